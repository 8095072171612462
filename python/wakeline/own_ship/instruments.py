"""Readings of own ship's individual instruments."""

from __future__ import annotations

import numpy as np

import wakeline as wl
from wakeline.recording import NavigationLog
from wakeline.recording.nmea import BottomTrack, GroundSpeed, WaterSpeed

from .times import between

FIX_STD_M = 3.0
"""Standard deviation of a GNSS position, per axis, m."""
VELOCITY_STD_MPS = 0.3  # over ground: filtered by the receiver, or rotated by the heading
UNDER_WAY_MPS = 1.5


def speed_and_course(ground: GroundSpeed) -> tuple[np.ndarray, np.ndarray]:
    """Speeds and courses (n,) over ground; a speed within its error without a course is zero."""
    rest = np.isnan(ground.course_rad) & (ground.speed_mps <= VELOCITY_STD_MPS)
    return np.where(rest, 0.0, ground.speed_mps), np.where(rest, 0.0, ground.course_rad)


def true_headings(part: NavigationLog, offset_rad: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and true headings: reported as true, else from the magnetic compass.

    `offset_rad` is added to magnetic headings of unknown variation.
    """
    true = part.heading.sound()
    if len(true):
        return true.time_s, true.heading_rad
    compass = part.compass.sound()
    variation = np.where(np.isnan(compass.variation_rad), offset_rad, compass.variation_rad)
    return compass.time_s, wl.wrap_angle(compass.heading_magnetic_rad + variation)


def leeway_rad(water: WaterSpeed, time_s: np.ndarray) -> np.ndarray:
    """Leeway angles (T,) from the heading to the course through the water, 0 if unknown.

    They tend to zero with the speed ahead.
    """
    known = water.rows(np.isfinite(water.ahead_mps) & np.isfinite(water.starboard_mps))
    ahead, starboard = known.ahead_mps, known.starboard_mps
    leeway = np.arctan(ahead * starboard / np.maximum(ahead**2, UNDER_WAY_MPS**2))
    return np.nan_to_num(between(time_s, known.time_s, leeway))


def over_ground_mps(bottom: BottomTrack, times: np.ndarray, heading_rad: np.ndarray) -> np.ndarray:
    """Velocities (n, 2) north and east from a log; NaN without a heading near that time."""
    heading = between(bottom.time_s, times, np.unwrap(heading_rad))
    c, s = np.cos(heading), np.sin(heading)
    ahead, starboard = bottom.ahead_mps, bottom.starboard_mps
    return np.column_stack([c * ahead - s * starboard, s * ahead + c * starboard])
