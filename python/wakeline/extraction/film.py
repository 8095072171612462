"""A file of radar video as a recording of plots."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from wakeline._brief import many
from wakeline._progress import counted
from wakeline.recording import (
    Episode,
    OwnShipMotion,
    RadarVideo,
    Recording,
    Scan,
    VideoReport,
    read_video,
)
from wakeline.recording.azimuths import (
    azimuth_notes,
    check_azimuth,
    headings_at,
    turned_to_north,
)
from wakeline.recording.own_csv import OWN_GAP_S, OwnRows, read_own_track
from wakeline.recording.table import finding_columns
from wakeline.recording.units import period_notes

from .plots import Extraction, Plots, joined
from .turns import judged, turns

_UNSEEN = 2.0  # plots have more error than their cells: echoes wander over the hull and split
_DAY_S = 86400.0


@dataclass(frozen=True, kw_only=True, repr=False)
class VideoRecording(Recording):
    """The plots of radar video: one scan per revolution, one episode per clock reset.

    ``radar`` has the errors of plots as estimated from their echoes: ``range_std_m`` and
    ``bearing_std_deg``.

    Attributes
    ----------
    last : RadarVideo
        The last revolution.
    """

    last: RadarVideo

    @property
    def plot_std(self) -> tuple[float, float]:
        """Errors of plots as estimated from their echoes: range in metres, bearing in radians."""
        return self.radar["range_std_m"], float(np.deg2rad(self.radar["bearing_std_deg"]))


@finding_columns
def read_plots_of_video(
    path: str | Path,
    own_path: str | Path | None = None,
    *,
    period_s: float | None = None,
    azimuth: str = "north",
    range_scale_m: float | None = None,
    min_range_m: float = 0.0,
    columns: Mapping[str, str] | None = None,
    extraction: Extraction | None = None,
) -> VideoRecording:
    """Read radar video and extract plots, one antenna revolution per scan.

    An incomplete revolution at either end of the recording is dropped. A new episode begins where
    the clock was set back. Without `own_path` the radar is at the origin. Video has only the time
    of day; its date is that of own ship's track. Without a time of day, or with one that stands,
    `period_s` is the duration of a revolution. Azimuths count from `azimuth`, "north" or "bow", to
    which the heading of own ship's file is added; a note says if they look like those from the
    other one. Of several range scales in turn the one nearest to `range_scale_m` is read, by
    default the longest. Cells nearer than `min_range_m`, by default 40 m or a tenth of a shorter
    range scale, give no plots. `columns` names columns of own ship's file. Plots are made by
    `extraction`, or another object with its methods.

    Raises
    ------
    RecordingError
        When the file has no radar video, or own ship's position is unknown at a plot, or own ship's
        file has several scenarios or lacks the heading.
    ValueError
        When `azimuth` is unknown, or "bow" without own ship's file.
    """
    check_azimuth(azimuth, own_path)
    path = Path(path)
    report = VideoReport()
    extraction = extraction or Extraction(min_range_m)
    parts: list[list[_Seen]] = []
    begun = 0
    blocks = read_video(path, period_s=period_s, range_scale_m=range_scale_m, report=report)
    for turn in counted(judged(turns(blocks)), "turns"):
        if not turn.whole:
            begun += 1
            continue
        if not parts or turn.begin_s < parts[-1][-1].end_s:
            _finish(parts, extraction)
            parts.append([])
        parts[-1].append(_Seen(turn.end_s, extraction.plots_of(turn)))
        last = turn.longest
    _finish(parts, extraction)
    variance = np.concatenate([seen.plots.variance for part in parts for seen in part])
    notes = [f"summary of the sender: {text}" for text in report.summaries]
    notes += [*report.notes, *extraction.notes()]
    if begun:
        notes.append(f"{begun} incomplete revolution{'s' * (begun > 1)} left out")
    ship = OwnShipMotion.fixed()
    if own_path is not None:
        rows = read_own_track(own_path, notes, columns)
        shift_s = days_s(rows, (parts[0][0].end_s + parts[-1][-1].end_s) / 2.0)
        parts = [[seen.later(shift_s) for seen in part] for part in parts]
        _check_covered(rows, parts, path)
        ship = rows.ship()
    episodes = _episodes(parts, ship, notes)
    if azimuth == "bow":
        episodes = [turned_to_north(episode, own_path) for episode in episodes]
        heading_rad = headings_at(ship, last.time_s + shift_s, own_path)
        last = replace(last, azimuth_rad=last.azimuth_rad + heading_rad)
    notes += [*period_notes(episodes, period_s), *azimuth_notes(episodes, azimuth)]
    radar = radar_of(variance, last)
    return VideoRecording(path.stem, episodes, notes, radar, last=last)


def radar_of(variance: np.ndarray, video: RadarVideo) -> dict[str, float]:
    """Errors of plots from the variances (n, 2) of their echoes in range and bearing."""
    least = np.array([video.cell_m, video.azimuth_width_rad]) ** 2 / 12.0
    std = np.sqrt(np.maximum(np.median(variance, axis=0) if len(variance) else least, least))
    return {
        "range_std_m": _UNSEEN * float(std[0]),
        "bearing_std_deg": float(np.degrees(_UNSEEN * float(std[1]))),
    }


class _Seen(NamedTuple):
    """End time of a revolution, and its plots."""

    end_s: float
    plots: Plots

    def later(self, by_s: float) -> _Seen:
        """The same at another time."""
        return _Seen(self.end_s + by_s, self.plots._replace(time_s=self.plots.time_s + by_s))


def _finish(parts: Sequence[list[_Seen]], extraction: Extraction) -> None:
    """Add the open echoes to the last revolution."""
    if parts:
        end_s, plots = parts[-1].pop()
        parts[-1].append(_Seen(end_s, joined([plots, extraction.finished()])))


def _episodes(
    parts: Sequence[Sequence[_Seen]], ship: OwnShipMotion, notes: list[str]
) -> list[Episode]:
    """One episode per part, with names and a note if there are several."""
    if len(parts) == 1:
        return [Episode("", _scans(parts[0], ship), ship)]
    notes.append(
        f"the clock is set back {many(len(parts) - 1, 'time')}, first after "
        f"{parts[0][-1].end_s:.1f} s; the following parts are tracked from a fresh start, as "
        "scenario part-2 and so on"
    )
    return [
        Episode(f"part-{number}", _scans(part, ship), ship)
        for number, part in enumerate(parts, start=1)
    ]


def _scans(part: Sequence[_Seen], ship: OwnShipMotion) -> list[Scan]:
    return [
        Scan.of_plots(end_s, k, seen.time_s, seen.range_m, seen.bearing_rad, ship.position_at)
        for k, (end_s, seen) in enumerate(part)
    ]


def days_s(own: OwnRows, middle_s: float) -> float:
    """Days to add to a time of day so that it is nearest to the middle of own ship's track."""
    if len(own.time_s) == 0:
        return 0.0
    return _DAY_S * round(((own.time_s[0] + own.time_s[-1]) / 2.0 - middle_s) / _DAY_S)


def _check_covered(own: OwnRows, parts: Sequence[Sequence[_Seen]], path: Path) -> None:
    """Own ship's position must be known at each plot and at the end of each revolution."""
    turns = [np.append(seen.plots.time_s, seen.end_s) for part in parts for seen in part]
    time_s = np.sort(np.concatenate(turns))
    lost, got = own.lacks(time_s, OWN_GAP_S)
    if lost.any():
        raise own.not_known(path, time_s[np.argmax(lost)], got)
