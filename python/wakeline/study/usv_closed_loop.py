"""An unmanned vessel in closed loop: the mission is steered by estimates, not by the truth.

Scenarios begin with ``loop_``: a constant current, one that turns, GNSS outages, GNSS errors that
are correlated in time (multipath), a compass near iron, before and after its calibration in a turn,
and all of these together.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

import wakeline as wl
from wakeline import plot
from wakeline.scenario import UsvMission, UsvPassage

from .base import Picture
from .usv_estimators import ESTIMATORS, Estimator, motion_of, navigator_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CLOSED_METRICS = (
    *("cross_track_rms_m", "cross_track_p95_m", "success_rate"),
    *("north_mse_m2", "east_mse_m2", "heading_mse_deg2", "nees"),
)

_BASE = UsvMission(allow_for_current=True, start_heading_rad=float(np.arctan2(300.0, 200.0)))
_TIDE = {"current_turn_s": 3600.0}
_OUTAGES = {"outages_s": ((200.0, 320.0), (600.0, 780.0))}
_MULTIPATH = {"multipath_std_m": 6.0, "multipath_time_s": 60.0}


def iron() -> wl.navigation.CompassEllipse:
    """Hard and soft iron near the compass: deviations of up to 15°."""
    return wl.navigation.CompassEllipse([0.14, -0.10], [[1.08, 0.04], [0.04, 0.93]])


def loops() -> dict[str, UsvMission]:
    """The missions in closed loop, by scenario."""
    raw = {"compass_iron": iron()}
    calibrated = raw | {"calibrated": True}
    disturbances: dict[str, dict[str, Any]] = {
        "loop_current_0.5": {},
        "loop_tide": _TIDE,
        "loop_outages": _OUTAGES,
        "loop_multipath": _MULTIPATH,
        "loop_iron": raw,
        "loop_iron_calibrated": calibrated,
        "loop_all": _TIDE | _OUTAGES | _MULTIPATH | calibrated,
    }
    return {name: replace(_BASE, **changes) for name, changes in disturbances.items()}


_TURNING = {"speed_walk_mps": 1e-3, "current_walk_mps": 5e-3}
CLOSED = {name: ESTIMATORS[name] for name in ("ukf5_known_bias", "ukf5_no_bias", "ukf8", "ekf8")}
CLOSED["ukf7_current"] = Estimator(7, "ukf", _TURNING)
CLOSED["ukf8_uncompensated"] = Estimator(8, "ukf", allow_for_current=False)
_CORRELATED = {"ukf8_correlated": Estimator(8, "ukf", correlated=True)}

_SHOWN_RUNS = 30


# Pilots -------------------------------------------------------------------------------------------


class NavigatorPilot:
    """An estimator that steers R runs."""

    def __init__(self, estimator: Estimator, mission: UsvMission, runs: int) -> None:
        self._estimator, self._mission = estimator, mission
        heading = mission.start_heading_rad
        start = np.zeros(2), mission.speed_mps * _towards(heading), heading
        self._navigators = [navigator_of(estimator, *start) for _ in range(runs)]
        self._bias = np.array(mission.imu_bias) * estimator.known_bias
        self._gnss_std_m = gnss_std_m(mission, correlated=estimator.correlated)

    def __call__(
        self, imu: np.ndarray, gnss: np.ndarray, compass: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """A step; see `UsvMission.sail`."""
        beliefs = wl.navigation.step_navigators(
            self._navigators,
            self._mission.period_s,
            imu - self._bias,
            gnss,
            compass,
            gnss_std_m=self._gnss_std_m,
            compass_std_rad=self._mission.compass_std_rad,
        )
        motion, covariance = motion_of(*beliefs)
        current = motion[:, 2:4] - self._mission.speed_mps * _towards(motion[:, 4])
        return motion, covariance, current * self._estimator.allow_for_current


class RawPilot:
    """GNSS and compass alone, the last fix in an outage; the current is not known."""

    def __init__(self, mission: UsvMission, runs: int) -> None:
        self._mission = mission
        self._fix = np.zeros((runs, 2))

    def __call__(
        self, imu: np.ndarray, gnss: np.ndarray, compass: np.ndarray
    ) -> tuple[np.ndarray, None, np.ndarray]:
        """A step; see `UsvMission.sail`."""
        self._fix = np.where(np.isfinite(gnss), gnss, self._fix)
        velocity = self._mission.speed_mps * _towards(compass)
        return np.column_stack([self._fix, velocity, compass]), None, np.zeros_like(velocity)


def gnss_std_m(mission: UsvMission, *, correlated: bool) -> np.ndarray:
    """Standard deviations (2,) of GNSS errors.

    Where `correlated`, those of independent errors whose mean over a long time has the same
    variance: that of multipath is multiplied by (1 + φ) / (1 - φ), φ the correlation of successive
    errors.
    """
    kept = np.exp(-mission.period_s / mission.multipath_time_s) * correlated
    multipath_m2 = mission.multipath_std_m**2 * (1 + kept) / (1 - kept)
    return np.sqrt(np.square(mission.gnss_std_m) + multipath_m2)


def _towards(heading_rad: float | np.ndarray) -> np.ndarray:
    return np.stack([np.cos(heading_rad), np.sin(heading_rad)], axis=-1)


# Results ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class ClosedLoop:
    """Runs of a scenario in closed loop.

    Attributes
    ----------
    scores : dict of str to float or None
        By metric.
    shown_m : ndarray (r, T, 2)
        True positions of the first runs.
    """

    scores: dict[str, float | None]
    shown_m: np.ndarray

    def figures(self) -> dict[str, float | None]:
        """By metric."""
        return self.scores


def closed_loop(
    mission: UsvMission, estimator: Estimator | str, runs: int, seed: list[int]
) -> ClosedLoop:
    """Runs steered by an estimator, by ``"gnss_compass"`` or by the ``"truth"``."""
    pilots = {"truth": lambda: None, "gnss_compass": lambda: RawPilot(mission, runs)}
    if isinstance(estimator, str):
        passage = mission.sail(pilots[estimator](), runs, seed)
    else:
        passage = mission.sail(NavigatorPilot(estimator, mission, runs), runs, seed)
    return ClosedLoop(_scores(passage), passage.position_m[:_SHOWN_RUNS])


def _scores(passage: UsvPassage) -> dict[str, float | None]:
    truth = np.concatenate([passage.position_m, passage.heading_rad[..., None]], axis=-1)
    error = passage.mean[..., [0, 1, 4]] - truth
    error[..., 2] = np.degrees(wl.wrap_angle(error[..., 2]))
    known = np.isfinite(passage.nees)
    values = (
        np.sqrt(np.nanmean(passage.cross_track_m**2)),
        np.nanpercentile(passage.cross_track_m, 95),
        passage.success.mean(),
        *np.nanmean(error[:, 1:] ** 2, axis=(0, 1)),
    )
    nees = float(passage.nees[known].mean()) if known.any() else None
    return dict(zip(CLOSED_METRICS, (*map(float, values), nees), strict=True))


def closed_loops(runs: int, seed: int) -> dict[tuple[str, str], Callable[[], ClosedLoop]]:
    """The work of every scenario and estimator."""
    jobs: dict[tuple[str, str], Callable[[], ClosedLoop]] = {}
    for k, (scene, mission) in enumerate(loops().items()):
        chosen: dict[str, Estimator | str] = {"truth": "truth", "gnss_compass": "gnss_compass"}
        chosen |= CLOSED | (_CORRELATED if mission.multipath_std_m > 0 else {})
        for name, estimator in chosen.items():
            jobs[scene, name] = partial(closed_loop, mission, estimator, runs, [seed, 100 + k])
    return jobs


# Pictures -----------------------------------------------------------------------------------------

_COLORS = {
    "truth": plot.INK,
    "gnss_compass": plot.MUTED,
    "ukf5_no_bias": plot.PALETTE[1],
    "ukf5_known_bias": plot.PALETTE[4],
    "ukf8": plot.PALETTE[0],
    "ukf8_uncompensated": plot.PALETTE[3],
    "ukf8_correlated": plot.PALETTE[5],
    "ukf7_current": plot.PALETTE[2],
}
_MAPS = (
    ("loop_current_0.5", "gnss_compass", "GNSS and compass alone"),
    ("loop_current_0.5", "ukf8", "fused (ukf8)"),
    ("loop_all", "gnss_compass", "all disturbances, GNSS and compass alone"),
    ("loop_all", "ukf8", "all disturbances, fused (ukf8)"),
)
_SCENES = {
    "loop_current_0.5": "current",
    "loop_tide": "turning\ncurrent",
    "loop_outages": "outages",
    "loop_multipath": "multipath",
    "loop_iron": "iron",
    "loop_iron_calibrated": "iron,\ncalibrated",
    "loop_all": "all",
}

Loops = Mapping[tuple[str, str], ClosedLoop]


def closed_pictures(done: Loops, seed: int) -> tuple[Picture, ...]:
    """Paths, cross-track errors and success rates, and the compass near iron."""
    missions = loops()
    return (
        Picture(
            "usv-closed-loop",
            f"Missions steered by estimates: the first {_SHOWN_RUNS} runs and the planned path",
            tuple(
                partial(_draw_paths, mission=missions[scene], runs=done[scene, name], title=title)
                for scene, name, title in _MAPS
            ),
            size_in=(8.4, 8.6),
            columns=2,
        ),
        Picture(
            "usv-cross-track",
            "Cross-track error and success in closed loop",
            (partial(_draw_errors, done=done), partial(_draw_success, done=done)),
            size_in=(8.4, 6.4),
        ),
        Picture(
            "usv-compass",
            "A compass near iron, and its calibration in a turn of two circles",
            (partial(_draw_ellipse, seed=seed), partial(_draw_deviation, seed=seed)),
            size_in=(9.0, 4.4),
            columns=2,
            shared=False,
        ),
    )


def _draw_paths(ax: Axes, mission: UsvMission, runs: ClosedLoop, title: str) -> Axes:
    from matplotlib.patches import Circle

    for obstacle in mission.obstacles:
        centre = (obstacle.east_m, obstacle.north_m)
        ax.add_patch(Circle(centre, obstacle.radius_m, color=plot.PALETTE[1], linewidth=0))
    ax.plot(*mission.path_m[:, ::-1].T, color=plot.INK, linewidth=3.2, alpha=0.25)
    for path in runs.shown_m:
        ax.plot(*path[:, ::-1].T, color=plot.PALETTE[0], linewidth=0.7, alpha=0.55)
    ways = np.array(mission.waypoints_m)
    ax.plot(*ways[:, ::-1].T, "o", color=plot.INK, markersize=4)
    share = runs.scores["success_rate"]
    error = runs.scores["cross_track_rms_m"]
    ax.text(
        *(0.97, 0.04, f"cross-track RMS {error:.1f} m\nsuccess {100 * share:.0f} %"),
        transform=ax.transAxes,
        ha="right",
        fontsize=plot.TEXT_PT,
    )
    ax.set_title(title, fontsize=plot.TEXT_PT, loc="left")
    ax.set_aspect("equal")
    ax.set(xlim=(-60, 880), ylim=(-60, 880), xlabel="east (m)", ylabel="north (m)")
    return plot.dress(ax)


def _bars(ax: Axes, done: Loops, metric: str) -> Axes:
    """Marks of a metric by scenario, one row of marks an estimator."""
    for k, (name, color) in enumerate(_COLORS.items()):
        found = {
            n: done[s, name].scores[metric] for n, s in enumerate(_SCENES) if (s, name) in done
        }
        place = np.array(list(found)) + 0.085 * (k - (len(_COLORS) - 1) / 2)
        ax.plot(place, list(found.values()), "o", color=color, markersize=6, label=name)
    for line in np.arange(len(_SCENES) - 1) + 0.5:
        ax.axvline(line, color=plot.MUTED, linewidth=0.4)
    ax.set_xlim(-0.5, len(_SCENES) - 0.5)
    ax.set_xticks(range(len(_SCENES)), _SCENES.values())
    return plot.dress(ax)


def _draw_errors(ax: Axes, done: Loops) -> Axes:
    _bars(ax, done, "cross_track_rms_m")
    ax.set_yscale("log")
    ax.set_yticks([1, 2, 5, 10, 20, 50, 100], ["1", "2", "5", "10", "20", "50", "100"])
    ax.minorticks_off()
    ax.set_ylabel("cross-track RMS (m)")
    return plot.name_lines(ax, columns=4)


def _draw_success(ax: Axes, done: Loops) -> Axes:
    _bars(ax, done, "success_rate")
    ax.set(ylabel="success rate", ylim=(-0.04, 1.04))
    return ax


def _calibration(seed: int) -> tuple[np.ndarray, wl.navigation.CompassEllipse]:
    """Fields (n, 2) of a turn, and the ellipse found in it."""
    rng = np.random.default_rng([seed, 7])
    heading = np.linspace(0.0, 4 * np.pi, 144, endpoint=False)
    field = iron().field(heading) + UsvMission.compass_std_rad * rng.standard_normal((144, 2))
    return field, wl.navigation.calibrate_compass(field)[0]


def _draw_ellipse(ax: Axes, seed: int) -> Axes:
    field, found = _calibration(seed)
    whole = np.linspace(0.0, 2 * np.pi, 361)
    circle = wl.navigation.CompassEllipse().field(whole)
    ax.plot(*circle.T[::-1], color=plot.MUTED, linewidth=1.0, linestyle="--", label="without iron")
    ax.plot(
        *found.field(whole).T[::-1], color=plot.PALETTE[0], linewidth=1.6, label="fitted ellipse"
    )
    ax.plot(
        *field.T[::-1], "o", color=plot.PALETTE[1], markersize=2.6, label="measured in the turn"
    )
    ax.plot(*found.hard_iron[::-1], "+", color=plot.PALETTE[0], markersize=11, label="hard iron")
    ax.plot(0, 0, "+", color=plot.MUTED, markersize=11)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel="field to starboard", ylabel="field ahead")
    return plot.name_lines(plot.dress(ax), columns=2)


def _draw_deviation(ax: Axes, seed: int) -> Axes:
    _, found = _calibration(seed)
    whole = np.linspace(0.0, 2 * np.pi, 361)
    lines = {
        "as measured": (wl.navigation.CompassEllipse(), plot.PALETTE[1]),
        "calibrated": (found, plot.PALETTE[0]),
    }
    for name, (correction, color) in lines.items():
        error = wl.wrap_angle(correction.heading_rad(iron().field(whole)) - whole)
        ax.plot(np.degrees(whole), np.degrees(error), color=color, linewidth=1.6, label=name)
    ax.set(xlabel="magnetic heading (°)", ylabel="deviation (°)", xlim=(0, 360))
    ax.set_xticks([0, 90, 180, 270, 360])
    return plot.name_lines(plot.dress(ax))
