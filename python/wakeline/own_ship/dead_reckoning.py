"""Own ship's path by speed and heading alone."""

from __future__ import annotations

import numpy as np


def travelled_m(step_s: float | np.ndarray, velocity_mps: np.ndarray) -> np.ndarray:
    """North and east (T, 2) travelled since the first of T times.

    Parameters
    ----------
    step_s : float or ndarray (T - 1,)
        Between the times.
    velocity_mps : ndarray (T - 1, 2)
        Of each step.
    """
    steps_m = np.asarray(step_s)[..., np.newaxis] * velocity_mps
    return np.vstack([np.zeros((1, 2)), np.cumsum(steps_m, axis=0)])
