"""Session files: pcap with everything a session received, in the order in which it was taken.

Each record is a UDP packet with its receive time. Data of input number `k` go to the address
127.1.0.k (and so on) and the port of the input; octets of a stream are a packet for each piece.
Records of the session itself go to 127.0.0.1 port 0 as JSON: the settings at the start of each
segment, the names of the inputs, and what operators did. A later segment begins with the state of
the session, so that it can be replayed alone.
"""

from __future__ import annotations

import contextlib
import errno
import json
import os
import re
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple
from urllib.parse import urlsplit

try:
    import fcntl
except ImportError:  # not POSIX
    fcntl = None  # type: ignore[assignment]

from wakeline.recording import RecordingError
from wakeline.recording.containers import datagrams_of

_MAGIC, _LINK_RAW, _MOST = 0xA1B2C3D4, 101, 262144
_HEAD = struct.pack("<IHHiIII", _MAGIC, 2, 4, 0, 0, _MOST, _LINK_RAW)
_LONGEST = 65000  # octets of a packet
_IP_HEAD = 28  # octets of the heads of IP and UDP
_SESSION = "127.0.0.1"
_VERSION = 1
_MICRO = 1_000_000


class Record(NamedTuple):
    """One record: data of an input, or of the session itself.

    Attributes
    ----------
    time_s : float
    input : str
        Name of the input; empty for the session's own.
    octets : bytes
    values : dict or None
        Of the session's own: ``settings``, ``state``, ``command``, ``clock``.
    """

    time_s: float
    input: str
    octets: bytes
    values: dict[str, Any] | None = None


def at_microsecond(time_s: float) -> float:
    """A time as a session file holds it."""
    second, micro = divmod(round(time_s * _MICRO), _MICRO)
    return second + micro * 1e-6


class Recorder:
    """Writes a session file.

    Each record is written at once and whole, so that a process that is killed loses at most the
    last. A file that exists is continued after its last whole record.

    Parameters
    ----------
    path : str or Path
        First segment; the following ones are beside it, with -0001 and so on in their names.
    settings : dict
        Settings of the session, written at the start of each segment.
    segment_octets, most_octets : int
        Size, without the state at its begin, at which a new segment begins; and of all segments
        before the oldest is removed.
    state : callable, optional
        Gives the state of the session, written at the start of each segment but the first.
    """

    def __init__(
        self,
        path: str | Path,
        settings: dict[str, Any],
        segment_octets: int = 256 << 20,
        most_octets: int = 4096 << 20,
        state: Callable[[], dict[str, Any]] | None = None,
    ) -> None:
        self.path, self._settings, self._state = Path(path), settings, state
        self._segment_octets, self._most_octets = segment_octets, most_octets
        self._inputs: dict[str, tuple[int, int]] = {}
        self._head_octets = 0  # of the segment, which its state is in
        known = segments_of(self.path)
        self._number = _number_of(known[-1], self.path) if known else 0
        self._file = -1
        self.octets = 0
        self._open(known[-1] if known else self.path)

    def _open(self, path: Path, *, fresh: bool = False) -> None:
        end = _whole_octets(path) if path.exists() and not fresh else 0
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT, 0o644)
        os.ftruncate(self._file, end)
        os.lseek(self._file, end, os.SEEK_SET)
        self.octets = end
        if end == 0:
            self._write(_HEAD)

    def begin(self, time_s: float) -> None:
        """Write the settings."""
        self._own(time_s, {"wakeline_session": _VERSION, "settings": self._settings})

    def data(self, time_s: float, name: str, url: str, octets: bytes) -> None:
        """Write octets of an input."""
        if self.octets - self._head_octets > self._segment_octets:
            self.rotate(time_s)
        number, port = self._inputs.get(name) or self._add_input(time_s, name, url)
        for begin in range(0, max(len(octets), 1), _LONGEST):
            self._packet(time_s, number, port, octets[begin : begin + _LONGEST])

    def command(self, time_s: float, command: dict[str, Any]) -> None:
        """Write what an operator did."""
        self._own(time_s, {"command": command})

    def clock(self, time_s: float) -> None:
        """Write that time has passed."""
        self._own(time_s, {"clock": True})

    def close(self) -> None:
        """Close the file."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1

    def _add_input(self, time_s: float, name: str, url: str) -> tuple[int, int]:
        number = len(self._inputs) + 1
        try:
            port = urlsplit(url).port or 1
        except ValueError:
            port = 1
        self._inputs[name] = number, port
        self._own(time_s, {"input": {"number": number, "name": name, "url": url}})
        return number, port

    def _own(self, time_s: float, values: dict[str, Any]) -> None:
        octets = json.dumps(values, separators=(",", ":")).encode()
        if len(octets) % _LONGEST == 0:
            octets += b" "
        for begin in range(0, len(octets), _LONGEST):
            self._packet(time_s, 0, 0, octets[begin : begin + _LONGEST])

    def _packet(self, time_s: float, number: int, port: int, octets: bytes) -> None:
        second, micro = divmod(round(time_s * _MICRO), _MICRO)
        high, low = divmod(number, 256)
        address = bytes((127, 1, high, low)) if number else bytes((127, 0, 0, 1))
        length = len(octets) + _IP_HEAD
        ip = struct.pack(
            ">BBHHHBBH4s4s", 0x45, 0, length, 0, 0, 64, 17, 0, bytes((127, 0, 0, 1)), address
        )
        ip = ip[:10] + struct.pack(">H", _checksum(ip)) + ip[12:]
        udp = struct.pack(">HHHH", 1, port, len(octets) + 8, 0)
        head = struct.pack("<IIII", second, micro, length, length)
        self._write(b"".join((head, ip, udp, octets)))

    def _write(self, octets: bytes) -> None:
        self.octets += len(octets)
        while octets:
            octets = octets[os.write(self._file, octets) :]

    def rotate(self, time_s: float, *, after_gap: bool = False) -> None:
        """Begin another segment, which can be read alone.

        It gets its name when its beginning is whole, so that one that is cut there is not read.
        After a gap, in which records were lost, a replay continues from its state.
        """
        segment = _segment(self.path, self._number + 1)
        begun = segment.with_name(segment.name + ".part")
        before = self._file, self.octets
        try:
            self._open(begun, fresh=True)
            self.begin(time_s)
            if self._state is not None:
                self._own(time_s, {"state": self._state(), "after_gap": after_gap})
            for name, (number, port) in self._inputs.items():
                url = f"udp://127.0.0.1:{port}"
                self._own(time_s, {"input": {"number": number, "name": name, "url": url}})
            begun.replace(segment)
        except BaseException:
            if self._file != before[0]:
                os.close(self._file)
                begun.unlink(missing_ok=True)
            self._file, self.octets = before
            raise
        self._head_octets = self.octets
        os.close(before[0])
        self._number += 1
        segments = segments_of(self.path)
        sizes = [segment.stat().st_size for segment in segments]
        while len(segments) > 1 and sum(sizes) > self._most_octets:
            with contextlib.suppress(OSError):
                segments[0].unlink()
            segments.pop(0)
            sizes.pop(0)


def lock(path: Path) -> BinaryIO:
    """Keep a session file for this process until the file returned is closed, or it dies.

    That file is beside the first segment, which may be removed, and stays.

    Raises
    ------
    OSError
        When another process records to the session file.
    """
    file = path.with_name(path.name + ".lock").open("ab")
    try:
        if fcntl is not None:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        raise OSError(errno.EBUSY, "another process records to this file", str(path)) from None
    except OSError:  # the file system has no locks
        pass
    return file


def segments_of(path: str | Path) -> list[Path]:
    """The segments of a session file that exist, in order."""
    path = Path(path)
    pattern = re.compile(re.escape(path.stem) + r"-\d{4,}" + re.escape(path.suffix))
    found = [one for one in path.parent.iterdir() if pattern.fullmatch(one.name)]
    found.sort(key=lambda one: _number_of(one, path))
    return ([path] if path.exists() else []) + found


def read_session(path: str | Path, *, last_segment: bool = False) -> Iterator[Record]:
    """The records of a session file and of the segments that follow it, or of the last one.

    Raises
    ------
    RecordingError
        When there is no such file, or it is not a session.
    """
    path = Path(path)
    segments = segments_of(path) if path.parent.is_dir() else []
    if not segments:
        raise RecordingError(path, "there is no such file", wanted="a session file")
    segments = segments[-1:] if last_segment else segments
    names: dict[str, str] = {}
    is_session = False
    for segment in segments:
        pending = b""
        for time_s, address, _, octets, _ in datagrams_of(segment):
            if address != _SESSION:
                if address not in names:
                    raise _no_session(segment)
                yield Record(time_s, names[address], octets)
                continue
            pending += octets
            if len(octets) == _LONGEST:
                continue
            try:
                values = json.loads(pending)
            except ValueError:
                raise _no_session(segment) from None
            pending = b""
            if "input" in values:
                high, low = divmod(int(values["input"]["number"]), 256)
                names[f"127.1.{high}.{low}"] = str(values["input"]["name"])
                continue
            is_session = is_session or "wakeline_session" in values
            yield Record(time_s, "", b"", values)
    if not is_session:
        raise _no_session(path)


def _no_session(path: Path) -> RecordingError:
    return RecordingError(
        path, "not a session", wanted="a file of wakeline live --record", got="another capture"
    )


def _segment(path: Path, number: int) -> Path:
    return path.with_name(f"{path.stem}-{number:04d}{path.suffix}") if number else path


def _number_of(segment: Path, path: Path) -> int:
    return 0 if segment == path else int(segment.stem.rpartition("-")[2])


def _whole_octets(path: Path) -> int:
    """Octets of a session file up to the end of its last whole record of all its packets."""
    size, at = path.stat().st_size, len(_HEAD)
    whole = at
    with path.open("rb") as file:
        if file.read(len(_HEAD)) != _HEAD:
            if size == 0:
                return 0
            raise _no_session(path)
        while at + 16 <= size:
            file.seek(at)
            head = file.read(16 + _IP_HEAD)
            kept = struct.unpack("<I", head[8:12])[0]
            if kept > _MOST or at + 16 + kept > size:
                break
            at += 16 + kept
            goes_on = kept == _LONGEST + _IP_HEAD and head[32:36] == bytes((127, 0, 0, 1))
            whole = whole if goes_on else at
    return whole


def _checksum(header: bytes) -> int:
    total = sum(struct.unpack(">10H", header))
    while total >> 16:
        total = (total & 0xFFFF) + (total >> 16)
    return ~total & 0xFFFF
