"""The inputs of a session: octets to readings, plots and sectors, with counts."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from wakeline.wire import SensorClock

from .asterix_feed import VIDEO, AsterixFeed, BlockAssembly, source_of, split
from .config import CONNECTION, InputConfig
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
    """What the inputs of a session share, by the names of radars; some measure from the bow.

    Radars with a SAC/SIC are in `sac_sic`. Inputs that name no radar have "", which is the first.
    `min_range_m` are the ranges from which they see targets.
    """

    video: dict[str, VideoFeed] = field(default_factory=dict)
    plots: dict[str, AsterixFeed] = field(default_factory=dict)
    spokes: dict[str, SpokeFeed] = field(default_factory=dict)
    recent: RecentMessages = field(default_factory=RecentMessages)
    from_bow: frozenset[str] = frozenset()
    sac_sic: Mapping[str, str] = field(default_factory=dict)
    min_range_m: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def radar_of(self) -> dict[str, str]:
        """Radars by their SAC/SIC."""
        return {source: name for name, source in self.sac_sic.items() if name}


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
    videos : dict of str to VideoFeed
        By the names of their radars.
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
        self.videos: dict[str, VideoFeed] = {}
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
        return self.name.partition(CONNECTION)[0]

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
                yield "radar", (self.radar, each)
        elif kind in _ASTERIX:
            for block in self._blocks_in(octets):
                yield from self._read_block(kind, time_s, block)

    @property
    def _selects(self) -> bool:
        """Whether messages are taken by their sources."""
        return bool(self.config.sac_sic or self._shared.sac_sic)

    def _blocks_in(self, octets: bytes) -> Iterable[bytes]:
        if self.config.is_stream:
            return self._blocks.feed(octets, self.problems)
        return split(octets) if self._selects else [octets]

    def _read_block(self, kind: str, time_s: float, block: bytes) -> Iterator[tuple[str, Any]]:
        radar = self._radar_of(source_of(block)) if self._selects else self.radar
        if radar is None:
            return
        if not self._shared.recent.is_new(time_s, radar, block):
            self.duplicates += 1
            return
        if not self.config.format:
            kind = "cat240" if block[0] == VIDEO else "cat048"
        for each in self._receiver(kind, radar).feed(time_s, block, self.problems):
            yield "radar", (radar, each)

    def _radar_of(self, source: str) -> str | None:
        """The radar that a message of a source is of; None if it is of none at this input."""
        shared = self._shared
        if self.config.sac_sic:
            return self.radar if source == self.config.sac_sic else None
        named = shared.radar_of.get(source)
        if named is not None:
            return named if self.radar in ("", named) else None
        if self.radar not in shared.sac_sic:
            return self.radar
        self.problems.add("other radar", f"source {source or 'without SAC/SIC'} at this input")
        return None

    def _spoke_feed(self) -> SpokeFeed:
        feeds = self._shared.spokes
        if self.radar not in feeds:
            from_bow = self.radar in self._shared.from_bow
            feeds[self.radar] = SpokeFeed(from_bow, self._least_m(self.radar))
        self.videos[self.radar] = feeds[self.radar].video
        return feeds[self.radar]

    def _least_m(self, radar: str) -> float:
        return self._shared.min_range_m.get(radar, 0.0)

    def _receiver(self, kind: str, radar: str) -> VideoFeed | AsterixFeed:
        """What decodes the messages of a radar."""
        shared = self._shared
        if kind in _PLOTS:
            if radar not in shared.plots:
                shared.plots[radar] = AsterixFeed()
            return shared.plots[radar]
        if radar not in self.videos:
            self.videos[radar] = shared.video.setdefault(radar, VideoFeed(self._least_m(radar)))
        return self.videos[radar]

    def pass_to(self, time_s: float) -> Iterator[tuple[str, Any]]:
        """What ends by time alone."""
        for radar, video in self.videos.items():
            for each in video.pass_to(time_s, self.problems):
                yield "radar", (radar, each)

    def status(self, time_s: float) -> dict[str, Any]:
        """Counts, rates, age and problems."""
        messages, octets = self.rate.per_s(time_s)
        videos = self.videos.values()
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
            "duplicates": self.duplicates + sum(one.duplicates for one in videos),
            "lost_sweeps": sum(one.lost for one in videos),
            "late_sweeps": sum(one.late for one in videos),
            "problems": dict(self.problems.count),
            "last_problem": self.problems.last,
        }
