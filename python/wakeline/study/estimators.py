"""The estimators that studies compare, built from a few numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

import wakeline as wl
from wakeline.montecarlo import Candidate


def turn_filter(rate_deg_s: float, noise: Any) -> wl.Ekf:
    """The filter of a coordinated turn at a known rate."""
    return wl.Ekf(wl.CoordinatedTurn(turn_rate_rad_s=np.deg2rad(rate_deg_s), noise=noise))


def learning_filter(
    noise: Any, rate_deg_s: float = 0.0, *, std_deg_s: float = 0.2, course_psd_rad2s: float = 0.0
) -> wl.Ekf:
    """The filter of a turn with a constant rate that is estimated from a first guess."""
    return wl.Ekf(
        wl.CoordinatedTurnRate(
            noise=noise,
            turn_rate_psd_rad2s3=0.0,
            prior_turn_rate_rad_s=np.deg2rad(rate_deg_s),
            prior_turn_rate_std_rad_s=np.deg2rad(std_deg_s),
            course_psd_rad2s=course_psd_rad2s,
        )
    )


def turn_imm(rates_deg_s: Sequence[float], noise: Any, *, stay: float = 0.9) -> wl.Imm:
    """An IMM of coordinated turns at known rates.

    Parameters
    ----------
    rates_deg_s : sequence of K floats
        Turn rates in degrees per second, including 0.
    noise : process noise
    stay : float
        Probability to stay in a mode from scan to scan, and of rate 0 at the start; the others
        share the rest equally.
    """
    filters = [turn_filter(rate, noise) for rate in rates_deg_s]
    return wl.Imm(
        filters=filters,
        chain=wl.ModeChain(sticky_chain(len(filters), stay)),
        initial_mode_probability=peaked(len(filters), list(rates_deg_s).index(0), stay),
    )


def sticky_chain(modes: int, stay: float) -> np.ndarray:
    """Transition matrix (K, K) with one probability to stay and equal other ones."""
    return np.array([peaked(modes, mode, stay) for mode in range(modes)])


def peaked(modes: int, at: int, probability: float) -> np.ndarray:
    """Probabilities (K,), the given one at one mode and equal other ones."""
    shared = np.full(modes, (1.0 - probability) / max(modes - 1, 1))
    shared[at] = probability
    return shared


def turn_candidate(
    rates_deg_s: Sequence[float], noise: Any, sensor: str, *, stay: float = 0.9
) -> Candidate:
    """A candidate for a Monte Carlo run that is a :func:`turn_imm`."""
    return Candidate(turn_imm(rates_deg_s, noise, stay=stay), sensor)
