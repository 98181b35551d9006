"""Scenes made by script, and how they are rendered; imported inside Blender."""
import math
import os
import pathlib
import sys

import bpy
import numpy

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tools" / "blender"))
os.environ["PATH"] = f"{pathlib.Path(os.environ['VDBEAM_BINARY']).parent}{os.pathsep}{os.environ['PATH']}"

import vdbeam_blender  # noqa: E402
from vdbeam_blender import exr  # noqa: E402

WIDTH, HEIGHT = 160, 90


def empty_scene():
    """A scene of 160 x 90 pixels without anything."""
    if not hasattr(bpy.types.Scene, "vdbeam"):
        vdbeam_blender.register()
    for things in (bpy.data.objects, bpy.data.meshes, bpy.data.lights, bpy.data.cameras, bpy.data.volumes,
                   bpy.data.materials, bpy.data.worlds):
        for thing in list(things):
            things.remove(thing)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, HEIGHT, 100
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.color_depth = "32"
    scene.render.engine = "VDBEAM"
    scene.render.use_border = scene.render.film_transparent = scene.render.use_motion_blur = False
    scene.frame_start = scene.frame_end = 1
    scene.frame_set(1)
    scene.vdbeam.passes, scene.vdbeam.update_interval = 2, 600
    scene.world = None
    return scene


def add(scene, name, data, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1)):
    """A new object."""
    thing = bpy.data.objects.new(name, data)
    thing.location, thing.rotation_euler, thing.scale = location, rotation, scale
    scene.collection.objects.link(thing)
    return thing


def add_camera(scene, location, target, **settings):
    """A camera that looks at a point."""
    data = bpy.data.cameras.new("camera")
    for name, value in settings.items():
        setattr(data, name, value)
    camera = add(scene, "camera", data, location)
    direction = camera.location.__class__(target) - camera.location
    camera.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()
    scene.camera = camera
    return camera


def add_lamp(scene, kind, energy, location=(0, 0, 3), rotation=(0, 0, 0), **settings):
    """A lamp."""
    data = bpy.data.lights.new(kind.lower(), kind)
    data.energy = energy
    for name, value in settings.items():
        setattr(data, name, value)
    return add(scene, kind.lower(), data, location, rotation)


def shader(material, kind, output="Surface", **inputs):
    """Makes a node of this kind the only shader of a material, and returns it."""
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    node = tree.nodes.new(kind)
    for name, value in inputs.items():
        node.inputs[name.replace("_", " ")].default_value = value
    out = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(node.outputs[0], out.inputs[output])
    return node


def add_plane(scene, size=4, **settings):
    """A matt plane."""
    mesh = bpy.data.meshes.new("plane")
    mesh.from_pydata([(-size, -size, 0), (size, -size, 0), (size, size, 0), (-size, size, 0)], [], [(0, 1, 2, 3)])
    material = bpy.data.materials.new("matt")
    shader(material, "ShaderNodeBsdfDiffuse", Color=(0.6, 0.5, 0.4, 1))
    mesh.materials.append(material)
    return add(scene, "plane", mesh, **settings)


def add_box(scene, name, kind, **inputs):
    """A box of a homogeneous medium."""
    mesh = bpy.data.meshes.new(name)
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    mesh.from_pydata(corners, [], [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    material = bpy.data.materials.new(name)
    shader(material, kind, "Volume", **inputs)
    mesh.materials.append(material)
    return add(scene, name, mesh)


def add_volume(scene, file, **inputs):
    """A volume object with a Principled Volume."""
    data = bpy.data.volumes.new("smoke")
    data.filepath = str(file)
    material = bpy.data.materials.new("smoke")
    node = shader(material, "ShaderNodeVolumePrincipled", "Volume", **inputs)
    data.materials.append(material)
    return add(scene, "smoke", data), node


def set_world(scene, colour, strength=1.0):
    """A constant world."""
    world = bpy.data.worlds.new("world")
    scene.world = world
    world.use_nodes = True
    world.node_tree.nodes.clear()
    background = world.node_tree.nodes.new("ShaderNodeBackground")
    background.inputs["Color"].default_value = (*colour, 1)
    background.inputs["Strength"].default_value = strength
    output = world.node_tree.nodes.new("ShaderNodeOutputWorld")
    world.node_tree.links.new(background.outputs[0], output.inputs["Surface"])
    return world.node_tree, background


def use_cycles(scene, samples, seed):
    """Cycles with as little bias as it can have."""
    scene.render.engine = "CYCLES"
    own = scene.cycles
    own.device, own.samples, own.seed = "CPU", samples, seed
    own.use_adaptive_sampling = own.use_denoising = False
    own.max_bounces = own.volume_bounces = own.diffuse_bounces = own.glossy_bounces = 32
    own.sample_clamp_indirect = 0
    own.volume_step_rate = 0.15


def render(scene, path):
    """Renders to a file and returns its planes by their names without the view layer's."""
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return {name.split(".", 1)[1]: plane for name, plane in exr.read(scene.render.filepath)[0].items()}


def combined(planes):
    """R, G, B as one array."""
    return numpy.stack([planes[f"Combined.{letter}"] for letter in "RGB"], -1).astype(float)


def blocks(image, size=30):
    """Means over blocks of pixels."""
    height, width, channels = image.shape
    return image[:height // size * size, :width // size * size].reshape(
        height // size, size, width // size, size, channels).mean((1, 3))


def lamps_on_plane():
    """Sun, point and area lamps and a constant world on a matt plane. Area lamps stand aside, since they block light
    here; Blender 3.4 darkens spot lamps by the cosine, and takes lamps with a radius for disks."""
    scene = empty_scene()
    add_camera(scene, (0, -5, 5), (0, 0, 0), lens=28)
    add_plane(scene)
    add_lamp(scene, "SUN", 1.5, rotation=(0.6, 0.2, 0), angle=0.1)
    add_lamp(scene, "POINT", 100, (-2, 0, 1.5), color=(1, 0.5, 0.2), shadow_soft_size=0)
    add_lamp(scene, "AREA", 60, (0, 5, 2), (-0.8, 0, 0), shape="RECTANGLE", size=1.5, size_y=0.5)
    add_lamp(scene, "AREA", 60, (5, 0, 2), (0, 0.8, 0), shape="DISK", size=0.8, color=(0.3, 0.6, 1))
    set_world(scene, (0.1, 0.2, 0.3), 0.5)
    return scene


def smoke():
    """Smoke with colour, absorption colour and a forward peak, in sunlight and skylight."""
    scene = empty_scene()
    add_camera(scene, (0.5, -6, 2), (1.2, 1, 1.1), lens=85)
    thing, _ = add_volume(scene, REPOSITORY / "data" / "smoke" / "smoke.0024.vdb", Density=6.0,
                          Color=(0.7, 0.6, 0.5, 1), Absorption_Color=(0.3, 0.1, 0.0, 1), Anisotropy=0.3)
    thing.rotation_euler, thing.scale = (0, 0, 0.1), (1.1, 1.1, 1.1)
    add_lamp(scene, "SUN", 3, rotation=(0.7, 0.3, 0), angle=0.01)
    set_world(scene, (0.2, 0.3, 0.5))
    return scene


def box_of_fog():
    """A box that scatters and absorbs, scaled and turned, beside a lamp."""
    scene = empty_scene()
    add_camera(scene, (0, -7, 2), (0, 0, 0), lens=45)
    box = add_box(scene, "fog", "ShaderNodeVolumePrincipled", Density=0.6, Color=(0.8, 0.7, 0.6, 1), Anisotropy=0.2,
                  Density_Attribute="")
    box.scale, box.rotation_euler = (1.5, 1, 0.8), (0, 0, 0.5)
    add_lamp(scene, "POINT", 300, (-2.5, -1, 2), shadow_soft_size=0)
    set_world(scene, (0.1, 0.1, 0.12))
    return scene


def world_of_fog():
    """A lamp over a matt plane, everywhere in fog that scatters and absorbs."""
    scene = empty_scene()
    add_camera(scene, (0, -6, 2.5), (0, 0, 0.5), lens=35)
    add_plane(scene)
    add_lamp(scene, "POINT", 400, (-1, -0.5, 1.8), shadow_soft_size=0)
    tree, _ = set_world(scene, (0, 0, 0))
    fog = tree.nodes.new("ShaderNodeVolumePrincipled")
    for name, value in (("Density", 0.25), ("Color", (0.8, 0.7, 0.6, 1)), ("Anisotropy", 0.3), ("Density Attribute", "")):
        fog.inputs[name].default_value = value
    tree.links.new(fog.outputs[0], next(node for node in tree.nodes if node.type == "OUTPUT_WORLD").inputs["Volume"])
    return scene


def surroundings(folder):
    """A matt plane under an environment image that has no symmetry and is turned."""
    scene = empty_scene()
    add_camera(scene, (0, -5, 2), (0, 0, 1), lens=12)
    add_plane(scene)
    tree, background = set_world(scene, (0, 0, 0), 1.5)
    y, x = numpy.mgrid[0:32, 0:64].astype(numpy.float32)
    file = str(folder / "surroundings.exr")
    exr.write(file, {"R": 0.2 + x / 64, "G": 0.2 + 0.5 * numpy.sin(x / 10) ** 2 + y / 32,
                     "B": 0.1 + 3 * numpy.exp(-((x - 20) ** 2 + (y - 12) ** 2) / 40)})
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(file)
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Rotation"].default_value = (0, 0, 0.7)
    place = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    tree.links.new(texture.outputs[0], background.inputs["Color"])
    return scene


def clear_sky(elevation, sun):
    """A matt plane, seen from above, under a Nishita sky, with its sun only if `sun` says so."""
    scene = empty_scene()
    add_camera(scene, (0, 0, 6), (0, 0, 0), lens=40)
    add_plane(scene)
    tree, background = set_world(scene, (0, 0, 0), 0.1)
    sky = tree.nodes.new("ShaderNodeTexSky")
    sky.sky_type, sky.sun_elevation, sky.sun_disc = "NISHITA", math.radians(elevation), sun
    tree.links.new(sky.outputs[0], background.inputs["Color"])
    return scene


def lens():
    """Lamps of a pixel and more, out of focus, through a shifted lens with a vertical sensor."""
    scene = empty_scene()
    camera = add_camera(scene, (0, -4, 1), (0, 0, 0.2), lens=35, sensor_fit="VERTICAL", sensor_height=20, shift_x=0.15,
                        shift_y=-0.1)
    camera.data.dof.use_dof, camera.data.dof.focus_distance, camera.data.dof.aperture_fstop = True, 2.5, 0.1
    add_plane(scene)
    set_world(scene, (1, 0.5, 0.2))
    return scene
