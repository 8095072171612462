"""Grouping of plots into scans."""

from __future__ import annotations

import itertools
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from typing import Any

import numpy as np

from .table import MOST_BAD

_COUNTERS = (100, 256, 360, 1000, 1024, 4096, 10_000, 1 << 16, 1_000_000, 1 << 24, 1 << 32)

_GAP_PERIODS = 0.5
_SCAN_PERIODS = 0.95

_TURNS_S = np.geomspace(20.0, 0.1, 533)  # in steps of 1 %
_LEAST_PLOTS, _STARTS, _LEAST_SHARE = 20, 256, 0.1
_LAGS = 0.5 + 2.5 * (np.arange(8 * _STARTS).reshape(_STARTS, 8) * 0.618034 % 1.0)  # of no rhythm
_MOST_TURNS = 3.5
_TURNING, _PEAK = 0.9, 16
_NEAR_PERIOD = np.linspace(0.95, 1.05, 11)
_SEAM_RAD = np.deg2rad(18.0)


def scan_numbers(time_s: np.ndarray, bearing_rad: np.ndarray, period_s: float | None) -> np.ndarray:
    """Scan number of each plot, counted from 0: antenna revolutions if the plots show them.

    If bearings grow with time as for an antenna that turns clockwise in about `period_s`, a scan
    begins where the beam passes the middle of the widest empty sector within the 18 degrees before
    the first plot; otherwise as in `by_time`. Plots of equal time are in one scan.

    Parameters
    ----------
    time_s : ndarray (n,)
        Times of the plots, sorted.
    bearing_rad : ndarray (n,)
        Clockwise from north; NaN where missing.
    period_s : float or None
        Time of one antenna turn, right to 5 %.

    Returns
    -------
    ndarray of int (n,)
    """
    seen = np.isfinite(bearing_rad)
    seen_s, seen_rad = time_s[seen], bearing_rad[seen]
    turn = None if period_s is None else turn_near(seen_s, seen_rad, period_s)
    if turn is None:
        return by_time(time_s, period_s)
    even_rad = 2.0 * np.pi * (time_s - time_s[0]) / turn
    ahead_rad = np.unwrap(seen_rad - even_rad[seen])
    turned_rad = even_rad + np.interp(time_s, seen_s, ahead_rad)
    turned_rad[seen] = even_rad[seen] + ahead_rad
    turns = np.floor((turned_rad - _seam_rad(seen_rad)) / (2.0 * np.pi))
    turns = turns[np.searchsorted(time_s, time_s)]
    return np.unique(np.maximum.accumulate(turns), return_inverse=True)[1]


def turn_near(time_s: np.ndarray, bearing_rad: np.ndarray, period_s: float) -> float | None:
    """Duration of a revolution within 5 % of `period_s`, None if the plots show none."""
    if len(time_s) < _LEAST_PLOTS:
        return None
    likeness = [_likeness(time_s, bearing_rad, turn) for turn in period_s * _NEAR_PERIOD]
    best = int(np.argmax(likeness))
    return float(period_s * _NEAR_PERIOD[best]) if likeness[best] > _TURNING else None


def _seam_rad(bearing_rad: np.ndarray) -> float:
    """Start of revolutions: the middle of the widest empty sector shortly before the first."""
    behind_rad = (bearing_rad[0] - bearing_rad) % (2.0 * np.pi)
    edges_rad = np.append(np.sort(behind_rad[behind_rad < _SEAM_RAD]), _SEAM_RAD)
    gap_rad = np.diff(edges_rad)
    widest = int(np.argmax(gap_rad))
    return float(bearing_rad[0] - edges_rad[widest] - gap_rad[widest] / 2.0)


def by_time(time_s: np.ndarray, period_s: float | None) -> np.ndarray:
    """Scan number of each plot from its time alone, counted from 0.

    Without a period, plots of equal time are one scan. With the period of a rotating antenna, a
    scan begins at a plot more than half a period after the previous plot, or 95 % of a period or
    more after the first plot of its scan, so that a target detected in every revolution is in
    each scan once although the antenna runs a little fast. Scans without plots are not found.

    Parameters
    ----------
    time_s : ndarray (n,)
        Times of the plots, sorted.
    period_s : float or None
        Duration of an antenna revolution.

    Returns
    -------
    ndarray of int (n,)
    """
    if len(time_s) == 0:
        return np.zeros(0, dtype=int)
    step_s = np.diff(time_s, prepend=time_s[:1])
    if period_s is None:
        return np.cumsum(step_s > 0)
    begins = step_s > _GAP_PERIODS * period_s
    first = 0
    while (first := _next_begin(time_s, begins, first, period_s)) < len(time_s):
        begins[first] = True
    return np.cumsum(begins)


def _next_begin(time_s: np.ndarray, begins: np.ndarray, first: int, period_s: float) -> int:
    """Index of the first plot of the scan after the one that begins at `first`."""
    full = max(int(np.searchsorted(time_s, time_s[first] + _SCAN_PERIODS * period_s)), first + 1)
    gap = np.flatnonzero(begins[first + 1 : full])
    return first + 1 + int(gap[0]) if len(gap) else full


def revolution_s(time_s: np.ndarray, bearing_rad: np.ndarray) -> float | None:
    """Estimated duration of an antenna revolution, to about 1 %, None if the plots show none.

    With a rotating antenna, the bearing of a plot gives its phase in the revolution. The result is
    the longest period of 0.1 to 20 s for which plots half a revolution to three revolutions apart
    differ in bearing by the angle that the beam turned: the mean cosine of the residual is above
    0.9.

    Parameters
    ----------
    time_s : ndarray (n,)
        Times of the plots, sorted.
    bearing_rad : ndarray (n,)
        Clockwise from north.
    """
    if len(time_s) < _LEAST_PLOTS:
        return None
    likeness = np.array([_likeness(time_s, bearing_rad, turn) for turn in _TURNS_S])
    if not (likeness > _TURNING).any():
        return None
    first = int(np.argmax(likeness > _TURNING))
    return float(_TURNS_S[first + np.argmax(likeness[first : first + _PEAK])])


def _likeness(time_s: np.ndarray, bearing_rad: np.ndarray, turn: float) -> float:
    """Mean cosine of the residual for an antenna of this period; 0 with too few pairs."""
    one = np.linspace(0, len(time_s) - 1, _STARTS).astype(int)[:, np.newaxis]
    other = np.searchsorted(time_s, time_s[one] + turn * _LAGS)
    there = other < len(time_s)
    other = np.minimum(other, len(time_s) - 1)
    turns = (time_s[other] - time_s[one]) / turn
    chosen = there & (turns <= _MOST_TURNS)
    if chosen.mean() < _LEAST_SHARE:
        return 0.0
    miss_rad = bearing_rad[other] - bearing_rad[one] - 2.0 * np.pi * turns
    return float(np.cos(miss_rad[chosen]).mean())


def by_list(time_s: np.ndarray, listed_time_s: np.ndarray, listed_number: np.ndarray) -> np.ndarray:
    """Number (n,) of the listed scan nearest in time to each plot; the earlier of equals."""
    order = np.argsort(listed_time_s, kind="stable")
    return listed_number[order][nearest(listed_time_s[order], time_s)]


def nearest(sorted_time_s: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """Index (n,) of the nearest of the sorted times (m,), m > 0; the earlier of equals."""
    after = np.clip(np.searchsorted(sorted_time_s, time_s), 0, len(sorted_time_s) - 1)
    before = np.maximum(after - 1, 0)
    nearer = np.abs(sorted_time_s[before] - time_s) <= np.abs(sorted_time_s[after] - time_s)
    return np.where(nearer, before, after)


def grouped(names: np.ndarray) -> Iterator[tuple[Any, np.ndarray]]:
    """Each of the names or numbers (n,), in order of the first, with the indices of its rows."""
    unique, first, group = np.unique(names, return_index=True, return_inverse=True)
    rows = np.split(np.argsort(group, kind="stable"), np.cumsum(np.bincount(group))[:-1])
    for k in np.argsort(first).tolist():
        yield unique[k].item(), rows[k]


def unwrapped(number: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """Scan numbers (n,) that continue where a counter begins again; others as they are.

    The counter has the first of the usual ranges, such as 256, that holds all numbers. It begins
    again where, in order of time, the number falls by more than half of that range.
    """
    if len(number) == 0:
        return number
    order = np.argsort(time_s, kind="stable")
    step = np.diff(number[order], prepend=number[order[0]])
    modulus = next((count for count in _COUNTERS if count > number.max()), int(number.max()) + 1)
    turns = np.cumsum((step < -modulus // 2) * 1 - (step > modulus // 2))
    longer = np.empty_like(number)
    longer[order] = number[order] + turns * modulus
    falls, still_falls = (np.count_nonzero(np.diff(n[order]) < 0) for n in (number, longer))
    return longer if still_falls < falls and number.min() >= 0 else number


def out_of_order(number: np.ndarray, time_s: np.ndarray, *, within: bool) -> np.ndarray:
    """Mask (n,) of the fewest rows without which times increase with the scan numbers.

    With `within` rows of one scan may have different or equal times. None are marked if more than
    a tenth would be.
    """
    astray = np.zeros(len(number), dtype=bool)
    order = np.lexsort((time_s, number))
    keys = list(zip(time_s[order].tolist(), (-number[order] * within).tolist(), strict=True))
    if all(a <= b if within else a < b for a, b in itertools.pairwise(keys)):
        return astray
    ends: list[tuple] = []  # of the longest sequences of each length
    length = []
    for key in keys:
        place = bisect_right(ends, key) if within else bisect_left(ends, key)
        ends[place : place + 1] = [key]
        length.append(place + 1)
    left = len(ends)
    astray[:] = True
    for k in reversed(range(len(keys))):
        if length[k] == left:
            astray[order[k]], left = False, left - 1
    return astray & (np.count_nonzero(astray) <= MOST_BAD * len(astray))


def repeated(*columns: np.ndarray) -> np.ndarray:
    """Mask (n,) of rows equal to an earlier row in every column; NaN equals nothing."""
    order = np.lexsort(columns[::-1])
    same = np.ones(max(len(order) - 1, 0), dtype=bool)
    for column in columns:
        values = column[order]
        same &= values[1:] == values[:-1]
    mask = np.zeros(len(order), dtype=bool)
    mask[order[1:][same]] = True
    return mask
