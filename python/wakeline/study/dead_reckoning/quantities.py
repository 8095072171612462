"""The quantities of a voyage and the metrics that judge their prediction."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

import wakeline as wl
from wakeline import navigation as nav
from wakeline._units import KNOT_MPS
from wakeline.scenario import voyage as sea

AHEAD = 4  # readings
METRICS = (
    "speed_rms_kn",
    "course_rms_deg",
    "latitude_rms_arcmin",
    "longitude_rms_arcmin",
    "drift_rms_kn",
)
PLACE = METRICS[2:4]
ARCMIN = np.deg2rad(1.0 / 60.0)
UNIT = dict(zip(METRICS, (KNOT_MPS, np.deg2rad(1.0), ARCMIN, ARCMIN, KNOT_MPS), strict=True))


class Predicted(NamedTuple):
    """A quantity after each reading, its rate per second, and the forecast; each (..., T)."""

    value: np.ndarray
    rate: np.ndarray
    forecast: np.ndarray


def radian_m() -> np.ndarray:
    """Metres per radian of latitude and of longitude at the start of the voyage."""
    return nav.velocity_from_rates_mps(1.0, 1.0, sea.START_RAD[0])


def columns(of: Any) -> dict[str, np.ndarray]:
    """Quantities of a voyage, or of its readings, by the metric that judges their forecast."""
    found = (of.speed_mps, of.course_rad, of.latitude_rad, of.longitude_rad)
    return dict(zip(METRICS, found, strict=False))


def is_angle(metric: str) -> bool:
    """Whether the quantity goes through north."""
    return metric == "course_rms_deg"


def forecast_errors(metric: str, forecast: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Prediction minus truth (..., T - 4) in the unit of the metric."""
    off = forecast[..., :-AHEAD] - truth[AHEAD:]
    return (wl.wrap_angle(off) if is_angle(metric) else off) / UNIT[metric]


# Phases of the voyage -----------------------------------------------------------------------------

NEAR_ZERO_MPS = 1.0 * KNOT_MPS
STEADY_TURN_RAD_S, STEADY_MPS2 = np.deg2rad(0.05), 0.3 * KNOT_MPS / 60.0


def phases(truth: sea.Voyage) -> dict[str, np.ndarray]:
    """Masks (T - 4,) of the predictions by phase: all, near zero speed, steady, in a maneuver.

    Near zero the ship makes at most 1 kn until the end of the prediction. It is steady if until
    then it turns by less than 0.05 degrees a second and changes its speed by less than 0.3 kn a
    minute, else in a maneuver.
    """
    turn = np.gradient(truth.course_rad, truth.dt_s)
    change = np.gradient(truth.speed_mps, truth.dt_s)
    moves = (np.abs(turn) > STEADY_TURN_RAD_S) | (np.abs(change) > STEADY_MPS2)
    maneuver, fast = (
        sliding_window_view(mask, AHEAD + 1).any(axis=-1)
        for mask in (moves, truth.speed_mps > NEAR_ZERO_MPS)
    )
    return {
        "forecast": np.ones_like(maneuver),
        "near_zero": ~fast,
        "steady": ~maneuver,
        "maneuver": maneuver,
    }
