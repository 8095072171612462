"""Motion models and sensors by matrices and functions in Python, beside those of the engine."""

import copy
import ctypes
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from cases import CONVERTED, DT_S, MOTIONS, POSITION, RADAR, START, readings, stepwise

STRAIGHT, TURN = MOTIONS["ConstantVelocity"], MOTIONS["CoordinatedTurn"]
ACCELERATED, TURNING = MOTIONS["ConstantAcceleration"], MOTIONS["CoordinatedTurnRate"]
TURNING_STATE = ["x", "vx", "y", "vy", "omega"]
ACCELERATED_STATE = ["x", "vx", "ax", "y", "vy", "ay"]


def by_matrices(motion, state=("x", "vx", "y", "vy")):
    return wl.LinearMotion(motion.matrix, motion.process_noise, state=state)


def by_functions(motion, state, with_jacobian=True, **prior):
    return wl.FunctionMotion(
        motion.transition,
        motion.process_noise,
        state=state,
        jacobian=motion.jacobian if with_jacobian else None,
        **prior,
    )


def assert_same(a, b, rtol=1e-12):
    """The results of two runs, each array to a part of its largest number."""
    for name in ("mean", "covariance", "mode_probability", "innovation", "nis", "log_likelihood"):
        one, other = getattr(a, name), getattr(b, name)
        if one is None or other is None:
            assert one is other
            continue
        scale = np.nanmax(np.abs(one))
        np.testing.assert_allclose(other, one, rtol=rtol, atol=rtol * scale, err_msg=name)
    np.testing.assert_array_equal(a.status, b.status)


# Named functions, which can be pickled.


def straight_matrix(dt_s):
    return [[1, dt_s, 0, 0], [0, 1, 0, 0], [0, 0, 1, dt_s], [0, 0, 0, 1]]


def straight_noise(dt_s):
    return STRAIGHT.process_noise(dt_s)


def bearing_of(position):
    return [np.arctan2(position[1], position[0])]


def polar(position):
    return [np.hypot(*position), np.arctan2(position[1], position[0])]


@settings(max_examples=25, deadline=None)
@given(
    psd=st.floats(1e-4, 10.0),
    steps_s=st.lists(st.floats(0.0, 30.0), min_size=1, max_size=6),
    seed=st.integers(0, 1000),
)
def test_constant_velocity_by_matrices_is_constant_velocity(psd, steps_s, seed):
    motion = wl.ConstantVelocity(noise=wl.WhiteAcceleration(psd_m2s3=psd))
    custom = by_matrices(motion)
    z = np.random.default_rng(seed).normal(5000.0, 500.0, (24, 2))
    dt_s = np.resize(steps_s, 24)
    for kind in (wl.Kalman, wl.Ekf, wl.Ukf):
        own, ours = (kind(one).run(z, dt_s, POSITION, START) for one in (motion, custom))
        assert_same(own, ours, rtol=1e-12 if kind is not wl.Ukf else 1e-9)


@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf])
@pytest.mark.parametrize("sensor", [RADAR, CONVERTED, POSITION], ids=lambda s: type(s).__name__)
def test_matrices_of_every_size_give_the_results_of_the_model(kind, sensor):
    z = readings(miss=(4, 11))
    if sensor is POSITION:
        z = z[:, :1] * np.column_stack([np.cos(z[:, 1]), np.sin(z[:, 1])])
    for motion, state in (
        (STRAIGHT, TURNING_STATE[:4]),
        (TURN, TURNING_STATE[:4]),
        (ACCELERATED, ACCELERATED_STATE),
    ):
        custom = by_matrices(motion, state)
        own, ours = (kind(one).run(z, DT_S, sensor, START) for one in (motion, custom))
        assert_same(own, ours, rtol=1e-9)
        assert own.mean.shape[1] == custom.states == len(state)


@pytest.mark.parametrize("with_jacobian", [True, False])
def test_functions_give_the_results_of_the_model(with_jacobian):
    z = readings(miss=(7,))
    custom = by_functions(
        TURNING,
        TURNING_STATE,
        with_jacobian,
        prior_std={"omega": TURNING.prior_turn_rate_std_rad_s},
    )
    for kind in (wl.Ekf, wl.Ukf):
        own, ours = (kind(one).run(z, DT_S, RADAR, START) for one in (TURNING, custom))
        assert_same(own, ours, rtol=1e-9 if with_jacobian or kind is wl.Ukf else 1e-6)
        assert ours.lanes == 0  # Python's speed
    assert wl.Ekf(by_matrices(STRAIGHT)).run(z, DT_S, RADAR, START).lanes == 1


def test_smoothers_give_the_results_of_the_model():
    z = readings(miss=(7,))
    pairs = [(motion, by_matrices(motion)) for motion in (STRAIGHT, TURN)]
    pairs.append((TURNING, by_functions(TURNING, TURNING_STATE)))
    for own, custom in pairs:
        for kind in (wl.Ekf, wl.Ukf):
            run = kind(own).run(z, DT_S, RADAR, START)
            for a, b in zip(
                kind(own).smooth(run.mean, run.covariance, DT_S),
                kind(custom).smooth(run.mean, run.covariance, DT_S),
                strict=True,
            ):
                np.testing.assert_allclose(b, a, rtol=1e-9, atol=1e-9 * np.abs(a).max())


def test_an_imm_of_matrices_is_the_imm_of_the_models():
    z, chain = readings(miss=(3,)), wl.ModeChain.from_sojourn_s([60.0, 30.0])
    own = wl.Imm([wl.Ekf(STRAIGHT), wl.Ekf(TURN)], chain)
    for custom in (
        wl.Imm([wl.Ekf(by_matrices(STRAIGHT)), wl.Ekf(by_matrices(TURN))], chain),
        wl.Imm([wl.Ekf(STRAIGHT), wl.Ekf(by_matrices(TURN))], chain),
    ):
        assert_same(own.run(z, DT_S, RADAR, START), custom.run(z, DT_S, RADAR, START), rtol=1e-10)
        a, b = (imm.smooth(z, DT_S, RADAR, START) for imm in (own, custom))
        np.testing.assert_allclose(b.mean, a.mean, rtol=1e-7)
        np.testing.assert_allclose(b.mode_probability, a.mode_probability, atol=1e-7)


def test_models_of_different_states_mix_by_their_names():
    """A state that only the custom model has, `drag`, is its own; the others mix."""
    f, q = np.eye(5), np.diag([0.1, 0.01, 0.1, 0.01, 1e-4])

    def matrix(dt_s):
        f[0, 1] = f[2, 3] = dt_s
        return f

    state = ["x", "vx", "y", "vy", "drag"]
    custom = wl.Ekf(wl.LinearMotion(matrix, lambda dt_s: q * dt_s, state=state))
    imm = wl.Imm([wl.Ekf(TURNING), custom], wl.ModeChain.from_sojourn_s([60.0, 60.0]))
    result = imm.run(readings(), DT_S, RADAR, START)
    assert result.mean.shape == (30, 4)
    assert np.isfinite(result.mean).all()
    assert (result.status == int(wl.Status.ok)).all()
    smoothed = imm.smooth(readings(), DT_S, RADAR, START)
    assert np.isfinite(smoothed.mean).all()
    assert np.trace(smoothed.covariance[10]) < np.trace(result.covariance[10])


FIRM = wl.LinearSensor(np.eye(2), np.diag([625.0, 900.0]), reads=["x", "y"])
SPEEDS = wl.LinearSensor([[0, 1, 0, 0], [0, 0, 0, 1], [0.5, 0, 0.5, 0]], np.diag([1.0, 1.0, 400.0]))
DRAWN_ASIDE = wl.LinearMotion(  # no model of the engine has this F
    lambda dt_s: np.array(straight_matrix(dt_s)) + 0.01 * dt_s * np.eye(4)[::-1], straight_noise
)


def many_and_one():
    """Estimators with sensors, and whether they run in lanes."""
    straight, turn = by_matrices(STRAIGHT), by_matrices(TURN)
    accelerated = by_matrices(ACCELERATED, ACCELERATED_STATE)
    chain = wl.ModeChain.from_sojourn_s([60.0, 30.0])
    for kind in (wl.Kalman, wl.Ekf, wl.Ukf):
        for motion in (straight, accelerated):
            yield kind(motion), POSITION, True
        for motion in (straight, ACCELERATED, DRAWN_ASIDE):
            yield kind(motion), FIRM, True
        yield kind(DRAWN_ASIDE), POSITION, False
    yield wl.SquareRootUkf(STRAIGHT), FIRM, True
    yield wl.Kalman(straight), SPEEDS, True
    yield wl.Imm([wl.Ekf(straight), wl.Ekf(turn)], chain), POSITION, True
    yield wl.Imm([wl.Ukf(accelerated), wl.Ekf(TURN)], chain), POSITION, True
    yield wl.Imm([wl.Ekf(straight), wl.Ekf(turn)], chain), FIRM, False


@pytest.mark.parametrize("gate", [None, wl.ChiSquareGate(probability=0.7)])
@pytest.mark.parametrize(("estimator", "sensor", "in_lanes"), list(many_and_one()))
def test_many_recordings_and_threads_give_the_results_of_one(estimator, sensor, in_lanes, gate):
    random = np.random.default_rng(5)
    z = random.normal(5000.0, 40.0, (19, 30, sensor.measurements))
    if sensor is SPEEDS:
        z[..., :2] /= 500.0
    z[random.random(z.shape[:2]) < 0.1] = np.nan
    steps_s, push = random.uniform(0.0, 4.0, 30), random.normal(0.0, 0.5, (30, 2))
    starts = [wl.Gaussian(random.normal(START.mean, 50.0), START.covariance) for _ in z]
    starts[3] = wl.Gaussian(START.mean, np.diag([1e11, 100.0, 1e11, 100.0]))  # P - K S Kᵀ cancels

    def run(of, start):
        return estimator.run(of, steps_s, sensor, start, acceleration_mps2=push, gate=gate)

    together = run(z, starts)
    assert together.lanes == (wl.lanes() if in_lanes else 1)
    for k, start in enumerate(starts):
        alone = run(z[k], start)
        for name in ("mean", "covariance", "innovation", "nis", "log_likelihood", "status"):
            one, all_of_them = getattr(alone, name), getattr(together, name)[k]
            rtol = 1e-6 if k == 3 else 1e-9
            scale = np.nanmax(np.abs(one), initial=1.0)
            np.testing.assert_allclose(all_of_them, one, rtol=rtol, atol=rtol * scale)


def test_many_recordings_ask_for_the_matrices_of_valid_steps_only():
    steps_s = []

    def matrix(dt_s):
        steps_s.append(dt_s)
        return STRAIGHT.matrix(dt_s)

    custom, dt_s = wl.LinearMotion(matrix, straight_noise), [1.0, -2.0, np.nan, 3.0, 3.0]
    z = np.full((9, 5, 2), 5000.0)
    for sensor in (POSITION, FIRM):
        own, ours = (wl.Kalman(one).run(z, dt_s, sensor, START) for one in (STRAIGHT, custom))
        assert_same(own, ours)
        assert ours.lanes == wl.lanes()
    assert set(steps_s) == {1.0, 3.0}


def test_a_reading_without_a_part_is_read_one_recording_at_a_time():
    z = np.random.default_rng(5).normal(5000.0, 500.0, (9, 5, 2))
    z[4, 2, 1] = np.nan
    together = wl.Kalman(STRAIGHT).run(z, DT_S, FIRM, START)
    assert together.lanes == 1
    alone = wl.Kalman(STRAIGHT).run(z[4], DT_S, FIRM, START)
    np.testing.assert_array_equal(together.mean[4], alone.mean)


def test_a_tracker_of_custom_models_makes_the_tracks_of_the_models():
    radar = wl.Radar(range_std_m=20.0, bearing_std_rad=np.deg2rad(0.5))
    chain = wl.ModeChain.from_sojourn_s([60.0, 30.0])
    random = np.random.default_rng(3)
    trackers = [
        wl.Tracker(radar, estimator=wl.Imm([wl.Ekf(one) for one in models], chain))
        for models in (
            (STRAIGHT, TURN),
            (by_matrices(STRAIGHT), by_matrices(TURN)),
        )
    ]
    for k in range(40):
        position = np.array([2000.0 + 15.0 * k, 1000.0 - 9.0 * k])
        plots = random.normal(polar(position), [20.0, np.deg2rad(0.5)])
        for tracker in trackers:
            tracker.process(3.0 * k, range_m=plots[:1], bearing_rad=plots[1:])
    own, ours = (tracker.tracks() for tracker in trackers)
    assert len(own.track_id) == 1
    np.testing.assert_array_equal(own.track_id, ours.track_id)
    np.testing.assert_allclose(ours.mean, own.mean, rtol=1e-9)
    level = wl.LinearMotion(lambda _: [[1.0]], lambda _: [[1.0]], state=["level"])
    without = wl.Imm([wl.Kalman(level)], wl.ModeChain.from_sojourn_s([60.0]))
    with pytest.raises(ValueError, match="x, vx, y"):
        wl.Tracker(radar, estimator=without)


def test_a_state_without_a_position():
    """A level that drifts, read by a gauge: the scalar Kalman filter."""
    level = wl.LinearMotion(lambda _: [[1.0]], lambda dt_s: [[0.5 * dt_s]], state=["level"])
    gauge = wl.LinearSensor([[1.0]], covariance=[[4.0]], reads=["level"])
    z = np.random.default_rng(2).normal(10.0, 2.0, (20, 1))
    result = wl.Kalman(level).run(z, 1.0, gauge, wl.Gaussian([0.0], [[100.0]]))
    mean, variance = 0.0, 100.0
    for k, reading in enumerate(z[:, 0]):
        variance += 0.5
        gain = variance / (variance + 4.0)
        mean, variance = mean + gain * (reading - mean), (1 - gain) * variance
        np.testing.assert_allclose(
            [result.mean[k, 0], result.covariance[k, 0, 0]], [mean, variance], rtol=1e-12
        )


# Sensors


@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf])
def test_a_sensor_of_a_function_is_the_sensor(kind):
    custom = wl.FunctionSensor(
        polar,
        covariance=np.diag([RADAR.range_std_m, RADAR.bearing_std_rad]) ** 2,
        reads=["x", "y"],
        angles=[1],
    )
    z = readings(miss=(5,))
    for motion in (STRAIGHT, TURNING, by_matrices(TURN)):
        own, ours = (kind(motion).run(z, DT_S, sensor, START) for sensor in (RADAR, custom))
        assert_same(own, ours, rtol=1e-6)
        assert ours.lanes == 0


def test_a_linear_sensor_of_the_position_is_position():
    custom = wl.LinearSensor(
        [[1, 0], [0, 1]], covariance=np.eye(2) * POSITION.position_std_m**2, reads=["x", "y"]
    )
    z = np.random.default_rng(4).normal(5000.0, 100.0, (30, 2))
    for kind in (wl.Kalman, wl.Ekf):
        assert_same(*(kind(STRAIGHT).run(z, DT_S, sensor, START) for sensor in (POSITION, custom)))


@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf])
def test_a_part_of_a_plot_is_a_bearing_or_a_range(kind):
    own = wl.measurement.OwnShip(north_m=50.0, position_std_m=3.0, heading_std_rad=0.002)
    radar = wl.RangeBearing(
        range_std_m=20.0, bearing_std_rad=0.01, extent_std_m=5.0, bearing_offset_rad=0.02, own=own
    )
    bearing = wl.Bearing(bearing_std_rad=0.01, extent_std_m=5.0, bearing_offset_rad=0.02, own=own)
    distance = wl.Range(range_std_m=20.0, extent_std_m=5.0, own=own)
    z = readings()
    for column, sensor in ((1, bearing), (0, distance)):
        part = z.copy()
        part[:, 1 - column] = np.nan
        a = kind(STRAIGHT).run(part, DT_S, radar, START)
        b = kind(STRAIGHT).run(z[:, [column]], DT_S, sensor, START)
        np.testing.assert_allclose(a.mean, b.mean, rtol=1e-9)
        np.testing.assert_allclose(a.nis, b.nis, rtol=1e-6)
        assert np.isnan(a.innovation[:, 1 - column]).all()
        np.testing.assert_allclose(a.innovation[:, [column]], b.innovation, atol=1e-9)


def test_missing_parts_of_readings_are_used_as_such():
    z = np.random.default_rng(4).normal(5000.0, 100.0, (30, 2))
    z[:, 0] = np.nan
    east = wl.LinearSensor([[0, 1]], [[POSITION.position_std_m**2]], reads=["x", "y"])
    part = wl.Kalman(STRAIGHT).run(z, DT_S, POSITION, START)
    whole = wl.Kalman(STRAIGHT).run(z[:, 1:], DT_S, east, START)
    np.testing.assert_allclose(part.mean, whole.mean, rtol=1e-12)
    np.testing.assert_allclose(part.log_likelihood, whole.log_likelihood, rtol=1e-9)

    doppler = wl.RangeBearingDoppler(range_std_m=30.0, bearing_std_rad=np.deg2rad(0.5))
    z3 = np.column_stack([readings(miss=(9,)), np.full(30, np.nan)])
    part = wl.Ekf(STRAIGHT).run(z3, DT_S, doppler, START)
    plain = wl.Ekf(STRAIGHT).run(z3[:, :2], DT_S, RADAR, START)
    np.testing.assert_allclose(part.mean, plain.mean, rtol=1e-12)

    # A plot with a part missing among whole ones, in a Kalman filter too.
    mixed = readings()
    mixed[4, 0] = mixed[8, 1] = np.nan
    for estimator in (wl.Kalman(STRAIGHT), wl.Imm([wl.Ekf(TURN)], wl.ModeChain([[1.0]]))):
        result = estimator.run(mixed, DT_S, CONVERTED, START)
        assert (result.status == int(wl.Status.ok)).all()
        np.testing.assert_array_equal(np.isnan(result.innovation[4]), [True, False])
        _, _, innovation, nis, _ = stepwise(estimator, mixed[:5], sensor=CONVERTED)
        assert np.isnan(innovation[4][0])
        assert nis[4] == pytest.approx(result.nis[4], rel=1e-6)


def test_a_missing_part_counts_in_the_gate_by_the_numbers_there():
    """A range that is 2.9 sigma off: outside the 99 % gate of one number, inside that of two."""
    z = [[4000.0 + 2.9 * RADAR.range_std_m, np.nan]]
    start = wl.Gaussian([4000.0, 0.0, 0.0, 0.0], np.eye(4) * 1e-6)
    gate = wl.ChiSquareGate(probability=0.99)
    result = wl.Ekf(STRAIGHT).run(z, 0.0, RADAR, start, gate=gate)
    assert result.status[0] == int(wl.Status.gated)


def test_bearings_alone_find_a_target_when_own_ship_turns():
    """Own ship's alteration makes the range observable; the error is what the covariance states."""
    random = np.random.default_rng(7)
    normalized = []
    for _ in range(60):
        own = np.array([0.0, 0.0])
        truth = np.array([6000.0, -3.0, 4000.0, -4.0])
        prior = np.diag([1500.0, 4.0, 1500.0, 4.0]) ** 2
        ukf = wl.Ukf(wl.ConstantVelocity(noise=wl.WhiteAcceleration(psd_m2s3=1e-4)))
        ukf.start(wl.Gaussian(random.multivariate_normal(truth, prior), prior))
        for scan in range(120):
            own = own + 10.0 * np.array([0.0, 8.0] if scan < 60 else [8.0, -4.0])
            truth = truth + 10.0 * np.array([truth[1], 0.0, truth[3], 0.0])
            sensor = wl.Bearing(
                bearing_std_rad=np.deg2rad(0.5),
                own=wl.measurement.OwnShip(north_m=own[0], east_m=own[1]),
            )
            ukf.predict(10.0)
            ukf.update(sensor, random.normal(bearing_of(truth[[0, 2]] - own), np.deg2rad(0.5)))
        belief = ukf.estimate()
        normalized.append(wl.eval.nees(belief.mean - truth, belief.covariance) / 4)
    assert np.sqrt(np.trace(belief.covariance[::2, ::2])) < 600.0
    assert np.mean(normalized) < 1.6


# Covariances of readings


def test_a_covariance_of_each_reading_takes_the_place_of_the_sensors():
    random = np.random.default_rng(4)
    z = random.normal(5000.0, 100.0, (3, 30, 2))
    same = np.broadcast_to(np.eye(2) * POSITION.position_std_m**2, (3, 30, 2, 2))
    for estimator in (wl.Kalman(STRAIGHT), wl.Imm([wl.Ekf(TURN)], wl.ModeChain([[1.0]]))):
        assert_same(
            estimator.run(z, DT_S, POSITION, START),
            estimator.run(z, DT_S, POSITION, START, covariance=same),
            rtol=1e-11,
        )
        roots = random.normal(0.0, 30.0, (3, 30, 2, 2)) + 40.0 * np.eye(2)
        each = roots @ roots.swapaxes(-1, -2) + 25.0 * np.eye(2)
        result = estimator.run(z, DT_S, POSITION, START, covariance=each)
        estimator.start(START)
        for k in range(30):
            estimator.predict(DT_S)
            estimator.update(POSITION, z[1, k], covariance=each[1, k])
        np.testing.assert_allclose(estimator.estimate().mean, result.mean[1, -1], rtol=1e-12)


def test_covariances_that_are_none_are_rejected():
    kalman = wl.Kalman(STRAIGHT)
    kalman.start(START)
    z = np.zeros((4, 2)) + 5000.0
    good = np.broadcast_to(np.eye(2), (4, 2, 2)).copy()
    for wrong in ([[1.0, 0.5], [0.0, 1.0]], [[1.0, 2.0], [2.0, 1.0]], [[np.nan, 0], [0, 1.0]]):
        with pytest.raises(ValueError, match="covariance"):
            kalman.update(POSITION, z[0], covariance=wrong)
        bad = good.copy()
        bad[2] = wrong
        with pytest.raises(ValueError, match="2"):
            kalman.run(z, DT_S, POSITION, START, covariance=bad)
    with pytest.raises(ValueError, match=r"\(4, 2, 2\)"):
        kalman.run(z, DT_S, POSITION, START, covariance=good[:3])


# What cannot be used


class Broken(Exception):
    pass


def test_an_exception_of_a_function_comes_from_the_call():
    def broken(x, dt_s):
        raise Broken("here")

    ekf = wl.Ekf(wl.FunctionMotion(broken, lambda x, dt_s: np.eye(4)))
    ekf.start(START)
    with pytest.raises(Broken, match="here"):
        ekf.predict(1.0)
    np.testing.assert_array_equal(ekf.estimate().mean, START.mean)  # nothing changed
    with pytest.raises(Broken):
        ekf.run(readings(), DT_S, RADAR, START)
    imm = wl.Imm([ekf], wl.ModeChain([[1.0]]))
    for call in (imm.run, imm.smooth):
        with pytest.raises(Broken):
            call(readings(), DT_S, RADAR, START)

    ekf = wl.Ekf(STRAIGHT)
    ekf.start(START)
    sensor = wl.FunctionSensor(lambda x: broken(x, 0.0), [[1.0]])
    with pytest.raises(Broken):
        ekf.update(sensor, [1.0])
    with pytest.raises(Broken):
        ekf.run([[1.0]], DT_S, sensor, START)


def test_an_exception_of_a_function_comes_out_of_a_tracker():
    calls = []

    def fails_later(x, dt_s):
        calls.append(dt_s)
        if len(calls) > 200:
            raise Broken
        return [x[0] + dt_s * x[1], x[1], x[2] + dt_s * x[3], x[3]]

    motion = wl.FunctionMotion(fails_later, lambda x, dt_s: STRAIGHT.process_noise(dt_s))
    chain = wl.ModeChain.from_sojourn_s([60.0])
    tracker = wl.Tracker(wl.Radar(), estimator=wl.Imm([wl.Ekf(motion)], chain))
    with pytest.raises(Broken):  # noqa: PT012
        for k in range(200):
            tracker.process(3.0 * k, range_m=[2000.0 + 15.0 * k], bearing_rad=[1.0])


@pytest.mark.parametrize(
    ("result", "word"),
    [
        ([1.0, 2.0, 3.0], r"\(4,\)"),
        (np.zeros((4, 1)), r"\(4, 1\)"),
        ([1.0, np.inf, 0.0, 0.0], "finite"),
        ("text", "text"),
        (None, "None"),
    ],
)
def test_results_of_another_kind_name_the_function(result, word):
    def my_transition(x, dt_s):
        return result

    ekf = wl.Ekf(wl.FunctionMotion(my_transition, lambda x, dt_s: np.eye(4)))
    ekf.start(START)
    with pytest.raises(ValueError, match=word) as caught:
        ekf.predict(1.0)
    assert "my_transition" in str(caught.value)
    assert "transition of" in str(caught.value)


def test_matrices_that_are_none_are_rejected_where_the_model_is_made():
    noise = STRAIGHT.process_noise
    for matrix in (lambda dt_s: np.eye(3), lambda dt_s: np.full((4, 4), np.nan)):
        with pytest.raises(ValueError, match="matrix"):
            wl.LinearMotion(matrix, noise)
    for bad in (-np.eye(4), np.triu(np.ones((4, 4)))):
        with pytest.raises(ValueError, match="process_noise"):
            wl.LinearMotion(STRAIGHT.matrix, lambda dt_s, bad=bad: bad)
    with pytest.raises(TypeError, match="matrix"):
        wl.LinearMotion(np.eye(4), noise)
    for state in ([], ["x"] * 4, list("abcdefghij"), ["x", "y", "vx", "vy"]):
        with pytest.raises(ValueError, match="state"):
            wl.LinearMotion(STRAIGHT.matrix, noise, state=state)
    with pytest.raises(ValueError, match="bias"):
        wl.LinearMotion(STRAIGHT.matrix, noise, prior_std={"bias": 1.0})
    with pytest.raises(TypeError, match="linear"):
        wl.Kalman(by_functions(TURNING, TURNING_STATE))


def test_sensors_that_cannot_be_used_say_why():
    with pytest.raises(ValueError, match="covariance"):
        wl.LinearSensor([[1, 0, 0, 0]], [[-1.0]])
    with pytest.raises(ValueError, match=r"\(1, 4\)"):
        wl.LinearSensor([[1, 0, 0]], [[1.0]])
    with pytest.raises(ValueError, match=r"\(M, M\)"):
        wl.LinearSensor(np.eye(5), np.eye(5), reads=list("abcde"))
    with pytest.raises(ValueError, match="angles"):
        wl.FunctionSensor(bearing_of, [[1.0]], angles=[1])
    gauge = wl.LinearSensor([[1.0]], [[1.0]], reads=["level"])
    ekf = wl.Ekf(STRAIGHT)
    ekf.start(START)
    with pytest.raises(ValueError, match="level"):
        ekf.update(gauge, [1.0])
    with pytest.raises(ValueError, match="level"):
        wl.Imm([ekf], wl.ModeChain([[1.0]])).run([[1.0]], DT_S, gauge, START)
    with pytest.raises(ValueError, match="linear"):
        wl.Kalman(STRAIGHT).run([[1.0]], DT_S, wl.Bearing(), START)
    with pytest.raises(TypeError, match="sensor"):
        wl.AlphaBeta(wl.ConstantGains(alpha=0.5, beta=0.2)).run([[1.0]], DT_S, wl.Bearing(), START)
    with pytest.raises(ValueError, match="gate"):
        ekf.run([[1.0]], DT_S, wl.Bearing(), START, gate=wl.RadiusGate(radius_m=10.0))


def test_filters_of_custom_models_are_copied_pickled_and_saved():
    motion = wl.LinearMotion(straight_matrix, straight_noise)
    assert "straight_matrix" in repr(motion)
    for make in (wl.Kalman, wl.Ekf, wl.Ukf):
        one = make(motion)
        one.start(START)
        one.predict(2.0)
        others = (copy.copy(one), copy.deepcopy(one), pickle.loads(pickle.dumps(one)))
        one.predict(1.0)
        for other in others:
            assert type(other) is type(one)
            other.predict(1.0)
            np.testing.assert_array_equal(one.estimate().mean, other.estimate().mean)
            np.testing.assert_array_equal(one.estimate().covariance, other.estimate().covariance)
    sensor = wl.FunctionSensor(bearing_of, [[0.01]], reads=["x", "y"], angles=[0])
    again = pickle.loads(pickle.dumps(sensor))
    assert again.reads == ["x", "y"]
    assert again.angles == [0]
    np.testing.assert_array_equal(again.measure([1.0, 1.0]), sensor.measure([1.0, 1.0]))


NUMBERS = ctypes.POINTER(ctypes.c_double)
OF_STEP = ctypes.CFUNCTYPE(None, NUMBERS, ctypes.c_double, NUMBERS)
OF_STATE = ctypes.CFUNCTYPE(None, NUMBERS, NUMBERS)


def compiled(function, size, of=OF_STEP):
    """As `numba.cfunc` makes it, but for its speed: numbers in and out by their address."""

    def write(x, *rest):
        *dt_s, result = rest
        for k, number in enumerate(np.ravel(function(np.array(x[:size]), *dt_s))):
            result[k] = number

    return of(write)


@pytest.mark.parametrize("with_jacobian", [True, False])
def test_compiled_functions_give_the_results_of_functions(with_jacobian):
    z = np.stack([readings(seed=seed) for seed in range(5)])
    prior = {"prior_std": {"omega": TURNING.prior_turn_rate_std_rad_s}}
    of_python = by_functions(TURNING, TURNING_STATE, with_jacobian, **prior)
    functions = [TURNING.transition, TURNING.process_noise]
    if with_jacobian:
        functions.append(TURNING.jacobian)
    transition, noise, *jacobian = (compiled(one, 5) for one in functions)
    custom = wl.FunctionMotion(transition, noise, TURNING_STATE, *jacobian, **prior)
    radar = wl.FunctionSensor(
        compiled(RADAR.measure, 2, OF_STATE),
        np.diag([RADAR.range_std_m, RADAR.bearing_std_rad]) ** 2,
        reads=["x", "y"],
        jacobian=compiled(RADAR.jacobian, 2, OF_STATE) if with_jacobian else None,
        angles=[1],
    )
    for kind in (wl.Ekf, wl.Ukf):
        ours = kind(custom).run(z, DT_S, RADAR, START)
        assert ours.lanes == 1  # no step waits for Python
        assert_same(kind(of_python).run(z, DT_S, RADAR, START), ours)
        heard = kind(custom).run(z, DT_S, radar, START)
        assert heard.lanes == 1
        assert_same(ours, heard, rtol=1e-12 if with_jacobian or kind is wl.Ukf else 1e-6)


def test_a_compiled_function_that_writes_nothing_fails_its_step():
    silent = compiled(lambda *_: [], 4)
    ekf = wl.Ekf(wl.FunctionMotion(silent, silent))
    ekf.start(START)
    with pytest.raises(wl.FilterError, match="finite"):
        ekf.predict(1.0)
    np.testing.assert_array_equal(ekf.estimate().mean, START.mean)


def test_a_function_compiled_for_other_arguments_is_rejected():
    for_sensor = compiled(bearing_of, 2, OF_STATE)
    for wrong in (for_sensor, ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(abs)):
        with pytest.raises(ValueError, match="transition"):
            wl.FunctionMotion(wrong, straight_noise)
    with pytest.raises(ValueError, match="measure"):
        wl.FunctionSensor(OF_STEP(lambda *_: None), [[1.0]], reads=["x", "y"])
