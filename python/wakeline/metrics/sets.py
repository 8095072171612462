"""Distances between two sets of points: GOSPA, OSPA and the pairing behind them."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wakeline import association
from wakeline._checks import plain_numbers, real_numbers


@dataclass(frozen=True)
class Gospa:
    """GOSPA (alpha = 2) of one scan and what it is made of.

    Attributes
    ----------
    value_m : float
        ``(localisation + missed + false) ** (1 / p)``.
    localisation, missed, false : float
        Sums over pairs, targets without a track and tracks without a target, in metres to the p.
    """

    value_m: float
    localisation: float
    missed: float
    false: float


def gospa(
    truth_m: np.ndarray, tracks_m: np.ndarray, cutoff_m: float = 50.0, p: float = 2.0
) -> Gospa:
    """Generalised optimal sub-pattern assignment metric, alpha = 2.

    The least of ``sum of d ** p over pairs + cutoff ** p / 2 for each point without a pair``, to
    the power ``1 / p`` (Rahmathullah, Garcia-Fernandez and Svensson, 2017).

    Parameters
    ----------
    truth_m : array_like (n, d)
        True positions.
    tracks_m : array_like (m, d)
        Estimated positions.
    cutoff_m : float
        Distance at which a pair is as bad as a missed target and a false track.
    p : float
        Order, at least 1.

    Returns
    -------
    Gospa

    Raises
    ------
    ValueError
        On arrays of another shape or not finite, a cut-off that is not positive and finite or an
        order that is not finite and at least 1, or so high that the cut-off to its power is no
        number.
    """
    return gospa_of(_checked_distances(truth_m, tracks_m, cutoff_m, p), cutoff_m, p)


def ospa(
    truth_m: np.ndarray, tracks_m: np.ndarray, cutoff_m: float = 50.0, p: float = 2.0
) -> float:
    """Optimal sub-pattern assignment metric in metres.

    ``((least sum of min(d, c) ** p + c ** p * |n - m|) / max(n, m)) ** (1 / p)`` (Schuhmacher, Vo
    and Vo, 2008); 0 when both sets are empty.

    Parameters
    ----------
    truth_m, tracks_m, cutoff_m, p
        As for :func:`gospa`.

    Raises
    ------
    ValueError
        As for :func:`gospa`.
    """
    distance_m = _checked_distances(truth_m, tracks_m, cutoff_m, p)
    if max(distance_m.shape) == 0:
        return 0.0
    cut = np.minimum(distance_m, cutoff_m) ** p
    unpaired = abs(distance_m.shape[0] - distance_m.shape[1])
    total = sum(cut[i, j] for i, j in pairs(cut)) + unpaired * cutoff_m**p
    return float((total / max(distance_m.shape)) ** (1.0 / p))


def gospa_of(distance_m: np.ndarray, cutoff_m: float, p: float) -> Gospa:
    """GOSPA from the distances (n, m); a pair at the cut-off costs as much as no pair."""
    cut = np.minimum(distance_m, cutoff_m) ** p
    inside = [cut[i, j] for i, j in pairs(cut) if distance_m[i, j] < cutoff_m]
    localisation = float(sum(inside))
    missed, false = ((count - len(inside)) * cutoff_m**p / 2.0 for count in distance_m.shape)
    return Gospa((localisation + missed + false) ** (1.0 / p), localisation, missed, false)


def pairs(cost: np.ndarray) -> Sequence[Sequence[int]]:
    """Optimal assignment of a cost matrix, none when it is empty."""
    return association.assign(cost) if cost.size else ()


def distances(a_m: np.ndarray, b_m: np.ndarray) -> np.ndarray:
    """Distances (n, m) between points (n, 2) and (m, 2)."""
    return np.hypot(a_m[:, np.newaxis, 0] - b_m[:, 0], a_m[:, np.newaxis, 1] - b_m[:, 1])


def _checked_distances(
    truth_m: np.ndarray, tracks_m: np.ndarray, cutoff_m: float, p: float
) -> np.ndarray:
    """Distances (n, m) between points (n, d) and (m, d) after looking at the arguments."""
    truth_m, tracks_m = real_numbers("truth_m", truth_m), real_numbers("tracks_m", tracks_m)
    if truth_m.ndim != 2 or tracks_m.ndim != 2 or truth_m.shape[1] != tracks_m.shape[1]:
        raise ValueError(
            f"truth_m and tracks_m must have shapes (n, d) and (m, d), "
            f"got {truth_m.shape} and {tracks_m.shape}"
        )
    if not (np.isfinite(truth_m).all() and np.isfinite(tracks_m).all()):
        raise ValueError("truth_m and tracks_m must be finite")
    plain_numbers(cutoff_m=cutoff_m, p=p)
    if not 0 < cutoff_m < np.inf:
        raise ValueError(f"cutoff_m must be positive and finite, got {cutoff_m}")
    if not 1 <= p < np.inf:
        raise ValueError(f"p must be finite and at least 1, got {p}")
    with np.errstate(over="ignore", under="ignore"):
        cutoff_power = np.float64(cutoff_m) ** p
    if not sys.float_info.min <= cutoff_power < np.inf:
        raise ValueError(f"p must be such that cutoff_m to its power is a number, got {p}")
    return np.linalg.norm(truth_m[:, np.newaxis] - tracks_m[np.newaxis], axis=2)
