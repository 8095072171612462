"""A recording through the tracker: tracks, events, encounters, and the track of each plot."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import wakeline as wl
from wakeline._progress import progress
from wakeline.recording import Episode, OwnShipMotion, Recording, Scan, Tracks

from .encounters import Encounter, watch_tracks
from .opening import open_recording
from .settings import Settings, read_settings

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MODE_NAMES = (
    *("cruising", "steady", "restless", "turning"),
    *("weaving", "port_turn", "starboard_turn"),
)
"""The motion models of `wakeline.VesselModels`, in the order of their probabilities."""
_COLUMNS = ("track_id", "status", "time_s", "mean", "covariance", "mode_probability", "nis")


@dataclass(frozen=True)
class TrackedEpisode:
    """Result of tracking an episode.

    Attributes
    ----------
    episode : Episode
        With the offsets of the radar removed from its plots.
    tracks : Tracks
        One row per displayed track and scan, at the time of the scan: predicted to it, or moved
        back to it from a later plot of the scan.
    events : list of wakeline.Event
    plot_track_id : list of ndarray of int
        For each scan the track of each plot: 0 none, negative a tentative one.
    rejected_plots : int
        Number of plots that the tracker rejected.
    elapsed_s : float
        Time that the tracker needed.
    encounters : list of Encounter
        Dangerous encounters of any two vessels, in order of start.
    watches_own : bool
        Whether own ship was one of them: it was requested, and its velocity is known.
    strobes_m : ndarray (n, 3) or None
        North, east and radius of the strobes of the last revolution; None without strobes.
    """

    episode: Episode
    tracks: Tracks
    events: list[wl.Event]
    plot_track_id: list[np.ndarray]
    rejected_plots: int
    elapsed_s: float
    encounters: list[Encounter] = field(default_factory=list)
    watches_own: bool = False
    strobes_m: np.ndarray | None = None

    @property
    def alarms(self) -> list[Encounter] | None:
        """The encounters with own ship, None if it was not watched."""
        return [one for one in self.encounters if one.with_own_ship] if self.watches_own else None


@dataclass(frozen=True, kw_only=True, repr=False)
class TrackedRecording(Tracks):
    """The tracks of a recording: a table of all rows, with events and encounters by episode.

    Attributes
    ----------
    recording : Recording
        As tracked, with the offsets of the radar removed from its plots.
    episodes : list of TrackedEpisode
        One for each episode of the recording.
    settings : Settings
        With which the recording was tracked.
    """

    recording: Recording
    episodes: list[TrackedEpisode]
    settings: Settings

    @classmethod
    def of(
        cls, recording: Recording, episodes: Sequence[TrackedEpisode], settings: Settings
    ) -> TrackedRecording:
        """Join the tracked episodes of a recording."""
        return cls(
            **vars(Tracks.joined([tracked.tracks for tracked in episodes])),
            recording=replace(recording, episodes=[tracked.episode for tracked in episodes]),
            episodes=list(episodes),
            settings=settings,
        )

    def smooth(
        self, time_s: np.ndarray | Sequence[float] | None = None, *, ahead_s: float = 0.0
    ) -> TrackedRecording:
        """The tracks with each state also estimated from the plots after it.

        A track begins with its first row as tracked; from there on the estimator of the tracker is
        smoothed over the plots that most probably belong to the track. Events, plots and their
        tracks remain, encounters are those of the smoothed tracks.

        Parameters
        ----------
        time_s : array_like (T,), optional
            Times of the rows, for each track from its first row on: also between scans; default the
            times of the rows as tracked.
        ahead_s : float
            How long after its last row a track is predicted, where `time_s` has such times.

        Raises
        ------
        FilterError
            When a track cannot be smoothed.

        Examples
        --------
        >>> import numpy as np, wakeline as wl
        >>> tracks = wl.track_recording("joyride")
        >>> smoothed = tracks.smooth()
        >>> each_second = tracks.smooth(np.arange(0.0, 60.0) + tracks.time_s[0])
        >>> len(each_second)
        60
        """
        from .smoothing import smooth_episode

        parts = [
            smooth_episode(part, self.settings, time_s=time_s, ahead_s=ahead_s)
            for part in self.episodes
        ]
        return TrackedRecording.of(self.recording, parts, self.settings)

    def plot(self, recording: Recording | Episode | None = None, **options: Any) -> Figure:
        """The tracks on a map with the plots and own ship of their recording."""
        return super().plot(self.recording if recording is None else recording, **options)

    @property
    def encounters(self) -> list[Encounter]:
        """The dangerous encounters of all episodes, in their order."""
        return [one for tracked in self.episodes for one in tracked.encounters]

    @property
    def alarms(self) -> list[Encounter]:
        """Those with own ship."""
        return [alarm for tracked in self.episodes for alarm in tracked.alarms or ()]


def track_recording(
    recording: Recording | str | Path,
    *,
    radar: wl.Radar | str | Path | None = None,
    vessels: wl.VesselModels | str | None = None,
    own: OwnShipMotion | str | Path | None = None,
    config: Settings | wl.TrackerConfig | str | Path | None = None,
    azimuth: str = "north",
) -> TrackedRecording:
    """Track a recording: plots in, tracks out.

    Each episode is tracked by a fresh :class:`wakeline.Tracker`.

    Parameters
    ----------
    recording : Recording, str or Path
        A recording, the name of a bundled one (``wakeline.recording.names()``), or a file: plots as
        CSV (:func:`wakeline.recording.read_plots`) or radar video in ASTERIX category 240
        (:func:`wakeline.extraction.read_plots_of_video`).
    radar : Radar, str or Path, optional
        Radar parameters, the name of a bundled radar (``wakeline.recording.radar_names()``), or a
        TOML file with keys of ``[radar]``. Default: those of `config`, else what the recording
        knows of its radar, else the defaults of :class:`wakeline.Radar`.
    vessels : VesselModels or str, optional
        Motion models, or "any" (default) or "ships" (merchant ships under way).
    own : OwnShipMotion, str or Path, optional
        Own ship, or its file. With it each row has the closest approach to own ship, and own ship
        is one of the vessels whose encounters are in the result. For a recording in a file it must
        be a file, and the radar is there.
    config : Settings, TrackerConfig, str or Path, optional
        All settings, parameters of the tracker, or a TOML file in the form that
        ``wakeline track --print-config`` prints.
    azimuth : str
        Origin of the azimuths in a file: "north", or "bow" with own ship's heading in `own`.

    Returns
    -------
    TrackedRecording
        A table of tracks (:class:`wakeline.recording.Tracks`) with events, encounters and the
        tracks of plots beside it.

    Raises
    ------
    RecordingError
        When a file of plots, video or own ship cannot be read.
    SettingsError
        When settings cannot be used.

    Examples
    --------
    >>> import wakeline as wl
    >>> recording = wl.recording.load("joyride")
    >>> tracks = wl.track_recording(recording)
    >>> picture = wl.plot.map(tracks, recording)  # doctest: +SKIP
    >>> wl.plot.save(picture, "joyride.png")  # doctest: +SKIP
    >>> tracks.ids()
    ['1']
    """
    opened, settings = opened_with_settings(recording, radar, vessels, own, config, azimuth)
    watched, named = own is not None, has_names(opened)
    tracked = [
        track_episode(episode, settings, own=episode.own if watched else None, named=named)
        for episode in opened
    ]
    return TrackedRecording.of(opened, tracked, settings)


def opened_with_settings(
    recording: Recording | str | Path,
    radar: wl.Radar | str | Path | None,
    vessels: wl.VesselModels | str | None,
    own: OwnShipMotion | str | Path | None,
    config: Settings | wl.TrackerConfig | str | Path | None,
    azimuth: str,
) -> tuple[Recording, Settings]:
    """The recording and the settings of :func:`track_recording`."""
    settings = read_settings(config, radar, vessels)
    opened = open_recording(
        recording,
        own,
        period_s=settings.period_s,
        azimuth=azimuth,
        min_range_m=settings.radar["min_range_m"],
    )
    if not isinstance(radar, wl.Radar):
        settings = settings.knowing(opened.radar)
    return opened, settings


def track_episode(
    episode: Episode,
    settings: Settings | None = None,
    *,
    own: OwnShipMotion | None = None,
    named: bool = False,
) -> TrackedEpisode:
    """Track one episode with a fresh tracker.

    Parameters
    ----------
    episode : Episode
    settings : Settings, optional
    own : OwnShipMotion, optional
        Own ship for closest approaches and encounters, if its velocity is known; usually
        ``episode.own``.
    named : bool
        Whether the tracks carry the name of the episode as their scenario.
    """
    settings = settings or Settings.default()
    tracker = settings.make_tracker(median_step_s(episode))
    tables, events, plot_track_id, rejected = [columns_of(tracker.tracks())], [], [], 0
    end_s, began_s = -np.inf, time.perf_counter()
    for scan in progress(episode.scans, len(episode), f"tracking {episode.name}".strip()):
        end_s = max(end_s, scan.time_s, scan.plot_time_s.max(initial=-np.inf))
        while end_s > tracker.latest_time_s:  # the radar was silent
            silence = tracker.process(tracker.latest_time_s, range_m=[], bearing_rad=[])
            events += silence.events
        report = _process(tracker, end_s, scan)
        tables.append(columns_of(tracker.tracks(time_s=scan.time_s)))
        events += report.events
        plot_track_id.append(report.plot_track_id)
        rejected += report.rejected_plots
    elapsed_s = time.perf_counter() - began_s
    return tracked_episode(
        episode,
        settings,
        tables,
        events=events,
        plot_track_id=plot_track_id,
        rejected_plots=rejected,
        elapsed_s=elapsed_s,
        own=own,
        named=named,
    )


def tracked_episode(
    episode: Episode,
    settings: Settings,
    tables: Sequence[dict[str, np.ndarray]],
    *,
    events: list[wl.Event],
    plot_track_id: list[np.ndarray],
    rejected_plots: int = 0,
    elapsed_s: float = 0.0,
    own: OwnShipMotion | None = None,
    named: bool = False,
) -> TrackedEpisode:
    """The result of an episode from the columns of its tracks at each scan."""
    if own is not None and not own.knows_velocity:
        own = None
    tracks = _joined(tables, episode.name if named else None)
    tracks, encounters = watch_tracks(tracks, own, settings.danger_limits, settings.danger_zones)
    shown = _without_offsets(episode, settings.make_radar())
    return TrackedEpisode(
        shown, tracks, events, plot_track_id, rejected_plots, elapsed_s, encounters, own is not None
    )


def median_step_s(episode: Episode) -> float | None:
    """Median time between scans, None with fewer than two."""
    return float(np.median(np.diff(episode.time_s))) if len(episode) > 1 else None


def has_names(recording: Recording) -> bool:
    """Whether the episodes of a recording have names."""
    return any(episode.name for episode in recording)


def _without_offsets(episode: Episode, radar: wl.Radar) -> Episode:
    """The episode with the radar's offsets removed from its plots."""
    offsets = radar.range_offset_m, radar.bearing_offset_rad, radar.time_offset_s
    if offsets == (0.0, 0.0, 0.0):
        return episode
    return replace(episode, scans=[scan.without_offsets(*offsets) for scan in episode.scans])


def _process(tracker: wl.Tracker, end_s: float, scan: Scan) -> wl.track.ScanReport:
    """Process one scan; it ends at its last plot, whatever its time is."""
    return tracker.process(
        end_s,
        range_m=scan.range_m,
        bearing_rad=scan.bearing_rad,
        plot_time_s=scan.plot_time_s,
        own_north_m=scan.own_north_m,
        own_east_m=scan.own_east_m,
    )


def columns_of(table: wl.track.TrackTable | wl.track.StrobeTrackTable) -> dict[str, np.ndarray]:
    """The columns of a table of tracks as arrays."""
    return {name: np.asarray(getattr(table, name)) for name in _COLUMNS}


def _joined(tables: Sequence[dict[str, np.ndarray]], scenario: str | None) -> Tracks:
    """Columns of tracks as the rows of one table."""
    column = {name: np.concatenate([table[name] for table in tables]) for name in _COLUMNS}
    return Tracks(
        track_id=column["track_id"].astype(str),
        time_s=column["time_s"],
        state=column["mean"],
        covariance=column["covariance"],
        mode_probability=column["mode_probability"],
        status=column["status"].astype(str),
        nis=column["nis"],
        scenario=None if scenario is None else np.full(len(column["time_s"]), scenario),
    )
