"""Meshes as OBJ files, and their materials."""
import hashlib
import os

from vdbeam_blender import sequence

from . import values


def obj_text(points, counts, indices, uvs=None, normals=None, left_handed=False):
    """An OBJ of polygons. `uvs` and `normals`: (values, place of each corner's among them), or None."""
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in points]
    lines += [f"vt {u:.9g} {v:.9g}" for u, v in (uvs or ([],))[0]]
    lines += [f"vn {x:.9g} {y:.9g} {z:.9g}" for x, y, z in (normals or ([],))[0]]
    place = 0
    for count in counts:
        corners = []
        for k in range(place, place + count):
            numbers = [str(indices[k] + 1)] + [str(given[1][k] + 1) if given else "" for given in (uvs, normals)]
            corners.append("/".join(numbers).rstrip("/"))
        lines.append("f " + " ".join(reversed(corners) if left_handed else corners))
        place += count
    return "\n".join(lines) + "\n"


def corner_places(number, interpolation, counts, indices, points):
    """For each corner of the polygons, the place of its value among a number of them; None where they fit in no way."""
    faces = [face for face, count in enumerate(counts) for _ in range(count)]
    ways = {"faceVarying": (len(indices), list(range(len(indices)))), "vertex": (points, indices),
            "varying": (points, indices), "uniform": (len(counts), faces), "constant": (1, [0] * len(indices))}
    named = [ways[interpolation]] if interpolation in ways else []
    # Files that name no interpolation, or a wrong one, are read by the number of values.
    return next((places for size, places in named + list(ways.values()) if size == number), None)


def corner_data(prim, name, time, polygons, fallback=None):
    """(values, place of each corner's) of a primvar or attribute; None without any, or where they do not fit.
    `polygons`: counts, indices and the number of points; `fallback`: the interpolation if none is authored."""
    found = values.value(prim, name, time)
    if not found:
        return None
    order = values.value(prim, f"{name}:indices", time)
    interpolation = prim.GetAttribute(name).GetMetadata("interpolation") or fallback
    places = corner_places(len(found if order is None else order), interpolation, *polygons)
    if places is None:
        return None
    return found, places if order is None else [order[place] for place in places]


def corner_normals(prim, time, polygons, notes):
    """The normals of the corners, from primvars:normals, else normals; None without any."""
    name = next((name for name in ("primvars:normals", "normals") if values.value(prim, name, time)), None)
    normals = name and corner_data(prim, name, time, polygons, "vertex")
    if name and normals is None:
        notes.add(str(prim.GetPath()), f"its {name} fit neither its corners, points nor faces and are left out")
    return normals


def write_mesh(prim, time, folder, notes):
    """Writes a mesh under a name with the hash of its content, and returns the name; None without polygons."""
    points = values.value(prim, "points", time)
    counts = values.value(prim, "faceVertexCounts", time)
    indices = values.value(prim, "faceVertexIndices", time)
    if not points or not counts or not indices:
        return None
    left = values.value(prim, "orientation", time, "rightHanded") == "leftHanded"
    polygons = counts, indices, len(points)
    text = obj_text(points, counts, indices, corner_data(prim, "primvars:st", time, polygons),
                    corner_normals(prim, time, polygons, notes), left)
    name = f"{sequence.safe_name(prim.GetName())}_{hashlib.sha256(text.encode()).hexdigest()[:12]}.obj"
    path = os.path.join(folder, name)
    if not os.path.exists(path):
        with open(path, "w", encoding="ascii") as file:
            file.write(text)
    return name


def note_unknown(prim, time, notes):
    """Notes what a mesh asks for and vdbeam does not have."""
    subject = str(prim.GetPath())
    scheme = values.value(prim, "subdivisionScheme", time, "catmullClark")
    if scheme != "none":
        notes.add(subject, f"a subdivision surface ({scheme}) has no counterpart; its faces are exported as they are")
    if any(values.target(child, "material:binding") is not None for child in prim.GetChildren()
           if child.GetTypeName() == "GeomSubset"):
        notes.add(subject, "materials of parts (GeomSubset) have no counterpart; the whole mesh has its own")
    if values.value(prim, "light:shaderId", time) is not None or "MeshLightAPI" in prim.GetAppliedSchemas():
        notes.add(subject, "MeshLightAPI has no counterpart; set vdbeam:material:type and vdbeam:material:radiance")


def texture_of(surface, stage, name, time):
    """The file of the UsdUVTexture that an input of a surface is connected to; empty without one."""
    path = values.source(surface, name)
    shader = path and stage.GetPrimAtPath(path.GetPrimPath())
    if not shader or str(values.value(shader, "info:id", None)) != "UsdUVTexture":
        return ""
    return values.asset(shader, "file", time)


# Inputs that a file may give: the key that they become, the outputs of UsdUVTexture that have what the key takes (one of
# a grey image is as good as another), and the number that the file multiplies.
MAPS = {"opacity": ("opacity_texture", ("a", "r"), {"opacity": 1.0}),
        "roughness": ("roughness_texture", ("g", "r"), {"roughness": 1.0}),
        "metallic": ("metal_texture", ("b", "r"), {"metal": 1.0}),
        "normal": ("normal_texture", ("rgb",), {})}


def map_keys(surface, stage, subject, time, notes):
    """Keys of the images that an UsdPreviewSurface is connected to, but for its colours."""
    keys = {}
    for name, (texture, outputs, factor) in MAPS.items():
        path = values.source(surface, name)
        if path is None:
            continue
        file = texture_of(surface, stage, name, time)
        if not file or str(path).rpartition(":")[2] not in outputs:
            notes.add(subject, f"the texture of {name} has no counterpart and is left out")
            continue
        keys |= {texture: file, **factor}
    threshold = values.number(surface, "opacityThreshold", time, 0.0)
    if "opacity_texture" in keys and threshold > 0:
        keys["opacity_cutoff"] = clamped(threshold)
    return keys


def clamped(number):
    """A number in [0, 1]."""
    return min(max(number, 0.0), 1.0)


def standard_keys(surface, stage, subject, time, notes):
    """A UsdPreviewSurface that neither shines nor is clear, whose colour a file may give."""
    if values.value(surface, "useSpecularWorkflow", time, 0):
        notes.add(subject, "useSpecularWorkflow has no counterpart; the surface reflects by its ior")
    keys = {"type": "standard",
            "albedo": [clamped(part) for part in values.colour(surface, "diffuseColor", time, (0.18, 0.18, 0.18))],
            "metal": clamped(values.number(surface, "metallic", time, 0.0)),
            "roughness": clamped(values.number(surface, "roughness", time, 0.5)),
            "ior": values.number(surface, "ior", time, 1.5)}
    coat = clamped(values.number(surface, "clearcoat", time, 0.0))
    if coat > 0:
        keys["coat"] = coat
        keys["coat_roughness"] = clamped(values.number(surface, "clearcoatRoughness", time, 0.01))
    keys |= map_keys(surface, stage, subject, time, notes)
    texture = texture_of(surface, stage, "diffuseColor", time)
    if texture:
        return {**keys, "albedo": [1.0, 1.0, 1.0], "texture": texture}
    if values.source(surface, "diffuseColor") is not None:
        notes.add(subject, "its diffuseColor is connected to a shader other than a UsdUVTexture with a file, which has no "
                           "counterpart")
    return keys


def note_unreflected(surface, subject, time, notes):
    """Notes that an emissive mesh reflects nothing, unless its surface is black."""
    diffuse = values.colour(surface, "diffuseColor", time, (0.18, 0.18, 0.18))
    if max(diffuse) > 0 or values.source(surface, "diffuseColor") is not None:
        notes.add(subject, "a surface that both emits and reflects has no counterpart: it emits its emissiveColor and "
                           "reflects nothing")


def material_keys(surface, stage, prim, time, notes):
    """The material of a mesh: of a UsdPreviewSurface, else of displayColor."""
    subject = str(prim.GetPath())
    if surface is None:
        shown = values.value(prim, "primvars:displayColor", time)
        colour = [float(part) for part in shown[0]] if shown else [0.5] * 3
        return {"type": "diffuse", "albedo": [clamped(part) for part in colour]}
    for name in ("emissiveColor", "displacement"):
        if values.source(surface, name) is not None:
            notes.add(subject, f"the texture of {name} has no counterpart and is left out")
    emitted = values.colour(surface, "emissiveColor", time, (0.0, 0.0, 0.0))
    if max(emitted) > 0:
        note_unreflected(surface, subject, time, notes)
        return {"type": "emissive", "radiance": emitted, "two_sided": True}
    if values.source(surface, "opacity") is None and values.number(surface, "opacity", time, 1.0) < 0.5:
        return {"type": "dielectric", "ior": values.number(surface, "ior", time, 1.5),
                "roughness": clamped(values.number(surface, "roughness", time, 0.5))}
    return standard_keys(surface, stage, subject, time, notes)
