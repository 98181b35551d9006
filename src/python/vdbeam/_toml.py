"""Python values as TOML."""

from __future__ import annotations

import json
import math
import os
import re
from typing import Any, Mapping

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def key_text(key: str) -> str:
    return key if _BARE_KEY.fullmatch(key) else json.dumps(key, ensure_ascii=False)


def value_text(value: Any) -> str:
    """The value on one line: numbers, texts, paths, lists, dicts, and whatever has `tolist` or `item`, as arrays
    and numbers of NumPy have."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        # JSON's escapes are TOML's, but for characters outside of the first plane, which need none.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key_text(k)} = {value_text(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(item) for item in value) + "]"
    raise TypeError(f"a scene cannot hold a value of type {type(value).__name__}")


def document(root: Mapping[str, Any]) -> str:
    """One line for each key of the root."""
    return "".join(f"{key_text(key)} = {value_text(value)}\n" for key, value in root.items())
