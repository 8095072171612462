"""Whole recordings through the tracker, and the alarms that their tracks raise."""

import dataclasses
import pickle
from importlib import resources

import numpy as np
import pytest

import wakeline as wl
from wakeline import metrics, recording, scenario
from wakeline.cli import main
from wakeline.recording import OwnShipMotion, RecordingError, Tracks, read_tracks
from wakeline.tracking import (
    Settings,
    open_recording,
    track_episode,
    write_tables,
)

BUNDLED = resources.files("wakeline.recording") / "data"
PERIOD_S = 2.5

# coverage, ids, switches, breaks, debiased position, velocity, course, false-track scans a scan
MUST = {
    "joyride": (0.97, 1, 0, 2, 20.0, 3.5, 19.0, 0.0),
    "autoferry": (0.94, 12, 2, 3, 5.5, 0.60, 8.5, 1.2),
}


def boat(scans, start_s=1000.0):
    """Rows time_s, north_m, east_m of a boat that steams north-east at 10 m/s."""
    rng = np.random.default_rng(1)
    after_s = PERIOD_S * np.arange(scans)
    place = np.column_stack([1000.0 + 6.0 * after_s, 500.0 + 8.0 * after_s])
    return np.column_stack([start_s + after_s, place + rng.normal(scale=3.0, size=place.shape)])


def write(path, rows, head="time_s,north_m,east_m"):
    path.write_text("\n".join([head, *(",".join(map(str, row)) for row in rows)]) + "\n")
    return path


def tracks_of(path, rows, head="time_s,north_m,east_m", **how):
    """The tracks of plots that come in a file."""
    return wl.track_recording(write(path / "plots.csv", rows, head), **how)


# Recordings ---------------------------------------------------------------------------------------


@pytest.fixture(scope="module", params=MUST)
def bundled(request):
    """A bundled recording and its tracks."""
    return recording.load(request.param), wl.track_recording(request.param)


def test_the_tracks_of_a_real_recording_are_as_good_as_they_must_be(bundled):
    real, tracks = bundled
    score = metrics.score(tracks, real).overall
    coverage, ids, switches, breaks, position_m, velocity_mps, course_deg, false = MUST[real.name]
    assert score.coverage >= coverage
    assert score.ids <= ids
    assert score.switches <= switches
    assert score.breaks <= breaks
    assert score.errors.position_rmse_debiased_m <= position_m
    assert score.errors.velocity_rmse_mps <= velocity_mps
    assert score.errors.course_rms_deg <= course_deg
    assert score.false_track_scans_per_scan <= false


def test_the_library_finds_the_tracks_of_the_command(bundled, tmp_path, no_pictures):
    real, tracks = bundled
    assert main(["demo", "--recording", real.name, "--out", str(tmp_path / "demo")]) == 0
    (tmp_path / "mine").mkdir()
    for file in write_tables(tmp_path / "mine", tracks.episodes):
        assert file.read_bytes() == (tmp_path / "demo" / file.name).read_bytes()


def test_a_recording_its_name_and_its_files_give_the_same_tracks(bundled):
    real, tracks = bundled
    files = [str(BUNDLED / real.name / f"{kind}.csv") for kind in ("plots", "scans")]
    opened = wl.track_recording(real, radar=real.name)
    read = wl.track_recording(files[0], own=files[1], radar=real.name)
    for other in (opened, read):
        np.testing.assert_array_equal(other.track_id, tracks.track_id)
        np.testing.assert_array_equal(other.time_s, tracks.time_s)
        np.testing.assert_array_equal(other.state, tracks.state)
    assert (tracks.cpa_m, opened.cpa_m) == (None, None)
    assert np.isfinite(read.cpa_m).all()


def test_tracks_are_a_table_that_keeps_its_episodes(bundled):
    real, tracks = bundled
    assert len(tracks) == sum(len(tracked.tracks) for tracked in tracks.episodes)
    assert [tracked.episode.name for tracked in tracks.episodes] == [e.name for e in real]
    assert len(tracks.recording) == len(real)
    assert type(tracks.where(slice(None))) is Tracks
    again = pickle.loads(pickle.dumps(tracks))
    np.testing.assert_array_equal(again.state, tracks.state)
    for episode, tracked in zip(real, tracks.episodes, strict=True):
        assert list(map(len, tracked.plot_track_id)) == [len(scan) for scan in episode.scans]


def test_radar_vessels_and_configuration_are_settings(tmp_path):
    plots = write(tmp_path / "plots.csv", boat(40))
    radar = wl.Radar(range_std_m=7.0, period_s=PERIOD_S)
    tracks = wl.track_recording(plots, radar=radar, vessels="ships", config=wl.TrackerConfig())
    assert tracks.settings.radar["range_std_m"] == 7.0
    assert tracks.settings.vessels == "ships"
    never = wl.TrackerConfig(confirm_hits=30, confirm_window=32)
    assert len(wl.track_recording(plots, config=never)) < len(tracks) - 20


def test_an_explicit_radar_wins_over_that_of_the_recording():
    real = recording.load("joyride")
    assert wl.track_recording(real).settings.radar == Settings.default().radar | real.radar
    explicit = wl.track_recording(real, radar=wl.Radar()).settings.radar
    assert explicit["range_std_m"] == wl.Radar().range_std_m


def test_simulated_recordings_are_tracked():
    truth = {"a": scenario.Truth([2000.0, -5.0, 1000.0, 4.0])}
    made = scenario.RadarSimulator(10.0, 0.005, PERIOD_S).record(truth, 60, rng=1)
    tracks = wl.track_recording(made)
    assert metrics.score(tracks, made).overall.coverage > 0.9


def test_a_boat_at_play_is_held_even_when_ships_are_expected():
    real = recording.load("joyride")
    score = metrics.score(wl.track_recording(real, vessels="ships"), real).overall
    assert score.coverage >= 0.97
    assert score.ids == 1


def test_tracks_are_at_scans_and_on_the_boat(tmp_path):
    tracks = tracks_of(tmp_path, boat(40))
    assert tracks.ids() == ["1"]
    assert set(tracks.status) <= {"confirmed", "coasting"}
    assert np.isin(tracks.time_s, boat(40)[:, 0]).all()
    assert np.isfinite(tracks.covariance).all()
    np.testing.assert_allclose(tracks.mode_probability.sum(axis=1), 1.0)
    np.testing.assert_allclose(tracks.state[-1], [1585.0, 6.0, 1280.0, 8.0], atol=8.0)
    (tracked,) = tracks.episodes
    assert tracked.events[0].kind == "started"
    assert (tracked.events[-1].kind, tracked.events[-1].track_id) == ("confirmed", 1)
    assert tracked.plot_track_id[-1].tolist() == [1]


def test_plots_are_shown_without_the_offset_of_the_radar(tmp_path):
    time_s, north_m, east_m = boat(40).T
    bearing_deg = np.degrees(np.arctan2(east_m, north_m)) + 5.0
    polar = np.column_stack([time_s, np.hypot(north_m, east_m), bearing_deg])
    radar = tmp_path / "radar.toml"
    radar.write_text("bearing_offset_deg = 5.0\n")
    tracks = tracks_of(tmp_path, polar, "time_s,range_m,bearing_deg", radar=radar)
    place_m = np.concatenate([scan.position_m for scan in tracks.recording.episodes[0].scans])
    np.testing.assert_allclose(place_m, np.column_stack([north_m, east_m]), atol=1e-6)
    assert np.hypot(*(tracks.state[-1, ::2] - place_m[-1])) < 10.0


def test_range_and_bearing_give_the_tracks_of_north_and_east(tmp_path):
    time_s, north_m, east_m = boat(40).T
    polar = np.column_stack(
        [time_s, np.hypot(north_m, east_m), np.degrees(np.arctan2(east_m, north_m))]
    )
    one = tracks_of(tmp_path, boat(40))
    other = tracks_of(tmp_path, polar, "Time,Range [m],Azimuth (deg)")
    np.testing.assert_allclose(one.state, other.state, rtol=1e-9)


def test_each_scenario_starts_afresh(tmp_path):
    rows = [(f"run {k}", *row) for k in (1, 2) for row in boat(20, start_s=1000.0 * k)]
    tracks = tracks_of(tmp_path, rows, "scenario,time_s,north_m,east_m")
    assert set(tracks.scenario) == {"run 1", "run 2"}
    assert set(tracks.track_id) == {"1"}
    one, two = (tracks.where(tracks.scenario == name) for name in ("run 1", "run 2"))
    np.testing.assert_allclose(one.state, two.state)


def test_the_order_of_rows_does_not_matter_and_repeated_ones_count_once(tmp_path):
    rows = boat(40)
    shuffled = np.random.default_rng(2).permutation(np.concatenate([rows, rows[5:8]]))
    np.testing.assert_array_equal(
        tracks_of(tmp_path, shuffled).state, tracks_of(tmp_path, rows).state
    )


def test_plots_without_a_position_are_left_out(tmp_path):
    rows = boat(30)
    rows[[7, 12], 1] = np.nan
    tracks = tracks_of(tmp_path, rows)
    assert any("2 plots without a finite position" in note for note in tracks.recording.notes)
    assert np.isfinite(tracks.state).all()


def test_no_plots_give_no_tracks(tmp_path):
    tracks = tracks_of(tmp_path, [])
    assert (len(tracks), tracks.ids(), tracks.alarms) == (0, [], [])


@pytest.mark.parametrize("pause_s", [0.0, 1e-6, 3600.0])
def test_scans_no_time_apart_or_an_hour(tmp_path, pause_s):
    rows = boat(40)
    rows[20:, 0] += pause_s - PERIOD_S
    tracks = tracks_of(tmp_path, rows)
    assert np.isfinite(tracks.state).all()
    assert len(tracks.ids()) == (2 if pause_s == 3600.0 else 1)


def test_ten_thousand_plots_in_a_scan(tmp_path):
    rng = np.random.default_rng(3)
    crowd = np.column_stack([np.full(10_000, 1050.0), rng.uniform(-2e4, 2e4, (10_000, 2))])
    tracks = tracks_of(tmp_path, np.concatenate([boat(40), crowd]))
    assert np.isfinite(tracks.state).all()
    assert "1" in tracks.ids()


def test_plots_at_the_radar_itself(tmp_path):
    rows = boat(40)
    rows[:, 1:] -= rows[20, 1:]  # passes through the radar
    rows[::4, 1:] = 0.0
    assert np.isfinite(tracks_of(tmp_path, rows).state).all()


def test_what_cannot_be_tracked_is_named(tmp_path):
    with pytest.raises(RecordingError, match=r"none.csv: the file cannot be read"):
        wl.track_recording(tmp_path / "none.csv")
    plots = write(tmp_path / "plots.csv", boat(3))
    with pytest.raises(TypeError, match=r"own must be a file for the recording in .*plots.csv"):
        wl.track_recording(plots, own=OwnShipMotion.fixed())
    with pytest.raises(ValueError, match="truth goes with a file of plots"):
        open_recording("joyride", truth=plots)


# Grouping of plots into scans ---------------------------------------------------------------------


def two_boats():
    """Two boats, the second seen 0.9 s after the first."""
    return np.concatenate([boat(40), boat(40) + np.array([0.9, 800.0, -2000.0])])


def test_a_period_groups_plots_that_have_times_of_their_own(tmp_path):
    tracks = tracks_of(tmp_path, two_boats(), radar="joyride")
    assert len(tracks.ids()) == 2
    assert [len(scan) for scan in tracks.recording.episodes[0].scans] == [2] * 40


def test_scan_numbers_group_plots_whatever_their_times(tmp_path):
    rows = np.column_stack([np.tile(np.arange(40), 2), two_boats()])
    tracks = tracks_of(tmp_path, rows, "scan,time_s,north_m,east_m")
    assert len(tracks.ids()) == 2
    assert [scan.number for scan in tracks.recording.episodes[0].scans] == list(range(40))


def test_antenna_revolutions_are_estimated_from_times_and_bearings(tmp_path):
    rng = np.random.default_rng(4)
    bearing = rng.uniform(0.0, 2 * np.pi, 6)  # six beacons, each seen as the beam passes
    rows = [
        (1000.0 + PERIOD_S * (turn + b / (2 * np.pi)), 3000 * np.cos(b), 3000 * np.sin(b))
        for turn in range(30)
        for b in bearing
    ]
    tracks = tracks_of(tmp_path, rows)
    time_s, north_m, east_m = np.array(sorted(rows)).T
    period_s = recording.revolution_s(time_s, np.arctan2(east_m, north_m))
    assert period_s == pytest.approx(PERIOD_S, rel=0.02)
    number = recording.scan_numbers(time_s, np.arctan2(east_m, north_m), PERIOD_S)
    assert np.bincount(number)[1:-1].tolist() == [6] * (number[-1] - 1)
    sizes = [len(scan) for scan in tracks.recording.episodes[0].scans]
    assert sizes[1:-1] == [6] * (len(sizes) - 2)
    assert any("2.5 s" in note for note in tracks.recording.notes)


def test_scans_without_plots_are_coasted_through(tmp_path):
    rows = boat(40)
    listed = [(k, row[0], 0, 0) for k, row in enumerate(rows)]
    own = write(tmp_path / "scans.csv", listed, "scan,time_s,own_north_m,own_east_m")
    seen = np.delete(np.column_stack([np.arange(40), rows]), [20, 21], axis=0)
    tracks = tracks_of(tmp_path, seen, "scan,time_s,north_m,east_m", own=own)
    np.testing.assert_array_equal(tracks.time_s[tracks.status == "coasting"], rows[[20, 21], 0])
    assert tracks.ids() == ["1"]


def test_rows_are_at_the_times_of_scans_whose_plots_come_later(tmp_path):
    rows = boat(41)
    begin_s = rows[:, 0] - 2.0
    listed = [(k, time_s, 0, 0) for k, time_s in enumerate(begin_s)]
    own = write(tmp_path / "scans.csv", listed, "scan,time_s,own_north_m,own_east_m")
    seen = np.column_stack([np.arange(40), rows[:40]])
    tracks = tracks_of(tmp_path, seen, "scan,time_s,north_m,east_m", own=own)
    assert len(tracks) > 30
    assert np.isin(tracks.time_s, begin_s).all()
    after_s = tracks.time_s - 1000.0
    true_m = np.column_stack([1000.0 + 6.0 * after_s, 500.0 + 8.0 * after_s])
    assert np.hypot(*(tracks.state[:, 0::2] - true_m).T)[10:].max() < 8.0


# Alarms -------------------------------------------------------------------------------------------


def approaching(probability, tcpa_s=60.0):
    """Rows of one track with these probabilities of a close approach, 10 s apart."""
    zero = np.zeros(len(probability))
    return Tracks(
        np.full(len(zero), "7"),
        10.0 * np.arange(len(zero)),
        np.zeros((len(zero), 4)),
        cpa_m=zero + 300.0,
        tcpa_s=zero + tcpa_s,
        cpa_probability=np.array(probability),
    )


SCANS, SCAN_S = 120, 3.0


@pytest.fixture(scope="module")
def encounter(tmp_path_factory):
    """Plots of one ship head on, 100 m off, and one that passes two miles off; own ship's file.

    Own ship steams north at 5 m/s.
    """
    folder = tmp_path_factory.mktemp("encounter")
    rng = np.random.default_rng(3)
    time_s = SCAN_S * np.arange(SCANS)
    head_on = np.column_stack([4000.0 - 6.0 * time_s, 0.0 * time_s + 100.0])
    clear = np.column_stack([2000.0 - 6.0 * time_s, 0.0 * time_s + 4000.0])
    rows = [
        (1000.0 + t, *(ship[k] + rng.normal(scale=4.0, size=2)))
        for k, t in enumerate(time_s)
        for ship in (head_on, clear)
    ]
    own = [(1000.0 + t, 5.0 * t, 0.0) for t in time_s]
    return (
        write(folder / "plots.csv", rows),
        write(folder / "own.csv", own, "time_s,own_north_m,own_east_m"),
    )


def test_the_ship_head_on_raises_an_alarm_and_the_other_does_not(encounter):
    plots, own = encounter
    tracks = wl.track_recording(plots, own=own)
    near = tracks.where(tracks.east_m < 2000.0)
    far = tracks.where(tracks.east_m > 2000.0)
    assert np.all(far.cpa_probability < 0.3)
    settled = near.where(near.time_s > 1120.0)
    np.testing.assert_allclose(settled.cpa_m, 100.0, atol=60.0)
    meeting_s = 1000.0 + 4000.0 / 11.0
    np.testing.assert_allclose(settled.time_s + settled.tcpa_s, meeting_s, atol=10.0)
    assert np.all(settled.cpa_probability[settled.time_s < meeting_s - 10.0] > 0.9)
    (alarm,) = tracks.alarms
    assert (alarm.first, alarm.second) == ("own", near.track_id[0])
    assert 1000.0 < alarm.begin_s < 1060.0
    distance_m = 4000.0 - 11.0 * (alarm.begin_s - 1000.0)
    assert alarm.range_m == pytest.approx(distance_m, abs=30.0)


def test_own_ship_of_an_open_recording_is_watched(encounter):
    plots, own = encounter
    opened = open_recording(plots, own)
    of_files = wl.track_recording(plots, own=own)
    for ship in (opened.episodes[0].own, own):
        tracks = wl.track_recording(opened, own=ship)
        np.testing.assert_array_equal(tracks.cpa_m, of_files.cpa_m)
        assert tracks.alarms == of_files.alarms
    assert wl.track_recording(opened).cpa_m is None


def test_limits_of_danger_change_the_alarms_and_no_track(encounter, tmp_path):
    plots, own = encounter
    wide = tmp_path / "wide.toml"
    wide.write_text("[danger]\ncpa_limit_m = 9000\n")
    a = wl.track_recording(plots, own=own)
    b = wl.track_recording(plots, own=own, config=wide)
    np.testing.assert_array_equal(a.state, b.state)
    np.testing.assert_array_equal(a.cpa_m, b.cpa_m)
    assert np.all(b.cpa_probability >= a.cpa_probability - 1e-3)
    assert set(b.track_id[b.cpa_probability > 0.9]) == set(b.track_id)


def test_the_covariance_of_own_ships_velocity_is_in_the_probability(encounter):
    plots, own = encounter
    opened = open_recording(plots, own)
    ship = opened.episodes[0].own
    velocity = {"vnorth_mps": np.full(SCANS, 5.0), "veast_mps": np.zeros(SCANS)}
    probability = {}
    for std_mps in (0.05, 0.2, 2.0, None):
        covariance = None if std_mps is None else np.tile(std_mps**2 * np.eye(2), (SCANS, 1, 1))
        known = dataclasses.replace(ship, velocity_m2s2=covariance, **velocity)
        tracks = track_episode(opened.episodes[0], own=known).tracks
        probability[std_mps] = tracks.where(tracks.time_s > 1060.0).cpa_probability
    np.testing.assert_allclose(probability[None], probability[0.2], atol=1e-12)
    assert (probability[0.05] != probability[0.2]).any()
    assert np.abs(probability[2.0] - probability[0.05]).max() > 0.1


def test_an_own_ship_of_one_position_raises_no_alarm(encounter):
    plots, _ = encounter
    tracks = wl.track_recording(wl.tracking.open_recording(plots), own=OwnShipMotion.fixed())
    assert tracks.episodes[0].alarms is None
    assert tracks.cpa_m is None


CRAFT = "[models]\ncruising_probability = 0\nsettling_s = 1e9\n"


@pytest.mark.parametrize(("models", "needs_hold"), [("", False), (CRAFT, True)])
def test_one_encounter_from_afar_is_one_alarm(tmp_path, models, needs_hold):
    """Even by models that expect a maneuver at any time, whose probabilities vary."""
    rng = np.random.default_rng(4)
    time_s = SCAN_S * np.arange(260)
    own_m = 5.0 * time_s
    range_m = np.hypot(9000.0 - 12.0 * time_s, 600.0) + rng.normal(scale=25.0, size=260)
    bearing = np.arctan2(600.0, 9000.0 - 12.0 * time_s) + rng.normal(scale=0.009, size=260)
    rows = np.column_stack([time_s, own_m + range_m * np.cos(bearing), range_m * np.sin(bearing)])
    opened = open_recording(write(tmp_path / "plots.csv", rows))
    own = OwnShipMotion(time_s, own_m, 0.0 * time_s)
    config = tmp_path / "mine.toml"
    counts = []
    for hold in ("", "[danger]\nclear_hold_s = 0\n"):
        config.write_text(f"{models}[radar]\nrange_std_m = 25\nbearing_std_deg = 0.5\n{hold}")
        counts.append(len(wl.track_recording(opened, own=own, config=config).alarms))
    assert counts[0] == 1
    assert (counts[1] > 1) == needs_hold


def test_danger_is_red_on_the_map():
    colors = pytest.importorskip("matplotlib.colors")
    tracks = dataclasses.replace(approaching([0.1, 0.9, 0.9]), alarmed=[False, True, True])
    ax = wl.plot.map(tracks).axes[0]
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert names.count("danger") == 1
    assert "7: CPA 300 m in 1.0 min" in [text.get_text() for text in ax.texts]
    red = [line for line in ax.lines if colors.to_hex(line.get_color()) == "#e00000"]
    assert np.isnan(red[0].get_xdata()).tolist() == [True, False, False]
    calm = wl.plot.map(dataclasses.replace(tracks, alarmed=[False] * 3)).axes[0]
    assert "danger" not in [text.get_text() for text in calm.get_legend().get_texts()]


def test_tables_are_read_back(bundled, tmp_path):
    _, tracks = bundled
    file, *_ = write_tables(tmp_path, tracks.episodes)
    np.testing.assert_array_equal(read_tracks(file).state, tracks.state)
