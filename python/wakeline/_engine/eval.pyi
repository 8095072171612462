"""
Whether an estimator tells the truth about its errors.
"""

__all__ = ["consistency_bounds"]

def consistency_bounds(confidence: float, dof: int, samples: int) -> tuple[float, float]:
    """
    (lower, upper) bounds of the average NEES or NIS of that many samples of a consistent estimator.
    """
