"""Set and drift from fixes, log and gyro: (16)-(20)."""

from __future__ import annotations

import numpy as np

from wakeline import navigation as nav
from wakeline._units import KNOT_MPS
from wakeline.metrics import rmse
from wakeline.scenario import voyage as sea

FIX_STEP_S, SPEED_MPS = 30.0, 10.0 * KNOT_MPS
WINDOW = 20  # fixes after the first
ALTERATION_MPS = 1.0 * KNOT_MPS


def drift_errors(runs: int, seed: int, fixes: int) -> dict[str, np.ndarray]:
    """Errors (R, fixes) in kn of the drift after each fix that follows the first one.

    The ship holds 10 kn and a random course in each run; log and gyro are read once between fixes.
    """
    current = nav.velocity_mps(sea.CURRENT_MPS, sea.CURRENT_RAD)
    line = _window(fixes)
    found: dict[str, list[np.ndarray]] = {"vector_line": [], "rates": []}
    for run_ in range(runs):
        rng = np.random.default_rng([seed, run_, fixes])
        course = rng.uniform(0.0, 2 * np.pi)
        over_ground = nav.velocity_mps(SPEED_MPS, course) + current
        log = SPEED_MPS + sea.LOG_STD_MPS * rng.standard_normal(fixes + 1)
        gyro = course + sea.GYRO_STD_RAD * rng.standard_normal(fixes + 1)
        fix_m = FIX_STEP_S * np.arange(fixes + 1)[:, None] * over_ground
        fix_m = fix_m + sea.FIX_STD_M * rng.standard_normal(fix_m.shape)
        mean, _ = line.run(FIX_STEP_S, log, gyro, fix_m, sea.FIX_STD_M)
        found["vector_line"].append(mean[1:] - current)
        found["rates"].append(mean_drift_from_rates(log, gyro, fix_m) - current)
    return {
        name: np.hypot(*np.moveaxis(np.array(off), -1, 0)) / KNOT_MPS for name, off in found.items()
    }


def mean_drift_from_rates(log: np.ndarray, gyro: np.ndarray, fix_m: np.ndarray) -> np.ndarray:
    """(T - 1, 2) m/s: the mean drift from the rates of all fixes until then."""
    rates = np.diff(fix_m, axis=0) / FIX_STEP_S
    each = nav.drift_from_rates_mps(rates, log[1:], gyro[1:])
    return np.cumsum(each, axis=0) / np.arange(1, len(fix_m))[:, None]


def drift_in_maneuvers(runs: int, seed: int, dt_s: float) -> tuple[np.ndarray, dict]:
    """Errors of the drift on the voyage, a fix every 30 s, log and gyro read every `dt_s`.

    Returns
    -------
    (time_s, errors)
        Of the fixes from the twentieth after the first on, (K,); by estimator (R, K) in kn.
        ``vector_line`` is the line through the window of 20, ``vector_line_ended`` leaves out the
        steps in which the ship alters, ``rates`` is the mean of the 20 rates (18)-(20), which is
        (16), (17) as printed: the end points.
    """
    truth = sea.reckoning_voyage(dt_s)
    read = truth.read(runs, seed)
    current = nav.velocity_mps(sea.CURRENT_MPS, sea.CURRENT_RAD)
    each = round(FIX_STEP_S / dt_s)
    at_fix = np.arange(len(truth.time_s)) % each == 0
    fix_m = np.where(at_fix[:, np.newaxis], _plane_m(read), np.nan)
    water_m = dt_s * np.stack(
        [read.speed_mps * np.cos(read.course_rad), read.speed_mps * np.sin(read.course_rad)], -1
    )
    water_m[:, 0] = 0.0
    off_m = (fix_m - np.cumsum(water_m, axis=1))[:, at_fix]
    found = {
        name: np.array(
            [
                window.run(dt_s, log, gyro, fixes, sea.FIX_STD_M)[0][at_fix][WINDOW:]
                for log, gyro, fixes in zip(read.speed_mps, read.course_rad, fix_m, strict=True)
            ]
        )
        for name, window in (
            ("vector_line", _window(WINDOW)),
            ("vector_line_ended", _window(WINDOW, ALTERATION_MPS)),
        )
    }
    found["rates"] = (off_m[:, WINDOW:] - off_m[:, :-WINDOW]) / (WINDOW * FIX_STEP_S)
    errors = {
        name: np.hypot(*np.moveaxis(drift - current, -1, 0)) / KNOT_MPS
        for name, drift in found.items()
    }
    return truth.time_s[at_fix][WINDOW:], errors


def rms_of_runs(errors: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """RMS error (R,) by estimator."""
    return {name: rmse(off, axis=-1) for name, off in errors.items()}


def _window(fixes: int, alteration_mps: float = 0.0) -> nav.DriftWindow:
    return nav.DriftWindow(
        max_fixes=fixes + 1,
        log_std_mps=sea.LOG_STD_MPS,
        heading_std_rad=sea.GYRO_STD_RAD,
        alteration_mps=alteration_mps,
    )


def _plane_m(read: sea.VoyageReadings) -> np.ndarray:
    """Fixes (R, T, 2), north and east, each step with its mid-latitude."""
    latitude, longitude = read.latitude_rad, read.longitude_rad
    middle = 0.5 * (latitude[:, 1:] + latitude[:, :-1])
    steps = nav.velocity_from_rates_mps(np.diff(latitude), np.diff(longitude), middle)
    place = np.zeros((*latitude.shape, 2))
    np.cumsum(steps, axis=1, out=place[:, 1:])
    return place
