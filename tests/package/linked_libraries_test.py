"""The program links to what it uses and to nothing else, and parts that are switched off are not even looked for."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from requirements import skip

BINARY = os.environ.get("VDBEAM_BINARY", "build/release/vdbeam")
SOURCE = Path(__file__).resolve().parents[2]

# What the library is made of (docs/developer/architecture.md); header-only libraries leave no trace.
LIBRARIES = {"openvdb", "tbb", "OpenEXR", "Imath", "png16", "turbojpeg", "z", "fmt", "tomlplusplus", "hwy",
             "xxhash", "embree3", "assimp", "OpenColorIO"}
RUNTIME = {"stdc++", "m", "gcc_s", "c", "ld-linux-x86-64", "ld-linux-aarch64", "atomic"}
SANITIZERS = {"asan", "ubsan", "tsan"}


def short_name(library):
    """libOpenEXR-3_1.so.30 -> OpenEXR"""
    name = re.sub(r"\.so.*", "", Path(library.strip()).name)
    return re.sub(r"^lib|-\d+_\d+$|\d*_debug$", "", name)


def output(*command):
    return subprocess.run(command, check=False, capture_output=True, text=True).stdout


class LinkedLibraries(unittest.TestCase):
    def test_links_to_these_and_no_others(self):
        needed = set(map(short_name, re.findall(r"NEEDED.*\[(.*)\]", output("readelf", "-d", BINARY))))
        self.assertEqual(needed - RUNTIME - SANITIZERS, LIBRARIES)

    def test_uses_all_of_them(self):
        unused = {short_name(line) for line in output("ldd", "-u", BINARY).splitlines() if ".so" in line}
        self.assertEqual(unused & LIBRARIES, set())

    def test_parts_that_are_off_are_not_looked_for(self):
        if shutil.which("cmake") is None:
            self.skipTest("no cmake")
        with tempfile.TemporaryDirectory() as folder:
            off = [f"-DVDBEAM_BUILD_{part}=OFF" for part in ("PROGRAM", "TESTS", "BENCHMARKS")]
            done = subprocess.run(["cmake", "-S", SOURCE, "-B", folder, *off], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            cache = Path(folder, "CMakeCache.txt").read_text(encoding="utf-8")
            for package in ("CLI11", "GTest", "benchmark"):
                self.assertNotIn(f"{package}_DIR", cache)
            rules = "".join(path.read_text(encoding="utf-8") for path in Path(folder).glob("**/link.txt"))
            rules += "".join(path.read_text(encoding="utf-8") for path in Path(folder).glob("build.ninja"))
            self.assertNotIn("vdbeam_cli", rules)


if __name__ == "__main__":
    if shutil.which("readelf") is None or shutil.which("ldd") is None:
        skip("binutils", "there is no readelf or ldd on this machine")
    unittest.main()
