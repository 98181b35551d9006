"""What the program takes, as it prints it: keys of scene files, commands and their arguments. A new row of its tables
is thus a part of every campaign."""
import functools
import re
import subprocess

import judge

# What arguments stand for. A placeholder that is in neither list stops the campaigns: it must be added to one.
FILES = {"SCENE|VDB": ("scene", "volume"), "VDB": ("volume",), "FILE...": ("volume", "mesh", "picture"),
         "IMAGE": ("film", "picture"), "REFERENCE": ("film", "picture"), "PARTIAL...": ("film",), "PARTIAL": ("film",), "SUMMARY.json...": ("summary",),
         "FILE.exr": ("film", "picture"), "FILE": ("film",), "FILE.png": (), "FILE.json": (), "FILE.toml": (), "FOLDER": ()}
VALUES = {"N", "T", "E", "L", "NAME", "WxH", "KEY=VALUE", "RANGE", "STOPS", "A-B", "X0,Y0,X1,Y1", "T|N", "MIB", "OPTION",
          "PATH", "HOST:PORT"}


def printed(*words):
    return subprocess.run([judge.BINARY, *words], check=True, capture_output=True, text=True).stdout


class Key:
    """A key of a scene file: its section ("mesh.material"), name, the types that take it, and what its values are."""

    def __init__(self, section, name, owners, values, default):
        self.section, self.name, self.owners, self.values, self.default = section, name, owners, values, default

    @property
    def path(self):
        return f"{self.section}.{self.name}"

    @property
    def is_file(self):
        return self.values == "path"

    def examples(self):
        """Values for it, sound ones and those at the ends of its range."""
        if '"' in self.values or self.values.startswith("true"):
            return re.findall(r'"[^"]*"|true|false', self.values)
        numbers = re.findall(r"[-\d.e+]*\d", self.values)
        return [self.default, *numbers] if self.default else numbers


# What follows a key's meaning: its values, unit and default; lines are wrapped anywhere.
VALUE_TEXT = re.compile(r'''((?:"[^"]*"(?:, "[^"]*")*|true or false|path|text|(?:whole number|number|3 numbers|RGB|duration|12 numbers)
(?: in [\[(][^])]*[])]| [<>]=? \S+)?))(?: \[[^],]*\])?, (?:required|default ("[^"]*"|\[[^]]*\]|\S+))'''.replace("\n", ""))


@functools.cache
def keys():
    """Every row of the table of keys."""
    found, section = [], ""
    for block in re.split(r"\n(?=\S|  \S)", printed("--help-scene")):
        if not block.startswith(" "):
            section = block.strip()
            continue
        name, text = block.split(maxsplit=1)
        text = " ".join(text.split())
        owners = re.match(r"([\w, ]+): ", text)
        owners = re.split(r", | and ", owners.group(1)) if owners else []
        row = VALUE_TEXT.search(text)
        if not row:
            raise SystemExit(f"{section}.{name} has values of a new kind: add it to VALUE_TEXT in tools/attack/tables.py")
        found.append(Key(section, name, owners, row.group(1), row.group(2) or ""))
    return found


class Argument:
    """An option or a positional argument of a command."""

    def __init__(self, names, placeholder, doc):
        self.names, self.placeholder, self.doc = names, placeholder, doc
        self.choices = placeholder.split("|") if re.fullmatch(r"[a-z0-9_-]+(\|[a-z0-9_-]+)+", placeholder) else []

    @property
    def is_file(self):
        return self.placeholder in FILES

    @property
    def is_output(self):
        return bool(re.search(r"\b[Ww]rit(e|es|ten)\b", self.doc)) or self.placeholder in ("FILE.png", "FILE.json", "FILE.toml")

    def words(self, value):
        return [self.names[-1], value] if self.names else [value]


@functools.cache
def arguments(command):
    """The options of a command, e.g. "farm slurm", that take a value. Stops where a placeholder is unknown."""
    found, docs, part = [], [], ""
    for line in printed("help", *command.split()).splitlines():
        if not line.startswith(" "):
            part = line
        if row := re.match(r"  (-\S+)(?: (\S+))?(?:  +(.*))?$", line):
            found.append((row.group(1).split(","), row.group(2) or ""))
            docs.append(row.group(3) or "")
        elif part == "Arguments:" and (row := re.match(r"  ([A-Z]\S*)(?:  +(.*))?$", line)):
            found.append(([], row.group(1)))
            docs.append(row.group(2) or "")
        elif part and docs and line.startswith(" " * 20):
            docs[-1] += " " + line.strip()
    listed = [Argument(names, placeholder, doc) for (names, placeholder), doc in zip(found, docs) if placeholder]
    for one in listed:
        if not one.choices and one.placeholder not in VALUES and one.placeholder not in FILES:
            raise SystemExit(f"vdbeam {command}: {one.names or ''} {one.placeholder} is new: add it to FILES or VALUES "
                             "in tools/attack/tables.py")
    return listed


@functools.cache
def commands():
    """Every command, e.g. "render", "farm slurm", but those that only describe the program, and `live`, which reads a
    scene as `render` does and ends only when it is interrupted."""
    found = []

    def walk(name):
        text = printed("help", *name.split())
        groups = re.findall(r"^(?:Commands|Engines):\n((?:  .*\n)+)", text, re.M)
        below = [word for group in groups for word in re.findall(r"^  (\w+)", group, re.M)]
        for word in below:
            walk(f"{name} {word}".strip())
        if name and not below and name not in ("help", "live"):
            found.append(name)

    walk("")
    return found
