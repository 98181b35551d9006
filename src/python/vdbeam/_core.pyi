from typing import Any, Callable, Optional, Sequence

import numpy as np

version: str

class Error(Exception): ...
class InputError(Error): ...
class FrameError(Error): ...

class Scene:
    notes: list[str]
    width: int
    height: int
    def settings(self) -> str: ...
    def hash(self) -> str: ...
    def plan(self, pilots: bool) -> str: ...

class PassRecord:
    passes: int
    seconds: float
    photons: int
    error_estimate: float
    error_low: float
    error_high: float
    noise_estimate: float
    bias_estimate: float
    mrse: float
    has_reference: bool

class Image:
    planes: dict[str, np.ndarray]
    def write_exr(self, path: str) -> None: ...
    def write_png(self, path: str, exposure: float, view: str) -> None: ...

class Session:
    def __init__(self) -> None: ...

class Frame:
    planes: dict[str, np.ndarray]
    image: Image
    passes: list[PassRecord]
    notes: list[str]
    report: str

class LiveImage:
    planes: dict[str, np.ndarray]
    image: Image
    edit: int
    passes: int
    mixed: bool
    seconds: float
    record: Optional[PassRecord]

class LiveEdit:
    edit: int
    changed: list[str]
    mixed: bool
    grids_read: int
    meshes_read: int
    trees_built: int
    kept: list[str]

class LiveSession:
    latest: Optional[LiveImage]
    def __init__(self, on_image: Optional[Callable[[LiveImage], Optional[bool]]],
                 on_edit: Optional[Callable[[LiveEdit], Optional[bool]]],
                 on_error: Optional[Callable[[Error], Optional[bool]]],
                 on_finished: Optional[Callable[[int], Optional[bool]]]) -> None: ...
    def show(self, scene: Scene, files_changed: bool) -> None: ...
    def stop(self) -> None: ...
    def wait(self, seconds: float) -> Optional[LiveImage]: ...
    def close(self) -> None: ...

def load_scene(path: str, frame: int, overrides: Sequence[str]) -> Scene: ...
def parse_scene(text: str, path: str, frame: int, overrides: Sequence[str]) -> Scene: ...
def write_density(values: Any, path: str, voxel_size: float, origin: Sequence[float], grid: str) -> None: ...
def read_image(path: str) -> Image: ...
def compare(image: Any, reference: Any, second_reference: Optional[Any]) -> dict[str, float]: ...
def render(scene: Scene, session: Session, reference: Optional[Any], second_reference: Optional[Any],
           on_pass: Optional[Callable[[PassRecord], Optional[bool]]],
           on_image: Optional[Callable[[Image], Optional[bool]]],
           on_note: Optional[Callable[[str], Optional[bool]]]) -> Frame: ...
