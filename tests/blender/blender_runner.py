"""Runs a test file inside Blender: by plain Python it starts Blender with the file, inside Blender it runs the tests."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import requirements  # noqa: E402


def inside_blender():
    """Whether this Python is Blender's."""
    try:
        import bpy
    except ImportError:
        return False
    return bpy.app.background


def start(file):
    """Runs the tests of a file inside Blender and exits with their result, 77 where Blender is missing."""
    blender = os.environ.get("BLENDER", shutil.which("blender"))
    if not blender:
        requirements.skip("blender", "needs Blender 3.4 or newer (apt-get install blender, or BLENDER=path)")
    program = os.environ.get("VDBEAM_BINARY", "build/release/vdbeam")
    # Debian's Blender takes its modules from the first Python on the PATH, which may lack NumPy.
    environment = {**os.environ, "PATH": os.defpath, "VDBEAM_BINARY": str(pathlib.Path(program).resolve())}
    with tempfile.TemporaryDirectory() as folder:  # Mantaflow leaves its table of noise in the working directory
        code = subprocess.run([blender, "-b", "--factory-startup", "--python-exit-code", "1", "-P", file], cwd=folder,
                              env=environment, check=False).returncode
    sys.exit(code)


def main(file):
    """What a test file ends with. The variable TESTS names single tests, e.g. Engine.test_cancel."""
    if not inside_blender():
        start(file)
    result = unittest.main(argv=[file, "-v", *os.environ.get("TESTS", "").split()], exit=False).result
    sys.stdout.flush()
    sys.stderr.flush()
    # Blender's own exit code is 1 after an error of a render that a test expected and caught.
    os._exit(0 if result.wasSuccessful() else 1)
