#!/usr/bin/env python3
"""The comp template for Blender's compositor: its nodes for the layers of an image, and what it renders. Skipped without
Blender."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

FILE = os.path.abspath(__file__)
sys.path.insert(0, os.path.dirname(FILE))

import blender_runner  # noqa: E402

ROOT = pathlib.Path(FILE).resolve().parents[2]
sys.path[:0] = [str(ROOT / "data" / "comp"), str(ROOT / "tools" / "blender")]

if blender_runner.inside_blender():
    import blender_comp
    import bpy
    import numpy
    from vdbeam_blender import exr

SHOT = """
[image]
width = 32
height = 24
layer_names = "NAMES"
[camera]
position = [0, 2, 6]
[[volume]]
shape = "sphere"
extinction = 2
[[light]]
type = "distant"
direction = [0.5, -1, -0.2]
irradiance = [2, 1.5, 1]
[[light]]
type = "environment"
radiance = [0.2, 0.3, 0.5]
visible = false
[[mesh]]
type = "plane"
rotate = [-90, 0, 0]
translate = [0, -1.2, 0]
material = { type = "shadow_catcher", albedo = [0.5, 0.4, 0.3] }
[render]
passes = 2
"""


class Comp(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.scene = bpy.context.scene

    def shot(self, *layers, names="vdbeam"):
        """Renders the shot with these layers; returns the path of its image."""
        scene = self.folder / "shot.toml"
        scene.write_text(SHOT.replace("NAMES", names) + "".join(f'[[layer]]\nname = "{layer}"\n' for layer in layers))
        path = self.folder / "shot.exr"
        subprocess.run([os.environ["VDBEAM_BINARY"], "render", scene, "-q", "-o", path], check=True)
        return str(path)

    def kinds(self):
        return [node.bl_idname.removeprefix("CompositorNode") for node in self.scene.node_tree.nodes]

    def test_shadow_and_added_light(self):
        shot = self.shot("alpha", "shadow", "catcher_light")
        plate = str(self.folder / "plate.exr")
        rows = numpy.linspace(0.1, 0.9, 24, dtype=numpy.float32)[:, None] * numpy.ones((1, 32), numpy.float32)
        exr.write(plate, {"R": rows, "G": rows / 2, "B": rows / 4, "A": numpy.ones_like(rows)})
        blender_comp.build(self.scene, shot, plate)
        self.scene.render.image_settings.file_format = "OPEN_EXR"
        self.scene.render.image_settings.color_depth = "32"
        self.scene.render.image_settings.exr_codec = "ZIP"
        self.scene.render.filepath = str(self.folder / "comp.exr")
        bpy.ops.render.render(write_still=True)
        comp, _ = exr.read(self.scene.render.filepath)
        parts, _ = exr.read(shot)
        behind, _ = exr.read(plate)
        for channel in "RGB":
            wanted = behind[channel] * parts["shadow." + channel] + parts[channel] + parts["catcher_light." + channel]
            numpy.testing.assert_allclose(comp[channel], wanted, atol=1e-5)
        self.assertGreater(parts["shadow.B"].max(), 0.99)
        self.assertLess(parts["shadow.R"].min(), 0.5)

    def test_the_denoiser_gets_its_layers(self):
        for names in ("vdbeam", "cycles"):
            shot = self.shot("alpha", "denoising_albedo", "denoising_normal", names=names)
            if "shot.exr" in bpy.data.images:
                bpy.data.images.remove(bpy.data.images["shot.exr"])
            blender_comp.build(self.scene, shot)
            self.assertEqual(self.kinds(), ["Image", "Denoise", "Composite", "Viewer"], names)
            denoise = self.scene.node_tree.nodes["Denoise"]
            self.assertTrue(all(denoise.inputs[name].is_linked for name in ("Image", "Albedo", "Normal")))

    def test_without_layers_it_is_an_over(self):
        shot = self.shot("alpha")
        blender_comp.build(self.scene, shot, shot)
        self.assertEqual(self.kinds(), ["Image", "Image", "AlphaOver", "Composite", "Viewer"])
        self.assertTrue(all(link.is_valid for link in self.scene.node_tree.links))


if __name__ == "__main__":
    blender_runner.main(FILE)
