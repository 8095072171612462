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
