"""``wakeline navigate``: own ship's solution from a log of its instruments."""

from __future__ import annotations

import argparse
import csv
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from wakeline import own_ship, plot
from wakeline._brief import counted, many
from wakeline._progress import progress
from wakeline.navigation import LocalPlane
from wakeline.recording import NavigationLog, RecordingError, read_nmea, replacing
from wakeline.recording.reach import plane_stretch

from . import outputs, report

_COLUMNS = (
    *("time_s", "lat_deg", "lon_deg", "north_m", "east_m", "vnorth_mps", "veast_mps"),
    *("heading_deg", "set_deg", "drift_mps", "drift_std_mps"),
    *("north_var_m2", "north_east_cov_m2", "east_var_m2"),
    *("vnorth_var_m2s2", "vnorth_veast_cov_m2s2", "veast_var_m2s2", "heading_std_deg", "status"),
)
_OWN, _PROBLEMS = "own.csv", "problems.csv"
_SHOWN_ROWS = 5
_LEAST_DRAWN_FIXES = 10
_FAR_M = 1000e3
_SMOOTHED = (
    "smoothed: own.csv and pictures also use later readings, up to a gap or to rejected "
    "readings that persisted"
)
_METHODS = {
    "navigator": "navigator",
    "dead_reckoning": "heading and log alone",
    "constant_velocity": "last velocity over ground",
}


def add_to(commands: argparse._SubParsersAction) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "navigate",
        help="own ship's solution from an NMEA 0183 log",
        description="Reads NMEA 0183, fuses fixes, speeds, headings and rates of turn, and writes "
        "own.csv and pictures. Parts separated by a gap of a minute are independent. Then "
        "satellites are hidden for a minute at a time, and the prediction errors are reported. "
        "Problems in the log are counted and listed in problems.csv; none is fatal. The status in "
        "own.csv is ok, coasting (no accepted fix for five seconds), rejected (a fix was rejected) "
        "or jumped (persistent rejected fixes moved the position by over 50 m; until it returns or "
        "all fixes have been accepted for a minute).",
    )
    parser.add_argument("log", type=Path, metavar="LOG.nmea", help="sentences, one per line")
    parser.add_argument(
        "--variation",
        type=_variation_deg,
        metavar="DEG",
        help="magnetic variation, positive east, if the log has none; default: estimated from "
        "velocities over ground, which needs alterations of course",
    )
    parser.add_argument(
        "--smooth",
        action="store_true",
        help="smooth: own.csv and the pictures also use later readings, up to a gap or to rejected "
        "readings that persisted; for finished voyages",
    )
    parser.add_argument(
        "--out", type=Path, metavar="DIR", default=Path("wakeline-out"), help="default %(default)s"
    )
    parser.add_argument("--json", type=Path, metavar="F", help="errors without satellites")
    parser.set_defaults(run=run, inputs=inputs)


def _variation_deg(text: str) -> float:
    try:
        variation_deg = float(text)
    except ValueError:
        variation_deg = np.nan
    if not abs(variation_deg) <= 180.0:
        raise argparse.ArgumentTypeError(f"wanted degrees from -180 to 180, got {text!r}")
    return variation_deg


class _Leg(NamedTuple):
    """A part of the log without gaps of a minute."""

    part: NavigationLog
    readings: own_ship.Readings
    track: own_ship.OwnTrack


def inputs(arguments: argparse.Namespace) -> list[Path]:
    """The input file of the command line."""
    return [arguments.log]


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    tables = (arguments.out / _OWN, arguments.out / _PROBLEMS)
    outputs.check_no_input("--out", tables, inputs(arguments))
    log = read_nmea(arguments.log, variation_deg=arguments.variation)
    outputs.make_folder(arguments.out)
    print(_input_lines(log), flush=True)
    problems = _write_problems(arguments.out / _PROBLEMS, log)
    if len(log.fixes.sound()) == 0:
        raise RecordingError(
            arguments.log,
            "there is no usable fix",
            wanted="at least one usable fix",
            got=f"{len(log.fixes)} that are not usable",
        )
    legs = _legs(log, smooth=arguments.smooth)
    files = [arguments.out / _OWN, *problems]
    _write_csv(files[0], legs)
    if outputs.can_draw():
        way = "own ship, smoothed" if arguments.smooth else "own ship"
        files += _write_pictures(arguments.out, legs, way)
    outputs.remove_stale(_earlier_pictures(arguments.out), files)
    if arguments.smooth:
        print(_SMOOTHED)
    errors = _hold_out(legs)
    print(_error_table(errors))
    print(f"written to {arguments.out}: {', '.join(file.name for file in files)}")
    if not outputs.can_draw():
        print(outputs.HOW_TO_GET_PICTURES)
    if arguments.json is not None:
        outputs.write_json(arguments.json, "navigate", _rows(errors, arguments.log.name))


def _legs(log: NavigationLog, *, smooth: bool) -> list[_Leg]:
    parts = log.parts()
    offset = _magnetic_offset(log, parts)
    plane = log.fixes.sound().plane()
    for note in (*_unused_notes(parts), *_stuck_notes(parts), *_far_notes(log, plane)):
        print(note, flush=True)
    fixed = [part for part in parts if len(part.fixes.sound())]
    watched = progress(fixed, len(fixed), "navigating")
    legs = [_leg(part, offset, plane, smooth) for part in watched]
    for note in (*_doubt_notes(legs), *_order_notes(legs)):
        print(note, flush=True)
    return legs


def _magnetic_offset(log: NavigationLog, parts: Sequence[NavigationLog]) -> own_ship.MagneticOffset:
    if not any(map(own_ship.wants_offset, parts)):
        return own_ship.NO_OFFSET
    offset = own_ship.magnetic_offset(parts)
    how = "(unknown)" if offset is None else "(estimated from velocities over ground)"
    offset = offset or own_ship.ANY_OFFSET
    degrees, std_deg = np.degrees(offset)
    added = f"{degrees:+.1f}° ± {std_deg:.1f}° are added to magnetic headings"
    print(f"note: {added} of unknown variation {how}")
    if len(log.water.sound()):
        share = f"{100.0 * offset.std_rad:.0f} %"
        print(f"note: without --variation set and drift have an error of {share} of the speed")
    return offset


def _leg(
    part: NavigationLog, offset: own_ship.MagneticOffset, plane: LocalPlane, smooth: bool
) -> _Leg:
    readings = own_ship.readings_of(part, offset, plane)
    return _Leg(part, readings, own_ship.navigate(readings, smooth=smooth))


def _unused_notes(parts: Sequence[NavigationLog]) -> Iterator[str]:
    unused = [own_ship.unused(part) for part in parts]
    for what in unused[0]:
        lines = np.concatenate([of_part[what] for of_part in unused])
        if len(lines):
            yield f"note: {what} are not used: {_lines(lines)}"


def _lines(lines: np.ndarray) -> str:
    return f"{len(lines)} (first in line {lines.min()})"


def _stuck_notes(parts: Sequence[NavigationLog]) -> Iterator[str]:
    lines = np.concatenate([own_ship.zero_speeds(part) for part in parts])
    if len(lines):
        yield (
            f"note: speeds through the water are 0 while the ship makes way over ground: "
            f"{_lines(lines)}; if the log is faulty, set and drift are wrong"
        )


def _far_notes(log: NavigationLog, plane: LocalPlane) -> Iterator[str]:
    """Note the distortion of the plane far from the first fix."""
    fixes = log.fixes.sound()
    position_m = plane.position_m(
        latitude_rad=fixes.latitude_rad, longitude_rad=fixes.longitude_rad
    )
    far_m = np.hypot(*position_m.T).max()
    if far_m > _FAR_M:
        percent = 100.0 * plane_stretch(far_m)
        yield (
            f"note: fixes are up to {far_m / 1e3:.0f} km from the first one, whose plane is "
            f"stretched by {percent:.3g} % across the line to them, and speeds and drift with it: "
            "split the log before that"
        )


def _doubt_notes(legs: Sequence[_Leg]) -> Iterator[str]:
    """Note readings that the navigator rejected, or accepted only after a while."""
    jump_m = np.concatenate([leg.track.jump_m for leg in legs])
    far_m, near_m = jump_m[jump_m > own_ship.JUMP_M], jump_m[jump_m <= own_ship.JUMP_M]
    jumps = _fix_lines(legs, [leg.track.jump_m > own_ship.JUMP_M for leg in legs])
    moves = np.count_nonzero(near_m)
    by = f"by up to {near_m.max(initial=0.0):.0f} m"
    for what, lines in _rejected_lines(legs).items():
        went_on = moves and what == "fixes"
        times = many(moves, "time")
        moved = f"; {times} they persisted and moved the position {by}" if went_on else ""
        yield (
            f"note: {what} inconsistent with other readings are rejected: {_lines(lines)}{moved}"
        )
    if len(jumps):
        yield (
            f"note: the position jumps {many(len(jumps), 'time')}, to persistent rejected fixes, "
            f"first by {far_m[0]:.0f} m in line {jumps[0]}; from there the status is jumped, until "
            "the position returns or all fixes have been accepted for a minute"
        )


def _rejected_lines(legs: Sequence[_Leg]) -> dict[str, np.ndarray]:
    """Lines of rejected readings, by instrument."""
    rejected = [own_ship.rejected_lines(leg.part, leg.track) for leg in legs]
    kinds = dict.fromkeys(what for of_leg in rejected for what in of_leg)
    lines = {w: np.concatenate([r[w] for r in rejected if w in r]) for w in kinds}
    return {what: found for what, found in lines.items() if len(found)}


def _order_notes(legs: Sequence[_Leg]) -> Iterator[str]:
    time_s = np.concatenate([leg.track.time_s for leg in legs])
    back = np.flatnonzero(np.diff(time_s) < 0)
    if len(back):
        rows = ", ".join(f"{k + 3}" for k in back[:_SHOWN_ROWS])
        yield (
            f"note: the times of own.csv go back {many(len(back), 'time')} because the clock was "
            f"set back (line {rows}); split it there before you use it as an own-ship file"
        )


def _fix_lines(legs: Sequence[_Leg], masks: Sequence[np.ndarray]) -> np.ndarray:
    """Lines of the fixes at the masked times of the legs."""
    return np.concatenate(
        [
            fixes.line[np.isin(fixes.time_s, leg.track.time_s[mask])]
            for leg, mask in zip(legs, masks, strict=True)
            for fixes in [leg.part.fixes.sound()]
        ]
    )


def _input_lines(log: NavigationLog) -> str:
    fixes = log.fixes.sound()
    hours = np.ptp(fixes.time_s) / 3600.0 if len(fixes) else 0.0
    read, fixed = many(log.report.lines, "line"), counted(len(fixes), "[fix|fixes]")
    lines = [f"{log.name}: {read}, {fixed} in {hours:.2f} h"]
    lines += [f"note: {note}" for note in log.notes]
    return "\n".join(lines)


def _hold_out(legs: Sequence[_Leg]) -> dict[str, dict[float, np.ndarray]]:
    """Errors without satellites over all legs."""
    of_legs = [leg.readings for leg in legs]
    if any(own_ship.wants_offset(leg.part) for leg in legs):
        seen = [own_ship.without_hidden(leg.part, leg.readings) for leg in legs]
        offset = own_ship.magnetic_offset(seen) or own_ship.ANY_OFFSET
        of_legs = [own_ship.readings_of(g.part, offset, g.readings.plane) for g in legs]
    joined: dict[str, dict[float, list[np.ndarray]]] = {}
    for readings in progress(of_legs, len(of_legs), "hiding satellites"):
        for name, errors in own_ship.hold_out(readings).items():
            for horizon_s, values in errors.items():
                joined.setdefault(name, {}).setdefault(horizon_s, []).append(values)
    return {
        name: {horizon_s: np.concatenate(parts) for horizon_s, parts in errors.items()}
        for name, errors in joined.items()
    }


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
    """Write the problems of the log and report the file; without problems remove the file."""
    problems, count = log.report.examples, sum(log.report.problems.values())
    if count == 0:
        path.unlink(missing_ok=True)
        return []
    with replacing(path) as fresh, fresh.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("line", "kind", "reason"))
        writer.writerows((problem.line, problem.kind, problem.reason) for problem in problems)
    whole = len(problems) == count
    which = "all problems" if whole else f"the first {many(len(problems), 'problem')}"
    print(f"note: {which} are listed in {path.name}", flush=True)
    return [path]


def _write_csv(path: Path, legs: Sequence[_Leg]) -> None:
    with replacing(path) as fresh, fresh.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(_COLUMNS)
        rows = (row for leg in legs for row in _csv_rows(leg.track))
        total = sum(len(leg.track.time_s) for leg in legs)
        writer.writerows(progress(rows, total, f"writing {path.name}"))


def _csv_rows(track: own_ship.OwnTrack) -> Iterator[list[Any]]:
    place, speed = track.position_m2, track.velocity_m2s2
    numbers = np.column_stack(
        [
            track.velocity_mps,
            np.degrees(track.heading_rad) % 360.0,
            np.degrees(track.set_rad) % 360.0,
            np.hypot(*track.current_mps.T),
            track.drift_std_mps,
            *(place[:, 0, 0], place[:, 0, 1], place[:, 1, 1]),
            *(speed[:, 0, 0], speed[:, 0, 1], speed[:, 1, 1]),
            np.degrees(track.heading_std_rad),
        ]
    )
    where = np.column_stack([track.latitude_deg, track.longitude_deg])
    columns = (track.time_s, where, track.position_m, numbers, track.status)
    for time_s, where_deg, place_m, row, status in zip(*columns, strict=True):
        yield [
            f"{time_s:.3f}",
            *(f"{value:.8f}" for value in where_deg),
            *(f"{value:.3f}" for value in place_m),
            *("" if np.isnan(value) else f"{value:.6g}" for value in row),
            status,
        ]


def _write_pictures(folder: Path, legs: Sequence[_Leg], way: str) -> list[Path]:
    """Write the map and the panels over time, one pair per sufficiently long leg."""
    files = []
    drawn = [leg for leg in legs if leg.readings.has_fix.sum() >= _LEAST_DRAWN_FIXES]
    if len(drawn) < len(legs):
        short = f"{len(legs) - len(drawn)} of {many(len(legs), 'part')}"
        print(f"note: {short} not drawn, with fewer than {_LEAST_DRAWN_FIXES} fixes")
    watched = progress(drawn, len(drawn), "drawing")
    for number, (_, readings, track) in enumerate(watched, start=1):
        end = f"-{number}" if len(drawn) > 1 else ""
        files += [folder / f"own_map{end}.png", folder / f"own_time{end}.png"]
        has_fix = readings.has_fix
        figure = plot.figure(7.2, 6.4)
        plot.own_map(
            figure.add_subplot(),
            track.position_m,
            readings.fix_m[has_fix],
            track.current_mps,
            coasting=track.status == "coasting",
            jumped=track.status == "jumped",
            name=way,
        )
        plot.save(figure, files[-2])
        plot.save(_time_figure(readings, track, readings.time_s[has_fix]), files[-1])
    return files


def _earlier_pictures(folder: Path) -> Iterator[Path]:
    names = re.compile(r"own_(map|time)(-\d+)?\.png")
    return (file for file in folder.iterdir() if names.fullmatch(file.name))


def _time_figure(
    readings: own_ship.Readings, track: own_ship.OwnTrack, fix_time_s: np.ndarray
) -> Any:
    """Speed and course over time, and the drift if the current is known."""
    knows_drift = bool(np.isfinite(track.current_mps).any())
    figure = plot.figure(7.2, 6.8 if knows_drift else 4.6)
    speed, course, *drift = figure.subplots(2 + knows_drift, 1, sharex=True)
    over_ground = track.velocity_mps
    plot.speed_over_time(
        speed, track.time_s, np.hypot(over_ground[:, 0], over_ground[:, 1]), readings.log_mps
    )
    plot.course_over_time(course, track.time_s, track.course_rad, track.heading_rad)
    for ax in drift:
        plot.drift_over_time(ax, track.time_s, track.current_mps, fix_time_s)
    panels = [speed, course, *drift]
    for ax in panels[:-1]:
        ax.set_xlabel("")
    figure.align_ylabels(panels)
    return figure
