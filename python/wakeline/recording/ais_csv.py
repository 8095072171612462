"""AIS position reports from CSV: the tracks of vessels in a local plane."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from wakeline._brief import brief, many, span
from wakeline._units import KNOT_MPS

from .errors import RecordingError
from .local_plane import LocalPlane
from .reach import unreachable
from .table import Table

COLUMNS = {
    "time": ("time", "time_s", "time_utc", "timestamp", "basedatetime", "base_date_time", "utc"),
    "mmsi": ("mmsi",),
    "latitude": ("latitude_degrees", "latitude_deg", "latitude", "lat_deg", "lat"),
    "longitude": ("longitude_degrees", "longitude_deg", "longitude", "lon_deg", "lon"),
    "cog": ("cog_degrees", "cog_deg", "cog", "course_over_ground"),
    "sog": ("sog_knots", "sog_kn", "sog", "speed_over_ground"),
}

_NO_LATITUDE_DEG, _NO_LONGITUDE_DEG = 91.0, 181.0
_NO_COURSE_DEG, _NO_SPEED_KN = 360.0, 102.25


@dataclass(frozen=True)
class AisTrack:
    """The reports of one vessel, sorted by time.

    Attributes
    ----------
    mmsi : str
        Its number.
    time_s : ndarray (n,)
        UTC seconds, increasing: of reception, which is at times a second or two after sending.
    north_m, east_m : ndarray (n,)
        In the local plane.
    course_rad, speed_mps : ndarray (n,)
        Over ground, in the local plane; NaN where not reported.
    """

    mmsi: str
    time_s: np.ndarray
    north_m: np.ndarray
    east_m: np.ndarray
    course_rad: np.ndarray
    speed_mps: np.ndarray

    def __len__(self) -> int:
        return len(self.time_s)

    def __repr__(self) -> str:
        return brief(self, many(len(self), "report"), span(self.time_s), name=self.mmsi)

    @property
    def vnorth_mps(self) -> np.ndarray:
        """Reported velocity (n,), NaN where not reported; zero at rest without a course."""
        return self._component(np.cos)

    @property
    def veast_mps(self) -> np.ndarray:
        """As :attr:`vnorth_mps`."""
        return self._component(np.sin)

    def parts(self, max_gap_s: float = 60.0, min_reports: int = 2) -> list[AisTrack]:
        """The track cut where nothing was heard for longer than `max_gap_s`.

        Parameters
        ----------
        max_gap_s : float
        min_reports : int
            Shorter parts are left out.
        """
        cuts = np.flatnonzero(np.diff(self.time_s) > max_gap_s) + 1
        edges = [0, *cuts.tolist(), len(self)]
        parts = [self.rows(slice(a, b)) for a, b in itertools.pairwise(edges)]
        return [part for part in parts if len(part) >= min_reports]

    def rows(self, which: slice | np.ndarray) -> AisTrack:
        """Some of the reports, by slice, index or mask."""
        names = ("time_s", "north_m", "east_m", "course_rad", "speed_mps")
        return replace(self, **{name: getattr(self, name)[which] for name in names})

    def _component(self, part) -> np.ndarray:
        return np.where(self.speed_mps == 0, 0.0, self.speed_mps * part(self.course_rad))


@dataclass(frozen=True)
class AisRecording:
    """Tracks of all vessels of a file.

    Attributes
    ----------
    plane : LocalPlane
        Where north 0, east 0 is.
    tracks : dict of str to AisTrack
        By MMSI, in order of their first report.
    notes : list of str
        What was left out, and why.
    """

    plane: LocalPlane
    tracks: dict[str, AisTrack]
    notes: list[str] = field(default_factory=list)

    def __repr__(self) -> str:
        reports = sum(map(len, self.tracks.values()))
        when = span(*(track.time_s for track in self.tracks.values()))
        return brief(self, many(len(self.tracks), "track"), many(reports, "report"), when)


def read_ais(
    path: str | Path,
    *,
    origin_deg: tuple[float, float] | None = None,
    min_step_s: float = 1.0,
    max_speed_mps: float = 40.0,
) -> AisRecording:
    """Read AIS position reports.

    Columns, by these or like names: ``Time`` (UTC), ``MMSI``, ``Latitude_degrees``,
    ``Longitude_degrees`` (WGS84) and, where known, ``COG_degrees`` (true) and ``SOG_knots``. Rows
    need not be sorted. What AIS sends for "not available" (latitude 91, longitude 181, course 360,
    speed 102.3) is taken as that: a report without position is left out. Left out are, too, of
    reports of a vessel closer together than `min_step_s` the earlier ones, which came late, and
    positions that it cannot have come to from those before at `max_speed_mps`.

    Parameters
    ----------
    path : str or Path
        The file.
    origin_deg : (float, float), optional
        Latitude and longitude of the origin of the plane; default the middle of the positions.
    min_step_s : float
        Least time between reports of a vessel.
    max_speed_mps : float
        No vessel is faster.

    Returns
    -------
    AisRecording

    Raises
    ------
    RecordingError
        Naming file, line and column, when the file cannot be read, a column is missing, or a cell
        is not what it should be.
    ValueError
        When a parameter is not positive or the origin is not on the earth.
    """
    if not (min_step_s > 0 and max_speed_mps > 0):
        raise ValueError(
            f"min_step_s and max_speed_mps must be positive, got {min_step_s} and {max_speed_mps}"
        )
    table = Table(path, COLUMNS)
    table.require("time", "mmsi", "latitude", "longitude")
    time_s = table.times("time")
    mmsi = np.array(table.text("mmsi"))
    table.check("mmsi", np.char.str_len(mmsi) > 0 if len(mmsi) else np.zeros(0), "a number")
    latitude_deg = _checked(table, "latitude", -90.0, 90.0, _NO_LATITUDE_DEG)
    longitude_deg = _checked(table, "longitude", -180.0, 180.0, _NO_LONGITUDE_DEG)
    cog_deg = _checked(table, "cog", 0.0, _NO_COURSE_DEG, _NO_COURSE_DEG)
    sog_kn = _checked(table, "sog", 0.0, 102.4, _NO_SPEED_KN)
    placed = np.isfinite(latitude_deg) & np.isfinite(longitude_deg)
    if not placed.any():
        raise RecordingError(table.path, "no report has a position", wanted="at least one")
    notes: list[str] = []
    _note(notes, table, ~placed, "without a position")
    if origin_deg is None:
        origin_deg = (
            float(np.mean([latitude_deg[placed].min(), latitude_deg[placed].max()])),
            float(np.mean([longitude_deg[placed].min(), longitude_deg[placed].max()])),
        )
    plane = LocalPlane(*origin_deg)
    north_m, east_m = plane.position_m(latitude_deg, longitude_deg)
    course_rad = plane.course_rad(np.radians(cog_deg), latitude_deg, longitude_deg)
    tracks: dict[str, AisTrack] = {}
    late, jumped = np.zeros(len(table), dtype=bool), np.zeros(len(table), dtype=bool)
    for number in dict.fromkeys(mmsi[placed].tolist()):
        row = np.flatnonzero(placed & (mmsi == number))
        row = row[np.argsort(time_s[row], kind="stable")]
        soon = np.append(np.diff(time_s[row]) < min_step_s, False)
        late[row[soon]] = True
        row = row[~soon]
        far = unreachable(time_s[row], np.column_stack([north_m, east_m])[row], max_speed_mps)
        jumped[row[far]] = True
        row = row[~far]
        tracks[number] = AisTrack(
            number, time_s[row], north_m[row], east_m[row], course_rad[row], sog_kn[row] * KNOT_MPS
        )
    _note(notes, table, late, f"less than {min_step_s:g} s before the next of the vessel")
    _note(notes, table, jumped, f"farther off than a vessel gets at {max_speed_mps:g} m/s")
    return AisRecording(plane, tracks, notes)


def _checked(table: Table, column: str, low: float, high: float, missing: float) -> np.ndarray:
    """Numbers (n,) of a column that lie in an interval; NaN for what stands for "not available"."""
    if column not in table:
        return np.full(len(table), np.nan)
    values = table.numbers(column)
    absent = values >= missing if column == "sog" else values == missing
    with np.errstate(invalid="ignore"):
        good = np.isnan(values) | absent | ((values >= low) & (values <= high))
    table.check(column, good, f"a number from {low:g} to {high:g}")
    return np.where(absent, np.nan, values)


def _note(notes: list[str], table: Table, rows: np.ndarray, what: str) -> None:
    if rows.any():
        notes.append(
            f"{table.path.name}: {np.count_nonzero(rows)} reports {what} left out "
            f"(first in line {table.line(int(np.argmax(rows)))})"
        )
