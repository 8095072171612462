"""Studies: rows in one shape, the same for a seed, beside what others report; errors in a line."""

import json
import math
import os
import sys
import time
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest

import wakeline as wl
from wakeline import montecarlo, scenario, study
from wakeline.cli import main
from wakeline.study import base, curves, detector, estimators

PNG = b"\x89PNG"
RUNS = 6
MANEUVERS = ("imm", "variable-structure")
CURVE_METRICS = (
    *("mean_position_m", "peak_position_m", "mean_velocity_mps", "peak_velocity_mps"),
    *("nees", "steady_nees", "steady_mean_nees_inside_share", "settling_s", "ns_per_step"),
)
ERRORS = ("position_rmse_m", "speed_rmse_mps", "course_rms_deg")
METRICS = dict.fromkeys(MANEUVERS, CURVE_METRICS) | {
    "solent": (*ERRORS, *(f"after_turn_{metric}" for metric in ERRORS))
}
SCENARIOS = {
    "imm": ["scans", "seconds", "scans_cauchy", "scans_gaussian"],
    "variable-structure": ["example1", "example2", "random"],
    "solent": ["coastal_60m", "coastal_15m"],
}
DISTURBED = ("scans_cauchy", "scans_gaussian")
ESTIMATORS = {
    "imm": ["imm2", "imm3", "detect_switch", "clairvoyant", "bound"],
    "variable-structure": [
        *("imm5", "imm9", "agmm", "sgmm", "likely_model_set", "mode_history"),
        *("mode_history_known", "mode_history_rates"),
        *("agmm_printed", "sgmm_printed", "agmm_printed_converted", "sgmm_printed_converted"),
        *("sgmm_symmetric", "sgmm_symmetric_converted"),
        *("imm5_converted", "agmm_converted", "sgmm_converted", "clairvoyant", "bound"),
    ],
    "solent": [
        *("kalman_cv", "wandering_course", "kalman_ca", "singer", "ekf_turn_rate"),
        *("ukf_turn_rate", "imm3", "imm5", "imm_turn_rate", "vessel_imm", "vessel_imm_ships"),
        *("agmm", "sgmm", "likely_model_set", "mode_history", "mode_history_rates"),
        "mode_history_vessels",
    ],
}


@pytest.fixture(scope="module")
def reports():
    return {name: study.load(name).run(RUNS, 3) for name in SCENARIOS}


def run(*arguments):
    return main(["study", *map(str, arguments)])


# What a study finds -------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SCENARIOS)
def test_rows_have_the_scenarios_the_estimators_and_the_metrics(reports, name):
    rows = reports[name].rows
    assert list(dict.fromkeys(row["scenario"] for row in rows)) == SCENARIOS[name]
    for scene in SCENARIOS[name]:
        found = [row["estimator"] for row in rows if row["scenario"] == scene]
        assert sorted(found) == sorted(ESTIMATORS[name])
    for row in rows:
        assert tuple(row)[2:] == METRICS[name]
        assert all(value is None or math.isfinite(value) for value in list(row.values())[2:])


@pytest.mark.parametrize("name", SCENARIOS)
def test_a_study_is_the_same_for_a_seed_and_another_for_another(name):
    def figures(seed, threads):
        rows = study.load(name).run(2, seed, threads=threads).rows
        return [{k: v for k, v in row.items() if k != "ns_per_step"} for row in rows]

    one = figures(3, threads=1)
    assert one == figures(3, threads=2)
    assert one != figures(4, threads=1)


@pytest.mark.parametrize("name", MANEUVERS)
def test_nobody_beats_the_bound_by_more_than_chance_and_a_true_start_allow(reports, name):
    report = reports[name]
    for scene in SCENARIOS[name]:
        if scene in DISTURBED:  # nobody knows the accelerations, which the bound does
            continue
        bound = report.row(scene, "bound")
        reported = report.row(scene, "clairvoyant")
        assert bound["mean_position_m"] < 1.4 * reported["mean_position_m"]
        for row in report.rows:
            if row["scenario"] == scene:
                assert row["mean_position_m"] >= 0.95 * reported["mean_position_m"]


def test_three_models_are_better_than_two_when_the_vessel_turns_both_ways(reports):
    two, three = (reports["imm"].row("scans", name) for name in ("imm2", "imm3"))
    assert three["peak_position_m"] < 0.5 * two["peak_position_m"]
    assert three["mean_position_m"] < two["mean_position_m"]


def test_an_imm_is_better_than_to_detect_a_turn_and_then_switch(reports):
    report = reports["imm"]
    for scene in ("scans", *DISTURBED):
        baseline, ours = (report.row(scene, name) for name in ("detect_switch", "imm3"))
        assert ours["mean_position_m"] < 0.9 * baseline["mean_position_m"]
        assert ours["peak_position_m"] < 0.8 * baseline["peak_position_m"]
    short = [report.row("seconds", name)["mean_position_m"] for name in ("detect_switch", "imm3")]
    assert short[0] == pytest.approx(short[1], rel=0.1)  # turns too short to tell


def test_heavy_tails_of_the_accelerations_change_little(reports):
    for name in ("imm2", "imm3"):
        heavy, normal = (reports["imm"].row(scene, name)["mean_position_m"] for scene in DISTURBED)
        assert heavy == pytest.approx(normal, rel=0.15)


def test_a_detector_that_never_switches_is_one_kalman_filter():
    scene = scenario.named("imm-scans")
    never = detector.DetectThenSwitch(0.05, 9.0, 0.9, 1.0 - 1e-12, 0.5)
    turning = wl.Ekf(wl.CoordinatedTurn(noise=wl.PiecewiseAcceleration(std_mps2=0.05)))
    z = scene.draw(3, 0)[:, :80]  # the straight
    ours, engine = (
        one.run(z, dt_s=3.0, sensor=scene.converted_sensor, start=scene.start)
        for one in (never, turning)
    )
    assert (ours.mode_probability[..., 0] == 1.0).all()
    np.testing.assert_allclose(ours.mean, engine.mean, rtol=1e-9)
    np.testing.assert_allclose(ours.covariance, engine.covariance, rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(ours.nis, engine.nis, rtol=1e-7)


def test_the_printed_rule_of_the_window_runs_to_starboard_while_undecided():
    candidates = study.variable_structure.candidates
    example, setting = scenario.named("example1"), study.variable_structure.SETTINGS["example1"]
    z = example.draw(20, 0)
    printed, meant = (
        candidates.centre_rates(build(setting, "polar"), example, z)[:, 5:30].mean()  # straight
        for build in (candidates.sgmm_printed, candidates.sgmm_symmetric)
    )
    assert printed > meant + np.deg2rad(0.2)
    assert abs(meant) < np.deg2rad(0.2)


def test_the_figures_of_a_reference_are_met():
    """Of an independent program; the tolerance is what 40 runs leave to chance."""
    result = montecarlo.run(
        scenario.named("example1"),
        study.variable_structure.estimators(study.variable_structure.SETTINGS["example1"]),
        40,
    )
    figures = result.summary()["example1"]
    for name in ("imm5", "imm5_converted", "clairvoyant"):
        published = study.variable_structure.REFERENCE.figures["example1", name]
        ours = [figures[name][metric] for metric in study.variable_structure.REFERENCE.metrics]
        np.testing.assert_allclose(ours, published, rtol=0.2)


def test_the_right_model_leads_where_there_is_one(reports):
    outcome = reports["imm"].result["imm-scans", "imm2"]
    leads = curves.leads_by_segment(outcome, np.deg2rad([0, 1]))
    assert [round(lead.rate_deg_s) for lead in leads] == [0, 1, -1, 0]
    assert leads[0].share > 0.9
    assert leads[0].delay_scans == 0
    assert 5 <= leads[1].delay_scans <= 20
    assert leads[2][1:] == (None, None)
    begin = int(np.flatnonzero(np.diff(outcome.true_turn_rate_rad_s))[0]) + 1
    share = 0.1 * (np.arange(len(outcome.time_s)) - begin)
    leads = curves.leads_by_segment(replace(outcome, right_mode_share=share), np.deg2rad([0, 1]))
    assert leads[1].delay_scans == 5  # half of the runs


def test_windows_and_centres_move_the_more_the_lower_their_threshold_asks():
    candidates = study.variable_structure.candidates
    example, setting = scenario.named("example1"), study.variable_structure.SETTINGS["example1"]
    z = example.draw(5, 1)

    def moves(candidate):
        return np.count_nonzero(np.diff(candidates.centre_rates(candidate, example, z)))

    windows = [
        moves(candidates.sgmm_symmetric(setting, "polar", threshold=t)) for t in (0.3, 0.7, 0.95)
    ]
    assert windows[0] > 3 * windows[1] > 0
    assert windows[2] == 0
    eager, calm = (
        moves(candidates.agmm_printed(setting, "polar", centre_threshold=t)) for t in (0.7, 0.3)
    )
    assert eager > 1.5 * calm > 0


def test_what_covariances_are_worth_is_what_the_rows_say(reports):
    report = reports["variable-structure"]
    reported = report.notes[1].splitlines()
    assert reported[2].split() == SCENARIOS["variable-structure"]
    for name in ("imm5", "sgmm", "mode_history"):
        (line,) = [line for line in reported if line.split()[0] == name]
        for scene, result in report.result.items():
            outcomes = [result[one, name] for one in result.scenarios]
            found = study.variable_structure.covariances.worth(outcomes)
            row = report.row(scene, name)
            assert found.nees == pytest.approx(row["steady_nees"])
            inside = row["steady_mean_nees_inside_share"]
            assert found.below + found.above + inside == pytest.approx(1.0)
            assert found.soon <= found.above
            assert str(found) in line


def test_an_error_within_ten_scans_after_a_switch_is_one_that_comes_soon(reports):
    outcome = reports["imm"].result["imm-scans", "imm2"]
    nees = np.full(len(outcome.time_s), 4.0)
    switch = int(np.searchsorted(outcome.time_s, outcome.switch_times_s[0], side="right"))
    nees[switch + 3 : switch + 15] = 100.0
    found = study.variable_structure.covariances.worth([replace(outcome, nees=nees)])
    steady = len(nees) - 3 * len(outcome.switch_times_s)
    assert (found.below, found.above, found.soon) == pytest.approx((0.0, 12 / steady, 7 / steady))


def test_the_window_forgets_its_first_probabilities_and_the_moving_grid_does_not():
    example = scenario.named("example1")
    setting = study.variable_structure.SETTINGS["example1"]
    z = example.draw(50, 0)
    candidates = study.variable_structure.candidates
    late_m = []
    for printed in (candidates.sgmm_symmetric, candidates.agmm_printed):
        centre, side = (
            printed(setting, "polar", initial_mode_probability=given)(example, z).mean
            for given in ([0.05, 0.9, 0.05], [0.9, 0.05, 0.05])
        )
        apart_m = np.hypot(*np.moveaxis((centre - side)[..., [0, 2]], -1, 0))
        assert apart_m[:, :20].mean() > 1.0
        late_m.append(np.median(apart_m[:, 150:200]))
    assert late_m[0] < 0.1
    assert late_m[1] > 0.5


def test_in_full_it_also_reports_what_the_outcome_hangs_on():
    report = study.variable_structure.run(1, 0, full=True)
    keys = [(row["scenario"], row["estimator"]) for row in report.rows]
    assert len(set(keys)) == len(keys)
    for noise in (1, 0.3, 0.1):
        for where in ("on", "between", "outside"):
            assert (f"example1_{where}_noise_x{noise:g}", "imm5") in keys
    for name in ("agmm_first_even", "agmm_first_right", "sgmm_first_left", "sgmm_t_0.3"):
        assert ("example1_settings", name) in keys
    assert ("example2_from_plots", "imm5_unbiased") in keys
    assert "robustness" in [picture.name for picture in report.pictures]
    *_, moves, survey = report.notes
    assert "SGMM t = 0.87" in moves
    assert "AGMM: less in both examples" in survey


def test_a_row_that_is_not_there(reports):
    with pytest.raises(KeyError, match="no row of imm7 on scans"):
        reports["imm"].row("scans", "imm7")


# Real vessels -------------------------------------------------------------------------------------


def test_a_finer_radar_gives_finer_tracks(reports):
    report = reports["solent"]
    for name in ESTIMATORS["solent"]:
        fine, coarse = (report.row(f"coastal_{m}m", name) for m in (15, 60))
        assert fine["position_rmse_m"] < 0.5 * coarse["position_rmse_m"]
        assert fine["course_rms_deg"] < coarse["course_rms_deg"]


@pytest.mark.parametrize("radar", SCENARIOS["solent"])
def test_the_models_of_a_tracker_stand_beside_those_made_for_these_vessels(reports, radar):
    report = reports["solent"]
    made = report.row(radar, "imm3")
    for name, factor in (("vessel_imm", 1.3), ("vessel_imm_ships", 1.05)):
        row = report.row(radar, name)
        assert all(row[metric] < factor * made[metric] for metric in ERRORS)


@pytest.mark.parametrize("radar", SCENARIOS["solent"])
def test_histories_reported_of_vessels_have_less_error_than_any_imm(reports, radar):
    report = reports["solent"]
    histories = report.row(radar, "mode_history_vessels")
    for metric in METRICS["solent"]:
        least = min(
            report.row(radar, name)[metric] for name in ESTIMATORS["solent"] if "imm" in name
        )
        assert histories[metric] < 1.02 * least, metric


def test_every_stretch_is_under_way_and_in_sight():
    for scene in study.solent.scenes("coastal_60m"):
        north_m, vnorth_mps, east_m, veast_mps = scene.truth_states.T
        assert np.hypot(north_m, east_m).max() < 10e3
        assert np.hypot(vnorth_mps, veast_mps).min() > 1.5
        assert scene.time_s[-1] > 175.0


@pytest.fixture
def bend():
    """A straight, a turn and a straight under the coarser radar."""
    straight, turn = scenario.Segment(120.0), scenario.Segment(60.0, np.deg2rad(3.0))
    truth = scenario.Truth([4000.0, 5.0, 0.0, 0.0], [straight, turn, straight])
    return scenario.Scenario("bend", truth, study.solent.RADARS["coastal_60m"], scans=99)


def test_after_a_turn_are_the_scans_of_it_and_of_half_a_minute_more(bend):
    after_s = bend.time_s[study.solent.after_turn(bend)]
    assert abs(after_s[0] - 120.0) <= 5.0
    assert abs(after_s[-1] - 210.0) <= 5.0
    assert len(after_s) == round((after_s[-1] - after_s[0]) / 3.0) + 1


def test_errors_count_from_half_a_minute_on_and_those_after_a_turn_once_more(bend):
    settled, turned = bend.time_s[1:] > 30.0, study.solent.after_turn(bend)[1:]
    off_m = np.where(turned, 50.0, np.where(settled, 5.0, 1e3))

    class Off:
        """Too far north, and a tenth too fast."""

        def run(self, z, **reported):
            states = bend.truth_states[1:] * [1.0, 1.1, 1.0, 1.1]
            states[:, 0] += off_m
            return SimpleNamespace(mean=np.broadcast_to(states, (len(z), *states.shape)))

    figures = study.solent._score(bend, Off(), 3, 0).figures()
    assert figures == pytest.approx(
        {
            "position_rmse_m": np.sqrt(np.mean(off_m[settled] ** 2)),
            "speed_rmse_mps": 0.5,
            "course_rms_deg": 0.0,
            "after_turn_position_rmse_m": 50.0,
            "after_turn_speed_rmse_mps": 0.5,
            "after_turn_course_rms_deg": 0.0,
        },
        abs=1e-9,
    )


# The table ----------------------------------------------------------------------------------------


def test_the_table_has_what_the_paper_and_a_reference_report_below_ours(reports):
    head, *cells = reports["variable-structure"].table()
    assert head[:4] == ["scenario", "estimator", "mean m", "peak m"]
    assert {len(row) for row in cells} == {len(head)}
    k = next(k for k, row in enumerate(cells) if row[:2] == ["example1", "imm5"])
    assert cells[k + 1][1:6] == ["  paper", "17.6", "69.5", "0.91", "4.74"]
    assert cells[k + 2][1:6] == ["  reference", "25.4", "34.5", "1.79", "3.05"]


def test_published_figures_are_silent_where_the_source_is():
    published = study.variable_structure.REFERENCE
    assert published.get("random", "imm5", "mean_position_m") == 29.8
    assert published.get("random", "imm5", "peak_position_m") is None
    assert published.get("random", "imm5", "nees") is None
    assert published.get("nowhere", "imm5", "mean_position_m") is None


# The estimators -----------------------------------------------------------------------------------


def test_a_chain_stays_and_shares_the_rest():
    chain = estimators.sticky_chain(5, 0.9)
    np.testing.assert_allclose(chain.sum(axis=1), 1.0)
    np.testing.assert_allclose(np.diag(chain), 0.9)
    np.testing.assert_allclose(chain[0, 1:], 0.025)
    np.testing.assert_allclose(estimators.peaked(1, 0, 1.0), [1.0])


def test_an_imm_of_turns_starts_straight():
    imm = estimators.turn_imm((-2, 0, 2), wl.PiecewiseAcceleration(std_mps2=0.1))
    imm.start(wl.Gaussian(np.zeros(4), np.eye(4)))
    np.testing.assert_allclose(imm.mode_probability(), [0.05, 0.9, 0.05])


# The command --------------------------------------------------------------------------------------


def test_list_names_each_study_in_a_line(capsys):
    assert run("list") == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == study.names()


def test_run_prints_the_table_and_writes_json(tmp_path, capsys, no_pictures):
    result = tmp_path / "sub" / "imm.json"
    assert run("run", "imm", "--runs", 2, "--json", result, "--out", tmp_path / "out") == 0
    written = json.loads(result.read_text())
    assert set(written) == {"name", "version", "seed", "runs", "rows"}
    assert (written["name"], written["seed"], written["runs"]) == ("imm", 0, 2)
    assert {row["estimator"] for row in written["rows"]} >= {"imm2", "imm3", "clairvoyant", "bound"}
    text = capsys.readouterr().out
    for word in ("imm: 2 runs, seed 0", "mean m/s", "reference", "95.3", "bound"):
        assert word in text


@pytest.mark.parametrize(
    ("name", "reported", "counts"),
    [
        ("imm", "imm: 1 run, seed 0", (0, 1)),
        ("solent", "solent: 10 runs, seed 0", (0, 10)),
        ("ais-forecast", "ais-forecast: 1 run, nothing random", (None, 1)),
    ],
)
def test_as_many_runs_are_reported_as_there_were(
    name, reported, counts, tmp_path, capsys, no_pictures
):
    runs = 1 if name == "imm" else 3
    result = tmp_path / "study.json"
    assert run("run", name, "--runs", runs, "--json", result, "--out", tmp_path / "out") == 0
    text = capsys.readouterr().out
    assert reported in text
    assert " 1 runs" not in text
    written = json.loads(result.read_text())
    assert (written["seed"], written["runs"]) == counts


def test_run_draws_the_figures_of_the_paper_which_a_terminal_sees(monkeypatch, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setattr("wakeline._progress._EVERY_S", -1.0)
    assert run("run", "imm", "--runs", 2, "--out", tmp_path) == 0
    drawn = sorted(tmp_path.iterdir())
    assert [path.suffix for path in drawn] == [".png"] * 7
    assert all(path.read_bytes().startswith(PNG) for path in drawn)
    text, seen = capsys.readouterr()
    assert all(path.name in text for path in drawn)
    assert "running █" in seen
    assert "drawing █" in seen
    assert "runs" not in seen


def test_every_panel_returns_the_axes_it_drew_into(reports):
    pytest.importorskip("matplotlib")
    from wakeline import plot

    for picture in reports["variable-structure"].pictures:
        for panel in picture.panels:
            ax = plot.figure().add_subplot()
            assert panel(ax) is ax
            assert ax.get_xlabel()


@pytest.mark.parametrize(
    ("arguments", "wanted"),
    [
        (["run", "none"], "invalid choice: 'none'"),
        (["run"], "NAME"),
        ([], "ACTION"),
        (["run", "imm", "--runs", "0"], "wanted an integer, at least 1, got '0'"),
        (["run", "imm", "--runs", "-3"], "wanted an integer, at least 1, got '-3'"),
        (["run", "imm", "--runs", "many"], "wanted an integer, at least 1, got 'many'"),
        (["run", "imm", "--seed", "-1"], "wanted an integer, at least 0, got '-1'"),
    ],
)
def test_a_study_that_is_invalid(capsys, arguments, wanted):
    assert run(*arguments) == 2
    message = capsys.readouterr().err
    assert message.startswith("wakeline: ")
    assert message.count("\n") == 1
    assert wanted in message


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"runs": 0}, "runs must be a whole number, at least 1, got 0"),
        ({"runs": -3}, "runs must be a whole number, at least 1, got -3"),
        ({"runs": 2.5}, r"runs must be a whole number, at least 1, got 2\.5"),
        ({"runs": 10**20}, "runs must be at most 10000000, got 100000000000000000000"),
        ({"runs": "3"}, "runs must be a whole number, at least 1, got '3'"),
        ({"seed": -1}, "seed must be a whole number, at least 0, got -1"),
        ({"seed": None}, "seed must be a whole number, at least 0, got None"),
        ({"threads": 0}, "threads must be a whole number, at least 1, got 0"),
        ({"threads": 1.5}, r"threads must be a whole number, at least 1, got 1\.5"),
    ],
)
def test_numbers_that_are_invalid_are_rejected_by_name(change, message):
    with pytest.raises(ValueError, match=message):
        study.imm.run(**({"runs": 1} | change))


def test_numbers_of_runs_on_video_that_are_invalid_are_rejected_by_name():
    for value in (-1, 1.5):
        with pytest.raises(ValueError, match=f"video_runs must be .* at least 0, got {value}"):
            study.fuzzy_alpha_beta.run(runs=1, video_runs=value)


# How the work is done -----------------------------------------------------------------------------


@pytest.mark.parametrize("threads", [1, 3, None])
def test_jobs_keep_their_order_and_have_the_threads_they_are_reported(threads):
    running, most = [], []

    def job(number):
        running.append(number)
        most.append(len(running))
        time.sleep(0.01)
        running.remove(number)
        return -number

    jobs = {number: lambda number=number: job(number) for number in range(20)}
    assert list(base.worked_off(jobs, threads, False).items()) == [(k, -k) for k in range(20)]
    assert max(most) <= (threads or os.cpu_count())


@pytest.mark.parametrize("where", ["job", "bar"])
def test_what_stops_the_work_calls_off_what_has_not_begun(monkeypatch, where):
    begun = []

    def job(number):
        begun.append(number)
        time.sleep(0.01)
        if where == "job":
            raise KeyboardInterrupt

    def stop(items, total, label):
        next(items)
        raise KeyboardInterrupt
        yield

    monkeypatch.setattr(base, "reported", stop)
    jobs = {number: lambda number=number: job(number) for number in range(300)}
    with pytest.raises(KeyboardInterrupt) as caught:
        base.worked_off(jobs, 1, where == "bar")
    assert caught.tb is not None, "it holds on to whatever raised"
    assert len(begun) < 150


def test_what_stops_the_work_has_what_was_done():
    def job(number):
        if number == 2:
            raise ZeroDivisionError
        return -number

    jobs = {number: partial(job, number) for number in range(300)}
    with pytest.raises(ZeroDivisionError) as caught:
        base.worked_off(jobs, 1, False)
    assert list(caught.value.result.items())[:2] == [(0, 0), (1, -1)]
    assert 2 not in caught.value.result
    with pytest.raises(ZeroDivisionError) as caught:
        base.in_turn(jobs)
    assert caught.value.result == {0: 0, 1: -1}


@pytest.fixture
def stopped(monkeypatch):
    """Studies are stopped when so much of their work is done."""

    def stop_after(count):
        def stop(items, total, label):
            for done, item in enumerate(items, start=1):
                yield item
                if done == count:
                    raise KeyboardInterrupt

        monkeypatch.setattr(base, "reported", stop)
        monkeypatch.setattr("wakeline._progress.progress", stop)

    return stop_after


@pytest.mark.parametrize("name", ["imm", "fuzzy-alpha-beta", "dead-reckoning", "solent"])
def test_a_study_that_is_stopped_has_the_rows_that_were_done(name, stopped):
    whole = study.load(name).run(1, 3)
    stopped(60 if name in ("fuzzy-alpha-beta", "solent") else 4)
    with pytest.raises(KeyboardInterrupt) as caught:
        study.load(name).run(1, 3, threads=1, progress=True)
    kept = caught.value.result
    assert (kept.name, kept.runs, kept.seed) == (name, whole.runs, 3)
    assert 0 < len(kept.rows) < len(whole.rows)
    assert not kept.pictures
    for row in kept.rows:
        same = whole.row(row["scenario"], row["estimator"])
        assert row | {"ns_per_step": None} == same | {"ns_per_step": None}
    assert len(kept.table()) > len(kept.rows)


def test_a_study_that_is_stopped_reports_what_was_done(stopped, tmp_path, capsys):
    stopped(3)
    file = tmp_path / "imm.json"
    assert run("run", "imm", "--runs", RUNS, "--json", file, "--out", tmp_path) == 130
    reported = capsys.readouterr()
    assert reported.out.endswith("\ninterrupted: the table has the completed rows\n")
    assert reported.err == "wakeline: interrupted\n"
    assert not file.exists()
    rows = json.loads((tmp_path / "imm-partial.json").read_text())["rows"]
    assert [row["estimator"] for row in rows] == ["imm2", "imm3", "detect_switch", "bound"]


def test_a_study_that_is_stopped_at_once_has_nothing_to_report(monkeypatch, tmp_path, capsys):
    def stop(*_):
        raise KeyboardInterrupt

    def planned(request):
        return base.Plan({"one": stop}, rows=list, in_turn=True)

    for plan in (stop, planned):
        monkeypatch.setitem(study._STUDIES, "imm", base.Study("imm", "", plan))
        assert run("run", "imm", "--out", tmp_path) == 130
        assert capsys.readouterr().out == ""


def test_an_output_folder_that_is_a_file(tmp_path, capsys):
    (tmp_path / "taken").write_text("mine")
    assert run("run", "imm", "--runs", 1, "--out", tmp_path / "taken") == 2
    assert "taken: File exists" in capsys.readouterr().err


def test_there_is_no_study_of_that_name():
    with pytest.raises(ValueError, match=r"name must be one of imm"):
        study.load("none")
