"""Runs `vdbeam render` and keeps reference images."""

import hashlib
import json
import shlex
import subprocess
from pathlib import Path

from .report import ReportError, read_report

# No curve is drawn with this seed, so that no image shares its noise with its reference.
REFERENCE_SEED = 999983
# A render ends at the first limit met: more passes than any time budget has.
MANY_PASSES = 10_000_000


class RenderFailed(Exception):
    """A render that did not end well, as one line."""


def render(binary, scene, output, report, estimator, seed, seconds, reference=None, extra=()):
    """Renders for a number of seconds; the report goes to `report`."""
    command = [str(binary), "render", str(scene), "-o", str(output), "--report", str(report),
               "--estimator", estimator, "--seed", str(seed), "--time", f"{seconds:g}s",
               "--passes", str(MANY_PASSES), *extra]
    if reference is not None:
        command += ["--reference", str(reference)]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        lines = result.stderr.strip().splitlines() or ["no message"]
        raise RenderFailed(f"{shlex.join(command)}: exit status {result.returncode}: {lines[-1]}")


def cached_reference(binary, scene, folder, seconds, extra=()):
    """An image by `path`, rendered once per scene text, settings and quality, and its report."""
    folder.mkdir(parents=True, exist_ok=True)
    key = hashlib.sha256()
    key.update(Path(scene).read_bytes())
    key.update(repr((float(seconds), tuple(extra))).encode())
    stem = folder / f"{Path(scene).stem}.{key.hexdigest()[:16]}"
    # with_suffix would take the key for a suffix.
    image, report = Path(f"{stem}.exr"), Path(f"{stem}.json")
    if not (image.exists() and report.exists()):
        print(f"{scene}: rendering a reference for {seconds:g} s", flush=True)
        render(binary, scene, image, report, "path", REFERENCE_SEED, seconds, extra=extra)
    return image, report


def reference_noise(report):
    """The MRSE that a reference's own noise adds, from its report; None if unknown."""
    try:
        estimate = json.loads(Path(report).read_text(encoding="utf-8"))["passes"][-1]
        return float(estimate["error_estimate"])
    except (OSError, ValueError, KeyError, IndexError, TypeError):
        return None


def run_all(binary, scenes, references, estimators, seeds, seconds, folder, extra=()):
    """Every scene, estimator and seed. The estimators take turns within a seed, so that a machine
    that gets slower is unfair to none."""
    folder.mkdir(parents=True, exist_ok=True)
    runs = []
    for scene in scenes:
        for seed in seeds:
            for estimator in estimators:
                stem = f"{Path(scene).stem}.{estimator}.{seed}"
                print(f"{scene}: {estimator}, seed {seed}, {seconds:g} s", flush=True)
                report = folder / f"{stem}.json"
                render(binary, scene, folder / f"{stem}.exr", report, estimator, seed, seconds,
                       references[Path(scene).stem], extra)
                runs.append(read_report(report, Path(scene).stem, estimator, seed))
    return runs


__all__ = ["ReportError", "RenderFailed", "cached_reference", "reference_noise", "render",
           "run_all"]
