"""NMEA 0183 as it arrives: own ship's instruments and AIS."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

from wakeline.recording.nmea.reader import Rows
from wakeline.recording.nmea.sentence import FIELDS, MODE_FIELD, Sentence, parted, pieces_of

from .ais import AisAssembly, decoded
from .lines import LineAssembly
from .problems import Problems

_AIS = ("VDM", "VDO")
_GIVES = {
    **dict.fromkeys(("GGA", "GNS", "GLL"), ("position",)),
    "RMC": ("position", "velocity"),
    "VTG": ("velocity",),
    **dict.fromkeys(("HDT", "THS", "HDG", "HDM"), ("heading",)),
}
_STATUS = {"RMC": 1, "GLL": 5}  # fields
_SIMULATOR = "simulator"
_NOT_MEASURED = {  # by mode or quality; of several modes the first one counts
    **dict.fromkeys("S8", _SIMULATOR),
    **dict.fromkeys("E6", "estimated"),
    **dict.fromkeys("M7", "manual input"),
    **dict.fromkeys("N0", "no fix"),
    "V": "not valid",
}


class OwnReading(NamedTuple):
    """A reading of own ship: quantity, sentence, talker, and values, or why there are none."""

    quantity: str
    sentence: str
    talker: str
    values: tuple[float, ...]
    why_not: str = ""


class AisMessage(NamedTuple):
    """A decoded AIS message, and whether it is own ship's."""

    message: Any
    own: bool


class NmeaDecoder:
    """Sentences of one source.

    Parameters
    ----------
    is_stream : bool
        Whether lines may be cut by the borders of the pieces.

    Attributes
    ----------
    sentences : int
        Valid ones.
    """

    def __init__(self, is_stream: bool) -> None:
        self.sentences = 0
        self._lines = LineAssembly(is_stream, 1024)
        self._ais = AisAssembly()
        self._with_checksum: set[str] = set()

    def feed(
        self, time_s: float, octets: bytes, problems: Problems
    ) -> Iterator[OwnReading | AisMessage]:
        """The readings in the next octets."""
        for line in self._lines.feed(octets.removeprefix(b"UdPbC\0"), problems):
            for piece, fault in pieces_of(line):
                if fault is not None:
                    problems.add(*fault)
                else:
                    yield from self._read(time_s, line, piece, problems)

    def _read(
        self, time_s: float, line: bytes, piece: bytes, problems: Problems
    ) -> Iterator[OwnReading | AisMessage]:
        address, kind, body = parted(piece)
        if b"*" in piece:
            self._with_checksum.add(kind)
        elif kind in self._with_checksum or kind in _AIS:
            problems.add("cut", f"{kind} has no checksum")
            return
        elif body.count(b",") + 1 < FIELDS.get(kind, 0):
            problems.add("cut", f"{kind}: wanted {FIELDS[kind]} fields or more")
            return
        self.sentences += 1
        if kind in _AIS:
            yield from self._read_ais(time_s, line, piece, kind == "VDO", problems)
        elif kind in FIELDS:
            sentence, rows = Sentence(0, address, kind, body.decode("ascii")), Rows()
            rows.read(sentence)
            for fault in sentence.faults:
                problems.add(*fault)
            yield from _readings(sentence, rows)

    def _read_ais(
        self, time_s: float, line: bytes, piece: bytes, own: bool, problems: Problems
    ) -> Iterator[AisMessage]:
        sentences = self._ais.feed(time_s, line, piece, problems)
        if sentences is None:
            return
        try:
            yield AisMessage(decoded(sentences), own)
        except ValueError as error:
            problems.add("AIS message", str(error))
        except ModuleNotFoundError as error:
            problems.add("pyais", str(error))


def _readings(sentence: Sentence, rows: Rows) -> Iterator[OwnReading]:
    kind, talker = sentence.kind, sentence.address[: -len(sentence.kind)]
    state = _state(sentence)
    found = [] if state == _SIMULATOR else list(_values(rows))
    for quantity, values in found:
        yield OwnReading(quantity, kind, talker, values)
    if sentence.faults:
        return
    given = {"heading" if quantity == "magnetic" else quantity for quantity, _ in found}
    for quantity in _GIVES.get(kind, ()):
        if quantity not in given:
            at_zero = quantity == "position" and rows.of["fixes"]
            why_not = state or ("position 0/0" if at_zero else "no value")
            yield OwnReading(quantity, kind, talker, (), why_not)


def _state(sentence: Sentence) -> str:
    """What an instrument says of data that it has not measured; empty if it has."""
    kind = sentence.kind
    modes = sentence.text(MODE_FIELD[kind]) if kind in MODE_FIELD else ""
    states = [words for mode, words in _NOT_MEASURED.items() if mode in modes]
    if states and len(states) == len(set(modes)):
        return states[0]
    if kind in _STATUS and sentence.text(_STATUS[kind]) == "V":
        return "no fix"
    return "no quality" if kind in ("GGA", "GNS") and not modes else ""


def _values(rows: Rows) -> Iterator[tuple[str, tuple[float, ...]]]:
    """Quantities and values of what was measured."""
    for _, _, _, valid, latitude, longitude, *_ in rows.of["fixes"]:
        if valid and max(abs(latitude), abs(longitude)) > 1e-4:
            yield "position", (latitude, longitude)
    for _, _, _, valid, speed, course, *_ in rows.of["ground"]:
        if valid and (math.isfinite(course) or speed == 0.0):
            course = course if math.isfinite(course) else 0.0
            if math.isfinite(speed):
                yield "velocity", (speed * math.cos(course), speed * math.sin(course))
    for _, variation in rows.variation:
        yield "variation", (variation,)
    for _, _, _, valid, heading in rows.of["heading"]:
        if valid:
            yield "heading", (heading,)
    for _, _, _, valid, heading, variation in rows.of["compass"]:
        if math.isfinite(variation):
            yield "variation", (variation,)
        if valid:
            yield "magnetic", (heading,)
    for _, _, _, valid, rate in rows.of["turn"]:
        if valid:
            yield "turn", (rate,)
