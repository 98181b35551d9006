#!/usr/bin/env python3
"""Makes one picture that compares the estimators at equal time, with the reference and crops at 200 %.

Usage: equal_time.py SCENE IMAGE [--time S] [--reference FILE.exr | --reference-time S] [--crop X,Y] [--resolution WxH] [--only-compose]

The default, conventional photon mapping (march) and the path tracer (path) render the scene for S seconds each (16 by
default). The reference is a file, or path with another seed and --reference-time seconds (600). The script prints the processor
seconds that each column of the picture used and its error against the reference (MRSE). The lower row is the part of half
the width and height whose upper left corner is at X,Y, enlarged twice. --only-compose makes the picture again from the
images in out/equal_time. oiiotool (Debian's openimageio-tools) draws it; the program is build/release/vdbeam, or
VDBEAM_BINARY.
"""
import argparse
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BINARY = os.environ.get("VDBEAM_BINARY", str(ROOT / "build/release/vdbeam"))
OUT = ROOT / "out" / "equal_time"
# Name of the image, words of the caption, estimator.
COLUMNS = [("auto", "vdbeam, default", "auto"), ("march", "photon mapping (march)", "march"), ("path", "path tracing (path)", "path"),
           ("reference", "reference", "path")]


def run(command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"equal_time.py: {command[0]} failed: {done.stderr.strip()}")
    return done.stdout


def render(options):
    """Renders all columns; writes their processor seconds to out/equal_time/seconds.json."""
    OUT.mkdir(parents=True, exist_ok=True)
    used = {}
    for name, _, estimator in COLUMNS:
        reference = name == "reference"
        if reference and options.reference:
            shutil.copyfile(options.reference, OUT / "reference.exr")
            run(["oiiotool", options.reference, "--ch", "R,G,B", "--mulc", str(2 ** options.exposure), "--colorconvert", "linear", "sRGB",
                 "-d", "uint8", "-o", f"{OUT}/reference.png"])
            continue
        seconds = options.reference_time if reference else options.time
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        run([BINARY, "render", options.scene, "-o", f"{OUT}/{name}.exr", "--preview", f"{OUT}/{name}.png", "--estimator",
             estimator, "--time", f"{seconds}s", "--seed", "777" if reference else "1", "--resolution", options.resolution, "-q",
             "--view", "srgb", "--exposure", str(options.exposure)])
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used[name] = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    (OUT / "seconds.json").write_text(json.dumps(used))


def caption(name, words):
    seconds = json.loads((OUT / "seconds.json").read_text()).get(name)
    if name == "reference":
        return words if seconds is None else f"{words}, {seconds:.0f} s"
    error = json.loads(run([BINARY, "compare", f"{OUT}/{name}.exr", f"{OUT}/reference.exr", "--json"]))
    return f"{words}, {seconds:.0f} s, MRSE {error['mrse']:.2g}"


def compose(options):
    width, height = map(int, options.resolution.split("x"))
    x, y = map(int, options.crop.split(",")) if options.crop else (width // 4, height // 8)
    columns = []
    for name, words, _ in COLUMNS:
        crop, column = f"{OUT}/{name}_crop.png", f"{OUT}/{name}_column.png"
        run(["oiiotool", f"{OUT}/{name}.png", "--cut", f"{width // 2}x{height // 2}+{x}+{y}", "--resize:filter=box",
             f"{width}x{height}", "-o", crop])
        run(["oiiotool", f"{OUT}/{name}.png", crop, "--mosaic", "1x2", "-o", column])
        columns.append(column)
        print(caption(name, words))
    run(["oiiotool", *columns, "--mosaic:pad=2", f"{len(columns)}x1", "--compression", "jpeg:92", "--nosoftwareattrib", "-o", options.image])
    print(f"{options.image}: written")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("image", help="PNG or JPEG to write")
    parser.add_argument("--time", type=float, default=16)
    parser.add_argument("--reference", help="image to compare with, of the same resolution")
    parser.add_argument("--exposure", type=float, default=0, help="exposure of the picture in stops")
    parser.add_argument("--reference-time", type=float, default=600)
    parser.add_argument("--crop", help="X,Y: corner of the enlarged part [pixels]")
    parser.add_argument("--resolution", default="480x270")
    parser.add_argument("--only-compose", action="store_true")
    options = parser.parse_args()
    if not options.only_compose:
        render(options)
    compose(options)


if __name__ == "__main__":
    main()
