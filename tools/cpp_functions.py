"""Finds the functions of C++ source that clang-format has laid out."""
import re

# Lines at which no function begins.
NO_FUNCTION = re.compile(r"(if|for|while|switch|else|do|namespace|class|struct|enum|union|extern|try|catch|return|case"
                         r"|default|typedef|using)\b|[{}#:]|//|\w+:$")
CLOSING = {"(": ")", "[": "]", "{": "}", "<": ">"}


def count_parameters(head):
    """Parameters of the function whose definition begins with `head`."""
    start = head.find("(")
    if head[:start].rstrip().endswith("operator"):
        start = head.find("(", head.find(")", start))
    depth, commas, text = 0, 0, ""
    for character in head[start:]:
        if character in CLOSING:
            depth += 1
        elif character in CLOSING.values():
            depth -= 1
            if depth == 0:
                break
        elif character == "," and depth == 1:
            commas += 1
        text += character
    return commas + 1 if text[1:].strip() else 0


def find_functions(text):
    """(line, lines, parameters) of each function that is defined in `text`; lambdas are parts of theirs."""
    lines = text.splitlines()
    number = 0
    while number < len(lines):
        first, begin = lines[number], number
        head = ""
        while number < len(lines):
            code = re.sub(r'"(\\.|[^"\\])*"', '""', lines[number])
            head += " " + re.sub(r"//.*", "", code).strip()
            number += 1
            if not head.strip() or first.lstrip().startswith("#"):
                break
            if head.count("(") == head.count(")") and head.rstrip().endswith(("{", ";", "}", ":")):
                break
        head = head.strip()
        if NO_FUNCTION.match(first.lstrip()) or not head.endswith("{") or "(" not in head:
            continue
        if "=" in head.split("(")[0].replace("operator=", "") or "[&" in head or "= [" in head:
            continue  # a value or a lambda
        indent = len(first) - len(first.lstrip())
        end = number
        while end < len(lines) - 1 and not re.match(" " * indent + r"}(\W|$)", lines[end]):
            end += 1
        yield begin + 1, end - begin + 1, count_parameters(head)
