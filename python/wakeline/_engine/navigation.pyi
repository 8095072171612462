"""
Places on the earth, dead reckoning, leeway and drift.
"""

import typing

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .core import Gaussian, Step

__all__ = [
    "ClosestApproach",
    "DriftModel",
    "DriftWindow",
    "FloatingObject",
    "LocalPlane",
    "TotalDrift",
    "UncertaintyEllipse",
    "UsvNavigator",
    "UsvReading",
    "UsvRun",
    "closest_approach",
    "dead_reckon",
    "drift_between",
    "drift_forecast",
    "drift_from_rates_mps",
    "drift_particles",
    "geodesic",
    "geodesic_destination",
    "ground_stabilised_mps",
    "ground_velocity_from_marks",
    "leeway_factor",
    "over_ground",
    "predict_course_rad",
    "predict_latitude_rad",
    "predict_longitude_rad",
    "predict_position_m",
    "predict_speed_mps",
    "predict_turn_rate_rad_s",
    "rhumb_destination",
    "rhumb_line",
    "sea_stabilised_mps",
    "speed_course",
    "stokes_drift_mps",
    "velocity_from_rates_mps",
    "velocity_mps",
    "velocity_over_window_mps",
    "water_velocity",
    "wind_current_mps",
    "wind_drift_mps",
]

class LocalPlane:
    """
    The plane of north and east about a place.

    Distance and course from the reference along the geodesic, as polar coordinates (the azimuthal equidistant projection): what is
    measured from the reference is true to 0.1 mm. Across, at a distance d, the plane is stretched by d² / (6 R²): 1e-5 at 50 km, 4e-5 at
    100 km.

    Parameters
    ----------
    latitude_rad, longitude_rad : float
        The reference.

    Raises
    ------
    ValueError
        When it is not on the earth.
    """
    def __copy__(self) -> LocalPlane: ...
    def __deepcopy__(self, memo: dict) -> LocalPlane: ...
    def __init__(self, latitude_rad: float, longitude_rad: float) -> None: ...
    def place(self, position_m: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """
        (latitude_rad, longitude_rad) (...) at [north, east] (..., 2).
        """
    def plane_course_rad(
        self, true_course_rad: ArrayLike, latitude_rad: ArrayLike, longitude_rad: ArrayLike
    ) -> NDArray[np.float64]:
        """
        Directions on the plane of courses from true north at places: meridians lean towards each other.
        """
    def position_m(self, latitude_rad: ArrayLike, longitude_rad: ArrayLike) -> NDArray[np.float64]:
        """
        [north, east] (..., 2) of places (...); NaN on the other side of the earth.
        """
    def true_course_rad(
        self, plane_course_rad: ArrayLike, latitude_rad: ArrayLike, longitude_rad: ArrayLike
    ) -> NDArray[np.float64]:
        """
        Courses from true north at places of directions on the plane.
        """
    @property
    def latitude_rad(self) -> float: ...
    @property
    def longitude_rad(self) -> float: ...

class TotalDrift:
    """
    What carries a vessel besides her engine; (3).

    Parameters
    ----------
    wind_drift_mps, current_mps, residual_mps : (2,) array
        [north, east] m/s of leeway, of the current of tide, wind and waves, and of what is left
        unexplained.

    Raises
    ------
    ValueError
        When one is not a pair.
    """
    def __init__(
        self,
        wind_drift_mps: ArrayLike = ...,
        current_mps: ArrayLike = ...,
        residual_mps: ArrayLike = ...,
    ) -> None: ...
    def velocity_mps(self) -> NDArray[np.float64]:
        """
        Their sum, [north, east] m/s.
        """
    @property
    def current_mps(self) -> NDArray[np.float64]: ...
    @property
    def residual_mps(self) -> NDArray[np.float64]: ...
    @property
    def wind_drift_mps(self) -> NDArray[np.float64]: ...

class FloatingObject:
    """
    What floats.

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
    def __eq__(self, other: FloatingObject) -> bool: ...
    @typing.overload
    def __eq__(self, other: object) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: int) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: FloatingObject) -> bool: ...
    @typing.overload
    def __ne__(self, other: object) -> bool: ...
    def __setstate__(self, state: int) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class DriftWindow:
    """
    The drift of a vessel over a sliding window of fixes; (16)-(20).

    The slope of the line through the differences of observed and reckoned positions, by least squares, with its covariance. The
    differences err by the fixes and by what log and compass sum up to in between, each reading independently of the one before; with no
    error of log and compass the line is the plain one. A lasting error of the log or the compass counts as drift.

    Parameters
    ----------
    max_fixes : int
        That are remembered, 2 to 32.
    log_std_mps, heading_std_rad : float
        Errors of one reading of the log and of the compass.

    Raises
    ------
    ValueError
        When a setting makes no sense.
    """
    def __copy__(self) -> DriftWindow: ...
    def __deepcopy__(self, memo: dict) -> DriftWindow: ...
    def __init__(
        self, *, max_fixes: int = 20, log_std_mps: float = 0.0, heading_std_rad: float = 0.0
    ) -> None: ...
    def add(self, fix: Gaussian) -> None:
        """
        Takes a fix of the present time, [north, east] m on a plane.
        """
    def advance(self, dt_s: float, speed_mps: float, heading_rad: float) -> None:
        """
        Lets time pass at a speed through the water and a heading.
        """
    def clear(self) -> None:
        """
        Forgets all fixes: after an alteration, where drift is wanted on the new course alone.
        """
    def drift(self) -> Gaussian:
        """
        [north, east] m/s; zero with an infinite covariance until `ready`.
        """
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def run(
        self,
        dt_s: ArrayLike,
        speed_mps: ArrayLike,
        heading_rad: ArrayLike,
        fix_m: ArrayLike,
        fix_std_m: ArrayLike,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """
        The drift after each of a series of fixes, from the first one on.

        Parameters
        ----------
        dt_s, speed_mps, heading_rad : float or (T,) array
            The step to a fix and what log and compass have said in it; the first step means nothing.
        fix_m : (T, 2) array
            NaN where a fix is missing.
        fix_std_m : float or (T,) array
            Error of a fix per axis.

        Returns
        -------
        (mean, covariance)
            (T, 2) and (T, 2, 2), as `drift`.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """
    @property
    def ready(self) -> bool:
        """
        whether there are two fixes of different times
        """
    @property
    def size(self) -> int:
        """
        fixes that are remembered
        """

class DriftModel:
    """
    How an object drifts: v = k U + C + r, U the wind, C the current, and what is not known of them.

    Parameters
    ----------
    leeway, leeway_std : float
        k and its error, which stays the same during a forecast; those of a dinghy by default.
    wind_std_mps, current_std_mps : float
        Errors per axis that last.
    residual_std_mps, residual_time_s : float
        Of r per axis, which wanders (Gauss-Markov) with a correlation time.

    Raises
    ------
    ValueError
        When one is negative or not finite.
    """
    @staticmethod
    def of(object: FloatingObject) -> DriftModel:
        """
        With the leeway of a kind of object, the rest by default.
        """
    def __copy__(self) -> DriftModel: ...
    def __deepcopy__(self, memo: dict) -> DriftModel: ...
    def __init__(
        self,
        *,
        leeway: float = 0.0385,
        leeway_std: float = 0.00375,
        wind_std_mps: float = 1.5,
        current_std_mps: float = 0.1,
        residual_std_mps: float = 0.05,
        residual_time_s: float = 1800.0,
    ) -> None: ...
    @property
    def current_std_mps(self) -> float: ...
    @property
    def leeway(self) -> float: ...
    @property
    def leeway_std(self) -> float: ...
    @property
    def residual_std_mps(self) -> float: ...
    @property
    def residual_time_s(self) -> float: ...
    @property
    def wind_std_mps(self) -> float: ...

class UncertaintyEllipse:
    """
    The area that holds a Gaussian position with a probability.
    """
    def __init__(self, covariance: ArrayLike, probability: float = 0.95) -> None: ...
    @property
    def area_m2(self) -> float: ...
    @property
    def major_axis_rad(self) -> float:
        """
        direction of the long axis, 0 .. pi clockwise from north
        """
    @property
    def semi_major_m(self) -> float: ...
    @property
    def semi_minor_m(self) -> float: ...

class ClosestApproach:
    """
    Closest approaches of pairs of ships; every array has the shape (...) of the pairs.
    """
    def __getstate__(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def __setstate__(self, arg0: tuple) -> None: ...
    def probability(self, limit_m: float, horizon_s: float = ...) -> NDArray[np.float64]:
        """
        Probability that the ships come closer than a limit L between now and a horizon H: that
        |p + v t| < L at some t, 0 <= t <= H, p and v of their joint Gaussian, near relative rest, too. Two
        ships that are known to be at rest are as close as they are now. Beside many draws it is off by
        0.004 in the mean square; by more than 0.02 seldom, but in one of thirty cases where the target is
        now within a tenth of the limit; by 0.08 at most, but that a target whose place is known, closer
        than a hundredth outside the limit, has up to 0.15 too little.

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
        The same, positive where the ships pass port to port along their relative motion.
        """
    @property
    def tcpa_s(self) -> NDArray[np.float64]:
        """
        Time until the closest point; negative when it is past, 0 at relative rest.
        """
    @property
    def tcpa_std_s(self) -> NDArray[np.float64]:
        """
        Standard deviation of tcpa_s, of first order.
        """

class UsvReading(Step):
    """
    What a reading has done to the navigator; true where it was taken.
    """
    def __getstate__(self) -> tuple[tuple, bool, bool]: ...
    def __setstate__(self, arg0: tuple) -> None: ...
    @property
    def rejected(self) -> bool:
        """
        outside the gate: the belief is as it was
        """
    @property
    def widened(self) -> bool:
        """
        outside the gate, but believed after too many rejections in a row
        """

class UsvRun:
    """
    What `UsvNavigator.run` returns.
    """
    def __getstate__(
        self,
    ) -> tuple[
        NDArray[np.float64],
        NDArray[np.float64],
        dict[str, NDArray[np.float64]],
        dict[str, NDArray[np.bool_]],
    ]: ...
    def __setstate__(self, arg0: tuple) -> None: ...
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
        by sensor: (T,) normalised innovations squared, NaN without a reading
        """
    @property
    def rejected(self) -> dict[str, NDArray[np.bool_]]:
        """
        by sensor: (T,) True for a rejected outlier
        """

class UsvNavigator:
    """
    Own ship's position, motion and heading by IMU, GNSS, compass and log.

    States are [north, east, v_north, v_east, heading] for 5, the same with the biases [forward,
    starboard, gyro] behind for 8, and [north, east, heading, speed through water, gyro bias, current
    north, current east] for 7, which does not use the accelerometer. Metres, seconds, radians; headings
    in [-pi, pi].

    A reading whose NIS is outside the gate is rejected. When more than `rejections` of one sensor in a
    row were, it is the belief that is widened, and the reading is taken, unless it is more than a
    million standard deviations off, or positions that are believed meanwhile refute it. Then velocities
    stay rejected, and compass and log may move the current alone, but not beyond what `current_std_mps`
    lets expect, unless it was stronger before. Headings that are believed refute rates of turn.

    Every position given is one to it: it does not find that a receiver froze. `recording.read_nmea`
    marks such fixes in a log.

    Parameters
    ----------
    states : {5, 7, 8}
    filter : {'ekf', 'ukf', 'augmented_ukf'}
        The extended filter and the unscented one, whose noise of the IMU is added to the covariance, or
        the unscented one that moves it through the motion as sigma points of its own. All agree where
        turns between readings are small.
    acceleration_std_mps2, yaw_rate_std_rad_s : float
        Noise of a reading of the IMU, held over a step.
    unmeasured_acceleration_std_mps2, unmeasured_yaw_rate_std_rad_s : float
        What the ship may do in a step without a reading of the IMU.
    acceleration_bias_std_mps2, gyro_bias_std_rad_s, current_std_mps : float
        Of biases and current (per axis) at the start, which are zero with these deviations.
    speed_walk_mps, current_walk_mps : float
        What speed through water and current gain in 1 s, of 7 states.
    turned_at : float
        Where in a step the heading is taken that turns its acceleration, of 5 and 8 states: 0.5 is its
        middle, 0 its start, as in the paper.
    gate_probability : float
        That a good reading is inside the gate.
    rejections : int
        In a row, before a reading is believed nevertheless; of 0 all are, and nothing is refuted.
    alpha, beta, kappa : float
        Of the unscented transforms.

    Raises
    ------
    ValueError
        When a parameter makes no sense.
    """
    def __copy__(self) -> UsvNavigator: ...
    def __deepcopy__(self, memo: dict) -> UsvNavigator: ...
    def __init__(
        self,
        states: int = 8,
        filter: str = "ekf",
        *,
        acceleration_std_mps2: float = 0.004,
        yaw_rate_std_rad_s: float = 0.0005759586531581288,
        unmeasured_acceleration_std_mps2: float = 0.1,
        unmeasured_yaw_rate_std_rad_s: float = 0.03490658503988659,
        acceleration_bias_std_mps2: float = 0.05,
        gyro_bias_std_rad_s: float = 0.008726646259971648,
        current_std_mps: float = 0.5,
        speed_walk_mps: float = 0.03,
        current_walk_mps: float = 0.002,
        turned_at: float = 0.5,
        gate_probability: float = 0.999,
        rejections: int = 10,
        alpha: float = 1.0,
        beta: float = 2.0,
        kappa: float = 0.0,
    ) -> None: ...
    def predict(self, dt_s: float, imu: ArrayLike | None = None) -> None:
        """
        A step under a reading of the IMU [forward m/s², starboard m/s², yaw rate rad/s], or without one.
        """
    def restore(self, state: bytes) -> None:
        """
        Goes on bit for bit where the saved one was.
        """
    def run(
        self,
        time_s: ArrayLike,
        imu: ArrayLike | None = None,
        gnss: ArrayLike | None = None,
        compass: ArrayLike | None = None,
        *,
        velocity: ArrayLike | None = None,
        log: ArrayLike | None = None,
        rate_of_turn: ArrayLike | None = None,
        imu_std: ArrayLike | None = None,
        gnss_std_m: ArrayLike = [8.0, 7.0],
        compass_std_rad: float = 0.017453292519943295,
        velocity_std_mps: float = 0.1,
        log_std_mps: float = 0.1,
        rate_of_turn_std_rad_s: float = 0.0017453292519943296,
        smooth: bool = False,
    ) -> UsvRun:
        """
        Navigates along a log, from the belief as it is, which is that of `time_s[0]`.

        Parameters
        ----------
        time_s : (T,) array
            Not decreasing.
        imu : (T, 3) array, optional
            Row k is the mean from time k - 1 to time k: [forward m/s², starboard m/s², yaw rate rad/s].
        gnss, velocity : (T, 2) array, optional
            Position m and velocity over ground m/s, [north, east].
        compass, log, rate_of_turn : (T,) array, optional
            Heading rad, speed through water m/s (7 states), rate of turn rad/s (7 or 8 states) beside the
            gyro of `imu`, without whose row it is no reading.
        imu_std : (T, 2) array, optional
            Row k is the noise from time k - 1 to time k of [acceleration m/s², yaw rate rad/s], measured or
            not, in place of the navigator's.
        gnss_std_m, compass_std_rad, velocity_std_mps, log_std_mps, rate_of_turn_std_rad_s : float
            Standard deviations; that of gnss is [north, east].
        smooth : bool
            Whether the beliefs returned know the readings after them, too, up to one for which the belief
            was widened: nothing is known across it.

        In every array a row that is not finite is no reading; without one of the IMU, the ship coasts.

        Returns
        -------
        UsvRun

        Raises
        ------
        ValueError
            When shapes do not fit, times decrease, a sensor needs a state that is not there, or
            `rate_of_turn` comes without `imu`.
        FilterError
            When the navigator was not started, or a row makes a step fail; the navigator is as it was then.
        """
    def save(self) -> bytes:
        """
        What it knows as bytes, for one that is made alike, on the same kind of machine.
        """
    def start(
        self,
        position_m: ArrayLike,
        velocity_mps: ArrayLike,
        heading_rad: float,
        *,
        position_std_m: ArrayLike = [8.0, 7.0],
        velocity_std_mps: float = 0.5,
        heading_std_rad: float = 0.017453292519943295,
    ) -> None:
        """
        Begins at [north, east] m with a velocity over ground [north, east] m/s and a heading.
        """
    def update_heading(
        self, heading_rad: float, heading_std_rad: float = 0.017453292519943295
    ) -> UsvReading:
        """
        A compass heading.
        """
    def update_position(
        self, position_m: ArrayLike, gnss_std_m: ArrayLike = [8.0, 7.0]
    ) -> UsvReading:
        """
        A GNSS position [north, east].
        """
    def update_rate_of_turn(
        self, rate_rad_s: float, gyro_rad_s: float, rate_std_rad_s: float = 0.0017453292519943296
    ) -> UsvReading:
        """
        A rate of turn beside that of the IMU's gyro at the time; 7 or 8 states.
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
    def started(self) -> bool: ...

def closest_approach(
    own: ArrayLike,
    target: ArrayLike,
    own_covariance: ArrayLike | None = None,
    target_covariance: ArrayLike | None = None,
) -> ClosestApproach:
    """
    Where and when ships that hold course and speed are closest: CPA and TCPA with their errors.

        tcpa = -p·v / |v|²,    d = p·n,    cpa = |d|,

    p and v the position and velocity of the target relative to own ship, n the unit vector to starboard
    of v. At a relative speed of 1 µm/s or less the range now is the CPA and TCPA is 0.

    Parameters
    ----------
    own, target : (..., 4) array_like
        [x, vx, y, vy], metres and m/s; leading shapes are broadcast against each other.
    own_covariance, target_covariance : (..., 4, 4) array_like, optional
        Errors, independent of each other; none by default.

    Returns
    -------
    ClosestApproach
        NaN where a state is NaN.

    Raises
    ------
    ValueError
        When a shape does not fit.
    """

def dead_reckon(
    latitude_rad: ArrayLike,
    longitude_rad: ArrayLike,
    speed_mps: ArrayLike,
    course_rad: ArrayLike,
    dt_s: ArrayLike,
    drift_speed_mps: ArrayLike = 0.0,
    drift_course_rad: ArrayLike = 0.0,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Combined dead reckoning by speed, course and drift; (11).

    Parameters
    ----------
    latitude_rad, longitude_rad, speed_mps, course_rad, dt_s, drift_speed_mps, drift_course_rad : array_like
        Broadcast against each other; speed and course through the water.

    Returns
    -------
    (latitude_rad, longitude_rad)
        In mid-latitude with the radii of the ellipsoid: within 0.1 m of the rhumb line over 20 km up to
        70 degrees. NaN beyond a pole.
    """

def drift_between(over_ground: Gaussian, through_water: Gaussian) -> Gaussian:
    """
    Drift of velocities that err independently.
    """

def drift_forecast(
    model: DriftModel, start: Gaussian, dt_s: ArrayLike, wind_mps: ArrayLike, current_mps: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Where an object that is left to wind and current will be, as a Gaussian that grows.

    Parameters
    ----------
    model : DriftModel
    start : Gaussian
        Over [north, east] m.
    dt_s : float or (T,) array
        Steps.
    wind_mps, current_mps : (2,) or (T, 2) array
        During each step: where the air and the water go, [north, east].

    Returns
    -------
    (mean, covariance)
        (T, 2) and (T, 2, 2) after each step, exact for the model.
    """

def drift_from_rates_mps(
    ground_velocity_mps: ArrayLike, speed_mps: ArrayLike, course_rad: ArrayLike
) -> NDArray[np.float64]:
    """
    Velocity over ground (..., 2) less that through the water, (..., 2).
    """

def drift_particles(
    model: DriftModel,
    start: Gaussian,
    dt_s: ArrayLike,
    wind_mps: ArrayLike,
    current_mps: ArrayLike,
    *,
    count: int = 1000,
    seed: int = 0,
) -> NDArray[np.float64]:
    """
    The same forecast as a cloud of objects that might be the one adrift.

    Parameters
    ----------
    model, start, dt_s, wind_mps, current_mps
        As for `drift_forecast`.
    count, seed : int
        The same seed gives the same objects, however many there are.

    Returns
    -------
    (T, count, 2) array
        [north, east] m after each step.
    """

def geodesic(
    latitude_rad: ArrayLike,
    longitude_rad: ArrayLike,
    to_latitude_rad: ArrayLike,
    to_longitude_rad: ArrayLike,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """
    The shortest line between places on the WGS84 ellipsoid, within 0.1 mm.

    Parameters
    ----------
    latitude_rad, longitude_rad, to_latitude_rad, to_longitude_rad : array_like
        Broadcast against each other.

    Returns
    -------
    (distance_m, course_rad, arrival_course_rad)
        Courses clockwise from true north at departure and at the destination. NaN where the places are
        nearly opposite each other on the earth (within about 0.7 degrees) and the series does not
        converge.

    Raises
    ------
    ValueError
        When a latitude is beyond a pole.

    References
    ----------
    T. Vincenty, Direct and inverse solutions of geodesics on the ellipsoid, Survey Review XXIII 176, 1975.
    """

def geodesic_destination(
    latitude_rad: ArrayLike, longitude_rad: ArrayLike, course_rad: ArrayLike, distance_m: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    (latitude_rad, longitude_rad) where geodesics lead that depart on a course.
    """

def ground_stabilised_mps(
    relative_mps: ArrayLike,
    own_speed_mps: ArrayLike,
    own_course_rad: ArrayLike,
    drift_mps: ArrayLike,
) -> NDArray[np.float64]:
    """
    Velocities of targets over ground (..., 2): a mark that lies still has none.
    """

def ground_velocity_from_marks(relative_velocity_mps: ArrayLike, covariance: ArrayLike) -> Gaussian:
    """
    Own velocity over ground by marks that lie still, tracked by radar.

    Parameters
    ----------
    relative_velocity_mps : (M, 2) array
        Of each mark relative to the ship, [north, east].
    covariance : (M, 2, 2) array

    Returns
    -------
    Gaussian
        Minus their mean, each weighed by its information.

    Raises
    ------
    ValueError
        When a covariance is not symmetric positive definite.
    """

def leeway_factor(object: FloatingObject) -> tuple[float, float]:
    """
    Least and greatest share of the wind's speed that an object takes on; (12).
    """

def over_ground(through_water: ArrayLike, drift: ArrayLike) -> NDArray[np.float64]:
    """
    Motion over ground: motion through the water plus drift, as vectors; (3), and (4) of accelerations.

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
        When one is not of pairs, or the shapes do not go together.
    """

def predict_course_rad(
    course_rad: ArrayLike,
    turn_rate_rad_s: ArrayLike,
    dt_s: ArrayLike,
    turn_acceleration_rad_s2: ArrayLike = 0.0,
) -> NDArray[np.float64]:
    """
    K + w t + a t² / 2 in 0 .. 2 pi; (5), (10).
    """

def predict_latitude_rad(
    latitude_rad: ArrayLike, rate_rad_s: ArrayLike, dt_s: ArrayLike
) -> NDArray[np.float64]:
    """
    Not over a pole; (6).
    """

def predict_longitude_rad(
    longitude_rad: ArrayLike, rate_rad_s: ArrayLike, dt_s: ArrayLike
) -> NDArray[np.float64]:
    """
    In -pi .. pi; (6).
    """

def predict_position_m(
    position_m: ArrayLike,
    velocity_mps: ArrayLike,
    dt_s: ArrayLike,
    acceleration_mps2: ArrayLike = ...,
) -> NDArray[np.float64]:
    """
    Positions (..., 2) after steps dt_s (...): p + v t + a t² / 2; (1), (2).
    """

def predict_speed_mps(
    speed_mps: ArrayLike, acceleration_mps2: ArrayLike, dt_s: ArrayLike
) -> NDArray[np.float64]:
    """
    v + a t; (5).
    """

def predict_turn_rate_rad_s(
    turn_rate_rad_s: ArrayLike, turn_acceleration_rad_s2: ArrayLike, dt_s: ArrayLike
) -> NDArray[np.float64]:
    """
    w + a t; (9).
    """

def rhumb_destination(
    latitude_rad: ArrayLike, longitude_rad: ArrayLike, course_rad: ArrayLike, distance_m: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    (latitude_rad, longitude_rad) where lines of constant course lead; NaN beyond a pole.
    """

def rhumb_line(
    latitude_rad: ArrayLike,
    longitude_rad: ArrayLike,
    to_latitude_rad: ArrayLike,
    to_longitude_rad: ArrayLike,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    (distance_m, course_rad) of lines of constant course on the ellipsoid, the shorter way round; to or from a pole along the meridian.
    """

def sea_stabilised_mps(
    relative_mps: ArrayLike, own_speed_mps: ArrayLike, own_course_rad: ArrayLike
) -> NDArray[np.float64]:
    """
    Velocities of targets through the water (..., 2) from those relative to the ship and hers by log and compass.
    """

def speed_course(velocity_mps: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    (speed_mps, course_rad) of [north, east] (..., 2).
    """

def stokes_drift_mps(wave_height_m: ArrayLike, wave_length_m: ArrayLike) -> NDArray[np.float64]:
    """
    Speed of the surface drift with waves in deep water, in their direction; height from trough to crest; (15).
    """

def velocity_from_rates_mps(
    latitude_rate_rad_s: ArrayLike, longitude_rate_rad_s: ArrayLike, latitude_rad: ArrayLike
) -> NDArray[np.float64]:
    """
    [north, east] (..., 2) of rates of latitude and longitude, on the ellipsoid; (8).
    """

def velocity_mps(speed_mps: ArrayLike, course_rad: ArrayLike) -> NDArray[np.float64]:
    """
    [north, east] (..., 2) of speeds and courses.
    """

def velocity_over_window_mps(
    time_s: ArrayLike, latitude_rad: ArrayLike, longitude_rad: ArrayLike
) -> NDArray[np.float64]:
    """
    Velocity over ground of a vessel on a rhumb line, by least squares through her first place; (7).

    Parameters
    ----------
    time_s, latitude_rad, longitude_rad : (N,) array
        The window.

    Returns
    -------
    (2,) array
        [north, east] m/s; NaN unless there are two times.
    """

def water_velocity(
    speed_mps: float, heading_rad: float, *, log_std_mps: float, heading_std_rad: float
) -> Gaussian:
    """
    Velocity through the water by log and compass, with the covariance of their errors.
    """

def wind_current_mps(
    wind_mps: ArrayLike, latitude_rad: ArrayLike, *, factor: float = 0.0127
) -> NDArray[np.float64]:
    """
    The current at the surface that a lasting wind makes; (14).

    ``V = k U / sqrt(sin |latitude|)``, 45 degrees to the right of where the wind blows in the northern hemisphere, to the left in the
    southern.

    Parameters
    ----------
    wind_mps : (..., 2) array
        Where the wind blows to, [north, east].
    latitude_rad : array_like
    factor : float
        k; observed ones lie from 0.04 (wind of 2 m/s) to 0.012 (20 m/s).

    Returns
    -------
    (..., 2) array
        [north, east] of the water.

    Raises
    ------
    ValueError
        Less than 20 degrees from the equator, where the law fails.
    """

def wind_drift_mps(wind_mps: ArrayLike, factor: ArrayLike) -> NDArray[np.float64]:
    """
    Drift (..., 2) of an object in a wind that blows to [north, east] (..., 2); (12), (13).
    """
