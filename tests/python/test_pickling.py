"""What is pickled, or sent to another process, goes on bit for bit."""

import copy
import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor
from operator import methodcaller

import numpy as np
import pytest

import wakeline as wl
from cases import CONVERTED, DT_S, MOTIONS, RADAR, START, readings
from test_repr import OF_ALL_KINDS, SCHEDULES

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
def test_an_estimator_goes_on_bit_for_bit(name, way):
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
        wl.filter.PrintedAdaptiveExponential(first_alpha=0.4),
        wl.filter.ThreePointSmoother(weight_before_s=2.0),
        wl.filter.AlphaBetaSmoother(wl.RecentMemory(max_plots=4), wrapped=True),
        wl.filter.AdaptiveAlphaBeta(),
        wl.filter.PrintedAdaptiveAlphaBeta(),
        wl.filter.WindowBank(),
    ],
    ids=lambda smoother: type(smoother).__name__,
)
def test_a_smoother_goes_on_bit_for_bit(smoother):
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
def test_a_navigator_goes_on_bit_for_bit(states, filter):
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


@pytest.mark.parametrize("estimator", [None, OF_ALL_KINDS["ModeHistory"]])
def test_a_tracker_goes_on_bit_for_bit(estimator):
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
        wl.navigation.LocalPlane(0.8, -0.1),
        wl.Radar(period_s=3.0),
        wl.TrackerConfig(confirm_hits=4),
        wl.VesselModels.ships(),
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


def test_a_state_that_is_of_another_is_refused_and_nothing_changes():
    imm = copy.copy(OF_ALL_KINDS["Imm-initial"])
    imm.start(START)
    follow(imm, z[:5])
    before = copy.copy(imm)
    history = copy.copy(OF_ALL_KINDS["ModeHistory"])
    of_another_chain = OF_ALL_KINDS["Imm"].save()
    for state in (b"", imm.save()[:-1], imm.save() + b"\0", history.save(), of_another_chain):
        with pytest.raises(ValueError, match="state is not that of one that is made alike"):
            imm.restore(state)
        assert_same(imm, before)
    imm.restore(before.save())
    assert_same(imm, before)


def test_a_root_is_no_covariance():
    ukf, root = (kind(MOTIONS["ConstantVelocity"]) for kind in (wl.Ukf, wl.SquareRootUkf))
    ukf.start(START)
    with pytest.raises(ValueError, match="made alike"):
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
def test_a_step_of_no_shape_is_refused(innovation, covariance, name):
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
