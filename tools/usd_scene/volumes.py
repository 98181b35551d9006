"""From UsdVol to [[volume]]. Grids are named by `fieldName` of their assets; relations of a volume only say what a grid
is for."""
from vdbeam_blender import sequence

from . import values

# What a relation field:NAME is for, by its name in lower case.
DENSITY = ("density",)
TEMPERATURE = ("temperature", "temp")
FLAME = ("flame", "flames", "fire", "heat", "burn", "emission", "fuel")
VELOCITY = ("velocity", "vel", "v")
COLOUR = ("cd", "color", "albedo", "diffuse")


def fields(prim, stage):
    """{relation's name in lower case: prim of the field}."""
    found = {}
    for relation in prim.GetRelationships():
        name = relation.GetName()
        if name.startswith("field:"):
            for target in relation.GetForwardedTargets():
                field = stage.GetPrimAtPath(target)
                if field and field.IsValid():
                    found[name[len("field:"):].lower()] = field
    return found


def file_keys(field, time):
    """`file` and, where the path has time samples, `time`."""
    path = values.asset(field, "filePath", time)
    if field.GetAttribute("filePath").GetNumTimeSamples() < 2:
        return {"file": path}
    pattern, number = sequence.pattern_of(path)
    if number is None:
        return {"file": path}
    return {"file": pattern, "time": {"offset": float(number), "speed": 0.0, "out_of_range": "hold"}}


def grid(field, time, fallback):
    """The grid's name in the file."""
    name = values.value(field, "fieldName", time)
    return str(name) if name else fallback


def first(found, names):
    """(relation's name, field) of the first relation that has one of the names."""
    return next(((name, found[name]) for name in names if name in found), (None, None))


def volume_keys(prim, stage, matrix, time, shading, notes):
    """Keys of a [[volume]], or None. `shading`: keys for all volumes that the prim's own keys do not give."""
    subject = str(prim.GetPath())
    found = {name: field for name, field in fields(prim, stage).items() if field.GetTypeName() == "OpenVDBAsset"}
    name, density = first(found, DENSITY)
    if density is None and len(found) == 1:
        name, density = next(iter(found.items()))
    if density is None:
        notes.add(subject, "it has no field:density of an OpenVDBAsset and is left out")
        return None
    keys = {"name": subject, **file_keys(density, time), "density": grid(density, time, name)}
    check_file(density, density, time, subject, notes)
    emission = {}
    for names, key in ((FLAME, "intensity"), (TEMPERATURE, "temperature")):
        name, field = first(found, names)
        if field is not None:
            emission[key] = grid(field, time, name)
            check_file(field, density, time, subject, notes)
    for names, key in ((VELOCITY, "velocity"), (COLOUR, "color_grid")):
        name, field = first(found, names)
        if field is not None:
            keys[key] = grid(field, time, name)
            check_file(field, density, time, subject, notes)
    if "velocity" in keys:  # per second; frames are time codes
        keys["velocity_fps"] = float(stage.GetTimeCodesPerSecond())
    known = {*DENSITY, *TEMPERATURE, *FLAME, *VELOCITY, *COLOUR}
    for name in sorted(set(found) - known):
        if found[name] is not density:
            notes.add(subject, f"field:{name} has no counterpart and is left out")
    own = values.own_keys(prim, time)
    if isinstance(own.get("emission"), dict):
        own["emission"] = {**emission, **own["emission"]}
    elif "intensity" in emission:
        notes.add(subject, "its fire is white and as bright as its grid; set vdbeam:emission:scale, and for black bodies "
                           "vdbeam:emission:kelvin")
        keys["emission"] = {"intensity": emission["intensity"]}
    elif emission:
        notes.add(subject, "its temperature brings no light; for black bodies set vdbeam:emission:kelvin")
    return {**keys, "transform": values.transform(matrix), **shading, **own}


def check_file(field, density, time, subject, notes):
    """A volume has one file."""
    if values.value(field, "fieldIndex", time, 0) > 0:
        notes.add(subject, f"{field.GetPath()} is not the first grid of its name (fieldIndex), which has no counterpart; "
                           "the first one is taken")
    if values.asset(field, "filePath", time) != values.asset(density, "filePath", time):
        notes.add(subject, f"{field.GetPath()} is in another file than the density, which has no counterpart; its grid "
                           "is looked for in the density's file")
