"""Values on separate times."""

from __future__ import annotations

import numpy as np

NEAR_S = 3.0


def between(time_s: np.ndarray, times: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Linearly interpolated values (T,); NaN where no value is near."""
    if len(times) == 0:
        return np.full(len(time_s), np.nan)
    after = np.searchsorted(times, time_s)
    before_s = times[np.maximum(after - 1, 0)]
    after_s = times[np.minimum(after, len(times) - 1)]
    near = np.minimum(np.abs(time_s - before_s), np.abs(after_s - time_s)) <= NEAR_S
    return np.where(near, np.interp(time_s, times, values), np.nan)


def at(time_s: np.ndarray, times: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values at the times that have one, NaN at the others."""
    spread = np.full((len(time_s), *values.shape[1:]), np.nan)
    later = times >= time_s[0]
    spread[np.searchsorted(time_s, times[later])] = values[later]
    return spread


def first(values: np.ndarray, otherwise: np.ndarray | float) -> np.ndarray | float:
    """The first row that is finite."""
    sound = np.isfinite(values.reshape(len(values), -1)).all(axis=1)
    return values[sound.argmax()] if sound.any() else otherwise


def held(time_s: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The last finite row at each time, and its time."""
    sound = np.isfinite(values.reshape(len(values), -1)).all(axis=1)
    last = np.maximum.accumulate(np.where(sound, np.arange(len(values)), 0))
    return values[last], time_s[last]
