"""Own ship's log through the navigator: where the ship was, and how well it is known.

>>> from wakeline import own_ship, recording
>>> part = recording.load_navigation(variation_deg=2.5).parts()[0]
>>> track = own_ship.navigate(own_ship.readings_of(part))
>>> track.position_m.shape == (len(track.time_s), 2)
True

Without an IMU the ship coasts from reading to reading, turning as her rate of turn indicator says.
With heading and speed through water the state has seven components, current among them; without
either it has five. Where the log tells of the speed across the hull, too, her way through the water
is not where she heads, and it is the way that the state's heading and speed are of.
"""

from __future__ import annotations

from .coasting import HORIZONS_S, hold_out, medians, without_hidden
from .left_out import rejected_lines, unused, zero_speeds
from .magnetic import ANY_OFFSET, NO_OFFSET, MagneticOffset, magnetic_offset, wants_offset
from .readings import Readings, plane_of, readings_of
from .solution import JUMP_M, OwnTrack, navigate

__all__ = [
    "ANY_OFFSET",
    "HORIZONS_S",
    "JUMP_M",
    "NO_OFFSET",
    "MagneticOffset",
    "OwnTrack",
    "Readings",
    "hold_out",
    "magnetic_offset",
    "medians",
    "navigate",
    "plane_of",
    "readings_of",
    "rejected_lines",
    "unused",
    "wants_offset",
    "without_hidden",
    "zero_speeds",
]
