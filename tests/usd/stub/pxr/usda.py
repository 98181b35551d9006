"""Reads a subset of .usda: prims, attributes with values or time samples, relationships, metadata of the layer."""
import re

TOKEN = re.compile(r'''\s*(?:\#[^\n]*\n\s*)*("(?:[^"\\]|\\.)*"|@[^@]*@|<[^>]*>|[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?'''
                   r'''|[A-Za-z_][\w:.]*|[=(){}\[\],:;]|\[\])''')


class Asset:
    """A path of an asset."""

    def __init__(self, path):
        self.path = self.resolvedPath = path


class Spec:
    """A prim as it was read."""

    def __init__(self, kind, name):
        self.kind, self.name = kind, name
        self.attributes, self.samples, self.relations, self.children = {}, {}, {}, []
        self.connections, self.metadata, self.property_metadata = {}, {}, {}


class Parser:
    """Reads tokens one by one."""

    def __init__(self, text):
        self.tokens = TOKEN.findall(text.split("\n", 1)[1] + "\n")
        self.place = 0

    def peek(self):
        """The next token, or ""."""
        return self.tokens[self.place] if self.place < len(self.tokens) else ""

    def take(self, wanted=None):
        """Takes the next token."""
        token = self.peek()
        if wanted is not None and token != wanted:
            raise RuntimeError(f"expected {wanted}, got {token}")
        self.place += 1
        return token

    def value(self):
        """A value."""
        token = self.take()
        if token[0] == '"':
            return token[1:-1]
        if token[0] == "@":
            return Asset(token[1:-1])
        if token[0] == "<":
            return token[1:-1]
        if token in "([":
            entries = []
            while self.peek() not in (")", "]"):
                entries.append(self.value())
                if self.peek() == ",":
                    self.take()
            self.take()
            return tuple(entries) if token == "(" else entries
        if token in ("true", "false"):
            return token == "true"
        return float(token) if re.search(r"[.eE]", token) else int(token)

    def metadata(self):
        """name = value in round brackets."""
        found = {}
        if self.peek() == "(":
            self.take()
            while self.peek() != ")":
                name = self.take()
                if self.peek() == "=":
                    self.take()
                    found[name] = self.value()
            self.take()
        return found

    def prim(self):
        """def TYPE "NAME" { ... }"""
        self.take("def")
        kind = self.take() if self.peek()[0] != '"' else ""
        spec = Spec(kind, self.take()[1:-1])
        spec.metadata = self.metadata()
        self.take("{")
        while self.peek() != "}":
            if self.peek() == "def":
                spec.children.append(self.prim())
            else:
                self.property(spec)
        self.take("}")
        return spec

    def property(self, spec):
        """An attribute or relationship."""
        words = []
        while self.peek() not in ("=", "(", "}", "def"):
            words.append(self.take())
        name = [word for word in words if word not in "[]"][-1]
        if self.peek() == "=":
            self.take()
            if "rel" in words:
                targets = self.value()
                spec.relations[name] = targets if isinstance(targets, list) else [targets]
            elif name.endswith(".connect"):
                sources = self.value()
                spec.connections[name[:-len(".connect")]] = sources if isinstance(sources, list) else [sources]
            elif name.endswith(".timeSamples"):
                spec.samples[name[:-len(".timeSamples")]] = self.time_samples()
            else:
                spec.attributes[name] = self.value()
        spec.property_metadata[name] = self.metadata()

    def time_samples(self):
        """{ time: value, ... }"""
        self.take("{")
        samples = {}
        while self.peek() != "}":
            time = float(self.take())
            self.take(":")
            samples[time] = self.value()
            if self.peek() == ",":
                self.take()
        self.take("}")
        return samples


def read(path):
    """(metadata, prims) of a file."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    if not text.startswith("#usda"):
        raise RuntimeError(f"{path} is not a layer")
    parser = Parser(text)
    metadata, prims = parser.metadata(), []
    while parser.peek():
        prims.append(parser.prim())
    return metadata, prims
