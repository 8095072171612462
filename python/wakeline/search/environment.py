"""Wind, current and tide of a search area."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from wakeline import navigation
from wakeline._checks import shaped

_S_PER_H = 3600.0


@dataclass(frozen=True)
class Flow:
    """Velocity of air or water over time, the same everywhere or on a grid of positions.

    Linear between times and grid points. A flow of one time is steady. Beyond the edges of the grid
    it is that at the edge.

    Attributes
    ----------
    time_s : (T,) array
        In order.
    velocity_mps : (T, 2) or (T, N, E, 2) array
        [north, east] to which air or water moves.
    north_m, east_m : (N,) and (E,) array
        Of the grid, in order; empty for a flow that is the same everywhere.

    Raises
    ------
    ValueError
        When shapes do not fit, a number is not finite, or times or grid lines are not in order.
    """

    time_s: np.ndarray
    velocity_mps: np.ndarray
    north_m: np.ndarray = field(default_factory=lambda: np.zeros(0))
    east_m: np.ndarray = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        for name in ("time_s", "north_m", "east_m"):
            line = shaped(name, getattr(self, name), None)
            if not (np.isfinite(line).all() and (np.diff(line) > 0).all()):
                raise ValueError(f"{name} must be finite and increase, got {line}")
            object.__setattr__(self, name, line)
        grid = (len(self.north_m), len(self.east_m)) if len(self.north_m) else ()
        velocity_mps = shaped("velocity_mps", self.velocity_mps, len(self.time_s), *grid, 2)
        if not len(self.time_s) or not np.isfinite(velocity_mps).all():
            raise ValueError("velocity_mps must have a finite velocity at every time")
        object.__setattr__(self, "velocity_mps", velocity_mps)

    @classmethod
    def steady(cls, north_mps: float, east_mps: float) -> Flow:
        """The same velocity at all times and everywhere."""
        return cls([0.0], [[north_mps, east_mps]])

    def knows(self, from_s: float, until_s: float) -> bool:
        """Whether the flow is known between two times."""
        first_s, last_s = self.time_s[[0, -1]]
        return len(self.time_s) == 1 or (first_s <= from_s and until_s <= last_s)

    def at(self, time_s: float, position_m: np.ndarray) -> np.ndarray:
        """Velocity (n, 2) at positions (n, 2)."""
        before, share = _between(self.time_s, np.array(time_s))
        after = min(before + 1, len(self.time_s) - 1)
        now_mps = (1.0 - share) * self.velocity_mps[before] + share * self.velocity_mps[after]
        if not len(self.north_m):
            return np.broadcast_to(now_mps, position_m.shape)
        i, u = _between(self.north_m, position_m[:, 0])
        j, v = _between(self.east_m, position_m[:, 1])
        i2, j2 = np.minimum(i + 1, len(self.north_m) - 1), np.minimum(j + 1, len(self.east_m) - 1)
        u, v = u[:, None], v[:, None]
        low_mps = (1.0 - v) * now_mps[i, j] + v * now_mps[i, j2]
        high_mps = (1.0 - v) * now_mps[i2, j] + v * now_mps[i2, j2]
        return (1.0 - u) * low_mps + u * high_mps


def _between(grid: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Index of the grid line before each value, and the share of the way to the next one."""
    if len(grid) == 1:
        return np.zeros(values.shape, int), np.zeros(values.shape)
    before = np.clip(np.searchsorted(grid, values, side="right") - 1, 0, len(grid) - 2)
    share = (values - grid[before]) / (grid[before + 1] - grid[before])
    return before, np.clip(share, 0.0, 1.0)


@dataclass(frozen=True)
class Tide:
    """A harmonic tidal current, the velocity on an ellipse:

        a cos(w (t - t0)) along the direction + b sin(w (t - t0)) to starboard of it.

    Attributes
    ----------
    period_s : float
        12.42 h for the principal lunar constituent.
    major_mps, minor_mps : float
        a and b; b > 0 turns clockwise, b = 0 is a rectilinear current.
    direction_rad : float
        To which the water moves at the strongest flood.
    time_s : float
        Its time t0.
    """

    period_s: float
    major_mps: float
    minor_mps: float = 0.0
    direction_rad: float = 0.0
    time_s: float = 0.0

    def at(self, time_s: float) -> np.ndarray:
        """Velocity (2,), [north, east] m/s."""
        phase = 2.0 * np.pi * (time_s - self.time_s) / self.period_s
        c, s = np.cos(self.direction_rad), np.sin(self.direction_rad)
        return self.major_mps * np.cos(phase) * np.array([c, s]) + self.minor_mps * np.sin(
            phase
        ) * np.array([-s, c])


@dataclass(frozen=True)
class Environment:
    """What moves an object.

    Attributes
    ----------
    wind : Flow
        Velocity of the air, to which the wind blows, at 10 m.
    current : Flow, optional
        Velocity of the water without tide and wind current.
    tides : tuple of Tide
    latitude_rad : float
        Of the search area, for the wind current.
    wind_current : bool
        Whether to add the current (14) of the wind with its factor ``wind_current_factor``; not if
        `current` contains it. It needs a latitude of 20 degrees or more.
    """

    wind: Flow
    current: Flow | None = None
    tides: tuple[Tide, ...] = ()
    latitude_rad: float = np.pi / 4
    wind_current: bool = True

    def require(self, from_s: float, until_s: float) -> None:
        """ValueError unless wind and current are known between two times."""
        for name, flow in (("wind", self.wind), ("current", self.current)):
            if flow is not None and not flow.knows(from_s, until_s):
                first_h, last_h = flow.time_s[[0, -1]] / _S_PER_H
                raise ValueError(
                    f"{name} must be known from {from_s / _S_PER_H:.2f} to "
                    f"{until_s / _S_PER_H:.2f} h, got {first_h:.2f} to {last_h:.2f} h"
                )

    def water_mps(self, time_s: float, position_m: np.ndarray, wind_mps: np.ndarray) -> np.ndarray:
        """Velocity (n, 2) of the surface water at positions (n, 2) under winds (n, 2)."""
        velocity_mps = np.zeros(position_m.shape)
        if self.current is not None:
            velocity_mps += self.current.at(time_s, position_m)
        for tide in self.tides:
            velocity_mps += tide.at(time_s)
        if self.wind_current:
            factor = navigation.wind_current_factor(np.hypot(*wind_mps.T))
            velocity_mps += navigation.wind_current_mps(wind_mps, self.latitude_rad, factor=factor)
        return velocity_mps
