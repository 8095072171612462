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
    printed = capsys.readouterr().out.rstrip().split("\n")
    pictures = list(tmp_path.glob("*.png"))
    assert pictures or len(printed) > 2, "ends in a picture or a table"
    for picture in pictures:
        assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_the_example_is_short(example):
    if example.stem != "compare_peers":  # which holds the peers' trackers, too
        assert len(example.read_text().split("\n")) <= 65


def test_examples_have_the_same_names_in_both_languages():
    ours = {path.stem for path in EXAMPLES}
    theirs = {path.stem for path in (ROOT / "cpp/examples").glob("*.cpp")}
    assert theirs - ours == {"live_console"}  # in Python that is `wakeline live`
    # What is the package's alone: recordings with their scores, tuning, sessions, peers.
    alone = {"first_tracks", "tune", "which_estimator", "live_session", "compare_peers"}
    assert ours - theirs == alone
