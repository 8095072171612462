"""Progress of long work on a terminal; nothing in a pipe."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable, Iterator
from typing import TypeVar

T = TypeVar("T")

_EVERY_S = 0.1
_WIDTH = 24


def progress(items: Iterable[T], total: int, label: str) -> Iterator[T]:
    """Iterate over `items`, with a bar on stderr if it is a terminal.

    Parameters
    ----------
    items : iterable
    total : int
        Number of items.
    label : str
        Name of the work.
    """
    if not _seen():
        yield from items
        return
    drawn_s = time.monotonic()
    try:
        for done, item in enumerate(items):
            if time.monotonic() - drawn_s > _EVERY_S:
                drawn_s = time.monotonic()
                _draw(f"{label} {_bar(done, total)} {done}/{total}")
            yield item
    finally:
        _draw("")


def counted(items: Iterable[T], label: str) -> Iterator[T]:
    """Iterate over `items` of unknown number, with a count on a terminal."""
    if not _seen():
        yield from items
        return
    try:
        for done, item in enumerate(items, start=1):
            _draw(f"{done} {label}")
            yield item
    finally:
        _draw("")


def _seen() -> bool:
    """Whether stderr is open and a terminal."""
    return sys.stderr is not None and sys.stderr.isatty()


def _bar(done: int, total: int) -> str:
    full = _WIDTH * done // max(total, 1)
    return "█" * full + "░" * (_WIDTH - full)


def _draw(text: str) -> None:
    sys.stderr.write(f"\r\x1b[K{text}")
    sys.stderr.flush()
