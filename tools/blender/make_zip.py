#!/usr/bin/env python3
"""Writes the Blender add-on as one file to install: tools/blender/make_zip.py [vdbeam_blender.zip]

The same sources give the same bytes.
"""
import pathlib
import sys
import zipfile

PACKAGE = pathlib.Path(__file__).resolve().parent / "vdbeam_blender"
DATE = (1980, 1, 1, 0, 0, 0)


def make(path):
    """Writes the zip."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for source in sorted(PACKAGE.glob("*.py")):
            entry = zipfile.ZipInfo(f"{PACKAGE.name}/{source.name}", DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, source.read_bytes())


if __name__ == "__main__":
    target = sys.argv[1] if len(sys.argv) > 1 else f"{PACKAGE.name}.zip"
    make(target)
    print(f"{target}: written; install it in Blender's preferences, Add-ons > Install")
