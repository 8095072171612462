"""Logs of an inertial measurement unit as CSV, with GNSS and heading or with an NMEA log beside."""

from __future__ import annotations

import csv
import dataclasses
import datetime
from pathlib import Path

import numpy as np

from wakeline._checks import shaped

from .errors import RecordingError
from .files import replacing
from .nmea import NavigationLog, NmeaReport, read_nmea
from .nmea.log import SERIES, Series
from .table import TIME_NAMES, Table

_NAMES = {
    "time_s": TIME_NAMES,
    "forward_mps2": ("forward_mps2", "accel_forward_mps2", "acceleration_forward_mps2"),
    "starboard_mps2": ("starboard_mps2", "accel_starboard_mps2", "acceleration_starboard_mps2"),
    "yaw_rate_deg_s": ("yaw_rate_deg_s", "turn_rate_deg_s"),
    "yaw_rate_rad_s": ("yaw_rate_rad_s", "turn_rate_rad_s"),
    "lat_deg": ("lat_deg", "latitude_deg", "lat", "latitude"),
    "lon_deg": ("lon_deg", "longitude_deg", "lon", "longitude"),
    "speed_mps": ("speed_mps", "sog_mps"),
    "course_deg": ("course_deg", "cog_deg"),
    "heading_deg": ("heading_deg", "heading_true_deg"),
    "heading_magnetic_deg": ("heading_magnetic_deg",),
}
_COLUMNS = (
    *("time_s", "forward_mps2", "starboard_mps2", "yaw_rate_deg_s"),
    *("lat_deg", "lon_deg", "heading_deg"),
)
_MOST_MPS2, _MOST_DEG_S, _MOST_DEG, _MOST_MPS = 100.0, 720.0, 720.0, 1e6


def read_imu(
    path: str | Path,
    nmea: str | Path | None = None,
    *,
    variation_deg: float | None = None,
    date: datetime.date | None = None,
) -> NavigationLog:
    """Read a log of an IMU.

    Parameters
    ----------
    path : str or Path
        CSV with a time and the columns ``forward_mps2``, ``starboard_mps2`` and ``yaw_rate_deg_s``
        or ``yaw_rate_rad_s`` (gravity removed, yaw positive to starboard), and optionally
        ``lat_deg`` and ``lon_deg`` of GNSS, ``speed_mps`` and ``course_deg`` over ground,
        ``heading_deg`` (true) and ``heading_magnetic_deg``. An empty cell is a missing reading.
    nmea : str or Path, optional
        NMEA 0183 log of the same times, for the readings that the CSV has no columns for.
    variation_deg : float, optional
        Magnetic variation of magnetic headings, positive east.
    date : datetime.date, optional
        Day of the first sentence of the NMEA log.

    Returns
    -------
    NavigationLog
        For :func:`wakeline.own_ship.navigate_log`.

    Raises
    ------
    RecordingError
        When a file cannot be read, a column is missing, a number is out of range, times decrease,
        there is no position in either file, or the times of both files have nothing in common.
    ValueError
        When `variation_deg` is out of range.
    """
    table = Table(path, _NAMES)
    yaw = "yaw_rate_rad_s" if "yaw_rate_rad_s" in table else "yaw_rate_deg_s"
    table.require("time_s", "forward_mps2", "starboard_mps2", yaw)
    time_s = table.times("time_s")
    table.check("time_s", np.diff(time_s, prepend=-np.inf) >= 0, "a time not before the last one")
    own = _series_of(table, time_s, yaw, variation_deg)
    if not len(own["imu"]):
        raise RecordingError(
            path, "there is no reading of the IMU", wanted="a row with three numbers"
        )
    if nmea is None:
        if not len(own["fixes"]):
            wanted = "columns lat_deg and lon_deg with numbers, or an NMEA log"
            raise RecordingError(path, "there is no position", wanted=wanted)
        empty = {name: _empty(kind) for name, kind in SERIES.items()}
        report = NmeaReport(lines=len(table) + 1)
        none = np.zeros(0, dtype=np.int64)
        return NavigationLog(table.path.stem, **(empty | own), dated=True, set_back_lines=none,
                             report=report, notes=[])  # fmt: skip
    beside = read_nmea(nmea, variation_deg=variation_deg, date=date)
    _check_times(beside, nmea, table.path, time_s)
    given = {name: series for name, series in own.items() if len(series)}
    return dataclasses.replace(beside, name=table.path.stem, **given)


def write_imu(
    path: str | Path,
    time_s: np.ndarray,
    imu: np.ndarray,
    latitude_deg: np.ndarray,
    longitude_deg: np.ndarray,
    heading_deg: np.ndarray,
) -> None:
    """Write a log that `read_imu` reads.

    `path` is replaced only when the new file is complete.

    Parameters
    ----------
    path : str or Path
        The file. Its folder must exist.
    time_s : (T,) array
    imu : (T, 3) array
        [forward m/s², starboard m/s², yaw rate rad/s].
    latitude_deg, longitude_deg, heading_deg : (T,) array
        NaN where there is no reading.
    """
    time_s = shaped("time_s", time_s, None)
    imu = shaped("imu", imu, len(time_s), 3)
    columns = (
        *((time_s, 3), (imu[:, 0], 4), (imu[:, 1], 4), (np.degrees(imu[:, 2]), 3)),
        *((latitude_deg, 7), (longitude_deg, 7), (heading_deg, 2)),
    )
    cells = [
        [
            "" if np.isnan(value) else f"{value:.{digits}f}"
            for value in shaped("a column", one, len(time_s))
        ]
        for one, digits in columns
    ]
    with replacing(Path(path)) as fresh, fresh.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(_COLUMNS)
        writer.writerows(zip(*cells, strict=True))


def _series_of(
    table: Table, time_s: np.ndarray, yaw: str, variation_deg: float | None
) -> dict[str, Series]:
    """The series of the columns that a table has."""
    line = np.array([table.line(row) for row in range(len(table))], dtype=np.int64)

    def numbers(column: str, most: float, unit: str) -> np.ndarray:
        if column not in table:
            return np.full(len(table), np.nan)
        values = table.numbers(column)
        table.check(column, np.isnan(values) | (np.abs(values) <= most), f"at most {most:g} {unit}")
        return values

    def series(name: str, needed: tuple[np.ndarray, ...], **columns: np.ndarray) -> Series:
        rows = np.isfinite(needed).all(axis=0)
        count = np.count_nonzero(rows)
        return SERIES[name](
            time_s=time_s[rows],
            valid=np.ones(count, dtype=bool),
            sentence=np.full(count, "CSV"),
            line=line[rows],
            **{key: np.broadcast_to(values, len(table))[rows] for key, values in columns.items()},
        )

    forward = numbers("forward_mps2", _MOST_MPS2, "m/s²")
    starboard = numbers("starboard_mps2", _MOST_MPS2, "m/s²")
    if yaw == "yaw_rate_deg_s":
        yaw_rad_s = np.radians(numbers(yaw, _MOST_DEG_S, "°/s"))
    else:
        yaw_rad_s = numbers(yaw, np.radians(_MOST_DEG_S), "rad/s")
    latitude = numbers("lat_deg", 90.0, "degrees")
    longitude = numbers("lon_deg", 360.0, "degrees")
    speed = numbers("speed_mps", _MOST_MPS, "m/s")
    course = np.radians(numbers("course_deg", _MOST_DEG, "degrees"))
    heading = np.radians(numbers("heading_deg", _MOST_DEG, "degrees"))
    magnetic = np.radians(numbers("heading_magnetic_deg", _MOST_DEG, "degrees"))
    variation = np.nan if variation_deg is None else np.radians(variation_deg)
    no, whole = np.array(False), 2 * np.pi
    return {
        "imu": series(
            *("imu", (forward, starboard, yaw_rad_s)),
            forward_mps2=forward,
            starboard_mps2=starboard,
            yaw_rate_rad_s=yaw_rad_s,
        ),
        "fixes": series(
            *("fixes", (latitude, longitude)),
            latitude_deg=latitude,
            longitude_deg=(longitude + 180.0) % 360.0 - 180.0,
            quality=np.array(-1),
            hdop=np.array(np.nan),
            frozen=no,
            suspect=no,
        ),
        "ground": series(
            *("ground", (speed,)), speed_mps=speed, course_rad=course % whole, frozen=no
        ),
        "heading": series("heading", (heading,), heading_rad=heading % whole),
        "compass": series(
            *("compass", (magnetic,)),
            heading_magnetic_rad=magnetic % whole,
            variation_rad=np.array(variation),
        ),
    }


def _empty(kind: type[Series]) -> Series:
    names = [f.name for f in dataclasses.fields(kind)]
    types = {"valid": bool, "frozen": bool, "suspect": bool, "sentence": "<U3"}
    types |= {"line": np.int64, "quality": np.int64}
    return kind(**{name: np.zeros(0, dtype=types.get(name, float)) for name in names})


def _check_times(beside: NavigationLog, nmea: str | Path, path: Path, time_s: np.ndarray) -> None:
    """Reject an NMEA log whose times are not those of the IMU."""
    if len(beside.set_back_lines):
        raise RecordingError(
            *(nmea, "the clock was set back"),
            line=int(beside.set_back_lines[0]),
            wanted="a log with one clock beside an IMU log; split it there",
        )
    heard_s = np.concatenate([series.time_s for series in beside.series.values()])
    if heard_s.max() < time_s[0] or heard_s.min() > time_s[-1]:
        raise RecordingError(
            *(nmea, f"its times are not those of {path}"),
            wanted=f"some from {time_s[0]:.3f} to {time_s[-1]:.3f} s",
            got=f"{heard_s.min():.3f} to {heard_s.max():.3f} s"
            + ("" if beside.dated else ", without a date"),
        )
