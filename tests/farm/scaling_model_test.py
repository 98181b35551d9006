#!/usr/bin/env python3
"""The model of docs/how-to/farm.md: its table is the script's, and its sums are what they should be."""
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import scaling_model


class ScalingModel(unittest.TestCase):
    def run_model(self, machines, *words):
        return scaling_model.model(scaling_model.arguments(words), machines)

    def test_documentation_shows_this_table(self):
        a = scaling_model.arguments([])
        table = scaling_model.table([scaling_model.model(a, m) for m in a.machines])
        self.assertIn(table, (ROOT / "docs" / "how-to" / "farm.md").read_text())

    def test_one_machine_renders_everything(self):
        one = self.run_model(1)
        # 256 passes of (4 + 3 * 2.359) core seconds on 32 cores, 1000 times
        self.assertAlmostEqual(one["wall"] / 3600, 1000 * 256 * 11.078 / 32 / 3600, delta=0.1)

    def test_frames_are_split_only_for_more_machines_than_frames(self):
        self.assertEqual([self.run_model(m)["splits"] for m in (1, 1000, 1001, 10000)], [1, 1, 2, 10])

    def test_every_part_reads_the_volume(self):
        self.assertAlmostEqual(self.run_model(10000)["reads"], 10 * self.run_model(1000)["reads"])

    def test_a_faster_server_helps_only_where_it_is_the_limit(self):
        fast = ("--server-gb", "500")
        self.assertLess(self.run_model(10000, *fast)["wall"], self.run_model(10000)["wall"] / 3)
        self.assertGreater(self.run_model(10, *fast)["wall"], self.run_model(10)["wall"] * 0.99)


if __name__ == "__main__":
    sys.exit(unittest.main())
