"""The examples run, and each has a counterpart of its name in C++."""

import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "python/examples").glob("*.py"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_the_example_runs(example, tmp_path, monkeypatch, capsys):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(example))
    assert capsys.readouterr().out
    for picture in tmp_path.glob("*.png"):
        assert picture.read_bytes().startswith(b"\x89PNG")


def test_examples_have_the_same_names_in_both_languages():
    names = {path.stem for path in (ROOT / "cpp/examples").glob("*.cpp")}
    names.remove("live_console")  # in Python that is `wakeline live`
    assert {path.stem for path in EXAMPLES} == names | {"compare_peers"}  # which are in Python
    assert len(names) == 9
