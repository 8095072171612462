"""Closest approach of tracks to own ship, and collision alarms."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, fields, replace
from typing import NamedTuple

import numpy as np

import wakeline as wl
from wakeline._checks import fraction, not_negative, number_fields
from wakeline._units import NAUTICAL_MILE_M
from wakeline.recording import OwnShipMotion, Tracks


class Field(NamedTuple):
    """A field of parameters, as the ``fields()`` of the engine's parameters describe theirs."""

    name: str
    type: type
    default: float
    unit: str
    rule: str
    sentence: str


def _limit(default: float, unit: str, rule: str, sentence: str) -> float:
    return field(default=default, metadata={"unit": unit, "rule": rule, "sentence": sentence})


_NOT_NEGATIVE, _PROBABILITY = "finite and not negative", "from 0 to 1"


@dataclass(frozen=True)
class DangerLimits:
    """Limits of a dangerous approach.

    An alarm begins when a track will be closer than `cpa_limit_m` within `tcpa_limit_s` with at
    least `alarm_probability`, before its closest approach. It ends when the probability remains
    below `clear_probability` for `clear_hold_s`, or when the track ends. The hold time keeps one
    alarm per encounter while the estimate of a distant ship varies.

    Raises
    ------
    ValueError
        When a value is out of range, or `clear_probability` is above `alarm_probability`.

    Attributes
    ----------
    """

    cpa_limit_m: float = _limit(
        NAUTICAL_MILE_M / 2.0, "m", _NOT_NEGATIVE, "Distance below which a track is dangerous."
    )
    tcpa_limit_s: float = _limit(
        1200.0, "s", _NOT_NEGATIVE, "Time within which the track comes so close."
    )
    alarm_probability: float = _limit(
        0.5, "1", _PROBABILITY, "With this probability or more, an alarm begins."
    )
    clear_probability: float = _limit(
        0.3, "1", _PROBABILITY, "An alarm ends when the probability stays below this."
    )
    clear_hold_s: float = _limit(
        60.0, "s", _NOT_NEGATIVE, "Time for which it must stay below; shorter gaps end no alarm."
    )
    own_velocity_std_mps: float = _limit(
        0.2,
        "m/s",
        _NOT_NEGATIVE,
        "Standard deviation of own ship's velocity per axis, if its covariance is unknown.",
    )

    def __post_init__(self) -> None:
        not_negative(**asdict(self))
        fraction(**number_fields(self, "alarm_probability", "clear_probability"))
        if self.clear_probability > self.alarm_probability:
            raise ValueError(
                f"clear_probability must not be above alarm_probability = "
                f"{self.alarm_probability}, got {self.clear_probability}"
            )

    @staticmethod
    def fields() -> tuple[Field, ...]:
        """The table of the fields: name, type, default, unit, rule and a sentence on each."""
        return tuple(Field(f.name, float, f.default, **f.metadata) for f in fields(DangerLimits))

    def as_dict(self) -> dict[str, float]:
        """The limits by name."""
        return asdict(self)


DangerLimits.__doc__ = (DangerLimits.__doc__ or "").rstrip() + "".join(
    f"\n    {f.name} : float, default {f.default:g}\n        {f.sentence} [{f.unit}; {f.rule}]"
    for f in DangerLimits.fields()
)


@dataclass(frozen=True)
class Alarm:
    """A dangerous part of a track.

    Attributes
    ----------
    track_id : str
    begin_s, end_s : float
        Times of its first and its last scan.
    cpa_m, tcpa_s, cpa_probability, range_m : float
        At the start: distance and time of the closest approach, probability of a distance below the
        limit, and range.
    inside : bool
        Whether the track was closer than the limit when the alarm began.
    """

    track_id: str
    begin_s: float
    end_s: float
    cpa_m: float
    tcpa_s: float
    cpa_probability: float
    range_m: float
    inside: bool

    def __str__(self) -> str:
        inside = f"inside already, {_miles(self.range_m)} off; " if self.inside else ""
        return (
            f"track {self.track_id} at {self.begin_s:.1f} s: {inside}CPA {_miles(self.cpa_m)}, "
            f"TCPA {self.tcpa_s / 60.0:.1f} min, {100.0 * self.cpa_probability:.0f} %, "
            f"until {self.end_s:.1f} s"
        )


class Watched(NamedTuple):
    """Tracks with ``alarmed`` rows, and the alarms in order of start."""

    tracks: Tracks
    alarms: list[Alarm]


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
    if tracks.covariance is None:
        raise ValueError("tracks must have a covariance for a closest approach, got none")
    if not own.knows_velocity:
        raise ValueError("own must have a velocity or more than one position, got one position")
    north_m, east_m = own.position_at(tracks.time_s).T
    vnorth_mps, veast_mps = own.velocity_at(tracks.time_s).T
    velocity_m2s2 = own.velocity_m2s2_at(tracks.time_s)
    if velocity_m2s2 is None:
        velocity_m2s2 = limits.own_velocity_std_mps**2 * np.eye(2)
    own_covariance = np.zeros((len(tracks), 4, 4))
    own_covariance[:, 1::2, 1::2] = velocity_m2s2
    approach = wl.navigation.closest_approach(
        np.column_stack([north_m, vnorth_mps, east_m, veast_mps]),
        tracks.state,
        own_covariance,
        tracks.covariance,
    )
    return replace(
        tracks,
        cpa_m=approach.cpa_m,
        tcpa_s=approach.tcpa_s,
        cpa_probability=approach.probability(limits.cpa_limit_m, limits.tcpa_limit_s),
    )


def with_alarms(tracks: Tracks, own: OwnShipMotion, limits: DangerLimits | None = None) -> Watched:
    """Find the alarms of tracks that come dangerously close to own ship.

    Parameters
    ----------
    tracks : Tracks
        Rows of each track in order of time. Without a closest approach,
        :func:`with_closest_approach` adds it.
    own : OwnShipMotion
    limits : DangerLimits, optional
    """
    limits = limits or DangerLimits()
    if tracks.cpa_probability is None:
        tracks = with_closest_approach(tracks, own, limits)
    range_m = np.hypot(*(tracks.state[:, [0, 2]] - own.position_at(tracks.time_s)).T)
    alarmed = np.zeros(len(tracks), dtype=bool)
    alarms: list[Alarm] = []
    for track_id in tracks.ids():
        rows = np.flatnonzero(tracks.track_id == track_id)
        for run in _runs(tracks.where(rows), limits):
            alarmed[rows[run]] = True
            first, last = rows[run][[0, -1]]
            alarms.append(
                Alarm(
                    track_id,
                    begin_s=float(tracks.time_s[first]),
                    end_s=float(tracks.time_s[last]),
                    cpa_m=float(tracks.cpa_m[first]),
                    tcpa_s=float(tracks.tcpa_s[first]),
                    cpa_probability=float(tracks.cpa_probability[first]),
                    range_m=float(range_m[first]),
                    inside=bool(range_m[first] < limits.cpa_limit_m),
                )
            )
    alarms.sort(key=lambda alarm: alarm.begin_s)
    return Watched(replace(tracks, alarmed=alarmed), alarms)


def _runs(track: Tracks, limits: DangerLimits) -> Iterator[slice]:
    """Rows of one track under each alarm."""
    begin = last = None
    ahead = track.tcpa_s >= 0.0
    for k, p in enumerate(track.cpa_probability):
        if begin is None:
            if p >= limits.alarm_probability and ahead[k]:
                begin = last = k
        elif p >= limits.clear_probability:
            last = k
        elif track.time_s[k] - track.time_s[last + 1] >= limits.clear_hold_s:
            yield slice(begin, last + 1)
            begin = None
    if begin is not None:
        yield slice(begin, last + 1)


def _miles(distance_m: float) -> str:
    return f"{distance_m:.0f} m ({distance_m / NAUTICAL_MILE_M:.2f} NM)"
