"""Tests that run the program."""
import os
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

BINARY = os.environ.get("VDBEAM_BINARY", "build/release/vdbeam")
DATA = Path(__file__).resolve().parents[2] / "data"

# A shell starts programs in the background with SIGINT ignored, programs hand that on to those that they start, and a
# test that sends it would wait for ever.
signal.signal(signal.SIGINT, signal.default_int_handler)


def run(*command):
    """Exit status and all output of a command."""
    result = subprocess.run(command, check=False, capture_output=True, text=True)
    return result.returncode, result.stdout + result.stderr


class InTempFolder(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, name):
        """Path of a file in the folder."""
        return str(Path(self.folder.name) / name)
