"""Combined dead reckoning (11), as the paper composes it, and ours."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from wakeline import navigation as nav
from wakeline._units import KNOT_MPS
from wakeline.scenario import voyage as sea

from .quantities import AHEAD, columns, radian_m
from .smoothers import smoothers, two_state_kalman

Places = tuple[np.ndarray, np.ndarray]
"""Latitudes and longitudes, each (R, T)."""

MEAN_OF = 15  # readings that a drift is averaged over: the paper's longest window
PAPER = ("combined_printed", "combined_mid_interval", "combined_mean_drift", "combined_both")
_DRIFT_STD_MPS = 1.5 * KNOT_MPS  # before anything is known
_DRIFT_PSD_M2S3 = 1e-9


def combined(
    dt_s: float, read: sea.VoyageReadings
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Ours, four readings ahead.

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
    speed_mps = 10.0 * KNOT_MPS
    walk_m = dt_s * np.hypot(sea.LOG_STD_MPS, speed_mps * sea.GYRO_STD_RAD) / np.sqrt(2.0)
    noise_m2 = np.diag([walk_m**2, dt_s * _DRIFT_PSD_M2S3])
    now, drift = [], []
    for observed, reckoned, per_radian_m in zip(fix, place, radian_m(), strict=True):
        off, slope = two_state_kalman(
            dt_s,
            observed - reckoned,
            sea.FIX_STD_M / per_radian_m,
            noise_m2 / per_radian_m**2,
            _DRIFT_STD_MPS / per_radian_m,
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


def paper_combined(dt_s: float, read: sea.VoyageReadings) -> dict[str, Places]:
    """The paper's, four readings ahead: (5), (11), (18)-(20), (26), (33).

    Speed, course, latitude and longitude are smoothed by (26) with the gains (33). The drift
    (18)-(20) is the velocity over ground, (8) with the mid-latitude of (11), minus that through the
    water. ``combined_printed`` continues with the speed, course and drift of the instant,
    ``combined_mid_interval`` with speed and course predicted by (5) for half way,
    ``combined_mean_drift`` with the mean drift of the last 15 readings, ``combined_both`` with
    both. ``first_order`` is (6) with the same smoothed latitude and longitude.
    """
    ahead_s = AHEAD * dt_s
    smooth = smoothers()["adaptive_two_pass"]
    speed, course, latitude, longitude = (
        smooth(metric, dt_s, readings) for metric, readings in columns(read).items()
    )
    middle = latitude.value + 0.5 * ahead_s * latitude.rate
    over_ground = nav.velocity_from_rates_mps(latitude.rate, longitude.rate, middle)
    drift = nav.drift_from_rates_mps(over_ground, speed.value, course.value)
    mean_drift = _mean_of_last(drift, MEAN_OF)
    now = speed.value, course.value
    half_way = tuple(one.value + 0.5 * ahead_s * one.rate for one in (speed, course))

    def reckon(ship: Places, drift_mps: np.ndarray) -> Places:
        """(11)."""
        set_and_drift = nav.speed_course(drift_mps)
        return nav.dead_reckon(latitude.value, longitude.value, *ship, ahead_s, *set_and_drift)

    composed = (
        reckon(now, drift),
        reckon(half_way, drift),
        reckon(now, mean_drift),
        reckon(half_way, mean_drift),
    )
    first_order = {"first_order": (latitude.forecast, longitude.forecast)}
    return dict(zip(PAPER, composed, strict=True)) | first_order


def difference_arcmin(found: Mapping[str, Places]) -> float:
    """Largest difference between (11) as printed and (6), of `paper_combined`."""
    pairs = zip(found["combined_printed"], found["first_order"], strict=True)
    return 60.0 * float(np.degrees(max(np.abs(a - b).max() for a, b in pairs)))


def _mean_of_last(values: np.ndarray, count: int) -> np.ndarray:
    """Mean (R, T, 2) of each row of values (R, T, 2) and those before it, at most `count`."""
    sums = np.cumsum(values, axis=-2)
    before = np.zeros_like(sums)
    before[..., count:, :] = sums[..., :-count, :]
    size = np.minimum(np.arange(1, values.shape[-2] + 1), count)
    return (sums - before) / size[:, np.newaxis]
