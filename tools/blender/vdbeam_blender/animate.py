"""Joins the scenes of several times into one with animated keys."""

# Keys that a scene file does not animate: names, choices, whole files.
STILL = {"name", "type", "file", "density", "mask", "color_grid", "image", "texture", "group", "visible", "shape",
         "width", "height", "projection", "up", "blades", "sun", "two_sided", "opacity_texture", "roughness_texture",
         "metal_texture", "normal_texture"}


def is_number(value):
    """Whether the value is a number or a list of numbers."""
    if isinstance(value, list):
        return bool(value) and all(is_number(entry) for entry in value)
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def merged_value(key, values, times, notes, subject):
    """One value for all times: itself, or keys."""
    first = values[0]
    if all(value == first for value in values):
        return first
    if all(isinstance(value, dict) for value in values):
        return merged_table(values, times, notes, subject)
    if key in STILL or not all(is_number(value) for value in values):
        notes.add(subject, f"{key} changes over time, which has no counterpart; it is that of frame {times[0]:g}")
        return first
    keep = [0] + [i for i in range(1, len(values) - 1)
                  if not values[i - 1] == values[i] == values[i + 1]] + [len(values) - 1]
    return {"keys": [[times[i], values[i]] for i in dict.fromkeys(keep)]}


def merged_table(tables, times, notes, subject):
    """One table for all times. A key that some lack is that of the first that has it."""
    result = {}
    for key in dict.fromkeys(key for table in tables for key in table):
        there = [table[key] for table in tables if key in table]
        if len(there) < len(tables):
            notes.add(subject, f"{key} is not there at all times; it is taken as constant")
            result[key] = there[0]
        else:
            result[key] = merged_value(key, there, times, notes, subject)
    return result


def merge(scenes, notes):
    """The scene of {time: scene}. Tables of lists are matched by their key `name`, else by their order; what is there
    at some times only is noted."""
    times = sorted(scenes)
    first = scenes[times[0]]
    result = {}
    for table, entries in first.items():
        if not isinstance(entries, list):
            result[table] = merged_table([scenes[time][table] for time in times], times, notes, table)
            continue
        result[table] = []
        for index, entry in enumerate(entries):
            subject = entry.get("name", f"{table}.{index}")
            found = [match(scenes[time].get(table, []), entry, index) for time in times]
            if any(other is None for other in found):
                notes.add(subject, "it is not there at all times, which has no counterpart; it stays where it is")
                found = [other or entry for other in found]
            result[table].append(merged_table(found, times, notes, subject))
        added = {other.get("name") for time in times for other in scenes[time].get(table, [])}
        for name in sorted(filter(None, added - {entry.get("name") for entry in entries})):
            notes.add(name, f"it appears after frame {times[0]:g}, which has no counterpart; it is left out")
    return result


def match(entries, entry, index):
    """The entry of the same name or, without names, of the same place and type."""
    if "name" in entry:
        return next((other for other in entries if other.get("name") == entry["name"]), None)
    if index < len(entries) and entries[index].get("type") == entry.get("type"):
        return entries[index]
    return None
