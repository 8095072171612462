"""The site of the documentation: its pages of Python, and that it builds without warnings."""

import importlib.util
import logging
from pathlib import Path

import pytest

import wakeline as wl

CPP = Path(__file__).parents[2] / "cpp"
spec = importlib.util.spec_from_file_location("site_pages", CPP / "docs/site_pages.py")
site_pages = importlib.util.module_from_spec(spec)
spec.loader.exec_module(site_pages)


@pytest.fixture(scope="module")
def pages():
    return dict(site_pages.pages())


def test_every_module_of_the_package_has_a_page(pages):
    nouns = {name for name in wl.__all__ if name in site_pages.PACKAGES}
    assert nouns | {*site_pages.ENGINE, "index"} == set(pages)
    left_out = {name for name in wl._MODULES if name not in pages}
    assert left_out == {"study"}, "studies have pages of their own"


def test_every_public_class_and_function_is_described(pages):
    text = "\n".join(pages.values())
    named = [name for name in wl.__all__ if name not in pages and name != "study"]
    missing = [name for name in named if f"\n## `{name}`\n" not in text]
    assert set(missing) <= {"lanes", "set_threads", "threads"}, "which are of wakeline.batch"


def test_public_names_have_docstrings(caplog):
    with caplog.at_level(logging.WARNING, "mkdocs.plugins.wakeline"):
        list(site_pages.pages())
    assert caplog.messages == []


def test_parameters_are_a_list_and_examples_code():
    text = site_pages.as_markdown(wl.track_recording.__doc__)
    assert "\n- `recording` (Recording, str or Path): A recording" in text
    assert "```python\n>>> import wakeline as wl" in text
    assert "----" not in text


def test_every_example_is_shown():
    text = site_pages.examples()
    for file in (CPP.parent / "python/examples").glob("*.py"):
        assert f"`{file.name}`" in text
    assert "also in C++" in text


def test_calls_of_the_engine_have_names_and_defaults():
    first = "run(self: a.b[c, d], z: X | None = None, n: int = 3, *, f: F = F(a=1, b=2)) -> None"
    assert site_pages.arguments_of(first) == ["z=None", "n=3", "*", "f=F(a=1, b=2)"]


def test_the_site_builds_without_warnings(tmp_path):
    build = pytest.importorskip("mkdocs.commands.build")
    from mkdocs.config import load_config

    config = load_config(str(CPP / "mkdocs.yml"), site_dir=str(tmp_path), strict=True)
    build.build(config)
    assert (tmp_path / "api/filter.html").is_file()
