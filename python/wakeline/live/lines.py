"""Lines from octets that may be cut anywhere."""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Iterator
from io import FileIO

from .problems import Problems

_LONGEST = 4096
_END = re.compile(rb"[\r\n]+")


class LineAssembly:
    """Lines of a stream, or of datagrams that each hold whole lines.

    Parameters
    ----------
    is_stream : bool
        Whether a line may continue in the next piece.
    longest : int
        A longer line is dropped and counted.
    """

    def __init__(self, is_stream: bool, longest: int = _LONGEST) -> None:
        self._is_stream, self._longest = is_stream, longest
        self._rest = b""
        self._drops = False  # the rest of a line that is too long

    def feed(self, octets: bytes, problems: Problems) -> Iterator[bytes]:
        """The lines that are complete."""
        *lines, rest = _END.split(self._rest + octets)
        if not self._is_stream:
            lines, rest = [*lines, rest.removesuffix(b"\0")], b""
        for line in lines:
            if self._drops:
                self._drops = False
            elif len(line) > self._longest:
                problems.add("long line", f"wanted at most {self._longest} octets a line")
            elif line.strip():
                yield line
        if len(rest) > self._longest and not self._drops:
            problems.add("long line", f"wanted at most {self._longest} octets a line")
            self._drops = True
        self._rest = b"" if self._drops else rest


def append_whole(file: FileIO, octets: bytes) -> None:
    """Append octets to a file without a buffer: all of them, or none where it takes no more.

    Raises
    ------
    OSError
        As where the disk is full.
    """
    end = file.seek(0, os.SEEK_END) if file.seekable() else None
    try:
        rest = memoryview(octets)
        while rest:
            rest = rest[file.write(rest) :]
    except OSError:
        if end is not None:
            with contextlib.suppress(OSError):  # as of a device
                file.truncate(end)
        raise
