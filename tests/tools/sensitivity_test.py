#!/usr/bin/env python3
"""The table of fitted numbers: what it reads of their header, what it computes, and that the page names each of them."""

import math
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import sensitivity  # noqa: E402


class Sensitivity(unittest.TestCase):
    def test_reads_numbers_with_their_types(self):
        text = "VDBEAM_TUNED(double, a, 1.0 / 4);\nVDBEAM_TUNED(std::size_t, b, 48);\nVDBEAM_TUNED(float, c, 5e-4f);"
        self.assertEqual(sensitivity.read_constants(text),
                         [("a", "double", 0.25), ("b", "std::size_t", 48), ("c", "float", 5e-4)])

    def test_reads_every_number_of_the_header(self):
        text = sensitivity.CONSTANTS.read_text()
        self.assertEqual(len(sensitivity.read_constants(text)), len(re.findall(r"^VDBEAM_TUNED", text, re.M)))

    def test_changes_whole_numbers_to_whole_numbers(self):
        self.assertEqual(sensitivity.changed("int", 3, 0.5), 2)
        self.assertEqual(sensitivity.changed("int", 1, 0.5), 1)
        self.assertEqual(sensitivity.changed("double", 1, 0.5), 0.5)

    def test_compares_by_scene(self):
        base = {"a": [1, 2], "b": [4, 1]}
        mean, worst, most = sensitivity.ratios({"a": [2, 2], "b": [8, 3]}, base, 0)
        self.assertAlmostEqual(mean, 2)
        self.assertAlmostEqual(most, 2)
        mean, worst, most = sensitivity.ratios({"a": [2, 2], "b": [8, 3]}, base, 1)
        self.assertAlmostEqual(mean, math.sqrt(3))
        self.assertEqual((worst, most), ("b", 3))

    def test_the_page_has_a_row_for_each_number_and_its_value(self):
        page = (ROOT / "docs" / "developer" / "tuning.md").read_text()
        rows = dict(re.findall(r"^\| `(\w+)` \| ([\d.e+-]+) \|", page, re.M))
        constants = sensitivity.read_constants(sensitivity.CONSTANTS.read_text())
        self.assertEqual(rows, {name: f"{value:g}" for name, _, value in constants})


if __name__ == "__main__":
    unittest.main()
