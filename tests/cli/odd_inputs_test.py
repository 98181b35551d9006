#!/usr/bin/env python3
"""Pipes, folders, sockets, devices, circles of links and files without permission in the place of every
kind of input: refused at once, in one line with file and reason.
"""
import ctypes
import os
import socket
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import BINARY, DATA, InTempFolder

REASONS = {"pipe": "pipe", "folder": "folder", "socket": "a socket", "device": "a device", "loop": "circle",
           "locked": "no permission"}
LONGEST = 60  # seconds; a pipe would be waited for for ever
SMALL = ["--resolution", "16x9", "--passes", "1", "--set", "render.photons=200", "-q"]
VOLUME = f"[[volume]]\nfile = '{DATA}/cloud.vdb'\n[[light]]\ntype = 'environment'\n"
GLTF = '{"asset": {"version": "2.0"}, "buffers": [{"uri": "%s", "byteLength": 36}]}'


def without_root():
    """Root may read everything but for this."""
    for capability in (1, 2):  # CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH
        ctypes.CDLL(None).prctl(24, capability, 0, 0, 0)  # PR_CAPBSET_DROP


def make(kind, path):
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind == "socket":
        with socket.socket(socket.AF_UNIX) as end:
            end.bind(str(path))
    elif kind == "device":
        path.symlink_to("/dev/zero")
    elif kind == "loop":
        path.symlink_to(path.name)
    else:
        path.write_bytes(b"1 2 3")
        path.chmod(0)


def remove(path):
    if path.is_dir() and not path.is_symlink():
        path.rmdir()
    else:
        path.unlink()


class OddInputs(InTempFolder):
    def setUp(self):
        super().setUp()
        self.here = Path(self.folder.name)
        (self.here / "s.toml").write_text(VOLUME, encoding="utf-8")
        (self.here / "buffer.gltf").write_text(GLTF % "odd.bin", encoding="utf-8")
        self.run_vdbeam("render", "s.toml", "-o", "sound.exr", *SMALL)
        self.run_vdbeam("render", "s.toml", "-o", "part.exr", "--pass-range", "0", *SMALL[:2], *SMALL[4:])

    def run_vdbeam(self, *words, **environment):
        result = subprocess.run([BINARY, *words], cwd=self.here, env={**os.environ, **environment},
                                capture_output=True, text=True, check=False, timeout=LONGEST,
                                stdin=subprocess.DEVNULL, preexec_fn=without_root)
        return result.returncode, result.stderr

    def inputs(self):
        """Name of the odd file, and the command that is to read it."""
        def with_key(name, *keys, command="render"):
            words = [word for key in keys for word in ("--set", key)]
            end = {"render": ["-o", "o.exr", *SMALL], "plan": [], "farm": ["-f", "1", "-o", "o.exr"]}[command]
            start = ["farm", "slurm"] if command == "farm" else [command]
            return name, [*start, "s.toml", *words, *end]

        for command in ("render", "plan", "farm"):
            yield with_key("odd.vdb", "volume.0.file=odd.vdb", command=command)
            yield with_key("odd.obj", "mesh.0.file=odd.obj", command=command)
            yield with_key("odd.bin", "mesh.0.file=buffer.gltf", command=command)
            yield with_key("odd.chan", "camera.file=odd.chan", command=command)
            yield with_key("odd.exr", "light.0.image=odd.exr", command=command)
        for name in ("odd.ply", "odd.gltf", "odd.glb"):
            yield with_key(name, f"mesh.0.file={name}")
        yield with_key("odd.glb", "camera.file=odd.glb")
        yield with_key("odd.bin", "camera.file=buffer.gltf")
        for name in ("odd.hdr", "odd.png"):
            yield with_key(name, f"light.0.image={name}")
        yield with_key("odd.png", "mesh.0.type=square", "mesh.0.material.texture=odd.png")
        for name in ("odd.toml", "odd.vdb"):
            yield name, ["render", name, "-o", "o.exr", *SMALL]
            yield name, ["plan", name]
            yield name, ["farm", "slurm", name, "-f", "1", "-o", "o.exr"]
        yield "odd.vdb", ["init", "odd.vdb"]
        for name in ("odd.vdb", "odd.obj", "odd.glb", "odd.exr", "odd.png"):
            yield name, ["info", name]
        yield "odd.bin", ["info", "buffer.gltf"]
        yield "odd.exr", ["render", "s.toml", "-o", "o.exr", *SMALL, "--reference", "odd.exr"]
        yield "odd.exr", ["render", "s.toml", "-o", "o.exr", *SMALL, "--reference", "sound.exr",
                          "--second-reference", "odd.exr"]
        yield "odd.exr", ["render", "s.toml", "-o", "o.exr", *SMALL, "--from-parts", "odd.exr"]
        yield "odd.exr", ["merge", "-o", "o.exr", "part.exr", "odd.exr"]
        yield "odd.exr", ["compare", "odd.exr", "sound.exr"]
        yield "odd.exr", ["compare", "sound.exr", "odd.exr"]
        yield "odd.exr", ["compare", "sound.exr", "sound.exr", "--second", "odd.exr"]
        yield "odd.ocio", ["render", "s.toml", "-o", "o.exr", *SMALL, "--set", "image.output_space=unknown"]

    def test_every_input(self):
        for name, words in self.inputs():
            for kind, reason in REASONS.items():
                if words[0] in ("plan", "farm") and kind not in ("pipe", "loop"):
                    continue  # they read scenes as render does
                with self.subTest(name=name, kind=kind, words=words):
                    make(kind, self.here / name)
                    try:
                        code, text = self.run_vdbeam(*words, OCIO=str(self.here / "odd.ocio"))
                    finally:
                        remove(self.here / name)
                    self.assertEqual(code, 2, text)
                    self.assertEqual(text.count("\n"), 1, text)
                    self.assertIn(name, text)
                    self.assertIn(reason, text)
                    self.assertFalse((self.here / "o.exr").exists())

    def test_what_lies_where_files_are_made_up(self):
        """By the name of a checkpoint nothing else is touched; by that of a snapshot it is left alone."""
        for kind in REASONS:
            with self.subTest(kind):
                path = self.here / "o.checkpoint.exr"
                make(kind, path)
                code, text = self.run_vdbeam("render", "s.toml", "-o", "o.exr", *SMALL)
                self.assertEqual((code, text.count("\n")), (2, 1), text)
                self.assertIn("o.checkpoint.exr", text)
                self.assertTrue(path.is_symlink() or path.exists())
                remove(path)

    def test_names_that_lead_nowhere(self):
        for name in ("x" * 5000, "a/" * 2500 + "b.obj"):
            (self.here / "far.gltf").write_text(GLTF % name, encoding="utf-8")
            for words in (["render", "s.toml", "--set", "mesh.0.file=far.gltf", "-o", "o.exr", *SMALL],
                          ["info", "far.gltf"], ["info", name], ["render", name, "-o", "o.exr"], ["plan", name],
                          ["compare", name, "sound.exr"], ["merge", "-o", "o.exr", name]):
                with self.subTest(words=words[:2]):
                    code, text = self.run_vdbeam(*words)
                    self.assertIn(code, (2, 3), text)
                    self.assertEqual(text.count("\n"), 1, text)

    def test_size_costs_nothing(self):
        """A terabyte of holes is neither hashed nor read."""
        for name, key in (("odd.vdb", "volume.0.file"), ("odd.obj", "mesh.0.file"), ("odd.chan", "camera.file"),
                          ("odd.exr", "light.0.image"), ("odd.png", "light.0.image")):
            with (self.here / name).open("wb") as file:
                file.truncate(1 << 40)
            with self.subTest(name):
                code, text = self.run_vdbeam("render", "s.toml", "--set", f"{key}={name}", "-o", "o.exr", *SMALL)
                self.assertEqual((code, text.count("\n")), (2, 1), text)
                self.assertIn(name, text)

    def test_a_locked_folder(self):
        (self.here / "locked").mkdir(mode=0)
        code, text = self.run_vdbeam("info", "locked")
        self.assertEqual((code, text), (2, "locked: the folder cannot be read: Permission denied\n"))


if __name__ == "__main__":
    unittest.main()
