"""What the paper and an independent program report of 500 runs."""

from __future__ import annotations

from ..base import Published

_ORDER = ("peak_position_m", "peak_velocity_mps", "mean_position_m", "mean_velocity_mps")
_SILENT = float("nan")

PAPER = Published(
    _ORDER,
    {
        ("example1", "imm5"): (69.52, 4.74, 17.62, 0.91),
        ("example1", "agmm_printed"): (39.92, 3.26, 10.21, 0.75),
        ("example1", "sgmm_printed"): (43.12, 3.31, 13.25, 0.74),
        ("example2", "imm5"): (80.66, 7.83, 23.15, 2.08),
        ("example2", "agmm_printed"): (51.83, 6.68, 11.37, 1.36),
        ("example2", "sgmm_printed"): (48.5, 5.9, 11.55, 1.40),
    },
)
REFERENCE = Published(
    _ORDER,
    {
        ("example1", "bound"): (23.5, 1.40, 9.7, 0.14),
        ("example1", "clairvoyant"): (20.9, 0.56, 9.1, 0.10),
        ("example1", "imm5_converted"): (35.4, 3.06, 26.1, 1.80),
        ("example1", "agmm_printed_converted"): (37.0, 3.95, 28.3, 2.61),
        ("example1", "sgmm_symmetric_converted"): (42.2, 3.53, 25.7, 1.65),
        ("example1", "imm5"): (34.5, 3.05, 25.4, 1.79),
        ("example1", "mode_history_known"): (34.1, 2.87, 17.8, 1.37),
        ("example2", "bound"): (22.4, 1.38, 12.8, 0.22),
        ("example2", "clairvoyant"): (18.7, 0.47, 11.8, 0.15),
        ("example2", "imm5_converted"): (48.8, 7.86, 27.6, 2.64),
        ("example2", "agmm_printed_converted"): (102.0, 11.2, 48.0, 5.24),
        ("example2", "sgmm_symmetric_converted"): (242.0, 15.8, 55.0, 4.22),
        ("example2", "imm5"): (47.1, 7.60, 26.1, 2.59),
        ("example2", "mode_history_known"): (49.6, 7.38, 21.8, 2.22),
        ("random", "clairvoyant"): (_SILENT, _SILENT, 9.9, 0.14),
        ("random", "imm5"): (_SILENT, _SILENT, 29.8, 2.61),
        ("random", "imm9"): (_SILENT, _SILENT, 28.8, 2.46),
        ("random", "mode_history_known"): (_SILENT, _SILENT, 26.7, 2.19),
        ("random", "mode_history_rates"): (_SILENT, _SILENT, 23.1, 1.76),
    },
)
