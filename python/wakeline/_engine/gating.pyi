"""
Where to look for a target's plot.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..recording.video import RadarVideo
from .core import Gaussian
from .video import ScanImage

__all__ = [
    "ChiSquareGate",
    "CovarianceStrobe",
    "RadiusGate",
    "RangeBearingWindow",
    "StrobeEcho",
    "strobe_echo",
]

class ChiSquareGate:
    """
    The ellipsoid that holds the target's own plot with a given probability.
    """
    def __copy__(self) -> ChiSquareGate: ...
    def __deepcopy__(self, memo: dict) -> ChiSquareGate: ...
    def __init__(self, *, probability: float = 0.99) -> None: ...
    def threshold(self, dof: int) -> float:
        """
        Largest normalised innovation squared inside, for `dof` measured quantities, at least 1; else NaN.
        """
    @property
    def probability(self) -> float: ...

class RadiusGate:
    """
    A circle of fixed radius about the predicted position.
    """
    def __copy__(self) -> RadiusGate: ...
    def __deepcopy__(self, memo: dict) -> RadiusGate: ...
    def __init__(self, *, radius_m: float = 100.0) -> None: ...
    def contains(self, predicted_m: ArrayLike, plot_m: ArrayLike) -> bool:
        """
        Whether a plot [north, east] lies inside.
        """
    @property
    def radius_m(self) -> float: ...

class CovarianceStrobe:
    """
    The gate of an estimator about the predicted position.

    Parameters
    ----------
    innovation_covariance_m2 : (2, 2) array
        Of north and east: what the estimator expects of a plot.
    gate : ChiSquareGate
        How sure it shall be to hold the plot.

    Raises
    ------
    ValueError
        When the covariance is not symmetric positive definite.
    """
    def __copy__(self) -> CovarianceStrobe: ...
    def __deepcopy__(self, memo: dict) -> CovarianceStrobe: ...
    def __init__(self, innovation_covariance_m2: ArrayLike, gate: ChiSquareGate = ...) -> None: ...
    def contains(self, predicted_m: ArrayLike, plot_m: ArrayLike) -> bool:
        """
        Whether a plot [north, east] lies inside.
        """
    @property
    def innovation_covariance_m2(self) -> NDArray[np.float64]:
        """
        (2, 2)
        """
    @property
    def threshold(self) -> float:
        """
        largest normalised innovation squared inside
        """

class RangeBearingWindow:
    """
    Ranges and bearings from the antenna near the predicted ones.
    """
    def __copy__(self) -> RangeBearingWindow: ...
    def __deepcopy__(self, memo: dict) -> RangeBearingWindow: ...
    def __init__(
        self, *, range_half_m: float = 100.0, bearing_half_rad: float = 0.017453292519943295
    ) -> None: ...
    def contains(self, predicted_m: ArrayLike, plot_m: ArrayLike) -> bool:
        """
        Whether a plot [north, east] lies inside.
        """
    @property
    def bearing_half_rad(self) -> float: ...
    @property
    def range_half_m(self) -> float: ...

class StrobeEcho:
    """
    The echo in a strobe as a measurement; true when there is one.
    """
    def __bool__(self) -> bool: ...
    @property
    def bearing_rad(self) -> float:
        """
        clockwise from north, 0 to 2 pi
        """
    @property
    def cells(self) -> int:
        """
        measured
        """
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (2, 2) of `range_m` and `bearing_rad`
        """
    @property
    def cut(self) -> bool:
        """
        part of the strobe lies outside the picture
        """
    @property
    def echoes(self) -> int:
        """
        that do not touch, measured or not; 0 when there were too many to tell apart
        """
    @property
    def peak_amplitude(self) -> int: ...
    @property
    def position(self) -> Gaussian:
        """
        north and east from the antenna, m; NaN without a measurement
        """
    @property
    def range_m(self) -> float:
        """
        of the centre of mass
        """
    @property
    def status(self) -> str:
        """
        'ok'; 'cut', 'touches edge', 'several echoes' or 'crowded', the last of these that holds; 'empty', 'outside' or 'invalid' without a measurement
        """
    @property
    def strobe_cells(self) -> int:
        """
        of the picture inside the strobe, whatever their amplitude
        """
    @property
    def total_amplitude(self) -> float: ...
    @property
    def touches_edge(self) -> bool:
        """
        what was measured goes on beyond the strobe
        """

def strobe_echo(
    video: RadarVideo | ScanImage,
    strobe: RadiusGate | CovarianceStrobe | RangeBearingWindow,
    predicted_m: ArrayLike,
    *,
    least_amplitude: int = 1,
    pedestal: int = 0,
    several: str = "all",
) -> StrobeEcho:
    """
    The echo in a strobe: the centre of mass of the amplitudes inside.

    A cell is inside when its centre is. The centre of mass is that of range and bearing, which the
    width of the beam does not shorten. Its covariance is the weighted spread over the effective number
    of cells, plus what the grid rounds away.

    Parameters
    ----------
    video : RadarVideo or ScanImage
        One turn or less, at even steps of azimuth.
    strobe : RadiusGate, CovarianceStrobe or RangeBearingWindow
    predicted_m : (2,) array
        North and east from the antenna.
    least_amplitude : int
        Cells below it do not count. Set it above the noise, which else draws the centre of mass to the
        prediction.
    pedestal : int
        Taken from the amplitude of every cell that counts; below `least_amplitude`.
    several : {'all', 'nearest', 'strongest'}
        Which is measured of several echoes that do not touch: the centre of mass of all, the one
        nearest to the prediction, or the one of the largest weight.

    Returns
    -------
    StrobeEcho
        With the status 'invalid' when the prediction is not finite.

    Raises
    ------
    ValueError
        When a setting makes no sense, or the sweeps do not run clockwise at even steps.

    References
    ----------
    Grinyak, Trofimov, "Multi-model tracking of moving vessels with a fuzzy criterion of maneuver
    detection".
    """
