"""Estimators whose turn models change: golden numbers, the same bits by either way, edges."""

import json
from pathlib import Path

import numpy as np
import pytest

import wakeline as wl
from cases import CONVERTED, DT_S, MOTIONS, POSITION, RADAR, START, readings, stepwise, turning_imm
from wakeline import montecarlo, scenario
from wakeline.scenario import RadarSimulator, Segment, Truth

GOLDEN = Path(__file__).parents[1] / "golden" / "multiple_models.json"
NOISE = wl.PiecewiseAcceleration(std_mps2=0.02)
GRID_RAD_S = np.deg2rad([-2.0, -1.0, 0.0, 1.0, 2.0])
EKF = wl.Ekf(wl.CoordinatedTurn(noise=NOISE))
BUILD = {
    "adaptive": lambda kind=wl.Ekf: wl.AdaptiveGridImm(kind(wl.CoordinatedTurn(noise=NOISE))),
    "switching": lambda kind=wl.Ekf: wl.SwitchingGridImm(
        kind(wl.CoordinatedTurn(noise=NOISE)), GRID_RAD_S
    ),
    "likely": lambda kind=wl.Ekf: wl.LikelyModelSetImm(
        kind(wl.CoordinatedTurn(noise=NOISE)),
        GRID_RAD_S,
        unlikely_threshold=0.1,
        likely_threshold=0.3,
    ),
}
KINDS = [wl.Kalman, wl.Ekf, wl.Ukf, wl.SquareRootUkf]


# --- golden -----------------------------------------------------------------------------------


def from_case(case, kind):
    """The estimator of a golden case."""
    turn = kind(wl.CoordinatedTurn(noise=wl.PiecewiseAcceleration(std_mps2=case["accel_std_mps2"])))
    reported = case["parameters"]
    initial = reported["initial_mode_probability"]
    if case["estimator"] == "agmm":
        return wl.AdaptiveGridImm(
            turn,
            max_turn_rate_rad_s=np.deg2rad(reported["max_turn_rate_deg_s"]),
            initial_turn_rates_rad_s=np.deg2rad(reported["initial_set_deg_s"]),
            min_spacing_rad_s=np.deg2rad(reported["min_spacing_deg_s"]),
            kept_spacing_rad_s=0.0,
            least_move_rad_s=0.0,
            centre_threshold=reported["t1"],
            centre_gain=1.0,
            unlikely_threshold=reported["t2"],
            likely_threshold=reported["t3"],
            initial_mode_probability=initial,
        )
    return wl.SwitchingGridImm(
        turn,
        np.deg2rad(reported["grid_deg_s"]),
        threshold=reported["t"],
        rule=reported["rule"],
        carry=reported["carry"],
        initial_centre=reported["initial_centre"],
        initial_mode_probability=initial,
    )


def golden_cases():
    cases = json.loads(GOLDEN.read_text())["cases"]
    for number, case in enumerate(cases):
        if case["estimator"] != "imm5":
            yield pytest.param(case, id=f"{case['scenario']}-{case['estimator']}-{number}")


@pytest.mark.parametrize("case", list(golden_cases()))
@pytest.mark.parametrize("kind", [wl.Kalman, wl.Ekf, wl.Ukf])
def test_grids_find_the_numbers_of_an_independent_reference(case, kind):
    sensor = wl.ConvertedRangeBearing(
        range_std_m=60.0, bearing_std_rad=np.deg2rad(0.5), unbiased=False
    )
    start = wl.Gaussian(case["start_mean"], np.diag([100.0, 1.0, 100.0, 1.0]))
    result = from_case(case, kind).run(case["z"], dt_s=case["period_s"], sensor=sensor, start=start)
    tolerance = 1e-6 if kind is wl.Ukf else 1e-9
    np.testing.assert_allclose(result.mean, case["mean"], rtol=tolerance, atol=tolerance)
    for reported, field in (
        (result.mode_probability, "mode_probability"),
        (np.rad2deg(result.turn_rate_rad_s), "turn_rate_deg_s"),
    ):
        np.testing.assert_allclose(reported, case[field], rtol=0, atol=tolerance)


# --- the same by either way -------------------------------------------------------------------


@pytest.mark.parametrize("sensor", [RADAR, CONVERTED, POSITION], ids=["polar", "converted", "fix"])
@pytest.mark.parametrize("build", [turning_imm, *BUILD.values()], ids=["imm", *BUILD])
@pytest.mark.parametrize("kind", KINDS)
def test_a_run_is_its_single_steps_bit_for_bit(build, kind, sensor):
    """A run of turns is composed anew at compile time where it can be; single steps never are."""
    if kind is wl.Kalman and sensor is RADAR:
        return
    z = readings(60, miss=(7, 8, 30))
    if sensor is POSITION:
        z = np.stack([z[:, 0] * np.cos(z[:, 1]), z[:, 0] * np.sin(z[:, 1])], axis=-1)
    result = build(kind).run(z, dt_s=DT_S, sensor=sensor, start=START)
    mean, covariance, innovation, nis, log_likelihood = stepwise(build(kind), z, sensor=sensor)
    np.testing.assert_array_equal(result.mean, mean)
    np.testing.assert_array_equal(result.covariance, covariance)
    np.testing.assert_array_equal(result.innovation, innovation)
    np.testing.assert_array_equal(result.nis, nis)
    np.testing.assert_array_equal(result.log_likelihood, log_likelihood)


@pytest.mark.parametrize("build", BUILD.values(), ids=BUILD)
@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_runs_do_not_know_of_each_other(build, kind):
    z = np.stack([readings(40, seed) for seed in range(3)])
    used = build(kind)
    stepwise(used, z[2])
    arguments = {"dt_s": DT_S, "sensor": RADAR, "start": START}
    together = used.run(z, **arguments)
    backwards = build(kind).run(z[::-1], **arguments)
    np.testing.assert_array_equal(together.mean, backwards.mean[::-1])
    np.testing.assert_array_equal(together.turn_rate_rad_s, backwards.turn_rate_rad_s[::-1])
    for k in range(3):  # alone not in lanes, which differ in rounding
        alone = build(kind).run(z[k], **arguments)
        np.testing.assert_allclose(together.mean[k], alone.mean, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(
            together.turn_rate_rad_s[k], alone.turn_rate_rad_s, rtol=1e-9, atol=1e-12
        )


@pytest.mark.parametrize("build", BUILD.values(), ids=BUILD)
def test_results_report_the_turn_rates_of_the_models(build):
    estimator = build()
    z = readings(80)
    result = estimator.run(z, dt_s=DT_S, sensor=RADAR, start=START)
    assert result.turn_rate_rad_s.shape == result.mode_probability.shape
    assert result.turn_rate_rad_s.shape == (80, estimator.models)
    rates, probability = result.turn_rate_rad_s, result.mode_probability
    np.testing.assert_allclose(probability.sum(axis=-1), 1.0, atol=1e-12)
    np.testing.assert_array_equal(probability[np.isnan(rates)], 0.0)
    mean_rate = np.nansum(rates * probability, axis=-1)
    assert abs(mean_rate[20:40].mean()) < np.deg2rad(0.5)
    assert mean_rate[60:].mean() == pytest.approx(0.02, abs=np.deg2rad(0.6))
    stepwise(estimator, z)
    np.testing.assert_array_equal(estimator.turn_rates_rad_s(), rates[-1])


def test_an_imm_has_no_turn_rates_that_change():
    result = turning_imm().run(readings(3), dt_s=DT_S, sensor=RADAR, start=START)
    assert result.turn_rate_rad_s is None


def test_unlikely_models_rest():
    result = BUILD["likely"]().run(readings(80), dt_s=DT_S, sensor=RADAR, start=START)
    assert np.isnan(result.turn_rate_rad_s).any(axis=0).sum() >= 2
    active = (~np.isnan(result.turn_rate_rad_s)).sum(axis=-1)
    assert active.min() >= 2
    assert active[0] == 5


def test_without_thresholds_no_model_rests():
    grid = wl.LikelyModelSetImm(EKF, GRID_RAD_S, unlikely_threshold=0.0, likely_threshold=0.0)
    chain = np.full((5, 5), 0.1 / 4) + (0.9 - 0.1 / 4) * np.eye(5)
    filters = [wl.Ekf(wl.CoordinatedTurn(turn_rate_rad_s=w, noise=NOISE)) for w in GRID_RAD_S]
    imm = wl.Imm(filters, wl.ModeChain(chain), [0.025, 0.025, 0.9, 0.025, 0.025])
    arguments = {"dt_s": DT_S, "sensor": RADAR, "start": START}
    there, here = grid.run(readings(60), **arguments), imm.run(readings(60), **arguments)
    np.testing.assert_allclose(there.mean, here.mean, rtol=1e-12, atol=1e-11)


# --- defaults ---------------------------------------------------------------------------------


def test_the_usual_adaptive_grid_is_nearly_as_good_as_five_models_and_never_lost():
    noise = wl.PiecewiseAcceleration(std_mps2=0.003)

    def turn(rate_deg_s):
        motion = wl.CoordinatedTurn(turn_rate_rad_s=np.deg2rad(rate_deg_s), noise=noise)
        return wl.Ekf(motion)

    chain = wl.ModeChain(np.full((5, 5), 0.1 / 4) + (0.9 - 0.1 / 4) * np.eye(5))
    adaptive = montecarlo.Candidate(wl.AdaptiveGridImm(turn(0.0)))
    printed = montecarlo.Candidate(
        wl.AdaptiveGridImm(
            turn(0.0),
            centre_threshold=0.3,
            centre_gain=1.0,
            kept_spacing_rad_s=0.0,
            least_move_rad_s=0.0,
        )
    )
    for name, widest in (("example1", 2.0), ("example2", 4.0)):
        rates = np.linspace(-widest, widest, 5)
        five = wl.Imm([turn(rate) for rate in rates], chain, [0.025, 0.025, 0.9, 0.025, 0.025])
        result = montecarlo.run(
            scenario.named(name),
            {"five": montecarlo.Candidate(five), "adaptive": adaptive, "printed": printed},
            60,
            seed=41,
            progress=False,
        )
        mean_m = {k: result[name, k].summary()["mean_position_m"] for k in result.candidates}
        assert mean_m["adaptive"] < 1.17 * mean_m["five"]
        assert mean_m["adaptive"] < 0.8 * mean_m["printed"]
    wild = scenario.random_maneuvers(8, seed=5)
    result = montecarlo.run(wild, {"adaptive": adaptive}, 10, seed=5, progress=False)
    assert all(result[s.name, "adaptive"].summary()["lost_runs"] == 0 for s in wild)


# --- a known acceleration ---------------------------------------------------------------------


@pytest.mark.parametrize("build", [turning_imm, *BUILD.values()], ids=["imm", *BUILD])
def test_a_known_acceleration_is_no_surprise(build):
    push = np.zeros((40, 2))
    push[15:30] = [0.3, -0.4]
    truth = [np.array([4000.0, 6.0, 3000.0, -8.0])]
    for u in push:
        x = truth[-1] + DT_S * truth[-1][[1, 1, 3, 3]] * [1, 0, 1, 0]
        truth.append(x + np.array([4.5 * u[0], 3 * u[0], 4.5 * u[1], 3 * u[1]]))
    truth = np.array(truth[1:])
    z = np.stack([np.hypot(truth[:, 0], truth[:, 2]), np.arctan2(truth[:, 2], truth[:, 0])], -1)
    arguments = {"dt_s": DT_S, "sensor": RADAR, "start": START}
    reported = build().run(z, **arguments, acceleration_mps2=push)
    untold = build().run(z, **arguments)
    assert np.abs(reported.mean - truth).max() < 10.0
    assert np.abs(untold.mean - truth).max() > 20.0


def test_a_known_acceleration_has_one_row_for_each_scan():
    with pytest.raises(ValueError, match=r"acceleration_mps2 must have shape \(5, 2\)"):
        BUILD["adaptive"]().run(
            readings(5), dt_s=DT_S, sensor=RADAR, start=START, acceleration_mps2=np.zeros((4, 2))
        )


# --- before a start ---------------------------------------------------------------------------


@pytest.mark.parametrize("build", BUILD.values(), ids=BUILD)
def test_before_a_start_the_modes_are_those_that_it_begins_with(build):
    estimator = build()
    before = estimator.mode_probability()
    assert before[len(before) // 2] == pytest.approx(0.9)
    estimator.start(START)
    np.testing.assert_array_equal(estimator.mode_probability(), before)


@pytest.mark.parametrize("build", [wl.AdaptiveGridImm, wl.SwitchingGridImm])
def test_before_a_start_the_modes_are_those_reported(build):
    estimator = build(EKF, initial_mode_probability=[0.2, 0.3, 0.5])
    np.testing.assert_array_equal(estimator.mode_probability(), [0.2, 0.3, 0.5])


# --- models at rest ---------------------------------------------------------------------------


def test_a_model_at_rest_keeps_the_belief_that_it_went_to_rest_with():
    estimator = BUILD["likely"]()
    estimator.start(START)
    known = [estimator.filter_estimate(k) for k in range(5)]
    rested = 0
    for z in readings(80):
        estimator.predict(DT_S)
        resting = np.isnan(estimator.turn_rates_rad_s())
        estimator.update(RADAR, z)
        now = [estimator.filter_estimate(k) for k in range(5)]
        for k in np.flatnonzero(resting):
            np.testing.assert_array_equal(now[k].mean, known[k].mean)
            np.testing.assert_array_equal(now[k].covariance, known[k].covariance)
            rested += 1
        known = now
    assert rested > 80


# --- in a tracker -----------------------------------------------------------------------------

TRACKER_RADAR = wl.Radar(
    range_std_m=10.0, bearing_std_rad=np.deg2rad(0.5), period_s=2.5, max_speed_mps=25.0
)


def recorded():
    simulator = RadarSimulator(
        10.0, np.deg2rad(0.5), 2.5, detection_probability=0.95, max_range_m=6000.0
    )
    turn = [Segment(50.0), Segment(60.0, 0.03), Segment(60.0)]
    (episode,) = simulator.record({"vessel": Truth([2000.0, 6.0, 500.0, 5.0], turn)}, 60, 3)
    return episode.scans


@pytest.mark.filterwarnings("ignore:the ModeChain has no period")
@pytest.mark.parametrize("build", BUILD.values(), ids=BUILD)
def test_a_tracker_keeps_its_tracks_with_any_estimator(build):
    tracker = wl.Tracker(TRACKER_RADAR, estimator=build())
    scans = recorded()
    for k, scan in enumerate(scans):
        if k == 30:
            again = wl.Tracker(TRACKER_RADAR, estimator=build())
            again.restore(tracker.save())
        for one in (tracker,) if k < 30 else (tracker, again):
            one.process(scan.time_s, range_m=scan.range_m, bearing_rad=scan.bearing_rad)
    table, other = tracker.tracks(), again.tracks()
    assert table.status == ["confirmed"]
    assert table.mode_probability.shape == (1, build().models)
    np.testing.assert_array_equal(table.mean, other.mean)
    np.testing.assert_array_equal(table.mode_probability, other.mode_probability)


def test_a_tracker_names_the_estimators_it_takes():
    with pytest.raises(TypeError, match=r"estimator must be .* got Ekf"):
        wl.Tracker(TRACKER_RADAR, estimator=EKF)


# --- rejected input ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("build", "options", "message"),
    [
        (wl.AdaptiveGridImm, {"max_turn_rate_rad_s": 0.0}, "max_turn_rate_rad_s"),
        (
            wl.AdaptiveGridImm,
            {"initial_turn_rates_rad_s": [-0.2, 0.0, 0.2], "max_turn_rate_rad_s": 0.1},
            "within max_turn_rate_rad_s, 0.1 to either side, got -0.2",
        ),
        (wl.AdaptiveGridImm, {"initial_turn_rates_rad_s": [0.01, 0.0, 0.02]}, "not less than"),
        (wl.AdaptiveGridImm, {"initial_turn_rates_rad_s": [0.0, 0.01]}, r"shape \(3,\)"),
        (wl.AdaptiveGridImm, {"min_spacing_rad_s": -1.0}, "min_spacing_rad_s"),
        (wl.AdaptiveGridImm, {"kept_spacing_rad_s": np.nan}, "kept_spacing_rad_s"),
        (wl.AdaptiveGridImm, {"least_move_rad_s": -1.0}, "least_move_rad_s"),
        (wl.AdaptiveGridImm, {"centre_gain": 1.5}, "centre_gain"),
        (
            wl.AdaptiveGridImm,
            {"unlikely_threshold": 0.7, "likely_threshold": 0.3},
            "at most likely_threshold",
        ),
        (wl.AdaptiveGridImm, {"initial_mode_probability": [0.5, 0.6, 0.5]}, "sum to 1"),
        (wl.AdaptiveGridImm, {"chain": wl.ModeChain([[1.0]])}, "chain must have 3 modes, .*got 1"),
        (wl.LikelyModelSetImm, {"chain": wl.ModeChain([[1.0]])}, "chain must have 5 modes"),
        (wl.SwitchingGridImm, {"grid_rad_s": [0.0, 0.02, 0.01]}, "greater than the one before"),
        (wl.SwitchingGridImm, {"grid_rad_s": [0.0]}, "3 to 16 turn rates, got 1"),
        (wl.SwitchingGridImm, {"grid_rad_s": [0.0, 0.02]}, "3 to 16 turn rates, got 2"),
        (wl.SwitchingGridImm, {"grid_rad_s": np.linspace(-1, 1, 40)}, "3 to 16 turn rates, got 40"),
        (wl.SwitchingGridImm, {"grid_rad_s": [0.0, np.nan, 0.1]}, "finite"),
        (wl.SwitchingGridImm, {"threshold": 1.2}, "threshold"),
        (wl.SwitchingGridImm, {"rule": "other"}, "rule must be 'symmetric' or 'literal'"),
        (wl.SwitchingGridImm, {"carry": "other"}, "carry must be 'slot' or 'identity'"),
        (wl.SwitchingGridImm, {"initial_centre": 9}, "initial_centre"),
        (wl.LikelyModelSetImm, {"grid_rad_s": [0.0]}, "2 to 16 turn rates, got 1"),
        (wl.LikelyModelSetImm, {"grid_rad_s": [0.1, 0.0]}, "greater than the one before"),
        (
            wl.LikelyModelSetImm,
            {"unlikely_threshold": 0.5, "likely_threshold": 0.2},
            "at most likely_threshold",
        ),
        (wl.LikelyModelSetImm, {"stay_probability": -0.1}, "probability"),
    ],
)
def test_parameters_that_are_invalid_are_rejected_by_name(build, options, message):
    with pytest.raises(ValueError, match=message):
        build(EKF, **options)


@pytest.mark.parametrize("build", [wl.AdaptiveGridImm, wl.SwitchingGridImm, wl.LikelyModelSetImm])
def test_a_filter_without_a_known_turn_rate_is_rejected(build):
    with pytest.raises(ValueError, match="filter must be one over CoordinatedTurn"):
        build(wl.Ekf(MOTIONS["ConstantVelocity"]))


@pytest.mark.parametrize("build", BUILD.values(), ids=BUILD)
def test_a_reading_that_is_not_a_number_changes_nothing(build):
    estimator = build()
    estimator.start(START)
    for z in readings(20):
        estimator.predict(DT_S)
        estimator.update(RADAR, z)
    before = estimator.estimate().mean, estimator.mode_probability(), estimator.turn_rates_rad_s()
    with pytest.raises(wl.FilterError):
        estimator.update(RADAR, [np.nan, 0.1])
    with pytest.raises(wl.FilterError):
        estimator.predict(np.nan)
    after = estimator.estimate().mean, estimator.mode_probability(), estimator.turn_rates_rad_s()
    for one, other in zip(before, after, strict=True):
        np.testing.assert_array_equal(one, other)
