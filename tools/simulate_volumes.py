#!/usr/bin/env python3
"""Simulates a smoke plume or an explosion with Blender's Mantaflow and writes one frame as a VDB.

Usage: simulate_volumes.py plume|explosion FILE.vdb [RESOLUTION]

The longest side of the domain has RESOLUTION voxels (192 by default). The gas is simulated at half of it, and Mantaflow's
noise adds the fine detail. On one core 192 takes some minutes; twice the resolution takes about sixteen times longer. Z is
up; the domain's lower corner is the origin. Blender 3.4 is needed (the Debian package blender). The frames that lead to
the one that is kept are deleted.
"""
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

# Half sides of the domain [world units], the frame that is kept, and settings of Blender's FluidDomainSettings.
KINDS = {
    "plume": {"half_size": (1.3, 0.9, 1.8), "frame": 34, "settings": {
        "alpha": 2.0, "beta": 3.0, "vorticity": 0.15, "use_dissolve_smoke": False, "time_scale": 1.2,
        "timesteps_max": 4, "cfl_condition": 3.0, "gravity": (-0.8, -0.2, -9.81)}},
    "explosion": {"half_size": (2.2, 2.2, 2.2), "frame": 16, "settings": {
        "alpha": 1.5, "beta": 3.5, "vorticity": 0.35, "use_dissolve_smoke": False, "burning_rate": 0.38,
        "flame_smoke": 1.6, "flame_vorticity": 0.9, "flame_ignition": 1.2, "flame_max_temp": 3.2,
        "time_scale": 1.0, "timesteps_max": 4, "cfl_condition": 3.0}},
}


def add_domain(bpy, kind, resolution, cache):
    """Returns the domain, which stands on the plane z = 0."""
    half = kind["half_size"]
    bpy.ops.mesh.primitive_cube_add(size=2, location=(0, 0, half[2]))
    domain = bpy.context.object
    domain.scale = half
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    modifier = domain.modifiers.new("fluid", "FLUID")
    modifier.fluid_type = "DOMAIN"
    settings = modifier.domain_settings
    settings.domain_type = "GAS"
    settings.resolution_max = resolution // 2
    settings.use_noise = True
    settings.noise_scale = 2
    settings.noise_strength = 1.2
    settings.use_collision_border_bottom = True
    for side in ("front", "back", "left", "right", "top"):
        setattr(settings, f"use_collision_border_{side}", False)
    settings.use_adaptive_domain = False
    settings.cache_type = "ALL"
    settings.cache_data_format = "OPENVDB"
    settings.openvdb_cache_compress_type = "BLOSC"
    settings.openvdb_data_depth = "16"
    settings.cache_directory = cache
    settings.cache_frame_start = 1
    settings.cache_frame_end = kind["frame"]
    for name, value in kind["settings"].items():
        setattr(settings, name, value) if name != "gravity" else setattr(bpy.context.scene, name, value)
    return domain


def add_source(bpy, place, radius, flow, velocity, last_frame, noise):
    """Adds a ball with a rough surface that gives off gas until `last_frame` (None: to the end)."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=radius, location=place)
    ball = bpy.context.object
    if noise:
        texture = bpy.data.textures.new(f"rough{place}", "CLOUDS")
        texture.noise_scale = 0.6 * radius
        rough = ball.modifiers.new("rough", "DISPLACE")
        rough.texture = texture
        rough.texture_coords = "GLOBAL"
        rough.strength = noise * radius
    modifier = ball.modifiers.new("fluid", "FLUID")
    modifier.fluid_type = "FLOW"
    settings = modifier.flow_settings
    settings.flow_behavior = "INFLOW"
    for name, value in flow.items():
        setattr(settings, name, value)
    if any(velocity):
        settings.use_initial_velocity = True
        settings.velocity_coord = velocity
    if last_frame is not None:
        for frame, value in ((1, True), (last_frame, True), (last_frame + 1, False)):
            settings.use_inflow = value
            settings.keyframe_insert("use_inflow", frame=frame)


def add_plume(bpy):
    texture = bpy.data.textures.new("uneven", "CLOUDS")
    texture.noise_scale = 0.18
    flow = {"flow_type": "SMOKE", "density": 1.0, "temperature": 1.6, "surface_distance": 0.5,
            "use_texture": True, "noise_texture": texture, "texture_size": 1.0}
    add_source(bpy, (-0.7, -0.1, 0.2), 0.2, flow, (0.3, 0.1, 2.2), None, 0.3)


def add_explosion(bpy):
    flow = {"flow_type": "BOTH", "density": 1.0, "temperature": 2.2, "fuel_amount": 2.2, "surface_distance": 0.8}
    add_source(bpy, (0, 0, 0.55), 0.42, flow, (0, 0, 4.0), 8, 0.6)
    for i in range(7):
        angle = 2 * math.pi * i / 7 + 0.35 * math.sin(5.0 * i)
        reach = 0.62 + 0.16 * math.sin(3.0 * i + 1)
        place = (reach * math.cos(angle), reach * math.sin(angle), 0.34 + 0.12 * (i % 3))
        speed = 3.2 + 1.1 * math.sin(7.0 * i)
        velocity = (speed * math.cos(angle), speed * math.sin(angle), 1.6 + 0.9 * (i % 3))
        add_source(bpy, place, 0.2 + 0.03 * (i % 3), flow, velocity, 5 + i % 3, 0.6)


def simulate_in_blender(name, cache, resolution):
    import bpy  # exists within Blender only
    bpy.ops.wm.read_factory_settings(use_empty=True)
    kind = KINDS[name]
    bpy.context.scene.frame_end = kind["frame"]
    {"plume": add_plume, "explosion": add_explosion}[name](bpy)
    # The domain comes last: Blender evaluates it with each new object, and fails with sources that appear later.
    domain = add_domain(bpy, kind, resolution, cache)
    bpy.context.view_layer.objects.active = domain
    bpy.ops.fluid.bake_all()


def main():
    if len(sys.argv) not in (3, 4) or sys.argv[1] not in KINDS:
        sys.exit(__doc__.split("\n\n")[1])
    name, target = sys.argv[1], pathlib.Path(sys.argv[2])
    resolution = sys.argv[3] if len(sys.argv) == 4 else "192"
    if not resolution.isdigit() or not 16 <= int(resolution) <= 1024:
        sys.exit(f"simulate_volumes.py: RESOLUTION must be a whole number in [16, 1024], got {resolution}")
    if not shutil.which("blender"):
        sys.exit("simulate_volumes.py: there is no blender; install it with: apt install blender")
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as cache:
        done = subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", __file__,
                               "--", "inside", name, cache, resolution], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        frame = pathlib.Path(cache) / "noise" / f"fluid_noise_{KINDS[name]['frame']:04d}.vdb"
        if done.returncode or not frame.exists():
            sys.exit(f"simulate_volumes.py: Blender made no {frame.name}; its last lines are\n{done.stdout[-6000:]}")
        shutil.copyfile(frame, target)
    print(f"{target}: written")


if "inside" in sys.argv:
    simulate_in_blender(*sys.argv[sys.argv.index("inside") + 1:][:2], int(sys.argv[-1]))
else:
    main()
