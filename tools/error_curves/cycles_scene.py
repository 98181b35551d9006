"""Builds a vdbeam scene in Blender and renders it with Cycles; run by Blender itself:

  blender --background --factory-startup --python cycles_scene.py -- SETTINGS.json

SETTINGS.json: `settings` of a vdbeam report, `image` (EXR to write), `seconds`, `threads`, `seed`,
`samples`, `step_rate`, `half_voxels` (half a voxel of each volume's grid, in the units of its file), `sky` (lat-long
EXR of all lights that surround the scene, its middle towards `sky_front`; null: there are none), `result` (JSON to write).

What has to be minded (Blender 3.4):
 - it draws voxel i at i + 1/2 where OpenVDB, and vdbeam, put it at i;
 - it marches with one jittered offset: a step as long as a voxel is too bright where voxels are optically
   thick, hence step_rate;
 - a sun's strength is the irradiance on a plane that faces it, a world's strength is radiance;
 - a point's power is 4 pi times its radiant intensity;
 - paths end after 4 bounces and pixels are filtered, unless the scene sets these explicitly.
"""

import json
import os
import sys
import time

from math import pi, radians
from pathlib import Path

import bpy
from mathutils import Matrix, Vector

sys.path.insert(0, str(Path(__file__).parent))
from cycles_surfaces import add_mesh, matrix_of  # noqa: E402


def look_at(camera):
    position, target = Vector(camera["position"]), Vector(camera["look_at"])
    back = (position - target).normalized()
    right = Vector(camera["up"]).cross(back).normalized()
    up = back.cross(right)
    return Matrix(((right.x, up.x, back.x, position.x), (right.y, up.y, back.y, position.y),
                   (right.z, up.z, back.z, position.z), (0, 0, 0, 1)))


def add_camera(settings):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.angle = radians(settings["camera"]["fov"])
    data.clip_start, data.clip_end = 1e-3, 1e6
    camera = bpy.data.objects.new("camera", data)
    camera.matrix_world = look_at(settings["camera"])
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def add_volume(volume, half_voxel):
    data = bpy.data.volumes.new("volume")
    data.filepath = volume["file"]
    material = bpy.data.materials.new("medium")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    medium = tree.nodes.new("ShaderNodeVolumePrincipled")
    medium.inputs["Color"].default_value = (*volume["albedo"], 1)
    medium.inputs["Absorption Color"].default_value = (0, 0, 0, 1)  # what does not scatter is lost
    medium.inputs["Anisotropy"].default_value = volume["phase"].get("g") or 0
    # The node multiplies its density by the attribute of that name.
    medium.inputs["Density"].default_value = volume["extinction"]
    medium.inputs["Density Attribute"].default_value = volume["density"]
    tree.links.new(medium.outputs["Volume"], output.inputs["Volume"])
    data.materials.append(material)
    place = bpy.data.objects.new("volume", data)
    place.matrix_world = matrix_of(volume["transform"]) @ Matrix.Translation([-h for h in half_voxel])
    data.render.space = "WORLD"  # the density is per world unit, however the object is scaled
    bpy.context.scene.collection.objects.link(place)


def add_light(light):
    color = light["irradiance" if light["type"] == "distant" else "intensity"]
    strength = max(color)
    if light["type"] == "distant":
        data = bpy.data.lights.new("sun", "SUN")
        data.energy = strength
        data.angle = radians(2 * light["angular_radius"])
    else:
        data = bpy.data.lights.new("point", "POINT")
        data.energy = 4 * pi * strength
        data.shadow_soft_size = 0
    data.color = [c / strength for c in color]
    place = bpy.data.objects.new(light["type"], data)
    if light["type"] == "distant":
        place.rotation_euler = Vector(light["direction"]).to_track_quat("-Z", "Y").to_euler()
    else:
        place.location = light["position"]
    place.visible_camera = False
    bpy.context.scene.collection.objects.link(place)


def add_sky(path, front, up, visible):
    """The middle of a vdbeam panorama looks to the front; Cycles' middle is x, its left y."""
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    ahead = Vector(front).normalized()
    right = ahead.cross(Vector(up)).normalized()
    turned = Matrix((ahead, -right, right.cross(ahead)))
    place = nodes.new("ShaderNodeTexCoord")
    mapping = nodes.new("ShaderNodeMapping")
    mapping.inputs["Rotation"].default_value = turned.to_euler()
    picture = nodes.new("ShaderNodeTexEnvironment")
    picture.image = bpy.data.images.load(path)
    picture.image.colorspace_settings.name = "Linear"
    links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], picture.inputs["Vector"])
    links.new(picture.outputs["Color"], nodes["Background"].inputs["Color"])
    world.cycles_visibility.camera = visible
    bpy.context.scene.world = world


def set_up_render(job):
    scene = bpy.context.scene
    image = job["settings"]["image"]
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = image["width"], image["height"]
    scene.render.resolution_percentage = 100
    scene.render.threads_mode = "FIXED"
    scene.render.threads = job["threads"]
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.seed = job["seed"]
    cycles.samples = job.get("samples") or 1 << 20
    cycles.time_limit = job["seconds"] or 0
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1
    cycles.max_bounces = cycles.volume_bounces = cycles.diffuse_bounces = 1024
    cycles.glossy_bounces = cycles.transmission_bounces = 1024
    cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.volume_step_rate = job["step_rate"]
    cycles.volume_max_steps = 65536
    cycles.use_auto_tile = False
    output = scene.render.image_settings
    output.file_format, output.color_depth, output.exr_codec = "OPEN_EXR", "32", "ZIP"
    scene.render.filepath = job["image"]


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as file:
        job = json.load(file)
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    bpy.context.scene.world = None
    add_camera(job["settings"])
    for volume, half_voxel in zip(job["settings"].get("volume", []), job["half_voxels"]):
        add_volume(volume, half_voxel)
    for mesh, material in zip(job["settings"].get("mesh", []), job["settings"].get("mesh.material", [])):
        add_mesh(mesh, material)
    for light in job["settings"].get("light", []):
        if light["type"] in ("distant", "point"):
            add_light(light)
    if job["sky"]:
        add_sky(job["sky"], job["sky_front"], job["settings"]["camera"]["up"], job["sky_visible"])
    set_up_render(job)
    start, used = time.monotonic(), sum(os.times()[:2])
    bpy.ops.render.render(write_still=True)
    with open(job["result"], "w", encoding="utf-8") as file:
        json.dump({"seconds": time.monotonic() - start, "processor_seconds": sum(os.times()[:2]) - used,
                   "version": bpy.app.version_string}, file)


main()
