"""Plots of the echoes of consecutive revolutions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

import wakeline as wl
from wakeline._brief import counted
from wakeline.recording import RadarVideo

from .settings import Kind, seen_cells, settings_for
from .turns import Turn

_SWEEPS_FOR_DIRECTION = 16  # of the antenna


class Plots(NamedTuple):
    """Columns of plots; variances (n, 2) of range and bearing."""

    time_s: np.ndarray
    range_m: np.ndarray
    bearing_rad: np.ndarray
    variance: np.ndarray


def joined(parts: Sequence[Plots]) -> Plots:
    return Plots(*map(np.concatenate, zip(*parts, strict=True)))


class Extraction:
    """Plots of consecutive revolutions, with settings estimated for each kind of video.

    Parameters
    ----------
    min_range_m : float
        Cells that begin nearer give no plots; 0: 40 m, or a tenth of a shorter range scale.
    """

    def __init__(self, min_range_m: float = 0.0) -> None:
        self._min_range_m = min_range_m
        self._extractor: wl.PlotExtractor | None = None
        self._kind: Kind | None = None
        self._settings: dict[Kind, dict[str, float]] = {}
        self._above_db = 0
        self._mirrored = False
        self._rejected = 0

    def plots_of(self, turn: Turn) -> Plots:
        """Plots of the echoes that end in a revolution."""
        plots = []
        turn = replace(turn, blocks=[seen_cells(one, self._min_range_m) for one in turn.blocks])
        for block in turn.blocks:
            kind = Kind.of(block)
            if self._kind is None or not kind.fits(self._kind) or self._turns_back(block):
                plots.append(self.finished())
                self._begin(turn, kind, block)
            plots.append(self._as_seen(self._extractor.process(self._clockwise(block))))
        return joined(plots)

    def finished(self) -> Plots:
        """Plots of the open echoes; the next revolution is then independent."""
        if self._extractor is None:
            return Plots(np.zeros(0), np.zeros(0), np.zeros(0), np.zeros((0, 2)))
        plots = self._as_seen(self._extractor.finish())
        counts = self._extractor.counts
        self._rejected += counts.too_long + counts.repeated + counts.invalid
        self._extractor = self._kind = None
        return plots

    def notes(self) -> list[str]:
        """Notes for the user."""
        notes = []
        if self._above_db:
            notes.append(
                f"strong clutter: the threshold is {self._above_db} dB above that for noise"
            )
        if self._mirrored:
            notes.append("the antenna turns anticlockwise")
        if self._rejected:
            what = "invalid [sweep|sweeps] left out"
            notes.append(counted(self._rejected, what))
        return notes

    def _begin(self, turn: Turn, kind: Kind, block: RadarVideo) -> None:
        self._mirrored = (sense(block) or sense(turn.longest)) < 0.0
        if kind not in self._settings:
            alike = [other for other in turn.blocks if Kind.of(other).fits(kind)]
            settings, above_db = settings_for(self._clockwise(max(alike, key=len)), kind)
            self._settings[kind] = settings
            self._above_db = max(self._above_db, above_db)
        self._extractor = wl.PlotExtractor(**self._settings[kind])
        self._kind = kind

    def _turns_back(self, block: RadarVideo) -> bool:
        """Whether the antenna's direction changes with this block."""
        return sense(block) * (-1.0 if self._mirrored else 1.0) < 0.0

    def _clockwise(self, video: RadarVideo) -> RadarVideo:
        """The video, mirrored if the antenna turns anticlockwise."""
        return replace(video, azimuth_rad=-video.azimuth_rad) if self._mirrored else video

    def _as_seen(self, plots: wl.video.VideoPlots) -> Plots:
        bearing_rad = -plots.bearing_rad if self._mirrored else plots.bearing_rad
        variance = np.diagonal(plots.covariance, axis1=1, axis2=2)
        return Plots(plots.time_s, plots.range_m, np.mod(bearing_rad, 2 * np.pi), variance)


def sense(video: RadarVideo) -> float:
    """1 if the antenna turns clockwise, -1 anticlockwise, 0 with too few sweeps."""
    if len(video) < _SWEEPS_FOR_DIRECTION:
        return 0.0
    return float(np.sign(np.sum(wl.wrap_angle(np.diff(video.azimuth_rad)))))
