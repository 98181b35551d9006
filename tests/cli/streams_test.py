#!/usr/bin/env python3
"""Standard streams that are full, closed or broken: lines are lost, frames are not, and a command
whose output is stdout says by its exit code that it could not be written."""
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import unittest

VDBEAM = os.environ["VDBEAM_BINARY"]
DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
FOG = str(DATA / "fog.vdb")  # small: what is tested does not depend on the volume
SMALL = ["--passes", "2", "--resolution", "32x18", "--set", "render.estimator=path", "--threads", "1"]
LOST = ["2>/dev/full", "2>&-", ">/dev/full", ">&-", "<&-", "<&- >&- 2>&-", ">/dev/full 2>/dev/full"]


class Streams(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vdbeam_streams_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_in_shell(self, redirection, *words):
        # The shell gives vdbeam its own streams where nothing is redirected.
        return subprocess.run(["sh", "-c", f'exec "$0" "$@" {redirection}', VDBEAM, *words],
                              cwd=self.folder, capture_output=True, text=True, check=False)

    def run_with_broken(self, stream, *words):
        """`stream` is a pipe that nobody reads any more."""
        read_end, write_end = os.pipe()
        os.close(read_end)
        try:
            streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, stream: write_end}
            return subprocess.run([VDBEAM, *words], cwd=self.folder, **streams, check=False)
        finally:
            os.close(write_end)

    def check_frames(self, result, case):
        self.assertEqual(result.returncode, 0, f"{case}: {result.stderr}")
        for name in ("o.0001.exr", "o.0002.exr"):
            self.assertTrue((self.folder / name).exists(), case)
            (self.folder / name).unlink()

    def test_a_lost_log_costs_no_frame(self):
        words = ["render", FOG, "-f", "1-2", "-o", "o.####.exr", "--progress", "openjd", *SMALL]
        for redirection in LOST:
            self.check_frames(self.run_in_shell(redirection, *words), redirection)
        for stream in ("stdout", "stderr"):
            self.check_frames(self.run_with_broken(stream, *words), f"broken {stream}")

    def test_errors_keep_their_exit_code(self):
        for redirection in LOST:
            result = self.run_in_shell(redirection, "render", "nothere.vdb")
            self.assertEqual(result.returncode, 2, redirection)

    def outputs(self):
        result = self.run_in_shell("", "render", FOG, "-o", "a.exr", *SMALL)
        self.assertEqual(result.returncode, 0, result.stderr)
        return [["info", FOG], ["init", FOG], ["plan", FOG, "--no-pilot"],
                ["plan", FOG, "--no-pilot", "--json"],
                ["compare", "a.exr", "a.exr"], ["compare", "a.exr", "a.exr", "--json"],
                ["farm", "slurm", FOG, "-f", "1", "-o", "o.exr"], ["--help"], ["--version"],
                ["--help-scene"], ["render", "--help"]]

    def test_a_lost_output_is_an_error(self):
        for words in self.outputs():
            for redirection, reason in ((">/dev/full", "No space left on device"),
                                        (">&-", "Bad file descriptor")):
                result = self.run_in_shell(redirection, *words)
                self.assertEqual(result.returncode, 3, f"{words} {redirection}: {result.stderr}")
                self.assertIn(f"standard output: cannot be written: {reason}\n", result.stderr)
                self.assertNotIn("internal error", result.stderr)

    def test_a_reader_that_has_enough_ends_the_command_silently(self):
        for words in self.outputs():
            result = self.run_with_broken("stdout", *words)
            self.assertEqual(result.returncode, -signal.SIGPIPE, words)
            self.assertNotIn(b"cannot be written", result.stderr)


if __name__ == "__main__":
    unittest.main()
