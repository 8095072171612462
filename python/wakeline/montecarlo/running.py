"""Runs cut into chunks, worked off by threads or by a cluster, added up in one order."""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from numbers import Real
from operator import methodcaller
from typing import Any

import numpy as np

try:
    import cloudpickle as pickler  # comes with Dask; sends what __main__ defines, too
except ImportError:
    pickler = pickle

from wakeline import _progress
from wakeline._checks import listed, run_numbers
from wakeline.scenario import Scenario

from .candidate import Candidate, named, told
from .result import Outcome, Result
from .sums import Chunk, Sums, sums_of

CHUNK_RUNS = 25
"""Runs in a chunk: fixed, so that sums are added alike on any number of threads or workers."""


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
    """Run every candidate on the same readings of every scenario.

    Results are the same bits for any number of threads or workers, the CPU time aside; those of a
    candidate on a scenario do not depend on what else is run.

    Every candidate does its first runs of every scenario before the rest is done, so that one that
    refuses what it is given does so soon. What ends the run early, an interrupt from the keyboard,
    too, has the attribute ``result``: a :class:`Result` of those candidates on those scenarios of
    which all runs were done.

    Parameters
    ----------
    scenarios : Scenario or sequence of Scenario
        With names that differ.
    candidates : mapping of str to Candidate or callable
        By name. A callable takes the scenario and readings (R, T, 2), for R of 1 and more, and
        gives what looks like a ``RunResult``: ``mean`` (R, T, N), ``covariance`` (R, T, N, N) with
        N of 4, 5 or 6 in the engine's state orders, ``nis`` (R, T), ``status`` (R, T),
        ``mode_probability`` (R, T, K) or None; where it also has ``turn_rate_rad_s``, that is the
        estimated turn rate (R, T) or the models' turn rates (R, T, K), NaN for one at rest. It
        raises ``FilterError`` when a run cannot start. Candidates are called by several threads at
        once.
    runs : int
        Number of runs, the readings being those of ``scenario.draw(runs, seed)``.
    seed : int
        Not negative.
    threads : int, optional
        Default as many as there are processors; not together with `client`.
    client : object, optional
        A ``dask.distributed.Client``, the module ``ray`` after ``ray.init()``, or an executor with
        ``submit``: does the work elsewhere, with candidates that can be pickled, as estimators,
        motion models and sensors of the engine can. Tested with local clusters of Dask and of Ray
        and with executors of threads and of processes.
    progress : bool or callable
        True draws a bar where stderr is a terminal; a callable is told chunks done and in all. What
        it raises ends the run: chunks that have not begun are called off.
    lost_beyond_m : float
        A run is counted as lost when its last position is farther off than this.
    draw_start : bool
        False: every run starts at the true state, so that errors begin below what the prior says,
        and below the bound for as long as the start is remembered. True: run r starts at the r-th
        of ``scenario.draw_starts(runs, seed)``; a callable is then told R of them as ``start=``.

    Returns
    -------
    Result

    Raises
    ------
    ValueError
        When there is nothing to run, two scenarios have the same name, a number makes no sense, a
        candidate gives arrays of another shape or cannot be sent to a client.
    TypeError
        When a candidate or the client is of a kind that does not fit.
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
    chunks.sort(key=lambda chunk: chunk.first_run > 0)  # who refuses its input does so at once
    texts = {}
    for scenario, name in pairs:
        with named(name, scenario):
            texts[scenario.name, name] = told(candidates[name], scenario)
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
    """Sums over all runs of each candidate on each scenario, as soon as its last chunk is done."""
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
        raise ValueError(f"scenarios must have names that differ, got {names}")
    if not isinstance(candidates, Mapping):
        raise TypeError(f"candidates must be a mapping by name, got {type(candidates)}")
    for name, candidate in candidates.items():
        if not isinstance(name, str):
            raise TypeError(f"candidates must have names that are text, got {name!r}")
        if not callable(candidate):
            raise TypeError(
                f"candidate {name!r} must be a Candidate or callable, got {type(candidate)}"
            )
    run_numbers(runs, seed, threads)
    if not (isinstance(lost_beyond_m, Real) and lost_beyond_m > 0):
        raise ValueError(f"lost_beyond_m must be positive, got {lost_beyond_m!r}")
    if client is not None and threads is not None:
        raise ValueError("threads must be left out together with client")
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
                "estimator and sensor, or functions of the scenario that build them, must be of a "
                "kind that can be pickled"
            ) from None


def _worked_off(chunks: list[Chunk], threads: int | None, client: Any) -> Iterator[Sums]:
    """Sums of the chunks in their order."""
    if client is None:
        with ThreadPoolExecutor(threads or os.cpu_count() or 1) as pool:
            yield from _gathered([pool.submit(sums_of, chunk) for chunk in chunks])
    elif isinstance(client, ThreadPoolExecutor):
        yield from _gathered([client.submit(sums_of, chunk) for chunk in chunks])
    elif hasattr(client, "submit"):
        packed = map(pickler.dumps, chunks)
        yield from _gathered([client.submit(sums_of_packed, chunk) for chunk in packed])
    elif hasattr(client, "remote") and hasattr(client, "get"):
        remote = client.remote(sums_of)
        waiting = [remote.remote(chunk) for chunk in chunks]
        yield from _gathered(waiting, client.get, client.cancel)
    else:
        raise TypeError(
            "client must be a dask.distributed.Client, the module ray or an executor, "
            f"got {type(client)}"
        )


def sums_of_packed(chunk: bytes) -> Sums:
    """`sums_of` of a pickled chunk: what a worker cannot import is then an error of its task.

    A worker of Dask that cannot unpickle the arguments of a task dies, and the client waits.
    """
    return sums_of(pickle.loads(chunk))


def _gathered(
    tasks: list[Any],
    result: Callable[[Any], Sums] = methodcaller("result"),
    cancel: Callable[[Any], Any] = methodcaller("cancel"),
) -> Iterator[Sums]:
    """Results in order; the first failure, or an early end, calls off what has not begun.

    No task is kept, and with it its result, once that has come.
    """
    tasks.reverse()
    try:
        while tasks:
            sums = result(tasks[-1])
            tasks.pop()
            yield sums
    finally:
        for task in tasks:
            cancel(task)


def _told(
    sums: Iterable[Sums], total: int, progress: bool | Callable[[int, int], None]
) -> Iterator[Sums]:
    """Hand on, telling how far the work has come."""
    if not callable(progress):
        yield from _progress.progress(sums, total, "running") if progress else sums
        return
    for done, item in enumerate(sums, start=1):
        progress(done, total)
        yield item
