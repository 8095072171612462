"""Plots of radars in ASTERIX as they arrive: categories 048 with 034, and 010."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from wakeline import wire

from .problems import Problems
from .radar_feed import PlacedPlot, PlotRow, Sector

CATEGORIES = (10, 34, 48)
VIDEO = 240
_OURS = frozenset((*CATEGORIES, VIDEO))
_ALL = _OURS | {*range(1, 34), 62, 63, 65, 150, 205, 247, 252}
_CHAIN = 16  # blocks in which a source is there twice
_HEAD = 3  # octets of the category and the length of a block
# The header of a block of ours, whose first record has a source.
_HEADER = re.compile(rb"[\n\"0\xf0](?=..[\x80-\xff])", re.DOTALL)
_PLOT, _NORTH, _SECTOR = 0, 1, 2
_TURN_RAD = 2.0 * math.pi
_SAME_RAD = 1e-6
_LATE_S = 2.0  # a mark from so much before the last one has been overtaken by it


def are_blocks(octets: bytes) -> bool:
    """Whether octets are whole blocks, of which the first is ours."""
    at = 0
    while at + _HEAD <= len(octets) and _begins_at(octets, at, _ALL if at else _OURS):
        at += _length_at(octets, at)
    return at == len(octets) > 0


def chain_in(octets: bytes, begin: int = 0) -> int | None:
    """Where blocks follow one another of which two have the same source; None if nowhere."""
    places = (match.start() for match in _HEADER.finditer(octets, begin))
    return next((at for at in places if _is_chain(octets, at)), None)


def _is_chain(octets: bytes, at: int) -> bool:
    sources: set[bytes] = set()
    for _ in range(_CHAIN):
        if at + _HEAD >= len(octets) or not _begins_at(octets, at, _ALL):
            return False
        if octets[at] in _OURS:
            source = _source_at(octets, at)
            if len(source) == 2 and source in sources:
                return True
            sources.add(source)
        at += _length_at(octets, at)
    return False


def split(octets: bytes) -> Iterator[bytes]:
    """The blocks of a datagram; what follows a damaged header is one."""
    while octets:
        length = _length_at(octets, 0)
        length = length if length >= _HEAD else len(octets)
        yield octets[:length]
        octets = octets[length:]


def source_of(block: bytes) -> str:
    """Area and system of the first record of a block, as SAC/SIC; empty where it has none."""
    has_source = len(block) > _HEAD and block[_HEAD] & 0x80
    return "/".join(map(str, _source_at(block, 0))) if has_source else ""


def _source_at(octets: bytes, at: int) -> bytes:
    """Area and system of the first record of a block."""
    at += _HEAD
    while at < len(octets) and octets[at] & 1:  # the field specification continues
        at += 1
    return octets[at + 1 : at + 3]


def _length_at(octets: bytes, at: int) -> int:
    return int.from_bytes(octets[at + 1 : at + _HEAD], "big")


def _begins_at(octets: bytes, at: int, categories: frozenset[int]) -> bool:
    """Whether a block begins there, and another one where it ends."""
    length = _length_at(octets, at)
    after = octets[at + length : at + length + 1]
    return octets[at] in categories and length >= _HEAD and (not after or after[0] in _ALL)


class BlockAssembly:
    """Data blocks of ASTERIX from a stream that is cut anywhere and may begin within a block."""

    def __init__(self) -> None:
        self._rest = b""
        self._search_at = 0  # octets of a block that is not whole

    def feed(self, octets: bytes, problems: Problems) -> Iterator[bytes]:
        """Take the next octets; the blocks of our categories that are whole with them."""
        self._rest += octets
        while len(self._rest) >= _HEAD:
            begins, length = _begins_at(self._rest, 0, _ALL), _length_at(self._rest, 0)
            if begins and len(self._rest) >= length:
                block, self._rest, self._search_at = self._rest[:length], self._rest[length:], 0
                if block[0] in _OURS:
                    yield block
                continue
            if begins and len(self._rest) < self._search_at:
                return
            begin = chain_in(self._rest, 1)
            if begin is None and begins:  # wait until it is whole; search seldom in a long one
                self._search_at = len(self._rest) * 5 // 4
                return
            if begin is None:
                ends = range(1, len(self._rest) - _HEAD + 1)
                found = (k for k in ends if _begins_at(self._rest, k, _OURS))
                begin = next(found, len(self._rest))
            head = self._rest[:_HEAD].hex()
            problems.add("ASTERIX", f"{begin} octets skipped: no data block begins with {head}")
            self._rest, self._search_at = self._rest[begin:], 0


class AsterixFeed:
    """Plots of one radar, and the sectors that its north and sector marks end.

    Of several radars at an input the first one counts.

    Attributes
    ----------
    clock : SensorClock
    test_plots : int
        Plots of simulated and test targets, which are left out.
    """

    def __init__(self) -> None:
        self.clock = wire.SensorClock()
        self.test_plots = 0
        self._decoder = wire.AsterixDecoder()
        self._source: int | None = None
        self._edge_rad = math.nan
        self._edge_s = -math.inf

    def feed(
        self, time_s: float, octets: bytes, problems: Problems
    ) -> Iterator[PlotRow | PlacedPlot | Sector]:
        """Take a datagram; its plots, and the sectors that end with it."""
        found = self._decoder.decode(octets, time_s)
        for _, text, item in found.problems:
            problems.add(f"ASTERIX {item}".strip(), text)
        rows = zip(
            found.kind.tolist(),
            found.source.tolist(),
            found.time_s.tolist(),
            found.range_m.tolist(),
            found.bearing_rad.tolist(),
            found.latitude_rad.tolist(),
            found.longitude_rad.tolist(),
            found.test.tolist(),
            strict=True,
        )
        for kind, source, at_s, range_m, bearing_rad, *place_rad, is_test in rows:
            if self._source is None:
                self._source = source
            if source != self._source:
                problems.add("other radar", f"source {divmod(source, 256)} at this input")
                continue
            when_s = self.clock(at_s, time_s)
            if kind == _PLOT:
                if is_test:
                    self.test_plots += 1
                elif math.isfinite(range_m + bearing_rad):
                    yield PlotRow(when_s, range_m, bearing_rad)
                elif math.isfinite(sum(place_rad)):
                    yield PlacedPlot(when_s, *place_rad)
            elif kind == _NORTH:
                yield from self._pass_to(0.0, when_s)
            elif math.isfinite(bearing_rad):
                yield from self._pass_to(bearing_rad % _TURN_RAD, when_s)

    def _pass_to(self, azimuth_rad: float, time_s: float) -> Iterator[Sector]:
        """The sector from the last mark; a whole turn where the marks are those of north."""
        from_rad, from_s = self._edge_rad, self._edge_s
        if 0.0 < from_s - time_s < _LATE_S:
            return
        width_rad = (azimuth_rad - from_rad) % _TURN_RAD
        if width_rad < _SAME_RAD or width_rad > _TURN_RAD - _SAME_RAD:
            if time_s - from_s < 0.2:  # north and the sector that begins there
                return
            width_rad = _TURN_RAD
        self._edge_rad, self._edge_s = azimuth_rad, time_s
        if math.isfinite(from_rad):
            yield Sector(from_rad, from_rad + width_rad, time_s, [])
