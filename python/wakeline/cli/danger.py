"""Which tracks come dangerously close to own ship, and since when."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace

import numpy as np

import wakeline as wl
from wakeline.recording import OwnShip, Tracks

NAUTICAL_MILE_M = 1852.0


@dataclass(frozen=True)
class DangerLimits:
    """When a track is dangerous.

    An alarm begins when a track comes closer than `cpa_limit_m` within `tcpa_limit_s` with a
    probability of `alarm_probability` or more, its closest point still ahead. It is over when the
    probability stays below `clear_probability` for `clear_hold_s`, so that one encounter is one
    alarm while the estimate of a far ship still wanders, or when the track ends. Its last scan is
    the last one that was not below.

    Attributes
    ----------
    cpa_limit_m, tcpa_limit_s : float
        Not negative.
    alarm_probability, clear_probability : float
        Between 0 and 1, the second not above the first.
    clear_hold_s : float
        Not negative.
    own_velocity_std_mps : float
        Error of own ship's velocity per axis, where her file does not tell its covariance.

    Raises
    ------
    ValueError
        When one is out of its range.
    """

    cpa_limit_m: float = NAUTICAL_MILE_M / 2.0
    tcpa_limit_s: float = 1200.0
    alarm_probability: float = 0.5
    clear_probability: float = 0.3
    clear_hold_s: float = 60.0
    own_velocity_std_mps: float = 0.2

    def __post_init__(self) -> None:
        for name, value in asdict(self).items():
            if not (math.isfinite(value) and value >= 0.0):
                raise ValueError(f"{name} must be finite and not negative, got {value}")
        for name in ("alarm_probability", "clear_probability"):
            if not getattr(self, name) <= 1.0:
                raise ValueError(f"{name} must be at most 1, got {getattr(self, name)}")
        if self.clear_probability > self.alarm_probability:
            raise ValueError(
                f"clear_probability must not be above alarm_probability = "
                f"{self.alarm_probability}, got {self.clear_probability}"
            )

    def as_dict(self) -> dict[str, float]:
        """The limits by name."""
        return asdict(self)


@dataclass(frozen=True)
class Alarm:
    """A stretch of a track that is dangerous.

    Attributes
    ----------
    track_id : str
    begin_s, end_s : float
        Times of its first and last scan.
    cpa_m, tcpa_s, cpa_probability, range_m : float
        As they stood when it began.
    inside : bool
        Whether it was closer than the limit already.
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
        inside = f"inside already, {_way(self.range_m)} off; " if self.inside else ""
        return (
            f"track {self.track_id} at {self.begin_s:.1f} s: {inside}CPA {_way(self.cpa_m)}, "
            f"TCPA {self.tcpa_s / 60.0:.1f} min, {100.0 * self.cpa_probability:.0f} %, "
            f"until {self.end_s:.1f} s"
        )


def _way(way_m: float) -> str:
    return f"{way_m:.0f} m ({way_m / NAUTICAL_MILE_M:.2f} NM)"


@dataclass(frozen=True)
class Danger:
    """What is dangerous of the tracks of an episode.

    Attributes
    ----------
    alarmed : ndarray of bool (n,)
        Rows of the tracks under an alarm.
    alarms : list of Alarm
        In the order in which they began.
    """

    alarmed: np.ndarray
    alarms: list[Alarm]


def with_closest_approach(tracks: Tracks, own: OwnShip, limits: DangerLimits) -> Tracks:
    """The tracks with CPA, TCPA and the probability of passing closer than the limit.

    Errors are those of the tracks and of own ship's velocity. An error of her place is none of
    them: plots are seen from there, so that it moves the tracks with her.

    Parameters
    ----------
    tracks : Tracks
        With their covariance.
    own : OwnShip
        Its velocity must be known.
    limits : DangerLimits
    """
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


def danger_of(tracks: Tracks, own: OwnShip, limits: DangerLimits) -> Danger:
    """The alarms of tracks whose rows are in order of time and have a probability."""
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
    return Danger(alarmed, sorted(alarms, key=lambda alarm: alarm.begin_s))


def _runs(track: Tracks, limits: DangerLimits) -> Iterator[slice]:
    """Stretches of a track under an alarm."""
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
