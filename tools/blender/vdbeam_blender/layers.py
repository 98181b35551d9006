"""Which of vdbeam's layers become which of Blender's passes."""
import numpy


class Pass:
    """A pass of Blender with the channels of vdbeam that fill it."""

    def __init__(self, name, letters, kind, layer, channels):
        self.name = name
        self.letters = letters  # Blender's channels, e.g. "RGBA"
        self.kind = kind  # COLOR, VALUE or VECTOR
        self.layer = layer  # name in [[layer]]; "" for none
        self.channels = channels  # (channel of the EXR, factor) for each letter


def plain(layer, letters):
    """Channels of a layer, as they are."""
    return [(f"{layer}.{letter}", 1.0) for letter in letters]


def colour(name, layer):
    """A pass with the colours of a layer."""
    return Pass(name, "RGB", "COLOR", layer, plain(layer, "RGB"))


REST = "rest"  # vdbeam's name for the lights without a group
COMBINED = Pass("Combined", "RGBA", "COLOR", "alpha", [(letter, 1.0) for letter in "RGBA"])
# By the option that asks for it; keys are those of `wanted`.
OPTIONAL = {
    "depth": [Pass("Depth", "Z", "VALUE", "depth", [("depth.Z", 1.0)])],
    "position": [Pass("Position", "XYZ", "VECTOR", "position", plain("position", "XYZ"))],
    # Blender's vectors point back in time, from this frame and to it; both are those of a steady motion.
    "vector": [Pass("Vector", "XYZW", "VECTOR", "motion",
                    [("motion.X", -1.0), ("motion.Y", -1.0), ("motion.X", -1.0), ("motion.Y", -1.0)])],
    "emit": [colour("Emit", "volume_emission")],
    "environment": [colour("Env", "background")],
    "volume": [colour("VolumeDir", "volume_direct"), colour("VolumeInd", "volume_indirect")],
    # Their names in Cycles, which templates of compositors expect.
    "denoising": [Pass("Denoising Normal", "XYZ", "VECTOR", "denoising_normal", plain("denoising_normal", "XYZ")),
                  colour("Denoising Albedo", "denoising_albedo")],
    "error": [colour("Error", "error")],
    "cryptomatte": [Pass(f"CryptoObject{index:02d}", "RGBA", "COLOR", "cryptomatte" if index == 0 else "",
                         plain(f"CryptoObject{index:02d}", "RGBA")) for index in range(3)],
}

# Passes of Blender without a counterpart, by the property of the view layer, and of its settings of Cycles.
UNMATCHED = {"use_pass_mist": "Mist", "use_pass_uv": "UV", "use_pass_object_index": "Object Index",
             "use_pass_material_index": "Material Index", "use_pass_shadow": "Shadow",
             "use_pass_ambient_occlusion": "Ambient Occlusion", "use_pass_cryptomatte_material": "Cryptomatte Material",
             "use_pass_cryptomatte_asset": "Cryptomatte Asset",
             **{f"use_pass_{kind}_{part}": f"{kind.title()} {part.title()}"
                for kind in ("diffuse", "glossy", "transmission", "subsurface")
                for part in ("direct", "indirect", "color")}}
UNMATCHED_OF_CYCLES = {"use_pass_shadow_catcher": "Shadow Catcher", "pass_debug_sample_count": "Sample Count"}


def note_unmatched(view_layer, notes):
    """Notes the passes that a view layer asks for and does not get."""
    cycles = getattr(view_layer, "cycles", None)
    names = [name for owner, known in ((view_layer, UNMATCHED), (cycles, UNMATCHED_OF_CYCLES))
             for key, name in known.items() if getattr(owner, key, False)]
    names += [one.name for one in getattr(view_layer, "aovs", [])]
    if names:
        notes.add(view_layer.name, f"the passes {', '.join(names)} have no counterpart and are left out")
    if getattr(view_layer, "use_pass_normal", False):
        notes.add(view_layer.name, "the pass Normal has no counterpart and is left out; Denoising Data has normals")


def passes(wanted, groups=()):
    """The passes of a view layer: Combined, those of the options in `wanted`, one for each light group and
    one for the lights without."""
    chosen = [COMBINED]
    for option, several in OPTIONAL.items():
        if option in wanted:
            chosen += several
    if groups:  # and what belongs to none of them
        names = [*groups, *([] if REST in groups else [REST])]
        chosen = chosen + [Pass(f"Combined_{name}", "RGB", "COLOR", "" if index else "lights",
                                plain(f"light_{name}", "RGB")) for index, name in enumerate(names)]
    return chosen


def layer_tables(chosen):
    """The [[layer]] tables of the scene file."""
    return [{"name": one.layer} for one in chosen if one.layer]


def planes_for_blender(planes, chosen, view_layer, opaque=False):
    """Channels by the names under which Blender's result loads them; a layer that is empty is 0. `opaque`: the world
    is part of the image, and alpha is 1; vdbeam's is the opacity of what is in front of it."""
    height, width = next(iter(planes.values())).shape
    empty = numpy.zeros((height, width), numpy.float32)
    result = {}
    for one in chosen:
        for letter, (channel, factor) in zip(one.letters, one.channels):
            plane = planes.get(channel, empty)
            result[f"{view_layer}.{one.name}.{letter}"] = plane if factor == 1 else plane * factor
    if opaque:
        result[f"{view_layer}.Combined.A"] = numpy.ones((height, width), numpy.float32)
    return result
