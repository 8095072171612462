"""`import wakeline` and `wakeline --help` import little; the rest is imported when it is used."""

import ast
import pkgutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import wakeline as wl
from wakeline import cli

HEAVY = {"aiohttp", "asyncio", "csv", "importlib.metadata", "json", "matplotlib", "pandas"}


def modules_after(code):
    """The modules that a new interpreter has after some code."""
    program = f"import sys\n{code}\nprint('modules', *sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    return set(done.stdout.rpartition("modules ")[2].split())


def packages():
    return {name for _, name, _ in pkgutil.iter_modules(wl.__path__) if not name.startswith("_")}


@pytest.mark.parametrize(
    "code", ["import wakeline", "import wakeline.cli; wakeline.cli.main(['--help'])"]
)
def test_import_and_help_load_no_package(code):
    loaded = modules_after(code)
    assert "wakeline._engine" in loaded
    begun = {f"wakeline.{name}" for name in packages() - {"cli"}}
    assert not loaded & begun
    assert not loaded & HEAVY - modules_after("import numpy")


def test_a_command_imports_only_its_own_module():
    loaded = modules_after("import wakeline.cli; wakeline.cli.main(['score', '--help'])")
    assert "wakeline.cli.score" in loaded
    assert not loaded & {"wakeline.cli.track", "wakeline.live", "wakeline.study", "matplotlib"}


def test_packages_are_there_without_an_import_of_their_own():
    loaded = modules_after("import wakeline\nassert wakeline.recording.names()")
    assert "wakeline.recording" in loaded
    assert "wakeline.live" not in loaded


def test_every_public_name_is_listed_and_there():
    assert set(wl.__all__) <= set(dir(wl))
    assert "__version__" in dir(wl)
    assert all(getattr(wl, name) is not None for name in wl.__all__)
    assert packages() - {"cli"} <= set(wl.__all__)
    with pytest.raises(AttributeError, match="no_such_name"):
        wl.no_such_name  # noqa: B018


def test_type_checkers_see_the_names_that_are_imported_later():
    tree = ast.parse(Path(wl.__file__).read_text(encoding="utf-8"))
    checked = next(
        node
        for node in tree.body
        if isinstance(node, ast.If) and ast.unparse(node.test) == "_TYPE_CHECKING"
    )
    names = {
        alias.name
        for node in checked.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert names == wl._MODULES | set(wl._FUNCTIONS)


def test_each_command_is_a_module_of_its_name():
    found = {
        name
        for _, name, _ in pkgutil.iter_modules(cli.__path__)
        if name != "__main__" and hasattr(import_module(f"wakeline.cli.{name}"), "add_to")
    }
    assert found == set(cli._COMMANDS)
