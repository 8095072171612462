"""Radar video through the strobe tracker: tracks, and what was measured in the strobes."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

import wakeline as wl
from wakeline._brief import counted
from wakeline.extraction import VideoRecording, noise_of, read_plots_of_video
from wakeline.extraction.film import days_s, radar_of
from wakeline.extraction.plots import Plots, sense
from wakeline.extraction.settings import Kind, settings_for, threshold_above
from wakeline.extraction.turns import Turn
from wakeline.recording import Episode, OwnShipMotion, RadarVideo, RecordingError
from wakeline.recording.azimuths import check_azimuth, headings_at
from wakeline.recording.own_csv import OwnRows, read_own_track
from wakeline.recording.table import TIME_NAMES, Table, finding_columns

from .settings import Settings
from .tracked import TrackedEpisode, columns_of, tracked_episode

_PIECE = 64  # sweeps between two acquisitions
_CELL_FALSE_ALARMS = 1e-3  # of a cell in a strobe
_AROUND_ECHO = 1.5  # radius of a strobe over half the length of a long echo
_RADIUS_M = (20.0, 300.0)
_GROWN = 3.0  # largest over usual radius
_POSITION_STD_M = 20.0
_DESIGNATIONS = {
    "time_s": TIME_NAMES,
    "north_m": ("north_m",),
    "east_m": ("east_m",),
    "position_std_m": ("position_std_m",),
}


class Designation(NamedTuple):
    """A vessel as an operator points at it."""

    time_s: float
    north_m: float
    east_m: float
    position_std_m: float = _POSITION_STD_M


def read_designations(path: str | Path) -> list[Designation]:
    """Read designations from CSV, in the order of time.

    Columns: a time, ``north_m``, ``east_m`` and, optional, ``position_std_m`` (20 m).

    Raises
    ------
    RecordingError
        When the file cannot be read, a number is not finite or a standard deviation not positive.
    """
    table = Table(path, _DESIGNATIONS)
    table.require("time_s", "north_m", "east_m")
    columns = [table.times("time_s"), table.ways_m("north_m"), table.ways_m("east_m")]
    for name, values in zip(("north_m", "east_m"), columns[1:], strict=True):
        table.check(name, np.isfinite(values), "a number of metres")
    if "position_std_m" in table:
        columns.append(table.ways_m("position_std_m"))
        table.check("position_std_m", columns[-1] > 0.0, "a positive number of metres")
    return sorted(Designation(*map(float, row)) for row in zip(*columns, strict=True))


@finding_columns
def follow_video(
    path: str | Path,
    settings: Settings | None = None,
    *,
    own: str | Path | None = None,
    acquire: str | Path | None = None,
    azimuth: str = "north",
    range_scale_m: float | None = None,
    columns: Mapping[str, str] | None = None,
) -> tuple[VideoRecording, Callable[..., TrackedEpisode]]:
    """Follow the vessels on radar video with a :class:`wakeline.StrobeTracker`.

    Parameters
    ----------
    path : str or Path
        Radar video in ASTERIX category 240; the antenna turns clockwise.
    settings : Settings, optional
        Where the errors of the radar, the radius of strobes and the least amplitude are those by
        default, they are estimated from the first revolution.
    own : str or Path, optional
        File of own ship, which carries the radar; default: at the origin.
    acquire : str or Path, optional
        File of designations (:func:`read_designations`). Default: vessels are acquired from
        extracted plots.
    azimuth, range_scale_m, columns
        As of :func:`wakeline.extraction.read_plots_of_video`.

    Returns
    -------
    recording : VideoRecording
        Its plots are what was measured in the strobes.
    track : callable
        Gives the tracks of one of its episodes; arguments as of :func:`track_episode`.

    Raises
    ------
    RecordingError
        When a file cannot be read, or the antenna turns anticlockwise.
    """
    settings = settings or Settings.default()
    rows = None if own is None else read_own_track(own, [], columns)
    wanted = None if acquire is None else read_designations(acquire)
    check_azimuth(azimuth, own)
    follower = _Follower(Path(path), settings, rows, wanted, own if azimuth == "bow" else None)
    film = read_plots_of_video(
        path,
        own,
        period_s=settings.period_s,
        azimuth=azimuth,
        range_scale_m=range_scale_m,
        columns=columns,
        extraction=follower,
    )
    film = replace(film, radar=follower.radar)
    parts = {id(e): part for e, part in zip(film.episodes, follower.parts, strict=True)}

    def track(
        episode: Episode, settings: Settings, *, own: OwnShipMotion | None, named: bool
    ) -> TrackedEpisode:
        return parts[id(episode)].tracked(episode, settings, own, named)

    return film, track


@dataclass
class _Part:
    """What was found between two resets of the clock."""

    tables: list[dict[str, np.ndarray]] = field(default_factory=list)
    events: list[wl.Event] = field(default_factory=list)
    plot_track_id: list[np.ndarray] = field(default_factory=list)
    strobes_m: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    elapsed_s: float = 0.0

    def tracked(
        self, episode: Episode, settings: Settings, own: OwnShipMotion | None, named: bool
    ) -> TrackedEpisode:
        tracked = tracked_episode(
            episode,
            settings,
            self.tables,
            events=self.events,
            plot_track_id=self.plot_track_id,
            elapsed_s=self.elapsed_s,
            own=own,
            named=named,
        )
        return replace(tracked, strobes_m=self.strobes_m)


class _Follower:
    """What is measured in strobes, revolution by revolution, in the form of an `Extraction`."""

    def __init__(
        self,
        path: Path,
        settings: Settings,
        own: OwnRows | None,
        designations: list[Designation] | None,
        heading: str | Path | None,
    ) -> None:
        self.parts: list[_Part] = []
        self.radar: dict[str, float] = {}
        self._path = path
        self._settings = settings
        self._own_rows, self._own = own, None if own is None else own.ship()
        self._heading = heading  # own ship's file where azimuths count from the bow
        self._days_s = 0.0
        self._acquires = designations is None
        self._waiting = deque(designations or ())
        self._left_out = 0
        self._flags = dict.fromkeys(("touches_edge", "fills", "shared"), 0)
        self._tracker: wl.StrobeTracker | None = None
        self._extractor: wl.PlotExtractor | None = None
        self._kind: Kind | None = None
        self._part: _Part | None = None

    def plots_of(self, turn: Turn) -> Plots:
        """The echoes measured in a revolution."""
        began_s = time.perf_counter()
        if self._tracker is None:
            self._begin(turn)
        found: list[wl.track.StrobeReadings] = []
        for block in turn.blocks:
            if sense(block) < 0.0:
                raise RecordingError(
                    self._path,
                    "the antenna turns anticlockwise",
                    wanted="a clockwise one for strobes; plots are extracted from either",
                )
            for piece in self._pieces(block):
                found.append(self._follow(piece))
        plots, ids = self._measured(found)
        part = self._part
        end_s = turn.end_s + self._days_s
        part.tables.append(columns_of(self._tracker.tracks(time_s=end_s)))
        part.events += [event for readings in found for event in readings.events]
        part.plot_track_id.append(ids)
        part.strobes_m = np.concatenate(
            [np.column_stack([r.predicted_m, r.radius_m])[r.track_id > 0] for r in found]
        )
        part.elapsed_s += time.perf_counter() - began_s
        return plots

    def finished(self) -> Plots:
        """End the part: what follows is tracked afresh."""
        self._tracker = self._extractor = self._kind = self._part = None
        return _NOTHING

    def notes(self) -> list[str]:
        """Notes for the user."""
        wanted = {
            "touches_edge": "[echo extends|echoes extend] beyond the strobe",
            "fills": "[echo fills|echoes fill] the strobe",
            "shared": "[echo is|echoes are] shared with another strobe",
        }
        notes = [counted(n, wanted[name]) for name, n in self._flags.items() if n]
        if self._left_out:
            notes.append(counted(self._left_out, "invalid [sweep|sweeps] left out"))
        if self._waiting:
            late = "[designation is|designations are] after the end of the video"
            notes.append(counted(len(self._waiting), late))
        return notes

    def _begin(self, turn: Turn) -> None:
        """A new tracker; what the settings leave open comes from the first revolution."""
        if not self.parts and self._own_rows is not None:
            self._days_s = days_s(self._own_rows, turn.begin_s)
        video = turn.longest
        extraction, above_db = settings_for(video, Kind.of(video))
        extractor = wl.PlotExtractor(**extraction)
        seen, open_ones = extractor.process(video), extractor.finish()
        joined = {
            name: np.concatenate([getattr(seen, name), getattr(open_ones, name)])
            for name in ("range_m", "range_extent_m", "bearing_extent_rad", "covariance")
        }
        if not self.radar:
            variance = np.diagonal(joined["covariance"], axis1=1, axis2=2)
            self.radar = radar_of(variance, video)
        length_m = np.hypot(
            joined["range_extent_m"], joined["range_m"] * joined["bearing_extent_rad"]
        )
        half_m = float(np.quantile(length_m, 0.9)) / 2.0 if len(length_m) else 0.0
        radius_m = float(np.clip(_AROUND_ECHO * half_m, *_RADIUS_M))
        sweeps = max(map(len, turn.blocks))
        self._tracker = self._settings.knowing(self.radar).make_strobe_tracker(
            period_s=2 * math.pi * (turn.end_s - turn.begin_s) / max(turn.covered_rad, 0.1),
            bits=8 * video.amplitude.itemsize,
            radius_m=radius_m,
            max_radius_m=_GROWN * radius_m,
            least_amplitude=threshold_above(
                noise_of(video.amplitude), _CELL_FALSE_ALARMS, above_db
            ),
            max_sweep_cells=max(4096, *(block.amplitude.shape[1] for block in turn.blocks)),
            max_strobe_sweeps=max(1024, sweeps // 4),
        )
        self._part = _Part([columns_of(self._tracker.tracks())])
        self.parts.append(self._part)

    def _pieces(self, block: RadarVideo) -> Iterator[RadarVideo]:
        time_s = block.time_s + self._days_s
        north_rad = block.azimuth_rad + self._heading_rad(time_s)
        block = replace(block, time_s=time_s, azimuth_rad=north_rad)
        kind = Kind.of(block)
        if self._acquires and (self._kind is None or not kind.fits(self._kind)):
            self._extractor = wl.PlotExtractor(**settings_for(block, kind)[0])
            self._kind = kind
        for first in range(0, len(block), _PIECE):
            yield block[first : first + _PIECE]

    def _follow(self, piece: RadarVideo) -> wl.track.StrobeReadings:
        begin_s = float(piece.time_s[0])
        while self._waiting and self._waiting[0].time_s <= begin_s:
            wanted = self._waiting.popleft()
            self._tracker.designate(*wanted, **self._own_at(np.array([wanted.time_s]), one=True))
        readings = self._tracker.process(piece, **self._own_at(piece.time_s))
        self._left_out += readings.rejected_sweeps
        if self._acquires:
            plots = self._extractor.process(piece)
            self._tracker.acquire(plots, **self._own_at(plots.time_s))
        return readings

    def _heading_rad(self, time_s: np.ndarray) -> np.ndarray | float:
        """Where azimuths count from."""
        if self._heading is None:
            return 0.0
        return headings_at(self._own, time_s, self._heading)

    def _own_at(self, time_s: np.ndarray, *, one: bool = False) -> dict:
        if self._own is None:
            return {}
        north_m, east_m = self._own.position_at(time_s).T
        if one:
            return {"own_north_m": float(north_m[0]), "own_east_m": float(east_m[0])}
        return {"own_north_m": north_m, "own_east_m": east_m}

    def _measured(self, found: list[wl.track.StrobeReadings]) -> tuple[Plots, np.ndarray]:
        """The echoes in the order of time, and the tracks that measured them."""
        columns = {
            name: np.concatenate([getattr(readings, name) for readings in found])
            for name in ("track_id", "time_s", "range_m", "bearing_rad", "covariance", *self._flags)
        }
        seen = np.flatnonzero(np.isfinite(columns["range_m"]))
        seen = seen[np.argsort(columns["time_s"][seen], kind="stable")]
        columns = {name: values[seen] for name, values in columns.items()}
        for name in self._flags:
            self._flags[name] += int(columns[name].sum())
        variance = np.diagonal(columns["covariance"], axis1=1, axis2=2)
        bearing_rad = columns["bearing_rad"] - self._heading_rad(columns["time_s"])
        plots = Plots(columns["time_s"] - self._days_s, columns["range_m"], bearing_rad, variance)
        return plots, columns["track_id"]


_NOTHING = Plots(np.zeros(0), np.zeros(0), np.zeros(0), np.zeros((0, 2)))
