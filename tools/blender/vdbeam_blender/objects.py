"""Reads Blender's objects into tables of a scene file. Objects are what has Blender's attributes; bpy itself is not
imported."""
import math

import numpy

from . import lamps, meshes, nodes, sequence, surface_shader, volume_shader

SURFACES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
NEVER = -999999  # number of a file that no sequence has


def rows(matrix):
    """A matrix as lists of numbers."""
    return [[float(value) for value in row] for row in matrix]


def transform(matrix):
    """Twelve numbers of a [[volume]] or [[mesh]]."""
    return [float(value) for row in list(matrix)[:3] for value in row]


def materials_of(obj):
    """The materials of an object's slots; slots may be empty."""
    return [slot.material for slot in obj.material_slots]


def volume_shader_of(obj):
    """The volume shader of an object's first material with nodes, and the material; (None, None) without one."""
    for material in materials_of(obj):
        if material is not None and material.use_nodes:
            return nodes.shader_of(material.node_tree, "OUTPUT_MATERIAL", "Volume"), material
    return None, None


# Cycles renders a volume object without a material as a Principled Volume with its defaults.
DEFAULT_VOLUME = {"extinction": 1.0, "extinction_scale": [1.0] * 3, "albedo": [0.5] * 3, "density": "density"}


def volume_keys(obj, data, matrix, notes):
    """Shading and place of a volume object; None where its material shows nothing."""
    shader, material = volume_shader_of(obj)
    if material is None:
        keys = dict(DEFAULT_VOLUME)
    else:
        keys = volume_shader.volume_keys(shader, notes, material.name)
    if keys is None:
        notes.add(obj.name, "its material has no volume shader that can be exported; the volume is left out")
        return None
    if not keys["density"]:
        notes.add(obj.name, "its shader uses no density grid; it is exported with the grid density")
        keys["density"] = "density"
    if data.render.space == "OBJECT":  # Cycles then keeps the opacity when the object is scaled
        stretch = math.sqrt(sum(sum(row[:3]) ** 2 for row in rows(matrix)[:3]) / 3)
        keys["extinction"] /= max(stretch, 1e-9)
    keys["transform"] = transform(matrix)
    return keys


def volume_file(data, frame, abspath):
    """`file` and, of a sequence, `time`, by Blender's rules."""
    path = abspath(data.filepath)
    if not data.is_sequence:
        return {"file": path}
    pattern, _ = sequence.pattern_of(path)
    number = sequence.file_number(math.floor(frame), {"mode": data.sequence_mode, "duration": data.frame_duration,
                                                      "start": data.frame_start, "offset": data.frame_offset})
    return {"file": pattern, "time": {"offset": float(NEVER if number is None else number), "speed": 0.0,
                                      "out_of_range": "clip" if data.sequence_mode == "CLIP" else "hold"}}


def volume_motion(data, fps):
    """Velocity of a volume's grids, for motion blur."""
    per_second = getattr(data, "velocity_unit", "FRAME") == "SECOND"
    scale = float(getattr(data, "velocity_scale", 1.0))
    return {"velocity": getattr(data, "velocity_grid", "") or "auto", "velocity_fps": float(fps),
            "velocity_scale": scale if per_second else scale * fps}


def casts_shadow(data):
    """Whether a lamp casts shadows in Cycles, whose setting was its own before Blender 4.2."""
    own = getattr(data, "cycles", None)
    if own is not None and hasattr(own, "cast_shadow"):
        return bool(own.cast_shadow)
    return bool(getattr(data, "use_shadow", True))


def lamp_colour(data):
    """The colour of a lamp, from Blender 4.5 on times that of its temperature."""
    colour = [float(value) for value in data.color]
    if getattr(data, "use_temperature", False):
        colour = [value * float(factor) for value, factor in zip(colour, data.temperature_color)]
    return colour


def lamp_facts(obj, matrix, data):
    """What lamps.py needs to know of a lamp."""
    return {"name": obj.name, "type": data.type, "matrix": rows(matrix), "colour": lamp_colour(data),
            "energy": float(data.energy) * 2 ** float(getattr(data, "exposure", 0.0)),
            "nodes": bool(data.use_nodes and data.node_tree and len(data.node_tree.nodes) > 2),
            "group": getattr(obj, "lightgroup", ""), "radius": float(getattr(data, "shadow_soft_size", 0.0)),
            "angle": float(getattr(data, "angle", 0.0)), "spot_size": float(getattr(data, "spot_size", 0.0)),
            "spot_blend": float(getattr(data, "spot_blend", 0.0)), "shape": getattr(data, "shape", ""),
            "size": float(getattr(data, "size", 0.0)), "size_y": float(getattr(data, "size_y", 0.0)),
            "normalized": bool(getattr(data, "normalize", True)),  # Blender 4.5
            "spread": float(getattr(data, "spread", math.pi)), "casts_shadow": casts_shadow(data),
            "portal": data.type == "AREA" and bool(getattr(getattr(data, "cycles", None), "is_portal", False))}


def camera_facts(obj, image, notes):
    """What camera.py needs to know of a camera."""
    data = obj.data
    matrix = obj.matrix_world
    focus = float(data.dof.focus_distance)
    if data.dof.focus_object is not None:
        away = data.dof.focus_object.matrix_world.translation - matrix.translation
        focus = abs(float(away.dot(matrix.col[2].to_3d().normalized())))
    if data.type == "PANO":
        kind = getattr(data, "panorama_type", None) or getattr(getattr(data, "cycles", None), "panorama_type", "")
        if kind != "EQUIRECTANGULAR":
            notes.add(obj.name, "panoramas other than equirectangular have no counterpart")
    if data.dof.use_dof and getattr(data.dof, "aperture_ratio", 1.0) != 1.0:
        notes.add(obj.name, "the aperture's ratio has no counterpart; it is round")
    return {**image, "type": data.type, "lens": float(data.lens), "sensor_fit": data.sensor_fit,
            "sensor_width": float(data.sensor_width), "sensor_height": float(data.sensor_height),
            "shift_x": float(data.shift_x), "shift_y": float(data.shift_y), "ortho_scale": float(data.ortho_scale),
            "near": float(data.clip_start), "far": float(data.clip_end), "use_dof": bool(data.dof.use_dof),
            "fstop": float(data.dof.aperture_fstop), "blades": int(data.dof.aperture_blades),
            "blade_angle": float(data.dof.aperture_rotation), "focus_distance": focus}


class Triangles:
    """The triangles of a mesh: arrays of corners, and the material of each triangle."""

    def __init__(self, mesh):
        mesh.calc_loop_triangles()
        count, corners = len(mesh.loop_triangles), len(mesh.loops)
        self.loops = numpy.empty(3 * count, numpy.int32)
        mesh.loop_triangles.foreach_get("loops", self.loops)
        self.materials = numpy.empty(count, numpy.int32)
        mesh.loop_triangles.foreach_get("material_index", self.materials)
        points = points_of(mesh)
        of_corner = numpy.empty(corners, numpy.int32)
        mesh.loops.foreach_get("vertex_index", of_corner)
        self.positions = points[of_corner]
        normals = numpy.empty(3 * corners, numpy.float32)
        if hasattr(mesh, "corner_normals"):  # from Blender 4.1 on
            mesh.corner_normals.foreach_get("vector", normals)
        else:
            mesh.calc_normals_split()
            mesh.loops.foreach_get("normal", normals)
        self.normals = normals.reshape(-1, 3)
        self.uvs = None
        if mesh.uv_layers.active is not None:
            uvs = numpy.empty(2 * corners, numpy.float32)
            mesh.uv_layers.active.data.foreach_get("uv", uvs)
            self.uvs = uvs.reshape(-1, 2)

    def of_one(self, index, matrix):
        """The corners of the triangles with this material, placed: (n, 3, 3)."""
        chosen = self.loops.reshape(-1, 3)[self.materials == index]
        placed = numpy.asarray(matrix, float)
        return self.positions[chosen].astype(float) @ placed[:3, :3].T + placed[:3, 3]

    def of_material(self, index):
        """The PLY of the triangles with this material."""
        chosen = self.loops.reshape(-1, 3)[self.materials == index].ravel()
        return meshes.ply_bytes(self.positions[chosen], self.normals[chosen],
                                None if self.uvs is None else self.uvs[chosen])


def material_keys(obj, material, notes, image_path):
    """Keys of the material of a mesh; None where it is not seen."""
    if obj.is_holdout:
        return {"type": "holdout"}
    if material is None or not material.use_nodes:
        colour = [0.8] * 3 if material is None else [float(value) for value in material.diffuse_color[:3]]
        keys = {"type": "diffuse", "albedo": colour}
    else:
        shader = nodes.shader_of(material.node_tree, "OUTPUT_MATERIAL", "Surface")
        keys = surface_shader.surface_keys(shader, notes, material.name, image_path)
    if obj.is_shadow_catcher and keys is not None:
        return {"type": "shadow_catcher", "albedo": keys.get("albedo", [0.8] * 3)}
    return keys


def points_of(mesh):
    """The points of a mesh, of (n, 3)."""
    points = numpy.empty(3 * len(mesh.vertices), numpy.float32)
    mesh.vertices.foreach_get("co", points)
    return points.reshape(-1, 3)


def mesh_volume(obj, box, matrix, shader, notes):
    """A box (lower, upper) of a homogeneous medium, as a [[volume]]; None where the mesh is no box."""
    keys = volume_shader.volume_keys(shader, notes, obj.name)
    if keys is None:
        return None
    if box is None:
        notes.add(obj.name, "a volume inside a mesh that is not a box has no counterpart and is left out; use a volume "
                            "object")
        return None
    if keys.pop("density") or keys.pop("emission", None):
        notes.add(obj.name, "grids and emission of a volume inside a mesh have no counterpart; the box is homogeneous")
    keys.pop("mask", None)
    keys.pop("color_grid", None)
    return {"shape": "box", "box_lower": box[0], "box_upper": box[1], **keys, "transform": transform(matrix)}


def lamp_table(obj, matrix, data, notes):
    """("light" or "mesh", keys) of a lamp object; None of one that emits nothing."""
    found = lamps.lamp_keys(lamp_facts(obj, matrix, data), notes)
    if found is None:
        return None
    table, keys = found
    if table == "mesh":
        keys = {"name": obj.name, **keys}
    return table, keys
