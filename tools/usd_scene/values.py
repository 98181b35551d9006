"""Attributes of prims."""


def value(prim, name, time, default=None):
    """An attribute's value at a time, or the one without a time (None): of `inputs:NAME` or `NAME`, whichever is
    authored (lights changed theirs), else the fallback of its schema."""
    attributes = [prim.GetAttribute(full) for full in (f"inputs:{name}", name)]
    for authored in (True, False):
        for attribute in attributes:
            if attribute and attribute.IsValid() and attribute.HasAuthoredValue() == authored:
                found = attribute.Get() if time is None else attribute.Get(time)
                if found is not None:
                    return found
    return default


def source(prim, name):
    """The path of the property that an input is connected to, or None."""
    attribute = prim.GetAttribute(f"inputs:{name}")
    found = attribute.GetConnections() if attribute and attribute.HasAuthoredConnections() else []
    return found[0] if found else None


def target(prim, name):
    """The path of the first target of a relationship, or None."""
    for relation in prim.GetRelationships():
        if relation.GetName() == name:
            return next(iter(relation.GetForwardedTargets()), None)
    return None


def number(prim, name, time, default):
    """A number."""
    return float(value(prim, name, time, default))


def colour(prim, name, time, default=(1.0, 1.0, 1.0)):
    """Three numbers."""
    return [float(part) for part in value(prim, name, time, default)]


def asset(prim, name, time):
    """The path of an asset, resolved where it can be; empty without one."""
    found = value(prim, name, time)
    return "" if found is None else asset_path(found)


def asset_path(found):
    """The path of a value that is an asset or a text."""
    return found.resolvedPath or found.path if hasattr(found, "path") else str(found)


def own_keys(prim, time):
    """Keys that the prim itself names: attributes vdbeam:KEY, and vdbeam:KEY:SUBKEY for tables such as phase."""
    keys = {}
    for attribute in prim.GetAttributes():
        words = attribute.GetName().split(":")
        if words[0] != "vdbeam" or len(words) not in (2, 3):
            continue
        found = plain(attribute.Get(time))
        if found is None:
            continue
        table = keys if len(words) == 2 else keys.setdefault(words[1], {})
        table[words[-1]] = found
    return keys


def plain(found):
    """A value as a bool, number, text or list of numbers."""
    if found is None or isinstance(found, (bool, int, float, str)):
        return found
    try:
        return [float(part) for part in found]
    except TypeError:
        return asset_path(found)


def rows(matrix):
    """A matrix of USD, which acts on row vectors, as lists of rows that act on columns."""
    return [[float(matrix[column][row]) for column in range(4)] for row in range(4)]


def product(a, b):
    """a b, of lists of rows."""
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def transform(matrix):
    """Twelve numbers of a [[volume]] or [[mesh]]."""
    return [entry for row in matrix[:3] for entry in row]
