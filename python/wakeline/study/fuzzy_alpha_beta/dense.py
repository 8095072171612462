"""Dense traffic: another craft passes, overtakes or keeps abreast, and may capture the strobe.

The craft of 10 m/s that turns hard is met on its first straight by a craft like it. Two craft that
are close have one echo on the picture, and a strobe that is wide or off its craft measures both.
Each estimator tracks the craft with strobes of every radius, on the same pictures.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from enum import IntEnum
from math import dist
from typing import NamedTuple

import numpy as np

from wakeline.recording import RadarVideo
from wakeline.scenario import Segment, Truth, hard_turns

from .estimators import estimators
from .on_video import ACQUIRED_WITH_M, Acquisition, Loop, video_scene

SITUATION = hard_turns()["10mps_r300"]
KINDS = ("passing", "overtaking", "abreast")
DISTANCES_M = (20, 30, 50, 100)
GATES_M = (12.0, 14.0, 16.0, 18.0, 22.0, 27.0, 35.0, 50.0)
ALONE = "alone"
ALLOWED_LOSS = 0.03
_MEETS_S = (65.0, 85.0)
_OVERTAKES_BY_MPS = 4.0
_JOINS_S, _JOINS_AT_RAD, _JOINS_IN_S = 40.0, np.deg2rad(15.0), 5.0
_ENDS_M, _FILM_MARGIN_M = 150.0, 260.0
_STREAM = 0xDE45E


class Ending(IntEnum):
    """What the strobe is on at the end: the craft, the neighbor, or neither."""

    HELD = 0
    CAPTURED = 1
    LOST = 2


Of = tuple[str, str, float]  # case, estimator and gate radius


def case_of(kind: str, distance_m: float) -> str:
    """Name of a case, such as ``passing_50m``."""
    return f"{kind}_{distance_m:g}m"


def neighbor(kind: str, craft: Truth, distance_m: float, meets_s: float) -> Truth:
    """A craft abeam of another one at a time, on the side from which that one turns away.

    Parameters
    ----------
    kind : str
        "passing" on the opposite course at the same speed; "overtaking" on the same course, 4 m/s
        faster; "abreast" at the same speed, after joining from 15 degrees aside at 45 s.
    craft : Truth
        On a straight until it turns.
    distance_m : float
        Between the centers when abeam.
    meets_s : float
    """
    side = -np.sign(sum(segment.turn_rate_rad_s for segment in craft.segments))
    north_m, vnorth_mps, east_m, veast_mps = craft.state_at(meets_s)[0]
    velocity = complex(vnorth_mps, veast_mps)
    ahead = velocity / abs(velocity)
    abeam = complex(north_m, east_m) + 1j * side * distance_m * ahead
    legs: tuple[Segment, ...] = ()
    if kind == "passing":
        velocity = -velocity
    elif kind == "overtaking":
        velocity += _OVERTAKES_BY_MPS * ahead
    else:
        velocity *= np.exp(-1j * side * _JOINS_AT_RAD)
        legs = (Segment(_JOINS_S), Segment(_JOINS_IN_S, side * _JOINS_AT_RAD / _JOINS_IN_S))
    path = Truth([0.0, velocity.real, 0.0, velocity.imag], legs)
    start = abeam - path.state_at(meets_s)[0, ::2] @ [1.0, 1j]
    return Truth([start.real, velocity.real, start.imag, velocity.imag], legs)


class Encounter:
    """Every estimator with every gate on the pictures of one case."""

    def __init__(self, gates_m: Iterable[float]) -> None:
        self.endings: dict[tuple[str, float], Ending] = {}
        self._gates_m = tuple(gates_m)
        self._acquisition = Acquisition()
        self._loops: dict[tuple[str, float], Loop] | None = None

    def take(self, turn: RadarVideo, craft_m: np.ndarray, other_m: np.ndarray) -> None:
        """Track on a revolution; positions of both craft when the beam passed the first."""
        if self._loops is None:
            start = self._acquisition.start(turn, craft_m, SITUATION.period_s)
            if start is not None:
                self._loops = {
                    (name, gate_m): Loop(estimator, gate_m).begin(start)
                    for gate_m in self._gates_m
                    for name, estimator in estimators().items()
                }
            return
        for key, loop in list(self._loops.items()):
            loop.take(turn, SITUATION.period_s)
            off_m = dist(loop.estimate_m[-1], craft_m)
            if loop.lost or off_m > _ENDS_M:
                del self._loops[key]
                self.endings[key] = ending(loop, craft_m, other_m)

    def end(self, craft_m: np.ndarray, other_m: np.ndarray) -> None:
        """The recording ends."""
        for key, loop in (self._loops or {}).items():
            self.endings[key] = ending(loop, craft_m, other_m)


def ending(loop: Loop, craft_m: np.ndarray, other_m: np.ndarray) -> Ending:
    """What a track is on: the nearer of both craft, if that is within the acquisition's radius."""
    if loop.lost:
        return Ending.LOST
    off_m = {
        Ending.HELD: dist(loop.estimate_m[-1], craft_m),
        Ending.CAPTURED: dist(loop.estimate_m[-1], other_m),
    }
    nearer = min(off_m, key=off_m.__getitem__)
    return nearer if off_m[nearer] <= ACQUIRED_WITH_M else Ending.LOST


class Moment(NamedTuple):
    """A revolution of one run: the picture and the position of the neighbor by case."""

    pictures: dict[str, RadarVideo]
    craft_m: np.ndarray
    others_m: dict[str, np.ndarray]


def moments(
    seed: int, kinds: Iterable[str], distances_m: Iterable[float], margin_m: float
) -> Iterator[Moment]:
    """One run: the same craft on the same sea, alone and met by a neighbor in each case."""
    scene = video_scene(SITUATION, seed, margin_m)
    craft = scene.targets["craft"]
    meets_s = np.random.default_rng([seed, _STREAM]).uniform(*_MEETS_S)
    others = {
        case_of(kind, distance_m): neighbor(kind, craft.truth, distance_m, meets_s)
        for kind in kinds
        for distance_m in distances_m
    }
    met = {case: [craft, replace(craft, truth=truth)] for case, truth in others.items()}
    looks = scene.radar.windows(
        {ALONE: [craft], **met},
        len(SITUATION.time_s),
        seed,
        around=craft.truth,
        margin_m=margin_m,
    )
    nowhere_m = np.full(2, np.inf)
    for look in looks:
        now_s = float(look[ALONE].time_s.mean())
        others_m = {case: truth.state_at(now_s)[0, ::2] for case, truth in others.items()}
        yield Moment(look, craft.truth.state_at(now_s)[0, ::2], {ALONE: nowhere_m, **others_m})


def meet(
    seed: int,
    *,
    kinds: Iterable[str] = KINDS,
    distances_m: Iterable[float] = DISTANCES_M,
    gates_m: Iterable[float] = GATES_M,
) -> dict[Of, Ending]:
    """How each strobe ends in a run.

    A track ends when it is lost by three misses or is 150 m off the craft, else with the recording.
    """
    gates_m = tuple(gates_m)
    encounters: dict[str, Encounter] = {}
    for moment in moments(seed, kinds, distances_m, _ENDS_M + max(gates_m)):
        for case, turn in moment.pictures.items():
            encounter = encounters.setdefault(case, Encounter(gates_m))
            encounter.take(turn, moment.craft_m, moment.others_m[case])
    for case, encounter in encounters.items():
        encounter.end(moment.craft_m, moment.others_m[case])
    return {
        (case, *of): found
        for case, encounter in encounters.items()
        for of, found in encounter.endings.items()
    }


class Frame(NamedTuple):
    """A revolution of a film: the picture, both craft, and the centers of the strobes."""

    turn: RadarVideo
    craft_m: np.ndarray
    other_m: np.ndarray
    strobes_m: dict[str, np.ndarray]


def film(seed: int, kind: str, distance_m: float, gates_m: Mapping[str, float]) -> list[Frame]:
    """Some estimators, each with its gate, in one case of a run; frames once they track."""
    acquisition = Acquisition()
    loops: dict[str, Loop] = {}
    case = case_of(kind, distance_m)
    frames = []
    for moment in moments(seed, [kind], [distance_m], _FILM_MARGIN_M):
        turn = moment.pictures[case]
        if not loops:
            start = acquisition.start(turn, moment.craft_m, SITUATION.period_s)
            if start is not None:
                every = estimators()
                loops = {
                    name: Loop(every[name], gate_m).begin(start) for name, gate_m in gates_m.items()
                }
            continue
        for loop in loops.values():
            loop.take(turn, SITUATION.period_s)
        centers_m = {name: loop.predicted_m[-1] for name, loop in loops.items()}
        frames.append(Frame(turn, moment.craft_m, moment.others_m[case], centers_m))
    return frames


class Shares:
    """Shares of the runs, given by seed, that end in each way, by case, estimator and gate."""

    def __init__(self, runs: Mapping[int, Mapping[Of, Ending]]) -> None:
        self.seeds, self.runs = list(runs), list(runs.values())

    def __bool__(self) -> bool:
        return bool(self.runs)

    @property
    def cases(self) -> list[str]:
        return list(dict.fromkeys(case for run in self.runs for case, _, _ in run))

    def share(self, case: str, name: str, gate_m: float, how: Ending) -> float:
        return float(np.mean([run[case, name, gate_m] == how for run in self.runs]))

    def curve(self, case: str, name: str, how: Ending) -> np.ndarray:
        """(G,) share over the gates."""
        return np.array([self.share(case, name, gate_m, how) for gate_m in GATES_M])

    def needed_gate_m(self, name: str) -> float:
        """The narrowest gate that loses a lone craft in at most 3 % of the runs.

        If there is none, the gate that loses it least often.
        """
        lost = self.curve(ALONE, name, Ending.LOST)
        return GATES_M[int(np.argmin(np.maximum(lost, ALLOWED_LOSS)))]
