"""
Beliefs, statuses, angles and the chi-square law.
"""

import enum
import typing

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "FilterError",
    "Gaussian",
    "Status",
    "Step",
    "chi_square_probability",
    "chi_square_quantile",
    "wrap_angle",
]

class FilterError(RuntimeError):
    """
    An estimator could not be started, predicted or updated; its belief is as it was.
    """

class Status(enum.IntEnum):
    """
    What became of one step: a number, as in the `status` of a run.
    """

    missed: typing.ClassVar[Status]
    negative_time_step: typing.ClassVar[Status]
    not_finite: typing.ClassVar[Status]
    not_positive_definite: typing.ClassVar[Status]
    not_started: typing.ClassVar[Status]
    ok: typing.ClassVar[Status]

class Gaussian:
    """
    A Gaussian belief.

    Parameters
    ----------
    mean : (N,) array
    covariance : (N, N) array
        Symmetric positive definite; checked when an estimator starts with it.

    Raises
    ------
    ValueError
        When the shapes do not fit.
    """
    def __getstate__(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def __init__(self, mean: ArrayLike, covariance: ArrayLike) -> None: ...
    def __setstate__(self, arg0: tuple) -> None: ...
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (N, N)
        """
    @property
    def mean(self) -> NDArray[np.float64]:
        """
        (N,)
        """

class Step:
    """
    What one measurement update has found; true where the reading was taken.
    """
    def __bool__(self) -> bool: ...
    def __getstate__(self) -> tuple[float, float]: ...
    def __setstate__(self, arg0: tuple) -> None: ...
    @property
    def innovation(self) -> NDArray[np.float64]:
        """
        (M,) measured minus predicted, angles wrapped
        """
    @property
    def innovation_covariance(self) -> NDArray[np.float64]:
        """
        (M, M)
        """
    @property
    def log_likelihood(self) -> float: ...
    @property
    def nis(self) -> float:
        """
        normalised innovation squared
        """
    @property
    def status(self) -> Status: ...

def chi_square_probability(value: float, dof: float) -> float:
    """
    Probability that a chi-square variable of `dof` degrees of freedom stays below `value`; NaN where there is no such law.
    """

def chi_square_quantile(probability: float, dof: float) -> float:
    """
    The value that a chi-square variable of `dof` degrees of freedom stays below with `probability`; NaN where there is none.
    """

def wrap_angle(angle_rad: ArrayLike) -> NDArray[np.float64]:
    """
    The same angle in [-pi, pi], rad; of an array each.
    """
