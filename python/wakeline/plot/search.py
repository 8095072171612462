"""Pictures of a search: where the object probably is, how it drifts, and the plan."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from wakeline._engine.core import chi_square_quantile

from .maps import ellipse_outline
from .style import (
    DANGER,
    INK,
    MUTED,
    PALETTE,
    TEXT_PT,
    dress,
    dress_map,
    figure,
    halo,
    name_lines,
    plain,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from wakeline.search import Allocation, Cloud, Plan, SearchScenario

_KM = 1e-3
_LAND = "#E9E2D0"
_SHOWN_TIMES = 6
_SHOWN_PARTICLES = 1500
_SMOOTH_CELLS = 1.2
_CONTAINED = (0.5, 0.9)
_LINE_HEIGHT = 6.0
_COLORS = {"plan": PALETTE[0], "naive": PALETTE[1], "bound": MUTED}
_LABELS = {
    "plan": "optimized plan",
    "naive": "naive: square about the datum",
    "bound": "bound: effort without routes",
}


def search_figures(
    scenario: SearchScenario,
    cloud: Cloud,
    plan: Plan,
    naive: Plan,
    bound: Allocation,
) -> dict[str, Figure]:
    """Figures by name: ``probability``, ``drift``, ``plan`` and ``pos``.

    Parameters
    ----------
    scenario : SearchScenario
    cloud : Cloud
        Before the search.
    plan, naive : Plan
    bound : Allocation
    """
    begin_s = min(sortie.time_s[0] for sortie in plan.sorties)
    figures = {}
    figures["probability"] = figure(7.2, 6.4)
    probability_view(figures["probability"].add_subplot(), scenario, cloud, begin_s)
    figures["drift"] = figure(7.2, 6.4)
    drift_view(figures["drift"].add_subplot(), scenario, cloud)
    figures["plan"] = figure(7.2, 6.8)
    plan_view(figures["plan"].add_subplot(), scenario, cloud, plan)
    figures["pos"] = figure(7.2, 4.2)
    pos_panel(figures["pos"].add_subplot(), cloud, {"plan": plan, "naive": naive}, bound)
    return figures


def probability_view(ax: Axes, scenario: SearchScenario, cloud: Cloud, time_s: float) -> Axes:
    """Probability density of the object at a time, with the areas that contain 50 and 90 %."""
    north_m, east_m, density = _density(cloud, time_s)
    shades = ax.pcolormesh(
        _KM * east_m, _KM * north_m, 1e8 * density, cmap=_shades(), rasterized=True
    )
    bar = ax.figure.colorbar(shades, ax=ax, shrink=0.7, pad=0.02)
    bar.set_label("POC (% per km²)", size=TEXT_PT, color=INK)
    bar.ax.tick_params(labelsize=TEXT_PT, color=MUTED, labelcolor=INK)
    bar.outline.set_visible(False)
    middle_n, middle_e = (0.5 * (edges[1:] + edges[:-1]) for edges in (north_m, east_m))
    ranked = np.sort(density.ravel())[::-1]
    inside = np.cumsum(ranked) / ranked.sum()
    levels = [ranked[np.searchsorted(inside, share)] for share in reversed(_CONTAINED)]
    if levels[0] < levels[1]:
        lines = ax.contour(
            _KM * middle_e, _KM * middle_n, density, levels, colors=INK, linewidths=(0.8, 1.3)
        )
        shares = (f"{share:.0%}" for share in reversed(_CONTAINED))
        names = dict(zip(levels, shares, strict=True))
        for text in ax.clabel(lines, fmt=names, fontsize=TEXT_PT - 1):
            text.set_path_effects(halo())
    _draw_land(ax, scenario)
    _draw_start(ax)
    _draw_datum(ax, cloud, time_s)
    dress_map(ax)
    _limit(ax, [cloud.at(time_s), np.zeros((1, 2))])
    return _titled(ax, f"Where the object probably is, {_after(time_s)}")


def drift_view(ax: Axes, scenario: SearchScenario, cloud: Cloud) -> Axes:
    """The cloud at some times, with the track of the datum and ellipses of 90 %."""
    times_s = np.linspace(0.0, cloud.time_s[-1], _SHOWN_TIMES)
    for time_s, color in zip(times_s, _time_colors(len(times_s)), strict=True):
        north_m, east_m = cloud.at(time_s)[:_SHOWN_PARTICLES].T
        ax.plot(
            _KM * east_m,
            _KM * north_m,
            linestyle="none",
            marker=".",
            markersize=2.4,
            markeredgewidth=0.0,
            color=color,
            alpha=0.55,
            rasterized=True,
        )
        ellipse = cloud.datum(time_s), cloud.covariance_m2(time_s)
        outline_m = ellipse_outline(*ellipse, chi_square_quantile(0.9, 2))
        ax.plot(*(_KM * outline_m.T[::-1]), color=color, linewidth=1.3, label=_hours(time_s))
    track_m = np.array([cloud.datum(t) for t in cloud.time_s])
    ax.plot(*(_KM * track_m.T[::-1]), color=INK, linewidth=1.6, path_effects=halo(3.0))
    _draw_land(ax, scenario)
    _draw_start(ax)
    _draw_datum(ax, cloud, cloud.time_s[-1])
    dress_map(ax)
    _limit(ax, [cloud.at(t) for t in times_s])
    name_lines(ax)
    return ax


def plan_view(ax: Axes, scenario: SearchScenario, cloud: Cloud, plan: Plan) -> Axes:
    """Routes and areas of the units on the cloud at the middle of the search."""
    first_s = min(sortie.time_s[0] for sortie in plan.sorties)
    last_s = max(sortie.time_s[-1] for sortie in plan.sorties)
    middle_s = 0.5 * (first_s + last_s)
    north_m, east_m, density = _density(cloud, middle_s)
    ax.pcolormesh(_KM * east_m, _KM * north_m, density, cmap=_shades(0.65), rasterized=True)
    shown, searched = [cloud.at(middle_s)], cloud
    for sortie, color in zip(plan.sorties, cycle(PALETTE), strict=False):
        before = searched.weight.sum()
        searched = searched.searched(sortie.potential(searched, plan.law))
        gained = before - searched.weight.sum()
        pattern = sortie.pattern
        outline_m = pattern.outline_m()
        closed_m = np.vstack([outline_m, outline_m[:1]])
        ax.plot(*(_KM * closed_m.T[::-1]), color=color, linewidth=1.0, linestyle=(0, (5, 3)))
        text = f"{sortie.unit.name}: {pattern.label}, POS {gained:.0%}"
        ax.plot(
            *(_KM * sortie.position_m.T[::-1]),
            color=color,
            linewidth=1.4,
            path_effects=halo(2.6),
            label=plain(text),
        )
        way_m = np.vstack([sortie.unit.position_m, sortie.position_m[0]])
        ax.plot(*(_KM * way_m.T[::-1]), color=color, linewidth=1.0, linestyle=":")
        ax.plot(
            *(_KM * sortie.position_m[0][::-1]),
            marker="o",
            markersize=7,
            markerfacecolor="white",
            markeredgecolor=color,
            markeredgewidth=1.8,
            zorder=4,
        )
        shown += [outline_m, sortie.position_m]
    _draw_land(ax, scenario)
    _draw_start(ax)
    _draw_datum(ax, cloud, middle_s)
    dress_map(ax)
    _limit(ax, shown)
    name_lines(ax, columns=1)
    return ax


def pos_panel(
    ax: Axes, cloud: Cloud, plans: Mapping[str, Plan], bound: Allocation | None = None
) -> Axes:
    """POS against time of plans by name and of the bound; bars when units of the first search."""
    first_s, last_s = np.inf, -np.inf
    for plan in plans.values():
        first_s = min([first_s, *(sortie.time_s[0] for sortie in plan.sorties)])
        last_s = max([last_s, *(sortie.time_s[-1] for sortie in plan.sorties)])
    time_s = np.linspace(first_s, last_s, 61)
    if bound is not None:
        curve = bound.pos_over_time(cloud)
        ax.fill_between(bound.time_s / 3600.0, 0.0, 100 * curve, color="#EEF1F4", linewidth=0)
        ax.plot(
            bound.time_s / 3600.0,
            100 * curve,
            color=MUTED,
            linewidth=1.2,
            linestyle=(0, (4, 2)),
            label=_LABELS["bound"],
        )
    ends = []
    for name, plan in plans.items():
        curve = 100 * plan.pos_over_time(cloud, time_s)
        color = _COLORS.get(name, INK)
        ax.plot(time_s / 3600.0, curve, color=color, linewidth=2.0, label=_LABELS.get(name, name))
        ends.append((curve[-1], color))
    height = -np.inf
    for value, color in sorted(ends):
        height = max(value, height + _LINE_HEIGHT)
        ax.annotate(
            f"{value:.0f} %",
            (time_s[-1] / 3600.0, height),
            xytext=(5, 0),
            textcoords="offset points",
            va="center",
            color=color,
            fontsize=TEXT_PT + 1,
        )
    sorties = next(iter(plans.values())).sorties
    for k, sortie in enumerate(sorties):
        height = -4.0 - 5.0 * k
        ends_h = sortie.time_s[[0, -1]] / 3600.0
        ax.plot(
            ends_h,
            [height, height],
            color=PALETTE[k % len(PALETTE)],
            linewidth=5.0,
            solid_capstyle="butt",
        )
        ax.annotate(
            plain(sortie.unit.name),
            (ends_h[0], height),
            xytext=(-5, 0),
            textcoords="offset points",
            ha="right",
            va="center",
            fontsize=TEXT_PT - 1,
            color=INK,
        )
    margin_h = (last_s - first_s) / 3600.0 * np.array([-0.1, 0.02])
    ax.set_xlim(np.array([first_s, last_s]) / 3600.0 + margin_h)
    ax.set_ylim(-4.0 - 5.0 * len(sorties), 104.0)
    ax.set_yticks(range(0, 101, 20))
    ax.set(xlabel="time after the last known position (h)", ylabel="POS (%)")
    dress(ax)
    return name_lines(ax)


# Parts -------------------------------------------------------------------------------------------


def _density(cloud: Cloud, time_s: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges of fine cells, and the smoothed probability density per m² in them."""
    from wakeline.search import probability_map

    place_m = cloud.at(time_s)
    low_m, high_m = (np.percentile(place_m, q, axis=0) for q in (0.2, 99.8))
    margin_m = 0.15 * (high_m - low_m).max() + 1.0
    side_m = ((high_m - low_m).max() + 2 * margin_m) / 110
    north_m, east_m = (
        np.arange(low - margin_m, high + margin_m + side_m, side_m)
        for low, high in zip(low_m, high_m, strict=True)
    )
    poc = probability_map(cloud, time_s, north_m, east_m)
    width = max(_SMOOTH_CELLS, 3.2 * (5000 / len(cloud)) ** (1 / 6))
    reach = np.arange(-int(3 * width) - 1, int(3 * width) + 2)
    kernel = np.exp(-0.5 * (reach / width) ** 2)
    kernel /= kernel.sum()
    for axis in (0, 1):
        poc = np.apply_along_axis(np.convolve, axis, poc, kernel, mode="same")
    return north_m, east_m, poc / side_m**2


def _shades(most: float = 1.0):
    from matplotlib.colors import LinearSegmentedColormap

    colors = ("#FDEBC800", "#FDEBC8", "#FBC77E", "#F0883E", "#CC4A2A", "#7F1D2E")
    whole = LinearSegmentedColormap.from_list("poc", colors)
    return LinearSegmentedColormap.from_list("part", whole(np.linspace(0.0, most, 64)))


def _time_colors(count: int) -> list:
    from matplotlib.colors import LinearSegmentedColormap

    colors = ("#9AC7E8", "#56B4E9", "#0072B2", "#332288", "#882255", "#D55E00")
    return list(LinearSegmentedColormap.from_list("time", colors)(np.linspace(0.0, 1.0, count)))


def _draw_land(ax: Axes, scenario: SearchScenario) -> None:
    for corners_m in scenario.land:
        ax.fill(*(_KM * corners_m.T[::-1]), facecolor=_LAND, edgecolor=MUTED, linewidth=0.8)


def _draw_start(ax: Axes) -> None:
    ax.plot(0.0, 0.0, marker="X", markersize=9, color=INK, markeredgecolor="white", zorder=5)
    _noted(ax, (0.0, 0.0), "last known position", (-12, -17))


def _draw_datum(ax: Axes, cloud: Cloud, time_s: float) -> None:
    east_km, north_km = _KM * cloud.datum(time_s)[::-1]
    ax.plot(
        east_km, north_km, marker="P", markersize=9, color=DANGER, markeredgecolor="white", zorder=5
    )
    _noted(ax, (east_km, north_km), f"datum {_hours(time_s)}")


def _noted(
    ax: Axes, place: tuple[float, float], text: str, offset_pt: tuple[float, float] = (7, 6)
) -> None:
    ax.annotate(
        text,
        place,
        xytext=offset_pt,
        textcoords="offset points",
        fontsize=TEXT_PT,
        color=INK,
        path_effects=halo(2.5),
        zorder=6,
    )


def _limit(ax: Axes, places_m: Sequence[np.ndarray]) -> None:
    """Show nearly all of the positions, with a margin."""
    low_m = np.min([np.percentile(p, 0.2, axis=0) for p in places_m], axis=0)
    high_m = np.max([np.percentile(p, 99.8, axis=0) for p in places_m], axis=0)
    margin_m = 0.08 * (high_m - low_m).max() + 100.0
    corners_km = _KM * np.array([low_m - margin_m, high_m + margin_m])
    ax.set(xlim=corners_km[:, 1], ylim=corners_km[:, 0])
    ax.set_aspect("equal", adjustable="box")


def _titled(ax: Axes, text: str) -> Axes:
    ax.set_title(text, fontsize=TEXT_PT + 1, color=INK, loc="left")
    return ax


def _hours(time_s: float) -> str:
    return f"{time_s / 3600.0:.1f} h"


def _after(time_s: float) -> str:
    return f"{_hours(time_s)} after the last known position"
