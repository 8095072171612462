"""Truth as a function of time: a vessel that runs through segments of constant turn and thrust."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

_SERIES_BELOW_RAD = 0.3


@dataclass(frozen=True)
class Segment:
    """A stretch of constant turn rate and constant acceleration along the course.

    Attributes
    ----------
    duration_s : float
        Positive.
    turn_rate_rad_s : float
        Positive to starboard.
    acceleration_mps2 : float
        Change of speed per second.

    Raises
    ------
    ValueError
        When a value is not finite or the duration is not positive.
    """

    duration_s: float
    turn_rate_rad_s: float = 0.0
    acceleration_mps2: float = 0.0

    def __post_init__(self) -> None:
        values = (self.duration_s, self.turn_rate_rad_s, self.acceleration_mps2)
        if not np.isfinite(values).all():
            raise ValueError(f"a segment must be finite, got {self}")
        if self.duration_s <= 0:
            raise ValueError(f"duration_s must be positive, got {self.duration_s}")


class Truth:
    """Where a vessel truly is, in closed form at any time.

    Within a segment the speed is ``v(s) = v + a s``, the course ``c(s) = c + w s``, and the way
    made is the integral of ``v(s) [cos c(s), sin c(s)]``, north and east, taken exactly. Before the
    first and after the last segment the vessel goes straight on at constant speed.

    Parameters
    ----------
    start : array_like (4,)
        State ``[north, vnorth, east, veast]`` at the beginning, metres and metres per second.
    segments : sequence of Segment
        In the order in which they are run through; none is a straight line.
    start_time_s : float
        Time of the beginning.
    start_course_rad : float, optional
        Course at the beginning of a vessel that starts at rest; default that of the velocity.

    Raises
    ------
    ValueError
        When the start is not four finite numbers or a segment brings the speed below zero.
    """

    def __init__(
        self,
        start: Sequence[float],
        segments: Sequence[Segment] = (),
        *,
        start_time_s: float = 0.0,
        start_course_rad: float | None = None,
    ) -> None:
        start = np.asarray(start, dtype=float)
        if start.shape != (4,) or not np.isfinite(start).all():
            raise ValueError(f"start must be 4 finite numbers, got {start.tolist()}")
        north_m, vnorth_mps, east_m, veast_mps = start
        self._start_m = np.array([north_m, east_m])
        speed_mps = float(np.hypot(vnorth_mps, veast_mps))
        course_rad = float(np.arctan2(veast_mps, vnorth_mps))
        self.segments = tuple(segments)
        self.start_time_s = float(start_time_s)
        self._lay_legs(speed_mps, course_rad if start_course_rad is None else start_course_rad)

    @property
    def end_time_s(self) -> float:
        """Time at which the last segment ends."""
        return float(self._time_s[-1])

    def state_at(self, time_s: np.ndarray | float) -> np.ndarray:
        """States ``[north, vnorth, east, veast]`` at the given times.

        Parameters
        ----------
        time_s : array_like (T,) or float
            Any times, in any order.

        Returns
        -------
        ndarray (T, 4)
            One row for a single time.
        """
        time_s = np.atleast_1d(np.asarray(time_s, dtype=float))
        leg = np.searchsorted(self._time_s, time_s, side="right")
        since_s = time_s - self._time_s[np.maximum(leg - 1, 0)]
        way_m = self._way(leg, since_s)
        speed_mps = self._speed_mps[leg] + self._acceleration_mps2[leg] * since_s
        course_rad = self._course_rad[leg] + self._turn_rate_rad_s[leg] * since_s
        return np.column_stack(
            [
                self._north_m[leg] + way_m.real,
                speed_mps * np.cos(course_rad),
                self._east_m[leg] + way_m.imag,
                speed_mps * np.sin(course_rad),
            ]
        )

    def turn_rate_at(self, time_s: np.ndarray | float) -> np.ndarray:
        """Turn rates (T,) in radians per second; at a change that of the segment that begins."""
        time_s = np.atleast_1d(np.asarray(time_s, dtype=float))
        return self._turn_rate_rad_s[np.searchsorted(self._time_s, time_s, side="right")]

    def _lay_legs(self, speed_mps: float, course_rad: float) -> None:
        """Legs are the straight run before the start, the segments, the straight run after them.

        Leg k begins at time k - 1 of `_time_s`; the leg before the start is told from there, too.
        """
        duration_s = [segment.duration_s for segment in self.segments]
        self._time_s = self.start_time_s + np.concatenate([[0.0], np.cumsum(duration_s)])
        self._turn_rate_rad_s = np.array([0.0, *(s.turn_rate_rad_s for s in self.segments), 0.0])
        self._acceleration_mps2 = np.array(
            [0.0, *(s.acceleration_mps2 for s in self.segments), 0.0]
        )
        gained_mps = self._acceleration_mps2[1:-1] * duration_s
        turned_rad = self._turn_rate_rad_s[1:-1] * duration_s
        self._speed_mps = speed_mps + np.concatenate([[0.0, 0.0], np.cumsum(gained_mps)])
        self._course_rad = course_rad + np.concatenate([[0.0, 0.0], np.cumsum(turned_rad)])
        slow = np.flatnonzero(self._speed_mps < -1e-9 * max(speed_mps, 1.0))
        if len(slow):
            raise ValueError(f"segment {slow[0] - 2} brings the speed below zero")
        legs = np.arange(1, len(self.segments) + 1)
        way_m = np.concatenate([[0.0, 0.0], np.cumsum(self._way(legs, np.array(duration_s)))])
        self._north_m = self._start_m[0] + way_m.real
        self._east_m = self._start_m[1] + way_m.imag

    def _way(self, leg: np.ndarray, since_s: np.ndarray) -> np.ndarray:
        """Way made on each leg (T,) since it began, as north + i east in metres.

        With ``h = w t / 2`` and the course ``m`` half way, the integral is
        ``t e^(i m) [(v + a t / 2) sin(h) / h + i (a t / 2) (sin(h) - h cos(h)) / h^2]``.
        """
        half_turn_rad = 0.5 * self._turn_rate_rad_s[leg] * since_s
        half_gain_mps = 0.5 * self._acceleration_mps2[leg] * since_s
        mean_speed_mps = self._speed_mps[leg] + half_gain_mps
        ahead = mean_speed_mps * np.sinc(half_turn_rad / np.pi)
        aside = half_gain_mps * _bow(half_turn_rad)
        mid_course_rad = self._course_rad[leg] + half_turn_rad
        return since_s * np.exp(1j * mid_course_rad) * (ahead + 1j * aside)


def _bow(h: np.ndarray) -> np.ndarray:
    """``(sin(h) - h cos(h)) / h^2``, by its series where the difference would lose digits."""
    square = h * h
    series = h / 3 * (1 - square / 10 * (1 - square / 28 * (1 - square / 54 * (1 - square / 88))))
    far = np.where(np.abs(h) < _SERIES_BELOW_RAD, 1.0, h)
    return np.where(far == h, (np.sin(far) - far * np.cos(far)) / far**2, series)
