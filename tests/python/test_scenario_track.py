"""Truth from recorded tracks: it meets them, joins them smoothly, and can be scanned by a radar."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wakeline import montecarlo, recording
from wakeline.scenario import (
    RadarSimulator,
    RadarVideoSimulator,
    Scenario,
    Segment,
    TrackTruth,
    Truth,
    VideoTarget,
    smoothed,
)

RADAR = RadarSimulator(30.0, 0.01, 2.0)
TURN = Truth([0.0, 8.0, 500.0, 0.0], [Segment(60.0), Segment(60.0, 0.03), Segment(60.0)])
TIME_S = np.cumsum([0.0, 2.0, 5.0, 3.0, 10.0, 2.0, 7.0])

steps = st.lists(st.floats(0.5, 20.0), min_size=2, max_size=8)


def track_of(truth, time_s, error_m=0.0, error_mps=0.0, seed=0):
    """What a receiver records of a truth."""
    noise = np.random.default_rng(seed).standard_normal((len(time_s), 4))
    state = truth.state_at(time_s) + noise * [error_m, error_mps, error_m, error_mps]
    names = ("north_m", "vnorth_mps", "east_m", "veast_mps")
    return SimpleNamespace(time_s=time_s, **dict(zip(names, state.T, strict=True)))


@given(steps, st.integers(0, 2**32))
def test_a_track_is_met_in_place_and_velocity(steps_s, seed):
    time_s = np.cumsum(steps_s)
    rng = np.random.default_rng(seed)
    state = rng.normal(0, 100, (len(time_s), 4))
    truth = TrackTruth(time_s, state[:, 0], state[:, 2], state[:, 1], state[:, 3])
    np.testing.assert_allclose(truth.state_at(time_s), state, rtol=1e-9, atol=1e-6)
    just_before = truth.state_at(time_s[1:-1] - 1e-9)
    np.testing.assert_allclose(just_before, state[1:-1], atol=1e-4)


@given(steps, st.tuples(*[st.floats(-50, 50)] * 8))
def test_cubic_motion_is_met_everywhere(steps_s, coefficients):
    time_s = np.cumsum(steps_s) / 10.0
    north, east = np.reshape(coefficients, (2, 4))
    between_s = np.linspace(time_s[0], time_s[-1], 17)
    columns = [np.polyval(p, time_s) for p in (north, east, np.polyder(north), np.polyder(east))]
    got = TrackTruth(time_s, *columns).state_at(between_s)
    for k, p in enumerate((north, np.polyder(north), east, np.polyder(east))):
        scale = 1.0 + np.abs(np.polyval(np.abs(p), time_s[-1]))
        np.testing.assert_allclose(got[:, k] / scale, np.polyval(p, between_s) / scale, atol=1e-9)


def test_velocities_that_were_not_recorded_are_those_of_a_parabola():
    north_m, east_m = 3.0 + 2.0 * TIME_S - 0.1 * TIME_S**2, 5.0 * TIME_S
    got = TrackTruth(TIME_S, north_m, east_m).state_at(TIME_S)
    np.testing.assert_allclose(got[:, 1], 2.0 - 0.2 * TIME_S, atol=1e-9)
    np.testing.assert_allclose(got[:, 3], 5.0)
    some = np.where(np.arange(7) % 2, np.nan, 1.5)
    partly = TrackTruth(TIME_S, north_m, east_m, some, some).state_at(TIME_S)
    np.testing.assert_allclose(partly[::2, 1], 1.5)
    np.testing.assert_allclose(partly[1::2, 1], got[1::2, 1])
    line = TrackTruth([0.0, 2.0], [0.0, 10.0], [0.0, 0.0])
    np.testing.assert_allclose(line.state_at([0.0, 1.0]), [[0, 5, 0, 0], [5, 5, 0, 0]])


def test_outside_the_track_the_vessel_goes_straight_on():
    truth = TrackTruth(TIME_S, 10.0 * TIME_S, -(TIME_S**2))
    assert (truth.start_time_s, truth.end_time_s) == (TIME_S[0], TIME_S[-1])
    outside_s = np.array([-7.0, TIME_S[-1] + 7.0])
    ends = truth.state_at(TIME_S[[0, -1]])
    got = truth.state_at(outside_s)
    np.testing.assert_allclose(got[:, 1::2], ends[:, 1::2])
    np.testing.assert_allclose(got[:, 0::2], ends[:, 0::2] + [[-7.0], [7.0]] * ends[:, 1::2])
    np.testing.assert_array_equal(truth.turn_rate_at(outside_s), 0.0)


def test_turn_rates_are_those_of_the_vessel():
    time_s = np.arange(0.0, 181.0, 2.0)
    truth = TrackTruth.of(track_of(TURN, time_s))
    middle_s = np.arange(5.0, 180.0, 4.0)
    between = truth.state_at(middle_s) - TURN.state_at(middle_s)
    assert np.abs(between[:, 0::2]).max() < 1e-3
    np.testing.assert_allclose(truth.turn_rate_at(middle_s), TURN.turn_rate_at(middle_s), atol=1e-4)
    drifting = TrackTruth([0.0, 10.0, 20.0], [0.0, 1.0, 0.0], [0.0, 1.0, 2.0])
    np.testing.assert_array_equal(drifting.turn_rate_at([5.0, 15.0]), 0.0)


def test_truths_and_own_ships_of_recordings_are_tracks():
    (episode,) = recording.load("joyride").episodes
    for track in (episode.own, *episode.truth.values()):
        truth = TrackTruth.of(track)
        place_m = truth.state_at(track.time_s)[:, 0::2]
        np.testing.assert_allclose(place_m, np.column_stack([track.north_m, track.east_m]))


def test_a_log_of_instruments_is_a_track():
    log = recording.load_navigation()
    truth, fixes = TrackTruth.of(log), log.fixes.sound()
    place_m = fixes.plane().position_m(
        latitude_rad=fixes.latitude_rad, longitude_rad=fixes.longitude_rad
    )
    state = truth.state_at(fixes.time_s)
    np.testing.assert_allclose(state[:, 0::2], place_m, atol=1e-6)
    assert np.hypot(*state[0, 0::2]) < 1e-6
    np.testing.assert_allclose(np.hypot(state[::50, 1], state[::50, 3]), 3.0, atol=2.0)

    first, second = map(TrackTruth.of, log.parts())
    assert (first.start_time_s, second.end_time_s) == (truth.start_time_s, truth.end_time_s)
    assert second.start_time_s - first.end_time_s > 60.0

    start_s = second.start_time_s
    yacht = Scenario("yacht", smoothed(log.parts()[1]), RADAR, scans=60, start_time_s=start_s)
    ahead_m = yacht.truth.state_at(start_s + 60.0) - second.state_at(start_s + 60.0)
    assert np.hypot(*ahead_m[0, 0::2]) < 20.0
    assert np.isfinite(yacht.draw(runs=1, seed=1)).all()


def test_a_vessel_is_looked_at_from_where_its_track_begins():
    vessels = {mmsi: TrackTruth.of(t) for mmsi, t in recording.load_ais().tracks.items()}
    first = min(vessels.values(), key=lambda truth: truth.start_time_s)
    assert first.start_time_s > 1e9
    scene = Scenario("first", first, RADAR, scans=30)
    assert scene.start_time_s == first.start_time_s
    np.testing.assert_array_equal(scene.truth_states[0], first.state_at(scene.time_s[:1])[0])
    assert RADAR.observe(first, 3, rng=0)[0][0] == first.start_time_s
    vessels["buoy"] = Truth([100.0, 0.0, 0.0, 0.0])
    last_s = max(truth.start_time_s for truth in vessels.values())
    assert RADAR.record(vessels, 3, rng=0).episodes[0].time_s[0] == last_s
    targets = [VideoTarget(truth=truth, length_m=20.0, beam_m=5.0) for truth in vessels.values()]
    video = RadarVideoSimulator(sweeps_per_turn=600, cells=50, period_s=2.0)
    (first, second) = video.turns(targets, scans=2)
    assert first.time_s.min() == pytest.approx(last_s, abs=0.01)
    assert second.time_s.min() == pytest.approx(last_s + 2.0, abs=0.01)
    np.testing.assert_array_equal(video.turn(targets, rng=0).time_s, first.time_s)


def test_a_track_can_be_moved_in_front_of_a_radar():
    truth = TrackTruth.of(track_of(TURN, np.arange(0.0, 181.0, 5.0)))
    moved = truth.moved(1000.0, -400.0)
    time_s = np.linspace(-10, 200, 43)
    np.testing.assert_allclose(
        moved.state_at(time_s) - truth.state_at(time_s),
        [[1000.0, 0.0, -400.0, 0.0]] * 43,
        atol=1e-9,
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([0.0], [0.0], [0.0]), r"time_s must have shape \(n,\), n at least 2, got \(1,\)"),
        (([0.0, 0.0], [0.0, 1.0], [0.0, 1.0]), "time_s must be finite and increase"),
        (([0.0, np.inf], [0.0, 1.0], [0.0, 1.0]), "time_s must be finite and increase"),
        (([0.0, 1.0], [0.0], [0.0, 1.0]), r"north_m must have shape \(2,\), got \(1,\)"),
        (([0.0, 1.0], [0.0, np.nan], [0.0, 1.0]), "north_m and east_m must be finite"),
        (([0.0, 1.0], [0.0, 1.0], [0.0, 1.0], [1.0]), "vnorth_mps must have shape"),
    ],
)
def test_tracks_that_are_invalid(arguments, message):
    with pytest.raises(ValueError, match=message):
        TrackTruth(*arguments)


# ------------------------------------------------------------------ smoothing


def test_smoothing_takes_errors_out_of_a_track():
    time_s = np.arange(0.0, 181.0, 3.0)
    heard = track_of(TURN, time_s, error_m=5.0, error_mps=0.3, seed=2)
    raw, calm = TrackTruth.of(heard), smoothed(heard, delay_std_s=0.0)

    def rmse_m(truth):
        return np.hypot(*(truth.state_at(time_s) - TURN.state_at(time_s))[:, 0::2].T).std()

    assert rmse_m(calm) < 0.5 * rmse_m(raw)


def test_smoothing_leaves_alone_what_has_no_errors():
    heard = track_of(TURN, np.arange(0.0, 181.0, 3.0))
    calm = smoothed(heard, position_std_m=1e-3, delay_std_s=0.0, velocity_std_mps=1e-3)
    time_s = np.linspace(0, 180, 61)
    np.testing.assert_allclose(calm.state_at(time_s), TURN.state_at(time_s), atol=0.02)


def test_smoothing_evens_out_reports_that_came_late():
    time_s = np.arange(0.0, 181.0, 3.0)
    straight = Truth([0.0, 15.0, 0.0, 0.0])
    heard = track_of(straight, time_s)
    heard.north_m = heard.north_m - 15.0 * np.random.default_rng(1).uniform(0, 2, len(time_s))
    reported, untold = (
        smoothed(heard, delay_std_s=delay_s).state_at(time_s)[:, 0] - 15.0 * time_s
        for delay_s in (1.0, 0.0)
    )
    assert reported.std() < 0.1 * (heard.north_m - 15.0 * time_s).std()
    assert reported.std() < 0.6 * untold.std()


def test_smoothing_manages_with_positions_alone():
    heard = track_of(TURN, np.arange(0.0, 181.0, 3.0), error_m=1.0)
    heard.vnorth_mps = np.full_like(heard.vnorth_mps, np.nan)
    calm = smoothed(heard, position_std_m=1.0, delay_std_s=0.0)
    time_s = np.arange(30.0, 150.0, 3.0)
    assert np.hypot(*(calm.state_at(time_s) - TURN.state_at(time_s))[:, 0::2].T).max() < 3.0


@pytest.mark.parametrize(
    "name", ["position_std_m", "delay_std_s", "velocity_std_mps", "accel_psd_m2s3"]
)
def test_smoothing_parameters_that_are_invalid(name):
    heard = track_of(TURN, np.arange(0.0, 30.0, 3.0))
    for wrong in (-1.0, np.nan):
        with pytest.raises(ValueError, match=name):
            smoothed(heard, **{name: wrong})


# ------------------------------------------------------------------ a recorded vessel, scanned


def test_a_vessel_of_the_solent_is_tracked_under_a_coastal_radar():
    track = max(recording.load_ais().tracks.values(), key=len)
    part = max(track.parts(30.0), key=len)
    truth = smoothed(part)
    here = truth.state_at(truth.start_time_s)[0]
    seen = Scenario(
        "solent",
        truth.moved(2000.0 - here[0], 1000.0 - here[2]),
        RADAR,
        scans=60,
        start_time_s=truth.start_time_s,
    )
    assert len(seen.switch_times_s) == 0
    assert not seen.control_mps2.any()
    result = montecarlo.run(seen, {"clairvoyant": montecarlo.clairvoyant}, 5, progress=False)
    assert result["solent", "clairvoyant"].summary()["failed_runs"] == 0
    assert np.isfinite(montecarlo.bound_curves(seen)).all()
