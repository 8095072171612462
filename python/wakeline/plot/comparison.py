"""Several estimators on one scenario: their paths, errors, turn rates and mode probabilities.

Every function draws into `ax` and returns it. Times are seconds from the start of the scenario,
states ``[north, vnorth, east, veast]``. Arrays that do not fit raise ValueError, which names them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import cycle, product
from typing import TYPE_CHECKING, Any

import numpy as np

from wakeline._checks import real_numbers, shaped

from .style import GRID, INK, MUTED, PALETTE, dress, dress_map, name_lines
from .time import draw_bands

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

_TRUTH_DASHES = (0, (4, 2))
_DASHES = ("-", (0, (3, 1)), (0, (1, 1)))
_MARKS = "os^"
_ROOM_ABOVE = 1.08
_STRIP = (1.02, 0.06)
_ROUND = (1.0, 2.0, 3.0, 5.0)
_MIDDLE = "#DDDDDD"
_PORT = ("#F4A582", "#B2182B")
_STARBOARD = ("#92C5DE", "#2166AC")


def paths_view(
    ax: Axes,
    truth: np.ndarray,
    tracks: Mapping[str, np.ndarray] | None = None,
    *,
    plots_m: np.ndarray | None = None,
    switch: Sequence[int] = (),
    radar: bool = True,
    colors: Mapping[str, str] | None = None,
) -> Axes:
    """Map of a true path and of tracks of it, north up, equal axes in kilometres.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Axes to draw into.
    truth : ndarray (T, 4)
        True states.
    tracks : mapping of str to ndarray (T, 4)
        Estimated states by name of the estimator.
    plots_m : ndarray (T, 2), optional
        Radar plots, north and east.
    switch : sequence of int
        Scans at which the turn rate changes, marked on the true path.
    radar : bool
        Whether to mark the radar at the origin.
    colors : mapping of str to str, optional
        Color of each track.
    """
    truth = shaped("truth", truth, None, 4)
    tracks = _by_name("tracks", {} if tracks is None else tracks, None, 4)
    if plots_m is not None:
        plots_m = shaped("plots_m", plots_m, None, 2)
        ax.scatter(*_km(plots_m), s=6, color=MUTED, alpha=0.6, linewidths=0, label="plot", zorder=2)
    for name, look in _looks(tracks, colors):
        ax.plot(*_km(tracks[name][:, 0::2]), **look, linewidth=1.3, label=name, zorder=3)
    place = truth[:, 0::2]
    line = {"color": INK, "linewidth": 1.1, "linestyle": _TRUTH_DASHES if tracks else "-"}
    ax.plot(*_km(place), **line, label="truth", zorder=4)
    ax.scatter(*_km(place[list(switch)]), s=14, color=INK, linewidths=0, zorder=5)
    ax.plot(*_km(place[:1]), color=INK, marker="o", markersize=6, markerfacecolor="white", zorder=5)
    if radar:
        ax.plot(0, 0, color=INK, marker="^", markersize=7, linestyle="", label="radar", zorder=5)
    return name_lines(dress_map(ax))


def error_panel(
    ax: Axes,
    time_s: np.ndarray,
    errors: Mapping[str, np.ndarray],
    *,
    bound: np.ndarray | None = None,
    ylabel: str = "position RMSE (m)",
    switch_s: Iterable[float] = (),
    colors: Mapping[str, str] | None = None,
    top: float | None = None,
    legend: bool = True,
) -> Axes:
    """Root mean square errors over time, with the region below the bound shaded.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Axes to draw into.
    time_s : ndarray (T,)
        Times.
    errors : mapping of str to ndarray (T,)
        Errors by name of the estimator.
    bound : ndarray (T,), optional
        The lower bound.
    ylabel : str
        Label of the errors, with their unit.
    switch_s : iterable of float
        Times at which the turn rate changes.
    colors : mapping of str to str, optional
        Colour of each estimator.
    top : float, optional
        Upper end of the axis; default above the highest curve.
    legend : bool
        Whether to name the lines.
    """
    time_s = _times(time_s)
    errors = _by_name("errors", errors, len(time_s))
    mark_switches(ax, switch_s)
    curves = list(errors.values())
    if bound is not None:
        curves.append(shaped("bound", bound, len(time_s)))
        ax.fill_between(time_s, bound, color=GRID, linewidth=0, zorder=1.5)
        ax.plot(time_s, bound, color=MUTED, linewidth=1.1, label="bound", zorder=2)
    for name, look in _looks(errors, colors):
        ax.plot(time_s, errors[name], **look, linewidth=1.4, label=name, zorder=3)
    ax.set_ylim(0.0, _ROOM_ABOVE * _highest(curves) if top is None else top)
    return _over_time(ax, time_s, ylabel, legend)


def turn_rate_panel(
    ax: Axes,
    time_s: np.ndarray,
    true_rate_rad_s: np.ndarray,
    rates_rad_s: Mapping[str, np.ndarray],
    *,
    colors: Mapping[str, str] | None = None,
    ylabel: str = "turn rate (°/s)",
    legend: bool = True,
) -> Axes:
    """Turn rates in degrees per second, positive to starboard, and the true one.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Axes to draw into.
    time_s, true_rate_rad_s : ndarray (T,)
        Times, and the true turn rate of the step that ends at each.
    rates_rad_s : mapping of str to ndarray (T,)
        Turn rates by name.
    colors : mapping of str to str, optional
        Color of each.
    ylabel : str
        Label of the rates, with their unit.
    legend : bool
        Whether to name the lines.
    """
    time_s = _times(time_s)
    rates_rad_s = _by_name("rates_rad_s", rates_rad_s, len(time_s))
    true_rate_rad_s = shaped("true_rate_rad_s", true_rate_rad_s, len(time_s))
    ax.axhline(0.0, color=MUTED, linewidth=0.6)
    for name, look in _looks(rates_rad_s, colors):
        rate_deg_s = np.degrees(rates_rad_s[name])
        ax.plot(time_s, rate_deg_s, **look, linewidth=1.4, label=name, zorder=3)
    true_deg_s = np.degrees(true_rate_rad_s)
    ax.step(
        time_s,
        true_deg_s,
        where="pre",
        color=INK,
        linewidth=1.1,
        linestyle=_TRUTH_DASHES,
        label="truth",
        zorder=4,
    )
    return _over_time(ax, time_s, ylabel, legend)


def probability_panel(
    ax: Axes,
    time_s: np.ndarray,
    probability: np.ndarray,
    turn_rate_rad_s: Sequence[float],
    *,
    true_rate_rad_s: np.ndarray | None = None,
    switch_s: Iterable[float] = (),
    ylabel: str = "mode probability",
    legend: bool = True,
) -> Axes:
    """Mode probabilities as bands that add up to 1, starboard on top, the true turn above them.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Axes to draw into.
    time_s : ndarray (T,)
        Times.
    probability : ndarray (T, K)
        Probabilities of the modes.
    turn_rate_rad_s : sequence of K floats
        Turn rate of each mode.
    true_rate_rad_s : ndarray (T,), optional
        The true turn rate of the step that ends at each time: a strip in the color of that rate.
    switch_s : iterable of float
        Times at which the turn rate changes.
    ylabel : str
        Label of the probabilities.
    legend : bool
        Whether to name the bands.
    """
    rate_deg_s = np.degrees(shaped("turn_rate_rad_s", turn_rate_rad_s, None))
    time_s = _times(time_s)
    probability = shaped("probability", probability, len(time_s), len(rate_deg_s))
    order = np.argsort(rate_deg_s)
    names = [f"{rate:+.3g} °/s" if rate else "0 °/s" for rate in rate_deg_s[order]]
    true_deg_s = np.zeros(0)
    if true_rate_rad_s is not None:
        true_deg_s = np.degrees(shaped("true_rate_rad_s", true_rate_rad_s, len(time_s)))
    colors = turn_colors(np.concatenate([rate_deg_s[order], true_deg_s]))
    draw_bands(ax, time_s, probability[:, order], names, colors[: len(order)])
    if not legend:
        ax.get_legend().remove()
    if len(true_deg_s):
        _draw_strip(ax, time_s, true_deg_s, colors[len(order) :])
    ax.set_yticks([0.0, 0.5, 1.0])
    mark_switches(ax, switch_s, color="white")
    return _over_time(ax, time_s, ylabel, False)


def ranking_panel(
    ax: Axes,
    names: Sequence[str],
    values: Mapping[str, Sequence[float]],
    *,
    xlabel: str,
    best_first: str | None = None,
    log: bool = False,
) -> Axes:
    """One row per estimator, one mark per case, best estimator on top.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Axes to draw into.
    names : sequence of K str
        The estimators.
    values : mapping of str to sequence of K floats
        Their figures by case.
    xlabel : str
        Label of the figures, with their unit.
    best_first : str, optional
        The case to sort by; default the last.
    log : bool
        Whether the axis is logarithmic; else it begins at 0.
    """
    table = _by_name("values", values, len(names))
    if not table or best_first not in (None, *table):
        raise ValueError(f"values must have {best_first or 'a case'}, got {list(table)}")
    by = table[best_first if best_first is not None else list(table)[-1]]
    order = np.argsort(by)[::-1]
    rows = np.arange(len(order))
    low, high = np.min(list(table.values()), axis=0), np.max(list(table.values()), axis=0)
    ax.hlines(rows, low[order], high[order], color=GRID, linewidth=3, zorder=1)
    looks = cycle(product(_MARKS, PALETTE))
    for (key, row), (mark, color) in zip(table.items(), looks, strict=False):
        look = {"marker": mark, "color": color, "s": 34, "linewidths": 0}
        ax.scatter(row[order], rows, **look, label=key, zorder=3)
    ax.set_yticks(rows, [names[k] for k in order])
    ax.set_ylim(-0.6, len(order) - 0.4)
    if log:
        ax.set_xscale("log")
        _round_ticks(ax.xaxis)
    else:
        ax.set_xlim(left=0.0)
    ax.set_xlabel(xlabel)
    dress(ax)
    ax.grid(visible=False, axis="y")
    return name_lines(ax)


def steps_panel(
    ax: Axes,
    steps: Sequence[str],
    values: Mapping[str, Sequence[float]],
    *,
    xlabel: str,
    ylabel: str,
    colors: Mapping[str, str] | None = None,
    legend: bool = True,
) -> Axes:
    """Figures of several estimators in a few cases, logarithmic.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Axes to draw into.
    steps : sequence of K str
        The cases, from left to right.
    values : mapping of str to sequence of K floats
        Figures by name of the estimator.
    xlabel, ylabel : str
        Labels of cases and figures.
    colors : mapping of str to str, optional
        Colour of each estimator.
    legend : bool
        Whether to name the lines.
    """
    at, values = np.arange(len(steps)), _by_name("values", values, len(steps))
    for name, look in _looks(values, colors):
        ax.plot(at, values[name], **look, linewidth=1.4, marker="o", markersize=5, label=name)
    ax.set_xticks(at, steps)
    ax.set_xlim(-0.3, len(steps) - 0.7)
    ax.set_yscale("log")
    _round_ticks(ax.yaxis)
    ax.set_xlabel(xlabel)
    ax.set_ylabel(ylabel)
    dress(ax)
    return name_lines(ax) if legend else ax


def mark_switches(ax: Axes, switch_s: Iterable[float], color: str = MUTED) -> Axes:
    """Faint vertical lines at the given times."""
    for time_s in switch_s:
        ax.axvline(time_s, color=color, linewidth=0.7, linestyle=(0, (1, 2)), zorder=1.8)
    return ax


def turn_colors(turn_rate_deg_s: Sequence[float]) -> list[str]:
    """Colors of turn rates: gray straight, red to port, blue to starboard, dark for fast turns."""
    from matplotlib.colors import LinearSegmentedColormap, to_hex

    rates = real_numbers("turn_rate_deg_s", turn_rate_deg_s)
    hardest = max(np.abs(rates).max(initial=0.0), 1e-12)
    port = LinearSegmentedColormap.from_list("port", _PORT)
    starboard = LinearSegmentedColormap.from_list("starboard", _STARBOARD)
    least = np.abs(rates[rates != 0.0]).min(initial=hardest)

    def color(rate: float) -> str:
        if rate == 0.0:
            return _MIDDLE
        depth = (abs(rate) - least) / (hardest - least) if hardest > least else 0.5
        return to_hex((port if rate < 0 else starboard)(depth))

    return [color(rate) for rate in rates]


def _times(time_s: np.ndarray) -> np.ndarray:
    """Times (T,), at least one."""
    time_s = shaped("time_s", time_s, None)
    if not len(time_s):
        raise ValueError("time_s must have at least one time")
    return time_s


def _by_name(what: str, rows: Mapping[str, Any], *shape: int | None) -> dict[str, np.ndarray]:
    """Arrays of a given shape."""
    if not isinstance(rows, Mapping):
        raise TypeError(f"{what} must be a mapping by name, got {type(rows).__name__}")
    return {name: shaped(f"{what} of {name!r}", row, *shape) for name, row in rows.items()}


def _looks(
    named: Mapping[str, object], colors: Mapping[str, str] | None
) -> list[tuple[str, dict[str, Any]]]:
    """Names with color and dashes; those without a color take the palette in order."""
    given = {name: {"color": color} for name, color in (colors or {}).items()}
    looks = cycle(product(_DASHES, PALETTE))
    return [
        (name, given.get(name, {"color": color, "linestyle": dashes}))
        for name, (dashes, color) in zip(named, looks, strict=False)
    ]


def _highest(curves: Iterable[np.ndarray]) -> float:
    """The largest finite value, 1 if none is above 0."""
    values = np.concatenate([np.zeros(0), *curves])
    return float(values[np.isfinite(values)].max(initial=0.0)) or 1.0


def _draw_strip(ax: Axes, time_s: np.ndarray, rate: np.ndarray, colors: Sequence[str]) -> None:
    """A strip above 1 in the color of the rate of each interval of constant rate."""
    begins = np.flatnonzero(np.diff(rate, prepend=np.nan) != 0.0)
    edges_s = np.append(time_s[np.maximum(begins - 1, 0)], time_s[-1])
    bars = list(zip(edges_s[:-1], np.diff(edges_s), strict=True))
    ax.broken_barh(bars, _STRIP, facecolors=[colors[k] for k in begins], linewidth=0)
    ax.set_ylim(0.0, sum(_STRIP))


def _over_time(ax: Axes, time_s: np.ndarray, ylabel: str, legend: bool) -> Axes:
    ax.set_xlim(float(time_s[0]), float(time_s[-1]))
    ax.set_xlabel("time (s)")
    ax.set_ylabel(ylabel)
    dress(ax)
    return name_lines(ax) if legend else ax


def _round_ticks(axis: Axis) -> None:
    """Ticks of a logarithmic axis at 1, 2, 3, 5, 10 and so on."""
    from matplotlib.ticker import LogLocator, NullLocator

    axis.set_major_locator(LogLocator(subs=_ROUND))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_locator(NullLocator())


def _km(position_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """East and north in kilometres of positions (n, 2), north and east in metres."""
    return position_m[:, 1] / 1e3, position_m[:, 0] / 1e3
