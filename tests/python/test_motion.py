"""Motion models in Python: laws of time, limits, and rejected parameters."""

import copy

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl
from cases import LINEAR_MOTIONS, MOTIONS

steps = st.floats(0.01, 60.0)
rates = st.floats(-0.5, 0.5)
NONLINEAR = sorted(set(MOTIONS) - set(LINEAR_MOTIONS))


def a_state(motion):
    return np.array([100.0, 6.0, -50.0, -8.0, 0.02, 0.1])[: motion.states]


@pytest.mark.parametrize("name", LINEAR_MOTIONS)
@given(first=steps, second=steps)
def test_two_steps_are_one_long_step(name, first, second):
    motion = LINEAR_MOTIONS[name]
    np.testing.assert_allclose(
        motion.matrix(first + second), motion.matrix(second) @ motion.matrix(first), atol=1e-7
    )
    f = motion.matrix(second)
    joined = f @ motion.process_noise(first) @ f.T + motion.process_noise(second)
    whole = motion.process_noise(first + second)
    np.testing.assert_allclose(joined, whole, atol=1e-9 * np.abs(whole).max())


@pytest.mark.parametrize("name", LINEAR_MOTIONS)
def test_no_time_changes_nothing(name):
    motion = LINEAR_MOTIONS[name]
    np.testing.assert_array_equal(motion.matrix(0.0), np.eye(motion.states))
    np.testing.assert_array_equal(motion.process_noise(0.0), np.zeros((motion.states,) * 2))


@pytest.mark.parametrize("name", MOTIONS)
@given(dt_s=steps)
def test_process_noise_is_symmetric_and_not_negative(name, dt_s):
    motion = MOTIONS[name]
    q = (
        motion.process_noise(dt_s)
        if name in LINEAR_MOTIONS
        else motion.process_noise(a_state(motion), dt_s)
    )
    np.testing.assert_allclose(q, q.T, rtol=1e-14)
    assert np.linalg.eigvalsh(q).min() >= -1e-9 * np.abs(q).max()


@pytest.mark.parametrize("name", NONLINEAR)
@given(dt_s=st.floats(0.1, 10.0), course=st.floats(-3.1, 3.1), speed=st.floats(1.0, 30.0))
def test_the_jacobian_is_the_slope(name, dt_s, course, speed):
    motion = MOTIONS[name]
    x = a_state(motion)
    x[1], x[3] = speed * np.cos(course), speed * np.sin(course)
    h = 1e-5
    slope = [
        (motion.transition(x + e, dt_s) - motion.transition(x - e, dt_s)) / (2 * h)
        for e in h * np.eye(motion.states)
    ]
    np.testing.assert_allclose(
        motion.jacobian(x, dt_s), np.transpose(slope), rtol=1e-5, atol=1e-5 * speed * dt_s**2
    )


@given(rates, steps)
def test_a_turn_keeps_the_speed_and_adds_to_the_course(rate, dt_s):
    before = a_state(wl.CoordinatedTurn())
    after = wl.CoordinatedTurn(turn_rate_rad_s=rate).matrix(dt_s) @ before
    assert np.hypot(after[1], after[3]) == pytest.approx(np.hypot(before[1], before[3]))
    turned = np.arctan2(after[3], after[1]) - np.arctan2(before[3], before[1])
    assert wl.wrap_angle(turned - rate * dt_s) == pytest.approx(0.0, abs=1e-9)


def test_a_positive_rate_turns_to_starboard():
    north = np.array([0.0, 10.0, 0.0, 0.0])
    after = wl.CoordinatedTurn(turn_rate_rad_s=0.1).matrix(1.0) @ north
    assert after[3] > 0.0  # towards east


@given(st.floats(-1e-6, 1e-6), st.floats(0.1, 10.0))
def test_a_turn_becomes_a_straight_line(rate, dt_s):
    straight = wl.ConstantVelocity(noise=wl.WhiteAcceleration(psd_m2s3=1.0))
    turn = wl.CoordinatedTurn(turn_rate_rad_s=rate, noise=wl.WhiteAcceleration(psd_m2s3=1.0))
    np.testing.assert_allclose(turn.matrix(dt_s), straight.matrix(dt_s), atol=1e-4)
    np.testing.assert_allclose(turn.process_noise(dt_s), straight.process_noise(dt_s), atol=1e-2)


@given(st.floats(-0.3, 0.3), st.floats(0.1, 10.0))
def test_a_rate_in_the_state_turns_as_the_known_rate_does(rate, dt_s):
    x = np.array([100.0, 6.0, -50.0, -8.0, rate])
    known = wl.CoordinatedTurn(turn_rate_rad_s=rate).matrix(dt_s) @ x[:4]
    np.testing.assert_allclose(
        wl.CoordinatedTurnRate().transition(x, dt_s), [*known, rate], atol=1e-9
    )


@given(st.floats(0.1, 30.0), st.floats(0.01, 2.0))
def test_piecewise_acceleration_is_the_papers_form(dt_s, std):
    gain = np.array([[dt_s**2 / 2, 0], [dt_s, 0], [0, dt_s**2 / 2], [0, dt_s]])
    motion = wl.ConstantVelocity(noise=wl.PiecewiseAcceleration(std_mps2=std))
    np.testing.assert_allclose(motion.process_noise(dt_s), gain @ gain.T * std**2, rtol=1e-12)


@given(st.floats(0.1, 30.0), st.floats(0.01, 2.0))
def test_white_acceleration_is_the_textbooks_form(dt_s, psd):
    axis = psd * np.array([[dt_s**3 / 3, dt_s**2 / 2], [dt_s**2 / 2, dt_s]])
    motion = wl.ConstantVelocity(noise=wl.WhiteAcceleration(psd_m2s3=psd))
    np.testing.assert_allclose(
        motion.process_noise(dt_s), np.kron(np.eye(2), axis), rtol=1e-12, atol=0
    )


@pytest.mark.parametrize(
    ("build", "name"),
    [
        (lambda v: wl.ConstantVelocity(noise=wl.WhiteAcceleration(psd_m2s3=v)), "psd_m2s3"),
        (lambda v: wl.ConstantVelocity(noise=wl.PiecewiseAcceleration(std_mps2=v)), "std_mps2"),
        (lambda v: wl.ConstantAcceleration(noise=wl.WhiteJerk(psd_m2s5=v)), "psd_m2s5"),
        (lambda v: wl.Singer(maneuver_time_s=v), "maneuver_time_s"),
        (lambda v: wl.Singer(accel_std_mps2=v), "accel_std_mps2"),
        (lambda v: wl.CoordinatedTurnRate(turn_rate_psd_rad2s3=v), "turn_rate_psd_rad2s3"),
        (lambda v: wl.CoordinatedTurnRate(turn_rate_time_s=v), "turn_rate_time_s"),
        (lambda v: wl.WanderingCourse(psd_m2s3=v), "psd_m2s3"),
    ],
)
@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_parameters_that_are_invalid_are_rejected_by_name(build, name, value):
    with pytest.raises(ValueError, match=name):
        build(value)


def test_a_turn_rate_must_be_finite():
    with pytest.raises(ValueError, match="turn_rate_rad_s"):
        wl.CoordinatedTurn(turn_rate_rad_s=np.nan)


def test_a_model_without_acceleration_rejects_jerk():
    with pytest.raises(ValueError, match=r"[Jj]erk|psd_m2s5|noise"):
        wl.ConstantVelocity(noise=wl.WhiteJerk(psd_m2s5=0.1))


def test_parameters_are_given_by_name():
    with pytest.raises(TypeError):
        wl.CoordinatedTurn(0.1)


@given(st.integers(0, 8).filter(lambda n: n != 5))
def test_a_state_of_wrong_size_is_rejected(size):
    with pytest.raises(ValueError, match=rf"x must have shape \(5,\), got \({size},\)"):
        wl.CoordinatedTurnRate().transition(np.zeros(size), 1.0)


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("dt_s", [-3.0, np.nan, np.inf])
def test_no_step_goes_back_or_for_ever(name, dt_s):
    motion = MOTIONS[name]
    state = () if name in LINEAR_MOTIONS else (a_state(motion),)
    for of_step in ("matrix", "transition", "jacobian", "process_noise"):
        if hasattr(motion, of_step):
            with pytest.raises(ValueError, match="dt_s must be finite and not negative"):
                getattr(motion, of_step)(*state, dt_s)


@pytest.mark.parametrize("name", MOTIONS)
def test_a_model_copies(name):
    assert (
        repr(copy.deepcopy(MOTIONS[name])) == repr(copy.copy(MOTIONS[name])) == repr(MOTIONS[name])
    )
