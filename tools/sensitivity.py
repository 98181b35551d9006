#!/usr/bin/python3
"""Measures what the fitted numbers of the method (src/tuning/constants.h) do: each is halved and doubled in turn, and
error (MRSE) times work of the default estimator and of `path` is compared with that of the number as it is. Work is
counted (rays, collisions, photons), not timed, so a busy machine changes nothing. Of the numbers of the error estimate
it is measured how often the stated interval holds the true error, and how wide it is.

It needs the Python module of a build with the CMake option VDBEAM_TUNING, which reads the numbers from the environment.
Prints a line per number; --page writes the tables of docs/developer/tuning.md anew.

Example:
  cmake -S . -B build/tuning -G Ninja -DCMAKE_BUILD_TYPE=Release -DVDBEAM_TUNING=ON && ninja -C build/tuning vdbeam_python
  PYTHONPATH=build/tuning/python tools/sensitivity.py --references out/references --page docs/developer/tuning.md
"""
import argparse
import json
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys

CONSTANTS = pathlib.Path(__file__).resolve().parents[1] / "src" / "tuning" / "constants.h"
SCENES = "cumulus,cloud_over_ground,lamp_in_smoke,fire_over_floor,droplets_over_ground"
FACTORS = "0.5,2"
# The tables follow this line of the page.
MARK = "<!-- The tables below are written by tools/sensitivity.py. -->"
# The section of the header whose numbers change no image.
ERROR_ESTIMATE = "// The error estimate:"


def read_constants(text):
    """[(name, type, value)] of a header's VDBEAM_TUNED lines."""
    found = re.findall(r"VDBEAM_TUNED\(\s*([\w:]+),\s*(\w+),\s*([^)]+)\)", text)
    return [(name, kind, float(eval(value.replace("f", ""), {"__builtins__": {}}))) for kind, name, value in found]


def names_of_error_estimate(text):
    return {name for name, _, _ in read_constants(text.partition(ERROR_ESTIMATE)[2])}


def changed(kind, value, factor):
    """The number times the factor, as its type holds it."""
    return value * factor if kind in ("float", "double") else max(1, round(value * factor))


def measure_here(names, options):
    """{scene: [e of the default estimator, e of path]} with the numbers of this process's environment."""
    import vdbeam

    from scene_suite import measure, scenes
    suite = measure.Suite(vdbeam, options.width, options.reference_passes, options.references)
    known = scenes.all_scenes(vdbeam)
    result = {}
    for name in names:
        result[name] = []
        for estimator, passes in (("auto", options.passes), ("path", options.path_passes)):
            suite.prepare(known[name])
            renders = [suite.error_and_work(known[name], estimator, passes, seed)
                       for seed in range(1, options.seeds + 1)]
            result[name].append(math.prod(sum(values) / options.seeds for values in zip(*renders)))
    return result


def estimates_here(names, options):
    """[holds, estimate over error, width of the interval] of the default estimator, by scene and seed."""
    import vdbeam

    from scene_suite import measure, scenes
    suite = measure.Suite(vdbeam, options.width, options.reference_passes, options.references)
    known = scenes.all_scenes(vdbeam)
    for name in names:
        suite.prepare(known[name])
    return [suite.estimate(known[name], options.passes, seed)
            for name in names for seed in range(1, options.estimate_seeds + 1)]


def measure_with(change, options, what):
    """The same in a process of its own."""
    environment = {**os.environ, "VDBEAM_TUNE": change}
    result = subprocess.run([sys.executable, "-B", __file__, *sys.argv[1:], "--here", what], env=environment, text=True,
                            capture_output=True, check=False)
    if result.returncode:
        sys.exit(f"sensitivity.py: {change}: {result.stderr.strip().splitlines()[-1]}")
    return json.loads(result.stdout)


def ratios(measured, base, estimator):
    """Geometric mean over the scenes, and the worst of them with its name."""
    each = {name: measured[name][estimator] / base[name][estimator] for name in base}
    mean = math.exp(sum(math.log(max(1e-6, value)) for value in each.values()) / len(each))
    worst = max(each, key=lambda name: each[name])
    return mean, worst, each[worst]


def row(name, value, by_factor, base):
    cells = []
    for measured in by_factor:
        mean, worst, most = ratios(measured, base, 0)
        cells += [f"{mean:.2f}", f"{most:.2f} ({worst})", f"{ratios(measured, base, 1)[0]:.2f}"]
    return f"| `{name}` | {value:g} | " + " | ".join(cells) + " |"


def estimate_cells(estimates):
    """Share of intervals that hold, median of estimate over error, median width."""
    held, over_true, widths = zip(*estimates)
    return [f"{sum(held) / len(held):.2f}", f"{statistics.median(over_true):.2f}", f"{statistics.median(widths):.1f}"]


def estimate_table(rows):
    head = ("| number | value | half: holds | stated / true | width | twice: holds | stated / true | width |\n"
            "|---|---|---|---|---|---|---|---|\n")
    return head + "\n".join(rows) + "\n"


def table(rows):
    head = ("| number | value | half: mean | worst scene | `path` | twice: mean | worst scene | `path` |\n"
            "|---|---|---|---|---|---|---|---|\n")
    return head + "\n".join(rows) + "\n"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--numbers", help="names, separated by commas; default: all")
    parser.add_argument("--factors", default=FACTORS, help=f"two factors of each number ({FACTORS})")
    parser.add_argument("--scenes", default=SCENES, help="of tools/scene_suite, separated by commas")
    parser.add_argument("--width", type=int, default=128, help="of the images [pixels] (128)")
    parser.add_argument("--passes", type=int, default=4, help="of the default estimator (4)")
    parser.add_argument("--path-passes", type=int, default=2, help="of path (2)")
    parser.add_argument("--seeds", type=int, default=3, help="renders of each, whose errors are averaged (3)")
    parser.add_argument("--estimate-seeds", type=int, default=8, help="the same for the error estimate (8)")
    parser.add_argument("--reference-passes", type=int, default=64, help="of each reference (64)")
    parser.add_argument("--references", help="folder in which references are kept; default: nowhere")
    parser.add_argument("--page", help="page whose table is written anew")
    parser.add_argument("--here", choices=("work", "estimates"), help=argparse.SUPPRESS)
    return parser.parse_args()


def changes(constant, options, what):
    """What is measured with the number times each factor."""
    name, kind, value = constant
    return [measure_with(f"{name}={changed(kind, value, float(factor))}", options, what) for factor in options.factors.split(",")]


def work_rows(constants, options):
    """Measures the numbers that change images, and prints and returns a row of the table for each."""
    base = measure_with("", options, "work") if constants else {}
    rows = []
    for constant in constants:
        rows.append(row(constant[0], constant[2], changes(constant, options, "work"), base))
        print(rows[-1], flush=True)
    return rows


def estimate_rows(constants, options):
    """The same for the numbers of the error estimate, after a row with all as they are."""
    if not constants:
        return []
    cells = estimate_cells(measure_with("", options, "estimates"))
    rows = ["| as they are | | " + " | ".join(cells + cells) + " |"]
    print(rows[-1], flush=True)
    for constant in constants:
        cells = [cell for estimates in changes(constant, options, "estimates") for cell in estimate_cells(estimates)]
        rows.append(f"| `{constant[0]}` | {constant[2]:g} | " + " | ".join(cells) + " |")
        print(rows[-1], flush=True)
    return rows


def main():
    options = arguments()
    if options.here:
        measure = {"work": measure_here, "estimates": estimates_here}[options.here]
        print(json.dumps(measure(options.scenes.split(","), options)))
        return
    text = CONSTANTS.read_text()
    wanted = options.numbers.split(",") if options.numbers else None
    chosen = [constant for constant in read_constants(text) if wanted is None or constant[0] in wanted]
    of_estimate = names_of_error_estimate(text)
    tables = [table(work_rows([c for c in chosen if c[0] not in of_estimate], options)),
              estimate_table(estimate_rows([c for c in chosen if c[0] in of_estimate], options))]
    if options.page:
        page = pathlib.Path(options.page)
        page.write_text(page.read_text().split(MARK)[0] + MARK + "\n\n" + "\n".join(tables))


if __name__ == "__main__":
    main()
