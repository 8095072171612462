"""
Motion models.
"""
import typing
import numpy as np
from numpy.typing import ArrayLike, NDArray
__all__: list = ['WhiteAcceleration', 'PiecewiseAcceleration', 'WhiteJerk', 'ProcessNoise', 'ConstantVelocity', 'WanderingCourse', 'ConstantAcceleration', 'CoordinatedTurn', 'CoordinatedTurnRate', 'Singer']
class WhiteAcceleration:
    """
    Continuous white acceleration per axis; Q is consistent for any dt.
    
    Parameters
    ----------
    psd_m2s3 : float, default 0.1
        Power spectral density of the acceleration, per axis. In m²/s³, 0 to 1e9.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> WhiteAcceleration:
        ...
    def __deepcopy__(self, memo: dict) -> WhiteAcceleration:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, psd_m2s3: float = 0.1) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    @property
    def psd_m2s3(self) -> float:
        """
        Power spectral density of the acceleration, per axis. In m²/s³, 0 to 1e9. Default 0.1.
        """
class PiecewiseAcceleration:
    """
    Acceleration constant over each step, Q = G s² Gᵀ: the papers' form.
    
    Parameters
    ----------
    std_mps2 : float, default 0.1
        Standard deviation of the acceleration of a step, per axis. In m/s², 0 to 1e6.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> PiecewiseAcceleration:
        ...
    def __deepcopy__(self, memo: dict) -> PiecewiseAcceleration:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, std_mps2: float = 0.1) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    @property
    def std_mps2(self) -> float:
        """
        Standard deviation of the acceleration of a step, per axis. In m/s², 0 to 1e6. Default 0.1.
        """
class WhiteJerk:
    """
    Continuous white jerk per axis, for states with an acceleration.
    
    Parameters
    ----------
    psd_m2s5 : float, default 0.01
        Power spectral density of the jerk, per axis. In m²/s⁵, 0 to 1e9.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> WhiteJerk:
        ...
    def __deepcopy__(self, memo: dict) -> WhiteJerk:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, psd_m2s5: float = 0.01) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    @property
    def psd_m2s5(self) -> float:
        """
        Power spectral density of the jerk, per axis. In m²/s⁵, 0 to 1e9. Default 0.01.
        """
class ProcessNoise:
    """
    One of the process-noise policies.
    """
    def __copy__(self) -> ProcessNoise:
        ...
    def __deepcopy__(self, memo: dict) -> ProcessNoise:
        ...
    @typing.overload
    def __init__(self, policy: WhiteAcceleration) -> None:
        ...
    @typing.overload
    def __init__(self, policy: PiecewiseAcceleration) -> None:
        ...
    @typing.overload
    def __init__(self, policy: WhiteJerk) -> None:
        ...
class ConstantVelocity:
    """
    Constant velocity: state [x, vx, y, vy] (m, m/s).
    
    Parameters
    ----------
    noise : WhiteAcceleration | PiecewiseAcceleration | WhiteJerk, default WhiteAcceleration(psd_m2s3=0.1)
        Process noise.
    """
    states: typing.ClassVar[int] = 4
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> ConstantVelocity:
        ...
    def __deepcopy__(self, memo: dict) -> ConstantVelocity:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, noise: WhiteAcceleration | PiecewiseAcceleration | WhiteJerk = ...) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def matrix(self, dt_s: float) -> NDArray[np.float64]:
        """
        F(dt), (N, N).
        """
    def process_noise(self, dt_s: float) -> NDArray[np.float64]:
        """
        Q(dt), (N, N).
        """
    @property
    def noise(self) -> WhiteAcceleration | PiecewiseAcceleration | WhiteJerk:
        """
        Process noise. Default WhiteAcceleration(psd_m2s3=0.1).
        """
class WanderingCourse:
    """
    Nearly constant velocity with course noise that grows with the speed: state [x, vx, y, vy].
    
    Parameters
    ----------
    psd_m2s3 : float, default 0.01
        Power spectral density of the acceleration at rest. In m²/s³, 0 to 1e9.
    course_psd_rad2s : float, default 0.01
        Power spectral density of the course noise, which grows with the speed. In rad²/s, 0 to 1000.
    max_speed_mps : float, default 30.0
        Speed up to which the course noise grows. In m/s, 1e-9 to 1e6.
    """
    states: typing.ClassVar[int] = 4
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> WanderingCourse:
        ...
    def __deepcopy__(self, memo: dict) -> WanderingCourse:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, psd_m2s3: float = 0.01, course_psd_rad2s: float = 0.01, max_speed_mps: float = 30.0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def jacobian(self, x: ArrayLike, dt_s: float) -> NDArray[np.float64]:
        """
        df/dx, (N, N).
        """
    def process_noise(self, x: ArrayLike, dt_s: float) -> NDArray[np.float64]:
        """
        Q(x, dt), (N, N).
        """
    def transition(self, x: ArrayLike, dt_s: float) -> NDArray[np.float64]:
        """
        f(x, dt), (N,).
        """
    @property
    def course_psd_rad2s(self) -> float:
        """
        Power spectral density of the course noise, which grows with the speed. In rad²/s, 0 to 1000. Default 0.01.
        """
    @property
    def max_speed_mps(self) -> float:
        """
        Speed up to which the course noise grows. In m/s, 1e-9 to 1e6. Default 30.0.
        """
    @property
    def psd_m2s3(self) -> float:
        """
        Power spectral density of the acceleration at rest. In m²/s³, 0 to 1e9. Default 0.01.
        """
class ConstantAcceleration:
    """
    Constant acceleration: state [x, vx, ax, y, vy, ay] (m, m/s, m/s²).
    
    Parameters
    ----------
    noise : WhiteAcceleration | PiecewiseAcceleration | WhiteJerk, default WhiteJerk(psd_m2s5=0.01)
        Process noise.
    prior_accel_std_mps2 : float, default 1.0
        Standard deviation of the acceleration, per axis, for a start that does not know it. In m/s², 1e-9 to 1e6.
    """
    states: typing.ClassVar[int] = 6
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> ConstantAcceleration:
        ...
    def __deepcopy__(self, memo: dict) -> ConstantAcceleration:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, noise: WhiteAcceleration | PiecewiseAcceleration | WhiteJerk = ..., prior_accel_std_mps2: float = 1.0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def matrix(self, dt_s: float) -> NDArray[np.float64]:
        """
        F(dt), (N, N).
        """
    def process_noise(self, dt_s: float) -> NDArray[np.float64]:
        """
        Q(dt), (N, N).
        """
    @property
    def noise(self) -> WhiteAcceleration | PiecewiseAcceleration | WhiteJerk:
        """
        Process noise. Default WhiteJerk(psd_m2s5=0.01).
        """
    @property
    def prior_accel_std_mps2(self) -> float:
        """
        Standard deviation of the acceleration, per axis, for a start that does not know it. In m/s², 1e-9 to 1e6. Default 1.0.
        """
class CoordinatedTurn:
    """
    A coordinated turn at a known rate, positive to starboard: state [x, vx, y, vy].
    
    Parameters
    ----------
    turn_rate_rad_s : float, default 0.0
        Turn rate, positive to starboard. In rad/s, -1000 to 1000.
    noise : WhiteAcceleration | PiecewiseAcceleration | WhiteJerk, default WhiteAcceleration(psd_m2s3=0.1)
        Process noise.
    """
    states: typing.ClassVar[int] = 4
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> CoordinatedTurn:
        ...
    def __deepcopy__(self, memo: dict) -> CoordinatedTurn:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, turn_rate_rad_s: float = 0.0, noise: WhiteAcceleration | PiecewiseAcceleration | WhiteJerk = ...) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def matrix(self, dt_s: float) -> NDArray[np.float64]:
        """
        F(dt), (N, N).
        """
    def process_noise(self, dt_s: float) -> NDArray[np.float64]:
        """
        Q(dt), (N, N).
        """
    @property
    def noise(self) -> WhiteAcceleration | PiecewiseAcceleration | WhiteJerk:
        """
        Process noise. Default WhiteAcceleration(psd_m2s3=0.1).
        """
    @property
    def turn_rate_rad_s(self) -> float:
        """
        Turn rate, positive to starboard. In rad/s, -1000 to 1000. Default 0.0.
        """
class CoordinatedTurnRate:
    """
    A coordinated turn with the rate in the state: [x, vx, y, vy, omega] (m, m/s, rad/s); the rate returns to its prior with `turn_rate_time_s`, or is a random walk if that is 0.
    
    Parameters
    ----------
    noise : WhiteAcceleration | PiecewiseAcceleration | WhiteJerk, default WhiteAcceleration(psd_m2s3=0.1)
        Process noise of the acceleration.
    turn_rate_psd_rad2s3 : float, default 0.0001
        Power spectral density of the noise of the turn rate. In rad²/s³, 0 to 1000.
    prior_turn_rate_std_rad_s : float, default 0.0523599
        Standard deviation of the turn rate for a start that does not know it. In rad/s, 1e-9 to 1000.
    course_psd_rad2s : float, default 0.0
        Power spectral density of the course noise, which grows with the speed. In rad²/s, 0 to 1000.
    max_speed_mps : float, default 30.0
        Speed up to which the course noise grows. In m/s, 1e-9 to 1e6.
    prior_turn_rate_rad_s : float, default 0.0
        Mean of the turn rate for such a start, to which it returns. In rad/s, -1000 to 1000.
    turn_rate_time_s : float, default 0.0
        Correlation time in which the turn rate returns to its prior; 0: never. In s, 0 to 1e12.
    """
    states: typing.ClassVar[int] = 5
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> CoordinatedTurnRate:
        ...
    def __deepcopy__(self, memo: dict) -> CoordinatedTurnRate:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, noise: WhiteAcceleration | PiecewiseAcceleration | WhiteJerk = ..., turn_rate_psd_rad2s3: float = 0.0001, prior_turn_rate_std_rad_s: float = 0.05235987755982989, course_psd_rad2s: float = 0.0, max_speed_mps: float = 30.0, prior_turn_rate_rad_s: float = 0.0, turn_rate_time_s: float = 0.0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def jacobian(self, x: ArrayLike, dt_s: float) -> NDArray[np.float64]:
        """
        df/dx, (N, N).
        """
    def process_noise(self, x: ArrayLike, dt_s: float) -> NDArray[np.float64]:
        """
        Q(x, dt), (N, N).
        """
    def transition(self, x: ArrayLike, dt_s: float) -> NDArray[np.float64]:
        """
        f(x, dt), (N,).
        """
    @property
    def course_psd_rad2s(self) -> float:
        """
        Power spectral density of the course noise, which grows with the speed. In rad²/s, 0 to 1000. Default 0.0.
        """
    @property
    def max_speed_mps(self) -> float:
        """
        Speed up to which the course noise grows. In m/s, 1e-9 to 1e6. Default 30.0.
        """
    @property
    def noise(self) -> WhiteAcceleration | PiecewiseAcceleration | WhiteJerk:
        """
        Process noise of the acceleration. Default WhiteAcceleration(psd_m2s3=0.1).
        """
    @property
    def prior_turn_rate_rad_s(self) -> float:
        """
        Mean of the turn rate for such a start, to which it returns. In rad/s, -1000 to 1000. Default 0.0.
        """
    @property
    def prior_turn_rate_std_rad_s(self) -> float:
        """
        Standard deviation of the turn rate for a start that does not know it. In rad/s, 1e-9 to 1000. Default 0.0523599.
        """
    @property
    def turn_rate_psd_rad2s3(self) -> float:
        """
        Power spectral density of the noise of the turn rate. In rad²/s³, 0 to 1000. Default 0.0001.
        """
    @property
    def turn_rate_time_s(self) -> float:
        """
        Correlation time in which the turn rate returns to its prior; 0: never. In s, 0 to 1e12. Default 0.0.
        """
class Singer:
    """
    Singer's model of a maneuvering target: state [x, vx, ax, y, vy, ay] (m, m/s, m/s²).
    
    Parameters
    ----------
    maneuver_time_s : float, default 20.0
        Correlation time of the acceleration. In s, 1e-9 to 1e12.
    accel_std_mps2 : float, default 0.5
        Stationary standard deviation of the acceleration, per axis. In m/s², 1e-9 to 1e6.
    """
    states: typing.ClassVar[int] = 6
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> Singer:
        ...
    def __deepcopy__(self, memo: dict) -> Singer:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, maneuver_time_s: float = 20.0, accel_std_mps2: float = 0.5) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def matrix(self, dt_s: float) -> NDArray[np.float64]:
        """
        F(dt), (N, N).
        """
    def process_noise(self, dt_s: float) -> NDArray[np.float64]:
        """
        Q(dt), (N, N).
        """
    @property
    def accel_std_mps2(self) -> float:
        """
        Stationary standard deviation of the acceleration, per axis. In m/s², 1e-9 to 1e6. Default 0.5.
        """
    @property
    def maneuver_time_s(self) -> float:
        """
        Correlation time of the acceleration. In s, 1e-9 to 1e12. Default 20.0.
        """
