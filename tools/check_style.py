#!/usr/bin/env python3
"""Checks the text of documentation, comments, help and messages; docs/developer/style.md explains the rules.

Prints one line per violation, "file:line: what", and exits 1 where there is one.
"""
import pathlib
import re
import sys

# Words of a private dialect, with what to write instead. They hold for all text: pages, comments, strings.
WORDS = [
    (r"\b(tell|tells|told|telling)\b", "report, estimate, measure, show or distinguish"),
    (r"\blikewise\b", "the same, in the same way"),
    (r"\b(so|as) many\b", "name the number"),
    (r"\bof which\b", "split the sentence, or use whose, where, including"),
    (r"\bin so far as\b", "as far as, if"),
    (r"\bgather(s|ed)? finally\b", "final gathering"),
    (r"\bfor the eye only\b", "for viewing only"),
    (r"\bcomplain(s|ed)? about\b", "report"),
]
# Words that pages and strings, which users read, avoid as well.
USER_WORDS = [
    (r"\bpictures?\b", "image (a file), pixel or frame"),
    (r"\bsimilar medium\b", "delta-scaled medium"),
    (r"\btak(e|es|en|ing) (out )?(the |a )?(forward )?peaks? out\b", "delta-M truncation"),
    (r"\beven sky\b", "constant environment"),
    (r"\bquick look at\b", "scan"),
    (r"\bnobody had\b", "no history"),
]
# A comment or docstring that begins with a preposition has no subject.
LEAD = re.compile(r'^(///?<?|#|""")\s*(Of|Likewise|So many|As many|By which|To which|From which)\b')
COMMENTS = {".h": r"//.*$", ".cpp": r"//.*$", ".py": r"(#.*|\"\"\".*)$", ".sh": r"#.*$", ".cmake": r"#.*$"}
STRING = re.compile(r'"((?:\\.|[^"\\])*)"')
# Names in the code and formats that keep the words: keys of reports, arguments, enumerators.
NAMES = re.compile(r"`[^`]*`|picture_facts|PictureFacts|\w*::picture\b|picture_guard|\.picture\b|\bpicture\.|\"picture\"")
FOLDERS = ("docs", "include", "src", "tests", "benchmarks", "tools", "cmake")
PAGES = ("README.md", "CHANGELOG.md")
# Pages that quote what they forbid.
EXEMPT = {"docs/developer/style.md", "tools/check_style.py", "tests/tools/check_style_test.py"}


def texts_of(line, suffix, in_code):
    """The parts of a line that people read: (text, whether users read it)."""
    if suffix == ".md":
        return [] if in_code else [(NAMES.sub("", line), True)]
    found = []
    comment = re.search(COMMENTS[suffix], line)
    code = line[:comment.start()] if comment else line
    if comment:
        found.append((comment.group(0), False))
    if suffix in {".h", ".cpp"} and not line.lstrip().startswith("#include"):
        found += [(text, True) for text in STRING.findall(code) if " " in text]
    return found


def check_text(path, text):
    """Violations of one file as (line number, message); `path` is relative to the root."""
    found, in_code = [], False
    # Tests quote input and names of their own; only their comments are checked.
    user_strings = path.parts[0] in {"src", "include"}
    for number, line in enumerate(text.splitlines(), 1):
        if path.suffix == ".md" and (line.startswith("```") or line.startswith("    ")):
            in_code = True
        for part, for_users in texts_of(line, path.suffix, in_code):
            if for_users and path.suffix != ".md" and not user_strings:
                continue
            rules = WORDS + (USER_WORDS if for_users else [])
            for pattern, instead in rules:
                match = re.search(pattern, NAMES.sub("", part), re.IGNORECASE)
                if match:
                    found.append((number, f'"{match.group(0)}": write {instead}'))
            if path.suffix != ".md" and LEAD.match(part.strip()):
                found.append((number, "a comment begins with its subject or a verb"))
        in_code = False
    return found


def check_tree(root):
    """Every violation below `root` as "file:line: message"."""
    files = [root / page for page in PAGES]
    for folder in FOLDERS:
        files += sorted(file for file in (root / folder).rglob("*")
                        if file.suffix == ".md" or file.suffix in COMMENTS)
    result = []
    for file in files:
        path = file.relative_to(root)
        if path.as_posix() in EXEMPT or not file.is_file():
            continue
        for number, message in check_text(path, file.read_text(encoding="utf-8")):
            result.append(f"{path}:{number}: {message}")
    return result


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    violations = check_tree(root)
    print("\n".join(violations) or "the text follows docs/developer/style.md")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
