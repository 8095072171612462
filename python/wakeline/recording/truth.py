"""True motion of a target: recorded positions, and the state at any time between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wakeline._brief import brief, many, span
from wakeline._checks import at_least, columns, in_a_row

from .scans import nearest

_SAME_SAMPLE_S = 0.02
_SAME_TIME_S = 1e-6
_FIT_POINTS = 4
_FIT_SIDE_S = 0.5


@dataclass(frozen=True)
class TargetTruth:
    """Recorded truth of one target, sorted by unique times.

    Attributes
    ----------
    time_s, north_m, east_m : ndarray (n,)
        Positions.
    vnorth_mps, veast_mps : ndarray (n,)
        Velocities, NaN where not recorded.
    """

    time_s: np.ndarray
    north_m: np.ndarray
    east_m: np.ndarray
    vnorth_mps: np.ndarray
    veast_mps: np.ndarray

    def __post_init__(self) -> None:
        columns(self, "time_s", "north_m", "east_m", "vnorth_mps", "veast_mps")

    def __len__(self) -> int:
        return len(self.time_s)

    def __repr__(self) -> str:
        return brief(self, many(len(self), "position"), span(self.time_s))

    def state_at(
        self, time_s: np.ndarray, *, max_gap_s: float = 2.5, window_s: float = 2.0
    ) -> np.ndarray:
        """State ``[north, vnorth, east, veast]`` at the given times.

        A sample with a velocity less than 0.02 s away is used unchanged. Otherwise the position is
        interpolated linearly, and the velocity is the slope at that time of a least-squares
        polynomial through the samples within `window_s` on either side (at least the nearest four):
        a parabola with samples more than 0.5 s away on both sides, else a line.

        Parameters
        ----------
        time_s : array_like (T,)
            Requested times.
        max_gap_s : float
            Longest step between samples that is interpolated across.
        window_s : float
            Half-width of the velocity fit.

        Returns
        -------
        ndarray (T, 4)
            NaN rows outside the record and inside longer gaps. Metres and metres per second.

        Raises
        ------
        ValueError
            When a parameter is negative.
        """
        at_least(0, max_gap_s=max_gap_s, window_s=window_s)
        time_s = in_a_row("time_s", time_s)
        state = np.full((len(time_s), 4), np.nan)
        if len(self) == 0:
            return state
        recorded = np.column_stack([self.north_m, self.vnorth_mps, self.east_m, self.veast_mps])
        nearest_sample = nearest(self.time_s, time_s).tolist()
        for row, t, near in zip(state, time_s, nearest_sample, strict=True):
            here = abs(self.time_s[near] - t) < _SAME_SAMPLE_S
            if here and np.isfinite(recorded[near, 1::2]).all():
                row[:] = recorded[near]
                continue
            position = self._position_at(t, near, max_gap_s)
            if position is not None:
                row[0::2] = position
                row[1::2] = self._fitted_velocity(t, window_s)
        return state

    def _position_at(self, t: float, near: int, max_gap_s: float) -> np.ndarray | None:
        """North and east at `t`, None without truth; `near` is the nearest sample."""
        if abs(self.time_s[near] - t) < _SAME_TIME_S:
            return self._position_m(near)
        after = int(np.searchsorted(self.time_s, t))
        if not 0 < after < len(self):
            return None
        step_s = self.time_s[after] - self.time_s[after - 1]
        if step_s > max_gap_s:
            return None
        weight = (t - self.time_s[after - 1]) / step_s
        return (1 - weight) * self._position_m(after - 1) + weight * self._position_m(after)

    def _fitted_velocity(self, t: float, window_s: float) -> np.ndarray:
        """Slope (2,) at `t` of the least-squares polynomial through the samples around it."""
        chosen = self._around(t, window_s)
        offset_s = self.time_s[chosen] - t
        both_sides = offset_s.min() < -_FIT_SIDE_S and offset_s.max() > _FIT_SIDE_S
        degree = 2 if both_sides and len(offset_s) >= _FIT_POINTS else 1
        basis = np.vander(offset_s, degree + 1, increasing=True)
        return np.linalg.lstsq(basis, self._position_m(chosen), rcond=None)[0][1]

    def _around(self, t: float, window_s: float) -> np.ndarray:
        """Indices of the samples within the window around `t`, at least of the nearest four."""
        begin, after, end = np.searchsorted(self.time_s, [t - window_s, t, t + window_s])
        first = max(min(begin, after - _FIT_POINTS) - 1, 0)
        near = np.arange(first, min(max(end, after + _FIT_POINTS) + 1, len(self)))
        away_s = np.abs(self.time_s[near] - t)
        inside = near[away_s <= window_s]
        if len(inside) >= _FIT_POINTS:
            return inside
        return np.sort(near[np.argsort(away_s, kind="stable")[:_FIT_POINTS]])

    def _position_m(self, which: int | np.ndarray) -> np.ndarray:
        """North and east (..., 2) of one sample or of several."""
        return np.stack([self.north_m[which], self.east_m[which]], axis=-1)
