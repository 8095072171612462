"""One sentence: its place in a line, its validity, and its fields."""

from __future__ import annotations

import datetime
import math
import re
from collections.abc import Iterator
from functools import reduce
from operator import xor

from .log import NmeaReport

# A sentence without a checksum must have at least this many fields.
FIELDS = {
    "RMC": 9,
    "GGA": 6,
    "GNS": 6,
    "GLL": 6,
    "VTG": 6,
    "HDT": 2,
    "THS": 2,
    "HDG": 5,
    "HDM": 2,
    "VHW": 6,
    "VBW": 6,
    "ROT": 2,
    "ZDA": 4,
}

_LINE_END = re.compile(rb"\r*\n|\r")
_PIECE = re.compile(rb"[$!][^$\\\r\n]*")
_CHECKSUM = {b"%02X" % value: value for value in range(256)}
_PRINTABLE = bytes(range(0x20, 0x7F))
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)").fullmatch
_CLOCK = re.compile(r"(\d\d)(\d\d)(\d\d(?:\.\d*)?)").fullmatch
_LATITUDE = re.compile(r"(\d\d)(\d\d(?:\.\d*)?)").fullmatch
_LONGITUDE = re.compile(r"(\d\d\d)(\d\d(?:\.\d*)?)").fullmatch
_DATE = re.compile(r"(\d\d)(\d\d)(\d\d)").fullmatch
_DAY_0 = datetime.date(1970, 1, 1).toordinal()
_GPS_YEAR = 1980
_FIRST_YEAR = 80  # two-digit years from here on are of the last century


class Sentence:
    """A valid sentence and its fields, counted from 0 after the address.

    Every reader returns NaN for an empty field, and for one that cannot be read, which is added to
    `faults`.

    Parameters
    ----------
    line : int
    kind : str
        The three letters after the talker.
    body : str
        Fields separated by commas.
    """

    __slots__ = ("_written", "faults", "fields", "kind", "line")

    def __init__(self, line: int, kind: str, body: str) -> None:
        self.line = line
        self.kind = kind
        self._written = body
        self.fields = [field.strip() for field in body.upper().split(",")]
        self.faults: list[tuple[str, str]] = []

    def text(self, k: int) -> str:
        """The text of a field; '' if there are fewer."""
        return self.fields[k] if k < len(self.fields) else ""

    def letter(self, k: int, allowed: str) -> str:
        """A field of one letter out of `allowed`, or ''."""
        text = self.text(k)
        if text and (len(text) > 1 or text not in allowed):
            self._fault("field", k, f"one of {' '.join(allowed)}")
            return ""
        return text

    def letters(self, k: int, allowed: str) -> str:
        """A field of letters out of `allowed`, or ''."""
        text = self.text(k)
        if not set(text) <= set(allowed):
            self._fault("field", k, f"letters out of {' '.join(allowed)}")
            return ""
        return text

    def says(self, k: int, letter: str) -> bool:
        """Whether a field is `letter` or empty."""
        return self.letter(k, letter) == self.text(k)

    def number(self, k: int, low: float, high: float) -> float:
        """A number from `low` to `high`."""
        text = self.text(k)
        if not text:
            return math.nan
        if not _NUMBER(text):
            return self._fault("field", k, "a number")
        return self._within(float(text), k, low, high)

    def whole_number(self, k: int, low: int, high: int) -> float:
        """A whole number from `low` to `high`, of digits only."""
        text = self.text(k)
        if text and not text.isdecimal():
            return self._fault("field", k, "a whole number")
        return self.number(k, low, high)

    def angle_rad(self, k: int) -> float:
        """An angle given in degrees from 0 to 360, as radians in [0, 2 pi)."""
        return math.radians(self.number(k, 0.0, 360.0) % 360.0)

    def signed_rad(self, k: int) -> float:
        """An angle in degrees with E or W in the next field, as radians positive east."""
        angle_deg = self.number(k, 0.0, 180.0)
        side = self.letter(k + 1, "EW")
        if math.isnan(angle_deg):
            return math.nan
        if not side:
            return self._fault("field", k + 1, "E or W")
        return math.radians(angle_deg if side == "E" else -angle_deg)

    def time_of_day_s(self, k: int) -> float:
        """Seconds since midnight; 60 s are allowed for a leap second."""
        text = self.text(k)
        if not text:
            return math.nan
        match = _CLOCK(text)
        if match is None:
            return self._fault("field", k, "hhmmss")
        hour, minute, second = int(match[1]), int(match[2]), float(match[3])
        if not (hour < 24 and minute < 60 and second < 61):
            return self._fault("range", k, "a time of day")
        return 3600.0 * hour + 60.0 * minute + second

    def day(self, k: int) -> float:
        """Days since 1970 of a date ddmmyy."""
        text = self.text(k)
        if not text:
            return math.nan
        match = _DATE(text)
        if match is None:
            return self._fault("field", k, "ddmmyy")
        day, month, year = map(int, match.groups())
        return self._day(k, year + (1900 if year >= _FIRST_YEAR else 2000), month, day)

    def day_in_fields(self, k: int) -> float:
        """Days since 1970 of day, month and year of four digits in three fields."""
        day, month = self.whole_number(k, 0, 99), self.whole_number(k + 1, 0, 99)
        year = self.whole_number(k + 2, _GPS_YEAR, 9999)
        if math.isnan(day + month + year):
            return math.nan
        return self._day(k, int(year), int(month), int(day))

    def place_deg(self, k: int) -> tuple[float, float]:
        """Latitude and longitude of four fields: ddmm.mm, N or S, dddmm.mm, E or W."""
        return (
            self._degrees(k, _LATITUDE, "ddmm.mm", "NS", 90.0),
            self._degrees(k + 2, _LONGITUDE, "dddmm.mm", "EW", 180.0),
        )

    def _degrees(self, k: int, form, wanted: str, sides: str, limit_deg: float) -> float:
        text, side = self.text(k), self.letter(k + 1, sides)
        if not text:
            return math.nan
        match = form(text)
        if match is None:
            return self._fault("field", k, wanted)
        if not side:
            return self._fault("field", k + 1, " or ".join(sides))
        minutes = float(match[2])
        if minutes >= 60.0:
            return self._fault("range", k, "minutes below 60")
        value = self._within(int(match[1]) + minutes / 60.0, k, 0.0, limit_deg)
        return value if side == sides[0] else -value

    def _day(self, k: int, year: int, month: int, day: int) -> float:
        try:
            return float(datetime.date(year, month, day).toordinal() - _DAY_0)
        except ValueError:
            return self._fault("range", k, "a date")

    def _within(self, value: float, k: int, low: float, high: float) -> float:
        return value if low <= value <= high else self._fault("range", k, f"{low:g} to {high:g}")

    def _fault(self, kind: str, k: int, wanted: str) -> float:
        written = self._written.split(",")[k].strip() if self.text(k) else ""
        self.faults.append((kind, f"{self.kind} field {k + 1}: wanted {wanted}, {_got(written)}"))
        return math.nan


def sentences(octets: bytes, report: NmeaReport) -> list[Sentence]:
    """The valid sentences of the kinds in `FIELDS`, in order; problems are added to `report`.

    A sentence begins at ``$`` (one of another kind also at ``!``) and ends with its line or where
    the next one begins; text before it in the line, such as a time stamp or a TAG block, is
    skipped. The octets between ``$`` and the last ``*`` must match the checksum that follows, if
    there is one; a sentence without a checksum is cut if others of its kind have one.

    Parameters
    ----------
    octets : bytes
        The log.
    report : NmeaReport
    """
    found: list[Sentence] = []
    unchecked: list[tuple[int, str, bytes]] = []
    with_checksum: set[str] = set()
    lines = _LINE_END.split(octets)
    report.lines = len(lines) - (lines[-1] == b"")
    for line, text in enumerate(lines, 1):
        pieces = _PIECE.findall(text)
        if not pieces and text.strip():
            report.add(line, "no sentence", f"wanted a sentence that begins with $, {_got(text)}")
        for piece in pieces:
            fault = _unsound(piece)
            if fault is not None:
                report.add(line, *fault)
                continue
            star = piece.rfind(b"*")
            kind, body = _parted(piece[1:] if star < 0 else piece[1:star])
            if star < 0:
                unchecked.append((line, kind, body))
                continue
            with_checksum.add(kind)
            report.sentences[kind] += 1
            if kind in FIELDS:
                found.append(Sentence(line, kind, body.decode("ascii")))
    found += _whole(unchecked, with_checksum, report)
    return sorted(found, key=lambda sentence: sentence.line)


def _whole(
    unchecked: list[tuple[int, str, bytes]], with_checksum: set[str], report: NmeaReport
) -> Iterator[Sentence]:
    """Sentences without a checksum that seem to be whole."""
    for line, kind, body in unchecked:
        if kind in with_checksum:
            report.add(line, "cut", f"{kind} has no checksum although others of the file have one")
            continue
        count = body.count(b",") + 1
        if count < FIELDS.get(kind, 0):
            report.add(line, "cut", f"{kind}: wanted {FIELDS[kind]} fields or more, got {count}")
            continue
        report.sentences[kind] += 1
        if kind in FIELDS:
            yield Sentence(line, kind, body.decode("ascii"))


def _unsound(piece: bytes) -> tuple[str, str] | None:
    """Kind and reason of a fault in the octets of a sentence."""
    star = piece.rfind(b"*")
    body = piece[1:] if star < 0 else piece[1:star]
    digits = piece[star + 1 : star + 3].rstrip()
    if star >= 0 and len(digits) == 2 and _CHECKSUM.get(digits.upper()) != reduce(xor, body, 0):
        return "checksum", f"wanted {reduce(xor, body, 0):02X}, {_got(piece)}"
    if body.rstrip().translate(None, _PRINTABLE):
        return "character", f"wanted printable ASCII, {_got(piece)}"
    if star >= 0 and len(digits) < 2:
        return "cut", f"wanted two digits after *, {_got(piece)}"
    if star < 0 and b"," not in body:
        return "cut", f"wanted fields or a checksum, {_got(piece)}"
    address = body.partition(b",")[0].strip()
    if not (address.isalnum() and len(address) >= 3):
        return "address", f"wanted talker and kind, {_got(piece)}"
    if piece[:1] == b"!" and _parted(body)[0] in FIELDS:
        return "address", f"wanted $ at the start, {_got(piece)}"
    return None


def _parted(body: bytes) -> tuple[str, bytes]:
    """The letters after the talker, or the whole address of a proprietary sentence; and fields."""
    address, _, fields = body.rstrip().partition(b",")
    text = address.decode("ascii").strip().upper()
    return (text[2:] if len(text) == 5 and text[0] != "P" else text), fields


def _got(text: str | bytes) -> str:
    if not text:
        return "got an empty field"
    shown = text if isinstance(text, str) else text.rstrip().decode("latin-1")
    return f"got {shown[:100]!r}"
