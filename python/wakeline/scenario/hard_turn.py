"""A small craft that turns hard, seen by a coastal radar whose plots lie on a grid of cells.

The scenario of "Multi-model tracking of moving vessels with a fuzzy criterion of maneuver
detection" (V. M. Grinyak, M. V. Trofimov): a straight, half a circle, a straight.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from wakeline import measurement
from wakeline._brief import brief, many, span
from wakeline._checks import entropy, positive, whole_number

from .radar import polar
from .truth import Segment, Truth

_SQRT12 = np.sqrt(12.0)


class HardTurnRuns(NamedTuple):
    """Independent runs: times (T,), true states (R, T, 4), plots in range and bearing (R, T, 2)."""

    time_s: np.ndarray
    truth: np.ndarray
    z: np.ndarray

    def __repr__(self) -> str:
        runs, scans = self.z.shape[:2]
        return brief(self, many(runs, "run"), many(scans, "scan"), span(self.time_s))


@dataclass(frozen=True)
class HardTurn:
    """A straight leg, a turn by half a circle, a straight leg; a plot is the center of its cell.

    The paper gives speed, radius, period and cell, but neither the range nor the lengths of the
    legs; those defaults are ours. Course, side of the turn, bearing and position within a cell
    are random in each run.

    Attributes
    ----------
    speed_mps, radius_m : float
    before_s, after_s : float
        Durations of the straight legs.
    range_m : float
        From the antenna, at the start.
    range_cell_m, azimuth_cell_rad : float
    period_s : float
        Time from scan to scan.

    Raises
    ------
    ValueError
        When one is not finite and positive.
    """

    speed_mps: float
    radius_m: float
    before_s: float = 120.0
    after_s: float = 60.0
    range_m: float = 20_000.0
    range_cell_m: float = 6.0
    azimuth_cell_rad: float = np.deg2rad(0.03)
    period_s: float = 3.0

    def __post_init__(self) -> None:
        positive(**vars(self))

    @property
    def turn_rate_rad_s(self) -> float:
        """Absolute turn rate."""
        return self.speed_mps / self.radius_m

    @property
    def turn_s(self) -> tuple[float, float]:
        """Times at which the turn begins and ends."""
        return self.before_s, self.before_s + np.pi / self.turn_rate_rad_s

    @property
    def time_s(self) -> np.ndarray:
        """Times (T,) of the scans; the first is 0."""
        return np.arange(0.0, self.turn_s[1] + self.after_s + 1e-9, self.period_s)

    @property
    def sensor(self) -> measurement.ConvertedRangeBearing:
        """The radar as a sensor: a cell is a uniform error with a std of its length / √12."""
        return measurement.ConvertedRangeBearing(
            range_std_m=self.range_cell_m / _SQRT12,
            bearing_std_rad=self.azimuth_cell_rad / _SQRT12,
        )

    def truth(self, rng: np.random.Generator) -> Truth:
        """One vessel with random position, course and side of the turn."""
        bearing, course = rng.uniform(-np.pi, np.pi, 2)
        rate = rng.choice([-1.0, 1.0]) * self.turn_rate_rad_s
        range_m = self.range_m + self.range_cell_m * rng.random()
        vnorth_mps, veast_mps = self.speed_mps * np.array([np.cos(course), np.sin(course)])
        place = range_m * np.array([np.cos(bearing), np.sin(bearing)])
        legs = (
            Segment(self.before_s),
            Segment(np.pi / self.turn_rate_rad_s, rate),
            Segment(self.after_s),
        )
        return Truth([place[0], vnorth_mps, place[1], veast_mps], legs)

    def draw(self, runs: int, seed: int | Sequence[int] = 0) -> HardTurnRuns:
        """Independent runs; run r does not depend on their number.

        Raises
        ------
        ValueError
            When runs or a seed is negative or not an integer.
        """
        whole_number("runs", runs, 0)
        time_s = self.time_s
        name = f"hard turn {self.speed_mps} {self.radius_m}"
        begin = entropy(seed, name)
        truth = np.empty((runs, len(time_s), 4))
        for run in range(runs):
            rng = np.random.default_rng([*begin, run])
            truth[run] = self.truth(rng).state_at(time_s)
        z = polar(truth.reshape(-1, 4)).reshape(runs, len(time_s), 2)
        cells = np.array([self.range_cell_m, self.azimuth_cell_rad])
        return HardTurnRuns(time_s, truth, (np.floor(z / cells) + 0.5) * cells)


def hard_turns() -> dict[str, HardTurn]:
    """The paper's two speeds at its radius, and the higher one at the turn rate of the lower."""
    return {
        "10mps_r300": HardTurn(10.0, 300.0),
        "20mps_r300": HardTurn(20.0, 300.0),
        "20mps_r600": HardTurn(20.0, 600.0),
    }
