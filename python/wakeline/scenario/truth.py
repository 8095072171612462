"""Truth as a function of time: segments of constant turn rate and thrust."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from wakeline._brief import brief, many, span
from wakeline._checks import (
    at_least,
    finite,
    in_a_row,
    listed,
    plain_numbers,
    positive,
    real_numbers,
)

_SERIES_BELOW_RAD = 0.3
_SAME_COURSE_RAD = 1e-9


@dataclass(frozen=True)
class Segment:
    """A segment of constant turn rate, thrust and accelerations north and east.

    Attributes
    ----------
    duration_s : float
        Positive.
    turn_rate_rad_s : float
        Positive to starboard.
    acceleration_mps2 : float
        Thrust: acceleration along the course.
    control_mps2 : (float, float)
        A known acceleration north and east in addition to turn and thrust: the ``u`` of the papers.
    disturbance_mps2 : (float, float)
        An unknown acceleration north and east: the ``w`` of the papers. It acts as `control_mps2`
        does, but is not part of :meth:`Truth.control_at`. With it, braking ends when the segment's
        initial speed is used up.

    Raises
    ------
    ValueError
        When a value is not finite, the duration is not positive or an acceleration is not a pair.
    """

    duration_s: float
    turn_rate_rad_s: float = 0.0
    acceleration_mps2: float = 0.0
    control_mps2: tuple[float, float] = (0.0, 0.0)
    disturbance_mps2: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        for name in ("control_mps2", "disturbance_mps2"):
            pair = tuple(real_numbers(name, getattr(self, name)).ravel().tolist())
            if len(pair) != 2:
                raise ValueError(f"{name} must be two numbers, north and east, got {pair}")
            object.__setattr__(self, name, pair)
        names = ("duration_s", "turn_rate_rad_s", "acceleration_mps2")
        values = {name: getattr(self, name) for name in names}
        plain_numbers(**values)
        if not np.isfinite([*values.values(), *self.control_mps2, *self.disturbance_mps2]).all():
            raise ValueError(f"a segment must be finite, got {self}")
        positive(duration_s=self.duration_s)

    @property
    def push_mps2(self) -> complex:
        """Sum of the accelerations north and east, as north + i east."""
        return complex(*self.control_mps2) + complex(*self.disturbance_mps2)


def segments_from_table(
    rows: Sequence[Sequence[float]], *, max_turn_rate_rad_s: float | None = None
) -> tuple[Segment, ...]:
    """Segments from rows of start time, end time and turn rate.

    Parameters
    ----------
    rows : sequence of (begin_s, end_s, turn_rate_rad_s)
        In order; each begins where the previous one ends.
    max_turn_rate_rad_s : float, optional
        Largest turn rate allowed, either side.

    Returns
    -------
    tuple of Segment

    Raises
    ------
    ValueError
        When a row is not three finite numbers, ends before it begins, overlaps the previous row,
        leaves a gap or turns too fast (the message names the row, counted from 0); when there is
        no row or the largest turn rate is negative.
    TypeError
        When the rows are not a sequence.
    """
    if max_turn_rate_rad_s is not None:
        at_least(0, max_turn_rate_rad_s=max_turn_rate_rad_s)
    rows = listed("rows", rows, "(begin_s, end_s, turn_rate_rad_s)")
    if not rows:
        raise ValueError("rows must have at least one row, got none")
    segments = []
    last_end_s = None
    for k, row in enumerate(rows):
        begin_s, end_s, rate_rad_s = _three_numbers(k, row)
        if end_s <= begin_s:
            raise ValueError(f"row {k} must end after it begins at {begin_s} s, got {end_s} s")
        if last_end_s is not None and begin_s != last_end_s:
            fault = "overlaps with" if begin_s < last_end_s else "leaves a gap after"
            raise ValueError(
                f"row {k} begins at {begin_s} s and {fault} row {k - 1}, which ends at "
                f"{last_end_s} s"
            )
        if max_turn_rate_rad_s is not None and abs(rate_rad_s) > max_turn_rate_rad_s:
            raise ValueError(
                f"row {k} turns at {rate_rad_s} rad/s, faster than {max_turn_rate_rad_s} rad/s"
            )
        segments.append(Segment(end_s - begin_s, rate_rad_s))
        last_end_s = end_s
    return tuple(segments)


def _three_numbers(number: int, row: Any) -> list[float]:
    """The three numbers of a row."""
    try:
        values = real_numbers("row", row)
    except (TypeError, ValueError):
        values = np.array(np.nan)
    if values.shape != (3,) or not np.isfinite(values).all():
        raise ValueError(
            f"row {number} must be three finite numbers: start, end and rate; got {row!r}"
        )
    return values.tolist()


class Truth:
    """True motion of a vessel, in closed form at any time.

    Within a segment of turn rate ``w``, thrust ``a`` and accelerations ``u`` north and east,

        ``dv/dt = w x v + a e(c) + u``

    where ``w x v`` turns the velocity and ``e(c)`` points along the steered course: the course at
    the start of the segment, turned at ``w`` since. The integrals are exact: the speed ``v + a t``
    along the steered course, its path, and the contribution of ``u``, which the turn rotates, too.
    Without ``u`` the steered course is the course over ground. Before the first and after the last
    segment the velocity is constant.

    Braking must end before ``v + a t`` becomes negative. With a disturbance, after which the speed
    is random, it ends there automatically.

    Parameters
    ----------
    start : array_like (4,)
        Initial state ``[north, vnorth, east, veast]``, metres and metres per second.
    segments : sequence of Segment
        In order; without segments the path is a straight line.
    start_time_s : float
        Start time.
    start_course_rad : float, optional
        Initial course of a vessel at rest; default, and required otherwise, the course of the
        velocity.

    Attributes
    ----------
    segments : tuple of Segment
    start_time_s : float

    Raises
    ------
    ValueError
        When the start, its time or its course is not finite, the course is not that of the
        velocity, or the thrust of a segment without disturbance makes the speed negative.
    TypeError
        When the segments are not a sequence of Segment.
    """

    def __init__(
        self,
        start: Sequence[float],
        segments: Sequence[Segment] = (),
        *,
        start_time_s: float = 0.0,
        start_course_rad: float | None = None,
    ) -> None:
        start = real_numbers("start", start)
        if start.shape != (4,) or not np.isfinite(start).all():
            raise ValueError(f"start must be 4 finite numbers, got {start.tolist()}")
        finite(
            start_time_s=start_time_s,
            start_course_rad=0.0 if start_course_rad is None else start_course_rad,
        )
        north_m, vnorth_mps, east_m, veast_mps = start
        speed_mps = float(np.hypot(vnorth_mps, veast_mps))
        course_rad = float(np.arctan2(veast_mps, vnorth_mps))
        if start_course_rad is None:
            start_course_rad = course_rad
        elif speed_mps and abs(np.exp(1j * (start_course_rad - course_rad)) - 1) > _SAME_COURSE_RAD:
            raise ValueError(
                f"start_course_rad must be the course of the velocity, {course_rad}, unless the "
                f"vessel starts at rest, got {start_course_rad}"
            )
        self.segments = tuple(listed("segments", segments, "Segment"))
        for segment in self.segments:
            if not isinstance(segment, Segment):
                raise TypeError(f"segments must be of type Segment, got {segment!r}")
        self.start_time_s = float(start_time_s)
        self._lay_legs(complex(north_m, east_m), speed_mps, start_course_rad)

    def __repr__(self) -> str:
        return brief(self, many(len(self.segments), "segment"), span(self._time_s))

    @property
    def parameters(self) -> dict[str, Any]:
        """Constructor parameters as lists and numbers."""
        return {
            "start": self.state_at(self.start_time_s)[0].tolist(),
            "start_time_s": self.start_time_s,
            "start_course_rad": self.start_course_rad,
            "segments": [
                {name: np.asarray(value).tolist() for name, value in asdict(segment).items()}
                for segment in self.segments
            ],
        }

    @property
    def end_time_s(self) -> float:
        """End time of the last segment."""
        return float(self._time_s[-1])

    @property
    def start_course_rad(self) -> float:
        """Initial steered course, in (-pi, pi] unless given otherwise."""
        return float(self._course_rad[1])

    @property
    def switch_times_s(self) -> np.ndarray:
        """Times (S,) at or after the start at which the turn rate changes, in order."""
        return self._time_s[np.diff(self._turn_rate_rad_s) != 0]

    @property
    def control_switch_times_s(self) -> np.ndarray:
        """Times (S,) at or after the start at which the known acceleration changes, in order."""
        return self._time_s[(np.diff(self._control_mps2, axis=0) != 0).any(axis=1)]

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

        Raises
        ------
        ValueError
            When the times have more than one axis.
        """
        leg, since_s = self._legs_at(time_s)
        place_m, velocity_mps = self._motion(leg, since_s)
        return np.column_stack([place_m.real, velocity_mps.real, place_m.imag, velocity_mps.imag])

    def turn_rate_at(self, time_s: np.ndarray | float) -> np.ndarray:
        """Turn rates (T,) in radians per second; at a change the new one."""
        return self._turn_rate_rad_s[self._legs_at(time_s)[0]]

    def control_at(self, time_s: np.ndarray | float) -> np.ndarray:
        """Known accelerations (T, 2) north and east in m/s²; at a change the new ones."""
        return self._control_mps2[self._legs_at(time_s)[0]]

    def _legs_at(self, time_s: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
        """Leg (T,) in force at each time, and the time (T,) since it began."""
        time_s = in_a_row("time_s", time_s)
        leg = np.searchsorted(self._time_s, time_s, side="right")
        return leg, time_s - self._time_s[np.maximum(leg - 1, 0)]

    def _lay_legs(self, place_m: complex, speed_mps: float, course_rad: float) -> None:
        """Legs are the straight before the start, the segments, the straight after them.

        Leg k begins at time k - 1 of `_time_s`; the leg before the start is relative to it, too.
        """
        legs = [None, *self.segments, None]
        duration_s = [segment.duration_s for segment in self.segments]
        self._time_s = self.start_time_s + np.concatenate([[0.0], np.cumsum(duration_s)])
        self._turn_rate_rad_s = np.array([s.turn_rate_rad_s if s else 0.0 for s in legs])
        self._acceleration_mps2 = np.array([s.acceleration_mps2 if s else 0.0 for s in legs])
        self._control_mps2 = np.array([s.control_mps2 if s else (0.0, 0.0) for s in legs])
        self._push_mps2 = np.array([s.push_mps2 if s else 0.0 for s in legs], dtype=complex)
        self._place_m = np.full(len(legs), place_m)
        self._speed_mps = np.full(len(legs), speed_mps)
        self._course_rad = np.full(len(legs), course_rad)
        self._thrust_ends_s = np.full(len(legs), np.inf)
        least_mps = -1e-9 * max(speed_mps, 1.0)
        for leg, segment in enumerate(self.segments, start=1):
            end_mps = self._speed_mps[leg] + segment.acceleration_mps2 * segment.duration_s
            if end_mps < least_mps:
                if not any(segment.disturbance_mps2):
                    raise ValueError(
                        f"segment {leg - 1} brakes to a negative speed; shorten it or brake less"
                    )
                self._thrust_ends_s[leg] = self._speed_mps[leg] / -segment.acceleration_mps2
            end_mps = max(end_mps, 0.0)
            end_m, velocity_mps = self._motion(np.array([leg]), np.array([segment.duration_s]))
            end_rad = self._course_rad[leg] + segment.turn_rate_rad_s * segment.duration_s
            if segment.push_mps2 and velocity_mps[0]:
                end_mps, end_rad = abs(velocity_mps[0]), np.angle(velocity_mps[0])
            self._place_m[leg + 1] = end_m[0]
            self._speed_mps[leg + 1], self._course_rad[leg + 1] = end_mps, end_rad

    def _motion(self, leg: np.ndarray, since_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Positions and velocities (T,) at times since each leg began, as north + i east.

        With ``h = w t / 2`` and the steered course ``m`` half way, the vessel's path is
        ``t e^(i m) [(v + a t / 2) sin(h) / h + i (a t / 2) (sin(h) - h cos(h)) / h^2]`` and what
        the acceleration ``u`` adds is ``u t^2 (e^(2 i h) - 1 - 2 i h) / (2 i h)^2``. After braking
        ends, the first of them is constant.
        """
        half_turn_rad = 0.5 * self._turn_rate_rad_s[leg] * since_s
        way_s = np.minimum(since_s, self._thrust_ends_s[leg])
        share = np.divide(way_s, since_s, out=np.ones(len(since_s)), where=way_s < since_s)
        half_way_rad = share * half_turn_rad
        half_gain_mps = 0.5 * self._acceleration_mps2[leg] * way_s
        middle = np.exp(1j * (self._course_rad[leg] + half_way_rad))
        swing = np.exp(1j * half_turn_rad)
        shrink = np.sinc(half_turn_rad / np.pi)
        ahead = (self._speed_mps[leg] + half_gain_mps) * np.sinc(half_way_rad / np.pi)
        aside = half_gain_mps * _bow(half_way_rad)
        pushed_mps = self._push_mps2[leg] * since_s
        pushed = 0.5 * shrink**2 + 1j * _lag(2.0 * half_turn_rad)
        place_m = self._place_m[leg] + since_s * (
            share * middle * (ahead + 1j * aside) + pushed_mps * pushed
        )
        speed_mps = np.maximum(self._speed_mps[leg] + 2.0 * half_gain_mps, 0.0)
        return place_m, middle * swing * speed_mps + pushed_mps * swing * shrink


def _bow(h: np.ndarray) -> np.ndarray:
    """``(sin(h) - h cos(h)) / h^2``, by its series where the difference would lose digits."""
    square = h * h
    series = h / 3 * (1 - square / 10 * (1 - square / 28 * (1 - square / 54 * (1 - square / 88))))
    far = np.where(np.abs(h) < _SERIES_BELOW_RAD, 1.0, h)
    return np.where(far == h, (np.sin(far) - far * np.cos(far)) / far**2, series)


def _lag(angle: np.ndarray) -> np.ndarray:
    """``(a - sin(a)) / a^2``, by its series where the difference would lose digits."""
    square = angle * angle
    series = angle / 6 * (1 - square / 20 * (1 - square / 42 * (1 - square / 72)))
    far = np.where(np.abs(angle) < _SERIES_BELOW_RAD, 1.0, angle)
    return np.where(far == angle, (far - np.sin(far)) / far**2, series)
