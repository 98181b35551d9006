#!/usr/bin/env python3
"""tools/cycles_curve.py with stand-ins for both renderers, whose errors are known; Blender is not needed."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.path.insert(0, str(ROOT / "tests/support"))
from requirements import DEBIAN, import_failed

try:
    import numpy as np
    import cycles_curve
    from error_curves import exr
except ModuleNotFoundError as problem:
    import_failed(problem)

SETTINGS = """{"image": {"width": 32, "height": 16}, "camera": {"up": [0, 1, 0]}, "light": [], "volume": [],
"render": {"max_bounces": None}}"""
# Both use processor time in proportion to their work, and give 1 + 0.2 / sqrt(work) times alternating signs.
RENDERER = f"""#!{DEBIAN}
import json, sys, time
sys.path.insert(0, "{ROOT / 'tools'}")
import numpy as np
from error_curves import exr

def render(path, work):
    begin = time.process_time()
    while time.process_time() - begin < 0.05 * work:
        pass
    signs = np.where(np.indices((16, 32)).sum(0) % 2, 1.0, -1.0)
    exr.write_rgb(path, 1 + np.repeat(0.2 / work ** 0.5 * signs[:, :, None], 3, 2))

if "--python" in sys.argv:
    job = json.load(open(sys.argv[-1]))
    begin = time.process_time()
    render(job["image"], job["samples"])
    json.dump({{"seconds": 1, "processor_seconds": time.process_time() - begin, "version": "0"}}, open(job["result"], "w"))
else:
    render(sys.argv[sys.argv.index("-o") + 1], int(sys.argv[sys.argv.index("--passes") + 1]))
    json.dump({{"settings": {SETTINGS}}}, open(sys.argv[sys.argv.index("--report") + 1], "w"))
"""


class Error(unittest.TestCase):
    def test_noise_of_references_drops_out(self):
        random = np.random.default_rng(1)
        truth = random.uniform(0.1, 2, (200, 200, 3))

        def noisy(relative):
            return truth + (truth + 0.01) * relative * random.standard_normal(truth.shape)

        mrse, bias = cycles_curve.error(noisy(0.02), (noisy(0.05), noisy(0.05)))
        # 120,000 products of 0.0004 on average, whose standard deviation is about 0.003. The references' noise,
        # which against one of them would add 0.0025, is left in the denominator: 1.5 x 0.05^4.
        self.assertAlmostEqual(mrse, 0.0004 + 1.5 * 0.05**4, delta=5 * 0.003 / 120000**0.5)
        self.assertLess(abs(bias), 0.002)
        # A picture that is brighter by 3 %.
        mrse, bias = cycles_curve.error(1.03 * truth, (noisy(0.01), noisy(0.01)))
        self.assertAlmostEqual(bias, 0.03, delta=0.002)
        self.assertAlmostEqual(mrse, 0.0009, delta=0.0001)


class Table(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        for name in ("vdbeam", "blender"):
            (self.folder / name).write_text(RENDERER, encoding="utf-8")
            (self.folder / name).chmod(0o755)
        for name in ("a.exr", "b.exr"):
            exr.write_rgb(self.folder / name, np.ones((16, 32, 3)))

    def run_tool(self, *arguments):
        return subprocess.run(
            [DEBIAN, "-B", ROOT / "tools/cycles_curve.py", self.folder / "scene.toml", "--references",
             self.folder / "a.exr", self.folder / "b.exr", "--binary", self.folder / "vdbeam", "-o",
             self.folder / "out", "--passes", "1,4", "--samples", "4", "--step-rates", "1,0.5", *arguments],
            capture_output=True, text=True, check=False, env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})

    def test_rows(self):
        result = self.run_tool()
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in result.stdout.splitlines()[2:]]
        self.assertEqual([row[:2] for row in rows],
                         [["vdbeam, auto", "1 passes"], ["vdbeam, auto", "4 passes"],
                          ["Cycles, steps of 1", "4 samples"], ["Cycles, steps of 0.5", "4 samples"]])
        for row, work in zip(rows, (1, 4, 4, 4)):
            self.assertAlmostEqual(float(row[3]), 0.04 / 1.01**2 / work, delta=0.001 / work)
            self.assertGreaterEqual(float(row[2]), round(0.05 * work, 1) - 0.1)
            self.assertEqual(row[5].lstrip("+-"), "0.00 %")

    def test_a_render_beyond_the_limit_is_one_line(self):
        result = self.run_tool("--passes", "200", "--limit", "0.5")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr, "cycles_curve.py: a render took more than 0.5 s (--limit)\n")


if __name__ == "__main__":
    unittest.main()
