#!/usr/bin/env python3
"""A killed batch goes on where it was: a few kills of tools/kill_test.py."""

import subprocess
import sys
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools/kill_test.py"

if __name__ == "__main__":
    sys.exit(subprocess.run([sys.executable, str(TOOL), "--kills", "6", "--frames", "4",
                             "--patience", "120"]).returncode)
