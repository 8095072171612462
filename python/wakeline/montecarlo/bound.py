"""The posterior Cramér-Rao bound of a scenario whose turn rates and switch times are known."""

from __future__ import annotations

from typing import Any

import numpy as np

from wakeline import eval, motion
from wakeline.scenario import Scenario

from .pieces import pieces


def bound(scenario: Scenario, noise: Any = None) -> np.ndarray:
    """Least covariance of an unbiased estimator that knows the turn rate at each instant.

    Conditional posterior Cramér-Rao bound for the truth's mode sequence, at the true states, with
    the start drawn from the scenario's prior. A switch between two scans splits the step. Plots
    count with their detection probability. On a recorded track, whose speed changes, too, no filter
    comes near a bound without `noise`.

    Parameters
    ----------
    scenario : Scenario
    noise : process-noise policy, optional
        Default: no process noise.

    Returns
    -------
    ndarray (T, 4, 4)
        Over ``[north, vnorth, east, veast]`` after each plot.

    Raises
    ------
    FilterError
        When a bound is not positive definite.
    """
    if not isinstance(scenario, Scenario):
        raise TypeError(f"scenario must be of type Scenario, got {type(scenario).__name__}")
    noise = motion.PiecewiseAcceleration(std_mps2=0.0) if noise is None else noise
    transition = np.empty((scenario.scans, 4, 4))
    process_noise = np.empty((scenario.scans, 4, 4))
    moved, gained = np.eye(4), np.zeros((4, 4))
    for piece in pieces(scenario):
        turn = motion.CoordinatedTurn(turn_rate_rad_s=piece.turn_rate_rad_s, noise=noise)
        step = turn.matrix(piece.dt_s)
        moved = step @ moved
        gained = step @ gained @ step.T + turn.process_noise(piece.dt_s)
        if piece.scan is not None:
            transition[piece.scan], process_noise[piece.scan] = moved, gained
            moved, gained = np.eye(4), np.zeros((4, 4))
    states = scenario.truth_states
    seen = np.hypot(states[:, 0], states[:, 2]) <= scenario.radar.max_range_m
    return eval.cramer_rao_bound(
        transition,
        process_noise,
        np.where(seen[:, np.newaxis], states, np.nan),
        sensor=scenario.polar_sensor,
        start_covariance=scenario.start.covariance,
        detection_probability=scenario.radar.detection_probability,
    )


def bound_curves(scenario: Scenario, noise: Any = None) -> tuple[np.ndarray, np.ndarray]:
    """The bound as RMSE curves.

    Returns
    -------
    position_m, velocity_mps : ndarray (T,)
        Least root mean square errors at each plot.

    Raises
    ------
    FilterError
        As :func:`bound`.
    """
    variance = np.diagonal(bound(scenario, noise), axis1=-2, axis2=-1)
    return np.sqrt(variance[:, 0] + variance[:, 2]), np.sqrt(variance[:, 1] + variance[:, 3])
