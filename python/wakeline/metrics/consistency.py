"""Consistency of errors and covariances over many runs."""

from __future__ import annotations

import numpy as np

from wakeline import eval
from wakeline._checks import plain_numbers, real_numbers, whole_number


def squared_distance(error: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """``e' inv(P) e`` of any number of errors, NaN where P is not positive definite.

    Parameters
    ----------
    error : array_like (..., N)
    covariance : array_like (..., N, N)
        Symmetric; its lower triangle is read.

    Returns
    -------
    ndarray (...)
        NEES for errors of estimates, NIS for innovations: chi-square with N degrees of freedom
        for a correct covariance.

    Raises
    ------
    ValueError
        When the shapes do not fit.
    """
    error, covariance = real_numbers("error", error), real_numbers("covariance", covariance)
    if error.ndim == 0 or covariance.shape != (*error.shape, error.shape[-1]):
        wanted = (*error.shape, *error.shape[-1:])
        raise ValueError(f"covariance must have shape {wanted}, got {covariance.shape}")
    states = error.shape[-1]
    lower: dict[tuple[int, int], np.ndarray] = {}
    whitened: list[np.ndarray] = []
    with np.errstate(invalid="ignore", divide="ignore"):
        for i in range(states):
            for j in range(i + 1):
                rest = covariance[..., i, j] - sum(lower[i, k] * lower[j, k] for k in range(j))
                if i == j:
                    lower[i, i] = np.sqrt(np.where(rest > 0, rest, np.nan))
                else:
                    lower[i, j] = rest / lower[j, j]
            left = error[..., i] - sum(lower[i, k] * whitened[k] for k in range(i))
            whitened.append(left / lower[i, i])
    return np.asarray(sum(w**2 for w in whitened))


def nees(error: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """Normalised estimation error squared, where every covariance must be right in form.

    Parameters
    ----------
    error : array_like (..., N)
        Estimate minus truth.
    covariance : array_like (..., N, N)
        Covariance of the estimate.

    Returns
    -------
    ndarray (...)
        As of :func:`squared_distance`.

    Raises
    ------
    ValueError
        When the shapes do not fit, a covariance is not positive definite or an error is NaN.
    """
    distance = squared_distance(error, covariance)
    if np.isnan(distance).any():
        raise ValueError("a covariance is not positive definite, or an error is NaN")
    return distance


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
