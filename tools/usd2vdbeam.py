#!/usr/bin/env python3
"""Writes a scene file for vdbeam from a USD stage: volumes, camera, lights, meshes, with their time samples.

Runs in any Python that has `pxr`: hython, mayapy, or a studio's own. What has no counterpart is listed on stderr. Exit
codes are vdbeam's: 0 done, 2 bad input. docs/how-to/usd.md describes it.
"""
import argparse
import os
import pathlib
import sys

TOOLS = pathlib.Path(__file__).resolve().parent
# An installed converter has the add-on's modules in the zip beside it.
sys.path[:0] = [str(TOOLS), str(TOOLS / "blender"), str(TOOLS / "vdbeam_blender.zip")]

from vdbeam_blender import animate, camera, notes as notes_module, sequence, toml_text  # noqa: E402


def frame_range(text):
    """(first, last) of "7" or "1-24"."""
    first, _, last = text.partition("-") if not text.startswith("-") else (text, "", "")
    try:
        pair = int(first), int(last or first)
    except ValueError as problem:
        raise argparse.ArgumentTypeError(f"{text}: must look like 7 or 1-24") from problem
    if pair[1] < pair[0]:
        raise argparse.ArgumentTypeError(f"{text}: must not end before its beginning")
    return pair


def size(text):
    """(width, height) of "960x540"."""
    try:
        width, height = (int(part) for part in text.split("x"))
    except ValueError as problem:
        raise argparse.ArgumentTypeError(f"{text}: must look like 960x540") from problem
    return width, height


def arguments(words):
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("stage", help="a .usd, .usda, .usdc or .usdz file")
    parser.add_argument("-o", "--output", default="scene.toml", help="scene file; meshes go beside it")
    parser.add_argument("-f", "--frames", type=frame_range, help="frames, e.g. 1-24; default: the stage's")
    parser.add_argument("--camera", default="", help="path of the camera; default: the first")
    parser.add_argument("--resolution", type=size, help="e.g. 960x540; default: that of the render settings")
    parser.add_argument("--extinction", type=float, default=10.0, help="of volumes, at a density of 1 (default: 10)")
    parser.add_argument("--albedo", type=float, default=0.9, help="of volumes (default: 0.9)")
    parser.add_argument("--g", type=float, default=0.0, help="mean cosine of volumes' scattering (default: 0)")
    return parser.parse_args(words)


def frames_of(stage, asked):
    """The frames to read."""
    if asked:
        return range(asked[0], asked[1] + 1)
    if stage.HasAuthoredTimeCodeRange():
        return range(int(stage.GetStartTimeCode()), int(stage.GetEndTimeCode()) + 1)
    return range(1, 2)


def convert(options, notes):
    """Writes the scene; returns its frames. Throws ValueError and OSError."""
    try:
        from usd_scene import stage as stage_module
    except ImportError as problem:
        raise ValueError(f"this Python has no pxr ({problem}); run hython, mayapy or a Python with usd-core") \
            from problem
    folder = os.path.dirname(os.path.abspath(options.output))
    shading = {"extinction": options.extinction, "albedo": options.albedo}
    if options.g:
        shading["phase"] = {"type": "henyey_greenstein", "g": options.g}
    stage = stage_module.open_stage(options.stage)
    reader = stage_module.StageReader(stage, stage_module.Options(folder, options.camera, options.resolution, shading),
                                      notes)
    frames = frames_of(stage, options.frames)
    margin = 1 if reader.has_shutter() else 0  # the shutter reaches beyond the frames
    scenes = {float(frame): reader.read(float(frame)) for frame in range(frames[0] - margin, frames[-1] + margin + 1)}
    sequence.name_sequences(scenes, folder)
    merged = animate.merge(scenes, notes)
    with open(os.path.join(folder, "camera.txt"), "w", encoding="ascii") as file:
        file.write(camera.matrix_lines(reader.matrices))
    with open(options.output, "w", encoding="utf-8") as file:
        file.write(toml_text.scene_text(merged, [f"from {options.stage} by usd2vdbeam.py"]))
    return frames


def main(words):
    """The program; returns its exit code."""
    options = arguments(words)
    notes = notes_module.Notes()
    try:
        frames = convert(options, notes)
    except (ValueError, OSError) as problem:
        print(f"usd2vdbeam: {problem}", file=sys.stderr)
        return 2
    for line in notes.lines:
        print(f"note: {line}", file=sys.stderr)
    span = str(frames[0]) if len(frames) == 1 else f"{frames[0]}-{frames[-1]}"
    print(f"{options.output}: written; render it with: vdbeam render {options.output} -f {span}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
