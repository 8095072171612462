"""Own ship's position and motion, estimated by a navigator from its readings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

import wakeline as wl
from wakeline._brief import brief, many, span

from .instruments import UNDER_WAY_MPS, VELOCITY_STD_MPS
from .magnetic import CURRENT_STD_MPS
from .readings import Readings, made_good_mps
from .times import NEAR_S, at, between, first

COMPASS_STD_RAD = np.deg2rad(4.0)  # of a small craft in waves
LOG_STD_MPS = 0.15
START_STD_M = 100.0  # at the first fix, which the filter then processes like any other
START_SPEED_STD_MPS, ANY_SPEED_STD_MPS = 1.0, 20.0  # with a velocity over ground, and without
START_HEADING_STD_RAD, ANY_HEADING_STD_RAD = np.deg2rad([10.0, 30.0])  # with a heading, and without
# Random walks over one second, whatever the steps:
VELOCITY_WALK_MPS, SPEED_WALK_MPS, CURRENT_WALK_MPS = 0.4, 0.1, 0.02
HEADING_WALK_RAD = np.deg2rad(10.0)  # without a rate of turn
TURNED_WALK_RAD = np.deg2rad(2.0)  # with a rate of turn, which lags
IMU_WALK_MPS, IMU_WALK_RAD = 0.02, np.deg2rad(0.05)  # of velocity and heading, with an IMU
LONGEST_STEP_S, MOST_STEPS = 2.0, 100  # between two readings, however far apart
GATE_PROBABILITY = 0.999

COASTING_S = 5.0
JUMP_M = 50.0
"""Distance of a position from the solution above which it is a jump, m."""
JUMPED_S = 60.0


@dataclass(frozen=True)
class OwnTrack:
    """Own ship's solution at times (T,).

    Positions, velocities and currents are north and east on the plane of the log, tangent to the
    earth at its first fix. Far from it the plane's north differs from true north, and distances
    across the line to the first fix are stretched by 4e-4 at 300 km and 4e-3 at 1000 km, and so are
    velocity and current.

    Attributes
    ----------
    time_s : ndarray (T,)
    latitude_deg, longitude_deg : ndarray (T,)
    position_m, velocity_mps : ndarray (T, 2)
        Over ground.
    heading_rad : ndarray (T,)
        From true north; NaN where the log has no heading.
    current_mps : ndarray (T, 2)
        NaN without heading or speed through water.
    lean_rad : ndarray (T,)
        Directions on the plane minus true directions.
    position_m2, velocity_m2s2 : ndarray (T, 2, 2)
        Covariances.
    heading_std_rad : ndarray (T,)
    imu_bias, imu_bias_std : ndarray (T, 3)
        Of an IMU, and their standard deviations: [forward m/s², starboard m/s², yaw rate rad/s];
        NaN without one.
    drift_std_mps : ndarray (T,)
        Largest standard deviation of the current over all directions.
    status : ndarray of str (T,)
        ``ok``; ``coasting`` without an accepted fix for more than five seconds; ``jumped`` after
        persistent fixes outside the gate moved the position by more than 50 m, until others move it
        back or all fixes have been accepted for a minute; ``rejected`` where a fix was rejected.
    jump_m : ndarray (T,)
        Distance by which such fixes moved the position, zero at other times.
    rejected : dict of str to ndarray of bool (T,)
        Rejected readings of ``gnss``, ``velocity``, ``compass`` and ``log``.
    """

    time_s: np.ndarray
    latitude_deg: np.ndarray
    longitude_deg: np.ndarray
    position_m: np.ndarray
    velocity_mps: np.ndarray
    heading_rad: np.ndarray
    current_mps: np.ndarray
    lean_rad: np.ndarray
    position_m2: np.ndarray
    velocity_m2s2: np.ndarray
    heading_std_rad: np.ndarray
    imu_bias: np.ndarray
    imu_bias_std: np.ndarray
    drift_std_mps: np.ndarray
    status: np.ndarray
    jump_m: np.ndarray
    rejected: Mapping[str, np.ndarray]

    def __repr__(self) -> str:
        return brief(self, many(len(self.time_s), "state"), span(self.time_s))

    @property
    def course_rad(self) -> np.ndarray:
        """Course over ground (T,) from true north."""
        return np.arctan2(self.velocity_mps[:, 1], self.velocity_mps[:, 0]) - self.lean_rad

    @property
    def set_rad(self) -> np.ndarray:
        """Direction (T,) to which the current sets, from true north."""
        return np.arctan2(self.current_mps[:, 1], self.current_mps[:, 0]) - self.lean_rad


def navigate(readings: Readings, *, smooth: bool = False) -> OwnTrack:
    """The solution at every reading since the first fix.

    With an IMU it has eight states, with its biases, and an unscented filter; otherwise an extended
    one of seven states with the current, or of five.

    A smoothed solution also uses later readings, up to one that was rejected until readings of its
    kind persisted. The rejected readings are the filter's.
    """
    states = 8 if readings.has_imu else 7 if readings.knows_water else 5
    done = _run(states, readings)
    moved_m = _moved_m(readings, done, _velocity(done.mean, states)[0])
    if smooth:
        done = _run(states, readings, smooth=True)
    mean, covariance = done.mean, done.covariance
    row = 2 if states == 7 else 4
    heading = wl.wrap_angle(mean[:, row] - readings.leeway_rad - readings.lean_rad)
    velocity, slope = _velocity(mean, states)
    latitude, longitude = readings.plane.place(mean[:, :2])
    heading_std = np.sqrt(covariance[:, row, row] + readings.offset_std_rad**2)
    known = readings.has_imu or np.isfinite(readings.heading_rad).any()
    unknown = np.full(len(mean), np.nan)
    bias, bias_std = np.full((2, len(mean), 3), np.nan)
    if states == 8:
        bias, bias_std = mean[:, 5:], np.sqrt(np.diagonal(covariance, axis1=1, axis2=2)[:, 5:])
    return OwnTrack(
        time_s=readings.time_s,
        latitude_deg=np.degrees(latitude),
        longitude_deg=np.degrees(longitude),
        position_m=mean[:, :2],
        velocity_mps=velocity,
        heading_rad=heading if known else unknown,
        current_mps=mean[:, 5:7] if states == 7 else np.full((len(mean), 2), np.nan),
        lean_rad=readings.lean_rad,
        position_m2=covariance[:, :2, :2],
        velocity_m2s2=slope @ covariance @ np.swapaxes(slope, 1, 2),
        heading_std_rad=heading_std if known else unknown,
        imu_bias=bias,
        imu_bias_std=bias_std,
        drift_std_mps=_drift_std_mps(done, readings.offset_std_rad) if states == 7 else unknown,
        status=_status(readings, done.rejected["gnss"], moved_m),
        jump_m=np.hypot(*moved_m.T),
        rejected=done.rejected,
    )


class _Solved(NamedTuple):
    """The arrays of `UsvRun` at the times of the readings."""

    mean: np.ndarray
    covariance: np.ndarray
    nis: Mapping[str, np.ndarray]
    rejected: Mapping[str, np.ndarray]


def _run(states: int, readings: Readings, *, smooth: bool = False) -> _Solved:
    rows, time_s = _in_short_steps(readings.time_s)

    def spread(values: np.ndarray) -> np.ndarray:
        return at(time_s, readings.time_s, values)

    within = np.searchsorted(rows, np.arange(len(time_s)))  # the step that each one divides
    imu = readings.imu[within] if states == 8 else _turning(readings, time_s)
    done = _navigator(states, readings).run(
        time_s,
        imu=imu,
        gnss=spread(readings.fix_m),
        compass=spread(readings.way_rad),
        velocity=spread(readings.over_ground_mps),
        log=spread(readings.way_mps) if states == 7 else None,
        imu_std=_motion_std(time_s, np.isfinite(imu[:, 2]), states),
        gnss_std_m=[readings.fix_std_m, readings.fix_std_m],
        compass_std_rad=COMPASS_STD_RAD,
        velocity_std_mps=VELOCITY_STD_MPS,
        log_std_mps=LOG_STD_MPS,
        smooth=smooth,
    )
    nis, rejected = (
        {name: values[rows] for name, values in by_sensor.items()}
        for by_sensor in (done.nis, done.rejected)
    )
    return _Solved(done.mean[rows], done.covariance[rows], nis, rejected)


def _in_short_steps(time_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Times, with intermediate ones where they are far apart, and the rows of the given ones.

    The noise of a random walk is constant over a step; over a long step it would correlate position
    and velocity.
    """
    steps = np.ceil(np.minimum(np.diff(time_s) / LONGEST_STEP_S, MOST_STEPS)).astype(int)
    rows = np.append(0, np.cumsum(steps))
    return rows, np.interp(np.arange(rows[-1] + 1), rows, time_s)


def _navigator(states: int, readings: Readings) -> wl.UsvNavigator:
    """Start from the first seconds of readings; without a heading, with the course made good."""
    navigator = wl.UsvNavigator(
        states,
        "ukf" if states == 8 else "ekf",
        speed_walk_mps=SPEED_WALK_MPS,
        current_walk_mps=CURRENT_WALK_MPS,
        current_std_mps=CURRENT_STD_MPS,
        gate_probability=GATE_PROBABILITY,
    )
    soon = readings.time_s - readings.time_s[0] <= NEAR_S
    velocity = first(readings.over_ground_mps[soon], np.full(2, np.nan))
    knows_velocity = np.isfinite(velocity).all()
    made_good = velocity if knows_velocity else first(made_good_mps(readings), velocity)
    under_way = np.hypot(*made_good) > UNDER_WAY_MPS
    course = np.arctan2(made_good[1], made_good[0]) if under_way else first(readings.way_rad, 0.0)
    heading = first(readings.way_rad[soon], course)
    knows_heading = states != 8 or np.isfinite(readings.way_rad).any()
    navigator.start(
        first(readings.fix_m, np.zeros(2)),
        velocity if knows_velocity else np.zeros(2),
        float(heading),
        position_std_m=[START_STD_M, START_STD_M],
        velocity_std_mps=START_SPEED_STD_MPS if knows_velocity else ANY_SPEED_STD_MPS,
        heading_std_rad=START_HEADING_STD_RAD if knows_heading else ANY_HEADING_STD_RAD,
    )
    return navigator


def _turning(readings: Readings, time_s: np.ndarray) -> np.ndarray:
    """IMU readings (T, 3) equivalent to rates of turn; NaN for steps without one."""
    given = np.isfinite(readings.turn_rate_rad_s)
    middle_s = time_s - np.diff(time_s, prepend=time_s[:1]) / 2.0
    rate = between(middle_s, readings.time_s[given], readings.turn_rate_rad_s[given])
    return np.column_stack([np.zeros((len(rate), 2)), rate])


def _motion_std(time_s: np.ndarray, given: np.ndarray, states: int) -> np.ndarray:
    """Standard deviations (T, 2) of acceleration and turn rate per step that give the walks.

    `given` (T,) is whether the step has a rate of turn, with 8 states also accelerations.
    """
    measured = [IMU_WALK_MPS, IMU_WALK_RAD] if states == 8 else [VELOCITY_WALK_MPS, TURNED_WALK_RAD]
    walk = np.where(given[:, None], measured, [VELOCITY_WALK_MPS, HEADING_WALK_RAD])
    return walk / np.sqrt(np.diff(time_s, prepend=-np.inf))[:, None]


def _velocity(mean: np.ndarray, states: int) -> tuple[np.ndarray, np.ndarray]:
    """Velocity over ground (T, 2) and its slope in the state (T, 2, N)."""
    slope = np.zeros((len(mean), 2, states))
    if states != 7:
        slope[:, [0, 1], [2, 3]] = 1.0
        return mean[:, 2:4], slope
    ahead = np.column_stack([np.cos(mean[:, 2]), np.sin(mean[:, 2])])
    slope[:, 0, 2], slope[:, 1, 2] = -mean[:, 3] * ahead[:, 1], mean[:, 3] * ahead[:, 0]
    slope[:, :, 3] = ahead
    slope[:, [0, 1], [5, 6]] = 1.0
    return mean[:, 3:4] * ahead + mean[:, 5:7], slope


def _drift_std_mps(done: _Solved, offset_std_rad: float) -> np.ndarray:
    """Largest standard deviations (T,) of the current of seven states over all directions.

    An error common to all headings turns speed through the water into current.
    """
    way_rad, way_mps = done.mean[:, 2], done.mean[:, 3]
    across = np.column_stack([-np.sin(way_rad), np.cos(way_rad)])
    by_offset_mps = (offset_std_rad * way_mps)[:, None] * across
    by_offset_m2s2 = by_offset_mps[:, :, None] * by_offset_mps[:, None, :]
    return np.sqrt(np.linalg.eigvalsh(done.covariance[:, 5:7, 5:7] + by_offset_m2s2)[:, -1])


def _moved_m(readings: Readings, done: _Solved, velocity_mps: np.ndarray) -> np.ndarray:
    """Displacement (T, 2) of the position by accepted fixes outside the gate."""
    outside = done.nis["gnss"] > -2.0 * np.log(1.0 - GATE_PROBABILITY)
    believed = np.flatnonzero(outside & ~done.rejected["gnss"])
    step_s = readings.time_s[believed] - readings.time_s[believed - 1]
    predicted_m = done.mean[believed - 1, :2] + velocity_mps[believed - 1] * step_s[:, None]
    moved_m = np.zeros((len(readings.time_s), 2))
    moved_m[believed] = readings.fix_m[believed] - predicted_m
    return moved_m


def _status(readings: Readings, rejected: np.ndarray, moved_m: np.ndarray) -> np.ndarray:
    believed = readings.has_fix & ~rejected
    last_s = np.maximum.accumulate(np.where(believed, readings.time_s, -np.inf))
    status = np.where(readings.time_s - last_s > COASTING_S, "coasting", "ok")
    status = np.where(_jumped(readings, rejected, moved_m), "jumped", status)
    return np.where(rejected, "rejected", status)


def _jumped(readings: Readings, rejected: np.ndarray, moved_m: np.ndarray) -> np.ndarray:
    """Mask (T,) of the times at which the position is in doubt after a jump."""
    jumped = np.zeros(len(moved_m), dtype=bool)
    moved = moved_m.any(axis=1)
    ends = np.append(_fitted(readings, rejected | moved), len(moved))
    away_m = np.zeros(2)
    for k in np.flatnonzero(moved):
        away_m = moved_m[k] + (away_m if jumped[k] else 0.0)
        jumped[k : ends[np.searchsorted(ends, k)]] = np.hypot(*away_m) > JUMP_M
    return jumped


def _fitted(readings: Readings, misfit: np.ndarray) -> np.ndarray:
    """Indices (n,) of the fixes after a minute of accepted fixes without a gap of a minute."""
    fixed = np.flatnonzero(readings.has_fix)
    time_s = readings.time_s[fixed]
    again = misfit[fixed] | (np.diff(time_s, prepend=-np.inf) > JUMPED_S)
    since_s = np.maximum.accumulate(np.where(again, time_s, -np.inf))
    return fixed[time_s - since_s >= JUMPED_S]
