"""Particles that know the law by which vessels of a scene move.

What they err by comes from the measurements and from the number of particles, not from a model: a
figure to measure estimators against that know less. A measurement that arrives late weighs the
particles by where they were at its time. Source: M. Arulampalam, S. Maskell, N. Gordon, T. Clapp,
IEEE Trans. Signal Processing 50, 2002 (SIR); M. Orton, A. Marrs, IEE Colloquium on Target Tracking,
2001 (late measurements).
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from typing import Any

import numpy as np

# Of the start, and of a walk that keeps particles apart which are drawn twice.
START_STD_M = 10.0
START_STD_MPS = 1.0
WALK_M = 0.3
WALK_MPS = 0.06
WALK_RAD = np.deg2rad(0.4)

LONGEST_STEP_S = 1.0


@dataclass(frozen=True)
class Law:
    """Vessels run straight and turn by turns, at a constant speed.

    Attributes
    ----------
    straight_s, turn_s : (float, float)
        Least and largest duration of a straight part and of a turn.
    turn_deg_s : (float, float)
        Least and largest turn rate, to either side.
    """

    straight_s: tuple[float, float]
    turn_s: tuple[float, float]
    turn_deg_s: tuple[float, float]

    def turn_rates(self, rng: np.random.Generator, count: int | None = None) -> Any:
        """A turn rate, rad/s, or an array of them."""
        return np.deg2rad(rng.uniform(*self.turn_deg_s, count)) * rng.choice([-1, 1], count)


class Particles:
    """Where a vessel may be that began a straight part at time 0.

    Parameters
    ----------
    law : Law
    count : int
    state : array (4,)
        ``[north, vnorth, east, veast]`` at the first time, about which they are spread.
    time_s : float
    rng : Generator
    """

    def __init__(
        self, law: Law, count: int, state: np.ndarray, time_s: float, rng: np.random.Generator
    ) -> None:
        self._law, self._rng, self._time_s = law, rng, time_s
        self._place_m = state[::2, None] + START_STD_M * rng.normal(size=(2, count))
        velocity = state[1::2, None] + START_STD_MPS * rng.normal(size=(2, count))
        self._speed_mps = np.hypot(*velocity)
        self._course_rad = np.arctan2(velocity[1], velocity[0])
        self._turn_rad_s = np.zeros(count)
        self._left_s = rng.uniform(*law.straight_s, count) - time_s
        self._weight = np.full(count, 1.0 / count)
        self._past: dict[Hashable, np.ndarray] = {}

    @property
    def states(self) -> np.ndarray:
        """``[north, vnorth, east, veast]`` of each, (4, count)."""
        north_m, east_m = self._place_m
        vnorth, veast = self._speed_mps * np.array(
            [np.cos(self._course_rad), np.sin(self._course_rad)]
        )
        return np.array([north_m, vnorth, east_m, veast])

    @property
    def mean(self) -> np.ndarray:
        """The mean state, (4,)."""
        return self.states @ self._weight

    def move_to(self, time_s: float) -> None:
        """Move to a later time."""
        steps = max(1, int(np.ceil((time_s - self._time_s) / LONGEST_STEP_S)))
        for _ in range(steps):
            self._move((time_s - self._time_s) / steps)
        self._time_s = time_s

    def _move(self, dt_s: float) -> None:
        middle_rad = self._course_rad + self._turn_rad_s * dt_s / 2
        way_m = dt_s * self._speed_mps * np.array([np.cos(middle_rad), np.sin(middle_rad)])
        draw, root = self._rng.normal(size=(4, len(self._weight))), np.sqrt(dt_s)
        self._place_m = self._place_m + way_m + WALK_M * root * draw[:2]
        self._speed_mps = self._speed_mps + WALK_MPS * root * draw[2]
        self._course_rad = self._course_rad + self._turn_rad_s * dt_s + WALK_RAD * root * draw[3]
        self._left_s = self._left_s - dt_s
        (ended,) = np.nonzero(self._left_s <= 0.0)
        if not len(ended):
            return
        turned = self._turn_rad_s[ended] != 0.0
        rates = self._law.turn_rates(self._rng, len(ended))
        straight_s, turn_s = (
            self._rng.uniform(*span_s, len(ended))
            for span_s in (self._law.straight_s, self._law.turn_s)
        )
        self._turn_rad_s[ended] = np.where(turned, 0.0, rates)
        self._left_s[ended] = np.where(turned, straight_s, turn_s)

    def remember(self, name: Hashable) -> None:
        """Keep the states of now, of which a measurement will come."""
        self._past[name] = self.states

    def recall(self, name: Hashable) -> np.ndarray:
        """The states that were kept, (4, count), for the last time."""
        return self._past.pop(name)

    def weigh(self, squares: np.ndarray) -> None:
        """Weigh by a normal measurement: its squared distance of each in standard deviations."""
        self._weight = self._weight * np.exp(-0.5 * (squares - squares.min()))
        self._weight /= self._weight.sum()
        if 1.0 / np.sum(self._weight**2) < len(self._weight) / 2:
            self._resample()

    def _resample(self) -> None:
        count = len(self._weight)
        places = (np.arange(count) + self._rng.uniform()) / count
        kept = np.minimum(np.searchsorted(np.cumsum(self._weight), places), count - 1)
        self._place_m = self._place_m[:, kept]
        self._speed_mps, self._course_rad = self._speed_mps[kept], self._course_rad[kept]
        self._turn_rad_s, self._left_s = self._turn_rad_s[kept], self._left_s[kept]
        self._past = {name: states[:, kept] for name, states in self._past.items()}
        self._weight = np.full(count, 1.0 / count)
