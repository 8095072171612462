"""The estimators of the study, one tuning each for all scenarios."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

import wakeline as wl
from wakeline.scenario import hard_turns

LABELS = {
    "fuzzy": "fuzzy",
    "fuzzy_fitted": "fuzzy, fitted",
    "fuzzy_improved": "Bayesian bank",
    "fixed3": "last three plots",
    "kalman": "Kalman, CV",
    "imm": "IMM, CV and turn",
}

PAPER_MEMBERSHIPS = {"steepness": 5.0, "threshold": 1.5}
TRAINING_RUNS = 100
_TRAINING_STREAM = 0x7EA1
_LEAST_STEP = 0.05


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
        "fuzzy_fitted": wl.FuzzyAlphaBeta(**fitted_memberships()),
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


@cache
def fitted_memberships(runs: int = TRAINING_RUNS) -> dict[str, float]:
    """Slope and threshold of the memberships with the least training error.

    A search with halved steps of their logarithms, from the paper's values. The training set is
    drawn apart from the runs that are reported.
    """
    training = [(turn, turn.draw(runs, _TRAINING_STREAM)) for turn in hard_turns().values()]
    best = np.log(list(PAPER_MEMBERSHIPS.values()))
    least = training_error_m(PAPER_MEMBERSHIPS, training)
    step = np.log(2.0)
    while step > _LEAST_STEP:
        tried = [best + step * np.array(way) for way in ((1, 0), (-1, 0), (0, 1), (0, -1))]
        errors = [training_error_m(_memberships(of), training) for of in tried]
        if min(errors) < least:
            best, least = tried[int(np.argmin(errors))], min(errors)
        else:
            step /= 2.0
    return _memberships(best)


def training_error_m(memberships: dict[str, float], training: list) -> float:
    """Root mean square distance from the predicted position to the plot; inf where invalid."""
    try:
        estimator = wl.FuzzyAlphaBeta(**memberships)
    except ValueError:
        return np.inf
    square_m2 = []
    for turn, runs in training:
        start = [wl.two_point(turn.sensor, *z[:2], turn.period_s) for z in runs.z]
        done = estimator.run(runs.z[:, 2:], dt_s=turn.period_s, sensor=turn.sensor, start=start)
        square_m2.append(np.mean(np.sum(done.innovation**2, axis=-1)))
    return float(np.sqrt(np.mean(square_m2)))


def _memberships(logarithms: np.ndarray) -> dict[str, float]:
    return dict(zip(PAPER_MEMBERSHIPS, np.exp(logarithms).tolist(), strict=True))
