"""``wakeline calibrate``: the offsets of a radar from AIS or GNSS reports, or another radar."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

import wakeline as wl
from wakeline import plot
from wakeline._brief import many
from wakeline.recording import Recording
from wakeline.recording.files import replacing_together
from wakeline.tracking import (
    calibrate,
    read_reports,
    read_settings,
    reports_of,
    track_recording,
)
from wakeline.tracking.calibrated import vessel_names

from . import options, outputs, report

_Units = tuple[tuple[str, str, float, str], ...]

_RADAR, _PICTURE = "radar.toml", "calibration.png"
_ABOUT = """\
Compares the plots of vessels with their position reports (AIS, GNSS) and finds
the constant offsets of the radar in range, bearing and time, measured minus
true, with their standard deviations. With --against they are compared with the
tracks of another radar, and the offsets are those less the ones of that radar.
An offset is reported if there are enough plots of reported vessels and its
standard deviation is small; one vessel on a steady course, vessels all on one
bearing, or all so near that their hulls hide the offset, are not enough.

Writes radar.toml, radar parameters with the offsets found (wakeline track
--radar radar.toml), and a picture of the errors before and after.
"""
_COLUMNS = """\
columns, separated by commas, recognized by name in any order:
  RECORDING  as for wakeline track
  --own      as for wakeline track
  --ais      time (UTC), mmsi, latitude, longitude; optional course and speed over
             ground; or, in the plane of the recording, time_s, target, north_m,
             east_m; optional vnorth_mps, veast_mps, scenario
  --against  as RECORDING, of the same plane and time; --against-own as --own
"""
_UNITS = (
    ("range", "m", 1.0, "m"),
    ("bearing", "rad", 180.0 / math.pi, "°"),
    ("time", "s", 1.0, "s"),
)
_OTHER = (("other_range", *_UNITS[0][1:]), ("other_bearing", *_UNITS[1][1:]))


def add_to(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command to its parser."""
    parser.description = _ABOUT
    parser.epilog = _COLUMNS
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    options.add_recording(parser)
    reference = parser.add_mutually_exclusive_group(required=True)
    reference.add_argument("--ais", type=Path, metavar="FILE", help="position reports of vessels")
    reference.add_argument(
        "--against", type=Path, metavar="RECORDING", help="plots of another radar"
    )
    options.add_own(parser)
    parser.add_argument(
        "--against-own", type=Path, metavar="SCANS.csv", help="where the other radar is"
    )
    parser.add_argument(
        "--against-radar", metavar="NAME|F.toml", help="parameters of the other radar"
    )
    options.add_origin(
        parser,
        "degrees, where north 0, east 0 of the recording is; for reports in latitude and longitude",
    )
    parser.add_argument(
        "--position-std",
        type=options.metres_above_zero,
        default=5.0,
        metavar="M",
        help="m, standard deviation of a reported position per axis (default 5)",
    )
    options.add_columns(parser)
    options.add_radar(parser)
    parser.add_argument("--config", type=Path, metavar="F.toml", help="settings")
    options.add_results(parser, "the offsets as JSON")
    parser.set_defaults(run=run, inputs=inputs)


def inputs(arguments: argparse.Namespace) -> list[Path]:
    """The input files of the command line."""
    return options.files(arguments, "plots", "ais", "against", "own", "against_own", "config")


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    written = {arguments.out / _RADAR, arguments.out / _PICTURE}
    outputs.check_no_input("--out", written, inputs(arguments))
    settings = read_settings(arguments.config, arguments.radar)
    recording = options.opened(arguments, settings)
    reports = _reports(arguments, recording)
    options.columns_of(arguments).require_found()
    settings = settings.knowing(recording.radar)
    found = calibrate(recording, reports, config=settings, position_std_m=arguments.position_std)
    names = vessel_names(reports)
    print(_about(recording, found))
    units = _UNITS if arguments.against is None else _UNITS + _OTHER
    print(_offset_table(found, units))
    if len(found.vessel_id):
        print(f"\n{_vessel_table(found, names)}")
    outputs.make_folder(arguments.out)
    with replacing_together(arguments.out, written) as fresh:
        (fresh / _RADAR).write_text(settings.calibrated(found).radar_toml(), encoding="utf-8")
    files = [_RADAR]
    if outputs.can_draw():
        plot.save(plot.calibration_figure(found, names), arguments.out / _PICTURE)
        files.append(_PICTURE)
    print(f"written to {arguments.out}: {', '.join(files)}")
    if len(files) == 1:
        print(outputs.HOW_TO_GET_PICTURES)
    if arguments.json is not None:
        outputs.write_json(
            arguments.json, "calibrate", _rows(found, units), vessels=_vessels(found, names)
        )


def _reports(arguments: argparse.Namespace, recording: Recording) -> list[Any]:
    """What the plots are compared with, for each episode."""
    if arguments.against is None:
        return read_reports(
            arguments.ais,
            recording,
            origin_deg=arguments.origin,
            columns=options.columns_of(arguments),
        )
    settings = read_settings(radar=arguments.against_radar)
    other = options.opened(
        arguments, settings, recording=arguments.against, own=arguments.against_own
    )
    return reports_of(track_recording(other, config=settings).smooth())


def _about(recording: Recording, found: wl.track.CalibrationResult) -> str:
    scans, plots = sum(map(len, recording)), sum(one.plot_count for one in recording)
    lines = [f"{recording.name}: {many(scans, 'scan')}, {many(plots, 'plot')}"]
    lines += [f"note: {note}" for note in recording.notes]
    matches = many(round(found.matches), "plot")
    lines.append(f"{matches} of {many(len(found.vessel_id), 'reported vessel')}")
    return "\n".join(lines)


def _offset_table(found: wl.track.CalibrationResult, units: _Units) -> str:
    rows = [["offset", "measured minus reference", "std", ""]]
    for name, key, scale, unit in units:
        one = getattr(found, f"{name}_{key}")
        known = math.isfinite(one.value)
        value = f"{scale * one.value:+.2f} {unit}" if known and one.determined else "-"
        std = f"{scale * one.std:.2f} {unit}" if known else "-"
        verdict = "" if one.determined else f"not determined: {one.verdict}"
        rows.append([name.replace("_", " "), value, std, verdict])
    return report.aligned(rows, left=1, text=(3,))


def _vessel_table(found: wl.track.CalibrationResult, names: list[str]) -> str:
    rows = [["vessel", "plots", "echo along", "to starboard"]]
    for one in _vessels(found, names):
        along, across = (f"{one[key]:+.1f} m" for key in ("along_m", "across_m"))
        rows.append([one["vessel"], f"{one['plots']:.0f}", along, across])
    return report.aligned(rows)


def _rows(found: wl.track.CalibrationResult, units: _Units) -> list[dict[str, Any]]:
    """One row per offset, in SI units; missing values are null."""
    return [
        {
            "offset": offset,
            "value": one.value if math.isfinite(one.value) else None,
            "std": one.std if math.isfinite(one.std) else None,
            "determined": one.determined,
            "verdict": one.verdict,
        }
        for offset in (f"{name}_{key}" for name, key, _, _ in units)
        for one in [getattr(found, offset)]
    ]


def _vessels(found: wl.track.CalibrationResult, names: list[str]) -> list[dict[str, Any]]:
    columns = (found.vessel_id, found.vessel_matches, found.vessel_along_m, found.vessel_across_m)
    return [
        {"vessel": names[k], "plots": n, "along_m": along_m, "across_m": across_m}
        for k, n, along_m, across_m in zip(*(column.tolist() for column in columns), strict=True)
    ]
