"""Calibration of a radar from position reports: the engine's, of recordings, and the command."""

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from wakeline import tracking
from wakeline.cli import main
from wakeline.recording import TargetTruth, write_plots
from wakeline.scenario import RadarSimulator, Truth
from wakeline.tracking import calibrate, read_reports, read_settings

RADAR = wl.Radar(range_std_m=10.0, bearing_std_rad=np.radians(0.5), period_s=2.5)
OFFSETS = (40.0, np.radians(2.0), 0.4)
REPORTED = ("211000001", "211000002", "211000003", "211000004", "211000005")


def fleet(rng, names):
    """Vessels on straight courses at 1 to 5 km."""
    truths = {}
    for name in names:
        range_m, speed_mps = rng.uniform(1000.0, 5000.0), rng.uniform(5.0, 12.0)
        bearing_rad, course_rad = rng.uniform(-np.pi, np.pi, 2)
        truths[name] = Truth(
            [
                range_m * np.cos(bearing_rad),
                speed_mps * np.cos(course_rad),
                range_m * np.sin(bearing_rad),
                speed_mps * np.sin(course_rad),
            ]
        )
    return truths


def recorded_by(truths, rng, offsets, *, minutes=10, clutter=20.0, place=(0.0, 0.0)):
    """The recording of a radar with offsets at a place."""
    radar = RadarSimulator(
        range_std_m=10.0,
        bearing_std_rad=np.radians(0.5),
        period_s=2.5,
        detection_probability=0.9,
        clutter_per_scan=clutter,
        max_range_m=9000.0,
        rotating=True,
    )
    own = Truth([place[0], 0.0, place[1], 0.0])
    recording = radar.record(truths, minutes * 24, rng, own=own)
    moved = [-offset for offset in offsets]
    episodes = [
        replace(one, scans=[scan.without_offsets(*moved) for scan in one.scans])
        for one in recording
    ]
    return replace(recording, episodes=episodes)


def scene(seed, offsets=OFFSETS, *, minutes=10, others=5, clutter=20.0):
    """A recording of five reported vessels, others and clutter by a radar with offsets."""
    rng = np.random.default_rng(seed)
    truths = fleet(rng, [*REPORTED, *(f"other {k}" for k in range(others))])
    return recorded_by(truths, rng, offsets, minutes=minutes, clutter=clutter)


def reports_of(recording, seed=0, every=4, std_m=5.0):
    """What the reported vessels report: every tenth second, with errors."""
    rng = np.random.default_rng(seed)
    found = {}
    for name in REPORTED:
        truth = recording.episodes[0].truth[name]
        rows = slice(None, None, every)
        count = len(truth.time_s[rows])
        found[name] = TargetTruth(
            truth.time_s[rows],
            truth.north_m[rows] + std_m * rng.standard_normal(count),
            truth.east_m[rows] + std_m * rng.standard_normal(count),
            truth.vnorth_mps[rows],
            truth.veast_mps[rows],
        )
    return found


def values(found):
    return np.array([found.range_m.value, found.bearing_rad.value, found.time_s.value])


def stds(found):
    return np.array([found.range_m.std, found.bearing_rad.std, found.time_s.std])


@pytest.fixture(scope="module")
def recorded():
    recording = scene(1)
    return recording, reports_of(recording)


# Offsets ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(3))
def test_the_offsets_of_a_simulated_radar_are_found(seed):
    recording = scene(seed)
    found = calibrate(recording, reports_of(recording, seed), radar=RADAR)
    error = np.abs(values(found) - OFFSETS)
    assert (error < 4.0 * stds(found)).all()
    assert error[0] < 3.0
    assert error[1] < np.radians(0.15)
    assert error[2] < 0.25
    assert found.range_m.determined
    assert found.bearing_rad.determined
    assert found.time_s.determined


def least_time_std_s(truths):
    """Cramér-Rao bound of the time offset: all matches known, and that the vessels run straight."""
    report_s, plot_s = np.arange(0.0, 600.0, 10.0), np.arange(0.0, 600.0, 2.5)
    information = np.zeros((3 + 4 * len(truths), 3 + 4 * len(truths)))
    for k, truth in enumerate(truths):
        place = slice(3 + 4 * k, 7 + 4 * k)  # north, east and velocities at the start
        for time_s in report_s:
            rows = np.hstack([np.eye(2), time_s * np.eye(2)]) / 5.0
            information[place, place] += rows.T @ rows + np.diag([0, 0, 100.0, 100.0])
        states = truth.state_at(plot_s)
        for time_s, (north_m, vnorth_mps, east_m, veast_mps) in zip(plot_s, states, strict=True):
            range_m = np.hypot(north_m, east_m)
            sight = np.array([[north_m, east_m], [-east_m, north_m]]) / range_m
            rows = np.zeros((2, len(information)))
            rows[:, :2] = np.diag([1.0, range_m])
            rows[:, 2] = -sight @ [vnorth_mps, veast_mps]
            rows[:, place] = np.hstack([sight, time_s * sight])
            rows /= np.array([[10.0], [range_m * np.radians(0.5)]])
            information += 0.9 * rows.T @ rows
    size = np.sqrt(np.diag(information))
    return np.sqrt(np.linalg.inv(information / np.outer(size, size))[2, 2]) / size[2]


def test_the_time_offset_errs_as_little_as_any_estimator_can():
    squares = []
    for seed in range(16):
        recording = scene(seed)
        found = calibrate(recording, reports_of(recording, seed), radar=RADAR)
        truths = list(fleet(np.random.default_rng(seed), REPORTED).values())
        squares.append(((found.time_s.value - OFFSETS[2]) / least_time_std_s(truths)) ** 2)
    assert 0.3 < np.mean(squares) < 1.5


@settings(max_examples=6, deadline=None)
@given(
    range_m=st.floats(-300.0, 300.0), bearing_deg=st.floats(-7.0, 7.0), time_s=st.floats(-1.0, 1.0)
)
def test_any_offsets_within_the_gate_are_found(range_m, bearing_deg, time_s):
    offsets = (range_m, np.radians(bearing_deg), time_s)
    recording = scene(3, offsets, others=0, clutter=5.0)
    found = calibrate(recording, reports_of(recording), radar=RADAR)
    assert (np.abs(values(found) - offsets) < 5.0 * stds(found)).all()


@pytest.mark.parametrize("offsets", [(0.0, np.radians(7.6), 0.0), (390.0, 0.0, 0.0)])
def test_offsets_of_which_the_gate_cuts_plots_off_are_not_determined(offsets):
    recording = scene(3, offsets, others=0, clutter=5.0)
    found = calibrate(recording, reports_of(recording), radar=RADAR)
    assert not found.range_m.determined
    assert not found.bearing_rad.determined
    assert found.bearing_rad.verdict == "near gate"


def test_it_carries_over_to_another_run(recorded):
    found = calibrate(*recorded, radar=RADAR)
    other = scene(77)
    scores = [
        wl.metrics.score(wl.track_recording(other, radar=radar), other, gate_m=400.0).overall
        for radar in (RADAR, found.applied_to(RADAR))
    ]
    before, after = (score.errors.position_rmse_m for score in scores)
    assert after < 0.3 * before


def test_reports_without_velocity_are_enough(recorded):
    recording, reports = recorded
    still = {
        name: replace(
            one, vnorth_mps=np.full(len(one), np.nan), veast_mps=np.full(len(one), np.nan)
        )
        for name, one in reports.items()
    }
    found = calibrate(recording, still, radar=RADAR)
    assert abs(found.bearing_rad.value - OFFSETS[1]) < np.radians(0.15)
    assert abs(found.range_m.value - OFFSETS[0]) < 4.0


def test_the_joyride_radar_is_two_degrees_off():
    joyride = wl.recording.load("joyride")
    thinned = {
        name: TargetTruth(
            *(
                getattr(truth, column)[::4]
                for column in ("time_s", "north_m", "east_m", "vnorth_mps", "veast_mps")
            )
        )
        for name, truth in joyride.episodes[0].truth.items()
    }
    found = calibrate(joyride, thinned, position_std_m=3.0)
    assert found.bearing_rad.determined
    assert np.degrees(found.bearing_rad.value) == pytest.approx(-1.9, abs=0.4)
    calibrated = read_settings(radar="joyride").calibrated(found)
    before, after = (
        wl.metrics.score(wl.track_recording(joyride, config=config), joyride).overall
        for config in (None, calibrated)
    )
    assert after.errors.position_rmse_m < before.errors.position_rmse_m - 3.0
    assert after.errors.position_rmse_m < 19.2


# Two radars ---------------------------------------------------------------------------------------


OTHER_OFFSETS = (-25.0, np.radians(-1.0), 0.1)


def two_radars(seed, place):
    """Recordings of one fleet by a radar at the origin, and by another one at a place."""
    rng = np.random.default_rng(seed)
    truths = fleet(rng, [f"vessel {k}" for k in range(8)])
    return (
        recorded_by(truths, rng, OFFSETS),
        recorded_by(truths, rng, OTHER_OFFSETS, place=place),
    )


def against(recording, other):
    tracks = wl.track_recording(other, radar=RADAR).smooth()
    return calibrate(recording, tracking.reports_of(tracks), radar=RADAR)


@pytest.mark.parametrize("place", [(0.0, 0.0), (3000.0, -2000.0)])
def test_two_radars_are_calibrated_against_each_other(place):
    found = against(*two_radars(5, place))
    difference = np.subtract(OFFSETS, OTHER_OFFSETS)
    assert (np.abs(values(found) - difference) < 4.0 * stds(found)).all()
    assert found.range_m.determined
    assert found.bearing_rad.determined
    others = (found.other_range_m, found.other_bearing_rad)
    apart = place != (0.0, 0.0)
    assert [one.determined for one in others] == [apart, apart]
    if apart:
        for one, truth in zip(others, OTHER_OFFSETS, strict=False):
            assert abs(one.value - truth) < 4.0 * one.std


def test_either_of_two_radars_has_the_opposite_difference():
    one, other = two_radars(6, (500.0, 500.0))
    there, back = against(one, other), against(other, one)
    spread = np.hypot(stds(there), stds(back))
    assert (np.abs(values(there) + values(back)) < 3.0 * spread).all()


# What is not determined ---------------------------------------------------------------------------


def test_one_vessel_on_a_steady_course_is_poor_geometry(recorded):
    recording, reports = recorded
    found = calibrate(recording, {REPORTED[0]: reports[REPORTED[0]]}, radar=RADAR)
    assert found.time_s.verdict == "poor geometry"
    assert found.applied_to(RADAR).time_offset_s == 0.0


def test_reports_of_another_hour_have_no_matches(recorded):
    recording, reports = recorded
    late = {name: replace(one, time_s=one.time_s + 3600.0) for name, one in reports.items()}
    found = calibrate(recording, late, radar=RADAR)
    assert [one.verdict for one in (found.range_m, found.bearing_rad, found.time_s)] == [
        "few matches"
    ] * 3
    assert found.applied_to(RADAR) == RADAR


def test_what_is_no_calibration_is_rejected(recorded):
    recording, reports = recorded
    with pytest.raises(ValueError, match="reports must be one mapping"):
        calibrate(recording, [reports, reports])
    for std_m in (0.0, -5.0, np.nan):
        with pytest.raises(ValueError, match="position_std_m"):
            calibrate(recording, reports, position_std_m=std_m)
    twice = replace(recording, episodes=recording.episodes * 2)
    with pytest.raises(ValueError, match="episodes must follow each other"):
        calibrate(twice, reports)
    with pytest.raises(ValueError, match="max_gap_s"):
        wl.CalibrationConfig(max_gap_s=-1.0)
    calibration = wl.Calibration(RADAR)
    with pytest.raises(ValueError, match=r"north_m must have shape \(3,\)"):
        calibration.add_reports(1, [0.0, 1.0, 2.0], north_m=[0.0, 1.0], east_m=0.0)
    with pytest.raises(ValueError, match=r"bearing_rad must have shape \(2,\)"):
        calibration.add_plots(0.0, range_m=[1.0, 2.0], bearing_rad=[1.0])
    assert calibration.add_reports(1, [5.0, 4.0, np.nan], north_m=0.0, east_m=0.0) == 2


def test_results_can_be_kept(recorded):
    found = calibrate(*recorded, radar=RADAR)
    offset = pickle.loads(pickle.dumps(found.bearing_rad))
    assert (offset.value, offset.std, offset.verdict) == (
        found.bearing_rad.value,
        found.bearing_rad.std,
        found.bearing_rad.verdict,
    )
    assert found.pair_probability.shape == found.pair_time_s.shape
    assert found.pair_probability.sum() == pytest.approx(found.matches)
    assert np.linalg.eigvalsh(found.covariance).min() > 0.0


# The tracker --------------------------------------------------------------------------------------


def test_a_tracker_subtracts_the_offsets_of_its_radar(recorded):
    recording, _ = recorded
    off = wl.Radar(
        **(
            RADAR.as_dict()
            | {"range_offset_m": 64.0, "bearing_offset_rad": 0.125, "time_offset_s": 0.5}
        )
    )
    exact, corrected = wl.Tracker(RADAR), wl.Tracker(off)
    for scan in recording.episodes[0].scans[:40]:
        time_s = max(scan.time_s, scan.plot_time_s.max(initial=-np.inf))
        exact.process(
            time_s,
            range_m=scan.range_m,
            bearing_rad=scan.bearing_rad,
            plot_time_s=scan.plot_time_s,
        )
        corrected.process(
            time_s + 0.5,
            range_m=scan.range_m + 64.0,
            bearing_rad=scan.bearing_rad + 0.125,
            plot_time_s=scan.plot_time_s + 0.5,
        )
    one, other = exact.tracks(), corrected.tracks()
    assert len(one.track_id) > 3
    np.testing.assert_allclose(one.time_s, other.time_s, atol=1e-9)
    # Bearings that are turned cross the seam elsewhere, so that numbers are in another order.
    means = (table.mean[np.argsort(table.mean[:, 0])] for table in (one, other))
    np.testing.assert_allclose(*means, rtol=1e-4, atol=0.01)


# The command --------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def files(recorded, tmp_path_factory):
    """plots.csv and reports.csv, in the plane; ais.csv, the same in latitude and longitude."""
    folder = tmp_path_factory.mktemp("calibration")
    recording, reports = recorded
    write_plots(folder / "plots.csv", recording)
    plane = wl.LocalPlane(latitude_rad=np.radians(54.0), longitude_rad=np.radians(10.0))
    tables = [["time_s,target,north_m,east_m"], ["time_s,mmsi,latitude,longitude"]]
    for name, one in reports.items():
        place_m = np.column_stack([one.north_m, one.east_m])
        degrees = np.degrees(np.column_stack(plane.place(place_m)))
        for table, places in zip(tables, (place_m, degrees), strict=True):
            rows = zip(one.time_s.tolist(), places.tolist(), strict=True)
            table += [f"{time_s},{name},{a:.9f},{b:.9f}" for time_s, (a, b) in rows]
    for file, table in zip(("reports.csv", "ais.csv"), tables, strict=True):
        (folder / file).write_text("\n".join(table) + "\n")
    return folder


def test_the_command_writes_a_radar_that_track_takes(files, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    out, found = tmp_path / "out", tmp_path / "found.json"
    command = ["calibrate", str(files / "plots.csv"), "--ais", str(files / "reports.csv")]
    assert main([*command, "--out", str(out), "--json", str(found)]) == 0
    text = capsys.readouterr().out
    assert "bearing" in text
    assert REPORTED[0] in text
    rows = {row["offset"]: row for row in json.loads(found.read_text())["rows"]}
    assert set(rows) == {"range_m", "bearing_rad", "time_s"}
    assert rows["bearing_rad"]["value"] == pytest.approx(OFFSETS[1], abs=np.radians(0.15))
    radar = read_settings(radar=out / "radar.toml").make_radar()
    assert radar.bearing_offset_rad == pytest.approx(rows["bearing_rad"]["value"])
    assert radar.range_offset_m == pytest.approx(rows["range_m"]["value"])
    assert (out / "calibration.png").read_bytes().startswith(b"\x89PNG")
    track = ["track", str(files / "plots.csv"), "--radar", str(out / "radar.toml")]
    assert main([*track, "--out", str(tmp_path / "tracks"), "--print-config"]) == 0


def test_the_command_compares_two_radars(tmp_path, capsys):
    recordings = two_radars(5, (0.0, 0.0))
    for name, recording in zip("ab", recordings, strict=True):
        write_plots(tmp_path / f"{name}.csv", recording)
    (tmp_path / "radar.toml").write_text(
        "range_std_m = 10.0\nbearing_std_deg = 0.5\nperiod_s = 2.5\n"
    )
    command = ["calibrate", str(tmp_path / "a.csv"), "--against", str(tmp_path / "b.csv")]
    radars = ["--radar", str(tmp_path / "radar.toml"), "--against-radar", tmp_path / "radar.toml"]
    results = ["--out", tmp_path / "out", "--json", tmp_path / "found.json"]
    assert main([*command, *map(str, radars), *map(str, results)]) == 0
    assert "other bearing" in capsys.readouterr().out
    rows = {row["offset"]: row for row in json.loads((tmp_path / "found.json").read_text())["rows"]}
    difference = OFFSETS[1] - OTHER_OFFSETS[1]
    assert rows["bearing_rad"]["value"] == pytest.approx(difference, abs=np.radians(0.1))
    assert not rows["other_bearing_rad"]["determined"]


def test_reports_in_latitude_and_longitude_need_the_origin(files, tmp_path, recorded, capsys):
    command = ["calibrate", str(files / "plots.csv"), "--ais", str(files / "ais.csv")]
    assert main([*command, "--out", str(tmp_path)]) == 2
    assert "--origin" in capsys.readouterr().err
    recording = replace(recorded[0], notes=[])
    flat = read_reports(files / "reports.csv", recording)[0]
    round_ = read_reports(files / "ais.csv", recording, origin_deg=(54.0, 10.0))[0]
    assert set(flat) == set(round_)
    for name, one in flat.items():
        np.testing.assert_allclose(one.north_m, round_[name].north_m, atol=0.01)
        np.testing.assert_allclose(one.east_m, round_[name].east_m, atol=0.01)


@pytest.mark.parametrize("origin", ["54", "north,east", ""])
def test_an_origin_that_is_none_is_rejected(files, origin, capsys):
    command = ["calibrate", str(files / "plots.csv"), "--ais", str(files / "ais.csv")]
    assert main([*command, "--origin", origin]) == 2
    assert "LAT,LON" in capsys.readouterr().err
