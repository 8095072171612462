"""Consistency of one run: windows of NIS, whiteness of innovations."""

import numpy as np
import pytest

import wakeline as wl
from wakeline.metrics import whiteness, windowed_nis


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


@pytest.mark.parametrize("wrong", [{"window": 0}, {"dof": 0}, {"confidence": 1.0}])
def test_parameters_that_make_no_sense_are_rejected(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        windowed_nis(np.ones(5), **wrong)
