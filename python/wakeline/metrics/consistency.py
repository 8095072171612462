"""Consistency of errors and covariances over many runs."""

from __future__ import annotations

import numpy as np

from wakeline import eval
from wakeline._checks import plain_numbers, real_numbers, whole_number


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
