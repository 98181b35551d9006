"""From the world's nodes to [[light]]: a constant colour, an environment image, a clear sky."""
import math

from . import nodes, notes as notes_module, volume_shader

# Irradiance of the sun above the air, and optical depth of haze at a dust density of 1, with which an atmosphere has
# the sunlight and the skylight of Cycles' Nishita sky at the strength 1. Fitted at elevations of 17, 46 and 80 degrees;
# the luminance of sunlight is within 5 % there, that of skylight within 8 %.
NISHITA_SUN = 153.0
NISHITA_HAZE = 0.027


def turn_of(texture, notes, subject):
    """Rotation of an image about Z [degrees], by a Mapping node."""
    mapping = nodes.source(nodes.socket(texture, "Vector"))
    if mapping is None or mapping.type != "MAPPING":
        if mapping is not None and mapping.type != "TEX_COORD":
            notes.add(subject, f"the {mapping.bl_label} node of the image's coordinates has no counterpart")
        return 0.0
    x, y, z = nodes.socket(mapping, "Rotation").default_value[:3]
    if abs(x) > 1e-6 or abs(y) > 1e-6:
        notes.add(subject, "the environment image is turned about Z only")
    angle = math.degrees(z)
    return angle if mapping.vector_type == "TEXTURE" else -angle


def picture(texture, strength, notes, subject, image_path):
    """An environment image. Blender's middle is at +X, vdbeam's first column at +Y."""
    if texture.projection != "EQUIRECTANGULAR":
        notes.add(subject, "a mirror-ball image has no counterpart and is left out")
        return []
    path = image_path(texture.image)
    if path is None:
        notes.add(subject, f"its image is left out, {notes_module.NO_IMAGE}")
        return []
    return [{"type": "environment", "image": path, "radiance": [strength] * 3,
             "rotation": 90.0 + turn_of(texture, notes, subject)}]


def sky(texture, strength, notes, subject):
    """A Nishita sky, as an atmosphere with its sun; nothing for the older skies."""
    if texture.sky_type not in ("NISHITA", "SINGLE_SCATTERING", "MULTIPLE_SCATTERING"):
        notes.add(subject, f"the sky {texture.sky_type} has no counterpart; use Nishita")
        return []
    elevation, azimuth = texture.sun_elevation, texture.sun_rotation  # azimuth from +Y to +X
    away = [-math.cos(elevation) * math.sin(azimuth), -math.cos(elevation) * math.cos(azimuth), -math.sin(elevation)]
    dust = getattr(texture, "dust_density", getattr(texture, "aerosol_density", 1.0))
    if abs(texture.air_density - 1) > 1e-3 or abs(texture.ozone_density - 1) > 1e-3:
        notes.add(subject, "the densities of air and ozone have no counterpart; those of the earth are used")
    # Nishita's sky has no light from the ground.
    air = {"direction": away, "aerosol": min(NISHITA_HAZE * dust, 5.0),
           "altitude": max(0.0, min(texture.altitude, 50000.0))}
    lights = [{"type": "atmosphere", **air, "irradiance": [NISHITA_SUN * strength] * 3, "ground_albedo": 0.0,
               "sun": False}]
    if texture.sun_disc and texture.sun_intensity > 0:
        lights.append({"type": "sun", **air, "irradiance": [NISHITA_SUN * strength * texture.sun_intensity] * 3})
    return lights


def constant(colour):
    """A constant environment, unless it is black."""
    return [{"type": "environment", "radiance": colour}] if max(colour) > 0 else []


# Half an edge of the box of a world's volume, in mean free paths of the channel with the longest: light from outside of
# it counts less than what a float holds of that from inside.
FAR_AWAY = 15.0


def world_volume(world, place, notes):
    """The [[volume]] of a world's volume, about a place; None without one. Cycles' fills all space, so that nothing of
    the background and of suns comes through; here it is a box beyond whose edges that is so."""
    if world is None or not world.use_nodes:
        return None
    shader = nodes.shader_of(world.node_tree, "OUTPUT_WORLD", "Volume")
    keys = volume_shader.volume_keys(shader, notes, world.name) if shader is not None else None
    if keys is None or keys["extinction"] <= 0:
        return None
    if keys.pop("density") or keys.pop("emission", None):
        notes.add(world.name, "grids and emission of the world's volume have no counterpart; it is homogeneous")
    keys.pop("mask", None)
    keys.pop("color_grid", None)
    thinnest = min(value for value in keys["extinction_scale"] if value > 0) * keys["extinction"]
    half = FAR_AWAY / thinnest
    lower, upper = ([value + side * half for value in place] for side in (-1, 1))
    return {"name": world.name, "shape": "box", "box_lower": lower, "box_upper": upper, **keys}


def world_lights(world, notes, image_path):
    """The world's [[light]] tables. `image_path` gives the file of an image, or None."""
    if world is None:
        return []
    if not world.use_nodes:
        return constant([float(value) for value in world.color])
    shader = nodes.shader_of(world.node_tree, "OUTPUT_WORLD", "Surface")
    if shader is None:
        return []
    if shader.type != "BACKGROUND":
        notes.add(world.name, f"the shader {shader.bl_label} has no counterpart; use Background")
        return []
    strength = nodes.constant_number(shader, notes, world.name, "Strength", default=1.0)
    texture = nodes.source(nodes.socket(shader, "Color"))
    if strength <= 0:
        return []
    if texture is not None and texture.type == "TEX_ENVIRONMENT" and texture.image is not None:
        return picture(texture, strength, notes, world.name, image_path)
    if texture is not None and texture.type == "TEX_SKY":
        return sky(texture, strength, notes, world.name)
    return constant([strength * value for value in nodes.constant_colour(shader, notes, world.name, "Color")])
