#!/usr/bin/env python3
"""Images as compositing programs read them: hidden lights, premultiplied RGBA, layers, attributes."""
import re
import shutil
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import BINARY, DATA, InTempFolder, run

SCENE = DATA / "cloud.toml"
SKY = "0.25,0.25,0.25"  # of the scene
SIZE = "48x27"
LAYERS = ["volume", "volume_direct", "volume_indirect", "depth"]


# A cloud before and behind a ball, over a ground.
MESHES = """
[camera]
position = [0.3, 1.2, 7.0]
look_at = [0.02, 0.3, 0.0]
fov = 28
[[volume]]
file = "{cloud}"
extinction = 10
albedo = {albedo}
[[mesh]]
type = "sphere"
scale = 0.4
translate = [0.1, 0.5, 0.1]
material = {ball}
[[mesh]]
type = "quad"
scale = 20
rotate = [-90, 0, 0]
translate = [0, -0.8, 0]
visible = {ground_visible}
material = {{ type = "{ground}", albedo = 0.5 }}
[[light]]
type = "distant"
direction = [-0.35, -0.86, -0.34]
irradiance = 5
[[light]]
type = "environment"
radiance = {sky}
visible = {sky_visible}
"""


class Compositing(InTempFolder):
    passes = 2

    def render(self, name, *options, scene=SCENE):
        code, text = run(BINARY, "render", str(scene), "-o", self.file(name), "--resolution", SIZE,
                         "--set", f"render.passes={self.passes}", *options)
        self.assertEqual(code, 0, text)
        return self.file(name)

    def render_meshes(self, name, *options, **values):
        values = {"cloud": SCENE.parent / "cloud.vdb", "albedo": "0.9", "ball": "{ type = 'diffuse', albedo = 0 }", "ground": "diffuse",
                  "ground_visible": "true", "sky": "0.3", "sky_visible": "true"} | values
        scene = Path(self.file(name + ".toml"))
        scene.write_text(MESHES.format(**values), encoding="utf-8")
        return self.render(name, *options, scene=scene)

    def assert_over(self, element, plate, truth, estimator):
        """The element over the plate is the picture of everything, in every pixel but on edges."""
        code, text = run("oiiotool", element, "--ch", "R,G,B,A", plate, "--ch", "R,G,B,A=1", "--over",
                         "-o", self.file("comp.exr"))
        self.assertEqual(code, 0, text)
        rms = lambda image: float(re.search(r"RMS error = (\S+)", run(
            "oiiotool", image, "--ch", "R,G,B", truth, "--ch", "R,G,B", "--diff")[1]).group(1))
        self.assertLess(rms(self.file("comp.exr")), 0.01, estimator)
        self.assertGreater(rms(plate), 0.05, "the cloud is in the plate already")

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

    def test_smoke_around_a_holdout_goes_over_a_plate_with_the_object(self):
        for estimator in ("beam", "path"):
            with self.subTest(estimator):
                options = ("--estimator", estimator)
                # The ground, which the camera does not see in any, lights all three alike.
                values = {"ground_visible": "false"}
                element = self.render_meshes("element.exr", *options, ball='"holdout"', sky_visible="false", **values)
                plate = self.render_meshes("plate.exr", *options, "--set", "volume.0.extinction=0", **values)
                truth = self.render_meshes("truth.exr", *options, **values)
                self.assert_over(element, plate, truth, estimator)

    def test_a_shadow_catcher_darkens_the_ground_of_a_plate(self):
        self.passes = 4  # the bare plate has one ray where the others, on the edge of the shadow, have four
        for estimator in ("beam", "path"):
            with self.subTest(estimator):
                # A cloud that only absorbs, in the sun alone: what it adds is shadow.
                options = ("--estimator", estimator)
                values = {"albedo": "0", "sky": "0"}
                element = self.render_meshes("element.exr", *options, ground="shadow_catcher", **values)
                truth = self.render_meshes("truth.exr", *options, **values)
                # A photograph of the ground: nothing stands on it.
                plate = self.render_meshes("bare.exr", *options, "--set", "volume.0.extinction=0",
                                           "--set", "mesh.0.translate=[0, 500, 0]", **values)
                self.assert_over(element, plate, truth, estimator)

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
