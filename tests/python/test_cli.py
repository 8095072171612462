"""The command: files in, files out, one clear line on bad input."""

import csv
import dataclasses
import json
import os
import re
import subprocess
import sys
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

import wakeline as wl
from wakeline import cli, metrics, recording
from wakeline.cli import main, outputs
from wakeline.cli import track as track_command
from wakeline.recording import own_csv, plot_rows, read_tracks, truth_csv
from wakeline.tracking.settings import KEYS

pytestmark = pytest.mark.usefixtures("no_pictures")

PNG = b"\x89PNG"
BUNDLED = resources.files("wakeline.recording") / "data"
PERIOD_S = 2.5

METRICS = (
    *("coverage", "ids", "switches", "breaks", "position_rmse_m", "position_rmse_debiased_m"),
    *("velocity_rmse_mps", "course_rms_deg", "speed_rmse_mps", "false_tracks"),
    *("false_track_scans_per_scan", "gospa_m"),
)


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    """Folder with the tracks and the scores of each bundled recording."""
    folder = tmp_path_factory.mktemp("demo")
    for name in recording.names():
        out = ["--out", str(folder / name), "--json", str(folder / f"{name}.json")]
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(outputs, "can_draw", lambda: False)
            assert main(["demo", "--recording", name, *out]) == 0
    return folder


@pytest.fixture
def plots_csv(tmp_path):
    """A boat that steams north-east at 10 m/s, plotted every 2.5 s, 40 scans."""
    return write_plots(tmp_path / "plots.csv", boat(40))


def boat(scans, start_s=1000.0):
    """Rows time_s, north_m, east_m."""
    rng = np.random.default_rng(1)
    after_s = PERIOD_S * np.arange(scans)
    place = np.column_stack([1000.0 + 6.0 * after_s, 500.0 + 8.0 * after_s])
    return np.column_stack([start_s + after_s, place + rng.normal(scale=3.0, size=place.shape)])


def write_plots(path, rows, head="time_s,north_m,east_m"):
    lines = [",".join(map(str, row)) for row in rows]
    path.write_text("\n".join([head, *lines]) + "\n")
    return path


def read_rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def track(*arguments):
    return main(["track", *map(str, arguments)])


def bundled(name, kind):
    return str(BUNDLED / name / f"{kind}.csv")


def rejected(capsys, *arguments):
    """The one line with which the command rejects its input."""
    assert main([*map(str, arguments)]) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith("wakeline: ")
    assert captured.err.count("\n") == 1
    return captured.err


# The recordings that ship -------------------------------------------------------------------------


def test_demo_explains_itself_and_says_what_it_wrote(tmp_path, capsys):
    assert main(["demo", "--out", str(tmp_path / "here")]) == 0
    text = capsys.readouterr().out
    for word in ("joyride", "coverage", "switches", "velocity", "false tracks", "tracks.csv"):
        assert word in text
    assert (tmp_path / "here" / "tracks.csv").exists()


@pytest.mark.parametrize("name", recording.names())
def test_score_says_what_metrics_says(demo, name, tmp_path, capsys):
    tracks_csv, result = demo / name / "tracks.csv", tmp_path / "score.json"
    files = [str(tracks_csv), bundled(name, "truth"), "--scans", bundled(name, "scans")]
    assert main(["score", *files, "--json", str(result)]) == 0
    written = json.loads(result.read_text())
    assert set(written) == {"name", "version", "seed", "runs", "rows"}
    assert written["name"] == "score"
    assert written["version"] == wl.__version__
    score = metrics.score(read_tracks(tracks_csv), recording.load(name))
    summaries = {episode.name or "tracks.csv": episode.summary for episode in score.episodes}
    summaries["all"] = score.overall
    assert [row["scenario"] for row in written["rows"]] == list(summaries)
    for row in written["rows"]:
        assert row["estimator"] == "tracks"
        figures = summaries[row["scenario"]].as_dict()
        assert tuple(row)[2:] == METRICS
        assert {key: row[key] for key in METRICS} == {key: figures[key] for key in METRICS}
    text = capsys.readouterr().out
    assert "coverage" in text
    assert "GOSPA" in text
    # without plots given, those beside the scans are used
    plots = ["--plots", bundled(name, "plots")]
    assert main(["score", *files, *plots, "--json", str(tmp_path / "again.json")]) == 0
    assert json.loads((tmp_path / "again.json").read_text()) == written


def test_a_score_needs_scans(demo, tmp_path, capsys):
    own = write_plots(tmp_path / "own.csv", [(1495196200 + k, 0, 0) for k in range(340)])
    files = [demo / "joyride" / "tracks.csv", bundled("joyride", "truth"), "--scans", own]
    message = rejected(capsys, "score", *files)
    assert message == (
        f"wakeline: {own}, line 1: there are no scans; wanted a column scan, or --plots\n"
    )
    assert main([*map(str, ["score", *files, "--plots", bundled("joyride", "plots")])]) == 0


def test_a_score_of_no_scans_says_why(tmp_path, capsys):
    plots = write_plots(tmp_path / "plots.csv", boat(40))
    rows = [(1001.0 + 4.0 * k, "A", *boat(40)[0, 1:]) for k in range(20)]
    truth = write_plots(tmp_path / "truth.csv", rows, "time_s,target,north_m,east_m")
    assert track(plots, "--truth", truth, "--out", tmp_path) == 0
    reported = "no scan counts: of 40 scans at most 4 have the truth of a target,"
    assert reported in capsys.readouterr().out


def test_tracks_of_a_scenario_without_scans_are_reported_by_their_file(demo, tmp_path, capsys):
    found = read_tracks(demo / "autoferry" / "tracks.csv")
    lost = dataclasses.replace(
        found, scenario=np.where(found.scenario == "3", "none", found.scenario)
    )
    recording.write_tracks(tmp_path / "t.csv", lost)
    files = [tmp_path / "t.csv", bundled("autoferry", "truth")]
    message = rejected(capsys, "score", *files, "--scans", bundled("autoferry", "scans"))
    assert f"{tmp_path / 't.csv'}, column scenario: " in message
    assert "wanted '2' or '3' or '4' or '5' or '6', got 'none'" in message


def test_score_with_another_gate(demo, tmp_path):
    files = [demo / "joyride" / "tracks.csv", bundled("joyride", "truth")]
    scans = ["--scans", bundled("joyride", "scans"), "--json", tmp_path / "score.json"]
    assert main([*map(str, ["score", *files, *scans, "--gate", 10])]) == 0
    row = json.loads((tmp_path / "score.json").read_text())["rows"][-1]
    assert row["coverage"] < 0.97


# What track writes --------------------------------------------------------------------------------


def test_track_writes_tracks_events_and_plots(plots_csv, tmp_path, capsys):
    out = tmp_path / "out"
    assert track(plots_csv, "--out", out, "--json", tmp_path / "track.json") == 0
    head = (out / "tracks.csv").read_text().splitlines()[0]
    assert head.startswith("track_id,time_s,north_m,east_m,vnorth_mps,veast_mps,course_deg")
    tracks = read_tracks(out / "tracks.csv")
    assert tracks.ids() == ["1"]
    assert set(tracks.status) <= {"confirmed", "coasting"}
    assert np.isin(tracks.time_s, boat(40)[:, 0]).all()
    assert np.isfinite(tracks.state).all()
    assert np.isfinite(tracks.covariance).all()
    np.testing.assert_allclose(tracks.mode_probability.sum(axis=1), 1.0)
    np.testing.assert_allclose(tracks.state[-1], [1585.0, 6.0, 1280.0, 8.0], atol=8.0)
    events = read_rows(out / "events.csv")
    assert events[0]["event"] == "started"
    assert {"event": "confirmed", "track_id": "1"}.items() <= events[-1].items()
    plots = read_rows(out / "plots_tracks.csv")
    assert len(plots) == 40
    assert plots[-1]["track_id"] == "1"
    row = json.loads((tmp_path / "track.json").read_text())["rows"][-1]
    assert (row["scans"], row["plots"], row["tracks"]) == (40, 40, 1)
    text = capsys.readouterr().out
    assert "40 scans, 40 plots" in text
    assert "period 2.5 s as between the scans" in text


def test_track_draws_a_map_and_a_picture_over_time(plots_csv, tmp_path, pictures):
    assert track(plots_csv, "--out", tmp_path) == 0
    for name in ("map.png", "time.png"):
        assert (tmp_path / name).read_bytes().startswith(PNG)


def test_without_matplotlib_the_tracks_are_written_all_the_same(
    plots_csv, tmp_path, capsys, monkeypatch, pictures
):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert track(plots_csv, "--out", tmp_path / "out") == 0
    assert "pip install 'wakeline[plot]'" in capsys.readouterr().out
    files = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert files == ["encounters.csv", "events.csv", "plots_tracks.csv", "tracks.csv"]


def test_track_with_truth_scores_as_well(tmp_path, capsys):
    files = [bundled("joyride", kind) for kind in ("plots", "scans", "truth")]
    own_truth = ["--own", files[1], "--truth", files[2], "--radar", "joyride"]
    result = tmp_path / "track.json"
    assert track(files[0], *own_truth, "--out", tmp_path, "--json", result) == 0
    row = json.loads(result.read_text())["rows"][-1]
    assert row["coverage"] >= 0.97
    assert row["scans"] == 115
    assert "coverage" in capsys.readouterr().out


def test_bundled_recordings_are_tracked_by_name_with_their_radar(tmp_path, capsys):
    assert track("joyride", "--out", tmp_path / "name") == 0
    assert "radar joyride" in capsys.readouterr().out
    files = [bundled("joyride", "plots"), "--own", bundled("joyride", "scans")]
    assert track(*files, "--radar", "joyride", "--out", tmp_path / "files") == 0
    named, read = (read_tracks(tmp_path / place / "tracks.csv") for place in ("name", "files"))
    np.testing.assert_array_equal(named.state, read.state)


def test_each_scenario_starts_afresh_and_is_carried_to_the_output(tmp_path):
    rows = [(f"run {k}", *row) for k in (1, 2) for row in boat(20, start_s=1000.0 * k)]
    plots = write_plots(tmp_path / "plots.csv", rows, "scenario,time_s,north_m,east_m")
    assert track(plots, "--out", tmp_path / "out") == 0
    tracks = read_tracks(tmp_path / "out" / "tracks.csv")
    assert set(tracks.scenario) == {"run 1", "run 2"}
    assert set(tracks.track_id) == {"1"}
    one, two = (tracks.where(tracks.scenario == name) for name in ("run 1", "run 2"))
    np.testing.assert_allclose(one.state, two.state)
    for name in ("events.csv", "plots_tracks.csv"):
        rows = read_rows(tmp_path / "out" / name)
        assert {row["scenario"] for row in rows} == {"run 1", "run 2"}


def test_each_scenario_has_separate_pictures(tmp_path, pictures):
    rows = [(name, *boat(1)[0]) for name in ("run/1", "run 2")]
    plots = write_plots(tmp_path / "plots.csv", rows, "scenario,time_s,north_m,east_m")
    assert track(plots, "--out", tmp_path) == 0
    drawn = sorted(path.name for path in tmp_path.glob("*.png"))
    assert drawn == ["map-run_1.png", "map-run_2.png", "time-run_1.png", "time-run_2.png"]


def test_of_many_scenarios_the_first_are_drawn(tmp_path, pictures, capsys, monkeypatch):
    monkeypatch.setattr(outputs, "MOST_DRAWN", 2)
    rows = [(str(k), *row) for k in range(4) for row in boat(8)]
    plots = write_plots(tmp_path / "plots.csv", rows, "scenario,time_s,north_m,east_m")
    out = tmp_path / "out"
    assert track(plots, "--out", out) == 0
    drawn = {path.name for path in out.glob("map-*.png")}
    assert drawn == {"map-0.png", "map-1.png"}
    assert "the first 2 of 4 scenarios are drawn" in capsys.readouterr().out
    assert len(set(read_tracks(out / "tracks.csv").scenario)) == 4


def test_scenarios_of_like_names_do_not_overwrite_each_others_pictures(tmp_path, pictures):
    names = ("a b", "a_b", "A_B", "a_b-2")
    rows = [(name, *boat(1)[0]) for name in names]
    plots = write_plots(tmp_path / "plots.csv", rows, "scenario,time_s,north_m,east_m")
    out = tmp_path / "out"
    assert track(plots, "--out", out) == 0
    drawn = sorted(path.stem for path in out.glob("map*.png"))
    assert drawn == ["map-A_B-3", "map-a_b", "map-a_b-2", "map-a_b-2-2"]
    (out / "map-a_b-4.png").write_text("mine")
    one = write_plots(tmp_path / "one.csv", boat(1))
    assert track(one, "--out", out) == 0
    assert sorted(path.name for path in out.glob("map*.png")) == ["map-a_b-4.png", "map.png"]


@pytest.mark.parametrize("letter", ["a", "海"])
def test_long_names_of_scenarios_are_cut_in_names_of_files(tmp_path, pictures, letter):
    names = [300 * letter, 301 * letter]
    rows = [(name, *row) for name in names for row in boat(2)]
    plots = write_plots(tmp_path / "plots.csv", rows, "scenario,time_s,north_m,east_m")
    out, result = tmp_path / "out", tmp_path / "track.json"
    assert track(plots, "--out", out, "--json", result) == 0
    assert [row["scenario"] for row in json.loads(result.read_text())["rows"]] == [*names, "all"]
    assert len(list(out.glob("map-*.png"))) == 2
    assert track(write_plots(tmp_path / "one.csv", boat(2)), "--out", out) == 0
    assert [path.name for path in out.glob("map*.png")] == ["map.png"]


def test_a_score_is_there_when_a_picture_fails(plots_csv, tmp_path, capsys, monkeypatch):
    def fails(*arguments):
        raise OSError("the disk is full")

    monkeypatch.setattr(outputs, "can_draw", lambda: True)
    monkeypatch.setattr(outputs, "write_pictures", fails)
    truth = tmp_path / "truth.csv"
    write_plots(truth, [(t, "A", n, e) for t, n, e in boat(40)], "time_s,target,north_m,east_m")
    result = tmp_path / "track.json"
    assert track(plots_csv, "--truth", truth, "--out", tmp_path, "--json", result) == 2
    captured = capsys.readouterr()
    assert captured.err == "wakeline: the disk is full\n"
    assert "coverage" in captured.out
    assert json.loads(result.read_text())["rows"][-1]["coverage"] == 1.0


def test_files_of_an_earlier_run_that_this_one_does_not_write_are_removed(tmp_path):
    rows = [(name, *row) for name in ("run/1", "run 2") for row in boat(20)]
    plots = write_plots(tmp_path / "plots.csv", rows, "scenario,time_s,north_m,east_m")
    one = write_plots(tmp_path / "one.csv", boat(20))
    own = write_plots(tmp_path / "own.csv", [(990 + k, 0, 0) for k in range(70)])
    out = tmp_path / "out"
    assert track(plots, "--own", own, "--out", out) == 0
    assert (out / "alarms.csv").exists()
    drawn = ["map-run_1.png", "map-run_2.png", "time-run_1.png", "ppi.png", "tracks-partial.csv"]
    mine = ["map-harbour.png", "time-series.png", "alarms-old.csv"]
    for name in drawn + mine:
        (out / name).write_text("earlier")
    assert track(one, "--out", out) == 0
    left = sorted(path.name for path in out.iterdir())
    assert left == sorted(["tracks.csv", "events.csv", "encounters.csv", "plots_tracks.csv", *mine])


def test_a_run_that_fails_leaves_the_files_of_an_earlier_one(plots_csv, tmp_path, capsys):
    (tmp_path / "map.png").write_text("earlier")
    plots_csv.write_text("time_s,north_m,east_m\n1,2,three\n")
    rejected(capsys, "track", plots_csv, "--out", tmp_path)
    assert (tmp_path / "map.png").exists()


def test_an_empty_recording_is_drawn_too(tmp_path, pictures):
    assert track(write_plots(tmp_path / "plots.csv", []), "--out", tmp_path) == 0
    assert (tmp_path / "map.png").read_bytes().startswith(PNG)


def test_a_later_scenario_that_fails_leaves_what_was_there_and_what_was_done(
    tmp_path, capsys, monkeypatch
):
    rows = [(k, *row) for k in (1, 2) for row in boat(20, start_s=1000.0 * k)]
    plots = write_plots(tmp_path / "plots.csv", rows, "scenario,time_s,north_m,east_m")
    out = tmp_path / "out"
    assert track(plots, "--out", out) == 0
    before = (out / "tracks.csv").read_bytes()
    whole = track_command.track_episode

    def fails_on_the_second(episode, *arguments, **options):
        if episode.name == "2":
            raise wl.FilterError("the engine gives up")
        return whole(episode, *arguments, **options)

    monkeypatch.setattr(track_command, "track_episode", fails_on_the_second)
    assert track(plots, "--out", out) == 2
    files, error = capsys.readouterr().err.splitlines()
    assert files.startswith("of the previous scenarios: tracks-partial.csv, ")
    assert error == "wakeline: the engine gives up"
    assert (out / "tracks.csv").read_bytes() == before
    assert set(read_tracks(out / "tracks-partial.csv").scenario) == {"1"}


def test_what_navigate_writes_is_an_own_ship_file(tmp_path, capsys):
    assert main(["navigate", str(BUNDLED / "irene" / "irene.nmea"), "--out", str(tmp_path)]) == 0
    start_s = float(read_rows(tmp_path / "own.csv")[0]["time_s"])
    plots = write_plots(tmp_path / "plots.csv", boat(40, start_s=start_s))
    assert track(plots, "--own", tmp_path / "own.csv", "--out", tmp_path) == 0
    assert "closer than 926 m within 20 min" in capsys.readouterr().out
    assert np.isfinite(read_tracks(tmp_path / "tracks.csv").cpa_m).all()


def test_alarms_are_printed_and_written(tmp_path, capsys):
    rows = boat(60)
    own = write_plots(tmp_path / "own.csv", [(990 + k, 2500.0 - k, 2500.0) for k in range(170)])
    assert track(write_plots(tmp_path / "plots.csv", rows), "--own", own, "--out", tmp_path) == 0
    (alarm,) = read_rows(tmp_path / "alarms.csv")
    text = capsys.readouterr().out
    assert "1 alarm of tracks closer than 926 m within 20 min" in text
    assert f"track {alarm['track_id']} at " in text
    assert "alarms.csv" in text


def test_without_own_ship_there_are_no_alarms(plots_csv, tmp_path, capsys):
    assert track(plots_csv, "--out", tmp_path) == 0
    assert not (tmp_path / "alarms.csv").exists()
    assert "alarm" not in capsys.readouterr().out


def test_an_own_ship_of_one_position_has_no_velocity(plots_csv, tmp_path, capsys):
    rows = [(k, 1000.0 + PERIOD_S * k) for k in range(40)]
    scans = write_plots(tmp_path / "scans.csv", rows, "scan,time_s")
    assert track(plots_csv, "--own", scans, "--out", tmp_path) == 0
    assert "own ship's velocity is unknown" in capsys.readouterr().out


# Bad input ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("time_s,north_m\n1,2\n", "a column is missing"),
        ("time_s,north_m,east_m\n1,2,three\n", "line 2, column east_m"),
        ("", "the file is empty"),
    ],
)
def test_plots_that_cannot_be_read_are_rejected(tmp_path, capsys, text, wanted):
    plots = tmp_path / "plots.csv"
    plots.write_text(text)
    out = tmp_path / "out"
    message = rejected(capsys, "track", plots, "--out", out)
    assert wanted in message
    assert str(plots) in message
    assert not (out / "tracks.csv").exists()


def test_bad_input_leaves_earlier_files_alone(plots_csv, tmp_path, capsys):
    assert track(plots_csv, "--out", tmp_path) == 0
    before = (tmp_path / "tracks.csv").read_bytes()
    plots_csv.write_text("time_s,north_m,east_m\n1,2,three\n")
    capsys.readouterr()
    rejected(capsys, "track", plots_csv, "--out", tmp_path)
    assert (tmp_path / "tracks.csv").read_bytes() == before


def test_truth_of_another_time_is_rejected(plots_csv, tmp_path, capsys):
    rows = [(5000 + k, "A", 0, 0) for k in range(30)]
    truth = write_plots(tmp_path / "truth.csv", rows, "time_s,target,north_m,east_m")
    message = rejected(capsys, "track", plots_csv, "--truth", truth, "--out", tmp_path)
    assert message.startswith(f"wakeline: {truth}, column time_s: the truth does not overlap")
    assert "wanted times within 1000.0 to 1097.5, got 5000.0 to 5029.0" in message


def test_plots_without_a_place_are_left_out_with_a_note(tmp_path, capsys):
    rows = boat(30)
    rows[[7, 12], 1] = np.nan
    plots = write_plots(tmp_path / "plots.csv", rows)
    assert track(plots, "--out", tmp_path) == 0
    assert "2 plots without a finite position left out" in capsys.readouterr().out
    assert np.isfinite(read_tracks(tmp_path / "tracks.csv").state).all()


def test_files_that_are_not_there(tmp_path, capsys):
    message = rejected(capsys, "track", tmp_path / "none.csv", "--out", tmp_path)
    assert "none.csv: the file cannot be read" in message


def test_an_output_folder_that_is_a_file(plots_csv, tmp_path, capsys):
    (tmp_path / "taken").write_text("mine")
    assert "taken: File exists" in rejected(capsys, "track", plots_csv, "--out", tmp_path / "taken")
    assert (tmp_path / "taken").read_text() == "mine"


@pytest.mark.parametrize("place", ["here", "/proc/self/fd"])
def test_a_json_that_cannot_be_written_is_reported_before_the_work(
    place, plots_csv, tmp_path, capsys
):
    (tmp_path / "here" / "score.json").mkdir(parents=True)
    result = tmp_path / place / "score.json"
    if not result.parent.is_dir():
        pytest.skip("no such folder on this system")
    message = rejected(capsys, "track", plots_csv, "--out", tmp_path / "out", "--json", result)
    assert message.startswith(f"wakeline: {result}: ")
    assert not (tmp_path / "out").exists()


TRACK = ["track", "plots.csv", "--own", "own.csv", "--truth", "truth.csv", "--config", "c.toml"]
SCORE = ["score", "tracks.csv", "truth.csv", "--scans", "own.csv"]


@pytest.mark.parametrize(
    ("arguments", "file"),
    [
        *((TRACK, file) for file in ("plots.csv", "own.csv", "truth.csv", "c.toml")),
        (["track", "plots.csv", "--radar", "c.toml"], "c.toml"),
        *((SCORE, file) for file in ("tracks.csv", "truth.csv", "own.csv", "plots.csv")),
    ],
)
def test_a_json_that_would_replace_an_input_is_rejected(
    tmp_path, capsys, monkeypatch, arguments, file
):
    monkeypatch.chdir(tmp_path)
    for name in ("plots.csv", "own.csv", "truth.csv", "tracks.csv", "c.toml"):
        Path(name).write_text("mine")
    result = Path("..", tmp_path.name, file)
    message = rejected(capsys, *arguments, "--json", result)
    assert message == f"wakeline: --json would replace the input {file}\n"
    assert Path(file).read_text() == "mine"


@pytest.mark.parametrize("name", ["tracks.csv", "plots_tracks.csv", "alarms-partial.csv"])
def test_plots_that_the_output_would_replace_are_rejected(tmp_path, capsys, name):
    plots = write_plots(tmp_path / name, boat(2))
    before = plots.read_bytes()
    message = rejected(capsys, "track", plots, "--out", tmp_path)
    assert message == f"wakeline: --out would replace the input {plots}\n"
    assert plots.read_bytes() == before


@pytest.mark.parametrize("name", ["tracks.csv", "MAP.PNG"])
def test_a_json_does_not_take_the_place_of_a_result(tmp_path, capsys, name):
    result = tmp_path / ".." / tmp_path.name / name
    message = rejected(capsys, "demo", "--out", tmp_path, "--json", result)
    wanted = f"--json must not have the name of a table or picture in {tmp_path}, got {name}"
    assert message == f"wakeline: {wanted}\n"
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("arguments", "wanted"),
    [
        (["track"], "needs a recording"),
        (["sail"], "invalid choice: 'sail'"),
        ([], "COMMAND"),
        (["score", "a.csv", "b.csv"], "--scans"),
        (["demo", "--recording", "none"], "invalid choice: 'none'"),
        (["score", "a.csv", "b.csv", "--scans", "c.csv", "--gate", "wide"], "invalid float"),
    ],
)
def test_a_command_line_that_is_invalid(capsys, arguments, wanted):
    assert wanted in rejected(capsys, *arguments)


def test_a_gate_that_is_invalid(demo, capsys):
    files = [demo / "joyride" / "tracks.csv", bundled("joyride", "truth")]
    scans = ["--scans", bundled("joyride", "scans")]
    capsys.readouterr()
    for gate in (-1, 1e-200, 1e300):
        message = rejected(capsys, "score", *files, *scans, "--gate", gate)
        assert f"gate_m must be positive and finite, from 1e-9 to 1e9, got {float(gate)}" in message


# The program --------------------------------------------------------------------------------------


def test_version_and_help(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"wakeline {wl.__version__}\n"
    assert main(["--help"]) == 0
    text = capsys.readouterr().out
    for command in ("demo", "track", "score", "bench"):
        assert command in text


def test_help_names_every_column_and_every_key_of_the_radar(capsys):
    assert main(["track", "--help"]) == 0
    text = capsys.readouterr().out
    _, _, columns = text.partition("columns, separated by commas")
    wanted = {*plot_rows.COLUMNS, *truth_csv.COLUMNS, *own_csv.COLUMNS, *KEYS["radar"]}
    named = set(re.findall(r"\w+", columns))
    assert wanted - named == {"heading_rad"}


def test_every_name_of_a_column_is_documented():
    page = Path(__file__).parents[2] / "cpp" / "docs" / "files.md"
    if not page.exists():
        pytest.skip("the documentation is not here")
    documented = set(re.findall(r"`(\w+)`", page.read_text(encoding="utf-8")))
    for columns in (plot_rows.COLUMNS, truth_csv.COLUMNS, own_csv.COLUMNS):
        assert {name for names in columns.values() for name in names} <= documented


def test_bench_measures_every_work(tmp_path, monkeypatch, capsys):
    from wakeline.cli import bench

    for name, value in (("REPEATS", 1), ("RUNS", 10), ("_SCANS", 20), ("LOOP_STEPS", 20)):
        monkeypatch.setattr(bench, name, value)
    for name, value in (("_TRACKER_SCANS", 2), ("_SWEEPS", 64), ("_CELLS", 128), ("_ROUNDS", 1)):
        monkeypatch.setattr(bench, name, value)
    assert main(["bench", "--json", str(tmp_path / "bench.json")]) == 0
    result = json.loads((tmp_path / "bench.json").read_text())
    assert result["name"] == "bench"
    rows = {(row["scenario"], row["estimator"]): row for row in result["rows"]}
    steps = ("kf_step", "ekf_polar_step", "ukf5_step", "imm3_step", "imm5_step")
    for work in (*steps, "fuzzy_alpha_beta_step", "bayesian_alpha_beta_step"):
        assert rows[work, "scalar_double"]["ns_per_step"] > 0
        assert rows[work, "batch_double"]["times_scalar_double"] > 0
    assert rows["imm3_run_python", "scalar_double"]["ns_per_step"] > 0
    assert rows["imm3_run_python", "batch_double"]["times_scalar_double"] > 0
    assert rows["imm3_run_python", "python_loop"]["times_scalar_double"] > 0
    for work in ("mode_history100_scan", "tracker_200", "tracker_1000", "gnn_200", "gnn_1000"):
        assert rows[work, "scalar_double"]["ms_per_scan"] > 0
    assert rows["cfar_scan", "scalar_double"]["ms_per_scan"] > 0
    ours = ("scalar_double", "batch_double", "python_loop")
    assert all(estimator.startswith(ours) for _, estimator in rows)
    assert "ns a step" in capsys.readouterr().out


def test_an_interrupt_is_no_traceback(plots_csv, tmp_path, capsys, monkeypatch):
    def interrupted(*arguments, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(track_command, "track_episode", interrupted)
    assert track(plots_csv, "--out", tmp_path) == 130
    assert capsys.readouterr().err == "wakeline: interrupted\n"


@pytest.mark.parametrize("words", ["Unable to allocate 3 TiB", ""])
def test_too_little_memory_is_no_traceback(plots_csv, tmp_path, capsys, monkeypatch, words):
    def has_no_memory(*arguments, **options):
        raise MemoryError(words)

    monkeypatch.setattr(track_command, "track_episode", has_no_memory)
    reported = rejected(capsys, "track", plots_csv, "--out", tmp_path)
    assert reported == f"wakeline: {words or 'not enough memory'}\n"


def test_a_reader_that_leaves_and_a_silent_stderr():
    """Into a pipe: no progress bar, and no complaint when nobody reads to the end."""
    command = [sys.executable, "-m", cli.__name__, "track", "--print-config"]
    environment = os.environ | {"PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment
    ) as process:
        process.stdout.close()
        errors = process.stderr.read()
    assert process.returncode == 141
    assert errors == b""


@pytest.mark.skipif(os.name != "posix", reason="the shell of POSIX closes the outputs")
def test_closed_outputs_are_none(plots_csv, tmp_path):
    command = [sys.executable, "-m", cli.__name__, "track", plots_csv, "--out", tmp_path / "out"]
    closed = ["sh", "-c", 'exec "$@" >&- 2>&-', "sh", *map(str, command)]
    assert subprocess.run(closed, check=False).returncode == 0
    assert (tmp_path / "out" / "tracks.csv").exists()


def test_an_output_that_knows_ascii_only_loses_signs_and_no_scores():
    command = [sys.executable, "-m", cli.__name__, "track", "--print-config"]
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    done = subprocess.run(command, capture_output=True, env=environment, check=False)
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"[m?/s?; 0 to 10000]" in done.stdout


def test_progress_is_drawn_on_a_terminal_only(monkeypatch, capsys):
    from wakeline import _progress as progress

    assert list(progress.progress(range(5), 5, "counting")) == list(range(5))
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setattr(progress, "_EVERY_S", -1.0)
    assert list(progress.progress(range(5), 5, "counting")) == list(range(5))
    assert "counting" in capsys.readouterr().err


def test_scoring_of_scenarios_is_seen_on_a_terminal(demo, monkeypatch, capsys):
    from wakeline import _progress as progress

    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setattr(progress, "_EVERY_S", -1.0)
    files = [str(demo / "autoferry" / "tracks.csv"), bundled("autoferry", "truth")]
    assert main(["score", *files, "--scans", bundled("autoferry", "scans")]) == 0
    assert re.search(r"scoring .* 4/5", capsys.readouterr().err)


def test_the_package_runs_as_the_command():
    command = [sys.executable, "-m", "wakeline", "--version"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout == f"wakeline {wl.__version__}\n"
