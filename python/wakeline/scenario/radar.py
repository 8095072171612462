"""A simulated radar: noise, missed detections, clutter, and a rotating antenna."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from wakeline._checks import (
    finite,
    fraction,
    not_negative,
    number_fields,
    plain_numbers,
    positive,
    whole_number,
)
from wakeline.recording import Episode, OwnShipMotion, Recording, Scan, TargetTruth

from .truth import Truth

_TURN_RAD = 2.0 * np.pi
_SWEEP_STEPS = 20


@dataclass(frozen=True)
class RadarSimulator:
    """A radar that reports range and bearing, clockwise from north.

    Attributes
    ----------
    range_std_m, bearing_std_rad : float
        Standard deviations of the independent Gaussian errors.
    period_s : float
        Time from scan to scan.
    detection_probability : float
        Probability that a look at a target in range gives a plot.
    clutter_per_scan : float
        Mean number of false plots per scan (Poisson), uniform over the disc in range.
    max_range_m : float
        Maximum range; must be finite with clutter.
    rotating : bool
        True: the antenna points north when a scan begins and turns clockwise once in `period_s`;
        a plot has the time at which the antenna points at it. A scan is one revolution. It contains
        no look at a target that crosses north ahead of the antenna, and two at a target that
        crosses north towards it. False: all plots of a scan have the time of the scan.

    Raises
    ------
    ValueError
        When a value is invalid.
    """

    range_std_m: float
    bearing_std_rad: float
    period_s: float
    detection_probability: float = 1.0
    clutter_per_scan: float = 0.0
    max_range_m: float = np.inf
    rotating: bool = False

    def __post_init__(self) -> None:
        plain_numbers(max_range_m=self.max_range_m)
        not_negative(**number_fields(self, "range_std_m", "bearing_std_rad", "clutter_per_scan"))
        positive(period_s=self.period_s)
        fraction(detection_probability=self.detection_probability)
        if not self.max_range_m > 0 or (self.clutter_per_scan and np.isinf(self.max_range_m)):
            raise ValueError(
                f"max_range_m must be positive, and finite for clutter, got {self.max_range_m}"
            )

    def observe(
        self,
        truth: Truth,
        scans: int,
        rng: np.random.Generator | int,
        *,
        own: Truth | None = None,
        start_time_s: float | None = None,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Plots of one target, in the form that estimators take.

        Parameters
        ----------
        truth : Truth
            The target.
        scans : int
            Number of scans, T.
        rng : numpy.random.Generator or int
            Random generator, or its seed.
        own : Truth, optional
            Own ship; default at rest at north 0, east 0.
        start_time_s : float, optional
            Time at which the first scan begins; default the start of the truth, or 0 for a truth
            without one.

        Returns
        -------
        time_s : ndarray (T,)
            Time at which the antenna points at the target: the later one in a scan with two looks,
            the middle of a scan without a look.
        z : ndarray (T, 2)
            Range in metres and bearing in [-pi, pi]; NaN rows without a detection or a look.

        Raises
        ------
        ValueError
            When scans is negative or not an integer.
        """
        rng = np.random.default_rng(rng)
        own = _at_rest() if own is None else own
        begin_s = self._begins(scans, start_of(truth) if start_time_s is None else start_time_s)
        return self._rows(truth, own, begin_s, self._looks(truth, own, begin_s), rng)

    def readings(self, exact: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """Add errors and missed detections to exact ranges and bearings.

        Near the antenna a range may become negative, and a bearing may leave [-pi, pi].

        Parameters
        ----------
        exact : ndarray (T, 2)
            Range in metres and bearing in radians.
        rng : numpy.random.Generator
            Random generator.

        Returns
        -------
        ndarray (T, 2)
            NaN rows where the target is not detected or out of range.
        """
        z = exact + rng.standard_normal(exact.shape) * [self.range_std_m, self.bearing_std_rad]
        missed = rng.random(len(exact)) >= self.detection_probability
        z[missed | (exact[:, 0] > self.max_range_m)] = np.nan
        return z

    def record(
        self,
        truths: Mapping[str, Truth],
        scans: int,
        rng: np.random.Generator | int,
        *,
        own: Truth | None = None,
        start_time_s: float | None = None,
        name: str = "simulated",
    ) -> Recording:
        """A recording of several targets and clutter, with truth.

        Parameters
        ----------
        truths : mapping of str to Truth
            The targets by name.
        scans, rng, own
            As for :meth:`observe`.
        start_time_s : float, optional
            Time at which the first scan begins; default the latest start of the truths.
        name : str
            Name of the recording.

        Returns
        -------
        Recording
            One episode. The time of a scan is its start, or its end for a rotating antenna; truth
            is given at those times, with velocities. A look belongs to the scan of its revolution.

        Raises
        ------
        ValueError
            As :meth:`observe`.
        """
        rng = np.random.default_rng(rng)
        own = _at_rest() if own is None else own
        if start_time_s is None:
            start_time_s = max(map(start_of, truths.values()), default=0.0)
        begin_s = self._begins(scans, start_time_s)
        scan_time_s = begin_s + (self.period_s if self.rotating else 0.0)
        looks = [(truth, self._looks(truth, own, begin_s)) for truth in truths.values()]
        rows = [self._rows(truth, own, begin_s, look, rng) for truth, look in looks]
        clutter = [self._clutter(begin, rng) for begin in begin_s]
        earlier = [self._earlier(truth, own, look, rng) for truth, look in looks]

        def own_position_m(time_s: np.ndarray) -> np.ndarray:
            return own.state_at(time_s)[:, 0::2]

        found = []
        for k in range(scans):
            plots = [
                *((time_s[k : k + 1], z[k : k + 1]) for time_s, z in rows),
                clutter[k],
                *((time_s[scan == k], z[scan == k]) for scan, time_s, z in earlier),
            ]
            time_s, z = (np.concatenate(parts) for parts in zip(*plots, strict=True))
            seen = np.isfinite(z[:, 0])
            found.append(
                Scan.of_plots(float(scan_time_s[k]), k, time_s[seen], *z[seen].T, own_position_m)
            )
        own_s = scan_time_s if scans else np.array([float(start_time_s)])
        own_state = own.state_at(own_s)
        ship = OwnShipMotion(
            time_s=own_s,
            north_m=own_state[:, 0],
            east_m=own_state[:, 2],
            vnorth_mps=own_state[:, 1],
            veast_mps=own_state[:, 3],
        )
        known = {key: _sampled(truth, scan_time_s) for key, truth in truths.items()}
        return Recording(name, [Episode("", found, ship, known)])

    def _begins(self, scans: int, start_time_s: float) -> np.ndarray:
        """Times (T,) at which the scans begin."""
        whole_number("scans", scans, 0)
        finite(start_time_s=start_time_s)
        return start_time_s + self.period_s * np.arange(scans)

    def _plots(
        self, truth: Truth, own: Truth, time_s: np.ndarray, rng: np.random.Generator
    ) -> np.ndarray:
        """Range and bearing (n, 2) of looks at the target, NaN rows where it is not detected."""
        exact = polar(truth.state_at(time_s) - own.state_at(time_s))
        return _proper(self.readings(exact, rng))

    def _looks(
        self, truth: Truth, own: Truth, begin_s: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Scan (L,) and time (L,) of every look at the target, in order of time.

        A revolution has one look, none where the target crosses north clockwise in it, and two
        where it crosses anticlockwise: the next after its start and the last before its end.
        """
        scans = np.arange(len(begin_s))
        if not self.rotating:
            return scans, begin_s
        edge_s = np.append(begin_s, begin_s[-1:] + self.period_s)
        bearing_rad = _bearing_at(truth, own, edge_s)
        ahead_rad = bearing_rad % _TURN_RAD
        turns = np.round((np.unwrap(bearing_rad) - ahead_rad) / _TURN_RAD)
        looks = 1 - np.diff(turns).astype(int)
        twice = looks > 1
        first_s = self._pointing_s(truth, own, begin_s, ahead_rad[:-1])
        last_s = self._pointing_s(truth, own, edge_s[1:][twice], ahead_rad[1:][twice] - _TURN_RAD)
        scan, time_s = np.repeat(scans, looks), np.repeat(first_s, looks)
        time_s[np.cumsum(looks)[twice] - 1] = last_s
        return scan, time_s

    def _pointing_s(
        self, truth: Truth, own: Truth, north_s: np.ndarray, bearing_rad: np.ndarray
    ) -> np.ndarray:
        """Times (n,) at which the antenna, at north at `north_s`, points at the target.

        Solves ``time = north + period * bearing(time) / turn`` from a bearing (n,) nearby by fixed
        point; it contracts as long as the target's bearing changes slower than the antenna turns.
        """
        for _ in range(_SWEEP_STEPS):
            time_s = north_s + self.period_s * bearing_rad / _TURN_RAD
            bearing_rad = bearing_rad + _wrapped(_bearing_at(truth, own, time_s) - bearing_rad)
        return north_s + self.period_s * bearing_rad / _TURN_RAD

    def _rows(
        self,
        truth: Truth,
        own: Truth,
        begin_s: np.ndarray,
        looks: tuple[np.ndarray, np.ndarray],
        rng: np.random.Generator,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Time (T,) and plot (T, 2) of the last look of each scan, as `observe` has them."""
        scan, look_s = looks
        time_s = begin_s + 0.5 * self.period_s
        time_s[scan] = look_s
        z = self._plots(truth, own, time_s, rng)
        z[np.setdiff1d(np.arange(len(begin_s)), scan)] = np.nan
        return time_s, z

    def _earlier(
        self,
        truth: Truth,
        own: Truth,
        looks: tuple[np.ndarray, np.ndarray],
        rng: np.random.Generator,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Scan (n,), time (n,) and plot (n, 2) of the looks that `observe` leaves out."""
        scan, time_s = looks
        earlier = np.flatnonzero(np.diff(scan) == 0)
        time_s = time_s[earlier]
        return scan[earlier], time_s, self._plots(truth, own, time_s, rng)

    def _clutter(self, begin_s: float, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
        """Times (n,) and plots (n, 2) of false plots, uniform over the disc."""
        if self.clutter_per_scan == 0:
            return np.zeros(0), np.zeros((0, 2))
        count = rng.poisson(self.clutter_per_scan)
        range_m = self.max_range_m * np.sqrt(rng.random(count))
        z = np.column_stack([range_m, rng.uniform(-np.pi, np.pi, count)])
        time_s = np.full(count, begin_s)
        if self.rotating:
            time_s += self.period_s * (z[:, 1] % _TURN_RAD) / _TURN_RAD
        return time_s, z


def _at_rest() -> Truth:
    return Truth([0.0, 0.0, 0.0, 0.0])


def start_of(truth: Any) -> float:
    """Time at which a truth begins, 0 for one without a start time."""
    return float(getattr(truth, "start_time_s", 0.0))


def _bearing_at(truth: Truth, own: Truth, time_s: np.ndarray) -> np.ndarray:
    return polar(truth.state_at(time_s) - own.state_at(time_s))[:, 1]


def polar(states: np.ndarray) -> np.ndarray:
    """Range and bearing (n, 2), in metres and radians, of states (n, 4) relative to the antenna."""
    north_m, _, east_m, _ = states.T
    return np.column_stack([np.hypot(north_m, east_m), np.arctan2(east_m, north_m)])


def _wrapped(angle_rad: np.ndarray) -> np.ndarray:
    """Angles in [-pi, pi)."""
    return (angle_rad + np.pi) % _TURN_RAD - np.pi


def _proper(z: np.ndarray) -> np.ndarray:
    """Range-bearing pairs (n, 2) of the same positions with non-negative range."""
    behind = z[:, 0] < 0
    return np.column_stack([np.abs(z[:, 0]), _wrapped(z[:, 1] + np.pi * behind)])


def _sampled(truth: Truth, time_s: np.ndarray) -> TargetTruth:
    north_m, vnorth_mps, east_m, veast_mps = truth.state_at(time_s).T
    return TargetTruth(time_s, north_m, east_m, vnorth_mps, veast_mps)
