"""Stages, prims and attributes."""
from . import usda


# Values of schemas, as USD gives them where nothing is authored.
FALLBACKS = {("DistantLight", "inputs:intensity"): 50000.0, ("SphereLight", "inputs:intensity"): 1.0,
             ("SphereLight", "inputs:radius"): 0.5}


DEFAULT_TIME = object()


class Attribute:
    """An attribute: a value, or samples that hold until the next (numbers are interpolated)."""

    def __init__(self, name, value=None, samples=None, fallback=None, connections=(), metadata=None):
        self.name, self.value, self.samples = name, value, samples
        self.metadata = metadata or {}
        self.connections = [Path(path) for path in connections]
        self.fallback = fallback  # of the schema

    def __bool__(self):
        return self.IsValid()

    def IsValid(self):
        return self.HasAuthoredValue() or self.fallback is not None or bool(self.connections)

    def HasAuthoredValue(self):
        return self.value is not None or self.samples is not None

    def GetName(self):
        return self.name

    def GetMetadata(self, key):
        return self.metadata.get(key)

    def GetNumTimeSamples(self):
        return len(self.samples or {})

    def HasAuthoredConnections(self):
        return bool(self.connections)

    def GetConnections(self):
        return self.connections

    def Get(self, time=DEFAULT_TIME):
        """As in pxr, a time is a number; None is none."""
        if time is not DEFAULT_TIME and not isinstance(time, (int, float)):
            raise TypeError(f"Get: {time!r} is no time")
        if not self.HasAuthoredValue():
            return self.fallback
        if not self.samples or time is DEFAULT_TIME:
            return self.value
        times = sorted(self.samples)
        before = max((t for t in times if t <= time), default=times[0])
        after = min((t for t in times if t >= time), default=times[-1])
        first, second = self.samples[before], self.samples[after]
        if before == after or not isinstance(first, (float, tuple)):
            return first
        part = (time - before) / (after - before)
        mix = lambda a, b: a + (b - a) * part
        return mix(first, second) if isinstance(first, float) else tuple(map(mix, first, second))


class Path(str):
    """A path of a prim or property."""

    def GetPrimPath(self):
        return self.split(".")[0]


class Relationship:
    """A relationship."""

    def __init__(self, name, targets):
        self.name, self.targets = name, targets

    def GetName(self):
        return self.name

    def GetForwardedTargets(self):
        return self.targets


class Prim:
    """A prim."""

    def __init__(self, stage, spec, parent, path):
        self.stage, self.spec, self.parent, self.path = stage, spec, parent, path
        self.children = [Prim(stage, child, self, f"{path.rstrip('/')}/{child.name}") for child in spec.children]

    def __bool__(self):
        return True

    def IsValid(self):
        return True

    def GetName(self):
        return self.spec.name

    def GetPath(self):
        return self.path

    def GetTypeName(self):
        return self.spec.kind

    def GetChildren(self):
        return self.children

    def GetAppliedSchemas(self):
        """Those of the layer, e.g. in `prepend apiSchemas = ["MaterialBindingAPI"]`."""
        return self.spec.metadata.get("apiSchemas", [])

    def GetAttribute(self, name):
        return Attribute(name, self.spec.attributes.get(name), self.spec.samples.get(name),
                         FALLBACKS.get((self.spec.kind, name)), self.spec.connections.get(name, ()),
                         self.spec.property_metadata.get(name))

    def GetAttributes(self):
        return [self.GetAttribute(name) for name in {**self.spec.attributes, **self.spec.samples}]

    def GetRelationships(self):
        return [Relationship(name, targets) for name, targets in self.spec.relations.items()]


class PrimRange:
    """A prim and all below it, with pruning."""

    def __init__(self, prim, predicate=None):
        self.prim = prim

    def __iter__(self):
        return _Walk(self.prim)


class _Walk:
    def __init__(self, prim):
        self.waiting, self.last = [prim], None

    def __iter__(self):
        return self

    def __next__(self):
        if self.last is not None:
            self.waiting[:0] = self.last.children
        if not self.waiting:
            raise StopIteration
        self.last = self.waiting.pop(0)
        return self.last

    def PruneChildren(self):
        self.last = None


def TraverseInstanceProxies():
    return None


class Stage:
    """A stage of one layer."""

    def __init__(self, path):
        self.metadata, prims = usda.read(path)
        root = usda.Spec("", "")
        root.children = prims
        self.root = Prim(self, root, None, "/")

    @staticmethod
    def Open(path):
        return Stage(path)

    def GetPseudoRoot(self):
        return self.root

    def GetPrimAtPath(self, path):
        return next((prim for prim in PrimRange(self.root) if prim.path == path), None)

    def HasAuthoredTimeCodeRange(self):
        return "startTimeCode" in self.metadata

    def GetStartTimeCode(self):
        return float(self.metadata.get("startTimeCode", 0))

    def GetEndTimeCode(self):
        return float(self.metadata.get("endTimeCode", 0))

    def GetTimeCodesPerSecond(self):
        return float(self.metadata.get("timeCodesPerSecond", self.GetFramesPerSecond()))

    def GetFramesPerSecond(self):
        return float(self.metadata.get("framesPerSecond", 24))
