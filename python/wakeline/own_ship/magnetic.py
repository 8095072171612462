"""Offset of magnetic headings with unknown variation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from wakeline.recording import NavigationLog

from .instruments import UNDER_WAY_MPS, leeway_rad
from .times import between

CURRENT_STD_MPS = 0.5
_SAME_CURRENT_S = 1800.0
_MINUTE_STD_MPS = 0.2  # of the mean velocity of a minute: gusts, leeway, deviation


class MagneticOffset(NamedTuple):
    """Offset added to magnetic headings, and the standard deviation of this constant error."""

    offset_rad: float
    std_rad: float


NO_OFFSET = MagneticOffset(0.0, 0.0)
"""That of true headings."""
ANY_OFFSET = MagneticOffset(0.0, float(np.deg2rad(15.0)))
"""That of magnetic headings of unknown variation, as variations spread over the seas."""


def wants_offset(part: NavigationLog) -> bool:
    """Whether the headings of a part are magnetic with partly unknown variation."""
    unknown = np.isnan(part.compass.sound().variation_rad)
    return len(part.heading.sound()) == 0 and bool(unknown.any())


def magnetic_offset(parts: Sequence[NavigationLog]) -> MagneticOffset | None:
    """Estimate the offset of magnetic headings without variation from velocities over ground.

    Least squares over minutes of ground = a · water + current, complex numbers of north and east,
    water by the magnetic compass; the angle of a is the offset. The current is constant over half
    an hour; alterations of course separate it from the offset. Without a log, speeds over ground
    replace those through the water. None if there are no such readings, or the log reads only 0.
    """
    if len(parts) == 0:
        return None
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

    Those by compass have the speed through the water or, without a log, over ground.
    """
    ground, compass, water = part.ground.sound(), part.compass.sound(), part.water.sound()
    ground = ground.rows(ground.speed_mps > UNDER_WAY_MPS)
    heading = between(ground.time_s, compass.time_s, np.unwrap(compass.heading_magnetic_rad))
    speed_mps = ground.speed_mps
    if len(water):
        sideways = np.tan(leeway_rad(water, ground.time_s))
        speed_mps = between(ground.time_s, water.time_s, water.ahead_mps) * (1.0 + 1j * sideways)
    over_ground = ground.speed_mps * np.exp(1j * ground.course_rad)
    return ground.time_s, speed_mps * np.exp(1j * heading), over_ground
