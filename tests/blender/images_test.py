#!/usr/bin/env python3
"""Images of Blender as textures and environments: files, packed and generated ones. Skipped without Blender."""
import os
import pathlib
import sys
import tempfile
import unittest

FILE = os.path.abspath(__file__)
sys.path.insert(0, os.path.dirname(FILE))

import blender_runner  # noqa: E402

if blender_runner.inside_blender():
    import bpy
    import numpy
    import scenes
    from vdbeam_blender import exr, images, notes, read_scene


def image(name, width=8, height=4, alpha=False, floats=False):
    """A new image whose pixels all differ, and these pixels from the top on."""
    made = bpy.data.images.new(name, width, height, alpha=alpha, float_buffer=floats)
    codes = (numpy.arange(width * height * 4) * 37 % 256).reshape(height, width, 4)
    pixels = (codes / 255 * (4 if floats else 1)).astype(numpy.float32)
    if not alpha:
        pixels[..., 3] = 1
    made.pixels.foreach_set(pixels[::-1].ravel())
    made.update()
    return made, pixels


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def saved(self, name, kind):
        """An image that was loaded from a file of this kind."""
        made, _ = image(name)
        made.filepath_raw, made.file_format = str(self.folder / name), kind
        made.save()
        bpy.data.images.remove(made)
        return bpy.data.images.load(str(self.folder / name))


class Files(InFolder):
    def path(self, of):
        """The file of an image within the folder, or None."""
        name = images.file_of(of, str(self.folder), bpy.path.abspath)
        return None if name is None else self.folder / name

    def pixels(self, path):
        """The pixels of a file as Blender loads it, from the top on."""
        loaded = bpy.data.images.load(str(path))
        values = numpy.empty(len(loaded.pixels), numpy.float32)
        loaded.pixels.foreach_get(values)
        return values.reshape(loaded.size[1], loaded.size[0], -1)[::-1]

    def test_files_that_vdbeam_reads_are_used_where_they_are(self):
        for name, kind in (("a.png", "PNG"), ("a.jpg", "JPEG"), ("a.jpeg", "JPEG"), ("a.exr", "OPEN_EXR"),
                           ("a.hdr", "HDR")):
            self.assertEqual(self.path(self.saved(name, kind)), self.folder / name)
        other = self.path(self.saved("a.tif", "TIFF"))
        self.assertEqual(other.suffix, ".png")
        self.assertTrue(numpy.array_equal(self.pixels(other), self.pixels(self.folder / "a.tif")))

    def test_packed_files_are_copied(self):
        for name, kind in (("b.jpg", "JPEG"), ("b.exr", "OPEN_EXR")):
            packed = self.saved(name, kind)
            data = (self.folder / name).read_bytes()
            packed.pack()
            (self.folder / name).unlink()
            found = self.path(packed)
            self.assertEqual((found.suffix, found.read_bytes()), (pathlib.Path(name).suffix, data))
            self.assertEqual(self.path(packed), found)

    def test_generated_images_are_written_by_their_depth(self):
        for alpha in (False, True):
            made, pixels = image("codes", alpha=alpha)
            found = self.path(made)
            self.assertEqual(found.suffix, ".png")
            self.assertLess(numpy.abs(self.pixels(found) - pixels).max(), 1e-6, alpha)
            made, pixels = image("floats", alpha=alpha, floats=True)
            planes, _ = exr.read(self.path(made))
            self.assertEqual(sorted(planes), sorted("RGBA" if alpha else "RGB"))
            for index, letter in enumerate("RGB"):
                self.assertTrue(numpy.array_equal(planes[letter], pixels[..., index]), letter)

    def test_painted_pixels_count(self):
        painted = self.saved("c.png", "PNG")
        before = self.path(painted)
        painted.pixels[0] = 1 - painted.pixels[0]
        after = self.path(painted)
        self.assertEqual((before.name, after.suffix), ("c.png", ".png"))
        self.assertNotEqual(before, after)

    def test_what_is_no_image_has_no_file(self):
        self.assertIsNone(self.path(None))
        gone = self.saved("d.tif", "TIFF")
        gone.filepath = str(self.folder / "gone.tif")
        self.assertIsNone(self.path(gone))
        self.assertIsNone(self.path(bpy.data.images.new("tiles", 8, 8, tiled=True)))


class Scenes(InFolder):
    def textured(self, picture, output="Color", name="Color"):
        """A plane with an image under an environment image, and the material's tree."""
        scene = scenes.empty_scene()
        scenes.add_camera(scene, (0, 0, 5), (0, 0, 0))
        plane = scenes.add_plane(scene, 1)
        plane.data.uv_layers.new()
        tree = plane.data.materials[0].node_tree
        shader = next(node for node in tree.nodes if node.type.startswith("BSDF"))
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = picture
        tree.links.new(texture.outputs[output], shader.inputs[name])
        world, background = scenes.set_world(scene, (0, 0, 0))
        around = world.nodes.new("ShaderNodeTexEnvironment")
        around.image = picture
        world.links.new(around.outputs[0], background.inputs["Color"])
        return scene

    def exported(self, scene):
        """The tables of a scene, and the notes."""
        found = notes.Notes()
        reader = read_scene.SceneReader(read_scene.Options(str(self.folder), bpy.path.abspath, 32, 18), found)
        return reader.read(bpy.context.evaluated_depsgraph_get(), 1.0), found.lines

    def test_an_image_is_texture_and_environment(self):
        packed = self.saved("e.jpg", "JPEG")
        packed.pack()
        generated, _ = image("made")
        for picture in (self.saved("f.jpg", "JPEG"), packed, generated):
            scene = self.textured(picture)
            tables, lines = self.exported(scene)
            file = tables["mesh"][0]["material"]["texture"]
            self.assertEqual(tables["light"][0]["image"], file)
            self.assertTrue((self.folder / file).is_file())
            self.assertEqual(lines, [])
            scene.render.resolution_x, scene.render.resolution_y = 32, 18
            self.assertGreater(scenes.combined(scenes.render(scene, self.folder / "image.exr")).min(), 0)

    def test_what_is_left_out_is_noted(self):
        gone = self.saved("g.png", "PNG")
        gone.filepath = str(self.folder / "gone.png")
        tables, lines = self.exported(self.textured(gone))
        self.assertNotIn("light", tables)
        self.assertEqual(tables["mesh"][0]["material"], {"type": "diffuse", "albedo": [0.5] * 3})
        self.assertEqual(len([line for line in lines if "its file is missing" in line]), 2)

    def test_alpha_of_an_image_without_one(self):
        scene = self.textured(self.saved("h.jpg", "JPEG"))
        material = bpy.data.materials.new("leaf")
        scenes.shader(material, "ShaderNodeBsdfPrincipled")
        scene.objects["plane"].data.materials[0] = material
        shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
        texture = material.node_tree.nodes.new("ShaderNodeTexImage")
        material.node_tree.links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
        for picture, expected in ((bpy.data.images["h.jpg"], None), (image("leaf", alpha=True)[0], ".png")):
            texture.image = picture
            file = self.exported(scene)[0]["mesh"][0]["material"].get("opacity_texture")
            self.assertEqual(file and pathlib.Path(file).suffix, expected)


if __name__ == "__main__":
    blender_runner.main(FILE)
