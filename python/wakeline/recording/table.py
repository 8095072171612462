"""A CSV file as named columns, each cell traceable to its line."""

from __future__ import annotations

import csv
import datetime
import io
import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np

from wakeline._brief import many

from .errors import RecordingError, octets_of
from .not_text import instead_of_text

TIME_NAMES = ("time_s", "time", "timestamp", "timestamp_s", "time_utc", "utc", "datetime")
TIME_WANTED = "UTC seconds or ISO 8601 text such as 2021-05-04T07:54:53.034Z"

_NOT_CSV = "the file is not CSV text in UTF-8"
_FARTHEST_M = 1e9
_FASTEST_MPS = 1e6
_LATEST_S = 1e11  # year 5138; a later time is in another unit

_ISO_TIME = re.compile(
    r"(\d{4}-\d{2}-\d{2})[T ](\d{2}:\d{2})(?::([0-5]\d|60))?(?:[.,](\d+))?\s*"
    r"(Z|[+-](?:[01]\d|2[0-3])(?::?[0-5]\d)?)?",
    re.IGNORECASE,
)
_LINE_END = re.compile(rb"\r\n|\r|\n")
_CELL = re.compile(r'( *"(?:[^"]|"")*")[ \t]*(?=[,\r\n]|$)|([^,]+)')


class Table:
    """Columns of text read from a CSV file with one header line.

    A byte-order mark, CRLF line ends, blank lines, lines of empty cells, and spaces around cells
    are ignored. Column names are compared in lower case with every run of other characters as one
    underscore, so ``Range [m]`` is ``range_m``.

    Parameters
    ----------
    path : str or Path
        The file.
    meanings : dict of str to sequence of str
        For each column the names that a file may use. Other columns are ignored.

    Raises
    ------
    RecordingError
        When the file cannot be read or is empty, its columns are not separated by commas, two
        columns have the same meaning, a quoted cell continues in the next line or after its closing
        quote, or a row has more or fewer cells than the header.
    """

    def __init__(self, path: str | Path, meanings: dict[str, Sequence[str]]) -> None:
        self.path = Path(path)
        self._meanings = meanings
        rows = _rows(self.path)
        _, header = next(rows, (0, []))
        if not header:
            raise RecordingError(self.path, "the file is empty", line=1, wanted="a header line")
        self.header = [name.strip() for name in header]
        if len(header) == 1 and re.search(r"[;\t|]", header[0]):
            raise RecordingError(
                self.path,
                "columns are not separated by commas",
                line=1,
                wanted="commas between columns and points in decimals",
                got=repr(header[0]),
            )
        self._place = self._recognise(self.header)
        self._line, cells = self._body(rows)
        self._cells = dict(zip(range(len(header)), zip(*cells, strict=True), strict=False))

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
                    line=1,
                    column=column,
                    wanted=" or ".join(self._meanings[column]),
                    got=", ".join(self.header),
                )

    def name(self, column: str) -> str:
        """Name of `column` in the file."""
        return self.header[self._place[column]]

    def text(self, column: str) -> list[str]:
        """Cells of a column without the spaces around them."""
        return [cell.strip() for cell in self._cells.get(self._place[column], ())]

    def numbers(self, column: str) -> np.ndarray:
        """Cells of a column as floats (n,); an empty cell is NaN."""
        return self._parsed(column, _number, "a number")

    def ways_m(self, column: str, metres: float = 1.0) -> np.ndarray:
        """Cells of a column in a unit of given length as metres (n,); an empty cell is NaN."""
        return metres * self._at_most(_FARTHEST_M / metres, column, "at most 1e9 m")

    def speeds_mps(self, column: str) -> np.ndarray:
        """Cells of a column as metres a second (n,); an empty cell is NaN."""
        return self._at_most(_FASTEST_MPS, column, "at most 1e6 m/s")

    def whole_numbers(self, column: str) -> np.ndarray:
        """Cells of a column as integers (n,)."""
        values = self.numbers(column)
        with np.errstate(invalid="ignore"):
            whole = (np.abs(values) < 2**53) & (values == np.rint(values))
        self.check(column, whole, "a whole number")
        return values.astype(np.int64)

    def times(self, column: str) -> np.ndarray:
        """Cells of a column as UTC seconds (n,), read from numbers or ISO 8601 text."""
        values = self._parsed(column, _time_s, TIME_WANTED)
        self.check(column, np.isfinite(values), TIME_WANTED)
        self.check(column, np.abs(values) < _LATEST_S, f"{TIME_WANTED}, not milliseconds")
        return values

    def check(self, column: str, good: np.ndarray, wanted: str) -> None:
        """Raise RecordingError at the first row of a column that is not `good` (n,)."""
        if not np.all(good):
            raise self.error(int(np.argmin(good)), column, wanted)

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
            got=repr(cell) if cell else "an empty cell",
        )

    def _at_most(self, most: float, column: str, wanted: str) -> np.ndarray:
        """Cells of a column as floats (n,); finite ones are at most `most` in magnitude."""
        values = self.numbers(column)
        self.check(column, ~(np.isfinite(values) & (np.abs(values) > most)), wanted)
        return values

    def _recognise(self, header: list[str]) -> dict[str, int]:
        """Index of each known column."""
        meaning = {name: column for column, names in self._meanings.items() for name in names}
        place: dict[str, int] = {}
        for k, name in enumerate(header):
            column = meaning.get(_plain(name))
            if column is None:
                continue
            if column in place:
                raise RecordingError(
                    self.path,
                    "a column is repeated",
                    line=1,
                    column=name,
                    wanted=f"one column for {column}",
                    got=f"{header[place[column]]} and {name}",
                )
            place[column] = k
        return place

    def _body(self, rows: Iterable[tuple[int, list[str]]]) -> tuple[np.ndarray, list[list[str]]]:
        """Line numbers and cells of the rows below the header."""
        lines, cells = [], []
        width = len(self.header)
        for line, row in rows:
            if len(row) != width:
                raise RecordingError(
                    self.path,
                    "a row does not fit the header",
                    line=line,
                    wanted=many(width, "cell"),
                    got=str(len(row)),
                )
            lines.append(line)
            cells.append(row)
        return np.array(lines, dtype=np.int64), cells

    def _parsed(self, column: str, parse: Callable[[str], float], wanted: str) -> np.ndarray:
        values: list[float] = []
        try:
            values.extend(map(parse, self._cells.get(self._place[column], ())))
        except (ValueError, OverflowError):
            raise self.error(len(values), column, wanted) from None
        return np.array(values, dtype=float)


def _rows(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Line number and cells of each line that is not blank."""
    octets = octets_of(path)
    instead = instead_of_text(octets)
    if instead:
        raise RecordingError(path, _NOT_CSV, got=instead)
    text = io.TextIOWrapper(io.BytesIO(octets), encoding="utf-8-sig", newline="")
    reader = csv.reader(map(_without_spaces_after_quotes, text), skipinitialspace=True, strict=True)
    line = 0
    try:
        for line, row in enumerate(reader, start=1):
            if reader.line_num != line:
                raise _quote_left_open(path, line)
            if any(map(str.strip, row)):
                yield line, row
    except UnicodeDecodeError as error:
        raise _not_utf_8(path, octets) from error
    except csv.Error as error:
        if reader.line_num > line + 1:
            raise _quote_left_open(path, line + 1) from error
        raise RecordingError(
            path,
            "a row is not CSV",
            line=line + 1,
            wanted="cells separated by commas, each quoted as a whole or not at all",
            got=str(error),
        ) from error


def _without_spaces_after_quotes(line: str) -> str:
    return _CELL.sub(r"\1\2", line) if '"' in line else line


def _quote_left_open(path: Path, line: int) -> RecordingError:
    problem = "a quoted cell does not end in its line"
    return RecordingError(path, problem, line=line, wanted="a row on one line")


def _not_utf_8(path: Path, octets: bytes) -> RecordingError:
    """The error that names the first octet that cannot be read."""
    try:
        octets.decode("utf-8")
    except UnicodeDecodeError as error:
        place = error.start
    return RecordingError(
        path,
        _NOT_CSV,
        line=1 + len(_LINE_END.findall(octets, 0, place)),
        offset=place,
        wanted="UTF-8",
        got=f"the octet 0x{octets[place]:02x}",
    )


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")


def _number(cell: str) -> float:
    if "_" in cell:
        raise ValueError(cell)
    return float(cell) if cell.strip() else math.nan


def _time_s(cell: str) -> float:
    """UTC seconds from a number or from ISO 8601 text; text without a zone is UTC.

    A leap second, 60, is the second after it.
    """
    try:
        return _number(cell)
    except ValueError:
        match = _ISO_TIME.fullmatch(cell.strip())
    if match is None:
        raise ValueError(cell)
    day, clock, second, fraction, zone = match.groups()
    moment = datetime.datetime.fromisoformat(f"{day}T{clock}").replace(tzinfo=datetime.timezone.utc)
    second_s = int(second or 0) + float(f"0.{fraction or 0}")
    return moment.timestamp() + second_s - _zone_offset_s(zone)


def _zone_offset_s(zone: str | None) -> float:
    if zone is None or zone in "Zz":
        return 0.0
    sign = -1.0 if zone[0] == "-" else 1.0
    digits = zone[1:].replace(":", "").ljust(4, "0")
    return sign * (3600.0 * int(digits[:2]) + 60.0 * int(digits[2:]))
