"""Azimuths from own ship's bow, turned to north by own ship's heading."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from itertools import islice, pairwise
from pathlib import Path

import numpy as np

from wakeline._engine.core import wrap_angle

from .errors import RecordingError
from .model import Episode, OwnShipMotion, Scan

AZIMUTHS = ("north", "bow")

_LEAST_TURN_RAD = np.radians(10.0)
_MOST_PAIRS, _MOST_PLOTS = 200, 200
_LEAST_STEPS = 20
_CLEARLY = 0.5


def check_azimuth(azimuth: str, own_path: str | Path | None) -> None:
    """Raise ValueError unless `azimuth` is a known origin; "bow" needs own ship's file."""
    if azimuth not in AZIMUTHS:
        raise ValueError(f"azimuth must be one of {', '.join(AZIMUTHS)}, got {azimuth!r}")
    if azimuth == "bow" and own_path is None:
        raise ValueError("azimuths from the bow need own ship's heading: give own ship's file")


def headings_at(ship: OwnShipMotion, time_s: np.ndarray, own_path: str | Path) -> np.ndarray:
    """Headings (n,) by linear interpolation.

    Raises
    ------
    RecordingError
        When own ship's file has none.
    """
    known = np.zeros(0) if ship.heading_rad is None else np.flatnonzero(~np.isnan(ship.heading_rad))
    if len(known) == 0:
        raise RecordingError(
            own_path,
            "there is no heading, from which azimuths from the bow count",
            column="heading_deg",
            wanted="own ship's heading",
        )
    return np.interp(time_s, ship.time_s[known], np.unwrap(ship.heading_rad[known]))


def turned_to_north(episode: Episode, own_path: str | Path) -> Episode:
    """An episode whose bearings count from the bow, with bearings from north."""

    def turned(scan: Scan) -> Scan:
        heading_rad = headings_at(episode.own, scan.plot_time_s, own_path)
        bearing_rad = wrap_angle(scan.bearing_rad + heading_rad)
        return dataclasses.replace(
            scan,
            bearing_rad=bearing_rad,
            north_m=scan.own_north_m + scan.range_m * np.cos(bearing_rad),
            east_m=scan.own_east_m + scan.range_m * np.sin(bearing_rad),
        )

    return dataclasses.replace(episode, scans=[turned(scan) for scan in episode.scans])


def azimuth_notes(episodes: Sequence[Episode], azimuth: str) -> list[str]:
    """A note if plots stay in place from scan to scan with the other origin of azimuths only."""
    sign = 1.0 if azimuth == "north" else -1.0
    steps_m: list[np.ndarray] = []
    for episode in episodes:
        heading_rad = episode.own.heading_rad
        known = np.isfinite(heading_rad) if heading_rad is not None else np.zeros(0, dtype=bool)
        if known.any() and np.ptp(np.unwrap(heading_rad[known])) >= _LEAST_TURN_RAD:
            filled = (scan for scan in episode.scans if 0 < len(scan) <= _MOST_PLOTS)
            pairs = islice(pairwise(filled), _MOST_PAIRS)
            steps_m += [_steps_m(episode.own, a, b, sign) for a, b in pairs]
    if sum(map(len, steps_m)) < _LEAST_STEPS:
        return []
    as_is_m, turned_m = np.median(np.concatenate(steps_m), axis=0)
    if not turned_m < _CLEARLY * as_is_m:
        return []
    other = AZIMUTHS[1 - AZIMUTHS.index(azimuth)]
    moves = f"plots move by {as_is_m:.0f} m from scan to scan with azimuths from the {azimuth}"
    would = f"by {turned_m:.0f} m with azimuths from the {other}"
    return [f"{moves}, and {would}: if they are these, give --azimuth {other}"]


def _steps_m(ship: OwnShipMotion, a: Scan, b: Scan, sign: float) -> np.ndarray:
    """Distances (n, 2) to the nearest plot of the next scan, as they are and turned by headings."""
    distances = [
        np.abs(_places_m(ship, a, by)[:, None] - _places_m(ship, b, by)).min(axis=1)
        for by in (0.0, sign)
    ]
    return np.column_stack(distances)


def _places_m(ship: OwnShipMotion, scan: Scan, by: float) -> np.ndarray:
    """Positions (n,) as complex numbers, with bearings turned by a multiple of the heading."""
    turn_rad = by * headings_at(ship, scan.plot_time_s, "") if by else 0.0
    own_m = scan.own_north_m + 1j * scan.own_east_m
    return own_m + scan.range_m * np.exp(1j * (scan.bearing_rad + turn_rad))
