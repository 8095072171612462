"""Smoothers of one quantity."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl
from wakeline import filter as wf
from wakeline import scenario

KINDS = {
    "exponential": lambda **k: wf.ExponentialSmoother(0.4, **k),
    "adaptive exponential": wf.AdaptiveExponentialSmoother,
    "three points": wf.ThreePointSmoother,
    "adaptive three points": lambda **k: wf.ThreePointSmoother(adaptive=True, parabola=False, **k),
    "(27)": lambda **k: wf.AlphaBetaSmoother(wf.GrowingMemory(max_plots=5), **k),
    "(28)": lambda **k: wf.AlphaBetaSmoother(wf.GrowingMemory(plots_before=1, max_plots=5), **k),
    "(29)": lambda **k: wf.AlphaBetaSmoother(wf.RecentMemory(max_plots=5), **k),
    "(30)": lambda **k: wf.AlphaBetaSmoother(wf.RangeDependent(), **k),
    "constant": lambda **k: wf.AlphaBetaSmoother(wf.ConstantGains(0.5, 0.2), **k),
    "tracking index": lambda **k: wf.AlphaBetaSmoother(
        wf.TrackingIndex(0.05), reading_std=0.1, **k
    ),
    "(33)": wf.AdaptiveAlphaBeta,
    "bank": wf.WindowBank,
}
every = pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS.keys())

KNOT = 1852.0 / 3600.0


def wrapped(angle_rad):
    return (np.asarray(angle_rad) + np.pi) % (2 * np.pi) - np.pi


@every
@given(st.floats(-10, 10), st.floats(-0.1, 0.1), st.integers(0, 1000))
def test_angles_go_through_north(kind, start, rate, seed):
    """Of angles a smoother says what it says of the same angles unwrapped."""
    rng = np.random.default_rng(seed)
    dt_s = rng.uniform(0.5, 3.0, 60)
    course = start + rate * np.cumsum(dt_s) + 0.02 * rng.standard_normal(60)
    on_line = kind().run(dt_s, course, ahead_s=4.0)
    on_angles = kind(wrapped=True).run(dt_s, wrapped(course), ahead_s=4.0)
    assert np.abs(on_angles[0]).max() <= np.pi
    assert np.abs(wrapped(on_angles[0] - on_line[0])).max() < 1e-7
    assert np.abs(on_angles[1] - on_line[1]).max() < 1e-7
    assert np.abs(wrapped(on_angles[2] - on_line[2])).max() < 1e-6


@pytest.mark.parametrize("kind", ["adaptive three points", "(33)", "bank"])
def test_readings_that_are_reported_twice_count_once(kind):
    rng = np.random.default_rng(4)
    dt_s, reading = rng.uniform(0.5, 3.0, 60), np.cumsum(rng.standard_normal(60))
    twice = np.column_stack([dt_s, np.zeros(60)]).ravel(), np.repeat(reading, 2)
    for said, once in zip(KINDS[kind]().run(*twice), KINDS[kind]().run(dt_s, reading), strict=True):
        np.testing.assert_array_equal(said[1::2], once)


@every
def test_359_to_1_is_2_degrees(kind):
    smoother = kind(wrapped=True)
    for course_deg in (357.0, 359.0, 1.0, 3.0, 5.0):
        smoother.update(1.0, np.radians(course_deg))
        assert abs(wrapped(smoother.value - np.radians(course_deg))) < np.radians(7)


@every
def test_step_by_step_is_the_run_and_arrays_are_runs(kind):
    rng = np.random.default_rng(1)
    readings = rng.standard_normal((2, 3, 40))
    value, rate, forecast = kind().run(2.0, readings, ahead_s=6.0)
    assert value.shape == rate.shape == forecast.shape == (2, 3, 40)
    smoother = kind()
    for k in range(40):
        smoother.update(2.0, readings[1, 2, k])
        assert smoother.value == value[1, 2, k]
        assert smoother.rate == rate[1, 2, k]
        assert smoother.forecast(6.0) == forecast[1, 2, k]


@every
def test_missing_readings_let_time_continue(kind):
    readings = np.array([np.nan, np.nan, 3.0, 3.0, np.nan, 3.0, 3.0, np.nan, np.nan])
    value, rate, forecast = kind().run(1.0, readings)
    assert np.isnan(value[:2]).all()
    assert value[2:] == pytest.approx(3.0)
    assert rate[2:] == pytest.approx(0.0, abs=1e-12)
    assert forecast[2:] == pytest.approx(3.0)


@every
def test_two_readings_of_one_time_are_taken(kind):
    steps = np.tile([1.0, 0.0], 9)
    value, rate, forecast = kind().run(steps, np.repeat(np.arange(9.0) / 10, 2))
    assert np.isfinite([value, rate, forecast]).all()
    assert forecast[-1] == pytest.approx(0.8, abs=0.1)


@every
def test_bad_readings_are_rejected(kind):
    with pytest.raises(wl.FilterError, match="reading 2: not finite"):
        kind().run(1.0, [1.0, np.nan, np.inf])
    with pytest.raises(ValueError, match="dt_s must be finite and not negative, got -1"):
        kind().run([0.0, -1.0], [1.0, 2.0])
    with pytest.raises(ValueError, match=r"dt_s must have shape \(\) or \(2,\), got \(3,\)"):
        kind().run([0.0, 1.0, 1.0], [1.0, 2.0])
    smoother = kind()
    assert np.isnan([smoother.value, smoother.rate, smoother.forecast(1.0)]).all(), "none yet"
    smoother.update(0.0, 1.0)
    with pytest.raises(wl.FilterError, match="negative time step"):
        smoother.update(-1.0, 2.0)
    assert smoother.value == 1.0


@given(st.floats(-5, 5), st.floats(-5, 5), st.floats(-5, 5), st.floats(0.1, 10), st.floats(0.1, 10))
def test_the_derivative_is_exact_for_a_parabola(a, b, c, before_s, after_s):
    def at(t):
        return a * t * t + b * t + c

    rate = wf.three_point_rate(at(-before_s), at(0.0), at(after_s), before_s, after_s)
    assert rate == pytest.approx(b, abs=1e-8 * (1 + abs(b) + abs(a) * 10) + 1e-8)
    even = wf.three_point_rate(at(-2.0), at(0.0), at(2.0), 2.0, 2.0, parabola=False)
    assert even == pytest.approx(b, abs=1e-9)


def test_the_schedules_are_those_of_the_paper():
    assert wf.RecentMemory().gains(reading=2) == pytest.approx([1.0, 1.0])
    assert wf.RecentMemory().gains(reading=9) == pytest.approx([54 / 110, 12 / 110])
    with pytest.raises(ValueError, match="max_plots"):
        wf.AlphaBetaSmoother(wf.RecentMemory(max_plots=1))
    with pytest.raises(ValueError, match="reading"):
        wf.RecentMemory().gains(reading=0)
    with pytest.raises(ValueError, match="reading_std"):
        wf.AlphaBetaSmoother(reading_std=0.0)
    far = wf.AlphaBetaSmoother(wf.RangeDependent()).run(1.0, [0.0, 1.0], range_m=40e3)
    assert far[0][1] == pytest.approx(0.5)  # 20 / D
    with pytest.raises(wl.FilterError, match="not finite"):
        wf.AlphaBetaSmoother(wf.RangeDependent()).run(1.0, [0.0, 1.0], range_m=np.nan)


@pytest.mark.parametrize("settings", [{"max_readings": 1}, {"max_readings": 33}, {"memory": -0.1}])
def test_a_bank_that_is_invalid_is_rejected(settings):
    with pytest.raises(ValueError, match=next(iter(settings))):
        wf.WindowBank(**settings)


@pytest.mark.parametrize(
    ("dt_s", "speed_kn", "course_deg"), [(1.0, 0.10, 0.30), (3.0, 0.22, 0.85), (10.0, 0.80, 4.2)]
)
def test_a_bank_predicts_a_voyage_four_steps_ahead(dt_s, speed_kn, course_deg):
    truth = scenario.reckoning_voyage(dt_s)
    log, gyro, *_ = truth.read(runs=6, seed=0)
    forecast = wf.WindowBank().run(dt_s, log, ahead_s=4 * dt_s)[2]
    speed_error = (forecast[:, :-4] - truth.speed_mps[4:]) / KNOT
    forecast = wf.WindowBank(wrapped=True).run(dt_s, gyro, ahead_s=4 * dt_s)[2]
    course_error = np.degrees(wrapped(forecast[:, :-4] - truth.course_rad[4:]))
    assert np.sqrt(np.mean(speed_error**2)) < speed_kn
    assert np.sqrt(np.mean(course_error**2)) < course_deg


# --- equations --------------------------------------------------------------------------------


def passed(dt_s, reading, gains):
    """(26) over a window: value, rate, and of each step x^ - x~, e, dV, t and the rise of x^."""
    value, rate, steps = reading[0], 0.0, []
    for n in range(1, len(reading)):
        alpha, beta = gains(n + 1)
        predicted = value + rate * dt_s[n]
        error = reading[n] - predicted
        before, value = value, predicted + alpha * error
        rate += beta * error / dt_s[n]
        steps.append([alpha * error, error, beta * error / dt_s[n], dt_s[n], value - before])
    return value, rate, np.array(steps)


def gains_27(n):
    return 2 * (2 * n - 1) / (n * (n + 1)), 6 / (n * (n + 1))


def by_33(dt_s, reading):
    """Two passes, the second with the gains of the first."""
    alpha = beta = 1.0
    if len(reading) > 2:
        correction, error, change, t, _ = passed(dt_s, reading, gains_27)[2].T
        alpha = (correction @ error) / (error @ error)
        beta = (change @ (error / t)) / ((error / t) @ (error / t))
    return passed(dt_s, reading, lambda _: (alpha, beta))[:2]


def alpha_23(dt_s, reading):
    rise = passed(dt_s, reading, gains_27)[2][:, 4]
    jump = reading[1:] - (reading[0] + np.cumsum(np.append(0.0, rise[:-1])))
    return np.clip((rise @ jump) / (jump @ jump), 0.0, 1.0)


def by_24(dt_s, reading):
    """The last reading but one, smoothed by the weights that bring three to the line of five."""
    t = np.append(0.0, np.cumsum(dt_s[1:]))
    off = np.polyval(np.polyfit(t, reading, 1), t)[1:-1] - reading[1:-1]
    beside = np.column_stack([-np.diff(reading)[:-1] / dt_s[1:-1], np.diff(reading)[1:] / dt_s[2:]])
    weights = np.linalg.lstsq(beside, off, rcond=None)[0]
    return reading[-2] + beside[-1] @ weights


def uneven_voyage(seed):
    """Steps and readings of something that wanders."""
    rng = np.random.default_rng(seed)
    dt_s = rng.uniform(0.5, 5.0, 50)
    return dt_s, np.cumsum(0.1 * dt_s * rng.standard_normal(50)) + 0.1 * rng.standard_normal(50)


@pytest.mark.parametrize("seed", range(3))
def test_windows_of_five_are_their_equations(seed):
    dt_s, reading = uneven_voyage(seed)
    adaptive, exponential = wf.AdaptiveAlphaBeta(), wf.AdaptiveExponentialSmoother()
    three = wf.ThreePointSmoother(adaptive=True)
    for k in range(50):
        before = exponential.value
        for smoother in (adaptive, exponential, three):
            smoother.update(dt_s[k], reading[k])
        window = slice(max(k - 4, 0), k + 1)
        if k == 0:
            continue
        assert [adaptive.value, adaptive.rate] == pytest.approx(
            by_33(dt_s[window], reading[window])
        )
        alpha = alpha_23(dt_s[window], reading[window])
        assert exponential.value == pytest.approx(before + alpha * (reading[k] - before))
        if k >= 4:
            assert three.value == pytest.approx(by_24(dt_s[window], reading[window]))


@pytest.mark.parametrize("seed", range(3))
def test_the_bank_is_the_line_whose_innovations_have_the_least_energy(seed):
    dt_s, reading = uneven_voyage(seed)
    time_s = np.cumsum(dt_s)

    def line(n, k):
        """Through the last n readings before the k-th, or as many as there are."""
        last = slice(max(k - n, 0), k)
        return np.polyfit(time_s[last], reading[last], min(k - 1, 1))

    bank = wf.WindowBank(max_readings=9, memory=0.9)
    bank.update(dt_s[0], reading[0])
    energy = np.zeros(8)
    for k in range(1, 50):
        bank.update(dt_s[k], reading[k])
        predicted = np.array([np.polyval(line(n, k), time_s[k]) for n in range(2, 10)])
        energy = 0.9 * energy + (reading[k] - predicted) ** 2
        best = line(int(np.argmin(energy)) + 2, k + 1)
        assert bank.window == min(int(np.argmin(energy)) + 2, k + 1)
        assert [bank.value, bank.rate] == pytest.approx([np.polyval(best, time_s[k]), best[0]])
