#!/usr/bin/env python3
"""Disks that fail in the middle of writing, as lost network mounts do: one clear line, no half file, and
an image that was there before stays as it was.

failing_disk.cpp is preloaded and lets one call fail: creating, writing, flushing, syncing, closing or
renaming an output.
"""
import errno
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

VDBEAM, SHIM = os.environ["VDBEAM_BINARY"], os.environ["VDBEAM_FAILING_DISK"]
SMOKE = pathlib.Path(__file__).resolve().parents[2] / "data/smoke/smoke.0001.vdb"
CALLS = ("open", "fwrite", "fflush", "fsync", "fclose", "rename")
MOUNT = "; the disk or its network mount fails: check it or write elsewhere"
ERRORS = {"EIO": "Input/output error" + MOUNT, "ESTALE": "Stale file handle" + MOUNT,
          "ETIMEDOUT": "Connection timed out" + MOUNT,
          "ENOSPC": "No space left on device; free some space or write elsewhere",
          "EDQUOT": "Disk quota exceeded; free some space or write elsewhere"}


class FailingDisk(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vdbeam_failing_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def render(self, call, error, word, *more, output="out.exr", passes=1):
        """With `call` failing for outputs whose names hold `word`."""
        environment = {**os.environ, "LC_ALL": "C"}
        if call:
            environment.update(LD_PRELOAD=SHIM, VDBEAM_TEST_FAULT=f"{call} {getattr(errno, error)} {word}",
                               # A sanitizer's library would insist on being the first.
                               ASAN_OPTIONS="verify_asan_link_order=0")
        return subprocess.run(
            [VDBEAM, "render", str(SMOKE), "-o", f"{self.folder}/{output}", "--passes", str(passes),
             "--resolution", "16x9", "--set", "render.photons=500", "--threads", "1", *more],
            env=environment, capture_output=True, text=True, check=False)

    def test_second_signal_kills(self):
        """A disk that never answers cannot be interrupted."""
        for number in (signal.SIGINT, signal.SIGTERM):
            environment = {**os.environ, "LD_PRELOAD": SHIM, "VDBEAM_TEST_FAULT": "fsync -1 out.exr",
                           "ASAN_OPTIONS": "verify_asan_link_order=0"}
            with subprocess.Popen([VDBEAM, "render", str(SMOKE), "-o", f"{self.folder}/out.exr", "--passes", "1",
                                   "--resolution", "16x9", "--set", "render.photons=500", "-q"],
                                  env=environment, stderr=subprocess.PIPE, text=True) as process:
                self.assertEqual(process.stderr.readline(), "waiting\n")
                process.send_signal(number)
                time.sleep(0.6)
                self.assertIsNone(process.poll())
                while process.poll() is None:  # signals that come too close to each other count as one
                    process.send_signal(number)
                    time.sleep(0.05)
                self.assertEqual(process.returncode, -number)
                self.assertNotIn("out.exr", self.names())

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())

    def check_refusal(self, result, name, error):
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn(f"{name}: cannot be written: {ERRORS[error]}\n", result.stderr)

    def test_every_call_and_every_error(self):
        cases = [(call, "EIO") for call in CALLS] + [("fsync", error) for error in ERRORS]
        for case in [*cases, ("rename", "ESTALE"), ("fclose", "EDQUOT"), ("open", "ESTALE")]:
            with self.subTest(case):
                result = self.render(*case, "out.exr", "-q")
                self.check_refusal(result, "out.exr", case[1])
                self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
                self.assertEqual(self.names(), [])

    def test_what_was_there_stays(self):
        old = self.folder / "out.exr"
        old.write_bytes(b"an older image")
        for call in CALLS:
            self.check_refusal(self.render(call, "ESTALE", "out.exr"), "out.exr", "ESTALE")
            self.assertEqual(self.names(), ["out.exr"])
            self.assertEqual(old.read_bytes(), b"an older image")

    def test_previews_and_reports_too(self):
        for name, option in (("p.png", "--preview"), ("r.json", "--report"), ("s.json", "--summary")):
            for call in ("fwrite", "fsync", "fclose"):
                with self.subTest(name=name, call=call):
                    result = self.render(call, "EIO", name, option, f"{self.folder}/{name}")
                    self.check_refusal(result, name, "EIO")
                    self.assertEqual(self.names(), ["out.exr"])
                    (self.folder / "out.exr").unlink()

    def test_a_checkpoint_is_not_worth_a_frame(self):
        for call in ("fwrite", "fsync", "rename"):
            result = self.render(call, "EIO", "checkpoint", "--checkpoint", "1", passes=3)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("out.checkpoint.exr: cannot be written: Input/output error", result.stderr)
            self.assertEqual(self.names(), ["out.exr"])

    def test_a_batch_goes_on_and_is_finished_later(self):
        batch = ("-f", "1-3", "--skip-existing")
        result = self.render("fclose", "EIO", "o.0002", *batch, output="o.####.exr")
        self.check_refusal(result, "o.0002.exr", "EIO")
        self.assertIn("2 done (1,3), 1 failed (2)", result.stderr)
        self.assertEqual(self.names(), ["o.0001.exr", "o.0003.exr"])
        result = self.render(None, None, None, *batch, output="o.####.exr")
        self.assertIn("1 done (2), 2 skipped (1,3)", result.stderr)
        self.assertEqual(self.names(), ["o.0001.exr", "o.0002.exr", "o.0003.exr"])


if __name__ == "__main__":
    sys.exit(unittest.main())
