"""Scenes that are edited while they are rendered."""

from __future__ import annotations

import math
import os
import weakref
from types import TracebackType
from typing import Any, Callable, Mapping, Optional, Type, Union

import numpy as np

from . import _core
from ._render import Image, path_with_extension
from ._scene import Scene, Source, scene_of


class LiveImage(Image):
    """An image of a `LiveSession`, with the layers R, G, B and A."""

    def __init__(self, image: "_core.LiveImage") -> None:
        super().__init__(image.planes)
        self._core = image
        #: Number of the edit that it shows; the first scene is 1.
        self.edit: int = image.edit
        #: Number of passes; 0 of a look before the first one.
        self.passes: int = image.passes
        #: Whether it was mixed from images of single lights, which were rendered before the edit.
        self.mixed: bool = image.mixed
        #: Time from the edit to this image [s].
        self.seconds: float = image.seconds

    @property
    def alpha(self) -> np.ndarray:
        """The opacity."""
        return self.layers["A"]

    @property
    def error(self) -> tuple[float, float, float]:
        """Estimated error (MRSE) of the image that was rendered, and its 95 % interval; NaN before the first pass."""
        record = self._core.record
        if record is None:
            return math.nan, math.nan, math.nan
        return record.error_estimate, record.error_low, record.error_high

    def save_preview(self, path: Union[str, "os.PathLike[str]"], exposure: float = 0, view: str = "filmic") -> None:
        """Writes a PNG of the image times 2^exposure. `view`: "filmic" or "srgb"."""
        self._core.image.write_png(path_with_extension(path, ".png"), float(exposure), view)

    def __repr__(self) -> str:
        height, width = self.alpha.shape
        return f"<vdbeam.LiveImage of {width} x {height} pixels, edit: {self.edit}, passes: {self.passes}>"


class LiveSession:
    """Renders a scene while it is edited, as `vdbeam live` does.

        with vdbeam.LiveSession("cloud.toml", on_image=lambda image: window.show(image.rgb)) as live:
            live["camera.position"] = [0, 1, 6]
            live["light.0.exposure"] = 1        # mixed from the images of the lights
            image = live.wait()

    `scene` is a `Scene`, or what `Scene` takes. Volumes, meshes and trees are kept as long as their files and keys
    stay the same. An edit returns at once; what was rendered of the scene before it is dropped, unless only strengths
    of lights changed. A value that is refused raises `InputError` and changes nothing.

    Callbacks, all optional, never run two at a time, on a thread of the session or, for edits that are mixed, of the
    caller: `on_image` gets each `LiveImage`, first a coarse look; `on_edit` what an edit took; `on_finished` its
    number, when the scene's stop rule is met; `on_error` the exception for a scene that cannot be rendered. A callback
    that returns False ends the render until the next edit. So does an exception in one of them, which the next call of
    `edit`, `show` or `wait` raises.

    On two cores at 960 x 540 the look came after 0.2 s for data/cloud.toml and after 0.3 s for scenes with surfaces, in
    the median; the slowest of 42 edits took 0.54 s.

    A session renders until it is closed: use `with`, or call `close`.
    """

    def __init__(self, scene: Union[Scene, Source], *,
                 on_image: Optional[Callable[[LiveImage], Optional[bool]]] = None,
                 on_edit: Optional[Callable[["_core.LiveEdit"], Optional[bool]]] = None,
                 on_error: Optional[Callable[["_core.Error"], Optional[bool]]] = None,
                 on_finished: Optional[Callable[[int], Optional[bool]]] = None) -> None:
        of_image = None
        if on_image is not None:
            def of_image(image: "_core.LiveImage") -> Optional[bool]:
                return on_image(LiveImage(image))
        self._scene = scene_of(scene)
        self._core = _core.LiveSession(of_image, on_edit, on_error, on_finished)
        # At the end of the program, before Python is gone.
        self._close = weakref.finalize(self, self._core.close)
        self._core.show(self._scene._core, False)

    @property
    def scene(self) -> Scene:
        """The scene that is shown. To change it, edit the session, or show another one."""
        return self._scene

    def show(self, scene: Union[Scene, Source], *, files_changed: bool = False) -> None:
        """Shows another scene. `files_changed`: files that it names have other contents than before."""
        scene = scene_of(scene)
        self._core.show(scene._core, files_changed)
        self._scene = scene

    def edit(self, settings: Mapping[str, Any]) -> None:
        """Sets keys by their paths, several in one edit: `live.edit({"camera.fov": 30, "volume.0.albedo": 0.9})`."""
        self.show(self._scene.with_settings(settings))

    def __setitem__(self, key: str, value: Any) -> None:
        """Sets one key: `live["volume.0.extinction"] = 20`."""
        self.edit({key: value})

    def __getitem__(self, key: str) -> Any:
        """The value of a key of the scene, the default included."""
        return self._scene[key]

    @property
    def image(self) -> Optional[LiveImage]:
        """The last image; None before the first one."""
        latest = self._core.latest
        return None if latest is None else LiveImage(latest)

    def wait(self, timeout: Optional[float] = None) -> Optional[LiveImage]:
        """Waits until the scene's stop rule is met or the render was stopped, and returns the last image; None after
        `timeout` seconds. Raises the error of a scene that cannot be rendered, what a callback has raised, and
        KeyboardInterrupt, after which the render goes on."""
        latest = self._core.wait(math.inf if timeout is None else float(timeout))
        return None if latest is None else LiveImage(latest)

    def stop(self) -> None:
        """Ends the render in progress; the next edit begins another."""
        self._core.stop()

    def close(self) -> None:
        """Ends the session. Images that it gave remain."""
        self._close()

    def __enter__(self) -> "LiveSession":
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()
