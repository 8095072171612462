"""
Estimators with one motion model.
"""
from collections.abc import Sequence
import typing
import numpy as np
from numpy.typing import ArrayLike, NDArray
from .core import Gaussian, Step
from .measurement import ConvertedRangeBearing, Position, RangeBearing, RangeBearingDoppler
from .gating import ChiSquareGate, RadiusGate
from .motion import ConstantAcceleration, ConstantVelocity, CoordinatedTurn, CoordinatedTurnRate, ProcessNoise, Singer, WanderingCourse
__all__: list = ['RunResult', 'Filter', 'Kalman', 'Ekf', 'Ukf', 'SquareRootUkf', 'Estimator', 'one_point', 'two_point', 'ConstantGains', 'GrowingMemory', 'BenedictBordner', 'CriticallyDamped', 'TrackingIndex', 'RangeDependent', 'RecentMemory', 'AdaptiveGains', 'stable_gains', 'AlphaBeta', 'AlphaBetaGamma', 'ExponentialSmoother', 'AdaptiveExponentialSmoother', 'ThreePointSmoother', 'three_point_rate', 'AlphaBetaSmoother', 'AdaptiveAlphaBeta', 'WindowBank']
class RunResult:
    """
    What `run` returns: arrays over scans, and over runs where there are several.
    """
    def __getstate__(self) -> tuple[NDArray[np.float64], NDArray[np.float64], typing.Any, typing.Any, NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.uint8], int]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
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
    def lanes(self) -> int:
        """
        how many filters were stepped side by side in one register: recordings, or hypotheses of a ModeHistory; 1 for one after the other
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
    Common base of Kalman, Ekf, Ukf and SquareRootUkf.
    """
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def predict(self, dt_s: float, acceleration_mps2: ArrayLike | None = None) -> None:
        """
        Moves dt_s seconds on, under a known acceleration [north, east] where one is given; mode probabilities follow the chain.
        """
    def run(self, z: ArrayLike, dt_s: ArrayLike, sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position, start: Gaussian | Sequence[Gaussian], own_position_m: ArrayLike | None = None, own_velocity_mps: ArrayLike | None = None, acceleration_mps2: ArrayLike | None = None, gate: RadiusGate | ChiSquareGate | None = None, reopen_after: int | None = None) -> RunResult:
        """
        Run whole recordings.
        
        Parameters
        ----------
        z : (T, M) or (R, T, M) array
            Readings of one run or of R independent runs; a row of NaN is a missed scan.
        dt_s : float or (T,) array
            Time before each reading, s; the first counts from the start.
        sensor : RangeBearing, ConvertedRangeBearing, RangeBearingDoppler or Position
        start : Gaussian or sequence of R of them
            Belief one step before the first reading, over the filter's state or over [x, vx, y, vy].
        own_position_m : (T, 2) array, optional
            North and east of own ship at each reading.
        own_velocity_mps : (T, 2) array, optional
            Its velocity over ground at each reading, which range rates are measured from.
        acceleration_mps2 : (T, 2) array, optional
            Known acceleration, north and east, in the step before each reading.
        gate : RadiusGate or ChiSquareGate, optional
            A reading outside is not used, and its status is `gated`: outside the circle about the predicted
            position, or with a larger normalized innovation squared (`nis`) than the ellipsoid's.
        reopen_after : int, optional
            After so many readings outside the gate in a row, all are used until one is inside again: the
            target is elsewhere, not its readings. Default: never.
        
        Returns
        -------
        RunResult
            mean (..., T, N), covariance (..., T, N, N), innovation (..., T, M), nis, log_likelihood and
            status (..., T); mode_probability (..., T, K) of multiple-model estimators and turn_rate_rad_s
            (..., T, K) of adaptive turn rates, else None. lanes: how many filters were stepped side by side in
            one register: recordings of a filter or an Imm, hypotheses of a ModeHistory. It is 1 for a
            single recording, a sensor of range rates and every other estimator.
        
        Raises
        ------
        ValueError
            When a shape does not fit, a sensor of range rates moves without `own_velocity_mps`, or
            `reopen_after` is without a gate or less than 1.
        FilterError
            When an estimator cannot start. A later step that fails is reported in `status`: an invalid
            reading leaves the prediction, an invalid `dt_s` leaves the belief unchanged.
        """
    def smooth(self, mean: ArrayLike, covariance: ArrayLike, dt_s: ArrayLike, acceleration_mps2: ArrayLike | None = None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
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
            When a covariance is not positive definite, a number not finite or a step negative.
        """
    def start(self, belief: Gaussian) -> None:
        """
        Begins with a belief over the state of the estimate or over [x, vx, y, vy].
        """
    def update(self, sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position, z: ArrayLike) -> Step:
        """
        Corrects the belief by a reading; returns the Step.
        """
    @property
    def started(self) -> bool:
        ...
class Kalman(Filter):
    """
    The Kalman filter: exact for linear motion and linear sensors.
    """
    def __copy__(self) -> Kalman:
        ...
    def __deepcopy__(self, memo: dict) -> Kalman:
        ...
    def __init__(self, motion: ConstantVelocity | WanderingCourse | ConstantAcceleration | CoordinatedTurn | CoordinatedTurnRate | Singer) -> None:
        ...
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
class Ekf(Filter):
    """
    The extended Kalman filter: motion and sensor linearized about the mean.
    """
    def __copy__(self) -> Ekf:
        ...
    def __deepcopy__(self, memo: dict) -> Ekf:
        ...
    def __init__(self, motion: ConstantVelocity | WanderingCourse | ConstantAcceleration | CoordinatedTurn | CoordinatedTurnRate | Singer) -> None:
        ...
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
class Ukf(Filter):
    """
    The unscented Kalman filter, with the scaled transform's alpha, beta and kappa.
    """
    def __copy__(self) -> Ukf:
        ...
    def __deepcopy__(self, memo: dict) -> Ukf:
        ...
    def __init__(self, motion: ConstantVelocity | WanderingCourse | ConstantAcceleration | CoordinatedTurn | CoordinatedTurnRate | Singer, *, alpha: float = 1.0, beta: float = 2.0, kappa: float = 0.0) -> None:
        ...
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
class SquareRootUkf(Filter):
    """
    The unscented Kalman filter with a square root of the covariance, for long runs.
    """
    def __copy__(self) -> SquareRootUkf:
        ...
    def __deepcopy__(self, memo: dict) -> SquareRootUkf:
        ...
    def __init__(self, motion: ConstantVelocity | WanderingCourse | ConstantAcceleration | CoordinatedTurn | CoordinatedTurnRate | Singer, *, alpha: float = 1.0, beta: float = 2.0, kappa: float = 0.0) -> None:
        ...
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
class Estimator:
    """
    What estimators of one or several models share.
    """
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def predict(self, dt_s: float, acceleration_mps2: ArrayLike | None = None) -> None:
        """
        Moves dt_s seconds on, under a known acceleration [north, east] where one is given; mode probabilities follow the chain.
        """
    def run(self, z: ArrayLike, dt_s: ArrayLike, sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position, start: Gaussian | Sequence[Gaussian], own_position_m: ArrayLike | None = None, own_velocity_mps: ArrayLike | None = None, acceleration_mps2: ArrayLike | None = None, gate: RadiusGate | ChiSquareGate | None = None, reopen_after: int | None = None) -> RunResult:
        """
        Run whole recordings.
        
        Parameters
        ----------
        z : (T, M) or (R, T, M) array
            Readings of one run or of R independent runs; a row of NaN is a missed scan.
        dt_s : float or (T,) array
            Time before each reading, s; the first counts from the start.
        sensor : RangeBearing, ConvertedRangeBearing, RangeBearingDoppler or Position
        start : Gaussian or sequence of R of them
            Belief one step before the first reading, over the filter's state or over [x, vx, y, vy].
        own_position_m : (T, 2) array, optional
            North and east of own ship at each reading.
        own_velocity_mps : (T, 2) array, optional
            Its velocity over ground at each reading, which range rates are measured from.
        acceleration_mps2 : (T, 2) array, optional
            Known acceleration, north and east, in the step before each reading.
        gate : RadiusGate or ChiSquareGate, optional
            A reading outside is not used, and its status is `gated`: outside the circle about the predicted
            position, or with a larger normalized innovation squared (`nis`) than the ellipsoid's.
        reopen_after : int, optional
            After so many readings outside the gate in a row, all are used until one is inside again: the
            target is elsewhere, not its readings. Default: never.
        
        Returns
        -------
        RunResult
            mean (..., T, N), covariance (..., T, N, N), innovation (..., T, M), nis, log_likelihood and
            status (..., T); mode_probability (..., T, K) of multiple-model estimators and turn_rate_rad_s
            (..., T, K) of adaptive turn rates, else None. lanes: how many filters were stepped side by side in
            one register: recordings of a filter or an Imm, hypotheses of a ModeHistory. It is 1 for a
            single recording, a sensor of range rates and every other estimator.
        
        Raises
        ------
        ValueError
            When a shape does not fit, a sensor of range rates moves without `own_velocity_mps`, or
            `reopen_after` is without a gate or less than 1.
        FilterError
            When an estimator cannot start. A later step that fails is reported in `status`: an invalid
            reading leaves the prediction, an invalid `dt_s` leaves the belief unchanged.
        """
    def start(self, belief: Gaussian) -> None:
        """
        Begins with a belief over the state of the estimate or over [x, vx, y, vy].
        """
    def update(self, sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position, z: ArrayLike) -> Step:
        """
        Corrects the belief by a reading; returns the Step.
        """
    @property
    def started(self) -> bool:
        ...
class ConstantGains:
    """
    Constant gains. A filter rejects those that are not stable (`stable_gains`).
    
    Parameters
    ----------
    alpha : float, default 0.5
        Gain of the position. -1e6 to 1e6.
    beta : float, default 0.2
        Gain of the velocity, over the step. -1e6 to 1e6.
    gamma : float, default 0.0
        Gain of the acceleration, over half the squared step; 0 for an alpha-beta filter. -1e6 to 1e6.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> ConstantGains:
        ...
    def __deepcopy__(self, memo: dict) -> ConstantGains:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, alpha: float = 0.5, beta: float = 0.2, gamma: float = 0.0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def gains(self, order: int = 2, *, reading: int = 1, elapsed_s: float = 1.0, std_m: float = 1.0, range_m: float = 0.0) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the previous one, with a standard deviation of `std_m`, at a range.
        """
    @property
    def alpha(self) -> float:
        """
        Gain of the position. -1e6 to 1e6. Default 0.5.
        """
    @property
    def beta(self) -> float:
        """
        Gain of the velocity, over the step. -1e6 to 1e6. Default 0.2.
        """
    @property
    def gamma(self) -> float:
        """
        Gain of the acceleration, over half the squared step; 0 for an alpha-beta filter. -1e6 to 1e6. Default 0.0.
        """
class GrowingMemory:
    """
    Growing memory: the least-squares line (or parabola) through all readings so far.
    
    With regular steps the filter equals that line exactly, for any start. A missed scan does not count.
    
    Parameters
    ----------
    plots_before : int, default 0
        Plots that the start was made of. In plots, 0 to 1e9.
    max_plots : int, default 0
        Plots at which the gains stop falling; 0: never. In plots, 0 to 1e9.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> GrowingMemory:
        ...
    def __deepcopy__(self, memo: dict) -> GrowingMemory:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, plots_before: int = 0, max_plots: int = 0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def gains(self, order: int = 2, *, reading: int = 1, elapsed_s: float = 1.0, std_m: float = 1.0, range_m: float = 0.0) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the previous one, with a standard deviation of `std_m`, at a range.
        """
    @property
    def max_plots(self) -> int:
        """
        Plots at which the gains stop falling; 0: never. In plots, 0 to 1e9. Default 0.
        """
    @property
    def plots_before(self) -> int:
        """
        Plots that the start was made of. In plots, 0 to 1e9. Default 0.
        """
class BenedictBordner:
    """
    beta = alpha² / (2 - alpha): the least error after a change of velocity for the noise that an alpha lets through.
    
    Parameters
    ----------
    alpha : float, default 0.5
        Gain of the position. Above 0 and at most 1.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> BenedictBordner:
        ...
    def __deepcopy__(self, memo: dict) -> BenedictBordner:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, alpha: float = 0.5) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def gains(self, order: int = 2, *, reading: int = 1, elapsed_s: float = 1.0, std_m: float = 1.0, range_m: float = 0.0) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the previous one, with a standard deviation of `std_m`, at a range.
        """
    @property
    def alpha(self) -> float:
        """
        Gain of the position. Above 0 and at most 1. Default 0.5.
        """
class CriticallyDamped:
    """
    All poles at theta: the least-squares line or parabola with weights theta a reading back (fading memory).
    
    Parameters
    ----------
    theta : float, default 0.5
        Weight of a reading over that of the next one; 0: only the newest readings count. At least 0 and below 1.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> CriticallyDamped:
        ...
    def __deepcopy__(self, memo: dict) -> CriticallyDamped:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, theta: float = 0.5) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def gains(self, order: int = 2, *, reading: int = 1, elapsed_s: float = 1.0, std_m: float = 1.0, range_m: float = 0.0) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the previous one, with a standard deviation of `std_m`, at a range.
        """
    @property
    def theta(self) -> float:
        """
        Weight of a reading over that of the next one; 0: only the newest readings count. At least 0 and below 1. Default 0.5.
        """
class TrackingIndex:
    """
    Gains of the steady Kalman filter, by the tracking index: accel_std T² / standard deviation of the reading.
    
    The standard deviation is that of each reading along and across the bearing, so that the gains depend on the range; the index
    depends on the step. Source: P. R. Kalata, The tracking index: a generalized parameter for alpha-beta and alpha-beta-gamma target trackers,
    IEEE Trans. AES-20, 1984.
    
    Parameters
    ----------
    accel_std_mps2 : float, default 0.1
        Standard deviation of the acceleration, of three states of its change, drawn anew for each step. In m/s², 1e-9 to 1e6.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> TrackingIndex:
        ...
    def __deepcopy__(self, memo: dict) -> TrackingIndex:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, accel_std_mps2: float = 0.1) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def gains(self, order: int = 2, *, reading: int = 1, elapsed_s: float = 1.0, std_m: float = 1.0, range_m: float = 0.0) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the previous one, with a standard deviation of `std_m`, at a range.
        """
    def steady_covariance(self, period_s: float, std_m: float, order: int = 2) -> NDArray[np.float64]:
        """
        (order, order) covariance of the states of one axis after an update, in the steady state.
        """
    @property
    def accel_std_mps2(self) -> float:
        """
        Standard deviation of the acceleration, of three states of its change, drawn anew for each step. In m/s², 1e-9 to 1e6. Default 0.1.
        """
class RangeDependent:
    """
    Gains by range, as in a radar plotting aid: those of `near`, beyond their range in inverse proportion to it, down to `far`.
    
    With D in km, ``alpha = 20 / D`` within 0.2 .. 0.5 and ``beta = 4 / D`` within 0.01 .. 0.2. Source: Hannoshyna, Kalinichenko, Nikitin, (30).
    
    Parameters
    ----------
    alpha_range_m : float, default 40000.0
        Range up to which the gain of the position is near_alpha. In m, 1e-9 to 1e9.
    beta_range_m : float, default 20000.0
        Range up to which the gain of the velocity is near_beta. In m, 1e-9 to 1e9.
    near_alpha : float, default 0.5
        Gain of the position at short range. 1e-9 to 1e6.
    near_beta : float, default 0.2
        Gain of the velocity at short range. 1e-9 to 1e6.
    far_alpha : float, default 0.2
        Least gain of the position; at most near_alpha. 1e-9 to 1e6.
    far_beta : float, default 0.01
        Least gain of the velocity; at most near_beta. 1e-9 to 1e6.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> RangeDependent:
        ...
    def __deepcopy__(self, memo: dict) -> RangeDependent:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, alpha_range_m: float = 40000.0, beta_range_m: float = 20000.0, near_alpha: float = 0.5, near_beta: float = 0.2, far_alpha: float = 0.2, far_beta: float = 0.01) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def gains(self, order: int = 2, *, reading: int = 1, elapsed_s: float = 1.0, std_m: float = 1.0, range_m: float = 0.0) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the previous one, with a standard deviation of `std_m`, at a range.
        """
    @property
    def alpha_range_m(self) -> float:
        """
        Range up to which the gain of the position is near_alpha. In m, 1e-9 to 1e9. Default 40000.0.
        """
    @property
    def beta_range_m(self) -> float:
        """
        Range up to which the gain of the velocity is near_beta. In m, 1e-9 to 1e9. Default 20000.0.
        """
    @property
    def far_alpha(self) -> float:
        """
        Least gain of the position; at most near_alpha. 1e-9 to 1e6. Default 0.2.
        """
    @property
    def far_beta(self) -> float:
        """
        Least gain of the velocity; at most near_beta. 1e-9 to 1e6. Default 0.01.
        """
    @property
    def near_alpha(self) -> float:
        """
        Gain of the position at short range. 1e-9 to 1e6. Default 0.5.
        """
    @property
    def near_beta(self) -> float:
        """
        Gain of the velocity at short range. 1e-9 to 1e6. Default 0.2.
        """
class RecentMemory:
    """
    Recent memory: the least-squares line through all readings with weights 1, 2, 3, ....
    
    Source: Hannoshyna, Kalinichenko, Nikitin, (29).
    
    Parameters
    ----------
    plots_before : int, default 0
        Plots that the start was made of. In plots, 0 to 1e9.
    max_plots : int, default 0
        Plots at which the gains stop falling; 0: never. In plots, 0 to 1e9.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> RecentMemory:
        ...
    def __deepcopy__(self, memo: dict) -> RecentMemory:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, plots_before: int = 0, max_plots: int = 0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def gains(self, order: int = 2, *, reading: int = 1, elapsed_s: float = 1.0, std_m: float = 1.0, range_m: float = 0.0) -> NDArray[np.float64]:
        """
        [alpha, beta] or, of order 3, [alpha, beta, gamma] for the reading-th reading since the start, `elapsed_s` after the previous one, with a standard deviation of `std_m`, at a range.
        """
    @property
    def max_plots(self) -> int:
        """
        Plots at which the gains stop falling; 0: never. In plots, 0 to 1e9. Default 0.
        """
    @property
    def plots_before(self) -> int:
        """
        Plots that the start was made of. In plots, 0 to 1e9. Default 0.
        """
class AdaptiveGains:
    """
    Gains from the last plots: those of a growing memory over a window, each weighted with the squared innovation that it met.
    
    Noise alone makes them about 0.74 and 0.37 with a window of five; a maneuver changes them little. For `AlphaBeta`; of one
    quantity see `AdaptiveAlphaBeta`. Source: Hannoshyna, Kalinichenko, Nikitin, (33), in two passes.
    
    Parameters
    ----------
    window : int, default 5
        Plots that the gains come from, the newest among them. In plots, 3 to 8.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> AdaptiveGains:
        ...
    def __deepcopy__(self, memo: dict) -> AdaptiveGains:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, window: int = 5) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    @property
    def window(self) -> int:
        """
        Plots that the gains come from, the newest among them. In plots, 3 to 8. Default 5.
        """
class AlphaBeta(Estimator):
    """
    The alpha-beta filter over [x, vx, y, vy], with a gain schedule.
    
    ``x += alpha e`` and ``vx += beta e / T`` per axis, with e the innovation in north and east and T the time since the previous
    reading, including missed scans; readings within an eighth of a step count as simultaneous. Covariance, NIS and likelihood are
    those of these gains under the given noise, so that it can be compared with a Kalman filter. Uses the position of any sensor.
    
    Parameters
    ----------
    gains : ConstantGains, GrowingMemory, RecentMemory, AdaptiveGains, BenedictBordner, CriticallyDamped, TrackingIndex or RangeDependent
    noise : ProcessNoise, optional
        Process noise for the covariance; default that of the tracking index, else `WhiteAcceleration()`.
    
    Raises
    ------
    ValueError
        When a parameter makes no sense or gains are not stable.
    """
    def __copy__(self) -> AlphaBeta:
        ...
    def __deepcopy__(self, memo: dict) -> AlphaBeta:
        ...
    def __init__(self, gains: ConstantGains | GrowingMemory | BenedictBordner | CriticallyDamped | TrackingIndex | RangeDependent | RecentMemory | AdaptiveGains, *, noise: ProcessNoise | None = None) -> None:
        ...
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
class AlphaBetaGamma(Estimator):
    """
    The alpha-beta-gamma filter over [x, vx, ax, y, vy, ay], with a gain schedule.
    
    As `AlphaBeta`, and ``ax += gamma e / (2 T²)``.
    
    Parameters
    ----------
    gains : ConstantGains, GrowingMemory, CriticallyDamped or TrackingIndex
    noise : ProcessNoise, optional
        Process noise for the covariance; default that of the tracking index, else `WhiteJerk()`.
    prior_accel_std_mps2 : float
        Prior standard deviation of the acceleration, for a start without one.
    
    Raises
    ------
    ValueError
        When a parameter makes no sense or gains are not stable.
    """
    def __copy__(self) -> AlphaBetaGamma:
        ...
    def __deepcopy__(self, memo: dict) -> AlphaBetaGamma:
        ...
    def __init__(self, gains: ConstantGains | GrowingMemory | CriticallyDamped | TrackingIndex, *, noise: ProcessNoise | None = None, prior_accel_std_mps2: float = 1.0) -> None:
        ...
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
class ExponentialSmoother:
    """
    Exponential smoothing: x^ += alpha (x - x^), for any time step; (21).
    
    Its forecast is its value.
    
    Parameters
    ----------
    alpha : float
        Above 0 and at most 1.
    wrapped : bool
        Readings are angles, radians: values are in -pi .. pi.
    """
    def __copy__(self) -> ExponentialSmoother:
        ...
    def __deepcopy__(self, memo: dict) -> ExponentialSmoother:
        ...
    def __init__(self, alpha: float = 0.5, *, wrapped: bool = False) -> None:
        ...
    def forecast(self, ahead_s: float) -> float:
        """
        The value `ahead_s` after the newest reading.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def run(self, dt_s: ArrayLike, reading: ArrayLike, *, ahead_s: float = 0.0) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """
        Smooth series of readings, each from a fresh start.
        
        Parameters
        ----------
        dt_s : float or (T,) array
            Steps to the readings; the first one is ignored.
        reading : (..., T) array
            NaN where missing: time passes.
        ahead_s : float
            Prediction horizon.
        
        Returns
        -------
        (value, rate, forecast)
            Each (..., T): after each reading, and `ahead_s` later; where a reading is missing, predicted to
            its time. NaN before the first reading.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def update(self, dt_s: float, reading: float) -> None:
        """
        Process a reading, `dt_s` after the previous one; the step of the first is ignored.
        """
    @property
    def alpha(self) -> float:
        """
        the last gain
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
    Exponential smoothing with alpha from the response of the line through the last five readings; (23).
    
    Parameters
    ----------
    wrapped : bool
        Readings are angles, radians: values are in -pi .. pi.
    """
    def __copy__(self) -> AdaptiveExponentialSmoother:
        ...
    def __deepcopy__(self, memo: dict) -> AdaptiveExponentialSmoother:
        ...
    def __init__(self, *, wrapped: bool = False) -> None:
        ...
    def forecast(self, ahead_s: float) -> float:
        """
        The value `ahead_s` after the newest reading.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def run(self, dt_s: ArrayLike, reading: ArrayLike, *, ahead_s: float = 0.0) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """
        Smooth series of readings, each from a fresh start.
        
        Parameters
        ----------
        dt_s : float or (T,) array
            Steps to the readings; the first one is ignored.
        reading : (..., T) array
            NaN where missing: time passes.
        ahead_s : float
            Prediction horizon.
        
        Returns
        -------
        (value, rate, forecast)
            Each (..., T): after each reading, and `ahead_s` later; where a reading is missing, predicted to
            its time. NaN before the first reading.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def update(self, dt_s: float, reading: float) -> None:
        """
        Process a reading, `dt_s` after the previous one; the step of the first is ignored.
        """
    @property
    def alpha(self) -> float:
        """
        the last gain
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
    Each reading smoothed with its neighbors, at uneven steps; (22), (24), (25).
    
    The value and the rate are those at the reading before the newest. Readings of one time are averaged.
    
    Parameters
    ----------
    weight_before_s, weight_after_s : float
        p: at this step a neighbor has the same weight as the reading itself.
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
    def __copy__(self) -> ThreePointSmoother:
        ...
    def __deepcopy__(self, memo: dict) -> ThreePointSmoother:
        ...
    def __init__(self, *, weight_before_s: float = 1.0, weight_after_s: float = 1.0, adaptive: bool = False, parabola: bool = True, wrapped: bool = False) -> None:
        ...
    def forecast(self, ahead_s: float) -> float:
        """
        The value `ahead_s` after the newest reading.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def run(self, dt_s: ArrayLike, reading: ArrayLike, *, ahead_s: float = 0.0) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """
        Smooth series of readings, each from a fresh start.
        
        Parameters
        ----------
        dt_s : float or (T,) array
            Steps to the readings; the first one is ignored.
        reading : (..., T) array
            NaN where missing: time passes.
        ahead_s : float
            Prediction horizon.
        
        Returns
        -------
        (value, rate, forecast)
            Each (..., T): after each reading, and `ahead_s` later; where a reading is missing, predicted to
            its time. NaN before the first reading.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def update(self, dt_s: float, reading: float) -> None:
        """
        Process a reading, `dt_s` after the previous one; the step of the first is ignored.
        """
    @property
    def delay_s(self) -> float:
        """
        time between the value and the newest reading
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
        Standard deviation of a reading, for a `TrackingIndex`.
    
    Raises
    ------
    ValueError
        When a parameter makes no sense or gains are not stable.
    """
    def __copy__(self) -> AlphaBetaSmoother:
        ...
    def __deepcopy__(self, memo: dict) -> AlphaBetaSmoother:
        ...
    def __init__(self, gains: ConstantGains | GrowingMemory | BenedictBordner | CriticallyDamped | TrackingIndex | RangeDependent | RecentMemory = ..., *, wrapped: bool = False, reading_std: float = 1.0) -> None:
        ...
    def forecast(self, ahead_s: float) -> float:
        """
        The value `ahead_s` after the newest reading.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def run(self, dt_s: ArrayLike, reading: ArrayLike, *, ahead_s: float = 0.0, range_m: float = 0.0) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """
        Smooth series of readings, each from a fresh start.
        
        Parameters
        ----------
        dt_s : float or (T,) array
            Steps to the readings; the first one is ignored.
        reading : (..., T) array
            NaN where missing: time passes.
        ahead_s : float
            Prediction horizon.
        
        Returns
        -------
        (value, rate, forecast)
            Each (..., T): after each reading, and `ahead_s` later; where a reading is missing, predicted to
            its time. NaN before the first reading.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def update(self, dt_s: float, reading: float, *, range_m: float = 0.0) -> None:
        """
        Process a reading, `dt_s` after the previous one, of an object at a range.
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
    The adaptive alpha-beta filter, in two passes over the last readings; (33).
    
    The first pass has the gains of a growing memory, the second ``alpha = sum((x^ - x~) e) / sum(e²)`` and
    ``beta = sum(dv e/t) / sum((e/t)²)`` over the first. Readings of one time are averaged.
    
    Parameters
    ----------
    window : int
        Readings of both passes, 3 to 16.
    wrapped : bool
        Readings are angles, radians: values are in -pi .. pi.
    
    Raises
    ------
    ValueError
        When the window has fewer or more readings.
    """
    def __copy__(self) -> AdaptiveAlphaBeta:
        ...
    def __deepcopy__(self, memo: dict) -> AdaptiveAlphaBeta:
        ...
    def __init__(self, *, window: int = 5, wrapped: bool = False) -> None:
        ...
    def forecast(self, ahead_s: float) -> float:
        """
        The value `ahead_s` after the newest reading.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def run(self, dt_s: ArrayLike, reading: ArrayLike, *, ahead_s: float = 0.0) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """
        Smooth series of readings, each from a fresh start.
        
        Parameters
        ----------
        dt_s : float or (T,) array
            Steps to the readings; the first one is ignored.
        reading : (..., T) array
            NaN where missing: time passes.
        ahead_s : float
            Prediction horizon.
        
        Returns
        -------
        (value, rate, forecast)
            Each (..., T): after each reading, and `ahead_s` later; where a reading is missing, predicted to
            its time. NaN before the first reading.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def update(self, dt_s: float, reading: float) -> None:
        """
        Process a reading, `dt_s` after the previous one; the step of the first is ignored.
        """
    @property
    def alpha(self) -> float:
        """
        the last gain
        """
    @property
    def beta(self) -> float:
        """
        the last gain of the rate
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
    The least-squares lines through the last 2, 3, ... readings; the one with the best recent predictions is used.
    
    Short windows follow a maneuver, long ones reduce noise in between; no tuning is needed. Readings of one time are averaged, without
    an effect on the choice.
    
    Parameters
    ----------
    max_readings : int
        Length of the longest window, 2 to 32.
    memory : float
        Factor of the energy of a window's innovations at each reading (fading memory).
    wrapped : bool
        Readings are angles, radians: values are in -pi .. pi.
    
    Raises
    ------
    ValueError
        When a setting makes no sense.
    """
    def __copy__(self) -> WindowBank:
        ...
    def __deepcopy__(self, memo: dict) -> WindowBank:
        ...
    def __init__(self, *, max_readings: int = 32, memory: float = 0.92, wrapped: bool = False) -> None:
        ...
    def forecast(self, ahead_s: float) -> float:
        """
        The value `ahead_s` after the newest reading.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def run(self, dt_s: ArrayLike, reading: ArrayLike, *, ahead_s: float = 0.0) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """
        Smooth series of readings, each from a fresh start.
        
        Parameters
        ----------
        dt_s : float or (T,) array
            Steps to the readings; the first one is ignored.
        reading : (..., T) array
            NaN where missing: time passes.
        ahead_s : float
            Prediction horizon.
        
        Returns
        -------
        (value, rate, forecast)
            Each (..., T): after each reading, and `ahead_s` later; where a reading is missing, predicted to
            its time. NaN before the first reading.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def update(self, dt_s: float, reading: float) -> None:
        """
        Process a reading, `dt_s` after the previous one; the step of the first is ignored.
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
        readings in the selected window
        """
def one_point(sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position, z: ArrayLike, speed_std_mps: float) -> Gaussian:
    """
    Belief over [x, vx, y, vy] from one plot and zero velocity with the given standard deviation per axis.
    """
def stable_gains(alpha: float, beta: float, gamma: float | None = None) -> bool:
    """
    Whether a filter with these gains is stable: alpha > 0, beta > 0, 2 alpha + beta < 4 and, with gamma, 0 < gamma < 4 alpha beta / (2 - alpha).
    """
def three_point_rate(before: ArrayLike, at: ArrayLike, after: ArrayLike, before_s: ArrayLike, after_s: ArrayLike, *, parabola: bool = True) -> NDArray[np.float64]:
    """
    Derivative at the middle of three readings at uneven steps; (25).
    
    Parameters
    ----------
    before, at, after : array_like
        The readings.
    before_s, after_s : array_like
        The steps between them, positive.
    parabola : bool
        b + f - c, exact for a parabola, else 2/3 c + (b + f) / 6, with less noise; b, f and c are the slopes before, after and overall.
    """
def two_point(sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position, first: ArrayLike, second: ArrayLike, dt_s: float) -> Gaussian:
    """
    Belief over [x, vx, y, vy] from two plots dt_s apart. The own ship of the sensor is that of the second plot; its velocity gives its position at the first.
    """
