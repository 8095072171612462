"""
The life of tracks.
"""
from collections.abc import Sequence
import typing
import numpy as np
from numpy.typing import ArrayLike, NDArray
from ..recording.video import RadarVideo
from .core import Gaussian, Status
from .measurement import OwnShip
from .video import VideoPlots
from .multimodel import AdaptiveGridImm, BayesianAlphaBeta, FuzzyAlphaBeta, Imm, LikelyModelSetImm, ModeHistory, SwitchingGridImm
__all__: list = ['Radar', 'TrackerConfig', 'VesselModels', 'vessel_imm', 'Event', 'ScanReport', 'ReportResult', 'TrackTable', 'Tracker', 'LateWindow', 'StrobeTrackerConfig', 'StrobeReadings', 'StrobeTrackTable', 'StrobeTracker', 'CalibrationConfig', 'CalibratedOffset', 'CalibrationResult', 'Calibration']
class Radar:
    """
    What a console knows of its radar and of the vessels it looks at.
    
    Parameters
    ----------
    range_std_m : float, default 10.0
        Standard deviation of the range of a plot. In m, 0.001 to 100000.
    bearing_std_rad : float, default 0.0174533
        Standard deviation of the bearing of a plot. In rad, 1e-9 to pi, in radians.
    extent_std_m : float, default 5.0
        Standard deviation of an echo's position on the hull, per axis. In m, 0 to 10000.
    period_s : float, default 3.0
        Antenna revolution. In s, 0.01 to 3600.
    max_speed_mps : float, default 30.0
        Speed limit of the vessels: no faster track starts, and a confirmed one is lost above it by three standard deviations of its speed. In m/s, 0.1 to 10000.
    bearing_offset_rad : float, default 0.0
        Measured minus true bearing; subtracted from every plot. In rad, -10 to 10.
    range_offset_m : float, default 0.0
        Measured minus true range; subtracted from every plot. In m, -100000 to 100000.
    time_offset_s : float, default 0.0
        Clock of the radar minus true time; subtracted from the times of scans and plots. In s, -3600 to 3600.
    min_range_m : float, default 0.0
        Range from which the radar sees targets; a track nearer than that has no misses. In m, 0 to 1e6.
    max_range_m : float, default 0.0
        Range up to which the radar sees targets, as a track beyond it has no misses; 0: the radar sees any. In m, 0 to 1e6.
    blind_from_rad : float, default 0.0
        From this bearing clockwise to `blind_to_rad`, as the radar measures it, targets are hidden by a mast or by land, and a track there has no misses. In rad, -10 to 10.
    blind_to_rad : float, default 0.0
        End of the blind sector; equal to `blind_from_rad`: there is none. In rad, -10 to 10.
    """
    __hash__: typing.ClassVar[None]  # type: ignore[assignment]
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> Radar:
        ...
    def __deepcopy__(self, memo: dict) -> Radar:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __init__(self, *, range_std_m: float = 10.0, bearing_std_rad: float = 0.017453292519943295, extent_std_m: float = 5.0, period_s: float = 3.0, max_speed_mps: float = 30.0, bearing_offset_rad: float = 0.0, range_offset_m: float = 0.0, time_offset_s: float = 0.0, min_range_m: float = 0.0, max_range_m: float = 0.0, blind_from_rad: float = 0.0, blind_to_rad: float = 0.0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    def position(self, range_m: float, bearing_rad: float, own: OwnShip = ...) -> Gaussian:
        """
        A plot from own ship as a position [north, east] with its covariance.
        """
    bearing_offset_rad: float
    """
    Measured minus true bearing; subtracted from every plot. In rad, -10 to 10. Default 0.0.
    """
    bearing_std_rad: float
    """
    Standard deviation of the bearing of a plot. In rad, 1e-9 to pi, in radians. Default 0.0174533.
    """
    blind_from_rad: float
    """
    From this bearing clockwise to `blind_to_rad`, as the radar measures it, targets are hidden by a mast or by land, and a track there has no misses. In rad, -10 to 10. Default 0.0.
    """
    blind_to_rad: float
    """
    End of the blind sector; equal to `blind_from_rad`: there is none. In rad, -10 to 10. Default 0.0.
    """
    extent_std_m: float
    """
    Standard deviation of an echo's position on the hull, per axis. In m, 0 to 10000. Default 5.0.
    """
    max_range_m: float
    """
    Range up to which the radar sees targets, as a track beyond it has no misses; 0: the radar sees any. In m, 0 to 1e6. Default 0.0.
    """
    max_speed_mps: float
    """
    Speed limit of the vessels: no faster track starts, and a confirmed one is lost above it by three standard deviations of its speed. In m/s, 0.1 to 10000. Default 30.0.
    """
    min_range_m: float
    """
    Range from which the radar sees targets; a track nearer than that has no misses. In m, 0 to 1e6. Default 0.0.
    """
    period_s: float
    """
    Antenna revolution. In s, 0.01 to 3600. Default 3.0.
    """
    range_offset_m: float
    """
    Measured minus true range; subtracted from every plot. In m, -100000 to 100000. Default 0.0.
    """
    range_std_m: float
    """
    Standard deviation of the range of a plot. In m, 0.001 to 100000. Default 10.0.
    """
    time_offset_s: float
    """
    Clock of the radar minus true time; subtracted from the times of scans and plots. In s, -3600 to 3600. Default 0.0.
    """
class TrackerConfig:
    """
    The rules by which tracks live; one set of defaults for all radars.
    
    Parameters
    ----------
    detection_probability : float, default 0.8
        Probability PD that a visible target gives a plot in a scan, before it is learned. A probability between 0 and 1.
    gate_probability : float, default 0.95
        Probability PG that the plot of a target is in its gate. Above 0 and below 1.
    clutter_density_per_m2 : float, default 1e-07
        False plots per area and scan, at the least; what is more is learned. In 1/m², 1e-15 to 1.
    outlier_probability : float, default 0.11
        Share of plots whose error is an outlier. At least 0 and below 1.
    outlier_scale : float, default 4.0
        Standard deviation of an outlier over that of a usual plot. 1 to 1000.
    clutter_cell_m : float, default 150.0
        Side of a cell of the clutter map; 0: no map. In m, 0, or 1 to 1e6.
    clutter_memory_s : float, default 60.0
        Fading memory of the clutter map. In s, 0.001 s to 1e12 s.
    clutter_weight : float, default 1.0
        Weight of the clutter map; 1: its density counts in full. 0 to 1000.
    visible_time_s : float, default 60.0
        Mean time until a target is hidden from the radar; 0: never. In s, 0, or 0.001 s to 1e12 s.
    hidden_time_s : float, default 40.0
        Mean time until a hidden target is visible again. In s, 0.001 s to 1e12 s.
    association : str, default 'probabilistic'
        Association of plots with tracks: 'probabilistic' weighs every plot in the gate (PDA) less what other tracks claim of it, 'global_nearest' gives each track one plot by the best total (GNN), 'nearest' by the best pair first.
    birth_density_per_m2 : float, default 3e-10
        New targets per area and scan; 0: none but designated ones. In 1/m², 0 to 1.
    free_plot : float, default 0.8
        A plot starts a track when it belongs to no other with this probability. A probability between 0 and 1.
    start_gate_sigma : float, default 3.0
        Plot errors by which the speed limit of a start is widened. In sigma, 0 to 1000.
    start_speed_factor : float, default 0.5
        Prior speed of a start over the speed limit of the radar; 0: the speed of two plots is taken as it is. 0 to 1000.
    confirm_existence : float, default 0.995
        A track is confirmed above this probability of existence, with `confirm_hits` of its last `confirm_window` scans. A probability between 0 and 1.
    confirm_hits : int, default 3
        Plots that a track needs to be confirmed. In plots, 1 to 32.
    confirm_window : int, default 5
        Last scans in which these plots are counted; `confirm_hits` or more. In scans, 1 to 32.
    survival_time_s : float, default 1000.0
        Mean time until a target leaves. In s, 0.001 s to 1e12 s.
    drop_existence : float, default 0.005
        A tentative track below this probability of existence, and below a third of that of its start, is dropped. A probability between 0 and 1.
    tentative_misses : int, default 6
        A tentative track is dropped after more misses in a row. In scans, 0 to 1e6.
    coast_scans : float, default 5.0
        A confirmed track is dropped after more misses in a row than this and `coast_scans_per_hit` together. In scans, 0 to 1e6.
    coast_scans_per_hit : float, default 0.3
        Further misses allowed for each plot that the track has had. In scans, 0 to 1e6.
    coast_scans_max : int, default 15
        Upper limit of the misses in a row of a confirmed track. In scans, 0 to 1e6.
    shown_probability : float, default 0.003
        A coasting track is held without being shown when a target that is there has so many misses in a row with less than this probability. A probability between 0 and 1.
    drop_position_std_m : float, default 100.0
        A track with a larger standard deviation of its position is dropped; the limit is raised to two plot errors and, for a confirmed track, to what a vessel runs in `coast_scans`. In m, 0.1 to 1e9.
    drop_speed_factor : float, default 1.0
        Factor on the speed limit of the radar, above which a tentative track is dropped, and a confirmed one by three standard deviations of its speed. 0.1 to 1e6.
    duplicate_distance : float, default 0.5
        Two tracks nearer than this, in squared sigmas of their difference, are one. In sigma², 0 to 1e6.
    vessel_length_m : float, default 0.0
        A track nearer than this to a shown one, at the same velocity, is another echo of its vessel; 0: each vessel has one echo. In m, 0 to 10000.
    duplicate_scans : int, default 3
        Scans for which two tracks must be so near before one is removed. In scans, 1 to 1e6.
    max_tracks : int, default 500
        Room for tracks; when full, a new track replaces the weakest tentative one or is not started. In tracks, 1 to 100000.
    max_plots : int, default 20000
        Room for the plots of a scan; those beyond it are rejected. In plots, 1 to 1e6.
    """
    __hash__: typing.ClassVar[None]  # type: ignore[assignment]
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> TrackerConfig:
        ...
    def __deepcopy__(self, memo: dict) -> TrackerConfig:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __init__(self, *, detection_probability: float = 0.8, gate_probability: float = 0.95, clutter_density_per_m2: float = 1e-07, outlier_probability: float = 0.11, outlier_scale: float = 4.0, clutter_cell_m: float = 150.0, clutter_memory_s: float = 60.0, clutter_weight: float = 1.0, visible_time_s: float = 60.0, hidden_time_s: float = 40.0, association: str = 'probabilistic', birth_density_per_m2: float = 3e-10, free_plot: float = 0.8, start_gate_sigma: float = 3.0, start_speed_factor: float = 0.5, confirm_existence: float = 0.995, confirm_hits: int = 3, confirm_window: int = 5, survival_time_s: float = 1000.0, drop_existence: float = 0.005, tentative_misses: int = 6, coast_scans: float = 5.0, coast_scans_per_hit: float = 0.3, coast_scans_max: int = 15, shown_probability: float = 0.003, drop_position_std_m: float = 100.0, drop_speed_factor: float = 1.0, duplicate_distance: float = 0.5, vessel_length_m: float = 0.0, duplicate_scans: int = 3, max_tracks: int = 500, max_plots: int = 20000) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    association: str
    """
    Association of plots with tracks: 'probabilistic' weighs every plot in the gate (PDA) less what other tracks claim of it, 'global_nearest' gives each track one plot by the best total (GNN), 'nearest' by the best pair first. Default 'probabilistic'.
    """
    birth_density_per_m2: float
    """
    New targets per area and scan; 0: none but designated ones. In 1/m², 0 to 1. Default 3e-10.
    """
    clutter_cell_m: float
    """
    Side of a cell of the clutter map; 0: no map. In m, 0, or 1 to 1e6. Default 150.0.
    """
    clutter_density_per_m2: float
    """
    False plots per area and scan, at the least; what is more is learned. In 1/m², 1e-15 to 1. Default 1e-07.
    """
    clutter_memory_s: float
    """
    Fading memory of the clutter map. In s, 0.001 s to 1e12 s. Default 60.0.
    """
    clutter_weight: float
    """
    Weight of the clutter map; 1: its density counts in full. 0 to 1000. Default 1.0.
    """
    coast_scans: float
    """
    A confirmed track is dropped after more misses in a row than this and `coast_scans_per_hit` together. In scans, 0 to 1e6. Default 5.0.
    """
    coast_scans_max: int
    """
    Upper limit of the misses in a row of a confirmed track. In scans, 0 to 1e6. Default 15.
    """
    coast_scans_per_hit: float
    """
    Further misses allowed for each plot that the track has had. In scans, 0 to 1e6. Default 0.3.
    """
    confirm_existence: float
    """
    A track is confirmed above this probability of existence, with `confirm_hits` of its last `confirm_window` scans. A probability between 0 and 1. Default 0.995.
    """
    confirm_hits: int
    """
    Plots that a track needs to be confirmed. In plots, 1 to 32. Default 3.
    """
    confirm_window: int
    """
    Last scans in which these plots are counted; `confirm_hits` or more. In scans, 1 to 32. Default 5.
    """
    detection_probability: float
    """
    Probability PD that a visible target gives a plot in a scan, before it is learned. A probability between 0 and 1. Default 0.8.
    """
    drop_existence: float
    """
    A tentative track below this probability of existence, and below a third of that of its start, is dropped. A probability between 0 and 1. Default 0.005.
    """
    drop_position_std_m: float
    """
    A track with a larger standard deviation of its position is dropped; the limit is raised to two plot errors and, for a confirmed track, to what a vessel runs in `coast_scans`. In m, 0.1 to 1e9. Default 100.0.
    """
    drop_speed_factor: float
    """
    Factor on the speed limit of the radar, above which a tentative track is dropped, and a confirmed one by three standard deviations of its speed. 0.1 to 1e6. Default 1.0.
    """
    duplicate_distance: float
    """
    Two tracks nearer than this, in squared sigmas of their difference, are one. In sigma², 0 to 1e6. Default 0.5.
    """
    duplicate_scans: int
    """
    Scans for which two tracks must be so near before one is removed. In scans, 1 to 1e6. Default 3.
    """
    free_plot: float
    """
    A plot starts a track when it belongs to no other with this probability. A probability between 0 and 1. Default 0.8.
    """
    gate_probability: float
    """
    Probability PG that the plot of a target is in its gate. Above 0 and below 1. Default 0.95.
    """
    hidden_time_s: float
    """
    Mean time until a hidden target is visible again. In s, 0.001 s to 1e12 s. Default 40.0.
    """
    max_plots: int
    """
    Room for the plots of a scan; those beyond it are rejected. In plots, 1 to 1e6. Default 20000.
    """
    max_tracks: int
    """
    Room for tracks; when full, a new track replaces the weakest tentative one or is not started. In tracks, 1 to 100000. Default 500.
    """
    outlier_probability: float
    """
    Share of plots whose error is an outlier. At least 0 and below 1. Default 0.11.
    """
    outlier_scale: float
    """
    Standard deviation of an outlier over that of a usual plot. 1 to 1000. Default 4.0.
    """
    shown_probability: float
    """
    A coasting track is held without being shown when a target that is there has so many misses in a row with less than this probability. A probability between 0 and 1. Default 0.003.
    """
    start_gate_sigma: float
    """
    Plot errors by which the speed limit of a start is widened. In sigma, 0 to 1000. Default 3.0.
    """
    start_speed_factor: float
    """
    Prior speed of a start over the speed limit of the radar; 0: the speed of two plots is taken as it is. 0 to 1000. Default 0.5.
    """
    survival_time_s: float
    """
    Mean time until a target leaves. In s, 0.001 s to 1e12 s. Default 1000.0.
    """
    tentative_misses: int
    """
    A tentative track is dropped after more misses in a row. In scans, 0 to 1e6. Default 6.
    """
    vessel_length_m: float
    """
    A track nearer than this to a shown one, at the same velocity, is another echo of its vessel; 0: each vessel has one echo. In m, 0 to 10000. Default 0.0.
    """
    visible_time_s: float
    """
    Mean time until a target is hidden from the radar; 0: never. In s, 0, or 0.001 s to 1e12 s. Default 60.0.
    """
class VesselModels:
    """
    The motion models of a tracker: cruising, steady, restless and turning.
    
    Parameters
    ----------
    cruising_psd_m2s3 : float, default 0.0001
        Acceleration noise of a cruising vessel at rest. In m²/s³, 0 to 10000.
    cruising_course_psd_rad2s : float, default 1e-06
        Course noise of a cruising vessel. In rad²/s, 0 to 100.
    steady_psd_m2s3 : float, default 0.005
        Acceleration noise of a steady vessel at rest. In m²/s³, 0 to 10000.
    steady_course_psd_rad2s : float, default 0.004
        Course noise of a steady vessel. In rad²/s, 0 to 100.
    restless_psd_m2s3 : float, default 0.2
        Acceleration noise of a restless vessel at rest. In m²/s³, 0 to 10000.
    restless_course_psd_rad2s : float, default 0.08
        Course noise of a restless vessel. In rad²/s, 0 to 100.
    turning_psd_m2s3 : float, default 3.0
        Acceleration noise of a turning vessel at rest. In m²/s³, 0 to 10000.
    turning_course_psd_rad2s : float, default 0.05
        Course noise of a turning vessel. In rad²/s, 0 to 100.
    turn_rate_psd_rad2s3 : float, default 0.0003
        Noise of the turn rate of a turning vessel. In rad²/s³, 0, or 1e-9 to 100.
    prior_turn_rate_std_rad_s : float, default 0.2
        Standard deviation of the turn rate before it is known and in the long run. In rad/s, 1e-6 to 10.
    cruising_probability : float, default 0.95
        Probability that a new vessel is cruising. A probability between 0 and 1.
    cruising_sojourn_s : float, default 1500.0
        Mean time until a cruising vessel does something else. In s, 0.001 s to 1e12 s.
    settling_s : float, default 600.0
        Mean time until a steady vessel is taken to cruise. In s, 0.001 s to 1e12 s.
    steady_sojourn_s : float, default 300.0
        Mean time until a steady vessel becomes restless or turns. In s, 0.001 s to 1e12 s.
    restless_sojourn_s : float, default 100.0
        Mean time for which a vessel is restless. In s, 0.001 s to 1e12 s.
    turning_sojourn_s : float, default 80.0
        Mean time for which a vessel turns. In s, 0.001 s to 1e12 s.
    """
    __hash__: typing.ClassVar[None]  # type: ignore[assignment]
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    @staticmethod
    def ships() -> VesselModels:
        """
        Models of merchant ships under way.
        """
    def __copy__(self) -> VesselModels:
        ...
    def __deepcopy__(self, memo: dict) -> VesselModels:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __init__(self, *, cruising_psd_m2s3: float = 0.0001, cruising_course_psd_rad2s: float = 1e-06, steady_psd_m2s3: float = 0.005, steady_course_psd_rad2s: float = 0.004, restless_psd_m2s3: float = 0.2, restless_course_psd_rad2s: float = 0.08, turning_psd_m2s3: float = 3.0, turning_course_psd_rad2s: float = 0.05, turn_rate_psd_rad2s3: float = 0.0003, prior_turn_rate_std_rad_s: float = 0.2, cruising_probability: float = 0.95, cruising_sojourn_s: float = 1500.0, settling_s: float = 600.0, steady_sojourn_s: float = 300.0, restless_sojourn_s: float = 100.0, turning_sojourn_s: float = 80.0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    cruising_course_psd_rad2s: float
    """
    Course noise of a cruising vessel. In rad²/s, 0 to 100. Default 1e-06.
    """
    cruising_probability: float
    """
    Probability that a new vessel is cruising. A probability between 0 and 1. Default 0.95.
    """
    cruising_psd_m2s3: float
    """
    Acceleration noise of a cruising vessel at rest. In m²/s³, 0 to 10000. Default 0.0001.
    """
    cruising_sojourn_s: float
    """
    Mean time until a cruising vessel does something else. In s, 0.001 s to 1e12 s. Default 1500.0.
    """
    prior_turn_rate_std_rad_s: float
    """
    Standard deviation of the turn rate before it is known and in the long run. In rad/s, 1e-6 to 10. Default 0.2.
    """
    restless_course_psd_rad2s: float
    """
    Course noise of a restless vessel. In rad²/s, 0 to 100. Default 0.08.
    """
    restless_psd_m2s3: float
    """
    Acceleration noise of a restless vessel at rest. In m²/s³, 0 to 10000. Default 0.2.
    """
    restless_sojourn_s: float
    """
    Mean time for which a vessel is restless. In s, 0.001 s to 1e12 s. Default 100.0.
    """
    settling_s: float
    """
    Mean time until a steady vessel is taken to cruise. In s, 0.001 s to 1e12 s. Default 600.0.
    """
    steady_course_psd_rad2s: float
    """
    Course noise of a steady vessel. In rad²/s, 0 to 100. Default 0.004.
    """
    steady_psd_m2s3: float
    """
    Acceleration noise of a steady vessel at rest. In m²/s³, 0 to 10000. Default 0.005.
    """
    steady_sojourn_s: float
    """
    Mean time until a steady vessel becomes restless or turns. In s, 0.001 s to 1e12 s. Default 300.0.
    """
    turn_rate_psd_rad2s3: float
    """
    Noise of the turn rate of a turning vessel. In rad²/s³, 0, or 1e-9 to 100. Default 0.0003.
    """
    turning_course_psd_rad2s: float
    """
    Course noise of a turning vessel. In rad²/s, 0 to 100. Default 0.05.
    """
    turning_psd_m2s3: float
    """
    Acceleration noise of a turning vessel at rest. In m²/s³, 0 to 10000. Default 3.0.
    """
    turning_sojourn_s: float
    """
    Mean time for which a vessel turns. In s, 0.001 s to 1e12 s. Default 80.0.
    """
class Event:
    """
    A change of a track's status in a scan.
    """
    def __getstate__(self) -> tuple[int, int, int, float, int, str]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    @property
    def identity(self) -> str:
        """
        of the vessel that reports, in the events of one; else empty
        """
    @property
    def kind(self) -> str:
        """
        started, confirmed, coasting or lost; full where max_tracks is reached, again only when there has been room in between; identified or identity_lost where a track is believed to be of a vessel that reports, or no longer; identity_disagrees where a report of it is far from its track, identity_jumps where it is farther from the one before than a vessel runs, identity_shared where two vessels report from one track
        """
    @property
    def reason(self) -> str:
        """
        why a track was lost: missed (without a plot for too long), doubtful (a tentative track whose target hardly exists), too_fast (above the speed limit), uncertain (its position is not known well enough), duplicate (a senior track follows the same target), displaced (a tentative track that made room), failed (the estimator cannot follow the measurements) or corrected (with late data there is no such track); empty for other events
        """
    @property
    def tentative_id(self) -> int:
        """
        the negative number before confirmation; 0 for a designated track
        """
    @property
    def time_s(self) -> float:
        ...
    @property
    def track_id(self) -> int:
        """
        0 of full
        """
class ScanReport:
    """
    Result of processing a scan.
    """
    def __getstate__(self) -> tuple[NDArray[np.int64], list[Event], int]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    @property
    def events(self) -> list[Event]:
        ...
    @property
    def plot_track_id(self) -> NDArray[np.int64]:
        """
        (n,) the track that each plot most likely belongs to; negative for a tentative one, 0 for none
        """
    @property
    def rejected_plots(self) -> int:
        """
        plots that are not finite or out of range, have a negative range, a bearing too large to be an angle or a time far from the scan's, or exceed max_plots
        """
class ReportResult:
    """
    Result of a vessel's report.
    """
    def __getstate__(self) -> tuple[Status, int, list[Event]]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    @property
    def events(self) -> list[Event]:
        ...
    @property
    def status(self) -> Status:
        """
        ok where it has updated or started a track; gated where it has not; negative_time_step or not_finite where its time is not of now
        """
    @property
    def track_id(self) -> int:
        """
        of the track that its vessel is believed to be; 0 without one
        """
class TrackTable:
    """
    Tracks as arrays, older ones first.
    """
    def __getstate__(self) -> tuple[NDArray[np.int64], list[str], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], typing.Any, NDArray[np.int64], NDArray[np.int64], list[str], list[str], NDArray[np.float64], NDArray[np.float64]]:
        ...
    def __len__(self) -> int:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
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
    def identity(self) -> list[str]:
        """
        of the vessel that reports and that the track is believed to be; else empty
        """
    @property
    def identity_probability(self) -> NDArray[np.float64]:
        """
        (k,) how probable that is; 0 without an identity
        """
    @property
    def identity_time_s(self) -> NDArray[np.float64]:
        """
        (k,) of the vessel's last report; NaN without an identity
        """
    @property
    def mean(self) -> NDArray[np.float64]:
        """
        (k, 4) [x, vx, y, vy]
        """
    @property
    def misses(self) -> NDArray[np.int64]:
        """
        (k,) consecutive scans without a plot
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
        (k,) of the likeliest plot; NaN without one
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
        (k, K) of each model, positive to starboard, NaN for an inactive one; None if models do not change theirs
        """
    @property
    def visibility(self) -> NDArray[np.float64]:
        """
        (k,)
        """
class Tracker:
    """
    Tracks all vessels in the plots of one or several radars, turn by turn or sector by sector.
    
    Calls from several threads are made one after the other; trackers share nothing.
    
    Parameters
    ----------
    radar : Radar or list of Radar
        The radars, numbered from 0; None in the list: a number without a radar. A track is updated by
        every radar that covers it, and a miss counts only where no other radar has seen it.
    config : TrackerConfig, optional
    models : VesselModels, optional
        Motion models of the estimator.
    estimator : Imm, AdaptiveGridImm, SwitchingGridImm, LikelyModelSetImm, ModeHistory, FuzzyAlphaBeta or BayesianAlphaBeta, optional
        Estimator to use instead of the one made from `models`.
    
    Raises
    ------
    ValueError
        When a setting is invalid.
    """
    def __init__(self, radar: Radar | Sequence[Radar | None], config: TrackerConfig = ..., models: VesselModels = ..., estimator: Imm | AdaptiveGridImm | SwitchingGridImm | LikelyModelSetImm | ModeHistory | FuzzyAlphaBeta | BayesianAlphaBeta | None = None) -> None:
        ...
    def add_radar(self, radar: Radar) -> int:
        """
        Add a radar and return its number, the least that is free.
        """
    def bearings(self, *, time_s: float, bearing_rad: ArrayLike, bearing_std_rad: float, sensor: int = 0, false_per_rad: float = 1.0, own: OwnShip = ...) -> ScanReport:
        """
        Take bearings of targets without their ranges, as of a camera.
        
        They update the confirmed tracks, start none, and tell of no misses. Bearings between several tracks
        are shared by their likelihoods, and which tracks the sensor sees is learned. Errors of such a sensor
        stay for a while: bearings that come faster than the antenna turns count as much as one a turn.
        
        Parameters
        ----------
        time_s : float
            Of all bearings, at most 120 s from the last scan.
        bearing_rad : (n,) array
            From north, of targets in any order, with false ones among them.
        bearing_std_rad : float
        sensor : int
            Number of the sensor, from 0 to 3.
        false_per_rad : float
            Mean of the false bearings in a radian.
        own : OwnShip
            Of the sensor.
        
        Returns
        -------
        ScanReport
            The track that each most probably belongs to.
        
        Raises
        ------
        ValueError
            When a shape does not fit, or a number is out of range.
        FilterError
            When the time is farther from the last scan; the tracker is unchanged.
        """
    def designate(self, time_s: float, north_m: float, east_m: float, position_std_m: float = 50.0, *, vnorth_mps: float | None = None, veast_mps: float | None = None, velocity_std_mps: float = 2.0) -> int:
        """
        Confirm the track at a position, or start a confirmed one, on an operator's designation.
        
        Of several tracks whose gate the position is in, the nearest is confirmed, in standard deviations; a
        hushed one is shown again. A new track begins at rest, or with the velocity given.
        
        Parameters
        ----------
        time_s : float
            At most `latest_time_s`, an hour after the last scan.
        north_m, east_m, position_std_m : float
        vnorth_mps, veast_mps, velocity_std_mps : float, optional
            Both components of the velocity, and their standard deviation, per axis.
        
        Returns
        -------
        int
            The track's number, or 0 if there is no room.
        
        Raises
        ------
        ValueError
            When the time is too far ahead, a number is not finite or beyond 1e9, or the standard deviation
            not positive.
        """
    def drop(self, track_id: int, *, hush: bool = False) -> bool:
        """
        End a track; False if no track has that number.
        
        With `hush` its vessel is followed in silence, so that it does not start again under another number:
        the track is not in `tracks`, has no events and no plots reported, until its vessel is lost, it is
        designated or dropped again.
        """
    def find(self, identity: str, *, source: str = 'ais') -> int:
        """
        The number of the track that a vessel which reports is believed to be; 0 without one.
        """
    def merge(self, track_id: int, other_id: int) -> bool:
        """
        Say that two tracks are of one vessel; False if there are no two of these numbers.
        
        The second is ended, and the first takes its name if it has none.
        """
    def process(self, time_s: float, *, range_m: ArrayLike, bearing_rad: ArrayLike, plot_time_s: ArrayLike | None = None, own_north_m: ArrayLike = 0.0, own_east_m: ArrayLike = 0.0, heading_std_rad: float = 0.0, own_position_std_m: float = 0.0, covariance: ArrayLike | None = None) -> ScanReport:
        """
        Process the plots of one scan, a whole turn of the antenna of radar 0.
        
        Parameters
        ----------
        time_s : float
            Time of the scan; not before the last one nor after `latest_time_s`.
        range_m, bearing_rad : (n,) arrays
        plot_time_s, own_north_m, own_east_m : float or (n,) arrays
            Time of each plot, and own ship's position at that time.
        heading_std_rad : float
            Standard deviation of own ship's heading.
        own_position_std_m : float
            Standard deviation of own ship's position, per axis.
        covariance : (n, 2, 2) array, optional
            Of range and bearing of each plot, such as that of `VideoPlots`, in place of the radar's errors;
            zero: the radar's.
        
        Returns
        -------
        ScanReport
        
        Raises
        ------
        ValueError
            When a shape does not fit or a standard deviation is negative.
        FilterError
            When the time is not finite, before the last scan or after `latest_time_s`; the tracker is
            unchanged.
        """
    def ranges(self, *, time_s: float, range_m: ArrayLike, range_std_m: float, sensor: int = 0, false_per_m: float = 0.001, own: OwnShip = ...) -> ScanReport:
        """
        Take ranges of targets without their bearings; as `bearings`.
        
        Parameters
        ----------
        time_s : float
        range_m : (n,) array
        range_std_m : float
        sensor : int
        false_per_m : float
            Mean of the false ranges in a metre.
        own : OwnShip
        
        Returns
        -------
        ScanReport
        
        Raises
        ------
        ValueError, FilterError
            As `bearings`.
        """
    def remove_radar(self, radar: int) -> bool:
        """
        Remove a radar and what was learned of it; tracks go on by the others.
        
        False when there is none of that number or it is the last one.
        """
    def rename(self, track_id: int, name: str) -> bool:
        """
        Name a track (at most 31 bytes of UTF-8 are kept); False if no track has that number.
        """
    def report(self, *, time_s: float, identity: str, north_m: float, east_m: float, position_std_m: float = 10.0, vnorth_mps: float | None = None, veast_mps: float | None = None, velocity_std_mps: float = 0.5, source: str = 'ais') -> ReportResult:
        """
        Take the position that a vessel reports of itself, such as by AIS.
        
        It is of the track that its identity is believed to be, which is decided by where the reports of the
        identity are, one after the other, and of a new track where there is none near and the vessel has
        reported before. It updates the track only while they agree, so that an identity that is wrong,
        stolen or old drags no track away; events tell of it. A track that reports is kept while its vessel
        can be silent. A report older than 120 s before the last scan, or not newer than the last one of its
        identity, and one more than 120 s ahead, changes nothing. Estimators other than `Imm` do not take
        the velocity.
        
        Parameters
        ----------
        time_s : float
            Of the position, true time.
        identity : str
            Such as the MMSI; at most 31 bytes of UTF-8.
        north_m, east_m, position_std_m : float
        vnorth_mps, veast_mps : float, optional
        velocity_std_mps : float
            Of the velocity, per axis.
        source : str
            The same identity of two sources is two; at most 15 bytes.
        
        Returns
        -------
        ReportResult
        
        Raises
        ------
        ValueError
            When a number is not finite or out of range, or a text empty or too long.
        """
    def restore(self, state: bytes) -> None:
        """
        Continue bit for bit from the saved tracker.
        """
    def save(self) -> bytes:
        """
        The complete state as bytes, for a tracker with the same settings on the same kind of machine.
        """
    def sector(self, *, radar: int = 0, from_rad: float, to_rad: float, time_s: float, range_m: ArrayLike, bearing_rad: ArrayLike, plot_time_s: ArrayLike | None = None, own: OwnShip = ..., covariance: ArrayLike | None = None) -> ScanReport:
        """
        Process a part of the antenna's turn.
        
        Tracks whose gate the beam has passed are updated or have missed, once a turn; others, and plots that
        may be theirs, wait for the next sector. Where sectors leave a gap, tracks are neither updated nor
        miss; a track that the beam has not passed for two periods coasts by time, a miss a period. Where
        sectors overlap the beam does not go back.
        
        Parameters
        ----------
        radar : int
            Number of the radar.
        from_rad, to_rad : float
            The beam went clockwise from one bearing, as the radar measures it, to the other; a turn apart:
            a whole turn, as `process` takes it. Equal: time passes.
        time_s : float
            At the end of the sector; not before the last one of this radar, nor more than a period before
            that of another one, nor after `latest_time_s`.
        range_m, bearing_rad : (n,) arrays
        plot_time_s : float or (n,) array
            Time of each plot.
        own : OwnShip
            At the end of the sector.
        covariance : (n, 2, 2) array, optional
            Of range and bearing of each plot, as in `process`.
        
        Returns
        -------
        ScanReport
            The track of a plot that waits is 0.
        
        Raises
        ------
        ValueError
            When the radar is not known, the angles are no sector, a shape does not fit or own ship is invalid.
        FilterError
            When the time is not finite, before the last sector or after `latest_time_s`; the tracker is
            unchanged.
        """
    def set_radar(self, number: int, radar: Radar) -> None:
        """
        Change the settings of a radar, such as the errors and the period of another range scale.
        
        All tracks are kept.
        
        Raises
        ------
        ValueError
            When there is no radar of that number.
        """
    def tracks(self, time_s: float | None = None, tentative: bool = False) -> TrackTable:
        """
        The confirmed and coasting tracks (with `tentative` all), at one time.
        
        Parameters
        ----------
        time_s : float, optional
            Default: the time of the last scan; before the first one each track has the time for which it
            was designated. A track is predicted to it, or moved back at constant velocity where its plot
            was later. NaN where it is so far ahead that a prediction fails.
        tentative : bool
            Whether tentative and held tracks are included.
        
        Returns
        -------
        TrackTable
        
        Raises
        ------
        ValueError
            When the time is not finite.
        """
    @property
    def config(self) -> TrackerConfig:
        ...
    @property
    def latest_time_s(self) -> float:
        """
        Until when a scan is processed and a target can be designated: an hour after the last scan, or ever before the first one. After a longer silence of the radar a scan without plots is needed an hour after the last one.
        """
    @property
    def radar(self) -> Radar:
        ...
    @property
    def time_s(self) -> float:
        """
        Time of the last scan; 0 before the first.
        """
class LateWindow(Tracker):
    """
    A tracker whose data may come late: the tracks are, bit for bit, as if all had come in time.
    
    Scans, sectors and what the operator does are put in their place by time: of one time in the order of
    radar and angles, so that the order in which they come does not matter. The calls are those of
    `Tracker`. What comes in time is processed at once. For what comes late the tracker goes back and
    processes again what came since, as soon as the work that came in pays for it: all corrections
    together cost at most 1.75 times what processing in order does. `tracks()` and `correct()` correct the
    picture at once. The events of a correction are the numbers that there are now (confirmed), or are no
    more (lost, for the reason corrected). A number that a track got within the window may become that of
    another one by a correction; older ones stay.
    
    Data from before the window are not processed: all their plots are `rejected_plots` of the report, and
    `too_late_inputs` counts them. All memory is taken by the constructor.
    
    Parameters
    ----------
    radar, config, models, estimator
        As of `Tracker`.
    window_s : float
        What is at most so much older than the newest data is put in its place; 0: two turns of the
        antenna.
    max_inputs, max_plots : int
        Room for the sectors and other inputs of a window, and for their plots; with more in a window the
        window is shorter.
    
    Raises
    ------
    ValueError
        When a setting is invalid.
    """
    def __init__(self, radar: Radar | Sequence[Radar | None], config: TrackerConfig = ..., models: VesselModels = ..., estimator: Imm | AdaptiveGridImm | SwitchingGridImm | LikelyModelSetImm | ModeHistory | FuzzyAlphaBeta | BayesianAlphaBeta | None = None, *, window_s: float = 0.0, max_inputs: int = 4000, max_plots: int = 50000) -> None:
        ...
    def correct(self) -> list[Event]:
        """
        Put all late data in the picture. Returns the events of the correction.
        """
    def drop(self, track_id: int, *, hush: bool = False, time_s: float | None = None) -> bool:
        """
        As `Tracker.drop`, at a time; default: now.
        """
    def merge(self, track_id: int, other_id: int, *, time_s: float | None = None) -> bool:
        """
        As `Tracker.merge`, at a time; default: now.
        """
    def rename(self, track_id: int, name: str, *, time_s: float | None = None) -> bool:
        """
        As `Tracker.rename`, at a time; default: now.
        """
    def save(self) -> bytes:
        """
        The complete state as bytes, with the data of the window; the picture is corrected.
        """
    def tracks(self, time_s: float | None = None, tentative: bool = False, correct: bool = True) -> TrackTable:
        """
        The tracks, as `Tracker.tracks` gives them.
        
        Parameters
        ----------
        time_s : float, optional
        tentative : bool
        correct : bool
            Whether all late data are put in first, at the cost of up to a window of data processed again;
            False: the picture as it is, at no cost.
        
        Returns
        -------
        TrackTable
        
        Raises
        ------
        ValueError
            When the time is not finite.
        """
    @property
    def corrections(self) -> int:
        """
        How often the picture was corrected.
        """
    @property
    def earliest_time_s(self) -> float:
        """
        Data from before are too late.
        """
    @property
    def is_correct(self) -> bool:
        """
        Whether all late data are in the picture.
        """
    @property
    def late_inputs(self) -> int:
        """
        How many came late and were put in their place.
        """
    @property
    def too_late_inputs(self) -> int:
        """
        How many came too late, and were not processed.
        """
    @property
    def window_s(self) -> float:
        ...
class StrobeTrackerConfig:
    """
    The rules by which the tracks of a StrobeTracker live.
    
    Parameters
    ----------
    least_amplitude : int, default 1
        Least amplitude of a cell that counts: above the noise. In counts, 1 to 65535.
    pedestal : int, default 0
        Amplitude subtracted from that of a cell to weigh it; below least_amplitude. In counts, 0 to 65535.
    several : str, default 'nearest'
        Which of several echoes in a strobe is measured.
    least_share : float, default 0.25
        Share of an echo's weight that a strobe must have of an echo shared with rivals. With less of it the echo is the rivals', with all but less of it the strobe's. 0 to 0.5.
    radius_m : float, default 45.0
        Radius of the strobe of a track that is seen in every turn. In m, 1 to 1e6.
    max_radius_m : float, default 150.0
        Largest radius, of a new track or after misses; at least radius_m. In m, 1 to 1e6.
    growth : float, default 1.5
        Factor of the radius after a turn without an echo. 1 to 100.
    shrinkage : float, default 0.6
        Factor of a radius above radius_m after a turn with an echo. Above 0 and at most 1.
    fill_share : float, default 0.9
        Share of the cells of a strobe from which on an echo fills it. Above 0 and at most 1.
    lost_after : int, default 3
        Turns in a row without an echo after which a track is lost. In turns, 1 to 100.
    confirm_hits : int, default 4
        Turns with an echo after which a track acquired from a plot is confirmed; until then the first turn without one ends it. In turns, 1 to 100.
    max_tracks : int, default 1000
        Room for tracks. In tracks, 1 to 100000.
    max_sweep_cells : int, default 4096
        Longer sweeps are rejected. In cells, 1 to 65536.
    max_strobe_sweeps : int, default 1024
        Sweeps that are kept: of a wider strobe the first sweeps are missing. In sweeps, 8 to 65536.
    """
    __hash__: typing.ClassVar[None]  # type: ignore[assignment]
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> StrobeTrackerConfig:
        ...
    def __deepcopy__(self, memo: dict) -> StrobeTrackerConfig:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __init__(self, *, least_amplitude: int = 1, pedestal: int = 0, several: str = 'nearest', least_share: float = 0.25, radius_m: float = 45.0, max_radius_m: float = 150.0, growth: float = 1.5, shrinkage: float = 0.6, fill_share: float = 0.9, lost_after: int = 3, confirm_hits: int = 4, max_tracks: int = 1000, max_sweep_cells: int = 4096, max_strobe_sweeps: int = 1024) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    confirm_hits: int
    """
    Turns with an echo after which a track acquired from a plot is confirmed; until then the first turn without one ends it. In turns, 1 to 100. Default 4.
    """
    fill_share: float
    """
    Share of the cells of a strobe from which on an echo fills it. Above 0 and at most 1. Default 0.9.
    """
    growth: float
    """
    Factor of the radius after a turn without an echo. 1 to 100. Default 1.5.
    """
    least_amplitude: int
    """
    Least amplitude of a cell that counts: above the noise. In counts, 1 to 65535. Default 1.
    """
    least_share: float
    """
    Share of an echo's weight that a strobe must have of an echo shared with rivals. With less of it the echo is the rivals', with all but less of it the strobe's. 0 to 0.5. Default 0.25.
    """
    lost_after: int
    """
    Turns in a row without an echo after which a track is lost. In turns, 1 to 100. Default 3.
    """
    max_radius_m: float
    """
    Largest radius, of a new track or after misses; at least radius_m. In m, 1 to 1e6. Default 150.0.
    """
    max_strobe_sweeps: int
    """
    Sweeps that are kept: of a wider strobe the first sweeps are missing. In sweeps, 8 to 65536. Default 1024.
    """
    max_sweep_cells: int
    """
    Longer sweeps are rejected. In cells, 1 to 65536. Default 4096.
    """
    max_tracks: int
    """
    Room for tracks. In tracks, 1 to 100000. Default 1000.
    """
    pedestal: int
    """
    Amplitude subtracted from that of a cell to weigh it; below least_amplitude. In counts, 0 to 65535. Default 0.
    """
    radius_m: float
    """
    Radius of the strobe of a track that is seen in every turn. In m, 1 to 1e6. Default 45.0.
    """
    several: str
    """
    Which of several echoes in a strobe is measured. Default 'nearest'.
    """
    shrinkage: float
    """
    Factor of a radius above radius_m after a turn with an echo. Above 0 and at most 1. Default 0.6.
    """
class StrobeReadings:
    """
    What was found in the strobes that the beam has passed.
    """
    def __getstate__(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], list[str], NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_], list[Event], int]:
        ...
    def __len__(self) -> int:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    @property
    def bearing_rad(self) -> NDArray[np.float64]:
        """
        (n,) the same
        """
    @property
    def cells(self) -> NDArray[np.int64]:
        """
        (n,) measured
        """
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (n, 2, 2) of range and bearing
        """
    @property
    def cut(self) -> NDArray[np.bool_]:
        """
        (n,) part of the strobe is outside the picture
        """
    @property
    def echoes(self) -> NDArray[np.int64]:
        """
        (n,) separate echoes in the strobe, without those of other strobes
        """
    @property
    def events(self) -> list[Event]:
        """
        list of Event
        """
    @property
    def fills(self) -> NDArray[np.bool_]:
        """
        (n,) the echo fills the strobe
        """
    @property
    def position_m(self) -> NDArray[np.float64]:
        """
        (n, 2) of the centroid, north and east; NaN without an echo
        """
    @property
    def predicted_m(self) -> NDArray[np.float64]:
        """
        (n, 2) center of the strobe, north and east
        """
    @property
    def radius_m(self) -> NDArray[np.float64]:
        """
        (n,) of the strobe
        """
    @property
    def range_m(self) -> NDArray[np.float64]:
        """
        (n,) of the centroid, as the radar measures it; NaN without an echo
        """
    @property
    def rejected_sweeps(self) -> int:
        """
        sweeps that are invalid, too long, repeated or before the last one
        """
    @property
    def shared(self) -> NDArray[np.bool_]:
        """
        (n,) a part of the echo belongs to the strobe of another track
        """
    @property
    def status(self) -> list[str]:
        """
        of the echo, as of `StrobeEcho`
        """
    @property
    def time_s(self) -> NDArray[np.float64]:
        """
        (n,) when the beam passed the echo, or the center without one
        """
    @property
    def touches_edge(self) -> NDArray[np.bool_]:
        """
        (n,) the echo extends beyond the strobe
        """
    @property
    def track_id(self) -> NDArray[np.int64]:
        """
        (n,) negative of a tentative track, positive from its confirmation on
        """
class StrobeTrackTable:
    """
    Tracks with their next strobes, older ones first.
    """
    def __getstate__(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], list[str], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        ...
    def __len__(self) -> int:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (k, 4, 4)
        """
    @property
    def hits(self) -> NDArray[np.int64]:
        """
        (k,) turns with an echo
        """
    @property
    def mean(self) -> NDArray[np.float64]:
        """
        (k, 4) [x, vx, y, vy]
        """
    @property
    def misses(self) -> NDArray[np.int64]:
        """
        (k,) consecutive turns without an echo
        """
    @property
    def mode_probability(self) -> NDArray[np.float64]:
        """
        (k, K)
        """
    @property
    def nis(self) -> NDArray[np.float64]:
        """
        (k,) of the echo; NaN without one
        """
    @property
    def status(self) -> list[str]:
        """
        tentative, confirmed or coasting
        """
    @property
    def strobe_m(self) -> NDArray[np.float64]:
        """
        (k, 2) center of the next strobe, north and east
        """
    @property
    def strobe_radius_m(self) -> NDArray[np.float64]:
        """
        (k,)
        """
    @property
    def strobe_time_s(self) -> NDArray[np.float64]:
        """
        (k,) when the beam will pass its center
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
class StrobeTracker:
    """
    Tracks vessels on radar video, each by a strobe.
    
    A vessel is acquired by the operator (`designate`) or from extracted plots (`acquire`). In each turn
    a strobe is laid on the picture around the predicted position; as soon as the beam has passed it, the
    centroid of the amplitudes inside updates the estimator. `lost_after` turns in a row without an echo
    end the track.
    
    The strobe is a circle of `radius_m`. It grows by `growth` after a turn without an echo, up to
    `max_radius_m`, and shrinks by `shrinkage` after one with an echo. The first strobe of a track is
    larger by the distance at the speed limit until the beam comes. Where strobes overlap, a cell belongs
    to the nearest center: an echo of which a strobe has less than `least_share` of the weight belongs to
    the other strobe, and one of which both have more is shared. A tentative track claims nothing from a
    confirmed one.
    
    Parameters
    ----------
    radar : Radar
    config : StrobeTrackerConfig, optional
    estimator : Imm, AdaptiveGridImm, SwitchingGridImm, LikelyModelSetImm, ModeHistory, FuzzyAlphaBeta or BayesianAlphaBeta, optional
        Default: BayesianAlphaBeta.
    land : LandMask, optional
        Areas whose cells are empty.
    bits : {8, 16}
        Of the amplitudes.
    
    Raises
    ------
    ValueError
        When a setting is invalid.
    
    References
    ----------
    Grinyak, Trofimov, "Multi-model tracking of moving vessels with a fuzzy criterion of maneuver
    detection". Arbitration, radii and acquisition are ours.
    """
    def __init__(self, radar: Radar, config: StrobeTrackerConfig = ..., estimator: Imm | AdaptiveGridImm | SwitchingGridImm | LikelyModelSetImm | ModeHistory | FuzzyAlphaBeta | BayesianAlphaBeta | None = None, *, land: ... | None = None, bits: int = 8) -> None:
        ...
    def __len__(self) -> int:
        ...
    def acquire(self, plots: VideoPlots, *, own_north_m: ArrayLike = 0.0, own_east_m: ArrayLike = 0.0) -> int:
        """
        Start tentative tracks at plots that are neither in a strobe nor in an excluded area.
        
        Parameters
        ----------
        plots : VideoPlots
            Of the sweeps just processed: anything with `time_s`, `range_m` and `bearing_rad`.
        own_north_m, own_east_m : float or (n,) arrays
            Position of the radar at each plot.
        
        Returns
        -------
        int
            Number of tracks started.
        """
    def designate(self, time_s: float, north_m: float, east_m: float, position_std_m: float = 20.0, *, own_north_m: float = 0.0, own_east_m: float = 0.0) -> int:
        """
        Start a confirmed track on an operator's designation.
        
        Parameters
        ----------
        time_s : float
            At most a period after the last sweep.
        north_m, east_m, position_std_m : float
        own_north_m, own_east_m : float
            Position of the radar.
        
        Returns
        -------
        int
            The track's number, or 0 if there is no room or the time is too late.
        
        Raises
        ------
        ValueError
            When a number is not finite or beyond 1e9, or the standard deviation not positive.
        """
    def drop(self, track_id: int) -> bool:
        """
        End a track; False if no track has that number.
        """
    def process(self, video: RadarVideo, *, own_north_m: ArrayLike = 0.0, own_east_m: ArrayLike = 0.0) -> StrobeReadings:
        """
        Process the sweeps of a video, which continue the previous ones.
        
        Parameters
        ----------
        video : RadarVideo
            Any number of sweeps; the antenna turns clockwise.
        own_north_m, own_east_m : float or (N,) arrays
            Position of the radar at each sweep.
        
        Returns
        -------
        StrobeReadings
            The strobes that the beam has passed, in the order of time.
        
        Raises
        ------
        ValueError
            When the amplitudes have other bits than the tracker, or a shape does not fit.
        """
    def restore(self, state: bytes) -> None:
        """
        Continue bit for bit from the saved tracker.
        """
    def save(self) -> bytes:
        """
        The complete state without the excluded areas as bytes, for a tracker with the same settings on the same kind of machine.
        """
    def set_land(self, land: ...) -> None:
        """
        Replace the excluded areas, from the next sweep on.
        """
    def tracks(self, time_s: float | None = None, tentative: bool = False) -> StrobeTrackTable:
        """
        The confirmed and coasting tracks (with `tentative` all), a StrobeTrackTable: each as of when the beam passed it, or at `time_s`: predicted to it, or moved back to it at constant velocity.
        """
    @property
    def config(self) -> StrobeTrackerConfig:
        ...
    @property
    def radar(self) -> Radar:
        ...
class CalibrationConfig:
    """
    Parameters of `Calibration`.
    
    Parameters
    ----------
    range_gate_m : float, default 400.0
        Largest range offset that is looked for. In m, 1 to 100000.
    bearing_gate_rad : float, default 0.139626
        Largest bearing offset that is looked for. In rad, above 0 and at most 3.14159.
    position_offset_std_m : float, default 2.0
        Expected constant offset of a vessel's echo from its reported position, per axis; the offsets measured correct it. In m, 0.01 to 10000.
    max_gap_s : float, default 60.0
        Longest time between two reports of a vessel that is interpolated. In s, 0.01 to 3600.
    max_range_std_m : float, default 3.0
        A range offset is determined up to this standard deviation. In m, 0.001 to 1e6.
    max_bearing_std_rad : float, default 0.00872665
        A bearing offset is determined up to this standard deviation. In rad, above 0 and at most 3.14159.
    max_time_std_s : float, default 0.5
        A time offset is determined up to this standard deviation. In s, 0.001 to 100000.
    min_matches : int, default 40
        Least number of plots of reported vessels. In plots, 10 to 1e6.
    max_matches : int, default 50000
        Room for pairs of plot and reported vessel; when it is full, every other pair of the past and of the future is left out. In pairs, 100 to 1e7.
    max_waiting_plots : int, default 20000
        Room for plots that wait for the next reports. In plots, 100 to 1e7.
    max_vessels : int, default 500
        Room for reported vessels; others are left out. In vessels, 1 to 100000.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> CalibrationConfig:
        ...
    def __deepcopy__(self, memo: dict) -> CalibrationConfig:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, range_gate_m: float = 400.0, bearing_gate_rad: float = 0.13962634015954636, position_offset_std_m: float = 2.0, max_gap_s: float = 60.0, max_range_std_m: float = 3.0, max_bearing_std_rad: float = 0.008726646259971648, max_time_std_s: float = 0.5, min_matches: int = 40, max_matches: int = 50000, max_waiting_plots: int = 20000, max_vessels: int = 500) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    @property
    def bearing_gate_rad(self) -> float:
        """
        Largest bearing offset that is looked for. In rad, above 0 and at most 3.14159. Default 0.139626.
        """
    @property
    def max_bearing_std_rad(self) -> float:
        """
        A bearing offset is determined up to this standard deviation. In rad, above 0 and at most 3.14159. Default 0.00872665.
        """
    @property
    def max_gap_s(self) -> float:
        """
        Longest time between two reports of a vessel that is interpolated. In s, 0.01 to 3600. Default 60.0.
        """
    @property
    def max_matches(self) -> int:
        """
        Room for pairs of plot and reported vessel; when it is full, every other pair of the past and of the future is left out. In pairs, 100 to 1e7. Default 50000.
        """
    @property
    def max_range_std_m(self) -> float:
        """
        A range offset is determined up to this standard deviation. In m, 0.001 to 1e6. Default 3.0.
        """
    @property
    def max_time_std_s(self) -> float:
        """
        A time offset is determined up to this standard deviation. In s, 0.001 to 100000. Default 0.5.
        """
    @property
    def max_vessels(self) -> int:
        """
        Room for reported vessels; others are left out. In vessels, 1 to 100000. Default 500.
        """
    @property
    def max_waiting_plots(self) -> int:
        """
        Room for plots that wait for the next reports. In plots, 100 to 1e7. Default 20000.
        """
    @property
    def min_matches(self) -> int:
        """
        Least number of plots of reported vessels. In plots, 10 to 1e6. Default 40.
        """
    @property
    def position_offset_std_m(self) -> float:
        """
        Expected constant offset of a vessel's echo from its reported position, per axis; the offsets measured correct it. In m, 0.01 to 10000. Default 2.0.
        """
    @property
    def range_gate_m(self) -> float:
        """
        Largest range offset that is looked for. In m, 1 to 100000. Default 400.0.
        """
class CalibratedOffset:
    """
    One offset of a radar, measured minus true.
    """
    def __getstate__(self) -> tuple[float, float]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    @property
    def determined(self) -> bool:
        """
        whether the value is good enough to be applied
        """
    @property
    def std(self) -> float:
        """
        its standard deviation
        """
    @property
    def value(self) -> float:
        """
        m, rad or s; NaN without any plot of a reported vessel
        """
    @property
    def verdict(self) -> str:
        """
        'determined', 'few matches' (too few plots of reported vessels, or no more than by chance) or 'poor geometry' (the standard deviation is above the limit)
        """
class CalibrationResult:
    """
    Offsets of a radar, and what they were found from.
    
    `vessel_*` are columns of the vessels with a plot, `pair_*` of all pairs of plot and vessel in the
    gate.
    """
    def applied_to(self, radar: Radar) -> Radar:
        """
        The parameters of a radar with the offsets that were determined.
        """
    @property
    def bearing_rad(self) -> CalibratedOffset:
        """
        CalibratedOffset of the bearing, rad
        """
    @property
    def bearing_scale(self) -> float:
        """
        the same of bearings
        """
    @property
    def correlation_scans(self) -> float:
        """
        number of plots of a vessel that count as one, for their errors are alike
        """
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (3, 3) of range, bearing and time offset
        """
    @property
    def matches(self) -> float:
        """
        number of plots of reported vessels
        """
    @property
    def pair_bearing_error_rad(self) -> NDArray[np.float64]:
        """
        (n,) the same
        """
    @property
    def pair_bearing_rad(self) -> NDArray[np.float64]:
        """
        (n,) bearing of the reported position
        """
    @property
    def pair_bearing_rest_rad(self) -> NDArray[np.float64]:
        """
        (n,) the same
        """
    @property
    def pair_probability(self) -> NDArray[np.float64]:
        """
        (n,) probability that the plot is the vessel's
        """
    @property
    def pair_range_error_m(self) -> NDArray[np.float64]:
        """
        (n,) plot minus reported position
        """
    @property
    def pair_range_m(self) -> NDArray[np.float64]:
        """
        (n,) range of the reported position
        """
    @property
    def pair_range_rest_m(self) -> NDArray[np.float64]:
        """
        (n,) the same without the offsets of radar and vessel
        """
    @property
    def pair_time_s(self) -> NDArray[np.float64]:
        """
        (n,) time of the plot, by the radar's clock
        """
    @property
    def pair_vessel(self) -> NDArray[np.int64]:
        """
        (n,) number of the vessel
        """
    @property
    def range_m(self) -> CalibratedOffset:
        """
        CalibratedOffset of the range, m
        """
    @property
    def range_scale(self) -> float:
        """
        errors of range found over those expected of radar and reports
        """
    @property
    def time_s(self) -> CalibratedOffset:
        """
        CalibratedOffset of the radar's clock, s
        """
    @property
    def vessel_across_m(self) -> NDArray[np.float64]:
        """
        (v,) the same, to starboard
        """
    @property
    def vessel_along_m(self) -> NDArray[np.float64]:
        """
        (v,) its echo minus its reported position, along its course
        """
    @property
    def vessel_id(self) -> NDArray[np.int64]:
        """
        (v,) number of each vessel
        """
    @property
    def vessel_matches(self) -> NDArray[np.float64]:
        """
        (v,) number of its plots
        """
    @property
    def vessel_offset_std_m(self) -> float:
        """
        standard deviation of the constant offsets of the vessels, per axis
        """
class Calibration:
    """
    Range, bearing and time offset of a radar from reports.
    
    Plots of vessels whose positions are known by their reports (AIS, GNSS) give the three offsets with
    their standard deviations, by robust weighted least squares. Each vessel's echo may have a constant
    offset from the reported position, which is estimated, too. An offset is determined only if there
    are enough matches and its standard deviation is below the limit. Reports and plots are given in
    order of time, each of either kind. Memory is bounded.
    
    Parameters
    ----------
    radar : Radar, optional
        Its errors; its offsets are not used.
    config : CalibrationConfig, optional
    
    Raises
    ------
    ValueError
        When a parameter is out of range.
    """
    def __init__(self, radar: Radar = ..., config: CalibrationConfig = ...) -> None:
        ...
    def add_plots(self, time_s: ArrayLike, *, range_m: ArrayLike, bearing_rad: ArrayLike, own_north_m: ArrayLike = 0.0, own_east_m: ArrayLike = 0.0, own_vnorth_mps: ArrayLike = 0.0, own_veast_mps: ArrayLike = 0.0, own_position_std_m: float = 0.0, heading_std_rad: float = 0.0) -> None:
        """
        Take plots; those that are not finite are left out.
        
        Parameters
        ----------
        time_s : (n,) array or float
            By the radar's clock.
        range_m, bearing_rad : (n,) array
            As measured.
        own_north_m, own_east_m, own_vnorth_mps, own_veast_mps : (n,) array or float
            Own ship at the time of each plot.
        own_position_std_m, heading_std_rad : float
            Standard deviations of own ship's position per axis, and of its heading.
        
        Raises
        ------
        ValueError
            When a shape does not fit or a standard deviation is negative.
        """
    def add_reports(self, vessel: int, time_s: ArrayLike, *, north_m: ArrayLike, east_m: ArrayLike, vnorth_mps: ArrayLike = ..., veast_mps: ArrayLike = ..., position_std_m: ArrayLike = 5.0) -> int:
        """
        Take position reports of one vessel.
        
        Parameters
        ----------
        vessel : int
            Its number, such as the MMSI.
        time_s : (n,) array or float
        north_m, east_m : (n,) array or float
        vnorth_mps, veast_mps : (n,) array or float, optional
            Velocity, NaN where unknown. With velocities, positions between reports are on a cubic.
        position_std_m : (n,) array or float
            Standard deviation per axis of the part that differs from report to report.
        
        Returns
        -------
        int
            Number of reports left out: not finite, not after the last one of the vessel, or of one vessel
            too many.
        
        Raises
        ------
        ValueError
            When a shape does not fit.
        """
    def solve(self) -> CalibrationResult:
        """
        CalibrationResult from all that was given so far.
        """
    @property
    def config(self) -> CalibrationConfig:
        ...
    @property
    def radar(self) -> Radar:
        ...
def vessel_imm(radar: Radar, models: VesselModels = ...) -> Imm:
    """
    The default estimator of a tracker.
    """
