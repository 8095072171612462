"""
Estimators with one motion model.
"""

import typing
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .core import Gaussian, Step
from .measurement import ConvertedRangeBearing, Position, RangeBearing, RangeBearingDoppler
from .motion import (
    ConstantAcceleration,
    ConstantVelocity,
    CoordinatedTurn,
    CoordinatedTurnRate,
    Singer,
    WanderingCourse,
)

__all__ = ["Ekf", "Filter", "Kalman", "RunResult", "SquareRootUkf", "Ukf", "one_point", "two_point"]

class RunResult:
    """
    What `run` returns: arrays over scans, and over runs where there are several.
    """
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (..., T, N, N)
        """
    @property
    def log_likelihood(self) -> NDArray[np.float64]:
        """
        (..., T)
        """
    @property
    def mean(self) -> NDArray[np.float64]:
        """
        (..., T, N)
        """
    @property
    def mode_probability(self) -> NDArray[np.float64] | None:
        """
        (..., T, K), None for a single filter
        """
    @property
    def nis(self) -> NDArray[np.float64]:
        """
        (..., T), NaN where there was no update
        """
    @property
    def status(self) -> NDArray[np.uint8]:
        """
        (..., T) values of Status
        """
    @property
    def turn_rate_rad_s(self) -> NDArray[np.float64]:
        """
        (..., T, K), of the models in each scan, NaN for one at rest; None where they do not change
        """

class Filter:
    """
    What Kalman, Ekf, Ukf and SquareRootUkf share.
    """
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def predict(self, dt_s: float, acceleration_mps2: ArrayLike | None = None) -> None:
        """
        Moves dt_s seconds on, under a known acceleration [north, east] where one is given; mode probabilities follow the chain.
        """
    def run(
        self,
        z: ArrayLike,
        dt_s: ArrayLike,
        sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
        start: Gaussian | Sequence[Gaussian],
        own_position_m: ArrayLike | None = None,
        acceleration_mps2: ArrayLike | None = None,
    ) -> RunResult:
        """
        Runs whole recordings.

        Parameters
        ----------
        z : (T, M) or (R, T, M) array
            Readings of one run or of R independent ones; a row of NaN is a missed scan.
        dt_s : float or (T,) array
            Time before each reading, s; the first counts from the start.
        sensor : RangeBearing, ConvertedRangeBearing, RangeBearingDoppler or Position
        start : Gaussian or sequence of R of them
            Belief one step before the first reading, over the filter's state or over [x, vx, y, vy].
        own_position_m : (T, 2) array, optional
            North and east of own ship at each reading.
        acceleration_mps2 : (T, 2) array, optional
            Known acceleration, north and east, in the step before each reading.

        Returns
        -------
        RunResult
            mean (..., T, N), covariance (..., T, N, N), mode_probability and turn_rate_rad_s (..., T, K), nis, log_likelihood
            and status (..., T).

        Raises
        ------
        ValueError
            When a shape does not fit.
        FilterError
            When an estimator cannot start. A step that fails later is marked in `status` and changes nothing.
        """
    def smooth(
        self, mean: ArrayLike, covariance: ArrayLike, dt_s: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """
        Rauch-Tung-Striebel smoother over the results of `run`.

        Parameters
        ----------
        mean : (T, N) array
        covariance : (T, N, N) array
        dt_s : float or (T,) array
            As for `run`.

        Returns
        -------
        (mean, covariance)
            Smoothed, same shapes.
        """
    def start(self, belief: Gaussian) -> None:
        """
        Begins with a belief over the state of the estimate or over [x, vx, y, vy].
        """
    def update(
        self,
        sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
        z: ArrayLike,
    ) -> Step:
        """
        Corrects the belief by a reading; returns the Step.
        """
    @property
    def started(self) -> bool: ...

class Kalman(Filter):
    """
    The Kalman filter: linear motion and linear sensors, nothing approximated.
    """
    @typing.overload
    def __init__(self, motion: ConstantVelocity) -> None: ...
    @typing.overload
    def __init__(self, motion: ConstantAcceleration) -> None: ...
    @typing.overload
    def __init__(self, motion: CoordinatedTurn) -> None: ...
    @typing.overload
    def __init__(self, motion: Singer) -> None: ...

class Ekf(Filter):
    """
    The extended Kalman filter: motion and sensor linearised about the mean.
    """
    @typing.overload
    def __init__(self, motion: ConstantVelocity) -> None: ...
    @typing.overload
    def __init__(self, motion: ConstantAcceleration) -> None: ...
    @typing.overload
    def __init__(self, motion: CoordinatedTurn) -> None: ...
    @typing.overload
    def __init__(self, motion: CoordinatedTurnRate) -> None: ...
    @typing.overload
    def __init__(self, motion: Singer) -> None: ...
    @typing.overload
    def __init__(self, motion: WanderingCourse) -> None: ...

class Ukf(Filter):
    """
    The unscented Kalman filter, with the scaled transform's alpha, beta and kappa.
    """
    @typing.overload
    def __init__(
        self, motion: ConstantVelocity, *, alpha: float = 1.0, beta: float = 2.0, kappa: float = 0.0
    ) -> None: ...
    @typing.overload
    def __init__(
        self,
        motion: ConstantAcceleration,
        *,
        alpha: float = 1.0,
        beta: float = 2.0,
        kappa: float = 0.0,
    ) -> None: ...
    @typing.overload
    def __init__(
        self, motion: CoordinatedTurn, *, alpha: float = 1.0, beta: float = 2.0, kappa: float = 0.0
    ) -> None: ...
    @typing.overload
    def __init__(
        self,
        motion: CoordinatedTurnRate,
        *,
        alpha: float = 1.0,
        beta: float = 2.0,
        kappa: float = 0.0,
    ) -> None: ...
    @typing.overload
    def __init__(
        self, motion: Singer, *, alpha: float = 1.0, beta: float = 2.0, kappa: float = 0.0
    ) -> None: ...
    @typing.overload
    def __init__(
        self, motion: WanderingCourse, *, alpha: float = 1.0, beta: float = 2.0, kappa: float = 0.0
    ) -> None: ...

class SquareRootUkf(Filter):
    """
    The unscented Kalman filter on a square root of the covariance, for long runs.
    """
    @typing.overload
    def __init__(
        self, motion: ConstantVelocity, *, alpha: float = 1.0, beta: float = 2.0, kappa: float = 0.0
    ) -> None: ...
    @typing.overload
    def __init__(
        self,
        motion: ConstantAcceleration,
        *,
        alpha: float = 1.0,
        beta: float = 2.0,
        kappa: float = 0.0,
    ) -> None: ...
    @typing.overload
    def __init__(
        self, motion: CoordinatedTurn, *, alpha: float = 1.0, beta: float = 2.0, kappa: float = 0.0
    ) -> None: ...
    @typing.overload
    def __init__(
        self,
        motion: CoordinatedTurnRate,
        *,
        alpha: float = 1.0,
        beta: float = 2.0,
        kappa: float = 0.0,
    ) -> None: ...
    @typing.overload
    def __init__(
        self, motion: Singer, *, alpha: float = 1.0, beta: float = 2.0, kappa: float = 0.0
    ) -> None: ...
    @typing.overload
    def __init__(
        self, motion: WanderingCourse, *, alpha: float = 1.0, beta: float = 2.0, kappa: float = 0.0
    ) -> None: ...

def one_point(
    sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
    z: ArrayLike,
    speed_std_mps: float,
) -> Gaussian:
    """
    Start over [x, vx, y, vy] from one plot and a velocity of zero with that standard deviation per axis.
    """

def two_point(
    sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
    first: ArrayLike,
    second: ArrayLike,
    dt_s: float,
) -> Gaussian:
    """
    Start over [x, vx, y, vy] from two plots dt_s apart.
    """
