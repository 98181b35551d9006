#!/usr/bin/env python3
"""Batches whose disk is full, read-only or gone: a clear error, no half file, and once there is room
again the next run finishes the job with the same images.

The disks are small tmpfs in a mount namespace of the test's own. Skipped where this machine allows no
such namespace, unless VDBEAM_REQUIRE names disk.
"""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
from requirements import skip

VDBEAM = os.environ["VDBEAM_BINARY"]
CLOUD = pathlib.Path(__file__).resolve().parents[2] / "data/cloud.toml"
INSIDE = "VDBEAM_TEST_NAMESPACE"
CAMERA = "camera.position={keys=[[1,[0.3,1.2,7]],[9,[1.5,1.2,7]]]}"


def command(folder, frames, *more, passes=1):
    return [VDBEAM, "render", str(CLOUD), "-f", frames, "-o", f"{folder}/o.####.exr", "--passes",
            str(passes), "--resolution", "64x36", "--set", "render.photons=2000", "--set", CAMERA,
            "--threads", "1", *more]


def render(*words, **options):
    return subprocess.run(command(*words, **options), capture_output=True, text=True, check=False)


def same_picture(a, b):
    result = subprocess.run([VDBEAM, "compare", str(a), str(b), "--json"], capture_output=True,
                            text=True, check=False)
    return result.returncode == 0 and '"rmse": 0.0' in result.stdout


def stop_between_files(process, folder):
    """Stops the process if it has no file open for writing, which would keep a disk from becoming
    read-only."""
    process.send_signal(signal.SIGSTOP)
    while pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()[0] == "R":
        time.sleep(0.001)
    if not any(path.name.startswith(".") for path in folder.iterdir()):
        return True
    process.send_signal(signal.SIGCONT)
    return False


class Disk(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vdbeam_disk_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.disk, self.whole = self.folder / "disk", self.folder / "whole"
        self.disk.mkdir()
        self.whole.mkdir()

    def mount(self, *options):
        subprocess.run(["mount", *options, str(self.disk)], check=True)

    def mount_tmpfs(self, kilobytes):
        self.mount("-t", "tmpfs", "-o", f"size={kilobytes}k", "vdbeam_test")
        self.addCleanup(subprocess.run, ["umount", "-l", str(self.disk)], stderr=subprocess.DEVNULL,
                        check=False)

    def names(self):
        return sorted(path.name for path in self.disk.iterdir())

    def render_whole(self, frames, **options):
        result = render(self.whole, frames, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return max(path.stat().st_size for path in self.whole.iterdir())

    def check_complete(self, frames):
        wanted = [f"o.{frame:04}.exr" for frame in frames]
        self.assertEqual(self.names(), wanted)
        for name in wanted:
            self.assertTrue(same_picture(self.disk / name, self.whole / name), name)

    def test_full_disk_in_a_batch(self):
        size = self.render_whole("1-6")
        self.mount_tmpfs(int(3.5 * size / 1024) + 1)  # room for three images
        result = render(self.disk, "1-6")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("3 done (1-3), 3 failed (4-6)", result.stderr)
        self.assertIn("o.0005.exr: cannot be written: No space left on device; free some space or "
                      "write elsewhere", result.stderr)
        self.check_complete([1, 2, 3])
        self.mount("-o", "remount,size=10m")
        result = render(self.disk, "1-6", "--skip-existing")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("3 done (4-6), 3 skipped (1-3)", result.stderr)
        self.check_complete(range(1, 7))

    def test_full_disk_costs_a_checkpoint_and_not_the_frame(self):
        size = self.render_whole("1", passes=3)
        self.mount_tmpfs(int(1.5 * size / 1024) + 1)  # a checkpoint is larger
        result = render(self.disk, "1", "--checkpoint", "1", passes=3)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("o.0001.checkpoint.exr: cannot be written: No space left", result.stderr)
        self.assertIn("rendering continues", result.stderr)
        self.check_complete([1])

    def test_no_room_for_anything_is_one_line(self):
        self.mount_tmpfs(4)
        result = render(self.disk, "1", "-q", "--report", f"{self.disk}/r.json")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn("No space left on device", result.stderr)
        self.assertEqual(self.names(), [])

    def test_disk_that_becomes_read_only_or_goes_away(self):
        self.render_whole("1-4")
        for change, words in ((["mount", "-o", "remount,ro"], "Read-only file system; write to"),
                              (["umount", "-l"], "No such file or directory; create its folder")):
            self.mount_tmpfs(10000)
            out = self.disk / "out"
            out.mkdir()
            with subprocess.Popen(command(out, "1-9999", "--on-error", "stop"),
                                  stderr=subprocess.PIPE, text=True) as process:
                while not (out / "o.0002.exr").exists() or not stop_between_files(process, out):
                    self.assertIsNone(process.poll())
                    time.sleep(0.005)
                subprocess.run([*change, str(self.disk)], check=True)
                process.send_signal(signal.SIGCONT)
                _, text = process.communicate()
            self.assertEqual(process.returncode, 3, text)
            self.assertIn(words, text)
            if out.exists():
                half = [path.name for path in out.iterdir() if path.name.startswith(".")]
                self.assertEqual(half, [])
                self.assertTrue(same_picture(out / "o.0002.exr", self.whole / "o.0002.exr"))
                subprocess.run(["umount", str(self.disk)], check=True)
            self.assertEqual(self.names(), [])

    def test_temporary_folders_are_not_needed(self):
        environment = {**os.environ, "TMPDIR": "/nonexistent", "TMP": "/nonexistent"}
        result = subprocess.run(command(self.disk, "1", "--checkpoint", "1", passes=2),
                                env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.names(), ["o.0001.exr"])


def enter_namespace():
    """Runs this script again in a mount namespace, as its root."""
    words = ["unshare", "--mount"] + ([] if os.geteuid() == 0 else ["--map-root-user"])
    probe = "mount -t tmpfs -o size=64k vdbeam_probe /mnt"
    try:
        tried = subprocess.run([*words, "sh", "-c", probe], capture_output=True, text=True,
                               check=False)
    except FileNotFoundError:
        skip("disk", "there is no unshare on this machine")
    if tried.returncode != 0:
        skip("disk", f"this machine lets no test mount a tmpfs: {tried.stderr.strip()}")
    return subprocess.run([*words, sys.executable, "-B", __file__],
                          env={**os.environ, INSIDE: "1"}, check=False).returncode


if __name__ == "__main__":
    sys.exit(unittest.main() if INSIDE in os.environ else enter_namespace())
