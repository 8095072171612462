"""The trackers of a session: sectors of radars and reports in, tracks out."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import wakeline as wl
from wakeline.measurement import OwnShip
from wakeline.tracking import MODE_NAMES
from wakeline.tracking.settings import Settings

_SILENT_TURNS = 2.5  # a sector that is a little late still comes before the miss
_SCANS = 2.5  # as large as a scan may be, of which the window has room for the plots
_SECTORS = 160  # of a turn, for which the window has room
_LEAST_INPUTS = 4000
_MOST_WATCHED = 2000  # plots whose NIS is kept
_WINDOW_S = 10.0  # of late data, at least: what clocks of sensors may be off, both ways


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
        """North of the origin, m."""
        return self.mean[0]

    @property
    def east_m(self) -> float:
        """East of the origin, m."""
        return self.mean[2]

    @property
    def speed_mps(self) -> float:
        """Speed over ground, m/s."""
        return math.hypot(self.mean[1], self.mean[3])

    @property
    def course_rad(self) -> float:
        """Course over ground, radians clockwise from north."""
        return math.atan2(self.mean[3], self.mean[1]) % (2.0 * math.pi)

    @property
    def mode(self) -> str:
        """The likeliest motion, such as "turning"; '' where the models have no names."""
        if len(self.mode_probability) != len(MODE_NAMES):
            return ""
        return MODE_NAMES[self.mode_probability.index(max(self.mode_probability))]


class TrackEngine:
    """The tracker of all radars of a session, which puts late data in their place.

    Parameters
    ----------
    radars : sequence of Radar
    settings : Settings
        Of tracker and motion models.
    window_s : float
        What is at most so late is put in its place; 0: two turns of the slowest radar, and at
        least 10 s.
    """

    def __init__(
        self, radars: Sequence[wl.Radar], settings: Settings, window_s: float = 0.0
    ) -> None:
        self.radars = list(radars)
        window_s = window_s or max(_WINDOW_S, 2.0 * max(one.period_s for one in radars))
        plots = int(_SCANS * settings.tracker["max_plots"])
        inputs = int(sum(_SECTORS * window_s / one.period_s for one in radars))
        self._tracker = settings.window_of(
            self.radars,
            window_s=window_s,
            max_inputs=max(inputs, _LEAST_INPUTS),
            max_plots=plots,
        )
        self._heard: set[int] = set()  # radars that have given a sector
        self._correct_s = self._heard_s = -math.inf
        self._late_s = 0.0
        self._late_reports = 0
        self._reported = False
        self._known = np.zeros(0, dtype=np.int64), np.zeros((0, 4))
        self._watched: deque[tuple[np.ndarray, np.ndarray]] = deque()
        self._watched_plots = 0

    @property
    def time_s(self) -> float:
        """The latest time of any sector; 0 before the first."""
        return self._tracker.time_s

    @property
    def late(self) -> dict[str, float]:
        """The window of late data, s, how many came late and too late, and corrections.

        Of those too late some are reports, such as of AIS, which are used as of now.
        """
        window = self._tracker
        return {
            "window_s": window.window_s,
            "late_inputs": window.late_inputs,
            "too_late_inputs": window.too_late_inputs,
            "too_late_reports": self._late_reports,
            "corrections": window.corrections,
        }

    def correct(self) -> list[dict[str, Any]]:
        """Put all late data in the picture; the events of tracks."""
        self._correct_s = self.time_s
        return _events(self._tracker.correct())

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
        events = list(self._catch_up(radar, time_s))
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
        self._heard.add(radar)
        return events + _events(report.events)

    def note_lateness(self, time_s: float, received_s: float) -> None:
        """Take note of how long after its time a sector has come; half of it after a minute."""
        passed_s = max(received_s - self._heard_s, 0.0)
        self._late_s = max(received_s - time_s, self._late_s * 0.5 ** (passed_s / 60.0))
        self._heard_s = received_s

    def coast(self, time_s: float) -> list[dict[str, Any]]:
        """Let time pass where all radars are silent for more than two periods.

        Where data come late, they are silent only when these would have come. A picture that has
        waited for a window is corrected.
        """
        events: list[dict[str, Any]] = []
        if self._tracker.is_correct:
            self._correct_s = self.time_s
        elif time_s - self._correct_s > self._tracker.window_s:
            events += self.correct()
        if not (self._heard or self._reported):
            return events
        fastest = min(sorted(self._heard) or [0], key=lambda k: self.radars[k].period_s)
        wait_s = _SILENT_TURNS * self.radars[fastest].period_s
        if self.time_s < time_s - wait_s - min(self._late_s, self._tracker.window_s):
            events += self._catch_up(fastest, time_s)
            events += self._pass(fastest, time_s)
        return events

    def _catch_up(self, radar: int, time_s: float) -> Iterator[dict[str, Any]]:
        """Steps of an hour over a longer silence."""
        while self.time_s > 0.0 and time_s > self._tracker.latest_time_s:
            yield from self._pass(radar, self._tracker.latest_time_s)

    def _pass(self, radar: int, time_s: float) -> list[dict[str, Any]]:
        report = self._tracker.sector(
            radar=radar, from_rad=0.0, to_rad=0.0, time_s=time_s, range_m=[], bearing_rad=[]
        )
        return _events(report.events)

    def set_period(self, radar: int, period_s: float, time_s: float | None = None) -> None:
        """Change the period of an antenna, at a time or now; all tracks are kept."""
        self.radars[radar] = wl.Radar(**self.radars[radar].as_dict() | {"period_s": period_s})
        self._tracker.set_radar(radar, self.radars[radar], time_s=time_s)

    def tracks(self, time_s: float | None = None) -> list[LiveTrack]:
        """All shown tracks, at a time or at that of the last sector."""
        return list(_rows(self.table(time_s)))

    def __len__(self) -> int:
        return len(self.table())

    def table(self, time_s: float | None = None) -> wl.track.TrackTable:
        """The same as columns."""
        return self._tracker.tracks(time_s=time_s, correct=False)

    def held(self) -> set[int]:
        """The tracks that are only held, as they have had no echo for long."""
        table = self._tracker.tracks(tentative=True, correct=False)
        names = zip(table.track_id.tolist(), table.status, strict=True)
        return {track_id for track_id, status in names if status == "held"}

    def updated(self) -> tuple[wl.track.TrackTable, np.ndarray, list[int]]:
        """The shown tracks, each as of its last update, and what the last call had not.

        These are the rows that were updated or corrected, and the numbers that are gone.
        """
        table = self._tracker.tracks(predicted=False, correct=False)
        ids = np.array(table.track_id)
        update = np.column_stack([table.nis, table.hits, table.misses, table.existence])
        known_ids, known = self._known
        same = np.zeros(update.shape, dtype=bool)
        if len(known_ids):
            place = np.searchsorted(known_ids, ids).clip(max=len(known_ids) - 1)
            same = (known[place] == update) | np.isnan(update)
            same &= (known_ids[place] == ids)[:, np.newaxis]
        rows = np.flatnonzero(~same.all(axis=1))
        plotted = np.flatnonzero(~same[:, 0] & np.isfinite(table.nis))
        self._watch_modes(table.nis[plotted], table.mode_probability[plotted])
        order = np.argsort(ids)
        self._known = ids[order], update[order]
        return table, rows, known_ids[~np.isin(known_ids, ids)].tolist()

    def _watch_modes(self, nis: np.ndarray, mode_probability: np.ndarray) -> None:
        """Keep the NIS of the latest plots with the modes of their tracks."""
        if len(nis):
            self._watched.append((nis, mode_probability))
            self._watched_plots += len(nis)
        while self._watched_plots > _MOST_WATCHED:
            self._watched_plots -= len(self._watched.popleft()[0])

    def modes(self) -> dict[str, dict[str, float]]:
        """Mean NIS of the latest plots while each mode was probable, with its bounds, by name."""
        if not self._watched:
            return {}
        nis, probability = map(np.concatenate, zip(*self._watched, strict=True))
        found = wl.metrics.nis_by_mode(nis, probability)
        names = MODE_NAMES if len(found.mean) == len(MODE_NAMES) else range(len(found.mean))
        rows = zip(found.mean.tolist(), found.lower.tolist(), found.upper.tolist(), strict=True)
        return {
            str(name): dict(zip(("mean_nis", "lower", "upper"), row, strict=True))
            for name, row in zip(names, rows, strict=True)
        }

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

    @property
    def heard(self) -> list[int]:
        """The radars that have given a sector."""
        return sorted(self._heard)

    def restore(self, state: bytes, heard: Iterable[int] | None = None) -> None:
        """Continue from a state; ValueError if it is that of another tracker."""
        self._tracker.restore(state)
        self._heard = set(range(len(self.radars)) if heard is None else heard)
        self._reported = True

    def report(self, **report: Any) -> tuple[list[dict[str, Any]], int]:
        """Take a position report with an identity.

        The arguments are those of ``Tracker.report``; velocities that are not finite are unknown.
        The events of tracks, and the number of the track that the vessel is believed to be where
        the report did not update it, else 0.
        """
        if not math.isfinite(report["vnorth_mps"] + report["veast_mps"]):
            report |= {"vnorth_mps": None, "veast_mps": None}
        self._reported = True
        before = self._tracker.too_late_inputs
        result = self._tracker.report(**report)
        self._late_reports += self._tracker.too_late_inputs - before
        return _events(result.events), result.track_id if result.status == wl.Status.gated else 0


def _rows(table: wl.track.TrackTable) -> Iterator[LiveTrack]:
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
        table.identity,
        table.identity_probability.tolist(),
        table.identity_time_s.tolist(),
        strict=True,
    )
    yield from (LiveTrack(*values) for values in columns)


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
