"""A partial image whose header claims another size is rendered anew, whatever memory that size would take."""
import os
import resource
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

BINARY = os.environ.get("VDBEAM_BINARY", "build/release/vdbeam")
SCENE = Path(__file__).resolve().parents[2] / "data" / "cloud.toml"
ADDRESS_SPACE = 8 << 30


def render(output):
    return subprocess.run(
        [BINARY, "render", SCENE, "--resolution", "32x18", "--passes", "2", "--pass-range", "0-1", "--skip-existing",
         "--set", "render.photons=1000", "-o", output],
        capture_output=True, text=True, check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE)))


def claim_size(path, width, height):
    data = bytearray(path.read_bytes())
    for window in (b"dataWindow\0box2i\0", b"displayWindow\0box2i\0"):
        start = data.index(window) + len(window) + 4
        data[start:start + 16] = struct.pack("<4i", 0, 0, width - 1, height - 1)
    path.write_bytes(data)


class HugePartial(unittest.TestCase):
    def test_is_rendered_anew(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "p.exr")
            self.assertEqual(render(path).returncode, 0)
            right = path.read_bytes()
            claim_size(path, 40000, 4000)
            done = render(path)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(len(path.read_bytes()) // 1000, len(right) // 1000)
            again = render(path)
            self.assertEqual(again.returncode, 0)
            self.assertIn("is there", again.stderr + again.stdout)


if __name__ == "__main__":
    unittest.main()
