"""Defines the ten settings of the panel and writes them as options of the command line."""
import bpy

MISSING = [("hold", "Hold", "Show the previous file"), ("error", "Error", "The frame fails"),
           ("black", "Black", "The frame is black")]
ESTIMATORS = [("auto", "Automatic", "gather, beam or path: the one with the smallest predicted error"),
              ("gather", "Final gathering", "Photons, gathered at the ends of short random walks"),
              ("beam", "Beam", "Photons, gathered along camera rays"),
              ("path", "Path tracing", "Unbiased path tracing, the reference")]


def update_passes(_settings, context):
    """Lets the compositor know that the passes have changed."""
    context.view_layer.update_render_passes()


class VdbeamSettings(bpy.types.PropertyGroup):
    """Settings of a scene, scene.vdbeam."""

    estimator: bpy.props.EnumProperty(name="Estimator", items=ESTIMATORS, default="auto",
                                      description="Rendering method")
    passes: bpy.props.IntProperty(name="Passes", default=32, min=1, max=100000,
                                  description="Number of passes; the other limits may end a frame earlier")
    time_limit: bpy.props.FloatProperty(name="Time Limit", default=0, min=0, unit="TIME_ABSOLUTE", subtype="TIME",
                                        description="Time limit of a frame in seconds; 0: none")
    target_error: bpy.props.FloatProperty(name="Target Error", default=0, min=0, precision=5,
                                          description="Stop at this estimated error (MRSE), e.g. 0.001; 0: never")
    clamp: bpy.props.FloatProperty(name="Clamp", default=0, min=0,
                                   description="Greatest radiance that the medium may add to a pixel in one pass; 0: "
                                               "none")
    seed: bpy.props.IntProperty(name="Seed", default=1, min=0, description="Seed of the random numbers")
    interpolation: bpy.props.EnumProperty(
        name="Interpolation", default="linear", description="Interpolation between voxels",
        items=[("linear", "Linear", ""), ("cubic", "Cubic", "Smooth, with ten times the memory")])
    missing: bpy.props.EnumProperty(name="Missing Files", items=MISSING, default="hold",
                                    description="What a frame does whose VDB file is missing")
    volume_layers: bpy.props.BoolProperty(name="Volume Layers", default=False, update=update_passes,
                                          description="Also write single and multiple scattering of the volumes as the "
                                                      "passes VolumeDir and VolumeInd")
    update_interval: bpy.props.FloatProperty(name="Update Interval", default=1, min=0.1, max=600, subtype="TIME",
                                             unit="TIME_ABSOLUTE", description="Seconds between images in the editor")


class VdbeamLayerSettings(bpy.types.PropertyGroup):
    """Passes of a view layer that Blender has no setting for, view_layer.vdbeam."""

    denoising_data: bpy.props.BoolProperty(name="Denoising Data", default=False, update=update_passes,
                                           description="Also write normals and albedo for a denoiser")
    error: bpy.props.BoolProperty(name="Error", default=False, update=update_passes,
                                  description="Also write the standard error of each pixel")


def render_keys(settings):
    """Keys of [render]."""
    keys = {"estimator": settings.estimator, "passes": settings.passes, "seed": settings.seed}
    for name, value in (("time", settings.time_limit), ("target_error", settings.target_error),
                        ("clamp", settings.clamp)):
        if value > 0:
            keys[name] = float(value)
    return keys


def viewport_keys(settings):
    """Keys of [render] for a viewport, which renders for longer than a frame may take."""
    return {name: value for name, value in render_keys(settings).items() if name != "time"}


def wanted_passes(scene, view_layer):
    """Options of layers.passes that the view layer asks for, by its settings, by ours and by those of Cycles, and its
    light groups."""
    wanted = {option for option, name in (("depth", "use_pass_z"), ("position", "use_pass_position"),
                                          ("vector", "use_pass_vector"), ("emit", "use_pass_emit"),
                                          ("environment", "use_pass_environment"),
                                          ("cryptomatte", "use_pass_cryptomatte_object"))
              if getattr(view_layer, name, False)}
    own, cycles = view_layer.vdbeam, getattr(view_layer, "cycles", None)
    if scene.vdbeam.volume_layers or any(getattr(cycles, f"use_pass_volume_{part}", False)
                                         for part in ("direct", "indirect")):
        wanted.add("volume")
    if own.denoising_data or getattr(cycles, "denoising_store_passes", False):
        wanted.add("denoising")
    if own.error:
        wanted.add("error")
    return wanted, [group.name for group in getattr(view_layer, "lightgroups", [])]
