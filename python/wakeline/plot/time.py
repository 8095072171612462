"""Tracks over time: speed, course, NIS and mode probability, one panel each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from wakeline._brief import many
from wakeline.recording import Episode, Tracks

from .maps import CHI_SQUARE_95_2DOF
from .style import (
    INK,
    MODE_PALETTE,
    TEXT_PT,
    by_length,
    dot_lone,
    dress,
    figure,
    from_zero,
    halo,
    name_above,
    name_lines,
    plain,
    stretches,
    through_north,
    track_colors,
    with_gaps,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NIS_TOP = 16.0
_MANY_TRACKS = 10


def time_view(
    fig: Figure,
    episode: Episode | None = None,
    tracks: Tracks | None = None,
    *,
    mode_names: Sequence[str] | None = None,
) -> list[Axes]:
    """Draw tracks over time since the first scan, as stacked panels.

    With more than ten tracks the ten longest; with more than ten true targets no truth. Panels:
    speed and course; NIS, if the tracks have it, with the 95 % line of two degrees of freedom;
    mode probability of the longest track, if available.

    Parameters
    ----------
    fig : matplotlib.figure.Figure
        Figure to draw into.
    episode : Episode, optional
        Its truth is drawn with the tracks; its first scan is time 0.
    tracks : Tracks, optional
        Tracks of that episode.
    mode_names : sequence of str, optional
        A name for each mode; default "mode 1" onwards.

    Returns
    -------
    list of matplotlib.axes.Axes
        The panels from top to bottom.
    """
    start_s = _start_s(episode, tracks)
    count = 0 if tracks is None else len(tracks.ids())
    colors = track_colors(tracks)
    tracks = _longest(tracks)
    if episode is not None and len(episode.truth or {}) > _MANY_TRACKS:
        episode = None
    panels = [speed_panel, course_panel]
    if tracks is not None and tracks.nis is not None:
        panels.append(nis_panel)
    modes = tracks is not None and tracks.mode_probability is not None and len(tracks) > 0
    axes = list(fig.subplots(len(panels) + modes, 1, sharex=True, squeeze=False)[:, 0])
    for ax, panel in zip(axes, panels, strict=False):
        panel(ax, tracks, episode, start_s=start_s, colors=colors)
    if modes:
        mode_panel(axes[-1], tracks, by_length(tracks)[0], start_s=start_s, mode_names=mode_names)
    for ax in axes[:-1]:
        ax.set_xlabel("")
    axes[0].margins(x=0.01)
    if tracks is not None and len(tracks):
        name_lines(axes[0])
    if count > _MANY_TRACKS:
        shown = f"the {_MANY_TRACKS} longest of {count} tracks"
        axes[-1].set_xlabel(f"{axes[-1].get_xlabel()}, {shown}")
    fig.align_ylabels(axes)
    return axes


def time_figure(
    episode: Episode | None = None,
    tracks: Tracks | None = None,
    *,
    mode_names: Sequence[str] | None = None,
) -> Figure:
    """A figure of one :func:`time_view`."""
    fig = figure(7.2, 7.4)
    time_view(fig, episode, tracks, mode_names=mode_names)
    return fig


def speed_panel(
    ax: Axes,
    tracks: Tracks | None,
    episode: Episode | None = None,
    *,
    start_s: float = 0.0,
    colors: Mapping[str, str] | None = None,
) -> Axes:
    """Speed over ground in m/s of every track and truth; returns `ax`.

    `colors` by track id are those of :func:`track_colors` by default, in every panel.
    """
    for k, (time_s, state) in enumerate(_true_states(episode)):
        speed_mps = np.hypot(state[:, 1], state[:, 3])
        label = "truth" if k == 0 else None
        ax.plot(time_s - start_s, speed_mps, label=label, **_TRUTH_LINE)
    for track_id, color, track in _each(tracks, colors):
        time_s, speed_mps = with_gaps(track.time_s, track.speed_mps)
        label = plain(f"track {track_id}")
        line = ax.plot(time_s - start_s, speed_mps, color=color, linewidth=1.5, label=label)
        dot_lone(*line)
    return _finish(from_zero(ax), "speed (m/s)")


def course_panel(
    ax: Axes,
    tracks: Tracks | None,
    episode: Episode | None = None,
    *,
    start_s: float = 0.0,
    colors: Mapping[str, str] | None = None,
) -> Axes:
    """Course over ground in degrees, interrupted where it passes north; returns `ax`."""
    for time_s, state in _true_states(episode):
        course_deg = np.degrees(np.arctan2(state[:, 3], state[:, 1])) % 360.0
        ax.plot(*through_north(time_s - start_s, course_deg), **_TRUTH_LINE)
    for _, color, track in _each(tracks, colors):
        time_s, course_deg = with_gaps(track.time_s, track.course_deg)
        line = through_north(time_s - start_s, course_deg)
        dot_lone(*ax.plot(*line, color=color, linewidth=1.5))
    ax.set_ylim(0.0, 360.0)
    ax.set_yticks([0, 90, 180, 270, 360])
    return _finish(ax, "course (°)")


def nis_panel(
    ax: Axes,
    tracks: Tracks,
    episode: Episode | None = None,
    *,
    start_s: float = 0.0,
    colors: Mapping[str, str] | None = None,
) -> Axes:
    """Normalized innovation squared, with the 95 % line of two degrees of freedom; returns `ax`.

    Values above the panel are triangles at its upper edge.
    """
    for _, color, track in _each(tracks, colors):
        time_s, nis = track.time_s - start_s, track.nis
        above = nis > _NIS_TOP
        ax.scatter(
            time_s[~above], nis[~above], s=9, color=color, linewidths=0, clip_on=False, zorder=3
        )
        edge = np.full(np.count_nonzero(above), 0.97 * _NIS_TOP)
        ax.scatter(time_s[above], edge, s=20, color=color, marker="^", linewidths=0)
    ax.axhline(CHI_SQUARE_95_2DOF, color=INK, linewidth=1.0, linestyle=(0, (4, 2)))
    ax.annotate(
        f"95 %: {CHI_SQUARE_95_2DOF:.2f}",
        (1.0, CHI_SQUARE_95_2DOF),
        xycoords=("axes fraction", "data"),
        xytext=(-2, 3),
        textcoords="offset points",
        ha="right",
        fontsize=TEXT_PT - 1,
        color=INK,
        path_effects=halo(),
    )
    ax.set_ylim(0.0, _NIS_TOP)
    return _finish(ax, "NIS")


def mode_panel(
    ax: Axes,
    tracks: Tracks,
    track_id: str,
    *,
    start_s: float = 0.0,
    mode_names: Sequence[str] | None = None,
) -> Axes:
    """Mode probabilities of one track as bands that add up to 1; returns `ax`."""
    track = tracks.where(tracks.track_id == track_id)
    modes = track.mode_probability.shape[1]
    names = mode_names or [f"mode {k}" for k in range(1, modes + 1)]
    if len(names) != modes:
        raise ValueError(f"mode_names must have {many(modes, 'name')}, got {len(names)}")
    draw_bands(ax, track.time_s - start_s, track.mode_probability, names)
    return _finish(ax, f"mode probability\nof track {plain(track_id)}")


def draw_bands(
    ax: Axes,
    time_s: np.ndarray,
    probability: np.ndarray,
    names: Sequence[str],
    colors: Sequence[str] | None = None,
) -> Axes:
    """Probabilities (T, K) as bands that add up to 1, with a legend above; returns `ax`.

    Bands are interrupted at gaps, like lines.
    """
    modes = probability.shape[1]
    colors = colors or [MODE_PALETTE[k % len(MODE_PALETTE)] for k in range(modes)]
    for when_s, bands in stretches(time_s, probability):
        ax.stackplot(when_s, bands.T, colors=colors, labels=names, linewidth=0)
        names = ()
    ax.set_ylim(0.0, 1.0)
    return name_above(
        ax,
        loc="lower right",
        bbox_to_anchor=(1.0, 1.0),
        fontsize=TEXT_PT - 1,
        frameon=False,
        handlelength=1.0,
        columnspacing=1.2,
        borderaxespad=0.1,
    )


_TRUTH_LINE = {"color": INK, "linewidth": 0.9, "linestyle": (0, (4, 2)), "zorder": 3}


def _start_s(episode: Episode | None, tracks: Tracks | None) -> float:
    if episode is not None and len(episode):
        return episode.scans[0].time_s
    return float(tracks.time_s.min()) if tracks is not None and len(tracks) else 0.0


def _longest(tracks: Tracks | None) -> Tracks | None:
    """As many tracks as can be distinguished."""
    if tracks is None or len(tracks.ids()) <= _MANY_TRACKS:
        return tracks
    return tracks.where(np.isin(tracks.track_id, by_length(tracks)[:_MANY_TRACKS]))


def _each(
    tracks: Tracks | None, colors: Mapping[str, str] | None
) -> Iterator[tuple[str, str, Tracks]]:
    """Id, colour and rows of each track."""
    colors = colors or track_colors(tracks)
    for track_id in [] if tracks is None else tracks.ids():
        yield track_id, colors[track_id], tracks.where(tracks.track_id == track_id)


def _true_states(episode: Episode | None):
    """Scan times (T,) and true states (T, 4) of each target, NaN rows without truth."""
    if episode is None:
        return
    for truth in (episode.truth or {}).values():
        yield episode.time_s, truth.state_at(episode.time_s)


def _finish(ax: Axes, ylabel: str) -> Axes:
    ax.set_xlabel("time from start (s)")
    ax.set_ylabel(ylabel)
    return dress(ax)
