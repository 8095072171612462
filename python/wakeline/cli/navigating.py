"""Own ship's log through the navigator: where the ship was, and how well it is known.

Without an IMU the ship coasts from reading to reading, turning as her rate of turn indicator says.
With heading and speed through water the state has seven components, current among them; without
either it has five. Where the log tells of the speed across the hull, too, her way through the water
is not where she heads, and it is the way that the state's heading and speed are of.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

import wakeline as wl
from wakeline._progress import progress
from wakeline.recording import NavigationLog
from wakeline.recording.nmea import BottomTrack, Fixes, GroundSpeed, WaterSpeed

FIX_STD_M = 3.0
VELOCITY_STD_MPS = 0.3  # over ground: filtered by the receiver, or turned by the heading
COMPASS_STD_RAD = np.deg2rad(4.0)  # of a small craft in waves
LOG_STD_MPS = 0.15
START_STD_M = 100.0  # at the first fix, which is yet to be taken as any other
START_SPEED_STD_MPS, ANY_SPEED_STD_MPS = 1.0, 20.0  # with a velocity over ground, and without
# What is gained in one second, whatever the steps:
VELOCITY_WALK_MPS, SPEED_WALK_MPS, CURRENT_WALK_MPS = 0.4, 0.1, 0.02
HEADING_WALK_RAD = np.deg2rad(10.0)  # where no rate of turn is told
TURNED_WALK_RAD = np.deg2rad(2.0)  # beside what an indicator tells, which lags
CURRENT_STD_MPS = 0.5
GATE_PROBABILITY = 0.999

COASTING_S = 5.0
JUMP_M, JUMPED_S = 50.0, 60.0
HIDDEN_S, HIDDEN_EVERY_S = 60.0, 150.0
HORIZONS_S = (10.0, 30.0, 60.0)
_UNDER_WAY_MPS = 1.5
_SAME_CURRENT_S = 1800.0
_MINUTE_STD_MPS = 0.2  # of the mean velocity of a minute: gusts, leeway, deviation
_SETTLED_S = 120.0
_NEAR_S = 3.0
_MADE_GOOD_S = 10.0


class MagneticOffset(NamedTuple):
    """What is added to magnetic headings, and its standard deviation, which lasts."""

    offset_rad: float
    std_rad: float


NO_OFFSET = MagneticOffset(0.0, 0.0)
ANY_OFFSET = MagneticOffset(0.0, np.deg2rad(15.0))  # variations over the seas


class Readings(NamedTuple):
    """Readings at all times (T,) at which there is one, NaN where there is none; a plane for them.

    ``fix_m`` and ``velocity_mps`` (T, 2) north and east, ``heading_rad`` (T,), ``log_mps``
    (T,) through the water ahead, ``leeway_rad`` (T,) from the heading to the way through the water,
    0 where no log tells of it, ``bottom_mps`` (T, 2) north and east over ground by a log that
    sees the bottom, ``turn_rate_rad_s`` (T,) to starboard. Directions are those on the plane, which
    are ``lean_rad`` (T,) more than from true north. ``offset_std_rad`` is the error that all
    headings share.
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

    @property
    def over_ground_mps(self) -> np.ndarray:
        """Velocities (T, 2) by satellite, or else by the log."""
        return np.where(np.isfinite(self.velocity_mps), self.velocity_mps, self.bottom_mps)

    @property
    def way_rad(self) -> np.ndarray:
        """Directions (T,) of the way through the water."""
        return self.heading_rad + self.leeway_rad

    @property
    def way_mps(self) -> np.ndarray:
        """Speeds (T,) along it."""
        return self.log_mps / np.cos(self.leeway_rad)

    @property
    def has_fix(self) -> np.ndarray:
        """Mask (T,) of the times with a fix."""
        return np.isfinite(self.fix_m[:, 0])

    @property
    def knows_water(self) -> bool:
        """Whether there are heading and speed through water."""
        return bool(np.isfinite(self.heading_rad).any() and np.isfinite(self.log_mps).any())


@dataclass(frozen=True)
class OwnTrack:
    """Own ship's solution at times (T,).

    Positions, velocities and currents are north and east on the plane of the log, which touches the
    Earth at its first fix. Elsewhere its north leans against true north, and across the line to the
    first fix it is stretched, by 4e-4 at 300 km and 4e-3 at 1000 km: by as much of the speed
    velocity and current err there.

    Attributes
    ----------
    time_s : ndarray (T,)
    latitude_deg, longitude_deg : ndarray (T,)
    position_m, velocity_mps : ndarray (T, 2)
        Over ground.
    heading_rad : ndarray (T,)
        From true north; NaN where the log has no heading.
    current_mps : ndarray (T, 2)
        NaN where there is no heading or no speed through water.
    lean_rad : ndarray (T,)
        By how much directions on the plane are more than from true north.
    position_m2, velocity_m2s2 : ndarray (T, 2, 2)
        Covariances.
    heading_std_rad : ndarray (T,)
    drift_std_mps : ndarray (T,)
        Of the current in the direction in which it is known least.
    status : ndarray of str (T,)
        ``ok``; ``coasting`` without a fix that was believed for more than five seconds; ``jumped``
        from where fixes that went on though rejected have moved the position by more than 50 m,
        until others move it back or all fixes have fitted for a minute; ``rejected`` where a fix
        was not believed.
    jump_m : ndarray (T,)
        How far such fixes have moved the position, zero at other times.
    rejected : dict of str to ndarray of bool (T,)
        Where a reading was not believed, of ``gnss``, ``velocity``, ``compass`` and ``log``.
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
    drift_std_mps: np.ndarray
    status: np.ndarray
    jump_m: np.ndarray
    rejected: Mapping[str, np.ndarray]

    @property
    def course_rad(self) -> np.ndarray:
        """Course over ground (T,) from true north."""
        return np.arctan2(self.velocity_mps[:, 1], self.velocity_mps[:, 0]) - self.lean_rad

    @property
    def set_rad(self) -> np.ndarray:
        """Where the current goes (T,), from true north."""
        return np.arctan2(self.current_mps[:, 1], self.current_mps[:, 0]) - self.lean_rad


def plane_of(fixes: Fixes) -> wl.navigation.LocalPlane:
    """The plane that touches the Earth at the first fix."""
    latitude_rad, longitude_rad = np.radians([fixes.latitude_deg[0], fixes.longitude_deg[0]])
    return wl.navigation.LocalPlane(latitude_rad=latitude_rad, longitude_rad=longitude_rad)


def readings_of(
    part: NavigationLog, offset: MagneticOffset, plane: wl.navigation.LocalPlane
) -> Readings:
    """The readings of a log that has a fix, `offset` added to headings of unknown variation."""
    fixes, ground, water = part.fixes.sound(), part.ground.sound(), part.water.sound()
    bottom, turn = part.bottom.sound(), part.turn.sound()
    latitude, longitude = np.radians(fixes.latitude_deg), np.radians(fixes.longitude_deg)
    leans_rad = wl.wrap_angle(plane.plane_course_rad(np.zeros(len(fixes)), latitude, longitude))

    def lean_rad(times: np.ndarray) -> np.ndarray:
        """By how much directions on the plane are more than true ones where the last fix is."""
        return leans_rad[np.maximum(np.searchsorted(fixes.time_s, times, side="right") - 1, 0)]

    heading_s, true_heading_rad = _headings(part, offset.offset_rad)
    headings = heading_s, true_heading_rad + lean_rad(heading_s)
    speed_mps, true_course_rad = _speed_course(ground)
    course_rad = true_course_rad + lean_rad(ground.time_s)
    course = np.column_stack([np.cos(course_rad), np.sin(course_rad)])
    series = (
        (fixes.time_s, plane.position_m(latitude, longitude)),
        (ground.time_s, speed_mps[:, None] * course),
        headings,
        (water.time_s, water.ahead_mps),
        (bottom.time_s, _over_ground(bottom, *headings)),
        (turn.time_s, turn.turn_rate_rad_s),
    )
    time_s = np.unique(np.concatenate([times for times, _ in series]))
    time_s = time_s[time_s >= fixes.time_s[0]]
    fix, velocity, heading, log, over_bottom, turn_rate = (_at(time_s, *one) for one in series)
    leeway = _leeway_rad(water, time_s)
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
    )


def unused(part: NavigationLog) -> dict[str, np.ndarray]:
    """Lines of the sound readings of a part that its solution does not use, by what they are."""
    fixed_s = part.fixes.sound().time_s
    first_s = fixed_s[0] if len(fixed_s) else np.inf
    early = [s.line[s.usable & (s.time_s < first_s)] for s in part.series.values()]
    ground, water, bottom, turn = (
        s.rows(s.usable & (s.time_s >= first_s))
        for s in (part.ground, part.water, part.bottom, part.turn)
    )
    known = np.isfinite(_speed_course(ground)).all(axis=0)
    headings = _headings(part, 0.0)
    over_ground = np.isfinite(_over_ground(bottom, *headings)).all(axis=1)
    nothing = np.zeros(0, dtype=np.int64)
    blind = len(headings[0]) == 0
    return {
        "readings with no fix before them": np.concatenate(early),
        "speeds over ground without a course, or courses without a speed": ground.line[~known],
        "speeds through the water without a heading": water.line if blind else nothing,
        "speeds through the water across the hull alone": water.line[np.isnan(water.ahead_mps)],
        "speeds over ground by log that lack a heading or a side": bottom.line[~over_ground],
        "rates of turn without a heading": turn.line if blind else nothing,
    }


def rejected_lines(part: NavigationLog, track: OwnTrack) -> dict[str, np.ndarray]:
    """Lines of the sound readings of a part that were not believed, by what they are."""
    headings = part.heading.sound() or part.compass.sound()
    ground, bottom = part.ground.sound(), part.bottom.sound()
    by_satellite = np.isin(track.time_s, ground.time_s)
    velocity = track.rejected.get("velocity", np.zeros(len(track.time_s), dtype=bool))
    masks = {
        "fixes": (part.fixes.sound(), track.rejected["gnss"]),
        "speeds over ground by satellite": (ground, velocity & by_satellite),
        "speeds over ground by log": (bottom, velocity & ~by_satellite),
        "headings": (headings, track.rejected["compass"]),
        "speeds through the water": (part.water.sound(), track.rejected.get("log")),
    }
    return {
        what: series.line[np.isin(series.time_s, track.time_s[mask])]
        for what, (series, mask) in masks.items()
        if mask is not None
    }


def zero_speeds(part: NavigationLog) -> np.ndarray:
    """Lines (n,) of sound speeds through the water of 0 while the ship makes way over ground."""
    water, ground = part.water.sound(), part.ground.sound()
    over_ground_mps = _between(water.time_s, ground.time_s, ground.speed_mps)
    return water.line[(water.ahead_mps == 0.0) & (over_ground_mps > _UNDER_WAY_MPS)]


def wants_offset(part: NavigationLog) -> bool:
    """Whether the headings of a part are magnetic ones whose variation is not always known."""
    unknown = np.isnan(part.compass.sound().variation_rad)
    return len(part.heading.sound()) == 0 and bool(unknown.any())


def magnetic_offset(parts: Sequence[NavigationLog]) -> MagneticOffset | None:
    """What to add to magnetic headings that have no variation, found from velocities over ground.

    Least squares over minutes of ground = a · water + current, complex numbers of north and east,
    water by the magnetic compass; the angle of a is the offset. The current is another in every
    half hour: alterations of course tell it from the offset. Without a log, speeds over ground
    stand for those through the water, and nothing does. None where there is nothing to find it
    from, or the log reads nothing but 0.
    """
    time_s, water, ground = _by_minute(parts)
    if len(time_s) == 0:
        return None
    knows_water = any(len(part.water.sound()) for part in parts)
    information, correlation = 0.0, 0j
    half_hour = (time_s - time_s[0]) // _SAME_CURRENT_S
    for same in [half_hour == number for number in np.unique(half_hour)]:
        w, g = water[same], ground[same]
        share = 1.0 / (len(w) + (_MINUTE_STD_MPS / CURRENT_STD_MPS) ** 2) if knows_water else 0.0
        information += np.vdot(w, w).real - share * abs(w.sum()) ** 2
        correlation += np.vdot(w, g) - share * w.sum().conj() * g.sum()
    if correlation == 0:
        return None
    std = _MINUTE_STD_MPS if knows_water else CURRENT_STD_MPS * np.sqrt(len(time_s))
    return MagneticOffset(
        float(np.angle(correlation)), float(std * np.sqrt(information) / abs(correlation))
    )


def navigate(readings: Readings, *, smooth: bool = False) -> OwnTrack:
    """The solution at every reading from the first fix on.

    Smoothed, it knows the readings after each time, too, up to one that was not believed until its
    like went on. What was not believed is the same.
    """
    states = 7 if readings.knows_water else 5
    done = _run(states, readings)
    moved_m = _moved_m(readings, done, _velocity(done.mean, states)[0])
    if smooth:
        done = _run(states, readings, smooth=True)
    mean, covariance = done.mean, done.covariance
    at = 2 if states == 7 else 4
    heading = wl.wrap_angle(mean[:, at] - readings.leeway_rad - readings.lean_rad)
    velocity, slope = _velocity(mean, states)
    latitude, longitude = readings.plane.place(mean[:, :2])
    heading_std = np.sqrt(covariance[:, at, at] + readings.offset_std_rad**2)
    known = np.isfinite(readings.heading_rad).any()
    unknown = np.full(len(mean), np.nan)
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
        drift_std_mps=_drift_std_mps(done, readings.offset_std_rad) if states == 7 else unknown,
        status=_status(readings, done.rejected["gnss"], moved_m),
        jump_m=np.hypot(*moved_m.T),
        rejected=done.rejected,
    )


def hold_out(readings: Readings) -> dict[str, dict[float, np.ndarray]]:
    """Errors (n,) in metres after seconds without satellites, by method and horizon.

    Fixes and speeds by satellite are hidden for a minute at a time, and what is foretold is
    compared with the hidden fixes: by the navigator, by the last velocity by satellite or, where
    there is none, of the last fixes, and by heading and speed through water alone.
    """
    starts_s = _hidden_from_s(readings)
    hidden = _is_hidden(readings.time_s, starts_s)
    seen = readings._replace(
        fix_m=np.where(hidden[:, None], np.nan, readings.fix_m),
        velocity_mps=np.where(hidden[:, None], np.nan, readings.velocity_mps),
    )
    foretold = {"navigator": navigate(seen).position_m, "constant_velocity": _straight_on(seen)}
    if readings.knows_water:
        foretold["dead_reckoning"] = _reckoned(seen)
    return {name: _errors(readings, place_m, starts_s) for name, place_m in foretold.items()}


def without_hidden(part: NavigationLog, readings: Readings) -> NavigationLog:
    """A part of a log without the speeds over ground that `hold_out` of its readings hides."""
    hidden = _is_hidden(part.ground.time_s, _hidden_from_s(readings))
    return dataclasses.replace(part, ground=part.ground.rows(~hidden))


def _hidden_from_s(readings: Readings) -> np.ndarray:
    """Times (n,) from which on satellites are hidden."""
    first_s, last_s = readings.time_s[[0, -1]]
    return np.arange(first_s + _SETTLED_S, last_s - HIDDEN_S - HIDDEN_EVERY_S / 2, HIDDEN_EVERY_S)


def _is_hidden(time_s: np.ndarray, starts_s: np.ndarray) -> np.ndarray:
    """Mask (T,) of times after a start, up to its end; starts are sorted and farther apart."""
    last = np.searchsorted(starts_s, time_s) - 1
    return (last >= 0) & (time_s - np.append(starts_s, 0.0)[last] <= HIDDEN_S)


def _run(states: int, readings: Readings, *, smooth: bool = False) -> wl.navigation.UsvRun:
    turning = _turning(readings)
    return _navigator(states, readings).run(
        readings.time_s,
        imu=turning,
        gnss=readings.fix_m,
        compass=readings.way_rad,
        velocity=readings.over_ground_mps,
        log=readings.way_mps if states == 7 else None,
        imu_std=_motion_std(readings.time_s, np.isfinite(turning[:, 2])),
        gnss_std_m=[FIX_STD_M, FIX_STD_M],
        compass_std_rad=COMPASS_STD_RAD,
        velocity_std_mps=VELOCITY_STD_MPS,
        log_std_mps=LOG_STD_MPS,
        smooth=smooth,
    )


def _navigator(states: int, readings: Readings) -> wl.UsvNavigator:
    """Begun by what is read within seconds; failing a heading, by the course made good."""
    navigator = wl.UsvNavigator(
        states,
        speed_walk_mps=SPEED_WALK_MPS,
        current_walk_mps=CURRENT_WALK_MPS,
        current_std_mps=CURRENT_STD_MPS,
        gate_probability=GATE_PROBABILITY,
    )
    soon = readings.time_s - readings.time_s[0] <= _NEAR_S
    velocity = _first(readings.over_ground_mps[soon], np.full(2, np.nan))
    knows_velocity = np.isfinite(velocity).all()
    made_good = velocity if knows_velocity else _first(_made_good_mps(readings), velocity)
    under_way = np.hypot(*made_good) > _UNDER_WAY_MPS
    course = np.arctan2(made_good[1], made_good[0]) if under_way else _first(readings.way_rad, 0.0)
    heading = _first(readings.way_rad[soon], course)
    navigator.start(
        _first(readings.fix_m, np.zeros(2)),
        velocity if knows_velocity else np.zeros(2),
        float(heading),
        position_std_m=[START_STD_M, START_STD_M],
        velocity_std_mps=START_SPEED_STD_MPS if knows_velocity else ANY_SPEED_STD_MPS,
        heading_std_rad=np.deg2rad(10.0),
    )
    return navigator


def _by_minute(parts: Sequence[NavigationLog]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Minutes (n,) under way and their mean velocities by magnetic compass and over ground."""
    rows = [_velocities(part) for part in parts]
    time_s, water, ground = (np.concatenate(column) for column in zip(*rows, strict=True))
    known = np.isfinite(water) & np.isfinite(ground)
    minute, of_row, count = np.unique(
        time_s[known] // 60.0, return_inverse=True, return_counts=True
    )
    means = [
        (np.bincount(of_row, v.real) + 1j * np.bincount(of_row, v.imag)) / count
        for v in (water[known], ground[known])
    ]
    return 60.0 * minute, *means


def _velocities(part: NavigationLog) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (n,) of speeds over ground, the velocities by magnetic compass and those over ground.

    Those by compass are through the water, or, without a log, of the speed over ground.
    """
    ground, compass, water = part.ground.sound(), part.compass.sound(), part.water.sound()
    ground = ground.rows(ground.speed_mps > _UNDER_WAY_MPS)
    heading = _between(ground.time_s, compass.time_s, np.unwrap(compass.heading_magnetic_rad))
    speed_mps = ground.speed_mps
    if len(water):
        sideways = np.tan(_leeway_rad(water, ground.time_s))
        speed_mps = _between(ground.time_s, water.time_s, water.ahead_mps) * (1.0 + 1j * sideways)
    over_ground = ground.speed_mps * np.exp(1j * ground.course_rad)
    return ground.time_s, speed_mps * np.exp(1j * heading), over_ground


def _speed_course(ground: GroundSpeed) -> tuple[np.ndarray, np.ndarray]:
    """Speeds and courses (n,) over ground; a speed within its error that has no course is rest."""
    rest = np.isnan(ground.course_rad) & (ground.speed_mps <= VELOCITY_STD_MPS)
    return np.where(rest, 0.0, ground.speed_mps), np.where(rest, 0.0, ground.course_rad)


def _headings(part: NavigationLog, offset_rad: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and true headings: those that are told as true, else of the compass.

    `offset_rad` is added to magnetic ones where the variation is not known.
    """
    true = part.heading.sound()
    if len(true):
        return true.time_s, true.heading_rad
    compass = part.compass.sound()
    variation = np.where(np.isnan(compass.variation_rad), offset_rad, compass.variation_rad)
    return compass.time_s, wl.wrap_angle(compass.heading_magnetic_rad + variation)


def _leeway_rad(water: WaterSpeed, time_s: np.ndarray) -> np.ndarray:
    """Angles (T,) from the heading to the way through the water, 0 where no log tells of them.

    They fade with the speed ahead, for a ship at rest has no way.
    """
    known = water.rows(np.isfinite(water.ahead_mps) & np.isfinite(water.starboard_mps))
    ahead, starboard = known.ahead_mps, known.starboard_mps
    leeway = np.arctan(ahead * starboard / np.maximum(ahead**2, _UNDER_WAY_MPS**2))
    return np.nan_to_num(_between(time_s, known.time_s, leeway))


def _over_ground(bottom: BottomTrack, times: np.ndarray, heading_rad: np.ndarray) -> np.ndarray:
    """Velocities (n, 2) north and east of a log; NaN without a heading at about the time."""
    heading = _between(bottom.time_s, times, np.unwrap(heading_rad))
    c, s = np.cos(heading), np.sin(heading)
    ahead, starboard = bottom.ahead_mps, bottom.starboard_mps
    return np.column_stack([c * ahead - s * starboard, s * ahead + c * starboard])


def _turning(readings: Readings) -> np.ndarray:
    """What an IMU would say (T, 3) of rates of turn alone; NaN for steps without any."""
    told = np.isfinite(readings.turn_rate_rad_s)
    middle_s = readings.time_s - np.diff(readings.time_s, prepend=readings.time_s[:1]) / 2.0
    rate = _between(middle_s, readings.time_s[told], readings.turn_rate_rad_s[told])
    return np.column_stack([np.zeros((len(rate), 2)), rate])


def _motion_std(time_s: np.ndarray, told: np.ndarray) -> np.ndarray:
    """Deviations (T, 2) of acceleration and rate of turn in each step that make up the walks.

    `told` (T,) is whether an indicator tells of the turn.
    """
    heading_walk_rad = np.where(told, TURNED_WALK_RAD, HEADING_WALK_RAD)
    walk = np.column_stack([np.full(len(time_s), VELOCITY_WALK_MPS), heading_walk_rad])
    return walk / np.sqrt(np.diff(time_s, prepend=-np.inf))[:, None]


def _between(time_s: np.ndarray, times: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values (T,) by linear interpolation; NaN where none is near."""
    if len(times) == 0:
        return np.full(len(time_s), np.nan)
    after = np.searchsorted(times, time_s)
    before_s = times[np.maximum(after - 1, 0)]
    after_s = times[np.minimum(after, len(times) - 1)]
    near = np.minimum(np.abs(time_s - before_s), np.abs(after_s - time_s)) <= _NEAR_S
    return np.where(near, np.interp(time_s, times, values), np.nan)


def _at(time_s: np.ndarray, times: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values at those of the times at which there are some, NaN at the others."""
    spread = np.full((len(time_s), *values.shape[1:]), np.nan)
    later = times >= time_s[0]
    spread[np.searchsorted(time_s, times[later])] = values[later]
    return spread


def _first(values: np.ndarray, otherwise: np.ndarray | float) -> np.ndarray | float:
    """The first row that is finite."""
    sound = np.isfinite(values.reshape(len(values), -1)).all(axis=1)
    return values[sound.argmax()] if sound.any() else otherwise


def _velocity(mean: np.ndarray, states: int) -> tuple[np.ndarray, np.ndarray]:
    """Velocity over ground (T, 2) and its slope in the state (T, 2, N)."""
    slope = np.zeros((len(mean), 2, states))
    if states == 5:
        slope[:, [0, 1], [2, 3]] = 1.0
        return mean[:, 2:4], slope
    ahead = np.column_stack([np.cos(mean[:, 2]), np.sin(mean[:, 2])])
    slope[:, 0, 2], slope[:, 1, 2] = -mean[:, 3] * ahead[:, 1], mean[:, 3] * ahead[:, 0]
    slope[:, :, 3] = ahead
    slope[:, [0, 1], [5, 6]] = 1.0
    return mean[:, 3:4] * ahead + mean[:, 5:7], slope


def _drift_std_mps(done: wl.navigation.UsvRun, offset_std_rad: float) -> np.ndarray:
    """Deviations (T,) of the current of seven states, in the direction in which it is known least.

    An error of all headings takes speed through the water for current.
    """
    way_rad, way_mps = done.mean[:, 2], done.mean[:, 3]
    across = np.column_stack([-np.sin(way_rad), np.cos(way_rad)])
    by_offset_mps = (offset_std_rad * way_mps)[:, None] * across
    by_offset_m2s2 = by_offset_mps[:, :, None] * by_offset_mps[:, None, :]
    return np.sqrt(np.linalg.eigvalsh(done.covariance[:, 5:7, 5:7] + by_offset_m2s2)[:, -1])


def _moved_m(
    readings: Readings, done: wl.navigation.UsvRun, velocity_mps: np.ndarray
) -> np.ndarray:
    """How far (T, 2) fixes outside the gate that were believed have moved the position."""
    outside = done.nis["gnss"] > -2.0 * np.log(1.0 - GATE_PROBABILITY)
    believed = np.flatnonzero(outside & ~done.rejected["gnss"])
    step_s = readings.time_s[believed] - readings.time_s[believed - 1]
    foretold_m = done.mean[believed - 1, :2] + velocity_mps[believed - 1] * step_s[:, None]
    moved_m = np.zeros((len(readings.time_s), 2))
    moved_m[believed] = readings.fix_m[believed] - foretold_m
    return moved_m


def _status(readings: Readings, rejected: np.ndarray, moved_m: np.ndarray) -> np.ndarray:
    believed = readings.has_fix & ~rejected
    last_s = np.maximum.accumulate(np.where(believed, readings.time_s, -np.inf))
    status = np.where(readings.time_s - last_s > COASTING_S, "coasting", "ok")
    status = np.where(_jumped(readings, rejected, moved_m), "jumped", status)
    return np.where(rejected, "rejected", status)


def _jumped(readings: Readings, rejected: np.ndarray, moved_m: np.ndarray) -> np.ndarray:
    """Mask (T,) of the times at which the position is in doubt, for it is not where it would be."""
    jumped = np.zeros(len(moved_m), dtype=bool)
    moved = moved_m.any(axis=1)
    ends = np.append(_fitted(readings, rejected | moved), len(moved))
    away_m = np.zeros(2)
    for k in np.flatnonzero(moved):
        away_m = moved_m[k] + (away_m if jumped[k] else 0.0)
        jumped[k : ends[np.searchsorted(ends, k)]] = np.hypot(*away_m) > JUMP_M
    return jumped


def _fitted(readings: Readings, misfit: np.ndarray) -> np.ndarray:
    """Indices (n,) of the fixes up to which all have fitted for a minute, without a gap as long."""
    fixed = np.flatnonzero(readings.has_fix)
    time_s = readings.time_s[fixed]
    again = misfit[fixed] | (np.diff(time_s, prepend=-np.inf) > JUMPED_S)
    since_s = np.maximum.accumulate(np.where(again, time_s, -np.inf))
    return fixed[time_s - since_s >= JUMPED_S]


def _straight_on(seen: Readings) -> np.ndarray:
    """Places (T, 2) on from the last fix with the last velocity over ground."""
    fix, fixed_s = _held(seen.time_s, seen.fix_m)
    told = np.isfinite(seen.velocity_mps).any()
    velocity, _ = _held(seen.time_s, seen.velocity_mps if told else _made_good_mps(seen))
    return fix + velocity * (seen.time_s - fixed_s)[:, None]


def _made_good_mps(seen: Readings) -> np.ndarray:
    """Velocities (T, 2) at fixes since one ten seconds or more before; NaN elsewhere."""
    fixed = np.flatnonzero(seen.has_fix)
    time_s, fix_m = seen.time_s[fixed], seen.fix_m[fixed]
    before = np.searchsorted(time_s, time_s - _MADE_GOOD_S, side="right") - 1
    known = before >= 0
    velocity = np.full(seen.fix_m.shape, np.nan)
    since_s = time_s[known] - time_s[before[known]]
    velocity[fixed[known]] = (fix_m[known] - fix_m[before[known]]) / since_s[:, None]
    return velocity


def _reckoned(seen: Readings) -> np.ndarray:
    """Places (T, 2) on from the last fix by heading and speed through water."""
    way_rad, _ = _held(seen.time_s, seen.way_rad)
    speed, _ = _held(seen.time_s, seen.way_mps)
    water = np.nan_to_num(speed[:, None] * np.column_stack([np.cos(way_rad), np.sin(way_rad)]))
    way = np.vstack(
        [np.zeros((1, 2)), np.cumsum(np.diff(seen.time_s)[:, None] * water[:-1], axis=0)]
    )
    fix, _ = _held(seen.time_s, seen.fix_m)
    way_at_fix, _ = _held(seen.time_s, np.where(np.isfinite(seen.fix_m), way, np.nan))
    return fix + way - way_at_fix


def _held(time_s: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The last finite row at each time, and when it was."""
    sound = np.isfinite(values.reshape(len(values), -1)).all(axis=1)
    last = np.maximum.accumulate(np.where(sound, np.arange(len(values)), 0))
    return values[last], time_s[last]


def _errors(
    readings: Readings, place_m: np.ndarray, starts_s: np.ndarray
) -> dict[float, np.ndarray]:
    fixed = np.flatnonzero(readings.has_fix)
    times = readings.time_s[fixed]
    errors: dict[float, list[float]] = {horizon_s: [] for horizon_s in HORIZONS_S}
    for start_s in progress(starts_s, len(starts_s), "comparing with hidden fixes"):
        before = np.searchsorted(times, start_s, side="right") - 1
        if start_s - times[before] > _NEAR_S:
            continue
        hidden = _is_hidden(times, np.array([start_s]))
        for horizon_s in HORIZONS_S:
            apart_s = np.where(hidden, np.abs(times - start_s - horizon_s), np.inf)
            k = fixed[apart_s.argmin()]
            if apart_s.min() <= _NEAR_S and np.isfinite(place_m[k]).all():
                errors[horizon_s].append(float(np.hypot(*(place_m[k] - readings.fix_m[k]))))
    return {horizon_s: np.array(values) for horizon_s, values in errors.items()}


def medians(errors: Mapping[float, np.ndarray]) -> dict[float, float]:
    """Median error by horizon; NaN where nothing could be compared."""
    return {h: float(np.median(e)) if len(e) else float("nan") for h, e in errors.items()}
