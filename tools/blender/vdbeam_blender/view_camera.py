"""From the view of a 3D viewport to [camera] and [image]. Matrices are rows, in Blender's conventions."""
import math

from . import camera

MOST_PIXELS = 2**23  # of a viewport, beyond which pixels are made larger


def image_size(width, height, pixel_size):
    """Width and height of the image of a region, whose pixels are this many of the screen's wide."""
    size = max(1, pixel_size)
    while (width // size) * (height // size) > MOST_PIXELS:
        size += 1
    return max(1, round(width / size)), max(1, round(height / size))


def pixel_size(preview_pixel_size, interface_scale=1.0):
    """Pixels of the screen across one of the image, for Blender's setting AUTO, 1, 2, 4 or 8."""
    return max(1, round(interface_scale)) if preview_pixel_size == "AUTO" else int(preview_pixel_size)


def is_perspective(window):
    """Whether a projection is not parallel."""
    return abs(window[3][3]) < 0.5


def clip_ends(window):
    """Distances of the near and the far plane; of a parallel projection the near one may be negative."""
    if is_perspective(window):
        return window[2][3] / (window[2][2] - 1), window[2][3] / (window[2][2] + 1)
    return (window[2][3] + 1) / window[2][2], (window[2][3] - 1) / window[2][2]


def view_keys(window, width, height):
    """Keys of [camera] for a viewport's projection, and the pixel aspect of [image]."""
    near, far = clip_ends(window)
    keys = {"up": [0.0, 0.0, 1.0]}
    if is_perspective(window):
        keys["fov"] = math.degrees(2 * math.atan(1 / window[1][1]))
        keys["shift_x"], keys["shift_y"] = window[0][2] / 2, window[1][2] / 2
        keys["near"], keys["far"] = near, far
    else:
        keys["projection"] = "orthographic"
        keys["view_height"] = 2 / window[1][1]
        keys["shift_x"], keys["shift_y"] = -window[0][3] / 2, -window[1][3] / 2
        keys["near"], keys["far"] = 0.0, far - near  # from the place of `view_matrix`
    aspect = window[1][1] / window[0][0] * height / width
    return keys, aspect


def view_matrix(camera_to_world, window):
    """The camera's place: that of the viewer or, of a parallel projection, on the near plane, behind which Blender
    draws too."""
    rows = [list(row) for row in camera_to_world]
    if not is_perspective(window):
        near = clip_ends(window)[0]
        for row in rows[:3]:
            row[3] -= near * row[2]
    return rows


def tables(view):
    """([image], [camera], lines of the camera's file) of a view: its image's `size`, the matrices `window` and
    `camera_to_world`, and `lens`, further keys of [camera]."""
    width, height = view["size"]
    keys, aspect = view_keys(view["window"], width, height)
    image = {"width": width, "height": height}
    if abs(aspect - 1) > 1e-4:
        image["pixel_aspect"] = aspect
    lines = camera.matrix_lines({1.0: view_matrix(view["camera_to_world"], view["window"])})
    return image, {**keys, **view.get("lens", {})}, lines
