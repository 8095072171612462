"""Closest approach of tracks to own ship, and dangerous encounters of any two vessels."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

import wakeline as wl
from wakeline._units import NAUTICAL_MILE_M
from wakeline.navigation import DangerLimits, DangerZone, EncounterTable
from wakeline.recording import OwnShipMotion, Tracks

OWN = "own"


@dataclass(frozen=True)
class Encounter:
    """A dangerous encounter of two vessels, from the first danger until it is over.

    Attributes
    ----------
    first, second : str
        Track ids; `first` is ``own`` for own ship.
    begin_s, end_s : float
        First and last time with danger.
    cpa_m, tcpa_s, cpa_std_m, tcpa_std_s, cpa_probability, range_m : float
        At the start: distance and time of the closest approach with their standard deviations,
        probability of a distance below the limit, and distance.
    least_range_m, least_range_s : float
        Smallest distance of the tracks up to the end, and its time.
    inside : bool
        Whether they were closer than the limit when it began.
    zone : str
        Zone whose limits applied; empty for the general ones.
    """

    first: str
    second: str
    begin_s: float
    end_s: float
    cpa_m: float
    tcpa_s: float
    cpa_std_m: float
    tcpa_std_s: float
    cpa_probability: float
    range_m: float
    least_range_m: float
    least_range_s: float
    inside: bool
    zone: str

    @property
    def with_own_ship(self) -> bool:
        """Whether own ship is one of the two."""
        return self.first == OWN

    def __str__(self) -> str:
        who = "track" if self.with_own_ship else f"tracks {self.first} and"
        inside = f"inside already, {_miles(self.range_m)} off; " if self.inside else ""
        return (
            f"{who} {self.second} at {self.begin_s:.1f} s: {inside}CPA {_miles(self.cpa_m)}, "
            f"TCPA {self.tcpa_s / 60.0:.1f} min, {100.0 * self.cpa_probability:.0f} %, "
            f"until {self.end_s:.1f} s"
        )


class Watched(NamedTuple):
    """Tracks with ``alarmed`` rows, and the encounters in order of start."""

    tracks: Tracks
    encounters: list[Encounter]


def with_closest_approach(
    tracks: Tracks, own: OwnShipMotion, limits: DangerLimits | None = None
) -> Tracks:
    """Add CPA, TCPA and the probability of a CPA below the limits to tracks.

    The errors are those of the tracks and of own ship's velocity. An error of own ship's position
    does not count: plots are measured from there, so that it moves the tracks with own ship.

    Parameters
    ----------
    tracks : Tracks
        With their covariance.
    own : OwnShipMotion
        Its velocity must be known.
    limits : DangerLimits, optional

    Raises
    ------
    ValueError
        When the tracks have no covariance or own ship's velocity is unknown.
    """
    limits = limits or DangerLimits()
    _require_covariance(tracks)
    state, covariance = _own_ship(own, tracks.time_s, limits)
    approach = wl.navigation.closest_approach(state, tracks.state, covariance, tracks.covariance)
    return replace(
        tracks,
        cpa_m=approach.cpa_m,
        tcpa_s=approach.tcpa_s,
        cpa_probability=approach.probability(limits.cpa_limit_m, limits.tcpa_limit_s),
    )


def watch_tracks(
    tracks: Tracks,
    own: OwnShipMotion | None = None,
    limits: DangerLimits | None = None,
    zones: Sequence[DangerZone] = (),
) -> Watched:
    """Find the dangerous encounters of tracks with each other and with own ship.

    Parameters
    ----------
    tracks : Tracks
        With their covariance.
    own : OwnShipMotion, optional
        Watched as one more vessel; its velocity must be known.
    limits : DangerLimits, optional
    zones : sequence of DangerZone, optional

    Returns
    -------
    Watched
        With own ship the tracks have a closest approach, and their rows in encounters with own ship
        are ``alarmed``.

    Raises
    ------
    ValueError
        When the tracks have no covariance or own ship's velocity is unknown.
    """
    limits = limits or DangerLimits()
    _require_covariance(tracks)
    encounters = list(_encounters(tracks, own, limits, zones))
    encounters.sort(key=lambda encounter: encounter.begin_s)
    if own is not None:
        alarmed = np.zeros(len(tracks), dtype=bool)
        for one in encounters:
            if one.with_own_ship:
                during = (one.begin_s <= tracks.time_s) & (tracks.time_s <= one.end_s)
                alarmed |= during & (tracks.track_id == one.second)
        tracks = replace(with_closest_approach(tracks, own, limits), alarmed=alarmed)
    return Watched(tracks, encounters)


def _encounters(
    tracks: Tracks, own: OwnShipMotion | None, limits: DangerLimits, zones: Sequence[DangerZone]
) -> Iterator[Encounter]:
    """The encounters, as they end."""
    number = {track_id: k for k, track_id in enumerate(tracks.ids(), 1)}
    vessel_id = np.array([number[track_id] for track_id in tracks.track_id], dtype=np.int64)
    time_s, row_of, rows = np.unique(tracks.time_s, return_inverse=True, return_counts=True)
    if len(time_s) == 0:
        return
    scans = np.split(np.argsort(row_of, kind="stable"), np.cumsum(rows)[:-1])
    state = covariance = None
    if own is not None:
        state, covariance = _own_ship(own, time_s, limits)
    watch = wl.navigation.EncounterWatch(limits, list(zones), int(rows.max()) + 1)
    names = [OWN, *number]
    begun: dict[int, dict[str, Any]] = {}
    for k, scan in enumerate(scans):
        scan = _latest_of_each(scan, vessel_id)
        vessels = (vessel_id[scan], tracks.state[scan], tracks.covariance[scan])
        if state is not None:
            ship = (np.zeros(1, dtype=np.int64), state[k : k + 1], covariance[k : k + 1])
            vessels = [np.concatenate(both) for both in zip(ship, vessels, strict=True)]
        report = watch.update(
            time_s[k], vessel_id=vessels[0], mean=vessels[1], covariance=vessels[2]
        )
        begun |= _starts(report.began, names, limits, zones)
        yield from _ended(begun, report.ended)
    yield from _ended(begun, watch.encounters)


def _latest_of_each(scan: np.ndarray, vessel_id: np.ndarray) -> np.ndarray:
    """The rows of a scan, the last one of each track."""
    _, last = np.unique(vessel_id[scan][::-1], return_index=True)
    return scan[::-1][last]


def _starts(
    began: EncounterTable, names: Sequence[str], limits: DangerLimits, zones: Sequence[DangerZone]
) -> dict[int, dict[str, Any]]:
    """What is known of each encounter when it begins, by its number."""
    std = np.sqrt(np.diagonal(began.covariance, axis1=1, axis2=2))
    columns = {
        "begin_s": began.begin_s,
        "cpa_m": began.cpa_m,
        "tcpa_s": began.tcpa_s,
        "cpa_std_m": std[:, 0],
        "tcpa_std_s": std[:, 1],
        "cpa_probability": began.probability,
        "range_m": began.range_m,
    }
    first, second, starts = began.first, began.second, {}
    for k, (one, place) in enumerate(zip(began.encounter_id.tolist(), began.zone, strict=True)):
        zone = zones[place] if place >= 0 else None
        start = {name: float(column[k]) for name, column in columns.items()}
        start["first"], start["second"] = names[first[k]], names[second[k]]
        start["inside"] = start["range_m"] < (zone.limits if zone else limits).cpa_limit_m
        starts[one] = start | {"zone": zone.name if zone else ""}
    return starts


def _ended(begun: dict[int, dict[str, Any]], ended: EncounterTable) -> Iterator[Encounter]:
    columns = (ended.encounter_id, ended.last_s, ended.least_range_m, ended.least_range_s)
    for one, *rest in zip(*(column.tolist() for column in columns), strict=True):
        end = dict(zip(("end_s", "least_range_m", "least_range_s"), rest, strict=True))
        yield Encounter(**begun.pop(one), **end)


def _own_ship(
    own: OwnShipMotion, time_s: np.ndarray, limits: DangerLimits
) -> tuple[np.ndarray, np.ndarray]:
    """States (n, 4) of own ship and their covariance (n, 4, 4), that of its velocity alone."""
    if not own.knows_velocity:
        raise ValueError("own must have a velocity or more than one position, got one position")
    north_m, east_m = own.position_at(time_s).T
    vnorth_mps, veast_mps = own.velocity_at(time_s).T
    velocity_m2s2 = own.velocity_m2s2_at(time_s)
    if velocity_m2s2 is None:
        velocity_m2s2 = limits.own_velocity_std_mps**2 * np.eye(2)
    covariance = np.zeros((len(time_s), 4, 4))
    covariance[:, 1::2, 1::2] = velocity_m2s2
    return np.column_stack([north_m, vnorth_mps, east_m, veast_mps]), covariance


def _require_covariance(tracks: Tracks) -> None:
    if tracks.covariance is None:
        raise ValueError("tracks must have a covariance for a closest approach, got none")


def _miles(distance_m: float) -> str:
    return f"{distance_m:.0f} m ({distance_m / NAUTICAL_MILE_M:.2f} NM)"
