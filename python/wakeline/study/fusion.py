"""Several sensors: two radars that overlap, AIS beside a radar, and AIS that lies.

- ``two_radars``: 40 vessels in the view of two radars of other errors, periods and places; by the
  ``fine`` one alone, the ``coarse`` one alone, and ``both``.
- ``ais``: 40 vessels that report every 10 s, 1 to 20 s late; by the ``radar`` alone, ``both`` as
  they come, and both with a window of late data, ``in_place``. ``radar_by_law`` and
  ``both_by_law`` have every eighth vessel followed by an estimator that knows how vessels of the
  scene move and which plots are theirs.
- ``wrong_ais``: 60 vessels of which 40 report, six of them wrongly: 2 NM off, a position that
  stands, at 0/0, an identity that two use, one that moves to another vessel, and a drift.

Radars give 16 sectors a turn and reports come as they arrive. Vessels run straight and turn. GOSPA
has the cut-off 100 m and order 2; a vessel is covered where a track is within 100 m. A twentieth of
the runs, rounded up, is made of each scene.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

import wakeline as wl
from wakeline import metrics, plot
from wakeline._units import NAUTICAL_MILE_M
from wakeline.scenario import RadarSimulator
from wakeline.scenario.truth import Segment, Truth

from .base import Done, Picture, Plan, Request, Rows, Study, arrivals, means_of, radar_of
from .known_law import Law, Particles

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CUT_OFF_M = 100.0
SECTORS = 16
DURATION_S = 240.0
SETTLED_S = 60.0
STEP_S = 2.5
FINE = RadarSimulator(10.0, np.deg2rad(0.5), 2.5, detection_probability=0.9, rotating=True)
COARSE = RadarSimulator(25.0, np.deg2rad(1.2), 3.0, detection_probability=0.9, rotating=True)
COARSE_PLACE = (4000.0, -2000.0)
AIS_STD_M = 5.0
AIS_STD_MPS = 0.2
LAW = Law(straight_s=(60.0, 200.0), turn_s=(10.0, 40.0), turn_deg_s=(0.5, 2.0))

_RUNS_PER_SCENE = 20


# Scenes -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Reports:
    """How a vessel reports.

    Attributes
    ----------
    identity : str
    offset_m : (float, float)
        Of its positions, north and east.
    stands_s : float
        From then on the position stands.
    drift_mps : float
        Northwards, of its positions, from a minute on.
    nowhere : bool
        It reports the origin, at rest.
    """

    identity: str
    offset_m: tuple[float, float] = (0.0, 0.0)
    stands_s: float = np.inf
    drift_mps: float = 0.0
    nowhere: bool = False

    def at(self, truth: Truth, time_s: float, rng: np.random.Generator) -> dict[str, float]:
        """The report of a time."""
        north_m, vnorth_mps, east_m, veast_mps = truth.state_at(min(time_s, self.stands_s))[0]
        if self.nowhere:
            north_m = vnorth_mps = east_m = veast_mps = 0.0
        north_m += self.offset_m[0] + self.drift_mps * max(time_s - 60.0, 0.0)
        error_m, error_mps = AIS_STD_M * rng.normal(size=2), AIS_STD_MPS * rng.normal(size=2)
        return {
            "time_s": time_s,
            "north_m": north_m + error_m[0],
            "east_m": east_m + self.offset_m[1] + error_m[1],
            "vnorth_mps": vnorth_mps + error_mps[0],
            "veast_mps": veast_mps + error_mps[1],
            "position_std_m": AIS_STD_M,
            "velocity_std_mps": 0.3,
        }


@dataclass
class Scene:
    """Vessels, and what the sensors have of them: calls of a tracker in the order of arrival.

    Attributes
    ----------
    truths : list of Truth
    identity : list of str
        Of each vessel by AIS; empty where it does not report, or wrongly.
    calls : list
        (arrival s, sensor, arguments): sensor 0 and 1 are radars, 2 is AIS.
    """

    truths: list[Truth]
    identity: list[str]
    calls: list[tuple[float, int, dict[str, Any]]] = field(default_factory=list)

    def look(
        self, number: int, radar: RadarSimulator, place: tuple[float, float], rng: Any
    ) -> None:
        """Add the sectors of a radar at a place."""
        own = Truth([place[0], 0.0, place[1], 0.0])
        truths = {str(k): truth for k, truth in enumerate(self.truths)}
        recording = radar.record(truths, int(DURATION_S / radar.period_s), rng, own=own)
        (episode,) = recording.episodes
        edge_rad = np.linspace(0.0, 2 * np.pi, SECTORS + 1)
        for scan in episode.scans:
            begin_s = scan.time_s - radar.period_s
            part = np.clip(
                np.digitize(scan.bearing_rad % (2 * np.pi), edge_rad) - 1, 0, SECTORS - 1
            )
            for k in range(SECTORS):
                end_s = begin_s + radar.period_s * (k + 1) / SECTORS
                inside = part == k
                call = {
                    "from_rad": edge_rad[k],
                    "to_rad": edge_rad[k + 1],
                    "time_s": end_s,
                    "range_m": scan.range_m[inside],
                    "bearing_rad": scan.bearing_rad[inside],
                    "plot_time_s": scan.plot_time_s[inside],
                    "own": wl.OwnShip(north_m=place[0], east_m=place[1]),
                }
                self.calls.append((end_s, number, call))

    def report(self, vessel: int, reports: Reports, rng: np.random.Generator) -> None:
        """Add the reports of a vessel."""
        for time_s in np.arange(rng.uniform(0.0, 10.0), DURATION_S, 10.0):
            arrival_s = time_s + rng.uniform(1.0, 20.0)
            values = reports.at(self.truths[vessel], float(time_s), rng)
            self.calls.append((arrival_s, 2, {"identity": reports.identity, **values}))


def fleet(count: int, rng: np.random.Generator) -> list[Truth]:
    """Vessels at 2 to 10 m/s that turn now and then, 400 m apart at the beginning."""
    found: list[Truth] = []
    places: list[np.ndarray] = []
    while len(found) < count:
        place = rng.uniform([-4500.0, -4500.0], [6000.0, 4500.0])
        near = any(np.hypot(*(place - other)) < 400.0 for other in places)
        if near or min(np.hypot(*place), np.hypot(*(place - COARSE_PLACE))) < 600.0:
            continue
        course, speed = rng.uniform(0, 2 * np.pi), rng.uniform(2.0, 10.0)
        segments = []
        while sum(segment.duration_s for segment in segments) < DURATION_S:
            turn = LAW.turn_rates(rng)
            segments += [
                Segment(rng.uniform(*LAW.straight_s)),
                Segment(rng.uniform(*LAW.turn_s), turn_rate_rad_s=turn),
            ]
        start = [place[0], speed * np.cos(course), place[1], speed * np.sin(course)]
        found.append(Truth(start, segments))
        places.append(place)
    return found


def _two_radars(rng: np.random.Generator) -> Scene:
    scene = Scene(fleet(40, rng), [""] * 40)
    scene.look(0, FINE, (0.0, 0.0), rng)
    scene.look(1, COARSE, COARSE_PLACE, rng)
    return scene


def _ais(rng: np.random.Generator) -> Scene:
    scene = Scene(fleet(40, rng), [str(257_000_000 + k) for k in range(40)])
    scene.look(0, FINE, (0.0, 0.0), rng)
    for k, identity in enumerate(scene.identity):
        scene.report(k, Reports(identity), rng)
    return scene


def _wrong_ais(rng: np.random.Generator) -> Scene:
    names = [str(257_000_000 + k) for k in range(40)]
    right = ["", "", "", "", "", "", *names[6:]]
    scene = Scene(fleet(60, rng), right + [""] * 20)
    scene.look(0, FINE, (0.0, 0.0), rng)
    wrong = [
        Reports(names[0], offset_m=(2 * NAUTICAL_MILE_M, 0.0)),
        Reports(names[1], stands_s=60.0),
        Reports(names[2], nowhere=True),
        Reports(names[3]),  # as vessel 4 does
        Reports(names[3]),
        Reports(names[5], drift_mps=6.0),
    ]
    for k, name in enumerate(names):
        scene.report(k, wrong[k] if k < len(wrong) else Reports(name), rng)
    return scene


SCENES = {
    "two_radars": (_two_radars, {"fine": {0}, "coarse": {1}, "both": {0, 1}}),
    "ais": (_ais, {"radar": {0}, "both": {0, 2}, "in_place": {0, 2}}),
    "wrong_ais": (_wrong_ais, {"radar": {0}, "both": {0, 2}}),
}
WINDOW_S = {"in_place": 20.0}
BY_LAW = {"ais": {"radar_by_law": {0}, "both_by_law": {0, 2}}}
PARTICLES = 5000
EVERY = 8


# Figures ------------------------------------------------------------------------------------------


def _tracker(sensors: set[int], window_s: float) -> tuple[wl.Tracker, dict[int, int]]:
    """A tracker with the radars among some sensors, and their numbers in it."""
    simulators = {0: FINE, 1: COARSE}
    used = sorted(sensors & set(simulators))
    radars = [radar_of(simulators[k]) for k in used]
    tracker = wl.LateWindow(radars, window_s=window_s) if window_s else wl.Tracker(radars)
    return tracker, {k: number for number, k in enumerate(used)}


def follow(scene: Scene, sensors: set[int], window_s: float = 0.0) -> dict[str, float]:
    """The figures of a tracker that is given some of the sensors, late data in a window."""
    tracker, number = _tracker(sensors, window_s)
    calls = sorted((call for call in scene.calls if call[1] in sensors), key=lambda call: call[0])
    states = _scored_times()
    sums = dict.fromkeys(("position", "velocity", "matched", "gospa", "right", "twice"), 0.0)
    longest_s, double_s = 0.0, np.zeros(len(scene.truths))
    for now_s, arrived in arrivals(calls, states):
        for _, sensor, values in arrived:
            if sensor in number:
                tracker.sector(radar=number[sensor], **values)
            else:
                tracker.report(**values)
        tracks = tracker.tracks(now_s)
        truth = np.array([one.state_at(now_s)[0] for one in scene.truths])
        sums["gospa"] += metrics.gospa(
            truth[:, ::2], tracks.mean[:, ::2], cutoff_m=CUT_OFF_M
        ).gospa_m
        if not len(tracks):
            continue
        apart_m = np.hypot(*(truth[:, None, ::2] - tracks.mean[None, :, ::2]).transpose(2, 0, 1))
        nearest = apart_m.argmin(axis=1)
        found = apart_m[np.arange(len(truth)), nearest] < CUT_OFF_M
        error = tracks.mean[nearest] - truth
        sums["position"] += np.sum(error[found][:, ::2] ** 2)
        sums["velocity"] += np.sum(error[found][:, 1::2] ** 2)
        sums["matched"] += found.sum()
        own = apart_m.argmin(axis=0)
        twice = np.bincount(own[apart_m.min(axis=0) < 50.0], minlength=len(truth)) > 1
        twice &= _alone(truth)
        double_s = np.where(twice, double_s + STEP_S, 0.0)
        longest_s = max(longest_s, double_s.max())
        names = np.array(tracks.identity)[nearest]
        sums["right"] += np.sum((names == np.array(scene.identity))[found])
    return {
        "gospa_m": sums["gospa"] / len(states),
        "coverage": sums["matched"] / len(states) / len(scene.truths),
        "position_m": float(np.sqrt(sums["position"] / sums["matched"])),
        "velocity_mps": float(np.sqrt(sums["velocity"] / sums["matched"])),
        "double_s": longest_s,
        "identity_right": sums["right"] / sums["matched"],
    }


def _alone(truth: np.ndarray) -> np.ndarray:
    """Whether no other vessel is within 100 m, whose track could be the nearer."""
    between_m = np.hypot(*(truth[:, None, ::2] - truth[None, :, ::2]).transpose(2, 0, 1))
    return np.sum(between_m < 100.0, axis=1) == 1


def _scored_times() -> np.ndarray:
    return np.arange(SETTLED_S, DURATION_S - STEP_S, STEP_S)


def follow_by_law(scene: Scene, sensors: set[int]) -> dict[str, float]:
    """The errors of an estimator that knows `LAW` and which plots are of which vessel."""
    rng = np.random.default_rng(len(scene.calls))
    errors = np.concatenate(
        [_errors_by_law(scene, k, sensors, rng) for k in range(0, len(scene.truths), EVERY)]
    )
    position, velocity = (np.mean(np.sum(errors[:, k::2] ** 2, axis=1)) for k in (0, 1))
    return {"position_m": float(np.sqrt(position)), "velocity_mps": float(np.sqrt(velocity))}


def _errors_by_law(
    scene: Scene, vessel: int, sensors: set[int], rng: np.random.Generator
) -> np.ndarray:
    truth = scene.truths[vessel]
    events: list[tuple[float, str, Any]] = [(time_s, "score", None) for time_s in _scored_times()]
    for number, (arrival_s, sensor, values) in enumerate(scene.calls):
        if sensor not in sensors:
            continue
        if sensor == 0:
            events += [(plot[0], "plot", plot[1:]) for plot in _plots_of(truth, values)]
        elif values["identity"] == scene.identity[vessel]:
            events += [(values["time_s"], "made", number), (arrival_s, "report", number)]
    events.sort(key=lambda event: event[0])
    begin_s = next(time_s for time_s, kind, _ in events if kind == "plot")
    particles = Particles(LAW, PARTICLES, truth.state_at(begin_s)[0], begin_s, rng)
    made, errors = set(), []
    for time_s, kind, what in events:
        if time_s < begin_s:
            continue
        particles.move_to(time_s)
        if kind == "plot":
            particles.weigh(_plot_squares(particles.states, *what))
        elif kind == "made":
            particles.remember(what)
            made.add(what)
        elif kind == "report" and what in made:
            particles.weigh(_report_squares(particles.recall(what), scene.calls[what][2]))
        elif kind == "score":
            errors.append(particles.mean - truth.state_at(time_s)[0])
    return np.array(errors)


def _plots_of(truth: Truth, sector: dict[str, Any]) -> Iterator[tuple[float, float, float]]:
    """Times, ranges and bearings of the plots of a sector that are a vessel's."""
    plots = zip(sector["plot_time_s"], sector["range_m"], sector["bearing_rad"], strict=True)
    for time_s, range_m, bearing_rad in plots:
        if _plot_squares(truth.state_at(time_s)[0][:, None], range_m, bearing_rad)[0] < 20.0:
            yield time_s, range_m, bearing_rad


def _plot_squares(states: np.ndarray, range_m: float, bearing_rad: float) -> np.ndarray:
    far_m = range_m - np.hypot(states[0], states[2])
    aside_rad = wl.wrap_angle(bearing_rad - np.arctan2(states[2], states[0]))
    return (far_m / FINE.range_std_m) ** 2 + (aside_rad / FINE.bearing_std_rad) ** 2


def _report_squares(states: np.ndarray, report: dict[str, Any]) -> np.ndarray:
    names = ("north_m", "vnorth_mps", "east_m", "veast_mps")
    errors = states - np.array([report[name] for name in names])[:, None]
    errors[::2] /= report["position_std_m"]
    errors[1::2] /= report["velocity_std_mps"]
    return np.sum(errors**2, axis=0)


def _run(name: str, seed: int) -> dict[str, dict[str, float]]:
    make, estimators = SCENES[name]
    scene = make(np.random.default_rng([seed, *map(ord, name)]))
    figures = {
        estimator: follow(scene, sensors, WINDOW_S.get(estimator, 0.0))
        for estimator, sensors in estimators.items()
    }
    by_law = BY_LAW.get(name, {}).items()
    return figures | {estimator: follow_by_law(scene, sensors) for estimator, sensors in by_law}


def _plan(request: Request) -> Plan:
    runs = -(-request.runs // _RUNS_PER_SCENE)
    jobs = {
        (name, request.seed + k): lambda name=name, seed=request.seed + k: _run(name, seed)
        for name in SCENES
        for k in range(runs)
    }
    return Plan(jobs, _rows, pictures=lambda done, rows: _pictures(rows), runs=runs)


def _rows(done: Done) -> Rows:
    rows = []
    for name, (_, estimators) in SCENES.items():
        runs = [run for (of, _), run in done.items() if of == name]
        for estimator in [*estimators, *BY_LAW.get(name, ())] if runs else ():
            figures = [run[estimator] for run in runs]
            row = {"scenario": name, "estimator": estimator, **means_of(figures)}
            if estimator in estimators:
                row["double_s"] = float(max(one["double_s"] for one in figures))
            rows.append(row)
    return rows


STUDY = Study("fusion", "several sensors: two radars, AIS beside a radar, AIS that lies", _plan)
run = STUDY.run


# Pictures -----------------------------------------------------------------------------------------


def _pictures(rows: Rows) -> Iterator[Picture]:
    yield Picture(
        "fusion",
        "Errors of one sensor and of all",
        (
            lambda ax: _bars(ax, rows, "position_m", "position RMS, m"),
            lambda ax: _bars(ax, rows, "velocity_mps", "velocity RMS, m/s"),
        ),
        size_in=(7.2, 5.0),
        shared=True,
    )


def _bars(ax: Axes, rows: Rows, metric: str, label: str) -> Axes:
    names = [f"{row['scenario']}\n{row['estimator']}".replace("_", " ") for row in rows]
    colors = [plot.PALETTE[0 if row["estimator"] in ("both", "in_place") else 1] for row in rows]
    ax.bar(np.arange(len(rows)), [row[metric] for row in rows], 0.6, color=colors)
    ax.set_xticks(np.arange(len(rows)), names)
    ax.set_ylabel(label)
    return ax
