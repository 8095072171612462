"""A recording as CSV: its plots, the scans with own ship, and the truth."""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from .files import replacing
from .model import Episode, Recording

_PLOTS = ("scan", "time_s", "range_m", "bearing_rad", "own_north_m", "own_east_m")
_SCANS = ("scan", "time_s", "own_north_m", "own_east_m")
_VELOCITY = ("own_vnorth_mps", "own_veast_mps")
_TRUTH = ("time_s", "target", "north_m", "east_m", "vnorth_mps", "veast_mps")


def write_plots(
    plots_path: str | Path,
    recording: Recording,
    own_path: str | Path | None = None,
    truth_path: str | Path | None = None,
) -> None:
    """Write a recording so that :func:`read_plots` reads it back.

    Ranges, bearings, times and own ship's positions are read back to the last bit. An existing file
    is replaced only when the new one is complete.

    Parameters
    ----------
    plots_path : str or Path
        One row per plot: ``scan, time_s, range_m, bearing_rad, own_north_m, own_east_m``.
    recording : Recording
        If an episode has a name, every file ends with a column ``scenario``.
    own_path : str or Path, optional
        One row per scan: ``scan, time_s, own_north_m, own_east_m`` and, if every episode has
        recorded it, the velocity ``own_vnorth_mps, own_veast_mps``. Without this file scans without
        plots are lost, and the time of a scan is that of its last plot.
    truth_path : str or Path, optional
        One row per target and time: ``time_s, target, north_m, east_m, vnorth_mps, veast_mps``.

    Raises
    ------
    ValueError
        When `truth_path` is given and an episode has no truth; when two episodes have the same
        name, a target has none, or a name cannot be read back (spaces around it, several lines).
    OSError
        When a file cannot be written.
    """
    if truth_path is not None and any(episode.truth is None for episode in recording):
        raise ValueError("every episode must have truth if truth_path is given")
    _check_names("episode", [episode.name for episode in recording])
    if truth_path is not None:
        for episode in recording:
            _check_names("target", [*map(str, episode.truth)])
            if "" in episode.truth:
                raise ValueError("a target must have a name, got ''")
    named = any(episode.name for episode in recording)
    _write(plots_path, _PLOTS, named, ((e.name, _plot_rows(e)) for e in recording))
    if own_path is not None:
        velocity = all(episode.own.vnorth_mps is not None for episode in recording)
        head = _SCANS + _VELOCITY * velocity
        _write(own_path, head, named, ((e.name, _scan_rows(e, velocity)) for e in recording))
    if truth_path is not None:
        _write(truth_path, _TRUTH, named, ((e.name, _truth_rows(e)) for e in recording))


def _check_names(what: str, names: list[str]) -> None:
    """ValueError unless each name is unique and can be read back from a cell."""
    for name, times in Counter(names).items():
        if times > 1:
            raise ValueError(f"each {what} must have a unique name, got {name!r} {times} times")
        if name != name.strip() or {"\n", "\r"} & set(name):
            raise ValueError(
                f"names of {what}s must be one line without spaces around it, got {name!r}"
            )


def _plot_rows(episode: Episode) -> Iterator[list]:
    for scan in episode.scans:
        columns = (
            *(scan.plot_time_s, scan.range_m, scan.bearing_rad),
            *(scan.own_north_m, scan.own_east_m),
        )
        for row in zip(*(column.tolist() for column in columns), strict=True):
            yield [scan.number, *row]


def _scan_rows(episode: Episode, velocity: bool) -> Iterator[list]:
    time_s = episode.time_s
    columns = [time_s, *episode.own.position_at(time_s).T]
    columns += [*episode.own.velocity_at(time_s).T] if velocity else []
    numbers = [scan.number for scan in episode.scans]
    return map(list, zip(numbers, *(column.tolist() for column in columns), strict=True))


def _truth_rows(episode: Episode) -> Iterator[list]:
    for target, truth in (episode.truth or {}).items():
        columns = (truth.north_m, truth.east_m, truth.vnorth_mps, truth.veast_mps)
        for time_s, *state in zip(
            *(column.tolist() for column in (truth.time_s, *columns)), strict=True
        ):
            yield [time_s, target, *state]


def _write(
    path: str | Path,
    head: Sequence[str],
    named: bool,
    episodes: Iterable[tuple[str, Iterable[list]]],
) -> None:
    with replacing(path) as fresh, fresh.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([*head, *["scenario"] * named])
        for name, rows in episodes:
            writer.writerows([*row, *[name] * named] for row in rows)
