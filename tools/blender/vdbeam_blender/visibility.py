"""Visibility of objects and worlds to single kinds of rays, as Cycles has it. vdbeam knows that to the camera alone."""

KINDS = {"visible_diffuse": "diffuse rays", "visible_glossy": "glossy rays", "visible_transmission": "transmission rays",
         "visible_volume_scatter": "volume rays", "visible_shadow": "shadow rays"}
WORLD_KINDS = {"diffuse": "diffuse rays", "glossy": "glossy rays", "transmission": "transmission rays",
               "scatter": "volume rays"}


def note_hidden(thing, name, kinds, notes):
    """Notes the rays from which Cycles hides an object or a world."""
    hidden = [text for key, text in kinds.items() if getattr(thing, key, True) is False]
    if hidden:
        notes.add(name, f"Cycles hides it from {', '.join(hidden)}, which has no counterpart")


def note_object(obj, name, notes):
    """Notes the rays from which an object is hidden, and its hair, which is not exported."""
    note_hidden(obj, name, KINDS, notes)
    if any(system.settings.type == "HAIR" and system.settings.render_type == "PATH"
           for system in getattr(obj, "particle_systems", [])):
        notes.add(name, "hair has no counterpart and is left out")


def is_holdout(obj, view_layer):
    """Whether a collection of the view layer makes an object a holdout; the object's own setting is its material's."""
    return bool(obj.original.holdout_get(view_layer=view_layer))


def is_seen(obj, view_layer):
    """Whether the camera sees an object: neither it nor a collection of the view layer hides it."""
    return bool(obj.visible_camera) and not obj.original.indirect_only_get(view_layer=view_layer)


def show_world(world, lights, notes):
    """Sets `visible` of a world's lights by its ray visibility."""
    rays = getattr(world, "cycles_visibility", None)
    if rays is None or not lights:
        return
    note_hidden(rays, world.name, WORLD_KINDS, notes)
    if getattr(rays, "camera", True) is False:
        for light in lights:
            light["visible"] = False


def note_scene(scene, notes):
    """Notes what Cycles does to the finished image."""
    exposure = getattr(getattr(scene, "cycles", None), "film_exposure", 1.0)
    if abs(exposure - 1) > 1e-6:
        notes.add(scene.name, "the exposure of Cycles' film has no counterpart; use that of the color management")
