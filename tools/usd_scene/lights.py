"""From UsdLux to [[light]] and emissive [[mesh]].

The quantities are UsdLux's: the radiance is intensity 2^exposure colour; `normalize` divides it by the area of a lamp,
and makes it the irradiance of a distant light. USD's nits are taken as W / m^2 / sr.
"""
import math

from . import values

KINDS = {"DistantLight", "DomeLight", "DomeLight_1", "SphereLight", "RectLight", "DiskLight", "CylinderLight"}


def emission(prim, time):
    """(radiance, keys): intensity, exposure, colour and colour temperature."""
    default = 50000.0 if prim.GetTypeName() == "DistantLight" else 1.0
    strength = values.number(prim, "intensity", time, default) * 2 ** values.number(prim, "exposure", time, 0.0)
    keys = {}
    if values.value(prim, "enableColorTemperature", time, False):
        keys["kelvin"] = values.number(prim, "colorTemperature", time, 6500.0)
    return [strength * part for part in values.colour(prim, "color", time)], keys


def scaled(colour, factor):
    """A colour times a number."""
    return [part * factor for part in colour]


def axis(matrix, column, sign=1.0):
    """A unit vector along an axis of a matrix."""
    vector = [sign * matrix[row][column] for row in range(3)]
    length = math.sqrt(sum(part * part for part in vector)) or 1.0
    return [part / length for part in vector]


def stretch(matrix, column):
    """The length of an axis of a matrix."""
    return math.sqrt(sum(matrix[row][column] ** 2 for row in range(3)))


def placed(matrix, scale):
    """Twelve numbers of a matrix whose axes are scaled first."""
    return [matrix[row][column] * (scale[column] if column < 3 else 1.0) for row in range(3) for column in range(4)]


def distant(prim, matrix, time):
    """A DistantLight shines along its -Z axis."""
    radiance, keys = emission(prim, time)
    half = math.radians(values.number(prim, "angle", time, 0.53)) / 2
    normalised = values.value(prim, "normalize", time, False) or half <= 0
    factor = 1.0 if normalised else math.pi * math.sin(min(half, math.pi / 2)) ** 2
    return {"type": "distant", "direction": axis(matrix, 2, -1.0), "irradiance": scaled(radiance, factor),
            "angular_radius": math.degrees(half), **keys}


def dome(prim, matrix, time, z_up, notes):
    """A DomeLight. Its image has +Z in the middle, +Y up, and +X a quarter to the left, as vdbeam's in a world with Y
    up."""
    radiance, keys = emission(prim, time)
    light = {"type": "environment", "radiance": radiance, **keys}
    image = values.asset(prim, "texture:file", time)
    if not image:
        return light
    if values.value(prim, "texture:format", time, "automatic") not in ("automatic", "latlong"):
        notes.add(str(prim.GetPath()), "a texture:format other than latlong has no counterpart")
    middle, pole = axis(matrix, 2), axis(matrix, 1)
    if z_up and prim.GetTypeName() == "DomeLight_1" and values.value(prim, "poleAxis", time, "scene") != "Y":
        middle, pole = axis(matrix, 1, -1.0), axis(matrix, 2)
    up = 2 if z_up else 1
    if pole[up] < 0.999:
        notes.add(str(prim.GetPath()), "a dome that is tilted has no counterpart; it stands upright")
    # The angle about the up axis from where vdbeam has the middle of the image, -Y or +Z.
    if z_up:
        angle = math.atan2(middle[0], -middle[1])
    else:
        angle = math.atan2(middle[0], middle[2])
    return {**light, "image": image, "rotation": math.degrees(angle)}


def sphere(prim, matrix, time, notes):
    """("light" or "mesh", keys) of a SphereLight; one that is treated as a point has the same intensity."""
    radiance, keys = emission(prim, time)
    radius = values.number(prim, "radius", time, 0.5)
    size = radius * sum(stretch(matrix, column) for column in range(3)) / 3
    if values.value(prim, "normalize", time, False) and size > 0:
        radiance = scaled(radiance, 1 / (4 * math.pi * size ** 2))
    cone = shaping(prim, matrix, time)
    is_point = size <= 0 or values.value(prim, "treatAsPoint", time, False)
    if is_point or cone:
        if not is_point:
            notes.add(str(prim.GetPath()), "a cone or profile of a lamp with a radius has no counterpart; its light comes "
                                           "from a point")
        if "ies" in cone:
            notes.add(str(prim.GetPath()), "its profile gives the shape of the intensity, not the strength")
        intensity = scaled(radiance, math.pi * size ** 2 if size > 0 else 0.25)
        return "light", {"type": "point", "position": [matrix[row][3] for row in range(3)], "intensity": intensity,
                         **cone, **keys}
    return "mesh", {"type": "sphere", "transform": placed(matrix, [radius] * 3),
                    "material": {"type": "emissive", "radiance": radiance, **keys}}


def shaping(prim, matrix, time):
    """Keys of the cone and the profile of a light, about its -Z axis; empty without them."""
    keys = {}
    angle = values.number(prim, "shaping:cone:angle", time, 90.0)
    if 0 < angle < 90:
        softness = min(max(values.number(prim, "shaping:cone:softness", time, 0.0), 0.0), 1.0)
        keys = {"type": "spot", "cone_angle": angle, "cone_falloff": softness * angle}
    profile = values.asset(prim, "shaping:ies:file", time)
    if profile:
        keys["ies"] = profile
    return {**keys, "direction": axis(matrix, 2, -1.0)} if keys else {}


def cylinder(prim, matrix, time, notes):
    """A CylinderLight, which lies along its X axis; vdbeam's lies along Z."""
    radiance, keys = emission(prim, time)
    radius, half = values.number(prim, "radius", time, 0.5), values.number(prim, "length", time, 1.0) / 2
    around = (stretch(matrix, 1) + stretch(matrix, 2)) / 2
    area = 2 * math.pi * radius * around * 2 * half * stretch(matrix, 0)
    if values.value(prim, "normalize", time, False) and area > 0:
        radiance = scaled(radiance, 1 / area)
    notes.add(str(prim.GetPath()), "the ends of the cylinder shine, too")
    lying = [[row[1], row[2], row[0], row[3]] for row in matrix]
    return {"type": "cylinder", "transform": placed(lying, [radius, radius, half]),
            "material": {"type": "emissive", "radiance": radiance, **keys}}


def flat(prim, matrix, time):
    """A RectLight or DiskLight, which shines along its -Z axis; vdbeam's shapes face +Z."""
    radiance, keys = emission(prim, time)
    round_shape = prim.GetTypeName() == "DiskLight"
    if round_shape:
        x = y = values.number(prim, "radius", time, 0.5)
    else:
        x, y = (values.number(prim, name, time, 1.0) / 2 for name in ("width", "height"))
    area = x * y * stretch(matrix, 0) * stretch(matrix, 1) * (math.pi if round_shape else 4)
    if values.value(prim, "normalize", time, False) and area > 0:
        radiance = scaled(radiance, 1 / area)
    material = {"type": "emissive", "radiance": radiance, **keys}
    texture = values.asset(prim, "texture:file", time)
    if texture:
        material["texture"] = texture
    # Half a turn about Y keeps the image upright for who looks at the lamp.
    return {"type": "disk" if round_shape else "quad", "transform": placed(matrix, [-x, y, -1.0]),
            "material": material}


# Controls without a counterpart, with the values that change nothing.
CONTROLS = {"shaping:focus": (0,), "shaping:cone:angle": (90,), "shaping:ies:file": ("",), "diffuse": (1,),
            "specular": (1,), "shadow:enable": (True,), "shadow:distance": (-1,), "shadow:falloff": (-1,)}


def note_controls(prim, time, known, notes):
    """Notes what a light asks for and vdbeam does not have, but for the controls that are known."""
    subject = str(prim.GetPath())
    for name, harmless in CONTROLS.items():
        found = values.value(prim, name, time)
        if found is None or name in known or values.plain(found) in harmless:
            continue
        notes.add(subject, f"{name} has no counterpart and is left out")
    black = (0.0, 0.0, 0.0)
    for name in ("shaping:focusTint", "shadow:color"):
        if max(values.colour(prim, name, time, black)) > 0:
            notes.add(subject, f"{name} has no counterpart and is left out")
    for name in ("light:filters", "filters", "collection:lightLink:excludes", "collection:shadowLink:excludes"):
        if values.target(prim, name) is not None:
            notes.add(subject, f"{name} has no counterpart and is left out")
    for name in ("collection:lightLink:includeRoot", "collection:shadowLink:includeRoot"):
        if values.value(prim, name, time, True) is False:
            notes.add(subject, f"{name} has no counterpart; the light reaches everything")


def light_tables(prim, matrix, time, z_up, notes):
    """("light" or "mesh", keys) of a light."""
    kind = prim.GetTypeName()
    subject = str(prim.GetPath())
    note_controls(prim, time, ("shaping:cone:angle", "shaping:ies:file") if kind == "SphereLight" else (), notes)
    if kind == "DistantLight":
        return "light", distant(prim, matrix, time)
    if kind.startswith("DomeLight"):
        return "light", dome(prim, matrix, time, z_up, notes)
    if kind == "SphereLight":
        table, keys = sphere(prim, matrix, time, notes)
    else:
        table, keys = "mesh", cylinder(prim, matrix, time, notes) if kind == "CylinderLight" else flat(prim, matrix, time)
    if table == "mesh":
        notes.add(subject, "it is exported as an emissive mesh, which blocks light")
        keys = {"name": subject, **keys}
    return table, keys
