"""Own ship from CSV: positions of the radar, and the list of scans if the file has one."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from wakeline._brief import many

from .errors import RecordingError
from .model import OwnShipMotion
from .table import TIME_NAMES, Table

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

    def part(self, scenario: str) -> OwnRows:
        """Rows of one scenario; all rows when the file has no scenario column."""
        return self if self.scenario is None else self._where(self.scenario == scenario)

    def by_time(self) -> OwnRows:
        """Rows with a finite position, sorted by time; of equal times the last in the file."""
        placed = np.isfinite(self.columns["north_m"]) & np.isfinite(self.columns["east_m"])
        rows = self._where(np.flatnonzero(placed))
        rows = rows._where(np.argsort(rows.time_s, kind="stable"))
        return rows._where(np.append(np.diff(rows.time_s) > 0, True)[: len(rows.time_s)])

    def ship(self) -> OwnShipMotion:
        """These sorted rows as own ship's track."""
        return OwnShipMotion(time_s=self.time_s, **self.columns)

    def lacks(self, time_s: np.ndarray, own_gap_s: float) -> tuple[int, str] | None:
        """The first of times (n,) that these sorted rows do not cover, and what they have.

        A time may be at most one median step outside of them, and not in a step longer than
        `own_gap_s`. None if all are covered.
        """
        if len(time_s) == 0:
            return None
        if len(self.row) == 0:
            return 0, "no position at all"
        step_s = np.diff(self.time_s)
        margin_s = min(float(np.median(step_s)), own_gap_s) if len(step_s) else 0.0
        start_s, end_s = self.time_s[0] - margin_s, self.time_s[-1] + margin_s
        outside = (time_s < start_s) | (time_s > end_s)
        if outside.any():
            return int(np.argmax(outside)), f"positions from {self.time_s[0]} to {self.time_s[-1]}"
        if len(step_s) == 0:
            return None
        after = np.clip(np.searchsorted(self.time_s, time_s), 1, len(step_s))
        inside = (time_s > self.time_s[after - 1]) & (time_s < self.time_s[after])
        lost = inside & (step_s[after - 1] > own_gap_s)
        if not lost.any():
            return None
        k = int(np.argmax(lost))
        line = self.table.line(self.row[after[k] - 1])
        return k, f"a gap of {step_s[after[k] - 1]:g} s after its line {line}"

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


def read_own(path: str | Path, notes: list[str]) -> OwnRows:
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

    Raises
    ------
    RecordingError
        When a column is missing, a cell cannot be read, a covariance is invalid, a scan is listed
        twice, or no row follows the header.
    """
    table = Table(path, COLUMNS)
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
    _check_scans_once(rows)
    _note_order(rows, notes)
    _note_jumped(table, notes)
    return rows


def read_own_track(path: str | Path, notes: list[str]) -> OwnRows:
    """Read an own-ship file that holds one track: rows with a position, in order of time.

    Raises
    ------
    RecordingError
        When the file cannot be read, has no positions, or has those of several scenarios.
    """
    rows = read_own(path, notes)
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


def read_own_ship(path: str | Path) -> OwnShipMotion:
    """Read own ship's track from a file, as :func:`read_plots` describes it.

    Raises
    ------
    RecordingError
        When the file cannot be read, has no positions, or has those of several scenarios.
    """
    return read_own_track(path, []).ship()


def _motion(table: Table, notes: list[str]) -> dict[str, np.ndarray]:
    if "north_m" not in table and "east_m" not in table and "scan" in table:
        notes.append(f"{table.path.name}: no own-ship position, so the radar is stationary")
        return {}
    table.require("north_m", "east_m")
    motion = {"north_m": table.ways_m("north_m"), "east_m": table.ways_m("east_m")}
    lost = ~(np.isfinite(motion["north_m"]) & np.isfinite(motion["east_m"]))
    if lost.any():
        first = table.line(int(np.argmax(lost)))
        rows = many(np.count_nonzero(lost), "row")
        notes.append(
            f"{table.path.name}: {rows} without a finite own-ship position "
            f"left out (first in line {first})"
        )
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


def _note_order(rows: OwnRows, notes: list[str]) -> None:
    parts = [rows] if rows.scenario is None else map(rows.part, np.unique(rows.scenario))
    back = np.concatenate([part.row[1:][np.diff(part.time_s) < 0] for part in parts])
    if len(back):
        notes.append(
            f"{rows.table.path.name}: times go back {many(len(back), 'time')} (first in line "
            f"{rows.table.line(int(back.min()))}), and rows are sorted: if a clock was set "
            "back, own ship has two positions at a time, so cut the file there"
        )


def _check_scans_once(rows: OwnRows) -> None:
    if rows.scan is None:
        return
    seen = set()
    scenarios = rows.scenario if rows.scenario is not None else np.full(len(rows.scan), "")
    for row, key in enumerate(zip(scenarios.tolist(), rows.scan.tolist(), strict=True)):
        if key in seen:
            raise rows.table.error(
                row, "scan", "each scan listed once", problem="a scan is listed twice"
            )
        seen.add(key)
