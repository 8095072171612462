"""Several sensors in one picture: the laws of the study ``fusion``, a run of each scene."""

import pytest

from wakeline.study import fusion


@pytest.fixture(scope="module")
def report():
    return fusion.run(runs=1, seed=1)


def test_two_radars_are_better_than_the_better_one(report):
    fine, coarse, both = (report.row("two_radars", name) for name in ("fine", "coarse", "both"))
    assert both["position_m"] <= 0.95 * fine["position_m"] < coarse["position_m"]
    assert both["gospa_m"] < min(fine["gospa_m"], coarse["gospa_m"])
    assert both["coverage"] >= 0.99
    assert both["double_s"] <= 9.0


def test_reports_make_positions_better_and_name_the_vessels(report):
    radar, both, in_place = (report.row("ais", name) for name in ("radar", "both", "in_place"))
    assert in_place["position_m"] <= 0.55 * radar["position_m"]
    assert in_place["velocity_mps"] <= 0.95 * both["velocity_mps"]
    assert both["position_m"] <= 0.8 * radar["position_m"]
    assert both["velocity_mps"] <= radar["velocity_mps"]
    assert both["identity_right"] >= 0.99


def test_reports_that_lie_do_no_harm(report):
    radar, both = (report.row("wrong_ais", name) for name in ("radar", "both"))
    assert both["position_m"] <= radar["position_m"]
    assert both["coverage"] >= 0.995 * radar["coverage"]
    assert both["identity_right"] >= 0.98
