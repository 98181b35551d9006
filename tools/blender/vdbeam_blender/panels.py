"""The panel of the engine's settings, and the preferences of the add-on."""
import bpy

from . import engine

# Panels of Blender that describe what the engine reads, by the engine that owns them.
SHARED_WITH = {"BLENDER_RENDER", "BLENDER_EEVEE", "BLENDER_EEVEE_NEXT"}
# Panels of these engines about what the engine does not read.
NOT_SHARED = {"RENDER_PT_simplify", "RENDER_PT_gpencil", "DATA_PT_EEVEE_light_distance", "DATA_PT_EEVEE_shadow",
              "DATA_PT_EEVEE_shadow_contact", "DATA_PT_EEVEE_shadow_cascaded_shadow_map",
              "VIEWLAYER_PT_eevee_layer_passes_data", "VIEWLAYER_PT_eevee_next_layer_passes_data",
              "VIEWLAYER_PT_eevee_layer_passes_light", "VIEWLAYER_PT_eevee_layer_passes_effects",
              "VIEWLAYER_PT_layer_passes_cryptomatte"}
# Panels of Cycles that Blender itself defines.
ALSO_SHARED = ("VIEWLAYER_PT_layer_passes_lightgroups",)
PASSES = ("use_pass_z", "use_pass_position", "use_pass_vector", "use_pass_emit", "use_pass_environment",
          "use_pass_cryptomatte_object")


class VdbeamPreferences(bpy.types.AddonPreferences):
    """Preferences of the add-on."""

    bl_idname = engine.PACKAGE

    program: bpy.props.StringProperty(name="Program", subtype="FILE_PATH",
                                      description="Path of vdbeam; empty: found on the PATH")

    def draw(self, _context):
        """Draws the preferences."""
        self.layout.prop(self, "program")


class OwnPanel:
    """A panel of the properties editor that is there with this engine only."""

    bl_label = "vdbeam"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {"VDBEAM"}

    @classmethod
    def poll(cls, context):
        """Shows the panel with this engine only."""
        return context.engine in cls.COMPAT_ENGINES


class VDBEAM_PT_settings(OwnPanel, bpy.types.Panel):
    """The ten settings."""

    bl_context = "render"

    def draw(self, context):
        """Draws the panel."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        own = context.scene.vdbeam
        for group in (("estimator",), ("passes", "time_limit", "target_error"), ("clamp", "seed"),
                      ("interpolation", "missing"), ("volume_layers", "update_interval")):
            column = layout.column(align=True)
            for name in group:
                column.prop(own, name)
        layout.operator("vdbeam.write_farm_job", icon="FILE_SCRIPT")


class VDBEAM_PT_passes(OwnPanel, bpy.types.Panel):
    """The passes of a view layer."""

    bl_context = "view_layer"
    bl_parent_id = "VIEWLAYER_PT_layer_passes"

    def draw(self, context):
        """Draws the panel."""
        layout, layer = self.layout, context.view_layer
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column(heading="Include")
        for name in PASSES:
            column.prop(layer, name)
        column.prop(context.scene.vdbeam, "volume_layers")
        for name in ("denoising_data", "error"):
            column.prop(layer.vdbeam, name)


def shared_panels():
    """Panels of Blender that the engine shows too."""
    panels = []
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines and engines & SHARED_WITH and panel.__name__ not in NOT_SHARED:
            panels.append(panel)
    return panels + [getattr(bpy.types, name) for name in ALSO_SHARED if hasattr(bpy.types, name)]


def register_panels():
    """Lets shared panels appear."""
    for panel in shared_panels():
        panel.COMPAT_ENGINES.add("VDBEAM")


def unregister_panels():
    """Takes back register_panels."""
    also = [getattr(bpy.types, name) for name in ALSO_SHARED if hasattr(bpy.types, name)]
    for panel in bpy.types.Panel.__subclasses__() + also:
        getattr(panel, "COMPAT_ENGINES", set()).discard("VDBEAM")
