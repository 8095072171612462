"""Curves of many runs: means between switches, settling, delays, right models, consistency."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl
from wakeline import metrics

TIME_S = 3.0 * np.arange(1, 21)
SWITCHES_S = np.array([15.0, 31.0])  # one on a reading, one between two
FIRST, SECOND, THIRD = slice(0, 5), slice(5, 10), slice(10, 20)

curves = st.lists(st.floats(0.01, 100.0), min_size=20, max_size=20).map(np.array)
switches = st.lists(st.integers(1, 119), max_size=5, unique=True).map(
    lambda halves: 0.5 * np.array(sorted(halves), dtype=float)
)

# ------------------------------------------------------------------ RMSE and segments


@given(st.integers(1, 5), st.integers(1, 4), st.integers(1, 3), st.integers(0, 2**32))
def test_a_curve_is_the_root_mean_square_length_at_each_time(runs, scans, components, seed):
    error = np.random.default_rng(seed).normal(size=(runs, scans, components))
    curve = metrics.rmse_curve(error)
    for k in range(scans):
        assert curve[k] ** 2 == pytest.approx(np.mean([e @ e for e in error[:, k]]))
    assert metrics.rmse_curve(-3.0 * error) == pytest.approx(3.0 * curve)


@pytest.mark.parametrize("shape", [(3, 2), (0, 3, 2)])
def test_a_curve_needs_runs_times_and_components(shape):
    with pytest.raises(ValueError, match=r"error must have shape \(R, T, d\) .* got \("):
        metrics.rmse_curve(np.zeros(shape))


def test_a_reading_at_a_switch_still_belongs_to_the_segment_that_ends():
    curve = np.arange(20.0)
    first, second, third = metrics.by_segment(TIME_S, curve, SWITCHES_S)
    assert (first.begin_s, first.end_s, first.scans) == (3.0, 15.0, 5)
    assert (second.begin_s, second.end_s, second.scans) == (15.0, 31.0, 5)
    assert (third.begin_s, third.end_s, third.scans) == (31.0, 60.0, 10)
    for segment, part in ((first, FIRST), (second, SECOND), (third, THIRD)):
        assert (segment.mean, segment.peak) == (curve[part].mean(), curve[part].max())


@given(curves, switches)
def test_segments_part_the_readings(curve, switches_s):
    segments = metrics.by_segment(TIME_S, curve, switches_s)
    assert sum(segment.scans for segment in segments) == len(curve)
    assert sum(s.scans * s.mean for s in segments) == pytest.approx(curve.sum())
    assert max(segment.peak for segment in segments) == curve.max()
    assert all(a.end_s <= b.begin_s for a, b in itertools.pairwise(segments))
    assert (segments[0].begin_s, segments[-1].end_s) == (TIME_S[0], TIME_S[-1])


@pytest.mark.parametrize(
    ("time_s", "curve", "switches_s", "message"),
    [
        ([1.0, 2.0], [1.0], [], r"same shape \(T,\).*\(2,\) and \(1,\)"),
        ([], [], [], "T at least 1"),
        ([1.0, 1.0], [1.0, 1.0], [], "time_s must be finite and increase"),
        ([1.0, np.nan], [1.0, 1.0], [], "time_s must be finite and increase"),
        ([1.0, 2.0], [1.0, 1.0], [2.0, 1.0], "switch_times_s must be finite and increase"),
        ([1.0, 2.0], [1.0, 1.0], [[1.0]], r"switch_times_s must have shape \(S,\)"),
    ],
)
def test_curves_that_are_invalid(time_s, curve, switches_s, message):
    for figure in (
        metrics.by_segment,
        metrics.settling_times_s,
        metrics.detection_delays_scans,
    ):
        with pytest.raises(ValueError, match=message):
            figure(time_s, curve, switches_s)


# ------------------------------------------------------------------ settling and detection


def test_settling_is_from_the_switch_to_the_first_reading_that_stays_calm():
    curve = np.ones(20)
    curve[5:8] = 5.0  # at 18, 21 and 24 s; calm from 27 s on
    curve[12] = 3.0  # the third segment rises late, at 39 s; calm from 42 s on
    assert metrics.settling_times_s(TIME_S, curve, SWITCHES_S) == pytest.approx([12.0, 11.0])
    assert metrics.settling_times_s(TIME_S, np.ones(20), SWITCHES_S) == pytest.approx([0.0, 0.0])


def test_settling_is_at_most_what_there_is_of_the_segment():
    curve = np.ones(20)
    curve[5:10] = [1.0, 1.0, 1.0, 1.0, 9.0]
    assert metrics.settling_times_s(TIME_S, curve, SWITCHES_S)[0] == 30.0 - 15.0


def test_a_segment_without_a_reading_does_not_settle_nor_detect():
    switches_s = [15.0, 15.5, 16.0]
    assert np.isnan(metrics.settling_times_s(TIME_S, np.ones(20), switches_s)[:2]).all()
    assert np.isnan(metrics.detection_delays_scans(TIME_S, np.ones(20), switches_s)[:2]).all()


@given(curves, switches, st.floats(0.0, 10.0))
def test_settling_knows_no_unit_and_is_sooner_with_a_larger_factor(curve, switches_s, more):
    settled_s = metrics.settling_times_s(TIME_S, curve, switches_s)
    np.testing.assert_array_equal(
        metrics.settling_times_s(TIME_S, 4.0 * curve, switches_s), settled_s
    )
    lax_s = metrics.settling_times_s(TIME_S, curve, switches_s, factor=1.2 + more)
    known = np.isfinite(settled_s)
    assert (0 <= lax_s[known]).all()
    assert (lax_s[known] <= settled_s[known]).all()


def test_the_delay_counts_readings_before_the_right_model_leads():
    right = np.zeros(20)
    right[FIRST] = 1.0
    right[[7, 8, 9]] = [0.5, 0.2, 1.0]
    assert metrics.detection_delays_scans(TIME_S, right, SWITCHES_S) == pytest.approx([2, 10])
    assert metrics.detection_delays_scans(TIME_S, right, SWITCHES_S, share=0.6) == pytest.approx(
        [4, 10]
    )
    assert metrics.detection_delays_scans(TIME_S, np.ones(20), SWITCHES_S) == pytest.approx([0, 0])


def test_factors_and_shares_that_are_invalid():
    with pytest.raises(ValueError, match=r"factor must be at least 1, got 0\.9"):
        metrics.settling_times_s(TIME_S, np.ones(20), [], factor=0.9)
    for share in (0.0, 1.1, np.nan):
        with pytest.raises(ValueError, match="share must be above 0 and at most 1"):
            metrics.detection_delays_scans(TIME_S, np.ones(20), [], share=share)


def test_steady_are_the_scans_but_for_the_three_after_a_switch():
    steady = metrics.steady_scans(TIME_S, SWITCHES_S)
    assert np.flatnonzero(~steady).tolist() == [5, 6, 7, 10, 11, 12]
    assert metrics.steady_scans(TIME_S, []).all()
    assert metrics.steady_scans(TIME_S, SWITCHES_S, scans=0).all()
    assert not metrics.steady_scans(TIME_S, SWITCHES_S, scans=99)[5:].any()
    assert np.flatnonzero(~metrics.steady_scans(TIME_S, [57.0])).tolist() == [19]
    for scans in (-1, 2.5):
        with pytest.raises(ValueError, match=f"scans must be a whole number.* got {scans}"):
            metrics.steady_scans(TIME_S, SWITCHES_S, scans=scans)


# ------------------------------------------------------------------ time of day


@pytest.mark.parametrize("shift_s", [-1e5, 1e3, 1.7e9])
def test_the_time_of_day_changes_no_figure(shift_s):
    time_s = 0.7 * np.arange(1, 21)
    switches_s = np.cumsum([0.7] * 5 + [5.3])[[4, 5]]  # one on a reading, one between two
    curve = np.random.default_rng(4).uniform(0.1, 1.0, 20)
    later = time_s + shift_s, curve, switches_s + shift_s
    for figure in (metrics.settling_times_s, metrics.detection_delays_scans):
        np.testing.assert_allclose(figure(*later), figure(time_s, curve, switches_s), atol=1e-6)
    np.testing.assert_array_equal(
        metrics.steady_scans(time_s + shift_s, switches_s + shift_s),
        metrics.steady_scans(time_s, switches_s),
    )
    for moved, here in zip(
        metrics.by_segment(*later), metrics.by_segment(time_s, curve, switches_s), strict=True
    ):
        assert (moved.scans, moved.mean, moved.peak) == (here.scans, here.mean, here.peak)


# ------------------------------------------------------------------ right models

RATES = np.array([-0.02, 0.0, 0.02])


def test_the_right_model_is_the_nearest_to_the_true_rate():
    modes = np.array([[0.1, 0.8, 0.1], [0.1, 0.8, 0.1], [0.0, 0.4, 0.6]])
    truth = np.array([0.0, -0.03, 0.015])
    assert metrics.right_mode(modes, RATES, truth).tolist() == [True, False, True]


def test_equally_near_models_are_both_right_and_rates_may_move():
    half_way = metrics.right_mode(np.eye(3)[[1, 2, 0]], RATES, [0.01] * 3)
    assert half_way.tolist() == [True, True, False]
    moving = np.array([[0.0, 0.01], [0.03, 0.01]])
    assert metrics.right_mode([[1, 0], [1, 0]], moving, [0.0, 0.0]).tolist() == [True, False]
    runs = metrics.right_mode(np.ones((4, 2, 2)), np.broadcast_to(moving, (4, 2, 2)), [0.0, 0.0])
    assert runs.tolist() == [[True, False]] * 4


@pytest.mark.filterwarnings("error")
@given(st.integers(0, 2**32))
def test_a_model_at_rest_is_as_if_it_were_not_there(seed):
    draw = np.random.default_rng(seed)
    modes, truth = draw.random((5, 7, 3)), draw.normal(size=7)
    rates = draw.normal(size=(5, 7, 3))
    without = metrics.right_mode(modes, rates, truth)
    at = draw.integers(4)
    with_one = metrics.right_mode(
        np.insert(modes, at, 0.0, axis=-1), np.insert(rates, at, np.nan, axis=-1), truth
    )
    np.testing.assert_array_equal(with_one, without)


def test_a_model_at_rest_is_never_right():
    assert metrics.right_mode([[0.0, 1.0]], [[np.nan, 0.0]], [0.0]).tolist() == [True]
    assert metrics.right_mode([[1.0, 0.0]], [[np.nan, 9.0]], [0.0]).tolist() == [False]
    assert metrics.right_mode([[0.5, 0.5]], [[np.nan, np.nan]], [0.0]).tolist() == [False]


def test_no_model_is_right_where_none_is_known_to_be_probable():
    modes = np.array([[np.nan, np.nan], [np.nan, 1.0], [1.0, 0.0]])
    assert metrics.right_mode(modes, [0.0, 0.1], np.zeros(3)).tolist() == [False, False, True]


@pytest.mark.parametrize(
    ("modes", "rates", "truth", "message"),
    [
        ((3, 2), (2,), (2,), r"mode_probability must have shape \(..., T, K\)"),
        ((2,), (2,), (), "mode_probability"),
        ((3, 0), (0,), (3,), "mode_probability"),
        ((3, 2), (3,), (3,), r"turn_rates_rad_s must have shape \(K,\).*got \(3,\)"),
    ],
)
def test_models_that_do_not_fit(modes, rates, truth, message):
    with pytest.raises(ValueError, match=message):
        metrics.right_mode(np.ones(modes), np.zeros(rates), np.zeros(truth))


# ------------------------------------------------------------------ consistency


@given(st.integers(1, 6), st.integers(1, 5), st.integers(0, 2**32))
def test_nees_is_the_squared_distance_by_the_inverse(states, count, seed):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(count, states, states)) + 3 * np.eye(states)
    error = rng.normal(size=(count, states))
    covariance = root @ root.swapaxes(-1, -2) + np.eye(states)
    wanted = [e @ np.linalg.solve(p, e) for e, p in zip(error, covariance, strict=True)]
    np.testing.assert_allclose(metrics.nees(error, covariance), wanted, rtol=1e-8)


def test_nees_is_nan_where_a_covariance_is_wrong():
    covariance = np.array([np.eye(2), -np.eye(2), np.ones((2, 2)), np.full((2, 2), np.nan)])
    got = metrics.nees(np.ones((4, 2)), covariance)
    np.testing.assert_array_equal(got, [2.0, np.nan, np.nan, np.nan])
    with pytest.raises(ValueError, match=r"covariance must have shape \(4, 2, 2\), got \(2, 2\)"):
        metrics.nees(np.ones((4, 2)), np.eye(2))


def test_the_share_inside_is_the_confidence_for_honest_averages():
    rng = np.random.default_rng(3)
    for samples in (1, 20):
        curve = rng.chisquare(4, (20_000, samples)).mean(axis=1)
        share = metrics.share_inside(curve, 4, samples)
        assert share == pytest.approx(0.95, abs=0.006)
        assert metrics.share_inside(curve, 4, samples, confidence=0.5) == pytest.approx(
            0.5, abs=0.02
        )


def test_scans_count_by_how_many_samples_they_have():
    low, high = wl.consistency_bounds(0.95, 2, 50)
    curve, samples = [low, high, high + 1e-9, high + 1e-9, np.nan, 0.0], [50, 50, 50, 2, 50, 0]
    assert metrics.share_inside(curve, 2, samples) == pytest.approx(3 / 5)
    assert np.isnan(metrics.share_inside(curve, 2, 0))


@pytest.mark.parametrize("samples", [[50, 50], 10.5, np.nan, np.inf, -3, [50, -1, 50]])
def test_samples_that_are_no_counts_are_rejected_by_name(samples):
    with pytest.raises(ValueError, match=r"samples must be integers, .* of shape \(\) or \(3,\)"):
        metrics.share_inside(np.ones(3), 2, samples)


def test_confidences_that_are_invalid():
    with pytest.raises(ValueError, match="confidence must be between 0 and 1, got 1"):
        metrics.share_inside([1.0], 2, 1, confidence=1.0)
    with pytest.raises(ValueError, match="dof"):
        metrics.share_inside([1.0], 0, 1)
