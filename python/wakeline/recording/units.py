"""Notes on numbers that look like those of another unit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from wakeline._units import NAUTICAL_MILE_M

from .model import Episode

_MANY = 20
_LEAST_FAR_M = 100.0
_FARTHEST_NM = 200.0
_LONGEST_REVOLUTION_S = 60.0
_PERIODS_AGREE = 0.2


def unit_notes(polar: np.ndarray, range_name: str, bearing_name: str) -> Iterator[str]:
    """Notes on ranges in metres and bearings in radians (n, 2); names are those of the columns."""
    range_m, bearing_rad = polar[np.isfinite(polar).all(axis=1)].T
    if len(range_m) < _MANY:
        return
    farthest_deg = float(np.degrees(np.abs(bearing_rad).max()))
    if "deg" in bearing_name.lower() and 0.0 < farthest_deg <= 2.0 * np.pi:
        within = f"all bearings lie within {farthest_deg:.1f}° of north"
        yield f"{within}: if {bearing_name} is in radians, name it bearing_rad"
    farthest_m, usual_nm = float(range_m.max()), float(np.median(range_m)) / NAUTICAL_MILE_M
    if "nm" in range_name.lower() and usual_nm > _FARTHEST_NM:
        above = f"half of the ranges are above {_FARTHEST_NM:.0f} nautical miles"
        yield f"{above}: if {range_name} is in metres, name it range_m"
    elif "nm" not in range_name.lower() and 0.0 < farthest_m < _LEAST_FAR_M:
        within = f"all ranges are within {farthest_m:.3g} m"
        yield f"{within}: if {range_name} is in nautical miles, name it range_nm"


def period_notes(
    episodes: Sequence[Episode], period_s: float | None, turn_s: float | None = None
) -> Iterator[str]:
    """Notes on times between scans that no antenna has, or that differ from `period_s`.

    `turn_s` is the time of a revolution as bearings show it, where scans are those of `period_s`.
    """
    steps_s = [np.diff([scan.time_s for scan in episode.scans]) for episode in episodes]
    step_s = float(np.median(np.concatenate(steps_s))) if any(map(len, steps_s)) else 0.0
    if step_s >= _LONGEST_REVOLUTION_S:
        apart = f"scans are {step_s:g} s apart, longer than a revolution of a ship's radar"
        yield f"{apart}: if times are in milliseconds, divide them by 1000"
    elif period_s and turn_s and abs(turn_s - period_s) > _PERIODS_AGREE * period_s:
        yield f"period_s of {period_s:g} s is used, though the antenna turns in {turn_s:.3g} s"
    elif period_s and step_s and abs(step_s - period_s) > _PERIODS_AGREE * period_s:
        yield f"period_s of {period_s:g} s is used, though scans are {step_s:.3g} s apart"
