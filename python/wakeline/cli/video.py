"""Radar video through the plot extractor, so that it can be tracked as any recording."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, islice, pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

import wakeline as wl
from wakeline import plot
from wakeline._brief import many
from wakeline._progress import counted
from wakeline.recording import (
    Episode,
    OwnShip,
    RadarVideo,
    Recording,
    RecordingError,
    Scan,
    Tracks,
    VideoReport,
    read_video,
)
from wakeline.recording.own_csv import OWN_GAP_S, OwnRows, read_own
from wakeline.recording.video import Beam

from .config import Settings
from .tracking import TrackedEpisode

_FALSE_ALARMS = 1e-5
_TRAIN_M, _GUARD_M = 400.0, 150.0  # either side of a cell; ships are up to 300 m long
_MOST_TRAIN_CELLS = 128
_ALIKE = 0.25  # parts by which windows may differ before settings are found anew
_WINDOW_SHARE = 8  # of a sweep, so that every cell has others to be compared with
_LOGARITHMIC_BELOW = 0.2  # skewness of noise: 0.63 behind a linear receiver, -1.1 in decibels
_RAYLEIGH_SPREAD_DB = 5.57  # standard deviation of noise in decibels
_WINDOW_CELLS = 32
_ABOVE_NOISE_DB = range(0, 40, 2)
_MOST_PLOTS = 150  # of a turn
_MOST_CELLS = 65536
_NEARLY = 0.7  # of its neighbour, and a turn counts as a whole one
_PAUSE_S = 10.0
_SWEEPS_THAT_TELL = 16  # which way the antenna turns
_UNSEEN = 2.0  # an echo errs more than its cells say: it wanders over the hull, and is cut in two
_STROBE = 0.99  # probability that the target's plot lies in the strobe that is drawn
_WIDE_ECHO_RAD = np.deg2rad(20.0)
_LONG_ECHO_M = 800.0  # a land mass, as consoles have it
_DAY_S = 86400.0


@dataclass(frozen=True)
class VideoRecording:
    """Plots of radar video, and the last turn of it.

    Attributes
    ----------
    recording : Recording
        One scan a turn, one episode as long as the clock goes on.
    last : RadarVideo
    plot_std : (float, float)
        What the echoes say of the errors of plots: range in metres and bearing in radians.
    """

    recording: Recording
    last: RadarVideo
    plot_std: tuple[float, float]

    def told_to(self, settings: Settings) -> Settings | None:
        """The settings with the errors of these plots as those of the radar; None where told."""
        default = Settings.default().radar
        if any(settings.radar[key] != default[key] for key in ("range_std_m", "bearing_std_deg")):
            return None
        range_std_m, bearing_std_rad = self.plot_std
        radar = settings.radar | {
            "range_std_m": range_std_m,
            "bearing_std_deg": float(np.degrees(bearing_std_rad)),
        }
        return replace(settings, radar=radar)


def read_plots_of_video(
    path: Path, own_path: Path | None = None, *, period_s: float | None = None
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
    report = VideoReport()
    extraction = _Extraction()
    parts: list[list[_Seen]] = []
    begun = 0
    blocks = read_video(path, period_s=period_s, report=report)
    for turn in counted(_judged(_turns(blocks)), "turns"):
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
    ship = OwnShip.fixed()
    if own_path is not None:
        rows = _own_rows(own_path, notes)
        days_s = _days_s(rows, parts)
        parts = [[seen.later(days_s) for seen in part] for part in parts]
        _check_covered(rows, parts, path)
        ship = rows.ship()
    recording = Recording(path.stem, _episodes(parts, ship, notes), notes=notes)
    return VideoRecording(recording, last, (_UNSEEN * float(std[0]), _UNSEEN * float(std[1])))


def draw_ppi(
    folder: Path, video: VideoRecording, part: TrackedEpisode, bearing_offset_rad: float
) -> Path:
    """Write ``ppi.png``: the last turn, its plots, strobes around the tracks, and the tracks.

    All as seen from own ship, tracks from where she is at the end of the turn; the offset is taken
    off what the radar reads.
    """
    scan = part.episode.scans[-1]
    tracks = _seen_from(part.episode.own.position_at(scan.time_s)[0], part.tracks)
    last = tracks.time_s == scan.time_s
    strobes = [
        _strobe(video, state[[0, 2]], covariance[np.ix_([0, 2], [0, 2])])
        for state, covariance in zip(tracks.state[last], tracks.covariance[last], strict=True)
    ]
    figure = plot.figure(8.6, 8.6)
    range_m, bearing_rad = scan.range_bearing.T
    plot.ppi(
        replace(video.last, azimuth_rad=video.last.azimuth_rad - bearing_offset_rad),
        figure.add_subplot(),
        plots=range_m[:, None] * np.column_stack([np.cos(bearing_rad), np.sin(bearing_rad)]),
        strobes=strobes,
        tracks=tracks,
    )
    file = folder / "ppi.png"
    plot.save(figure, file)
    return file


def _seen_from(place_m: np.ndarray, tracks: Tracks) -> Tracks:
    """The tracks with positions about a place (2,), north and east."""
    return replace(tracks, state=tracks.state - [place_m[0], 0.0, place_m[1], 0.0])


def _strobe(video: VideoRecording, place_m: np.ndarray, covariance_m2: np.ndarray) -> np.ndarray:
    """Outline of where the next plot of a track lies with the probability of the gate."""
    range_std_m, bearing_std_rad = video.plot_std
    sensor = wl.ConvertedRangeBearing(range_std_m=range_std_m, bearing_std_rad=bearing_std_rad)
    polar = [np.hypot(*place_m), np.arctan2(place_m[1], place_m[0])]
    plot_m2 = wl.one_point(sensor, polar, 1.0).covariance[np.ix_([0, 2], [0, 2])]
    threshold = wl.ChiSquareGate(probability=_STROBE).threshold(2)
    return plot.ellipse_outline(place_m, covariance_m2 + plot_m2, threshold)


# Turns of the antenna -----------------------------------------------------------------------------


@dataclass
class _Turn:
    """Blocks of video from one beginning of a turn to the next."""

    blocks: list[RadarVideo]
    whole: bool = True

    @property
    def begin_s(self) -> float:
        """Time of its first sweep."""
        return float(self.blocks[0].time_s[0])

    @property
    def end_s(self) -> float:
        """Time of its last sweep."""
        return float(self.blocks[-1].time_s[-1])

    @property
    def longest(self) -> RadarVideo:
        """The block of the most sweeps."""
        return max(self.blocks, key=len)

    @property
    def covered_rad(self) -> float:
        """How far the beam has turned."""
        return sum(len(block) * block.azimuth_width_rad for block in self.blocks)


def _turns(blocks: Iterable[RadarVideo]) -> Iterator[_Turn]:
    beam = Beam()
    turn: _Turn | None = None
    for block in blocks:
        begins = [beam.begins_turn(azimuth_rad) for azimuth_rad in block.azimuth_rad.tolist()]
        if turn is not None and (begins[0] or _pauses(turn.blocks[-1], block)):
            yield turn
            turn = None
        turn = turn or _Turn([])
        turn.blocks.append(block)
    if turn is not None:
        yield turn


def _pauses(before: RadarVideo, block: RadarVideo) -> bool:
    return not 0.0 <= block.time_s[0] - before.time_s[-1] <= _PAUSE_S


def _judged(turns: Iterable[_Turn]) -> Iterator[_Turn]:
    """The turns, those at either end marked where they are much less than their neighbours.

    At the beginning there may be two: a sector across north is cut there until its end is known.
    """
    turns = iter(turns)
    first = list(islice(turns, 3))
    most_rad = max((turn.covered_rad for turn in first), default=0.0)
    for turn in first[:-1]:
        turn.whole = turn.covered_rad > _NEARLY * most_rad
    for before, turn in pairwise(chain(first, turns)):
        yield before
        neighbour, last = before, turn
    if len(first) > 1:
        last.whole = last.covered_rad > _NEARLY * neighbour.covered_rad or not neighbour.whole
        yield last
    else:
        yield from first


# Plots --------------------------------------------------------------------------------------------


class _Plots(NamedTuple):
    """Columns of plots; variances (n, 2) of range and bearing."""

    time_s: np.ndarray
    range_m: np.ndarray
    bearing_rad: np.ndarray
    variance: np.ndarray


def _joined(parts: Sequence[_Plots]) -> _Plots:
    return _Plots(*map(np.concatenate, zip(*parts, strict=True)))


class _Seen(NamedTuple):
    """When a turn ended, and its plots."""

    end_s: float
    plots: _Plots

    def later(self, by_s: float) -> _Seen:
        """The same at another time."""
        return _Seen(self.end_s + by_s, self.plots._replace(time_s=self.plots.time_s + by_s))


def _finish(parts: Sequence[list[_Seen]], extraction: _Extraction) -> None:
    """Give the echoes that are open to the last turn."""
    if parts:
        end_s, plots = parts[-1].pop()
        parts[-1].append(_Seen(end_s, _joined([plots, extraction.finished()])))


def _episodes(parts: Sequence[Sequence[_Seen]], ship: OwnShip, notes: list[str]) -> list[Episode]:
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


def _scans(part: Sequence[_Seen], ship: OwnShip) -> list[Scan]:
    return [
        Scan.of_plots(end_s, k, seen.time_s, seen.range_m, seen.bearing_rad, ship.position_at)
        for k, (end_s, seen) in enumerate(part)
    ]


class _Kind(NamedTuple):
    """What the settings of an extractor depend on, beside the noise: bits and windows in cells."""

    dtype: np.dtype
    train_cells: int
    guard_cells: int

    @classmethod
    def of(cls, video: RadarVideo) -> _Kind:
        most = max(video.amplitude.shape[1] // _WINDOW_SHARE, 1)
        train = int(np.clip(_TRAIN_M / video.cell_m, 8, _MOST_TRAIN_CELLS))
        return cls(video.amplitude.dtype, min(train, most), min(int(_GUARD_M / video.cell_m), most))

    def fits(self, other: _Kind) -> bool:
        """Whether windows of one do for the other."""
        windows = zip(self[1:], other[1:], strict=True)
        return self.dtype == other.dtype and all(
            abs(mine - its) <= _ALIKE * max(mine, its) for mine, its in windows
        )


class _Extraction:
    """Plots of turn after turn, with settings found where a kind of video is met first."""

    def __init__(self) -> None:
        self._extractor: wl.PlotExtractor | None = None
        self._kind: _Kind | None = None
        self._settings: dict[_Kind, dict[str, float]] = {}
        self._above_db = 0
        self._mirrored = False
        self._refused = 0

    def plots_of(self, turn: _Turn) -> _Plots:
        """Plots of the echoes that end in a turn."""
        plots = []
        for block in turn.blocks:
            kind = _Kind.of(block)
            if self._kind is None or not kind.fits(self._kind) or self._turns_back(block):
                plots.append(self.finished())
                self._begin(turn, kind, block)
            plots.append(self._as_seen(self._extractor.process(self._clockwise(block))))
        return _joined(plots)

    def finished(self) -> _Plots:
        """Plots of the echoes that are open; after it the next turn stands alone."""
        if self._extractor is None:
            return _Plots(np.zeros(0), np.zeros(0), np.zeros(0), np.zeros((0, 2)))
        plots = self._as_seen(self._extractor.finish())
        counts = self._extractor.counts
        self._refused += counts.too_long + counts.repeated + counts.invalid
        self._extractor = self._kind = None
        return plots

    def notes(self) -> list[str]:
        """What a user should know."""
        notes = []
        if self._above_db:
            notes.append(
                f"so much clutter that echoes count from {self._above_db} dB above noise on"
            )
        if self._mirrored:
            notes.append("the antenna turns anticlockwise")
        if self._refused:
            notes.append(f"{self._refused} sweeps that make no sense left out")
        return notes

    def _begin(self, turn: _Turn, kind: _Kind, block: RadarVideo) -> None:
        self._mirrored = (_sense(block) or _sense(turn.longest)) < 0.0
        if kind not in self._settings:
            alike = [other for other in turn.blocks if _Kind.of(other).fits(kind)]
            settings, above_db = _settings_for(self._clockwise(max(alike, key=len)), kind)
            self._settings[kind] = settings
            self._above_db = max(self._above_db, above_db)
        self._extractor = wl.PlotExtractor(**self._settings[kind])
        self._kind = kind

    def _turns_back(self, block: RadarVideo) -> bool:
        """Whether the antenna turns the other way from this block on."""
        return _sense(block) * (-1.0 if self._mirrored else 1.0) < 0.0

    def _clockwise(self, video: RadarVideo) -> RadarVideo:
        """The video as it is, or in a mirror where the antenna turns the other way."""
        return replace(video, azimuth_rad=-video.azimuth_rad) if self._mirrored else video

    def _as_seen(self, plots: wl.video.VideoPlots) -> _Plots:
        bearing_rad = -plots.bearing_rad if self._mirrored else plots.bearing_rad
        variance = np.diagonal(plots.covariance, axis1=1, axis2=2)
        return _Plots(plots.time_s, plots.range_m, np.mod(bearing_rad, 2 * np.pi), variance)


def _sense(video: RadarVideo) -> float:
    """1 where the antenna turns clockwise, -1 anticlockwise, 0 where too few sweeps tell."""
    if len(video) < _SWEEPS_THAT_TELL:
        return 0.0
    return float(np.sign(np.sum(wl.wrap_angle(np.diff(video.azimuth_rad)))))


def _settings_for(turn: RadarVideo, kind: _Kind) -> tuple[dict[str, float], int]:
    """Settings for this picture, and how far its threshold lies above that of noise, in dB.

    It is raised until the turn gives no more plots than an operator would bear: land and sea
    clutter fluctuate more than noise.
    """
    noise = noise_of(turn.amplitude)
    most = _MOST_PLOTS * min(len(turn) * turn.azimuth_width_rad / (2 * np.pi), 1.0)
    for above_db in _ABOVE_NOISE_DB:
        settings = _settings(kind, noise, above_db)
        trial = wl.PlotExtractor(**settings)
        if len(trial.process(turn)) + len(trial.finish()) <= most:
            break
    return settings, above_db


def _settings(kind: _Kind, noise: Noise | None, above_db: float) -> dict[str, float]:
    """Settings for windows of this length and a receiver of this kind."""
    if noise is not None and noise.skewness < _LOGARITHMIC_BELOW:
        steps_per_db = noise.std / _RAYLEIGH_SPREAD_DB
        offset_db = wl.video.threshold_offset_db(_FALSE_ALARMS) + above_db
        threshold = {"threshold_factor": 1.0, "threshold_offset": int(steps_per_db * offset_db) + 1}
    else:
        factor = wl.video.threshold_factor(_FALSE_ALARMS, train_cells=kind.train_cells)
        threshold = {"threshold_factor": min(factor * 10 ** (above_db / 20), 1000.0)}
    return {
        "max_sweep_cells": _MOST_CELLS,
        "gap_sweeps": 1,  # azimuth is often counted as coarsely as sweeps come
        "train_cells": kind.train_cells,
        "guard_cells": kind.guard_cells,
        "max_range_extent_m": _LONG_ECHO_M,
        "max_bearing_extent_rad": _WIDE_ECHO_RAD,
        **threshold,
    }


class Noise(NamedTuple):
    """Standard deviation in amplitudes, and skewness, of the noise of a picture."""

    std: float
    skewness: float


def noise_of(amplitude: np.ndarray) -> Noise | None:
    """The noise of a picture (N, C); None where there is none to see.

    Of pieces of sweeps of 32 cells a fifth is taken for noise: those of the least mean that are not
    dark.
    """
    whole = amplitude.shape[1] // _WINDOW_CELLS * _WINDOW_CELLS
    pieces = amplitude[:, :whole].reshape(-1, _WINDOW_CELLS).astype(np.float32)
    mean = pieces.mean(axis=1) if len(pieces) else np.zeros(0)
    lit = np.flatnonzero(mean > 1.0)
    if len(lit) == 0:
        return None
    low, high = np.quantile(mean[lit], [0.05, 0.25])
    quiet = lit[(mean[lit] >= low) & (mean[lit] <= high)]
    away = pieces[quiet] - mean[quiet, None]
    std = float(np.sqrt(np.mean(away**2)))
    return Noise(std, float(np.mean(away**3)) / std**3) if std > 0 else None


# Own ship -----------------------------------------------------------------------------------------


def _own_rows(path: Path, notes: list[str]) -> OwnRows:
    """Rows with a position, in order of time."""
    rows = read_own(path, notes)
    if not rows.has_position:
        raise RecordingError(
            path,
            "there is no own-ship position",
            line=1,
            wanted="columns north_m and east_m",
            got="scans alone",
        )
    scenarios = [] if rows.scenario is None else sorted(set(rows.scenario.tolist()))
    if len(scenarios) > 1:
        raise RecordingError(
            path,
            "own ship's track is not one",
            column="scenario",
            wanted="one scenario, as video has no names of them",
            got=f"{len(scenarios)}, such as {scenarios[0]!r} and {scenarios[1]!r}",
        )
    return rows.by_time()


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
