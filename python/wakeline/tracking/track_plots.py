"""The plots of tracks, and how a filter reads them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import wakeline as wl
from wakeline.recording import Tracks

from .tracked import TrackedEpisode


def plot_sensor(radar: wl.Radar) -> wl.ConvertedRangeBearing:
    """A sensor with the errors of the radar, for plots without its offsets."""
    return wl.ConvertedRangeBearing(
        range_std_m=radar.range_std_m,
        bearing_std_rad=radar.bearing_std_rad,
        extent_std_m=radar.extent_std_m,
    )


@dataclass(frozen=True)
class TrackPlots:
    """Plots of an episode or of one of its tracks, sorted by time.

    Attributes
    ----------
    track_id : ndarray (n,)
        The track to which each plot most probably belongs.
    time_s : ndarray (n,)
    range_bearing : ndarray (n, 2)
        Range in metres and bearing in radians.
    own_m : ndarray (n, 2)
        Own ship at the time of each plot, north and east.
    """

    track_id: np.ndarray
    time_s: np.ndarray
    range_bearing: np.ndarray
    own_m: np.ndarray

    @classmethod
    def of(cls, tracked: TrackedEpisode) -> TrackPlots:
        """The plots of an episode."""
        scans = tracked.episode.scans
        own = (np.column_stack([scan.own_north_m, scan.own_east_m]) for scan in scans)
        plots = cls(
            np.concatenate([np.zeros(0, dtype=int), *tracked.plot_track_id]),
            np.concatenate([np.zeros(0), *(scan.plot_time_s for scan in scans)]),
            np.vstack([np.zeros((0, 2)), *(scan.range_bearing for scan in scans)]),
            np.vstack([np.zeros((0, 2)), *own]),
        )
        return plots.where(np.argsort(plots.time_s, kind="stable"))

    def __len__(self) -> int:
        return len(self.time_s)

    def __getitem__(self, track_id: str | int) -> TrackPlots:
        """The plots of one track."""
        return self.where(self.track_id == int(track_id))

    def where(self, chosen: np.ndarray) -> TrackPlots:
        """The chosen plots, by mask or by index."""
        return TrackPlots(*(column[chosen] for column in vars(self).values()))

    @property
    def position_m(self) -> np.ndarray:
        """North and east, (n, 2)."""
        range_m, bearing_rad = self.range_bearing.T
        along = np.column_stack([np.cos(bearing_rad), np.sin(bearing_rad)])
        return self.own_m + range_m[:, np.newaxis] * along

    def covariance(self, radar: wl.Radar) -> np.ndarray:
        """Of the positions with the errors of a radar, (n, 2, 2)."""
        range_m, bearing_rad = self.range_bearing.T
        cos, sin = np.cos(bearing_rad), np.sin(bearing_rad)
        along_m = radar.range_std_m * np.column_stack([cos, sin])
        across_m = (radar.bearing_std_rad * range_m)[:, np.newaxis] * np.column_stack([-sin, cos])
        covariance = np.tile(radar.extent_std_m**2 * np.eye(2), (len(self), 1, 1))
        for error_m in (along_m, across_m):
            covariance += error_m[:, :, np.newaxis] * error_m[:, np.newaxis, :]
        return covariance

    def near(self, track: Tracks, radar: wl.Radar, probability: float) -> TrackPlots:
        """The plots after the first row of the track that are inside the gate about its rows.

        Parameters
        ----------
        track : Tracks
            The rows of the track, by time.
        radar : Radar
            For the errors of the plots.
        probability : float
            That a plot of the track is inside.
        """
        after = np.searchsorted(track.time_s, self.time_s)
        before = np.maximum(after - 1, 0)
        after = np.minimum(after, len(track) - 1)
        is_after = track.time_s[after] - self.time_s < self.time_s - track.time_s[before]
        row = np.where(is_after, after, before)
        ahead_s = (self.time_s - track.time_s[row])[:, np.newaxis]
        expected_m = track.state[row][:, 0::2] + ahead_s * track.state[row][:, 1::2]
        error_m = self.position_m - expected_m
        covariance = track.covariance[row][:, 0::2, 0::2] + self.covariance(radar)
        inside = wl.eval.nees(error_m, covariance) < wl.chi_square_quantile(probability, 2)
        return self.where(inside & (self.time_s > track.time_s[0]))
