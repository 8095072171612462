"""`Imm.smooth`: what it promises, beside `run` and the smoother of one filter."""

import numpy as np
import pytest

import wakeline as wl
from wakeline import scenario

DEG = np.pi / 180.0
SENSOR = wl.RangeBearing(range_std_m=60.0, bearing_std_rad=0.5 * DEG)
DT_S = 3.0


def turning(rate_deg_s, std_mps2=0.01):
    noise = wl.PiecewiseAcceleration(std_mps2=std_mps2)
    return wl.Ekf(wl.CoordinatedTurn(turn_rate_rad_s=rate_deg_s * DEG, noise=noise))


def imm(*filters):
    modes = len(filters)
    return wl.Imm(
        filters=list(filters),
        chain=wl.ModeChain(
            np.full((modes, modes), 0.1 / (modes - 1)) + (0.9 - 0.1 / (modes - 1)) * np.eye(modes),
            period_s=DT_S,
        ),
    )


@pytest.fixture(scope="module")
def example():
    """Readings (12, T, 2), truth (T, 4) and start of the papers' first voyage."""
    voyage = scenario.named("example1")
    z = voyage.draw(12, 0)
    truth = voyage.truth.state_at(DT_S * np.arange(1, z.shape[1] + 1))
    start = wl.Gaussian(voyage.truth.state_at(0.0)[0], np.diag([100.0, 1.0, 100.0, 1.0]))
    return z, truth, start


def rms(result, truth, rows):
    return np.sqrt(np.mean((result.mean[..., :4] - truth)[..., rows] ** 2))


def test_the_turns_of_example_1_are_known_far_better(example):
    z, truth, start = example
    estimator = imm(*(turning(rate) for rate in (-2, -1, 0, 1, 2)))
    reported = {"dt_s": DT_S, "sensor": SENSOR, "start": start}
    filtered, smooth = estimator.run(z, **reported), estimator.smooth(z, **reported)
    assert rms(smooth, truth, [0, 2]) < 0.55 * rms(filtered, truth, [0, 2])
    assert rms(smooth, truth, [1, 3]) < 0.35 * rms(filtered, truth, [1, 3])
    error = smooth.mean - truth
    nees = np.einsum("rti,rtij,rtj->rt", error, np.linalg.inv(smooth.covariance), error)
    assert 1.5 < nees.mean() < 4.5
    np.testing.assert_allclose(smooth.mode_probability.sum(-1), 1.0, atol=1e-12)
    for name in ("innovation", "nis", "log_likelihood", "status"):
        np.testing.assert_allclose(getattr(smooth, name), getattr(filtered, name), rtol=1e-9)
    for name in ("mean", "covariance", "mode_probability"):
        last, filtered_last = getattr(smooth, name)[:, -1], getattr(filtered, name)[:, -1]
        np.testing.assert_allclose(last, filtered_last, rtol=1e-8, atol=1e-9)


@pytest.mark.parametrize("kind", [wl.Ekf, wl.Ukf, wl.SquareRootUkf])
def test_equal_models_are_one_filter(example, kind):
    """With missed scans, steps that differ and a known acceleration."""
    z, _, start = example
    z, rng = z[0, :60].copy(), np.random.default_rng(1)
    z[20:23] = np.nan
    dt_s, push = rng.uniform(1.0, 4.0, 60), rng.normal(0.0, 0.05, (60, 2))
    filter = kind(wl.CoordinatedTurnRate(noise=wl.WhiteAcceleration(psd_m2s3=0.01)))
    reported = {"dt_s": dt_s, "sensor": SENSOR, "start": start, "acceleration_mps2": push}
    filtered = filter.run(z, **reported)
    mean, covariance = filter.smooth(filtered.mean, filtered.covariance, dt_s, push)
    smooth = imm(filter, filter).smooth(z, **reported)
    np.testing.assert_allclose(smooth.mean, mean, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(smooth.covariance, covariance, rtol=1e-4, atol=1e-6)


def test_a_recording_alone_is_that_among_others(example):
    z, _, start = example
    estimator = imm(turning(0.0), turning(2.0))
    reported = {"dt_s": DT_S, "sensor": SENSOR, "start": start}
    together = estimator.smooth(z[:, :40], **reported)
    before = wl.threads()
    try:
        wl.set_threads(1)
        alone = estimator.smooth(z[3, :40], **reported)
    finally:
        wl.set_threads(before)
    np.testing.assert_array_equal(together.mean[3], alone.mean)
    np.testing.assert_array_equal(together.covariance[3], alone.covariance)
    np.testing.assert_array_equal(together.mode_probability[3], alone.mode_probability)


def test_models_of_other_states(example):
    z, truth, start = example
    noise = wl.PiecewiseAcceleration(std_mps2=0.05)
    estimator = imm(
        wl.Ekf(wl.ConstantVelocity(noise=noise)),
        wl.Ukf(wl.CoordinatedTurnRate(noise=noise)),
        wl.Ekf(wl.ConstantAcceleration(noise=noise)),
    )
    reported = {"dt_s": DT_S, "sensor": SENSOR, "start": start}
    filtered, smooth = estimator.run(z, **reported), estimator.smooth(z, **reported)
    assert smooth.mean.shape == (*z.shape[:2], 4)
    assert rms(smooth, truth, [0, 2]) < 0.75 * rms(filtered, truth, [0, 2])
    assert rms(smooth, truth, [1, 3]) < 0.6 * rms(filtered, truth, [1, 3])


def test_a_pause_of_months_costs_no_recording(example):
    z, _, start = example
    estimator = imm(turning(0.0), turning(2.0))
    steps_s = np.full(20, DT_S)
    steps_s[12] = 1e8
    reported = {"sensor": SENSOR, "start": start}
    filtered = estimator.run(z[:, :20], dt_s=steps_s, **reported)
    smooth = estimator.smooth(z[:, :20], dt_s=steps_s, **reported)
    before = estimator.smooth(z[:, :12], dt_s=DT_S, **reported)
    assert (smooth.mean[:, :12] == before.mean).all((1, 2)).any()
    assert (smooth.mean[:, 12:-1] != filtered.mean[:, 12:-1]).all()
    assert np.isfinite(smooth.covariance).all()


def test_what_cannot_be_smoothed_is_reported(example):
    z, _, start = example
    estimator = imm(turning(0.0), turning(2.0))
    steps_s = np.full(20, DT_S)
    steps_s[10] = -1.0
    with pytest.raises(wl.FilterError, match="smooth of run 0: negative time step"):
        estimator.smooth(z[0, :20], dt_s=steps_s, sensor=SENSOR, start=start)
    with pytest.raises(ValueError, match=r"z must have shape \(T, 2\) or \(R, T, 2\)"):
        estimator.smooth(z[0, :20, :1], dt_s=DT_S, sensor=SENSOR, start=start)
    empty = estimator.smooth(z[0, :0], dt_s=DT_S, sensor=SENSOR, start=start)
    assert empty.mean.shape == (0, 4)
