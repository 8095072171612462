"""Scenarios: truth obeys its equations of motion, the radar has the errors it says."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wakeline import metrics
from wakeline.scenario import RadarSimulator, Scenario, Segment, TrackTruth, Truth, UsvMission

rates = st.floats(-0.3, 0.3)
accelerations = st.floats(0.0, 0.5)
START = [100.0, 6.0, -50.0, 8.0]


def runge_kutta(state, duration_s, turn_rate, acceleration, steps=400):
    """The same motion by small steps."""

    def slope(s):
        speed = np.hypot(s[1], s[3])
        along = acceleration * np.array([s[1], s[3]]) / speed
        return np.array([s[1], along[0] - turn_rate * s[3], s[3], along[1] + turn_rate * s[1]])

    h = duration_s / steps
    for _ in range(steps):
        k1 = slope(state)
        k2 = slope(state + h / 2 * k1)
        k3 = slope(state + h / 2 * k2)
        k4 = slope(state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return state


@pytest.mark.parametrize("turn_rate", [0.0, 1e-12, 1e-6, 1e-3, -0.015, 0.03, 0.3, -0.3])
@pytest.mark.parametrize("acceleration", [0.0, 0.2, -0.2])
def test_truth_obeys_its_equation_of_motion(turn_rate, acceleration):
    truth = Truth(START, [Segment(40.0, turn_rate, acceleration)])
    for at in (0.5, 20.0, 40.0):
        wanted = runge_kutta(np.array(START), at, turn_rate, acceleration)
        np.testing.assert_allclose(truth.state_at(at)[0], wanted, atol=1e-5)


@given(rates, accelerations, st.floats(1.0, 30.0))
def test_a_segment_cut_in_two_is_the_same_motion(turn_rate, acceleration, cut_s):
    whole = Truth(START, [Segment(60.0, turn_rate, acceleration)])
    halves = Truth(
        START,
        [Segment(cut_s, turn_rate, acceleration), Segment(60.0 - cut_s, turn_rate, acceleration)],
    )
    time_s = np.linspace(0.0, 60.0, 41)
    np.testing.assert_allclose(halves.state_at(time_s), whole.state_at(time_s), atol=1e-8)


@given(rates)
def test_small_and_large_turns_join_smoothly(turn_rate):
    near = Truth(START, [Segment(2.0, turn_rate, 0.3)]).state_at(2.0)
    next_to_it = Truth(START, [Segment(2.0, turn_rate + 1e-9, 0.3)]).state_at(2.0)
    np.testing.assert_allclose(near, next_to_it, atol=1e-6)


def test_a_full_turn_to_starboard_comes_back():
    truth = Truth([0.0, 10.0, 0.0, 0.0], [Segment(2 * np.pi / 0.1, 0.1)])
    quarter = truth.state_at(0.5 * np.pi / 0.1)[0]
    np.testing.assert_allclose(quarter, [100.0, 0.0, 100.0, 10.0], atol=1e-9)
    np.testing.assert_allclose(truth.state_at(truth.end_time_s)[0], [0, 10, 0, 0], atol=1e-9)


def test_outside_its_segments_a_vessel_goes_straight_on():
    truth = Truth(START, [Segment(10.0, 0.2, 0.5)], start_time_s=5.0)
    before, start = truth.state_at([-5.0, 5.0])
    np.testing.assert_allclose(before[0::2], start[0::2] - 10.0 * start[1::2])
    end, after = truth.state_at([15.0, 25.0])
    np.testing.assert_allclose(after[1::2], end[1::2])
    np.testing.assert_allclose(after[0::2], end[0::2] + 10.0 * end[1::2])
    assert np.hypot(*end[1::2]) == pytest.approx(15.0)
    np.testing.assert_array_equal(truth.turn_rate_at([0.0, 5.0, 14.9, 15.0]), [0.0, 0.2, 0.2, 0.0])


def test_a_vessel_may_start_at_rest_on_a_given_course():
    truth = Truth([0, 0, 0, 0], [Segment(10.0, 0.0, 1.0)], start_course_rad=np.pi / 2)
    np.testing.assert_allclose(truth.state_at(10.0)[0], [0, 0, 50, 10], atol=1e-12)


@pytest.mark.parametrize("turns", [-1, 0, 1])
def test_a_vessel_that_moves_starts_on_the_course_of_its_velocity(turns):
    course_rad = np.arctan2(START[3], START[1])
    reported = Truth(START, [Segment(9.0, 0.1)], start_course_rad=course_rad + turns * 2 * np.pi)
    wanted = Truth(START, [Segment(9.0, 0.1)])
    np.testing.assert_allclose(reported.state_at(20.0), wanted.state_at(20.0), atol=1e-9)
    with pytest.raises(ValueError, match=r"start_course_rad must be the course of .*got 1\.57"):
        Truth(START, start_course_rad=np.pi / 2)


def test_scenarios_of_other_truths_have_other_parameters():
    radar = RadarSimulator(30.0, 0.01, 3.0)

    def parameters(truth):
        return Scenario("one", truth, radar, 20).parameters["truth"]

    straight = Truth([1000.0, 5.0, 0.0, 0.0], [Segment(60.0)])
    turning = Truth([1000.0, 5.0, 0.0, 0.0], [Segment(60.0, 0.02)])
    recorded = TrackTruth([0.0, 60.0], [1000.0, 1300.0], [0.0, 0.0])
    moved = recorded.moved(1.0, 0.0)
    reported = [parameters(truth) for truth in (straight, turning, recorded, moved)]
    assert all(one != other for k, one in enumerate(reported) for other in reported[:k])
    assert parameters(recorded) == reported[2]
    assert reported[2]["type"] == "TrackTruth"


def test_what_another_truth_calls_parameters_is_its_own():
    class Known(TrackTruth):
        parameters = np.zeros(3)

    truth = Known([0.0, 60.0], [1000.0, 1300.0], [0.0, 0.0])
    reported = Scenario("one", truth, RadarSimulator(30.0, 0.01, 3.0), 20).parameters["truth"]
    assert reported["type"] == "Known"
    assert len(reported["states_sha256"]) == 64


@pytest.mark.parametrize("name", ["switch_times_s", "control_switch_times_s"])
def test_what_another_truth_reports_of_its_switches_are_numbers(name):
    reported = type("Told", (TrackTruth,), {name: ["10", "20"]})
    truth = reported([0.0, 60.0], [1000.0, 1300.0], [0.0, 0.0])
    with pytest.raises(TypeError, match=f"^{name} must hold real numbers: got text such as '10'"):
        getattr(Scenario("one", truth, RadarSimulator(30.0, 0.01, 3.0), 20), name)


def test_truths_show_themselves_in_a_few_words():
    truth = Truth([0.0, 5.0, 0.0, 0.0], [Segment(60.0), Segment(30.0, 0.02)], start_time_s=10.0)
    assert repr(truth) == "<Truth: 2 segments, 10.0 to 100.0 s>"
    assert repr(Truth([0.0, 5.0, 0.0, 0.0])) == "<Truth: 0 segments, 0.0 to 0.0 s>"
    recorded = TrackTruth([0.0, 1.0, 2.5], [0.0, 5.0, 10.0], np.zeros(3))
    assert repr(recorded) == "<TrackTruth: 3 positions, 0.0 to 2.5 s>"


def test_a_segment_must_be_one():
    with pytest.raises(TypeError, match=r"of type Segment, got \(10, 0.1\)"):
        Truth([1000.0, 5.0, 0.0, 0.0], [(10, 0.1)])
    for what in (None, Segment(10.0)):
        with pytest.raises(TypeError, match="segments must be a sequence of Segment, got"):
            Truth(START, what)


@pytest.mark.parametrize(
    "truth", [Truth(START, [Segment(10.0)]), TrackTruth([0.0, 1.0], [0.0, 5.0], [0.0, 0.0])]
)
def test_times_are_in_a_row(truth):
    with pytest.raises(ValueError, match=r"time_s must be a number or .* \(T,\), got \(2, 2\)"):
        truth.state_at(np.zeros((2, 2)))


def test_truths_that_are_invalid():
    with pytest.raises(ValueError, match="duration_s"):
        Segment(0.0)
    with pytest.raises(ValueError, match="finite"):
        Segment(1.0, np.nan)
    with pytest.raises(ValueError, match="segment 1"):
        Truth(START, [Segment(10.0), Segment(100.0, 0.0, -0.2)])
    for start in ([0.0, 1.0], [0.0, np.nan, 0.0, 0.0]):
        with pytest.raises(ValueError, match="4 finite numbers"):
            Truth(start)
    for name in ("start_time_s", "start_course_rad"):
        with pytest.raises(ValueError, match=f"{name} must be finite, got nan"):
            Truth(START, **{name: np.nan})


# ------------------------------------------------------------------ radar

RADAR = RadarSimulator(range_std_m=20.0, bearing_std_rad=0.01, period_s=2.5)
FAR = Truth([3000.0, 5.0, 1000.0, 0.0])


def test_the_same_seed_gives_the_same_plots():
    first, again = RADAR.observe(FAR, 30, 7), RADAR.observe(FAR, 30, 7)
    np.testing.assert_array_equal(first[1], again[1])
    assert not np.array_equal(first[1], RADAR.observe(FAR, 30, 8)[1])


def test_plots_have_the_errors_of_the_radar():
    time_s, z = RADAR.observe(FAR, 20_000, 1, own=Truth([10.0, 5.0, 0.0, 0.0]))
    relative = (FAR.state_at(time_s) - Truth([10.0, 5.0, 0.0, 0.0]).state_at(time_s))[:, 0::2]
    error = z - np.column_stack([np.hypot(*relative.T), np.arctan2(*relative.T[::-1])])
    np.testing.assert_allclose(error.mean(axis=0) / [20.0, 0.01], 0.0, atol=0.04)
    np.testing.assert_allclose(error.std(axis=0) / [20.0, 0.01], 1.0, atol=0.03)


def test_targets_are_missed_as_often_as_said():
    radar = RadarSimulator(20.0, 0.01, 2.5, detection_probability=0.7)
    _, z = radar.observe(FAR, 10_000, 3)
    seen = np.isfinite(z)
    assert (seen[:, 0] == seen[:, 1]).all()
    assert seen[:, 0].mean() == pytest.approx(0.7, abs=0.02)


def test_targets_out_of_range_are_not_seen():
    near = RadarSimulator(20.0, 0.01, 2.5, max_range_m=1000.0)
    assert np.isnan(near.observe(FAR, 5, 1)[1]).all()


def test_a_rotating_antenna_points_at_the_target_when_it_sees_it():
    radar = RadarSimulator(0.0, 0.0, 2.5, rotating=True)
    crossing = Truth([200.0, -10.0, -300.0, 12.0])
    time_s, z = radar.observe(crossing, 40, 1)
    state = crossing.state_at(time_s)
    np.testing.assert_allclose(z[:, 1], np.arctan2(state[:, 2], state[:, 0]), atol=1e-9)
    pointing = 2 * np.pi * (time_s - 2.5 * np.arange(40)) / 2.5
    np.testing.assert_allclose(np.exp(1j * pointing), np.exp(1j * z[:, 1]), atol=1e-9)


CROSSING = {
    "clockwise": Truth([1000.0, 0.0, -120.0, 10.0]),
    "anticlockwise": Truth([1000.0, 0.0, 120.0, -10.0]),
    "to and fro": Truth([300.0, 10.0, -30.0, 0.0], [Segment(60.0, 0.3)]),
}
TURNING = RadarSimulator(0.0, 0.0, 2.5, rotating=True)


def looks_at(truth, scans):
    """When an antenna that begins at north at 0 s laps the target, from fine steps."""
    time_s = np.linspace(0.0, 2.5 * scans, 200 * scans + 1)
    north_m, _, east_m, _ = truth.state_at(time_s).T
    laps = time_s / 2.5 - np.unwrap(np.arctan2(east_m, north_m)) / (2 * np.pi)
    return np.interp(np.arange(np.ceil(laps[0]), laps[-1]), laps, time_s)


@pytest.mark.parametrize("way", CROSSING)
def test_every_look_is_recorded_once_and_in_its_turn(way):
    (episode,) = TURNING.record({"a": CROSSING[way]}, 20, 1).episodes
    time_s = np.concatenate([scan.plot_time_s for scan in episode.scans])
    np.testing.assert_allclose(time_s, looks_at(CROSSING[way], 20), atol=1e-4)
    for scan in episode.scans:
        assert ((scan.time_s - 2.5 <= scan.plot_time_s) & (scan.plot_time_s < scan.time_s)).all()


@pytest.mark.parametrize("way", CROSSING)
def test_a_row_is_the_last_look_of_its_turn_and_missed_without_any(way):
    time_s, z = TURNING.observe(CROSSING[way], 20, 1)
    wanted = {int(at // 2.5): at for at in looks_at(CROSSING[way], 20)}
    assert np.flatnonzero(np.isfinite(z[:, 0])).tolist() == sorted(wanted)
    np.testing.assert_allclose(time_s[sorted(wanted)], list(wanted.values()), atol=1e-4)
    assert (np.diff(time_s) > 0).all()


@pytest.mark.parametrize("way", CROSSING)
def test_who_crosses_north_does_not_change_what_else_is_drawn(way):
    radar = RadarSimulator(
        10.0, 0.01, 2.5, 0.9, clutter_per_scan=3.0, max_range_m=200.0, rotating=True
    )
    near = Truth([-50.0, 1.0, 80.0, 0.0])
    one, other = (
        radar.record({"unseen": unseen, "near": near}, 20, 5).episodes[0].scans
        for unseen in (CROSSING[way], FAR)
    )
    for a, b in zip(one, other, strict=True):
        np.testing.assert_array_equal(a.plot_time_s, b.plot_time_s)
        np.testing.assert_array_equal(a.range_m, b.range_m)


@pytest.mark.parametrize("rotating", [False, True])
def test_a_recording_holds_targets_and_clutter_in_order(rotating):
    radar = RadarSimulator(
        10.0, 0.01, 2.5, 0.9, clutter_per_scan=6.0, max_range_m=5000.0, rotating=rotating
    )
    truths = {"a": FAR, "b": Truth([-500.0, 0.0, 800.0, 6.0])}
    made = radar.record(truths, 400, 5, own=Truth([0.0, 4.0, 0.0, 3.0]))
    (episode,) = made.episodes
    assert (np.diff(episode.time_s) > 0).all()
    assert set(episode.truth) == {"a", "b"}
    assert episode.plot_count / 400 == pytest.approx(6.0 + 2 * 0.9, abs=0.4)
    for scan in episode.scans:
        assert (np.diff(scan.plot_time_s) >= 0).all()
        north = scan.own_north_m + scan.range_m * np.cos(scan.bearing_rad)
        np.testing.assert_allclose(scan.north_m, north)
        np.testing.assert_allclose(
            np.column_stack([scan.own_north_m, scan.own_east_m]),
            episode.own.position_at(scan.plot_time_s),
            atol=1e-6,
        )
    truth = episode.truth["a"].state_at(episode.time_s)
    np.testing.assert_allclose(truth, FAR.state_at(episode.time_s))


def test_clutter_is_even_over_the_disc():
    radar = RadarSimulator(10.0, 0.01, 1.0, clutter_per_scan=20.0, max_range_m=1000.0)
    (episode,) = radar.record({}, 500, 9).episodes
    range_m = np.concatenate([scan.range_m for scan in episode.scans])
    assert np.mean(range_m < 500.0) == pytest.approx(0.25, abs=0.02)


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ({"range_std_m": -1.0}, "range_std_m"),
        ({"bearing_std_rad": np.nan}, "bearing_std_rad"),
        ({"period_s": 0.0}, "period_s"),
        ({"period_s": np.inf}, "period_s"),
        ({"clutter_per_scan": -1.0}, "clutter_per_scan"),
        ({"detection_probability": np.nan}, "detection_probability"),
        ({"detection_probability": 1.5}, "detection_probability"),
        ({"clutter_per_scan": 3.0}, "max_range_m"),
        ({"max_range_m": 0.0}, "max_range_m"),
    ],
)
def test_radars_that_are_invalid(arguments, name):
    with pytest.raises(ValueError, match=name):
        RadarSimulator(
            **({"range_std_m": 1.0, "bearing_std_rad": 0.01, "period_s": 1.0} | arguments)
        )


def test_a_recording_of_no_scans_knows_where_own_ship_is():
    radar, own = RadarSimulator(1.0, 0.01, 1.0), Truth(START)
    (episode,) = radar.record({"a": Truth(START)}, 0, 1, own=own, start_time_s=5.0)
    assert len(episode) == 0
    np.testing.assert_array_equal(episode.own.position_at([5.0]), own.state_at([5.0])[:, 0::2])


@pytest.mark.parametrize("scans", [-1, 2.5, None])
def test_scans_are_counted_in_whole_numbers(scans):
    radar, target = RadarSimulator(1.0, 0.01, 1.0), Truth(START)
    for seen in (lambda: radar.observe(target, scans, 1), lambda: radar.record({}, scans, 1)):
        with pytest.raises(ValueError, match="scans must be a whole number, at least 0, got"):
            seen()


WITH_A_NUMBER = {
    "duration_s": Segment,
    "turn_rate_rad_s": lambda value: Segment(1.0, value),
    "start_time_s": lambda value: Truth(START, start_time_s=value),
    "range_std_m": lambda value: RadarSimulator(value, 0.01, 3.0),
    "max_range_m": lambda value: RadarSimulator(60.0, 0.01, 3.0, max_range_m=value),
    "velocity_std_mps": lambda value: Scenario(
        "one", Truth(START), RadarSimulator(60.0, 0.01, 3.0), 5, velocity_std_mps=value
    ),
    "factor": lambda value: metrics.settling_times_s([0.0], [0.0], [], factor=value),
    "share": lambda value: metrics.detection_delays_scans([0.0], [0.0], [], share=value),
    "confidence": lambda value: metrics.share_inside([1.0], 2, 1, confidence=value),
    "current_mps": lambda value: UsvMission(current_mps=value),
}


@pytest.mark.parametrize("name", WITH_A_NUMBER)
@pytest.mark.parametrize("wrong", ["3", {}, np.ones(2), 1j])
def test_what_is_not_a_number_is_rejected_by_name(name, wrong):
    with pytest.raises(TypeError, match=f"^{name} must be a number, got {re.escape(repr(wrong))}"):
        WITH_A_NUMBER[name](wrong)


def test_a_radar_that_is_none_and_a_scan_at_no_time_are_rejected_by_name():
    radar, truth = RadarSimulator(60.0, 0.01, 3.0), Truth(START)
    with pytest.raises(TypeError, match="radar must be a RadarSimulator, got None"):
        Scenario("one", truth, None, 5)
    for start_time_s in (np.nan, np.inf):
        with pytest.raises(ValueError, match=f"start_time_s must be finite, got {start_time_s}"):
            radar.observe(truth, 3, 1, start_time_s=start_time_s)
    with pytest.raises(ValueError, match=r"curve must have shape \(T,\), got \(3, 3\)"):
        metrics.share_inside(np.ones((3, 3)), 4, 10)
