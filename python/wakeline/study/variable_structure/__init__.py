"""Paper B: an IMM of five models against three models with adaptive turn rates.

Le Minh Hoang, A. A. Konovalov, Dao Van Luc, "Tracking of maneuvering targets using a variable
structure multiple model algorithm", J. Russian Universities. Radioelectronics, 2023, 26(3), 77-89.

Scenarios are ``example1``, ``example2`` and ``random``, by which the result is a mapping. Each of
the 24 random scenarios has its share of `runs`, rounded up. In full it also varies turn rates off
the grid, noise, thresholds, unprinted parameters, and the start from plots.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from wakeline import montecarlo, scenario
from wakeline.scenario import Scenario

from .. import curves
from ..base import Done, Picture, Plan, Request, Rows, Study
from . import covariances
from .candidates import SETTINGS, estimators
from .pictures import pictures_of, robustness_picture
from .published import PAPER, REFERENCE
from .sweeps import moves, survey, swept

__all__ = ["PAPER", "REFERENCE", "SETTINGS", "STUDY", "estimators", "run"]

RANDOM_SCENARIOS = 24
NOTE = (
    "The paper's mean position errors of AGMM and SGMM are at or below the bound of an estimator\n"
    "that knows every turn. Runs start at the true state, while the bound assumes initial errors\n"
    "of 10 m and 1 m/s: as long as these have an influence, an estimator can be below it."
)


def _plan(request: Request) -> Plan:
    runs, seed, threads = request.runs, request.seed, request.threads
    jobs: dict[str, Callable[[], montecarlo.Result]] = {}
    rows_of: dict[str, Callable[[montecarlo.Result], Rows]] = {}

    def add(
        name: str,
        scenarios: Sequence[Scenario],
        candidates: Mapping[str, Any],
        rows: Callable[[montecarlo.Result], Rows],
    ) -> None:
        share = -(-runs // len(scenarios))
        jobs[name] = partial(
            montecarlo.run,
            scenarios,
            candidates,
            share,
            seed,
            threads=threads,
            progress=request.progress,
        )
        rows_of[name] = rows

    for name in ("example1", "example2"):
        example = scenario.named(name)
        rows = partial(curves.rows, name=name, scenario=example)
        add(name, [example], estimators(SETTINGS[name]), rows)
    wanderers = scenario.random_maneuvers(RANDOM_SCENARIOS)
    rows = partial(curves.merged_rows, name="random", scenarios=wanderers)
    add("random", wanderers, estimators(SETTINGS["random"]), rows)
    groups = tuple(jobs)
    for example, candidates in swept() if request.full else ():
        rows = partial(curves.rows, name=example.name, scenario=example)
        add(example.name, [example], candidates, rows)

    def results(done: Done) -> dict[str, montecarlo.Result]:
        return {name: done[name] for name in groups if name in done}

    def pictures(done: Done, rows: Rows) -> list[Picture]:
        drawn = pictures_of(results(done), rows, seed)
        return [*drawn, *([robustness_picture(rows)] if request.full else [])]

    def notes(done: Done, rows: Rows) -> list[str]:
        found = [NOTE, covariances.note(results(done))]
        if request.full:
            found += [moves(runs, seed), survey(-(-runs // 5), seed, threads)]
        return found

    return Plan(
        jobs=jobs,
        in_turn=True,
        rows=lambda done: [row for name, one in done.items() for row in rows_of[name](one)],
        result=results,
        pictures=pictures,
        notes=notes,
    )


STUDY = Study(
    "variable-structure",
    "IMM of five models against moving grids of three, paper B: AGMM and SGMM",
    _plan,
    published={"paper": PAPER, "reference": REFERENCE},
)
run = STUDY.run
