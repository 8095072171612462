"""Random maneuvers: vessels that go straight and turn, at continuous rates and times."""

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

    Each vessel starts at a random position and course, goes straight, then alternates between turns
    and straights until the time is up. All values are uniform in their intervals; both sides of a
    turn are equally likely. A switch is in general between scans, not at one.

    Parameters
    ----------
    count : int
        Number of scenarios.
    seed : int
        Scenario k does not depend on `count`.
    turn_rate_deg_s, speed_mps, duration_s, range_m : (float, float)
        Minimum and maximum of the turn rate (either side), the speed, the duration of a straight or
        a turn, and the distance from the radar at the start.
    total_s : float
        Length of a scenario.

    Returns
    -------
    list of Scenario
        Named "random-<seed>-<k>", k from 0.

    Raises
    ------
    ValueError
        When the count is below 1, the seed below 0, an interval is not a pair, empty or not
        finite, or a duration is not positive.
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
                f"{name} must be a minimum and a maximum, both at least 0, got {interval}"
            )
    if not duration_s[0] > 0 or not RADAR.period_s <= total_s < np.inf:
        raise ValueError(
            f"duration_s must be positive and total_s at least a scan, got {duration_s}, {total_s}"
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
