"""Finished tracks: smoothed, at any time, one by one, and as tables of pandas."""

import csv
import sys
from dataclasses import replace

import numpy as np
import pytest

import wakeline as wl
from wakeline import metrics
from wakeline.cli import main
from wakeline.recording import Tracks, read_tracks, write_tracks
from wakeline.scenario.dense import SCENES


@pytest.fixture(scope="module")
def scene():
    """Pairs of vessels that pass each other, their tracks, and the tracks smoothed."""
    crossings = replace(SCENES["crossings"], scans=60)
    seen = crossings.record(3)
    radar = wl.Radar(
        range_std_m=crossings.radar.range_std_m,
        bearing_std_rad=crossings.radar.bearing_std_rad,
        period_s=crossings.radar.period_s,
    )
    tracks = wl.track_recording(seen, radar=radar)
    return seen, tracks, tracks.smooth()


def errors_of(tracks, seen):
    return metrics.score(tracks, seen).overall.errors


def test_smoothed_tracks_are_nearer_to_the_truth(scene):
    seen, tracks, smoothed = scene
    before, after = errors_of(tracks, seen), errors_of(smoothed, seen)
    assert after.position_rmse_m < 0.6 * before.position_rmse_m
    assert after.velocity_rmse_mps < 0.6 * before.velocity_rmse_mps


def test_the_covariance_of_smoothed_tracks_is_that_of_their_errors(scene):
    seen, _, smoothed = scene
    nees = []
    for track in smoothed:
        for target in seen.episodes[0].truth.values():
            known_m = target.state_at(track.time_s)[:, 0::2]
            error_m = track.state[:, 0::2] - known_m
            if np.nanmedian(np.hypot(*error_m.T)) < 20.0:
                whitened = np.linalg.solve(track.covariance[:, 0::2, 0::2], error_m[:, :, None])
                nees.append(np.nanmean(np.sum(error_m * whitened[:, :, 0], axis=1)))
    assert len(nees) > 15
    assert 1.0 < np.mean(nees) < 3.0, "of 2 components"


def test_smoothed_rows_are_those_of_the_tracks(scene):
    _, tracks, smoothed = scene
    for column in ("track_id", "time_s", "status", "nis"):
        np.testing.assert_array_equal(getattr(smoothed, column), getattr(tracks, column))
    assert smoothed.episodes[0].events == tracks.episodes[0].events
    assert smoothed.settings == tracks.settings


def test_states_between_scans_are_on_the_smoothed_track(scene):
    _, tracks, smoothed = scene
    track_id = tracks.ids()[0]
    known = smoothed[track_id]
    middle_s = (known.time_s[1:] + known.time_s[:-1]) / 2
    every_s = np.concatenate([known.time_s, middle_s])
    denser = tracks.smooth(every_s[::-1])[track_id]
    assert (np.diff(denser.time_s) > 0).all()
    at_scans = denser.where(np.isin(denser.time_s, known.time_s))
    np.testing.assert_allclose(at_scans.state, known.state, atol=0.1)  # mixed more often
    np.testing.assert_allclose(at_scans.covariance, known.covariance, rtol=0.05, atol=0.1)
    between = denser.where(np.isin(denser.time_s, middle_s))
    mean_m = (known.state[1:] + known.state[:-1])[:, 0::2] / 2
    assert np.hypot(*(between.state[:, 0::2] - mean_m).T).max() < 2.0


def test_after_its_end_a_track_is_predicted_as_long_as_wanted(scene):
    _, tracks, smoothed = scene
    track_id = tracks.ids()[0]
    last = smoothed[track_id].where([-1])
    after_s = last.time_s[0] + np.array([10.0, 20.0, 31.0])
    ahead = tracks.smooth(after_s, ahead_s=30.0)[track_id]
    np.testing.assert_array_equal(ahead.time_s, after_s[:2])
    assert (ahead.status == "coasting").all()
    straight_m = last.state[:, 0::2] + np.outer([10.0, 20.0], last.state[0, 1::2])
    np.testing.assert_allclose(ahead.state[:, 0::2], straight_m, atol=3.0)
    spread = np.trace(np.vstack([last.covariance, ahead.covariance]), axis1=1, axis2=2)
    assert (np.diff(spread) > 0).all()
    with pytest.raises(KeyError):
        tracks.smooth(last.time_s - 1e6)[track_id]


def test_a_plot_far_from_the_track_does_not_bend_it(scene):
    _, tracks, smoothed = scene
    part = tracks.episodes[0]
    track_id = tracks.ids()[0]
    chosen = [np.asarray(ids) == int(track_id) for ids in part.plot_track_id]
    k = [n for n, mine in enumerate(chosen) if mine.any()][20]
    scan = part.episode.scans[k]
    moved = replace(scan, range_m=scan.range_m + np.where(chosen[k], 300.0, 0.0))
    scans = [*part.episode.scans[:k], moved, *part.episode.scans[k + 1 :]]
    bent = replace(part, episode=replace(part.episode, scans=scans))
    found = wl.tracking.smooth_episode(bent, tracks.settings).tracks[track_id]
    off_m = np.hypot(*(found.state - smoothed[track_id].state)[:, 0::2].T)
    assert off_m.max() < 10.0


def test_the_command_writes_smoothed_tracks(tmp_path, no_pictures):
    folder = wl.recording._data() / "joyride"
    files = [str(folder / "plots.csv"), "--own", str(folder / "scans.csv")]
    assert main(["track", *files, "--radar", "joyride", "--smooth", "--out", str(tmp_path)]) == 0
    written = read_tracks(tmp_path / "tracks.csv")
    tracks = wl.track_recording(files[0], own=files[2], radar="joyride")
    np.testing.assert_allclose(written.state, tracks.smooth().state)
    assert not np.allclose(written.state, tracks.state)
    assert written.cpa_m is not None


def test_no_tracks_are_smoothed_to_none():
    empty = wl.recording.load("joyride")
    empty = replace(empty, episodes=[replace(empty.episodes[0], scans=[], truth=None)])
    tracks = wl.track_recording(empty)
    assert len(tracks.smooth()) == len(tracks.smooth([1.0, 2.0])) == 0


# Tables -------------------------------------------------------------------------------------------


def test_a_track_by_its_number_and_one_after_the_other(scene):
    _, tracks, _ = scene
    first = tracks.ids()[0]
    assert len(tracks[first]) == (tracks.track_id == first).sum()
    np.testing.assert_array_equal(tracks[int(first)].state, tracks[first].state)
    assert [track.ids() for track in tracks] == [[name] for name in tracks.ids()]
    with pytest.raises(KeyError, match="no-such-track"):
        tracks["no-such-track"]


def test_tracks_as_a_data_frame_are_as_in_a_file(scene, tmp_path):
    pytest.importorskip("pandas")
    _, tracks, _ = scene
    table = tracks.to_pandas()
    write_tracks(tmp_path / "tracks.csv", tracks)
    with (tmp_path / "tracks.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(table.columns) == list(rows[0])
    np.testing.assert_array_equal(table["north_m"], [float(row["north_m"]) for row in rows])
    assert table["track_id"].tolist() == [row["track_id"] for row in rows]


def test_without_pandas_an_error_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match="pip install pandas"):
        Tracks(np.array(["1"]), np.zeros(1), np.zeros((1, 4))).to_pandas()


def test_tracks_draw_themselves_on_their_recording():
    pytest.importorskip("matplotlib")
    tracks = wl.track_recording("joyride")
    (ax,) = tracks.plot().axes
    assert len(ax.collections) + len(ax.lines) > len(wl.plot.map(tracks).axes[0].lines)
