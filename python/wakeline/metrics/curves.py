"""Errors of many runs as curves over time, and figures of curves around switches of the truth.

A segment is the time between two switches; a plot exactly at a switch belongs to the
segment that ends there.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from wakeline._checks import at_least, plain_numbers, real_numbers, whole_number


@dataclass(frozen=True)
class SegmentFigures:
    """Figures of a curve over one segment.

    Attributes
    ----------
    begin_s, end_s : float
        The segment; the first begins, and the last ends, with the first and last plot.
    scans : int
        Number of plots in the segment.
    mean, peak : float
        In the unit of the curve.
    """

    begin_s: float
    end_s: float
    scans: int
    mean: float
    peak: float


def rmse_curve(error: np.ndarray) -> np.ndarray:
    """Root mean square length of the errors over runs, at each time.

    Parameters
    ----------
    error : array_like (R, T, d)
        Estimate minus truth of R runs, d components in one unit.

    Returns
    -------
    ndarray (T,)
        In the unit of the error.

    Raises
    ------
    ValueError
        When the shape is different or there is no run.
    """
    error = real_numbers("error", error)
    if error.ndim != 3 or not len(error):
        raise ValueError(f"error must have shape (R, T, d) with R at least 1, got {error.shape}")
    return np.sqrt(np.mean(np.sum(error**2, axis=-1), axis=0))


def by_segment(
    time_s: np.ndarray, curve: np.ndarray, switch_times_s: np.ndarray
) -> list[SegmentFigures]:
    """Mean and peak of a curve between switches.

    Parameters
    ----------
    time_s : array_like (T,)
        Increasing.
    curve : array_like (T,)
    switch_times_s : array_like (S,)
        Increasing.

    Returns
    -------
    list of SegmentFigures
        The segments with a plot, at most S + 1.

    Raises
    ------
    ValueError
        When the shapes do not fit, a curve is empty or times do not increase.
    """
    time_s, curve, switch_times_s = _checked(time_s, curve, switch_times_s)
    begin_s, end_s = float(time_s[0]), float(time_s[-1])
    cuts_s = [begin_s, *np.clip(switch_times_s, begin_s, end_s).tolist(), end_s]
    return [
        SegmentFigures(
            begin_s=cuts_s[k],
            end_s=cuts_s[k + 1],
            scans=part.stop - part.start,
            mean=float(np.mean(curve[part])),
            peak=float(np.max(curve[part])),
        )
        for k, part in enumerate(_parts(time_s, switch_times_s))
        if part.stop > part.start
    ]


def settling_times_s(
    time_s: np.ndarray, curve: np.ndarray, switch_times_s: np.ndarray, *, factor: float = 1.2
) -> np.ndarray:
    """Settling time of an error curve after each switch.

    The reference level of a segment is the median of the curve over its second half. The curve has
    settled at the first plot after which it remains at or below `factor` times that level until the
    segment ends. A segment in which it does not settle counts with its length up to its last plot,
    which is then a lower bound.

    Parameters
    ----------
    time_s : array_like (T,)
        Increasing.
    curve : array_like (T,)
        Such as an RMSE curve.
    switch_times_s : array_like (S,)
        Increasing.
    factor : float
        At least 1.

    Returns
    -------
    ndarray (S,)
        Seconds after the switch; 0 if the curve never exceeds the level, NaN for a segment without
        a plot.

    Raises
    ------
    ValueError
        As :func:`by_segment`, and when the factor is below 1.
    """
    at_least(1, factor=factor)
    time_s, curve, switch_times_s = _checked(time_s, curve, switch_times_s)
    settled_s = np.full(len(switch_times_s), np.nan)
    for k, part in enumerate(_parts(time_s, switch_times_s)[1:]):
        piece = curve[part]
        if not len(piece):
            continue
        restless = ~(piece <= factor * np.median(piece[len(piece) // 2 :]))
        first_calm = len(piece) - int(np.argmax(restless[::-1])) if restless.any() else 0
        at = min(first_calm, len(piece) - 1)
        settled_s[k] = time_s[part][at] - switch_times_s[k] if first_calm else 0.0
    return settled_s


def detection_delays_scans(
    time_s: np.ndarray,
    right_mode_share: np.ndarray,
    switch_times_s: np.ndarray,
    *,
    share: float = 0.5,
) -> np.ndarray:
    """Detection delay: scans after each switch until the right model is the most probable.

    Parameters
    ----------
    time_s : array_like (T,)
        Increasing.
    right_mode_share : array_like (T,)
        Share of the runs whose most probable model is the right one.
    switch_times_s : array_like (S,)
        Increasing.
    share : float
        Required share of the runs.

    Returns
    -------
    ndarray (S,)
        Plots after the switch before the share is reached: 0 if at once, all plots of a segment in
        which it is never reached, NaN for a segment without a plot.

    Raises
    ------
    ValueError
        As :func:`by_segment`, and when `share` is not within (0, 1].
    """
    plain_numbers(share=share)
    if not 0 < share <= 1:
        raise ValueError(f"share must be above 0 and at most 1, got {share}")
    time_s, right, switch_times_s = _checked(time_s, right_mode_share, switch_times_s)
    delays = np.full(len(switch_times_s), np.nan)
    for k, part in enumerate(_parts(time_s, switch_times_s)[1:]):
        found = right[part] >= share
        if len(found):
            delays[k] = np.argmax(found) if found.any() else len(found)
    return delays


def steady_scans(time_s: np.ndarray, switch_times_s: np.ndarray, *, scans: int = 3) -> np.ndarray:
    """The plots that are not directly after a switch.

    No causal estimator detects a switch before some plots have shown it; its consistency is judged
    at the other plots.

    Parameters
    ----------
    time_s : array_like (T,)
        Increasing.
    switch_times_s : array_like (S,)
        Increasing.
    scans : int
        Plots excluded after each switch.

    Returns
    -------
    ndarray of bool (T,)

    Raises
    ------
    ValueError
        When the times do not increase or `scans` is negative or no whole number.
    """
    whole_number("scans", scans, 0)
    time_s, _, switch_times_s = _checked(time_s, time_s, switch_times_s)
    steady = np.ones(len(time_s), dtype=bool)
    for part in _parts(time_s, switch_times_s)[1:]:
        steady[part.start : part.start + scans] = False
    return steady


def _parts(time_s: np.ndarray, switch_times_s: np.ndarray) -> list[slice]:
    """Plots of each of the S + 1 segments.

    A plot counts as at a switch if their times differ by no more than rounding.
    """
    tolerance_s = 1e-9 * (time_s[-1] - time_s[0]) + 8.0 * np.spacing(np.abs(time_s).max())
    cuts = np.searchsorted(time_s, switch_times_s + tolerance_s, side="right")
    edges = [0, *cuts.tolist(), len(time_s)]
    return [slice(a, b) for a, b in itertools.pairwise(edges)]


def _checked(
    time_s: np.ndarray, curve: np.ndarray, switch_times_s: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    time_s, curve = real_numbers("time_s", time_s), real_numbers("curve", curve)
    switch_times_s = real_numbers("switch_times_s", switch_times_s)
    if time_s.ndim != 1 or not len(time_s) or curve.shape != time_s.shape:
        raise ValueError(
            f"time_s and curve must have the same shape (T,), T at least 1, "
            f"got {time_s.shape} and {curve.shape}"
        )
    if switch_times_s.ndim != 1:
        raise ValueError(f"switch_times_s must have shape (S,), got {switch_times_s.shape}")
    for name, times in (("time_s", time_s), ("switch_times_s", switch_times_s)):
        if not (np.isfinite(times).all() and (np.diff(times) > 0).all()):
            raise ValueError(f"{name} must be finite and increase")
    return time_s, curve, switch_times_s
