"""The commands of README.md and docs/tutorial.md work as they stand in the page, on a fresh build, in smaller images."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARY = pathlib.Path(os.environ.get("VDBEAM_BINARY", ROOT / "build" / "release" / "vdbeam")).resolve()
COMMAND = re.compile(r"^    ((?:export PATH|mkdir|vdbeam|oiiotool) ?.*)$", re.MULTILINE)
SIZE, SMALL = "480x270", "48x27"


def commands(page, begin="", end=None):
    """The lines of a page's code that a reader types, between two headings."""
    text = (ROOT / page).read_text(encoding="utf-8")
    part = text[text.index(begin):text.index(end) if end else None]
    return [line.replace(SIZE, SMALL) for line in COMMAND.findall(part)]


class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        # What a fresh build of the source tree has.
        (self.folder / "build" / "release").mkdir(parents=True)
        (self.folder / "build" / "release" / "vdbeam").symlink_to(BINARY)
        (self.folder / "data").symlink_to(ROOT / "data")

    def type(self, lines):
        script = "set -e\n" + "".join(f"{line}\n" for line in lines)
        environment = {**os.environ, "PATH": "/usr/local/bin:/usr/bin:/bin"}
        result = subprocess.run(["bash", "-c", script], cwd=self.folder, env=environment,
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, script + result.stdout + result.stderr)
        return result.stdout + result.stderr

    def has(self, *names):
        for name in names:
            self.assertGreater((self.folder / "out" / name).stat().st_size, 0, name)

    def test_tutorial(self):
        lines = commands("docs/tutorial.md")
        self.assertGreater(len(lines), 10)
        output = self.type(lines)
        page = (ROOT / "docs/tutorial.md").read_text(encoding="utf-8")
        quoted = re.findall(r"^    (  (?:  )?[a-z].*|\S+: \d+ grids)$", page, re.MULTILINE)
        self.assertGreater(len(quoted), 10)
        factor = re.compile(r"\d+(?= times)")  # the pilot's prediction changes with the methods
        for line in quoted:
            self.assertIn(factor.sub("N", line), factor.sub("N", output))
        self.has("first.png", "look.0012.png", "dense.exr", "shot.0001.exr", "shot.sh", "element.exr", "comp.exr")

    def test_five_minutes_of_the_readme(self):
        lines = commands("README.md", "## Five minutes to a sequence", "## What it renders")
        self.assertGreater(len(lines), 5)
        self.type(lines)
        self.has("first.png", "look.0024.exr", "shot.0024.exr")

    def test_pictures_of_readme_and_gallery(self):
        """The commands beside pictures name scenes, keys and options that exist."""
        for page in ("README.md", "docs/gallery.md"):
            text = (ROOT / page).read_text(encoding="utf-8")
            scenes = re.findall(r"tools/gallery\.py (\w+)", text)
            self.assertGreater(len(scenes), 2, page)
            for scene in scenes:
                self.assertTrue((ROOT / f"data/gallery/{scene}.toml").is_file(), f"{page}: {scene}")
            for line in re.findall(r"`(vdbeam render data/[^`]*)`", text):
                scene = re.match(r"vdbeam render (\S+)", line).group(1)
                self.assertTrue((ROOT / scene).is_file(), line)
                self.assertRegex(line, r"-o \S+\.exr --passes \d+")


if __name__ == "__main__":
    if not shutil.which("oiiotool"):
        print("oiiotool is not installed")
        sys.exit(77)
    unittest.main()
