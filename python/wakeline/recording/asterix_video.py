"""Recorded radar video: files of ASTERIX category 240, read by revolution and written."""

from __future__ import annotations

import collections
import itertools
import math
import zlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wakeline._brief import counted, many
from wakeline._checks import finite, positive
from wakeline._engine.video import Cat240Decoder, Cat240Encoder, Cat240Sweeps

from .containers import Contents, instead_of_text, octets_of, video_of
from .errors import RecordingError
from .files import replacing
from .video import Beam, RadarVideo

_PIECE = 1 << 22  # octets read at once
_HEAD = 1 << 19  # octets that identify the format of a file
_MOST = 1 << 27  # octets of amplitudes in a block
_MOST_WITHOUT = 1 << 26  # octets without a block at the begin of a file
_TURN = 2 * math.pi
_STEP = _TURN / 65536  # of azimuth in the format
_LATE = 64  # messages; a count that goes back further has restarted
_SEQUENCES = 1 << 32
_HELD_S = 1.0
_PAUSE_S = 60.0
_ASTRAY_RAD = 0.2
_BELOW = {"azimuth_rad": 1e6, "time_s": 1e15, "start_range_m": 1e9, "cell_m": 1e6}  # to be written
_NEAR = 64  # sweeps
_MOST_RETURNS = 1  # to a range scale in as many sweeps, if scales are not sent in turn
_MOST_PARTS = 64  # of a sweep
_ABUT = 1.5  # sweeps farther apart, or nearer, by this factor do not have the given width


_ASTRAY = "neighbours in azimuth, time or count"


@dataclass
class VideoReport:
    """What a reader found besides the sweeps; filled while it reads.

    Attributes
    ----------
    sweeps : int
        Number of sweeps read.
    contents : Contents
        The container of the video, such as a network capture.
    source : (int, int) or None
        Area and system code (SAC, SIC) of the radar that was read.
    summaries : list of str
        The sender's descriptions of its video, each text once.
    problems : int
        Blocks and records that cannot be read.
    first_problem : RecordingError or None
        The first of them.
    skipped_octets : int
        Octets skipped because of damage.
    other_blocks : int
        Blocks of other categories.
    other_source : int
        Sweeps of other radars.
    missing : int
        Sweeps missing according to the sender's count.
    repeated, late : int
        Dropped sweeps: a repetition, or one that arrived after a later one.
    untimed : int
        Dropped sweeps without a time of day.
    standing : int
        Sweeps at a time of day that stands for a revolution, which is not used.
    incomplete : int
        Sweeps without one of their parts, whose cells are zero.
    other_scales : Counter
        Dropped sweeps of other range scales, sent in turn, by range in metres.
    scale_m : float
        Range of the scale that was read instead.
    held : int
        Sweeps whose time goes back by less than a second; they get the previous time.
    time_jumps : int
        Times that go back further, or forward by more than a minute.
    reversals : int
        Changes of the antenna's direction of rotation.
    astray : int
        Dropped sweeps whose azimuth or time is far from those of both neighbors, which agree,
        or whose count runs ahead of theirs.
    """

    sweeps: int = 0
    contents: Contents = field(default_factory=Contents)
    source: tuple[int, int] | None = None
    summaries: list[str] = field(default_factory=list)
    problems: int = 0
    first_problem: RecordingError | None = None
    skipped_octets: int = 0
    other_blocks: int = 0
    other_source: int = 0
    missing: int = 0
    repeated: int = 0
    late: int = 0
    untimed: int = 0
    standing: int = 0
    incomplete: int = 0
    other_scales: collections.Counter[float] = field(default_factory=collections.Counter)
    scale_m: float = 0.0
    held: int = 0
    time_jumps: int = 0
    reversals: int = 0
    astray: int = 0

    @property
    def notes(self) -> list[str]:
        """Notes for the user, one sentence each."""
        words = [
            (self.problems, "[record|records] cannot be read"),
            (self.skipped_octets, "[octet|octets] skipped because of damage"),
            (self.other_source, "[sweep|sweeps] of other radars left out"),
            (self.missing, "[sweep|sweeps] missing"),
            (self.repeated, "[sweep that repeats|sweeps that repeat] the one before left out"),
            (self.late, "[sweep that comes|sweeps that come] late left out"),
            (self.untimed, "[sweep|sweeps] without a time of day left out"),
            (self.standing, "[sweep has|sweeps have] a time of day that stands, which is not used"),
            (self.incomplete, "[sweep lacks one of its|sweeps lack one of their] parts"),
            (self.held, "[sweep|sweeps] whose time goes back, set to the previous time"),
            (self.time_jumps, "[jump|jumps] of time"),
            (self.reversals, "[reversal|reversals] of the antenna"),
            (self.astray, f"[sweep far from its|sweeps far from their] {_ASTRAY} left out"),
        ]
        notes = [counted(count, what) for count, what in words if count]
        if self.problems:
            notes[0] += f" (first: {self.first_problem})"
        if self.other_scales:
            others = " m, ".join(f"{range_m:.0f}" for range_m in sorted(self.other_scales))
            notes.append(
                f"range scales are sent in turn: that of {self.scale_m:.0f} m is used, and "
                f"{many(self.other_scales.total(), 'sweep')} of {others} m left out; choose with "
                "range_scale_m (--range-scale)"
            )
        return self.contents.notes + notes


def is_video(path: str | Path) -> bool:
    """Whether a file begins as ASTERIX radar video or has some in its first 512 KiB.

    The file may be compressed, a network capture, or in the final format of ASTERIX.

    Raises
    ------
    OSError
        When there is no such file.
    RecordingError
        When the file cannot be read.
    """
    Path(path).stat()
    head, last = next(_pieces(video_of(path, Contents()), _HEAD))
    begins = len(head) > 3 and head[0] == 240 and head[1:3] > b"\x00\x04" and head[3] >= 0xC0
    found = Cat240Decoder().decode(head[:_HEAD], last=last and len(head) <= _HEAD)
    return bool(begins or len(found.offset) or found.summaries)


def read_video(
    path: str | Path,
    *,
    strict: bool = False,
    source: tuple[int, int] | None = None,
    midnight_s: float = 0.0,
    period_s: float | None = None,
    range_scale_m: float | None = None,
    report: VideoReport | None = None,
) -> Iterator[RadarVideo]:
    """Read recorded radar video in blocks of at most one revolution, in bounded memory.

    The file is a sequence of ASTERIX category 240 data blocks, may be compressed (gzip, bzip2, xz),
    in ASTERIX final format, or a network capture (pcap, pcapng); ``cpp/docs/video_files.md``
    describes what is read and how damage is handled. Consecutive messages of one azimuth with
    different cells are one sweep. A new block begins where the antenna passes
    north or, for a sector scan, where the beam goes back; where start range, length or number of
    cells or the bits of a cell change, where the width of sweeps changes by more than half, and
    where time jumps. A revolution of more than 128 MiB is split. The azimuth is the true bearing.

    Cells of 8 bits and fewer come as ``uint8`` (fewer are scaled to full scale 255), of 16 bits as
    ``uint16``. The width of a sweep is the mean of its block; without a width, or with another
    distance between sweeps, it is the median step from sweep to sweep.

    Parameters
    ----------
    path : str or Path
        The file.
    strict : bool
        Raise at the first block or record that cannot be read; otherwise count and skip it.
    source : (int, int), optional
        Area and system code (SAC, SIC) of the radar to read; default the first in the file.
    midnight_s : float
        UTC seconds of the midnight before the first sweep, because records contain only the time of
        day. Later midnights are counted.
    period_s : float, optional
        Duration of a revolution, for sweeps without a time of day, or with one that stands for a
        revolution; without an earlier time the first sweep has time 0.
    range_scale_m : float, optional
        Where sweeps of several range scales are sent in turn, those with the range nearest to this
        are read; default those of the longest range.
    report : VideoReport, optional
        Filled while reading.

    Yields
    ------
    RadarVideo

    Raises
    ------
    RecordingError
        When the file cannot be opened or contains no readable sweep; with `strict`, at the first
        fault. The message names file, octet, what was expected and what came.
    ValueError
        When `period_s` or `range_scale_m` is not positive, `midnight_s` is not finite or `source`
        is not two octets.
    """
    finite(midnight_s=midnight_s)
    for name, value in (("period_s", period_s), ("range_scale_m", range_scale_m)):
        if value is not None:
            positive(**{name: value})
    if source is not None:
        _check_source(source)
    report = VideoReport() if report is None else report
    report.source = None if source is None else tuple(source)
    order = _Order(report, midnight_s, period_s, range_scale_m)
    return _blocks(Path(path), order, strict)


def write_video(
    path: str | Path,
    videos: RadarVideo | Iterable[RadarVideo],
    *,
    source: tuple[int, int] = (0, 0),
    summary: str = "",
) -> None:
    """Write radar video as ASTERIX category 240; `path` is replaced only on success.

    Amplitudes are read back exactly, azimuths within half of 360/65536 degrees, times of day within
    1/256 s (the date is lost), cells within 75 nm (75 mm where longer than 643 m), the start range
    within half a cell.

    Parameters
    ----------
    path : str or Path
        The file to write. Its folder must exist.
    videos : RadarVideo or iterable of RadarVideo
        In order of time; written one at a time.
    source : (int, int)
        Area and system code (SAC, SIC) of the radar.
    summary : str
        A description of the video, at most 255 ASCII characters; empty: not written.

    Raises
    ------
    ValueError
        When a sweep has more than 65024 cells of 8 or 32512 of 16 bits, a time or azimuth that is
        not finite, or a length that the format cannot represent.
    """
    if not summary.isascii():
        raise ValueError(f"summary must be ASCII, got {summary!r}")
    _check_source(source)
    encoder = Cat240Encoder(*source)
    with replacing(path) as fresh, fresh.open("wb") as file:
        if summary:
            file.write(encoder.encode_summary(summary))
        for video in [videos] if isinstance(videos, RadarVideo) else videos:
            _check_writable(video)
            for first in range(0, len(video), 256):
                part = video[first : first + 256]
                file.write(
                    encoder.encode(
                        part.amplitude,
                        part.azimuth_rad,
                        part.time_s,
                        azimuth_width_rad=part.azimuth_width_rad,
                        start_range_m=part.start_range_m,
                        cell_m=part.cell_m,
                    )
                )


def _check_source(source: tuple[int, int]) -> None:
    codes = range(256)
    if len(source) != 2 or not all(code in codes for code in source):
        raise ValueError(f"source must be two numbers from 0 to 255, got {source!r}")


def _check_writable(video: RadarVideo) -> None:
    """Reject impossible values by name; the encoder checks the limits of the format."""
    for name, most in _BELOW.items():
        values = np.atleast_1d(getattr(video, name))
        wrong = np.flatnonzero(~(np.abs(values) < most))
        if len(wrong):
            raise ValueError(
                f"sweep {wrong[0]} cannot be written: {name} must be finite and below {most:g}, "
                f"got {values[wrong[0]]}"
            )


def _blocks(path: Path, order: _Order, strict: bool) -> Iterator[RadarVideo]:
    report = order.report
    block = _Block()
    decoded = _decoded(path, report, strict)
    sweeps = (row for piece in decoded for row in _rows(path, piece, report, strict))
    for sweep, begins in order.kept(sweeps):
        if begins or block.ends_before(sweep):
            yield from block.videos()
            block = _Block()
        block.add(sweep)
    yield from block.videos()
    if report.sweeps == 0:
        raise _nothing(path, order)


def _nothing(path: Path, order: _Order) -> RecordingError:
    report = order.report
    if report.untimed:
        wanted, got = "I240/140, or period_s given", f"{many(report.untimed, 'sweep')} without"
        if report.standing:
            got = f"a time of day that stands in {many(report.standing, 'sweep')}"
        return RecordingError(path, "no sweep has a time of day", wanted=wanted, got=got)
    if order.other is not None:
        got = f"{report.other_source} of others, first of {order.other}"
        wanted = f"sweeps of source {report.source}"
        return RecordingError(path, "no video of this radar", wanted=wanted, got=got)
    got = "nothing" if report.first_problem is None else f"this: {report.first_problem}"
    if report.contents.form and not report.contents.used:
        got = str(report.contents)
        if report.first_problem is not None:
            got += f", not readable: {report.first_problem}"
    elif path.is_file():  # a pipe is not read again
        got = instead_of_text(octets_of(path)[:_HEAD]) or got
    return RecordingError(path, "no radar video", wanted="sweeps of ASTERIX category 240", got=got)


def _decoded(path: Path, report: VideoReport, strict: bool) -> Iterator[Cat240Sweeps]:
    """The sweeps of the file, piece by piece."""
    decoder = Cat240Decoder()
    rest, found = b"", False
    for piece, last in _pieces(video_of(path, report.contents), _PIECE):
        data = rest + piece
        sweeps = decoder.decode(data, last)
        rest = data[sweeps.consumed :]
        _take_note(path, sweeps, report, strict)
        report.skipped_octets = decoder.skipped_octets
        report.other_blocks = decoder.other_blocks
        yield sweeps
        found = found or bool(len(sweeps.offset) or decoder.other_blocks)
        if not found and decoder.skipped_octets > _MOST_WITHOUT:
            return


def _pieces(octets: Iterable[bytes], least: int) -> Iterator[tuple[bytes, bool]]:
    """The octets in pieces of a length or more, each with whether it is the last."""
    held, waiting, size = b"", [], 0
    for part in octets:
        waiting.append(part)
        size += len(part)
        if size >= least:
            if held:
                yield held, False
            held, waiting, size = b"".join(waiting), [], 0
    if held and size:
        yield held, False
        held = b""
    yield held or b"".join(waiting), True


def _take_note(path: Path, sweeps: Cat240Sweeps, report: VideoReport, strict: bool) -> None:
    for text in (octets.decode("ascii", "replace") for octets in sweeps.summaries):
        if text not in report.summaries and len(report.summaries) < 100:
            report.summaries.append(text)
    if sweeps.problems:
        offset, problem, wanted, got = sweeps.problems[0]
        error = RecordingError(path, problem, offset=offset, wanted=wanted, got=got)
        _count_problem(error, report, strict, sweeps.problem_count)


def _count_problem(error: RecordingError, report: VideoReport, strict: bool, count: int) -> None:
    report.problems += count
    report.first_problem = report.first_problem or error
    if strict:
        raise error


class _Sweep(NamedTuple):
    """One sweep of the file."""

    source: int
    sequence: int
    time_s: float
    azimuth_rad: float
    width_rad: float
    geometry: tuple[float, float]
    amplitude: NDArray

    def follows(self, before: _Sweep) -> bool:
        """Whether the two fit in one array."""
        now, then = self.amplitude, before.amplitude
        return self.geometry == before.geometry and (now.shape, now.dtype) == (
            then.shape,
            then.dtype,
        )

    def counts_from(self, before: _Sweep) -> int:
        """Messages since another sweep, negative where the sender's count goes back."""
        half = _SEQUENCES // 2
        return (self.sequence - before.sequence + half) % _SEQUENCES - half

    def counts_ahead(self, before: _Sweep, after: _Sweep) -> bool:
        """Whether its count would make sweeps late that continue from the one before."""
        return -_LATE < after.counts_from(self) < 0 and after.counts_from(before) > 0

    def strays(self, before: _Sweep, after: _Sweep) -> bool:
        """Whether it is far, in azimuth or time, from two that are not far from each other."""
        return any(
            (far(self, before) or far(after, self)) and not far(after, before)
            for far in (_Sweep._turned_far, _Sweep._jumps)
        )

    @property
    def begin(self) -> int:
        """Number of cells between the antenna and the first."""
        return round(self.geometry[0] / self.geometry[1])

    @property
    def end(self) -> int:
        """Number of cells between the antenna and the end of the last."""
        return self.begin + len(self.amplitude)

    @property
    def scale(self) -> _Scale:
        return _Scale(*self.geometry, len(self.amplitude), self.amplitude.dtype.itemsize)

    def is_part_beside(self, parts: Sequence[_Sweep]) -> bool:
        """Whether it has other cells of the sweep that these are parts of."""
        first, most = parts[0], _MOST_PARTS * len(self.amplitude)
        return (
            self.azimuth_rad == first.azimuth_rad
            and self.geometry[1] == first.geometry[1]
            and self.amplitude.dtype == first.amplitude.dtype
            and all(part.end <= self.begin or self.end <= part.begin for part in parts)
            and all(abs(part.begin - self.begin) < most for part in parts)
        )

    def joined(self, parts: Sequence[_Sweep], begin: int, end: int) -> _Sweep:
        """The sweep with the cells of all its parts, from `begin` to `end`."""
        if len(self.amplitude) == end - begin:
            return self
        amplitude = np.zeros(end - begin, self.amplitude.dtype)
        for part in parts:
            amplitude[part.begin - begin : part.end - begin] = part.amplitude
        nearest_m = min(part.geometry[0] for part in parts)
        start_m = nearest_m if min(part.begin for part in parts) == begin else begin * self.cell_m
        return self._replace(geometry=(start_m, self.cell_m), amplitude=amplitude)

    @property
    def cell_m(self) -> float:
        return self.geometry[1]

    def _turned_far(self, since: _Sweep) -> bool:
        return abs(_turn_rad(since.azimuth_rad, self.azimuth_rad)) > _ASTRAY_RAD

    def _jumps(self, since: _Sweep) -> bool:
        return _jumps(self.time_s - since.time_s)


@dataclass(frozen=True)
class _Scale:
    """The cells of a sweep."""

    start_range_m: float
    cell_m: float
    cells: int = field(compare=False)  # a sweep of the same cells may be longer or shorter
    octets: int

    @property
    def range_m(self) -> float:
        return self.start_range_m + self.cells * self.cell_m


def _returns(scales: Iterable[_Scale]) -> int:
    """How often the range scale changes back to one that was sent before."""
    changes = [scale for scale, _ in itertools.groupby(scales)]
    return len(changes) - len(set(changes))


def _turn_rad(before_rad: float, now_rad: float) -> float:
    return (now_rad - before_rad + math.pi) % _TURN - math.pi


def _rows(path: Path, sweeps: Cat240Sweeps, report: VideoReport, strict: bool) -> Iterator[_Sweep]:
    columns = (
        sweeps.source,
        sweeps.sequence,
        sweeps.time_s,
        sweeps.azimuth_rad,
        sweeps.azimuth_width_rad,
        sweeps.start_range_m,
        sweeps.cell_m,
        sweeps.first,
        sweeps.cells,
        sweeps.bits,
        sweeps.compressed,
    )
    octets, words = sweeps.octets, sweeps.words
    rows = enumerate(zip(*(c.tolist() for c in columns), strict=True))
    for row, (*given, start, cell, first, cells, bits, compressed) in rows:
        if compressed:
            amplitude = _decompressed(octets[first : first + compressed].tobytes(), cells, bits)
        else:
            amplitude = (words if bits > 8 else octets)[first : first + cells].copy()
        if amplitude is None:
            error = RecordingError(
                path,
                "the compressed video cannot be read",
                offset=int(sweeps.offset[row]),
                wanted=f"zlib data of {many(cells, 'cell')} of {bits} bits",
                got=f"other {many(compressed, 'octet')}",
            )
            _count_problem(error, report, strict, 1)
            continue
        yield _Sweep(*given, (start, cell), amplitude)  # a copy lets the piece go


def _decompressed(octets: bytes, cells: int, bits: int) -> NDArray | None:
    """The cells of a sweep compressed by zlib, with its header or without; None if it is not."""
    for form in (zlib.MAX_WBITS | 32, -zlib.MAX_WBITS):
        with suppress(zlib.error):
            whole = zlib.decompressobj(form).decompress(octets, (cells * bits + 7) // 8)
            amplitude = Cat240Decoder.unpack(whole, cells, bits)
            if amplitude is not None:
                return amplitude
    return None


class _Order:
    """Which sweeps are kept, and when they were received."""

    def __init__(
        self,
        report: VideoReport,
        midnight_s: float,
        period_s: float | None,
        range_scale_m: float | None,
    ) -> None:
        self.report = report
        self.other: tuple[int, int] | None = None  # the first other radar
        self._midnight_s = midnight_s
        self._period_s = period_s
        self._range_scale_m = range_scale_m
        self._known = midnight_s, 0.0  # the last time of day, and the way of the beam until then
        self._before: _Sweep | None = None
        self._time_s: float | None = None
        self._beam = Beam()

    def kept(self, sweeps: Iterable[_Sweep]) -> Iterator[tuple[_Sweep, bool]]:
        """The sweeps to keep, with their absolute time, and whether a block begins with each."""
        begins = False
        ours = self._steady(filter(self._is_ours, sweeps), _Sweep.counts_ahead)
        whole = self._of_one_scale(self._timed(self._whole(filter(self._is_next, ours))))
        for sweep in self._steady(whole, _Sweep.strays):
            begins |= self._beam.begins_turn(sweep.azimuth_rad)
            self.report.reversals = self._beam.reversals
            time_s = self._time_of(sweep)
            if math.isnan(time_s):
                self.report.untimed += 1
                continue
            time_s, jump = self._in_order(time_s)
            self.report.sweeps += 1
            yield sweep._replace(time_s=time_s), begins or jump
            begins = False

    def _steady(
        self, sweeps: Iterable[_Sweep], strays: Callable[[_Sweep, _Sweep, _Sweep], bool]
    ) -> Iterator[_Sweep]:
        """The sweeps without those far from both neighbors, which agree."""
        before = held = None
        for sweep in sweeps:
            if held is not None and before is not None and strays(held, before, sweep):
                self.report.astray += 1
            elif held is not None:
                yield held
                before = held
            held = sweep
        if held is not None:
            yield held

    def _is_ours(self, sweep: _Sweep) -> bool:
        source = divmod(sweep.source, 256)
        if self.report.source is None:
            self.report.source = source
        ours = self.report.source == source
        if not ours:
            self.report.other_source += 1
            self.other = self.other or source
        return ours

    def _is_next(self, sweep: _Sweep) -> bool:
        """Whether the sender's count, if there is one, continues."""
        before = self._before
        if before is not None and sweep.sequence >= 0 and before.sequence >= 0:
            step = sweep.counts_from(before)
            if step == 0 and sweep.azimuth_rad == before.azimuth_rad and _same(sweep, before):
                self.report.repeated += 1
                return False
            if -_LATE < step < 0:
                self.report.late += 1
                return False
            self.report.missing += max(step - 1, 0)
        self._before = sweep
        return True

    def _whole(self, messages: Iterable[_Sweep]) -> Iterator[_Sweep]:
        """Sweeps made of the messages of one azimuth; cells that are not there are zero."""
        parts: list[_Sweep] = []
        extent: dict[float, tuple[int, int]] = {}  # of sweeps in parts, by the length of cells
        for message in itertools.chain(messages, [None]):
            if parts and (message is None or not message.is_part_beside(parts)):
                cell_m = parts[0].geometry[1]
                known = extent.get(cell_m)
                begin = min(part.begin for part in parts)
                end = max(part.end for part in parts)
                if known is not None and known[0] <= begin and end <= known[1]:
                    begin, end = known
                    held = sum(len(part.amplitude) for part in parts)
                    self.report.incomplete += held < end - begin
                elif len(parts) > 1:
                    extent[cell_m] = begin, end
                yield parts[0].joined(parts, begin, end)
                parts = []
            if message is not None:
                parts.append(message)

    def _timed(self, sweeps: Iterable[_Sweep]) -> Iterator[_Sweep]:
        """The sweeps, without the time of day where it stands for a revolution."""
        held: list[_Sweep] = []
        before, turned_rad = None, 0.0
        for sweep in sweeps:
            if before is not None and sweep.time_s == before.time_s:
                turned_rad += abs(_turn_rad(before.azimuth_rad, sweep.azimuth_rad))
            else:
                yield from held
                held, turned_rad = [], 0.0
            before = sweep
            held.append(sweep)
            if turned_rad > _TURN:
                self.report.standing += len(held)
                yield from (each._replace(time_s=math.nan) for each in held)
                held = []
        yield from held

    def _of_one_scale(self, sweeps: Iterable[_Sweep]) -> Iterator[_Sweep]:
        """The sweeps of one range scale where several are sent in turn.

        A scale is sent in turn with another if that was sent shortly before and after the sweep.
        """
        waiting: collections.deque[tuple[_Sweep, _Scale]] = collections.deque()
        coming: collections.Counter[_Scale] = collections.Counter()
        seen: dict[_Scale, int] = {}
        before: _Sweep | None = None
        sweeps = iter(sweeps)
        for index in itertools.count():
            for sweep in itertools.islice(sweeps, _NEAR - len(waiting)):
                if before is None or not sweep.follows(before):
                    scale = sweep.scale
                before = sweep
                waiting.append((sweep, scale))
                coming[scale] += 1
            if not waiting:
                return
            if index == 0 and _returns(scale for _, scale in waiting) > _MOST_RETURNS:
                seen = dict.fromkeys(coming, 0)
            ends = len(waiting) < _NEAR and bool(self.report.other_scales)
            sweep, its = waiting.popleft()
            coming[its] -= 1
            seen[its] = index
            in_turn = len(seen) > 1 and [
                other
                for other, last in seen.items()
                if other != its
                and index - last < _NEAR
                and (coming[other] or ends)
                and self._prefers(other, its)
            ]
            if in_turn:
                self.report.other_scales[its.range_m] += 1
                self.report.scale_m = max(in_turn, key=self._preference).range_m
            else:
                yield sweep

    def _prefers(self, scale: _Scale, to: _Scale) -> bool:
        return self._preference(scale) > self._preference(to)

    def _preference(self, scale: _Scale) -> tuple[float, float]:
        wanted_m = self._range_scale_m
        nearness = scale.range_m if wanted_m is None else -abs(scale.range_m - wanted_m)
        return nearness, -scale.cell_m

    def _time_of(self, sweep: _Sweep) -> float:
        time_s, turned_rad = sweep.time_s, self._beam.turned_rad
        if self._period_s is not None and math.isnan(time_s):
            known_s, known_rad = self._known
            return known_s + (turned_rad - known_rad) / _TURN * self._period_s
        if not math.isnan(time_s):
            self._known = self._midnight_s + time_s, turned_rad
        return self._midnight_s + time_s

    def _in_order(self, time_s: float) -> tuple[float, bool]:
        before, self._time_s = self._time_s, time_s
        if before is None:
            return time_s, False
        if -_HELD_S < time_s - before < 0:
            self.report.held += 1
            self._time_s = before
            return before, False
        jump = _jumps(time_s - before)
        self.report.time_jumps += jump
        return time_s, jump


def _jumps(step_s: float) -> bool:
    return step_s <= -_HELD_S or step_s > _PAUSE_S


def _same(sweep: _Sweep, before: _Sweep) -> bool:
    """Whether both have the same time, if they have times."""
    return sweep.time_s == before.time_s or math.isnan(sweep.time_s)


class _Block:
    """Sweeps of one geometry and one revolution."""

    def __init__(self) -> None:
        self._sweeps: list[_Sweep] = []
        self._octets = 0

    def ends_before(self, sweep: _Sweep) -> bool:
        """Whether a sweep belongs to the next block."""
        if not self._sweeps:
            return False
        return (
            self._octets > _MOST or not sweep.follows(self._sweeps[0]) or not self._as_wide(sweep)
        )

    def _as_wide(self, sweep: _Sweep) -> bool:
        width_rad, first_rad = sweep.width_rad, self._sweeps[0].width_rad
        given = width_rad > 0 and first_rad > 0
        return not given or abs(width_rad - first_rad) <= 0.5 * first_rad + 1.5 * _STEP

    def add(self, sweep: _Sweep) -> None:
        self._octets += sweep.amplitude.nbytes
        self._sweeps.append(sweep)

    def videos(self) -> Iterator[RadarVideo]:
        """The sweeps as radar video; None without sweeps."""
        if not self._sweeps:
            return
        start_range_m, cell_m = self._sweeps[0].geometry
        yield RadarVideo(
            amplitude=np.stack([sweep.amplitude for sweep in self._sweeps]),
            azimuth_rad=np.array([sweep.azimuth_rad for sweep in self._sweeps]),
            time_s=np.array([sweep.time_s for sweep in self._sweeps]),
            azimuth_width_rad=self._mean_width_rad(),
            start_range_m=start_range_m,
            cell_m=cell_m,
        )

    def _mean_width_rad(self) -> float:
        given = np.array([sweep.width_rad for sweep in self._sweeps])
        given_rad = float(given[given > 0].mean()) if given.any() else 0.0
        steps = np.abs(np.diff([sweep.azimuth_rad for sweep in self._sweeps]))
        steps = steps[(steps > 0) & (steps < math.pi)]
        if len(steps) == 0:
            return given_rad or _STEP
        step_rad = float(np.median(steps))
        abut = step_rad / _ABUT <= given_rad <= step_rad * _ABUT
        return given_rad if abut else step_rad
