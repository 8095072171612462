"""Echoes for the page: the latest turn of a radar as a polar image, row by row."""

from __future__ import annotations

import struct
import threading

import numpy as np
from numpy.typing import ArrayLike, NDArray

_TURN_RAD = 2.0 * np.pi
_MOST_ROWS, _LEAST_ROWS = 2048, 64
_MOST_COLUMNS = 1024
_FILLED_GAP = 4
_HEADER = struct.Struct("<BBHHHff")  # kind, radar, rows, columns, count, range_m, heading_rad


class EchoImage:
    """The latest amplitude in each direction, clockwise from north, in 16 levels.

    An image has up to 2048 rows (directions) of up to 1024 columns (ranges); a cell is the largest
    amplitude in it, so that no echo is lost. A client takes the rows that are new to it: what it
    could not take in time is replaced, never queued (:class:`EchoReader`).

    Parameters
    ----------
    radar : int
        Number of the radar in messages.

    Attributes
    ----------
    range_m, heading_rad : float
        Of the latest sweeps.
    written : int
        Rows so far.
    """

    def __init__(self, radar: int = 0) -> None:
        self.radar = radar
        self.range_m = self.heading_rad = float("nan")
        self._levels = np.zeros((0, 0), np.uint8)
        self._version = np.zeros(0, np.int64)
        self._now = 0
        self._last_row = -1
        self.written = 0
        self._lock = threading.Lock()

    def __call__(
        self,
        azimuth_rad: ArrayLike,
        heading_rad: float,
        range_m: float,
        cells: NDArray[np.uint8],
    ) -> None:
        """Take sweeps in order of time.

        Parameters
        ----------
        azimuth_rad : (n,) array
            Clockwise from the bow, or from north where the heading is NaN.
        heading_rad : float
        range_m : float
            Of the outer edge of the last cell.
        cells : (n, m) array of uint8
        """
        azimuth_rad = np.atleast_1d(np.asarray(azimuth_rad, dtype=float))
        if len(azimuth_rad) == 0:
            return
        if np.isfinite(heading_rad):
            azimuth_rad = azimuth_rad + heading_rad
        levels = _columns(np.asarray(cells, dtype=np.uint8)) >> 4
        with self._lock:
            self._fit(azimuth_rad, range_m, levels.shape[1])
            self.heading_rad = heading_rad
            self._write(azimuth_rad, levels)

    def _fit(self, azimuth_rad: NDArray[np.float64], range_m: float, columns: int) -> None:
        """Start anew where range, columns or the number of sweeps of a turn change."""
        rows = len(self._version)
        if len(azimuth_rad) > 1:
            step_rad = float(np.median(np.diff(azimuth_rad) % _TURN_RAD))
            if 0.0 < step_rad < np.pi:
                wanted = 2 ** int(np.log2(_TURN_RAD / step_rad * 1.02))
                rows = int(np.clip(wanted, _LEAST_ROWS, _MOST_ROWS))
        rows = rows or _MOST_ROWS
        if self._levels.shape == (rows, columns) and range_m == self.range_m:
            return
        self.range_m = range_m
        self._levels = np.zeros((rows, columns), np.uint8)
        self._version = np.zeros(rows, np.int64)
        self._last_row = -1

    def _write(self, azimuth_rad: NDArray[np.float64], levels: NDArray[np.uint8]) -> None:
        rows = len(self._version)
        row = (azimuth_rad % _TURN_RAD * (rows / _TURN_RAD)).astype(np.int64) % rows
        begins = np.flatnonzero(np.diff(row, prepend=-1))
        row = row[begins]
        largest = np.maximum.reduceat(levels, begins, axis=0)
        self.written += len(row) - int(row[0] == self._last_row)
        if row[0] == self._last_row:
            np.maximum(largest[0], self._levels[row[0]], out=largest[0])
        steps = np.diff(row, prepend=self._last_row if self._last_row >= 0 else row[0]) % rows
        new_version = self._now + 1 + np.arange(len(row))
        self._now += len(row)
        for back in range(min(_FILLED_GAP, int(steps.max(initial=1))) - 1, -1, -1):
            filled = (steps > back) & (steps <= _FILLED_GAP) if back else np.full(len(row), True)
            at = (row[filled] - back) % rows
            self._levels[at] = largest[filled]
            self._version[at] = new_version[filled]
        self._last_row = int(row[-1])

    @property
    def shape(self) -> tuple[int, int]:
        """Rows of a turn, and columns."""
        return self._levels.shape

    def rows_since(self, version: int, most: int) -> tuple[bytes, int, int]:
        """Message with the rows newer than a version, the oldest first; its version; rows left.

        A message is little-endian: kind 1, radar, rows of a turn, columns, number of rows here,
        range of the outer edge in metres, heading in radians (NaN unknown); the numbers of the
        rows; their cells, two of 4 bits an octet, the nearer one in the low half. It is empty when
        there is none.
        """
        with self._lock:
            new = np.flatnonzero(self._version > version)
            if len(new) == 0:
                return b"", version, 0
            left = max(len(new) - most, 0)
            new = new[np.argsort(self._version[new], kind="stable")[:most]]
            rows, columns = self._levels.shape
            head = _HEADER.pack(
                1, self.radar, rows, columns, len(new), self.range_m, self.heading_rad
            )
            chosen = self._levels[new]
            packed = chosen[:, 0::2] | (chosen[:, 1::2] << 4)
            message = head + new.astype("<u2").tobytes() + packed.tobytes()
            return message, int(self._version[new[-1]]), left


class EchoReader:
    """What one client has seen of an echo image.

    Attributes
    ----------
    gap : int
        Rows that newer ones have replaced before the client took them.
    """

    def __init__(self, image: EchoImage, most: int = 256) -> None:
        self._image, self._most = image, most
        self._version = self.gap = 0
        self._written = self._sent = 0

    def next(self) -> bytes:
        """The next message (:meth:`EchoImage.rows_since`); empty when nothing is new."""
        is_first = self._version == 0
        message, self._version, left = self._image.rows_since(self._version, self._most)
        if not message:
            return message
        count = _HEADER.unpack_from(message)[4]
        if is_first:
            self._written = self._image.written - count - left
        self._sent += count
        if left == 0:
            self.gap += max(self._image.written - self._written - self._sent, 0)
            self._written, self._sent = self._image.written, 0
        return message


def _columns(cells: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The largest of every few neighbours, for an even number of columns."""
    together = -(-cells.shape[1] // _MOST_COLUMNS)
    columns = -(-cells.shape[1] // together)
    columns += columns % 2
    missing = columns * together - cells.shape[1]
    if missing:
        cells = np.pad(cells, ((0, 0), (0, missing)))
    largest = cells[:, 0::together]
    for k in range(1, together):
        largest = np.maximum(largest, cells[:, k::together])
    return largest
