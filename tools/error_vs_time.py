#!/usr/bin/python3
"""Error against run time of vdbeam's estimators on the sample scenes.

Renders each scene with each estimator for the same time, with several seeds, against a reference,
and writes to the output folder:
  curves.csv             every pass of every run
  SCENE.png, SCENE.svg   MRSE against seconds, a line per variant, a band over the seeds
  table.md               MRSE x seconds at MRSE 0.01, at 0.001 and at the end
  index.html             all of it on one page, with images at equal time and error images
  runs/                  images and reports; references/: references rendered by `path`

Examples:
  tools/error_vs_time.py
  tools/error_vs_time.py --scenes data/smoke.toml --time 20 --seeds 1-5 --estimators beam,path
  tools/error_vs_time.py --reference cloud=cloud_4096spp.exr --threads 2 --peers
  tools/error_vs_time.py --estimators beam --variant 'k100: --set render.neighbours=100' \
      --variant 'scatter: --set render.store=scatter'
  tools/error_vs_time.py --plot-only            # draws again what the last run left
"""

import argparse
import json
import os
import sys
from pathlib import Path


def stop_without(missing):
    """Ends the program where a Python module is missing."""
    sys.exit(f"error_vs_time.py: the Python module {missing.name} is missing; Debian has python3-numpy and "
             "python3-matplotlib for /usr/bin/python3")


MISSING = None
try:
    from error_curves import report as reports
    from error_curves import runner
except ModuleNotFoundError as problem:
    MISSING = problem  # --help works all the same

ROOT = Path(__file__).resolve().parent.parent
ESTIMATORS = ("beam", "gather", "march", "path")


def parse_seeds(text):
    """"1-3,7" -> [1, 2, 3, 7]."""
    seeds = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        seeds += range(int(first), int(last or first) + 1)
    if not seeds or min(seeds) < 0 or runner.REFERENCE_SEED in seeds:
        raise ValueError("no usable seeds")
    return seeds


def variant(text):
    return runner.parse_variant(text)


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", type=Path, metavar="SCENE",
                        default=[ROOT / "data/cloud.toml", ROOT / "data/smoke.toml"])
    parser.add_argument("--estimators", default=",".join(ESTIMATORS),
                        type=lambda text: [e for e in text.split(",") if e],
                        help="default: %(default)s; '' for none")
    parser.add_argument("--variant", action="append", default=[], metavar="NAME: OPTIONS",
                        type=variant,
                        help="another way to render: 'k200: --set render.neighbours=200'; may be "
                             "repeated")
    parser.add_argument("--time", type=float, default=10, metavar="SECONDS",
                        help="of rendering per run (default: %(default)s)")
    parser.add_argument("--seeds", type=parse_seeds, default="1-3",
                        help="such as 1-3,7 (default: %(default)s)")
    parser.add_argument("--reference", action="append", default=[], metavar="SCENE=FILE.exr",
                        help="true image of a scene, by its file's stem, or two independent ones, A.exr,B.exr; may be "
                             "repeated")
    parser.add_argument("--reference-time", type=float, default=300, metavar="SECONDS",
                        help="for a reference that is not given (default: %(default)s)")
    parser.add_argument("--output", type=Path, default=ROOT / "out/error_vs_time", metavar="FOLDER")
    parser.add_argument("--binary", type=Path, default=ROOT / "build/release/vdbeam")
    parser.add_argument("--option", action="append", default=[], metavar="=--OPTION",
                        help="passed on to `vdbeam render`, such as --option=--threads=2")
    parser.add_argument("--peers", action="store_true",
                        help="compare with Blender's Cycles and OpenVDB's vdb_render too, where they are "
                             "installed and can show the scene")
    parser.add_argument("--threads", type=int, default=0, metavar="N",
                        help="for every renderer (default: all cores)")
    parser.add_argument("--plot-only", action="store_true",
                        help="render no curves; use the reports that are there")
    parser.add_argument("--no-plots", action="store_true", help="write the tables alone")
    if MISSING:
        if {"-h", "--help"} & set(sys.argv[1:] if arguments is None else arguments):
            parser.print_help()
            sys.exit(0)
        stop_without(MISSING)
    options = parser.parse_args(arguments)
    options.variants = [runner.parse_variant(name) for name in options.estimators] + options.variant
    names = [variant.name for variant in options.variants]
    if not names or len(set(names)) < len(names):
        parser.error("there must be estimators or variants, each with another name")
    stems = [scene.stem for scene in options.scenes]
    if len(set(stems)) < len(stems):
        parser.error("two scenes have the same file name; the results are named by it")
    options.option = [f"--threads={options.threads}", *options.option] if options.threads else options.option
    pairs = [pair.partition("=")[::2] for pair in options.reference]
    options.references = {stem: tuple(Path(file) for file in files.split(",")) for stem, files in pairs}
    unknown = set(options.references) - set(stems)
    if unknown:
        parser.error(f"--reference {sorted(unknown)[0]}: no such scene; there are {', '.join(stems)}")
    if any(len(files) > 2 for files in options.references.values()):
        parser.error("--reference: a scene has one reference or two")
    if options.time <= 0 or options.reference_time <= 0:
        parser.error("times must be positive")
    return options


def find_references(options):
    """One reference or two of every scene by its stem, and the noise of those rendered here."""
    images, noise = {}, {}
    for scene in options.scenes:
        if scene.stem in options.references:
            images[scene.stem] = options.references[scene.stem]
        else:
            image, report = runner.cached_reference(
                options.binary, scene, options.output / "references", options.reference_time,
                options.option)
            images[scene.stem] = (image,)
            noise[scene.stem] = runner.reference_noise(report)
    return images, noise


def existing_runs(options):
    runs = []
    for scene in options.scenes:
        for variant in options.variants:
            for seed in options.seeds:
                path = options.output / "runs" / f"{scene.stem}.{variant.name}.{seed}.json"
                if path.exists():
                    runs.append(reports.read_report(path, scene.stem, variant.name, seed))
    if not runs:
        raise reports.ReportError(f"{options.output / 'runs'}: no reports of these scenes, "
                                  "estimators and seeds; run without --plot-only first")
    return runs


def run_peers(options, references, runs):
    """Other renderers, on scenes as the reports of vdbeam's runs describe them."""
    from error_curves import peers, vdb_render

    renderers = {"Cycles": peers.run_cycles, "vdb_render": vdb_render.run_vdb_render}
    for scene in options.scenes:
        first = next(run for run in runs if run.scene == scene.stem)
        folder = options.output / "runs"
        report = folder / f"{first.scene}.{first.estimator}.{first.seed}.json"
        settings = json.loads(report.read_text(encoding="utf-8")).get("settings")
        for name, run in renderers.items():
            try:
                runs += run(options.binary, scene.stem, settings, references[scene.stem], options.seeds,
                            options.time, options.threads or os.cpu_count(), folder)
            except peers.NotWithinMeans as reason:
                print(f"{scene}: {name} is left out: {reason}", flush=True)


def draw(runs, folder, references, noise):
    # Imported here: it takes a second, and a wrong option should not.
    try:
        from error_curves import page, plots
    except ModuleNotFoundError as problem:
        stop_without(problem)

    places = {scene: plots.plot_scene(runs, scene, folder / scene, noise.get(scene))
              for scene in dict.fromkeys(run.scene for run in runs)}
    page.write_page(runs, folder, references, places)


def main(arguments=None):
    options = parse_arguments(arguments)
    try:
        if options.plot_only:
            runs = existing_runs(options)
        references, noise = find_references(options)
        if not options.plot_only:
            runs = runner.run_all(options.binary, options.scenes, references, options.variants,
                                  options.seeds, options.time, options.output / "runs",
                                  options.option)
            if options.peers:
                run_peers(options, references, runs)
        reports.write_csv(runs, options.output / "curves.csv")
        if not options.no_plots:
            draw(runs, options.output, references, noise)
    except (runner.RenderFailed, reports.ReportError, OSError) as error:
        print(f"error_vs_time.py: {error}", file=sys.stderr)
        return 1
    text = reports.table(runs)
    (options.output / "table.md").write_text(text, encoding="utf-8")
    print(text, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
