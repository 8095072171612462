"""Vessels of an AIS recording while under way, common to the studies of them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from wakeline.recording import AisTrack

LEAST_SPEED_MPS, MAX_GAP_S = 2.0, 25.0


def stretches(track: AisTrack) -> Iterator[AisTrack]:
    """The parts of a track, of two reports or more, in which the vessel makes way and is heard.

    It makes more than 2 m/s with a reported course, without a gap over 25 s.
    """
    for gapless in track.parts(MAX_GAP_S):
        moving = (gapless.speed_mps > LEAST_SPEED_MPS) & np.isfinite(gapless.course_rad)
        rows = np.flatnonzero(moving)
        for part in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1):
            if len(part) > 1:
                yield gapless.rows(part)
