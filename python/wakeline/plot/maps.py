"""The map: plots, tracks, own ship and truth in the plane, north up."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from wakeline._brief import many
from wakeline._checks import shaped
from wakeline.recording import Episode, Recording, Tracks

from .style import (
    DANGER,
    INK,
    MUTED,
    TEXT_PT,
    by_length,
    dot_lone,
    dress,
    figure,
    halo,
    name_lines,
    plain,
    track_colors,
    with_gaps,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Annotation

    from wakeline.tracking import Encounter

CHI_SQUARE_95_2DOF = -2.0 * float(np.log(0.05))
_ID_OFFSET_PT = 11.0
_DANGER_PT = 5.4
_DANGER_CORE_PT = 3.0
_RING_PT = 11.0
_MOST_ENCOUNTERS = 6
_WATER_AROUND = 0.12
_FLATTEST = 0.75
_GRID_LINES = 10
_WIDTH_IN, _HEIGHT_IN = 7.2, 6.4


def map_view(
    ax: Axes,
    episode: Episode | None = None,
    tracks: Tracks | None = None,
    *,
    encounters: Sequence[Encounter] = (),
    ellipse_every: int = 5,
    whole: bool = False,
    legend: bool = True,
) -> Axes:
    """Draw an episode and its tracks: east to the right, north up, equal axes in metres.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Axes to draw into.
    episode : Episode, optional
        Its plots and, from the first scan to the last, own ship and truth, if available.
    tracks : Tracks, optional
        Tracks of that episode, each with its id at its end, unless it would cover that of a longer
        one, and, with a covariance, the 95 % ellipse of every `ellipse_every`-th row. Rows under an
        alarm have a red edge, with a ring and the closest approach at the start; where labels would
        overlap, the closest approach has the label.
    encounters : sequence of Encounter
        Of these tracks: the six closest have red edges, and a line between the two vessels where
        they were closest.
    ellipse_every : int
        0 for no ellipses.
    whole : bool
        True: show every plot, too. False: show the tracks, own ship and truth with a margin, and
        report how many plots are outside; without tracks and truth every plot is shown.
    legend : bool
        Whether to explain the marks.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    from .labels import LoneLabels

    if episode is not None:
        _draw_plots(ax, episode)
        _draw_own_ship(ax, *_own_way(episode))
        for k, truth in enumerate(_true_ways(episode)):
            _draw_truth(ax, *truth, "truth" if k == 0 else None)
    ids = {}
    for k, (track_id, color) in enumerate(track_colors(tracks).items()):
        track = tracks.where(tracks.track_id == track_id)
        if ellipse_every > 0 and track.covariance is not None:
            _draw_ellipses(ax, track.where(slice(None, None, ellipse_every)), color, k == 0)
        ids[track_id] = _draw_track(ax, track, track_id, color, "track" if k == 0 else None)
    if tracks is not None:
        ax.add_artist(LoneLabels([ids[track_id] for track_id in by_length(tracks)]))
    if tracks is not None:
        _draw_danger(ax, tracks, encounters)
    ax.set_aspect("equal", adjustable="box")
    ax.ticklabel_format(useOffset=False, style="plain")
    _set_window(ax, episode, tracks, whole)
    ax.set_xlabel("east (m)")
    ax.set_ylabel("north (m)")
    dress(ax)
    if legend:
        name_lines(ax)
    return ax


def map(
    tracks: Tracks | None = None,
    recording: Recording | Episode | None = None,
    *,
    encounters: Sequence[Encounter] | None = None,
    ellipse_every: int = 5,
    whole: bool = False,
) -> Figure:
    """Draw tracks and their recording as a map, north up; one for each episode.

    Parameters
    ----------
    tracks : Tracks, optional
    recording : Recording or Episode, optional
        Plots, own ship and truth, drawn below the tracks.
    encounters : sequence of Encounter, optional
        As for :func:`map_view`; by default those of a :class:`~wakeline.tracking.TrackedRecording`.
    ellipse_every, whole
        As for :func:`map_view`.

    Returns
    -------
    matplotlib.figure.Figure
        For :func:`save`.
    """
    if not isinstance(recording, Recording):
        recording = Recording("", [recording])
    watched = [part.encounters for part in getattr(tracks, "episodes", ())]
    if encounters is not None or len(watched) != len(recording):
        watched = [encounters or ()] * len(recording)
    home = None
    if tracks is not None and len(recording) > 1:
        named = np.full(len(tracks), "") if tracks.scenario is None else tracks.scenario
        home = recording.episode_of(named, tracks.time_s)
    columns = max(1, math.ceil(math.sqrt(len(recording))))
    rows = max(1, math.ceil(len(recording) / columns))
    fig = figure(_WIDTH_IN * columns, _HEIGHT_IN * rows)
    for k, episode in enumerate(recording):
        ax = fig.add_subplot(rows, columns, k + 1)
        shown = tracks if home is None else tracks.where(home == k)
        how = {"ellipse_every": ellipse_every, "whole": whole}
        map_view(ax, episode, shown, encounters=watched[k], **how)
        if len(recording) > 1:
            ax.set_title(plain(episode.name), fontsize=TEXT_PT, color=INK, loc="right")
    return fig


def ellipse_outline(
    mean: np.ndarray, covariance: np.ndarray, quantile: float = CHI_SQUARE_95_2DOF, points: int = 61
) -> np.ndarray:
    """Outline of the ellipse ``(x - mean)' inv(covariance) (x - mean) = quantile``.

    Parameters
    ----------
    mean : array_like (2,)
    covariance : array_like (2, 2)
        Symmetric and positive semidefinite.
    quantile : float
        Chi-square quantile of 2 degrees of freedom; default 95 %.
    points : int
        Number of points; the last equals the first.

    Returns
    -------
    ndarray (points, 2)

    Raises
    ------
    ValueError
        When the shapes differ.
    """
    variance, axes = np.linalg.eigh(shaped("covariance", covariance, 2, 2))
    around = np.linspace(0.0, 2.0 * np.pi, points)
    circle = np.column_stack([np.cos(around), np.sin(around)])
    half_axes = np.sqrt(quantile * np.maximum(variance, 0.0))
    return shaped("mean", mean, 2) + (circle * half_axes) @ axes.T


def _draw_plots(ax: Axes, episode: Episode) -> None:
    if episode.plot_count == 0:
        return
    north_m, east_m = _plot_positions(episode).T
    ax.scatter(east_m, north_m, s=11, color=MUTED, alpha=0.7, linewidths=0, label="plot", zorder=2)


def _own_way(episode: Episode) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, north and east (n,) of own ship from the first scan to the last."""
    time_s = episode.time_s if len(episode) else episode.own.time_s
    return time_s, *episode.own.position_at(time_s).T


def _true_ways(episode: Episode) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Times, north and east (n,) of each target from the first scan to the last."""
    begin_s, end_s = episode.time_s[[0, -1]] if len(episode) else (-np.inf, np.inf)
    for truth in (episode.truth or {}).values():
        shown = (begin_s <= truth.time_s) & (truth.time_s <= end_s)
        yield truth.time_s[shown], truth.north_m[shown], truth.east_m[shown]


def _draw_own_ship(
    ax: Axes, time_s: np.ndarray, own_north_m: np.ndarray, own_east_m: np.ndarray
) -> None:
    _, north_m, east_m = with_gaps(time_s, own_north_m, own_east_m)
    ax.plot(east_m, north_m, color=INK, linewidth=1.0, linestyle=(0, (1, 1.5)), zorder=2)
    ax.plot(
        own_east_m[-1:],
        own_north_m[-1:],
        color=INK,
        linestyle=(0, (1, 1.5)),
        linewidth=1.0,
        marker="^",
        markersize=7,
        markeredgecolor="white",
        label="own ship",
        zorder=4,
    )


def _draw_truth(
    ax: Axes,
    time_s: np.ndarray,
    true_north_m: np.ndarray,
    true_east_m: np.ndarray,
    label: str | None,
) -> None:
    _, north_m, east_m = with_gaps(time_s, true_north_m, true_east_m)
    ax.plot(east_m, north_m, color=INK, linewidth=1.0, linestyle=(0, (4, 2)), label=label, zorder=5)


def _draw_track(
    ax: Axes, track: Tracks, track_id: str, color: str, label: str | None
) -> Annotation:
    """Draw the track; returns the label at its end."""
    _, north_m, east_m = with_gaps(track.time_s, track.north_m, track.east_m)
    dot_lone(*ax.plot(east_m, north_m, color=color, linewidth=1.8, label=label, zorder=4))
    ax.plot(
        track.east_m[:1],
        track.north_m[:1],
        color=color,
        marker="o",
        markersize=4.5,
        markerfacecolor="white",
        zorder=6,
    )
    end = (track.east_m[-1], track.north_m[-1])
    ax.plot(*end, color=color, marker="o", markersize=4.5, zorder=6)
    ahead = np.deg2rad(track.course_deg[-1])
    return ax.annotate(
        plain(track_id),
        end,
        xytext=(_ID_OFFSET_PT * np.sin(ahead), _ID_OFFSET_PT * np.cos(ahead)),
        textcoords="offset points",
        ha="center",
        va="center",
        color=color,
        fontsize=TEXT_PT,
        fontweight="bold",
        path_effects=halo(),
        zorder=7,
    )


def _draw_danger(ax: Axes, tracks: Tracks, encounters: Sequence[Encounter]) -> None:
    """The dangerous parts of tracks, alarms by own ship, and where others were closest."""
    from .labels import ClearLabels

    alarmed = np.zeros(len(tracks), dtype=bool) if tracks.alarmed is None else tracks.alarmed
    others = [one for one in encounters if not one.with_own_ship]
    closest = sorted(others, key=lambda one: one.least_range_m)[:_MOST_ENCOUNTERS]
    during = alarmed.copy()
    for one in closest:
        in_time = (one.begin_s <= tracks.time_s) & (tracks.time_s <= one.end_s)
        during |= in_time & np.isin(tracks.track_id, (one.first, one.second))
    _draw_edges(ax, tracks, during, "danger" if len(closest) == len(others) else "closest dangers")
    threats = [
        _draw_alarm(ax, tracks.where(tracks.track_id == track_id))
        for track_id in tracks.where(alarmed).ids()
    ]
    threats += [threat for one in closest for threat in _draw_closest(ax, tracks, one)]
    nearest_first = [text for _, text in sorted(threats, key=lambda threat: threat[0])]
    if nearest_first:
        ax.add_artist(ClearLabels(nearest_first, clear_pt=_RING_PT / 2.0))


def _draw_edges(ax: Axes, tracks: Tracks, during: np.ndarray, label: str) -> None:
    """A red edge along rows of tracks."""
    from matplotlib.patheffects import Normal, Stroke

    core = [Normal(), Stroke(linewidth=_DANGER_CORE_PT, foreground="white")]
    edge = {"linewidth": _DANGER_PT, "path_effects": core, "solid_capstyle": "round"}
    for track_id in tracks.where(during).ids():
        mine = tracks.track_id == track_id
        _, north_m, east_m = with_gaps(
            tracks.time_s[mine],
            *(np.where(during, way_m, np.nan)[mine] for way_m in (tracks.north_m, tracks.east_m)),
        )
        ax.plot(east_m, north_m, color=DANGER, label=label, zorder=3.5, **edge)
        label = None


def _draw_alarm(ax: Axes, track: Tracks) -> tuple[float, Annotation]:
    """A ring and the closest approach to own ship, at the start of the alarm."""
    ring = {"markersize": _RING_PT, "markerfacecolor": "none", "markeredgewidth": 1.8}
    first = track.where(np.flatnonzero(track.alarmed)[:1])
    place = (first.east_m[0], first.north_m[0])
    ax.plot(*place, color=DANGER, marker="o", **ring, zorder=6)
    return 0.0 if first.cpa_m is None else first.cpa_m[0], _label(ax, place, _threat(first))


def _draw_closest(
    ax: Axes, tracks: Tracks, encounter: Encounter
) -> Iterator[tuple[float, Annotation]]:
    """A line between two vessels where they were closest, with that distance."""
    ends = []
    for track_id in (encounter.first, encounter.second):
        rows = np.flatnonzero(tracks.track_id == track_id)
        if len(rows) == 0:
            return
        row = rows[np.argmin(np.abs(tracks.time_s[rows] - encounter.least_range_s))]
        ends.append((tracks.east_m[row], tracks.north_m[row]))
    line = {"linewidth": 1.0, "marker": "o", "markersize": 3.0, "zorder": 6.5}
    ax.plot(*zip(*ends, strict=True), color=DANGER, **line)
    distance = f"{encounter.first}\u2013{encounter.second}: {encounter.least_range_m:.0f} m"
    yield encounter.least_range_m, _label(ax, tuple(np.mean(ends, axis=0)), distance)


def _label(ax: Axes, place: tuple[float, float], text: str) -> Annotation:
    return ax.annotate(
        plain(text),
        place,
        xytext=(0.0, 0.0),
        textcoords="offset points",
        color=DANGER,
        fontsize=TEXT_PT - 1,
        path_effects=halo(),
        zorder=7,
    )


def _threat(row: Tracks) -> str:
    if row.cpa_m is None or row.tcpa_s is None:
        return f"{row.track_id[0]}"
    return f"{row.track_id[0]}: CPA {row.cpa_m[0]:.0f} m in {row.tcpa_s[0] / 60.0:.1f} min"


def _draw_ellipses(ax: Axes, track: Tracks, color: str, labelled: bool) -> None:
    from matplotlib.collections import PolyCollection

    place = np.ix_(range(len(track)), (0, 2), (0, 2))
    pairs = zip(track.state[:, 0::2], track.covariance[place], strict=True)
    outlines = [ellipse_outline(mean, covariance)[:, ::-1] for mean, covariance in pairs]
    ellipses = PolyCollection(outlines, facecolor=color, edgecolor=color, alpha=0.22, linewidth=0.8)
    ellipses.set(zorder=3, label="95 % ellipse" if labelled else None)
    ax.add_collection(ellipses)


def _set_window(ax: Axes, episode: Episode | None, tracks: Tracks | None, whole: bool) -> None:
    """Fit the axes, and report how many plots are outside."""
    plots = np.zeros((0, 2)) if episode is None else _plot_positions(episode)
    seen = _tracked_positions(episode, tracks)
    if whole or len(seen) == 0:
        seen = np.concatenate([seen, plots])
    if episode is not None and len(seen):
        seen = np.concatenate([seen, np.column_stack(_own_way(episode)[1:])])
    seen = seen[np.isfinite(seen).all(axis=1)]
    if len(seen) == 0:
        return
    low, high = seen.min(axis=0), seen.max(axis=0)
    side_m = np.maximum(high - low, _least_side_m(tracks)) * (1.0 + 2.0 * _WATER_AROUND)
    side_m = np.maximum(side_m, _FLATTEST * side_m.max())
    low, high = (low + high - side_m) / 2.0, (low + high + side_m) / 2.0
    ax.set(ylim=(low[0], high[0]), xlim=(low[1], high[1]))
    _same_steps(ax, float(side_m.max()))
    _count_outside(ax, ~((low <= plots) & (plots <= high)).all(axis=1))


def _least_side_m(tracks: Tracks | None) -> float:
    """Margin for the usual 95 % ellipse, at least a metre."""
    if tracks is None or tracks.covariance is None:
        return 1.0
    variance = tracks.covariance[:, (0, 2), (0, 2)].max(axis=1)
    known = variance[np.isfinite(variance)]
    usual = float(np.median(known)) if len(known) else 0.0
    return max(1.0, 2.0 * np.sqrt(CHI_SQUARE_95_2DOF * usual))


def _same_steps(ax: Axes, side_m: float) -> None:
    """Grid lines at the same round distance in both directions."""
    from matplotlib.ticker import MaxNLocator, MultipleLocator

    ticks = MaxNLocator(_GRID_LINES, steps=[1, 2, 2.5, 5, 10]).tick_values(0.0, side_m)
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(MultipleLocator(ticks[1] - ticks[0]))


def _plot_positions(episode: Episode) -> np.ndarray:
    """All plots (n, 2), north and east."""
    return np.concatenate([np.zeros((0, 2)), *(scan.position_m for scan in episode.scans)])


def _tracked_positions(episode: Episode | None, tracks: Tracks | None) -> np.ndarray:
    """All positions (n, 2) of truth and tracks, north and east."""
    ways = [] if episode is None else [np.column_stack(way[1:]) for way in _true_ways(episode)]
    ways += [] if tracks is None else [tracks.state[:, 0::2]]
    return np.concatenate([np.zeros((0, 2)), *ways])


def _count_outside(ax: Axes, outside: np.ndarray) -> None:
    if not outside.any():
        return
    ax.annotate(
        f"{np.count_nonzero(outside)} of {many(len(outside), 'plot')} outside",
        (1.0, 0.0),
        xycoords="axes fraction",
        xytext=(-4, 5),
        textcoords="offset points",
        ha="right",
        fontsize=TEXT_PT - 1,
        color=MUTED,
        path_effects=halo(),
    )
