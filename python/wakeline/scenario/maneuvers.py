"""Random maneuvers: vessels that run straight and turn, at rates and times on no grid."""

from __future__ import annotations

import numpy as np

from wakeline._checks import whole_number

from .papers import RADAR
from .scenario import Scenario
from .truth import Segment, Truth


def random_maneuvers(
    count: int = 24,
    seed: int = 0,
    *,
    turn_rate_deg_s: tuple[float, float] = (0.7, 4.0),
    speed_mps: tuple[float, float] = (5.0, 15.0),
    duration_s: tuple[float, float] = (15.0, 120.0),
    range_m: tuple[float, float] = (500.0, 3000.0),
    total_s: float = 750.0,
) -> list[Scenario]:
    """Scenarios of vessels that alternate between straights and turns, under the papers' radar.

    Each starts at a random place and course, goes straight, then turns and goes straight by turns
    until the time is up. Everything is uniform in its interval; a turn goes to either side alike.
    Segments end when they end: a switch falls between scans, not on one.

    Parameters
    ----------
    count : int
        How many.
    seed : int
        Scenario k is the same whatever `count` is.
    turn_rate_deg_s, speed_mps, duration_s, range_m : (float, float)
        Least and largest turn rate (either side), speed, duration of a straight or a turn, and
        distance from the radar at the start.
    total_s : float
        Length of a scenario.

    Returns
    -------
    list of Scenario
        Named "random-<seed>-<k>", k from 0.

    Raises
    ------
    ValueError
        When the count is below 1, the seed below 0, an interval is no pair, empty or not finite, or
        a duration is not positive.
    """
    whole_number("count", count, 1)
    whole_number("seed", seed, 0)
    intervals = {
        "turn_rate_deg_s": turn_rate_deg_s,
        "speed_mps": speed_mps,
        "duration_s": duration_s,
        "range_m": range_m,
    }
    for name, interval in intervals.items():
        if np.shape(interval) != (2,) or not 0 <= interval[0] <= interval[1] < np.inf:
            raise ValueError(
                f"{name} must be an interval from 0 up, least and largest, got {interval}"
            )
    if not duration_s[0] > 0 or not RADAR.period_s <= total_s < np.inf:
        raise ValueError(
            f"duration_s must be positive and total_s hold a scan, got {duration_s}, {total_s}"
        )
    return [
        Scenario(
            f"random-{seed}-{k}",
            _wanderer(np.random.default_rng([seed, k]), intervals, total_s),
            RADAR,
            int(total_s // RADAR.period_s),
        )
        for k in range(count)
    ]


def _wanderer(
    rng: np.random.Generator, intervals: dict[str, tuple[float, float]], total_s: float
) -> Truth:
    range_m, speed_mps = rng.uniform(*intervals["range_m"]), rng.uniform(*intervals["speed_mps"])
    place = range_m * np.exp(1j * rng.uniform(-np.pi, np.pi))
    velocity = speed_mps * np.exp(1j * rng.uniform(-np.pi, np.pi))
    segments: list[Segment] = []
    left_s = total_s
    while left_s > 0:
        duration_s = min(float(rng.uniform(*intervals["duration_s"])), left_s)
        rate_deg_s = rng.choice([-1.0, 1.0]) * rng.uniform(*intervals["turn_rate_deg_s"])
        turning = len(segments) % 2 == 1
        segments.append(Segment(duration_s, float(np.deg2rad(rate_deg_s)) if turning else 0.0))
        left_s -= duration_s
    return Truth([place.real, velocity.real, place.imag, velocity.imag], segments)
