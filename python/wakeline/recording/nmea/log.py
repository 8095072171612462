"""What a log of a vessel's own instruments holds: one series a kind of reading, each at its times.

Times are UTC seconds since 1970, angles radians clockwise from north, speeds m/s.
"""

from __future__ import annotations

import dataclasses
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from wakeline._brief import brief, many, span
from wakeline._checks import not_negative

from ..local_plane import LocalPlane
from ..model import OwnShip

if TYPE_CHECKING:
    from typing_extensions import Self


@dataclass(frozen=True)
class Series:
    """Readings of one kind.

    Rows are in the order of time; where the clock was set back, what came before it stands first.

    Attributes
    ----------
    time_s : ndarray (n,)
        UTC seconds.
    valid : ndarray of bool (n,)
        Whether the instrument itself stands by the reading.
    sentence : ndarray of str (n,)
        The sentence it came in, such as ``RMC``.
    line : ndarray of int (n,)
        Its line of the file.
    """

    time_s: np.ndarray
    valid: np.ndarray
    sentence: np.ndarray
    line: np.ndarray

    def __len__(self) -> int:
        return len(self.time_s)

    def __repr__(self) -> str:
        return brief(self, many(len(self), "reading"), span(self.time_s))

    @property
    def usable(self) -> np.ndarray:
        """Mask (n,) of the readings to work with."""
        return self.valid

    def rows(self, which: slice | np.ndarray) -> Self:
        """Some of the readings, by slice, index or mask."""
        values = {f.name: getattr(self, f.name)[which] for f in dataclasses.fields(self)}
        return dataclasses.replace(self, **values)

    def sound(self) -> Self:
        """The readings that are `usable`."""
        return self.rows(self.usable)


@dataclass(frozen=True, repr=False)
class Fixes(Series):
    """Positions by satellite, one a time (RMC, GGA, GNS, GLL).

    Attributes
    ----------
    latitude_deg, longitude_deg : ndarray (n,)
        WGS84, positive north and east.
    quality : ndarray of int (n,)
        As GGA counts: 0 none, 1 autonomous, 2 differential (9 of a GGA, too), 3 precise, 4 RTK,
        5 RTK float, 6 estimated, 7 put in by hand, 8 simulated; -1 not said. `valid` is false for
        0, 6 and 7, where the status is V, and where either cannot be read. Of the modes of a GNS it
        is the best.
    hdop : ndarray (n,)
        Horizontal dilution of precision, NaN where not said.
    frozen : ndarray of bool (n,)
        The position is that of the fix before, again and again, though the vessel moves.
    suspect : ndarray of bool (n,)
        At latitude 0, longitude 0, or where the vessel cannot have come: alone, or several that
        come back to where she can have come without them.
    """

    latitude_deg: np.ndarray
    longitude_deg: np.ndarray
    quality: np.ndarray
    hdop: np.ndarray
    frozen: np.ndarray
    suspect: np.ndarray

    @property
    def usable(self) -> np.ndarray:
        """Mask (n,) of fixes that are valid, not frozen and not suspect."""
        return self.valid & ~self.frozen & ~self.suspect


@dataclass(frozen=True, repr=False)
class GroundSpeed(Series):
    """Speed and course over ground, one a time (RMC, VTG).

    Attributes
    ----------
    speed_mps, course_rad : ndarray (n,)
        NaN where only the other is given. Course from true north in [0, 2 pi).
    frozen : ndarray of bool (n,)
        Speed and course are those of the reading before, as is the position of the fix they come
        with, which is frozen or suspect.
    """

    speed_mps: np.ndarray
    course_rad: np.ndarray
    frozen: np.ndarray

    @property
    def usable(self) -> np.ndarray:
        """Mask (n,) of readings that are valid and not frozen."""
        return self.valid & ~self.frozen


@dataclass(frozen=True, repr=False)
class TrueHeading(Series):
    """Heading from true north (HDT, THS, VHW; from a magnetic compass where these are silent).

    Attributes
    ----------
    heading_rad : ndarray (n,)
        In [0, 2 pi).
    """

    heading_rad: np.ndarray


@dataclass(frozen=True, repr=False)
class MagneticHeading(Series):
    """Heading from magnetic north (HDG, HDM, VHW), deviation removed where the sentence gives it.

    Attributes
    ----------
    heading_magnetic_rad : ndarray (n,)
        In [0, 2 pi).
    variation_rad : ndarray (n,)
        Positive east; NaN where neither the log nor the caller knows it.
    """

    heading_magnetic_rad: np.ndarray
    variation_rad: np.ndarray

    @property
    def heading_rad(self) -> np.ndarray:
        """Heading (n,) from true north in [0, 2 pi); NaN where the variation is not known."""
        return np.mod(self.heading_magnetic_rad + self.variation_rad, 2 * np.pi)


@dataclass(frozen=True, repr=False)
class WaterSpeed(Series):
    """Speed through the water (VHW, VBW).

    Attributes
    ----------
    ahead_mps, starboard_mps : ndarray (n,)
        Along and across the hull; NaN where not given.
    """

    ahead_mps: np.ndarray
    starboard_mps: np.ndarray


@dataclass(frozen=True, repr=False)
class BottomTrack(Series):
    """Speed over ground as a log sees it (VBW).

    Attributes
    ----------
    ahead_mps, starboard_mps : ndarray (n,)
        Along and across the hull; NaN where not given.
    """

    ahead_mps: np.ndarray
    starboard_mps: np.ndarray


@dataclass(frozen=True, repr=False)
class RateOfTurn(Series):
    """Rate of turn (ROT).

    Attributes
    ----------
    turn_rate_rad_s : ndarray (n,)
        Positive to starboard.
    """

    turn_rate_rad_s: np.ndarray


@dataclass(frozen=True)
class NmeaProblem:
    """Something in a log that could not be used.

    Attributes
    ----------
    line : int
        Line of the file, from 1.
    kind : str
        A key of `NmeaReport.problems`.
    reason : str
        What was wanted and what came.
    """

    line: int
    kind: str
    reason: str

    def __str__(self) -> str:
        return f"line {self.line}: {self.kind}: {self.reason}"


@dataclass
class NmeaReport:
    """What was in a log and what could not be used of it.

    Attributes
    ----------
    lines : int
        Lines of the file.
    sentences : Counter of str
        Sound sentences by kind, such as ``RMC``, those of no interest among them.
    problems : Counter of str
        How often each kind of problem came. A sentence is left out for ``no sentence`` (text
        without ``$``), ``cut`` (its end is missing), ``checksum``, ``character`` (an octet that
        cannot be printed), ``address`` (none of talker and kind) and ``time`` (a time that leaps
        and comes back). Of one with a ``field`` that cannot be read or out of ``range`` only that
        value is left out, unless it is the time or the place; of one with a ``date`` that leaps and
        comes back, only the date.
    examples : list of NmeaProblem
        Problems in the order of lines, at most `max_examples`.
    repeated : int
        Fixes and ground speeds of a time that another sentence had given already.
    displaced_lines : list of int
        Lines of valid fixes among them that were left out though at another place than the fix of
        that time, which another sentence of their kind had given.
    other_speed_lines : list of int
        Lines of valid ground speeds among them that were left out though other than that of their
        time, which another sentence of their kind had given.
    max_examples : int
    """

    lines: int = 0
    sentences: Counter[str] = field(default_factory=Counter)
    problems: Counter[str] = field(default_factory=Counter)
    examples: list[NmeaProblem] = field(default_factory=list)
    repeated: int = 0
    displaced_lines: list[int] = field(default_factory=list)
    other_speed_lines: list[int] = field(default_factory=list)
    max_examples: int = 100_000

    def add(self, line: int, kind: str, reason: str) -> None:
        """Count a problem and keep it while there is room."""
        self.problems[kind] += 1
        if len(self.examples) < self.max_examples:
            self.examples.append(NmeaProblem(line, kind, reason))


@dataclass(frozen=True)
class NavigationLog:
    """The readings of a vessel's own instruments.

    Attributes
    ----------
    name : str
        Stem of the file.
    fixes : Fixes
    ground : GroundSpeed
    heading : TrueHeading
    compass : MagneticHeading
    water : WaterSpeed
    bottom : BottomTrack
    turn : RateOfTurn
    dated : bool
        Whether the log, or the caller, says the day; if not, times count from the midnight before
        the first.
    set_back_lines : ndarray of int (k,)
        Lines where the clock was set back.
    report : NmeaReport
    notes : list of str
        What there is to know before using the log; empty for a clean one.
    """

    name: str
    fixes: Fixes
    ground: GroundSpeed
    heading: TrueHeading
    compass: MagneticHeading
    water: WaterSpeed
    bottom: BottomTrack
    turn: RateOfTurn
    dated: bool
    set_back_lines: np.ndarray
    report: NmeaReport
    notes: list[str]

    def __repr__(self) -> str:
        counts = (f"{name} {len(series)}" for name, series in self.series.items() if len(series))
        return brief(self, *counts, span(self.fixes.time_s), name=self.name)

    @property
    def series(self) -> dict[str, Series]:
        """All series by name."""
        return {name: getattr(self, name) for name in SERIES}

    def gaps_s(self, longer_than_s: float = 10.0) -> np.ndarray:
        """Times (k, 2) of usable fixes before and after each gap longer than `longer_than_s`.

        ValueError when that is negative.
        """
        not_negative(longer_than_s=longer_than_s)
        fixes = self.fixes.sound()
        wide = np.flatnonzero(np.diff(fixes.time_s) > longer_than_s)
        return np.column_stack([fixes.time_s[wide], fixes.time_s[wide + 1]])

    def fixes_in_order(self, what: str) -> Fixes:
        """Sound fixes, of which there is one at least, under a clock that was never set back.

        Raises
        ------
        ValueError
            When it is not so; says what wants them.
        """
        fixes = self.fixes.sound()
        if len(fixes) == 0:
            raise ValueError(f"{self.name}: a {what} wants a sound fix, got none")
        if len(self.set_back_lines):
            raise ValueError(
                f"{self.name}: the clock was set back, so that times do not grow: "
                f"take the {what} of each of parts()"
            )
        return fixes

    def track(self, plane: LocalPlane | None = None) -> OwnShip:
        """Where the vessel was, by her sound fixes, and her velocities as told with them.

        Gaps are not told apart: of a log in several parts take the track of each of `parts`, unless
        what joins them may be made up.

        Parameters
        ----------
        plane : LocalPlane, optional
            Default the one that touches the earth at the first sound fix.

        Returns
        -------
        OwnShip
            Velocities are NaN at fixes that come without one; zero at rest without a course.

        Raises
        ------
        ValueError
            When there is no sound fix, or the clock was set back.
        """
        fixes, ground = self.fixes_in_order("track"), self.ground.sound()
        place_deg = fixes.latitude_deg, fixes.longitude_deg
        plane = plane or LocalPlane(fixes.latitude_deg[0], fixes.longitude_deg[0])
        speed_mps, course_rad = np.full((2, len(fixes)), np.nan)
        _, of_fix, of_ground = np.intersect1d(fixes.time_s, ground.time_s, return_indices=True)
        speed_mps[of_fix] = ground.speed_mps[of_ground]
        course_rad[of_fix] = ground.course_rad[of_ground]
        course_rad[speed_mps == 0] = 0.0
        course_rad = plane.course_rad(course_rad, *place_deg)
        return OwnShip(
            fixes.time_s,
            *plane.position_m(*place_deg),
            vnorth_mps=speed_mps * np.cos(course_rad),
            veast_mps=speed_mps * np.sin(course_rad),
        )

    def parts(self, max_gap_s: float = 60.0) -> list[NavigationLog]:
        """The log cut where no instrument was heard for longer than `max_gap_s`.

        It is cut, too, where the clock was set back, so that in each part times only grow. All
        parts share the report and the notes.

        Parameters
        ----------
        max_gap_s : float

        Raises
        ------
        ValueError
            When it is negative.
        """
        not_negative(max_gap_s=max_gap_s)
        all_series = self.series.values()
        time_s = np.concatenate([s.time_s for s in all_series])
        section = self._section(np.concatenate([s.line for s in all_series]))
        parts = []
        for number in np.unique(section):
            heard_s = np.unique(time_s[section == number])
            cuts = np.flatnonzero(np.diff(heard_s) > max_gap_s)
            starts, ends = heard_s[[0, *(cuts + 1)]], heard_s[[*cuts, -1]]
            parts += [self._part(number, a, b) for a, b in zip(starts, ends, strict=True)]
        return parts

    def _part(self, section: int, start_s: float, end_s: float) -> NavigationLog:
        inside = {
            name: s.rows(
                (self._section(s.line) == section) & (s.time_s >= start_s) & (s.time_s <= end_s)
            )
            for name, s in self.series.items()
        }
        return dataclasses.replace(self, **inside, set_back_lines=np.zeros(0, dtype=np.int64))

    def _section(self, line: np.ndarray) -> np.ndarray:
        """How often (n,) the clock had been set back by each line (n,)."""
        return np.searchsorted(self.set_back_lines, line, side="right")


SERIES = {
    "fixes": Fixes,
    "ground": GroundSpeed,
    "heading": TrueHeading,
    "compass": MagneticHeading,
    "water": WaterSpeed,
    "bottom": BottomTrack,
    "turn": RateOfTurn,
}
