"""Output files of the command: checks, pictures, JSON."""

from __future__ import annotations

import csv
import errno
import json
import os
import re
from collections.abc import Iterable
from itertools import chain, count
from pathlib import Path
from typing import Any

try:
    import fcntl
except ImportError:  # not POSIX
    fcntl = None  # type: ignore[assignment]

from wakeline import __version__, plot
from wakeline._progress import progress
from wakeline.extraction import VideoRecording
from wakeline.recording import replacing
from wakeline.recording.files import settle
from wakeline.tracking import MODE_NAMES, TrackedRecording
from wakeline.tracking.tables import TABLES

HOW_TO_GET_PICTURES = "no pictures without matplotlib: pip install 'wakeline[plot]'"
PARTIAL = "-partial"
MOST_DRAWN = 20  # episodes; the pictures of one take a second

_PICTURES = ("map", "time")
_MOST_OCTETS = 120  # of a scenario in a file name, which some file systems limit to 143

_held: dict[Path, int] = {}  # folders of this command, with a descriptor each that has the lock


def make_folder(folder: Path) -> None:
    """Make the folder of outputs this command's own; fail before the work if that is impossible.

    What a killed command was writing there is moved in if it was complete, else removed.

    Raises
    ------
    ValueError
        When another command writes to the folder.
    OSError
        When nothing can be written there.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if not os.access(folder, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(folder))
    if _lock(folder):
        settle(folder)


def release_folders() -> None:
    """Let other commands write to the folders of this one."""
    while _held:
        os.close(_held.popitem()[1])


def _lock(folder: Path) -> bool:
    """Whether the folder is this command's own; False where the system has no such locks."""
    folder = folder.resolve()
    if fcntl is None or folder in _held:
        return folder in _held
    try:
        descriptor = os.open(folder, os.O_RDONLY)
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        raise ValueError(
            f"another wakeline command writes to {folder}: wait for its end, or give --out "
            "another folder"
        ) from None
    except OSError:
        os.close(descriptor)
        return False
    _held[folder] = descriptor
    return True


def check_no_input(option: str, outputs: Iterable[Path], inputs: Iterable[Path]) -> None:
    """Raise ValueError if an output option names an input file."""
    inputs = list(inputs)
    for output in outputs:
        for file in inputs:
            if _is_same(output, file):
                raise ValueError(f"{option} would replace the input {file}")


def check_no_result(option: str, output: Path, folder: Path) -> None:
    """Raise ValueError if an option names a possible result in the folder."""
    if output.suffix.lower() in (".csv", ".png") and output.parent.resolve() == folder.resolve():
        raise ValueError(
            f"{option} must not have the name of a table or picture in {folder}, got {output.name}"
        )


def partial_tables(folder: Path) -> set[Path]:
    """The tables of an earlier run of tracking that ended early."""
    return {folder / f"{stem}{PARTIAL}.csv" for stem in TABLES}


def of_tracking(folder: Path) -> set[Path]:
    """The files that an earlier run of tracking may have left in `folder`.

    Pictures are those of the scenarios in its ``plots_tracks.csv``, so that a user's file with a
    similar name does not count.
    """
    tables = {f"{stem}.csv" for stem in TABLES}
    ends = {"", *(f"-{name}" for name in _file_names(_scenarios_in(folder / "plots_tracks.csv")))}
    pictures = {f"{stem}{end}.png" for stem in _PICTURES for end in ends}
    named = {folder / name for name in tables | pictures | {"ppi.png"}}
    return named | partial_tables(folder)


def write_pictures(folder: Path, tracks: TrackedRecording) -> list[Path]:
    """Write ``map.png`` and ``time.png`` of the first episodes, ``ppi.png`` of radar video."""
    files = []
    parts = tracks.episodes
    named = list(zip(parts, _file_names(part.episode.name for part in parts), strict=True))
    drawn = named[:MOST_DRAWN]
    for part, name in progress(drawn, len(drawn), "drawing"):
        end = f"-{name}" if len(parts) > 1 else ""
        modes = part.tracks.mode_probability.shape[1]
        names = MODE_NAMES if modes == len(MODE_NAMES) else None
        figures = (
            plot.map(part.tracks, part.episode, encounters=part.encounters),
            plot.time_figure(part.episode, part.tracks, mode_names=names),
        )
        for stem, figure in zip(_PICTURES, figures, strict=True):
            files.append(folder / f"{stem}{end}.png")
            plot.save(figure, files[-1])
    if isinstance(tracks.recording, VideoRecording):
        files.append(folder / "ppi.png")
        plot.save(plot.screen(tracks), files[-1])
    return files


def can_draw() -> bool:
    """Whether matplotlib is installed."""
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        return False
    return True


def write_json(
    path: Path,
    name: str,
    rows: list[dict[str, Any]],
    *,
    seed: int | None = None,
    runs: int = 1,
    **more: Any,
) -> None:
    """Write machine-readable results, and more by name; `seed` is None if nothing is random."""
    results = {"name": name, "version": __version__, "seed": seed, "runs": runs, "rows": rows}
    results |= more
    with replacing(path) as fresh:
        fresh.write_text(json.dumps(results, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def _is_same(output: Path, file: Path) -> bool:
    try:
        return output.is_file() and output.samefile(file)  # a device replaces nothing
    except (OSError, ValueError):  # one of them does not exist
        return False


def _scenarios_in(plots: Path) -> list[str]:
    """Scenarios in a file of plots and their tracks; none without such a file."""
    try:
        with plots.open(newline="", encoding="utf-8") as file:
            return list(dict.fromkeys(row["scenario"] or "" for row in csv.DictReader(file)))
    except (OSError, KeyError, TypeError, UnicodeDecodeError, csv.Error):
        return []


def _file_names(scenarios: Iterable[str]) -> list[str]:
    """File names of scenarios, shortened; duplicates get a number.

    Names that differ only in case are duplicates, as on some file systems.
    """
    taken: dict[str, str] = {}
    for scenario in scenarios:
        sound = re.sub(r"[^\w.+-]+", "_", scenario) or "unnamed"
        plain = sound.encode()[:_MOST_OCTETS].decode(errors="ignore")
        numbered = chain([plain], (f"{plain}-{number}" for number in count(2)))
        free = next(name for name in numbered if name.lower() not in taken)
        taken[free.lower()] = free
    return list(taken.values())
