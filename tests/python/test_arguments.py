"""An object rebuilt from its arguments, which `pickle` and `repr` use, is an equal one."""

import copy
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from cases import (
    CONVERTED,
    DT_S,
    ESTIMATORS,
    LINEAR_MOTIONS,
    MOTIONS,
    POSITION,
    RADAR,
    SMALL_NOISE,
    START,
    readings,
    turning_imm,
)

TURN = wl.Ekf(wl.CoordinatedTurn(turn_rate_rad_s=0.03, noise=SMALL_NOISE))
RATES = np.deg2rad([-3.0, -1.0, 0.5, 2.0])
PERIODIC = wl.ModeChain([[0.9, 0.06, 0.04], [0.18, 0.8, 0.02], [0.1, 0.1, 0.8]], period_s=3.0)
SCHEDULES = {
    "ConstantGains": wl.ConstantGains(0.5, 0.2),
    "GrowingMemory": wl.GrowingMemory(plots_before=2, max_plots=7),
    "BenedictBordner": wl.BenedictBordner(0.4),
    "CriticallyDamped": wl.CriticallyDamped(0.7),
    "TrackingIndex": wl.TrackingIndex(0.3),
    "RangeDependent": wl.RangeDependent(beta_range_m=1e4),
    "RecentMemory": wl.RecentMemory(plots_before=2, max_plots=5),
    "AdaptiveGains": wl.filter.AdaptiveGains(window=6),
}
OF_ALL_KINDS = {
    **{name: make() for name, make in ESTIMATORS.items()},
    **{f"Kalman-{name}": wl.Kalman(motion) for name, motion in LINEAR_MOTIONS.items()},
    **{f"AlphaBeta-{name}": wl.AlphaBeta(gains) for name, gains in SCHEDULES.items()},
    "AlphaBeta-noise": wl.AlphaBeta(SCHEDULES["TrackingIndex"], noise=SMALL_NOISE),
    "AlphaBetaGamma": wl.AlphaBetaGamma(wl.GrowingMemory(max_plots=9), prior_accel_std_mps2=0.2),
    "Ukf-points": wl.Ukf(MOTIONS["Singer"], alpha=0.5, beta=1.5, kappa=-1.0),
    "Imm-initial": wl.Imm([TURN, TURN, TURN], PERIODIC, [0.2, 0.5, 0.3]),
    "AdaptiveGridImm": wl.AdaptiveGridImm(TURN),
    "AdaptiveGridImm-other": wl.AdaptiveGridImm(
        wl.Ukf(wl.CoordinatedTurn()),
        max_turn_rate_rad_s=0.1,
        initial_turn_rates_rad_s=[-0.05, 0.01, 0.1],
        centre_gain=1.0,
        least_move_rad_s=0.0,
        chain=PERIODIC,
        initial_mode_probability=[0.3, 0.4, 0.3],
    ),
    "SwitchingGridImm": wl.SwitchingGridImm(TURN),
    "SwitchingGridImm-other": wl.SwitchingGridImm(
        TURN, RATES, threshold=0.7, rule="literal", carry="slot", initial_centre=2
    ),
    "LikelyModelSetImm": wl.LikelyModelSetImm(TURN),
    "LikelyModelSetImm-other": wl.LikelyModelSetImm(
        TURN, RATES, unlikely_threshold=0.01, likely_threshold=0.3, stay_probability=0.8
    ),
    "ModeHistory": wl.ModeHistory(TURN),
    "ModeHistory-habits": wl.ModeHistory(
        wl.SquareRootUkf(wl.CoordinatedTurn()),
        RATES,
        straight_sojourn_s=300.0,
        turn_sojourn_s=41.7,
        straighten_probability=0.6,
        max_hypotheses=20,
        max_branches=40,
        merge_distance=1.0,
        sibling_distance=np.inf,
    ),
    "ModeHistory-chain": wl.ModeHistory(
        TURN,
        RATES[:3],
        chain=PERIODIC,
        initial_mode_probability=[0.1, 0.8, 0.1],
        min_segment_s=3.0,
        switch_time_spread=0.0,
        negligible_probability=1e-5,
    ),
    "ModeHistory-rates": wl.ModeHistory(
        wl.Ekf(wl.CoordinatedTurnRate(prior_turn_rate_std_rad_s=0.01)), RATES
    ),
    "ModeHistory-between": wl.ModeHistory(
        wl.Ekf(wl.CoordinatedTurnRate()),
        RATES,
        grid_std_rad_s=np.linspace(1e-4, 2e-3, len(RATES)),
        grid_weight=np.linspace(0.5, 1.0, len(RATES)),
    ),
    "ModeHistory-one_side": wl.ModeHistory(
        wl.Ekf(wl.CoordinatedTurnRate(prior_turn_rate_std_rad_s=0.01)), [0.0, 0.05]
    ),
    "ModeHistory-pseudo_bayes": wl.ModeHistory.pseudo_bayes(2, TURN, RATES, stay_probability=0.8),
    "ModeHistory-of": wl.ModeHistory.of(
        [
            wl.Ekf(wl.CoordinatedTurnRate(prior_turn_rate_std_rad_s=1e-4)),
            wl.Ekf(wl.CoordinatedTurnRate(noise=SMALL_NOISE, prior_turn_rate_rad_s=0.04)),
        ],
        wl.ModeChain.from_sojourn_s([120.0, 15.0]),
        [0.75, 0.25],
        max_hypotheses=20,
    ),
    "FuzzyAlphaBeta": wl.FuzzyAlphaBeta(max_plots=6, threshold=1.2, t_norm="minimum", hold=False),
    "BayesianAlphaBeta": wl.BayesianAlphaBeta(max_plots=7, parabolas=False, sojourn_s=20.0),
}


def again(thing):
    """The same from a pickle of it, which shows the same arguments."""
    other = pickle.loads(pickle.dumps(thing))
    assert type(other) is type(thing)
    assert repr(other) == repr(thing)
    return other


def assert_same_run(one, other, sensor, runs=2):
    z = np.array([readings(miss=[7], seed=seed) for seed in range(runs)])
    if sensor is POSITION:
        z = np.stack([z[..., 0] * np.cos(z[..., 1]), z[..., 0] * np.sin(z[..., 1])], axis=-1)
    got, wanted = (e.run(z, dt_s=DT_S, sensor=sensor, start=START) for e in (one, other))
    for field in ("mean", "covariance", "nis", "log_likelihood", "status", "mode_probability"):
        np.testing.assert_array_equal(getattr(got, field), getattr(wanted, field), field)


@pytest.mark.parametrize("name", OF_ALL_KINDS)
def test_the_arguments_of_an_estimator_make_one_that_runs_to_the_same_bits(name):
    estimator = OF_ALL_KINDS[name]
    assert_same_run(again(estimator), estimator, CONVERTED if "Kalman" in name else RADAR)


@pytest.mark.parametrize("name", OF_ALL_KINDS)
def test_the_arguments_are_the_parameters_not_the_belief(name):
    estimator = copy.copy(OF_ALL_KINDS[name])
    estimator.start(START)
    for row in readings(12):
        estimator.predict(DT_S)
        estimator.update(CONVERTED, row)
    assert repr(estimator) == repr(OF_ALL_KINDS[name])


# Chains -------------------------------------------------------------------------------------------

sojourns = st.lists(st.floats(1e-2, 1e6), min_size=2, max_size=16)


def assert_same_chain(chain):
    other = again(chain)
    for dt_s in (0.0, 0.3, 3.0, 1e4):
        np.testing.assert_array_equal(other.transition(dt_s), chain.transition(dt_s))
    assert other.continuous == chain.continuous


@given(sojourns)
@settings(max_examples=50)
def test_chains_of_sojourn_times(sojourn_s):
    assert_same_chain(wl.ModeChain.from_sojourn_s(sojourn_s))


@given(st.integers(2, 6), st.integers(0, 1000), st.sampled_from([None, 0.7, 3.0]))
@settings(max_examples=50)
def test_chains_of_matrices(modes, seed, period_s):
    matrix = 0.9 * np.eye(modes) + 0.1 * np.random.default_rng(seed).dirichlet(
        np.ones(modes), modes
    )
    try:
        chain = wl.ModeChain(matrix, period_s)
    except ValueError:
        return  # no chain in continuous time has this matrix
    assert_same_chain(chain)


def test_a_chain_of_one_mode_and_one_that_ends():
    assert_same_chain(wl.ModeChain.from_sojourn_s([60.0]))
    assert_same_chain(wl.ModeChain([[1.0]]))
    assert_same_chain(wl.ModeChain([[1.0, 0.0], [0.1, 0.9]], period_s=2.0))


def test_a_generator_is_that_of_a_chain_in_continuous_time():
    generator = [[-0.5, 0.5], [0.25, -0.25]]
    chain = wl.ModeChain.from_generator(generator)
    same = wl.ModeChain.from_sojourn_s([2.0, 4.0])
    np.testing.assert_array_equal(chain.transition(3.0), same.transition(3.0))
    for bad, message in (
        ([[-0.5, 0.4], [0.25, -0.25]], "sum of a row of the generator must be 0"),
        ([[0.5, -0.5], [0.25, -0.25]], "rate of the generator off its diagonal"),
        ([[np.nan, 0.5], [0.25, -0.25]], "sum of a row of the generator must be 0"),
        ([[-0.5, 0.5]], r"generator_per_s must have shape \(K, K\)"),
        (np.zeros((17, 17)), "K at most 16"),
    ):
        with pytest.raises(ValueError, match=message):
            wl.ModeChain.from_generator(bad)


# Models, sensors and the rest ---------------------------------------------------------------------

positive = st.floats(1e-9, 1e3)
noises = st.one_of(
    st.builds(wl.WhiteAcceleration, psd_m2s3=positive),
    st.builds(wl.PiecewiseAcceleration, std_mps2=positive),
)
motions = st.one_of(
    st.builds(wl.ConstantVelocity, noise=noises),
    st.builds(wl.ConstantAcceleration, noise=noises, prior_accel_std_mps2=positive),
    st.builds(wl.CoordinatedTurn, turn_rate_rad_s=st.floats(-1, 1), noise=noises),
    st.builds(
        wl.CoordinatedTurnRate,
        noise=noises,
        turn_rate_psd_rad2s3=positive,
        prior_turn_rate_std_rad_s=positive,
        course_psd_rad2s=positive,
        max_speed_mps=positive,
        prior_turn_rate_rad_s=st.floats(-1, 1),
        turn_rate_time_s=positive,
    ),
    st.builds(wl.Singer, maneuver_time_s=positive, accel_std_mps2=positive),
    st.builds(
        wl.WanderingCourse,
        psd_m2s3=positive,
        course_psd_rad2s=positive,
        max_speed_mps=positive,
    ),
)


@given(motions)
def test_motions_of_any_parameters(motion):
    x = np.array([10.0, 3.0, 20.0, -4.0, 0.01, 0.3])[: motion.states]
    state = () if hasattr(motion, "matrix") else (x,)
    np.testing.assert_array_equal(
        again(motion).process_noise(*state, 2.5), motion.process_noise(*state, 2.5)
    )
    begun = [wl.Ekf(one) for one in (again(motion), motion)]
    for filter in begun:
        filter.start(START)
    got, wanted = (filter.estimate() for filter in begun)
    np.testing.assert_array_equal(got.mean, wanted.mean)
    np.testing.assert_array_equal(got.covariance, wanted.covariance)


OWN = wl.OwnShip(north_m=10.0, veast_mps=-2.0, heading_std_rad=0.01)


@pytest.mark.parametrize(
    "thing",
    [
        RADAR,
        wl.RangeBearing(range_std_m=7.0, extent_std_m=3.0, bearing_offset_rad=-0.01, own=OWN),
        CONVERTED,
        wl.ConvertedRangeBearing(unbiased=False, own=OWN),
        wl.RangeBearingDoppler(range_rate_std_mps=0.3),
        POSITION,
        OWN,
        START,
        wl.ChiSquareGate(probability=0.9),
        wl.Radar(),
        wl.TrackerConfig(association="nearest"),
        wl.VesselModels.ships(),
        *SCHEDULES.values(),
    ],
    ids=lambda thing: type(thing).__name__,
)
def test_sensors_schedules_and_settings(thing):
    again(thing)


@pytest.mark.parametrize("wrapped", [False, True])
@pytest.mark.parametrize(
    ("name", "settings_of_it"),
    [
        ("ExponentialSmoother", {"alpha": 0.3}),
        ("AdaptiveExponentialSmoother", {}),
        ("ThreePointSmoother", {"weight_before_s": 2.0, "adaptive": True, "parabola": False}),
        ("AlphaBetaSmoother", {"gains": wl.TrackingIndex(0.1), "reading_std": 2.0}),
        ("AlphaBetaSmoother", {"gains": wl.RecentMemory(max_plots=4)}),
        ("AdaptiveAlphaBeta", {}),
        ("AdaptiveAlphaBeta", {"window": 9}),
        ("WindowBank", {"max_readings": 7, "memory": 0.5}),
    ],
)
def test_smoothers(name, settings_of_it, wrapped):
    smoother = getattr(wl.filter, name)(**settings_of_it, wrapped=wrapped)
    other = again(smoother)
    reading = np.cumsum(np.random.default_rng(1).normal(size=20))
    for a, b in zip(other.run(1.5, reading), smoother.run(1.5, reading), strict=True):
        np.testing.assert_array_equal(a, b)
    smoother.update(1.0, 0.5)
    assert repr(smoother) == repr(other)


@pytest.mark.parametrize("states", [5, 7, 8])
@pytest.mark.parametrize("kind", ["ekf", "ukf", "augmented_ukf"])
def test_the_navigator(states, kind):
    navigator = wl.UsvNavigator(
        states, kind, gyro_bias_std_rad_s=0.02, gate_probability=0.95, rejections=3, alpha=0.8
    )
    runs = []
    for one in (again(navigator), navigator):
        one.start([0.0, 0.0], [3.0, 1.0], 0.3)
        time_s = np.arange(20.0)
        gnss = np.column_stack([3.0 * time_s, time_s])
        imu = np.tile([0.01, 0.0, 0.02], (20, 1))
        runs.append(one.run(time_s, imu, gnss))
    np.testing.assert_array_equal(runs[0].mean, runs[1].mean)
    np.testing.assert_array_equal(runs[0].covariance, runs[1].covariance)


@pytest.mark.parametrize(
    "estimator", [None, turning_imm(), wl.ModeHistory(TURN)], ids=["usual", "Imm", "ModeHistory"]
)
def test_the_tracker(estimator):
    tracker = wl.Tracker(
        wl.Radar(range_std_m=30.0),
        wl.TrackerConfig(confirm_hits=2),
        wl.VesselModels.ships(),
        estimator,
    )
    other = again(tracker)
    for k, (range_m, bearing_rad) in enumerate(readings(10)):
        for one in (tracker, other):
            one.process(DT_S * k, range_m=[range_m], bearing_rad=[bearing_rad])
    np.testing.assert_array_equal(other.tracks().mean, tracker.tracks().mean)
    assert len(tracker.tracks()) == 1
    assert repr(tracker) == repr(other)
