"""Rendering and comparing."""

from __future__ import annotations

import json
import math
import os
from typing import Any, Callable, Mapping, Optional, Union

import numpy as np

from . import _core
from ._scene import Scene, Source, scene_of

Rgb = Union["np.ndarray[Any, Any]", "Image", str, "os.PathLike[str]"]


def path_with_extension(path: Union[str, "os.PathLike[str]"], extension: str) -> str:
    """The path, whose name must say what is written: other programs go by it."""
    text = os.fspath(path)
    if not text.lower().endswith(extension):
        raise _core.InputError(f"{text}: the name of this file must end with {extension}")
    return text


class Session:
    """What is kept from one render to the next: volumes, lights and meshes that did not change are not read
    again. Use one session at a time."""

    def __init__(self) -> None:
        self._core = _core.Session()

    def render(self, scene: Union[Scene, Source], **options: Any) -> "Frame":
        """Like `vdbeam.render`, but does not read again what earlier calls have read."""
        return render(scene, session=self, **options)


class Image:
    """The layers of an image."""

    def __init__(self, layers: dict[str, np.ndarray]) -> None:
        #: The image's planes by name ("R", "volume_direct.R", "depth.Z", ...): arrays of height by width floats, in
        #: scene-linear units. They share the memory of the image, which lives as long as one of them.
        self.layers = layers

    @property
    def rgb(self) -> np.ndarray:
        """The image: height by width by 3, a copy."""
        return np.stack([self.layers[name] for name in "RGB"], axis=-1)

    @property
    def alpha(self) -> Optional[np.ndarray]:
        """The opacity, or None where the scene has no such layer."""
        return self.layers.get("A")

    def __repr__(self) -> str:
        height, width = next(iter(self.layers.values())).shape
        return f"<vdbeam.Image of {width} x {height} pixels>"


class Frame(Image):
    """A rendered frame."""

    def __init__(self, frame: "_core.Frame") -> None:
        super().__init__(frame.planes)
        self._core = frame
        #: The report that the program writes with `--report`: plan, seconds by stage, counts, memory, passes.
        self.report: dict[str, Any] = json.loads(frame.report)
        #: The state of the image after each pass.
        self.passes: list[_core.PassRecord] = frame.passes
        #: What was repaired, chosen or found odd.
        self.notes: list[str] = frame.notes

    @property
    def error(self) -> tuple[float, float, float]:
        """Estimated error (MRSE) of the image, and its 95 % interval; NaN or infinite as long as they are
        unknown, as after one pass."""
        if not self.passes:
            return math.nan, math.nan, math.nan
        last = self.passes[-1]
        return last.error_estimate, last.error_low, last.error_high

    @property
    def stopped_by(self) -> str:
        """What ended the render: "passes", "time", "target_error" or "stop"."""
        return self.report["stopped_by"]

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes all layers as an EXR, which is never half there."""
        self._core.image.write_exr(path_with_extension(path, ".exr"))

    def save_preview(self, path: Union[str, "os.PathLike[str]"], exposure: float = 0, view: str = "filmic") -> None:
        """Writes a PNG of the image times 2^exposure. `view`: "filmic" or "srgb"."""
        self._core.image.write_png(path_with_extension(path, ".png"), float(exposure), view)

    def __repr__(self) -> str:
        height, width = next(iter(self.layers.values())).shape
        error = f"{self.error[0]:.3g}" if math.isfinite(self.error[0]) else "unknown"
        return f"<vdbeam.Frame of {width} x {height} pixels, passes: {len(self.passes)}, error: {error}>"


def _array(image: Rgb) -> np.ndarray:
    if isinstance(image, Image):
        return image.rgb
    return read_image(image) if isinstance(image, (str, os.PathLike)) else np.asarray(image)


def render(scene: Union[Scene, Source], settings: Optional[Mapping[str, Any]] = None, *,
           on_pass: Optional[Callable[[_core.PassRecord], Optional[bool]]] = None,
           on_image: Optional[Callable[[Image], Optional[bool]]] = None,
           on_note: Optional[Callable[[str], Optional[bool]]] = None, reference: Optional[Rgb] = None,
           second_reference: Optional[Rgb] = None, session: Optional[Session] = None) -> Frame:
    """Renders one frame of a `Scene`, or of what `Scene` takes.

    `settings` are applied as in `Scene`. `on_pass` is called after each pass with its record, `on_image` with the
    `Image` so far, which has the layers of the frame, `on_note` with each line for the user. They are called on
    another thread; one that returns False ends the render, whose frame then holds the finished passes. An exception in
    one of them ends it too, and is raised here. So does KeyboardInterrupt, at any time.

    `reference`: the true image, for `mrse` in the records; `second_reference`: an independent one, which removes the
    noise of both. Images are arrays, frames or paths.
    """
    scene = scene_of(scene, settings)
    of_image = None
    if on_image is not None:
        def of_image(image: "_core.Image") -> Optional[bool]:
            return on_image(Image(image.planes))
    frame = _core.render(scene._core, (session or Session())._core,
                         None if reference is None else _array(reference),
                         None if second_reference is None else _array(second_reference), on_pass, of_image, on_note)
    return Frame(frame)


def compare(image: Rgb, reference: Rgb, second_reference: Optional[Rgb] = None) -> dict[str, float]:
    """Errors of an image against a reference: `rmse`, `mrse`, `relmse`, `bias` and `flip`. With a second,
    independent reference their noise cancels, and `mrse_error` is the standard error of `mrse`."""
    second = None if second_reference is None else _array(second_reference)
    return _core.compare(_array(image), _array(reference), second)


def read_image(path: Union[str, "os.PathLike[str]"]) -> np.ndarray:
    """R, G and B of an EXR, HDR, PNG or JPEG file: height by width by 3, linear."""
    planes = _core.read_image(os.fspath(path)).planes
    return np.stack([planes[name] for name in "RGB"], axis=-1)
