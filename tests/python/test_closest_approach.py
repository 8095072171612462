"""Closest approach of ships, and own ship's velocity."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl
from wakeline.recording import OwnShipMotion, RecordingError
from wakeline.recording.own_csv import read_own

KNOT = 1852.0 / 3600.0
MILE_M = 1852.0
HEAD = (
    "time_s,north_m,east_m,vnorth_mps,veast_mps,"
    "vnorth_var_m2s2,vnorth_veast_cov_m2s2,veast_var_m2s2"
)
SPEED = st.floats(-15.0, 15.0)
PLACE = st.floats(-2e4, 2e4)
SHIP = st.tuples(PLACE, SPEED, PLACE, SPEED)

closest_approach = wl.navigation.closest_approach


# The engine ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("own_kn", "range_nm", "bearing_deg", "course_deg", "speed_kn", "cpa_nm", "tcpa_min"),
    [
        (10, 8, 0, 180, 20, 0, 24),
        (10, 1, 0, 90, 10, 1, 0),
        (5, 8, 45, 225, 20, 0, 24),
        (25, 8, 45, 225, 20, 0, 24),
    ],
)
def test_the_scenarios_of_a823(
    own_kn, range_nm, bearing_deg, course_deg, speed_kn, cpa_nm, tcpa_min
):
    bearing, course = np.radians([bearing_deg, course_deg])
    own = np.array([0.0, own_kn * KNOT, 0.0, 0.0])
    place = range_nm * MILE_M * np.array([np.cos(bearing), np.sin(bearing)])
    velocity = own[1::2] + speed_kn * KNOT * np.array([np.cos(course), np.sin(course)])
    target = [place[0], velocity[0], place[1], velocity[1]]
    approach = closest_approach(own, target)
    assert approach.cpa_m / MILE_M == pytest.approx(cpa_nm, abs=1e-9)
    assert approach.tcpa_s / 60.0 == pytest.approx(tcpa_min, abs=1e-9)
    assert approach.cpa_std_m == 0.0


@given(own=SHIP, target=SHIP, after_s=st.floats(-600.0, 600.0))
def test_no_time_is_closer_than_the_closest(own, target, after_s):
    approach = closest_approach(own, target)
    x, vx, y, vy = np.subtract(target, own)
    there_m = np.hypot(x + vx * after_s, y + vy * after_s)
    assert there_m >= approach.cpa_m * (1 - 1e-9) - 1e-6 or np.hypot(vx, vy) <= 1e-6


@given(own=SHIP, target=SHIP)
def test_both_ships_see_the_same(own, target):
    one, other = closest_approach(own, target), closest_approach(target, own)
    np.testing.assert_allclose(one.signed_cpa_m, other.signed_cpa_m, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(one.tcpa_s, other.tcpa_s, rtol=1e-9, atol=1e-9)


def test_many_pairs_are_each_pair_alone():
    rng = np.random.default_rng(1)
    own = rng.normal(scale=[2e3, 8, 2e3, 8], size=(3, 1, 4))
    target = rng.normal(scale=[2e3, 8, 2e3, 8], size=(5, 4))
    root = rng.normal(scale=0.5, size=(5, 4, 4))
    covariance = root @ np.swapaxes(root, -1, -2)
    own_covariance = np.diag([4.0, 0.1, 4.0, 0.1])
    every = closest_approach(own, target, own_covariance, covariance)
    assert every.covariance.shape == (3, 5, 2, 2)
    for i in range(3):
        for j in range(5):
            one = closest_approach(own[i, 0], target[j], own_covariance, covariance[j])
            for name in ("cpa_m", "signed_cpa_m", "tcpa_s", "cpa_std_m", "tcpa_std_s"):
                assert getattr(every, name).shape == (3, 5)
                assert getattr(every, name)[i, j] == getattr(one, name)
            assert every.probability(500.0, 900.0)[i, j] == one.probability(500.0, 900.0)
    assert closest_approach(np.zeros(4), np.zeros((0, 4))).probability(1.0).shape == (0,)


def test_the_probability_is_the_share_of_draws_that_come_so_close():
    target = np.array([6000.0, -8.0, 700.0, 0.5])
    covariance = np.diag([900.0, 0.25, 900.0, 0.25])
    rng = np.random.default_rng(2)
    x, vx, y, vy = (target + rng.standard_normal((100_000, 4)) * np.sqrt(np.diag(covariance))).T
    approach = closest_approach(np.zeros(4), target, None, covariance)
    for limit_m, horizon_s in [(926.0, 1200.0), (1200.0, 1200.0), (1500.0, 700.0)]:
        t = np.clip(-(x * vx + y * vy) / (vx**2 + vy**2), 0.0, horizon_s)
        share = np.mean(np.hypot(x + vx * t, y + vy * t) < limit_m)
        assert approach.probability(limit_m, horizon_s) == pytest.approx(share, abs=0.02)
    d = (y * vx - x * vy) / np.hypot(vx, vy)
    assert np.std(d) == pytest.approx(approach.cpa_std_m, rel=0.02)


def test_ships_that_keep_together_stay_at_their_range():
    approach = closest_approach([0.0, 5.0, 0.0, 2.0], [300.0, 5.0, -400.0, 2.0])
    assert approach.cpa_m == 500.0
    assert approach.tcpa_s == 0.0
    assert approach.probability(501.0) == 1.0


def test_what_is_not_a_number_gives_none():
    approach = closest_approach(np.zeros(4), [[np.nan, 1.0, 1.0, 1.0], [9.0, -1.0, 1.0, 0.0]])
    assert np.isnan(approach.cpa_m).tolist() == [True, False]
    assert np.isnan(approach.probability(5.0)).tolist() == [True, False]
    lost = closest_approach([0.0, 5.0, 0.0, 0.0], [np.nan, 5.0, 100.0, 0.0])  # at relative rest
    assert np.isnan([lost.cpa_m, lost.tcpa_s, lost.cpa_std_m, lost.tcpa_std_s]).all()


@pytest.mark.parametrize(
    ("arguments", "wanted"),
    [
        ((np.zeros(3), np.zeros(4)), r"own must have shape \(..., 4\), got \(3,\)"),
        ((np.zeros(4), np.zeros((4, 2))), r"target must have shape"),
        ((np.zeros(4), np.zeros(4), np.eye(2)), r"own_covariance must have shape"),
        ((np.zeros((2, 4)), np.zeros((3, 4))), "broadcast"),
    ],
)
def test_shapes_that_do_not_fit_are_named(arguments, wanted):
    with pytest.raises(ValueError, match=wanted):
        closest_approach(*arguments)


@pytest.mark.parametrize("limits", [(-1.0, 5.0), (1.0, -5.0), (np.nan, 5.0), (1.0, np.nan)])
def test_limits_below_zero_are_rejected(limits):
    with pytest.raises(ValueError, match="must not be negative"):
        closest_approach(np.zeros(4), np.ones(4)).probability(*limits)


# Own ship's velocity ------------------------------------------------------------------------------


def test_own_velocity_is_the_recorded_one_else_that_of_the_positions():
    time_s = np.arange(0.0, 100.0, 2.0)
    places = (10.0 + 3.0 * time_s, 5.0 - 4.0 * time_s)
    steady = OwnShipMotion(time_s, *places)
    np.testing.assert_allclose(steady.velocity_at([0.0, 31.0, 120.0]), [[3.0, -4.0]] * 3)
    gap = np.where(time_s == 30.0, np.nan, 7.0)
    reported = OwnShipMotion(time_s, *places, vnorth_mps=gap, veast_mps=gap)
    np.testing.assert_allclose(reported.velocity_at([30.0, 999.0]), [[7.0, 7.0]] * 2)
    lost = np.full(50, np.nan)
    untold = OwnShipMotion(time_s, *places, vnorth_mps=lost, veast_mps=lost)
    np.testing.assert_allclose(untold.velocity_at([31.0]), [[3.0, -4.0]])
    assert steady.knows_velocity
    assert not OwnShipMotion.fixed().knows_velocity


def test_a_covariance_of_own_ship_is_interpolated_over_rows_that_report_none():
    time_s = np.arange(4.0)
    covariance = np.array([1.0, np.nan, 3.0, 5.0])[:, None, None] * np.array(
        [[1.0, 0.5], [0.5, 2.0]]
    )
    own = OwnShipMotion(time_s, time_s, time_s, time_s, time_s, velocity_m2s2=covariance)
    at = own.velocity_m2s2_at([0.0, 1.0, 2.5, 9.0])
    np.testing.assert_allclose(at[:, 0, 0], [1.0, 2.0, 4.0, 5.0])
    np.testing.assert_allclose(at[:, 0, 1], at[:, 0, 0] / 2.0)
    assert OwnShipMotion(time_s, time_s, time_s).velocity_m2s2_at([0.0]) is None


def read_rows(path, *rows, head=HEAD):
    path.write_text("\n".join([head, *rows]) + "\n")
    notes = []
    return read_own(path, notes), notes


@pytest.mark.parametrize(
    ("cells", "name"),
    [
        ("-1,0,1", "vnorth_var_m2s2"),
        ("1,0,inf", "veast_var_m2s2"),
        ("1,1.1,1", "vnorth_veast_cov_m2s2"),
        ("1e300,1.1e300,1e300", "vnorth_veast_cov_m2s2"),
    ],
)
def test_a_covariance_that_is_none_is_an_error_at_its_cell(tmp_path, cells, name):
    with pytest.raises(RecordingError, match=f"line 3.*{name}"):
        read_rows(tmp_path / "own.csv", "0,0,0,0,0,1,0,1", f"1,0,0,0,0,{cells}")


def test_a_large_covariance_is_one(tmp_path):
    own, _ = read_rows(tmp_path / "own.csv", "0,0,0,0,0,1e300,-0.5e300,1e300")
    assert own.columns["velocity_m2s2"][0, 0, 1] == -0.5e300


@pytest.mark.parametrize("status", ["jumped", "Jumped"])
def test_rows_in_which_the_position_of_own_ship_is_in_doubt_are_noted(tmp_path, status):
    row = f"0,0,0,0,0,1,0,1,{status}"
    _, notes = read_rows(tmp_path / "own.csv", row, head=f"{HEAD},status")
    assert len(notes) == 1
    assert "in doubt in 1 row" in notes[0]
