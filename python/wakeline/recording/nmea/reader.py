"""Reads a log of NMEA 0183 sentences of own ship's instruments."""

from __future__ import annotations

import dataclasses
import datetime
import itertools
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from wakeline._brief import counted, many
from wakeline._checks import above_zero, at_least, plain_numbers
from wakeline._units import KNOT_MPS

from ..containers import instead_of_text, sentences_of
from ..errors import RecordingError
from ..reach import jumps_m, unreachable
from .beside import DAY_S, Beside, times_beside
from .clock import Clock
from .log import (
    SERIES,
    Fixes,
    GroundSpeed,
    MagneticHeading,
    NavigationLog,
    NmeaProblem,
    NmeaReport,
    Series,
    TrueHeading,
    WaterSpeed,
)
from .sentence import MODE_FIELD, Sentence, lines_of, sentences
from .sources import ClockStands, Timed, choose, date_notes

# Priority of the sentences that give the same time.
_BEST_FIRST = ("GGA", "GNS", "RMC", "GLL", "VTG")
# Quality of GGA for the mode of RMC, GLL and VTG, and those that are not measurements.
_QUALITY = {"A": 1, "D": 2, "P": 3, "R": 4, "F": 5, "E": 6, "M": 7, "S": 8, "N": 0}
_BEST_MODE_FIRST = "RFPDASEMN"  # of the modes of several systems of satellites
_NOT_MEASURED = (0, 6, 7)
_NOT_SAID = -1
_EARTH_RADIUS_M = 6371e3
_SBAS, _DIFFERENTIAL = 9, 2  # some receivers write 9, which GGA does not define, for 2

_SENTENCES = "NMEA 0183 sentences"
_MAX_SPEED_KN = 200.0
_MAX_RATE_DEG_MIN = 10_000.0
_STILL_MPS = 1.0 * KNOT_MPS  # below, a vessel at rest and a moving one look the same
_FROZEN_M = 50.0
_AT_ZERO_DEG = 1e-4
_SAME_VARIATION_DEG = 0.05
_BLIND_S = 60.0
_SILENT_S = 10.0
_UNMARKED_FIX = (False, False)  # frozen, suspect: found when all are read
_UNMARKED_GROUND = (False,)  # frozen


def read_nmea(
    path: str | Path,
    *,
    variation_deg: float | None = None,
    date: datetime.date | None = None,
    reorder_s: float = 2.0,
    max_speed_mps: float = 40.0,
) -> NavigationLog:
    """Read an NMEA 0183 log of own ship's instruments.

    **Sentences**: RMC, GGA, GNS, GLL, VTG, HDT, HDG, HDM, THS, VHW, VBW, ROT and ZDA of any talker,
    upper or lower case; others are counted. A checksum is optional but must be correct. Leading
    zeros of times, dates and positions may be missing, and minutes may be 60. An empty field is
    NaN. No line is fatal: problems are counted by kind in the report and listed with their lines.

    **Times** are those of the sentences (RMC, GGA, GNS, GLL, ZDA), with dates from RMC and ZDA, and
    continue over midnight:

    - If sentences have different clocks, the one that carries the voyage counts; clocks in local
    time are corrected, and the sentences of others dropped. Notes report each conflict with both
    times. The rule is that of ``wakeline.recording.nmea.sources.choose``.
    - Times beside the sentences (the ``c:`` of a TAG block, the stamp of a logger or a column of a
    recorder, before or after the sentence) count if no sentence has a time or their clock
    stands; otherwise they place readings without a time.
    - Without a date, a step is less than half a day.
    - A time before the last by up to `reorder_s` is late. A time farther before it or a leap after
    it (10 s, or five usual steps where these are longer) is wrong if one of the next three timed
    sentences continues from the previous clock, or if the log ends before three others; its
    sentence is dropped. Otherwise there is a gap, or the clock was set back. Dates are checked in
    the same way, but only the date is dropped. If only dropped sentences have dates, these dates
    are used. A date that may be 1024 weeks early is noted.
    - Other readings without a time are equally spaced by lines between the timed sentences around
    them; where the log itself stopped between them, they have the usual spacing after the first.
    The first VTG after a timed sentence has that time, because it belongs to its fix.

    **Fixes** of one time are one fix: the valid one, in the order GGA, GNS, RMC, GLL. Fixes are
    marked, never dropped: not `valid` (status V, quality 0); `frozen`, where the position is
    constant while the vessel moves over 50 m by its speed over ground, or else through the water,
    reported within a minute of the fix; `suspect` at 0/0 and where the vessel cannot be at
    `max_speed_mps`, if the fixes return to where it can be meanwhile. Three or more that do not
    return are accepted, and a note reports the jump. Positions in sentences with empty fields are
    not fixes. Speeds over ground are `frozen` where speed and course are constant with the
    position of frozen or suspect fixes.

    **Headings**: magnetic headings (HDG with its deviation, HDM) are a separate series, with
    `variation_deg`, else the variation of the sentence, else of the previous RMC (or else the
    first). With a sign, E or nothing may follow a variation.
    They also serve as true headings where the variation is known and there is no true one within
    10 s. Headings in VHW count only if the log has no others of their kind.

    Parameters
    ----------
    path : str or Path
        The log.
    variation_deg : float, optional
        Magnetic variation, positive east. It overrides that of the log.
    date : datetime.date, optional
        Day of the first timed sentence. It overrides the date of the log, whose later dates are
        moved alike; a datetime counts by its day.
    reorder_s : float
        Sentences that are late by up to this are sorted; a clock that goes back farther was set.
    max_speed_mps : float
        Maximum speed of the vessel.

    Returns
    -------
    NavigationLog

    Raises
    ------
    RecordingError
        When the file cannot be read, has no time or only a clock that stands, or no sentence with a
        reading.
    TypeError
        When `date` is not a date or another parameter is not a number.
    ValueError
        When a parameter is invalid.
    """
    at_least(0, reorder_s=reorder_s)
    above_zero(max_speed_mps=max_speed_mps)
    if variation_deg is not None:
        plain_numbers(variation_deg=variation_deg)
        if not abs(variation_deg) <= 180:
            raise ValueError(f"variation_deg must be from -180 to 180, got {variation_deg}")
    first_day, path, report = _day(date), Path(path), NmeaReport()
    octets, rows = sentences_of(path, wanted=f"a log of {_SENTENCES}"), Rows()
    lines = lines_of(octets)
    for sentence in sentences(lines, report):
        rows.read(sentence)
        for kind, reason in sentence.faults:
            report.add(sentence.line, kind, reason)
    beside = times_beside(lines)
    if not rows.timed and beside is None:
        raise _nothing_read(path, octets, report, "no sentence with a time could be read")
    try:
        times = _Times(rows, beside, first_day, reorder_s, report)
    except ClockStands as stands:
        raise RecordingError(
            path,
            f"{stands}, so that no position has a time",
            wanted="a clock that advances, or a time beside each sentence",
        ) from None
    clock = times.clock
    report.examples.sort(key=_line)
    series = {name: _series(kind, rows.of[name], times, report) for name, kind in SERIES.items()}
    invalid_notes = [*_empty_notes(rows.empty), *_invalid_notes(series)]
    series["compass"], overridden = _with_variation(
        series["compass"], rows.variation, variation_deg
    )
    series["heading"] = _true_headings(series["heading"], series["compass"], clock)
    series["fixes"] = _marked(series, clock, max_speed_mps)
    series["ground"] = _marked_ground(series, clock)
    if not any(map(len, series.values())):
        raise _nothing_read(path, octets, report, "no sentence with a reading could be read")
    notes: list[str] = []
    log = NavigationLog(
        path.stem,
        **series,
        dated=clock.dated,
        set_back_lines=clock.set_back_lines,
        report=report,
        notes=notes,
    )
    remarks = [*times.notes, *overridden]
    if clock.dated:
        remarks += date_notes(clock.first_day, clock.moved_days)
    remarks += [*_notes(log), *invalid_notes, *_jump_notes(log, max_speed_mps)]
    notes += [f"{path.name}: {note}" for note in remarks]
    return log


def _day(date: datetime.date | None) -> float:
    """Days since 1970, NaN for no date."""
    if date is None:
        return math.nan
    if not isinstance(date, datetime.date):
        raise TypeError(f"date must be a datetime.date, got {date!r}")
    return float(date.toordinal() - datetime.date(1970, 1, 1).toordinal())


def _line(problem: NmeaProblem) -> int:
    return problem.line


def _nothing_read(path: Path, octets: bytes, report: NmeaReport, problem: str) -> RecordingError:
    instead = instead_of_text(octets)
    if instead:
        return RecordingError(path, "the file is not text", wanted=_SENTENCES, got=instead)
    found = [f"{count} {kind}" for kind, count in report.sentences.most_common(8)]
    found += [f"{count} of {kind!r}" for kind, count in report.problems.most_common()]
    first = min(report.examples, key=_line, default=None)
    return RecordingError(
        path,
        problem + (f" (first problem in {first})" if first else ""),
        wanted=f"{_SENTENCES}, RMC, GGA, GNS, GLL or ZDA among them",
        got=f"{many(report.lines, 'line')}: {', '.join(found) or 'no sentence'}",
    )


# ------------------------------------------------------------------ sentences


class Rows:
    """The rows read so far.

    Attributes
    ----------
    timed : list of tuple
        Of each sentence with a time: line, time of day, days since 1970, address, and the latitude
        and longitude of a valid fix that is not at 0/0.
    before_vtg : dict of int to int
        For lines of VTG the index in `timed` of the sentence before it, of the same talker.
    variation : list of (line, radians)
    of : dict of str to list of tuple
        For each series rows of line, sentence, index in `timed` or None, valid, and its values.
    empty : dict of str to list of int
        For each kind of sentence the lines in which its main fields are empty.
    """

    def __init__(self) -> None:
        self.timed: list[tuple[int, float, float, str, float, float]] = []
        self.before_vtg: dict[int, int] = {}
        self.variation: list[tuple[int, float]] = []
        self.of: dict[str, list[tuple]] = {name: [] for name in SERIES}
        self.empty: dict[str, list[int]] = {}

    def read(self, s: Sentence) -> None:
        """Add the readings of a sentence."""
        names, _ = _IS_FOR.get(s.kind, ((), ""))
        before = [len(self.of[name]) for name in names]
        _READERS[s.kind](s, self)
        if names and not s.faults and before == [len(self.of[name]) for name in names]:
            self.empty.setdefault(s.kind, []).append(s.line)

    def stamp(
        self,
        s: Sentence,
        time_of_day_s: float,
        day: float = math.nan,
        *,
        valid: bool = False,
        place_deg: tuple[float, float] = (math.nan, math.nan),
    ) -> int | None:
        """Note a time; its index in `timed`, or None for an empty field."""
        if math.isnan(time_of_day_s):
            return None
        if not valid or max(map(abs, place_deg)) < _AT_ZERO_DEG:
            place_deg = math.nan, math.nan
        self.timed.append((s.line, time_of_day_s, day, s.address, *place_deg))
        return len(self.timed) - 1

    def add_where_known(
        self,
        name: str,
        s: Sentence,
        valid: bool,
        *values: float,
        stamp: int | None = None,
        marks: tuple[bool, ...] = (),
    ) -> None:
        """A row, if any of its values is known; `marks` are those of its last columns."""
        if not all(map(math.isnan, values)):
            self.of[name].append((s.line, s.kind, stamp, valid, *values, *marks))


def _rmc(s: Sentence, rows: Rows) -> None:
    time_s, place = s.time_of_day_s(0), s.place_deg(2)
    if s.faults:
        return
    status, quality = s.letter(1, "AV"), _quality(s)
    valid = not s.faults and status == "A" and quality not in _NOT_MEASURED
    stamp = rows.stamp(s, time_s, s.day(8), valid=valid, place_deg=place)
    _add_fix(rows, s, stamp, valid, place, quality)
    speed = _knots(s, 6), s.angle_rad(7)
    rows.add_where_known("ground", s, valid, *speed, stamp=stamp, marks=_UNMARKED_GROUND)
    variation_rad = s.signed_rad(9)
    if not math.isnan(variation_rad):
        rows.variation.append((s.line, variation_rad))


def _gga(s: Sentence, rows: Rows) -> None:
    time_s, place = s.time_of_day_s(0), s.place_deg(1)
    if s.faults:
        return
    given = s.number(MODE_FIELD[s.kind], 0, _SBAS)
    quality = _NOT_SAID if math.isnan(given) else int(given)
    _add_fix_with_hdop(rows, s, time_s, place, _DIFFERENTIAL if quality == _SBAS else quality)


def _gns(s: Sentence, rows: Rows) -> None:
    time_s, place = s.time_of_day_s(0), s.place_deg(1)
    if s.faults:
        return
    modes = s.letters(MODE_FIELD[s.kind], _BEST_MODE_FIRST)
    quality = _QUALITY[min(modes, key=_BEST_MODE_FIRST.index)] if modes else _NOT_SAID
    _add_fix_with_hdop(rows, s, time_s, place, quality)


def _add_fix_with_hdop(
    rows: Rows, s: Sentence, time_s: float, place_deg: tuple[float, float], quality: int
) -> None:
    valid = quality not in (*_NOT_MEASURED, _NOT_SAID)
    stamp = rows.stamp(s, time_s, valid=valid, place_deg=place_deg)
    _add_fix(rows, s, stamp, valid, place_deg, quality, s.number(7, 0.0, 1000.0))


def _gll(s: Sentence, rows: Rows) -> None:
    place, time_s = s.place_deg(0), s.time_of_day_s(4)
    if s.faults:
        return
    status, quality = s.letter(5, "AV"), _quality(s)
    valid = not s.faults and status != "V" and quality not in _NOT_MEASURED
    stamp = rows.stamp(s, time_s, valid=valid, place_deg=place)
    _add_fix(rows, s, stamp, valid, place, quality)


def _add_fix(
    rows: Rows,
    s: Sentence,
    stamp: int | None,
    valid: bool,
    place_deg: tuple[float, float],
    quality: int,
    hdop: float = math.nan,
) -> None:
    if not math.isnan(sum(place_deg)):
        values = (*place_deg, quality, hdop)
        rows.add_where_known("fixes", s, valid, *values, stamp=stamp, marks=_UNMARKED_FIX)


def _vtg(s: Sentence, rows: Rows) -> None:
    if rows.timed and rows.timed[-1][3][:-3] == s.address[:-3]:
        rows.before_vtg[s.line] = len(rows.timed) - 1
    quality = _quality(s)
    valid = not s.faults and quality not in _NOT_MEASURED
    speed_mps = _speed_mps(s, 4) if s.says(5, "N") else _kmh(s, 6)
    course_rad = s.angle_rad(0) if s.says(1, "T") else math.nan
    rows.add_where_known("ground", s, valid, speed_mps, course_rad, marks=_UNMARKED_GROUND)


def _hdt(s: Sentence, rows: Rows) -> None:
    rows.add_where_known("heading", s, True, s.angle_rad(0))


def _ths(s: Sentence, rows: Rows) -> None:
    valid = s.letter(MODE_FIELD[s.kind], "AEMSV") in ("A", "S")
    rows.add_where_known("heading", s, valid, s.angle_rad(0))


def _hdg(s: Sentence, rows: Rows) -> None:
    deviation_rad = s.signed_rad(1)
    heading_rad = s.angle_rad(0) + (0.0 if math.isnan(deviation_rad) else deviation_rad)
    variation_rad = s.signed_rad(3)
    if not math.isnan(heading_rad):
        rows.add_where_known("compass", s, True, heading_rad % math.tau, variation_rad)


def _hdm(s: Sentence, rows: Rows) -> None:
    rows.add_where_known("compass", s, True, s.angle_rad(0), math.nan)


def _vhw(s: Sentence, rows: Rows) -> None:
    rows.add_where_known("heading", s, True, s.angle_rad(0))
    rows.add_where_known("compass", s, True, s.angle_rad(2), math.nan)
    rows.add_where_known("water", s, True, _speed_mps(s, 4), math.nan)


def _vbw(s: Sentence, rows: Rows) -> None:
    for name, k in (("water", 0), ("bottom", 3)):
        valid = s.letter(k + 2, "AV") == "A"
        rows.add_where_known(name, s, valid, _knots(s, k), _knots(s, k + 1))


def _rot(s: Sentence, rows: Rows) -> None:
    rate_deg_min = s.number(0, -_MAX_RATE_DEG_MIN, _MAX_RATE_DEG_MIN)
    rows.add_where_known("turn", s, s.letter(1, "AV") == "A", math.radians(rate_deg_min) / 60.0)


def _zda(s: Sentence, rows: Rows) -> None:
    time_s = s.time_of_day_s(0)
    rows.stamp(s, time_s, s.day_in_fields(1))


_READERS = {
    "RMC": _rmc,
    "GGA": _gga,
    "GNS": _gns,
    "GLL": _gll,
    "VTG": _vtg,
    "HDT": _hdt,
    "THS": _ths,
    "HDG": _hdg,
    "HDM": _hdm,
    "VHW": _vhw,
    "VBW": _vbw,
    "ROT": _rot,
    "ZDA": _zda,
}

# The series of a kind of sentence, and its main quantity.
_IS_FOR = {
    **dict.fromkeys(("RMC", "GGA", "GNS", "GLL"), (("fixes",), "position")),
    "VTG": (("ground",), "speed"),
    **dict.fromkeys(("HDT", "THS"), (("heading",), "heading")),
    **dict.fromkeys(("HDG", "HDM"), (("compass",), "heading")),
    "VHW": (("heading", "compass", "water"), "heading or speed"),
    "ROT": (("turn",), "rate of turn"),
}


def _quality(s: Sentence) -> int:
    return _QUALITY.get(s.letter(MODE_FIELD[s.kind], "".join(_QUALITY)), _NOT_SAID)


def _knots(s: Sentence, k: int) -> float:
    return s.number(k, -_MAX_SPEED_KN, _MAX_SPEED_KN) * KNOT_MPS


def _speed_mps(s: Sentence, k: int) -> float:
    """A speed in knots, or else, two fields later, in km/h."""
    speed_mps = _knots(s, k)
    return _kmh(s, k + 2) if math.isnan(speed_mps) else speed_mps


def _kmh(s: Sentence, k: int) -> float:
    return s.number(k, -2 * _MAX_SPEED_KN, 2 * _MAX_SPEED_KN) / 3.6


# ------------------------------------------------------------------ times


class _Times:
    """The times of the readings of a log.

    Attributes
    ----------
    clock : Clock
        That of the sentences chosen for it, or of the times beside them.
    notes : list of str
        Conflicts between clocks and dates.
    """

    def __init__(
        self,
        rows: Rows,
        beside: Beside | None,
        first_day: float,
        reorder_s: float,
        report: NmeaReport,
    ) -> None:
        self.notes: list[str] = []
        self._line, clock_s, day, address, *place_deg = (
            map(np.array, zip(*rows.timed, strict=True)) if rows.timed else np.zeros((6, 0))
        )
        timed = Timed(self._line, clock_s, day, address, np.column_stack(place_deg))
        self._time_s = np.full(len(self._line), np.nan)
        rules = first_day, reorder_s, report
        choice = choose(timed, beside, reorder_s) if rows.timed else None
        if choice is None or choice.by_stamps:
            untimed = [f"no sentence has a time: {beside.what} count"]
            zone = [] if beside.utc else [f"{beside.what} have no zone and are taken as UTC"]
            self.notes += [*(choice.notes if choice else untimed), *zone]
            midnight = np.floor(beside.time_s / DAY_S)
            clock_s = beside.time_s - DAY_S * midnight
            day = midnight if beside.dated else np.full(len(midnight), np.nan)
            self.clock = Clock(beside.line, clock_s, day, *rules, beside)
        else:
            for k, reason in choice.rejected.items():
                report.add(int(self._line[k]), "time", reason)
            self.notes += choice.notes
            used, kept, clock_s, day = choice.used, choice.kept, choice.clock_s, choice.day
            self.clock = Clock(self._line[used], clock_s[used], day[used], *rules, beside)
            self._time_s[used] = self.clock.time_s
            self._time_s[kept] = self.clock.near(self._line[kept], clock_s[kept])
        self._rejected = np.zeros(len(self._line), dtype=bool)
        self._rejected[list(choice.rejected) if choice else []] = True
        self._untimed = ~self._rejected & np.isnan(self._time_s)
        if choice is not None and not choice.by_stamps:
            self._untimed &= ~choice.used
        self._before_vtg = rows.before_vtg

    def of(self, line: np.ndarray, sentence: np.ndarray, stamp: tuple) -> np.ndarray:
        """Times (n,) of rows; NaN where that of the sentence is wrong."""
        own = np.array([-1 if k is None else k for k in stamp], dtype=np.int64)
        vtg = np.flatnonzero(sentence == "VTG")
        of_fix_s = np.full(len(line), np.nan)
        of_fix_s[vtg] = self._last_timed(line[vtg])
        of_fix_s[vtg[1:][of_fix_s[vtg[1:]] == of_fix_s[vtg[:-1]]]] = np.nan
        time_s = np.where(np.isnan(of_fix_s), self.clock.at_line(line), of_fix_s)
        before = np.array([self._before_vtg.get(k, -1) for k in line[vtg].tolist()], dtype=np.int64)
        time_s[vtg[before >= 0][self._rejected[before[before >= 0]]]] = np.nan
        timed = own >= 0
        timed[timed] = ~self._untimed[own[timed]]
        time_s[timed] = self._time_s[own[timed]]
        return time_s

    def _last_timed(self, line: np.ndarray) -> np.ndarray:
        """Times (m,) of the last timed sentence before each line (m,), NaN without one."""
        believed = np.isfinite(self._time_s)
        if not believed.any():
            return np.full(len(line), np.nan)
        before = np.searchsorted(self._line[believed], line, side="right") - 1
        return np.where(before < 0, np.nan, self._time_s[believed][before])


# ------------------------------------------------------------------ series

_BASE = ("time_s", "valid", "sentence", "line")
_DTYPE = {"quality": np.int64, "frozen": bool, "suspect": bool}


def _series(kind: type[Series], rows: list[tuple], times: _Times, report: NmeaReport) -> Series:
    """Rows with their times, in order; fixes and ground speeds one per time."""
    clock = times.clock
    names = [f.name for f in dataclasses.fields(kind) if f.name not in _BASE]
    line, sentence, stamp, valid, *values = (
        zip(*rows, strict=True) if rows else [()] * (4 + len(names))
    )
    line, sentence = np.array(line, dtype=np.int64), np.array(sentence, dtype="<U3")
    series = kind(
        time_s=times.of(line, sentence, stamp),
        valid=np.array(valid, dtype=bool),
        sentence=sentence,
        line=line,
        **{
            name: np.array(column, dtype=_DTYPE.get(name, float))
            for name, column in zip(names, values, strict=True)
        },
    )
    series = series.rows(np.isfinite(series.time_s))
    series = series.rows(np.lexsort((series.line, series.time_s, clock.section(series.line))))
    return _one_a_time(series, clock, report) if kind in (Fixes, GroundSpeed) else series


def _one_a_time(series: Series, clock: Clock, report: NmeaReport) -> Series:
    millisecond = np.rint(series.time_s * 1e3)
    section = clock.section(series.line)
    rank = np.array([_BEST_FIRST.index(kind) for kind in series.sentence.tolist()], dtype=int)
    order = np.lexsort((series.line, rank, ~series.valid, millisecond, section))
    series, millisecond, section = series.rows(order), millisecond[order], section[order]
    again = (np.diff(millisecond) == 0) & (np.diff(section) == 0)
    report.repeated += int(np.count_nonzero(again))
    first = np.append(True, ~again)[: len(series)]
    if isinstance(series, Fixes):
        report.displaced_lines += _other_lines(series, first, "latitude_deg", "longitude_deg")
    else:
        report.other_speed_lines += _other_lines(series, first, "speed_mps", "course_rad")
    return series.rows(first)


def _other_lines(series: Series, first: np.ndarray, *names: str) -> list[int]:
    """Lines of valid readings other than the first of their time, of the same kind."""
    kept = series.rows(np.maximum.accumulate(np.where(first, np.arange(len(series)), 0)))
    other = np.any([_differ(getattr(series, name), getattr(kept, name)) for name in names], axis=0)
    return np.sort(series.line[series.valid & (series.sentence == kept.sentence) & other]).tolist()


def _differ(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return (a != b) & ~(np.isnan(a) & np.isnan(b))


# ------------------------------------------------------------------ headings


def _with_variation(
    compass: MagneticHeading, given: list[tuple[int, float]], given_deg: float | None
) -> tuple[MagneticHeading, list[str]]:
    """Magnetic headings with the variation given, or else that of the log, and notes."""
    compass = _others_than_vhw(compass)
    if given_deg is not None:
        return _with_given_variation(compass, given, given_deg)
    if given:
        line, given_rad = map(np.array, zip(*given, strict=True))
        known_rad = given_rad[np.maximum(np.searchsorted(line, compass.line, side="right") - 1, 0)]
    else:
        known_rad = np.nan
    unknown = np.isnan(compass.variation_rad)
    variation_rad = np.where(unknown, known_rad, compass.variation_rad)
    return dataclasses.replace(compass, variation_rad=variation_rad), []


def _with_given_variation(
    compass: MagneticHeading, of_rmc: list[tuple[int, float]], given_deg: float
) -> tuple[MagneticHeading, list[str]]:
    """Magnetic headings with the variation given, and a note if the log has another one."""
    of_log = of_rmc + list(zip(compass.line.tolist(), compass.variation_rad.tolist(), strict=True))
    other = [
        (line, math.degrees(rad))
        for line, rad in of_log
        if abs(math.degrees(rad) - given_deg) > _SAME_VARIATION_DEG
    ]
    notes = []
    if other:
        line, log_deg = min(other)
        instead = f"instead of {log_deg:+.1f}° in the log (first in line {line})"
        notes = [f"the variation given, {given_deg:+.1f}°, is used {instead}"]
    variation_rad = np.full(len(compass), math.radians(given_deg))
    return dataclasses.replace(compass, variation_rad=variation_rad), notes


def _true_headings(heading: TrueHeading, compass: MagneticHeading, clock: Clock) -> TrueHeading:
    """The true headings, and those of the compass where they are missing."""
    heading = _others_than_vhw(heading)
    known = compass.rows(np.isfinite(compass.variation_rad))
    if not heading.valid.any() and len(known):
        heading = heading.rows(heading.valid)
    silent = np.ones(len(known), dtype=bool)
    for own, other in zip(*_by_section(clock, heading, known), strict=True):
        given_s = heading.time_s[own][heading.valid[own]]
        silent[other] = _far(known.time_s[other], given_s, _SILENT_S)
    joined = _joined(heading, known.rows(silent))
    return joined.rows(np.lexsort((joined.line, joined.time_s, clock.section(joined.line))))


def _far(time_s: np.ndarray, given_s: np.ndarray, by_s: float) -> np.ndarray:
    """Mask (n,) of the times that are farther than `by_s` from any of the sorted others."""
    around_s = np.concatenate([[-np.inf], given_s, [np.inf]])
    after = np.searchsorted(around_s, time_s)
    return np.minimum(time_s - around_s[after - 1], around_s[after] - time_s) > by_s


def _joined(heading: TrueHeading, compass: MagneticHeading) -> TrueHeading:
    names = [f.name for f in dataclasses.fields(TrueHeading)]
    pairs = [(getattr(heading, name), getattr(compass, name)) for name in names]
    return TrueHeading(*map(np.concatenate, pairs))


def _others_than_vhw(series: Series) -> Series:
    """The readings that do not come from a VHW, if any of them is valid."""
    other = series.sentence != "VHW"
    return series.rows(other) if series.valid[other].any() else series


# ------------------------------------------------------------------ doubtful fixes


def _marked(series: dict[str, Series], clock: Clock, max_speed_mps: float) -> Fixes:
    """The fixes, with frozen and suspect ones marked."""
    fixes = series["fixes"]
    frozen, suspect = np.zeros(len(fixes), dtype=bool), _at_zero(fixes)
    of_sections = _by_section(clock, fixes, series["ground"], series["water"])
    for here, ground, water in zip(*of_sections, strict=True):
        time_s, place = fixes.time_s[here], np.arange(len(fixes))[here]
        speed_mps = _speed_at(time_s, series["ground"].rows(ground), series["water"].rows(water))
        frozen[here] = _frozen(fixes.rows(here), speed_mps) & ~suspect[here]
        placed = place[fixes.valid[here] & ~suspect[here]]
        position_m = _earth_centred_m(fixes.rows(placed))
        suspect[placed] = unreachable(fixes.time_s[placed], position_m, max_speed_mps)
    return dataclasses.replace(fixes, frozen=frozen, suspect=suspect)


def _marked_ground(series: dict[str, Series], clock: Clock) -> GroundSpeed:
    """The speeds over ground, with frozen ones marked."""
    fixes, ground = series["fixes"], series["ground"]
    same_place = _repeats(fixes.latitude_deg, fixes.longitude_deg)
    stuck = fixes.rows(same_place & (fixes.frozen | fixes.suspect))
    frozen = _repeats(ground.speed_mps, ground.course_rad)
    for here, there in zip(*_by_section(clock, ground, stuck), strict=True):
        frozen[here] &= np.isin(ground.time_s[here], stuck.time_s[there])
    return dataclasses.replace(ground, frozen=frozen)


def _by_section(clock: Clock, *series: Series) -> list[list[slice]]:
    """For each series its rows of each section, which are in order."""
    number = np.arange(len(clock.set_back_lines) + 2)
    edges = [np.searchsorted(clock.section(s.line), number).tolist() for s in series]
    return [[slice(a, b) for a, b in itertools.pairwise(of_one)] for of_one in edges]


def _at_zero(fixes: Fixes) -> np.ndarray:
    return (np.abs(fixes.latitude_deg) < _AT_ZERO_DEG) & (
        np.abs(fixes.longitude_deg) < _AT_ZERO_DEG
    )


def _speed_at(time_s: np.ndarray, ground: GroundSpeed, water: WaterSpeed) -> np.ndarray:
    """Speeds (n,) over ground, or else through the water, or zero without either."""
    speed_mps = np.zeros(len(time_s))
    for series, values in ((water, "ahead_mps"), (ground, "speed_mps")):
        readings = series.rows(series.valid & np.isfinite(getattr(series, values)))
        given = ~_far(time_s, readings.time_s, _BLIND_S)
        given_mps = np.abs(getattr(readings, values))
        speed_mps[given] = (
            np.interp(time_s[given], readings.time_s, given_mps) if given.any() else 0.0
        )
    return speed_mps


def _frozen(fixes: Fixes, speed_mps: np.ndarray) -> np.ndarray:
    """Mask (n,) of fixes that repeat the previous one although the vessel moves."""
    same = _repeats(fixes.latitude_deg, fixes.longitude_deg)
    speed_mps = np.where(speed_mps < _STILL_MPS, 0.0, speed_mps)
    step_m = 0.5 * (speed_mps[1:] + speed_mps[:-1]) * np.diff(fixes.time_s)
    run = np.cumsum(~same) - 1
    way_m = np.bincount(run[1:], np.where(same[1:], step_m, 0.0), minlength=1)
    return same & (way_m[run] > _FROZEN_M)


def _repeats(*columns: np.ndarray) -> np.ndarray:
    """Mask (n,) of the rows equal to the previous one."""
    same = np.all([np.diff(column) == 0 for column in columns], axis=0)
    return np.append(False, same)[: len(columns[0])]


def _earth_centred_m(fixes: Fixes) -> np.ndarray:
    """Positions (n, 3) on a sphere."""
    latitude, longitude = fixes.latitude_rad, fixes.longitude_rad
    across = np.cos(latitude)
    vertical = (across * np.cos(longitude), across * np.sin(longitude), np.sin(latitude))
    return _EARTH_RADIUS_M * np.column_stack(vertical)


# ------------------------------------------------------------------ notes


def _notes(log: NavigationLog) -> list[str]:
    report, fixes, ground = log.report, log.fixes, log.ground
    notes = [_problem_note(report, kind, n) for kind, n in report.problems.most_common()]
    if not log.dated:
        notes.append("no sentence has a date, so times count from the midnight before the first")
    if len(log.set_back_lines):
        where = ", ".join(map(str, log.set_back_lines[:5].tolist()))
        times = many(len(log.set_back_lines), "time")
        notes.append(f"the clock was set back {times} (line {where})")
    displaced = report.displaced_lines
    if displaced:
        what = "[fix|fixes] at a time given before but another position [is|are] left out"
        notes.append(f"{counted(len(displaced), what)} (first in line {displaced[0]})")
    other = report.other_speed_lines
    if other:
        what = "different [speed|speeds] over ground at a time given before [is|are] left out"
        notes.append(f"{counted(len(other), what)} (first in line {other[0]})")
    still = ground.frozen & ground.valid
    for series, mask, what in (
        (fixes, ~fixes.valid, "[fix|fixes] marked invalid by the receiver"),
        (fixes, fixes.frozen, "[fix|fixes] frozen while the vessel moves"),
        (fixes, fixes.suspect, "[fix|fixes] at 0/0 or out of the vessel's reach"),
        (ground, still, "[speed|speeds] over ground repeated with such a fix"),
    ):
        if mask.any():
            first = int(series.line[mask][0])
            notes.append(f"{counted(np.count_nonzero(mask), what)} (first in line {first})")
    gaps_s = np.diff(log.gaps_s()).ravel()
    if len(gaps_s):
        notes.append(
            f"{many(len(gaps_s), 'gap')} of more than 10 s between fixes, the longest "
            f"{gaps_s.max():g} s"
        )
    blind_s = _blind_s(log)
    if len(blind_s):
        notes.append(
            counted(len(blind_s), "[interval|intervals] of more than ")
            + f"{_BLIND_S:g} s without a heading, the longest {blind_s.max():.0f} s"
        )
    lines = _unknown_where_silent(log)
    if len(lines):
        what = "magnetic [heading|headings] without true ones [needs|need] a variation"
        notes.append(f"{counted(len(lines), what)} (first in line {lines.min()})")
    unknown = np.count_nonzero(np.isnan(log.compass.variation_rad))
    if not log.heading.valid.any():
        what = "magnetic [one needs|ones need] a variation"
        also = f"; {counted(unknown, what)}" if unknown else ""
        notes.append(f"no true heading{also}")
    return notes


def _blind_s(log: NavigationLog) -> np.ndarray:
    """Durations (k,) without a heading although other sentences came, if the log has headings."""
    stretches_s = [np.zeros(0)]
    if log.heading.valid.any() or log.compass.valid.any():
        for part in log.parts():
            heard_s = np.concatenate([series.time_s for series in part.series.values()])
            given_s = (part.heading.sound() or part.compass.sound()).time_s
            stretches_s.append(np.diff([heard_s.min(), *given_s, heard_s.max()]))
    blind_s = np.concatenate(stretches_s)
    return blind_s[blind_s > _BLIND_S]


def _unknown_where_silent(log: NavigationLog) -> np.ndarray:
    """Lines (n,) of magnetic headings of unknown variation that true ones do not replace."""
    lines = [np.zeros(0, dtype=np.int64)]
    for part in log.parts():
        given_s, compass = part.heading.sound().time_s, part.compass.sound()
        if len(given_s):
            unknown = np.isnan(compass.variation_rad)
            lines.append(compass.line[unknown & _far(compass.time_s, given_s, _SILENT_S)])
    return np.concatenate(lines)


def _empty_notes(empty: dict[str, list[int]]) -> Iterator[str]:
    for kind, lines in empty.items():
        _, what = _IS_FOR[kind]
        note = counted(len(lines), f"{kind} [sentence has|sentences have] no {what}")
        yield f"{note} (first in line {lines[0]})"


def _invalid_notes(series: dict[str, Series]) -> Iterator[str]:
    for name, what in (
        ("heading", "[heading|headings]"),
        ("water", "[speed|speeds] through the water"),
        ("bottom", "[speed|speeds] over ground by log"),
        ("turn", "[rate|rates] of turn"),
    ):
        line = series[name].line[~series[name].valid]
        if len(line):
            note = counted(len(line), f"{what} marked invalid by the instrument")
            yield f"{note} (first in line {line.min()})"


def _jump_notes(log: NavigationLog, max_speed_mps: float) -> Iterator[str]:
    for part in log.parts(np.inf):
        fixes = part.fixes.sound()
        jump_m = jumps_m(fixes.time_s, _earth_centred_m(fixes), max_speed_mps)
        at = np.flatnonzero(jump_m)
        if len(at):
            count = np.append(at, len(fixes))[1] - at[0]
            yield (
                f"the position jumps {many(len(at), 'time')} out of the vessel's reach, "
                f"first by {jump_m[at[0]] / 1e3:.3g} km in line {fixes.line[at[0]]}, where "
                + counted(count, "[fix continues|fixes continue]")
            )


def _problem_note(report: NmeaReport, kind: str, count: int) -> str:
    first = next((str(p) for p in report.examples if p.kind == kind), None)
    return f"{many(count, 'problem')} of kind {kind!r}" + (f" (first in {first})" if first else "")
