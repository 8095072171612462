"""One-model estimators: laws, failures that change nothing, and `run` against single steps."""

import copy
import pickle
import time
from contextlib import nullcontext
from itertools import pairwise
from threading import Thread

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import wakeline as wl
from cases import (
    CONVERTED,
    DT_S,
    ESTIMATORS,
    LINEAR_MOTIONS,
    MOTIONS,
    POSITION,
    RADAR,
    START,
    START_MEAN,
    readings,
    stepwise,
    turning_imm,
)
from wakeline.scenario import RadarSimulator, Scenario, Segment, Truth

shapes = hnp.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=4)
FIELDS = ("mean", "covariance", "innovation", "nis", "log_likelihood", "status")


def ekf():
    return wl.Ekf(MOTIONS["ConstantVelocity"])


def run(estimator, z, **changes):
    return estimator.run(z, **({"dt_s": DT_S, "sensor": RADAR, "start": START} | changes))


def north_east(z):
    return np.column_stack([z[:, 0] * np.cos(z[:, 1]), z[:, 0] * np.sin(z[:, 1])])


# --- laws -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", LINEAR_MOTIONS)
@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf, wl.SquareRootUkf])
@pytest.mark.parametrize("sensor", [CONVERTED, POSITION], ids=["converted", "position"])
def test_every_filter_is_the_kalman_filter_on_a_linear_model(name, kind, sensor):
    z = readings()
    if sensor is POSITION:
        z = north_east(z)
    exact = run(wl.Kalman(LINEAR_MOTIONS[name]), z, sensor=sensor)
    other = run(kind(LINEAR_MOTIONS[name]), z, sensor=sensor)
    assert (exact.status == 0).all()
    for field in ("mean", "covariance", "nis", "log_likelihood"):
        np.testing.assert_allclose(
            getattr(other, field), getattr(exact, field), rtol=1e-7, atol=1e-6, err_msg=field
        )


@pytest.mark.parametrize(("alpha", "kappa"), [(1.0, 0.0), (0.5, 1.0), (1e-3, 0.0), (1.0, -1.0)])
def test_the_spread_of_sigma_points_is_nothing_to_a_linear_model(alpha, kappa):
    motion = MOTIONS["ConstantVelocity"]
    z = readings()
    exact = run(wl.Kalman(motion), z, sensor=CONVERTED)
    spread = run(wl.Ukf(motion, alpha=alpha, kappa=kappa), z, sensor=CONVERTED)
    np.testing.assert_allclose(spread.mean, exact.mean, rtol=1e-6, atol=1e-5)


@pytest.mark.parametrize("name", ESTIMATORS)
def test_covariances_stay_symmetric_and_positive(name):
    covariance = run(ESTIMATORS[name](), readings()).covariance
    np.testing.assert_array_equal(covariance, np.swapaxes(covariance, -1, -2))
    assert np.linalg.eigvalsh(covariance).min() > 0.0


def test_a_filter_of_the_true_model_reports_the_truth_about_its_errors():
    rng = np.random.default_rng(11)
    motion = MOTIONS["ConstantVelocity"]
    runs, scans = 300, 30
    f, q = motion.matrix(DT_S), motion.process_noise(DT_S)
    x = rng.multivariate_normal(START.mean, START.covariance, runs)
    truth = np.empty((runs, scans, 4))
    for scan in range(scans):
        x = x @ f.T + rng.multivariate_normal(np.zeros(4), q, runs)
        truth[:, scan] = x
    z = truth[..., [0, 2]] + rng.normal(0.0, POSITION.position_std_m, (runs, scans, 2))
    result = run(wl.Kalman(motion), z, sensor=POSITION)
    error = truth - result.mean
    nees = np.einsum("rti,rtij,rtj->rt", error, np.linalg.inv(result.covariance), error)
    lower, upper = wl.consistency_bounds(0.999, 4, runs)
    assert ((lower < nees.mean(axis=0)) & (nees.mean(axis=0) < upper)).all()
    # Innovations of a consistent filter are independent: all scans count.
    lower, upper = wl.consistency_bounds(0.999, 2, runs * scans)
    assert lower < result.nis.mean() < upper


@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_a_bearing_seam_is_no_jump(kind):
    """A vessel due south: bearings flip between +180 and -180 degrees."""
    start = wl.Gaussian([-3000.0, 0.0, -40.0, 8.0], np.diag([900.0, 4.0, 900.0, 4.0]))
    east_m = -40.0 + 8.0 * np.arange(1, 21)
    z = np.column_stack([np.hypot(3000.0, east_m), np.arctan2(east_m, -3000.0)])
    assert np.ptp(z[:, 1]) > 6.0
    result = run(kind(MOTIONS["ConstantVelocity"]), z, dt_s=1.0, start=start)
    np.testing.assert_allclose(result.mean[:, 2], east_m, atol=3.0)
    assert result.nis.max() < 0.5


def test_smoothing_ends_where_filtering_does_and_knows_no_less_before():
    kalman = wl.Kalman(MOTIONS["ConstantVelocity"])
    filtered = run(kalman, readings(), sensor=CONVERTED)
    mean, covariance = kalman.smooth(filtered.mean, filtered.covariance, DT_S)
    np.testing.assert_array_equal(mean[-1], filtered.mean[-1])
    np.testing.assert_array_equal(covariance[-1], filtered.covariance[-1])
    gain = filtered.covariance - covariance
    assert np.linalg.eigvalsh(gain).min() > -1e-9 * covariance.max()
    assert (np.trace(gain, axis1=1, axis2=2)[:-1] > 0.0).all()


def test_smoothing_without_noise_is_one_straight_line():
    motion = wl.ConstantVelocity(noise=wl.WhiteAcceleration(psd_m2s3=1e-12))
    kalman = wl.Kalman(motion)
    filtered = run(kalman, readings(20), sensor=CONVERTED)
    mean, _ = kalman.smooth(filtered.mean, filtered.covariance, DT_S)
    for before, after in pairwise(mean):
        np.testing.assert_allclose(motion.matrix(DT_S) @ before, after, atol=1e-4)


def test_two_point_start_is_the_line_through_both():
    first, second = [3000.0, 0.3], [3050.0, 0.31]
    belief = wl.two_point(RADAR, first, second, 2.0)
    as_read = [r * np.array([np.cos(b), np.sin(b)]) for r, b in (first, second)]
    np.testing.assert_allclose(belief.mean[[0, 2]], as_read[1])
    np.testing.assert_allclose(belief.mean[[1, 3]], (as_read[1] - as_read[0]) / 2.0, atol=1e-9)
    places = [RADAR.position(z) for z in (first, second)]
    velocity_covariance = belief.covariance[np.ix_([1, 3], [1, 3])]
    np.testing.assert_allclose(
        velocity_covariance, (places[0].covariance + places[1].covariance) / 4.0, rtol=1e-9
    )


def test_a_two_point_start_knows_that_own_ship_moves():
    own = wl.OwnShip(vnorth_mps=10.0)
    radar = wl.RangeBearing(range_std_m=10.0, bearing_std_rad=1e-4, own=own)
    belief = wl.two_point(radar, [5030.0, 0.0], [5000.0, 0.0], 3.0)  # of a buoy ahead
    np.testing.assert_allclose(belief.mean, [5000.0, 0.0, 0.0, 0.0], atol=1e-3)


def test_one_point_start_knows_the_place_and_a_speed():
    belief = wl.one_point(RADAR, [3000.0, 0.3], 12.0)
    np.testing.assert_allclose(belief.mean[[1, 3]], 0.0)
    np.testing.assert_allclose(belief.covariance[np.ix_([1, 3], [1, 3])], 144.0 * np.eye(2))


@pytest.mark.parametrize("name", MOTIONS)
def test_a_start_over_position_and_velocity_fits_every_motion(name):
    filter_ = wl.Ekf(MOTIONS[name])
    assert not filter_.started
    filter_.start(START)
    assert filter_.started
    belief = filter_.estimate()
    assert belief.mean.shape == (MOTIONS[name].states,)
    known = [0, 1, 3, 4] if MOTIONS[name].states == 6 else [0, 1, 2, 3]
    np.testing.assert_array_equal(belief.mean[known], START_MEAN)
    assert np.linalg.eigvalsh(belief.covariance).min() > 0.0


# --- run --------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ESTIMATORS)
@pytest.mark.parametrize("sensor", [RADAR, CONVERTED], ids=["polar", "converted"])
def test_run_is_the_loop_of_single_steps_bit_for_bit(name, sensor):
    z = readings(miss=(4, 5, 17))
    result = run(ESTIMATORS[name](), z, sensor=sensor)
    mean, covariance, innovation, nis, log_likelihood = stepwise(
        ESTIMATORS[name](), z, sensor=sensor
    )
    np.testing.assert_array_equal(result.mean, mean)
    np.testing.assert_array_equal(result.covariance, covariance)
    np.testing.assert_array_equal(result.innovation, innovation)
    np.testing.assert_array_equal(result.nis, nis)
    np.testing.assert_array_equal(result.log_likelihood, log_likelihood)


@pytest.mark.parametrize("name", ESTIMATORS)
def test_many_runs_are_many_single_runs(name):
    z = np.stack([readings(12, seed, miss=(seed,)) for seed in range(5)])
    starts = [wl.Gaussian(START_MEAN + k, START.covariance) for k in range(5)]
    together = run(ESTIMATORS[name](), z, start=starts)
    for k in range(5):
        alone = run(ESTIMATORS[name](), z[k], start=starts[k])
        for field in FIELDS:
            here, there = getattr(together, field)[k], getattr(alone, field)
            # Side by side they are computed with the fused operations of wider registers.
            rounding = 1e-11 * np.nanmax(np.abs(there))
            np.testing.assert_allclose(here, there, rtol=0, atol=rounding, err_msg=field)


def test_run_leaves_the_estimator_as_it_was():
    estimator = ekf()
    estimator.start(START)
    run(estimator, readings())
    np.testing.assert_array_equal(estimator.estimate().mean, START_MEAN)


def test_a_step_for_each_scan():
    z = readings(6)
    even = run(ekf(), z)
    np.testing.assert_array_equal(run(ekf(), z, dt_s=[DT_S] * 6).mean, even.mean)
    np.testing.assert_array_equal(run(ekf(), z, dt_s=np.full(6, 3)).mean, even.mean)
    uneven = run(ekf(), z, dt_s=np.linspace(1.0, 6.0, 6))
    assert (uneven.status == 0).all()
    assert not np.array_equal(uneven.mean, even.mean)


def test_a_moving_own_ship_sees_the_same_vessel():
    own = np.column_stack([np.linspace(0.0, 600.0, 30), np.linspace(0.0, -300.0, 30)])
    z = readings()
    place = z[:, :1] * np.column_stack([np.cos(z[:, 1]), np.sin(z[:, 1])]) - own
    seen = np.column_stack([np.hypot(*place.T), np.arctan2(place[:, 1], place[:, 0])])
    moving = run(ekf(), seen, own_position_m=own)
    own_each = ekf()
    own_each.start(START)
    for k, row in enumerate(seen):
        sensor = wl.RangeBearing(
            range_std_m=RADAR.range_std_m,
            bearing_std_rad=RADAR.bearing_std_rad,
            own=wl.OwnShip(north_m=own[k, 0], east_m=own[k, 1]),
        )
        own_each.predict(DT_S)
        own_each.update(sensor, row)
        np.testing.assert_array_equal(moving.mean[k], own_each.estimate().mean)
    assert np.abs(moving.mean - run(ekf(), z).mean)[:, [0, 2]].max() < 100.0


@pytest.mark.parametrize("name", ESTIMATORS)
@pytest.mark.parametrize(
    "gate", [wl.RadiusGate(radius_m=700.0), wl.ChiSquareGate(probability=1.0 - 1e-9)], ids=type
)
def test_a_reading_outside_the_gate_is_as_one_that_is_missed(name, gate):
    z = readings()
    z[7, 0] += 900.0
    reported = run(ESTIMATORS[name](), np.where(np.arange(len(z))[:, None] == 7, np.nan, z))
    gated = run(ESTIMATORS[name](), z, gate=gate)
    assert (gated.status == np.where(np.arange(len(z)) == 7, int(wl.Status.gated), 0)).all()
    for field in set(FIELDS) - {"status"}:
        np.testing.assert_array_equal(getattr(gated, field), getattr(reported, field))


@pytest.mark.parametrize(
    "gate", [wl.RadiusGate(radius_m=700.0), wl.ChiSquareGate(probability=1.0 - 1e-9)], ids=type
)
def test_a_gate_reopens_after_readings_outside_in_a_row(gate):
    z = readings(60)
    z[20:, 0] += 1500.0
    z[10, 0] += 1500.0
    lost = run(ekf(), z, gate=gate)
    assert (lost.status[20:26] == wl.Status.gated).all()
    found = run(ekf(), z, gate=gate, reopen_after=3)
    assert found.status[10] == wl.Status.gated
    assert found.status[20:24].tolist() == [wl.Status.gated] * 3 + [wl.Status.ok]
    assert found.status[-1] == wl.Status.ok
    many = ekf().run(np.stack([z, readings(60), z]), DT_S, RADAR, START, gate=gate, reopen_after=3)
    np.testing.assert_array_equal(many.status, [found.status, 0 * found.status, found.status])
    with pytest.raises(ValueError, match="reopen_after"):
        run(ekf(), z, gate=gate, reopen_after=0)
    with pytest.raises(ValueError, match="reopen_after"):
        run(ekf(), z, reopen_after=3)


@pytest.mark.parametrize("north_m", [0.0, 5e-4, 0.5, 500.0])
@pytest.mark.parametrize("own", [wl.OwnShip(), wl.OwnShip(north_m=300.0, east_m=-200.0)])
def test_a_start_at_the_antenna_converges(north_m, own):
    sensor = wl.RangeBearing(own=own)
    doppler = wl.RangeBearingDoppler(own=own)
    place = [own.north_m + 5000.0 * np.cos(0.6), own.east_m + 5000.0 * np.sin(0.6)]
    mean = [own.north_m + north_m, 0.0, own.east_m, 0.0]
    start = wl.Gaussian(mean, np.diag([1e8, 100.0, 1e8, 100.0]))
    for z, one in (([5000.0, 0.6], sensor), ([5000.0, 0.6, 0.0], doppler)):
        for estimator in (ekf(), turning_imm(), wl.Ukf(wl.ConstantVelocity())):
            result = estimator.run(np.tile(z, (30, 1)), 3.0, one, start)
            assert (result.status == wl.Status.ok).all()
            assert np.hypot(*(result.mean[-1, [0, 2]] - place)) < 1.0
            many = estimator.run(np.tile(z, (9, 30, 1)), 3.0, one, start)
            np.testing.assert_allclose(many.mean[4, -1], result.mean[-1], rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("estimator", [turning_imm, lambda: per_prediction()], ids=["time", "step"])
def test_modes_that_change_once_per_prediction_warn_of_uneven_steps(estimator):
    uneven = np.where(np.arange(12) % 3, DT_S, DT_S / 10)
    z = readings(12)
    warned = estimator is not turning_imm
    caught = pytest.warns(UserWarning, match="no period") if warned else nullcontext()
    with caught:
        estimator().run(z, uneven, RADAR, START)
    one = estimator()
    one.start(START)
    one.predict(DT_S)
    one.predict(DT_S * 1.01)  # a turn of the antenna
    caught = pytest.warns(UserWarning, match="no period") if warned else nullcontext()
    with caught:
        one.predict(DT_S / 10)
    estimator().run(z, DT_S, RADAR, START)


def per_prediction():
    return wl.Imm([ekf(), ekf()], wl.ModeChain([[0.9, 0.1], [0.2, 0.8]]))


def test_a_step_is_true_where_its_reading_was_taken():
    filtering = ekf()
    filtering.start(START)
    filtering.predict(DT_S)
    assert filtering.update(RADAR, [1000.0, 0.5])
    navigator = wl.UsvNavigator()
    navigator.start([0, 0], [1, 0], 0.0)
    navigator.predict(1.0)
    assert navigator.update_position([1.0, 1.0])
    assert not navigator.update_position([np.nan, 0.0])
    assert not navigator.update_position([1e5, 0.0])


@pytest.mark.parametrize("kind", ["timedelta64[s]", "datetime64[ns]", "complex128"])
def test_times_and_complex_numbers_are_no_readings(kind):
    steps = np.ones(3, dtype=int).astype(kind)
    for dt_s in (steps, list(steps)):
        with pytest.raises(TypeError, match="must hold real numbers"):
            ekf().run(np.zeros((3, 2)), dt_s, RADAR, START)


@pytest.mark.parametrize("kind", ["U9", "S9", object])
def test_numbers_written_as_text_are_no_readings(kind):
    z = np.array([["5000", "0.5"], ["4980", "0.506"]], dtype=kind)
    for reported in (z, z.tolist(), np.ma.array(z)):
        with pytest.raises(TypeError, match=r"must hold real numbers, got text such as .*5000"):
            ekf().run(reported, 3.0, RADAR, START)
    with pytest.raises(TypeError, match="dt_s must be a number or an array, got '3'"):
        ekf().run(np.zeros((2, 2)), "3", RADAR, START)


def test_a_row_of_nan_is_a_missed_scan():
    z = readings(miss=(3,))
    result = run(ekf(), z)
    assert wl.Status(result.status[3]) == wl.Status.missed
    assert np.isnan(result.nis[3])
    assert np.isnan(result.log_likelihood[3])
    f = MOTIONS["ConstantVelocity"].matrix(DT_S)
    np.testing.assert_allclose(result.mean[3], f @ result.mean[2], rtol=1e-12)
    assert (np.delete(result.status, 3) == int(wl.Status.ok)).all()


@pytest.mark.parametrize("bad", [[5000.0, np.inf], [-np.inf, 0.7]])
def test_a_reading_that_is_not_finite_is_marked_and_changes_nothing(bad):
    z = readings()
    z[3] = bad
    missed = z.copy()
    missed[3] = np.nan
    result = run(ekf(), z)
    assert wl.Status(result.status[3]) == wl.Status.not_finite
    np.testing.assert_array_equal(result.mean, run(ekf(), missed).mean)
    assert np.isfinite(result.mean).all()


def test_an_own_position_that_is_not_finite_is_marked_and_changes_nothing():
    own = np.zeros((3, 2))
    own[1, 0] = np.nan
    result = run(ekf(), readings(3), own_position_m=own)
    assert wl.Status(result.status[1]) == wl.Status.not_finite
    assert np.isfinite(result.mean).all()


@pytest.mark.parametrize(
    ("dt_s", "status"),
    [(-1.0, wl.Status.negative_time_step), (np.nan, wl.Status.not_finite)],
)
def test_a_time_step_that_is_invalid_is_marked_and_changes_nothing(dt_s, status):
    result = run(ekf(), readings(3), dt_s=[DT_S, dt_s, DT_S])
    assert wl.Status(result.status[1]) == status
    np.testing.assert_array_equal(result.mean[1], result.mean[0])
    assert wl.Status(result.status[2]) == wl.Status.ok


@pytest.mark.parametrize("name", ESTIMATORS)
@pytest.mark.parametrize("dt_s", [0.0, 3600.0])
def test_no_time_and_an_hour_are_time_steps(name, dt_s):
    result = run(ESTIMATORS[name](), readings(3), dt_s=[DT_S, dt_s, DT_S])
    assert np.isfinite(result.mean).all()
    assert np.isfinite(result.covariance).all()


@pytest.mark.parametrize("name", ["Ekf-ConstantVelocity", "Imm", "Imm-mixed"])
def test_no_scans_and_no_runs(name):
    states = run(ESTIMATORS[name](), readings(1)).mean.shape[-1]
    assert run(ESTIMATORS[name](), np.zeros((0, 2))).mean.shape == (0, states)
    none = run(ESTIMATORS[name](), np.zeros((0, 7, 2)))
    assert none.covariance.shape == (0, 7, states, states)
    assert none.status.shape == (0, 7)


def test_a_long_run_lets_other_threads_work():
    z = np.tile(readings(), (300, 1, 1))
    worker = Thread(target=lambda: [run(ESTIMATORS["Imm-mixed"](), z) for _ in range(50)])
    turns = 0
    worker.start()
    while worker.is_alive():
        time.sleep(1e-3)
        turns += 1
    assert turns > 10


# --- the Python edge --------------------------------------------------------------------------


@given(shapes)
def test_readings_of_wrong_shape_name_wanted_and_given(shape):
    if len(shape) in (2, 3) and shape[-1] == 2:
        return
    with pytest.raises(ValueError, match=r"z must have shape \(T, 2\) or \(R, T, 2\)") as error:
        run(ekf(), np.zeros(shape))
    assert f"got {shape}" in str(error.value)


@given(shapes)
def test_steps_of_wrong_shape_name_wanted_and_given(shape):
    if shape in ((), (6,)):
        return
    with pytest.raises(ValueError, match=r"dt_s must have shape \(\) or \(6,\)") as error:
        run(ekf(), readings(6), dt_s=np.ones(shape))
    assert f"got {shape}" in str(error.value)


@given(shapes)
def test_own_positions_of_wrong_shape_name_wanted_and_given(shape):
    if shape == (6, 2):
        return
    with pytest.raises(ValueError, match="own_position_m must have shape") as error:
        run(ekf(), readings(6), own_position_m=np.zeros(shape))
    assert f"got {shape}" in str(error.value)


def test_a_position_sensor_has_no_own_ship():
    for name in ("own_position_m", "own_velocity_mps"):
        with pytest.raises(ValueError, match=name):
            run(ekf(), readings(6), sensor=POSITION, **{name: np.zeros((6, 2))})


def test_doppler_readings_are_three_numbers():
    doppler = wl.RangeBearingDoppler(range_std_m=30.0, bearing_std_rad=0.01, range_rate_std_mps=0.5)
    with pytest.raises(ValueError, match=r"z must have shape \(T, 3\)"):
        run(ekf(), readings(6), sensor=doppler)
    z = np.column_stack([readings(6), np.zeros(6)])
    assert run(ekf(), z, sensor=doppler).mean.shape == (6, 4)


def seen_on_the_way(scans=60):
    """A vessel at 5 m/s east, seen with its range rate from own ship, who turns: z, place, way."""
    time_s = DT_S * np.arange(1, scans + 1)
    course_rad = 0.01 * time_s
    own_mps = 8.0 * np.column_stack([np.cos(course_rad), np.sin(course_rad)])
    own_m = 800.0 * np.column_stack([np.sin(course_rad), 1.0 - np.cos(course_rad)])
    way_m = np.column_stack([np.full(scans, 3000.0), 1000.0 + 5.0 * time_s]) - own_m
    range_m = np.hypot(*way_m.T)
    rate_mps = ((np.array([0.0, 5.0]) - own_mps) * way_m).sum(axis=1) / range_m
    bearing_rad = np.arctan2(way_m[:, 1], way_m[:, 0])
    return np.column_stack([range_m, bearing_rad, rate_mps]), own_m, own_mps


@pytest.mark.parametrize("runs", [None, 9])
def test_range_rates_are_those_that_a_turning_own_ship_sees(runs):
    z, own_m, own_mps = seen_on_the_way()
    doppler = wl.RangeBearingDoppler(
        range_std_m=10.0, bearing_std_rad=0.003, range_rate_std_mps=0.3
    )
    start = wl.Gaussian([3000.0, 0.0, 1000.0, 5.0], np.diag([100.0, 1.0, 100.0, 1.0]))
    many = z if runs is None else np.tile(z, (runs, 1, 1))
    reported = {"dt_s": DT_S, "sensor": doppler, "start": start, "own_position_m": own_m}
    result = ekf().run(many, own_velocity_mps=own_mps, **reported)
    truth = np.column_stack([0.0 * z[:, 0] + 3000.0, 1000.0 + 5.0 * DT_S * np.arange(1, 61)])
    assert np.abs(result.mean[..., [0, 2]] - truth).max() < 1e-6
    assert np.abs(result.nis).max() < 1e-9
    with pytest.raises(ValueError, match=r"own_velocity_mps is required .* got None"):
        ekf().run(many, **reported)
    with pytest.raises(ValueError, match=r"own_velocity_mps must have shape \(60, 2\), got"):
        ekf().run(many, own_velocity_mps=own_mps[1:], **reported)


@pytest.mark.parametrize("dt_s", ["abc", object(), None])
def test_a_time_step_that_is_not_a_number_is_named(dt_s):
    with pytest.raises(TypeError, match="dt_s must be a number or an array, got"):
        run(ekf(), readings(3), dt_s=dt_s)


def test_strides_dtypes_and_lists_are_taken():
    z = readings()
    wanted = run(ekf(), z).mean
    wide = np.zeros((60, 5))
    wide[::2, 1:4:2] = z
    for same in (wide[::2, 1:4:2], np.asfortranarray(z), z.tolist(), z.astype(">f8")):
        np.testing.assert_array_equal(run(ekf(), same).mean, wanted)
    reversed_rows = z[::-1].copy()[::-1]
    np.testing.assert_array_equal(run(ekf(), reversed_rows).mean, wanted)
    single = run(ekf(), z.astype(np.float32)).mean
    np.testing.assert_allclose(single, wanted, atol=0.1)


@pytest.mark.parametrize("starts", [[], [START], [START] * 3])
def test_starts_are_one_or_one_a_run(starts):
    with pytest.raises(ValueError, match=rf"start must be .*\(2\), got {len(starts)}"):
        run(ekf(), np.stack([readings(3)] * 2), start=starts)


@given(st.sampled_from([0, 1, 2, 3, 7, 8]))
def test_a_belief_of_wrong_size_is_rejected(size):
    with pytest.raises(ValueError, match=f"belief must have a mean of .*, got {size}"):
        ekf().start(wl.Gaussian(np.zeros(size), np.eye(size)))


@pytest.mark.parametrize("states", [5, 6])
def test_a_belief_over_another_state_is_rejected(states):
    with pytest.raises((ValueError, wl.FilterError)):
        ekf().start(wl.Gaussian(np.zeros(states), np.eye(states)))


@pytest.mark.parametrize("sensor", [None, 3, "radar", START])
def test_what_is_no_sensor_is_rejected_by_name(sensor):
    with pytest.raises(TypeError, match="sensor must be RangeBearing"):
        run(ekf(), readings(3), sensor=sensor)


@pytest.mark.parametrize("motion", [wl.CoordinatedTurnRate(), wl.WanderingCourse(), None])
def test_kalman_rejects_motion_that_is_not_linear(motion):
    with pytest.raises(TypeError):
        wl.Kalman(motion)


def test_kalman_rejects_a_sensor_that_is_not_linear():
    kalman = wl.Kalman(MOTIONS["ConstantVelocity"])
    with pytest.raises(ValueError, match="sensor must be linear for Kalman"):
        run(kalman, readings(3))
    kalman.start(START)
    with pytest.raises(ValueError, match="sensor must be linear for Kalman"):
        kalman.update(RADAR, [5000.0, 0.6])


@pytest.mark.parametrize("wrong", [{"alpha": 0.0}, {"kappa": -4.0}, {"beta": np.nan}])
@pytest.mark.parametrize("kind", [wl.Ukf, wl.SquareRootUkf])
def test_sigma_points_that_are_invalid_are_rejected_by_name(kind, wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        kind(MOTIONS["ConstantVelocity"], **wrong)


@pytest.mark.parametrize("dt_s", [0.0, -1.0, np.nan, np.inf])
def test_a_start_from_two_plots_needs_time_between(dt_s):
    with pytest.raises(ValueError, match="dt_s must be"):
        wl.two_point(RADAR, [3000.0, 0.3], [3000.0, 0.3], dt_s)


@pytest.mark.parametrize("plot", [[np.nan, 0.3], [3000.0, np.inf]])
def test_a_start_needs_plots_that_are_there(plot):
    with pytest.raises(ValueError, match="first must be finite"):
        wl.two_point(RADAR, plot, [3000.0, 0.3], 1.0)
    with pytest.raises(ValueError, match="second must be finite"):
        wl.two_point(RADAR, [3000.0, 0.3], plot, 1.0)
    with pytest.raises(ValueError, match="z must be finite"):
        wl.one_point(RADAR, plot, 5.0)
    with pytest.raises(ValueError, match="speed_std_mps must be finite and positive, got -1"):
        wl.one_point(RADAR, [3000.0, 0.3], -1.0)


# --- copies -----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ESTIMATORS)
@pytest.mark.parametrize("how", [copy.copy, copy.deepcopy])
def test_a_copy_continues_by_itself(name, how):
    estimator = ESTIMATORS[name]()
    estimator.start(START)
    before = estimator.estimate()
    twin = how(estimator)
    assert type(twin) is type(estimator)
    estimator.predict(1.0)
    np.testing.assert_array_equal(twin.estimate().mean, before.mean)
    twin.predict(1.0)
    np.testing.assert_array_equal(twin.estimate().covariance, estimator.estimate().covariance)


def test_results_go_through_pickle():
    result = run(ESTIMATORS["Imm"](), readings(5))
    again = pickle.loads(pickle.dumps(result))
    for field in (*FIELDS, "mode_probability"):
        np.testing.assert_array_equal(getattr(again, field), getattr(result, field))
    assert again.turn_rate_rad_s is None


# --- failures ---------------------------------------------------------------------------------

NOT_BELIEFS = {
    "negative": np.diag([1.0, 1.0, 1.0, -1.0]),
    "zero": np.zeros((4, 4)),
    "not finite": np.diag([1.0, np.nan, 1.0, 1.0]),
    "not a covariance": np.array(
        [[1.0, 2.0, 0, 0], [2.0, 1.0, 0, 0], [0, 0, 1.0, 0], [0, 0, 0, 1.0]]
    ),
}


@pytest.mark.parametrize("name", ESTIMATORS)
@pytest.mark.parametrize("covariance", NOT_BELIEFS.values(), ids=NOT_BELIEFS)
def test_a_start_that_is_no_belief_is_an_error(name, covariance):
    belief = wl.Gaussian(START_MEAN, covariance)
    with pytest.raises(wl.FilterError, match="start"):
        ESTIMATORS[name]().start(belief)
    with pytest.raises(wl.FilterError, match="run 0"):
        run(ESTIMATORS[name](), readings(3), start=belief)


@pytest.mark.parametrize("name", ESTIMATORS)
def test_an_estimator_that_was_not_started_says_so(name):
    estimator = ESTIMATORS[name]()
    with pytest.raises(wl.FilterError, match="not started"):
        estimator.predict(1.0)
    with pytest.raises(wl.FilterError, match="not started"):
        estimator.update(RADAR, [5000.0, 0.6])
    with pytest.raises(wl.FilterError, match="estimate: not started"):
        estimator.estimate()


@pytest.mark.parametrize("name", ESTIMATORS)
def test_a_step_that_fails_leaves_the_belief_as_it_was(name):
    estimator = ESTIMATORS[name]()
    estimator.start(START)
    estimator.predict(DT_S)
    estimator.update(RADAR, [5000.0, 0.64])
    before = estimator.estimate()
    failures = [
        lambda: estimator.predict(-1.0),
        lambda: estimator.predict(np.nan),
        lambda: estimator.predict(np.inf),
        lambda: estimator.update(RADAR, [np.nan, np.nan]),
        lambda: estimator.update(RADAR, [np.inf, 0.0]),
    ]
    for fail in failures:
        with pytest.raises(wl.FilterError):
            fail()
        after = estimator.estimate()
        np.testing.assert_array_equal(after.mean, before.mean)
        np.testing.assert_array_equal(after.covariance, before.covariance)


@pytest.mark.parametrize("name", ["Ekf-ConstantVelocity", "Imm"])
@given(size=st.integers(0, 5).filter(lambda n: n != 2))
def test_a_single_reading_of_wrong_shape_is_rejected(name, size):
    estimator = ESTIMATORS[name]()
    estimator.start(START)
    with pytest.raises(ValueError, match=rf"z must have shape \(2,\), got \({size},\)"):
        estimator.update(RADAR, np.zeros(size))


@pytest.mark.parametrize(
    ("mean", "covariance", "wanted"),
    [
        (np.zeros((5, 3)), np.zeros((5, 4, 4)), r"mean must have shape \(T, 4\), got \(5, 3\)"),
        (np.zeros((5, 4)), np.zeros((4, 4, 4)), r"covariance must have shape \(5, 4, 4\)"),
    ],
)
def test_smoothing_arrays_of_wrong_shape_is_rejected(mean, covariance, wanted):
    with pytest.raises(ValueError, match=wanted):
        ekf().smooth(mean, covariance, DT_S)


def test_smoothing_knows_the_acceleration_that_the_filter_knew():
    """Smoothed under a push is smoothed without one, plus the way that the push alone makes."""
    kalman = wl.Kalman(MOTIONS["ConstantVelocity"])
    z = readings()
    push = np.zeros_like(z)
    push[5:9] = [0.8, -0.5]
    way = np.zeros((len(z), 4))
    gain = np.kron(np.eye(2), [[DT_S**2 / 2], [DT_S]])
    for k in range(1, len(z)):
        way[k] = MOTIONS["ConstantVelocity"].matrix(DT_S) @ way[k - 1] + gain @ push[k]
    plain = run(kalman, north_east(z), sensor=wl.Position(position_std_m=20.0))
    pushed = run(
        kalman,
        north_east(z) + way[:, [0, 2]],
        sensor=wl.Position(position_std_m=20.0),
        acceleration_mps2=push,
    )
    expected, spread = kalman.smooth(plain.mean, plain.covariance, DT_S)
    mean, covariance = kalman.smooth(pushed.mean, pushed.covariance, DT_S, push)
    np.testing.assert_allclose(mean, expected + way, atol=1e-7)
    np.testing.assert_allclose(covariance, spread, rtol=1e-9)


@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_smoothing_comes_nearer_to_the_truth(kind):
    truth, radar = Truth([4000, 6, 3000, -8], [Segment(300)]), RadarSimulator(30, 0.01, 3)
    straight = Scenario("straight", truth, radar, scans=90, position_std_m=30, velocity_std_mps=2)
    z, starts = straight.draw(10, 1), straight.draw_starts(10, 1)
    filtering = kind(wl.CoordinatedTurnRate())
    filtered = filtering.run(z, 3.0, straight.polar_sensor, starts)
    smoothed = [
        filtering.smooth(*beliefs, 3.0)[0]
        for beliefs in zip(filtered.mean, filtered.covariance, strict=True)
    ]
    off_m, left_m = (
        np.hypot(*(np.array(mean)[..., [0, 2]] - straight.truth_states[:, [0, 2]]).T).mean()
        for mean in (filtered.mean, smoothed)
    )
    assert left_m < 0.6 * off_m


def test_smoothing_of_nothing_is_nothing_and_backwards_an_error():
    mean, covariance = ekf().smooth(np.zeros((0, 4)), np.zeros((0, 4, 4)), DT_S)
    assert mean.shape == (0, 4)
    assert covariance.shape == (0, 4, 4)
    beliefs = np.zeros((3, 4)), np.tile(np.eye(4), (3, 1, 1))
    with pytest.raises(wl.FilterError, match="smooth: negative time step"):
        ekf().smooth(*beliefs, [1.0, 1.0, -3.0])
    with pytest.raises(ValueError, match=r"acceleration_mps2 must have shape \(3, 2\)"):
        ekf().smooth(*beliefs, DT_S, np.zeros((2, 2)))


def test_smoothing_what_is_no_covariance_is_an_error():
    with pytest.raises(wl.FilterError, match="smooth"):
        ekf().smooth(np.zeros((3, 4)), np.full((3, 4, 4), -1.0), DT_S)


def test_masked_readings_are_missed():
    z = readings()
    masked = np.ma.masked_array(z, mask=np.zeros_like(z, dtype=bool))
    masked[4] = np.ma.masked
    missed = z.copy()
    missed[4] = np.nan
    for given_z, wanted_z in ((masked, missed), (np.ma.masked_array(z), z)):
        got, wanted = run(ekf(), given_z), run(ekf(), wanted_z)
        for field in FIELDS:
            np.testing.assert_array_equal(getattr(got, field), getattr(wanted, field))
    one = ekf()
    one.start(START)
    one.predict(DT_S)
    with pytest.raises(wl.FilterError, match="update: not finite"):
        one.update(RADAR, masked[4])


# --- traps ------------------------------------------------------------------------------------


def test_the_trap_of_the_upper_triangle():
    """A UKF that takes `matrixLLT` for a factor is wrong for covariances that are not diagonal."""
    skew = np.array([[1.0, 0, 0, 0], [0.4, 1, 0, 0], [0.7, 0.2, 1, 0], [0.1, 0.3, -0.5, 1]])
    belief = wl.Gaussian(START_MEAN, 400.0 * skew @ skew.T)
    motion = MOTIONS["ConstantVelocity"]
    exact = run(wl.Kalman(motion), readings(3), sensor=CONVERTED, start=belief)
    for kind in (wl.Ukf, wl.SquareRootUkf):
        points = run(kind(motion), readings(3), sensor=CONVERTED, start=belief)
        np.testing.assert_allclose(points.mean, exact.mean, rtol=1e-9)


def test_the_trap_of_sigma_points_from_before_the_prediction():
    """A UKF that pairs old with redrawn points has a gain of 0.566 where 0.8 is right."""
    start = wl.Gaussian(np.zeros(4), np.diag([1.0, 1e-12, 1.0, 1e-12]))
    noise = wl.PiecewiseAcceleration(std_mps2=2.0)  # Q of the position is 1 for a step of 1 s
    for kind in (wl.Kalman, wl.Ukf, wl.SquareRootUkf):
        filter_ = kind(wl.ConstantVelocity(noise=noise))
        filter_.start(start)
        filter_.predict(1.0)
        filter_.update(wl.Position(position_std_m=np.sqrt(0.5)), [1.0, 0.0])
        assert filter_.estimate().mean[0] == pytest.approx(0.8, abs=1e-9)
