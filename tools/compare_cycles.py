#!/usr/bin/python3
"""Compares vdbeam with Blender's Cycles on the same scene, region by region.

The scene is built in Blender from the settings in vdbeam's report (volumes, meshes, materials, lights), both
render it with the same number of seeds, and a table in Markdown is printed: the mean of each region by both,
Cycles' difference, and its standard error over the seeds. Images stay in the output folder.

    tools/compare_cycles.py data/cloud_over_ground.toml --passes 64 --samples 256 --seeds 4
    tools/compare_cycles.py data/glass_in_fog.toml --resolution 160x90 --regions 4x3 --samples 1024 \\
        --set mesh.0.material.solid=false --set mesh.1.scale=0.4
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("scene", type=Path)
    add("-o", "--output", type=Path, default=Path("out/cycles"), help="folder of images (%(default)s)")
    add("--binary", type=Path, default=ROOT / "build/release/vdbeam")
    add("--estimator", default="auto", help="vdbeam's (%(default)s)")
    add("--passes", type=int, default=64, help="of vdbeam per seed (%(default)s)")
    add("--samples", type=int, default=256, help="of Cycles per pixel and seed (%(default)s)")
    add("--step-rate", type=float, default=0.1, help="Cycles' steps in voxels (%(default)s)")
    add("--seeds", type=int, default=4, help="renders of each (%(default)s)")
    add("--threads", type=int, default=2)
    add("--resolution", default="160x90")
    add("--regions", default="4x3", help="columns and rows (%(default)s)")
    add("--set", action="append", default=[], metavar="KEY=VALUE", help="of both scenes; may be repeated")
    return parser.parse_args(arguments)


def render_vdbeam(options, seed):
    """The image and the report."""
    stem = options.output / f"{options.scene.stem}.vdbeam.{seed}"
    report = Path(f"{stem}.json")
    words = [options.binary, "render", options.scene, "-o", f"{stem}.exr", "--report", report, "--overwrite",
             "--estimator", options.estimator, "--passes", str(options.passes), "--seed", str(seed),
             "--threads", str(options.threads), "--resolution", options.resolution]
    for pair in options.set:
        words += ["--set", pair]
    result = subprocess.run(words, capture_output=True, text=True, check=False)
    if result.returncode:
        sys.exit(f"compare_cycles.py: {result.stderr.strip()}")
    return f"{stem}.exr", json.loads(report.read_text(encoding="utf-8"))


def region_means(image, columns, rows):
    """Mean over the channels of each region, row by row from the top."""
    import numpy as np

    return np.array([part.mean() for band in np.array_split(image, rows, axis=0)
                     for part in np.array_split(band, columns, axis=1)])


def table(ours, theirs, columns):
    """A row per region of the renders' means, which are rows of the two arrays."""
    import numpy as np

    lines = ["| row, column | vdbeam | Cycles | Cycles / vdbeam - 1 | standard error |", "|---|---|---|---|---|"]
    mine, other = ours.mean(axis=0), theirs.mean(axis=0)
    spread = np.sqrt(ours.var(axis=0, ddof=1) / len(ours) + theirs.var(axis=0, ddof=1) / len(theirs))
    for i, (a, b, error) in enumerate(zip(mine, other, spread)):
        lines.append(f"| {i // columns + 1}, {i % columns + 1} | {a:.5f} | {b:.5f} | {100 * (b / a - 1):+.2f} % "
                     f"| {100 * error / a:.2f} % |")
    lines.append(f"| all | {mine.mean():.5f} | {other.mean():.5f} | {100 * (other.mean() / mine.mean() - 1):+.2f} % | "
                 f"{100 * np.sqrt((spread ** 2).sum()) / mine.sum():.2f} % |")
    return "\n".join(lines)


def main(arguments=None):
    options = parse_arguments(arguments)
    try:
        import numpy as np

        from error_curves import exr, peers
    except ModuleNotFoundError as problem:
        return f"compare_cycles.py: Python's {problem.name} is needed: apt-get install python3-{problem.name}"
    columns, rows = (int(x) for x in options.regions.split("x"))
    options.output.mkdir(parents=True, exist_ok=True)
    ours, theirs, seconds = [], [], [0.0, 0.0]
    try:
        for seed in range(1, options.seeds + 1):
            image, report = render_vdbeam(options, seed)
            ours.append(region_means(exr.read_rgb(image), columns, rows))
            seconds[0] += report["seconds"]["render"] if "render" in report["seconds"] else 0
            stem = options.output / f"{options.scene.stem}.cycles.{seed}"
            job = peers.cycles_job(options.binary, report["settings"], stem)
            outcome = peers.render_cycles(job, stem, samples=options.samples, seed=seed, threads=options.threads,
                                          step_rate=options.step_rate)
            seconds[1] += outcome["seconds"]
            theirs.append(region_means(exr.read_rgb(f"{stem}.exr"), columns, rows))
    except (peers.NotWithinMeans, peers.ReportError) as reason:
        return f"compare_cycles.py: {options.scene}: {reason}"
    print(table(np.array(ours), np.array(theirs), columns))
    print(f"\nvdbeam {seconds[0]:.1f} s, Cycles (Blender {outcome['version']}) {seconds[1]:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
