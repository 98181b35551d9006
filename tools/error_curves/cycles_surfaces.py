"""Meshes and materials of a vdbeam scene in Blender; for cycles_scene.py, which Blender runs."""

import bmesh
import bpy
from mathutils import Matrix


def matrix_of(transform):
    """A row-major 3x4 matrix as Blender has it."""
    return Matrix((transform[0:4], transform[4:8], transform[8:12], (0, 0, 0, 1)))


def _quad(mesh):
    mesh.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
    layer = mesh.uv_layers.new()
    for item, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1))):
        item.uv = uv


def _disk(mesh):
    shape = bmesh.new()
    bmesh.ops.create_circle(shape, cap_ends=True, segments=256, radius=1)
    for face in shape.faces:
        if face.normal.z < 0:
            face.normal_flip()
    shape.to_mesh(mesh)


def _sphere(mesh):
    """Cycles has no spheres: 81920 triangles with smooth normals."""
    shape = bmesh.new()
    bmesh.ops.create_icosphere(shape, subdivisions=7, radius=1)
    for face in shape.faces:
        face.smooth = True
    shape.to_mesh(mesh)


def _file(path):
    before = set(bpy.data.objects)
    if path.lower().endswith(".obj"):
        bpy.ops.wm.obj_import(filepath=path, forward_axis="Y", up_axis="Z")
    else:
        bpy.ops.import_mesh.ply(filepath=path)
    return [item for item in bpy.data.objects if item not in before]


def _with_defaults(settings):
    """The values that stand for those that the scene leaves to vdbeam."""
    values = dict(settings)
    if values["albedo"] is None:
        values["albedo"] = [1, 1, 1] if values.get("texture") else [0.8, 0.8, 0.8]
    if values["roughness"] is None:
        values["roughness"] = 0.2 if values["type"] == "conductor" else 0
    return values


def _reflecting(tree, settings, output):
    kind = settings["type"]
    if kind == "diffuse":
        node = tree.nodes.new("ShaderNodeBsdfDiffuse")
        node.inputs["Color"].default_value = (*settings["albedo"], 1)
        _add_texture(tree, settings, settings["albedo"], node.inputs["Color"])
    elif kind in ("mirror", "conductor"):
        node = tree.nodes.new("ShaderNodeBsdfGlossy")
        node.distribution = "SHARP" if kind == "mirror" else "GGX"
        node.inputs["Color"].default_value = (*settings["reflectance"], 1)
        if kind == "conductor":
            node.inputs["Roughness"].default_value = settings["roughness"]
    else:
        node = tree.nodes.new("ShaderNodeBsdfGlass")
        node.distribution = "GGX" if settings["roughness"] else "SHARP"
        node.inputs["Color"].default_value = (1, 1, 1, 1)
        node.inputs["IOR"].default_value = settings["ior"]
        node.inputs["Roughness"].default_value = settings["roughness"]
    tree.links.new(node.outputs["BSDF"], output.inputs["Surface"])


def _add_texture(tree, settings, factor, target):
    if not settings.get("texture"):
        return
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.load(settings["texture"])
    node.image.colorspace_settings.name = (
        "sRGB" if settings["texture"].lower().endswith(".png") else "Linear")
    node.extension = {"repeat": "REPEAT", "clamp": "EXTEND"}[settings["texture_wrap"]]
    times = tree.nodes.new("ShaderNodeMixRGB")
    times.blend_type, times.inputs["Fac"].default_value = "MULTIPLY", 1
    times.inputs["Color1"].default_value = (*factor, 1)
    tree.links.new(node.outputs["Color"], times.inputs["Color2"])
    tree.links.new(times.outputs["Color"], target)


def _shining(tree, settings, output):
    """Shines from its front, or both sides, and is black."""
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value = (*settings["radiance"], 1)
    emission.inputs["Strength"].default_value = 1
    _add_texture(tree, settings, settings["radiance"], emission.inputs["Color"])
    if settings["two_sided"]:
        tree.links.new(emission.outputs["Emission"], output.inputs["Surface"])
        return
    black = tree.nodes.new("ShaderNodeBsdfDiffuse")
    black.inputs["Color"].default_value = (0, 0, 0, 1)
    side = tree.nodes.new("ShaderNodeNewGeometry")
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(side.outputs["Backfacing"], mix.inputs["Fac"])
    tree.links.new(emission.outputs["Emission"], mix.inputs[1])
    tree.links.new(black.outputs["BSDF"], mix.inputs[2])
    tree.links.new(mix.outputs["Shader"], output.inputs["Surface"])


def _material(settings):
    material = bpy.data.materials.new(settings["type"])
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    (_shining if settings["type"] == "emissive" else _reflecting)(tree, _with_defaults(settings), output)
    return material


def add_mesh(mesh, material):
    """A [[mesh]] and its material, as the report's settings have them."""
    if mesh["type"] == "file":
        places = _file(mesh["file"])
    else:
        data = bpy.data.meshes.new(mesh["type"])
        {"quad": _quad, "disk": _disk, "sphere": _sphere}[mesh["type"]](data)
        places = [bpy.data.objects.new(mesh["type"], data)]
        bpy.context.scene.collection.objects.link(places[0])
    made = _material(material)
    for place in places:
        place.data.materials.clear()
        place.data.materials.append(made)
        place.matrix_world = matrix_of(mesh["transform"])
        place.visible_camera = mesh["visible"]
