#!/usr/bin/env python3
"""Deep pictures as other programs read them: OpenImageIO flattens them to the flat picture."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import BINARY, DATA, InTempFolder, run

SCENE = DATA / "sunlit_cloud.toml"
LIMITS = ("oiiotool", "--fail", "0.002", "--failpercent", "0", "--hardfail", "0.006")


class Deep(InTempFolder):
    def render(self, name, *options):
        code, text = run(BINARY, "render", str(SCENE), "-o", self.file(name), "--resolution", "48x24",
                         "--set", "image.deep=true", *options)
        self.assertEqual(code, 0, text)

    def expect_same(self, flat, deep):
        code, text = run("oiiotool", self.file(deep), "--flatten", "--ch", "R,G,B,A", "-o", self.file("flattened.exr"))
        self.assertEqual(code, 0, text)
        code, text = run(*LIMITS, self.file("flattened.exr"), self.file(flat), "--ch",
                         "volume.R,volume.G,volume.B,volume.A", "--chnames", "R,G,B,A", "--diff")
        self.assertEqual(code, 0, text)

    def test_flattens_to_the_flat_picture(self):
        self.render("a.exr", "--passes", "4", "--report", self.file("a.json"))
        self.expect_same("a.exr", "a.deep.exr")
        report = Path(self.file("a.json")).read_text(encoding="utf-8")
        for key in ('"samples"', '"bytes"', '"alpha_error"'):
            self.assertIn(key, report)

    def test_partial_renders_merge(self):
        self.render("p.exr", "--pass-range", "0-1")
        self.render("q.exr", "--pass-range", "2-3")
        self.assertFalse(Path(self.file("p.deep.exr")).exists())
        code, text = run(BINARY, "merge", "-o", self.file("m.exr"), self.file("p.exr"), self.file("q.exr"))
        self.assertEqual(code, 0, text)
        self.expect_same("m.exr", "m.deep.exr")

    def test_opaque_object_in_the_cloud(self):
        """A deep object over which our own samples lie, by OpenImageIO, is what a far plane leaves."""
        common = ("--passes", "24", "--set", "volume.0.extinction=12", "--set", "image.deep_alpha=0.02")
        self.render("whole.exr", *common)
        self.render("near.exr", *common, "--set", "camera.far=6.5")
        code, text = run("oiiotool", self.file("near.exr"), "--ch", "R=0,G=0,B=0,A=1,Z=6.5,ZBack=6.5",
                         "--deepen", "-o", self.file("object.exr"))
        self.assertEqual(code, 0, text)
        code, text = run("oiiotool", self.file("whole.deep.exr"), self.file("object.exr"), "--deepmerge", "--flatten",
                         "--ch", "R,G,B", "-o", self.file("composed.exr"))
        self.assertEqual(code, 0, text)
        code, text = run("oiiotool", self.file("near.exr"), "--ch", "volume.R,volume.G,volume.B", "--chnames", "R,G,B",
                         "-o", self.file("expected.exr"))
        self.assertEqual(code, 0, text)
        code, text = run(BINARY, "compare", self.file("composed.exr"), self.file("expected.exr"))
        self.assertEqual(code, 0, text)
        bias = [line for line in text.splitlines() if "bias" in line]
        self.assertTrue(bias, text)
        self.assertLess(abs(float(bias[0].split()[1].rstrip("%"))), 4, text)


if __name__ == "__main__":
    unittest.main()
