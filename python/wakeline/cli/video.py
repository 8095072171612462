"""Radar video through the plot extractor, so that it can be tracked as any recording."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

import wakeline as wl
from wakeline import plot
from wakeline._progress import counted
from wakeline.recording import (
    Episode,
    RadarVideo,
    Recording,
    Scan,
    VideoReport,
    read_video,
)

from .config import Settings
from .tracking import TrackedEpisode

_FALSE_ALARMS = 1e-5
_TRAIN_M, _GUARD_M = 400.0, 150.0  # either side of a cell; ships are up to 300 m long
_MOST_TRAIN_CELLS = 128
_LOGARITHMIC_BELOW = 0.2  # skewness of noise: 0.63 behind a linear receiver, -1.1 in decibels
_RAYLEIGH_SPREAD_DB = 5.57  # standard deviation of noise in decibels
_WINDOW_CELLS = 32
_ABOVE_NOISE_DB = range(0, 40, 2)
_MOST_PLOTS = 150  # of a turn
_STROBE = 0.99  # probability that the target's plot lies in the strobe that is drawn
_WIDE_ECHO_RAD = np.deg2rad(20.0)
_LONG_ECHO_M = 800.0  # a land mass, as consoles have it


@dataclass(frozen=True)
class VideoRecording:
    """Plots of radar video, and the last turn of it.

    Attributes
    ----------
    recording : Recording
        One scan a turn.
    last : RadarVideo
    plot_std : (float, float)
        What the echoes say of the errors of plots: range in metres and bearing in radians.
    """

    recording: Recording
    last: RadarVideo
    plot_std: tuple[float, float]

    def told_to(self, settings: Settings) -> Settings:
        """The settings, with the errors of these plots as those of the radar."""
        range_std_m, bearing_std_rad = self.plot_std
        radar = settings.radar | {
            "range_std_m": range_std_m,
            "bearing_std_deg": float(np.degrees(bearing_std_rad)),
        }
        return replace(settings, radar=radar)


def read_plots_of_video(path: Path) -> VideoRecording:
    """Read radar video and take its echoes as plots, a turn of the antenna after the other.

    Raises
    ------
    RecordingError
        When the file holds no radar video.
    """
    report, notes = VideoReport(), []
    scans: list[Scan] = []
    variances: list[np.ndarray] = []
    for turn, plots in counted(_extracted(path, report, notes), "turns"):
        scans.append(_scan(len(scans), turn, plots))
        variances += [np.diagonal(part.covariance, axis1=1, axis2=2) for part in plots]
    least = np.array([turn.cell_m, turn.azimuth_width_rad]) ** 2 / 12.0
    variance = np.concatenate(variances)
    std = np.sqrt(np.maximum(np.median(variance, axis=0) if len(variance) else least, least))
    told = [f"the sender says: {text}" for text in report.summaries]
    recording = Recording(path.stem, [Episode("", scans)], notes=[*told, *report.notes, *notes])
    return VideoRecording(recording, turn, (float(std[0]), float(std[1])))


def draw_ppi(folder: Path, video: VideoRecording, part: TrackedEpisode) -> Path:
    """Write ``ppi.png``: the last turn, its plots, strobes around the tracks, and the tracks."""
    scan = part.episode.scans[-1]
    last = part.tracks.time_s == scan.time_s
    strobes = [
        _strobe(video, state[[0, 2]], covariance[np.ix_([0, 2], [0, 2])])
        for state, covariance in zip(
            part.tracks.state[last], part.tracks.covariance[last], strict=True
        )
    ]
    figure = plot.figure(8.6, 8.6)
    plot.ppi(
        video.last,
        figure.add_subplot(),
        plots=np.column_stack([scan.north_m, scan.east_m]),
        strobes=strobes,
        tracks=part.tracks,
    )
    file = folder / "ppi.png"
    plot.save(figure, file)
    return file


def _strobe(video: VideoRecording, place_m: np.ndarray, covariance_m2: np.ndarray) -> np.ndarray:
    """Outline of where the next plot of a track lies with the probability of the gate."""
    range_std_m, bearing_std_rad = video.plot_std
    sensor = wl.ConvertedRangeBearing(range_std_m=range_std_m, bearing_std_rad=bearing_std_rad)
    polar = [np.hypot(*place_m), np.arctan2(place_m[1], place_m[0])]
    plot_m2 = wl.one_point(sensor, polar, 1.0).covariance[np.ix_([0, 2], [0, 2])]
    threshold = wl.ChiSquareGate(probability=_STROBE).threshold(2)
    return plot.ellipse_outline(place_m, covariance_m2 + plot_m2, threshold)


def _extracted(
    path: Path, report: VideoReport, notes: list[str]
) -> Iterator[tuple[RadarVideo, list[wl.video.VideoPlots]]]:
    """Each turn of the file with the plots of the echoes that end in it."""
    turns = read_video(path, report=report)
    turn = next(turns)
    extractor, above_db = _extractor_for(turn)
    if above_db:
        notes.append(f"so much clutter that echoes count from {above_db} dB above noise on")
    for following in turns:
        yield turn, [extractor.process(turn)]
        turn = following
    yield turn, [extractor.process(turn), extractor.finish()]


def _extractor_for(turn: RadarVideo) -> tuple[wl.PlotExtractor, float]:
    """An extractor for this picture, and how far its threshold lies above that of noise, in dB.

    It is raised until the turn gives no more plots than an operator would bear: land and sea
    clutter fluctuate more than noise.
    """
    noise = noise_of(turn.amplitude)
    for above_db in _ABOVE_NOISE_DB:
        settings = _settings(turn, noise, above_db)
        trial = wl.PlotExtractor(**settings)
        if len(trial.process(turn)) + len(trial.finish()) <= _MOST_PLOTS:
            break
    return wl.PlotExtractor(**settings), above_db


def _settings(turn: RadarVideo, noise: Noise | None, above_db: float) -> dict[str, float]:
    """Settings for cells of this length and a receiver of this kind."""
    train = int(np.clip(_TRAIN_M / turn.cell_m, 8, _MOST_TRAIN_CELLS))
    if noise is not None and noise.skewness < _LOGARITHMIC_BELOW:
        steps_per_db = noise.std / _RAYLEIGH_SPREAD_DB
        offset_db = wl.video.threshold_offset_db(_FALSE_ALARMS) + above_db
        threshold = {"threshold_factor": 1.0, "threshold_offset": int(steps_per_db * offset_db) + 1}
    else:
        factor = wl.video.threshold_factor(_FALSE_ALARMS, train_cells=train)
        threshold = {"threshold_factor": min(factor * 10 ** (above_db / 20), 1000.0)}
    return {
        "train_cells": train,
        "guard_cells": int(_GUARD_M / turn.cell_m),
        "max_range_extent_m": _LONG_ECHO_M,
        "max_bearing_extent_rad": _WIDE_ECHO_RAD,
        **threshold,
    }


class Noise(NamedTuple):
    """Standard deviation in amplitudes, and skewness, of the noise of a picture."""

    std: float
    skewness: float


def noise_of(amplitude: np.ndarray) -> Noise | None:
    """The noise of a picture (N, C); None where there is none to see.

    Of pieces of sweeps of 32 cells a fifth is taken for noise: those of the least mean that are not
    dark.
    """
    whole = amplitude.shape[1] // _WINDOW_CELLS * _WINDOW_CELLS
    pieces = amplitude[:, :whole].reshape(-1, _WINDOW_CELLS).astype(np.float32)
    mean = pieces.mean(axis=1) if len(pieces) else np.zeros(0)
    lit = np.flatnonzero(mean > 1.0)
    if len(lit) == 0:
        return None
    low, high = np.quantile(mean[lit], [0.05, 0.25])
    quiet = lit[(mean[lit] >= low) & (mean[lit] <= high)]
    away = pieces[quiet] - mean[quiet, None]
    std = float(np.sqrt(np.mean(away**2)))
    return Noise(std, float(np.mean(away**3)) / std**3) if std > 0 else None


def _scan(number: int, turn: RadarVideo, plots: list[wl.video.VideoPlots]) -> Scan:
    """The plots of a turn, in order of time."""
    time_s, range_m, bearing_rad = (
        np.concatenate([getattr(part, name) for part in plots])
        for name in ("time_s", "range_m", "bearing_rad")
    )
    order = np.argsort(time_s, kind="stable")
    range_m, bearing_rad = range_m[order], bearing_rad[order]
    at_origin = np.zeros(len(order))
    return Scan(
        time_s=float(turn.time_s[-1]),
        number=number,
        plot_time_s=time_s[order],
        north_m=range_m * np.cos(bearing_rad),
        east_m=range_m * np.sin(bearing_rad),
        range_m=range_m,
        bearing_rad=bearing_rad,
        own_north_m=at_origin,
        own_east_m=at_origin,
    )
