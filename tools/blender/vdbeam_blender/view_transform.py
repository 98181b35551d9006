"""From Blender's color management to the options of previews. Nothing here imports bpy."""
import math

VIEWS = {"Filmic": "filmic", "AgX": "filmic", "Standard": "srgb", "Raw": "srgb"}
SAME = {"Filmic", "Standard"}  # those that have a counterpart


def view_words(settings, notes):
    """--view and --exposure of a scene's view settings; what has no counterpart is noted."""
    name = settings.view_transform
    view = VIEWS.get(name, "filmic")
    if name not in SAME:
        notes.add("previews", f"the view transform {name} has no counterpart; {view} is used")
    if settings.look not in ("", "None"):
        notes.add("previews", f"the look {settings.look} has no counterpart and is left out")
    if not math.isclose(settings.gamma, 1.0, abs_tol=1e-6):
        notes.add("previews", f"the gamma {settings.gamma:.3g} has no counterpart and is left out")
    if settings.use_curve_mapping:
        notes.add("previews", "the curves of the color management have no counterpart and are left out")
    exposure = [] if abs(settings.exposure) < 1e-6 else [f"--exposure={settings.exposure:.6g}"]
    return [f"--view={view}", *exposure]
