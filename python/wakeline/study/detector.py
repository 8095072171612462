"""The baseline of adaptive tracking: detect a maneuver, then switch the filter."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

import wakeline as wl


class DetectThenSwitch:
    """One Kalman filter of constant velocity with two levels of process noise.

    The NIS, summed with a fading memory, decides before each prediction: above an upper bound the
    vessel is taken to maneuver and the noise is high, below a lower one it is low again. Source: Y.
    Bar-Shalom, X. R. Li, T. Kirubarajan, Estimation with Applications to Tracking and Navigation,
    2001, 11.2.2, noise level switching.

    Parameters
    ----------
    quiet_std_mps2, maneuver_std_mps2 : float
        Process noise of each level, an acceleration held over a scan.
    memory : float
        Share of the sum that is kept from scan to scan, below 1; it looks back over 1 / (1 -
        memory) scans.
    detect_probability, quiet_probability : float
        Probabilities of the sum, if the vessel does not maneuver, at which the level goes up and
        down.
    """

    def __init__(
        self,
        quiet_std_mps2: float,
        maneuver_std_mps2: float,
        memory: float,
        detect_probability: float,
        quiet_probability: float,
    ) -> None:
        self.levels_mps2 = np.array([quiet_std_mps2, maneuver_std_mps2])
        self.memory = memory
        # The faded sum of chi-squares of 2 degrees is about a scaled chi-square: its mean is
        # 2 / (1 - memory), its variance 4 / (1 - memory²).
        freedom = 2.0 * (1.0 + memory) / (1.0 - memory)
        self.bounds = np.array(
            [
                wl.chi_square_quantile(probability, round(freedom)) / (1.0 + memory)
                for probability in (quiet_probability, detect_probability)
            ]
        )

    def run(
        self, z: np.ndarray, *, dt_s: float, sensor: Any, start: wl.Gaussian
    ) -> SimpleNamespace:
        """Run plots (R, T, 2) of range and bearing, none missing.

        Returns
        -------
        namespace
            As of an estimator of the engine; ``mode_probability`` (R, T, 2) is 1 for the level.
        """
        runs, scans = z.shape[:2]
        place_m, error_m2 = _converted(z, sensor)
        move = np.kron(np.eye(2), [[1.0, dt_s], [0.0, 1.0]])
        push = np.kron(np.eye(2), [[0.5 * dt_s**2], [dt_s]])
        read = np.kron(np.eye(2), [[1.0, 0.0]])
        mean = np.tile(start.mean, (runs, 1))
        covariance = np.tile(start.covariance, (runs, 1, 1))
        faded, level = np.zeros(runs), np.zeros(runs, int)
        found = SimpleNamespace(
            mean=np.empty((runs, scans, 4)),
            covariance=np.empty((runs, scans, 4, 4)),
            nis=np.empty((runs, scans)),
            status=np.zeros((runs, scans), int),
            mode_probability=np.empty((runs, scans, 2)),
            turn_rate_rad_s=None,
        )
        for k in range(scans):
            noise = self.levels_mps2[level, np.newaxis, np.newaxis] ** 2 * (push @ push.T)
            mean = mean @ move.T
            covariance = move @ covariance @ move.T + noise
            innovation = place_m[:, k] - mean @ read.T
            spread = read @ covariance @ read.T + error_m2[:, k]
            gain = covariance @ read.T @ np.linalg.inv(spread)
            nis = np.einsum("ri,rij,rj->r", innovation, np.linalg.inv(spread), innovation)
            mean = mean + np.einsum("rij,rj->ri", gain, innovation)
            rest = np.eye(4) - gain @ read
            kept = np.swapaxes(gain, -1, -2)
            covariance = (
                rest @ covariance @ np.swapaxes(rest, -1, -2) + gain @ error_m2[:, k] @ kept
            )
            faded = self.memory * faded + nis
            level = np.where(faded > self.bounds[1], 1, np.where(faded < self.bounds[0], 0, level))
            found.mean[:, k], found.covariance[:, k], found.nis[:, k] = mean, covariance, nis
            found.mode_probability[:, k] = np.eye(2)[level]
        return found


def _converted(z: np.ndarray, sensor: Any) -> tuple[np.ndarray, np.ndarray]:
    """Plots north and east (..., 2), and their covariances, by the plain conversion."""
    range_m, bearing = z[..., 0], z[..., 1]
    ahead = np.stack([np.cos(bearing), np.sin(bearing)], axis=-1)
    abeam = np.stack([-ahead[..., 1], ahead[..., 0]], axis=-1)
    across_m = range_m * sensor.bearing_std_rad
    along, across = (axis[..., :, np.newaxis] * axis[..., np.newaxis, :] for axis in (ahead, abeam))
    covariance = sensor.range_std_m**2 * along + across_m[..., np.newaxis, np.newaxis] ** 2 * across
    return range_m[..., np.newaxis] * ahead, covariance
