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


class NotWithinMeans(Exception):
    """A scene that a renderer cannot show, with the reason."""


def errors(image, reference):
    """The metrics of docs/physics.md that curves need."""
    difference = image - reference
    return {"rmse": float(np.sqrt(np.mean(difference**2))),
            "mrse": float(np.mean((difference / (reference + 0.01)) ** 2)),
            "bias": float(image.mean() / reference.mean() - 1)}


def check_for_cycles(settings):
    """Raises NotWithinMeans unless the scene can be built in Blender as it is."""
    if settings["render"]["max_bounces"] is not None:
        raise NotWithinMeans("a limit of bounces")
    for volume in settings["volume"]:
        if volume["phase"]["type"] not in ("isotropic", "henyey_greenstein"):
            raise NotWithinMeans(f"phase function {volume['phase']['type']}")
        if volume["extinction_scale"] != [1, 1, 1]:
            raise NotWithinMeans("chromatic extinction")
        if volume["transform"] != [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]:
            raise NotWithinMeans("a transformed volume")
    for light in settings["light"]:
        if light["type"] not in ("distant", "environment") or light.get("image"):
            raise NotWithinMeans(f"a light of type {light['type']}" +
                                 (" with an image" if light.get("image") else ""))


def half_voxels(binary, volume):
    """Half a voxel along each axis in world units, as `vdbeam info` has it."""
    text = subprocess.run([binary, "info", volume["file"]], capture_output=True, text=True,
                          check=False).stdout
    found = re.search(r"voxel (\S+) x (\S+) x (\S+)", text)
    if not found:
        raise ReportError(f"{volume['file']}: vdbeam info tells no voxel size")
    return [float(size) / 2 for size in found.groups()]


def run_cycles(binary, scene, settings, reference, seeds, seconds, threads, folder):
    """A run per step rate and seed, whose `passes` are renders of a quarter, half and all of the
    time, one after another in turn. Raises NotWithinMeans."""
    if shutil.which("blender") is None:
        raise NotWithinMeans("blender is not installed")
    check_for_cycles(settings)
    truth = exr.read_rgb(reference)
    halves = [half_voxels(binary, volume) for volume in settings["volume"]]
    runs = []
    for seed in seeds:
        for rate in STEP_RATES:
            name = f"cycles_step{rate:g}".replace(".", "_")
            run = Run(scene, name, seed)
            for i, share in enumerate((0.25, 0.5, 1)):
                stem = folder / f"{scene}.{name}.{seed}"
                print(f"{scene}: {name}, seed {seed}, {share * seconds:g} s", flush=True)
                job = {"settings": settings, "half_voxels": halves, "seconds": share * seconds,
                       "threads": threads, "seed": seed, "step_rate": rate,
                       "image": f"{stem}.exr", "result": f"{stem}.blender.json"}
                job_file = Path(f"{stem}.job.json")
                job_file.write_text(json.dumps(job), encoding="utf-8")
                result = subprocess.run(["blender", "--background", "--factory-startup", "--python",
                                         CYCLES_SCENE, "--", job_file], capture_output=True,
                                        text=True, check=False)
                if not Path(job["result"]).exists():
                    last = (result.stderr.strip() or result.stdout.strip()).splitlines()[-1:]
                    raise ReportError(f"blender: {last[0] if last else 'no message'}")
                outcome = json.loads(Path(job["result"]).read_text(encoding="utf-8"))
                Path(job["result"]).unlink()
                entry = dict.fromkeys(FIELDS, float("nan"))
                entry.update(errors(exr.read_rgb(job["image"]), truth), seconds=outcome["seconds"])
                entry["pass"] = i + 1
                run.passes.append(entry)
            report = {"settings": {"renderer": f"Cycles, Blender {outcome['version']}", **job},
                      "passes": run.passes}
            Path(f"{stem}.json").write_text(json.dumps(report), encoding="utf-8")
            runs.append(run)
    return runs
