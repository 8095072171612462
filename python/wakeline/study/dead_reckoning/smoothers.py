"""Smoothers of one quantity at a time: those of the paper, and those beside which they are judged.

A smoother takes the metric of a quantity, the step and its readings (..., T), and returns
:class:`Predicted`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

import wakeline as wl
from wakeline import filter as wf
from wakeline._units import KNOT_MPS
from wakeline.scenario import voyage as sea

from .quantities import AHEAD, Predicted, is_angle, radian_m

WINDOW = 5
Smoother = Callable[[str, float, np.ndarray], Predicted]


def smoothers() -> dict[str, Smoother]:
    """The estimators that are compared with the gains (33)."""
    return {
        "last_value": _last_value,
        "alpha_beta_w5": _in_windows(wf.GrowingMemory()),
        "adaptive_two_pass": _engine(lambda wrapped: wf.AdaptiveAlphaBeta(wrapped=wrapped)),
        "adaptive_one_pass": lambda metric, dt_s, readings: one_pass(metric, dt_s, readings)[0],
        "window_bank": _engine(lambda wrapped: wf.WindowBank(wrapped=wrapped)),
        "kalman": _kalman,
    }


def schedules() -> dict[str, Smoother]:
    """(26) with the fixed gains (28)-(30) beside (27), ``alpha_beta_w5``.

    ``w5``: restarted in each window of five readings. ``growing``: from the first reading on, as
    printed. (30) is that of an object within 20 km of the radar.
    """
    near = wf.RangeDependent().gains(range_m=0.0)
    return {
        "gains_28_w5": _in_windows(wf.GrowingMemory(plots_before=1)),
        "gains_29_w5": _in_windows(wf.RecentMemory()),
        "gains_30": _schedule(wf.ConstantGains(*near)),
        "gains_27_growing": _schedule(wf.GrowingMemory()),
        "gains_28_growing": _schedule(wf.GrowingMemory(plots_before=1)),
        "gains_29_growing": _schedule(wf.RecentMemory()),
    }


def series() -> dict[str, Smoother]:
    """The smoothers without a rate, (21), (23), and those of three points, (22), (24), (25)."""
    return {
        "exponential": _engine(lambda wrapped: wf.ExponentialSmoother(wrapped=wrapped)),
        "adaptive_exponential": _engine(
            lambda wrapped: wf.AdaptiveExponentialSmoother(wrapped=wrapped)
        ),
        "three_point": _engine(lambda wrapped: wf.ThreePointSmoother(wrapped=wrapped)),
        "adaptive_three_point": _engine(
            lambda wrapped: wf.ThreePointSmoother(adaptive=True, wrapped=wrapped)
        ),
    }


def every() -> dict[str, Smoother]:
    """All of them."""
    return smoothers() | schedules() | series()


def _engine(make: Callable[[bool], Any]) -> Smoother:
    def smooth(metric: str, dt_s: float, readings: np.ndarray) -> Predicted:
        return Predicted(*make(is_angle(metric)).run(dt_s, readings, ahead_s=AHEAD * dt_s))

    return smooth


def _schedule(gains: Any) -> Smoother:
    return _engine(lambda wrapped: wf.AlphaBetaSmoother(gains, wrapped=wrapped))


def _in_windows(gains: Any) -> Smoother:
    """(26), restarted in each window of the last five readings."""
    smooth = _schedule(gains)

    def restarted(metric: str, dt_s: float, readings: np.ndarray) -> Predicted:
        first = smooth(metric, dt_s, readings[..., : WINDOW - 1])
        later = smooth(metric, dt_s, sliding_window_view(readings, WINDOW, axis=-1))
        joined = (
            np.concatenate([begun, full[..., -1]], axis=-1)
            for begun, full in zip(first, later, strict=True)
        )
        return Predicted(*joined)

    return restarted


def _last_value(metric: str, dt_s: float, readings: np.ndarray) -> Predicted:
    return Predicted(readings, np.zeros_like(readings), readings)


def line_forecast(metric: str, readings: np.ndarray, window: int) -> np.ndarray:
    """Forecast (..., T) by the line through the last `window` readings, at first NaN.

    At even steps it is a fixed weighted mean of them.
    """
    if is_angle(metric):
        readings = np.unwrap(readings, axis=-1)
    age = np.arange(window)[::-1]  # steps back
    off = age - age.mean()
    weights = 1.0 / window - off * (AHEAD + age.mean()) / (off @ off)
    forecast = np.full_like(readings, np.nan)
    forecast[..., window - 1 :] = sliding_window_view(readings, window, axis=-1) @ weights
    return forecast


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
    wrap = wl.wrap_angle if is_angle(metric) else np.asarray
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


# The Kalman filter --------------------------------------------------------------------------------

READING_STD = {
    "speed_rms_kn": sea.LOG_STD_MPS,
    "course_rms_deg": sea.GYRO_STD_RAD,
    "latitude_rms_arcmin": sea.FIX_STD_M / radian_m()[0],
    "longitude_rms_arcmin": sea.FIX_STD_M / radian_m()[1],
}
RATE_STD = {
    "speed_rms_kn": 0.1 * KNOT_MPS,
    "course_rms_deg": np.deg2rad(0.4),
    "latitude_rms_arcmin": 5.0 / radian_m()[0],
    "longitude_rms_arcmin": 5.0 / radian_m()[1],
}
# White acceleration of each quantity, unit² / s³: one tuning for every step.
ACCELERATION_PSD = {
    "speed_rms_kn": 1.5e-5 * KNOT_MPS**2,
    "course_rms_deg": 6e-4 * np.deg2rad(1.0) ** 2,
    "latitude_rms_arcmin": 0.02 / radian_m()[0] ** 2,
    "longitude_rms_arcmin": 0.02 / radian_m()[1] ** 2,
}


def _kalman(metric: str, dt_s: float, readings: np.ndarray) -> Predicted:
    """Value and rate, driven by white acceleration."""
    psd = ACCELERATION_PSD[metric]
    noise = psd * np.array([[dt_s**3 / 3, dt_s**2 / 2], [dt_s**2 / 2, dt_s]])
    if is_angle(metric):
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
