"""vdbeam.LiveSession: edits by keys, images as they come, errors, interruption, and the end of a session."""
import gc
import os
import signal
import subprocess
import sys
import threading
import time
import unittest
import weakref

import built_module

built_module.require()

import numpy as np  # noqa: E402

import vdbeam  # noqa: E402

PATIENCE = 120  # seconds, of a machine that does much else
ENDLESS = 1000000  # passes
SCENE = {
    "image": {"width": 40, "height": 24},
    "camera": {"position": [0, 0.5, 5], "look_at": [0, 0, 0], "fov": 34},
    "volume": [{"shape": "sphere", "extinction": 4, "albedo": 0.9}],
    "light": [{"type": "distant", "direction": [-1, -1, -0.5], "irradiance": 3},
              {"type": "environment", "radiance": 0.3}],
    "render": {"passes": 3, "photons": 2000, "estimator": "beam"},
}


def scene(**settings):
    return vdbeam.Scene(SCENE, settings)


class Seen:
    """What a session has called back with."""

    def __init__(self):
        self.images, self.edits, self.errors, self.finished = [], [], [], []
        self.first = threading.Event()

    def callbacks(self):
        return {"on_image": self.image, "on_edit": self.edits.append, "on_error": self.errors.append,
                "on_finished": self.finished.append}

    def image(self, image):
        self.images.append(image)
        self.first.set()


class Edits(unittest.TestCase):
    def test_shows_what_a_render_gives(self):
        seen = Seen()
        with vdbeam.LiveSession(scene(), **seen.callbacks()) as live:
            first = live.wait(PATIENCE)
            live.edit({"volume.0.extinction": 6, "camera.fov": 30})
            second = live.wait(PATIENCE)
            self.assertEqual(live["volume.0.extinction"], 6)
        self.assertEqual((first.edit, first.passes, second.edit, second.passes), (1, 3, 2, 3))
        self.assertEqual([sorted(edit.changed) for edit in seen.edits], [[], ["camera.fov", "volume.0.extinction"]])
        self.assertEqual(seen.finished, [1, 2])
        self.assertEqual((seen.images[0].edit, seen.images[-1].edit), (1, 2))
        fresh = vdbeam.render(scene(**{"volume.0.extinction": 6, "camera.fov": 30}))
        # Groups of lights add the same light in another order.
        self.assertTrue(np.allclose(second.rgb, fresh.rgb, rtol=1e-4, atol=1e-6))
        self.assertFalse(np.allclose(first.rgb, fresh.rgb, rtol=1e-2))
        self.assertGreater(second.error[0], 0)

    def test_lights_are_mixed(self):
        seen = Seen()
        with vdbeam.LiveSession(scene(), **seen.callbacks()) as live:
            first = live.wait(PATIENCE)
            live["light.0.exposure"] = 1
            live["light.1.exposure"] = 1
            both = live.wait(PATIENCE)
        self.assertTrue(seen.edits[1].mixed and seen.edits[2].mixed and both.mixed)
        self.assertTrue(np.allclose(both.rgb, 2 * first.rgb, rtol=1e-4, atol=1e-6))
        self.assertEqual(seen.finished, [1, 2, 3])

    def test_layers_share_memory_and_outlive_the_session(self):
        live = vdbeam.LiveSession(scene())
        layers = live.wait(PATIENCE).layers
        live.close()
        del live
        self.assertEqual(sorted(layers), ["A", "B", "G", "R"])
        self.assertFalse(layers["R"].flags.owndata)
        self.assertTrue(layers["R"].any())

    def test_an_edit_in_a_callback(self):
        first, second = threading.Event(), threading.Event()

        def on_finished(number):
            if number == 1:
                first.wait(PATIENCE)  # until `live` is there
                live["camera.fov"] = 20
            else:
                second.set()
        with vdbeam.LiveSession(scene(), on_finished=on_finished) as live:
            first.set()
            self.assertTrue(second.wait(PATIENCE))
            self.assertEqual(live.wait(PATIENCE).edit, 2)


class Errors(unittest.TestCase):
    def test_a_refused_value_changes_nothing(self):
        with vdbeam.LiveSession(scene()) as live:
            with self.assertRaisesRegex(vdbeam.InputError, "volume.0.extinction.*-1"):
                live["volume.0.extinction"] = -1
            self.assertEqual(live.wait(PATIENCE).edit, 1)

    def test_a_scene_that_cannot_be_rendered(self):
        seen = Seen()
        broken = {"volume.0.density": "smoke"}
        source = built_module.ROOT / "data/cloud.toml"
        small = {"image.width": 40, "image.height": 24, "render.passes": 1}
        with self.assertRaises(vdbeam.Error) as rendered:
            vdbeam.render(vdbeam.Scene(source, {**small, **broken}))
        with vdbeam.LiveSession(vdbeam.Scene(source, {**small, **broken}), **seen.callbacks()) as live:
            with self.assertRaises(vdbeam.Error) as waited:
                live.wait(PATIENCE)
            self.assertIs(type(waited.exception), type(rendered.exception))
            self.assertEqual(str(waited.exception), str(rendered.exception))
            self.assertEqual([str(error) for error in seen.errors], [str(rendered.exception)])
            live["volume.0.density"] = "density"
            self.assertEqual(live.wait(PATIENCE).passes, 1)

    def test_an_exception_in_a_callback_arrives(self):
        def fail(image):
            raise KeyError("mine")
        with vdbeam.LiveSession(scene(**{"render.passes": ENDLESS}), on_image=fail) as live:
            with self.assertRaisesRegex(KeyError, "mine"):
                live.wait(PATIENCE)

    def test_false_ends_the_render(self):
        with vdbeam.LiveSession(scene(**{"render.passes": ENDLESS}), on_image=lambda image: False) as live:
            stopped = live.wait(PATIENCE)
            self.assertLess(stopped.passes, ENDLESS)
            live["camera.fov"] = 20
            self.assertEqual(live.wait(PATIENCE).edit, 2)

    def test_a_closed_session(self):
        live = vdbeam.LiveSession(scene())
        live.close()
        live.close()
        with self.assertRaisesRegex(RuntimeError, "closed"):
            live["camera.fov"] = 20
        with self.assertRaisesRegex(RuntimeError, "closed"):
            live.wait()


class Endings(unittest.TestCase):
    def test_keyboard_interrupt_and_time(self):
        with vdbeam.LiveSession(scene(**{"render.passes": ENDLESS})) as live:
            timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                live.wait()
            timer.join()
            self.assertIsNone(live.wait(0.1))
            live.stop()
            live.wait(PATIENCE)

    def test_a_callback_may_close(self):
        there, closed = threading.Event(), threading.Event()

        def close(image):
            there.wait(PATIENCE)
            live.close()
            closed.set()
        live = vdbeam.LiveSession(scene(**{"render.passes": ENDLESS}), on_image=close)
        there.set()
        self.assertTrue(closed.wait(PATIENCE))

    def test_a_session_that_nobody_needs_ends(self):
        seen = Seen()
        live = vdbeam.LiveSession(scene(**{"render.passes": ENDLESS}), **seen.callbacks())
        self.assertTrue(seen.first.wait(PATIENCE))
        gone = weakref.ref(live)
        del live
        gc.collect()
        self.assertIsNone(gone())
        images = len(seen.images)
        time.sleep(1)
        self.assertEqual(len(seen.images), images)

    def test_the_lock_is_released(self):
        ticks = []
        with vdbeam.LiveSession(scene(**{"render.passes": ENDLESS}), on_image=lambda image: None) as live:
            done = threading.Event()

            def tick():
                while not done.wait(0.01):
                    ticks.append(1)
            thread = threading.Thread(target=tick)
            thread.start()
            live.wait(0.5)
            done.set()
            thread.join()
        self.assertGreater(len(ticks), 3)

    def test_a_program_may_end_while_a_session_renders(self):
        program = f"""
import vdbeam
live = vdbeam.LiveSession(vdbeam.Scene({SCENE!r}, {{"render.passes": {ENDLESS}}}), on_image=lambda image: None)
live.wait(0.3)
print("done")
"""
        result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=PATIENCE,
                                env={**os.environ, "PYTHONPATH": str(built_module.PACKAGE)})
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "done\n", ""))


if __name__ == "__main__":
    unittest.main()
