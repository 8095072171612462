"""``wakeline score``: tracks against truth."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from wakeline import metrics
from wakeline._progress import progress
from wakeline.recording import (
    Episode,
    Recording,
    RecordingError,
    Tracks,
    read_plots,
    read_tracks,
)

from . import options, outputs, report


def add_to(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command to its parser."""
    parser.description = (
        "Scores tracks against truth: accuracy, continuity, false tracks. The JSON has "
        "one row per scenario, named after the tracks file if it has no name, and one of all "
        "together, scenario all."
    )
    parser.add_argument("tracks", type=Path, metavar="TRACKS.csv")
    parser.add_argument("truth", type=Path, metavar="TRUTH.csv")
    parser.add_argument("--scans", type=Path, metavar="SCANS.csv", required=True)
    parser.add_argument(
        "--plots",
        type=Path,
        metavar="PLOTS.csv",
        help="radar plots; default plots.csv in the folder of the scans, if it exists",
    )
    parser.add_argument(
        "--gate", type=float, default=50.0, metavar="M", help="m, largest distance (default 50)"
    )
    options.add_columns(parser)
    parser.add_argument("--json", type=Path, metavar="F", help="write the score as JSON")
    parser.set_defaults(run=run, inputs=inputs)


def _check_scenarios(file: Path, tracks: Tracks, recording: Recording) -> None:
    """RecordingError if a track belongs to a scenario that the recording does not have."""
    known = [episode.name for episode in recording]
    if tracks.scenario is None or len(known) == 1:
        return
    lost = tracks.scenario[~np.isin(tracks.scenario, ["", *known])]
    if len(lost):
        raise RecordingError(
            file,
            "a track belongs to a scenario without scans",
            column="scenario",
            wanted=" or ".join(map(repr, known)),
            got=repr(str(lost[0])),
        )


class _Watched(Recording):
    """A recording that reports the progress over its episodes."""

    def __iter__(self) -> Iterator[Episode]:
        return progress(self.episodes, len(self), "scoring")


def inputs(arguments: argparse.Namespace) -> list[Path]:
    """The input files of the command line."""
    files = [arguments.tracks, arguments.truth, arguments.scans, _plots(arguments)]
    return [file for file in files if file is not None]


def _plots(arguments: argparse.Namespace) -> Path | None:
    """Radar plots, or those in the folder of the scans, if they exist."""
    beside = arguments.scans.with_name("plots.csv")
    return arguments.plots or (beside if beside.exists() else None)


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    columns = options.columns_of(arguments)
    plots = _plots(arguments)
    recording = read_plots(plots, arguments.scans, arguments.truth, columns=columns)
    if not any(map(len, recording)):
        raise RecordingError(
            arguments.scans, "there are no scans", line=1, wanted="a column scan, or --plots"
        )
    tracks = read_tracks(arguments.tracks, columns=columns, notes=recording.notes)
    columns.require_found()
    _check_scenarios(arguments.tracks, tracks, recording)
    watched = _Watched(recording.name, recording.episodes, recording.notes)
    score = metrics.score(tracks, watched, gate_m=arguments.gate)
    for note in recording.notes:
        print(f"note: {note}")
    print(report.score_table(score))
    if arguments.json is not None:
        rows = report.score_rows(score, arguments.tracks.name)
        outputs.write_json(arguments.json, "score", rows)
