"""Curves out of reports: reading, joining seeds, and the figures of merit."""

import csv
import json
from dataclasses import dataclass, field

import numpy as np

FIELDS = ("pass", "seconds", "photons", "error_estimate", "rmse", "mrse", "relmse", "bias")


class ReportError(Exception):
    """A report that cannot be used, as one line."""


@dataclass
class Run:
    """One render: its settings and one row per pass."""

    scene: str
    estimator: str
    seed: int
    passes: list = field(default_factory=list)  # dicts with FIELDS

    def column(self, name):
        return np.array([entry[name] for entry in self.passes], dtype=float)


def read_report(path, scene, estimator, seed):
    """The passes of a report written with --reference."""
    try:
        with open(path, encoding="utf-8") as file:
            report = json.load(file)
    except (OSError, ValueError) as error:
        raise ReportError(f"{path}: not a readable report: {error}") from error
    passes = report.get("passes") if isinstance(report, dict) else None
    if not passes:
        raise ReportError(f"{path}: has no passes")
    rows = []
    for entry in passes:
        missing = [name for name in ("pass", "seconds", "mrse") if name not in entry]
        if missing:
            raise ReportError(f"{path}: a pass has no {missing[0]}; was it rendered with --reference?")
        # JSON has no infinity; an unknown error estimate is null.
        rows.append({name: entry[name] if entry.get(name) is not None else float("nan")
                     for name in FIELDS})
    return Run(scene, estimator, seed, rows)


def write_csv(runs, path):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("scene", "estimator", "seed") + FIELDS)
        for run in runs:
            for entry in run.passes:
                writer.writerow([run.scene, run.estimator, run.seed]
                                + [entry[name] for name in FIELDS])


@dataclass
class Curve:
    """The runs of one estimator on one scene over their seeds, at common times."""

    estimator: str
    seconds: np.ndarray
    mrse: np.ndarray  # geometric mean over the seeds
    low: np.ndarray
    high: np.ndarray


def _usable(run):
    seconds, mrse = run.column("seconds"), run.column("mrse")
    good = np.isfinite(mrse) & (mrse > 0) & (seconds > 0)
    return seconds[good], mrse[good]


def join_seeds(runs, points=200):
    """One curve of the runs of one estimator, over the times that all of them cover; None if none
    are left. Between passes the error is interpolated linearly in the logarithms."""
    samples = [_usable(run) for run in runs]
    samples = [(s, m) for s, m in samples if len(s)]
    if not samples:
        return None
    first = max(s[0] for s, _ in samples)
    last = min(s[-1] for s, _ in samples)
    if last < first:
        return None
    seconds = np.geomspace(first, last, points) if last > first else np.array([first])
    logs = np.array([np.interp(np.log(seconds), np.log(s), np.log(m)) for s, m in samples])
    return Curve(runs[0].estimator, seconds, np.exp(logs.mean(axis=0)), np.exp(logs.min(axis=0)),
                 np.exp(logs.max(axis=0)))


def seconds_at(curve, error):
    """When the curve first is at or below an error; None if it never is."""
    below = np.nonzero(curve.mrse <= error)[0]
    if not len(below):
        return None
    i = below[0]
    if i == 0:
        return float(curve.seconds[0])
    x = np.log(curve.mrse[[i, i - 1]])
    return float(np.exp(np.interp(np.log(error), x, np.log(curve.seconds[[i, i - 1]]))))


def efficiency(curve, error):
    """MRSE x seconds where the curve reaches an error. A curve that begins below it is measured at
    its first point. None where it is not reached."""
    seconds = seconds_at(curve, error)
    return None if seconds is None else seconds * min(error, float(curve.mrse[0]))


def table(runs, levels=(0.01, 0.001)):
    """A Markdown table: per scene and estimator, MRSE x seconds at error levels and at the end."""
    def cell(value):
        return "-" if value is None else f"{value:.2g}"

    lines = ["| scene | estimator | seeds | passes | seconds | MRSE | bias | "
             + " | ".join(f"MRSE x s at {level:g}" for level in levels) + " | at the end |",
             "|---" * (8 + len(levels)) + "|"]
    for scene, estimator, group in group_runs(runs):
        curve = join_seeds(group)
        if curve is None:
            lines.append(f"| {scene} | {estimator} | {len(group)} |" + " - |" * (5 + len(levels)))
            continue
        bias = np.mean([run.column("bias")[-1] for run in group])
        cells = [scene, estimator, str(len(group)),
                 f"{np.mean([run.passes[-1]['pass'] for run in group]):.0f}",
                 f"{curve.seconds[-1]:.1f}", f"{curve.mrse[-1]:.2g}", f"{100 * bias:+.2f} %"]
        cells += [cell(efficiency(curve, level)) for level in levels]
        cells.append(cell(float(curve.seconds[-1] * curve.mrse[-1])))
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def group_runs(runs):
    """(scene, estimator, runs), in the order in which they first appear."""
    groups = {}
    for run in runs:
        groups.setdefault((run.scene, run.estimator), []).append(run)
    scenes = list(dict.fromkeys(run.scene for run in runs))
    estimators = list(dict.fromkeys(run.estimator for run in runs))
    return [(s, e, groups[s, e]) for s in scenes for e in estimators if (s, e) in groups]
