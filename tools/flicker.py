#!/usr/bin/env python3
"""Measures how much a sequence flickers: its temporal error under each seed and radius policy.

A reference of every frame is rendered by the path estimator with numbers of its own, unless its
files are there. Then the frames are rendered with each combination of render.seeds (per_frame,
correlated) and of the settings in --variant, for several seeds, and compared by `vdbeam compare -f`.
The result is a table in Markdown: MRSE, temporal error (`vdbeam compare --help` defines it), their
ratio (temporal / (2 MRSE): 1 where the frames' errors are independent), bias, measures of jumps, and
processor seconds. A jump shows as a temporal error of one pair of frames far above the median of all
(`worst pair`), or as a mean brightness that changes otherwise than the reference's (`brightness jump`).

    tools/flicker.py smoke.toml -f 1-24 --resolution 48x64 --passes 8 \\
        --variant adaptive:render.kernel=adaptive \\
        --variant fixed:render.kernel=fixed,render.radius=0.14
"""

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
POLICIES = ("per_frame", "correlated")


def vdbeam(options, *words):
    result = subprocess.run([options.binary, *words], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"vdbeam {' '.join(words)}: {result.stderr.strip()}")
    return result.stdout


def render(options, output, *words):
    vdbeam(options, "render", options.scene, f"--frames={options.frames}", "-o", output,
           "--resolution", options.resolution, "-q", *words)


def settings(variant):
    """NAME:key=value,key=value as the name and words for the command line."""
    name, _, entries = variant.partition(":")
    words = [word for entry in entries.split(",") if entry for word in ("--set", entry)]
    return name, words


def processor_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def jumps(frames):
    """For one seed's frames: the worst pair's temporal error over the median, and the largest change of
    the bias from one frame to the next."""
    temporal = [frame["temporal"] for frame in frames[1:]]
    changes = [abs(b["bias"] - a["bias"]) for a, b in zip(frames, frames[1:])]
    return max(temporal) / statistics.median(temporal), max(changes)


def measure(options, folder, reference, policy, words):
    """Means over the seeds; of jumps the largest."""
    sums, begin = {}, processor_seconds()
    for seed in range(1, options.seeds + 1):
        image = f"{folder}/{seed}.####.exr"
        render(options, image, "--passes", str(options.passes), "--seed", str(seed),
               "--set", f"render.seeds={policy}", *words)
    seconds = (processor_seconds() - begin) / options.seeds
    for seed in range(1, options.seeds + 1):
        result = json.loads(vdbeam(options, "compare", f"{folder}/{seed}.####.exr", reference,
                                   f"--frames={options.frames}", "--json"))
        for key in ("mrse", "temporal", "bias"):
            sums[key] = sums.get(key, 0) + result[key] / options.seeds
        worst, jump = jumps(result["frames"])
        sums["worst"] = max(sums.get("worst", 0), worst)
        sums["jump"] = max(sums.get("jump", 0), jump)
    return {**sums, "seconds": seconds}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("-f", "--frames", required=True)
    parser.add_argument("--binary", default=os.environ.get(
        "VDBEAM_BINARY", str(ROOT / "build/release/vdbeam")))
    parser.add_argument("--variant", action="append", metavar="NAME:KEY=VALUE,...")
    parser.add_argument("--passes", type=int, default=8)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--resolution", default="48x64")
    parser.add_argument("--reference", help="folder of the reference's frames; made where absent")
    parser.add_argument("--reference-passes", type=int, default=2048)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="vdbeam_flicker_") as name:
        folder = Path(options.reference or f"{name}/reference")
        folder.mkdir(parents=True, exist_ok=True)
        reference = f"{folder}/ref.####.exr"
        render(options, reference, "--estimator", "path", "--passes", str(options.reference_passes),
               "--seed", "77", "--set", "render.seeds=per_frame", "--skip-existing")
        print("| setting | seeds | MRSE | temporal error | ratio | bias | worst pair / median | "
              "brightness jump | processor seconds |\n|---|---|---|---|---|---|---|---|---|")
        for number, variant in enumerate(options.variant or ["default:"]):
            label, words = settings(variant)
            for policy in POLICIES:
                place = Path(name) / f"{number}_{policy}"
                place.mkdir()
                r = measure(options, place, reference, policy, words)
                print(f"| {label} | {policy} | {r['mrse']:.2e} | {r['temporal']:.2e} | "
                      f"{r['temporal'] / (2 * r['mrse']):.2f} | {100 * r['bias']:+.2f} % | "
                      f"{r['worst']:.1f} | {100 * r['jump']:.2f} % | "
                      f"{r['seconds']:.1f} |", flush=True)


if __name__ == "__main__":
    main()
