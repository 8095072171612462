"""Consistency bounds."""

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
    "wrong", [(0.0, 1, 1), (1.0, 1, 1), (np.nan, 1, 1), (0.95, 0, 1), (0.95, 1, 0)]
)
def test_what_makes_no_sense_is_refused(wrong):
    with pytest.raises(ValueError, match="confidence must lie between 0 and 1"):
        wl.consistency_bounds(*wrong)
