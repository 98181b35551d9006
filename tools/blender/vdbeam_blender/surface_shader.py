"""From surface shaders to the material of a [[mesh]]."""
import math

from . import glow, nodes, notes as notes_module, surface_maps

TEXTURES = "Base Color", "Color"
WITH_OPACITY = {"diffuse", "standard", "conductor", "holdout"}
TINT = "tint"  # no key of vdbeam's: the colour of glass until its mesh is known


def with_texture(node, keys, notes, subject, image_path):
    """Adds albedo or texture of a diffuse surface."""
    behind = nodes.source(nodes.socket(node, *TEXTURES))
    if behind is not None and behind.type == "TEX_IMAGE" and behind.image is not None:
        path = image_path(behind.image)
        if path is not None:
            return {**keys, "texture": path, "albedo": [1.0] * 3}
        notes.add(subject, f"its texture is left out, {notes_module.NO_IMAGE}; the albedo 0.5 is used")
        return {**keys, "albedo": [0.5] * 3}
    return {**keys, "albedo": clipped(nodes.constant_colour(node, notes, subject, *TEXTURES))}


def clipped(colour):
    """A reflectance within [0, 1]."""
    return [max(0.0, min(1.0, value)) for value in colour]


def emission(colour, strength):
    """An emissive surface."""
    return {"type": "emissive", "radiance": [max(value, 0.0) * strength for value in colour], "two_sided": True}


def glass(node, notes, subject):
    """A smooth or frosted dielectric."""
    tint = clipped(nodes.constant_colour(node, notes, subject, *TEXTURES))
    # The colour counts at each surface here, inside there: tinted_inside knows how far light goes.
    keys = {TINT: tint} if min(tint) < 0.95 else {}
    return {**keys, "type": "dielectric", "ior": nodes.constant_number(node, notes, subject, "IOR", default=1.5),
            "roughness": nodes.constant_number(node, notes, subject, "Roughness")}


def tinted_inside(keys, chord, notes, subject):
    """The material with the colour of its glass as absorption: a ray through two surfaces of the colour c has c^2,
    which the mean chord has too, 0 for a mesh that is not closed."""
    tint = keys.get(TINT)
    if tint is None:
        return keys
    plain = {name: value for name, value in keys.items() if name != TINT}
    if chord <= 0:
        notes.add(subject, "the colour of glass has no counterpart where its mesh is not closed; it is left out")
        return plain
    notes.add(subject, "the colour of glass is exported as absorption inside, which grows with the way of the light")
    return {**plain, "absorption": [-2 * math.log(max(value, 1e-3)) / chord for value in tint]}


def metal(node, notes, subject):
    """A conductor."""
    return {"type": "conductor", "reflectance": clipped(nodes.constant_colour(node, notes, subject, *TEXTURES)),
            "roughness": nodes.constant_number(node, notes, subject, "Roughness")}


def gloss_ior(node, notes, subject):
    """The index of refraction with the reflectance of a Principled BSDF's gloss straight on; 1: it has none. Blender 4
    scales that of IOR by twice the level, earlier versions have 0.08 of Specular."""
    if nodes.socket(node, "Specular IOR Level") is not None:
        ior = nodes.constant_number(node, notes, subject, "IOR", default=1.5)
        level = nodes.constant_number(node, notes, subject, "Specular IOR Level")
        reflectance = ((ior - 1) / (ior + 1)) ** 2 * 2 * level
    else:
        reflectance = 0.08 * nodes.constant_number(node, notes, subject, "Specular")
    root = math.sqrt(max(0.0, min(0.65, reflectance)))
    return round((1 + root) / (1 - root), 6)


def principled(node, notes, subject, image_path):
    """A Principled BSDF: its surface, with what it emits, until glow.py chooses between them."""
    surface = principled_surface(node, notes, subject, image_path)
    colour = nodes.constant_colour(node, notes, subject, "Emission Color", "Emission")
    strength = nodes.constant_number(node, notes, subject, "Emission Strength", default=1.0)
    if strength * max(colour) > 0:
        return {**surface, glow.GLOW: {"radiance": emission(colour, strength)["radiance"], "subject": subject}}
    return surface


def principled_surface(node, notes, subject, image_path):
    """A Principled BSDF without its emission: glass or a standard surface."""
    transmission = nodes.constant_number(node, notes, subject, "Transmission Weight", "Transmission")
    metal_keys = surface_maps.number(node, "metal", notes, subject, image_path, "Metallic")
    metallic = metal_keys["metal"]
    if 0.01 < transmission < 0.99:
        notes.add(subject, f"a transmission of {transmission:.2g} has no counterpart; it is rounded to 0 or 1")
    if transmission > 0.5 and metallic < 0.5:
        return {**glass(node, notes, subject), **surface_maps.normal(node, notes, subject, image_path)}
    ior = gloss_ior(node, notes, subject)
    coat = nodes.constant_number(node, notes, subject, "Coat Weight", "Clearcoat")
    more = {**surface_maps.opacity(node, "Alpha", notes, subject, image_path),
            **surface_maps.normal(node, notes, subject, image_path)}
    if ior == 1 and metallic == 0 and "metal_texture" not in metal_keys and coat == 0:
        return with_texture(node, {"type": "diffuse", **more}, notes, subject, image_path)
    keys = {"type": "standard", **metal_keys, "ior": ior,
            **surface_maps.number(node, "roughness", notes, subject, image_path, "Roughness", default=0.5), **more}
    if coat > 0:
        keys["coat"] = min(1.0, coat)
        keys["coat_roughness"] = max(0.0, min(1.0, nodes.constant_number(
            node, notes, subject, "Coat Roughness", "Clearcoat Roughness")))
    return with_texture(node, keys, notes, subject, image_path)


def cut_out(node, notes, subject, image_path):
    """A mixture of a surface and nothing, as leaves have it; None for another mixture."""
    factor, *sides = node.inputs
    shaders = [nodes.source(side) for side in sides[:2]]
    for i, shader in enumerate(shaders):
        if shader is None or shader.type != "BSDF_TRANSPARENT" or shaders[1 - i] is None:
            continue
        keys = surface_keys(shaders[1 - i], notes, subject, image_path)
        share = surface_maps.opacity(node, factor.name, notes, subject, image_path)
        if i == 1:  # the factor is the share of nothing
            if "opacity_texture" in share:
                notes.add(subject, "an image of transparency has no counterpart, only one of opacity; it is left out")
                return keys
            share = {"opacity": 1 - share.get("opacity", 1.0)}
        if share and keys is not None and keys["type"] not in WITH_OPACITY:
            notes.add(subject, f"the opacity of a surface of the type {keys['type']} has no counterpart; it is left "
                               "out")
            return keys
        return None if keys is None else {**keys, **share}
    return None


def surface_keys(node, notes, subject, image_path):
    """Keys of the material; None for a surface that is not there (transparent, or without a shader)."""
    if node is None or node.type == "BSDF_TRANSPARENT":
        return None
    if node.type == "BSDF_PRINCIPLED":
        return principled(node, notes, subject, image_path)
    if node.type == "BSDF_DIFFUSE":
        return with_texture(node, {"type": "diffuse", **surface_maps.normal(node, notes, subject, image_path)}, notes,
                            subject, image_path)
    if node.type in ("BSDF_GLOSSY", "BSDF_ANISOTROPIC"):
        return metal(node, notes, subject)
    if node.type == "BSDF_GLASS":
        return glass(node, notes, subject)
    if node.type == "EMISSION":
        return emission(nodes.constant_colour(node, notes, subject, "Color"),
                        nodes.constant_number(node, notes, subject, "Strength", default=1.0))
    if node.type == "MIX_SHADER" and (keys := cut_out(node, notes, subject, image_path)) is not None:
        return keys
    if node.type == "HOLDOUT":
        return {"type": "holdout"}
    notes.add(subject, f"the shader {node.bl_label} has no counterpart; the surface is matt grey")
    return {"type": "diffuse", "albedo": [0.5] * 3}
