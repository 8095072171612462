"""Truth from CSV: recorded positions of targets, with or without velocities."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from wakeline._brief import many

from .errors import RecordingError
from .model import Recording
from .scans import grouped
from .table import TIME_NAMES, Table
from .truth import TargetTruth

COLUMNS = {
    "time_s": TIME_NAMES,
    "scenario": ("scenario",),
    "target": ("target", "target_id", "mmsi"),
    "north_m": ("north_m",),
    "east_m": ("east_m",),
    "vnorth_mps": ("vnorth_mps",),
    "veast_mps": ("veast_mps",),
}
_VELOCITY = ("vnorth_mps", "veast_mps")


def read_truth(
    path: str | Path, recording: Recording, columns: Mapping[str, str] | None = None
) -> list[dict[str, TargetTruth]]:
    """Read the truth of each episode of a recording.

    Columns: a time, ``target``, ``north_m``, ``east_m``; optionally ``vnorth_mps``, ``veast_mps``,
    ``scenario``. Rows need not be sorted; of equal times of a target the last row counts. Rows
    without a finite position, or of scenarios that the recording does not have, are dropped with a
    note on the recording; a recording without scenario names takes the rows of any scenario.

    Parameters
    ----------
    path : str or Path
        The file.
    recording : Recording
        Its episodes receive the rows, its notes the remarks.
    columns : dict of str to str, optional
        Names of columns in this file and what they are.

    Returns
    -------
    list of dict of str to TargetTruth
        One per episode: the targets by name.

    Raises
    ------
    RecordingError
        When a column is missing, more than a tenth of the rows cannot be read, no row follows the
        header, or no row is within the time of the recording.
    """
    table = Table(path, COLUMNS, recording.notes, columns)
    table.require("time_s", "target", "north_m", "east_m")
    if len(table) == 0:
        raise RecordingError(table.path, "no row follows the header", line=1, wanted="truth rows")
    time_s = table.times("time_s")
    unknown = np.full(len(table), np.nan)
    velocity = [table.speeds_mps(c) if c in table else unknown for c in _VELOCITY]
    state = np.column_stack([table.ways_m("north_m"), table.ways_m("east_m"), *velocity])
    target = np.array(table.text("target"))
    table.check("target", np.char.str_len(target) > 0, "a name or number")
    scenario = np.array(table.text("scenario") if "scenario" in table else [""] * len(table))
    sound = table.kept()
    kept = sound & _kept(table, sound, state, scenario, recording)
    episode = recording.episode_of(scenario[kept], time_s[kept])
    _check_overlap(table, time_s[kept], episode, recording)
    rows = dict(grouped(episode))
    none = np.zeros(0, dtype=int)
    target, time_s, state = target[kept], time_s[kept], state[kept]
    return [
        _targets(target[mine], time_s[mine], state[mine])
        for mine in (rows.get(k, none) for k in range(len(recording)))
    ]


def _kept(
    table: Table,
    sound: np.ndarray,
    state: np.ndarray,
    scenario: np.ndarray,
    recording: Recording,
) -> np.ndarray:
    """Mask (n,) of the valid ones of the `sound` rows; the others get a note."""
    finite = ~sound | np.isfinite(state[:, :2]).all(axis=1)
    names = [episode.name for episode in recording]
    known = np.isin(scenario, ["", *names]) | (names == [""])
    reasons = ((finite, "without a finite position"), (known, "of scenarios without scans"))
    for good, what in reasons:
        if not good.all():
            first = table.line(int(np.argmin(good)))
            recording.notes.append(
                f"{table.path.name}: {many(np.count_nonzero(~good), 'row')} {what} left out "
                f"(first in line {first})"
            )
    return finite & known


def _check_overlap(
    table: Table, time_s: np.ndarray, episode: np.ndarray, recording: Recording
) -> None:
    """Truth must overlap the time of an episode, if there are scans and rows."""
    scenes = recording.episodes
    spans = [
        (scenes[k].time_s[[0, -1]], time_s[rows]) for k, rows in grouped(episode) if len(scenes[k])
    ]
    if spans and all(rows.max() < begin or rows.min() > end for (begin, end), rows in spans):
        (begin, end), rows = spans[0]
        raise RecordingError(
            table.path,
            "the truth does not overlap the recording in time",
            column=table.name("time_s"),
            wanted=f"times within {begin} to {end}",
            got=f"{rows.min()} to {rows.max()}",
        )


def _targets(target: np.ndarray, time_s: np.ndarray, state: np.ndarray) -> dict[str, TargetTruth]:
    """Truth by target; names sorted by length, then letters, so that 2 comes before 10."""
    names = sorted(np.unique(target).tolist(), key=lambda name: (len(name), name))
    return {name: _one_target(time_s[target == name], state[target == name]) for name in names}


def _one_target(time_s: np.ndarray, state: np.ndarray) -> TargetTruth:
    order = np.argsort(time_s, kind="stable")
    last = order[np.append(np.diff(time_s[order]) > 0, True)]
    return TargetTruth(time_s[last], *state[last].T)
