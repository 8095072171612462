"""Own ship from several sources: which one counts, and where the ship was at any time."""

from __future__ import annotations

import bisect
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from wakeline.measurement import OwnShip

from .config import SENTENCES, OwnConfig

_KEPT = 256  # readings of a source
_YAW_RAD_S = math.radians(1.0)  # unknown rate of turn of a ship in waves
_MOST_RATE_RAD_S = math.radians(30.0)
_ACCELERATION_MPS2 = 0.2  # unknown acceleration of own ship
_RATE_SPAN_S = 0.4  # between readings that give a rate
_TAU = 2.0 * math.pi


class SourceKey(NamedTuple):
    """Who gives a quantity: the letters of the sentence, its talker, and the input."""

    sentence: str
    talker: str
    input: str

    def __str__(self) -> str:
        return f"{self.talker}{self.sentence}@{self.input}"

    def fits(self, pattern: str) -> bool:
        """Whether a preference such as ``GGA``, ``GPGGA``, ``GPGGA@NAME`` or ``@NAME`` means it."""
        sentence, _, at = pattern.partition("@")
        return sentence in ("", self.sentence, self.talker + self.sentence) and at in (
            "",
            self.input,
        )


@dataclass
class Source:
    """Readings of one quantity from one source."""

    key: SourceKey
    rank: int
    since_s: float
    count: int = 0
    unusable: str = ""
    time_s: list[float] = field(default_factory=list)
    value: list[tuple[float, ...]] = field(default_factory=list)

    def add(self, time_s: float, value: tuple[float, ...]) -> None:
        """Add a reading; one at the time of the last replaces it, an older one is not used."""
        self.count += 1
        if self.time_s and time_s <= self.time_s[-1]:
            if time_s == self.time_s[-1]:
                self.value[-1] = value
            return
        self.time_s.append(time_s)
        self.value.append(value)
        if len(self.time_s) > _KEPT:
            del self.time_s[: _KEPT // 2], self.value[: _KEPT // 2]

    def age_s(self, time_s: float) -> float:
        """Age of the last reading."""
        return time_s - self.time_s[-1] if self.time_s else math.inf

    def off_s(self, time_s: float) -> float:
        """From a time to the nearest reading, in either direction."""
        if not self.time_s:
            return math.inf
        return min(abs(time_s - self.time_s[k]) for k in self.around(time_s))

    def around(self, time_s: float) -> tuple[int, int]:
        """Index of the readings before and after a time; equal at and beyond the ends."""
        after = bisect.bisect_left(self.time_s, time_s)
        last = len(self.time_s) - 1
        if after > last:
            return last, last
        if after == 0 or self.time_s[after] == time_s:
            return after, after
        return after - 1, after


class Ranked:
    """One quantity: its sources in order of preference, and the one that is used.

    A source that has been silent for longer than `age_s` is replaced at once by the best one that
    has not. A better source than the one used is taken after it has been there for `dwell_s`; in
    the first `dwell_s` of the session at once. Of sources of the same rank the one that came first
    is used.

    Attributes
    ----------
    used : Source or None
    why : str
        Why this source is used.
    """

    def __init__(self, name: str, preferred: Sequence[str], dwell_s: float, age_s: float) -> None:
        self.name, self.sources = name, dict[SourceKey, Source]()
        self.used: Source | None = None
        self.why = "no source yet"
        self._preferred, self._dwell_s, self.oldest_s = tuple(preferred), dwell_s, age_s
        self._begin_s: float | None = None
        self._rejected: dict[SourceKey, tuple[float, str]] = {}

    def add(
        self, time_s: float, key: SourceKey, value: tuple[float, ...], unusable: str = ""
    ) -> None:
        """Add a reading; `unusable` says why it cannot be used."""
        self._rejected.pop(key, None)
        source = self.sources.get(key)
        if source is None:
            source = self.sources[key] = Source(key, self._rank(key), time_s)
        elif source.age_s(time_s) > self.oldest_s:
            source.since_s = time_s
        source.unusable = unusable
        source.add(time_s, value)
        if self._begin_s is None:
            self._begin_s = time_s
        self.choose(time_s)

    def reject(self, time_s: float, key: SourceKey, why: str) -> None:
        """Note that a source has no reading, and why."""
        self._rejected[key] = time_s, why

    def rejection(self, time_s: float) -> tuple[str, float] | None:
        """What the best of the sources that have no reading says, and its age."""
        recent = [
            (self._rank(key), f"{key.talker}{key.sentence}: {why}", time_s - when_s)
            for key, (when_s, why) in self._rejected.items()
            if time_s - when_s <= self.oldest_s
        ]
        return min(recent)[1:] if recent else None

    def choose(self, time_s: float) -> None:
        """Choose the source to be used at a time."""
        used = self.used
        if used is not None and (used.age_s(time_s) > self.oldest_s or used.unusable):
            best = self._best(time_s, 0.0)
            if best is not None and best is not used:
                silent = used.unusable or f"silent for {used.age_s(time_s):.1f} s"
                self.used, self.why = best, f"{used.key} {silent}"
            return
        begins = self._begin_s is None or time_s - self._begin_s <= self._dwell_s
        best = self._best(time_s, 0.0 if begins else self._dwell_s)
        if best is None or best is used:
            return
        if used is None or best.rank < used.rank:
            self.used, self.why = best, self._reason(best, used)

    def _best(self, time_s: float, dwell_s: float) -> Source | None:
        fresh = [
            source
            for source in self.sources.values()
            if source.age_s(time_s) <= self.oldest_s
            and not source.unusable
            and time_s - source.since_s >= dwell_s
        ]
        return min(fresh, key=lambda source: source.rank, default=None)

    def _rank(self, key: SourceKey) -> int:
        for rank, pattern in enumerate(self._preferred):
            if key.fits(pattern):
                return rank
        order = SENTENCES[self.name]
        place = order.index(key.sentence) if key.sentence in order else len(order)
        return len(self._preferred) + place

    def _reason(self, best: Source, used: Source | None) -> str:
        if best.rank < len(self._preferred):
            return f"preferred as {self._preferred[best.rank]}"
        if used is None:
            return "the first source"
        return f"{best.key.sentence} is better than {used.key.sentence}"

    def age_s(self, time_s: float) -> float:
        """Age of the reading used."""
        return math.inf if self.used is None else max(self.used.age_s(time_s), 0.0)

    def fresh(self, time_s: float) -> Source | None:
        """The source used, unless its readings are too far from that time."""
        source = self.used
        if source is None or source.unusable or source.off_s(time_s) > self.oldest_s:
            return None
        return source

    def status(self, time_s: float, shown: Callable[[tuple[float, ...]], Any]) -> dict[str, Any]:
        """Which source is used and why, and what the others say."""
        used, fresh, why = self.used, self.fresh(time_s) is not None, self.why
        rejection = None if fresh else self.rejection(time_s)
        if rejection is not None:
            why = f"{rejection[0]}, {rejection[1]:.1f} s old"
        return {
            "source": None if used is None else str(used.key),
            "why": why,
            "age_s": None if used is None else round(self.age_s(time_s), 3),
            "fresh": fresh,
            "sources": [
                {
                    "source": str(one.key),
                    "count": one.count,
                    "age_s": round(one.age_s(time_s), 3),
                    "value": shown(one.value[-1]),
                    "used": one is used,
                    "why_not": one.unusable or None if one is not used else None,
                }
                for one in sorted(self.sources.values(), key=lambda one: one.rank)
            ],
            "rejected": [
                {"source": str(key), "age_s": round(time_s - when_s, 3), "why": why}
                for key, (when_s, why) in self._rejected.items()
            ],
        }


class Missing(NamedTuple):
    """Why own ship is not known at a time."""

    reason: str


class Pose(NamedTuple):
    """Own ship at a time: its reference point, heading and velocity, with standard deviations.

    `heading_rad` and velocities are NaN where unknown.
    """

    time_s: float
    north_m: float
    east_m: float
    heading_rad: float
    vnorth_mps: float
    veast_mps: float
    position_std_m: float
    heading_std_rad: float
    velocity_std_mps: float

    def antenna(self, forward_m: float, starboard_m: float) -> OwnShip:
        """The place of an antenna aboard."""
        north_m, east_m = _ahead(self.heading_rad, forward_m, starboard_m)
        known = math.isfinite(self.vnorth_mps)
        return OwnShip(
            north_m=self.north_m + north_m,
            east_m=self.east_m + east_m,
            vnorth_mps=self.vnorth_mps if known else 0.0,
            veast_mps=self.veast_mps if known else 0.0,
            position_std_m=self.position_std_m,
            velocity_std_mps=self.velocity_std_mps if known else 0.0,
            heading_std_rad=self.heading_std_rad,
        )


class OwnShipSources:
    """Own ship's position, heading and velocity from ranked sources.

    Readings have the time at which they were received: clocks of instruments may be hours off, and
    sentences may have none. Between readings position and heading are interpolated, after the last
    one predicted with the velocity and the rate of turn, with errors that grow.

    Parameters
    ----------
    config : OwnConfig
    """

    def __init__(self, config: OwnConfig) -> None:
        self.config = config
        self.position, self.heading, self.velocity, self.turn = (
            Ranked(name, preferred, config.dwell_s, age_s)
            for name, preferred, age_s in (
                ("position", config.position, config.position_age_s),
                ("heading", config.heading, config.heading_age_s),
                ("velocity", config.velocity, config.velocity_age_s),
                ("turn", (), config.heading_age_s),
            )
        )
        self.variation_rad = math.radians(config.variation_deg)
        self._fixed: Pose | None = None

    def fix_place(self, north_m: float, east_m: float) -> None:
        """Make it a station that does not move."""
        heading_rad = math.radians(self.config.fixed_heading_deg)
        self._fixed = Pose(0.0, north_m, east_m, heading_rad, *(0.0,) * 5)

    def add_magnetic(self, time_s: float, key: SourceKey, heading_rad: float) -> None:
        """Add a magnetic heading; it counts when the variation is known."""
        unusable = "" if math.isfinite(self.variation_rad) else "magnetic, variation unknown"
        variation_rad = 0.0 if unusable else self.variation_rad
        self.heading.add(time_s, key, ((heading_rad + variation_rad) % _TAU,), unusable)

    def learn_variation(self, variation_rad: float) -> None:
        """Take a variation of a sentence, unless the settings have one."""
        if math.isnan(self.config.variation_deg):
            self.variation_rad = variation_rad

    def choose(self, time_s: float) -> None:
        """Choose the sources to be used at a time."""
        for one in (self.position, self.heading, self.velocity, self.turn):
            one.choose(time_s)

    def ages_s(self, time_s: float) -> list[tuple[str, float, float, str]]:
        """Of position and heading the age, the age at which it is too old, and why it may be.

        The age is NaN where nothing has come.
        """
        if self._fixed is not None:
            return []
        found = []
        for name, one in (("position", self.position), ("heading", self.heading)):
            age_s = math.nan if one.used is None else one.age_s(time_s)
            if one.used is not None and one.used.unusable:
                age_s = math.inf
            why, _ = one.rejection(time_s) or ("no data", 0.0)
            found.append((name, age_s, one.oldest_s, why))
        return found

    def at(self, time_s: float, *, needs_heading: bool = False) -> Pose | Missing:
        """Own ship at a time, or why it is not known."""
        if self._fixed is not None:
            return self._fixed._replace(time_s=time_s)
        heading = self.heading_at(time_s)
        if heading is None and needs_heading:
            return Missing(self._too_old("heading", self.heading, time_s))
        source = self.position.fresh(time_s)
        if source is None:
            return Missing(self._too_old("position", self.position, time_s))
        velocity = self._velocity_at(time_s, source)
        north_m, east_m, std_m = self._position_at(time_s, source, velocity)
        heading_rad, heading_std_rad = (math.nan, 0.0) if heading is None else heading
        config = self.config
        lever = _ahead(heading_rad, config.gnss_forward_m, config.gnss_starboard_m)
        vnorth_mps, veast_mps = velocity or (math.nan, math.nan)
        return Pose(
            time_s,
            north_m - lever[0],
            east_m - lever[1],
            heading_rad,
            vnorth_mps,
            veast_mps,
            std_m,
            heading_std_rad,
            0.2 if velocity else 0.0,
        )

    def last(self, time_s: float) -> Pose | None:
        """Own ship where it was last, with its heading at a time; None if it never was anywhere."""
        source = self.position.used
        if source is None:
            return None
        heading_rad, heading_std_rad = self.heading_at(time_s) or (math.nan, 0.0)
        unknown = math.nan
        return Pose(
            time_s,
            *source.value[-1][:2],
            heading_rad,
            unknown,
            unknown,
            unknown,
            heading_std_rad,
            0.0,
        )

    def heading_at(self, time_s: float) -> tuple[float, float] | None:
        """Heading and its standard deviation; None if unknown."""
        if self._fixed is not None:
            return self._fixed.heading_rad, 0.0
        source = self.heading.fresh(time_s)
        if source is None:
            return None
        std_rad = math.radians(self.config.heading_std_deg)
        before, after = source.around(time_s)
        (h0,), t0 = source.value[before], source.time_s[before]
        if before != after:
            (h1,), t1 = source.value[after], source.time_s[after]
            share = (time_s - t0) / (t1 - t0)
            return (h0 + share * _wrapped(h1 - h0)) % _TAU, std_rad
        since_s = time_s - t0
        if since_s <= 0.0:
            return h0, math.hypot(std_rad, _YAW_RAD_S * since_s)
        rate = self._turn_rate(source, before)
        return (h0 + rate * since_s) % _TAU, math.hypot(std_rad, _YAW_RAD_S * since_s)

    def _turn_rate(self, source: Source, last: int) -> float:
        turn = self.turn.fresh(source.time_s[last])
        if turn is not None:
            return turn.value[-1][0]
        first = last
        while first > 0 and source.time_s[last] - source.time_s[first] < _RATE_SPAN_S:
            first -= 1
        span_s = source.time_s[last] - source.time_s[first]
        if span_s <= 0.0 or span_s > self.config.heading_age_s:
            return 0.0
        rate = _wrapped(source.value[last][0] - source.value[first][0]) / span_s
        return rate if abs(rate) <= _MOST_RATE_RAD_S else 0.0

    def _velocity_at(self, time_s: float, position: Source) -> tuple[float, float] | None:
        source = self.velocity.fresh(time_s)
        if source is not None:
            before, after = source.around(time_s)
            now, then = source.value[before], source.value[after]
            if before == after:
                return now[0], now[1]
            t0, t1 = source.time_s[before], source.time_s[after]
            share = (time_s - t0) / (t1 - t0)
            return tuple(a + share * (b - a) for a, b in zip(now[:2], then[:2], strict=True))
        last = position.around(time_s)[0]  # the latest until then
        first = last
        while first > 0 and position.time_s[last] - position.time_s[first] < 2.0:
            first -= 1
        span_s = position.time_s[last] - position.time_s[first]
        if not 0.9 < span_s <= 2.0 * self.config.position_age_s:
            return None
        return tuple(
            (b - a) / span_s
            for a, b in zip(position.value[first], position.value[last], strict=True)
        )

    def _position_at(
        self, time_s: float, source: Source, velocity: tuple[float, float] | None
    ) -> tuple[float, float, float]:
        std_m = self.config.position_std_m
        before, after = source.around(time_s)
        p0, t0 = source.value[before], source.time_s[before]
        if before != after:
            p1, t1 = source.value[after], source.time_s[after]
            share = (time_s - t0) / (t1 - t0)
            return p0[0] + share * (p1[0] - p0[0]), p0[1] + share * (p1[1] - p0[1]), std_m
        since_s = time_s - t0
        vnorth_mps, veast_mps = velocity or (0.0, 0.0)
        drift_m = 0.5 * _ACCELERATION_MPS2 * since_s**2 if velocity else 5.0 * abs(since_s)
        return (
            p0[0] + vnorth_mps * since_s,
            p0[1] + veast_mps * since_s,
            math.hypot(std_m, drift_m),
        )

    def _too_old(self, name: str, ranked: Ranked, time_s: float) -> str:
        rejection = ranked.rejection(time_s)
        why = f" ({rejection[0]})" if rejection else ""
        if ranked.used is None:
            return f"no {name}{why}"
        return f"{name} {ranked.age_s(time_s):.0f} s old{why}"

    def status(self, time_s: float, to_deg: Callable[[float, float], Any]) -> dict[str, Any]:
        """Of each quantity the source used and why; `to_deg` gives latitude and longitude."""

        def speed(value: tuple[float, ...]) -> dict[str, float]:
            return {
                "speed_mps": round(math.hypot(*value[:2]), 3),
                "course_deg": round(math.degrees(math.atan2(value[1], value[0])) % 360.0, 2),
            }

        def degrees(value: tuple[float, ...]) -> float:
            return round(math.degrees(value[0]), 2)

        return {
            "position": self.position.status(time_s, lambda value: to_deg(*value[:2])),
            "heading": self.heading.status(time_s, degrees),
            "velocity": self.velocity.status(time_s, speed),
        }


def _ahead(heading_rad: float, forward_m: float, starboard_m: float) -> tuple[float, float]:
    """[north, east] of a point aboard; of the reference point itself without a heading."""
    if not math.isfinite(heading_rad) or (forward_m == 0.0 and starboard_m == 0.0):
        return 0.0, 0.0
    cos, sin = math.cos(heading_rad), math.sin(heading_rad)
    return forward_m * cos - starboard_m * sin, forward_m * sin + starboard_m * cos


def _wrapped(angle_rad: float) -> float:
    return (angle_rad + math.pi) % _TAU - math.pi
