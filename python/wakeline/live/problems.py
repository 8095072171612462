"""What is wrong with the data of a source: counted by kind, with the last example."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from wakeline._brief import cut

_MOST_KINDS = 32


@dataclass
class Problems:
    """Problems of one source.

    Attributes
    ----------
    count : Counter
        Problems by kind.
    last : str
        The last one, in words.
    """

    count: Counter[str] = field(default_factory=Counter)
    last: str = ""

    def add(self, kind: str, reason: str, times: int = 1) -> None:
        """Count a problem."""
        if kind not in self.count and len(self.count) >= _MOST_KINDS:
            kind = "other"
        self.count[kind] += times
        self.last = f"{kind}: {cut(reason)}"


def in_words(error: Exception) -> str:
    """The reason of an error, without its number."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return str(error)
