"""Runs in chunks, computed by threads or by a cluster, summed in a fixed order."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from numbers import Real
from typing import Any

import numpy as np

try:
    import cloudpickle as pickler  # comes with Dask; sends what __main__ defines, too
except ImportError:
    pickler = pickle

from wakeline import _progress
from wakeline._checks import listed, run_numbers
from wakeline._pool import thread_pool
from wakeline.scenario import Scenario

from .candidate import Candidate, description, named
from .result import Outcome, Result
from .sums import Chunk, Sums, sums_of

CHUNK_RUNS = 25
"""Runs in a chunk: fixed, so that sums do not depend on the number of threads or workers."""


def run(
    scenarios: Scenario | Sequence[Scenario],
    candidates: Mapping[str, Candidate | Callable[[Scenario, np.ndarray], Any]],
    runs: int,
    seed: int = 0,
    *,
    threads: int | None = None,
    client: Any = None,
    progress: bool | Callable[[int, int], None] = True,
    lost_beyond_m: float = 500.0,
    draw_start: bool = False,
) -> Result:
    """Run every candidate on the same plots of every scenario.

    Results have the same bits for any number of threads or workers, except the CPU time; those of a
    candidate on a scenario do not depend on what else is run.

    Every candidate does its first runs of every scenario before the rest, so that invalid
    candidates fail early. An exception that ends the run, also a keyboard interrupt, has the
    attribute ``result``: a :class:`Result` of the candidates and scenarios with complete runs.

    Parameters
    ----------
    scenarios : Scenario or sequence of Scenario
        With different names.
    candidates : mapping of str to Candidate or callable
        By name. A callable takes the scenario and plots (R, T, 2), for R of at least 1, and returns
        an object like ``RunResult``: ``mean`` (R, T, N), ``covariance`` (R, T, N, N) with N of 4, 5
        or 6 in the engine's state orders, ``nis`` (R, T), ``status`` (R, T), ``mode_probability``
        (R, T, K) or None; an optional ``turn_rate_rad_s`` is the estimated turn rate (R, T) or the
        models' turn rates (R, T, K), NaN for an inactive model. It raises ``FilterError`` when a
        run cannot start. Candidates are called by several threads at once.
    runs : int
        Number of runs; the plots are those of ``scenario.draw(runs, seed)``.
    seed : int
        Not negative.
    threads : int, optional
        Default: the number of processors; not together with `client`.
    client : object, optional
        Does the work elsewhere: a ``dask.distributed.Client`` or an executor of
        ``concurrent.futures``. Candidates must be picklable, as estimators, motion models and
        sensors of the engine are.
    progress : bool or callable
        True draws a bar if stderr is a terminal; a callable receives the chunks done and in total.
        An exception in it ends the run: chunks that have not begun are cancelled.
    lost_beyond_m : float
        A run counts as lost if the error of its last position is larger.
    draw_start : bool
        False: every run starts at the true state, so that errors are at first below the prior and
        the bound. True: run r starts at the r-th of ``scenario.draw_starts(runs, seed)``; a
        callable then receives R of them as ``start=``.

    Returns
    -------
    Result

    Raises
    ------
    ValueError
        When there is nothing to run, two scenarios have the same name, a number is invalid, a
        candidate returns arrays of a different shape or cannot be sent to a client.
    TypeError
        When a candidate or the client has an unsupported type.
    """
    if isinstance(scenarios, Scenario):
        scenarios = [scenarios]
    scenarios = listed("scenarios", scenarios, "Scenario")
    _check(scenarios, candidates, runs, seed, threads, client, lost_beyond_m)
    pairs = [(scenario, name) for scenario in scenarios for name in candidates]
    firsts = range(0, runs, CHUNK_RUNS)
    chunks = [
        Chunk(
            scenario,
            name,
            candidates[name],
            first,
            min(CHUNK_RUNS, runs - first),
            seed,
            float(lost_beyond_m),
            bool(draw_start),
        )
        for scenario, name in pairs
        for first in firsts
    ]
    chunks.sort(key=lambda chunk: chunk.first_run > 0)  # invalid candidates fail at once
    texts = {}
    for scenario, name in pairs:
        with named(name, scenario):
            texts[scenario.name, name] = description(candidates[name], scenario)
    parameters = {
        "chunk_runs": CHUNK_RUNS,
        "lost_beyond_m": float(lost_beyond_m),
        "draw_start": bool(draw_start),
        "scenarios": {scenario.name: scenario.parameters for scenario in scenarios},
    }
    outcomes: dict[tuple[str, str], Outcome] = {}
    result = Result(outcomes, runs, seed, parameters)
    try:
        with (
            closing(_worked_off(chunks, threads, client)) as sums,
            closing(_told(sums, len(chunks), progress)) as done,
        ):
            for scenario, name, total in _complete(chunks, done, last=firsts[-1]):
                names = scenario.name, name
                outcomes[names] = Outcome.of(scenario, name, total, **texts[names])
    except BaseException as error:
        error.result = result
        raise
    return result


def _complete(
    chunks: Iterable[Chunk], done: Iterable[Sums], last: int
) -> Iterator[tuple[Scenario, str, Sums]]:
    """Sums over all runs of each candidate on each scenario, when its last chunk is done."""
    totals: dict[tuple[str, str], Sums] = {}
    for chunk, sums in zip(chunks, done, strict=True):
        names = chunk.scenario.name, chunk.candidate_name
        with named(chunk.candidate_name, chunk.scenario):
            totals[names] = totals[names] + sums if names in totals else sums
        if chunk.first_run == last:
            yield chunk.scenario, chunk.candidate_name, totals.pop(names)


def _check(
    scenarios: list[Scenario],
    candidates: Mapping[str, Any],
    runs: int,
    seed: int,
    threads: int | None,
    client: Any,
    lost_beyond_m: float,
) -> None:
    if not scenarios or not candidates:
        raise ValueError("there must be at least one scenario and one candidate")
    for scenario in scenarios:
        if not isinstance(scenario, Scenario):
            raise TypeError(f"scenarios must be of type Scenario, got {scenario!r}")
    names = [scenario.name for scenario in scenarios]
    if len(set(names)) < len(names):
        raise ValueError(f"scenarios must have different names, got {names}")
    if not isinstance(candidates, Mapping):
        raise TypeError(f"candidates must be a mapping by name, got {type(candidates)}")
    for name, candidate in candidates.items():
        if not isinstance(name, str):
            raise TypeError(f"candidates must have names of type str, got {name!r}")
        if not callable(candidate):
            raise TypeError(
                f"candidate {name!r} must be a Candidate or callable, got {type(candidate)}"
            )
    run_numbers(runs, seed, threads)
    if not (isinstance(lost_beyond_m, Real) and lost_beyond_m > 0):
        raise ValueError(f"lost_beyond_m must be positive, got {lost_beyond_m!r}")
    if client is not None and threads is not None:
        raise ValueError("threads must not be given together with client")
    if client is not None and not isinstance(client, ThreadPoolExecutor):
        for name, candidate in candidates.items():
            _check_can_be_sent(name, candidate)


def _check_can_be_sent(name: str, candidate: Any) -> None:
    parts = (candidate.estimator, candidate.sensor) if isinstance(candidate, Candidate) else ()
    for part in parts:
        if callable(part) or isinstance(part, str):
            continue
        try:
            pickler.dumps(part)
        except (TypeError, AttributeError, pickle.PicklingError) as error:
            raise ValueError(
                f"candidate {name!r} cannot be sent to the workers of a client ({error}): its "
                "estimator and sensor, or functions of the scenario that build them, must be "
                "picklable"
            ) from None


def _worked_off(chunks: list[Chunk], threads: int | None, client: Any) -> Iterator[Sums]:
    """Sums of the chunks in their order."""
    if client is None:
        with thread_pool(threads) as pool:
            yield from _gathered([pool.submit(sums_of, chunk) for chunk in chunks])
    elif isinstance(client, ThreadPoolExecutor):
        yield from _gathered([client.submit(sums_of, chunk) for chunk in chunks])
    elif hasattr(client, "submit"):
        packed = map(pickler.dumps, chunks)
        yield from _gathered([client.submit(sums_of_packed, chunk) for chunk in packed])
    else:
        raise TypeError(
            f"client must be a dask.distributed.Client or an executor, got {type(client)}"
        )


def sums_of_packed(chunk: bytes) -> Sums:
    """`sums_of` a pickled chunk, so that a failing import in a worker is an error of its task.

    A worker of Dask that cannot unpickle the arguments of a task dies, and the client waits.
    """
    return sums_of(pickle.loads(chunk))


def _gathered(tasks: list[Any]) -> Iterator[Sums]:
    """Results in order; the first failure, or an early end, cancels what has not begun.

    A task, and with it its result, is released once the result has arrived.
    """
    tasks.reverse()
    try:
        while tasks:
            sums = tasks[-1].result()
            tasks.pop()
            yield sums
    finally:
        for task in tasks:
            task.cancel()


def _told(
    sums: Iterable[Sums], total: int, progress: bool | Callable[[int, int], None]
) -> Iterator[Sums]:
    """Pass results on and report progress."""
    if not callable(progress):
        yield from _progress.progress(sums, total, "running") if progress else sums
        return
    for done, item in enumerate(sums, start=1):
        progress(done, total)
        yield item
