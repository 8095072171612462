"""A vessel that alters speed and course in a current, with log, gyro and fixes.

Speed follows its orders with a lag of 60 s, course with a turn rate of at most 0.4 deg/s that
builds up in 10 s; the current sets to 060 at 1.2 kn.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from wakeline import navigation as nav
from wakeline._brief import brief, many, span
from wakeline._checks import plain_numbers, whole_number
from wakeline._units import KNOT_MPS

START_RAD = np.deg2rad([46.5, 30.8])
END_S = 2400.0
SPEED_ORDERS_KN = {0: 12.0, 400: 6.0, 900: 0.5, 1300: 10.0}  # by the second they are given in
COURSE_ORDERS_DEG = {0: 330.0, 200: 420.0, 700: 300.0, 1500: 380.0, 2000: 250.0}
SPEED_LAG_S, TURN_LAG_S, COURSE_LAG_S, MOST_TURN_DEG_S = 60.0, 10.0, 20.0, 0.4
CURRENT_MPS, CURRENT_RAD = 1.2 * KNOT_MPS, np.deg2rad(60.0)
LOG_STD_MPS, GYRO_STD_RAD, FIX_STD_M = 0.1 * KNOT_MPS, np.deg2rad(0.3), 4.0

_FINE_S = 0.1


class VoyageReadings(NamedTuple):
    """Readings of the instruments, each (R, T): log m/s, gyro 0 .. 2 pi rad, fix rad."""

    speed_mps: np.ndarray
    course_rad: np.ndarray
    latitude_rad: np.ndarray
    longitude_rad: np.ndarray

    def __repr__(self) -> str:
        runs, times = np.atleast_2d(self.speed_mps).shape
        return brief(self, many(runs, "run"), many(times, "reading"))


@dataclass(frozen=True)
class Voyage:
    """The truth (T,) every `dt_s`: speed and unwrapped course through the water.

    Attributes
    ----------
    dt_s : float
    time_s, speed_mps, course_rad, latitude_rad, longitude_rad : (T,) array
    """

    dt_s: float
    time_s: np.ndarray
    speed_mps: np.ndarray
    course_rad: np.ndarray
    latitude_rad: np.ndarray
    longitude_rad: np.ndarray

    def __repr__(self) -> str:
        return brief(self, many(len(self.time_s), "state"), span(self.time_s))

    def read(self, runs: int, seed: int = 0) -> VoyageReadings:
        """Readings of independent runs: log 0.1 kn, gyro 0.3 degrees, fixes 4 m per axis.

        Parameters
        ----------
        runs, seed : int
            Run r of a seed does not depend on the number of runs.
        """
        whole_number("runs", runs, least=1)
        whole_number("seed", seed, least=0)
        noise = np.empty((4, runs, len(self.time_s)))
        for run in range(runs):
            rng = np.random.default_rng([seed, run])
            noise[:, run] = rng.standard_normal((4, len(self.time_s)))
        radian_m = nav.velocity_from_rates_mps(1.0, 1.0, self.latitude_rad)
        return VoyageReadings(
            self.speed_mps + LOG_STD_MPS * noise[0],
            (self.course_rad + GYRO_STD_RAD * noise[1]) % (2 * np.pi),
            self.latitude_rad + FIX_STD_M * noise[2] / radian_m[..., 0],
            self.longitude_rad + FIX_STD_M * noise[3] / radian_m[..., 1],
        )


def reckoning_voyage(dt_s: float) -> Voyage:
    """The voyage of 40 minutes, sampled every `dt_s`.

    Raises
    ------
    ValueError
        When `dt_s` is not a positive multiple of 0.1 s, at most 600 s.
    """
    plain_numbers(dt_s=dt_s)
    each = round(dt_s / _FINE_S) if 0.0 < dt_s <= 600.0 else 0
    if each < 1 or abs(each * _FINE_S - dt_s) > 1e-9:
        raise ValueError(f"dt_s must be a multiple of 0.1 s up to 600 s, got {dt_s}")
    return Voyage(float(dt_s), *(column[::each] for column in _truth()))


def reckoned(
    speed_mps: np.ndarray, course_rad: np.ndarray, dt_s: float, drift_mps: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Latitudes and longitudes (..., T) reckoned by log and gyro from the start; (11).

    Parameters
    ----------
    speed_mps, course_rad : (..., T) array
        A step uses the mean of the readings before and after it.
    dt_s : float
    drift_mps : float
        Speed of the current to 060.
    """
    courses = np.unwrap(course_rad, axis=-1)
    speed = 0.5 * (speed_mps[..., 1:] + speed_mps[..., :-1])
    course = 0.5 * (courses[..., 1:] + courses[..., :-1])
    latitude = np.full(speed.shape, START_RAD[0])
    for _ in range(2):  # first with the latitude of the start, then with that of each step
        there, east = nav.dead_reckon(
            latitude, 0.0, speed, course, dt_s, drift_mps, CURRENT_RAD if drift_mps else 0.0
        )
        sums = _from_zero(there - latitude)
        latitude = START_RAD[0] + sums[..., :-1]
    return START_RAD[0] + sums, START_RAD[1] + _from_zero(east)


def _from_zero(steps: np.ndarray) -> np.ndarray:
    sums = np.zeros((*steps.shape[:-1], steps.shape[-1] + 1))
    np.cumsum(steps, axis=-1, out=sums[..., 1:])
    return sums


@lru_cache(maxsize=1)
def _truth() -> tuple[np.ndarray, ...]:
    """Time, speed, course, latitude and longitude every tenth of a second."""
    time_s = np.arange(0.0, END_S + _FINE_S / 2, _FINE_S)
    speed_order = _ordered(time_s, SPEED_ORDERS_KN)
    course_order = _ordered(time_s, COURSE_ORDERS_DEG)
    speed_kn, course_deg, rate = np.empty(len(time_s)), np.empty(len(time_s)), 0.0
    speed_kn[0], course_deg[0] = speed_order[0], course_order[0]
    for k in range(1, len(time_s)):
        before = k - 1
        speed_kn[k] = speed_kn[before] + _FINE_S / SPEED_LAG_S * (speed_order[k] - speed_kn[before])
        wanted = (course_order[k] - course_deg[before]) / COURSE_LAG_S
        wanted = min(max(wanted, -MOST_TURN_DEG_S), MOST_TURN_DEG_S)
        rate += _FINE_S / TURN_LAG_S * (wanted - rate)
        course_deg[k] = course_deg[before] + _FINE_S * rate
    speed, course = KNOT_MPS * speed_kn, np.deg2rad(course_deg)
    columns = (time_s, speed, course, *reckoned(speed, course, _FINE_S, CURRENT_MPS))
    for column in columns:
        column.flags.writeable = False
    return columns


def _ordered(time_s: np.ndarray, orders: dict[int, float]) -> np.ndarray:
    """The order in force at each time."""
    given = np.searchsorted(list(orders), time_s, side="right") - 1
    return np.array(list(orders.values()))[given]
