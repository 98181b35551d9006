#!/usr/bin/env python3
"""A test whose part of the machine is missing is skipped, and fails where VDBEAM_REQUIRE names that part."""

import os
import subprocess
import sys
import unittest
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
# Each ends at once where no program is found.
PARTS = {"slurm": "farm/slurm_test.py", "browser": "tools/error_page_test.py",
         "blender": "blender/engine_test.py",
         "disk": "cli/full_disk_test.py", "binutils": "package/linked_libraries_test.py"}


def run_without_programs(script, required):
    environment = {**os.environ, "PATH": "/nonexistent", "VDBEAM_REQUIRE": required,
                   "VDBEAM_BINARY": "vdbeam"}
    return subprocess.run([sys.executable, "-B", TESTS / script], env=environment,
                          capture_output=True, text=True, check=False)


class Requirements(unittest.TestCase):
    def test_a_missing_part_skips_or_fails(self):
        for part, script in PARTS.items():
            for required, status in (("", 77), (f"other,{part}", 1), ("other", 77)):
                with self.subTest(part=part, required=required):
                    result = run_without_programs(script, required)
                    self.assertEqual(result.returncode, status, result.stdout + result.stderr)
                    self.assertEqual(len(result.stdout.splitlines()), 1, result.stdout)

    def test_ci_requires_every_part(self):
        ci = (TESTS.parent / ".ci/run").read_text(encoding="utf-8")
        self.assertIn("VDBEAM_REQUIRE=slurm,browser,disk,numpy,binutils", ci)


if __name__ == "__main__":
    unittest.main()
