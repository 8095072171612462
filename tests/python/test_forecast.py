"""Where other vessels will be, from their reports."""

import numpy as np
import pytest

import wakeline as wl
from wakeline import forecast
from wakeline.recording import AisTrack, Tracks

PLACE_M = [5000.0, -3000.0]  # of the last report


def circling(rate_rad_s, speed_mps=8.0, step_s=5.0, count=25):
    """Exact reports of a vessel that turns at a rate and ends with course north."""
    age_s = step_s * (np.arange(count) - (count - 1))
    course = rate_rad_s * age_s
    if rate_rad_s == 0:
        north, east = speed_mps * age_s, 0 * age_s
    else:
        radius = speed_mps / rate_rad_s
        north, east = radius * np.sin(course), radius * (1 - np.cos(course))
    speed = np.full(count, speed_mps)
    return AisTrack("1", 1000.0 + age_s, PLACE_M[0] + north, PLACE_M[1] + east, course, speed)


def placed_at(north_m):
    """A straight of which one report has another place."""
    track = circling(0.0)
    track.north_m[-3] = north_m
    return track


@pytest.mark.parametrize("model", forecast.names())
def test_a_straight_is_predicted_exactly(model):
    place_m = forecast.position_m(circling(0.0), [0.0, 60.0, 360.0], model)
    np.testing.assert_allclose(place_m - PLACE_M, [[0, 0], [480, 0], [2880, 0]], atol=1e-3)


def test_who_turns_on_stays_on_the_circle():
    rate = np.deg2rad(1.0)
    ahead_s = np.array([90.0, 180.0])
    place_m = forecast.position_m(circling(rate), ahead_s, "turning_on")
    radius = 8.0 / rate
    wanted = radius * np.column_stack([np.sin(rate * ahead_s), 1 - np.cos(rate * ahead_s)])
    np.testing.assert_allclose(place_m - PLACE_M, wanted, atol=0.1)


def test_a_turn_that_ends_continues_straight():
    rate = np.deg2rad(1.0)
    place_m = forecast.position_m(circling(rate), [300.0, 360.0], "turn_that_ends")
    north_m, east_m = np.diff(place_m, axis=0)[0]
    assert np.hypot(north_m, east_m) == pytest.approx(480.0, rel=1e-6)
    assert np.degrees(np.arctan2(east_m, north_m)) == pytest.approx(30.0, abs=0.01)


@pytest.mark.parametrize("model", ["window_5", "two_pass", "window_bank"])
def test_smoothers_rest_from_the_noise_of_reports(model):
    rng = np.random.default_rng(5)
    off_m = {model: [], "last_report": []}
    for _ in range(60):
        noisy = circling(0.0)
        noisy.course_rad[:] = wl.wrap_angle(np.pi + np.deg2rad(3.0) * rng.standard_normal(25))
        for name, found in off_m.items():
            place_m = forecast.position_m(noisy, [60.0], name)[0] - PLACE_M
            found.append(np.hypot(place_m[0] + 480.0, place_m[1]))
    assert np.mean(off_m[model]) < 0.95 * np.mean(off_m["last_report"])


def test_the_kalman_filter_counts_each_position_once():
    age_s = np.array([-30.0, 0.0])
    track = AisTrack("1", age_s, np.array([0.0, 200.0]), np.zeros(2), np.zeros(2), np.full(2, 5.0))
    move, noise = np.array([[1.0, 30.0], [0.0, 1.0]]), 0.1 * np.array([[9e3, 450.0], [450.0, 30.0]])
    state = move @ [0.0, 5.0]
    covariance = move @ np.diag([10.0**2, 1.0]) @ move.T + noise
    gain = covariance[:, 0] / (covariance[0, 0] + 10.0**2)
    state = state + gain * (200.0 - state[0])
    place_m = forecast.position_m(track, [60.0], "kalman_cv")[0]
    np.testing.assert_allclose(place_m, [state[0] + 60.0 * state[1], 0.0], atol=1e-9)


def test_unless_reported_otherwise_it_continues_as_last_reported():
    track = circling(np.deg2rad(1.0))
    place_m = forecast.position_m(track, [60.0])
    np.testing.assert_allclose(place_m - PLACE_M, [[480.0, 0.0]], atol=1e-9)


def rows_of(track, number="7"):
    """The same as rows of a track of the radar."""
    columns = (track.north_m, track.vnorth_mps, track.east_m, track.veast_mps)
    return Tracks(np.full(len(track), number), track.time_s, np.column_stack(columns))


@pytest.mark.parametrize("model", forecast.names())
def test_a_track_of_the_radar_is_predicted_as_the_reports_that_say_the_same(model):
    reports, ahead_s = circling(np.deg2rad(-1.0)), [0.0, 60.0, 180.0]
    rows = rows_of(reports)
    np.testing.assert_allclose(
        forecast.position_m(rows, ahead_s, model),
        forecast.position_m(reports, ahead_s, model),
        atol=1e-6,
    )
    assert forecast.turn_rate_rad_s(rows) == pytest.approx(np.deg2rad(-1.0), abs=1e-9)


def test_the_rate_of_turn_is_that_of_the_courses_that_are_reported():
    track = circling(np.deg2rad(1.0))
    track.course_rad[[-4, -2]] = np.nan
    assert forecast.turn_rate_rad_s(track) == pytest.approx(np.deg2rad(1.0), abs=1e-9)
    assert forecast.turn_rate_rad_s(track.rows(slice(-2, None))) == 0.0
    assert forecast.turn_rate_rad_s(track.rows(slice(0, 0))) == 0.0
    assert forecast.turn_rate_rad_s(Tracks.joined([])) == 0.0


def test_reports_of_one_time_report_no_rate_of_turn():
    seen = circling(np.deg2rad(1.0), step_s=40.0, count=3)
    again = seen.rows(np.array([0, 1, 2, 2, 2]))  # heard by three stations
    assert forecast.turn_rate_rad_s(again) == 0.0
    for model in ("turning_on", "turn_that_ends"):
        place_m = forecast.position_m(again, [60.0], model)
        np.testing.assert_allclose(place_m, forecast.position_m(again, [60.0]), atol=1e-9)


def test_of_several_tracks_none_is_predicted():
    one, other = rows_of(circling(0.0)), rows_of(circling(0.0), "8")
    with pytest.raises(ValueError, match="rows of one track, got 2"):
        forecast.position_m(Tracks.joined([one, other]), [60.0])
    with pytest.raises(ValueError, match="in order of time"):
        forecast.position_m(Tracks.joined([one, one]), [60.0])


@pytest.mark.parametrize("rate_deg_s", [0.0, 1.0, -2.0])
def test_the_rate_of_turn_is_that_of_the_course_through_north(rate_deg_s):
    rate = np.deg2rad(rate_deg_s)
    assert forecast.turn_rate_rad_s(circling(rate)) == pytest.approx(rate, abs=1e-9)
    assert forecast.turn_rate_rad_s(circling(rate, count=2)) == 0.0


@pytest.mark.parametrize(
    ("track", "ahead_s", "model", "wanted"),
    [
        (circling(0.0), [60.0], "magic", "model must be one of last_report"),
        (circling(0.0), [-1.0], "line_60s", "ahead_s must be finite times"),
        (circling(0.0), [np.nan], "line_60s", "ahead_s must be finite times"),
        (circling(0.0), [np.inf], "turning_on", "ahead_s must be finite times"),
        (circling(0.0), 60.0, "line_60s", "ahead_s must be finite times"),
        (circling(0.0, speed_mps=np.nan), [60.0], "last_report", "a course and a speed"),
        (placed_at(np.nan), [60.0], "line_60s", "a position, a course and a speed"),
        (circling(0.0, count=1), [60.0], "line_60s", "reports of two times or more"),
        (circling(0.0, step_s=0.0), [60.0], "line_60s", "reports of two times or more"),
        (circling(0.0, count=0), [60.0], "last_report", "reports of two times or more"),
        (circling(0.0, step_s=90.0), [60.0], "kalman_cv", "reports of two times or more"),
    ],
)
def test_what_cannot_be_predicted_is_rejected(track, ahead_s, model, wanted):
    with pytest.raises(ValueError, match=wanted):
        forecast.position_m(track, ahead_s, model)
