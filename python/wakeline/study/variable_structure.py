"""Paper B: an IMM of five models against three models whose turn rates move with the vessel.

Le Minh Hoang, A. A. Konovalov, Dao Van Luc, "Tracking of maneuvering targets using a variable
structure multiple model algorithm", J. Russian Universities. Radioelectronics, 2023, 26(3), 77-89.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

import wakeline as wl
from wakeline import PiecewiseAcceleration, montecarlo, plot, scenario
from wakeline.montecarlo import Candidate
from wakeline.scenario import Scenario

from . import curves
from .base import Picture, Published, Report, Rows
from .estimators import exists, turn_candidate, turn_filter

SUMMARY = "IMM of five models against moving grids of three, paper B: AGMM and SGMM"

RANDOM_SCENARIOS = 24
LABELS = {
    "imm5": "IMM5",
    "imm9": "IMM9",
    "agmm": "AGMM",
    "sgmm": "SGMM",
    "likely_model_set": "LMS",
    "mode_history": "mode histories",
    "clairvoyant": "clairvoyant",
}
COLORS = dict(zip(LABELS.values(), plot.PALETTE, strict=False)) | {"clairvoyant": plot.INK}

POLAR, CONVERTED = "polar", "converted"
_NOISE = {
    POLAR: PiecewiseAcceleration(std_mps2=0.003),
    CONVERTED: PiecewiseAcceleration(std_mps2=0.05),
}
_STAY = 0.9
_IN_PICTURES = 100

_ORDER = ("peak_position_m", "peak_velocity_mps", "mean_position_m", "mean_velocity_mps")
PAPER = Published(
    _ORDER,
    {
        ("example1", "imm5"): (69.52, 4.74, 17.62, 0.91),
        ("example1", "agmm"): (39.92, 3.26, 10.21, 0.75),
        ("example1", "sgmm"): (43.12, 3.31, 13.25, 0.74),
        ("example2", "imm5"): (80.66, 7.83, 23.15, 2.08),
        ("example2", "agmm"): (51.83, 6.68, 11.37, 1.36),
        ("example2", "sgmm"): (48.5, 5.9, 11.55, 1.40),
    },
)
_SILENT = float("nan")
REFERENCE = Published(
    _ORDER,
    {
        ("example1", "bound"): (23.5, 1.40, 9.7, 0.14),
        ("example1", "clairvoyant"): (20.9, 0.56, 9.1, 0.10),
        ("example1", "imm5_converted"): (35.4, 3.06, 26.1, 1.80),
        ("example1", "agmm_converted"): (37.0, 3.95, 28.3, 2.61),
        ("example1", "sgmm_converted"): (42.2, 3.53, 25.7, 1.65),
        ("example1", "imm5"): (34.5, 3.05, 25.4, 1.79),
        ("example1", "mode_history"): (34.1, 2.87, 17.8, 1.37),
        ("example2", "bound"): (22.4, 1.38, 12.8, 0.22),
        ("example2", "clairvoyant"): (18.7, 0.47, 11.8, 0.15),
        ("example2", "imm5_converted"): (48.8, 7.86, 27.6, 2.64),
        ("example2", "agmm_converted"): (102.0, 11.2, 48.0, 5.24),
        ("example2", "sgmm_converted"): (242.0, 15.8, 55.0, 4.22),
        ("example2", "imm5"): (47.1, 7.60, 26.1, 2.59),
        ("example2", "mode_history"): (49.6, 7.38, 21.8, 2.22),
        ("random", "clairvoyant"): (_SILENT, _SILENT, 9.9, 0.14),
        ("random", "imm5"): (_SILENT, _SILENT, 29.8, 2.61),
        ("random", "imm9"): (_SILENT, _SILENT, 28.8, 2.46),
        ("random", "mode_history"): (_SILENT, _SILENT, 25.7, 2.04),
    },
)


# The estimators -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Setting:
    """What the estimators are told about an example.

    Attributes
    ----------
    imm5_deg_s : tuple of 5 floats
        Turn rates of the IMM and of SGMM's grid.
    agmm_max_deg_s, agmm_unlikely, agmm_likely : float
        The limit of AGMM's rates, its thresholds t2 and t3.
    """

    imm5_deg_s: tuple[float, ...]
    agmm_max_deg_s: float
    agmm_unlikely: float
    agmm_likely: float


SETTINGS = {
    "example1": Setting((-2, -1, 0, 1, 2), 3.0, 0.25, 0.75),
    "example2": Setting((-4, -2, 0, 2, 4), 5.0, 0.2, 0.8),
    "random": Setting((-4, -2, 0, 2, 4), 5.0, 0.2, 0.8),
}


def imm5(setting: Setting, form: str) -> Candidate:
    """The IMM of five models."""
    return turn_candidate(setting.imm5_deg_s, _NOISE[form], form, stay=_STAY)


def imm9(setting: Setting, form: str) -> Candidate:
    """An IMM of nine models, 1 deg/s apart."""
    return turn_candidate(range(-4, 5), _NOISE[form], form, stay=_STAY)


def agmm(setting: Setting, form: str, **options: Any) -> Candidate:
    """Three models whose turn rates move; what is not printed stays at its default."""
    fields = {
        "max_turn_rate_rad_s": np.deg2rad(setting.agmm_max_deg_s),
        "unlikely_threshold": setting.agmm_unlikely,
        "likely_threshold": setting.agmm_likely,
    }
    grid = wl.AdaptiveGridImm(filter=turn_filter(0.0, _NOISE[form]), **(fields | options))
    return Candidate(grid, form)


def sgmm(setting: Setting, form: str, **options: Any) -> Candidate:
    """A window of three models on the IMM's five rates."""
    rates_rad_s = np.deg2rad(setting.imm5_deg_s)
    fields = {"grid_rad_s": rates_rad_s, "threshold": 0.7}
    grid = wl.SwitchingGridImm(filter=turn_filter(0.0, _NOISE[form]), **(fields | options))
    return Candidate(grid, form)


def estimators(setting: Setting) -> dict[str, Any]:
    """The candidates by name: all of them that the engine has."""
    found: dict[str, Any] = {}
    for name, build, form, needs in _TABLE:
        if exists(*needs):
            found[name] = build(setting, form)
    return found | {"clairvoyant": partial(montecarlo.clairvoyant, sensor=POLAR)}


_TABLE: tuple[tuple[str, Callable[..., Any], str, tuple[str, ...]], ...] = (
    ("imm5", imm5, POLAR, ()),
    ("imm9", imm9, POLAR, ()),
    ("agmm", agmm, POLAR, ("AdaptiveGridImm",)),
    ("sgmm", sgmm, POLAR, ("SwitchingGridImm",)),
    ("imm5_converted", imm5, CONVERTED, ()),
    ("agmm_converted", agmm, CONVERTED, ("AdaptiveGridImm",)),
    ("sgmm_converted", sgmm, CONVERTED, ("SwitchingGridImm",)),
)


# Runs ---------------------------------------------------------------------------------------------


def run(
    runs: int = 500,
    seed: int = 0,
    *,
    full: bool = False,
    threads: int | None = None,
    progress: bool = False,
) -> Report:
    """Run the study.

    Parameters
    ----------
    runs, seed : int
        Of the Monte Carlo runs. Each of the 24 random scenarios has as many of them as make up
        `runs`, rounded up.
    full : bool
        Also what the outcome hangs on: turn rates beside the grid, noise, what is not printed.
    threads : int, optional
        Default as many as there are processors.
    progress : bool
        Whether to draw a bar where stderr is a terminal.

    Returns
    -------
    Report
        Scenarios ``example1``, ``example2`` and ``random``, whose `result` is a mapping by these.
    """

    def monte_carlo(
        scenarios: Sequence[Scenario], candidates: Mapping[str, Any], share: int = 1
    ) -> montecarlo.Result:
        return montecarlo.run(
            scenarios, candidates, -(-runs // share), seed, threads=threads, progress=progress
        )

    results, rows = {}, []
    for name in ("example1", "example2"):
        example = scenario.named(name)
        results[name] = monte_carlo([example], estimators(SETTINGS[name]))
        rows += curves.rows(results[name], name, example)
    wanderers = scenario.random_maneuvers(RANDOM_SCENARIOS)
    results["random"] = monte_carlo(wanderers, estimators(SETTINGS["random"]), len(wanderers))
    rows += curves.merged_rows(results["random"], "random", wanderers)
    if full:
        for example, setting in _sweeps():
            result = monte_carlo([example], setting)
            rows += curves.rows(result, example.name, example)
    return Report(
        name="variable-structure",
        seed=seed,
        runs=runs,
        rows=rows,
        result=results,
        pictures=tuple(_pictures(results, rows, seed)),
        published={"paper": PAPER, "reference": REFERENCE},
        notes=(NOTE,),
    )


NOTE = (
    "The paper's mean position errors of AGMM and SGMM lie on or below the bound of an estimator\n"
    "that is told every turn. Runs start at the true state, while the bound takes the start to be\n"
    "known to 10 m and 1 m/s only: over the first scans an estimator can be below it."
)


def _sweeps() -> Iterator[tuple[Scenario, dict[str, Any]]]:
    """Scenarios and candidates that show what the outcome hangs on, around example 1."""
    first, setting = scenario.named("example1"), SETTINGS["example1"]
    usual = {k: v for k, v in estimators(setting).items() if "_converted" not in k}
    for times, where in ((1.0, "on_grid"), (0.75, "between"), (1.5, "outside")):
        truth = _turning(first, times)
        yield replace(first, name=f"example1_rates_{where}", truth=truth), usual
    for scale in (0.3, 0.1):
        radar = replace(
            first.radar,
            range_std_m=scale * first.radar.range_std_m,
            bearing_std_rad=scale * first.radar.bearing_std_rad,
        )
        yield replace(first, name=f"example1_noise_x{scale}", radar=radar), usual
    for name in ("example1", "example2"):
        example = scenario.named(name)
        yield replace(example, name=f"{name}_settings"), dict(_variants(SETTINGS[name]))


def _turning(example: Scenario, times: float) -> scenario.Truth:
    """The truth of an example with all its turn rates so many times as large."""
    segments = [
        replace(segment, turn_rate_rad_s=times * segment.turn_rate_rad_s)
        for segment in example.truth.segments
    ]
    return scenario.Truth(example.truth.state_at(0.0)[0], segments)


def _variants(setting: Setting) -> Iterator[tuple[str, Candidate]]:
    """AGMM and SGMM with other thresholds and with other choices of what is not printed."""
    if exists("AdaptiveGridImm"):
        for spacing in (0.5, 1.0, 2.0):
            options = {"min_spacing_rad_s": np.deg2rad(spacing)}
            yield f"agmm_spacing_{spacing:g}", agmm(setting, POLAR, **options)
        for side in (0.5, 1.0, 2.0):
            options = {"initial_turn_rates_rad_s": np.deg2rad([-side, 0.0, side])}
            yield f"agmm_initial_{side:g}", agmm(setting, POLAR, **options)
        for threshold in (0.3, 0.7):
            yield f"agmm_t1_{threshold:g}", agmm(setting, POLAR, centre_threshold=threshold)
    if exists("SwitchingGridImm"):
        for threshold in (0.3, 0.7, 0.9):
            yield f"sgmm_t_{threshold:g}", sgmm(setting, POLAR, threshold=threshold)
        yield "sgmm_literal", sgmm(setting, POLAR, rule="literal")
        yield "sgmm_identity", sgmm(setting, POLAR, carry="identity")


# Pictures -----------------------------------------------------------------------------------------


def _pictures(results: Mapping[str, montecarlo.Result], rows: Rows, seed: int) -> Iterator[Picture]:
    for name in ("example1", "example2"):
        yield from _example_pictures(name, results[name], seed)
    for what, vary, label in (
        ("t", _sgmm_centre, "SGMM"),
        ("t1", _agmm_centre, "AGMM"),
    ):
        if exists("SwitchingGridImm" if vary is _sgmm_centre else "AdaptiveGridImm"):
            yield Picture(
                f"influence-{what}",
                f"Turn rate of {label}'s centre model in one run, by the threshold {what}",
                tuple(
                    partial(_draw_influence, name=name, vary=vary, what=what, seed=seed)
                    for name in ("example1", "example2")
                ),
                shared=False,
            )
    yield Picture(
        "variable-structure-ranking",
        "Mean position error of every estimator",
        (partial(_draw_ranking, rows=rows),),
        size_in=(7.2, 4.6),
    )


def _example_pictures(name: str, result: montecarlo.Result, seed: int) -> Iterator[Picture]:
    example, setting = scenario.named(name), SETTINGS[name]
    candidates = estimators(setting)
    shown = {key: label for key, label in LABELS.items() if key in candidates}
    paper = {key: shown[key] for key in ("imm5", "agmm", "sgmm") if key in shown}
    title = f"Example {name[-1]}"
    z = example.draw(min(_IN_PICTURES, result.runs), seed)
    yield Picture(
        f"{name}-truth",
        f"{title}: the true path",
        (partial(curves.draw_truth, scenario=example),),
        shared=False,
    )
    yield Picture(
        f"{name}-tracks",
        f"{title}: plots and filtered tracks of one run",
        (
            partial(
                curves.draw_tracks,
                scenario=example,
                candidates={label: candidates[key] for key, label in paper.items()},
                seed=seed,
                colors=COLORS,
            ),
        ),
        shared=False,
    )
    yield Picture(
        f"{name}-turn-rate",
        f"{title}: turn rate of the centre model in one run, and of the estimate in the mean",
        (
            partial(_draw_centres, example=example, candidates=candidates, seed=seed),
            partial(_draw_rates, example=example, result=result, shown=shown),
        ),
        size_in=(7.2, 6.2),
    )
    yield Picture(
        f"{name}-modes",
        f"{title}: mode probabilities, mean of the runs",
        tuple(
            partial(_draw_modes, example=example, candidate=candidates[key], label=label, z=z)
            for key, label in paper.items()
        ),
        size_in=(7.2, 2.4 * len(paper) + 0.4),
    )
    yield curves.error_picture(
        f"{name}-errors",
        f"{title}: RMSE of {result.runs} runs over the bound",
        result,
        example,
        {key: label for key, label in shown.items() if key != "imm9"},
        COLORS,
    )


def _draw_modes(ax, example: Scenario, candidate: Candidate, label: str, z: np.ndarray):
    """Probability of each turn rate; rates that move are put into steps of 1 deg/s."""
    found = candidate(example, z)
    rates = getattr(found, "turn_rate_rad_s", None)
    rates = candidate.rates(example) if rates is None else np.asarray(rates)
    rates_deg_s = np.broadcast_to(np.degrees(rates), found.mode_probability.shape)
    steps_deg_s = np.unique(np.round(rates_deg_s))
    share = np.stack(
        [
            np.where(np.round(rates_deg_s) == step, found.mode_probability, 0.0).sum(-1).mean(0)
            for step in steps_deg_s
        ],
        axis=-1,
    )
    return plot.probability_panel(
        ax,
        example.time_s,
        share,
        np.deg2rad(steps_deg_s),
        true_rate_rad_s=example.turn_rates_rad_s,
        switch_s=example.switch_times_s,
        ylabel=f"{label}\nmode probability",
    )


def _draw_centres(ax, example: Scenario, candidates: Mapping[str, Any], seed: int):
    """Turn rate of the centre model in the first run."""
    rates = {
        LABELS[key]: _centre(candidates[key], example, seed)
        for key in ("agmm", "sgmm")
        if key in candidates
    }
    return plot.turn_rate_panel(
        ax, example.time_s, example.turn_rates_rad_s, rates, colors=COLORS,
        ylabel="turn rate of\nthe centre model (°/s)",
    )  # fmt: skip


def _draw_rates(ax, example: Scenario, result: montecarlo.Result, shown: Mapping[str, str]):
    """Estimated turn rate, mean of the runs."""
    outcomes = {label: result[example.name, key] for key, label in shown.items()}
    rates = {
        label: outcome.turn_rate_rad_s
        for label, outcome in outcomes.items()
        if outcome.turn_rate_rad_s is not None and label not in ("clairvoyant", "IMM9")
    }
    return plot.turn_rate_panel(
        ax, example.time_s, example.turn_rates_rad_s, rates, colors=COLORS,
        ylabel="estimated turn rate,\nmean of the runs (°/s)",
    )  # fmt: skip


def _draw_influence(
    ax, name: str, vary: Callable[[str, float, int], np.ndarray], what: str, seed: int
):
    example = scenario.named(name)
    rates = {f"{what} = {value:g}": vary(name, value, seed) for value in (0.3, 0.7)}
    return plot.turn_rate_panel(
        ax, example.time_s, example.turn_rates_rad_s, rates,
        ylabel=f"example {name[-1]}, rate of\nthe centre model (°/s)",
    )  # fmt: skip


def _sgmm_centre(name: str, threshold: float, seed: int) -> np.ndarray:
    grid = sgmm(SETTINGS[name], POLAR, threshold=threshold)
    return _centre(grid, scenario.named(name), seed)


def _agmm_centre(name: str, threshold: float, seed: int) -> np.ndarray:
    grid = agmm(SETTINGS[name], POLAR, centre_threshold=threshold)
    return _centre(grid, scenario.named(name), seed)


def _centre(candidate: Candidate, example: Scenario, seed: int) -> np.ndarray:
    """Turn rate (T,) of the middle of three models in the first run."""
    return np.asarray(candidate(example, example.draw(1, seed)).turn_rate_rad_s)[0, :, 1]


def _draw_ranking(ax, rows: Rows):
    """Mean position error by estimator in each scenario."""
    names = list(dict.fromkeys(row["estimator"] for row in rows))
    found = {(row["scenario"], row["estimator"]): row["mean_position_m"] for row in rows}
    values = {
        scene: [found[scene, name] for name in names]
        for scene in ("example1", "example2", "random")
    }
    return plot.ranking_panel(
        ax, [LABELS.get(name, name) for name in names], values, xlabel="mean position RMSE (m)"
    )
