"""Results of Monte Carlo runs: curves and figures of every candidate on every scenario."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from wakeline import metrics
from wakeline._brief import brief, many
from wakeline.scenario import Scenario

from . import archive
from .sums import Sums

_STATES, _MEASUREMENTS = 4, 2


@dataclass(frozen=True)
class Outcome:
    """Results of one candidate on one scenario. Curves are over the T plots.

    Attributes
    ----------
    scenario, candidate : str
        Names.
    time_s : ndarray (T,)
    switch_times_s : ndarray (S,)
        Times at which the true turn rate switches.
    true_turn_rate_rad_s : ndarray (T,)
        In force before each plot.
    runs : int
        Runs in the curves.
    failed_runs : int
        Excluded runs: they could not start, or their estimates are not finite.
    lost_runs : int
        Runs whose last position is too far off; the curves include them.
    failed_steps : int
        Steps that an estimator reported as failed, over all runs.
    position_rmse_m, velocity_rmse_mps : ndarray (T,)
        Root mean square over the runs of the distance to the true position and velocity.
    nees : ndarray (T,)
        Mean over the runs, of 4 states; NaN where a covariance is not positive definite.
    nees_inside_share : ndarray (T,)
        Share of the runs whose individual NEES is within the 95 % bounds of one value.
    nis, nis_count : ndarray (T,)
        Mean over the runs with a plot, and their number; NaN without any.
    mode_probability : ndarray (T, K) or None
        Mean over the runs.
    turn_rate_rad_s : ndarray (T,) or None
        Estimate, mean over the runs.
    right_mode_share : ndarray (T,) or None
        Share of the runs whose most probable model is the active one nearest to the true turn rate.
    cpu_s : float
        CPU time of the estimator over the runs in the curves, in the calling threads; complete only
        after ``wakeline.set_threads(1)``.
    estimator : str or None
        The repr of the candidate's estimator with all of its parameters, such as
        ``Imm(filters=[Ekf(motion=...), ...], chain=..., initial_mode_probability=[...])``; of
        other estimators, and candidates that are functions, have their own ``repr``. None in older
        files.
    sensor : str or None
        The same for the sensor; None also if a function chooses it.
    """

    scenario: str
    candidate: str
    time_s: np.ndarray
    switch_times_s: np.ndarray
    true_turn_rate_rad_s: np.ndarray
    runs: int
    failed_runs: int
    lost_runs: int
    failed_steps: int
    position_rmse_m: np.ndarray
    velocity_rmse_mps: np.ndarray
    nees: np.ndarray
    nees_inside_share: np.ndarray
    nis: np.ndarray
    nis_count: np.ndarray
    mode_probability: np.ndarray | None
    turn_rate_rad_s: np.ndarray | None
    right_mode_share: np.ndarray | None
    cpu_s: float
    estimator: str | None = None
    sensor: str | None = None

    def __repr__(self) -> str:
        scans, name = many(len(self.time_s), "scan"), f"{self.candidate} on {self.scenario}"
        return brief(self, many(self.runs, "run"), scans, name=name)

    @classmethod
    def of(
        cls,
        scenario: Scenario,
        candidate: str,
        sums: Sums,
        estimator: str | None = None,
        sensor: str | None = None,
    ) -> Outcome:
        """From the sums over all runs; curves over no run are NaN."""

        def mean(total: np.ndarray | None) -> np.ndarray | None:
            return None if total is None else _divided(total, sums.runs)

        return cls(
            scenario=scenario.name,
            candidate=candidate,
            time_s=scenario.time_s,
            switch_times_s=scenario.switch_times_s,
            true_turn_rate_rad_s=scenario.turn_rates_rad_s,
            runs=sums.runs,
            failed_runs=sums.failed_runs,
            lost_runs=sums.lost_runs,
            failed_steps=sums.failed_steps,
            position_rmse_m=np.sqrt(mean(sums.position_m2)),
            velocity_rmse_mps=np.sqrt(mean(sums.velocity_m2s2)),
            nees=mean(sums.nees),
            nees_inside_share=mean(sums.nees_inside),
            nis=_divided(sums.nis, sums.nis_count),
            nis_count=sums.nis_count,
            mode_probability=mean(sums.mode_probability),
            turn_rate_rad_s=mean(sums.turn_rate_rad_s),
            right_mode_share=mean(sums.right_mode),
            cpu_s=sums.cpu_s,
            estimator=estimator,
            sensor=sensor,
        )

    def summary(self) -> dict[str, float | None]:
        """The figures by name; None where a figure does not apply.

        Returns
        -------
        dict
            ``mean_position_m``, ``peak_position_m``, ``mean_velocity_mps``, ``peak_velocity_mps``:
            mean and maximum over the scans of the RMSE curves. ``settling_s``: mean over the
            switches of :func:`wakeline.metrics.settling_times_s` of the position RMSE.
            ``ns_per_step``: CPU time of a step of the runs in the curves.

            ``nees``: mean over the scans, 4 for a consistent estimator. ``nees_inside_share``:
            share of all runs' scans whose individual NEES is within its 95 % bounds.
            ``mean_nees_inside_share``: share of the scans whose mean over the runs is within the 95
            % bounds of that mean, which are narrow with many runs. The prefix ``steady_`` excludes
            the three scans after each switch. ``nis``, ``mean_nis_inside_share``: the same for the
            innovations; 2 for a consistent estimator.

            ``right_mode_share``, ``detection_delay_scans``: mean over the scans and over the
            switches. ``runs``, ``failed_runs``, ``lost_runs``, ``failed_steps``: counts.
        """
        time_s, switch_s, right = self.time_s, self.switch_times_s, self.right_mode_share
        # The right model at a plot is the one in force half a scan before, at a switch the new one.
        new = np.unique(np.searchsorted(_half_a_scan_before(time_s), switch_s))
        scans = np.arange(len(time_s))
        delays = [] if right is None else metrics.detection_delays_scans(scans, right, new - 0.5)
        settling_s = metrics.settling_times_s(time_s, self.position_rmse_m, switch_s)
        steps = self.runs * len(time_s)
        every = np.ones(len(time_s), dtype=bool)
        return {
            "mean_position_m": _number(np.mean(self.position_rmse_m)),
            "peak_position_m": _number(np.max(self.position_rmse_m)),
            "mean_velocity_mps": _number(np.mean(self.velocity_rmse_mps)),
            "peak_velocity_mps": _number(np.max(self.velocity_rmse_mps)),
            "settling_s": _mean(settling_s) if self.runs else None,
            "ns_per_step": 1e9 * self.cpu_s / steps if steps else None,
            **self._consistency("", every),
            **self._consistency("steady_", metrics.steady_scans(time_s, switch_s)),
            "nis": _mean(self.nis),
            "mean_nis_inside_share": _number(
                metrics.share_inside(self.nis, _MEASUREMENTS, self.nis_count)
            ),
            "right_mode_share": None if right is None else _mean(right),
            "detection_delay_scans": _mean(delays),
            "runs": self.runs,
            "failed_runs": self.failed_runs,
            "lost_runs": self.lost_runs,
            "failed_steps": self.failed_steps,
        }

    def _consistency(self, prefix: str, scans: np.ndarray) -> dict[str, float | None]:
        """Figures of the NEES over some scans."""
        nees, inside = self.nees[scans], self.nees_inside_share[scans]
        return {
            f"{prefix}nees": _number(np.mean(nees)) if len(nees) else None,
            f"{prefix}nees_inside_share": _mean(inside),
            f"{prefix}mean_nees_inside_share": _number(
                metrics.share_inside(nees, _STATES, self.runs)
            ),
        }

    def segments(self, curve: str = "position_rmse_m") -> list[metrics.SegmentFigures]:
        """Mean and peak of a curve in each segment of the truth.

        Parameters
        ----------
        curve : str
            Name of an attribute (T,), such as ``velocity_rmse_mps`` or ``nees``.

        Raises
        ------
        ValueError
            When no curve has that name.
        """
        values = getattr(self, curve, None)
        if not isinstance(values, np.ndarray) or values.shape != self.time_s.shape:
            raise ValueError(f"curve must name a curve (T,) of the outcome, got {curve!r}")
        return metrics.by_segment(self.time_s, values, self.switch_times_s)


@dataclass(frozen=True)
class Result:
    """The outcomes of a Monte Carlo run.

    ``result[scenario, candidate]`` is an :class:`Outcome`.

    Attributes
    ----------
    outcomes : mapping of (str, str) to Outcome
        By names of scenario and candidate, in the given order; some are missing if the run ended
        early.
    runs, seed : int
        As given to :func:`wakeline.montecarlo.run`.
    parameters : mapping
        Other parameters of the figures, besides ``estimator`` and ``sensor`` of each outcome:
        ``chunk_runs``, ``lost_beyond_m``, ``draw_start`` and, in ``scenarios``, the ``parameters``
        of each scenario by name.
    version : str
        Version of Wakeline that made it.
    """

    outcomes: Mapping[tuple[str, str], Outcome] = field(repr=False)
    runs: int
    seed: int
    parameters: Mapping[str, Any] = field(default_factory=dict)
    version: str = field(default_factory=archive.current_version)

    def __repr__(self) -> str:
        counts = many(len(self.scenarios), "scenario"), many(len(self.candidates), "candidate")
        return brief(self, *counts, many(self.runs, "run"), f"seed {self.seed}")

    def __getitem__(self, names: tuple[str, str]) -> Outcome:
        try:
            return self.outcomes[names]
        except KeyError:
            raise KeyError(
                f"no outcome {names!r}; scenarios: {', '.join(self.scenarios)}; "
                f"candidates: {', '.join(self.candidates)}"
            ) from None

    @property
    def scenarios(self) -> list[str]:
        """Names in the order in which they were given."""
        return list(dict.fromkeys(scenario for scenario, _ in self.outcomes))

    @property
    def candidates(self) -> list[str]:
        """Names in the order in which they were given."""
        return list(dict.fromkeys(candidate for _, candidate in self.outcomes))

    def summary(self) -> dict[str, dict[str, dict[str, float | None]]]:
        """Figures by scenario, then candidate: see :meth:`Outcome.summary`."""
        figures: dict[str, dict[str, dict[str, float | None]]] = {}
        for (scenario, candidate), outcome in self.outcomes.items():
            figures.setdefault(scenario, {})[candidate] = outcome.summary()
        return figures

    def merged(
        self, candidate: str, scenarios: Sequence[str] | None = None
    ) -> dict[str, float | None]:
        """Figures of one candidate over several scenarios of the same length.

        The squared errors are averaged over the scenarios plot by plot before taking the root:
        ``mean_...`` and ``peak_...`` are mean and maximum of these curves. The other figures, and
        ``scenario_mean_position_m`` and ``scenario_mean_velocity_mps``, are means of the figures
        of the scenarios; counts are sums.

        Parameters
        ----------
        candidate : str
        scenarios : sequence of str, optional
            Default all.

        Returns
        -------
        dict
            As for :meth:`Outcome.summary`, and the two figures above.

        Raises
        ------
        ValueError
            When there is no scenario or their lengths differ.
        KeyError
            For an unknown name.
        """
        names = self.scenarios if scenarios is None else scenarios
        parts = [self[name, candidate] for name in names]
        lengths = sorted({len(part.time_s) for part in parts})
        if len(lengths) != 1:
            raise ValueError(f"scenarios must have the same number of scans, got {lengths}")
        own = [part.summary() for part in parts]
        figures = {name: _mean_of([one[name] for one in own]) for name in own[0]}
        for name in ("runs", "failed_runs", "lost_runs", "failed_steps"):
            figures[name] = sum(one[name] for one in own)
        for what, unit in (("position", "m"), ("velocity", "mps")):
            curve = np.sqrt(
                np.mean([getattr(part, f"{what}_rmse_{unit}") ** 2 for part in parts], axis=0)
            )
            figures[f"scenario_mean_{what}_{unit}"] = figures[f"mean_{what}_{unit}"]
            figures[f"mean_{what}_{unit}"] = _number(np.mean(curve))
            figures[f"peak_{what}_{unit}"] = _number(np.max(curve))
        return figures

    def save(self, path: str | Path) -> None:
        """Write everything to one NPZ file, which replaces an existing one when complete."""
        archive.save(path, self.outcomes, self.runs, self.seed, self.parameters, self.version)

    @classmethod
    def load(cls, path: str | Path) -> Result:
        """Read a file written by :meth:`save`.

        Raises
        ------
        ValueError
            When the file cannot be read or is not such a file; the message names it.
        """
        return archive.load(path, cls, Outcome)


def _divided(total: np.ndarray, count: int | np.ndarray) -> np.ndarray:
    count = np.broadcast_to(np.asarray(count, dtype=float), total.shape)
    return np.divide(total, count, out=np.full(total.shape, np.nan), where=count > 0)


def _half_a_scan_before(time_s: np.ndarray) -> np.ndarray:
    """Times half a step before the given ones; the first step is as long as the second."""
    step_s = np.diff(time_s)
    return time_s - 0.5 * np.concatenate([step_s[:1], step_s]) if len(step_s) else time_s


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _mean(values: np.ndarray) -> float | None:
    """Mean of the finite ones."""
    values = np.asarray(values)[np.isfinite(values)]
    return float(np.mean(values)) if len(values) else None


def _mean_of(values: Sequence[float | None]) -> float | None:
    return _mean(np.array([value for value in values if value is not None], dtype=float))
