"""The outputs of a session: tracks and events to octets."""

from __future__ import annotations

import abc
import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from wakeline import wire

from .config import OutputConfig
from .json_lines import write_line

if TYPE_CHECKING:
    from .session import Session


_NUMBERS = 100  # of targets in TTM
_RESTING = 5  # of these rest, for targets that come
_KEEPS = 0.8  # so much nearer is a target that takes the place of another
_LEAST_INTERVAL_S = 3.0  # OpenCPN draws no trail of a target that comes more often than 2 s


class Output:
    """One receiver of tracks.

    Attributes
    ----------
    config : OutputConfig
    send : callable
        Called with the octets of one message; replaced by what brings them to the receiver.
    messages, octets : int
        For the receiver until now.
    sent, dropped : int
        Messages that were sent, and that the receiver did not take in time.
    waiting : int
        Tracks shown for which the receiver has no number.
    connection : str
    failing : bool
        Whether `connection` says why nothing can be sent.
    """

    def __init__(self, config: OutputConfig) -> None:
        self.config = config
        self.send: Callable[[bytes], None] = _nowhere
        self.messages = self.octets = self.sent = self.dropped = self.waiting = 0
        self.connection = ""
        self.failing = False

    def tracks(self, session: Session, lines: Callable[[], Sequence[bytes]]) -> None:
        """Send the tracks that sectors have updated, which `lines` gives as JSON."""

    def event(self, session: Session, event: dict[str, Any]) -> None:
        """Send an event."""

    def save(self) -> bytes:
        """The numbers of its targets, empty if it has none."""
        return b""

    def restore(self, session: Session, state: bytes) -> None:
        """Continue with numbers that were saved."""

    def _send(self, octets: bytes) -> None:
        self.messages += 1
        self.octets += len(octets)
        self.send(octets)

    def status(self) -> dict[str, Any]:
        """Counts."""
        return {
            "url": self.config.url,
            "format": self.config.format,
            "connection": self.connection,
            "failing": self.failing,
            "messages": self.messages,
            "octets": self.octets,
            "sent": self.sent,
            "dropped": self.dropped,
            "waiting": self.waiting,
        }


class JsonOutput(Output):
    """JSON lines of track updates and events."""

    def tracks(self, session: Session, lines: Callable[[], Sequence[bytes]]) -> None:
        for line in lines():
            self._send(line)

    def event(self, session: Session, event: dict[str, Any]) -> None:
        self._send(write_line(event.get("type", "event"), event))


class WireOutput(Output, abc.ABC):
    """Sentences or datagrams of the feeds of :mod:`wakeline.wire`, which have all shown tracks.

    They are sent when the session knows where it is.
    """

    def __init__(self, config: OutputConfig) -> None:
        super().__init__(config)
        self._feed: Any = None

    def tracks(self, session: Session, lines: Callable[[], Sequence[bytes]]) -> None:
        if session.plane is None:
            return
        if self._feed is None:
            self._feed = self._make(session)
        shown, chosen = session.shown, self._chosen(session)
        columns = {
            "track_id": shown.track_id[chosen],
            "estimate_time_s": shown.time_s[chosen],
            "mean": shown.mean[chosen],
            "name": [shown.names[k] for k in chosen.tolist()],
            "acquiring": shown.acquiring[chosen],
        }
        more = self._more(session, chosen)
        for octets in self._feed.update(session.time_s, **columns, **more):
            self._send(octets)
        self.waiting = len(shown) - len(chosen) + self._feed.waiting

    def _chosen(self, session: Session) -> np.ndarray:
        """The rows of the tracks that are sent."""
        return np.arange(len(session.shown))

    def save(self) -> bytes:
        return b"" if self._feed is None else self._feed.save()

    def restore(self, session: Session, state: bytes) -> None:
        self._feed = self._make(session)
        self._feed.restore(state)

    @abc.abstractmethod
    def _make(self, session: Session) -> Any:
        """The feed."""

    @abc.abstractmethod
    def _more(self, session: Session, chosen: np.ndarray) -> dict[str, Any]:
        """What else the feed is given of these rows."""


class TtmOutput(WireOutput):
    """NMEA 0183: OSD with TTM, or TLL."""

    def _make(self, session: Session) -> Any:
        periods = [radar.period_s for radar in session.tracker.radars]
        interval_s = max(_LEAST_INTERVAL_S, *periods)
        return wire.TtmFeed(session.plane, interval_s=interval_s, tll=self.config.format == "tll")

    def _chosen(self, session: Session) -> np.ndarray:
        """Of more than there are numbers those in danger, then the nearest."""
        shown = session.shown
        if len(shown) <= _NUMBERS - _RESTING:
            return super()._chosen(session)
        own, _ = session.fix_of_receivers()
        rank_m = np.hypot(shown.mean[:, 0] - own.north_m, shown.mean[:, 2] - own.east_m)
        rank_m[np.isin(shown.track_id, list(self._feed.numbers))] *= _KEEPS
        rank_m[np.isin(shown.track_id, list(session.watchers[0].alarms.in_danger))] = 0.0
        return np.argsort(rank_m, kind="stable")[: _NUMBERS - _RESTING]

    def _more(self, session: Session, chosen: np.ndarray) -> dict[str, Any]:
        own, own_velocity_known = session.fix_of_receivers()
        heading = session.own.heading_at(session.time_s)
        return {
            "own": own,
            "own_velocity_known": own_velocity_known,
            "heading_rad": math.nan if heading is None else heading[0],
            "manual": np.isin(session.shown.track_id[chosen], list(session.acquired)),
        }


class AsterixOutput(WireOutput):
    """System tracks of ASTERIX category 062, or tracks of 010."""

    def _make(self, session: Session) -> Any:
        if self.config.format == "cat010":
            return wire.Cat010Feed(session.plane)
        return wire.Cat062Feed(session.plane, several_radars=len(session.radars) > 1)

    def _more(self, session: Session, chosen: np.ndarray) -> dict[str, Any]:
        shown = session.shown
        return {"covariance": shown.covariance[chosen], "coasting": shown.coasting[chosen]}


_KINDS = {
    "json": JsonOutput,
    "ttm": TtmOutput,
    "tll": TtmOutput,
    "cat062": AsterixOutput,
    "cat010": AsterixOutput,
}


def make_output(config: OutputConfig) -> Output:
    """The output of a format."""
    return _KINDS[config.format](config)


def _nowhere(octets: bytes) -> None:
    pass
