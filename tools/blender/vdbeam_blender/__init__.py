"""vdbeam for Blender: a render engine for clouds, smoke and fire. docs/how-to/blender.md describes its use.

Modules without bpy (all but engine, view_engine, farm, panels, settings and this one) can be imported by any Python with NumPy.
"""

bl_info = {
    "name": "vdbeam",
    "description": "Renders OpenVDB clouds, smoke and fire by photon mapping and path tracing",
    "author": "the vdbeam authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Render Engine",
    "category": "Render",
}


def classes():
    """Everything that Blender registers, in order."""
    from . import engine, farm, panels, settings
    return [settings.VdbeamSettings, settings.VdbeamLayerSettings, panels.VdbeamPreferences, engine.VdbeamRenderEngine,
            panels.VDBEAM_PT_settings, panels.VDBEAM_PT_passes, farm.VDBEAM_OT_write_farm_job]


def register():
    """Switches the add-on on."""
    import bpy

    from . import panels, settings
    for one in classes():
        bpy.utils.register_class(one)
    bpy.types.Scene.vdbeam = bpy.props.PointerProperty(type=settings.VdbeamSettings)
    bpy.types.ViewLayer.vdbeam = bpy.props.PointerProperty(type=settings.VdbeamLayerSettings)
    panels.register_panels()


def unregister():
    """Switches the add-on off."""
    import bpy

    from . import panels
    panels.unregister_panels()
    del bpy.types.Scene.vdbeam
    del bpy.types.ViewLayer.vdbeam
    for one in reversed(classes()):
        bpy.utils.unregister_class(one)
