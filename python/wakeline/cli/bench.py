"""``wakeline bench``: throughput of the engine on this machine, from Python."""

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
from wakeline.live import benchmark as benchmark_live

from . import outputs, report

OURS, LANES = "scalar_double", "batch_double"

SEED = 0
REPEATS = 5
RUNS, _SCANS = 500, 250
DT_S = 3.0
LOOP_STEPS = 500
_IN_CPP = ("kf_step", "ekf_polar_step", "ukf5_step", "imm3_step", "imm5_step")
_ROUNDS = 40
TURN_RATES_DEG_S = (0.0, 1.0, -1.0)
_TRACKER_SETTLING, _TRACKER_SCANS, PLOT_STD_M = 20, 10, 5.0
GNN_SCANS, GNN_GATE = 10, 9.21
_SWEEPS, _CELLS, TRAIN, GUARD = 4096, 2048, 16, 4
RANGE_STD_M, _BEARING_STD_RAD = 20.0, np.deg2rad(0.5)

TakeScan = Callable[[float, np.ndarray], None]
"""Takes a time, s, and plots (P, 2), m."""


@dataclass(frozen=True)
class Work:
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


def add_to(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command to its parser."""
    parser.description = (
        "Measures throughput per estimator on this machine, from Python: the best of "
        f"{REPEATS} times, with ratios within the run."
    )
    parser.add_argument(
        "what",
        nargs="?",
        choices=("engine", "live"),
        default="engine",
        help="the engine (default), or live sessions on the loopback: latency, losses, processor, "
        "memory; about three minutes",
    )
    parser.add_argument("--json", type=Path, metavar="F", help="write the figures as JSON")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    if arguments.what == "live":
        rows = list(progress(benchmark_live.figures(), 12, "measuring"))
        print(benchmark_live.table(rows))
        if arguments.json is not None:
            outputs.write_json(arguments.json, "bench live", rows, seed=SEED)
        return
    works = _works()
    rows = [measured(work) for work in progress(works, len(works), "measuring")]
    add_ratios(rows)
    print(table(rows))
    if arguments.json is not None:
        outputs.write_json(arguments.json, "bench", rows, seed=SEED, runs=REPEATS)


def _works() -> list[Work]:
    return [
        *_step_works(),
        *imm_run_works(),
        *tracker_works(),
        *assignment_works(),
        *video_works(),
    ]


def measured(work: Work) -> dict[str, Any]:
    if work.settle is not None:
        work.settle()
    best_s = min(_elapsed_s(work.call) for _ in range(REPEATS))
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


def add_ratios(rows: list[dict[str, Any]]) -> None:
    """To the steps how many Kalman steps they take, to other programs how many times ours."""
    ours = {row["scenario"]: row for row in rows if row["estimator"] == OURS}
    for row in rows:
        metric = "ns_per_step" if "ns_per_step" in row else "ms_per_scan"
        if metric == "ns_per_step" and row["estimator"] == OURS:
            if "kf_step" in ours:
                row["times_kf_step"] = row[metric] / ours["kf_step"][metric]
        elif row["estimator"] != OURS:
            row[f"times_{OURS}"] = row[metric] / ours[row["scenario"]][metric]


def table(rows: list[dict[str, Any]]) -> str:
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


def _step_works() -> Iterator[Work]:
    polar = wl.RangeBearing(range_std_m=RANGE_STD_M, bearing_std_rad=_BEARING_STD_RAD)
    converted = wl.ConvertedRangeBearing(range_std_m=RANGE_STD_M, bearing_std_rad=_BEARING_STD_RAD)
    z = recordings(RUNS // 10)
    for name, estimator, sensor in (
        ("kf_step", wl.Kalman(_constant_velocity()), converted),
        ("ekf_polar_step", wl.Ekf(_constant_velocity()), polar),
        ("ukf5_step", wl.Ukf(wl.CoordinatedTurnRate(noise=noise())), polar),
        ("imm3_step", _imm(*TURN_RATES_DEG_S), polar),
        ("imm5_step", _imm(0.0, 1.0, -1.0, 3.0, -3.0), polar),
        ("fuzzy_alpha_beta_step", wl.FuzzyAlphaBeta(), polar),
        ("bayesian_alpha_beta_step", wl.BayesianAlphaBeta(), polar),
    ):
        steps = z[..., 0].size
        if name in _IN_CPP:
            call = partial(benchmark.steps, name, rounds=_ROUNDS)
            yield Work(name, OURS, "ns_per_step", call, count=call())
        else:
            yield Work(name, OURS, "ns_per_step", _run_by_run(estimator, z, sensor), steps)
        yield Work(name, LANES, "ns_per_step", _all_runs(estimator, z, sensor), steps)
    few = z[: max(len(z) // 10, 1)]
    tree = wl.ModeHistory(wl.Ekf(wl.CoordinatedTurn(noise=noise())), max_branches=100)
    call = _run_by_run(tree, few, polar)
    yield Work("mode_history100_scan", OURS, "ms_per_scan", call, few[..., 0].size)
    call = _all_runs(tree, few, polar)
    yield Work("mode_history100_scan", LANES, "ms_per_scan", call, few[..., 0].size)


def imm_run_works() -> Iterator[Work]:
    """500 runs of 250 positions through an IMM of three models."""
    name, metric = "imm3_run_python", "ns_per_step"
    sensor = wl.Position(position_std_m=RANGE_STD_M)
    imm, z = _imm(*TURN_RATES_DEG_S), places(recordings(RUNS))
    steps = z[..., 0].size
    yield Work(name, OURS, metric, _run_by_run(imm, z, sensor), steps)
    yield Work(name, LANES, metric, _all_runs(imm, z, sensor), steps)
    if wl.threads() > 1:
        threads = f"{LANES}_{wl.threads()}_threads"
        yield Work(name, threads, metric, _whole_run(imm, z, sensor), steps)
    one = np.concatenate(list(z))[:LOOP_STEPS]

    def loop() -> None:
        imm.start(start())
        for place in one:
            imm.predict(DT_S)
            imm.update(sensor, place)

    yield Work(name, "python_loop", metric, loop, len(one))


def _whole_run(estimator: Any, z: np.ndarray, sensor: Any) -> Callable[[], Any]:
    return lambda: estimator.run(z, dt_s=DT_S, sensor=sensor, start=start())


def _run_by_run(estimator: Any, z: np.ndarray, sensor: Any) -> Callable[[], Any]:
    """One run after the other."""
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


def noise() -> Any:
    return wl.WhiteAcceleration(psd_m2s3=0.01)


def _constant_velocity() -> Any:
    return wl.ConstantVelocity(noise=noise())


def _imm(*turn_rate_deg_s: float) -> Any:
    filters = [
        wl.Ekf(wl.CoordinatedTurn(turn_rate_rad_s=np.deg2rad(rate), noise=noise()))
        for rate in turn_rate_deg_s
    ]
    return wl.Imm(filters=filters, chain=wl.ModeChain(chain(len(filters))))


def chain(modes: int) -> np.ndarray:
    leave = 0.05
    return np.full((modes, modes), leave / (modes - 1)) + (
        1 - leave - leave / (modes - 1)
    ) * np.eye(modes)


def start() -> Any:
    return wl.Gaussian([5000.0, 0.0, 0.0, 5.0], np.diag([400.0, 25.0, 1900.0, 25.0]))


def places(polar: np.ndarray) -> np.ndarray:
    """North and east (..., 2) of ranges and bearings (..., 2)."""
    return polar[..., :1] * np.stack([np.cos(polar[..., 1]), np.sin(polar[..., 1])], -1)


def recordings(runs: int) -> np.ndarray:
    """Plots (runs, scans, 2) of a vessel that steams steadily across the radar's view."""
    rng = np.random.default_rng(SEED)
    after_s = DT_S * np.arange(1, _SCANS + 1)
    north_m, east_m = np.full(_SCANS, 5000.0), 5.0 * after_s
    truth = np.column_stack([np.hypot(north_m, east_m), np.arctan2(east_m, north_m)])
    return truth + rng.normal(size=(runs, _SCANS, 2)) * [RANGE_STD_M, _BEARING_STD_RAD]


# Whole scans --------------------------------------------------------------------------------------


def tracker_works() -> Iterator[Work]:
    """Targets that the tracker has settled on, each seen in every scan, among false plots."""
    for name, targets, false_plots in (("tracker_200", 200, 200), ("tracker_1000", 1000, 500)):
        process = _our_tracker(targets)
        scans = busy_scans(targets, false_plots, _TRACKER_SETTLING + REPEATS * _TRACKER_SCANS)
        yield tracker_work(name, OURS, process, scans, _TRACKER_SETTLING, _TRACKER_SCANS)


def tracker_work(
    name: str,
    estimator: str,
    process: TakeScan,
    scans: list[tuple[float, np.ndarray]],
    settling: int,
    count: int,
) -> Work:
    """So many scans at a time, after those in which tracks start."""
    track = partial(_track, process, iter(scans))
    return Work(
        name, estimator, "ms_per_scan", partial(track, count), count, partial(track, settling)
    )


def busy_scans(targets: int, false_plots: int, count: int) -> list[tuple[float, np.ndarray]]:
    """Times and plots (P, 2), m: boats on straight courses, 600 m apart, and false plots."""
    rng = np.random.default_rng(SEED)
    side = int(np.ceil(np.sqrt(targets)))
    place_m = 2000.0 + 600.0 * np.column_stack(np.divmod(np.arange(targets), side))
    velocity_mps = rng.uniform(-6.0, 6.0, (targets, 2))
    scans = []
    for k in range(count):
        false_m = rng.uniform(1700.0, 1700.0 + 600.0 * side, (false_plots, 2))
        seen_m = place_m + k * DT_S * velocity_mps
        seen_m += rng.normal(scale=PLOT_STD_M, size=place_m.shape)
        scans.append((k * DT_S, np.concatenate([seen_m, false_m])))
    return scans


def _track(process: TakeScan, scans: Iterator[tuple[float, np.ndarray]], count: int) -> None:
    for time_s, position_m in islice(scans, count):
        process(time_s, position_m)


def _our_tracker(targets: int) -> TakeScan:
    radar = wl.Radar(range_std_m=10.0, bearing_std_rad=np.deg2rad(0.1), period_s=DT_S)
    tracker = wl.Tracker(radar, wl.TrackerConfig(max_tracks=2 * targets + 100))

    def process(time_s: float, position_m: np.ndarray) -> None:
        north_m, east_m = position_m.T
        range_m, bearing_rad = np.hypot(north_m, east_m), np.arctan2(east_m, north_m)
        tracker.process(time_s, range_m=range_m, bearing_rad=bearing_rad)

    return process


def assignment_works() -> Iterator[Work]:
    """Optimal assignment of n tracks to n plots, about five candidates a track."""
    for name, scans in assignment_problems().items():
        yield Work(name, OURS, "ms_per_scan", each(ours_assigned, scans), GNN_SCANS)


def assignment_problems() -> dict[str, list[tuple[np.ndarray, np.ndarray, np.ndarray]]]:
    """Compressed rows of the costs of some scans, by the name of the work."""
    rng = np.random.default_rng(SEED)
    return {
        f"gnn_{size}": [_gated_costs(rng, size, 5.0) for _ in range(GNN_SCANS)]
        for size in (200, 1000)
    }


def each(function: Callable[[Any], Any], problems: list[Any]) -> Callable[[], None]:
    def call() -> None:
        for problem in problems:
            function(problem)

    return call


def _gated_costs(
    rng: np.random.Generator, size: int, candidates: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compressed rows of gated distances: each track's plot, and random others."""
    start, columns, costs = [0], [], []
    for row in range(size):
        others = rng.choice(size, rng.poisson(candidates - 1.0), replace=False)
        plots = np.unique(np.append(others, row))
        columns.append(plots)
        costs.append(np.where(plots == row, 0.3, 1.0) * rng.uniform(0.1, GNN_GATE, len(plots)))
        start.append(start[-1] + len(plots))
    return np.array(start), np.concatenate(columns), np.concatenate(costs)


def ours_assigned(cost: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
    return wl.association.assign_sparse(*cost, unassigned_cost=GNN_GATE, columns=len(cost[0]) - 1)


# Radar video --------------------------------------------------------------------------------------


def video_works() -> Iterator[Work]:
    """A turn of 4096 sweeps of 2048 cells of 8 bits, from amplitudes to centroids of echoes."""
    amplitude, factor = noisy_video()
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
        train_cells=TRAIN,
        guard_cells=GUARD,
        threshold_factor=factor,
        max_sweep_cells=_CELLS,
        closed_circle=True,
    )

    def ours() -> None:
        extractor.process(video)
        extractor.finish()

    yield Work("cfar_scan", OURS, "ms_per_scan", ours, 1)


def noisy_video() -> tuple[np.ndarray, float]:
    """Amplitudes of Rayleigh noise and 200 ships, and the factor of the threshold."""
    rng = np.random.default_rng(SEED)
    amplitude = rng.rayleigh(14.0, (_SWEEPS, _CELLS)).clip(0, 255).astype(np.uint8)
    echo = 255 - 5 * np.abs(np.arange(20) - 10)[:, None] - 10 * np.abs(np.arange(5) - 2)
    for sweep, cell in rng.integers(0, (_SWEEPS - 20, _CELLS - 5), (200, 2)):
        amplitude[sweep : sweep + 20, cell : cell + 5] = echo
    return amplitude, wl.video.threshold_factor(1e-9, train_cells=TRAIN)
