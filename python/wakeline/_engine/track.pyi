"""
The life of tracks.
"""

import typing

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .core import Gaussian
from .measurement import OwnShip
from .multimodel import (
    AdaptiveGridImm,
    BayesianAlphaBeta,
    FuzzyAlphaBeta,
    Imm,
    LikelyModelSetImm,
    ModeHistory,
    SwitchingGridImm,
)

__all__ = [
    "Event",
    "Radar",
    "ScanReport",
    "TrackTable",
    "Tracker",
    "TrackerConfig",
    "VesselModels",
    "vessel_imm",
]

class Radar:
    """
    What a console knows of its radar and of the vessels it looks at.
    """

    __hash__: typing.ClassVar[None]  # type: ignore[assignment]
    def __copy__(self) -> Radar: ...
    def __deepcopy__(self, memo: dict) -> Radar: ...
    def __eq__(self, other: object) -> bool: ...
    def __init__(
        self,
        *,
        range_std_m: float = 10.0,
        bearing_std_rad: float = 0.017453292519943295,
        extent_std_m: float = 5.0,
        period_s: float = 3.0,
        max_speed_mps: float = 30.0,
        bearing_offset_rad: float = 0.0,
    ) -> None: ...
    def as_dict(self) -> dict[str, float | int | str]:
        """
        The settings by name.
        """
    def position(self, range_m: float, bearing_rad: float, own: OwnShip = ...) -> Gaussian:
        """
        A plot seen from own ship as a position [north, east] with its covariance.
        """
    bearing_offset_rad: float
    bearing_std_rad: float
    extent_std_m: float
    max_speed_mps: float
    period_s: float
    range_std_m: float

class TrackerConfig:
    """
    The rules by which tracks live; one set of defaults for all radars.
    """

    __hash__: typing.ClassVar[None]  # type: ignore[assignment]
    def __copy__(self) -> TrackerConfig: ...
    def __deepcopy__(self, memo: dict) -> TrackerConfig: ...
    def __eq__(self, other: object) -> bool: ...
    def __init__(
        self,
        *,
        detection_probability: float = 0.8,
        gate_probability: float = 0.95,
        clutter_density_per_m2: float = 1e-07,
        wild_probability: float = 0.2,
        wild_scale: float = 4.0,
        clutter_cell_m: float = 150.0,
        clutter_memory_s: float = 60.0,
        clutter_weight: float = 1.0,
        visible_time_s: float = 60.0,
        hidden_time_s: float = 40.0,
        initial_existence: float = 0.08,
        free_plot: float = 0.8,
        start_gate_sigma: float = 3.0,
        start_speed_factor: float = 1.0,
        confirm_existence: float = 0.99,
        confirm_hits: int = 3,
        confirm_window: int = 5,
        survival_time_s: float = 1000.0,
        drop_existence: float = 0.005,
        tentative_misses: int = 4,
        coast_scans: float = 5.0,
        coast_scans_per_hit: float = 0.3,
        coast_scans_max: int = 15,
        shown_scans: int = 4,
        drop_position_std_m: float = 100.0,
        drop_speed_factor: float = 1.0,
        duplicate_distance: float = 0.5,
        vessel_length_m: float = 0.0,
        duplicate_scans: int = 3,
        max_tracks: int = 500,
        max_plots: int = 20000,
        association: str = "probabilistic",
    ) -> None: ...
    def as_dict(self) -> dict[str, float | int | str]:
        """
        The settings by name.
        """
    association: str
    """
    probabilistic, global_nearest or nearest
    """
    clutter_cell_m: float
    clutter_density_per_m2: float
    clutter_memory_s: float
    clutter_weight: float
    coast_scans: float
    coast_scans_max: int
    coast_scans_per_hit: float
    confirm_existence: float
    confirm_hits: int
    confirm_window: int
    detection_probability: float
    drop_existence: float
    drop_position_std_m: float
    drop_speed_factor: float
    duplicate_distance: float
    duplicate_scans: int
    free_plot: float
    gate_probability: float
    hidden_time_s: float
    initial_existence: float
    max_plots: int
    max_tracks: int
    shown_scans: int
    start_gate_sigma: float
    start_speed_factor: float
    survival_time_s: float
    tentative_misses: int
    vessel_length_m: float
    visible_time_s: float
    wild_probability: float
    wild_scale: float

class VesselModels:
    """
    The motion models of a tracker: cruising, steady, restless and turning.
    """

    __hash__: typing.ClassVar[None]  # type: ignore[assignment]
    @staticmethod
    def ships() -> VesselModels:
        """
        Of ships under way, which alter course as ships do.
        """
    def __copy__(self) -> VesselModels: ...
    def __deepcopy__(self, memo: dict) -> VesselModels: ...
    def __eq__(self, other: object) -> bool: ...
    def __init__(
        self,
        *,
        cruising_psd_m2s3: float = 0.0001,
        cruising_course_psd_rad2s: float = 1e-06,
        steady_psd_m2s3: float = 0.005,
        steady_course_psd_rad2s: float = 0.004,
        restless_psd_m2s3: float = 0.2,
        restless_course_psd_rad2s: float = 0.08,
        turning_psd_m2s3: float = 3.0,
        turning_course_psd_rad2s: float = 0.05,
        turn_rate_psd_rad2s3: float = 0.0003,
        prior_turn_rate_std_rad_s: float = 0.2,
        cruising_probability: float = 0.95,
        cruising_sojourn_s: float = 1500.0,
        settling_s: float = 600.0,
        steady_sojourn_s: float = 300.0,
        restless_sojourn_s: float = 100.0,
        turning_sojourn_s: float = 80.0,
    ) -> None: ...
    def as_dict(self) -> dict[str, float | int | str]:
        """
        The settings by name.
        """
    cruising_course_psd_rad2s: float
    cruising_probability: float
    cruising_psd_m2s3: float
    cruising_sojourn_s: float
    prior_turn_rate_std_rad_s: float
    restless_course_psd_rad2s: float
    restless_psd_m2s3: float
    restless_sojourn_s: float
    settling_s: float
    steady_course_psd_rad2s: float
    steady_psd_m2s3: float
    steady_sojourn_s: float
    turn_rate_psd_rad2s3: float
    turning_course_psd_rad2s: float
    turning_psd_m2s3: float
    turning_sojourn_s: float

class Event:
    """
    Something that became of a track in a scan.
    """
    def __getstate__(self) -> tuple[int, int, int, float]: ...
    def __setstate__(self, arg0: tuple) -> None: ...
    @property
    def kind(self) -> str:
        """
        started, confirmed, coasting or lost
        """
    @property
    def tentative_id(self) -> int:
        """
        the negative number it had before it was confirmed; 0 for a designated track
        """
    @property
    def time_s(self) -> float: ...
    @property
    def track_id(self) -> int: ...

class ScanReport:
    """
    What a scan has brought.
    """
    def __getstate__(self) -> tuple[NDArray[np.int64], list[Event], int]: ...
    def __setstate__(self, arg0: tuple) -> None: ...
    @property
    def events(self) -> list[Event]: ...
    @property
    def plot_track_id(self) -> NDArray[np.int64]:
        """
        (n,) the track each plot most likely belongs to; negative for a tentative one, 0 for none
        """
    @property
    def refused_plots(self) -> int:
        """
        plots not finite, behind the antenna, of so many turns that the bearing is lost, of another time than the scan, or beyond max_plots
        """

class TrackTable:
    """
    Tracks as arrays, older ones first.
    """
    def __getstate__(
        self,
    ) -> tuple[
        NDArray[np.int64],
        list[str],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        typing.Any,
        NDArray[np.int64],
        NDArray[np.int64],
        list[str],
    ]: ...
    def __len__(self) -> int: ...
    def __setstate__(self, arg0: tuple) -> None: ...
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (k, 4, 4)
        """
    @property
    def existence(self) -> NDArray[np.float64]:
        """
        (k,)
        """
    @property
    def hits(self) -> NDArray[np.int64]:
        """
        (k,)
        """
    @property
    def mean(self) -> NDArray[np.float64]:
        """
        (k, 4) [x, vx, y, vy]
        """
    @property
    def misses(self) -> NDArray[np.int64]:
        """
        (k,) scans in a row without a plot
        """
    @property
    def mode_probability(self) -> NDArray[np.float64]:
        """
        (k, K)
        """
    @property
    def name(self) -> list[str]:
        """
        given by the operator
        """
    @property
    def nis(self) -> NDArray[np.float64]:
        """
        (k,) of the likeliest plot; NaN where there was none
        """
    @property
    def status(self) -> list[str]:
        """
        tentative, confirmed, coasting or held
        """
    @property
    def time_s(self) -> NDArray[np.float64]:
        """
        (k,) of the belief
        """
    @property
    def track_id(self) -> NDArray[np.int64]:
        """
        (k,)
        """
    @property
    def turn_rate_rad_s(self) -> NDArray[np.float64] | None:
        """
        (k, K) of each model, positive to starboard, NaN for one at rest; None where models do not change theirs
        """
    @property
    def visibility(self) -> NDArray[np.float64]:
        """
        (k,)
        """

class Tracker:
    """
    Keeps tracks of all vessels a radar sees, scan by scan.

    Use it from one thread at a time; trackers share nothing.

    Parameters
    ----------
    radar : Radar
    config : TrackerConfig, optional
    models : VesselModels, optional
        Motion models of the estimator.
    estimator : Imm, AdaptiveGridImm, SwitchingGridImm, LikelyModelSetImm, ModeHistory, FuzzyAlphaBeta or BayesianAlphaBeta, optional
        Another estimator in place of that made of `models`.

    Raises
    ------
    ValueError
        When a setting makes no sense.
    """
    def __init__(
        self,
        radar: Radar,
        config: TrackerConfig = ...,
        models: VesselModels = ...,
        estimator: Imm
        | AdaptiveGridImm
        | SwitchingGridImm
        | LikelyModelSetImm
        | ModeHistory
        | FuzzyAlphaBeta
        | BayesianAlphaBeta
        | None = None,
    ) -> None: ...
    def designate(
        self, time_s: float, north_m: float, east_m: float, position_std_m: float = 50.0
    ) -> int:
        """
        The operator says that there is a target.

        Parameters
        ----------
        time_s : float
            At most an hour after the last scan; scans go on without plots, too.
        north_m, east_m, position_std_m : float

        Returns
        -------
        int
            The track's number, or 0 when there is no room.

        Raises
        ------
        ValueError
            When the time is too far ahead, a number is not finite or the error not above zero.
        """
    def drop(self, track_id: int) -> bool:
        """
        Ends a track; False when there is none of that number.
        """
    def process(
        self,
        time_s: float,
        *,
        range_m: ArrayLike,
        bearing_rad: ArrayLike,
        plot_time_s: ArrayLike | None = None,
        own_north_m: ArrayLike = 0.0,
        own_east_m: ArrayLike = 0.0,
        heading_std_rad: float = 0.0,
        own_position_std_m: float = 0.0,
    ) -> ScanReport:
        """
        Takes in the plots of one scan.

        Parameters
        ----------
        time_s : float
            Time of the scan; not before the last one.
        range_m, bearing_rad : (n,) arrays
        plot_time_s, own_north_m, own_east_m : float or (n,) arrays
            When each plot was seen, and from where.
        heading_std_rad : float
            Error of own ship's heading.
        own_position_std_m : float
            Error of own ship's position, per axis.

        Returns
        -------
        ScanReport

        Raises
        ------
        ValueError
            When a shape does not fit or an error is below zero.
        FilterError
            When time runs backwards or is not finite; nothing changed.
        """
    def rename(self, track_id: int, name: str) -> bool:
        """
        Names a track (31 bytes at most are kept); False when there is none of that number.
        """
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved tracker was.
        """
    def save(self) -> bytes:
        """
        The whole state as bytes, for a tracker with the same settings on the same kind of machine.
        """
    def tracks(self, time_s: float | None = None, tentative: bool = False) -> TrackTable:
        """
        The confirmed and coasting tracks (with `tentative` all), a TrackTable: as of the last scan, or predicted to `time_s` where that is later.
        """
    @property
    def config(self) -> TrackerConfig: ...
    @property
    def radar(self) -> Radar: ...

def vessel_imm(radar: Radar, models: VesselModels = ...) -> Imm:
    """
    The estimator that a tracker uses for this radar unless told otherwise.
    """
