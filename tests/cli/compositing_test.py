#!/usr/bin/env python3
"""Images as compositing programs read them: hidden lights, premultiplied RGBA, layers, attributes."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BINARY = os.environ.get("VDBEAM_BINARY", "build/release/vdbeam")
SCENE = Path(__file__).resolve().parents[2] / "data/cloud.toml"
SKY = "0.25,0.25,0.25"  # of the scene
SIZE = "48x27"
LAYERS = ["volume", "volume_direct", "volume_indirect", "depth"]


def run(*command):
    result = subprocess.run(command, check=False, capture_output=True, text=True)
    return result.returncode, result.stdout + result.stderr


class Compositing(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, name):
        return str(Path(self.folder.name) / name)

    def render(self, name, *options):
        code, text = run(BINARY, "render", str(SCENE), "-o", self.file(name), "--resolution", SIZE,
                         "--passes", "2", *options)
        self.assertEqual(code, 0, text)
        return self.file(name)

    def test_hidden_sky_goes_over_any_plate(self):
        for estimator in ("beam", "path"):
            with self.subTest(estimator):
                element = self.render("element.exr", "--estimator", estimator,
                                      "--set", "light.1.visible=false")
                truth = self.render("truth.exr", "--estimator", estimator)
                code, text = run("oiiotool", element, "--ch", "R,G,B,A", "--pattern",
                                 f"constant:color={SKY},1", SIZE, "4", "--over", "-o", self.file("comp.exr"))
                self.assertEqual(code, 0, text)
                limits = ("oiiotool", "--fail", "0.001", "--failpercent", "0", "--hardfail", "0.002")
                # --diff comes last: it compares as soon as there are two images.
                code, text = run(*limits, self.file("comp.exr"), "--ch", "R,G,B", truth, "--ch", "R,G,B", "--diff")
                self.assertEqual(code, 0, text)
                code, text = run(*limits, element, "--ch", "R,G,B", truth, "--ch", "R,G,B", "--diff")
                self.assertNotEqual(code, 0, "the sky is not hidden at all")
                code, text = run(*limits, element, "--ch", "R,G,B,A", element, "--ch",
                                 "volume.R,volume.G,volume.B,volume.A", "--chnames", "R,G,B,A", "--diff")
                self.assertEqual(code, 0, text)

    def test_attributes_have_the_types_that_others_expect(self):
        image = self.render("shot.exr", "--set", "image.fps=24")
        code, text = run("oiiotool", "--info", "-v", image)
        self.assertEqual(code, 0, text)
        for line in ("vdbeam:frame: 1\n", "vdbeam:passes: 2\n", "vdbeam:complete: 1\n", "vdbeam:cameraFov: 24\n",
                     "vdbeam:cameraPosition: 0.3, 1.2, 7", "framesPerSecond: 24/1", "smpte:TimeCode: 00:00:00:01",
                     f'vdbeam:scene: "{SCENE}"'):
            self.assertIn(line, text)

    @unittest.skipUnless(shutil.which("blender"), "Blender is not installed")
    def test_blender_shows_every_layer(self):
        image = self.render("shot.exr")
        script = ("import bpy; s = bpy.context.scene; s.use_nodes = True; "
                  "n = s.node_tree.nodes.new('CompositorNodeImage'); "
                  f"n.image = bpy.data.images.load({image!r}); "
                  "print('outputs:', ' '.join(o.name for o in n.outputs))")
        _, text = run("blender", "-b", "--factory-startup", "--python-expr", script)
        outputs = [line.split()[1:] for line in text.splitlines() if line.startswith("outputs:")]
        self.assertEqual(len(outputs), 1, text)
        for layer in LAYERS:
            self.assertIn(layer, outputs[0])
        self.assertNotIn("unknown channel", text)


if __name__ == "__main__":
    if shutil.which("oiiotool") is None:
        print("oiiotool (Debian's openimageio-tools) is not installed")
        sys.exit(77)
    unittest.main()
