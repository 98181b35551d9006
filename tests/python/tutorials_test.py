"""Every command block of docs/tutorials runs as it stands in the page, the largest images smaller, and leaves what the page
says it does."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import built_module

built_module.require()

sys.path.insert(0, str(built_module.ROOT / "tests" / "support"))
from requirements import required  # noqa: E402

ROOT = built_module.ROOT
PAGES = ROOT / "docs/tutorials"
BINARY = pathlib.Path(os.environ["VDBEAM_BINARY"]).resolve()


def blocks(page, language):
    """The blocks of a language in a page, as one script."""
    text = (PAGES / f"{page}.md").read_text(encoding="utf-8")
    return "\n".join(re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL))


def without_figures(line):
    """A line of output with its spaces, numbers, lists of numbers and units of memory made equal: times and memory
    vary, and with them the frames that a task renders before another takes over."""
    line = re.sub(r"[KMG]iB", "MiB", " ".join(line.split()))
    return re.sub(r"0(,0)+", "0", re.sub(r"[-+]?\d[\d.e+-]*|-(?= |$)", "0", line))


class Tutorials(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        # What a reader has who built the source tree.
        build = self.folder / "build" / "release"
        build.mkdir(parents=True)
        (build / "vdbeam").symlink_to(BINARY)
        (build / "python").symlink_to(built_module.PACKAGE)
        for name in ("data", "tools"):
            (self.folder / name).symlink_to(ROOT / name)
        self.environment = {**os.environ, "PATH": "/usr/local/bin:/usr/bin:/bin", "MPLCONFIGDIR": str(self.folder)}

    def run_script(self, script):
        """What the commands print; each must succeed."""
        result = subprocess.run(["bash", "-c", f"set -e\n{script}"], cwd=self.folder, env=self.environment,
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout + result.stderr

    def prints_as_quoted(self, page, output):
        """The output has the lines that the page quotes, but for figures."""
        quoted = [line for line in blocks(page, "text").splitlines() if line.strip(" .")]
        self.assertGreater(len(quoted), 5)
        printed = {without_figures(line) for line in output.splitlines()}
        for line in quoted:
            self.assertIn(without_figures(line), printed)

    def smaller(self, script, sizes):
        """The script with other sizes of images, {size: other}."""
        for size, other in sizes.items():
            self.assertIn(size, script)
            script = script.replace(size, other)
        return script

    def has(self, *names):
        for name in names:
            self.assertGreater((self.folder / "out" / name).stat().st_size, 0, name)

    def needs(self, *programs):
        missing = [name for name in programs if not shutil.which(name, path=self.environment["PATH"])]
        if missing and any(required(name) for name in missing):
            self.fail(f"{' and '.join(missing)} missing")
        if missing:
            self.skipTest(f"{' and '.join(missing)} missing")

    def test_farm(self):
        output = self.run_script(blocks("farm", "sh"))
        self.has("farm/page/frame.0008.png")
        self.prints_as_quoted("farm", output)
        self.assertIn("its finished image is there", output)
        shot = (self.folder / "out/farm/page/index.html").read_text(encoding="utf-8")
        self.assertIn("<b>8 of 8</b>", shot)
        self.assertIn("exit code 3", output)  # of the failure that the page shows
        page = (self.folder / "out/farm/failure/index.html").read_text(encoding="utf-8")
        self.assertIn("there is no file smoke.0002.vdb", page)
        # Nothing of the interruption is left.
        self.assertEqual(list((self.folder / "out/farm/frames").glob("*.checkpoint.exr")), [])

    def test_hero_cloud(self):
        sizes = {"width = 320\nheight = 180": "width = 128\nheight = 72", "128x72": "48x27"}
        self.prints_as_quoted("hero-cloud", self.run_script(self.smaller(blocks("hero-cloud", "sh"), sizes)))
        self.has(*(f"dusk/{name}.png" for name in ("first", "extinction_15", "extinction_150", "droplets", "late", "dusk")))
        report = json.loads((self.folder / "out/dusk/dusk.json").read_text(encoding="utf-8"))
        self.assertIn(report["stopped_by"], ("target_error", "time"))  # of a busy machine
        header = (self.folder / "out/dusk/dusk.exr").read_bytes()[:40000]
        for layer in (b"volume_direct", b"volume_indirect", b"light_sky"):  # as the page says
            self.assertIn(layer, header)

    def test_compare_estimators(self):
        (self.folder / "out").mkdir()
        (self.folder / "compare.py").write_text(blocks("compare-estimators", "python"), encoding="utf-8")
        output = self.run_script(blocks("compare-estimators", "sh") + f"\n'{sys.executable}' compare.py")
        self.has("errors.png")
        self.prints_as_quoted("compare-estimators", output)
        rows = re.findall(r"^(\w+) +seed \d: [\d.]+ s, MRSE ([\d.e+-]+), MRSE x s", output, re.MULTILINE)
        self.assertEqual([row[0] for row in rows], [method for method in ("beam", "gather", "march", "path") for _ in "12"])

    def test_blender_comp(self):
        self.needs("blender", "oiiotool")
        self.environment.update(BLENDER_USER_CONFIG=str(self.folder / "config"),
                                BLENDER_USER_SCRIPTS=str(self.folder / "scripts"))
        output = self.run_script(self.smaller(blocks("blender-comp", "sh"), {"240, 180": "120, 90", "240x180": "120x90"}))
        self.prints_as_quoted("blender-comp", output)
        self.has("blender/element.0016.exr", "blender/frame.0014.exr", "blender/page/index.html", "blender/comp.png")

    def test_pages_are_short_and_linked(self):
        index = (ROOT / "docs/index.md").read_text(encoding="utf-8")
        pages = list(PAGES.glob("*.md"))
        self.assertEqual(len(pages), 4)
        for page in pages:
            lines = page.read_text(encoding="utf-8").count("\n")
            self.assertTrue(80 <= lines <= 180, f"{page.name} has {lines} lines")
            self.assertIn(f"(tutorials/{page.name})", index)


if __name__ == "__main__":
    unittest.main()
