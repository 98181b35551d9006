#!/usr/bin/env python3
"""What plan says about twelve scenes: the parts of the method that each uses, why others are left out, and what its
passes are; the report and the image of a render hold the same."""
import json
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import BINARY, DATA, InTempFolder, run

VIEW = {"view importance", "path guide", "kernel pilot"}
GATHER = VIEW | {"forward peak", "final gathering", "shadow lattice", "boundary correction", "refined edges"}
# Scene, options, estimator of the first pass, features that are on, and why one of the others is off.
SCENES = [
    ("cloud", [], "gather", GATHER, ("branches", "photons carry the light; only bias probes are path traced")),
    ("cloud", ["--estimator", "beam"], "beam", GATHER - {"final gathering", "refined edges"},
     ("final gathering", "render.estimator names another method")),
    ("cloud", ["--estimator", "path"], "path", set(), ("shadow lattice", "the estimator traces no photons")),
    ("smoke", ["-f", "8"], "gather", GATHER, ("branches", "photons carry the light; only bias probes are path traced")),
    ("sunlit_cloud", [], "gather", GATHER, ("branches", "photons carry the light; only bias probes are path traced")),
    ("fire", ["-f", "14"], "gather", GATHER, ("branches", "photons carry the light; only bias probes are path traced")),
    ("ball_in_smoke", [], "gather", GATHER,
     ("branches", "no phase function has a sharp enough peak, and no lamp stands in the medium")),
    ("cloud_over_ground", [], "gather", GATHER,
     ("branches", "no phase function has a sharp enough peak, and no lamp stands in the medium")),
    ("cornell_fog", [], "beam", VIEW | {"boundary correction", "refined edges"}, ("shadow lattice", "no light has a single direction")),
    ("glass_in_fog", [], "beam", VIEW | {"boundary correction", "refined edges"}, ("shadow lattice", "no light has a single direction")),
    ("headlights", [], "beam", VIEW | {"forward peak", "boundary correction", "refined edges", "branches"},
     ("shadow lattice", "no light has a single direction")),
    ("lighthouse", ["-f", "8"], "beam", VIEW | {"boundary correction", "refined edges"},
     ("shadow lattice", "no light has a single direction")),
]


class PlanFeatures(InTempFolder):
    def plan(self, scene, *options):
        code, text = run(BINARY, "plan", str(DATA / f"{scene}.toml"), "--json", *options)
        self.assertEqual(code, 0, text)
        return json.loads(text[text.index("{"):])

    def test_of_twelve_scenes(self):
        for scene, options, estimator, on, (feature, reason) in SCENES:
            with self.subTest(scene=scene, options=options):
                plan = self.plan(scene, *options)
                self.assertEqual({f["name"] for f in plan["features"] if f["on"]}, on)
                self.assertEqual([f["reason"] for f in plan["features"] if f["name"] == feature], [reason])
                self.assertEqual(plan["schedule"][0]["estimator"], estimator)
                self.assertTrue(all(f["reason"] for f in plan["features"]))

    def test_passes_gather_with_smaller_kernels_and_fits(self):
        passes = self.plan("cloud", "--passes", "64")["schedule"]
        self.assertEqual([passes[0]["pass"], passes[-1]["pass"]], [0, 63])
        for before, after in zip(passes, passes[1:]):
            self.assertLess(after["kernel_scale"], before["kernel_scale"])
            self.assertLessEqual(after["regression_radius"], before["regression_radius"])

    def test_text_and_headers_only(self):
        code, text = run(BINARY, "plan", str(DATA / "cloud.toml"))
        self.assertEqual(code, 0, text)
        self.assertIn("final gathering      photons are gathered at the end of", text)
        self.assertIn("features that are off", text)
        plan = self.plan("cloud", "--no-pilot")
        self.assertEqual([plan["features"], plan["schedule"]], [[], []])

    def test_report_and_image_hold_the_same(self):
        plan = self.plan("cloud", "--passes", "2", "--resolution", "96x54")
        report, image = self.file("r.json"), self.file("o.exr")
        code, text = run(BINARY, "render", str(DATA / "cloud.toml"), "-o", image, "--report", report, "--passes", "2",
                         "--resolution", "96x54")
        self.assertEqual(code, 0, text)
        rendered = json.loads(Path(report).read_text(encoding="utf-8"))["plan"]
        self.assertEqual(rendered["features"], plan["features"])
        self.assertEqual(rendered["schedule"], plan["schedule"])
        code, text = run("oiiotool", "--info", "-v", image)
        self.assertEqual(code, 0, text)
        self.assertIn("forward peak: on; final gathering: on", text)


if __name__ == "__main__":
    unittest.main()
