"""The scenarios of the papers, as printed.

A is "Interacting multiple model algorithm for tracking maneuvering surface vessels" (Vestnik NovSU,
2023), B is "Tracking of maneuvering targets using a variable structure multiple model algorithm"
(J. Russian Universities. Radioelectronics, 2023). All have a radar of 60 m and 0.5 degrees with a
period of 3 s, and an initial state known to 10 m and 1 m/s per axis; the papers print speeds in
knots, north and east.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from wakeline._units import KNOT_MPS

from .radar import RadarSimulator
from .scenario import Scenario
from .truth import Truth, segments_from_table

RADAR = RadarSimulator(range_std_m=60.0, bearing_std_rad=np.deg2rad(0.5), period_s=3.0)

_EXAMPLE_1 = (
    (0, 90, 0), (90, 180, -2), (180, 240, 0), (240, 330, 2), (330, 360, 0), (360, 540, -1),
    (540, 600, 0), (600, 750, 1),
)  # fmt: skip
_EXAMPLE_2 = (
    (0, 45, 0), (45, 120, 2), (120, 135, 0), (135, 180, -4), (180, 210, 0), (210, 255, 4),
    (255, 360, -2), (360, 390, 0),
)  # fmt: skip


def imm(reading: str = "scans") -> Scenario:
    """Scenario of paper A: a straight, a turn each way at 1 deg/s, a straight; 250 scans.

    Parameters
    ----------
    reading : {"scans", "seconds"}
        The unit of the paper's table of turn rates (0-80: 0, 81-140: +1, 141-200: -1, 201-250:
        0 deg/s). The paper prints seconds; its 250 scans of 3 s suggest scans, with which the turns
        begin at 240 s. In seconds they begin at 80 s and the vessel goes straight from 200 s.

    Raises
    ------
    ValueError
        For another reading.
    """
    if reading not in ("scans", "seconds"):
        raise ValueError(f'reading must be "scans" or "seconds", got {reading!r}')
    unit_s = RADAR.period_s if reading == "scans" else 1.0
    end_s = 250 * RADAR.period_s
    rows = ((0, 80 * unit_s, 0), (80 * unit_s, 140 * unit_s, 1), (140 * unit_s, 200 * unit_s, -1))
    return _scenario(f"imm-{reading}", (1000, 1000), (10, 6), (*rows, (200 * unit_s, end_s, 0)))


def example1() -> Scenario:
    """Example 1 of paper B: turns at 1 and 2 deg/s, 250 scans."""
    return _scenario("example1", (1000, 1000), (15, 10), _EXAMPLE_1)


def example2() -> Scenario:
    """Example 2 of paper B: turns at 2 and 4 deg/s, starting at the antenna, 130 scans."""
    return _scenario("example2", (0, 0), (20, 12), _EXAMPLE_2)


BY_NAME: dict[str, Callable[[], Scenario]] = {
    "imm-scans": lambda: imm("scans"),
    "imm-seconds": lambda: imm("seconds"),
    "example1": example1,
    "example2": example2,
}


def _scenario(
    name: str,
    position_m: tuple[float, float],
    speed_kn: tuple[float, float],
    rows: Sequence[tuple[float, float, float]],
) -> Scenario:
    vnorth_mps, veast_mps = (KNOT_MPS * speed for speed in speed_kn)
    start = [position_m[0], vnorth_mps, position_m[1], veast_mps]
    segments = segments_from_table([(a, b, np.deg2rad(rate)) for a, b, rate in rows])
    return Scenario(name, Truth(start, segments), RADAR, round(rows[-1][1] / RADAR.period_s))
