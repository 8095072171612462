"""The study on forecasts of vessels from their AIS."""

import pytest

from wakeline import forecast, study
from wakeline.study import ais_forecast


@pytest.fixture(scope="module")
def report():
    return ais_forecast.run()


def test_errors_grow_with_time_and_turns_are_harder(report):
    for name in forecast.names():
        medians = [
            report.row(f"after_{horizon_s:.0f}s", name)["position_median_m"]
            for horizon_s in ais_forecast.HORIZONS_S
        ]
        assert medians == sorted(medians)
        assert report.row("after_60s_turning", name)["position_median_m"] > medians[0]


def test_no_turn_goes_on_for_six_minutes(report):
    rows = {name: report.row("after_360s", name) for name in forecast.names()}
    assert rows["turning_on"]["position_median_m"] > 1.5 * rows["last_report"]["position_median_m"]


def test_it_is_listed_and_its_picture_can_be_drawn(report, tmp_path):
    assert study.load("ais-forecast") is ais_forecast
    (file,) = report.save_pictures(tmp_path)
    assert file.stat().st_size > 5000
