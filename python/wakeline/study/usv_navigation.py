"""Navigation of an unmanned surface vessel by IMU, GNSS and compass, with unknown biases.

"Sensor system information processing in unmanned navigation applications" (P. S. Evsyukov, O. N.
Andreeva, V. V. Khanychev): a mission of 800 m by 800 m in a current, an unscented Kalman filter of
five states. Ours also estimates the biases of the IMU, and is compared with the Cramér-Rao bound.

Scenarios are ``current_0.5`` and so on, in m/s; those that begin with ``loop_`` are steered by the
estimates (`usv_closed_loop`). In full also the paper's filter with its figures of
the IMU as variances, ours with accelerations rotated by the heading at the start of a step, and
with augmented noise.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import wakeline as wl
from wakeline import plot
from wakeline.scenario import UsvLogs, UsvMission, UsvVoyage

from .base import Picture, Plan, Published, Request, Rows, Study
from .usv_closed_loop import ClosedLoop, closed_loops, closed_pictures
from .usv_estimators import ESTIMATORS, IN_FULL, Estimator, motion_of, navigator_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ERRORS = ("north_mse_m2", "east_mse_m2", "heading_mse_deg2")
METRICS = (*_ERRORS, "nees", *(f"second_half_{metric}" for metric in _ERRORS))
DEFAULT = "ukf8"
SHOWN = "current_0.5"

# Prior of a navigator, the defaults of `wl.UsvNavigator`.
PRIOR_STD = np.array(
    [8.0, 7.0, 0.5, 0.5, np.deg2rad(1.0), 0.05, 0.05, np.deg2rad(0.5)]
)  # [north, east, v_north, v_east, heading, forward bias, starboard bias, gyro bias]
_BIAS_WALK = 1e-6

_NAN = float("nan")
PAPER = Published(
    _ERRORS,
    {
        ("current_0.5", "gnss_compass"): (66.7, 51.1, 0.93),
        ("current_0.3", "gnss_compass"): (56.5, 48.0, 0.95),
        ("current_0.15", "gnss_compass"): (63.4, 48.5, 1.00),
        ("current_0.5", "ukf5_known_bias"): (4.97, 4.47, 0.111),
        ("current_0.3", "ukf5_known_bias"): (4.75, 4.28, 0.093),
        ("current_0.15", "ukf5_known_bias"): (3.86, 3.70, 0.089),
    },
)
REFERENCE = Published(
    METRICS,
    {
        ("current_0.5", "ukf5_known_bias"): (2.27, 1.89, 0.034, *[_NAN] * 4),
        ("current_0.5", "ukf8"): (2.91, 2.40, 0.044, 4.85, 2.07, 1.70, 0.034),
        ("current_0.5", "ukf7_current"): (1.37, 1.13, 0.044, *[_NAN] * 4),
        ("current_0.5", "bound8"): (3.12, 2.49, 0.045, _NAN, 2.09, 1.71, 0.034),
        ("current_0.5", "ukf5_printed_noise"): (5.93, 4.74, 0.094, *[_NAN] * 4),
    },
)
NOTE = """Unscented and extended filter agree to the digits shown, because the motion is nearly
linear over a step. NEES is that of position, velocity and heading, 5 for a consistent filter. Every
filter starts at the true position, the bound averages over initial errors: over the whole mission a
filter may be below it, and the second half is the fair comparison. ukf5_known_bias, the paper's
filter, is given the biases; ukf8 estimates them. ukf7_current assumes that speed through water and
current never change, the bound does not. Errors hardly depend on the current; that the paper's fall
with it is chance. In scenarios that begin with loop_ the estimator steers: the cross-track error is
the distance from the planned path, a success arrives without touching an obstacle."""


# The missions -------------------------------------------------------------------------------------


def missions() -> dict[str, UsvMission]:
    """The paper's three currents and its two tidal streams.

    In a current as fast as itself a vessel that follows bearings never reaches its waypoint; there
    it points up into the current.
    """
    return {
        f"current_{current}": UsvMission(
            current_mps=current, allow_for_current=current >= UsvMission.speed_mps
        )
        for current in (0.5, 0.3, 0.15, 0.7, 1.0)
    }


def navigate(estimator: Estimator, mission: UsvMission, logs: UsvLogs, run: int) -> Any:
    """The beliefs of an estimator along a run, an `UsvRun`.

    It starts at the true position and heading, with the velocity through the water.
    """
    truth = mission.voyage
    through_water = truth.velocity_mps[0] - mission.current
    navigator = navigator_of(estimator, truth.position_m[0], through_water, truth.heading_rad[0])
    return navigator.run(
        truth.time_s,
        logs.imu[run] - np.array(mission.imu_bias) * estimator.known_bias,
        logs.gnss[run],
        logs.compass[run],
        gnss_std_m=mission.gnss_std_m,
        compass_std_rad=mission.compass_std_rad,
        smooth=estimator.smooth,
    )


# Errors -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Outcome:
    """Errors of R runs, averaged over them at each of T times after the start.

    Attributes
    ----------
    squared : ndarray (T, 3)
        Of north and east m², and of the heading in degrees².
    nees : ndarray (T,) or None
        Normalized squared error of position, velocity and heading.
    """

    squared: np.ndarray
    nees: np.ndarray | None = None

    def figures(self) -> dict[str, float | None]:
        """By metric."""
        mean, late = self.squared.mean(axis=0), self.squared[len(self.squared) // 2 :].mean(axis=0)
        nees = None if self.nees is None else float(self.nees.mean())
        return dict(zip(METRICS, (*map(float, mean), nees, *map(float, late)), strict=True))


def evaluate(estimator: Estimator, mission: UsvMission, logs: UsvLogs) -> Outcome:
    """An estimator on all runs."""
    truth, runs = mission.voyage, len(logs.imu)
    squared, nees = np.zeros((len(truth.time_s), 3)), np.zeros(len(truth.time_s))
    for run in range(runs):
        done = navigate(estimator, mission, logs, run)
        mean, covariance = motion_of(done.mean, done.covariance)
        error = mean - _motion(truth)
        error[:, 4] = wl.wrap_angle(error[:, 4])
        squared += _shown(error[:, [0, 1, 4]]) ** 2 / runs
        nees += wl.metrics.nees(error, covariance) / runs
    return Outcome(squared[1:], nees[1:])


def raw(mission: UsvMission, logs: UsvLogs) -> Outcome:
    """Errors of GNSS and compass alone."""
    truth = mission.voyage
    error = np.concatenate(
        [
            logs.gnss - truth.position_m,
            wl.wrap_angle(logs.compass - truth.heading_rad)[..., None],
        ],
        axis=-1,
    )
    return Outcome(np.mean(_shown(error[:, 1:]) ** 2, axis=0))


def _motion(truth: UsvVoyage) -> np.ndarray:
    return np.column_stack([truth.position_m, truth.velocity_mps, truth.heading_rad])


def _shown(error: np.ndarray) -> np.ndarray:
    """Errors (..., 3) of north, east and heading, the heading's in degrees."""
    return error * [1.0, 1.0, np.degrees(1.0)]


# The bound ----------------------------------------------------------------------------------------


class Bound(NamedTuple):
    """Cramér-Rao bounds of eight states: covariances (T, 8, 8) of filter and smoother."""

    filtered: np.ndarray
    smoothed: np.ndarray

    def outcome(self, smoothed: bool = False) -> Outcome:
        """Variances of north, east and heading after the start."""
        variance = np.diagonal(self.smoothed if smoothed else self.filtered, axis1=1, axis2=2)
        return Outcome(_shown(_shown(variance[1:, [0, 1, 4]])))


def bound(mission: UsvMission) -> Bound:
    """The least covariances of position, velocity, heading and biases, for the true voyage.

    Information of the motion's Jacobian F along the truth, the IMU's noise Q and the sensors,

        J_k = (F J_{k-1}⁻¹ Fᵀ + Q)⁻¹ + Hᵀ R⁻¹ H,    J_0 = P_0⁻¹,

    and of all readings back from the end, P_k|T = P_k + G (P_k+1|T - P_k+1|k) Gᵀ with
    G = P_k Fᵀ P_k+1|k⁻¹.
    """
    truth, dt_s = mission.voyage, mission.period_s
    read = np.zeros((8, 8))
    read[[0, 1, 4], [0, 1, 4]] = (
        np.array([*mission.gnss_std_m, mission.compass_std_rad], dtype=float) ** -2
    )
    filtered, expected, steps = [np.diag(PRIOR_STD**2)], [], []
    for heading, imu in zip(truth.heading_rad[:-1], truth.imu[1:], strict=True):
        f, q = _step(heading, imu, mission.imu_std, dt_s)
        steps.append(f)
        expected.append(f @ filtered[-1] @ f.T + q)
        filtered.append(np.linalg.inv(np.linalg.inv(expected[-1]) + read))
    smoothed = [filtered[-1]]
    for p, f, ahead in zip(filtered[-2::-1], steps[::-1], expected[::-1], strict=True):
        gain = np.linalg.solve(ahead, f @ p).T
        smoothed.append(p + gain @ (smoothed[-1] - ahead) @ gain.T)
    return Bound(np.array(filtered), np.array(smoothed[::-1]))


def _step(
    heading: float, imu: np.ndarray, imu_std: tuple[float, float, float], dt_s: float
) -> tuple[np.ndarray, np.ndarray]:
    """F and Q of a step under the true acceleration [forward, starboard] and rate of turn."""
    middle = heading + dt_s / 2 * imu[2]
    c, s = np.cos(middle), np.sin(middle)
    turn = np.array([[c, -s], [s, c]])
    a = turn @ imu[:2]
    reach = np.array([dt_s**2 / 2, dt_s])  # of an acceleration, on position and velocity
    by_heading = np.kron(reach, [-a[1], a[0]])
    by_imu = np.zeros((8, 3))
    by_imu[:4, :2] = np.kron(reach[:, None], turn)
    by_imu[:5, 2] = [*(dt_s / 2 * by_heading), dt_s]
    f = np.eye(8)
    f[[0, 1], [2, 3]] = dt_s
    f[:4, 4] = by_heading
    f[:, 5:] -= by_imu
    q = (by_imu * np.square(imu_std)) @ by_imu.T
    q[[5, 6, 7], [5, 6, 7]] = dt_s * _BIAS_WALK**2
    return f, q


# The study ----------------------------------------------------------------------------------------


def _plan(request: Request) -> Plan:
    chosen = ESTIMATORS | (IN_FULL if request.full else {})
    jobs: dict[tuple[str, str], Callable[[], Outcome | ClosedLoop]] = {}
    for k, (scene, mission) in enumerate(missions().items()):
        logs = mission.draw(request.runs, [request.seed, k])
        least = bound(mission)
        jobs[scene, "gnss_compass"] = partial(raw, mission, logs)
        for name, estimator in chosen.items():
            jobs[scene, name] = partial(evaluate, estimator, mission, logs)
        jobs[scene, "bound8"] = least.outcome
        jobs[scene, "smoother_bound8"] = partial(least.outcome, smoothed=True)
    jobs |= closed_loops(request.runs, request.seed)
    return Plan(
        jobs=jobs,
        rows=_rows,
        pictures=lambda done, rows: _pictures(done, request.seed),
        notes=lambda done, rows: [NOTE],
    )


STUDY = Study(
    "usv-navigation",
    "an unmanned vessel by IMU, GNSS and compass: biases ignored and estimated, in closed loop",
    _plan,
    published={"paper": PAPER, "reference": REFERENCE},
)
run = STUDY.run


def _rows(done: Mapping[tuple[str, str], Outcome | ClosedLoop]) -> Rows:
    return [
        {"scenario": scene, "estimator": name} | outcome.figures()
        for (scene, name), outcome in done.items()
    ]


# Pictures -----------------------------------------------------------------------------------------

_COLORS = {
    "ukf8": plot.PALETTE[0],
    "ukf5_known_bias": plot.PALETTE[4],
    "ukf7_current": plot.PALETTE[2],
    "smoother8": plot.PALETTE[1],
}
_UNITS = ("north (m)", "east (m)", "heading (°)")
_BIASES = (
    ("forward bias (m/s²)", 1.0),
    ("starboard bias (m/s²)", 1.0),
    ("gyro bias (°/s)", np.degrees(1.0)),
)


def _pictures(done: Mapping[tuple[str, str], Outcome], seed: int) -> tuple[Picture, ...]:
    mission = missions()[SHOWN]
    logs = mission.draw(1, [seed, 0])
    beliefs = navigate(ESTIMATORS[DEFAULT], mission, logs, 0)
    outcomes = {name: outcome for (scene, name), outcome in done.items() if scene == SHOWN}
    return (
        Picture(
            "usv-mission",
            f"A mission in a current of {mission.current_mps:g} m/s",
            (partial(_draw_mission, mission=mission, logs=logs, beliefs=beliefs),),
            size_in=(7.2, 7.0),
        ),
        Picture(
            "usv-errors",
            "RMSE, and the bound of ukf8",
            tuple(
                partial(_draw_errors, mission=mission, outcomes=outcomes, axis=axis)
                for axis in range(len(_UNITS))
            ),
            size_in=(7.6, 7.4),
        ),
        Picture(
            "usv-biases",
            "The estimated biases of the IMU, with two standard deviations",
            tuple(
                partial(_draw_bias, mission=mission, beliefs=beliefs, axis=axis)
                for axis in range(len(_BIASES))
            ),
            size_in=(7.2, 6.4),
        ),
        *closed_pictures(done, seed),
    )


def _draw_mission(ax: Axes, mission: UsvMission, logs: UsvLogs, beliefs: Any) -> Axes:
    from matplotlib.patches import Circle

    truth = mission.voyage
    ax.scatter(
        *logs.gnss[0, :, ::-1].T, s=5, color=plot.MUTED, alpha=0.6, linewidths=0, label="GNSS"
    )
    for k, obstacle in enumerate(mission.obstacles):
        place = (obstacle.east_m, obstacle.north_m)
        name = "obstacle" if k == 0 else None
        ax.add_patch(
            Circle(place, obstacle.radius_m, color=plot.PALETTE[1], linewidth=0, label=name)
        )
    ways = np.vstack([np.zeros((1, 2)), mission.waypoints_m])
    ax.plot(
        *ways[:, ::-1].T,
        color=plot.MUTED,
        linewidth=0.8,
        linestyle=":",
        marker="o",
        label="waypoints",
    )
    ax.plot(*beliefs.mean[:, 1::-1].T, color=_COLORS[DEFAULT], linewidth=1.6, label=DEFAULT)
    ax.plot(
        *truth.position_m[:, ::-1].T, color=plot.INK, linewidth=1.0, linestyle="--", label="truth"
    )
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel="east (m)", ylabel="north (m)")
    north, east = 200.0 * mission.current
    ax.annotate(
        "",
        (500.0 + east, 120.0 + north),
        (500.0, 120.0),
        arrowprops={"arrowstyle": "->", "color": plot.INK, "linewidth": 1.6},
    )
    ax.text(500.0, 140.0, f"current {mission.current_mps:g} m/s", fontsize=plot.TEXT_PT)
    plot.dress(ax)
    return plot.name_lines(ax)


def _draw_errors(ax: Axes, mission: UsvMission, outcomes: Mapping[str, Outcome], axis: int) -> Axes:
    def curve(name: str) -> np.ndarray:
        return np.sqrt(outcomes[name].squared[:, axis])

    errors = {name: curve(name) for name in _COLORS}
    return plot.error_panel(
        ax,
        mission.voyage.time_s[1:],
        errors,
        bound=curve("bound8"),
        ylabel=_UNITS[axis],
        colors=_COLORS,
        legend=axis == 0,
    )


def _draw_bias(ax: Axes, mission: UsvMission, beliefs: Any, axis: int) -> Axes:
    name, scale = _BIASES[axis]
    time_s = mission.voyage.time_s
    mean = scale * beliefs.mean[:, 5 + axis]
    spread = 2.0 * scale * np.sqrt(beliefs.covariance[:, 5 + axis, 5 + axis])
    true, prior = scale * mission.imu_bias[axis], scale * PRIOR_STD[5 + axis]
    ax.fill_between(
        time_s, mean - spread, mean + spread, color=_COLORS[DEFAULT], alpha=0.2, linewidth=0
    )
    ax.plot(time_s, mean, color=_COLORS[DEFAULT], linewidth=1.4, label=DEFAULT)
    ax.axhline(true, color=plot.INK, linewidth=1.0, linestyle="--", label="truth")
    ax.set_xlim(time_s[0], time_s[-1])
    ax.set_ylim(min(true - prior, mean.min()), max(true + prior, mean.max()))
    ax.set(xlabel="time (s)", ylabel=name)
    plot.dress(ax)
    return plot.name_lines(ax) if axis == 0 else ax
