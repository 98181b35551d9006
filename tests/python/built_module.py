"""Finds the module that the build has made; ends with 77, which ctest counts as skipped, where it is missing."""
import importlib.util
import os
import pathlib
import signal
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = pathlib.Path(os.environ["VDBEAM_BUILD"]) / "python"
SYSTEM_PYTHON = "/usr/bin/python3"


def require():
    if not list((PACKAGE / "vdbeam").glob("_core*.so")):
        print("skipped: the Python module was not built")
        sys.exit(77)
    if importlib.util.find_spec("numpy") is None:
        if sys.executable != SYSTEM_PYTHON and os.path.exists(SYSTEM_PYTHON):
            os.execv(SYSTEM_PYTHON, [SYSTEM_PYTHON, "-B", *sys.argv])
        print("skipped: NumPy is missing")
        sys.exit(77)
    sys.path.insert(0, str(PACKAGE))
    # A shell starts programs in the background with SIGINT ignored, and a test that sends it would wait for ever.
    signal.signal(signal.SIGINT, signal.default_int_handler)
