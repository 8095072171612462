"""Seeded Monte Carlo runs of estimators on scenarios, and their statistics.

>>> import numpy as np, wakeline as wl
>>> from wakeline import montecarlo, scenario
>>> turning = lambda deg_s: wl.Ekf(wl.CoordinatedTurn(turn_rate_rad_s=np.deg2rad(deg_s)))
>>> imm = wl.Imm([turning(0.0), turning(1.0)], wl.ModeChain.from_sojourn_s([60.0, 60.0]))
>>> result = montecarlo.run(scenario.named("imm-scans"), {"imm2": montecarlo.Candidate(imm)}, 4)
>>> sorted(result["imm-scans", "imm2"].summary())[:2]
['detection_delay_scans', 'failed_runs']
"""

from .bound import bound, bound_curves
from .candidate import Candidate, clairvoyant
from .result import Outcome, Result
from .running import CHUNK_RUNS, run

__all__ = [
    "CHUNK_RUNS",
    "Candidate",
    "Outcome",
    "Result",
    "bound",
    "bound_curves",
    "clairvoyant",
    "run",
]
