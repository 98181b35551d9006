"""The type stubs of the compiled module name what it has, with the same parameters and types, and the package says that it
is typed."""
import ast
import re
import unittest

import built_module

built_module.require()

from vdbeam import _core  # noqa: E402

PACKAGE = built_module.PACKAGE / "vdbeam"
STUBS = PACKAGE / "_core.pyi"
SIGNATURE = re.compile(r"\w*\((.*)\) -> ([^\n]*)")


def public(names):
    """Names without those of Python itself."""
    return {name for name in names if not name.startswith("_") or name == "__init__"}


def type_in_stubs(annotation):
    """A type of the stubs, as the module would write it."""
    if isinstance(annotation, ast.Constant):
        return str(annotation.value)
    text = ast.unparse(annotation)
    if not isinstance(annotation, ast.Subscript):
        return {"Any": "array", "np.ndarray": "array"}.get(text, text)
    kind = ast.unparse(annotation.value)
    if kind == "Callable":
        return "object"
    if kind == "dict":
        return "dict"
    inner = type_in_stubs(annotation.slice)
    if kind == "Optional":
        # The module cannot say that an object, or a pointer to a class of its own, may be None.
        return inner if inner == "object" else f"Optional[{inner}]"
    return f"List[{inner}]"


def type_in_module(text):
    """The same for a type of a signature that pybind11 wrote."""
    text = re.sub(r"numpy\.ndarray\[[\w.]+\]", "array", text.strip())
    return re.sub(r"float\[\d\]", "float", text.replace("vdbeam._core.", ""))


def same_type(stub, module):
    return stub == module or (isinstance(getattr(_core, module, None), type) and stub == f"Optional[{module}]")


def split_parameters(text):
    """[(name, type)] of "scene: Scene, passes: List[int]"."""
    return [tuple(word.split(": ")) for word in re.split(r", (?=\w+: )", text) if word]


def signature_in_stubs(entry):
    """([(name, type)], type of the result) of a function, ([], type) of an attribute."""
    if isinstance(entry, ast.AnnAssign):
        return [], type_in_stubs(entry.annotation)
    arguments = [argument for argument in entry.args.args if argument.arg != "self"]
    return [(one.arg, type_in_stubs(one.annotation)) for one in arguments], type_in_stubs(entry.returns)


def signature_in_module(found):
    """The same of what the module has."""
    if isinstance(found, str):
        return [], "str"
    is_attribute = isinstance(found, property)
    parameters, result = SIGNATURE.match(((found.fget if is_attribute else found).__doc__ or "")).groups()
    known = [(name, type_in_module(kind)) for name, kind in split_parameters(parameters)]
    return known[1:] if is_attribute or known[:1] and known[0][0] == "self" else known, type_in_module(result)


def mistakes(where, owner, node):
    """How a class or module of the stubs differs from `owner`, one line each."""
    lines = []
    entries = [entry for entry in node.body if isinstance(entry, (ast.FunctionDef, ast.AnnAssign))]
    names = {entry.name if isinstance(entry, ast.FunctionDef) else entry.target.id: entry for entry in entries}
    for name, entry in names.items():
        found = getattr(owner, name, None)
        if found is None:
            lines.append(f"{where}.{name} is in the stubs only")
            continue
        stub, module = signature_in_stubs(entry), signature_in_module(found)
        same = [name for name, _ in stub[0]] == [name for name, _ in module[0]] and all(
            same_type(one, other) for one, other in zip([kind for _, kind in stub[0]] + [stub[1]],
                                                        [kind for _, kind in module[0]] + [module[1]]))
        if not same:
            lines.append(f"{where}.{name} is {stub} in the stubs, {module} in the module")
    if isinstance(owner, type) and not issubclass(owner, Exception):
        lines += [f"{where}.{name} is not in the stubs"
                  for name in public(vars(owner)) - {"__init__"} - set(names)]
    return lines


def all_mistakes(text):
    """How the stubs differ from the module."""
    tree = ast.parse(text)
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    lines = mistakes("_core", _core, tree)
    for name, node in classes.items():
        lines += mistakes(name, getattr(_core, name), node) if hasattr(_core, name) else [f"{name} is in the stubs only"]
    functions = {entry.name for entry in tree.body if isinstance(entry, ast.FunctionDef)}
    return lines + [f"{name} is not in the stubs" for name in public(dir(_core)) - functions - set(classes) - {"version"}]


class Stubs(unittest.TestCase):
    def setUp(self):
        self.text = STUBS.read_text(encoding="utf-8")

    def test_they_are_those_of_the_module(self):
        self.assertEqual(all_mistakes(self.text), [])

    def test_wrong_stubs_are_found(self):
        for right, wrong in (("def wait(self, seconds: float)", "def wait(self, patience: float)"),
                             ("def wait(self, seconds: float)", "def wait(self, seconds: str)"),
                             ("def wait(self, seconds: float)", "def wait(self)"),
                             ("def close(self) -> None", "def close(self) -> int"),
                             ("def stop(self) -> None: ...", "pass"),
                             ("def stop(self)", "def end(self)"),
                             ("overrides: Sequence[str]", "overrides: Sequence[int]"),
                             ("second_reference: Optional[Any]", "second_reference: Any"),
                             ("image: Any, reference: Any", "reference: Any, image: Any"),
                             ("record: Optional[PassRecord]", "record: Optional[Image]"),
                             ("    photons: int\n", ""),
                             ("    photons: int\n", "    photons: float\n"),
                             ("class FrameError(Error): ...", ""),
                             ("class Session:", "class Sessions:"),
                             ("version: str", "version: str\nrevision: str")):
            self.assertIn(right, self.text)
            self.assertNotEqual(all_mistakes(self.text.replace(right, wrong, 1)), [], f"{right} -> {wrong}")

    def test_the_package_is_typed(self):
        self.assertTrue((PACKAGE / "py.typed").exists())


if __name__ == "__main__":
    unittest.main()
