"""Sectors of one radar from its plots and its marks."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from wakeline.recording import scans
from wakeline.wire import SensorClock

_TAU = 2.0 * math.pi
_MOST_WAITING = 20_000  # plots
_MEMORY_S, _LEAST_REMEMBERED, _APART_S = 60.0, 40, 0.05  # of plots
_CHECK_S = 20.0


class PlotRow(NamedTuple):
    """A plot as the radar measures it."""

    time_s: float
    range_m: float
    bearing_rad: float
    range_var_m2: float = 0.0
    bearing_var_rad2: float = 0.0


class PlacedPlot(NamedTuple):
    """A plot as a position on the earth."""

    time_s: float
    latitude_rad: float
    longitude_rad: float


class Sector(NamedTuple):
    """A part of the antenna's turn with its plots."""

    from_rad: float
    to_rad: float
    time_s: float
    plots: list[PlotRow]


class AntennaPeriod:
    """Finds the period of an antenna from the times and bearings of its plots.

    Parameters
    ----------
    period_s : float
        Supposed until plots show another.
    """

    def __init__(self, period_s: float) -> None:
        self.period_s = period_s
        self._plots: deque[tuple[float, float]] = deque()
        self._checked_s = -math.inf

    def add(self, plot: PlotRow) -> bool:
        """Take a plot; whether those of the last while show another period, which it then has."""
        passed_s = plot.time_s - self._plots[-1][0] if self._plots else math.inf
        if passed_s < -_MEMORY_S:  # of a clock that was set back
            self._plots.clear()
            self._checked_s = -math.inf
        elif passed_s <= _APART_S:
            return False
        self._plots.append((plot.time_s, plot.bearing_rad))
        while plot.time_s > self._plots[0][0] + _MEMORY_S and len(self._plots) > _LEAST_REMEMBERED:
            self._plots.popleft()
        if plot.time_s < self._checked_s + _CHECK_S:
            return False
        self._checked_s = plot.time_s
        return self._find()

    def _find(self) -> bool:
        time_s, bearing_rad = np.array(self._plots).T
        if scans.turn_near(time_s, bearing_rad, self.period_s) is not None:
            return False
        found_s = scans.revolution_s(time_s, bearing_rad)
        if found_s is None:
            return False
        self.period_s = found_s
        self._plots.clear()
        return True


@dataclass
class RadarFeed:
    """Plots of one radar until their sector ends.

    A radar that marks its sectors ends them itself. Of one that does not, a turn ends a period
    after its first plot, or where a plot is a period later.

    Attributes
    ----------
    name : str
    antenna : AntennaPeriod
    unused_why : str
        Why its last sector was not used; empty if it was.
    used_s : float
        When its last sector was.
    """

    name: str
    antenna: AntennaPeriod
    clock: SensorClock = field(default_factory=SensorClock)
    plots: int = 0
    sectors: int = 0
    unused: int = 0
    excluded: int = 0
    unused_why: str = ""
    used_s: float = -math.inf
    last_s: float = -math.inf
    _waiting: list[PlotRow] = field(default_factory=list)
    _marks: bool = False
    _turn_begin_s: float | None = None

    @property
    def period_s(self) -> float:
        """Period of the antenna."""
        return self.antenna.period_s

    def is_silent_at(self, time_s: float) -> bool:
        """Whether it has given nothing for three turns and 10 s."""
        return time_s - self.last_s > self.longest_silence_s

    @property
    def longest_silence_s(self) -> float:
        """After that it is lost."""
        return max(3.0 * self.period_s, 10.0)

    def add(self, plot: PlotRow) -> list[Sector]:
        """Add a plot; the turn that ends before it, of a radar without marks."""
        self.plots += 1
        ended = [] if self._marks else self.pass_to(plot.time_s)
        if len(self._waiting) < _MOST_WAITING:
            self._waiting.append(plot)
        else:
            self.unused += 1
        if self._turn_begin_s is None:
            self._turn_begin_s = plot.time_s
        return ended

    def mark(self, from_rad: float, to_rad: float, time_s: float) -> list[Sector]:
        """End a sector; the plots until now are in it, or waited for an earlier one."""
        self._marks, self.last_s = True, time_s
        self.sectors += 1
        plots, self._waiting = self._waiting, []
        return [Sector(from_rad, to_rad, time_s, plots)]

    def pass_to(self, time_s: float) -> list[Sector]:
        """The turns that end until a time, of a radar without marks."""
        begin_s = self._turn_begin_s
        if self._marks or begin_s is None or time_s < begin_s + 0.9 * self.period_s:
            return []
        turns = max(round((time_s - begin_s) / self.period_s), 1)
        end_s = max((plot.time_s for plot in self._waiting), default=begin_s)
        self._turn_begin_s = begin_s + turns * self.period_s if turns > 1 else None
        plots, self._waiting = self._waiting, []
        self.last_s = end_s
        self.sectors += 1
        return [Sector(0.0, _TAU, end_s, plots)]


def columns(plots: list[PlotRow]) -> tuple[np.ndarray, ...]:
    """Times, ranges, bearings, and variances (n, 2, 2) or None of plots."""
    table = np.array(plots, dtype=float).reshape(len(plots), 5)
    covariance = None
    if len(plots) and table[:, 3].any():
        covariance = np.zeros((len(plots), 2, 2))
        covariance[:, 0, 0], covariance[:, 1, 1] = table[:, 3], table[:, 4]
    return table[:, 0], table[:, 1], table[:, 2], covariance
