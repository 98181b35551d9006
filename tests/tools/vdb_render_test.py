#!/usr/bin/env python3
"""How tools/error_curves/vdb_render.py puts a scene into the program's words; the program is not needed."""

import copy
import json
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.path.insert(0, str(ROOT / "tests/support"))
from requirements import import_failed

try:
    import numpy as np
    from error_curves import exr, page, vdb_render
    from error_curves.peers import NotWithinMeans
    from error_curves.report import Run
except ModuleNotFoundError as problem:
    import_failed(problem)

SETTINGS = {
    "image": {"width": 320, "height": 180},
    "camera": {"position": [0.3, 1.2, 7], "look_at": [0, 0.5, 0], "up": [0, 1, 0], "fov": 24},
    "volume": [{"file": "cloud.vdb", "density": "density", "extinction": 40, "extinction_scale": [1, 1, 0.5],
                "albedo": [0.75, 1, 0.5], "transform": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0],
                "phase": {"type": "isotropic", "g": 0}}],
    "light": [{"type": "distant", "direction": [-1, -2, 0.5], "irradiance": [12.56637061, 0, 25.13274123],
               "angular_radius": 0},
              {"type": "environment", "radiance": [0, 0, 0], "image": ""}],
    "render": {"max_bounces": 1},
}


def option(command, name, count=1):
    place = command.index(name)
    values = [float(x) for x in command[place + 1].split(",")]
    assert len(values) == count, command[place + 1]
    return values


class CommandLine(unittest.TestCase):
    def test_scene_in_its_units(self):
        command = vdb_render.command(SETTINGS, 0.01, "out.exr", (0.5, 0.25), 2, 3)
        self.assertEqual(command[:3], ["vdb_render", "cloud.vdb", "out.exr"])
        self.assertEqual(command[command.index("-name") + 1], "density")
        self.assertEqual(command[command.index("-res") + 1], "640x360")
        # 0.4, 0.4, 0.2 per voxel; the albedo of it scatters.
        np.testing.assert_allclose(option(command, "-scatter", 3), [0.3, 0.4, 0.1])
        np.testing.assert_allclose(option(command, "-absorb", 3), [0.1, 0, 0.1])
        # Towards the light, and irradiance / (4 pi).
        np.testing.assert_allclose(option(command, "-light", 6), [1, 2, -0.5, 1, 0, 2], rtol=1e-6)
        np.testing.assert_allclose(option(command, "-fov")[0], 41.400985, rtol=1e-6)
        np.testing.assert_allclose(option(command, "-translate", 3), [0.3, 1.2, 7])
        np.testing.assert_allclose(option(command, "-lookat", 3), [0, 0.5, 0])
        for name, value in (("-gain", 0), ("-step", 0.5), ("-shadowstep", 0.25), ("-cpus", 3)):
            self.assertEqual(option(command, name)[0], value)
        self.assertLess(option(command, "-cutoff")[0], 1e-5)

    def test_what_it_cannot_show(self):
        vdb_render.check(SETTINGS)
        for change, reason in (
                (lambda s: s["render"].update(max_bounces=None), "single scattering"),
                (lambda s: s["volume"].append(s["volume"][0]), "one volume"),
                (lambda s: s["volume"][0]["phase"].update(type="henyey_greenstein", g=0.5), "isotropic"),
                (lambda s: s["volume"][0]["transform"].__setitem__(3, 1), "transformed"),
                (lambda s: s["light"][1].update(radiance=[0, 1, 0]), "one distant light"),
                (lambda s: s["light"][0].update(irradiance=[0, 0, 0]), "one distant light"),
                (lambda s: s["light"][0].update(angular_radius=1), "without a disc"),
                (lambda s: s["light"].append({"type": "point", "intensity": [1, 1, 1]}), "one distant")):
            settings = copy.deepcopy(SETTINGS)
            change(settings)
            with self.assertRaisesRegex(NotWithinMeans, reason):
                vdb_render.check(settings)

    def test_without_the_program_a_reason_is_given(self):
        which = vdb_render.shutil.which
        self.addCleanup(setattr, vdb_render.shutil, "which", which)
        vdb_render.shutil.which = lambda name: None
        with self.assertRaisesRegex(NotWithinMeans, "libopenvdb-tools"):
            vdb_render.run_vdb_render("vdbeam", "scene", SETTINGS, "r.exr", [1], 1, 1, Path("."))

    def test_samples_are_averaged_and_written(self):
        image = np.arange(4 * 6 * 3, dtype=np.float32).reshape(4, 6, 3)
        small = vdb_render.averaged(image, 2)
        np.testing.assert_array_equal(small[1, 2], image[2:4, 4:6].reshape(4, 3).mean(0))
        with tempfile.TemporaryDirectory() as folder:
            exr.write_rgb(f"{folder}/a.exr", small)
            np.testing.assert_array_equal(exr.read_rgb(f"{folder}/a.exr"), small)

    def test_the_page_names_the_versions_of_other_renderers(self):
        reports = {"beam": {"versions": {"vdbeam": "1.2.3"}, "settings": {"image": {}}},
                   "cycles": {"settings": {"renderer": "Cycles, Blender 3.4.1"}},
                   "vdb_render": {"settings": {"renderer": "vdb_render, OpenVDB of unknown version"}}}
        runs = [Run("cloud", name, seed) for name in reports for seed in (1, 2)]
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "runs").mkdir()
            for run in runs:
                path = Path(folder) / "runs" / f"cloud.{run.estimator}.{run.seed}.json"
                path.write_text(json.dumps(reports[run.estimator]), encoding="utf-8")
            # Without an image the date is that of the report.
            self.assertRegex(page._conditions(Path(folder), runs),
                             r"^Measured \d{4}-\d\d-\d\d; vdbeam 1.2.3; Cycles, Blender 3.4.1\.$")


if __name__ == "__main__":
    unittest.main()
