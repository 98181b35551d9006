#!/usr/bin/env python3
"""Kills at calls that write and at random moments: some of those of tools/attack.sh."""
import subprocess
import sys
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools/attack"

if __name__ == "__main__":
    sys.exit(subprocess.run([sys.executable, "-B", str(TOOL), "--kills", "16", "--seed", "1"]).returncode)
