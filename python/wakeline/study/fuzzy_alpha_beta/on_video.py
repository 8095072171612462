"""The same turn from radar video: the strobe is placed on the picture, scan by scan.

At 20 km the beam of a coastal radar is wider than the strobe, and the centroid in the strobe is
close to the strobe's center. Here the craft is 10 km away and the beam only three cells wide, so
that its echo fits into the strobe.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

import wakeline as wl
from wakeline.recording import RadarVideo
from wakeline.scenario import HardTurn, VideoScene, small_craft_scene
from wakeline.study import curves

from .estimators import estimators

LOST_AFTER = 3  # consecutive misses
RANGE_M = 10_000.0
LEAST_AMPLITUDE = 40  # above all but one in a hundred cells of the sea
# Standard deviation of the centroid from the craft, measured with strobes around the truth.
SENSOR = wl.ConvertedRangeBearing(range_std_m=2.2, bearing_std_rad=2.5 / RANGE_M)
_SNR_DB, _CLUTTER_TO_NOISE_DB = 12.0, 4.0
_BEAM_CELLS = 3.0
ACQUIRED_WITH_M = 45.0
_MARGIN_M = 120.0
_UNKNOWN = np.full(2, np.nan)


@dataclass
class Loop:
    """One estimator tracking one craft on video; arrays over scans, NaN after a loss.

    Attributes
    ----------
    estimator : object
    gate_m : float
        Radius of the strobe, which grows after a miss and shrinks again.
    radius_m : float
        Current radius, by the rules of `StrobeTrackerConfig`.
    predicted_m, estimate_m : list of (2,) arrays
        North and east: center of the strobe, and the estimate afterwards.
    echoes : list of (2,) arrays
        Range and bearing of the centroid in the strobe; NaN without one.
    misses : int
        Current number of consecutive misses.
    """

    estimator: Any
    gate_m: float
    predicted_m: list[np.ndarray] = field(default_factory=list)
    echoes: list[np.ndarray] = field(default_factory=list)
    estimate_m: list[np.ndarray] = field(default_factory=list)
    misses: int = 0
    radius_m: float = field(init=False)

    def __post_init__(self) -> None:
        self.radius_m = self.gate_m
        self._rules = wl.StrobeTrackerConfig(radius_m=self.gate_m)

    @property
    def lost(self) -> bool:
        return self.misses >= LOST_AFTER

    @property
    def measured_m(self) -> np.ndarray:
        """(T, 2) north and east of the centroids."""
        return curves.place_m(np.array(self.echoes))

    def begin(self, start: wl.Gaussian) -> Loop:
        """Start the estimator."""
        self.estimator.start(start)
        return self

    def take(self, turn: RadarVideo, period_s: float) -> None:
        """Predict, place the strobe on a revolution, and update with the plot in it."""
        if self.lost:
            for scans in (self.predicted_m, self.echoes, self.estimate_m):
                scans.append(_UNKNOWN)
            return
        self.estimator.predict(period_s)
        self.predicted_m.append(place_of(self.estimator))
        echo = strobe(turn, self.predicted_m[-1], self.radius_m)
        if echo is not None:
            self.estimator.update(SENSOR, echo)
        self.misses = 0 if echo is not None else self.misses + 1
        self.radius_m = self._rules.next_radius_m(self.radius_m, seen=echo is not None)
        self.echoes.append(_UNKNOWN if echo is None else echo)
        self.estimate_m.append(place_of(self.estimator))


class Acquisition:
    """The first two plots, the nearest in wide strobes around the truth.

    An operator points at the craft, not at the strongest echo near it.
    """

    def __init__(self) -> None:
        self._plots: list[np.ndarray] = []

    def start(self, turn: RadarVideo, craft_m: np.ndarray, period_s: float) -> wl.Gaussian | None:
        """Take a revolution; the start once two in a row have an echo."""
        plot = strobe(turn, craft_m, ACQUIRED_WITH_M, several="nearest")
        self._plots = [] if plot is None else [*self._plots, plot]
        return wl.two_point(SENSOR, *self._plots, period_s) if len(self._plots) == 2 else None


@dataclass(frozen=True)
class VideoRun:
    """All estimators on one simulated recording.

    Attributes
    ----------
    time_s : ndarray (T,)
        Times at which the beam passed the craft.
    truth : ndarray (T, 4)
    loops : mapping of str to Loop
    last : RadarVideo
        The last revolution.
    """

    time_s: np.ndarray
    truth: np.ndarray
    loops: Mapping[str, Loop]
    last: RadarVideo

    def error_m(self, name: str) -> np.ndarray:
        """(T,) distance from the estimate to the truth; NaN after a loss."""
        return np.linalg.norm(np.array(self.loops[name].estimate_m) - self.truth[:, ::2], axis=-1)


def follow(situation: HardTurn, gate_m: float, seed: int, margin_m: float = _MARGIN_M) -> VideoRun:
    """Simulate the picture around the craft and let every estimator track it.

    The margin is that of the picture around the craft.
    """
    scene = video_scene(situation, seed, margin_m)
    craft = scene.targets["craft"]
    period_s = situation.period_s
    acquisition = Acquisition()
    loops: dict[str, Loop] = {}
    time_s: list[float] = []
    looks = scene.radar.windows(
        {"craft": [craft]}, len(situation.time_s), seed, around=craft.truth, margin_m=margin_m
    )
    for look in looks:
        turn = look["craft"]
        now_s = float(turn.time_s.mean())
        if not loops:
            start = acquisition.start(turn, craft.truth.state_at(now_s)[0, ::2], period_s)
            if start is not None:
                loops = {
                    name: Loop(estimator, gate_m).begin(start)
                    for name, estimator in estimators().items()
                }
            continue
        time_s.append(now_s)
        for loop in loops.values():
            loop.take(turn, period_s)
    return VideoRun(np.array(time_s), craft.truth.state_at(np.array(time_s)), loops, turn)


def video_scene(situation: HardTurn, seed: int, margin_m: float = _MARGIN_M) -> VideoScene:
    """The small craft in sea clutter, so near that its echo fits into the strobe."""
    near = replace(situation, range_m=RANGE_M)
    scene = small_craft_scene(seed, situation=near, margin_m=margin_m, beam_cells=_BEAM_CELLS)
    sea = replace(scene.radar.sea, clutter_to_noise_db=_CLUTTER_TO_NOISE_DB)
    return replace(scene, radar=replace(scene.radar, snr_db=_SNR_DB, sea=sea))


def strobe(
    turn: RadarVideo, around_m: np.ndarray, radius_m: float, several: str = "all"
) -> np.ndarray | None:
    """Range and bearing of the centroid in a circular strobe; None without an echo."""
    echo = wl.gating.strobe_echo(
        turn,
        wl.RadiusGate(radius_m=radius_m),
        around_m,
        least_amplitude=LEAST_AMPLITUDE,
        several=several,
    )
    return np.array([echo.range_m, echo.bearing_rad]) if echo else None


def place_of(estimator: Any) -> np.ndarray:
    """North and east of an estimate."""
    return estimator.estimate().mean[::2]
