"""Own ship's solution from a log: position, velocity and heading with their covariances.

>>> from wakeline import own_ship, recording
>>> part = recording.load_navigation(variation_deg=2.5).parts()[0]
>>> track = own_ship.navigate(own_ship.readings_of(part))
>>> track.position_m.shape == (len(track.time_s), 2)
True

With an IMU (`recording.read_imu`) the state has eight components: position, velocity, heading and
its biases. Without one it is predicted between readings with the rate of turn, if the log has it.
With heading and speed through water it has seven components then, including the current; without
either it has five. If the log has the speed across the hull, the heading and speed of the state are
those of the motion through the water, which differs from the heading by the leeway.
"""

from __future__ import annotations

from .coasting import HORIZONS_S, hold_out, medians, without_hidden
from .instruments import FIX_STD_M
from .left_out import rejected_lines, unused, zero_speeds
from .magnetic import ANY_OFFSET, NO_OFFSET, MagneticOffset, magnetic_offset, wants_offset
from .readings import Readings, readings_of
from .solution import JUMP_M, OwnTrack, navigate
from .voyage import Leg, Voyage, navigate_log, write_own

__all__ = [
    "ANY_OFFSET",
    "FIX_STD_M",
    "HORIZONS_S",
    "JUMP_M",
    "NO_OFFSET",
    "Leg",
    "MagneticOffset",
    "OwnTrack",
    "Readings",
    "Voyage",
    "hold_out",
    "magnetic_offset",
    "medians",
    "navigate",
    "navigate_log",
    "readings_of",
    "rejected_lines",
    "unused",
    "wants_offset",
    "without_hidden",
    "write_own",
    "zero_speeds",
]
