"""Tracks smoothed after the fact: each state also uses the plots after it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import wakeline as wl
from wakeline._checks import in_a_row
from wakeline.recording import Tracks

from .encounters import watch_tracks
from .settings import Settings
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
    sensor = wl.ConvertedRangeBearing(
        range_std_m=radar.range_std_m,
        bearing_std_rad=radar.bearing_std_rad,
        extent_std_m=radar.extent_std_m,
    )
    tracks = tracked.tracks
    rows = tracks if time_s is None else _rows_at(tracks, in_a_row("time_s", time_s), ahead_s)
    state, covariance = rows.state.copy(), rows.covariance.copy()
    modes = rows.mode_probability.copy()
    for track_id in rows.ids():
        known, wanted = tracks[track_id], rows.track_id == track_id
        plots = _plots_of(tracked, int(track_id)).near(known, radar)
        found = _smoothed(estimator, sensor, known, plots, rows.time_s[wanted])
        state[wanted], covariance[wanted], modes[wanted] = found
    smoothed = replace(rows, state=state, covariance=covariance, mode_probability=modes)
    own = tracked.episode.own if tracked.watches_own else None
    smoothed, encounters = watch_tracks(
        smoothed, own, settings.danger_limits, settings.danger_zones
    )
    return replace(tracked, tracks=smoothed, encounters=encounters)


@dataclass(frozen=True)
class _Plots:
    """The plots of one track: times (n,), range and bearing (n, 2), own ship (n, 2)."""

    time_s: np.ndarray
    range_bearing: np.ndarray
    own_m: np.ndarray

    def where(self, chosen: np.ndarray) -> _Plots:
        return _Plots(self.time_s[chosen], self.range_bearing[chosen], self.own_m[chosen])

    def near(self, track: Tracks, radar: wl.Radar) -> _Plots:
        """The plots after the first row of the track that are no outliers."""
        after = np.searchsorted(track.time_s, self.time_s)
        before = np.maximum(after - 1, 0)
        after = np.minimum(after, len(track) - 1)
        is_after = track.time_s[after] - self.time_s < self.time_s - track.time_s[before]
        row = np.where(is_after, after, before)
        ahead_s = (self.time_s - track.time_s[row])[:, np.newaxis]
        expected_m = track.state[row][:, 0::2] + ahead_s * track.state[row][:, 1::2]
        range_m, bearing_rad = self.range_bearing.T
        along = np.column_stack([np.cos(bearing_rad), np.sin(bearing_rad)])
        across = np.column_stack([-along[:, 1], along[:, 0]])
        error_m = self.own_m + range_m[:, np.newaxis] * along - expected_m
        covariance = track.covariance[row][:, 0::2, 0::2] + radar.extent_std_m**2 * np.eye(2)
        for axis, std_m in (
            (along, np.full(len(row), radar.range_std_m)),
            (across, range_m * radar.bearing_std_rad),
        ):
            axis = std_m[:, np.newaxis] * axis
            covariance += axis[:, :, np.newaxis] * axis[:, np.newaxis, :]
        distance = np.linalg.solve(covariance, error_m[:, :, np.newaxis])[:, :, 0]
        inside = np.sum(error_m * distance, axis=1) < wl.chi_square_quantile(_OWN_PLOTS, 2)
        return self.where(inside & (self.time_s > track.time_s[0]))


def _plots_of(tracked: TrackedEpisode, track_id: int) -> _Plots:
    times, readings, own = [np.zeros(0)], [np.zeros((0, 2))], [np.zeros((0, 2))]
    for scan, ids in zip(tracked.episode.scans, tracked.plot_track_id, strict=True):
        mine = np.asarray(ids) == track_id
        times.append(scan.plot_time_s[mine])
        readings.append(scan.range_bearing[mine])
        own.append(np.column_stack([scan.own_north_m, scan.own_east_m])[mine])
    plots = _Plots(np.concatenate(times), np.vstack(readings), np.vstack(own))
    return plots.where(np.argsort(plots.time_s, kind="stable"))


def _smoothed(
    estimator: wl.Imm,
    sensor: wl.ConvertedRangeBearing,
    track: Tracks,
    plots: _Plots,
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
