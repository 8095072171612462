"""What every class and function of the engine does with arguments and with what it gives out."""

import datetime
import pickle

import numpy as np
import pytest

import wakeline as wl
from cases import RADAR, START, turning_imm
from wakeline import _engine

CALLS = {
    "unknown": (lambda: wl.RangeBearing(bearing_std_deg=0.5), ["bearing_std_deg"]),
    "nonlinear": (lambda: wl.Kalman(wl.CoordinatedTurnRate()), ["Kalman", "linear", "Ekf", "Ukf"]),
    "by place": (lambda: tracker().process(0.0, [5.0], [1.0]), ["range_m and bearing_rad", "name"]),
    "missing": (lambda: tracker().process(0.0, range_m=[5.0]), ["process needs bearing_rad"]),
    "no model": (lambda: wl.Ekf(5), ["motion", "ConstantVelocity", "Singer", "5"]),
    "own model": (lambda: wl.Ekf(Own()), ["motion", "ConstantVelocity", "Own"]),
    "own sensor": (lambda: started().update(Own(), [1.0, 2.0]), ["sensor", "RangeBearing", "Own"]),
    "own filter": (lambda: wl.Imm([Own()], wl.ModeChain([[1.0]])), ["filters", "Ekf", "Own"]),
    "bare chain": (lambda: wl.Imm([wl.Ekf(Cv())], np.eye(1)), ["chain", "ModeChain", "array"]),
    "no radar": (lambda: wl.Tracker(3.0), ["radar", "Radar", "3.0"]),
    "text": (lambda: tracker().process("now", range_m=[], bearing_rad=[]), ["time_s", "number"]),
    "clock": (lambda: tracker().process(NOW, range_m=[], bearing_rad=[]), ["time_s", "timestamp"]),
    "times": (lambda: tracker().tracks(time_s=NOW), ["time_s", "datetime", "seconds"]),
    "span": (lambda: started().predict(NOW - NOW), ["dt_s", "timedelta", "seconds"]),
    "gate": (lambda: started().run([[1, 1]], 3.0, RADAR, START, gate=9.2), ["gate", "RadiusGate"]),
    "setting": (lambda: setattr(wl.TrackerConfig(), "max_tracks", "7"), ["max_tracks", "'7'"]),
    "too many": (lambda: started().predict(1.0, [0, 0], 3), ["predict", "at most 2"]),
    "twice": (lambda: started().predict(1.0, dt_s=1.0), ["predict", "dt_s"]),
}
NOW = datetime.datetime(2026, 8, 15, 12, tzinfo=datetime.timezone.utc)
Cv = wl.ConstantVelocity


class Own:
    """A model of one's own."""

    def matrix(self, dt_s):
        return np.eye(4)


class Drag(wl.ConstantVelocity):
    def matrix(self, dt_s):
        return np.kron(np.eye(2), [[1, dt_s], [0, 0.5]])


class Wide(wl.RangeBearing):
    def observe(self, z):
        return wl.Gaussian(z, np.eye(2))


class Slow(wl.Ekf):
    def predict(self, dt_s):
        super().predict(dt_s / 2)


def tracker():
    return wl.Tracker(wl.Radar())


def started():
    estimator = wl.Ekf(wl.ConstantVelocity())
    estimator.start(START)
    return estimator


@pytest.mark.parametrize(("call", "facts"), CALLS.values(), ids=CALLS)
def test_arguments_that_do_not_fit_are_one_sentence(call, facts):
    with pytest.raises(TypeError) as raised:
        call()
    message = str(raised.value)
    assert len(message) < 240
    assert "\n" not in message
    for fact in facts:
        assert fact in message


def test_whatever_is_called_with_something_odd_says_so_in_one_line():
    """Each class of the engine, made with one odd argument and with far too many."""
    classes = {
        one
        for module in vars(_engine).values()
        if type(module) is type(_engine)
        for one in vars(module).values()
        if isinstance(one, type) and not issubclass(one, (BaseException, int))
    }
    assert len(classes) > 60
    for one in classes:
        for odd in ([Own()], [Own()] * 30):
            with pytest.raises((TypeError, ValueError)) as raised:
                one(*odd)
            assert len(str(raised.value)) < 500, one
            assert "\n" not in str(raised.value), one


@pytest.mark.parametrize(
    "use",
    [
        lambda: wl.Kalman(Drag()),
        lambda: started().update(Wide(), [5000.0, 0.6]),
        lambda: wl.Imm([Slow(Cv())], wl.ModeChain([[1.0]])),
    ],
)
def test_methods_overridden_in_python_are_never_ignored_in_silence(use):
    with pytest.raises(TypeError, match="derived in Python"):
        use()


def test_a_tracker_needs_an_estimator_whose_methods_are_the_engines():
    class Steady(wl.Imm):
        pass

    steady = Steady([wl.Ekf(Cv())], wl.ModeChain([[1.0]]))
    with pytest.raises(TypeError, match="Steady is derived in Python"):
        wl.Tracker(wl.Radar(), estimator=steady)


# --- copies ------------------------------------------------------------------------------------

COPIES = {
    "mean": lambda: wl.Gaussian([0, 0], np.eye(2)).mean,
    "covariance": lambda: started().estimate().covariance,
    "innovation": lambda: started().update(RADAR, [5000.0, 0.6]).innovation,
    "strobe": lambda: wl.CovarianceStrobe(np.eye(2)).innovation_covariance_m2,
    "cpa": lambda: wl.closest_approach(np.zeros((3, 4)), np.ones((3, 4))).cpa_m,
}


@pytest.mark.parametrize("copied", COPIES.values(), ids=COPIES)
def test_an_array_that_a_property_copies_cannot_be_written(copied):
    array = copied()
    with pytest.raises(ValueError, match="read-only"):
        array[...] = 5.0
    array = array.copy()
    array[...] = 5.0


def test_what_a_function_returns_is_the_callers():
    f = wl.ConstantVelocity().matrix(1.0)
    f[0, 0] = 2.0
    run = started().run(np.tile([5000.0, 0.6], (3, 1)), 3.0, RADAR, START)
    run.mean[0] = 7.0
    assert (run.mean[0] == 7.0).all(), "a result keeps its arrays"


def test_settings_of_an_object_in_use_cannot_be_set():
    used = tracker()
    for copied, name in ((used.config, "max_tracks"), (used.radar, "range_std_m")):
        before = getattr(copied, name)
        with pytest.raises(AttributeError, match=f"{name} cannot be set"):
            setattr(copied, name, 7)
        assert getattr(copied, name) == before
        own = pickle.loads(pickle.dumps(copied))
        setattr(own, name, 7)
        assert getattr(own, name) == 7
    sensor = wl.RangeBearing()
    sensor.own.north_m = 5.0
    assert sensor.own.north_m == 5.0, "a part of one's own sensor"


# --- names -------------------------------------------------------------------------------------


def test_the_names_that_stubs_promise():
    assert "RangeBearing" in wl.measurement.__all__
    for name, module in vars(_engine).items():
        if type(module) is type(_engine):
            public = {one for one in vars(module) if not one.startswith("_")}
            assert set(module.__all__) == public, name


def test_unknown_values_of_tables_are_missed_readings():
    """As pandas gives a column of Float64 with NA: objects, and a `to_numpy` that fills."""

    class Column:
        def __init__(self, *values):
            self.values = values

        def __len__(self):
            return len(self.values)

        def __array__(self, dtype=None, copy=None):
            return np.array([Unknown() if v is None else v for v in self.values], dtype=object)

        def to_numpy(self, dtype=None, copy=False, na_value=None):
            return np.array([na_value if v is None else v for v in self.values], dtype=dtype)

    class Unknown:
        def __float__(self):
            raise TypeError("float() of NA")

    report = tracker().process(0.0, range_m=Column(5000.0, None), bearing_rad=[0.1, 0.2])
    assert report.rejected_plots == 1
    with pytest.raises(TypeError, match="range_m") as raised:
        tracker().process(0.0, range_m=[Unknown()], bearing_rad=[0.1])
    assert "\n" not in str(raised.value)


def test_an_imm_is_as_it_was_after_a_call_that_failed():
    imm = turning_imm()
    imm.start(START)
    before = imm.save()
    with pytest.raises(TypeError):
        imm.update(Own(), [1.0])
    assert imm.save() == before


LONG = 10_000 * "ä"


@pytest.mark.parametrize(
    "call",
    [
        lambda: wl.TrackerConfig(association=LONG),
        lambda: wl.Radar(range_std_m=LONG),
        lambda: wl.UsvNavigator(filter=LONG),
        lambda: wl.navigation.leeway_lines(LONG),
        lambda: wl.gating.strobe_echo(None, wl.RadiusGate(radius_m=1.0), [0, 0], several=LONG),
        lambda: wl.video.cfar(np.zeros((8, 64), np.uint8), kind=LONG),
    ],
)
def test_no_message_quotes_a_long_text_in_full(call):
    with pytest.raises((TypeError, ValueError, AttributeError)) as raised:
        call()
    assert len(str(raised.value)) < 1000
