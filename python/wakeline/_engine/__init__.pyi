"""The C++ engine of Wakeline."""

from . import (
    association,
    batch,
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
    "batch",
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
