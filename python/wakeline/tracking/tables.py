"""Tracks, events, plots and encounters as files."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import fields
from pathlib import Path

from wakeline.recording import Tracks, replacing, write_tracks

from .encounters import Encounter
from .tracked import TrackedEpisode

TABLES = ("tracks", "events", "plots_tracks", "encounters", "alarms")
_OF_ENCOUNTER = tuple(column.name for column in fields(Encounter))
_OF_ALARM = ("track_id", "begin_s", "end_s", "cpa_m", "tcpa_s", "cpa_probability", "range_m")


def write_tables(
    folder: str | Path, episodes: Sequence[TrackedEpisode], suffix: str = ""
) -> list[Path]:
    """Write ``tracks.csv``, ``events.csv``, ``plots_tracks.csv`` and ``encounters.csv``.

    Encounters with own ship, if it was watched, are in ``alarms.csv``, too; otherwise an earlier
    ``alarms.csv`` is removed. Each file is replaced only when the new one is complete.

    Parameters
    ----------
    folder : str or Path
        Must exist.
    episodes : sequence of TrackedEpisode
        Such as the ``episodes`` of a :class:`TrackedRecording`.
    suffix : str
        Inserted before ``.csv``.

    Returns
    -------
    list of Path
        The files.
    """
    files = [Path(folder, f"{stem}{suffix}.csv") for stem in TABLES]
    tracks, events, plots, encounters, alarms = files
    scenario = ["scenario"] if any(part.tracks.scenario is not None for part in episodes) else []
    write_tracks(tracks, Tracks.joined([part.tracks for part in episodes]))
    head = ["time_s", "event", "track_id", "tentative_id", "reason", *scenario]
    _write_csv(events, head, (row for part in episodes for row in _event_rows(part)))
    head = ["scan", "time_s", "north_m", "east_m", "track_id", *scenario]
    _write_csv(plots, head, (row for part in episodes for row in _plot_rows(part)))
    head = [*_OF_ENCOUNTER, *scenario]
    _write_csv(encounters, head, (row for part in episodes for row in _encounter_rows(part)))
    if all(part.alarms is None for part in episodes):
        alarms.unlink(missing_ok=True)
        return files[:-1]
    head = [*_OF_ALARM, *scenario]
    _write_csv(alarms, head, (row for part in episodes for row in _alarm_rows(part)))
    return files


def _event_rows(part: TrackedEpisode) -> Iterable[list]:
    scenario = _scenario(part)
    for event in part.events:
        yield [
            event.time_s,
            event.kind,
            event.track_id,
            event.tentative_id,
            event.reason,
            *scenario,
        ]


def _plot_rows(part: TrackedEpisode) -> Iterable[list]:
    scenario = _scenario(part)
    for scan, ids in zip(part.episode.scans, part.plot_track_id, strict=True):
        columns = (scan.plot_time_s, scan.north_m, scan.east_m, ids)
        for row in zip(*(column.tolist() for column in columns), strict=True):
            yield [scan.number, *row, *scenario]


def _encounter_rows(part: TrackedEpisode) -> Iterable[list]:
    scenario = _scenario(part)
    for one in part.encounters:
        yield [*(getattr(one, name) for name in _OF_ENCOUNTER), *scenario]


def _alarm_rows(part: TrackedEpisode) -> Iterable[list]:
    scenario = _scenario(part)
    for alarm in part.alarms or ():
        yield [alarm.second, *(getattr(alarm, name) for name in _OF_ALARM[1:]), *scenario]


def _scenario(part: TrackedEpisode) -> list[str]:
    return [] if part.tracks.scenario is None else [part.episode.name]


def _write_csv(path: Path, head: list[str], rows: Iterable[list]) -> None:
    with replacing(path) as fresh, fresh.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows(rows)
