"""The time of every line of a log, from its sentences with a time of day."""

from __future__ import annotations

import itertools
import math

import numpy as np

from .beside import DAY_S, Beside
from .log import NmeaReport
from .sources import leap_s, usual_step_s, wrapped_s

_DOUBTED = 3  # a time that leaps is rejected if one of the next 3 sentences returns


class Clock:
    """Times of timed sentences and, between them, of lines.

    **Day.** A time of day differs from the previous one by less than half a day, which continues
    it over midnight. The day is that of the nearest sentence with a date.

    **Leaps.** A time before the last one by up to `reorder_s` is late. If a time is farther before
    it, or a leap after it (10 s, or five usual steps where these are longer), the next three timed
    sentences decide. If one of them continues from the previous clock, rather than from the time in
    doubt, that was a wrong time; so it was if the log ends before three others, unless it is a leap
    ahead. If none does, there was a gap, or the clock was set back; up to three times before the
    first of these are wrong. A date is wrong if the previous date returns within three dated
    sentences, or from midnight on if it does not change there, until it changes.

    **Sections.** A section begins where the clock was set back. Within a section times increase:
    late sentences are sorted. A clock set back by about `reorder_s` or less looks like late
    sentences.

    **Lines** between two timed sentences are equally spaced in time, or as the times beside them
    are where these advance as the clock does, to within `reorder_s`. If a gap has fewer lines than
    usual, so that the log itself must have stopped, they have the usual spacing after the previous
    sentence; so do lines before the first and after the last.

    Parameters
    ----------
    line, time_of_day_s, day : array_like (n,)
        Line, time of day, and days since 1970 or NaN, of each timed sentence, in order; n >= 1.
    first_day : float
        Days since 1970 of the first sentence, whatever its date; NaN for the dates of sentences, or
        if none of those with a right time has one, of those with a wrong time.
    reorder_s : float
    report : NmeaReport
        Wrong times and dates are added to it.
    beside : Beside, optional
        Times beside the sentences.

    Attributes
    ----------
    time_s : ndarray (n,)
        UTC seconds, NaN for a wrong time; since the midnight before the first if no day is known.
    dated : bool
        Whether a day is known.
    first_day : float
        Days since 1970 of the first right time; 0 if unknown.
    moved_days : float
        Days from the date of the log to the one given.
    set_back_lines : ndarray of int (k,)
        First line of each section but the first.
    """

    def __init__(
        self,
        line,
        time_of_day_s,
        day,
        first_day: float,
        reorder_s: float,
        report: NmeaReport,
        beside: Beside | None = None,
    ) -> None:
        self._line = np.asarray(line, dtype=np.int64)
        clock_s, day = np.asarray(time_of_day_s, dtype=float), np.asarray(day, dtype=float)
        usual_s = usual_step_s(clock_s)
        self._leap_s = leap_s(usual_s)
        self._beside, self._reorder_s = beside, reorder_s
        unrolled_s, wrong, set_back = _unrolled_s(clock_s, day, usual_s, self._leap_s, reorder_s)
        believed = np.where(wrong, np.nan, day)
        knows_day = bool(np.isfinite(believed).any())
        self.dated = bool(math.isfinite(first_day) or np.isfinite(day).any())
        day_offset = _day_offset(unrolled_s, clock_s, believed if knows_day else day)
        self.first_day = float(day_offset[np.argmin(wrong)])
        self.moved_days = 0.0
        if math.isfinite(first_day):
            moved_days = first_day - self.first_day
            day_offset, day = day_offset + moved_days, day + moved_days
            self.moved_days = moved_days if np.isfinite(day).any() else 0.0
            self.first_day = first_day
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
        order = np.argsort(line, kind="stable")
        line = line[order]
        edges = [0, *np.searchsorted(line, self.set_back_lines).tolist(), len(line)]
        time_s = np.empty(len(line))
        for number, (start, end) in enumerate(itertools.pairwise(edges)):
            here = line[start:end]
            time_s[start:end] = np.interp(here, *self._anchors[number])
            if self._beside is not None:
                stamped_s = self._by_stamps(here, *self._news[number])
                time_s[start:end] = np.where(np.isnan(stamped_s), time_s[start:end], stamped_s)
        in_order = np.empty(len(line))
        in_order[order] = time_s
        return in_order

    def _by_stamps(
        self, line: np.ndarray, anchor_line: np.ndarray, anchor_s: np.ndarray
    ) -> np.ndarray:
        """Times (m,) of lines (m,) by the times beside them; NaN where these do not fit."""
        ahead_s = anchor_s - self._beside.at(anchor_line)
        known = np.isfinite(ahead_s)
        if not known.any():
            return np.full(len(line), np.nan)
        anchor_line, anchor_s, ahead_s = anchor_line[known], anchor_s[known], ahead_s[known]
        after = np.searchsorted(anchor_line, line)
        before, after = np.maximum(after - 1, 0), np.minimum(after, len(anchor_line) - 1)
        time_s = self._beside.at(line) + np.interp(line, anchor_line, ahead_s)
        inside = (line >= anchor_line[0]) & (line <= anchor_line[-1])
        clipped_s = np.clip(time_s, anchor_s[before], np.maximum(anchor_s[before], anchor_s[after]))
        fits = np.abs(ahead_s[after] - ahead_s[before]) <= self._reorder_s
        return np.where(fits, np.where(inside, clipped_s, time_s), np.nan)

    def near(self, line: np.ndarray, time_of_day_s: np.ndarray) -> np.ndarray:
        """Times (m,) of lines (m,) with a time of day that does not make the clock."""
        time_s = self.at_line(line)
        return time_s + wrapped_s(time_of_day_s - time_s)

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
        bounds = np.searchsorted(section, np.arange(len(ends) + 1))
        news = [self._new_times(slice(a, b)) for a, b in itertools.pairwise(bounds)]
        self._news = news
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

    def _new_times(self, chosen: slice) -> tuple[np.ndarray, np.ndarray]:
        """Lines and times of the sentences that first give a later time."""
        line, time_s = self._line[chosen], self.time_s[chosen]
        line, time_s = line[np.isfinite(time_s)], time_s[np.isfinite(time_s)]
        if len(line) == 0:
            return np.zeros(0), np.zeros(0)
        latest_s = np.maximum.accumulate(time_s)
        new = np.append(True, np.diff(latest_s) > 0)
        new[1:] &= np.diff(line) > 0
        return line[new].astype(float), latest_s[new]


def _unrolled_s(
    clock_s: np.ndarray, day: np.ndarray, usual_s: float, leap_s: float, reorder_s: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (n,) from the midnight before the first; masks (n,) of wrong ones and of set backs."""
    unrolled_s = clock_s.copy()
    wrong, set_back = np.zeros((2, len(clock_s)), dtype=bool)
    last_s, doubted, first, utc_s = float(clock_s[0]), [], 0, DAY_S * day + clock_s

    def back(k: int) -> bool:
        later = utc_s[k] > np.max(utc_s[first:k], where=np.isfinite(day[first:k]), initial=-np.inf)
        return unrolled_s[k] < last_s and not (later and np.isfinite(day[first:k]).any())

    for k, time_s in enumerate(clock_s.tolist()):
        step_s = wrapped_s(time_s - last_s)
        goes_on = -reorder_s <= step_s <= leap_s
        unrolled_s[k] = last_s + step_s
        if doubted:
            before_s = float(unrolled_s[doubted[-1]])
            from_doubted_s = wrapped_s(time_s - before_s)
            if abs(from_doubted_s - usual_s) < abs(step_s - usual_s):
                goes_on = False
                unrolled_s[k] = before_s + from_doubted_s
        if goes_on:
            wrong[doubted] = True
            last_s, doubted = max(last_s, float(unrolled_s[k])), []
        else:
            doubted.append(k)
            if len(doubted) > _DOUBTED:
                start = doubted[0]
                if start - first <= _DOUBTED and back(start):
                    wrong[first:start] = True
                else:
                    set_back[start] = unrolled_s[start] < last_s
                last_s, doubted, first = float(unrolled_s[k]), [], start
    wrong[[k for k in doubted if back(k)]] = True
    return clock_s + DAY_S * _midnights(unrolled_s, clock_s), wrong, set_back


def _day_offset(unrolled_s: np.ndarray, clock_s: np.ndarray, day: np.ndarray) -> np.ndarray:
    """Days (n,) to add to unrolled times; zeros without a date."""
    dated = np.flatnonzero(np.isfinite(day))
    if len(dated) == 0:
        return np.zeros(len(day))
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
