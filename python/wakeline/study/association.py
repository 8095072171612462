"""Dense traffic: the tracker on scenes of crossings, clutter, anchorages and merged echoes.

Every scene has exact truth and a rotating antenna that gives each plot its own time. The tracker
has its defaults and nothing is given. The other estimators each change one part of it:

- ``global_nearest``: one plot for each track, by the best total, instead of belief propagation.
- ``no_outliers``: no plot is an outlier.
- ``no_map``: the density of clutter by range alone, without the map.
- ``no_prior_speed``: starts from two plots without a prior of the speed.

GOSPA has the cut-off 100 m and order 2, and leaves out the first five scans. A hundredth of the
runs, rounded up, is drawn of each scene.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

import wakeline as wl
from wakeline import metrics, plot
from wakeline.recording import Recording, Tracks
from wakeline.scenario.dense import RADAR, SCENES

from .base import Done, Picture, Plan, Request, Rows, Study, means_of, radar_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CUT_OFF_M = 100.0
SKIPPED_SCANS = 5
ESTIMATORS: dict[str, dict[str, Any]] = {
    "tracker": {},
    "global_nearest": {"association": "global_nearest"},
    "no_outliers": {"outlier_probability": 0.0},
    "no_map": {"clutter_cell_m": 0.0},
    "no_prior_speed": {"start_speed_factor": 0.0},
}

_RUNS_PER_SCENE = 100
_SHOWN = ("clutter_1000", "anchorage", "merged", "crossings")


def track(recording: Recording, estimator: str) -> Tracks:
    """The tracks of a run, with the errors of the radar given."""
    config = wl.TrackerConfig(**ESTIMATORS[estimator])
    return wl.track_recording(recording, radar=radar_of(RADAR), config=config)


def record(scene: str, seed: int) -> Recording:
    """A run of a scene."""
    return SCENES[scene].record(np.random.default_rng([seed, *map(ord, scene)]))


def figures(tracks: Tracks, recording: Recording) -> dict[str, float | None]:
    """The figures of a run."""
    score = metrics.score(tracks, recording, gate_m=CUT_OFF_M)
    overall, (episode,) = score.overall, score.episodes
    scans = [target.initiation_scans for target in episode.targets]
    return {
        "gospa_m": float(np.mean([g.gospa_m for g in episode.gospa[SKIPPED_SCANS:]])),
        "coverage": overall.coverage,
        "position_m": overall.errors.position_rmse_m,
        "switches": float(overall.switches),
        "false_tracks": float(overall.false_tracks),
        "delay_scans": float(np.mean([s for s in scans if s is not None])),
    }


def _run(scene: str, seed: int) -> dict[str, dict[str, float | None]]:
    recording = record(scene, seed)
    return {name: figures(track(recording, name), recording) for name in ESTIMATORS}


def _plan(request: Request) -> Plan:
    runs = -(-request.runs // _RUNS_PER_SCENE)
    jobs = {
        (scene, request.seed + k): lambda scene=scene, seed=request.seed + k: _run(scene, seed)
        for scene in SCENES
        for k in range(runs)
    }
    return Plan(
        jobs,
        _rows,
        pictures=lambda done, rows: _pictures(request.seed, rows),
        runs=runs,
    )


def _rows(done: Done) -> Rows:
    return [
        {"scenario": scene, "estimator": name, **means_of([run[name] for run in runs])}
        for scene in SCENES
        if (runs := [run for (of, _), run in done.items() if of == scene])
        for name in ESTIMATORS
    ]


STUDY = Study(
    "association",
    "the tracker in dense traffic: crossings, clutter, anchorages and merged echoes",
    _plan,
)
run = STUDY.run


# Pictures -----------------------------------------------------------------------------------------


def _pictures(seed: int, rows: Rows) -> Iterator[Picture]:
    yield Picture(
        "association",
        "GOSPA of the tracker, and with one part changed",
        (lambda ax: _bars(ax, rows),),
        size_in=(7.2, 4.2),
    )
    yield Picture(
        "association-scenes",
        "Tracks in dense scenes",
        tuple(lambda ax, scene=scene: _map(ax, scene, seed) for scene in _SHOWN),
        size_in=(7.2, 7.4),
        columns=2,
        shared=False,
    )


def _bars(ax: Axes, rows: Rows) -> Axes:
    place = np.arange(len(SCENES))
    width = 0.8 / len(ESTIMATORS)
    for k, name in enumerate(ESTIMATORS):
        value = [row["gospa_m"] for row in rows if row["estimator"] == name]
        ax.bar(place + (k - 2) * width, value, width, label=name, color=plot.PALETTE[k])
    ax.set_xticks(place, [name.replace("_", "\n") for name in SCENES])
    ax.set_ylabel("GOSPA, m")
    ax.legend(frameon=False, ncols=3)
    return ax


def _map(ax: Axes, scene: str, seed: int) -> Axes:
    recording = record(scene, seed)
    tracks = track(recording, "tracker")
    (episode,) = recording.episodes
    for scan in episode.scans[-30:]:
        ax.plot(*scan.position_m[:, ::-1].T / 1e3, ".", color=plot.MUTED, ms=1.0, zorder=1)
    for track_id in tracks.ids():
        path = tracks.where(tracks.track_id == track_id).state
        ax.plot(path[:, 2] / 1e3, path[:, 0] / 1e3, lw=1.0, zorder=2)
    ax.set_aspect("equal")
    ax.set_title(f"{scene}: {SCENES[scene].summary}", fontsize=plot.TEXT_PT)
    ax.set_xlabel("east, km")
    ax.set_ylabel("north, km")
    return ax
