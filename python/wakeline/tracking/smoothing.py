"""Tracks smoothed after the fact: each state also uses the plots after it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import wakeline as wl
from wakeline._checks import in_a_row
from wakeline.recording import Tracks

from .encounters import watch_tracks
from .settings import Settings
from .track_plots import TrackPlots, plot_sensor
from .tracked import TrackedEpisode, median_step_s

_OWN_PLOTS = 0.99  # share of a track's plots that are inside the gate about its estimate


def smooth_episode(
    tracked: TrackedEpisode,
    settings: Settings,
    *,
    time_s: np.ndarray | None = None,
    ahead_s: float = 0.0,
) -> TrackedEpisode:
    """The episode with its tracks smoothed, and its encounters those of the smoothed tracks.

    A track begins with its first row as tracked. The estimator of the tracker then takes the plots
    that most probably belong to the track, with the errors of the radar, and smooths them
    (:meth:`wakeline.Imm.smooth`). A plot outside the 99 % gate about the tracker's own estimate is
    an outlier and is left out.

    Parameters
    ----------
    tracked : TrackedEpisode
    settings : Settings
        With which it was tracked.
    time_s : array_like (T,), optional
        Times of the rows, in any order, for each track from its first row on; default the times of
        the rows as tracked.
    ahead_s : float
        How long after its last row a track is predicted, where `time_s` has such times.
    """
    radar = settings.make_radar(median_step_s(tracked.episode))
    estimator = settings.make_estimator(radar)
    sensor = plot_sensor(radar)
    tracks = tracked.tracks
    rows = tracks if time_s is None else _rows_at(tracks, in_a_row("time_s", time_s), ahead_s)
    state, covariance = rows.state.copy(), rows.covariance.copy()
    modes = rows.mode_probability.copy()
    plots = TrackPlots.of(tracked)
    for track_id in rows.ids():
        known, wanted = tracks[track_id], rows.track_id == track_id
        near = plots[track_id].near(known, radar, _OWN_PLOTS)
        found = _smoothed(estimator, sensor, known, near, rows.time_s[wanted])
        state[wanted], covariance[wanted], modes[wanted] = found
    smoothed = replace(rows, state=state, covariance=covariance, mode_probability=modes)
    own = tracked.episode.own if tracked.watches_own else None
    smoothed, encounters = watch_tracks(
        smoothed, own, settings.danger_limits, settings.danger_zones
    )
    return replace(tracked, tracks=smoothed, encounters=encounters)


def _smoothed(
    estimator: wl.Imm,
    sensor: wl.ConvertedRangeBearing,
    track: Tracks,
    plots: TrackPlots,
    time_s: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean, covariance and mode probability at some times, which are readings that are missing."""
    missing = np.full((len(time_s), 2), np.nan)
    when_s = np.concatenate([plots.time_s, time_s])
    order = np.argsort(when_s, kind="stable")
    result = estimator.smooth(
        np.vstack([plots.range_bearing, missing])[order],
        dt_s=np.diff(when_s[order], prepend=track.time_s[0]),
        sensor=sensor,
        start=wl.Gaussian(track.state[0], track.covariance[0]),
        own_position_m=np.vstack([plots.own_m, np.zeros_like(missing)])[order],
    )
    at = np.argsort(order)[len(plots.time_s) :]
    return result.mean[at], result.covariance[at], result.mode_probability[at]


def _rows_at(tracks: Tracks, time_s: np.ndarray, ahead_s: float) -> Tracks:
    """For each time and track that is there, its row before the time, with this time."""
    time_s = np.sort(time_s)
    index, times, ended = [], [], []
    for track_id in tracks.ids():
        mine = np.flatnonzero(tracks.track_id == track_id)
        first_s, last_s = tracks.time_s[mine[[0, -1]]]
        mine_s = time_s[(time_s >= first_s) & (time_s <= last_s + ahead_s)]
        index.append(mine[np.searchsorted(tracks.time_s[mine], mine_s, side="right") - 1])
        times.append(mine_s)
        ended.append(mine_s > last_s)
    if not index:
        return tracks
    order = np.argsort(np.concatenate(times), kind="stable")
    rows = tracks.where(np.concatenate(index)[order])
    at_s = np.concatenate(times)[order]
    return replace(
        rows,
        time_s=at_s,
        status=np.where(np.concatenate(ended)[order], "coasting", rows.status),
        nis=np.where(at_s == rows.time_s, rows.nis, np.nan),
    )
