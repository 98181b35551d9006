"""Every Python block of docs/how-to/python.md runs as it stands, in smaller images, and writes what it says."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import built_module

built_module.require()

SIZE = re.compile(r'("(?:image\.)?(?:width|height)": )(\d+)')
page, sizes = SIZE.subn(lambda size: f"{size[1]}{int(size[2]) // 4}", (built_module.ROOT / "docs/how-to/python.md").read_text())
assert sizes >= 8, "the page gives sizes in another way"
blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
assert len(blocks) >= 3, "the page has lost its examples"
with tempfile.TemporaryDirectory() as folder:
    os.symlink(built_module.ROOT / "data", pathlib.Path(folder) / "data")
    for number, block in enumerate(blocks):
        print(f"block {number}", flush=True)
        subprocess.run([sys.executable, "-c", block], cwd=folder, check=True,
                       env={**os.environ, "PYTHONPATH": str(built_module.PACKAGE), "MPLCONFIGDIR": folder})
        for name in re.findall(r'save(?:fig|_preview)?\("([^"]+)"\)', block):
            size = (pathlib.Path(folder) / name).stat().st_size
            assert size > 1000, f"{name} has {size} bytes"
