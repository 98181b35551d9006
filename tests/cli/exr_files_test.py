#!/usr/bin/env python3
"""Parts, tiles, names, compression and attributes of EXRs, as other programs read them."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import BINARY, DATA, InTempFolder, run

SCENE = DATA / "sunlit_cloud.toml"
LAYERS = ("layer.0.name=alpha", "layer.1.name=volume_direct", "layer.2.name=depth", "layer.3.name=position")


class ExrFiles(InTempFolder):
    def render(self, name, *settings, expect=0):
        options = [option for setting in (*LAYERS, *settings) for option in ("--set", setting)]
        code, text = run(BINARY, "render", str(SCENE), "-o", self.file(name), "--resolution", "40x24", "--passes",
                         "2", "--set", "render.estimator=path", *options)
        self.assertEqual(code, expect, text)
        return text

    def info(self, name):
        # The exit code of OpenEXR 3.1.5's exrinfo is chance where the file is good: it is never set.
        _, text = run("exrinfo", "-v", self.file(name))
        self.assertIn("File '", text)
        self.assertNotIn("ERROR", text)
        return text

    def test_a_part_for_each_layer(self):
        self.render("one.exr")
        self.render("parts.exr", "image.parts=layers", "layer.2.compression=zips", "layer.3.compression=piz")
        code, text = run("oiiotool", "-a", "--info", self.file("parts.exr"))
        self.assertEqual(code, 0, text)
        self.assertIn("4 subimages", text)
        info = self.info("parts.exr")
        for part in ("rgba", "volume_direct", "depth", "position"):
            self.assertIn(f"'{part}'", info)
        for compression in ("zips", "piz", "zip"):
            self.assertIn(f"'{compression}'", info.lower())
        # Pixel for pixel those of the file with one part.
        for channels in ("R,G,B,A", "volume_direct.R", "depth.Z", "position.X,position.Y,position.Z"):
            part = {"R": 0, "v": 1, "d": 2, "p": 3}[channels[0]]
            code, text = run("oiiotool", self.file("one.exr"), "--ch", channels, "-a", self.file("parts.exr"),
                             "--subimage", str(part), "--ch", channels, "--fail", "0", "--diff")
            self.assertEqual(code, 0, text)
        code, text = run(BINARY, "compare", self.file("one.exr"), self.file("parts.exr"))
        self.assertEqual(code, 0, text)

    def test_tiles(self):
        self.render("lines.exr")
        for more in ((), ("image.parts=layers",)):
            self.render("tiles.exr", "image.tile=16", *more)
            self.assertIn("16", self.info("tiles.exr"))
            code, text = run("oiiotool", "-v", "--info", self.file("tiles.exr"))
            self.assertEqual(code, 0, text)
            self.assertIn("tile size: 16 x 16", text)
            code, text = run("oiiotool", self.file("lines.exr"), "--ch", "R,G,B,A", self.file("tiles.exr"),
                             "--subimage", "0", "--ch", "R,G,B,A", "--fail", "0", "--diff")
            self.assertEqual(code, 0, text)

    def test_names_of_other_renderers(self):
        for renderer, names in (("arnold", ("R", "A", "volume_direct.R", "Z", "P.X")),
                                ("cycles", ("ViewLayer.Combined.R", "ViewLayer.Combined.A", "ViewLayer.VolumeDir.R",
                                            "ViewLayer.Depth.Z", "ViewLayer.Position.X"))):
            self.render("named.exr", f"image.layer_names={renderer}")
            code, text = run("oiiotool", "-v", "--info", self.file("named.exr"))
            self.assertEqual(code, 0, text)
            channels = text[text.index("channel list:"):].splitlines()[0]
            for name in names:
                self.assertRegex(channels, rf"[ :]{name.replace('.', '[.]')}[ ,]")
            self.assertNotIn("depth.Z", channels)
        self.render("plain.exr")
        code, text = run(BINARY, "compare", self.file("named.exr"), self.file("plain.exr"))
        self.assertEqual(code, 0, text)

    def test_attributes_and_time_code(self):
        self.render("a.exr", "image.fps=24", "image.time_code=01:00:00:00", "image.attributes=shot = 010; artist=A B")
        code, text = run("oiiotool", "-v", "--info", self.file("a.exr"))
        self.assertEqual(code, 0, text)
        self.assertIn('shot: "010"', text)
        self.assertIn('artist: "A B"', text)
        self.assertIn("01:00:00:01", text)

    def test_merged_parts_are_written_alike(self):
        options = ("--resolution", "40x24", "--set", "render.estimator=path")
        settings = (*LAYERS, "image.parts=layers", "image.layer_names=arnold", "layer.3.compression=zips")
        for name, passes in (("p.exr", "0-1"), ("q.exr", "2-3")):
            code, text = run(BINARY, "render", str(SCENE), "-o", self.file(name), "--pass-range", passes, *options,
                             *[option for setting in settings for option in ("--set", setting)])
            self.assertEqual(code, 0, text)
        code, text = run(BINARY, "merge", "-o", self.file("m.exr"), self.file("p.exr"), self.file("q.exr"))
        self.assertEqual(code, 0, text)
        info = self.info("m.exr")
        self.assertIn("'zips'", info.lower())
        self.assertIn("P.X", info)

    def test_what_is_wrong(self):
        for setting, line in (("layer.2.compression=zips", 'layer.2.compression needs image.parts = "layers"'),
                              ("image.time_code=01:00:00:00", "image.time_code needs image.fps, of at most 30"),
                              ("image.attributes=channels=1", 'image.attributes must not name "channels"'),
                              ("image.attributes=abc", 'image.attributes must be "name = text; name = text"')):
            self.assertIn(line, self.render("x.exr", setting, expect=2))


if __name__ == "__main__":
    unittest.main()
