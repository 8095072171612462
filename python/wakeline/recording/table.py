"""A CSV file as named columns, each cell traceable to its line."""

from __future__ import annotations

import csv
import datetime
import itertools
import math
import re
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial, wraps
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import numpy as np

from wakeline._brief import cut, many

from .containers import instead_of_text, octets_of
from .errors import RecordingError

TIME_NAMES = ("time_s", "time", "timestamp", "timestamp_s", "time_utc", "utc", "datetime")
TIME_WANTED = "UTC seconds or ISO 8601 text such as 2021-05-04T07:54:53.034Z"

_P = ParamSpec("_P")
_R = TypeVar("_R")
_FARTHEST_M = 1e9
_FASTEST_MPS = 1e6
_LATEST_S = 1e11  # year 5138; a later time is in another unit
_YEAR_S = 366 * 86400.0
MOST_BAD = 0.1  # share of the rows

_SEPARATORS = ",;\t|"
_PREAMBLE = 50  # lines among which the header is
_MISSING = frozenset(("", "na", "n/a", "#n/a", "nan", "null", "none", "nil", "-", "--", r"\n"))


_CLOCK = r"[T ]+(\d{1,2}):(\d{2})(?::(\d{2}))?(?:[.,](\d+))?\s*([AP]M)?"
_ZONE = r"\s*(Z|UTC|GMT|[+-](?:[01]\d|2[0-3])(?::?[0-5]\d)?(?: UTC| GMT)?)?"
_YEAR_FIRST = re.compile(rf"(\d{{4}})([-/.])(\d{{1,2}})\2(\d{{1,2}}){_CLOCK}{_ZONE}", re.IGNORECASE)
_YEAR_LAST = re.compile(rf"(\d{{1,2}})([-/.])(\d{{1,2}})\2(\d{{4}}){_CLOCK}{_ZONE}", re.IGNORECASE)
_LINE_END = re.compile(r"\r\n|\r|\n")


class ColumnNames(dict[str, str]):
    """Names of columns in some files and what they are; each is to be in one of the files."""

    def __init__(self, names: Mapping[str, str] | None = None) -> None:
        super().__init__(names or {})
        self._read: list[Path] = []
        self._headers: dict[str, str] = {}
        self._meanings: set[str] = set()

    def note(
        self, path: Path, header: Sequence[str], meanings: Mapping[str, Sequence[str]]
    ) -> None:
        """Note what a file has and what its columns may be."""
        self._read.append(path)
        self._headers |= {_plain(name): name for name in header}
        for column, names in meanings.items():
            self._meanings |= {_plain(column), *map(_plain, names)}

    def require_found(self) -> None:
        """Raise RecordingError for a name that no file has, and for what no column is."""
        for name, ours in self.items() if self._read else ():
            if _plain(name) not in self._headers:
                got = cut(", ".join(self._headers.values()))
                raise RecordingError(self._read[0], "a column is missing", wanted=name, got=got)
            if _plain(ours) not in self._meanings:
                wanted = ", ".join(sorted(self._meanings))
                raise RecordingError(
                    self._read[0], "there is no such meaning", column=name, wanted=wanted, got=ours
                )


def finding_columns(read: Callable[_P, _R]) -> Callable[_P, _R]:
    """Has a function that reads files reject names in `columns` that none of them has.

    The names of a `ColumnNames` may be in other files, which its owner reads.
    """

    @wraps(read)
    def checked(*args: _P.args, **kwargs: _P.kwargs) -> _R:
        columns = kwargs.get("columns")
        if isinstance(columns, ColumnNames):
            return read(*args, **kwargs)
        names = kwargs["columns"] = ColumnNames(columns)
        result = read(*args, **kwargs)
        names.require_found()
        return result

    return checked


class Table:
    """Columns of text read from a CSV file with one header line.

    Columns are separated by commas, or by semicolons, tabs or bars where the header has these; with
    another separator than the comma numbers may have a decimal comma. A byte-order mark, CRLF line
    ends, blank lines, lines of empty cells, lines that begin with ``#``, lines above the header,
    repeated headers, empty cells beyond the header, and spaces around cells are ignored. Column
    names are compared in lower case with every run of other characters as one underscore, so
    ``Range [m]`` is ``range_m``.

    **Rows that cannot be read** are marked: a row with more or fewer cells than the header, or with
    an invalid cell. :meth:`kept` leaves them out and notes their number and the first of them. A
    last row that is cut off is left out as well. Text that is not UTF-8 is
    read as Latin-1.

    Parameters
    ----------
    path : str or Path
        The file, or one that is compressed by gzip, bzip2 or xz.
    meanings : dict of str to sequence of str
        For each column the names that a file may use. Other columns are ignored.
    notes : list of str, optional
        Notes are added to it. Without it the first row that cannot be read is an error.
    columns : dict of str to str, optional
        Names of columns in this file and what they are: one of the names in `meanings`.

    Raises
    ------
    RecordingError
        When the file cannot be read or is empty or not text, two columns have the same meaning, or
        more than a tenth of the rows do not fit the header.
    """

    def __init__(
        self,
        path: str | Path,
        meanings: Mapping[str, Sequence[str]],
        notes: list[str] | None = None,
        columns: Mapping[str, str] | None = None,
    ) -> None:
        self.path = Path(path)
        self._meanings = meanings
        self._most_bad = 0.0 if notes is None else MOST_BAD
        self._notes = [] if notes is None else notes
        lines = _lines(self.path, self._notes)
        meaning = {_plain(name): column for column, names in meanings.items() for name in names}
        meaning |= dict(zip(meanings, meanings, strict=True))
        renamed = {
            _plain(name): meaning[_plain(ours)]
            for name, ours in (columns or {}).items()
            if _plain(ours) in meaning
        }
        first, self._separator, self.header = _header(lines, meaning | renamed)
        self._number = _number if self._separator == "," else _number_with_comma
        if not self.header:
            raise RecordingError(self.path, "the file is empty", line=1, wanted="a header line")
        if isinstance(columns, ColumnNames):
            columns.note(self.path, self.header, meanings)
        self._header_line = first + 1
        self._place = self._recognise(meaning | renamed)
        self._bad: dict[int, RecordingError] = {}
        self._misfits: list[RecordingError] = []
        self._line, cells = self._body(lines, first + 1)
        self._cells = dict(enumerate(zip(*cells, strict=True)))
        self._check_share()

    def __len__(self) -> int:
        return len(self._line)

    def __contains__(self, column: str) -> bool:
        return column in self._place

    def line(self, row: int) -> int:
        """Line of the file with `row`."""
        return int(self._line[row])

    def require(self, *columns: str) -> None:
        """Raise RecordingError unless the file has each of `columns`."""
        for column in columns:
            if column not in self:
                raise RecordingError(
                    self.path,
                    "a column is missing",
                    line=self._header_line,
                    column=column,
                    wanted=f"{' or '.join(self._meanings[column])}; name others with columns",
                    got=cut(", ".join(self.header)),
                )

    def name(self, column: str) -> str:
        """Name of `column` in the file."""
        return self.header[self._place[column]]

    @property
    def columns(self) -> list[str]:
        """The known columns of the file."""
        return list(self._place)

    def unknown(self) -> list[str]:
        """Names of the columns without a known meaning."""
        known = set(self._place.values())
        return [name for k, name in enumerate(self.header) if k not in known and name]

    def text(self, column: str) -> list[str]:
        """Cells of a column without the spaces around them."""
        return [cell.strip() for cell in self._cells.get(self._place[column], ())]

    def numbers(self, column: str) -> np.ndarray:
        """Cells of a column as floats (n,); NaN where empty, such as ``NA``, or invalid."""
        return self._parsed(column, self._number, "a number")

    def ways_m(self, column: str, metres: float = 1.0) -> np.ndarray:
        """Cells of a column in a unit of given length as metres (n,); NaN as in `numbers`."""
        return metres * self._at_most(_FARTHEST_M / metres, column, "at most 1e9 m")

    def speeds_mps(self, column: str) -> np.ndarray:
        """Cells of a column as metres a second (n,); NaN as in `numbers`."""
        return self._at_most(_FASTEST_MPS, column, "at most 1e6 m/s")

    def whole_numbers(self, column: str) -> np.ndarray:
        """Cells of a column as integers (n,); 0 where invalid."""
        values = self.numbers(column)
        with np.errstate(invalid="ignore"):
            whole = (np.abs(values) < 2**53) & (values == np.rint(values))
        self.check(column, whole, "a whole number")
        return np.where(whole, values, 0).astype(np.int64)

    def times(self, column: str) -> np.ndarray:
        """Cells of a column as UTC seconds (n,), from numbers or text; NaN where invalid.

        Numbers are seconds, or with a note milliseconds and the like, where half of them would be
        after the year 5138. Text is ISO 8601 or a date with the year last: day first, unless only
        month first fits, or spans less time. A time without a zone is UTC. A time more than a year
        from all others is invalid, unless a tenth of the rows or more are.
        """
        parse = partial(_time_s, number=self._number, day_first=self._day_first(column))
        values = self._in_seconds(self._parsed(column, parse, TIME_WANTED))
        self.check(column, np.isfinite(values), TIME_WANTED)
        good = ~(np.abs(values) >= _LATEST_S)
        self.check(column, good, f"{TIME_WANTED}, not milliseconds")
        values = np.where(good, values, np.nan)
        self.check(column, ~_astray(values), "a time within a year of the others")
        return values

    def check(self, column: str, good: np.ndarray, wanted: str) -> None:
        """Mark the rows of a column that are not `good` (n,)."""
        for row in np.flatnonzero(~np.asarray(good, dtype=bool)).tolist():
            if row not in self._bad:
                self._bad[row] = self.error(row, column, wanted)
                if not self._most_bad:
                    raise self._bad[row]

    def reject(self, rows: np.ndarray, column: str, wanted: str, problem: str) -> None:
        """Mark rows for a problem of theirs beside other rows."""
        for row in rows.tolist():
            self._bad.setdefault(row, self.error(row, column, wanted, problem=problem))

    def kept(self) -> np.ndarray:
        """Mask (n,) of the rows that are not marked; a note says how many are left out.

        Raises
        ------
        RecordingError
            The first problem, when more than a tenth of the rows are marked.
        """
        self._check_share()
        bad = [*self._misfits, *self._bad.values()]
        if bad:
            first = min(bad, key=lambda error: error.line)
            self._notes.append(
                f"{self.path.name}: {many(len(bad), 'row')} that cannot be read left out "
                f"(first: {first.place_and_reason})"
            )
        return self.sound

    @property
    def sound(self) -> np.ndarray:
        """Mask (n,) of the rows that are not marked until now."""
        sound = np.ones(len(self), dtype=bool)
        sound[list(self._bad)] = False
        return sound

    def error(
        self, row: int, column: str, wanted: str, *, problem: str = "a cell cannot be read"
    ) -> RecordingError:
        """The error for an invalid cell."""
        cell = self._cells[self._place[column]][row].strip()
        return RecordingError(
            self.path,
            problem,
            line=self.line(row),
            column=self.name(column),
            wanted=wanted,
            got=repr(cell[:80]) if cell else "an empty cell",
        )

    def _check_share(self) -> None:
        bad = [*self._misfits, *self._bad.values()]
        rows = len(self) + len(self._misfits)
        if len(bad) > self._most_bad * rows:
            raise bad[0].remarked(f"{len(bad)} of {many(rows, 'row')}") if len(bad) > 1 else bad[0]

    def _at_most(self, most: float, column: str, wanted: str) -> np.ndarray:
        """Cells of a column as floats (n,); finite ones are at most `most` in magnitude."""
        values = self.numbers(column)
        good = ~(np.isfinite(values) & (np.abs(values) > most))
        self.check(column, good, wanted)
        return np.where(good, values, np.nan)

    def _recognise(self, meaning: Mapping[str, str]) -> dict[str, int]:
        """Index of each known column."""
        place: dict[str, int] = {}
        for k, name in enumerate(self.header):
            column = meaning.get(_plain(name))
            if column is None:
                continue
            if column in place:
                raise RecordingError(
                    self.path,
                    "a column is repeated",
                    line=self._header_line,
                    column=name,
                    wanted=f"one column for {column}",
                    got=f"{cut(self.header[place[column]])} and {cut(name)}",
                )
            place[column] = k
        return place

    def _body(self, lines: list[str], first: int) -> tuple[np.ndarray, list[list[str]]]:
        """Line numbers and cells of the rows below the header."""
        numbers, rows = [], []
        last = max((k for k, line in enumerate(lines, start=1) if line.strip()), default=0)
        width, header, blank = len(self.header), lines[first - 1], f"{self._separator} \t"
        for number, line in enumerate(itertools.islice(lines, first, None), start=first + 1):
            row = _cells(line, self._separator)
            if len(row) != width:
                row = self._fitted(row)
            if not line.strip(blank) or line == header:
                continue
            if len(row) == width:
                numbers.append(number)
                rows.append(row)
            elif line.startswith("#"):
                continue
            elif number == last and len(row) < width and rows and self._most_bad:
                self._notes.append(
                    f"{self.path.name}: the last row is cut off and left out (line {number})"
                )
            else:
                self._misfits.append(
                    RecordingError(
                        self.path,
                        "a row does not fit the header",
                        line=number,
                        wanted=many(width, "cell"),
                        got=str(len(row)),
                    )
                )
        return np.array(numbers, dtype=np.int64), rows

    def _fitted(self, row: list[str]) -> list[str]:
        """The row with as many cells as the header, if those beyond either are empty."""
        width = len(self.header)
        while len(row) > width and not row[-1].strip():
            row = row[:-1]
        if len(row) < width and not any(self.header[len(row) :]):
            row = row + [""] * (width - len(row))
        return row

    def _parsed(self, column: str, parse: Callable[[str], float], wanted: str) -> np.ndarray:
        cells = self._cells.get(self._place[column], ())
        try:
            return np.array(list(map(parse, cells)), dtype=float)
        except (ValueError, OverflowError):
            values = [_tried(parse, cell) for cell in cells]
        self.check(column, np.array([value is not None for value in values]), wanted)
        return np.array([math.nan if value is None else value for value in values])

    def _day_first(self, column: str) -> bool:
        """Whether dates with the year last begin with the day."""
        cells = self._cells.get(self._place[column], ())
        dates = [match for match in map(_YEAR_LAST.fullmatch, map(str.strip, cells)) if match]
        first, second = (sum(int(match[k]) > 12 for match in dates) for k in (1, 3))
        if not dates or first or second or any(match[2] == "." for match in dates):
            return first >= second
        if any(match[9] for match in dates):  # AM or PM
            return False
        spans_s = []
        for day_first in (True, False):
            read = [_tried(partial(_date_s, day_first=day_first), match) for match in dates]
            spans_s.append(np.ptp([time_s or 0.0 for time_s in read]))
        order = "day" if spans_s[0] <= spans_s[1] else "month"
        self._notes.append(f"{self.path.name}: dates such as {dates[0][0]} are read {order} first")
        return order == "day"

    def _in_seconds(self, values: np.ndarray) -> np.ndarray:
        """Times in seconds, from numbers of milliseconds, microseconds or nanoseconds as well."""
        known = np.abs(values[np.isfinite(values)])
        usual = float(np.median(known)) if len(known) else 0.0
        for unit, per_second in (("milli", 1e3), ("micro", 1e6), ("nano", 1e9)):
            if _LATEST_S <= usual < _LATEST_S * per_second:
                self._notes.append(f"{self.path.name}: times are read as {unit}seconds")
                return values / per_second
        return values


def _lines(path: Path, notes: list[str]) -> list[str]:
    """The lines of a text file."""
    octets = octets_of(path)
    instead = instead_of_text(octets)
    if instead:
        wanted = "a table as text (CSV), or where there may be radar video ASTERIX category 240"
        raise RecordingError(path, "the file cannot be read", wanted=wanted, got=instead)
    try:
        text = octets.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        text = octets.decode("latin-1")
        line = 1 + len(_LINE_END.findall(text, 0, error.start))
        notes.append(
            f"{path.name}: not UTF-8 (octet 0x{octets[error.start]:02x} in line {line}), read as "
            "Latin-1"
        )
    return _LINE_END.split(text)


def _header(lines: list[str], meaning: Mapping[str, str]) -> tuple[int, str, list[str]]:
    """Index of the header line, the separator, and the names.

    The header is the line near the top with most known names, else the first line with text.
    """
    best, found = (-1, False, 0), (0, ",", [])
    for k, line in enumerate(lines[:_PREAMBLE]):
        for separator in _SEPARATORS if line.strip() else "":
            names = [name.strip() for name in _cells(line, separator)]
            known = sum(_plain(name) in meaning for name in names)
            rank = (known, not line.startswith("#"), 0 if known or k else len(names))
            if rank > best:
                best, found = rank, (k, separator, names)
    return found


def _cells(line: str, separator: str) -> list[str]:
    """The cells of a line; where quotes are not those of CSV they are part of the cell."""
    if '"' not in line:
        return line.split(separator)
    try:
        plain = _spaces_after_quotes(separator).sub(r"\1\2", line)
        rows = csv.reader([plain], delimiter=separator, skipinitialspace=True, strict=True)
        return next(rows)
    except csv.Error:
        return line.split(separator)


@cache
def _spaces_after_quotes(separator: str) -> re.Pattern[str]:
    end = re.escape(separator)
    return re.compile(rf'( *"(?:[^"]|"")*")[ \t]*(?={end}|$)|([^{end}]+)')


def is_missing(cell: str) -> bool:
    """Whether a cell is empty or a word for a missing value."""
    return cell.strip().lower() in _MISSING


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")


def _tried(parse: Callable[[Any], float], cell: Any) -> float | None:
    try:
        return parse(cell)
    except (ValueError, OverflowError):
        return None


def _number(cell: str) -> float:
    try:
        if "_" not in cell:
            return float(cell)
    except ValueError:
        if is_missing(cell):
            return math.nan
    raise ValueError(cell)


def _number_with_comma(cell: str) -> float:
    return _number(cell.replace(",", ".") if cell.count(",") == 1 and "." not in cell else cell)


def _time_s(cell: str, *, number: Callable[[str], float], day_first: bool) -> float:
    """UTC seconds from a number or from a date and time; text without a zone is UTC.

    A leap second, 60, is the second after it.
    """
    try:
        return number(cell)
    except ValueError:
        match = _YEAR_FIRST.fullmatch(cell.strip()) or _YEAR_LAST.fullmatch(cell.strip())
    if match is None:
        raise ValueError(cell)
    return _date_s(match, day_first)


def _date_s(match: re.Match[str], day_first: bool) -> float:
    one, _, two, three, hour, minute, second, fraction, half, zone = match.groups()
    if match.re is _YEAR_FIRST:
        year, month, day = one, two, three
    else:
        (day, month), year = ((one, two) if day_first else (two, one)), three
    hours, second_s = int(hour), int(second or 0) + float(f"0.{fraction or 0}")
    if half:
        hours = hours % 12 + 12 * (half.upper() == "PM")
    if hours > 23 or int(minute) > 59 or second_s >= 61.0:
        raise ValueError(match[0])
    day_s = _day_s(int(year), int(month), int(day))
    return day_s + 3600.0 * hours + 60.0 * int(minute) + second_s - _zone_offset_s(zone)


@cache
def _day_s(year: int, month: int, day: int) -> float:
    return 86400.0 * (datetime.date(year, month, day).toordinal() - 719163)  # 1970-01-01


def _zone_offset_s(zone: str | None) -> float:
    if zone is None or zone[0] not in "+-":
        return 0.0
    sign = -1.0 if zone[0] == "-" else 1.0
    digits = re.sub(r"\D", "", zone).ljust(4, "0")
    return sign * (3600.0 * int(digits[:2]) + 60.0 * int(digits[2:]))


def _astray(values: np.ndarray) -> np.ndarray:
    """Mask (n,) of the times more than a year from all others, if they are few."""
    order = np.argsort(values)  # NaN last
    cuts = np.flatnonzero(np.diff(values[order]) > _YEAR_S) + 1
    astray = np.zeros(len(values), dtype=bool)
    if len(cuts):
        parts = np.split(order, cuts)
        astray[order] = True
        astray[max(parts, key=len)] = False
        astray &= np.isfinite(values)
    return astray & (astray.sum() <= MOST_BAD * len(values))
