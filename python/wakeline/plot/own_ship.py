"""Own ship's solution: its path, and speed, course, drift and biases over time."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from wakeline._checks import shaped
from wakeline._units import KNOT_MPS

from .style import (
    INK,
    MUTED,
    PALETTE,
    TEXT_PT,
    dot_lone,
    dress,
    dress_map,
    figure,
    from_zero,
    name_lines,
    through_north,
    with_gaps,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from wakeline.own_ship import Leg

_ARROWS = 24
_LEAST_KM = 0.005  # from the middle of a map to its edge
_LONGEST = 0.1  # arrow, as a share of the width of the map


def own_map(
    ax: Axes,
    position_m: np.ndarray,
    fix_m: np.ndarray,
    current_mps: np.ndarray | None = None,
    *,
    coasting: np.ndarray | None = None,
    jumped: np.ndarray | None = None,
    name: str = "own ship",
) -> Axes:
    """Map of own ship's path and fixes, north up, with the current along it; returns `ax`.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Axes to draw into.
    position_m, fix_m : ndarray (T, 2), (n, 2)
        North and east, of the solution and of fixes.
    current_mps : ndarray (T, 2), optional
        North and east; drawn as arrows where finite, with a scale arrow of a round speed.
    coasting : ndarray of bool (T,), optional
        Times without fixes.
    jumped : ndarray of bool (T,), optional
        Times at which the position is in doubt after a jump.
    name : str
        Label of the path.
    """
    position_m, fix_m = shaped("position_m", position_m, None, 2), shaped("fix_m", fix_m, None, 2)
    ax.plot(fix_m[:, 1] / 1e3, fix_m[:, 0] / 1e3, ".", color=MUTED, markersize=3, label="fixes")
    way = position_m / 1e3
    dot_lone(*ax.plot(way[:, 1], way[:, 0], color=PALETTE[0], linewidth=1.5, label=name))
    for what, where, color, doubt in (
        ("coasting", coasting, PALETTE[1], "without fixes"),
        ("jumped", jumped, PALETTE[3], "after a jump"),
    ):
        marked = where is not None and shaped(what, where, len(way)).astype(bool)
        if np.any(marked):
            part = np.where(marked[:, None], way, np.nan)
            line = ax.plot(part[:, 1], part[:, 0], color=color, linewidth=2.0, label=doubt)
            dot_lone(*line)
    if current_mps is not None:
        current_mps = shaped("current_mps", current_mps, len(way), 2)
        placed = np.isfinite(way).all(axis=1)
        known = np.flatnonzero(placed & np.isfinite(current_mps).all(axis=1))
        if len(known):
            at = known[np.linspace(0, len(known) - 1, min(_ARROWS, len(known))).astype(int)]
            across_km = np.ptp(way[placed], axis=0).max()
            _arrows(ax, way[at], current_mps[at] / KNOT_MPS, _LONGEST * across_km)
    _widen(ax, np.concatenate([way, fix_m / 1e3]))
    return name_lines(dress_map(ax))


def _widen(ax: Axes, places_km: np.ndarray) -> None:
    """Show some metres around places (n, 2), which may be one spot."""
    places_km = places_km[np.isfinite(places_km).all(axis=1)]
    if len(places_km):
        north_km, east_km = 0.5 * (places_km.min(axis=0) + places_km.max(axis=0))
        for around_km in (-_LEAST_KM, _LEAST_KM):
            ax.update_datalim([(east_km + around_km, north_km + around_km)])


def _arrows(ax: Axes, from_km: np.ndarray, drift_kn: np.ndarray, longest_km: float) -> None:
    """Arrows (n, 2) north and east of drifts of a given maximum length, and a scale arrow."""
    most_kn = np.hypot(*drift_kn.T).max()
    if not (most_kn > 0 and longest_km > 0):
        return
    to_km = from_km + drift_kn * longest_km / most_kn
    ax.update_datalim(to_km[:, ::-1])
    arrows = ax.quiver(
        from_km[:, 1],
        from_km[:, 0],
        drift_kn[:, 1],
        drift_kn[:, 0],
        color=PALETTE[2],
        width=0.003,
        angles="xy",
        scale_units="xy",
        scale=most_kn / longest_km,
        zorder=4,
    )
    round_kn = _round_below(most_kn)
    ax.quiverkey(
        arrows,
        1.0 - _LONGEST,
        1.028,
        round_kn,
        f"current of {round_kn:g} kn",
        labelpos="W",
        labelcolor=INK,
        fontproperties={"size": TEXT_PT},
    )


def _round_below(value: float) -> float:
    """The largest 1, 2 or 5 times a power of ten that is not above a value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= value))


def speed_over_time(
    ax: Axes, time_s: np.ndarray, over_ground_mps: np.ndarray, through_water_mps: np.ndarray
) -> Axes:
    """Known speeds in knots over time in minutes; returns `ax`."""
    time_s = shaped("time_s", time_s, None)
    over_ground_mps = shaped("over_ground_mps", over_ground_mps, len(time_s))
    through_water_mps = shaped("through_water_mps", through_water_mps, len(time_s))
    for values, color, name in (
        (over_ground_mps, PALETTE[0], "over ground"),
        (through_water_mps, PALETTE[2], "through water"),
    ):
        _draw(ax, _by_minute(time_s, values / KNOT_MPS), color, name)
    return name_lines(_over_time(from_zero(ax), "speed (kn)"))


def course_over_time(
    ax: Axes, time_s: np.ndarray, course_rad: np.ndarray, heading_rad: np.ndarray
) -> Axes:
    """Course over ground and heading in degrees over time, where known; returns `ax`."""
    time_s = shaped("time_s", time_s, None)
    course_rad = shaped("course_rad", course_rad, len(time_s))
    heading_rad = shaped("heading_rad", heading_rad, len(time_s))
    for values, color, name in (
        (course_rad, PALETTE[0], "course over ground"),
        (heading_rad, PALETTE[1], "heading"),
    ):
        line = through_north(*_by_minute(time_s, np.degrees(values) % 360.0))
        _draw(ax, line, color, name)
    ax.set_ylim(0.0, 360.0)
    ax.set_yticks([0, 90, 180, 270, 360])
    return name_lines(_over_time(ax, "course (°)"))


def drift_over_time(
    ax: Axes, time_s: np.ndarray, current_mps: np.ndarray, fix_time_s: np.ndarray
) -> Axes:
    """Drift in knots over time, with the times of fixes marked below; returns `ax`."""
    time_s, fix_time_s = shaped("time_s", time_s, None), shaped("fix_time_s", fix_time_s, None)
    current_mps = shaped("current_mps", current_mps, len(time_s), 2)
    drift_kn = np.hypot(current_mps[:, 0], current_mps[:, 1]) / KNOT_MPS
    _draw(ax, _by_minute(time_s, drift_kn), PALETTE[2], "drift")
    minutes = (fix_time_s - (time_s[0] if len(time_s) else 0.0)) / 60.0
    ax.plot(minutes, np.zeros(len(minutes)), "|", color=INK, markersize=4, label="fixes")
    return name_lines(_over_time(from_zero(ax), "drift (kn)"))


def biases_over_time(
    ax: Axes,
    time_s: np.ndarray,
    bias: Mapping[str, np.ndarray],
    std: Mapping[str, np.ndarray],
    ylabel: str,
) -> Axes:
    """Biases of an IMU by name over time, with two standard deviations; returns `ax`."""
    time_s = shaped("time_s", time_s, None)
    minutes = (time_s - (time_s[0] if len(time_s) else 0.0)) / 60.0
    low, high = [], []
    for color, (name, values) in zip((PALETTE[0], PALETTE[1]), bias.items(), strict=False):
        values = shaped(f"bias of {name}", values, len(time_s))
        spread = 2.0 * shaped(f"std of {name}", std[name], len(time_s))
        ax.fill_between(
            minutes, values - spread, values + spread, color=color, alpha=0.18, linewidth=0
        )
        ax.plot(minutes, values, color=color, linewidth=1.2, label=name)
        settled = len(values) // 10  # the wide beginning would hide the rest
        low.append(np.min((values - 2.0 * spread)[settled:], initial=np.inf))
        high.append(np.max((values + 2.0 * spread)[settled:], initial=-np.inf))
    if len(time_s):
        ax.set_ylim(min(low), max(high))
    return name_lines(_over_time(ax, ylabel))


def own_map_figure(leg: Leg, *, name: str = "own ship") -> Figure:
    """A figure of one :func:`own_map`: a leg of a voyage and its fixes."""
    fig, track = figure(7.2, 6.4), leg.track
    own_map(
        fig.add_subplot(),
        track.position_m,
        leg.readings.fix_m[leg.readings.has_fix],
        track.current_mps,
        coasting=track.status == "coasting",
        jumped=track.status == "jumped",
        name=name,
    )
    return fig


def own_time_figure(leg: Leg) -> Figure:
    """A figure of speed, course and, where known, drift or the biases of an IMU over time."""
    track, readings = leg.track, leg.readings
    time_s = track.time_s
    views = [
        partial(
            speed_over_time,
            time_s=time_s,
            over_ground_mps=np.hypot(*track.velocity_mps.T),
            through_water_mps=readings.log_mps,
        ),
        partial(
            course_over_time,
            time_s=time_s,
            course_rad=track.course_rad,
            heading_rad=track.heading_rad,
        ),
    ]
    if np.isfinite(track.current_mps).any():
        fix_s = readings.time_s[readings.has_fix]
        current_mps = track.current_mps
        views.append(
            partial(drift_over_time, time_s=time_s, current_mps=current_mps, fix_time_s=fix_s)
        )
    if readings.has_imu:
        for names, ylabel, unit in (
            ({"forward": 0, "starboard": 1}, "bias (m/s²)", 1.0),
            ({"gyro": 2}, "bias (°/s)", np.degrees(1.0)),
        ):
            bias, std = (
                {name: unit * values[:, k] for name, k in names.items()}
                for values in (track.imu_bias, track.imu_bias_std)
            )
            views.append(
                partial(biases_over_time, time_s=time_s, bias=bias, std=std, ylabel=ylabel)
            )
    fig = figure(7.2, 0.2 + 2.2 * len(views))
    panels = fig.subplots(len(views), 1, sharex=True)
    for ax, view in zip(panels, views, strict=True):
        view(ax)
    for ax in panels[:-1]:
        ax.set_xlabel("")
    fig.align_ylabels(panels)
    return fig


def _draw(ax: Axes, line: tuple[np.ndarray, np.ndarray], color: str, name: str) -> None:
    if len(line[0]):
        dot_lone(*ax.plot(*line, color=color, linewidth=1.2, label=name))


def _by_minute(time_s: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    known = np.isfinite(values)
    if not known.any():
        return np.zeros(0), np.zeros(0)
    times, drawn = with_gaps(time_s[known], values[known])
    return (times - time_s[0]) / 60.0, drawn


def _over_time(ax: Axes, ylabel: str) -> Axes:
    ax.set(xlabel="time (min)", ylabel=ylabel)
    return dress(ax)
