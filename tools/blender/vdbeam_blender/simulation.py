"""From a smoke domain of Mantaflow to a [[volume]] with the files of its cache."""
import glob
import math
import os

from . import objects, vdb_header, volume_shader

KELVIN = 1000.0  # of a unit of Mantaflow's temperatures


def domain_of(obj):
    """Settings of an object's smoke domain, None where it is none."""
    for modifier in obj.modifiers:
        if modifier.type == "FLUID" and modifier.fluid_type == "DOMAIN":
            settings = modifier.domain_settings
            if settings is not None and settings.domain_type == "GAS":
                return settings
    return None


def cache_file(settings, frame, abspath):
    """(file of the frame, pattern of all frames, number): of the fine cache if there is noise, else of the coarse."""
    number = math.floor(frame) - int(getattr(settings, "cache_frame_offset", 0))
    folder = abspath(settings.cache_directory)
    kinds = [("noise", "fluid_noise")] if settings.use_noise else []
    for kind, stem in [*kinds, ("data", "fluid_data")]:
        place = os.path.join(folder, kind)
        file = os.path.join(place, f"{stem}_{number:04d}.vdb")
        if os.path.isfile(file):
            break
    return file, os.path.join(place, f"{stem}_####.vdb"), number


def transform_of(matrix, corners, resolution, voxel):
    """Twelve numbers from the file's world to the scene's. The first voxel of the file lies at its origin, and its
    middle half a cell from the domain's lower corner. `corners`: lower and upper, in the object's space."""
    cells = [(high - low) / count for low, high, count in zip(*corners, resolution)]
    result = []
    for row in objects.rows(matrix)[:3]:
        place = sum(row[axis] * (corners[0][axis] + cells[axis] / 2) for axis in range(3)) + row[3]
        result += [*(row[axis] * cells[axis] / voxel for axis in range(3)), place]
    return result


def use_grids(keys, grids, settings, notes, name):
    """Names grids as the file does: noise has its own, and Cycles derives temperatures from flames."""
    def named(grid):
        return grid if grid in grids else f"{grid}_noise"

    keys["density"] = named(keys["density"])
    emission = keys.get("emission")
    if emission is None:
        return
    if emission.pop("temperature", None) is not None:
        unit = emission.pop("kelvin")
        low, high = float(settings.flame_ignition), float(settings.flame_max_temp)
        emission.update(temperature="flame", kelvin=unit * (high - low), kelvin_offset=unit * low)
    for key in ("temperature", "intensity"):
        if key in emission:
            emission[key] = named(emission[key])
            if emission[key] not in grids:
                notes.add(name, f"its cache has no grid {emission[key].removesuffix('_noise')}; it does not shine")
                keys.pop("emission")
                return


def shading_of(obj, notes):
    """Keys of the domain's material, None where it shows nothing."""
    shader, material = objects.volume_shader_of(obj)
    if material is None:
        return dict(objects.DEFAULT_VOLUME)
    keys = volume_shader.volume_keys(shader, notes, material.name)
    if keys is not None and not keys["density"]:
        keys["density"] = "density"
    return keys


def volume_table(obj, settings, name, matrix, frame, abspath, notes):
    """The [[volume]] of a domain; None where there is nothing to show, which is noted."""
    keys = shading_of(obj, notes)
    if keys is None:
        return notes.add(name, "its material has no volume shader that can be exported; the smoke is left out")
    file, pattern, number = cache_file(settings, frame, abspath)
    if not os.path.isfile(file):
        others = sorted(glob.glob(glob.escape(pattern).replace("####", "*")))
        if not others:
            return notes.add(name, f"its smoke is left out, since there is no {file}; bake the domain with the cache format "
                                   "OpenVDB")
        notes.add(name, "its cache lacks frames; Missing Files decides what they show")
        file = others[0]
    try:
        grids = vdb_header.read(file)
    except (OSError, vdb_header.VdbError) as problem:
        return notes.add(name, f"its smoke is left out, since {file} cannot be read: {problem}")
    use_grids(keys, grids, settings, notes, name)
    voxel = grids.get(keys["density"])
    if voxel is None:
        return notes.add(name, f"its smoke is left out, since {file} has no grid {keys['density']}")
    for grid in ("mask", "color_grid"):
        if keys.pop(grid, ""):
            notes.add(name, "colours and products of the grids of a simulation have no counterpart and are left out")
    corners = [list(obj.bound_box[index])[:3] for index in (0, 6)]
    finer = settings.noise_scale if keys["density"].endswith("_noise") else 1
    resolution = [count * finer for count in settings.domain_resolution]
    keys["transform"] = transform_of(matrix, corners, resolution, voxel)
    time = {"offset": float(number), "speed": 0.0, "out_of_range": "clip"}
    return {"name": name, "file": pattern, "time": time, **keys}
