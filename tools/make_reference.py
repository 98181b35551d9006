#!/usr/bin/env python3
"""Writes the generated parts of docs/reference: tables of keys in scene.md, options in cli.md.

tools/make_reference.py            writes them
tools/make_reference.py --check    writes nothing; exits 1 where a page differs from the program

The program is build/release/vdbeam, or VDBEAM_BINARY.
"""
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = ROOT / "docs" / "reference"
COMMANDS = ["render", "live", "info", "init", "plan", "compare", "merge", "summary", "farm", "farm slurm", "farm openjd",
            "help"]
# Options that several commands share are printed for `render` only.
SHARED = ["When to stop:", "Scene:"]

CLI_HEAD = """# Command line

This page is made by `tools/make_reference.py` from the program's help. `vdbeam help COMMAND` prints the same.

## Exit codes

| code | meaning |
|---|---|
| 0 | done; also a draft that a time limit ended |
| 1 | a defect in vdbeam |
| 2 | bad input: an option, a scene file, a file that is missing or of the wrong kind; one line names what is wrong, with file, line and key where they apply |
| 3 | a frame failed: a truncated or corrupt volume, a full disk, not enough memory, a time limit that left no image |
| 129, 130, 143 | ended by SIGHUP, SIGINT, SIGTERM; the passes so far are in a checkpoint |

## Environment

| variable | use |
|---|---|
| `OCIO` | OpenColorIO configuration for `image.output_space` |
| `SLURM_CPUS_PER_TASK`, `CUE_THREADS` | default of `--threads` |
| `SLURM_MEM_PER_NODE`, `SLURM_MEM_PER_CPU` | memory granted |
| `NO_COLOR`, `TERM` | plain output |
"""


def program(*words):
    binary = os.environ.get("VDBEAM_BINARY", ROOT / "build" / "release" / "vdbeam")
    environment = {**os.environ, "COLUMNS": "100", "TERM": "dumb"}
    return subprocess.run([binary, *words], check=True, capture_output=True, text=True, env=environment).stdout


def key_tables():
    """The Markdown table of each section by its name."""
    tables = {}
    for block in re.split(r"\n\n(?=[\w.]+\n\|)", program("generate", "keys").strip()):
        name, table = block.split("\n", 1)
        tables[name] = table.strip("\n") + "\n"
    return tables


def scene_page(text):
    """The page with the tables that the program prints between its markers."""
    tables = key_tables()
    named = re.findall(r"<!-- keys: ([\w.]+) -->", text)
    if sorted(named) != sorted(tables):
        raise SystemExit(f"scene.md has the tables {sorted(named)}, the program {sorted(tables)}")
    return re.sub(r"<!-- keys: ([\w.]+) -->\n.*?<!-- end -->",
                  lambda match: f"<!-- keys: {match[1]} -->\n{tables[match[1]]}<!-- end -->", text, flags=re.DOTALL)


def without_shared(help_text):
    """A command's help without the groups of options that `render` has too."""
    blocks = help_text.split("\n\n")
    return "\n\n".join(block for block in blocks if block.split("\n")[0] not in SHARED)


def cli_page():
    text = CLI_HEAD
    for command in COMMANDS:
        page = program(*command.split(), "--help").rstrip()
        shared = command != "render" and any(f"\n{group}\n" in page for group in SHARED)
        if shared:
            page = without_shared(page)
        indented = "\n".join("    " + line if line else "" for line in page.split("\n"))
        more = "\nThe options about the scene and when to stop are those of [render](#render).\n" if shared else ""
        text += f"\n## {command}\n{more}\n{indented}\n"
    return text


def main(arguments):
    wanted = {PAGES / "scene.md": scene_page((PAGES / "scene.md").read_text(encoding="utf-8")),
              PAGES / "cli.md": cli_page()}
    stale = [page for page, text in wanted.items()
             if not page.exists() or page.read_text(encoding="utf-8") != text]
    for page in stale:
        if "--check" in arguments:
            print(f"{page.relative_to(ROOT)}: differs from the program; run tools/make_reference.py")
        else:
            page.write_text(wanted[page], encoding="utf-8")
            print(f"{page.relative_to(ROOT)}: written")
    return 1 if stale and "--check" in arguments else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
