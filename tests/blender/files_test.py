#!/usr/bin/env python3
"""The files that the Blender add-on reads and writes, and the passes that they fill, without Blender."""
import json
import pathlib
import subprocess
import sys
import types
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools" / "blender"), str(ROOT / "tests" / "support")]

import requirements  # noqa: E402

try:
    import numpy
except ImportError as problem:
    requirements.import_failed(problem)

from program import BINARY, DATA, InTempFolder  # noqa: E402
from vdbeam_blender import exr, layers, meshes, objects  # noqa: E402


class Chords(unittest.TestCase):
    @staticmethod
    def cube(edge):
        """The twelve triangles of a cube, with their fronts outside."""
        faces = []
        for axis in range(3):
            u, v = numpy.eye(3)[(axis + 1) % 3], numpy.eye(3)[(axis + 2) % 3]
            for side in (0.0, 1.0):
                corner = side * numpy.eye(3)[axis]
                quad = [corner, corner + u, corner + u + v, corner + v]
                quad = quad if side else quad[::-1]
                faces += [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
        return edge * numpy.array(faces) + 7.0

    def test_mean_chord(self):
        """4 V / A: two thirds of the edge of a cube."""
        self.assertAlmostEqual(meshes.mean_chord(self.cube(3.0)), 2.0)
        self.assertEqual(meshes.mean_chord(self.cube(3.0)[:-1]), 0)


class Facts(unittest.TestCase):
    def test_shadow_settings_of_blender(self):
        cycles = types.SimpleNamespace
        self.assertFalse(objects.casts_shadow(cycles(cycles=cycles(cast_shadow=False), use_shadow=True)))
        self.assertFalse(objects.casts_shadow(cycles(use_shadow=False)))
        self.assertTrue(objects.casts_shadow(cycles()))

    def test_colour_of_a_lamp_by_its_temperature(self):
        lamp = types.SimpleNamespace(color=(1.0, 0.5, 0.25))
        self.assertEqual(objects.lamp_colour(lamp), [1.0, 0.5, 0.25])
        lamp.use_temperature, lamp.temperature_color = True, (1.0, 0.5, 0.0)
        self.assertEqual(objects.lamp_colour(lamp), [1.0, 0.25, 0.0])
        lamp.use_temperature = False
        self.assertEqual(objects.lamp_colour(lamp), [1.0, 0.5, 0.25])

    def test_lights_without_a_group_have_a_pass(self):
        chosen = layers.passes(set(), ["key", "sky"])
        self.assertEqual([one.name for one in chosen], ["Combined", "Combined_key", "Combined_sky", "Combined_rest"])
        self.assertEqual(layers.layer_tables(chosen), [{"name": "alpha"}, {"name": "lights"}])
        self.assertEqual([one.name for one in layers.passes(set())], ["Combined"])
        self.assertEqual(len(layers.passes(set(), ["rest"])), 2)


class Files(InTempFolder):
    def test_ply_is_read_by_vdbeam(self):
        corners = numpy.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0], [1, 1, 0], [0, 1, 0]], numpy.float32)
        normals = numpy.tile(numpy.float32([0, 0, 1]), (6, 1))
        name = meshes.write(self.folder.name, "a b/c.##", meshes.ply_bytes(corners, normals, corners[:, :2]))
        self.assertRegex(name, r"^a_b_c____[0-9a-f]{12}\.ply$")
        self.assertEqual(meshes.write(self.folder.name, "a b/c.##", meshes.ply_bytes(corners, normals, corners[:, :2])),
                         name)
        text = subprocess.run([BINARY, "info", self.file(name)], capture_output=True, text=True, check=True).stdout
        self.assertRegex(text, r"triangles\s+2\b")
        self.assertRegex(text, r"(?i)uv\s+.*0.*1")

    def test_box(self):
        corners = [(x, y, z) for x in (0, 2) for y in (-1, 1) for z in (3, 5)]
        self.assertEqual(meshes.box_of(corners), ([0, -1, 3], [2, 1, 5]))
        self.assertIsNone(meshes.box_of(corners[:7] + [(2, 1, 5.5)]))

    def test_exr_of_every_compression(self):
        """The reader finds what vdbeam wrote; the writer's file is read by vdbeam."""
        scene = str(DATA / "cloud.toml")
        planes = {}
        for compression in ("none", "zip", "zips", "rle"):
            path = self.file(f"{compression}.exr")
            subprocess.run([BINARY, "render", scene, "-o", path, "--passes", "1", "--resolution", "48x27", "-q", "--set",
                            "render.photons=2000", "--set", f"image.compression={compression}"], check=True)
            planes[compression], window = exr.read(path)
            self.assertEqual(window, (0, 0, 47, 26))
        for compression, found in planes.items():
            self.assertEqual(set(found), set(planes["none"]))
            for name, plane in found.items():
                self.assertTrue(numpy.array_equal(plane, planes["none"][name]), (compression, name))
        exr.write(self.file("own.exr"), {name: planes["none"][name] for name in "RGB"})
        compare = subprocess.run([BINARY, "compare", self.file("own.exr"), self.file("zip.exr"), "--json"],
                                 capture_output=True, text=True, check=True)
        self.assertEqual(json.loads(compare.stdout)["rmse"], 0)

    def test_damaged_exr(self):
        for data, text in ((b"no", "truncated"), (b"\0" * 64, "not an EXR")):
            pathlib.Path(self.file("x.exr")).write_bytes(data)
            with self.assertRaisesRegex(exr.ExrError, text):
                exr.read(self.file("x.exr"))


class Passes(unittest.TestCase):
    def test_names_and_signs(self):
        chosen = layers.passes({"depth", "vector", "volume"}, ["key"])
        self.assertEqual([one.name for one in chosen],
                         ["Combined", "Depth", "Vector", "VolumeDir", "VolumeInd", "Combined_key", "Combined_rest"])
        self.assertEqual([table["name"] for table in layers.layer_tables(chosen)],
                         ["alpha", "depth", "motion", "volume_direct", "volume_indirect", "lights"])
        planes = {"R": numpy.full((1, 2), 3, numpy.float32), "motion.X": numpy.ones((1, 2), numpy.float32)}
        found = layers.planes_for_blender(planes, chosen, "Layer")
        self.assertEqual(found["Layer.Combined.R"].tolist(), [[3, 3]])
        self.assertEqual(found["Layer.Vector.Z"].tolist(), [[-1, -1]])
        self.assertEqual(found["Layer.Depth.Z"].tolist(), [[0, 0]])


if __name__ == "__main__":
    unittest.main()
