"""The study on forecasts of vessels from their AIS."""

import re
from pathlib import Path

import pytest

from wakeline import forecast, study
from wakeline.study import ais_forecast

PAGE = (Path(__file__).parents[2] / "cpp/docs/theory/ais_forecast.md").read_text()


@pytest.fixture(scope="module")
def report():
    return ais_forecast.run()


@pytest.mark.parametrize("name", forecast.names())
def test_the_figures_are_those_of_the_page(report, name):
    (cells,) = re.findall(rf"^\| `{name}` \| ([\d, |]+) \|$", PAGE, flags=re.MULTILINE)
    cases = [f"after_{s:.0f}s{end}" for end in ("", "_turning") for s in ais_forecast.HORIZONS_S]
    for case, cell in zip(cases, cells.split(" | "), strict=True):
        row = report.row(case, name)
        found = row["position_median_m"], row["position_p90_m"]
        assert found == pytest.approx([float(number) for number in cell.split(", ")], abs=0.6)
    assert f"{report.notes[0].split(' forecasts')[0]} forecasts." in PAGE


def test_errors_grow_with_time_and_turns_are_harder(report):
    for name in forecast.names():
        medians = [
            report.row(f"after_{horizon_s:.0f}s", name)["position_median_m"]
            for horizon_s in ais_forecast.HORIZONS_S
        ]
        assert medians == sorted(medians)
        assert report.row("after_60s_turning", name)["position_median_m"] > medians[0]


def test_no_turn_continues_for_six_minutes(report):
    rows = {name: report.row("after_360s", name) for name in forecast.names()}
    assert rows["turning_on"]["position_median_m"] > 1.5 * rows["last_report"]["position_median_m"]


def test_it_is_listed_and_its_picture_can_be_drawn(report, tmp_path):
    assert study.load("ais-forecast") is ais_forecast.STUDY
    (file,) = report.save_pictures(tmp_path)
    assert file.stat().st_size > 5000
