#!/usr/bin/env python3
"""tools/flicker.py on a cloud that grows denser: correlated seeds flicker less."""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import flicker  # noqa: E402


class Flicker(unittest.TestCase):
    def run_tool(self, *words):
        return subprocess.run([sys.executable, "-B", str(ROOT / "tools/flicker.py"), *words],
                              env=os.environ, capture_output=True, text=True, check=False)

    def test_table(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder, "cloud.toml")
            text = (ROOT / "data/cloud.toml").read_text()
            text = text.replace('"cloud.vdb"', f'"{ROOT}/data/cloud.vdb"')
            scene.write_text(re.sub(r"extinction = \S+",
                                    "extinction = { keys = [[1, 40], [3, 42]] }", text))
            result = self.run_tool(str(scene), "-f", "1-3", "--resolution", "32x18", "--passes", "2",
                                   "--reference-passes", "64", "--variant",
                                   "more:render.photons=20000,render.estimator=beam")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = [line.split("|") for line in result.stdout.splitlines()[2:]]
        self.assertEqual([row[2].strip() for row in rows], ["per_frame", "correlated"])
        temporal = [float(row[4]) for row in rows]
        self.assertLess(temporal[1], 0.75 * temporal[0])

    def test_jumps(self):
        """One pair of five that differs tenfold, and a frame whose mean is 1 % too bright."""
        frames = [{"temporal": temporal, "bias": bias} for temporal, bias in
                  zip((None, 1, 1, 10, 1, 1), (0, 0, 0.01, 0, 0, 0))]
        worst, jump = flicker.jumps(frames)
        self.assertEqual(worst, 10)
        self.assertAlmostEqual(jump, 0.01)

    def test_mistakes_end_it_with_one_line(self):
        result = self.run_tool("absent.toml", "-f", "1-3")
        self.assertEqual(result.returncode, 1)
        self.assertIn("absent.toml", result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1)


if __name__ == "__main__":
    unittest.main()
