"""What is damaged, and the command that reads it: a mutant is a pure function of its kind and number.

Doors lead to a file: keys of kind file of a scene (from the program's own table), arguments of commands (from its help),
and files that are read because they lie beside others (checkpoints, buffers, materials).
"""
import json
import os
import pathlib
import random
import re
import tempfile

import damage
import headers
import judge
import samples
import tables


class Case:
    """One mutant: the files to write, the command, and what must hold beyond the usual."""

    def __init__(self, label, files, words, patience=None, must_succeed=False, picture=None, environment=None, inputs=()):
        self.label, self.files, self.words, self.patience, self.inputs = label, files, words, patience, inputs
        self.must_succeed, self.picture, self.environment = must_succeed, picture, environment


# Sections that a key needs around it; a key of another section stands in a table of that name.
AROUND = {"camera": '[camera]\n{line}\n', "volume": '[[volume]]\n{line}\nextinction = 3\n',
          "mesh": '[[mesh]]\n{line}\n', "mesh.material": '[[mesh]]\nfile = "mesh.obj"\n[mesh.material]\n{line}\n',
          "light": '[[light]]\n{line}\n',
          "instance": '[[volume]]\nfile = "sphere_packed.vdb"\nname = "puff"\n[[instance]]\nvolume = "puff"\n{line}\n'}
CAMERA = "[camera]\nposition = [0, 0.5, 6]\nlook_at = [0, 0, 0]\nfov = 30\n"
SURROUNDINGS = {"camera": CAMERA, "volume": '[[volume]]\nfile = "sphere_packed.vdb"\nextinction = 3\n',
                "light": '[[light]]\ntype = "distant"\nirradiance = [2, 2, 2]\n'}
REST = "[image]\nwidth = 8\nheight = 8\n[render]\npasses = 1\nphotons = 100\n"


def scene_with(key, path, owner=None):
    """A scene in which the key names the file."""
    line = f'{key.name} = "{path}"'
    if owner:
        line = f'{"shape" if key.section == "volume" else "type"} = "{owner}"\n{line}'
    around = AROUND.get(key.section, f"[{key.section}]\n{{line}}\n")
    rest = "".join(text for name, text in SURROUNDINGS.items() if name != key.section.split(".")[0])
    return around.format(line=line) + rest + REST


class Targets:
    """All doors, with the kinds of files for which each is meant."""

    def __init__(self, sound, files):
        self.sound, self.files = sound, files  # a folder, and the names of each kind in it
        self.readable = {kind: names for kind, names in files.items() if kind != "scene"}
        found = sound / "doors.json"
        if not found.exists():
            found.write_text(json.dumps(self.find_doors()))
        doors = json.loads(found.read_text())
        pairs = [(key, owner) for key in tables.keys() if key.is_file for owner in (key.owners or [None])]
        self.any_door = pairs
        self.doors = {kind: [pair for pair in pairs if kind in doors[pair[0].path]] for kind in self.readable}
        self.rows = [(command, argument) for command in tables.commands() for argument in tables.arguments(command)]
        self.kinds = [*self.readable, "scene", "values", "command", "clash"]

    def find_doors(self):
        """The kinds for which a sound file renders behind each key. A key that takes none stops the campaign."""
        found = {}
        for key in filter(lambda key: key.is_file, tables.keys()):
            owner = (key.owners or [None])[0]
            kinds = [kind for kind in self.readable if any(self.renders(scene_with(key, name, owner))
                                                           for name in self.first_of(kind))]
            if not kinds:
                raise SystemExit(f"no sound file for {key.path}: add one to tools/attack/samples.py, or what else the "
                                 "key needs to AROUND in targets.py")
            found[key.path] = kinds
        return found

    def first_of(self, kind):
        """A few of a kind, of different endings."""
        endings = {}
        for name in self.files[kind]:
            endings.setdefault(name[name.rfind("."):], name)
        if kind == "volume":
            endings[".vdb"] = "sphere_packed.vdb"
        return endings.values()

    def renders(self, text):
        with tempfile.TemporaryDirectory(prefix="vdbeam_attack_") as name:
            folder = pathlib.Path(name)
            for path in self.sound.iterdir():
                os.symlink(path, folder / path.name)
            (folder / "trial.toml").write_text(text)
            return judge.run(["render", "trial.toml", *samples.SMALL, "-o", "trial.exr"], folder).code == 0

    def make(self, kind, number):
        rng = random.Random(f"{kind}:{number}")
        maker = {"scene": self.scene, "values": self.values, "command": self.command, "film": self.film,
                 "clash": self.clash}.get(kind)
        case = maker(rng) if maker else self.file(kind, rng)
        case.label = f"{kind}:{number}"
        return case

    def damaged(self, kind, rng):
        name = rng.choice(self.files[kind])
        return name, headers.damaged(name, (self.sound / name).read_bytes(), rng)

    def file(self, kind, rng):
        """A damaged volume, mesh, picture, camera or profile behind a key of a scene, or as an argument."""
        name, data = self.damaged(kind, rng)
        files = {name: data}
        beside = {".bin": name.replace("buffer", "parts").replace(".bin", ".gltf"), ".mtl": "mesh.obj"}
        named = beside.get(name[name.rfind("."):], name)
        if not self.doors[kind] or kind == "volume" and rng.random() < 0.4 or kind in ("mesh", "picture") and rng.random() < 0.3:
            return Case("", files, self.argument_words(kind, named, rng))
        key, owner = rng.choice(self.doors[kind] if rng.random() < 0.95 else self.any_door)
        files["scene.toml"] = scene_with(key, named, owner).encode()
        return Case("", files, self.scene_words(rng))

    def scene_words(self, rng, scene="scene.toml"):
        """A command that reads a scene: mostly one that renders it, since only that reads all of it."""
        if rng.random() < 0.7:
            extra = rng.choice([[], [], [], ["--estimator", "path"], ["--estimator", "beam"], ["--preview", "out.png"],
                                ["--report", "out.json"], ["--set", "image.deep=true"], ["--set", "image.cryptomatte=true"]])
            return ["render", scene, *samples.SMALL, "-o", "out.exr", "--passes", "1", *extra]
        return rng.choice([["plan", scene], ["plan", scene, "--json"], *self.scene_commands(scene)])

    def scene_commands(self, scene):
        """The other commands that take a scene as their one positional argument."""
        return [[*command.split(), scene, *required(command)] for command, argument in self.rows
                if argument.placeholder == "SCENE|VDB" and not command.startswith(("render", "plan"))]

    def argument_words(self, kind, name, rng):
        """A command with the file as one of its arguments; the others are sound."""
        rows = [(command, argument) for command, argument in self.rows
                if kind in tables.FILES.get(argument.placeholder, ()) and not argument.is_output]
        command, argument = rng.choice(rows)
        return self.with_argument(command, argument, name)

    def with_argument(self, command, argument, value):
        words = command.split()
        for other in tables.arguments(command):
            if not other.names:
                words += [value] if other is argument else self.sound_words(command, other)
        words += required(command)
        if argument.names:
            words = without(words, argument) + argument.words(value)
        return words

    def sound_words(self, command, argument):
        if argument.placeholder == "SCENE|VDB":
            return ["fog.toml"]
        if argument.placeholder == "PARTIAL...":
            return ["first.exr", "second.exr"]
        return {"VDB": ["sphere_packed.vdb"], "SUMMARY.json...": ["frames.summary"], "FILE...": ["sphere_packed.vdb"]}.get(argument.placeholder, ["finished.exr"])

    def film(self, rng):
        """A damaged image that vdbeam wrote, in each of the places where it is read again."""
        name, data = self.damaged("film", rng)
        render = ["render", "fog.toml", *samples.SMALL, "--passes", "2"]
        kind = rng.randrange(7)
        if kind == 0:  # what can be made anew is no reason to fail
            data = headers.damaged("first.exr", (self.sound / "first.exr").read_bytes(), rng)
            return Case("", {"out.checkpoint.exr": data}, [*render, "-o", "out.exr"], None, True, "finished.exr")
        if kind == 1:
            data = headers.damaged("finished.exr", (self.sound / "finished.exr").read_bytes(), rng)
            return Case("", {"out.exr": data}, [*render, "-o", "out.exr", "--skip-existing"], None, True, "finished.exr")
        if kind == 2:
            words = [word for word in render if word not in ("--passes", "2")]
            return Case("", {"out.exr": data}, [*words, "--pass-range", "0-0", "--skip-existing", "-o", "out.exr"], None, True)
        if kind == 3:
            return Case("", {"one.exr": data}, ["merge", "-q", "-o", "out.exr", "one.exr", "second.exr"])
        if kind == 4:
            return Case("", {"one.exr": data}, [*render, "-o", "out.exr", "--from-parts", "one.exr", "--from-parts",
                                                "second.exr"])
        if kind == 5:
            return Case("", {"deep.deep.exr": data}, [*render, "--skip-existing", "--set", "image.deep=true", "-o",
                                                      "deep.exr"], None, True)
        return Case("", {name: data}, self.argument_words("film", name, rng))

    def scene(self, rng):
        """Other tokens in a scene."""
        name = rng.choice(self.files["scene"])
        data = headers.damaged("x.toml", (self.sound / name).read_bytes(), rng)
        return Case("", {"scene.toml": data}, self.scene_words(rng), patience=5)

    def values(self, rng):
        """Values from the table of keys: good ones, and any, in a file or by --set."""
        sets = []
        for key in rng.sample(tables.keys(), rng.choice([1, 1, 2, 4])):
            value = self.value_of(key, rng)
            section = key.section.split(".")
            if section[0] in ("volume", "instance", "mesh", "light", "layer"):
                section.insert(1, rng.choice("0001"))
            sets += ["--set", f"{'.'.join(section)}.{key.name}={value}"]
        words = self.scene_words(rng)
        scene = rng.choice(["scene.toml", "fog.toml"])
        return Case("", {"scene.toml": (self.sound / scene).read_bytes()}, words + sets, patience=5)

    def value_of(self, key, rng):
        """A value of the right type in most cases, from a table of sound, extreme and absurd ones."""
        if key.is_file:
            return rng.choice(self.files[rng.choice(list(self.readable))])
        examples = key.examples()
        if rng.random() < 0.1 or "number" not in key.values + "RGB":
            return rng.choice(examples or damage.WORDS) if rng.random() < 0.8 else rng.choice(damage.WORDS)
        count = {"RGB": 3, "3 numbers": 3, "12 numbers": 12}.get(key.values, 1)
        numbers = [rng.choice([*[one for one in examples if one[:1] in "-0123456789"], *damage.EXTREMES]) for _ in range(count)]
        if "whole" in key.values:
            numbers = [rng.choice([*re.findall(r"-?\d+", key.values), "0", "1", "2", "1000", "2147483647", "4294967296"])]
        return f"[{', '.join(numbers)}]" if count > 1 and "[" not in numbers[0] else numbers[0]

    def command(self, rng):
        """Arguments of a command drawn from its help, with values of any kind."""
        command = rng.choice(tables.commands())
        words, rows = command.split(), tables.arguments(command)
        for argument in rows:
            if not argument.names:
                words += self.sound_words(command, argument) if rng.random() < 0.8 else [self.value(argument, rng)]
        words += required(command)
        options = [one for one in rows if one.names]
        for argument in rng.sample(options, min(len(options), rng.choice([1, 2, 3, 5]))):
            words = without(words, argument) + argument.words(self.value(argument, rng))
        return Case("", {}, [word.replace("\0", "") for word in words], patience=5)

    def clash(self, rng):
        """An output that is also an input: each key of kind file and each output, also those beside -o."""
        kind = rng.choice([kind for kind, doors in self.doors.items() if doors])
        key, owner = rng.choice(self.doors[kind])
        name = rng.choice(list(self.first_of(kind)))
        ending = name[name.rfind("."):]
        named = rng.choice([f"x{ending}", f"x{ending}", "x.deep.exr", "x.checkpoint.exr", "x.snapshot.exr"])
        beside = "x.exr" if named.count(".") > 1 else None
        outputs = [argument for argument in tables.arguments("render") if argument.is_output and argument.names]
        words = ["render", "scene.toml", *samples.SMALL, "--passes", "1", "--set", "image.deep=true"]
        output = rng.choice(outputs)
        written = output.words(rng.choice([named, f"./{named}", f"missing/../{named}", named.upper()]))
        if beside or output.names[-1] == "--output":
            written = ["-o", beside or named]
        elif rng.random() < 0.8:
            words += ["-o", "out.exr"]
        files = {named: (self.sound / name).read_bytes(), "scene.toml": scene_with(key, named, owner).encode()}
        return Case("", files, words + written, inputs=[named, "scene.toml"])

    def value(self, argument, rng):
        if argument.choices and rng.random() < 0.7:
            return rng.choice(argument.choices)
        if argument.is_file:
            files = [name for kind in self.files for name in self.first_of(kind)]
            return rng.choice(["out.exr", "out.png", "out.####.exr", "out.json", "-", "", "missing", "missing/out.exr", ".",
                               *files])
        usual = ["1", "2", "0", "8x8", "1-3", "0-1", "0,0,4,4", "1s", "2m", "1-1000000", "-3-3", "1-10x3", "beam", "path",
                 "image.deep=true", "light.0.irradiance=[1,1,1]", "0-0", "3,3,3,3", "5,5,1,1", "-1,-1,9,9"]
        return rng.choice(usual if rng.random() < 0.6 else damage.WORDS)


def required(command):
    """What a command needs beside its positional arguments."""
    if command == "render":
        return [*samples.SMALL, "--passes", "1", "-o", "out.exr"]
    if command == "merge":
        return ["-o", "out.exr", "-q"]
    if command == "summary":
        return ["--html", "page"]
    if command.startswith("farm"):
        return ["-f", "1-2", "-o", "out.####.exr"]
    return []


def without(words, argument):
    """The words but an option and its value."""
    for name in argument.names:
        if name in words:
            at = words.index(name)
            words = words[:at] + words[at + 2:]
    return words
