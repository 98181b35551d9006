"""Meshes as OBJ files, and their materials."""
import hashlib
import os

from vdbeam_blender import sequence

from . import values


def obj_text(points, counts, indices, uvs=None, left_handed=False):
    """An OBJ of polygons. `uvs`: one for each corner, or None."""
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in points]
    if uvs is not None:
        lines += [f"vt {u:.9g} {v:.9g}" for u, v in uvs]
    place = 0
    for count in counts:
        corners = [f"{indices[k] + 1}/{k + 1}" if uvs is not None else f"{indices[k] + 1}"
                   for k in range(place, place + count)]
        lines.append("f " + " ".join(reversed(corners) if left_handed else corners))
        place += count
    return "\n".join(lines) + "\n"


def corner_uvs(prim, time, indices, points):
    """The texture coordinates of the corners, from primvars:st; None without any."""
    found = values.value(prim, "primvars:st", time)
    if found is None:
        return None
    order = values.value(prim, "primvars:st:indices", time)
    uvs = [found[k] for k in order] if order is not None else list(found)
    if len(uvs) == len(indices):
        return uvs
    return [uvs[k] for k in indices] if len(uvs) == points else None


def write_mesh(prim, time, folder):
    """Writes a mesh under a name with the hash of its content, and returns the name; None without polygons."""
    points = values.value(prim, "points", time)
    counts = values.value(prim, "faceVertexCounts", time)
    indices = values.value(prim, "faceVertexIndices", time)
    if not points or not counts or not indices:
        return None
    left = values.value(prim, "orientation", time, "rightHanded") == "leftHanded"
    text = obj_text(points, counts, indices, corner_uvs(prim, time, indices, len(points)), left)
    name = f"{sequence.safe_name(prim.GetName())}_{hashlib.sha256(text.encode()).hexdigest()[:12]}.obj"
    path = os.path.join(folder, name)
    if not os.path.exists(path):
        with open(path, "w", encoding="ascii") as file:
            file.write(text)
    return name


def material_keys(surface, prim, time, notes):
    """The material of a mesh: of a UsdPreviewSurface, else of displayColor."""
    subject = str(prim.GetPath())
    if surface is None:
        shown = values.value(prim, "primvars:displayColor", time)
        colour = [float(part) for part in shown[0]] if shown else [0.5] * 3
        return {"type": "diffuse", "albedo": [min(max(part, 0.0), 1.0) for part in colour]}
    emitted = values.colour(surface, "emissiveColor", time, (0.0, 0.0, 0.0))
    if max(emitted) > 0:
        return {"type": "emissive", "radiance": emitted, "two_sided": True}
    colour = [min(max(part, 0.0), 1.0) for part in values.colour(surface, "diffuseColor", time, (0.18, 0.18, 0.18))]
    roughness = values.number(surface, "roughness", time, 0.5)
    if values.number(surface, "metallic", time, 0.0) > 0.5:
        return {"type": "conductor", "reflectance": colour, "roughness": roughness}
    if values.number(surface, "opacity", time, 1.0) < 0.5:
        return {"type": "dielectric", "ior": values.number(surface, "ior", time, 1.5), "roughness": roughness}
    notes.add(subject, "the gloss of a UsdPreviewSurface that is not metal has no counterpart; the surface is matt")
    return {"type": "diffuse", "albedo": colour}
