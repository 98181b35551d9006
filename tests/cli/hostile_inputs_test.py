"""Small files that claim to be large, or hold less than they claim, are refused in one line and at small cost."""
import os
import struct
import subprocess
import tempfile
import unittest
import zlib
from pathlib import Path

BINARY = os.environ.get("VDBEAM_BINARY", "build/release/vdbeam")
DATA = Path(__file__).resolve().parents[2] / "data"
SIDE = 16384
MOST_MEBIBYTES = 300


def png(bits, color_type):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    header = struct.pack(">IIBBBBB", SIDE, SIDE, bits, color_type, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"")) + chunk(b"IEND", b"")


def hdr():
    return f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {SIDE} +X {SIDE}\n".encode()


def exr(width, height, compression, lines_per_chunk, chunk):
    """R, G and B as floats; all chunks are the same few bytes."""
    def attribute(name, kind, body):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(body)) + body
    channels = b"".join(name + b"\0" + struct.pack("<IBBBBII", 2, 0, 0, 0, 0, 1, 1) for name in (b"B", b"G", b"R"))
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<II", 20000630, 2)
    head += attribute(b"channels", b"chlist", channels + b"\0")
    head += attribute(b"compression", b"compression", bytes([compression]))
    head += attribute(b"dataWindow", b"box2i", window) + attribute(b"displayWindow", b"box2i", window)
    head += attribute(b"lineOrder", b"lineOrder", b"\0")
    head += attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    head += attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
    head += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    rows = range(0, height, lines_per_chunk)
    start = len(head) + 8 * len(rows)
    chunks = [struct.pack("<iI", y, len(chunk)) + chunk for y in rows]
    offsets = b"".join(struct.pack("<Q", start + i * len(chunks[0])) for i in range(len(rows)))
    return head + offsets + b"".join(chunks)


NONE, RLE, ZIPS, ZIP, DWAB = 0, 1, 2, 3, 9
FEW = zlib.compress(bytes(64))
BOMBS = {"8 bits.png": png(8, 6), "16 bits.png": png(16, 6), "a.hdr": hdr(),
         "dwa.exr": exr(SIDE, SIDE, DWAB, 256, b"\0"), "zip.exr": exr(SIDE, SIDE, ZIP, 16, FEW)}
# What the file lacks would be whatever the heap held.
SHORT = {"zip.exr": exr(1024, 16, ZIP, 16, FEW), "zips.exr": exr(1024, 4, ZIPS, 1, FEW),
         "rle.exr": exr(1024, 4, RLE, 1, bytes([63, 0])), "none.exr": exr(1024, 4, NONE, 1, bytes(64)),
         "not deflated.exr": exr(1024, 16, ZIP, 16, bytes(64))}
SOUND = {"zip.exr": exr(1024, 16, ZIP, 16, zlib.compress(bytes(1024 * 16 * 12))),
         "zips.exr": exr(1024, 4, ZIPS, 1, zlib.compress(bytes(1024 * 12))),
         "rle.exr": exr(1024, 4, RLE, 1, bytes([127, 0]) * (1024 * 12 // 128)),
         "none.exr": exr(1024, 4, NONE, 1, bytes(1024 * 12))}


class HostileInputs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_on(self, *command):
        """Exit code, standard error, and the most memory in MiB of the program and its readers."""
        with subprocess.Popen([BINARY, *command], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              text=True) as process:
            text = process.stderr.read()
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, text, usage.ru_maxrss / 1024

    def compare(self, name, data):
        (self.folder / name).write_bytes(data)
        return self.run_on("compare", name, name)

    def expect_refused(self, name, data):
        code, text, mebibytes = self.compare(name, data)
        self.assertEqual(code, 2, text)
        self.assertEqual(text.count("\n"), 1, text)
        self.assertIn(name, text)
        self.assertLess(mebibytes, MOST_MEBIBYTES)

    def test_pictures_that_their_files_cannot_hold(self):
        for name, data in BOMBS.items():
            with self.subTest(name):
                self.expect_refused(name, data)

    def test_chunks_of_fewer_pixels(self):
        for name, data in SHORT.items():
            with self.subTest(name):
                self.expect_refused(name, data)

    def test_whole_chunks_are_read(self):
        for name, data in SOUND.items():
            with self.subTest(name):
                code, text, _ = self.compare(name, data)
                self.assertEqual(code, 0, text)

    def test_a_grid_of_far_more_voxels_than_its_file_says(self):
        data = bytearray((DATA / "fog.vdb").read_bytes())
        name = b"file_voxel_count"
        at = data.index(name) + len(name)
        at += 4 + struct.unpack_from("<I", data, at)[0]  # the type's name
        self.assertEqual(struct.unpack_from("<I", data, at)[0], 8)
        voxels = struct.unpack_from("<q", data, at + 4)[0]
        for declared, expected in ((voxels // 2, 0), (voxels // 2000, 3)):
            struct.pack_into("<q", data, at + 4, declared)
            (self.folder / "a.vdb").write_bytes(data)
            code, text, mebibytes = self.run_on("render", "a.vdb", "--resolution", "8x8", "--passes", "1", "--quiet",
                                                "-o", "a.exr")
            self.assertEqual(code, expected, text)
            self.assertLess(mebibytes, MOST_MEBIBYTES)
        self.assertIn("a.vdb", text)
        self.assertIn(str(voxels), text)


if __name__ == "__main__":
    unittest.main()
