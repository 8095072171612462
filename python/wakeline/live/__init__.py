"""Live tracking: from what instruments and radars send to tracks for others.

:class:`Session` needs no network: it is fed with octets and their times. ``wakeline live`` connects
one with sockets, files and serial lines.
"""

from .config import (
    InputConfig,
    LiveConfig,
    OutputConfig,
    OwnConfig,
    RadarConfig,
    SessionConfig,
    read_config,
)
from .engine import LiveTrack, TrackEngine
from .session import Session

__all__ = [
    "InputConfig",
    "LiveConfig",
    "LiveTrack",
    "OutputConfig",
    "OwnConfig",
    "RadarConfig",
    "Session",
    "SessionConfig",
    "TrackEngine",
    "read_config",
]
