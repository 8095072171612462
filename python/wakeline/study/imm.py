"""Paper A: an IMM of two and of three models on a vessel that turns to both sides.

"Interacting multiple model algorithm for tracking maneuvering surface vessels", Vestnik NovSU,
2023, 3(132), 394-404. The paper shows curves, reports no figures, and claims: the right model is
the most probable in each segment, the error peaks at the switches, IMM3 is better than IMM2.

Scenarios are ``scans`` and ``seconds``, the two readings of the paper's table of turns; the result
is the Monte Carlo result of both.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from wakeline import PiecewiseAcceleration, montecarlo, plot
from wakeline._brief import many
from wakeline.scenario import Scenario, papers

from . import curves
from .base import Done, Picture, Plan, Published, Request, Rows, Study
from .estimators import turn_candidate

LABELS = {"imm2": "IMM2", "imm3": "IMM3", "clairvoyant": "clairvoyant"}
_NOISE = PiecewiseAcceleration(std_mps2=0.05)
_RATES_DEG_S = {"imm2": (0, 1), "imm3": (0, 1, -1)}
_READINGS = {
    "scans": "the table of turns counts scans",
    "seconds": "the table of turns counts seconds",
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
    } | {"clairvoyant": montecarlo.clairvoyant}


def _plan(request: Request) -> Plan:
    scenarios = {reading: papers.imm(reading) for reading in _READINGS}
    work = partial(
        montecarlo.run,
        list(scenarios.values()),
        estimators(),
        request.runs,
        request.seed,
        threads=request.threads,
        progress=request.progress,
    )
    return Plan(
        jobs={"imm": work},
        in_turn=True,
        rows=lambda done: _rows(scenarios, done),
        result=lambda done: done.get("imm"),
        pictures=lambda done, _: _pictures(done["imm"], scenarios, request.seed),
        notes=lambda done, _: [_wins(done["imm"], scenarios)],
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
