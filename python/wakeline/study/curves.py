"""Rows and pictures of Monte Carlo results, common to the studies of maneuvers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from wakeline import metrics, montecarlo, plot
from wakeline.scenario import Scenario

from .base import Picture, Rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes

METRICS = (
    *("mean_position_m", "peak_position_m", "mean_velocity_mps", "peak_velocity_mps"),
    *("nees", "steady_nees", "steady_mean_nees_inside_share", "settling_s", "ns_per_step"),
)
BOUND = "bound"
_SAME_RATE_RAD_S = 1e-9


def rows(result: montecarlo.Result, name: str, scenario: Scenario) -> Rows:
    """A row per candidate on a scenario called `name`, and one of the bound.

    Candidates missing from a partial result have no row.
    """
    found = [
        _row(name, candidate, outcome.summary())
        for (scene, candidate), outcome in result.outcomes.items()
        if scene == scenario.name
    ]
    return [*found, _row(name, BOUND, bound_figures([scenario]))] if found else []


def merged_rows(result: montecarlo.Result, name: str, scenarios: Sequence[Scenario]) -> Rows:
    """The same over several scenarios of one length, their curves averaged."""
    names = [scenario.name for scenario in scenarios]
    found = [
        _row(name, candidate, result.merged(candidate, names))
        for candidate in result.candidates
        if all((scene, candidate) in result.outcomes for scene in names)
    ]
    return [*found, _row(name, BOUND, bound_figures(scenarios))] if found else []


def figures(rows: Rows, metric: str) -> dict[tuple[str, str], float]:
    """One metric of all rows by scenario and estimator."""
    return {(row["scenario"], row["estimator"]): row[metric] for row in rows}


def bound_figures(scenarios: Sequence[Scenario]) -> dict[str, float]:
    """Mean and peak of the bound, squared errors averaged over the scenarios scan by scan."""
    position_m, velocity_mps = (
        metrics.rmse(curve, axis=0)
        for curve in zip(*(montecarlo.bound_curves(one) for one in scenarios), strict=True)
    )
    return {
        "mean_position_m": float(position_m.mean()),
        "peak_position_m": float(position_m.max()),
        "mean_velocity_mps": float(velocity_mps.mean()),
        "peak_velocity_mps": float(velocity_mps.max()),
    }


def _row(scenario: str, estimator: str, found: Mapping[str, Any]) -> dict[str, Any]:
    return {"scenario": scenario, "estimator": estimator} | {
        metric: found.get(metric) for metric in METRICS
    }


# Panels -------------------------------------------------------------------------------------------


def error_picture(
    name: str,
    title: str,
    result: montecarlo.Result,
    scenario: Scenario,
    labels: Mapping[str, str],
    colors: Mapping[str, str],
) -> Picture:
    """RMSE of position and velocity over time, with the bound."""
    outcomes = {labels[key]: result[scenario.name, key] for key in labels}
    return Picture(
        name,
        title,
        (
            partial(draw_errors, scenario=scenario, outcomes=outcomes, colors=colors),
            partial(draw_errors, scenario=scenario, outcomes=outcomes, colors=colors, speed=True),
        ),
        size_in=(7.2, 6.2),
    )


def draw_errors(
    ax: Axes,
    scenario: Scenario,
    outcomes: Mapping[str, montecarlo.Outcome],
    colors: Mapping[str, str],
    speed: bool = False,
) -> Axes:
    """One panel of RMSE curves; only that of positions has a legend."""
    key = "velocity_rmse_mps" if speed else "position_rmse_m"
    return plot.error_panel(
        ax,
        scenario.time_s,
        {name: getattr(outcome, key) for name, outcome in outcomes.items()},
        bound=montecarlo.bound_curves(scenario)[int(speed)],
        ylabel="velocity RMSE (m/s)" if speed else "position RMSE (m)",
        switch_s=scenario.switch_times_s,
        colors=colors,
        legend=not speed,
    )


def draw_truth(ax: Axes, scenario: Scenario) -> Axes:
    """The true path."""
    return plot.paths_view(ax, scenario.truth_states, switch=switch_scans(scenario))


def draw_tracks(
    ax: Axes,
    scenario: Scenario,
    candidates: Mapping[str, Any],
    seed: int,
    colors: Mapping[str, str] | None = None,
) -> Axes:
    """Plots and filtered tracks of the first run."""
    z = scenario.draw(1, seed)
    tracks = {name: kinematics(call(scenario, z).mean[0]) for name, call in candidates.items()}
    return plot.paths_view(
        ax,
        scenario.truth_states,
        tracks,
        plots_m=place_m(z[0]),
        switch=switch_scans(scenario),
        colors=colors,
    )


def draw_modes(
    ax: Axes, outcome: montecarlo.Outcome, rates_rad_s: Sequence[float], ylabel: str
) -> Axes:
    """Mean mode probabilities of models of fixed turn rates."""
    return plot.probability_panel(
        ax,
        outcome.time_s,
        outcome.mode_probability,
        rates_rad_s,
        true_rate_rad_s=outcome.true_turn_rate_rad_s,
        switch_s=outcome.switch_times_s,
        ylabel=ylabel,
    )


# Figures of a result ------------------------------------------------------------------------------


class Lead(NamedTuple):
    """The right model in a segment: the share of scans in which it leads, and its delay.

    It leads where its mean probability over the runs is the largest; the delay is the number of
    scans until it is the most probable one in half of the runs. Both are None if no model has the
    true rate.
    """

    rate_deg_s: float
    share: float | None
    delay_scans: int | None


def leads_by_segment(outcome: montecarlo.Outcome, rates_rad_s: Sequence[float]) -> list[Lead]:
    """The lead of the right model in each segment of constant true turn rate."""
    rates = np.asarray(rates_rad_s, dtype=float)
    true = outcome.true_turn_rate_rad_s
    leads = metrics.right_mode(outcome.mode_probability, rates, true)
    segments = np.split(np.arange(len(true)), np.flatnonzero(np.diff(true)) + 1)
    found = []
    for part in segments:
        in_half = np.append(outcome.right_mode_share[part] >= 0.5, True)
        has_model = (np.abs(rates - true[part[0]]) < _SAME_RATE_RAD_S).any()
        lead = (float(leads[part].mean()), int(in_half.argmax())) if has_model else (None, None)
        found.append(Lead(float(np.degrees(true[part[0]])), *lead))
    return found


def switch_scans(scenario: Scenario) -> list[int]:
    """The scans at or after the switches."""
    return np.searchsorted(scenario.time_s, scenario.switch_times_s).tolist()


def place_m(z: np.ndarray) -> np.ndarray:
    """North and east (..., 2) of readings (..., 2) of range and bearing."""
    range_m, bearing_rad = np.moveaxis(z, -1, 0)
    return np.stack([range_m * np.cos(bearing_rad), range_m * np.sin(bearing_rad)], axis=-1)


def kinematics(mean: np.ndarray) -> np.ndarray:
    """``[north, vnorth, east, veast]`` (..., 4) of states of 4, 5 or 6 components."""
    return mean[..., [0, 1, 3, 4]] if mean.shape[-1] == 6 else mean[..., :4]
