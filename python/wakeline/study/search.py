"""Search: predicted and simulated success of plans for the bundled scenario.

Objects drift by the model of :mod:`wakeline.search` with their own errors, in steps five times as
fine as those of the plan, and are detected or missed by chance. Scenarios are the patterns,
``plan`` is the pattern optimized for the drifting cloud, ``naive`` the same pattern of coverage 1
in a square about the datum, ``bound`` the greedy allocation of the plan's effort over cells.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from wakeline import plot
from wakeline import search as ws
from wakeline._checks import entropy

from .base import Done, Picture, Plan, Request, Rows, Study

if TYPE_CHECKING:
    from matplotlib.axes import Axes

EXAMPLE = "liferaft"
LABELS = {kind: known.label for kind, known in ws.PATTERNS.items()}

_PLANNED, _JUDGED = 2000, 10000
_TRUE_STEP_S = 120.0
_BAND = 0.99
_ESTIMATORS = {"plan": "optimized", "naive": "naive", "bound": "optimized"}
_SHADES = {"plan": plot.PALETTE[0], "naive": plot.PALETTE[1], "bound": plot.MUTED}


def binomial_band(probability: float, runs: int, share: float = _BAND) -> tuple[int, int]:
    """Fewest and most successes of `runs` that have at least the given share between them."""
    counts = np.arange(runs + 1)
    logs = np.append(0.0, np.cumsum(np.log(counts[1:])))
    p = min(max(probability, 1e-12), 1.0 - 1e-12)
    chances = np.exp(
        logs[-1] - logs - logs[::-1] + counts * np.log(p) + (runs - counts) * np.log1p(-p)
    )
    below = np.cumsum(chances)
    tail = 0.5 * (1.0 - share)
    low = int(np.searchsorted(below, tail))
    high = int(np.searchsorted(below, 1.0 - tail))
    return low, min(high, runs)


def _plan(request: Request) -> Plan:
    scenario = ws.read_scenario(EXAMPLE)
    seed = 3 * request.seed
    planned = scenario.cloud(_PLANNED, seed)
    judged = scenario.cloud(_JUDGED, seed + 1)
    objects = scenario.cloud(request.runs, seed + 2, step_s=_TRUE_STEP_S)
    chance = np.random.default_rng(entropy(request.seed, "search chance")).random(request.runs)

    def judgment(plan: ws.Plan | ws.Allocation, pod: np.ndarray) -> dict[str, Any]:
        return {"predicted": plan.pos(judged), "found": int(np.count_nonzero(chance < pod))}

    def optimized(kind: str) -> dict[str, Any]:
        plan = ws.optimized_plan(scenario.units, planned, scenario.law, [kind], request.seed)
        bound = ws.greedy_bound(plan, judged)
        return {
            "routes": plan,
            "plan": judgment(plan, plan.pod(objects)),
            "bound": judgment(bound, bound.pod(objects)),
        }

    def naive(kind: str) -> dict[str, Any]:
        plan = ws.naive_plan(scenario.units, judged, scenario.law, kind)
        return {"routes": plan, "naive": judgment(plan, plan.pod(objects))}

    jobs = {
        (kind, work.__name__): partial(work, kind)
        for kind in scenario.patterns
        for work in (optimized, naive)
    }
    return Plan(
        jobs=jobs,
        rows=partial(_rows, runs=request.runs),
        pictures=partial(_pictures, scenario=scenario, cloud=judged, runs=request.runs),
        notes=partial(_notes, runs=request.runs),
    )


STUDY = Study(
    "search",
    "search plans for a drifting life raft: predicted and simulated probability of success",
    _plan,
)
run = STUDY.run


def _rows(done: Done, runs: int) -> Rows:
    return [
        {
            "scenario": kind,
            "estimator": name,
            "pos_predicted": one[name]["predicted"],
            "pos_found": one[name]["found"] / runs,
            "found_runs": one[name]["found"],
        }
        for kind in ws.PATTERNS
        for name, work in _ESTIMATORS.items()
        if name in (one := done.get((kind, work), {}))
    ]


def _notes(done: Done, rows: Rows, runs: int) -> list[str]:
    outside = [
        f"{row['estimator']} of {LABELS[row['scenario']]}"
        for row in rows
        if row["estimator"] != "bound" and not _is_inside(row, runs)
    ]
    found = {(row["scenario"], row["estimator"]): row["found_runs"] for row in rows}
    gains = ", ".join(
        f"{label} {found[kind, 'plan'] / max(found[kind, 'naive'], 1) - 1:+.0%}"
        for kind, label in LABELS.items()
    )
    return [
        f"outside the binomial {_BAND:.0%} band of the predicted POS: "
        + (", ".join(outside) or "none"),
        f"found by the plan compared with the naive one: {gains}",
    ]


def _is_inside(row: dict[str, Any], runs: int) -> bool:
    low, high = binomial_band(row["pos_predicted"], runs)
    return low <= row["found_runs"] <= high


def _pictures(
    done: Done, rows: Rows, scenario: ws.SearchScenario, cloud: ws.Cloud, runs: int
) -> list[Picture]:
    plans, naive = (
        tuple(
            partial(plot.plan_view, scenario=scenario, cloud=cloud, plan=done[kind, work]["routes"])
            for kind in ws.PATTERNS
        )
        for work in ("optimized", "naive")
    )
    size = {"size_in": (11.0, 11.0), "columns": 2, "shared": False}
    return [
        Picture(
            "pos",
            "Predicted and simulated success",
            (partial(_bars, rows=rows, runs=runs),),
            size_in=(7.2, 4.2),
        ),
        Picture("plans", "Optimized plans by pattern", plans, **size),
        Picture("naive", "Naive plans: squares about the datum", naive, **size),
    ]


def _bars(ax: Axes, rows: Rows, runs: int) -> Axes:
    """Share found as bars, predicted POS as marks with the band that the share should be in."""
    kinds = list(dict.fromkeys(row["scenario"] for row in rows))
    names = list(dict.fromkeys(row["estimator"] for row in rows))
    for k, name in enumerate(names):
        mine = [row for row in rows if row["estimator"] == name]
        at = np.arange(len(kinds)) + 0.27 * (k - 1)
        found = [100 * row["pos_found"] for row in mine]
        predicted = np.array([100 * row["pos_predicted"] for row in mine])
        ax.bar(at, found, 0.25, color=_SHADES[name], alpha=0.85, label=f"{name}: share found")
        bands = np.array([binomial_band(row["pos_predicted"], runs) for row in mine]).T
        reach = np.abs(100 * bands / runs - predicted)
        ax.errorbar(
            at,
            predicted,
            yerr=reach,
            linestyle="none",
            marker="D",
            markersize=4.5,
            color=plot.INK,
            markerfacecolor="white",
            capsize=3,
            linewidth=1.0,
            label="predicted POS, 99 % band" if k == 0 else None,
        )
    ax.set_xticks(np.arange(len(kinds)), [LABELS[kind] for kind in kinds])
    ax.set(ylabel=f"POS (%), {runs} objects", ylim=(0.0, 104.0))
    plot.dress(ax)
    ax.grid(axis="x", visible=False)
    return plot.name_lines(ax)
