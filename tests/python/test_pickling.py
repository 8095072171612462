"""Pickled objects, also in other processes, continue bit for bit."""

import copy
import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor
from operator import methodcaller

import numpy as np
import pytest

import wakeline as wl
from cases import CONVERTED, DT_S, MOTIONS, RADAR, START, readings
from test_arguments import OF_ALL_KINDS, SCHEDULES

WAYS = {
    "pickle": lambda one: pickle.loads(pickle.dumps(one)),
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
}
z = readings(24, miss=[7, 15])


def follow(estimator, rows):
    for row in rows:
        estimator.predict(DT_S)
        if np.isfinite(row).all():
            estimator.update(CONVERTED, row)
    return estimator


def assert_same(one, other):
    got, wanted = one.estimate(), other.estimate()
    np.testing.assert_array_equal(got.mean, wanted.mean)
    np.testing.assert_array_equal(got.covariance, wanted.covariance)
    for name in ("mode_probability", "turn_rates_rad_s"):
        if hasattr(other, name):
            np.testing.assert_array_equal(getattr(one, name)(), getattr(other, name)())


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", OF_ALL_KINDS)
def test_an_estimator_continues_bit_for_bit(name, way):
    estimator = copy.copy(OF_ALL_KINDS[name])
    estimator.start(START)
    follow(estimator, z[:12])
    other = WAYS[way](estimator)
    assert type(other) is type(estimator)
    assert repr(other) == repr(estimator)
    assert_same(other, estimator)
    assert_same(follow(other, z[12:]), follow(estimator, z[12:]))


@pytest.mark.parametrize("name", OF_ALL_KINDS)
def test_an_estimator_that_has_not_begun_has_not_begun(name):
    other = WAYS["pickle"](OF_ALL_KINDS[name])
    assert not other.started
    other.start(START)
    same = copy.copy(OF_ALL_KINDS[name])
    same.start(START)
    assert_same(follow(other, z), follow(same, z))


@pytest.mark.parametrize(
    "smoother",
    [
        wl.filter.ExponentialSmoother(0.3, wrapped=True),
        wl.filter.AdaptiveExponentialSmoother(),
        wl.filter.ThreePointSmoother(weight_before_s=2.0),
        wl.filter.AlphaBetaSmoother(wl.RecentMemory(max_plots=4), wrapped=True),
        wl.filter.AdaptiveAlphaBeta(),
        wl.filter.WindowBank(),
    ],
    ids=lambda smoother: type(smoother).__name__,
)
def test_a_smoother_continues_bit_for_bit(smoother):
    assert np.isnan(WAYS["pickle"](smoother).value)
    course = np.linspace(3.0, 3.4, 20)
    for reading in course[:9]:
        smoother.update(2.0, reading)
    other = WAYS["pickle"](smoother)
    for reading in course[9:]:
        smoother.update(2.0, reading)
        other.update(2.0, reading)
        assert (other.value, other.rate) == (smoother.value, smoother.rate)


@pytest.mark.parametrize("filter", ["ekf", "ukf", "augmented_ukf"])
@pytest.mark.parametrize("states", [5, 7, 8])
def test_a_navigator_continues_bit_for_bit(states, filter):
    navigator = wl.UsvNavigator(states, filter, rejections=4)
    navigator.start([0.0, 0.0], [5.0, 0.0], 0.0)
    rng = np.random.default_rng(2)

    def sail(one, first, last, noise):
        for k in range(first, last):
            one.predict(1.0, [0.0, 0.0, 0.0])
            one.update_heading(noise[k, 2] / 50)
            one.update_velocity([0.0 if k > 30 else 5.0, 0.0])
            reading = one.update_position([5.0 * k + noise[k, 0], noise[k, 1]])
        return reading

    noise = rng.normal(size=(60, 3))
    sail(navigator, 1, 36, noise)
    other = WAYS["pickle"](navigator)
    got, wanted = (sail(one, 36, 60, noise) for one in (other, navigator))
    assert got.nis == wanted.nis
    np.testing.assert_array_equal(other.estimate.mean, navigator.estimate.mean)
    np.testing.assert_array_equal(other.estimate.covariance, navigator.estimate.covariance)
    again = WAYS["pickle"](got)
    assert (type(again), again.nis, again.rejected) == (type(got), got.nis, got.rejected)
    assert again.widened == got.widened
    np.testing.assert_array_equal(again.innovation_covariance, got.innovation_covariance)


@pytest.mark.filterwarnings("ignore:the ModeChain has no period")
@pytest.mark.parametrize("estimator", [None, OF_ALL_KINDS["ModeHistory"]])
def test_a_tracker_continues_bit_for_bit(estimator):
    tracker = wl.Tracker(wl.Radar(period_s=DT_S), estimator=estimator)

    def watch(one, rows, first):
        for k, row in enumerate(rows, first):
            range_m, bearing_rad = row[np.isfinite(row)].reshape(-1, 2).T
            one.process(DT_S * k, range_m=range_m, bearing_rad=bearing_rad)
        return one.tracks()

    watch(tracker, z[:12], 1)
    for way in WAYS.values():
        other = way(tracker)
        assert repr(other) == repr(tracker)
        table = watch(way(tracker), z[12:], 13)
        assert len(table.track_id) == 1
    wanted = watch(tracker, z[12:], 13)
    np.testing.assert_array_equal(table.mean, wanted.mean)
    np.testing.assert_array_equal(table.covariance, wanted.covariance)
    np.testing.assert_array_equal(table.track_id, wanted.track_id)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(
    "thing",
    [
        *MOTIONS.values(),
        wl.WhiteAcceleration(psd_m2s3=0.3),
        wl.PiecewiseAcceleration(std_mps2=0.2),
        wl.WhiteJerk(psd_m2s5=0.1),
        *SCHEDULES.values(),
        wl.RecentMemory(max_plots=3),
        wl.RangeBearing(own=wl.OwnShip(north_m=3.0)),
        wl.RangeBearingDoppler(),
        wl.Position(position_std_m=2.0),
        wl.OwnShip(heading_std_rad=0.01),
        wl.ModeChain([[0.9, 0.1], [0.3, 0.7]], period_s=3.0),
        wl.ChiSquareGate(probability=0.9),
        wl.RadiusGate(radius_m=300.0),
        wl.gating.RangeBearingWindow(range_half_m=40.0),
        wl.CovarianceStrobe([[90.0, 1 / 3], [1 / 3, 7.0]], wl.ChiSquareGate(probability=0.7)),
        wl.LocalPlane(latitude_rad=0.8, longitude_rad=-0.1),
        wl.Radar(period_s=3.0),
        wl.TrackerConfig(confirm_hits=4),
        wl.VesselModels.ships(),
        wl.navigation.DriftModel(leeway=0.05, residual_time_s=900.0),
        wl.navigation.DriftWindow(max_fixes=7, log_std_mps=0.1, alteration_mps=0.5),
        wl.motion.ProcessNoise(wl.WhiteJerk(psd_m2s5=0.1)),
        wl.motion.ProcessNoise(wl.PiecewiseAcceleration(std_mps2=0.2)),
        wl.video.StaticClutterMap(8, 16, 60.0, factor=1.25),
        START,
    ],
    ids=lambda thing: type(thing).__name__,
)
def test_models_sensors_and_settings(thing, way):
    other = WAYS[way](thing)
    assert other is not thing
    assert type(other) is type(thing)
    assert repr(other) == repr(thing)


def test_a_step_and_the_results_of_a_run():
    filter = wl.Ekf(MOTIONS["ConstantVelocity"])
    filter.start(START)
    filter.predict(DT_S)
    step = filter.update(RADAR, z[0])
    other = WAYS["pickle"](step)
    assert (other.status, other.nis) == (step.status, step.nis)
    assert other.log_likelihood == step.log_likelihood
    np.testing.assert_array_equal(other.innovation, step.innovation)
    np.testing.assert_array_equal(other.innovation_covariance, step.innovation_covariance)
    result = filter.run(z, dt_s=DT_S, sensor=RADAR, start=START)
    np.testing.assert_array_equal(WAYS["pickle"](result).covariance, result.covariance)


def assert_equal_fields(one, other, names):
    assert type(one) is type(other)
    for name in names.split():
        got, wanted = getattr(one, name), getattr(other, name)
        if isinstance(wanted, dict):
            assert got.keys() == wanted.keys()
            for key in wanted:
                np.testing.assert_array_equal(got[key], wanted[key])
        elif wanted is not None:
            np.testing.assert_array_equal(got, wanted)
            assert np.asarray(got).dtype == np.asarray(wanted).dtype
        else:
            assert got is None


@pytest.mark.parametrize("way", WAYS)
def test_the_run_of_a_navigator(way):
    navigator = wl.UsvNavigator(8)
    navigator.start([0.0, 0.0], [5.0, 0.0], 0.0)
    time_s = np.arange(9.0)
    gnss = np.column_stack([5.0 * time_s, 0.0 * time_s])
    gnss[5] = 900.0
    run = navigator.run(time_s, imu=np.zeros((9, 3)), gnss=gnss)
    assert run.rejected["gnss"][5]
    assert_equal_fields(WAYS[way](run), run, "mean covariance nis rejected")


@pytest.mark.parametrize("way", WAYS)
def test_what_a_fuzzy_criterion_saw(way):
    trace = wl.FuzzyAlphaBeta().trace(z, dt_s=DT_S, sensor=CONVERTED, start=START)
    names = "quality chosen sigma_hat_m residual_ratios rule_strengths prediction_m innovation_m"
    assert_equal_fields(WAYS[way](trace), trace, names)


@pytest.mark.parametrize("way", WAYS)
def test_closest_approaches(way):
    rng = np.random.default_rng(5)
    target = rng.normal(scale=[2e3, 8, 2e3, 8], size=(3, 2, 4))
    covariance = np.diag([900.0, 0.25, 400.0, 0.5])
    for one in (
        wl.navigation.closest_approach(np.zeros(4), target, None, covariance),
        wl.navigation.closest_approach(np.zeros(4), target[0, 0]),
        wl.navigation.closest_approach(np.zeros(4), np.zeros((0, 4))),
    ):
        other = WAYS[way](one)
        assert_equal_fields(other, one, "cpa_m signed_cpa_m tcpa_s cpa_std_m tcpa_std_s covariance")
        np.testing.assert_array_equal(
            other.probability(500.0, 600.0), one.probability(500.0, 600.0)
        )


@pytest.mark.filterwarnings("ignore:the ModeChain has no period")
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("estimator", [None, OF_ALL_KINDS["SwitchingGridImm"]])
def test_what_a_tracker_reports(estimator, way):
    tracker = wl.Tracker(wl.Radar(period_s=DT_S), estimator=estimator)
    events = []
    for k, row in enumerate(z[:12]):
        range_m, bearing_rad = row[np.isfinite(row)].reshape(-1, 2).T
        report = tracker.process(DT_S * k, range_m=range_m, bearing_rad=bearing_rad)
        other = WAYS[way](report)
        assert_equal_fields(other, report, "plot_track_id rejected_plots")
        assert_equal_fields_of_all(other.events, report.events)
        events += report.events
    assert {event.kind for event in events} >= {"started", "confirmed"}
    table = tracker.tracks()
    assert len(table) == 1
    names = "track_id status time_s mean covariance mode_probability turn_rate_rad_s nis"
    assert_equal_fields(WAYS[way](table), table, f"{names} existence visibility hits misses name")


def assert_equal_fields_of_all(events, wanted):
    assert len(events) == len(wanted)
    for event, same in zip(events, wanted, strict=True):
        assert_equal_fields(event, same, "kind track_id tentative_id time_s reason")


@pytest.mark.parametrize("way", WAYS)
def test_a_window_of_drift_continues_bit_for_bit(way):
    window = wl.navigation.DriftWindow(
        max_fixes=5, log_std_mps=0.1, heading_std_rad=0.01, alteration_mps=0.3
    )

    def sail(one, first, last):
        for k in range(first, last):
            one.advance(10.0, 4.0 if k < 14 else 4.5, 0.3 + 0.01 * k)
            if k % 2:
                fix = [40.0 * k + np.sin(k), 12.0 * k + np.cos(k)]
                one.add(wl.Gaussian(fix, 25.0 * np.eye(2)))
        return one.drift()

    sail(window, 0, 15)
    other = WAYS[way](window)
    got, wanted = sail(other, 15, 24), sail(window, 15, 24)
    np.testing.assert_array_equal(got.mean, wanted.mean)
    np.testing.assert_array_equal(got.covariance, wanted.covariance)
    assert (other.size, other.ready) == (window.size, window.ready)
    with pytest.raises(ValueError, match="different parameters"):
        wl.navigation.DriftWindow(max_fixes=6).restore(window.save())


@pytest.mark.parametrize("state", [(), (1, 2, 3, 4, 5)])
def test_a_result_of_no_such_fields_is_rejected(state):
    for kind in (wl.track.ScanReport, wl.track.TrackTable, wl.navigation.ClosestApproach):
        with pytest.raises(ValueError, match="state is not that of such a result"):
            kind.__new__(kind).__setstate__(state)


def test_a_state_that_is_of_another_is_rejected_and_nothing_changes():
    imm = copy.copy(OF_ALL_KINDS["Imm-initial"])
    imm.start(START)
    follow(imm, z[:5])
    before = copy.copy(imm)
    history = copy.copy(OF_ALL_KINDS["ModeHistory"])
    of_another_chain = OF_ALL_KINDS["Imm"].save()
    for state in (b"", imm.save()[:-1], imm.save() + b"\0"):
        with pytest.raises(ValueError, match=r"state must be the bytes that save\(\) returned"):
            imm.restore(state)
        assert_same(imm, before)
    for state in (history.save(), of_another_chain):
        with pytest.raises(ValueError, match="state was saved with different parameters"):
            imm.restore(state)
        assert_same(imm, before)
    imm.restore(before.save())
    assert_same(imm, before)


def test_a_root_is_no_covariance():
    ukf, root = (kind(MOTIONS["ConstantVelocity"]) for kind in (wl.Ukf, wl.SquareRootUkf))
    ukf.start(START)
    with pytest.raises(ValueError, match="different parameters"):
        root.restore(ukf.save())
    assert not root.started


@pytest.mark.parametrize(
    ("innovation", "covariance", "name"),
    [
        (np.zeros(40), np.eye(40), "innovation must have shape"),
        (np.zeros(2), np.eye(1), "innovation_covariance must have shape"),
        (np.zeros((2, 2)), np.eye(4), "innovation must have shape"),
    ],
)
def test_a_step_of_no_shape_is_rejected(innovation, covariance, name):
    step = wl.Step.__new__(wl.Step)
    with pytest.raises(ValueError, match=name):
        step.__setstate__((wl.Status.ok, innovation, covariance, 0.0, 0.0))


class Mine(wl.Ekf):
    pass


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_what_is_derived_in_python_says_itself_how(protocol):
    mine = Mine(MOTIONS["ConstantVelocity"])
    with pytest.raises(TypeError, match="Mine is derived in Python"):
        pickle.dumps(mine, protocol)
    for way in (copy.copy, copy.deepcopy):
        with pytest.raises(TypeError, match="Mine is derived in Python"):
            way(mine)


def test_another_process_works_with_what_it_is_sent():
    kinds = [OF_ALL_KINDS[name] for name in ("Imm-initial", "ModeHistory", "SwitchingGridImm")]
    run = methodcaller("run", z, dt_s=DT_S, sensor=RADAR, start=START)
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        for got, wanted in zip(pool.map(run, kinds), map(run, kinds), strict=True):
            np.testing.assert_array_equal(got.mean, wanted.mean)
