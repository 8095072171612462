"""A whole log through the navigator: its legs, notes on its readings, and errors of coasting."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import wakeline as wl
from wakeline._brief import many
from wakeline._progress import progress
from wakeline.recording import NavigationLog, replacing
from wakeline.recording.reach import plane_stretch

from .coasting import hold_out, without_hidden
from .instruments import FIX_STD_M
from .left_out import rejected_lines, unused, zero_speeds
from .magnetic import ANY_OFFSET, NO_OFFSET, MagneticOffset, magnetic_offset, wants_offset
from .readings import Readings, readings_of
from .solution import JUMP_M, OwnTrack, navigate

_COLUMNS = (
    *("time_s", "lat_deg", "lon_deg", "north_m", "east_m", "vnorth_mps", "veast_mps"),
    *("heading_deg", "set_deg", "drift_mps", "drift_std_mps"),
    *("north_var_m2", "north_east_cov_m2", "east_var_m2"),
    *("vnorth_var_m2s2", "vnorth_veast_cov_m2s2", "veast_var_m2s2", "heading_std_deg", "status"),
)
_BIAS_COLUMNS = (
    *("forward_bias_mps2", "starboard_bias_mps2", "gyro_bias_deg_s"),
    *("forward_bias_std_mps2", "starboard_bias_std_mps2", "gyro_bias_std_deg_s"),
)
_SHOWN_ROWS = 5
_FAR_M = 1000e3


class Leg(NamedTuple):
    """A part of a log without a gap of a minute: its log, its readings, and the solution."""

    part: NavigationLog
    readings: Readings
    track: OwnTrack


@dataclass(frozen=True)
class Voyage:
    """The solution of a log.

    Attributes
    ----------
    legs : list of Leg
        The parts that have a fix, in order of time, all in the plane of the first fix.
    notes : list of str
        Notes for the user: readings that are ignored, rejected or doubtful.
    """

    legs: list[Leg]
    notes: list[str]

    def hold_out(self) -> dict[str, dict[float, np.ndarray]]:
        """Errors without satellites over all legs, as of :func:`hold_out`, by method and horizon.

        Hidden speeds over ground are not used for the magnetic offset either.
        """
        of_legs = [leg.readings for leg in self.legs]
        if any(wants_offset(leg.part) for leg in self.legs):
            seen = [without_hidden(leg.part, leg.readings) for leg in self.legs]
            offset = magnetic_offset(seen) or ANY_OFFSET
            of_legs = [
                readings_of(leg.part, offset, leg.readings.plane, fix_std_m=leg.readings.fix_std_m)
                for leg in self.legs
            ]
        joined: dict[str, dict[float, list[np.ndarray]]] = {}
        for readings in progress(of_legs, len(of_legs), "hiding satellites"):
            for name, errors in hold_out(readings).items():
                for horizon_s, values in errors.items():
                    joined.setdefault(name, {}).setdefault(horizon_s, []).append(values)
        return {
            name: {horizon_s: np.concatenate(parts) for horizon_s, parts in errors.items()}
            for name, errors in joined.items()
        }


def navigate_log(
    log: NavigationLog, *, smooth: bool = False, fix_std_m: float = FIX_STD_M
) -> Voyage:
    """Navigate a whole log; parts separated by a gap of a minute are independent.

    Parameters
    ----------
    log : NavigationLog
        From :func:`wakeline.recording.read_nmea`, or :func:`wakeline.recording.read_imu`.
    smooth : bool
        Whether each time also uses later readings, up to a gap or to a rejected reading that
        persisted.
    fix_std_m : float
        Standard deviation of a fix, per axis.

    Raises
    ------
    ValueError
        When the log has no usable fix, or `fix_std_m` is not positive.

    Examples
    --------
    >>> from wakeline import own_ship, recording
    >>> voyage = own_ship.navigate_log(recording.load_navigation())
    >>> len(voyage.legs)
    2
    """
    fixes = log.fixes.sound()
    if len(fixes) == 0:
        unsound = len(log.fixes)
        raise ValueError(
            f"{log.name}: there is no usable fix; wanted at least one usable fix, "
            f"got {unsound} that are not usable"
        )
    parts, plane = log.parts(), fixes.plane()
    offset, notes = _magnetic_offset(log, parts)
    notes += [*_unused_notes(parts), *_stuck_notes(parts), *_far_notes(log, plane)]
    fixed = [part for part in parts if len(part.fixes.sound())]
    legs = []
    for part in progress(fixed, len(fixed), "navigating"):
        readings = readings_of(part, offset, plane, fix_std_m=fix_std_m)
        legs.append(Leg(part, readings, navigate(readings, smooth=smooth)))
    notes += [*_bias_notes(legs), *_doubt_notes(legs), *_order_notes(legs)]
    return Voyage(legs, notes)


def write_own(path: str | Path, tracks: Sequence[OwnTrack]) -> None:
    """Write solutions as an own-ship file, which ``wakeline track --own`` takes.

    With an IMU further columns have its biases. `path` is replaced only when the new file is
    complete.

    Parameters
    ----------
    path : str or Path
        The file. Its folder must exist.
    tracks : sequence of OwnTrack
        Such as those of the legs of a voyage, written in order.
    """
    path = Path(path)
    with replacing(path) as fresh, fresh.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        has_imu = any(np.isfinite(track.imu_bias).any() for track in tracks)
        writer.writerow((*_COLUMNS, *_BIAS_COLUMNS) if has_imu else _COLUMNS)
        rows = (row for track in tracks for row in _csv_rows(track, has_imu))
        total = sum(len(track.time_s) for track in tracks)
        writer.writerows(progress(rows, total, f"writing {path.name}"))


def _csv_rows(track: OwnTrack, has_imu: bool) -> Iterator[list[Any]]:
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
    biases = np.column_stack([track.imu_bias, track.imu_bias_std])[:, : 6 * has_imu]
    biases[:, 2::3] = np.degrees(biases[:, 2::3])
    columns = (track.time_s, where, track.position_m, numbers, track.status, biases)
    for time_s, where_deg, place_m, row, status, bias in zip(*columns, strict=True):
        yield [
            f"{time_s:.3f}",
            *(f"{value:.8f}" for value in where_deg),
            *(f"{value:.3f}" for value in place_m),
            *map(_cell, row),
            status,
            *map(_cell, bias),
        ]


def _cell(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.6g}"


def _magnetic_offset(
    log: NavigationLog, parts: Sequence[NavigationLog]
) -> tuple[MagneticOffset, list[str]]:
    """The offset of magnetic headings of unknown variation, and notes about it."""
    if not any(map(wants_offset, parts)):
        return NO_OFFSET, []
    offset = magnetic_offset(parts)
    how = "(unknown)" if offset is None else "(estimated from velocities over ground)"
    offset = offset or ANY_OFFSET
    degrees, std_deg = np.degrees(offset)
    added = f"{degrees:+.1f}° ± {std_deg:.1f}° are added to magnetic headings"
    notes = [f"{added} of unknown variation {how}"]
    if len(log.water.sound()):
        share = f"{100.0 * offset.std_rad:.0f} %"
        notes.append(f"without --variation set and drift have an error of {share} of the speed")
    return offset, notes


def _unused_notes(parts: Sequence[NavigationLog]) -> Iterator[str]:
    of_parts = [unused(part) for part in parts]
    for what in of_parts[0]:
        lines = np.concatenate([lines_of[what] for lines_of in of_parts])
        if len(lines):
            yield f"{what} are not used: {_lines(lines)}"


def _lines(lines: np.ndarray) -> str:
    return f"{len(lines)} (first in line {lines.min()})"


def _stuck_notes(parts: Sequence[NavigationLog]) -> Iterator[str]:
    lines = np.concatenate([zero_speeds(part) for part in parts])
    if len(lines):
        yield (
            f"speeds through the water are 0 while the ship makes way over ground: "
            f"{_lines(lines)}; if the log is faulty, set and drift are wrong"
        )


def _far_notes(log: NavigationLog, plane: wl.LocalPlane) -> Iterator[str]:
    """Note the distortion of the plane far from the first fix."""
    fixes = log.fixes.sound()
    position_m = plane.position_m(
        latitude_rad=fixes.latitude_rad, longitude_rad=fixes.longitude_rad
    )
    far_m = np.hypot(*position_m.T).max()
    if far_m > _FAR_M:
        percent = 100.0 * plane_stretch(far_m)
        yield (
            f"fixes are up to {far_m / 1e3:.0f} km from the first one, whose plane is "
            f"stretched by {percent:.3g} % across the line to them, and speeds and drift with it: "
            "split the log before that"
        )


def _bias_notes(legs: Sequence[Leg]) -> Iterator[str]:
    """The biases of the IMU at the end of the last leg that has them."""
    for leg in legs[::-1]:
        bias, std = leg.track.imu_bias[-1], leg.track.imu_bias_std[-1]
        if np.isfinite(bias).all():
            forward, starboard = (
                f"{b:+.3f} ± {s:.3f}" for b, s in zip(bias[:2], std, strict=False)
            )
            gyro = f"{np.degrees(bias[2]):+.3f} ± {np.degrees(std[2]):.3f} °/s"
            yield f"biases of the IMU: forward {forward}, starboard {starboard} m/s², gyro {gyro}"
            return


def _doubt_notes(legs: Sequence[Leg]) -> Iterator[str]:
    """Note readings that the navigator rejected, or accepted only after a while."""
    jump_m = np.concatenate([leg.track.jump_m for leg in legs])
    far_m, near_m = jump_m[jump_m > JUMP_M], jump_m[jump_m <= JUMP_M]
    jumps = _fix_lines(legs, [leg.track.jump_m > JUMP_M for leg in legs])
    moves = np.count_nonzero(near_m)
    by = f"by up to {near_m.max(initial=0.0):.0f} m"
    for what, lines in _rejected_lines(legs).items():
        went_on = moves and what == "fixes"
        times = many(moves, "time")
        moved = f"; {times} they persisted and moved the position {by}" if went_on else ""
        yield (f"{what} inconsistent with other readings are rejected: {_lines(lines)}{moved}")
    if len(jumps):
        yield (
            f"the position jumps {many(len(jumps), 'time')}, to persistent rejected fixes, "
            f"first by {far_m[0]:.0f} m in line {jumps[0]}; from there the status is jumped, until "
            "the position returns or all fixes have been accepted for a minute"
        )


def _rejected_lines(legs: Sequence[Leg]) -> dict[str, np.ndarray]:
    """Lines of rejected readings, by instrument."""
    rejected = [rejected_lines(leg.part, leg.track) for leg in legs]
    kinds = dict.fromkeys(what for of_leg in rejected for what in of_leg)
    lines = {w: np.concatenate([r[w] for r in rejected if w in r]) for w in kinds}
    return {what: found for what, found in lines.items() if len(found)}


def _order_notes(legs: Sequence[Leg]) -> Iterator[str]:
    time_s = np.concatenate([leg.track.time_s for leg in legs])
    back = np.flatnonzero(np.diff(time_s) < 0)
    if len(back):
        rows = ", ".join(f"{k + 3}" for k in back[:_SHOWN_ROWS])
        yield (
            f"the times of own.csv go back {many(len(back), 'time')} because the clock was "
            f"set back (line {rows}); split it there before you use it as an own-ship file"
        )


def _fix_lines(legs: Sequence[Leg], masks: Sequence[np.ndarray]) -> np.ndarray:
    """Lines of the fixes at the masked times of the legs."""
    return np.concatenate(
        [
            fixes.line[np.isin(fixes.time_s, leg.track.time_s[mask])]
            for leg, mask in zip(legs, masks, strict=True)
            for fixes in [leg.part.fixes.sound()]
        ]
    )
