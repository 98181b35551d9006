#!/usr/bin/env python3
"""Renders the strips of docs/how-to: one key of the look per strip, from left to right.

Usage: look_strips.py [FOLDER] [STRIP...]

Writes FOLDER/look_STRIP.jpg (docs/images by default) for each STRIP, or for all: albedo, extinction, phase, curve,
emission. oiiotool (Debian's openimageio-tools) joins the tiles; the program is build/release/vdbeam, or VDBEAM_BINARY.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
BINARY = os.environ.get("VDBEAM_BINARY", str(ROOT / "build/release/vdbeam"))
CLOUD, FIRE = "data/sunlit_cloud.toml", "data/fire.toml"
BACKLIGHT = "light.0.direction=[0.5,-0.45,0.75]"
SMOOTH = "volume.0.interpolation=cubic"

# Scene and, tile by tile, the values that are set.
STRIPS = {
    "albedo": (CLOUD, [["volume.0.albedo=0.9"], ["volume.0.albedo=0.99"], ["volume.0.albedo=0.999"]]),
    "extinction": (CLOUD, [["volume.0.extinction=5"], ["volume.0.extinction=25"], ["volume.0.extinction=120"]]),
    "phase": (CLOUD, [[BACKLIGHT, "volume.0.phase={type='isotropic'}"],
                      [BACKLIGHT, "volume.0.phase={type='henyey_greenstein',g=0.8}"],
                      [BACKLIGHT, "volume.0.phase={type='mie',droplet_diameter=20}"]]),
    "curve": (CLOUD, [["volume.0.density_curve='0:0 1:1'"], ["volume.0.density_curve='0:0 0.5:0.02 1:1'"],
                      ["volume.0.density_curve='0:0 0.3:1 1:1'"]]),
    "emission": (FIRE, [[SMOOTH, "volume.0.emission.scale=4"], [SMOOTH, "volume.0.emission.scale=25"],
                        [SMOOTH, "volume.0.emission.scale=150"]]),
}
SIZES = {CLOUD: "400x220", FIRE: "400x400"}
FRAMES = {FIRE: ["-f", "14"]}


def run(command):
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    if done.returncode:
        sys.exit(f"look_strips.py: {command[0]} failed: {done.stderr.strip()}")


def render(name, target):
    scene, tiles = STRIPS[name]
    with tempfile.TemporaryDirectory() as folder:
        images = []
        for i, values in enumerate(tiles):
            images.append(f"{folder}/{i}.png")
            run([BINARY, "render", scene, *FRAMES.get(scene, []), "-o", f"{folder}/{i}.exr", "--preview", images[-1], "--passes",
                 "4", "--resolution", SIZES[scene], "-q", *[word for value in values for word in ("--set", value)]])
        run(["oiiotool", *images, "--mosaic:pad=2", f"{len(images)}x1", "--compression", "jpeg:90", "--nosoftwareattrib", "-o", str(target)])
    print(f"{target}: written", flush=True)


def main():
    words = sys.argv[1:]
    folder = ROOT / "docs/images"
    if words and words[0] not in STRIPS:
        folder = pathlib.Path(words.pop(0)).absolute()
    if not folder.is_dir() or set(words) - set(STRIPS):
        sys.exit(__doc__.split("\n\n")[1])
    for name in words or STRIPS:
        render(name, folder / f"look_{name}.jpg")


if __name__ == "__main__":
    main()
