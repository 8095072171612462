"""
How a vessel moves.
"""

import typing

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "ConstantAcceleration",
    "ConstantVelocity",
    "CoordinatedTurn",
    "CoordinatedTurnRate",
    "PiecewiseAcceleration",
    "ProcessNoise",
    "Singer",
    "WanderingCourse",
    "WhiteAcceleration",
    "WhiteJerk",
]

class WhiteAcceleration:
    """
    Continuous white acceleration per axis; Q is right for any dt.
    """
    def __copy__(self) -> WhiteAcceleration: ...
    def __deepcopy__(self, memo: dict) -> WhiteAcceleration: ...
    def __init__(self, *, psd_m2s3: float = 0.1) -> None: ...
    @property
    def psd_m2s3(self) -> float: ...

class PiecewiseAcceleration:
    """
    Acceleration drawn for each step, Q = G s² Gᵀ: the papers' form.
    """
    def __copy__(self) -> PiecewiseAcceleration: ...
    def __deepcopy__(self, memo: dict) -> PiecewiseAcceleration: ...
    def __init__(self, *, std_mps2: float = 0.1) -> None: ...
    @property
    def std_mps2(self) -> float: ...

class WhiteJerk:
    """
    Continuous white jerk per axis, for states that hold an acceleration.
    """
    def __copy__(self) -> WhiteJerk: ...
    def __deepcopy__(self, memo: dict) -> WhiteJerk: ...
    def __init__(self, *, psd_m2s5: float = 0.01) -> None: ...
    @property
    def psd_m2s5(self) -> float: ...

class ProcessNoise:
    """
    One of the process-noise policies.
    """
    def __getstate__(self) -> tuple[int, float]: ...
    @typing.overload
    def __init__(self, policy: WhiteAcceleration, /) -> None: ...
    @typing.overload
    def __init__(self, policy: PiecewiseAcceleration, /) -> None: ...
    @typing.overload
    def __init__(self, policy: WhiteJerk, /) -> None: ...
    def __setstate__(self, arg0: tuple) -> None: ...

class ConstantVelocity:
    """
    Straight and steady: state [x, vx, y, vy] (m, m/s).
    """

    states: typing.ClassVar[int] = 4
    def __copy__(self) -> ConstantVelocity: ...
    def __deepcopy__(self, memo: dict) -> ConstantVelocity: ...
    def __init__(
        self, *, noise: ProcessNoise | WhiteAcceleration | PiecewiseAcceleration | WhiteJerk = ...
    ) -> None: ...
    def matrix(self, dt_s: float) -> NDArray[np.float64]:
        """
        F(dt), (N, N).
        """
    def process_noise(self, dt_s: float) -> NDArray[np.float64]:
        """
        Q(dt), (N, N).
        """

class WanderingCourse:
    """
    Straight and nearly steady, with an acceleration that grows with the speed: state [x, vx, y, vy].
    """

    states: typing.ClassVar[int] = 4
    def __copy__(self) -> WanderingCourse: ...
    def __deepcopy__(self, memo: dict) -> WanderingCourse: ...
    def __init__(
        self, *, psd_m2s3: float = 0.01, course_psd_rad2s: float = 0.01, max_speed_mps: float = 30.0
    ) -> None: ...
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

class ConstantAcceleration:
    """
    Acceleration that stays: state [x, vx, ax, y, vy, ay] (m, m/s, m/s²).
    """

    states: typing.ClassVar[int] = 6
    def __copy__(self) -> ConstantAcceleration: ...
    def __deepcopy__(self, memo: dict) -> ConstantAcceleration: ...
    def __init__(
        self,
        *,
        noise: ProcessNoise | WhiteAcceleration | PiecewiseAcceleration | WhiteJerk = ...,
        prior_accel_std_mps2: float = 1.0,
    ) -> None: ...
    def matrix(self, dt_s: float) -> NDArray[np.float64]:
        """
        F(dt), (N, N).
        """
    def process_noise(self, dt_s: float) -> NDArray[np.float64]:
        """
        Q(dt), (N, N).
        """

class CoordinatedTurn:
    """
    A steady turn at a known rate, positive to starboard: state [x, vx, y, vy].
    """

    states: typing.ClassVar[int] = 4
    def __copy__(self) -> CoordinatedTurn: ...
    def __deepcopy__(self, memo: dict) -> CoordinatedTurn: ...
    def __init__(
        self,
        *,
        turn_rate_rad_s: float = 0.0,
        noise: ProcessNoise | WhiteAcceleration | PiecewiseAcceleration | WhiteJerk = ...,
    ) -> None: ...
    def matrix(self, dt_s: float) -> NDArray[np.float64]:
        """
        F(dt), (N, N).
        """
    def process_noise(self, dt_s: float) -> NDArray[np.float64]:
        """
        Q(dt), (N, N).
        """
    @property
    def turn_rate_rad_s(self) -> float: ...

class CoordinatedTurnRate:
    """
    A turn whose rate is part of the state and wanders: [x, vx, y, vy, omega] (m, m/s, rad/s); it returns to the prior rate within `turn_rate_time_s`, or never where that is 0.
    """

    states: typing.ClassVar[int] = 5
    def __copy__(self) -> CoordinatedTurnRate: ...
    def __deepcopy__(self, memo: dict) -> CoordinatedTurnRate: ...
    def __init__(
        self,
        *,
        noise: ProcessNoise | WhiteAcceleration | PiecewiseAcceleration | WhiteJerk = ...,
        turn_rate_psd_rad2s3: float = 0.0001,
        prior_turn_rate_std_rad_s: float = 0.05235987755982989,
        course_psd_rad2s: float = 0.0,
        max_speed_mps: float = 30.0,
        prior_turn_rate_rad_s: float = 0.0,
        turn_rate_time_s: float = 0.0,
    ) -> None: ...
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

class Singer:
    """
    Singer's maneuvering target: state [x, vx, ax, y, vy, ay] (m, m/s, m/s²).
    """

    states: typing.ClassVar[int] = 6
    def __copy__(self) -> Singer: ...
    def __deepcopy__(self, memo: dict) -> Singer: ...
    def __init__(self, *, maneuver_time_s: float = 20.0, accel_std_mps2: float = 0.5) -> None: ...
    def matrix(self, dt_s: float) -> NDArray[np.float64]:
        """
        F(dt), (N, N).
        """
    def process_noise(self, dt_s: float) -> NDArray[np.float64]:
        """
        Q(dt), (N, N).
        """
