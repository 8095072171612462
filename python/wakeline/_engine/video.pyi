"""
Radar video to plots.
"""

import typing

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..recording.video import RadarVideo

__all__ = [
    "Cat240Decoder",
    "Cat240Encoder",
    "Cat240Sweeps",
    "ExtractionCounts",
    "LandMask",
    "PlotExtractor",
    "ScanImage",
    "StaticClutterMap",
    "VideoPlots",
    "cfar",
    "cfar_threshold",
    "false_alarm_probability",
    "threshold_factor",
    "threshold_offset_db",
]

class LandMask:
    """
    Areas about the antenna in which nothing is detected.

    Of each direction it knows the ranges that are excluded; a cell that lies in an area by a part is
    excluded.

    Parameters
    ----------
    azimuths : int
        Directions in a turn.
    """
    def __init__(self, azimuths: int = 4096) -> None: ...
    def exclude_polygon(self, corners_m: ArrayLike) -> None:
        """
        Excludes the inside of a polygon.

        Parameters
        ----------
        corners_m : (k, 2) array
            North and east of the antenna, which may lie inside.
        """
    def exclude_sector(
        self, from_azimuth_rad: float, to_azimuth_rad: float, near_m: float, far_m: float
    ) -> None:
        """
        Excludes ranges in the directions clockwise from one azimuth to another, across north
        too; a whole turn where these are a turn apart.
        """
    def excludes(self, azimuth_rad: float, range_m: float) -> bool:
        """
        Whether a place is excluded.
        """
    @property
    def azimuths(self) -> int: ...

class StaticClutterMap:
    """
    What always stands there: the mean amplitude of each cell.

    A cell must exceed `factor` times its mean over the last `time_constant_s`. Land and buoys vanish
    after ``time_constant_s * log(factor / (factor - 1))``, and so does a ship that stays as long.

    Parameters
    ----------
    azimuths : int
        Rows in a turn; of several sweeps in a row the strongest amplitudes are learned.
    cells : int
        Cells of range; cells of sweeps beyond are left alone.
    time_constant_s : float
        Well above the time in which the slowest ship of interest moves by her own echo.
    factor : float
        Of the mean amplitude that a cell must exceed.
    """
    def __copy__(self) -> StaticClutterMap: ...
    def __deepcopy__(self, memo: dict) -> StaticClutterMap: ...
    def __init__(
        self, azimuths: int, cells: int, time_constant_s: float, factor: float = 1.5
    ) -> None: ...
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """
    @property
    def azimuths(self) -> int: ...
    @property
    def cells(self) -> int: ...
    @property
    def mean(self) -> NDArray[np.float32]:
        """
        (azimuths, cells) float32: mean amplitudes.
        """

class VideoPlots:
    """
    Plots of radar video as arrays, in the order in which their echoes were over.
    """
    def __len__(self) -> int: ...
    @property
    def bearing_extent_rad(self) -> NDArray[np.float64]: ...
    @property
    def bearing_rad(self) -> NDArray[np.float64]:
        """
        (n,) amplitude-weighted means, clockwise from north, 0 to 2 pi.
        """
    @property
    def cells(self) -> NDArray[np.int64]:
        """
        (n,) cells above their thresholds.
        """
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (n, 2, 2) of range_m and bearing_rad: weighted spread of the echo by its effective number of cells, and a twelfth of a cell's and a sweep's square.
        """
    @property
    def cut(self) -> NDArray[np.bool_]:
        """
        (n,) true where the plot may be a part of an echo: closed at `max_sweeps`, or beside sweeps that are missing.
        """
    @property
    def peak_amplitude(self) -> NDArray[np.float64]: ...
    @property
    def range_extent_m(self) -> NDArray[np.float64]: ...
    @property
    def range_m(self) -> NDArray[np.float64]:
        """
        (n,) amplitude-weighted means.
        """
    @property
    def time_s(self) -> NDArray[np.float64]: ...
    @property
    def total_amplitude(self) -> NDArray[np.float64]: ...
    @property
    def touches_first_cell(self) -> NDArray[np.bool_]: ...
    @property
    def touches_last_cell(self) -> NDArray[np.bool_]: ...

class ExtractionCounts:
    """
    What has happened to the sweeps and echoes of an extractor.
    """
    @property
    def cut(self) -> int:
        """
        Plots that may be parts of echoes.
        """
    @property
    def gaps(self) -> int:
        """
        Times that sweeps were missing.
        """
    @property
    def geometry_changes(self) -> int:
        """
        Times that start range or cell length changed.
        """
    @property
    def invalid(self) -> int:
        """
        Sweeps refused for they made no sense.
        """
    @property
    def plots(self) -> int: ...
    @property
    def repeated(self) -> int:
        """
        Sweeps refused for they stood where the last one stood.
        """
    @property
    def reversals(self) -> int:
        """
        Times that the antenna went back.
        """
    @property
    def sweeps(self) -> int:
        """
        Used.
        """
    @property
    def too_large(self) -> int:
        """
        Echoes that gave no plot.
        """
    @property
    def too_long(self) -> int:
        """
        Sweeps refused for their length.
        """
    @property
    def too_small(self) -> int:
        """
        Echoes that gave no plot.
        """

class PlotExtractor:
    """
    Sweeps in, plots out as soon as their echo is over.

    CFAR along range, then cells that touch are one echo, from sweep to sweep and turn to turn; north
    is a direction as any other. A sweep that is missing closes the echoes it would have touched, as
    does a step back of the antenna and another cell length; a sweep that makes no sense is refused;
    see `counts`. Memory is taken once, whatever the picture.

    Parameters
    ----------
    kind, train_cells, guard_cells, threshold_factor, threshold_offset, rank, least_amplitude
        As of `cfar`.
    max_sweep_cells : int
        Longer sweeps are refused.
    gap_cells, gap_sweeps : int
        That may be missing within an echo.
    min_cells, max_cells : int
        Smaller and larger echoes give no plot.
    max_range_extent_m, max_bearing_extent_rad : float
        Longer and wider echoes give no plot.
    max_sweeps : int
        An echo is closed after so many; what follows is another one, and both are marked as `cut`.
    closed_circle : bool
        Each turn is a picture of its own, whose last sweeps are joined with its first ones. Without,
        turns follow each other.
    land : LandMask, optional
        Where nothing is detected.
    clutter : StaticClutterMap, optional
        What always stands there; the extractor learns with a copy.
    """
    def __init__(
        self,
        *,
        kind: str = "cell_averaging",
        train_cells: int = 16,
        guard_cells: int = 4,
        threshold_factor: float = 3.0,
        threshold_offset: int = 0,
        rank: float = 0.75,
        least_amplitude: int = 1,
        max_sweep_cells: int = 4096,
        gap_cells: int = 0,
        gap_sweeps: int = 0,
        min_cells: int = 2,
        max_cells: int = 100000000,
        max_range_extent_m: float = 1000000.0,
        max_bearing_extent_rad: float = 6.283185307179586,
        max_sweeps: int = 1024,
        closed_circle: bool = False,
        land: LandMask | None = None,
        clutter: StaticClutterMap | None = None,
    ) -> None: ...
    def finish(self) -> VideoPlots:
        """
        No sweep will follow: the plots of all open echoes. Then the extractor is ready for other sweeps, with the counts and the clutter map that it has.
        """
    def process(self, video: RadarVideo) -> VideoPlots:
        """
        Takes the sweeps of a video; the next one continues where it ends.

        Returns
        -------
        VideoPlots
            Of the echoes that were over within.
        """
    def set_land(self, land: LandMask) -> None:
        """
        Other areas from the next sweep on.
        """
    @property
    def clutter(self) -> StaticClutterMap:
        """
        A copy of what the extractor has learned of static clutter.
        """
    @property
    def counts(self) -> ExtractionCounts: ...
    @property
    def open_echoes(self) -> int:
        """
        Number of echoes that are not over yet.
        """

class ScanImage:
    """
    The picture of the last turn on a regular polar grid.

    Sweeps that follow each other and share a row leave the greater amplitude; a row that the beam
    comes back to is written anew.

    Parameters
    ----------
    sweeps, cells : int
        Rows in a turn, and range cells of each.
    bits : int
        8 or 16.
    first_azimuth_rad : float
        Of row 0.
    """
    def __init__(
        self, sweeps: int, cells: int, *, bits: int = 8, first_azimuth_rad: float = 0.0
    ) -> None: ...
    def __len__(self) -> int: ...
    def add(self, video: RadarVideo) -> int:
        """
        Takes the sweeps of a video; the number of those that made sense and were taken. Another start range or cell length clears the image first.
        """
    def clear(self) -> None: ...
    @property
    def amplitude(self) -> NDArray[np.uint8] | NDArray[np.uint16]:
        """
        (sweeps, cells) of uint8 or uint16: the image's own memory, which changes with it.
        """
    @property
    def azimuth_rad(self) -> NDArray[np.float64]:
        """
        (sweeps,) centres of the rows.
        """
    @property
    def azimuth_step_rad(self) -> float: ...
    @property
    def azimuth_width_rad(self) -> float:
        """
        What a row stands for, as of a video.
        """
    @property
    def cell_m(self) -> float: ...
    @property
    def first_azimuth_rad(self) -> float: ...
    @property
    def range_m(self) -> NDArray[np.float64]:
        """
        (cells,) centres of the cells.
        """
    @property
    def start_range_m(self) -> float: ...

class Cat240Sweeps:
    """
    Sweeps decoded from a piece of a file, a row each.

    `first` is where the cells of a sweep begin in `octets` (8 bits and fewer, these scaled to 8) or in
    `words` (16 bits). `source` is 256 SAC + SIC, `sequence` -1 and `time_s` NaN where the sender tells
    none. `problems` has the first 100 as (offset, problem, wanted, got).
    """
    @property
    def azimuth_rad(self) -> NDArray[np.float64]: ...
    @property
    def azimuth_width_rad(self) -> NDArray[np.float64]: ...
    @property
    def bits(self) -> NDArray[np.int64]: ...
    @property
    def cell_m(self) -> NDArray[np.float64]: ...
    @property
    def cells(self) -> NDArray[np.int64]: ...
    @property
    def consumed(self) -> int: ...
    @property
    def first(self) -> NDArray[np.int64]: ...
    @property
    def octets(self) -> NDArray[np.uint8]: ...
    @property
    def offset(self) -> NDArray[np.int64]: ...
    @property
    def problem_count(self) -> int: ...
    @property
    def problems(self) -> list[tuple[int, str, str, str]]: ...
    @property
    def sequence(self) -> NDArray[np.int64]: ...
    @property
    def source(self) -> NDArray[np.int64]: ...
    @property
    def start_range_m(self) -> NDArray[np.float64]: ...
    @property
    def summaries(self) -> list[bytes]: ...
    @property
    def time_s(self) -> NDArray[np.float64]: ...
    @property
    def words(self) -> NDArray[np.uint16]: ...

class Cat240Decoder:
    """
    ASTERIX category 240 to arrays, piece by piece.
    """
    def __init__(self) -> None: ...
    def decode(self, data: bytes, last: bool) -> Cat240Sweeps:
        """
        The sweeps of a piece of a file.

        Parameters
        ----------
        data : bytes
            What the piece before left over (all but its first `consumed` octets) and what follows.
        last : bool
            Whether nothing follows.
        """
    @property
    def other_blocks(self) -> int:
        """
        Blocks of other categories so far.
        """
    @property
    def skipped_octets(self) -> int:
        """
        Octets passed over because of damage so far.
        """

class Cat240Encoder:
    """
    Sweeps to ASTERIX category 240.
    """
    def __init__(self, area: int = 0, system: int = 0) -> None: ...
    @typing.overload
    def encode(
        self,
        amplitude: NDArray[np.uint8],
        azimuth_rad: ArrayLike,
        time_s: ArrayLike,
        azimuth_width_rad: float,
        start_range_m: float,
        cell_m: float,
    ) -> bytes:
        """
        The blocks of some sweeps, one each.

        Parameters
        ----------
        amplitude : (N, C) array of uint8 or uint16
        azimuth_rad, time_s : (N,) array
        azimuth_width_rad, start_range_m, cell_m : float

        Raises
        ------
        ValueError
            When a sweep cannot be written: too many cells, a length that cannot be told.
        """
    @typing.overload
    def encode(
        self,
        amplitude: NDArray[np.uint16],
        azimuth_rad: ArrayLike,
        time_s: ArrayLike,
        azimuth_width_rad: float,
        start_range_m: float,
        cell_m: float,
    ) -> bytes:
        """
        The blocks of some sweeps, one each.

        Parameters
        ----------
        amplitude : (N, C) array of uint8 or uint16
        azimuth_rad, time_s : (N,) array
        azimuth_width_rad, start_range_m, cell_m : float

        Raises
        ------
        ValueError
            When a sweep cannot be written: too many cells, a length that cannot be told.
        """
    def encode_summary(self, text: str) -> bytes:
        """
        The block of a text about the video, at most 255 characters of ASCII.
        """

def cfar(
    amplitude: NDArray[np.uint8] | NDArray[np.uint16],
    *,
    kind: str = "cell_averaging",
    train_cells: int = 16,
    guard_cells: int = 4,
    threshold_factor: float = 3.0,
    threshold_offset: int = 0,
    rank: float = 0.75,
    least_amplitude: int = 1,
) -> NDArray[np.bool_]:
    """
    Which cells stand out from those before and behind them: CFAR along range.

    Parameters
    ----------
    amplitude : (N, C) array of uint8 or uint16
        Sweeps, of each its range cells.
    kind : str
        cell_averaging compares a cell with the mean of its training cells, ordered_statistic with the
        k-th smallest.
    train_cells : int
        On each side, 1 to 128; at the ends of a sweep those that exist.
    guard_cells : int
        On each side, next to the cell, that are left out.
    threshold_factor : float
        Times the mean or the k-th; see `threshold_factor`.
    threshold_offset : int
        On top of that. Video of a logarithmic receiver wants a factor of 1 and an offset; see
        `threshold_offset_db`.
    rank : float
        k by the number of training cells; ordered_statistic only.
    least_amplitude : int
        Less is never detected.

    Returns
    -------
    (N, C) bool array
    """

def cfar_threshold(
    amplitude: NDArray[np.uint8] | NDArray[np.uint16],
    *,
    kind: str = "cell_averaging",
    train_cells: int = 16,
    guard_cells: int = 4,
    threshold_factor: float = 3.0,
    threshold_offset: int = 0,
    rank: float = 0.75,
    least_amplitude: int = 1,
) -> NDArray[np.uint8] | NDArray[np.uint16]:
    """
    The amplitudes that cells have to exceed: (N, C) of the amplitudes' type.

    Parameters as of `cfar`.
    """

def false_alarm_probability(
    threshold_factor: float,
    *,
    noise: str = "rayleigh",
    kind: str = "cell_averaging",
    train_cells: int = 16,
    rank: float = 0.75,
) -> float:
    """
    The other way round: the probability at which noise is detected; see `threshold_factor`.
    """

def threshold_factor(
    probability: float,
    *,
    noise: str = "rayleigh",
    kind: str = "cell_averaging",
    train_cells: int = 16,
    rank: float = 0.75,
) -> float:
    """
    The threshold factor at which noise is detected with a probability.

    With N = 2 `train_cells`, factor f and p the probability::

        cell_averaging     exponential   p = (1 + f / N)^-N
                           rayleigh      p = (1 + f^2 b / N)^-N,   b = pi/4 + (1 - pi/4) / N
        ordered_statistic  exponential   p = prod_{i<k} (N - i) / (N - i + f),   k = ceil(rank N)
                           rayleigh      the same with f^2

    The second takes a mean of Rayleigh amplitudes for simpler than it is: with 8 to 16 training cells noise is detected
    10 to 30 % more often than a probability of 1e-4 to 1e-6 says. The others are exact.

    Parameters
    ----------
    probability : float
        Of a cell of independent noise with all its training cells.
    noise : str
        How its amplitudes are distributed: exponential behind a square-law detector, rayleigh behind
        a linear one.
    kind, train_cells, rank
        As of `cfar`.
    """

def threshold_offset_db(probability: float) -> float:
    """
    How far noise behind a logarithmic receiver exceeds its mean level with a probability.

    ``10 lg(-ln p) + 2.507``, in decibels; times the receiver's steps a decibel it is the
    `threshold_offset`, with a `threshold_factor` of 1. Exact for many training cells.
    """
