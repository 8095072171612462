"""Trees of mode histories: what they are laws of is in the tests of C++; here what Python adds."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from cases import CONVERTED, DT_S, MOTIONS, RADAR, SMALL_NOISE, START, readings
from wakeline import montecarlo, scenario

RATES = np.deg2rad([-3.0, -1.5, 0.0, 1.5, 3.0])
TURN = wl.CoordinatedTurn(noise=SMALL_NOISE)


def tree(kind=wl.Ekf, **options):
    return wl.ModeHistory(kind(TURN), RATES, **options)


@pytest.mark.parametrize("kind", [wl.Kalman, wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_run_is_the_steps_one_by_one(kind):
    sensor = CONVERTED if kind is wl.Kalman else RADAR
    z = readings(12, seed=3)
    z[5] = np.nan
    dt_s = np.linspace(2.0, 4.0, len(z))
    result = tree(kind).run(z, dt_s=dt_s, sensor=sensor, start=START)
    one = tree(kind)
    one.start(START)
    for k, reading in enumerate(z):
        one.predict(dt_s[k])
        if not np.isnan(reading).any():
            step = one.update(sensor, reading)
            assert result.log_likelihood[k] == step.log_likelihood
        np.testing.assert_array_equal(result.mean[k], one.estimate().mean)
        np.testing.assert_array_equal(result.covariance[k], one.estimate().covariance)
        np.testing.assert_array_equal(result.mode_probability[k], one.mode_probability())
    assert one.models == len(RATES)
    assert one.started
    assert result.status[5] == int(wl.Status.missed)


@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_runs_side_by_side_know_nothing_of_each_other(kind):
    z = np.stack([readings(20, seed) for seed in range(3)])
    together = tree(kind).run(z, dt_s=DT_S, sensor=RADAR, start=START)
    others = tree(kind).run(z[::-1].copy(), dt_s=DT_S, sensor=RADAR, start=START)
    for run, alone in enumerate(z):
        np.testing.assert_array_equal(together.mean[run], others.mean[2 - run])
        # A run alone takes one hypothesis after the other, many take some in lanes.
        expected = tree(kind).run(alone, dt_s=DT_S, sensor=RADAR, start=START)
        np.testing.assert_allclose(together.mean[run], expected.mean, rtol=1e-11)
        np.testing.assert_allclose(
            together.mode_probability[run], expected.mode_probability, rtol=0, atol=1e-11
        )


LEARNT_STD_RAD_S = np.deg2rad(0.5)
LEARNT = wl.CoordinatedTurnRate(
    noise=SMALL_NOISE, turn_rate_psd_rad2s3=0.0, prior_turn_rate_std_rad_s=LEARNT_STD_RAD_S
)


@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_a_tree_that_learns_its_rates_runs_as_it_steps(kind):
    z = readings(12, seed=4)
    one, result = (wl.ModeHistory(kind(LEARNT), RATES) for _ in range(2))
    result = result.run(z, dt_s=DT_S, sensor=RADAR, start=START)
    one.start(START)
    for k, reading in enumerate(z):
        one.predict(DT_S)
        one.update(RADAR, reading)
        np.testing.assert_array_equal(result.mean[k], one.estimate().mean)
        np.testing.assert_array_equal(result.mode_probability[k], one.mode_probability())
    assert result.mean.shape == (12, 5)


@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_a_tree_that_learns_its_rates_in_lanes_is_the_same(kind):
    z = np.stack([readings(20, seed) for seed in range(3)])
    learning = wl.ModeHistory(kind(LEARNT), RATES)
    together = learning.run(z, dt_s=DT_S, sensor=RADAR, start=START)
    for run, alone in enumerate(z):
        expected = learning.run(alone, dt_s=DT_S, sensor=RADAR, start=START)
        np.testing.assert_allclose(together.mean[run], expected.mean, rtol=1e-9, atol=1e-9)


def test_a_start_may_know_the_rate():
    rate_rad_s = np.deg2rad(0.7)
    known = wl.Gaussian(
        [*START.mean, rate_rad_s], np.pad(START.covariance, (0, 1)) + np.diag([0, 0, 0, 0, 1e-8])
    )
    one = wl.ModeHistory(wl.Ekf(LEARNT), RATES)
    one.start(known)
    np.testing.assert_allclose(one.estimate().mean[4], rate_rad_s, rtol=1e-12)
    one.start(START)
    np.testing.assert_allclose(one.estimate().mean[4], 0.0, atol=1e-15)


@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_deviations_and_weights_that_are_those_left_out_change_nothing(kind):
    z = np.stack([readings(15, seed) for seed in range(2)])
    std_rad_s = np.full(len(RATES), LEARNT_STD_RAD_S)
    std_rad_s[2] *= 0.1  # that of the straight
    reported = wl.ModeHistory(
        kind(LEARNT), RATES, grid_std_rad_s=std_rad_s, grid_weight=np.full(len(RATES), 0.5)
    )
    left_out = wl.ModeHistory(kind(LEARNT), RATES)
    for readings_of in (z, z[0]):
        results = [
            one.run(readings_of, dt_s=DT_S, sensor=RADAR, start=START)
            for one in (reported, left_out)
        ]
        np.testing.assert_array_equal(results[0].mean, results[1].mean)


@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_each_rate_of_a_tree_in_lanes_has_its_own_deviation(kind):
    z = np.stack([readings(20, seed) for seed in range(3)])
    between = wl.ModeHistory(
        kind(LEARNT),
        RATES,
        grid_std_rad_s=np.deg2rad([0.01, 0.5, 0.01, 0.5, 0.01]),
        grid_weight=[1.0, 0.3, 1.0, 0.3, 1.0],
    )
    together = between.run(z, dt_s=DT_S, sensor=RADAR, start=START)
    for run, alone in enumerate(z):
        expected = between.run(alone, dt_s=DT_S, sensor=RADAR, start=START)
        np.testing.assert_allclose(together.mean[run], expected.mean, rtol=1e-9, atol=1e-9)


def kinds_of_way(kind=wl.Ekf):
    """Filters that differ in their noise: two straights, and turns either way that are learnt."""
    none, some = np.deg2rad([0.01, 0.5])
    return [
        kind(
            wl.CoordinatedTurnRate(
                noise=wl.WhiteAcceleration(psd_m2s3=psd),
                turn_rate_psd_rad2s3=0.0,
                prior_turn_rate_rad_s=rate,
                prior_turn_rate_std_rad_s=std,
            )
        )
        for psd, rate, std in (
            (1e-4, 0.0, none),
            (0.05, 0.0, none),
            (0.01, -0.03, some),
            (0.01, 0.03, some),
        )
    ]


WAYS = wl.ModeChain.from_sojourn_s([200.0, 100.0, 20.0, 20.0])


@pytest.mark.parametrize("kind", [wl.Kalman, wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_a_tree_of_the_filters_of_a_grid_is_that_over_the_grid(kind):
    sensor = CONVERTED if kind is wl.Kalman else RADAR
    z = readings(20, seed=5)
    chain, initial = wl.ModeChain.from_sojourn_s([60.0] * 5), np.full(5, 0.2)
    filters = [kind(wl.CoordinatedTurn(turn_rate_rad_s=rate, noise=SMALL_NOISE)) for rate in RATES]
    grid = tree(kind, chain=chain, initial_mode_probability=initial)
    for of in (
        wl.ModeHistory.of(filters, chain),
        wl.ModeHistory.of(filters, chain, initial_mode_probability=initial),
    ):
        expected, found = (one.run(z, dt_s=DT_S, sensor=sensor, start=START) for one in (grid, of))
        np.testing.assert_array_equal(found.mean, expected.mean)
        np.testing.assert_array_equal(found.mode_probability, expected.mode_probability)
        np.testing.assert_array_equal(of.turn_rates_rad_s(), RATES)


def test_a_tree_of_one_mode_is_its_filter():
    z = readings(20, seed=6)
    (filter,) = kinds_of_way()[2:3]
    expected = filter.run(z, dt_s=DT_S, sensor=RADAR, start=START)
    found = wl.ModeHistory.of([filter], wl.ModeChain([[1.0]])).run(
        z, dt_s=DT_S, sensor=RADAR, start=START
    )
    np.testing.assert_allclose(found.mean, expected.mean, rtol=1e-12)
    np.testing.assert_allclose(found.covariance, expected.covariance, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(found.log_likelihood, expected.log_likelihood, rtol=1e-12)


@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_a_tree_of_other_noises_in_lanes_is_the_same(kind):
    z = np.stack([readings(20, seed) for seed in range(3)])
    ways = wl.ModeHistory.of(kinds_of_way(kind), WAYS)
    together = ways.run(z, dt_s=DT_S, sensor=RADAR, start=START)
    for run, alone in enumerate(z):
        expected = ways.run(alone, dt_s=DT_S, sensor=RADAR, start=START)
        np.testing.assert_allclose(together.mean[run], expected.mean, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(
            together.mode_probability[run], expected.mode_probability, rtol=0, atol=1e-9
        )


def test_a_vessel_that_goes_straight_is_taken_for_the_quieter_of_two_straights():
    scene = scenario.Scenario(
        "straight",
        scenario.Truth([4000.0, 6.0, 3000.0, -8.0], [scenario.Segment(600.0)]),
        scenario.RadarSimulator(30.0, np.deg2rad(0.5), period_s=DT_S),
        scans=200,
    )
    z = scene.draw(20, 0)
    found = wl.ModeHistory.of(kinds_of_way(), WAYS).run(z, dt_s=DT_S, sensor=RADAR, start=START)
    quiet, restless, *turns = found.mode_probability[:, -1].mean(axis=0)
    assert quiet > 0.5
    assert quiet > 2.0 * restless
    assert max(turns) < 0.1


def test_rates_that_are_learnt_between_known_ones_are_nearly_the_best_of_both():
    known_deg_s, between_deg_s = np.arange(-4.0, 5.0), np.array([-3.5, -2.5, -1.5, 1.5, 2.5, 3.5])
    rates_deg_s = np.sort(np.concatenate([known_deg_s, between_deg_s]))
    learnt = np.isin(rates_deg_s, between_deg_s)
    filter = wl.Ekf(
        wl.CoordinatedTurnRate(
            noise=wl.PiecewiseAcceleration(std_mps2=0.003),
            turn_rate_psd_rad2s3=0.0,
            prior_turn_rate_std_rad_s=np.deg2rad(0.2),
        )
    )
    trees = {
        "known": wl.ModeHistory(study_filter()),
        "learnt": wl.ModeHistory(filter),
        "both": wl.ModeHistory(
            filter,
            np.deg2rad(rates_deg_s),
            grid_std_rad_s=np.deg2rad(np.where(learnt, 0.2, 0.005)),
            grid_weight=np.where(learnt, 0.3, 1.0),
        ),
    }
    on_the_grid = paired("example1", trees, runs=60)
    assert on_the_grid["both"] < 1.04 * on_the_grid["known"]
    assert on_the_grid["both"] < 0.96 * on_the_grid["learnt"]
    candidates = {name: montecarlo.Candidate(tree) for name, tree in trees.items()}
    off_the_grid = montecarlo.run(scenario.random_maneuvers(8, 3), candidates, 8, 7)
    mean_m = {
        name: np.mean(
            [off_the_grid[one, name].summary()["mean_position_m"] for one in off_the_grid.scenarios]
        )
        for name in trees
    }
    assert mean_m["both"] < 0.97 * mean_m["known"]
    assert mean_m["both"] < 1.04 * mean_m["learnt"]


def test_a_filter_without_turn_rate_is_rejected():
    with pytest.raises(ValueError, match=r"over CoordinatedTurn, .*CoordinatedTurnRate"):
        wl.ModeHistory(wl.Ekf(wl.ConstantVelocity()), RATES)


@settings(max_examples=20, deadline=None)
@given(st.integers(5, 40), st.integers(0, 60), st.floats(0.0, 30.0), st.floats(0.0, 4.0), st.data())
def test_any_tree_is_a_belief(kept, switches, min_segment_s, merge_distance, data):
    z = readings(25, data.draw(st.integers(0, 1000)))
    z[data.draw(st.lists(st.integers(0, 24), max_size=8))] = np.nan
    one = tree(
        max_hypotheses=kept,
        max_branches=kept + 1 + switches,
        min_segment_s=min_segment_s,
        merge_distance=merge_distance,
        sibling_distance=2.0 * merge_distance,
    )
    result = one.run(z, dt_s=DT_S, sensor=RADAR, start=START)
    assert np.isfinite(result.mean).all()
    assert np.linalg.eigvalsh(result.covariance).min() > 0.0
    np.testing.assert_allclose(result.mode_probability.sum(axis=-1), 1.0, atol=1e-12)


def test_it_reports_its_turn_rates_and_a_study_needs_no_others():
    np.testing.assert_array_equal(tree().turn_rates_rad_s(), RATES)
    default = wl.ModeHistory(wl.Ekf(TURN)).turn_rates_rad_s()
    np.testing.assert_allclose(np.rad2deg(default), np.arange(-4.0, 5.0), atol=1e-12)
    example = scenario.named("example1")
    reported = montecarlo.Candidate(tree(), turn_rates_rad_s=RATES)
    figures = [
        montecarlo.run(example, {"tree": one}, runs=2, progress=False).summary()["example1"]["tree"]
        for one in (reported, montecarlo.Candidate(tree()), montecarlo.Candidate(lambda _: tree()))
    ]
    assert figures[0]["right_mode_share"] is not None
    for found in figures[1:]:
        assert found["right_mode_share"] == figures[0]["right_mode_share"]
        assert found["detection_delay_scans"] == figures[0]["detection_delay_scans"]


def test_it_finds_the_turn_rate():
    truth = scenario.Truth(
        [2000.0, 8.0, 1000.0, 0.0], [scenario.Segment(60.0), scenario.Segment(60.0, np.deg2rad(3))]
    )
    _, z = scenario.RadarSimulator(10.0, 0.002, DT_S).observe(truth, 40, 5, start_time_s=DT_S)
    start = wl.Gaussian([2000.0, 8.0, 1000.0, 0.0], np.diag([100.0, 1.0, 100.0, 1.0]))
    sharp = wl.RangeBearing(range_std_m=10.0, bearing_std_rad=0.002)
    result = wl.ModeHistory(
        wl.Ekf(wl.CoordinatedTurn(noise=wl.PiecewiseAcceleration(std_mps2=0.01))), RATES
    ).run(z, dt_s=DT_S, sensor=sharp, start=start)
    assert result.mode_probability[15, 2] > 0.7
    assert result.mode_probability[35, 4] > 0.9


def test_a_known_acceleration_moves_the_prediction():
    still, pushed = tree(), tree()
    for one in (still, pushed):
        one.start(START)
    u = np.array([0.2, -0.1])
    still.predict(DT_S)
    pushed.predict(DT_S, u)
    shift = np.array([DT_S**2 / 2 * u[0], DT_S * u[0], DT_S**2 / 2 * u[1], DT_S * u[1]])
    np.testing.assert_allclose(pushed.estimate().mean, still.estimate().mean + shift, atol=1e-9)


def paired(name, estimators, runs=40):
    """Mean position error of each estimator over the same readings."""
    result = montecarlo.run(
        scenario.named(name), {k: montecarlo.Candidate(v) for k, v in estimators.items()}, runs, 7
    )
    return {k: result[name, k].summary()["mean_position_m"] for k in estimators}


def study_filter(rate_deg_s=0.0):
    return wl.Ekf(
        wl.CoordinatedTurn(
            turn_rate_rad_s=np.deg2rad(rate_deg_s), noise=wl.PiecewiseAcceleration(std_mps2=0.003)
        )
    )


@pytest.mark.parametrize(
    ("name", "rates"), [("example1", (-2, -1, 0, 1, 2)), ("example2", (-4, -2, 0, 2, 4))]
)
def test_histories_kept_apart_are_nearer_than_mixed_ones(name, rates):
    chain = wl.ModeChain(np.full((5, 5), 0.025) + 0.875 * np.eye(5))
    errors = paired(
        name,
        {
            "tree": wl.ModeHistory(study_filter()),
            "imm": wl.Imm([study_filter(rate) for rate in rates], chain),
        },
    )
    assert errors["tree"] < 0.9 * errors["imm"]


def a_vessel_of_its_habits(rng, total_s):
    """One that steers as a tree believes by default that vessels do."""
    rates, straight, mode, segments = np.deg2rad(np.arange(-4.0, 5.0)), 4, 4, []
    turns = [k for k in range(9) if k != straight]
    if rng.random() < 0.1:
        mode = rng.choice(turns)
    least_s = 0.0  # of the first, which had begun before
    while sum(segment.duration_s for segment in segments) < total_s:
        duration_s = least_s + rng.exponential(40.0 if mode == straight else 70.0)
        segments.append(scenario.Segment(duration_s, rates[mode]))
        least_s = 12.0
        if mode != straight and rng.random() < 0.85:
            mode = straight
        else:
            mode = rng.choice([k for k in turns if k != mode])
    return segments


def test_of_vessels_that_steer_by_its_habits_it_is_as_sure_as_it_may_be():
    # NEES is 4 in the mean of the prior, whatever its tails, where nothing is cut or approximated.
    rng = np.random.default_rng(5)
    runs, scans = 300, 60
    spread = np.diag([100.0, 1.0, 100.0, 1.0])
    origin = np.array([3000.0, 7.7, 3000.0, 5.1])
    starts = origin + rng.standard_normal((runs, 4)) * np.sqrt(np.diag(spread))
    time_s = 3.0 * np.arange(1, scans + 1)
    truth = np.stack(
        [
            scenario.Truth(start, a_vessel_of_its_habits(rng, time_s[-1])).state_at(time_s)
            for start in starts
        ]
    )
    radar = wl.RangeBearing(range_std_m=60.0, bearing_std_rad=np.deg2rad(0.5))
    north_m, east_m = truth[..., 0], truth[..., 2]
    z = np.stack([np.hypot(north_m, east_m), np.arctan2(east_m, north_m)], axis=-1)
    z += rng.standard_normal(z.shape) * [radar.range_std_m, radar.bearing_std_rad]
    filter = wl.Ekf(wl.CoordinatedTurn(noise=wl.PiecewiseAcceleration(std_mps2=0.003)))
    tree = wl.ModeHistory(filter, switch_time_spread=1.0, max_hypotheses=180, max_branches=256)
    result = tree.run(z, dt_s=3.0, sensor=radar, start=wl.Gaussian(origin, spread))
    error = truth - result.mean
    nees = np.einsum("rti,rtij,rtj->rt", error, np.linalg.inv(result.covariance), error)
    assert 3.7 < nees.mean() < 4.3


def test_pseudo_bayes_of_second_order_is_as_good_as_an_imm_and_of_first_order_is_not():
    rates = np.deg2rad([-2.0, -1.0, 0.0, 1.0, 2.0])
    chain = wl.ModeChain(np.full((5, 5), 0.025) + 0.875 * np.eye(5))
    errors = paired(
        "example1",
        {
            "gpb1": wl.ModeHistory.pseudo_bayes(1, study_filter(), rates, chain=chain),
            "gpb2": wl.ModeHistory.pseudo_bayes(2, study_filter(), rates, chain=chain),
            "imm": wl.Imm([study_filter(rate) for rate in (-2, -1, 0, 1, 2)], chain),
        },
    )
    assert errors["gpb2"] == pytest.approx(errors["imm"], rel=0.05)
    assert errors["gpb1"] > 1.1 * errors["imm"]


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: wl.ModeHistory(wl.Ekf(MOTIONS["ConstantVelocity"])), "CoordinatedTurn"),
        (lambda: wl.ModeHistory(wl.Ekf(TURN), [0.0]), "2 to 16 turn rates, got 1"),
        (
            lambda: wl.ModeHistory(wl.Ekf(TURN), np.linspace(-1, 1, 40)),
            "2 to 16 turn rates, got 40",
        ),
        (lambda: wl.ModeHistory(wl.Ekf(TURN), [0.1, 0.0]), "greater than the one before"),
        (lambda: wl.ModeHistory(wl.Ekf(TURN), [0.0, np.nan]), "finite"),
        (lambda: tree(max_hypotheses=4), "max_hypotheses must be at least the number of modes"),
        (lambda: tree(max_branches=300), "max_branches must be at most the capacity of 256"),
        (
            lambda: tree(max_hypotheses=90, max_branches=80),
            "max_branches must be more than max_hypotheses",
        ),
        (lambda: tree(min_segment_s=-1.0), "min_segment_s"),
        (lambda: tree(merge_distance=-1.0), "merge_distance"),
        (lambda: tree(sibling_distance=0.1), "sibling_distance must be merge_distance or more"),
        (lambda: tree(switch_time_spread=100.0), "switch_time_spread must be 0 to 1, got 100"),
        (lambda: tree(negligible_probability=1.0), "negligible_probability"),
        (lambda: tree(straighten_probability=2.0), "straighten_probability"),
        (lambda: tree(straight_sojourn_s=0.0), "sojourn"),
        (lambda: tree(initial_mode_probability=np.ones(5)), "initial_mode_probability"),
        (lambda: tree(chain=wl.ModeChain(np.eye(3))), "modes"),
        (lambda: tree(grid_weight=[1.0, 2.0]), "grid_weight must have one number for each of .* 5"),
        (
            lambda: tree(grid_weight=[1.0, 1.0, 1.0, 0.0, 1.0]),
            "of a turn in grid_weight must be finite and positive, got 0",
        ),
        (lambda: tree(grid_std_rad_s=np.ones(5)), "grid_std_rad_s is for .*CoordinatedTurnRate"),
        (
            lambda: wl.ModeHistory(wl.Ekf(LEARNT), RATES, grid_std_rad_s=np.ones(4)),
            "grid_std_rad_s must have one number for each of the 5 turn rates .* got 4",
        ),
        (
            lambda: wl.ModeHistory(wl.Ekf(LEARNT), RATES, grid_std_rad_s=[1, 1, 0, 1, 1]),
            "deviation of grid_std_rad_s must be finite and positive, got 0",
        ),
        (lambda: wl.ModeHistory.of([], WAYS), "filters must be 1 to 16 filters, got 0"),
        (lambda: wl.ModeHistory.of([wl.Ekf(TURN)] * 17, WAYS), "1 to 16 filters, got 17"),
        (
            lambda: wl.ModeHistory.of([wl.Ekf(TURN), wl.Ukf(TURN)], WAYS),
            "filters must be of one kind .* filter 1 differs",
        ),
        (
            lambda: wl.ModeHistory.of([wl.Ekf(TURN), wl.Kalman(TURN)], WAYS),
            "filters must be of one kind .* filter 1 differs",
        ),
        (
            lambda: wl.ModeHistory.of([wl.Ekf(TURN), wl.Ekf(LEARNT)], WAYS),
            "filters must be of one kind over one motion model",
        ),
        (
            lambda: wl.ModeHistory.of([wl.Kalman(MOTIONS["ConstantVelocity"])], WAYS),
            "filters must be over CoordinatedTurn or CoordinatedTurnRate",
        ),
        (lambda: wl.ModeHistory.of(kinds_of_way()[:3], WAYS), "got 4 modes and 3 filters"),
        (
            lambda: wl.ModeHistory.of(kinds_of_way(), WAYS, max_hypotheses=3),
            "max_hypotheses must be at least the number of modes",
        ),
        (
            lambda: wl.ModeHistory.of(kinds_of_way(), WAYS, [0.5, 0.5]),
            "initial_mode_probability",
        ),
        (lambda: wl.ModeHistory.pseudo_bayes(0, wl.Ekf(TURN), RATES), "1 to 8"),
        (lambda: wl.ModeHistory.pseudo_bayes(4, wl.Ekf(TURN), RATES), "more than 256 filters"),
    ],
)
def test_what_is_invalid_is_rejected_in_words(build, words):
    with pytest.raises(ValueError, match=words):
        build()


def test_a_kalman_filter_takes_linear_sensors_only():
    one = tree(wl.Kalman)
    one.start(START)
    one.predict(DT_S)
    with pytest.raises(ValueError, match="linear"):
        one.update(RADAR, readings(1)[0])


def test_a_reading_that_is_not_a_number_changes_nothing():
    one = tree()
    one.start(START)
    one.predict(DT_S)
    before = one.estimate().mean
    with pytest.raises(wl.FilterError, match="finite"):
        one.update(RADAR, [np.nan, 1.0])
    np.testing.assert_array_equal(one.estimate().mean, before)
