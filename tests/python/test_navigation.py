"""Geodesy, dead reckoning, leeway and drift."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl
from wakeline import navigation as nav

KNOT = 1852.0 / 3600.0
LATITUDE = st.floats(-1.5, 1.5)
LONGITUDE = st.floats(-np.pi, np.pi)
COURSE = st.floats(0.0, 2 * np.pi)


def wrapped(angle_rad):
    return (np.asarray(angle_rad) + np.pi) % (2 * np.pi) - np.pi


def plane_at(latitude, longitude):
    return nav.LocalPlane(latitude_rad=latitude, longitude_rad=longitude)


def position_m(plane, latitude, longitude):
    return plane.position_m(latitude_rad=latitude, longitude_rad=longitude)


def metres_apart(a, b):
    return float(nav.geodesic(*a, *b)[0])


# Geodesy


def test_geodesics_are_those_of_geographiclib():
    geodesic = pytest.importorskip("geographiclib.geodesic").Geodesic.WGS84
    rng = np.random.default_rng(1)
    latitude = np.degrees(np.arcsin(rng.uniform(-1, 1, (2, 500))))
    longitude = rng.uniform(-180, 180, (2, 500))
    places = np.radians([latitude[0], longitude[0], latitude[1], longitude[1]])
    distance_m, course_rad, arrival_rad = nav.geodesic(*places)
    found = 0
    for k in range(500):
        known = geodesic.Inverse(latitude[0, k], longitude[0, k], latitude[1, k], longitude[1, k])
        if known["a12"] > 179:  # nearly opposite each other
            continue
        found += 1
        assert distance_m[k] == pytest.approx(known["s12"], abs=1e-3)
        worth_m = 6.4e6 * np.sin(np.radians(known["a12"]))  # of a radian of course
        assert abs(wrapped(course_rad[k] - np.radians(known["azi1"]))) * worth_m < 1e-3
        assert abs(wrapped(arrival_rad[k] - np.radians(known["azi2"]))) * worth_m < 1e-3
    assert found > 450


def test_the_plane_is_true_to_a_millimetre_within_50_km_and_far_beyond():
    geodesic = pytest.importorskip("geographiclib.geodesic").Geodesic.WGS84
    rng = np.random.default_rng(2)
    for reach_m in (50e3, 1000e3):
        for _ in range(200):
            latitude, longitude = rng.uniform(-89, 89), rng.uniform(-180, 180)
            azimuth, distance_m = rng.uniform(0, 360), rng.uniform(0, reach_m)
            there = geodesic.Direct(latitude, longitude, azimuth, distance_m)
            plane = plane_at(np.radians(latitude), np.radians(longitude))
            place = np.radians([there["lat2"], there["lon2"]])
            wanted = distance_m * np.array(
                [np.cos(np.radians(azimuth)), np.sin(np.radians(azimuth))]
            )
            assert np.linalg.norm(position_m(plane, *place) - wanted) < 1e-3
            back = np.array(plane.place(wanted))
            assert metres_apart(back, place) < 1e-3


@given(LATITUDE, LONGITUDE, COURSE, st.floats(0.0, 5e6))
def test_geodesics_lead_where_they_came_from(latitude, longitude, course, distance_m):
    there = nav.geodesic_destination(latitude, longitude, course, distance_m)
    assert abs(there[1]) <= np.pi
    assert metres_apart((latitude, longitude), there) == pytest.approx(distance_m, abs=1e-5)


@given(LATITUDE, LONGITUDE, COURSE, st.floats(1.0, 2e6))
def test_rhumb_lines_lead_where_they_came_from(latitude, longitude, course, distance_m):
    there = nav.rhumb_destination(latitude, longitude, course, distance_m)
    if np.isnan(there[0]) or abs(there[0]) > 1.5:
        return  # beyond a pole, or round and round it
    assert abs(there[1]) <= np.pi
    found_m, found_rad = nav.rhumb_line(latitude, longitude, *there)
    assert found_m <= distance_m + 1e-4  # the shorter way round
    if abs(distance_m * np.sin(course)) < 6e6 * np.cos(1.5):
        assert found_m == pytest.approx(distance_m, abs=1e-4)
        assert abs(wrapped(found_rad - course)) * distance_m < 1e-3


@given(st.floats(-1.2, 1.2), st.floats(-0.01, 0.01), st.floats(-0.01, 0.01))
def test_nothing_happens_at_the_date_line(latitude, to_the_west, to_the_east):
    """What is near 180 degrees is as what is near 0."""
    here = nav.geodesic(latitude, to_the_west, latitude + 0.003, to_the_east)
    there = nav.geodesic(
        latitude, wrapped(np.pi + to_the_west), latitude + 0.003, wrapped(np.pi + to_the_east)
    )
    assert here[0] == pytest.approx(there[0], abs=1e-6)
    assert np.abs(wrapped(np.subtract(here[1:], there[1:]))).max() < 1e-6
    plane = plane_at(latitude, np.pi)
    mirrored = plane_at(latitude, -np.pi)
    place = latitude + 0.002, wrapped(np.pi + to_the_east)
    assert position_m(plane, *place) == pytest.approx(position_m(mirrored, *place), abs=1e-6)


def test_a_rhumb_line_is_the_integral_of_its_course():
    latitude, course = np.radians([10.0, 55.0]), np.radians(40.0)
    p = np.linspace(*latitude, 20001)
    m = (
        6378137.0
        * (1 - 0.0066943799901413165)
        / (1 - 0.0066943799901413165 * np.sin(p) ** 2) ** 1.5
    )
    n = 6378137.0 / np.sqrt(1 - 0.0066943799901413165 * np.sin(p) ** 2)
    step = p[1] - p[0]
    weights = np.ones(p.size) * 2.0
    weights[1::2] = 4.0
    weights[[0, -1]] = 1.0
    north_m = (weights * m).sum() * step / 3
    dlon = np.tan(course) * (weights * m / (n * np.cos(p))).sum() * step / 3
    there = nav.rhumb_destination(latitude[0], 3.0, course, north_m / np.cos(course))
    assert there[0] == pytest.approx(latitude[1], abs=1e-12)
    assert wrapped(there[1] - 3.0 - dlon) == pytest.approx(0.0, abs=1e-12)


def test_places_opposite_each_other_are_not_found():
    distance_m, course_rad, _ = nav.geodesic(0.0, 0.0, [0.001, 0.5], [np.pi - 0.001, 0.5])
    assert np.isnan(distance_m).tolist() == [True, False]
    assert np.isnan(course_rad).tolist() == [True, False]


def test_arrays_are_broadcast():
    plane = plane_at(0.8, 0.1)
    places_m = position_m(plane, np.full((3, 1), 0.801), np.linspace(0.1, 0.11, 4))
    assert places_m.shape == (3, 4, 2)
    latitude, longitude = plane.place(places_m)
    assert latitude.shape == longitude.shape == (3, 4)
    assert np.allclose(latitude, 0.801, atol=1e-12)
    place = {"latitude_rad": latitude, "longitude_rad": longitude}
    course = plane.plane_course_rad(1.0, **place)
    assert np.allclose(plane.true_course_rad(course, **place), 1.0)
    assert (plane.latitude_rad, plane.longitude_rad) == (0.8, 0.1)


def test_a_plane_takes_places_by_the_names_that_have_their_unit():
    plane = plane_at(0.8, 0.1)
    for call in (lambda: nav.LocalPlane(0.8, 0.1), lambda: plane.position_m(0.8, 0.1)):
        with pytest.raises(TypeError, match="latitude_rad"):
            call()


def test_latitudes_in_degrees_are_rejected():
    with pytest.raises(ValueError, match=r"latitude_rad must be from -pi/2 to pi/2, got 46\.5"):
        plane_at(46.5, 30.7)
    with pytest.raises(ValueError, match=r"to_latitude_rad must be .* got 46\.5"):
        nav.geodesic(0.8, 0.1, [0.8, 46.5], 0.1)
    with pytest.raises(ValueError, match="broadcast"):
        nav.geodesic([0.8, 0.8], 0.1, [0.8, 0.7, 0.6], 0.1)
    with pytest.raises(ValueError, match=r"position_m must have shape \(\.\.\., 2\), got \(3,\)"):
        plane_at(0.8, 0.1).place([1.0, 2.0, 3.0])


# Dead reckoning


@given(st.floats(-10, 10), st.floats(-0.1, 0.1), st.floats(0, 100), st.floats(0, 100))
def test_a_prediction_is_a_sum_of_steps(course, rate, first_s, second_s):
    at_once = nav.predict_course_rad(course, rate, first_s + second_s)
    in_steps = nav.predict_course_rad(nav.predict_course_rad(course, rate, first_s), rate, second_s)
    assert abs(wrapped(at_once - in_steps)) < 1e-9
    assert 0 <= at_once < 2 * np.pi


def test_predictions_of_each_quantity():
    assert nav.predict_speed_mps(5.0, -0.1, 10.0) == 4.0
    assert nav.predict_turn_rate_rad_s(0.01, 0.001, 10.0) == pytest.approx(0.02)
    assert nav.predict_latitude_rad(0.8, 1e-6, 10.0) == pytest.approx(0.80001)
    assert nav.predict_longitude_rad(np.pi - 1e-6, 1e-6, 2.0) == pytest.approx(-np.pi + 1e-6)
    # K + w t + a t² / 2, not + a t²
    assert nav.predict_course_rad(0.1, 0.01, 10.0, 0.002) == pytest.approx(0.3)
    assert nav.predict_position_m([0.0, 0.0], [1.0, 2.0], 10.0, [0.2, 0.0]) == pytest.approx(
        [20, 20]
    )
    assert nav.predict_position_m([[0.0, 0.0]] * 3, [1.0, 2.0], [1, 2, 3]).shape == (3, 2)
    speed, course = nav.speed_course(nav.velocity_mps([3.0, 5.0], [0.1, 6.2]))
    assert speed == pytest.approx([3.0, 5.0])
    assert course == pytest.approx([0.1, 6.2])


def test_motion_over_ground_adds_vectors_not_speeds():
    ground = nav.over_ground(nav.velocity_mps(5.0, 0.0), nav.velocity_mps(5.0, 2 * np.pi / 3))
    assert nav.speed_course(ground) == pytest.approx((5.0, np.pi / 3))
    water, drift = np.arange(12.0).reshape(3, 2, 2), np.array([1.0, -2.0])
    np.testing.assert_array_equal(nav.over_ground(water, drift), water + drift)
    np.testing.assert_array_equal(nav.over_ground(water, 0 * water), water)
    with pytest.raises(ValueError, match=r"drift must have shape \(\.\.\., 2\), got \(3,\)"):
        nav.over_ground([1.0, 2.0], [1.0, 2.0, 3.0])


def test_total_drift_is_the_sum_of_its_parts():
    drift = nav.TotalDrift([1.0, 0.0], [0.0, 2.0], residual_mps=[0.5, 0.25])
    np.testing.assert_array_equal(drift.velocity_mps(), [1.5, 2.25])
    np.testing.assert_array_equal(drift.current_mps, [0.0, 2.0])
    parts = (drift.wind_drift_mps, drift.current_mps, drift.residual_mps)
    np.testing.assert_array_equal(nav.TotalDrift(*parts).velocity_mps(), drift.velocity_mps())
    np.testing.assert_array_equal(nav.TotalDrift().velocity_mps(), [0.0, 0.0])
    leeway = nav.wind_drift_mps([0.0, 10.0], 0.04)
    blown = nav.TotalDrift(wind_drift_mps=leeway).velocity_mps()
    np.testing.assert_array_equal(nav.over_ground([3.0, 0.0], blown), [3.0, leeway[1]])
    with pytest.raises(ValueError, match=r"current_mps must have shape \(2,\), got \(3,\)"):
        nav.TotalDrift(current_mps=[1.0, 2.0, 3.0])


@given(st.floats(-1.2, 1.2), LONGITUDE, COURSE, st.floats(0.1, 10), COURSE, st.floats(0.0, 1.5))
def test_combined_dead_reckoning_is_the_rhumb_line(latitude, longitude, course, speed, set_, drift):
    total = nav.velocity_mps(speed, course) + nav.velocity_mps(drift, set_)
    ground_speed, ground_course = nav.speed_course(total)
    dt_s = min(3600.0, 20e3 / max(ground_speed, 0.01))
    reckoned = nav.dead_reckon(latitude, longitude, speed, course, dt_s, drift, set_)
    rhumb = nav.rhumb_destination(latitude, longitude, ground_course, ground_speed * dt_s)
    assert abs(reckoned[1]) <= np.pi
    assert metres_apart(reckoned, rhumb) < 1.0


def test_there_is_nothing_beyond_a_pole():
    north = np.deg2rad(89.99)
    assert np.isnan(nav.dead_reckon(north, 0.0, 10.0, 0.0, 3600.0)).all()
    assert np.isfinite(nav.dead_reckon(north, 0.0, 10.0, np.pi, 3600.0)).all()


def test_velocity_over_a_window_and_from_rates():
    time_s = np.array([0.0, 30.0, 45.0, 100.0])
    place = nav.rhumb_destination(0.8, np.pi - 1e-5, 1.5, 6.0 * time_s)
    wanted = nav.velocity_mps(6.0, 1.5)
    assert nav.velocity_over_window_mps(1e9 + time_s, *place) == pytest.approx(wanted, abs=1e-6)
    later = nav.dead_reckon(0.8, 0.0, 6.0, 1.5, 1.0)
    rates = nav.velocity_from_rates_mps(later[0] - 0.8, later[1], 0.8)
    assert rates == pytest.approx(wanted, abs=1e-4)
    with pytest.raises(ValueError, match=r"longitude_rad must have shape \(4,\), got \(2,\)"):
        nav.velocity_over_window_mps(time_s, place[0], [0.0, 0.1])


# Leeway


def test_leeway_and_stokes():
    assert nav.leeway_factor(nav.FloatingObject.dinghy) == (0.032, 0.045)
    assert nav.wind_drift_mps([[10.0, 0.0], [0.0, -10.0]], 0.04) == pytest.approx(
        np.array([[0.4, 0.0], [0.0, -0.4]])
    )
    assert nav.stokes_drift_mps(2.0, 50.0) == pytest.approx(0.1395, abs=5e-5)
    with pytest.raises(ValueError, match="wave_length_m"):
        nav.stokes_drift_mps(2.0, 0.0)


@given(st.floats(0, 30), COURSE, st.floats(np.radians(20), np.pi / 2))
def test_the_wind_current_is_mirrored_at_the_equator(wind, course, latitude):
    north = nav.wind_current_mps(nav.velocity_mps(wind, course), latitude)
    south = nav.wind_current_mps(nav.velocity_mps(wind, -course), -latitude)
    assert north == pytest.approx(south * [1, -1], abs=1e-12)
    speed, set_ = nav.speed_course(north)
    assert speed == pytest.approx(0.0127 * wind / np.sqrt(np.sin(latitude)), abs=1e-12)
    if wind > 1e-3:
        assert wrapped(set_ - course) == pytest.approx(np.pi / 4, abs=1e-9)


@pytest.mark.parametrize("latitude_deg", [0.0, 19.9, -19.9])
def test_near_the_equator_there_is_no_wind_current(latitude_deg):
    with pytest.raises(ValueError, match="20 degrees"):
        nav.wind_current_mps([10.0, 0.0], np.radians([45.0, latitude_deg]))


# Drift, observed


def reckoned_voyage(rng, fixes, fix_std_m=4.0):
    """A ship of 10 kn in a current of 1.2 kn to 060: log, compass, fixes (T, 2), current."""
    current = nav.velocity_mps(1.2 * KNOT, np.radians(60))
    course = rng.uniform(0, 2 * np.pi)
    ground = nav.velocity_mps(10 * KNOT, course) + current
    speed = 10 * KNOT + 0.1 * KNOT * rng.standard_normal(fixes)
    heading = course + np.radians(0.3) * rng.standard_normal(fixes)
    fix = 30.0 * np.arange(fixes)[:, None] * ground + fix_std_m * rng.standard_normal((fixes, 2))
    return speed, heading, fix, current


def test_drift_over_a_window_is_found_and_its_covariance_is_true():
    rng = np.random.default_rng(3)
    settings = {"log_std_mps": 0.1 * KNOT, "heading_std_rad": np.radians(0.3)}
    window = nav.DriftWindow(max_fixes=21, **settings)
    errors, nees = [], []
    for _ in range(1000):
        speed, heading, fix, current = reckoned_voyage(rng, 21)
        mean, covariance = window.run(30.0, speed, heading, fix, 4.0)
        assert np.isinf(covariance[0, 0, 0])
        off = mean[1:] - current
        errors.append(off)
        nees.append(np.einsum("ti,tij,tj->t", off, np.linalg.inv(covariance[1:]), off))
    rms_kn = np.sqrt((np.array(errors) ** 2).sum(axis=2).mean(axis=0)) / KNOT
    assert rms_kn[4] < 0.11  # five fixes after the first
    assert rms_kn[19] < 0.0305  # twenty; 0.0297 in the long run
    assert np.mean(nees, axis=0) == pytest.approx(2.0, abs=0.3)


def test_drift_over_a_window_is_the_best_line_through_differences_that_err_together():
    """Generalised least squares over positions and slope, of the fixes that are remembered."""
    rng = np.random.default_rng(5)
    log_std, heading_std, eye = 0.2, 0.01, np.eye(2)
    window = nav.DriftWindow(max_fixes=7, log_std_mps=log_std, heading_std_rad=heading_std)
    time_s, reckoned, summed, reported = 0.0, np.zeros(2), np.zeros((2, 2)), []
    for _ in range(20):
        for dt in rng.choice([0.0, 1.0, 7.0], 3):
            speed, heading = rng.uniform(0, 8), rng.uniform(-np.pi, np.pi)
            window.advance(dt, speed, heading)
            ahead, abeam = (
                nav.velocity_mps(1.0, heading),
                nav.velocity_mps(1.0, heading + np.pi / 2),
            )
            time_s += dt
            reckoned = reckoned + dt * speed * ahead
            summed = summed + (dt * log_std) ** 2 * np.outer(ahead, ahead)
            summed += (dt * speed * heading_std) ** 2 * np.outer(abeam, abeam)
        half = rng.standard_normal((2, 2))
        fix = wl.Gaussian(reckoned + 3.0 * rng.standard_normal(2), 9.0 * half @ half.T + eye)
        window.add(fix)
        reported = [*reported, (time_s, fix.mean - reckoned, fix.covariance, summed)][-7:]
        if not window.ready:
            continue
        times, off, of_fix, of_log = zip(*reported, strict=True)
        covariance = np.block(
            [
                [of_log[min(i, j)] - of_log[0] + (i == j) * of_fix[i] for j in range(len(reported))]
                for i in range(len(reported))
            ]
        )
        design = np.vstack([np.hstack([eye, (t - times[0]) * eye]) for t in times])
        weighted = np.linalg.solve(covariance, design).T
        best = np.linalg.inv(weighted @ design)
        slope = (best @ weighted @ np.concatenate(off))[2:]
        np.testing.assert_allclose(window.drift().mean, slope, rtol=1e-8, atol=1e-10)
        np.testing.assert_allclose(window.drift().covariance, best[2:, 2:], rtol=1e-8, atol=1e-12)


def test_a_window_step_by_step_is_its_run_and_bridges_missing_fixes():
    rng = np.random.default_rng(4)
    speed, heading, fix, _ = reckoned_voyage(rng, 12)
    fix[5] = np.nan
    window = nav.DriftWindow(max_fixes=6)
    mean, covariance = window.run(30.0, speed, heading, fix, 4.0)
    for k in range(12):
        if k:
            window.advance(30.0, speed[k], heading[k])
        if k != 5:
            window.add(wl.Gaussian(fix[k], 16.0 * np.eye(2)))
        assert window.drift().mean == pytest.approx(mean[k], abs=1e-12)
    assert window.size == 6
    assert window.ready
    assert np.isfinite(covariance[1:]).all()
    window.clear()
    assert not window.ready


def test_bad_windows_are_rejected():
    with pytest.raises(ValueError, match=r"max_fixes must be 2 to .*, got 1"):
        nav.DriftWindow(max_fixes=1)
    window = nav.DriftWindow()
    with pytest.raises(wl.FilterError, match="negative time step"):
        window.advance(-1.0, 5.0, 0.0)
    with pytest.raises(wl.FilterError, match="not positive definite"):
        window.add(wl.Gaussian([0.0, 0.0], -np.eye(2)))
    with pytest.raises(ValueError, match=r"fix must be over \[north, east\], got 4 states"):
        window.add(wl.Gaussian(np.zeros(4), np.eye(4)))
    with pytest.raises(wl.FilterError, match="advance in row 2: not finite"):
        window.run(1.0, [5.0, 5.0, np.nan], 0.0, np.zeros((3, 2)), 1.0)
    with pytest.raises(ValueError, match=r"speed_mps must have shape \(\) or \(3,\), got \(2,\)"):
        window.run(30.0, [1.0, 2.0], 0.0, np.zeros((3, 2)), 4.0)
    with pytest.raises(ValueError, match="fix_std_m"):
        window.run(30.0, 1.0, 0.0, np.zeros((3, 2)), 0.0)


@pytest.mark.parametrize("forecast", [nav.drift_forecast, nav.drift_particles])
def test_the_step_that_a_drift_cannot_take_is_named(forecast):
    start = wl.Gaussian(np.zeros(2), np.eye(2))
    with pytest.raises(wl.FilterError, match="in row 1: negative time step"):
        forecast(nav.DriftModel(), start, [60.0, -60.0], [5.0, 0.0], [0.0, 0.0])


def test_marks_give_the_ground_velocity_and_the_drift():
    relative = np.array([[-5.0, -1.0], [-5.2, -0.8]])
    covariance = np.array([np.eye(2) * 0.01, np.eye(2) * 0.04])
    ground = nav.ground_velocity_from_marks(relative, covariance)
    assert ground.mean == pytest.approx([5.04, 0.96])
    assert ground.covariance == pytest.approx(np.eye(2) * 0.008)
    water = nav.water_velocity(5.0, 0.0, log_std_mps=0.05, heading_std_rad=0.01)
    assert water.covariance == pytest.approx(np.eye(2) * 0.0025)
    drift = nav.drift_between(ground, water)
    assert drift.mean == pytest.approx([0.04, 0.96])
    assert nav.drift_from_rates_mps(ground.mean, 5.0, 0.0) == pytest.approx(drift.mean)
    assert nav.ground_stabilised_mps(-ground.mean, 5.0, 0.0, drift.mean) == pytest.approx(
        0, abs=1e-12
    )
    assert nav.sea_stabilised_mps(-ground.mean, 5.0, 0.0) == pytest.approx(-drift.mean)
    with pytest.raises(ValueError, match="mark 1"):
        nav.ground_velocity_from_marks(relative, covariance * [[[1]], [[-1]]])


# Drift, forecast

START = wl.Gaussian([100.0, -50.0], [[2500.0, 300.0], [300.0, 900.0]])


def test_particles_and_ellipse_agree():
    model = nav.DriftModel.of(nav.FloatingObject.dinghy)
    wind = np.stack([np.linspace(8, 4, 24), np.linspace(-2, 6, 24)], axis=1)
    mean, covariance = nav.drift_forecast(model, START, np.full(24, 600.0), wind, [0.3, 0.1])
    cloud = nav.drift_particles(
        model, START, np.full(24, 600.0), wind, [0.3, 0.1], count=20_000, seed=5
    )
    assert cloud.shape == (24, 20_000, 2)
    for k in (0, 11, 23):
        assert np.cov(cloud[k].T) == pytest.approx(
            covariance[k], rel=0.05, abs=0.05 * covariance[k, 0, 0]
        )
        off = cloud[k] - mean[k]
        nis = np.einsum("ni,ij,nj->n", off, np.linalg.inv(covariance[k]), off)
        assert (nis < wl.chi_square_quantile(0.95, 2)).mean() == pytest.approx(0.95, abs=0.01)
    areas = [nav.UncertaintyEllipse(c, 0.95).area_m2 for c in covariance]
    assert (np.diff(areas) > 0).all()


def test_a_cloud_is_the_same_for_the_same_seed_however_many_there_are():
    args = (nav.DriftModel(), START, np.full(3, 600.0), [8.0, 0.0], [0.0, 0.0])
    few = nav.drift_particles(*args, count=5, seed=7)
    many = nav.drift_particles(*args, count=50, seed=7)
    assert np.array_equal(few, many[:, :5])
    assert not np.array_equal(few, nav.drift_particles(*args, count=5, seed=8))


def test_an_ellipse_has_the_axes_of_its_covariance():
    ellipse = nav.UncertaintyEllipse([[100.0, 0.0], [0.0, 400.0]], 0.95)
    scale = np.sqrt(wl.chi_square_quantile(0.95, 2))
    assert ellipse.semi_major_m == pytest.approx(20 * scale)
    assert ellipse.semi_minor_m == pytest.approx(10 * scale)
    assert ellipse.major_axis_rad == pytest.approx(np.pi / 2)
    with pytest.raises(ValueError, match="probability"):
        nav.UncertaintyEllipse(np.eye(2), 1.0)
    with pytest.raises(ValueError, match="covariance"):
        nav.UncertaintyEllipse(-np.eye(2))


def test_bad_forecasts_are_rejected():
    with pytest.raises(ValueError, match="leeway_std must be 0 to 1e6, got -1"):
        nav.DriftModel(leeway_std=-1.0)
    with pytest.raises(ValueError, match="wind_mps must be finite"):
        nav.drift_forecast(nav.DriftModel(), START, 60.0, [np.nan, 0.0], [0.0, 0.0])
    with pytest.raises(
        ValueError, match=r"wind_mps must have shape \(2,\) or \(3, 2\), got \(4, 2\)"
    ):
        nav.drift_forecast(nav.DriftModel(), START, [60.0] * 3, np.zeros((4, 2)), [0.0, 0.0])
    with pytest.raises(ValueError, match="count"):
        nav.drift_particles(nav.DriftModel(), START, 60.0, [1.0, 0.0], [0.0, 0.0], count=0)
