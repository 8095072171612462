"""The error of all readers: file, line and column or octet, what was expected, what came."""

from __future__ import annotations

from pathlib import Path

from wakeline._brief import cut, with_short_quotes

_PLACES = ("line", "column", "offset", "wanted", "got")


class RecordingError(ValueError):
    """A recording cannot be read.

    Parameters
    ----------
    path : str or Path
        The file at fault.
    problem : str
        What is wrong.
    line : int, optional
        Line of the file, 1 for the header.
    column : str, optional
        Name of the column in the file.
    offset : int, optional
        Offset of the fault in octets, in a file that is not UTF-8 text.
    wanted, got : str, optional
        What was expected there, and what the file has.

    All parameters are attributes; ``str(error)`` is one line made of them, in which a quotation
    has at most 80 characters.
    """

    def __init__(
        self,
        path: str | Path,
        problem: str,
        *,
        line: int | None = None,
        column: str | None = None,
        offset: int | None = None,
        wanted: str | None = None,
        got: str | None = None,
    ) -> None:
        self.path = Path(path)
        self.problem = problem
        self.line = line
        self.column = column
        self.offset = offset
        self.wanted = wanted
        self.got = got
        super().__init__(self._sentence())

    def __reduce__(self):
        return _rebuild, (self.path, self.problem, {name: getattr(self, name) for name in _PLACES})

    @property
    def place_and_reason(self) -> str:
        """The message without the file."""
        return str(self).removeprefix(f"{self.path}, ").removeprefix(f"{self.path}: ")

    def remarked(self, remark: str) -> RecordingError:
        """The same error with a remark on the problem, in parentheses."""
        places = {name: getattr(self, name) for name in _PLACES}
        return RecordingError(self.path, f"{self.problem} ({remark})", **places)

    def _sentence(self) -> str:
        place = [str(self.path)]
        if self.line is not None:
            place.append(f"line {self.line}")
        if self.column is not None:
            place.append(f"column {cut(self.column)}")
        if self.offset is not None:
            place.append(f"octet {self.offset}")
        sentence = f"{', '.join(place)}: {self.problem}"
        if self.wanted is not None:
            sentence += f"; wanted {self.wanted}"
        if self.got is not None:
            sentence += f", got {with_short_quotes(self.got)}"
        return sentence


def _rebuild(path: Path, problem: str, places: dict) -> RecordingError:
    return RecordingError(path, problem, **places)
