"""Scores of tracks against truth, and of many runs: errors as curves, consistency, settling.

States are ``[north, vnorth, east, veast]`` in metres and metres per second.
"""

from .consistency import nees, share_inside, squared_distance
from .curves import (
    SegmentFigures,
    by_segment,
    detection_delays_scans,
    rmse_curve,
    settling_times_s,
    steady_scans,
)
from .modes import right_mode
from .results import EpisodeScore, Score, Summary, TargetScore
from .scoring import score
from .sets import Gospa, gospa, ospa
from .states import Errors, rmse

__all__ = [
    "EpisodeScore",
    "Errors",
    "Gospa",
    "Score",
    "SegmentFigures",
    "Summary",
    "TargetScore",
    "by_segment",
    "detection_delays_scans",
    "gospa",
    "nees",
    "ospa",
    "right_mode",
    "rmse",
    "rmse_curve",
    "score",
    "settling_times_s",
    "share_inside",
    "squared_distance",
    "steady_scans",
]
