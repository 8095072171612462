"""The shown tracks as columns, each as of its last update."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from wakeline.track import TrackTable


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

    def take(self, table: TrackTable, rows: np.ndarray) -> None:
        """Add tracks of a table, or replace them by their update."""
        at = np.array([self._at(one) for one in table.track_id[rows].tolist()], dtype=np.int64)
        status, name = table.status, table.name
        self._ids[at], self._time_s[at] = table.track_id[rows], table.time_s[rows]
        self._mean[at], self._covariance[at] = table.mean[rows], table.covariance[rows]
        self._coasting[at] = [status[row] == "coasting" for row in rows.tolist()]
        for place, row in zip(at.tolist(), rows.tolist(), strict=True):
            self.names[place] = name[row]

    def _at(self, track_id: int) -> int:
        """The row of a track, which is made where it has none."""
        row = self._row.get(track_id)
        if row is None:
            row = self._row[track_id] = len(self)
            self.names.append("")
            if row == len(self._ids):
                self._grow()
        return row

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
