"""Parts of the machine that a test may do without, and that CI may not."""
import os
import sys
from pathlib import Path

DEBIAN = "/usr/bin/python3"
SKIPPED = 77  # what CTest shows as skipped


def required(part):
    """Whether VDBEAM_REQUIRE, a list of parts with commas between them, names the part."""
    return part in os.environ.get("VDBEAM_REQUIRE", "").split(",")


def skip(part, reason):
    """Ends a test that cannot run for want of `part` ("slurm", "browser", "blender", "disk", "numpy"
    or "binutils"): as skipped, or as failed where VDBEAM_REQUIRE names it."""
    print(f"{'failed, since VDBEAM_REQUIRE names ' + part if required(part) else 'skipped'}: {reason}")
    sys.exit(1 if required(part) else SKIPPED)


def import_failed(problem):
    """Starts the test again with Debian's Python, for which Debian's packages are; skips it where it
    runs with that one already."""
    if Path(sys.executable).resolve() != Path(DEBIAN).resolve() and Path(DEBIAN).exists():
        os.execv(DEBIAN, [DEBIAN, *sys.argv])
    skip("numpy", f"the Python module {problem.name} is missing")
