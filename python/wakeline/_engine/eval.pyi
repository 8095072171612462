"""
Consistency of estimators, and bounds.
"""
import numpy as np
from numpy.typing import ArrayLike, NDArray
from .measurement import ConvertedRangeBearing, Position, RangeBearing, RangeBearingDoppler
__all__: list = ['SetDistance', 'set_distance', 'nees', 'consistency_bounds', 'cramer_rao_bound']
class SetDistance:
    """
    GOSPA (alpha = 2) and OSPA of one scan.
    
    The parts are in metres to the power of the order: ``gospa_m ** order = localisation + missed + false_tracks``.
    """
    def __getstate__(self) -> tuple[float, float, float, float, float, int]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    @property
    def false_tracks(self) -> float:
        """
        cutoff_m ** order / 2 for each track without a target.
        """
    @property
    def gospa_m(self) -> float:
        ...
    @property
    def localisation(self) -> float:
        """
        Sum over pairs of d ** order.
        """
    @property
    def missed(self) -> float:
        """
        cutoff_m ** order / 2 for each target without a track.
        """
    @property
    def ospa_m(self) -> float:
        """
        At most the cut-off.
        """
    @property
    def pairs(self) -> int:
        """
        Targets with a track nearer than the cut-off.
        """
def consistency_bounds(confidence: float, dof: int, samples: int) -> tuple[float, float]:
    """
    (lower, upper) bounds of the average NEES or NIS of that many samples of a consistent estimator.
    """
def cramer_rao_bound(transition: ArrayLike, process_noise: ArrayLike, states: ArrayLike, sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position, start_covariance: ArrayLike, detection_probability: float = 1.0) -> NDArray[np.float64]:
    """
    The posterior Cramér-Rao bound of a vessel whose motion is known.
    
    `P' = F P Fᵀ + Q`, then `P'⁻¹ = P⁻¹ + p Hᵀ R⁻¹ H`, at the true states.
    
    Parameters
    ----------
    transition, process_noise : (T, 4, 4) array
        F and Q from the previous reading to each reading; the first from the start.
    states : (T, 4) array
        True states [x, vx, y, vy] (m, m/s) at the readings; a row of NaN is a missed scan.
    sensor : RangeBearing, ConvertedRangeBearing, RangeBearingDoppler or Position
    start_covariance : (4, 4) array
        Covariance of the prior.
    detection_probability : float
        Probability p of a reading.
    
    Returns
    -------
    (T, 4, 4) array
        The least covariance of an unbiased estimator after each reading.
    
    Raises
    ------
    ValueError
        When a shape does not fit, the prior is not positive definite or p is not from 0 to 1.
    FilterError
        When a step fails.
    """
def nees(error: ArrayLike, covariance: ArrayLike) -> NDArray[np.float64]:
    """
    Normalised estimation error squared ``e' inv(P) e`` of any number of errors.
    
    Of innovations and their covariances it is the NIS. Chi-square with N degrees of freedom where the covariance is right.
    
    Parameters
    ----------
    error : (..., N) array_like
        Estimate minus truth, N from 1 to 9.
    covariance : (..., N, N) array_like
        Symmetric; its lower triangle is read.
    
    Returns
    -------
    (...) array
        NaN where the covariance is not positive definite or a number is not finite.
    
    Raises
    ------
    ValueError
        When a shape does not fit.
    """
def set_distance(truth_m: ArrayLike, tracks_m: ArrayLike, cutoff_m: float = 50.0, order: float = 2.0) -> SetDistance:
    """
    GOSPA and OSPA: how far a set of tracks is from the set of true targets, in one scan.
    
    With the cut-off c, the order p and the best pairing of targets with tracks,
    ``gospa_m ** p = sum of d ** p over pairs + c ** p / 2 for each point without a pair`` and
    ``ospa_m ** p = (sum of d ** p over pairs + c ** p (n - pairs)) / n`` for n the size of the larger set; zero where both are empty.
    
    Parameters
    ----------
    truth_m : (N, D) array_like
        True positions; `[]` for none.
    tracks_m : (M, D) array_like
        Estimated positions; `[]` for none.
    cutoff_m : float
        Distance at which a pair is as bad as a missed target and a false track.
    order : float
        p, at least 1.
    
    Raises
    ------
    ValueError
        When a shape does not fit, a position is not finite, the cut-off is not positive and finite, or the order is below 1 or
        so high that the cut-off to its power overflows.
    
    References
    ----------
    A. S. Rahmathullah, A. F. Garcia-Fernandez, L. Svensson, Generalized Optimal Sub-Pattern Assignment Metric, Fusion 2017;
    D. Schuhmacher, B.-T. Vo, B.-N. Vo, A Consistent Metric for Performance Evaluation of Multi-Object Filters, IEEE Trans. Signal
    Processing 56(8), 2008.
    """
