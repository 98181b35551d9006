"""From Blender's lamps and world to [[light]] and emissive [[mesh]].

Strengths are those of Cycles: a sun has an irradiance; a lamp of P watts has the intensity P / 4 pi; an area lamp the
radiance P / 4 A. Lamps of Cycles are not visible to the camera.
"""
import math


def scaled(colour, factor):
    """A colour times a number."""
    return [value * factor for value in colour]


def direction(matrix):
    """The direction in which a lamp shines: its -Z axis."""
    axis = [-matrix[row][2] for row in range(3)]
    length = math.sqrt(sum(value * value for value in axis)) or 1.0
    return [value / length for value in axis]


def place(matrix):
    """The position of an object."""
    return [matrix[row][3] for row in range(3)]


def columns(matrix):
    """Lengths of the axes of an object."""
    return [math.sqrt(sum(matrix[row][column] ** 2 for row in range(3))) for column in range(3)]


def placed(matrix, scale):
    """Twelve numbers of a matrix whose axes are scaled first."""
    return [matrix[row][column] * (scale[column] if column < 3 else 1.0) for row in range(3) for column in range(4)]


def sun(lamp):
    """A sun: its angle is the diameter of its disc."""
    return {"type": "distant", "direction": direction(lamp["matrix"]),
            "irradiance": scaled(lamp["colour"], lamp["energy"]), "angular_radius": math.degrees(lamp["angle"]) / 2,
            "visible": False}


def ball(lamp):
    """A point lamp with a radius, as an emissive sphere of the same intensity: its radiance times pi r^2."""
    radius = lamp["radius"]
    x, y, z = place(lamp["matrix"])
    radiance = lamp["energy"] / (4 * math.pi**2 * radius**2)
    return {"type": "sphere", "translate": [x, y, z], "scale": [radius] * 3, "visible": False,
            "material": {"type": "emissive", "radiance": scaled(lamp["colour"], radiance)}}


def point(lamp):
    """A lamp without a size."""
    return {"type": "point", "position": place(lamp["matrix"]),
            "intensity": scaled(lamp["colour"], lamp["energy"] / (4 * math.pi))}


def spot(lamp):
    """A spot lamp: Cycles' smooth edge lies inside the cone and is even in the cosine."""
    half = lamp["spot_size"] / 2
    inner = math.acos(min(1.0, math.cos(half) + (1 - math.cos(half)) * lamp["spot_blend"]))
    return {"type": "spot", "position": place(lamp["matrix"]), "direction": direction(lamp["matrix"]),
            "intensity": scaled(lamp["colour"], lamp["energy"] / (4 * math.pi)),
            "cone_angle": min(math.degrees(half), 90.0), "cone_falloff": math.degrees(half - inner)}


def area(lamp):
    """An area lamp, as an emissive quad or disk. It shines along -Z, a mesh along +Z."""
    across = lamp["size"]
    up = lamp["size_y"] if lamp["shape"] in ("RECTANGLE", "ELLIPSE") else across
    round_shape = lamp["shape"] in ("DISK", "ELLIPSE")
    sx, sy, _ = columns(lamp["matrix"])
    surface = across * up * sx * sy * (math.pi / 4 if round_shape else 1)
    radiance = lamp["energy"] / (4 * surface) if surface > 0 else 0.0
    # Half a turn about X: the front of the quad then looks along -Z.
    transform = placed(lamp["matrix"], [across / 2, -up / 2, -1.0])
    return {"type": "disk" if round_shape else "quad", "transform": transform, "visible": False,
            "material": {"type": "emissive", "radiance": scaled(lamp["colour"], radiance)}}


def lamp_keys(lamp, notes):
    """("light" or "mesh", keys) of a lamp; None of one that emits nothing."""
    kind, group = lamp["type"], lamp.get("group", "")
    if lamp.get("portal"):
        notes.add(lamp["name"], "a portal has no counterpart and is left out; it emits nothing in Cycles either")
        return None
    if lamp.get("nodes"):
        notes.add(lamp["name"], "the nodes of a lamp have no counterpart; its colour and strength are exported")
    if not lamp.get("normalized", True):
        notes.add(lamp["name"], "a strength that is not normalized by the lamp's area has no counterpart; it is normalized")
    if not lamp.get("casts_shadow", True):
        notes.add(lamp["name"], "a lamp without shadows has no counterpart; it casts them")
    if kind == "SUN":
        table, keys = "light", sun(lamp)
    elif kind == "AREA":
        if lamp.get("spread", math.pi) < math.pi - 1e-3:
            notes.add(lamp["name"], "the spread of an area lamp has no counterpart; it shines in all directions")
        notes.add(lamp["name"], "it is exported as an emissive mesh, which blocks light")
        table, keys = "mesh", area(lamp)
    elif kind == "POINT" and lamp["radius"] > 0:
        notes.add(lamp["name"], "its radius is exported as an emissive sphere, which blocks light")
        table, keys = "mesh", ball(lamp)
    else:
        if lamp["radius"] > 0:
            notes.add(lamp["name"], "the radius of a spot lamp has no counterpart; its shadows are sharp")
        table, keys = "light", spot(lamp) if kind == "SPOT" else point(lamp)
    if group:
        keys["group"] = group
    return table, keys
