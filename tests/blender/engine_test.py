#!/usr/bin/env python3
"""The render engine inside Blender: the installed zip, passes, images as they come, errors, cancelling, animations,
render borders, farm jobs. Skipped without Blender."""
import os
import pathlib
import shutil
import stat
import subprocess
import sys
import tempfile
import time
import types
import unittest

FILE = os.path.abspath(__file__)
sys.path.insert(0, os.path.dirname(FILE))

import blender_runner  # noqa: E402

if blender_runner.inside_blender():
    import bpy
    import numpy
    import scenes
    from vdbeam_blender import engine, exr, mesh_cache, view_engine

DATA = pathlib.Path(FILE).resolve().parents[2] / "data"
SMOKE = DATA / "smoke" / "smoke.0024.vdb"


class Engine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def smoke(self, file=SMOKE):
        """Smoke in front of a constant world."""
        scene = scenes.empty_scene()
        scenes.add_camera(scene, (0.5, -6, 2), (1.2, 1, 1.1), lens=85)
        self.volume, _ = scenes.add_volume(scene, file, Density=20.0)
        scenes.set_world(scene, (0.5, 0.5, 0.5))
        scene.render.resolution_x, scene.render.resolution_y = 64, 36
        return scene

    def render(self, scene, name="image.exr"):
        return scenes.render(scene, self.folder / name)

    def fails(self, scene, text):
        with self.assertRaisesRegex(RuntimeError, text):
            self.render(scene)

    def program(self, text):
        """Replaces the program by a shell script, until the test ends."""
        path = self.folder / "vdbeam"
        path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        self.on_path(f"{self.folder}{os.pathsep}{os.environ['PATH']}")

    def on_path(self, path):
        """Sets the PATH until the test ends."""
        self.addCleanup(os.environ.__setitem__, "PATH", os.environ["PATH"])
        os.environ["PATH"] = path

    def replace(self, owner, name, value):
        """Sets an attribute until the test ends."""
        self.addCleanup(setattr, owner, name, getattr(owner, name))
        setattr(owner, name, value)

    def test_passes_add_up_and_repeat(self):
        scene = self.smoke()
        layer = bpy.context.view_layer
        layer.use_pass_z = layer.use_pass_position = layer.use_pass_environment = True
        layer.use_pass_cryptomatte_object = True
        scene.vdbeam.volume_layers = True
        first, second = self.render(scene, "a.exr"), self.render(scene, "b.exr")
        for name, plane in first.items():
            self.assertTrue(numpy.array_equal(plane, second[name]), name)
        crypto = {f"CryptoObject{index:02d}" for index in range(3)}
        self.assertEqual({name.split(".")[0] for name in first},
                         {*crypto, "Combined", "Depth", "Position", "Env", "VolumeDir", "VolumeInd"})
        for letter in "RGB":
            parts = first[f"VolumeDir.{letter}"] + first[f"VolumeInd.{letter}"] + first[f"Env.{letter}"]
            self.assertLess(numpy.abs(parts - first[f"Combined.{letter}"]).max(), 2e-3)  # halves
        self.assertGreater(first["CryptoObject00.G"].max(), 0.5)  # the smoke's coverage
        self.assertTrue(5 < first["Depth.Z"][18, 32] < 9)
        self.assertEqual(first["Combined.A"][0, 0], 1)  # the world is visible
        layer.use_pass_z = layer.use_pass_position = layer.use_pass_environment = False
        layer.use_pass_cryptomatte_object = False
        scene.vdbeam.volume_layers = False
        scene.render.film_transparent = True
        self.assertEqual(self.render(scene)["Combined.A"][0, 0], 0)

    def test_light_groups_add_up(self):
        scene = self.smoke()
        layer = bpy.context.view_layer
        lamp = scenes.add_lamp(scene, "SUN", 3)
        lamp.lightgroup, scene.world.lightgroup = "key", "sky"
        for name in ("key", "sky"):
            layer.lightgroups.add().name = name
        planes = self.render(scene)
        self.assertGreater(planes["Combined_key.R"].max(), 0.01)
        total = planes["Combined_key.R"] + planes["Combined_sky.R"]
        self.assertLess(numpy.abs(total - planes["Combined.R"]).max(), 2e-3)
        self.assertEqual(planes["Combined_rest.R"].max(), 0)
        scene.world.lightgroup = ""
        planes = self.render(scene)
        rest = planes["Combined_rest.R"] + planes["Combined_key.R"]
        self.assertGreater(planes["Combined_rest.R"].max(), 0.1)
        self.assertLess(numpy.abs(rest - planes["Combined.R"]).max(), 2e-3)
        while layer.lightgroups:
            layer.lightgroups.remove(layer.lightgroups[0]) if hasattr(layer.lightgroups, "remove") else \
                bpy.ops.scene.view_layer_remove_lightgroup()

    def test_images_come_during_the_render(self):
        scene = self.smoke()
        scene.vdbeam.passes, scene.vdbeam.update_interval = 40, 0.1
        shown, done = [], []
        show, follow = engine.Target.show, engine.process.progress_text
        self.replace(engine.Target, "show", lambda target, path: (shown.append(path), show(target, path)))
        self.replace(engine.process, "progress_text", lambda event: (done.append(event["done"]), follow(event))[1])
        self.render(scene)
        self.assertGreaterEqual(len(shown), 3)
        self.assertTrue(shown[-1].endswith("image.exr"))
        self.assertEqual(len(done), 40)
        self.assertEqual(done, sorted(done))

    def test_cancel(self):
        scene = self.smoke()
        scene.vdbeam.passes = 100000
        begin = time.monotonic()
        children = []
        cancel = engine.process.Render.cancel
        self.replace(engine.process.Render, "cancel", lambda own: (children.append(own.child), cancel(own)))
        self.replace(engine.VdbeamRenderEngine, "cancelled", lambda own: time.monotonic() > begin + 3)
        self.render(scene)  # what there is is kept, and no error is raised
        self.assertLess(time.monotonic() - begin, 30)
        self.assertEqual(children[0].returncode, 128 + 15)

    def test_program_that_is_missing_or_fails(self):
        scene = self.smoke()
        self.program('echo "the disk is on fire" >&2; exit 3')
        self.fails(scene, "vdbeam: the disk is on fire")
        self.program("kill -SEGV $$")
        self.fails(scene, "vdbeam was ended by signal 11")
        self.on_path("/nowhere")
        self.fails(scene, "vdbeam is not on the PATH; enter its path in the preferences")

    def test_missing_file(self):
        scene = self.smoke(self.folder / "none.vdb")
        self.fails(scene, "none.vdb")
        scene.camera = None
        with self.assertRaisesRegex(RuntimeError, "[Cc]amera"):
            self.render(scene)

    def test_sequence_and_moving_camera(self):
        """Frames 2 to 4 show the files 24, 25 (missing: the one before) and none, through a camera that moves."""
        shutil.copy(SMOKE, self.folder / "smoke.0024.vdb")
        shutil.copy(DATA / "smoke" / "smoke.0012.vdb", self.folder / "smoke.0026.vdb")
        scene = self.smoke(self.folder / "smoke.0024.vdb")
        data = self.volume.data
        data.is_sequence, data.frame_start, data.frame_duration, data.frame_offset = True, 2, 2, 23
        data.sequence_mode = "CLIP"
        scene.frame_start, scene.frame_end = 2, 4
        scene.render.filepath = str(self.folder / "frame.####")
        bpy.ops.render.render(animation=True)
        frames = [exr.read(self.folder / f"frame.{number:04d}.exr")[0] for number in (2, 3, 4)]
        first, second, third = (scenes.combined({name.split(".", 1)[1]: plane for name, plane in planes.items()})
                                for planes in frames)
        self.assertLess(numpy.abs(first - second).mean(), 0.02)  # other random numbers, the same smoke
        self.assertGreater(numpy.abs(first - 0.5).max(), 0.1)
        self.assertLess(numpy.abs(third - 0.5).max(), 1e-3)  # the world alone
        scene.vdbeam.missing = "error"
        scene.frame_set(3)
        self.addCleanup(setattr, scene.vdbeam, "missing", "hold")
        self.fails(scene, "smoke.0025.vdb")

    def test_motion_blur_of_a_camera(self):
        scene = self.smoke()
        camera = scene.camera
        for frame, x in ((0, 0.2), (2, 0.8)):
            camera.location.x = x
            camera.keyframe_insert("location", frame=frame)
        scene.frame_set(1)
        scene.vdbeam.passes = 16
        sharp = scenes.combined(self.render(scene))
        scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
        blurred = scenes.combined(self.render(scene))
        self.assertEqual(scene.frame_current, 1)
        steep = [numpy.abs(numpy.diff(image[..., 0], axis=1)).max() for image in (sharp, blurred)]
        self.assertLess(steep[1], 0.8 * steep[0])

    def test_render_border(self):
        scene = self.smoke()
        whole = scenes.combined(self.render(scene))
        render = scene.render
        render.use_border, render.use_crop_to_border = True, True
        render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.5, 1.0
        part = scenes.combined(self.render(scene))
        self.assertEqual(part.shape, (18, 32, 3))
        self.assertLess(numpy.abs(part - whole[:18, 16:48]).max(), 1e-6)

    def test_a_lamp_with_a_radius_is_as_bright(self):
        """And has soft shadows: a plane beneath a smaller one, whose edge is as sharp as pixels, or not."""
        means, steps = [], []
        for radius in (0.0, 0.4):
            scene = scenes.empty_scene()
            scenes.add_camera(scene, (0, 0, 6), (0, 0, 0), lens=40)
            scenes.add_plane(scene, 4)
            scenes.add_plane(scene, 0.3, location=(0, 0, 1))
            lamp = scenes.add_lamp(scene, "POINT", 300, location=(1.5, 0, 4))
            lamp.data.shadow_soft_size = radius
            scene.vdbeam.estimator, scene.vdbeam.passes = "path", 32
            image = scenes.combined(self.render(scene))[..., 1]
            means.append(image[:10].mean())
            steps.append(numpy.abs(numpy.diff(image[45, :64])).max())  # left of the smaller plane
        scene.vdbeam.estimator = "auto"
        self.assertLess(abs(means[1] / means[0] - 1), 0.02)
        self.assertLess(steps[1], 0.7 * steps[0])

    def test_a_mesh_that_changes_its_shape_is_reported(self):
        scene = self.smoke()
        plane = scenes.add_plane(scene, 1)
        plane.shape_key_add(name="basis")
        key = plane.shape_key_add(name="up")
        for point in key.data:
            point.co.z += 1
        for frame, value in ((0, 0.0), (2, 1.0)):
            key.value = value
            key.keyframe_insert("value", frame=frame)
        scene.frame_set(1)
        lines = []
        write = engine.VdbeamRenderEngine.write_scene
        self.replace(engine.VdbeamRenderEngine, "write_scene",
                     lambda *words: (lines.extend(write(*words)), list(lines))[1])
        self.render(scene)
        self.assertFalse([line for line in lines if "its shape changes" in line])
        scene.render.use_motion_blur = True
        self.render(scene)
        self.assertTrue([line for line in lines if "its shape changes" in line])

    def test_holdout_and_shadow_catcher(self):
        scene = scenes.empty_scene()
        scenes.add_camera(scene, (0, -5, 5), (0, 0, 0), lens=28)
        scenes.add_lamp(scene, "SUN", 3, rotation=(0.5, 0, 0))
        ground = scenes.add_plane(scene)
        block = scenes.add_plane(scene, 0.7, location=(0, 0, 1))
        scene.render.film_transparent = True
        ground.is_shadow_catcher, block.is_holdout = True, True
        alpha = self.render(scene)["Combined.A"]
        self.assertGreater(alpha.max(), 0.9)  # the shadow
        self.assertLess(alpha.min(), 0.01)  # beside it, and the holdout
        self.assertLess((alpha > 0.5).mean(), 0.2)

    def test_viewport(self):
        """What Blender calls for a viewport, with stubs of what a Blender without windows lacks."""
        scene = self.smoke()
        scene.camera.data.dof.use_dof = True
        engine_of_view, drawn, lines = view_engine.Viewport(), [], []
        engine_of_view.update_stats = lambda _name, line: lines.append(line)
        engine_of_view.tag_redraw = lambda: None
        self.replace(view_engine.view_draw.Drawing, "draw",
                     lambda _own, _engine, _scene, pixels, width, height: drawn.append((pixels, width, height)))
        depsgraph = bpy.context.evaluated_depsgraph_get()
        camera = scene.camera.evaluated_get(depsgraph)
        window = camera.calc_matrix_camera(depsgraph, x=48, y=32)
        context = types.SimpleNamespace(
            region=types.SimpleNamespace(width=48, height=32),
            region_data=types.SimpleNamespace(view_perspective="CAMERA", window_matrix=window,
                                              view_matrix=camera.matrix_world.inverted()))
        engine_of_view.view_update(context, depsgraph)
        end = time.monotonic() + 120
        while (not lines or lines[-1] != "Done") and time.monotonic() < end:
            engine_of_view.view_draw(context, depsgraph)
            time.sleep(0.05)
        self.assertEqual(lines[-1], "Done")
        pixels, width, height = drawn[-1]
        self.assertEqual((pixels.shape, width, height), ((32, 48, 4), 48, 32))
        self.assertTrue(numpy.allclose(pixels[-1, 0], [0.5, 0.5, 0.5, 1], atol=2e-3))  # the world
        self.assertGreater(numpy.abs(pixels - 0.5)[..., :3].max(), 0.1)
        child = engine_of_view.preview.render.child
        self.edits_gather_what_changed(scene, engine_of_view, context)
        text = (pathlib.Path(engine_of_view.preview.folder) / "scene.toml").read_text(encoding="utf-8")
        self.assertIn("lens_radius", text)
        folder = pathlib.Path(engine_of_view.preview.folder)
        del engine_of_view
        child.wait(30)
        while folder.exists() and time.monotonic() < end:
            time.sleep(0.05)
        self.assertFalse(folder.exists())

    def edits_gather_what_changed(self, scene, engine_of_view, context):
        """Edits of a viewport's scene: meshes are read again where they change, and nowhere else."""
        gathered, gather = [], mesh_cache.gathered
        self.replace(mesh_cache, "gathered", lambda mesh, *words: (gathered.append(mesh.name), gather(mesh, *words))[1])
        first, second = scenes.add_plane(scene, 1, location=(0, 3, 0)), scenes.add_plane(scene, 2, location=(0, 3, 1))
        twin = scenes.add(scene, "twin", second.data, (0, 4, 0))
        lamp = scenes.add_lamp(scene, "SUN", 1)

        def meshes_after(edit):
            changed = []
            note = lambda _scene, depsgraph: changed.extend(  # noqa: E731
                types.SimpleNamespace(id=types.SimpleNamespace(name=one.id.name), is_updated_geometry=one.is_updated_geometry)
                for one in depsgraph.updates)
            bpy.app.handlers.depsgraph_update_post.append(note)
            edit()
            bpy.context.view_layer.update()
            bpy.app.handlers.depsgraph_update_post.remove(note)
            depsgraph = bpy.context.evaluated_depsgraph_get()
            # A viewport's graph has the updates of the edit; those of the window's are over here.
            graph = types.SimpleNamespace(scene=depsgraph.scene, view_layer=depsgraph.view_layer,
                                          object_instances=depsgraph.object_instances, updates=changed)
            gathered.clear()
            engine_of_view.view_update(context, graph)
            return sorted(set(gathered))

        meshes_after(lambda: None)
        self.assertEqual(len(gathered), 2)  # the twin shares the file of its mesh
        self.assertEqual(meshes_after(lambda: setattr(lamp.data, "energy", 2)), [])
        self.assertEqual(meshes_after(lambda: setattr(first, "location", (1, 3, 0))), [])
        self.assertEqual(meshes_after(lambda: (setattr(first.data.vertices[0].co, "z", 0.5), first.data.update())),
                         [first.data.name])
        self.assertEqual(meshes_after(lambda: second.modifiers.new("thick", "SOLIDIFY")), [second.data.name])
        self.assertEqual(meshes_after(lambda: setattr(twin, "hide_viewport", True)), [])
        text = engine_of_view.preview.scene
        self.assertEqual(text.count("[[mesh]]"), 2)

    def test_farm_job(self):
        """The job's scene gives the image of F12, frame by frame."""
        scene = self.smoke()
        scene.frame_start, scene.frame_end = 1, 3
        for frame, x in ((1, 0.2), (3, 0.8)):
            scene.camera.location.x = x
            scene.camera.keyframe_insert("location", frame=frame)
        scenes.add_plane(scene, 2, location=(1, 1, -0.2)).keyframe_insert("location", frame=1)
        scene.view_settings.exposure = 1.5
        self.assertEqual(bpy.ops.vdbeam.write_farm_job(directory=str(self.folder), preview=True), {"FINISHED"})
        scene.view_settings.exposure = 0
        job = (self.folder / "job.sbatch").read_text(encoding="utf-8")
        for word in ("sbatch", "--view=filmic", "--exposure=1.5"):
            self.assertIn(word, job)
        scene.frame_set(2)
        expected = self.render(scene)
        subprocess.run([os.environ["VDBEAM_BINARY"], "render", "scene.toml", "-f", "2", "-o", "f.exr", "-q"],
                       cwd=self.folder, check=True)
        planes, _ = exr.read(self.folder / "f.exr")
        for letter in "RGB":
            apart = numpy.abs(planes[letter] - expected[f"Combined.{letter}"]).max()
            self.assertLess(apart, 2e-3, letter)

    def test_blend_file_on_the_command_line(self):
        """A saved file is rendered by a Blender that only has the add-on on its path of scripts."""
        scene = self.smoke()
        scene.render.image_settings.file_format = "OPEN_EXR"
        shot = self.folder / "shot.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(shot))
        package = DATA.parent / "tools" / "blender" / "vdbeam_blender"
        shutil.copytree(package, self.folder / "addons" / package.name)
        result = subprocess.run([bpy.app.binary_path, "-b", "--addons", package.name, shot, "-o", "//frame.####", "-f",
                                 "7"], env={**os.environ, "BLENDER_USER_SCRIPTS": str(self.folder)},
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        image = exr.read(self.folder / "frame.0007.exr")[0]
        self.assertGreater(numpy.abs(image["R"] - 0.5).max(), 0.1)

    def test_zip_is_installed_and_removed(self):
        """In a Blender of its own: the zip registers the engine, its settings and its panel, and takes them back."""
        archive = self.folder / "vdbeam_blender.zip"
        maker = DATA.parent / "tools" / "blender" / "make_zip.py"
        subprocess.run([shutil.which("python3"), maker, archive], check=True)
        script = f"""
import bpy
bpy.ops.preferences.addon_install(filepath={str(archive)!r})
bpy.ops.preferences.addon_enable(module="vdbeam_blender")
scene = bpy.context.scene
scene.render.engine = "VDBEAM"
own = scene.vdbeam
assert len(own.bl_rna.properties) == 12, list(own.bl_rna.properties.keys())  # ten, its name and its type
assert "VDBEAM" in bpy.types.WORLD_PT_context_world.COMPAT_ENGINES
bpy.context.preferences.addons["vdbeam_blender"].preferences.program = {os.environ["VDBEAM_BINARY"]!r}
scene.render.resolution_x, scene.render.resolution_y, own.passes = 32, 18, 1
bpy.ops.render.render()
bpy.ops.preferences.addon_disable(module="vdbeam_blender")
assert not hasattr(bpy.types.Scene, "vdbeam") and not hasattr(bpy.types.ViewLayer, "vdbeam")
assert "VDBEAM" not in bpy.types.WORLD_PT_context_world.COMPAT_ENGINES
print("all is well")
"""
        (self.folder / "script.py").write_text(script, encoding="utf-8")
        result = subprocess.run([bpy.app.binary_path, "-b", "--factory-startup", "-P", self.folder / "script.py"],
                                env={**os.environ, "BLENDER_USER_SCRIPTS": str(self.folder), "PATH": os.defpath},
                                capture_output=True, text=True, check=False)
        self.assertIn("all is well", result.stdout, result.stdout + result.stderr)


if __name__ == "__main__":
    blender_runner.main(FILE)
