"""The estimators of an unmanned vessel's motion that the study compares."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

import wakeline as wl


class Estimator(NamedTuple):
    """A navigator and its options.

    Attributes
    ----------
    states : int
    filter : str
    options : mapping
        Of `wl.UsvNavigator`.
    known_bias : bool
        Whether the biases are subtracted from its IMU's readings.
    smooth : bool
    allow_for_current : bool
        In closed loop: whether the vessel points up into the estimated current.
    correlated : bool
        In closed loop: whether the standard deviation of GNSS allows for errors that are correlated
        in time.
    """

    states: int
    filter: str
    options: Mapping[str, float] = {}
    known_bias: bool = False
    smooth: bool = False
    allow_for_current: bool = True
    correlated: bool = False


# The paper rejects nothing.
_NO_GATE = {"gate_probability": 1.0 - 1e-12, "rejections": 0}
_STEADY = {"speed_walk_mps": 1e-4, "current_walk_mps": 1e-4}
# The paper's figures of the IMU as printed: variances.
_PRINTED = {
    "acceleration_std_mps2": np.sqrt(0.004),
    "yaw_rate_std_rad_s": np.deg2rad(np.sqrt(0.033)),
}

ESTIMATORS = {
    "ukf5_known_bias": Estimator(5, "ukf", known_bias=True),
    "ukf5_no_bias": Estimator(5, "ukf", _NO_GATE),
    "ukf8": Estimator(8, "ukf"),
    "ekf8": Estimator(8, "ekf"),
    "ukf7_current": Estimator(7, "ukf", _STEADY),
    "smoother8": Estimator(8, "ekf", smooth=True),
}
IN_FULL = {
    "ukf5_printed_noise": Estimator(5, "ukf", _PRINTED, known_bias=True),
    "ukf8_turned_at_start": Estimator(8, "ukf", {"turned_at": 0.0}),
    "augmented_ukf8": Estimator(8, "augmented_ukf"),
}


def navigator_of(
    estimator: Estimator, position_m: Any, velocity_mps: Any, heading_rad: float
) -> Any:
    """A started `wl.UsvNavigator`."""
    navigator = wl.UsvNavigator(estimator.states, estimator.filter, **estimator.options)
    navigator.start(position_m, velocity_mps, heading_rad)
    return navigator


def motion_of(mean: np.ndarray, covariance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(T, 5) and (T, 5, 5) of [north, east, v_north, v_east, heading] from any belief.

    With 7 states the velocity over ground is the sum of that through the water and the current.
    """
    if mean.shape[1] != 7:
        return mean[:, :5], covariance[:, :5, :5]
    heading, speed = mean[:, 2], mean[:, 3]
    ahead = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    across = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    by_state = np.zeros((len(mean), 5, 7))
    by_state[:, [0, 1, 4], [0, 1, 2]] = 1.0
    by_state[:, 2:4, 2] = speed[:, None] * across
    by_state[:, 2:4, 3] = ahead
    by_state[:, [2, 3], [5, 6]] = 1.0
    velocity = speed[:, None] * ahead + mean[:, 5:]
    motion = np.column_stack([mean[:, :2], velocity, heading])
    return motion, by_state @ covariance @ by_state.transpose(0, 2, 1)
