"""Sums over one chunk of runs, which add up to those of all runs."""

from __future__ import annotations

import time
from contextlib import AbstractContextManager
from dataclasses import dataclass, fields, replace
from functools import reduce
from operator import add
from typing import Any

import numpy as np

from wakeline import core, eval
from wakeline._brief import many
from wakeline.metrics import nees as nees_of
from wakeline.metrics import right_mode
from wakeline.scenario import Scenario

from .candidate import Candidate, named

_KINEMATICS = {4: slice(4), 5: slice(4), 6: [0, 1, 3, 4]}
_NEES_BAND = eval.consistency_bounds(0.95, 4, 1)
_FINE = [int(status) for status in (core.Status.ok, core.Status.missed, core.Status.gated)]


@dataclass(frozen=True)
class Sums:
    """Sums over the runs of a chunk; sums over nothing are None.

    Attributes
    ----------
    runs : int
        Runs in the curves.
    failed_runs, lost_runs, failed_steps : int
        See :class:`wakeline.montecarlo.Outcome`.
    position_m2, velocity_m2s2, nees : ndarray (T,)
    nees_inside : ndarray (T,)
        Runs whose individual NEES is within its bounds.
    nis, nis_count : ndarray (T,)
        Over the runs with a plot.
    mode_probability : ndarray (T, K) or None
    turn_rate_rad_s : ndarray (T,) or None
    right_mode : ndarray (T,) or None
        Runs whose most probable model is the right one.
    cpu_s : float
        Time of the estimator for the runs in the curves, assuming equal times.
    """

    runs: int
    failed_runs: int
    lost_runs: int
    failed_steps: int
    position_m2: np.ndarray
    velocity_m2s2: np.ndarray
    nees: np.ndarray
    nees_inside: np.ndarray
    nis: np.ndarray
    nis_count: np.ndarray
    mode_probability: np.ndarray | None
    turn_rate_rad_s: np.ndarray | None
    right_mode: np.ndarray | None
    cpu_s: float

    def __add__(self, other: Sums) -> Sums:
        """Add a chunk; one without valid runs adds only its counts."""
        return replace(
            self,
            **{field.name: _added(self, other, field.name) for field in fields(self)},
        )


def _added(a: Sums, b: Sums, name: str) -> Any:
    mine, its = getattr(a, name), getattr(b, name)
    if mine is None or its is None:
        return its if a.runs == 0 else mine if b.runs == 0 else None
    if np.shape(mine) != np.shape(its):
        raise ValueError(
            f"{name} must have the same shape in all runs, got {np.shape(mine)} and {np.shape(its)}"
        )
    return mine + its


@dataclass(frozen=True)
class Chunk:
    """A piece of work: some runs of one candidate on one scenario."""

    scenario: Scenario
    candidate_name: str
    candidate: Any
    first_run: int
    runs: int
    seed: int
    lost_beyond_m: float
    draw_start: bool


def sums_of(chunk: Chunk) -> Sums:
    """Draw the plots, run the candidate and sum up; one by one if not all runs can start."""
    which = {"runs": chunk.runs, "seed": chunk.seed, "first_run": chunk.first_run}
    z = chunk.scenario.draw(**which)
    starts = chunk.scenario.draw_starts(**which) if chunk.draw_start else None
    try:
        return _summed(chunk, z, starts)
    except core.FilterError:
        own = [None if starts is None else starts[k : k + 1] for k in range(chunk.runs)]
        ones = [_summed_one(chunk, z[k : k + 1], own[k]) for k in range(chunk.runs)]
        with _named(chunk):
            return reduce(add, ones)


def _named(chunk: Chunk) -> AbstractContextManager[None]:
    """Errors within name the candidate and the scenario."""
    return named(chunk.candidate_name, chunk.scenario)


def _summed_one(chunk: Chunk, z: np.ndarray, starts: list[core.Gaussian] | None) -> Sums:
    """Sums of a single run, failed if it cannot start."""
    try:
        return _summed(chunk, z, starts)
    except core.FilterError:
        zero = np.zeros(chunk.scenario.scans)
        return Sums(0, 1, 0, 0, *[zero] * 6, None, None, None, 0.0)


def _summed(chunk: Chunk, z: np.ndarray, starts: list[core.Gaussian] | None) -> Sums:
    given = {} if starts is None else {"start": starts}
    began_s = time.thread_time()
    with _named(chunk):
        result = chunk.candidate(chunk.scenario, z, **given)
    cpu_s = time.thread_time() - began_s
    mean, covariance = _kinematics(chunk, result, len(z))
    usable = np.isfinite(mean).all(axis=(1, 2))
    status = _of_each_scan(chunk, result, "status", len(z), "RT")
    error = mean[usable] - chunk.scenario.truth_states
    position_m2 = error[..., 0] ** 2 + error[..., 2] ** 2
    nees = nees_of(error, covariance[usable])
    nis = _of_each_scan(chunk, result, "nis", len(z), "RT")[usable]
    modes = None
    if getattr(result, "mode_probability", None) is not None:
        modes = _of_each_scan(chunk, result, "mode_probability", len(z), "RTK")[usable]
    rates, estimated_rate = _rates(chunk, result, modes, usable)
    return Sums(
        runs=int(np.count_nonzero(usable)),
        failed_runs=int(np.count_nonzero(~usable)),
        lost_runs=int(np.count_nonzero(np.sqrt(position_m2[:, -1]) > chunk.lost_beyond_m)),
        failed_steps=int(np.count_nonzero(~np.isin(status, _FINE))),
        position_m2=position_m2.sum(axis=0),
        velocity_m2s2=(error[..., 1] ** 2 + error[..., 3] ** 2).sum(axis=0),
        nees=nees.sum(axis=0),
        nees_inside=((nees >= _NEES_BAND[0]) & (nees <= _NEES_BAND[1])).sum(axis=0),
        nis=np.where(np.isfinite(nis), nis, 0.0).sum(axis=0),
        nis_count=np.isfinite(nis).sum(axis=0).astype(float),
        mode_probability=None if modes is None else modes.sum(axis=0),
        turn_rate_rad_s=None if estimated_rate is None else estimated_rate.sum(axis=0),
        right_mode=_right_mode(chunk.scenario, modes, rates),
        cpu_s=cpu_s * float(np.mean(usable)),
    )


def _told(chunk: Chunk, result: Any, name: str) -> np.ndarray:
    """An array of a candidate's result."""
    value = getattr(result, name, None)
    if value is None:
        raise ValueError(
            f"candidate {chunk.candidate_name!r} must give a result with {name}, "
            f"got {type(result).__name__} without"
        )
    try:
        numbers = np.asarray(value)
        if np.iscomplexobj(numbers):
            raise TypeError(f"got {numbers.dtype}")
        return numbers.astype(float, copy=False)
    except (TypeError, ValueError) as error:
        raise ValueError(
            f"candidate {chunk.candidate_name!r} must give {name} of real numbers: {error}"
        ) from error


def _of_each_scan(chunk: Chunk, result: Any, name: str, runs: int, axes: str) -> np.ndarray:
    """An array of a candidate's result with the given axes, (R, T) or (R, T, K)."""
    value, scans = _told(chunk, result, name), chunk.scenario.scans
    if value.ndim != len(axes) or value.shape[:2] != (runs, scans):
        raise ValueError(
            f"candidate {chunk.candidate_name!r} must give {name} ({', '.join(axes)}) with "
            f"R = {runs} and T = {scans}, got {value.shape}"
        )
    return value


def _kinematics(chunk: Chunk, result: Any, runs: int) -> tuple[np.ndarray, np.ndarray]:
    """Means (R, T, 4) and covariances (R, T, 4, 4) over ``[north, vnorth, east, veast]``."""
    mean = _told(chunk, result, "mean")
    covariance = _told(chunk, result, "covariance")
    states = mean.shape[-1] if mean.ndim else 0
    given = mean.shape == (runs, chunk.scenario.scans, states)
    if not (given and states in _KINEMATICS and covariance.shape == (*mean.shape, states)):
        raise ValueError(
            f"candidate {chunk.candidate_name!r} must give mean (R, T, N) and covariance "
            f"(R, T, N, N) with R = {runs}, T = {chunk.scenario.scans} and N of 4, 5 or 6, "
            f"got {mean.shape} and {covariance.shape}"
        )
    at = _KINEMATICS[states]
    return mean[..., at], covariance[..., at, :][..., at]


def _rates(
    chunk: Chunk, result: Any, modes: np.ndarray | None, usable: np.ndarray
) -> tuple[np.ndarray | None, np.ndarray | None]:
    """Turn rates of the models, which broadcast to (R, T, K), and the estimated rate (R, T)."""
    given = getattr(result, "turn_rate_rad_s", None)
    mean = np.asarray(result.mean)
    if given is not None:
        axes = "RT" if np.ndim(given) == 2 else "RTK"
        given = _of_each_scan(chunk, result, "turn_rate_rad_s", len(usable), axes)[usable]
        if axes == "RT":
            return None, given
        if modes is not None:
            _require_rates(chunk, modes, given.shape == modes.shape, given.shape)
        return given, None if modes is None else _mean_rate(modes, given)
    rates = None
    if isinstance(chunk.candidate, Candidate):
        with _named(chunk):
            rates = chunk.candidate.rates(chunk.scenario)
    if mean.shape[-1] == 5:
        return rates, mean[usable, :, 4]
    if rates is None or modes is None:
        return rates, None
    _require_rates(chunk, modes, rates.shape == modes.shape[-1:], rates.shape)
    return rates, modes @ rates


def _mean_rate(modes: np.ndarray, rates: np.ndarray) -> np.ndarray:
    """Mean turn rate (R, T) of models; a model without probability may have no rate."""
    return np.where(modes == 0.0, 0.0, modes * rates).sum(axis=-1)


def _require_rates(chunk: Chunk, modes: np.ndarray, fit: bool, shape: tuple[int, ...]) -> None:
    if not fit:
        raise ValueError(
            f"candidate {chunk.candidate_name!r} must have one turn rate for each of its "
            f"{many(modes.shape[-1], 'model')}, got {shape}"
        )


def _right_mode(
    scenario: Scenario, modes: np.ndarray | None, rates: np.ndarray | None
) -> np.ndarray | None:
    """Runs (T,) whose most probable model is the right one."""
    if modes is None or rates is None:
        return None
    return right_mode(modes, rates, scenario.turn_rates_rad_s).sum(axis=0)
