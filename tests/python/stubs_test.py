"""The type stubs of the compiled module name what it has, with the same parameters, and the package says that it is typed."""
import ast
import re
import unittest

import built_module

built_module.require()

from vdbeam import _core  # noqa: E402

PACKAGE = built_module.PACKAGE / "vdbeam"
STUBS = PACKAGE / "_core.pyi"


def public(names):
    """Names without those of Python itself."""
    return {name for name in names if not name.startswith("_") or name == "__init__"}


def members_of(node):
    """{name: parameters without self, None for values} of a class or module of the stubs."""
    members = {}
    for entry in node.body:
        if isinstance(entry, ast.FunctionDef):
            is_value = any(getattr(decorator, "id", "") == "property" for decorator in entry.decorator_list)
            words = [argument.arg for argument in entry.args.args + entry.args.kwonlyargs if argument.arg != "self"]
            members[entry.name] = None if is_value else words
        elif isinstance(entry, ast.AnnAssign):
            members[entry.target.id] = None
    return members


def parameters_of(function):
    """Names of the parameters that pybind11 wrote into the first line of the docstring; None without it."""
    line = (function.__doc__ or "").split("\n")[0]
    match = re.match(r"\w+\((.*)\) -> ", line)
    if not match:
        return None
    names = re.findall(r"(?:^|, )(\w+): ", match.group(1))
    return [name for name in names if name != "self"]


class Stubs(unittest.TestCase):
    def setUp(self):
        self.tree = ast.parse(STUBS.read_text(encoding="utf-8"))
        self.classes = {node.name: node for node in self.tree.body if isinstance(node, ast.ClassDef)}

    def check(self, where, owner, stubs):
        for name, words in stubs.items():
            found = getattr(owner, name, None)
            self.assertTrue(hasattr(owner, name), f"{where}.{name} is in the stubs only")
            known = parameters_of(found) if words is not None and callable(found) else None
            if known is not None and not any(re.fullmatch(r"arg\d+", one) for one in known):
                self.assertEqual(words, known, f"{where}.{name}")

    def test_the_module_has_what_they_name(self):
        functions = {name: words for name, words in members_of(self.tree).items()}
        self.check("_core", _core, functions)
        for name, node in self.classes.items():
            self.assertTrue(hasattr(_core, name), name)
            self.check(name, getattr(_core, name), members_of(node))

    def test_they_name_what_the_module_has(self):
        named = set(self.classes) | set(members_of(self.tree))
        self.assertEqual(public(dir(_core)) - named - {"__init__"}, set())
        for name, node in self.classes.items():
            kind = getattr(_core, name)
            if issubclass(kind, Exception):
                continue
            own = public(vars(kind)) - {"__init__"}
            self.assertEqual(own - set(members_of(node)), set(), name)

    def test_the_package_is_typed(self):
        self.assertTrue((PACKAGE / "py.typed").exists())


if __name__ == "__main__":
    unittest.main()
