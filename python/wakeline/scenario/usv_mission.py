"""An unmanned surface vessel on a mission: waypoints, obstacles, current and sensors.

The simulator of "Sensor system information processing in unmanned navigation applications"
(P. S. Evsyukov, O. N. Andreeva, V. V. Khanychev): 800 m by 800 m, guided by bearings. The vessel is
steered by its true motion, or in closed loop by estimates (`UsvMission.sail`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
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
from wakeline.recording import write_imu

_LONGEST_STEPS = 5000
_CALIBRATION_READINGS = 144  # of the compass, in a turn of two circles
_PATH_STEP_M, _LONGEST_PATH = 0.5, 100_000
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
        NaN in an outage.
    compass : ndarray (R, T)
        In [-pi, pi].
    """

    imu: np.ndarray
    gnss: np.ndarray
    compass: np.ndarray

    def __repr__(self) -> str:
        runs, times = np.atleast_2d(self.compass).shape
        return brief(self, many(runs, "run"), many(times, "time"))


class UsvPassage(NamedTuple):
    """R runs in closed loop at T times; NaN, and the last leg, after the arrival of a run.

    Attributes
    ----------
    time_s : ndarray (T,)
    position_m : ndarray (R, T, 2)
        True, [north, east].
    heading_rad : ndarray (R, T)
        True.
    velocity_mps : ndarray (R, T, 2)
        True, over ground.
    mean : ndarray (R, T, 5)
        The estimates that steered: [north, east, v_north, v_east, heading].
    nees : ndarray (R, T)
        Their normalized squared errors, 5 on average if consistent; NaN without a covariance.
    cross_track_m : ndarray (R, T)
        Distance of the true position from the planned path, not negative.
    arrived : ndarray of bool (R,)
        Whether the estimates reached the last waypoint in time.
    touched : ndarray of bool (R,)
        Whether the vessel touched an obstacle.
    success : ndarray of bool (R,)
        Arrived within two acceptance radii of the last waypoint, without touching an obstacle.
    """

    time_s: np.ndarray
    position_m: np.ndarray
    heading_rad: np.ndarray
    velocity_mps: np.ndarray
    mean: np.ndarray
    nees: np.ndarray
    cross_track_m: np.ndarray
    arrived: np.ndarray
    touched: np.ndarray
    success: np.ndarray

    def __repr__(self) -> str:
        runs, times = self.heading_rad.shape
        return brief(self, many(runs, "run"), many(times, "time"))


Pilot = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class UsvMission:
    """From (0, 0) to (800, 800) m through waypoints, around obstacles.

    `WaypointFollower` steers: in each step the vessel turns towards its aim by

        clip(wrap(bearing - heading), -w T, w T),

    with w the largest rate of turn. The aim is the waypoint, or, where the straight line to it is
    too close to an obstacle, the tangent to the circle of clearance around that obstacle. A current
    carries the vessel along. A waypoint is reached once it is closer than `accept_m`.

    The paper gives the area, the sensors and the currents. The other defaults are ours.

    Attributes
    ----------
    current_mps, current_towards_rad : float
    current_turn_s : float
        Time in which the current turns through a circle, clockwise, as a rotary tidal stream does;
        infinite for a constant one.
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
    multipath_std_m, multipath_time_s : float
        Standard deviation per axis, and correlation time, of a further error of GNSS positions that
        is correlated in time (Gauss-Markov).
    outages_s : tuple of (begin, end)
        Times without GNSS.
    compass_std_rad : float
    compass_iron : CompassEllipse, optional
        Hard and soft iron near the compass; its noise is then that of each component of the field,
        over the earth's horizontal field.
    calibrated : bool
        Whether the iron is calibrated before the mission, in a turn of two circles; otherwise the
        compass takes the field that it measures for the earth's.

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
    current_turn_s: float = np.inf
    multipath_std_m: float = 0.0
    multipath_time_s: float = 60.0
    outages_s: tuple[tuple[float, float], ...] = ()
    compass_iron: wl.navigation.CompassEllipse | None = None
    calibrated: bool = False

    def __post_init__(self) -> None:
        names = ("clearance_m", "accept_m", "speed_mps", "turn_rate_rad_s", "period_s")
        positive(**number_fields(self, *names), multipath_time_s=self.multipath_time_s)
        not_negative(current_mps=self.current_mps, multipath_std_m=self.multipath_std_m)
        if not self.current_turn_s > 0:
            raise ValueError(f"current_turn_s must be positive, got {self.current_turn_s}")
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
        for begin_s, end_s in self.outages_s:
            if not 0 <= begin_s <= end_s:
                raise ValueError(
                    f"outages_s must be pairs of increasing times, got {self.outages_s}"
                )

    @property
    def current(self) -> np.ndarray:
        """[north, east] m/s at the start."""
        return self.current_at(0.0)

    def current_at(self, time_s: float) -> np.ndarray:
        """[north, east] m/s."""
        turned = 2 * np.pi * time_s / self.current_turn_s
        return self.current_mps * _towards(self.current_towards_rad + turned)

    @cached_property
    def follower(self) -> wl.navigation.WaypointFollower:
        """What steers the vessel."""
        guidance = wl.navigation.WaypointGuidance(
            speed_mps=self.speed_mps,
            turn_rate_rad_s=self.turn_rate_rad_s,
            accept_m=self.accept_m,
            clearance_m=self.clearance_m,
        )
        route = np.vstack([np.zeros((1, 2)), self.waypoints_m])
        return wl.navigation.WaypointFollower(route, guidance, np.array(self.obstacles))

    @cached_property
    def path_m(self) -> np.ndarray:
        """The planned path, of a vessel that turns on the spot in still water: its corners (K, 2).

        Raises
        ------
        ValueError
            When obstacles are around a waypoint.
        """
        follower, still = self.follower, np.zeros((1, 2))
        position, leg, turned = np.zeros((1, 2)), np.zeros(1, dtype=int), np.nan
        corners = []
        for _ in range(_LONGEST_PATH):
            steering = follower.steer(position, np.zeros(1), still, self.period_s, leg)
            leg = steering.leg
            if leg[0] == follower.legs:
                return np.vstack([*corners, position, self.waypoints_m[-1:]])
            if not np.isclose(steering.heading_rad[0], turned, rtol=0.0, atol=1e-9):
                corners.append(position)
            turned = steering.heading_rad[0]
            position = position + _PATH_STEP_M * _towards(turned)
        raise ValueError(f"obstacles must leave a path to waypoint {self.waypoints_m[leg[0]]}")

    @cached_property
    def voyage(self) -> UsvVoyage:
        """The true motion, steered by itself.

        Raises
        ------
        ValueError
            When a waypoint is not reached because the current is too strong.
        """
        vessel = _Vessels(self, 1)
        states, readings = [vessel.state], [np.full((1, 3), np.nan)]
        while True:
            current = self.current_at(vessel.time_s) if self.allow_for_current else np.zeros(2)
            turn_rate = vessel.steer(vessel.position, vessel.heading, current[None])
            if vessel.leg[0] == self.follower.legs:
                break
            readings.append(vessel.step(turn_rate))
            states.append(vessel.state)
            if len(states) > _LONGEST_STEPS:
                way = self.waypoints_m[vessel.leg[0]]
                raise ValueError(
                    f"waypoint {way} is not reached in {len(states)} steps; reduce current_mps"
                )
        rows = np.concatenate(states)
        return UsvVoyage(
            time_s=self.period_s * np.arange(len(rows)),
            position_m=rows[:, :2],
            velocity_mps=rows[:, 2:4],
            heading_rad=rows[:, 4],
            imu=np.concatenate(readings),
        )

    def draw(self, runs: int, seed: int | Sequence[int] = 0) -> UsvLogs:
        """Independent runs of the sensors along `voyage`; run r does not depend on their number.

        Raises
        ------
        ValueError
            When runs or a seed is negative or not an integer.
        """
        truth = self.voyage
        sensors = _Sensors(self, runs, len(truth.time_s), seed)
        heading = np.broadcast_to(truth.heading_rad, (runs, len(truth.time_s)))
        return UsvLogs(
            imu=truth.imu + sensors.imu_error,
            gnss=truth.position_m + sensors.gnss_error,
            compass=sensors.headings(heading, slice(None)),
        )

    def write_log(self, path: str | Path, seed: int | Sequence[int] = 0) -> None:
        """Write a run of `draw` as an IMU log, with a fix and a heading every second.

        The mission begins in the Gulf of Finland, at 60° N 29° E, at the time 0.

        Raises
        ------
        ValueError
            When `period_s` is not a whole part of a second.
        """
        every = round(1.0 / self.period_s)
        if not np.isclose(every * self.period_s, 1.0):
            raise ValueError(f"period_s must be a whole part of a second, got {self.period_s}")
        time_s = self.voyage.time_s[1:]  # there are no readings at the start
        imu, gnss, compass = (readings[0, 1:] for readings in self.draw(1, seed))
        seldom = np.where(np.arange(1, len(time_s) + 1) % every == 0, 0.0, np.nan)
        plane = wl.LocalPlane(latitude_rad=np.deg2rad(60.0), longitude_rad=np.deg2rad(29.0))
        latitude, longitude = map(np.degrees, plane.place(np.nan_to_num(gnss)))
        missing = seldom + 0.0 * gnss[:, 0]
        heading_deg = np.degrees(compass) % 360.0 + seldom
        write_imu(path, time_s, imu, latitude + missing, longitude + missing, heading_deg)

    def sail(
        self,
        pilot: Pilot | None,
        runs: int,
        seed: int | Sequence[int] = 0,
        *,
        longest: float = 2.0,
    ) -> UsvPassage:
        """Runs in closed loop: estimates, and not the truth, steer the vessel.

        Parameters
        ----------
        pilot : callable, optional
            ``pilot(imu, gnss, compass)`` takes the readings of a step of all runs, (R, 3), (R, 2)
            and (R,), NaN where missing, and returns the motion (R, 5) of [north, east, v_north,
            v_east, heading], its covariance (R, 5, 5) or None, and the current (R, 2) to allow for.
            By default the truth steers, and allows for the true current.
        runs, seed : int
            The sensors' errors are those of `draw` with the same seed.
        longest : float
            A run ends after this multiple of the time that the planned path takes in still water.

        Raises
        ------
        ValueError
            When runs or a seed is negative or not an integer.
        """
        length_m = np.hypot(*np.diff(self.path_m, axis=0).T).sum()
        steps = int(np.ceil(longest * length_m / (self.speed_mps * self.period_s)))
        sensors = _Sensors(self, runs, steps + 1, seed)
        vessel = _Vessels(self, runs)
        motion = vessel.state
        aim_current = np.broadcast_to(self.current, (runs, 2))
        if pilot is not None:
            aim_current = np.zeros((runs, 2))
        states, means, nees = [vessel.state], [motion], [np.full(runs, np.nan)]
        arrival = np.full(runs, steps + 1)
        for k in range(1, steps + 1):
            turn_rate = vessel.steer(motion[:, :2], motion[:, 4], aim_current)
            arrival = np.where((vessel.leg == self.follower.legs) & (arrival > k), k, arrival)
            if (arrival <= k).all():
                break
            imu = vessel.step(turn_rate)
            if pilot is None:
                current = self.current_at(vessel.time_s)
                motion, covariance = vessel.state, None
                aim_current = np.broadcast_to(current, (runs, 2))
            else:
                motion, covariance, aim_current = pilot(
                    imu + sensors.imu_error[:, k],
                    vessel.position + sensors.gnss_error[:, k],
                    sensors.headings(vessel.heading, k),
                )
            states.append(vessel.state)
            means.append(motion)
            nees.append(_nees(motion - vessel.state, covariance))
        series = (np.stack(rows, axis=1) for rows in (states, means, nees))
        return self._passage(*series, arrival)

    def _passage(
        self,
        states: np.ndarray,
        means: np.ndarray,
        nees: np.ndarray,
        arrival: np.ndarray,
    ) -> UsvPassage:
        """The passage of states (R, T, 5) that end before the rows `arrival` (R,)."""
        runs, times = states.shape[:2]
        arrived = arrival <= times
        last = np.minimum(arrival, times) - 1
        after = np.arange(times) > last[:, None]
        end_m = states[np.arange(runs), last, :2] - self.waypoints_m[-1]
        truth = np.where(after[..., None], np.nan, states)
        position = truth[..., :2]
        touched = np.zeros(runs, dtype=bool)
        for obstacle in self.obstacles:
            off = position - obstacle[:2]
            touched |= (np.hypot(off[..., 0], off[..., 1]) < obstacle.radius_m).any(axis=1)
        return UsvPassage(
            time_s=self.period_s * np.arange(times),
            position_m=position,
            heading_rad=truth[..., 4],
            velocity_mps=truth[..., 2:4],
            mean=np.where(after[..., None], np.nan, means),
            nees=np.where(after, np.nan, nees),
            cross_track_m=_distance_m(position, self.path_m),
            arrived=arrived,
            touched=touched,
            success=arrived & ~touched & (np.hypot(*end_m.T) < 2 * self.accept_m),
        )


USV_EXAMPLE = UsvMission(
    speed_mps=3.0,
    turn_rate_rad_s=float(np.deg2rad(15.0)),
    period_s=0.2,
    imu_std=(0.01, 0.01, float(np.deg2rad(0.08))),
    gnss_std_m=(2.5, 2.5),
    compass_std_rad=float(np.deg2rad(2.0)),
    outages_s=((150.0, 210.0),),
)
"""The mission of the bundled IMU log, at 3 m/s, with a minute without GNSS."""


class _Vessels:
    """The true motion of R vessels."""

    def __init__(self, mission: UsvMission, runs: int) -> None:
        self._mission = mission
        self.time_s = 0.0
        self.leg = np.zeros(runs, dtype=int)
        self.position = np.zeros((runs, 2))
        self.heading = np.full(runs, mission.start_heading_rad)
        self.velocity = self._over_ground()

    @property
    def state(self) -> np.ndarray:
        """[north, east, v_north, v_east, heading] (R, 5)."""
        return np.column_stack([self.position, self.velocity, self.heading])

    def steer(
        self, position_m: np.ndarray, heading_rad: np.ndarray, current_mps: np.ndarray
    ) -> np.ndarray:
        """Rates of turn (R,) by estimates of position, heading and current."""
        period_s = self._mission.period_s
        steering = self._mission.follower.steer(
            position_m, heading_rad, current_mps, period_s, self.leg
        )
        self.leg = steering.leg
        return steering.turn_rate_rad_s

    def step(self, turn_rate_rad_s: np.ndarray) -> np.ndarray:
        """Move by one step; returns what the IMU feels (R, 3)."""
        period_s, before, slow = self._mission.period_s, self.heading, self.velocity
        turn = period_s * turn_rate_rad_s
        self.time_s += period_s
        self.heading = wl.wrap_angle(before + turn)
        self.velocity = self._over_ground()
        self.position = self.position + period_s * (slow + self.velocity) / 2
        push, ahead = (self.velocity - slow) / period_s, _towards(before + turn / 2)
        forward = push[:, 0] * ahead[:, 0] + push[:, 1] * ahead[:, 1]
        starboard = push[:, 1] * ahead[:, 0] - push[:, 0] * ahead[:, 1]
        return np.column_stack([forward, starboard, turn_rate_rad_s])

    def _over_ground(self) -> np.ndarray:
        through_water = self._mission.speed_mps * _towards(self.heading)
        return through_water + self._mission.current_at(self.time_s)


class _Sensors:
    """Errors of the sensors of R runs at T times; NaN in the first row."""

    def __init__(
        self, mission: UsvMission, runs: int, times: int, seed: int | Sequence[int]
    ) -> None:
        whole_number("runs", runs, 0)
        self._mission, self._begin = mission, entropy(seed, "usv mission")
        noise = self._normal(runs, times, 6)
        noise[:, 0] = np.nan
        self.imu_error = mission.imu_bias + noise[..., :3] * mission.imu_std
        self.gnss_error = noise[..., 3:5] * mission.gnss_std_m
        self._compass_error = noise[..., 5] * mission.compass_std_rad
        if mission.multipath_std_m > 0:
            self.gnss_error += self._multipath(self._normal(runs, times, 2, 1))
        time_s = mission.period_s * np.arange(times)
        for begin_s, end_s in mission.outages_s:
            self.gnss_error[:, (time_s >= begin_s) & (time_s <= end_s)] = np.nan
        if mission.compass_iron is not None:
            self._field_error = mission.compass_std_rad * self._normal(runs, times, 2, 2)
            self._field_error[:, 0] = np.nan
            turn = mission.compass_std_rad * self._normal(runs, _CALIBRATION_READINGS, 2, 3)
            self._corrections = [self._calibrated(one) for one in turn]

    def headings(self, heading_rad: np.ndarray, row: int | slice) -> np.ndarray:
        """Headings by compass (R, ...) at true ones (R, ...), of some of the times."""
        iron = self._mission.compass_iron
        if iron is None:
            return wl.wrap_angle(heading_rad + self._compass_error[:, row])
        field = iron.field(heading_rad) + self._field_error[:, row]
        read = [c.heading_rad(f) for c, f in zip(self._corrections, field, strict=True)]
        return np.reshape(read, heading_rad.shape)

    def _normal(self, runs: int, times: int, columns: int, *of: int) -> np.ndarray:
        noise = np.empty((runs, times, columns))
        for run in range(runs):
            np.random.default_rng([*self._begin, run, *of]).standard_normal(out=noise[run])
        return noise

    def _multipath(self, noise: np.ndarray) -> np.ndarray:
        """Gauss-Markov errors (R, T, 2) from normal numbers."""
        kept = np.exp(-self._mission.period_s / self._mission.multipath_time_s)
        error = np.empty_like(noise)
        error[:, 0] = noise[:, 0]
        for k in range(1, noise.shape[1]):
            error[:, k] = kept * error[:, k - 1] + np.sqrt(1 - kept**2) * noise[:, k]
        return self._mission.multipath_std_m * error

    def _calibrated(self, error: np.ndarray) -> wl.navigation.CompassEllipse:
        """The correction by a turn of two circles with errors (n, 2) of the field."""
        if not self._mission.calibrated:
            return wl.navigation.CompassEllipse()
        turn = np.linspace(0.0, 4 * np.pi, len(error), endpoint=False)
        ellipse, _ = wl.navigation.calibrate_compass(self._mission.compass_iron.field(turn) + error)
        return ellipse


def _towards(heading_rad: float | np.ndarray) -> np.ndarray:
    return np.stack([np.cos(heading_rad), np.sin(heading_rad)], axis=-1)


def _nees(error: np.ndarray, covariance: np.ndarray | None) -> np.ndarray:
    """Normalized squared errors (R,) of motions (R, 5)."""
    if covariance is None:
        return np.full(len(error), np.nan)
    error[:, 4] = wl.wrap_angle(error[:, 4])
    return wl.metrics.nees(error, covariance)


def _distance_m(position_m: np.ndarray, path_m: np.ndarray) -> np.ndarray:
    """Distances (...) of points (..., 2) from a path of corners (K, 2)."""
    nearest = np.full(position_m.shape[:-1], np.inf)
    for begin, end in pairwise(path_m):
        way, off = end - begin, position_m - begin
        along = np.clip(off @ way / (way @ way), 0.0, 1.0)
        apart = off - along[..., None] * way
        nearest = np.minimum(nearest, np.hypot(apart[..., 0], apart[..., 1]))
    return nearest
