"""
Assignment of plots to tracks.
"""
import numpy as np
from numpy.typing import ArrayLike, NDArray
__all__: list = ['assign', 'assign_sparse']
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
        Row and column of each pair, by row: the most pairs possible, at the least total cost.
    """
def assign_sparse(indptr: ArrayLike, indices: ArrayLike, data: ArrayLike, *, unassigned_cost: ArrayLike, columns: int) -> NDArray[np.int64]:
    """
    Optimal one-to-one assignment of gated pairs.
    
    Minimizes the costs of the pairs plus `unassigned_cost` of the unassigned rows. Pairs are given as
    the compressed rows of a sparse matrix, as in `scipy.sparse.csr_array`; other pairs are forbidden.
    
    Parameters
    ----------
    indptr : (rows + 1,) int array
        Row r has the candidates `indptr[r]` to `indptr[r + 1] - 1`.
    indices : (candidates,) int array
        Column of each candidate, at most once per row.
    data : (candidates,) array
        Cost of each candidate, of any sign; inf forbids it.
    unassigned_cost : float or (rows,) array
        Cost of an unassigned row.
    columns : int
    
    Returns
    -------
    (pairs, 2) int array
        Row and column of each pair, by row.
    """
