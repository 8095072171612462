"""Other programs on the work of ``wakeline bench``, beside Wakeline: those that are installed.

    python cpp/benchmarks/peers.py [--json F]

An IMM over many recordings by numba, JAX and filterpy: the first two are textbook code; numba goes
through the recordings one after the other, JAX through all at once. A tracker of many targets by
Stone Soup, assignments by scipy, echoes of radar video by scipy and opencv. Loops written by hand
in C++ are in `hand_loops.hpp`.
"""

from __future__ import annotations

import argparse
import datetime
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import wakeline as wl
from wakeline.cli import bench, outputs
from wakeline.cli.bench import TakeScan, Work

_STONESOUP_SETTLING = 5  # its scans take seconds


def main() -> None:
    """Print a table of our rows and of theirs."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", type=Path, metavar="F", help="write the figures as JSON")
    arguments = parser.parse_args()
    works = [
        *bench.imm_run_works(),
        *_imm_works(),
        *bench.tracker_works(),
        *_tracker_works(),
        *bench.assignment_works(),
        *_assignment_works(),
        *bench.video_works(),
        *_video_works(),
    ]
    rows = [bench.measured(work) for work in works]
    bench.add_ratios(rows)
    print(bench.table(rows))
    if arguments.json is not None:
        outputs.write_json(arguments.json, "peers", rows, seed=bench.SEED, runs=bench.REPEATS)


# An IMM of three models over 500 recordings -------------------------------------------------------


def _imm_works() -> Iterator[Work]:
    name, metric, problem = "imm3_run_python", "ns_per_step", _linear_imm()
    z = bench.places(bench.recordings(bench.RUNS))
    for peer, run in (("numba", numba_imm(problem)), ("jax", jax_imm(problem))):
        if run is not None:
            yield Work(name, peer, metric, partial(run, z), z[..., 0].size)
    filterpy = _filterpy_imm(problem)
    if filterpy is None:
        return
    one = np.concatenate(list(z))[: bench.LOOP_STEPS]

    def loop() -> None:
        for place in one:
            filterpy.predict()
            filterpy.update(place)

    yield Work(name, "filterpy", metric, loop, len(one))


@dataclass(frozen=True)
class LinearImm:
    """An IMM of K linear models of 4 states, ``[x, vx, y, vy]``, that is given positions.

    Attributes
    ----------
    f, q : (K, 4, 4) arrays
        Transition and process noise of each model, over one scan.
    chain : (K, K) array
        Mode transition probabilities.
    mean, covariance : (4,) and (4, 4) arrays
        Where every recording starts.
    position_std_m : float
        Error of a plot, per axis.
    """

    f: np.ndarray
    q: np.ndarray
    chain: np.ndarray
    mean: np.ndarray
    covariance: np.ndarray
    position_std_m: float


class ImmHistory(NamedTuple):
    """What an IMM says of R recordings of T scans.

    ``mean`` (R, T, 4), ``covariance`` (R, T, 4, 4), ``mode_probability`` (R, T, K) and
    ``log_likelihood`` (R, T).
    """

    mean: np.ndarray
    covariance: np.ndarray
    mode_probability: np.ndarray
    log_likelihood: np.ndarray


Run = Callable[[np.ndarray], ImmHistory]


def numba_imm(imm: LinearImm) -> Run | None:
    """What takes plots (R, T, 2) through the IMM, compiled by numba; None where it is missing."""
    try:
        import numba
    except ImportError:
        return None
    run = numba.njit(error_model="numpy")(_run_in_loops)
    r = imm.position_std_m**2

    def call(z: np.ndarray) -> ImmHistory:
        return ImmHistory(*run(z, imm.f, imm.q, imm.chain, imm.mean, imm.covariance, r))

    return call


def jax_imm(imm: LinearImm) -> Run | None:
    """The same by JAX, `vmap` over recordings of a `scan` over time; None where it is missing.

    Switches JAX to double precision. It takes as many threads as the process may have.
    """
    try:
        import jax
    except ImportError:
        return None
    jax.config.update("jax_enable_x64", True)
    run = jax.jit(jax.vmap(_recording_in_jax(imm)))

    def call(z: np.ndarray) -> ImmHistory:
        return ImmHistory(*(np.asarray(part) for part in run(z)))

    return call


def _linear_imm() -> LinearImm:
    """The three models as other programs take them."""
    motions = [
        wl.CoordinatedTurn(turn_rate_rad_s=rate, noise=bench.noise())
        for rate in np.deg2rad(bench.TURN_RATES_DEG_S)
    ]
    return LinearImm(
        f=np.array([motion.matrix(bench.DT_S) for motion in motions]),
        q=np.array([motion.process_noise(bench.DT_S) for motion in motions]),
        chain=bench.chain(len(motions)),
        mean=np.asarray(bench.start().mean),
        covariance=np.asarray(bench.start().covariance),
        position_std_m=bench.RANGE_STD_M,
    )


def _filterpy_imm(problem: LinearImm) -> Any:
    try:
        from filterpy.kalman import IMMEstimator, KalmanFilter
    except ImportError:
        return None
    filters = []
    for f, q in zip(problem.f, problem.q, strict=True):
        one = KalmanFilter(dim_x=4, dim_z=2)
        one.x, one.P, one.F, one.Q = problem.mean, problem.covariance, f, q
        one.H = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0]])
        one.R = problem.position_std_m**2 * np.eye(2)
        filters.append(one)
    return IMMEstimator(filters, np.full(len(filters), 1 / len(filters)), problem.chain)


def _run_in_loops(
    z: np.ndarray,
    f: np.ndarray,
    q: np.ndarray,
    chain: np.ndarray,
    start: np.ndarray,
    start_covariance: np.ndarray,
    r: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    runs, scans, modes, n = z.shape[0], z.shape[1], f.shape[0], 4
    means = np.zeros((runs, scans, n))
    covariances = np.zeros((runs, scans, n, n))
    probabilities = np.zeros((runs, scans, modes))
    log_likelihoods = np.zeros((runs, scans))
    x, p = np.empty((modes, n)), np.empty((modes, n, n))
    mu, expected = np.empty(modes), np.empty(modes)
    x0, p0 = np.empty((modes, n)), np.empty((modes, n, n))
    d, fp, gain = np.empty(n), np.empty((n, n)), np.empty((n, 2))
    for run in range(runs):
        mu[:] = 1.0 / modes
        for j in range(modes):
            x[j], p[j] = start, start_covariance
        for scan in range(scans):
            # Mixing
            for j in range(modes):
                expected[j] = 0.0
                for i in range(modes):
                    expected[j] += chain[i, j] * mu[i]
                x0[j], p0[j] = 0.0, 0.0
                for i in range(modes):
                    weight = chain[i, j] * mu[i] / expected[j]
                    for a in range(n):
                        x0[j, a] += weight * x[i, a]
                for i in range(modes):
                    weight = chain[i, j] * mu[i] / expected[j]
                    for a in range(n):
                        d[a] = x[i, a] - x0[j, a]
                    for a in range(n):
                        for b in range(n):
                            p0[j, a, b] += weight * (p[i, a, b] + d[a] * d[b])
            total = 0.0
            for j in range(modes):
                # Prediction
                for a in range(n):
                    x[j, a] = 0.0
                    for b in range(n):
                        x[j, a] += f[j, a, b] * x0[j, b]
                for a in range(n):
                    for b in range(n):
                        fp[a, b] = 0.0
                        for c in range(n):
                            fp[a, b] += f[j, a, c] * p0[j, c, b]
                for a in range(n):
                    for b in range(n):
                        element = q[j, a, b]
                        for c in range(n):
                            element += fp[a, c] * f[j, b, c]
                        p[j, a, b] = element
                # Correction
                v0, v1 = z[run, scan, 0] - x[j, 0], z[run, scan, 1] - x[j, 2]
                s00, s01, s11 = p[j, 0, 0] + r, p[j, 0, 2], p[j, 2, 2] + r
                det = s00 * s11 - s01 * s01
                i00, i01, i11 = s11 / det, -s01 / det, s00 / det
                for a in range(n):
                    gain[a, 0] = p[j, a, 0] * i00 + p[j, a, 2] * i01
                    gain[a, 1] = p[j, a, 0] * i01 + p[j, a, 2] * i11
                    x[j, a] += gain[a, 0] * v0 + gain[a, 1] * v1
                for a in range(n):
                    gain_s0 = gain[a, 0] * s00 + gain[a, 1] * s01
                    gain_s1 = gain[a, 0] * s01 + gain[a, 1] * s11
                    for b in range(n):
                        p[j, a, b] -= gain_s0 * gain[b, 0] + gain_s1 * gain[b, 1]
                nis = v0 * (i00 * v0 + i01 * v1) + v1 * (i01 * v0 + i11 * v1)
                mu[j] = expected[j] * np.exp(-0.5 * nis) / (2.0 * np.pi * np.sqrt(det))
                total += mu[j]
            # Mode probabilities and combined estimate
            for j in range(modes):
                mu[j] /= total
                probabilities[run, scan, j] = mu[j]
                for a in range(n):
                    means[run, scan, a] += mu[j] * x[j, a]
            for j in range(modes):
                for a in range(n):
                    d[a] = x[j, a] - means[run, scan, a]
                for a in range(n):
                    for b in range(n):
                        covariances[run, scan, a, b] += mu[j] * (p[j, a, b] + d[a] * d[b])
            log_likelihoods[run, scan] = np.log(total)
    return means, covariances, probabilities, log_likelihoods


def _recording_in_jax(imm: LinearImm) -> Callable[[Any], Any]:
    import jax
    import jax.numpy as jnp

    f, q, chain = jnp.asarray(imm.f), jnp.asarray(imm.q), jnp.asarray(imm.chain)
    modes, r = len(f), imm.position_std_m**2

    def moments(weight: Any, x: Any, p: Any) -> tuple[Any, Any]:
        mean = weight @ x
        d = x - mean
        return mean, jnp.einsum("i,iab->ab", weight, p + d[:, :, None] * d[:, None, :])

    def predict_and_correct(f: Any, q: Any, x: Any, p: Any, z: Any) -> tuple[Any, Any, Any]:
        x, p = f @ x, f @ p @ f.T + q
        pht = p[:, ::2]
        v, s = z - x[::2], pht[::2] + r * jnp.eye(2)
        det = s[0, 0] * s[1, 1] - s[0, 1] * s[1, 0]
        inverse = jnp.array([[s[1, 1], -s[0, 1]], [-s[1, 0], s[0, 0]]]) / det
        gain = pht @ inverse
        likelihood = jnp.exp(-0.5 * v @ inverse @ v) / (2 * jnp.pi * jnp.sqrt(det))
        return x + gain @ v, p - gain @ s @ gain.T, likelihood

    def step(belief: Any, z: Any) -> tuple[Any, Any]:
        x, p, mu = belief
        expected = mu @ chain
        weight = chain * mu[:, None] / expected
        x, p = jax.vmap(moments, (1, None, None))(weight, x, p)
        x, p, likelihood = jax.vmap(predict_and_correct, (0, 0, 0, 0, None))(f, q, x, p, z)
        mu = expected * likelihood
        total = mu.sum()
        mu = mu / total
        return (x, p, mu), (*moments(mu, x, p), mu, jnp.log(total))

    start = (
        jnp.broadcast_to(jnp.asarray(imm.mean), (modes, 4)),
        jnp.broadcast_to(jnp.asarray(imm.covariance), (modes, 4, 4)),
        jnp.full(modes, 1.0 / modes),
    )
    return lambda z: jax.lax.scan(step, start, z)[1]


# A tracker of 200 targets -------------------------------------------------------------------------


def _tracker_works() -> Iterator[Work]:
    process = stonesoup_tracker(bench.PLOT_STD_M)
    if process is not None:
        scans = bench.busy_scans(200, 200, _STONESOUP_SETTLING + bench.REPEATS)
        yield bench.tracker_work("tracker_200", "stonesoup", process, scans, _STONESOUP_SETTLING, 1)


def stonesoup_tracker(position_std_m: float) -> TakeScan | None:
    """What takes scans through Stone Soup's components; None where it is missing.

    Kalman filters of constant velocity, global nearest neighbour among the four nearest plots; a
    track starts by three plots and ends after three scans without one.
    """
    try:
        from stonesoup.dataassociator.tree import DetectionKDTreeGNN2D
        from stonesoup.deleter.time import UpdateTimeStepsDeleter
        from stonesoup.hypothesiser.distance import DistanceHypothesiser
        from stonesoup.initiator.simple import MultiMeasurementInitiator
        from stonesoup.measures import Mahalanobis
        from stonesoup.models.measurement.linear import LinearGaussian
        from stonesoup.models.transition.linear import (
            CombinedLinearGaussianTransitionModel,
            ConstantVelocity,
        )
        from stonesoup.predictor.kalman import KalmanPredictor
        from stonesoup.types.detection import Detection
        from stonesoup.types.state import GaussianState
        from stonesoup.updater.kalman import KalmanUpdater
    except ImportError:
        return None
    sensor = LinearGaussian(4, (0, 2), position_std_m**2 * np.eye(2))
    motion = CombinedLinearGaussianTransitionModel([ConstantVelocity(0.05), ConstantVelocity(0.05)])
    predictor, updater = KalmanPredictor(motion), KalmanUpdater(sensor)
    hypothesiser = DistanceHypothesiser(predictor, updater, Mahalanobis(), missed_distance=3.5)
    associator = DetectionKDTreeGNN2D(
        hypothesiser,
        predictor,
        updater,
        number_of_neighbours=4,
        max_distance_covariance_multiplier=3.0,
    )
    deleter = UpdateTimeStepsDeleter(3)
    initiator = MultiMeasurementInitiator(
        GaussianState(np.zeros((4, 1)), np.diag([0.0, 36.0, 0.0, 36.0])),
        deleter=deleter,
        data_associator=associator,
        updater=updater,
        measurement_model=sensor,
        min_points=3,
    )
    began = datetime.datetime(2026, 1, 1)
    tracks: set[Any] = set()

    def take(time_s: float, position_m: np.ndarray) -> None:
        now = began + datetime.timedelta(seconds=time_s)
        plots = {
            Detection(place[:, None], timestamp=now, measurement_model=sensor)
            for place in position_m
        }
        taken = set()
        for track, hypothesis in associator.associate(tracks, plots, now).items():
            if hypothesis:
                track.append(updater.update(hypothesis))
                taken.add(hypothesis.measurement)
            else:
                track.append(hypothesis.prediction)
        tracks.difference_update(deleter.delete_tracks(tracks))
        tracks.update(initiator.initiate(plots - taken, now))

    return take


# Assignments --------------------------------------------------------------------------------------


def _assignment_works() -> Iterator[Work]:
    try:
        from scipy.sparse.csgraph import min_weight_full_bipartite_matching as match
    except ImportError:
        return
    for name, scans in bench.assignment_problems().items():
        matrices = [_with_ways_out(cost) for cost in scans]
        for cost, matrix in zip(scans, matrices, strict=True):
            rows, columns = match(matrix)
            best, ours = matrix[rows, columns].sum(), _total_cost(cost, bench.ours_assigned(cost))
            if not np.isclose(best, ours, rtol=1e-9):
                raise RuntimeError(f"{name}: a total of {ours}, scipy has {best}")
        yield Work(name, "scipy", "ms_per_scan", bench.each(match, matrices), bench.GNN_SCANS)


def _total_cost(cost: tuple[np.ndarray, np.ndarray, np.ndarray], pairs: np.ndarray) -> float:
    start, columns, costs = cost
    total = bench.GNN_GATE * (len(start) - 1 - len(pairs))
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
    return hstack([pairs, diags_array(np.full(size, bench.GNN_GATE))], format="csr")


# Radar video --------------------------------------------------------------------------------------


def _video_works() -> Iterator[Work]:
    amplitude, factor = bench.noisy_video()
    for peer, scan in (("scipy", _scipy_scan()), ("opencv", _opencv_scan())):
        if scan is not None:
            yield Work("cfar_scan", peer, "ms_per_scan", partial(scan, amplitude, factor), 1)


def _scipy_scan() -> Callable[[np.ndarray, float], Any] | None:
    """The same with scipy's filter and labels; sums over the few cells that are left by numpy."""
    try:
        from scipy import ndimage
    except ImportError:
        return None

    def scan(amplitude: np.ndarray, factor: float) -> Any:
        window = ndimage.uniform_filter1d(amplitude, bench.TRAIN, axis=1, output=np.float32)
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
        window = cv2.boxFilter(amplitude, cv2.CV_32F, (bench.TRAIN, 1))
        above = _above(amplitude, window, factor).astype(np.uint8)
        return cv2.connectedComponentsWithStats(above, connectivity=8)

    return scan


def _above(amplitude: np.ndarray, window: np.ndarray, factor: float) -> np.ndarray:
    """Cells above the mean of the windows on both sides; none at the ends of sweeps."""
    apart = bench.TRAIN + 2 * bench.GUARD + 1
    first = bench.GUARD + (bench.TRAIN + 1) // 2
    threshold = window[:, :-apart] + window[:, apart:]
    threshold *= np.float32(factor / 2)
    above = np.zeros(amplitude.shape, bool)
    inside = slice(first, first + threshold.shape[1])
    np.greater(amplitude[:, inside], threshold, out=above[:, inside])
    return above


if __name__ == "__main__":
    main()
