"""The Python module: scenes from files, dicts and arrays, renders with callbacks, errors, interruption."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import built_module

built_module.require()

import numpy as np  # noqa: E402

import vdbeam  # noqa: E402

SMALL = {"image.width": 48, "image.height": 27, "render.passes": 2}


def cloud(**settings):
    return vdbeam.Scene(built_module.ROOT / "data/cloud.toml", {**SMALL, **settings})


def ball(points=33, radius=1.0, density=1.0):
    """A ball of this density about the origin, with its voxel size."""
    axis = np.linspace(-1.1 * radius, 1.1 * radius, points)
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    values = np.where(x * x + y * y + z * z < radius * radius, density, 0).astype(np.float32)
    return vdbeam.Density(values, axis[1] - axis[0], [axis[0]] * 3)


class Scenes(unittest.TestCase):
    def test_settings_and_defaults(self):
        scene = cloud()
        self.assertEqual((scene.width, scene.height), (48, 27))
        self.assertEqual(scene["render.passes"], 2)
        scene["render.passes"] = np.int64(3)
        scene["volume.0.albedo"] = np.array([0.5, 0.25, 1])
        self.assertEqual(scene["render.passes"], 3)
        self.assertEqual(scene["volume.0.albedo"], [0.5, 0.25, 1])
        self.assertEqual(scene.settings["render"]["passes"], 3)

    def test_a_refused_value_changes_nothing(self):
        scene = cloud()
        before = scene.hash()
        with self.assertRaisesRegex(vdbeam.InputError, "render.passes.*-1"):
            scene["render.passes"] = -1
        with self.assertRaisesRegex(vdbeam.InputError, "camera.fow.*fov"):
            scene["camera.fow"] = 30
        with self.assertRaises(TypeError):
            scene["camera.fov"] = object()
        self.assertEqual(scene.hash(), before)

    def test_a_missing_key_is_named(self):
        for key in ("camera.fow", "light.9.exposure", "camera.fov.x", "light.first"):
            with self.assertRaises(KeyError) as caught:
                cloud()[key]
            self.assertEqual(caught.exception.args, (key,))

    def test_a_dict_is_a_scene_file(self):
        keys = {"image": {"width": 48, "height": 27}, "camera": {"position": [0, 0, 5], "look_at": (0, 0, 0)},
                "volume": [{"file": "cloud.vdb", "extinction": 3.5, "phase": {"type": "henyey_greenstein", "g": 0.5}}],
                "light": [{"type": "environment", "radiance": [1, 1, 1]}], "render": {"passes": 2}}
        scene = vdbeam.Scene(keys, folder=built_module.ROOT / "data")
        text = "".join(
            ["[image]\nwidth = 48\nheight = 27\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n",
             f"[[volume]]\nfile = '{built_module.ROOT}/data/cloud.vdb'\nextinction = 3.5\nphase.type = 'henyey_greenstein'\n",
             "phase.g = 0.5\n[[light]]\ntype = 'environment'\nradiance = [1, 1, 1]\n[render]\npasses = 2\n"])
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "same.toml"
            path.write_text(text)
            self.assertEqual(scene.hash(), vdbeam.Scene(path).hash())
        with self.assertRaisesRegex(vdbeam.InputError, "scene:2: .*position"):
            vdbeam.Scene({"image": {"width": 48}, "camera": {"position": [0, 0]}})

    def test_errors_are_the_program_s_lines(self):
        with self.assertRaisesRegex(vdbeam.InputError, "nowhere.toml"):
            vdbeam.Scene("/nowhere.toml")
        self.assertTrue(issubclass(vdbeam.InputError, vdbeam.Error))
        broken = cloud(**{"volume.0.density": "smoke"})
        with self.assertRaisesRegex(vdbeam.Error, "smoke"):
            vdbeam.render(broken)

    def test_plan(self):
        plan = cloud().plan()
        self.assertIn(plan["estimator"], ("gather", "beam", "path"))
        self.assertTrue(plan["schedule"])
        self.assertFalse(cloud().plan(pilots=False).get("schedule"))


class Renders(unittest.TestCase):
    def test_the_program_renders_the_same(self):
        frame = vdbeam.render(cloud())
        with tempfile.TemporaryDirectory() as folder:
            image = pathlib.Path(folder) / "a.exr"
            options = [f"{key}={value}" for key, value in SMALL.items()]
            subprocess.run([os.environ["VDBEAM_BINARY"], "render", built_module.ROOT / "data/cloud.toml", "-o", image, "-q",
                            *[word for option in options for word in ("--set", option)]], check=True)
            saved = pathlib.Path(folder) / "b.exr"
            frame.save(saved)
            frame.save_preview(pathlib.Path(folder) / "b.png")
            self.assertTrue(np.array_equal(vdbeam.read_image(image), vdbeam.read_image(saved)))
            self.assertTrue(np.allclose(frame.rgb, vdbeam.read_image(saved), rtol=1e-3, atol=1e-6))
        self.assertEqual(frame.rgb.shape, (27, 48, 3))
        self.assertEqual(frame.stopped_by, "passes")
        self.assertEqual([record.passes for record in frame.passes], [1, 2])
        self.assertEqual(frame.report["plan"]["estimator"], cloud().plan()["estimator"])

    def test_what_a_scene_takes_can_be_rendered(self):
        scene = cloud()
        small = {"image.width": scene.width, "image.height": scene.height, "render.passes": 2}
        path = built_module.ROOT / "data/cloud.toml"
        for source in (path, str(path)):
            np.testing.assert_array_equal(vdbeam.render(source, small).rgb, vdbeam.render(vdbeam.Scene(path, small)).rgb)
        with self.assertRaisesRegex(vdbeam.InputError, "there is no file"):
            vdbeam.Session().render("missing.toml")

    def test_files_are_named_after_their_format(self):
        frame = vdbeam.render(cloud(), {"render.passes": 1})
        with tempfile.TemporaryDirectory() as folder:
            for name, save in (("a.png", frame.save), ("a.jpg", frame.save_preview), ("a.exr", frame.save_preview)):
                with self.assertRaisesRegex(vdbeam.InputError, f"{name}: the name of this file must end with"):
                    save(pathlib.Path(folder) / name)
            self.assertEqual(os.listdir(folder), [])
            frame.save(pathlib.Path(folder) / "a.EXR")
            self.assertEqual(os.listdir(folder), ["a.EXR"])

    def test_objects_describe_themselves(self):
        frame = vdbeam.render(cloud(), {"render.passes": 1})
        self.assertEqual(repr(frame), "<vdbeam.Frame of 48 x 27 pixels, passes: 1, error: unknown>")
        self.assertEqual(repr(vdbeam.Density(np.ones((3, 4, 5)))), "<vdbeam.Density of 3 x 4 x 5 voxels>")

    def test_layers_share_memory_and_outlive_the_frame(self):
        frame = vdbeam.render(cloud())
        layers = frame.layers
        sums = {name: plane.sum() for name, plane in layers.items()}
        self.assertFalse(layers["R"].flags.owndata)
        del frame
        for name, plane in layers.items():
            self.assertEqual(plane.sum(), sums[name])

    def test_callbacks(self):
        records, images, notes = [], [], []
        frame = vdbeam.render(cloud(), {"render.passes": 4, "volume.0.color_grid": "auto"}, on_pass=records.append,
                              on_image=images.append, on_note=notes.append)
        self.assertEqual([record.passes for record in records], [1, 2, 3, 4])
        self.assertGreaterEqual(len(images), 3)
        self.assertTrue(all(image.rgb.shape == (27, 48, 3) and image.rgb.any() for image in images))
        self.assertEqual(records[-1].error_estimate, frame.error[0])

    def test_on_image_has_the_layers_of_the_frame(self):
        images = []
        scene = cloud(layer=[{"name": "depth"}, {"name": "volume_direct"}])
        frame = vdbeam.render(scene, on_image=images.append)
        self.assertIn("depth.Z", frame.layers)
        self.assertEqual(sorted(images[0].layers), sorted(frame.layers))
        for name, plane in frame.layers.items():  # the last image is the frame's, and outlives it
            np.testing.assert_array_equal(images[-1].layers[name], plane)
        self.assertLess(vdbeam.compare(images[-1], frame)["mrse"], 1e-12)

    def test_false_ends_the_render(self):
        frame = vdbeam.render(cloud(), {"render.passes": 1000}, on_pass=lambda record: record.passes < 2)
        self.assertEqual(frame.stopped_by, "stop")
        self.assertLess(len(frame.passes), 10)
        self.assertTrue(frame.rgb.any())

    def test_an_exception_in_a_callback_arrives(self):
        def fail(record):
            raise KeyError("mine")
        with self.assertRaisesRegex(KeyError, "mine"):
            vdbeam.render(cloud(), {"render.passes": 1000}, on_pass=fail)

    def test_keyboard_interrupt(self):
        timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            vdbeam.render(cloud(), {"render.passes": 1000000, "render.estimator": "path"})
        timer.join()

    def test_the_lock_is_released(self):
        ticks, done = [], threading.Event()

        def tick():
            while not done.wait(0.01):
                ticks.append(1)
        thread = threading.Thread(target=tick)
        thread.start()
        vdbeam.render(cloud(), {"image.width": 96, "image.height": 54})
        done.set()
        thread.join()
        self.assertGreater(len(ticks), 3)

    def test_a_session_reads_volumes_once(self):
        session = vdbeam.Session()
        scene = cloud()
        first = session.render(scene)
        scene["light.0.exposure"] = 1
        second = session.render(scene)
        self.assertEqual(first.report["counts"]["grids_read"], 1)
        self.assertEqual(second.report["counts"]["grids_read"], 0)
        self.assertGreater(second.rgb.mean(), 1.1 * first.rgb.mean())


class Arrays(unittest.TestCase):
    def test_transmittance_of_a_ball(self):
        """Absorption alone before a white sky: exp(-extinction chord), by Beer and Lambert."""
        keys = {"image": {"width": 33, "height": 33},
                "camera": {"position": [0, 0, 40], "look_at": [0, 0, 0], "fov": 4},
                "volume": [{"file": ball(points=129), "extinction": 0.7, "albedo": 0}],
                "light": [{"type": "environment", "radiance": [1, 1, 1]}], "render": {"passes": 8}}
        rgb = vdbeam.render(vdbeam.Scene(keys)).rgb
        self.assertAlmostEqual(float(rgb[16, 16, 0]), float(np.exp(-0.7 * 2)), delta=0.01)
        self.assertAlmostEqual(float(rgb[0, 0, 0]), 1, delta=1e-3)

    def test_files_are_removed(self):
        density = ball()
        path = pathlib.Path(density.path)
        scene = vdbeam.Scene({"volume": [{"file": density}]})
        del density
        self.assertTrue(path.exists())
        scene["image.width"] = 32
        self.assertTrue(path.exists())
        del scene
        self.assertFalse(path.exists())

    def test_bad_arrays(self):
        with self.assertRaisesRegex(ValueError, "three axes"):
            vdbeam.Density(np.zeros((3, 3)))
        with self.assertRaisesRegex(vdbeam.InputError, "along all three axes"):
            vdbeam.Density(np.zeros((3, 0, 3)))
        with self.assertRaisesRegex(vdbeam.InputError, "voxel size"):
            vdbeam.Density(np.zeros((3, 3, 3)), voxel_size=0)


class Comparisons(unittest.TestCase):
    def test_errors_of_known_images(self):
        reference = np.full((8, 8, 3), 0.5, np.float32)
        errors = vdbeam.compare(reference + 0.1, reference)
        self.assertAlmostEqual(errors["rmse"], 0.1, places=6)
        self.assertAlmostEqual(errors["mrse"], 0.01 / 0.51 ** 2, places=6)
        self.assertAlmostEqual(errors["bias"], 0.2, places=6)
        with self.assertRaises(vdbeam.InputError):
            vdbeam.compare(reference, reference[:4])
        with self.assertRaisesRegex(ValueError, "height, width, 3"):
            vdbeam.compare(reference[..., 0], reference)

    def test_references_in_records(self):
        truth = vdbeam.render(cloud(), {"render.passes": 64}).rgb
        records = vdbeam.render(cloud(), reference=truth).passes
        self.assertTrue(records[0].has_reference)
        self.assertGreater(records[0].mrse, records[1].mrse)


if __name__ == "__main__":
    unittest.main()
