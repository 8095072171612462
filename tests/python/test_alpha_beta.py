"""Alpha-beta filters: their laws are tested in C++; here what Python adds."""

import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from cases import CONVERTED, DT_S, POSITION, RADAR, START, readings

LINES = {
    "constant": wl.ConstantGains(0.5, 0.2),
    "growing": wl.GrowingMemory(),
    "bordner": wl.BenedictBordner(0.6),
    "damped": wl.CriticallyDamped(0.5),
    "index": wl.TrackingIndex(0.3),
    "range": wl.RangeDependent(),
}
PARABOLAS = {
    "constant": wl.ConstantGains(0.6, 0.3, 0.05),
    "growing": wl.GrowingMemory(plots_before=2),
    "damped": wl.CriticallyDamped(0.5),
    "index": wl.TrackingIndex(0.1),
}
FILTERS = {f"line-{k}": wl.AlphaBeta(v) for k, v in LINES.items()} | {
    f"parabola-{k}": wl.AlphaBetaGamma(v) for k, v in PARABOLAS.items()
}


@pytest.mark.parametrize("name", FILTERS)
@pytest.mark.parametrize("sensor", [RADAR, CONVERTED])
def test_run_is_the_steps_one_by_one(name, sensor):
    z = readings(15, seed=4)
    z[6:8] = np.nan
    dt_s = np.linspace(2.0, 4.0, len(z))
    one = FILTERS[name]
    result = one.run(z, dt_s=dt_s, sensor=sensor, start=START)
    one.start(START)
    for k, reading in enumerate(z):
        one.predict(dt_s[k])
        if not np.isnan(reading).any():
            step = one.update(sensor, reading)
            assert result.nis[k] == step.nis
            assert result.log_likelihood[k] == step.log_likelihood
            np.testing.assert_array_equal(result.innovation[k], step.innovation)
        np.testing.assert_array_equal(result.mean[k], one.estimate().mean)
        np.testing.assert_array_equal(result.covariance[k], one.estimate().covariance)
    assert result.mode_probability is None
    assert result.status[6] == int(wl.Status.missed)
    assert one.started


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 1000), st.integers(3, 40), st.floats(0.1, 10.0))
def test_growing_memory_is_the_polynomial_fit(seed, scans, dt_s):
    z = np.random.default_rng(seed).normal(0.0, 10.0, (scans, 2))
    age = dt_s * np.arange(1 - scans, 1)
    for one, degree in ((wl.AlphaBeta, 1), (wl.AlphaBetaGamma, 2)):
        mean = one(wl.GrowingMemory()).run(z, dt_s=dt_s, sensor=POSITION, start=START).mean[-1]
        fit = np.polynomial.polynomial.polyfit(age, z, degree) * [[1.0], [1.0], [2.0]][: degree + 1]
        scale = 10.0 / dt_s ** np.arange(degree + 1)
        np.testing.assert_allclose(mean.reshape(2, -1) / scale, fit.T / scale, atol=1e-8)


@pytest.mark.parametrize(("one", "degree"), [(wl.AlphaBeta, 1), (wl.AlphaBetaGamma, 2)])
def test_critically_damped_weighs_readings_by_theta_a_reading_back(one, degree):
    theta, scans, dt_s = 0.7, 200, 2.0
    z = np.random.default_rng(3).normal(0.0, 10.0, (scans, 2))
    age = dt_s * np.arange(1 - scans, 1)
    mean = one(wl.CriticallyDamped(theta)).run(z, dt_s=dt_s, sensor=POSITION, start=START).mean[-1]
    root_weight = theta ** (np.arange(scans)[::-1] / 2)  # that of the squares is theta a reading
    fit = np.polynomial.polynomial.polyfit(age, z, degree, w=root_weight)
    np.testing.assert_allclose(mean.reshape(2, -1)[:, :2], fit.T[:, :2], atol=1e-6)


def test_a_tracking_index_is_the_kalman_filter_in_its_steady_state():
    z = readings(300, seed=5)
    accel = wl.PiecewiseAcceleration(std_mps2=0.2)
    kalman = wl.Kalman(wl.ConstantVelocity(noise=accel))
    index = wl.TrackingIndex(0.2)
    xy = np.column_stack([z[:, 0] * np.cos(z[:, 1]), z[:, 0] * np.sin(z[:, 1])])
    truth = kalman.run(xy, dt_s=DT_S, sensor=POSITION, start=START)
    ours = wl.AlphaBeta(index).run(xy, dt_s=DT_S, sensor=POSITION, start=START)
    np.testing.assert_allclose(ours.mean[-1], truth.mean[-1], rtol=1e-9)
    np.testing.assert_allclose(ours.covariance[-1], truth.covariance[-1], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(
        index.steady_covariance(DT_S, 25.0), truth.covariance[-1, :2, :2], rtol=1e-9
    )
    assert (ours.covariance[5].diagonal() >= truth.covariance[5].diagonal() - 1e-9).all()


def test_the_noise_is_that_of_the_covariance_alone():
    z = readings(10, seed=6)
    calm, wild = (
        wl.AlphaBeta(wl.BenedictBordner(0.5), noise=wl.WhiteAcceleration(psd_m2s3=psd)).run(
            z, dt_s=DT_S, sensor=RADAR, start=START
        )
        for psd in (0.01, 1.0)
    )
    np.testing.assert_array_equal(calm.mean, wild.mean)
    assert (calm.covariance[-1].diagonal() < wild.covariance[-1].diagonal()).all()


def test_a_known_acceleration_moves_the_prediction():
    still, pushed = (wl.AlphaBeta(wl.BenedictBordner(0.5)) for _ in range(2))
    for one in (still, pushed):
        one.start(START)
    still.predict(2.0)
    pushed.predict(2.0, [0.5, -1.0])
    np.testing.assert_allclose(
        pushed.estimate().mean - still.estimate().mean, [1.0, 1.0, -2.0, -2.0], atol=1e-9
    )


def test_doppler_readings_give_their_position():
    sensor = wl.RangeBearingDoppler(range_std_m=30.0, bearing_std_rad=np.deg2rad(0.5))
    z = readings(10, seed=7)
    with_rate = np.column_stack([z, np.zeros(len(z))])
    index = wl.TrackingIndex(0.3)
    ours = wl.AlphaBeta(index).run(with_rate, dt_s=DT_S, sensor=sensor, start=START)
    plain = wl.AlphaBeta(index).run(z, dt_s=DT_S, sensor=RADAR, start=START)
    np.testing.assert_array_equal(ours.mean, plain.mean)


def alternatives():
    gains = wl.ConstantGains(0.25, 0.04), wl.ConstantGains(0.6, 0.25)
    return wl.Imm([wl.AlphaBeta(one) for one in gains], wl.ModeChain.from_sojourn_s([60.0, 60.0]))


def test_one_model_of_an_imm_is_the_filter_itself():
    one, z = FILTERS["line-constant"], readings(30, seed=2)
    imm = wl.Imm([one], wl.ModeChain([[1.0]]))
    ours, alone = (e.run(z, dt_s=DT_S, sensor=CONVERTED, start=START) for e in (imm, one))
    np.testing.assert_array_equal(ours.mean, alone.mean)
    np.testing.assert_array_equal(ours.covariance, alone.covariance)


def test_a_vessel_that_alters_is_followed_by_the_larger_gains():
    time_s = np.arange(0.0, 300.0, 3.0)
    after_s = np.maximum(time_s - 150.0, 0.0)
    truth = np.column_stack([2000.0 + 8.0 * time_s, 1000.0 + 4.0 * time_s + 0.03 * after_s**2])
    z = truth + np.random.default_rng(0).normal(0.0, 20.0, truth.shape)
    sensor = wl.Position(position_std_m=20.0)
    start = wl.Gaussian([2000.0, 8.0, 1000.0, 4.0], np.diag([400.0, 4.0, 400.0, 4.0]))
    found = alternatives().run(z, dt_s=3.0, sensor=sensor, start=start)
    assert found.mode_probability[60:, 1].mean() > 1.5 * found.mode_probability[20:50, 1].mean()
    again = pickle.loads(pickle.dumps(alternatives()))
    np.testing.assert_array_equal(
        again.run(z, dt_s=3.0, sensor=sensor, start=start).mean, found.mean
    )


def test_among_several_models_it_needs_a_position():
    with pytest.raises(ValueError, match="AlphaBeta"):
        alternatives().run(readings(3, seed=1), dt_s=DT_S, sensor=RADAR, start=START)


def test_a_tracker_can_keep_its_tracks_with_it():
    rng = np.random.default_rng(1)
    tracker = wl.Tracker(wl.Radar(period_s=3.0), estimator=alternatives())
    for time_s in np.arange(0.0, 120.0, 3.0):
        plot = np.array([2000.0, 1000.0]) + time_s * np.array([8.0, 4.0]) + rng.normal(0, 5.0, 2)
        tracker.process(
            time_s,
            range_m=[np.hypot(*plot)],
            bearing_rad=[np.arctan2(plot[1], plot[0])],
        )
    (mean,) = tracker.tracks().mean
    np.testing.assert_allclose(mean[[0, 2]], [2936.0, 1468.0], atol=25.0)
    np.testing.assert_allclose(mean[[1, 3]], [8.0, 4.0], atol=2.0)


def test_gains_can_be_asked_for():
    np.testing.assert_allclose(wl.GrowingMemory().gains(reading=2), [1.0, 1.0])
    np.testing.assert_allclose(wl.BenedictBordner(0.5).gains(), [0.5, 0.25 / 1.5])
    for range_km in (5.0, 20.0, 30.0, 40.0, 60.0, 150.0, 900.0):
        printed = np.clip(20.0 / range_km, 0.2, 0.5), np.clip(4.0 / range_km, 0.01, 0.2)
        np.testing.assert_allclose(wl.RangeDependent().gains(range_m=1e3 * range_km), printed)
    np.testing.assert_allclose(wl.RecentMemory().gains(reading=9), [54 / 110, 12 / 110])
    assert wl.TrackingIndex(0.1).gains(3, elapsed_s=3.0, std_m=10.0).shape == (3,)
    assert wl.stable_gains(0.5, 0.2)
    assert not wl.stable_gains(1.5, 1.0)
    assert not wl.stable_gains(0.5, 0.2, 0.5)


@pytest.mark.parametrize(
    ("build", "error", "words"),
    [
        (lambda: wl.AlphaBeta(wl.ConstantGains(1.5, 1.0)), ValueError, "2 alpha"),
        (lambda: wl.AlphaBeta(wl.ConstantGains(0.5, 0.2, 0.1)), ValueError, "gamma"),
        (lambda: wl.AlphaBetaGamma(wl.ConstantGains(0.5, 0.2)), ValueError, "gamma"),
        (lambda: wl.AlphaBetaGamma(wl.BenedictBordner(0.5)), TypeError, "gains of AlphaBeta"),
        (lambda: wl.AlphaBeta(0.5), TypeError, "gains of AlphaBeta"),
        (lambda: wl.AlphaBeta(wl.BenedictBordner(np.nan)), ValueError, "alpha"),
        (lambda: wl.AlphaBeta(wl.CriticallyDamped(1.0)), ValueError, "theta"),
        (lambda: wl.AlphaBeta(wl.TrackingIndex(-0.1)), ValueError, "accel_std_mps2"),
        (lambda: wl.AlphaBeta(wl.GrowingMemory(max_plots=1)), ValueError, "max_plots"),
        (lambda: wl.AlphaBeta(wl.RangeDependent(far_beta=1.0)), ValueError, "far_beta"),
        (
            lambda: wl.AlphaBeta(wl.TrackingIndex(0.1), noise=wl.WhiteJerk(psd_m2s5=0.1)),
            ValueError,
            "acceleration",
        ),
        (lambda: wl.BenedictBordner(0.5).gains(3), ValueError, "order"),
        (lambda: wl.TrackingIndex(0.5).gains(4), ValueError, "order"),
        (lambda: wl.GrowingMemory().gains(reading=0), ValueError, "reading"),
        (lambda: wl.GrowingMemory().gains(reading=-1000), ValueError, "reading"),
        (lambda: wl.TrackingIndex(0.5).gains(elapsed_s=-1.0), ValueError, "elapsed_s"),
        (lambda: wl.TrackingIndex(0.5).gains(std_m=0.0), ValueError, "std_m"),
        (lambda: wl.RangeDependent().gains(range_m=np.nan), ValueError, "range_m"),
        (lambda: wl.TrackingIndex(0.5).steady_covariance(0.0, 1.0), ValueError, "period_s"),
    ],
)
def test_what_is_invalid_is_rejected_in_words(build, error, words):
    with pytest.raises(error, match=words):
        build()


def test_a_step_that_fails_says_so_and_changes_nothing():
    one = wl.AlphaBeta(wl.GrowingMemory())
    with pytest.raises(wl.FilterError, match="not started"):
        one.predict(1.0)
    one.start(START)
    with pytest.raises(wl.FilterError, match="negative"):
        one.predict(-1.0)
    with pytest.raises(wl.FilterError, match="finite"):
        one.update(POSITION, [np.nan, 0.0])
    np.testing.assert_array_equal(one.estimate().mean, START.mean)
    with pytest.raises(ValueError, match="4 states"):
        one.start(wl.Gaussian(np.zeros(6), np.eye(6)))
