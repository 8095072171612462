"""Scenarios: truth as a function of time, and a simulated radar that looks at it.

>>> from wakeline import scenario
>>> turns = scenario.named("example1")
>>> turns.draw(runs=2, seed=1).shape
(2, 250, 2)
"""

from __future__ import annotations

from . import papers
from .disturbance import disturbed
from .maneuvers import random_maneuvers
from .radar import RadarSimulator
from .scenario import AnyTruth, Scenario
from .track_truth import TrackTruth, smoothed
from .truth import Segment, Truth, segments_from_table

__all__ = [
    "AnyTruth",
    "RadarSimulator",
    "Scenario",
    "Segment",
    "TrackTruth",
    "Truth",
    "disturbed",
    "named",
    "names",
    "papers",
    "random_maneuvers",
    "segments_from_table",
    "smoothed",
]


def names() -> list[str]:
    """Names of the papers' scenarios."""
    return list(papers.BY_NAME)


def named(name: str) -> Scenario:
    """A scenario of the papers.

    Parameters
    ----------
    name : str
        One of ``names()``: "imm-scans" and "imm-seconds" are the two readings of paper A,
        "example1" and "example2" those of paper B.

    Raises
    ------
    ValueError
        When there is no scenario of that name.
    """
    if name not in papers.BY_NAME:
        raise ValueError(f"no scenario {name!r}; there are {', '.join(names())}")
    return papers.BY_NAME[name]()
