"""Picture of a calibration: plots of reported vessels before and after."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .style import GRID, INK, MUTED, PALETTE, TEXT_PT, dress, figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from wakeline._engine.track import CalibratedOffset, CalibrationResult

_MATCHED = 0.5
_COLORED = 8  # vessels; more have one color
_ROOM = 1.35


def calibration_figure(result: CalibrationResult, names: Sequence[str]) -> Figure:
    """Errors of plots in range and bearing over the bearing, before and after a calibration.

    Parameters
    ----------
    result : CalibrationResult
    names : sequence of str
        Names of the vessels by number.
    """
    fig = figure(9.6, 5.4)
    panels = fig.subplots(2, 2, sharex=True, sharey="row")
    matched = result.pair_probability > _MATCHED
    bearing_deg = np.degrees(result.pair_bearing_rad) % 360.0
    rows = (
        ("range error, m", 1.0, result.pair_range_error_m, result.pair_range_rest_m),
        (
            "bearing error, °",
            180.0 / np.pi,
            result.pair_bearing_error_rad,
            result.pair_bearing_rest_rad,
        ),
    )
    offsets = (result.range_m, result.bearing_rad)
    colors = _colors(result)
    for (label, scale, before, after), offset, line in zip(rows, offsets, panels, strict=True):
        for ax, error in zip(line, (before, after), strict=True):
            dress(ax)
            ax.axhline(0.0, color=INK, linewidth=0.9, zorder=1.5)
            if error is before:
                other = ~matched
                ax.scatter(
                    bearing_deg[other], scale * error[other], s=3, color=MUTED, alpha=0.35, lw=0
                )
            for vessel, color in colors.items():
                mine = matched & (result.pair_vessel == vessel)
                ax.scatter(
                    bearing_deg[mine],
                    scale * error[mine],
                    s=9,
                    color=color,
                    alpha=0.65,
                    linewidths=0,
                    label=names[vessel],
                )
        line[0].set_ylabel(label)
        _limit(line[0], scale * np.concatenate([before[matched], after[matched]]))
        if np.isfinite(offset.value):
            line[0].axhline(scale * offset.value, color=PALETTE[1], linewidth=1.4, zorder=3)
    panels[0, 0].set_title("as measured", loc="left", fontsize=TEXT_PT + 1, color=INK)
    panels[0, 1].set_title(
        "without the offsets of radar and vessels", loc="left", fontsize=TEXT_PT + 1, color=INK
    )
    _say(panels[0, 0], "range", result.range_m, 1.0, "m")
    _say(panels[1, 0], "bearing", result.bearing_rad, 180.0 / np.pi, "°")
    _say(panels[1, 1], "time", result.time_s, 1.0, "s")
    for ax in panels[1]:
        ax.set_xlabel("bearing of the vessel, °")
        ax.set_xlim(0.0, 360.0)
        ax.set_xticks(range(0, 361, 60))
    if 0 < len(colors) <= _COLORED:
        handles, labels = panels[0, 1].get_legend_handles_labels()
        fig.legend(
            handles,
            labels,
            loc="outside lower center",
            ncols=len(labels),
            frameon=False,
            fontsize=TEXT_PT,
            markerscale=1.8,
            labelcolor=INK,
        )
    return fig


def _colors(result: CalibrationResult) -> dict[int, str]:
    """A color for each vessel; one for all if there are many."""
    vessels = result.vessel_id.tolist()
    if len(vessels) > _COLORED:
        return dict.fromkeys(vessels, PALETTE[0])
    others = [color for color in PALETTE if color != PALETTE[1]]
    return {vessel: others[k % len(others)] for k, vessel in enumerate(vessels)}


def _limit(ax: Axes, errors: np.ndarray) -> None:
    """Limits that hold all errors but the rarest, and zero."""
    if len(errors) == 0:
        return
    low, high = np.percentile(np.append(errors, 0.0), [0.5, 99.5])
    half = max(0.5 * _ROOM * (high - low), 1e-6)
    middle = 0.5 * (low + high)
    ax.set_ylim(middle - half, middle + half)


def _say(ax: Axes, what: str, offset: CalibratedOffset, scale: float, unit: str) -> None:
    """An offset as text in the upper corner."""
    space = "" if unit == "°" else " "
    value = f"{scale * offset.value:+.2f} ± {scale * offset.std:.2f}{space}{unit}"
    value = value.replace("-", "−")
    text = value if offset.determined else f"not determined ({offset.verdict})"
    ax.text(
        0.99,
        0.97,
        f"{what} offset {text}",
        transform=ax.transAxes,
        ha="right",
        va="top",
        fontsize=TEXT_PT,
        color=INK,
        bbox={"facecolor": "white", "edgecolor": GRID, "pad": 2.5},
        zorder=5,
    )
