"""Smoothing and prediction of own ship's motion, and the drift of the water.

The vessel of :mod:`wakeline.scenario.voyage` alters speed and course for 40 minutes in a current.
Each estimator smooths speed, course, latitude and longitude and predicts them four readings ahead;
combined dead reckoning (11) combines smoothed speed, course and drift. The drift is estimated on a
steady course with a fix every 30 s, by a line through the differences of observed and reckoned
positions or from rates.

Scenarios are ``forecast_4x1s`` to ``forecast_4x10s``, four readings ahead on the voyage, and
``drift_20``, ``drift_5``, with that many fixes after the first.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

import wakeline as wl
from wakeline import filter as wf
from wakeline import navigation as nav
from wakeline import plot
from wakeline._units import KNOT_MPS
from wakeline.metrics import rmse
from wakeline.scenario import voyage as sea

from . import curves
from .base import Done, Picture, Plan, Published, Request, Rows, Study

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AHEAD = 4  # readings
WINDOW = 5
STEPS_S = {"forecast_4x1s": 1.0, "forecast_4x3s": 3.0, "forecast_4x10s": 10.0}
FIXES = {"drift_20": 20, "drift_5": 5}
DRIFT_STEP_S, DRIFT_SPEED_MPS = 30.0, 10.0 * KNOT_MPS
METRICS = (
    "speed_rms_kn",
    "course_rms_deg",
    "latitude_rms_arcmin",
    "longitude_rms_arcmin",
    "drift_rms_kn",
)

ARCMIN = np.deg2rad(1.0 / 60.0)
_NAN = float("nan")
_UNIT = dict(zip(METRICS, (KNOT_MPS, np.deg2rad(1.0), ARCMIN, ARCMIN, KNOT_MPS), strict=True))
_DRIFT_STD_MPS = 1.5 * KNOT_MPS  # before anything is known
_DRIFT_PSD_M2S3 = 1e-9
_SHOWN = {"adaptive_two_pass": 1, "window_bank": 2, "kalman": 0}  # with their colours
_SHOWN_STEP_S = 3.0


class Predicted(NamedTuple):
    """A quantity after each reading, its rate per second, and the forecast; each (..., T)."""

    value: np.ndarray
    rate: np.ndarray
    forecast: np.ndarray


Smoother = Callable[[str, float, np.ndarray], Predicted]


# The estimators -----------------------------------------------------------------------------------


def smoothers() -> dict[str, Smoother]:
    """Each takes a metric, the step and readings (..., T) of the quantity that it judges."""
    return {
        "last_value": _last_value,
        "alpha_beta_w5": _window,
        "adaptive_two_pass": _engine(lambda wrapped: wf.AdaptiveAlphaBeta(wrapped=wrapped)),
        "adaptive_one_pass": lambda metric, dt_s, readings: one_pass(metric, dt_s, readings)[0],
        "window_bank": _engine(lambda wrapped: wf.WindowBank(wrapped=wrapped)),
        "kalman": _kalman,
    }


def _engine(make: Callable[[bool], Any]) -> Smoother:
    def smooth(metric: str, dt_s: float, readings: np.ndarray) -> Predicted:
        smoother = make(metric == "course_rms_deg")
        return Predicted(*smoother.run(dt_s, readings, ahead_s=AHEAD * dt_s))

    return smooth


def _last_value(metric: str, dt_s: float, readings: np.ndarray) -> Predicted:
    return Predicted(readings, np.zeros_like(readings), readings)


def _window(metric: str, dt_s: float, readings: np.ndarray) -> Predicted:
    """(26) with the gains (27), restarted in each window: the line through the last readings."""
    smooth = _engine(lambda wrapped: wf.AlphaBetaSmoother(wf.GrowingMemory(), wrapped=wrapped))
    first = smooth(metric, dt_s, readings[..., : WINDOW - 1])
    windows = sliding_window_view(readings, WINDOW, axis=-1)
    later = smooth(metric, dt_s, windows)
    joined = (
        np.concatenate([begun, full[..., -1]], axis=-1)
        for begun, full in zip(first, later, strict=True)
    )
    return Predicted(*joined)


def one_pass(
    metric: str, dt_s: float, readings: np.ndarray
) -> tuple[Predicted, np.ndarray, np.ndarray]:
    """The adaptive alpha-beta filter (33) as printed, for comparison.

    The gains are those sums over the filter's own last five steps which
    :class:`wakeline.filter.AdaptiveAlphaBeta` takes over a first pass. There the correction of a
    step is alpha times its innovation, so the sums return means of the gains just used.

    Returns
    -------
    (Predicted, alpha, beta)
        Each array has the shape (..., T) of the readings; the gains are those of each reading.
    """
    wrap = wl.wrap_angle if metric == "course_rms_deg" else np.asarray
    value, rate, alpha, beta = (np.zeros_like(readings) for _ in range(4))
    innovation = np.zeros_like(readings)
    value[..., 0] = wrap(readings[..., 0])
    alpha[..., 0] = beta[..., 0] = 1.0
    for k in range(1, readings.shape[-1]):
        n = k + 1
        if n <= WINDOW + 1:  # (27), until the sums are full
            alpha[..., k] = 2 * (2 * n - 1) / (n * (n + 1))
            beta[..., k] = 6 / (n * (n + 1))
        else:
            squared = innovation[..., k - WINDOW : k] ** 2
            for gain in (alpha, beta):
                gain[..., k] = np.average(gain[..., k - WINDOW : k], axis=-1, weights=squared)
        predicted = value[..., k - 1] + rate[..., k - 1] * dt_s
        innovation[..., k] = wrap(readings[..., k] - predicted)
        value[..., k] = wrap(predicted + alpha[..., k] * innovation[..., k])
        rate[..., k] = rate[..., k - 1] + beta[..., k] * innovation[..., k] / dt_s
    return Predicted(value, rate, wrap(value + rate * (AHEAD * dt_s))), alpha, beta


def _kalman(metric: str, dt_s: float, readings: np.ndarray) -> Predicted:
    """Value and rate, driven by white acceleration."""
    psd = ACCELERATION_PSD[metric]
    noise = psd * np.array([[dt_s**3 / 3, dt_s**2 / 2], [dt_s**2 / 2, dt_s]])
    if metric == "course_rms_deg":
        readings = np.unwrap(readings, axis=-1)
    value, rate = two_state_kalman(
        dt_s, readings, READING_STD[metric], noise, rate_std=RATE_STD[metric]
    )
    return Predicted(value, rate, value + AHEAD * dt_s * rate)


def two_state_kalman(
    dt_s: float, readings: np.ndarray, reading_std: float, noise: np.ndarray, rate_std: float
) -> tuple[np.ndarray, np.ndarray]:
    """Value and rate (..., T) of readings (..., T) by a Kalman filter started with the first.

    Parameters
    ----------
    dt_s : float
    readings : (..., T) array
    reading_std : float
    noise : (2, 2) array
        Process noise of value and rate per step.
    rate_std : float
        Standard deviation of the initial rate, whose mean is zero.
    """
    move = np.array([[1.0, dt_s], [0.0, 1.0]])
    covariance = np.diag([reading_std**2, rate_std**2])
    value, rate = np.empty_like(readings), np.zeros_like(readings)
    value[..., 0] = readings[..., 0]
    for k in range(1, readings.shape[-1]):
        covariance = move @ covariance @ move.T + noise
        gain = covariance[:, 0] / (covariance[0, 0] + reading_std**2)
        covariance = covariance - np.outer(gain, covariance[0])
        predicted = value[..., k - 1] + dt_s * rate[..., k - 1]
        off = readings[..., k] - predicted
        value[..., k] = predicted + gain[0] * off
        rate[..., k] = rate[..., k - 1] + gain[1] * off
    return value, rate


def combined(
    dt_s: float, read: sea.VoyageReadings
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Combined dead reckoning four readings ahead; (11).

    A line through observed minus reckoned positions corrects the reckoned position with its value
    and gives the drift as its slope. The prediction continues with the speed and course that the
    bank of windows predicts for half way.

    Returns
    -------
    (latitude_rad, longitude_rad, latitude_drift_rad_s, longitude_drift_rad_s)
        Each (R, T).
    """
    place = sea.reckoned(read.speed_mps, read.course_rad, dt_s)
    fix = (read.latitude_rad, read.longitude_rad)
    # Errors of log and gyro are independent at each reading: the reckoned position is a random
    # walk.
    walk_m = dt_s * np.hypot(sea.LOG_STD_MPS, DRIFT_SPEED_MPS * sea.GYRO_STD_RAD) / np.sqrt(2.0)
    noise_m2 = np.diag([walk_m**2, dt_s * _DRIFT_PSD_M2S3])
    now, drift = [], []
    for observed, reckoned, radian_m in zip(fix, place, RADIAN_M, strict=True):
        off, slope = two_state_kalman(
            dt_s,
            observed - reckoned,
            sea.FIX_STD_M / radian_m,
            noise_m2 / radian_m**2,
            _DRIFT_STD_MPS / radian_m,
        )
        now.append(reckoned + off)
        drift.append(slope)
    bank = smoothers()["window_bank"]
    half_s = 0.5 * AHEAD * dt_s
    speed, course = (
        smoothed.value + half_s * smoothed.rate
        for smoothed in (
            bank("speed_rms_kn", dt_s, read.speed_mps),
            bank("course_rms_deg", dt_s, read.course_rad),
        )
    )
    drift_mps = nav.velocity_from_rates_mps(*drift, now[0])
    ahead = nav.dead_reckon(*now, speed, course, AHEAD * dt_s, *nav.speed_course(drift_mps))
    return (*ahead, *drift)


# Errors -------------------------------------------------------------------------------------------


def _radian_m() -> np.ndarray:
    """Metres per radian of latitude and of longitude at the start of the voyage."""
    return nav.velocity_from_rates_mps(1.0, 1.0, sea.START_RAD[0])


RADIAN_M = _radian_m()
READING_STD = {
    "speed_rms_kn": sea.LOG_STD_MPS,
    "course_rms_deg": sea.GYRO_STD_RAD,
    "latitude_rms_arcmin": sea.FIX_STD_M / RADIAN_M[0],
    "longitude_rms_arcmin": sea.FIX_STD_M / RADIAN_M[1],
}
RATE_STD = {
    "speed_rms_kn": 0.1 * KNOT_MPS,
    "course_rms_deg": np.deg2rad(0.4),
    "latitude_rms_arcmin": 5.0 / RADIAN_M[0],
    "longitude_rms_arcmin": 5.0 / RADIAN_M[1],
}


# White acceleration of each quantity, unit² / s³: one tuning for every step.
ACCELERATION_PSD = {
    "speed_rms_kn": 1.5e-5 * KNOT_MPS**2,
    "course_rms_deg": 6e-4 * np.deg2rad(1.0) ** 2,
    "latitude_rms_arcmin": 0.02 / RADIAN_M[0] ** 2,
    "longitude_rms_arcmin": 0.02 / RADIAN_M[1] ** 2,
}


def _columns(of: Any) -> dict[str, np.ndarray]:
    """Quantities of a voyage, or of its readings, by the metric that judges their forecast."""
    columns = (of.speed_mps, of.course_rad, of.latitude_rad, of.longitude_rad)
    return dict(zip(METRICS, columns, strict=False))


def forecast_errors(metric: str, forecast: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Prediction minus truth (..., T - 4) in the unit of the metric."""
    off = forecast[..., :-AHEAD] - truth[AHEAD:]
    return (wl.wrap_angle(off) if metric == "course_rms_deg" else off) / _UNIT[metric]


def judge(dt_s: float, read: sea.VoyageReadings, name: str) -> dict[str, np.ndarray]:
    """RMS prediction error of each run (R,) of an estimator on a voyage, by metric."""
    truth = sea.reckoning_voyage(dt_s)
    true, readings = _columns(truth), _columns(read)
    if name != "combined":
        smooth = smoothers()[name]
        predicted = {m: smooth(m, dt_s, column).forecast for m, column in readings.items()}
        return {m: rmse(forecast_errors(m, predicted[m], true[m]), axis=-1) for m in predicted}
    latitude, longitude, *rates = combined(dt_s, read)
    drift = nav.velocity_from_rates_mps(*rates, truth.latitude_rad)
    off = drift - nav.velocity_mps(sea.CURRENT_MPS, sea.CURRENT_RAD)
    return {
        m: rmse(forecast_errors(m, ahead, true[m]), axis=-1)
        for m, ahead in zip(METRICS[2:4], (latitude, longitude), strict=True)
    } | {"drift_rms_kn": rmse(np.hypot(off[..., 0], off[..., 1]) / KNOT_MPS, axis=-1)}


def drift_errors(runs: int, seed: int, fixes: int) -> dict[str, np.ndarray]:
    """Errors (R, fixes) in kn of the drift after each fix that follows the first one.

    The ship holds 10 kn and a random course in each run; log and gyro are read once between fixes.
    """
    current = nav.velocity_mps(sea.CURRENT_MPS, sea.CURRENT_RAD)
    line = nav.DriftWindow(
        max_fixes=fixes + 1, log_std_mps=sea.LOG_STD_MPS, heading_std_rad=sea.GYRO_STD_RAD
    )
    found: dict[str, list[np.ndarray]] = {"vector_line": [], "rates": []}
    for run_ in range(runs):
        rng = np.random.default_rng([seed, run_, fixes])
        course = rng.uniform(0.0, 2 * np.pi)
        over_ground = nav.velocity_mps(DRIFT_SPEED_MPS, course) + current
        log = DRIFT_SPEED_MPS + sea.LOG_STD_MPS * rng.standard_normal(fixes + 1)
        gyro = course + sea.GYRO_STD_RAD * rng.standard_normal(fixes + 1)
        fix_m = DRIFT_STEP_S * np.arange(fixes + 1)[:, None] * over_ground
        fix_m = fix_m + sea.FIX_STD_M * rng.standard_normal(fix_m.shape)
        mean, _ = line.run(DRIFT_STEP_S, log, gyro, fix_m, sea.FIX_STD_M)
        found["vector_line"].append(mean[1:] - current)
        found["rates"].append(mean_drift_from_rates(log, gyro, fix_m) - current)
    return {
        name: np.hypot(*np.moveaxis(np.array(off), -1, 0)) / KNOT_MPS for name, off in found.items()
    }


def mean_drift_from_rates(log: np.ndarray, gyro: np.ndarray, fix_m: np.ndarray) -> np.ndarray:
    """(T - 1, 2) m/s: the mean drift from the rates of all fixes until then."""
    rates = np.diff(fix_m, axis=0) / DRIFT_STEP_S
    each = nav.drift_from_rates_mps(rates, log[1:], gyro[1:])
    return np.cumsum(each, axis=0) / np.arange(1, len(fix_m))[:, None]


# The study ----------------------------------------------------------------------------------------

_PAPER = Published(
    METRICS,
    {(case, "adaptive_two_pass"): (0.3, 1.0, _NAN, _NAN, _NAN) for case in STEPS_S}
    | {(case, "combined"): (_NAN, _NAN, 0.03, 0.03, _NAN) for case in STEPS_S},
)
_REFERENCE_KN_DEG = {
    "last_value": ((0.136, 1.09), (0.291, 3.18), (0.88, 10.7)),
    "alpha_beta_w5": ((0.197, 0.59), (0.244, 0.85), (0.81, 5.1)),
    "adaptive_two_pass": ((0.249, 0.79), (0.287, 1.10), (0.76, 4.5)),
    "window_bank": ((0.157, 0.46), (0.217, 0.82), (0.75, 4.2)),
    "kalman": ((0.086, 0.29), (0.209, 0.82), (0.76, 3.9)),
}
_REFERENCE = Published(
    METRICS,
    {
        (case, name): (*figures[k], _NAN, _NAN, _NAN)
        for name, figures in _REFERENCE_KN_DEG.items()
        for k, case in enumerate(STEPS_S)
    }
    | {
        ("forecast_4x3s", "combined"): (_NAN, _NAN, 0.002, 0.003, _NAN),
        ("drift_20", "vector_line"): (_NAN, _NAN, _NAN, _NAN, 0.030),
        ("drift_5", "vector_line"): (_NAN, _NAN, _NAN, _NAN, 0.10),
    },
)


def _plan(request: Request) -> Plan:
    runs, seed = request.runs, request.seed
    jobs: dict[tuple[str, str], Callable[[], dict[str, np.ndarray]]] = {}
    for case, dt_s in STEPS_S.items():
        read = sea.reckoning_voyage(dt_s).read(runs, seed)
        for name in (*smoothers(), "combined"):
            jobs[case, name] = partial(judge, dt_s, read, name)
    for case, fixes in FIXES.items():
        jobs[case, "drift"] = partial(drift_errors, runs, seed, fixes)

    def pictures(done: Done, rows: Rows) -> tuple[Picture, ...]:
        longest = max(FIXES, key=FIXES.__getitem__)
        return _pictures(rows, done[longest, "drift"], seed)

    return Plan(
        jobs=jobs,
        rows=lambda done: _rows(_by_estimator(done)),
        result=_by_estimator,
        pictures=pictures,
        notes=lambda done, rows: [_claim_note(rows)],
    )


STUDY = Study(
    "dead-reckoning",
    "own ship's motion smoothed and predicted, set and drift: the gains (33) beside others",
    _plan,
    published={"paper": _PAPER, "reference": _REFERENCE},
)
run = STUDY.run


def _by_estimator(done: Done) -> dict[tuple[str, str], dict[str, np.ndarray]]:
    """Errors of each run (R,) by scenario and estimator; those of a drift after the last fix."""
    found = {}
    for (case, name), errors in done.items():
        if name == "drift":
            found |= {(case, one): {"drift_rms_kn": off[:, -1]} for one, off in errors.items()}
        else:
            found[case, name] = errors
    return found


def _rows(done: Mapping[tuple[str, str], dict[str, np.ndarray]]) -> Rows:
    return [
        {"scenario": case, "estimator": name}
        | {m: float(rmse(of_runs[m])) if m in of_runs else None for m in METRICS}
        for (case, name), of_runs in done.items()
    ]


def _claim_note(rows: Rows) -> str:
    """Test of the claim that the gains (33) are the best."""
    figure = {(r["scenario"], r["estimator"]): r for r in rows}
    lines = [
        'The claim "(33) is best of all": the errors of (33) in two passes four readings ahead,',
        "divided by those of the line through five readings, and by the least:",
    ]
    for case, dt_s in STEPS_S.items():
        parts = []
        for metric in METRICS[:2]:
            ours, line = (figure[case, n][metric] for n in ("adaptive_two_pass", "alpha_beta_w5"))
            best = min(smoothers(), key=lambda name: figure[case, name][metric])
            quantity = metric.split("_")[0]
            parts.append(
                f"{quantity} {ours / line:.2f}, {ours / figure[case, best][metric]:.2f} ({best})"
            )
        lines.append(f"  every {dt_s:.0f} s: {'; '.join(parts)}")
    lines += [
        "It is better than the line only where maneuvers, not noise, dominate the error: at 10 s.",
        "As printed, in one pass, its gains never adapt. The paper gives no step; its 0.3 kn, 1.0",
        "degrees and 0.03' are beside every one.",
    ]
    return "\n".join(lines)


# Pictures -----------------------------------------------------------------------------------------


class _Shown(NamedTuple):
    """How a quantity is drawn: metric, name, unit, and part of the voyage."""

    metric: str
    name: str
    unit: str
    part_s: tuple[float, float]


_QUANTITIES = {
    "reckoning-speed": _Shown("speed_rms_kn", "speed", "kn", (360.0, 660.0)),
    "reckoning-course": _Shown("course_rms_deg", "course", "°", (660.0, 960.0)),
    "reckoning-latitude": _Shown("latitude_rms_arcmin", "latitude", "′", (180.0, 300.0)),
    "reckoning-longitude": _Shown("longitude_rms_arcmin", "longitude", "′", (180.0, 300.0)),
}


def _pictures(rows: Rows, drifts: Mapping[str, np.ndarray], seed: int) -> tuple[Picture, ...]:
    quantities = (
        Picture(
            name,
            f"{shown.name.capitalize()}: smoothed, and predicted 12 s ahead (reading every 3 s)",
            (
                partial(_draw_smoothed, shown=shown, seed=seed),
                partial(_draw_predicted, shown=shown, seed=seed),
            ),
            size_in=(8.4, 6.4),
        )
        for name, shown in _QUANTITIES.items()
    )
    return (
        Picture(
            "reckoning-wind-current",
            "Wind current (14) against latitude",
            (_draw_wind_current,),
            size_in=(7.2, 4.6),
        ),
        *quantities,
        Picture(
            "reckoning-rates",
            "Rates of change, from a reading every 3 s",
            tuple(partial(_draw_rate, shown=shown, seed=seed) for shown in _QUANTITIES.values()),
            size_in=(11.0, 6.8),
            columns=2,
            shared=False,
        ),
        Picture(
            "reckoning-forecast",
            "RMS error of the forecast four readings ahead",
            tuple(partial(_draw_ranking, rows=rows, metric=metric) for metric in METRICS[:4]),
            size_in=(11.0, 6.8),
            columns=2,
            shared=False,
        ),
        Picture(
            "reckoning-drift",
            "Drift vector estimated on a steady course, a fix of 4 m every 30 s",
            (partial(_draw_drift, drifts=drifts),),
            size_in=(7.2, 4.2),
        ),
    )


def _draw_wind_current(ax: Axes) -> Axes:
    """Fig. 1 of the paper, with the graph of the search manual."""
    latitude_deg = np.linspace(20.0, 90.0, 141)
    for wind_mps, color in zip((30.0, 20.0, 10.0), plot.PALETTE, strict=False):
        current = nav.wind_current_mps([wind_mps, 0.0], np.deg2rad(latitude_deg))
        speed_kn = nav.speed_course(current)[0] / KNOT_MPS
        ax.plot(
            latitude_deg, speed_kn, color=color, linewidth=1.6, label=f"wind {wind_mps:.0f} m/s"
        )
    quoted = {"x": [20, 90, 20, 90], "y": [0.44, 0.26, 0.88, 0.52]}
    ax.plot(*quoted.values(), "x", color=plot.INK, markersize=6, label="quoted in the paper")
    for wind_kn, current_kn in ((20.0, 0.7), (34.0, 1.25)):
        ax.axhline(current_kn, color=plot.MUTED, linewidth=0.9, linestyle="--")
        ax.plot(55.0, current_kn, "o", color=plot.MUTED, markersize=6)
        ax.text(
            56.0,
            current_kn - 0.06,
            f"search manual: {current_kn:g} kn in a wind of {wind_kn * KNOT_MPS:.1f} m/s",
            fontsize=plot.TEXT_PT,
            color=plot.INK,
        )
    ax.set(xlabel="latitude (°)", ylabel="wind current (kn)", xlim=(18.0, 92.0))
    ax.set_ylim(bottom=0.0)
    plot.dress(ax)
    return plot.name_lines(ax)


class _Drawn(NamedTuple):
    """A quantity of the first voyage in its unit, positions relative to the start."""

    time_s: np.ndarray
    truth: np.ndarray
    readings: np.ndarray
    predicted: Mapping[str, Predicted]


def _drawn(shown: _Shown, seed: int) -> _Drawn:
    voyage = sea.reckoning_voyage(_SHOWN_STEP_S)
    truth = _columns(voyage)[shown.metric]
    readings = _columns(voyage.read(1, seed))[shown.metric][0]
    angle = shown.metric == "course_rms_deg"
    zero = 0.0 if shown.metric in METRICS[:2] else truth[0]

    def in_unit(values: np.ndarray) -> np.ndarray:
        near = truth + wl.wrap_angle(values - truth) if angle else values
        return (near - zero) / _UNIT[shown.metric]

    found = {}
    for name in _SHOWN:
        value, rate, forecast = smoothers()[name](shown.metric, voyage.dt_s, readings)
        ahead = np.full_like(forecast, np.nan)
        ahead[AHEAD:] = forecast[:-AHEAD]
        found[name] = Predicted(in_unit(value), rate / _UNIT[shown.metric], in_unit(ahead))
    return _Drawn(voyage.time_s, in_unit(truth), in_unit(readings), found)


def _within(ax: Axes, drawn: _Drawn, shown: _Shown, *columns: np.ndarray) -> None:
    """Set the window to a part of the voyage and the range of `columns` in it."""
    part = (drawn.time_s >= shown.part_s[0]) & (drawn.time_s <= shown.part_s[1])
    seen = np.concatenate([column[part] for column in columns])
    room = 0.06 * np.ptp(seen)
    ax.set_xlim(shown.part_s)
    ax.set_ylim(seen.min() - room, seen.max() + room)


def _draw_smoothed(ax: Axes, shown: _Shown, seed: int) -> Axes:
    drawn = _drawn(shown, seed)
    ax.plot(drawn.time_s, drawn.readings, ".", color=plot.MUTED, markersize=4, label="readings")
    ax.plot(drawn.time_s, drawn.truth, color=plot.INK, linewidth=1.0, linestyle="--", label="truth")
    for name, color in _SHOWN.items():
        value = drawn.predicted[name].value
        ax.plot(drawn.time_s, value, color=plot.PALETTE[color], linewidth=1.3, label=name)
    _within(ax, drawn, shown, drawn.truth, drawn.readings)
    since = " from the start" if shown.metric in METRICS[2:] else ""
    ax.set(xlabel="time (s)", ylabel=f"{shown.name}{since} ({shown.unit})")
    if shown.metric == "course_rms_deg":
        ax.yaxis.set_major_formatter(_compass)  # through north without a jump
    plot.dress(ax)
    return plot.name_lines(ax)


def _compass(course_deg: float, _tick: int) -> str:
    return f"{course_deg % 360.0:g}"


def _draw_predicted(ax: Axes, shown: _Shown, seed: int) -> Axes:
    drawn = _drawn(shown, seed)
    ax.axhline(0.0, color=plot.INK, linewidth=0.8)
    off = {name: found.forecast - drawn.truth for name, found in drawn.predicted.items()}
    for name, color in _SHOWN.items():
        ax.plot(drawn.time_s, off[name], color=plot.PALETTE[color], linewidth=1.3, label=name)
    _within(ax, drawn, shown, *off.values())
    ax.set(xlabel="time (s)", ylabel=f"prediction - truth ({shown.unit})")
    return plot.dress(ax)


def _draw_rate(ax: Axes, shown: _Shown, seed: int) -> Axes:
    drawn = _drawn(shown, seed)
    rate = np.gradient(drawn.truth, drawn.time_s)
    for name, color in _SHOWN.items():
        found = 60.0 * drawn.predicted[name].rate
        ax.plot(drawn.time_s, found, color=plot.PALETTE[color], linewidth=1.2, label=name)
    line = {"color": plot.INK, "linewidth": 1.0, "linestyle": "--", "label": "truth"}
    ax.plot(drawn.time_s, 60.0 * rate, **line)
    rates = (60.0 * found.rate for found in drawn.predicted.values())
    _within(ax, drawn, shown, 60.0 * rate, *rates)
    ax.set(xlabel="time (s)", ylabel=f"rate of {shown.name} ({shown.unit}/min)")
    plot.dress(ax)
    return plot.name_lines(ax) if shown.metric == METRICS[0] else ax


def _draw_ranking(ax: Axes, rows: Rows, metric: str) -> Axes:
    figures = curves.figures(rows, metric)
    names = list(smoothers()) + ([] if metric in METRICS[:2] else ["combined"])
    values = {
        f"every {dt_s:.0f} s": [figures[case, name] for name in names]
        for case, dt_s in STEPS_S.items()
    }
    quantity, _, unit = metric.split("_")
    unit = {"deg": "°", "arcmin": "′"}.get(unit, unit)
    ax = plot.ranking_panel(
        ax, names, values, xlabel=f"{quantity} ({unit})", best_first="every 3 s", log=True
    )
    if metric in METRICS[2:]:
        ax.set_xticks([0.0003, 0.001, 0.003, 0.01, 0.03, 0.1])
    if metric != METRICS[0] and ax.get_legend() is not None:
        ax.get_legend().remove()
    return ax


def _draw_drift(ax: Axes, drifts: Mapping[str, np.ndarray]) -> Axes:
    for (name, off), color in zip(drifts.items(), plot.PALETTE, strict=False):
        rms_kn = rmse(off, axis=0)
        fixes = np.arange(1, len(rms_kn) + 1)
        ax.plot(fixes, rms_kn, color=color, linewidth=1.4, marker="o", markersize=4, label=name)
    ax.plot([5, 20], [0.10, 0.03], "x", color=plot.INK, markersize=7, label="reference")
    ax.set(
        xlabel="fixes after the first", ylabel="RMS error of the drift vector (kn)", yscale="log"
    )
    ticks = [0.03, 0.05, 0.1, 0.2, 0.5]
    ax.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.set_yticks([], minor=True)
    ax.set_xticks(range(0, 21, 5))
    plot.dress(ax)
    return plot.name_lines(ax)
