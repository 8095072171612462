"""A scenario: one truth, the radar that observes it, and an estimator's prior."""

from __future__ import annotations

import hashlib
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np

from wakeline import core, measurement
from wakeline._checks import entropy, finite, number_fields, positive, real_numbers, whole_number

from .radar import RadarSimulator, polar, start_of
from .truth import Truth


@runtime_checkable
class AnyTruth(Protocol):
    """What a scenario needs of a truth: :class:`Truth`, :class:`TrackTruth` or a custom one."""

    def state_at(self, time_s: np.ndarray | float) -> np.ndarray:
        """States (T, 4), ``[north, vnorth, east, veast]``."""

    def turn_rate_at(self, time_s: np.ndarray | float) -> np.ndarray:
        """Turn rates (T,), rad/s, positive to starboard."""


@dataclass(frozen=True)
class Scenario:
    """One target, a radar at north 0, east 0, and an estimator's prior.

    The first plot is one period after the start.

    Attributes
    ----------
    name : str
        Names the results, and is part of the seed of the plots.
    truth : Truth
        Or anything with ``state_at`` and ``turn_rate_at``.
    radar : RadarSimulator
        Without clutter and not rotating: every scan is one plot at its time.
    scans : int
        Number of plots, T.
    position_std_m, velocity_std_mps : float
        Standard deviations of the prior, per axis; positive.
    start_time_s : float, optional
        Start time; default that of the truth, 0 for a truth without one.

    Raises
    ------
    ValueError
        When a value is invalid.
    TypeError
        When the truth has no `state_at` or `turn_rate_at`.
    """

    name: str
    truth: AnyTruth
    radar: RadarSimulator
    scans: int
    position_std_m: float = 10.0
    velocity_std_mps: float = 1.0
    start_time_s: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name:
            raise ValueError(f"name must be a non-empty string, got {self.name!r}")
        if not isinstance(self.truth, AnyTruth):
            raise TypeError(f"truth must have state_at and turn_rate_at, got {self.truth!r}")
        if not isinstance(self.radar, RadarSimulator):
            raise TypeError(f"radar must be a RadarSimulator, got {self.radar!r}")
        whole_number("scans", self.scans, 1)
        positive(**number_fields(self, "position_std_m", "velocity_std_mps"))
        if self.start_time_s is None:
            object.__setattr__(self, "start_time_s", start_of(self.truth))
        finite(start_time_s=self.start_time_s)
        if self.radar.rotating or self.radar.clutter_per_scan:
            raise ValueError("radar must not rotate nor have clutter: a scan is one reading here")

    @property
    def time_s(self) -> np.ndarray:
        """Times (T,) of the readings."""
        return self.start_time_s + self.radar.period_s * np.arange(1, self.scans + 1)

    @property
    def truth_states(self) -> np.ndarray:
        """True states (T, 4) at the readings, ``[north, vnorth, east, veast]``."""
        return self.truth.state_at(self.time_s)

    @property
    def turn_rates_rad_s(self) -> np.ndarray:
        """Turn rates (T,): at each reading the one in force half a period before it.

        Where the rate does not switch within a scan that is the rate of the whole interval that
        ends at the reading.
        """
        return self.truth.turn_rate_at(self.time_s - 0.5 * self.radar.period_s)

    @property
    def control_mps2(self) -> np.ndarray:
        """Known accelerations (T, 2), north and east, in force half a period before each reading.

        Zeros for a truth without ``control_at``, such as a recorded track.
        """
        return self.control_at(self.time_s - 0.5 * self.radar.period_s)

    def control_at(self, time_s: np.ndarray) -> np.ndarray:
        """Known accelerations (n, 2), north and east, at times (n,)."""
        control_at = getattr(self.truth, "control_at", None)
        return np.zeros((len(time_s), 2)) if control_at is None else control_at(time_s)

    @property
    def switch_times_s(self) -> np.ndarray:
        """Times (S,) after the start and before the last reading at which the turn rate switches.

        Empty for a truth without ``switch_times_s``, such as a recorded track.
        """
        return self._within("switch_times_s")

    @property
    def control_switch_times_s(self) -> np.ndarray:
        """Times (S,) after the start and before the last reading at which the control changes.

        Empty for a truth without ``control_switch_times_s``.
        """
        return self._within("control_switch_times_s")

    def _within(self, name: str) -> np.ndarray:
        """Those of the truth's times of that name after the start and before the last reading."""
        time_s = real_numbers(name, getattr(self.truth, name, ()))
        return time_s[(time_s > self.start_time_s) & (time_s < self.time_s[-1])]

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters of radar, scenario and truth by name; results are stored with them.

        ``truth`` holds the `parameters` of a :class:`Truth`; of another truth its type and a digest
        of :attr:`truth_states`.
        """
        own = ("scans", "position_std_m", "velocity_std_mps", "start_time_s")
        numbers = asdict(self.radar) | {name: getattr(self, name) for name in own}
        if isinstance(self.truth, Truth):
            truth = self.truth.parameters
        else:
            truth = {
                "type": type(self.truth).__name__,
                "states_sha256": hashlib.sha256(self.truth_states.tobytes()).hexdigest(),
            }
        return {name: float(value) for name, value in numbers.items()} | {"truth": truth}

    @property
    def start(self) -> core.Gaussian:
        """The initial belief: the true state and the prior's covariance."""
        position_m2, velocity_m2s2 = self.position_std_m**2, self.velocity_std_mps**2
        return core.Gaussian(
            self.truth.state_at(self.start_time_s)[0],
            np.diag([position_m2, velocity_m2s2, position_m2, velocity_m2s2]),
        )

    def draw(self, runs: int, seed: int | Sequence[int] = 0, *, first_run: int = 0) -> np.ndarray:
        """Plots of independent runs: the true range and bearing plus Gaussian errors.

        The errors are added as in the papers, without wrapping: see
        :meth:`RadarSimulator.readings`.

        Parameters
        ----------
        runs : int
            Number of runs, R.
        seed : int or sequence of int
            Not negative. The errors of run r depend on the scenario's name, but not on R.
        first_run : int
            Number of the first run.

        Returns
        -------
        ndarray (R, T, 2)
            Range in metres and bearing in radians; NaN rows where the target is not detected or out
            of range.

        Raises
        ------
        ValueError
            When runs, first_run or a seed is negative or not an integer.
        """
        chances = self._chances(runs, seed, first_run)
        exact = polar(self.truth_states)
        z = np.empty((runs, self.scans, 2))
        for run, rng in enumerate(chances):
            z[run] = self.radar.readings(exact, rng)
        return z

    def draw_starts(
        self, runs: int, seed: int | Sequence[int] = 0, *, first_run: int = 0
    ) -> list[core.Gaussian]:
        """Initial beliefs of independent runs: :attr:`start` with a mean drawn from it.

        Parameters
        ----------
        runs, seed, first_run
            As for :meth:`draw`; the draws are independent of the plots.

        Returns
        -------
        list of R Gaussian

        Raises
        ------
        ValueError
            As for :meth:`draw`.
        """
        exact = self.start
        std = np.sqrt(np.diag(exact.covariance))
        return [
            core.Gaussian(exact.mean + std * rng.standard_normal(4), exact.covariance)
            for rng in self._chances(runs, seed, first_run, zlib.crc32(b"start"))
        ]

    def _chances(
        self, runs: int, seed: int | Sequence[int], first_run: int, *purpose: int
    ) -> Iterator[np.random.Generator]:
        """Random generator of each run."""
        whole_number("runs", runs, 0)
        whole_number("first_run", first_run, 0)
        begin = entropy(seed, self.name)
        return (np.random.default_rng([*begin, first_run + run, *purpose]) for run in range(runs))

    @property
    def polar_sensor(self) -> measurement.RangeBearing:
        """The radar as the sensor of an Ekf or Ukf: range and bearing."""
        return measurement.RangeBearing(
            range_std_m=self.radar.range_std_m, bearing_std_rad=self.radar.bearing_std_rad
        )

    @property
    def converted_sensor(self) -> measurement.ConvertedRangeBearing:
        """The radar with plots converted to north and east, as in the papers (not unbiased)."""
        return measurement.ConvertedRangeBearing(
            range_std_m=self.radar.range_std_m,
            bearing_std_rad=self.radar.bearing_std_rad,
            unbiased=False,
        )
