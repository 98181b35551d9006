"""Mutated files of every kind that vdbeam reads: each gives a result or one line of error.

Kinds: scene, volume, picture of the sky (EXR and HDR), checkpoint, finished image, partial image, and
meshes (OBJ, PLY, glTF, rendered and described by `info`), their buffers and their textures (PNG).
By hand, for longer: VDBEAM_BINARY=build/release/vdbeam mutated_files_test.py --cases 10000 --seed 2
A case is a pure function of the seed and its number, which a failure names; --case N runs that one
and leaves its files in --keep FOLDER.
"""
import argparse
import os
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import time

import sample_meshes

VDBEAM = os.environ.get("VDBEAM_BINARY", "vdbeam")
DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
SECONDS, BYTES = 10, 2 << 30

SCENE = """[image]
width = 32
height = 18
[camera]
position = [0.3, 1.2, 7.0]
look_at = [0.02, 0.5, 0.0]
fov = 24
[[volume]]
file = "%s"
extinction = 40.5
albedo = [0.99, 0.5, 1]
transform = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
phase = { type = "two_lobe", g = 0.6, g2 = -0.2, blend = 0.3 }
[[light]]
type = "spot"
position = [1, 2, 3]
direction = [-0.55, -0.66, -0.44]
intensity = [5, 5, 5]
[[light]]
type = "environment"
radiance = 0.25
rotation = 90
direct = "sampled"
[render]
passes = 64
time = "1m30s"
photons = 1000
kernel = "fixed"
radius = 1e-2
seed = 9223372036854775807
""" % (DATA / "smoke" / "smoke.0001.vdb").as_posix()

MESH_SCENE = """[camera]
position = [0, -2, 3]
[[mesh]]
file = "%s"
smooth_angle = 40
material = { type = "diffuse", texture = "%s" }
[[light]]
type = "distant"
direction = [0.2, 0.3, -1]
[[light]]
type = "environment"
"""

WORDS = [b"nan", b"inf", b"-1", b"1e999", b"0", b"[", b"]", b"{", b'"', b"=", b"\n", b"\xff", b"\x00",
         b"9223372036854775807", b"-9223372036854775808", b"true", b"[[light]]", b"#", b"''' ", b"1979-05-27",
         b"/dev/zero", b"/dev/null", b"../", b"[" * 5000]


def mutate(data, rng):
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 1, 2, 4, 16])):
        # Half of the damage goes where headers are.
        at = rng.randrange((len(data) if rng.randrange(2) else min(len(data), 2000)) + 1)
        kind = rng.randrange(8)
        if kind == 0 and at < len(data):
            data[at] ^= 1 << rng.randrange(8)
        elif kind == 1 and at < len(data):
            data[at] = rng.choice([0, 1, 127, 128, 255, rng.randrange(256)])
        elif kind == 2:
            del data[at:at + rng.choice([1, 2, 8, 100, len(data)])]
        elif kind == 3:
            data[at:at] = rng.choice(WORDS)
        elif kind == 4:
            length = rng.randrange(1, 64)
            source = rng.randrange(len(data) + 1)
            data[at:at] = data[source:source + length]
        elif kind >= 6:  # another digit, which mostly leaves a file that can be read
            digits = [i for i, byte in enumerate(data) if 48 <= byte <= 57]
            if digits:
                data[rng.choice(digits)] = 48 + rng.randrange(10)
        elif at + 4 <= len(data):
            data[at:at + 4] = struct.pack("<i", rng.choice([0, 1, -1, 2**31 - 1, -2**31, 65536]))
    return bytes(data)


def radiance_picture(width=16, height=8):
    rows = b"".join(b"\x02\x02" + struct.pack(">H", width) +
                    b"".join(bytes([128 + width]) + bytes([value]) for value in (90, 120, 200, 129))
                    for _ in range(height))
    header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width)
    return header + rows


class Driver:
    def __init__(self, folder, seed):
        self.folder, self.seed = pathlib.Path(folder), seed
        self.worst_seconds = self.worst_bytes = 0
        self.counts = {}

    def sources(self):
        """Name, bytes and the command of each kind of file; each must be accepted as it is."""
        still = ["--resolution", "4x3", "--set", "render.photons=500", "-q"]
        scene, out = self.folder / "seed.toml", self.folder / "out.exr"
        scene.write_text(SCENE, encoding="utf-8")

        def render(*words, of=scene, to=out):
            return ["render", of, *still, "-o", to, *words]

        def made(*words):
            subprocess.run([VDBEAM, *map(str, render(*words))], check=True)
            return out.read_bytes()

        def other_scene(old, new):
            path = self.folder / "other.toml"
            path.write_text(SCENE.replace(old, new), encoding="utf-8")
            return render("--passes", "1", of=path)

        def sky(name):
            return other_scene("radiance = 0.25", f'radiance = 0.25\nimage = "{name}"')

        volume = DATA / "smoke" / "smoke.0001.vdb"
        finished, first, second = (made(*words) for words in (
            ["--passes", "1"], ["--pass-range", "0-1"], ["--pass-range", "2-3"]))
        (self.folder / "second.exr").write_bytes(second)
        # A checkpoint is what --pass-range writes, under another name.
        return [("scene.toml", SCENE.encode(), lambda name: ["plan", self.folder / name]),
                ("picture.exr", finished, sky),
                ("picture.hdr", radiance_picture(), sky),
                ("volume.vdb", volume.read_bytes(),
                 lambda name: other_scene(volume.as_posix(), f"{name}")),
                ("out.checkpoint.exr", first, lambda name: render("--passes", "2")),
                ("out.exr", finished, lambda name: render("--passes", "1", "--skip-existing")),
                ("first.exr", first, lambda name: ["merge", "-q", "-o", self.folder / "merged.exr",
                                                   self.folder / name, self.folder / "second.exr"]),
                *self.mesh_sources(render)]

    def mesh_sources(self, render):
        """Meshes are rendered and described; the texture is damaged under a mesh that is sound."""
        gltf, buffer = sample_meshes.gltf_with_buffer("buffer.bin")
        meshes = [("mesh.obj", sample_meshes.obj_file()), ("ascii.ply", sample_meshes.ply_file(binary=False)),
                  ("binary.ply", sample_meshes.ply_file(binary=True)), ("mesh.gltf", sample_meshes.gltf_file()),
                  ("mesh.glb", sample_meshes.glb_file())]
        picture = sample_meshes.png_file()
        sound = {"square.obj": meshes[0][1], "sound.png": picture, "named.gltf": gltf}
        for name, data in sound.items():
            (self.folder / name).write_bytes(data)

        def rendered(mesh, texture="sound.png"):
            path = self.folder / "mesh.toml"
            path.write_text(MESH_SCENE % (mesh, texture), encoding="utf-8")
            return render("--passes", "1", of=path)

        return [*((name, data, rendered) for name, data in meshes),
                *((name, data, lambda name: ["info", self.folder / name]) for name, data in meshes),
                ("buffer.bin", buffer, lambda _: rendered("named.gltf")),
                ("texture.png", picture, lambda name: rendered("square.obj", name))]

    def run(self, label, arguments):
        waited, before = 0, time.monotonic()
        errors = self.folder / "errors.txt"
        with errors.open("wb") as stream:
            process = subprocess.Popen([VDBEAM, *map(str, arguments)], stdout=subprocess.DEVNULL, stderr=stream)
            while True:
                done, status, usage = os.wait4(process.pid, os.WNOHANG)
                if done:
                    break
                # A loaded machine gets more than SECONDS, and a pause of the whole machine counts little.
                now = time.monotonic()
                waited, before = waited + min(now - before, 0.1), now
                if waited > 200:
                    process.kill()
                    process.wait()
                    raise AssertionError(f"{label}: hangs")
                time.sleep(0.002)
        process.returncode = code = os.waitstatus_to_exitcode(status)
        seconds, peak = usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024
        self.worst_seconds, self.worst_bytes = max(self.worst_seconds, seconds), max(self.worst_bytes, peak)
        self.counts[code] = self.counts.get(code, 0) + 1
        text = errors.read_bytes()
        lines = [line for line in text.splitlines() if not line.startswith((b"note:", b"warning:"))]
        assert code in (0, 2, 3), f"{label}: exit code {code}: {text!r}"
        assert code == 0 or len(lines) == 1, f"{label}: not one line: {text!r}"
        assert seconds <= SECONDS, f"{label}: {seconds:.1f} s of processor time"
        assert peak <= BYTES, f"{label}: {peak / 1e9:.1f} GB"
        # What can be made anew is no reason to fail.
        assert code == 0 or not label.endswith(("(out.checkpoint.exr)", "(out.exr)")), f"{label}: {text!r}"
        return code

    def run_all(self, cases):
        sources = self.sources()
        for name, data, command in sources:
            (self.folder / name).write_bytes(data)
            assert self.run(name, command(name)) == 0, f"{name} is refused as it is"
        for case in cases:
            name, data, command = sources[case % len(sources)]
            rng = random.Random(f"{self.seed} {case}")
            (self.folder / name).write_bytes(mutate(data, rng))
            self.run(f"seed {self.seed}, case {case} ({name})", command(name))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--case", type=int, help="only this one")
    parser.add_argument("--keep", help="a folder for the files")
    arguments = parser.parse_args()
    cases = range(arguments.first, arguments.first + arguments.cases)
    if arguments.case is not None:
        cases = [arguments.case]
    with tempfile.TemporaryDirectory(prefix="vdbeam_mutated_") as folder:
        driver = Driver(arguments.keep or folder, arguments.seed)
        try:
            driver.run_all(cases)
        except AssertionError as error:
            print(error)
            return 1
        print(f"{len(cases)} cases, exit codes {driver.counts}, at most {driver.worst_seconds:.2f} s "
              f"and {driver.worst_bytes / 1e6:.0f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
