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
        self.assertEqual(meshes["/world/ground"]["material"], {"type": "diffuse", "albedo": [0.4, 0.3, 0.2]})
        self.assertNotIn("/world/hidden", meshes)
        text = pathlib.Path(self.file(meshes["/world/ground"]["file"])).read_text(encoding="ascii")
        self.assertIn("f 4/1 3/2 2/3 1/4", text)
        for line in ("note: /world/grass: a BasisCurves has no counterpart", "field:odour has no counterpart",
                     "shaping:cone:angle has no counterpart", "the gloss of a UsdPreviewSurface"):
            self.assertIn(line, self.notes)

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
