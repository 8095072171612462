"""Forecasts of vessels from their AIS."""

import numpy as np
import pytest

from wakeline import study
from wakeline.recording import AisTrack
from wakeline.study import ais_forecast
from wakeline.study.ais_forecast import Origin


@pytest.fixture(scope="module")
def report():
    return ais_forecast.run()


def circling(rate_rad_s, speed_mps=8.0, step_s=5.0, count=25):
    """Exact reports of a vessel that turns at a rate and ends at north 0, east 0, course north."""
    age_s = step_s * (np.arange(count) - (count - 1))
    course = rate_rad_s * age_s
    if rate_rad_s == 0:
        north, east = speed_mps * age_s, 0 * age_s
    else:
        radius = speed_mps / rate_rad_s
        north, east = radius * np.sin(course), radius * (1 - np.cos(course))
    return AisTrack("1", 1000.0 + age_s, north, east, course, np.full(count, speed_mps))


@pytest.mark.parametrize("name", ais_forecast.models())
def test_a_straight_is_foretold_exactly(name):
    ahead_s = np.array([60.0, 360.0])
    place_m = ais_forecast.models()[name](Origin(circling(0.0), 0.0), ahead_s)
    np.testing.assert_allclose(place_m, [[480.0, 0.0], [2880.0, 0.0]], atol=1e-3)


def test_who_turns_on_stays_on_the_circle():
    rate = np.deg2rad(1.0)
    past = circling(rate)
    ahead_s = np.array([90.0, 180.0])
    place_m = ais_forecast.models()["turning_on"](Origin(past, rate), ahead_s)
    radius = 8.0 / rate
    wanted = radius * np.column_stack([np.sin(rate * ahead_s), 1 - np.cos(rate * ahead_s)])
    np.testing.assert_allclose(place_m, wanted, atol=0.1)


def test_errors_grow_with_time_and_turns_are_harder(report):
    for name in ais_forecast.models():
        medians = [
            report.row(f"after_{horizon_s:.0f}s", name)["position_median_m"]
            for horizon_s in ais_forecast.HORIZONS_S
        ]
        assert medians == sorted(medians)
        assert report.row("after_60s_turning", name)["position_median_m"] > medians[0]


def test_no_turn_goes_on_for_six_minutes(report):
    rows = {name: report.row("after_360s", name) for name in ais_forecast.models()}
    assert rows["turning_on"]["position_median_m"] > 1.5 * rows["last_report"]["position_median_m"]


def test_it_is_listed_and_its_picture_can_be_drawn(report, tmp_path):
    assert study.load("ais-forecast") is ais_forecast
    (file,) = report.save_pictures(tmp_path)
    assert file.stat().st_size > 5000
