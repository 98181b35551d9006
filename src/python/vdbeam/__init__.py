"""vdbeam: a renderer of OpenVDB clouds, smoke and fire.

    import vdbeam

    scene = vdbeam.Scene("cloud.toml", {"render.passes": 16})
    frame = vdbeam.render(scene, on_pass=lambda p: print(p.passes, p.error_estimate))
    frame.rgb          # height x width x 3, linear
    frame.save("cloud.exr")

A scene is a file, a bare VDB, or a dict with the keys of a scene file (docs/reference/scene.md). Everything
that a scene file, an option or a volume can have wrong raises `InputError` or `FrameError`, whose text is the
line that the program prints.
"""

from ._core import Error, FrameError, InputError, LiveEdit, PassRecord
from ._core import version as __version__
from ._density import Density
from ._live import LiveImage, LiveSession
from ._render import Frame, Image, Session, compare, read_image, render
from ._scene import Scene

__all__ = ["Density", "Error", "Frame", "FrameError", "Image", "InputError", "LiveEdit", "LiveImage", "LiveSession",
           "PassRecord", "Scene", "Session", "compare", "read_image", "render", "__version__"]
