"""Estimators with several models: the chain, missed scans, golden numbers and consistency."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import wakeline as wl
from cases import (
    CONVERTED,
    DT_S,
    MOTIONS,
    RADAR,
    START,
    START_MEAN,
    mixed_imm,
    readings,
    turning_imm,
)

GOLDEN = Path(__file__).parents[1] / "golden" / "multiple_models.json"
MODES = st.integers(1, 6)


@st.composite
def chains(draw):
    """A row-stochastic matrix that mostly stays."""
    modes = draw(MODES)
    weights = draw(hnp.arrays(float, (modes, modes), elements=st.floats(0.0, 1.0)))
    matrix = weights + 3.0 * modes * np.eye(modes)
    return matrix / matrix.sum(axis=1, keepdims=True)


# --- ModeChain --------------------------------------------------------------------------------


@given(chains())
def test_a_matrix_is_applied_once_whatever_the_time(matrix):
    chain = wl.ModeChain(matrix)
    assert chain.modes == len(matrix)
    assert not chain.continuous
    for dt_s in (0.1, 60.0):
        np.testing.assert_array_equal(chain.transition(dt_s), matrix)
    for wrong in (-0.1, np.nan):
        with pytest.raises(ValueError, match="dt_s must be"):
            chain.transition(wrong)


@given(
    hnp.arrays(float, MODES, elements=st.floats(1.0, 1e4)), st.floats(0.0, 1e3), st.floats(0, 1e3)
)
def test_a_chain_in_time_has_rows_of_one_and_adds_its_times(sojourn_s, first_s, second_s):
    chain = wl.ModeChain.from_sojourn_s(sojourn_s)
    assert chain.continuous
    both = chain.transition(first_s + second_s)
    np.testing.assert_allclose(both.sum(axis=1), 1.0, atol=1e-12)
    assert both.min() >= 0.0
    np.testing.assert_allclose(
        chain.transition(first_s) @ chain.transition(second_s), both, atol=1e-9
    )


@given(st.floats(1.0, 1e3), st.floats(1e-3, 1e-2))
def test_the_mean_sojourn_is_the_time_until_it_leaves(sojourn_s, part):
    stay = wl.ModeChain.from_sojourn_s([sojourn_s, 50.0]).transition(part * sojourn_s)[0, 0]
    assert stay == pytest.approx(1.0 - part, abs=part)
    assert stay < 1.0


@given(chains(), st.floats(0.5, 30.0))
def test_a_matrix_with_a_period_stands_for_that_time(matrix, period_s):
    try:
        chain = wl.ModeChain(matrix, period_s=period_s)
    except ValueError as error:  # not every matrix is that of a chain in continuous time
        assert "continuous" in str(error) or "period" in str(error)  # noqa: PT017
        return
    np.testing.assert_allclose(chain.transition(period_s), matrix, atol=1e-6)


@pytest.mark.parametrize(
    "matrix",
    [
        [[0.9, 0.2], [0.1, 0.9]],
        [[0.9, 0.0999], [0.1, 0.9]],
        [[1.1, -0.1], [0.1, 0.9]],
        [[np.nan, 0.1], [0.1, 0.9]],
        [[0.7, 0.2], [0.3, 0.8]],  # columns sum to 1: given the wrong way round
    ],
)
def test_rows_that_are_no_distribution_are_rejected(matrix):
    with pytest.raises(ValueError, match=r"mode chain must (sum to 1|be a probability)"):
        wl.ModeChain(matrix)


@given(hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=20))
def test_a_chain_of_wrong_shape_names_wanted_and_given(shape):
    if len(shape) == 2 and shape[0] == shape[1] and 1 <= shape[0] <= 16:
        return
    with pytest.raises(ValueError, match=r"matrix must have shape \(K, K\)") as error:
        wl.ModeChain(np.ones(shape))
    assert f"got {shape}" in str(error.value)


def test_forty_modes_are_too_many():
    with pytest.raises(ValueError, match=r"K at most 16, got \(40, 40\)"):
        wl.ModeChain(np.eye(40))
    with pytest.raises(ValueError, match="sojourn_s must have 1 to 16 times, got 40"):
        wl.ModeChain.from_sojourn_s(np.full(40, 60.0))


@pytest.mark.parametrize("times", [[0.0, 1.0], [-1.0, 1.0], [np.nan], [np.inf, 1.0], []])
def test_sojourn_times_that_are_invalid_are_rejected(times):
    with pytest.raises(ValueError, match="sojourn"):
        wl.ModeChain.from_sojourn_s(times)


# --- laws of the Imm --------------------------------------------------------------------------


@pytest.mark.parametrize("kind", [wl.Kalman, wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_one_mode_is_its_filter(kind):
    motion = MOTIONS["CoordinatedTurn"]
    arguments = {"dt_s": DT_S, "sensor": CONVERTED, "start": START}
    one = wl.Imm([kind(motion)], wl.ModeChain([[1.0]])).run(readings(), **arguments)
    alone = kind(motion).run(readings(), **arguments)
    for field in ("mean", "covariance", "nis", "log_likelihood"):
        np.testing.assert_allclose(getattr(one, field), getattr(alone, field), rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(one.mode_probability, 1.0)


@pytest.mark.parametrize("build", [turning_imm, mixed_imm])
def test_probabilities_are_a_distribution_and_the_estimate_is_their_mean(build):
    imm = build()
    imm.start(START)
    for z in readings():
        imm.predict(DT_S)
        imm.update(RADAR, z)
        probability = imm.mode_probability()
        assert probability.min() >= 0.0
        assert probability.sum() == pytest.approx(1.0, abs=1e-12)
        beliefs = [imm.filter_estimate(k) for k in range(imm.models)]
        rows = [{4: [0, 1, 2, 3], 5: [0, 1, 2, 3], 6: [0, 1, 3, 4]}[len(b.mean)] for b in beliefs]
        means = np.array([b.mean[r] for b, r in zip(beliefs, rows, strict=True)])
        mean = probability @ means
        covariance = sum(
            p * (b.covariance[np.ix_(r, r)] + np.outer(m - mean, m - mean))
            for p, b, r, m in zip(probability, beliefs, rows, means, strict=True)
        )
        np.testing.assert_allclose(imm.estimate().mean, mean, rtol=1e-9)
        np.testing.assert_allclose(imm.estimate().covariance, covariance, rtol=1e-7, atol=1e-7)


def test_the_order_of_the_modes_is_a_name_only():
    z = readings()
    there = turning_imm(rates_deg_s=(0.0, 1.0, -1.0)).run(z, dt_s=DT_S, sensor=RADAR, start=START)
    back = turning_imm(rates_deg_s=(-1.0, 1.0, 0.0)).run(z, dt_s=DT_S, sensor=RADAR, start=START)
    np.testing.assert_allclose(back.mean, there.mean, rtol=1e-9)
    np.testing.assert_allclose(back.mode_probability[:, ::-1], there.mode_probability, atol=1e-9)


def test_the_turn_finds_its_mode():
    result = turning_imm().run(readings(60), dt_s=DT_S, sensor=RADAR, start=START)
    straight, starboard, port = result.mode_probability.T
    assert straight[10:28].mean() > starboard[10:28].mean()
    assert starboard[40:].mean() > 0.5
    assert port[40:].mean() < 0.1


# --- missed scans -----------------------------------------------------------------------------


def test_missed_scans_relax_the_modes_along_the_chain():
    """FilterPy trap: there every missed scan raises the mode of least noise, 0.961 -> 0.974."""
    imm = turning_imm(rates_deg_s=(0.0, 2.0), stay=0.95)
    z = readings(40, miss=range(30, 40))
    result = imm.run(z, dt_s=DT_S, sensor=RADAR, start=START)
    chain = np.array([[0.95, 0.05], [0.05, 0.95]])
    wanted = result.mode_probability[29]
    for scan in range(30, 40):
        wanted = wanted @ chain
        assert wl.Status(result.status[scan]) == wl.Status.missed
        np.testing.assert_allclose(result.mode_probability[scan], wanted, rtol=1e-12)
    from_half = np.abs(result.mode_probability[29:, 0] - 0.5)
    np.testing.assert_allclose(from_half[1:], 0.9 * from_half[:-1], rtol=1e-9)


def test_a_chain_in_time_relaxes_with_time():
    chain = wl.ModeChain.from_sojourn_s([60.0, 20.0])
    filters = [wl.Ekf(MOTIONS["ConstantVelocity"]), wl.Ekf(MOTIONS["CoordinatedTurn"])]
    imm = wl.Imm(filters, chain, initial_mode_probability=[0.1, 0.9])
    z = np.full((3, 2), np.nan)
    steps = np.array([1.0, 30.0, 3600.0])
    result = imm.run(z, dt_s=steps, sensor=RADAR, start=START)
    wanted = np.array([0.1, 0.9])
    for row, dt_s in zip(result.mode_probability, steps, strict=True):
        wanted = wanted @ chain.transition(dt_s)
        np.testing.assert_allclose(row, wanted, atol=1e-12)
    np.testing.assert_allclose(result.mode_probability[-1], [0.75, 0.25], atol=1e-9)


# --- traps ------------------------------------------------------------------------------------


def test_the_trap_of_the_mixing_matrix_for_the_transition():
    """Two equal models: .695/.305 by the chain, .664/.336 with the mixing matrix in its place."""
    chain = np.array([[0.9, 0.1], [0.4, 0.6]])
    equal = [wl.Ekf(MOTIONS["ConstantVelocity"])] * 2
    imm = wl.Imm(equal, wl.ModeChain(chain), initial_mode_probability=[0.59, 0.41])
    result = imm.run(readings(8), dt_s=DT_S, sensor=RADAR, start=START)
    wanted = np.array([0.59, 0.41])
    for row in result.mode_probability:
        wanted = wanted @ chain
        np.testing.assert_allclose(row, wanted, atol=1e-9)
    np.testing.assert_allclose(result.mode_probability[0], [0.695, 0.305], atol=1e-12)


def test_the_trap_of_the_transposed_chain():
    """A mode that is never entered stays empty; entered by columns it would fill."""
    chain = wl.ModeChain([[1.0, 0.0], [0.2, 0.8]])
    equal = [wl.Ekf(MOTIONS["ConstantVelocity"])] * 2
    imm = wl.Imm(equal, chain, initial_mode_probability=[1.0, 0.0])
    result = imm.run(readings(), dt_s=DT_S, sensor=RADAR, start=START)
    np.testing.assert_array_equal(result.mode_probability[:, 0], 1.0)


def test_the_trap_of_likelihoods_that_underflow():
    """FilterPy trap: a far outlier has no effect on the modes when likelihoods are clamped."""
    noises = [wl.WhiteAcceleration(psd_m2s3=psd) for psd in (1e-4, 10.0)]
    filters = [wl.Ekf(wl.ConstantVelocity(noise=noise)) for noise in noises]
    imm = wl.Imm(filters, wl.ModeChain([[0.95, 0.05], [0.05, 0.95]]))
    imm.start(START)
    for z in readings(10):
        imm.predict(DT_S)
        imm.update(RADAR, z)
    imm.predict(DT_S)
    step = imm.update(RADAR, [40_000.0, 0.64])
    assert step.log_likelihood < np.log(np.finfo(float).tiny)
    assert np.isfinite(imm.mode_probability()).all()
    assert imm.mode_probability()[1] > 0.999  # the mode that is less surprised


def test_two_estimators_share_nothing():
    """A cache of the transition in a `static` would be shared by both."""
    z, arguments = readings(), {"dt_s": DT_S, "sensor": RADAR, "start": START}
    alone = turning_imm(stay=0.9).run(z, **arguments)
    turning_imm(stay=0.6).run(z, **arguments)
    again = turning_imm(stay=0.9).run(z, **arguments)
    np.testing.assert_array_equal(alone.mean, again.mean)


# --- golden -----------------------------------------------------------------------------------


def golden_cases():
    cases = json.loads(GOLDEN.read_text())["cases"]
    return [
        pytest.param(case, id=case["scenario"]) for case in cases if case["estimator"] == "imm5"
    ]


@pytest.mark.parametrize("case", golden_cases())
@pytest.mark.parametrize("kind", [wl.Kalman, wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_five_models_find_the_numbers_of_an_independent_reference(case, kind):
    parameters = case["parameters"]
    noise = wl.PiecewiseAcceleration(std_mps2=case["accel_std_mps2"])
    filters = [
        kind(wl.CoordinatedTurn(turn_rate_rad_s=np.deg2rad(rate), noise=noise))
        for rate in parameters["turn_rates_deg_s"]
    ]
    chain = np.full((5, 5), 0.1 / 4)
    np.fill_diagonal(chain, 0.9)
    imm = wl.Imm(filters, wl.ModeChain(chain), parameters["initial_mode_probability"])
    sensor = wl.ConvertedRangeBearing(
        range_std_m=parameters.get("range_std_m", 60.0),
        bearing_std_rad=np.deg2rad(0.5),
        unbiased=False,
    )
    start = wl.Gaussian(case["start_mean"], np.diag([100.0, 1.0, 100.0, 1.0]))
    result = imm.run(case["z"], dt_s=case["period_s"], sensor=sensor, start=start)
    assert (result.status == int(wl.Status.ok)).all()
    tolerance = 1e-9 if kind in (wl.Kalman, wl.Ekf) else 1e-7
    np.testing.assert_allclose(result.mean, case["mean"], rtol=tolerance, atol=tolerance)
    np.testing.assert_allclose(
        result.mode_probability, case["mode_probability"], rtol=0, atol=tolerance
    )


# --- consistency ------------------------------------------------------------------------------


def test_an_imm_of_the_true_chain_and_models_reports_the_truth_about_its_errors():
    rng = np.random.default_rng(17)
    runs, scans = 400, 40
    rates = np.deg2rad([0.0, 1.5, -1.5])
    noise = wl.PiecewiseAcceleration(std_mps2=0.1)
    motions = [wl.CoordinatedTurn(turn_rate_rad_s=rate, noise=noise) for rate in rates]
    chain = np.full((3, 3), 0.025) + 0.925 * np.eye(3)
    matrices = np.array([motion.matrix(DT_S) for motion in motions])
    q = motions[0].process_noise(DT_S)

    mode = rng.integers(0, 3, runs)
    x = rng.multivariate_normal(START_MEAN, START.covariance, runs)
    truth = np.empty((runs, scans, 4))
    for scan in range(scans):
        mode = (rng.random((runs, 1)) > chain.cumsum(axis=1)[mode]).sum(axis=1)
        driven = rng.multivariate_normal(np.zeros(4), q, runs)
        x = np.einsum("rij,rj->ri", matrices[mode], x) + driven
        truth[:, scan] = x
    bearing_rad = np.arctan2(truth[..., 2], truth[..., 0])
    z = np.stack([np.hypot(truth[..., 0], truth[..., 2]), bearing_rad], axis=-1)
    z += rng.standard_normal(z.shape) * [RADAR.range_std_m, RADAR.bearing_std_rad]

    imm = wl.Imm([wl.Ekf(motion) for motion in motions], wl.ModeChain(chain))
    result = imm.run(z, dt_s=DT_S, sensor=RADAR, start=START)
    error = truth - result.mean
    nees = np.einsum("rti,rtij,rtj->rt", error, np.linalg.inv(result.covariance), error)
    # A mixture has heavier tails than a Gaussian: its average must fit, its scatter need not.
    lower, upper = wl.consistency_bounds(0.999, 4, runs)
    average = nees.mean(axis=0)
    assert ((lower < average) & (average < upper)).mean() > 0.9
    assert 0.93 < average.mean() / 4.0 < 1.07


# --- the Python edge --------------------------------------------------------------------------


def one_filter():
    return wl.Ekf(MOTIONS["ConstantVelocity"])


def test_shapes_of_the_results():
    z = np.stack([readings(7)] * 3)
    result = mixed_imm().run(z, dt_s=DT_S, sensor=RADAR, start=START)
    assert result.mean.shape == (3, 7, 4)
    assert result.covariance.shape == (3, 7, 4, 4)
    assert result.mode_probability.shape == (3, 7, 3)
    assert result.nis.shape == result.log_likelihood.shape == result.status.shape == (3, 7)
    assert one_filter().run(z, dt_s=DT_S, sensor=RADAR, start=START).mode_probability is None


@pytest.mark.parametrize("count", [1, 3])
def test_a_filter_for_each_mode(count):
    with pytest.raises(ValueError, match=f"chain must have {count} modes, .*got 2"):
        wl.Imm([one_filter()] * count, wl.ModeChain([[0.9, 0.1], [0.1, 0.9]]))


@pytest.mark.parametrize("count", [0, 17, 40])
def test_no_filters_and_too_many_are_rejected(count):
    with pytest.raises(ValueError, match=f"filters must be 1 to 16 filters, got {count}"):
        wl.Imm([one_filter()] * count, wl.ModeChain([[1.0]]))


@pytest.mark.parametrize("what", [3, None, MOTIONS["ConstantVelocity"]])
def test_what_is_no_filter_is_rejected_by_name(what):
    with pytest.raises(TypeError, match=r"filters must be Kalman, .* or AlphaBeta"):
        wl.Imm([what], wl.ModeChain([[1.0]]))


def test_known_turn_rates_are_reported():
    def imm(*motions):
        chain = wl.ModeChain.from_sojourn_s([60.0] * len(motions))
        return wl.Imm([wl.Ukf(motion) for motion in motions], chain)

    straight = wl.ConstantVelocity()
    turns = [wl.CoordinatedTurn(turn_rate_rad_s=rate) for rate in (0.0, 0.02, -0.01)]
    np.testing.assert_array_equal(imm(*turns).turn_rates_rad_s(), [0.0, 0.02, -0.01])
    np.testing.assert_array_equal(imm(straight, turns[1]).turn_rates_rad_s(), [0.0, 0.02])
    for unknown in (wl.CoordinatedTurnRate(), wl.WanderingCourse(), wl.Singer()):
        assert imm(*turns, unknown).turn_rates_rad_s() is None


def test_a_bare_matrix_is_no_chain():
    with pytest.raises(TypeError):
        wl.Imm([one_filter()] * 2, np.full((2, 2), 0.5))


@pytest.mark.parametrize(
    "initial", [[0.3, 0.3], [1.5, -0.5], [np.nan, 1.0], [1.0], [0.5, 0.3, 0.2]]
)
def test_initial_probabilities_must_be_a_distribution(initial):
    with pytest.raises(ValueError, match="initial"):
        wl.Imm([one_filter()] * 2, wl.ModeChain(np.full((2, 2), 0.5)), initial)


def test_kalman_filters_reject_a_sensor_that_is_not_linear():
    imm = turning_imm(wl.Kalman)
    with pytest.raises(ValueError, match="sensor must be linear for Kalman"):
        imm.run(readings(3), dt_s=DT_S, sensor=RADAR, start=START)


@pytest.mark.parametrize("index", [3, -1])
def test_there_is_no_filter_of_that_number(index):
    imm = turning_imm()
    imm.start(START)
    with pytest.raises(IndexError, match=f"index must be 0 to 2, got {index}"):
        imm.filter_estimate(index)


def test_a_filter_that_was_not_started_believes_nothing():
    with pytest.raises(wl.FilterError, match="not started"):
        turning_imm().filter_estimate(0)


@pytest.mark.parametrize("runs", [1, 9])
def test_models_that_never_take_turns_run_on(runs):
    """Of an identity for a chain one model dwindles beyond what numbers hold."""
    filters = [wl.Ekf(wl.CoordinatedTurn(turn_rate_rad_s=rate)) for rate in (0.0, 0.035)]
    imm = wl.Imm(filters, wl.ModeChain(np.eye(2)))
    north_m = 30.0 * np.arange(1, 1001)
    z = np.tile(np.column_stack([north_m, 0.0 * north_m]), (runs, 1, 1))
    start = wl.Gaussian([0.0, 10.0, 0.0, 0.0], 100.0 * np.eye(4))
    result = imm.run(z, dt_s=3.0, sensor=wl.Position(position_std_m=10.0), start=start)
    assert (result.status == wl.Status.ok).all()
    assert result.mean[:, -1, 0] == pytest.approx(30000.0, abs=1.0)
    assert result.mode_probability.sum(axis=-1) == pytest.approx(1.0)


def test_before_a_start_the_modes_are_those_that_it_begins_with():
    filters = [wl.Ekf(wl.ConstantVelocity()), wl.Ekf(wl.ConstantVelocity())]
    imm = wl.Imm(filters, wl.ModeChain(np.eye(2)), initial_mode_probability=[0.95, 0.05])
    assert imm.mode_probability() == pytest.approx([0.95, 0.05])


def test_an_estimator_keeps_its_own_filters():
    shared = one_filter()
    imm = wl.Imm([shared, shared], wl.ModeChain(np.full((2, 2), 0.5)))
    imm.start(START)
    assert not shared.started
