"""AIS position reports from CSV: the tracks of vessels in a local plane."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from wakeline._brief import brief, counted, many, span
from wakeline._checks import above_zero, at_least, columns
from wakeline._engine.navigation import LocalPlane
from wakeline._units import KNOT_MPS

from .errors import RecordingError
from .reach import plane_stretch, unreachable
from .table import TIME_NAMES, Table, finding_columns, is_missing

COLUMNS = {
    "time": (
        *TIME_NAMES,
        "t",
        "basedatetime",
        "base_date_time",
        "date_time",
        "date_time_utc",
        "datetime_utc",
        "timestamp_utc",
        "received_at",
    ),
    "mmsi": ("mmsi", "sourcemmsi", "source_mmsi", "shipid", "ship_id", "vessel_id"),
    "latitude": ("latitude_degrees", "latitude_deg", "latitude", "lat_deg", "lat"),
    "longitude": ("longitude_degrees", "longitude_deg", "longitude", "lon_deg", "lon", "long"),
    "cog": (
        *("cog_degrees", "cog_deg", "cog"),
        *("course_over_ground", "courseoverground", "course_deg", "course"),
    ),
    "sog": (
        *("sog_knots", "sog_kn", "sog"),
        *("speed_over_ground", "speedoverground", "speed_knots", "speed_kn"),
    ),
    "sog_mps": ("sog_mps", "speed_mps"),
    "speed": ("speed",),
}
_KNOTS_BY = ("t", ("shipid", "ship_id", "vessel_id"))  # names of the Piraeus set, in knots
_LIKE_MOTION = re.compile(r"speed|sog|velocity|course|cog|heading_over_ground", re.IGNORECASE)
_UNITS_MPS = {"m/s": 1.0, "knots": KNOT_MPS, "km/h": 1.0 / 3.6, "tenths of a knot": 0.1 * KNOT_MPS}
_UNIT_WITHIN, _LEAST_STEPS, _LONGEST_STEP_S = 1.25, 3, 600.0

_FAR_M = 500e3  # where the plane stretches distances by a thousandth

_NO_LATITUDE_DEG, _NO_LONGITUDE_DEG = 91.0, 181.0
_NO_COURSE_DEG, _NO_SPEED_KN = 360.0, 102.15  # 102.2 means as much or more
_LARGEST_COURSE_DEG, _LARGEST_SPEED_KN = 410.0, 102.4  # that the fields of a message can hold


@dataclass(frozen=True)
class AisTrack:
    """The reports of one vessel, sorted by time.

    Attributes
    ----------
    mmsi : str
        Its number.
    time_s : ndarray (n,)
        UTC seconds of reception, in order; reception may be a second or two after transmission.
    north_m, east_m : ndarray (n,)
        In the local plane.
    course_rad, speed_mps : ndarray (n,)
        Over ground, in the local plane; NaN where not reported.

    Raises
    ------
    ValueError
        When a column's length differs from that of the times, or the times are not finite and in
        order.
    TypeError
        When a column holds text.
    """

    mmsi: str
    time_s: np.ndarray
    north_m: np.ndarray
    east_m: np.ndarray
    course_rad: np.ndarray
    speed_mps: np.ndarray

    def __post_init__(self) -> None:
        columns(self, "time_s", "north_m", "east_m", "course_rad", "speed_mps")

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
        """The track, split at gaps longer than `max_gap_s`.

        Parameters
        ----------
        max_gap_s : float
        min_reports : int
            Parts with fewer reports are dropped.

        Raises
        ------
        ValueError
            When a parameter is negative.
        """
        at_least(0, max_gap_s=max_gap_s, min_reports=min_reports)
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
        Dropped reports and the reasons.
    """

    plane: LocalPlane
    tracks: dict[str, AisTrack]
    notes: list[str] = field(default_factory=list)

    def __repr__(self) -> str:
        reports = sum(map(len, self.tracks.values()))
        when = span(*(track.time_s for track in self.tracks.values()))
        return brief(self, many(len(self.tracks), "track"), many(reports, "report"), when)


@finding_columns
def read_ais(
    path: str | Path,
    *,
    origin_deg: tuple[float, float] | None = None,
    min_step_s: float = 1.0,
    max_speed_mps: float = 40.0,
    columns: Mapping[str, str] | None = None,
) -> AisRecording:
    """Read AIS position reports.

    Columns, by these or similar names: ``Time`` (UTC), ``MMSI``, ``Latitude_degrees``,
    ``Longitude_degrees`` (WGS84) and, optionally, ``COG_degrees`` (true) and ``SOG_knots`` or
    ``SOG_mps``. The names in the sets of the Danish Maritime Authority, MarineCadastre, Brest,
    Kystverket, Piraeus and Global Fishing Watch are known. A ``speed`` without a unit is in the one
    in which it agrees with the positions; without such a unit it is not used. Notes report it, and
    other columns that look like a speed or course. Rows need not be sorted.

    The AIS values for "not available" (latitude 91, longitude 181, course 360, speed 102.3, and
    102.2 for "or higher") and impossible courses and speeds are missing values. Dropped are rows
    that cannot be read, reports without a position, late reports (the earlier one of two reports
    closer together than `min_step_s`), and positions that the vessel cannot reach at
    `max_speed_mps`.

    The plane is for one area: a note reports positions more than 500 km from its origin, and by how
    much distances across are too long there.

    Parameters
    ----------
    path : str or Path
        The file.
    origin_deg : (float, float), optional
        Latitude and longitude of the plane's origin; default the medians of the positions, which
        are robust to outliers.
    min_step_s : float
        Minimum time between reports of a vessel; more frequent ones are thinned.
    max_speed_mps : float
        Maximum speed of a vessel.
    columns : dict of str to str, optional
        Names of columns in this file and which of the names above they are, such as
        ``{"ship": "mmsi", "v": "SOG_mps"}``.

    Returns
    -------
    AisRecording

    Raises
    ------
    RecordingError
        When the file cannot be read, a column is missing, or more than a tenth of the rows cannot
        be read; the message names file, line and column.
    ValueError
        When a parameter is not positive or the origin is not on the earth.
    """
    above_zero(min_step_s=min_step_s, max_speed_mps=max_speed_mps)
    if origin_deg is not None and not (abs(origin_deg[0]) <= 90 and abs(origin_deg[1]) <= 180):
        raise ValueError(
            "origin_deg must be a latitude from -90 to 90 and a longitude from -180 to 180, "
            f"got {origin_deg}"
        )
    notes: list[str] = []
    table = Table(path, COLUMNS, notes, columns)
    table.require("time", "mmsi", "latitude", "longitude")
    time_s = table.times("time")
    mmsi = np.array([number.removesuffix(".0") for number in table.text("mmsi")], dtype=str)
    table.check("mmsi", [not is_missing(number) for number in mmsi.tolist()], "a number")
    latitude_deg = _coordinate(table, "latitude", 90.0, _NO_LATITUDE_DEG)
    longitude_deg = _coordinate(table, "longitude", 180.0, _NO_LONGITUDE_DEG)
    cog_deg = _over_ground(table, "cog", _NO_COURSE_DEG, _LARGEST_COURSE_DEG, notes)
    speed_mps = _speeds_mps(table, notes)
    sound = table.kept()
    placed = np.isfinite(latitude_deg) & np.isfinite(longitude_deg) & sound
    if not placed.any():
        raise RecordingError(table.path, "no report has a position", wanted="at least one")
    _note(notes, table, sound & ~placed, "report", "without a position")
    if origin_deg is None:
        origin_deg = _median_deg(latitude_deg[placed], longitude_deg[placed])
    plane = LocalPlane(
        latitude_rad=np.radians(origin_deg[0]), longitude_rad=np.radians(origin_deg[1])
    )
    place = {"latitude_rad": np.radians(latitude_deg), "longitude_rad": np.radians(longitude_deg)}
    north_m, east_m = plane.position_m(**place).T
    course_rad = plane.plane_course_rad(np.radians(cog_deg), **place)
    opposite = placed & np.isnan(north_m)
    _note(notes, table, opposite, "report", "on the other side of the earth from the origin")
    vessels = list(_rows_by_vessel(mmsi, time_s, np.flatnonzero(placed & ~opposite)))
    if "speed" in table and not np.isfinite(speed_mps).any():
        speed_mps = _unitless(table, vessels, time_s, north_m, east_m, notes)
    _note_unknown(table, notes)
    tracks: dict[str, AisTrack] = {}
    late, jumped = np.zeros(len(table), dtype=bool), np.zeros(len(table), dtype=bool)
    for number, row in vessels:
        soon = _too_soon(time_s[row], min_step_s)
        late[row[soon]] = True
        row = row[~soon]
        far = unreachable(time_s[row], np.column_stack([north_m, east_m])[row], max_speed_mps)
        jumped[row[far]] = True
        row = row[~far]
        tracks[number] = AisTrack(
            number, time_s[row], north_m[row], east_m[row], course_rad[row], speed_mps[row]
        )
    _note_far(notes, table, np.where(late | jumped, 0.0, np.hypot(north_m, east_m)))
    _note(notes, table, late, "report", f"less than {min_step_s:g} s before the next of the vessel")
    way = f"out of reach of the vessel at {max_speed_mps:g} m/s"
    _note(notes, table, jumped, "report", way)
    return AisRecording(plane, tracks, notes)


def _speeds_mps(table: Table, notes: list[str]) -> np.ndarray:
    """Speeds (n,) over ground from a column with a unit; NaN without one."""
    if "sog_mps" in table:
        largest_mps = _LARGEST_SPEED_KN * KNOT_MPS
        return _over_ground(table, "sog_mps", _NO_SPEED_KN * KNOT_MPS, largest_mps, notes)
    time, vessels = _KNOTS_BY
    piraeus = table.name("time") == time and table.name("mmsi") in vessels
    knots = "speed" if piraeus and "speed" in table else "sog"
    return KNOT_MPS * _over_ground(table, knots, _NO_SPEED_KN, _LARGEST_SPEED_KN, notes)


def _unitless(
    table: Table,
    vessels: Sequence[tuple[str, np.ndarray]],
    time_s: np.ndarray,
    north_m: np.ndarray,
    east_m: np.ndarray,
    notes: list[str],
) -> np.ndarray:
    """Speeds (n,) in the unit in which they agree with the steps between positions."""
    speed, ratios = table.numbers("speed"), []
    for _, row in vessels:
        step_s, given = np.diff(time_s[row]), 0.5 * (speed[row][1:] + speed[row][:-1])
        way_m = np.hypot(np.diff(north_m[row]), np.diff(east_m[row]))
        steps = (step_s > 0.0) & (step_s < _LONGEST_STEP_S) & (given > 1.0)
        ratios.append(way_m[steps] / (step_s * given)[steps])
    ratio = np.concatenate(ratios)
    name, found = table.name("speed"), float(np.median(ratio)) if len(ratio) else np.nan
    for unit, factor in _UNITS_MPS.items():
        if len(ratio) >= _LEAST_STEPS and factor / _UNIT_WITHIN < found < factor * _UNIT_WITHIN:
            notes.append(f"{table.path.name}: {name} is in {unit}, as the positions show")
            return np.where(speed >= 0.0, factor * speed, np.nan)
    notes.append(
        f"{table.path.name}: no speed is used, because the unit of {name} is not known; name it "
        f"with columns: {name}=SOG_knots or {name}=SOG_mps"
    )
    return np.full(len(speed), np.nan)


def _note_unknown(table: Table, notes: list[str]) -> None:
    """Note columns that are not known but look like speed or course."""
    alike = [name for name in table.unknown() if _LIKE_MOTION.search(name)]
    if alike and not ("cog" in table and {"sog", "sog_mps", "speed"} & set(table.columns)):
        notes.append(
            f"{table.path.name}: {', '.join(alike)} not used; if it is the course or speed over "
            f"ground, name it with columns: {alike[0]}=COG_degrees, SOG_knots or SOG_mps"
        )


def _rows_by_vessel(
    mmsi: np.ndarray, time_s: np.ndarray, row: np.ndarray
) -> Iterator[tuple[str, np.ndarray]]:
    """Each vessel, in order of first report, with its rows in order of time."""
    numbers, first, vessel = np.unique(mmsi[row], return_index=True, return_inverse=True)
    order = np.lexsort((time_s[row], vessel))
    rows = np.split(row[order], np.flatnonzero(np.diff(vessel[order])) + 1)
    for k in np.argsort(first).tolist():
        yield str(numbers[k]), rows[k]


def _coordinate(table: Table, column: str, largest_deg: float, missing_deg: float) -> np.ndarray:
    """Latitudes or longitudes (n,); NaN where not available."""
    values = table.numbers(column)
    absent = np.isnan(values) | (values == missing_deg)
    good = absent | (np.abs(values) <= largest_deg)
    table.check(column, good, f"a number from {-largest_deg:g} to {largest_deg:g}")
    return np.where(absent | ~good, np.nan, values)


def _over_ground(
    table: Table, column: str, missing: float, largest: float, notes: list[str]
) -> np.ndarray:
    """Courses or speeds (n,); NaN from `missing` on and below zero."""
    if column not in table:
        return np.full(len(table), np.nan)
    values = table.numbers(column)
    good = np.isnan(values) | (np.abs(values) <= largest)
    table.check(column, good, f"a number from 0 to {largest:g}")
    odd = good & ((values < 0.0) | (values > _NO_COURSE_DEG))
    _note(notes, table, odd, "value", f"of {table.name(column)} impossible for a vessel")
    return np.where((values < 0.0) | (values >= missing), np.nan, values)


def _median_deg(latitude_deg: np.ndarray, longitude_deg: np.ndarray) -> tuple[float, float]:
    """Medians of the latitudes and of the longitudes, on whichever side of 180 degrees."""
    mean_deg = np.degrees(np.angle(np.exp(1j * np.radians(longitude_deg)).sum()))
    east_deg = (longitude_deg - mean_deg + 180.0) % 360.0 - 180.0
    median_deg = mean_deg + np.median(east_deg)
    return float(np.median(latitude_deg)), float((median_deg + 180.0) % 360.0 - 180.0)


def _too_soon(time_s: np.ndarray, min_step_s: float) -> np.ndarray:
    """Mask (n,) of reports less than a step before the next one that is kept."""
    soon = np.zeros(len(time_s), dtype=bool)
    if np.all(np.diff(time_s) >= min_step_s):
        return soon
    kept_s = np.inf
    for k in reversed(range(len(time_s))):
        soon[k] = kept_s - time_s[k] < min_step_s
        if not soon[k]:
            kept_s = time_s[k]
    return soon


def _note(notes: list[str], table: Table, rows: np.ndarray, noun: str, what: str) -> None:
    if rows.any():
        notes.append(
            f"{table.path.name}: {many(np.count_nonzero(rows), noun)} {what} left out "
            f"(first in line {table.line(int(np.argmax(rows)))})"
        )


def _note_far(notes: list[str], table: Table, distance_m: np.ndarray) -> None:
    """Note reports (n,) too far from the origin of the plane."""
    far = np.nan_to_num(distance_m) > _FAR_M
    if far.any():
        farthest_m = float(distance_m[far].max())
        notes.append(
            f"{table.path.name}: {counted(np.count_nonzero(far), '[report is|reports are]')} "
            f"more than {_FAR_M / 1e3:.0f} km from the origin of the plane (first in line "
            f"{table.line(int(np.argmax(far)))}); distances across are too long by "
            f"{100.0 * plane_stretch(farthest_m):.1f} % at {farthest_m / 1e3:.0f} km; cut the file "
            "to one area"
        )
