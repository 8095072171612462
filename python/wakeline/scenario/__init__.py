"""Scenarios: truth as a function of time, and a simulated radar that observes it.

>>> from wakeline import scenario
>>> turns = scenario.named("example1")
>>> turns.draw(runs=2, seed=1).shape
(2, 250, 2)
"""

from __future__ import annotations

from . import papers
from .disturbance import disturbed
from .hard_turn import HardTurn, HardTurnRuns, hard_turns
from .maneuvers import random_maneuvers
from .radar import RadarSimulator
from .scenario import AnyTruth, Scenario
from .track_truth import TrackTruth, smoothed
from .truth import Segment, Truth, segments_from_table
from .usv_mission import USV_EXAMPLE, Obstacle, UsvLogs, UsvMission, UsvPassage, UsvVoyage
from .video import (
    Land,
    RadarVideoSimulator,
    SeaClutter,
    VideoScene,
    VideoTarget,
    radar_screen,
    small_craft_scene,
    strait_scene,
)
from .voyage import Voyage, VoyageReadings, reckoning_voyage

__all__ = [
    "USV_EXAMPLE",
    "AnyTruth",
    "HardTurn",
    "HardTurnRuns",
    "Land",
    "Obstacle",
    "RadarSimulator",
    "RadarVideoSimulator",
    "Scenario",
    "SeaClutter",
    "Segment",
    "TrackTruth",
    "Truth",
    "UsvLogs",
    "UsvMission",
    "UsvPassage",
    "UsvVoyage",
    "VideoScene",
    "VideoTarget",
    "Voyage",
    "VoyageReadings",
    "disturbed",
    "hard_turns",
    "named",
    "names",
    "papers",
    "radar_screen",
    "random_maneuvers",
    "reckoning_voyage",
    "segments_from_table",
    "small_craft_scene",
    "smoothed",
    "strait_scene",
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
        When no scenario has that name.
    """
    if name not in papers.BY_NAME:
        raise ValueError(f"name must be one of {', '.join(names())}, got {name!r}")
    return papers.BY_NAME[name]()
