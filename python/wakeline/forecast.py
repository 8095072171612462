"""Position forecasts of other vessels from their AIS reports or from a track.

>>> from wakeline import forecast, recording
>>> track = recording.load_ais().tracks["235007473"]
>>> forecast.position_m(track, [60.0, 180.0], "turn_that_ends").shape
(2, 2)
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import wakeline as wl
from wakeline import filter as wf
from wakeline._checks import real_numbers
from wakeline.recording import AisTrack, Tracks

__all__ = ["names", "position_m", "turn_rate_rad_s"]

_RATE_OVER_S = 30.0
_LINE_OVER_S = 60.0
_KALMAN_OVER_S = 120.0
_TURN_ENDS_S = 30.0
_STEP_S = 1.0
_POSITION_STD_M = 10.0
_VELOCITY_STD_MPS = 1.0


def names() -> list[str]:
    """Names of the models."""
    return list(_MODELS)


def position_m(
    track: AisTrack | Tracks, ahead_s: ArrayLike, model: str = "last_report"
) -> NDArray[np.float64]:
    """Predict a vessel's position at times after its last report.

    Parameters
    ----------
    track : AisTrack or Tracks
        Reports so far, all with course and speed; or the rows of one track, in order of time.
    ahead_s : (H,) array_like
        Seconds after the last of them.
    model : str
        ``last_report``: constant velocity with course and speed of the last report. ``line_60s``:
        along the line through the positions of the last minute. ``kalman_cv``: constant velocity
        from a Kalman filter over the positions of the last two minutes. ``turning_on``: constant
        speed and turn rate, that of the last half minute. ``turn_that_ends``: the same, the turn
        rate decaying with a time constant of half a minute. ``window_5``, ``two_pass`` and
        ``window_bank``: constant velocity with course and speed smoothed over the reports of the
        last two minutes: the combined prediction (11) of `theory/dead_reckoning.md`, by the gains
        (27) over five reports, by (33) and by the bank of windows.

    Returns
    -------
    ndarray (H, 2)
        North and east, in the plane of the track.

    Raises
    ------
    ValueError
        When no model has that name, a report lacks position, course or speed, the last minute has
        reports of fewer than two times, or a time ahead is negative or not finite; when rows are
        of several tracks or out of order.
    """
    track = _reports(track)
    ahead_s = real_numbers("ahead_s", ahead_s)
    if model not in _MODELS:
        raise ValueError(f"model must be one of {', '.join(_MODELS)}, got {model!r}")
    if ahead_s.ndim != 1 or not ((ahead_s >= 0.0) & np.isfinite(ahead_s)).all():
        raise ValueError(f"ahead_s must be finite times (H,), none negative, got {ahead_s}")
    columns = (track.north_m, track.east_m, track.course_rad, track.speed_mps)
    if not np.isfinite(columns).all():
        raise ValueError("every report of the track must have a position, a course and a speed")
    if len(track) == 0 or np.ptp(_last(track, _LINE_OVER_S).time_s) == 0.0:
        raise ValueError("the track must have reports of two times or more in its last minute")
    return np.array([track.north_m[-1], track.east_m[-1]]) + _MODELS[model](track, ahead_s)


def turn_rate_rad_s(track: AisTrack | Tracks) -> float:
    """Slope of the reported courses over the last half minute.

    Zero for fewer than three reports, or if all have the same time.
    """
    recent = _last(_reports(track), _RATE_OVER_S)
    recent = recent.rows(np.isfinite(recent.course_rad))
    if len(recent) < 3 or np.ptp(recent.time_s) == 0.0:
        return 0.0
    return float(np.polyfit(_age_s(recent), np.unwrap(recent.course_rad), 1)[0])


# The models: displacements (H, 2) from the last report -------------------------------------------


def _last_report(track: AisTrack, ahead_s: np.ndarray) -> np.ndarray:
    return ahead_s[:, None] * np.array([track.vnorth_mps[-1], track.veast_mps[-1]])


def _line(track: AisTrack, ahead_s: np.ndarray) -> np.ndarray:
    recent = _last(track, _LINE_OVER_S)
    lines = np.polyfit(_age_s(recent), _way_m(recent), 1)
    return ahead_s[:, None] * lines[0] + lines[1]


def _kalman(track: AisTrack, ahead_s: np.ndarray) -> np.ndarray:
    recent = _last(track, _KALMAN_OVER_S)
    way_m = _way_m(recent)
    start = wl.Gaussian(
        [way_m[0, 0], recent.vnorth_mps[0], way_m[0, 1], recent.veast_mps[0]],
        np.diag([_POSITION_STD_M**2, _VELOCITY_STD_MPS**2] * 2),
    )
    done = wl.Kalman(wl.ConstantVelocity()).run(
        way_m[1:],
        dt_s=np.diff(recent.time_s),
        sensor=wl.Position(position_std_m=_POSITION_STD_M),
        start=start,
    )
    north, vnorth, east, veast = done.mean[-1]
    return np.array([north, east]) + ahead_s[:, None] * np.array([vnorth, veast])


def _turning(track: AisTrack, ahead_s: np.ndarray, *, ends_s: float) -> np.ndarray:
    """Constant reported speed and a turn rate that decays with a time constant."""
    times_s = np.arange(0.0, ahead_s.max(initial=0.0) + _STEP_S, _STEP_S)
    turned_s = times_s if np.isinf(ends_s) else ends_s * (1.0 - np.exp(-times_s / ends_s))
    course_rad = track.course_rad[-1] + turn_rate_rad_s(track) * turned_s
    middle_rad = 0.5 * (course_rad[1:] + course_rad[:-1])
    steps_m = track.speed_mps[-1] * _STEP_S * np.array([np.cos(middle_rad), np.sin(middle_rad)])
    return np.column_stack(
        [np.interp(ahead_s, times_s, np.append(0.0, np.cumsum(step_m))) for step_m in steps_m]
    )


def _smoothed(
    track: AisTrack, ahead_s: np.ndarray, *, make: Callable[[bool], Any], reports: int | None = None
) -> np.ndarray:
    """Constant velocity with smoothed speed and course."""
    recent = _last(track, _KALMAN_OVER_S)
    if reports is not None:
        recent = recent.rows(slice(-reports, None))
    dt_s = np.diff(recent.time_s, prepend=recent.time_s[0])
    speed_mps, course_rad = (
        make(wrapped).run(dt_s, readings)[0][-1]
        for wrapped, readings in ((False, recent.speed_mps), (True, recent.course_rad))
    )
    return ahead_s[:, None] * speed_mps * np.array([np.cos(course_rad), np.sin(course_rad)])


_MODELS: dict[str, Callable[[AisTrack, np.ndarray], np.ndarray]] = {
    "last_report": _last_report,
    "line_60s": _line,
    "kalman_cv": _kalman,
    "turning_on": partial(_turning, ends_s=np.inf),
    "turn_that_ends": partial(_turning, ends_s=_TURN_ENDS_S),
    "window_5": partial(
        _smoothed,
        make=lambda wrapped: wf.AlphaBetaSmoother(wf.GrowingMemory(), wrapped=wrapped),
        reports=5,
    ),
    "two_pass": partial(_smoothed, make=lambda wrapped: wf.AdaptiveAlphaBeta(wrapped=wrapped)),
    "window_bank": partial(_smoothed, make=lambda wrapped: wf.WindowBank(wrapped=wrapped)),
}


def _reports(track: AisTrack | Tracks) -> AisTrack:
    """Each row of a track as a report of position, course and speed."""
    if isinstance(track, AisTrack):
        return track
    if not isinstance(track, Tracks):
        raise TypeError(f"track must be an AisTrack or Tracks, got {type(track).__name__}")
    if len(track.ids()) > 1:
        raise ValueError(f"track must be rows of one track, got {len(track.ids())} tracks")
    if not (np.diff(track.time_s) > 0).all():
        raise ValueError("the rows of the track must be in order of time")
    north_m, vnorth_mps, east_m, veast_mps = track.state.T
    return AisTrack(
        mmsi="",
        time_s=track.time_s,
        north_m=north_m,
        east_m=east_m,
        course_rad=np.arctan2(veast_mps, vnorth_mps),
        speed_mps=np.hypot(vnorth_mps, veast_mps),
    )


def _age_s(track: AisTrack) -> np.ndarray:
    """Times of the reports, that of the last being zero."""
    return track.time_s - track.time_s[-1:]


def _last(track: AisTrack, over_s: float) -> AisTrack:
    """The reports of the last seconds."""
    return track.rows(_age_s(track) >= -over_s)


def _way_m(track: AisTrack) -> np.ndarray:
    """Positions (n, 2) from the last report."""
    return np.column_stack([track.north_m - track.north_m[-1], track.east_m - track.east_m[-1]])
