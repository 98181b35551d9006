#!/usr/bin/python3
"""Error against processor time: vdbeam beside Blender's Cycles on the same scene.

Renders the scene with vdbeam at several counts of passes and with Cycles at several counts of samples and steps, and
prints a table in Markdown: processor seconds, MRSE, MRSE times seconds, and the bias of the mean. Processor seconds are
user and system time of all threads: of vdbeam's whole process, of Cycles from the call that renders (so not of Blender's
start). The MRSE is the mean product of a picture's differences to two independent references, whose own noise thereby
drops out:

    mean((v - a) (v - b) / ((a + b) / 2 + 0.01)^2)

    vdbeam render data/cloud.toml --estimator path --passes 200 --seed 101 --resolution 240x135 -o a.exr   # and 102, b
    tools/cycles_curve.py data/cloud.toml --references a.exr b.exr --resolution 240x135
"""

import argparse
import json
import resource
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def numbers(kind):
    return lambda text: [kind(x) for x in text.split(",")]


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("scene", type=Path)
    add("--references", nargs=2, required=True, type=Path, metavar="FILE.exr", help="two with different seeds")
    add("--passes", type=numbers(int), default="2,8,32", help="of vdbeam (%(default)s)")
    add("--samples", type=numbers(int), default="4,16,64", help="of Cycles per pixel (%(default)s)")
    add("--step-rates", type=numbers(float), default="1,0.25", help="Cycles' steps in voxels (%(default)s)")
    add("--estimator", default="auto", help="vdbeam's (%(default)s)")
    add("--seeds", type=int, default=1, help="renders of each; their errors are averaged (%(default)s)")
    add("--resolution", default="240x135")
    add("--threads", type=int, default=2)
    add("--limit", type=float, default=600, help="seconds that one render may take (%(default)s)")
    add("--set", action="append", default=[], metavar="KEY=VALUE", help="of both scenes; may be repeated")
    add("-o", "--output", type=Path, default=Path("out/cycles_curve"), help="folder of images (%(default)s)")
    add("--binary", type=Path, default=ROOT / "build/release/vdbeam")
    return parser.parse_args(arguments)


def processor_seconds_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def render_vdbeam(options, passes, seed):
    """The image, the report, and processor seconds."""
    stem = options.output / f"{options.scene.stem}.vdbeam.{passes}.{seed}"
    words = [options.binary, "render", options.scene, "-o", f"{stem}.exr", "--report", f"{stem}.json", "--overwrite",
             "--estimator", options.estimator, "--passes", str(passes), "--seed", str(seed),
             "--threads", str(options.threads), "--resolution", options.resolution]
    for pair in options.set:
        words += ["--set", pair]
    before = processor_seconds_of_children()
    result = subprocess.run(words, capture_output=True, text=True, check=False, timeout=options.limit)
    if result.returncode:
        sys.exit(f"cycles_curve.py: {result.stderr.strip()}")
    seconds = processor_seconds_of_children() - before
    return f"{stem}.exr", json.loads(Path(f"{stem}.json").read_text(encoding="utf-8")), seconds


def error(image, references):
    """MRSE without the references' noise, and the bias of the mean."""
    a, b = references
    truth = (a + b) / 2
    return float(((image - a) * (image - b) / (truth + 0.01) ** 2).mean()), float(image.mean() / truth.mean() - 1)


def row(name, work, results):
    """Row of one renderer's (seconds, MRSE, bias) for each seed."""
    seconds, mrse, bias = (sum(column) / len(results) for column in zip(*results))
    return f"| {name} | {work} | {seconds:.1f} | {mrse:.2g} | {mrse * seconds:.2g} | {100 * bias:+.2f} % |"


def main(arguments=None):
    options = parse_arguments(arguments)
    try:
        from error_curves import exr, peers
    except ModuleNotFoundError as problem:
        return f"cycles_curve.py: Python's {problem.name} is needed: apt-get install python3-{problem.name}"
    seeds = range(1, options.seeds + 1)
    options.output.mkdir(parents=True, exist_ok=True)
    print("| renderer | work | processor s | MRSE | MRSE x s | bias |\n|---|---|---|---|---|---|", flush=True)
    try:
        references = [exr.read_rgb(path) for path in options.references]
        report = None
        for passes in options.passes:
            results = []
            for seed in seeds:
                image, report, seconds = render_vdbeam(options, passes, seed)
                results.append((seconds, *error(exr.read_rgb(image), references)))
            print(row(f"vdbeam, {options.estimator}", f"{passes} passes", results), flush=True)
        stem = options.output / f"{options.scene.stem}.cycles"
        job = peers.cycles_job(options.binary, report["settings"], stem)
        for rate in options.step_rates:
            for samples in options.samples:
                results = []
                for seed in seeds:
                    outcome = peers.render_cycles(job, f"{stem}.{rate:g}.{samples}.{seed}", samples=samples, seed=seed,
                                                  threads=options.threads, step_rate=rate, limit=options.limit)
                    image = exr.read_rgb(outcome["job"]["image"])
                    results.append((outcome["processor_seconds"], *error(image, references)))
                print(row(f"Cycles, steps of {rate:g}", f"{samples} samples", results), flush=True)
    except subprocess.TimeoutExpired:
        return f"cycles_curve.py: a render took more than {options.limit:g} s (--limit)"
    except (peers.NotWithinMeans, peers.ReportError) as reason:
        return f"cycles_curve.py: {options.scene}: {reason}"
    return 0


if __name__ == "__main__":
    sys.exit(main())
