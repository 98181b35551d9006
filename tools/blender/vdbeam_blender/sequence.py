"""Which file of a VDB sequence a frame shows, by Blender's rules for volume objects."""
import os
import re


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
