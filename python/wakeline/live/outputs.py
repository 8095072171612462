"""The outputs of a session: tracks and events to octets."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from .config import OutputConfig
from .engine import LiveTrack
from .json_lines import write_line

if TYPE_CHECKING:
    from .session import Session


class Output:
    """One receiver of tracks.

    Attributes
    ----------
    config : OutputConfig
    send : callable
        Called with the octets of one message; replaced by what brings them to the receiver.
    messages, octets : int
        Sent until now.
    dropped : int
        Messages that the receiver did not take in time.
    """

    def __init__(self, config: OutputConfig) -> None:
        self.config = config
        self.send: Callable[[bytes], None] = _nowhere
        self.messages = self.octets = self.dropped = 0
        self.connection = ""

    def tracks(self, session: Session, radar: str, updated: Sequence[LiveTrack]) -> None:
        """Send the tracks that a sector has updated."""

    def event(self, session: Session, event: dict[str, Any]) -> None:
        """Send an event."""

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
            "messages": self.messages,
            "octets": self.octets,
            "dropped": self.dropped,
        }


class JsonOutput(Output):
    """JSON lines of track updates and events."""

    def tracks(self, session: Session, radar: str, updated: Sequence[LiveTrack]) -> None:
        for values in session.describe(updated):
            self._send(write_line("track", values | {"radar": radar}))

    def event(self, session: Session, event: dict[str, Any]) -> None:
        self._send(write_line(event.get("kind", "event"), event))


def make_output(config: OutputConfig) -> Output:
    """The output of a format."""
    return {"json": JsonOutput}.get(config.format, Output)(config)


def _nowhere(octets: bytes) -> None:
    pass
