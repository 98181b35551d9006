#!/usr/bin/env python3
"""tools/error_vs_time.py with a stand-in for the renderer whose error is known: C / seconds."""

import csv
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from fake_renderer import install

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools/error_vs_time.py"


class ErrorVsTime(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.output = self.folder / "out"
        self.binary = install(self.folder)
        for name in ("cloud", "smoke", "broken"):
            (self.folder / f"{name}.toml").write_text(f"# {name}\n", encoding="utf-8")

    def run_tool(self, *arguments, scenes=("cloud", "smoke"), plots=False):
        command = [TOOL, "--binary", self.binary, "--output", self.output, "--time", "8",
                   "--scenes", *(self.folder / f"{name}.toml" for name in scenes), *arguments]
        command += [] if plots else ["--no-plots"]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def calls(self):
        log = Path(f"{self.binary}.log").read_text(encoding="utf-8")
        return [line.split()[1:] for line in log.splitlines()]

    def table_row(self, scene, estimator):
        for line in (self.output / "table.md").read_text(encoding="utf-8").splitlines():
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            if cells[:2] == [scene, estimator]:
                return cells
        self.fail(f"no row of {scene} {estimator}")

    def test_writes_curves_plots_and_table(self):
        result = self.run_tool(plots=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.output / "curves.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 2 * 4 * 3 * 40)
        self.assertEqual(rows[0]["scene"], "cloud")
        self.assertAlmostEqual(float(rows[1]["seconds"]) * float(rows[1]["mrse"]), 0.002)
        for scene in ("cloud", "smoke"):
            self.assertEqual((self.output / f"{scene}.png").read_bytes()[:4], b"\x89PNG")
            self.assertIn("<svg", (self.output / f"{scene}.svg").read_text(encoding="utf-8"))
        page = (self.output / "index.html").read_text(encoding="utf-8")
        self.assertEqual(page.count("data:image/svg+xml"), 4)  # for light and for dark pages
        self.assertIn("Measured 2026-03-14; Abacus, 2 cores, 2 threads; vdbeam 1.2.3.", page)
        for text in ("MRSE x s at 0.01", "&ldquo;-&rdquo; means", "<h2>What the numbers mean</h2>"):
            self.assertIn(text, page)
        # 4 images, 4 error images and a reference for each of 2 scenes, and the scale of the errors.
        self.assertEqual(page.count("data:image/png"), 2 * 9 + 1)
        self.assertNotIn("http", page)
        beam = self.table_row("cloud", "beam")
        self.assertEqual(beam[2:4], ["3", "40"])
        self.assertEqual(beam[6], "-0.10 %")
        # Seeds 1, 2, 3 have factors 1, 1.1, 0.9: the geometric mean of the products is 0.00199.
        self.assertEqual(beam[7:], ["0.002", "0.002", "0.002"])
        # 0.03 / 8 s: an error of 0.001 is never reached.
        self.assertEqual(self.table_row("smoke", "path")[7:], ["0.03", "-", "0.03"])

    def test_axes_have_several_numbers(self):
        self.assertEqual(self.run_tool(plots=True).returncode, 0)
        svg = (self.output / "cloud.svg").read_text(encoding="utf-8")
        # Matplotlib draws text as paths and leaves it in comments. The runs last 0.2 to 8 seconds.
        labels = re.findall(r"<!-- ([\d.e+-]+) -->", svg)
        for number in ("0.2", "0.5", "1", "2", "5", "0.01", "0.001"):
            self.assertIn(number, labels)

    def test_estimators_take_turns_and_references_are_cached(self):
        self.assertEqual(self.run_tool("--seeds", "4,6-7", scenes=("cloud",)).returncode, 0)
        calls = self.calls()
        self.assertEqual(calls[0], ["path", "999983", "None"])
        # Each seed begins with another one.
        turns = ("4", "beam gather march path"), ("6", "gather march path beam"), ("7", "march path beam gather")
        self.assertEqual([call[:2] for call in calls[1:]],
                         [[e, seed] for seed, order in turns for e in order.split()])
        self.assertTrue(all(call[2].endswith(".exr") for call in calls[1:]))
        self.assertEqual(self.run_tool("--seeds", "1", scenes=("cloud",)).returncode, 0)
        self.assertEqual(len([c for c in self.calls() if c[1] == "999983"]), 1)
        (self.folder / "cloud.toml").write_text("# changed\n", encoding="utf-8")
        self.assertEqual(self.run_tool("--seeds", "1", scenes=("cloud",)).returncode, 0)
        self.assertEqual(len([c for c in self.calls() if c[1] == "999983"]), 2)

    def test_given_reference_and_options_are_passed_on(self):
        result = self.run_tool("--reference", "cloud=/r/true.exr", "--estimators", "beam",
                               "--option=--threads=2", scenes=("cloud",))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.calls(), [["beam", str(s), "/r/true.exr"] for s in (1, 2, 3)])

    def test_two_references_are_passed_on(self):
        result = self.run_tool("--reference", "cloud=/r/a.exr,/r/b.exr", "--estimators", "beam", "--seeds", "1",
                               scenes=("cloud",))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.calls(), [["beam", "1", "/r/a.exr", "/r/b.exr"]])
        self.assertEqual(self.run_tool("--reference", "cloud=a.exr,b.exr,c.exr").returncode, 2)

    def test_variants_are_estimators_with_other_settings(self):
        result = self.run_tool("--estimators", "beam", "--seeds", "1",
                               "--variant", "quick: --estimator path --threads 1",
                               scenes=("cloud",), plots=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([call[0] for call in self.calls()[1:]], ["beam", "path"])
        self.assertEqual(self.table_row("cloud", "quick")[7:], ["0.03", "-", "0.03"])
        self.assertIn('"name": "quick"', (self.output / "index.html").read_text(encoding="utf-8"))
        for wrong in (["--variant", "a/b: --threads=1"], ["--variant", "beam: --threads=1"]):
            self.assertEqual(self.run_tool(*wrong, scenes=("cloud",)).returncode, 2, wrong)

    def test_plots_again_without_rendering(self):
        self.assertNotEqual(self.run_tool("--plot-only").returncode, 0)
        self.assertEqual(self.run_tool("--seeds", "1").returncode, 0)
        count = len(self.calls())
        (self.output / "curves.csv").unlink()
        self.assertEqual(self.run_tool("--plot-only").returncode, 0)
        self.assertTrue((self.output / "curves.csv").exists())
        self.assertFalse((self.output / "cloud.png").exists())
        self.assertEqual(len(self.calls()), count)

    def test_failures_are_one_clear_line(self):
        result = self.run_tool(scenes=("broken",))
        self.assertEqual(result.returncode, 1)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn("medium.g must lie in (-1, 1)", result.stderr)
        for arguments in (["--seeds", "x"], ["--time", "-1"], ["--reference", "sky=a.exr"]):
            self.assertEqual(self.run_tool(*arguments).returncode, 2, arguments)

    def test_missing_modules_are_one_line(self):
        for name in ("numpy", "matplotlib"):
            folder = self.folder / name
            folder.mkdir()
            (folder / f"{name}.py").write_text(f"raise ModuleNotFoundError('not here', name='{name}')\n",
                                               encoding="utf-8")
            result = subprocess.run([TOOL, "--binary", self.binary, "--output", self.output, "--scenes",
                                     self.folder / "cloud.toml", "--seeds", "1"], capture_output=True,
                                    text=True, check=False, env={**os.environ, "PYTHONPATH": str(folder)})
            self.assertEqual(result.returncode, 1)
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
            self.assertIn(f"module {name} is missing; Debian has python3-numpy", result.stderr)

    def test_reports_without_errors_are_refused(self):
        self.assertEqual(self.run_tool("--seeds", "1", scenes=("cloud",)).returncode, 0)
        report = self.output / "runs/cloud.beam.1.json"
        for text, reason in (("{", "not a readable report"), ("{}", "no passes"),
                             ('{"passes": [{"pass": 1, "seconds": 1}]}', "no mrse")):
            report.write_text(text, encoding="utf-8")
            result = self.run_tool("--plot-only", "--seeds", "1", scenes=("cloud",))
            self.assertEqual(result.returncode, 1)
            self.assertIn(reason, result.stderr)


if __name__ == "__main__":
    unittest.main()
