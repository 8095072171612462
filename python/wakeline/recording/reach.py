"""Positions that a vessel cannot have reached, and how far a plane reaches."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

_SLACK_M, _SLACK_S = 50.0, 2.0
_TRUSTED = 3
_MOST_AWAY = 3  # consecutive parts
_EARTH_RADIUS_M = 6371e3


def plane_stretch(distance_m: float) -> float:
    """Relative stretch of a distance on a `LocalPlane`, across the direction to its origin.

    At a distance d from the origin it is d / (R sin(d / R)) - 1.
    """
    angle_rad = distance_m / _EARTH_RADIUS_M
    return float(angle_rad / np.sin(angle_rad) - 1.0) if angle_rad else 0.0


def unreachable(time_s: np.ndarray, position_m: np.ndarray, max_speed_mps: float) -> np.ndarray:
    """Mask (n,) of the positions that are out of reach of the previous ones.

    Three consecutive positions that are consistent with each other but not with the track begin
    another part of it. A first part of at most three is rejected. So is a part after which the
    track returns to where it could have gone without it, unless it is longer than the parts before
    and after together.

    Parameters
    ----------
    time_s : ndarray (n,)
        Not decreasing.
    position_m : ndarray (n, d)
        Cartesian.
    max_speed_mps : float
        Maximum speed of the vessel; 50 m and 2 s are tolerated in addition.
    """

    def reachable(a: int, b: int) -> bool:
        way_m = np.sqrt(np.sum((position_m[b] - position_m[a]) ** 2))
        return way_m <= _reach_m(time_s[b] - time_s[a], max_speed_mps)

    mask = np.ones(len(time_s), dtype=bool)
    for stretch in _without_excursions(_stretches(len(time_s), reachable), reachable):
        mask[stretch] = False
    return mask


def jumps_m(time_s: np.ndarray, position_m: np.ndarray, max_speed_mps: float) -> np.ndarray:
    """Distances (n,) from the previous position to those out of reach; zero for others."""
    way_m = np.sqrt(np.sum(np.diff(position_m, axis=0) ** 2, axis=1))
    far = way_m > _reach_m(np.diff(time_s), max_speed_mps)
    return np.append(0.0, np.where(far, way_m, 0.0))[: len(time_s)]


def _reach_m(after_s, max_speed_mps: float):
    return _SLACK_M + max_speed_mps * (after_s + _SLACK_S)


def _stretches(count: int, reachable: Callable[[int, int], bool]) -> list[list[int]]:
    """Positions, each within reach of the previous one of its part."""
    stretches: list[list[int]] = []
    doubted: list[int] = []
    for k in range(count):
        if not stretches:
            stretches.append([k])
        elif reachable(stretches[-1][-1], k):
            stretches[-1].append(k)
            doubted = []
        else:
            doubted = [*doubted, k] if doubted and reachable(doubted[-1], k) else [k]
            if len(doubted) >= _TRUSTED:
                if len(stretches) == 1 and len(stretches[0]) <= len(doubted):
                    stretches.clear()
                stretches.append(doubted)
                doubted = []
    return stretches


def _without_excursions(
    stretches: list[list[int]], reachable: Callable[[int, int], bool]
) -> list[list[int]]:
    """The parts without those that the track returns from, short ones dropped first."""
    longest = _TRUSTED
    while longest < 2 * sum(map(len, stretches)):
        kept: list[list[int]] = []
        for stretch in stretches:
            away = _stretches_away(kept, stretch, longest, reachable)
            if away:
                del kept[-away:]
                kept[-1] = kept[-1] + stretch
            else:
                kept.append(stretch)
        stretches, longest = kept, 2 * longest
    return stretches


def _stretches_away(
    kept: list[list[int]], stretch: list[int], longest: int, reachable: Callable[[int, int], bool]
) -> int:
    """Number of the last parts between this one and one that it continues."""
    positions = 0
    for back in range(1, min(_MOST_AWAY, len(kept) - 1) + 1):
        before = kept[-1 - back]
        positions += len(kept[-back])
        few = positions <= min(longest, len(before) + len(stretch))
        if few and reachable(before[-1], stretch[0]):
            return back
    return 0
