"""Writes scenes: of one frame for the render engine, of a range of frames for a farm."""
import math
import os

from . import animate, camera, notes as notes_module, read_scene, sequence, toml_text

MOMENTS = 5  # times at which a shutter's motion is read


def shutter_of(scene):
    """(open, close) of a scene with motion blur, else None."""
    if not scene.render.use_motion_blur:
        return None
    position = getattr(scene.render, "motion_blur_position", None)
    if position is None:
        position = getattr(getattr(scene, "cycles", None), "motion_blur_position", "CENTER")
    return camera.shutter(position, scene.render.motion_blur_shutter)


def moments(frame, blur):
    """Times at which a frame is read: its own, and with an open shutter some while it is open."""
    if not blur:
        return [float(frame)]
    step = (blur[1] - blur[0]) / (MOMENTS - 1)
    return sorted({float(frame), *(frame + blur[0] + step * index for index in range(MOMENTS))})


def write_scene(options, times, go_to, comments=()):
    """Writes scene.toml and its files into the options' folder, and returns the notes. `go_to` takes a time and
    returns the evaluated scene there. Throws ValueError for a scene that cannot be rendered."""
    notes = notes_module.Notes()
    reader = read_scene.SceneReader(options, notes)
    scenes = {time: reader.read(go_to(time), time) for time in times}
    if options.sequence:
        sequence.name_sequences(scenes, options.folder)
    merged = animate.merge(scenes, notes)
    read_scene.write_camera(options.folder, reader.matrices)
    with open(os.path.join(options.folder, "scene.toml"), "w", encoding="utf-8") as file:
        file.write(toml_text.scene_text(merged, comments))
    return notes.lines


def split_time(time):
    """(frame, subframe) of a time, as Blender sets it."""
    frame = math.floor(time)
    return frame, time - frame
