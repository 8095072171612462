"""Which plots make one scan, and what order scans have."""

from __future__ import annotations

import numpy as np

_GAP_PERIODS = 0.5
_SCAN_PERIODS = 0.95


def by_time(time_s: np.ndarray, period_s: float | None) -> np.ndarray:
    """Scan number of each plot from its time alone, counted from 0.

    Without a period, plots of equal time are one scan. With the period of a rotating antenna, a
    scan begins at a plot that comes more than half a period after the plot before it, or 95 % of a
    period or more after the first plot of its scan, so a target that is seen every turn comes once
    a scan although the antenna runs a little fast. Scans without plots cannot be seen from times.

    Parameters
    ----------
    time_s : ndarray (n,)
        Times of the plots, sorted.
    period_s : float or None
        Time of one antenna turn.

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
    """Index of the plot that begins the scan after the one that begins at `first`."""
    full = max(int(np.searchsorted(time_s, time_s[first] + _SCAN_PERIODS * period_s)), first + 1)
    gap = np.flatnonzero(begins[first + 1 : full])
    return first + 1 + int(gap[0]) if len(gap) else full


def by_list(time_s: np.ndarray, listed_time_s: np.ndarray, listed_number: np.ndarray) -> np.ndarray:
    """Number (n,) of the listed scan nearest in time to each plot; of equals the earlier."""
    order = np.argsort(listed_time_s, kind="stable")
    return listed_number[order][nearest(listed_time_s[order], time_s)]


def nearest(sorted_time_s: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """Index (n,) of the nearest of the sorted times (m,), m > 0; of equals the earlier."""
    after = np.clip(np.searchsorted(sorted_time_s, time_s), 0, len(sorted_time_s) - 1)
    before = np.maximum(after - 1, 0)
    nearer = np.abs(sorted_time_s[before] - time_s) <= np.abs(sorted_time_s[after] - time_s)
    return np.where(nearer, before, after)


def repeated(*columns: np.ndarray) -> np.ndarray:
    """Mask (n,) of rows equal in every column to a row before them; NaN equals nothing."""
    order = np.lexsort(columns[::-1])
    same = np.ones(max(len(order) - 1, 0), dtype=bool)
    for column in columns:
        values = column[order]
        same &= values[1:] == values[:-1]
    mask = np.zeros(len(order), dtype=bool)
    mask[order[1:][same]] = True
    return mask
