"""Studies: the scenarios of papers reproduced, with the papers' figures beside ours.

>>> from wakeline import study
>>> report = study.imm.run(runs=20, seed=0)
>>> report.row("scans", "imm3")["mean_position_m"] < report.row("scans", "imm2")["mean_position_m"]
True

A study is a module with ``STUDY``, a :class:`Study`, whose ``run`` is that of the module, too:
``run(runs, seed, *, full=False, threads=None, progress=False) -> Report``.
"""

from __future__ import annotations

from . import (
    a823,
    ais_forecast,
    association,
    consistency,
    dead_reckoning,
    fusion,
    fuzzy_alpha_beta,
    imm,
    lidar,
    search,
    solent,
    usv_navigation,
    variable_structure,
)
from .base import Picture, Published, Report, Study

__all__ = [
    "Picture",
    "Published",
    "Report",
    "Study",
    "a823",
    "ais_forecast",
    "association",
    "consistency",
    "dead_reckoning",
    "fusion",
    "fuzzy_alpha_beta",
    "imm",
    "lidar",
    "load",
    "names",
    "search",
    "solent",
    "usv_navigation",
    "variable_structure",
]

_STUDIES = {
    module.STUDY.name: module.STUDY
    for module in (
        imm,
        variable_structure,
        fuzzy_alpha_beta,
        solent,
        a823,
        ais_forecast,
        dead_reckoning,
        search,
        usv_navigation,
        association,
        consistency,
        fusion,
        lidar,
    )
}


def names() -> list[str]:
    """Names of the studies."""
    return list(_STUDIES)


def load(name: str) -> Study:
    """A study by name.

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
