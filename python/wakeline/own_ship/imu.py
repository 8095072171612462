"""Readings of an IMU on the steps of a solution."""

from __future__ import annotations

import numpy as np

from wakeline.recording.nmea import ImuReadings

SHORTEST_STEP_S = 0.1
_LONGEST_STEP_S = 1.5  # that a reading is the mean of


def averaged(readings: ImuReadings) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) and means (n, 3) over steps of at least 0.1 s, in which a vessel hardly turns."""
    columns = (readings.forward_mps2, readings.starboard_mps2, readings.yaw_rate_rad_s)
    imu, time_s = np.column_stack(columns), readings.time_s
    if len(time_s) == 0:
        return time_s, imu
    slot = np.ceil((time_s - time_s[0]) / SHORTEST_STEP_S - 1e-6)
    last = np.flatnonzero(np.append(np.diff(slot) > 0, True))
    first = np.append(0, last[:-1] + 1)
    count = last + 1 - first
    return time_s[last], np.add.reduceat(imu, first) / count[:, None]


def of_steps(time_s: np.ndarray, imu_s: np.ndarray, imu: np.ndarray) -> np.ndarray:
    """Readings (T, 3) of the steps that end at times (T,): each the first one not before its end.

    NaN where that is later by more than a reading lasts, and where there is none.
    """
    if len(imu_s) == 0:
        return np.full((len(time_s), 3), np.nan)
    k = np.minimum(np.searchsorted(imu_s, time_s), len(imu_s) - 1)
    waits_s = imu_s[k] - time_s
    usual_s = np.median(np.diff(imu_s)) if len(imu_s) > 1 else 0.0
    known = (waits_s >= 0) & (waits_s < max(3 * usual_s, SHORTEST_STEP_S))
    return np.where(known[:, None] & (waits_s < _LONGEST_STEP_S)[:, None], imu[k], np.nan)
