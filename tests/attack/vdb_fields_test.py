#!/usr/bin/env python3
"""The campaign's damage to VDBs lands on their fields, and leaves the rest of the file as it was."""
import random
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools/attack"), str(ROOT / "tests/support")]
import vdb_fields  # noqa: E402
from program import BINARY  # noqa: E402

FOG = (ROOT / "data/fog.vdb").read_bytes()


def info(data):
    """What the program says of a file with this content."""
    with tempfile.NamedTemporaryFile(suffix=".vdb") as file:
        file.write(data)
        file.flush()
        return subprocess.run([BINARY, "info", file.name], check=False, capture_output=True, text=True,
                              timeout=60).stdout.replace(file.name, "FILE")


class Fields(unittest.TestCase):
    def setUp(self):
        self.file = vdb_fields.Vdb(FOG)

    def field(self, name):
        return next(field for field in self.file.fields if field.name == name)

    def test_every_kind_of_field_is_found(self):
        for name in ("version", "tree of a grid", "begin of its values", "compression", "value of file_voxel_count", "map",
                     "number 0 of the map", "background", "number of root children", "x of an origin", "mask of children"):
            self.assertTrue(self.field(name).values, name)
        self.assertEqual(self.file.at, len(FOG))

    def test_a_longer_field_moves_what_lies_behind_it(self):
        longer = self.file.with_value(self.field("name of a grid"), vdb_fields.text(b"a longer name"))
        self.assertEqual(info(longer).replace("a longer name", "density").split(), info(FOG).split())

    def test_a_scale_can_be_no_number(self):
        data = self.file.with_value(self.field("number 0 of the map"), struct.pack("<d", float("nan")))
        self.assertNotEqual(info(data), info(FOG))

    def test_most_mutants_differ_and_can_be_made_again(self):
        mutants = [vdb_fields.vdb(FOG, random.Random(seed)) for seed in range(100)]
        self.assertLess(mutants.count(FOG), 10)
        self.assertEqual(mutants[:20], [vdb_fields.vdb(FOG, random.Random(seed)) for seed in range(20)])


if __name__ == "__main__":
    unittest.main()
