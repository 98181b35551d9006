#!/usr/bin/env python3
"""Damaged files and wild commands: a few hundred of the mutants of tools/attack.sh."""
import subprocess
import sys
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools/attack"

if __name__ == "__main__":
    sys.exit(subprocess.run([sys.executable, "-B", str(TOOL), "--mutants", "60"]).returncode)
