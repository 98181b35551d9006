#!/usr/bin/env python3
"""View layers and renders one after the other inside Blender: what each of them leaves to the next. Skipped without
Blender."""
import glob
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import types
import unittest

FILE = os.path.abspath(__file__)
sys.path.insert(0, os.path.dirname(FILE))

import blender_runner  # noqa: E402

if blender_runner.inside_blender():
    import bpy
    import numpy
    import scenes
    from vdbeam_blender import engine, exr, notes, read_scene, temp_folder, view_engine, viewport


def plain_scene():
    """A plane under a constant world, small enough to be rendered often."""
    scene = scenes.empty_scene()
    scenes.add_camera(scene, (0, -5, 5), (0, 0, 0))
    scenes.add_plane(scene)
    scenes.set_world(scene, (0.5, 0.5, 0.5))
    scene.render.resolution_x, scene.render.resolution_y = 32, 18
    scene.vdbeam.passes = 1
    return scene


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.path = self.folder / "image.exr"

    def replace(self, owner, name, value):
        """Sets an attribute until the test ends."""
        self.addCleanup(setattr, owner, name, getattr(owner, name))
        setattr(owner, name, value)


class ViewLayers(InFolder):
    def second_layer(self, scene):
        """Adds a view layer until the test ends."""
        layer = scene.view_layers.new("second")
        self.addCleanup(scene.view_layers.remove, layer)
        return layer

    def planes(self, scene):
        """The planes of a render, by view layer and pass."""
        scene.render.filepath = str(self.path)
        bpy.ops.render.render(write_still=True)
        return exr.read(self.path)[0]

    def test_every_view_layer_is_kept(self):
        scene = plain_scene()
        second = self.second_layer(scene)
        second.use_pass_z = True
        planes = self.planes(scene)
        first = scene.view_layers[0].name
        for letter in "RGB":
            self.assertGreater(planes[f"{first}.Combined.{letter}"].min(), 0.1)
            self.assertTrue(numpy.array_equal(planes[f"{first}.Combined.{letter}"], planes[f"second.Combined.{letter}"]))
        self.assertGreater(planes["second.Depth.Z"].max(), 5)
        self.assertNotIn(f"{first}.Depth.Z", planes)

    def test_data_for_denoisers(self):
        """By the setting of vdbeam or by that of Cycles. A soft shadow, aside, has noise; the normals point up."""
        scene = plain_scene()
        scenes.add_plane(scene, 0.5, location=(-1.5, 0, 1))
        scenes.add_lamp(scene, "SUN", 3, angle=0.5)
        layer = scene.view_layers[0]
        layer.vdbeam.denoising_data = layer.vdbeam.error = True
        scene.vdbeam.passes = 8
        planes = self.planes(scene)
        name = layer.name
        layer.vdbeam.denoising_data = layer.vdbeam.error = False
        self.assertLess(abs(planes[f"{name}.Denoising Normal.Z"][9, 16] - 1), 1e-3)
        self.assertLess(abs(planes[f"{name}.Denoising Albedo.R"][9, 16] - 0.6), 1e-3)
        error = planes[f"{name}.Error.R"]
        self.assertTrue(0 < error.max() < 0.2 * planes[f"{name}.Combined.R"].max())
        layer.cycles.denoising_store_passes = layer.cycles.use_pass_volume_direct = True
        scene.vdbeam.passes = 1
        planes = self.planes(scene)
        layer.cycles.denoising_store_passes = layer.cycles.use_pass_volume_direct = False
        self.assertEqual({channel.split(".")[1] for channel in planes},
                         {"Combined", "Denoising Normal", "Denoising Albedo", "VolumeDir", "VolumeInd"})
        self.assertEqual({channel.split(".")[1] for channel in self.planes(scene)}, {"Combined"})

    def test_passes_without_a_counterpart_are_noted(self):
        scene = plain_scene()
        layer = scene.view_layers[0]
        found = notes.Notes()
        reader = read_scene.SceneReader(read_scene.Options(str(self.folder), bpy.path.abspath, 32, 18), found)
        reader.read(bpy.context.evaluated_depsgraph_get(), 1.0)
        self.assertEqual(found.lines, [])
        layer.use_pass_normal = layer.use_pass_mist = layer.use_pass_diffuse_color = True
        reader.read(bpy.context.evaluated_depsgraph_get(), 1.0)
        layer.use_pass_normal = layer.use_pass_mist = layer.use_pass_diffuse_color = False
        self.assertEqual(found.lines, [
            f"{layer.name}: the passes Mist, Diffuse Color have no counterpart and are left out",
            f"{layer.name}: the pass Normal has no counterpart and is left out; Denoising Data has normals"])

    def test_panels_of_passes(self):
        """The panels show what the engine renders: no pass of EEVEE, and the light groups of Cycles."""
        shown = [panel for panel in bpy.types.Panel.__subclasses__() + [bpy.types.VIEWLAYER_PT_layer_passes_lightgroups]
                 if "VDBEAM" in getattr(panel, "COMPAT_ENGINES", ()) and "passes" in panel.__name__]
        self.assertEqual({panel.__name__ for panel in shown},
                         {"VDBEAM_PT_passes", "VIEWLAYER_PT_layer_passes", "VIEWLAYER_PT_layer_passes_lightgroups"})
        drawn = []
        column = types.SimpleNamespace(prop=lambda owner, name: drawn.append(getattr(owner, name)))
        panel = types.SimpleNamespace(layout=types.SimpleNamespace(column=lambda heading: column))
        bpy.types.VDBEAM_PT_passes.draw(panel, bpy.context)
        self.assertEqual(len(drawn), 9)

    def test_a_view_layer_that_fails_is_reported(self):
        scene = plain_scene()
        self.second_layer(scene)
        write = engine.VdbeamRenderEngine.write_scene

        def fail_in_second(own, folder, depsgraph, *more):
            if depsgraph.view_layer.name == "second":
                raise ValueError("it is of no use")
            return write(own, folder, depsgraph, *more)

        self.replace(engine.VdbeamRenderEngine, "write_scene", fail_in_second)
        with self.assertRaisesRegex(RuntimeError, "vdbeam: it is of no use"):
            self.planes(scene)


class Renders(InFolder):
    """Blender refuses F12 while an image is rendered. Renders may follow each other, and other programs and viewports
    render at the same time."""

    def setUp(self):
        super().setUp()
        self.started = []
        begin = engine.process.Render.__init__

        def note(own, words, folder):
            begin(own, words, folder)
            self.started.append((own.child, folder))

        self.replace(engine.process.Render, "__init__", note)

    def image(self, scene):
        return scenes.combined(scenes.render(scene, self.path))

    def nothing_is_left(self, renders):
        """Checks that programs have ended and their folders are gone."""
        self.assertEqual(len(self.started), renders)
        for child, folder in self.started:
            self.assertIsNotNone(child.returncode)
            self.assertFalse(os.path.exists(folder))

    def test_one_after_the_other(self):
        scene = plain_scene()
        first = self.image(scene)
        self.assertTrue(numpy.array_equal(first, self.image(scene)))
        self.nothing_is_left(2)

    def test_after_a_break(self):
        """A render that the user breaks, by Ctrl-C on the command line or Esc in the editor, does not hinder the next."""
        scene = plain_scene()
        first = self.image(scene)
        scene.vdbeam.passes = 100000
        follow = engine.VdbeamRenderEngine.follow

        def interrupted(own, *words):
            os.kill(os.getpid(), signal.SIGINT)
            return follow(own, *words)

        engine.VdbeamRenderEngine.follow = interrupted
        try:
            bpy.ops.render.render()
        finally:
            engine.VdbeamRenderEngine.follow = follow
        scene.vdbeam.passes = 1
        self.assertTrue(numpy.array_equal(first, self.image(scene)))
        self.nothing_is_left(3)

    def test_after_an_exception(self):
        """Blender removes an engine whose scene a script renders once more: then the program ends as well."""
        scene = plain_scene()
        scene.vdbeam.passes = 100000

        def removed(_own):
            raise ReferenceError("StructRNA of type VdbeamRenderEngine has been removed")

        cancelled = engine.VdbeamRenderEngine.cancelled
        engine.VdbeamRenderEngine.cancelled = removed
        try:
            bpy.ops.render.render()  # Blender prints the exception
        finally:
            engine.VdbeamRenderEngine.cancelled = cancelled
        scene.vdbeam.passes = 1
        self.assertGreater(self.image(scene).min(), 0.1)
        self.nothing_is_left(2)

    def test_beside_a_viewport(self):
        """A viewport's program goes on while F12 renders."""
        scene = plain_scene()
        preview = viewport.Preview(engine.process.find_program(""), threads=1)
        self.addCleanup(preview.close)
        preview.show_scene({"light": [{"type": "environment"}], "render": {"passes": 1000000}}, opaque=True)
        window = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1.02, -2.02], [0, 0, -1, 0]]
        place = [[float(row == column) for column in range(4)] for row in range(4)]
        preview.show_view({"size": (32, 18), "window": window, "camera_to_world": place})
        self.assertGreater(self.image(scene).min(), 0.1)
        (live, _), still = self.started[0], self.started[1:]
        self.assertIsNone(live.poll())
        preview.close()
        self.assertIsNotNone(live.wait(60))
        self.started = still
        self.nothing_is_left(1)

    def test_the_end_of_an_engine_reaches_blender(self):
        """Blender 4.4 has a __del__ of its own, which must be called; Blender 3.4 has none."""
        ended = []

        class Engine:
            def __del__(self):
                ended.append("Blender")

        class Later(view_engine.Viewport, Engine):
            pass

        later = Later()
        later.preview = types.SimpleNamespace(close=lambda: ended.append("viewport"))
        del later
        self.assertEqual(ended, ["viewport", "Blender"])
        view_engine.Viewport().__del__()

    def test_two_blenders_at_once(self):
        """A second Blender renders and ends while the first one does, whose folder it leaves alone."""
        scene = plain_scene()
        expected = self.image(scene)
        shot, other = self.folder / "shot.blend", self.folder / "other.exr"
        bpy.ops.wm.save_as_mainfile(filepath=str(shot))
        script = (f"import sys; sys.path.insert(0, {os.path.dirname(FILE)!r}); import bpy, scenes, vdbeam_blender; "
                  f"vdbeam_blender.register(); bpy.ops.wm.open_mainfile(filepath={str(shot)!r}); "
                  f"scenes.render(bpy.context.scene, {str(other)!r})")
        follow = engine.VdbeamRenderEngine.follow
        results = []

        def with_another(own, render, target):
            results.append(subprocess.run([bpy.app.binary_path, "-b", "--factory-startup", "--python-expr", script],
                                          capture_output=True, text=True, check=False))
            self.assertTrue(os.path.exists(self.started[-1][1]))
            return follow(own, render, target)

        self.replace(engine.VdbeamRenderEngine, "follow", with_another)
        self.assertTrue(numpy.array_equal(expected, self.image(scene)))
        self.assertEqual(results[0].returncode, 0, results[0].stdout + results[0].stderr)
        planes = {name.split(".", 1)[1]: plane for name, plane in exr.read(other)[0].items()}
        self.assertTrue(numpy.array_equal(expected, scenes.combined(planes)))
        self.nothing_is_left(2)
        left = glob.glob(os.path.join(tempfile.gettempdir(), f"{temp_folder.PREFIX}*"))
        self.assertFalse([folder for folder in left if temp_folder.is_left(pathlib.Path(folder))])


if __name__ == "__main__":
    blender_runner.main(FILE)
