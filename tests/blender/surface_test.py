#!/usr/bin/env python3
"""What Blender's surface shaders become in a scene file, without Blender."""
import math
import unittest

from fake_nodes import Socket, link, node
from vdbeam_blender import glow, lamps, notes, surface_shader


class Surfaces(unittest.TestCase):
    def keys(self, shader):
        self.notes = notes.Notes()
        return surface_shader.surface_keys(shader, self.notes, "stone", lambda image: image)

    def principled(self, **values):
        inputs = {"Base Color": (0.8, 0.8, 0.8, 1), "Metallic": 0.0, "Specular": 0.0, "Roughness": 0.5, "IOR": 1.45,
                  "Transmission": 0.0, "Emission": (0, 0, 0, 1), "Emission Strength": 1.0}
        return node("BSDF_PRINCIPLED", {**inputs, **{key.replace("_", " "): value for key, value in values.items()}})

    def test_principled_takes_the_strongest_part(self):
        self.assertEqual(self.keys(self.principled()), {"type": "diffuse", "albedo": [0.8] * 3})
        metal = self.keys(self.principled(Metallic=1.0, Roughness=0.2))
        self.assertEqual((metal["type"], metal["metal"], metal["roughness"]), ("standard", 1.0, 0.2))
        self.assertEqual(self.keys(self.principled(Transmission=1.0, Base_Color=(1, 1, 1, 1))),
                         {"type": "dielectric", "ior": 1.45, "roughness": 0.5})

    def test_names_of_blender_4(self):
        shader = node("BSDF_PRINCIPLED", {"Base Color": (1, 1, 1, 1), "Metallic": 0.0, "Specular IOR Level": 0.0,
                                          "Roughness": 0.0, "IOR": 1.33, "Transmission Weight": 1.0,
                                          "Emission Color": (1, 1, 1, 1), "Emission Strength": 0.0})
        self.assertEqual(self.keys(shader), {"type": "dielectric", "ior": 1.33, "roughness": 0.0})

    def test_gloss_and_coat(self):
        self.assertEqual(self.keys(self.principled(Specular=0.5)),
                         {"type": "standard", "metal": 0.0, "ior": 1.5, "roughness": 0.5, "albedo": [0.8] * 3})
        coated = self.keys(self.principled(Clearcoat=0.7, Clearcoat_Roughness=0.1))
        self.assertEqual((coated["ior"], coated["coat"], coated["coat_roughness"]), (1, 0.7, 0.1))
        self.assertEqual(self.notes.lines, [])
        newer = node("BSDF_PRINCIPLED", {"Base Color": (1, 1, 1, 1), "Metallic": 0.3, "Specular IOR Level": 0.5,
                                         "Roughness": 0.2, "IOR": 1.33, "Emission Strength": 0.0, "Coat Weight": 0.0})
        self.assertEqual(self.keys(newer), {"type": "standard", "metal": 0.3, "ior": 1.33, "roughness": 0.2,
                                            "albedo": [1.0] * 3})

    def test_transparent_is_not_there(self):
        self.assertIsNone(self.keys(node("BSDF_TRANSPARENT")))

    def test_texture(self):
        shader = link(node("TEX_IMAGE", image="bricks.png"), self.principled(), "Base Color")
        self.assertEqual(self.keys(shader), {"type": "diffuse", "texture": "bricks.png", "albedo": [1.0] * 3})

    def test_maps_of_opacity_roughness_and_normal(self):
        shader = self.principled(Specular=0.5, Alpha=1.0)
        shader.inputs.append(Socket("Normal"))
        picture = node("TEX_IMAGE", image="packed.png")
        apart = node("SEPARATE_COLOR", {"Color": None})
        apart.outputs[0].name = "Green"
        link(picture, apart, "Color")
        link(apart, shader, "Roughness")
        link(node("TEX_IMAGE", image="metal.png"), shader, "Metallic")
        link(node("TEX_IMAGE", image="leaf.png"), shader, "Alpha")
        bumps = node("NORMAL_MAP", {"Strength": 0.5, "Color": None}, space="TANGENT")
        link(node("TEX_IMAGE", image="bumps.png"), bumps, "Color")
        link(bumps, shader, "Normal")
        self.assertEqual(self.keys(shader), {
            "type": "standard", "metal": 1.0, "metal_texture": "metal.png", "ior": 1.5, "roughness": 1.0,
            "roughness_texture": "packed.png", "opacity_texture": "leaf.png", "normal_texture": "bumps.png",
            "normal_scale": 0.5, "albedo": [0.8] * 3})
        self.assertEqual(self.notes.lines, [])
        apart.outputs[0].name = "Red"  # no channel of roughness
        self.assertNotIn("roughness_texture", self.keys(shader))
        self.assertEqual(len(self.notes.lines), 1)

    def test_mixture_with_nothing_has_an_opacity(self):
        def mixture(factor, first, second):
            both = node("MIX_SHADER", {"Fac": factor, "1": None, "2": None})
            link(first, both, "1")
            return link(second, both, "2")

        clear, matt = node("BSDF_TRANSPARENT"), node("BSDF_DIFFUSE", {"Color": (1, 1, 1, 1)})
        self.assertEqual(self.keys(mixture(0.25, clear, matt)), {"type": "diffuse", "albedo": [1.0] * 3, "opacity": 0.25})
        self.assertEqual(self.keys(mixture(0.25, matt, clear))["opacity"], 0.75)
        leaf = link(node("TEX_IMAGE", image="leaf.png"), mixture(0.5, clear, matt), "Fac")
        self.assertEqual(self.keys(leaf)["opacity_texture"], "leaf.png")
        self.assertEqual(self.notes.lines, [])
        self.assertEqual(self.keys(mixture(0.5, matt, matt))["type"], "diffuse")
        self.assertEqual(len(self.notes.lines), 1)


class Glow(unittest.TestCase):
    """Surfaces that emit and reflect: the part with the greater radiance stays."""

    def tables(self, radiance, lights, albedo=0.5, name="screen"):
        material = {"type": "diffuse", "albedo": [albedo] * 3}
        if max(radiance) > 0:
            material["glow"] = {"radiance": radiance, "subject": "paint"}
        mesh = {"name": name, "file": "a.ply", "transform": [1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3], "material": material,
                "group": "key"}
        return {"mesh": [mesh], "light": lights}

    def material(self, *words, emissive=None, **more):
        self.notes, tables = notes.Notes(), self.tables(*words, **more)
        glow.choose(tables, {} if emissive is None else emissive, self.notes)
        self.group = tables["mesh"][0].get("group")
        return tables["mesh"][0]["material"]

    def test_emission_of_principled_waits_for_the_lights(self):
        shader = node("BSDF_PRINCIPLED", {"Base Color": (0.8, 0.8, 0.8, 1), "Specular": 0.0, "IOR": 1.45,
                                          "Emission": (1, 0.5, 0, 1), "Emission Strength": 4.0})
        keys = surface_shader.surface_keys(shader, notes.Notes(), "paint", None)
        self.assertEqual(keys, {"type": "diffuse", "albedo": [0.8] * 3,
                                "glow": {"radiance": [4.0, 2.0, 0.0], "subject": "paint"}})

    def test_the_brighter_part_stays(self):
        """A surface of albedo 0.5 reflects a radiance of 0.5 under a constant environment of 1."""
        world = [{"type": "environment", "radiance": [0.1, 1.0, 0.1]}]
        matt = {"type": "diffuse", "albedo": [0.5] * 3}
        self.assertEqual(self.material([0.4, 0.0, 0.0], world), matt)
        self.assertEqual(self.notes.lines, ["paint: its emission, of the radiance 0.4, is left out on objects that reflect "
                                            "more; a material does one or the other"])
        self.assertIsNone(self.group)
        self.assertEqual(self.material([0.6, 0.0, 0.0], world),
                         {"type": "emissive", "radiance": [0.6, 0.0, 0.0], "two_sided": True})
        self.assertIn("paint: its surface is left out on objects that reflect less", self.notes.lines[0])
        self.assertEqual(self.group, "key")
        self.assertEqual(self.material([0.1] * 3, [])["type"], "emissive")
        self.assertEqual(self.material([0.1] * 3, world, albedo=0.0)["type"], "emissive")
        self.assertEqual(self.notes.lines, [])
        self.assertEqual(self.material([0.0] * 3, world), matt)

    def test_light_of_suns_and_lamps(self):
        lights = [{"type": "distant", "irradiance": [3.0, 2.0, 1.0]},
                  {"type": "point", "position": [1, 2, 5], "intensity": [8.0, 0.0, 0.0]}]
        tables = self.tables([0.1] * 3, lights)
        self.assertAlmostEqual(glow.irradiance(tables, [1, 2, 3]), 3.0 + 8.0 / 4)
        lamp = {"name": "lamp", "matrix": [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 13], [0, 0, 0, 1]], "colour": [1.0] * 3,
                "energy": 40.0, "radius": 0.5, "type": "POINT"}
        for kind, expected in (("POINT", 40 / (4 * math.pi)), ("AREA", 40 / 4)):
            _, mesh = lamps.lamp_keys({**lamp, "type": kind, "shape": "DISK", "size": 0.5}, notes.Notes())
            tables = {"light": [], "mesh": [mesh]}
            self.assertAlmostEqual(glow.irradiance(tables, [1, 2, 3]), expected / 100)

    def test_the_choice_holds_at_all_times(self):
        world, emissive = [{"type": "environment", "radiance": [1.0] * 3}], {}
        self.assertEqual(self.material([2.0] * 3, world, emissive=emissive)["type"], "emissive")
        self.assertEqual(self.material([0.1] * 3, world, emissive=emissive)["radiance"], [0.1] * 3)
        self.assertEqual(self.material([0.0] * 3, world, emissive=emissive)["radiance"], [0.0] * 3)
        self.assertEqual(self.material([0.0] * 3, world, emissive=emissive, name="lamp")["type"], "diffuse")
        self.assertEqual(self.material([2.0] * 3, world, emissive=emissive, name="lamp")["type"], "diffuse")
        self.assertIn("at all times", self.notes.lines[0])

    def test_opacity_of_what_has_none(self):
        both = node("MIX_SHADER", {"Fac": 0.5, "1": None, "2": None})
        link(node("BSDF_TRANSPARENT"), both, "1")
        link(node("EMISSION", {"Color": (1, 1, 1, 1), "Strength": 2.0}), both, "2")
        found = notes.Notes()
        keys = surface_shader.surface_keys(both, found, "ghost", None)
        self.assertEqual(keys, {"type": "emissive", "radiance": [2.0] * 3, "two_sided": True})
        self.assertIn("the opacity of a surface of the type emissive", found.lines[0])


class Glass(unittest.TestCase):
    def test_colour_becomes_absorption(self):
        found = notes.Notes()
        glass = node("BSDF_GLASS", {"Color": (1.0, 0.5, 0.25, 1.0), "IOR": 1.45, "Roughness": 0.0})
        keys = surface_shader.surface_keys(glass, found, "glass", None)
        inside = surface_shader.tinted_inside(keys, 2.0, found, "glass")
        for value, colour in zip(inside["absorption"], (1.0, 0.5, 0.25)):
            self.assertAlmostEqual(math.exp(-2.0 * value), colour * colour)
        self.assertEqual(set(inside), {"type", "ior", "roughness", "absorption"})
        self.assertNotIn("absorption", surface_shader.tinted_inside(keys, 0.0, found, "glass"))
        self.assertIn("not closed", found.lines[-1])

    def test_clear_glass_is_clear(self):
        glass = node("BSDF_GLASS", {"Color": (1.0, 1.0, 1.0, 1.0), "IOR": 1.45, "Roughness": 0.0})
        keys = surface_shader.surface_keys(glass, notes.Notes(), "glass", None)
        self.assertEqual(surface_shader.tinted_inside(keys, 1.0, notes.Notes(), "glass"), keys)


if __name__ == "__main__":
    unittest.main()
