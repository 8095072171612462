"""One sentence: its place in a line, its validity, and its fields."""

from __future__ import annotations

import datetime
import math
import re
from collections.abc import Iterator, Sequence
from functools import reduce
from operator import xor

from wakeline._brief import quoted

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
# Where sentences say how their values came about: quality of GGA, mode of all others.
MODE_FIELD = {"GGA": 5, "GNS": 5, "RMC": 11, "GLL": 6, "VTG": 8, "THS": 1}

_LINE_END = re.compile(rb"\r*\n|\r")
_PIECE = re.compile(rb"[$!][^$\\\r\n]*")
_CHECKSUM = {b"%02X" % value: value for value in range(256)}
_PRINTABLE = bytes(range(0x20, 0x7F))
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)").fullmatch
_PACKED = re.compile(r"\d+(?:\.\d*)?").fullmatch
_DAY_0 = datetime.date(1970, 1, 1).toordinal()
_GPS_YEAR = 1980
_FIRST_YEAR = 80  # two-digit years from here on are of the last century


class Sentence:
    """A valid sentence and its fields, counted from 0 after the address.

    Every reader returns NaN for an empty field, and for one that cannot be read, which is added to
    `faults`. Times, dates and positions may lack leading zeros, except in the last field, which may
    be cut.

    Parameters
    ----------
    line : int
    address : str
        Talker and kind, such as ``GPRMC``.
    kind : str
        The three letters after the talker.
    body : str
        Fields separated by commas.
    """

    __slots__ = ("_written", "address", "faults", "fields", "kind", "line")

    def __init__(self, line: int, address: str, kind: str, body: str) -> None:
        self.line = line
        self.address = address
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
        """An angle in degrees, as radians positive east.

        The next field is E or W; with a sign it is E or empty.
        """
        signed = self.text(k)[:1] in ("+", "-")
        angle_deg = self.number(k, -180.0 if signed else 0.0, 180.0)
        side = self.letter(k + 1, "EW")
        if math.isnan(angle_deg):
            return math.nan
        if signed and side == "W":
            return self._fault("field", k, "no sign beside W")
        if not (side or signed):
            return self._fault("field", k + 1, "E or W")
        return math.radians(-angle_deg if side == "W" else angle_deg)

    def time_of_day_s(self, k: int) -> float:
        """Seconds since midnight; 60 s are allowed for a leap second."""
        packed = self._packed(k, 6, "hhmmss")
        if not packed:
            return math.nan
        hour, minute, second = int(packed[:2]), int(packed[2:4]), float(packed[4:])
        if not (hour < 24 and minute < 60 and second < 61):
            return self._fault("range", k, "a time of day")
        return 3600.0 * hour + 60.0 * minute + second

    def day(self, k: int) -> float:
        """Days since 1970 of a date ddmmyy."""
        packed = self._packed(k, 6, "ddmmyy")
        if not packed:
            return math.nan
        day, month, year = int(packed[:2]), int(packed[2:4]), int(packed[4:6])
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
            self._degrees(k, "ddmm.mm", "NS", 90.0),
            self._degrees(k + 2, "dddmm.mm", "EW", 180.0),
        )

    def _degrees(self, k: int, form: str, sides: str, limit_deg: float) -> float:
        """Degrees and minutes; the two digits before the point are minutes, which may be 60."""
        width = form.index(".")
        packed, side = self._packed(k, width, form), self.letter(k + 1, sides)
        if not packed:
            return math.nan
        if not side:
            return self._fault("field", k + 1, " or ".join(sides))
        degrees, minutes = int(packed[: width - 2]), float(packed[width - 2 :])
        if minutes > 60.0:
            return self._fault("range", k, "minutes up to 60")
        value = self._within(degrees + minutes / 60.0, k, 0.0, limit_deg)
        return value if side == sides[0] else -value

    def _packed(self, k: int, width: int, form: str) -> str:
        """A number of `width` digits before its point, completed where leading zeros are left out.

        '' if it is empty or cannot be read.
        """
        text = self.text(k)
        missing = width - len(text.partition(".")[0])
        whole = missing == 0 or (missing > 0 and k + 1 < len(self.fields))
        if text and not (whole and _PACKED(text)):
            self._fault("field", k, form)
            return ""
        return text and text.rjust(len(text) + missing, "0")

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


def lines_of(octets: bytes) -> list[bytes]:
    """The lines of a log."""
    lines = _LINE_END.split(octets)
    return lines[:-1] if lines[-1] == b"" else lines


def sentences(lines: Sequence[bytes], report: NmeaReport) -> list[Sentence]:
    """The valid sentences of the kinds in `FIELDS`, in order; problems are added to `report`.

    A sentence begins at ``$`` (one of another kind also at ``!``) and ends with its line or where
    the next one begins; text before it in the line, such as a time stamp or a TAG block, is
    skipped. The octets between ``$`` and the last ``*`` must match the checksum that follows, if
    there is one; a sentence without a checksum is cut if others of its kind have one.

    Parameters
    ----------
    lines : sequence of bytes
        The lines of the log.
    report : NmeaReport
    """
    found: list[Sentence] = []
    unchecked: list[tuple[int, str, str, bytes]] = []
    with_checksum: set[str] = set()
    report.lines = len(lines)
    for line, text in enumerate(lines, 1):
        for piece, fault in pieces_of(text):
            if fault is not None:
                report.add(line, *fault)
                continue
            address, kind, body = parted(piece)
            if b"*" not in piece:
                unchecked.append((line, address, kind, body))
                continue
            with_checksum.add(kind)
            report.sentences[kind] += 1
            if kind in FIELDS:
                found.append(Sentence(line, address, kind, body.decode("ascii")))
    found += _whole(unchecked, with_checksum, report)
    return sorted(found, key=lambda sentence: sentence.line)


def _whole(
    unchecked: list[tuple[int, str, str, bytes]], with_checksum: set[str], report: NmeaReport
) -> Iterator[Sentence]:
    """Sentences without a checksum that seem to be whole."""
    for line, address, kind, body in unchecked:
        if kind in with_checksum:
            report.add(line, "cut", f"{kind} has no checksum although others of the file have one")
            continue
        count = body.count(b",") + 1
        if count < FIELDS.get(kind, 0):
            report.add(line, "cut", f"{kind}: wanted {FIELDS[kind]} fields or more, got {count}")
            continue
        report.sentences[kind] += 1
        if kind in FIELDS:
            yield Sentence(line, address, kind, body.decode("ascii"))


def pieces_of(text: bytes) -> Iterator[tuple[bytes, tuple[str, str] | None]]:
    """Each sentence in a line with the kind and reason of its fault, None if it is valid."""
    pieces = _PIECE.findall(text)
    if not pieces and text.strip():
        yield text, ("no sentence", f"wanted a sentence that begins with $, {_got(text)}")
    for piece in pieces:
        yield piece, _unsound(piece)


def parted(piece: bytes) -> tuple[str, str, bytes]:
    """Address, kind and fields of a valid sentence, without its checksum."""
    star = piece.rfind(b"*")
    return _parted(piece[1:] if star < 0 else piece[1:star])


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
    if piece[:1] == b"!" and _parted(body)[1] in FIELDS:
        return "address", f"wanted $ at the start, {_got(piece)}"
    return None


def _parted(body: bytes) -> tuple[str, str, bytes]:
    """The address, its letters after the talker (all of a proprietary one), and the fields."""
    address, _, fields = body.rstrip().partition(b",")
    text = address.decode("ascii").strip().upper()
    return text, (text[2:] if len(text) == 5 and text[0] != "P" else text), fields


def _got(text: str | bytes) -> str:
    if not text:
        return "got an empty field"
    shown = text if isinstance(text, str) else text.rstrip().decode("latin-1")
    return f"got {quoted(shown)}"
