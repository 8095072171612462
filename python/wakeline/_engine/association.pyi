"""
Which plot is whose.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["assign", "assign_sparse"]

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

def assign_sparse(
    indptr: ArrayLike,
    indices: ArrayLike,
    data: ArrayLike,
    *,
    unassigned_cost: ArrayLike,
    columns: int,
) -> NDArray[np.int64]:
    """
    Optimal one-to-one assignment of gated pairs, each row at most one.

    Minimises the costs of the pairs plus `unassigned_cost` of the rows left out. Pairs are given as
    the compressed rows of a sparse matrix, as `scipy.sparse.csr_array` holds them; what is not there
    is forbidden.

    Parameters
    ----------
    indptr : (rows + 1,) int array
        Row r has the candidates `indptr[r]` to `indptr[r + 1] - 1`.
    indices : (candidates,) int array
        Column of each candidate, at most once a row.
    data : (candidates,) array
        Cost of each, of any sign; inf forbids it.
    unassigned_cost : float or (rows,) array
        What it costs to leave a row out.
    columns : int

    Returns
    -------
    (pairs, 2) int array
        Row and column of each pair, by row.
    """
