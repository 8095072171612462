"""The time of a scenario in intervals of constant turn rate and control."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from wakeline.scenario import Scenario


@dataclass(frozen=True)
class Piece:
    """An interval of constant turn rate and control.

    Attributes
    ----------
    turn_rate_rad_s, dt_s : float
    scan : int or None
        Index of the plot at its end; None if it ends at a switch between two plots.
    control_mps2 : (float, float)
        Known acceleration north and east.
    """

    turn_rate_rad_s: float
    dt_s: float
    scan: int | None
    control_mps2: tuple[float, float]


def pieces(scenario: Scenario) -> list[Piece]:
    """The time from the start to the last plot, split at every plot and every switch."""
    time_s = scenario.time_s
    switch_s = np.union1d(scenario.switch_times_s, scenario.control_switch_times_s)
    cuts_s = np.union1d(time_s, switch_s)
    begins_s = np.concatenate([[scenario.start_time_s], cuts_s[:-1]])
    middles_s = 0.5 * (begins_s + cuts_s)
    rates, controls = scenario.truth.turn_rate_at(middles_s), scenario.control_at(middles_s)
    scan_at = {t: k for k, t in enumerate(time_s.tolist())}
    return [
        Piece(float(rate), float(end - begin), scan_at.get(float(end)), tuple(control))
        for rate, control, begin, end in zip(rates, controls, begins_s, cuts_s, strict=True)
    ]


def stretches(scenario: Scenario) -> list[tuple[float, list[Piece]]]:
    """The intervals in consecutive groups of the same turn rate."""
    groups = itertools.groupby(pieces(scenario), key=lambda piece: piece.turn_rate_rad_s)
    return [(rate, list(group)) for rate, group in groups]
