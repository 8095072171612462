"""Which clock of a log counts, where its sentences have several."""

from __future__ import annotations

import datetime
import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from wakeline._brief import counted, many

from .beside import DAY_S, Beside

_LEAP_S, _LEAP_STEPS = 10.0, 5.0
_LIVE_CHAINS = 4  # of one address at a time
_AGREEING = 0.8  # least share of the sentences
_ZONE_S = 900.0  # offsets of local times are multiples of it
_LATEST_REPEAT_S = 600.0
_CLEARLY = 0.5
_STAMPS_AGREE_S = 60.0
_STAMPS_STEADY_S = 5.0
_STANDING = 10  # least number of sentences
_MISSING = 3.0  # usual steps that may be missing where a minute repeats
_ROLLOVER_DAYS = 7.0 * 1024.0
_YEAR_DAYS = 365.25
_DAY_0 = datetime.date(1970, 1, 1).toordinal()


@dataclass
class Timed:
    """The sentences of a log that have a time, in order.

    Attributes
    ----------
    line : ndarray of int (n,)
    clock_s : ndarray (n,)
        Times of day.
    day : ndarray (n,)
        Days since 1970; NaN in a sentence without a date.
    address : ndarray of str (n,)
        Talker and kind, such as ``GPRMC``.
    place_deg : ndarray (n, 2)
        Latitude and longitude of valid fixes that are not at 0/0; NaN of others.
    """

    line: np.ndarray
    clock_s: np.ndarray
    day: np.ndarray
    address: np.ndarray
    place_deg: np.ndarray

    @property
    def has_fix(self) -> np.ndarray:
        """Mask (n,) of the sentences with a valid fix that is not at 0/0."""
        return np.isfinite(self.place_deg).all(axis=1)


@dataclass
class Choice:
    """The clock that counts.

    Attributes
    ----------
    used : ndarray of bool (n,)
        The sentences that make the clock.
    kept : ndarray of bool (n,)
        Other sentences whose times are right, or right once corrected.
    clock_s, day : ndarray (n,)
        As of `Timed`, corrected; the day is NaN where another date counts.
    by_stamps : bool
        The times beside the sentences are the clock instead: none of the sentences is used.
    rejected : dict of int to str
        For each other sentence, by its index, why its time is not believed.
    notes : list of str
        The conflicts between clocks.
    """

    used: np.ndarray
    kept: np.ndarray
    clock_s: np.ndarray
    day: np.ndarray
    by_stamps: bool = False
    rejected: dict[int, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)


class ClockStands(ValueError):
    """The only clock of a log stands."""


def choose(timed: Timed, beside: Beside | None, reorder_s: float) -> Choice:
    """Choose the clock of a log.

    **Sources.** A source is an address (talker and kind), or one of several clocks that alternate
    under one address. Two sources agree if at least 80 % of the sentences of the one with fewer
    lie, within `reorder_s`, between the times of the other one around them. Sources that agree are
    one clock.

    **Choice.** Of the clocks that advance the one that carries the voyage counts: it has valid
    fixes away from 0/0 in at least half as many minutes as any other. Among such clocks the first
    of these that differs decides: its position changes; it agrees with times beside the sentences
    that are in UTC; it is that of a satellite receiver (its talker begins with G); it has a date;
    its year is the latest that is not in the future; the number of minutes with fixes, of agreeing
    addresses, of sentences.

    **Other clocks** are reported, with both times.

    - A source that is late by up to ten minutes repeats another one, which counts, if its
      positions are nearer to those of the same time than to those of the lines around them. Its
      fixes are kept, but it does not time other lines.
    - A source that is off by a multiple of 15 minutes, advances and has valid fixes, or is a ZDA,
      is in local time. It is corrected.
    - The readings of a source that stands and has fixes are placed by times beside the sentences,
      or by lines if the chosen clock has no fixes.
    - Any other time is wrong: its sentence is dropped.

    - Times without a fix before the first fix are wrong unless they lead to it.

    A clock without a date that is off stamps in UTC by a multiple of 15 minutes is corrected, too.

    **Dates.** Where sources that agree in time have different dates, the date nearest to those
    beside the sentences counts, else one that is not 1024 weeks before another, else the one of
    most sentences. A date that is 1024 weeks before those beside the sentences is corrected. If
    no sentence has one, the dates beside the sentences count, or those of other clocks.

    **Clocks that stand.** If a minute repeats (08:02:59 is followed by 08:02:00, at least twice) or
    the whole clock stands, the times beside the sentences count. Without these, minutes are
    counted from the seconds.

    Parameters
    ----------
    timed : Timed
        At least one sentence.
    beside : Beside or None
        Times beside the sentences.
    reorder_s : float

    Raises
    ------
    ClockStands
        When the only clock stands and the lines have no times beside their sentences.
    """
    if beside is not None and not beside.advances:
        beside = None
    sources = _sources(timed, reorder_s)
    clocks = _clocks(timed, sources, reorder_s)
    clocks = sorted(clocks, key=lambda clock: _weight(timed, clock, clocks, beside), reverse=True)
    repeated = (c for c in clocks[1:] if _is_late(timed, c[0], clocks[0][0]))
    first = next(repeated, clocks[0])
    clocks = [first, *(clock for clock in clocks if clock is not first)]
    chosen = np.sort(np.concatenate(first))
    count = len(timed.line)
    used, kept = np.zeros((2, count), dtype=bool)
    choice = Choice(used, kept, timed.clock_s.copy(), timed.day.copy())
    choice.used[chosen] = True
    for clock in clocks[1:]:
        for source in clock:
            _judge(timed, chosen, source, beside, reorder_s, choice)
    _leave_out_start(timed, chosen, reorder_s, choice)
    _settle_zone(timed, chosen, beside, choice)
    _settle_dates(timed, clocks, chosen, beside, choice)
    _settle_standing(timed, chosen, beside, choice)
    return choice


def usual_step_s(clock_s: np.ndarray) -> float:
    """The usual step between times of day (n,), over any number of days, in any order."""
    since_s = np.cumsum(wrapped_s(np.diff(clock_s, prepend=clock_s[:1])))
    steps_s = np.diff(np.unique(np.rint(1e3 * since_s))) / 1e3
    return _median(steps_s)


def _median(numbers: np.ndarray) -> float:
    """The median; 0 if there are no numbers, as where no sentence is between those of a source."""
    return float(np.median(numbers)) if len(numbers) else 0.0


def leap_s(usual_s: float) -> float:
    """The longest step that is no leap."""
    return max(_LEAP_S, _LEAP_STEPS * usual_s)


def wrapped_s(step_s):
    """A step of the time of day, from minus to plus half a day."""
    return (step_s + DAY_S / 2) % DAY_S - DAY_S / 2


# ------------------------------------------------------------------ sources


def _sources(timed: Timed, reorder_s: float) -> list[np.ndarray]:
    """Indices of the sentences of each source."""
    sources = []
    for address in dict.fromkeys(timed.address.tolist()):
        of_address = np.flatnonzero(timed.address == address)
        lane = _lanes(timed.clock_s[of_address], reorder_s)
        sources += [of_address[lane == number] for number in np.unique(lane)]
    return sources


def _lanes(clock_s: np.ndarray, reorder_s: float) -> np.ndarray:
    """Number (n,) of the clock among those that alternate.

    A clock that is left and not returned to, such as a wrong time or one before a gap, is part of
    the one with most sentences.
    """
    chain = _chains(clock_s, reorder_s)
    if chain[-1] == 0:
        return chain
    first = np.unique(chain, return_index=True)[1]
    last = len(chain) - 1 - np.unique(chain[::-1], return_index=True)[1]
    ends: list[int] = []
    lane_of = np.empty(len(first), dtype=np.int64)
    for number in np.argsort(first).tolist():
        free = [lane for lane, end in enumerate(ends[-_LIVE_CHAINS:]) if end < first[number]]
        offset = max(len(ends) - _LIVE_CHAINS, 0)
        lane = max(free, key=lambda k: ends[offset + k]) + offset if free else len(ends)
        if lane == len(ends):
            ends.append(-1)
        ends[lane] = int(last[number])
        lane_of[number] = lane
    lane = lane_of[chain]
    visited = lane[np.append(True, np.diff(lane) != 0)]
    visits, size = np.bincount(visited), np.bincount(lane)
    lane[(visits < 2)[lane]] = np.argmax(size)
    return lane


def _chains(clock_s: np.ndarray, reorder_s: float) -> np.ndarray:
    """Number (n,) of the chain of each time; in a chain each time continues the previous one."""
    usual_s = _usual_of_alternating_s(clock_s)
    longest_s = leap_s(usual_s)
    steps_s = wrapped_s(np.diff(clock_s))
    chain = np.zeros(len(clock_s), dtype=np.int64)
    if ((steps_s >= -reorder_s) & (steps_s <= longest_s)).all():
        return chain
    live: list[tuple[float, int]] = []
    count = 0
    for k, time_s in enumerate(clock_s.tolist()):
        off = [
            (abs(step_s - usual_s), place)
            for place, (last_s, _) in enumerate(live)
            if -reorder_s <= (step_s := wrapped_s(time_s - last_s)) <= longest_s
        ]
        if off:
            chain[k] = live.pop(min(off)[1])[1]
        else:
            chain[k], count = count, count + 1
        live = [(time_s, int(chain[k])), *live[: _LIVE_CHAINS - 1]]
    return chain


def _usual_of_alternating_s(clock_s: np.ndarray) -> float:
    """The usual step of a clock among those that alternate."""
    steps_s = np.diff(np.unique(clock_s))
    medians_s = [float(np.median(steps_s))] if len(steps_s) else []
    for apart in range(1, _LIVE_CHAINS + 1):
        steps_s = np.abs(wrapped_s(clock_s[apart:] - clock_s[:-apart]))
        medians_s += [float(np.median(steps_s[steps_s > 0]))] if steps_s.any() else []
    return min(medians_s, default=0.0)


def _clocks(timed: Timed, sources: list[np.ndarray], reorder_s: float) -> list[list[np.ndarray]]:
    """The sources, those that agree together; the leading one of each clock first."""
    ordered = sorted(sources, key=lambda s: (_minutes(timed, s), len(s)), reverse=True)
    clocks: list[list[np.ndarray]] = []
    for source in ordered:
        agreeing = (c for c in clocks if _agree(timed, c[0], source, reorder_s))
        clock = next(agreeing, None)
        if clock is None:
            clocks.append([source])
        else:
            clock.append(source)
    return clocks


def _agree(timed: Timed, a: np.ndarray, b: np.ndarray, reorder_s: float) -> bool:
    off_s = _offsets_s(timed, a, b)
    return len(off_s) == 0 or bool(np.mean(np.abs(off_s) <= reorder_s) >= _AGREEING)


def _offsets_s(timed: Timed, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Times (k,) by which `b` is ahead of `a`, at sentences of the one with fewer of them."""
    if len(b) > len(a):
        return -_offsets_s(timed, b, a)
    off_s = _off_s(timed, a, b)
    if np.isnan(off_s).all():
        off_s = -_off_s(timed, b, a)
    return off_s[np.isfinite(off_s)]


def _off_s(timed: Timed, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Distances (n,) in time of sentences `b` from the interval between those of `a` around them.

    NaN before the first and after the last of `a`.
    """
    after = np.searchsorted(a, b)
    inside = (after > 0) & (after < len(a))
    before_s = timed.clock_s[a[np.maximum(after - 1, 0)]]
    after_s = timed.clock_s[a[np.minimum(after, len(a) - 1)]]
    from_before_s = wrapped_s(timed.clock_s[b] - before_s)
    from_after_s = wrapped_s(timed.clock_s[b] - after_s)
    nearer = np.abs(from_before_s) < np.abs(from_after_s)
    off_s = np.where(nearer, from_before_s, from_after_s)
    off_s[(from_before_s >= 0) & (from_before_s <= wrapped_s(after_s - before_s))] = 0.0
    return np.where(inside, off_s, np.nan)


# ------------------------------------------------------------------ the choice


def _minutes(timed: Timed, chosen: np.ndarray) -> int:
    """Number of minutes with a valid fix."""
    return len(np.unique(timed.clock_s[chosen[timed.has_fix[chosen]]] // 60.0))


def _weight(
    timed: Timed, clock: list[np.ndarray], clocks: list[list[np.ndarray]], beside: Beside | None
) -> tuple[float, ...]:
    chosen = np.concatenate(clock)
    minutes = _minutes(timed, chosen)
    most = max(_minutes(timed, np.concatenate(other)) for other in clocks)
    day = timed.day[chosen]
    day = day[np.isfinite(day)]
    year = float(np.median(day)) // _YEAR_DAYS if len(day) else -1.0
    return (
        len(chosen) == 1 or len(np.unique(timed.clock_s[chosen])) > 1,
        minutes > 0 and 2 * minutes >= most,
        _place_changes(timed, chosen),
        beside is not None and beside.utc and _follows(timed, chosen, beside),
        bool(np.char.startswith(timed.address[chosen].astype(str), "G").any()),
        len(day) > 0,
        year if year <= (_today() + 1.0) // _YEAR_DAYS else -1.0,
        minutes,
        len(np.unique(timed.address[chosen])),
        len(chosen),
    )


def _follows(timed: Timed, chosen: np.ndarray, beside: Beside) -> bool:
    """Whether times of day agree with those beside the sentences."""
    off_s = np.abs(wrapped_s(timed.clock_s[chosen] - beside.at(timed.line[chosen])))
    off_s = off_s[np.isfinite(off_s)]
    return len(off_s) > 0 and bool(np.median(off_s) <= _STAMPS_AGREE_S)


def _today() -> float:
    return float(datetime.date.today().toordinal() - _DAY_0)


# ------------------------------------------------------------------ other clocks


def _judge(
    timed: Timed,
    chosen: np.ndarray,
    source: np.ndarray,
    beside: Beside | None,
    reorder_s: float,
    choice: Choice,
) -> None:
    """Keep, correct or reject a source that does not agree with the chosen clock."""
    off_s = _offsets_s(timed, chosen, source)
    usual_s = _median(off_s)
    zone_s = _ZONE_S * np.rint(usual_s / _ZONE_S)
    name = timed.address[source[0]]
    alive = len(np.unique(timed.clock_s[source])) > 1 and (
        name.endswith("ZDA") or timed.has_fix[source].any()
    )
    steady = len(off_s) > 0 and np.mean(np.abs(off_s - zone_s) <= max(reorder_s, 1.0)) >= _AGREEING
    used = chosen[_nearest(timed.line[chosen], timed.line[source])]
    both = (
        f"{_moment(timed, source[0])} in line {timed.line[source[0]]}, where "
        f"{timed.address[used[0]]} has {_moment(timed, used[0])}"
    )
    untimed = beside is not None or not timed.has_fix[chosen].any()
    if not alive and untimed and _place_changes(timed, source):
        choice.notes.append(f"the clock of {name} stands ({both}): its times are not used")
    elif _is_late(timed, chosen, source):
        choice.kept[source] = True
        choice.notes.append(
            f"{name} repeats fixes of {timed.address[used[0]]} {-usual_s:.3g} s late "
            f"({both}): it does not time other lines"
        )
    elif alive and steady and zone_s:
        choice.kept[source] = True
        choice.clock_s[source] = (timed.clock_s[source] - zone_s) % DAY_S
        days = (timed.clock_s[source] - zone_s) // DAY_S
        choice.day[source] = timed.day[source] + days
        choice.notes.append(
            f"{name} is {_hours(zone_s)} off another clock, as local time is ({both}): corrected"
        )
    else:
        for k, other in zip(source.tolist(), used.tolist(), strict=True):
            choice.rejected[k] = (
                f"wanted about {_clock(timed.clock_s[other])} as in {timed.address[other]}, "
                f"got {_clock(timed.clock_s[k])}"
            )
        choice.notes.append(
            f"two clocks: {name} has {both}: the latter counts, and "
            + counted(len(source), "[time|times] of the former [is|are] left out")
        )


def _leave_out_start(timed: Timed, chosen: np.ndarray, reorder_s: float, choice: Choice) -> None:
    """Reject times before the first fix that do not lead to it: those of a receiver without one."""
    fixed = np.flatnonzero(timed.has_fix[chosen])
    start = chosen[: fixed[0]] if len(fixed) else chosen[:0]
    start = start[~np.char.endswith(timed.address[start].astype(str), "ZDA")]
    if len(start) == 0:
        return
    first = chosen[fixed[0]]
    step_s = wrapped_s(timed.clock_s[first] - timed.clock_s[start[-1]])
    days = timed.day[first] - timed.day[start[-1]]
    if -reorder_s <= step_s <= leap_s(usual_step_s(timed.clock_s[chosen])) and not abs(days) > 1.0:
        return
    choice.used[start] = False
    for k in start.tolist():
        choice.rejected[k] = (
            f"wanted a time that leads to {_moment(timed, first)} of the first fix in line "
            f"{timed.line[first]}, got {_moment(timed, k)}"
        )


def _settle_zone(timed: Timed, chosen: np.ndarray, beside: Beside | None, choice: Choice) -> None:
    """Correct a clock without a date that is in local time by stamps in UTC."""
    if beside is None or not beside.utc or np.isfinite(timed.day[chosen]).any():
        return
    off_s = _known(wrapped_s(timed.clock_s[chosen] - beside.at(timed.line[chosen])))
    zone_s = _ZONE_S * np.rint(np.median(off_s) / _ZONE_S)
    if zone_s and abs(np.median(off_s) - zone_s) <= _STAMPS_STEADY_S:
        choice.clock_s = (choice.clock_s - zone_s) % DAY_S
        choice.notes.append(
            f"{timed.address[chosen[0]]} is {_hours(zone_s)} off {beside.what}, as local time is "
            f"({_clock(timed.clock_s[chosen[0]])} in line {timed.line[chosen[0]]}): corrected"
        )


def _is_late(timed: Timed, chosen: np.ndarray, source: np.ndarray) -> bool:
    """Whether a source repeats others some seconds or minutes later."""
    usual_s = _median(_offsets_s(timed, chosen, source))
    return -_LATEST_REPEAT_S < usual_s < 0.0 and _repeats(timed, chosen, source)


def _repeats(timed: Timed, chosen: np.ndarray, source: np.ndarray) -> bool:
    """Whether most fixes of a source have the place of an earlier line at the same time.

    It is at most half as far, in the median, as the place of the fix next to it in the log.
    """
    mine, its = (k[timed.has_fix[k]] for k in (source, chosen))
    earlier = dict(zip(_milliseconds(timed, its[::-1]), its[::-1].tolist(), strict=True))
    first = map(earlier.get, _milliseconds(timed, mine))
    pairs = [
        (k, other)
        for k, other in zip(mine.tolist(), first, strict=True)
        if other is not None and other < k
    ]
    if not 2 * len(pairs) > len(mine):
        return False
    again, first = np.array(pairs).T
    beside = its[_nearest(timed.line[its], timed.line[again])]
    off_deg = [
        np.abs(timed.place_deg[k] - timed.place_deg[again]).max(axis=1) for k in (first, beside)
    ]
    same_time_deg, same_line_deg = np.median(off_deg, axis=1)
    return bool(same_time_deg < _CLEARLY * same_line_deg)


def _milliseconds(timed: Timed, chosen: np.ndarray) -> list[int]:
    return np.rint(1e3 * timed.clock_s[chosen]).astype(np.int64).tolist()


# ------------------------------------------------------------------ dates


def _settle_dates(
    timed: Timed,
    clocks: list[list[np.ndarray]],
    chosen: np.ndarray,
    beside: Beside | None,
    choice: Choice,
) -> None:
    """Leave one date to the chosen clock, and borrow one where it has none."""
    dated = [[s[np.isfinite(timed.day[s])] for s in clock] for clock in clocks]
    sources = [s for s in dated[0] if len(s)]
    if not sources:
        if beside is not None and beside.dated:
            days = (beside.at(timed.line[chosen]) - choice.clock_s[chosen]) / DAY_S
            choice.day[chosen] = np.rint(days)
            choice.notes.append(f"no sentence has a date that counts: {beside.what} have it")
            return
        for source in (s for clock in dated[1:] for s in clock if len(s)):
            user = chosen[_nearest(timed.line[chosen], timed.line[source])]
            utc_s = DAY_S * choice.day[source] + choice.clock_s[source]
            choice.day[user] = np.rint((utc_s - timed.clock_s[user]) / DAY_S)
            return
        return

    def weight(source: np.ndarray) -> tuple[bool, bool, int]:
        off = [_days_off(timed, source, other) for other in sources]
        follows = abs(_days_off_stamps(timed, source, beside)) <= 1.5
        return follows, _ROLLOVER_DAYS not in off, len(source)

    best = max(sources, key=weight)
    for source in sources:
        off_days = _days_off(timed, best, source)
        if off_days:
            choice.day[source] = np.nan
            early = "1024 weeks early, " if off_days == -_ROLLOVER_DAYS else ""
            choice.notes.append(
                f"two dates: {timed.address[source[0]]} has {_date(timed.day[source[0]])} "
                f"({early}line {timed.line[source[0]]}), {timed.address[best[0]]} has "
                f"{_date(timed.day[best[0]])}, which counts"
            )
    off_days = _days_off_stamps(timed, best, beside)
    rollovers = -np.rint(off_days / _ROLLOVER_DAYS)
    if rollovers > 0 and abs(off_days + rollovers * _ROLLOVER_DAYS) < 2:
        choice.day += rollovers * _ROLLOVER_DAYS
        choice.notes.append(
            f"the dates of {timed.address[best[0]]} are {rollovers * 1024:.0f} weeks before "
            f"{beside.what} ({_date(timed.day[best[0]])}) and are corrected: the receiver missed a "
            "rollover of GPS weeks"
        )


def date_notes(day: float, moved_days: float) -> Iterator[str]:
    """Notes on the date of a log that was moved, or may be 1024 weeks early."""
    if moved_days:
        instead = f"instead of {_date(day - moved_days)} in the log"
        yield f"the date given, {_date(day)}, is used {instead}"
    elif day + _ROLLOVER_DAYS <= _today():
        yield (
            f"the log begins on {_date(day)}, which a receiver that missed a rollover of GPS weeks "
            f"gives for {_date(day + _ROLLOVER_DAYS)} (1024 weeks early): if so, give the date "
            "(--date)"
        )


def _days_off(timed: Timed, a: np.ndarray, b: np.ndarray) -> float:
    """Whole days from the dates of source `a` to those of `b`."""
    other = a[_nearest(timed.line[a], timed.line[b])]
    days = timed.day[b] - timed.day[other]
    return float(np.median(np.rint(days + (timed.clock_s[b] - timed.clock_s[other]) / DAY_S)))


def _days_off_stamps(timed: Timed, source: np.ndarray, beside: Beside | None) -> float:
    """Days from the times beside the sentences to those of a source, NaN where unknown."""
    if beside is None or not beside.dated:
        return math.nan
    off_s = DAY_S * timed.day[source] + timed.clock_s[source] - beside.at(timed.line[source])
    off_s = off_s[np.isfinite(off_s)]
    return float(np.median(off_s)) / DAY_S if len(off_s) else math.nan


def _nearest(line: np.ndarray, to: np.ndarray) -> np.ndarray:
    """Index (m,) of the nearest of sorted lines (n,) to each of others (m,)."""
    after = np.searchsorted(line, to)
    below, above = np.maximum(after - 1, 0), np.minimum(after, len(line) - 1)
    return np.where(np.abs(line[below] - to) < np.abs(line[above] - to), below, above)


# ------------------------------------------------------------------ clocks that stand


def _settle_standing(
    timed: Timed, chosen: np.ndarray, beside: Beside | None, choice: Choice
) -> None:
    clock_s, name = timed.clock_s[chosen], timed.address[chosen[0]]
    stands = len(np.unique(clock_s)) == 1
    cycles = np.zeros(len(chosen)) if stands else _cycles_of_minute(clock_s)
    if stands:
        what = (
            f"the clock of {name} stands at {_clock(clock_s[0])} "
            f"(line {timed.line[chosen[0]]} to {timed.line[chosen[-1]]})"
        )
        if beside is not None and np.ptp(_known(beside.at(timed.line[chosen]))) > _LEAP_S:
            _use_stamps(choice, f"{what}: {beside.what} count instead")
        elif len(chosen) >= _STANDING and _place_changes(timed, chosen):
            raise ClockStands(what)
    elif cycles.any():
        first = int(np.argmax(cycles > 0))
        what = (
            f"the minute of {name} stands: {_clock(clock_s[first])[:5]} repeats "
            f"{many(int(cycles.max()), 'time')} (first in line {timed.line[chosen[first]]}), so "
            "that its clock cannot be used"
        )
        if beside is not None:
            _use_stamps(choice, f"{what}: {beside.what} count instead")
        else:
            choice.clock_s[chosen] = (clock_s + 60.0 * cycles) % DAY_S
            choice.notes.append(f"{what} as it is: minutes are counted from its seconds")
    else:
        _leave_standing(timed, chosen, beside, choice)


def _use_stamps(choice: Choice, note: str) -> None:
    choice.used[:], choice.kept[:], choice.by_stamps = False, False, True
    choice.rejected, choice.notes = {}, [note]


def _cycles_of_minute(clock_s: np.ndarray) -> np.ndarray:
    """Repetitions (n,) of the minute since it last changed; zeros unless one repeats twice."""
    same = np.append(False, np.diff(clock_s // 60.0) == 0)
    step_s = np.diff(clock_s, prepend=clock_s[:1])
    usual_s = float(np.median(np.abs(step_s[step_s != 0.0])))
    turns_over = same & (np.abs(np.abs(step_s) + usual_s - 60.0) <= _MISSING * usual_s)
    turns = np.cumsum(np.where(turns_over, -np.sign(step_s), 0.0))
    at_change = np.maximum.accumulate(np.where(same, 0, np.arange(len(clock_s))))
    cycles = turns - turns[at_change]
    return cycles if cycles.max() >= 2.0 else np.zeros(len(clock_s))


def _leave_standing(
    timed: Timed, chosen: np.ndarray, beside: Beside | None, choice: Choice
) -> None:
    """Where the clock stands for a while use the times beside the sentences, and say so."""
    starts = np.flatnonzero(np.append(True, np.diff(timed.clock_s[chosen]) != 0))
    ends = np.append(starts[1:], len(chosen))
    long = ends - starts >= _STANDING * max(1.0, float(np.median(ends - starts)))
    for start, end in zip(starts[long], ends[long], strict=True):
        run = chosen[start:end]
        if not _place_changes(timed, run):
            continue
        what = (
            f"the clock of {timed.address[run[0]]} stands at {_clock(timed.clock_s[run[0]])} "
            f"(line {timed.line[run[0]]} to {timed.line[run[-1]]})"
        )
        if beside is not None and np.ptp(_known(beside.at(timed.line[run]))) > _LEAP_S:
            choice.used[run[1:]] = False
            what = f"{what}: {beside.what} count there"
        choice.notes.append(what)


def _known(values: np.ndarray) -> np.ndarray:
    """The values that are not NaN, or zero."""
    known = values[np.isfinite(values)]
    return known if len(known) else np.zeros(1)


def _place_changes(timed: Timed, chosen: np.ndarray) -> bool:
    places = timed.place_deg[chosen[timed.has_fix[chosen]]]
    return len(places) > 0 and bool(np.ptp(places, axis=0).any())


# ------------------------------------------------------------------ words


def _moment(timed: Timed, k: int) -> str:
    clock = _clock(timed.clock_s[k])
    return f"{_date(timed.day[k])} {clock}" if math.isfinite(timed.day[k]) else clock


def _clock(time_of_day_s: float) -> str:
    second = int(time_of_day_s) % int(DAY_S)
    return f"{second // 3600:02d}:{second // 60 % 60:02d}:{second % 60:02d}"


def _date(day: float) -> str:
    return datetime.date.fromordinal(int(day) + _DAY_0).isoformat()


def _hours(offset_s: float) -> str:
    minutes = round(offset_s / 60.0)
    return f"{'-' if minutes < 0 else '+'}{abs(minutes) // 60:02d}:{abs(minutes) % 60:02d} h"
