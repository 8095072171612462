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

_STATE = 4


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
    """Tracks of all radars of a session.

    Each radar has a tracker; a track's number is unique in the session.

    Parameters
    ----------
    radars : sequence of Radar
    settings : Settings
        Of tracker and motion models.
    """

    def __init__(self, radars: Sequence[wl.Radar], settings: Settings) -> None:
        self.radars = list(radars)
        self._trackers = [settings.tracker_of(radar) for radar in self.radars]

    @property
    def time_s(self) -> float:
        """The latest time of any sector; 0 before the first."""
        return max(tracker.time_s for tracker in self._trackers)

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
        tracker = self._trackers[radar]
        events = list(self._catch_up(radar, time_s))
        report = tracker.sector(
            radar=0,
            from_rad=from_rad,
            to_rad=to_rad,
            time_s=max(time_s, tracker.time_s),
            range_m=range_m,
            bearing_rad=bearing_rad,
            plot_time_s=plot_time_s,
            own=own,
            covariance=covariance,
        )
        return events + self._events(radar, report.events)

    def coast(self, time_s: float) -> list[dict[str, Any]]:
        """Let time pass for radars that are silent for two periods."""
        events = []
        for radar, tracker in enumerate(self._trackers):
            if 0.0 < tracker.time_s < time_s - 2.0 * self.radars[radar].period_s:
                events += self._catch_up(radar, time_s)
                events += self._pass(radar, time_s)
        return events

    def _catch_up(self, radar: int, time_s: float) -> Iterator[dict[str, Any]]:
        """Steps of an hour over a longer silence."""
        tracker = self._trackers[radar]
        while time_s > tracker.latest_time_s:
            yield from self._pass(radar, tracker.latest_time_s)

    def _pass(self, radar: int, time_s: float) -> list[dict[str, Any]]:
        report = self._trackers[radar].sector(
            radar=0, from_rad=0.0, to_rad=0.0, time_s=time_s, range_m=[], bearing_rad=[]
        )
        return self._events(radar, report.events)

    def _events(self, radar: int, events: Sequence[wl.Event]) -> list[dict[str, Any]]:
        return [
            {
                "event": event.kind,
                "track_id": self._number(radar, event.track_id),
                "time_s": event.time_s,
                "reason": event.reason,
            }
            for event in events
            if event.track_id > 0
        ]

    def tracks(self, time_s: float | None = None, *, tentative: bool = False) -> list[LiveTrack]:
        """All tracks, at a time or at that of the last sector."""
        return [
            track
            for radar, tracker in enumerate(self._trackers)
            for track in self._rows(radar, tracker.tracks(time_s=time_s, tentative=tentative))
        ]

    def _rows(self, radar: int, table: wl.track.TrackTable) -> Iterator[LiveTrack]:
        columns = zip(
            table.track_id.tolist(),
            table.status,
            table.name,
            table.time_s.tolist(),
            table.mean.tolist(),
            table.covariance.tolist(),
            table.mode_probability.tolist(),
            table.existence.tolist(),
            table.hits.tolist(),
            table.misses.tolist(),
            strict=True,
        )
        for track_id, *values in columns:
            yield LiveTrack(self._number(radar, track_id), *values)

    def _number(self, radar: int, track_id: int) -> int:
        return track_id * len(self._trackers) + (radar if track_id > 0 else -radar)

    def _tracker_of(self, track_id: int) -> tuple[wl.Tracker, int]:
        own_id, radar = divmod(abs(track_id), len(self._trackers))
        return self._trackers[radar], own_id if track_id > 0 else -own_id

    def designate(self, time_s: float, north_m: float, east_m: float, std_m: float = 50.0) -> int:
        """Confirm the track at a position, or start one; its number, 0 without room."""
        tracker = self._trackers[0]
        track_id = tracker.designate(max(time_s, tracker.time_s), north_m, east_m, std_m)
        return self._number(0, track_id)

    def drop(self, track_id: int, *, hush: bool = False) -> bool:
        """End a track; False if there is none with that number."""
        tracker, number = self._tracker_of(track_id)
        return tracker.drop(number, hush=hush)

    def rename(self, track_id: int, name: str) -> bool:
        """Name a track; False if there is none with that number."""
        tracker, number = self._tracker_of(track_id)
        return tracker.rename(number, name)

    def report(self, **report: Any) -> list[dict[str, Any]]:
        """Take a position report with an identity; the events of tracks."""
        return []
