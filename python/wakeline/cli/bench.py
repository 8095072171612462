"""``wakeline bench``: what the engine does in a second on this machine, from Python."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

import wakeline as wl
from wakeline._engine import benchmark
from wakeline._progress import progress

from . import outputs, report
from ._peers import LinearImm, TakeScan, jax_imm, numba_imm, stonesoup_tracker

OURS, LANES, BY_HAND = "scalar_double", "batch_double", "hand_loop"

_SEED = 0
_REPEATS = 5
_RUNS, _SCANS = 500, 250
_DT_S = 3.0
_LOOP_STEPS = 500
_BESIDE_HAND_LOOPS = ("kf_step", "ekf_polar_step", "ukf5_step", "imm3_step", "imm5_step")
_ROUNDS = 40
_TURN_RATES_DEG_S = (0.0, 1.0, -1.0)
_TRACKER_SETTLING, _TRACKER_SCANS, _PLOT_STD_M = 20, 10, 5.0
_STONESOUP_SETTLING, _MOST_FOR_STONESOUP = 5, 200  # as its scans take seconds
_GNN_SCANS, _GNN_GATE = 10, 9.21
_SWEEPS, _CELLS, _TRAIN, _GUARD = 4096, 2048, 16, 4
_RANGE_STD_M, _BEARING_STD_RAD = 20.0, np.deg2rad(0.5)


@dataclass(frozen=True)
class _Work:
    """One row of the benchmark.

    Attributes
    ----------
    name, estimator : str
        The work, and who does it.
    metric : str
        ``ns_per_step`` or ``ms_per_scan``.
    call : callable
        Does it once.
    count : int
        Steps or scans in one call.
    settle : callable, optional
        What comes before it, and is not timed.
    """

    name: str
    estimator: str
    metric: str
    call: Callable[[], Any]
    count: int
    settle: Callable[[], Any] | None = None


def add_to(commands: argparse._SubParsersAction) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "bench",
        help="throughput on this machine",
        description="Measures throughput per estimator on this machine, from Python: the best of "
        f"{_REPEATS} times, with ratios within the run. numba, jax, filterpy, stonesoup, scipy and "
        "opencv are measured beside where they are installed.",
    )
    parser.add_argument("--json", type=Path, metavar="F", help="write the figures as JSON")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    works = _works()
    rows = [_measured(work) for work in progress(works, len(works), "measuring")]
    _add_ratios(rows)
    print(_table(rows))
    if arguments.json is not None:
        outputs.write_json(arguments.json, "bench", rows, seed=_SEED, runs=_REPEATS)


def _works() -> list[_Work]:
    return [
        *_step_works(),
        *_imm_run_works(),
        *_tracker_works(),
        *_assignment_works(),
        *_video_works(),
    ]


def _measured(work: _Work) -> dict[str, Any]:
    if work.settle is not None:
        work.settle()
    best_s = min(_elapsed_s(work.call) for _ in range(_REPEATS))
    unit_s = {"ns_per_step": 1e-9, "ms_per_scan": 1e-3}[work.metric]
    return {
        "scenario": work.name,
        "estimator": work.estimator,
        work.metric: best_s / work.count / unit_s,
    }


def _elapsed_s(call: Callable[[], Any]) -> float:
    began_s = time.perf_counter()
    call()
    return time.perf_counter() - began_s


def _add_ratios(rows: list[dict[str, Any]]) -> None:
    """To the steps how many Kalman steps they take, to other programs how many times ours."""
    ours = {row["scenario"]: row for row in rows if row["estimator"] == OURS}
    kalman_ns = ours["kf_step"]["ns_per_step"]
    for row in rows:
        metric = "ns_per_step" if "ns_per_step" in row else "ms_per_scan"
        if metric == "ns_per_step" and row["estimator"] == OURS:
            row["times_kf_step"] = row[metric] / kalman_ns
        elif row["estimator"] != OURS:
            row[f"times_{OURS}"] = row[metric] / ours[row["scenario"]][metric]


def _table(rows: list[dict[str, Any]]) -> str:
    cells = [["work", "estimator", "time", "ratio"]]
    for row in rows:
        if "ns_per_step" in row:
            figure = f"{row['ns_per_step']:.0f} ns a step"
        else:
            figure = f"{row['ms_per_scan']:.3f} ms a scan"
        ratios = [(key, value) for key, value in row.items() if key.startswith("times_")]
        ratio = "".join(f"{value:.1f} x {key[len('times_') :]}" for key, value in ratios)
        cells.append([row["scenario"], row["estimator"], figure, ratio])
    return report.aligned(cells, left=2, text=(3,))


# Steps of one estimator ---------------------------------------------------------------------------


def _step_works() -> Iterator[_Work]:
    polar = wl.RangeBearing(range_std_m=_RANGE_STD_M, bearing_std_rad=_BEARING_STD_RAD)
    converted = wl.ConvertedRangeBearing(range_std_m=_RANGE_STD_M, bearing_std_rad=_BEARING_STD_RAD)
    z = _recordings(_RUNS // 10)
    for name, estimator, sensor in (
        ("kf_step", wl.Kalman(_constant_velocity()), converted),
        ("ekf_polar_step", wl.Ekf(_constant_velocity()), polar),
        ("ukf5_step", wl.Ukf(wl.CoordinatedTurnRate(noise=_noise())), polar),
        ("imm3_step", _imm(*_TURN_RATES_DEG_S), polar),
        ("imm5_step", _imm(0.0, 1.0, -1.0, 3.0, -3.0), polar),
        ("fuzzy_alpha_beta_step", wl.FuzzyAlphaBeta(), polar),
        ("bayesian_alpha_beta_step", wl.BayesianAlphaBeta(), polar),
    ):
        steps = z[..., 0].size
        if name in _BESIDE_HAND_LOOPS:
            yield from _cpp_works(name)
        else:
            yield _Work(name, OURS, "ns_per_step", _run_by_run(estimator, z, sensor), steps)
        yield _Work(name, LANES, "ns_per_step", _all_runs(estimator, z, sensor), steps)
    few = z[: max(len(z) // 10, 1)]
    tree = wl.ModeHistory(wl.Ekf(wl.CoordinatedTurn(noise=_noise())), max_branches=100)
    call = _run_by_run(tree, few, polar)
    yield _Work("mode_history100_scan", OURS, "ms_per_scan", call, few[..., 0].size)
    call = _all_runs(tree, few, polar)
    yield _Work("mode_history100_scan", LANES, "ms_per_scan", call, few[..., 0].size)


def _cpp_works(name: str) -> Iterator[_Work]:
    """Steps one after the other in C++, ours and those written by hand; both keep nothing."""
    for estimator, hand in ((OURS, False), (BY_HAND, True)):
        call = partial(benchmark.steps, name, hand=hand, rounds=_ROUNDS)
        yield _Work(name, estimator, "ns_per_step", call, count=call())


def _imm_run_works() -> Iterator[_Work]:
    """500 runs of 250 positions through an IMM of three models."""
    name, metric = "imm3_run_python", "ns_per_step"
    sensor = wl.Position(position_std_m=_RANGE_STD_M)
    polar, imm = _recordings(_RUNS), _imm(*_TURN_RATES_DEG_S)
    z = polar[..., :1] * np.stack([np.cos(polar[..., 1]), np.sin(polar[..., 1])], -1)
    steps = z[..., 0].size
    yield _Work(name, OURS, metric, _run_by_run(imm, z, sensor), steps)
    yield _Work(name, LANES, metric, _all_runs(imm, z, sensor), steps)
    if wl.threads() > 1:
        threads = f"{LANES}_{wl.threads()}_threads"
        yield _Work(name, threads, metric, _whole_run(imm, z, sensor), steps)
    one = np.concatenate(list(z))[:_LOOP_STEPS]

    def loop() -> None:
        imm.start(_start())
        for place in one:
            imm.predict(_DT_S)
            imm.update(sensor, place)

    yield _Work(name, "python_loop", metric, loop, len(one))
    problem = _peer_problem()
    for peer, run in (("numba", numba_imm(problem)), ("jax", jax_imm(problem))):
        if run is not None:
            yield _Work(name, peer, metric, partial(run, z), steps)
    try:
        from filterpy.kalman import IMMEstimator, KalmanFilter
    except ImportError:
        return
    filterpy = _filterpy_imm(problem, IMMEstimator, KalmanFilter)

    def filterpy_loop() -> None:
        for place in one:
            filterpy.predict()
            filterpy.update(place)

    yield _Work(name, "filterpy", metric, filterpy_loop, len(one))


def _whole_run(estimator: Any, z: np.ndarray, sensor: Any) -> Callable[[], Any]:
    return lambda: estimator.run(z, dt_s=_DT_S, sensor=sensor, start=_start())


def _run_by_run(estimator: Any, z: np.ndarray, sensor: Any) -> Callable[[], Any]:
    """One run after the other, each on its own."""
    calls = [_whole_run(estimator, one, sensor) for one in z]
    return lambda: [call() for call in calls]


def _all_runs(estimator: Any, z: np.ndarray, sensor: Any) -> Callable[[], Any]:
    """All runs in one call, in lanes, on one thread."""
    call = _whole_run(estimator, z, sensor)

    def on_one_thread() -> Any:
        before = wl.threads()
        wl.set_threads(1)
        try:
            return call()
        finally:
            wl.set_threads(before)

    return on_one_thread


def _noise() -> Any:
    return wl.WhiteAcceleration(psd_m2s3=0.01)


def _constant_velocity() -> Any:
    return wl.ConstantVelocity(noise=_noise())


def _imm(*turn_rate_deg_s: float) -> Any:
    filters = [
        wl.Ekf(wl.CoordinatedTurn(turn_rate_rad_s=np.deg2rad(rate), noise=_noise()))
        for rate in turn_rate_deg_s
    ]
    return wl.Imm(filters=filters, chain=wl.ModeChain(_chain(len(filters))))


def _chain(modes: int) -> np.ndarray:
    leave = 0.05
    return np.full((modes, modes), leave / (modes - 1)) + (
        1 - leave - leave / (modes - 1)
    ) * np.eye(modes)


def _start() -> Any:
    return wl.Gaussian([5000.0, 0.0, 0.0, 5.0], np.diag([400.0, 25.0, 1900.0, 25.0]))


def _recordings(runs: int) -> np.ndarray:
    """Plots (runs, scans, 2) of a vessel that steams steadily across the radar's view."""
    rng = np.random.default_rng(_SEED)
    after_s = _DT_S * np.arange(1, _SCANS + 1)
    north_m, east_m = np.full(_SCANS, 5000.0), 5.0 * after_s
    truth = np.column_stack([np.hypot(north_m, east_m), np.arctan2(east_m, north_m)])
    return truth + rng.normal(size=(runs, _SCANS, 2)) * [_RANGE_STD_M, _BEARING_STD_RAD]


def _peer_problem() -> LinearImm:
    """The three models as other programs take them."""
    motions = [
        wl.CoordinatedTurn(turn_rate_rad_s=rate, noise=_noise())
        for rate in np.deg2rad(_TURN_RATES_DEG_S)
    ]
    return LinearImm(
        f=np.array([motion.matrix(_DT_S) for motion in motions]),
        q=np.array([motion.process_noise(_DT_S) for motion in motions]),
        chain=_chain(len(motions)),
        mean=np.asarray(_start().mean),
        covariance=np.asarray(_start().covariance),
        position_std_m=_RANGE_STD_M,
    )


def _filterpy_imm(problem: LinearImm, estimator_class: type, filter_class: type) -> Any:
    filters = []
    for f, q in zip(problem.f, problem.q, strict=True):
        one = filter_class(dim_x=4, dim_z=2)
        one.x, one.P, one.F, one.Q = problem.mean, problem.covariance, f, q
        one.H = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0]])
        one.R = problem.position_std_m**2 * np.eye(2)
        filters.append(one)
    return estimator_class(filters, np.full(len(filters), 1 / len(filters)), problem.chain)


# Whole scans --------------------------------------------------------------------------------------


def _tracker_works() -> Iterator[_Work]:
    """Targets that the tracker has settled on, each seen in every scan, among false plots."""
    for name, targets, false_plots in (("tracker_200", 200, 200), ("tracker_1000", 1000, 500)):
        peers = [(OURS, _our_tracker(targets), _TRACKER_SETTLING, _TRACKER_SCANS)]
        if targets <= _MOST_FOR_STONESOUP:
            peers.append(("stonesoup", stonesoup_tracker(_PLOT_STD_M), _STONESOUP_SETTLING, 1))
        for peer, process, settling, count in peers:
            if process is None:
                continue
            scans = _busy_scans(targets, false_plots, settling + _REPEATS * count)
            track = partial(_track, process, iter(scans))
            call, settle = partial(track, count), partial(track, settling)
            yield _Work(name, peer, "ms_per_scan", call, count, settle)


def _busy_scans(targets: int, false_plots: int, count: int) -> list[tuple[float, np.ndarray]]:
    """Times and plots (P, 2), m: boats on straight courses, 600 m apart, and false plots."""
    rng = np.random.default_rng(_SEED)
    side = int(np.ceil(np.sqrt(targets)))
    place_m = 2000.0 + 600.0 * np.column_stack(np.divmod(np.arange(targets), side))
    velocity_mps = rng.uniform(-6.0, 6.0, (targets, 2))
    scans = []
    for k in range(count):
        false_m = rng.uniform(1700.0, 1700.0 + 600.0 * side, (false_plots, 2))
        seen_m = place_m + k * _DT_S * velocity_mps
        seen_m += rng.normal(scale=_PLOT_STD_M, size=place_m.shape)
        scans.append((k * _DT_S, np.concatenate([seen_m, false_m])))
    return scans


def _track(process: TakeScan, scans: Iterator[tuple[float, np.ndarray]], count: int) -> None:
    for time_s, position_m in islice(scans, count):
        process(time_s, position_m)


def _our_tracker(targets: int) -> TakeScan:
    radar = wl.Radar(range_std_m=10.0, bearing_std_rad=np.deg2rad(0.1), period_s=_DT_S)
    tracker = wl.Tracker(radar, wl.TrackerConfig(max_tracks=2 * targets + 100))

    def process(time_s: float, position_m: np.ndarray) -> None:
        north_m, east_m = position_m.T
        range_m, bearing_rad = np.hypot(north_m, east_m), np.arctan2(east_m, north_m)
        tracker.process(time_s, range_m=range_m, bearing_rad=bearing_rad)

    return process


def _assignment_works() -> Iterator[_Work]:
    """Optimal assignment of n tracks to n plots, about five candidates a track."""
    rng = np.random.default_rng(_SEED)
    for size in (200, 1000):
        name, scans = f"gnn_{size}", [_gated_costs(rng, size, 5.0) for _ in range(_GNN_SCANS)]
        yield _Work(name, OURS, "ms_per_scan", _each(_ours_assigned, scans), _GNN_SCANS)
        try:
            from scipy.sparse.csgraph import min_weight_full_bipartite_matching as match
        except ImportError:
            continue
        matrices = [_with_ways_out(cost) for cost in scans]
        for cost, matrix in zip(scans, matrices, strict=True):
            rows, columns = match(matrix)
            best, ours = matrix[rows, columns].sum(), _total_cost(cost, _ours_assigned(cost))
            if not np.isclose(best, ours, rtol=1e-9):
                raise RuntimeError(f"{name}: a total of {ours}, where scipy finds {best}")
        yield _Work(name, "scipy", "ms_per_scan", _each(match, matrices), _GNN_SCANS)


def _each(function: Callable[[Any], Any], problems: list[Any]) -> Callable[[], None]:
    def call() -> None:
        for problem in problems:
            function(problem)

    return call


def _gated_costs(
    rng: np.random.Generator, size: int, candidates: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compressed rows of gated distances: of each track its own plot, and others by chance."""
    start, columns, costs = [0], [], []
    for row in range(size):
        others = rng.choice(size, rng.poisson(candidates - 1.0), replace=False)
        plots = np.unique(np.append(others, row))
        columns.append(plots)
        costs.append(np.where(plots == row, 0.3, 1.0) * rng.uniform(0.1, _GNN_GATE, len(plots)))
        start.append(start[-1] + len(plots))
    return np.array(start), np.concatenate(columns), np.concatenate(costs)


def _ours_assigned(cost: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
    return wl.association.assign_sparse(*cost, unassigned_cost=_GNN_GATE, columns=len(cost[0]) - 1)


def _total_cost(cost: tuple[np.ndarray, np.ndarray, np.ndarray], pairs: np.ndarray) -> float:
    start, columns, costs = cost
    total = _GNN_GATE * (len(start) - 1 - len(pairs))
    for row, column in pairs:
        mine = slice(start[row], start[row + 1])
        total += costs[mine][columns[mine] == column].item()
    return total


def _with_ways_out(cost: tuple[np.ndarray, np.ndarray, np.ndarray]) -> Any:
    """The same as a matrix with a column more for each row, at the cost of leaving it out."""
    from scipy.sparse import csr_array, diags_array, hstack

    start, columns, costs = cost
    size = len(start) - 1
    pairs = csr_array((costs, columns, start), shape=(size, size))
    return hstack([pairs, diags_array(np.full(size, _GNN_GATE))], format="csr")


# Radar video --------------------------------------------------------------------------------------


def _video_works() -> Iterator[_Work]:
    """A turn of 4096 sweeps of 2048 cells of 8 bits, from amplitudes to centroids of echoes."""
    name, metric = "cfar_scan", "ms_per_scan"
    amplitude, factor = _video(), wl.video.threshold_factor(1e-9, train_cells=_TRAIN)
    step_rad = 2 * np.pi / _SWEEPS
    video = wl.recording.RadarVideo(
        amplitude=amplitude,
        azimuth_rad=step_rad * np.arange(_SWEEPS),
        time_s=2.5 / _SWEEPS * np.arange(_SWEEPS),
        azimuth_width_rad=step_rad,
        start_range_m=0.0,
        cell_m=7.5,
    )
    extractor = wl.PlotExtractor(
        train_cells=_TRAIN,
        guard_cells=_GUARD,
        threshold_factor=factor,
        max_sweep_cells=_CELLS,
        closed_circle=True,
    )

    def ours() -> None:
        extractor.process(video)
        extractor.finish()

    yield _Work(name, OURS, metric, ours, 1)
    for peer, scan in (("scipy", _scipy_scan()), ("opencv", _opencv_scan())):
        if scan is not None:
            yield _Work(name, peer, metric, lambda scan=scan: scan(amplitude, factor), 1)


def _video() -> np.ndarray:
    """Rayleigh noise and 200 ships."""
    rng = np.random.default_rng(_SEED)
    amplitude = rng.rayleigh(14.0, (_SWEEPS, _CELLS)).clip(0, 255).astype(np.uint8)
    echo = 255 - 5 * np.abs(np.arange(20) - 10)[:, None] - 10 * np.abs(np.arange(5) - 2)
    for sweep, cell in rng.integers(0, (_SWEEPS - 20, _CELLS - 5), (200, 2)):
        amplitude[sweep : sweep + 20, cell : cell + 5] = echo
    return amplitude


def _scipy_scan() -> Callable[[np.ndarray, float], Any] | None:
    """The same with scipy's filter and labels; sums over the few cells that are left by numpy."""
    try:
        from scipy import ndimage
    except ImportError:
        return None

    def scan(amplitude: np.ndarray, factor: float) -> Any:
        window = ndimage.uniform_filter1d(amplitude, _TRAIN, axis=1, output=np.float32)
        labels, count = ndimage.label(_above(amplitude, window, factor), np.ones((3, 3)))
        sweep, cell = np.nonzero(labels)
        label, weight = labels[sweep, cell], amplitude[sweep, cell].astype(float)
        total, by_cell, by_sweep = (
            np.bincount(label, weights, count + 1)[1:]
            for weights in (weight, weight * cell, weight * sweep)
        )
        return by_cell / total, by_sweep / total

    return scan


def _opencv_scan() -> Callable[[np.ndarray, float], Any] | None:
    """The same with opencv, but for the weights: its components have centroids without."""
    try:
        import cv2
    except ImportError:
        return None
    cv2.setNumThreads(1)  # as ours

    def scan(amplitude: np.ndarray, factor: float) -> Any:
        window = cv2.boxFilter(amplitude, cv2.CV_32F, (_TRAIN, 1))
        above = _above(amplitude, window, factor).astype(np.uint8)
        return cv2.connectedComponentsWithStats(above, connectivity=8)

    return scan


def _above(amplitude: np.ndarray, window: np.ndarray, factor: float) -> np.ndarray:
    """Cells above the mean of the windows on both sides; none at the ends of sweeps."""
    apart = _TRAIN + 2 * _GUARD + 1
    first = _GUARD + (_TRAIN + 1) // 2
    threshold = window[:, :-apart] + window[:, apart:]
    threshold *= np.float32(factor / 2)
    above = np.zeros(amplitude.shape, bool)
    inside = slice(first, first + threshold.shape[1])
    np.greater(amplitude[:, inside], threshold, out=above[:, inside])
    return above
