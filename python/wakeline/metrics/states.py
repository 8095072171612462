"""Errors of state estimates: RMSE and the error figures of a score."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wakeline._checks import real_numbers
from wakeline._engine.core import wrap_angle

_COURSE_MIN_SPEED_MPS = 2.0


def rmse(error: np.ndarray, axis: int | tuple[int, ...] | None = None) -> np.ndarray | float:
    """Root mean square of errors over `axis`, over all of them by default."""
    return np.sqrt(np.mean(np.square(real_numbers("error", error)), axis=axis))


@dataclass(frozen=True)
class Errors:
    """Errors of matched states; a figure without states is None.

    Attributes
    ----------
    matched : int
        Number of states.
    position_rmse_m, position_median_m : float or None
        Root mean square and median of the distance to truth.
    position_rmse_debiased_m : float or None
        Root mean square distance after subtracting each target's mean error.
    mean_offset_north_m, mean_offset_east_m : float or None
        Mean position error.
    velocity_rmse_mps, speed_rmse_mps : float or None
        Root mean square length of the velocity error, and of the speed error.
    course_rms_deg : float or None
        Root mean square course error where the true speed is above 2 m/s.
    """

    matched: int = 0
    position_rmse_m: float | None = None
    position_median_m: float | None = None
    position_rmse_debiased_m: float | None = None
    mean_offset_north_m: float | None = None
    mean_offset_east_m: float | None = None
    velocity_rmse_mps: float | None = None
    speed_rmse_mps: float | None = None
    course_rms_deg: float | None = None


def errors_of(estimates: Sequence[np.ndarray], truths: Sequence[np.ndarray]) -> Errors:
    """Errors of the states of one or more targets, (K, 4) each."""
    pairs = [(e, t) for e, t in zip(estimates, truths, strict=True) if len(e)]
    if not pairs:
        return Errors()
    estimate, truth = (np.concatenate(states) for states in zip(*pairs, strict=True))
    error = estimate - truth
    offsets_m = [(e - t)[:, 0::2] for e, t in pairs]
    debiased_m = np.concatenate([offset - offset.mean(axis=0) for offset in offsets_m])
    distance_m = np.hypot(error[:, 0], error[:, 2])
    true_speed_mps = np.hypot(truth[:, 1], truth[:, 3])
    speed_error_mps = np.hypot(estimate[:, 1], estimate[:, 3]) - true_speed_mps
    turn = np.arctan2(estimate[:, 3], estimate[:, 1]) - np.arctan2(truth[:, 3], truth[:, 1])
    turn = wrap_angle(turn[true_speed_mps > _COURSE_MIN_SPEED_MPS])
    return Errors(
        matched=len(error),
        position_rmse_m=float(rmse(distance_m)),
        position_median_m=float(np.median(distance_m)),
        position_rmse_debiased_m=float(rmse(np.hypot(*debiased_m.T))),
        mean_offset_north_m=float(error[:, 0].mean()),
        mean_offset_east_m=float(error[:, 2].mean()),
        velocity_rmse_mps=float(rmse(np.hypot(error[:, 1], error[:, 3]))),
        speed_rmse_mps=float(rmse(speed_error_mps)),
        course_rms_deg=float(rmse(np.degrees(turn))) if len(turn) else None,
    )
