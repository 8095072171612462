"""``wakeline navigate``: own ship's solution from a log of its instruments, or of an IMU."""

from __future__ import annotations

import argparse
import csv
import datetime
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from wakeline import own_ship, plot
from wakeline._brief import counted, many
from wakeline._progress import progress
from wakeline.recording import NavigationLog, RecordingError, read_imu, read_nmea, replacing
from wakeline.recording.files import replacing_together

from . import options, outputs, report

_OWN, _PROBLEMS, _FAILED = "own.csv", "problems.csv", f"problems{outputs.PARTIAL}.csv"
_LEAST_DRAWN_FIXES = 10
_MOST_DRAWN_LEGS = 10
_SMOOTHED = (
    "smoothed: own.csv and pictures also use later readings, up to a gap or to rejected "
    "readings that persisted"
)
_METHODS = {
    "navigator": "navigator",
    "dead_reckoning": "heading and log alone",
    "constant_velocity": "last velocity over ground",
}


def add_to(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command to its parser."""
    parser.description = (
        "Reads NMEA 0183, fuses fixes, speeds, headings and rates of turn, and writes "
        "own.csv and pictures. A log whose name ends in .csv is that of an IMU: a time, "
        "forward_mps2, starboard_mps2, yaw_rate_deg_s, and lat_deg, lon_deg and heading_deg or an "
        "NMEA 0183 log beside it (--nmea); its biases are estimated. Parts separated by a gap of a "
        "minute are independent. Then satellites are hidden for a minute at a time, and the "
        "prediction errors are reported. "
        "Problems in the log are counted and listed in problems.csv; none is fatal. The status in "
        "own.csv is ok, coasting (no accepted fix for five seconds), rejected (a fix was rejected) "
        "or jumped (persistent rejected fixes moved the position by over 50 m; until it returns or "
        "all fixes have been accepted for a minute)."
    )
    parser.add_argument(
        "log", type=Path, metavar="LOG", help="sentences, one per line; or .csv with rows of an IMU"
    )
    parser.add_argument(
        "--nmea",
        type=Path,
        metavar="LOG.nmea",
        help="beside an IMU log: what it has no columns for",
    )
    parser.add_argument(
        "--variation",
        type=_variation_deg,
        metavar="DEG",
        help="magnetic variation, positive east; overrides the log; default: that of the log, else "
        "estimated from velocities over ground, which needs alterations of course",
    )
    parser.add_argument(
        "--date",
        type=_date,
        metavar="YYYY-MM-DD",
        help="day of the first sentence; overrides the log",
    )
    parser.add_argument(
        "--fix-std",
        type=options.metres_above_zero,
        metavar="M",
        default=own_ship.FIX_STD_M,
        help="standard deviation of a fix, per axis; default %(default)g m",
    )
    parser.add_argument(
        "--smooth",
        action="store_true",
        help="smooth: own.csv and the pictures also use later readings, up to a gap or to rejected "
        "readings that persisted; for finished voyages",
    )
    options.add_results(parser, "errors without satellites")
    parser.set_defaults(run=run, inputs=inputs)


def _variation_deg(text: str) -> float:
    try:
        variation_deg = float(text)
    except ValueError:
        variation_deg = np.nan
    if not abs(variation_deg) <= 180.0:
        raise argparse.ArgumentTypeError(f"wanted degrees from -180 to 180, got {text!r}")
    return variation_deg


def _date(text: str) -> datetime.date:
    try:
        return datetime.date.fromisoformat(text)
    except ValueError:
        wanted = "wanted a date such as 2026-08-15"
        raise argparse.ArgumentTypeError(f"{wanted}, got {text!r}") from None


def inputs(arguments: argparse.Namespace) -> list[Path]:
    """The input files of the command line."""
    return [arguments.log, *([arguments.nmea] if arguments.nmea else [])]


def _read(arguments: argparse.Namespace) -> NavigationLog:
    given = {"variation_deg": arguments.variation, "date": arguments.date}
    if arguments.log.suffix.lower() == ".csv":
        return read_imu(arguments.log, arguments.nmea, **given)
    if arguments.nmea is not None:
        raise RecordingError(
            *(arguments.log, "--nmea goes with an IMU log"), wanted="a name that ends in .csv"
        )
    return read_nmea(arguments.log, **given)


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    tables = [arguments.out / name for name in (_OWN, _PROBLEMS, _FAILED)]
    outputs.check_no_input("--out", tables, inputs(arguments))
    log = _read(arguments)
    outputs.make_folder(arguments.out)
    print(_input_lines(log), flush=True)
    earlier = [*tables, *_pictures(arguments.out)]
    try:
        voyage = own_ship.navigate_log(log, smooth=arguments.smooth, fix_std_m=arguments.fix_std)
    except ValueError:
        _write_problems(arguments.out / _FAILED, log)
        raise
    with replacing_together(arguments.out, earlier) as fresh:
        files = [fresh / _OWN, *_write_problems(fresh / _PROBLEMS, log)]
        own_ship.write_own(files[0], [leg.track for leg in voyage.legs])
    for note in voyage.notes:
        print(f"note: {note}", flush=True)
    if outputs.can_draw():
        name = "own ship, smoothed" if arguments.smooth else "own ship"
        files += _write_pictures(arguments.out, voyage.legs, name)
    if arguments.smooth:
        print(_SMOOTHED)
    errors = voyage.hold_out()
    print(_error_table(errors))
    print(f"written to {arguments.out}: {', '.join(file.name for file in files)}")
    if not outputs.can_draw():
        print(outputs.HOW_TO_GET_PICTURES)
    if arguments.json is not None:
        outputs.write_json(arguments.json, "navigate", _rows(errors, arguments.log.name))


def _input_lines(log: NavigationLog) -> str:
    fixes = log.fixes.sound()
    hours = np.ptp(fixes.time_s) / 3600.0 if len(fixes) else 0.0
    read, fixed = many(log.report.lines, "line"), counted(len(fixes), "[fix|fixes]")
    lines = [f"{log.name}: {read}, {fixed} in {hours:.2f} h"]
    lines += [f"note: {note}" for note in log.notes]
    return "\n".join(lines)


def _error_table(errors: dict[str, dict[float, np.ndarray]]) -> str:
    count = max(len(values) for by_horizon in errors.values() for values in by_horizon.values())
    if count == 0:
        return "too short, or its fixes too rare, to test it without satellites"
    head = ["", *(f"{horizon_s:.0f} s" for horizon_s in own_ship.HORIZONS_S)]
    body = [
        [_METHODS[name], *map(_metres, own_ship.medians(errors[name]).values())]
        for name in _METHODS
        if name in errors
    ]
    title = f"error in metres without satellites, median of {many(count, 'time')}:"
    return f"\n{title}\n{report.aligned([head, *body])}\n"


def _metres(value: float) -> str:
    return "-" if np.isnan(value) else f"{value:.1f}"


def _rows(errors: dict[str, dict[float, np.ndarray]], file: str) -> list[dict[str, Any]]:
    rows = []
    for name, by_horizon in errors.items():
        row: dict[str, Any] = {"scenario": file, "estimator": name}
        for horizon_s, values in by_horizon.items():
            known = len(values) > 0
            row[f"coast_{horizon_s:.0f}s_median_m"] = float(np.median(values)) if known else None
            row[f"coast_{horizon_s:.0f}s_p95_m"] = (
                float(np.percentile(values, 95)) if known else None
            )
        rows.append(row)
    return rows


def _write_problems(path: Path, log: NavigationLog) -> list[Path]:
    """Write the problems of the log, if there are any, and report the file."""
    problems, count = log.report.examples, sum(log.report.problems.values())
    if count == 0:
        return []
    with replacing(path) as fresh, fresh.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("line", "kind", "reason"))
        writer.writerows((problem.line, problem.kind, problem.reason) for problem in problems)
    whole = len(problems) == count
    which = "all problems" if whole else f"the first {many(len(problems), 'problem')}"
    print(f"note: {which} are listed in {path.name}", flush=True)
    return [path]


def _write_pictures(folder: Path, legs: Sequence[own_ship.Leg], name: str) -> list[Path]:
    """Write the map and the panels over time, one pair a leg, of the legs with most fixes."""
    files = []
    drawn = [leg for leg in legs if leg.readings.has_fix.sum() >= _LEAST_DRAWN_FIXES]
    if len(drawn) < len(legs):
        short = f"{len(legs) - len(drawn)} of {many(len(legs), 'part')}"
        print(f"note: {short} not drawn, with fewer than {_LEAST_DRAWN_FIXES} fixes")
    if len(drawn) > _MOST_DRAWN_LEGS:
        print(f"note: of {len(drawn)} parts those {_MOST_DRAWN_LEGS} with most fixes are drawn")
        most = np.argsort([-leg.readings.has_fix.sum() for leg in drawn], kind="stable")
        drawn = [drawn[k] for k in sorted(most[:_MOST_DRAWN_LEGS])]
    for number, leg in enumerate(progress(drawn, len(drawn), "drawing"), start=1):
        end = f"-{number}" if len(drawn) > 1 else ""
        files += [folder / f"own_map{end}.png", folder / f"own_time{end}.png"]
        plot.save(plot.own_map_figure(leg, name=name), files[-2])
        plot.save(plot.own_time_figure(leg), files[-1])
    return files


def _pictures(folder: Path) -> Iterator[Path]:
    names = re.compile(r"own_(map|time)(-\d+)?\.png")
    return (file for file in folder.iterdir() if names.fullmatch(file.name))
