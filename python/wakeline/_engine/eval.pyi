"""
Whether an estimator tells the truth about its errors.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .measurement import ConvertedRangeBearing, Position, RangeBearing, RangeBearingDoppler

__all__ = ["consistency_bounds", "cramer_rao_bound"]

def consistency_bounds(confidence: float, dof: int, samples: int) -> tuple[float, float]:
    """
    (lower, upper) bounds of the average NEES or NIS of that many samples of a consistent estimator.
    """

def cramer_rao_bound(
    transition: ArrayLike,
    process_noise: ArrayLike,
    states: ArrayLike,
    sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
    start_covariance: ArrayLike,
    detection_probability: float = 1.0,
) -> NDArray[np.float64]:
    """
    The posterior Cramér-Rao bound of a vessel whose motion is known.

    `P' = F P Fᵀ + Q`, then `P'⁻¹ = P⁻¹ + p Hᵀ R⁻¹ H`, at the true states.

    Parameters
    ----------
    transition, process_noise : (T, 4, 4) array
        F and Q from the reading before to each reading; the first from the start.
    states : (T, 4) array
        True states [x, vx, y, vy] (m, m/s) at the readings; a row of NaN is a missed scan.
    sensor : RangeBearing, ConvertedRangeBearing, RangeBearingDoppler or Position
    start_covariance : (4, 4) array
        Covariance of the prior.
    detection_probability : float
        Chance p that a reading is made.

    Returns
    -------
    (T, 4, 4) array
        The covariance after each reading that no unbiased estimator beats.

    Raises
    ------
    ValueError
        When a shape does not fit, the prior is not positive definite or p is not from 0 to 1.
    FilterError
        When a step cannot be done.
    """
