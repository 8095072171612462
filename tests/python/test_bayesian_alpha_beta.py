"""Lines and parabolas through the last plots, weighed by Bayes' rule."""

import numpy as np
import pytest

import wakeline as wl
from cases import CONVERTED, DT_S, POSITION, RADAR, START, readings, stepwise
from wakeline.scenario import hard_turns


def test_a_run_is_its_single_steps_bit_for_bit():
    z = readings(miss=(4, 5, 17))
    result = wl.BayesianAlphaBeta().run(z, dt_s=DT_S, sensor=RADAR, start=START)
    wanted = stepwise(wl.BayesianAlphaBeta(), z)
    for field, values in zip(
        ("mean", "covariance", "innovation", "nis", "log_likelihood"), wanted, strict=True
    ):
        np.testing.assert_array_equal(getattr(result, field), values, err_msg=field)
    np.testing.assert_allclose(result.mode_probability.sum(axis=-1), 1.0)


@pytest.mark.parametrize("sensor", [RADAR, CONVERTED], ids=["polar", "converted"])
def test_innovations_are_positions_minus_predicted_ones(sensor):
    bank = wl.BayesianAlphaBeta()
    bank.start(START)
    for z in readings(12):
        bank.predict(DT_S)
        ahead = bank.estimate().mean[[0, 2]]
        place = sensor.position(z).mean
        np.testing.assert_allclose(bank.update(sensor, z).innovation, place - ahead, atol=1e-9)


def test_every_mode_reports_its_plots():
    assert wl.BayesianAlphaBeta().plots_of_mode.tolist() == [*range(2, 11), *range(4, 11)]
    only = wl.BayesianAlphaBeta(min_plots=3, max_plots=5, parabolas=False)
    assert only.plots_of_mode.tolist() == [3, 4, 5]
    assert only.models == 3


def test_it_follows_a_hard_turn_that_the_longest_line_loses():
    situation = hard_turns()["20mps_r300"]
    drawn = situation.draw(20, seed=3)
    starts = [wl.two_point(situation.sensor, *z[:2], situation.period_s) for z in drawn.z]

    def worst_m(estimator):
        done = estimator.run(
            drawn.z[:, 2:], dt_s=situation.period_s, sensor=situation.sensor, start=starts
        )
        return np.median(np.linalg.norm(done.innovation, axis=-1)[:, 8:].max(axis=1))

    line = worst_m(wl.BayesianAlphaBeta(min_plots=10, max_plots=10, parabolas=False))
    assert worst_m(wl.BayesianAlphaBeta()) < 0.3 * line


def test_nis_is_of_the_order_that_it_says():
    situation = hard_turns()["10mps_r300"]
    drawn = situation.draw(100, seed=4)
    starts = [wl.two_point(situation.sensor, *z[:2], situation.period_s) for z in drawn.z]
    done = wl.BayesianAlphaBeta().run(
        drawn.z[:, 2:], dt_s=situation.period_s, sensor=situation.sensor, start=starts
    )
    gate = wl.ChiSquareGate(probability=0.99).threshold(2)
    assert np.mean(done.nis < gate) > 0.98
    assert 0.8 < done.nis.mean() < 2.5


def test_a_tracker_holds_a_vessel_with_it():
    radar = wl.Radar(range_std_m=8.0, bearing_std_rad=0.002, period_s=3.0)
    tracker = wl.Tracker(radar, estimator=wl.BayesianAlphaBeta())
    rng = np.random.default_rng(1)
    for scan in range(40):
        place = np.array([2000.0 + 6.0 * 3.0 * scan, 500.0 + 20.0 * np.sin(scan / 6.0)])
        tracker.process(
            3.0 * scan,
            range_m=[np.hypot(*place) + 8.0 * rng.standard_normal()],
            bearing_rad=[np.arctan2(place[1], place[0]) + 0.002 * rng.standard_normal()],
        )
    table = tracker.tracks()
    assert table.status == ["confirmed"]
    assert np.hypot(*(table.mean[0, [0, 2]] - place)) < 20.0
    assert table.mode_probability.shape == (1, 16)
    other = wl.Tracker(radar, estimator=wl.BayesianAlphaBeta())
    other.restore(tracker.save())
    np.testing.assert_array_equal(other.tracks().mean, table.mean)


@pytest.mark.parametrize(
    ("setting", "value"),
    [("min_plots", 1), ("max_plots", 11), ("sojourn_s", 0.0), ("longest_line_probability", 1.0)],
)
def test_settings_that_are_invalid_are_rejected(setting, value):
    with pytest.raises(ValueError, match=setting):
        wl.BayesianAlphaBeta(**{setting: value})


def test_takes_the_position_of_other_sensors():
    bank = wl.BayesianAlphaBeta()
    place = np.array([[1000.0 + 12.0 * k, 300.0 - 6.0 * k] for k in range(12)])
    done = bank.run(place, dt_s=3.0, sensor=POSITION, start=START)
    np.testing.assert_allclose(done.mean[-1], [1132.0, 4.0, 234.0, -2.0], atol=1e-6)
