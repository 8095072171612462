"""An episode assembled from the rows of a plots file and an own-ship file."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wakeline._brief import many

from . import scans as grouping
from .model import Episode, OwnShipMotion, Scan
from .own_csv import OwnRows
from .plot_rows import PlotRows
from .table import MOST_BAD


@dataclass(frozen=True)
class _ScanList:
    """Numbers and times (m,) of scans, with the row of the own-ship file that lists each."""

    number: np.ndarray
    time_s: np.ndarray
    own_row: np.ndarray


def build_episode(
    scenario: str,
    plots: PlotRows,
    own: OwnRows | None,
    fixed: OwnShipMotion,
    period_s: float | None,
    own_gap_s: float,
    notes: list[str],
) -> Episode:
    """One scenario's scans and own ship.

    Parameters
    ----------
    scenario : str
        Its name.
    plots : PlotRows
        Its rows; positions that are not finite are NaN.
    own : OwnRows or None
        Its rows.
    fixed : OwnShipMotion
        Own ship if neither file has its position.
    period_s, own_gap_s : float
        As for ``read_plots``.
    notes : list of str
        Notes are added to it.

    Raises
    ------
    RecordingError
        When scan times do not increase, or own ship's position is unknown at more than a tenth of
        the plots.
    """
    listed = _listed_scans(own)
    plots = plots.where(np.argsort(plots.time_s, kind="stable"))
    plots, number = _numbered(plots, listed, _bearing_rad(plots, own, fixed), period_s)
    scans = _all_scans(listed, plots, number)
    _check_plot_times(plots, number)
    _check_scan_times(scans, plots, number, own)
    placed = np.isfinite(plots.place).all(axis=1)
    plots, number = plots.where(placed), number[placed]
    if own is not None and own.has_position:
        covered = _covered(plots, own.by_time(), own_gap_s, notes)
        plots, number = plots.where(covered), number[covered]
    own_m, ship = _own_ship(plots, own, fixed)
    return Episode(scenario, _scans(scans, number, _plot_columns(plots, own_m)), ship)


def _listed_scans(own: OwnRows | None) -> _ScanList:
    if own is None or own.scan is None:
        return _ScanList(np.zeros(0, dtype=np.int64), np.zeros(0), np.zeros(0, dtype=np.int64))
    return _ScanList(own.scan, own.time_s, own.row)


def _numbered(
    plots: PlotRows, listed: _ScanList, bearing_rad: np.ndarray, period_s: float | None
) -> tuple[PlotRows, np.ndarray]:
    """Plots, sorted by time, by scan and, within it, by time; and the scan number (n,) of each."""
    if plots.scan is not None:
        number = plots.scan
    elif len(listed.number):
        number = grouping.by_list(plots.time_s, listed.time_s, listed.number)
    else:
        number = grouping.scan_numbers(plots.time_s, bearing_rad, period_s)
    order = np.argsort(number, kind="stable")
    return plots.where(order), number[order]


def _bearing_rad(plots: PlotRows, own: OwnRows | None, fixed: OwnShipMotion) -> np.ndarray:
    """Bearing (n,) of each plot from own ship, NaN where a position is unknown."""
    if plots.polar:
        return plots.place[:, 1]
    known = own is not None and own.has_position
    own_m = plots.own_m
    if own_m is None:
        own_m = (_track(own.by_time(), fixed) if known else fixed).position_at(plots.time_s)
    north_m, east_m = (plots.place - own_m).T
    return np.arctan2(east_m, north_m)


def _track(rows: OwnRows, fixed: OwnShipMotion) -> OwnShipMotion:
    """Own ship's track from rows with a position, sorted by time; `fixed` without any."""
    return rows.ship() if len(rows.row) else fixed


def _all_scans(listed: _ScanList, plots: PlotRows, number: np.ndarray) -> _ScanList:
    """Listed scans and scans of plots in order of number; -1 is no row of the list."""
    every = np.union1d(listed.number, number)
    time_s = np.empty(len(every))
    own_row = np.full(len(every), -1)
    time_s[np.searchsorted(every, number)] = plots.time_s
    place = np.searchsorted(every, listed.number)
    time_s[place], own_row[place] = listed.time_s, listed.own_row
    return _ScanList(every, time_s, own_row)


def _check_plot_times(plots: PlotRows, number: np.ndarray) -> None:
    """Plots must not be earlier than plots of the scans before theirs."""
    back = np.flatnonzero(np.diff(plots.time_s) < 0)
    if len(back):
        k = int(back[0])
        raise plots.table.error(
            plots.row[k + 1],
            "time_s",
            f"a time not before {plots.time_s[k]}, the last plot of scan {number[k]}",
            problem="scan times go back",
        )


def _check_scan_times(
    scans: _ScanList, plots: PlotRows, number: np.ndarray, own: OwnRows | None
) -> None:
    """Times of scans must increase with their numbers."""
    stuck = np.flatnonzero(np.diff(scans.time_s) <= 0)
    if not len(stuck):
        return
    k = int(stuck[0]) + 1
    if scans.own_row[k] >= 0:
        table, row = own.table, scans.own_row[k]
    else:
        table = plots.table
        row = plots.row[np.searchsorted(number, scans.number[k], side="right") - 1]
    raise table.error(
        row,
        "time_s",
        f"a time after {scans.time_s[k - 1]} of scan {scans.number[k - 1]}",
        problem="scan times do not increase",
    )


def _own_ship(
    plots: PlotRows, own: OwnRows | None, fixed: OwnShipMotion
) -> tuple[np.ndarray, OwnShipMotion]:
    """Own position (n, 2) at each plot, and own ship's track."""
    if own is not None and own.has_position:
        ship = _track(own.by_time(), fixed)
        return ship.position_at(plots.time_s) if plots.own_m is None else plots.own_m, ship
    if plots.own_m is not None and len(plots):
        time_s, first = np.unique(plots.time_s, return_index=True)
        return plots.own_m, OwnShipMotion(time_s, *plots.own_m[first].T)
    return fixed.position_at(plots.time_s), fixed


def _covered(plots: PlotRows, own: OwnRows, own_gap_s: float, notes: list[str]) -> np.ndarray:
    """Mask (n,) of the plots at which own ship's position is known; `own` is sorted by time."""
    lost, got = own.lacks(plots.time_s, own_gap_s)
    if lost.any():
        k = int(np.argmax(lost))
        error = own.not_known(
            plots.table.path,
            plots.time_s[k],
            got,
            line=plots.table.line(plots.row[k]),
            column=plots.table.name("time_s"),
        )
        if np.count_nonzero(lost) > MOST_BAD * len(lost):
            raise error
        count = many(np.count_nonzero(lost), "plot")
        name = plots.table.path.name
        notes.append(f"{name}: {count} left out (first: {error.place_and_reason})")
    return ~lost


def _plot_columns(plots: PlotRows, own_m: np.ndarray) -> dict[str, np.ndarray]:
    """The per-plot fields of ``Scan`` for all plots, each (n,)."""
    if plots.polar:
        range_m, bearing_rad = plots.place[:, 0], _within_half_turn(plots.place[:, 1])
        north_m = own_m[:, 0] + range_m * np.cos(bearing_rad)
        east_m = own_m[:, 1] + range_m * np.sin(bearing_rad)
    else:
        north_m, east_m = plots.place.T
        relative_m = plots.place - own_m
        range_m = np.hypot(*relative_m.T)
        bearing_rad = np.arctan2(relative_m[:, 1], relative_m[:, 0])
    return {
        "plot_time_s": plots.time_s,
        "north_m": north_m,
        "east_m": east_m,
        "range_m": range_m,
        "bearing_rad": bearing_rad,
        "own_north_m": own_m[:, 0],
        "own_east_m": own_m[:, 1],
    }


def _within_half_turn(angle_rad: np.ndarray) -> np.ndarray:
    """Angles within one turn either way, wrapped to [-pi, pi]; those inside keep their bits."""
    return angle_rad - 2.0 * np.pi * ((angle_rad > np.pi) * 1.0 - (angle_rad < -np.pi) * 1.0)


def _scans(scans: _ScanList, number: np.ndarray, columns: dict[str, np.ndarray]) -> list[Scan]:
    """Cut the columns, sorted by scan number (n,), into scans."""
    begin = np.searchsorted(number, scans.number, side="left")
    end = np.searchsorted(number, scans.number, side="right")
    return [
        Scan(float(t), int(n), **{name: values[a:b] for name, values in columns.items()})
        for t, n, a, b in zip(scans.time_s, scans.number, begin, end, strict=True)
    ]
