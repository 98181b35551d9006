#!/usr/bin/env python3
"""`vdbeam live`: a scene that is edited is shown again, with what did not change kept."""
import json
import os
import pathlib
import pty
import queue
import shutil
import signal
import subprocess
import sys
import threading
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import DATA, InTempFolder  # noqa: E402

VDBEAM = os.environ["VDBEAM_BINARY"]
PATIENCE = 120  # seconds, of a machine that does much else

SCENE = """
[image]
width = 48
height = 32
[camera]
position = [0, 0, {distance}]
look_at = [0, 0, 0]
[[volume]]
file = "fog.vdb"
extinction = 2
[[light]]
type = "distant"
direction = [-1, -1, -1]
irradiance = 3
exposure = {exposure}
[[light]]
type = "environment"
radiance = 0.1
[render]
passes = 4
photons = 2000
"""


def scene(distance=5, exposure=0):
    return SCENE.format(distance=distance, exposure=exposure)


class Live:
    """A running `vdbeam live` and its events."""

    def __init__(self, *options):
        self.process = subprocess.Popen([VDBEAM, "live", "fog.toml", "--progress", "json", "-q", "--threads", "1", *options],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.events = queue.Queue()
        self.seen = []  # all that `wait` has read
        self.thread = threading.Thread(target=self._read, daemon=True)
        self.thread.start()

    def _read(self):
        for line in self.process.stdout:
            self.events.put(json.loads(line))

    def wait(self, event, **keys):
        """The next event of this kind with these values; those before it are dropped."""
        while True:
            found = self.events.get(timeout=PATIENCE)
            self.seen.append(found)
            if found["event"] == event and all(found[key] == value for key, value in keys.items()):
                return found

    def end(self):
        self.process.send_signal(signal.SIGINT)
        _, errors = self.process.communicate(timeout=PATIENCE)
        return self.process.returncode, errors


class LiveTest(InTempFolder):
    def setUp(self):
        super().setUp()
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder.name)
        shutil.copy(DATA / "fog.vdb", "fog.vdb")
        self.save(scene())
        self.live = None

    def tearDown(self):
        if self.live and self.live.process.poll() is None:
            self.live.process.kill()
            self.live.process.communicate()
        super().tearDown()

    def save(self, text):
        pathlib.Path("fog.new").write_text(text)
        os.replace("fog.new", "fog.toml")

    def start(self, *options):
        self.live = Live(*options)
        return self.live

    def preview(self):
        return pathlib.Path("fog.live.png").read_bytes()

    def test_shows_the_scene_and_waits(self):
        live = self.start()
        self.assertEqual(live.wait("edit")["edit"], 1)
        self.assertEqual(live.wait("image", passes=4)["path"], str(pathlib.Path("fog.live.png").resolve()))
        self.assertEqual(self.preview()[:4], b"\x89PNG")
        self.assertEqual(live.end(), (0, ""))

    def test_mixes_an_edit_of_a_light(self):
        live = self.start()
        live.wait("image", passes=4)
        before = self.preview()
        self.save(scene(exposure=-2))
        edit = live.wait("edit")
        self.assertTrue(edit["mixed"])
        self.assertEqual(edit["changed"], ["light.0.exposure"])
        live.wait("image", edit=2, mixed=True, passes=4)
        dark = self.preview()
        self.assertNotEqual(dark, before)
        self.save(scene(exposure=0))
        live.wait("image", edit=3, mixed=False, passes=4)
        self.assertEqual(self.preview(), before)

    def test_keeps_the_volume_where_the_camera_moves(self):
        live = self.start()
        self.assertEqual(live.wait("edit")["grids_read"], 1)
        live.wait("image")
        self.save(scene(distance=6))
        edit = live.wait("edit")
        self.assertEqual((edit["mixed"], edit["grids_read"], edit["changed"]), (False, 0, ["camera.position"]))
        self.assertEqual(edit["kept"], ["medium, lights and surfaces, since no key that shapes them has changed"])
        image = live.wait("image", edit=2, passes=4)
        self.assertEqual(image["stage"], "pass")
        self.assertGreater(image["peak_memory"], 1 << 20)

    def test_reads_a_volume_that_was_written_anew(self):
        live = self.start()
        live.wait("finished")
        shutil.copy(DATA / "fog.vdb", "other.vdb")
        os.replace("other.vdb", "fog.vdb")
        edit = live.wait("edit", edit=2)
        self.assertEqual((edit["mixed"], edit["grids_read"], edit["changed"]), (False, 1, []))
        live.wait("finished")

    def test_reports_a_mistake_and_goes_on(self):
        live = self.start()
        live.wait("finished")
        self.save(scene() + "bogus = 1\n")
        self.assertIn("unknown key render.bogus", live.wait("message", level="error")["text"])
        self.save(scene(exposure=1))
        live.wait("image", edit=2, mixed=True)

    def test_waits_for_a_file_that_is_being_written(self):
        live = self.start()
        live.wait("finished")
        pathlib.Path("fog.toml").write_text("")  # as editors do before they write
        pathlib.Path("fog.toml").write_text(scene(exposure=1))
        live.wait("image", edit=2, mixed=True)

    def test_a_scene_that_is_saved_as_it_was_changes_nothing(self):
        live = self.start()
        live.wait("finished")
        self.save(scene())
        self.save(scene(exposure=1))
        self.assertEqual(live.wait("edit")["edit"], 2)

    def test_reports_that_a_mistake_is_repaired(self):
        live = self.start()
        live.wait("finished")
        self.save(scene() + "bogus = 1\n")
        live.wait("message", level="error")
        self.save(scene())
        self.assertIn("can be read again", live.wait("message", level="note")["text"])
        self.save(scene(exposure=1))
        self.assertEqual(live.wait("edit")["edit"], 2)

    def test_a_volume_that_is_being_written_is_no_mistake(self):
        live = self.start()
        live.wait("finished")
        whole = pathlib.Path("fog.vdb").read_bytes()
        with open("fog.vdb", "wb") as file:
            for begin in range(0, len(whole), len(whole) // 20 + 1):
                file.write(whole[begin:begin + len(whole) // 20 + 1])
                file.flush()
                time.sleep(0.05)
        live.wait("finished")
        self.assertEqual([event for event in live.seen if event["event"] == "message"], [])

    def test_a_damaged_volume_is_reported_once(self):
        live = self.start()
        live.wait("finished")
        pathlib.Path("fog.vdb").write_bytes(b"no volume")
        self.assertIn("fog.vdb", live.wait("message", level="error")["text"])
        shutil.copy(DATA / "fog.vdb", "fog.vdb")
        live.wait("finished")
        self.assertEqual(sum(event["event"] == "message" for event in live.seen), 1)

    def test_names_a_light_that_is_added_or_removed(self):
        live = self.start()
        live.wait("finished")
        self.save(scene() + "[[light]]\ntype = 'point'\nposition = [1, 1, 1]\nintensity = 1\n")
        self.assertEqual(live.wait("edit")["changed"], ["light.2"])
        self.save(scene())
        self.assertEqual(live.wait("edit")["changed"], ["light.2"])

    def test_an_edit_of_layers_renders_nothing_anew(self):
        live = self.start()
        live.wait("image", passes=4)
        self.save(scene() + "[[layer]]\nname = 'beauty'\n[[layer]]\nname = 'depth'\n")
        self.assertTrue(live.wait("edit")["mixed"])
        live.wait("image", edit=2, mixed=False, passes=4)

    def test_the_status_line_has_passes_and_error(self):
        main, terminal = pty.openpty()
        process = subprocess.Popen([VDBEAM, "live", "fog.toml", "--threads", "1"], stderr=terminal,
                                   env=dict(os.environ, TERM="xterm"))
        os.close(terminal)
        shown = b""
        while b"Ctrl+C ends" not in shown:
            shown += os.read(main, 4096)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(PATIENCE), 0)
        os.close(main)
        self.assertRegex(shown, rb"finished: 4 passes, error [0-9.e-]+ \([0-9.e-]+ to [0-9.e-]+\); waiting for edits")
        self.assertNotIn(b"nan", shown)

    def test_stops_a_long_render_for_an_edit(self):
        long = scene().replace("passes = 4", "passes = 1000000")
        self.save(long)
        live = self.start()
        live.wait("image", passes=1)
        self.save(long.replace("extinction = 2", "extinction = 3"))
        live.wait("image", edit=2)
        self.assertEqual(live.end()[0], 0)

    def test_ends_with_its_input(self):
        """So it ends when whoever started it is killed, and so does a render."""
        self.save(scene().replace("passes = 4", "passes = 1000000"))
        for command, code in ((["live", "fog.toml"], 0), (["render", "fog.toml", "--threads", "1"], 128 + 15)):
            process = subprocess.Popen([VDBEAM, *command, "-q", "--end-with-stdin"], stdin=subprocess.PIPE,
                                       stderr=subprocess.PIPE)
            process.stdin.write(b"dropped")
            process.stdin.flush()
            with self.assertRaises(subprocess.TimeoutExpired):
                process.wait(1)
            process.communicate(timeout=PATIENCE)  # closes it
            self.assertEqual(process.returncode, code)

    def test_linear_preview_before_the_end(self):
        live = self.start("--preview", "view.exr")
        self.assertEqual(live.wait("image", passes=4)["path"], str(pathlib.Path("view.exr").resolve()))
        live.wait("finished")
        self.assertEqual(pathlib.Path("view.exr").read_bytes()[:4], b"\x76\x2f\x31\x01")

    def test_a_preview_without_a_folder_is_refused(self):
        result = subprocess.run([VDBEAM, "live", "fog.toml", "--preview", "no/view.png"], capture_output=True, text=True,
                                timeout=PATIENCE)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("--preview no/view.png: there is no folder no", result.stderr)

    def test_a_preview_that_cannot_be_written_is_reported_once(self):
        os.mkdir("view")
        live = self.start("--preview", "view/view.png")
        live.wait("finished")
        shutil.rmtree("view")
        for exposure in (1, 2, 3):
            self.save(scene(exposure=exposure))
            live.wait("finished", edit=exposure + 1)
        os.mkdir("view")
        self.save(scene(exposure=5))
        live.wait("image", edit=5)
        messages = [event["text"] for event in live.seen if event["event"] == "message"]
        self.assertEqual(len(messages), 1, messages)
        self.assertIn("view/view.png", messages[0])

    def test_never_replaces_an_input(self):
        for target in ("fog.vdb", "fog.toml"):
            os.symlink(target, "out.png")
            result = subprocess.run([VDBEAM, "live", "fog.toml", "--preview", "out.png"], capture_output=True, text=True)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("--preview", result.stderr)
            os.remove("out.png")


if __name__ == "__main__":
    unittest.main()
