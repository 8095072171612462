"""Drift of a search object: a cloud of particles from the last known position."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from wakeline import navigation
from wakeline._brief import brief, many
from wakeline._checks import entropy, finite, not_negative, positive, shaped, whole_number

from .environment import Environment

STEP_S = 600.0
_TRIES = 100


@dataclass(frozen=True)
class SearchObject:
    """What is searched for, and how it is known.

    Attributes
    ----------
    kind : str
        One of ``wakeline.navigation.leeway_kinds()``.
    position_m : (2,) array
        Last known position, [north, east], at the time 0.
    position_std_m : float
        Its standard deviation per axis.
    time_std_s : float
        Standard deviation of its time, at which the drift begins.
    jibes_per_h : float
        Rate at which the object changes the side of the wind direction to which it drifts
        (Breivik and Allen 2008: 0.04 an hour).
    wind_std_mps, current_std_mps : float
        Standard deviations per axis of errors of wind and current that last during the drift.
    residual_std_mps, residual_time_s : float
        Standard deviation per axis and correlation time of a drift that wanders (Gauss-Markov).

    Raises
    ------
    ValueError
        When the kind is unknown or a number is out of range.
    """

    kind: str
    position_m: np.ndarray = (0.0, 0.0)
    position_std_m: float = 0.0
    time_std_s: float = 0.0
    jibes_per_h: float = 0.04
    wind_std_mps: float = 1.5
    current_std_mps: float = 0.1
    residual_std_mps: float = 0.05
    residual_time_s: float = 1800.0

    def __post_init__(self) -> None:
        navigation.leeway_lines(self.kind)
        object.__setattr__(self, "position_m", shaped("position_m", self.position_m, 2))
        finite(north_m=float(self.position_m[0]), east_m=float(self.position_m[1]))
        names = ("position_std_m", "time_std_s", "jibes_per_h", "wind_std_mps", "current_std_mps")
        not_negative(**{name: getattr(self, name) for name in (*names, "residual_std_mps")})
        positive(residual_time_s=self.residual_time_s)


@dataclass(frozen=True)
class Cloud:
    """Drifting particles, each a possible object.

    Attributes
    ----------
    time_s : (T,) array
        From the time of the last known position, in even steps.
    position_m : (n, T, 2) array
        [north, east].
    weight : (n,) array
        Probability that the object is this one and not found yet; the sum is 1 before a search.
    ashore : (n,) bool array
        Which have drifted on land, where they stay.
    """

    time_s: np.ndarray
    position_m: np.ndarray
    weight: np.ndarray
    ashore: np.ndarray

    def __len__(self) -> int:
        return len(self.weight)

    def __repr__(self) -> str:
        return brief(self, many(len(self), "particle"), f"{self.time_s[-1] / 3600.0:.1f} h")

    def at(self, time_s: float) -> np.ndarray:
        """Positions (n, 2) at a time."""
        k = int(np.clip(np.searchsorted(self.time_s, time_s) - 1, 0, len(self.time_s) - 2))
        share = (time_s - self.time_s[k]) / (self.time_s[k + 1] - self.time_s[k])
        return (1.0 - share) * self.position_m[:, k] + share * self.position_m[:, k + 1]

    def datum(self, time_s: float) -> np.ndarray:
        """The datum (2,): mean position at a time."""
        return np.average(self.at(time_s), axis=0, weights=self.weight)

    def covariance_m2(self, time_s: float) -> np.ndarray:
        """Covariance (2, 2) of the position at a time."""
        return np.cov(self.at(time_s).T, aweights=self.weight, ddof=0)

    def searched(self, potential: np.ndarray) -> Cloud:
        """The cloud after a search without success, which missed each with exp(-potential).

        Bayes' rule: POC <- POC (1 - POD). The sum of the weights is the probability that the object
        is not found yet.
        """
        return replace(self, weight=self.weight * np.exp(-potential))

    def part(self, rows: slice) -> Cloud:
        """Some of the particles, as a cloud of the same total probability."""
        weight = self.weight[rows]
        scale = self.weight.sum() / weight.sum() if weight.sum() > 0 else 1.0
        return Cloud(self.time_s, self.position_m[rows], scale * weight, self.ashore[rows])


def drift(
    search_object: SearchObject,
    environment: Environment,
    until_s: float,
    *,
    count: int = 5000,
    seed: int = 0,
    step_s: float = STEP_S,
    land: Sequence[np.ndarray] = (),
) -> Cloud:
    """Drift of an object from its last known position.

    The velocity is leeway (Allen, or (12)) in the wind plus current, tide, wind current (14) and a
    residual; each particle has its errors of position, time, leeway, wind and current. It begins to
    the right or the left of the wind direction with the same probability.

    Parameters
    ----------
    search_object : SearchObject
    environment : Environment
    until_s : float
        Duration from the last known time.
    count, seed : int
        Particles, and the seed of their errors.
    step_s : float
        Longest step; the midpoint rule is used.
    land : sequence of (k, 2) arrays
        Corners of areas, [north, east] m. A particle that reaches one stays there.

    Returns
    -------
    Cloud

    Raises
    ------
    ValueError
        When a number is out of range, wind or current are not known at some time, the last known
        position is on land, or the wind current is not defined at the latitude.
    """
    whole_number("count", count, 1)
    positive(until_s=until_s, step_s=step_s)
    environment.require(0.0, until_s)
    o = search_object
    if on_land(o.position_m[None], land)[0]:
        north_m, east_m = o.position_m
        raise ValueError(f"position_m must be at sea, got land at {north_m:.0f} m, {east_m:.0f} m")
    rng = np.random.default_rng(entropy(seed, "search drift"))
    steps = int(np.ceil(until_s / step_s))
    time_s = np.linspace(0.0, until_s, steps + 1)
    h = time_s[1]
    place_m = _at_sea(o, count, rng, land)
    begin_s = o.time_std_s * rng.standard_normal(count)
    leeway_error = rng.standard_normal((count, 2))
    to_right = rng.random(count) < 0.5
    wind_error_mps = o.wind_std_mps * rng.standard_normal((count, 2))
    current_error_mps = o.current_std_mps * rng.standard_normal((count, 2))
    residual_mps = o.residual_std_mps * rng.standard_normal((count, 2))
    kept = np.exp(-h / o.residual_time_s)
    fresh_mps = o.residual_std_mps * np.sqrt(1.0 - kept**2)
    jibing = -np.expm1(-o.jibes_per_h * h / 3600.0)

    track_m = np.empty((count, steps + 1, 2))
    track_m[:, 0] = place_m
    ashore = np.zeros(count, bool)
    velocity_mps = np.zeros((count, 2))
    for k in range(steps):
        middle_s, middle_m = time_s[k] + 0.5 * h, place_m + 0.5 * h * velocity_mps
        wind_mps = environment.wind.at(middle_s, middle_m) + wind_error_mps
        velocity_mps = (
            navigation.leeway_mps(o.kind, wind_mps, error=leeway_error, to_right=to_right)
            + environment.water_mps(middle_s, middle_m, wind_mps)
            + current_error_mps
            + 0.5 * residual_mps
        )
        residual_mps = kept * residual_mps + fresh_mps * rng.standard_normal((count, 2))
        velocity_mps += 0.5 * residual_mps
        # A particle that begins before the first time has drifted like in the first step.
        from_s = begin_s if k == 0 else np.maximum(begin_s, time_s[k])
        moved_m = np.maximum(time_s[k + 1] - from_s, 0.0)[:, None] * velocity_mps
        place_m = _moved(place_m, moved_m, ashore, land)
        to_right ^= rng.random(count) < jibing
        track_m[:, k + 1] = place_m
    return Cloud(time_s, track_m, np.full(count, 1.0 / count), ashore)


def _moved(
    place_m: np.ndarray, moved_m: np.ndarray, ashore: np.ndarray, land: Sequence[np.ndarray]
) -> np.ndarray:
    """Places after a step; who meets land stays at the last place at sea and is `ashore`."""
    next_m = place_m + moved_m
    for share in (0.5, 1.0) if land else ():
        ashore |= on_land(place_m + share * moved_m, land)
    return np.where(ashore[:, None], place_m, next_m)


def _at_sea(
    o: SearchObject, count: int, rng: np.random.Generator, land: Sequence[np.ndarray]
) -> np.ndarray:
    """Last known positions with their errors, drawn again while on land."""
    place_m = o.position_m + o.position_std_m * rng.standard_normal((count, 2))
    for _ in range(_TRIES):
        again = on_land(place_m, land)
        if not again.any():
            break
        place_m[again] = o.position_m + o.position_std_m * rng.standard_normal((again.sum(), 2))
    return place_m


def on_land(position_m: np.ndarray, land: Sequence[np.ndarray]) -> np.ndarray:
    """Which positions (n, 2) are inside one of the polygons (k, 2)."""
    inside = np.zeros(len(position_m), bool)
    north_m, east_m = position_m.T
    for corners_m in land:
        odd = np.zeros(len(position_m), bool)
        for (n1, e1), (n2, e2) in zip(corners_m, np.roll(corners_m, -1, axis=0), strict=True):
            if n1 == n2:
                continue
            crosses = (n1 > north_m) != (n2 > north_m)
            odd ^= crosses & (east_m < e1 + (north_m - n1) / (n2 - n1) * (e2 - e1))
        inside |= odd
    return inside
