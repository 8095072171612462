"""Scores of tracks against truth: coverage, continuity, accuracy, false tracks, OSPA and GOSPA.

States are ``[north, vnorth, east, veast]`` in metres and metres per second.
"""

from .results import EpisodeScore, Score, Summary, TargetScore
from .scoring import score
from .sets import Gospa, gospa, ospa
from .states import Errors, nees, rmse

__all__ = [
    "EpisodeScore",
    "Errors",
    "Gospa",
    "Score",
    "Summary",
    "TargetScore",
    "gospa",
    "nees",
    "ospa",
    "rmse",
    "score",
]
