"""The style of all figures: a color-blind safe palette, plain axes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wakeline.recording import Tracks, replacing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.backend_bases import RendererBase
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend
    from matplotlib.lines import Line2D
    from matplotlib.transforms import Bbox

PALETTE = (
    *("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00"),
    *("#56B4E9", "#882255", "#999933", "#332288", "#44AA99"),
)
"""Colors of tracks and curves, in turn."""
MODE_PALETTE = ("#DDDDDD", "#EE8866", "#77AADD", "#44BB99", "#FFAABB", "#BBCC33", "#99DDFF")
DANGER = "#E00000"
INK = "#1F2328"
"""Color of text, truth and own ship."""
MUTED = "#8C959F"
"""Color of axes, plots and side notes."""
GRID = "#E4E7EB"
TEXT_PT = 9
"""Size of the text of a picture, points."""
_DOTS_PER_IN = 160
_ROOM_ABOVE = 1.08
_GAP_STEPS = 4.0
_BESIDE_IN = 0.7  # minimum width left of the axes of a column of panels
_AROUND_IN = 0.09  # margin of the layout


def figure(width_in: float = 7.2, height_in: float = 6.0) -> Figure:
    """A new figure of the given size, independent of any window."""
    from matplotlib.figure import Figure

    return Figure(
        figsize=(width_in, height_in), dpi=_DOTS_PER_IN, layout="constrained", facecolor="white"
    )


def save(fig: Figure, path: str | Path) -> None:
    """Write a figure; `path` is replaced only when the new file is complete.

    Parameters
    ----------
    fig : matplotlib.figure.Figure
        The figure.
    path : str or Path
        The suffix determines the format, such as ``.png`` or ``.pdf``.

    Raises
    ------
    ValueError
        When the suffix is not a supported format.
    """
    kinds = fig.canvas.get_supported_filetypes()
    if Path(path).suffix[1:].lower() not in kinds:
        raise ValueError(f"path must end in .{', .'.join(sorted(kinds))}, got {str(path)!r}")
    with replacing(path) as fresh:
        fig.savefig(fresh, bbox_inches="tight", pad_inches=0.1)


def dress(ax: Axes) -> Axes:
    """Apply the common style to axes; returns `ax`."""
    ax.set_axisbelow(True)
    ax.grid(color=GRID, linewidth=0.8)
    ax.tick_params(labelsize=TEXT_PT, color=MUTED, labelcolor=INK, length=3)
    for side, spine in ax.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(MUTED)
    for label in (ax.xaxis.label, ax.yaxis.label):
        label.set_size(TEXT_PT)
        label.set_color(INK)
    return ax


def from_zero(ax: Axes) -> Axes:
    """Start the vertical axis at zero, with room above the highest line; returns `ax`."""
    highest = ax.dataLim.y1
    ax.set_ylim(0.0, _ROOM_ABOVE * highest if 0.0 < highest < np.inf else None)
    return ax


def dress_map(ax: Axes) -> Axes:
    """The style of a map in kilometres, north up; returns `ax`."""
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("east (km)")
    ax.set_ylabel("north (km)")
    return dress(ax)


def halo(width: float = 2.0) -> list:
    """Path effects that keep text and thin lines legible on any background."""
    from matplotlib import patheffects

    return [patheffects.withStroke(linewidth=width, foreground="white")]


def plain(text: str) -> str:
    """Literal text: a dollar sign does not begin a formula."""
    return text.replace("$", r"\$")


def name_lines(ax: Axes, columns: int | None = None) -> Axes:
    """A legend above the axes, by default as in :func:`name_above`.

    Returns `ax`.
    """
    return name_above(
        ax,
        columns,
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        fontsize=TEXT_PT,
        frameon=False,
        handlelength=1.8,
        columnspacing=1.4,
        borderaxespad=0.3,
        labelcolor=INK,
    )


def name_above(ax: Axes, columns: int | None = None, **look: object) -> Axes:
    """A legend in as few rows as fit the width of the axes; returns `ax`."""
    count, room_px = len(ax.get_legend_handles_labels()[1]), _room_px(ax)
    for rows in range(1, count + 1):
        legend = ax.legend(ncols=columns or -(-count // rows), **look)
        fits = legend.get_window_extent().width <= room_px
        if fits and ax.get_aspect() == "auto":
            legend.get_tightbbox = partial(_within_width, legend)
        if fits or columns:
            break
    return ax


def _within_width(legend: Legend, renderer: RendererBase | None = None) -> Bbox:
    """The box of a legend above the axes, for which the layout reserves no width.

    Otherwise the layout would shrink the axes for a legend that is wider than they are.
    """
    from matplotlib.transforms import Bbox

    room = legend.axes.get_window_extent(renderer)
    box = type(legend).get_tightbbox(legend, renderer)
    return Bbox.from_extents(max(box.x0, room.x0), box.y0, min(box.x1, room.x1), box.y1)


def _room_px(ax: Axes) -> float:
    """Approximate width of the axes in the layout of their figure."""
    spec = ax.get_subplotspec()
    if spec is None:
        return ax.get_window_extent().width
    widths = spec.get_gridspec().get_width_ratios()
    share = sum(widths[spec.colspan.start : spec.colspan.stop]) / sum(widths)
    beside_px = ax.get_window_extent().x0 - ax.get_tightbbox().x0 + _AROUND_IN * ax.figure.dpi
    return share * ax.figure.bbox.width - max(beside_px, _BESIDE_IN * ax.figure.dpi)


def track_colors(tracks: Tracks | None) -> dict[str, str]:
    """Color of each track id, the same in every view of the same tracks.

    The longest tracks have different colors, as far as the palette allows.
    """
    ids = [] if tracks is None else tracks.ids()
    longest = [] if tracks is None else by_length(tracks)[: len(PALETTE)]
    color = dict(zip(sorted(ids, key=lambda i: i not in longest), cycle(PALETTE), strict=False))
    return {track_id: color[track_id] for track_id in ids}


def by_length(tracks: Tracks) -> list[str]:
    """Track ids, those with the most rows first."""
    return [track_id for track_id, _ in Counter(tracks.track_id.tolist()).most_common()]


def with_gaps(time_s: np.ndarray, *columns: np.ndarray) -> list[np.ndarray]:
    """Times and columns (n,) with a NaN row in each gap, so that lines are interrupted.

    A gap is a step of more than four times the median one.
    """
    after = _after_gaps(time_s)
    return [np.insert(column.astype(float), after, np.nan) for column in (time_s, *columns)]


def stretches(time_s: np.ndarray, *columns: np.ndarray) -> Iterator[tuple[np.ndarray, ...]]:
    """Times (n,) and columns (n, ...) between gaps as in :func:`with_gaps`."""
    after = _after_gaps(time_s)
    return zip(*(np.split(column, after) for column in (time_s, *columns)), strict=True)


def through_north(time_s: np.ndarray, degrees: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The line (n,) of a compass angle, broken at the edges where it passes north."""
    degrees = degrees % 360.0  # a value just below 0 becomes 360
    step = np.diff(degrees)
    last = np.flatnonzero(np.abs(step) > 180.0)
    way = step[last] - np.copysign(360.0, step[last])
    out = np.where(way > 0.0, 360.0, 0.0)
    passed_s = time_s[last] + (out - degrees[last]) / way * np.diff(time_s)[last]
    seam = np.column_stack([out, np.full(len(last), np.nan), 360.0 - out])
    at = np.repeat(last + 1, 3)
    return np.insert(time_s, at, np.repeat(passed_s, 3)), np.insert(degrees, at, seam.ravel())


def dot_lone(line: Line2D) -> None:
    """A dot on each point between two gaps, where a line would be invisible."""
    known = np.isfinite(line.get_xydata()).all(axis=1)
    stroke = known[1:] & known[:-1]
    lone = known & ~np.append(False, stroke) & ~np.append(stroke, False)
    if lone.any():
        line.set(marker=".", markevery=np.flatnonzero(lone).tolist())


def _after_gaps(time_s: np.ndarray) -> np.ndarray:
    """Rows that follow a gap."""
    step_s = np.diff(time_s)
    usual_s = np.median(step_s) if len(step_s) else 0.0
    return np.flatnonzero(step_s > _GAP_STEPS * usual_s) + 1
