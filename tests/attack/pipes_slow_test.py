#!/usr/bin/env python3
"""Pipes, devices, folders and the like in place of files: some of those of tools/attack.sh."""
import subprocess
import sys
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools/attack"

if __name__ == "__main__":
    sys.exit(subprocess.run([sys.executable, "-B", str(TOOL), "--pipes", "25"]).returncode)
