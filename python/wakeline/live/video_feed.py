"""Radar video as it arrives: messages of ASTERIX category 240 to sweeps, plots and sectors."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

import wakeline as wl
from wakeline._engine.video import Cat240Decoder, Cat240Sweeps
from wakeline.extraction.settings import Kind, seen_cells, settings_for
from wakeline.recording import RadarVideo
from wakeline.wire import SensorClock

from .problems import Problems
from .radar_feed import PlotRow, Sector

_TAU = 2.0 * math.pi
_BATCH = 32  # messages decoded together
_WAIT_S = 0.01  # unless the first of them is older
_LATE = 64  # messages; a count that goes back further has restarted
_SEQUENCES = 1 << 32
_STEPS = 64  # from sweep to sweep, that the sense of rotation is found from
_BEHIND_RAD = 0.1  # of the beam, at most: where echoes that have not ended begin
_SECTOR_RAD = _TAU / 128
_BACK_RAD = 2.0 * _BEHIND_RAD  # of a turn, at most: the end of a sector has gone back
_TRIAL_RAD = _TAU  # of video that settings are estimated from
_MOST_TRIAL = 256 << 20  # octets
_LEAST_STEP_S = 1e-4  # between the ends of sectors
_JITTER_S = 1.0  # so much before the last end: the rate is of few sweeps
_SILENT_S = 5.0  # a sweep after a longer silence begins anew

Show = Callable[[np.ndarray, float, np.ndarray], None]
"""Called with azimuth_rad (n,), range_m of the end of the last cell, and cells (n, C) of uint8."""


class Sweeps(NamedTuple):
    """Sweeps of one geometry."""

    azimuth_rad: np.ndarray
    time_s: np.ndarray
    width_rad: float
    start_range_m: float
    cell_m: float
    amplitude: np.ndarray

    def video(self) -> RadarVideo:
        """As radar video."""
        return RadarVideo(
            self.amplitude,
            self.azimuth_rad,
            self.time_s,
            self.width_rad,
            self.start_range_m,
            self.cell_m,
        )

    @property
    def geometry(self) -> tuple:
        """What sweeps in one array have in common."""
        return self.start_range_m, self.cell_m, self.amplitude.shape[1], self.amplitude.dtype


class VideoFeed:
    """Plots of the echoes in the video of one radar, and the sectors that the beam has passed.

    Messages are decoded 32 at a time, or after 10 ms. Settings of detection are estimated from the
    first revolution, which gives no plots. A sector ends where the first echo that the beam
    has not left begins, which is a plot only later, and at most 0.1 rad behind the beam.

    Parameters
    ----------
    min_range_m : float
        As for :class:`wakeline.extraction.plots.Extraction`.
    show : callable, optional

    Attributes
    ----------
    sweeps, lost, late, duplicates : int
        Sweeps taken; missing by the sender's count, after 64 messages; that came late, and are not
        used; that came twice.
    clock : SensorClock
    """

    def __init__(self, min_range_m: float = 0.0, show: Show | None = None) -> None:
        self._min_range_m = min_range_m
        self.sweeps = self.lost = self.late = self.duplicates = 0
        self.clock = SensorClock()
        self.show = show
        self.range_m = 0.0
        self._decoder = Cat240Decoder()
        self._waiting: list[bytes] = []
        self._times: list[float] = []
        self._sequence = -1
        self._missing: deque[int] = deque()  # of the last 64
        self._source: int | None = None
        self._extractor: wl.PlotExtractor | None = None
        self._kind: Kind | None = None
        self._geometry: tuple | None = None
        self._trial: list[RadarVideo] = []
        self._trial_rad = 0.0
        self._azimuth_rad = self._kept_rad = math.nan
        self._clockwise = 0  # steps of the last sweeps, less those anticlockwise
        self._edge_rad = math.nan
        self._edge_s = self._time_s = -math.inf

    def feed(self, time_s: float, octets: bytes, problems: Problems) -> Iterator[PlotRow | Sector]:
        """Take a message; plots and sectors that end with it."""
        self._waiting.append(octets)
        self._times.append(time_s)
        if len(self._waiting) >= _BATCH or time_s - self._times[0] >= _WAIT_S:
            yield from self._flush(problems)

    def pass_to(self, time_s: float, problems: Problems) -> Iterator[PlotRow | Sector]:
        """Decode what waits for longer than 10 ms."""
        if self._times and time_s - self._times[0] >= _WAIT_S:
            yield from self._flush(problems)

    def _flush(self, problems: Problems) -> Iterator[PlotRow | Sector]:
        data, times = b"".join(self._waiting), self._times
        self._waiting, self._times = [], []
        skipped = self._decoder.skipped_octets
        found = self._decoder.decode(data, True)
        for _, problem, wanted, got in found.problems:
            problems.add(problem, f"wanted {wanted}, got {got}")
        if found.problem_count > len(found.problems):
            problems.add("video", "more problems", found.problem_count - len(found.problems))
        if self._decoder.skipped_octets > skipped:
            problems.add("octets skipped", "octets that are no ASTERIX 240")
        if len(found.offset) == 0:
            return
        received_s = np.array(times)
        if len(received_s) != len(found.offset):
            received_s = np.full(len(found.offset), times[-1])
        for sweeps in self._of_one_geometry(found, received_s, problems):
            yield from self.take(sweeps, problems)

    # ------------------------------------------------------------------ sweeps

    def _of_one_geometry(
        self, found: Cat240Sweeps, received_s: np.ndarray, problems: Problems
    ) -> Iterator[Sweeps]:
        kept = self._kept(found, problems)
        if len(kept) == 0:
            return
        times_s = self._times_of(found.time_s, received_s)
        columns = np.column_stack([found.start_range_m, found.cell_m, found.cells, found.bits])
        changes = np.flatnonzero(np.any(np.diff(columns[kept], axis=0) != 0, axis=1)) + 1
        for rows in np.split(kept, changes):
            amplitude = _cells(found, rows)
            if amplitude is None:
                problems.add("compressed video", "compressed video cannot be used live")
                continue
            azimuth_rad = found.azimuth_rad[rows]
            yield Sweeps(
                azimuth_rad,
                np.maximum.accumulate(times_s[rows]),
                float(np.median(found.azimuth_width_rad[rows])) or _TAU / 4096,
                float(found.start_range_m[rows[0]]),
                float(found.cell_m[rows[0]]),
                amplitude,
            )

    def _kept(self, found: Cat240Sweeps, problems: Problems) -> np.ndarray:
        """Rows that continue the sender's count, of the first radar that was seen."""
        if self._source is None:
            self._source = int(found.source[0])
        kept = []
        columns = (found.source, found.sequence, found.azimuth_rad)
        rows = zip(*(one.tolist() for one in columns), strict=True)
        for row, (source, sequence, azimuth_rad) in enumerate(rows):
            if source != self._source:
                problems.add("other radar", f"source {divmod(source, 256)} at this input")
            elif self._continues(sequence, azimuth_rad, problems):
                self._sequence, self._kept_rad = sequence, azimuth_rad
                kept.append(row)
        self.sweeps += len(kept)
        return np.array(kept, dtype=np.int64)

    def _continues(self, sequence: int, azimuth_rad: float, problems: Problems) -> bool:
        """Whether a sweep is neither late nor there already, by the sender's count."""
        if sequence < 0 or self._sequence < 0:
            return True
        half = _SEQUENCES // 2
        step = (sequence - self._sequence + half) % _SEQUENCES - half
        if step == 0 and azimuth_rad != self._kept_rad:
            if "message count" not in problems.count:
                problems.add("message count", f"the sender's count stays {sequence}")
            return True
        if -_LATE < step <= 0:
            if sequence in self._missing:
                self._missing.remove(sequence)
                self.late += 1
            else:
                self.duplicates += 1
            return False
        self._miss(step, sequence)
        return True

    def _miss(self, step: int, sequence: int) -> None:
        """Note the numbers that a step of the count leaves out; what is too old is lost."""
        recent = range(max(step - _LATE, 1), step)
        self._missing.extend((self._sequence + k) % _SEQUENCES for k in recent)
        self.lost += max(step - 1 - len(recent), 0)
        while self._missing and (sequence - self._missing[0]) % _SEQUENCES >= _LATE:
            self._missing.popleft()
            self.lost += 1

    def _times_of(self, time_of_day_s: np.ndarray, received_s: np.ndarray) -> np.ndarray:
        if not math.isfinite(time_of_day_s[0]):
            return received_s
        first_s = self.clock(float(time_of_day_s[0]), float(received_s[0]))
        steps = np.nan_to_num(time_of_day_s - time_of_day_s[0])
        return first_s + (steps + 43200.0) % 86400.0 - 43200.0

    # ------------------------------------------------------------------ plots

    def take(self, sweeps: Sweeps, problems: Problems) -> Iterator[PlotRow | Sector]:
        """Take sweeps of one geometry in order; plots and sectors that end with them."""
        if self.show is not None:
            cells = sweeps.amplitude
            if cells.dtype != np.uint8:
                cells = (cells >> 8).astype(np.uint8)
            self.show(
                sweeps.azimuth_rad,
                sweeps.start_range_m + sweeps.cell_m * cells.shape[1],
                cells,
            )
        self._follow(sweeps.azimuth_rad)
        silent = sweeps.time_s[0] - self._time_s > _SILENT_S
        self._time_s = float(sweeps.time_s[-1])
        self.range_m = sweeps.start_range_m + sweeps.cell_m * sweeps.amplitude.shape[1]
        video = seen_cells(sweeps.video(), self._min_range_m)
        if sweeps.geometry != self._geometry or silent:
            yield from self._begin(sweeps.geometry, video)
        if self._extractor is None and not self._learn(video):
            return
        plots = self._extractor.process(video)
        if self._clockwise < 0:
            problems.add("anticlockwise", "an antenna that turns anticlockwise cannot be used live")
            return
        yield from _rows(plots)
        yield from self._sectors(sweeps)

    def _follow(self, azimuth_rad: np.ndarray) -> None:
        """Follow the sense of rotation, over some sweeps."""
        steps_rad = np.diff(azimuth_rad, prepend=self._azimuth_rad)
        turns_on = np.sign(np.sin(steps_rad[np.isfinite(steps_rad)])).sum()
        self._clockwise = int(np.clip(self._clockwise + turns_on, -_STEPS, _STEPS))
        self._azimuth_rad = float(azimuth_rad[-1])

    def _begin(self, geometry: tuple, video: RadarVideo) -> Iterator[PlotRow]:
        """Begin anew, with the settings of before where cells are alike."""
        if self._extractor is not None:
            yield from _rows(self._extractor.finish())
        self._geometry, self._edge_rad = geometry, math.nan
        kind = Kind.of(video)
        if self._kind is None or not kind.fits(self._kind):
            self._extractor, self._kind = None, kind
            self._trial, self._trial_rad = [], 0.0

    def _learn(self, video: RadarVideo) -> bool:
        """Estimate the settings of detection when a revolution is there."""
        self._trial.append(video)
        self._trial_rad += video.azimuth_width_rad * len(video)
        octets = sum(one.amplitude.nbytes for one in self._trial)
        if self._trial_rad < _TRIAL_RAD and octets < _MOST_TRIAL:
            return False
        whole = replace(
            self._trial[0],
            amplitude=np.concatenate([one.amplitude for one in self._trial]),
            azimuth_rad=np.concatenate([one.azimuth_rad for one in self._trial]),
            time_s=np.concatenate([one.time_s for one in self._trial]),
        )
        settings, _ = settings_for(whole, self._kind)
        self._extractor = wl.PlotExtractor(**settings)
        self._trial = []
        return True

    def _sectors(self, sweeps: Sweeps) -> Iterator[Sector]:
        """The sector that ends behind the beam, if it is wide enough."""
        last_rad = float(sweeps.azimuth_rad[-1])
        first_rad = float(sweeps.azimuth_rad[0])
        if math.isnan(self._edge_rad):
            self._edge_rad = (first_rad - 0.5 * sweeps.width_rad) % _TAU
        behind_rad = min(self._extractor.open_extent_rad, _BEHIND_RAD)
        passed_rad = (last_rad + 0.5 * sweeps.width_rad - behind_rad - self._edge_rad) % _TAU
        if not _SECTOR_RAD <= passed_rad < _TAU - _BACK_RAD:
            return
        rate = _rate_rad_s(sweeps)
        time_s = float(sweeps.time_s[-1])
        if rate > 0.0:
            time_s -= behind_rad / rate
        if 0.0 <= self._edge_s - time_s < _JITTER_S:
            time_s = self._edge_s + _LEAST_STEP_S
        self._edge_s = time_s
        from_rad = self._edge_rad
        self._edge_rad = (from_rad + passed_rad) % _TAU
        yield Sector(from_rad, from_rad + passed_rad, time_s, [])


def _rate_rad_s(sweeps: Sweeps) -> float:
    span_s = float(sweeps.time_s[-1] - sweeps.time_s[0])
    turned_rad = float(sweeps.azimuth_rad[-1] - sweeps.azimuth_rad[0]) % _TAU
    return turned_rad / span_s if span_s > 0.0 and turned_rad < math.pi else 0.0


def _rows(plots: wl.video.VideoPlots) -> Iterator[PlotRow]:
    variances = np.diagonal(plots.covariance, axis1=1, axis2=2)
    columns = (plots.time_s, plots.range_m, plots.bearing_rad % _TAU, *variances.T)
    yield from map(PlotRow._make, zip(*(one.tolist() for one in columns), strict=True))


def _cells(found: Cat240Sweeps, rows: np.ndarray) -> np.ndarray | None:
    """The cells (n, C) of rows of one geometry; None if they are compressed."""
    if found.compressed[rows].any():
        return None
    cells = int(found.cells[rows[0]])
    memory = found.words if found.bits[rows[0]] > 8 else found.octets
    first = found.first[rows]
    if np.all(np.diff(first) == cells):
        return memory[first[0] : first[0] + cells * len(rows)].reshape(len(rows), cells)
    return memory[first[:, None] + np.arange(cells)]
