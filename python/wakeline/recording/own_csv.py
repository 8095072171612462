"""Own ship from CSV: positions of the radar, and the list of scans if the file has one."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from wakeline._brief import many

from .errors import RecordingError
from .model import OwnShipMotion
from .plot_rows import number_scans
from .scans import grouped, repeated
from .table import TIME_NAMES, Table, finding_columns

OWN_GAP_S = 10.0  # longest step that is interpolated across by default
_ROUNDED = 1e-4  # of covariances written to six digits

VELOCITY_COVARIANCE = ("vnorth_var_m2s2", "vnorth_veast_cov_m2s2", "veast_var_m2s2")
COLUMNS = {
    "time_s": TIME_NAMES,
    "scan": ("scan", "scan_number", "scan_id"),
    "scenario": ("scenario",),
    "north_m": ("own_north_m", "north_m"),
    "east_m": ("own_east_m", "east_m"),
    "vnorth_mps": ("own_vnorth_mps", "vnorth_mps"),
    "veast_mps": ("own_veast_mps", "veast_mps"),
    "heading_deg": ("own_heading_deg", "heading_deg"),
    "heading_rad": ("own_heading_rad", "heading_rad"),
    **{name: (name,) for name in VELOCITY_COVARIANCE},
    "status": ("status",),
}


@dataclass(frozen=True)
class OwnRows:
    """Rows of an own-ship file, in the order of the file.

    Attributes
    ----------
    table : Table
        The file, to name lines in errors.
    row : ndarray of int (n,)
        Row of the file behind each entry.
    scenario : ndarray of str (n,) or None
    scan : ndarray of int (n,) or None
        None if the file lists no scans.
    time_s : ndarray (n,)
    columns : dict of str to ndarray (n,)
        ``north_m``, ``east_m`` and, if the file has them, the velocity, ``heading_rad`` and
        ``velocity_m2s2`` (n, 2, 2).
    """

    table: Table
    row: np.ndarray
    scenario: np.ndarray | None
    scan: np.ndarray | None
    time_s: np.ndarray
    columns: dict[str, np.ndarray]

    @property
    def has_position(self) -> bool:
        """Whether the file has own ship's position."""
        return "north_m" in self.columns

    def parts(self, scenarios: Sequence[str]) -> dict[str, OwnRows]:
        """Rows of each scenario; all rows for each when the file has no scenario column."""
        if self.scenario is None:
            return dict.fromkeys(scenarios, self)
        none = dict.fromkeys(scenarios, self._where(np.zeros(0, dtype=int)))
        return none | {name: self._where(rows) for name, rows in grouped(self.scenario)}

    @property
    def placed(self) -> np.ndarray:
        """Mask (n,) of the rows with a finite position."""
        return np.isfinite(self.columns["north_m"]) & np.isfinite(self.columns["east_m"])

    def by_time(self) -> OwnRows:
        """Rows with a finite position, sorted by time; of equal times the last in the file."""
        rows = self._where(self.placed)
        rows = rows._where(np.argsort(rows.time_s, kind="stable"))
        return rows._where(np.append(np.diff(rows.time_s) > 0, True)[: len(rows.time_s)])

    def ship(self) -> OwnShipMotion:
        """These sorted rows as own ship's track."""
        return OwnShipMotion(time_s=self.time_s, **self.columns)

    def lacks(self, time_s: np.ndarray, own_gap_s: float) -> tuple[np.ndarray, str]:
        """Mask of the times (n,) that these sorted rows do not cover, and what they have instead.

        A time may be at most one median step outside of them, and not in a step longer than
        `own_gap_s`. The text is that for the first of them.
        """
        if len(self.row) == 0:
            return np.ones(len(time_s), dtype=bool), "no position at all"
        step_s = np.append(np.diff(self.time_s), 0.0)
        margin_s = min(float(np.median(step_s[:-1])), own_gap_s) if len(step_s) > 1 else 0.0
        outside = (time_s < self.time_s[0] - margin_s) | (time_s > self.time_s[-1] + margin_s)
        before = np.clip(np.searchsorted(self.time_s, time_s) - 1, 0, len(step_s) - 1)
        inside = (time_s > self.time_s[before]) & (step_s[before] > own_gap_s) & ~outside
        inside &= ~np.isin(time_s, self.time_s)
        k = int(np.argmax(outside | inside)) if len(time_s) else 0
        if not inside.any() or outside[k]:
            return outside | inside, f"positions from {self.time_s[0]} to {self.time_s[-1]}"
        line = self.table.line(self.row[before[k]])
        return outside | inside, f"a gap of {step_s[before[k]]:g} s after its line {line}"

    def not_known(
        self, path: str | Path, time_s: float, got: str, **place: int | str
    ) -> RecordingError:
        """The error that `path` needs own ship at a time that these rows lack."""
        return RecordingError(
            path,
            f"own ship is not known at {time_s}",
            wanted=f"a time that {self.table.path} covers",
            got=got,
            **place,
        )

    def _where(self, chosen: np.ndarray) -> OwnRows:
        return OwnRows(
            table=self.table,
            row=self.row[chosen],
            scenario=None if self.scenario is None else self.scenario[chosen],
            scan=None if self.scan is None else self.scan[chosen],
            time_s=self.time_s[chosen],
            columns={name: values[chosen] for name, values in self.columns.items()},
        )


def read_own(
    path: str | Path, notes: list[str], columns: Mapping[str, str] | None = None
) -> OwnRows:
    """Read an own-ship file.

    Columns: a time; ``own_north_m, own_east_m`` (or ``north_m, east_m``); where known
    ``own_vnorth_mps, own_veast_mps, own_heading_deg``, and the covariance of the velocity,
    ``vnorth_var_m2s2, vnorth_veast_cov_m2s2, veast_var_m2s2``; ``scan`` when each row is a scan
    (positions may then be absent); ``scenario``; ``status``, of which ``jumped`` is noted. An empty
    or NaN position is a gap.

    Parameters
    ----------
    path : str or Path
        The file.
    notes : list of str
        Notes are added to it.
    columns : dict of str to str, optional
        Names of columns in this file and what they are.

    Raises
    ------
    RecordingError
        When a column is missing, no row follows the header, or more than a tenth of the rows cannot
        be read, have an invalid covariance, or list a scan again.
    """
    table = Table(path, COLUMNS, notes, columns)
    table.require("time_s")
    if len(table) == 0:
        raise RecordingError(
            table.path, "no row follows the header", line=1, wanted="own-ship rows"
        )
    rows = OwnRows(
        table=table,
        row=np.arange(len(table)),
        scenario=np.array(table.text("scenario")) if "scenario" in table else None,
        scan=table.whole_numbers("scan") if "scan" in table else None,
        time_s=table.times("time_s"),
        columns=_motion(table, notes),
    )
    if rows.scan is not None:
        scan = number_scans(table, rows.scenario, rows.scan, rows.time_s, within=False)
        rows = dataclasses.replace(rows, scan=scan)
        _reject_repeats(rows)
    rows = rows._where(table.kept())
    _note_without_position(rows, notes)
    _note_order(rows, notes)
    _note_jumped(table, notes)
    return rows


def read_own_track(
    path: str | Path, notes: list[str], columns: Mapping[str, str] | None = None
) -> OwnRows:
    """Read an own-ship file that holds one track: rows with a position, in order of time.

    Raises
    ------
    RecordingError
        When the file cannot be read, has no positions, or has those of several scenarios.
    """
    rows = read_own(path, notes, columns)
    if not rows.has_position:
        raise RecordingError(
            path,
            "there is no own-ship position",
            line=1,
            wanted="columns north_m and east_m",
            got="scans alone",
        )
    scenarios = [] if rows.scenario is None else sorted(set(rows.scenario.tolist()))
    if len(scenarios) > 1:
        raise RecordingError(
            path,
            "own ship's track is not one",
            column="scenario",
            wanted="one scenario, as the recording has no names of them",
            got=f"{len(scenarios)}, such as {scenarios[0]!r} and {scenarios[1]!r}",
        )
    return rows.by_time()


@finding_columns
def read_own_ship(path: str | Path, *, columns: Mapping[str, str] | None = None) -> OwnShipMotion:
    """Read own ship's track from a file, as :func:`read_plots` describes it.

    Parameters
    ----------
    path : str or Path
        The file.
    columns : dict of str to str, optional
        Names of columns in this file and what they are.

    Raises
    ------
    RecordingError
        When the file cannot be read, has no positions, or has those of several scenarios.
    """
    return read_own_track(path, [], columns).ship()


def _motion(table: Table, notes: list[str]) -> dict[str, np.ndarray]:
    if "north_m" not in table and "east_m" not in table and "scan" in table:
        notes.append(f"{table.path.name}: no own-ship position, so the radar is stationary")
        return {}
    table.require("north_m", "east_m")
    motion = {"north_m": table.ways_m("north_m"), "east_m": table.ways_m("east_m")}
    motion |= {c: table.speeds_mps(c) for c in ("vnorth_mps", "veast_mps") if c in table}
    if "heading_deg" in table:
        motion["heading_rad"] = np.deg2rad(table.numbers("heading_deg"))
    elif "heading_rad" in table:
        motion["heading_rad"] = table.numbers("heading_rad")
    if all(column in table for column in VELOCITY_COVARIANCE):
        motion["velocity_m2s2"] = _velocity_m2s2(table)
    return motion


def _velocity_m2s2(table: Table) -> np.ndarray:
    """Covariances (n, 2, 2) of the velocity, NaN where a cell is empty."""
    north, cross, east = (table.numbers(column) for column in VELOCITY_COVARIANCE)
    for column, variance in zip(VELOCITY_COVARIANCE[::2], (north, east), strict=True):
        sound = np.isnan(variance) | ((variance >= 0.0) & np.isfinite(variance))
        table.check(column, sound, "a finite variance, not negative")
    with np.errstate(invalid="ignore"):  # rows with a negative variance are left out already
        too_large = np.abs(cross) > np.sqrt(north) * np.sqrt(east) * (1.0 + _ROUNDED)
    table.check(VELOCITY_COVARIANCE[1], ~too_large, "a covariance within those of its variances")
    return np.stack([north, cross, cross, east], axis=1).reshape(-1, 2, 2)


def _note_jumped(table: Table, notes: list[str]) -> None:
    status = [s.lower() for s in table.text("status")] if "status" in table else []
    if "jumped" in status:
        rows = many(status.count("jumped"), "row")
        notes.append(
            f"{table.path.name}: own ship's position is in doubt in {rows} with "
            f"status jumped (first in line {table.line(status.index('jumped'))})"
        )


def _note_without_position(rows: OwnRows, notes: list[str]) -> None:
    lost = ~rows.placed if rows.has_position else np.zeros(0, dtype=bool)
    if lost.any():
        count = many(np.count_nonzero(lost), "row")
        notes.append(
            f"{rows.table.path.name}: {count} without a finite own-ship position left out (first "
            f"in line {rows.table.line(rows.row[np.argmax(lost)])})"
        )


def _note_order(rows: OwnRows, notes: list[str]) -> None:
    parts = rows.parts([""]).values()
    back = np.concatenate([part.row[1:][np.diff(part.time_s) < 0] for part in parts])
    if len(back):
        notes.append(
            f"{rows.table.path.name}: times go back {many(len(back), 'time')} (first in line "
            f"{rows.table.line(int(back.min()))}), and rows are sorted: if a clock was set "
            "back, own ship has two positions at a time, so cut the file there"
        )


def _reject_repeats(rows: OwnRows) -> None:
    scenario = rows.scenario if rows.scenario is not None else np.zeros(len(rows.scan), dtype=str)
    sound = np.flatnonzero(rows.table.sound)
    again = sound[repeated(np.unique(scenario[sound], return_inverse=True)[1], rows.scan[sound])]
    rows.table.reject(again, "scan", "each scan listed once", "a scan is listed twice")
