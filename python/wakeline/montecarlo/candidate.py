"""A candidate of a Monte Carlo study: an estimator and its sensor."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np

from wakeline import core, filter, motion
from wakeline._checks import real_numbers
from wakeline.scenario import Scenario

from .pieces import stretches


@dataclass(frozen=True)
class Candidate:
    """An estimator, its sensor and, optionally, the turn rates of its models.

    The estimator also receives the scenario's known acceleration, if there is one.

    Each of the three may be a function of the scenario that returns it.

    Attributes
    ----------
    estimator : object or callable
        Any object with ``run(z, dt_s=, sensor=, start=)``, or ``estimator(scenario)``, a function
        or a class, that builds it; with a known acceleration also ``acceleration_mps2=``.
    sensor : {"polar", "converted"}, object or callable
        The scenario's radar as ``RangeBearing`` or as ``ConvertedRangeBearing(unbiased=False)``, a
        sensor, or ``sensor(scenario)``.
    turn_rates_rad_s : sequence of K float, or callable, optional
        Turn rate of each model, or ``turn_rates_rad_s(scenario)``; default the estimator's method
        of that name. Used for the estimated turn rate and the right model if the run itself has no
        ``turn_rate_rad_s``.
    """

    estimator: Any
    sensor: Any = "polar"
    turn_rates_rad_s: Sequence[float] | Callable[[Scenario], Sequence[float]] | None = None

    def __call__(self, scenario: Scenario, z: np.ndarray, *, start: Any = None) -> Any:
        """Run the plots (R, T, 2) of a scenario: a ``RunResult`` or an object like it.

        The start is the scenario's, or R given ones.
        """
        return self._built(scenario).run(
            z,
            dt_s=scenario.radar.period_s,
            sensor=_sensor(self.sensor, scenario),
            start=scenario.start if start is None else start,
            **_control_of(scenario.control_mps2),
        )

    def rates(self, scenario: Scenario) -> np.ndarray | None:
        """Turn rates (K,) of the models in rad/s, None if unknown."""
        rates = self.turn_rates_rad_s
        if callable(rates):
            rates = rates(scenario)
        if rates is None:
            rates = getattr(self._built(scenario), "turn_rates_rad_s", lambda: None)()
        return None if rates is None else real_numbers("turn_rates_rad_s", rates)

    def description(self, scenario: Scenario) -> dict[str, str]:
        """The ``repr`` of ``estimator`` and ``sensor`` on a scenario.

        If one cannot be built, so that every run fails, it is the repr of its builder.
        """
        return {
            "estimator": _text_of(partial(self._built, scenario), self.estimator),
            "sensor": _text_of(partial(_sensor, self.sensor, scenario), self.sensor),
        }

    def _built(self, scenario: Scenario) -> Any:
        ready = hasattr(self.estimator, "run") and not isinstance(self.estimator, type)
        built = self.estimator
        if callable(built) and not ready:
            built = built(scenario)
        if not hasattr(built, "run"):
            raise TypeError(
                "estimator must have run, or be a function of the scenario that returns one, "
                f"got {built!r}"
            )
        return built


@contextmanager
def named(candidate_name: str, scenario: Scenario) -> Iterator[None]:
    """Add the candidate and the scenario to errors."""
    try:
        yield
    except (TypeError, ValueError) as error:
        error_type = TypeError if isinstance(error, TypeError) else ValueError
        which = f"candidate {candidate_name!r} on {scenario.name!r}"
        raise error_type(f"{which}: {error}") from error


def description(candidate: Candidate | Callable[..., Any], scenario: Scenario) -> dict[str, str]:
    """Description of a candidate on a scenario, by attribute of an outcome."""
    if isinstance(candidate, Candidate):
        return candidate.description(scenario)
    return {"estimator": _text(candidate)}


def clairvoyant(
    scenario: Scenario,
    z: np.ndarray,
    *,
    sensor: Any = "polar",
    noise: Any = None,
    start: Any = None,
) -> SimpleNamespace:
    """The Kalman filter that knows the turn rate at each instant.

    Without thrust and disturbance, which it does not know, no candidate can be better. It knows the
    control. Where the rate or the control switches between two scans it predicts in two steps. On a
    recorded track, whose speed changes, too, it diverges without `noise`. Bind options with
    ``functools.partial``.

    Parameters
    ----------
    scenario : Scenario
    z : ndarray (R, T, 2)
        Plots, as from ``scenario.draw``.
    sensor : {"polar", "converted"}, object or callable
        As for :class:`Candidate`. Converted plots are inaccurate near the antenna.
    noise : process-noise policy, optional
        Default: no process noise.
    start : Gaussian or sequence of R Gaussian, optional
        Default ``scenario.start``.

    Returns
    -------
    namespace
        ``mean`` (R, T, 4), ``covariance`` (R, T, 4, 4), ``mode_probability`` None, ``innovation``
        (R, T, 2), ``nis``, ``log_likelihood``, ``status`` and ``turn_rate_rad_s`` (R, T).

    Raises
    ------
    FilterError
        When the filter cannot start.
    ValueError
        When the plots have a different shape.
    """
    z = real_numbers("z", z)
    if z.ndim != 3 or z.shape[1] != scenario.scans:
        raise ValueError(f"z must have shape (R, {scenario.scans}, 2), got {z.shape}")
    sensor = _sensor(sensor, scenario)
    noise = motion.PiecewiseAcceleration(std_mps2=0.0) if noise is None else noise
    starts = scenario.start if start is None else start
    fields: dict[str, list[np.ndarray]] = {
        name: [] for name in ("mean", "covariance", "innovation", "nis", "log_likelihood", "status")
    }
    for rate_rad_s, steps in stretches(scenario):
        dt_s = np.array([step.dt_s for step in steps])
        padded = np.full((len(z), len(steps), z.shape[-1]), np.nan)
        read = [k for k, step in enumerate(steps) if step.scan is not None]
        padded[:, read] = z[:, [steps[k].scan for k in read]]
        known = filter.Ekf(motion.CoordinatedTurn(turn_rate_rad_s=rate_rad_s, noise=noise))
        control = _control_of(np.array([step.control_mps2 for step in steps]))
        piece = known.run(padded, dt_s=dt_s, sensor=sensor, start=starts, **control)
        starts = list(map(core.Gaussian, piece.mean[:, -1], piece.covariance[:, -1]))
        for name, parts in fields.items():
            parts.append(getattr(piece, name)[:, read])
    joined = {name: np.concatenate(parts, axis=1) for name, parts in fields.items()}
    rates = np.broadcast_to(scenario.turn_rates_rad_s, z.shape[:2])
    return SimpleNamespace(**joined, mode_probability=None, turn_rate_rad_s=rates)


def _control_of(control_mps2: np.ndarray) -> dict[str, np.ndarray]:
    """The keyword argument for a known acceleration (T, 2); empty if it is zero."""
    return {"acceleration_mps2": control_mps2} if control_mps2.any() else {}


def _text(thing: Any) -> str:
    """The repr without a memory address."""
    return re.sub(r" at 0x[0-9a-fA-F]+", "", repr(thing))


def _text_of(build: Callable[[], Any], otherwise: Any) -> str:
    try:
        return _text(build())
    except core.FilterError:
        return _text(otherwise)


def _sensor(sensor: Any, scenario: Scenario) -> Any:
    if isinstance(sensor, str):
        if sensor not in ("polar", "converted"):
            raise ValueError(f'sensor must be "polar", "converted" or a sensor, got {sensor!r}')
        return getattr(scenario, f"{sensor}_sensor")
    return sensor(scenario) if callable(sensor) else sensor
