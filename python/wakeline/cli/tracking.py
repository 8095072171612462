"""A recording through the tracker: tracks, events, and which plot went to which track."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

import wakeline as wl
from wakeline._progress import progress
from wakeline.recording import Episode, Recording, Scan, Tracks

from .config import Settings
from .danger import Danger, danger_of, with_closest_approach

MODE_NAMES = ("cruising", "steady", "restless", "turning")
_COLUMNS = ("track_id", "status", "time_s", "mean", "covariance", "mode_probability", "nis")


@dataclass(frozen=True)
class TrackedEpisode:
    """What tracking made of an episode.

    Attributes
    ----------
    episode : Episode
        With the offset of the radar taken off the bearings of its plots.
    tracks : Tracks
        One row a shown track and scan, at the time of the scan: predicted to it, or carried back
        from a later plot of the scan.
    events : list of wakeline.Event
    plot_track_id : list of ndarray of int
        For each scan the track of each plot: 0 none, negative a tentative one.
    refused_plots : int
        Plots that the tracker could not take.
    elapsed_s : float
        Time the tracker needed.
    danger : Danger or None
        Where own ship's motion is known and danger was asked for.
    """

    episode: Episode
    tracks: Tracks
    events: list[wl.Event]
    plot_track_id: list[np.ndarray]
    refused_plots: int
    elapsed_s: float
    danger: Danger | None = None


def track_episode(
    episode: Episode, settings: Settings, *, named: bool = False, danger: bool = False
) -> TrackedEpisode:
    """Track one episode with a fresh tracker.

    Parameters
    ----------
    episode : Episode
    settings : Settings
    named : bool
        Whether the tracks carry the name of the episode as their scenario.
    danger : bool
        Whether to look, where own ship's velocity is known, for tracks that come too close.
    """
    tracker = settings.tracker_of(median_step_s(episode))
    tables, events, plot_track_id, refused = [_columns(tracker.tracks())], [], [], 0
    end_s, began_s = -np.inf, time.perf_counter()
    for scan in progress(episode.scans, len(episode), f"tracking {episode.name}".strip()):
        end_s = max(end_s, scan.time_s, scan.plot_time_s.max(initial=-np.inf))
        report = _process(tracker, end_s, scan)
        tables.append(_at(scan.time_s, _columns(tracker.tracks(time_s=scan.time_s))))
        events += report.events
        plot_track_id.append(report.plot_track_id)
        refused += report.refused_plots
    elapsed_s = time.perf_counter() - began_s
    tracks = _joined(tables, episode.name if named else None)
    found = None
    if danger and episode.own.knows_velocity:
        tracks = with_closest_approach(tracks, episode.own, settings.danger_limits)
        found = danger_of(tracks, episode.own, settings.danger_limits)
    shown = _without_offset(episode, math.radians(settings.radar["bearing_offset_deg"]))
    return TrackedEpisode(shown, tracks, events, plot_track_id, refused, elapsed_s, found)


def median_step_s(episode: Episode) -> float | None:
    """Median step between scans, None where there are fewer than two."""
    return float(np.median(np.diff(episode.time_s))) if len(episode) > 1 else None


def has_names(recording: Recording) -> bool:
    """Whether the recording tells its episodes apart by name."""
    return any(episode.name for episode in recording)


def _without_offset(episode: Episode, bearing_offset_rad: float) -> Episode:
    """The episode with its plots where the tracker takes them to be."""
    if bearing_offset_rad == 0.0:
        return episode
    return replace(episode, scans=[scan.turned(-bearing_offset_rad) for scan in episode.scans])


def _process(tracker: wl.Tracker, end_s: float, scan: Scan):
    """One scan into the tracker; a scan ends with its last plot, wherever its own time lies."""
    return tracker.process(
        end_s,
        range_m=scan.range_m,
        bearing_rad=scan.bearing_rad,
        plot_time_s=scan.plot_time_s,
        own_north_m=scan.own_north_m,
        own_east_m=scan.own_east_m,
    )


def _columns(table: wl.track.TrackTable) -> dict[str, np.ndarray]:
    return {name: np.asarray(getattr(table, name)) for name in _COLUMNS}


def _at(time_s: float, column: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The columns of tracks at a time; those of a later one go straight back to it."""
    back_s = np.minimum(time_s - column["time_s"], 0.0)
    if not back_s.any():
        return column
    step = np.tile(np.eye(4), (len(back_s), 1, 1))
    step[:, 0, 1] = step[:, 2, 3] = back_s
    return column | {
        "time_s": np.minimum(column["time_s"], time_s),
        "mean": np.einsum("kij,kj->ki", step, column["mean"]),
        "covariance": step @ column["covariance"] @ step.swapaxes(1, 2),
    }


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
