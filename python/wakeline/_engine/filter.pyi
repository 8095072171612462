"""
Estimators with one motion model.
"""

import typing
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .core import Gaussian, Step
from .gating import RadiusGate
from .measurement import ConvertedRangeBearing, Position, RangeBearing, RangeBearingDoppler
from .motion import (
    ConstantAcceleration,
    ConstantVelocity,
    CoordinatedTurn,
    CoordinatedTurnRate,
    ProcessNoise,
    Singer,
    WanderingCourse,
)

__all__ = [
    "AdaptiveAlphaBeta",
    "AdaptiveExponentialSmoother",
    "AlphaBeta",
    "AlphaBetaGamma",
    "AlphaBetaSmoother",
    "BenedictBordner",
    "ConstantGains",
    "CriticallyDamped",
    "Ekf",
    "ExponentialSmoother",
    "Filter",
    "GrowingMemory",
    "Kalman",
    "RangeDependent",
    "RecentMemory",
    "RunResult",
    "SquareRootUkf",
    "ThreePointSmoother",
    "TrackingIndex",
    "Ukf",
    "WindowBank",
    "one_point",
    "stable_gains",
    "three_point_rate",
    "two_point",
]

class RunResult:
    """
    What `run` returns: arrays over scans, and over runs where there are several.
    """
    def __getstate__(
        self,
    ) -> tuple[
        NDArray[np.float64],
        NDArray[np.float64],
        typing.Any,
        typing.Any,
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.uint8],
    ]: ...
    def __setstate__(self, arg0: tuple) -> None: ...
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (..., T, N, N)
        """
    @property
    def innovation(self) -> NDArray[np.float64]:
        """
        (..., T, M), measured minus predicted; NaN where there was no update
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
    def turn_rate_rad_s(self) -> NDArray[np.float64] | None:
        """
        (..., T, K), of the models in each scan, NaN for one at rest; None where they do not change
        """

class Filter:
    """
    What Kalman, Ekf, Ukf and SquareRootUkf share.
    """
    def __copy__(self) -> Filter: ...
    def __deepcopy__(self, memo: dict) -> Filter: ...
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def predict(self, dt_s: float, acceleration_mps2: ArrayLike | None = None) -> None:
        """
        Moves dt_s seconds on, under a known acceleration [north, east] where one is given; mode probabilities follow the chain.
        """
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def run(
        self,
        z: ArrayLike,
        dt_s: ArrayLike,
        sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
        start: Gaussian | Sequence[Gaussian],
        own_position_m: ArrayLike | None = None,
        own_velocity_mps: ArrayLike | None = None,
        acceleration_mps2: ArrayLike | None = None,
        gate: RadiusGate | None = None,
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
        own_velocity_mps : (T, 2) array, optional
            Her velocity over ground at each reading, which range rates are measured from.
        acceleration_mps2 : (T, 2) array, optional
            Known acceleration, north and east, in the step before each reading.
        gate : RadiusGate, optional
            A reading farther from the predicted position is missed.

        Returns
        -------
        RunResult
            mean (..., T, N), covariance (..., T, N, N), innovation (..., T, M), nis, log_likelihood and
            status (..., T); mode_probability (..., T, K) of several models and turn_rate_rad_s (..., T, K)
            of models that change theirs, else None.

        Raises
        ------
        ValueError
            When a shape does not fit, or a sensor of range rates moves and its velocity is not told.
        FilterError
            When an estimator cannot start. A step that fails later is marked in `status`: a reading that
            cannot be taken leaves the prediction, a `dt_s` that cannot leaves all as it was.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """
    def smooth(
        self,
        mean: ArrayLike,
        covariance: ArrayLike,
        dt_s: ArrayLike,
        acceleration_mps2: ArrayLike | None = None,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """
        Rauch-Tung-Striebel smoother over the results of `run`.

        Parameters
        ----------
        mean : (T, N) array
        covariance : (T, N, N) array
        dt_s : float or (T,) array
        acceleration_mps2 : (T, 2) array, optional
            As for `run`.

        Returns
        -------
        (mean, covariance)
            Smoothed, same shapes.

        Raises
        ------
        ValueError
            When a shape does not fit.
        FilterError
            When a covariance is not positive definite, a number not finite or a step below zero.
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
    def __copy__(self) -> Kalman: ...
    def __deepcopy__(self, memo: dict) -> Kalman: ...
    @typing.overload
    def __init__(self, motion: ConstantVelocity) -> None: ...
    @typing.overload
    def __init__(self, motion: ConstantAcceleration) -> None: ...
    @typing.overload
    def __init__(self, motion: CoordinatedTurn) -> None: ...
    @typing.overload
    def __init__(self, motion: Singer) -> None: ...
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """

class Ekf(Filter):
    """
    The extended Kalman filter: motion and sensor linearised about the mean.
    """
    def __copy__(self) -> Ekf: ...
    def __deepcopy__(self, memo: dict) -> Ekf: ...
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
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """

class Ukf(Filter):
    """
    The unscented Kalman filter, with the scaled transform's alpha, beta and kappa.
    """
    def __copy__(self) -> Ukf: ...
    def __deepcopy__(self, memo: dict) -> Ukf: ...
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
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """

class SquareRootUkf(Filter):
    """
    The unscented Kalman filter on a square root of the covariance, for long runs.
    """
    def __copy__(self) -> SquareRootUkf: ...
    def __deepcopy__(self, memo: dict) -> SquareRootUkf: ...
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
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """

class ConstantGains:
    """
    Gains that stay the same; gamma for an alpha-beta-gamma filter only. A filter refuses those that are not stable.
    """
    def __copy__(self) -> ConstantGains: ...
    def __deepcopy__(self, memo: dict) -> ConstantGains: ...
    def __init__(self, alpha: float, beta: float, gamma: float = 0.0) -> None: ...
    def gains(
        self,
        order: int = 2,
        *,
        reading: int = 1,
        elapsed_s: float = 1.0,
        std_m: float = 1.0,
        range_m: float = 0.0,
    ) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the one before, of error `std_m` along the axis, at a range.
        """
    @property
    def alpha(self) -> float: ...
    @property
    def beta(self) -> float: ...
    @property
    def gamma(self) -> float: ...

class GrowingMemory:
    """
    Gains that draw the least-squares line (or parabola) through all readings so far.

    With regular steps the filter equals that line exactly, whatever the start. A missed scan does not count.

    Parameters
    ----------
    plots_before : int
        That the start was made of.
    max_plots : int
        The gains stay those of so many; 0 for all.
    """
    def __copy__(self) -> GrowingMemory: ...
    def __deepcopy__(self, memo: dict) -> GrowingMemory: ...
    def __init__(self, *, plots_before: int = 0, max_plots: int = 0) -> None: ...
    def gains(
        self,
        order: int = 2,
        *,
        reading: int = 1,
        elapsed_s: float = 1.0,
        std_m: float = 1.0,
        range_m: float = 0.0,
    ) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the one before, of error `std_m` along the axis, at a range.
        """
    @property
    def max_plots(self) -> int: ...
    @property
    def plots_before(self) -> int: ...

class BenedictBordner:
    """
    beta = alpha² / (2 - alpha): the least error after a change of velocity for the noise that an alpha lets through.
    """
    def __copy__(self) -> BenedictBordner: ...
    def __deepcopy__(self, memo: dict) -> BenedictBordner: ...
    def __init__(self, alpha: float) -> None: ...
    def gains(
        self,
        order: int = 2,
        *,
        reading: int = 1,
        elapsed_s: float = 1.0,
        std_m: float = 1.0,
        range_m: float = 0.0,
    ) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the one before, of error `std_m` along the axis, at a range.
        """
    @property
    def alpha(self) -> float: ...

class CriticallyDamped:
    """
    All poles at theta: the least-squares line or parabola with weights theta a reading back (fading memory).
    """
    def __copy__(self) -> CriticallyDamped: ...
    def __deepcopy__(self, memo: dict) -> CriticallyDamped: ...
    def __init__(self, theta: float) -> None: ...
    def gains(
        self,
        order: int = 2,
        *,
        reading: int = 1,
        elapsed_s: float = 1.0,
        std_m: float = 1.0,
        range_m: float = 0.0,
    ) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the one before, of error `std_m` along the axis, at a range.
        """
    @property
    def theta(self) -> float: ...

class TrackingIndex:
    """
    Gains of the steady Kalman filter, by the tracking index: accel_std T² / error of the reading.

    The error is that of each reading along and across the bearing, so that the gains follow the range by themselves; the index follows
    the step.

    Parameters
    ----------
    accel_std_mps2 : float
        Of the acceleration (with three states: its change) drawn anew for each step.

    References
    ----------
    P. R. Kalata, The tracking index: a generalized parameter for alpha-beta and alpha-beta-gamma target trackers, IEEE Trans. AES-20,
    1984.
    """
    def __copy__(self) -> TrackingIndex: ...
    def __deepcopy__(self, memo: dict) -> TrackingIndex: ...
    def __init__(self, accel_std_mps2: float) -> None: ...
    def gains(
        self,
        order: int = 2,
        *,
        reading: int = 1,
        elapsed_s: float = 1.0,
        std_m: float = 1.0,
        range_m: float = 0.0,
    ) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the one before, of error `std_m` along the axis, at a range.
        """
    def steady_covariance(
        self, period_s: float, std_m: float, order: int = 2
    ) -> NDArray[np.float64]:
        """
        (order, order) covariance of the states of one axis after an update, in the steady state.
        """
    @property
    def accel_std_mps2(self) -> float: ...

class RangeDependent:
    """
    Gains by the range alone, as a radar plotting aid has them: beyond `near_range_m` in inverse proportion to the range, down to those of `far`.
    """
    def __copy__(self) -> RangeDependent: ...
    def __deepcopy__(self, memo: dict) -> RangeDependent: ...
    def __init__(
        self,
        *,
        near_range_m: float = 20000.0,
        near_alpha: float = 0.5,
        near_beta: float = 0.2,
        far_alpha: float = 0.2,
        far_beta: float = 0.01,
    ) -> None: ...
    def gains(
        self,
        order: int = 2,
        *,
        reading: int = 1,
        elapsed_s: float = 1.0,
        std_m: float = 1.0,
        range_m: float = 0.0,
    ) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the one before, of error `std_m` along the axis, at a range.
        """
    @property
    def far_alpha(self) -> float: ...
    @property
    def far_beta(self) -> float: ...
    @property
    def near_alpha(self) -> float: ...
    @property
    def near_beta(self) -> float: ...
    @property
    def near_range_m(self) -> float: ...

class AlphaBeta:
    """
    The alpha-beta filter over [x, vx, y, vy], its gains by a schedule.

    ``x += alpha e`` and ``vx += beta e / T`` per axis, e the innovation in north and east and T the time since the reading before,
    missed scans included; readings within an eighth of a step are of one time and have one T. Covariance, NIS and likelihood are those
    of such gains where plots and motion are as the models say, so that it may be compared with a Kalman filter. Takes the position out
    of any sensor.

    Parameters
    ----------
    gains : ConstantGains, GrowingMemory, BenedictBordner, CriticallyDamped, TrackingIndex or RangeDependent
    noise : ProcessNoise, optional
        Of a constant velocity, for the covariance; when left out that which a tracking index stands for, else `WhiteAcceleration()`.

    Raises
    ------
    ValueError
        When a parameter makes no sense or gains are not stable.
    """
    def __copy__(self) -> AlphaBeta: ...
    def __deepcopy__(self, memo: dict) -> AlphaBeta: ...
    def __init__(
        self,
        gains: ConstantGains
        | GrowingMemory
        | BenedictBordner
        | CriticallyDamped
        | TrackingIndex
        | RangeDependent,
        *,
        noise: ProcessNoise | None = None,
    ) -> None: ...
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def predict(self, dt_s: float, acceleration_mps2: ArrayLike | None = None) -> None:
        """
        Moves dt_s seconds on, under a known acceleration [north, east] where one is given; mode probabilities follow the chain.
        """
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def run(
        self,
        z: ArrayLike,
        dt_s: ArrayLike,
        sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
        start: Gaussian | Sequence[Gaussian],
        own_position_m: ArrayLike | None = None,
        own_velocity_mps: ArrayLike | None = None,
        acceleration_mps2: ArrayLike | None = None,
        gate: RadiusGate | None = None,
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
        own_velocity_mps : (T, 2) array, optional
            Her velocity over ground at each reading, which range rates are measured from.
        acceleration_mps2 : (T, 2) array, optional
            Known acceleration, north and east, in the step before each reading.
        gate : RadiusGate, optional
            A reading farther from the predicted position is missed.

        Returns
        -------
        RunResult
            mean (..., T, N), covariance (..., T, N, N), innovation (..., T, M), nis, log_likelihood and
            status (..., T); mode_probability (..., T, K) of several models and turn_rate_rad_s (..., T, K)
            of models that change theirs, else None.

        Raises
        ------
        ValueError
            When a shape does not fit, or a sensor of range rates moves and its velocity is not told.
        FilterError
            When an estimator cannot start. A step that fails later is marked in `status`: a reading that
            cannot be taken leaves the prediction, a `dt_s` that cannot leaves all as it was.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
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

class AlphaBetaGamma:
    """
    The alpha-beta-gamma filter over [x, vx, ax, y, vy, ay], its gains by a schedule.

    As `AlphaBeta`, and ``ax += gamma e / (2 T²)``.

    Parameters
    ----------
    gains : ConstantGains, GrowingMemory, CriticallyDamped or TrackingIndex
    noise : ProcessNoise, optional
        Of a constant acceleration, for the covariance; when left out that which a tracking index stands for, else `WhiteJerk()`.
    prior_accel_std_mps2 : float
        What a start without acceleration assumes of it.

    Raises
    ------
    ValueError
        When a parameter makes no sense or gains are not stable.
    """
    def __copy__(self) -> AlphaBetaGamma: ...
    def __deepcopy__(self, memo: dict) -> AlphaBetaGamma: ...
    def __init__(
        self,
        gains: ConstantGains | GrowingMemory | CriticallyDamped | TrackingIndex,
        *,
        noise: ProcessNoise | None = None,
        prior_accel_std_mps2: float = 1.0,
    ) -> None: ...
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def predict(self, dt_s: float, acceleration_mps2: ArrayLike | None = None) -> None:
        """
        Moves dt_s seconds on, under a known acceleration [north, east] where one is given; mode probabilities follow the chain.
        """
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def run(
        self,
        z: ArrayLike,
        dt_s: ArrayLike,
        sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
        start: Gaussian | Sequence[Gaussian],
        own_position_m: ArrayLike | None = None,
        own_velocity_mps: ArrayLike | None = None,
        acceleration_mps2: ArrayLike | None = None,
        gate: RadiusGate | None = None,
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
        own_velocity_mps : (T, 2) array, optional
            Her velocity over ground at each reading, which range rates are measured from.
        acceleration_mps2 : (T, 2) array, optional
            Known acceleration, north and east, in the step before each reading.
        gate : RadiusGate, optional
            A reading farther from the predicted position is missed.

        Returns
        -------
        RunResult
            mean (..., T, N), covariance (..., T, N, N), innovation (..., T, M), nis, log_likelihood and
            status (..., T); mode_probability (..., T, K) of several models and turn_rate_rad_s (..., T, K)
            of models that change theirs, else None.

        Raises
        ------
        ValueError
            When a shape does not fit, or a sensor of range rates moves and its velocity is not told.
        FilterError
            When an estimator cannot start. A step that fails later is marked in `status`: a reading that
            cannot be taken leaves the prediction, a `dt_s` that cannot leaves all as it was.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
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

class ExponentialSmoother:
    """
    Exponential smoothing: x^ += alpha (x - x^), whatever the time step; (21).

    Its forecast is its value.

    Parameters
    ----------
    alpha : float
        Above 0 and at most 1.
    wrapped : bool
        Readings are angles, radians: values are in -pi .. pi.
    """
    def __copy__(self) -> ExponentialSmoother: ...
    def __deepcopy__(self, memo: dict) -> ExponentialSmoother: ...
    def __init__(self, alpha: float = 0.5, *, wrapped: bool = False) -> None: ...
    def forecast(self, ahead_s: float) -> float:
        """
        The value `ahead_s` after the newest reading.
        """
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def run(
        self, dt_s: ArrayLike, reading: ArrayLike, *, ahead_s: float = 0.0
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """
        Smooths series of readings, each from a fresh start.

        Parameters
        ----------
        dt_s : float or (T,) array
            Steps to the readings; the first one means nothing.
        reading : (..., T) array
            NaN where one is missing: time goes on.
        ahead_s : float
            How far to foretell.

        Returns
        -------
        (value, rate, forecast)
            Each (..., T): after each reading, and `ahead_s` later; where one is missing, foretold to its
            time. NaN before the first reading.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """
    def update(self, dt_s: float, reading: float) -> None:
        """
        Takes a reading, `dt_s` after the one before; the step of the first means nothing.
        """
    @property
    def alpha(self) -> float:
        """
        the gain last used
        """
    @property
    def rate(self) -> float:
        """
        of the value, per second
        """
    @property
    def value(self) -> float:
        """
        NaN before the first reading
        """

class AdaptiveExponentialSmoother:
    """
    Exponential smoothing whose alpha is the part of a jump that the line through the last five readings follows; (23).

    Parameters
    ----------
    wrapped : bool
        Readings are angles, radians: values are in -pi .. pi.
    """
    def __copy__(self) -> AdaptiveExponentialSmoother: ...
    def __deepcopy__(self, memo: dict) -> AdaptiveExponentialSmoother: ...
    def __init__(self, *, wrapped: bool = False) -> None: ...
    def forecast(self, ahead_s: float) -> float:
        """
        The value `ahead_s` after the newest reading.
        """
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def run(
        self, dt_s: ArrayLike, reading: ArrayLike, *, ahead_s: float = 0.0
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """
        Smooths series of readings, each from a fresh start.

        Parameters
        ----------
        dt_s : float or (T,) array
            Steps to the readings; the first one means nothing.
        reading : (..., T) array
            NaN where one is missing: time goes on.
        ahead_s : float
            How far to foretell.

        Returns
        -------
        (value, rate, forecast)
            Each (..., T): after each reading, and `ahead_s` later; where one is missing, foretold to its
            time. NaN before the first reading.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """
    def update(self, dt_s: float, reading: float) -> None:
        """
        Takes a reading, `dt_s` after the one before; the step of the first means nothing.
        """
    @property
    def alpha(self) -> float:
        """
        the gain last used
        """
    @property
    def rate(self) -> float:
        """
        of the value, per second
        """
    @property
    def value(self) -> float:
        """
        NaN before the first reading
        """

class ThreePointSmoother:
    """
    Each reading smoothed by its neighbours, at uneven steps; (22), (24), (25).

    The value and the rate are those at the reading before the newest. A reading of the time of the one before joins it: both become
    their mean.

    Parameters
    ----------
    weight_before_s, weight_after_s : float
        p: at this step a neighbour counts as much as the reading itself.
    adaptive : bool
        Weights by least squares over five readings instead; (24).
    parabola : bool
        The rate is exact for a parabola at any steps, else by Simpson's weights; (25).
    wrapped : bool
        Readings are angles, radians: values are in -pi .. pi.

    Raises
    ------
    ValueError
        When a weight is negative.
    """
    def __copy__(self) -> ThreePointSmoother: ...
    def __deepcopy__(self, memo: dict) -> ThreePointSmoother: ...
    def __init__(
        self,
        *,
        weight_before_s: float = 1.0,
        weight_after_s: float = 1.0,
        adaptive: bool = False,
        parabola: bool = True,
        wrapped: bool = False,
    ) -> None: ...
    def forecast(self, ahead_s: float) -> float:
        """
        The value `ahead_s` after the newest reading.
        """
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def run(
        self, dt_s: ArrayLike, reading: ArrayLike, *, ahead_s: float = 0.0
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """
        Smooths series of readings, each from a fresh start.

        Parameters
        ----------
        dt_s : float or (T,) array
            Steps to the readings; the first one means nothing.
        reading : (..., T) array
            NaN where one is missing: time goes on.
        ahead_s : float
            How far to foretell.

        Returns
        -------
        (value, rate, forecast)
            Each (..., T): after each reading, and `ahead_s` later; where one is missing, foretold to its
            time. NaN before the first reading.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """
    def update(self, dt_s: float, reading: float) -> None:
        """
        Takes a reading, `dt_s` after the one before; the step of the first means nothing.
        """
    @property
    def delay_s(self) -> float:
        """
        from the time of the value to the newest reading
        """
    @property
    def rate(self) -> float:
        """
        of the value, per second
        """
    @property
    def value(self) -> float:
        """
        NaN before the first reading
        """

class RecentMemory:
    """
    Gains that draw the least-squares line through all readings with weights 1, 2, 3, ...; (29).

    Parameters
    ----------
    max_plots : int
        The gains stay those of so many; 0 for all.
    """
    def __copy__(self) -> RecentMemory: ...
    def __deepcopy__(self, memo: dict) -> RecentMemory: ...
    def __init__(self, *, max_plots: int = 0) -> None: ...
    def gains(self, *, reading: int = 1) -> NDArray[np.float64]:
        """
        [alpha, beta] for the reading-th reading.
        """
    @property
    def max_plots(self) -> int: ...

class AlphaBetaSmoother:
    """
    One quantity by an alpha-beta filter whose gains follow a schedule; (26)-(30).

    Parameters
    ----------
    gains : GrowingMemory, RecentMemory, RangeDependent, ConstantGains, BenedictBordner, CriticallyDamped or TrackingIndex
        (27) is `GrowingMemory()`, (28) `GrowingMemory(plots_before=1)`, (29) `RecentMemory()`, (30) `RangeDependent()`.
    wrapped : bool
        Readings are angles, radians: values are in -pi .. pi.
    reading_std : float
        Error of a reading in its own unit, for a `TrackingIndex`.

    Raises
    ------
    ValueError
        When a parameter makes no sense or gains are not stable.
    """
    def __copy__(self) -> AlphaBetaSmoother: ...
    def __deepcopy__(self, memo: dict) -> AlphaBetaSmoother: ...
    def __init__(
        self,
        gains: ConstantGains
        | GrowingMemory
        | BenedictBordner
        | CriticallyDamped
        | TrackingIndex
        | RangeDependent
        | RecentMemory = ...,
        *,
        wrapped: bool = False,
        reading_std: float = 1.0,
    ) -> None: ...
    def forecast(self, ahead_s: float) -> float:
        """
        The value `ahead_s` after the newest reading.
        """
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def run(
        self, dt_s: ArrayLike, reading: ArrayLike, *, ahead_s: float = 0.0, range_m: float = 0.0
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """
        Smooths series of readings, each from a fresh start.

        Parameters
        ----------
        dt_s : float or (T,) array
            Steps to the readings; the first one means nothing.
        reading : (..., T) array
            NaN where one is missing: time goes on.
        ahead_s : float
            How far to foretell.

        Returns
        -------
        (value, rate, forecast)
            Each (..., T): after each reading, and `ahead_s` later; where one is missing, foretold to its
            time. NaN before the first reading.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """
    def update(self, dt_s: float, reading: float, *, range_m: float = 0.0) -> None:
        """
        Takes a reading, `dt_s` after the one before, of an object at a range.
        """
    @property
    def rate(self) -> float:
        """
        of the value, per second
        """
    @property
    def value(self) -> float:
        """
        NaN before the first reading
        """

class AdaptiveAlphaBeta:
    """
    The adaptive alpha-beta filter, in two passes over the last five readings; (33).

    The first pass has the gains of a growing memory, the second those that ``alpha = sum((x^ - x~) e) / sum(e²)`` and
    ``beta = sum(dv e/t) / sum((e/t)²)`` make of it. A reading of the time of the one before joins it: both become their mean.

    Parameters
    ----------
    wrapped : bool
        Readings are angles, radians: values are in -pi .. pi.
    """
    def __copy__(self) -> AdaptiveAlphaBeta: ...
    def __deepcopy__(self, memo: dict) -> AdaptiveAlphaBeta: ...
    def __init__(self, *, wrapped: bool = False) -> None: ...
    def forecast(self, ahead_s: float) -> float:
        """
        The value `ahead_s` after the newest reading.
        """
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def run(
        self, dt_s: ArrayLike, reading: ArrayLike, *, ahead_s: float = 0.0
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """
        Smooths series of readings, each from a fresh start.

        Parameters
        ----------
        dt_s : float or (T,) array
            Steps to the readings; the first one means nothing.
        reading : (..., T) array
            NaN where one is missing: time goes on.
        ahead_s : float
            How far to foretell.

        Returns
        -------
        (value, rate, forecast)
            Each (..., T): after each reading, and `ahead_s` later; where one is missing, foretold to its
            time. NaN before the first reading.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """
    def update(self, dt_s: float, reading: float) -> None:
        """
        Takes a reading, `dt_s` after the one before; the step of the first means nothing.
        """
    @property
    def alpha(self) -> float:
        """
        the gain last used
        """
    @property
    def beta(self) -> float:
        """
        the gain of the rate last used
        """
    @property
    def rate(self) -> float:
        """
        of the value, per second
        """
    @property
    def value(self) -> float:
        """
        NaN before the first reading
        """

class WindowBank:
    """
    The least-squares lines through the last 2, 3, ... readings, of which that one speaks that has foretold the readings best.

    Short windows follow a maneuver, long ones rest in between; nothing has to be tuned to the noise or to the maneuvers.
    A reading of the time of the one before joins it, and judges no line: both become their mean.

    Parameters
    ----------
    max_readings : int
        Of the longest window, 2 to 32.
    memory : float
        What the energy of a window's innovations keeps of itself at each reading.
    wrapped : bool
        Readings are angles, radians: values are in -pi .. pi.

    Raises
    ------
    ValueError
        When a setting makes no sense.
    """
    def __copy__(self) -> WindowBank: ...
    def __deepcopy__(self, memo: dict) -> WindowBank: ...
    def __init__(
        self, *, max_readings: int = 32, memory: float = 0.92, wrapped: bool = False
    ) -> None: ...
    def forecast(self, ahead_s: float) -> float:
        """
        The value `ahead_s` after the newest reading.
        """
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def run(
        self, dt_s: ArrayLike, reading: ArrayLike, *, ahead_s: float = 0.0
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """
        Smooths series of readings, each from a fresh start.

        Parameters
        ----------
        dt_s : float or (T,) array
            Steps to the readings; the first one means nothing.
        reading : (..., T) array
            NaN where one is missing: time goes on.
        ahead_s : float
            How far to foretell.

        Returns
        -------
        (value, rate, forecast)
            Each (..., T): after each reading, and `ahead_s` later; where one is missing, foretold to its
            time. NaN before the first reading.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """
    def update(self, dt_s: float, reading: float) -> None:
        """
        Takes a reading, `dt_s` after the one before; the step of the first means nothing.
        """
    @property
    def rate(self) -> float:
        """
        of the value, per second
        """
    @property
    def value(self) -> float:
        """
        NaN before the first reading
        """
    @property
    def window(self) -> int:
        """
        readings of the window that speaks
        """

def one_point(
    sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
    z: ArrayLike,
    speed_std_mps: float,
) -> Gaussian:
    """
    Start over [x, vx, y, vy] from one plot and a velocity of zero with that standard deviation per axis.
    """

def stable_gains(alpha: float, beta: float, gamma: float | None = None) -> bool:
    """
    Whether a filter of these gains forgets its errors: alpha > 0, beta > 0, 2 alpha + beta < 4 and, with gamma, 0 < gamma < 4 alpha beta / (2 - alpha).
    """

def three_point_rate(
    before: ArrayLike,
    at: ArrayLike,
    after: ArrayLike,
    before_s: ArrayLike,
    after_s: ArrayLike,
    *,
    parabola: bool = True,
) -> NDArray[np.float64]:
    """
    Derivative at the middle of three readings at uneven steps; (25).

    Parameters
    ----------
    before, at, after : array_like
        The readings.
    before_s, after_s : array_like
        The steps between them, positive.
    parabola : bool
        b + f - c, exact for a parabola, else 2/3 c + (b + f) / 6, of less noise; b, f and c the slopes before, after and over all.
    """

def two_point(
    sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
    first: ArrayLike,
    second: ArrayLike,
    dt_s: float,
) -> Gaussian:
    """
    Start over [x, vx, y, vy] from two plots dt_s apart. The own ship of the sensor is where the second one was taken, to which it has come at its velocity.
    """
