#!/usr/bin/env python3
"""Checks the rules of the source tree that no compiler checks; docs/developer/architecture.md explains them.

Prints one line per violation, "file:line: what", and exits 1 where there is one.
"""
import pathlib
import re
import sys

from cpp_functions import find_functions

# A folder of src includes only from itself and from the folders before it.
LAYERS = ["text", "math", "tuning", "machine", "image", "volume", "vdb", "grids", "geometry", "phase", "materials", "lights",
          "photonmap", "medium", "camera", "transport", "walks", "layers", "errors", "film", "compare", "keys", "scene",
          "rays", "photons", "shading", "estimators", "choose", "report", "prepare", "plan", "render", "live", "farm", "page", "console", "batch", "cli", "python"]
LINE_LIMIT = 400
PUBLIC_LINE_LIMIT = 150
# Source files of one folder: whoever looks for one reads that many names.
FOLDER_LIMIT = 40
# The same for those that hold the way of a pass, and for all of a folder with its own folders.
FOLDER_LIMITS = {"choose": 20, "errors": 20, "layers": 20, "photons": 20, "rays": 20, "shading": 20, "walks": 20}
FAMILY_LIMITS = {"estimators": 30}
FUNCTION_LIMIT = 60
# Functions that are tables: a line or more for each key.
TABLES = {"keys"}
PARAMETER_LIMIT = 7
CODE = {".h", ".cpp", ".py", ".sh", ".cmake"}

# The one header that has Embree's types; only source files of its folder include it.
EMBREE_HEADER = "geometry/shape_tree.h"
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
# No library's type belongs in the public headers.
FOREIGN = re.compile(r"\b(openvdb|nanovdb|embree|rtc[A-Z]\w*|tbb|Imath|Imf|toml|nlohmann|hwy|CLI)\b")
# The folders of the program, which alone print to the terminal and end the process.
PROGRAM = {"console", "batch", "cli"}
PRINTS = re.compile(r"\bstd::(cout|cerr|clog)\b|(?<![\w.])(std::)?(printf|puts|fputs|perror)\s*\("
                    r"|\bfprintf\s*\(\s*std(out|err)|\bfmt::print\s*\(\s*(\"|std(out|err))")
EXITS = re.compile(r"(?<![\w.>])(std::)?(exit|quick_exit|abort|terminate)\s*\(")
# A user's file is opened by machine/input_file, which waits for no pipe and reads no device. What a library
# opens by its path is checked there first. The rest of src/machine reads the system's own files.
OPENS = re.compile(r"\b(std::)?(basic_)?[io]?(fstream|filebuf)\b(?!\s*>)|(?<![\w.>])(std::|::)?(fopen|freopen|open|openat|creat)"
                   r"\s*\(\s*[^)\s]")
LIBRARY_OPENS = re.compile(r"\bio::File>?\(|\bCreateFromFile\(|\.ReadFile\(|\bImf::\w*InputFile \w+\("
                           r"|\bpng_image_begin_read_from_file\(|\bImageInput::open\(")
CHECKS = re.compile(r"\b(check_input_file|open_input_file|check_attribute_sizes|check_configuration|read_guarded"
                    r"|check_file|make_immortal|open_uris|read_start)\b")
LEFTOVERS = re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X|NOLI" r"NT\w*)\b")


def code_part(line):
    """The line without its // comment and without the contents of its strings."""
    return re.sub(r"//.*", "", re.sub(r'"(\\.|[^"\\])*"', '""', line))


def check_include(path, quote, name):
    """What is wrong with an include in `path` (relative to the root), or None."""
    parts = path.parts
    if parts[0] == "include":
        if quote == '"' and not name.startswith("vdbeam/"):
            return f'public headers include only the standard library and "vdbeam/...", got "{name}"'
        if quote == "<" and ("/" in name or "." in name):
            return f"public headers include only the standard library and vdbeam, got <{name}>"
        return None
    if parts[0] != "src":
        return None
    if re.match(r"(openvdb|nanovdb)/", name) and not (parts[1] == "vdb" and path.suffix == ".cpp"):
        return f"OpenVDB headers belong in src/vdb/*.cpp, got {name}"
    if parts[1] != "image" and re.match(r"(OpenEXR/|Imath/)?(Imf|OpenEXR|Imath|half\.h)", name):
        return f"OpenEXR and Imath headers belong in src/image, got {name}"
    if name == EMBREE_HEADER and not (parts[1] == "geometry" and path.suffix == ".cpp"):
        return f"{name} brings Embree with it and belongs in src/geometry/*.cpp"
    if re.match(r"(embree3|assimp)/", name) and not (
            parts[1] == "geometry" and (path.suffix == ".cpp" or path.as_posix().endswith(EMBREE_HEADER))):
        return f"Embree and assimp headers belong in src/geometry/*.cpp, got {name}"
    if quote == "<" or name.startswith("vdbeam/"):
        return None
    layer, target = parts[1], name.split("/")[0]
    if layer not in LAYERS:
        return f"folder src/{layer} is not in the list of layers"
    if target not in LAYERS:
        return f'include from src as "folder/file.h", got "{name}"'
    if LAYERS.index(target) > LAYERS.index(layer):
        return f"src/{layer} may not include from src/{target}, which comes after it"
    return None


def check_functions(path, text):
    """Functions that are too long, or take too much, as (line number, message)."""
    for number, lines, parameters in find_functions(text):
        if lines > FUNCTION_LIMIT and path.parts[1] not in TABLES:
            yield number, f"a function of {lines} lines, the limit is {FUNCTION_LIMIT}"
        if parameters > PARAMETER_LIMIT:
            yield number, f"a function of {parameters} parameters, the limit is {PARAMETER_LIMIT}"


def check_folders(root):
    """Folders of src that hold too many files, as "folder:1: message"."""
    def count(files):
        return sum(file.suffix in CODE for file in files)

    for folder in sorted(path for path in (root / "src").rglob("*") if path.is_dir()):
        limit = FOLDER_LIMITS.get(folder.name, FOLDER_LIMIT)
        if (files := count(folder.iterdir())) > limit:
            yield f"{folder.relative_to(root)}:1: {files} files, the limit is {limit}"
    for name, limit in FAMILY_LIMITS.items():
        if (files := count((root / "src" / name).rglob("*"))) > limit:
            yield f"src/{name}:1: {files} files in all, the limit is {limit}"


def check_file(path, text):
    """Violations of one file as (line number, message); `path` is relative to the root."""
    lines = text.splitlines()
    found = []
    public = path.parts[0] == "include"
    limit = PUBLIC_LINE_LIMIT if public else LINE_LIMIT
    if len(lines) > limit:
        found.append((len(lines), f"{len(lines)} lines, the limit is {limit}"))
    # Headers that Highway includes once per instruction set guard themselves in another way.
    if path.suffix == ".h" and not path.name.endswith("-inl.h") and "#pragma once" not in text:
        found.append((1, "a header begins with #pragma once"))
    if path.suffix in {".h", ".cpp"} and path.parts[0] in {"include", "src"}:
        found += check_functions(path, text)
    library = public or (path.parts[0] == "src" and path.parts[1] not in PROGRAM)
    for number, line in enumerate(lines, 1):
        include = INCLUDE.match(line)
        if include and path.suffix in {".h", ".cpp"}:
            message = check_include(path, *include.groups())
            if message:
                found.append((number, message))
        if LEFTOVERS.search(line):
            found.append((number, "unfinished work or a silenced warning does not belong in the tree"))
        code = code_part(line)
        if public and not include and FOREIGN.search(code):
            found.append((number, "no other library's type in a public header"))
        if library and path.suffix in {".h", ".cpp"}:
            if PRINTS.search(code):
                found.append((number, "nothing but the program prints: src/console, src/batch, src/cli"))
            if EXITS.search(code):
                found.append((number, "nothing but the program ends the process: src/console, src/batch, src/cli"))
        if path.parts[0] == "src" and path.parts[1] != "machine" and not include:
            if OPENS.search(code) and "/dev/null" not in line:
                found.append((number, "files are opened by machine/input_file and machine/atomic_file"))
            if LIBRARY_OPENS.search(code) and not CHECKS.search(text):
                found.append((number, "a library opens a path that machine/input_file has not checked"))
    return found


def check_tree(root):
    """Every violation below `root` as "file:line: message"."""
    result = list(check_folders(root))
    for folder in ("include", "src", "tests", "benchmarks", "tools", "cmake"):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in CODE and file.is_file():
                path = file.relative_to(root)
                for number, message in check_file(path, file.read_text(encoding="utf-8")):
                    result.append(f"{path}:{number}: {message}")
    return result


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    violations = check_tree(root)
    print("\n".join(violations) or "the layout is as it should be")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
