"""One self-contained HTML page: curves, images at equal time side by side, error images, settings."""

import base64
import datetime
import html
import io
import json
import re
from pathlib import Path
from string import Template

import matplotlib
import numpy as np
from matplotlib import image as matplotlib_image

from . import exr
from .report import ReportError, group_runs, join_seeds, table

TEMPLATE = Path(__file__).with_name("page.html")
# Errors are shown as |v - r| / (r + 0.01), the root of a pixel's MRSE, from 0 to this.
LARGEST_ERROR = 0.5
ERROR_COLOURS = "magma"  # perceptually uniform


def _data_url(data, kind):
    return f"data:{kind};base64," + base64.b64encode(data).decode("ascii")


def _png_url(pixels):
    buffer = io.BytesIO()
    matplotlib_image.imsave(buffer, pixels, format="png")
    return _data_url(buffer.getvalue(), "image/png")


def display_image(rgb, exposure=0.0):
    """8-bit sRGB of linear RGB."""
    linear = np.clip(np.nan_to_num(rgb * 2.0**exposure), 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear,
                       1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
    return np.round(255 * encoded).astype(np.uint8)


def error_image(rgb, reference):
    """The relative error of each pixel in false colours."""
    error = np.sqrt(np.mean(((rgb - reference) / (reference + 0.01)) ** 2, axis=2))
    scaled = np.clip(np.nan_to_num(error, nan=np.inf) / LARGEST_ERROR, 0, 1)
    return (255 * matplotlib.colormaps[ERROR_COLOURS](scaled)[..., :3]).astype(np.uint8)


def _scale_bar():
    bar = matplotlib.colormaps[ERROR_COLOURS](np.linspace(0, 1, 256))[None, :, :3]
    return _png_url((255 * np.repeat(bar, 8, axis=0)).astype(np.uint8))


def _caption(run):
    last = run.passes[-1]
    return (f"{run.estimator}: {last['pass']:.0f} passes in {last['seconds']:.1f} s, "
            f"MRSE {last['mrse']:.2g}, bias {100 * last['bias']:+.2f} %")


def _settings(report_path):
    report = json.loads(Path(report_path).read_text(encoding="utf-8"))
    report.pop("passes", None)
    return json.dumps(report, indent=2, sort_keys=True)


def _report(folder, run):
    """The report of a run, and its path."""
    path = folder / "runs" / f"{run.scene}.{run.estimator}.{run.seed}.json"
    return json.loads(path.read_text(encoding="utf-8")), path


def _peers(folder, runs):
    """The other renderers with their versions, where these are known."""
    settings = [_report(folder, run)[0].get("settings") or {} for run in runs]
    return list(dict.fromkeys(one["renderer"] for one in settings if re.search(r"\d", one.get("renderer", ""))))


def _conditions(folder, runs):
    """One line: when, where and with what the runs were made, from the images and reports."""
    report, path = _report(folder, runs[0])
    machine = report.get("machine", {})
    # A copied report is younger than the measurement; the image holds when it was rendered.
    parts = [exr.capture_date(path.with_suffix(".exr"))
             or datetime.date.fromtimestamp(path.stat().st_mtime).isoformat()]
    if "cpu" in machine:
        parts.append(f"{machine['cpu']}, {machine.get('cores')} cores, {machine.get('threads')} threads")
    parts += [f"{name} {version}" for name, version in report.get("versions", {}).items()]
    parts += _peers(folder, runs)
    return html.escape("Measured " + "; ".join(parts) + ".")


def _values(scene, runs, points=60):
    """The curves of a scene as numbers, for the pointer: seconds, MRSE, and its least and largest over the seeds."""
    curves = []
    for name, estimator, group in group_runs(runs):
        curve = join_seeds(group, points) if name == scene else None
        if curve is not None:
            columns = zip(curve.seconds, curve.mrse, curve.low, curve.high)
            curves.append({"name": estimator, "seeds": len(group),
                           "points": [[float(f"{value:.4g}") for value in row] for row in columns]})
    return curves


def _scene_data(scene, runs, folder, reference_paths, place):
    """What the page shows of one scene: the run with the first seed of each estimator."""
    firsts = [group[0] for name, _, group in group_runs(runs) if name == scene]
    pictures = [exr.read_rgb(path) for path in reference_paths]
    reference = sum(pictures) / len(pictures)
    images, errors, settings = [], [], []
    for run in firsts:
        stem = folder / "runs" / f"{scene}.{run.estimator}.{run.seed}"
        rgb = exr.read_rgb(f"{stem}.exr")
        if rgb.shape != reference.shape:
            raise ReportError(f"{stem}.exr: its size is not that of {reference_paths[0]}")
        images.append({"name": run.estimator, "caption": _caption(run),
                       "url": _png_url(display_image(rgb))})
        errors.append({"caption": _caption(run), "url": _png_url(error_image(rgb, reference))})
        settings.append({"name": f"{run.estimator}, seed {run.seed}",
                         "text": _settings(f"{stem}.json")})
    names = ", ".join(Path(path).name for path in reference_paths)
    images.append({"name": "reference", "caption": f"reference: {names}",
                   "url": _png_url(display_image(reference))})
    curves, dark = (_data_url((folder / f"{scene}{ending}.svg").read_bytes(), "image/svg+xml")
                    for ending in ("", ".dark"))
    return {"name": scene, "curves": curves, "dark": dark, "images": images, "errors": errors,
            "settings": settings, "place": place, "values": _values(scene, runs)}


def _html_table(markdown):
    """The table of report.table, whose second line only separates the head."""
    rows = [[html.escape(cell.strip()) for cell in line.strip("|").split("|")]
            for line in markdown.splitlines()]
    head = "".join(f"<th>{cell}</th>" for cell in rows[0])
    body = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>"
                   for row in rows[2:])
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def write_page(runs, folder, references, places):
    """Writes FOLDER/index.html from the runs' images and reports. `references`: scene -> one or two EXRs; `places`:
    scene -> what plots.plot_scene returned."""
    scenes = [_scene_data(scene, runs, folder, references[scene], places[scene])
              for scene in dict.fromkeys(run.scene for run in runs)]
    # "</" would end the script element.
    data = json.dumps(scenes).replace("</", "<\\/")
    page = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        data=data, table=_html_table(table(runs)), scale=_scale_bar(),
        largest=f"{LARGEST_ERROR:g}", conditions=_conditions(folder, runs))
    (folder / "index.html").write_text(page, encoding="utf-8")
