"""
Estimators with several motion models.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .core import Gaussian, Step
from .filter import Filter, RunResult
from .measurement import ConvertedRangeBearing, Position, RangeBearing, RangeBearingDoppler

__all__ = ["Imm", "ModeChain"]

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
    def from_sojourn_s(sojourn_s: ArrayLike) -> ModeChain:
        """
        The chain that stays in mode k for sojourn_s[k] seconds on average and leaves to each other mode alike.
        """
    def __init__(self, matrix: ArrayLike, period_s: float | None = None) -> None: ...
    def transition(self, dt_s: float) -> NDArray[np.float64]:
        """
        P(dt), (K, K).
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
    def __init__(
        self,
        filters: Sequence[Filter],
        chain: ModeChain,
        initial_mode_probability: ArrayLike | None = None,
    ) -> None: ...
    def estimate(self) -> Gaussian:
        """
        The moment-matched belief: over the state where all filters share one, else over [x, vx, y, vy].
        """
    def filter_estimate(self, index: int) -> Gaussian:
        """
        The belief of one of the filters, over its own state.
        """
    def mode_probability(self) -> NDArray[np.float64]:
        """
        (K,)
        """
    def predict(self, dt_s: float) -> None:
        """
        Mixes and moves dt_s seconds on; mode probabilities follow the chain.
        """
    def run(
        self,
        z: ArrayLike,
        dt_s: ArrayLike,
        sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
        start: Gaussian | Sequence[Gaussian],
        own_position_m: ArrayLike | None = None,
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

        Returns
        -------
        RunResult
            mean (..., T, N), covariance (..., T, N, N), mode_probability (..., T, K), nis, log_likelihood and status (..., T).

        Raises
        ------
        ValueError
            When a shape does not fit.
        FilterError
            When an estimator cannot start. A step that fails later is marked in `status` and changes nothing.
        """
    def start(self, belief: Gaussian) -> None:
        """
        Begins with a belief over [x, vx, y, vy], or over the state that all filters share.
        """
    def update(
        self,
        sensor: RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position,
        z: ArrayLike,
    ) -> Step:
        """
        Corrects every model and weighs them; returns the Step.
        """
    @property
    def models(self) -> int: ...
    @property
    def started(self) -> bool: ...
