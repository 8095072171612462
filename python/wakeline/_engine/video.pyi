"""
Plots from radar video.
"""
import typing
import numpy as np
from numpy.typing import ArrayLike, NDArray
from ..recording.video import RadarVideo
__all__: list = ['cfar', 'cfar_threshold', 'threshold_factor', 'false_alarm_probability', 'threshold_offset_db', 'LandMask', 'StaticClutterMap', 'VideoPlots', 'ExtractionCounts', 'PlotExtractor', 'ScanImage', 'Cat240Sweeps', 'Cat240Decoder', 'Cat240Encoder']
class LandMask:
    """
    Areas around the antenna without detections.
    
    It holds the excluded ranges of each direction; a cell that is partly inside an area is excluded.
    
    Parameters
    ----------
    azimuths : int
        Directions per revolution.
    """
    def __init__(self, azimuths: int = 4096) -> None:
        ...
    def exclude_polygon(self, corners_m: ArrayLike) -> None:
        """
        Exclude the inside of a polygon.
        
        Parameters
        ----------
        corners_m : (k, 2) array
            North and east of the antenna, which may be inside.
        """
    def exclude_sector(self, from_azimuth_rad: float, to_azimuth_rad: float, near_m: float, far_m: float) -> None:
        """
        Exclude ranges in the directions clockwise from one azimuth to another, also across north;
                   a full revolution if they differ by 2 pi.
        """
    def excludes(self, azimuth_rad: float, range_m: float) -> bool:
        """
        Whether a position is excluded.
        """
    @property
    def azimuths(self) -> int:
        ...
class StaticClutterMap:
    """
    Static clutter: the mean amplitude of each cell.
    
    A cell must exceed `factor` times its mean over the last `time_constant_s`. Land and buoys vanish
    after ``time_constant_s * log(factor / (factor - 1))``, and so does a stationary ship.
    
    Parameters
    ----------
    azimuths : int
        Rows per revolution; of several sweeps in a row the largest amplitudes are learned.
    cells : int
        Range cells; cells beyond are ignored.
    time_constant_s : float
        Well above the time in which the slowest ship of interest moves by the size of its echo.
    factor : float
        A cell must exceed this times its mean amplitude.
    """
    def __copy__(self) -> StaticClutterMap:
        ...
    def __deepcopy__(self, memo: dict) -> StaticClutterMap:
        ...
    def __init__(self, azimuths: int, cells: int, time_constant_s: float, factor: float = 1.5) -> None:
        ...
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    @property
    def azimuths(self) -> int:
        ...
    @property
    def cells(self) -> int:
        ...
    @property
    def mean(self) -> NDArray[np.float32]:
        """
        (azimuths, cells) float32: mean amplitudes.
        """
class VideoPlots:
    """
    Plots of radar video as arrays, in order of the ends of their echoes.
    """
    def __len__(self) -> int:
        ...
    @property
    def bearing_extent_rad(self) -> NDArray[np.float64]:
        ...
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
        (n, 2, 2) of range_m and bearing_rad: weighted spread of the echo divided by its effective number of cells, plus a twelfth of a cell's and a sweep's square.
        """
    @property
    def cut(self) -> NDArray[np.bool_]:
        """
        (n,) true where the plot may be a part of an echo: closed at `max_sweeps`, or next to missing sweeps.
        """
    @property
    def peak_amplitude(self) -> NDArray[np.float64]:
        ...
    @property
    def range_extent_m(self) -> NDArray[np.float64]:
        ...
    @property
    def range_m(self) -> NDArray[np.float64]:
        """
        (n,) amplitude-weighted means.
        """
    @property
    def time_s(self) -> NDArray[np.float64]:
        ...
    @property
    def total_amplitude(self) -> NDArray[np.float64]:
        ...
    @property
    def touches_first_cell(self) -> NDArray[np.bool_]:
        ...
    @property
    def touches_last_cell(self) -> NDArray[np.bool_]:
        ...
class ExtractionCounts:
    """
    Counts of the sweeps and echoes of an extractor.
    """
    @property
    def cut(self) -> int:
        """
        Plots that may be parts of echoes.
        """
    @property
    def gaps(self) -> int:
        """
        Number of gaps in the sweeps.
        """
    @property
    def geometry_changes(self) -> int:
        """
        Number of changes of start range or cell length.
        """
    @property
    def invalid(self) -> int:
        """
        Invalid sweeps, rejected.
        """
    @property
    def plots(self) -> int:
        ...
    @property
    def repeated(self) -> int:
        """
        Sweeps rejected at the azimuth of the last one.
        """
    @property
    def reversals(self) -> int:
        """
        Number of steps back of the antenna.
        """
    @property
    def sweeps(self) -> int:
        """
        Used.
        """
    @property
    def too_large(self) -> int:
        """
        Echoes too large for a plot.
        """
    @property
    def too_long(self) -> int:
        """
        Sweeps rejected for their length.
        """
    @property
    def too_small(self) -> int:
        """
        Echoes too small for a plot.
        """
class PlotExtractor:
    """
    Extracts plots from sweeps; a plot is complete when its echo ends.
    
    CFAR along range; connected cells are one echo, from sweep to sweep and across revolutions. A missing
    sweep closes the echoes it would have touched, and so does a step back of the antenna or a change of
    the cell length; invalid sweeps are rejected; see `counts`. Memory is allocated once.
    
    Parameters
    ----------
    kind, train_cells, guard_cells, threshold_factor, threshold_offset, rank, least_amplitude
        As of `cfar`.
    max_sweep_cells : int
        Longer sweeps are rejected.
    gap_cells, gap_sweeps : int
        Gaps allowed within an echo.
    min_cells, max_cells : int
        Smaller and larger echoes give no plot.
    max_range_extent_m, max_bearing_extent_rad : float
        Longer and wider echoes give no plot.
    max_sweeps : int
        An echo is closed after this many sweeps; the rest is another echo, and both are marked as `cut`.
    closed_circle : bool
        Each revolution is a separate picture whose last sweeps are connected with its first ones.
        Otherwise revolutions follow each other.
    land : LandMask, optional
        Areas without detections.
    clutter : StaticClutterMap, optional
        Static clutter; the extractor learns with a copy.
    """
    def __init__(self, *, kind: str = 'cell_averaging', train_cells: int = 16, guard_cells: int = 4, threshold_factor: float = 3.0, threshold_offset: int = 0, rank: float = 0.75, least_amplitude: int = 1, max_sweep_cells: int = 4096, gap_cells: int = 0, gap_sweeps: int = 0, min_cells: int = 2, max_cells: int = 100000000, max_range_extent_m: float = 1000000.0, max_bearing_extent_rad: float = 6.283185307179586, max_sweeps: int = 1024, closed_circle: bool = False, land: LandMask | None = None, clutter: StaticClutterMap | None = None) -> None:
        ...
    def finish(self) -> VideoPlots:
        """
        Close all open echoes and return their plots. The extractor is then ready for other sweeps, with its counts and clutter map.
        """
    def process(self, video: RadarVideo) -> VideoPlots:
        """
        Process the sweeps of a video, which continue the previous ones.
        
        Returns
        -------
        VideoPlots
            Plots of the echoes that ended.
        """
    def set_land(self, land: LandMask) -> None:
        """
        Replace the areas, from the next sweep on.
        """
    @property
    def clutter(self) -> StaticClutterMap:
        """
        A copy of what the extractor has learned of static clutter.
        """
    @property
    def counts(self) -> ExtractionCounts:
        ...
    @property
    def open_echoes(self) -> int:
        """
        Number of open echoes.
        """
class ScanImage:
    """
    The picture of the last revolution on a regular polar grid.
    
    Consecutive sweeps in one row leave the larger amplitude; a row to which the beam returns is
    overwritten.
    
    Parameters
    ----------
    sweeps, cells : int
        Rows per revolution, and range cells of each.
    bits : int
        8 or 16.
    first_azimuth_rad : float
        Of row 0.
    """
    def __init__(self, sweeps: int, cells: int, *, bits: int = 8, first_azimuth_rad: float = 0.0) -> None:
        ...
    def __len__(self) -> int:
        ...
    def add(self, video: RadarVideo) -> int:
        """
        Add the sweeps of a video; returns the number of valid ones. Another start range or cell length clears the image first.
        """
    def clear(self) -> None:
        ...
    @property
    def amplitude(self) -> NDArray[np.uint8] | NDArray[np.uint16]:
        """
        (sweeps, cells) of uint8 or uint16: the image's own memory, which changes with it.
        """
    @property
    def azimuth_rad(self) -> NDArray[np.float64]:
        """
        (sweeps,) centers of the rows.
        """
    @property
    def azimuth_step_rad(self) -> float:
        ...
    @property
    def azimuth_width_rad(self) -> float:
        """
        Width of a row.
        """
    @property
    def cell_m(self) -> float:
        ...
    @property
    def first_azimuth_rad(self) -> float:
        ...
    @property
    def range_m(self) -> NDArray[np.float64]:
        """
        (cells,) centers of the cells.
        """
    @property
    def start_range_m(self) -> float:
        ...
class Cat240Sweeps:
    """
    Sweeps decoded from a piece of a file, one per row.
    
    `first` is the index of a sweep's first cell in `octets` (8 bits and fewer, scaled to 8) or in `words`
    (16 bits). Where `compressed` is not 0 it is a number of octets from there on; decompress them and
    call `Cat240Decoder.unpack`. `source` is 256 SAC + SIC; `sequence` is -1 and `time_s` NaN if missing. `problems` has the
    first 100 as (offset, problem, wanted, got).
    """
    @property
    def azimuth_rad(self) -> NDArray[np.float64]:
        ...
    @property
    def azimuth_width_rad(self) -> NDArray[np.float64]:
        ...
    @property
    def bits(self) -> NDArray[np.int64]:
        ...
    @property
    def cell_m(self) -> NDArray[np.float64]:
        ...
    @property
    def cells(self) -> NDArray[np.int64]:
        ...
    @property
    def compressed(self) -> NDArray[np.int64]:
        ...
    @property
    def consumed(self) -> int:
        ...
    @property
    def first(self) -> NDArray[np.int64]:
        ...
    @property
    def octets(self) -> NDArray[np.uint8]:
        ...
    @property
    def offset(self) -> NDArray[np.int64]:
        ...
    @property
    def problem_count(self) -> int:
        ...
    @property
    def problems(self) -> list[tuple[int, str, str, str]]:
        ...
    @property
    def sequence(self) -> NDArray[np.int64]:
        ...
    @property
    def source(self) -> NDArray[np.int64]:
        ...
    @property
    def start_range_m(self) -> NDArray[np.float64]:
        ...
    @property
    def summaries(self) -> list[bytes]:
        ...
    @property
    def time_s(self) -> NDArray[np.float64]:
        ...
    @property
    def words(self) -> NDArray[np.uint16]:
        ...
class Cat240Decoder:
    """
    ASTERIX category 240 to arrays, piece by piece.
    """
    @staticmethod
    def unpack(octets: bytes, cells: int, bits: int) -> NDArray[np.float64]:
        """
        The cells of a sweep from its decompressed octets.
        
        Parameters
        ----------
        octets : bytes
        cells, bits : int
            Number of cells, and bits of each: 1, 2, 4, 8 or 16.
        
        Returns
        -------
        (cells,) array of uint8 or uint16, or None
            None for too few octets.
        """
    def __init__(self) -> None:
        ...
    def decode(self, data: bytes, last: bool) -> Cat240Sweeps:
        """
        The sweeps of a piece of a file.
        
        Parameters
        ----------
        data : bytes
            The rest of the previous piece (all but its first `consumed` octets) and what follows.
        last : bool
            Whether this is the last piece.
        """
    @property
    def other_blocks(self) -> int:
        """
        Blocks of other categories so far.
        """
    @property
    def skipped_octets(self) -> int:
        """
        Octets skipped because of damage so far.
        """
class Cat240Encoder:
    """
    Sweeps to ASTERIX category 240.
    """
    def __init__(self, area: int = 0, system: int = 0) -> None:
        ...
    @typing.overload
    def encode(self, amplitude: NDArray[np.uint8], azimuth_rad: ArrayLike, time_s: ArrayLike, azimuth_width_rad: float, start_range_m: float, cell_m: float) -> bytes:
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
            When a sweep cannot be written: too many cells, or a length that the format cannot represent.
        """
    @typing.overload
    def encode(self, amplitude: NDArray[np.uint16], azimuth_rad: ArrayLike, time_s: ArrayLike, azimuth_width_rad: float, start_range_m: float, cell_m: float) -> bytes:
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
            When a sweep cannot be written: too many cells, or a length that the format cannot represent.
        """
    def encode_summary(self, text: str) -> bytes:
        """
        The block of a description of the video, at most 255 ASCII characters.
        """
def cfar(amplitude: NDArray[np.uint8] | NDArray[np.uint16], *, kind: str = 'cell_averaging', train_cells: int = 16, guard_cells: int = 4, threshold_factor: float = 3.0, threshold_offset: int = 0, rank: float = 0.75, least_amplitude: int = 1) -> NDArray[np.bool_]:
    """
    Detect cells that exceed their neighbors in range at a constant false alarm rate (CFAR).
    
    Parameters
    ----------
    amplitude : (N, C) array of uint8 or uint16
        Range cells of each sweep.
    kind : str
        cell_averaging compares a cell with the mean of its training cells, ordered_statistic with the
        k-th smallest.
    train_cells : int
        Training cells on each side, 1 to 128; at the ends of a sweep those that exist.
    guard_cells : int
        Guard cells on each side, next to the cell, which are excluded.
    threshold_factor : float
        Multiplies the mean or the k-th smallest; see `threshold_factor`.
    threshold_offset : int
        Added to the product. Video of a logarithmic receiver needs a factor of 1 and an offset; see
        `threshold_offset_db`.
    rank : float
        k / number of training cells; ordered_statistic only.
    least_amplitude : int
        Smaller amplitudes are never detected.
    
    Returns
    -------
    (N, C) bool array
    """
def cfar_threshold(amplitude: NDArray[np.uint8] | NDArray[np.uint16], *, kind: str = 'cell_averaging', train_cells: int = 16, guard_cells: int = 4, threshold_factor: float = 3.0, threshold_offset: int = 0, rank: float = 0.75, least_amplitude: int = 1) -> NDArray[np.uint8] | NDArray[np.uint16]:
    """
    Thresholds of the cells: (N, C) of the amplitudes' type.
    
    Parameters as for `cfar`.
    """
def false_alarm_probability(threshold_factor: float, *, noise: str = 'rayleigh', kind: str = 'cell_averaging', train_cells: int = 16, rank: float = 0.75) -> float:
    """
    Inverse of `threshold_factor`: the probability of false alarm.
    """
def threshold_factor(probability: float, *, noise: str = 'rayleigh', kind: str = 'cell_averaging', train_cells: int = 16, rank: float = 0.75) -> float:
    """
    The threshold factor for a given probability of false alarm.
    
    With N = 2 `train_cells`, factor f and p the probability::
    
        cell_averaging     exponential   p = (1 + f / N)^-N
                           rayleigh      p = (1 + f^2 b / N)^-N,   b = pi/4 + (1 - pi/4) / N
        ordered_statistic  exponential   p = prod_{i<k} (N - i) / (N - i + f),   k = ceil(rank N)
                           rayleigh      the same with f^2
    
    The second approximates the distribution of a mean of Rayleigh amplitudes: with 8 to 16 training cells and a
    probability of 1e-4 to 1e-6 false alarms are 10 to 30 % more frequent. The others are exact.
    
    Parameters
    ----------
    probability : float
        For a cell of independent noise with all training cells.
    noise : str
        Distribution of the amplitudes: exponential after a square-law detector, rayleigh after a
        linear one.
    kind, train_cells, rank
        As for `cfar`.
    """
def threshold_offset_db(probability: float) -> float:
    """
    The threshold above the mean level for a logarithmic receiver and a probability of false alarm.
    
    ``10 lg(-ln p) + 2.507`` decibels; multiplied by the receiver's steps per decibel it is the
    `threshold_offset`, with a `threshold_factor` of 1. Exact for many training cells.
    """
