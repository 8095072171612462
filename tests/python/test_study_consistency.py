"""Consistency: errors are as large as reported, and tracks are not too far out."""

import numpy as np
import pytest

import wakeline as wl
from wakeline.study import consistency


@pytest.mark.parametrize("case", [(12e3, 2.0), (24e3, 1.0), (48e3, 3.0)])
def test_tracks_and_filters_are_not_too_far_out(case):
    runs = [consistency._range_run(*case, [1, k]) for k in range(60)]
    for name in consistency.ESTIMATORS:
        row = consistency._range_row([run[name] for run in runs])
        # The mean of 60 runs, each of few independent errors, is known to about 0.1.
        assert abs(row["outward_ratio"]) < 0.35, name
        if name in ("kalman", "imm"):
            assert row["position_nees"] == pytest.approx(2.0, abs=0.5), name
        if name == "tracker":
            assert 1.0 < row["position_nees"] < 4.0


@pytest.mark.parametrize(
    ("motion", "models", "velocity"),
    [
        ("straight", "tracker", (0.05, 2.0)),
        ("straight", "tracker_ships", (0.05, 2.0)),
        ("altering", "tracker", (0.5, 3.0)),
        ("altering", "tracker_ships", (0.5, 3.0)),
        ("maneuvering", "tracker", (1.5, 3.0)),
        ("solent_60m", "tracker", (1.5, 3.0)),
        ("solent_15m", "tracker", (1.5, 3.0)),
    ],
)
def test_tracks_err_as_they_report(motion, models, velocity):
    # The mean of forty ships is known to about 0.1.
    row = consistency._motion_row(consistency._motion_run(motion, models, 40, 0))
    assert 1.6 < row["position_nees"] < (2.7 if motion.startswith("solent") else 2.4)
    assert velocity[0] < row["velocity_nees"] < velocity[1]
    if motion == "altering":
        assert row["turn_velocity_nees"] < (5.2 if models == "tracker" else 15.0)
    if motion.startswith("solent"):
        assert row["turn_velocity_nees"] < 4.0


@pytest.mark.parametrize("name", consistency.RECORDINGS)
def test_errors_that_stay_are_reported_on_recordings(name):
    assert consistency._recording_run(name)["debiased_position_nees"] < 3.0


def straight_ships_nees(scale_of, stays_m=0.0, offset_rad=0.0, seed=0):
    """NEES of the position of five ships on straight courses, less the mean offset of the bearing.

    `scale_of` draws the factors on the stated errors of the plots of a scan; the echoes also wander
    by `stays_m` with a time constant of 40 s.
    """
    rng = np.random.default_rng(seed)
    radar = wl.Radar(range_std_m=10.0, bearing_std_rad=np.deg2rad(0.5), period_s=2.5)
    tracker = wl.Tracker(radar)
    place = rng.uniform(2e3, 8e3, 5) * np.exp(2j * np.pi * np.arange(5) / 5)
    velocity = rng.uniform(5.0, 10.0, 5) * np.exp(1j * rng.uniform(-np.pi, np.pi, 5))
    wander, keeps = np.zeros(5, complex), np.exp(-2.5 / 40.0)
    errors, across, covariance = [], [], []
    for k in range(300):
        scale = scale_of(rng, 5)
        truth = place + 2.5 * k * velocity
        normal = rng.standard_normal((6, 5))
        wander = keeps * wander + stays_m * np.sqrt(1 - keeps**2) * (normal[0] + 1j * normal[1])
        echo = truth + wander + radar.extent_std_m * scale * (normal[2] + 1j * normal[3])
        tracker.process(
            2.5 * k,
            range_m=np.abs(echo) + radar.range_std_m * scale * normal[4],
            bearing_rad=np.angle(echo) + radar.bearing_std_rad * scale * normal[5] + offset_rad,
        )
        table = tracker.tracks()
        for mean, p in zip(table.mean, table.covariance, strict=True):
            if k < consistency.SETTLED_SCANS:
                continue
            of = truth[np.abs(truth - (mean[0] + 1j * mean[2])).argmin()]
            errors.append([mean[0] - of.real, mean[2] - of.imag])
            across.append([-of.imag, of.real])
            covariance.append(p[::2, ::2])
    error, across = np.array(errors), np.array(across)
    error -= (error * across).sum() / (across**2).sum() * across
    return consistency.nees(error, np.array(covariance)).mean()


def outliers(rng, n):
    """As often and as far as the default settings say."""
    config = wl.TrackerConfig()
    return np.where(rng.random(n) < config.outlier_probability, config.outlier_scale, 1.0)


@pytest.mark.parametrize(
    "case",
    [
        {"scale_of": lambda rng, n: np.ones(n)},
        {"scale_of": outliers},
        {"scale_of": lambda rng, n: np.ones(n), "offset_rad": 0.01},
        {"scale_of": lambda rng, n: np.full(n, 0.3), "stays_m": 25.0},
        *({"scale_of": lambda rng, n, s=s: np.full(n, s)} for s in (0.5, 0.7, 1.4, 2.0)),
    ],
    ids=["stated", "outliers", "offset", "wandering", "half", "0.7", "1.4", "double"],
)
def test_independent_errors_are_not_taken_for_errors_that_stay(case):
    assert 0.9 < np.mean([straight_ships_nees(**case, seed=seed) for seed in range(4)]) < 3.0


@pytest.mark.parametrize("scene", ["crossings", "clutter_300", "craft"])
def test_existence_is_calibrated(scene):
    existence, real = consistency.existences(scene, 0)
    share = [
        real[(existence >= low) & (existence < high)].mean()
        for low, high in ((0.0, 0.2), (0.85, 0.95), (0.99, 1.0))
    ]
    assert share[0] < 0.1
    assert 0.7 < share[1] <= 1.0
    assert share[2] > 0.98


def test_the_study_makes_rows_of_every_part():
    report = consistency.run(10, 0, threads=1)
    names = {row["scenario"] for row in report.rows}
    assert {"straight", "joyride", "autoferry", "existence_all", "range_48km_3deg"} <= names
    assert report.row("altering", "tracker_ships")["turn_velocity_nees"] is not None
    assert report.pictures[0].draw() is not None


def test_a_bearing_offset_is_left_out():
    (episode,) = wl.recording.load("joyride")
    time_s = episode.own.time_s[:50]
    truth = np.zeros((50, 4))
    truth[:, 0] = np.interp(time_s, episode.own.time_s, episode.own.north_m) + 500.0
    truth[:, 2] = np.interp(time_s, episode.own.time_s, episode.own.east_m) + 300.0
    turned = truth.copy()
    turned[:, 0] -= 0.02 * 300.0
    turned[:, 2] += 0.02 * 500.0
    found = consistency.Found(turned, np.zeros((50, 4, 4)), truth)
    np.testing.assert_allclose(consistency.less_bearing(episode, time_s, found), 0.0, atol=1e-6)
