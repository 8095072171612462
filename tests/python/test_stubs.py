"""The stubs of the installed package name and type what the engine has."""

import ast
import builtins
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import pytest

import wakeline as wl
from wakeline import _engine

PACKAGE = Path(wl.__file__).parent
STUBS = PACKAGE / "_engine"
pytestmark = pytest.mark.skipif(
    wl.__version__ == "0+unknown" and not STUBS.exists(),
    reason="a checkout that is not installed has no stubs",
)
NOUNS = sorted(name for name, value in vars(_engine).items() if type(value) is type(_engine))


def names_in(body):
    """What a module or class stub defines."""
    names = set()
    for node in body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            names.add(node.name)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names.add(node.target.id)
        elif isinstance(node, ast.Assign):
            names.update(t.id for t in node.targets if isinstance(t, ast.Name))
    return names


def public(namespace):
    return {name for name in vars(namespace) if not name.startswith("_")}


def test_the_engine_is_the_extension_and_the_package_is_typed():
    assert _engine.__file__.endswith(tuple(EXTENSION_SUFFIXES))
    assert (PACKAGE / "py.typed").exists()


def test_there_is_a_stub_for_each_noun_and_no_other():
    assert sorted(path.stem for path in STUBS.glob("*.pyi")) == sorted(["__init__", *NOUNS])
    assert not list(STUBS.glob("*.py"))  # it would be imported in place of the extension


@pytest.mark.parametrize("noun", NOUNS)
def test_a_stub_names_all_that_its_noun_has(noun):
    module = getattr(_engine, noun)
    body = ast.parse((STUBS / f"{noun}.pyi").read_text()).body
    assert public(module) <= names_in(body)
    for node in body:
        if isinstance(node, ast.ClassDef):
            wanted = public(getattr(module, node.name)) - {"name", "value", "add_note"}
            if not issubclass(getattr(module, node.name), BaseException):
                assert wanted <= names_in(node.body), node.name


def untyped(function):
    """Arguments of a function stub, but for the first of a method, without a type or with any."""
    arguments = function.args
    listed = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
    any_of = ("object", "typing.Any", "Any")
    return [
        one.arg
        for one in listed
        if one.arg not in ("self", "cls")
        and (one.annotation is None or ast.unparse(one.annotation) in any_of)
    ] + [one.arg for one in (arguments.vararg, arguments.kwarg) if one is not None]


@pytest.mark.parametrize("noun", NOUNS)
def test_a_stub_has_the_types_of_arguments_and_results(noun):
    tree = ast.parse((STUBS / f"{noun}.pyi").read_text())
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("__"):
            assert not untyped(node), f"{node.name}: {untyped(node)}"
            assert ast.unparse(node.returns) not in ("object", "typing.Any"), node.name
        elif isinstance(node, ast.FunctionDef) and node.name == "__init__":
            assert not untyped(node), f"line {node.lineno}: {untyped(node)}"


@pytest.mark.parametrize("noun", NOUNS)
def test_a_stub_defines_or_imports_every_name_it_uses(noun):
    tree = ast.parse((STUBS / f"{noun}.pyi").read_text())
    defined = names_in(tree.body) | set(vars(builtins))
    for node in ast.walk(tree):
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            defined |= {alias.asname or alias.name for alias in node.names}
        elif isinstance(node, ast.ClassDef):
            defined |= names_in(node.body)
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    assert used <= defined
