"""Position errors after up to a minute without satellites, measured by hiding them."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np

from wakeline import navigation
from wakeline._progress import progress
from wakeline.recording import NavigationLog

from .dead_reckoning import travelled_m
from .readings import Readings, made_good_mps
from .solution import navigate
from .times import NEAR_S, held

HIDDEN_S, HIDDEN_EVERY_S = 60.0, 150.0
HORIZONS_S = (10.0, 30.0, 60.0)
"""Times without positions after which `hold_out` takes the errors, s."""
_SETTLED_S = 120.0


def hold_out(readings: Readings) -> dict[str, dict[float, np.ndarray]]:
    """Errors (n,) in metres after a time without satellites, by method and horizon.

    Satellite fixes and speeds are hidden for a minute at a time, and predictions are compared with
    the hidden fixes: by the navigator, by the last satellite velocity (or that of the last fixes),
    and by heading and speed through water alone.
    """
    starts_s = _hidden_from_s(readings)
    hidden = _is_hidden(readings.time_s, starts_s)
    seen = readings._replace(
        fix_m=np.where(hidden[:, None], np.nan, readings.fix_m),
        velocity_mps=np.where(hidden[:, None], np.nan, readings.velocity_mps),
    )
    predicted = {"navigator": navigate(seen).position_m, "constant_velocity": _straight_on(seen)}
    if readings.knows_water:
        predicted["dead_reckoning"] = _reckoned(seen)
    return {name: _errors(readings, place_m, starts_s) for name, place_m in predicted.items()}


def medians(errors: Mapping[float, np.ndarray]) -> dict[float, float]:
    """Median error by horizon; NaN where nothing could be compared."""
    return {h: float(np.median(e)) if len(e) else float("nan") for h, e in errors.items()}


def without_hidden(part: NavigationLog, readings: Readings) -> NavigationLog:
    """A part of a log without the speeds over ground that `hold_out` of its readings hides."""
    hidden = _is_hidden(part.ground.time_s, _hidden_from_s(readings))
    return dataclasses.replace(part, ground=part.ground.rows(~hidden))


def _hidden_from_s(readings: Readings) -> np.ndarray:
    """Times (n,) at which satellites become hidden."""
    first_s, last_s = readings.time_s[[0, -1]]
    return np.arange(first_s + _SETTLED_S, last_s - HIDDEN_S - HIDDEN_EVERY_S / 2, HIDDEN_EVERY_S)


def _is_hidden(time_s: np.ndarray, starts_s: np.ndarray) -> np.ndarray:
    """Mask (T,) of times after a start, up to its end; starts are sorted and farther apart."""
    last = np.searchsorted(starts_s, time_s) - 1
    return (last >= 0) & (time_s - np.append(starts_s, 0.0)[last] <= HIDDEN_S)


def _straight_on(seen: Readings) -> np.ndarray:
    """Positions (T, 2) predicted from the last fix with the last velocity over ground."""
    fix, fixed_s = held(seen.time_s, seen.fix_m)
    given = np.isfinite(seen.velocity_mps).any()
    velocity, _ = held(seen.time_s, seen.velocity_mps if given else made_good_mps(seen))
    return navigation.predict_position_m(fix, velocity, seen.time_s - fixed_s)


def _reckoned(seen: Readings) -> np.ndarray:
    """Positions (T, 2) predicted from the last fix by heading and speed through water."""
    way_rad, _ = held(seen.time_s, seen.way_rad)
    speed, _ = held(seen.time_s, seen.way_mps)
    water = np.nan_to_num(navigation.velocity_mps(speed, way_rad))
    way = travelled_m(np.diff(seen.time_s), water[:-1])
    fix, _ = held(seen.time_s, seen.fix_m)
    way_at_fix, _ = held(seen.time_s, np.where(np.isfinite(seen.fix_m), way, np.nan))
    return fix + way - way_at_fix


def _errors(
    readings: Readings, place_m: np.ndarray, starts_s: np.ndarray
) -> dict[float, np.ndarray]:
    """Distances of predicted positions (T, 2) from hidden fixes, by horizon."""
    fixed = np.flatnonzero(readings.has_fix)
    times = readings.time_s[fixed]
    errors: dict[float, list[float]] = {horizon_s: [] for horizon_s in HORIZONS_S}
    for start_s in progress(starts_s, len(starts_s), "comparing with hidden fixes"):
        after, end = np.searchsorted(times, [start_s, start_s + HIDDEN_S], side="right")
        if start_s - times[after - 1] > NEAR_S or after == end:
            continue
        for horizon_s in HORIZONS_S:
            apart_s = np.abs(times[after:end] - start_s - horizon_s)
            k = fixed[after + apart_s.argmin()]
            if apart_s.min() <= NEAR_S and np.isfinite(place_m[k]).all():
                errors[horizon_s].append(float(np.hypot(*(place_m[k] - readings.fix_m[k]))))
    return {horizon_s: np.array(values) for horizon_s, values in errors.items()}
