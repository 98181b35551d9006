#!/usr/bin/env python3
"""Frames that do not fit into the memory granted are refused before it is spent, and none is read ahead that does not
fit beside the one before it."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from memory_peak import run_measured
from program import BINARY, DATA, InTempFolder, run

TOOLS = Path(os.environ.get("VDBEAM_BUILD", "build/release")) / "tools"
MIB = 2**20


def granting(mib):
    return dict(os.environ, SLURM_MEM_PER_NODE=str(mib))


class MemoryLimits(InTempFolder):
    @classmethod
    def setUpClass(cls):
        cls.volumes = tempfile.TemporaryDirectory(prefix="vdbeam_volumes_")
        cls.addClassCleanup(cls.volumes.cleanup)
        for size in (32, 256):
            subprocess.run([str(TOOLS / "make_volumes"), "ramp", f"{cls.volumes.name}/{size}.vdb", "--size", str(size)],
                           check=True, capture_output=True)

    def make(self, sizes):
        """A scene of a volume for each frame, by its width in voxels."""
        for number, size in enumerate(sizes, 1):
            shutil.copy(f"{self.volumes.name}/{size}.vdb", self.file(f"v.{number:04}.vdb"))
        scene = Path(self.file("v.toml"))
        scene.write_text('[camera]\nposition = [0, 0, -3]\nlook_at = [0, 0, 0]\n'
                         '[[volume]]\nfile = "v.####.vdb"\nextinction = 5\nalbedo = [0, 0, 0]\n'
                         '[[light]]\ntype = "environment"\n[render]\nestimator = "path"\npasses = 1\n', encoding="utf-8")
        return str(scene)

    def render(self, scene, output, *options, env=None):
        return run_measured(BINARY, "render", scene, "-o", self.file(output), "--resolution", "32x32", *options, env=env)

    def test_refused_in_one_line_and_the_others_go_on(self):
        scene = self.make([32, 256, 32])
        code, text, peak = self.render(scene, "o.####.exr", "-f", "1-3", env=granting(100))
        self.assertEqual(code, 3, text)
        refused = [line for line in text.splitlines() if "grants" in line]
        self.assertTrue(refused and all("v.0002.vdb" in line and "box_lower" in line for line in refused), text)
        self.assertTrue(Path(self.file("o.0001.exr")).exists() and Path(self.file("o.0003.exr")).exists())
        self.assertFalse(Path(self.file("o.0002.exr")).exists())
        self.assertLess(peak, 100 * MIB)

    def test_deep_samples_are_refused_before_they_are_made(self):
        code, text, peak = run_measured(
            BINARY, "render", str(DATA / "cloud.toml"), "-o", self.file("o.exr"), "--resolution", "1280x720",
            "--set", "image.deep=true", "--set", "image.deep_alpha=0.001", env=granting(1024))
        self.assertEqual(code, 2, text)
        self.assertIn("image.deep", text)
        self.assertLess(peak, 200 * MIB)

    def test_next_frame_waits_where_two_do_not_fit(self):
        scene = self.make([256, 256, 256])
        code, text, free = self.render(scene, "free.####.exr", "-f", "1-3")
        self.assertEqual(code, 0, text)
        code, text, single = self.render(scene, "single.exr", "-f", "1")
        self.assertEqual(code, 0, text)
        limit = 1.2 * single
        self.assertGreater(free, limit)
        code, text, peak = self.render(scene, "o.####.exr", "-f", "1-3", env=granting(int(limit / MIB)))
        self.assertEqual(code, 0, text)
        self.assertLess(peak, limit)
        for frame in ("0001", "0002", "0003"):
            code, text = run(BINARY, "compare", self.file(f"o.{frame}.exr"), self.file(f"free.{frame}.exr"), "--json")
            self.assertEqual(code, 0, text)
            self.assertIn('"rmse": 0.0', text)


if __name__ == "__main__":
    unittest.main()
