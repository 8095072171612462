"""Real maneuvers: vessels of the Solent, replayed from AIS under a simulated coastal radar.

The truth is the motion of vessels off Portsmouth in January 2016. A radar at Gilkicker Point
detects those within ten kilometres in every scan, with Gaussian errors in range and bearing. Every
estimator has one tuning for all vessels and both radars, and starts from the first plot.

AIS reports arrive with random delays of seconds, so that a vessel seems to jump along its path. The
time of each report is therefore recomputed: the interval between reports is the distance made
divided by the mean of the two reported speeds. A segment counts if a vessel makes more than 2 m/s
for three minutes and reports at a median interval under 7 s, without a gap over 25 s.

Scenarios are the radars. Errors are root mean squares over all vessels, runs and scans from 30 s
after the start; those with the prefix ``after_turn_`` cover the scans of :func:`after_turn`. Runs
are divided among the segments and rounded up. In full also the effect of tuning.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

import wakeline as wl
from wakeline import WhiteAcceleration, plot, recording
from wakeline._brief import many
from wakeline.recording import AisTrack
from wakeline.scenario import RadarSimulator, Scenario, TrackTruth

from . import curves, under_way
from .base import Picture, Plan, Request, Rows, Study
from .estimators import learning_filter, peaked, turn_filter, turn_imm

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from wakeline.scenario.scenario import AnyTruth

RADARS = {
    "coastal_60m": RadarSimulator(60.0, np.deg2rad(0.5), period_s=3.0),
    "coastal_15m": RadarSimulator(15.0, np.deg2rad(0.1), period_s=2.5),
}
RADAR_AT_DEG = (50.7743, -1.1407)
TURN_RATE_DEG_S = 1.5
AFTER_TURN_S = 30.0
METRICS = ("position_rmse_m", "speed_rmse_mps", "course_rms_deg")
AFTER = "after_turn_"

_WINDOW_S = 10.0
_SETTLE_S = 30.0
_MIN_STEP_S, _MAX_STEP_S = 0.5, 7.0
_MIN_DURATION_S = 180.0
_COVERAGE_M = 10e3
_START_SPEED_STD_MPS = 10.0
_NOISE = WhiteAcceleration(psd_m2s3=0.06)
_STRAIGHT_S, _TURN_S = 200.0, 20.0
_LEAST_S = 6.0  # minimum duration of a history's segments; the chain gives the rest
_THREE_DEG_S = (0, 2, -2)
_WANDERING_M2S3, _COURSE_PSD_RAD2S = 0.001, 0.0015
_STRAIGHTS = (  # white acceleration m²/s³, course noise rad²/s, mean time s, as above
    (5e-5, 1e-5, 150.0),
    (0.001, 0.001, 100.0),
    (0.05, 0.003, 70.0),
)
_TURNS = (1e-4, 5e-4, 6.0)  # of the same
_TURN_RATES_DEG_S, _TURN_STD_DEG_S, _NO_TURN_DEG_S = (-4, -2, 2, 4), 0.2, 0.01
_TUNED = wl.VesselModels(
    cruising_psd_m2s3=4e-4,
    cruising_course_psd_rad2s=3e-5,
    steady_psd_m2s3=4e-4,
    steady_course_psd_rad2s=0.0016,
    restless_psd_m2s3=0.25,
    restless_course_psd_rad2s=0.003,
    turning_psd_m2s3=0.002,
    turning_course_psd_rad2s=7e-4,
    turn_rate_psd_rad2s3=7e-6,
    prior_turn_rate_std_rad_s=np.deg2rad(0.8),
    cruising_probability=0.25,
    cruising_sojourn_s=180.0,
    settling_s=140.0,
    steady_sojourn_s=150.0,
    restless_sojourn_s=50.0,
    turning_sojourn_s=80.0,
    agile_probability=0.015,
)
_OTHER_NOISES_M2S3 = (0.003, 0.01, 0.3)
_SHOWN = ("kalman_ca", "kalman_cv", "mode_history")
_SHOWN_STRETCH, _SHOWN_S = "235007473-1", 180.0


# The vessels --------------------------------------------------------------------------------------


@lru_cache(maxsize=1)
def vessels() -> dict[str, TrackTruth]:
    """Segments by name, with the radar at north 0, east 0."""
    ais = recording.load_ais()
    latitude_rad, longitude_rad = np.radians(RADAR_AT_DEG)
    radar_m = ais.plane.position_m(latitude_rad=latitude_rad, longitude_rad=longitude_rad)
    found = {}
    for mmsi, track in ais.tracks.items():
        often = filter(_heard_often, under_way.stretches(track))
        for k, truth in enumerate(filter(None, map(_retimed, often))):
            found[f"{mmsi}-{k}"] = truth.moved(-radar_m[0], -radar_m[1])
    return {name: truth for name, truth in found.items() if _covered(truth)}


def _heard_often(track: AisTrack) -> bool:
    return bool(np.median(np.diff(track.time_s)) < _MAX_STEP_S)


def _retimed(track: AisTrack) -> TrackTruth | None:
    """The track with times that fit distance and speed; None if it is too short."""
    way_m = np.hypot(np.diff(track.north_m), np.diff(track.east_m))
    step_s = way_m / (0.5 * (track.speed_mps[1:] + track.speed_mps[:-1]))
    time_s = np.concatenate([[0.0], np.cumsum(step_s)])
    kept = np.concatenate([[True], step_s > _MIN_STEP_S])
    if time_s[-1] < _MIN_DURATION_S:
        return None
    return TrackTruth(time_s[kept], track.north_m[kept], track.east_m[kept])


def _covered(truth: TrackTruth) -> bool:
    """Whether the vessel is always within range of the radar."""
    place_m = truth.state_at(np.arange(0.0, truth.end_time_s))[:, 0::2]
    return bool(np.hypot(*place_m.T).max() < _COVERAGE_M)


def scenes(radar: str) -> list[Scenario]:
    """A scenario of each segment under a radar of :data:`RADARS`."""
    simulator = RADARS[radar]
    return [
        Scenario(f"{radar}-{name}", truth, simulator, int(truth.end_time_s // simulator.period_s))
        for name, truth in vessels().items()
    ]


def after_turn(scenario: Scenario) -> np.ndarray:
    """Scans (T,) in a turn, or less than 30 s after its start or end."""
    return turning(scenario.truth, scenario.time_s)


def turning(truth: AnyTruth, time_s: np.ndarray) -> np.ndarray:
    """Whether times (n,) are in a turn, or less than 30 s after its start or end.

    A vessel turns where its course changes by more than 1.5 deg/s, averaged over 10 s.
    """
    fine_s = np.arange(0.0, time_s.max(initial=0.0) + _WINDOW_S, 1.0)
    velocity = truth.state_at(fine_s)[:, 1::2]
    course_deg = np.degrees(np.unwrap(np.arctan2(velocity[:, 1], velocity[:, 0])))
    half = int(_WINDOW_S / 2)
    rate_deg_s = (course_deg[2 * half :] - course_deg[: -2 * half]) / _WINDOW_S
    turning_s = fine_s[half:-half][np.abs(rate_deg_s) > TURN_RATE_DEG_S]
    return soon_after(turning_s, time_s)


def soon_after(turning_s: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """Whether times (n,) are 0 to 30 s after any of the times of a turn."""
    since_s = time_s[:, np.newaxis] - turning_s
    return ((since_s >= 0.0) & (since_s <= AFTER_TURN_S)).any(axis=1)


# The estimators -----------------------------------------------------------------------------------


def estimators() -> dict[str, Any]:
    """Every estimator by name, with its one tuning.

    Single-model filters have the library's defaults. Turn models have a white acceleration of
    0.06 m²/s³; the mean sojourn is 200 s on a straight and 20 s in a turn where separate models
    represent them. Other parameters have their defaults, except the noises and times of
    `mode_history_rates` and `mode_history_vessels`.
    """
    return {name: build() for name, build in _TABLE.items()}


def variants() -> dict[str, Any]:
    """Effect of tuning: other process noise, turns as often as in papers, these vessels."""
    noises = {psd: WhiteAcceleration(psd_m2s3=psd) for psd in _OTHER_NOISES_M2S3}
    return (
        {
            f"kalman_cv_psd_{psd:g}": wl.Ekf(wl.ConstantVelocity(noise=noise))
            for psd, noise in noises.items()
        }
        | {f"imm3_psd_{psd:g}": _imm(_THREE_DEG_S, noise) for psd, noise in noises.items()}
        | {
            "imm3_restless": turn_imm(_THREE_DEG_S, _NOISE, stay=0.95),
            "mode_history_restless": wl.ModeHistory(turn_filter(0.0, _NOISE)),
            "imm_turn_rate_wandering": _imm_wandering(),
            "vessel_imm_tuned": wl.vessel_imm(wl.Radar(), _TUNED),
        }
    )


def _imm(rates_deg_s: Sequence[float], noise: Any = _NOISE) -> wl.Imm:
    """A straight, first, and turns at known rates."""
    return _straight_first([turn_filter(rate, noise) for rate in rates_deg_s])


def _imm_rate() -> wl.Imm:
    """A straight, and a turn whose rate is part of the state."""
    return _straight_first(
        [wl.Ekf(wl.ConstantVelocity(noise=_NOISE)), wl.Ekf(wl.CoordinatedTurnRate(noise=_NOISE))]
    )


def _imm_wandering() -> wl.Imm:
    """The same with the noise of the histories that learn their rates."""
    straight = wl.WanderingCourse(psd_m2s3=_WANDERING_M2S3, course_psd_rad2s=_COURSE_PSD_RAD2S)
    turn = wl.CoordinatedTurnRate(
        noise=WhiteAcceleration(psd_m2s3=_WANDERING_M2S3), course_psd_rad2s=_COURSE_PSD_RAD2S
    )
    return _straight_first([wl.Ekf(straight), wl.Ekf(turn)])


def _straight_first(filters: list[wl.Ekf]) -> wl.Imm:
    turns = len(filters) - 1
    return wl.Imm(
        filters,
        wl.ModeChain.from_sojourn_s([_STRAIGHT_S, *[_TURN_S] * turns]),
        peaked(len(filters), 0, 0.9),
    )


def _histories(filter: wl.Ekf) -> wl.ModeHistory:
    return wl.ModeHistory(
        filter,
        min_segment_s=_LEAST_S,
        straight_sojourn_s=_STRAIGHT_S - _LEAST_S,
        turn_sojourn_s=_TURN_S - _LEAST_S,
    )


def _vessel_histories() -> wl.ModeHistory:
    """Straights with three noises, and turns whose rates are estimated from first guesses."""
    modes = [(*straight, 0.0, _NO_TURN_DEG_S) for straight in _STRAIGHTS]
    modes += [(*_TURNS, rate_deg_s, _TURN_STD_DEG_S) for rate_deg_s in _TURN_RATES_DEG_S]
    filters = [
        learning_filter(
            WhiteAcceleration(psd_m2s3=psd),
            rate_deg_s,
            std_deg_s=std_deg_s,
            course_psd_rad2s=course_psd,
        )
        for psd, course_psd, _, rate_deg_s, std_deg_s in modes
    ]
    chain = wl.ModeChain.from_sojourn_s([mean_s for _, _, mean_s, *_ in modes])
    return wl.ModeHistory.of(filters, chain, min_segment_s=_LEAST_S)


_TABLE: dict[str, Callable[[], Any]] = {
    "kalman_cv": lambda: wl.Ekf(wl.ConstantVelocity()),
    "wandering_course": lambda: wl.Ekf(wl.WanderingCourse()),
    "kalman_ca": lambda: wl.Ekf(wl.ConstantAcceleration()),
    "singer": lambda: wl.Ekf(wl.Singer()),
    "ekf_turn_rate": lambda: wl.Ekf(wl.CoordinatedTurnRate()),
    "ukf_turn_rate": lambda: wl.Ukf(wl.CoordinatedTurnRate()),
    "imm3": lambda: _imm(_THREE_DEG_S),
    "imm5": lambda: _imm((0, 2, -2, 4, -4)),
    "imm_turn_rate": _imm_rate,
    "vessel_imm": lambda: wl.vessel_imm(wl.Radar()),
    "vessel_imm_ships": lambda: wl.vessel_imm(wl.Radar(), wl.VesselModels.ships()),
    "agmm": lambda: wl.AdaptiveGridImm(turn_filter(0.0, _NOISE)),
    "sgmm": lambda: wl.SwitchingGridImm(turn_filter(0.0, _NOISE)),
    "likely_model_set": lambda: wl.LikelyModelSetImm(turn_filter(0.0, _NOISE)),
    "mode_history": lambda: _histories(turn_filter(0.0, _NOISE)),
    "mode_history_rates": lambda: _histories(
        learning_filter(
            WhiteAcceleration(psd_m2s3=_WANDERING_M2S3), course_psd_rad2s=_COURSE_PSD_RAD2S
        )
    ),
    "mode_history_vessels": _vessel_histories,
}


# Runs ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Sums:
    """Squared errors of position, speed and course (3,) and scans, overall and after turns."""

    squared: np.ndarray
    scans: int
    squared_after: np.ndarray
    scans_after: int

    def __add__(self, other: _Sums) -> _Sums:
        return _Sums(
            self.squared + other.squared,
            self.scans + other.scans,
            self.squared_after + other.squared_after,
            self.scans_after + other.scans_after,
        )

    def figures(self) -> dict[str, float]:
        every = np.sqrt(self.squared / self.scans)
        after = np.sqrt(self.squared_after / self.scans_after)
        return dict(zip(METRICS, every.tolist(), strict=True)) | {
            f"{AFTER}{metric}": value for metric, value in zip(METRICS, after.tolist(), strict=True)
        }


_NOTHING = _Sums(np.zeros(3), 0, np.zeros(3), 0)


def _plan(request: Request) -> Plan:
    each = -(-request.runs // len(vessels()))
    built = estimators() | (variants() if request.full else {})
    return Plan(
        jobs={
            (radar, name, scene.name): partial(_score, scene, estimator, each, request.seed)
            for radar in RADARS
            for name, estimator in built.items()
            for scene in scenes(radar)
        },
        rows=lambda done: _rows(_totals(done)),
        result=_totals,
        pictures=lambda done, rows: _pictures(rows, request.seed),
        notes=lambda done, rows: [_note(_totals(done), each)],
        runs=each * len(vessels()),
    )


STUDY = Study(
    "solent",
    "real maneuvers replayed from AIS under coastal radars: every estimator by name",
    _plan,
)
run = STUDY.run


def _totals(done: Mapping[tuple[str, str, str], _Sums]) -> dict[tuple[str, str], _Sums]:
    """Sums over all segments of each estimator under each radar, if all are done."""
    parts: dict[tuple[str, str], list[_Sums]] = {}
    for (radar, name, _), sums in done.items():
        parts.setdefault((radar, name), []).append(sums)
    return {of: sum(each, _NOTHING) for of, each in parts.items() if len(each) == len(vessels())}


def _rows(totals: Mapping[tuple[str, str], _Sums]) -> Rows:
    return [
        {"scenario": radar, "estimator": name} | sums.figures()
        for (radar, name), sums in totals.items()
    ]


def track(scene: Scenario, estimator: Any, z: np.ndarray) -> np.ndarray:
    """States (R, T - 1, 4) after the second plot of runs (R, T, 2) and after every later one."""
    dt_s, sensor = scene.radar.period_s, scene.polar_sensor
    starts = [wl.one_point(sensor, first, _START_SPEED_STD_MPS) for first in z[:, 0]]
    found = estimator.run(z[:, 1:], dt_s=dt_s, sensor=sensor, start=starts)
    return curves.kinematics(np.asarray(found.mean))


def _score(scene: Scenario, estimator: Any, runs: int, seed: int) -> _Sums:
    states = track(scene, estimator, scene.draw(runs, seed))
    settled = scene.time_s[1:] > _SETTLE_S
    after = after_turn(scene)[1:] & settled
    truth = scene.truth_states[1:]
    error = states - truth
    speed_mps = np.hypot(states[..., 1], states[..., 3]) - np.hypot(truth[:, 1], truth[:, 3])
    course_deg = np.degrees(wl.wrap_angle(_course_rad(states) - _course_rad(truth)))
    squared = np.stack(
        [error[..., 0] ** 2 + error[..., 2] ** 2, speed_mps**2, course_deg**2], axis=-1
    )
    return _Sums(
        squared[:, settled].sum(axis=(0, 1)),
        runs * int(settled.sum()),
        squared[:, after].sum(axis=(0, 1)),
        runs * int(after.sum()),
    )


def _course_rad(states: np.ndarray) -> np.ndarray:
    return np.arctan2(states[..., 3], states[..., 1])


def _note(totals: Mapping[tuple[str, str], _Sums], each: int) -> str:
    minutes = sum(truth.end_time_s for truth in vessels().values()) / 60.0
    sums = next(iter(totals.values()))
    return (
        f"{len(vessels())} segments of {len(set(map(_vessel, vessels())))} vessels, "
        f"{minutes:.0f} min in all, {many(each, 'run')} of each; "
        f"{100.0 * sums.scans_after / sums.scans:.0f} % of the scans are after a turn: at most\n"
        f"{AFTER_TURN_S:.0f} s after the course changed by more than {TURN_RATE_DEG_S:g}°/s, "
        f"averaged over {_WINDOW_S:.0f} s."
    )


# Pictures -----------------------------------------------------------------------------------------


def _pictures(rows: Rows, seed: int) -> tuple[Picture, ...]:
    return (
        Picture(
            "solent-map",
            "Vessels off Portsmouth, 12 January 2016, relative to Gilkicker Point",
            (_draw_map,),
            size_in=(6.4, 8.8),
            shared=False,
        ),
        Picture(
            "solent-track",
            "Three minutes of a fast craft: one run under the radars of 60 m and of 15 m",
            tuple(partial(_draw_track, radar=radar, seed=seed) for radar in RADARS),
            size_in=(7.2, 10.4),
            shared=False,
        ),
        Picture(
            "solent-ranking",
            "After a turn: errors of every estimator under either radar",
            tuple(
                partial(_draw_ranking, rows=rows, metric=f"{AFTER}{metric}", xlabel=label)
                for metric, label in zip(
                    METRICS,
                    ("position RMSE (m)", "speed RMSE (m/s)", "course RMS error (°)"),
                    strict=True,
                )
            ),
            size_in=(12.0, 5.2),
            columns=3,
            shared=False,
        ),
    )


def _draw_map(ax: Axes) -> Axes:
    colors = dict(zip(dict.fromkeys(map(_vessel, vessels())), plot.PALETTE, strict=False))
    named = set()
    for name, truth in vessels().items():
        vessel = _vessel(name)
        place_m = truth.state_at(np.arange(0.0, truth.end_time_s, 2.0))[:, 0::2]
        ax.plot(
            place_m[:, 1] / 1e3,
            place_m[:, 0] / 1e3,
            color=colors[vessel],
            marker="o",
            markersize=4,
            markevery=[0],
            label=None if vessel in named else vessel,
        )
        named.add(vessel)
    ax.plot([], [], color=plot.INK, marker="o", markersize=4, linestyle="", label="start")
    ax.plot(0, 0, color=plot.INK, marker="^", markersize=7, linestyle="", label="radar")
    return plot.name_lines(plot.dress_map(ax))


def _vessel(stretch: str) -> str:
    return stretch.partition("-")[0]


def _draw_track(ax: Axes, radar: str, seed: int) -> Axes:
    """The part of a segment with the most turning, with the tracks of the shown estimators."""
    scene = next(one for one in scenes(radar) if one.name.endswith(_SHOWN_STRETCH))
    z, built = scene.draw(1, seed), estimators()
    count = int(_SHOWN_S // scene.radar.period_s)
    settled = int(_SETTLE_S // scene.radar.period_s)
    turning = np.convolve(after_turn(scene)[1 + settled :], np.ones(count), "valid")
    first = settled + int(turning.argmax())
    part = slice(first, first + count)
    tracks = {name: track(scene, built[name], z)[0, part] for name in _SHOWN}
    return plot.paths_view(
        ax,
        scene.truth_states[1:][part],
        tracks,
        plots_m=curves.place_m(z[0, 1:][part]),
        radar=False,
    )


def _draw_ranking(ax: Axes, rows: Rows, metric: str, xlabel: str) -> Axes:
    names = list(estimators())
    found = curves.figures(rows, metric)
    values = {radar: [found[radar, name] for name in names] for radar in RADARS}
    return plot.ranking_panel(ax, names, values, xlabel=xlabel, log=True)
