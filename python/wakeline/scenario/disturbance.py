"""Truth under random accelerations that are not Gaussian."""

from __future__ import annotations

import itertools

import numpy as np

from wakeline._checks import above_zero, at_least, positive

from .truth import Segment, Truth


def disturbed(
    truth: Truth,
    scale_mps2: float,
    interval_s: float,
    rng: np.random.Generator | int,
    *,
    degrees_of_freedom: float = 1.0,
    limit_mps2: float | None = None,
) -> Truth:
    """The same maneuvers under heavy-tailed random accelerations north and east.

    The accelerations are constant over each interval, so that the truth remains exact in closed
    form: scale times Student's t, per axis, redrawn where it exceeds the limit. One degree of
    freedom is the Cauchy law of paper A, equation (4), which has no variance and must be truncated.
    Braking ends when the vessel has lost its speed; it then drifts and does not go astern. In each
    interval the thrust points along the velocity at its start, which a known acceleration turns,
    too.

    Parameters
    ----------
    truth : Truth
        The undisturbed motion; its segments are split at the ends of the intervals, and its
        accelerations are kept.
    scale_mps2 : float
        Scale of the distribution: half of the draws of a Cauchy law are within it.
    interval_s : float
        Duration of an acceleration.
    rng : numpy.random.Generator or int
        Random generator, or its seed.
    degrees_of_freedom : float
        Of Student's t: 1 is Cauchy, infinity Gaussian.
    limit_mps2 : float, optional
        Largest acceleration per axis; default 20 scales.

    Returns
    -------
    Truth
        With the disturbances in its segments.

    Raises
    ------
    ValueError
        When a parameter is not positive and finite (degrees of freedom may be infinite), the
        limit is below the scale, or the truth has no segments.
    """
    positive(scale_mps2=scale_mps2, interval_s=interval_s)
    above_zero(degrees_of_freedom=degrees_of_freedom)
    limit_mps2 = 20.0 * scale_mps2 if limit_mps2 is None else limit_mps2
    at_least(scale_mps2, limit_mps2=limit_mps2)
    if not truth.segments:
        raise ValueError("truth must have at least one segment, got none")
    rng = np.random.default_rng(rng)
    span_s = truth.end_time_s - truth.start_time_s
    intervals = max(int(np.ceil(span_s / interval_s * (1 - 1e-12))), 1)
    push_mps2 = _heavy_tailed(rng, (intervals, 2), degrees_of_freedom, limit_mps2 / scale_mps2)
    push_mps2 *= scale_mps2
    ends_s = np.cumsum([segment.duration_s for segment in truth.segments])
    cuts_s = np.union1d(interval_s * np.arange(1, intervals), ends_s)
    cuts_s = np.concatenate([[0.0], cuts_s[(cuts_s > 0) & (cuts_s <= ends_s[-1])]])
    pieces = []
    for begin_s, end_s in itertools.pairwise(cuts_s.tolist()):
        middle_s = 0.5 * (begin_s + end_s)
        order = truth.segments[int(np.searchsorted(ends_s, middle_s))]
        north_mps2, east_mps2 = push_mps2[min(int(middle_s / interval_s), intervals - 1)]
        pieces.append(
            Segment(
                end_s - begin_s,
                order.turn_rate_rad_s,
                order.acceleration_mps2,
                order.control_mps2,
                (
                    order.disturbance_mps2[0] + float(north_mps2),
                    order.disturbance_mps2[1] + float(east_mps2),
                ),
            )
        )
    start = truth.state_at(truth.start_time_s)[0]
    return Truth(
        start,
        pieces,
        start_time_s=truth.start_time_s,
        start_course_rad=truth.start_course_rad,
    )


def _heavy_tailed(
    rng: np.random.Generator, shape: tuple[int, ...], degrees_of_freedom: float, limit: float
) -> np.ndarray:
    """Student's t of unit scale, redrawn where it exceeds the limit."""

    def draw(size):
        if np.isinf(degrees_of_freedom):
            return rng.standard_normal(size)
        return rng.standard_t(degrees_of_freedom, size)

    drawn = draw(shape)
    while (beyond := np.abs(drawn) > limit).any():
        drawn[beyond] = draw(int(beyond.sum()))
    return drawn
