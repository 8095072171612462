"""
What a sensor reports.
"""

import typing

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .core import Gaussian

__all__ = [
    "ConvertedRangeBearing",
    "OwnShip",
    "Position",
    "RangeBearing",
    "RangeBearingDoppler",
    "conversion_bias_matters",
    "conversion_bias_ratio",
]

class OwnShip:
    """
    Where the antenna is when it measures, and how well that is known.
    """
    def __copy__(self) -> OwnShip: ...
    def __deepcopy__(self, memo: dict) -> OwnShip: ...
    def __init__(
        self,
        *,
        north_m: float = 0.0,
        east_m: float = 0.0,
        vnorth_mps: float = 0.0,
        veast_mps: float = 0.0,
        position_std_m: float = 0.0,
        velocity_std_mps: float = 0.0,
        heading_std_rad: float = 0.0,
    ) -> None: ...
    east_m: float
    heading_std_rad: float
    north_m: float
    position_std_m: float
    veast_mps: float
    velocity_std_mps: float
    vnorth_mps: float

class RangeBearing:
    """
    A plot [range m, bearing rad] for Ekf and Ukf.

    Parameters
    ----------
    range_std_m, bearing_std_rad : float
        Standard deviations of the radar.
    extent_std_m : float
        Wander of the echo over the vessel's hull, per axis.
    bearing_offset_rad : float
        Bearing read minus true bearing.
    own : OwnShip
        Where the antenna is, and how well that and the heading are known.
    """

    measurements: typing.ClassVar[int] = 2
    own: OwnShip
    def __copy__(self) -> RangeBearing: ...
    def __deepcopy__(self, memo: dict) -> RangeBearing: ...
    def __init__(
        self,
        *,
        range_std_m: float = 10.0,
        bearing_std_rad: float = 0.017453292519943295,
        extent_std_m: float = 0.0,
        bearing_offset_rad: float = 0.0,
        own: OwnShip = ...,
    ) -> None: ...
    def jacobian(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        dh/dx of those components.
        """
    def measure(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        h of the components the sensor reads ([x, y], or [x, vx, y, vy]), (M,).
        """
    def observe(self, z: ArrayLike) -> Gaussian:
        """
        The reading as value and covariance R, converted where the sensor is.
        """
    def position(self, z: ArrayLike) -> Gaussian:
        """
        The reading in north/east, m: mean (2,), covariance (2, 2).
        """
    @property
    def bearing_offset_rad(self) -> float: ...
    @property
    def bearing_std_rad(self) -> float: ...
    @property
    def extent_std_m(self) -> float: ...
    @property
    def range_std_m(self) -> float: ...

class ConvertedRangeBearing:
    """
    A plot [range m, bearing rad] turned into north/east with its own covariance: linear.

    Parameters
    ----------
    range_std_m, bearing_std_rad : float
        Standard deviations of the radar.
    extent_std_m : float
        Wander of the echo over the vessel's hull, per axis.
    bearing_offset_rad : float
        Bearing read minus true bearing.
    own : OwnShip
        Where the antenna is, and how well that and the heading are known.
    unbiased : bool
        Correct mean and covariance for the curvature of the bearing error.
    """

    measurements: typing.ClassVar[int] = 2
    own: OwnShip
    def __copy__(self) -> ConvertedRangeBearing: ...
    def __deepcopy__(self, memo: dict) -> ConvertedRangeBearing: ...
    def __init__(
        self,
        *,
        range_std_m: float = 10.0,
        bearing_std_rad: float = 0.017453292519943295,
        unbiased: bool = True,
        extent_std_m: float = 0.0,
        bearing_offset_rad: float = 0.0,
        own: OwnShip = ...,
    ) -> None: ...
    def jacobian(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        dh/dx of those components.
        """
    def measure(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        h of the components the sensor reads ([x, y], or [x, vx, y, vy]), (M,).
        """
    def observe(self, z: ArrayLike) -> Gaussian:
        """
        The reading as value and covariance R, converted where the sensor is.
        """
    def position(self, z: ArrayLike) -> Gaussian:
        """
        The reading in north/east, m: mean (2,), covariance (2, 2).
        """
    @property
    def bearing_offset_rad(self) -> float: ...
    @property
    def bearing_std_rad(self) -> float: ...
    @property
    def extent_std_m(self) -> float: ...
    @property
    def range_std_m(self) -> float: ...
    @property
    def unbiased(self) -> bool: ...

class RangeBearingDoppler:
    """
    A plot [range m, bearing rad, range rate m/s], the rate as own ship sees it.

    Parameters
    ----------
    range_std_m, bearing_std_rad : float
        Standard deviations of the radar.
    extent_std_m : float
        Wander of the echo over the vessel's hull, per axis.
    bearing_offset_rad : float
        Bearing read minus true bearing.
    own : OwnShip
        Where the antenna is, and how well that and the heading are known.
    range_rate_std_mps : float
        Standard deviation of the range rate.
    """

    measurements: typing.ClassVar[int] = 3
    own: OwnShip
    def __copy__(self) -> RangeBearingDoppler: ...
    def __deepcopy__(self, memo: dict) -> RangeBearingDoppler: ...
    def __init__(
        self,
        *,
        range_std_m: float = 10.0,
        bearing_std_rad: float = 0.017453292519943295,
        range_rate_std_mps: float = 1.0,
        extent_std_m: float = 0.0,
        bearing_offset_rad: float = 0.0,
        own: OwnShip = ...,
    ) -> None: ...
    def jacobian(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        dh/dx of those components.
        """
    def measure(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        h of the components the sensor reads ([x, y], or [x, vx, y, vy]), (M,).
        """
    def observe(self, z: ArrayLike) -> Gaussian:
        """
        The reading as value and covariance R, converted where the sensor is.
        """
    def position(self, z: ArrayLike) -> Gaussian:
        """
        The reading in north/east, m: mean (2,), covariance (2, 2).
        """
    @property
    def bearing_offset_rad(self) -> float: ...
    @property
    def bearing_std_rad(self) -> float: ...
    @property
    def extent_std_m(self) -> float: ...
    @property
    def range_rate_std_mps(self) -> float: ...
    @property
    def range_std_m(self) -> float: ...

class Position:
    """
    A position [north m, east m] with equal error in every direction.
    """

    measurements: typing.ClassVar[int] = 2
    def __copy__(self) -> Position: ...
    def __deepcopy__(self, memo: dict) -> Position: ...
    def __init__(self, *, position_std_m: float = 10.0) -> None: ...
    def jacobian(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        dh/dx of those components.
        """
    def measure(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        h of the components the sensor reads ([x, y], or [x, vx, y, vy]), (M,).
        """
    def observe(self, z: ArrayLike) -> Gaussian:
        """
        The reading as value and covariance R, converted where the sensor is.
        """
    def position(self, z: ArrayLike) -> Gaussian:
        """
        The reading in north/east, m: mean (2,), covariance (2, 2).
        """
    @property
    def position_std_m(self) -> float: ...

def conversion_bias_matters(
    range_m: ArrayLike, range_std_m: ArrayLike, bearing_std_rad: ArrayLike
) -> NDArray[np.bool_]:
    """
    True when the plain polar conversion is biased enough to matter: ratio above 0.4.
    """

def conversion_bias_ratio(
    range_m: ArrayLike, range_std_m: ArrayLike, bearing_std_rad: ArrayLike
) -> NDArray[np.float64]:
    """
    r sb² / sr: twice the bias of the plain polar conversion, r sb² / 2, over the range error.
    """
