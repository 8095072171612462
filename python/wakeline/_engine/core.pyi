"""
Beliefs, statuses, angles and the chi-square distribution.
"""
import enum
import typing
import numpy as np
from numpy.typing import ArrayLike, NDArray
__all__: list = ['FilterError', 'Status', 'Gaussian', 'Step', 'wrap_angle', 'chi_square_quantile', 'chi_square_probability']
class FilterError(RuntimeError):
    """
    An estimator could not be started, predicted or updated; its belief is unchanged.
    """
class Status(enum.IntEnum):
    """
    Status of one step: a number, as in the `status` of a run.
    """
    gated: typing.ClassVar[Status]
    missed: typing.ClassVar[Status]
    negative_time_step: typing.ClassVar[Status]
    not_finite: typing.ClassVar[Status]
    not_positive_definite: typing.ClassVar[Status]
    not_started: typing.ClassVar[Status]
    ok: typing.ClassVar[Status]
    def __format__(self, format_spec: str) -> NDArray[np.float64]:
        ...
    def __str__(self) -> ...:
        ...
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
    def __copy__(self) -> Gaussian:
        ...
    def __deepcopy__(self, memo: dict) -> Gaussian:
        ...
    def __init__(self, mean: ArrayLike, covariance: ArrayLike) -> None:
        ...
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
    Result of a measurement update; true if the reading was accepted.
    """
    def __bool__(self) -> bool:
        ...
    def __getstate__(self) -> tuple[float, float]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
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
    def log_likelihood(self) -> float:
        ...
    @property
    def nis(self) -> float:
        """
        normalized innovation squared
        """
    @property
    def status(self) -> Status:
        ...
def chi_square_probability(value: float, dof: float) -> float:
    """
    Probability that a chi-square variable with `dof` degrees of freedom is below `value`; NaN for invalid arguments.
    """
def chi_square_quantile(probability: float, dof: float) -> float:
    """
    Chi-square quantile of `probability` with `dof` degrees of freedom; NaN for invalid arguments.
    """
def wrap_angle(angle_rad: ArrayLike) -> NDArray[np.float64]:
    """
    The angle wrapped to [-pi, pi], rad; elementwise for an array.
    """
