"""Other renderers on the same scenes, as runs like vdbeam's own: equal time, same metric, same reference."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np

from . import exr
from .report import FIELDS, ReportError, Run

CYCLES_SCENE = Path(__file__).with_name("cycles_scene.py")
# A step of one voxel is 5 to 10 % too bright where voxels are optically thick.
STEP_RATES = (1.0, 0.25)
SKIES = {"sky": ("type", "radiance", "zenith", "horizon", "ground"),
         "environment": ("type", "radiance", "image", "rotation")}  # and the keys of their look


class NotWithinMeans(Exception):
    """A scene that a renderer cannot show, with the reason."""


def errors(image, references):
    """The metrics of docs/theory/error-estimate.md that curves need, free of the references' noise where there are two."""
    truth = sum(references) / len(references)
    products = (image - references[0]) * (image - references[-1])
    return {"rmse": float(np.sqrt(max(0, products.mean()))),
            "mrse": float((products / (truth + 0.01) ** 2).mean()),
            "bias": float(image.mean() / truth.mean() - 1)}


def check_for_cycles(settings):
    """Raises NotWithinMeans unless the scene can be built in Blender as it is."""
    if settings["render"]["max_bounces"] is not None:
        raise NotWithinMeans("a limit of bounces")
    for volume in settings.get("volume", []):
        if volume["phase"]["type"] not in ("isotropic", "henyey_greenstein"):
            raise NotWithinMeans(f"phase function {volume['phase']['type']}")
        if volume["extinction_scale"] != [1, 1, 1]:
            raise NotWithinMeans("chromatic extinction")
    for mesh, material in zip(settings.get("mesh", []), settings.get("mesh.material", [])):
        check_surface(mesh, material)
    skies = [light for light in settings.get("light", []) if light["type"] in SKIES]
    if len({light["visible"] for light in skies}) > 1:
        raise NotWithinMeans("skies that the camera sees")
    for light in settings.get("light", []):
        if light["type"] not in ("distant", "point", *SKIES):
            raise NotWithinMeans(f"a light of type {light['type']}")


def check_surface(mesh, material):
    if mesh["type"] == "file" and Path(mesh["file"]).suffix.lower() not in (".obj", ".ply"):
        raise NotWithinMeans(f"the mesh {mesh['file']}")
    if material["type"] in ("holdout", "shadow_catcher"):
        raise NotWithinMeans(f"the material {material['type']}")
    if material.get("texture") and material["texture_wrap"] == "mirror":
        raise NotWithinMeans("a mirrored texture")
    if material["type"] == "dielectric" and (material["solid"] or max(material["absorption"]) > 0):
        raise NotWithinMeans("glass without medium inside (material.solid, material.absorption)")


def half_voxels(binary, volume):
    """Half a voxel along each axis in world units, as `vdbeam info` has it."""
    text = subprocess.run([binary, "info", volume["file"]], capture_output=True, text=True,
                          check=False).stdout
    found = re.search(r"voxel (\S+) x (\S+) x (\S+)", text)
    if not found:
        raise ReportError(f"{volume['file']}: vdbeam info prints no voxel size")
    return [float(size) / 2 for size in found.groups()]


def _toml(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    return json.dumps(value)  # of numbers, texts and lists they are the same


def render_sky(binary, settings, stem):
    """All that surrounds the scene as a lat-long EXR; its path, the direction of its middle, and
    whether the camera sees it. The path is None where nothing does."""
    skies = [light for light in settings.get("light", []) if light["type"] in SKIES]
    if not skies:
        return None, None, True
    up = np.array(settings["camera"]["up"], dtype=float)
    front = np.cross(up, [1.0, 0, 0] if abs(up[0]) < 0.9 * np.linalg.norm(up) else [0, 1.0, 0])
    text = "[image]\nwidth = 1024\nheight = 512\n[camera]\nprojection = \"panorama\"\nposition = [0, 0, 0]\n"
    text += f"look_at = {_toml(front.tolist())}\nup = {_toml(up.tolist())}\n"
    text += "[render]\nestimator = \"path\"\npasses = 16\n"
    for light in skies:
        text += "[[light]]\n" + "".join(f"{key} = {_toml(light[key])}\n" for key in SKIES[light["type"]])
    scene, image = Path(f"{stem}.sky.toml"), Path(f"{stem}.sky.exr")
    scene.write_text(text, encoding="utf-8")
    result = subprocess.run([binary, "render", scene, "-o", image], capture_output=True, text=True, check=False)
    if result.returncode:
        raise ReportError(f"the sky of Cycles' scene: {result.stderr.strip()}")
    return str(image.resolve()), front.tolist(), skies[0]["visible"]


def cycles_job(binary, settings, stem):
    """What all of Cycles' renders of a scene have in common. Raises NotWithinMeans."""
    if shutil.which("blender") is None:
        raise NotWithinMeans("blender is not installed")
    check_for_cycles(settings)
    sky, front, visible = render_sky(binary, settings, stem)
    return {"settings": settings, "sky": sky, "sky_front": front, "sky_visible": visible,
            "half_voxels": [half_voxels(binary, volume) for volume in settings.get("volume", [])]}


def render_cycles(job, stem, limit=None, **how):
    """Renders `stem`.exr; `how`: seconds or samples, threads, seed, step_rate. Blender's messages about it. After `limit`
    seconds subprocess.TimeoutExpired is raised."""
    job = {"seconds": 0, "samples": 0, **job, **how, "image": str(Path(f"{stem}.exr").resolve()),
           "result": f"{stem}.blender.json"}
    job_file = Path(f"{stem}.job.json")
    job_file.write_text(json.dumps(job), encoding="utf-8")
    result = subprocess.run(["blender", "--background", "--factory-startup", "--python", CYCLES_SCENE, "--",
                             job_file], capture_output=True, text=True, check=False, timeout=limit)
    if not Path(job["result"]).exists():
        lines = (result.stdout + result.stderr).splitlines()
        errors_told = [line for line in lines if "Error:" in line] or lines or ["no message"]
        raise ReportError(f"blender: {errors_told[-1]}")
    outcome = json.loads(Path(job["result"]).read_text(encoding="utf-8"))
    Path(job["result"]).unlink()
    return {**outcome, "job": job}


def run_cycles(binary, scene, settings, references, seeds, seconds, threads, folder):
    """A run per step rate and seed, whose `passes` are renders of a quarter, half and all of the
    time, one after another in turn. Raises NotWithinMeans."""
    job = cycles_job(binary, settings, folder / f"{scene}.cycles")
    truth = [exr.read_rgb(reference) for reference in references]
    runs = []
    for seed in seeds:
        for rate in STEP_RATES:
            name = f"cycles_step{rate:g}".replace(".", "_")
            run = Run(scene, name, seed)
            stem = folder / f"{scene}.{name}.{seed}"
            for i, share in enumerate((0.25, 0.5, 1)):
                print(f"{scene}: {name}, seed {seed}, {share * seconds:g} s", flush=True)
                outcome = render_cycles(job, stem, seconds=share * seconds, threads=threads, seed=seed,
                                        step_rate=rate)
                entry = dict.fromkeys(FIELDS, float("nan"))
                entry.update(errors(exr.read_rgb(f"{stem}.exr"), truth), seconds=outcome["seconds"])
                entry["pass"] = i + 1
                run.passes.append(entry)
            report = {"settings": {"renderer": f"Cycles, Blender {outcome['version']}", **outcome["job"]},
                      "passes": run.passes}
            Path(f"{stem}.json").write_text(json.dumps(report), encoding="utf-8")
            runs.append(run)
    return runs
