"""
Sensors.
"""
import typing
import numpy as np
from numpy.typing import ArrayLike, NDArray
from .core import Gaussian
__all__: list = ['OwnShip', 'RangeBearing', 'ConvertedRangeBearing', 'Position', 'RangeBearingDoppler', 'conversion_bias_ratio', 'conversion_bias_matters']
class OwnShip:
    """
    Where the antenna is when it measures, and how well that is known.
    
    Parameters
    ----------
    north_m : float, default 0.0
        Position of the antenna to the north. In m, -1e9 to 1e9.
    east_m : float, default 0.0
        Position of the antenna to the east. In m, -1e9 to 1e9.
    vnorth_mps : float, default 0.0
        Velocity to the north. In m/s, -1e6 to 1e6.
    veast_mps : float, default 0.0
        Velocity to the east. In m/s, -1e6 to 1e6.
    position_std_m : float, default 0.0
        Standard deviation of the position, per axis. In m, 0 to 1e9.
    velocity_std_mps : float, default 0.0
        Standard deviation of the velocity, per axis. In m/s, 0 to 1e6.
    heading_std_rad : float, default 0.0
        Standard deviation of the heading, which turns every bearing. In rad, 0 to pi, in radians.
    """
    __hash__: typing.ClassVar[None]  # type: ignore[assignment]
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> OwnShip:
        ...
    def __deepcopy__(self, memo: dict) -> OwnShip:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __init__(self, *, north_m: float = 0.0, east_m: float = 0.0, vnorth_mps: float = 0.0, veast_mps: float = 0.0, position_std_m: float = 0.0, velocity_std_mps: float = 0.0, heading_std_rad: float = 0.0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    east_m: float
    """
    Position of the antenna to the east. In m, -1e9 to 1e9. Default 0.0.
    """
    heading_std_rad: float
    """
    Standard deviation of the heading, which turns every bearing. In rad, 0 to pi, in radians. Default 0.0.
    """
    north_m: float
    """
    Position of the antenna to the north. In m, -1e9 to 1e9. Default 0.0.
    """
    position_std_m: float
    """
    Standard deviation of the position, per axis. In m, 0 to 1e9. Default 0.0.
    """
    veast_mps: float
    """
    Velocity to the east. In m/s, -1e6 to 1e6. Default 0.0.
    """
    velocity_std_mps: float
    """
    Standard deviation of the velocity, per axis. In m/s, 0 to 1e6. Default 0.0.
    """
    vnorth_mps: float
    """
    Velocity to the north. In m/s, -1e6 to 1e6. Default 0.0.
    """
class RangeBearing:
    """
    A plot [range m, bearing rad] for Ekf and Ukf.
    
    Parameters
    ----------
    range_std_m : float, default 10.0
        Standard deviation of the range. In m, 1e-9 to 1e9.
    bearing_std_rad : float, default 0.0174533
        Standard deviation of the bearing. In rad, 1e-9 to pi, in radians.
    extent_std_m : float, default 0.0
        Standard deviation of the echo's position on the hull, per axis. In m, 0 to 1e9.
    bearing_offset_rad : float, default 0.0
        Measured minus true bearing. In rad, -10 to 10.
    own : OwnShip, default OwnShip(north_m=0.0, east_m=0.0, vnorth_mps=0.0, veast_mps=0.0, position_std_m=0.0, velocity_std_mps=0.0, heading_std_rad=0.0)
        Position of the antenna, with its standard deviation and that of the heading.
    """
    __hash__: typing.ClassVar[None]  # type: ignore[assignment]
    measurements: typing.ClassVar[int] = 2
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> RangeBearing:
        ...
    def __deepcopy__(self, memo: dict) -> RangeBearing:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __init__(self, *, range_std_m: float = 10.0, bearing_std_rad: float = 0.017453292519943295, extent_std_m: float = 0.0, bearing_offset_rad: float = 0.0, own: OwnShip = ...) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def jacobian(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        dh/dx of those components.
        """
    def measure(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        h of the components that the sensor reads ([x, y], or [x, vx, y, vy]), (M,).
        """
    def observe(self, z: ArrayLike) -> Gaussian:
        """
        The reading as value and covariance R, converted if the sensor is.
        """
    def position(self, z: ArrayLike) -> Gaussian:
        """
        The reading in north/east, m: mean (2,), covariance (2, 2).
        """
    bearing_offset_rad: float
    """
    Measured minus true bearing. In rad, -10 to 10. Default 0.0.
    """
    bearing_std_rad: float
    """
    Standard deviation of the bearing. In rad, 1e-9 to pi, in radians. Default 0.0174533.
    """
    extent_std_m: float
    """
    Standard deviation of the echo's position on the hull, per axis. In m, 0 to 1e9. Default 0.0.
    """
    own: OwnShip
    """
    Position of the antenna, with its standard deviation and that of the heading. Default OwnShip(north_m=0.0, east_m=0.0, vnorth_mps=0.0, veast_mps=0.0, position_std_m=0.0, velocity_std_mps=0.0, heading_std_rad=0.0).
    """
    range_std_m: float
    """
    Standard deviation of the range. In m, 1e-9 to 1e9. Default 10.0.
    """
class ConvertedRangeBearing:
    """
    A plot [range m, bearing rad] converted to north/east with its covariance: linear.
    
    Parameters
    ----------
    range_std_m : float, default 10.0
        Standard deviation of the range. In m, 1e-9 to 1e9.
    bearing_std_rad : float, default 0.0174533
        Standard deviation of the bearing. In rad, 1e-9 to pi, in radians.
    extent_std_m : float, default 0.0
        Standard deviation of the echo's position on the hull, per axis. In m, 0 to 1e9.
    bearing_offset_rad : float, default 0.0
        Measured minus true bearing. In rad, -10 to 10.
    own : OwnShip, default OwnShip(north_m=0.0, east_m=0.0, vnorth_mps=0.0, veast_mps=0.0, position_std_m=0.0, velocity_std_mps=0.0, heading_std_rad=0.0)
        Position of the antenna, with its standard deviation and that of the heading.
    unbiased : bool, default True
        Mean and covariance are corrected for the curvature of the bearing error, and the covariance is that at a filter's prediction.
    """
    __hash__: typing.ClassVar[None]  # type: ignore[assignment]
    measurements: typing.ClassVar[int] = 2
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> ConvertedRangeBearing:
        ...
    def __deepcopy__(self, memo: dict) -> ConvertedRangeBearing:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __init__(self, *, range_std_m: float = 10.0, bearing_std_rad: float = 0.017453292519943295, extent_std_m: float = 0.0, bearing_offset_rad: float = 0.0, own: OwnShip = ..., unbiased: bool = True) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def jacobian(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        dh/dx of those components.
        """
    def measure(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        h of the components that the sensor reads ([x, y], or [x, vx, y, vy]), (M,).
        """
    def observe(self, z: ArrayLike) -> Gaussian:
        """
        The reading as value and covariance R, converted if the sensor is.
        """
    def position(self, z: ArrayLike) -> Gaussian:
        """
        The reading in north/east, m: mean (2,), covariance (2, 2).
        """
    bearing_offset_rad: float
    """
    Measured minus true bearing. In rad, -10 to 10. Default 0.0.
    """
    bearing_std_rad: float
    """
    Standard deviation of the bearing. In rad, 1e-9 to pi, in radians. Default 0.0174533.
    """
    extent_std_m: float
    """
    Standard deviation of the echo's position on the hull, per axis. In m, 0 to 1e9. Default 0.0.
    """
    own: OwnShip
    """
    Position of the antenna, with its standard deviation and that of the heading. Default OwnShip(north_m=0.0, east_m=0.0, vnorth_mps=0.0, veast_mps=0.0, position_std_m=0.0, velocity_std_mps=0.0, heading_std_rad=0.0).
    """
    range_std_m: float
    """
    Standard deviation of the range. In m, 1e-9 to 1e9. Default 10.0.
    """
    unbiased: bool
    """
    Mean and covariance are corrected for the curvature of the bearing error, and the covariance is that at a filter's prediction. Default True.
    """
class Position:
    """
    A position [north m, east m] with an isotropic error.
    
    Parameters
    ----------
    position_std_m : float, default 10.0
        Standard deviation of the position, per axis. In m, 1e-9 to 1e9.
    """
    measurements: typing.ClassVar[int] = 2
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> Position:
        ...
    def __deepcopy__(self, memo: dict) -> Position:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, position_std_m: float = 10.0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def jacobian(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        dh/dx of those components.
        """
    def measure(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        h of the components that the sensor reads ([x, y], or [x, vx, y, vy]), (M,).
        """
    def observe(self, z: ArrayLike) -> Gaussian:
        """
        The reading as value and covariance R, converted if the sensor is.
        """
    def position(self, z: ArrayLike) -> Gaussian:
        """
        The reading in north/east, m: mean (2,), covariance (2, 2).
        """
    @property
    def position_std_m(self) -> float:
        """
        Standard deviation of the position, per axis. In m, 1e-9 to 1e9. Default 10.0.
        """
class RangeBearingDoppler:
    """
    A plot [range m, bearing rad, range rate m/s], relative to own ship.
    
    Parameters
    ----------
    range_std_m : float, default 10.0
        Standard deviation of the range. In m, 1e-9 to 1e9.
    bearing_std_rad : float, default 0.0174533
        Standard deviation of the bearing. In rad, 1e-9 to pi, in radians.
    extent_std_m : float, default 0.0
        Standard deviation of the echo's position on the hull, per axis. In m, 0 to 1e9.
    bearing_offset_rad : float, default 0.0
        Measured minus true bearing. In rad, -10 to 10.
    own : OwnShip, default OwnShip(north_m=0.0, east_m=0.0, vnorth_mps=0.0, veast_mps=0.0, position_std_m=0.0, velocity_std_mps=0.0, heading_std_rad=0.0)
        Position of the antenna, with its standard deviation and that of the heading.
    range_rate_std_mps : float, default 1.0
        Standard deviation of the range rate. In m/s, 1e-9 to 1e6.
    """
    __hash__: typing.ClassVar[None]  # type: ignore[assignment]
    measurements: typing.ClassVar[int] = 3
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> RangeBearingDoppler:
        ...
    def __deepcopy__(self, memo: dict) -> RangeBearingDoppler:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __init__(self, *, range_std_m: float = 10.0, bearing_std_rad: float = 0.017453292519943295, extent_std_m: float = 0.0, bearing_offset_rad: float = 0.0, own: OwnShip = ..., range_rate_std_mps: float = 1.0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def jacobian(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        dh/dx of those components.
        """
    def measure(self, x: ArrayLike) -> NDArray[np.float64]:
        """
        h of the components that the sensor reads ([x, y], or [x, vx, y, vy]), (M,).
        """
    def observe(self, z: ArrayLike) -> Gaussian:
        """
        The reading as value and covariance R, converted if the sensor is.
        """
    def position(self, z: ArrayLike) -> Gaussian:
        """
        The reading in north/east, m: mean (2,), covariance (2, 2).
        """
    bearing_offset_rad: float
    """
    Measured minus true bearing. In rad, -10 to 10. Default 0.0.
    """
    bearing_std_rad: float
    """
    Standard deviation of the bearing. In rad, 1e-9 to pi, in radians. Default 0.0174533.
    """
    extent_std_m: float
    """
    Standard deviation of the echo's position on the hull, per axis. In m, 0 to 1e9. Default 0.0.
    """
    own: OwnShip
    """
    Position of the antenna, with its standard deviation and that of the heading. Default OwnShip(north_m=0.0, east_m=0.0, vnorth_mps=0.0, veast_mps=0.0, position_std_m=0.0, velocity_std_mps=0.0, heading_std_rad=0.0).
    """
    range_rate_std_mps: float
    """
    Standard deviation of the range rate. In m/s, 1e-9 to 1e6. Default 1.0.
    """
    range_std_m: float
    """
    Standard deviation of the range. In m, 1e-9 to 1e9. Default 10.0.
    """
def conversion_bias_matters(range_m: ArrayLike, range_std_m: ArrayLike, bearing_std_rad: ArrayLike) -> NDArray[np.bool_]:
    """
    Whether the bias of the plain polar conversion matters: ratio above 0.4.
    """
def conversion_bias_ratio(range_m: ArrayLike, range_std_m: ArrayLike, bearing_std_rad: ArrayLike) -> NDArray[np.float64]:
    """
    r sb² / sr: twice the bias of the plain polar conversion, r sb² / 2, over the range error.
    """
