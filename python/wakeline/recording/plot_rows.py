"""The rows of a plots file: columns known by name, cells checked, metres and radians."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from wakeline._brief import counted, cut
from wakeline._units import NAUTICAL_MILE_M

from .errors import RecordingError
from .scans import grouped, out_of_order, repeated, unwrapped
from .table import TIME_NAMES, Table
from .units import unit_notes

COLUMNS = {
    "time_s": TIME_NAMES,
    "scan": ("scan", "scan_number", "scan_id"),
    "scenario": ("scenario",),
    "north_m": ("north_m",),
    "east_m": ("east_m",),
    "range_m": ("range_m", "distance_m"),
    "range_nm": ("range_nm", "distance_nm"),
    "bearing_deg": ("bearing_deg", "azimuth_deg"),
    "bearing_rad": ("bearing_rad", "azimuth_rad"),
    "own_north_m": ("own_north_m",),
    "own_east_m": ("own_east_m",),
}

_MEASUREMENT_WANTED = (
    "north_m and east_m, or range_m (or range_nm) and bearing_deg (or bearing_rad, azimuth_deg, "
    "azimuth_rad)"
)

_BACK_S = 60.0
_PUT_IN_ORDER = (
    "sorted that [is|are] more than a minute earlier than the row above: if a clock was set back "
    "or restarted at midnight, cut the file there"
)


@dataclass(frozen=True)
class PlotRows:
    """Rows of a plots file, in the order of the file.

    Attributes
    ----------
    table : Table or None
        The file, to name lines in errors; None without a file.
    row : ndarray of int (n,)
        Row of the file behind each entry.
    scenario : ndarray of str (n,)
        '' if the file has no scenario column.
    scan : ndarray of int (n,) or None
    time_s : ndarray (n,)
    place : ndarray (n, 2)
        North and east in metres, or range in metres and bearing in radians; NaN where not finite.
    polar : bool
        Whether `place` is range and bearing.
    own_m : ndarray (n, 2) or None
        Own position with each plot, if the file has it.
    """

    table: Table | None
    row: np.ndarray
    scenario: np.ndarray
    scan: np.ndarray | None
    time_s: np.ndarray
    place: np.ndarray
    polar: bool
    own_m: np.ndarray | None

    def __len__(self) -> int:
        return len(self.row)

    @classmethod
    def none(cls) -> PlotRows:
        """No rows."""
        return cls(
            table=None,
            row=np.zeros(0, dtype=int),
            scenario=np.zeros(0, dtype=str),
            scan=None,
            time_s=np.zeros(0),
            place=np.zeros((0, 2)),
            polar=False,
            own_m=None,
        )

    def where(self, chosen: np.ndarray) -> PlotRows:
        """The chosen rows, by mask or by index."""
        return PlotRows(
            table=self.table,
            row=self.row[chosen],
            scenario=self.scenario[chosen],
            scan=None if self.scan is None else self.scan[chosen],
            time_s=self.time_s[chosen],
            place=self.place[chosen],
            polar=self.polar,
            own_m=None if self.own_m is None else self.own_m[chosen],
        )


def read_plot_rows(
    path: str | Path, notes: list[str], columns: Mapping[str, str] | None = None
) -> PlotRows:
    """Read the rows of a plots file.

    Parameters
    ----------
    path : str or Path
        The file.
    notes : list of str
        Notes are added to it: rows that cannot be read (dropped), times that go back, repeated rows
        (dropped), no plots.
    columns : dict of str to str, optional
        Names of columns in this file and what they are.

    Raises
    ------
    RecordingError
        When a column is missing or more than a tenth of the rows cannot be read.
    """
    table = Table(path, COLUMNS, notes, columns)
    table.require("time_s")
    place, polar = _places(table, notes)
    scenario = table.text("scenario") if "scenario" in table else [""] * len(table)
    rows = PlotRows(
        table=table,
        row=np.arange(len(table)),
        scenario=np.array(scenario, dtype=str),
        scan=table.whole_numbers("scan") if "scan" in table else None,
        time_s=table.times("time_s"),
        place=place,
        polar=polar,
        own_m=_own_beside(table),
    )
    if rows.scan is not None:
        scan = number_scans(table, rows.scenario, rows.scan, rows.time_s, within=True)
        rows = dataclasses.replace(rows, scan=scan)
    rows = rows.where(table.kept())
    if polar:
        names = [_name_of(table, quantity) for quantity in ("range", "bearing")]
        notes += [f"{table.path.name}: {note}" for note in unit_notes(rows.place, *names)]
    if len(rows) == 0:
        notes.append(f"{table.path.name}: no plots")
    if rows.scan is None:
        remark(rows, _set_back(rows), _PUT_IN_ORDER, notes)
    return _without_repeats(rows, notes)


def number_scans(
    table: Table,
    scenario: np.ndarray | None,
    scan: np.ndarray,
    time_s: np.ndarray,
    *,
    within: bool,
) -> np.ndarray:
    """Scan numbers (n,) by scenario, continued where their counter begins again.

    Rows whose times contradict the numbers of the others are marked in the table, if they are few.
    With `within` a scan may have several rows.
    """
    scan = scan.copy()
    sound = np.flatnonzero(table.sound)
    names = np.zeros(len(scan), dtype=str) if scenario is None else scenario
    for _, part in grouped(names[sound]):
        rows = sound[part]
        scan[rows] = unwrapped(scan[rows], time_s[rows])
        astray = rows[out_of_order(scan[rows], time_s[rows], within=within)]
        wanted = "times that increase with the scan numbers"
        table.reject(astray, "time_s", wanted, "the time does not fit the scan")
    return scan


def remark(rows: PlotRows, chosen: np.ndarray, what: str, notes: list[str]) -> None:
    """Add a counted note about the chosen rows (mask), if there are any."""
    if chosen.any():
        first = rows.table.line(int(rows.row[np.argmax(chosen)]))
        count = np.count_nonzero(chosen)
        note = counted(int(count), f"[plot|plots] {what}")
        notes.append(f"{rows.table.path.name}: {note} (first in line {first})")


def _places(table: Table, notes: list[str]) -> tuple[np.ndarray, bool]:
    """Measured positions (n, 2), NaN where not finite, and whether they are polar."""
    _at_most_one(table, ("range_m", "range_nm"))
    _at_most_one(table, ("bearing_deg", "bearing_rad"))
    cartesian = "north_m" in table and "east_m" in table
    polar = ("range_m" in table or "range_nm" in table) and (
        "bearing_deg" in table or "bearing_rad" in table
    )
    if cartesian and polar:
        notes.append(f"{table.path.name}: north and east are used, range and bearing are ignored")
    if cartesian:
        columns = [table.ways_m("north_m"), table.ways_m("east_m")]
    elif polar:
        columns = [_ranges_m(table), _bearings_rad(table)]
    else:
        raise RecordingError(
            table.path,
            "a column is missing",
            line=1,
            wanted=_MEASUREMENT_WANTED,
            got=cut(", ".join(table.header)),
        )
    place = np.column_stack(columns)
    place[~np.isfinite(place).all(axis=1)] = np.nan
    return place, not cartesian


def _name_of(table: Table, quantity: str) -> str:
    """Name in the file of the column of ranges or bearings."""
    return next(table.name(c) for c in COLUMNS if c.startswith(quantity) and c in table)


def _at_most_one(table: Table, columns: Sequence[str]) -> None:
    present = [table.name(c) for c in columns if c in table]
    if len(present) > 1:
        raise RecordingError(
            table.path,
            "a column is repeated in another unit",
            line=1,
            column=present[1],
            wanted="one of them",
            got=" and ".join(present),
        )


def _ranges_m(table: Table) -> np.ndarray:
    column = "range_m" if "range_m" in table else "range_nm"
    range_m = table.ways_m(column, 1.0 if column == "range_m" else NAUTICAL_MILE_M)
    table.check(column, ~(range_m < 0), "a range of 0 or more")
    return range_m


def _bearings_rad(table: Table) -> np.ndarray:
    """Bearings from north; anything beyond one turn either way is an error."""
    if "bearing_deg" in table:
        values = table.numbers("bearing_deg")
        table.check("bearing_deg", ~(np.abs(values) > 360.0), "a bearing from -360 to 360 degrees")
        return np.deg2rad(values)
    values = table.numbers("bearing_rad")
    sense = ~(np.abs(values) > 2.0 * np.pi)
    table.check("bearing_rad", sense, "a bearing from -2 pi to 2 pi radians")
    return values


def _own_beside(table: Table) -> np.ndarray | None:
    if "own_north_m" not in table and "own_east_m" not in table:
        return None
    names = ("own_north_m", "own_east_m")
    table.require(*names)
    own_m = np.column_stack([table.ways_m(name) for name in names])
    for name, way_m in zip(names, own_m.T, strict=True):
        table.check(name, np.isfinite(way_m), "a finite number")
    return own_m


def _set_back(rows: PlotRows) -> np.ndarray:
    """Mask (n,) of rows that are much earlier than the row before them, of the same scenario."""
    back = np.diff(rows.time_s, prepend=rows.time_s[:1]) < -_BACK_S
    back[1:] &= rows.scenario[1:] == rows.scenario[:-1]
    return back


def _without_repeats(rows: PlotRows, notes: list[str]) -> PlotRows:
    _, scenario = np.unique(rows.scenario, return_inverse=True)
    scan = rows.scan if rows.scan is not None else np.zeros(len(rows), dtype=int)
    again = repeated(scenario, scan, rows.time_s, *rows.place.T)
    remark(rows, again, "that [repeats|repeat] an earlier row left out", notes)
    return rows.where(~again)
