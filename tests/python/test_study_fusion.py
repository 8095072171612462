"""Several sensors in one picture: the laws of the study ``fusion``, a run of each scene."""

import numpy as np
import pytest

from wakeline.study import fusion
from wakeline.study.known_law import Law, Particles


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


def test_what_knows_the_law_of_motion_is_better_than_what_does_not(report):
    for by_law, tracker in (("radar_by_law", "radar"), ("both_by_law", "in_place")):
        knows, learns = (report.row("ais", name) for name in (by_law, tracker))
        assert 0.0 < knows["velocity_mps"] < learns["velocity_mps"]
        assert 0.0 < knows["position_m"] < learns["position_m"]


def test_late_measurements_weigh_particles_by_where_they_were():
    law = Law(straight_s=(100.0, 100.0), turn_s=(10.0, 20.0), turn_deg_s=(1.0, 2.0))
    rng = np.random.default_rng(3)
    particles = Particles(law, 4000, np.array([0.0, 5.0, 0.0, 0.0]), 0.0, rng)
    particles.move_to(10.0)
    particles.remember("fix")
    particles.move_to(30.0)
    particles.weigh((particles.recall("fix")[0] - 60.0) ** 2)
    # 10 m ahead after 10 s, half of it by the start and half by a speed that has lasted since.
    assert particles.mean[1] == pytest.approx(5.5, abs=0.2)
    assert particles.mean[0] == pytest.approx(60.0 + 20.0 * particles.mean[1], abs=1.0)


def test_reports_that_lie_do_no_harm(report):
    radar, both = (report.row("wrong_ais", name) for name in ("radar", "both"))
    assert both["position_m"] <= radar["position_m"]
    assert both["coverage"] >= 0.995 * radar["coverage"]
    assert both["identity_right"] >= 0.98
