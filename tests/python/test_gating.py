"""Gates."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl


@given(st.floats(0.01, 0.9999), st.integers(1, 6))
def test_the_gate_holds_its_probability(probability, dof):
    threshold = wl.ChiSquareGate(probability=probability).threshold(dof)
    assert wl.chi_square_probability(threshold, dof) == pytest.approx(probability, rel=1e-9)


def test_the_textbooks_gates():
    assert wl.ChiSquareGate(probability=0.99).threshold(2) == pytest.approx(9.21, abs=5e-3)
    assert wl.ChiSquareGate(probability=0.95).threshold(1) == pytest.approx(3.84, abs=5e-3)


def test_the_gate_holds_its_share_of_innovations():
    rng = np.random.default_rng(3)
    nis = (rng.standard_normal((100_000, 2)) ** 2).sum(axis=1)
    inside = (nis <= wl.ChiSquareGate(probability=0.9).threshold(2)).mean()
    assert inside == pytest.approx(0.9, abs=0.005)


@given(st.floats(1.0, 1e4), st.floats(0.0, 2e4), st.floats(-np.pi, np.pi), st.floats(-1e5, 1e5))
def test_a_circle_holds_what_is_near(radius_m, distance_m, angle_rad, north_m):
    if abs(distance_m - radius_m) < 1e-6:
        return
    gate = wl.RadiusGate(radius_m=radius_m)
    plot = [north_m + distance_m * np.cos(angle_rad), distance_m * np.sin(angle_rad)]
    assert gate.contains([north_m, 0.0], plot) == (distance_m < radius_m)


def test_nan_is_in_no_gate():
    assert not wl.RadiusGate(radius_m=10.0).contains([0.0, 0.0], [np.nan, 0.0])


@pytest.mark.parametrize("probability", [0.0, -0.1, 1.0, 1.1, np.nan])
def test_a_gate_probability_that_is_invalid_is_rejected(probability):
    with pytest.raises(ValueError, match="probability"):
        wl.ChiSquareGate(probability=probability)


@pytest.mark.parametrize("radius_m", [-1.0, np.nan, np.inf])
def test_a_radius_that_is_invalid_is_rejected(radius_m):
    with pytest.raises(ValueError, match="radius_m"):
        wl.RadiusGate(radius_m=radius_m)


def test_a_plot_of_wrong_shape_is_rejected():
    with pytest.raises(ValueError, match=r"plot_m must have shape \(2,\), got \(3,\)"):
        wl.RadiusGate(radius_m=1.0).contains([0.0, 0.0], [0.0, 0.0, 0.0])
