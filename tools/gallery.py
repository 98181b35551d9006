#!/usr/bin/env python3
"""Renders pictures of docs/gallery.md: makes the volumes and meshes that a scene needs, then renders it.

Usage: gallery.py [NAME...] [--draft] [--list]

NAME is a scene of data/gallery (storm, silver, ...). Without a name all are rendered, one after the other. Images go to
out/gallery/NAME.exr, .png and .json (the report). --draft renders two passes at a quarter of the size. The program is
build/release/vdbeam, or VDBEAM_BINARY; make_volumes is taken from build/release, or VDBEAM_BUILD. The simulated volumes,
plume.vdb and explosion.vdb, need Blender and some minutes (tools/simulate_volumes.py).
"""
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = ROOT / "data" / "gallery"
VOLUMES = SCENES / "volumes"
OUT = ROOT / "out" / "gallery"
BUILD = pathlib.Path(os.environ.get("VDBEAM_BUILD", ROOT / "build" / "release"))
BINARY = os.environ.get("VDBEAM_BINARY", str(BUILD / "vdbeam"))

# Arguments of make_volumes for each cloud.
CLOUDS = {
    "storm.vdb": ["storm", "--size", "480", "--extent", "20", "--seed", "1"],
    "cumulus.vdb": ["cumulus", "--size", "400", "--extent", "4", "--seed", "4"],
    "fogbank.vdb": ["fogbank", "--size", "320", "--extent", "40"],
    "field.vdb": ["field", "--size", "1400", "--extent", "40"],
}
SIMULATED = {"plume.vdb": "plume", "explosion.vdb": "explosion"}


def needed_files(scene):
    """Names of the files in data/gallery/volumes that a scene reads."""
    return re.findall(r'"volumes/([^"]+)"', scene.read_text())


def make(name):
    """Makes one file of data/gallery/volumes where it is not there yet."""
    target = VOLUMES / name
    if target.exists():
        return
    VOLUMES.mkdir(parents=True, exist_ok=True)
    print(f"making {target.relative_to(ROOT)}", flush=True)
    if name in CLOUDS:
        kind, *options = CLOUDS[name]
        run([BUILD / "tools" / "make_volumes", kind, target, *options])
    elif name in SIMULATED:
        run([sys.executable, ROOT / "tools" / "simulate_volumes.py", SIMULATED[name], target])
    else:
        run([sys.executable, ROOT / "tools" / "make_props.py", VOLUMES])


def run(command):
    command = [str(word) for word in command]
    if not pathlib.Path(command[0]).exists():
        sys.exit(f"gallery.py: there is no {command[0]}; build it with: cmake --build --preset release")
    code = subprocess.run(command).returncode
    if code:
        sys.exit(code)


def render(scene, draft):
    for name in needed_files(scene):
        make(name)
    OUT.mkdir(parents=True, exist_ok=True)
    base = OUT / scene.stem
    size = ["--passes", "2", "--resolution", "480x270"] if draft else []
    run([BINARY, "render", scene, "-o", f"{base}.exr", "--preview", f"{base}.png", "--report", f"{base}.json", *size])


def main():
    names = [word for word in sys.argv[1:] if not word.startswith("-")]
    options = set(sys.argv[1:]) - set(names)
    scenes = {path.stem: path for path in sorted(SCENES.glob("*.toml"))}
    unknown = [name for name in names if name not in scenes]
    if "--help" in options or "-h" in options:
        print(__doc__)
    elif options - {"--draft", "--list"} or unknown:
        sys.exit(f"gallery.py: unknown: {' '.join([*sorted(options - {'--draft', '--list'}), *unknown])}; the scenes are "
                 + ", ".join(scenes))
    elif "--list" in options:
        print("\n".join(scenes))
    else:
        for name in names or scenes:
            render(scenes[name], "--draft" in options)


if __name__ == "__main__":
    main()
