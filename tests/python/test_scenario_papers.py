"""Scenarios as studies take them: the papers' numbers, seeded readings, random maneuvers."""

import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl
from wakeline import scenario
from wakeline.scenario import RadarSimulator, Scenario, Segment, Truth, papers

RADAR = RadarSimulator(30.0, 0.01, 2.0)
STRAIGHT = Truth([2000.0, 5.0, 1000.0, -3.0])


@pytest.mark.parametrize(
    ("name", "scans", "position_m", "speed_kn", "switches_s", "rates_deg_s"),
    [
        ("imm-scans", 250, 1000.0, (10, 6), [240, 420, 600], [0, 1, -1, 0]),
        ("imm-seconds", 250, 1000.0, (10, 6), [80, 140, 200], [0, 1, -1, 0]),
        (
            "example1",
            250,
            1000.0,
            (15, 10),
            [90, 180, 240, 330, 360, 540, 600],
            [0, -2, 0, 2, 0, -1, 0, 1],
        ),
        (
            "example2",
            130,
            0.0,
            (20, 12),
            [45, 120, 135, 180, 210, 255, 360],
            [0, 2, 0, -4, 0, 4, -2, 0],
        ),
    ],
)
def test_the_papers_scenarios(name, scans, position_m, speed_kn, switches_s, rates_deg_s):
    paper = scenario.named(name)
    assert (paper.name, paper.scans, paper.time_s[0]) == (name, scans, 3.0)
    assert len(paper.time_s) == scans
    assert paper.time_s[-1] == pytest.approx(paper.truth.end_time_s)
    north_m, vnorth_mps, east_m, veast_mps = paper.start.mean
    assert (north_m, east_m) == (position_m, position_m)
    np.testing.assert_allclose(
        [vnorth_mps, veast_mps], np.array(speed_kn) * 1852 / 3600, rtol=1e-12
    )
    np.testing.assert_allclose(paper.start.covariance, np.diag([100.0, 1.0, 100.0, 1.0]))
    np.testing.assert_allclose(paper.switch_times_s, switches_s)
    assert (paper.radar.range_std_m, paper.radar.period_s) == (60.0, 3.0)
    assert paper.radar.bearing_std_rad == pytest.approx(np.deg2rad(0.5))
    rates = np.rad2deg(paper.turn_rates_rad_s)
    change = np.flatnonzero(np.abs(np.diff(rates)) > 1e-9)
    np.testing.assert_allclose(rates[[0, *(change + 1)]], rates_deg_s, atol=1e-9)


def test_readings_in_scans_switch_after_the_scan_of_the_table():
    rates = np.rad2deg(papers.imm().turn_rates_rad_s)
    np.testing.assert_allclose(rates[[79, 80, 139, 140, 199, 200]], [0, 1, 1, -1, -1, 0], atol=1e-9)


def test_names_that_are_not_there():
    assert scenario.names() == ["imm-scans", "imm-seconds", "example1", "example2"]
    with pytest.raises(ValueError, match=r"imm-scans.*'example3'"):
        scenario.named("example3")
    with pytest.raises(ValueError, match="reading must be"):
        papers.imm("minutes")


def test_the_speed_stays_in_the_papers_turns():
    states = papers.example2().truth_states
    np.testing.assert_allclose(np.hypot(states[:, 1], states[:, 3]), np.hypot(20, 12) * 1852 / 3600)


# ------------------------------------------------------------------ readings


@given(st.integers(0, 2**40), st.integers(1, 6), st.integers(0, 4))
def test_a_run_has_the_same_readings_in_any_company(seed, runs, first):
    case = Scenario("company", STRAIGHT, RADAR, 5)
    together = case.draw(first + runs, seed)
    np.testing.assert_array_equal(together[first:], case.draw(runs, seed, first_run=first))


def test_runs_seeds_and_names_differ():
    case = Scenario("a", STRAIGHT, RADAR, 5)
    z = case.draw(3, 1)
    assert len(np.unique(z)) == z.size
    assert not (z == case.draw(3, 2)).any()
    assert not (z == Scenario("b", STRAIGHT, RADAR, 5).draw(3, 1)).any()


def test_errors_are_those_of_the_radar():
    case = Scenario("errors", STRAIGHT, RADAR, 20)
    error = case.draw(2000, 0) - Scenario(
        "exact", STRAIGHT, RadarSimulator(0.0, 0.0, 2.0), 20
    ).draw(1, 0)
    np.testing.assert_allclose(error.mean(axis=(0, 1)) / [30.0, 0.01], 0.0, atol=0.03)
    np.testing.assert_allclose(error.std(axis=(0, 1)) / [30.0, 0.01], 1.0, atol=0.02)
    flat = error.reshape(-1, 2)
    assert abs(np.corrcoef(flat.T)[0, 1]) < 0.02
    assert abs(np.corrcoef(error[:, 0, 0], error[:, 1, 0])[0, 1]) < 0.1


def test_readings_are_raw_near_the_antenna():
    near = Scenario("near", Truth([1.0, 0.0, 0.0, 0.0]), RADAR, 50)
    assert (near.draw(4, 0)[..., 0] < 0).any()


def test_missed_and_distant_targets_leave_rows_of_nan():
    seldom = RadarSimulator(30.0, 0.01, 2.0, detection_probability=0.7)
    z = Scenario("seldom", STRAIGHT, seldom, 400).draw(10, 0)
    missed = np.isnan(z)
    assert (missed[..., 0] == missed[..., 1]).all()
    assert missed[..., 0].mean() == pytest.approx(0.3, abs=0.03)
    leaving = Truth([900.0, 10.0, 0.0, 0.0])
    near = RadarSimulator(1.0, 0.01, 2.0, max_range_m=1000.0)
    seen = np.isfinite(Scenario("leaving", leaving, near, 10).draw(1, 0)[0, :, 0])
    np.testing.assert_array_equal(seen, [True] * 5 + [False] * 5)


def test_a_scenario_may_start_at_any_time():
    truth = Truth([0.0, 10.0, 500.0, 0.0], [Segment(50.0), Segment(50.0, 0.1)], start_time_s=1000.0)
    late = Scenario("late", truth, RADAR, 30, start_time_s=1030.0)
    assert late.time_s[0] == 1032.0
    np.testing.assert_allclose(late.start.mean, [300.0, 10.0, 500.0, 0.0])
    np.testing.assert_allclose(late.switch_times_s, [1050.0])
    np.testing.assert_allclose(late.turn_rates_rad_s[[9, 10]], [0.0, 0.1])


def test_a_scenario_starts_with_its_truth():
    truth = Truth([0.0, 10.0, 500.0, 0.0], [Segment(50.0)], start_time_s=1000.0)
    assert Scenario("with it", truth, RADAR, 30).time_s[0] == 1000.0 + RADAR.period_s
    early = Scenario("early", truth, RADAR, 30, start_time_s=0.0)
    assert early.time_s[0] == RADAR.period_s
    assert Scenario("untold", SilentTruth(), RADAR, 30).start_time_s == 0.0


class SilentTruth:
    """A vessel at rest without a start time."""

    def state_at(self, time_s):
        return np.zeros((np.size(time_s), 4))

    def turn_rate_at(self, time_s):
        return np.zeros(np.size(time_s))


def test_a_truth_that_begins_after_the_scenario_may_switch_at_its_beginning():
    segments = [Segment(9.0, 0.1, control_mps2=(0.2, 0.0)), Segment(9.0, 0.1)]
    truth = Truth([0.0, 10.0, 500.0, 0.0], segments, start_time_s=11.0)
    early, with_it = (Scenario("at", truth, RADAR, 30, start_time_s=t) for t in (0.0, 11.0))
    np.testing.assert_allclose(early.switch_times_s, [11.0, 29.0])
    np.testing.assert_allclose(early.control_switch_times_s, [11.0, 20.0])
    np.testing.assert_allclose(with_it.switch_times_s, [29.0])
    np.testing.assert_allclose(with_it.control_switch_times_s, [20.0])


def test_starts_err_as_the_prior_says_and_have_nothing_in_common_with_the_readings():
    case = Scenario("starts", STRAIGHT, RADAR, 1, position_std_m=20.0, velocity_std_mps=2.0)
    starts = case.draw_starts(4000, 3)
    errors = np.array([start.mean for start in starts]) - case.start.mean
    np.testing.assert_allclose(errors.mean(axis=0) / [20, 2, 20, 2], 0.0, atol=0.06)
    np.testing.assert_allclose(errors.std(axis=0) / [20, 2, 20, 2], 1.0, atol=0.05)
    np.testing.assert_array_equal(starts[7].covariance, case.start.covariance)
    both = np.column_stack([errors, case.draw(4000, 3)[:, 0]])
    assert np.abs(np.corrcoef(both.T) - np.eye(6)).max() < 0.07


def test_a_run_starts_alike_however_many_there_are():
    case = papers.example1()
    some = [start.mean for start in case.draw_starts(5, 9)]
    alone = [case.draw_starts(1, 9, first_run=k)[0].mean for k in range(5)]
    np.testing.assert_array_equal(some, alone)
    assert not np.array_equal(some, [start.mean for start in case.draw_starts(5, 10)])


def test_sensors_have_the_errors_of_the_radar():
    case = Scenario("sensors", STRAIGHT, RADAR, 5)
    assert isinstance(case.polar_sensor, wl.RangeBearing)
    assert (case.polar_sensor.range_std_m, case.polar_sensor.bearing_std_rad) == (30.0, 0.01)
    assert isinstance(case.converted_sensor, wl.ConvertedRangeBearing)
    np.testing.assert_allclose(  # not unbiased: the plain conversion
        case.converted_sensor.observe([1000.0, 0.5]).mean,
        1000.0 * np.array([np.cos(0.5), np.sin(0.5)]),
    )


def test_scenarios_can_be_sent_to_another_process():
    example = pickle.loads(pickle.dumps(papers.example1()))
    np.testing.assert_array_equal(example.draw(1, 3), papers.example1().draw(1, 3))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"name": ""}, "name must be"),
        ({"scans": 0}, "scans must be a whole number"),
        ({"scans": 2.5}, "scans must be a whole number"),
        ({"position_std_m": 0.0}, "position_std_m must be finite and positive"),
        ({"velocity_std_mps": np.nan}, "velocity_std_mps must be finite and positive"),
        ({"start_time_s": np.inf}, "start_time_s must be finite"),
        ({"radar": RadarSimulator(1.0, 0.1, 1.0, rotating=True)}, "must not rotate"),
        (
            {"radar": RadarSimulator(1.0, 0.1, 1.0, clutter_per_scan=2.0, max_range_m=1e3)},
            "nor have clutter",
        ),
    ],
)
def test_scenarios_that_are_invalid(change, message):
    right = {"name": "x", "truth": STRAIGHT, "radar": RADAR, "scans": 3}
    with pytest.raises(ValueError, match=message):
        Scenario(**(right | change))
    with pytest.raises(TypeError, match="truth must have state_at"):
        Scenario(**(right | {"truth": None}))


def test_draws_that_are_invalid():
    case = Scenario("x", STRAIGHT, RADAR, 3)
    assert case.draw(0).shape == (0, 3, 2)
    with pytest.raises(ValueError, match="runs must be a whole number, at least 0, got -1"):
        case.draw(-1)
    with pytest.raises(ValueError, match=r"runs must be a whole number, at least 0, got 1\.5"):
        case.draw(1.5)
    with pytest.raises(ValueError, match="first_run must be a whole number, at least 0, got -2"):
        case.draw(1, first_run=-2)
    for seed in (-1, 1.5, None, "x", [1, -1], [1.5]):
        with pytest.raises(ValueError, match="seed must be a whole number, at least 0, got"):
            case.draw(1, seed)


# ------------------------------------------------------------------ random maneuvers


def test_random_maneuvers_are_as_described():
    cases = scenario.random_maneuvers(40, seed=2)
    assert len({case.name for case in cases}) == 40
    rates = np.concatenate([[s.turn_rate_rad_s for s in c.truth.segments] for c in cases])
    assert {s.turn_rate_rad_s for c in cases for s in c.truth.segments[::2]} == {0.0}
    turns = np.rad2deg(rates[rates != 0])
    assert np.abs(turns).min() >= 0.7
    assert np.abs(turns).max() <= 4.0
    assert 0.4 < np.mean(turns > 0) < 0.6
    for case in cases:
        assert case.scans == 250
        assert case.truth.end_time_s == pytest.approx(750.0)
        durations_s = [s.duration_s for s in case.truth.segments[:-1]]
        assert all(15.0 <= d <= 120.0 for d in durations_s)
        assert 5.0 <= np.hypot(*case.start.mean[1::2]) <= 15.0
        assert 500.0 <= np.hypot(*case.start.mean[0::2]) <= 3000.0
        off_scan = case.switch_times_s / 3.0 % 1.0
        assert (off_scan > 1e-6).all()


def test_random_maneuvers_depend_on_the_seed_alone():
    few, many = scenario.random_maneuvers(2, seed=5), scenario.random_maneuvers(4, seed=5)
    for a, b in zip(few, many, strict=False):
        np.testing.assert_array_equal(a.truth_states, b.truth_states)
    other = scenario.random_maneuvers(1, seed=6)[0]
    assert not np.array_equal(other.truth_states, few[0].truth_states)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"count": 0}, "count must be a whole number, at least 1, got 0"),
        ({"count": 2.0}, "count must be a whole number"),
        ({"seed": -1}, "seed must be a whole number, at least 0, got -1"),
        ({"turn_rate_deg_s": 2}, "turn_rate_deg_s must be .*got 2"),
        ({"speed_mps": (5.0, 6.0, 7.0)}, r"speed_mps must be .*got \(5.0, 6.0, 7.0\)"),
        ({"turn_rate_deg_s": (-1.0, 4.0)}, "turn_rate_deg_s must be"),
        ({"range_m": (0.0, np.inf)}, "range_m must be"),
        ({"speed_mps": (5.0, 4.0)}, "speed_mps must be"),
        ({"duration_s": (0.0, 4.0)}, "duration_s must be positive"),
        ({"total_s": 1.0}, "total_s"),
    ],
)
def test_random_maneuvers_that_are_invalid(arguments, message):
    with pytest.raises(ValueError, match=message):
        scenario.random_maneuvers(**arguments)
