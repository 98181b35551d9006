#!/usr/bin/env python3
"""Time limits and signals hold inside every stage, whatever a setting makes it cost; logs that nobody
reads, lost terminals and kills at the wrong moment cost nothing."""
import json
import os
import pathlib
import select
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

VDBEAM = os.environ["VDBEAM_BINARY"]
DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
CLOUD = str(DATA / "cloud.vdb")
SMALL = ["--resolution", "32x18", "--set", "render.photons=2000"]
LONG_DEEP = ["--resolution", "2048x1152", "--set", "image.deep=true", "--set", "image.deep_alpha=0.02"]
LONG_SAMPLES = ["--resolution", "16x16", "--set", "render.direct_samples=1000000000"]
SLOW_VOLUME = ["--set", "volume.0.interpolation=cubic", "--set", "volume.0.noise_amplitude=0.05", "--set",
               "volume.0.noise_octaves=12", "--resolution", "16x16"]
PATIENCE = 60  # seconds, of a stage that would take many minutes


class Interruption(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vdbeam_interruption_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def words(self, *more):
        return [VDBEAM, "render", CLOUD, "-o", "o.exr", *more]

    def start(self, *more, **streams):
        child = subprocess.Popen(self.words(*more), cwd=self.folder,
                                 **{"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, **streams})
        self.addCleanup(child.kill)
        return child

    def wait_for_line(self, child, word):
        text = b""
        while word not in text:
            ready = select.select([child.stderr], [], [], PATIENCE)[0]
            self.assertTrue(ready, text)
            piece = os.read(child.stderr.fileno(), 4096)
            self.assertTrue(piece, text)
            text += piece
        return text

    def check_time_limit(self, *more):
        result = subprocess.run(self.words("--time", "1", *more), cwd=self.folder, capture_output=True,
                                timeout=PATIENCE, check=False)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn(b"quick look", result.stderr)
        self.assertTrue((self.folder / "o.exr").exists())

    def check_signal(self, *more, number=signal.SIGTERM):
        child = self.start("--passes", "4", *more)
        self.wait_for_line(child, b"16x16" if "16x16" in more else b"2048x1152")
        time.sleep(1)
        child.send_signal(number)
        _, log = child.communicate(timeout=PATIENCE)
        self.assertEqual(child.returncode, 128 + number, log)

    def test_time_limit_holds_while_deep_pixels_are_cut(self):
        self.check_time_limit(*LONG_DEEP)

    def test_signal_holds_while_deep_pixels_are_cut(self):
        self.check_signal(*LONG_DEEP)

    def test_time_limit_holds_among_shadow_rays(self):
        for estimator in ("beam", "path"):
            self.check_time_limit(*LONG_SAMPLES, "--estimator", estimator)

    def test_time_limit_holds_while_volumes_are_prepared(self):
        """Cubic interpolation and 12 octaves of noise: minutes of work before the first pass."""
        result = subprocess.run(self.words("--time", "1", *SLOW_VOLUME), cwd=self.folder, capture_output=True,
                                timeout=PATIENCE, check=False)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn(b"the time limit of 1.0s ended the frame while its files were read", result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_signal_holds_among_shadow_rays(self):
        self.check_signal(*LONG_SAMPLES, "--estimator", "path")

    def test_auto_takes_path_where_light_paths_never_end(self):
        result = subprocess.run(self.words("--passes", "1", "--resolution", "16x16", "--report", "r.json", "--set",
                                           "volume.0.extinction=1e6", "--set", "render.estimator=auto"),
                                cwd=self.folder, capture_output=True, timeout=PATIENCE, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(b"too many to trace photons", result.stderr)
        self.assertEqual(json.loads((self.folder / "r.json").read_text())["plan"]["estimator"], "path")

    def test_a_lost_terminal_leaves_a_checkpoint(self):
        child = self.start("--passes", "1000000", "--checkpoint", "1", *SMALL)
        self.wait_for_line(child, b"32x18")
        while not (self.folder / "o.checkpoint.exr").exists():
            self.assertIsNone(child.poll())
            time.sleep(0.05)
        child.send_signal(signal.SIGHUP)
        child.communicate(timeout=PATIENCE)
        self.assertEqual(child.returncode, 129)
        self.assertTrue((self.folder / "o.checkpoint.exr").exists())

    def test_nohup_is_heeded(self):
        child = self.start("--passes", "20", *SMALL, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        self.wait_for_line(child, b"32x18")
        child.send_signal(signal.SIGHUP)
        child.communicate(timeout=PATIENCE)
        self.assertEqual(child.returncode, 0)

    def test_a_log_that_nobody_reads_loses_lines_and_no_frame(self):
        read_end, write_end = os.pipe()
        self.addCleanup(os.close, read_end)
        os.write(write_end, b"x" * 65536)  # a pipe's usual size
        child = subprocess.Popen([VDBEAM, "render", CLOUD, "-f", "1-3", "-o", "o.####.exr", "--passes", "1",
                                  *SMALL], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=write_end)
        self.addCleanup(child.kill)
        os.close(write_end)
        self.assertEqual(child.wait(timeout=PATIENCE), 0)
        self.assertEqual(len(list(self.folder.glob("o.*.exr"))), 3)

    def test_lost_lines_are_counted_once_the_log_is_read_again(self):
        read_end, write_end = os.pipe()
        self.addCleanup(os.close, read_end)
        os.write(write_end, b"x" * 65536)
        child = self.start("--passes", "1000000", "--checkpoint", "1", *SMALL, stderr=write_end)
        os.close(write_end)
        while not (self.folder / "o.checkpoint.exr").exists():
            self.assertIsNone(child.poll())
            time.sleep(0.05)
        os.set_blocking(read_end, False)
        while True:
            try:
                os.read(read_end, 65536)
            except BlockingIOError:
                break
        child.send_signal(signal.SIGTERM)
        self.assertEqual(child.wait(timeout=PATIENCE), 143)
        text = os.read(read_end, 65536).decode()
        self.assertRegex(text, r"^\(\d+ lines? of the log lost: nobody read it\)\n")
        self.assertIn("interrupted", text)

    def test_a_report_is_there_before_its_image(self):
        """Killed as soon as the image has its name, a frame has lost nothing."""
        child = self.start("--passes", "2", "--report", "r.json", *SMALL)
        while not (self.folder / "o.exr").exists():
            if child.poll() is not None:
                break
        child.kill()
        child.communicate()
        self.assertTrue((self.folder / "o.exr").exists())
        self.assertEqual(json.loads((self.folder / "r.json").read_text())["stopped_by"], "passes")

    def test_slow_work_is_no_silence_slow(self):
        """Side by side, since the line comes after ten seconds; on one thread each, since others share the machine."""
        one_thread = ["--passes", "1", "--threads", "1"]
        passes = self.start(*one_thread, *LONG_SAMPLES, "--estimator", "path")
        reading = self.start(*one_thread, *SLOW_VOLUME)
        for child, line in ((passes, b"no pass yet, still working\n"), (reading, b"reading the next frame, still working\n")):
            log = self.wait_for_line(child, b"still working")
            child.kill()
            self.assertIn(line, log)

    def test_time_limit_holds_while_meshes_are_read(self):
        """A mesh file whose reading takes seconds, and a limit that leaves it half of one."""
        side = 700
        with open(self.folder / "large.obj", "w", encoding="ascii") as mesh:
            for y in range(side):
                mesh.write("".join(f"v {x} {x * y % 7} {y}\n" for x in range(side)))
            for y in range(side - 1):
                mesh.write("".join(f"f {y * side + x + 1} {y * side + x + 2} {y * side + x + side + 1}\n"
                                   for x in range(side - 1)))
        (self.folder / "m.toml").write_text('[[mesh]]\nfile = "large.obj"\n[[light]]\ntype = "sky"\n')
        result = subprocess.run([VDBEAM, "render", "m.toml", "-o", "o.exr", "--time", "0.01"], cwd=self.folder,
                                capture_output=True, timeout=PATIENCE, check=False)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn(b"ended the frame while its files were read", result.stderr)
        self.assertFalse((self.folder / "o.exr").exists())


if __name__ == "__main__":
    unittest.main()
