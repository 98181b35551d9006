"""Temporary folders that do not outlive Blender, however it ends: those that a killed one left are removed by the next."""
import os
import pathlib
import shutil
import tempfile
import time

try:
    import fcntl
except ImportError:  # not on Windows
    fcntl = None

PREFIX = "vdbeam_blender_"
LOCK = "blender.lock"
LONGEST_LIFE = 86400.0  # seconds without a change, where it cannot be found out whether a folder is in use


def is_left(folder):
    """Whether nobody uses a folder: the system unlocks its file when the process that holds it ends."""
    lock = folder / LOCK
    try:
        if fcntl is None or not lock.exists():
            return time.time() > folder.stat().st_mtime + LONGEST_LIFE
        with open(lock, "rb") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except OSError:  # locked, gone, or someone else's
        return False
    return True


def remove_left():
    """Removes the folders that nobody uses any longer."""
    for folder in pathlib.Path(tempfile.gettempdir()).glob(f"{PREFIX}*"):
        if not folder.is_symlink() and is_left(folder):
            shutil.rmtree(folder, ignore_errors=True)


class TempFolder:
    """A folder that is removed by `cleanup`, at the end of a `with`, or by the next Blender."""

    def __init__(self):
        remove_left()
        self.holder = tempfile.TemporaryDirectory(prefix=PREFIX)
        self.name = self.holder.name
        self.lock = open(os.path.join(self.name, LOCK), "wb")
        if fcntl is not None:
            fcntl.flock(self.lock, fcntl.LOCK_EX)

    def cleanup(self):
        """Removes the folder."""
        self.lock.close()
        self.holder.cleanup()

    def __enter__(self):
        return self.name

    def __exit__(self, *_):
        self.cleanup()
