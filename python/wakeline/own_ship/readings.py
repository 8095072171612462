"""The readings of own ship's instruments on common times."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import wakeline as wl
from wakeline._brief import brief, many, span
from wakeline._checks import positive
from wakeline.recording import NavigationLog

from .imu import averaged, of_steps
from .instruments import FIX_STD_M, leeway_rad, over_ground_mps, speed_and_course, true_headings
from .magnetic import NO_OFFSET, MagneticOffset, wants_offset
from .times import at

_MADE_GOOD_S = 10.0


class Readings(NamedTuple):
    """Readings at all times (T,) with any reading, NaN where missing, on a plane.

    ``fix_m`` and ``velocity_mps`` (T, 2) north and east, ``heading_rad`` (T,), ``log_mps``
    (T,) through the water ahead, ``leeway_rad`` (T,) from the heading to the course through the
    water, 0 if unknown, ``bottom_mps`` (T, 2) north and east over ground by a bottom-tracking log,
    ``turn_rate_rad_s`` (T,) to starboard. Directions are relative to the plane's north; they exceed
    true directions by ``lean_rad`` (T,). ``offset_std_rad`` is the standard deviation of the error
    common to all headings, ``fix_std_m`` that of a fix, per axis. ``imu`` (T, 3) is [forward m/s²,
    starboard m/s², yaw rate rad/s], the mean of the step that ends at each time, in steps of at
    least 0.1 s; None without an IMU.
    """

    plane: wl.navigation.LocalPlane
    time_s: np.ndarray
    fix_m: np.ndarray
    velocity_mps: np.ndarray
    heading_rad: np.ndarray
    log_mps: np.ndarray
    leeway_rad: np.ndarray
    bottom_mps: np.ndarray
    turn_rate_rad_s: np.ndarray
    lean_rad: np.ndarray
    offset_std_rad: float
    fix_std_m: float = FIX_STD_M
    imu: np.ndarray | None = None

    def __repr__(self) -> str:
        return brief(self, many(len(self.time_s), "time"), span(self.time_s))

    @property
    def over_ground_mps(self) -> np.ndarray:
        """Velocities (T, 2) over ground by satellite, or else by the log."""
        return np.where(np.isfinite(self.velocity_mps), self.velocity_mps, self.bottom_mps)

    @property
    def way_rad(self) -> np.ndarray:
        """Courses (T,) through the water."""
        return self.heading_rad + self.leeway_rad

    @property
    def way_mps(self) -> np.ndarray:
        """Speeds (T,) along the course through the water."""
        return self.log_mps / np.cos(self.leeway_rad)

    @property
    def has_fix(self) -> np.ndarray:
        """Mask (T,) of the times with a fix."""
        return np.isfinite(self.fix_m[:, 0])

    @property
    def has_imu(self) -> bool:
        """Whether there are readings of an IMU."""
        return self.imu is not None and bool(np.isfinite(self.imu).any())

    @property
    def knows_water(self) -> bool:
        """Whether heading and speed through water are available."""
        return bool(np.isfinite(self.heading_rad).any() and np.isfinite(self.log_mps).any())


def readings_of(
    part: NavigationLog,
    offset: MagneticOffset = NO_OFFSET,
    plane: wl.navigation.LocalPlane | None = None,
    *,
    fix_std_m: float = FIX_STD_M,
) -> Readings:
    """The readings of a log, with `offset` added to headings of unknown variation.

    The plane is by default tangent to the earth at the first fix. `fix_std_m` is the standard
    deviation of a fix, per axis.

    Raises
    ------
    ValueError
        When there is no usable fix, the clock was set back, or `fix_std_m` is not positive.
    """
    positive(fix_std_m=fix_std_m)
    fixes = part.fixes_in_order("set of readings")
    ground, water = part.ground.sound(), part.water.sound()
    plane = plane or fixes.plane()
    bottom, turn = part.bottom.sound(), part.turn.sound()
    place = {"latitude_rad": fixes.latitude_rad, "longitude_rad": fixes.longitude_rad}
    leans_rad = wl.wrap_angle(plane.plane_course_rad(np.zeros(len(fixes)), **place))

    def lean_rad(times: np.ndarray) -> np.ndarray:
        """Difference between directions on the plane and true ones at the last fix."""
        return leans_rad[np.maximum(np.searchsorted(fixes.time_s, times, side="right") - 1, 0)]

    heading_s, true_heading_rad = true_headings(part, offset.offset_rad)
    headings = heading_s, true_heading_rad + lean_rad(heading_s)
    speed_mps, true_course_rad = speed_and_course(ground)
    course_rad = true_course_rad + lean_rad(ground.time_s)
    course = np.column_stack([np.cos(course_rad), np.sin(course_rad)])
    series = (
        (fixes.time_s, plane.position_m(**place)),
        (ground.time_s, speed_mps[:, None] * course),
        headings,
        (water.time_s, water.ahead_mps),
        (bottom.time_s, over_ground_mps(bottom, *headings)),
        (turn.time_s, turn.turn_rate_rad_s),
    )
    imu_s, imu = averaged(part.imu.sound())
    time_s = np.unique(np.concatenate([imu_s, *(times for times, _ in series)]))
    time_s = time_s[time_s >= fixes.time_s[0]]
    fix, velocity, heading, log, over_bottom, turn_rate = (at(time_s, *one) for one in series)
    leeway = leeway_rad(water, time_s)
    return Readings(
        plane,
        time_s,
        fix_m=fix,
        velocity_mps=velocity,
        heading_rad=heading,
        log_mps=log,
        leeway_rad=leeway,
        bottom_mps=over_bottom,
        turn_rate_rad_s=turn_rate,
        lean_rad=lean_rad(time_s),
        offset_std_rad=offset.std_rad if wants_offset(part) else 0.0,
        fix_std_m=fix_std_m,
        imu=of_steps(time_s, imu_s, imu),
    )


def made_good_mps(seen: Readings) -> np.ndarray:
    """Velocities (T, 2) at fixes relative to one at least ten seconds before; NaN elsewhere."""
    fixed = np.flatnonzero(seen.has_fix)
    time_s, fix_m = seen.time_s[fixed], seen.fix_m[fixed]
    before = np.searchsorted(time_s, time_s - _MADE_GOOD_S, side="right") - 1
    known = before >= 0
    velocity = np.full(seen.fix_m.shape, np.nan)
    since_s = time_s[known] - time_s[before[known]]
    velocity[fixed[known]] = (fix_m[known] - fix_m[before[known]]) / since_s[:, None]
    return velocity
