"""Spokes of a radar server of Signal K (mayara and others): protocol buffers to sweeps.

``RadarMessage { repeated Spoke spokes = 2; }`` and ``Spoke { uint32 angle = 1; uint32 bearing =
2; uint32 range = 3; uint64 time = 4; bytes data = 5; }``: angle clockwise from the bow and bearing
from north, both in spokes of a revolution; range of the last pixel in metres; time in ms since
1970; one octet a pixel, up to `pixelValues` of the radar's capabilities, which come first as JSON.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from itertools import groupby
from typing import NamedTuple

import numpy as np

from .problems import Problems
from .radar_feed import PlotRow, Sector
from .video_feed import Sweeps, VideoFeed

_TURN_RAD = 2.0 * math.pi
_MOST_PER_TURN = 1 << 16
_MOST_PIXELS = 1 << 16


class _Spoke(NamedTuple):
    number: int
    range_m: int
    time_ms: int
    pixels: bytes

    @property
    def geometry(self) -> tuple[int, int]:
        return self.range_m, len(self.pixels)


class SpokeFeed:
    """Plots and sectors of one radar from its spokes.

    Parameters
    ----------
    from_bow : bool
        Whether angles from the bow are used; else bearings from north, which a server gives where
        it knows the heading.
    min_range_m : float
        As for :class:`VideoFeed`.

    Attributes
    ----------
    video : VideoFeed
    clock : SensorClock
    """

    def __init__(self, from_bow: bool, min_range_m: float = 0.0) -> None:
        self.video = VideoFeed(min_range_m)
        self.clock = self.video.clock
        self._from_bow = from_bow
        self._per_turn = 0
        self._scale = 1

    def feed(self, time_s: float, octets: bytes, problems: Problems) -> Iterator[PlotRow | Sector]:
        """Take a message of the stream, or the capabilities of the radar."""
        try:
            if octets[:1] == b"{":
                self._learn(octets)
                return
            spokes = list(self._spokes(octets))
        except (ValueError, IndexError, KeyError, TypeError) as error:
            problems.add("spokes", str(error) or type(error).__name__)
            return
        for _, alike in groupby(spokes, key=lambda spoke: spoke.geometry):
            yield from self.video.take(self._sweeps(time_s, list(alike)), problems)

    def _learn(self, octets: bytes) -> None:
        capabilities = json.loads(octets)
        per_turn = int(capabilities["spokesPerRevolution"])
        values = int(capabilities.get("pixelValues", 256))
        if not 0 < per_turn <= _MOST_PER_TURN or not 2 <= values <= 256:
            raise ValueError(
                f"wanted spokesPerRevolution and pixelValues, got {per_turn}, {values}"
            )
        self._per_turn, self._scale = per_turn, 255 // (values - 1)

    def _spokes(self, octets: bytes) -> Iterator[_Spoke]:
        if not self._per_turn:
            raise ValueError("spokes before the capabilities of the radar")
        wanted = 1 if self._from_bow else 2
        for number, message in _fields(octets):
            if number != 2 or not isinstance(message, bytes):
                continue
            spoke = dict(_fields(message))
            if wanted not in spoke:
                raise ValueError("a spoke has no bearing: the server does not know the heading")
            angle, range_m, pixels = spoke[wanted], spoke.get(3, 0), spoke.get(5, b"")
            if not (isinstance(angle, int) and isinstance(range_m, int) and 0 < range_m < 1e6):
                raise ValueError("wanted an angle and a range of a spoke")
            if not isinstance(pixels, bytes) or not 0 < len(pixels) <= _MOST_PIXELS:
                raise ValueError("wanted pixels of a spoke")
            time_ms = spoke.get(4, 0)
            yield _Spoke(angle, range_m, time_ms if isinstance(time_ms, int) else 0, pixels)

    def _sweeps(self, time_s: float, spokes: list[_Spoke]) -> Sweeps:
        first, count = spokes[0], len(spokes)
        amplitude = np.frombuffer(b"".join(one.pixels for one in spokes), np.uint8)
        scaled = np.minimum(amplitude.astype(np.uint16) * self._scale, 255).astype(np.uint8)
        times = [
            self.clock(1e-3 * one.time_ms, time_s) if one.time_ms else time_s for one in spokes
        ]
        number = np.array([one.number % self._per_turn for one in spokes])
        return Sweeps(
            number * (_TURN_RAD / self._per_turn),
            np.maximum.accumulate(times),
            _TURN_RAD / self._per_turn,
            0.0,
            first.range_m / len(first.pixels),
            scaled.reshape(count, -1),
        )


def _fields(octets: bytes) -> Iterator[tuple[int, int | bytes]]:
    """Field numbers and values of a message; ValueError if it is cut."""
    at = 0
    while at < len(octets):
        key, at = _varint(octets, at)
        kind = key & 7
        if kind == 0:
            value, at = _varint(octets, at)
        elif kind in (1, 5):
            size = 8 if kind == 1 else 4
            value, at = octets[at : at + size], at + size
        elif kind == 2:
            size, at = _varint(octets, at)
            value, at = octets[at : at + size], at + size
        else:
            raise ValueError(f"wanted a field of protocol buffers, got kind {kind}")
        if at > len(octets):
            raise ValueError("the message is cut")
        yield key >> 3, value


def _varint(octets: bytes, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        octet = octets[at]
        value |= (octet & 127) << shift
        at += 1
        if octet < 128:
            return value, at
        shift += 7
        if shift > 63:
            raise ValueError("wanted a number of at most 64 bits")
