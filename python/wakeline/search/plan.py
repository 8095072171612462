"""Search units, their sorties, and the probability of success (POS) of a plan.

A particle of the cloud is exposed while a unit passes it: POS is the mean over particles of
1 - exp(-potential), with the drift during the search. Probabilities of containment (POC) and of
detection (POD) of an area are those of the IAMSAR Manual, for comparison.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

import wakeline as wl
from wakeline import navigation
from wakeline._checks import finite, positive, shaped

from .drift import Cloud
from .patterns import Pattern, datum_square

DETECTION_LAWS = ("definite_range", "inverse_cube", "exponential")
"""Names of the laws of detection, by lateral range, of a `Unit`."""

_LENGTH_ROUNDS = 4


@dataclass(frozen=True)
class Unit:
    """A search unit.

    Attributes
    ----------
    name : str
    position_m : (2,) array
        Where it departs, [north, east].
    start_s : float
        When, after the last known time of the object.
    endurance_s : float
        From departure until it must leave the search area.
    transit_mps, search_mps : float
        Speed to the commence search point, and on the pattern.
    sweep_width_m : float
        For this object, from the tables of the IAMSAR Manual.

    Raises
    ------
    ValueError
        When a number is out of range.
    """

    name: str
    position_m: np.ndarray
    start_s: float
    endurance_s: float
    transit_mps: float
    search_mps: float
    sweep_width_m: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "position_m", shaped("position_m", self.position_m, 2))
        finite(start_s=self.start_s)
        names = ("endurance_s", "transit_mps", "search_mps", "sweep_width_m")
        positive(**{name: getattr(self, name) for name in names})

    @property
    def end_s(self) -> float:
        """When it must leave the search area."""
        return self.start_s + self.endurance_s

    def route_length_m(self, place_m: np.ndarray) -> float:
        """Length of a pattern that commences at a place; not positive if out of reach."""
        transit_s = np.hypot(*(place_m - self.position_m)) / self.transit_mps
        return self.search_mps * (self.endurance_s - transit_s)

    def intercept(self, cloud: Cloud) -> navigation.Intercept:
        """Where the unit meets the datum if it departs for it, with the errors of the cloud."""
        now_s, later_s = self.start_s, min(self.start_s + 1800.0, cloud.time_s[-1])
        dt_s = later_s - now_s
        states = np.empty((len(cloud), 4))
        states[:, ::2] = cloud.at(now_s)
        states[:, 1::2] = (cloud.at(later_s) - cloud.at(now_s)) / dt_s
        mean = np.average(states, axis=0, weights=cloud.weight)
        covariance = np.cov(states.T, aweights=cloud.weight, ddof=0)
        return navigation.intercept(
            wl.Gaussian(mean, covariance), self.position_m, self.transit_mps
        )


@dataclass(frozen=True)
class Track:
    """A track on which an object is looked for.

    Attributes
    ----------
    time_s : (K,) array
        At its turning points, in order.
    position_m : (K, 2) array
        [north, east].
    sweep_width_m : float
    """

    time_s: np.ndarray
    position_m: np.ndarray
    sweep_width_m: float

    def potential(
        self, cloud: Cloud, law: str, from_s: float = -np.inf, until_s: float = np.inf
    ) -> np.ndarray:
        """-log of the probability (n,) that each particle is missed, between two times."""
        first_s, last_s = max(from_s, self.time_s[0]), min(until_s, self.time_s[-1])
        if not first_s < last_s:
            return np.zeros(len(cloud))
        grid_s = cloud.time_s
        time_s = np.concatenate([[first_s, last_s], self.time_s, grid_s])
        time_s = np.unique(time_s[(first_s <= time_s) & (time_s <= last_s)])
        unit_m = np.column_stack([np.interp(time_s, self.time_s, p) for p in self.position_m.T])
        return navigation.detection_potential(
            law, self.sweep_width_m, time_s, unit_m, grid_s, cloud.position_m
        )


@dataclass(frozen=True)
class Sortie(Track):
    """A unit on a pattern, from the commence search point on.

    Attributes
    ----------
    unit : Unit
    pattern : Pattern
    """

    unit: Unit
    pattern: Pattern

    @classmethod
    def on(cls, unit: Unit, pattern: Pattern) -> Sortie | None:
        """The sortie of a unit whose pattern lasts as long as its endurance; None out of reach."""
        length_m = unit.route_length_m(pattern.center_m)
        for _ in range(_LENGTH_ROUNDS):
            if not length_m > 0.0:
                return None
            pattern = replace(pattern, length_m=length_m)
            length_m = unit.route_length_m(pattern.turning_points_m()[0])
        points_m = pattern.turning_points_m()
        begin_s = unit.start_s + np.hypot(*(points_m[0] - unit.position_m)) / unit.transit_mps
        run_m = np.append(0.0, np.cumsum(np.hypot(*np.diff(points_m, axis=0).T)))
        time_s = begin_s + run_m / unit.search_mps
        return cls(np.minimum(time_s, unit.end_s), points_m, unit.sweep_width_m, unit, pattern)

    @property
    def coverage(self) -> float:
        """Effort by area: sweep width times length of the track over the area."""
        run_m = self.unit.search_mps * (self.time_s[-1] - self.time_s[0])
        return self.unit.sweep_width_m * run_m / self.pattern.area_m2

    def poc(self, cloud: Cloud) -> float:
        """Share of the object's probability in the area at the middle of the sortie."""
        middle_m = cloud.at(0.5 * (self.time_s[0] + self.time_s[-1]))
        return float(cloud.weight @ self.pattern.holds(middle_m))


@dataclass(frozen=True)
class Plan:
    """Sorties that are evaluated together.

    Attributes
    ----------
    sorties : tuple of Sortie
    law : str
        One of `DETECTION_LAWS`.
    """

    sorties: tuple[Sortie, ...]
    law: str = "inverse_cube"

    def potential(self, cloud: Cloud, until_s: float = np.inf) -> np.ndarray:
        """-log of the probability (n,) that all sorties miss each particle until a time."""
        parts = (sortie.potential(cloud, self.law, until_s=until_s) for sortie in self.sorties)
        return sum(parts, np.zeros(len(cloud)))

    def pod(self, cloud: Cloud) -> np.ndarray:
        """Probability (n,) that each particle is detected."""
        return -np.expm1(-self.potential(cloud))

    def pos(self, cloud: Cloud) -> float:
        """Probability of success: that the object is found."""
        return success(cloud, self.potential(cloud))

    def pos_over_time(self, cloud: Cloud, time_s: Sequence[float]) -> np.ndarray:
        """POS (T,) until each of the times, in order."""
        potential, before_s, values = np.zeros(len(cloud)), -np.inf, []
        for now_s in time_s:
            for sortie in self.sorties:
                potential += sortie.potential(cloud, self.law, before_s, now_s)
            values.append(success(cloud, potential))
            before_s = now_s
        return np.array(values)


def success(cloud: Cloud, potential: np.ndarray) -> float:
    """Probability that an object of the cloud is found: the sum of POC times POD."""
    return min(1.0, float(cloud.weight @ -np.expm1(-potential)))


def naive_plan(
    units: Sequence[Unit], cloud: Cloud, law: str = "inverse_cube", kind: str = "expanding_square"
) -> Plan:
    """Every unit on a pattern of coverage 1 in a square about the datum of its arrival.

    Raises
    ------
    ValueError
        When a unit cannot reach the datum.
    """
    return Plan(tuple(naive_sortie(unit, cloud, kind) for unit in units), law)


def naive_sortie(unit: Unit, cloud: Cloud, kind: str) -> Sortie:
    """A sortie of the naive plan."""
    datum_m, length_m = on_scene(unit, cloud)
    sortie = Sortie.on(unit, datum_square(kind, datum_m, length_m, unit.sweep_width_m))
    return _reached(unit, cloud, sortie)


def on_scene(unit: Unit, cloud: Cloud) -> tuple[np.ndarray, float]:
    """The datum at arrival, and the length of a route from there."""
    met = unit.intercept(cloud)
    arrival_s = unit.start_s + met.time_s if met.found else np.inf
    if not arrival_s < unit.end_s:
        raise _unreachable(unit, cloud)
    datum_m = cloud.datum(arrival_s)
    return datum_m, unit.search_mps * (unit.end_s - arrival_s)


def _reached(unit: Unit, cloud: Cloud, sortie: Sortie | None) -> Sortie:
    if sortie is None:
        raise _unreachable(unit, cloud)
    return sortie


def _unreachable(unit: Unit, cloud: Cloud) -> ValueError:
    distance_m = np.hypot(*(cloud.datum(unit.start_s) - unit.position_m))
    return ValueError(
        f"unit {unit.name!r} must reach the datum within its endurance of "
        f"{unit.endurance_s / 3600.0:.2f} h, got {distance_m / 1000.0:.1f} km at "
        f"{unit.transit_mps:.1f} m/s"
    )
