"""Cells of the search area: the probability map, and a bound of POS from effort without routes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from wakeline import navigation

from .drift import Cloud
from .plan import Plan

_SLICE_S = 900.0
_PARTICLES_A_CELL = 40
_COVERAGE_STEP = 0.25
_MOST_COVERAGE = 10.0


@dataclass(frozen=True)
class Allocation:
    """Effort over cells and time, without routes: what no plan of the same effort should exceed.

    In every time slice the effort goes, in small parts, to the cell where it raises POS most. A
    cell counts as swept by parallel tracks.

    Attributes
    ----------
    time_s : (K + 1,) array
        Edges of the slices.
    north_m, east_m : arrays
        Edges of the cells.
    coverage : (K, N, E) array
        Of each cell in each slice.
    law : str
    """

    time_s: np.ndarray
    north_m: np.ndarray
    east_m: np.ndarray
    coverage: np.ndarray
    law: str

    def pod(self, cloud: Cloud) -> np.ndarray:
        """Probability of detection (n,) of each particle of a cloud."""
        return navigation.parallel_track_pod(self.law, sum(self._coverages(cloud)))

    def pos(self, cloud: Cloud) -> float:
        """Probability of success."""
        return min(1.0, float(cloud.weight @ self.pod(cloud)))

    def pos_over_time(self, cloud: Cloud) -> np.ndarray:
        """POS (K + 1,) until each of `time_s`."""
        total = np.cumsum([np.zeros(len(cloud)), *self._coverages(cloud)], axis=0)
        return navigation.parallel_track_pod(self.law, total) @ cloud.weight

    def _coverages(self, cloud: Cloud) -> Iterator[np.ndarray]:
        """Coverage (n,) of each particle in each slice."""
        for k, middle_s in enumerate(0.5 * (self.time_s[1:] + self.time_s[:-1])):
            cell = _cells(cloud.at(middle_s), self.north_m, self.east_m)
            yield np.where(cell >= 0, self.coverage[k].ravel()[cell], 0.0)


def greedy_bound(plan: Plan, cloud: Cloud) -> Allocation:
    """The greedy allocation of the effort of a plan's sorties, in their times."""
    first_s = min(sortie.time_s[0] for sortie in plan.sorties)
    last_s = max(sortie.time_s[-1] for sortie in plan.sorties)
    time_s = np.linspace(first_s, last_s, max(2, round((last_s - first_s) / _SLICE_S) + 1))
    middle_s = 0.5 * (time_s[1:] + time_s[:-1])
    narrowest_m = min(sortie.sweep_width_m for sortie in plan.sorties)
    north_m, east_m = map_cells(cloud, first_s, last_s, narrowest_m)
    cell_m2 = (north_m[1] - north_m[0]) * (east_m[1] - east_m[0])
    table = np.linspace(0.0, _MOST_COVERAGE, 401)
    pods = navigation.parallel_track_pod(plan.law, table)
    count = (len(north_m) - 1) * (len(east_m) - 1)
    coverage = np.zeros((len(middle_s), count))
    total = np.zeros(len(cloud))

    def gains(rows: np.ndarray, step: float) -> np.ndarray:
        now = np.interp(total[rows], table, pods)
        return cloud.weight[rows] * (np.interp(total[rows] + step, table, pods) - now)

    for k, (from_s, until_s) in enumerate(pairwise(time_s)):
        effort_m2 = sum(
            one.unit.sweep_width_m
            * one.unit.search_mps
            * max(0.0, min(until_s, one.time_s[-1]) - max(from_s, one.time_s[0]))
            for one in plan.sorties
        )
        cell = _cells(cloud.at(middle_s[k]), north_m, east_m)
        order = np.argsort(cell, kind="stable")
        starts = np.searchsorted(cell[order], np.arange(count + 1))
        members = [order[a:b] for a, b in pairwise(starts)]
        parts = max(1, int(np.ceil(effort_m2 / cell_m2 / _COVERAGE_STEP)))
        step = effort_m2 / cell_m2 / parts
        inside = np.flatnonzero(cell >= 0)
        gain = np.bincount(cell[inside], gains(inside, step), count)
        for _ in range(parts):
            best = int(np.argmax(gain))
            coverage[k, best] += step
            total[members[best]] += step
            gain[best] = gains(members[best], step).sum()
    shape = (len(middle_s), len(north_m) - 1, len(east_m) - 1)
    return Allocation(time_s, north_m, east_m, coverage.reshape(shape), plan.law)


def map_cells(
    cloud: Cloud, first_s: float, last_s: float, least_m: float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Edges of square cells, north and east, for a cloud between two times.

    A cell in the middle has some 40 particles, and sides of `least_m` or more.
    """
    middle_s = 0.5 * (first_s + last_s)
    core_m2 = 4.0 * np.pi * np.sqrt(max(np.linalg.det(cloud.covariance_m2(middle_s)), 1.0))
    side_m = np.sqrt(core_m2 * _PARTICLES_A_CELL / len(cloud))
    places_m = np.concatenate([cloud.at(t) for t in (first_s, middle_s, last_s)])
    low_m, high_m = places_m.min(axis=0), places_m.max(axis=0)
    side_m = max(side_m, least_m, (high_m - low_m).max() / 400)
    north_m, east_m = (
        low + side_m * np.arange(int((high - low) / side_m) + 2)
        for low, high in zip(low_m, high_m, strict=True)
    )
    return north_m, east_m


def probability_map(
    cloud: Cloud, time_s: float, north_m: np.ndarray, east_m: np.ndarray
) -> np.ndarray:
    """POC (N, E) of cells with edges (N + 1,) and (E + 1,) at a time."""
    return np.histogram2d(*cloud.at(time_s).T, bins=(north_m, east_m), weights=cloud.weight)[0]


def _cells(position_m: np.ndarray, north_m: np.ndarray, east_m: np.ndarray) -> np.ndarray:
    """Row-major index of each position's cell, -1 outside."""
    i = np.floor((position_m[:, 0] - north_m[0]) / (north_m[1] - north_m[0])).astype(int)
    j = np.floor((position_m[:, 1] - east_m[0]) / (east_m[1] - east_m[0])).astype(int)
    inside = (i >= 0) & (i < len(north_m) - 1) & (j >= 0) & (j < len(east_m) - 1)
    return np.where(inside, i * (len(east_m) - 1) + j, -1)
