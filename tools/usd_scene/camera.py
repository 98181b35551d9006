"""From UsdGeom.Camera to [camera]. USD's apertures and focal length are in tenths of a scene unit."""
from . import values

TENTHS = 0.1


def camera_keys(prim, time, settings, notes):
    """Keys of [camera] but its place."""
    aperture, film_height = settings.fit(values.number(prim, "horizontalAperture", time, 20.955),
                                         values.number(prim, "verticalAperture", time, 15.2908))
    if values.number(prim, "exposure", time, 0.0) != 0:
        notes.add(str(prim.GetPath()), "the exposure of a camera has no counterpart; scale the image in the comp")
    keys = {"shift_x": values.number(prim, "horizontalApertureOffset", time, 0.0) / aperture,
            "shift_y": values.number(prim, "verticalApertureOffset", time, 0.0) / film_height}
    near, far = values.value(prim, "clippingRange", time, (1.0, 1000000.0))
    keys["near"], keys["far"] = float(near), float(far)
    if values.value(prim, "projection", time, "perspective") == "orthographic":
        return {**keys, "projection": "orthographic", "view_height": TENTHS * film_height}
    focal = values.number(prim, "focalLength", time, 50.0)
    keys["focal_length"], keys["film_width"] = focal, aperture
    f_stop = values.number(prim, "fStop", time, 0.0)
    distance = values.number(prim, "focusDistance", time, 0.0)
    if f_stop > 0 and distance > 0 and settings.depth_of_field:
        keys["lens_radius"], keys["focus_distance"] = TENTHS * focal / (2 * f_stop), distance
    return keys


def shutter_keys(prim, time, settings):
    """Opening and closing of the shutter, in frames."""
    begin = values.number(prim, "shutter:open", time, 0.0)
    end = values.number(prim, "shutter:close", time, 0.0)
    return {"shutter_open": begin, "shutter_close": end} if end > begin and settings.motion_blur else {}
