#!/usr/bin/env python3
"""A sequence on a real Slurm: an array of split frames, one task requeued, all of it merged.

Skipped where this machine cannot run Slurm, unless VDBEAM_REQUIRE names slurm.
"""
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time

from slurm_sandbox import CannotRun, SlurmSandbox

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
from requirements import skip

VDBEAM = os.environ["VDBEAM_BINARY"]
DATA = pathlib.Path(__file__).parents[2] / "data"
FRAMES = range(1, 13)
PATIENCE = 600  # seconds for all tasks, on a machine that is busy with other tests
RENDER = ["--passes=8", "--resolution=48x64", "--set=render.photons=4000", "--threads=1"]


def check(condition, text):
    if not condition:
        raise AssertionError(text)


def vdbeam(*words):
    result = subprocess.run([VDBEAM, *words], capture_output=True, text=True, check=False)
    check(result.returncode == 0, f"vdbeam {words}: {result.stderr}")


def pixels(path):
    """The compressed pixels of an EXR of scan lines: all that follows its header and offsets."""
    data = path.read_bytes()
    check(data[:4] == b"\x76\x2f\x31\x01", f"{path} is no EXR")
    place = 8
    while data[place]:
        name_end = data.index(b"\0", place)
        type_end = data.index(b"\0", name_end + 1)
        size, = struct.unpack_from("<i", data, type_end + 1)
        place = type_end + 5 + size
    first_chunk, = struct.unpack_from("<Q", data, place + 1)
    return data[first_chunk:]


def make_scene(folder):
    scene = folder / "smoke.toml"
    text = (DATA / "smoke.toml").read_text()
    scene.write_text(text.replace('"smoke/', f'"{DATA}/smoke/'))
    return scene


def jobs(slurm):
    """Every task as Slurm knows it: a dictionary of its fields."""
    lines = slurm.output("scontrol", "-o", "show", "job").splitlines()
    return [dict(re.findall(r"(\w+)=(\S*)", line)) for line in lines if "JobId=" in line]


def running(slurm):
    """Numbers of the tasks that run."""
    return [job["JobId"] for job in jobs(slurm) if job["JobState"] == "RUNNING"]


def requeue_one(slurm):
    """Requeues a task that runs, and returns its number."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        started = running(slurm)
        # Slurm drains a node on which a task is requeued before it has come to be.
        time.sleep(0.3)
        for task in running(slurm):
            if task in started and slurm.run("scontrol", "requeue", task).returncode == 0:
                return task
    raise AssertionError("no task came to run")


def wait_for_end(slurm):
    end = time.monotonic() + PATIENCE
    while waiting := slurm.output("squeue", "-h", "-o", "%i %T %r"):
        check(time.monotonic() < end, f"still in the queue after {PATIENCE} s:\n{waiting}")
        if "held" in waiting:  # it was started anew before its former run had ended, and failed
            slurm.run("scontrol", "update", "NodeName=localhost", "State=RESUME")
            for task in [line.split()[0] for line in waiting.splitlines() if "held" in line]:
                slurm.run("scontrol", "release", task)
        time.sleep(0.2)


def logs(folder):
    return "".join(f"\n--- {path.name}\n{path.read_text()}" for path in sorted(folder.glob("*.log")))


def check_images(farm, local):
    for frame in FRAMES:
        name = f"smoke.{frame:04}.exr"
        check((farm / name).exists(), f"{name} is missing{logs(farm)}")
        check(pixels(farm / name) == pixels(local / name), f"{name} differs from a local run")
    left = sorted(p.name for p in farm.iterdir() if p.suffix != ".log")
    check(left == [f"smoke.{frame:04}.exr" for frame in FRAMES], f"left over: {left}")


def run_job(slurm, folder):
    scene = make_scene(folder)
    farm, local = folder / "farm", folder / "local"
    for path in (farm, local):
        path.mkdir()
    script = folder / "job.sh"
    frames = f"{FRAMES[0]}-{FRAMES[-1]}"
    vdbeam("farm", "slurm", str(scene), "-f", frames, "-o", str(farm / "smoke.####.exr"), *RENDER,
           "--splits", "2", "--memory", "256", "--checkpoint", "1s", "--program", VDBEAM, "--job",
           str(script))
    submitted = slurm.run("bash", str(script))
    check(submitted.returncode == 0, f"submission failed: {submitted.stderr}")
    number = requeue_one(slurm)
    vdbeam("render", str(scene), "-f", frames, "-o", str(local / "smoke.####.exr"), *RENDER, "-q")
    wait_for_end(slurm)
    everything = jobs(slurm)
    check(len(everything) == 3 * len(FRAMES), f"{len(everything)} tasks ran")
    for job in everything:
        check(job["JobState"] == "COMPLETED", f"task {job['JobId']}: {job}{logs(farm)}")
    # Once, or more often where Slurm failed to start it anew (wait_for_end).
    restarted = [job["JobId"] for job in everything if job["Restarts"] != "0"]
    check(restarted == [number], f"restarted: {restarted}, and not {number} alone")
    check_images(farm, local)


def main():
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="vdbeam_slurm_") as name:
        cluster, work = pathlib.Path(name) / "cluster", pathlib.Path(name) / "shot 1"
        pathlib.Path(name).chmod(0o755)
        cluster.mkdir()
        work.mkdir()
        try:
            with SlurmSandbox(cluster) as slurm:
                started = time.monotonic()
                run_job(slurm, work)
        except CannotRun as reason:
            skip("slurm", reason)
    print(f"Slurm was up after {started - begin:.1f} s; {len(FRAMES)} frames in 2 parts each, one "
          f"requeued, merged and equal to a local run after {time.monotonic() - started:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
