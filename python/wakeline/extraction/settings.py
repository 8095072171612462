"""Settings of a plot extractor estimated from the video."""

from __future__ import annotations

import math
from statistics import NormalDist
from typing import NamedTuple

import numpy as np

import wakeline as wl
from wakeline.recording import RadarVideo

from .noise import Noise, noise_of

_LEAST_RANGE_M = 40.0  # from which a ship's radar must detect (IMO MSC.192(79), 5.3.2)
_LEAST_SHARE = 0.1  # of a short range scale
_FALSE_ALARMS = 1e-5
_TRAIN_M, _GUARD_M = 400.0, 150.0  # either side of a cell; ships are up to 300 m long
_MOST_TRAIN_CELLS = 128
_ALIKE = 0.25  # relative difference of windows before settings are estimated again
_WINDOW_SHARE = 8  # of a sweep, so that every cell has others for comparison
_LOGARITHMIC_BELOW = 0.2  # skewness of noise: 0.63 behind a linear receiver, -1.1 in decibels
_RAYLEIGH_SPREAD_DB = 5.57  # standard deviation of noise in decibels
_ABOVE_NOISE_DB = range(0, 40, 2)
_MOST_PLOTS, _FEW_PLOTS = 150, 20  # of a revolution
_STEEP = 0.6  # share of clutter that remains 2 dB higher
_MOST_CELLS = 65536
_WIDE_ECHO_RAD = np.deg2rad(20.0)
_LONG_ECHO_M = 800.0  # longer echoes are land


class Kind(NamedTuple):
    """Besides the noise, the settings depend on bits and on windows in cells."""

    dtype: np.dtype
    train_cells: int
    guard_cells: int

    @classmethod
    def of(cls, video: RadarVideo) -> Kind:
        most = max(video.amplitude.shape[1] // _WINDOW_SHARE, 1)
        train = int(np.clip(_TRAIN_M / video.cell_m, 8, _MOST_TRAIN_CELLS))
        return cls(video.amplitude.dtype, min(train, most), min(int(_GUARD_M / video.cell_m), most))

    def fits(self, other: Kind) -> bool:
        """Whether the windows are similar enough."""
        windows = zip(self[1:], other[1:], strict=True)
        return self.dtype == other.dtype and all(
            abs(mine - its) <= _ALIKE * max(mine, its) for mine, its in windows
        )


def seen_cells(video: RadarVideo, min_range_m: float) -> RadarVideo:
    """The cells from `min_range_m`, or from 40 m or a tenth of the range scale where that is 0.

    Near the antenna the cells are so many for their area that noise looks like a target.
    """
    range_m = video.start_range_m + video.cell_m * video.amplitude.shape[1]
    return video.beyond(min_range_m or min(_LEAST_RANGE_M, _LEAST_SHARE * range_m))


def settings_for(turn: RadarVideo, kind: Kind) -> tuple[dict[str, float], int]:
    """Settings for this picture, and its threshold relative to that for noise, in dB.

    The threshold is raised until a revolution has an acceptable number of plots, because land and
    sea clutter fluctuate more than noise, and on for as long as that removes many of them: echoes
    of targets are not that near to it.
    """
    noise = noise_of(turn.amplitude)
    part = min(len(turn) * turn.azimuth_width_rad / (2 * np.pi), 1.0)
    chosen, fewest = None, _MOST_PLOTS * part
    for above_db in _ABOVE_NOISE_DB:
        settings = _settings(kind, noise, above_db)
        trial = wl.PlotExtractor(**settings)
        plots = len(trial.process(turn)) + len(trial.finish())
        if chosen is not None and plots > _STEEP * fewest:
            break
        if plots > fewest:
            continue
        chosen, fewest = (settings, above_db), plots
        if plots <= _FEW_PLOTS * part:
            break
    return chosen or (settings, above_db)


def threshold_above(noise: Noise | None, false_alarms: float, above_db: float) -> int:
    """The amplitude that noise exceeds with a probability, raised by so many dB."""
    if noise is None:
        return 1
    amplitude = noise.mean + noise.std * _exceeded_stds(noise.skewness, false_alarms)
    if noise.skewness < _LOGARITHMIC_BELOW:
        return int(amplitude + noise.std / _RAYLEIGH_SPREAD_DB * above_db) + 1
    return int(amplitude * 10 ** (above_db / 20)) + 1


def _exceeded_stds(skewness: float, probability: float) -> float:
    """By how many standard deviations above its mean noise is exceeded with a probability.

    Exact for noise of a linear receiver (Rayleigh), of powers (exponential), in decibels (Gumbel)
    and for a normal one; between their skewnesses interpolated.
    """
    power = -math.log(probability)  # in means of a receiver's noise
    rayleigh_mean, rayleigh_std = math.sqrt(math.pi / 4.0), math.sqrt(1.0 - math.pi / 4.0)
    stds = {
        -1.14: (math.log(power) + np.euler_gamma) / (math.pi / math.sqrt(6.0)),
        0.0: NormalDist().inv_cdf(1.0 - probability),
        0.631: (math.sqrt(power) - rayleigh_mean) / rayleigh_std,
        2.0: power - 1.0,
    }
    return float(np.interp(skewness, list(stds), list(stds.values())))


def _settings(kind: Kind, noise: Noise | None, above_db: float) -> dict[str, float]:
    """Settings for windows of this length and a receiver of this kind."""
    if noise is not None and noise.skewness < _LOGARITHMIC_BELOW:
        steps_per_db = noise.std / _RAYLEIGH_SPREAD_DB
        offset_db = wl.video.threshold_offset_db(_FALSE_ALARMS) + above_db
        threshold = {"threshold_factor": 1.0, "threshold_offset": int(steps_per_db * offset_db) + 1}
    else:
        factor = wl.video.threshold_factor(_FALSE_ALARMS, train_cells=kind.train_cells)
        threshold = {"threshold_factor": min(factor * 10 ** (above_db / 20), 1000.0)}
    return {
        "max_sweep_cells": _MOST_CELLS,
        "gap_sweeps": 1,  # the resolution of the azimuth is often that of the sweeps
        "train_cells": kind.train_cells,
        "guard_cells": kind.guard_cells,
        "max_range_extent_m": _LONG_ECHO_M,
        "max_bearing_extent_rad": _WIDE_ECHO_RAD,
        **threshold,
    }
