"""Radar plots from CSV, with own ship and truth beside them, as a recording."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import numpy as np

from wakeline._checks import plain_numbers

from .episodes import build_episode
from .model import Episode, OwnShip, Recording
from .own_csv import OWN_GAP_S, OwnRows, read_own
from .plot_rows import PlotRows, read_plot_rows, remark
from .scans import turn_s
from .truth_csv import read_truth

_MANY, _NEARLY_ALL = 20, 0.9
_FAR_M = 300e3


def read_plots(
    plots_path: str | Path | None,
    own_path: str | Path | None = None,
    truth_path: str | Path | None = None,
    *,
    own: tuple[float, float] = (0.0, 0.0),
    period_s: float | None = None,
    own_gap_s: float = OWN_GAP_S,
    name: str | None = None,
) -> Recording:
    """Read radar plots, and own ship and truth where there are files of them.

    **Columns of the plots file**, known by name in any order and case (``Range [m]`` is
    ``range_m``): a time (``time_s``, ``time``, ``timestamp``, ``time_utc``, ``utc`` or
    ``datetime``: UTC seconds or ISO 8601 text, UTC where no zone is given) and a place, either
    ``north_m`` and ``east_m``, or a range (``range_m``, ``distance_m``, ``range_nm``) and a bearing
    clockwise from true north (``bearing_deg``, ``azimuth_deg``, ``bearing_rad``, ``azimuth_rad``).
    North and east win where a file has both. Optional: ``scan`` (also ``scan_number``,
    ``scan_id``), ``scenario``, ``own_north_m`` and ``own_east_m``. Other columns are left alone.

    **Scans** are told apart by the ``scan`` column. Without one, a plot goes to the scan nearest in
    time of those the own-ship file lists; without a list, a scan is a turn of the antenna, of
    `period_s`. Where that is not given but the bearings grow with the times of the plots as under
    an antenna that turns clockwise, it is found from them, which leaves a note. Bearings that grow
    so tell where a turn ends; where they do not, a scan begins at a plot more than half a period
    after the plot before it or 95 % of a period or more after its scan's first plot, and without a
    period plots of equal time are one scan. Every scan the own-ship file lists is in the
    recording, with or without plots. Within a scan plots are sorted by time; scans are in the order
    of their numbers and their times must grow.

    **Own ship** comes from the own columns of the plots file, else by linear interpolation from the
    own-ship file, else it is the fixed position `own`. A plot may lie at most one median step of
    the own-ship file outside its record.

    **Left out with a note**: plots without a finite place (the scan stays) and repeated rows. Where
    no scans are numbered a note tells, too, of times that go back by more than a minute. A note
    tells of plots that mostly lie more than 300 km from own ship, as in a grid of a country without
    her place in it. A file with a header only has no plots, which is no error.

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
        North and east in metres of a radar that does not move.
    period_s : float, optional
        Time of one antenna turn, right to 5 %.
    own_gap_s : float
        Longest step of the own-ship file that is interpolated across.
    name : str, optional
        Name of the recording; default the stem of the file.

    Returns
    -------
    Recording

    Raises
    ------
    RecordingError
        When a file cannot be read as described; it names file, line and column.
    ValueError
        When neither plots nor own ship is given, or a parameter is not positive.
    """
    if plots_path is None and own_path is None:
        raise ValueError("a plots file or an own-ship file is needed")
    for label, value in (("period_s", period_s), ("own_gap_s", own_gap_s)):
        if value is None:
            continue
        plain_numbers(**{label: value})
        if not value > 0:
            raise ValueError(f"{label} must be positive, got {value}")
    notes: list[str] = []
    plots = PlotRows.none() if plots_path is None else read_plot_rows(plots_path, notes)
    remark(plots, np.isnan(plots.place[:, 0]), "without a finite place left out", notes)
    own_rows = None if own_path is None else read_own(own_path, notes)
    fixed = OwnShip.fixed(*own)

    def episodes_of(period_s: float | None) -> list[Episode]:
        return [
            build_episode(scenario, plots, own_rows, fixed, period_s, own_gap_s)
            for scenario in _scenarios(plots, own_rows)
        ]

    episodes = episodes_of(period_s)
    if period_s is None and plots.scan is None and (own_rows is None or own_rows.scan is None):
        episodes = _in_turns(episodes, episodes_of, notes)
    _note_far(episodes, notes)
    recording = Recording(name or Path(plots_path or own_path).stem, episodes, notes)
    return recording if truth_path is None else _with_truth(recording, truth_path)


def _note_far(episodes: list[Episode], notes: list[str]) -> None:
    """Tell of plots that no radar of a ship sees from where she is taken to be."""
    range_m = [scan.range_m for episode in episodes for scan in episode.scans if len(scan)]
    usual_m = float(np.median(np.concatenate(range_m))) if range_m else 0.0
    if usual_m > _FAR_M:
        notes.append(
            f"plots are {usual_m / 1e3:.0f} km from own ship, farther than a radar at sea sees; "
            "she stands at the origin where no file says otherwise"
        )


def _in_turns(
    episodes: list[Episode],
    episodes_of: Callable[[float | None], list[Episode]],
    notes: list[str],
) -> list[Episode]:
    """The episodes with turns of the antenna as scans, where the plots tell of turns."""
    period_s = _turn_s(episodes)
    turns = episodes if period_s is None else episodes_of(period_s)
    if sum(map(len, turns)) < sum(map(len, episodes)):
        notes.append(
            f"scans are turns of {period_s:.2g} s, as times and bearings of the plots tell"
        )
        return turns
    sizes = np.array([len(scan) for episode in episodes for scan in episode.scans])
    if period_s is None and len(sizes) >= _MANY and np.mean(sizes == 1) > _NEARLY_ALL:
        notes.append(
            "nearly every scan holds one plot; where the antenna turns, its period_s tells which "
            "plots make a scan"
        )
    return episodes


def _turn_s(episodes: list[Episode]) -> float | None:
    """Median over the episodes that tell of a turn, None where none does."""
    found = []
    for episode in filter(len, episodes):
        time_s = np.concatenate([scan.plot_time_s for scan in episode.scans])
        bearing_rad = np.concatenate([scan.bearing_rad for scan in episode.scans])
        found.append(turn_s(time_s, bearing_rad))
    known = [turn for turn in found if turn is not None]
    return float(np.median(known)) if known else None


def _scenarios(plots: PlotRows, own: OwnRows | None) -> list[str]:
    """Names of the scenarios in the order of the files; '' alone when there is none."""
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


def _with_truth(recording: Recording, path: str | Path) -> Recording:
    truth = read_truth(path, recording)
    pairs = zip(recording.episodes, truth, strict=True)
    return dataclasses.replace(
        recording, episodes=[dataclasses.replace(episode, truth=t) for episode, t in pairs]
    )
