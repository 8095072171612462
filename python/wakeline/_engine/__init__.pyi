"""The C++ engine of Wakeline."""

from . import association, core, eval, filter, gating, measurement, motion, multimodel, track, video

__all__ = [
    "association",
    "core",
    "eval",
    "filter",
    "gating",
    "measurement",
    "motion",
    "multimodel",
    "track",
    "video",
]
