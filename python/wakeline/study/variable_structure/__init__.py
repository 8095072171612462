"""Paper B: an IMM of five models against three models with adaptive turn rates.

Le Minh Hoang, A. A. Konovalov, Dao Van Luc, "Tracking of maneuvering targets using a variable
structure multiple model algorithm", J. Russian Universities. Radioelectronics, 2023, 26(3), 77-89.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from wakeline import montecarlo, scenario
from wakeline._checks import run_numbers
from wakeline.scenario import Scenario

from .. import curves
from ..base import Report, Rows, kept
from . import covariances
from .candidates import SETTINGS, estimators
from .pictures import pictures_of, robustness_picture
from .published import PAPER, REFERENCE
from .sweeps import moves, survey, swept

__all__ = ["PAPER", "REFERENCE", "SETTINGS", "SUMMARY", "estimators", "run"]

SUMMARY = "IMM of five models against moving grids of three, paper B: AGMM and SGMM"

RANDOM_SCENARIOS = 24
NOTE = (
    "The paper's mean position errors of AGMM and SGMM are at or below the bound of an estimator\n"
    "that knows every turn. Runs start at the true state, while the bound assumes initial errors\n"
    "of 10 m and 1 m/s: as long as these have an influence, an estimator can be below it."
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
        Of the Monte Carlo runs; the 24 random scenarios share them, rounded up.
    full : bool
        Also the dependence on turn rates off the grid, noise, thresholds, unprinted parameters, and
        a start from plots.
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
    report = Report(
        name="variable-structure",
        seed=seed,
        runs=runs,
        rows=[],
        published={"paper": PAPER, "reference": REFERENCE},
    )
    results: dict[str, montecarlo.Result] = {}
    rows: Rows = []

    def monte_carlo(
        name: str,
        scenarios: Sequence[Scenario],
        candidates: Mapping[str, Any],
        rows_of: Callable[[montecarlo.Result], Rows],
        share: int = 1,
    ) -> montecarlo.Result:
        def until_now(done: montecarlo.Result) -> Report:
            return replace(report, rows=rows + rows_of(done), result=results | {name: done})

        with kept(until_now, montecarlo.Result({}, runs, seed)):
            result = montecarlo.run(
                scenarios, candidates, -(-runs // share), seed, threads=threads, progress=progress
            )
        rows.extend(rows_of(result))
        return result

    for name in ("example1", "example2"):
        example = scenario.named(name)
        rows_of = partial(curves.rows, name=name, scenario=example)
        results[name] = monte_carlo(name, [example], estimators(SETTINGS[name]), rows_of)
    wanderers = scenario.random_maneuvers(RANDOM_SCENARIOS)
    rows_of = partial(curves.merged_rows, name="random", scenarios=wanderers)
    wandering = estimators(SETTINGS["random"])
    results["random"] = monte_carlo("random", wanderers, wandering, rows_of, len(wanderers))
    for example, candidates in swept() if full else ():
        rows_of = partial(curves.rows, name=example.name, scenario=example)
        monte_carlo(example.name, [example], candidates, rows_of)
    notes = [NOTE, covariances.note(results)]
    if full:
        with kept(lambda _: replace(report, rows=rows, result=results)):
            notes += [moves(runs, seed), survey(-(-runs // 5), seed, threads)]
    drawn = [*pictures_of(results, rows, seed), *([robustness_picture(rows)] if full else [])]
    return replace(report, rows=rows, result=results, pictures=tuple(drawn), notes=tuple(notes))
