"""The estimators of the study, one tuning each for all scenarios."""

from __future__ import annotations

from typing import Any

import numpy as np

import wakeline as wl

LABELS = {
    "fuzzy": "fuzzy",
    "fuzzy_improved": "Bayesian bank",
    "fixed3": "last three plots",
    "kalman": "Kalman, CV",
    "imm": "IMM, CV and turn",
}


def estimators() -> dict[str, Any]:
    """By name; the IMM's noises were tuned on other runs than those reported."""
    straight = wl.ConstantVelocity(noise=wl.WhiteAcceleration(psd_m2s3=5e-4))
    turning = wl.CoordinatedTurnRate(
        noise=wl.WhiteAcceleration(psd_m2s3=0.014),
        turn_rate_psd_rad2s3=1.4e-4,
        prior_turn_rate_std_rad_s=0.09,
    )
    model = wl.ConstantVelocity(noise=wl.PiecewiseAcceleration(std_mps2=0.7))
    return {
        "fuzzy": wl.FuzzyAlphaBeta(),
        "fuzzy_improved": wl.BayesianAlphaBeta(),
        "fixed3": wl.BayesianAlphaBeta(min_plots=3, max_plots=3, parabolas=False),
        "kalman": wl.Kalman(model),
        "imm": wl.Imm(
            filters=[wl.Ekf(straight), wl.Ekf(turning)],
            chain=wl.ModeChain.from_sojourn_s([14.5, 120.0]),
            initial_mode_probability=[0.9, 0.1],
        ),
    }


def window_lengths(estimator: Any) -> np.ndarray | None:
    """(K,) number of plots of each mode of an estimator of lines through plots."""
    return getattr(estimator, "plots_of_mode", None)
