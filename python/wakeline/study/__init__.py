"""Studies: the scenarios of papers reproduced, with the papers' figures beside ours.

>>> from wakeline import study
>>> report = study.imm.run(runs=20, seed=0)
>>> report.row("scans", "imm3")["mean_position_m"] < report.row("scans", "imm2")["mean_position_m"]
True

A study is a module with a ``SUMMARY`` of one line and a function ``run(runs, seed, *, full=False,
threads=None, progress=False) -> Report``. An exception that ends it early, also a keyboard
interrupt, has the attribute ``result``: a :class:`Report` of the complete rows, without pictures.
"""

from __future__ import annotations

from types import ModuleType

from . import (
    a823,
    ais_forecast,
    dead_reckoning,
    fuzzy_alpha_beta,
    imm,
    solent,
    usv_navigation,
    variable_structure,
)
from .base import Picture, Published, Report

__all__ = [
    "Picture",
    "Published",
    "Report",
    "a823",
    "ais_forecast",
    "dead_reckoning",
    "fuzzy_alpha_beta",
    "imm",
    "load",
    "names",
    "solent",
    "usv_navigation",
    "variable_structure",
]

_STUDIES = {
    "imm": imm,
    "variable-structure": variable_structure,
    "fuzzy-alpha-beta": fuzzy_alpha_beta,
    "solent": solent,
    "a823": a823,
    "ais-forecast": ais_forecast,
    "dead-reckoning": dead_reckoning,
    "usv-navigation": usv_navigation,
}


def names() -> list[str]:
    """Names of the studies."""
    return list(_STUDIES)


def load(name: str) -> ModuleType:
    """The module of a study.

    Parameters
    ----------
    name : str
        One of ``names()``.

    Raises
    ------
    ValueError
        When no study has that name.
    """
    if name not in _STUDIES:
        raise ValueError(f"name must be one of {', '.join(_STUDIES)}, got {name!r}")
    return _STUDIES[name]
