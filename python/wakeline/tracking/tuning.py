"""Settings of a radar and its vessels by maximum likelihood, from plots alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

import wakeline as wl
from wakeline._brief import brief, many
from wakeline._progress import progress
from wakeline.recording import OwnShipMotion, Recording

from .settings import Settings
from .track_plots import TrackPlots, plot_sensor
from .tracked import (
    TrackedEpisode,
    has_names,
    median_step_s,
    opened_with_settings,
    track_episode,
)

_ROUNDS = 6
_PASSES = 2  # in which outliers are found
_OWN_PLOTS = 0.9999  # share of a track's plots inside the gate about its estimate
_LEAST_PLOTS = 50
_LEAST_RUN = 10  # plots of a track
_MOVED = 3.0  # standard deviations of its first position that a track moves
_LARGEST_STD = 0.35  # of the logarithm of a parameter that the plots determine
_STEP = 0.3  # of numerical derivatives, in logarithms; the likelihood is rough on a finer scale
_LARGEST_STEP = 0.7
_STEPS = 25
_ENOUGH = 0.02  # of the log-likelihood
_PRIOR_STD = 1.0  # of the logarithm of a parameter, about its given value
_LEAST_SHARE = 1e-4  # of outliers
_IMPOSSIBLE = -1e12
_MARGIN = 0.02  # of the logarithm of a limit
_WIDER = 1.5  # errors to track with, over those found
_SAME = 1.05  # factor on an error that does not matter for the tracks

# By the key of settings: limits of a search.
_LIMITS = {
    "range_std_m": (0.05, 2000.0),
    "bearing_std_deg": (0.005, 20.0),
    "extent_std_m": (0.05, 500.0),
    "noise_scale": (0.2, 5.0),
}
_RADAR = ("range_std_m", "bearing_std_deg", "extent_std_m")


@dataclass(frozen=True)
class TunedParameter:
    """One parameter by maximum likelihood.

    Attributes
    ----------
    name : str
        As in a file of settings; ``noise_scale`` is the factor on the acceleration and course noise
        of all motion models.
    before, value, std : float
        Given value, most likely value and its standard deviation; NaN where there is none.
    determined : bool
        Whether the plots determine it.
    verdict : str
        Why they do not. The value is then the given one, or belongs to that of another parameter.
    """

    name: str
    before: float
    value: float
    std: float
    determined: bool
    verdict: str = ""


@dataclass(frozen=True)
class Tuning:
    """Settings found by :func:`tune`.

    Attributes
    ----------
    parameters : list of TunedParameter
        ``range_std_m``, ``bearing_std_deg``, ``extent_std_m``, ``noise_scale`` and
        ``detection_probability``.
    settings : Settings
        The given settings with these values.
    tracks, plots : int
        Tracks and plots that were used.
    nis_before, nis_after : float
        Mean normalized innovation squared of the plots that are no outliers, with the given and
        with the tuned settings; 2 where the settings are right.
    nis_bounds : (float, float)
        95 % bounds of the mean of so many plots with right settings.
    """

    parameters: list[TunedParameter]
    settings: Settings
    tracks: int
    plots: int
    nis_before: float
    nis_after: float
    nis_bounds: tuple[float, float]

    def __getitem__(self, name: str) -> TunedParameter:
        """A parameter by name."""
        for parameter in self.parameters:
            if parameter.name == name:
                return parameter
        raise KeyError(name)

    def __repr__(self) -> str:
        found = [f"{p.name} {p.value:.3g}" for p in self.parameters if p.determined]
        return brief(self, many(self.tracks, "track"), many(self.plots, "plot"), *found)


def tune(
    recording: Recording | str | Path,
    *,
    radar: wl.Radar | str | Path | None = None,
    vessels: wl.VesselModels | str | None = None,
    own: OwnShipMotion | str | Path | None = None,
    config: Settings | wl.TrackerConfig | str | Path | None = None,
    azimuth: str = "north",
) -> Tuning:
    """Find errors of the radar, noise of the motion models and detection from plots alone.

    The recording is tracked, with gates so wide that no plot is left out for its error. Errors and
    noise then maximize the likelihood of the innovations of the tracker's estimator over the plots
    of each track, of which a share are outliers (`outlier_probability` and `outlier_scale` of the
    tracker). The detection probability maximizes the likelihood of the scans with and without a
    plot of a track, where vessels are hidden for times as in the settings. Only tracks that move
    count: echoes of quays and of anchored vessels have other errors. Errors are those of plots that
    are no outliers; where there are none, give `outlier_probability` 0, else they are too small.

    A weak prior (a factor of e about the given value) keeps what the plots do not determine near
    where it was. Standard deviations are those of the observed information. A parameter is
    determined if its own is less than 35 % of its value.

    Parameters
    ----------
    recording, radar, vessels, own, config, azimuth
        As of :func:`track_recording`; what the recording knows of its radar is the start, too.

    Returns
    -------
    Tuning

    Raises
    ------
    ValueError
        When the tracks have too few plots.
    RecordingError, SettingsError
        As of :func:`track_recording`.

    Examples
    --------
    >>> import wakeline as wl
    >>> tuned = wl.tune("joyride", radar=wl.Radar())
    >>> tuned["range_std_m"].determined
    True
    >>> tracks = wl.track_recording("joyride", config=tuned.settings)
    """
    opened, given = opened_with_settings(recording, radar, vessels, own, config, azimuth)
    state, widest = _State(given), given
    for _ in progress(range(_ROUNDS), _ROUNDS, "tuning"):
        episodes = list(_tracked(opened, widest))
        runs = [run for one in episodes for run in _runs_of(one, widest)]
        plots = sum(len(run.plots) for run in runs)
        if plots < _LEAST_PLOTS:
            raise ValueError(
                f"{opened.name}: moving tracks have {many(plots, 'plot')}, too few to tune from; "
                f"wanted {_LEAST_PLOTS}, of tracks with {_LEAST_RUN} each"
            )
        state = _fitted(state, runs).with_detection(episodes)
        before, widest = widest, _wider(widest, state)
        if widest == before:
            break
    bounds = wl.consistency_bounds(0.95, 2, plots)
    return Tuning(
        parameters=state.parameters(given),
        settings=state.settings,
        tracks=len(runs),
        plots=plots,
        nis_before=_read(given, runs).mean_nis,
        nis_after=_read(state.settings, runs).mean_nis,
        nis_bounds=(float(bounds[0]), float(bounds[1])),
    )


# Tracks -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Run:
    """The plots of a track, which of them the estimator uses, and its first row as the start."""

    plots: TrackPlots
    dt_s: np.ndarray
    start: wl.Gaussian
    used: np.ndarray

    @property
    def readings(self) -> np.ndarray:
        """A missing reading and the plot, at the time of each plot."""
        readings = np.full((2 * len(self.plots), 2), np.nan)
        readings[1::2] = np.where(self.used[:, np.newaxis], self.plots.range_bearing, np.nan)
        return readings

    @property
    def steps_s(self) -> np.ndarray:
        """Before each reading."""
        return np.column_stack([self.dt_s, np.zeros_like(self.dt_s)]).ravel()

    def without(self, outlier: np.ndarray) -> _Run:
        """The run without using the plots that are outliers with these probabilities."""
        return replace(self, used=outlier < 0.5)


def _tracked(recording: Recording, settings: Settings) -> Iterator[TrackedEpisode]:
    for episode in recording:
        yield track_episode(episode, settings, named=has_names(recording))


def _runs_of(tracked: TrackedEpisode, settings: Settings) -> Iterator[_Run]:
    radar = settings.make_radar(median_step_s(tracked.episode))
    every = TrackPlots.of(tracked)
    for track in tracked.tracks:
        plots = every[track.track_id[0]].near(track, radar, _OWN_PLOTS)
        moved_m = np.hypot(*(track.state[-1] - track.state[0])[0::2])
        std_m = math.sqrt(np.trace(track.covariance[0, 0::2, 0::2]))
        if len(plots) >= _LEAST_RUN and moved_m > _MOVED * std_m:
            dt_s = np.diff(plots.time_s, prepend=track.time_s[0])
            start = wl.Gaussian(track.state[0], track.covariance[0])
            yield _Run(plots, dt_s, start, np.ones(len(plots), dtype=bool))


def _wider(settings: Settings, state: _State) -> Settings:
    """Settings to track with, whose errors are at least half as large again as those found.

    Gates are then wide enough that the largest errors are not left out. Errors never become
    smaller, as each round would leave out more of them.
    """
    errors = {name: _WIDER * state.value(name) for name in _RADAR}
    wider = {k: v for k, v in errors.items() if v > _SAME * float(settings.radar[k])}
    return replace(settings, radar=settings.radar | wider)


# Errors and noise ---------------------------------------------------------------------------------


@dataclass(frozen=True)
class _State:
    """Settings in a search, and what is known of each parameter."""

    given: Settings
    values: dict[str, float] = field(default_factory=dict)
    std: dict[str, float] = field(default_factory=dict)
    verdicts: dict[str, str] = field(default_factory=dict)

    def value(self, name: str) -> float:
        """Of a parameter, as found or as given."""
        return self.values.get(name, _given(self.given, name))

    @property
    def settings(self) -> Settings:
        """The given settings with what was found."""
        found = {name: float(f"{value:.4g}") for name, value in self.values.items()}
        scale = found.get("noise_scale", 1.0)
        models = {
            key: float(f"{scale * value:.4g}") if _is_noise(key) else value
            for key, value in self.given.models.items()
        }
        return replace(
            self.given,
            radar=self.given.radar | {k: v for k, v in found.items() if k in _RADAR},
            tracker=self.given.tracker
            | {k: v for k, v in found.items() if k in self.given.tracker},
            models=models if scale != 1.0 else self.given.models,
        )

    def with_detection(self, episodes: Sequence[TrackedEpisode]) -> _State:
        """With the detection probability of tracks."""
        name = "detection_probability"
        seen = [hits for one in episodes for hits in _hits_of(one)]
        steps_s = [step for one in episodes if (step := median_step_s(one.episode))]
        if not seen or not steps_s:
            return self._without(name, "no track has two plots")
        step_s = float(np.median(steps_s))
        value, std = _detection(seen, step_s, self.given.tracker)
        if not std < _LARGEST_STD * value:
            return self._without(name, "too few scans")
        return replace(self, values=self.values | {name: value}, std=self.std | {name: std})

    def _without(self, name: str, verdict: str) -> _State:
        return replace(
            self,
            values={k: v for k, v in self.values.items() if k != name},
            verdicts=self.verdicts | {name: verdict},
        )

    def parameters(self, given: Settings) -> list[TunedParameter]:
        """All of them, in order."""
        return [
            TunedParameter(
                name,
                before=_given(given, name),
                value=self.value(name),
                std=self.std.get(name, math.nan),
                determined=name in self.values and name not in self.verdicts,
                verdict=self.verdicts.get(name, ""),
            )
            for name in (*_LIMITS, "detection_probability")
        ]


def _given(settings: Settings, name: str) -> float:
    if name == "noise_scale":
        return 1.0
    return float((settings.radar if name in _RADAR else settings.tracker)[name])


def _is_noise(key: str) -> bool:
    return key.endswith(("_psd_m2s3", "_course_psd_rad2s"))


def _fitted(state: _State, runs: Sequence[_Run]) -> _State:
    """The most likely errors and noise with a weak prior about the given values.

    The prior keeps what the plots do not determine near its given value, also where they determine
    two parameters only together. A parameter that is given as 0, or that would go to its limit,
    remains as given.
    """
    verdicts = {name: "given as 0" for name in _LIMITS if _given(state.given, name) == 0.0}
    while True:
        names = [name for name in _LIMITS if name not in verdicts]
        u, std = _most_likely(state, names, runs)
        low, high = np.log([_LIMITS[name] for name in names]).T
        at_limit = (u < low + _MARGIN) | (u > high - _MARGIN)
        if not at_limit.any():
            break
        k = int(np.argmax(at_limit))
        limit = _LIMITS[names[k]][int(u[k] > low[k] + _MARGIN)]
        verdicts[names[k]] = f"would be beyond {limit:g}"
    values = dict(zip(names, np.exp(u).tolist(), strict=True))
    for name, one in zip(names, std, strict=True):
        if not one < _LARGEST_STD:
            verdicts[name] = "the plots hardly depend on it, or on it and another one together"
    stds = {name: values[name] * float(one) for name, one in zip(names, std, strict=True)}
    return replace(state, values=values, std=stds, verdicts=verdicts)


def _most_likely(
    state: _State, names: Sequence[str], runs: Sequence[_Run]
) -> tuple[np.ndarray, np.ndarray]:
    """Logarithms of the named parameters, and their standard deviations."""
    low, high = np.log([_LIMITS[name] for name in names]).T
    prior = np.log([_given(state.given, name) for name in names])
    u = np.log([state.value(name) for name in names])

    def read(u: np.ndarray) -> _Read:
        values = dict(zip(names, np.exp(u).tolist(), strict=True))
        return _read(_State(state.given, values).settings, runs)

    def posterior(u: np.ndarray) -> float:
        return read(u).log_likelihood - 0.5 * float(np.sum(((u - prior) / _PRIOR_STD) ** 2))

    for _ in range(_PASSES):
        outliers = read(u).outlier
        runs = [run.without(mine) for run, mine in zip(runs, outliers, strict=True)]
        u = _maximized(posterior, u, low, high)
    return u, _std(_derivatives(posterior, u)[1])


@dataclass(frozen=True)
class _Read:
    """The plots of runs as read by the estimator.

    A plot is an outlier, with errors `outlier_scale` times as large, with `outlier_probability`.
    """

    log_likelihood: float
    nis: list[np.ndarray]
    outlier: list[np.ndarray]

    @property
    def mean_nis(self) -> float:
        """Of plots, each with the probability that it is no outlier."""
        return float(
            np.average(np.concatenate(self.nis), weights=1.0 - np.concatenate(self.outlier))
        )


def _read(settings: Settings, runs: Sequence[_Run]) -> _Read:
    radar = settings.make_radar()
    estimator, sensor = settings.make_estimator(radar), plot_sensor(radar)
    share = max(float(settings.tracker["outlier_probability"]), _LEAST_SHARE)
    excess = float(settings.tracker["outlier_scale"]) ** 2 - 1.0
    total, all_nis, all_outliers = 0.0, [], []
    for run in runs:
        # Each plot is preceded by a missing one at its time, which gives the prediction.
        result = estimator.run(
            run.readings,
            dt_s=run.steps_s,
            sensor=sensor,
            start=run.start,
            own_position_m=np.repeat(run.plots.own_m, 2, axis=0),
        )
        innovation_m = run.plots.position_m - result.mean[::2, 0::2]
        errors = run.plots.covariance(radar)
        spread = result.covariance[::2, 0::2, 0::2] + errors
        usual, nis = _log_density(innovation_m, spread)
        outlier, _ = _log_density(innovation_m, spread + excess * errors)
        usual = np.where(run.used, result.log_likelihood[1::2], usual)
        usual, outlier = usual + math.log1p(-share), outlier + math.log(share)
        both = np.logaddexp(usual, outlier)
        total += float(np.sum(both))
        all_nis.append(nis)
        all_outliers.append(np.exp(outlier - both))
    return _Read(total if math.isfinite(total) else _IMPOSSIBLE, all_nis, all_outliers)


def _log_density(error: np.ndarray, covariance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Logarithm of a normal density of errors (n, 2), and their squared distance."""
    distance = wl.eval.nees(error, covariance)
    return -0.5 * (distance + np.log(np.linalg.det(covariance))) - math.log(2 * math.pi), distance


# Maximization -------------------------------------------------------------------------------------


def _derivatives(of: Callable[[np.ndarray], float], u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Gradient and Hessian by central differences."""
    n = len(u)
    step = _STEP * np.eye(n)
    middle = of(u)
    up, down = (np.array([of(u + sign * step[i]) for i in range(n)]) for sign in (1, -1))
    hessian = np.diag((up - 2.0 * middle + down) / _STEP**2)
    for i in range(n):
        for j in range(i):
            both = of(u + step[i] + step[j]) + of(u - step[i] - step[j])
            mixed = both - up[i] - up[j] - down[i] - down[j] + 2.0 * middle
            hessian[i, j] = hessian[j, i] = mixed / (2.0 * _STEP**2)
    return (up - down) / (2.0 * _STEP), hessian


def _maximized(
    of: Callable[[np.ndarray], float], u: np.ndarray, low: np.ndarray, high: np.ndarray
) -> np.ndarray:
    """Newton's method with steps of limited length between limits."""
    u = np.clip(u, low, high)
    best = of(u)
    for _ in range(_STEPS):
        gradient, hessian = _derivatives(of, u)
        curvature, axes = np.linalg.eigh(-hessian)
        curvature = np.maximum(np.abs(curvature), 1.0)
        step = axes @ ((axes.T @ gradient) / curvature)
        step *= min(1.0, _LARGEST_STEP / max(np.abs(step).max(), 1e-300))
        steps = 0.5 ** np.arange(6)[:, np.newaxis] * step
        arms = _STEP / 2 * np.vstack([np.eye(len(u)), -np.eye(len(u))])
        before = best
        u, best = _better(of, u, best, np.clip(u + steps, low, high))
        if best - before >= _ENOUGH:
            continue
        # A parameter alone where Newton's method gains nothing.
        before = best
        u, best = _better(of, u, best, np.clip(u + arms, low, high), by=_ENOUGH)
        if best == before:
            break
    return u


def _better(
    of: Callable[[np.ndarray], float],
    u: np.ndarray,
    value: float,
    trials: np.ndarray,
    by: float = 0.0,
) -> tuple[np.ndarray, float]:
    """The first of the trials that is better by so much, and its value; else what was."""
    for trial in trials:
        if (tried := of(trial)) > value + by:
            return trial, tried
    return u, value


def _std(hessian: np.ndarray) -> np.ndarray:
    """Standard deviations by the observed information, which has at least that of the prior."""
    curvature, axes = np.linalg.eigh(-hessian)
    return np.sqrt((axes**2 / np.maximum(curvature, _PRIOR_STD**-2)).sum(axis=1))


# Detection ----------------------------------------------------------------------------------------


def _hits_of(tracked: TrackedEpisode) -> Iterator[np.ndarray]:
    """For each track whether it has a plot in each scan from its first plot to its last one."""
    time_s = tracked.episode.time_s
    ids = [set(np.asarray(one).tolist()) for one in tracked.plot_track_id]
    for track in tracked.tracks:
        name = int(track.track_id[0])
        hit = np.array([name in one for one in ids], dtype=bool)
        scans = np.flatnonzero(hit & (time_s > track.time_s[0]))
        if len(scans) > 1:
            yield hit[scans[0] : scans[-1]]


def _detection(
    seen: Sequence[np.ndarray], step_s: float, tracker: dict[str, Any]
) -> tuple[float, float]:
    """Most likely detection probability of a visible vessel, and its standard deviation."""

    def likelihood(u: np.ndarray) -> float:
        probability = 1.0 / (1.0 + math.exp(-u[0]))
        return sum(_visible_likelihood(hits, probability, step_s, tracker) for hits in seen)

    limit = np.array([6.0])
    u = _maximized(likelihood, np.array([1.0]), -limit, limit)
    _, hessian = _derivatives(likelihood, u)
    value = 1.0 / (1.0 + math.exp(-u[0]))
    return value, float(value * (1.0 - value) * _std(hessian)[0])


def _visible_likelihood(
    hits: np.ndarray, probability: float, step_s: float, tracker: dict[str, Any]
) -> float:
    """Of scans with and without a plot of a vessel that is at times hidden."""
    visible_s, hidden_s = tracker["visible_time_s"], tracker["hidden_time_s"]
    hides = -math.expm1(-step_s / visible_s) if visible_s > 0.0 else 0.0
    shows = -math.expm1(-step_s / hidden_s)
    visible, total = 1.0, 0.0
    for hit in hits.tolist():
        visible += (1.0 - visible) * shows - visible * hides
        likelihood = visible * probability if hit else 1.0 - visible * probability
        visible = visible * (probability if hit else 1.0 - probability) / likelihood
        total += math.log(likelihood)
    return total
