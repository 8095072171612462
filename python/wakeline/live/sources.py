"""The inputs of a session: octets to readings, plots and sectors, with counts."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from wakeline.wire import SensorClock

from .asterix_feed import VIDEO, AsterixFeed, BlockAssembly
from .config import InputConfig
from .json_lines import BadLine, read_line
from .lines import LineAssembly
from .nmea import AisMessage, NmeaDecoder
from .problems import Problems
from .recognition import format_in_stream, format_of_datagram
from .signalk import SignalkDecoder, VesselReading
from .spokes import SpokeFeed
from .video_feed import VideoFeed

_RATE_S = 5.0
_LONGEST_LINE = 1 << 16
_TWICE_S = 0.5  # the same message of redundant senders comes within this time
_PLOTS = ("cat048", "cat010")
_ASTERIX = ("cat240", *_PLOTS)
_MOST_UNKNOWN = 1 << 17  # octets of a stream; two blocks of ASTERIX are no longer
_UNKNOWN_S = 2.0  # after which octets of an unknown format are a problem
_KEPT = 4096  # octets of them


@dataclass
class Rate:
    """Messages and octets of the last 5 s."""

    messages: int = 0
    octets: int = 0
    _recent: deque[list[float]] = field(default_factory=deque)

    def add(self, time_s: float, octets: int) -> None:
        """Count a message."""
        self.messages += 1
        self.octets += octets
        if self._recent and time_s - self._recent[-1][0] < 0.5:
            self._recent[-1][1] += 1
            self._recent[-1][2] += octets
        else:
            self._recent.append([time_s, 1, octets])
        self._forget(time_s)

    def _forget(self, time_s: float) -> None:
        while self._recent and time_s - self._recent[0][0] > _RATE_S:
            self._recent.popleft()

    def per_s(self, time_s: float) -> tuple[float, float]:
        """Messages and octets a second."""
        self._forget(time_s)
        span_s = max(time_s - self._recent[0][0], 1.0) if self._recent else 1.0
        return tuple(sum(one[k] for one in self._recent) / span_s for k in (1, 2))


class RecentMessages:
    """Messages of the last 0.5 s, to drop those that come again by another way."""

    def __init__(self) -> None:
        self._time_s: dict[int, float] = {}

    def is_new(self, time_s: float, radar: str, octets: bytes) -> bool:
        """Whether the message of a radar has not come in the last 0.5 s."""
        key, times = hash((radar, octets)), self._time_s
        is_new = time_s - times.get(key, -math.inf) > _TWICE_S
        if is_new:
            times.pop(key, None)
            times[key] = time_s
            while len(times) > 1 and time_s - times[next(iter(times))] > _TWICE_S:
                del times[next(iter(times))]
        return is_new


@dataclass
class Receivers:
    """What the inputs of a session share, by the names of radars; some measure from the bow."""

    video: dict[str, VideoFeed] = field(default_factory=dict)
    plots: dict[str, AsterixFeed] = field(default_factory=dict)
    spokes: dict[str, SpokeFeed] = field(default_factory=dict)
    recent: RecentMessages = field(default_factory=RecentMessages)
    from_bow: frozenset[str] = frozenset()


class Source:
    """One input.

    Attributes
    ----------
    config : InputConfig
    problems : Problems
    rate : Rate
    duplicates : int
        Messages dropped because another sender of the same data was first.
    clock : SensorClock
        Of times in JSON lines.
    last_s : float
    connection : str
    failing : bool
        Whether `connection` says why nothing can be received.
    """

    def __init__(self, config: InputConfig, shared: Receivers | None = None) -> None:
        self.config, self._shared = config, shared or Receivers()
        self.problems, self.rate, self.clock = Problems(), Rate(), SensorClock()
        self.duplicates = 0
        self.last_s = -math.inf
        self.connection = ""
        self.failing = False
        self.video: VideoFeed | None = None
        self._signalk = SignalkDecoder()
        self._format = config.format
        self._unsure, self._unsure_s = b"", -math.inf
        self._begin_decoders()

    @classmethod
    def unknown(cls, name: str, shared: Receivers) -> Source:
        """An input that is not configured: datagrams of any format."""
        return cls(InputConfig(name=name, url=""), shared)

    @property
    def name(self) -> str:
        return self.config.name

    @property
    def group(self) -> str:
        """Its name, or that of the input that a peer has connected to."""
        return self.name.partition(" from ")[0]

    @property
    def radar(self) -> str:
        return self.config.radar

    def read(self, time_s: float, octets: bytes) -> Iterator[tuple[str, Any]]:
        """What the next octets hold: kind and values."""
        self.rate.add(time_s, len(octets))
        self.last_s = time_s
        if self.config.format:
            yield from self._read_as(self.config.format, time_s, octets)
        elif self.config.is_stream:
            yield from self._read_stream(time_s, octets)
        elif kind := format_of_datagram(octets):
            yield from self._read_as(kind, time_s, octets)
        elif octets:
            self._add_unknown(octets)

    def _read_stream(self, time_s: float, octets: bytes) -> Iterator[tuple[str, Any]]:
        """Read a stream, whose format is looked for until it gives something, and again after."""
        if not self._unsure:
            self._unsure_s = time_s
        self._unsure += octets
        found = False
        for each in self._read_as(self._format, time_s, octets):
            found = True
            yield each
        kind = "" if found else format_in_stream(self._unsure)
        known = kind == self._format or {kind, self._format} <= {*_ASTERIX}
        if kind and not known:
            self._format = kind
            self._begin_decoders()
            yield from self._read_as(kind, time_s, self._unsure)
        if found or kind:
            self._unsure = b""
        elif len(self._unsure) > _MOST_UNKNOWN or time_s - self._unsure_s > _UNKNOWN_S:
            if not self._format:
                self._add_unknown(self._unsure)
            self._unsure, self._unsure_s = self._unsure[-_KEPT:], time_s

    def _begin_decoders(self) -> None:
        self._nmea = NmeaDecoder(self.config.is_stream)
        self._lines = LineAssembly(self.config.is_stream, _LONGEST_LINE)
        self._blocks = BlockAssembly()

    def _add_unknown(self, octets: bytes) -> None:
        self.problems.add("unknown", f"wanted NMEA, JSON or ASTERIX, got {octets[:24]!r}")

    def _read_as(self, kind: str, time_s: float, octets: bytes) -> Iterator[tuple[str, Any]]:
        if kind == "nmea":
            for reading in self._nmea.feed(time_s, octets, self.problems):
                yield ("ais" if isinstance(reading, AisMessage) else "own"), reading
        elif kind == "json":
            for line in self._lines.feed(octets, self.problems):
                try:
                    yield "json", read_line(line)
                except BadLine as error:
                    self.problems.add("JSON", str(error))
        elif kind == "signalk":
            for line in self._lines.feed(octets, self.problems):
                for reading in self._signalk.feed(line, self.problems):
                    yield ("vessel" if isinstance(reading, VesselReading) else "own"), reading
        elif kind == "spokes":
            for each in self._spoke_feed().feed(time_s, octets, self.problems):
                yield "radar", each
        elif kind in _ASTERIX:
            blocks = self._blocks.feed(octets, self.problems) if self.config.is_stream else [octets]
            for block in blocks:
                yield from self._read_block(kind, time_s, block)

    def _read_block(self, kind: str, time_s: float, block: bytes) -> Iterator[tuple[str, Any]]:
        if not self._shared.recent.is_new(time_s, self.radar, block):
            self.duplicates += 1
            return
        if not self.config.format:
            kind = "cat240" if block[0] == VIDEO else "cat048"
        for each in self._receiver(kind).feed(time_s, block, self.problems):
            yield "radar", each

    def _spoke_feed(self) -> SpokeFeed:
        feeds = self._shared.spokes
        if self.radar not in feeds:
            feeds[self.radar] = SpokeFeed(self.radar in self._shared.from_bow)
        self.video = feeds[self.radar].video
        return feeds[self.radar]

    def _receiver(self, kind: str) -> VideoFeed | AsterixFeed:
        """What decodes the messages of its radar."""
        if kind in _PLOTS:
            if self.radar not in self._shared.plots:
                self._shared.plots[self.radar] = AsterixFeed()
            return self._shared.plots[self.radar]
        if self.video is None:
            self.video = self._shared.video.setdefault(self.radar, VideoFeed())
        return self.video

    def pass_to(self, time_s: float) -> Iterator[tuple[str, Any]]:
        """What ends by time alone."""
        if self.video is not None:
            for each in self.video.pass_to(time_s, self.problems):
                yield "radar", each

    def status(self, time_s: float) -> dict[str, Any]:
        """Counts, rates, age and problems."""
        messages, octets = self.rate.per_s(time_s)
        video = self.video
        return {
            "url": self.config.url,
            "format": self._format,
            "connection": self.connection,
            "failing": self.failing,
            "messages": self.rate.messages,
            "octets": self.rate.octets,
            "messages_per_s": round(messages, 2),
            "octets_per_s": round(octets, 1),
            "age_s": time_s - self.last_s,
            "duplicates": self.duplicates + (video.duplicates if video else 0),
            "lost_sweeps": video.lost if video else 0,
            "late_sweeps": video.late if video else 0,
            "problems": dict(self.problems.count),
            "last_problem": self.problems.last,
        }
