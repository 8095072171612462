"""
Estimators with several motion models.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .core import Gaussian, Step
from .filter import Filter, RunResult
from .gating import RadiusGate
from .measurement import ConvertedRangeBearing, Position, RangeBearing, RangeBearingDoppler

__all__ = [
    "AdaptiveGridImm",
    "BayesianAlphaBeta",
    "FuzzyAlphaBeta",
    "FuzzyTrace",
    "Imm",
    "LikelyModelSetImm",
    "ModeChain",
    "ModeHistory",
    "SwitchingGridImm",
]

class ModeChain:
    """
    The Markov chain between modes: `matrix[i, j] = P(mode j now | mode i before)`.

    Parameters
    ----------
    matrix : (K, K) array
        Rows sum to 1.
    period_s : float, optional
        The time the matrix stands for; the chain then depends on the time step. Left out, the matrix is applied once per
        prediction.

    Raises
    ------
    ValueError
        When a row is no distribution, or no continuous-time chain has this matrix over the period.
    """
    @staticmethod
    def from_generator(generator_per_s: ArrayLike) -> ModeChain:
        """
        The chain in continuous time that goes from mode i to mode j generator_per_s[i, j] times a second; rows sum to 0.
        """
    @staticmethod
    def from_sojourn_s(sojourn_s: ArrayLike) -> ModeChain:
        """
        The chain that stays in mode k for sojourn_s[k] seconds on average and leaves to each other mode alike.
        """
    def __copy__(self) -> ModeChain: ...
    def __deepcopy__(self, memo: dict) -> ModeChain: ...
    def __init__(self, matrix: ArrayLike, period_s: float | None = None) -> None: ...
    def transition(self, dt_s: float) -> NDArray[np.float64]:
        """
        P(dt), (K, K). Raises ValueError for a step below zero.
        """
    @property
    def continuous(self) -> bool: ...
    @property
    def modes(self) -> int: ...

class Imm:
    """
    The interacting multiple model estimator.

    Parameters
    ----------
    filters : sequence of K filters
        Of any kinds and state sizes.
    chain : ModeChain
    initial_mode_probability : (K,) array, optional
        What a start begins with; uniform when left out.
    """
    def __copy__(self) -> Imm: ...
    def __deepcopy__(self, memo: dict) -> Imm: ...
    def __init__(
        self,
        filters: Sequence[Filter],
        chain: ModeChain,
        initial_mode_probability: ArrayLike | None = None,
    ) -> None: ...
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def filter_estimate(self, index: int) -> Gaussian:
        """
        The belief of one of the filters, over its own state.
        """
    def mode_probability(self) -> NDArray[np.float64]:
        """
        (K,)
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
        Runs whole recordings and smooths them: what each scan tells knows the scans after it, too.

        Each pair of modes of two scans is a way of its own: carried back by the Rauch-Tung-Striebel
        smoother of its filter, and as likely as it foretold what came. For recordings that are over; takes
        K² predictions and smoothings a scan, one recording after the other on each thread. Where a step is
        so long that nothing can be carried back over it (weeks, of `PiecewiseAcceleration`), what was
        before is smoothed by itself.

        Parameters
        ----------
        z, dt_s, sensor, start, own_position_m, own_velocity_mps, acceleration_mps2, gate
            As of `run`.

        Returns
        -------
        RunResult
            mean, covariance and mode_probability are smoothed, those of the last scan as filtered;
            innovation, nis, log_likelihood and status are those of `run`.

        Raises
        ------
        ValueError
            As of `run`.
        FilterError
            When an estimator cannot start, or a recording cannot be smoothed: a step between two scans is
            below zero or no number.

        References
        ----------
        R. E. Helmick, W. D. Blair, S. A. Hoffman, IEEE Trans. Information Theory 41, 1995; N. Nadarajah,
        R. Tharmarasa, M. McDonald, T. Kirubarajan, IEEE Trans. AES 48, 2012.
        """
    def start(self, belief: Gaussian) -> None:
        """
        Begins with a belief over the state of the estimate or over [x, vx, y, vy].
        """
    def turn_rates_rad_s(self) -> NDArray[np.float64] | None:
        """
        (K,) turn rates of the models, positive to starboard; None where one is not known.
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
    def models(self) -> int: ...
    @property
    def started(self) -> bool: ...

class AdaptiveGridImm:
    """
    Three turn models whose rates move with the target.

    The turn rates move before each prediction that follows an update, with its mode probabilities. Has the face of `Imm`.

    The printed rule is that of centre_threshold 0.3, centre_gain 1, kept_spacing_rad_s 0 and least_move_rad_s 0. Its grid collapses to half of
    min_spacing_rad_s to each side, where the rates may differ too little to be told apart, and nothing opens it again. The
    defaults keep it open and move its centre with patience.

    Parameters
    ----------
    filter : Kalman, Ekf, Ukf or SquareRootUkf over CoordinatedTurn
        What all three models are like; its turn rate does not matter.
    max_turn_rate_rad_s : float
        No model turns faster.
    initial_turn_rates_rad_s : (3,) array, optional
        Left, centre and right at a start, none less than the one before it; zero and half the maximum to each side when left
        out. Not printed.
    min_spacing_rad_s : float
        The least spacing that a move starts from. Not printed.
    kept_spacing_rad_s : float
        No side comes nearer to the centre, but for the maximum: what keeps the grid open. Not in the paper: 0.
    least_move_rad_s : float
        A grid none of whose rates would move so far stays, which saves time. Not in the paper: 0.
    centre_threshold : float
        A centre less probable than this moves towards the mean rate. In the paper 0.3.
    centre_gain : float
        How far it moves towards it. Not in the paper: 1, all the way.
    unlikely_threshold : float
        Where the centre is the most probable, a side less probable than this comes half way nearer.
    likely_threshold : float
        Where a side is the most probable, and more than this, it goes twice as far.
    stay_probability : float
        Of the models' chain: to stay, the rest to each other model alike.
    chain : ModeChain, optional
        Another chain of three modes, instead of `stay_probability`.
    initial_mode_probability : (3,) array, optional
        What a start begins with; 0.9 for the centre when left out. Not printed.

    Raises
    ------
    ValueError
        When a parameter makes no sense.

    References
    ----------
    Le Minh Hoang, A. A. Konovalov, Dao Van Luc, J. Russian Universities. Radioelectronics, 2023, 26(3), step 1.1.
    """
    def __copy__(self) -> AdaptiveGridImm: ...
    def __deepcopy__(self, memo: dict) -> AdaptiveGridImm: ...
    def __init__(
        self,
        filter: Filter,
        *,
        max_turn_rate_rad_s: float = 0.08726646259971647,
        initial_turn_rates_rad_s: ArrayLike | None = None,
        min_spacing_rad_s: float = 0.03490658503988659,
        kept_spacing_rad_s: float = 0.05235987755982989,
        least_move_rad_s: float = 0.0017453292519943296,
        centre_threshold: float = 0.8,
        centre_gain: float = 0.3,
        unlikely_threshold: float = 0.25,
        likely_threshold: float = 0.75,
        stay_probability: float = 0.9,
        chain: ModeChain | None = None,
        initial_mode_probability: ArrayLike | None = None,
    ) -> None: ...
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def filter_estimate(self, index: int) -> Gaussian:
        """
        The belief of one of the filters, over its own state.
        """
    def mode_probability(self) -> NDArray[np.float64]:
        """
        (K,)
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
    def turn_rates_rad_s(self) -> NDArray[np.float64]:
        """
        (K,) turn rates of the models, positive to starboard; NaN for one at rest.
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
    def models(self) -> int: ...
    @property
    def started(self) -> bool: ...

class SwitchingGridImm:
    """
    Three turn models in a window on a fixed grid of turn rates.

    The window moves before each prediction that follows an update, with its mode probabilities. Has the face of `Imm`.

    Parameters
    ----------
    filter : Kalman, Ekf, Ukf or SquareRootUkf over CoordinatedTurn
        What all three models are like; its turn rate does not matter.
    grid_rad_s : (3 to 16,) array, optional
        Turn rates, rising; 2.5 deg/s apart up to 5 deg/s to each side when left out.
    threshold : float
        A model more probable than this decides. In the paper 0.7, with which the window often comes too late.
    rule : 'symmetric' or 'literal'
        Left if the left model is above the threshold, right if the right one is, else stay; or as printed: left if the left
        one is, stay if the centre is, else right.
    carry : 'slot' or 'identity'
        Whether each slot keeps its estimate and probability, or each model that stays does and the entering one begins with
        the combined estimate and the probability of the leaving one. Not printed.
    initial_centre : int, optional
        Index of the window's middle at a start; the straightest rate but the ends when left out. Not printed.
    stay_probability : float
        Of the models' chain: to stay, the rest to each other model alike.
    chain : ModeChain, optional
        Another chain of three modes, instead of `stay_probability`.
    initial_mode_probability : (3,) array, optional
        What a start begins with; 0.9 for the centre when left out. Not printed.

    Raises
    ------
    ValueError
        When a parameter makes no sense.

    References
    ----------
    Le Minh Hoang, A. A. Konovalov, Dao Van Luc, J. Russian Universities. Radioelectronics, 2023, 26(3), step 1.2.
    """
    def __copy__(self) -> SwitchingGridImm: ...
    def __deepcopy__(self, memo: dict) -> SwitchingGridImm: ...
    def __init__(
        self,
        filter: Filter,
        grid_rad_s: ArrayLike | None = None,
        *,
        threshold: float = 0.5,
        rule: str = "symmetric",
        carry: str = "identity",
        initial_centre: int | None = None,
        stay_probability: float = 0.9,
        chain: ModeChain | None = None,
        initial_mode_probability: ArrayLike | None = None,
    ) -> None: ...
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def filter_estimate(self, index: int) -> Gaussian:
        """
        The belief of one of the filters, over its own state.
        """
    def mode_probability(self) -> NDArray[np.float64]:
        """
        (K,)
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
    def turn_rates_rad_s(self) -> NDArray[np.float64]:
        """
        (K,) turn rates of the models, positive to starboard; NaN for one at rest.
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
    def centre(self) -> int:
        """
        Index of the window's middle in the grid.
        """
    @property
    def models(self) -> int: ...
    @property
    def started(self) -> bool: ...

class LikelyModelSetImm:
    """
    Turn models that join and leave by their probability.

    All are active at a start. Before each prediction that follows an update the unlikely ones go to rest and the neighbours
    of the likely ones join; the most probable one always has its neighbours with it. Has the face of `Imm`; a model at rest
    has probability 0 and turn rate NaN, and its `filter_estimate` is the belief that it went to rest with.

    Parameters
    ----------
    filter : Kalman, Ekf, Ukf or SquareRootUkf over CoordinatedTurn
        What all models are like; its turn rate does not matter.
    grid_rad_s : (2 to 16,) array, optional
        Turn rates, rising; 2 deg/s apart up to 4 deg/s to each side when left out.
    unlikely_threshold : float
        A model less probable than this leaves.
    likely_threshold : float
        One at least as probable as this has its neighbours join it.
    stay_probability : float
        Of the models' chain: to stay, the rest to each other active model alike.
    chain : ModeChain, optional
        Another chain of as many modes, instead of `stay_probability`; what leads to a model at rest goes to the active ones.
    initial_mode_probability : (K,) array, optional
        What a start begins with; 0.9 for the straightest when left out.

    Raises
    ------
    ValueError
        When a parameter makes no sense.

    References
    ----------
    X. R. Li, Y. Zhang, IEEE Trans. AES-36, 2000: the likely-model set.
    """
    def __copy__(self) -> LikelyModelSetImm: ...
    def __deepcopy__(self, memo: dict) -> LikelyModelSetImm: ...
    def __init__(
        self,
        filter: Filter,
        grid_rad_s: ArrayLike | None = None,
        *,
        unlikely_threshold: float = 0.03,
        likely_threshold: float = 0.1,
        stay_probability: float = 0.9,
        chain: ModeChain | None = None,
        initial_mode_probability: ArrayLike | None = None,
    ) -> None: ...
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def filter_estimate(self, index: int) -> Gaussian:
        """
        The belief of one of the filters, over its own state.
        """
    def mode_probability(self) -> NDArray[np.float64]:
        """
        (K,)
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
    def turn_rates_rad_s(self) -> NDArray[np.float64]:
        """
        (K,) turn rates of the models, positive to starboard; NaN for one at rest.
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
    def models(self) -> int: ...
    @property
    def started(self) -> bool: ...

class ModeHistory:
    """
    A tree of histories of turn rates, not mixed.

    Each hypothesis is one filter with its own past. A prediction lets every hypothesis keep its turn rate or take another one; an
    update weighs the hypotheses by their likelihood, joins those that have become alike and keeps the likeliest. Has the face of
    `Imm`; `mode_probability` has one number for each turn rate of the grid.

    Parameters
    ----------
    filter : Kalman, Ekf, Ukf or SquareRootUkf over CoordinatedTurn, or Ekf, Ukf or SquareRootUkf over CoordinatedTurnRate
        What every hypothesis is like; its turn rate does not matter. Over CoordinatedTurnRate each learns its own rate: one that
        comes into a mode begins at the rate of the grid, with `prior_turn_rate_std_rad_s` (the straightest with a tenth of
        it); what it has learnt is in the state. A fifth of the grid's step, and `turn_rate_psd_rad2s3` of 0, keep the modes
        apart.
    grid_rad_s : (2 to 16,) array, optional
        Turn rates, rising; -4 to 4 degrees a second in steps of 1 when left out.
    grid_std_rad_s : (K,) array, optional
        Of filters over CoordinatedTurnRate, how far the rate may be off each of the grid when a turn begins, instead of
        `prior_turn_rate_std_rad_s` and a tenth of it. Next to none (1e-4 rad/s) at rates that vessels are known to turn at, and
        more at some between them, which learn theirs, is nearly as good as either where either is right.
    grid_weight : (K,) array, optional
        How usual each rate is among turns, as parts of their sum; that of the straightest does not matter. All alike when left out.
    straight_sojourn_s, turn_sojourn_s : float
        Mean time on a straight (the straightest rate of the grid) and in a turn, once it may end. The defaults suit small
        craft that turn often; ships go straight for minutes.
    straighten_probability : float
        That a turn ends in a straight; other turns are alike.
    chain : ModeChain, optional
        Another chain, instead of those three and `grid_weight`.
    initial_mode_probability : (K,) array, optional
        What a start begins with; 0.9 for the straightest when left out.
    max_hypotheses : int
        Kept after an update; K or more.
    max_branches : int
        Filtered in a scan, at most 256: what was kept, and the likeliest switches from it that there is room for.
    min_segment_s : float
        A turn rate that is younger does not change.
    merge_distance : float
        Hypotheses of one turn rate that are nearer join, around the heavier one: the Mahalanobis distance in its covariance; 0 joins none.
    sibling_distance : float
        The same for those that came to it in one scan and differ only in what came before; `merge_distance` or more.
    switch_time_spread : float
        Uncertainty of when in the scan a switch came: this part, 0 to 1, of the variance of a time uniform in it.
    negligible_probability : float
        Hypotheses that have less are dropped.

    Raises
    ------
    ValueError
        When a parameter makes no sense.

    References
    ----------
    G. A. Ackerson, K. S. Fu, IEEE Trans. Automatic Control 15, 1970; J. K. Tugnait, Automatica 18, 1982; D. J. Salmond, Proc. SPIE
    1305, 1990.
    """
    @staticmethod
    def of(
        filters: Sequence[Filter],
        chain: ModeChain,
        initial_mode_probability: ArrayLike | None = None,
        *,
        max_hypotheses: int = 75,
        max_branches: int = 100,
        min_segment_s: float = 12.0,
        merge_distance: float = 1.9,
        sibling_distance: float = 12.0,
        switch_time_spread: float = 0.15,
        negligible_probability: float = 1e-07,
    ) -> ModeHistory:
        """
        A tree whose modes differ in more than their turn rate: in their noise, too.

        Parameters
        ----------
        filters : sequence of 1 to 16 filters
            One for each mode, of one kind (Kalman, Ekf, Ukf or SquareRootUkf), all over CoordinatedTurn or all over
            CoordinatedTurnRate. Of these, a straight is one about 0 whose `prior_turn_rate_std_rad_s` is next to none and whose
            `turn_rate_psd_rad2s3` is 0; a hypothesis takes the rate of a mode up when it comes into it, unless the one that it leaves
            had the same prior.
        chain : ModeChain
            Of as many modes.
        initial_mode_probability : (K,) array, optional
            What a start begins with; all alike when left out.
        max_hypotheses, max_branches, min_segment_s, merge_distance, sibling_distance, switch_time_spread, negligible_probability
            As of the class.

        Raises
        ------
        TypeError
            When `filters` is no sequence, or one of them is no filter.
        ValueError
            When the filters are not alike, or a parameter makes no sense.
        """
    @staticmethod
    def pseudo_bayes(
        order: int,
        filter: Filter,
        grid_rad_s: ArrayLike | None = None,
        *,
        stay_probability: float = 0.9,
        chain: ModeChain | None = None,
        initial_mode_probability: ArrayLike | None = None,
    ) -> ModeHistory:
        """
        The generalised pseudo-Bayes estimator of an order: GPB1, GPB2, ...

        Histories with the same last ``order - 1`` turn rates join in every scan.

        Parameters
        ----------
        order : int
            1 or more, 2 or more over CoordinatedTurnRate; K to the power of it is at most 256.
        filter, grid_rad_s, chain, initial_mode_probability
            As of the class.
        stay_probability : float
            Of the turn rates' chain where none is given: to stay, the rest to each other one alike.

        Raises
        ------
        ValueError
            When a parameter makes no sense.

        References
        ----------
        Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, 11.6.3-11.6.5.
        """
    def __copy__(self) -> ModeHistory: ...
    def __deepcopy__(self, memo: dict) -> ModeHistory: ...
    def __init__(
        self,
        filter: Filter,
        grid_rad_s: ArrayLike | None = None,
        *,
        grid_std_rad_s: ArrayLike | None = None,
        grid_weight: ArrayLike | None = None,
        straight_sojourn_s: float = 40.0,
        turn_sojourn_s: float = 70.0,
        straighten_probability: float = 0.85,
        chain: ModeChain | None = None,
        initial_mode_probability: ArrayLike | None = None,
        max_hypotheses: int = 75,
        max_branches: int = 100,
        min_segment_s: float = 12.0,
        merge_distance: float = 1.9,
        sibling_distance: float = 12.0,
        switch_time_spread: float = 0.15,
        negligible_probability: float = 1e-07,
    ) -> None: ...
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def mode_probability(self) -> NDArray[np.float64]:
        """
        (K,)
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
    def turn_rates_rad_s(self) -> NDArray[np.float64]:
        """
        (K,) turn rates of the modes, positive to starboard. Those learnt are in the state.
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
    def hypothesis_count(self) -> int:
        """
        How many there are at present.
        """
    @property
    def models(self) -> int: ...
    @property
    def started(self) -> bool: ...

class BayesianAlphaBeta:
    """
    Lines and parabolas through the last plots, weighed by Bayes' rule.

    Each member foretells the next plot with a known error: the plot's own, times one plus the member's noise factor. The plot's
    likelihood is the evidence for it, and from scan to scan a member stays the right one for a while. The estimate is the mixture.
    Does what `FuzzyAlphaBeta` does, many plots on a straight and few in a turn, without its usual residual, which a turn inflates,
    its hold and its hard choice; a parabola holds a turn that lines cut. Has the face of `Imm`, with a mode for each member: lines
    first, shorter before longer, then parabolas.

    Takes the position out of any sensor, and measures innovations in north and east.

    Parameters
    ----------
    min_plots, max_plots : int
        Of the shortest and the longest line, 2 to 16; at most 16 members in all.
    parabolas : bool
        Whether there are parabolas too, through four plots and more.
    sojourn_s : float
        Mean time until another member is the right one.
    longest_line_probability : float
        Prior of the longest line; the other members are alike.
    acceleration_std_mps2 : float
        Per axis, of a maneuver that began at the last plot but one: widens the covariance, not used in weighing.

    Raises
    ------
    ValueError
        When a parameter makes no sense.
    """
    def __copy__(self) -> BayesianAlphaBeta: ...
    def __deepcopy__(self, memo: dict) -> BayesianAlphaBeta: ...
    def __init__(
        self,
        *,
        min_plots: int = 2,
        max_plots: int = 10,
        parabolas: bool = True,
        sojourn_s: float = 30.0,
        longest_line_probability: float = 0.4,
        acceleration_std_mps2: float = 0.15,
    ) -> None: ...
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def mode_probability(self) -> NDArray[np.float64]:
        """
        (K,)
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
    def models(self) -> int: ...
    @property
    def plots_of_mode(self) -> NDArray[np.int32]:
        """
        (K,) number of plots that each member goes through.
        """
    @property
    def started(self) -> bool: ...

class FuzzyTrace:
    """
    What `FuzzyAlphaBeta.trace` returns: arrays over scans, and over runs where there are several; NaN where nothing was judged.
    """
    def __getstate__(
        self,
    ) -> tuple[
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.int32],
    ]: ...
    def __setstate__(self, arg0: tuple) -> None: ...
    @property
    def chosen(self) -> NDArray[np.int32]:
        """
        (..., T) plots of the line chosen
        """
    @property
    def innovation_m(self) -> NDArray[np.float64]:
        """
        (..., T, 2) north and east
        """
    @property
    def prediction_m(self) -> NDArray[np.float64]:
        """
        (..., T, 2) north and east
        """
    @property
    def quality(self) -> NDArray[np.float64]:
        """
        (..., T) output of the machine
        """
    @property
    def residual_ratios(self) -> NDArray[np.float64]:
        """
        (..., T, J - 1) of the lines through 2 .. J plots
        """
    @property
    def rule_strengths(self) -> NDArray[np.float64]:
        """
        (..., T, J)
        """
    @property
    def sigma_hat_m(self) -> NDArray[np.float64]:
        """
        (..., T)
        """

class FuzzyAlphaBeta:
    """
    The line through the last plots, as many as a fuzzy criterion finds good: many on a straight, few in a turn.

    In each scan the plot is compared with what the lines through the last 2, 3, ... plots foretold. Of each line there is the ratio of
    its residual to `sigma_hat_m`, the mean residual of the shortest line since the start; ``bad(ratio) = 1 / (1 + exp(-steepness
    (ratio - threshold)))`` and ``good = 1 - bad``. Rule p of a zero-order Sugeno machine says: where the first p lines are good and
    the rest bad, track with ``max(2, p + 1)`` plots. The estimate is the line through as many plots as the rules say on average.
    Until there are two plots it is the belief at the start, as a Kalman filter keeps it.
    A plot of about the time of the one before, within a sixteenth of a step, joins it and judges nothing.

    Has the face of `Imm`, with one mode for each line. Takes the position out of any sensor, and measures innovations in north and
    east.

    Parameters
    ----------
    max_plots : int
        Of the longest line, 2 to 16.
    steepness, threshold : float
        Of the membership functions.
    clip : float
        Greater ratios count as this.
    t_norm : {'product', 'minimum'}
        How degrees are combined.
    hold : bool
        Whether the greater of the last two outputs counts, against single outliers.
    acceleration_std_mps2 : float
        Per axis, of a maneuver that began at the last plot but one: widens the covariance, not used in the choice.

    Raises
    ------
    ValueError
        When a parameter makes no sense.

    References
    ----------
    V. M. Grinyak, M. V. Trofimov, Multi-model tracking of moving vessels with a fuzzy criterion of maneuver detection.
    """
    def __copy__(self) -> FuzzyAlphaBeta: ...
    def __deepcopy__(self, memo: dict) -> FuzzyAlphaBeta: ...
    def __init__(
        self,
        *,
        max_plots: int = 10,
        steepness: float = 5.0,
        threshold: float = 1.5,
        clip: float = 3.0,
        t_norm: str = "product",
        hold: bool = True,
        acceleration_std_mps2: float = 0.5,
    ) -> None: ...
    def estimate(self) -> Gaussian:
        """
        The belief; of several models moment-matched, over the state where all share one, else over [x, vx, y, vy].
        """
    def judge(self, ratios: ArrayLike) -> tuple[float, NDArray[np.float64]]:
        """
        The machine alone: its output and the strengths (n + 1,) of its rules for the ratios (n,), 0 or more, of the lines through 2, 3, ... plots.
        """
    def mode_probability(self) -> NDArray[np.float64]:
        """
        (K,)
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
    def trace(
        self,
        z: ArrayLike,
        dt_s: ArrayLike,
        sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
        start: Gaussian | Sequence[Gaussian],
    ) -> FuzzyTrace:
        """
        What the criterion sees and does in every scan of whole recordings.

        Parameters
        ----------
        z, dt_s, sensor, start
            As of `run`.

        Returns
        -------
        FuzzyTrace

        Raises
        ------
        ValueError
            When a shape does not fit.
        FilterError
            When it cannot start.
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
    def chosen(self) -> int:
        """
        Plots of the line chosen.
        """
    @property
    def models(self) -> int: ...
    @property
    def plots_of_mode(self) -> NDArray[np.int32]:
        """
        (K,) number of plots that each line goes through.
        """
    @property
    def quality(self) -> float:
        """
        Output of the machine at the last plot, before it is held and rounded; NaN without one.
        """
    @property
    def residual_ratios(self) -> NDArray[np.float64]:
        """
        Of each line that was judged at the last plot: its residual over `sigma_hat_m`, clipped.
        """
    @property
    def rule_strengths(self) -> NDArray[np.float64]:
        """
        Of each rule of that judgement.
        """
    @property
    def sigma_hat_m(self) -> float:
        """
        Mean residual of the shortest line since the start; NaN before the first one.
        """
    @property
    def started(self) -> bool: ...
