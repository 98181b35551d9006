"""Writes a scene dictionary as TOML: tables of plain values, lists of tables."""
import json
import math

import numbers


def value_text(value):
    """A value in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        if not math.isfinite(value):
            raise ValueError(f"a scene file holds no {value}")
        text = f"{float(value):.9g}"
        return text if any(mark in text for mark in ".e") else text + ".0"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {value_text(entry)}" for key, entry in value.items()) + " }"
    return "[" + ", ".join(value_text(entry) for entry in value) + "]"


def scene_text(scene, comments=()):
    """The scene file. `comments` come first, a line each."""
    lines = [f"# {' '.join(comment.split())}" for comment in comments]
    for name, table in scene.items():
        for entry in table if isinstance(table, list) else [table]:
            lines.append("")
            lines.append(f"[[{name}]]" if isinstance(table, list) else f"[{name}]")
            lines += [f"{key} = {value_text(value)}" for key, value in entry.items()]
    return "\n".join(lines).lstrip("\n") + "\n"
