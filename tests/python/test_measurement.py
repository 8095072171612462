"""Sensors in Python: seams, own ship, the polar conversion and rejected parameters."""

import copy

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl

bearings = st.floats(-np.pi, np.pi)
ranges = st.floats(50.0, 20000.0)
places = st.floats(-5000.0, 5000.0)
SENSORS = {
    "RangeBearing": wl.RangeBearing(range_std_m=10.0, bearing_std_rad=0.01),
    "ConvertedRangeBearing": wl.ConvertedRangeBearing(range_std_m=10.0, bearing_std_rad=0.01),
    "RangeBearingDoppler": wl.RangeBearingDoppler(
        range_std_m=10.0, bearing_std_rad=0.01, range_rate_std_mps=0.5
    ),
    "Position": wl.Position(position_std_m=10.0),
    "Bearing": wl.Bearing(bearing_std_rad=0.01),
    "Range": wl.Range(range_std_m=10.0),
}


@given(ranges, bearings)
def test_bearings_are_clockwise_from_north(range_m, bearing_rad):
    place = SENSORS["RangeBearing"].position([range_m, bearing_rad]).mean
    # The conversion is unbiased: it lies on the same line, a little farther or nearer.
    assert wl.wrap_angle(np.arctan2(place[1], place[0]) - bearing_rad) == pytest.approx(0, abs=1e-9)
    assert np.hypot(*place) == pytest.approx(range_m, rel=1e-3)


@given(ranges, bearings, places, places)
def test_a_moved_own_ship_moves_what_it_sees(range_m, bearing_rad, north_m, east_m):
    at_rest = wl.RangeBearing(range_std_m=10.0, bearing_std_rad=0.01)
    moved = wl.RangeBearing(
        range_std_m=10.0, bearing_std_rad=0.01, own=wl.OwnShip(north_m=north_m, east_m=east_m)
    )
    z = [range_m, bearing_rad]
    np.testing.assert_allclose(
        moved.position(z).mean - [north_m, east_m], at_rest.position(z).mean, atol=1e-6
    )
    np.testing.assert_allclose(
        moved.position(z).covariance, at_rest.position(z).covariance, rtol=1e-9, atol=1e-9
    )


@given(ranges, bearings, places, places)
def test_what_is_measured_is_where_it_is(range_m, bearing_rad, north_m, east_m):
    sensor = wl.RangeBearing(own=wl.OwnShip(north_m=north_m, east_m=east_m))
    place = [north_m + range_m * np.cos(bearing_rad), east_m + range_m * np.sin(bearing_rad)]
    measured = sensor.measure(place)
    assert measured[0] == pytest.approx(range_m)
    assert wl.wrap_angle(measured[1] - bearing_rad) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("name", ["RangeBearing", "RangeBearingDoppler"])
@given(range_m=st.floats(200.0, 20000.0), bearing_rad=st.floats(-3.0, 3.0))
def test_the_jacobian_is_the_slope(name, range_m, bearing_rad):
    sensor = SENSORS[name]
    place = range_m * np.array([np.cos(bearing_rad), np.sin(bearing_rad)])
    x = place if name == "RangeBearing" else np.array([place[0], 5.0, place[1], -7.0])
    h = 1e-3
    slope = [(sensor.measure(x + e) - sensor.measure(x - e)) / (2 * h) for e in h * np.eye(len(x))]
    np.testing.assert_allclose(sensor.jacobian(x), np.transpose(slope), atol=1e-7, rtol=1e-5)


def test_the_range_rate_is_that_which_own_ship_sees():
    own = wl.OwnShip(vnorth_mps=10.0)
    sensor = wl.RangeBearingDoppler(own=own)
    same_speed = sensor.measure([1000.0, 10.0, 0.0, 0.0])
    ahead = sensor.measure([1000.0, 15.0, 0.0, 0.0])
    assert same_speed[2] == pytest.approx(0.0, abs=1e-12)
    assert ahead[2] == pytest.approx(5.0)


def converted_error(unbiased, range_m, range_std_m, bearing_std_rad, draws=200_000):
    """Mean error and claimed and true mean square error of converted plots of one place."""
    rng = np.random.default_rng(5)
    sensor = wl.ConvertedRangeBearing(
        range_std_m=range_std_m, bearing_std_rad=bearing_std_rad, unbiased=unbiased
    )
    z = rng.normal([range_m, 0.5], [range_std_m, bearing_std_rad], (draws // 100, 2))
    plots = [sensor.observe(row) for row in z]
    truth = range_m * np.array([np.cos(0.5), np.sin(0.5)])
    errors = np.array([plot.mean for plot in plots]) - truth
    claimed = np.mean([np.trace(plot.covariance) for plot in plots])
    return errors.mean(axis=0), claimed, (errors**2).sum(axis=1).mean()


def test_the_unbiased_conversion_takes_the_bias_away():
    range_m, range_std_m, bearing_std_rad = 10_000.0, 10.0, 0.15
    assert wl.conversion_bias_matters(range_m, range_std_m, bearing_std_rad)
    plain, *_ = converted_error(False, range_m, range_std_m, bearing_std_rad)
    better, claimed, true = converted_error(True, range_m, range_std_m, bearing_std_rad)
    outward = np.array([np.cos(0.5), np.sin(0.5)])
    assert abs(plain @ outward) == pytest.approx(range_m * bearing_std_rad**2 / 2, rel=0.1)
    assert abs(better @ outward) < 0.15 * abs(plain @ outward)
    assert claimed == pytest.approx(true, rel=0.1)


@given(ranges, st.floats(1.0, 100.0), st.floats(1e-3, 0.2))
def test_the_bias_matters_above_four_tenths(range_m, range_std_m, bearing_std_rad):
    ratio = wl.conversion_bias_ratio(range_m, range_std_m, bearing_std_rad)
    assert ratio == pytest.approx(range_m * bearing_std_rad**2 / range_std_m)
    matters = wl.conversion_bias_matters(range_m, range_std_m, bearing_std_rad)
    assert matters == (ratio > 0.4)


def test_bias_functions_work_by_element():
    ratio = wl.conversion_bias_ratio(np.array([1e3, 1e5]), 10.0, 0.02)
    np.testing.assert_allclose(ratio, [0.04, 4.0])
    np.testing.assert_array_equal(
        wl.conversion_bias_matters(np.array([1e3, 1e5]), 10.0, 0.02), [False, True]
    )


def test_a_heading_error_widens_across_not_along():
    known = wl.ConvertedRangeBearing(range_std_m=10.0, bearing_std_rad=0.003)
    unsure = wl.ConvertedRangeBearing(
        range_std_m=10.0, bearing_std_rad=0.003, own=wl.OwnShip(heading_std_rad=0.004)
    )
    of_both = wl.ConvertedRangeBearing(range_std_m=10.0, bearing_std_rad=0.005)
    z = [5000.0, 0.0]
    wide = unsure.observe(z).covariance
    assert wide[1, 1] > 2.0 * known.observe(z).covariance[1, 1]
    np.testing.assert_allclose(wide, of_both.observe(z).covariance, rtol=1e-9)


def test_a_bearing_offset_is_taken_out():
    offset = wl.RangeBearing(bearing_offset_rad=0.02)
    plain = wl.RangeBearing()
    np.testing.assert_allclose(
        offset.position([1000.0, 0.52]).mean, plain.position([1000.0, 0.5]).mean, atol=1e-9
    )


@pytest.mark.parametrize("name", SENSORS)
@given(size=st.integers(0, 6))
def test_a_reading_of_wrong_size_is_rejected(name, size):
    sensor = SENSORS[name]
    if size == sensor.measurements:
        return
    with pytest.raises(
        ValueError, match=rf"z must have shape \({sensor.measurements},\), got \({size},\)"
    ):
        sensor.observe(np.zeros(size))


@pytest.mark.parametrize(
    ("build", "name"),
    [
        (lambda v: wl.RangeBearing(range_std_m=v), "range_std_m"),
        (lambda v: wl.RangeBearing(bearing_std_rad=v), "bearing_std_rad"),
        (lambda v: wl.RangeBearing(extent_std_m=v), "extent_std_m"),
        (lambda v: wl.ConvertedRangeBearing(range_std_m=v), "range_std_m"),
        (lambda v: wl.RangeBearingDoppler(range_rate_std_mps=v), "range_rate_std_mps"),
        (lambda v: wl.Position(position_std_m=v), "position_std_m"),
        (lambda v: wl.OwnShip(heading_std_rad=v), "heading_std_rad"),
        (lambda v: wl.OwnShip(position_std_m=v), "position_std_m"),
    ],
)
@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_parameters_that_are_invalid_are_rejected_by_name(build, name, value):
    with pytest.raises(ValueError, match=name):
        build(value)


@pytest.mark.parametrize("sensor", ["RangeBearing", "ConvertedRangeBearing", "RangeBearingDoppler"])
@pytest.mark.parametrize("value", [45.0, 90.0])
def test_degrees_where_radians_are_wanted_are_rejected(sensor, value):
    for build in (getattr(wl, sensor), wl.Radar):
        with pytest.raises(ValueError, match=r"bearing_std_rad must be .* in radians"):
            build(bearing_std_rad=value)
    with pytest.raises(ValueError, match=r"heading_std_rad must be .* in radians"):
        wl.OwnShip(heading_std_rad=value)


@pytest.mark.parametrize("name", ["position_std_m", "velocity_std_mps", "heading_std_rad"])
@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_own_ship_is_not_set_to_what_is_invalid(name, value):
    sensor = wl.RangeBearing(own=wl.OwnShip(north_m=5.0))
    with pytest.raises(ValueError, match=f"{name} must be "):
        setattr(sensor.own, name, value)
    setattr(sensor.own, name, 2.0)
    assert getattr(sensor.own, name) == 2.0
    assert sensor.own.north_m == 5.0


@pytest.mark.parametrize("name", SENSORS)
def test_a_sensor_copies(name):
    for copied in (copy.copy(SENSORS[name]), copy.deepcopy(SENSORS[name])):
        assert repr(copied) == repr(SENSORS[name])
        assert copied is not SENSORS[name]


def test_parameters_are_given_by_name():
    with pytest.raises(TypeError):
        wl.RangeBearing(10.0, 0.01)
