#!/usr/bin/env python3
"""Scenes of Blender have the same light by vdbeam's path tracer as by Cycles: means over blocks of 30 x 30 pixels
agree within 1 % and four standard errors, which two renders of each show. Skipped without Blender."""
import os
import pathlib
import sys
import tempfile
import unittest

FILE = os.path.abspath(__file__)
sys.path.insert(0, os.path.dirname(FILE))

import blender_runner  # noqa: E402

if blender_runner.inside_blender():
    import numpy
    import scenes

TOLERANCE = 0.01  # the bias of Cycles' ray marching in smoke
LUMINANCE = (0.2126, 0.7152, 0.0722)


def mean_and_error(first, second):
    """Mean of two renders, and its standard error: half the standard deviation of their difference."""
    return (first + second) / 2, numpy.sqrt(numpy.mean((first - second) ** 2)) / 2


class AgainstCycles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def blocks(self, scene, name, seed):
        return scenes.blocks(scenes.combined(scenes.render(scene, self.folder / f"{name}{seed}.exr")))

    def check(self, scene, passes, samples):
        """Compares the blocks that are at least a hundredth of the brightest one, which must be most of them."""
        scene.vdbeam.estimator, scene.vdbeam.passes = "path", passes
        mine, theirs = [], []
        for seed in (1, 2):
            scene.render.engine, scene.vdbeam.seed = "VDBEAM", seed
            mine.append(self.blocks(scene, "vdbeam", seed))
            scenes.use_cycles(scene, samples, seed)
            theirs.append(self.blocks(scene, "cycles", seed))
        lit = theirs[0] > 0.01 * theirs[0].max()
        self.assertGreater(lit.mean(), 0.5)
        (mean, noise), (expected, other) = (mean_and_error(*[(one / theirs[0])[lit] for one in both])
                                            for both in (mine, theirs))
        error = numpy.hypot(noise, other)
        self.assertLess(error, 0.003, "the renders are too noisy to be compared")
        apart = numpy.abs(mean / expected - 1).max()
        print(f"largest difference {apart:.4f}, standard error {error:.4f}")
        self.assertLess(apart, TOLERANCE + 4 * error)

    def test_lamps(self):
        self.check(scenes.lamps_on_plane(), 16, 16)

    def test_smoke(self):
        self.check(scenes.smoke(), 24, 4)

    def test_box_of_fog(self):
        self.check(scenes.box_of_fog(), 24, 16)

    def test_world_of_fog(self):
        """Walks are long in fog without an end, so the mean of the image is compared, within 2 %."""
        scene = scenes.world_of_fog()
        scene.vdbeam.estimator, scene.vdbeam.passes = "path", 12
        mine = self.blocks(scene, "vdbeam", 1).mean((0, 1))
        scenes.use_cycles(scene, 64, 1)
        theirs = self.blocks(scene, "cycles", 1).mean((0, 1))
        self.assertLess(numpy.abs(mine / theirs - 1).max(), 0.02)

    def test_clear_skies(self):
        """The luminance of a plane by the light of the sky is within 8 %, by that of the sun within 5 %."""
        for elevation in (17, 46, 80):
            light = {}
            for sun in (False, True):
                scene = scenes.clear_sky(elevation, sun)
                scene.vdbeam.estimator, scene.vdbeam.passes = "path", 4
                mine = self.blocks(scene, "vdbeam", 1).mean((0, 1)) @ LUMINANCE
                scenes.use_cycles(scene, 32, 1)
                light[sun] = numpy.array([mine, self.blocks(scene, "cycles", 1).mean((0, 1)) @ LUMINANCE])
            for part, most in ((light[False], 0.08), (light[True] - light[False], 0.05)):
                print(f"elevation {elevation}: {part[0] / part[1] - 1:.3f}")
                self.assertLess(abs(part[0] / part[1] - 1), most)

    def test_environment_image(self):
        self.check(scenes.surroundings(self.folder), 12, 16)

    def test_lens(self):
        self.check(scenes.lens(), 12, 16)


if __name__ == "__main__":
    blender_runner.main(FILE)
