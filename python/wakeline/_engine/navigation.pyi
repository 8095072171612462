"""
Geodesy, dead reckoning, leeway and drift.
"""
from collections.abc import Sequence
import typing
import numpy as np
from numpy.typing import ArrayLike, NDArray
from .core import Gaussian, Step
__all__: list = ['geodesic', 'geodesic_destination', 'rhumb_line', 'rhumb_destination', 'LocalPlane', 'predict_position_m', 'predict_speed_mps', 'predict_course_rad', 'predict_latitude_rad', 'predict_longitude_rad', 'predict_turn_rate_rad_s', 'velocity_mps', 'speed_course', 'over_ground', 'TotalDrift', 'velocity_over_window_mps', 'velocity_from_rates_mps', 'dead_reckon', 'FloatingObject', 'leeway_factor', 'wind_drift_mps', 'wind_current_factor', 'wind_current_mps', 'stokes_drift_mps', 'drift_from_rates_mps', 'water_velocity', 'ground_velocity_from_marks', 'drift_between', 'sea_stabilised_mps', 'ground_stabilised_mps', 'DriftWindow', 'DriftModel', 'drift_forecast', 'drift_particles', 'UncertaintyEllipse', 'ClosestApproach', 'closest_approach', 'DangerLimits', 'DangerZone', 'ApproachTable', 'EncounterTable', 'EncounterReport', 'EncounterWatch', 'leeway_kinds', 'leeway_lines', 'leeway_mps', 'pass_probability', 'parallel_track_pod', 'random_search_pod', 'detection_potential', 'Intercept', 'intercept', 'UsvReading', 'UsvRun', 'UsvNavigator', 'step_navigators', 'WaypointGuidance', 'Steering', 'WaypointFollower', 'CompassEllipse', 'calibrate_compass']
class LocalPlane:
    """
    The plane of north and east around a reference position.
    
    Distance and course from the reference along the geodesic, as polar coordinates (the azimuthal equidistant projection): distances
    from the reference are exact to 0.1 mm. Across that direction, at a distance d, the plane is stretched by d² / (6 R²): 1e-5 at 50 km,
    4e-5 at 100 km. Positions are keyword arguments in radians, because degrees would silently give another position.
    
    Parameters
    ----------
    latitude_rad, longitude_rad : float
        The reference.
    
    Raises
    ------
    ValueError
        When it is not on the earth.
    """
    def __copy__(self) -> LocalPlane:
        ...
    def __deepcopy__(self, memo: dict) -> LocalPlane:
        ...
    def __init__(self, *, latitude_rad: float, longitude_rad: float) -> None:
        ...
    def place(self, position_m: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """
        (latitude_rad, longitude_rad) (...) at [north, east] (..., 2).
        """
    def plane_course_rad(self, true_course_rad: ArrayLike, *, latitude_rad: ArrayLike, longitude_rad: ArrayLike) -> NDArray[np.float64]:
        """
        Directions on the plane of courses from true north at positions, with the convergence of meridians.
        """
    def position_m(self, *, latitude_rad: ArrayLike, longitude_rad: ArrayLike) -> NDArray[np.float64]:
        """
        [north, east] (..., 2) of positions (...); NaN near the antipode.
        """
    def true_course_rad(self, plane_course_rad: ArrayLike, *, latitude_rad: ArrayLike, longitude_rad: ArrayLike) -> NDArray[np.float64]:
        """
        Courses from true north at positions, from directions on the plane.
        """
    @property
    def latitude_rad(self) -> float:
        ...
    @property
    def longitude_rad(self) -> float:
        ...
class TotalDrift:
    """
    Total drift of a vessel; (3).
    
    Parameters
    ----------
    wind_drift_mps, current_mps, residual_mps : (2,) array
        [north, east] m/s of leeway, of the current of tide, wind and waves, and of the residual.
    
    Raises
    ------
    ValueError
        When one is not a pair.
    """
    def __init__(self, wind_drift_mps: ArrayLike = ..., current_mps: ArrayLike = ..., residual_mps: ArrayLike = ...) -> None:
        ...
    def velocity_mps(self) -> NDArray[np.float64]:
        """
        Their sum, [north, east] m/s.
        """
    @property
    def current_mps(self) -> NDArray[np.float64]:
        ...
    @property
    def residual_mps(self) -> NDArray[np.float64]:
        ...
    @property
    def wind_drift_mps(self) -> NDArray[np.float64]:
        ...
class FloatingObject:
    """
    Kind of floating object.
    
    Members:
    
      buoy
    
      dinghy
    
      launch
    
      ship
    """
    __members__: typing.ClassVar[dict[str, FloatingObject]]
    buoy: typing.ClassVar[FloatingObject]
    dinghy: typing.ClassVar[FloatingObject]
    launch: typing.ClassVar[FloatingObject]
    ship: typing.ClassVar[FloatingObject]
    @typing.overload
    def __eq__(self, other: FloatingObject) -> bool:
        ...
    @typing.overload
    def __eq__(self, other: object) -> bool:
        ...
    def __getstate__(self) -> int:
        ...
    def __hash__(self) -> int:
        ...
    def __index__(self) -> int:
        ...
    def __init__(self, value: int) -> None:
        ...
    def __int__(self) -> int:
        ...
    @typing.overload
    def __ne__(self, other: FloatingObject) -> bool:
        ...
    @typing.overload
    def __ne__(self, other: object) -> bool:
        ...
    def __setstate__(self, state: int) -> None:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def value(self) -> int:
        ...
class DriftWindow:
    """
    The drift of a vessel over a sliding window of fixes; (16)-(20).
    
    The slope of the line through the differences of observed and reckoned positions, by least squares, with its covariance. The
    differences have the errors of the fixes and the accumulated, independent errors of log and compass; without errors of log and
    compass the line is the plain one. A constant error of the log or the compass counts as drift.
    
    Parameters
    ----------
    max_fixes : int
        Maximum number of fixes, 2 to 32.
    log_std_mps, heading_std_rad : float
        Standard deviations of one reading of the log and of the compass.
    alteration_mps : float
        Change of the velocity through the water since a fix that ends the line at that fix; 0: none does. The step is left out,
        another line with the same slope begins at the fix after it.
    
    Raises
    ------
    ValueError
        When a setting makes no sense.
    """
    def __copy__(self) -> DriftWindow:
        ...
    def __deepcopy__(self, memo: dict) -> DriftWindow:
        ...
    def __init__(self, *, max_fixes: int = 20, log_std_mps: float = 0.0, heading_std_rad: float = 0.0, alteration_mps: float = 0.0) -> None:
        ...
    def add(self, fix: Gaussian) -> None:
        """
        Process a fix at the present time, [north, east] m on a plane.
        """
    def advance(self, dt_s: float, speed_mps: float, heading_rad: float) -> None:
        """
        Advance time with a speed through the water and a heading.
        """
    def clear(self) -> None:
        """
        Forget all fixes, e.g. after an alteration of course.
        """
    def drift(self) -> Gaussian:
        """
        [north, east] m/s; zero with an infinite covariance until `ready`.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def run(self, dt_s: ArrayLike, speed_mps: ArrayLike, heading_rad: ArrayLike, fix_m: ArrayLike, fix_std_m: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """
        The drift after each of a series of fixes.
        
        Parameters
        ----------
        dt_s, speed_mps, heading_rad : float or (T,) array
            The step to a fix and the readings of log and compass in it; the first step is ignored.
        fix_m : (T, 2) array
            NaN where a fix is missing.
        fix_std_m : float or (T,) array
            Standard deviation of a fix per axis.
        
        Returns
        -------
        (mean, covariance)
            (T, 2) and (T, 2, 2), as for `drift`.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    @property
    def ready(self) -> bool:
        """
        whether there are two fixes of different times without an alteration in between
        """
    @property
    def size(self) -> int:
        """
        number of fixes
        """
class DriftModel:
    """
    How an object drifts: v = k U + C + r, U the wind, C the current, and what is not known of them; the leeway is that of a dinghy by default.
    
    Parameters
    ----------
    leeway : float, default 0.0385
        Leeway factor k: speed through the water over that of the wind. 0 to 1e6.
    leeway_std : float, default 0.00375
        Standard deviation of the factor, which stays the same during a forecast. 0 to 1e6.
    wind_std_mps : float, default 1.5
        Standard deviation of the wind, per axis, of an error that lasts. In m/s, 0 to 1e6.
    current_std_mps : float, default 0.1
        Standard deviation of the current, per axis, of an error that lasts. In m/s, 0 to 1e6.
    residual_std_mps : float, default 0.05
        Standard deviation of the residual drift, per axis, which wanders (Gauss-Markov). In m/s, 0 to 1e6.
    residual_time_s : float, default 1800.0
        Correlation time of the residual drift. In s, 1e-9 to 1e12.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    @staticmethod
    def of(object: FloatingObject) -> DriftModel:
        """
        The model with the leeway of a kind of object.
        """
    def __copy__(self) -> DriftModel:
        ...
    def __deepcopy__(self, memo: dict) -> DriftModel:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, leeway: float = 0.0385, leeway_std: float = 0.00375, wind_std_mps: float = 1.5, current_std_mps: float = 0.1, residual_std_mps: float = 0.05, residual_time_s: float = 1800.0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    @property
    def current_std_mps(self) -> float:
        """
        Standard deviation of the current, per axis, of an error that lasts. In m/s, 0 to 1e6. Default 0.1.
        """
    @property
    def leeway(self) -> float:
        """
        Leeway factor k: speed through the water over that of the wind. 0 to 1e6. Default 0.0385.
        """
    @property
    def leeway_std(self) -> float:
        """
        Standard deviation of the factor, which stays the same during a forecast. 0 to 1e6. Default 0.00375.
        """
    @property
    def residual_std_mps(self) -> float:
        """
        Standard deviation of the residual drift, per axis, which wanders (Gauss-Markov). In m/s, 0 to 1e6. Default 0.05.
        """
    @property
    def residual_time_s(self) -> float:
        """
        Correlation time of the residual drift. In s, 1e-9 to 1e12. Default 1800.0.
        """
    @property
    def wind_std_mps(self) -> float:
        """
        Standard deviation of the wind, per axis, of an error that lasts. In m/s, 0 to 1e6. Default 1.5.
        """
class UncertaintyEllipse:
    """
    The area that contains a Gaussian position with a given probability.
    """
    def __init__(self, covariance: ArrayLike, probability: float = 0.95) -> None:
        ...
    @property
    def area_m2(self) -> float:
        ...
    @property
    def major_axis_rad(self) -> float:
        """
        direction of the long axis, 0 .. pi clockwise from north
        """
    @property
    def semi_major_m(self) -> float:
        ...
    @property
    def semi_minor_m(self) -> float:
        ...
class ClosestApproach:
    """
    Closest approaches of pairs of ships; every array has the shape (...) of the pairs.
    """
    def __getstate__(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    def probability(self, limit_m: float, horizon_s: float = ...) -> NDArray[np.float64]:
        """
        Probability that the ships come closer than a limit L between now and a horizon H: that
                  |p + v t| < L at some t, 0 <= t <= H, with p and v jointly Gaussian, also near relative rest. The
                  RMS error against random draws is 0.004. Errors above 0.02 are rare, except in one of thirty cases
                  with a target within a tenth of the limit; they are at most 0.08, but up to 0.15 (too small) for a
                  target with a known position less than a hundredth outside the limit.
        
        Parameters
        ----------
        limit_m : float
        horizon_s : float
            May be infinite.
        
        Returns
        -------
        (...) array
        
        Raises
        ------
        ValueError
            When one is negative or NaN.
        """
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (..., 2, 2) of [signed_cpa_m, tcpa_s].
        """
    @property
    def cpa_m(self) -> NDArray[np.float64]:
        """
        Distance at the closest point, not negative.
        """
    @property
    def cpa_std_m(self) -> NDArray[np.float64]:
        """
        Standard deviation of signed_cpa_m, of first order.
        """
    @property
    def signed_cpa_m(self) -> NDArray[np.float64]:
        """
        Signed distance, positive if the ships pass port to port along their relative motion.
        """
    @property
    def tcpa_s(self) -> NDArray[np.float64]:
        """
        Time until the closest point; negative in the past, 0 at relative rest.
        """
    @property
    def tcpa_std_s(self) -> NDArray[np.float64]:
        """
        Standard deviation of tcpa_s, of first order.
        """
class DangerLimits:
    """
    Limits of a dangerous approach of two vessels.
    
    An encounter begins when two vessels will be closer than `cpa_limit_m` within `tcpa_limit_s` with
    at least `alarm_probability`, their closest approach within that time, too. It ends when the danger
    is over for `clear_hold_s`: the probability below `clear_probability`, or the closest approach past,
    or no motion relative to each other, or both vessels at rest. The hold time keeps one alarm per
    encounter while the estimate of a distant vessel varies.
    
    Parameters
    ----------
    cpa_limit_m : float, default 926.0
        Distance below which an approach is dangerous. In m, 0 to 1e6.
    tcpa_limit_s : float, default 1200.0
        Time within which the vessels come so close, and to their closest approach. In s, 0 to 100000.
    alarm_probability : float, default 0.5
        With this probability or more, an encounter begins. A probability between 0 and 1.
    clear_probability : float, default 0.3
        An encounter ends when the probability stays below this, at most `alarm_probability`. A probability between 0 and 1.
    clear_hold_s : float, default 60.0
        Time for which the danger must be over; shorter gaps end no encounter. In s, 0 to 100000.
    rest_speed_mps : float, default 0.5
        Vessels up to this speed are at rest (moored, berthed or at anchor); two of them are no danger to each other. In m/s, 0 to 100.
    own_length_m : float, default 50.0
        A vessel that is first dangerous closer than this to own ship is an echo of own ship. In m, 0 to 1000.
    own_velocity_std_mps : float, default 0.2
        Standard deviation of own ship's velocity per axis, if its covariance is unknown. In m/s, 0 to 100.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> DangerLimits:
        ...
    def __deepcopy__(self, memo: dict) -> DangerLimits:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, cpa_limit_m: float = 926.0, tcpa_limit_s: float = 1200.0, alarm_probability: float = 0.5, clear_probability: float = 0.3, clear_hold_s: float = 60.0, rest_speed_mps: float = 0.5, own_length_m: float = 50.0, own_velocity_std_mps: float = 0.2) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    @property
    def alarm_probability(self) -> float:
        """
        With this probability or more, an encounter begins. A probability between 0 and 1. Default 0.5.
        """
    @property
    def clear_hold_s(self) -> float:
        """
        Time for which the danger must be over; shorter gaps end no encounter. In s, 0 to 100000. Default 60.0.
        """
    @property
    def clear_probability(self) -> float:
        """
        An encounter ends when the probability stays below this, at most `alarm_probability`. A probability between 0 and 1. Default 0.3.
        """
    @property
    def cpa_limit_m(self) -> float:
        """
        Distance below which an approach is dangerous. In m, 0 to 1e6. Default 926.0.
        """
    @property
    def own_length_m(self) -> float:
        """
        A vessel that is first dangerous closer than this to own ship is an echo of own ship. In m, 0 to 1000. Default 50.0.
        """
    @property
    def own_velocity_std_mps(self) -> float:
        """
        Standard deviation of own ship's velocity per axis, if its covariance is unknown. In m/s, 0 to 100. Default 0.2.
        """
    @property
    def rest_speed_mps(self) -> float:
        """
        Vessels up to this speed are at rest (moored, berthed or at anchor); two of them are no danger to each other. In m/s, 0 to 100. Default 0.5.
        """
    @property
    def tcpa_limit_s(self) -> float:
        """
        Time within which the vessels come so close, and to their closest approach. In s, 0 to 100000. Default 1200.0.
        """
class DangerZone:
    """
    An area with separate limits, such as a harbor.
    
    Parameters
    ----------
    name : str
    outline_m : (n, 2) array_like
        Corners [north, east] of a polygon, n at least 3.
    limits : DangerLimits, optional
    
    Raises
    ------
    ValueError
        When there are fewer than three corners or one is not finite.
    """
    __hash__: typing.ClassVar[None]  # type: ignore[assignment]
    def __eq__(self, arg0: DangerZone) -> bool:
        ...
    def __init__(self, name: str, outline_m: ArrayLike, limits: DangerLimits = ...) -> None:
        ...
    def contains(self, north_m: float, east_m: float) -> bool:
        """
        Whether a place is inside.
        """
    @property
    def limits(self) -> DangerLimits:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def outline_m(self) -> NDArray[np.float64]:
        """
        (n, 2) corners [north, east]
        """
class ApproachTable:
    """
    Closest approaches of pairs of vessels, as arrays.
    """
    def __getstate__(self) -> bytes:
        ...
    def __len__(self) -> int:
        ...
    def __setstate__(self, arg0: bytes) -> None:
        ...
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (n, 2, 2) of [signed_cpa_m, tcpa_s], of first order
        """
    @property
    def cpa_m(self) -> NDArray[np.float64]:
        """
        (n,) distance at the closest point
        """
    @property
    def first(self) -> NDArray[np.int64]:
        """
        (n,) a vessel; 0 is own ship
        """
    @property
    def first_at_cpa_m(self) -> NDArray[np.float64]:
        """
        (n, 2) [north, east] of the first vessel at the closest point
        """
    @property
    def probability(self) -> NDArray[np.float64]:
        """
        (n,) probability to come closer than the limit within the time limit
        """
    @property
    def range_m(self) -> NDArray[np.float64]:
        """
        (n,) distance
        """
    @property
    def second(self) -> NDArray[np.int64]:
        """
        (n,) the other, of a larger number
        """
    @property
    def second_at_cpa_m(self) -> NDArray[np.float64]:
        """
        (n, 2) of the second one
        """
    @property
    def signed_cpa_m(self) -> NDArray[np.float64]:
        """
        (n,) the same, positive where the vessels pass port to port
        """
    @property
    def tcpa_s(self) -> NDArray[np.float64]:
        """
        (n,) time until the closest point; negative in the past
        """
    @property
    def zone(self) -> NDArray[np.int64]:
        """
        (n,) index of the zone whose limits apply, -1 for the general ones
        """
class EncounterTable:
    """
    Dangerous encounters as arrays; what changes is of `time_s`.
    """
    def __getstate__(self) -> bytes:
        ...
    def __len__(self) -> int:
        ...
    def __setstate__(self, arg0: bytes) -> None:
        ...
    @property
    def acknowledged(self) -> NDArray[np.bool_]:
        """
        (n,) whether the operator knows it
        """
    @property
    def begin_s(self) -> NDArray[np.float64]:
        """
        (n,) first update with danger
        """
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (n, 2, 2) of [signed_cpa_m, tcpa_s], of first order
        """
    @property
    def cpa_m(self) -> NDArray[np.float64]:
        """
        (n,) distance at the closest point
        """
    @property
    def dangerous(self) -> NDArray[np.bool_]:
        """
        (n,) whether the danger continues; False in the hold time
        """
    @property
    def encounter_id(self) -> NDArray[np.int64]:
        """
        (n,) positive, never used again
        """
    @property
    def first(self) -> NDArray[np.int64]:
        """
        (n,) a vessel; 0 is own ship
        """
    @property
    def first_at_cpa_m(self) -> NDArray[np.float64]:
        """
        (n, 2) [north, east] of the first vessel at the closest point
        """
    @property
    def last_s(self) -> NDArray[np.float64]:
        """
        (n,) last update with danger
        """
    @property
    def least_range_m(self) -> NDArray[np.float64]:
        """
        (n,) smallest distance of all updates so far
        """
    @property
    def least_range_s(self) -> NDArray[np.float64]:
        """
        (n,) its time
        """
    @property
    def probability(self) -> NDArray[np.float64]:
        """
        (n,) probability to come closer than the limit within the time limit
        """
    @property
    def range_m(self) -> NDArray[np.float64]:
        """
        (n,) distance
        """
    @property
    def second(self) -> NDArray[np.int64]:
        """
        (n,) the other, of a larger number
        """
    @property
    def second_at_cpa_m(self) -> NDArray[np.float64]:
        """
        (n, 2) of the second one
        """
    @property
    def signed_cpa_m(self) -> NDArray[np.float64]:
        """
        (n,) the same, positive where the vessels pass port to port
        """
    @property
    def tcpa_s(self) -> NDArray[np.float64]:
        """
        (n,) time until the closest point; negative in the past
        """
    @property
    def time_s(self) -> NDArray[np.float64]:
        """
        (n,) last update that had both vessels
        """
    @property
    def zone(self) -> NDArray[np.int64]:
        """
        (n,) index of the zone whose limits apply, -1 for the general ones
        """
class EncounterReport:
    """
    Result of an update.
    """
    def __getstate__(self) -> tuple[EncounterTable, EncounterTable, ApproachTable, int, int]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    @property
    def approaches(self) -> ApproachTable:
        """
        ApproachTable of all approaches that can matter, dangerous or not
        """
    @property
    def began(self) -> EncounterTable:
        """
        EncounterTable of new encounters
        """
    @property
    def ended(self) -> EncounterTable:
        """
        EncounterTable of encounters whose danger is over
        """
    @property
    def left_out(self) -> int:
        """
        approaches and encounters without room
        """
    @property
    def unwatched_vessels(self) -> int:
        """
        vessels that are not finite, or beyond max_vessels
        """
class EncounterWatch:
    """
    Finds the vessels that come dangerously close to each other.
    
    An approach can matter when its closest point is ahead within the time limit, the probability of
    coming closer than the limit is at least 0.01, the vessels move relative to each other by three
    standard deviations, one of them is faster than `rest_speed_mps` by two, and neither is own ship with the
    other closer than `own_length_m`. An encounter begins when such an approach has `alarm_probability`
    and ends when the danger is over (`DangerLimits`). Limits are those of the first zone that contains
    the middle between the vessels at their closest point, else the general ones; an encounter keeps its
    limits. A pair is left out without a probability only if that is below 0.01.
    
    Parameters
    ----------
    limits : DangerLimits, optional
    zones : sequence of DangerZone, optional
    max_vessels : int, optional
    
    Raises
    ------
    ValueError
        When a limit is out of range.
    """
    def __init__(self, limits: DangerLimits = ..., zones: Sequence[DangerZone] = (), max_vessels: int = 1000) -> None:
        ...
    def acknowledge(self, encounter_id: int) -> bool:
        """
        Mark an encounter as known to the operator; False if none has that number.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved watch was.
        """
    def save(self) -> bytes:
        """
        The complete state as bytes, for a watch with the same limits, zones and room.
        """
    def update(self, time_s: float, *, vessel_id: ArrayLike, mean: ArrayLike, covariance: ArrayLike) -> EncounterReport:
        """
        Take all vessels at a time.
        
        Parameters
        ----------
        time_s : float
            Not before the last one.
        vessel_id : (n,) array of int
            0 for own ship, different for each vessel.
        mean : (n, 4) array
            [x, vx, y, vy], metres and m/s.
        covariance : (n, 4, 4) array
            Of own ship that of its velocity alone: plots are measured from its position.
        
        Returns
        -------
        EncounterReport
        
        Raises
        ------
        ValueError
            When a shape does not fit or two vessels have the same number.
        FilterError
            When the time is before the last one or not finite; nothing is changed.
        """
    @property
    def encounters(self) -> EncounterTable:
        """
        EncounterTable of those that have not ended, by their vessels' numbers.
        """
    @property
    def limits(self) -> DangerLimits:
        ...
    @property
    def max_vessels(self) -> int:
        ...
    @property
    def zones(self) -> list[DangerZone]:
        ...
class Intercept:
    """
    Where and when a search unit meets a moving object.
    """
    @property
    def course_rad(self) -> float:
        """
        Of the unit.
        """
    @property
    def course_std_rad(self) -> float:
        """
        Standard deviation, first order.
        """
    @property
    def covariance_m2(self) -> NDArray[np.float64]:
        """
        (2, 2) of the position.
        """
    @property
    def found(self) -> bool:
        """
        False where the object outruns the unit; the rest is then NaN.
        """
    @property
    def position_m(self) -> NDArray[np.float64]:
        """
        (2,), [north, east] of the object at that time.
        """
    @property
    def time_s(self) -> float:
        """
        From now.
        """
    @property
    def time_std_s(self) -> float:
        """
        Standard deviation, first order.
        """
class UsvReading(Step):
    """
    Outcome of a reading; true if it was accepted.
    """
    def __getstate__(self) -> tuple[tuple, bool, bool]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    @property
    def rejected(self) -> bool:
        """
        outside the gate: the belief is unchanged
        """
    @property
    def widened(self) -> bool:
        """
        outside the gate, but accepted after too many consecutive rejections
        """
class UsvRun:
    """
    Result of `UsvNavigator.run`.
    """
    def __getstate__(self) -> tuple[NDArray[np.float64], NDArray[np.float64], dict[str, NDArray[np.float64]], dict[str, NDArray[np.bool_]]]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    @property
    def covariance(self) -> NDArray[np.float64]:
        """
        (T, N, N)
        """
    @property
    def mean(self) -> NDArray[np.float64]:
        """
        (T, N)
        """
    @property
    def nis(self) -> dict[str, NDArray[np.float64]]:
        """
        by sensor: (T,) normalized innovations squared, NaN without a reading
        """
    @property
    def rejected(self) -> dict[str, NDArray[np.bool_]]:
        """
        by sensor: (T,) True for a rejected outlier
        """
class UsvNavigator:
    """
    Own ship's position, motion and heading by IMU, GNSS, compass and log.
    
    States are [north, east, v_north, v_east, heading] for 5, the same followed by the biases [forward,
    starboard, gyro] for 8, and [north, east, heading, speed through water, gyro bias, current north,
    current east] for 7, which does not use the accelerometers. Metres, seconds, radians; headings in
    [-pi, pi].
    
    A reading whose NIS is outside the gate is rejected. After more than `rejections` consecutive
    rejections of one sensor the covariance is inflated and the reading accepted, unless it is more than
    a million standard deviations off, or positions accepted meanwhile refute it. Then velocities remain
    rejected, and compass and log may move only the current, within the gate of `current_std_mps` unless
    it was stronger before. Accepted headings refute rates of turn.
    
    It does not detect a frozen receiver; `recording.read_nmea` marks such fixes in a log.
    
    Parameters
    ----------
    states : {5, 7, 8}
    filter : {'ekf', 'ukf', 'augmented_ukf'}
        The extended and the unscented filter, which add the noise of the IMU to the covariance, or the
        unscented filter with sigma points for that noise. All agree if turns between readings are small.
    acceleration_std_mps2, yaw_rate_std_rad_s : float
        Standard deviation of a reading of the IMU, constant over a step.
    unmeasured_acceleration_std_mps2, unmeasured_yaw_rate_std_rad_s : float
        Process noise of a step without a reading of the IMU.
    acceleration_bias_std_mps2, gyro_bias_std_rad_s, current_std_mps : float
        Initial standard deviations of biases and current (per axis), whose initial means are zero.
    speed_walk_mps, current_walk_mps : float
        Random walks of speed through water and current over 1 s, for 7 states.
    turned_at : float
        Point in a step whose heading rotates the acceleration, for 5 and 8 states: 0.5 is its middle, 0
        its start, as in the paper.
    gate_probability : float
        Probability that a good reading is inside the gate.
    rejections : int
        Consecutive rejections before a reading is accepted; 0: all are accepted, nothing is refuted.
    alpha, beta, kappa : float
        Parameters of the unscented transform.
    
    Raises
    ------
    ValueError
        When a parameter makes no sense.
    """
    def __copy__(self) -> UsvNavigator:
        ...
    def __deepcopy__(self, memo: dict) -> UsvNavigator:
        ...
    def __init__(self, states: int = 8, filter: str = 'ekf', *, acceleration_std_mps2: float = 0.004, yaw_rate_std_rad_s: float = 0.0005759586531581288, unmeasured_acceleration_std_mps2: float = 0.1, unmeasured_yaw_rate_std_rad_s: float = 0.03490658503988659, acceleration_bias_std_mps2: float = 0.05, gyro_bias_std_rad_s: float = 0.008726646259971648, current_std_mps: float = 0.5, speed_walk_mps: float = 0.03, current_walk_mps: float = 0.002, turned_at: float = 0.5, gate_probability: float = 0.999, rejections: int = 10, alpha: float = 1.0, beta: float = 2.0, kappa: float = 0.0) -> None:
        ...
    def predict(self, dt_s: float, imu: ArrayLike | None = None) -> None:
        """
        Predict with a reading of the IMU [forward m/s², starboard m/s², yaw rate rad/s], or without one.
        """
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def run(self, time_s: ArrayLike, imu: ArrayLike | None = None, gnss: ArrayLike | None = None, compass: ArrayLike | None = None, *, velocity: ArrayLike | None = None, log: ArrayLike | None = None, rate_of_turn: ArrayLike | None = None, imu_std: ArrayLike | None = None, gnss_std_m: ArrayLike = [8.0, 7.0], compass_std_rad: float = 0.017453292519943295, velocity_std_mps: float = 0.1, log_std_mps: float = 0.1, rate_of_turn_std_rad_s: float = 0.0017453292519943296, smooth: bool = False) -> UsvRun:
        """
        Process a log from the current belief, which is that of `time_s[0]`.
        
        Parameters
        ----------
        time_s : (T,) array
            Not decreasing.
        imu : (T, 3) array, optional
            Row k is the mean from time k - 1 to time k: [forward m/s², starboard m/s², yaw rate rad/s].
        gnss, velocity : (T, 2) array, optional
            Position m and velocity over ground m/s, [north, east].
        compass, log, rate_of_turn : (T,) array, optional
            Heading rad, speed through water m/s (7 states), rate of turn rad/s (7 or 8 states); the last is
            ignored in rows without a reading of `imu`.
        imu_std : (T, 2) array, optional
            Row k is the standard deviation from time k - 1 to time k of [acceleration m/s², yaw rate rad/s],
            measured or not, instead of the navigator's.
        gnss_std_m, compass_std_rad, velocity_std_mps, log_std_mps, rate_of_turn_std_rad_s : float
            Standard deviations; that of gnss is [north, east].
        smooth : bool
            Whether the returned beliefs also use later readings, up to one at which the covariance was
            inflated.
        
        In every array a row that is not finite is a missing reading.
        
        Returns
        -------
        UsvRun
        
        Raises
        ------
        ValueError
            When shapes do not fit, times decrease, a sensor needs a missing state, or `rate_of_turn` is
            given without `imu`.
        FilterError
            When the navigator was not started, or a step fails; the navigator is then unchanged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def start(self, position_m: ArrayLike, velocity_mps: ArrayLike, heading_rad: float, *, position_std_m: ArrayLike = [8.0, 7.0], velocity_std_mps: float = 0.5, heading_std_rad: float = 0.017453292519943295) -> None:
        """
        Start at [north, east] m with a velocity over ground [north, east] m/s and a heading.
        """
    def update_heading(self, heading_rad: float, heading_std_rad: float = 0.017453292519943295) -> UsvReading:
        """
        A compass heading.
        """
    def update_position(self, position_m: ArrayLike, gnss_std_m: ArrayLike = [8.0, 7.0]) -> UsvReading:
        """
        A GNSS position [north, east].
        """
    def update_rate_of_turn(self, rate_rad_s: float, gyro_rad_s: float, rate_std_rad_s: float = 0.0017453292519943296) -> UsvReading:
        """
        A rate of turn at the time of a reading of the IMU's gyro; 7 or 8 states.
        """
    def update_speed(self, speed_mps: float, speed_std_mps: float = 0.1) -> UsvReading:
        """
        A speed through water by the log; 7 states.
        """
    def update_velocity(self, velocity_mps: ArrayLike, velocity_std_mps: float = 0.1) -> UsvReading:
        """
        A velocity over ground [north, east].
        """
    @property
    def estimate(self) -> Gaussian:
        """
        The belief, a Gaussian.
        """
    @property
    def started(self) -> bool:
        ...
class WaypointGuidance:
    """
    How a vessel follows its waypoints.
    
    Parameters
    ----------
    speed_mps : float, default 1.0
        Speed through the water, from which the correction for the current follows. In m/s, 1e-9 to 1e6.
    turn_rate_rad_s : float, default 0.0872665
        Largest rate of turn. In rad/s, 1e-9 to 1000.
    accept_m : float, default 10.0
        A waypoint closer than this is reached. Above the radius of the largest turn, or a vessel that misses the waypoint may circle around it. In m, 1e-9 to 1e9.
    clearance_m : float, default 10.0
        Distance that is kept from the edge of an obstacle. In m, 0 to 1e9.
    """
    @staticmethod
    def fields() -> tuple[tuple[str, type, object, str, str, str], ...]:
        """
        The table of its fields: name, type, default, unit, rule and a sentence on each.
        """
    def __copy__(self) -> WaypointGuidance:
        ...
    def __deepcopy__(self, memo: dict) -> WaypointGuidance:
        ...
    def __eq__(self, other: object) -> bool:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, speed_mps: float = 1.0, turn_rate_rad_s: float = 0.08726646259971647, accept_m: float = 10.0, clearance_m: float = 10.0) -> None:
        ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        The values by name.
        """
    @property
    def accept_m(self) -> float:
        """
        A waypoint closer than this is reached. Above the radius of the largest turn, or a vessel that misses the waypoint may circle around it. In m, 1e-9 to 1e9. Default 10.0.
        """
    @property
    def clearance_m(self) -> float:
        """
        Distance that is kept from the edge of an obstacle. In m, 0 to 1e9. Default 10.0.
        """
    @property
    def speed_mps(self) -> float:
        """
        Speed through the water, from which the correction for the current follows. In m/s, 1e-9 to 1e6. Default 1.0.
        """
    @property
    def turn_rate_rad_s(self) -> float:
        """
        Largest rate of turn. In rad/s, 1e-9 to 1000. Default 0.0872665.
        """
class Steering:
    """
    Commands for one step; every array has the shape (...) of the vessels.
    """
    def __getstate__(self) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    @property
    def cross_track_m(self) -> NDArray[np.float64]:
        """
        Distance from the line of the leg, positive to starboard.
        """
    @property
    def heading_rad(self) -> NDArray[np.float64]:
        """
        Heading to be steered.
        """
    @property
    def leg(self) -> NDArray[np.int64]:
        """
        Leg that is followed; the number of legs after the last waypoint.
        """
    @property
    def turn_rate_rad_s(self) -> NDArray[np.float64]:
        """
        Rate of turn in this step, positive to starboard.
        """
class WaypointFollower:
    """
    Leads vessels along waypoints, around obstacles and against the current.
    
    In each step a vessel turns by clip(wrap(heading to steer - heading), -w T, w T), w the largest rate
    of turn. The heading to steer is the bearing of the next waypoint or, where the straight line to it
    is too close to an obstacle, of the tangent to the circle of clearance around the nearest such
    obstacle, corrected for the current as far as the speed through the water allows, so that the course
    over ground is that bearing. A waypoint is reached once it is closer than `accept_m`.
    
    It holds the route; the leg, the progress along it, is the caller's, so that one follower serves any
    number of vessels.
    
    Parameters
    ----------
    route_m : (N, 2) array
        [north, east]; the first point is where the route begins, leg k leads from point k to k + 1.
    guidance : WaypointGuidance
    obstacles : (K, 3) array, optional
        Discs to avoid: [north, east, radius] m.
    
    Raises
    ------
    ValueError
        When there are less than two points, a radius is not positive, or a number is not finite.
    
    References
    ----------
    P. S. Evsyukov, O. N. Andreeva, V. V. Khanychev, "Sensor system information processing in unmanned
    navigation applications", the mission and (26).
    """
    def __copy__(self) -> WaypointFollower:
        ...
    def __deepcopy__(self, memo: dict) -> WaypointFollower:
        ...
    def __init__(self, route_m: ArrayLike, guidance: WaypointGuidance = ..., obstacles: ArrayLike | None = None) -> None:
        ...
    def steer(self, position_m: ArrayLike, heading_rad: ArrayLike, current_mps: ArrayLike, dt_s: float, leg: ArrayLike) -> Steering:
        """
        The commands for a step, from estimates of position, heading and current.
        
        Parameters
        ----------
        position_m : (..., 2) array
            [north, east].
        heading_rad : (...) array
        current_mps : (..., 2) array
            [north, east]; zero where it is not known.
        dt_s : float
        leg : (...) array of int
            The leg that was followed last; 0 at the start.
        
        Returns
        -------
        Steering
        
        Raises
        ------
        ValueError
            When shapes do not fit or `dt_s` is not positive.
        FilterError
            When a number is not finite, with the index of the vessel.
        """
    @property
    def guidance(self) -> WaypointGuidance:
        ...
    @property
    def legs(self) -> int:
        """
        number of legs, N - 1
        """
    @property
    def obstacles(self) -> NDArray[np.float64]:
        """
        (K, 3) [north, east, radius] m
        """
    @property
    def route_m(self) -> NDArray[np.float64]:
        """
        (N, 2) [north, east]
        """
class CompassEllipse:
    """
    Hard and soft iron of a magnetic compass.
    
    The field measured along the body [forward, starboard], in any unit, is S [cos ψ, -sin ψ] + b with ψ
    the magnetic heading: over a turn an ellipse.
    
    Parameters
    ----------
    hard_iron : (2,) array
        b, its centre.
    soft_iron : (2, 2) array
        S, symmetric and positive definite: the soft iron times the horizontal field of the earth.
    
    Raises
    ------
    ValueError
        When a number is not finite, or `soft_iron` is not symmetric and positive definite.
    """
    def __copy__(self) -> CompassEllipse:
        ...
    def __deepcopy__(self, memo: dict) -> CompassEllipse:
        ...
    def __init__(self, hard_iron: ArrayLike = [0.0, 0.0], soft_iron: ArrayLike = [[1.0, 0.0], [0.0, 1.0]]) -> None:
        ...
    def field(self, heading_rad: ArrayLike) -> NDArray[np.float64]:
        """
        The fields (..., 2) at magnetic headings (...).
        """
    def heading_rad(self, field: ArrayLike) -> NDArray[np.float64]:
        """
        Magnetic headings (...) in [-pi, pi] of measured fields (..., 2).
        """
    @property
    def hard_iron(self) -> NDArray[np.float64]:
        ...
    @property
    def soft_iron(self) -> NDArray[np.float64]:
        ...
def calibrate_compass(field: ArrayLike) -> tuple[CompassEllipse, float]:
    """
    Hard and soft iron of a compass from the fields that it measures in a turn.
    
    The ellipse of least squared algebraic distance. The turn may have any rate; a whole one is best. A
    rotation of the soft iron, a constant error of all headings, cannot be found in a turn.
    
    Parameters
    ----------
    field : (n, 2) array
        [forward, starboard] in any unit; rows that are not finite are left out.
    
    Returns
    -------
    (ellipse, heading_std_rad)
        A `CompassEllipse`, and the standard deviation that its error gives at the worst heading; a
        short arc shows in it.
    
    Raises
    ------
    ValueError
        When there are less than six readings.
    FilterError
        When they show no ellipse.
    """
def closest_approach(own: ArrayLike, target: ArrayLike, own_covariance: ArrayLike | None = None, target_covariance: ArrayLike | None = None) -> ClosestApproach:
    """
    CPA and TCPA of ships at constant velocity, with their errors.
    
        tcpa = -p·v / |v|²,    d = p·n,    cpa = |d|,
    
    with p and v the position and velocity of the target relative to own ship, n the unit vector to
    starboard of v. At a relative speed of at most 1 µm/s the CPA is the present range and TCPA is 0.
    
    Parameters
    ----------
    own, target : (..., 4) array_like
        [x, vx, y, vy], metres and m/s; leading shapes are broadcast against each other.
    own_covariance, target_covariance : (..., 4, 4) array_like, optional
        Covariances of independent errors; default none.
    
    Returns
    -------
    ClosestApproach
        NaN where a state is NaN.
    
    Raises
    ------
    ValueError
        When a shape does not fit.
    """
def dead_reckon(latitude_rad: ArrayLike, longitude_rad: ArrayLike, speed_mps: ArrayLike, course_rad: ArrayLike, dt_s: ArrayLike, drift_speed_mps: ArrayLike = 0.0, drift_course_rad: ArrayLike = 0.0) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Combined dead reckoning by speed, course and drift; (11).
    
    Parameters
    ----------
    latitude_rad, longitude_rad, speed_mps, course_rad, dt_s, drift_speed_mps, drift_course_rad : array_like
        Broadcast against each other; speed and course through the water.
    
    Returns
    -------
    (latitude_rad, longitude_rad)
        By mid-latitude with the radii of the ellipsoid: within 0.1 m of the rhumb line over 20 km up to
        70 degrees. NaN beyond a pole.
    """
def detection_potential(law: str, sweep_width_m: float, time_s: ArrayLike, unit_m: ArrayLike, object_time_s: ArrayLike, object_m: ArrayLike) -> NDArray[np.float64]:
    """
    -log of the probability that a unit on its route misses each of n drifting objects.
    
    Potentials of several routes add up; the probability of detection is 1 - exp(-potential). A part of
    a pass counts by its share of the potential of the whole pass, exact for the inverse cube law.
    
    Parameters
    ----------
    law : str
        ``definite_range``, ``inverse_cube`` or ``exponential``.
    sweep_width_m : float
    time_s : (K,) array
        Times of the unit's positions; motion is straight in between.
    unit_m : (K, 2) array
        [north, east].
    object_time_s : (T,) array
        Times of the objects' positions, in order; those of the unit are within them.
    object_m : (n, T, 2) array
    
    Returns
    -------
    (n,) array
    
    Raises
    ------
    ValueError
        When the law is unknown, the sweep width is not positive, a shape or a time does not fit.
    """
def drift_between(over_ground: Gaussian, through_water: Gaussian) -> Gaussian:
    """
    Drift from two velocities with independent errors.
    """
def drift_forecast(model: DriftModel, start: Gaussian, dt_s: ArrayLike, wind_mps: ArrayLike, current_mps: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Forecast of the position of a drifting object, as a Gaussian.
    
    Parameters
    ----------
    model : DriftModel
    start : Gaussian
        Over [north, east] m.
    dt_s : float or (T,) array
        Steps.
    wind_mps, current_mps : (2,) or (T, 2) array
        Velocity of air and water in each step, [north, east].
    
    Returns
    -------
    (mean, covariance)
        (T, 2) and (T, 2, 2) after each step, exact for the model.
    """
def drift_from_rates_mps(ground_velocity_mps: ArrayLike, speed_mps: ArrayLike, course_rad: ArrayLike) -> NDArray[np.float64]:
    """
    Velocity over ground (..., 2) minus that through the water, (..., 2).
    """
def drift_particles(model: DriftModel, start: Gaussian, dt_s: ArrayLike, wind_mps: ArrayLike, current_mps: ArrayLike, *, count: int = 1000, seed: int = 0) -> NDArray[np.float64]:
    """
    The same forecast as particles.
    
    Parameters
    ----------
    model, start, dt_s, wind_mps, current_mps
        As for `drift_forecast`.
    count, seed : int
        Particle k of a seed does not depend on the count.
    
    Returns
    -------
    (T, count, 2) array
        [north, east] m after each step.
    """
def geodesic(latitude_rad: ArrayLike, longitude_rad: ArrayLike, to_latitude_rad: ArrayLike, to_longitude_rad: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """
    The shortest line between positions on the WGS84 ellipsoid, within 0.1 mm.
    
    Parameters
    ----------
    latitude_rad, longitude_rad, to_latitude_rad, to_longitude_rad : array_like
        Broadcast against each other.
    
    Returns
    -------
    (distance_m, course_rad, arrival_course_rad)
        Courses clockwise from true north at departure and at the destination. NaN for nearly antipodal
        positions (within about 0.7 degrees), where the series does not converge.
    
    Raises
    ------
    ValueError
        When a latitude is beyond a pole.
    
    References
    ----------
    T. Vincenty, Direct and inverse solutions of geodesics on the ellipsoid, Survey Review XXIII 176, 1975.
    """
def geodesic_destination(latitude_rad: ArrayLike, longitude_rad: ArrayLike, course_rad: ArrayLike, distance_m: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    (latitude_rad, longitude_rad) of the destinations of geodesics with an initial course.
    """
def ground_stabilised_mps(relative_mps: ArrayLike, own_speed_mps: ArrayLike, own_course_rad: ArrayLike, drift_mps: ArrayLike) -> NDArray[np.float64]:
    """
    Velocities of targets over ground (..., 2); zero for a fixed mark.
    """
def ground_velocity_from_marks(relative_velocity_mps: ArrayLike, covariance: ArrayLike) -> Gaussian:
    """
    Own ship's velocity over ground from fixed marks tracked by radar.
    
    Parameters
    ----------
    relative_velocity_mps : (M, 2) array
        Of each mark relative to the ship, [north, east].
    covariance : (M, 2, 2) array
    
    Returns
    -------
    Gaussian
        Minus their mean, weighted by information.
    
    Raises
    ------
    ValueError
        When a covariance is not symmetric positive definite.
    """
def intercept(object: Gaussian, unit_m: ArrayLike, speed_mps: float) -> Intercept:
    """
    Least time in which a unit of a speed meets an object at constant velocity.
    
    Parameters
    ----------
    object : Gaussian
        Over [x, vx, y, vy] in the plane of north and east.
    unit_m : (2,) array
        Present position of the unit in that plane.
    speed_mps : float
    
    Returns
    -------
    Intercept
    
    Raises
    ------
    ValueError
        When a shape does not fit or the speed is not positive.
    """
def leeway_factor(object: FloatingObject) -> tuple[float, float]:
    """
    Minimum and maximum leeway factor of an object; (12).
    """
def leeway_kinds() -> dict[str, typing.Any]:
    """
    Kinds of search objects with a line about each: those of Allen's table, and those of (12).
    """
def leeway_lines(kind: str) -> dict[str, typing.Any]:
    """
    Leeway of a kind of object as lines over the wind speed W.
    
    Each of ``downwind``, ``right`` and ``left`` is (slope, offset_mps, std_slope, std_offset_mps) of
    ``slope W + offset + e (std_slope W + std_offset)``; crosswind components are positive to the right.
    
    Raises
    ------
    ValueError
        When there is no such kind.
    """
def leeway_mps(kind: str, wind_mps: ArrayLike, *, error: ArrayLike, to_right: ArrayLike) -> NDArray[np.float64]:
    """
    Leeway of objects of a kind; Allen and Plourde 1999, Breivik and Allen 2008.
    
    Parameters
    ----------
    kind : str
        One of `leeway_kinds()`.
    wind_mps : (..., 2) array
        Velocity of the air, [north, east].
    error : (..., 2) array
        Standard normal errors [downwind, crosswind] of the objects, which last.
    to_right : (...) array of bool
        Whether each drifts to the right of the wind direction, else to the left.
    
    Returns
    -------
    (..., 2) array
        Velocity through the water, [north, east]; zero in a calm.
    
    Raises
    ------
    ValueError
        When there is no such kind, or the shapes do not fit.
    """
def over_ground(through_water: ArrayLike, drift: ArrayLike) -> NDArray[np.float64]:
    """
    Motion over ground: the vector sum of motion through the water and drift; (3), (4) for accelerations.
    
    Parameters
    ----------
    through_water, drift : (..., 2) array
        [north, east], both in m/s or both in m/s²; broadcast against each other.
    
    Returns
    -------
    (..., 2) array
        [north, east], in the same unit.
    
    Raises
    ------
    ValueError
        When an argument does not have pairs, or the shapes do not fit.
    """
def parallel_track_pod(law: str, coverage: ArrayLike) -> NDArray[np.float64]:
    """
    Probability of detection (POD) in an area swept by even parallel tracks.
    
    Coverage C is sweep width / track spacing: min(1, C) for ``definite_range``, erf(sqrt(pi) C / 2) for
    ``inverse_cube``, the mean over the area for ``exponential``.
    """
def pass_probability(law: str, lateral_range_m: ArrayLike, sweep_width_m: ArrayLike) -> NDArray[np.float64]:
    """
    Probability of detection of an object that a unit passes on a straight line; Koopman.
    
    With x the lateral range and W the sweep width: ``definite_range`` 1 up to W/2, ``inverse_cube``
    1 - exp(-W²/(4 pi x²)), ``exponential`` exp(-2 |x|/W). The integral over x is W.
    """
def predict_course_rad(course_rad: ArrayLike, turn_rate_rad_s: ArrayLike, dt_s: ArrayLike, turn_acceleration_rad_s2: ArrayLike = 0.0) -> NDArray[np.float64]:
    """
    K + w t + a t² / 2 in 0 .. 2 pi; (5), (10).
    """
def predict_latitude_rad(latitude_rad: ArrayLike, rate_rad_s: ArrayLike, dt_s: ArrayLike) -> NDArray[np.float64]:
    """
    Not across a pole; (6).
    """
def predict_longitude_rad(longitude_rad: ArrayLike, rate_rad_s: ArrayLike, dt_s: ArrayLike) -> NDArray[np.float64]:
    """
    In -pi .. pi; (6).
    """
def predict_position_m(position_m: ArrayLike, velocity_mps: ArrayLike, dt_s: ArrayLike, acceleration_mps2: ArrayLike = ...) -> NDArray[np.float64]:
    """
    Positions (..., 2) after steps dt_s (...): p + v t + a t² / 2; (1), (2).
    """
def predict_speed_mps(speed_mps: ArrayLike, acceleration_mps2: ArrayLike, dt_s: ArrayLike) -> NDArray[np.float64]:
    """
    v + a t; (5).
    """
def predict_turn_rate_rad_s(turn_rate_rad_s: ArrayLike, turn_acceleration_rad_s2: ArrayLike, dt_s: ArrayLike) -> NDArray[np.float64]:
    """
    w + a t; (9).
    """
def random_search_pod(coverage: ArrayLike) -> NDArray[np.float64]:
    """
    POD of random search with a coverage C: 1 - exp(-C), of any law.
    """
def rhumb_destination(latitude_rad: ArrayLike, longitude_rad: ArrayLike, course_rad: ArrayLike, distance_m: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    (latitude_rad, longitude_rad) of the destinations of rhumb lines; NaN beyond a pole.
    """
def rhumb_line(latitude_rad: ArrayLike, longitude_rad: ArrayLike, to_latitude_rad: ArrayLike, to_longitude_rad: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    (distance_m, course_rad) of lines of constant course on the ellipsoid, in the shorter direction; to or from a pole along the meridian.
    """
def sea_stabilised_mps(relative_mps: ArrayLike, own_speed_mps: ArrayLike, own_course_rad: ArrayLike) -> NDArray[np.float64]:
    """
    Velocities of targets through the water (..., 2) from those relative to own ship and own ship's by log and compass.
    """
def speed_course(velocity_mps: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    (speed_mps, course_rad) of [north, east] (..., 2).
    """
def step_navigators(navigators: Sequence[UsvNavigator], dt_s: float, imu: ArrayLike, gnss: ArrayLike, compass: ArrayLike, *, gnss_std_m: ArrayLike = [8.0, 7.0], compass_std_rad: float = 0.017453292519943295) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    One step of many navigators: `predict`, then the readings at the end of the step.
    
    A simulation in closed loop steps all its runs at once with it; a log as a whole is the work of
    `UsvNavigator.run`, which gives the same beliefs.
    
    Parameters
    ----------
    navigators : sequence of UsvNavigator
        R started navigators with the same number N of states.
    dt_s : float
    imu : (R, 3) array
        Means over the step: [forward m/s², starboard m/s², yaw rate rad/s].
    gnss : (R, 2) array
        Positions m, [north, east].
    compass : (R,) array
        Headings rad.
    gnss_std_m, compass_std_rad : float
        Standard deviations; that of gnss is [north, east].
    
    In every array a row that is not finite is a missing reading.
    
    Returns
    -------
    (mean, covariance)
        (R, N) and (R, N, N).
    
    Raises
    ------
    ValueError
        When shapes do not fit, or the navigators differ in the number of states.
    FilterError
        When a navigator was not started, or a step fails; those before it have made their step.
    """
def stokes_drift_mps(wave_height_m: ArrayLike, wave_length_m: ArrayLike) -> NDArray[np.float64]:
    """
    Speed of the surface drift with waves in deep water, in their direction; height from trough to crest; (15).
    """
def velocity_from_rates_mps(latitude_rate_rad_s: ArrayLike, longitude_rate_rad_s: ArrayLike, latitude_rad: ArrayLike) -> NDArray[np.float64]:
    """
    [north, east] (..., 2) of rates of latitude and longitude, on the ellipsoid; (8).
    """
def velocity_mps(speed_mps: ArrayLike, course_rad: ArrayLike) -> NDArray[np.float64]:
    """
    [north, east] (..., 2) of speeds and courses.
    """
def velocity_over_window_mps(time_s: ArrayLike, latitude_rad: ArrayLike, longitude_rad: ArrayLike) -> NDArray[np.float64]:
    """
    Velocity over ground of a vessel on a rhumb line, by least squares from its first position; (7).
    
    Parameters
    ----------
    time_s, latitude_rad, longitude_rad : (N,) array
        The window.
    
    Returns
    -------
    (2,) array
        [north, east] m/s; NaN with fewer than two times.
    """
def water_velocity(speed_mps: float, heading_rad: float, *, log_std_mps: float, heading_std_rad: float) -> Gaussian:
    """
    Velocity through the water by log and compass, with the covariance of their errors.
    """
def wind_current_factor(wind_mps: ArrayLike) -> NDArray[np.float64]:
    """
    The factor k of (14) by the wind speed: 0.04 at 2 m/s, 0.012 at 20 m/s, a power law between.
    """
def wind_current_mps(wind_mps: ArrayLike, latitude_rad: ArrayLike, *, factor: ArrayLike = 0.0127) -> NDArray[np.float64]:
    """
    The surface current of a steady wind; (14).
    
    ``V = k U / sqrt(sin |latitude|)``, 45 degrees to the right of the wind in the northern hemisphere, to the left in the southern.
    
    Parameters
    ----------
    wind_mps : (..., 2) array
        Direction and speed to which the wind blows, [north, east].
    latitude_rad : array_like
    factor : array_like
        k; observed values are from 0.04 (wind of 2 m/s) to 0.012 (20 m/s), see wind_current_factor.
    
    Returns
    -------
    (..., 2) array
        [north, east] of the current.
    
    Raises
    ------
    ValueError
        Less than 20 degrees from the equator, where the formula is invalid.
    """
def wind_drift_mps(wind_mps: ArrayLike, factor: ArrayLike) -> NDArray[np.float64]:
    """
    Drift (..., 2) of an object in a wind that blows to [north, east] (..., 2); (12), (13).
    """
