"""Offsets of the radar of a recording, from reports of vessels in it or from another radar."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import wakeline as wl
from wakeline._brief import many
from wakeline._checks import positive
from wakeline.recording import Recording, RecordingError, ais_csv, read_ais, truth_csv
from wakeline.recording.table import Table, finding_columns

from .settings import Settings, read_settings
from .tracked import TrackedEpisode, TrackedRecording

Reports = Mapping[str, Any]


@dataclass(frozen=True)
class RadarTrack:
    """A track of a radar in place of the reports of its vessel.

    Attributes
    ----------
    time_s, north_m, east_m, vnorth_mps, veast_mps : ndarray (n,)
        By the clock of the radar.
    covariance : ndarray (n, 2, 2)
        Of the positions.
    antenna_north_m, antenna_east_m : ndarray (n,)
        Where the radar was.
    """

    time_s: np.ndarray
    north_m: np.ndarray
    east_m: np.ndarray
    vnorth_mps: np.ndarray
    veast_mps: np.ndarray
    covariance: np.ndarray
    antenna_north_m: np.ndarray
    antenna_east_m: np.ndarray


@finding_columns
def read_reports(
    path: str | Path,
    recording: Recording,
    *,
    origin_deg: tuple[float, float] | None = None,
    columns: Mapping[str, str] | None = None,
) -> list[Reports]:
    """Read position reports of vessels in the area of a recording.

    Parameters
    ----------
    path : str or Path
        AIS with latitudes and longitudes (:func:`wakeline.recording.read_ais`), or positions in the
        plane of the recording: ``time_s``, ``target`` (or ``mmsi``), ``north_m``, ``east_m``, and
        optionally ``vnorth_mps``, ``veast_mps``, ``scenario``.
    recording : Recording
        Its notes receive the remarks.
    origin_deg : (float, float), optional
        Latitude and longitude of north 0, east 0 of the recording; AIS needs them.
    columns : dict of str to str, optional
        Names of columns in the file and what they are.

    Returns
    -------
    list of dict of str to AisTrack or TargetTruth
        For each episode of the recording the reports of each vessel.

    Raises
    ------
    RecordingError
        When the file cannot be read, or is AIS and the origin is missing.
    """
    both = {
        "latitude": ais_csv.COLUMNS["latitude"],
        "north_m": truth_csv.COLUMNS["north_m"],
    }
    table = Table(path, both, [], columns)
    if "latitude" not in table:
        return list(truth_csv.read_truth(path, recording, columns))
    if origin_deg is None:
        raise RecordingError(
            table.path,
            "latitudes need the place of the recording",
            column=table.name("latitude"),
            wanted="the latitude and longitude of its north 0, east 0 (--origin)",
        )
    ais = read_ais(path, origin_deg=origin_deg, columns=columns)
    recording.notes.extend(ais.notes)
    return [ais.tracks] * len(recording)


def reports_of(tracks: TrackedRecording) -> list[dict[str, RadarTrack]]:
    """The tracks of one radar as what another one is compared with.

    Smoothed tracks (``tracks.smooth()``) have no lag in turns.

    Returns
    -------
    list of dict of str to RadarTrack
        For each episode its tracks by number.

    Examples
    --------
    >>> import wakeline as wl
    >>> joyride = wl.recording.load("joyride")
    >>> reports = wl.tracking.reports_of(wl.track_recording(joyride).smooth())
    >>> list(reports[0])
    ['1']
    """
    return [_reports_of(tracked) for tracked in tracks.episodes]


def _reports_of(tracked: TrackedEpisode) -> dict[str, RadarTrack]:
    found = {}
    for track in tracked.tracks:
        north_m, vnorth_mps, east_m, veast_mps = track.state.T
        place = (north_m, east_m, vnorth_mps, veast_mps)
        covariance = track.covariance[:, ::2, ::2]
        antenna_m = tracked.episode.own.position_at(track.time_s)
        name = str(track.track_id[0])
        found[name] = RadarTrack(track.time_s, *place, covariance, *antenna_m.T)
    return found


def calibrate(
    recording: Recording,
    reports: Reports | Sequence[Reports],
    *,
    radar: wl.Radar | str | Path | None = None,
    config: Settings | wl.CalibrationConfig | str | Path | None = None,
    position_std_m: float = 5.0,
) -> wl.track.CalibrationResult:
    """Find the offsets of the radar of a recording from position reports, or from another radar.

    Parameters
    ----------
    recording : Recording
    reports : dict of str to track, or a sequence of them
        The reports of each vessel (AIS, GNSS), for all episodes or for each: objects with
        ``time_s``, ``north_m``, ``east_m``, ``vnorth_mps``, ``veast_mps`` such as an ``AisTrack``,
        a ``TargetTruth`` or an ``OwnShipMotion`` of :mod:`wakeline.recording`; or the tracks of
        another radar (:func:`reports_of`), and the offsets are those less the ones of that radar.
    radar : Radar, str or Path, optional
        As for :func:`wakeline.track_recording`; its errors count, its offsets do not.
    config : Settings, CalibrationConfig, str or Path, optional
        Settings with the radar, or parameters of the calibration.
    position_std_m : float
        Standard deviation of a report per axis; tracks have their covariances.

    Returns
    -------
    CalibrationResult
        Vessels have the numbers 0, 1, ... in the order of their names over all episodes
        (:func:`vessel_names`).

    Raises
    ------
    ValueError
        When there are not as many mappings of reports as episodes, episodes overlap in time, or a
        parameter is invalid.

    Examples
    --------
    >>> import wakeline as wl
    >>> recording = wl.recording.load("joyride")
    >>> reports = [episode.truth for episode in recording]
    >>> found = wl.tracking.calibrate(recording, reports, position_std_m=3.0)
    >>> found.bearing_rad.verdict
    'determined'
    """
    positive(position_std_m=position_std_m)
    each = [reports] * len(recording) if isinstance(reports, Mapping) else list(reports)
    if len(each) != len(recording):
        raise ValueError(
            f"reports must be one mapping or one for each of {many(len(recording), 'episode')}, "
            f"got {len(each)}"
        )
    parameters = config if isinstance(config, wl.CalibrationConfig) else wl.CalibrationConfig()
    if isinstance(config, wl.CalibrationConfig):
        config = None
    settings = read_settings(config, radar).knowing(recording.radar)
    calibration = wl.Calibration(settings.make_radar(), parameters)
    number = {name: k for k, name in enumerate(vessel_names(each))}
    end_s = -np.inf
    pairs = zip(recording, each, strict=True)
    for episode, known in sorted(pairs, key=lambda pair: pair[0].time_s.min(initial=np.inf)):
        feed = _Feed(calibration, known, number, position_std_m)
        for scan in episode.scans:
            last_s = max(scan.time_s, scan.plot_time_s.max(initial=-np.inf))
            if last_s < end_s:
                raise ValueError(
                    f"episodes must follow each other in time, got a scan at {last_s} s after "
                    f"one at {end_s} s"
                )
            end_s = last_s
            feed.until(last_s)
            ways = episode.own.velocity_at(scan.plot_time_s) if episode.own.knows_velocity else None
            calibration.add_plots(
                scan.plot_time_s,
                range_m=scan.range_m,
                bearing_rad=scan.bearing_rad,
                own_north_m=scan.own_north_m,
                own_east_m=scan.own_east_m,
                own_vnorth_mps=0.0 if ways is None else ways[:, 0],
                own_veast_mps=0.0 if ways is None else ways[:, 1],
            )
        feed.until(end_s + parameters.max_gap_s)
    return calibration.solve()


def vessel_names(reports: Sequence[Reports]) -> list[str]:
    """Names of the vessels, each once, in the order of their numbers in a calibration."""
    return list(dict.fromkeys(name for one in reports for name in one))


class _Feed:
    """Reports of all vessels in order of time."""

    def __init__(
        self,
        calibration: wl.Calibration,
        reports: Reports,
        number: Mapping[str, int],
        position_std_m: float,
    ) -> None:
        self._calibration, self._std_m, self._next = calibration, position_std_m, 0
        tables = [_columns(track, number[name]) for name, track in reports.items()]
        names = tables[0] if tables else ()
        joined = {"time_s": np.zeros(0)}
        joined |= {name: np.concatenate([one[name] for one in tables]) for name in names}
        order = np.argsort(joined["time_s"], kind="stable")
        self._columns = {name: column[order] for name, column in joined.items()}

    def until(self, time_s: float) -> None:
        """Give the reports up to a time."""
        end = int(np.searchsorted(self._columns["time_s"], time_s, side="right"))
        for k in range(self._next, end):
            report = {name: column[k : k + 1] for name, column in self._columns.items()}
            vessel = int(report.pop("vessel")[0])
            self._calibration.add_reports(vessel, position_std_m=self._std_m, **report)
        self._next = max(end, self._next)


def _columns(track: Any, vessel: int) -> dict[str, np.ndarray]:
    """Columns of a track as `add_reports` takes them, NaN where it has none."""
    count = len(track.time_s)
    columns = {"vessel": np.full(count, vessel), "covariance": np.zeros((count, 2, 2))}
    for name in ("time_s", "north_m", "east_m", "vnorth_mps", "veast_mps"):
        column = getattr(track, name)
        columns[name] = np.full(count, np.nan) if column is None else column
    antenna = dict.fromkeys(("antenna_north_m", "antenna_east_m"), np.full(count, np.nan))
    if isinstance(track, RadarTrack):
        antenna = {name: getattr(track, name) for name in antenna}
        columns["covariance"] = track.covariance
    return columns | antenna
