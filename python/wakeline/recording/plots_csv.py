"""Radar plots from CSV, with own ship and truth, as a recording."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from wakeline._checks import above_zero

from .azimuths import azimuth_notes, check_azimuth, turned_to_north
from .episodes import build_episode
from .model import Episode, OwnShipMotion, Recording
from .own_csv import OWN_GAP_S, OwnRows, read_own
from .plot_rows import PlotRows, read_plot_rows, remark
from .scans import grouped, revolution_s
from .table import finding_columns
from .truth_csv import read_truth
from .units import period_notes

_MANY, _NEARLY_ALL = 20, 0.9
_FAR_M = 300e3


@finding_columns
def read_plots(
    plots_path: str | Path | None,
    own_path: str | Path | None = None,
    truth_path: str | Path | None = None,
    *,
    own: tuple[float, float] = (0.0, 0.0),
    period_s: float | None = None,
    own_gap_s: float = OWN_GAP_S,
    azimuth: str = "north",
    name: str | None = None,
    columns: Mapping[str, str] | None = None,
) -> Recording:
    """Read radar plots, and own ship and truth if there are files of them.

    **Columns of the plots file**, recognized by name in any order and case (``Range [m]`` is
    ``range_m``): a time (``time_s``, ``time``, ``timestamp``, ``time_utc``, ``utc`` or
    ``datetime``: UTC seconds or ISO 8601 text, UTC without a zone) and a position, either
    ``north_m`` and ``east_m``, or a range (``range_m``, ``distance_m``, ``range_nm``) and a bearing
    clockwise from true north (``bearing_deg``, ``azimuth_deg``, ``bearing_rad``, ``azimuth_rad``).
    North and east take precedence over range and bearing. Optional: ``scan`` (also
    ``scan_number``, ``scan_id``), ``scenario``, ``own_north_m`` and ``own_east_m``. Other columns
    are ignored.

    **Scans** are given by the ``scan`` column. Without one, a plot belongs to the nearest scan in
    time of the own-ship file; without such a list, a scan is an antenna revolution of `period_s`.
    Without `period_s` it is estimated from times and bearings, if they fit an antenna that turns
    clockwise, with a note. Such bearings also show where a revolution ends. Otherwise a scan begins
    at a plot more than half a period after the plot before it, or 95 % of a period or more after
    the first plot of its scan; without a period, plots of equal time are one scan. The recording
    has every scan of the own-ship file, with or without plots. Within a scan plots are sorted by
    time; scans are in order of their numbers, and their times must increase.

    **Own ship** comes from the own columns of the plots file, else by linear interpolation from the
    own-ship file, else it is the fixed position `own`. A plot may be at most one median step of
    the own-ship file outside its record.

    **Dropped with a note**: plots without a finite position (the scan remains), repeated rows, and
    rows of any of the files that cannot be read or whose time contradicts their scan number, up to
    a tenth of the rows. A scan number that begins again, such as 0 after 255, is continued.
    Without scan numbers, times that go back by more than a minute get a note, too. So do plots that
    are mostly more than 300 km from own ship, as in a national grid without its position, numbers
    that look like those of another unit, and bearings that look like those from the other origin.
    A file with only a header has no plots; that is not an error.

    Parameters
    ----------
    plots_path : str or Path or None
        Plots file; None for scans without plots from `own_path`.
    own_path : str or Path, optional
        Own-ship file: a time and ``own_north_m, own_east_m`` (or ``north_m, east_m``); ``scan``
        when each row is a scan; ``scenario``; ``own_vnorth_mps``, ``own_veast_mps`` and
        ``own_heading_deg`` where known.
    truth_path : str or Path, optional
        Truth file: a time, ``target``, ``north_m``, ``east_m``; ``scenario``; ``vnorth_mps`` and
        ``veast_mps`` where known.
    own : (float, float)
        North and east in metres of a stationary radar.
    period_s : float, optional
        Duration of an antenna revolution, within 5 %.
    own_gap_s : float
        Longest step of the own-ship file that is interpolated across.
    azimuth : str
        Origin of bearings: "north", or "bow", to which the heading of the own-ship file is added.
    name : str, optional
        Name of the recording; default the stem of the file.
    columns : dict of str to str, optional
        Names of columns in these files and which of the names above they are, such as
        ``{"rho": "range_m", "theta": "bearing_deg"}``.

    Returns
    -------
    Recording

    Raises
    ------
    RecordingError
        When a file cannot be read as described; the message names file, line and column.
    ValueError
        When neither plots nor own ship is given, a parameter is invalid, or azimuths from the bow
        come without own ship's file or without bearings.
    """
    if plots_path is None and own_path is None:
        raise ValueError("plots_path or own_path must be given, got neither")
    for label, value in (("period_s", period_s), ("own_gap_s", own_gap_s)):
        if value is None:
            continue
        above_zero(**{label: value})
    check_azimuth(azimuth, own_path)
    notes: list[str] = []
    plots = PlotRows.none() if plots_path is None else read_plot_rows(plots_path, notes, columns)
    remark(plots, np.isnan(plots.place[:, 0]), "without a finite position left out", notes)
    own_rows = None if own_path is None else read_own(own_path, notes, columns)
    fixed = OwnShipMotion.fixed(*own)

    scenarios = _scenarios(plots, own_rows)
    parts = {name: plots.where(rows) for name, rows in grouped(plots.scenario)}
    none = plots.where(np.zeros(0, dtype=int))
    own_parts = {} if own_rows is None else own_rows.parts(scenarios)

    def episodes_of(period_s: float | None) -> list[Episode]:
        return [
            build_episode(
                scenario,
                parts.get(scenario, none),
                own_parts.get(scenario),
                fixed,
                period_s,
                own_gap_s,
                notes,
            )
            for scenario in scenarios
        ]

    episodes = episodes_of(period_s)
    is_listed = plots.scan is not None or (own_rows is not None and own_rows.scan is not None)
    if period_s is None and not is_listed:
        episodes = _in_turns(episodes, episodes_of, notes)
    if azimuth == "bow":
        if not plots.polar:
            raise ValueError(f"azimuths from the bow need bearings, which {plots_path} has not")
        episodes = [turned_to_north(episode, own_path) for episode in episodes]
    _note_far(episodes, notes)
    turn_s = None if is_listed or period_s is None else _revolution_s(episodes)
    notes += period_notes(episodes, period_s, turn_s)
    notes += azimuth_notes(episodes, azimuth) if plots.polar else []
    notes[:] = dict.fromkeys(notes)
    recording = Recording(name or Path(plots_path or own_path).stem, episodes, notes)
    return recording if truth_path is None else _with_truth(recording, truth_path, columns)


def _note_far(episodes: list[Episode], notes: list[str]) -> None:
    """Note plots that are out of range of a ship's radar."""
    range_m = [scan.range_m for episode in episodes for scan in episode.scans if len(scan)]
    usual_m = float(np.median(np.concatenate(range_m))) if range_m else 0.0
    if usual_m > _FAR_M:
        notes.append(
            f"plots are {usual_m / 1e3:.0f} km from own ship, beyond the range of a ship's radar; "
            "own ship is at the origin unless a file gives its position"
        )


def _in_turns(
    episodes: list[Episode],
    episodes_of: Callable[[float | None], list[Episode]],
    notes: list[str],
) -> list[Episode]:
    """The episodes with antenna revolutions as scans, if the plots show them."""
    period_s = _revolution_s(episodes)
    turns = episodes if period_s is None else episodes_of(period_s)
    if sum(map(len, turns)) < sum(map(len, episodes)):
        notes.append(
            f"scans are revolutions of {period_s:.2g} s, estimated from times and bearings"
        )
        return turns
    sizes = np.array([len(scan) for episode in episodes for scan in episode.scans])
    if period_s is None and len(sizes) >= _MANY and np.mean(sizes == 1) > _NEARLY_ALL:
        notes.append(
            "nearly every scan has one plot; give period_s of the radar to group the plots of a "
            "revolution"
        )
    return episodes


def _revolution_s(episodes: list[Episode]) -> float | None:
    """Median period of the episodes that have one, None if none has."""
    found = []
    for episode in filter(len, episodes):
        time_s = np.concatenate([scan.plot_time_s for scan in episode.scans])
        bearing_rad = np.concatenate([scan.bearing_rad for scan in episode.scans])
        found.append(revolution_s(time_s, bearing_rad))
    known = [turn for turn in found if turn is not None]
    return float(np.median(known)) if known else None


def _scenarios(plots: PlotRows, own: OwnRows | None) -> list[str]:
    """Names of the scenarios in the order of the files; '' alone without names."""
    named = plots.scenario.tolist()
    if own is not None and own.scenario is not None:
        if plots.table is not None:
            plots.table.require("scenario")
        if own.scan is not None:
            named = own.scenario.tolist() + named
    scenarios = list(dict.fromkeys(named)) or [""]
    if own is not None and own.scan is not None and len(scenarios) > 1:
        own.table.require("scenario")
    return scenarios


def _with_truth(
    recording: Recording, path: str | Path, columns: Mapping[str, str] | None
) -> Recording:
    truth = read_truth(path, recording, columns)
    pairs = zip(recording.episodes, truth, strict=True)
    return dataclasses.replace(
        recording, episodes=[dataclasses.replace(episode, truth=t) for episode, t in pairs]
    )
