"""The figures of the paper, and one of all estimators."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from wakeline import montecarlo, plot, scenario
from wakeline._brief import many
from wakeline.montecarlo import Candidate
from wakeline.scenario import Scenario

from .. import curves
from ..base import Picture, Rows
from .candidates import (
    COLORS,
    LABELS,
    POLAR,
    SETTINGS,
    agmm_printed,
    centre_rates,
    estimators,
    sgmm_symmetric,
)
from .sweeps import NOISES, RATES, robustness_name

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_DRAWN_RUNS = 100
_SHOWN = {
    "": ("imm5", "agmm", "sgmm", "mode_history"),
    "-printed": ("imm5", "agmm_printed", "sgmm_printed", "sgmm_symmetric"),
}
_IN_ROBUSTNESS = (
    *("imm5", "imm9", "agmm", "sgmm"),
    *("mode_history", "mode_history_known", "mode_history_rates", "clairvoyant"),
)


@dataclass(frozen=True)
class _Influence:
    """The center model of an estimator for several values of a threshold."""

    letter: str
    field: str
    values: tuple[float, ...]
    label: str
    build: Callable[..., Candidate]

    def picture(self, seed: int) -> Picture:
        return Picture(
            f"influence-{self.letter}",
            f"Turn rate of {self.label}'s centre model in one run, by the threshold {self.letter}",
            tuple(partial(self.draw, name=name, seed=seed) for name in ("example1", "example2")),
            shared=False,
        )

    def draw(self, ax: Axes, name: str, seed: int) -> Axes:
        example, setting = scenario.named(name), SETTINGS[name]
        rates = {
            f"{self.letter} = {value:g}": _first_centre(
                self.build(setting, POLAR, **{self.field: value}), example, seed
            )
            for value in self.values
        }
        return plot.turn_rate_panel(
            ax,
            example.time_s,
            example.turn_rates_rad_s,
            rates,
            ylabel=f"example {name[-1]}, rate of\nthe centre model (°/s)",
        )


_INFLUENCES = (
    _Influence("t", "threshold", (0.3, 0.7, 0.9), "SGMM", sgmm_symmetric),
    _Influence("t1", "centre_threshold", (0.3, 0.7), "AGMM", agmm_printed),
)


def pictures_of(
    results: Mapping[str, montecarlo.Result], rows: Rows, seed: int
) -> Iterator[Picture]:
    """The figures of both examples, of the influence of thresholds, and of the ranking."""
    for name in ("example1", "example2"):
        yield from _example_pictures(name, results[name], seed)
    for influence in _INFLUENCES:
        yield influence.picture(seed)
    yield Picture(
        "variable-structure-ranking",
        "Mean position error of every estimator",
        (partial(_draw_ranking, rows=rows),),
        size_in=(7.2, 5.2),
    )


def robustness_picture(rows: Rows) -> Picture:
    """Mean position error divided by the bound, by turn rates and by noise."""
    return Picture(
        "robustness",
        "Example 1 with other turn rates, finer radars: mean position RMSE over the bound",
        tuple(partial(_draw_robustness, rows=rows, noise=noise) for noise in NOISES),
        size_in=(8.8, 7.2),
    )


def _example_pictures(name: str, result: montecarlo.Result, seed: int) -> Iterator[Picture]:
    """The true path, and of each group of estimators the tracks, rates, modes and errors."""
    yield Picture(
        f"{name}-truth",
        f"Example {name[-1]}: the true path",
        (partial(curves.draw_truth, scenario=scenario.named(name)),),
        shared=False,
    )
    for suffix, shown in _SHOWN.items():
        yield from _group_pictures(name, suffix, shown, result, seed)


def _group_pictures(
    name: str, suffix: str, shown: tuple[str, ...], result: montecarlo.Result, seed: int
) -> Iterator[Picture]:
    example = scenario.named(name)
    every = estimators(SETTINGS[name])
    candidates = {key: every[key] for key in shown}
    title = f"Example {name[-1]}"
    yield Picture(
        f"{name}-tracks{suffix}",
        f"{title}: plots and filtered tracks of one run",
        (
            partial(
                curves.draw_tracks,
                scenario=example,
                candidates={LABELS[key]: one for key, one in candidates.items()},
                seed=seed,
                colors=COLORS,
            ),
        ),
        shared=False,
    )
    yield Picture(
        f"{name}-turn-rate{suffix}",
        f"{title}: turn rate of the centre model in one run, and of the estimate in the mean",
        (
            partial(_draw_centres, example=example, candidates=candidates, seed=seed),
            partial(_draw_rates, example=example, result=result, shown=shown),
        ),
        size_in=(7.2, 6.2),
    )
    z = example.draw(min(_DRAWN_RUNS, result.runs), seed)
    yield Picture(
        f"{name}-modes{suffix}",
        f"{title}: probabilities of the turn rates, mean of {many(len(z), 'run')}",
        tuple(
            partial(
                _draw_modes,
                example=example,
                candidate=candidate,
                label=LABELS[key],
                z=z,
                legend=key == shown[0],
            )
            for key, candidate in candidates.items()
        ),
        size_in=(7.2, 1.9 * len(shown) + 0.7),
    )
    yield curves.error_picture(
        f"{name}-errors{suffix}",
        f"{title}: RMSE of {many(result.runs, 'run')} over the bound",
        result,
        example,
        {key: LABELS[key] for key in (*shown, "clairvoyant")},
        COLORS,
    )


# Panels -------------------------------------------------------------------------------------------


def _draw_modes(
    ax: Axes, example: Scenario, candidate: Candidate, label: str, z: np.ndarray, legend: bool
) -> Axes:
    """Probability of each rate of IMM5, with that of the nearest rates added."""
    found = candidate(example, z)
    moving = found.turn_rate_rad_s
    rates_rad_s = candidate.rates(example) if moving is None else moving
    bands_deg_s = SETTINGS[example.name].imm5_deg_s
    spacing_deg_s = bands_deg_s[1] - bands_deg_s[0]
    nearest = spacing_deg_s * np.round(np.degrees(rates_rad_s).round(6) / spacing_deg_s)
    band = np.broadcast_to(
        np.clip(nearest, bands_deg_s[0], bands_deg_s[-1]), found.mode_probability.shape
    )
    share = [
        np.where(band == rate, found.mode_probability, 0.0).sum(axis=-1).mean(axis=0)
        for rate in bands_deg_s
    ]
    return plot.probability_panel(
        ax,
        example.time_s,
        np.stack(share, axis=-1),
        np.deg2rad(bands_deg_s),
        true_rate_rad_s=example.turn_rates_rad_s,
        switch_s=example.switch_times_s,
        ylabel=f"{label}\nmode probability",
        legend=legend,
    )


def _draw_centres(ax: Axes, example: Scenario, candidates: Mapping[str, Any], seed: int) -> Axes:
    """Turn rate of the centre model in the first run."""
    return plot.turn_rate_panel(
        ax,
        example.time_s,
        example.turn_rates_rad_s,
        {
            LABELS[key]: _first_centre(candidate, example, seed)
            for key, candidate in candidates.items()
            if key.startswith(("agmm", "sgmm"))
        },
        colors=COLORS,
        ylabel="turn rate of\nthe centre model (°/s)",
    )


def _draw_rates(
    ax: Axes, example: Scenario, result: montecarlo.Result, shown: tuple[str, ...]
) -> Axes:
    """Estimated turn rate, mean of the runs."""
    return plot.turn_rate_panel(
        ax,
        example.time_s,
        example.turn_rates_rad_s,
        {LABELS[key]: result[example.name, key].turn_rate_rad_s for key in shown},
        colors=COLORS,
        ylabel="estimated turn rate,\nmean of the runs (°/s)",
    )


def _first_centre(candidate: Candidate, example: Scenario, seed: int) -> np.ndarray:
    """Turn rate (T,) of the centre model in the first run."""
    return centre_rates(candidate, example, example.draw(1, seed))[0]


def _draw_ranking(ax: Axes, rows: Rows) -> Axes:
    """Mean position error by estimator in each scenario."""
    names = list(dict.fromkeys(row["estimator"] for row in rows if row["scenario"] == "random"))
    found = curves.figures(rows, "mean_position_m")
    values = {
        scene: [found[scene, name] for name in names]
        for scene in ("example1", "example2", "random")
    }
    return plot.ranking_panel(
        ax, [LABELS.get(name, name) for name in names], values, xlabel="mean position RMSE (m)"
    )


def _draw_robustness(ax: Axes, rows: Rows, noise: float) -> Axes:
    """Position error over the bound for turn rates on, between and outside the IMM's own."""
    found = curves.figures(rows, "mean_position_m")
    scenes = [robustness_name(where, noise) for where in RATES]
    values = {
        LABELS[key]: [found[scene, key] / found[scene, curves.BOUND] for scene in scenes]
        for key in _IN_ROBUSTNESS
    }
    return plot.steps_panel(
        ax,
        list(RATES),
        values,
        xlabel="turn rates against those of IMM5",
        ylabel=f"{60 * noise:g} m, {0.5 * noise:g}°\nRMSE / bound",
        colors=COLORS,
        legend=noise == NOISES[0],
    )
