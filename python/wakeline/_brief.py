"""Short texts: reprs of objects with many numbers, counts, quotations."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any

_MOST_QUOTED = 80
_LONG_QUOTE = re.compile(r"""(?<!\w)(['"])(?=((?:(?!\1).){81,})\1)\2\1(?!\w)""", re.DOTALL)
_EITHER = re.compile(r"\[([^][|]*)\|([^][|]*)\]")


def brief(thing: Any, *facts: str, name: str = "") -> str:
    """``<Recording 'joyride': 115 scans, 147 plots>``, as ``__repr__`` should say it."""
    title = f"{type(thing).__name__} {name!r}" if name else type(thing).__name__
    return f"<{title}: {', '.join(filter(None, facts))}>"


def cut(text: str) -> str:
    """Text of a user or a file as messages quote it: both ends, at most 80 characters."""
    return text if len(text) <= _MOST_QUOTED else f"{text[:38]}...{text[-39:]}"


def quoted(value: Any) -> str:
    """The repr of a value of a user or a file as messages quote it: at most 80 characters."""
    return cut(repr(value))


def with_short_quotes(message: str) -> str:
    """A message whose quotations have at most 80 characters."""
    return _LONG_QUOTE.sub(lambda quote: f"{quote[1]}{cut(quote[2])}{quote[1]}", message)


def many(count: int, noun: str) -> str:
    """A count with its noun, such as "1 scan" and "2 scans"."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


def counted(count: int, what: str) -> str:
    """A count with its noun; ``[one|more]`` is the form for one or for more.

    >>> counted(1, "[row|rows] that [repeats|repeat] another")
    '1 row that repeats another'
    """
    fits = 1 if count == 1 else 2
    return f"{count} {_EITHER.sub(lambda either: either[fits], what)}"


def span(*times_s: Sequence[float]) -> str:
    """From the first to the last time of sorted sequences; '' without times."""
    ends: Iterable[float] = [end for t in times_s if len(t) for end in (t[0], t[-1])]
    return f"{min(ends):.1f} to {max(ends):.1f} s" if ends else ""
