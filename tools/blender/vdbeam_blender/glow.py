"""Chooses between the two parts of a surface that emits and reflects, since a material of vdbeam does one or the other.

What is left out is an error of the image: the emission one of its radiance, the surface one of the light that it would
reflect. So the part with the smaller radiance is left out. The reflected radiance is estimated without shadows, on a
surface that faces every light.
"""
import math

# No key of vdbeam's: radiance of what a surface emits, and subject of notes, until the lights of its scene are known.
GLOW = "glow"
WHITE = {"dielectric", "mirror"}  # materials without a colour of their own


def area_of(mesh):
    """The area of a lamp that is exported as a quad, a disk or a sphere."""
    if mesh["type"] == "sphere":
        return 4 * math.pi * mesh["scale"][0] ** 2
    rows = mesh["transform"]
    x, y = ([rows[4 * row + column] for row in range(3)] for column in (0, 1))
    across = math.sqrt(sum(value * value for value in x)) * math.sqrt(sum(value * value for value in y))
    return across * (math.pi if mesh["type"] == "disk" else 4)


def place_of(mesh):
    """The place of a mesh: its origin."""
    return mesh["translate"] if "translate" in mesh else mesh["transform"][3::4]


def squared_distance(first, second):
    """The square of the distance of two points, above 0."""
    return max(sum((a - b) ** 2 for a, b in zip(first, second)), 1e-12)


def irradiance(tables, place):
    """The irradiance [W / m^2] on a surface at a place that faces all lights: suns, lamps, the world; the image of an
    environment counts with the radiance 1. The channel of each light with the most counts."""
    total = 0.0
    for light in tables["light"]:
        if light["type"] in ("distant", "atmosphere", "sun"):
            total += max(light["irradiance"])
        elif light["type"] in ("point", "spot"):
            total += max(light["intensity"]) / squared_distance(light["position"], place)
        elif light["type"] == "environment":
            total += math.pi * max(light["radiance"])
    for mesh in tables["mesh"]:
        if mesh.get("type") in ("sphere", "quad", "disk"):  # a lamp; a sphere shows a quarter of its area
            seen = area_of(mesh) / (4 if mesh["type"] == "sphere" else 1)
            total += max(mesh["material"]["radiance"]) * min(seen / squared_distance(place_of(mesh), place), math.pi)
    return total


def reflected(keys, light):
    """The radiance [W / m^2 / sr] that a surface would reflect of an irradiance."""
    albedo = 1.0 if keys["type"] in WHITE else max(keys.get("albedo") or keys.get("reflectance") or [1.0])
    return albedo * light / math.pi


def emits_more(material, glow, light, notes):
    """Whether a surface emits at least what it reflects; what is left out is noted unless it is black."""
    emitted = max(glow["radiance"])
    if emitted < reflected(material, light):
        notes.add(glow["subject"], f"its emission, of the radiance {emitted:.2g}, is left out on objects that reflect "
                                   "more; a material does one or the other")
        return False
    if reflected(material, 1.0) > 0 or material["type"] == "standard":
        notes.add(glow["subject"], f"its surface is left out on objects that reflect less than the radiance "
                                   f"{emitted:.2g} that it emits; a material does one or the other")
    return True


def choose(tables, emissive, notes):
    """Chooses for all meshes of a scene, whose lights are complete. `emissive`: the choices so far by the names of the
    meshes, which hold at all times, since the type of a material cannot change."""
    for mesh in tables["mesh"]:
        material, name = mesh["material"], mesh["name"]
        glow = material.pop(GLOW, None)
        if name not in emissive:
            emissive[name] = material["type"] == "emissive" if glow is None else \
                emits_more(material, glow, irradiance(tables, place_of(mesh)), notes)
        elif glow is not None and not emissive[name]:
            notes.add(glow["subject"], "its emission is left out at all times, as it is at the first")
        if emissive[name] and material["type"] != "emissive":
            radiance = [0.0] * 3 if glow is None else glow["radiance"]
            mesh["material"] = {"type": "emissive", "radiance": radiance, "two_sided": True}
        elif not emissive[name]:
            mesh.pop("group", None)
