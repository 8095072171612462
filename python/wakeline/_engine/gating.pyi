"""
Gates and strobes for a target's plot.
"""
import typing
import numpy as np
from numpy.typing import ArrayLike, NDArray
from ..recording.video import RadarVideo
from .core import Gaussian
from .video import ScanImage
__all__: list = ['ChiSquareGate', 'RadiusGate', 'CovarianceStrobe', 'RangeBearingWindow', 'StrobeEcho', 'strobe_echo']
class ChiSquareGate:
    """
    The ellipsoid that holds the target's own plot with a given probability.
    
    Parameters
    ----------
    probability : float, default 0.99
        Probability that the plot of a target is inside the gate. Above 0 and below 1.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> ChiSquareGate:
        ...
    def __deepcopy__(self, memo: dict) -> ChiSquareGate:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, probability: float = 0.99) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def threshold(self, dof: int) -> float:
        """
        Largest normalized innovation squared inside, for `dof` measured quantities, at least 1; else NaN.
        """
    @property
    def probability(self) -> float:
        """
        Probability that the plot of a target is inside the gate. Above 0 and below 1. Default 0.99.
        """
class RadiusGate:
    """
    A circle of fixed radius around the predicted position.
    
    Parameters
    ----------
    radius_m : float, default 100.0
        Radius about the predicted position. In m, 1e-9 to 1e9.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> RadiusGate:
        ...
    def __deepcopy__(self, memo: dict) -> RadiusGate:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, radius_m: float = 100.0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def contains(self, predicted_m: ArrayLike, plot_m: ArrayLike) -> bool:
        """
        Whether a plot [north, east] is inside.
        """
    @property
    def radius_m(self) -> float:
        """
        Radius about the predicted position. In m, 1e-9 to 1e9. Default 100.0.
        """
class CovarianceStrobe:
    """
    The gate of an estimator around the predicted position.
    
    Parameters
    ----------
    innovation_covariance_m2 : (2, 2) array
        Innovation covariance over north and east.
    gate : ChiSquareGate
        Its probability to contain the plot.
    
    Raises
    ------
    ValueError
        When the covariance is not symmetric positive definite.
    """
    def __copy__(self) -> CovarianceStrobe:
        ...
    def __deepcopy__(self, memo: dict) -> CovarianceStrobe:
        ...
    def __init__(self, innovation_covariance_m2: ArrayLike, gate: ChiSquareGate = ...) -> None:
        ...
    def contains(self, predicted_m: ArrayLike, plot_m: ArrayLike) -> bool:
        """
        Whether a plot [north, east] is inside.
        """
    @property
    def innovation_covariance_m2(self) -> NDArray[np.float64]:
        """
        (2, 2)
        """
    @property
    def threshold(self) -> float:
        """
        largest normalized innovation squared inside
        """
class RangeBearingWindow:
    """
    A window of range and bearing around the predicted position.
    
    Parameters
    ----------
    range_half_m : float, default 100.0
        Half the length of the window along range. In m, 1e-9 to 1e9.
    bearing_half_rad : float, default 0.0174533
        Half the width of the window in bearing, at most pi. In rad, above 0 and at most 3.14159.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> RangeBearingWindow:
        ...
    def __deepcopy__(self, memo: dict) -> RangeBearingWindow:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, range_half_m: float = 100.0, bearing_half_rad: float = 0.017453292519943295) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def contains(self, predicted_m: ArrayLike, plot_m: ArrayLike) -> bool:
        """
        Whether a plot [north, east] is inside.
        """
    @property
    def bearing_half_rad(self) -> float:
        """
        Half the width of the window in bearing, at most pi. In rad, above 0 and at most 3.14159. Default 0.0174533.
        """
    @property
    def range_half_m(self) -> float:
        """
        Half the length of the window along range. In m, 1e-9 to 1e9. Default 100.0.
        """
class StrobeEcho:
    """
    The echo in a strobe as a measurement; true when there is one.
    """
    def __bool__(self) -> bool:
        ...
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
        part of the strobe is outside the picture
        """
    @property
    def echoes(self) -> int:
        """
        separate echoes, measured or not; 0 if there were too many to separate
        """
    @property
    def peak_amplitude(self) -> int:
        ...
    @property
    def position(self) -> Gaussian:
        """
        north and east from the antenna, m; NaN without a measurement
        """
    @property
    def range_m(self) -> float:
        """
        of the centroid
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
    def total_amplitude(self) -> float:
        ...
    @property
    def touches_edge(self) -> bool:
        """
        the measured echo extends beyond the strobe
        """
def strobe_echo(video: RadarVideo | ScanImage, strobe: RadiusGate | CovarianceStrobe | RangeBearingWindow, predicted_m: ArrayLike, *, least_amplitude: int = 1, pedestal: int = 0, several: str = 'all') -> StrobeEcho:
    """
    The echo in a strobe: the centroid of the amplitudes inside.
    
    A cell is inside if its center is. The centroid is that of range and bearing, which the width of the
    beam does not bias. Its covariance is the weighted spread divided by the effective number of cells,
    plus the quantization of the grid.
    
    Parameters
    ----------
    video : RadarVideo or ScanImage
        At most one revolution, at even steps of azimuth.
    strobe : RadiusGate, CovarianceStrobe or RangeBearingWindow
    predicted_m : (2,) array
        North and east from the antenna.
    least_amplitude : int
        Cells below it do not count. Set it above the noise, which otherwise biases the centroid towards
        the prediction.
    pedestal : int
        Subtracted from the amplitude of every cell that counts; below `least_amplitude`.
    several : {'all', 'nearest', 'strongest'}
        Which of several separate echoes is measured: the centroid of all, the one nearest to the
        prediction, or the one with the largest weight.
    
    Returns
    -------
    StrobeEcho
        With the status 'invalid' if the prediction is not finite.
    
    Raises
    ------
    ValueError
        When a setting is invalid, or the sweeps are not clockwise at even steps.
    
    References
    ----------
    Grinyak, Trofimov, "Multi-model tracking of moving vessels with a fuzzy criterion of maneuver
    detection".
    """
