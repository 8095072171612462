"""The study on dead reckoning: its voyage, its predictions, and the claim about (33)."""

import json
import math

import numpy as np
import pytest

from wakeline import filter as wf
from wakeline import navigation as nav
from wakeline import scenario, study
from wakeline.study import dead_reckoning as reckoning

KNOT = 1852.0 / 3600.0
RUNS = 12
STEPS = ("4x1s", "4x3s", "4x10s")
FORECASTS = ("forecast_4x1s", "forecast_4x3s", "forecast_4x10s")
QUANTITIES = ("speed_rms_kn", "course_rms_deg")
PLACE = ("latitude_rms_arcmin", "longitude_rms_arcmin")


@pytest.fixture(scope="module")
def report():
    return reckoning.run(RUNS, seed=5)


# The voyage ---------------------------------------------------------------------------------------


def test_the_voyage_is_made_over_ground_by_the_ship_and_the_current():
    truth = scenario.reckoning_voyage(1.0)
    rates = np.gradient([truth.latitude_rad, truth.longitude_rad], truth.time_s, axis=1)
    over_ground = nav.velocity_from_rates_mps(*rates, truth.latitude_rad)
    current = nav.drift_from_rates_mps(over_ground, truth.speed_mps, truth.course_rad)
    wanted = nav.velocity_mps(1.2 * KNOT, np.radians(60.0))
    # Differences of places are blunt where an order bends the speed.
    np.testing.assert_allclose(current[1:-1], np.tile(wanted, (2399, 1)), atol=0.02)
    np.testing.assert_allclose(current[1:-1].mean(axis=0), wanted, atol=0.001)


def test_the_voyage_is_the_same_at_every_step():
    fine, coarse = scenario.reckoning_voyage(1.0), scenario.reckoning_voyage(10.0)
    for name in ("time_s", "speed_mps", "course_rad", "latitude_rad", "longitude_rad"):
        np.testing.assert_array_equal(getattr(fine, name)[::10], getattr(coarse, name))
    assert fine.course_rad.max() > 2 * np.pi  # the ship turns through north
    turns_deg_s = np.degrees(np.diff(fine.course_rad))
    assert np.abs(turns_deg_s).max() == pytest.approx(0.4, abs=0.001)


def test_instruments_err_as_they_are_said_to():
    truth = scenario.reckoning_voyage(3.0)
    read = truth.read(runs=20, seed=1)
    assert (read.speed_mps - truth.speed_mps).std() / KNOT == pytest.approx(0.1, rel=0.03)
    assert read.course_rad.min() >= 0.0
    assert read.course_rad.max() < 2 * np.pi
    off = (read.course_rad - truth.course_rad + np.pi) % (2 * np.pi) - np.pi
    assert np.degrees(off.std()) == pytest.approx(0.3, rel=0.03)
    place = truth.latitude_rad, truth.longitude_rad
    distance_m = nav.geodesic(*place, read.latitude_rad, read.longitude_rad)[0]
    assert np.sqrt(np.mean(distance_m**2) / 2) == pytest.approx(4.0, rel=0.03)
    np.testing.assert_array_equal(truth.read(runs=3, seed=1).speed_mps, read.speed_mps[:3])


@pytest.mark.parametrize("dt_s", [0.0, -1.0, 0.25, 700.0, float("nan")])
def test_steps_that_do_not_fit_are_rejected(dt_s):
    with pytest.raises(ValueError, match=r"dt_s must be a multiple of 0\.1 s"):
        scenario.reckoning_voyage(dt_s)


def test_voyages_without_runs_are_rejected():
    with pytest.raises(ValueError, match="runs must be a whole number, at least 1, got 0"):
        scenario.reckoning_voyage(10.0).read(runs=0)
    with pytest.raises(ValueError, match="seed must be a whole number, at least 0, got -1"):
        scenario.reckoning_voyage(10.0).read(runs=1, seed=-1)


# What the study finds -----------------------------------------------------------------------------


def test_rows_are_those_of_the_design(report):
    forecasts = [*reckoning.smoothers(), "combined"]
    assert forecasts == [
        *("last_value", "alpha_beta_w5", "adaptive_two_pass", "adaptive_one_pass"),
        *("window_bank", "kalman", "combined"),
    ]
    formulas = [
        *(f"gains_{n}" for n in ("28_w5", "29_w5", "30")),
        *(f"gains_{n}_growing" for n in (27, 28, 29)),
        *("exponential", "adaptive_exponential", "three_point", "adaptive_three_point"),
    ]
    composed = [f"combined_{how}" for how in ("printed", "mid_interval", "mean_drift", "both")]
    wanted = [(c, name) for c in FORECASTS for name in (*forecasts, *formulas, *composed)]
    slow = [name for name in forecasts if name != "combined"] + formulas
    wanted += [(f"near_zero_{step}", name) for step in STEPS for name in slow]
    wanted += [
        (f"{phase}_4x3s", f"line_w{n}")
        for phase in ("steady", "maneuver")
        for n in (2, 3, 6, 10, 15)
    ]
    wanted += [
        (case, name) for case in ("drift_20", "drift_5") for name in ("vector_line", "rates")
    ]
    wanted += [
        (f"drift_maneuvers_{step}", name)
        for step in ("3s", "30s")
        for name in ("vector_line", "vector_line_ended", "rates")
    ]
    assert [(row["scenario"], row["estimator"]) for row in report.rows] == wanted
    for row in report.rows:
        assert tuple(row)[2:] == (*QUANTITIES, *PLACE, "drift_rms_kn")
        figures = [value for value in list(row.values())[2:] if value is not None]
        assert figures
        assert all(math.isfinite(value) and value > 0.0 for value in figures)
    assert report.row("drift_5", "rates")["speed_rms_kn"] is None
    assert report.row("forecast_4x3s", "combined")["course_rms_deg"] is None


def test_the_table_has_figures_that_report_estimators_apart(report):
    head, *rows = report.table()
    drift = [row[head.index("drift rms kn")] for row in rows]
    assert all(len(cell.lstrip("0.")) >= 2 for cell in drift if cell not in ("", "-"))


@pytest.mark.parametrize("name", ["window_bank", "kalman"])
def test_forecasts_four_readings_ahead_are_as_good_as_asked_for(report, name):
    every_second, every_three = (report.row(case, name) for case in FORECASTS[:2])
    # Sampling: 12 voyages are sure to 1 or 2 %.
    assert every_second["speed_rms_kn"] < 0.10
    assert every_second["course_rms_deg"] < 0.30
    assert every_three["speed_rms_kn"] < 0.22
    assert every_three["course_rms_deg"] < 0.85


def test_combined_dead_reckoning_predicts_places_best(report):
    for metric in PLACE:
        assert report.row("forecast_4x3s", "combined")[metric] < 0.6 * 0.003
        for case in FORECASTS:
            ours = report.row(case, "combined")[metric]
            assert ours < 0.5 * min(report.row(case, n)[metric] for n in reckoning.smoothers())


def test_drift_is_found_on_a_steady_course():
    errors = {fixes: reckoning.drift_errors(400, 1, fixes) for fixes in (20, 5)}
    rms = {
        (fixes, name): np.sqrt(np.mean(off[:, -1] ** 2))
        for fixes, found in errors.items()
        for name, off in found.items()
    }
    # Sampling: 0.0297 and 0.103 kn in the long run, known to 5 % at two standard deviations.
    assert rms[20, "vector_line"] < 0.03 * 1.05
    assert rms[5, "vector_line"] < 0.11
    assert all(rms[fixes, "vector_line"] < rms[fixes, "rates"] for fixes in (20, 5))


def test_the_figures_of_the_methods_come_out(report):
    """Those whose estimator is without tuning, to their last digit and what sampling does."""
    for name in ("last_value", "alpha_beta_w5", "adaptive_two_pass"):
        for case in FORECASTS:
            for metric in QUANTITIES:
                theirs = report.published["reference"].get(case, name, metric)
                assert report.row(case, name)[metric] == pytest.approx(theirs, rel=0.08)


# The claim that (33) is the best ------------------------------------------------------------------


def test_the_gains_33_are_better_than_the_line_only_where_maneuvers_make_the_error(report):
    def ratio(case, metric):
        ours = report.row(case, "adaptive_two_pass")[metric]
        return ours / report.row(case, "alpha_beta_w5")[metric]

    for metric in QUANTITIES:
        assert ratio("forecast_4x1s", metric) > 1.15
        assert ratio("forecast_4x3s", metric) > 1.1
        assert ratio("forecast_4x10s", metric) < 0.97
    assert "only where maneuvers" in report.notes[0]


def test_what_the_paper_reports_is_reached(report):
    assert (
        report.published["paper"].get("forecast_4x3s", "adaptive_two_pass", "speed_rms_kn") == 0.3
    )
    row = report.row("forecast_4x3s", "adaptive_two_pass")
    assert row["speed_rms_kn"] < 0.3
    for case in FORECASTS:
        assert max(report.row(case, "combined")[metric] for metric in PLACE) < 0.03


def test_in_one_pass_the_gains_never_adapt_and_the_rows_are_those_of_fixed_gains():
    dt_s = 3.0
    truth = scenario.reckoning_voyage(dt_s)
    read = truth.read(runs=3, seed=4)
    metric = "speed_rms_kn"
    row = reckoning.judge(dt_s, read, "adaptive_one_pass")["forecast"][metric]
    found, *gains = reckoning.one_pass(metric, dt_s, read.speed_mps)
    for gain in gains:
        assert np.ptp(gain[:, 100:], axis=-1).max() < 1e-6  # through every maneuver
    for run, readings in enumerate(read.speed_mps):
        forecast = found.forecast[run]
        off = reckoning.forecast_errors(metric, forecast, truth.speed_mps)
        assert row[run] == pytest.approx(np.sqrt(np.mean(off**2)), rel=1e-12)
        fixed = wf.AlphaBetaSmoother(wf.ConstantGains(*(float(gain[run, -1]) for gain in gains)))
        same = fixed.run(dt_s, readings, ahead_s=4 * dt_s)[2]
        np.testing.assert_allclose(forecast[100:], same[100:], atol=1e-3 * KNOT)


@pytest.mark.parametrize("window", [3, 5])
@pytest.mark.parametrize("seed", range(5))
def test_the_gains_33_are_between_those_that_they_are_averaged_from(window, seed):
    """So the paper's beta of up to 1.3 cannot come from (33) over a pass with (27)."""
    n = np.arange(2, window + 1)
    alpha, beta = 2 * (2 * n - 1) / (n * (n + 1)), 6 / (n * (n + 1))
    rng = np.random.default_rng(seed)
    smoother = wf.AdaptiveAlphaBeta(window=window)
    for k, reading in enumerate(np.cumsum(rng.standard_normal(60)) * rng.uniform(0, 5)):
        smoother.update(2.0, reading)
        if k >= window:
            assert alpha.min() - 1e-9 <= smoother.alpha <= alpha.max() + 1e-9
            assert beta.min() - 1e-9 <= smoother.beta <= beta.max() + 1e-9


# The other claims ---------------------------------------------------------------------------------


@pytest.mark.parametrize("dt_s", [1.0, 3.0, 10.0])
def test_combined_dead_reckoning_with_the_drift_of_the_instant_is_first_order(dt_s):
    """(11) adds to the motion through the water what (18)-(20) subtracted it from."""
    read = scenario.reckoning_voyage(dt_s).read(runs=100, seed=0)
    found = reckoning.paper_combined(dt_s, read)
    assert reckoning.difference_arcmin(found) < 4e-8
    for name in ("combined_mid_interval", "combined_mean_drift", "combined_both"):
        off = found[name][0] - found["first_order"][0]
        assert 60 * np.degrees(np.abs(off).max()) > 1e-4


def test_the_combined_model_gains_only_by_averages_and_forecasts(report):
    for case in FORECASTS:
        first_order, printed, mean, both = (
            report.row(case, name)["latitude_rms_arcmin"]
            for name in (
                "adaptive_two_pass",
                "combined_printed",
                "combined_mean_drift",
                "combined_both",
            )
        )
        assert printed == pytest.approx(first_order, rel=1e-6)
        assert mean < 0.9 * first_order
        assert both < 0.75 * first_order


def test_no_fixed_schedule_is_best_everywhere_and_27_is_nowhere(report):
    names = {"27": "alpha_beta_w5", "28": "gains_28_w5", "29": "gains_29_w5", "30": "gains_30"}
    best = {
        (case, metric): min(names, key=lambda n: report.row(case, names[n])[metric])
        for case in FORECASTS
        for metric in (*QUANTITIES, *PLACE)
    }
    assert {best[case, m] for case in FORECASTS[:2] for m in (*QUANTITIES, *PLACE)} == {"30"}
    assert {best[FORECASTS[2], m] for m in (*QUANTITIES, *PLACE)} == {"29"}
    for n in (27, 28, 29):  # of the whole voyage
        assert report.row("forecast_4x3s", f"gains_{n}_growing")["speed_rms_kn"] > 1.0


def test_smoothers_without_a_rate_are_no_match_where_the_quantity_moves(report):
    for name in ("exponential", "adaptive_exponential"):
        for case in FORECASTS:
            line, ours = report.row(case, "alpha_beta_w5"), report.row(case, name)
            assert all(ours[m] > 1.4 * line[m] for m in ("course_rms_deg", *PLACE))
        near, line = (report.row("near_zero_4x1s", n) for n in (name, "alpha_beta_w5"))
        assert all(near[m] < 0.8 * line[m] for m in (*QUANTITIES, *PLACE))


def test_series_are_worst_near_zero_speed_and_as_bad_elsewhere(report):
    rates = ("alpha_beta_w5", "adaptive_two_pass", "adaptive_one_pass", "window_bank", "kalman")
    for name in ("three_point", "adaptive_three_point"):
        for step in STEPS[:2]:
            near = report.row(f"near_zero_{step}", name)["speed_rms_kn"]
            others = [report.row(f"near_zero_{step}", n)["speed_rms_kn"] for n in rates]
            assert near > 1.3 * max(others)
        slow, whole = (
            report.row(f"{part}_4x1s", name)["speed_rms_kn"] for part in ("near_zero", "forecast")
        )
        assert slow == pytest.approx(whole, rel=0.1)


def test_long_windows_are_for_a_steady_ship_and_short_ones_for_maneuvers(report):
    speed = {
        (phase, n): report.row(f"{phase}_4x3s", f"line_w{n}")["speed_rms_kn"]
        for phase in ("steady", "maneuver")
        for n in (3, 6, 10, 15)
    }
    assert speed["steady", 15] < speed["steady", 10] < speed["steady", 6] < speed["steady", 3]
    assert speed["maneuver", 6] < min(speed["maneuver", n] for n in (3, 15))


def test_a_line_that_ends_at_alterations_needs_no_frequent_log(report):
    through, ended, rates = (
        report.row("drift_maneuvers_30s", name)["drift_rms_kn"]
        for name in ("vector_line", "vector_line_ended", "rates")
    )
    assert ended < 0.4 * min(through, rates)
    often = report.row("drift_maneuvers_3s", "vector_line")["drift_rms_kn"]
    assert often < 0.05


# How it is made -----------------------------------------------------------------------------------


@pytest.mark.parametrize("window", [2, 5, 15])
def test_the_fixed_weights_of_a_line_are_least_squares(window):
    readings = np.random.default_rng(3).standard_normal((2, 30))
    ahead = reckoning.line_forecast("speed_rms_kn", readings, window)
    assert np.isnan(ahead[:, : window - 1]).all()
    for k in range(window - 1, 30):
        line = np.polyfit(np.arange(window) - window + 1, readings[1, k - window + 1 : k + 1], 1)
        assert ahead[1, k] == pytest.approx(np.polyval(line, 4.0), abs=1e-9)


def test_a_kalman_filter_without_process_noise_is_the_line_of_least_squares():
    rng = np.random.default_rng(6)
    readings = rng.standard_normal((3, 25))
    value, rate = reckoning.two_state_kalman(2.0, readings, 1.0, np.zeros((2, 2)), rate_std=1e6)
    time_s = 2.0 * np.arange(25)
    for row, last, slope in zip(readings, value[:, -1], rate[:, -1], strict=True):
        line = np.polyfit(time_s, row, 1)
        assert slope == pytest.approx(line[0], abs=1e-6)
        assert last == pytest.approx(np.polyval(line, time_s[-1]), abs=1e-6)


def test_the_window_is_the_line_through_its_readings():
    rng = np.random.default_rng(7)
    readings = rng.standard_normal((2, 12))
    found = reckoning.smoothers()["alpha_beta_w5"]("speed_rms_kn", 2.0, readings)
    for k in range(1, 12):
        begin = max(0, k - 4)
        time_s = 2.0 * np.arange(begin - k, 1)
        line = np.polyfit(time_s, readings[1, begin : k + 1], 1)
        assert found.forecast[1, k] == pytest.approx(np.polyval(line, 8.0), abs=1e-9)


def test_the_same_seed_gives_the_same_figures():
    one, other = (reckoning.run(2, seed=2, threads=threads) for threads in (1, 3))
    assert json.dumps(one.rows) == json.dumps(other.rows)
    assert json.dumps(one.rows) != json.dumps(reckoning.run(2, seed=3).rows)


def test_the_study_has_its_name_and_its_table(report):
    assert study.load("dead-reckoning") is reckoning.STUDY
    assert "dead-reckoning" in study.names()
    cells = report.table()
    assert any(row[1].strip() == "paper" for row in cells)
    assert {len(row) for row in cells} == {len(cells[0])}


def test_every_picture_can_be_drawn(report, tmp_path):
    files = report.save_pictures(tmp_path)
    names = (
        "wind-current",
        "speed",
        "course",
        "latitude",
        "longitude",
        *(f"every-{quantity}" for quantity in ("speed", "course", "latitude", "longitude")),
        "rates",
        "forecast",
        "combined",
        "windows",
        "drift",
        "drift-maneuvers",
    )
    assert [file.stem for file in files] == [f"reckoning-{name}" for name in names]
    assert all(file.stat().st_size > 5000 for file in files)
