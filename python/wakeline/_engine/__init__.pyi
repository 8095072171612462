"""The C++ engine of Wakeline."""

from . import (
    association,
    core,
    eval,
    filter,
    gating,
    measurement,
    motion,
    multimodel,
    navigation,
    track,
    video,
)

__all__ = [
    "association",
    "core",
    "eval",
    "filter",
    "gating",
    "measurement",
    "motion",
    "multimodel",
    "navigation",
    "track",
    "video",
]
