"""Position forecasts of other vessels: the models of :mod:`wakeline.forecast` on AIS.

The vessels of the Solent report position, course and speed every few seconds. Every 15 seconds a
forecast for one, three and six minutes is made and compared with the later position. Nothing is
random here: there is one run.

Scenarios are ``after_60s`` and so on; with ``_turning`` those forecasts that begin while the course
changes by more than half a degree a second.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from wakeline import forecast, plot, recording
from wakeline.recording import AisTrack

from . import under_way
from .base import Done, Picture, Plan, Request, Rows, Study

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HORIZONS_S = (60.0, 180.0, 360.0)
TURNING_RAD_S = np.deg2rad(0.5)
LABELS = {
    "last_report": "last report, constant velocity",
    "line_60s": "line through 60 s",
    "kalman_cv": "Kalman, constant velocity",
    "turning_on": "turning on",
    "turn_that_ends": "decaying turn rate",
    "window_5": "smoothed, last five",
    "two_pass": "smoothed, two passes",
    "window_bank": "smoothed, bank of windows",
}

_NOTE = "{count} forecasts, {share:.0%} of them from a turn of more than half a degree a second on"
_EVERY_S = 15.0
_HISTORY_S = 60.0
_CURVE_S = np.arange(20.0, 361.0, 20.0)


def _plan(request: Request) -> Plan:
    ahead_s = np.unique([*_CURVE_S, *HORIZONS_S])

    def turning(done: Done) -> np.ndarray:
        return done["forecasts"][1]

    def pictures(done: Done, rows: Rows) -> list[Picture]:
        table, turning = done["forecasts"]
        panels = (
            partial(_draw, table=table, which=which, ahead_s=ahead_s)
            for which in (np.ones(len(turning), bool), turning)
        )
        title = "Error of a forecast: half of all, and of those that begin in a turn"
        return [Picture("forecast-errors", title, tuple(panels), size_in=(7.2, 6.6))]

    return Plan(
        jobs={"forecasts": partial(_errors, ahead_s)},
        rows=lambda done: [row for one in done.values() for row in _rows(*one, ahead_s)],
        pictures=pictures,
        notes=lambda done, rows: [
            _NOTE.format(count=len(turning(done)), share=np.mean(turning(done)))
        ],
        runs=1,
    )


STUDY = Study(
    "ais-forecast",
    "forecasts of vessels in the Solent from their AIS, one to six minutes ahead",
    _plan,
    random=False,
)
run = STUDY.run


def _errors(ahead_s: np.ndarray) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Errors (n, H) of n forecasts by model, and which of them (n,) begin in a turn."""
    errors: dict[str, list[np.ndarray]] = {name: [] for name in forecast.names()}
    turning = []
    for past, later_m in _cases(ahead_s):
        turning.append(abs(forecast.turn_rate_rad_s(past)) > TURNING_RAD_S)
        for name, of_model in errors.items():
            of_model.append(np.hypot(*(forecast.position_m(past, ahead_s, name) - later_m).T))
    return {name: np.array(values) for name, values in errors.items()}, np.array(turning)


@lru_cache(maxsize=1)
def _tracks() -> tuple[AisTrack, ...]:
    """Segments of vessels under way that are long enough for a forecast."""
    tracks = recording.load_ais().tracks.values()
    parts = (part for track in tracks for part in under_way.stretches(track))
    return tuple(part for part in parts if np.ptp(part.time_s) > _HISTORY_S + max(HORIZONS_S))


def _cases(ahead_s: np.ndarray) -> Iterator[tuple[AisTrack, np.ndarray]]:
    """The reports of a vessel until a time, and its later positions (H, 2)."""
    for track in _tracks():
        last_s = track.time_s[-1] - ahead_s.max()
        for now_s in np.arange(track.time_s[0] + _HISTORY_S, last_s, _EVERY_S):
            end = int(np.searchsorted(track.time_s, now_s, side="right"))
            then_s = track.time_s[end - 1] + ahead_s
            later_m = [
                np.interp(then_s, track.time_s, place_m)
                for place_m in (track.north_m, track.east_m)
            ]
            yield track.rows(slice(end)), np.column_stack(later_m)


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
