"""Consistency of the estimators: their NEES and its band, scan by scan."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from wakeline import eval, metrics, montecarlo

_STATES, _CONFIDENCE = 4, 0.95
_SOON_SCANS = 10
_HEAD = """\
NEES without the three scans after each switch (consistent: 4); share of these scans whose mean
over the runs is below and above its 95 % band; in brackets, above within ten scans of a switch:"""


class Worth(NamedTuple):
    """Figures of the NEES without the three scans after each switch.

    Shares of these scans: ``below`` and ``above`` the 95 % band of the mean of the runs, and
    ``soon``, above and within ten scans after a switch.
    """

    nees: float
    below: float
    above: float
    soon: float

    def __str__(self) -> str:
        below, above, soon = (f"{100.0 * share:.0f}" for share in self[1:])
        return f"{self.nees:.2f}; {below} and {above} % ({soon} %)"


def worth(outcomes: Sequence[montecarlo.Outcome]) -> Worth:
    """The figures of one estimator, averaged over the scenarios; NaN without a run."""
    each = [_worth(outcome) for outcome in outcomes if outcome.runs]
    return Worth(*np.mean(each or [[np.nan] * 4], axis=0).tolist())


def note(results: Mapping[str, montecarlo.Result]) -> str:
    """One line per estimator, with its figures on each group of scenarios."""
    names = next(iter(results.values())).candidates
    columns = [["", *names]]
    for group, result in results.items():
        found = (worth([result[one, name] for one in result.scenarios]) for name in names)
        columns.append([group, *map(str, found)])
    widths = [max(map(len, column)) for column in columns]
    lines = [
        "  " + "  ".join(f"{cell:{width}}" for cell, width in zip(row, widths, strict=True))
        for row in zip(*columns, strict=True)
    ]
    return "\n".join([_HEAD, *map(str.rstrip, lines)])


def _worth(outcome: montecarlo.Outcome) -> Worth:
    time_s, switch_s = outcome.time_s, outcome.switch_times_s
    steady = metrics.steady_scans(time_s, switch_s)
    soon = ~metrics.steady_scans(time_s, switch_s, scans=_SOON_SCANS)
    lower, upper = eval.consistency_bounds(_CONFIDENCE, _STATES, outcome.runs)
    below, above = outcome.nees < lower, outcome.nees > upper
    shares = (mask[steady].mean() for mask in (below, above, above & soon))
    return Worth(float(outcome.nees[steady].mean()), *map(float, shares))
