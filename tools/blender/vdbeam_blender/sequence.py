"""Sequences of files: which one of a VDB sequence a frame shows, and meshes that change from frame to frame."""
import os
import re
import shutil


def safe_name(name):
    """A file's name without characters that paths or frame patterns use."""
    return re.sub(r"[^A-Za-z0-9_-]", "_", name)[:80]


def pattern_of(path):
    """(path with #### for the number, number) of "smoke.0024.vdb"; (path, None) where there is no number."""
    folder, name = os.path.split(path)
    match = re.match(r"(.*?)(\d+)(\D*)$", name)
    if not match:
        return path, None
    head, digits, tail = match.groups()
    return os.path.join(folder, head + "#" * len(digits) + tail), int(digits)


def file_number(frame, volume):
    """Number of the file at a frame, or None where Blender shows nothing. `volume` has mode (CLIP, EXTEND, REPEAT,
    PING_PONG), duration, start and offset, as Blender's volume does."""
    duration = volume["duration"]
    if duration < 1:
        return None
    place = int(frame) - volume["start"] + 1
    mode = volume["mode"]
    if mode == "CLIP":
        if not 1 <= place <= duration:
            return None
    elif mode == "REPEAT":
        place = (place - 1) % duration + 1
    elif mode == "PING_PONG":
        period = max(2 * duration - 2, 1)
        place = (place - 1) % period + 1
        if place > duration:
            place = 2 * duration - place
    else:
        place = max(1, min(place, duration))
    return place + volume["offset"]


def name_sequences(scenes, folder):
    """Makes files of meshes that change from frame to frame into sequences like NAME.####.ply."""
    files = {}
    for time, scene in scenes.items():
        for mesh in scene.get("mesh", []):
            if "file" in mesh:
                files.setdefault(mesh["name"], {})[time] = mesh["file"]
    for name, by_time in files.items():
        if len(set(by_time.values())) == 1:
            continue
        stem, ending = safe_name(name), os.path.splitext(next(iter(by_time.values())))[1]
        for time, file in by_time.items():
            shutil.copyfile(os.path.join(folder, file), os.path.join(folder, f"{stem}.{int(time):04d}{ending}"))
        for scene in scenes.values():
            for mesh in scene.get("mesh", []):
                if mesh["name"] == name:
                    mesh["file"] = f"{stem}.####{ending}"
