"""The shown tracks as columns, each as of its last update."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from .engine import LiveTrack


class Shown:
    """Columns of the shown tracks, for outputs that report all of them.

    Attributes
    ----------
    names : list of str
    coasting : list of bool
    """

    def __init__(self) -> None:
        self._row: dict[int, int] = {}
        self._ids = np.zeros(64, dtype=np.int64)
        self._time_s, self._mean = np.zeros(64), np.zeros((64, 4))
        self._covariance = np.zeros((64, 4, 4))
        self._coasting = np.zeros(64, dtype=bool)
        self.names: list[str] = []

    def __len__(self) -> int:
        return len(self._row)

    @property
    def track_id(self) -> np.ndarray:
        """(k,)"""
        return self._ids[: len(self)]

    @property
    def time_s(self) -> np.ndarray:
        """(k,) of the last update."""
        return self._time_s[: len(self)]

    @property
    def mean(self) -> np.ndarray:
        """(k, 4) [north, its velocity, east, its velocity]"""
        return self._mean[: len(self)]

    @property
    def covariance(self) -> np.ndarray:
        """(k, 4, 4)"""
        return self._covariance[: len(self)]

    @property
    def coasting(self) -> np.ndarray:
        """(k,)"""
        return self._coasting[: len(self)]

    def take(self, updated: Iterable[LiveTrack]) -> None:
        """Add tracks, or replace them by their update."""
        for track in updated:
            row = self._row.get(track.track_id)
            if row is None:
                row = self._row[track.track_id] = len(self)
                self.names.append(track.name)
                if row == len(self._ids):
                    self._grow()
            self._ids[row], self._time_s[row] = track.track_id, track.time_s
            self._mean[row], self._covariance[row] = track.mean, track.covariance
            self._coasting[row], self.names[row] = track.status == "coasting", track.name

    def drop(self, track_ids: Iterable[int]) -> None:
        """Remove tracks; the last one takes the row of each."""
        for track_id in track_ids:
            row = self._row.pop(track_id, None)
            if row is None:
                continue
            last = len(self)
            name = self.names.pop()
            if row != last:
                self._row[int(self._ids[last])] = row
                self.names[row] = name
                for column in self._columns():
                    column[row] = column[last]

    def _columns(self) -> tuple[np.ndarray, ...]:
        return self._ids, self._time_s, self._mean, self._covariance, self._coasting

    def _grow(self) -> None:
        self._ids, self._time_s, self._mean, self._covariance, self._coasting = (
            np.concatenate([column, np.zeros_like(column)]) for column in self._columns()
        )
