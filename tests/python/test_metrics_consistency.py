"""Consistency of one run: windows of NIS, whiteness of innovations."""

import numpy as np
import pytest

import wakeline as wl
from wakeline.metrics import nis_by_mode, whiteness, windowed_nis


def test_the_mean_is_of_the_last_readings_whatever_is_missing():
    rng = np.random.default_rng(0)
    nis = rng.chisquare(2, (3, 50))
    nis[rng.random(nis.shape) < 0.3] = np.nan
    means = windowed_nis(nis, 5).mean
    for run, mean in zip(nis, means, strict=True):
        for k in range(50):
            known = run[: k + 1][np.isfinite(run[: k + 1])]
            expected = known[-5:].mean() if len(known) >= 5 else np.nan
            np.testing.assert_allclose(mean[k], expected)


def test_bounds_hold_the_share_of_consistent_filters_that_they_should():
    nis = np.random.default_rng(1).chisquare(2, (4000, 20))
    watched = windowed_nis(nis, 20, confidence=0.9)
    assert 0.88 < watched.inside[:, -1].mean() < 0.92
    assert watched.lower < 2.0 < watched.upper
    assert not watched.inside[:, :19].any()


def runs(psd_m2s3):
    """A filter on white acceleration noise of 0.1 m²/s³."""
    rng = np.random.default_rng(2)
    F = np.array([[1.0, 2.0], [0.0, 1.0]])
    spread = np.linalg.cholesky(0.1 * np.array([[8 / 3, 2.0], [2.0, 2.0]]))
    state, z = np.array([[1000.0, 500.0], [2.0, 3.0]]), []
    for _ in range(400):
        state = F @ state + spread @ rng.normal(size=(2, 2))
        z.append(state[0] + rng.normal(scale=5.0, size=2))
    kalman = wl.Kalman(wl.ConstantVelocity(noise=wl.WhiteAcceleration(psd_m2s3=psd_m2s3)))
    sensor = wl.Position(position_std_m=5.0)
    return kalman.run(z, dt_s=2.0, sensor=sensor, start=wl.one_point(sensor, z[0], 5.0))


def test_innovations_of_the_right_filter_are_white_and_of_a_lagging_one_are_not():
    right, lagging = runs(0.1), runs(0.001)
    value, bound = whiteness(right.innovation[20:])
    assert abs(value) < bound
    late, bound = whiteness(lagging.innovation[20:])
    assert late > 2.0 * bound
    assert windowed_nis(right.nis, 100).inside[-1]
    assert windowed_nis(lagging.nis, 100).mean[-1] > windowed_nis(lagging.nis, 100).upper


def test_the_bound_of_whiteness_holds_its_share():
    rng = np.random.default_rng(3)
    found = [whiteness(rng.normal(size=(200, 2)), lag=2) for _ in range(500)]
    assert 0.92 < np.mean([abs(value) < bound for value, bound in found]) < 0.98
    assert np.isnan(whiteness(np.full((5, 2), np.nan))).all()


def test_a_track_is_watched_by_its_own_readings():
    track = wl.track_recording("joyride")["1"]
    watched = windowed_nis(track.nis, 15)
    assert watched.mean.shape == track.time_s.shape
    assert np.isfinite(watched.mean[-1])


def test_a_tracker_watches_each_track_as_it_runs():
    tracker = wl.Tracker(wl.Radar(range_std_m=10.0, bearing_std_rad=0.01, period_s=2.0))
    rng = np.random.default_rng(4)
    hits, weight, nis = 0, np.zeros(0), np.zeros(0)
    compared = 0
    for k in range(80):
        position = np.array([1500.0 + 5.0 * k, -800.0 + 3.0 * k]) + rng.normal(0.0, 9.0, 2)
        seen = [position] if rng.random() < 0.8 else np.zeros((0, 2))
        range_m, bearing_rad = np.hypot(*np.transpose(seen)), np.arctan2(*np.transpose(seen)[::-1])
        tracker.process(2.0 * k, range_m=range_m, bearing_rad=bearing_rad)
        table = tracker.tracks(tentative=True)
        if len(table) == 0:
            continue
        if table.hits[0] > hits and np.isfinite(table.nis[0]):
            nis, weight = np.append(nis, table.nis[0]), np.append(0.9 * weight, 1.0)
        hits = table.hits[0]
        if len(nis) == 0:
            continue
        compared += 1
        np.testing.assert_allclose(table.mean_nis[0], nis @ weight / weight.sum(), rtol=1e-9)
        samples = weight.sum() ** 2 / (weight**2).sum()
        bounds = wl.consistency_bounds(0.95, 2, max(samples, 1.0))
        np.testing.assert_allclose(table.mean_nis_bounds[0], bounds, rtol=1e-3)
        assert np.isfinite(table.whiteness[0]) == (len(nis) > 1)
        assert np.isfinite(table.whiteness_bound[0]) == (len(nis) > 1)
    assert compared > 60


def test_nis_by_mode_is_the_mean_while_a_mode_was_probable():
    rng = np.random.default_rng(5)
    mode = rng.integers(0, 2, 4000)
    nis = rng.chisquare(2, 4000) * np.where(mode == 1, 2.0, 1.0)
    nis[::7] = np.nan
    probability = np.zeros((4000, 3))
    probability[np.arange(4000), mode] = 0.9
    probability[np.arange(4000), 1 - mode] = 0.1
    found = nis_by_mode(nis.reshape(4, 1000), probability.reshape(4, 1000, 3))
    assert np.isnan([found.mean[2], found.lower[2], found.upper[2]]).all()
    known = np.isfinite(nis)
    expected = np.average(nis[known], weights=probability[known, 1])
    np.testing.assert_allclose(found.mean[1], expected)
    assert found.upper[1] < found.mean[1]
    sure = nis_by_mode(nis, np.eye(2)[mode])
    assert sure.lower[0] < sure.mean[0] < sure.upper[0]
    with pytest.raises(ValueError, match="mode_probability"):
        nis_by_mode(nis, probability[1:])


@pytest.mark.parametrize("wrong", [{"window": 0}, {"dof": 0}, {"confidence": 1.0}])
def test_parameters_that_make_no_sense_are_rejected(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        windowed_nis(np.ones(5), **wrong)
