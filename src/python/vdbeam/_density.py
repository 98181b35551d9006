"""Densities from arrays."""

from __future__ import annotations

import os
import tempfile
from typing import Any, Sequence

import numpy as np

from . import _core


class Density:
    """A density from a NumPy array, for the key `file` of a volume.

    `values[x, y, z]` is the density at `origin + voxel_size * (x, y, z)` in world units. Negative values and
    values that are not finite are treated as in a file: they become 0, with a note. The array is copied, to a
    temporary file that is removed with this object; a scene keeps the densities that it uses.

        ball = vdbeam.Density(values, voxel_size=0.1)
        scene = vdbeam.Scene({"volume": [{"file": ball, "extinction": 4}]})
    """

    def __init__(self, values: Any, voxel_size: float = 1.0, origin: Sequence[float] = (0.0, 0.0, 0.0)) -> None:
        self.shape = np.shape(values)
        handle, self.path = tempfile.mkstemp(prefix="vdbeam-", suffix=".vdb")
        os.close(handle)
        _core.write_density(values, self.path, float(voxel_size), [float(x) for x in origin], "density")

    def __fspath__(self) -> str:
        return self.path

    def __repr__(self) -> str:
        return f"<vdbeam.Density of {' x '.join(map(str, self.shape))} voxels>"

    def __del__(self) -> None:
        path, remove = getattr(self, "path", None), getattr(os, "remove", None)
        if path and remove:
            try:
                remove(path)
            except OSError:
                pass
