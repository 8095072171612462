"""Times written beside sentences: TAG blocks, stamps of a logger, columns of a recorder."""

from __future__ import annotations

import datetime
import math
import re
from collections.abc import Callable, Iterable
from functools import reduce
from operator import xor
from typing import NamedTuple

import numpy as np

DAY_S = 86400.0

_SENTENCE = re.compile(rb"[$!][^$\\\r\n]*")
_TAG = re.compile(r"\\([^\\]*)\*([0-9A-Fa-f]{2})\\")
_TAG_TIME = re.compile(r"(?:^|,)c:(\d+(?:\.\d+)?)(?:,|$)")
_CLOCK = r"(\d{1,2}):(\d\d):(\d\d(?:[.,]\d+)?)"
_ZONE = r"\s*(Z|UTC|GMT|[+-]\d\d:?\d\d)?"
_AFTER_DATE = rf"(?:[T_ ,;]|\s)\s*{_CLOCK}{_ZONE}"
_YEAR_FIRST = re.compile(r"(\d{4})[-/.](\d\d)[-/.](\d\d)" + _AFTER_DATE, re.IGNORECASE)
_YEAR_LAST = re.compile(r"(\d{1,2})[-/.](\d{1,2})[-/.](\d{4})" + _AFTER_DATE, re.IGNORECASE)
_COMPACT = re.compile(
    r"(?<!\d)(\d{4})(\d\d)(\d\d)[T_ -]?(\d\d):?(\d\d):?(\d\d(?:[.,]\d+)?)(?!\d)" + _ZONE,
    re.IGNORECASE,
)
_SINCE_1970 = re.compile(r"(?<![\d.])(\d{9,10}(?:\.\d+)?|\d{13}(?:\.\d+)?|\d{16}|\d{19})(?![\d.])")
_TIME_OF_DAY = re.compile(rf"(?<![\d:]){_CLOCK}(?![\d:])")
_SINCE_START = re.compile(r"^[\s\"'\[(]*(\d{1,7}\.\d+)(?:[\s\"'\]),;]|$)")
_LEAST_SHARE = 0.05
_EPOCHS_PER_S = {9: 1.0, 10: 1.0, 13: 1e3, 16: 1e6, 19: 1e9}


class Beside(NamedTuple):
    """Times beside the sentences of a log, in order of lines.

    Attributes
    ----------
    line : ndarray of int (n,)
    time_s : ndarray (n,)
        UTC seconds; since some midnight if not `dated`.
    dated : bool
        Whether they have a date.
    utc : bool
        Whether they state that they are in UTC.
    what : str
        What they are, in words.
    """

    line: np.ndarray
    time_s: np.ndarray
    dated: bool
    utc: bool
    what: str

    @property
    def advances(self) -> bool:
        """Whether they are more than one time, or the only one."""
        return len(np.unique(self.time_s)) > 1 or len(self.line) == 1

    def at(self, line: np.ndarray) -> np.ndarray:
        """Times (m,) beside the sentences of lines (m,), NaN where there is none."""
        k = np.minimum(np.searchsorted(self.line, line), len(self.line) - 1)
        return np.where(self.line[k] == line, self.time_s[k], np.nan)


def times_beside(lines: Iterable[bytes]) -> Beside | None:
    """The times beside the sentences of a log; None if fewer than 5 % of them have one.

    Of several forms the one of most lines counts.

    Parameters
    ----------
    lines : iterable of bytes
        The lines of the log.
    """
    found: dict[str, list[tuple[int, bytes, tuple]]] = {}
    count = 0
    for number, octets in enumerate(lines, 1):
        sentence = _SENTENCE.search(octets)
        if sentence is None:
            continue
        count += 1
        before, (_, star, after) = octets[: sentence.start()], sentence[0].rpartition(b"*")
        text = (before if before.strip() or not star else after[2:]).strip()
        if len(text) < 3:
            continue
        name, stamp = _stamp(text.decode("latin-1"))
        if stamp is not None:
            address = sentence[0].partition(b",")[0]
            found.setdefault(name, []).append((number, address, stamp))
    name = max(found, key=lambda name: len(found[name]), default=None)
    if name is None or len(found[name]) < _LEAST_SHARE * count:
        return None
    line, address, stamps = zip(*found[name], strict=True)
    time_s, utc = _FORMS[name].read(stamps)
    time_s = np.array(time_s, dtype=float)
    known = np.isfinite(time_s)
    if not known.any():
        return None
    line, address, time_s = np.array(line, dtype=np.int64), np.array(address), time_s[known]
    dated = name not in ("time of day", "since start")
    return Beside(line[known], _spread(time_s, address[known]), dated, utc, _FORMS[name].what)


def _spread(time_s: np.ndarray, address: np.ndarray) -> np.ndarray:
    """Times (n,), spread by lines where most sentences come several times at one time."""
    run = np.cumsum(np.append(True, np.diff(time_s) != 0)) - 1
    pairs = np.unique(np.char.add(address, run.astype("S10")))
    steps_s = np.diff(time_s)[np.diff(time_s) > 0]
    if 2 * len(pairs) > len(time_s) or len(steps_s) == 0:
        return time_s
    size = np.bincount(run)
    rank = np.arange(len(run)) - (np.cumsum(size) - size)[run]
    return time_s + np.median(steps_s) * rank / size[run]


def _stamp(text: str) -> tuple[str, tuple | None]:
    """Form and parts of the time in a text."""
    for name, form in _FORMS.items():
        parts = form.find(text)
        if parts is not None:
            return name, parts
    return "", None


def _tag(text: str) -> tuple | None:
    for block, digits in _TAG.findall(text):
        time = _TAG_TIME.search(block)
        if time and reduce(xor, block.encode("latin-1"), 0) == int(digits, 16):
            return (time[1],)
    return None


def _found(pattern: re.Pattern) -> Callable[[str], tuple | None]:
    def find(text: str) -> tuple | None:
        match = pattern.search(text)
        return match.groups() if match else None

    return find


def _since_1970(stamps: Iterable[tuple]) -> tuple[list[float], bool]:
    return [
        float(text) / _EPOCHS_PER_S.get(len(text.partition(".")[0]), 1.0) for (text,) in stamps
    ], True


def _year_first(stamps: Iterable[tuple]) -> tuple[list[float], bool]:
    stamps = list(stamps)
    return [_seconds(*stamp) for stamp in stamps], all(stamp[-1] for stamp in stamps)


def _year_last(stamps: Iterable[tuple]) -> tuple[list[float], bool]:
    """Day first, unless a second number is above 12."""
    stamps = list(stamps)
    month_first = any(int(second) > 12 for _, second, *_ in stamps)
    ordered = [
        (year, *((a, b) if month_first else (b, a)), *clock) for a, b, year, *clock in stamps
    ]
    return _year_first(ordered)


def _time_of_day(stamps: Iterable[tuple]) -> tuple[list[float], bool]:
    return [
        3600.0 * int(hour) + 60.0 * int(minute) + float(second.replace(",", "."))
        for hour, minute, second in stamps
    ], False


def _since_start(stamps: Iterable[tuple]) -> tuple[list[float], bool]:
    return [float(text) for (text,) in stamps], False


def _seconds(year, month, day, hour, minute, second, zone) -> float:
    """UTC seconds, NaN for an impossible date or time."""
    try:
        date = datetime.datetime(int(year), int(month), int(day), int(hour), int(minute))
    except ValueError:
        return math.nan
    offset_s = 0.0
    if zone and zone[0] in "+-":
        digits = zone.replace(":", "")
        offset_s = 3600.0 * int(digits[:3]) + 60.0 * int(digits[0] + digits[3:])
    midnight_s = date.replace(tzinfo=datetime.timezone.utc).timestamp()
    return midnight_s + float(second.replace(",", ".")) - offset_s


class _Form(NamedTuple):
    """How a form of stamp is found in a text and read, and what it is called."""

    find: Callable[[str], tuple | None]
    read: Callable[[Iterable[tuple]], tuple[list[float], bool]]
    what: str


_LOGGER = "stamps of the logger"
_FORMS = {
    "tag": _Form(_tag, _since_1970, "times of the TAG blocks"),
    "year first": _Form(_found(_YEAR_FIRST), _year_first, _LOGGER),
    "year last": _Form(_found(_YEAR_LAST), _year_last, _LOGGER),
    "compact": _Form(_found(_COMPACT), _year_first, _LOGGER),
    "since 1970": _Form(_found(_SINCE_1970), _since_1970, _LOGGER),
    "time of day": _Form(_found(_TIME_OF_DAY), _time_of_day, "times of day of the logger"),
    "since start": _Form(_found(_SINCE_START), _since_start, "seconds of the logger"),
}
