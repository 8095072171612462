"""Stone Soup, FilterPy and Wakeline on the same recordings: GOSPA, switches and time.

    pip install stonesoup filterpy
    python compare_peers.py            # one real recording and one simulated scene
    python compare_peers.py --all      # all of them, which takes Stone Soup many minutes

A peer that is not installed is left out. Each tracker is causal and gets the same plots at the end
of each scan; Wakeline also uses the time of each plot. Stone Soup is a Kalman filter of constant
velocity with global nearest neighbor, FilterPy an IMM of two Kalman filters with the association
written here, as FilterPy has none. On the real recordings both have the errors and noise that a
random search of a hundred tries found best for them, in the scenes the errors that were simulated.
"""

from __future__ import annotations

import argparse
import datetime
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

import wakeline as wl
from wakeline.recording import Episode, Recording, Tracks
from wakeline.scenario.dense import RADAR, SCENES

F = np.eye(4) + np.diag([1.0, 0.0, 1.0], 1)  # of one second; [x, vx, y, vy]


@dataclass(frozen=True)
class Tuned:
    """What a peer is given: errors of plots, process noise, gate, and the life of a track."""

    radar: wl.Radar
    psd_m2s3: tuple[float, float]  # of the quiet and of the restless filter
    gate_sigma: float
    hits: int
    misses: int


def tuned(
    range_m: float, bearing_deg: float, extent_m: float, *psd: float, gate: float, life: tuple
) -> Tuned:
    errors = {"range_std_m": range_m, "bearing_std_rad": np.deg2rad(bearing_deg)}
    return Tuned(wl.Radar(**errors, extent_std_m=extent_m), (psd[0], psd[-1]), gate, *life)


SCENE = tuned(10.0, 0.5, 0.0, 0.02, 0.5, gate=3.5, life=(3, 5))
STONE_SOUP = {
    "joyride": tuned(10.1, 0.92, 8.2, 2.7, gate=3.2, life=(3, 4)),
    "autoferry": tuned(3.2, 0.63, 5.5, 0.26, gate=3.6, life=(4, 5)),
}
FILTERPY = {
    "joyride": tuned(8.6, 0.71, 14.0, 0.1, 5.6, gate=3.5, life=(3, 4)),
    "autoferry": tuned(3.0, 2.0, 2.0, 0.005, 1.35, gate=3.5, life=(3, 3)),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--all", action="store_true", help="all recordings and scenes")
    every = parser.parse_known_args()[0].all
    recordings = dict(cases(every))
    print(f"{'recording':<12}{'tracker':<12}{'GOSPA m':>9}{'switches':>10}{'ms a scan':>11}")
    missing = []
    for name, recording in recordings.items():
        for tracker, track in (
            ("wakeline", with_wakeline),
            ("stonesoup", with_stone_soup),
            ("filterpy", with_filterpy),
        ):
            if tracker in missing:
                continue
            try:
                began_s = time.perf_counter()
                tracks = track(name, recording)
            except ImportError:
                missing.append(tracker)
                continue
            scans = sum(map(len, recording))
            each_ms = 1e3 * (time.perf_counter() - began_s) / scans
            score = wl.metrics.score(tracks, recording).overall
            figures = f"{score.gospa_m:9.1f}{score.switches:10d}{each_ms:11.2f}"
            print(f"{name:<12}{tracker:<12}{figures}", flush=True)
    for tracker in missing:
        print(f"{tracker} is not installed: pip install {tracker}")


def cases(every: bool) -> Iterator[tuple[str, Recording]]:
    """The recordings by name."""
    yield "joyride", wl.recording.load("joyride")
    yield "crossings", replace(SCENES["crossings"], scans=25).record(1)
    if every:
        yield "autoferry", wl.recording.load("autoferry")
        for name in ("open_sea", "craft", "clutter_300"):
            yield name, SCENES[name].record(1)


def with_wakeline(name: str, recording: Recording) -> Tracks:
    """Wakeline's tracker with its defaults and the errors of the radar."""
    if name not in SCENES:
        return wl.track_recording(recording)
    errors = {"range_std_m": RADAR.range_std_m, "bearing_std_rad": RADAR.bearing_std_rad}
    return wl.track_recording(recording, radar=wl.Radar(**errors, period_s=RADAR.period_s))


# Peers --------------------------------------------------------------------------------------------

# What takes the time of a scan and its plots, positions (n, 2) and covariances (n, 2, 2), and gives
# the confirmed tracks: number, state and covariance of each.
TakeScan = Callable[[float, np.ndarray, np.ndarray], list[tuple[int, np.ndarray, np.ndarray]]]


def with_peer(recording: Recording, radar: wl.Radar, make: Callable[[], TakeScan]) -> Tracks:
    """Each episode through a new tracker of a peer."""
    rows = []
    for episode in recording:
        take = make()
        for time_s, position_m, covariance in scans_of(episode, radar):
            confirmed = take(time_s, position_m, covariance)
            rows += [(episode.name, time_s, *track) for track in confirmed]
    scenario, time_s, number, state, covariance = zip(*rows, strict=True)
    return Tracks(
        track_id=np.array([f"{n}" for n in number]),
        time_s=np.array(time_s),
        state=np.array(state),
        covariance=np.array(covariance),
        scenario=np.array(scenario),
    )


def scans_of(episode: Episode, radar: wl.Radar) -> Iterator[tuple[float, np.ndarray, np.ndarray]]:
    """The plots of each scan as positions with covariances, at the end of the scan."""
    for scan in episode.scans:
        plots = [
            radar.position(*plot, wl.measurement.OwnShip(north_m=north_m, east_m=east_m))
            for plot, north_m, east_m in zip(
                scan.range_bearing, scan.own_north_m, scan.own_east_m, strict=True
            )
        ]
        position_m = np.array([plot.mean for plot in plots]).reshape(-1, 2)
        covariance = np.array([plot.covariance for plot in plots]).reshape(-1, 2, 2)
        yield scan.time_s, position_m, covariance


def with_stone_soup(name: str, recording: Recording) -> Tracks:
    settings = STONE_SOUP.get(name, SCENE)
    return with_peer(recording, settings.radar, lambda: stone_soup(settings))


def stone_soup(settings: Tuned) -> TakeScan:
    """Stone Soup's components, as in its tutorials."""
    from stonesoup.dataassociator.neighbour import GNNWith2DAssignment
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

    axis = ConstantVelocity(settings.psd_m2s3[0])
    predictor = KalmanPredictor(CombinedLinearGaussianTransitionModel([axis, axis]))
    updater = KalmanUpdater(None)
    hypothesiser = DistanceHypothesiser(predictor, updater, Mahalanobis(), settings.gate_sigma)
    associator = GNNWith2DAssignment(hypothesiser)
    deleter = UpdateTimeStepsDeleter(settings.misses)
    initiator = MultiMeasurementInitiator(
        GaussianState(np.zeros((4, 1)), np.diag([0.0, 100.0, 0.0, 100.0])),
        deleter=deleter,
        data_associator=associator,
        updater=updater,
        min_points=settings.hits,
    )
    epoch, tracks, numbers = datetime.datetime(2026, 1, 1), set(), {}
    first_s = None

    def take(time_s: float, position_m: np.ndarray, covariance: np.ndarray) -> list:
        nonlocal first_s
        first_s = time_s if first_s is None else first_s
        now = epoch + datetime.timedelta(seconds=time_s - first_s)
        plots = {
            Detection(place[:, None], now, measurement_model=LinearGaussian(4, (0, 2), errors))
            for place, errors in zip(position_m, covariance, strict=True)
        }
        free = set(plots)
        for track, found in associator.associate(tracks, plots, now).items():
            track.append(updater.update(found) if found else found.prediction)
            free.discard(found.measurement)
        tracks.difference_update(deleter.delete_tracks(tracks))
        tracks.update(initiator.initiate(free, now))
        return [
            (numbers.setdefault(track.id, len(numbers)), np.ravel(track.mean), track.covar)
            for track in tracks
        ]

    return take


def with_filterpy(name: str, recording: Recording) -> Tracks:
    settings = FILTERPY.get(name, SCENE)
    return with_peer(recording, settings.radar, lambda: filterpy_imm(settings))


def filterpy_imm(settings: Tuned) -> TakeScan:
    """FilterPy's IMM of two Kalman filters for each track, with global nearest neighbor."""
    from filterpy.common import Q_continuous_white_noise
    from filterpy.kalman import IMMEstimator, KalmanFilter
    from scipy.optimize import linear_sum_assignment

    H = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])

    def start(place: np.ndarray, errors: np.ndarray) -> IMMEstimator:
        filters = []
        for _ in settings.psd_m2s3:
            one = KalmanFilter(dim_x=4, dim_z=2)
            one.H = H
            one.x = (H.T @ place)[:, None]
            one.P = H.T @ errors @ H + np.diag([0.0, 100.0, 0.0, 100.0])
            filters.append(one)
        return IMMEstimator(filters, np.array([0.9, 0.1]), np.array([[0.97, 0.03], [0.03, 0.97]]))

    tracks: list[dict] = []
    count, last_s = 0, None

    def predict(imm: IMMEstimator, dt_s: float) -> None:
        for one, psd in zip(imm.filters, settings.psd_m2s3, strict=True):
            one.F = np.eye(4) + dt_s * (F - np.eye(4))
            one.Q = Q_continuous_white_noise(2, dt_s, psd, block_size=2)
        imm.predict()

    def take(time_s: float, position_m: np.ndarray, covariance: np.ndarray) -> list:
        nonlocal count, last_s
        dt_s, last_s = time_s - (time_s if last_s is None else last_s), time_s
        limit = settings.gate_sigma**2
        cost = np.full((len(tracks), len(position_m)), limit)
        for row, track in zip(cost, tracks, strict=True):
            predict(track["imm"], dt_s)
            track["misses"] += 1
            if len(position_m):
                error_m = position_m - (H @ track["imm"].x).ravel()
                spread = H @ track["imm"].P @ H.T + covariance
                whitened = np.linalg.solve(spread, error_m[:, :, None])[:, :, 0]
                row[:] = np.minimum(np.sum(error_m * whitened, axis=1), limit)
        free = set(range(len(position_m)))
        for k, plot in zip(*linear_sum_assignment(cost), strict=True):
            if cost[k, plot] < limit:
                for one in tracks[k]["imm"].filters:
                    one.R = covariance[plot]
                tracks[k]["imm"].update(position_m[plot][:, None])
                tracks[k]["hits"] += 1
                tracks[k]["misses"] = 0
                free.discard(plot)
        most = {True: settings.misses, False: 1}
        tracks[:] = [t for t in tracks if t["misses"] <= most[t["hits"] >= settings.hits]]
        for plot in sorted(free):
            count += 1
            imm = start(position_m[plot], covariance[plot])
            tracks.append({"imm": imm, "number": count, "hits": 1, "misses": 0})
        return [
            (track["number"], track["imm"].x.ravel().copy(), track["imm"].P.copy())
            for track in tracks
            if track["hits"] >= settings.hits
        ]

    return take


main()
