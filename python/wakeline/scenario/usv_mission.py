"""An unmanned surface vessel on a mission: waypoints, obstacles, current and sensors.

The simulator of "Sensor system information processing in unmanned navigation applications"
(P. S. Evsyukov, O. N. Andreeva, V. V. Khanychev): 800 m by 800 m, guided by bearings.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

import wakeline as wl
from wakeline._brief import brief, many, span
from wakeline._checks import (
    entropy,
    not_negative,
    number_fields,
    positive,
    real_numbers,
    whole_number,
)

_LONGEST_STEPS = 5000
_SHAPES = {
    "current_towards_rad": (),
    "start_heading_rad": (),
    "imu_bias": (3,),
    "imu_std": (3,),
    "gnss_std_m": (2,),
    "compass_std_rad": (),
}


class Obstacle(NamedTuple):
    """A disc to avoid."""

    north_m: float
    east_m: float
    radius_m: float


class UsvVoyage(NamedTuple):
    """True motion on a mission, at T times.

    Attributes
    ----------
    time_s : ndarray (T,)
    position_m, velocity_mps : ndarray (T, 2)
        [north, east]; the velocity is over ground.
    heading_rad : ndarray (T,)
    imu : ndarray (T, 3)
        [forward m/s², starboard m/s², yaw rate rad/s] of the step that ends at each time,
        without errors; the first row is NaN.
    """

    time_s: np.ndarray
    position_m: np.ndarray
    velocity_mps: np.ndarray
    heading_rad: np.ndarray
    imu: np.ndarray

    def __repr__(self) -> str:
        return brief(self, many(len(self.time_s), "state"), span(self.time_s))


class UsvLogs(NamedTuple):
    """Sensor readings of R runs at T times; NaN in the first row of each.

    Attributes
    ----------
    imu : ndarray (R, T, 3)
    gnss : ndarray (R, T, 2)
    compass : ndarray (R, T)
        In [-pi, pi].
    """

    imu: np.ndarray
    gnss: np.ndarray
    compass: np.ndarray

    def __repr__(self) -> str:
        runs, times = np.atleast_2d(self.compass).shape
        return brief(self, many(runs, "run"), many(times, "time"))


@dataclass(frozen=True)
class UsvMission:
    """From (0, 0) to (800, 800) m through waypoints, around obstacles.

    In each step the vessel turns towards its aim by

        clip(wrap(bearing - heading), -w T, w T),

    with w the largest rate of turn. The aim is the waypoint, or, where the straight line to it is
    too close to an obstacle, the tangent to the circle of clearance around that obstacle. A current
    carries the vessel along. A waypoint is reached once it is closer than `accept_m`.

    The paper gives the area, the sensors and the currents. The other defaults are ours.

    Attributes
    ----------
    current_mps, current_towards_rad : float
    allow_for_current : bool
        Whether the vessel points up into the current, so that its course over ground leads to the
        aim.
    waypoints_m : tuple of (north, east)
    obstacles : tuple of Obstacle
    clearance_m : float
        Distance between the edge of an obstacle and the circle of clearance.
    accept_m, speed_mps, start_heading_rad, turn_rate_rad_s, period_s : float
        The speed is through the water.
    imu_bias, imu_std : tuple of 3 floats
        [forward m/s², starboard m/s², yaw rate rad/s]; the noise is constant over a step.
    gnss_std_m : (north, east)
    compass_std_rad : float

    Raises
    ------
    ValueError
        When a quantity that must be positive is not, the current or a standard deviation is
        negative, or a number is not finite.
    """

    current_mps: float = 0.5
    current_towards_rad: float = np.deg2rad(90.0)
    allow_for_current: bool = False
    waypoints_m: tuple[tuple[float, float], ...] = (
        *((200.0, 300.0), (450.0, 420.0)),
        *((620.0, 700.0), (800.0, 800.0)),
    )
    obstacles: tuple[Obstacle, ...] = (
        Obstacle(95.0, 150.0, 20.0),
        Obstacle(330.0, 370.0, 15.0),
        Obstacle(545.0, 570.0, 25.0),
    )
    clearance_m: float = 10.0
    accept_m: float = 10.0
    speed_mps: float = 1.0
    start_heading_rad: float = np.deg2rad(150.0)
    turn_rate_rad_s: float = np.deg2rad(5.0)
    period_s: float = 1.0
    imu_bias: tuple[float, float, float] = (0.03, 0.02, np.deg2rad(0.28))
    imu_std: tuple[float, float, float] = (0.004, 0.004, np.deg2rad(0.033))
    gnss_std_m: tuple[float, float] = (8.0, 7.0)
    compass_std_rad: float = np.deg2rad(1.0)

    def __post_init__(self) -> None:
        names = ("clearance_m", "accept_m", "speed_mps", "turn_rate_rad_s", "period_s")
        positive(**number_fields(self, *names))
        not_negative(current_mps=self.current_mps)
        for name, shape in _SHAPES.items():
            value = getattr(self, name)
            numbers = real_numbers(name, value)
            if numbers.shape != shape or not np.isfinite(numbers).all():
                raise ValueError(f"{name} must be finite and have shape {shape}, got {value}")
            if "_std" in name and (numbers < 0).any():
                raise ValueError(f"{name} must be zero or more, got {value}")
        ways = real_numbers("waypoints_m", self.waypoints_m)
        if ways.ndim != 2 or ways.shape[1] != 2 or not np.isfinite(ways).all():
            raise ValueError(f"waypoints_m must be pairs of finite numbers, got {self.waypoints_m}")
        for obstacle in self.obstacles:
            if not (np.isfinite(obstacle).all() and obstacle.radius_m > 0):
                raise ValueError(f"obstacles must be finite with positive radius, got {obstacle}")

    @property
    def current(self) -> np.ndarray:
        """[north, east] m/s."""
        return self.current_mps * _towards(self.current_towards_rad)

    @cached_property
    def voyage(self) -> UsvVoyage:
        """The true motion.

        Raises
        ------
        ValueError
            When a waypoint is not reached because the current is too strong.
        """
        most = self.turn_rate_rad_s * self.period_s
        position, heading = np.zeros(2), self.start_heading_rad
        velocity = self._over_ground(heading)
        states, readings = [(*position, *velocity, heading)], [np.full(3, np.nan)]
        for way in np.asarray(self.waypoints_m, dtype=float):
            while np.hypot(*(way - position)) >= self.accept_m:
                turn = np.clip(wl.wrap_angle(self._aim(position, way) - heading), -most, most)
                before, slow = heading, velocity
                heading = wl.wrap_angle(before + turn)
                velocity = self._over_ground(heading)
                position = position + self.period_s * (slow + velocity) / 2
                push = (velocity - slow) / self.period_s
                felt = push @ _body_to_north_east(before + turn / 2)
                states.append((*position, *velocity, heading))
                readings.append(np.array([*felt, turn / self.period_s]))
                if len(states) > _LONGEST_STEPS:
                    raise ValueError(
                        f"waypoint {way} is not reached in {len(states)} steps; reduce current_mps"
                    )
        rows = np.array(states)
        return UsvVoyage(
            time_s=self.period_s * np.arange(len(rows)),
            position_m=rows[:, :2],
            velocity_mps=rows[:, 2:4],
            heading_rad=rows[:, 4],
            imu=np.array(readings),
        )

    def draw(self, runs: int, seed: int | Sequence[int] = 0) -> UsvLogs:
        """Independent runs of the sensors; run r does not depend on their number.

        Raises
        ------
        ValueError
            When runs or a seed is negative or not an integer.
        """
        whole_number("runs", runs, 0)
        truth = self.voyage
        begin = entropy(seed, "usv mission")
        noise = np.empty((runs, len(truth.time_s), 6))
        for run in range(runs):
            np.random.default_rng([*begin, run]).standard_normal(out=noise[run])
        noise[:, 0] = np.nan
        return UsvLogs(
            imu=truth.imu + self.imu_bias + noise[..., :3] * self.imu_std,
            gnss=truth.position_m + noise[..., 3:5] * self.gnss_std_m,
            compass=wl.wrap_angle(truth.heading_rad + noise[..., 5] * self.compass_std_rad),
        )

    def _over_ground(self, heading_rad: float) -> np.ndarray:
        return self.speed_mps * _towards(heading_rad) + self.current

    def _aim(self, position: np.ndarray, way: np.ndarray) -> float:
        """The heading to steer."""
        bearing = self._bearing(position, way)
        if not self.allow_for_current:
            return bearing
        across = self.current_mps * np.sin(self.current_towards_rad - bearing) / self.speed_mps
        return bearing - np.arcsin(np.clip(across, -1.0, 1.0))

    def _bearing(self, position: np.ndarray, way: np.ndarray) -> float:
        """Bearing to the waypoint, or past the nearest obstacle in between."""
        bearing = _bearing_of(way - position)
        reach = np.hypot(*(way - position))
        nearest = np.inf
        for obstacle in self.obstacles:
            to = np.array(obstacle[:2]) - position
            distance, keep = np.hypot(*to), obstacle.radius_m + self.clearance_m
            off = wl.wrap_angle(_bearing_of(way - position) - _bearing_of(to))
            along, across = distance * np.cos(off), distance * abs(np.sin(off))
            if 0 < along < reach and across < keep and distance < nearest:
                nearest = distance
                tangent = np.arcsin(min(keep / distance, 1.0))
                bearing = _bearing_of(to) + np.copysign(tangent, off)
        return bearing


def _towards(heading_rad: float) -> np.ndarray:
    return np.array([np.cos(heading_rad), np.sin(heading_rad)])


def _body_to_north_east(heading_rad: float) -> np.ndarray:
    c, s = np.cos(heading_rad), np.sin(heading_rad)
    return np.array([[c, -s], [s, c]])


def _bearing_of(offset: np.ndarray) -> float:
    return float(np.arctan2(offset[1], offset[0]))
