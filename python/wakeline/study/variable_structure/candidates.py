"""The estimators of the study and their parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

import wakeline as wl
from wakeline import PiecewiseAcceleration, montecarlo, plot
from wakeline.montecarlo import Candidate
from wakeline.scenario import Scenario

from ..estimators import learning_filter, sticky_chain, turn_candidate, turn_filter

_PLAIN_LABELS = {
    "imm5": "IMM5",
    "mode_history": "histories",
    "agmm": "AGMM",
    "sgmm": "SGMM",
    "likely_model_set": "LMS",
    "imm9": "IMM9",
    "mode_history_known": "histories, known rates",
    "mode_history_rates": "histories, learnt rates",
    "clairvoyant": "clairvoyant",
    "agmm_printed": "AGMM as printed",
    "sgmm_printed": "SGMM as printed",
    "sgmm_symmetric": "SGMM, symmetric rule",
}
LABELS = _PLAIN_LABELS | {
    f"{key}_converted": f"{label}, converted" for key, label in _PLAIN_LABELS.items()
}
COLORS = dict(zip(_PLAIN_LABELS.values(), plot.PALETTE, strict=False)) | {
    "clairvoyant": plot.INK,
    "AGMM as printed": plot.PALETTE[2],
    "SGMM as printed": plot.PALETTE[3],
    "SGMM, symmetric rule": plot.PALETTE[4],
}

POLAR, CONVERTED = "polar", "converted"
_NOISE = {
    POLAR: PiecewiseAcceleration(std_mps2=0.003),
    CONVERTED: PiecewiseAcceleration(std_mps2=0.05),
}
_STAY = 0.9
_NINE_DEG_S = range(-4, 5)
# Histories know the nine rates and learn those between them.
_BETWEEN_DEG_S = (-3.5, -2.5, -1.5, 1.5, 2.5, 3.5)
_KNOWN_STD_DEG_S, _BETWEEN_STD_DEG_S = 0.005, 0.2
_BETWEEN_WEIGHT = 0.3


@dataclass(frozen=True)
class Setting:
    """Parameters of the estimators in an example.

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
    return turn_candidate(_NINE_DEG_S, _NOISE[form], form, stay=_STAY)


def agmm(setting: Setting, form: str) -> Candidate:
    """Three models with adaptive turn rates, with the library's defaults."""
    return Candidate(wl.AdaptiveGridImm(_turning(form)), form)


def agmm_printed(setting: Setting, form: str, **options: Any) -> Candidate:
    """The same by the rules and thresholds of the paper; unprinted parameters have defaults."""
    printed = {
        "max_turn_rate_rad_s": np.deg2rad(setting.agmm_max_deg_s),
        "centre_threshold": 0.3,
        "unlikely_threshold": setting.agmm_unlikely,
        "likely_threshold": setting.agmm_likely,
        "centre_gain": 1.0,
        "kept_spacing_rad_s": 0.0,
        "least_move_rad_s": 0.0,
    }
    return Candidate(wl.AdaptiveGridImm(_turning(form), **(printed | options)), form)


def sgmm(setting: Setting, form: str) -> Candidate:
    """A window of three models on a fixed grid, with the library's defaults."""
    return Candidate(wl.SwitchingGridImm(_turning(form)), form)


def sgmm_printed(setting: Setting, form: str, **options: Any) -> Candidate:
    """The same by the printed rule, on the IMM's five rates with the paper's threshold.

    The rule is not symmetric: the window moves right while undecided. Estimates are kept by place,
    which is not printed.
    """
    printed = {"threshold": 0.7, "rule": "literal", "carry": "slot"}
    grid_rad_s = np.deg2rad(setting.imm5_deg_s)
    window = wl.SwitchingGridImm(_turning(form), grid_rad_s, **(printed | options))
    return Candidate(window, form)


def sgmm_symmetric(setting: Setting, form: str, **options: Any) -> Candidate:
    """The same by the rule that is likely meant: the window moves only to a likely side."""
    return sgmm_printed(setting, form, **({"rule": "symmetric"} | options))


def likely_model_set(setting: Setting, form: str) -> Candidate:
    """The likely ones of several models, with the library's defaults."""
    return Candidate(wl.LikelyModelSetImm(_turning(form)), form)


def mode_history(setting: Setting, form: str) -> Candidate:
    """A tree of mode histories: nine rates are known, those between them are learnt."""
    rates_deg_s = np.sort([*_NINE_DEG_S, *_BETWEEN_DEG_S])
    between = np.isin(rates_deg_s, _BETWEEN_DEG_S)
    tree = wl.ModeHistory(
        learning_filter(_NOISE[form]),
        np.deg2rad(rates_deg_s),
        grid_std_rad_s=np.deg2rad(np.where(between, _BETWEEN_STD_DEG_S, _KNOWN_STD_DEG_S)),
        grid_weight=np.where(between, _BETWEEN_WEIGHT, 1.0),
    )
    return Candidate(tree, form)


def mode_history_known(setting: Setting, form: str) -> Candidate:
    """A tree of mode histories over the nine rates alone."""
    return Candidate(wl.ModeHistory(_turning(form), np.deg2rad(_NINE_DEG_S)), form)


def mode_history_rates(setting: Setting, form: str) -> Candidate:
    """The same; histories begin a turn at one of the rates and learn the rate."""
    tree = wl.ModeHistory(learning_filter(_NOISE[form]), np.deg2rad(_NINE_DEG_S))
    return Candidate(tree, form)


def unmixed(setting: Setting, form: str) -> dict[str, Candidate]:
    """IMM5, and estimators with its rates and its chain that mix less and less."""
    filter, rates_rad_s = _turning(form), np.deg2rad(setting.imm5_deg_s)
    chain = wl.ModeChain(sticky_chain(len(rates_rad_s), _STAY))
    apart = partial(
        wl.ModeHistory,
        filter,
        rates_rad_s,
        chain=chain,
        min_segment_s=0.0,
        switch_time_spread=0.0,
        max_hypotheses=100,
        max_branches=200,
    )
    built = {f"gpb{n}": wl.ModeHistory.pseudo_bayes(n, filter, rates_rad_s) for n in (1, 2, 3)} | {
        "histories_joined": apart(),
        "histories_apart": apart(merge_distance=0.0, sibling_distance=0.0),
    }
    return {"imm5": imm5(setting, form)} | {
        name: Candidate(estimator, form) for name, estimator in built.items()
    }


def centre_rates(candidate: Candidate, example: Scenario, z: np.ndarray) -> np.ndarray:
    """Turn rate (R, T) of the middle of three models."""
    return np.asarray(candidate(example, z).turn_rate_rad_s)[..., 1]


def _turning(form: str) -> wl.Ekf:
    return turn_filter(0.0, _NOISE[form])


def estimators(setting: Setting) -> dict[str, Any]:
    """The candidates by name."""
    found = {name: build(setting, POLAR) for name, build in _TABLE.items()}
    converted = {f"{name}_converted": _TABLE[name](setting, CONVERTED) for name in _CONVERTED}
    return found | converted | {"clairvoyant": partial(montecarlo.clairvoyant, sensor=POLAR)}


_TABLE: dict[str, Callable[[Setting, str], Candidate]] = {
    "imm5": imm5,
    "imm9": imm9,
    "agmm": agmm,
    "agmm_printed": agmm_printed,
    "sgmm": sgmm,
    "sgmm_printed": sgmm_printed,
    "sgmm_symmetric": sgmm_symmetric,
    "likely_model_set": likely_model_set,
    "mode_history": mode_history,
    "mode_history_known": mode_history_known,
    "mode_history_rates": mode_history_rates,
}
_CONVERTED = ("imm5", "agmm", "agmm_printed", "sgmm", "sgmm_printed", "sgmm_symmetric")
