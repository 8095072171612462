"""Paper B: an IMM of five models against three models whose turn rates move with the vessel.

Le Minh Hoang, A. A. Konovalov, Dao Van Luc, "Tracking of maneuvering targets using a variable
structure multiple model algorithm", J. Russian Universities. Radioelectronics, 2023, 26(3), 77-89.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from wakeline import montecarlo, scenario
from wakeline._checks import run_numbers
from wakeline.scenario import Scenario

from .. import curves
from ..base import Report
from . import covariances
from .candidates import SETTINGS, estimators
from .pictures import pictures_of, robustness_picture
from .published import PAPER, REFERENCE
from .sweeps import moves, survey, swept

__all__ = ["PAPER", "REFERENCE", "SETTINGS", "SUMMARY", "estimators", "run"]

SUMMARY = "IMM of five models against moving grids of three, paper B: AGMM and SGMM"

RANDOM_SCENARIOS = 24
NOTE = (
    "The paper's mean position errors of AGMM and SGMM lie on or below the bound of an estimator\n"
    "that is told every turn. Runs start at the true state, while the bound takes the start to be\n"
    "known to 10 m and 1 m/s only: as long as that is remembered, an estimator can be below it."
)


def run(
    runs: int = 500,
    seed: int = 0,
    *,
    full: bool = False,
    threads: int | None = None,
    progress: bool = False,
) -> Report:
    """Run the study.

    Parameters
    ----------
    runs, seed : int
        Of the Monte Carlo runs. Each of the 24 random scenarios has as many of them as make up
        `runs`, rounded up.
    full : bool
        Also what the outcome hangs on: turn rates beside the grid, noise, thresholds, what is not
        printed, a start from plots.
    threads : int, optional
        Default as many as there are processors.
    progress : bool
        Whether to draw a bar where stderr is a terminal.

    Returns
    -------
    Report
        Scenarios ``example1``, ``example2`` and ``random``, whose `result` is a mapping by these.
    """
    run_numbers(runs, seed, threads)

    def monte_carlo(
        scenarios: Sequence[Scenario], candidates: Mapping[str, Any], share: int = 1
    ) -> montecarlo.Result:
        return montecarlo.run(
            scenarios, candidates, -(-runs // share), seed, threads=threads, progress=progress
        )

    results, rows = {}, []
    for name in ("example1", "example2"):
        example = scenario.named(name)
        results[name] = monte_carlo([example], estimators(SETTINGS[name]))
        rows += curves.rows(results[name], name, example)
    wanderers = scenario.random_maneuvers(RANDOM_SCENARIOS)
    results["random"] = monte_carlo(wanderers, estimators(SETTINGS["random"]), len(wanderers))
    rows += curves.merged_rows(results["random"], "random", wanderers)
    for example, candidates in swept() if full else ():
        result = monte_carlo([example], candidates)
        rows += curves.rows(result, example.name, example)
    notes = [NOTE, covariances.note(results)]
    if full:
        notes += [moves(runs, seed), survey(-(-runs // 5), seed, threads)]
    drawn = [*pictures_of(results, rows, seed), *([robustness_picture(rows)] if full else [])]
    return Report(
        name="variable-structure",
        seed=seed,
        runs=runs,
        rows=rows,
        result=results,
        pictures=tuple(drawn),
        published={"paper": PAPER, "reference": REFERENCE},
        notes=tuple(notes),
    )
