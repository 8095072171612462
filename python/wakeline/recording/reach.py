"""Positions that a vessel cannot have come to."""

from __future__ import annotations

import numpy as np

_SLACK_M, _SLACK_S = 50.0, 2.0
_TRUSTED = 3


def unreachable(time_s: np.ndarray, position_m: np.ndarray, max_speed_mps: float) -> np.ndarray:
    """Mask (n,) of the positions that do not follow from those before them.

    Where three in a row follow from each other but not from the track so far, they are believed;
    the track so far is not when it is no longer than they are.

    Parameters
    ----------
    time_s : ndarray (n,)
        Never falling.
    position_m : ndarray (n, d)
        Cartesian.
    max_speed_mps : float
        No vessel is faster; 50 m and 2 s are let pass on top.
    """

    def reachable(a: int, b: int) -> bool:
        way_m = np.sqrt(np.sum((position_m[b] - position_m[a]) ** 2))
        return way_m <= _SLACK_M + max_speed_mps * (time_s[b] - time_s[a] + _SLACK_S)

    kept: list[int] = []
    doubted: list[int] = []
    for k in range(len(time_s)):
        if not kept or reachable(kept[-1], k):
            kept.append(k)
            doubted = []
            continue
        doubted = [*doubted, k] if doubted and reachable(doubted[-1], k) else [k]
        if len(doubted) >= _TRUSTED:
            kept = doubted if len(kept) <= len(doubted) else kept + doubted
            doubted = []
    mask = np.ones(len(time_s), dtype=bool)
    mask[kept] = False
    return mask
