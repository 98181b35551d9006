#!/usr/bin/env python3
"""The gallery: its scenes load, its volumes and meshes can be made, and its page names each scene."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools"))
import gallery  # noqa: E402
import make_props  # noqa: E402

BINARY = os.environ["VDBEAM_BINARY"]
BUILD = Path(os.environ["VDBEAM_BUILD"])
SCENES = sorted((ROOT / "data/gallery").glob("*.toml"))


def run(*words, **options):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **options)


class Gallery(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """Small stand-ins for all that the scenes read."""
        cls.folder = tempfile.TemporaryDirectory()
        cls.volumes = Path(cls.folder.name, "volumes")
        done = run("/usr/bin/python3", "-B", ROOT / "tools/make_props.py", cls.volumes, "--small")
        assert done.returncode == 0, done.stderr
        for name, (kind, *_) in gallery.CLOUDS.items():
            done = run(BUILD / "tools/make_volumes", kind, cls.volumes / name, "--size", "64")
            assert done.returncode == 0, done.stderr
        for name in gallery.SIMULATED:
            shutil.copyfile(ROOT / "data/fire/fire.0014.vdb", cls.volumes / name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_all_scenes_can_be_rendered(self):
        self.assertGreaterEqual(len(SCENES), 5)
        for scene in SCENES:
            # The samples name their grids differently.
            text = scene.read_text().replace("density_noise", "density").replace("flame_noise", "flame")
            text = text.replace('"../', f'"{ROOT}/data/')
            copy = Path(self.folder.name, scene.name)
            copy.write_text(text)
            done = run(BINARY, "plan", copy, "--no-pilot")
            self.assertEqual(done.returncode, 0, f"{scene.name}: {done.stderr}")

    def test_every_file_has_a_maker(self):
        made = {path.name for path in self.volumes.iterdir()}
        for scene in SCENES:
            for name in gallery.needed_files(scene):
                self.assertIn(name, made, scene.name)

    def test_page_has_command_and_image_of_each_scene(self):
        page = (ROOT / "docs/gallery.md").read_text()
        for scene in SCENES:
            self.assertIn(f"tools/gallery.py {scene.stem}", page)
            image = f"images/{scene.stem}." + ("webp" if scene.stem in gallery.SEQUENCES else "jpg")
            self.assertIn(image, page)
            self.assertTrue((ROOT / "docs" / image).exists(), image)

    def test_scenes_have_their_size_and_passes(self):
        for scene in SCENES:
            values = tomllib.loads(scene.read_text())
            least = 640 if scene.stem in gallery.SEQUENCES else 960
            self.assertGreaterEqual(values["image"]["width"], least, scene.name)
            self.assertIn("passes", values["render"], scene.name)

    def test_meshes_are_sound(self):
        for path in self.volumes.glob("*.obj"):
            lines = path.read_text().splitlines()
            points = sum(line.startswith("v ") for line in lines)
            corners = [int(word.split("/")[0]) for line in lines if line.startswith("f ") for word in line.split()[1:]]
            self.assertEqual(min(corners), 1, path.name)
            self.assertEqual(max(corners), points, path.name)
            places = sum(line.startswith("vt ") for line in lines)
            if any(line.startswith("f ") and "/" in line for line in lines):
                used = [int(word.split("/")[1]) for line in lines if line.startswith("f ") for word in line.split()[1:]]
                self.assertEqual(max(used), places, path.name)

    def test_the_comp_of_the_yard_is_everything_together(self):
        """The comp is far closer to everything together than the plate is: smoke and shadow have their places and strengths."""
        scene, base = Path(self.folder.name, "yard.toml"), Path(self.folder.name, "yard")
        text = (ROOT / "data/gallery/yard.toml").read_text().replace("density_noise", "density")
        scene.write_text(text)
        options = ["--passes", "4", "--resolution", "64x36", "--quiet"]
        gallery.composite(scene, base, options)
        done = run(BINARY, "render", scene, "-o", f"{base}.all.exr", *options)
        self.assertEqual(done.returncode, 0, done.stderr)

        def rms(image):
            text = run("oiiotool", image, "--ch", "R,G,B", f"{base}.all.exr", "--ch", "R,G,B", "--diff").stdout
            return float(re.search(r"RMS error = (\S+)", text).group(1))

        self.assertGreater(rms(f"{base}.plate.exr"), 0.05, "there is no smoke")
        self.assertLess(rms(f"{base}.exr"), 0.4 * rms(f"{base}.plate.exr"))
        self.assertTrue(Path(f"{base}.png").exists())

    def test_props_are_the_same_each_time(self):
        again = Path(self.folder.name, "hills.obj")
        make_props.make_hills().write(again)
        self.assertEqual(again.read_bytes(), (self.volumes / "hills.obj").read_bytes())


class Words(unittest.TestCase):
    def refused(self, *words):
        done = run(sys.executable, "-B", ROOT / "tools" / words[0], *words[1:], cwd=tempfile.gettempdir())
        self.assertNotEqual(done.returncode, 0)
        self.assertFalse(re.search("Traceback", done.stderr), done.stderr)
        return done.stderr

    def test_wrong_words_are_refused(self):
        self.assertIn("unknown: thunder; the scenes are", self.refused("gallery.py", "thunder"))
        self.assertIn("Usage", self.refused("simulate_volumes.py", "flood", "x.vdb"))
        self.assertIn("RESOLUTION must be a whole number in [16, 1024], got many",
                      self.refused("simulate_volumes.py", "plume", "x.vdb", "many"))
        self.assertIn("Usage", self.refused("make_props.py"))
        self.assertIn("Usage", self.refused("look_strips.py", "docs", "colour"))


if __name__ == "__main__":
    unittest.main()
