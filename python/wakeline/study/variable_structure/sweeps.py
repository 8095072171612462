"""Dependence on turn rates, noise, thresholds, unprinted parameters, and the start."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np

import wakeline as wl
from wakeline import montecarlo, scenario
from wakeline.montecarlo import Candidate
from wakeline.scenario import Scenario

from . import candidates
from .candidates import POLAR, SETTINGS, Setting

RATES = {"on": 1.0, "between": 0.75, "outside": 1.5}
"""Factors that put the turn rates of example 1 on, between and outside the IMM's rates."""
NOISES = (1.0, 0.3, 0.1)
"""Factors of both errors of the radar."""
FIRST = {
    "even": (1 / 3, 1 / 3, 1 / 3),
    "half": (0.25, 0.5, 0.25),
    "sure": (0.01, 0.98, 0.01),
    "left": (0.9, 0.05, 0.05),
    "right": (0.05, 0.05, 0.9),
}
"""First probabilities of three models, left, centre and right."""
_SURVEY = 60


def robustness_name(where: str, noise: float) -> str:
    """Name of a scenario of the sweep over rates and noise."""
    return f"example1_{where}_noise_x{noise:g}"


def swept() -> Iterator[tuple[Scenario, dict[str, Any]]]:
    """Scenarios, each with its candidates."""
    first, setting = scenario.named("example1"), SETTINGS["example1"]
    polar = {k: v for k, v in candidates.estimators(setting).items() if "_converted" not in k}
    for noise in NOISES:
        for where, times in RATES.items():
            yield (
                replace(
                    first,
                    name=robustness_name(where, noise),
                    truth=_turning(first, times),
                    radar=_finer(first.radar, noise),
                ),
                polar,
            )
    for name in ("example1", "example2"):
        example = scenario.named(name)
        yield replace(example, name=f"{name}_settings"), _variants(SETTINGS[name])
        yield replace(example, name=f"{name}_mixing"), candidates.unmixed(SETTINGS[name], POLAR)
        yield replace(example, name=f"{name}_from_plots"), _from_plots(example, SETTINGS[name])


def _turning(example: Scenario, times: float) -> scenario.Truth:
    """The truth of an example with all turn rates multiplied by a factor."""
    segments = [
        replace(segment, turn_rate_rad_s=times * segment.turn_rate_rad_s)
        for segment in example.truth.segments
    ]
    return scenario.Truth(example.truth.state_at(0.0)[0], segments)


def _finer(radar: scenario.RadarSimulator, times: float) -> scenario.RadarSimulator:
    return replace(
        radar,
        range_std_m=times * radar.range_std_m,
        bearing_std_rad=times * radar.bearing_std_rad,
    )


def _variants(setting: Setting) -> dict[str, Candidate]:
    """The printed rules, with other thresholds and other unprinted parameters.

    Rates of AGMM are in degrees per second, first probabilities those of `FIRST`. `agmm_kept` and
    `agmm_patient` each have one of two additions to the rules in the library's defaults. Variants
    of SGMM have the symmetric rule, but those called literal.
    """
    first = {name: {"initial_mode_probability": given} for name, given in FIRST.items()}
    adaptive = {
        "agmm_printed": {},
        **{f"agmm_t1_{t1:g}": {"centre_threshold": t1} for t1 in (0.3, 0.7)},
        **{f"agmm_r_{r:g}": {"min_spacing_rad_s": np.deg2rad(r)} for r in (0.5, 1.0, 2.0, 3.0)},
        **{
            f"agmm_initial_{side:g}": {"initial_turn_rates_rad_s": np.deg2rad([-side, 0.0, side])}
            for side in (0.5, 1.0, 2.0)
        },
        **{f"agmm_first_{name}": given for name, given in first.items()},
        "agmm_kept": {"kept_spacing_rad_s": np.deg2rad(3.0)},
        "agmm_patient": {"centre_threshold": 0.8, "centre_gain": 0.3},
    }
    switching = {
        "sgmm_symmetric": {},
        **{f"sgmm_t_{t:g}": {"threshold": t} for t in (0.3, 0.5, 0.7, 0.9)},
        **{f"sgmm_first_{name}": given for name, given in first.items()},
        "sgmm_identity": {"carry": "identity"},
        "sgmm_literal": {"rule": "literal"},
        "sgmm_literal_t_0.9": {"rule": "literal", "threshold": 0.9},
    }
    return {
        "imm5": candidates.imm5(setting, POLAR),
        **{
            name: candidates.agmm_printed(setting, POLAR, **given)
            for name, given in adaptive.items()
        },
        **{
            name: candidates.sgmm_symmetric(setting, POLAR, **given)
            for name, given in switching.items()
        },
    }


# Counts ------------------------------------------------------------------------------------------


def moves(runs: int, seed: int) -> str:
    """Number of moves of the center model in a run, by threshold."""
    lines = ["Moves of the center model in a run, mean of the runs:"]
    for name in ("example1", "example2"):
        example, setting = scenario.named(name), SETTINGS[name]
        z = example.draw(runs, seed)
        kinds = {
            f"SGMM t = {t:g}": candidates.sgmm_symmetric(setting, POLAR, threshold=t)
            for t in (0.3, 0.7, 0.87, 0.9)
        } | {
            f"AGMM t1 = {t1:g}": candidates.agmm_printed(setting, POLAR, centre_threshold=t1)
            for t1 in (0.3, 0.7)
        }
        counts = {
            kind: np.count_nonzero(np.diff(candidates.centre_rates(candidate, example, z))) / runs
            for kind, candidate in kinds.items()
        }
        lines.append(f"  {name}: " + ", ".join(f"{kind}: {n:.1f}" for kind, n in counts.items()))
    return "\n".join(lines)


def survey(runs: int, seed: int, threads: int | None) -> str:
    """Share of random settings of AGMM and SGMM with a lower mean error than IMM5."""
    ratios = {}
    for name in ("example1", "example2"):
        example, setting = scenario.named(name), SETTINGS[name]
        drawn = {"imm5": candidates.imm5(setting, POLAR)} | _drawn(setting)
        figures = montecarlo.run(
            example, drawn, runs, seed, threads=threads, progress=False
        ).summary()[example.name]
        imm5_m = figures["imm5"]["mean_position_m"]
        ratios[name] = {k: figures[k]["mean_position_m"] / imm5_m for k in drawn if k != "imm5"}
    lines = [f"Ratio of the mean position error to IMM5's, for {_SURVEY} random settings:"]
    for kind in ("agmm", "sgmm"):
        each = np.array([[of[f"{kind}-{k}"] for k in range(_SURVEY)] for of in ratios.values()])
        less = (each < 1.0).all(axis=0).mean()
        least, middle = each.min(axis=1), np.median(each, axis=1)
        lines.append(
            f"  {kind.upper()}: less in both examples {less:.0%}, least {least[0]:.2f} and "
            f"{least[1]:.2f}, median {middle[0]:.2f} and {middle[1]:.2f}"
        )
    return "\n".join(lines)


def _drawn(setting: Setting) -> dict[str, Candidate]:
    rng, first = np.random.default_rng(0), np.random.default_rng(1)
    found = {}
    for k in range(_SURVEY):
        side_deg_s = rng.uniform(0.2, setting.agmm_max_deg_s)
        found[f"agmm-{k}"] = candidates.agmm_printed(
            setting,
            POLAR,
            min_spacing_rad_s=np.deg2rad(rng.uniform(0.2, 3.0)),
            initial_turn_rates_rad_s=np.deg2rad([-side_deg_s, 0.0, side_deg_s]),
            centre_threshold=rng.uniform(0.1, 0.9),
            unlikely_threshold=rng.uniform(0.02, 0.4),
            likely_threshold=rng.uniform(0.5, 0.98),
            initial_mode_probability=first.dirichlet(np.ones(3)),
        )
        found[f"sgmm-{k}"] = candidates.sgmm_printed(
            setting,
            POLAR,
            threshold=rng.uniform(0.3, 0.95),
            rule=str(rng.choice(["symmetric", "literal"])),
            carry=str(rng.choice(["slot", "identity"])),
            initial_mode_probability=first.dirichlet(np.ones(3)),
        )
    return found


# From plots ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _FromPlots:
    """A candidate started from the first two plots, which replace its first two estimates."""

    estimator: Any
    sensor: Any

    def __call__(self, scene: Scenario, z: np.ndarray) -> SimpleNamespace:
        dt_s, sensor = scene.radar.period_s, self.sensor
        starts = [wl.two_point(sensor, first, second, dt_s) for first, second in z[:, :2]]
        found = self.estimator.run(z[:, 2:], dt_s=dt_s, sensor=sensor, start=starts)
        none = np.full((len(z), 2), np.nan)
        return SimpleNamespace(
            mean=_led_by(np.array([start.mean for start in starts]), found.mean),
            covariance=_led_by(np.array([start.covariance for start in starts]), found.covariance),
            nis=np.concatenate([none, found.nis], axis=1),
            status=np.concatenate([np.zeros((len(z), 2), int), found.status], axis=1),
            mode_probability=None,
        )


def _led_by(start: np.ndarray, later: np.ndarray) -> np.ndarray:
    """Values (R, T + 2, ...), the first two from the start."""
    return np.concatenate([start[:, np.newaxis], start[:, np.newaxis], later], axis=1)


def _from_plots(example: Scenario, setting: Setting) -> dict[str, _FromPlots]:
    """IMM5 with each form of the measurements and the same process noise."""
    radar = example.radar
    unbiased = wl.ConvertedRangeBearing(
        range_std_m=radar.range_std_m, bearing_std_rad=radar.bearing_std_rad, unbiased=True
    )
    imm = candidates.imm5(setting, POLAR).estimator
    return {
        "imm5": _FromPlots(imm, example.polar_sensor),
        "imm5_converted": _FromPlots(imm, example.converted_sensor),
        "imm5_unbiased": _FromPlots(imm, unbiased),
    }
