#!/usr/bin/env python3
"""The viewport of the Blender add-on without Blender: its camera, the program behind it, its drawing by a stub of gpu."""
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import types
import types
import unittest
import unittest.mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools" / "blender"), str(ROOT / "tests" / "support")]

import requirements  # noqa: E402

try:
    import numpy
except ImportError as problem:
    requirements.import_failed(problem)

from program import BINARY, InTempFolder  # noqa: E402
from vdbeam_blender import meshes, temp_folder, view_camera, view_draw, viewport  # noqa: E402

PATIENCE = 120  # seconds, of a machine that does much else
IDENTITY = [[1.0 if row == column else 0.0 for column in range(4)] for row in range(4)]
SCENE = {"volume": [{"shape": "sphere", "extinction": 4.0, "albedo": 0.9}],
         "light": [{"type": "environment", "radiance": [0.2, 0.4, 0.8]}],
         "render": {"passes": 2, "photons": 2000, "estimator": "beam"}}


def frustum(left, right, bottom, top, near, far):
    """A perspective projection, as OpenGL has it."""
    return [[2 * near / (right - left), 0, (right + left) / (right - left), 0],
            [0, 2 * near / (top - bottom), (top + bottom) / (top - bottom), 0],
            [0, 0, -(far + near) / (far - near), -2 * far * near / (far - near)], [0, 0, -1, 0]]


def parallel(left, right, bottom, top, near, far):
    """A parallel projection, as OpenGL has it."""
    return [[2 / (right - left), 0, 0, -(right + left) / (right - left)],
            [0, 2 / (top - bottom), 0, -(top + bottom) / (top - bottom)],
            [0, 0, -2 / (far - near), -(far + near) / (far - near)], [0, 0, 0, 1]]


def place(distance):
    """A camera on the z axis that looks down."""
    rows = [list(row) for row in IDENTITY]
    rows[2][3] = distance
    return rows


class Cameras(unittest.TestCase):
    def test_perspective(self):
        """A window of 1.6 x 0.8 at distance 1, its middle at (0.2, -0.1)."""
        keys, aspect = view_camera.view_keys(frustum(-0.06, 0.1, -0.05, 0.03, 0.1, 100), 200, 100)
        self.assertAlmostEqual(keys["fov"], math.degrees(2 * math.atan(0.4)))
        self.assertAlmostEqual(keys["shift_x"], 0.2 / 1.6)
        self.assertAlmostEqual(keys["shift_y"], -0.1 / 0.8)
        self.assertAlmostEqual(keys["near"], 0.1)
        self.assertAlmostEqual(keys["far"], 100, places=6)
        self.assertAlmostEqual(aspect, 1)

    def test_pixel_aspect(self):
        self.assertAlmostEqual(view_camera.view_keys(frustum(-2, 2, -1, 1, 1, 9), 100, 100)[1], 2)

    def test_parallel(self):
        """Blender draws what is behind the viewer too: the camera stands on the near plane."""
        window = parallel(-3, 5, -1, 3, -50, 100)
        keys, aspect = view_camera.view_keys(window, 200, 100)
        self.assertEqual(keys["projection"], "orthographic")
        self.assertAlmostEqual(keys["view_height"], 4)
        self.assertAlmostEqual(keys["shift_x"], 1 / 8)
        self.assertAlmostEqual(keys["shift_y"], 1 / 4)
        self.assertAlmostEqual(keys["far"], 150)
        self.assertAlmostEqual(aspect, 1)
        self.assertAlmostEqual(view_camera.view_matrix(place(7), window)[2][3], 57)
        self.assertEqual(view_camera.view_matrix(place(7), frustum(-1, 1, -1, 1, 1, 9))[2][3], 7)

    def test_sizes(self):
        self.assertEqual(view_camera.image_size(1000, 501, 2), (500, 250))
        width, height = view_camera.image_size(7680, 4320, 1)
        self.assertLessEqual(width * height, view_camera.MOST_PIXELS)
        self.assertEqual(view_camera.image_size(1, 1, 8), (1, 1))
        self.assertEqual([view_camera.pixel_size("AUTO"), view_camera.pixel_size("AUTO", 2.0), view_camera.pixel_size("4")],
                         [1, 2, 4])


class Programs(unittest.TestCase):
    def setUp(self):
        self.preview = viewport.Preview(str(pathlib.Path(BINARY).resolve()), threads=1)
        self.addCleanup(self.preview.close)

    def view(self, distance=5.0, size=(48, 32)):
        half = 0.3
        window = frustum(-half * size[0] / size[1], half * size[0] / size[1], -half, half, 1, 100)
        return {"size": size, "window": window, "camera_to_world": place(distance)}

    def wait(self, wanted):
        """The state for which `wanted(pixels, text)` holds first."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            self.preview.update()
            _, pixels, text = self.preview.state()
            if wanted(pixels, text):
                return pixels
            time.sleep(0.02)
        return self.fail(f"nothing new: {text}")

    def test_image_of_the_view(self):
        self.preview.show_scene(SCENE, opaque=True)
        self.assertIsNone(self.preview.render)  # there is no view yet
        self.preview.show_view(self.view())
        pixels = self.wait(lambda pixels, text: text == "Done")
        self.assertEqual(pixels.shape, (32, 48, 4))
        self.assertEqual(pixels.dtype, numpy.float32)
        self.assertTrue(numpy.allclose(pixels[0, 0], [0.2, 0.4, 0.8, 1], atol=2e-3))  # linear, the sky
        self.assertFalse(numpy.allclose(pixels[16, 24], [0.2, 0.4, 0.8, 1], atol=1e-2))
        self.preview.show_view(self.view(size=(32, 32)))
        self.assertEqual(self.wait(lambda pixels, text: pixels.shape[1] == 32).shape, (32, 32, 4))

    def test_rows_begin_at_the_bottom(self):
        """A sphere above the middle is in the upper half, whose rows come last."""
        scene = {**SCENE, "volume": [{**SCENE["volume"][0], "translate": [0.0, 1.5, 0.0], "extinction": 50.0, "albedo": 0.0}]}
        self.preview.show_scene(scene, opaque=False)
        self.preview.show_view(self.view(distance=8.0))
        alpha = self.wait(lambda pixels, text: text == "Done")[..., 3]
        self.assertGreater(alpha[16:].sum(), 10)
        self.assertLess(alpha[:12].sum(), 0.1)

    def test_edits_wait_for_the_look_at_the_last(self):
        self.preview.show_scene(SCENE, opaque=True)
        self.preview.show_view(self.view())
        first = self.preview.written
        self.preview.show_view(self.view(6.0))
        self.assertEqual(self.preview.written, first)
        self.wait(lambda pixels, text: self.preview.written != first)
        self.wait(lambda pixels, text: text == "Done" and not self.preview.is_busy())

    def test_files_of_meshes_go_when_no_scene_names_them(self):
        for number in range(viewport.KEPT_SCENES + 2):
            (pathlib.Path(self.preview.folder) / f"{number}.ply").write_bytes(b"")
            self.preview.shown_files = {f"{number}.ply"}
            self.preview.sweep()
        left = sorted(path.name for path in pathlib.Path(self.preview.folder).glob("*.ply"))
        self.assertEqual(left, [f"{number}.ply" for number in range(2, viewport.KEPT_SCENES + 2)])

    def test_files_of_images_stay_while_a_scene_names_them(self):
        names = ("image_a.png", "image_b.exr", "image_c.jpg")
        for name in names:
            (pathlib.Path(self.preview.folder) / name).write_bytes(b"")
        material = {"type": "diffuse", "texture": names[0]}
        self.preview.show_scene({"mesh": [{"file": "a.ply", "material": material}],
                                 "light": [{"type": "environment", "image": names[1]}]}, opaque=True)
        self.preview.sweep()
        self.assertEqual([os.path.exists(os.path.join(self.preview.folder, name)) for name in names], [True, True, False])

    def test_mistakes_are_shown_and_mended(self):
        self.preview.show_scene({**SCENE, "render": {"passes": 2, "bogus": 1}}, opaque=True)
        self.preview.show_view(self.view())
        self.wait(lambda pixels, text: "bogus" in text)
        self.preview.show_scene(SCENE, opaque=True)
        self.wait(lambda pixels, text: text == "Done")

    def test_scene_that_is_mended_while_the_program_ends(self):
        """The program has refused the scene, but still runs when the next one is written."""
        self.preview.show_scene({**SCENE, "render": {"passes": 2, "bogus": 1}}, opaque=True)
        self.preview.show_view(self.view())
        refused = self.preview.render.child
        refused.wait(PATIENCE)
        child = types.SimpleNamespace(code=None, poll=lambda: child.code)
        self.preview.render.child = child
        self.preview.show_scene(SCENE, opaque=True)
        child.code = 2
        self.wait(lambda pixels, text: text == "Done")

    def test_program_that_refuses_its_scene_is_not_started_again(self):
        self.preview.show_scene({**SCENE, "render": {"passes": 2, "bogus": 1}}, opaque=True)
        self.preview.show_view(self.view())
        first = self.preview.render
        first.child.wait(PATIENCE)
        for _ in range(3):
            self.preview.update()
        self.assertIs(self.preview.render, first)

    def test_close_ends_the_program_and_removes_the_folder(self):
        self.preview.show_scene({**SCENE, "render": {"passes": 1000000}}, opaque=True)
        self.preview.show_view(self.view())
        self.wait(lambda pixels, text: pixels is not None)
        child = self.preview.render.child
        begin = time.monotonic()
        self.preview.close()
        self.assertLess(time.monotonic() - begin, 1)  # nobody waits
        child.wait(PATIENCE)
        end = time.monotonic() + PATIENCE
        while os.path.exists(self.preview.folder) and time.monotonic() < end:
            time.sleep(0.05)
        self.assertFalse(os.path.exists(self.preview.folder))


class Rows(unittest.TestCase):
    def test_distinct_rows(self):
        table = numpy.random.default_rng(1).integers(0, 3, (2000, 4)).astype(numpy.float32) / 7
        table[::7, 0] *= -0.0
        rows, places = meshes.distinct_rows(table)
        self.assertEqual(len(rows), len(numpy.unique(table, axis=0)))
        self.assertTrue(numpy.array_equal(rows[places], table))


class Children(InTempFolder):
    def test_a_killed_blender_leaves_no_program(self):
        """A Python that stands for Blender is killed: the program ends."""
        script = f"""
import sys, time
sys.path.insert(0, {str(ROOT / "tools" / "blender")!r})
from vdbeam_blender import viewport
preview = viewport.Preview({str(pathlib.Path(BINARY).resolve())!r}, threads=1)
preview.show_scene({ {**SCENE, "render": {"passes": 1000000}}!r}, True)
preview.show_view({ {"size": (48, 32), "window": frustum(-1, 1, -1, 1, 1, 100), "camera_to_world": place(5.0)}!r})
print(preview.render.child.pid, preview.folder, flush=True)
time.sleep({PATIENCE})
"""
        blender = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True,
                                   env={**os.environ, "TMPDIR": self.folder.name})
        pid, folder = blender.stdout.readline().split()
        pid = int(pid)
        blender.send_signal(signal.SIGKILL)
        blender.wait()
        blender.stdout.close()
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end and self.runs(pid):
            time.sleep(0.05)
        self.assertFalse(self.runs(pid))
        # The next one removes what it left, but nothing that is in use.
        left = pathlib.Path(folder)
        self.assertTrue(left.exists())
        with unittest.mock.patch.object(tempfile, "tempdir", self.folder.name):
            first, second = temp_folder.TempFolder(), temp_folder.TempFolder()
        self.assertFalse(left.exists())
        self.assertTrue(os.path.exists(first.name))
        for one in (first, second):
            one.cleanup()
            self.assertFalse(os.path.exists(one.name))

    def runs(self, pid):
        """Whether a process is there and no zombie."""
        try:
            state = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
        except OSError:
            return False
        return state != "Z"


class Drawings(unittest.TestCase):
    def test_uploads_once_and_restores_the_state(self):
        calls = []
        texture = object()
        gpu = types.SimpleNamespace(
            types=types.SimpleNamespace(
                Buffer=lambda kind, count, data: calls.append(("buffer", kind, count, data.shape)) or "data",
                GPUTexture=lambda size, format, data: calls.append(("texture", size, format, data)) or texture),
            state=types.SimpleNamespace(blend_set=lambda mode: calls.append(("blend", mode))))
        engine = types.SimpleNamespace(bind_display_space_shader=lambda scene: calls.append(("bind", scene)),
                                       unbind_display_space_shader=lambda: calls.append(("unbind",)))
        drawing = view_draw.Drawing(gpu, lambda *words: calls.append(("draw", *words)))
        drawing.draw(engine, "scene", None, 640, 480)
        self.assertEqual(calls, [])
        pixels = numpy.zeros((2, 3, 4), numpy.float32)
        drawn = [("blend", "ALPHA_PREMULT"), ("bind", "scene"), ("draw", texture, (0, 0), 640, 480), ("unbind",),
                 ("blend", "NONE")]
        drawing.draw(engine, "scene", pixels, 640, 480)
        self.assertEqual(calls, [("buffer", "FLOAT", 24, (24,)), ("texture", (3, 2), "RGBA16F", "data"), *drawn])
        calls.clear()
        drawing.draw(engine, "scene", pixels, 640, 480)
        self.assertEqual(calls, drawn)

    def test_status(self):
        self.assertEqual(viewport.status_text({"event": "image", "passes": 0}), "Quick look")
        self.assertEqual(viewport.status_text({"event": "image", "passes": 3, "error": 0.01, "error_low": None}),
                         "Pass 3, error 0.01")
        self.assertEqual(viewport.status_text({"event": "message", "level": "error", "text": "line"}), "line")
        self.assertIsNone(viewport.status_text({"event": "edit"}))


if __name__ == "__main__":
    unittest.main()
