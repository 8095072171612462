"""A log of own ship's instruments: one series per kind of reading, with its times.

Times are UTC seconds since 1970, angles radians clockwise from north, speeds m/s.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from wakeline._brief import brief, many, span
from wakeline._checks import at_least
from wakeline._engine.navigation import LocalPlane

from ..model import OwnShipMotion

if TYPE_CHECKING:
    from typing_extensions import Self


@dataclass(frozen=True)
class Series:
    """Readings of one kind.

    Rows are in order of time within each section between clock set-backs.

    Attributes
    ----------
    time_s : ndarray (n,)
        UTC seconds.
    valid : ndarray of bool (n,)
        Whether the instrument marks the reading as valid.
    sentence : ndarray of str (n,)
        Kind of the sentence, such as ``RMC``.
    line : ndarray of int (n,)
        Line of the file.
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
        """Mask (n,) of the readings to use."""
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
    """Satellite positions, one per time (RMC, GGA, GNS, GLL).

    Attributes
    ----------
    latitude_deg, longitude_deg : ndarray (n,)
        WGS84, positive north and east.
    quality : ndarray of int (n,)
        As in GGA: 0 none, 1 autonomous, 2 differential (also 9 of a GGA), 3 precise, 4 RTK, 5 RTK
        float, 6 estimated, 7 manual input, 8 simulated; -1 not given. `valid` is false for 0, 6 and
        7, for status V, and where either cannot be read. For GNS it is the best of the modes.
    hdop : ndarray (n,)
        Horizontal dilution of precision, NaN where not given.
    frozen : ndarray of bool (n,)
        The position repeats that of the previous fix although the vessel moves.
    suspect : ndarray of bool (n,)
        At latitude 0, longitude 0, or out of the vessel's reach: a single fix, or several after
        which the track returns to where it could have gone without them.
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

    @property
    def latitude_rad(self) -> np.ndarray:
        """Latitude (n,) in radians."""
        return np.radians(self.latitude_deg)

    @property
    def longitude_rad(self) -> np.ndarray:
        """Longitude (n,) in radians."""
        return np.radians(self.longitude_deg)

    def plane(self) -> LocalPlane:
        """The plane about the first fix."""
        return LocalPlane(latitude_rad=self.latitude_rad[0], longitude_rad=self.longitude_rad[0])


@dataclass(frozen=True, repr=False)
class GroundSpeed(Series):
    """Speed and course over ground, one per time (RMC, VTG).

    Attributes
    ----------
    speed_mps, course_rad : ndarray (n,)
        NaN where only the other is given. Course from true north in [0, 2 pi).
    frozen : ndarray of bool (n,)
        Speed and course repeat the previous reading, and so does the position of their fix, which
        is frozen or suspect.
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
    """True heading (HDT, THS, VHW; from a magnetic compass where these are missing).

    Attributes
    ----------
    heading_rad : ndarray (n,)
        In [0, 2 pi).
    """

    heading_rad: np.ndarray


@dataclass(frozen=True, repr=False)
class MagneticHeading(Series):
    """Magnetic heading (HDG, HDM, VHW), corrected for deviation if the sentence gives it.

    Attributes
    ----------
    heading_magnetic_rad : ndarray (n,)
        In [0, 2 pi).
    variation_rad : ndarray (n,)
        Positive east; NaN if neither the log nor the caller gives it.
    """

    heading_magnetic_rad: np.ndarray
    variation_rad: np.ndarray

    @property
    def heading_rad(self) -> np.ndarray:
        """True heading (n,) in [0, 2 pi); NaN where the variation is unknown."""
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
    """Speed over ground by Doppler log (VBW).

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


@dataclass(frozen=True, repr=False)
class ImuReadings(Series):
    """Readings of an inertial measurement unit, gravity removed (`read_imu`; NMEA 0183 has none).

    Each is the mean since the reading before it.

    Attributes
    ----------
    forward_mps2, starboard_mps2 : ndarray (n,)
        Acceleration along and across the hull.
    yaw_rate_rad_s : ndarray (n,)
        Positive to starboard.
    """

    forward_mps2: np.ndarray
    starboard_mps2: np.ndarray
    yaw_rate_rad_s: np.ndarray


@dataclass(frozen=True)
class NmeaProblem:
    """A problem in a log.

    Attributes
    ----------
    line : int
        Line of the file, from 1.
    kind : str
        A key of `NmeaReport.problems`.
    reason : str
        What was expected and what came.
    """

    line: int
    kind: str
    reason: str

    def __str__(self) -> str:
        return f"line {self.line}: {self.kind}: {self.reason}"


@dataclass
class NmeaReport:
    """Contents of a log and the problems in it.

    Attributes
    ----------
    lines : int
        Lines of the file.
    sentences : Counter of str
        Valid sentences by kind, such as ``RMC``, including unused kinds.
    problems : Counter of str
        Number of problems of each kind. A sentence is dropped for ``no sentence`` (text without
        ``$``), ``cut`` (its end is missing), ``checksum``, ``character`` (a non-printable octet),
        ``address`` (not talker and kind) and ``time`` (a time that leaps and returns). With a
        ``field`` that cannot be read or out of ``range`` only that value is dropped, unless it is
        the time or the position; with a ``date`` that leaps and returns, only the date.
    examples : list of NmeaProblem
        Problems in order of lines, at most `max_examples`.
    repeated : int
        Fixes and ground speeds of a time that another sentence has given already.
    displaced_lines : list of int
        Lines of those valid fixes that were dropped although another sentence of their kind gives
        a different position at that time.
    other_speed_lines : list of int
        Lines of those valid ground speeds that were dropped although another sentence of their
        kind gives a different speed at that time.
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
        """Count a problem, and store it up to `max_examples`."""
        self.problems[kind] += 1
        if len(self.examples) < self.max_examples:
            self.examples.append(NmeaProblem(line, kind, reason))


@dataclass(frozen=True)
class NavigationLog:
    """The readings of own ship's instruments.

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
    imu : ImuReadings
    dated : bool
        Whether the log or the caller gives the day; otherwise times count from the midnight before
        the first.
    set_back_lines : ndarray of int (k,)
        Lines where the clock was set back.
    report : NmeaReport
    notes : list of str
        Notes for the user of the log; empty for a clean one.
    """

    name: str
    fixes: Fixes
    ground: GroundSpeed
    heading: TrueHeading
    compass: MagneticHeading
    water: WaterSpeed
    bottom: BottomTrack
    turn: RateOfTurn
    imu: ImuReadings
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
        at_least(0, longer_than_s=longer_than_s)
        fixes = self.fixes.sound()
        wide = np.flatnonzero(np.diff(fixes.time_s) > longer_than_s)
        return np.column_stack([fixes.time_s[wide], fixes.time_s[wide + 1]])

    def fixes_in_order(self, what: str) -> Fixes:
        """Usable fixes, at least one, with a clock that was never set back.

        Raises
        ------
        ValueError
            When there is none or the clock was set back; the message names what needs them.
        """
        fixes = self.fixes.sound()
        if len(fixes) == 0:
            raise ValueError(f"{self.name}: a {what} needs a usable fix, got none")
        if len(self.set_back_lines):
            raise ValueError(
                f"{self.name}: the clock was set back, so that times do not increase; "
                f"use the {what} of each of parts()"
            )
        return fixes

    def track(self, plane: LocalPlane | None = None) -> OwnShipMotion:
        """Own ship's track: usable fixes, with the velocities reported with them.

        Gaps are interpolated. For a log in several parts use the track of each of `parts`.

        Parameters
        ----------
        plane : LocalPlane, optional
            Default: about the first usable fix.

        Returns
        -------
        OwnShipMotion
            Velocities are NaN at fixes without one, and zero at rest without a course.

        Raises
        ------
        ValueError
            When there is no usable fix, or the clock was set back.
        """
        fixes, ground = self.fixes_in_order("track"), self.ground.sound()
        place = {"latitude_rad": fixes.latitude_rad, "longitude_rad": fixes.longitude_rad}
        plane = plane or fixes.plane()
        speed_mps, course_rad = np.full((2, len(fixes)), np.nan)
        _, of_fix, of_ground = np.intersect1d(fixes.time_s, ground.time_s, return_indices=True)
        speed_mps[of_fix] = ground.speed_mps[of_ground]
        course_rad[of_fix] = ground.course_rad[of_ground]
        course_rad[speed_mps == 0] = 0.0
        course_rad = plane.plane_course_rad(course_rad, **place)
        return OwnShipMotion(
            fixes.time_s,
            *plane.position_m(**place).T,
            vnorth_mps=speed_mps * np.cos(course_rad),
            veast_mps=speed_mps * np.sin(course_rad),
        )

    def parts(self, max_gap_s: float = 60.0) -> list[NavigationLog]:
        """The log, split where all instruments are silent for longer than `max_gap_s`.

        It is also split where the clock was set back, so that times increase in each part. All
        parts share the report and the notes.

        Parameters
        ----------
        max_gap_s : float

        Raises
        ------
        ValueError
            When it is negative.
        """
        at_least(0, max_gap_s=max_gap_s)
        of_series = {name: self._section(s.line) for name, s in self.series.items()}
        section = np.concatenate(list(of_series.values()))
        time_s = np.concatenate([s.time_s for s in self.series.values()])
        order = np.lexsort((time_s, section))
        section, time_s = section[order], time_s[order]
        cuts = np.flatnonzero((np.diff(time_s) > max_gap_s) | (np.diff(section) > 0)) + 1
        edges = [0, *cuts.tolist(), len(section)]
        return [
            self._part(of_series, section[start], time_s[start], time_s[end - 1])
            for start, end in itertools.pairwise(edges)
            if start < end
        ]

    def _part(
        self, of_series: dict[str, np.ndarray], section: int, start_s: float, end_s: float
    ) -> NavigationLog:
        inside = {}
        for name, s in self.series.items():
            low, high = np.searchsorted(of_series[name], [section, section + 1])
            time_s = s.time_s[low:high]
            first = low + np.searchsorted(time_s, start_s)
            inside[name] = s.rows(slice(first, low + np.searchsorted(time_s, end_s, side="right")))
        return dataclasses.replace(self, **inside, set_back_lines=np.zeros(0, dtype=np.int64))

    def _section(self, line: np.ndarray) -> np.ndarray:
        """Number (n,) of clock set-backs before each line (n,)."""
        return np.searchsorted(self.set_back_lines, line, side="right")


SERIES = {
    "fixes": Fixes,
    "ground": GroundSpeed,
    "heading": TrueHeading,
    "compass": MagneticHeading,
    "water": WaterSpeed,
    "bottom": BottomTrack,
    "turn": RateOfTurn,
    "imu": ImuReadings,
}
