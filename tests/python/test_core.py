"""Beliefs, angles and the chi-square law at the border to Python."""

import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import wakeline as wl

finite = st.floats(-1e6, 1e6)


@given(hnp.arrays(float, st.integers(1, 8), elements=finite))
def test_a_gaussian_gives_back_what_it_was_made_of(mean):
    covariance = np.diag(1.0 + np.abs(mean))
    belief = wl.Gaussian(mean, covariance)
    np.testing.assert_array_equal(belief.mean, mean)
    np.testing.assert_array_equal(belief.covariance, covariance)


@given(st.integers(0, 5), st.integers(0, 5), st.integers(0, 5))
def test_a_gaussian_of_wrong_shape_names_argument_wanted_and_given(states, rows, columns):
    if (rows, columns) == (states, states):
        return
    with pytest.raises(ValueError, match="covariance must have shape") as error:
        wl.Gaussian(np.zeros(states), np.zeros((rows, columns)))
    assert f"({states}, {states})" in str(error.value)
    assert f"got ({rows}, {columns})" in str(error.value)


@pytest.mark.parametrize("mean", [3.0, np.zeros((2, 2))])
def test_a_mean_must_be_a_vector(mean):
    with pytest.raises(ValueError, match=r"mean must have shape \(N,\), got"):
        wl.Gaussian(mean, np.eye(2))


def test_a_gaussian_goes_through_pickle():
    belief = wl.Gaussian([1.0, 2.0], [[2.0, 0.5], [0.5, 1.0]])
    again = pickle.loads(pickle.dumps(belief))
    np.testing.assert_array_equal(again.mean, belief.mean)
    np.testing.assert_array_equal(again.covariance, belief.covariance)


def test_a_gaussian_holds_a_copy():
    mean, covariance = np.zeros(2), np.eye(2)
    belief = wl.Gaussian(mean, covariance)
    mean += 1.0
    covariance += 1.0
    np.testing.assert_array_equal(belief.mean, [0.0, 0.0])
    np.testing.assert_array_equal(belief.covariance, np.eye(2))


@pytest.mark.parametrize("dtype", [np.float32, np.int64, np.uint8, np.bool_])
def test_other_dtypes_lists_and_strides_are_taken_by_value(dtype):
    mean = np.array([1, 0, 1, 1], dtype=dtype)
    wide = np.arange(64.0).reshape(8, 8)
    for given_mean, given_covariance in (
        (mean, wide[::2, ::2]),
        (mean.tolist(), wide[::2, ::2].tolist()),
        (np.repeat(mean, 3)[::3], np.asfortranarray(wide[::2, ::2])),
    ):
        belief = wl.Gaussian(given_mean, given_covariance)
        np.testing.assert_array_equal(belief.mean, [1.0, 0.0, 1.0, 1.0])
        np.testing.assert_array_equal(belief.covariance, wide[::2, ::2])


@given(st.floats(-1e4, 1e4))
def test_a_wrapped_angle_is_the_same_direction_in_range(angle_rad):
    wrapped = wl.wrap_angle(angle_rad)
    assert -np.pi <= wrapped <= np.pi
    np.testing.assert_allclose(
        [np.cos(wrapped), np.sin(wrapped)], [np.cos(angle_rad), np.sin(angle_rad)], atol=1e-9
    )


def test_angles_wrap_by_element():
    angles = np.deg2rad([[0.0, 359.0], [181.0, -541.0]])
    np.testing.assert_allclose(
        np.rad2deg(wl.wrap_angle(angles)), [[0.0, -1.0], [-179.0, 179.0]], atol=1e-9
    )


def test_an_angle_that_is_masked_is_none_and_times_are_no_angles():
    wrapped = wl.wrap_angle(np.ma.array([7.0, 7.0], mask=[True, False]))
    np.testing.assert_allclose(wrapped, [np.nan, 7.0 - 2 * np.pi])
    with pytest.raises(TypeError, match="real numbers"):
        wl.wrap_angle(np.array(["2026-01-01"], dtype="M8[D]"))
    assert type(wl.wrap_angle(7)) is float
    assert wl.wrap_angle(np.zeros((2, 0))).shape == (2, 0)
    np.testing.assert_array_equal(wl.wrap_angle(np.arange(6.0)[::-2]), [5 - 2 * np.pi, 3.0, 1.0])


# Abramowitz and Stegun, table 26.8 (upper tail probabilities).
@pytest.mark.parametrize(
    ("probability", "dof", "value"),
    [
        (0.95, 1, 3.84146),
        (0.95, 2, 5.99146),
        (0.99, 2, 9.21034),
        (0.999, 3, 16.2662),
        (0.05, 4, 0.710721),
        (0.5, 10, 9.34182),
        (0.975, 100, 129.561),
        (0.025, 100, 74.2219),
    ],
)
def test_chi_square_quantiles_of_the_textbook(probability, dof, value):
    assert wl.chi_square_quantile(probability, dof) == pytest.approx(value, rel=5e-6)


@given(st.floats(1e-9, 1 - 1e-9), st.floats(0.5, 5000.0))
def test_quantile_and_probability_are_inverse(probability, dof):
    value = wl.chi_square_quantile(probability, dof)
    assert wl.chi_square_probability(value, dof) == pytest.approx(probability, rel=1e-9, abs=1e-12)


@given(st.floats(0.0, 100.0))
def test_two_degrees_of_freedom_have_a_closed_form(value):
    assert wl.chi_square_probability(value, 2) == pytest.approx(-math.expm1(-value / 2), rel=1e-12)


def test_the_ends_of_the_chi_square_law():
    assert wl.chi_square_quantile(0.0, 3) == 0.0
    assert wl.chi_square_quantile(1.0, 3) == np.inf
    assert wl.chi_square_probability(-1.0, 3) == 0.0
    assert wl.chi_square_probability(np.inf, 3) == 1.0


@pytest.mark.parametrize(("x", "dof"), [(np.nan, 2), (-0.1, 2), (1.1, 2), (0.5, 0), (0.5, -1)])
def test_a_quantile_that_does_not_exist_is_nan(x, dof):
    assert np.isnan(wl.chi_square_quantile(x, dof))


def test_names_of_the_status_values():
    assert {status.name for status in wl.Status.__members__.values()} == {
        "ok",
        "missed",
        "not_started",
        "not_finite",
        "not_positive_definite",
        "negative_time_step",
        "gated",
    }
    assert int(wl.Status.ok) == 0


def test_a_status_is_its_number():
    status = np.array([0, 1, 0], dtype=np.uint8)
    assert (status == wl.Status.missed).tolist() == [False, True, False]
    assert (status != wl.Status.ok).tolist() == [False, True, False]
    assert np.isin(status, [wl.Status.missed]).tolist() == [False, True, False]
    assert {wl.Status.missed: "m"}[1] == "m"


def test_a_status_is_shown_as_its_name():
    assert [str(status) for status in wl.Status] == [status.name for status in wl.Status]
    assert f"{wl.Status.gated}, {wl.Status.ok:>4}, {wl.Status.gated:02d}" == "gated,   ok, 06"


def test_a_filter_error_is_a_runtime_error():
    assert issubclass(wl.FilterError, RuntimeError)


def test_every_noun_is_a_module_and_its_names_stand_at_the_top():
    import wakeline.filter as nouns

    assert nouns.Ekf is wl.Ekf
    for name in wl.__all__:
        assert getattr(wl, name) is not None
