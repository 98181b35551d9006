"""A stand-in for `vdbeam render` whose error is known: C / seconds."""

import struct
from pathlib import Path

# Takes the options that the tool may give, refuses others, and writes one image per estimator.
FAKE_RENDERER = """#!/usr/bin/python3
import argparse, json, shutil, sys
parser = argparse.ArgumentParser()
parser.add_argument("command", choices=["render"])
parser.add_argument("scene")
for name in ("-o", "--report", "--estimator", "--time", "--reference",
             "--second-reference"):
    parser.add_argument(name)
for name in ("--seed", "--passes", "--threads"):
    parser.add_argument(name, type=int)
options = parser.parse_args()
with open(__file__ + ".log", "a") as log:
    print(options.scene, options.estimator, options.seed, options.reference,
          *([options.second_reference] if options.second_reference else []), file=log)
if "broken" in options.scene:
    print("broken.toml:3: medium.g must lie in (-1, 1), got 1.2", file=sys.stderr)
    sys.exit(2)
budget = float(options.time.rstrip("s"))
product = {"beam": 0.002, "gather": 0.001, "march": 0.05, "path": 0.03}[options.estimator]
product *= 1 + 0.1 * (options.seed % 3 - 1)
passes = []
for i in range(1, 41):
    seconds = budget * i / 40
    entry = {"pass": i, "seconds": seconds, "photons": 1000,
             "error_estimate": None if i == 1 else product / seconds}
    if options.reference:
        entry.update(rmse=0.1, mrse=product / seconds, relmse=0.1, bias=-0.001)
    passes.append(entry)
shutil.copy(f"{__file__}.{options.estimator}.exr", options.o)
json.dump({"passes": passes, "versions": {"vdbeam": "1.2.3"},
           "machine": {"cpu": "Abacus", "cores": 2, "threads": 2}}, open(options.report, "w"))
"""


DATE = "2026:03:14 15:09:26"


def tiny_exr(brightness):
    """An uncompressed EXR of 2 x 1 pixels: R, G, B as floats, and when it was rendered."""
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data

    channels = b"".join(name + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in (b"B", b"G", b"R"))
    window = struct.pack("<4i", 0, 0, 1, 0)
    header = (b"\x76\x2f\x31\x01\x02\0\0\0" + attribute(b"capDate", b"string", DATE.encode())
              + attribute(b"channels", b"chlist", channels + b"\0")
              + attribute(b"compression", b"compression", b"\0")
              + attribute(b"dataWindow", b"box2i", window)
              + attribute(b"displayWindow", b"box2i", window)
              + attribute(b"lineOrder", b"lineOrder", b"\0")
              + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
              + attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
              + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0")
    pixels = struct.pack("<6f", *(brightness * x for x in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6)))
    return (header + struct.pack("<Q", len(header) + 8) + struct.pack("<ii", 0, len(pixels)) + pixels)


def install(folder):
    """Puts the program and its images in a folder; its path."""
    binary = Path(folder) / "vdbeam"
    binary.write_text(FAKE_RENDERER, encoding="utf-8")
    binary.chmod(0o755)
    for estimator, brightness in (("beam", 1), ("gather", 1.1), ("march", 0.5), ("path", 1.2)):
        Path(f"{binary}.{estimator}.exr").write_bytes(tiny_exr(brightness))
    return binary
