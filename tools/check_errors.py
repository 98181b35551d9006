#!/usr/bin/python3
"""Measures vdbeam on scenes that no constant was fitted to: six clouds and seven shots, made from nothing.

Each scene is rendered by the default estimator and by `path`, and compared with two independent references by
`path`. Prints a line per scene: the estimator, the error (MRSE), the stated one over it, whether the stated interval
holds it, and the lead over `path`: how many times longer `path` works for the same error. Work is counted (rays,
collisions, photons), not timed, so that a busy machine changes nothing; seconds are printed beside it.

tools/scene_suite/limits.json holds the error that each scene may have after these passes and the lead that it must
have; the program ends with 1 where one does not. --update writes the limits anew: a third above what was measured.

--seeds 20 validates the error estimate instead: each scene is rendered with 20 seeds, and a line per scene says how
often the stated 95 % interval holds the true error, the median of the stated over the true error, and the median of the
interval's upper end over its lower one. It needs references with far less noise than the renders, and 3 passes or more.

Examples:
  PYTHONPATH=build/release/python tools/check_errors.py
  PYTHONPATH=build/release/python tools/check_errors.py --scenes tower,fog_with_trees --references out/references
  PYTHONPATH=build/release/python tools/check_errors.py --seeds 20 --reference-passes 128
"""
import argparse
import json
import pathlib
import statistics
import sys

LIMITS = pathlib.Path(__file__).parent / "scene_suite" / "limits.json"
SLACK = 4 / 3


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--scenes", help="names, separated by commas; default: all")
    parser.add_argument("--width", type=int, default=128, help="of the images [pixels] (128)")
    parser.add_argument("--passes", type=int, default=8, help="of the default estimator (8)")
    parser.add_argument("--path-passes", type=int, default=8, help="of path, which is compared with it (8)")
    parser.add_argument("--reference-passes", type=int, default=64, help="of each reference (64)")
    parser.add_argument("--references", help="folder in which references are kept; default: nowhere")
    parser.add_argument("--images", help="folder for previews")
    parser.add_argument("--no-limits", action="store_true", help="compare with no limits, as at another size")
    parser.add_argument("--json", help="file for the figures")
    parser.add_argument("--update", action="store_true", help="write the limits anew")
    parser.add_argument("--seeds", type=int, default=0, help="validate the error estimate with the seeds 1 to this")
    options = parser.parse_args()
    if options.seeds and options.passes < 3:
        parser.error("--seeds needs --passes 3 or more: before, no interval is stated")
    return options


def validate(suite, name, keys, options):
    """Renders a scene with each seed and prints how the stated errors compare with the true ones."""
    suite.prepare(keys)
    found = [suite.estimate(keys, options.passes, seed) for seed in range(1, options.seeds + 1)]
    held, over_true, widths = zip(*found)
    figures = {"scene": name, "seeds": options.seeds, "passes": options.passes, "held": sum(held),
               "stated_over_true": statistics.median(over_true), "least": min(over_true), "most": max(over_true),
               "width": statistics.median(widths)}
    print(f"{name:22} {sum(held):4d} of {options.seeds:<4d} {figures['stated_over_true']:8.2f} {min(over_true):6.2f} "
          f"{max(over_true):6.2f} {figures['width']:7.1f}", flush=True)
    return figures


def line(outcome):
    stated = outcome.stated / outcome.mrse if outcome.mrse > 0 else float("nan")
    return (f"{outcome.scene:22} {outcome.estimator:7} {outcome.mrse:9.5f} {stated:7.2f} "
            f"{'yes' if outcome.holds else 'NO':5} {outcome.lead:8.1f} {outcome.seconds:8.1f} {outcome.path_seconds:8.1f}")


def broken_limits(outcome, limits):
    limit = limits.get(outcome.scene)
    if not limit:
        return []
    broken = []
    if outcome.mrse > limit["mrse"] + 2 * outcome.mrse_error:
        broken.append(f"{outcome.scene}: the error is {outcome.mrse:.5f}, its limit {limit['mrse']:.5f}")
    if outcome.lead < limit["lead"]:
        broken.append(f"{outcome.scene}: the lead over path is {outcome.lead:.1f}, its limit {limit['lead']:.1f}")
    return broken


def write_figures(file, figures):
    if file:
        pathlib.Path(file).write_text(json.dumps(figures, indent=1) + "\n")


def main():
    options = arguments()
    import vdbeam

    from scene_suite import measure, scenes
    suite = measure.Suite(vdbeam, options.width, options.reference_passes, options.references, options.images)
    known = scenes.all_scenes(vdbeam)
    names = options.scenes.split(",") if options.scenes else list(known)
    for name in names:
        if name not in known:
            sys.exit(f"check_errors.py: there is no scene {name}; there are {', '.join(known)}")
    if options.seeds:
        print(f"{'scene':22} {'interval holds':>12} {'median':>6} {'least':>6} {'most':>6} {'width':>7}", flush=True)
        figures = [validate(suite, name, known[name], options) for name in names]
        return write_figures(options.json, figures)
    limits = json.loads(LIMITS.read_text()) if LIMITS.exists() and not options.no_limits else {}
    print(f"{'scene':22} {'takes':7} {'MRSE':>9} {'stated':>7} {'holds':5} {'lead':>8} {'s':>8} {'s path':>8}", flush=True)
    outcomes, broken = [], []
    for name in names:
        outcome = suite.measure(name, known[name], options.passes, options.path_passes)
        print(line(outcome), flush=True)
        outcomes.append(outcome)
        broken += broken_limits(outcome, limits)
    write_figures(options.json, [{**vars(o), "holds": o.holds, "lead": o.lead} for o in outcomes])
    if options.update:
        limits.update({o.scene: {"mrse": round(o.mrse * SLACK, 7), "lead": round(o.lead / SLACK, 3)} for o in outcomes})
        LIMITS.write_text(json.dumps(limits, indent=1) + "\n")
        return
    for text in broken:
        print(text, file=sys.stderr)
    sys.exit(1 if broken else 0)


if __name__ == "__main__":
    main()
