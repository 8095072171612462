"""The site of the documentation: examples, notebooks, the reference of Python."""

import logging
import re
from importlib import import_module
from inspect import ismodule
from pathlib import Path

import pytest

import wakeline as wl

CPP = Path(__file__).parents[2] / "cpp"
with pytest.MonkeyPatch.context() as patch:
    patch.syspath_prepend(CPP / "docs/site")
    import gallery
    import python_reference


@pytest.fixture(scope="module")
def pages():
    return dict(python_reference.pages())


def test_every_module_of_the_package_has_a_page(pages):
    nouns = {name for name in wl.__all__ if name in python_reference.PACKAGES}
    assert nouns | {*python_reference.ENGINE, "index"} == set(pages)
    left_out = {name for name in wl._MODULES if name not in pages}
    assert left_out == {"study"}, "studies have pages of their own"


def test_every_public_class_and_function_is_described(pages):
    text = "\n".join(pages.values())
    named = [name for name in wl.__all__ if name not in pages and name != "study"]
    missing = [name for name in named if f"\n## `{name}`\n" not in text]
    assert set(missing) <= {"lanes", "set_threads", "threads"}, "which are of wakeline.batch"


def test_public_names_have_docstrings(caplog):
    with caplog.at_level(logging.WARNING, "mkdocs.plugins.wakeline"):
        list(python_reference.pages())
    assert caplog.messages == []


def test_parameters_are_a_list_and_examples_code():
    text = python_reference.as_markdown(wl.track_recording.__doc__)
    assert "\n- `recording` (Recording, str or Path): A recording" in text
    assert "```python\n>>> import wakeline as wl" in text
    assert "----" not in text


def test_every_example_is_shown():
    files = {file.stem for file in (CPP.parent / "python/examples").glob("*.py")}
    assert {one.name for one in gallery.examples()} == files - {gallery.PEERS}
    assert set(gallery.ORDER) <= files


@pytest.mark.parametrize("notebook", gallery.notebooks(), ids=lambda file: file.stem)
def test_the_notebook_runs(notebook, tmp_path):
    for module in ("nbconvert", "nbclient", "ipykernel", "matplotlib"):
        pytest.importorskip(module)
    gallery.run_notebook(notebook, tmp_path)
    page = (tmp_path / f"{notebook.stem}.md").read_text(encoding="utf-8")
    assert page.startswith(f"# {gallery.title_of(notebook)}\n")
    drawn = gallery.pictures(tmp_path)
    assert drawn
    assert all(f"{file.name})" in page for file in drawn)


def test_calls_of_the_engine_have_names_and_defaults():
    first = "run(self: a.b[c, d], z: X | None = None, n: int = 3, *, f: F = F(a=1, b=2)) -> None"
    assert python_reference.arguments_of(first) == ["z=None", "n=3", "*", "f=F(a=1, b=2)"]


@pytest.mark.parametrize("name", python_reference.MODULES)
def test_every_public_name_of_a_module_has_a_heading_on_its_page(name, pages):
    module = import_module(f"wakeline.{name}")
    public = python_reference.public_names(module)
    names = {one for one in public if not ismodule(getattr(module, one))}
    assert names <= set(re.findall(r"^##+ `([\w.:~]+)`", pages[name], re.MULTILINE))
