"""NMEA 0183 logs of own ship's instruments."""

from .log import (
    BottomTrack,
    Fixes,
    GroundSpeed,
    ImuReadings,
    MagneticHeading,
    NavigationLog,
    NmeaProblem,
    NmeaReport,
    RateOfTurn,
    TrueHeading,
    WaterSpeed,
)
from .reader import read_nmea

__all__ = [
    "BottomTrack",
    "Fixes",
    "GroundSpeed",
    "ImuReadings",
    "MagneticHeading",
    "NavigationLog",
    "NmeaProblem",
    "NmeaReport",
    "RateOfTurn",
    "TrueHeading",
    "WaterSpeed",
    "read_nmea",
]
