#!/usr/bin/env python3
"""Builds the Debian packages with CPack and looks into them: files, dependencies, a program that
starts, a manual page and completions that name every command and option."""
import glob
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

BUILD = os.environ["VDBEAM_BUILD"]
PROGRAM = os.environ["VDBEAM_BINARY"]
TESTS = pathlib.Path(__file__).resolve().parents[1]
MODULE = glob.glob(os.path.join(BUILD, "python/vdbeam/_core*.so"))


def output(*words, **options):
    return subprocess.run(words, check=True, capture_output=True, text=True, **options).stdout


def options_of(command):
    """The long options that `vdbeam help COMMAND` shows."""
    return re.findall(r"^  (?:-\w,)?(--[\w-]+)", output(PROGRAM, "help", *command), re.M)


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="vdbeam_deb_")
        # What is in them does not depend on how it is packed, and xz takes most of the time.
        output("cpack", "--config", os.path.join(BUILD, "CPackConfig.cmake"), "-B", cls.folder, "-D",
               "CPACK_DEBIAN_COMPRESSION_TYPE=gzip")
        cls.packages = {name.split("_")[0]: os.path.join(cls.folder, name)
                        for name in os.listdir(cls.folder) if name.endswith(".deb")}
        cls.root = os.path.join(cls.folder, "root")
        output("dpkg-deb", "-x", cls.packages["vdbeam"], cls.root)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def installed(self, *path):
        return os.path.join(self.root, "usr", *path)

    def field(self, package, name):
        return output("dpkg-deb", "-f", self.packages[package], name).strip()

    def test_program_and_library_are_apart(self):
        module = {"python3-vdbeam"} if MODULE else set()
        self.assertEqual(set(self.packages), {"vdbeam", "libvdbeam-dev"} | module)
        program = output("dpkg-deb", "-c", self.packages["vdbeam"])
        library = output("dpkg-deb", "-c", self.packages["libvdbeam-dev"])
        self.assertNotIn("/include/", program)
        self.assertNotIn(".a\n", program)
        for name in ("libvdbeam.a", "/include/vdbeam/render.h", "vdbeamConfig.cmake"):
            self.assertIn(name, library)
        self.assertNotIn("/bin/", library)

    @unittest.skipUnless(MODULE, "the Python module was not built")
    def test_the_python_module_is_found(self):
        root = os.path.join(self.folder, "python_root")
        output("dpkg-deb", "-x", self.packages["python3-vdbeam"], root)
        package = os.path.join(root, "usr/lib/python3/dist-packages")
        self.assertEqual(sorted(name.split(".")[0] for name in os.listdir(os.path.join(package, "vdbeam"))),
                         ["__init__", "_core", "_core", "_density", "_live", "_render", "_scene", "_toml", "py"])
        version = output("/usr/bin/python3", "-B", "-c", "import vdbeam; print(vdbeam.__version__)",
                         env={"PYTHONPATH": package})
        self.assertEqual(version.strip(), self.field("python3-vdbeam", "Version"))
        self.assertIn("python3-numpy", self.field("python3-vdbeam", "Depends"))

    def test_dependencies_are_those_of_the_program(self):
        depends = self.field("vdbeam", "Depends")
        needed = re.findall(r"NEEDED\s+(\S+)", output("objdump", "-p", PROGRAM))
        for library, package in (("libopenvdb", "libopenvdb"), ("libtbb", "libtbb"),
                                 ("libOpenEXR", "libopenexr"), ("libpng", "libpng"),
                                 ("libc.", "libc6")):
            self.assertTrue(any(name.startswith(library) for name in needed), library)
            self.assertRegex(depends, r"(^|, )" + package)
        self.assertIn("libopenvdb-dev", self.field("libvdbeam-dev", "Depends"))

    def test_program_renders_a_packaged_scene(self):
        program = self.installed("bin", "vdbeam")
        self.assertIn("OpenVDB", output(program, "--version"))
        scene = self.installed("share", "doc", "vdbeam", "examples", "cloud.toml")
        picture = os.path.join(self.folder, "cloud.exr")
        output(program, "render", scene, "-o", picture, "--passes", "1", "--resolution", "16x9",
               "--set", "render.photons=1000")
        self.assertTrue(os.path.getsize(picture))

    def test_documentation(self):
        for name in ("README.md", "CHANGELOG.md", "LICENSE", "docs/reference/scene.md", "docs/images/cloud.png",
                     "examples/smoke.toml", "examples/smoke/smoke.0001.vdb", "examples/fire.toml"):
            path = self.installed("share", "doc", "vdbeam", name)
            self.assertTrue(os.path.getsize(path), path)

    def test_blender_addon_is_the_zip_of_the_sources(self):
        sys.path.insert(0, str(TESTS.parent / "tools" / "blender"))
        import make_zip
        again = io.BytesIO()
        make_zip.make(again)
        addon = self.installed("share", "vdbeam", "vdbeam_blender.zip")
        self.assertEqual(pathlib.Path(addon).read_bytes(), again.getvalue())
        with zipfile.ZipFile(addon) as archive:
            self.assertIn("vdbeam_blender/__init__.py", archive.namelist())

    def test_usd_converter_runs_by_itself(self):
        """It finds its modules wherever it starts, and writes what the one of the source tree writes."""
        stage = TESTS / "usd" / "shot.usda"
        scenes = []
        for place in (self.installed("share", "vdbeam"), TESTS.parent / "tools"):
            folder = tempfile.mkdtemp(dir=self.folder)
            output(sys.executable, "-B", os.path.join(place, "usd2vdbeam.py"), stage, cwd=folder,
                   env={"PYTHONPATH": str(TESTS / "usd" / "stub")})
            scenes.append({path.name: path.read_bytes() for path in pathlib.Path(folder).iterdir()})
        self.assertIn("scene.toml", scenes[0])
        self.assertEqual(scenes[0], scenes[1])

    def commands(self):
        found = re.findall(r"^  (\w+)  ", output(PROGRAM, "help").split("Commands:")[1]
                           .split("Examples:")[0], re.M)
        self.assertIn("render", found)
        return [[name] for name in found] + [["farm", "slurm"], ["farm", "openjd"]]

    def test_manual_page_has_every_option(self):
        with open(self.installed("share", "man", "man1", "vdbeam.1"), encoding="utf-8") as file:
            page = file.read().replace("\\-", "-")
        for command in self.commands():
            self.assertIn(".SS vdbeam " + " ".join(command), page)
            for option in options_of(command):
                self.assertIn(option, page)
        for text in ("droplet_diameter", "Exit codes:", ".SH NAME"):
            self.assertIn(text, page)
        if shutil.which("groff"):
            result = subprocess.run(["groff", "-k", "-man", "-Tutf8", "-ww", "-z",
                                     self.installed("share", "man", "man1", "vdbeam.1")],
                                    capture_output=True, text=True, check=True)
            self.assertEqual(result.stderr, "")

    def complete(self, *words):
        """What bash offers for the last of the words."""
        script = self.installed("share", "bash-completion", "completions", "vdbeam")
        code = (f'. "{script}"; COMP_WORDS=(vdbeam "$@"); COMP_CWORD=$#; _vdbeam; '
                'printf "%s\\n" "${COMPREPLY[@]}"')
        return output("bash", "-c", code, "bash", *words).split()

    def test_bash_completes(self):
        self.assertEqual(self.complete("ren"), ["render"])
        self.assertEqual(self.complete("farm", ""), ["slurm", "openjd"])
        self.assertEqual(self.complete("render", "x.toml", "--on-error", ""), ["continue", "stop"])
        self.assertEqual(self.complete("render", "-o", "x"), [])  # the names of files
        for command in self.commands():
            self.assertEqual(set(options_of(command)) - set(self.complete(*command, "--")), set())

    def test_zsh_completion_has_every_option(self):
        path = self.installed("share", "zsh", "vendor-completions", "_vdbeam")
        with open(path, encoding="utf-8") as file:
            text = file.read()
        self.assertTrue(text.startswith("#compdef vdbeam\n"))
        for command in self.commands():
            part = text.split("\n_vdbeam_" + "_".join(command) + "() {")[1].split("\n}\n")[0]
            for option in options_of(command):
                self.assertRegex(part, re.escape(option) + r"[\[,}]")
        if shutil.which("zsh"):
            output("zsh", "-n", path)


if __name__ == "__main__":
    if not shutil.which("dpkg-shlibdeps"):
        print("dpkg-dev is not installed")
        sys.exit(77)
    unittest.main()
