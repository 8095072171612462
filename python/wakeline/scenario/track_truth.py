"""Truth from a recorded track: interpolated positions with or without velocities."""

from __future__ import annotations

from typing import Any

import numpy as np

from wakeline import filter, motion
from wakeline._brief import brief, many, span
from wakeline._checks import above_zero, at_least, in_a_row, real_numbers
from wakeline.recording import NavigationLog

_TURNING_ABOVE_MPS = 0.5


class TrackTruth:
    """The path between recorded positions: cubic Hermite interpolation.

    Position and velocity are continuous and have the recorded values at the recorded times; the
    acceleration is discontinuous there. A missing velocity is the slope of the parabola through the
    position and its neighbors. Before the first and after the last position the velocity is
    constant.

    Parameters
    ----------
    time_s : array_like (n,)
        Increasing, at least two.
    north_m, east_m : array_like (n,)
    vnorth_mps, veast_mps : array_like (n,), optional
        Recorded velocities; NaN where missing.

    Raises
    ------
    ValueError
        When the shapes do not fit, times do not increase, or a position is not finite.
    """

    def __init__(
        self,
        time_s: np.ndarray,
        north_m: np.ndarray,
        east_m: np.ndarray,
        vnorth_mps: np.ndarray | None = None,
        veast_mps: np.ndarray | None = None,
    ) -> None:
        self._time_s = real_numbers("time_s", time_s)
        if self._time_s.ndim != 1 or len(self._time_s) < 2:
            raise ValueError(f"time_s must have shape (n,), n at least 2, got {self._time_s.shape}")
        if not (np.isfinite(self._time_s).all() and (np.diff(self._time_s) > 0).all()):
            raise ValueError("time_s must be finite and increase")
        place_m = self._column("north_m", north_m) + 1j * self._column("east_m", east_m)
        if not np.isfinite(place_m).all():
            raise ValueError("north_m and east_m must be finite")
        unknown = np.full(len(self._time_s), np.nan)
        vnorth = unknown if vnorth_mps is None else self._column("vnorth_mps", vnorth_mps)
        veast = unknown if veast_mps is None else self._column("veast_mps", veast_mps)
        velocity_mps = vnorth + 1j * veast
        slope_mps = _slopes(self._time_s, place_m)
        self._place_m = place_m
        self._velocity_mps = np.where(np.isfinite(velocity_mps), velocity_mps, slope_mps)

    def __repr__(self) -> str:
        return brief(self, many(len(self._time_s), "position"), span(self._time_s))

    @classmethod
    def of(cls, track: Any) -> TrackTruth:
        """From an object with ``time_s, north_m, east_m, vnorth_mps, veast_mps``.

        An ``AisTrack``, a ``TargetTruth`` or an ``OwnShipMotion`` of :mod:`wakeline.recording`; a
        ``NavigationLog`` gives its `track`, relative to the first valid fix.

        Gaps are interpolated, too. To avoid that, use each of the `parts` of an ``AisTrack`` or a
        ``NavigationLog``.

        Raises
        ------
        ValueError
            As the class, and as `NavigationLog.track`.
        """
        track = _track(track)
        return cls(track.time_s, track.north_m, track.east_m, track.vnorth_mps, track.veast_mps)

    @property
    def start_time_s(self) -> float:
        """Time of the first position."""
        return float(self._time_s[0])

    @property
    def end_time_s(self) -> float:
        """Time of the last position."""
        return float(self._time_s[-1])

    def moved(self, north_m: float, east_m: float) -> TrackTruth:
        """The same track moved by this much north and east."""
        place_m = self._place_m + complex(north_m, east_m)
        velocity = self._velocity_mps
        return TrackTruth(self._time_s, place_m.real, place_m.imag, velocity.real, velocity.imag)

    def state_at(self, time_s: np.ndarray | float) -> np.ndarray:
        """States ``[north, vnorth, east, veast]`` at the given times.

        Parameters
        ----------
        time_s : array_like (T,) or float
            Any times, in any order.

        Returns
        -------
        ndarray (T, 4)
            One row for a single time.

        Raises
        ------
        ValueError
            When the times have more than one axis.
        """
        place_m, velocity_mps, _ = self._motion(time_s)
        return np.column_stack([place_m.real, velocity_mps.real, place_m.imag, velocity_mps.imag])

    def turn_rate_at(self, time_s: np.ndarray | float) -> np.ndarray:
        """Turn rates (T,) of the velocity, rad/s; 0 for a vessel slower than 0.5 m/s."""
        _, velocity_mps, acceleration_mps2 = self._motion(time_s)
        speed_mps = np.abs(velocity_mps)
        across = (np.conj(velocity_mps) * acceleration_mps2).imag
        moving = speed_mps > _TURNING_ABOVE_MPS
        return np.divide(across, speed_mps**2, out=np.zeros(len(across)), where=moving)

    def _motion(self, time_s: np.ndarray | float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Positions, velocities and accelerations (T,) as north + i east."""
        time_s = in_a_row("time_s", time_s)
        last = len(self._time_s) - 1
        k = np.clip(np.searchsorted(self._time_s, time_s, side="right") - 1, 0, last - 1)
        step_s = self._time_s[k + 1] - self._time_s[k]
        u = (time_s - self._time_s[k]) / step_s
        p, q = self._place_m[k], self._place_m[k + 1]
        v, w = self._velocity_mps[k] * step_s, self._velocity_mps[k + 1] * step_s
        bend, twist = 3 * (q - p) - 2 * v - w, 2 * (p - q) + v + w
        place_m = p + u * (v + u * (bend + u * twist))
        velocity_mps = (v + u * (2 * bend + u * 3 * twist)) / step_s
        acceleration_mps2 = (2 * bend + u * 6 * twist) / step_s**2
        for outside, end in ((time_s < self._time_s[0], 0), (time_s > self._time_s[-1], last)):
            beyond_s = (time_s - self._time_s[end])[outside]
            place_m[outside] = self._place_m[end] + self._velocity_mps[end] * beyond_s
            velocity_mps[outside] = self._velocity_mps[end]
            acceleration_mps2[outside] = 0.0
        return place_m, velocity_mps, acceleration_mps2

    def _column(self, name: str, values: np.ndarray) -> np.ndarray:
        values = real_numbers(name, values)
        if values.shape != self._time_s.shape:
            raise ValueError(f"{name} must have shape {self._time_s.shape}, got {values.shape}")
        return values


def _track(recorded: Any) -> Any:
    return recorded.track() if isinstance(recorded, NavigationLog) else recorded


def _slopes(time_s: np.ndarray, place_m: np.ndarray) -> np.ndarray:
    """Slope at each point of the parabola through it and its neighbors; of the line for two."""
    step_s = np.diff(time_s)
    mean_mps = np.diff(place_m) / step_s
    if len(mean_mps) == 1:
        return np.repeat(mean_mps, 2)
    before, after = step_s[:-1], step_s[1:]
    middle = (after * mean_mps[:-1] + before * mean_mps[1:]) / (before + after)
    first = 2 * mean_mps[0] - middle[0]
    last = 2 * mean_mps[-1] - middle[-1]
    return np.concatenate([[first], middle, [last]])


def smoothed(
    track: Any,
    *,
    position_std_m: float = 5.0,
    delay_std_s: float = 1.0,
    velocity_std_mps: float = 0.3,
    accel_psd_m2s3: float = 0.05,
) -> TrackTruth:
    """The most probable path of a vessel from reports with errors, such as AIS.

    The motion model is white acceleration. A report has an isotropic position error, an error along
    the course from its delay, and a velocity error. A Kalman filter and a Rauch-Tung-Striebel
    smoother estimate the states at the reports; cubic Hermite interpolation gives the most probable
    path between them.

    Parameters
    ----------
    track : object
        As of :meth:`TrackTruth.of`; at least two reports.
    position_std_m : float
        Standard deviation of a position per axis.
    delay_std_s : float
        Standard deviation of the times; at speed ``v`` it adds ``v`` times this along the course.
    velocity_std_mps : float
        Standard deviation of a reported velocity per axis.
    accel_psd_m2s3 : float
        Power spectral density of the white acceleration per axis.

    Returns
    -------
    TrackTruth

    Raises
    ------
    ValueError
        As :class:`TrackTruth`, and when a parameter is not positive (a delay: negative).
    """
    track = _track(track)
    exact = TrackTruth.of(track)
    above_zero(
        position_std_m=position_std_m,
        velocity_std_mps=velocity_std_mps,
        accel_psd_m2s3=accel_psd_m2s3,
    )
    at_least(0, delay_std_s=delay_std_s)
    reported = np.isfinite(np.asarray(track.vnorth_mps) + np.asarray(track.veast_mps))
    time_s = np.asarray(track.time_s, dtype=float)
    z = exact.state_at(time_s)
    dt_s = np.diff(time_s, prepend=time_s[0])
    vessel = motion.ConstantVelocity(noise=motion.WhiteAcceleration(psd_m2s3=accel_psd_m2s3))
    means, covariances = [], []
    mean, covariance = z[0], np.diag([1e6, 1e3, 1e6, 1e3])
    for k, step_s in enumerate(dt_s.tolist()):
        f = vessel.matrix(step_s)
        mean, covariance = f @ mean, f @ covariance @ f.T + vessel.process_noise(step_s)
        noise = np.diag([position_std_m**2, velocity_std_mps**2] * 2)
        late_m = delay_std_s * z[k, 1::2]
        noise[0::2, 0::2] += np.outer(late_m, late_m)
        read = [0, 1, 2, 3] if reported[k] else [0, 2]
        innovation_covariance = covariance[np.ix_(read, read)] + noise[np.ix_(read, read)]
        gain = np.linalg.solve(innovation_covariance, covariance[read]).T
        mean = mean + gain @ (z[k] - mean)[read]
        keep = np.eye(4)
        keep[:, read] -= gain
        covariance = keep @ covariance @ keep.T + gain @ noise[np.ix_(read, read)] @ gain.T
        means.append(mean)
        covariances.append(covariance)
    mean, _ = filter.Kalman(vessel).smooth(np.array(means), np.array(covariances), dt_s)
    return TrackTruth(time_s, mean[:, 0], mean[:, 2], mean[:, 1], mean[:, 3])
