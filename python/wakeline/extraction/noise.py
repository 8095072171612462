"""The noise of a radar picture."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

_WINDOW_CELLS = 32
_WIDENED, _ALIKE = 4, 2.5  # times; standard deviations of the mean of a piece


class Noise(NamedTuple):
    """Standard deviation, skewness and mean of the amplitude of the noise of a picture."""

    std: float
    skewness: float
    mean: float


def noise_of(amplitude: np.ndarray) -> Noise | None:
    """The noise of a picture (N, C); None if none is visible.

    Noise is estimated from the fifth of all pieces of 32 cells that has the smallest mean without
    being dark, and from those whose mean differs no more from that than by the noise itself.
    """
    whole = amplitude.shape[1] // _WINDOW_CELLS * _WINDOW_CELLS
    pieces = amplitude[:, :whole].reshape(-1, _WINDOW_CELLS).astype(np.float32)
    mean = pieces.mean(axis=1) if len(pieces) else np.zeros(0)
    lit = np.flatnonzero(mean > 1.0)
    if len(lit) == 0:
        return None
    low, high = np.quantile(mean[lit], [0.05, 0.25], method="nearest")  # also for few pieces
    found = _noise_of_pieces(pieces[lit[(mean[lit] >= low) & (mean[lit] <= high)]])
    for _ in range(_WIDENED if found is not None else 0):
        alike = np.abs(mean[lit] - found.mean) <= _ALIKE * found.std / np.sqrt(_WINDOW_CELLS)
        found = _noise_of_pieces(pieces[lit[alike]]) or found
    return found


def _noise_of_pieces(pieces: np.ndarray) -> Noise | None:
    if len(pieces) == 0:
        return None
    mean = pieces.mean(axis=1)
    away = pieces - mean[:, np.newaxis]
    square = away * away
    std = float(np.sqrt(np.mean(square)))
    skewness = float(np.mean(square * away)) / std**3 if std > 0 else 0.0
    return Noise(std, skewness, float(mean.mean())) if std > 0 else None
