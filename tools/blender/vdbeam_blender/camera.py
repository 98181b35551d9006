"""From Blender's camera to [camera]. Sizes of the sensor are in mm, angles in radians, lengths in scene units."""
import math


def is_horizontal(facts):
    """Whether the sensor spans the image's width rather than its height."""
    if facts["sensor_fit"] == "AUTO":
        return facts["width"] * facts["pixel_aspect"] >= facts["height"]
    return facts["sensor_fit"] == "HORIZONTAL"


def lens_keys(facts):
    """Field of view, shift and projection."""
    across, up = facts["width"] * facts["pixel_aspect"], facts["height"]
    horizontal = is_horizontal(facts)
    span = across if horizontal else up  # what the sensor, the ortho scale and the shift refer to
    keys = {"shift_x": facts["shift_x"] * span / across, "shift_y": facts["shift_y"] * span / up}
    if facts["type"] == "ORTHO":
        return {**keys, "projection": "orthographic", "view_height": facts["ortho_scale"] * up / span}
    if facts["type"] == "PANO":
        return {"projection": "panorama"}
    sensor = facts["sensor_height"] if facts["sensor_fit"] == "VERTICAL" else facts["sensor_width"]
    half = math.atan(sensor * up / span / 2 / facts["lens"])
    return {**keys, "fov": math.degrees(2 * half)}


def focus_keys(facts):
    """The thin lens of depth of field."""
    if not facts["use_dof"] or facts["type"] == "PANO" or facts["fstop"] <= 0:
        return {}
    focal = 1e-3 * facts["lens"] if facts["type"] == "PERSP" else 1.0  # as Cycles has it
    keys = {"lens_radius": focal / (2 * facts["fstop"]), "focus_distance": max(facts["focus_distance"], 1e-6)}
    if facts["blades"] >= 3:
        keys["blades"] = facts["blades"]
        keys["blade_angle"] = math.degrees(facts["blade_angle"])
    return keys


def camera_keys(facts):
    """Keys of [camera] but its place, which is a matrix: a file has it at every time."""
    keys = {"up": [0.0, 0.0, 1.0], **lens_keys(facts), **focus_keys(facts)}
    if facts["type"] != "PANO":
        keys["near"] = facts["near"]
        keys["far"] = facts["far"]
    return keys


def shutter(position, length):
    """(open, close) in frames relative to the frame, for Blender's position START, CENTER or END."""
    begin = {"START": 0.0, "CENTER": -length / 2, "END": -length}[position]
    return begin, begin + length


def unscaled(matrix):
    """The camera's matrix without the scale of its parents: 4 rows."""
    lengths = [math.sqrt(sum(matrix[row][column] ** 2 for row in range(3))) or 1.0 for column in range(3)]
    rows = [[matrix[row][column] / lengths[column] for column in range(3)] + [matrix[row][3]] for row in range(3)]
    return rows + [[0.0, 0.0, 0.0, 1.0]]


def matrix_lines(matrices):
    """The camera's file: {time: matrix} as lines of the time and 16 numbers."""
    lines = []
    for time in sorted(matrices):
        rows = unscaled(matrices[time])
        lines.append(" ".join(f"{value:.9g}" for value in [time, *(value for row in rows for value in row)]))
    return "\n".join(lines) + "\n"
