"""Runs `vdbeam render` and keeps reference images."""

import hashlib
import json
import re
import shlex
import subprocess
from dataclasses import dataclass
from pathlib import Path

from .report import ReportError, read_report

# No curve is drawn with this seed, so that no image shares its noise with its reference.
REFERENCE_SEED = 999983
# A render ends at the first limit met: more passes than any time budget has.
MANY_PASSES = 10_000_000


class RenderFailed(Exception):
    """A render that did not end well, as one line."""


@dataclass(frozen=True)
class Variant:
    """One way to render, compared with the others: a name and options of `vdbeam render`."""

    name: str
    options: tuple = ()


def parse_variant(text):
    """'k200: --estimator beam --set render.neighbours=200' or the name of an estimator alone."""
    name, colon, options = text.partition(":")
    name = name.strip()
    if not re.fullmatch(r"[A-Za-z0-9_=,-]+", name):
        raise ValueError(f"'{name}' is no name for a file")
    return Variant(name, tuple(shlex.split(options)) if colon else ("--estimator", name))


def render(binary, scene, output, report, variant, seed, seconds, references=(), extra=()):
    """Renders for a number of seconds; the report goes to `report`, and errors against one or two references."""
    command = [str(binary), "render", str(scene), "-o", str(output), "--report", str(report),
               "--seed", str(seed), "--time", f"{seconds:g}s", "--passes", str(MANY_PASSES),
               *variant.options, *extra]
    for option, reference in zip(("--reference", "--second-reference"), references):
        command += [option, str(reference)]
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
        render(binary, scene, image, report, parse_variant("path"), REFERENCE_SEED, seconds,
               extra=extra)
    return image, report


def reference_noise(report):
    """The MRSE that a reference's own noise adds, from its report; None if unknown."""
    try:
        estimate = json.loads(Path(report).read_text(encoding="utf-8"))["passes"][-1]
        return float(estimate["error_estimate"])
    except (OSError, ValueError, KeyError, IndexError, TypeError):
        return None


def run_all(binary, scenes, references, variants, seeds, seconds, folder, extra=()):
    """Every scene, variant and seed. The variants take turns within a seed, and each seed begins
    with another one, so that a machine that gets slower or hotter is unfair to none."""
    folder.mkdir(parents=True, exist_ok=True)
    runs = []
    for scene in scenes:
        stem = Path(scene).stem
        for turn, seed in enumerate(seeds):
            first = turn % len(variants)
            for variant in variants[first:] + variants[:first]:
                print(f"{scene}: {variant.name}, seed {seed}, {seconds:g} s", flush=True)
                output = folder / f"{stem}.{variant.name}.{seed}.exr"
                report = output.with_suffix(".json")
                render(binary, scene, output, report, variant, seed, seconds, references[stem],
                       extra)
                runs.append(read_report(report, stem, variant.name, seed))
    order = [variant.name for variant in variants]
    return sorted(runs, key=lambda run: order.index(run.estimator))


__all__ = ["ReportError", "RenderFailed", "Variant", "cached_reference", "parse_variant",
           "reference_noise", "render", "run_all"]
