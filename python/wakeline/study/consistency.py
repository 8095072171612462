"""Consistency: whether errors are as large as estimators report, and their mean is zero.

- ``range_...`` scenarios: vessels at one range with one bearing error, for ``tracker``, ``kalman``
  and ``imm`` on converted plots, and ``ekf`` on range and bearing. ``outward_`` is the error of the
  range: its mean, its standard deviation, and the first over the second.
- ``straight``, ``altering`` (ships that turn by half a degree to one degree a second),
  ``maneuvering`` (:func:`wakeline.scenario.random_maneuvers`), ``solent_60m`` and ``solent_15m``
  (:mod:`wakeline.study.solent`): the tracker with its default models, and with
  ``VesselModels.ships()`` on ships. The prefix ``turn_`` means scans in a turn and the 30 s after
  it, ``straight_`` all others.
- ``joyride`` and ``autoferry``: what the tracker reports of recorded vessels. ``debiased_`` is less
  the mean offset: of the bearing, and of the position of each target.
- ``existence_...``: the track-scans of the scenes of dense traffic whose probability of existence
  is from 0.85 to 0.95, and how many of these are of a vessel.

NEES is the normalized estimation error squared, of position or velocity: 2 where the covariance is
right. Simulated echoes wander by `extent_std_m` of the radar's parameters. A tenth of the runs,
rounded up, is drawn of each scenario, five times as many of ships and ranges, a hundredth of each
scene.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import wakeline as wl
from wakeline import WhiteAcceleration, metrics, plot, recording
from wakeline.eval import nees
from wakeline.recording import Episode, Recording, Tracks
from wakeline.scenario import RadarSimulator, Segment, Truth, random_maneuvers
from wakeline.scenario.dense import RADAR as DENSE_RADAR
from wakeline.scenario.dense import SCENES
from wakeline.scenario.radar import polar

from . import solent
from .base import Done, Picture, Plan, Request, Rows, Study, radar_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from wakeline.scenario.scenario import AnyTruth

RANGES: tuple[tuple[float, float], ...] = (
    (3e3, 2.0),
    (6e3, 2.0),
    (12e3, 2.0),
    (24e3, 1.0),
    (24e3, 3.0),
    (48e3, 1.0),
    (48e3, 3.0),
)
ESTIMATORS = ("tracker", "kalman", "imm", "ekf")
MOTIONS = ("straight", "altering", "maneuvering", "solent_60m", "solent_15m")
SHIPS = ("straight", "altering")
RECORDINGS = ("joyride", "autoferry")
PERIOD_S = 2.5
SETTLED_SCANS = 20
TURN_DEG_S = 0.05
SURE = (0.85, 0.95)

_EXTENT_STD_M = 5.0
_RANGE_STD_M, _BEARING_STD_RAD = 10.0, np.deg2rad(0.5)
_SCANS = 100
_PSD_M2S3 = 0.003
_START_SPEED_STD_MPS = 10.0
_GATE_M, _GATE_STDS = 60.0, 3.0
_POSITION, _VELOCITY = slice(0, 4, 2), slice(1, 4, 2)


class Found(NamedTuple):
    """Estimates beside the truth: means (n, 4), covariances (n, 4, 4), truth (n, 4)."""

    mean: np.ndarray
    covariance: np.ndarray
    truth: np.ndarray

    def where(self, chosen: np.ndarray) -> Found:
        return Found(*(part[chosen] for part in self))

    def nees(self, part: slice, error: np.ndarray | None = None) -> np.ndarray:
        """NEES (n,) of the position or the velocity."""
        if error is None:
            error = (self.mean - self.truth)[:, part]
        return nees(error, self.covariance[:, part, part])


# Simulated vessels --------------------------------------------------------------------------------


def plots(
    truth: AnyTruth, radar: RadarSimulator, scans: int, extent_std_m: float, seed: Sequence[int]
) -> tuple[np.ndarray, np.ndarray]:
    """Times (T,) and plots (T, 2) of a vessel whose echo wanders."""
    rng = np.random.default_rng(seed)
    time_s = radar.period_s * np.arange(scans)
    echo = truth.state_at(time_s).copy()
    echo[:, _POSITION] += extent_std_m * rng.standard_normal((scans, 2))
    return time_s, radar.readings(polar(echo), rng)


def tracked(
    truth: AnyTruth,
    radar: RadarSimulator,
    scans: int,
    seed: Sequence[int],
    *,
    extent_std_m: float = _EXTENT_STD_M,
    models: wl.VesselModels | None = None,
) -> tuple[np.ndarray, Found]:
    """Times (n,) and estimates of the confirmed tracks of a vessel alone."""
    tracker = wl.Tracker(
        radar_of(radar, extent_std_m=extent_std_m),
        models=models or wl.VesselModels(),
    )
    rows = []
    for time_s, z in zip(*plots(truth, radar, scans, extent_std_m, seed), strict=True):
        seen = z[np.newaxis][np.isfinite(z[:1])]  # (1, 2), or none
        tracker.process(float(time_s), range_m=seen[:, 0], bearing_rad=seen[:, 1])
        table = tracker.tracks()
        if time_s >= SETTLED_SCANS * radar.period_s:
            rows += [(time_s, *row) for row in zip(table.mean, table.covariance, strict=True)]
    time_s = np.array([row[0] for row in rows])
    mean = np.array([row[1] for row in rows]).reshape(-1, 4)
    covariance = np.array([row[2] for row in rows]).reshape(-1, 4, 4)
    return time_s, Found(mean, covariance, truth.state_at(time_s))


def at_range(range_m: float, seed: Sequence[int]) -> Truth:
    """A vessel on a straight course, about at a range."""
    rng = np.random.default_rng([*seed, int(range_m)])
    bearing_rad, course_rad = rng.uniform(-np.pi, np.pi, 2)
    place, velocity = (
        range_m * np.exp(1j * bearing_rad),
        rng.uniform(3, 12) * np.exp(1j * course_rad),
    )
    return Truth([place.real, velocity.real, place.imag, velocity.imag])


def ship(seed: Sequence[int], *, alters: bool) -> Truth:
    """A ship of 5 to 10 m/s at 2 to 8 km, for ten minutes, that alters its course twice or not."""
    rng = np.random.default_rng([*seed, 7])
    place = rng.uniform(2e3, 8e3) * np.exp(1j * rng.uniform(-np.pi, np.pi))
    velocity = rng.uniform(5.0, 10.0) * np.exp(1j * rng.uniform(-np.pi, np.pi))
    legs = [Segment(240.0 if alters else 600.0)]
    for _ in range(2 * alters):
        rate_rad_s = np.deg2rad(rng.uniform(0.5, 1.0)) * rng.choice([-1, 1])
        legs += [Segment(rng.uniform(30.0, 60.0), rate_rad_s), Segment(240.0)]
    return Truth([place.real, velocity.real, place.imag, velocity.imag], legs)


def in_turn(truth: AnyTruth, time_s: np.ndarray) -> np.ndarray:
    """Whether times (n,) are in a turn, or in the 30 s after one."""
    fine_s = np.arange(0.0, time_s.max(initial=0.0) + 1.0, 0.5)
    turning_s = fine_s[np.abs(truth.turn_rate_at(fine_s)) > np.deg2rad(TURN_DEG_S)]
    return solent.soon_after(turning_s, time_s)


# Range and bearing --------------------------------------------------------------------------------


def _estimator(name: str) -> Any:
    noise = WhiteAcceleration(psd_m2s3=_PSD_M2S3)
    if name == "ekf":
        return wl.Ekf(wl.ConstantVelocity(noise=noise))
    if name == "kalman":
        return wl.Kalman(wl.ConstantVelocity(noise=noise))
    quiet = WhiteAcceleration(psd_m2s3=_PSD_M2S3 / 2)
    return wl.Imm(
        [wl.Kalman(wl.ConstantVelocity(noise=part)) for part in (quiet, noise)],
        wl.ModeChain.from_sojourn_s([60.0, 60.0]),
    )


def _wander(truth: Truth, time_s: np.ndarray, seed: Sequence[int]) -> np.ndarray:
    """States (T, 4) of a vessel that moves by the noise of the filters."""
    rng = np.random.default_rng([*seed, 3])
    dt = PERIOD_S
    step = np.array([[1.0, dt], [0.0, 1.0]])
    root = np.linalg.cholesky(_PSD_M2S3 * np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]]))
    state = truth.state_at(0.0)[0].reshape(2, 2)
    states = [state]
    for _ in time_s[1:]:
        state = state @ step.T + rng.standard_normal((2, 2)) @ root.T
        states.append(state)
    return np.array(states).reshape(-1, 4)


def _filtered(name: str, range_m: float, bearing_rad: float, seed: Sequence[int]) -> Found:
    sensor_of = wl.RangeBearing if name == "ekf" else wl.ConvertedRangeBearing
    sensor = sensor_of(range_std_m=_RANGE_STD_M, bearing_std_rad=bearing_rad)
    radar = RadarSimulator(_RANGE_STD_M, bearing_rad, PERIOD_S)
    time_s = PERIOD_S * np.arange(_SCANS)
    states = _wander(at_range(range_m, seed), time_s, seed)
    z = radar.readings(polar(states), np.random.default_rng(seed))
    start = wl.one_point(sensor, z[0], speed_std_mps=_START_SPEED_STD_MPS)
    result = _estimator(name).run(z[1:], dt_s=PERIOD_S, sensor=sensor, start=start)
    settled = slice(SETTLED_SCANS - 1, None)
    return Found(
        result.mean[settled, :4], result.covariance[settled, :4, :4], states[SETTLED_SCANS:]
    )


def _range_run(range_m: float, bearing_deg: float, seed: Sequence[int]) -> dict[str, np.ndarray]:
    """Error of the range and NEES of the position, (2, n), of every estimator."""
    bearing_rad = float(np.deg2rad(bearing_deg))
    radar = RadarSimulator(_RANGE_STD_M, bearing_rad, PERIOD_S)
    found = {name: _filtered(name, range_m, bearing_rad, seed) for name in ESTIMATORS[1:]}
    truth = at_range(range_m, seed)
    found["tracker"] = tracked(truth, radar, _SCANS, seed, extent_std_m=0.0)[1]
    return {
        name: np.array(
            [
                np.hypot(*of.mean[:, _POSITION].T) - np.hypot(*of.truth[:, _POSITION].T),
                of.nees(_POSITION),
            ]
        )
        for name, of in found.items()
    }


def _range_row(runs: list[np.ndarray]) -> dict[str, float]:
    outward_m, of_position = np.concatenate(runs, axis=1)
    return {
        "outward_mean_m": float(outward_m.mean()),
        "outward_std_m": float(outward_m.std()),
        "outward_ratio": float(outward_m.mean() / outward_m.std()),
        "position_nees": float(of_position.mean()),
    }


# Motions ------------------------------------------------------------------------------------------


def _motion_runs(motion: str, runs: int, seed: int) -> Iterator[tuple[AnyTruth, RadarSimulator]]:
    radar = RadarSimulator(_RANGE_STD_M, _BEARING_STD_RAD, PERIOD_S)
    if motion.startswith("solent"):
        coastal = solent.RADARS[motion.replace("solent", "coastal")]
        yield from ((truth, coastal) for truth in solent.vessels().values())
    elif motion == "maneuvering":
        yield from ((scenario.truth, radar) for scenario in random_maneuvers(runs, seed))
    else:
        for k in range(runs):
            yield ship([seed, k], alters=motion == "altering"), radar


def _motion_run(motion: str, models: str, runs: int, seed: int) -> np.ndarray:
    """NEES of position and velocity, and whether in a turn, (3, n)."""
    chosen = wl.VesselModels.ships() if models == "tracker_ships" else None
    found = []
    for k, (truth, radar) in enumerate(_motion_runs(motion, runs, seed)):
        scans = int(truth.end_time_s // radar.period_s)
        time_s, of = tracked(truth, radar, scans, [seed, k], models=chosen)
        turns = (solent.turning if motion.startswith("solent") else in_turn)(truth, time_s)
        found.append(np.array([of.nees(_POSITION), of.nees(_VELOCITY), turns]))
    return np.concatenate(found, axis=1)


def _motion_row(values: np.ndarray) -> dict[str, float | None]:
    turns = values[2] > 0.0
    row: dict[str, float | None] = {}
    for prefix, chosen in (
        ("", np.full(turns.shape, True)),
        ("straight_", ~turns),
        ("turn_", turns),
    ):
        for name, column in zip(("position_nees", "velocity_nees"), values, strict=False):
            row[prefix + name] = float(column[chosen].mean()) if chosen.any() else None
    return row


# Recordings ---------------------------------------------------------------------------------------


def matched(tracks: Tracks, of: Recording) -> Iterator[tuple[Episode, np.ndarray, Found]]:
    """Times (n,) and estimates of each target of a recording, as its score matches them."""
    row_of = {state.tobytes(): k for k, state in enumerate(tracks.state)}
    for episode, scored in zip(of, metrics.score(tracks, of).episodes, strict=True):
        for target in scored.targets:
            rows = [row_of[state.tobytes()] for state in target.estimate]
            if rows and tracks.covariance is not None:
                yield (
                    episode,
                    tracks.time_s[rows],
                    Found(target.estimate, tracks.covariance[rows], target.truth),
                )


def less_bearing(episode: Episode, time_s: np.ndarray, found: Found) -> np.ndarray:
    """Errors of the position (n, 2) less the mean offset of the bearing."""
    error = (found.mean - found.truth)[:, _POSITION]
    own = np.column_stack(
        [
            np.interp(time_s, episode.own.time_s, episode.own.north_m),
            np.interp(time_s, episode.own.time_s, episode.own.east_m),
        ]
    )
    away = found.truth[:, _POSITION] - own
    across = np.column_stack([-away[:, 1], away[:, 0]])  # moved by a turn of one radian
    return error - (error * across).sum() / (across**2).sum() * across


def _recording_run(name: str) -> dict[str, float]:
    of = recording.load(name)
    tracks = wl.track_recording(of)
    raw, less, speed = [], [], []
    for episode, time_s, found in matched(tracks, of):
        error = (found.mean - found.truth)[:, _POSITION]
        without = (
            less_bearing(episode, time_s, found)
            if name == "joyride"
            else error - error.mean(axis=0)
        )
        raw.append(found.nees(_POSITION))
        less.append(found.nees(_POSITION, without))
        speed.append(found.nees(_VELOCITY))
    return {
        "position_nees": float(np.concatenate(raw).mean()),
        "debiased_position_nees": float(np.concatenate(less).mean()),
        "velocity_nees": float(np.concatenate(speed).mean()),
    }


# Existence ----------------------------------------------------------------------------------------


def existences(scene: str, seed: int) -> np.ndarray:
    """Existence of every track-scan of a scene, and whether it is of a vessel, (2, n).

    A vessel is one track's: of those within 60 m or three standard deviations the nearest,
    confirmed tracks first.
    """
    (episode,) = SCENES[scene].record(np.random.default_rng([seed, *map(ord, scene)]))
    tracker = wl.Tracker(radar_of(DENSE_RADAR))
    truth = np.array([of.state_at(episode.time_s) for of in (episode.truth or {}).values()])
    found = []
    for k, scan in enumerate(episode.scans):
        tracker.process(
            scan.time_s,
            range_m=scan.range_m,
            bearing_rad=scan.bearing_rad,
            plot_time_s=scan.plot_time_s,
        )
        table = tracker.tracks(time_s=scan.time_s, tentative=True)
        found.append(np.array([table.existence, _is_real(table, truth[:, k, _POSITION])]))
    return np.concatenate(found, axis=1)


def _is_real(table: Any, truth_m: np.ndarray) -> np.ndarray:
    real = np.zeros(len(table.track_id), dtype=bool)
    position_m2 = np.trace(table.covariance[:, _POSITION, _POSITION], axis1=1, axis2=2)
    gate_m = np.maximum(_GATE_M, _GATE_STDS * np.sqrt(position_m2))
    apart_m = np.hypot(*(table.mean[:, np.newaxis, _POSITION] - truth_m).transpose(2, 0, 1))
    track, vessel = np.nonzero(apart_m < gate_m[:, np.newaxis])
    order = np.lexsort((apart_m[track, vessel], np.asarray(table.track_id)[track] <= 0))
    taken: set[int] = set()
    for k in order:
        if not real[track[k]] and vessel[k] not in taken:
            real[track[k]] = True
            taken.add(int(vessel[k]))
    return real


def _existence_row(runs: list[np.ndarray]) -> dict[str, float | None]:
    existence, real = np.concatenate(runs, axis=1)
    chosen = (existence >= SURE[0]) & (existence <= SURE[1])
    return {
        "track_scans": float(chosen.sum()),
        "real_share": float(real[chosen].mean()) if chosen.any() else None,
    }


# The study ----------------------------------------------------------------------------------------


def _plan(request: Request) -> Plan:
    few, scenes = -(-request.runs // 10), -(-request.runs // 100)
    seed = request.seed
    jobs: dict[Any, Any] = {
        ("range", case, k): partial(_range_run, *case, [seed, k])
        for case in RANGES
        for k in range(5 * few)
    }
    for models, motions in (("tracker", MOTIONS), ("tracker_ships", SHIPS)):
        for motion in motions:
            drawn = 5 * few if motion in SHIPS else few
            jobs["motion", motion, models] = partial(_motion_run, motion, models, drawn, seed)
    for name in RECORDINGS:
        jobs["recording", name] = partial(_recording_run, name)
    for scene in SCENES:
        for k in range(scenes):
            jobs["existence", scene, k] = partial(existences, scene, seed + k)
    return Plan(jobs, _rows, pictures=lambda done, rows: _pictures(rows), runs=few)


def _rows(done: Done) -> Rows:
    rows: Rows = []
    for range_m, bearing_deg in RANGES:
        of = [v for key, v in done.items() if key[:2] == ("range", (range_m, bearing_deg))]
        name = f"range_{range_m / 1e3:g}km_{bearing_deg:g}deg"
        rows += [
            {"scenario": name, "estimator": e, **_range_row([run[e] for run in of])}
            for e in ESTIMATORS
            if of
        ]
    rows += [
        {"scenario": key[1], "estimator": key[2], **_motion_row(value)}
        for key, value in done.items()
        if key[0] == "motion"
    ]
    rows += [
        {"scenario": key[1], "estimator": "tracker", **value}
        for key, value in done.items()
        if key[0] == "recording"
    ]
    runs = {
        scene: [v for key, v in done.items() if key[:2] == ("existence", scene)] for scene in SCENES
    }
    runs["all"] = [run for of in runs.values() for run in of]
    rows += [
        {"scenario": f"existence_{scene}", "estimator": "tracker", **_existence_row(of)}
        for scene, of in runs.items()
        if of
    ]
    return rows


STUDY = Study(
    "consistency",
    "whether errors are as large as reported: bias, NEES of tracks, probability of existence",
    _plan,
)
run = STUDY.run


# Pictures -----------------------------------------------------------------------------------------


def _pictures(rows: Rows) -> Iterator[Picture]:
    yield Picture(
        "consistency",
        "Errors beside what is reported of them",
        (partial(_outwards, rows=rows), partial(_nees, rows=rows)),
        size_in=(7.2, 6.4),
        shared=False,
    )


def _outwards(ax: Axes, rows: Rows) -> Axes:
    """Mean error of the range over its standard deviation."""
    scenarios = list(dict.fromkeys(r["scenario"] for r in rows if r["scenario"][:6] == "range_"))
    place = np.arange(len(scenarios))
    ax.axhspan(-0.15, 0.15, color=plot.MUTED, alpha=0.25, lw=0)
    for k, name in enumerate(ESTIMATORS):
        of = {
            r["scenario"]: r["outward_ratio"]
            for r in rows
            if r["estimator"] == name and r["scenario"][:6] == "range_"
        }
        ax.plot(place, [of[s] for s in scenarios], "o", color=plot.PALETTE[k], label=name)
    labels = [
        s.split("_")[1].replace("km", " km") + "\n" + s.split("_")[2].replace("deg", "°")
        for s in scenarios
    ]
    ax.set_xticks(place, labels)
    ax.set_ylabel("mean error outwards, σ")
    ax.set_ylim(-0.5, 0.5)
    ax.legend(frameon=False, ncols=4)
    return ax


def _nees(ax: Axes, rows: Rows) -> Axes:
    """NEES of position and velocity by motion and segment."""
    shown = [r for r in rows if r["scenario"] in MOTIONS and r["estimator"] == "tracker"]
    place = np.arange(len(shown))
    columns = (
        "straight_position_nees",
        "turn_position_nees",
        "straight_velocity_nees",
        "turn_velocity_nees",
    )
    labels = ("position, straight", "position, turn", "velocity, straight", "velocity, turn")
    for k, (column, label) in enumerate(zip(columns, labels, strict=True)):
        values = [r[column] or np.nan for r in shown]
        ax.bar(place + (k - 1.5) * 0.2, values, 0.2, label=label, color=plot.PALETTE[k])
    ax.axhline(2.0, color=plot.INK, lw=1.0)
    ax.set_ylim(0.0, 1.35 * ax.get_ylim()[1])  # room for the legend
    ax.set_xticks(place, [r["scenario"].replace("_", "\n") for r in shown])
    ax.set_ylabel("NEES (2 is right)")
    ax.legend(frameon=False, ncols=2)
    return ax
