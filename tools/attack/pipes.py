"""Pipes, sockets, devices, folders, loops of links and vast sparse files wherever the program takes a file."""
import os
import shutil
import socket
import stat

import judge
import samples
import tables
import targets

SPARSE = 1 << 40


def make_odd(path, what):
    if what == "pipe":
        os.mkfifo(path)
    elif what == "socket":
        with socket.socket(socket.AF_UNIX) as one:
            here = os.getcwd()
            os.chdir(path.parent)  # names of sockets are short
            one.bind(path.name)
            os.chdir(here)
    elif what == "folder":
        path.mkdir()
    elif what == "loop":
        path.symlink_to(path.name)
    elif what == "nowhere":
        path.symlink_to("missing/file")
    elif what == "sparse":
        path.touch()
        os.truncate(path, SPARSE)
    elif what == "empty":
        path.touch()
    else:
        path.symlink_to(what)


ODD = ["pipe", "socket", "folder", "loop", "nowhere", "sparse", "empty", "/dev/zero", "/dev/full", "/dev/random", "/dev/tty"]


def doors(sound):
    """Each place where a file is read or written: the file's name, and the command. Of a key once for each of the
    formats that it takes, since each has its own reader."""
    for kind, pairs in sound.doors.items():
        for key, owner in pairs:
            for name in sound.first_of(kind):
                ending = name[name.rfind("."):]
                if ending == ".bin" or ending == ".mtl":
                    continue
                odd = "odd" + ending
                yield f"{key.path} {ending}", odd, ["render", "scene.toml", *samples.SMALL, "--passes", "1", "-o", "out.exr"], \
                    {"scene.toml": targets.scene_with(key, odd, owner).encode()}, {}
    for command, argument in sound.rows:
        if argument.is_file:
            for ending in {".exr"} if argument.is_output else {".exr", ".vdb", ".obj"}:
                odd = "odd" + ending
                yield f"{command} {argument.placeholder} {(argument.names or ['argument'])[-1]} {ending}", odd, \
                    sound.with_argument(command, argument, odd), {}, {}
    fog = ["render", "fog.toml", *samples.SMALL, "--passes", "1", "-o"]
    yield "checkpoint", "out.checkpoint.exr", [*fog, "out.exr"], {}, {}
    yield "snapshot", "out.snapshot.exr", [*fog, "out.exr"], {}, {}
    yield "finished image", "out.exr", [*fog, "out.exr", "--skip-existing"], {}, {}
    yield "deep image", "out.deep.exr", [*fog, "out.exr", "--set", "image.deep=true"], {}, {}
    yield "buffer of a glTF", "buffer.bin", ["info", "parts.gltf"], {}, {}
    yield "material of an OBJ", "mesh.mtl", ["info", "mesh.obj"], {}, {}
    yield "buffer of a camera", "camera.bin", ["plan", "scene.toml"], \
        {"scene.toml": targets.scene_with(next(k for k in tables.keys() if k.path == "camera.file"), "camera.gltf").encode()}, {}
    yield "OCIO", "odd.ocio", [*fog, "out.exr", "--set", "image.output_space=x"], {}, {"OCIO": "odd.ocio"}


def attack(here, count):
    """Tries every odd thing at every door, or about `count` of them spread evenly; breaches go to the campaign's."""
    tried = [(door, what) for door in doors(here.targets) for what in ODD]
    tried = tried[::max(1, len(tried) // count)]
    for (label, odd, words, files, environment), what in tried:
        case = targets.Case(f"{label} is {what}", files, words, environment=environment)
        problem = try_one(here, case, odd, what)
        if problem:
            here.breaches.append((case, problem))
            print(f"{case.label}: {problem}\n    vdbeam {' '.join(map(str, case.words))}", flush=True)
    print(f"{len(tried)} odd files, {len(here.breaches)} breaches")


def try_one(here, case, odd, what):
    here.set_up(case.files)
    path = here.place / odd
    if path.is_dir():
        shutil.rmtree(path)
    path.unlink(missing_ok=True)
    make_odd(path, what)
    before = os.lstat(path)
    result = judge.run(case.words, here.place, here.limit, environment=case.environment)
    after = os.lstat(path) if os.path.lexists(path) else None
    written = what in ("empty", "sparse", "nowhere", "loop")  # what an output may replace
    if not written and (after is None or stat.S_IFMT(after.st_mode) != stat.S_IFMT(before.st_mode)):
        return "it was replaced or removed"
    return judge.complaint(result)
