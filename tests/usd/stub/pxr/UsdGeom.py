"""Transforms, visibility, point instancers. Matrices act on row vectors, as USD's do."""
import math


class Matrix(list):
    """Four rows."""

    def __mul__(self, other):
        return Matrix([sum(self[i][k] * other[k][j] for k in range(4)) for j in range(4)] for i in range(4))

    def GetInverse(self):
        size = 4
        rows = [list(self[i]) + [float(i == j) for j in range(size)] for i in range(size)]
        for i in range(size):
            pivot = max(range(i, size), key=lambda k: abs(rows[k][i]))
            rows[i], rows[pivot] = rows[pivot], rows[i]
            rows[i] = [value / rows[i][i] for value in rows[i]]
            for k in range(size):
                if k != i:
                    rows[k] = [a - rows[k][i] * b for a, b in zip(rows[k], rows[i])]
        return Matrix([row[size:] for row in rows])


def identity():
    return Matrix([[float(i == j) for j in range(4)] for i in range(4)])


def translation(offset):
    matrix = identity()
    matrix[3][:3] = [float(part) for part in offset]
    return matrix


def scaling(factors):
    matrix = identity()
    for i, factor in enumerate(factors):
        matrix[i][i] = float(factor)
    return matrix


def rotation(axis, degrees):
    matrix = identity()
    j, k = (axis + 1) % 3, (axis + 2) % 3
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    matrix[j][j], matrix[j][k], matrix[k][j], matrix[k][k] = c, s, -s, c
    return matrix


def local(prim, time):
    """The product of the prim's operations: the last of them acts first."""
    matrix = identity()
    for name in prim.GetAttribute("xformOpOrder").Get() or []:
        value = prim.GetAttribute(name).Get(time)
        kind = name.split(":")[1]
        if kind == "translate":
            step = translation(value)
        elif kind == "scale":
            step = scaling(value)
        elif kind == "transform":
            step = Matrix([list(row) for row in value])
        else:
            step = rotation(0, value[0]) * rotation(1, value[1]) * rotation(2, value[2])
        matrix = step * matrix
    return matrix


class XformCache:
    """World transforms at a time."""

    def __init__(self, time):
        self.time = time

    def GetLocalToWorldTransform(self, prim):
        matrix = identity()
        while prim is not None:
            matrix = matrix * local(prim, self.time)
            prim = prim.parent
        return matrix


class Imageable:
    """Visibility and purpose, inherited."""

    def __init__(self, prim):
        self.prim = prim

    def __bool__(self):
        return True

    def ComputeVisibility(self, time):
        prim = self.prim
        while prim is not None:
            if prim.GetAttribute("visibility").Get(time) == "invisible":
                return "invisible"
            prim = prim.parent
        return "inherited"

    def ComputePurpose(self):
        return self.prim.GetAttribute("purpose").Get() or "default"


class PointInstancer:
    """A point instancer with positions."""

    IncludeProtoXform, ExcludeProtoXform = "IncludeProtoXform", "ExcludeProtoXform"
    ApplyMask, IgnoreMask = "ApplyMask", "IgnoreMask"

    def __init__(self, prim):
        self.prim = prim

    def ComputeMaskAtTime(self, time):
        """By the places of points without ids; empty where nothing is hidden."""
        hidden = self.prim.GetAttribute("invisibleIds").Get(time)
        return [place not in hidden for place in range(len(self.GetProtoIndicesAttr().Get(time)))] if hidden else []

    def ComputeInstanceTransformsAtTime(self, time, _base, _prototypes, mask):
        assert mask == self.IgnoreMask
        roots = [self.prim.stage.GetPrimAtPath(path) for path in self.GetPrototypesRel().GetForwardedTargets()]
        indices = self.GetProtoIndicesAttr().Get(time)
        return [local(roots[index], time) * translation(place)
                for index, place in zip(indices, self.prim.GetAttribute("positions").Get(time))]

    def GetProtoIndicesAttr(self):
        return self.prim.GetAttribute("protoIndices")

    def GetPrototypesRel(self):
        return next(relation for relation in self.prim.GetRelationships() if relation.GetName() == "prototypes")


def GetStageUpAxis(stage):
    return stage.metadata.get("upAxis", "Y")
