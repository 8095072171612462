"""Whether the most probable of several models is the right one."""

from __future__ import annotations

import numpy as np

from wakeline._checks import real_numbers

_SAME_RATE_RAD_S = 1e-12


def right_mode(
    mode_probability: np.ndarray, turn_rates_rad_s: np.ndarray, true_turn_rate_rad_s: np.ndarray
) -> np.ndarray:
    """Whether the most probable model is the one whose turn rate is nearest to the true one.

    Parameters
    ----------
    mode_probability : array_like (..., T, K)
        Of one or more runs, or their mean.
    turn_rates_rad_s : array_like (K,), (T, K) or (..., T, K)
        Turn rates of the models, fixed or over time; NaN for an inactive model, which does not
        count.
    true_turn_rate_rad_s : array_like (T,)

    Returns
    -------
    ndarray of bool (..., T)
        Equally near models are all right; of equally probable models the first counts. False where
        a probability is NaN.

    Raises
    ------
    ValueError
        When the shapes do not fit.
    """
    modes = real_numbers("mode_probability", mode_probability)
    rates = real_numbers("turn_rates_rad_s", turn_rates_rad_s)
    truth = real_numbers("true_turn_rate_rad_s", true_turn_rate_rad_s)
    if modes.ndim < 2 or modes.shape[-1] == 0 or truth.shape != modes.shape[-2:-1]:
        raise ValueError(
            "mode_probability must have shape (..., T, K) and true_turn_rate_rad_s (T,), "
            f"got {modes.shape} and {truth.shape}"
        )
    if rates.shape not in (modes.shape[-1:], modes.shape[-2:], modes.shape):
        raise ValueError(
            f"turn_rates_rad_s must have shape (K,), (T, K) or {modes.shape}, got {rates.shape}"
        )
    distance = np.abs(rates - truth[:, np.newaxis])
    distance = np.broadcast_to(np.where(np.isnan(distance), np.inf, distance), modes.shape)
    first = modes.argmax(axis=-1)[..., np.newaxis]
    chosen = np.take_along_axis(distance, first, axis=-1)[..., 0]
    valid = ~np.isnan(modes).any(axis=-1) & np.isfinite(chosen)
    return valid & (chosen <= distance.min(axis=-1) + _SAME_RATE_RAD_S)
