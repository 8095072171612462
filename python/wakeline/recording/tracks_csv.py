"""Tracks as CSV: one row per confirmed track and scan."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wakeline._brief import brief, cut, many, span
from wakeline._checks import real_numbers, shaped
from wakeline._frames import data_frame

from .errors import RecordingError
from .files import replacing
from .table import TIME_NAMES, Table, finding_columns

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame

    from .model import Episode, Recording

_FIRST = ("time_s", "north_m", "east_m", "vnorth_mps", "veast_mps")
COVARIANCE_COLUMNS = (
    "var_north_m2",
    "cov_north_vnorth_m2ps",
    "cov_north_east_m2",
    "cov_north_veast_m2ps",
    "var_vnorth_m2ps2",
    "cov_vnorth_east_m2ps",
    "cov_vnorth_veast_m2ps2",
    "var_east_m2",
    "cov_east_veast_m2ps",
    "var_veast_m2ps2",
)
_UPPER = np.triu_indices(4)
_MAX_MODES = 64
APPROACH_COLUMNS = ("cpa_m", "tcpa_s", "cpa_probability")
_NAMES = (
    "track_id",
    *_FIRST,
    *COVARIANCE_COLUMNS,
    "status",
    "nis",
    *APPROACH_COLUMNS,
    "scenario",
    *(f"mode_{k}" for k in range(1, _MAX_MODES + 1)),
)


@dataclass(frozen=True)
class Tracks:
    """Rows of tracks, one per track and scan.

    Attributes
    ----------
    track_id : ndarray of str (n,)
    time_s : ndarray (n,)
        Time of the scan.
    state : ndarray (n, 4)
        ``[north, vnorth, east, veast]``, metres and metres per second.
    covariance : ndarray (n, 4, 4) or None
        Of the state.
    mode_probability : ndarray (n, K) or None
        Of a multiple-model estimator.
    status : ndarray of str (n,) or None
        State of the track at the scan, such as ``confirmed`` or ``coasting``.
    nis : ndarray (n,) or None
        Normalized innovation squared of the associated plot, NaN without one.
    scenario : ndarray of str (n,) or None
        Episode of the recording that a row belongs to.
    cpa_m, tcpa_s, cpa_probability : ndarray (n,) or None
        Closest approach to own ship: distance, time until then (negative: in the past), and the
        probability of a distance below a limit.
    alarmed : ndarray of bool (n,) or None
        Rows in an encounter with own ship (:func:`wakeline.tracking.watch_tracks`); not written to
        files of tracks.

    Raises
    ------
    ValueError
        When an array does not have the shape above.
    """

    track_id: np.ndarray
    time_s: np.ndarray
    state: np.ndarray
    covariance: np.ndarray | None = None
    mode_probability: np.ndarray | None = None
    status: np.ndarray | None = None
    nis: np.ndarray | None = None
    scenario: np.ndarray | None = None
    cpa_m: np.ndarray | None = None
    tcpa_s: np.ndarray | None = None
    cpa_probability: np.ndarray | None = None
    alarmed: np.ndarray | None = None

    def __post_init__(self) -> None:
        n = len(self.time_s)
        wanted = {"track_id": (n,), "time_s": (n,), "state": (n, 4)}
        optional = {"covariance": (n, 4, 4), "status": (n,), "nis": (n,), "scenario": (n,)}
        optional |= dict.fromkeys(APPROACH_COLUMNS, (n,))
        wanted |= {k: shape for k, shape in optional.items() if getattr(self, k) is not None}
        for name, shape in wanted.items():
            is_text = name in ("track_id", "status", "scenario")
            given = getattr(self, name)
            array = np.asarray(given, dtype=str) if is_text else real_numbers(name, given)
            _check_shape(name, array.shape, shape)
            object.__setattr__(self, name, array)
        if self.alarmed is not None:
            object.__setattr__(self, "alarmed", shaped("alarmed", self.alarmed, n).astype(bool))
        if self.mode_probability is not None:
            modes = real_numbers("mode_probability", self.mode_probability)
            object.__setattr__(self, "mode_probability", modes)
            _check_shape("mode_probability", modes.shape, (n, modes.shape[-1] if modes.ndim else 0))

    def __len__(self) -> int:
        return len(self.time_s)

    def __repr__(self) -> str:
        when = span(np.sort(self.time_s))
        return brief(self, many(len(self.ids()), "track"), many(len(self), "row"), when)

    def where(self, chosen: np.ndarray) -> Tracks:
        """The chosen rows, by mask or by index."""
        columns = {name: getattr(self, name) for name in _COLUMNS}
        return Tracks(**{k: None if v is None else v[chosen] for k, v in columns.items()})

    @staticmethod
    def joined(parts: Sequence[Tracks]) -> Tracks:
        """The rows of all parts in order, with the columns that every part has."""
        if not parts:
            return Tracks(np.zeros(0, dtype=str), np.zeros(0), np.zeros((0, 4)))
        columns = {name: [getattr(part, name) for part in parts] for name in _COLUMNS}
        shared = {k: v for k, v in columns.items() if all(values is not None for values in v)}
        return Tracks(**{name: np.concatenate(values) for name, values in shared.items()})

    def ids(self) -> list[str]:
        """The track ids in order of first row."""
        return list(dict.fromkeys(self.track_id.tolist()))

    def __getitem__(self, track_id: str | int) -> Tracks:
        """The rows of one track, in every scenario that has its id.

        Raises
        ------
        KeyError
            When no row has the id.
        """
        chosen = self.track_id == str(track_id)
        if not chosen.any():
            raise KeyError(f"no track {track_id!r}, but {cut(', '.join(self.ids())) or 'none'}")
        return self.where(chosen)

    def __iter__(self) -> Iterator[Tracks]:
        """The rows of each track, in order of first row."""
        return map(self.__getitem__, self.ids())

    def to_pandas(self) -> DataFrame:
        """The rows as a `pandas.DataFrame` with the columns of a tracks file (`write_tracks`)."""
        return data_frame(_columns(self))

    def plot(self, recording: Recording | Episode | None = None, **options: Any) -> Figure:
        """The tracks on a map, with a recording below them; see :func:`wakeline.plot.map`.

        Parameters
        ----------
        recording : Recording or Episode, optional
            Plots, own ship and truth.
        **options
            As for :func:`wakeline.plot.map`.

        Returns
        -------
        matplotlib.figure.Figure
            For :func:`wakeline.plot.save`.
        """
        from wakeline.plot import map as draw_map

        return draw_map(self, recording, **options)

    @property
    def north_m(self) -> np.ndarray:
        """Positions north, (n,)."""
        return self.state[:, 0]

    @property
    def east_m(self) -> np.ndarray:
        """Positions east, (n,)."""
        return self.state[:, 2]

    @property
    def course_deg(self) -> np.ndarray:
        """Courses over ground, (n,), clockwise from north in [0, 360)."""
        course = np.degrees(np.arctan2(self.state[:, 3], self.state[:, 1])) % 360.0
        return np.where(course == 360.0, 0.0, course)

    @property
    def speed_mps(self) -> np.ndarray:
        """Speeds over ground, (n,)."""
        return np.hypot(self.state[:, 1], self.state[:, 3])


_COLUMNS = tuple(column.name for column in fields(Tracks))


@finding_columns
def read_tracks(
    path: str | Path,
    *,
    columns: Mapping[str, str] | None = None,
    notes: list[str] | None = None,
) -> Tracks:
    """Read a tracks file.

    Columns: ``track_id, time_s, north_m, east_m, vnorth_mps, veast_mps``; optionally all covariance
    terms, ``mode_1`` onwards, ``status``, ``nis``, ``cpa_m``, ``tcpa_s``, ``cpa_probability``,
    ``scenario``. Other columns are ignored. Numbers may be NaN, times may not. A file with only a
    header has no rows. Rows that cannot be read are left out.

    Parameters
    ----------
    path : str or Path
        The file.
    columns : dict of str to str, optional
        Names of columns in this file and which of the columns above they are.
    notes : list of str, optional
        Notes are added to it.

    Raises
    ------
    RecordingError
        When a column is missing or more than a tenth of the rows cannot be read.
    """
    meanings = {name: (name,) for name in _NAMES} | {"time_s": TIME_NAMES}
    table = Table(path, meanings, [] if notes is None else notes, columns)
    table.require("track_id", *_FIRST)
    number = table.numbers
    tracks = Tracks(
        track_id=np.array(table.text("track_id"), dtype=str),
        time_s=table.times("time_s"),
        state=_state(table),
        covariance=_covariance(table),
        mode_probability=_modes(table),
        status=np.array(table.text("status"), dtype=str) if "status" in table else None,
        nis=number("nis") if "nis" in table else None,
        scenario=np.array(table.text("scenario"), dtype=str) if "scenario" in table else None,
        **{name: number(name) for name in APPROACH_COLUMNS if name in table},
    )
    return tracks.where(table.kept())


def write_tracks(path: str | Path, tracks: Tracks) -> None:
    """Write a tracks file; `path` is replaced only when the new file is complete.

    The columns are ``track_id, time_s, north_m, east_m, vnorth_mps, veast_mps, course_deg,
    speed_mps``, then, if `tracks` has them, the ten upper covariance terms of
    ``[north, vnorth, east, veast]`` row by row, ``mode_1`` onwards, ``status``, ``nis``,
    ``cpa_m``, ``tcpa_s``, ``cpa_probability``, ``scenario``. Numbers are read back to the last bit.

    Parameters
    ----------
    path : str or Path
        The file to write. Its folder must exist.
    tracks : Tracks
        The rows, written in order.
    """
    columns = _columns(tracks)
    with replacing(path) as fresh, fresh.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))


def _columns(tracks: Tracks) -> dict[str, list]:
    """Columns by name, in the order of the file."""
    north, vnorth, east, veast = tracks.state.T
    columns = {
        "track_id": tracks.track_id,
        "time_s": tracks.time_s,
        "north_m": north,
        "east_m": east,
        "vnorth_mps": vnorth,
        "veast_mps": veast,
        "course_deg": tracks.course_deg,
        "speed_mps": tracks.speed_mps,
    }
    if tracks.covariance is not None:
        terms = tracks.covariance[:, _UPPER[0], _UPPER[1]].T
        columns |= dict(zip(COVARIANCE_COLUMNS, terms, strict=True))
    if tracks.mode_probability is not None:
        columns |= {f"mode_{k}": p for k, p in enumerate(tracks.mode_probability.T, start=1)}
    for name in ("status", "nis", *APPROACH_COLUMNS, "scenario"):
        if getattr(tracks, name) is not None:
            columns[name] = getattr(tracks, name)
    return {name: values.tolist() for name, values in columns.items()}


def _state(table: Table) -> np.ndarray:
    way_m, speed_mps = table.ways_m, table.speeds_mps
    north = [way_m("north_m"), speed_mps("vnorth_mps")]
    return np.column_stack([*north, way_m("east_m"), speed_mps("veast_mps")])


def _covariance(table: Table) -> np.ndarray | None:
    if not all(name in table for name in COVARIANCE_COLUMNS):
        return None
    covariance = np.empty((len(table), 4, 4))
    for i, j, name in zip(*_UPPER, COVARIANCE_COLUMNS, strict=True):
        covariance[:, i, j] = covariance[:, j, i] = table.numbers(name)
    return covariance


def _modes(table: Table) -> np.ndarray | None:
    names = [name for name in (f"mode_{k}" for k in range(1, _MAX_MODES + 1)) if name in table]
    if not names:
        return None
    if names != [f"mode_{k}" for k in range(1, len(names) + 1)]:
        raise RecordingError(
            table.path,
            "a mode column is missing",
            line=1,
            wanted=f"mode_1 to {names[-1]}",
            got=", ".join(names),
        )
    return np.column_stack([table.numbers(name) for name in names])


def _check_shape(name: str, got: tuple[int, ...], wanted: tuple[int, ...]) -> None:
    if got != wanted:
        raise ValueError(f"{name} must have shape {wanted}, got {got}")
