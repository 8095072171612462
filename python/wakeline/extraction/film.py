"""A file of radar video as a recording of plots."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
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
from wakeline.recording.own_csv import OWN_GAP_S, OwnRows, read_own_track

from .plots import Extraction, Plots, joined
from .turns import judged, turns

_UNSEEN = 2.0  # an echo errs more than its cells say: it wanders over the hull, and is cut in two
_DAY_S = 86400.0


@dataclass(frozen=True, kw_only=True, repr=False)
class VideoRecording(Recording):
    """The plots of radar video: one scan an antenna revolution, an episode until a clock is reset.

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


def read_plots_of_video(
    path: str | Path, own_path: str | Path | None = None, *, period_s: float | None = None
) -> VideoRecording:
    """Read radar video and take its echoes as plots, a turn of the antenna after the other.

    A turn that is only begun, at either end of the recording, is left out: the beam has not been
    everywhere. What comes after a clock that was set back is an episode of its own. Without
    `own_path` the radar stands at the origin. Video has the time of day alone; its day is that on
    which own ship's track lies. Where it has none, `period_s` is the time of a turn.

    Raises
    ------
    RecordingError
        When the file holds no radar video, or own ship is not known at one of its plots, or is
        that of several scenarios.
    """
    path = Path(path)
    report = VideoReport()
    extraction = Extraction()
    parts: list[list[_Seen]] = []
    begun = 0
    blocks = read_video(path, period_s=period_s, report=report)
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
    least = np.array([last.cell_m, last.azimuth_width_rad]) ** 2 / 12.0
    std = np.sqrt(np.maximum(np.median(variance, axis=0) if len(variance) else least, least))
    notes = [f"the sender says: {text}" for text in report.summaries]
    notes += [*report.notes, *extraction.notes()]
    if begun:
        notes.append(f"{begun} turn{'s' * (begun > 1)} only begun left out")
    ship = OwnShipMotion.fixed()
    if own_path is not None:
        rows = read_own_track(own_path, notes)
        days_s = _days_s(rows, parts)
        parts = [[seen.later(days_s) for seen in part] for part in parts]
        _check_covered(rows, parts, path)
        ship = rows.ship()
    radar = {
        "range_std_m": _UNSEEN * float(std[0]),
        "bearing_std_deg": float(np.degrees(_UNSEEN * float(std[1]))),
    }
    return VideoRecording(path.stem, _episodes(parts, ship, notes), notes, radar, last=last)


class _Seen(NamedTuple):
    """When a turn ended, and its plots."""

    end_s: float
    plots: Plots

    def later(self, by_s: float) -> _Seen:
        """The same at another time."""
        return _Seen(self.end_s + by_s, self.plots._replace(time_s=self.plots.time_s + by_s))


def _finish(parts: Sequence[list[_Seen]], extraction: Extraction) -> None:
    """Give the echoes that are open to the last turn."""
    if parts:
        end_s, plots = parts[-1].pop()
        parts[-1].append(_Seen(end_s, joined([plots, extraction.finished()])))


def _episodes(
    parts: Sequence[Sequence[_Seen]], ship: OwnShipMotion, notes: list[str]
) -> list[Episode]:
    """One a part, with names where there are several, which is told."""
    if len(parts) == 1:
        return [Episode("", _scans(parts[0], ship), ship)]
    notes.append(
        f"the clock is set back {many(len(parts) - 1, 'time')}, first after "
        f"{parts[0][-1].end_s:.1f} s: what follows is tracked from a fresh start, as scenario "
        "part-2 and so on"
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


def _days_s(own: OwnRows, parts: Sequence[Sequence[_Seen]]) -> float:
    """Whole days from the time of day to own ship's track, as their middles come nearest."""
    if len(own.time_s) == 0:
        return 0.0
    middle_s = (parts[0][0].end_s + parts[-1][-1].end_s) / 2.0
    return _DAY_S * round(((own.time_s[0] + own.time_s[-1]) / 2.0 - middle_s) / _DAY_S)


def _check_covered(own: OwnRows, parts: Sequence[Sequence[_Seen]], path: Path) -> None:
    """Own ship must be known at each plot and at the end of each turn."""
    turns = [np.append(seen.plots.time_s, seen.end_s) for part in parts for seen in part]
    time_s = np.sort(np.concatenate(turns))
    lost = own.lacks(time_s, OWN_GAP_S)
    if lost is not None:
        k, got = lost
        raise own.not_known(path, time_s[k], got)
