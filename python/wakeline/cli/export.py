"""``wakeline export``: tracks for maps and navigation programs."""

from __future__ import annotations

import argparse
from datetime import datetime
from pathlib import Path

from wakeline._brief import many
from wakeline.recording import Tracks, export_tracks, read_tracks

from . import options, outputs


def add_to(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command to its parser."""
    parser.description = (
        "Writes tracks with latitude and longitude for maps and navigation programs. "
        "The ending of each file is its format: .gpx, .kml, .geojson or .csv."
    )
    parser.add_argument(
        "tracks",
        type=Path,
        metavar="TRACKS.csv|SESSION",
        help="tracks, or a session file of wakeline live --record, which is replayed",
    )
    parser.add_argument("files", type=Path, nargs="+", metavar="FILE")
    options.add_origin(
        parser,
        "degrees, where north 0, east 0 of the tracks is; default for a session: its own origin",
    )
    parser.add_argument(
        "--start",
        type=_time,
        metavar="TIME",
        help="when time_s is 0, such as 2026-05-01T12:00:00, in UTC unless it has an offset; "
        "default: times from 1e8 s on are Unix times, others are left out",
    )
    options.add_columns(parser)
    parser.set_defaults(run=run, inputs=inputs, json=None)


def _time(text: str) -> datetime:
    try:
        return datetime.fromisoformat(text.replace("Z", "+00:00"))
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"wanted a time such as 2026-05-01T12:00:00, got {text!r}"
        ) from None


def inputs(arguments: argparse.Namespace) -> list[Path]:
    """The input files of the command line."""
    return [arguments.tracks]


def _read(arguments: argparse.Namespace) -> tuple[Tracks, tuple[float, float] | None]:
    """Tracks and their origin."""
    if arguments.tracks.suffix.lower() not in (".csv", ".gz"):
        from wakeline.live.session_tracks import session_tracks

        tracks, origin_deg = session_tracks(arguments.tracks)
        return tracks, arguments.origin or origin_deg
    notes: list[str] = []
    tracks = read_tracks(arguments.tracks, columns=dict(arguments.columns), notes=notes)
    for note in notes:
        print(f"note: {note}")
    return tracks, arguments.origin


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    outputs.check_no_input("FILE", arguments.files, inputs(arguments))
    tracks, origin_deg = _read(arguments)
    if origin_deg is None:
        raise ValueError("--origin LAT,LON is needed: the tracks have no latitude and longitude")
    for file in arguments.files:
        export_tracks(file, tracks, origin_deg=origin_deg, start=arguments.start)
    written = ", ".join(map(str, arguments.files))
    print(f"{many(len(tracks.ids()), 'track')}, {many(len(tracks), 'row')} written to {written}")
