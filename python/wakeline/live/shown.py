"""The shown tracks as columns, each as of its last update."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from wakeline.track import TrackTable

_COLUMNS = (
    *("_ids", "_time_s", "_mean", "_covariance", "_coasting", "_acquiring"),
    *("_first_s", "_seen_s", "_hits"),
)


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
        self._coasting, self._acquiring = np.zeros(64, dtype=bool), np.zeros(64, dtype=bool)
        self._first_s, self._seen_s = np.zeros(64), np.zeros(64)
        self._hits = np.zeros(64, dtype=np.int64)
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

    @property
    def acquiring(self) -> np.ndarray:
        """(k,) Whether the operator has acquired it and its motion is not known yet."""
        return self._acquiring[: len(self)]

    def seen_s(self, track_id: int) -> tuple[float, float] | None:
        """When a track was first shown, and its last echo; None of one that is not shown."""
        row = self._row.get(track_id)
        return None if row is None else (float(self._first_s[row]), float(self._seen_s[row]))

    def take(self, table: TrackTable, rows: np.ndarray, acquiring: np.ndarray) -> None:
        """Add tracks of a table, or replace them by their update."""
        known = len(self)
        at = np.array([self._at(one) for one in table.track_id[rows].tolist()], dtype=np.int64)
        hits, time_s, is_new = table.hits[rows], table.time_s[rows], at >= known
        self._first_s[at[is_new]] = time_s[is_new]
        seen = is_new | (hits != self._hits[at])
        self._seen_s[at[seen]] = time_s[seen]
        self._hits[at], self._acquiring[at] = hits, acquiring[rows]
        status, name = table.status, table.name
        self._ids[at], self._time_s[at] = table.track_id[rows], time_s
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

    def _columns(self) -> list[np.ndarray]:
        return [getattr(self, name) for name in _COLUMNS]

    def _grow(self) -> None:
        for name, column in zip(_COLUMNS, self._columns(), strict=True):
            setattr(self, name, np.concatenate([column, np.zeros_like(column)]))
