"""Scenes of dense traffic under a rotating radar, with exact truth."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from wakeline.recording import Recording

from .radar import RadarSimulator
from .scenario import AnyTruth
from .track_truth import TrackTruth
from .truth import Segment, Truth

RADAR = RadarSimulator(
    10.0,
    np.deg2rad(0.5),
    2.5,
    detection_probability=0.9,
    clutter_per_scan=50.0,
    max_range_m=6000.0,
    rotating=True,
)
MERGED_M = 40.0

_NEAREST_M = 500.0
_STEP_S = 0.5
_FAR = 1e4  # times farther off is out of range, at the same bearing


@dataclass(frozen=True)
class DenseScene:
    """Vessels that come near each other, or are hidden in clutter.

    Attributes
    ----------
    name : str
    summary : str
    radar : RadarSimulator
    scans : int
    draw : callable
        Draws the truths of a run, by name, from a generator and the scene.
    merged_m : float
        Two successive vessels nearer than this give one plot, at their mean; 0: none do.
    """

    name: str
    summary: str
    radar: RadarSimulator
    scans: int
    draw: Callable[[np.random.Generator, DenseScene], list[AnyTruth]]
    merged_m: float = 0.0

    @property
    def duration_s(self) -> float:
        """Time from the start of the first scan to the end of the last."""
        return self.scans * self.radar.period_s

    def record(self, rng: np.random.Generator | int) -> Recording:
        """Draw a run: plots with their own times, and the truth at the ends of scans."""
        rng = np.random.default_rng(rng)
        truths = {str(k + 1): truth for k, truth in enumerate(self.draw(rng, self))}
        if not self.merged_m:
            return self.radar.record(truths, self.scans, rng, name=self.name)
        known = replace(self.radar, clutter_per_scan=0.0).record(truths, self.scans, 0)
        echoes = {name: echo for name, echo in self._echoes(list(truths.values()))}
        seen = self.radar.record(echoes, self.scans, rng, start_time_s=0.0, name=self.name)
        return replace(seen, episodes=[replace(seen.episodes[0], truth=known.episodes[0].truth)])

    def _echoes(self, truths: list[AnyTruth]) -> Iterator[tuple[str, AnyTruth]]:
        for k, pair in enumerate(zip(truths[::2], truths[1::2], strict=True)):
            for part in ("first", "second", "both"):
                yield f"{k}-{part}", _Echo(*pair, part, self.merged_m)


@dataclass(frozen=True)
class _Echo:
    """One echo of two vessels: out of range while the other echoes are there."""

    first: AnyTruth
    second: AnyTruth
    part: str
    merged_m: float

    def state_at(self, time_s: np.ndarray | float) -> np.ndarray:
        a, b = self.first.state_at(time_s), self.second.state_at(time_s)
        merged = np.hypot(*(a - b)[:, 0::2].T) < self.merged_m
        state = {"first": a, "second": b, "both": (a + b) / 2}[self.part]
        return np.where((merged == (self.part == "both"))[:, np.newaxis], state, _FAR * state)


# Paths --------------------------------------------------------------------------------------------


def _unit(angle_rad: float) -> np.ndarray:
    return np.array([np.cos(angle_rad), np.sin(angle_rad)])


def _straight(place_m: np.ndarray, velocity_mps: np.ndarray, at_s: float = 0.0) -> Truth:
    """A straight course that is at a place at a time."""
    start_m = place_m - at_s * velocity_mps
    return Truth([start_m[0], velocity_mps[0], start_m[1], velocity_mps[1]])


def _places_m(truth: AnyTruth, duration_s: float) -> np.ndarray:
    return truth.state_at(np.arange(0.0, duration_s + _STEP_S, _STEP_S))[:, 0::2]


def _stays(truth: AnyTruth, scene: DenseScene) -> bool:
    """Whether a vessel is always in range, and not at the antenna."""
    range_m = np.hypot(*_places_m(truth, scene.duration_s).T)
    return bool(range_m.min() > _NEAREST_M and range_m.max() < 0.97 * scene.radar.max_range_m)


def _first(draws: Iterator[list[AnyTruth]], scene: DenseScene) -> list[AnyTruth]:
    """The first draw of which all vessels stay in range."""
    return next(found for found in draws if all(_stays(truth, scene) for truth in found))


def _repeated(draw: Callable[[], list[AnyTruth]]) -> Iterator[list[AnyTruth]]:
    while True:
        yield draw()


def _spots(rng: np.random.Generator, count: int, far_m: float, apart_m: float) -> list[np.ndarray]:
    """Places between 1200 m and `far_m` from the antenna, and that far from each other."""
    spots: list[np.ndarray] = []
    while len(spots) < count:
        spot = np.sqrt(rng.uniform(1200.0**2, far_m**2)) * _unit(rng.uniform(0, 2 * np.pi))
        if all(np.hypot(*(spot - other)) > apart_m for other in spots):
            spots.append(spot)
    return spots


def _ships(rng: np.random.Generator, scene: DenseScene) -> list[AnyTruth]:
    """Twenty ships on straight courses at 3 to 12 m/s."""

    def one() -> list[AnyTruth]:
        range_m = scene.radar.max_range_m * np.sqrt(rng.random())
        velocity = rng.uniform(3.0, 12.0) * _unit(rng.uniform(0, 2 * np.pi))
        return [_straight(range_m * _unit(rng.uniform(0, 2 * np.pi)), velocity)]

    return [_first(_repeated(one), scene)[0] for _ in range(20)]


def _crossings(rng: np.random.Generator, scene: DenseScene) -> list[AnyTruth]:
    """Twelve pairs whose courses differ by 5 to 90 degrees and that pass at 30 to 150 m."""
    found: list[AnyTruth] = []
    for spot, angle_deg in zip(
        _spots(rng, 12, 4500.0, 600.0), np.geomspace(5, 90, 12), strict=True
    ):

        def pair(spot: np.ndarray = spot, angle_deg: float = angle_deg) -> list[AnyTruth]:
            course = rng.uniform(0, 2 * np.pi)
            first = rng.uniform(4.0, 9.0) * _unit(course)
            second = rng.uniform(4.0, 9.0) * _unit(course + np.radians(angle_deg))
            relative = second - first
            abeam = np.array([-relative[1], relative[0]]) / np.hypot(*relative)
            at_s = scene.duration_s * rng.uniform(0.35, 0.65)
            passing = spot + rng.choice([-1, 1]) * rng.uniform(30.0, 150.0) * abeam
            return [_straight(spot, first, at_s), _straight(passing, second, at_s)]

        found += _first(_repeated(pair), scene)
    return found


def _abreast(rng: np.random.Generator, scene: DenseScene) -> list[AnyTruth]:
    """Six pairs on parallel courses, two each 25, 50 and 100 m apart."""
    found: list[AnyTruth] = []
    for spot, gap_m in zip(_spots(rng, 6, 3500.0, 900.0), np.repeat([25, 50, 100], 2), strict=True):

        def pair(spot: np.ndarray = spot, gap_m: float = float(gap_m)) -> list[AnyTruth]:
            course = rng.uniform(0, 2 * np.pi)
            velocity = rng.uniform(4.0, 8.0) * _unit(course)
            aside = gap_m * _unit(course + np.pi / 2)
            at_s = scene.duration_s / 2
            return [_straight(spot, velocity, at_s), _straight(spot + aside, velocity, at_s)]

        found += _first(_repeated(pair), scene)
    return found


def _craft(rng: np.random.Generator, scene: DenseScene) -> list[AnyTruth]:
    """Fifteen craft, straight for 10 to 40 s, then turning at 3 to 10 deg/s for 5 to 20 s."""

    def one() -> list[AnyTruth]:
        segments: list[Segment] = []
        left_s = scene.duration_s
        while left_s > 0.0:
            rate_rad_s = np.radians(rng.uniform(3.0, 10.0)) * rng.choice([-1, 1])
            segments.append(Segment(rng.uniform(10.0, 40.0)))
            segments.append(Segment(rng.uniform(5.0, 20.0), turn_rate_rad_s=rate_rad_s))
            left_s -= segments[-1].duration_s + segments[-2].duration_s
        place = np.sqrt(rng.uniform(1000.0**2, 5000.0**2)) * _unit(rng.uniform(0, 2 * np.pi))
        velocity = rng.uniform(10.0, 20.0) * _unit(rng.uniform(0, 2 * np.pi))
        return [Truth([place[0], velocity[0], place[1], velocity[1]], segments)]

    return [_first(_repeated(one), scene)[0] for _ in range(15)]


def _anchorage(rng: np.random.Generator, scene: DenseScene) -> list[AnyTruth]:
    """150 ships that swing at anchor, 150 m or more apart, and 20 movers at 3 to 8 m/s."""
    middle, side_m = 3300.0 * _unit(rng.uniform(0, 2 * np.pi)), 2000.0
    anchors: list[np.ndarray] = []
    while len(anchors) < 150:
        spot = middle + rng.uniform(-side_m, side_m, 2)
        if np.hypot(*spot) > 700.0 and all(np.hypot(*(spot - one)) > 150.0 for one in anchors):
            anchors.append(spot)
    time_s = np.arange(0.0, scene.duration_s + 2 * _STEP_S, _STEP_S)
    found: list[AnyTruth] = []
    for spot in anchors:
        phase = 2 * np.pi * time_s / rng.uniform(300.0, 600.0) + rng.uniform(0, 2 * np.pi)
        heading = rng.uniform(0, 2 * np.pi) + np.radians(15.0) * np.sin(phase)
        found.append(
            TrackTruth(time_s, spot[0] + 30.0 * np.cos(heading), spot[1] + 30.0 * np.sin(heading))
        )
    paths_m = [_places_m(truth, scene.duration_s) for truth in found]
    while len(found) < 170:
        spot = middle + rng.uniform(-side_m, side_m, 2)
        velocity = rng.uniform(3.0, 8.0) * _unit(rng.uniform(0, 2 * np.pi))
        mover = _straight(spot, velocity, scene.duration_s / 2)
        path_m = _places_m(mover, scene.duration_s)
        clear = all(np.hypot(*(path_m - other).T).min() > 60.0 for other in paths_m)
        if clear and _stays(mover, scene):
            found.append(mover)
            paths_m.append(path_m)
    return found


def _meetings(rng: np.random.Generator, scene: DenseScene) -> list[AnyTruth]:
    """Eight pairs that are one echo for 10 to 20 scans: five cross, three run on together."""
    found: list[AnyTruth] = []
    time_s = np.arange(0.0, scene.duration_s + 2 * _STEP_S, _STEP_S)
    after_s = time_s - scene.duration_s / 2
    for k, spot in enumerate(_spots(rng, 8, 3000.0, 700.0)):

        def pair(k: int = k, spot: np.ndarray = spot) -> list[AnyTruth]:
            together_s = scene.radar.period_s * rng.uniform(11.0, 19.0)
            course = rng.uniform(0, 2 * np.pi)
            velocity = rng.uniform(4.0, 7.0) * _unit(course)
            if k < 5:  # the relative course is a straight line past the other one
                nearest_m = rng.uniform(0.0, 15.0)
                way = course + rng.choice([-1, 1]) * rng.uniform(0.3, 2.8)
                along_m = 2.0 * np.sqrt(MERGED_M**2 - nearest_m**2) / together_s * after_s
                apart_m = np.outer(along_m, _unit(way)) + nearest_m * _unit(way + np.pi / 2)
            else:  # the gap falls to 20 m and grows again
                s = np.abs(after_s) / (together_s / 2)
                gap_m = 20.0 + (MERGED_M - 20.0) * np.where(s < 1.0, s**2, 2.0 * s - 1.0)
                apart_m = np.outer(gap_m, _unit(course + np.pi / 2))
            centre_m = spot + np.outer(after_s, velocity)
            return [TrackTruth(time_s, *(centre_m + half * apart_m).T) for half in (-0.5, 0.5)]

        found += _first(_repeated(pair), scene)
    return found


SCENES = {
    scene.name: scene
    for scene in (
        DenseScene(
            "open_sea",
            "20 ships on straight courses, 10 km",
            replace(RADAR, max_range_m=10e3),
            120,
            _ships,
        ),
        DenseScene("crossings", "12 pairs that pass at 30 to 150 m", RADAR, 120, _crossings),
        DenseScene("abreast", "6 pairs side by side, 25 to 100 m", RADAR, 100, _abreast),
        DenseScene(
            "clutter_300",
            "20 ships, 2.7e-6 false plots per m²",
            replace(RADAR, clutter_per_scan=300.0),
            100,
            _ships,
        ),
        DenseScene(
            "clutter_1000",
            "20 ships, 8.8e-6 false plots per m²",
            replace(RADAR, clutter_per_scan=1000.0),
            100,
            _ships,
        ),
        DenseScene(
            "craft",
            "15 craft that turn at 3 to 10 deg/s",
            replace(RADAR, clutter_per_scan=100.0),
            120,
            _craft,
        ),
        DenseScene(
            "anchorage",
            "150 ships at anchor and 20 movers",
            replace(RADAR, clutter_per_scan=100.0),
            100,
            _anchorage,
        ),
        DenseScene(
            "merged", "8 pairs that are one echo for a while", RADAR, 120, _meetings, MERGED_M
        ),
        DenseScene(
            "seldom",
            "20 ships seen in every other scan, 10 km",
            replace(RADAR, max_range_m=10e3, detection_probability=0.5),
            120,
            _ships,
        ),
    )
}
