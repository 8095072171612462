"""
Estimators with several motion models.
"""
from collections.abc import Sequence
import numpy as np
from numpy.typing import ArrayLike, NDArray
from .core import Gaussian
from .measurement import ConvertedRangeBearing, Position, RangeBearing, RangeBearingDoppler
from .filter import Estimator, Filter, RunResult
from .gating import ChiSquareGate, RadiusGate
__all__: list = ['ModeChain', 'MultiModelEstimator', 'Imm', 'AdaptiveGridImm', 'SwitchingGridImm', 'LikelyModelSetImm', 'ModeHistory', 'BayesianAlphaBeta', 'FuzzyTrace', 'FuzzyAlphaBeta']
class ModeChain:
    """
    The Markov chain between modes: `matrix[i, j] = P(mode j now | mode i before)`.
    
    Parameters
    ----------
    matrix : (K, K) array
        Rows sum to 1.
    period_s : float, optional
        The time step of the matrix; the chain is then in continuous time. Default: the matrix is applied once per
        prediction, whatever its step, so that all steps must be equal; uneven steps and trackers warn of it.
    
    Raises
    ------
    ValueError
        When a row is not a distribution, or no continuous-time chain has this matrix over the period.
    """
    @staticmethod
    def from_generator(generator_per_s: ArrayLike) -> ModeChain:
        """
        The chain in continuous time with the rate generator_per_s[i, j] from mode i to mode j; rows sum to 0.
        """
    @staticmethod
    def from_sojourn_s(sojourn_s: ArrayLike) -> ModeChain:
        """
        The chain with a mean sojourn of sojourn_s[k] seconds in mode k and equal transitions to the other modes.
        """
    def __copy__(self) -> ModeChain:
        ...
    def __deepcopy__(self, memo: dict) -> ModeChain:
        ...
    def __init__(self, matrix: ArrayLike, period_s: float | None = None) -> None:
        ...
    def transition(self, dt_s: float) -> NDArray[np.float64]:
        """
        P(dt), (K, K). Raises ValueError for a negative step.
        """
    @property
    def continuous(self) -> bool:
        ...
    @property
    def modes(self) -> int:
        ...
class MultiModelEstimator(Estimator):
    """
    What estimators of several models share.
    """
    def mode_probability(self) -> NDArray[np.float64]:
        """
        (K,)
        """
    @property
    def models(self) -> int:
        """
        K
        """
class Imm(MultiModelEstimator):
    """
    The interacting multiple model estimator.
    
    Parameters
    ----------
    filters : sequence of K filters
        `Kalman`, `Ekf`, `Ukf`, `SquareRootUkf` and `AlphaBeta`, over any states.
    chain : ModeChain
    initial_mode_probability : (K,) array, optional
        What a start begins with; uniform when left out.
    """
    def __copy__(self) -> Imm:
        ...
    def __deepcopy__(self, memo: dict) -> Imm:
        ...
    def __init__(self, filters: Sequence[Filter], chain: ModeChain, initial_mode_probability: ArrayLike | None = None) -> None:
        ...
    def filter_estimate(self, index: int) -> Gaussian:
        """
        The belief of one of the filters, over its own state.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def smooth(self, z: ArrayLike, dt_s: ArrayLike, sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position, start: Gaussian | Sequence[Gaussian], own_position_m: ArrayLike | None = None, own_velocity_mps: ArrayLike | None = None, acceleration_mps2: ArrayLike | None = None, gate: RadiusGate | ChiSquareGate | None = None, reopen_after: int | None = None) -> RunResult:
        """
        Run and smooth whole recordings: each estimate also uses later scans.
        
        Each pair of modes of two scans is a separate path, smoothed by the Rauch-Tung-Striebel smoother of
        its filter and weighted by how well it predicted the later readings. A scan takes K² predictions and
        smoothings; each thread takes one recording after the other. If a step is too long to smooth across
        (weeks, with `PiecewiseAcceleration`), the part before it is smoothed separately.
        
        Parameters
        ----------
        z, dt_s, sensor, start, own_position_m, own_velocity_mps, acceleration_mps2, gate, reopen_after
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
            When an estimator cannot start, or a recording cannot be smoothed because a step between two
            scans is negative or NaN.
        
        References
        ----------
        R. E. Helmick, W. D. Blair, S. A. Hoffman, IEEE Trans. Information Theory 41, 1995; N. Nadarajah,
        R. Tharmarasa, M. McDonald, T. Kirubarajan, IEEE Trans. AES 48, 2012.
        """
    def turn_rates_rad_s(self) -> NDArray[np.float64] | None:
        """
        (K,) turn rates of the models, positive to starboard; None if one is unknown.
        """
class AdaptiveGridImm(MultiModelEstimator):
    """
    Three turn models with adaptive turn rates.
    
    The turn rates move before each prediction that follows an update, by its mode probabilities. Same interface as `Imm`.
    
    The printed rule has centre_threshold 0.3, centre_gain 1, kept_spacing_rad_s 0 and least_move_rad_s 0. Its grid collapses to half of
    min_spacing_rad_s on each side, where the rates may differ too little to be distinguished, and nothing opens it again. The
    defaults keep it open and move its center slowly.
    
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
        Of the models' chain: to stay; the rest is shared equally by the other models.
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
    def __copy__(self) -> AdaptiveGridImm:
        ...
    def __deepcopy__(self, memo: dict) -> AdaptiveGridImm:
        ...
    def __init__(self, filter: Filter, *, max_turn_rate_rad_s: float = 0.08726646259971647, initial_turn_rates_rad_s: ArrayLike | None = None, min_spacing_rad_s: float = 0.03490658503988659, kept_spacing_rad_s: float = 0.05235987755982989, least_move_rad_s: float = 0.0017453292519943296, centre_threshold: float = 0.8, centre_gain: float = 0.3, unlikely_threshold: float = 0.25, likely_threshold: float = 0.75, stay_probability: float = 0.9, chain: ModeChain | None = None, initial_mode_probability: ArrayLike | None = None) -> None:
        ...
    def filter_estimate(self, index: int) -> Gaussian:
        """
        The belief of one of the filters, over its own state.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def turn_rates_rad_s(self: Estimator) -> NDArray[np.float64]:
        """
        (K,) turn rates of the models, positive to starboard; NaN for one at rest.
        """
class SwitchingGridImm(MultiModelEstimator):
    """
    Three turn models in a window on a fixed grid of turn rates.
          
          The window moves before each prediction that follows an update, by its mode probabilities. Same interface as `Imm`.
    
    Parameters
    ----------
    filter : Kalman, Ekf, Ukf or SquareRootUkf over CoordinatedTurn
        What all three models are like; its turn rate does not matter.
    grid_rad_s : (3 to 16,) array, optional
        Turn rates, rising; 2.5 deg/s apart up to 5 deg/s to each side when left out.
    threshold : float
        A model with a larger probability moves the window. 0.7 in the paper, with which it is often too late.
    rule : 'symmetric' or 'literal'
        Left if the left model is above the threshold, right if the right one is, else stay; or as printed: left if the left
        one is, stay if the center is, else right.
    carry : 'slot' or 'identity'
        Whether each slot keeps its estimate and probability, or each remaining model does and the entering one starts with
        the combined estimate and the probability of the leaving one. Not printed.
    initial_centre : int, optional
        Index of the window's center at a start; default the straightest rate except the ends. Not printed.
    stay_probability : float
        Of the models' chain: to stay; the rest is shared equally by the other models.
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
    def __copy__(self) -> SwitchingGridImm:
        ...
    def __deepcopy__(self, memo: dict) -> SwitchingGridImm:
        ...
    def __init__(self, filter: Filter, grid_rad_s: ArrayLike | None = None, *, threshold: float = 0.5, rule: str = 'symmetric', carry: str = 'identity', initial_centre: int | None = None, stay_probability: float = 0.9, chain: ModeChain | None = None, initial_mode_probability: ArrayLike | None = None) -> None:
        ...
    def filter_estimate(self, index: int) -> Gaussian:
        """
        The belief of one of the filters, over its own state.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def turn_rates_rad_s(self: Estimator) -> NDArray[np.float64]:
        """
        (K,) turn rates of the models, positive to starboard; NaN for one at rest.
        """
    @property
    def centre(self) -> int:
        """
        Index of the window's center in the grid.
        """
class LikelyModelSetImm(MultiModelEstimator):
    """
    Turn models that become active and inactive by their probability.
    
    All are active at a start. Before each prediction that follows an update the unlikely ones become inactive and the neighbors
    of the likely ones active; the most probable one always has active neighbors. Same interface as `Imm`; an inactive model
    has probability 0 and turn rate NaN, and its `filter_estimate` is its last belief.
    
    Parameters
    ----------
    filter : Kalman, Ekf, Ukf or SquareRootUkf over CoordinatedTurn
        What all models are like; its turn rate does not matter.
    grid_rad_s : (2 to 16,) array, optional
        Turn rates, rising; 2 deg/s apart up to 4 deg/s to each side when left out.
    unlikely_threshold : float
        A model less probable than this becomes inactive.
    likely_threshold : float
        The neighbors of a model at least as probable as this become active.
    stay_probability : float
        Of the models' chain: to stay; the rest is shared equally by the other active models.
    chain : ModeChain, optional
        Another chain of as many modes, instead of `stay_probability`; transitions to inactive models go to the active ones.
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
    def __copy__(self) -> LikelyModelSetImm:
        ...
    def __deepcopy__(self, memo: dict) -> LikelyModelSetImm:
        ...
    def __init__(self, filter: Filter, grid_rad_s: ArrayLike | None = None, *, unlikely_threshold: float = 0.03, likely_threshold: float = 0.1, stay_probability: float = 0.9, chain: ModeChain | None = None, initial_mode_probability: ArrayLike | None = None) -> None:
        ...
    def filter_estimate(self, index: int) -> Gaussian:
        """
        The belief of one of the filters, over its own state.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def turn_rates_rad_s(self: Estimator) -> NDArray[np.float64]:
        """
        (K,) turn rates of the models, positive to starboard; NaN for one at rest.
        """
class ModeHistory(MultiModelEstimator):
    """
    A tree of turn-rate histories without mixing.
    
    Each hypothesis is one filter with its history. In a prediction every hypothesis keeps its turn rate or switches to another one; an
    update weights the hypotheses by their likelihood, merges similar ones and keeps the likeliest. Same interface as `Imm`;
    `mode_probability` has one number per turn rate of the grid.
    
    Parameters
    ----------
    filter : Kalman, Ekf, Ukf or SquareRootUkf over CoordinatedTurn, or Ekf, Ukf or SquareRootUkf over CoordinatedTurnRate
        Prototype of the hypotheses; its turn rate does not matter. Over CoordinatedTurnRate each hypothesis learns its rate: when it
        enters a mode, it starts at the rate of the grid with `prior_turn_rate_std_rad_s` (the straightest with a tenth of it); the
        estimated rate is in the state. A fifth of the grid's step, and `turn_rate_psd_rad2s3` of 0, keep the modes distinct.
    grid_rad_s : (2 to 16,) array, optional
        Increasing turn rates; default -4 to 4 degrees per second in steps of 1.
    grid_std_rad_s : (K,) array, optional
        For filters over CoordinatedTurnRate: initial standard deviation of the rate around each rate of the grid, instead of
        `prior_turn_rate_std_rad_s` and a tenth of it. Nearly zero (1e-4 rad/s) at known rates and more at some between them, which
        are then learnt, is nearly as good as either alternative where that one is right.
    grid_weight : (K,) array, optional
        Relative frequency of each rate among turns; that of the straightest does not matter. Default: all equal.
    straight_sojourn_s, turn_sojourn_s : float
        Mean sojourn on a straight (the straightest rate of the grid) and in a turn, after `min_segment_s`. The defaults suit small
        craft that turn often; ships go straight for minutes.
    straighten_probability : float
        Probability that a turn ends in a straight; other turns are equally probable.
    chain : ModeChain, optional
        Another chain, instead of those three and `grid_weight`.
    initial_mode_probability : (K,) array, optional
        Initial probabilities; default 0.9 for the straightest.
        max_hypotheses : int
        Maximum kept after an update; at least K.
    max_branches : int
        Maximum filtered in a scan, at most 256: the kept hypotheses and their likeliest switches.
    min_segment_s : float
        Minimum time between switches.
    merge_distance : float
        Hypotheses of one turn rate within this Mahalanobis distance (in the covariance of the more probable one) merge; 0: none.
    sibling_distance : float
        The same for hypotheses that switched to it in one scan and differ only before that; at least `merge_distance`.
    switch_time_spread : float
        Uncertainty of the switch time within a scan: this share, 0 to 1, of the variance of a uniform time.
    negligible_probability : float
        Less probable hypotheses are dropped.
    
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
    def of(filters: Sequence[Filter], chain: ModeChain, initial_mode_probability: ArrayLike | None = None, *, max_hypotheses: int = 75, max_branches: int = 100, min_segment_s: float = 12.0, merge_distance: float = 1.9, sibling_distance: float = 12.0, switch_time_spread: float = 0.15, negligible_probability: float = 1e-07) -> ModeHistory:
        """
        A tree whose modes differ in turn rate and noise.
        
        Parameters
        ----------
        filters : sequence of 1 to 16 filters
            One per mode, of one kind (Kalman, Ekf, Ukf or SquareRootUkf), all over CoordinatedTurn or all over
            CoordinatedTurnRate. In the latter case a straight has a prior rate of 0, `prior_turn_rate_std_rad_s` of nearly zero and
            `turn_rate_psd_rad2s3` of 0; a hypothesis adopts the rate of a mode when it enters it, unless the previous mode had the
            same prior.
        chain : ModeChain
            Of as many modes.
        initial_mode_probability : (K,) array, optional
            Mode probabilities at a start; equal by default.
        max_hypotheses, max_branches, min_segment_s, merge_distance, sibling_distance, switch_time_spread, negligible_probability
            As of the class.
        
        Raises
        ------
        TypeError
            When `filters` is not a sequence of filters.
        ValueError
            When the filters are of different kinds, or a parameter is invalid.
        """
    @staticmethod
    def pseudo_bayes(order: int, filter: Filter, grid_rad_s: ArrayLike | None = None, *, stay_probability: float = 0.9, chain: ModeChain | None = None, initial_mode_probability: ArrayLike | None = None) -> ModeHistory:
        """
        The generalized pseudo-Bayes estimator of an order: GPB1, GPB2, ...
              
              Histories with the same last ``order - 1`` turn rates merge in every scan.
        
        Parameters
        ----------
        order : int
            1 or more, 2 or more over CoordinatedTurnRate; K to the power of it is at most 256.
        filter, grid_rad_s, chain, initial_mode_probability
            As of the class.
        stay_probability : float
            Of the turn rates' chain where none is given: to stay; the rest is shared equally by the others.
        
        Raises
        ------
        ValueError
            When a parameter makes no sense.
        
        References
        ----------
        Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, 11.6.3-11.6.5.
        """
    def __copy__(self) -> ModeHistory:
        ...
    def __deepcopy__(self, memo: dict) -> ModeHistory:
        ...
    def __init__(self, filter: Filter, grid_rad_s: ArrayLike | None = None, *, grid_std_rad_s: ArrayLike | None = None, grid_weight: ArrayLike | None = None, straight_sojourn_s: float = 40.0, turn_sojourn_s: float = 70.0, straighten_probability: float = 0.85, chain: ModeChain | None = None, initial_mode_probability: ArrayLike | None = None, max_hypotheses: int = 75, max_branches: int = 100, min_segment_s: float = 12.0, merge_distance: float = 1.9, sibling_distance: float = 12.0, switch_time_spread: float = 0.15, negligible_probability: float = 1e-07) -> None:
        ...
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def turn_rates_rad_s(self) -> NDArray[np.float64]:
        """
        (K,) turn rates of the modes, positive to starboard. Learnt rates are in the state.
        """
    @property
    def hypothesis_count(self) -> int:
        """
        Current number of hypotheses.
        """
class BayesianAlphaBeta(MultiModelEstimator):
    """
    Lines and parabolas through the last plots, weighted by Bayes' rule.
    
    Each member predicts the next plot with a known variance: the plot's, times one plus the member's noise factor. The plot's
    likelihood is the evidence, and the right member is a Markov chain. The estimate is the mixture. Like `FuzzyAlphaBeta` it uses
    many plots on a straight and few in a turn, but without its usual residual, which a turn inflates, its hold and its hard choice;
    parabolas follow a turn. Same interface as `Imm`, with one mode per member: lines first, shorter before longer, then parabolas.
    
    Uses the position of any sensor; innovations are in north and east.
    
    Parameters
    ----------
    min_plots, max_plots : int
        Lengths of the shortest and the longest line, 2 to 16; at most 16 members in all.
    parabolas : bool
        Whether there are also parabolas, through at least four plots.
    sojourn_s : float
        Mean sojourn of the right member.
    longest_line_probability : float
        Prior of the longest line; the other members are equally probable.
    acceleration_std_mps2 : float
        Per axis, of a maneuver since the last plot but one: increases the covariance, not used in the weights.
    
    Raises
    ------
    ValueError
        When a parameter makes no sense.
    """
    def __copy__(self) -> BayesianAlphaBeta:
        ...
    def __deepcopy__(self, memo: dict) -> BayesianAlphaBeta:
        ...
    def __init__(self, *, min_plots: int = 2, max_plots: int = 10, parabolas: bool = True, sojourn_s: float = 30.0, longest_line_probability: float = 0.4, acceleration_std_mps2: float = 0.15) -> None:
        ...
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    @property
    def plots_of_mode(self) -> NDArray[np.int32]:
        """
        (K,) number of plots of each member.
        """
class FuzzyTrace:
    """
    Result of `FuzzyAlphaBeta.trace`: arrays over scans, and over runs if there are several; NaN without residuals.
    """
    def __getstate__(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.int32]]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    @property
    def chosen(self) -> NDArray[np.int32]:
        """
        (..., T) plots of the selected line
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
        (..., T) output of the Sugeno system
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
class FuzzyAlphaBeta(MultiModelEstimator):
    """
    A line through the last plots, with their number from a fuzzy criterion: many on a straight, few in a turn.
    
    In each scan the plot is compared with the predictions of the lines through the last 2, 3, ... plots. Each line has the ratio of
    its residual to `sigma_hat_m`, the mean residual of the shortest line since the start; ``bad(ratio) = 1 / (1 + exp(-steepness
    (ratio - threshold)))`` and ``good = 1 - bad``. Rule p of a zero-order Sugeno system: if the first p lines are good and the rest
    bad, track with ``max(2, p + 1)`` plots. The estimate is the line through the weighted mean of these numbers of plots. Before
    the second plot it is the initial belief, predicted and updated as in a Kalman filter. A plot within a sixteenth of a step after
    the previous one is merged with it, without an effect on the choice.
    
    Same interface as `Imm`, with one mode per line. Uses the position of any sensor; innovations are in north and east.
    
    Parameters
    ----------
    max_plots : int
        Length of the longest line, 2 to 16.
    steepness, threshold : float
        Of the membership functions.
    clip : float
        Upper limit of the ratios.
    t_norm : {'product', 'minimum'}
        Combination of degrees.
    hold : bool
        Whether the greater of the last two outputs is used, against single outliers.
    acceleration_std_mps2 : float
        Per axis, of a maneuver since the last plot but one: increases the covariance, not used in the choice.
    
    Raises
    ------
    ValueError
        When a parameter makes no sense.
    
    References
    ----------
    V. M. Grinyak, M. V. Trofimov, Multi-model tracking of moving vessels with a fuzzy criterion of maneuver detection.
    """
    def __copy__(self) -> FuzzyAlphaBeta:
        ...
    def __deepcopy__(self, memo: dict) -> FuzzyAlphaBeta:
        ...
    def __init__(self, *, max_plots: int = 10, steepness: float = 5.0, threshold: float = 1.5, clip: float = 3.0, t_norm: str = 'product', hold: bool = True, acceleration_std_mps2: float = 0.5) -> None:
        ...
    def evaluate(self, ratios: ArrayLike) -> tuple[float, NDArray[np.float64]]:
        """
        The Sugeno system alone: its output and the strengths (n + 1,) of its rules for the ratios (n,), not negative, of the lines through 2, 3, ... plots.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def trace(self, z: ArrayLike, dt_s: ArrayLike, sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position, start: Gaussian | Sequence[Gaussian]) -> FuzzyTrace:
        """
        Inputs and outputs of the criterion in every scan of whole recordings.
        
        Parameters
        ----------
        z, dt_s, sensor, start
            As for `run`.
        
        Returns
        -------
        FuzzyTrace
        
        Raises
        ------
        ValueError
            When a shape does not fit.
        FilterError
            When the estimator cannot start.
        """
    @property
    def chosen(self) -> int:
        """
        Plots of the selected line.
        """
    @property
    def plots_of_mode(self) -> NDArray[np.int32]:
        """
        (K,) number of plots that each line goes through.
        """
    @property
    def quality(self) -> float:
        """
        Output of the Sugeno system at the last plot, before it is held and rounded; NaN without one.
        """
    @property
    def residual_ratios(self) -> NDArray[np.float64]:
        """
        For each line at the last plot: its residual / `sigma_hat_m`, clipped.
        """
    @property
    def rule_strengths(self) -> NDArray[np.float64]:
        """
        Strength of each rule.
        """
    @property
    def sigma_hat_m(self) -> float:
        """
        Mean residual of the shortest line since the start; NaN before the first one.
        """
