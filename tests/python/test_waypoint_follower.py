"""Guidance along waypoints, calibration of a compass near iron, and steps of many navigators."""

import copy
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from wakeline.navigation import (
    CompassEllipse,
    WaypointFollower,
    WaypointGuidance,
    calibrate_compass,
    step_navigators,
)

ROUTE = np.array([[0.0, 0.0], [200.0, 300.0], [450.0, 420.0]])
OBSTACLES = np.array([[95.0, 150.0, 20.0]])


def follower(**guidance):
    return WaypointFollower(ROUTE, WaypointGuidance(**guidance), OBSTACLES)


# The follower -------------------------------------------------------------------------------------


def test_a_fleet_is_steered_as_its_vessels_one_by_one():
    rng = np.random.default_rng(1)
    position, heading = rng.uniform(0, 450, (3, 4, 2)), rng.uniform(-3, 3, (3, 4))
    current, leg = rng.normal(0, 0.3, (3, 4, 2)), rng.integers(0, 2, (3, 4))
    fleet = follower().steer(position, heading, current, 1.0, leg)
    for k in np.ndindex(3, 4):
        one = follower().steer(position[k], heading[k], current[k], 1.0, leg[k])
        for name in ("leg", "turn_rate_rad_s", "heading_rad", "cross_track_m"):
            assert getattr(fleet, name)[k] == getattr(one, name)


@given(
    towards=st.floats(-np.pi, np.pi),
    speed=st.floats(0.0, 0.9),
    east=st.floats(-100, 300),
    north=st.floats(-100, 300),
)
def test_the_course_over_ground_is_the_bearing_of_the_waypoint(towards, speed, east, north):
    """Whatever the current, as long as it is slower than the vessel."""
    current = speed * np.array([np.cos(towards), np.sin(towards)])
    free = WaypointFollower([[0.0, 0.0], [400.0, 400.0]], WaypointGuidance(speed_mps=1.0))
    heading = free.steer([north, east], 0.0, current, 1.0, 0).heading_rad
    velocity = np.array([np.cos(heading), np.sin(heading)]) + current
    to = np.array([400.0 - north, 400.0 - east])
    assert abs(to[0] * velocity[1] - to[1] * velocity[0]) < 1e-9 * np.hypot(*to)
    assert to @ velocity > 0


def test_the_leg_advances_inside_the_circle_of_acceptance_and_ends():
    guide = follower(accept_m=15.0)
    for distance, leg in ((15.1, 0), (14.9, 1)):
        assert guide.steer(ROUTE[1] - [distance, 0], 0.0, [0, 0], 1.0, 0).leg == leg
    end = guide.steer(ROUTE[2], 0.3, [0, 0], 1.0, 1)
    assert (int(end.leg), float(end.turn_rate_rad_s)) == (guide.legs, 0.0)


def test_a_follower_is_copied_and_pickled():
    guide = follower(turn_rate_rad_s=0.2)
    where = (ROUTE[0], 1.0, [0.1, 0.2], 1.0, 0)
    for same in (copy.copy(guide), pickle.loads(pickle.dumps(guide))):
        assert same.guidance == guide.guidance
        np.testing.assert_array_equal(same.route_m, ROUTE)
        np.testing.assert_array_equal(same.obstacles, OBSTACLES)
        assert same.steer(*where).heading_rad == guide.steer(*where).heading_rad
    command = pickle.loads(pickle.dumps(guide.steer(*where)))
    assert command.heading_rad == guide.steer(*where).heading_rad


def test_errors_of_a_follower_name_the_argument():
    with pytest.raises(ValueError, match="points of the route"):
        WaypointFollower(ROUTE[:1])
    with pytest.raises(ValueError, match="route_m"):
        WaypointFollower(ROUTE.T)
    with pytest.raises(ValueError, match="obstacles"):
        WaypointFollower(ROUTE, obstacles=[[1.0, 2.0]])
    with pytest.raises(ValueError, match="radius_m"):
        WaypointFollower(ROUTE, obstacles=[[1.0, 2.0, -1.0]])
    with pytest.raises(ValueError, match="accept_m"):
        WaypointGuidance(accept_m=0.0)
    guide = follower()
    with pytest.raises(ValueError, match="current_mps"):
        guide.steer(ROUTE, np.zeros(3), [0, 0], 1.0, [0, 0, 0])
    with pytest.raises(ValueError, match="dt_s"):
        guide.steer(ROUTE[0], 0.0, [0, 0], 0.0, 0)
    with pytest.raises(wl.FilterError, match="vessel 1"):
        guide.steer(ROUTE[:2], [0, np.nan], np.zeros((2, 2)), 1.0, [0, 0])


# The compass --------------------------------------------------------------------------------------

irons = st.builds(
    lambda hard, a, b, c: CompassEllipse(hard, [[a, b], [b, c]]),
    st.lists(st.floats(-2, 2), min_size=2, max_size=2),
    st.floats(0.6, 1.6),
    st.floats(-0.3, 0.3),
    st.floats(0.6, 1.6),
)


@settings(max_examples=50)
@given(irons, st.floats(-np.pi, np.pi))
def test_calibration_recovers_the_ellipse_of_a_turn(iron, start):
    heading = start + np.linspace(0.0, 2 * np.pi, 60, endpoint=False)
    found, std = calibrate_compass(iron.field(heading))
    np.testing.assert_allclose(found.hard_iron, iron.hard_iron, atol=1e-8)
    np.testing.assert_allclose(found.soft_iron, iron.soft_iron, atol=1e-8)
    assert std < 1e-6
    error = wl.wrap_angle(found.heading_rad(iron.field(heading)) - heading)
    np.testing.assert_allclose(error, 0.0, atol=1e-8)


def test_calibration_removes_the_deviation():
    """A tenth of it or less remains, with readings as noisy as a degree."""
    rng = np.random.default_rng(4)
    iron = CompassEllipse([0.15, -0.1], [[1.1, 0.05], [0.05, 0.92]])
    turn = np.linspace(0.0, 4 * np.pi, 144)
    found, std = calibrate_compass(iron.field(turn) + np.deg2rad(1) * rng.normal(size=(144, 2)))
    raw, left = (
        np.abs(wl.wrap_angle(one.heading_rad(iron.field(turn)) - turn)).max()
        for one in (CompassEllipse(), found)
    )
    assert np.degrees(raw) > 8
    assert left < 0.1 * raw
    assert left < 4 * std


def test_a_calibration_without_a_turn_is_an_error():
    with pytest.raises(ValueError, match="at least 6"):
        calibrate_compass(np.zeros((5, 2)))
    with pytest.raises(wl.FilterError, match="ellipse"):
        calibrate_compass(np.ones((50, 2)))
    for soft in ([[1, 0.5], [0, 1]], [[1, 2], [2, 1]], [[1, 0], [0, np.nan]]):
        with pytest.raises(ValueError, match="soft_iron"):
            CompassEllipse([0, 0], soft)


def test_an_ellipse_is_copied_and_pickled():
    iron = CompassEllipse([0.15, -0.1], [[1.1, 0.05], [0.05, 0.92]])
    for same in (copy.copy(iron), pickle.loads(pickle.dumps(iron))):
        np.testing.assert_array_equal(same.field(0.3), iron.field(0.3))


# Steps of many navigators -------------------------------------------------------------------------


@pytest.mark.parametrize(("states", "kind"), [(5, "ukf"), (8, "ukf"), (8, "ekf"), (7, "ukf")])
def test_steps_of_many_give_the_beliefs_of_their_runs(states, kind):
    rng = np.random.default_rng(5)
    times, runs = 40, 3
    imu = rng.normal(0, 0.05, (runs, times, 3))
    gnss = rng.normal(0, 8, (runs, times, 2))
    compass = rng.normal(0, 0.02, (runs, times))
    imu[:, 10], gnss[:, 5:15], compass[1, 20] = np.nan, np.nan, np.nan
    gnss[2, 30] = 500.0  # an outlier
    gnss[:, 0], compass[:, 0] = np.nan, np.nan

    def started():
        navigator = wl.UsvNavigator(states, kind)
        navigator.start([0, 0], [1, 0], 0.0)
        return navigator

    fleet = [started() for _ in range(runs)]
    whole = [started().run(np.arange(times), *log) for log in zip(imu, gnss, compass, strict=True)]
    for k in range(1, times):
        mean, covariance = step_navigators(fleet, 1.0, imu[:, k], gnss[:, k], compass[:, k])
        for r in range(runs):
            np.testing.assert_array_equal(mean[r], whole[r].mean[k])
            np.testing.assert_array_equal(covariance[r], whole[r].covariance[k])


def test_errors_of_steps_name_the_argument():
    one, other, idle = wl.UsvNavigator(8), wl.UsvNavigator(5), wl.UsvNavigator(8)
    for navigator in (one, other):
        navigator.start([0, 0], [1, 0], 0.0)
    rows = np.zeros((2, 3)), np.zeros((2, 2)), np.zeros(2)
    with pytest.raises(ValueError, match="same number of states"):
        step_navigators([one, other], 1.0, *rows)
    with pytest.raises(ValueError, match="gnss must have shape"):
        step_navigators([one, one], 1.0, rows[0], np.zeros((3, 2)), rows[2])
    with pytest.raises(ValueError, match="gnss_std_m"):
        step_navigators([one, one], 1.0, *rows, gnss_std_m=[0, 1])
    with pytest.raises(wl.FilterError):
        step_navigators([idle, idle], 1.0, *rows)
