#!/usr/bin/env python3
"""tools/usd2vdbeam.py, against a stub of `pxr` that reads simple .usda files: what the fixture becomes, and that
vdbeam renders it."""
import math
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT / "tests" / "support"))

from program import BINARY, DATA, InTempFolder  # noqa: E402

TOOL = ROOT / "tools" / "usd2vdbeam.py"
try:
    import tomllib
except ImportError:  # before Python 3.11
    tomllib = None


class UsdScene(InTempFolder):
    def convert(self, *words, stage=HERE / "shot.usda", code=0, stub=True):
        """Runs the tool in the folder; returns what it prints on stderr."""
        environment = {**os.environ, "PYTHONPATH": str(HERE / "stub") if stub else ""}
        result = subprocess.run([sys.executable, "-B", TOOL, stage, "-o", "scene.toml", *words], cwd=self.folder.name,
                                env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stderr

    def scene(self, *words):
        """The scene of the fixture."""
        if tomllib is None:
            self.skipTest("needs Python 3.11")
        self.notes = self.convert(*words)
        return tomllib.loads(pathlib.Path(self.file("scene.toml")).read_text(encoding="utf-8"))

    def almost(self, found, expected):
        self.assertEqual(len(found), len(expected))
        for a, b in zip(found, expected):
            self.assertAlmostEqual(a, b, places=6)

    def test_volume_has_the_names_of_its_grids(self):
        """The relation says `soot` and `warmth`; the grids are called as their fields' fieldName."""
        volume = self.scene()["volume"][0]
        self.assertEqual((volume["name"], volume["density"]), ("/world/smoke", "density"))
        self.assertEqual(volume["emission"], {"temperature": "temperature", "kelvin": 600})
        self.assertEqual(volume["file"], "smoke.####.vdb")
        self.assertEqual(volume["time"]["offset"]["keys"], [[1, 12], [2, 24], [3, 24]])
        self.assertEqual(volume["phase"], {"type": "henyey_greenstein", "g": 0.4})
        self.assertEqual((volume["extinction"], volume["albedo"]), (30, 0.9))
        # Scaled by two, then turned by 90 degrees about X, then moved up by the parent.
        self.almost(volume["transform"], [2, 0, 0, 0, 0, 0, -2, 1, 0, 2, 0, 0])

    def test_point_instances(self):
        volumes = self.scene("--extinction", "4")["volume"]
        self.assertEqual([volume["name"] for volume in volumes[1:]],
                         ["/world/puffs/puff/cloud.0", "/world/puffs/puff/cloud.1"])
        self.almost([volumes[1]["transform"][k] for k in (3, 7, 11)], [5, 1.5, 0.25])
        self.almost([volumes[2]["transform"][k] for k in (3, 7, 11)], [0, 1.5, 5.25])
        self.assertEqual((volumes[1]["density"], volumes[1]["extinction"]), ("density", 4))

    def test_hidden_instances_and_names_of_old(self):
        """Points may be hidden; lights had no `inputs:` before USD 21, and the schema's fallbacks do not count then."""
        if tomllib is None:
            self.skipTest("needs Python 3.11")
        text = (HERE / "shot.usda").read_text(encoding="utf-8")
        text = text.replace("int[] protoIndices = [0, 0]", "int[] protoIndices = [0, 0]\n        int64[] invisibleIds = [0]")
        text += '\ndef SphereLight "old"\n{\n    float intensity = 3\n    float radius = 2\n}\n'
        pathlib.Path(self.file("old.usda")).write_text(text, encoding="utf-8")
        self.convert(stage="old.usda")
        scene = tomllib.loads(pathlib.Path(self.file("scene.toml")).read_text(encoding="utf-8"))
        self.assertEqual([volume["name"] for volume in scene["volume"][1:]], ["/world/puffs/puff/cloud.1"])
        old = next(mesh for mesh in scene["mesh"] if mesh["name"] == "/old")
        self.assertEqual((old["material"]["radiance"], old["transform"][0]), ([3] * 3, 2))

    def test_camera(self):
        camera = self.scene()["camera"]
        self.assertEqual((camera["focal_length"], camera["film_width"], camera["focus_distance"]), (50, 36, 7))
        self.assertAlmostEqual(camera["shift_x"], 0.1)
        self.assertAlmostEqual(camera["lens_radius"], 5 / 5.6)
        lines = pathlib.Path(self.file("camera.txt")).read_text(encoding="ascii").splitlines()
        self.almost([float(word) for word in lines[1].split()], [2, 1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 8, 0, 0, 0, 1])

    def test_lights(self):
        scene = self.scene()
        sun, disc, sky = scene["light"]
        self.assertEqual(sun["irradiance"]["keys"], [[1, [3] * 3], [2, [6] * 3], [3, [12] * 3]])
        self.almost(sun["direction"], [0, -1, 0])
        self.almost(disc["irradiance"], [1000 * math.pi * math.sin(math.radians(0.5)) ** 2] * 3)
        self.almost(sky["radiance"], [0.1, 0.2, 0.5])
        meshes = {mesh["name"]: mesh for mesh in scene["mesh"]}
        bulb = meshes["/lights/bulb"]
        self.assertEqual((bulb["type"], bulb["material"]["kelvin"]), ("sphere", 3200))
        self.almost(bulb["material"]["radiance"], [10 / (4 * math.pi * 0.25 ** 2)] * 3)
        window = meshes["/lights/window"]
        # It shines down: the quad's +Z axis points to -Y, and its sides are 2 and 1.
        transform = window["transform"]
        self.almost([transform[k] for k in (2, 6, 10)], [0, -1, 0])
        self.assertAlmostEqual(math.hypot(*(transform[k] for k in (0, 4, 8))), 1)
        self.assertAlmostEqual(math.hypot(*(transform[k] for k in (1, 5, 9))), 0.5)
        self.assertEqual(meshes["/lights/lid"]["type"], "disk")

    def variant(self, *replacements, more="", name="variant.usda"):
        """The scene of the fixture with other text, and its notes."""
        if tomllib is None:
            self.skipTest("needs Python 3.11")
        text = (HERE / "shot.usda").read_text(encoding="utf-8")
        for old, new in replacements:
            self.assertIn(old, text)
            text = text.replace(old, new, 1)
        pathlib.Path(self.file(name)).write_text(text + more, encoding="utf-8")
        self.notes = self.convert(stage=name)
        return tomllib.loads(pathlib.Path(self.file("scene.toml")).read_text(encoding="utf-8"))

    def test_a_lamp_with_a_cone_is_a_spot(self):
        """The same intensity along its axis; softness is a share of the cone's angle."""
        scene = self.variant(("float inputs:radius = 0.25", """float inputs:radius = 0.25
        float inputs:shaping:cone:angle = 40
        float inputs:shaping:cone:softness = 0.25
        asset inputs:shaping:ies:file = @lamp.ies@"""))
        spot = scene["light"][-1]
        self.assertEqual((spot["type"], spot["cone_angle"], spot["cone_falloff"]), ("spot", 40, 10))
        self.assertEqual((spot["ies"], spot["kelvin"], spot["position"]), ("lamp.ies", 3200, [3, 3, 0]))
        self.almost(spot["direction"], [0, 0, -1])
        self.almost(spot["intensity"], [10 / 4] * 3)  # 10 / (4 pi r^2) times pi r^2
        self.assertIn("/lights/bulb: a cone or profile of a lamp with a radius has no counterpart", self.notes)
        self.assertNotIn("/lights/bulb: shaping", self.notes)

    def test_a_cylinder_lies_along_x(self):
        scene = self.variant(more="""
def CylinderLight "tube"
{
    float inputs:radius = 0.1
    float inputs:length = 3
    float inputs:intensity = 6
    bool inputs:normalize = true
}
""")
        tube = next(mesh for mesh in scene["mesh"] if mesh["name"] == "/tube")
        self.assertEqual(tube["type"], "cylinder")
        self.almost(tube["transform"], [0, 0, 1.5, 0, 0.1, 0, 0, 0, 0, 0.1, 0, 0])
        self.almost(tube["material"]["radiance"], [6 / (2 * math.pi * 0.1 * 3)] * 3)
        self.assertIn("/tube: the ends of the cylinder shine, too", self.notes)

    def test_controls_of_lights_without_a_counterpart_are_noted(self):
        self.variant(("float inputs:radius = 0.5", """float inputs:radius = 0.5
        float inputs:diffuse = 0
        float inputs:specular = 1
        bool inputs:shadow:enable = false
        color3f inputs:shadow:color = (0.5, 0, 0)
        rel light:filters = </lights/gobo>
        rel collection:lightLink:excludes = </world/ground>"""))
        for name in ("diffuse", "shadow:enable", "shadow:color", "light:filters", "collection:lightLink:excludes"):
            self.assertIn(f"note: /lights/lid: {name} has no counterpart", self.notes)
        self.assertNotIn("/lights/lid: specular", self.notes)
        self.assertNotIn("/lights/sky:", self.notes)

    def test_velocities_are_per_second_of_time_codes(self):
        velocity = """rel field:density = </world/smoke/soot>
        rel field:vel = </world/smoke/motion>

        def OpenVDBAsset "motion"
        {
            int fieldIndex = 1
            token fieldName = "v"
            asset filePath.timeSamples = {
                1: @smoke.0012.vdb@,
                2: @smoke.0024.vdb@,
                3: @smoke.0024.vdb@,
            }
        }
"""
        here = "rel field:density = </world/smoke/soot>"
        volume = self.variant((here, velocity))["volume"][0]
        self.assertEqual((volume["velocity"], volume["velocity_fps"]), ("v", 25))
        self.assertIn("/world/smoke/motion is not the first grid of its name", self.notes)
        volume = self.variant((here, velocity), ("framesPerSecond = 25", "framesPerSecond = 25\n    timeCodesPerSecond = 48"))
        self.assertEqual(volume["volume"][0]["velocity_fps"], 48)
        self.assertEqual(volume["image"]["fps"], 25)

    def test_render_settings_fit_the_image_to_the_aperture(self):
        """The film of the fixture is 36 x 15.2908, of 2.354 : 1; its image is of 1.778 : 1."""
        here = "uniform int2 resolution = (48, 27)"
        for policy, width in (("expandAperture", 36), ("cropAperture", 15.2908 * 48 / 27), ("adjustApertureHeight", 36),
                              ("adjustApertureWidth", 15.2908 * 48 / 27)):
            camera = self.variant((here, f'{here}\nuniform token aspectRatioConformPolicy = "{policy}"'))["camera"]
            self.assertAlmostEqual(camera["film_width"], width, msg=policy)
            self.assertAlmostEqual(camera["shift_x"], 3.6 / width, msg=policy)
        wide = self.variant((here, "uniform int2 resolution = (480, 100)"))["camera"]
        self.assertAlmostEqual(wide["film_width"], 15.2908 * 4.8)  # the default expands
        scene = self.variant((here, f'{here}\nuniform float pixelAspectRatio = 2\nuniform bool disableDepthOfField = true'))
        self.assertEqual(scene["image"]["pixel_aspect"], 2)
        self.assertAlmostEqual(scene["camera"]["film_width"], 15.2908 * 2 * 48 / 27)
        self.assertNotIn("lens_radius", scene["camera"])

    def test_render_settings_name_the_camera(self):
        more = 'def Camera "second"\n{\n    float horizontalAperture = 50\n}\n'
        here = "uniform int2 resolution = (48, 27)"
        camera = self.variant((here, f"{here}\n    rel camera = </second>"), more=more)["camera"]
        self.assertEqual(camera["film_width"], 50)

    def test_textures_and_parts_of_a_mesh(self):
        here = "color3f inputs:diffuseColor = (0.4, 0.3, 0.2)"
        scene = self.variant((here, """color3f inputs:diffuseColor.connect = </looks/stone/image.outputs:rgb>
            float inputs:roughness.connect = </looks/stone/image.outputs:g>
            float inputs:opacity.connect = </looks/stone/image.outputs:a>
            float inputs:opacityThreshold = 0.3
            normal3f inputs:normal.connect = </looks/stone/image.outputs:a>
            float inputs:metallic = 0.25
            float inputs:clearcoat = 0.5
        }

        def Shader "image"
        {
            uniform token info:id = "UsdUVTexture"
            asset inputs:file = @stone.png@"""),
                             ("rel material:binding = </looks/stone>", """rel material:binding = </looks/stone>
        uniform token subdivisionScheme = "none"

        def GeomSubset "half"
        {
            rel material:binding = </looks/stone>
        }"""))
        ground = next(mesh for mesh in scene["mesh"] if mesh["name"] == "/world/ground")
        self.assertEqual(ground["material"], {"type": "standard", "albedo": [1, 1, 1], "texture": "stone.png", "ior": 1.5,
                                              "metal": 0.25, "roughness": 1, "roughness_texture": "stone.png", "coat": 0.5,
                                              "coat_roughness": 0.01, "opacity": 1, "opacity_texture": "stone.png",
                                              "opacity_cutoff": 0.3})
        self.assertIn("/world/ground: the texture of normal has no counterpart", self.notes)
        self.assertIn("/world/ground: materials of parts (GeomSubset) have no counterpart", self.notes)
        self.assertNotIn("/world/ground: a subdivision surface", self.notes)

    def dome(self, up, light):
        """The environment of a stage with a dome."""
        text = f"""#usda 1.0
(
    upAxis = "{up}"
)
def Camera "cam" {{ }}
def {light}
{{
    asset inputs:texture:file = @sky.exr@
    float3 xformOp:rotateXYZ = (%s)
    uniform token[] xformOpOrder = ["xformOp:rotateXYZ"]
}}
"""
        def rotation(turn):
            pathlib.Path(self.file("dome.usda")).write_text(text % turn, encoding="utf-8")
            self.notes = self.convert(stage="dome.usda")
            light = tomllib.loads(pathlib.Path(self.file("scene.toml")).read_text(encoding="utf-8"))["light"][0]
            self.assertEqual((light["type"], light["image"]), ("environment", "sky.exr"))
            return light["rotation"]
        return rotation

    def test_domes_turn_about_the_up_axis(self):
        """With Y up an image has the same place as in vdbeam; with Z up, DomeLight_1 stands upright by itself, and a
        DomeLight by a quarter turn about X."""
        if tomllib is None:
            self.skipTest("needs Python 3.11")
        rotation = self.dome("Y", 'DomeLight "sky"')
        self.assertAlmostEqual(rotation("0, 0, 0"), 0)
        self.assertAlmostEqual(rotation("0, 30, 0"), 30)
        self.assertNotIn("tilted", self.notes)
        rotation("40, 0, 0")
        self.assertIn("tilted", self.notes)
        rotation = self.dome("Z", 'DomeLight_1 "sky"')
        self.assertAlmostEqual(rotation("0, 0, 30"), 30)
        rotation = self.dome("Z", 'DomeLight "sky"')
        self.assertAlmostEqual(rotation("90, 0, 0"), 0)
        self.assertAlmostEqual(rotation("90, 0, 30"), 30)
        self.assertNotIn("tilted", self.notes)

    def test_mesh_and_what_is_left_out(self):
        meshes = {mesh["name"]: mesh for mesh in self.scene()["mesh"]}
        self.assertEqual(meshes["/world/ground"]["material"],
                         {"type": "standard", "albedo": [0.4, 0.3, 0.2], "metal": 0, "roughness": 0.5, "ior": 1.5})
        self.assertNotIn("/world/hidden", meshes)
        text = pathlib.Path(self.file(meshes["/world/ground"]["file"])).read_text(encoding="ascii")
        self.assertIn("f 4/1 3/2 2/3 1/4", text)
        for line in ("note: /world/grass: a BasisCurves has no counterpart", "field:odour has no counterpart",
                     "shaping:cone:angle has no counterpart",
                     "note: /world/ground: a subdivision surface (catmullClark) has no counterpart"):
            self.assertIn(line, self.notes)

    def faces_with(self, *lines, old="texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)]"):
        """The normals and the face of the ground's OBJ, with these lines in place of its texture coordinates."""
        scene = self.variant((old, "\n".join(lines)))
        ground = next(mesh for mesh in scene["mesh"] if mesh["name"] == "/world/ground")
        text = pathlib.Path(self.file(ground["file"])).read_text(encoding="ascii")
        return [line for line in text.splitlines() if line.startswith(("vn", "f"))]

    def test_normals_go_with_the_mesh(self):
        """The corners of the ground are its points 4 to 1. USD interpolates normals over points if not said otherwise."""
        four = "normals = [(0, 1, 0), (0, 1, 0.5), (0.5, 1, 0), (1, 0, 0)]"
        lines = ["vn 0 1 0", "vn 0 1 0.5", "vn 0.5 1 0", "vn 1 0 0"]
        by_point, by_corner = "f 4//4 3//3 2//2 1//1", "f 4//1 3//2 2//3 1//4"
        self.assertEqual(self.faces_with(f'normal3f[] {four} (interpolation = "vertex")'), [*lines, by_point])
        self.assertEqual(self.faces_with(f'normal3f[] {four} (interpolation = "faceVarying")'), [*lines, by_corner])
        self.assertEqual(self.faces_with(f"normal3f[] {four}"), [*lines, by_point])
        self.assertEqual(self.faces_with('normal3f[] normals = [(0, 1, 0)] (interpolation = "uniform")'),
                         ["vn 0 1 0", "f 4//1 3//1 2//1 1//1"])
        self.assertEqual(self.faces_with(f"normal3f[] {four}", 'normal3f[] primvars:normals = [(0, 2, 0), (0, 3, 0)] '
                                         '(interpolation = "faceVarying")', "int[] primvars:normals:indices = [1, 0, 0, 1]"),
                         ["vn 0 2 0", "vn 0 3 0", "f 4//2 3//1 2//1 1//2"])
        result = subprocess.run([BINARY, "info", next(pathlib.Path(self.folder.name).glob("*.obj"))], capture_output=True,
                                text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.faces_with("normal3f[] normals = [(0, 1, 0), (0, 1, 0)]"), ["f 4 3 2 1"])
        self.assertIn("note: /world/ground: its normals fit neither its corners, points nor faces", self.notes)

    def test_a_surface_that_emits_reflects_nothing(self):
        diffuse = "color3f inputs:diffuseColor = (0.4, 0.3, 0.2)"
        note = "note: /world/ground: a surface that both emits and reflects has no counterpart"
        scene = self.variant((diffuse, f"{diffuse}\ncolor3f inputs:emissiveColor = (0, 0.01, 0)"))
        ground = next(mesh for mesh in scene["mesh"] if mesh["name"] == "/world/ground")
        self.assertEqual(ground["material"], {"type": "emissive", "radiance": [0, 0.01, 0], "two_sided": True})
        self.assertIn(note, self.notes)
        self.variant((diffuse, "color3f inputs:diffuseColor = (0, 0, 0)\ncolor3f inputs:emissiveColor = (0, 0.01, 0)"))
        self.assertNotIn(note, self.notes)

    def test_vdbeam_renders_it(self):
        self.convert()
        for name, source in (("smoke.0012.vdb", "smoke/smoke.0012.vdb"), ("smoke.0024.vdb", "smoke/smoke.0024.vdb"),
                             ("fog.vdb", "fog.vdb")):
            shutil.copy(DATA / source, self.file(name))
        result = subprocess.run([BINARY, "render", "scene.toml", "-f", "2", "-o", "o.exr", "--passes", "1"],
                                cwd=self.folder.name, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_deforming_mesh_is_a_sequence(self):
        text = (HERE / "shot.usda").read_text(encoding="utf-8")
        points = "(-2, 0, -2), (2, 0, -2), (2, 0, 2), (-2, 0, 2)"
        moved = text.replace(f"points = [{points}]", "points.timeSamples = {1: [%s], 2: [%s]}" % (
            points, points.replace("0,", "0.5,")))
        self.assertNotEqual(text, moved)
        pathlib.Path(self.file("moved.usda")).write_text(moved, encoding="utf-8")
        self.convert("-f", "1-2", stage="moved.usda")
        self.assertIn('file = "_world_ground.####.obj"', pathlib.Path(self.file("scene.toml")).read_text("utf-8"))
        self.assertEqual(len(list(pathlib.Path(self.folder.name).glob("_world_ground.000[12].obj"))), 2)

    def test_bad_input(self):
        self.assertIn("has no pxr", self.convert(code=2, stub=False))
        pathlib.Path(self.file("x.usda")).write_text("nothing", encoding="utf-8")
        self.assertIn("x.usda: cannot be opened", self.convert(stage="x.usda", code=2))
        pathlib.Path(self.file("x.usda")).write_text('#usda 1.0\ndef Scope "a" { }\n', encoding="utf-8")
        self.assertIn("the stage has no camera", self.convert(stage="x.usda", code=2))
        self.assertIn("is not a camera", self.convert("--camera", "/world", code=2))
        self.assertIn("must look like 7 or 1-24", self.convert("-f", "1..3", code=2))


if __name__ == "__main__":
    unittest.main()
