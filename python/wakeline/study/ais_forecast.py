"""Where other vessels will be: forecasts from AIS, by the same models as own ship's.

The vessels of the Solent report position, course and speed every few seconds. From each quarter of
a minute on it is foretold where a vessel will be after one, three and six minutes, and compared
with where it then was. Nothing is random here: there is one run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import wakeline as wl
from wakeline import plot, recording
from wakeline.recording import AisTrack

from .base import Picture, Report, Rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SUMMARY = "forecasts of vessels in the Solent from their AIS, one to six minutes ahead"

HORIZONS_S = (60.0, 180.0, 360.0)
TURNING_RAD_S = np.deg2rad(0.5)
LABELS = {
    "last_report": "last report, straight on",
    "line_60s": "line through 60 s",
    "kalman_cv": "Kalman, straight on",
    "turning_on": "turning on",
    "turn_that_ends": "a turn that ends",
}

_NOTE = "{count} forecasts, {share:.0%} of them from a turn of more than half a degree a second on"
_EVERY_S = 15.0
_MAX_GAP_S = 25.0
_LEAST_SPEED_MPS = 2.0
_HISTORY_S = 60.0
_RATE_OVER_S = 30.0
_TURN_ENDS_S = 30.0
_POSITION_STD_M = 10.0
_CURVE_S = np.arange(20.0, 361.0, 20.0)


class Origin(NamedTuple):
    """A vessel at the time of a forecast: its reports so far, and its rate of turn."""

    past: AisTrack
    turn_rate_rad_s: float


Model = Callable[[Origin, np.ndarray], np.ndarray]


def models() -> dict[str, Model]:
    """From an origin and times ahead (H,), places (H, 2) relative to the last report, by name."""
    return {
        "last_report": _last_report,
        "line_60s": _line,
        "kalman_cv": _kalman,
        "turning_on": partial(_turning, ends_s=np.inf),
        "turn_that_ends": partial(_turning, ends_s=_TURN_ENDS_S),
    }


def run(
    runs: int = 1,
    seed: int = 0,
    *,
    full: bool = False,
    threads: int | None = None,
    progress: bool = False,
) -> Report:
    """Run the study; there is nothing random in it, and no argument changes the figures.

    Returns
    -------
    Report
        Scenarios ``after_60s`` and so on, and with ``_turning`` those forecasts that begin while
        the course changes by more than half a degree a second.
    """
    ahead_s = np.unique([*_CURVE_S, *HORIZONS_S])
    errors = {name: [] for name in models()}
    turning = []
    for origin, later_m in _cases(ahead_s):
        turning.append(abs(origin.turn_rate_rad_s) > TURNING_RAD_S)
        for name, model in models().items():
            errors[name].append(np.hypot(*(model(origin, ahead_s) - later_m).T))
    table = {name: np.array(values) for name, values in errors.items()}
    return Report(
        name="ais-forecast",
        seed=seed,
        runs=1,
        rows=_rows(table, np.array(turning), ahead_s),
        result=table,
        pictures=(
            Picture(
                "forecast-errors",
                "Error of a forecast: half of all, and of those that begin in a turn",
                (
                    partial(_draw, table=table, which=np.ones(len(turning), bool), ahead_s=ahead_s),
                    partial(_draw, table=table, which=np.array(turning), ahead_s=ahead_s),
                ),
                size_in=(7.2, 6.6),
            ),
        ),
        notes=(_NOTE.format(count=len(turning), share=np.mean(turning)),),
    )


@lru_cache(maxsize=1)
def _tracks() -> tuple[AisTrack, ...]:
    """Gapless stretches of vessels under way, long enough for a forecast."""
    stretches = []
    for track in recording.load_ais().tracks.values():
        for part in track.parts(_MAX_GAP_S):
            way = (part.speed_mps > _LEAST_SPEED_MPS) & np.isfinite(part.course_rad)
            rows = np.flatnonzero(way)
            for one in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1):
                if len(one) and np.ptp(part.time_s[one]) > _HISTORY_S + max(HORIZONS_S):
                    stretches.append(part.rows(one))
    return tuple(stretches)


def _cases(ahead_s: np.ndarray) -> Iterator[tuple[Origin, np.ndarray]]:
    """Origins, and where the vessel then was (H, 2) relative to its last report."""
    for track in _tracks():
        last_s = track.time_s[-1] - ahead_s.max()
        for now_s in np.arange(track.time_s[0] + _HISTORY_S, last_s, _EVERY_S):
            end = int(np.searchsorted(track.time_s, now_s, side="right"))
            begin = int(np.searchsorted(track.time_s, track.time_s[end - 1] - 2 * _HISTORY_S))
            past = track.rows(slice(begin, end))
            then_s = past.time_s[-1] + ahead_s
            later_m = np.column_stack(
                [
                    np.interp(then_s, track.time_s, track.north_m) - past.north_m[-1],
                    np.interp(then_s, track.time_s, track.east_m) - past.east_m[-1],
                ]
            )
            yield Origin(past, _turn_rate_rad_s(past)), later_m


def _turn_rate_rad_s(past: AisTrack) -> float:
    """Slope of the reported course over the last half minute."""
    age_s = past.time_s - past.time_s[-1]
    recent = age_s >= -_RATE_OVER_S
    if recent.sum() < 3:
        return 0.0
    return float(np.polyfit(age_s[recent], np.unwrap(past.course_rad[recent]), 1)[0])


def _last_report(origin: Origin, ahead_s: np.ndarray) -> np.ndarray:
    velocity = np.array([origin.past.vnorth_mps[-1], origin.past.veast_mps[-1]])
    return ahead_s[:, None] * velocity


def _line(origin: Origin, ahead_s: np.ndarray) -> np.ndarray:
    past = origin.past
    age_s = past.time_s - past.time_s[-1]
    recent = age_s >= -_HISTORY_S
    return np.column_stack(
        [
            np.polyval(np.polyfit(age_s[recent], (values - values[-1])[recent], 1), ahead_s)
            for values in (past.north_m, past.east_m)
        ]
    )


def _kalman(origin: Origin, ahead_s: np.ndarray) -> np.ndarray:
    past = origin.past
    place = np.column_stack([past.north_m - past.north_m[-1], past.east_m - past.east_m[-1]])
    start = wl.Gaussian(
        [place[0, 0], past.vnorth_mps[0], place[0, 1], past.veast_mps[0]],
        np.diag([_POSITION_STD_M**2, 1.0, _POSITION_STD_M**2, 1.0]),
    )
    done = wl.Kalman(wl.ConstantVelocity()).run(
        place,
        dt_s=np.diff(past.time_s, prepend=past.time_s[0]),
        sensor=wl.Position(position_std_m=_POSITION_STD_M),
        start=start,
    )
    north, vnorth, east, veast = done.mean[-1]
    return np.array([north, east]) + ahead_s[:, None] * np.array([vnorth, veast])


def _turning(origin: Origin, ahead_s: np.ndarray, *, ends_s: float) -> np.ndarray:
    """On with the reported speed and a rate of turn that fades with a time constant."""
    step_s = 1.0
    times = np.arange(0.0, ahead_s.max() + step_s, step_s)
    rate = origin.turn_rate_rad_s
    turned = rate * (times if np.isinf(ends_s) else ends_s * (1.0 - np.exp(-times / ends_s)))
    course = origin.past.course_rad[-1] + turned
    speed = origin.past.speed_mps[-1]
    middle = 0.5 * (course[1:] + course[:-1])
    way = speed * step_s * np.column_stack([np.cos(middle), np.sin(middle)])
    places = np.vstack([np.zeros((1, 2)), np.cumsum(way, axis=0)])
    return np.column_stack([np.interp(ahead_s, times, places[:, axis]) for axis in range(2)])


def _rows(table: dict[str, np.ndarray], turning: np.ndarray, ahead_s: np.ndarray) -> Rows:
    rows: list[dict[str, Any]] = []
    for end, which in (("", np.ones(len(turning), bool)), ("_turning", turning)):
        for horizon_s in HORIZONS_S:
            at = int(np.searchsorted(ahead_s, horizon_s))
            for name, errors in table.items():
                found = errors[which, at]
                rows.append(
                    {
                        "scenario": f"after_{horizon_s:.0f}s{end}",
                        "estimator": name,
                        "position_median_m": float(np.median(found)),
                        "position_p90_m": float(np.percentile(found, 90)),
                    }
                )
    return rows


def _draw(ax: Axes, table: dict[str, np.ndarray], which: np.ndarray, ahead_s: np.ndarray) -> Axes:
    for (name, errors), color in zip(table.items(), plot.PALETTE, strict=False):
        median_m = np.median(errors[which], axis=0)
        ax.plot(ahead_s, median_m, color=color, linewidth=1.6, label=LABELS[name])
    ax.set_yscale("log")
    ax.set(xlabel="time ahead (s)", ylabel=f"median error (m)\n{which.sum()} forecasts")
    plot.dress(ax)
    return plot.name_lines(ax, columns=3) if which.all() else ax
