"""Inputs and outputs of a live session: sockets, serial lines, files, each in its thread."""

from __future__ import annotations

import abc
import contextlib
import errno
import math
import re
import select
import socket
import struct
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO
from urllib.parse import parse_qs, urlsplit

from wakeline.recording import RecordingError
from wakeline.recording.containers import datagrams_of

from . import signalk
from .config import CONNECTION, InputConfig, OutputConfig, SettingsError
from .lines import append_whole
from .problems import in_words

Take = Callable[[str, list[tuple[float, bytes]]], None]
"""Called with the name of an input and its messages: times and octets."""

_SET_FORWARD_S = 1.0  # of the machine's clock, which is followed
_WAIT_S = 0.2  # until a thread looks whether it should end
_BATCH = 64
_RECEIVE_BUFFER = 16 << 20
_PIECE = 1 << 16
_LONGEST_STEP_S = 600.0  # between JSON lines of a file: those of two clocks are farther apart
_TIME = re.compile(rb'"time_s"\s*:\s*(-?\d{1,15}(?:\.\d*)?(?:[eE][-+]?\d{1,2})?)')
_BACK_OFF_S = (0.25, 10.0)  # first and longest
_MOST_CLIENTS = 32
_MOST_QUEUED = 1 << 20  # octets that wait for a receiver
_MOST_FOR_FILE = 64 << 20
_MOST_DISCARDED = 1_000_000
_LONGEST_WAIT_S = 5.0  # of a message for a receiver that is not a file
_MOST_UNSENT = 1024  # octets in a socket that the network does not take
PROBES = {"TCP_KEEPIDLE": 30, "TCP_KEEPINTVL": 5, "TCP_KEEPCNT": 3}  # s, s, times
HOW_TO_GET_SERIAL = "serial lines need pyserial: pip install 'wakeline[live]'"


class _Clock:
    """UTC seconds that never go back: a clock of the machine that is set back is not followed."""

    def __init__(self) -> None:
        self._ahead_s = time.time() - time.monotonic()

    def __call__(self) -> float:
        now_s = time.monotonic() + self._ahead_s
        forward_s = time.time() - now_s
        if forward_s > _SET_FORWARD_S:
            self._ahead_s += forward_s
            now_s += forward_s
        return now_s


now_s = _Clock()


class _Thread(abc.ABC):
    """The thread of an input or output, which ends when it is closed; listens at `tcp-listen`.

    Attributes
    ----------
    failure : RecordingError or None
        Why it has ended before its file was read.
    """

    def __init__(self, config: InputConfig | OutputConfig) -> None:
        self.config = config
        self.connection = "starting"
        self._error = ""
        self.failure: RecordingError | None = None
        self.restarts = 0
        self._url, self._query = urlsplit(config.url), parse_qs(urlsplit(config.url).query)
        self._ends = threading.Event()
        self._thread = threading.Thread(target=self._run, name=config.name, daemon=True)
        self.port = self._url.port if self._url.netloc else None
        if config.scheme in ("udp", "tcp", "tcp-listen") and self.port is None:
            raise SettingsError(f"{config.url} needs a port")
        self._baud = _whole_number(config.url, "baud", self._query.get("baud", ["4800"])[-1])
        self._datagrams: socket.socket | None = None
        self._listener: socket.socket | None = None
        with _naming(config.url):
            if config.scheme == "udp":
                self._datagrams = self._udp_socket()
            elif config.scheme == "tcp-listen":
                self._listener = _listening(self._url.hostname or "127.0.0.1", self._url.port)
                self.port = self._listener.getsockname()[1]

    def start(self) -> None:
        self._thread.start()

    def close(self) -> None:
        """Ask the thread to end."""
        self._ends.set()

    def join(self) -> None:
        if self._thread.ident is not None:
            self._thread.join(2.0)
            return
        for one in (self._datagrams, self._listener):  # it has not been started
            if one is not None:
                one.close()

    @property
    def is_done(self) -> bool:
        """Whether it has ended by itself."""
        return not self._thread.is_alive()

    @property
    def is_failing(self) -> bool:
        """Whether `connection` is the error for which it waits to begin again."""
        return self.connection == self._error != ""

    def _run(self) -> None:
        """Work, and begin again with growing pauses after an error."""
        pause_s = _BACK_OFF_S[0]
        while not self._ends.is_set():
            began_s = time.monotonic()
            try:
                if self._work():
                    self.connection = "ended"
                    return
                self.connection = "closed by the other side"
            except RecordingError as error:
                self.failure, self.connection, self._error = error, str(error), str(error)
                return
            except (OSError, SettingsError) as error:
                self.connection = self._error = in_words(error)
            if time.monotonic() - began_s > 2.0 * _BACK_OFF_S[1]:
                pause_s = _BACK_OFF_S[0]
            self.restarts += 1
            self._ends.wait(pause_s)
            pause_s = min(2.0 * pause_s, _BACK_OFF_S[1])

    @contextlib.contextmanager
    def _connected(self) -> Iterator[socket.socket]:
        """A connection with the address of the URL."""
        address = self._url.hostname or "127.0.0.1", self._url.port
        self.connection = f"connecting to {address[0]} port {address[1]}"
        with socket.create_connection(address, 5.0) as one:
            _probe(one)
            self.connection = "connected"
            yield one

    @abc.abstractmethod
    def _udp_socket(self) -> socket.socket:
        """The socket of datagrams."""

    @abc.abstractmethod
    def _work(self) -> bool:
        """Work until an error; True if all is done."""


class NetworkInput(_Thread):
    """One input of a session, received in a thread.

    A connection that fails is made again, after pauses from 0.25 to 10 s.

    Parameters
    ----------
    config : InputConfig
    take : callable
        Called in the thread with the name and the messages.

    Raises
    ------
    OSError, SettingsError, RecordingError
        When an address cannot be listened at, or a capture cannot be read.
    """

    def __init__(self, config: InputConfig, take: Take) -> None:
        super().__init__(config)
        self._take = take
        self._capture = datagrams_of(self._path()) if config.scheme == "pcap" else None
        if config.scheme == "file" and not Path(self._path()).exists():
            raise FileNotFoundError(errno.ENOENT, "No such file or directory", self._path())
        if self._datagrams is not None:
            self.port = self._datagrams.getsockname()[1]

    def _work(self) -> bool:
        return {
            "udp": self._udp,
            "tcp": self._tcp,
            "tcp-listen": self._tcp_listen,
            "serial": self._serial,
            "stdin": self._stdin,
            "file": self._file,
            "pcap": self._pcap,
            "signalk": self._signalk,
        }[self.config.scheme]()

    # ------------------------------------------------------------------ datagrams

    def _udp_socket(self) -> socket.socket:
        host, port = self._url.hostname or "127.0.0.1", self._url.port
        one = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        is_group = 224 <= int(host.split(".")[0] if host[0].isdigit() else 0) <= 239
        if is_group or _is_broadcast(host):  # every receiver has a copy
            one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        for option in (getattr(socket, "SO_RCVBUFFORCE", 33), socket.SO_RCVBUF):
            with contextlib.suppress(OSError):
                one.setsockopt(socket.SOL_SOCKET, option, _RECEIVE_BUFFER)
                break
        try:
            _bind(one, host, port)
        except OSError as error:
            if error.errno != errno.EADDRINUSE:
                raise
            share = f"to share broadcasts, name their address: udp://192.168.1.255:{port}"
            raise OSError(error.errno, f"{error.strerror}; {share}") from None
        if is_group:
            interface = self._query.get("iface", ["0.0.0.0"])[-1]
            member = struct.pack("4s4s", socket.inet_aton(host), socket.inet_aton(interface))
            one.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
        return one

    def discard(self) -> None:
        """Drop the datagrams that have waited, of which nobody knows since when."""
        if self._datagrams is None:
            return
        self._datagrams.setblocking(False)
        with contextlib.suppress(BlockingIOError):
            for _ in range(_MOST_DISCARDED):
                self._datagrams.recv(_PIECE)

    def _udp(self) -> bool:
        one = self._datagrams
        one.settimeout(_WAIT_S)
        self.connection = f"listening on port {self.port}"
        while not self._ends.is_set():
            try:
                octets = one.recv(_PIECE)
            except TimeoutError:
                continue
            first_s = now_s()
            batch = [(first_s, octets)]
            one.setblocking(False)
            with contextlib.suppress(BlockingIOError):
                while len(batch) < _BATCH:
                    octets = one.recv(_PIECE)
                    batch.append((now_s(), octets))
            one.settimeout(_WAIT_S)
            self._take(self.config.name, batch)
        one.close()
        return True

    # ------------------------------------------------------------------ streams

    def _tcp(self) -> bool:
        with self._connected() as one:
            return self._stream(one, self.config.name)

    def _stream(self, one: socket.socket, name: str) -> bool:
        one.settimeout(_WAIT_S)
        while not self._ends.is_set():
            try:
                octets = one.recv(_PIECE)
            except TimeoutError:
                continue
            if not octets:
                return False
            self._take(name, [(now_s(), octets)])
        return True

    def _tcp_listen(self) -> bool:
        listener, clients = self._listener, {}
        listener.setblocking(False)
        try:
            while not self._ends.is_set():
                self.connection = f"port {self.port}, {len(clients)} connected"
                ready, _, _ = select.select([listener, *clients], [], [], _WAIT_S)
                for one in ready:
                    if one is listener:
                        with contextlib.suppress(OSError):
                            self._accept(listener, clients)
                    elif not self._receive(one, clients[one]):
                        del clients[one]
                        one.close()
        finally:
            for one in [listener, *clients]:
                one.close()
        return True

    def _accept(self, listener: socket.socket, clients: dict[socket.socket, str]) -> None:
        one, (host, port, *_) = listener.accept()
        if len(clients) >= _MOST_CLIENTS:
            one.close()
            return
        one.setblocking(False)
        _probe(one)
        clients[one] = self._name_of(f"{host}:{port}")

    def _receive(self, one: socket.socket, name: str) -> bool:
        try:
            octets = one.recv(_PIECE)
        except BlockingIOError:
            return True
        except OSError:
            return False
        if octets:
            self._take(name, [(now_s(), octets)])
        return bool(octets)

    def _serial(self) -> bool:
        try:
            import serial
        except ModuleNotFoundError:
            raise SettingsError(HOW_TO_GET_SERIAL) from None
        with serial.Serial(self._url.path, self._baud, timeout=_WAIT_S) as one:
            self.connection = f"open at {self._baud} baud"
            while not self._ends.is_set():
                octets = one.read(max(one.in_waiting, 1))
                if octets:
                    self._take(self.config.name, [(now_s(), octets)])
        return True

    def _stdin(self) -> bool:
        self.connection = "reading"
        descriptor = sys.stdin.buffer.raw if hasattr(sys.stdin.buffer, "raw") else sys.stdin.buffer
        while not self._ends.is_set():
            ready, _, _ = select.select([descriptor], [], [], _WAIT_S)
            if ready:
                octets = descriptor.read(_PIECE)
                if not octets:
                    return True
                self._take(self.config.name, [(now_s(), octets)])
        return True

    def _file(self) -> bool:
        """The octets of a file; JSON lines with times as far apart as these are."""
        self.connection = "reading"
        last = b""
        with Path(self._path()).open("rb") as file:
            if file.peek(1)[:1] == b"{":
                return self._paced(_timed_lines(file), _LONGEST_STEP_S)
            while not self._ends.is_set() and (octets := file.read(_PIECE)):
                self._take(self.config.name, [(now_s(), octets)])
                last = octets[-1:]
        if b" " <= last <= b"~":  # a last line without an end
            self._take(self.config.name, [(now_s(), b"\n")])
        return True

    def _pcap(self) -> bool:
        self.connection = "reading"
        return self._paced((one.time_s, one.octets, one.connection) for one in self._capture)

    def _paced(
        self, messages: Iterable[tuple[float | None, bytes, str]], longest_s: float = math.inf
    ) -> bool:
        """Take messages of peers as far apart as their times are, but for longer steps.

        One without a time comes with the one before.
        """
        last_s = offset_s = math.nan
        for time_s, octets, peer in messages:
            if time_s is not None:
                if not abs(time_s - last_s) <= longest_s:
                    offset_s = now_s() - time_s
                last_s = time_s
                self._ends.wait(max(time_s + offset_s - now_s(), 0.0))
            if self._ends.is_set():
                return True
            self._take(self._name_of(peer), [(now_s(), octets)])
        return True

    def _name_of(self, peer: str) -> str:
        return f"{self.config.name}{CONNECTION}{peer}" if peer else self.config.name

    def _signalk(self) -> bool:
        self.connection = "connecting"

        def take(octets: bytes) -> None:
            self.connection = "connected"
            self._take(self.config.name, [(now_s(), octets)])

        try:
            host, port = self._url.hostname or "127.0.0.1", self._url.port or 3000
            radar = self._url.path.removeprefix("/radars/").strip("/")
            return signalk.receive(host, port, radar, take, self._ends.is_set)
        except ModuleNotFoundError as error:
            raise SettingsError(str(error)) from None

    def _path(self) -> str:
        return self._url.netloc + self._url.path


def _timed_lines(file: BinaryIO) -> Iterator[tuple[float | None, bytes, str]]:
    """The lines of a file, or pieces of longer ones, with the times in them."""
    last = b"\n"
    while octets := file.readline(_PIECE):
        found = _TIME.search(octets)
        yield float(found[1]) if found else None, octets, ""
        last = octets[-1:]
    if last != b"\n":
        yield None, b"\n", ""


class NetworkOutput(_Thread):
    """One output of a session, sent in a thread.

    What a receiver does not take waits, up to 5 s and 1 MiB; what a file does not, up to 64 MiB.
    Beyond that the oldest messages are dropped. A receiver that is connected has only what comes
    from then on.

    Parameters
    ----------
    config : OutputConfig
    """

    def __init__(self, config: OutputConfig) -> None:
        super().__init__(config)
        self.sent = self.dropped = 0
        self._counting = threading.Lock()
        if config.scheme in ("file", "stdout"):
            self._waiting = _Backlog(self._drop, math.inf, _MOST_FOR_FILE)
        else:
            self._waiting = _Backlog(self._drop, _LONGEST_WAIT_S, _MOST_QUEUED)

    def send(self, octets: bytes) -> None:
        """Send a message; it never waits."""
        if self._datagrams is not None:
            try:
                self._datagrams.send(octets)
                self.connection = "sending"
                self.sent += 1
            except OSError as error:
                self._drop(1)
                if error.errno not in (errno.ECONNREFUSED, errno.EAGAIN):
                    self.connection = self._error = in_words(error)
            return
        self._waiting.add(octets)

    def _drop(self, count: int) -> None:
        """Count dropped messages."""
        with self._counting:
            self.dropped += count

    def start(self) -> None:
        if self._datagrams is None:
            super().start()

    def join(self) -> None:
        if self._datagrams is None:
            super().join()

    def _udp_socket(self) -> socket.socket:
        one = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        one.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        interface = self._query.get("iface", [None])[-1]
        if interface:
            one.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(interface))
        one.connect((self._url.hostname or "127.0.0.1", self._url.port))
        one.setblocking(False)
        return one

    def _work(self) -> bool:
        if self.config.scheme == "tcp":
            with self._connected() as one:
                one.settimeout(10.0)
                _limit_unsent(one)
                self._waiting.clear()
                return self._each(one.sendall)
        if self.config.scheme == "tcp-listen":
            return self._serve()
        if self.config.scheme == "serial":
            return self._write_serial()
        return self._write_file()

    def _each(self, send: Callable[[bytes], Any]) -> bool:
        """Give each message to a function, until the output is closed and nothing waits."""
        while True:
            octets = self._next()
            if octets is not None:
                try:
                    send(octets)
                except OSError:
                    self._drop(1)
                    raise
                self.sent += 1
            elif self._ends.is_set():
                return True

    def _next(self) -> bytes | None:
        return self._waiting.take(0.05 if self._ends.is_set() else _WAIT_S)

    def _write_file(self) -> bool:
        if self.config.scheme == "stdout":
            return self._each(_write_stdout)
        with Path(self._url.netloc + self._url.path).open("ab", buffering=0) as file:
            self.connection = "writing"
            return self._each(partial(append_whole, file))

    def _write_serial(self) -> bool:
        try:
            import serial
        except ModuleNotFoundError:
            raise SettingsError(HOW_TO_GET_SERIAL) from None
        with serial.Serial(self._url.path, self._baud, write_timeout=5.0) as one:
            self.connection = f"open at {self._baud} baud"
            self._waiting.clear()
            return self._each(one.write)

    def _serve(self) -> bool:
        clients: dict[socket.socket, _Client] = {}
        self._listener.setblocking(False)
        try:
            while True:
                self.connection = f"port {self.port}, {len(clients)} connected"
                octets = self._waiting.take(0.0) if clients else self._next()
                with contextlib.suppress(OSError):
                    one, _ = self._listener.accept()
                    one.setblocking(False)
                    if len(clients) < _MOST_CLIENTS:
                        _probe(one)
                        _limit_unsent(one)
                        clients[one] = _Client(one, self._drop)
                    else:
                        one.close()
                self.sent += octets is not None and bool(clients)
                for one, client in list(clients.items()):
                    if octets is not None:
                        client.waiting.add(octets)
                    if not client.flush():
                        del clients[one]
                        one.close()
                if octets is None:
                    if self._ends.is_set():
                        return True
                    if clients:
                        self._ends.wait(0.01)
        finally:
            for one in [self._listener, *clients]:
                one.close()


class _Backlog:
    """Messages that wait to be sent. Of those that are too old or too many the oldest are dropped.

    Parameters
    ----------
    drop : callable
        Called with the number of messages that are dropped.
    longest_s : float
        Longest time that a message waits.
    most_octets : int
        Of all messages together.
    """

    def __init__(self, drop: Callable[[int], None], longest_s: float, most_octets: int) -> None:
        self._drop, self._longest_s, self._most_octets = drop, longest_s, most_octets
        self._messages = deque[tuple[float, bytes]]()
        self._octets = 0
        self._news = threading.Condition()

    def add(self, octets: bytes) -> None:
        """Add a message."""
        with self._news:
            self._messages.append((time.monotonic(), octets))
            self._octets += len(octets)
            self._forget()
            self._news.notify()

    def take(self, wait_s: float = 0.0) -> bytes | None:
        """The oldest message, waiting for one if there is none."""
        with self._news:
            if not self._messages:
                self._news.wait(wait_s)
            self._forget()
            return self._pop() if self._messages else None

    def clear(self) -> None:
        """Drop all messages."""
        with self._news:
            self._drop(len(self._messages))
            self._messages.clear()
            self._octets = 0

    def _pop(self) -> bytes:
        _, octets = self._messages.popleft()
        self._octets -= len(octets)
        return octets

    def _forget(self) -> None:
        since_s = time.monotonic() - self._longest_s
        while self._messages and (
            self._octets > self._most_octets or self._messages[0][0] < since_s
        ):
            self._pop()
            self._drop(1)


class _Client:
    """A client of a listening output, with what it has not read yet."""

    def __init__(self, one: socket.socket, drop: Callable[[int], None]) -> None:
        self._socket, self._begun = one, b""
        self.waiting = _Backlog(drop, _LONGEST_WAIT_S, _MOST_QUEUED)

    def flush(self) -> bool:
        """Send what the client takes; False if it is gone."""
        try:
            while octets := self._begun or self.waiting.take():
                self._begun = octets
                self._begun = octets[self._socket.send(octets) :]
            return self._socket.recv(_PIECE) != b""
        except BlockingIOError:
            return True
        except OSError:
            return False


@contextlib.contextmanager
def _naming(url: str) -> Iterator[None]:
    """Name the URL in errors of its address."""
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), url) from None


def _write_stdout(octets: bytes) -> None:
    sys.stdout.write(octets.decode("utf-8", "replace"))
    sys.stdout.flush()


def _whole_number(url: str, key: str, text: str) -> int:
    if not text.isdecimal():
        raise SettingsError(f"{url}: {key} must be a whole number, got {text!r}")
    return int(text)


def _listening(host: str, port: int) -> socket.socket:
    one = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    _bind(one, host, port)
    one.listen(_MOST_CLIENTS)
    return one


def _bind(one: socket.socket, host: str, port: int) -> None:
    try:
        one.bind((host, port))
    except OSError:
        one.close()
        raise


def _is_broadcast(host: str) -> bool:
    """Whether it is a broadcast address: the system asks for permission to send there."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        try:
            one.connect((host, 1))
        except PermissionError:
            return True
        except OSError:
            return False
    return False


def _probe(one: socket.socket) -> None:
    """Ask a silent peer whether it is there, so that a half-open connection ends."""
    one.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for name, value in PROBES.items():
        if hasattr(socket, name):
            one.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)


def _limit_unsent(one: socket.socket) -> None:
    """Let messages wait here, not in the system, where old ones cannot be dropped."""
    if hasattr(socket, "TCP_NOTSENT_LOWAT"):
        one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, _MOST_UNSENT)


def close_all(threads: Iterable[_Thread]) -> None:
    """End all threads."""
    threads = list(threads)
    for one in threads:
        one.close()
    for one in threads:
        one.join()
