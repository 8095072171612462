"""Consistency bounds, and the bound of errors."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl


def test_the_textbooks_bounds():
    # Bar-Shalom, Li, Kirubarajan 2001, example 5.4.2: 50 runs of 2 states, 95 %.
    lower, upper = wl.consistency_bounds(0.95, 2, 50)
    assert (lower, upper) == (pytest.approx(1.5, abs=0.02), pytest.approx(2.6, abs=0.02))


@given(st.floats(0.01, 0.999), st.integers(1, 12), st.integers(1, 1000))
def test_bounds_enclose_the_median_and_hold_their_confidence(confidence, dof, samples):
    lower, upper = wl.consistency_bounds(confidence, dof, samples)
    median = wl.chi_square_quantile(0.5, dof * samples) / samples
    assert lower < median < upper
    inside = wl.chi_square_probability(upper * samples, dof * samples) - wl.chi_square_probability(
        lower * samples, dof * samples
    )
    assert inside == pytest.approx(confidence, abs=1e-9)


@given(st.integers(1, 12), st.integers(1, 1000))
def test_more_samples_narrow_the_bounds(dof, samples):
    narrow, wide = (wl.consistency_bounds(0.95, dof, n) for n in (2 * samples, samples))
    assert narrow[1] - narrow[0] < wide[1] - wide[0]


@pytest.mark.parametrize(
    ("wrong", "wanted"),
    [
        ((0.0, 1, 1), "confidence must be between 0 and 1, got 0"),
        ((1.0, 1, 1), "confidence must be between 0 and 1, got 1"),
        ((np.nan, 1, 1), "confidence must be between 0 and 1, got nan"),
        ((0.95, 0, 1), "dof must be at least 1, got 0"),
        ((0.95, 1, 0), "samples must be at least 1, got 0"),
    ],
)
def test_what_is_invalid_is_rejected(wrong, wanted):
    with pytest.raises(ValueError, match=wanted):
        wl.consistency_bounds(*wrong)


# The posterior Cramér-Rao bound ------------------------------------------------------------------

SCANS = 12
TURN = wl.CoordinatedTurn(turn_rate_rad_s=0.02, noise=wl.PiecewiseAcceleration(std_mps2=0.1))
PRIOR = np.diag([100.0, 1.0, 100.0, 1.0])
STATES = np.array([[1500.0 + 20 * k, 7.0, -800.0 + 9 * k, 3.0] for k in range(SCANS)])
RADAR = wl.RangeBearing(range_std_m=60.0, bearing_std_rad=0.01)


def bound(**change):
    usual = {
        "transition": np.broadcast_to(TURN.matrix(3.0), (SCANS, 4, 4)),
        "process_noise": np.broadcast_to(TURN.process_noise(3.0), (SCANS, 4, 4)),
        "states": STATES,
        "sensor": RADAR,
        "start_covariance": PRIOR,
    }
    return wl.eval.cramer_rao_bound(**(usual | change))


def test_the_bound_of_a_linear_sensor_is_the_kalman_covariance():
    sensor = wl.Position(position_std_m=25.0)
    z = STATES[:, 0::2].copy()
    z[[3, 4]] = np.nan
    found = wl.Ekf(TURN).run(z, dt_s=3.0, sensor=sensor, start=wl.Gaussian(STATES[0], PRIOR))
    states = STATES.copy()
    states[[3, 4]] = np.nan
    got = bound(sensor=sensor, states=states)
    np.testing.assert_allclose(got, found.covariance, rtol=1e-9, atol=1e-9)


def test_a_missed_scan_is_one_without_a_chance():
    missed = np.full_like(STATES, np.nan)
    never = bound(detection_probability=0.0)
    np.testing.assert_allclose(bound(states=missed), never, rtol=1e-12, atol=1e-12)
    growing = np.trace(bound(states=missed), axis1=1, axis2=2)
    assert (np.diff(growing) > 0).all()


def test_a_converted_reading_holds_no_more_than_its_plot():
    converted = wl.ConvertedRangeBearing(range_std_m=60.0, bearing_std_rad=0.01)
    np.testing.assert_array_equal(bound(sensor=converted), bound())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"states": STATES[:, :3]}, r"states must have shape \(T, 4\), got \(12, 3\)"),
        ({"transition": np.zeros((11, 4, 4))}, r"transition .*\(12, 4, 4\), got \(11, 4, 4\)"),
        ({"process_noise": np.zeros((4, 4))}, r"process_noise .*\(12, 4, 4\), got \(4, 4\)"),
        ({"start_covariance": np.eye(3)}, "start_covariance"),
        ({"start_covariance": -np.eye(4)}, "start_covariance must be finite, symmetric and pos"),
        ({"detection_probability": 1.5}, "detection_probability must be from 0 to 1, got 1.5"),
        ({"detection_probability": np.nan}, "detection_probability must be from 0 to 1, got nan"),
    ],
)
def test_bounds_that_are_invalid(change, message):
    with pytest.raises(ValueError, match=message):
        bound(**change)


def test_nothing_is_learnt_right_at_the_antenna():
    there = np.where(np.arange(SCANS)[:, np.newaxis] == 0, [[0.0, 7.0, 0.0, 3.0]], STATES)
    missed = np.where(np.arange(SCANS)[:, np.newaxis] == 0, np.nan, STATES)
    np.testing.assert_allclose(bound(states=there), bound(states=missed), rtol=1e-12, atol=1e-12)


def test_a_bound_that_cannot_be_said_names_the_scan():
    transition = np.broadcast_to(TURN.matrix(3.0), (SCANS, 4, 4)).copy()
    transition[2, 1, 1] = np.nan
    with pytest.raises(wl.FilterError, match="scan 2"):
        bound(transition=transition)
