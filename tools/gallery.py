#!/usr/bin/env python3
"""Renders the images of docs/gallery.md: makes the volumes and meshes that a scene needs, then renders it.

Usage: gallery.py [NAME...] [--draft] [--list]

NAME is a scene of data/gallery (storm, silver, ...). Without a name all are rendered, one after the other. Images go to
out/gallery/NAME.exr, .png and .json (the report); orbit is a sequence and becomes NAME.webp too; yard is a comp of
NAME.plate.exr and NAME.smoke.exr, which oiiotool makes. --draft renders two passes at a quarter of the size. The program is build/release/vdbeam, or VDBEAM_BINARY; make_volumes is taken from
build/release, or VDBEAM_BUILD. The simulated volumes, plume.vdb and explosion.vdb, need Blender and some minutes
(tools/simulate_volumes.py).
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = ROOT / "data" / "gallery"
VOLUMES = SCENES / "volumes"
OUT = ROOT / "out" / "gallery"
BUILD = pathlib.Path(os.environ.get("VDBEAM_BUILD", ROOT / "build" / "release"))
BINARY = os.environ.get("VDBEAM_BINARY", str(BUILD / "vdbeam"))

# Arguments of make_volumes for each cloud.
CLOUDS = {
    "storm.vdb": ["storm", "--size", "900", "--extent", "23", "--seed", "1"],
    "cumulus.vdb": ["cumulus", "--size", "700", "--extent", "4", "--seed", "2"],
    "orbit.vdb": ["cumulus", "--size", "300", "--extent", "4", "--seed", "3"],
    "fogbank.vdb": ["fogbank", "--size", "320", "--extent", "40"],
    "field.vdb": ["field", "--size", "2000", "--extent", "40"],
}
# Options of the 8-bit images. "srgb" clips, but keeps the contrast of bright clouds.
VIEWS = {
    "storm": ["--view", "srgb", "--exposure", "-0.3"],
    "silver": ["--view", "srgb", "--exposure", "-0.1"],
    "field": ["--view", "srgb", "--exposure", "-0.3"],
    "windows": ["--view", "srgb", "--exposure", "0.1"],
    "lighthouse": ["--view", "srgb", "--exposure", "-0.2"],
    "stacks": ["--exposure", "0.3"],
    "explosion": ["--exposure", "0.8"],
    "orbit": ["--view", "srgb", "--exposure", "-0.3"],
    "water": ["--view", "srgb", "--exposure", "-0.2"],
}
SEQUENCES = {"orbit": "1-48"}
# Scenes that are rendered twice and composited: the exposure of the 8-bit image.
COMPS = {"yard": 0.4}
SIMULATED = {"plume.vdb": ["plume", "192"], "explosion.vdb": ["explosion", "256"]}


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
        kind, resolution = SIMULATED[name]
        run([sys.executable, ROOT / "tools" / "simulate_volumes.py", kind, target, resolution])
    else:
        run([ROOT / "tools" / "make_props.py", VOLUMES])


def run(command):
    command = [str(word) for word in command]
    if not pathlib.Path(command[0]).exists():
        sys.exit(f"gallery.py: there is no {command[0]}; build it with: cmake --build --preset release")
    code = subprocess.run(command).returncode
    if code:
        sys.exit(code)


def animate(base, frames):
    """Joins the previews of a sequence to an animated WebP, where Pillow is installed."""
    try:
        from PIL import Image
    except ImportError:
        print("gallery.py: no animation without Pillow; install it with: apt install python3-pil")
        return
    images = [Image.open(f"{base}.{frame:04d}.png").convert("RGB") for frame in frames]
    images[0].save(f"{base}.webp", save_all=True, append_images=images[1:], duration=83, loop=0, quality=82, method=6)


def composite(scene, base, options):
    """Renders the surfaces alone, then the volumes with the surfaces as shadow catchers, and puts the second over the first
    as docs/how-to/compositing.md describes. The light that the smoke adds to surfaces is faint and smooth, and noisy after
    few passes: it is blurred."""
    meshes = len(tomllib.loads(scene.read_text())["mesh"])
    parts = {
        "plate": ["--set", "volume.0.extinction=0", "--set", "render.passes=3"],
        "smoke": [word for i in range(meshes) for word in ("--set", f"mesh.{i}.material.type=shadow_catcher")]
        + ["--set", "light.0.visible=false"],
    }
    for part, changes in parts.items():
        run([BINARY, "render", scene, "-o", f"{base}.{part}.exr", "--report", f"{base}.{part}.json", *changes, *options])
    plate, smoke, three = f"{base}.plate.exr", f"{base}.smoke.exr", ["--chnames", "R,G,B"]
    run([oiiotool(), plate, "--ch", "R,G,B", smoke, "--ch", "shadow.R,shadow.G,shadow.B", *three, "--mul",
         smoke, "--ch", "R,G,B", "--add", smoke, "--ch", "catcher_light.R,catcher_light.G,catcher_light.B", *three, "--blur", "21x21",
         "--add", "-o", f"{base}.exr", "--mulc", str(2 ** COMPS[scene.stem]), "--colorconvert", "linear", "sRGB", "-d", "uint8",
         "-o", f"{base}.png"])


def oiiotool():
    return shutil.which("oiiotool") or sys.exit("gallery.py: there is no oiiotool; install it with: apt install openimageio-tools")


def render(scene, draft):
    for name in needed_files(scene):
        make(name)
    OUT.mkdir(parents=True, exist_ok=True)
    base, options = OUT / scene.stem, list(VIEWS.get(scene.stem, []))
    if draft:
        options += ["--passes", "2", "--resolution", "480x270"]
    if scene.stem in COMPS:
        composite(scene, base, options)
        return
    if scene.stem not in SEQUENCES:
        run([BINARY, "render", scene, "-o", f"{base}.exr", "--preview", f"{base}.png", "--report", f"{base}.json", *options])
        return
    run([BINARY, "render", scene, "-f", SEQUENCES[scene.stem], "-o", f"{base}.####.exr", "--preview", f"{base}.####.png",
         "--report", f"{base}.####.json", *options])
    first, last = map(int, SEQUENCES[scene.stem].split("-"))
    animate(base, range(first, last + 1))


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
