#!/usr/bin/env python3
"""What plan says about twelve scenes: the parts of the method that each uses, why others are left out, and what its
passes are; the report and the image of a render hold the same."""
import json
import re
import sys
import unittest
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import BINARY, DATA, InTempFolder, run

VIEW = {"view importance", "path guide", "kernel pilot"}
GATHER = VIEW | {"forward peak", "final gathering", "shadow lattice", "boundary correction", "refined edges"}
# A cloud with a peaked phase function in isotropic mist, under a sun and an even sky.
TWO_VOLUMES = """
[camera]
position = [0.3, 1.2, 7.0]
look_at = [0.02, 0.5, 0.0]
fov = 24

[[volume]]
file = "{data}/cloud.vdb"
extinction = 40
phase = {{ type = "henyey_greenstein", g = 0.85 }}

[[volume]]
file = "{data}/fog.vdb"
extinction = 0.1

[[light]]
type = "distant"
direction = [-0.55, -0.66, -0.44]
irradiance = [5, 5, 5]

[[light]]
type = "environment"
radiance = [0.25, 0.25, 0.25]
"""


class Row(NamedTuple):
    """What plan says of a scene."""
    scene: str
    options: list
    estimator: str  # of the first pass
    on: set         # features
    off: tuple      # one of the others, and why
    scope: dict     # of features: what does without them
    origins: dict   # of numbers


MEASURED = {"light paths": "measured", "neighbours": "measured", "kernel scale": "default",
            "shadow rays per camera ray": "measured"}
WALKS = {**MEASURED, "walks per camera ray": "measured", "fit [pixels]": "measured"}
NO_WALKS = ("branches", "photons carry the light; only bias probes are path traced")
NO_PEAK = ("branches", "no phase function has a sharp enough peak, and no lamp stands in the medium")
NO_SUN = ("shadow lattice", "no light has a single direction")
ON_SURFACES = {"view importance": "photons on surfaces", "kernel pilot": "kernels of photons on surfaces"}
SCENES = [
    Row("cloud", [], "gather", GATHER, NO_WALKS, {"branches": "all paths and walks"}, WALKS),
    Row("cloud", ["--estimator", "beam"], "beam", GATHER - {"final gathering", "refined edges"},
        ("final gathering", "render.estimator names another method"),
        {"final gathering": "the scene", "refined edges": "all pixels"}, MEASURED),
    Row("cloud", ["--estimator", "path"], "path", set(), ("shadow lattice", "the estimator traces no photons"),
        {"view importance": "the scene", "shadow lattice": "all shadow rays"}, {}),
    Row("smoke", ["-f", "8"], "gather", GATHER - {"forward peak"},
        ("forward peak", "no phase function has a peak that is worth truncating"), {"forward peak": "the scene"},
        WALKS),
    Row("sunlit_cloud", [], "gather", GATHER, NO_WALKS, {}, WALKS),
    Row("fire", ["-f", "14"], "gather", GATHER - {"forward peak"}, NO_WALKS, {}, WALKS),
    Row("ball_in_smoke", [], "gather", GATHER - {"forward peak"}, NO_PEAK, {}, WALKS),
    Row("cloud_over_ground", [], "gather", GATHER, NO_PEAK, ON_SURFACES, WALKS),
    Row("cornell_fog", [], "beam", VIEW | {"boundary correction", "refined edges"}, NO_SUN,
        {"refined edges": "edges of the medium", "shadow lattice": "all shadow rays"}, MEASURED),
    Row("glass_in_fog", [], "beam", VIEW | {"boundary correction", "refined edges"}, NO_SUN, {}, MEASURED),
    Row("headlights", [], "beam", VIEW | {"boundary correction", "refined edges", "branches"}, NO_SUN,
        {"branches": "paths to mesh.3, mesh.4"}, MEASURED),
    Row("lighthouse", ["-f", "8"], "beam", VIEW | {"boundary correction", "hidden lights", "refined edges"}, NO_SUN,
        {"final gathering": "the scene"}, MEASURED),
    Row("sunlit_water", [], "gather", GATHER - {"shadow lattice"},
        ("shadow lattice", "extinction differs between channels"),
        {"shadow lattice": "all shadow rays, because of volume.0",
         "final gathering": "rays behind mirrors and glass, and caustics of light.0"}, WALKS),
    Row("two_volumes", ["--set", "render.photons=20000", "--set", "render.neighbours=100"], "beam",
        GATHER - {"kernel pilot", "final gathering", "refined edges"},
        ("refined edges", "without surfaces, only final gathering refines edges"),
        {"forward peak": "volume.1", "kernel pilot": "the scene"},
        {"light paths": "scene", "neighbours": "scene", "kernel scale": "default"}),
    Row("two_volumes", ["--set", "render.direct=photons"], "beam", VIEW | {"boundary correction"},
        ("forward peak", "a light other than a constant sky is sampled by photons only"),
        {"forward peak": "the scene, because of light.0", "final gathering": "the scene, because of light.0"}, {}),
]


class PlanFeatures(InTempFolder):
    def plan(self, scene, *options):
        path = DATA / f"{scene}.toml"
        if scene == "two_volumes":
            path = Path(self.file("two_volumes.toml"))
            path.write_text(TWO_VOLUMES.format(data=DATA), encoding="utf-8")
        code, text = run(BINARY, "plan", str(path), "--json", *options)
        self.assertEqual(code, 0, text)
        return json.loads(text[text.index("{"):])

    def test_of_twelve_scenes(self):
        self.assertEqual(len({row.scene for row in SCENES}), 12)
        for row in SCENES:
            with self.subTest(scene=row.scene, options=row.options):
                plan = self.plan(row.scene, *row.options)
                features = {f["name"]: f for f in plan["features"]}
                self.assertEqual({name for name, f in features.items() if f["on"]}, row.on)
                self.assertEqual(features[row.off[0]]["reason"], row.off[1])
                self.assertEqual(plan["schedule"][0]["estimator"], row.estimator)
                for name, scope in row.scope.items():
                    self.assertEqual(features[name]["scope"], scope, name)
                origins = {n["name"]: n["origin"] for n in plan["numbers"]}
                self.assertEqual({name: origins[name] for name in row.origins}, row.origins)
                self.check_feature_texts(plan["features"])
                self.assertTrue(all(n["reason"] for n in plan["numbers"]))

    def check_feature_texts(self, features):
        """All have reasons; those that are off say what does without them; pilots that ran say what they took."""
        for feature in features:
            self.assertTrue(feature["reason"])
            self.assertTrue(feature["on"] or feature["scope"])
            if feature["on"] and feature["name"] in VIEW:
                self.assertRegex(feature["cost"],
                                 r"^a pilot of .*\d+ (light paths|camera rays) \([\d.e+]+ % of a pass\)$")
            if feature["name"] in ("boundary correction", "shadow lattice"):
                self.assertNotIn("cost", feature)
        gather = next(f for f in features if f["name"] == "final gathering")
        if gather["on"]:
            self.assertRegex(gather["cost"], r"gathering along camera rays has [\d.e+]+ times its forecast error")

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
        self.assertRegex(text, r"measured on small photon maps; a pilot of \d+ light paths")
        self.assertRegex(text, r"light paths +\d+ +measured +4[.\d]* for each of \d+ camera rays")
        self.assertRegex(text, r"kernel scale +1 to 0\.\d+ +default +kernels shrink by render.alpha = 0.6")
        plan = self.plan("cloud", "--no-pilot")
        self.assertEqual([plan["features"], plan["schedule"], plan["numbers"]], [[], [], []])

    def test_report_and_image_hold_the_same(self):
        plan = self.plan("cloud", "--passes", "2", "--resolution", "96x54")
        report, image = self.file("r.json"), self.file("o.exr")
        code, text = run(BINARY, "render", str(DATA / "cloud.toml"), "-o", image, "--report", report, "--passes", "2",
                         "--resolution", "96x54")
        self.assertEqual(code, 0, text)
        rendered = json.loads(Path(report).read_text(encoding="utf-8"))["plan"]
        self.assertEqual(rendered["features"], plan["features"])
        self.assertEqual(rendered["schedule"], plan["schedule"])
        self.assertEqual(rendered["numbers"], plan["numbers"])
        code, text = run("oiiotool", "--info", "-v", image)
        self.assertEqual(code, 0, text)
        self.assertIn("forward peak: on; final gathering: on [at equal time", text)
        self.assertRegex(text, r"vdbeam:numbers: .light paths: \d+ \(default\); neighbours: \d+ \(measured\)")
        columns = json.loads(re.search(r'vdbeam:schedule: "(.*)"', text)[1].replace('\\"', '"'))
        passes = [dict(zip(columns, values)) for values in zip(*columns.values())]
        self.assertEqual(passes, plan["schedule"])


if __name__ == "__main__":
    unittest.main()
