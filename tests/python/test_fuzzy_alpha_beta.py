"""The fuzzy choice among lines: its laws are tested in C++; here what Python adds."""

import time
from threading import Event, Thread

import numpy as np
import pytest

import wakeline as wl
from cases import DT_S, POSITION, RADAR, START, readings, stepwise
from wakeline import scenario

TURN = scenario.HardTurn(10.0, 300.0)
TRACED = ("quality", "chosen", "sigma_hat_m", "residual_ratios", "rule_strengths")


def test_run_is_the_steps_one_by_one():
    z = readings(30, seed=3, miss=[5, 12, 13])
    result = wl.FuzzyAlphaBeta().run(z, dt_s=DT_S, sensor=RADAR, start=START)
    wanted = stepwise(wl.FuzzyAlphaBeta(), z)
    for name, values in zip(
        ("mean", "covariance", "innovation", "nis", "log_likelihood"), wanted, strict=True
    ):
        np.testing.assert_array_equal(getattr(result, name), values)
    assert result.mode_probability.shape == (30, 9)
    np.testing.assert_array_equal(result.mode_probability.sum(axis=-1), 1.0)
    assert np.linalg.eigvalsh(result.covariance).min() > 0.0


def test_trace_is_what_the_estimator_shows_step_by_step():
    z = readings(25, seed=4, miss=[7])
    fuzzy = wl.FuzzyAlphaBeta(max_plots=6, t_norm="minimum")
    trace = fuzzy.trace(z, dt_s=DT_S, sensor=RADAR, start=START)
    assert trace.residual_ratios.shape == (25, 5)
    assert trace.rule_strengths.shape == (25, 6)
    fuzzy.start(START)
    for k, reading in enumerate(z):
        fuzzy.predict(DT_S)
        np.testing.assert_array_equal(trace.prediction_m[k], fuzzy.estimate().mean[[0, 2]])
        if k == 7:
            assert np.isnan(trace.quality[k])
            assert np.isnan(trace.innovation_m[k]).all()
            assert trace.chosen[k] == fuzzy.chosen
            continue
        step = fuzzy.update(RADAR, reading)
        np.testing.assert_array_equal(trace.innovation_m[k], step.innovation)
        for name in TRACED:
            reported, shown = getattr(trace, name)[k], np.asarray(getattr(fuzzy, name))
            if shown.ndim:
                assert np.isnan(reported[len(shown) :]).all()
                reported = reported[: len(shown)]
            np.testing.assert_array_equal(reported, shown)
    assert len(fuzzy.residual_ratios) == 5
    assert len(fuzzy.rule_strengths) == 6
    assert fuzzy.plots_of_mode.tolist() == [2, 3, 4, 5, 6]
    assert np.flatnonzero(fuzzy.mode_probability()).tolist() == [fuzzy.chosen - 2]


def test_a_long_trace_lets_other_threads_work():
    z = np.tile(readings(), (1500, 1, 1))
    worker = Thread(target=wl.FuzzyAlphaBeta().trace, args=(z, DT_S, RADAR, START))
    turns = 0
    worker.start()
    while worker.is_alive():
        time.sleep(1e-3)
        turns += 1
    assert turns > 10


def test_a_trace_is_its_own_while_another_thread_moves_its_sensor():
    radar = wl.RangeBearing(range_std_m=30.0, bearing_std_rad=np.deg2rad(0.5))
    z = np.tile(readings(), (1500, 1, 1))
    done = Event()

    def move():
        while not done.is_set():
            radar.own = wl.OwnShip(north_m=100.0 - radar.own.north_m)

    mover = Thread(target=move)
    mover.start()
    try:
        for _ in range(5):
            trace = wl.FuzzyAlphaBeta().trace(z, DT_S, radar, START)
            first = trace.prediction_m[:1]
            np.testing.assert_array_equal(trace.prediction_m, first.repeat(len(z), axis=0))
    finally:
        done.set()
        mover.join()


def test_traces_side_by_side_know_nothing_of_each_other():
    z = np.stack([readings(20, seed) for seed in range(3)])
    together = wl.FuzzyAlphaBeta().trace(z, dt_s=DT_S, sensor=RADAR, start=[START] * 3)
    for run, alone in enumerate(z):
        expected = wl.FuzzyAlphaBeta().trace(alone, dt_s=DT_S, sensor=RADAR, start=START)
        for name in (*TRACED, "prediction_m", "innovation_m"):
            np.testing.assert_array_equal(getattr(together, name)[run], getattr(expected, name))


def test_the_machine_gives_the_values_of_its_source():
    rising = [0.5, 0.5, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.0]
    product, minimum = wl.FuzzyAlphaBeta(), wl.FuzzyAlphaBeta(t_norm="minimum")
    assert product.evaluate(rising)[0] == pytest.approx(5.499994, abs=1e-6)
    assert minimum.evaluate(rising)[0] == pytest.approx(5.464032, abs=1e-6)
    quality, strengths = product.evaluate(np.full(9, 1.5))
    assert quality == pytest.approx(5.6)
    np.testing.assert_allclose(strengths, np.full(10, 0.5**9))
    for clipped in (3.0, 1e3, np.inf):
        assert minimum.evaluate(np.full(9, clipped))[0] == pytest.approx(2.019812, abs=1e-6)


def test_the_hold_lengthens_and_never_shortens():
    z = readings(40, seed=5)
    held, free = (
        wl.FuzzyAlphaBeta(hold=hold).trace(z, dt_s=DT_S, sensor=RADAR, start=START)
        for hold in (True, False)
    )
    np.testing.assert_array_equal(held.quality, free.quality)
    judged = np.isfinite(free.quality)
    np.testing.assert_array_equal(free.chosen[judged], np.round(free.quality[judged]))
    assert (held.chosen >= free.chosen).all()
    longest = np.fmax(held.quality[1:], held.quality[:-1])[judged[1:]]
    np.testing.assert_array_equal(held.chosen[1:][judged[1:]], np.round(longest))


def test_the_line_is_long_on_a_straight_and_short_in_a_turn():
    runs = TURN.draw(20, seed=1)
    trace = wl.FuzzyAlphaBeta().trace(
        runs.z, dt_s=TURN.period_s, sensor=TURN.sensor, start=wl.Gaussian(np.zeros(4), np.eye(4))
    )
    turning = (runs.time_s > TURN.before_s + 15.0) & (
        runs.time_s < TURN.before_s + np.pi / TURN.turn_rate_rad_s
    )
    straight = (runs.time_s > 45.0) & (runs.time_s < TURN.before_s)
    assert np.median(trace.quality[:, straight]) > 9.0
    assert 3.0 < np.mean(trace.quality[:, turning]) < 7.0
    assert np.isfinite(trace.sigma_hat_m[:, 5:]).all()


def test_a_tracker_holds_a_vessel_with_it_and_its_state_can_be_saved():
    radar = wl.Radar(period_s=3.0, range_std_m=8.0, bearing_std_rad=np.deg2rad(0.15))
    tracker = wl.Tracker(radar, estimator=wl.FuzzyAlphaBeta())
    truth = scenario.Truth(
        [4000.0, 8.0, 3000.0, -6.0], [scenario.Segment(90.0), scenario.Segment(200.0, 0.02)]
    )
    sensor = scenario.RadarSimulator(8.0, np.deg2rad(0.15), 3.0)
    time_s, z = sensor.observe(truth, 70, 2, start_time_s=3.0)
    ids = set()
    for k, (now_s, (range_m, bearing_rad)) in enumerate(zip(time_s, z, strict=True)):
        seen = k % 11 != 10
        tracker.process(now_s, range_m=[range_m][:seen], bearing_rad=[bearing_rad][:seen])
        table = tracker.tracks()
        ids.update(table.track_id)
        if k == 40:
            saved = tracker.save()
    assert len(ids) == 1
    assert table.mode_probability.shape == (1, 9)
    mean = table.mean[0]
    assert np.hypot(*(mean[[0, 2]] - truth.state_at(table.time_s[0])[0, [0, 2]])) < 60.0
    again = wl.Tracker(radar, estimator=wl.FuzzyAlphaBeta())
    again.restore(saved)
    for now_s, (range_m, bearing_rad) in zip(time_s[41:44], z[41:44], strict=True):
        again.process(now_s, range_m=[range_m], bearing_rad=[bearing_rad])
    assert len(again.tracks()) == 1
    with pytest.raises(ValueError, match="same settings"):
        wl.Tracker(radar, estimator=wl.FuzzyAlphaBeta(hold=False)).restore(saved)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"max_plots": 1}, "max_plots must be 2 to 16, got 1"),
        ({"max_plots": 17}, "max_plots"),
        ({"steepness": -1.0}, "steepness"),
        ({"threshold": 4.0}, "threshold"),
        ({"clip": np.inf}, "clip"),
        ({"t_norm": "mean"}, "t_norm must be 'product' or 'minimum', got 'mean'"),
        ({"acceleration_std_mps2": np.nan}, "acceleration_std_mps2"),
    ],
)
def test_what_is_invalid_is_rejected_in_words(options, words):
    with pytest.raises(ValueError, match=words):
        wl.FuzzyAlphaBeta(**options)


def test_arrays_that_do_not_fit_are_rejected():
    fuzzy = wl.FuzzyAlphaBeta()
    with pytest.raises(ValueError, match=r"z must have shape \(T, 2\) or \(R, T, 2\)"):
        fuzzy.trace(np.zeros((5, 3)), dt_s=DT_S, sensor=RADAR, start=START)
    with pytest.raises(ValueError, match="dt_s"):
        fuzzy.trace(np.zeros((5, 2)), dt_s=np.ones(4), sensor=RADAR, start=START)
    with pytest.raises(ValueError, match="one per run"):
        fuzzy.trace(np.zeros((3, 5, 2)), dt_s=DT_S, sensor=RADAR, start=[START] * 2)
    with pytest.raises(TypeError, match="sensor"):
        fuzzy.trace(np.zeros((5, 2)), dt_s=DT_S, sensor=None, start=START)
    for ratios in (np.zeros(10), [-1.0, 1.0], [np.nan]):
        with pytest.raises(ValueError, match="ratios"):
            fuzzy.evaluate(ratios)


def test_a_step_that_fails_says_so_and_changes_nothing():
    fuzzy = wl.FuzzyAlphaBeta()
    with pytest.raises(wl.FilterError, match="not started"):
        fuzzy.update(POSITION, [1.0, 2.0])
    fuzzy.start(START)
    fuzzy.predict(DT_S)
    before = fuzzy.estimate().mean
    with pytest.raises(wl.FilterError, match="finite"):
        fuzzy.update(POSITION, [np.nan, 2.0])
    np.testing.assert_array_equal(fuzzy.estimate().mean, before)
    assert np.isnan(fuzzy.quality)
    assert np.isnan(fuzzy.sigma_hat_m)
