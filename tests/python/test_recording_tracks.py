"""Truth and tracks as files, and truth between its samples."""

import csv
import dataclasses
import time

import numpy as np
import pytest

from wakeline import recording
from wakeline.recording import (
    RecordingError,
    TargetTruth,
    Tracks,
    read_plots,
    read_tracks,
    write_tracks,
)

PLOTS = "scan,time_s,north_m,east_m\n0,0,1,1\n1,2,1,1\n"


# ------------------------------------------------------------------ truth


def test_truth_is_read_by_target_and_time(file):
    plots = file(PLOTS, "plots.csv")
    truth = file(
        "time_s,target,north_m,east_m\n2,10,4,4\n0,10,0,0\n0,2,7,7\n1,10,9,9\n1,10,2,2\n3,2,nan,1\n",
        "truth.csv",
    )
    read = read_plots(plots, truth_path=truth)
    targets = read.episodes[0].truth
    assert list(targets) == ["2", "10"]
    assert targets["10"].north_m.tolist() == [0.0, 2.0, 4.0]
    assert "1 row without a finite position" in read.notes[0]


def test_truth_of_another_scenario_is_left_out_of_the_only_one(file):
    truth = file(
        "scenario,time_s,target,north_m,east_m\na,0,1,0,0\nb,1,1,900,900\na,2,1,4,4\n", "truth.csv"
    )
    named = file("scenario,time_s,north_m,east_m\na,0,1,1\na,2,1,1\n", "named.csv")
    read = read_plots(named, truth_path=truth)
    assert read.episodes[0].truth["1"].north_m.tolist() == [0.0, 4.0]
    assert read.notes == ["truth.csv: 1 row of scenarios without scans left out (first in line 3)"]
    nameless = read_plots(file(PLOTS, "plots.csv"), truth_path=truth)
    assert nameless.episodes[0].truth["1"].north_m.tolist() == [0.0, 900.0, 4.0]


@pytest.mark.parametrize(
    ("text", "column", "parts"),
    [
        ("time_s,north_m,east_m\n0,1,1\n", "target", ["missing"]),
        ("time_s,target,north_m,east_m\n", None, ["no row follows the header"]),
        ("time_s,target,north_m,east_m\n0,1,a,1\n", "north_m", ["a number", "'a'"]),
        ("time_s,target,north_m,east_m\n0,1,1,1\n1, ,1,1\n", "target", ["line 3", "empty cell"]),
    ],
)
def test_bad_truth_is_reported(file, text, column, parts):
    plots = file(PLOTS, "plots.csv")
    truth = file(text, "truth.csv")
    with pytest.raises(RecordingError) as caught:
        read_plots(plots, truth_path=truth)
    assert caught.value.column == column
    for part in parts:
        assert part in str(caught.value)


def dense_truth(time_s, position):
    nan = np.full(len(time_s), np.nan)
    return TargetTruth(time_s, *position(time_s), nan, nan)


def test_velocity_of_dense_truth_is_exact_on_a_parabola():
    time_s = np.arange(0.0, 60.0, 0.2)
    truth = dense_truth(time_s, lambda t: (3.0 + 2.0 * t + 0.05 * t**2, 7.0 - t))
    asked = np.linspace(1.0, 58.0, 37)
    wanted = np.column_stack([2.0 + 0.1 * asked, np.full(37, -1.0)])
    np.testing.assert_allclose(truth.state_at(asked)[:, 1::2], wanted, atol=1e-9)


def test_no_truth_in_gaps_and_outside_the_record():
    time_s = np.concatenate([np.arange(0, 20, 0.5), np.arange(40, 60, 0.5)])
    truth = dense_truth(time_s, lambda t: (t, 2.0 * t))
    known = np.isfinite(truth.state_at([-1.0, 5.25, 30.0, 45.1, 61.0])).all(axis=1)
    assert known.tolist() == [False, True, False, True, False]


def test_truth_is_the_same_in_a_longer_record():
    """Whose other samples must not matter, nor cost time."""
    time_s = np.cumsum(np.random.default_rng(1).uniform(0.05, 1.2, 400_000))
    whole = dense_truth(time_s, lambda t: (100.0 * np.sin(t / 40.0), 100.0 * np.cos(t / 30.0)))
    begin, end = 200_000, 200_400
    part = TargetTruth(*(getattr(whole, f.name)[begin:end] for f in dataclasses.fields(whole)))
    asked_s = np.linspace(time_s[begin] + 5.0, time_s[end - 1] - 5.0, 2000)
    for window_s in (2.0, 0.1):
        started = time.perf_counter()
        states = whole.state_at(asked_s, window_s=window_s)
        assert time.perf_counter() - started < 2.0
        np.testing.assert_array_equal(states, part.state_at(asked_s, window_s=window_s))
        assert np.isfinite(states).all()


def test_recorded_velocity_is_taken_as_it_is():
    truth = TargetTruth(
        *(np.array(v, dtype=float) for v in ([0, 2], [1, 2], [3, 4], [5, 6], [7, 8]))
    )
    np.testing.assert_array_equal(truth.state_at([0.01]), [[1.0, 5.0, 3.0, 7.0]])


# ------------------------------------------------------------------ tracks


def some_tracks(n=6, modes=3, seed=1):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(n, 4, 4))
    return Tracks(
        track_id=rng.integers(1, 4, n).astype(str),
        time_s=1.6e9 + np.arange(n) * 2.513,
        state=rng.normal(size=(n, 4)) * 1e3,
        covariance=root @ root.transpose(0, 2, 1),
        mode_probability=rng.dirichlet(np.ones(modes), n),
        status=np.array(["updated", "coasting"] * (n // 2)),
        nis=np.where(np.arange(n) % 2, np.nan, 1.25),
        scenario=np.array(["a", "b"] * (n // 2)),
    )


def test_tracks_come_back_bit_for_bit(tmp_path):
    tracks = some_tracks()
    write_tracks(tmp_path / "tracks.csv", tracks)
    again = read_tracks(tmp_path / "tracks.csv")
    for name in ("track_id", "time_s", "state", "mode_probability", "status", "nis", "scenario"):
        np.testing.assert_array_equal(getattr(again, name), getattr(tracks, name))
    upper = np.triu_indices(4)
    np.testing.assert_array_equal(
        again.covariance[:, upper[0], upper[1]], tracks.covariance[:, upper[0], upper[1]]
    )


def test_the_columns_of_a_tracks_file(tmp_path):
    write_tracks(tmp_path / "t.csv", some_tracks(modes=2))
    with (tmp_path / "t.csv").open() as f:
        header = next(csv.reader(f))
    assert header[:8] == [
        *("track_id", "time_s", "north_m", "east_m", "vnorth_mps", "veast_mps"),
        *("course_deg", "speed_mps"),
    ]
    assert header[18:] == ["mode_1", "mode_2", "status", "nis", "scenario"]


def test_course_is_clockwise_from_north():
    state = [[0, 1, 0, 0], [0, 0, 0, 1], [0, -1, 0, 0], [0, 0, 0, -1], [0, 1, 0, -1e-300]]
    tracks = Tracks(["1"] * 5, np.arange(5), state)
    np.testing.assert_allclose(tracks.course_deg, [0, 90, 180, 270, 0], atol=1e-12)
    assert (tracks.course_deg < 360.0).all()


def test_a_file_of_plain_tracks_and_an_empty_one(tmp_path):
    plain = Tracks(["7"], [1.0], [[1.0, 2.0, 3.0, 4.0]])
    for tracks in (plain, plain.where(slice(0, 0))):
        write_tracks(tmp_path / "t.csv", tracks)
        again = read_tracks(tmp_path / "t.csv")
        assert len(again) == len(tracks)
        assert again.covariance is None
        assert again.mode_probability is None


def test_parts_are_joined_with_what_they_share():
    first, second = some_tracks(seed=1), Tracks(["x"], [0.0], [[1.0, 2.0, 3.0, 4.0]])
    joined = Tracks.joined([first, second])
    assert len(joined) == 7
    assert joined.status is None
    assert len(Tracks.joined([])) == 0


def test_tracks_of_the_wrong_shape():
    with pytest.raises(ValueError, match=r"state must have shape \(2, 4\), got \(2, 3\)"):
        Tracks(["1", "1"], [0, 1], np.zeros((2, 3)))
    with pytest.raises(ValueError, match="mode_probability"):
        Tracks(["1"], [0], np.zeros((1, 4)), mode_probability=np.zeros(1))


@pytest.mark.parametrize(
    ("text", "column", "parts"),
    [
        ("track_id,time_s,north_m,east_m,vnorth_mps\n", "veast_mps", ["missing"]),
        (
            "track_id,time_s,north_m,east_m,vnorth_mps,veast_mps\n1,0,1,1,a,1\n",
            "vnorth_mps",
            ["'a'"],
        ),
        (
            "track_id,time_s,north_m,east_m,vnorth_mps,veast_mps,mode_2\n1,0,1,1,1,1,1\n",
            None,
            ["mode_1 to mode_2"],
        ),
    ],
)
def test_bad_tracks_are_reported(file, text, column, parts):
    path = file(text, "tracks.csv")
    with pytest.raises(RecordingError) as caught:
        read_tracks(path)
    assert caught.value.column == column
    for part in parts:
        assert part in str(caught.value)


def test_what_was_written_before_is_kept_when_writing_fails(tmp_path):
    path = tmp_path / "out.txt"
    path.write_text("before")

    def write_half():
        with recording.replacing(path) as fresh:
            fresh.write_text("half")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        write_half()
    assert path.read_text() == "before"
    assert [p.name for p in tmp_path.iterdir()] == ["out.txt"]


@pytest.mark.parametrize("name", ["none/out.txt", "taken/out.txt", "folder"])
def test_a_file_that_cannot_be_written_is_named_as_it_was_given(tmp_path, name):
    (tmp_path / "taken").write_text("mine")
    (tmp_path / "folder").mkdir()
    path = tmp_path / name
    with (
        pytest.raises(OSError, match=r"out\.txt|folder") as caught,
        recording.replacing(path) as fresh,
    ):
        fresh.write_text("text")
    assert caught.value.filename == str(path)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["folder", "taken"]
