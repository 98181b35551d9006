#!/usr/bin/env python3
"""The comp template for Nuke: its node graph is closed, its channels are those that vdbeam writes, and Nuke opens it
where there is one."""
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import BINARY, DATA, InTempFolder, run

TEMPLATE = DATA / "comp" / "vdbeam.nk"
NUKE = shutil.which("Nuke") or shutil.which("nuke")
# Layers that Nuke has without add_layer.
BUILT_IN = {"rgba", "depth"}
# Nuke's names of channels that it reads under others from an EXR.
ENDINGS = {"red": "R", "green": "G", "blue": "B", "alpha": "A"}

SCENE = """
[image]
width = 16
height = 12
[camera]
position = [0, 2, 6]
[[volume]]
shape = "sphere"
extinction = 2
emission = { intensity = "density", scale = 0.5 }
[[light]]
type = "distant"
direction = [0.5, -1, -0.2]
irradiance = 2
group = "sun"
[[light]]
type = "environment"
radiance = 0.3
group = "sky"
[[mesh]]
type = "plane"
rotate = [-90, 0, 0]
translate = [0, -1.2, 0]
material = "shadow_catcher"
[render]
passes = 1
"""

# Written for Nuke's own Python: every node has what it needs.
CHECK = """
import nuke
import sys
template, shot = sys.argv[1:3]
nuke.scriptOpen(template)
for node in nuke.allNodes("Read"):
    node["file"].setValue(shot)
broken = [node.name() for node in nuke.allNodes() if node.hasError()]
assert not broken, broken
assert nuke.toNode("comp").sample("red", 8, 6) > 0
"""


def commands(text):
    """(word, rest, body) of each command of a script, whose nodes have their knobs as a body."""
    text = re.sub(r"^#.*\n", "", text, flags=re.M)
    return re.findall(r"^(\w+) ([^\n{]*|\{[^\n]*\})(?:\{\n(.*?)^\})?\n", text, re.M | re.S)


def read_graph(text):
    """({node: its inputs}, {variable: node}), as Nuke's stack machine connects them. IndexError and KeyError where an
    input is missing."""
    stack, names, graph = [], {}, {}
    for word, rest, body in commands(text):
        if word == "set":
            names[rest.split()[0]] = stack[-1]
        elif word == "push":
            stack.append(names[rest.strip().removeprefix("$")])
        elif word != "add_layer":
            name = re.search(r"^ name (\w+)$", body, re.M).group(1)
            count = re.search(r"^ inputs ([\d+]+)$", body, re.M)
            count = sum(int(part) for part in count.group(1).split("+")) if count else 1
            if name in graph:
                raise KeyError(f"two nodes {name}")
            graph[name] = [stack.pop() for _ in range(count)]
            stack.append(name)
    return graph


def above(graph, name):
    """The node and all that it depends on."""
    return {name}.union(*(above(graph, other) for other in graph[name]))


class NukeTemplate(InTempFolder):
    def setUp(self):
        super().setUp()
        self.text = TEMPLATE.read_text(encoding="utf-8")

    def declared(self):
        """{layer: its channels} of add_layer."""
        lines = re.findall(r"^add_layer \{(\w+) (.*)\}$", self.text, re.M)
        return {layer: channels.split() for layer, channels in lines}

    def render(self):
        """Renders a scene with the layers of the template; the image's path."""
        Path(self.file("shot.toml")).write_text(SCENE + "".join(
            f'[[layer]]\nname = "{name}"\n' for name in ["beauty", "alpha", "depth", *self.declared()]), encoding="utf-8")
        code, text = run(BINARY, "render", self.file("shot.toml"), "-o", self.file("shot.0001.exr"))
        self.assertEqual(code, 0, text)
        return self.file("shot.0001.exr")

    def test_graph_is_closed(self):
        graph = read_graph(self.text)
        self.assertEqual(graph["beauty"], ["parts", "light_groups"])
        self.assertEqual(graph["grade_far"], ["beauty", "haze"])
        self.assertEqual(set(graph["plate_and_beauty"]), {"plate_in_shadow", "denoise"})
        # The denoiser is the artist's own: its inputs are all that the result does not need.
        self.assertEqual(set(graph) - above(graph, "comp"), {"albedo", "normal"})
        self.assertEqual([name for name, inputs in graph.items() if not inputs], ["vdbeam", "plate"])

    def test_channels_are_written_by_vdbeam(self):
        declared = self.declared()
        shuffled = re.findall(r"^ in (\w+)$", self.text, re.M)
        self.assertEqual(sorted(shuffled), sorted(declared), "each layer is used once")
        named = [channel for channels in declared.values() for channel in channels]
        named += re.findall(r"\b(depth\.\w+)", self.text)
        self.assertGreater(len(named), 30)
        header = Path(self.render()).read_bytes()[:4000]
        for channel in named:
            layer, ending = channel.split(".")
            self.assertTrue(layer in declared or layer in BUILT_IN, channel)
            self.assertIn(f"\0{layer}.{ENDINGS.get(ending, ending)}\0".encode(), header)

    @unittest.skipUnless(NUKE, "Nuke is not installed")
    def test_nuke_opens_it(self):
        Path(self.file("check.py")).write_text(CHECK, encoding="utf-8")
        result = subprocess.run([NUKE, "-t", self.file("check.py"), TEMPLATE, self.render()],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)


if __name__ == "__main__":
    unittest.main()
