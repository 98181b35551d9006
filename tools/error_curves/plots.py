"""Log-log plots of error against seconds."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib import ticker

from .report import group_runs, join_seeds

# Each estimator has its own line style, so that curves can be read without colour.
STYLES = {"beam": ("#0072b2", "-"), "gather": ("#cc79a7", "-"), "march": ("#d55e00", "--"), "path": ("#009e73", "-.")}
OTHERS = [(colour, style) for style in ("-", "--", ":") for colour in
          ("#cc79a7", "#e69f00", "#56b4e9", "#555555", "#8c564b")]


def _label(axis):
    """Numbers as people write them, at 1, 2 and 5 of each decade, or more where the axis is short."""
    low, high = axis.get_view_interval()
    decades = np.log10(high / low)
    subs = range(1, 10) if decades < 0.7 else (1, 2, 5) if decades < 3 else (1,)
    axis.set_major_locator(ticker.LogLocator(10, subs=subs, numticks=100))
    axis.set_minor_locator(ticker.LogLocator(10, subs=range(1, 10), numticks=100))
    axis.set_major_formatter(ticker.FuncFormatter(lambda x, _: f"{x:g}"))
    axis.set_minor_formatter(ticker.NullFormatter())


def plot_scene(runs, scene, path_stem, noise=None):
    """Writes PATH_STEM.png and PATH_STEM.svg, and PATH_STEM.dark.svg for dark pages: a line per
    estimator (the geometric mean over the seeds), a band from the least to the largest, and the
    reference's own noise. Returns where the axes lie in the drawing, for a page that shows values."""
    for style, ending in (("default", ""), ("dark_background", ".dark")):
        with plt.style.context(style):
            plt.rcParams["svg.hashsalt"] = "vdbeam"  # the same file for the same data
            figure = _draw(runs, scene, noise)
            if not ending:
                figure.savefig(f"{path_stem}.png", dpi=144)
            figure.savefig(f"{path_stem}{ending}.svg", metadata={"Date": None}, transparent=True)
            place = _place(figure.axes[0])
            plt.close(figure)
    return place


def _place(axes):
    """The edges of the axes as fractions of the drawing, from its top left, and the seconds at the left and right."""
    box = axes.get_position()
    return {"left": box.x0, "right": box.x1, "top": 1 - box.y1, "bottom": 1 - box.y0, "seconds": axes.get_xlim()}


def _draw(runs, scene, noise):
    figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
    other = 0
    for name, estimator, group in group_runs(runs):
        curve = join_seeds(group) if name == scene else None
        if curve is None:
            continue
        colour, style = STYLES.get(estimator) or OTHERS[other % len(OTHERS)]
        other += estimator not in STYLES
        marker = "o" if len(curve.seconds) == 1 else None
        axes.plot(curve.seconds, curve.mrse, style, color=colour, marker=marker, label=estimator)
        if len(group) > 1:
            axes.fill_between(curve.seconds, curve.low, curve.high, color=colour, alpha=0.2, lw=0)
    if noise is not None and np.isfinite(noise) and noise > 0:
        axes.axhline(noise, color="#888888", lw=1.5, ls=":", label="noise of the reference")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("seconds of rendering")
    axes.set_ylabel("error (MRSE, mean relative squared error)")
    axes.set_title(scene)
    _label(axes.xaxis)
    _label(axes.yaxis)
    axes.grid(which="major", alpha=0.5)
    axes.grid(which="minor", alpha=0.15)
    if axes.get_legend_handles_labels()[0]:
        axes.legend()
    return figure
