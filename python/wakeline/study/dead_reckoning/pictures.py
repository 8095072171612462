"""Pictures of the study."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import wakeline as wl
from wakeline import navigation as nav
from wakeline import plot
from wakeline._units import KNOT_MPS
from wakeline.metrics import rmse
from wakeline.scenario import voyage as sea

from .. import curves
from ..base import Picture, Rows
from .combined import PAPER as PAPER_COMBINED
from .quantities import AHEAD, METRICS, PLACE, UNIT, Predicted, columns, is_angle
from .smoothers import every

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SHOWN = {"adaptive_two_pass": 1, "window_bank": 2, "kalman": 0}  # with their colours
_SHOWN_STEP_S = 3.0
_FAMILIES = {
    "exponential": {"exponential": "(21)", "adaptive_exponential": "(23)"},
    "three points": {"three_point": "(22), (25)", "adaptive_three_point": "(24), (25)"},
    "fixed gains": {
        "alpha_beta_w5": "(27)",
        "gains_28_w5": "(28)",
        "gains_29_w5": "(29)",
        "gains_30": "(30)",
    },
    "adaptive gains": {
        "adaptive_two_pass": "(33), two passes",
        "adaptive_one_pass": "(33), one pass",
    },
}
_THREE_POINTS = ("three_point", "adaptive_three_point")  # their value is that one reading ago


class _Shown(NamedTuple):
    """How a quantity is drawn: metric, name, unit, and part of the voyage."""

    metric: str
    name: str
    unit: str
    part_s: tuple[float, float]


_QUANTITIES = {
    "reckoning-speed": _Shown("speed_rms_kn", "speed", "kn", (360.0, 660.0)),
    "reckoning-course": _Shown("course_rms_deg", "course", "°", (660.0, 960.0)),
    "reckoning-latitude": _Shown("latitude_rms_arcmin", "latitude", "′", (180.0, 300.0)),
    "reckoning-longitude": _Shown("longitude_rms_arcmin", "longitude", "′", (180.0, 300.0)),
}


Windows = Mapping[int, Mapping[str, Mapping[str, np.ndarray]]]
Maneuvers = Mapping[str, tuple[np.ndarray, Mapping[str, np.ndarray]]]


def pictures_of(
    rows: Rows,
    steps_s: Mapping[str, float],
    drifts: Mapping[str, np.ndarray],
    windows: Windows,
    maneuvers: Maneuvers,
    seed: int,
) -> tuple[Picture, ...]:
    """All pictures; `windows` and `maneuvers` are the results of these jobs."""
    quantities = (
        Picture(
            name,
            f"{shown.name.capitalize()}: smoothed, and predicted 12 s ahead (reading every 3 s)",
            (
                partial(_draw_smoothed, shown=shown, seed=seed),
                partial(_draw_predicted, shown=shown, seed=seed),
            ),
            size_in=(8.4, 6.4),
        )
        for name, shown in _QUANTITIES.items()
    )
    return (
        Picture(
            "reckoning-wind-current",
            "Wind current (14) against latitude",
            (_draw_wind_current,),
            size_in=(7.2, 4.6),
        ),
        *quantities,
        *(_every_formula(shown, seed) for shown in _QUANTITIES.values()),
        Picture(
            "reckoning-rates",
            "Rates of change, from a reading every 3 s",
            tuple(partial(_draw_rate, shown=shown, seed=seed) for shown in _QUANTITIES.values()),
            size_in=(11.0, 6.8),
            columns=2,
            shared=False,
        ),
        Picture(
            "reckoning-forecast",
            "RMS error of the forecast four readings ahead",
            tuple(
                partial(_draw_ranking, rows=rows, steps_s=steps_s, metric=metric)
                for metric in METRICS[:4]
            ),
            size_in=(11.0, 11.0),
            columns=2,
            shared=False,
        ),
        Picture(
            "reckoning-combined",
            "Position four readings ahead: combined dead reckoning (11) beside (6)",
            tuple(
                partial(_draw_combined, rows=rows, steps_s=steps_s, metric=metric)
                for metric in PLACE
            ),
            size_in=(11.0, 3.9),
            columns=2,
            shared=False,
        ),
        Picture(
            "reckoning-windows",
            "Error four readings of 3 s ahead by length of the line; shaded: the paper's advice",
            tuple(partial(_draw_windows, windows=windows, metric=metric) for metric in METRICS[:4]),
            size_in=(11.0, 6.8),
            columns=2,
        ),
        Picture(
            "reckoning-drift",
            "Drift vector estimated on a steady course, a fix of 4 m every 30 s",
            (partial(_draw_drift, drifts=drifts),),
            size_in=(7.2, 4.2),
        ),
        Picture(
            "reckoning-drift-maneuvers",
            "Drift vector through the maneuvers of the voyage, a fix of 4 m every 30 s",
            (
                _draw_orders,
                *(
                    partial(_draw_drift_maneuvers, case=case, found=found)
                    for case, found in maneuvers.items()
                ),
            ),
            size_in=(8.4, 7.4),
        ),
    )


def _every_formula(shown: _Shown, seed: int) -> Picture:
    """The quantity smoothed and predicted by every formula of the paper, one family in a row."""
    panels = [
        partial(_draw_truth, shown=shown, seed=seed),
        partial(_draw_true_rate, shown=shown, seed=seed),
    ]
    for family, names in _FAMILIES.items():
        for ahead in (False, True):
            panels.append(
                partial(
                    _draw_family, shown=shown, seed=seed, family=family, names=names, ahead=ahead
                )
            )
    return Picture(
        f"reckoning-every-{shown.name}",
        f"{shown.name.capitalize()} by every formula of the paper, a reading every 3 s: "
        "smoothed (left), predicted 12 s ahead (right)",
        tuple(panels),
        size_in=(11.0, 10.6),
        columns=2,
    )


def _draw_wind_current(ax: Axes) -> Axes:
    """Fig. 1 of the paper, with the graph of the search manual."""
    latitude_deg = np.linspace(20.0, 90.0, 141)
    for wind_mps, color in zip((30.0, 20.0, 10.0), plot.PALETTE, strict=False):
        current = nav.wind_current_mps([wind_mps, 0.0], np.deg2rad(latitude_deg))
        speed_kn = nav.speed_course(current)[0] / KNOT_MPS
        ax.plot(
            latitude_deg, speed_kn, color=color, linewidth=1.6, label=f"wind {wind_mps:.0f} m/s"
        )
    quoted = {"x": [20, 90, 20, 90], "y": [0.44, 0.26, 0.88, 0.52]}
    ax.plot(*quoted.values(), "x", color=plot.INK, markersize=6, label="quoted in the paper")
    for wind_kn, current_kn in ((20.0, 0.7), (34.0, 1.25)):
        ax.axhline(current_kn, color=plot.MUTED, linewidth=0.9, linestyle="--")
        ax.plot(55.0, current_kn, "o", color=plot.MUTED, markersize=6)
        ax.text(
            56.0,
            current_kn - 0.06,
            f"search manual: {current_kn:g} kn in a wind of {wind_kn * KNOT_MPS:.1f} m/s",
            fontsize=plot.TEXT_PT,
            color=plot.INK,
        )
    ax.set(xlabel="latitude (°)", ylabel="wind current (kn)", xlim=(18.0, 92.0))
    ax.set_ylim(bottom=0.0)
    plot.dress(ax)
    return plot.name_lines(ax)


class _Drawn(NamedTuple):
    """A quantity of the first voyage in its unit, positions relative to the start."""

    time_s: np.ndarray
    truth: np.ndarray
    readings: np.ndarray
    predicted: Mapping[str, Predicted]


def _drawn(shown: _Shown, seed: int, names: Iterable[str] = tuple(_SHOWN)) -> _Drawn:
    voyage = sea.reckoning_voyage(_SHOWN_STEP_S)
    truth = columns(voyage)[shown.metric]
    readings = columns(voyage.read(1, seed))[shown.metric][0]
    zero = truth[0] if shown.metric in PLACE else 0.0

    def in_unit(values: np.ndarray) -> np.ndarray:
        near = truth + wl.wrap_angle(values - truth) if is_angle(shown.metric) else values
        return (near - zero) / UNIT[shown.metric]

    found, smooths = {}, every()
    for name in names:
        value, rate, forecast = smooths[name](shown.metric, voyage.dt_s, readings)
        if name in _THREE_POINTS:
            value = np.append(value[1:], np.nan)
        ahead = np.full_like(forecast, np.nan)
        ahead[AHEAD:] = forecast[:-AHEAD]
        found[name] = Predicted(in_unit(value), rate / UNIT[shown.metric], in_unit(ahead))
    return _Drawn(voyage.time_s, in_unit(truth), in_unit(readings), found)


def _within(ax: Axes, drawn: _Drawn, shown: _Shown, *columns: np.ndarray) -> None:
    """Set the window to a part of the voyage and the range of `columns` in it."""
    part = (drawn.time_s >= shown.part_s[0]) & (drawn.time_s <= shown.part_s[1])
    seen = np.concatenate([column[part] for column in columns])
    room = 0.06 * np.ptp(seen)
    ax.set_xlim(shown.part_s)
    ax.set_ylim(seen.min() - room, seen.max() + room)


def _draw_smoothed(ax: Axes, shown: _Shown, seed: int) -> Axes:
    drawn = _drawn(shown, seed)
    ax.plot(drawn.time_s, drawn.readings, ".", color=plot.MUTED, markersize=4, label="readings")
    ax.plot(drawn.time_s, drawn.truth, color=plot.INK, linewidth=1.0, linestyle="--", label="truth")
    for name, color in _SHOWN.items():
        value = drawn.predicted[name].value
        ax.plot(drawn.time_s, value, color=plot.PALETTE[color], linewidth=1.3, label=name)
    _within(ax, drawn, shown, drawn.truth, drawn.readings)
    since = " from the start" if shown.metric in PLACE else ""
    ax.set(xlabel="time (s)", ylabel=f"{shown.name}{since} ({shown.unit})")
    if is_angle(shown.metric):
        ax.yaxis.set_major_formatter(_compass)  # through north without a jump
    plot.dress(ax)
    return plot.name_lines(ax)


def _compass(course_deg: float, _tick: int) -> str:
    return f"{course_deg % 360.0:g}"


def _draw_predicted(ax: Axes, shown: _Shown, seed: int) -> Axes:
    drawn = _drawn(shown, seed)
    ax.axhline(0.0, color=plot.INK, linewidth=0.8)
    off = {name: found.forecast - drawn.truth for name, found in drawn.predicted.items()}
    for name, color in _SHOWN.items():
        ax.plot(drawn.time_s, off[name], color=plot.PALETTE[color], linewidth=1.3, label=name)
    _within(ax, drawn, shown, *off.values())
    ax.set(xlabel="time (s)", ylabel=f"prediction - truth ({shown.unit})")
    return plot.dress(ax)


def _draw_truth(ax: Axes, shown: _Shown, seed: int) -> Axes:
    """The readings and the truth, for the panels below."""
    drawn = _drawn(shown, seed, ())
    ax.plot(drawn.time_s, drawn.readings, ".", color=plot.MUTED, markersize=5, label="readings")
    ax.plot(drawn.time_s, drawn.truth, color=plot.INK, linewidth=1.4, label="truth")
    _within(ax, drawn, shown, drawn.truth, drawn.readings)
    since = " from the start" if shown.metric in PLACE else ""
    ax.set(xlabel="time (s)", ylabel=f"{shown.name}{since} ({shown.unit})")
    if is_angle(shown.metric):
        ax.yaxis.set_major_formatter(_compass)
    plot.dress(ax)
    return plot.name_lines(ax)


def _draw_true_rate(ax: Axes, shown: _Shown, seed: int) -> Axes:
    drawn = _drawn(shown, seed, ())
    rate = 60.0 * np.gradient(drawn.truth, drawn.time_s)
    ax.plot(drawn.time_s, rate, color=plot.INK, linewidth=1.4, label="truth")
    _within(ax, drawn, shown, rate)
    ax.set(xlabel="time (s)", ylabel=f"true rate ({shown.unit}/min)")
    return plot.dress(ax)


def _draw_family(
    ax: Axes, shown: _Shown, seed: int, family: str, names: Mapping[str, str], ahead: bool
) -> Axes:
    """What a family of formulas gives, minus the truth."""
    drawn = _drawn(shown, seed, names)
    ax.axhline(0.0, color=plot.INK, linewidth=0.8)
    off = {
        name: (found.forecast if ahead else found.value) - drawn.truth
        for name, found in drawn.predicted.items()
    }
    noise = drawn.readings - drawn.truth
    if not ahead:
        ax.plot(drawn.time_s, noise, ".", color=plot.MUTED, markersize=4)
    for (name, label), color in zip(names.items(), (0, 1, 2, 3), strict=False):
        ax.plot(drawn.time_s, off[name], color=plot.PALETTE[color], linewidth=1.3, label=label)
    _within(ax, drawn, shown, *off.values(), *([] if ahead else [noise]))
    what = "predicted - truth" if ahead else f"{family}\nsmoothed - truth"
    ax.set(xlabel="time (s)", ylabel=f"{what} ({shown.unit})")
    plot.dress(ax)
    return ax if ahead else plot.name_lines(ax)


def _draw_rate(ax: Axes, shown: _Shown, seed: int) -> Axes:
    drawn = _drawn(shown, seed)
    rate = np.gradient(drawn.truth, drawn.time_s)
    for name, color in _SHOWN.items():
        found = 60.0 * drawn.predicted[name].rate
        ax.plot(drawn.time_s, found, color=plot.PALETTE[color], linewidth=1.2, label=name)
    line = {"color": plot.INK, "linewidth": 1.0, "linestyle": "--", "label": "truth"}
    ax.plot(drawn.time_s, 60.0 * rate, **line)
    rates = (60.0 * found.rate for found in drawn.predicted.values())
    _within(ax, drawn, shown, 60.0 * rate, *rates)
    ax.set(xlabel="time (s)", ylabel=f"rate of {shown.name} ({shown.unit}/min)")
    plot.dress(ax)
    return plot.name_lines(ax) if shown.metric == METRICS[0] else ax


def _draw_ranking(ax: Axes, rows: Rows, steps_s: Mapping[str, float], metric: str) -> Axes:
    names = [name for name in every() if not name.endswith("growing")]
    names += ["combined_printed", "combined"] if metric in PLACE else []
    return _draw_steps(ax, rows, steps_s, metric, names)


def _draw_combined(ax: Axes, rows: Rows, steps_s: Mapping[str, float], metric: str) -> Axes:
    labels = {
        "adaptive_two_pass": "(6)",
        **dict(
            zip(
                PAPER_COMBINED,
                (
                    "(11), drift (18)-(20) of the instant",
                    "speed and course of mid-interval",
                    "mean drift of 15 readings",
                    "both",
                ),
                strict=True,
            )
        ),
        "combined": "ours",
    }
    return _draw_steps(ax, rows, steps_s, metric, list(labels), list(labels.values()))


def _draw_steps(
    ax: Axes,
    rows: Rows,
    steps_s: Mapping[str, float],
    metric: str,
    names: list[str],
    labels: list[str] | None = None,
) -> Axes:
    figures = curves.figures(rows, metric)
    values = {
        f"every {dt_s:.0f} s": [figures[f"forecast_{step}", name] for name in names]
        for step, dt_s in steps_s.items()
    }
    quantity, _, unit = metric.split("_")
    unit = {"deg": "°", "arcmin": "′"}.get(unit, unit)
    ax = plot.ranking_panel(
        ax,
        labels or names,
        values,
        xlabel=f"{quantity} ({unit})",
        best_first="every 3 s",
        log=True,
    )
    if metric in PLACE:
        ax.set_xticks([0.0003, 0.001, 0.003, 0.01, 0.03, 0.1])
    if metric not in (METRICS[0], PLACE[0] if labels else None) and ax.get_legend() is not None:
        ax.get_legend().remove()
    return ax


def _draw_windows(ax: Axes, windows: Windows, metric: str) -> Axes:
    """Error by the number of readings of the line, steady and in maneuvers."""
    lengths = list(windows)
    for phase, color, name in (
        ("maneuver", plot.PALETTE[1], "in maneuvers"),
        ("steady", plot.PALETTE[0], "steady"),
    ):
        errors = [float(rmse(windows[n][phase][metric])) for n in lengths]
        ax.plot(lengths, errors, color=color, linewidth=1.6, marker="o", markersize=4, label=name)
    for first, last, name, shade in (
        (2, 3, "start", 0.28),
        (3, 6, "middle", 0.16),
        (10, 15, "steady", 0.16),
    ):
        ax.axvspan(first, last, color=plot.MUTED, alpha=shade, linewidth=0, zorder=0)
        at = ((first + last) / 2, 0.03)
        ax.text(
            *at,
            name,
            transform=ax.get_xaxis_transform(),
            ha="center",
            va="bottom",
            rotation=90 if name == "start" else 0,
            fontsize=plot.TEXT_PT,
            color=plot.INK,
        )
    quantity, _, unit = metric.split("_")
    unit = {"deg": "°", "arcmin": "′"}.get(unit, unit)
    ax.set(xlabel="readings in the line", ylabel=f"{quantity} ({unit})", yscale="log")
    ticks = [0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0]
    low, high = ax.get_ylim()
    ax.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.set_yticks([], minor=True)
    ax.set_ylim(low, high)
    ax.set_xticks(range(2, 21, 2))
    plot.dress(ax)
    return plot.name_lines(ax) if metric == METRICS[0] else ax


def _draw_orders(ax: Axes) -> Axes:
    """Course and speed through the water over the voyage."""
    voyage = sea.reckoning_voyage(_SHOWN_STEP_S)
    ax.plot(
        voyage.time_s,
        voyage.speed_mps / KNOT_MPS,
        color=plot.PALETTE[0],
        linewidth=1.6,
        label="speed (kn)",
    )
    turn = np.degrees(np.gradient(voyage.course_rad, voyage.dt_s))
    ax.plot(
        voyage.time_s,
        10.0 * turn,
        color=plot.PALETTE[4],
        linewidth=1.2,
        label="turn rate (tenths of °/s)",
    )
    ax.set(xlabel="time (s)", ylabel="the ship", xlim=(0.0, sea.END_S))
    plot.dress(ax)
    return plot.name_lines(ax)


def _draw_drift_maneuvers(
    ax: Axes, case: str, found: tuple[np.ndarray, Mapping[str, np.ndarray]]
) -> Axes:
    time_s, errors = found
    labels = {
        "rates": "mean of the rates (18)-(20)",
        "vector_line": "line",
        "vector_line_ended": "line that ends at an alteration",
    }
    for (name, label), color in zip(labels.items(), (3, 1, 2), strict=True):
        ax.plot(
            time_s,
            rmse(errors[name], axis=0),
            color=plot.PALETTE[color],
            linewidth=1.5,
            label=label,
        )
    step = case.rsplit("_", 1)[1].removesuffix("s")
    ax.set(
        xlabel="time (s)",
        ylabel=f"RMS error (kn),\nlog and gyro every {step} s",
        xlim=(0.0, sea.END_S),
    )
    ax.set_ylim(bottom=0.0)
    plot.dress(ax)
    return plot.name_lines(ax) if step == "3" else ax


def _draw_drift(ax: Axes, drifts: Mapping[str, np.ndarray]) -> Axes:
    for (name, off), color in zip(drifts.items(), plot.PALETTE, strict=False):
        rms_kn = rmse(off, axis=0)
        fixes = np.arange(1, len(rms_kn) + 1)
        ax.plot(fixes, rms_kn, color=color, linewidth=1.4, marker="o", markersize=4, label=name)
    ax.plot([5, 20], [0.10, 0.03], "x", color=plot.INK, markersize=7, label="reference")
    ax.set(
        xlabel="fixes after the first", ylabel="RMS error of the drift vector (kn)", yscale="log"
    )
    ticks = [0.03, 0.05, 0.1, 0.2, 0.5]
    ax.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.set_yticks([], minor=True)
    ax.set_xticks(range(0, 21, 5))
    plot.dress(ax)
    return plot.name_lines(ax)
