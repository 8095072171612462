"""The estimators of the study and what each is told."""

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

from ..estimators import exists, sticky_chain, turn_candidate, turn_filter

LABELS = {
    "imm5": "IMM5",
    "imm9": "IMM9",
    "agmm": "AGMM",
    "sgmm": "SGMM",
    "likely_model_set": "LMS",
    "mode_history": "histories",
    "clairvoyant": "clairvoyant",
    "imm5_converted": "IMM5, converted",
    "agmm_converted": "AGMM, converted",
    "sgmm_converted": "SGMM, converted",
}
COLORS = dict(
    zip(("IMM5", "histories", "AGMM", "SGMM", "LMS", "IMM9"), plot.PALETTE, strict=False),
    clairvoyant=plot.INK,
)

POLAR, CONVERTED = "polar", "converted"
_NOISE = {
    POLAR: PiecewiseAcceleration(std_mps2=0.003),
    CONVERTED: PiecewiseAcceleration(std_mps2=0.05),
}
_STAY = 0.9
_NINE_DEG_S = range(-4, 5)


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
    return turn_candidate(_NINE_DEG_S, _NOISE[form], form, stay=_STAY)


def agmm(setting: Setting, form: str, **options: Any) -> Candidate:
    """Three models whose turn rates move; what is not printed stays at its default."""
    fields = {
        "max_turn_rate_rad_s": np.deg2rad(setting.agmm_max_deg_s),
        "unlikely_threshold": setting.agmm_unlikely,
        "likely_threshold": setting.agmm_likely,
    }
    return Candidate(wl.AdaptiveGridImm(_turning(form), **(fields | options)), form)


def sgmm(setting: Setting, form: str, **options: Any) -> Candidate:
    """A window of three models on the IMM's five rates."""
    rates_rad_s = np.deg2rad(setting.imm5_deg_s)
    return Candidate(wl.SwitchingGridImm(_turning(form), rates_rad_s, **options), form)


def likely_model_set(setting: Setting, form: str) -> Candidate:
    """The likely ones of nine models."""
    return Candidate(wl.LikelyModelSetImm(_turning(form), np.deg2rad(_NINE_DEG_S)), form)


def mode_history(setting: Setting, form: str) -> Candidate:
    """A tree of mode histories over nine rates, at its defaults."""
    rates_rad_s = np.deg2rad(_NINE_DEG_S)
    return Candidate(wl.ModeHistory(_turning(form), rates_rad_s), form, rates_rad_s)


def unmixed(setting: Setting, form: str) -> dict[str, Candidate]:
    """IMM5, and estimators of its rates and its chain that mix less and less."""
    filter, rates_rad_s = _turning(form), np.deg2rad(setting.imm5_deg_s)
    chain = wl.ModeChain(sticky_chain(len(rates_rad_s), _STAY))
    apart = partial(
        wl.ModeHistory, filter, rates_rad_s, chain=chain, min_segment_s=0.0, switch_time_spread=0.0
    )
    built = {f"gpb{n}": wl.ModeHistory.pseudo_bayes(n, filter, rates_rad_s) for n in (1, 2, 3)} | {
        "histories_joined": apart(),
        "histories_apart": apart(merge_distance=0.0),
    }
    return {"imm5": imm5(setting, form)} | {
        name: Candidate(estimator, form, rates_rad_s) for name, estimator in built.items()
    }


def centre_rates(candidate: Candidate, example: Scenario, z: np.ndarray) -> np.ndarray:
    """Turn rate (R, T) of the middle of three models."""
    return np.asarray(candidate(example, z).turn_rate_rad_s)[..., 1]


def _turning(form: str) -> wl.Ekf:
    return turn_filter(0.0, _NOISE[form])


def estimators(setting: Setting) -> dict[str, Any]:
    """The candidates by name."""
    found = {name: build(setting, form) for name, build, form, needs in _TABLE if exists(*needs)}
    return found | {"clairvoyant": partial(montecarlo.clairvoyant, sensor=POLAR)}


_TABLE: tuple[tuple[str, Callable[[Setting, str], Candidate], str, tuple[str, ...]], ...] = (
    ("imm5", imm5, POLAR, ()),
    ("imm9", imm9, POLAR, ()),
    ("agmm", agmm, POLAR, ("AdaptiveGridImm",)),
    ("sgmm", sgmm, POLAR, ("SwitchingGridImm",)),
    ("likely_model_set", likely_model_set, POLAR, ("LikelyModelSetImm",)),
    ("mode_history", mode_history, POLAR, ("ModeHistory",)),
    ("imm5_converted", imm5, CONVERTED, ()),
    ("agmm_converted", agmm, CONVERTED, ("AdaptiveGridImm",)),
    ("sgmm_converted", sgmm, CONVERTED, ("SwitchingGridImm",)),
)
