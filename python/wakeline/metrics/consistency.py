"""Consistency of errors and covariances, over many runs and in windows of one run."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from wakeline import eval
from wakeline._checks import plain_numbers, real_numbers, whole_number
from wakeline._engine.core import chi_square_quantile


def share_inside(
    curve: np.ndarray, dof: int, samples: int | np.ndarray, *, confidence: float = 0.95
) -> float:
    """Share of the scans whose average NEES or NIS is within its chi-square bounds.

    Parameters
    ----------
    curve : array_like (T,)
        Averages over independent runs; NaN counts as outside.
    dof : int
        Degrees of freedom of one value: states for NEES, numbers in a reading for NIS.
    samples : int or array_like (T,)
        Values averaged at each scan; scans without values are ignored.
    confidence : float
        Probability that a consistent estimator is inside.

    Returns
    -------
    float
        0 to 1; near `confidence` for a consistent estimator. NaN when no scan has a value.

    Raises
    ------
    ValueError
        When confidence or dof is invalid or the shapes do not fit.
    """
    curve, samples = real_numbers("curve", curve), real_numbers("samples", samples)
    plain_numbers(confidence=confidence)
    whole_number("dof", dof, 1)
    if curve.ndim != 1:
        raise ValueError(f"curve must have shape (T,), got {curve.shape}")
    counts = (samples == np.floor(samples)) & (samples >= 0) & (samples < np.inf)
    if samples.shape not in ((), curve.shape) or not counts.all():
        raise ValueError(
            f"samples must be integers, not negative, of shape () or {curve.shape}, "
            f"got {samples.tolist()}"
        )
    samples = np.broadcast_to(samples.astype(int), curve.shape)
    inside = np.zeros(curve.shape, dtype=bool)
    for count in np.unique(samples[samples > 0]).tolist():
        lower, upper = eval.consistency_bounds(confidence, dof, count)
        inside |= (samples == count) & (curve >= lower) & (curve <= upper)
    counted = int(np.count_nonzero(samples > 0))
    return float(np.count_nonzero(inside)) / counted if counted else float("nan")


@dataclass(frozen=True)
class WindowedNis:
    """Means of NIS over the last readings, with their chi-square bounds.

    Attributes
    ----------
    mean : ndarray (..., T)
        Of the last readings up to each scan; NaN before there are that many.
    lower, upper : float
        Bounds of the mean of a consistent estimator.
    """

    mean: np.ndarray
    lower: float
    upper: float

    @property
    def inside(self) -> np.ndarray:
        """Whether each mean is within the bounds, (..., T)."""
        return (self.mean >= self.lower) & (self.mean <= self.upper)


def windowed_nis(
    nis: np.ndarray, window: int = 20, *, dof: int = 2, confidence: float = 0.95
) -> WindowedNis:
    """Mean NIS of the last readings, to watch a filter or a track as it runs.

    Above the bounds, errors are larger than reported: a maneuver, a wrong sensor, or too little
    noise. Below them, the covariance is too large.

    Parameters
    ----------
    nis : array_like (..., T)
        Of `run`, or of one track (``tracks[track_id].nis``); scans without a reading are NaN, and
        the last readings before them count.
    window : int
        Number of readings.
    dof : int
        Numbers in a reading.
    confidence : float
        Probability that the mean of a consistent estimator is within the bounds.

    Raises
    ------
    ValueError
        When window, dof or confidence is invalid.

    References
    ----------
    Y. Bar-Shalom, X. R. Li, T. Kirubarajan, Estimation with Applications to Tracking and
    Navigation, 2001, section 5.4.
    """
    nis = np.atleast_1d(real_numbers("nis", nis))
    plain_numbers(confidence=confidence)
    whole_number("window", window, 1)
    whole_number("dof", dof, 1)
    lower, upper = eval.consistency_bounds(confidence, dof, window)
    mean = np.full(nis.shape, np.nan)
    for at in np.ndindex(nis.shape[:-1]):
        known = np.flatnonzero(np.isfinite(nis[at]))
        if len(known) < window:
            continue
        sums = np.convolve(nis[at][known], np.ones(window), mode="valid") / window
        last = np.searchsorted(known, np.arange(nis.shape[-1]), side="right") - window
        mean[at] = np.where(last >= 0, sums[np.maximum(last, 0)], np.nan)
    return WindowedNis(mean, float(lower), float(upper))


@dataclass(frozen=True)
class NisByMode:
    """Mean NIS of each mode, with its chi-square bounds.

    Attributes
    ----------
    mean : ndarray (K,)
        Of the readings, each weighted by the probability of the mode; NaN of a mode that there was
        not.
    lower, upper : ndarray (K,)
        Bounds of the mean of a consistent estimator.
    """

    mean: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


def nis_by_mode(
    nis: np.ndarray, mode_probability: np.ndarray, *, dof: int = 2, confidence: float = 0.95
) -> NisByMode:
    """Mean NIS while each mode was probable: which of the models has errors that are not as stated.

    Parameters
    ----------
    nis : array_like (...)
        Of runs or tracks; NaN of scans without a reading.
    mode_probability : array_like (..., K)
        Of the same scans.
    dof : int
        Numbers in a reading.
    confidence : float
        Probability that the mean of a consistent estimator is within the bounds.

    Raises
    ------
    ValueError
        When the shapes do not fit, or dof or confidence is invalid.

    References
    ----------
    As of :func:`windowed_nis`.

    Examples
    --------
    >>> import wakeline as wl
    >>> tracks = wl.track_recording("joyride")
    >>> wl.metrics.nis_by_mode(tracks.nis, tracks.mode_probability).mean.shape
    (7,)
    """
    nis = np.atleast_1d(real_numbers("nis", nis))
    weights = real_numbers("mode_probability", mode_probability)
    plain_numbers(confidence=confidence)
    whole_number("dof", dof, 1)
    if weights.ndim < 2 or weights.shape[:-1] != nis.shape:
        wanted = ", ".join([*map(str, nis.shape), "K"])
        raise ValueError(f"mode_probability must have shape ({wanted}), got {weights.shape}")
    known = np.isfinite(nis)
    nis, weights = nis[known], weights[known]
    total, squares = weights.sum(axis=0), (weights**2).sum(axis=0)
    mean, lower, upper = np.full((3, weights.shape[-1]), np.nan)
    for k in np.flatnonzero(total > 0.0).tolist():
        mean[k] = weights[:, k] @ nis / total[k]
        samples = max(total[k] ** 2 / squares[k], 1.0)
        lower[k], upper[k] = eval.consistency_bounds(confidence, dof, samples)
    return NisByMode(mean, lower, upper)


def whiteness(
    innovation: np.ndarray, lag: int = 1, *, confidence: float = 0.95
) -> tuple[float, float]:
    """Autocorrelation of the innovations of one run, and its bound.

    ``sum v_k . v_(k + lag) / sqrt(sum v_k . v_k  sum v_(k + lag) . v_(k + lag))`` over pairs of
    readings; innovations of a filter with the right model are white, so that it is 0 but for
    chance. Positive values are those of a filter that lags: too little process noise.

    Parameters
    ----------
    innovation : array_like (T, M)
        Of `run`; rows of scans without a reading are NaN. Divide components of different units by
        their standard deviations.
    lag : int
        In scans.
    confidence : float
        Probability that the value of white innovations is within the bound.

    Returns
    -------
    (value, bound)
        From -1 to 1, and the bound of its amount. NaN without two readings that far apart.

    Raises
    ------
    ValueError
        When a shape does not fit, or lag or confidence is invalid.

    References
    ----------
    As of :func:`windowed_nis`.
    """
    innovation = real_numbers("innovation", innovation)
    if innovation.ndim != 2:
        raise ValueError(f"innovation must have shape (T, M), got {innovation.shape}")
    plain_numbers(confidence=confidence)
    whole_number("lag", lag, 1)
    first, second = innovation[:-lag], innovation[lag:]
    both = np.isfinite(first).all(axis=1) & np.isfinite(second).all(axis=1)
    first, second = first[both], second[both]
    scale = math.sqrt(float(np.sum(first**2) * np.sum(second**2)))
    if len(first) < 2 or scale == 0.0:
        return math.nan, math.nan
    bound = math.sqrt(chi_square_quantile(confidence, 1) / first.size)
    return float(np.sum(first * second)) / scale, bound
