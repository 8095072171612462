"""
Which plot is whose.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["assign"]

def assign(cost: ArrayLike) -> NDArray[np.int64]:
    """
    Optimal one-to-one assignment.

    Parameters
    ----------
    cost : (rows, columns) array
        Any finite costs; inf forbids a pair.

    Returns
    -------
    (pairs, 2) int array
        Row and column of each pair, by row: as many pairs as can be, then the least total cost.
    """
