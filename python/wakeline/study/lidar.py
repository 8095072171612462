"""A lidar beside a radar: the bundled recording "autoferry", five runs with two boats.

The lidar looks every 0.5 s, sees boats up to about 150 m and is to the tracker a second radar. Its
points wander along a hull for seconds, so that a dozen looks are worth one: ``LIDAR`` has their
spread in a look as extent, and the time for which they are correlated. Estimators are the ``radar``
alone, the ``lidar`` alone and ``both``; ``lidar_late`` and ``radar_late`` have the data of one
sensor 1.7 s late, in a window of late data. Tracks are scored at the scans of the radar.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

import wakeline as wl
from wakeline import metrics, plot, recording
from wakeline.recording import Episode, Tracks
from wakeline.tracking import read_settings

from .base import Done, Picture, Plan, Request, Rows, Study, arrivals, means_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RADAR = read_settings(radar="autoferry").make_radar()
LIDAR = wl.Radar(
    range_std_m=2.0,
    bearing_std_rad=np.deg2rad(0.5),
    extent_std_m=2.0,
    correlation_time_s=3.0,
    period_s=0.5,
    max_speed_mps=RADAR.max_speed_mps,
    max_range_m=150.0,
)
CONFIG = wl.TrackerConfig(vessel_length_m=20.0)
GATE_M = 20.0
LATE_S = 1.7
SENSORS = {"radar": RADAR, "lidar": LIDAR}
ESTIMATORS = {
    "radar": {"radar": 0.0},
    "lidar": {"lidar": 0.0},
    "both": {"radar": 0.0, "lidar": 0.0},
    "lidar_late": {"radar": 0.0, "lidar": LATE_S},
    "radar_late": {"radar": LATE_S, "lidar": 0.0},
}


def tracker_of(late_s: dict[str, float]) -> wl.Tracker:
    """A tracker with the sensors that are given by how late their data come."""
    radars = [SENSORS[name] for name in late_s]
    kind = wl.LateWindow if any(late_s.values()) else wl.Tracker
    return kind(radars, config=CONFIG)


def follow(
    episodes: dict[str, Episode], late_s: dict[str, float]
) -> tuple[wl.track.TrackTable, Tracks]:
    """The last picture of a run, and the tracks as they were at each scan of the radar.

    Parameters
    ----------
    episodes : dict of str to Episode
        The run as each sensor saw it.
    late_s : dict of str to float
        The sensors that are used, and how late their data come.
    """
    tracker = tracker_of(late_s)
    calls = [
        (scan.time_s + late_s[name], number, scan, episodes[name].own)
        for number, name in enumerate(late_s)
        for scan in episodes[name].scans
    ]
    calls.sort(key=lambda call: call[:2])
    tables, begun = [], False
    for now_s, arrived in arrivals(calls, [*episodes["radar"].time_s.tolist(), np.inf]):
        begun = begun or bool(arrived)
        for _, number, scan, own in arrived:
            ((north_m, east_m),) = own.position_at(np.array([scan.time_s]))
            tracker.sector(
                radar=number,
                from_rad=0.0,
                to_rad=2 * np.pi,
                time_s=scan.time_s,
                range_m=scan.range_m,
                bearing_rad=scan.bearing_rad,
                plot_time_s=scan.plot_time_s,
                own=wl.OwnShip(north_m=north_m, east_m=east_m),
            )
        if np.isfinite(now_s) and begun:
            tables.append((now_s, tracker.tracks(now_s)))
    tracks = Tracks(
        track_id=np.concatenate([table.track_id for _, table in tables]).astype(str),
        time_s=np.concatenate([np.full(len(table), now_s) for now_s, table in tables]),
        state=np.concatenate([table.mean for _, table in tables]),
    )
    return tracker.tracks(), tracks


def _run(k: int) -> dict[str, dict[str, float]]:
    episodes = {
        "radar": recording.load("autoferry").episodes[k],
        "lidar": recording.load_lidar().episodes[k],
    }
    scores = {
        name: metrics.score(follow(episodes, late_s)[1], episodes["radar"], gate_m=GATE_M)
        for name, late_s in ESTIMATORS.items()
    }
    return {
        name: {
            "coverage": score.overall.coverage,
            "position_m": score.overall.errors.position_rmse_m,
            "velocity_mps": score.overall.errors.velocity_rmse_mps,
            "velocity_to_radar": _on_the_same(score, scores["radar"]),
            "velocity_to_lidar": _on_the_same(score, scores["lidar"]),
        }
        for name, score in scores.items()
    }


def _on_the_same(score: metrics.Score, other: metrics.Score) -> float:
    """The error of velocity over that of another estimator, on the track-scans of both."""
    errors = [_velocity_errors(one) for one in (score, other)]
    both = errors[0].keys() & errors[1].keys()
    squares = [sum(one[key] for key in both) for one in errors]
    return float(np.sqrt(squares[0] / squares[1])) if both else np.nan


def _velocity_errors(score: metrics.Score) -> dict[tuple[Any, ...], float]:
    """The squared error of each track-scan, by target and true state."""
    return {
        (target.target, *truth.tolist()): float(np.sum((estimate - truth)[1::2] ** 2))
        for episode in score.episodes
        for target in episode.targets
        for estimate, truth in zip(target.estimate, target.truth, strict=True)
    }


def _plan(request: Request) -> Plan:
    names = [episode.name for episode in recording.load("autoferry")]
    return Plan(
        {name: partial(_run, k) for k, name in enumerate(names)},
        _rows,
        pictures=lambda done, rows: _pictures(rows),
        runs=len(names),
    )


def _rows(done: Done) -> Rows:
    runs = {f"run_{name}": run for name, run in done.items()}
    rows = [
        {"scenario": name, "estimator": estimator, **figures}
        for name, run in runs.items()
        for estimator, figures in run.items()
    ]
    for estimator in ESTIMATORS if runs else ():
        mean = means_of([run[estimator] for run in runs.values()])
        rows.append({"scenario": "mean", "estimator": estimator, **mean})
    return rows


STUDY = Study("lidar", "a lidar beside a radar, in time and late: two boats in a harbor", _plan)
run = STUDY.run


# Pictures -----------------------------------------------------------------------------------------


def _pictures(rows: Rows) -> Iterator[Picture]:
    yield Picture(
        "lidar",
        "Coverage and error of velocity of a radar, a lidar and both",
        (
            lambda ax: _bars(ax, rows, "coverage", "coverage"),
            lambda ax: _bars(ax, rows, "velocity_mps", "velocity RMS, m/s"),
        ),
        size_in=(7.2, 5.0),
        shared=True,
    )


def _bars(ax: Axes, rows: Rows, metric: str, label: str) -> Axes:
    names = list(dict.fromkeys(row["scenario"] for row in rows))
    for k, estimator in enumerate(("radar", "lidar", "both")):
        heights = [row[metric] for row in rows if row["estimator"] == estimator]
        place = np.arange(len(heights)) + 0.27 * (k - 1)
        ax.bar(place, heights, 0.25, color=plot.PALETTE[k], label=estimator)
    ax.set_xticks(np.arange(len(names)), [name.replace("_", " ") for name in names])
    ax.set_ylabel(label)
    if metric == "coverage":
        ax.set_ylim(0.0, 1.3)
        ax.legend(loc="upper center", ncols=3)
    return ax
