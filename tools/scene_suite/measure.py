"""Renders the suite's scenes and compares them with references by `path`."""
import dataclasses
import hashlib
import json
import pathlib

import numpy as np

# Processor time [ns] of what a render counts, so that work needs no clock. Only ratios matter.
TIME_OF = {"light_collisions": 150, "photons_stored": 2000, "contributions": 12, "shadow_rays": 3000,
           "walk_collisions": 40, "walk_shadow_rays": 200, "gather_walks": 1500, "camera_rays": 10000}
# The same of a light path of a pilot: they are few beside those of a frame of usual size.
TIME_OF_PILOT_PATH = 20000


def holds(low, high, mrse, mrse_error):
    """Whether an interval contains an error that is known within a standard error."""
    return low - 2 * mrse_error <= mrse <= high + 2 * mrse_error


@dataclasses.dataclass
class Outcome:
    """One scene: errors (MRSE) against the two references, and counted work [s]."""
    scene: str
    estimator: str
    passes: int
    mrse: float
    mrse_error: float  # standard error of mrse, by the noise of the references
    stated: float
    low: float
    high: float
    work: float
    seconds: float
    path_mrse: float
    path_work: float
    path_seconds: float

    @property
    def holds(self):
        """The stated interval contains the true error, as far as the references show it."""
        return holds(self.low, self.high, self.mrse, self.mrse_error)

    @property
    def lead(self):
        """How many times longer `path` works for the same error."""
        return self.path_mrse * self.path_work / (self.mrse * self.work)


def work_of(frame):
    counts = frame.report["counts"]
    return 1e-9 * sum(time * counts[name] for name, time in TIME_OF.items())


def with_image(keys, width):
    return {**keys, "image": {"width": width, "height": width * 9 // 16}}


def identity(keys):
    """Name of a scene that is the same wherever its densities are written."""
    text = json.dumps(keys, sort_keys=True, default=lambda density: density.identity)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


class Suite:
    """Renders scenes at one size; references are kept in a folder, by the scenes' hashes."""

    def __init__(self, vdbeam, width, reference_passes, folder=None, images=None):
        self._vdbeam, self._width, self._passes = vdbeam, width, reference_passes
        self._folder = pathlib.Path(folder) if folder else None
        self._images = pathlib.Path(images) if images else None
        self._kept = {}

    def _render(self, keys, settings, references=()):
        vdbeam = self._vdbeam
        frame = vdbeam.render(vdbeam.Scene(with_image(keys, self._width)), settings,
                              **dict(zip(("reference", "second_reference"), references)))
        return frame

    def _reference(self, keys, seed):
        settings = {"render.estimator": "path", "render.passes": self._passes, "render.seed": seed}
        vdbeam = self._vdbeam
        seen = {k: v for k, v in with_image(keys, self._width).items() if k != "layer"}
        path = self._folder / f"{identity({**seen, **settings})}.npy" if self._folder else None
        if path and path.exists():
            return np.load(path)
        image = vdbeam.render(vdbeam.Scene(seen, settings)).rgb
        if path:
            self._folder.mkdir(parents=True, exist_ok=True)
            np.save(path, image)
        return image

    def _references(self, keys):
        return [self._reference(keys, 1001), self._reference(keys, 1002)]

    def prepare(self, keys):
        """Renders or reads the references of a scene, once."""
        if identity(keys) not in self._kept:
            self._kept[identity(keys)] = self._references(keys)

    def error_and_work(self, keys, estimator, passes, seed):
        """MRSE and counted work [s], with that of pilots, of one render of a scene that was prepared."""
        settings = {"render.passes": passes, "render.estimator": estimator, "render.seed": seed}
        frame = self._render(keys, settings)
        pilot = 1e-9 * TIME_OF_PILOT_PATH * frame.report["counts"]["pilot_paths"]
        return self._vdbeam.compare(frame, *self._kept[identity(keys)])["mrse"], work_of(frame) + pilot

    def estimate(self, keys, passes, seed):
        """The error estimate of one render of a scene that was prepared: whether its interval holds the true error,
        the estimate over that error, and the interval's upper end over its lower one."""
        frame = self._render(keys, {"render.passes": passes, "render.seed": seed})
        true, last = self._vdbeam.compare(frame, *self._kept[identity(keys)]), frame.passes[-1]
        return (holds(last.error_low, last.error_high, true["mrse"], true["mrse_error"]),
                last.error_estimate / true["mrse"], last.error_high / last.error_low)

    def measure(self, name, keys, passes, path_passes, seed=1):
        references = self._references(keys)
        frame = self._render(keys, {"render.passes": passes, "render.seed": seed}, references)
        path = self._render(keys, {"render.passes": path_passes, "render.estimator": "path", "render.seed": seed},
                            references)
        if self._images:
            self._images.mkdir(parents=True, exist_ok=True)
            frame.save_preview(self._images / f"{name}.png")
            path.save_preview(self._images / f"{name}.path.png")
        errors = self._vdbeam.compare(frame, *references)
        last = frame.passes[-1]
        return Outcome(name, frame.report["plan"]["estimator"], passes, errors["mrse"], errors["mrse_error"],
                       last.error_estimate, last.error_low, last.error_high, work_of(frame), last.seconds,
                       path.passes[-1].mrse, work_of(path), path.passes[-1].seconds)
