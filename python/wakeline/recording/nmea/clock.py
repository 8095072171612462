"""The time of every line of a log, from its sentences with a time of day."""

from __future__ import annotations

import itertools
import math

import numpy as np

from .log import NmeaReport

DAY_S = 86400.0

_DOUBTED = 3  # a time that leaps is rejected if one of the next 3 sentences returns
_LEAP_S, _LEAP_STEPS = 10.0, 5.0


class Clock:
    """Times of timed sentences and, between them, of lines.

    **Day.** A time of day differs from the previous one by less than half a day, which continues
    it over midnight. The day is that of the nearest sentence with a date.

    **Leaps.** If a time is before the last one or a leap after it (10 s, or five usual steps where
    these are longer), the next three timed sentences decide. If one of them continues from the
    previous clock, rather than from the time in doubt, that was a late sentence (before the last
    one by up to `reorder_s`) or a wrong time. If none does, there was a gap, or the clock was set
    back. A date is wrong if the previous date returns within three dated sentences, or from
    midnight on if it does not change there, until it changes.

    **Sections.** A section begins where the clock was set back. Within a section times increase:
    late sentences are sorted. A clock set back by about `reorder_s` or less looks like late
    sentences.

    **Lines** between two timed sentences are equally spaced in time. If a gap has fewer lines than
    usual, so that the log itself must have stopped, they have the usual spacing after the previous
    sentence; so do lines before the first and after the last.

    Parameters
    ----------
    line, time_of_day_s, day : array_like (n,)
        Line, time of day, and days since 1970 or NaN, of each timed sentence, in order; n >= 1.
    first_day : float
        Days since 1970 of the first sentence, if none has a date; NaN if unknown, in which case the
        dates of sentences with a wrong time are used.
    reorder_s : float
    report : NmeaReport
        Wrong times and dates are added to it.

    Attributes
    ----------
    time_s : ndarray (n,)
        UTC seconds, NaN for a wrong time; since the midnight before the first if no day is known.
    dated : bool
        Whether a day is known.
    set_back_lines : ndarray of int (k,)
        First line of each section but the first.
    """

    def __init__(self, line, time_of_day_s, day, first_day, reorder_s: float, report: NmeaReport):
        self._line = np.asarray(line, dtype=np.int64)
        clock_s, day = np.asarray(time_of_day_s, dtype=float), np.asarray(day, dtype=float)
        usual_s = _usual_step_s(clock_s)
        self._leap_s = max(_LEAP_S, _LEAP_STEPS * usual_s)
        unrolled_s, wrong, set_back = _unrolled_s(clock_s, usual_s, self._leap_s, reorder_s)
        believed = np.where(wrong, np.nan, day)
        knows_day = math.isfinite(first_day) or bool(np.isfinite(believed).any())
        self.dated = knows_day or bool(np.isfinite(day).any())
        day_offset = _day_offset(unrolled_s, clock_s, believed if knows_day else day, first_day)
        for k in np.flatnonzero(wrong):
            report.add(int(line[k]), "time", "the time leaps, and the next ones do not confirm it")
        off_days = day - day_offset - _midnights(unrolled_s, clock_s)
        for k in np.flatnonzero(~wrong & np.isfinite(day) & (off_days != 0)):
            stale = "the date is that of the day before"
            leaps = "the date leaps, and the next ones do not confirm it"
            report.add(int(line[k]), "date", stale if off_days[k] == -1 else leaps)
        self.time_s = np.where(wrong, np.nan, unrolled_s + DAY_S * day_offset)
        self.set_back_lines = self._set_back_lines(set_back, reorder_s)
        self._anchors = self._all_anchors(report.lines)

    def section(self, line: np.ndarray) -> np.ndarray:
        """Number (m,) of the section of each line (m,)."""
        return np.searchsorted(self.set_back_lines, line, side="right")

    def at_line(self, line: np.ndarray) -> np.ndarray:
        """Times (m,) of lines (m,)."""
        time_s = np.empty(len(line))
        section = self.section(line)
        for number, (anchor_line, anchor_s) in enumerate(self._anchors):
            here = section == number
            time_s[here] = np.interp(line[here], anchor_line, anchor_s)
        return time_s

    def last_timed(self, line: np.ndarray) -> np.ndarray:
        """Times (m,) of the last timed sentence before each line (m,), NaN without one."""
        believed = np.isfinite(self.time_s)
        before = np.searchsorted(self._line[believed], line, side="right") - 1
        return np.where(before < 0, np.nan, self.time_s[believed][before])

    def _set_back_lines(self, set_back: np.ndarray, reorder_s: float) -> np.ndarray:
        lines, latest_s = [], -np.inf
        for line, time_s, known in zip(self._line.tolist(), self.time_s, set_back, strict=True):
            if math.isnan(time_s):
                continue
            if time_s < latest_s - (0.0 if known else reorder_s):
                lines.append(line)
                latest_s = time_s
            latest_s = max(latest_s, time_s)
        return np.array(lines, dtype=np.int64)

    def _all_anchors(self, last_line: int) -> list[tuple[np.ndarray, np.ndarray]]:
        """For each section lines and times to interpolate between."""
        section = self.section(self._line)
        ends = [*self.set_back_lines.tolist(), last_line + 1]
        starts = [1, *self.set_back_lines.tolist()]
        news = [self._new_times(section == number) for number in range(len(ends))]
        steps = [(np.diff(a), np.diff(t)) for a, t in news]
        pace_s = np.concatenate([dt / da for da, dt in steps])
        usual = np.concatenate([dt for _, dt in steps]) <= self._leap_s
        pace_s = float(np.median(pace_s[usual])) if usual.any() else 0.0
        return [
            _extended(line, time_s, start, end - 1, pace_s) if len(line) else self._next(start)
            for (line, time_s), start, end in zip(news, starts, ends, strict=True)
        ]

    def _next(self, line: int) -> tuple[np.ndarray, np.ndarray]:
        """The next time after a line as the only anchor of a section without times."""
        believed = np.isfinite(self.time_s)
        after = np.searchsorted(self._line[believed], line)
        return np.array([float(line)]), self.time_s[believed][[after]]

    def _new_times(self, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lines and times of the sentences that first give a later time."""
        chosen = chosen & np.isfinite(self.time_s)
        if not chosen.any():
            return np.zeros(0), np.zeros(0)
        line, time_s = self._line[chosen], self.time_s[chosen]
        latest_s = np.maximum.accumulate(time_s)
        new = np.append(True, np.diff(latest_s) > 0)
        new[1:] &= np.diff(line) > 0
        return line[new].astype(float), latest_s[new]


def _usual_step_s(clock_s: np.ndarray) -> float:
    """The usual step between times of day (n,), over any number of days, in any order."""
    since_s = np.cumsum(_wrapped(np.diff(clock_s, prepend=clock_s[:1])))
    steps_s = np.diff(np.unique(np.rint(1e3 * since_s))) / 1e3
    return float(np.median(steps_s)) if len(steps_s) else 0.0


def _unrolled_s(
    clock_s: np.ndarray, usual_s: float, leap_s: float, reorder_s: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (n,) from the midnight before the first; masks (n,) of wrong ones and of set backs."""
    unrolled_s = clock_s.copy()
    wrong, set_back = np.zeros((2, len(clock_s)), dtype=bool)
    last_s, doubted = float(clock_s[0]), []
    for k, time_s in enumerate(clock_s.tolist()):
        step_s = _wrapped(time_s - last_s)
        goes_on = 0.0 <= step_s <= leap_s
        unrolled_s[k] = last_s + step_s
        if doubted:
            before_s = float(unrolled_s[doubted[-1]])
            from_doubted_s = _wrapped(time_s - before_s)
            if abs(from_doubted_s - usual_s) < abs(step_s - usual_s):
                goes_on = False
                unrolled_s[k] = before_s + from_doubted_s
        if goes_on:
            off_s = unrolled_s[doubted] - last_s
            wrong[doubted] = (off_s > 0) | (off_s < -reorder_s)
            last_s, doubted = float(unrolled_s[k]), []
        else:
            doubted.append(k)
            if len(doubted) > _DOUBTED:
                set_back[doubted[0]] = unrolled_s[doubted[0]] < last_s
                last_s, doubted = float(unrolled_s[k]), []
    return clock_s + DAY_S * _midnights(unrolled_s, clock_s), wrong, set_back


def _day_offset(
    unrolled_s: np.ndarray, clock_s: np.ndarray, day: np.ndarray, first_day: float
) -> np.ndarray:
    """Days (n,) to add to unrolled times."""
    dated = np.flatnonzero(np.isfinite(day))
    if len(dated) == 0:
        return np.full(len(day), np.nan_to_num(first_day))
    given = _over_midnight((day - _midnights(unrolled_s, clock_s))[dated], day[dated])
    edges = [0, *(np.flatnonzero(np.diff(given) != 0) + 1).tolist(), len(given)]
    for (a, b), (_, c) in itertools.pairwise(itertools.pairwise(edges)):
        if 0 < a and b - a <= _DOUBTED and given[b:c][0] == given[a - 1]:
            given[a:b] = given[a - 1]
    index = np.arange(len(day))
    after = np.minimum(np.searchsorted(dated, index), len(dated) - 1)
    before = np.maximum(np.searchsorted(dated, index, side="right") - 1, 0)
    nearer = np.abs(unrolled_s - unrolled_s[dated[after]]) < np.abs(
        unrolled_s - unrolled_s[dated[before]]
    )
    return given[np.where(nearer, after, before)]


def _over_midnight(given: np.ndarray, day: np.ndarray) -> np.ndarray:
    """Days (n,) to add according to the dates, the previous one where a date (n,) is stale.

    A date that does not change at midnight is stale until it changes.
    """
    given = given.copy()
    changes = np.flatnonzero(np.diff(day) != 0) + 1
    for first in np.flatnonzero((np.diff(given) == -1) & (np.diff(day) == 0)) + 1:
        end = np.append(changes[changes > first], len(given))[0]
        given[first:end] = given[first - 1]
    return given


def _midnights(unrolled_s: np.ndarray, clock_s: np.ndarray) -> np.ndarray:
    """Number (n,) of midnights passed."""
    return np.rint((unrolled_s - clock_s) / DAY_S)


def _extended(
    line: np.ndarray, time_s: np.ndarray, first_line: int, last_line: int, pace_s: float
) -> tuple[np.ndarray, np.ndarray]:
    """Anchors, with one before each gap in which the log stopped, and one at either end."""
    lines, step_s = np.diff(line), np.diff(time_s)
    stopped = np.flatnonzero((lines > 1) & (pace_s * lines < 0.5 * step_s))
    line = np.concatenate(
        [[first_line], np.insert(line, stopped + 1, line[stopped + 1] - 1), [last_line]]
    )
    resumed_s = time_s[stopped] + pace_s * (lines[stopped] - 1)
    time_s = np.insert(time_s, stopped + 1, resumed_s)
    before_s, after_s = pace_s * (line[1] - first_line), pace_s * (last_line - line[-2])
    return line, np.concatenate([[time_s[0] - before_s], time_s, [time_s[-1] + after_s]])


def _wrapped(step_s):
    """A step of the time of day, from minus to plus half a day."""
    return (step_s + DAY_S / 2) % DAY_S - DAY_S / 2
