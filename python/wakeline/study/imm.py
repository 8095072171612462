"""Paper A: an IMM of two and of three models on a vessel that turns to both sides.

"Interacting multiple model algorithm for tracking maneuvering surface vessels", Vestnik NovSU,
2023, 3(132), 394-404. The paper shows curves, reports no figures, and claims: the right model is
the most probable in each segment, the error peaks at the switches, IMM3 is better than IMM2, and an
IMM better than a filter that detects a maneuver and then switches.

Scenarios are ``scans`` and ``seconds``, the two readings of the paper's table of turns;
``scans_cauchy`` and ``scans_gaussian`` are the first one under random accelerations, heavy-tailed
as in the paper's (4) and Gaussian of the same variance, each on 20 truths, to each of which falls
its share of the runs, rounded up. The result is the Monte Carlo result of the two readings.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from wakeline import PiecewiseAcceleration, montecarlo, plot
from wakeline._brief import many
from wakeline.montecarlo import Candidate
from wakeline.scenario import Scenario, disturbed, papers

from . import curves
from .base import Done, Picture, Plan, Published, Request, Rows, Study
from .detector import DetectThenSwitch
from .estimators import turn_candidate

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LABELS = {
    "imm2": "IMM2",
    "imm3": "IMM3",
    "detect_switch": "detect, then switch",
    "clairvoyant": "clairvoyant",
}
_NOISE = PiecewiseAcceleration(std_mps2=0.05)
_RATES_DEG_S = {"imm2": (0, 1), "imm3": (0, 1, -1)}
_READINGS = {
    "scans": "the table of turns counts scans",
    "seconds": "the table of turns counts seconds",
}
_TRUTHS = 20
# Scale of the accelerations, degrees of freedom and largest one: the root mean square of a Cauchy
# law that is cut at 20 scales is 3.5 scales.
_DISTURBANCES = {
    "scans_cauchy": (0.01, 1.0, 0.2),
    "scans_gaussian": (0.035, np.inf, 0.2),
}

REFERENCE = Published(
    ("peak_position_m", "peak_velocity_mps", "mean_position_m", "mean_velocity_mps"),
    {("scans", "imm2"): (95.3, 4.86, 33.2, 1.59), ("scans", "imm3"): (28.4, 2.38, 23.4, 1.04)},
)


def estimators() -> dict[str, Any]:
    """The candidates by name; plain converted measurements and 0.05 m/s² as in the paper."""
    return {
        name: turn_candidate(rates, _NOISE, "converted", stay=0.95)
        for name, rates in _RATES_DEG_S.items()
    } | {"detect_switch": detector(), "clairvoyant": montecarlo.clairvoyant}


def detector() -> Candidate:
    """The baseline: levels of noise, memory and bounds with the least mean error on ``scans``."""
    switching = DetectThenSwitch(
        quiet_std_mps2=0.05,
        maneuver_std_mps2=0.2,
        memory=0.9,
        detect_probability=0.95,
        quiet_probability=0.3,
    )
    return Candidate(switching, "converted")


def disturbed_scenarios(name: str) -> list[Scenario]:
    """The scenario ``scans`` under random accelerations, each held for a scan."""
    scale, freedom, limit = _DISTURBANCES[name]
    scans = papers.imm("scans")
    return [
        replace(
            scans,
            name=f"{name}_{k}",
            truth=disturbed(
                scans.truth,
                scale,
                scans.radar.period_s,
                k,
                degrees_of_freedom=freedom,
                limit_mps2=limit,
            ),
        )
        for k in range(_TRUTHS)
    ]


def _plan(request: Request) -> Plan:
    scenarios = {reading: papers.imm(reading) for reading in _READINGS}
    wanderers = {name: disturbed_scenarios(name) for name in _DISTURBANCES}
    jobs = {"imm": _work(list(scenarios.values()), estimators(), request, request.runs)}
    disturbed_estimators = estimators() | {
        "clairvoyant": partial(montecarlo.clairvoyant, noise=_NOISE)
    }
    for name, truths in wanderers.items():
        jobs[name] = _work(truths, disturbed_estimators, request, -(-request.runs // _TRUTHS))

    def rows(done: Done) -> Rows:
        found = _rows(scenarios, {"imm": done["imm"]}) if "imm" in done else []
        for name, truths in wanderers.items():
            found += curves.merged_rows(done[name], name, truths) if name in done else []
        return found

    return Plan(
        jobs=jobs,
        in_turn=True,
        rows=rows,
        result=lambda done: done.get("imm"),
        pictures=lambda done, found: [
            *_pictures(done["imm"], scenarios, request.seed),
            _disturbance_picture(found, wanderers["scans_cauchy"][0]),
        ],
        notes=lambda done, _: [_wins(done["imm"], scenarios)],
    )


def _work(
    scenarios: Sequence[Scenario], candidates: dict[str, Any], request: Request, runs: int
) -> partial[montecarlo.Result]:
    return partial(
        montecarlo.run,
        list(scenarios),
        candidates,
        runs,
        request.seed,
        threads=request.threads,
        progress=request.progress,
    )


STUDY = Study(
    "imm",
    "IMM of two and three models, paper A: turns at 1 deg/s either way",
    _plan,
    published={"reference": REFERENCE},
)
run = STUDY.run


def _rows(scenarios: dict[str, Scenario], done: Done) -> Rows:
    return [
        row
        for result in done.values()
        for reading, scenario in scenarios.items()
        for row in curves.rows(result, reading, scenario)
    ]


def _pictures(
    result: montecarlo.Result, scenarios: dict[str, Scenario], seed: int
) -> list[Picture]:
    names = {name: LABELS[name] for name in _RATES_DEG_S}
    pictures = [
        Picture(
            "imm-truth",
            "Paper A: the true path, its table of turns read as scans and as seconds",
            tuple(partial(curves.draw_truth, scenario=scenario) for scenario in scenarios.values()),
            size_in=(9.0, 5.0),
            columns=2,
            shared=False,
        ),
        Picture(
            "imm-tracks",
            "One run: plots and filtered tracks",
            (
                partial(
                    curves.draw_tracks,
                    scenario=scenarios["scans"],
                    candidates={LABELS[name]: estimators()[name] for name in names},
                    seed=seed,
                ),
            ),
            shared=False,
        ),
    ]
    for reading, scenario in scenarios.items():
        pictures += [
            Picture(
                f"imm-modes-{reading}",
                f"Mode probabilities, mean of {many(result.runs, 'run')}; {_READINGS[reading]}",
                tuple(
                    partial(
                        curves.draw_modes,
                        outcome=result[scenario.name, name],
                        rates_rad_s=np.deg2rad(_RATES_DEG_S[name]),
                        ylabel=f"{LABELS[name]}\nmode probability",
                    )
                    for name in names
                ),
                size_in=(7.2, 5.2),
            ),
            curves.error_picture(
                f"imm-errors-{reading}",
                f"RMSE of {many(result.runs, 'run')} over the bound; {_READINGS[reading]}",
                result,
                scenario,
                LABELS,
                {"clairvoyant": plot.INK},
            ),
        ]
    return pictures


def _wins(result: montecarlo.Result, scenarios: dict[str, Scenario]) -> str:
    """Share of each segment in which the right model is the most probable, and its delay."""
    lines = [
        "Share of the scans of each segment in which the right model has the largest mean",
        "probability, and scans until it is the most probable in half of the runs:",
    ]
    for reading, scenario in scenarios.items():
        for name, rates in _RATES_DEG_S.items():
            leads = curves.leads_by_segment(result[scenario.name, name], np.deg2rad(rates))
            parts = [
                f"{lead.rate_deg_s:+.0f} °/s "
                + (
                    "no model"
                    if lead.share is None
                    else f"{lead.share:.0%} after {lead.delay_scans}"
                )
                for lead in leads
            ]
            lines.append(f"  {reading}, {name}: {', '.join(parts)}")
    return "\n".join(lines)


def _disturbance_picture(rows: Rows, example: Scenario) -> Picture:
    """A disturbed truth, and the errors of every estimator with and without disturbances."""
    return Picture(
        "imm-disturbed",
        "Random accelerations: one true path with heavy-tailed ones, and the mean errors",
        (
            partial(curves.draw_truth, scenario=example),
            partial(_draw_disturbed_ranking, rows=rows),
        ),
        size_in=(10.4, 4.6),
        columns=2,
        shared=False,
    )


def _draw_disturbed_ranking(ax: Axes, rows: Rows) -> Axes:
    found = curves.figures(rows, "mean_position_m")
    cases = {"none": "scans", "Gaussian": "scans_gaussian", "Cauchy-like": "scans_cauchy"}
    values = {label: [found[scene, name] for name in LABELS] for label, scene in cases.items()}
    return plot.ranking_panel(ax, list(LABELS.values()), values, xlabel="mean position RMSE (m)")
