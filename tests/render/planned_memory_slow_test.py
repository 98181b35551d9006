#!/usr/bin/env python3
"""Planned memory is what is taken: 12 drawn scenes, each rendered, its peak beside the plan's total."""
import json
import os
import random
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from memory_peak import run_measured
from program import BINARY, DATA, InTempFolder, run

TOOLS = Path(os.environ.get("VDBEAM_BUILD", "build/release")) / "tools"
LEAST, MOST = 0.8, 1.25


class Drawing:
    """Draws options of one scene."""

    def __init__(self, seed, ball):
        self.random = random.Random(seed)
        self.options = []
        self.volume = self.random.choice(["cloud", "cloud", "ball", "fire", "smoke"])
        self.scene = {"cloud": DATA / "cloud.toml", "ball": ball, "fire": DATA / "fire.toml",
                      "smoke": DATA / "smoke.toml"}[self.volume]
        if self.volume == "fire":
            self.options += ["-f", "14"]
        self.draw()

    def set(self, key, value):
        self.options += ["--set", f"{key}={value}"]

    def draw(self):
        chance = self.random.random
        estimator = self.random.choice(["beam", "path", "path", "march", "auto"])
        dear = estimator != "path"
        # The film takes its memory with the first pass, beside the photons of the second.
        self.options += ["--estimator", estimator, "--passes", "2" if dear else "1"]
        size = self.random.choice([(480, 270), (640, 360)] if dear else [(960, 540), (1280, 720), (640, 360)])
        if not dear:
            self.set("render.max_bounces", 1)
        if chance() < 0.3:
            self.set("volume.0.interpolation", "cubic")
        if chance() < 0.2 and self.volume in ("cloud", "smoke"):
            self.set("volume.0.noise_amplitude", 0.02)
            self.set("volume.0.noise_octaves", 1)  # time that memory does not depend on
        if chance() < 0.3 and self.volume in ("fire", "smoke"):
            self.set("camera.shutter_open", -0.25)
            self.set("camera.shutter_close", 0.25)
        if chance() < 0.25:
            self.set("image.deep", "true")
            size = (480, 270)  # the dearest to render, and deep samples fill the memory in a small picture, too
        if chance() < 0.25:
            self.set("light.0.group", "key")
        if chance() < 0.3:
            for i, layer in enumerate(("alpha", "position", "depth_near")):
                self.set(f"layer.{i}.name", layer)
        self.preview = chance() < 0.3
        self.options += ["--resolution", f"{size[0]}x{size[1]}"]


class PlannedMemory(InTempFolder):
    def make_ball(self):
        """A scene with many partly filled leaves: a ball of noise."""
        code, text = run(str(TOOLS / "make_volumes"), "noise", self.file("ball.vdb"), "--size", "192")
        self.assertEqual(code, 0, text)
        scene = Path(self.file("ball.toml"))
        scene.write_text((DATA / "cloud.toml").read_text(encoding="utf-8").replace("cloud.vdb", "ball.vdb"),
                         encoding="utf-8")
        return scene

    def planned(self, scene, options):
        code, text = run(BINARY, "plan", str(scene), "--json", "--no-pilot", *options)
        self.assertEqual(code, 0, text)
        return json.loads(text[text.index("{"):])["memory"]["peak"]

    def test_surfaces_that_throw_light_take_photons(self):
        """Caustics may be anywhere on the ground, so there are more photons than for the cloud alone."""
        scene, options = DATA / "cloud_over_ground.toml", ["--resolution", "480x270", "--passes", "2"]
        code, text, peak = run_measured(BINARY, "render", str(scene), "-o", self.file("o.exr"), *options)
        self.assertEqual(code, 0, text)
        share = self.planned(scene, options) / peak
        self.assertTrue(LEAST <= share <= MOST, share)

    def test_total_is_the_measured_peak(self):
        ball = self.make_ball()
        wrong = []
        for seed in range(12):
            drawing = Drawing(seed, ball)
            command = [BINARY, "render", str(drawing.scene), "-o", self.file("o.exr"), *drawing.options]
            if drawing.preview:
                command += ["--preview", self.file("o.png")]
            planned = self.planned(drawing.scene, drawing.options)
            code, text, peak = run_measured(*command)
            self.assertEqual(code, 0, text)
            share = planned / peak
            line = f"{share:.2f}: planned {planned / 2**20:.0f} MiB, measured {peak / 2**20:.0f} MiB: " \
                   f"{drawing.volume} {' '.join(drawing.options)}"
            print(line, flush=True)
            if not LEAST <= share <= MOST:
                wrong.append(line)
        self.assertEqual(wrong, [], "\n".join(wrong))


if __name__ == "__main__":
    unittest.main()
