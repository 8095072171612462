"""An unmanned vessel in closed loop: estimates steer the mission."""

import dataclasses
from itertools import pairwise

import numpy as np
import pytest

import wakeline as wl
from wakeline.scenario import UsvMission
from wakeline.study import usv_closed_loop as loop
from wakeline.study.usv_estimators import Estimator

RUNS = 6
NO_ERRORS = {
    "imu_bias": (0.0, 0.0, 0.0),
    "imu_std": (0.0, 0.0, 0.0),
    "gnss_std_m": (1e-6, 1e-6),
    "compass_std_rad": 1e-9,
}
LOOPS = loop.loops()
BASE = LOOPS["loop_current_0.5"]
STRAIGHT = dataclasses.replace(
    BASE,
    waypoints_m=((300.0, 400.0),),
    obstacles=(),
    start_heading_rad=float(np.arctan2(400.0, 300.0)),
)


def scores(mission, name, runs=RUNS, seed=1):
    return loop.closed_loop(mission, loop.CLOSED.get(name, name), runs, [seed]).scores


def rms(passage):
    return np.sqrt(np.nanmean(passage.cross_track_m**2))


# The simulation -----------------------------------------------------------------------------------


def test_with_perfect_sensors_the_vessel_keeps_to_its_path():
    for current in (0.0, 0.5):
        perfect = dataclasses.replace(STRAIGHT, current_mps=current, **NO_ERRORS)
        pilot = loop.NavigatorPilot(Estimator(8, "ukf"), perfect, 2)
        passage = perfect.sail(pilot, 2, 1)
        assert passage.success.all()
        limit = 1e-4 if current == 0.0 else 2.0  # metres, until it has turned into the current
        assert np.nanmax(passage.cross_track_m) < limit


def test_the_truth_as_a_pilot_is_the_voyage():
    mission = UsvMission(allow_for_current=True)
    passage, voyage = mission.sail(None, 1, 0), mission.voyage
    np.testing.assert_array_equal(passage.position_m[0], voyage.position_m)
    np.testing.assert_array_equal(passage.velocity_mps[0], voyage.velocity_mps)
    np.testing.assert_array_equal(passage.heading_rad[0], voyage.heading_rad)


def test_the_planned_path_leads_past_the_obstacles_to_the_end():
    path = BASE.path_m
    np.testing.assert_array_equal(path[[0, -1]], [[0.0, 0.0], BASE.waypoints_m[-1]])
    share = np.linspace(0.0, 1.0, 50)[:, None]
    dense = np.concatenate([a + share * (b - a) for a, b in pairwise(path)])
    for obstacle in BASE.obstacles:
        nearest = np.hypot(*(dense - obstacle[:2]).T).min() - obstacle.radius_m
        assert nearest == pytest.approx(BASE.clearance_m, abs=0.5)


def test_allowing_for_the_current_reduces_the_cross_track_error():
    for scene in ("loop_current_0.5", "loop_tide"):
        with_it, without = (
            scores(LOOPS[scene], name)["cross_track_rms_m"]
            for name in ("ukf8", "ukf8_uncompensated")
        )
        assert with_it < 0.2 * without


def test_fused_estimates_steer_better_than_gnss_and_compass_alone():
    for scene in ("loop_current_0.5", "loop_outages"):
        fused, raw = (scores(LOOPS[scene], name) for name in ("ukf8", "gnss_compass"))
        assert fused["success_rate"] == 1.0
        assert fused["cross_track_rms_m"] < 0.3 * raw["cross_track_rms_m"]


def test_estimates_of_known_errors_are_consistent():
    for scene in ("loop_current_0.5", "loop_outages", "loop_tide"):
        assert 4.0 < scores(LOOPS[scene], "ukf8", runs=10)["nees"] < 6.0


def test_biases_that_are_ignored_lead_astray():
    ignored, estimated = (scores(BASE, name) for name in ("ukf5_no_bias", "ukf8"))
    assert ignored["cross_track_rms_m"] > 3 * estimated["cross_track_rms_m"]
    assert ignored["success_rate"] < estimated["success_rate"]


def test_calibration_brings_the_heading_back():
    error = {
        name: scores(LOOPS[name], "ukf8")["heading_mse_deg2"]
        for name in ("loop_iron", "loop_iron_calibrated", "loop_current_0.5")
    }
    assert error["loop_iron"] > 50 * error["loop_iron_calibrated"]
    assert error["loop_iron_calibrated"] < 3 * error["loop_current_0.5"]


def test_a_run_is_the_same_whatever_their_number():
    few, many = (BASE.sail(loop.RawPilot(BASE, n), n, 5) for n in (2, 3))
    count = np.isfinite(few.heading_rad[0]).sum()
    np.testing.assert_array_equal(few.position_m[0, :count], many.position_m[0, :count])


# The sensors --------------------------------------------------------------------------------------


def test_multipath_is_correlated_in_time_as_stated():
    mission = dataclasses.replace(
        BASE, gnss_std_m=(0.0, 0.0), multipath_std_m=6.0, multipath_time_s=20.0
    )
    error = mission.draw(60, 2).gnss[:, 1:] - mission.voyage.position_m[1:]
    assert error.std() == pytest.approx(6.0, rel=0.05)
    for lag in (1, 10, 30):
        kept = np.mean(error[:, lag:] * error[:, :-lag]) / np.mean(error**2)
        assert kept == pytest.approx(np.exp(-lag / 20.0), abs=0.05)


def test_there_are_no_fixes_in_an_outage():
    logs = LOOPS["loop_outages"].draw(2, 1)
    seen = np.isfinite(logs.gnss).all(axis=-1)
    time_s = np.arange(seen.shape[1])
    hidden = ((time_s >= 200) & (time_s <= 320)) | ((time_s >= 600) & (time_s <= 780))
    np.testing.assert_array_equal(seen[0, 1:], ~hidden[1:])


def test_a_turning_current_turns_as_stated():
    mission = dataclasses.replace(BASE, current_turn_s=400.0)
    quarter = mission.current_at(100.0)
    np.testing.assert_allclose(quarter, [-0.5, 0.0], atol=1e-12)  # from east to south
    truth = mission.voyage
    ahead = np.column_stack([np.cos(truth.heading_rad), np.sin(truth.heading_rad)])
    current = np.array([mission.current_at(t) for t in truth.time_s])
    np.testing.assert_allclose(truth.velocity_mps - current, ahead, atol=1e-12)


def test_the_standard_deviation_of_correlated_errors_is_that_of_their_mean():
    mission = LOOPS["loop_multipath"]
    independent = loop.gnss_std_m(mission, correlated=True)
    long = dataclasses.replace(mission, waypoints_m=((3000.0, 0.0),), obstacles=())
    error = long.draw(150, 3).gnss[:, 1:] - long.voyage.position_m[1:]
    mean_std = error.mean(axis=1).std(axis=0)
    np.testing.assert_allclose(mean_std, independent / np.sqrt(error.shape[1]), rtol=0.2)


def test_iron_is_seen_by_an_uncalibrated_compass_only():
    iron = wl.navigation.CompassEllipse([0.1, 0.0], np.eye(2))
    raw = dataclasses.replace(BASE, compass_iron=iron, compass_std_rad=1e-4)
    truth = raw.voyage.heading_rad[1:]
    off, on = (
        wl.wrap_angle(mission.draw(1, 1).compass[0, 1:] - truth)
        for mission in (raw, dataclasses.replace(raw, calibrated=True))
    )
    deviation = np.arctan2(-np.sin(truth) * -1, np.cos(truth) + 0.1) - truth
    np.testing.assert_allclose(off, wl.wrap_angle(deviation), atol=1e-3)
    np.testing.assert_allclose(on, 0.0, atol=1e-3)


def test_errors_of_a_mission_name_the_argument():
    for wrong in (
        {"current_turn_s": 0.0},
        {"multipath_std_m": -1.0},
        {"multipath_time_s": 0.0},
        {"outages_s": ((5.0, 1.0),)},
    ):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            UsvMission(**wrong)
