"""The trackers of a session: sectors of radars and reports in, tracks out."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import wakeline as wl
from wakeline.measurement import OwnShip
from wakeline.tracking import MODE_NAMES
from wakeline.tracking.settings import Settings

_SILENT_TURNS = 2.5  # a sector that is a little late still comes before the miss


@dataclass(frozen=True)
class LiveTrack:
    """A track at a time.

    Attributes
    ----------
    track_id : int
    status : str
        tentative, confirmed, coasting or held.
    name : str
        Given by the operator.
    time_s : float
    mean : tuple of float
        [north, its velocity, east, its velocity].
    covariance : tuple of tuple of float
    mode_probability : tuple of float
    existence : float
    hits, misses : int
    identity : str
        Of the vessel that reports from the track, such as its MMSI; empty without one.
    identity_probability, identity_time_s : float
        How probable that is, and the time of its last report.
    """

    track_id: int
    status: str
    name: str
    time_s: float
    mean: tuple[float, float, float, float]
    covariance: tuple[tuple[float, ...], ...]
    mode_probability: tuple[float, ...]
    existence: float
    hits: int
    misses: int
    identity: str = ""
    identity_probability: float = 0.0
    identity_time_s: float = math.nan

    @property
    def north_m(self) -> float:
        return self.mean[0]

    @property
    def east_m(self) -> float:
        return self.mean[2]

    @property
    def speed_mps(self) -> float:
        return math.hypot(self.mean[1], self.mean[3])

    @property
    def course_rad(self) -> float:
        return math.atan2(self.mean[3], self.mean[1]) % (2.0 * math.pi)

    @property
    def mode(self) -> str:
        """The likeliest motion, such as "turning"; '' where the models have no names."""
        if len(self.mode_probability) != len(MODE_NAMES):
            return ""
        return MODE_NAMES[int(np.argmax(self.mode_probability))]


class TrackEngine:
    """The tracker of all radars of a session.

    Parameters
    ----------
    radars : sequence of Radar
    settings : Settings
        Of tracker and motion models.

    Attributes
    ----------
    late_sectors : int
        Sectors that came too late to be used.
    """

    def __init__(self, radars: Sequence[wl.Radar], settings: Settings) -> None:
        self.radars = list(radars)
        self.late_sectors = 0
        self._tracker = settings.tracker_of(self.radars)
        self._last_s = [-math.inf] * len(self.radars)

    @property
    def time_s(self) -> float:
        """The latest time of any sector; 0 before the first."""
        return self._tracker.time_s

    def sector(
        self,
        radar: int,
        from_rad: float,
        to_rad: float,
        time_s: float,
        range_m: np.ndarray,
        bearing_rad: np.ndarray,
        plot_time_s: np.ndarray,
        own: OwnShip,
        covariance: np.ndarray | None = None,
    ) -> list[dict[str, Any]]:
        """Process a part of a radar's turn; the events of tracks."""
        time_s = max(time_s, self._last_s[radar])
        events = list(self._catch_up(radar, time_s))
        if time_s < self.time_s - self.radars[radar].period_s:
            self.late_sectors += 1
            return events
        report = self._tracker.sector(
            radar=radar,
            from_rad=from_rad,
            to_rad=to_rad,
            time_s=time_s,
            range_m=range_m,
            bearing_rad=bearing_rad,
            plot_time_s=plot_time_s,
            own=own,
            covariance=covariance,
        )
        self._last_s[radar] = time_s
        return events + _events(report.events)

    def coast(self, time_s: float) -> list[dict[str, Any]]:
        """Let time pass for radars that are silent for more than two periods."""
        events: list[dict[str, Any]] = []
        for radar, last_s in enumerate(self._last_s):
            if self.time_s > 0.0 and last_s < time_s - _SILENT_TURNS * self.radars[radar].period_s:
                events += self._catch_up(radar, time_s)
                events += self._pass(radar, max(time_s, last_s))
        return events

    def _catch_up(self, radar: int, time_s: float) -> Iterator[dict[str, Any]]:
        """Steps of an hour over a longer silence."""
        while self.time_s > 0.0 and time_s > self._tracker.latest_time_s:
            yield from self._pass(radar, self._tracker.latest_time_s)

    def _pass(self, radar: int, time_s: float) -> list[dict[str, Any]]:
        report = self._tracker.sector(
            radar=radar, from_rad=0.0, to_rad=0.0, time_s=time_s, range_m=[], bearing_rad=[]
        )
        self._last_s[radar] = time_s
        return _events(report.events)

    def tracks(self, time_s: float | None = None) -> list[LiveTrack]:
        """All shown tracks, at a time or at that of the last sector."""
        return list(self._rows(self._tracker.tracks(time_s=time_s)))

    def updated(self, seen: dict[int, tuple[int, int]]) -> tuple[list[LiveTrack], set[int]]:
        """Tracks whose hits or misses are not those in `seen`, which is brought up to date.

        With them the numbers of all shown tracks.
        """
        table = self._tracker.tracks()
        ids = table.track_id.tolist()
        now = list(zip(table.hits.tolist(), table.misses.tolist(), strict=True))
        rows = [k for k, one in enumerate(ids) if seen.get(one) != now[k]]
        seen.update((ids[k], now[k]) for k in rows)
        return list(self._rows(table, rows)), set(ids)

    def _rows(
        self, table: wl.track.TrackTable, rows: Sequence[int] | None = None
    ) -> Iterator[LiveTrack]:
        """Tracks of a table, or of some of its rows."""
        which = np.arange(len(table)) if rows is None else np.array(rows, dtype=np.int64)
        status, name = table.status, table.name
        columns = zip(
            table.track_id[which].tolist(),
            [status[k] for k in which.tolist()],
            [name[k] for k in which.tolist()],
            table.time_s[which].tolist(),
            table.mean[which].tolist(),
            table.covariance[which].tolist(),
            table.mode_probability[which].tolist(),
            table.existence[which].tolist(),
            table.hits[which].tolist(),
            table.misses[which].tolist(),
            *_identities(table, which),
            strict=True,
        )
        yield from (LiveTrack(*values) for values in columns)

    def designate(self, time_s: float, north_m: float, east_m: float, std_m: float = 50.0) -> int:
        """Confirm the track at a position, or start one; its number, 0 without room."""
        return self._tracker.designate(max(time_s, self.time_s), north_m, east_m, std_m)

    def drop(self, track_id: int, *, hush: bool = False) -> bool:
        """End a track; False if there is none with that number."""
        return self._tracker.drop(track_id, hush=hush)

    def rename(self, track_id: int, name: str) -> bool:
        """Name a track; False if there is none with that number."""
        return self._tracker.rename(track_id, name)

    def save(self) -> bytes:
        """The state, for `restore`."""
        return self._tracker.save()

    def restore(self, state: bytes) -> None:
        """Continue from a state; ValueError if it is that of another tracker."""
        self._tracker.restore(state)
        self._last_s = [self.time_s] * len(self.radars)

    def report(self, **report: Any) -> list[dict[str, Any]]:
        """Take a position report with an identity; the events of tracks.

        The arguments are those of ``Tracker.report``; velocities that are not finite are unknown.
        """
        if not math.isfinite(report["vnorth_mps"] + report["veast_mps"]):
            report |= {"vnorth_mps": None, "veast_mps": None}
        return _events(self._tracker.report(**report).events)


def _identities(table: wl.track.TrackTable, which: np.ndarray) -> list[list[Any]]:
    """Columns of identity, its probability and the time of its last report."""
    names = table.identity
    return [
        [names[k] for k in which.tolist()],
        table.identity_probability[which].tolist(),
        table.identity_time_s[which].tolist(),
    ]


def _events(events: Sequence[wl.Event]) -> list[dict[str, Any]]:
    return [
        {
            "event": event.kind,
            "track_id": event.track_id,
            "time_s": event.time_s,
            "reason": event.reason,
        }
        | ({"identity": event.identity} if event.identity else {})
        for event in events
        if event.track_id > 0
    ]
