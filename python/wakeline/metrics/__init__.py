"""Scores of tracks against truth, and of many runs: errors as curves, consistency, settling.

States are ``[north, vnorth, east, veast]`` in metres and metres per second.
"""

from wakeline._engine.eval import SetDistance, nees, set_distance

from .consistency import (
    NisByMode,
    WindowedNis,
    nis_by_mode,
    share_inside,
    whiteness,
    windowed_nis,
)
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
from .states import Errors, rmse

gospa = set_distance  # by the name that the metric has

__all__ = [
    "EpisodeScore",
    "Errors",
    "NisByMode",
    "Score",
    "SegmentFigures",
    "SetDistance",
    "Summary",
    "TargetScore",
    "WindowedNis",
    "by_segment",
    "detection_delays_scans",
    "gospa",
    "nees",
    "nis_by_mode",
    "right_mode",
    "rmse",
    "rmse_curve",
    "score",
    "set_distance",
    "settling_times_s",
    "share_inside",
    "steady_scans",
    "whiteness",
    "windowed_nis",
]
