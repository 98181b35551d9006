"""OpenVDB's own vdb_render on the same scene, where that is within its means: one fog volume, one distant
light, isotropic scattering, once.

What has to be minded (OpenVDB 10.0):
 - steps, and so absorption and scattering, are per voxel, not per world unit;
 - its light's colour is the radiance that scatters towards the camera: irradiance / (4 pi);
 - its light's direction points to the light, its field of view is horizontal;
 - `-gain` brightens shadows to look like multiple scattering, and its default is not 0;
 - `-cutoff` ends rays at that squared transmittance, and its default of 0.005 is visible in thick media;
 - a ray goes through the middle of a pixel, always: larger pictures, averaged, stand for more samples.
"""

import json
import math
import re
import shutil
import subprocess
import time
from pathlib import Path

from . import exr
from .peers import NotWithinMeans, errors, half_voxels
from .report import FIELDS, ReportError, Run

# Steps in voxels along the camera's and along the shadow ray: the program's own, and finer ones, since the
# optical depth of its shadow rays is short by about half a step.
STEPS = ((1.0, 3.0), (1.0, 1.0), (0.5, 0.25))
CUTOFF = 1e-6
# A picture this many times as wide and high, averaged.
SUPERSAMPLING = (1, 2, 3, 4, 6, 8, 12, 16)


def the_light(settings):
    """The only light that shines."""
    power = {"distant": "irradiance", "environment": "radiance"}
    lights = [light for light in settings["light"] if max(light[power.get(light["type"], "intensity")]) > 0]
    if len(lights) != 1 or lights[0]["type"] != "distant" or lights[0]["angular_radius"] > 0:
        raise NotWithinMeans("its light is one distant light without a disc")
    return lights[0]


def check(settings):
    """Raises NotWithinMeans unless the program can show the scene as it is."""
    if settings["render"]["max_bounces"] != 1:
        raise NotWithinMeans("it has single scattering only (render.max_bounces = 1)")
    if len(settings["volume"]) != 1:
        raise NotWithinMeans("it shows one volume")
    volume, = settings["volume"]
    phase = volume["phase"]
    if phase["type"] != "isotropic" and (phase["type"] != "henyey_greenstein" or phase["g"] != 0):
        raise NotWithinMeans("it scatters isotropically only")
    if volume["transform"] != [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]:
        raise NotWithinMeans("a transformed volume")
    the_light(settings)


def triple(values):
    return ",".join(f"{value:.9g}" for value in values)


def command(settings, voxel, image, steps, supersampling, threads):
    """The command line for a scene within the program's means, whose cubic voxels are `voxel` world units
    wide."""
    camera, size, volume = settings["camera"], settings["image"], settings["volume"][0]
    light = the_light(settings)
    extinction = [volume["extinction"] * scale * voxel for scale in volume["extinction_scale"]]
    scattering = [e * albedo for e, albedo in zip(extinction, volume["albedo"])]
    absorption = [e - s for e, s in zip(extinction, scattering)]
    half_height = math.tan(math.radians(camera["fov"]) / 2)
    fov = 2 * math.degrees(math.atan(half_height * size["width"] / size["height"]))
    to_light = [-x for x in light["direction"]]
    radiance = [e / (4 * math.pi) for e in light["irradiance"]]
    return ["vdb_render", volume["file"], str(image), "-name", volume["density"],
            "-res", f"{size['width'] * supersampling}x{size['height'] * supersampling}",
            "-translate", triple(camera["position"]), "-lookat", triple(camera["look_at"]),
            "-up", triple(camera["up"]), "-fov", f"{fov:.9g}",
            "-absorb", triple(absorption), "-scatter", triple(scattering),
            "-gain", "0", "-cutoff", f"{CUTOFF:g}", "-light", triple(to_light + radiance),
            "-step", f"{steps[0]:g}", "-shadowstep", f"{steps[1]:g}", "-cpus", str(threads)]


def averaged(image, times):
    """Every times x times pixels as one."""
    height, width, channels = image.shape
    return image.reshape(height // times, times, width // times, times, channels).mean((1, 3))


def version():
    text = subprocess.run(["vdb_render", "-version"], capture_output=True, text=True, check=False)
    found = re.search(r"\d+\.\d+\.\d+", text.stdout + text.stderr)
    return found.group() if found else "of unknown version"


def run_vdb_render(binary, scene, settings, references, _, seconds, threads, folder):
    """A run per pair of steps, whose `passes` are images with more and more samples per pixel, as long as
    the time allows. It draws no random numbers: one run stands for all seeds.
    Raises NotWithinMeans."""
    if shutil.which("vdb_render") is None:
        raise NotWithinMeans("it is not installed (Debian: libopenvdb-tools)")
    check(settings)
    halves = half_voxels(binary, settings["volume"][0])
    if max(halves) - min(halves) > 1e-6 * max(halves):
        raise NotWithinMeans("voxels that are no cubes")
    truth = [exr.read_rgb(reference) for reference in references]
    runs = []
    for steps in STEPS:
        name = f"vdb_render_step{steps[0]:g}_{steps[1]:g}".replace(".", "_")
        run = Run(scene, name, 1)
        stem = folder / f"{scene}.{name}.1"
        for times in SUPERSAMPLING:
            previous = SUPERSAMPLING[SUPERSAMPLING.index(times) - 1]
            if run.passes and run.passes[-1]["seconds"] * (times / previous) ** 2 > seconds:
                break
            print(f"{scene}: {name}, {times * times} samples per pixel", flush=True)
            job = command(settings, 2 * halves[0], f"{stem}.full.exr", steps, times, threads)
            start = time.monotonic()
            result = subprocess.run(job, capture_output=True, text=True, check=False)
            taken = time.monotonic() - start
            if result.returncode != 0 or not Path(f"{stem}.full.exr").exists():
                last = (result.stderr.strip() or result.stdout.strip()).splitlines()[-1:]
                raise ReportError(f"vdb_render: {last[0] if last else 'no message'}")
            image = averaged(exr.read_rgb(f"{stem}.full.exr"), times)
            Path(f"{stem}.full.exr").unlink()
            exr.write_rgb(f"{stem}.exr", image)
            entry = dict.fromkeys(FIELDS, float("nan"))
            entry.update(errors(image, truth), seconds=taken)
            entry["pass"] = len(run.passes) + 1
            run.passes.append(entry)
        report = {"settings": {"renderer": f"vdb_render, OpenVDB {version()}", "command": job},
                  "passes": run.passes}
        Path(f"{stem}.json").write_text(json.dumps(report), encoding="utf-8")
        runs.append(run)
    return runs
