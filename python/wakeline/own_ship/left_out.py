"""Readings of a log that the solution ignores or rejects."""

from __future__ import annotations

import numpy as np

from wakeline.recording import NavigationLog

from .instruments import UNDER_WAY_MPS, over_ground_mps, speed_and_course, true_headings
from .solution import OwnTrack
from .times import between


def unused(part: NavigationLog) -> dict[str, np.ndarray]:
    """Lines of the valid readings of a part that its solution ignores, by kind."""
    fixed_s = part.fixes.sound().time_s
    first_s = fixed_s[0] if len(fixed_s) else np.inf
    early = [s.line[s.usable & (s.time_s < first_s)] for s in part.series.values()]
    ground, water, bottom, turn = (
        s.rows(s.usable & (s.time_s >= first_s))
        for s in (part.ground, part.water, part.bottom, part.turn)
    )
    known = np.isfinite(speed_and_course(ground)).all(axis=0)
    headings = true_headings(part, 0.0)
    over_ground = np.isfinite(over_ground_mps(bottom, *headings)).all(axis=1)
    nothing = np.zeros(0, dtype=np.int64)
    blind = len(headings[0]) == 0
    return {
        "readings with no fix before them": np.concatenate(early),
        "speeds over ground without a course, or courses without a speed": ground.line[~known],
        "speeds through the water without a heading": water.line if blind else nothing,
        "speeds through the water across the hull alone": water.line[np.isnan(water.ahead_mps)],
        "speeds over ground by log that lack a heading or a side": bottom.line[~over_ground],
        "rates of turn without a heading": turn.line if blind else nothing,
        "speeds through the water and rates of turn beside an IMU": (
            np.concatenate([water.line, turn.line]) if len(part.imu) else nothing
        ),
    }


def rejected_lines(part: NavigationLog, track: OwnTrack) -> dict[str, np.ndarray]:
    """Lines of the valid readings of a part that were rejected, by kind."""
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
    """Lines (n,) of valid speeds through the water of 0 while the ship moves over ground."""
    water, ground = part.water.sound(), part.ground.sound()
    over_ground_mps = between(water.time_s, ground.time_s, ground.speed_mps)
    return water.line[(water.ahead_mps == 0.0) & (over_ground_mps > UNDER_WAY_MPS)]
