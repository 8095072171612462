"""Of radar video `wakeline track` takes the errors of its plots, and draws the screen."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

import wakeline as wl
from wakeline import plot
from wakeline.extraction import VideoRecording
from wakeline.recording import Tracks

from .config import Settings
from .tracking import TrackedEpisode

_STROBE = 0.99  # probability that the target's plot lies in the strobe that is drawn


def told_to(settings: Settings, video: VideoRecording) -> Settings | None:
    """The settings with the errors of its plots for the radar; None where they tell others."""
    default = Settings.default().radar
    if any(settings.radar[key] != default[key] for key in ("range_std_m", "bearing_std_deg")):
        return None
    range_std_m, bearing_std_rad = video.plot_std
    radar = settings.radar | {
        "range_std_m": range_std_m,
        "bearing_std_deg": float(np.degrees(bearing_std_rad)),
    }
    return replace(settings, radar=radar)


def draw_ppi(
    folder: Path, video: VideoRecording, part: TrackedEpisode, bearing_offset_rad: float
) -> Path:
    """Write ``ppi.png``: the last turn, its plots, strobes around the tracks, and the tracks.

    All as seen from own ship, tracks from where she is at the end of the turn; the offset is taken
    off what the radar reads.
    """
    scan = part.episode.scans[-1]
    tracks = _seen_from(part.episode.own.position_at(scan.time_s)[0], part.tracks)
    last = tracks.time_s == scan.time_s
    strobes = [
        _strobe(video, state[[0, 2]], covariance[np.ix_([0, 2], [0, 2])])
        for state, covariance in zip(tracks.state[last], tracks.covariance[last], strict=True)
    ]
    figure = plot.figure(8.6, 8.6)
    range_m, bearing_rad = scan.range_bearing.T
    plot.ppi(
        replace(video.last, azimuth_rad=video.last.azimuth_rad - bearing_offset_rad),
        figure.add_subplot(),
        plots=range_m[:, None] * np.column_stack([np.cos(bearing_rad), np.sin(bearing_rad)]),
        strobes=strobes,
        tracks=tracks,
    )
    file = folder / "ppi.png"
    plot.save(figure, file)
    return file


def _seen_from(place_m: np.ndarray, tracks: Tracks) -> Tracks:
    """The tracks with positions about a place (2,), north and east."""
    return replace(tracks, state=tracks.state - [place_m[0], 0.0, place_m[1], 0.0])


def _strobe(video: VideoRecording, place_m: np.ndarray, covariance_m2: np.ndarray) -> np.ndarray:
    """Outline of where the next plot of a track lies with the probability of the gate."""
    range_std_m, bearing_std_rad = video.plot_std
    sensor = wl.ConvertedRangeBearing(range_std_m=range_std_m, bearing_std_rad=bearing_std_rad)
    polar = [np.hypot(*place_m), np.arctan2(place_m[1], place_m[0])]
    plot_m2 = wl.one_point(sensor, polar, 1.0).covariance[np.ix_([0, 2], [0, 2])]
    threshold = wl.ChiSquareGate(probability=_STROBE).threshold(2)
    return plot.ellipse_outline(place_m, covariance_m2 + plot_m2, threshold)
