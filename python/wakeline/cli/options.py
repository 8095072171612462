"""Options that several commands have, and the files they name."""

from __future__ import annotations

import argparse
import math
import sys
import threading
from pathlib import Path
from typing import Any

from wakeline.recording import Recording, radar_names
from wakeline.recording.azimuths import AZIMUTHS
from wakeline.recording.table import ColumnNames
from wakeline.tracking import Settings, open_recording


def above_zero(text: str, wanted: str = "a number", most: float = sys.float_info.max) -> float:
    """The value of an option."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value <= most:
        raise argparse.ArgumentTypeError(f"wanted {wanted} above 0, got {text!r}")
    return value


def metres_above_zero(text: str) -> float:
    """The value of an option in metres."""
    return above_zero(text, "metres")


def seconds_above_zero(text: str) -> float:
    """The value of an option in seconds, for which a program can wait."""
    return above_zero(text, "seconds", threading.TIMEOUT_MAX)


def add_recording(parser: argparse.ArgumentParser) -> None:
    """Add the argument of a recording, bundled or in a file."""
    parser.add_argument(
        "plots",
        type=Path,
        metavar="RECORDING",
        help="radar plots as CSV, radar video, or the name of a bundled recording",
    )


def add_own(parser: argparse.ArgumentParser) -> None:
    """Add the options of own ship: its file, and where bearings begin."""
    parser.add_argument(
        "--own", type=Path, metavar="SCANS.csv", help="own ship, and the list of scans"
    )
    parser.add_argument(
        "--azimuth",
        choices=AZIMUTHS,
        default="north",
        help="origin of bearings and azimuths: north (default), or the bow, to which heading_deg "
        "of --own is added",
    )


def add_radar(parser: argparse.ArgumentParser) -> None:
    """Add the option of the radar."""
    parser.add_argument(
        "--radar",
        metavar="NAME|F.toml",
        help=f"radar parameters: {', '.join(radar_names())}, or a TOML file with keys of [radar]; "
        "overrides [radar] of --config",
    )


def add_columns(parser: argparse.ArgumentParser) -> None:
    """Add the option that names columns of tables."""
    parser.add_argument(
        "--columns",
        action="append",
        type=_pair,
        default=[],
        metavar="NAME=OURS",
        help="what the column NAME of a table is, such as rho=range_m; may be repeated",
    )


def add_origin(parser: argparse.ArgumentParser, help_text: str) -> None:
    """Add the option of the position of the plane's origin."""
    parser.add_argument("--origin", type=place, metavar="LAT,LON", help=help_text)


def add_results(
    parser: argparse.ArgumentParser, json_text: str, folder: str = "wakeline-out"
) -> None:
    """Add the options of the folder of results, and of results as JSON."""
    parser.add_argument(
        "--out", type=Path, metavar="DIR", default=Path(folder), help="default %(default)s"
    )
    parser.add_argument("--json", type=Path, metavar="F", help=json_text)


def opened(arguments: argparse.Namespace, settings: Settings, **others: Any) -> Recording:
    """The recording of the command line; `others` as of :func:`open_recording`."""
    return open_recording(
        **{"recording": arguments.plots, "own": arguments.own} | others,
        period_s=settings.period_s,
        azimuth=arguments.azimuth,
        min_range_m=settings.radar["min_range_m"],
        columns=columns_of(arguments),
    )


def columns_of(arguments: argparse.Namespace) -> ColumnNames:
    """What ``--columns`` names, the same for all files of a command."""
    if not isinstance(arguments.columns, ColumnNames):
        arguments.columns = ColumnNames(dict(arguments.columns))
    return arguments.columns


def files(arguments: argparse.Namespace, *names: str) -> list[Path]:
    """The input files that are given, of the named arguments and of ``--radar``."""
    found = [getattr(arguments, name) for name in names]
    if arguments.radar is not None and arguments.radar not in radar_names():
        found.append(Path(arguments.radar))
    return [file for file in found if file is not None]


def place(text: str) -> tuple[float, float]:
    """Latitude and longitude of an argument such as ``63.44,10.40``."""
    try:
        latitude_deg, longitude_deg = map(float, text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"wanted LAT,LON in degrees such as 63.44,10.40, got {text!r}"
        ) from None
    return latitude_deg, longitude_deg


def _pair(text: str) -> tuple[str, str]:
    name, equals, ours = text.partition("=")
    if not (name and equals and ours):
        raise argparse.ArgumentTypeError(f"wanted NAME=OURS such as rho=range_m, got {text!r}")
    return name, ours
