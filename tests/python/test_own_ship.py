"""Own ship's solution from Python; what it is worth is in the tests of the command."""

import dataclasses

import numpy as np
import pytest

from wakeline import own_ship, recording
from wakeline.navigation import LocalPlane


def longest_part(**options):
    """Of the log that ships with the package."""
    return max(recording.load_navigation(**options).parts(), key=lambda part: len(part.fixes))


def test_the_bundled_log_is_navigated():
    part = longest_part()
    offset = own_ship.magnetic_offset([part])
    readings = own_ship.readings_of(part, offset)
    track = own_ship.navigate(readings)
    fixed = readings.has_fix & (track.status == "ok")
    away_m = np.hypot(*(track.position_m - readings.fix_m)[fixed].T)
    assert np.median(away_m) < own_ship.JUMP_M / 10
    errors = own_ship.medians(own_ship.hold_out(readings)["navigator"])
    assert list(errors) == list(own_ship.HORIZONS_S)
    assert 0 < errors[10.0] < errors[30.0] < errors[60.0] < 20.0


def test_smoothed_it_is_surer_of_the_same_voyage():
    readings = own_ship.readings_of(longest_part(variation_deg=2.0))
    as_it_went = own_ship.navigate(readings)
    smoothed = own_ship.navigate(readings, smooth=True)
    np.testing.assert_array_equal(smoothed.status, as_it_went.status)
    np.testing.assert_array_equal(smoothed.time_s, readings.time_s)

    def variance_m2(track):
        return np.trace(track.position_m2, axis1=1, axis2=2)

    assert np.median(variance_m2(smoothed) / variance_m2(as_it_went)) < 0.6


def test_a_log_that_cannot_be_navigated_as_a_whole_is_rejected_in_words():
    part = longest_part()
    unfixed = dataclasses.replace(part, fixes=part.fixes.rows(slice(0)))
    with pytest.raises(ValueError, match="irene: a set of readings needs a usable fix, got none"):
        own_ship.readings_of(unfixed)
    again = dataclasses.replace(part, set_back_lines=part.fixes.line[500:501])
    with pytest.raises(ValueError, match=r"irene: the clock was set back.* each of parts"):
        own_ship.readings_of(again)
    assert own_ship.magnetic_offset([]) is None


def fixes_alone(time_s, fix_m):
    """Readings of a receiver without velocities, aboard a ship without other instruments."""
    none, pairs = np.full(len(time_s), np.nan), np.full((len(time_s), 2), np.nan)
    return own_ship.Readings(
        plane=LocalPlane(latitude_rad=0.9, longitude_rad=0.1),
        time_s=time_s,
        fix_m=fix_m,
        velocity_mps=pairs,
        heading_rad=none,
        log_mps=none,
        leeway_rad=np.zeros(len(time_s)),
        bottom_mps=pairs,
        turn_rate_rad_s=none,
        lean_rad=np.zeros(len(time_s)),
        offset_std_rad=0.0,
    )


def test_seldom_fixes_report_as_much_of_the_velocity_whatever_times_lie_between():
    time_s = np.arange(0.0, 1200.0, 40.0)
    course_rad = np.pi / 2 * (time_s > 600.0)
    velocity_mps = 5.0 * np.column_stack([np.cos(course_rad), np.sin(course_rad)])
    fix_m = np.cumsum(40.0 * velocity_mps, axis=0)
    often_s = np.arange(0.0, time_s[-1] + 1.0)
    often_m = np.full((len(often_s), 2), np.nan)
    often_m[::40] = fix_m
    seldom = own_ship.navigate(fixes_alone(time_s, fix_m))
    often = own_ship.navigate(fixes_alone(often_s, often_m))
    between = {"atol": 0.2, "rtol": 0.05}
    np.testing.assert_allclose(seldom.velocity_mps, often.velocity_mps[::40], **between)
    np.testing.assert_allclose(seldom.velocity_m2s2, often.velocity_m2s2[::40], **between)
    misfit = seldom.velocity_mps - velocity_mps
    nees = np.einsum("ti,tij,tj->t", misfit, np.linalg.inv(seldom.velocity_m2s2), misfit)
    assert nees.max() < 13.8  # within 99.9 % of what it claims


def test_a_pause_of_a_month_is_not_a_month_of_short_steps():
    fix_m = np.array([[0.0, 0.0], [10.0, 0.0], [5e4, 2e4], [5e4, 2e4]])
    time_s = np.array([0.0, 10.0, 2.6e6, 2.6e6 + 10.0])
    rows, steps_s = own_ship.solution._in_short_steps(time_s)
    np.testing.assert_array_equal(steps_s[rows], time_s)
    assert len(steps_s) < 150
    track = own_ship.navigate(fixes_alone(time_s, fix_m))
    np.testing.assert_allclose(track.position_m[2:], fix_m[2:], atol=20.0)
