#!/usr/bin/env python3
"""Kills a batch of frames at random moments and checks that nothing is lost but time.

A batch is rendered once undisturbed and timed. Then it is started again and again with
--skip-existing and --checkpoint, each time killed (SIGKILL and SIGTERM in turn) after a random
time, until the wanted number of kills is reached; a last start runs to the end. Every image must
then be equal to the undisturbed one, value for value, and no file may bear an image's name that is
not complete.

    tools/kill_test.py --kills 100
"""

import argparse
import os
import random
import signal
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def command(options, folder):
    return [
        options.binary, "render", str(ROOT / "data/cloud.toml"), "-f", f"1-{options.frames}",
        "-o", str(folder / "out.####.exr"), "--passes", str(options.passes),
        "--resolution", options.resolution, "--set", f"render.photons={options.photons}",
        "--set", "camera.position={keys=[[1,[0.3,1.2,7]],[12,[1.5,1.2,7]]]}",
        "--checkpoint", "1", "--skip-existing", "-q",
    ]


def pixel_data(path):
    """The compressed scanlines of an EXR: everything behind its header and its table of offsets."""
    data = path.read_bytes()
    at, height = 8, 0  # magic number and version
    while data[at]:
        name_end = data.index(b"\0", at)
        type_end = data.index(b"\0", name_end + 1)
        size = struct.unpack_from("<I", data, type_end + 1)[0]
        if data[at:name_end] == b"dataWindow":
            window = struct.unpack_from("<4i", data, type_end + 5)
            height = window[3] - window[1] + 1
        at = type_end + 5 + size
    lines_per_chunk = 16  # ZIP
    chunks = (height + lines_per_chunk - 1) // lines_per_chunk
    return data[at + 1 + 8 * chunks:]


def kill_once(options, folder, seconds, number):
    """Starts the batch and kills it; True if it was still running."""
    sent = signal.SIGKILL if number % 2 else signal.SIGTERM
    with subprocess.Popen(command(options, folder), stderr=subprocess.PIPE) as process:
        try:
            process.wait(timeout=seconds)
        except subprocess.TimeoutExpired:
            begin = time.monotonic()
            process.send_signal(sent)
            code = process.wait()
            if time.monotonic() - begin > options.patience:
                sys.exit(f"kill {number}: ended only after {time.monotonic() - begin:.1f} s")
            wanted = (-signal.SIGKILL,) if sent == signal.SIGKILL else (143, 0, -signal.SIGTERM)
            if code not in wanted:
                sys.exit(f"kill {number}: exit code {code}: {process.stderr.read().decode()}")
            return True
        if process.returncode != 0:
            sys.exit(f"exit code {process.returncode}: {process.stderr.read().decode()}")
        return False


def run_through(options, folder):
    begin = time.monotonic()
    subprocess.run(command(options, folder), check=True)
    return time.monotonic() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default=os.environ.get(
        "VDBEAM_BINARY", str(ROOT / "build/release/vdbeam")))
    parser.add_argument("--kills", type=int, default=6)
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--passes", type=int, default=4)
    parser.add_argument("--photons", type=int, default=20000)
    parser.add_argument("--resolution", default="64x36")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--patience", type=float, default=5,
                        help="seconds within which a signal must end it; more on a busy machine")
    options = parser.parse_args()
    moments = random.Random(options.seed)
    with tempfile.TemporaryDirectory(prefix="vdbeam_kill_") as name:
        reference, folder = Path(name) / "reference", Path(name) / "killed"
        reference.mkdir()
        folder.mkdir()
        whole = run_through(options, reference)
        kills = rounds = 0
        while kills < options.kills:
            if not kill_once(options, folder, moments.uniform(0, 0.6 * whole), kills):
                rounds += 1  # all frames were done: begin anew
                for path in folder.iterdir():
                    path.unlink()
                continue
            kills += 1
        run_through(options, folder)
        images = sorted(reference.iterdir())
        names = sorted(path.name for path in folder.iterdir() if not path.name.startswith("."))
        if names != [path.name for path in images]:
            sys.exit(f"files {names} instead of {[path.name for path in images]}")
        wrong = [path.name for path in images if pixel_data(folder / path.name) != pixel_data(path)]
        if wrong:
            sys.exit(f"these differ from the undisturbed run: {', '.join(wrong)}")
        print(f"{kills} kills in {rounds + 1} batches of {len(images)} frames "
              f"({whole:.1f} s undisturbed): all images equal")


if __name__ == "__main__":
    main()
