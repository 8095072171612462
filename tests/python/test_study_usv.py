"""The study of an unmanned vessel's navigation: mission, sensors and results."""

import dataclasses

import numpy as np
import pytest

import wakeline as wl
from wakeline import study
from wakeline.scenario import Obstacle, UsvMission
from wakeline.study import usv_navigation as usv
from wakeline.study.usv_closed_loop import CLOSED_METRICS

RUNS = 40
SCENARIOS = [f"current_{current}" for current in (0.5, 0.3, 0.15, 0.7, 1.0)]
ESTIMATORS = [
    *("gnss_compass", "ukf5_known_bias", "ukf5_no_bias", "ukf8", "ekf8", "ukf7_current"),
    *("smoother8", "bound8", "smoother_bound8"),
]
LOOPS = [f"loop_{name}" for name in ("current_0.5", "tide", "outages", "multipath", "iron")]
LOOPS += ["loop_iron_calibrated", "loop_all"]
PILOTS = [
    *("truth", "gnss_compass", "ukf5_known_bias", "ukf5_no_bias", "ukf8", "ekf8", "ukf7_current"),
    "ukf8_uncompensated",
]
ERRORS = ("north_mse_m2", "east_mse_m2", "heading_mse_deg2")


@pytest.fixture(scope="module")
def small():
    return usv.run(2, 3)


@pytest.fixture(scope="module")
def figures():
    """Figures of the default navigator and others at the first current."""
    mission = usv.missions()["current_0.5"]
    logs = mission.draw(RUNS, 1)
    names = ("ukf8", "smoother8", "ukf5_known_bias", "ukf7_current")
    found = {name: usv.evaluate(usv.ESTIMATORS[name], mission, logs) for name in names}
    least = usv.bound(mission)
    found |= {"bound8": least.outcome(), "smoother_bound8": least.outcome(smoothed=True)}
    found["gnss_compass"] = usv.raw(mission, logs)
    return {name: outcome.figures() for name, outcome in found.items()}


def errors(figures, prefix=""):
    return np.array([figures[prefix + metric] for metric in ERRORS])


# The mission --------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SCENARIOS)
def test_she_reaches_every_waypoint_and_keeps_clear_of_what_is_in_the_way(name):
    mission = usv.missions()[name]
    position = mission.voyage.position_m
    for way in mission.waypoints_m:
        assert np.hypot(*(position - way).T).min() < mission.accept_m
    assert np.hypot(*(position[-1] - [800, 800])) < mission.accept_m
    for obstacle in mission.obstacles:
        assert np.hypot(*(position - obstacle[:2]).T).min() > obstacle.radius_m


def test_without_the_obstacles_she_would_run_into_them():
    """Pointing up into the current the vessel follows the straight lines with the obstacles."""
    mission = UsvMission(allow_for_current=True)
    free = dataclasses.replace(mission, obstacles=())
    for obstacle in mission.obstacles:
        nearest = [
            np.hypot(*(one.voyage.position_m - obstacle[:2]).T).min() for one in (mission, free)
        ]
        assert nearest[1] < obstacle.radius_m
        assert nearest[0] > obstacle.radius_m + 0.95 * mission.clearance_m


@pytest.mark.parametrize("name", ["current_0.5", "current_1.0"])
def test_the_voyage_is_what_the_imu_feels(name):
    mission = usv.missions()[name]
    truth = mission.voyage
    assert np.abs(truth.imu[1:, 2]).max() <= mission.turn_rate_rad_s + 1e-12
    through_water = truth.velocity_mps - mission.current
    np.testing.assert_allclose(np.hypot(*through_water.T), mission.speed_mps)
    model_error = 0.0
    for k in range(1, len(truth.time_s)):
        heading = truth.heading_rad[k - 1] + truth.imu[k, 2] / 2
        c, s = np.cos(heading), np.sin(heading)
        a = np.array([[c, -s], [s, c]]) @ truth.imu[k, :2]
        moved = truth.position_m[k - 1] + truth.velocity_mps[k - 1] + a / 2
        model_error = max(model_error, np.abs(moved - truth.position_m[k]).max())
    assert model_error < 1e-9
    turned = wl.wrap_angle(np.diff(truth.heading_rad) - truth.imu[1:, 2])
    np.testing.assert_allclose(turned, 0.0, atol=1e-12)


def test_sensors_err_as_they_are_said_to():
    mission = UsvMission()
    truth, logs = mission.voyage, mission.draw(30, 5)
    off = logs.imu[:, 1:] - truth.imu[1:]
    np.testing.assert_allclose(off.mean(axis=(0, 1)), mission.imu_bias, atol=1e-4)
    np.testing.assert_allclose(off.std(axis=(0, 1)), mission.imu_std, rtol=0.03)
    fixes = logs.gnss[:, 1:] - truth.position_m[1:]
    np.testing.assert_allclose(fixes.std(axis=(0, 1)), mission.gnss_std_m, rtol=0.03)
    compass = wl.wrap_angle(logs.compass[:, 1:] - truth.heading_rad[1:])
    np.testing.assert_allclose(compass.std(), mission.compass_std_rad, rtol=0.03)
    assert np.isnan(logs.gnss[:, 0]).all()


def test_a_run_is_the_same_whatever_their_number():
    mission = UsvMission()
    few, many, other = mission.draw(2, 7), mission.draw(3, 7), mission.draw(2, 8)
    for one, two, three in zip(few, many, other, strict=True):
        np.testing.assert_array_equal(one, two[:2])
        assert not np.array_equal(one, three, equal_nan=True)


def test_errors_of_a_mission_say_what_is_wrong():
    with pytest.raises(ValueError, match="speed_mps must be finite and positive, got 0"):
        UsvMission(speed_mps=0)
    with pytest.raises(ValueError, match="current_mps must be finite and not negative, got -1"):
        UsvMission(current_mps=-1)
    for obstacle in (Obstacle(0.0, 0.0, -1.0), Obstacle(np.nan, 0.0, 1.0)):
        with pytest.raises(ValueError, match="obstacles must be finite"):
            UsvMission(obstacles=(obstacle,))
    with pytest.raises(ValueError, match="waypoints_m must be pairs of finite numbers"):
        UsvMission(waypoints_m=((0.0, np.nan),))
    with pytest.raises(ValueError, match="is not reached"):
        _ = UsvMission(current_mps=2.0).voyage
    with pytest.raises(ValueError, match="runs must be a whole number"):
        UsvMission().draw(-1)


@pytest.mark.parametrize(
    ("name", "value", "wanted"),
    [
        ("start_heading_rad", np.nan, r"finite and have shape \(\)"),
        ("current_towards_rad", np.inf, r"finite and have shape \(\)"),
        ("imu_bias", (0.0, np.nan, 0.0), r"finite and have shape \(3,\)"),
        ("gnss_std_m", (8.0, 7.0, 7.0), r"finite and have shape \(2,\)"),
        ("gnss_std_m", (8.0, -7.0), "zero or more"),
        ("compass_std_rad", -0.1, "zero or more"),
    ],
)
def test_numbers_of_a_mission_that_are_none_are_rejected(name, value, wanted):
    with pytest.raises(ValueError, match=f"{name} must be {wanted}"):
        UsvMission(**{name: value})


# What comes out -----------------------------------------------------------------------------------


def test_rows_have_the_scenarios_the_estimators_and_the_metrics(small):
    assert list(dict.fromkeys(row["scenario"] for row in small.rows)) == SCENARIOS + LOOPS
    for scene in SCENARIOS + LOOPS:
        names = [r["estimator"] for r in small.rows if r["scenario"] == scene]
        correlated = ["ukf8_correlated"] if scene in ("loop_multipath", "loop_all") else []
        assert names == (ESTIMATORS if scene in SCENARIOS else PILOTS + correlated)
    for row in small.rows:
        metrics = usv.METRICS if row["scenario"] in SCENARIOS else CLOSED_METRICS
        assert tuple(row)[2:] == metrics
        assert all(value is None or np.isfinite(value) for value in list(row.values())[2:])
    assert "usv-navigation" in study.names()


def test_filters_unscented_and_extended_agree(small):
    for scene in SCENARIOS:
        one, two = (errors(small.row(scene, name)) for name in ("ukf8", "ekf8"))
        np.testing.assert_allclose(one, two, rtol=0.01)


def test_biases_that_are_ignored_cost_more_than_the_filter_gains(small):
    for scene in SCENARIOS:
        ignored = errors(small.row(scene, "ukf5_no_bias"))
        assert np.all(ignored > 10 * errors(small.row(scene, "ukf8")))
        assert ignored[:2].sum() > errors(small.row(scene, "gnss_compass"))[:2].sum()


def test_unknown_biases_cost_little(figures):
    """The aims have a margin for chance: errors of a mission hang together over minutes."""
    ours = figures["ukf8"]
    assert np.all(errors(ours) < 1.1 * np.array([3.2, 2.6, 0.05]))
    assert 4.5 < ours["nees"] < 5.5
    assert np.all(errors(figures["smoother8"]) < 1.1 * np.array([0.65, 0.55, 0.02]))
    assert np.all(errors(figures["ukf5_known_bias"]) < errors(ours))
    assert np.all(errors(ours) < 0.1 * errors(figures["gnss_compass"]))


def test_no_filter_that_does_not_know_more_is_below_the_bound(figures):
    least = errors(figures["bound8"], "second_half_")
    ratio = errors(figures["ukf8"], "second_half_") / least
    assert np.all((ratio > 0.85) & (ratio < 1.2))
    smoothed = errors(figures["smoother8"]) / errors(figures["smoother_bound8"])
    assert np.all((smoothed > 0.85) & (smoothed < 1.2))
    assert np.all(errors(figures["ukf7_current"], "second_half_")[:2] < least[:2])


@pytest.mark.parametrize("name", ["ukf8", "ukf5_known_bias", "bound8"])
def test_the_figures_of_a_reference_are_met(figures, name):
    """Of an independent program, without obstacles; 40 runs leave a tenth to chance."""
    published = usv.REFERENCE.figures["current_0.5", name]
    ours = [figures[name][metric] for metric in usv.REFERENCE.metrics]
    pairs = [(a, b) for a, b in zip(ours, published, strict=True) if np.isfinite(b)]
    rtol = 0.03 if name == "bound8" else 0.2
    np.testing.assert_allclose(*zip(*pairs, strict=True), rtol=rtol)


def test_the_bound_is_what_an_extended_filter_believes_at_the_truth():
    """With readings free of errors the navigator's covariance is the bound."""
    mission = UsvMission()
    truth, least = mission.voyage, usv.bound(mission)
    exact = (truth.imu, truth.position_m, truth.heading_rad)
    for smooth, wanted in ((False, least.filtered), (True, least.smoothed)):
        navigator = wl.UsvNavigator(8, "ekf")
        navigator.start(truth.position_m[0], truth.velocity_mps[0], truth.heading_rad[0])
        gnss, compass = exact[1].copy(), exact[2].copy()
        gnss[0], compass[0] = np.nan, np.nan
        done = navigator.run(truth.time_s, exact[0], gnss, compass, smooth=smooth)
        std = np.sqrt(np.diagonal(wanted, axis1=1, axis2=2))
        apart = (done.covariance - wanted) / (std[:, :, None] * std[:, None, :])
        np.testing.assert_allclose(apart, 0.0, atol=1e-6)


def test_readings_behind_make_the_bound_smaller():
    least = usv.bound(UsvMission())
    spread = np.diagonal(least.filtered - least.smoothed, axis1=1, axis2=2)
    assert np.all(spread >= -1e-12)
    np.testing.assert_array_equal(least.filtered[-1], least.smoothed[-1])


def test_the_motion_of_seven_states_has_its_covariance():
    rng = np.random.default_rng(2)
    mean = rng.normal(size=(1, 7))
    root = 1e-4 * rng.normal(size=(7, 7))
    motion, covariance = usv.motion_of(mean, (root @ root.T)[None])
    drawn, _ = usv.motion_of(mean + rng.normal(size=(200_000, 7)) @ root.T, np.zeros((1, 7, 7)))
    np.testing.assert_allclose(drawn.mean(axis=0), motion[0], atol=1e-5)
    scale = np.sqrt(np.diag(covariance[0]))
    apart = (np.cov(drawn.T) - covariance[0]) / np.outer(scale, scale)
    np.testing.assert_allclose(apart, 0.0, atol=0.02)


# The table and the pictures -----------------------------------------------------------------------


def test_the_paper_stands_below_ours(small):
    cells = small.table()
    names = [row[1] for row in cells]
    at = names.index("ukf5_known_bias")
    assert cells[at + 1][1:5] == ["  paper", "4.97", "4.47", "0.111"]
    assert cells[at + 2][1:5] == ["  reference", "2.27", "1.89", "0.034"]


def test_pictures_are_drawn(small, tmp_path):
    files = small.save_pictures(tmp_path)
    assert [f.stem for f in files] == [
        *("usv-mission", "usv-errors", "usv-biases"),
        *("usv-closed-loop", "usv-cross-track", "usv-compass"),
    ]
    assert all(f.read_bytes().startswith(b"\x89PNG") for f in files)


@pytest.mark.parametrize("seed", [0, 3])
def test_what_is_found_of_a_bias_is_seen_all_the_time(seed):
    pytest.importorskip("matplotlib")
    from wakeline import plot

    mission = usv.missions()[usv.SHOWN]
    beliefs = usv.navigate(usv.ESTIMATORS[usv.DEFAULT], mission, mission.draw(1, [seed, 0]), 0)
    for axis in range(3):
        ax = usv._draw_bias(plot.figure().add_subplot(), mission, beliefs, axis)
        low, high = ax.get_ylim()
        found = ax.lines[0].get_ydata()
        assert low <= found.min()
        assert found.max() <= high
