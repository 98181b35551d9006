#!/usr/bin/env python3
"""What Blender's nodes, lamps, cameras and sequences become in a scene file, without Blender."""
import math
import types
import unittest

from fake_nodes import link, node
from vdbeam_blender import animate, camera, lamps, notes, sequence, toml_text, view_transform, volume_shader, world


def principled_volume(**values):
    """A Principled Volume with Blender's defaults."""
    inputs = {"Color": (0.5, 0.5, 0.5, 1), "Color Attribute": "", "Density": 1.0, "Density Attribute": "density",
              "Anisotropy": 0.0, "Absorption Color": (0, 0, 0, 1), "Emission Strength": 0.0,
              "Emission Color": (1, 1, 1, 1), "Blackbody Intensity": 0.0, "Blackbody Tint": (1, 1, 1, 1),
              "Temperature": 1000.0, "Temperature Attribute": "temperature"}
    return node("PRINCIPLED_VOLUME", {**inputs, **{key.replace("_", " "): value for key, value in values.items()}})


class VolumeShaders(unittest.TestCase):
    def keys(self, shader):
        self.notes = notes.Notes()
        return volume_shader.volume_keys(shader, self.notes, "smoke")

    def test_defaults_scatter_and_absorb_half(self):
        keys = self.keys(principled_volume())
        self.assertEqual(keys, {"extinction": 1.0, "extinction_scale": [1.0] * 3, "albedo": [0.5] * 3,
                                "density": "density"})
        self.assertEqual(self.notes.lines, [])

    def test_absorption_colour_changes_the_extinction(self):
        """Cycles absorbs (1 - colour) (1 - sqrt(absorption colour))."""
        keys = self.keys(principled_volume(Color=(0.8, 0.6, 0.4, 1), Absorption_Color=(0.25, 0.0, 1.0, 1), Density=10.0,
                                           Anisotropy=0.4))
        extinction = [10 * (0.8 + 0.2 * 0.5), 10 * (0.6 + 0.4), 10 * 0.4]
        for scale, expected in zip(keys["extinction_scale"], extinction):
            self.assertAlmostEqual(keys["extinction"] * scale, expected)
        for albedo, expected in zip(keys["albedo"], (8 / 9, 0.6, 1.0)):
            self.assertAlmostEqual(albedo, expected)
        self.assertEqual(keys["phase"], {"type": "henyey_greenstein", "g": 0.4})

    def test_sum_of_scatter_and_absorption(self):
        scatter = node("VOLUME_SCATTER", {"Color": (1, 1, 1, 1), "Density": 3.0, "Anisotropy": 0.5})
        absorption = node("VOLUME_ABSORPTION", {"Color": (0, 0.5, 1, 1), "Density": 2.0})
        attribute = node("ATTRIBUTE", attribute_name="density")
        product = node("MATH", {"a": 1.0, "b": 4.0}, operation="MULTIPLY")
        link(attribute, product, "a")
        link(product, scatter, "Density")
        link(attribute, absorption, "Density")
        both = node("ADD_SHADER", {"0": None, "1": None})
        link(scatter, both, "0")
        link(absorption, both, "1")
        keys = self.keys(both)
        for scale, expected in zip(keys["extinction_scale"], (4 + 1, 4 + 0.5, 4)):
            self.assertAlmostEqual(keys["extinction"] * scale, expected)
        self.assertEqual(keys["density"], "density")
        self.assertAlmostEqual(keys["phase"]["g"], 0.5)

    def test_black_bodies_have_the_brightness_of_cycles(self):
        """sigma T^4 / (pi 10^6): the scene's scale times (T / reference)^4."""
        keys = self.keys(principled_volume(Blackbody_Intensity=1.0, Temperature=800.0))
        emission = keys["emission"]
        self.assertEqual((emission["temperature"], emission["kelvin"], emission["law"]),
                         ("temperature", 800.0, "stefan_boltzmann"))
        kelvin = 1700
        self.assertAlmostEqual(emission["scale"] * (kelvin / emission["reference"]) ** 4,
                               5.670373e-14 / math.pi * kelvin ** 4)

    def test_flame_grid_emits(self):
        shader = principled_volume()
        link(node("ATTRIBUTE", attribute_name="flame"), shader, "Emission Strength")
        self.assertEqual(self.keys(shader)["emission"], {"intensity": "flame", "scale": 1.0, "color": [1, 1, 1]})

    def test_what_has_no_counterpart_is_noted(self):
        shader = principled_volume()
        link(node("VALTORGB"), shader, "Density")
        self.keys(shader)
        self.assertEqual(len(self.notes.lines), 1)
        self.assertIn("Density is driven by a Valtorgb", self.notes.lines[0])
        self.assertIsNone(self.keys(node("BSDF_HAIR")))
        self.assertIn("has no counterpart", self.notes.lines[0])


class Worlds(unittest.TestCase):
    def lights(self, colour_node=None, strength=1.0):
        background = node("BACKGROUND", {"Color": (0.1, 0.2, 0.3, 1), "Strength": strength})
        if colour_node is not None:
            link(colour_node, background, "Color")
        output = node("OUTPUT_WORLD", {"Surface": None, "Volume": None}, target="ALL", is_active_output=True)
        link(background, output, "Surface")
        tree = types.SimpleNamespace(nodes=[background, output])
        self.notes = notes.Notes()
        return world.world_lights(types.SimpleNamespace(use_nodes=True, node_tree=tree, name="World"), self.notes,
                                  lambda image: image)

    def test_constant_and_black(self):
        self.assertEqual(self.lights(strength=2.0), [{"type": "environment", "radiance": [0.2, 0.4, 0.6]}])
        self.assertEqual(self.lights(strength=0.0), [])
        self.assertEqual(world.world_lights(None, None, None), [])

    def test_volume_of_the_world(self):
        """A box of fifteen mean free paths to each side, of the thinnest channel."""
        fog = principled_volume(Density=0.5, Color=(1, 0.5, 0, 1), Absorption_Color=(0, 0, 0, 1), Density_Attribute="")
        output = node("OUTPUT_WORLD", {"Surface": None, "Volume": None}, target="ALL", is_active_output=True)
        link(fog, output, "Volume")
        tree = types.SimpleNamespace(nodes=[fog, output])
        found = notes.Notes()
        keys = world.world_volume(types.SimpleNamespace(use_nodes=True, node_tree=tree, name="World"), [1, 2, 3], found)
        self.assertEqual((keys["shape"], keys["name"], keys["extinction"]), ("box", "World", 0.5))
        self.assertEqual(keys["albedo"], [1.0, 0.5, 0.0])
        self.assertEqual((keys["box_lower"], keys["box_upper"]), ([-29, -28, -27], [31, 32, 33]))
        self.assertNotIn("density", keys)
        self.assertEqual(found.lines, [])
        self.assertIsNone(world.world_volume(None, [0, 0, 0], found))

    def test_environment_image_turns(self):
        mapping = node("MAPPING", {"Rotation": (0, 0, math.radians(30))}, vector_type="POINT")
        texture = node("TEX_ENVIRONMENT", {"Vector": None}, image="sky.exr", projection="EQUIRECTANGULAR")
        link(mapping, texture, "Vector")
        self.assertAlmostEqual(self.lights(texture)[0]["rotation"], 60)

    def test_nishita_sky(self):
        sky = node("TEX_SKY", sky_type="NISHITA", sun_elevation=0.5, sun_rotation=math.pi / 2, air_density=1.0,
                   dust_density=2.0, ozone_density=1.0, altitude=100.0, sun_disc=True, sun_intensity=0.5)
        atmosphere, sun = self.lights(sky, 0.1)
        self.assertEqual((atmosphere["type"], atmosphere["sun"], sun["type"]), ("atmosphere", False, "sun"))
        self.assertAlmostEqual(sun["irradiance"][0], atmosphere["irradiance"][0] / 2)
        # The sun stands at +X: its light travels along -X and down.
        self.assertAlmostEqual(sun["direction"][0], -math.cos(0.5))
        self.assertAlmostEqual(sun["direction"][1], 0)
        self.assertAlmostEqual(sun["direction"][2], -math.sin(0.5))


class Lamps(unittest.TestCase):
    @staticmethod
    def lamp(**more):
        unit = [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]
        return {"name": "lamp", "matrix": unit, "colour": [1.0, 0.5, 0.0], "energy": 40.0, "radius": 0.0, **more}

    def test_strengths(self):
        found = notes.Notes()
        table, point = lamps.lamp_keys(self.lamp(type="POINT"), found)
        self.assertEqual((table, point["position"]), ("light", [1, 2, 3]))
        self.assertAlmostEqual(point["intensity"][0], 40 / (4 * math.pi))
        _, sun = lamps.lamp_keys(self.lamp(type="SUN", angle=math.radians(2)), found)
        self.assertEqual((sun["irradiance"], sun["direction"]), ([40, 20, 0], [0, 0, -1]))
        self.assertAlmostEqual(sun["angular_radius"], 1)
        _, spot = lamps.lamp_keys(self.lamp(type="SPOT", spot_size=math.radians(60), spot_blend=1.0), found)
        self.assertAlmostEqual(spot["cone_angle"], 30)
        self.assertAlmostEqual(spot["cone_falloff"], 30)
        self.assertEqual(found.lines, [])

    def test_area_lamp_is_a_quad_that_shines_down(self):
        table, quad = lamps.lamp_keys(self.lamp(type="AREA", shape="RECTANGLE", size=2.0, size_y=0.5), notes.Notes())
        self.assertEqual((table, quad["type"], quad["visible"]), ("mesh", "quad", False))
        self.assertAlmostEqual(quad["material"]["radiance"][0], 40 / (4 * 1.0))
        self.assertEqual(quad["transform"], [1, 0, 0, 1, 0, -0.25, 0, 2, 0, 0, -1, 3])


    def test_radius_is_a_sphere_of_the_same_intensity(self):
        found = notes.Notes()
        table, ball = lamps.lamp_keys(self.lamp(type="POINT", radius=0.5), found)
        self.assertEqual((table, ball["type"], ball["translate"], ball["scale"]), ("mesh", "sphere", [1, 2, 3], [0.5] * 3))
        self.assertAlmostEqual(ball["material"]["radiance"][0] * math.pi * 0.25, 40 / (4 * math.pi))
        self.assertIn("emissive sphere", found.lines[0])

    def test_what_has_no_counterpart_is_reported(self):
        found = notes.Notes()
        lamps.lamp_keys(self.lamp(type="SPOT", radius=0.5, spot_size=1.0, spot_blend=0.0, casts_shadow=False), found)
        self.assertIn("without shadows", found.lines[0])
        self.assertIn("radius of a spot lamp", found.lines[1])

    def test_a_strength_that_is_not_normalized_is_reported(self):
        found = notes.Notes()
        lamps.lamp_keys(self.lamp(type="SUN", angle=0.0, normalized=False), found)
        self.assertEqual(len(found.lines), 1)
        self.assertIn("lamp: a strength that is not normalized", found.lines[0])

    def test_a_portal_is_no_lamp(self):
        found = notes.Notes()
        portal = self.lamp(type="AREA", shape="SQUARE", size=2.0, size_y=2.0, portal=True)
        self.assertIsNone(lamps.lamp_keys(portal, found))
        self.assertIn("lamp: a portal has no counterpart", found.lines[0])


class Cameras(unittest.TestCase):
    @staticmethod
    def facts(**more):
        return {"width": 200, "height": 100, "pixel_aspect": 1.0, "type": "PERSP", "lens": 50.0, "sensor_fit": "AUTO",
                "sensor_width": 36.0, "sensor_height": 24.0, "shift_x": 0.1, "shift_y": 0.2, "ortho_scale": 6.0,
                "near": 0.1, "far": 100.0, "use_dof": False, "fstop": 2.8, "blades": 0, "blade_angle": 0.0,
                "focus_distance": 4.0, **more}

    def test_sensor_fits(self):
        for fit, size, tangent in (("AUTO", (200, 100), 18 / 50 / 2), ("AUTO", (100, 200), 18 / 50),
                                   ("HORIZONTAL", (100, 200), 18 / 50 * 2), ("VERTICAL", (200, 100), 12 / 50)):
            keys = camera.camera_keys(self.facts(sensor_fit=fit, width=size[0], height=size[1]))
            self.assertAlmostEqual(math.tan(math.radians(keys["fov"] / 2)), tangent, msg=fit)

    def test_shift_is_in_units_of_the_fitted_side(self):
        keys = camera.camera_keys(self.facts())
        self.assertAlmostEqual(keys["shift_x"], 0.1)
        self.assertAlmostEqual(keys["shift_y"], 0.4)

    def test_lens_and_shutter(self):
        keys = camera.camera_keys(self.facts(use_dof=True, blades=6, blade_angle=math.pi / 6))
        self.assertAlmostEqual(keys["lens_radius"], 0.05 / 5.6)
        self.assertEqual((keys["focus_distance"], keys["blades"]), (4.0, 6))
        self.assertEqual(camera.shutter("CENTER", 0.5), (-0.25, 0.25))
        self.assertEqual(camera.shutter("START", 0.5), (0, 0.5))

    def test_scale_of_parents_is_left_out(self):
        line = camera.matrix_lines({3.0: [[2, 0, 0, 5], [0, 0, -3, 6], [0, 4, 0, 7], [0, 0, 0, 1]]})
        self.assertEqual([float(word) for word in line.split()], [3, 1, 0, 0, 5, 0, 0, -1, 6, 0, 1, 0, 7, 0, 0, 0, 1])


class Sequences(unittest.TestCase):
    def numbers(self, mode, frames=range(-2, 9)):
        volume = {"mode": mode, "duration": 3, "start": 2, "offset": 10}
        return [sequence.file_number(frame, volume) for frame in frames]

    def test_modes(self):
        self.assertEqual(self.numbers("CLIP"), [None] * 4 + [11, 12, 13] + [None] * 4)
        self.assertEqual(self.numbers("EXTEND"), [11] * 5 + [12] + [13] * 5)
        self.assertEqual(self.numbers("REPEAT"), [13, 11, 12, 13, 11, 12, 13, 11, 12, 13, 11])
        self.assertEqual(self.numbers("PING_PONG"), [11, 12, 13, 12, 11, 12, 13, 12, 11, 12, 13])

    def test_pattern(self):
        self.assertEqual(sequence.pattern_of("/a/smoke_v2.0024.vdb"), ("/a/smoke_v2.####.vdb", 24))
        self.assertEqual(sequence.pattern_of("/a/smoke.vdb"), ("/a/smoke.vdb", None))


class Animation(unittest.TestCase):
    def test_values_that_change_become_keys(self):
        scenes = {float(time): {"camera": {"fov": 30.0 + time, "near": 0.1},
                                "volume": [{"name": "a", "file": "a.vdb", "extinction": 2.0,
                                            "phase": {"type": "henyey_greenstein", "g": 0.1 * time}}]}
                  for time in (1, 2, 3)}
        found = notes.Notes()
        merged = animate.merge(scenes, found)
        self.assertEqual(merged["camera"], {"fov": {"keys": [[1.0, 31.0], [2.0, 32.0], [3.0, 33.0]]}, "near": 0.1})
        self.assertEqual(merged["volume"][0]["phase"]["type"], "henyey_greenstein")
        self.assertEqual(merged["volume"][0]["phase"]["g"]["keys"][1], [2.0, 0.2])
        self.assertEqual(found.lines, [])

    def test_constant_stretches_keep_their_ends(self):
        merged = animate.merge({float(t): {"render": {"clamp": v}} for t, v in enumerate((1.0, 1.0, 1.0, 2.0, 2.0))},
                               notes.Notes())
        self.assertEqual(merged["render"]["clamp"]["keys"], [[0.0, 1.0], [2.0, 1.0], [3.0, 2.0], [4.0, 2.0]])

    def test_what_cannot_change_is_noted(self):
        found = notes.Notes()
        merged = animate.merge({1.0: {"light": [{"type": "point"}, {"type": "spot"}], "mesh": [{"name": "a", "file": "x"}]},
                                2.0: {"light": [{"type": "point"}], "mesh": [{"name": "a", "file": "y"}, {"name": "b"}]}},
                               found)
        self.assertEqual(merged["mesh"], [{"name": "a", "file": "x"}])
        self.assertEqual(len(found.lines), 3)


class Views(unittest.TestCase):
    def words(self, **more):
        self.notes = notes.Notes()
        settings = {"view_transform": "Filmic", "look": "None", "gamma": 1.0, "exposure": 0.0, "use_curve_mapping": False}
        return view_transform.view_words(types.SimpleNamespace(**{**settings, **more}), self.notes)

    def test_view_and_exposure(self):
        self.assertEqual(self.words(), ["--view=filmic"])
        self.assertEqual(self.words(view_transform="Standard", exposure=-1.5), ["--view=srgb", "--exposure=-1.5"])
        self.assertEqual(self.notes.lines, [])

    def test_what_has_no_counterpart_is_noted(self):
        self.assertEqual(self.words(view_transform="AgX", look="AgX - Punchy", gamma=1.2, use_curve_mapping=True),
                         ["--view=filmic"])
        for line, text in zip(self.notes.lines, ("view transform AgX has no counterpart; filmic", "look AgX - Punchy",
                                                 "gamma 1.2", "curves"), strict=True):
            self.assertIn(text, line)
        self.assertEqual(self.words(view_transform="Raw"), ["--view=srgb"])
        self.assertEqual(len(self.notes.lines), 1)


class SceneText(unittest.TestCase):
    def test_scene_text_is_read_back(self):
        scene = {"image": {"width": 3, "height": 2}, "camera": {"up": [0.0, 0.0, 1.0], "fov": {"keys": [[1.0, 20.0]]}},
                 "light": [{"type": "environment", "radiance": [0.1, 1e-9, 2]}, {"type": "point", "visible": True}]}
        text = toml_text.scene_text(scene, ["two\nlines \"here\""])
        try:
            import tomllib
        except ImportError:
            self.skipTest("needs Python 3.11")
        self.assertEqual(tomllib.loads(text), scene)
        self.assertTrue(text.startswith('# two lines "here"\n'))
        with self.assertRaises(ValueError):
            toml_text.scene_text({"camera": {"fov": math.nan}})


if __name__ == "__main__":
    unittest.main()
