#!/usr/bin/env python3
"""How a shot scales over machines, on paper: the table of docs/how-to/farm.md.

Every assumption is an option. All machines start at once, share one file server, and do nothing
else; a frame is split by passes only where there are more machines than frames.
"""
import argparse
import math


def arguments(words=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--frames", type=int, default=1000)
    add("--machines", type=int, nargs="+", default=[1, 100, 1000, 10000])
    add("--width", type=int, default=2048)
    add("--height", type=int, default=1152)
    add("--passes", type=int, default=256, help="of a frame")
    add("--cores", type=int, default=32, help="of a machine")
    add("--pass-seconds", type=float, default=3.0, help="core seconds of a pass, per megapixel")
    add("--photon-seconds", type=float, default=4.0, help="core seconds of a pass's photons")
    add("--volume-mb", type=float, default=400.0, help="VDB of a frame")
    add("--brick-seconds", type=float, default=12.0, help="one machine reads and bricks a VDB")
    add("--image-bytes", type=float, default=20.0, help="per pixel of the finished EXR")
    add("--film-bytes", type=float, default=184.0, help="per pixel of a part and of a checkpoint")
    add("--checkpoint", type=float, default=300.0, help="seconds between checkpoints")
    add("--server-gb", type=float, default=5.0, help="GB/s of the file server")
    add("--link-gb", type=float, default=1.0, help="GB/s of a machine's network")
    add("--dispatch", type=float, default=50.0, help="tasks that the queue starts in a second")
    return parser.parse_args(words)


def model(a, machines):
    """What `machines` machines do with the shot: seconds and GB."""
    pixels = a.width * a.height
    splits = max(1, min(math.ceil(machines / a.frames), a.passes))
    tasks = a.frames * splits
    film_gb = pixels * a.film_bytes / 1e9
    image_gb = pixels * a.image_bytes / 1e9
    pass_seconds = (a.photon_seconds + a.pass_seconds * pixels / 1e6) / a.cores
    render = pass_seconds * math.ceil(a.passes / splits)
    # Reading and bricking a frame overlaps the rendering of the one before, if there is one.
    waves = math.ceil(tasks / machines)
    compute = a.brick_seconds + waves * render if waves > 1 else a.brick_seconds + render
    reads = tasks * a.volume_mb / 1e3
    checkpoints = tasks * math.floor(render / a.checkpoint) * film_gb
    parts = tasks * film_gb if splits > 1 else 0.0
    writes = a.frames * image_gb + checkpoints + parts
    busy = min(tasks, machines)
    # A part is merged at the server's rate: every byte of the parts crosses the network again.
    merge = (max(parts / a.server_gb, splits * film_gb / a.link_gb) if splits > 1 else 0.0)
    storage = (reads + writes) / a.server_gb
    dispatch = (tasks + (a.frames if splits > 1 else 0)) / a.dispatch
    burst = busy * a.volume_mb / 1e3 / min(a.server_gb, busy * a.link_gb)
    wall = max(compute + burst, storage, dispatch) + merge
    ideal = a.frames * (pass_seconds * a.passes) / machines
    return {"machines": machines, "splits": splits, "tasks": tasks, "render": render,
            "compute": compute, "burst": burst, "reads": reads, "writes": writes,
            "storage": storage, "dispatch": dispatch, "merge": merge, "wall": wall,
            "efficiency": ideal / wall}


ROWS = [
    ("parts of a frame", "splits", "{:.0f}"), ("tasks", "tasks", "{:.0f}"),
    ("rendering a task", "render", "seconds"), ("all tasks, computing", "compute", "seconds"),
    ("first volumes arrive after", "burst", "seconds"), ("read in all", "reads", "{:.0f} GB"),
    ("written in all", "writes", "{:.0f} GB"), ("server busy", "storage", "seconds"),
    ("queue busy", "dispatch", "seconds"), ("merging", "merge", "seconds"),
    ("wall clock", "wall", "seconds"), ("of the ideal speed", "efficiency", "{:.0%}")]


def duration(seconds):
    if seconds >= 2 * 86400:
        return f"{seconds / 86400:.1f} d"
    if seconds >= 2 * 3600:
        return f"{seconds / 3600:.1f} h"
    return f"{seconds / 60:.1f} min" if seconds >= 120 else f"{seconds:.0f} s"


def table(results):
    """Markdown, a column for each number of machines."""
    lines = ["| machines | " + " | ".join(f"{r['machines']:,}" for r in results) + " |",
             "|---|" + "---|" * len(results)]
    for title, key, form in ROWS:
        cells = [duration(r[key]) if form == "seconds" else form.format(r[key]) for r in results]
        lines.append(f"| {title} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main():
    a = arguments()
    print(table([model(a, machines) for machines in a.machines]))


if __name__ == "__main__":
    main()
