"""Scenes."""

from __future__ import annotations

import json
import os
from typing import Any, Mapping, Optional, Union

from . import _core, _toml
from ._density import Density

Source = Union[str, "os.PathLike[str]", Mapping[str, Any]]


def _densities(value: Any) -> list[Density]:
    """All densities in a tree of values."""
    if isinstance(value, Density):
        return [value]
    if isinstance(value, Mapping):
        value = list(value.values())
    if isinstance(value, (list, tuple)):
        return [density for item in value for density in _densities(item)]
    return []


class Scene:
    """What is rendered.

    `source` is the path of a scene file or of a VDB, or a dict with the keys of a scene file, as
    `{"camera": {"position": [0, 0, 9]}, "volume": [{"file": "cloud.vdb"}]}`. `settings` are applied last, by their
    paths: `{"render.passes": 16, "volume.0.extinction": 20}`. `frame` replaces #### and %04d in paths, and animated
    keys are evaluated at its time. Relative paths of a dict begin at `folder`, which is the current one by default.

    Raises `InputError` for what is not a valid scene.
    """

    def __init__(self, source: Source, settings: Optional[Mapping[str, Any]] = None, *, frame: int = 1,
                 folder: Union[str, "os.PathLike[str]", None] = None) -> None:
        self._source = source
        self._settings: dict[str, Any] = dict(settings or {})
        self._folder = os.fspath(folder) if folder is not None else ""
        self.frame = int(frame)
        self._core = self._load()

    def _load(self) -> "_core.Scene":
        overrides = [f"{key}={_toml.value_text(value)}" for key, value in self._settings.items()]
        # They exist as long as the scene does.
        self._kept = _densities(self._source) + _densities(self._settings)
        if isinstance(self._source, Mapping):
            name = os.path.join(self._folder, "scene")
            return _core.parse_scene(_toml.document(self._source), name, self.frame, overrides)
        return _core.load_scene(os.fspath(self._source), self.frame, overrides)

    def with_settings(self, settings: Mapping[str, Any], *, frame: Optional[int] = None) -> "Scene":
        """The same scene with these settings, or of another frame."""
        return Scene(self._source, {**self._settings, **settings}, frame=self.frame if frame is None else frame,
                     folder=self._folder)

    def __setitem__(self, key: str, value: Any) -> None:
        """Sets a key by its path: `scene["light.0.irradiance"] = 3`. A value that is refused changes nothing."""
        changed = self.with_settings({key: value})
        self._settings, self._core, self._kept = changed._settings, changed._core, changed._kept

    def __getitem__(self, key: str) -> Any:
        """The value of a key by its path, the default included: `scene["camera.fov"]`."""
        value: Any = self.settings
        try:
            for part in key.split("."):
                value = value[int(part)] if isinstance(value, list) else value[part]
        except (KeyError, IndexError, TypeError, ValueError):
            raise KeyError(key) from None
        return value

    @property
    def settings(self) -> dict[str, Any]:
        """All keys with their values, defaults included."""
        return json.loads(self._core.settings())

    @property
    def width(self) -> int:
        """Width of the image [pixels]."""
        return self._core.width

    @property
    def height(self) -> int:
        """Height of the image [pixels]."""
        return self._core.height

    @property
    def notes(self) -> list[str]:
        """What was chosen for the scene or is odd in it."""
        return self._core.notes

    def hash(self) -> str:
        """16 hexadecimal digits that change with everything that changes the image, contents of files included."""
        return self._core.hash()

    def plan(self, pilots: bool = True) -> dict[str, Any]:
        """What a render will do and why: estimator, stages, features, the schedule of passes, memory. With `pilots`
        the files are read and measured as before a render; without, features, numbers and schedule are left out."""
        return json.loads(self._core.plan(pilots))

    def __repr__(self) -> str:
        name = "dict" if isinstance(self._source, Mapping) else repr(os.fspath(self._source))
        return f"<vdbeam.Scene of {name}, {self.width} x {self.height}, frame {self.frame}>"


def scene_of(scene: Union[Scene, Source], settings: Optional[Mapping[str, Any]] = None) -> Scene:
    """A scene, or what `Scene` takes, with these settings."""
    if not isinstance(scene, Scene):
        return Scene(scene, settings)
    return scene.with_settings(settings) if settings else scene
