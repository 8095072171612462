# SPDX-FileCopyrightText: 2026 Wakeline developers
# SPDX-License-Identifier: MIT
"""Many runs at once, in lanes and over threads, are the runs one by one."""

from __future__ import annotations

import os
import subprocess
import sys
import threading

import numpy as np
import pytest

import wakeline as wl

RUNS, SCANS, DT_S = 19, 60, 2.5
POLAR = wl.RangeBearing(range_std_m=20.0, bearing_std_rad=np.deg2rad(0.5))
CONVERTED = wl.ConvertedRangeBearing(range_std_m=20.0, bearing_std_rad=np.deg2rad(0.5))
THIN = wl.ConvertedRangeBearing(range_std_m=20.0, bearing_std_rad=1e-7)
DOPPLER = wl.RangeBearingDoppler(
    range_std_m=20.0, bearing_std_rad=np.deg2rad(0.5), range_rate_std_mps=0.3
)
NOISE = wl.WhiteAcceleration(psd_m2s3=0.05)
ARRAYS = ("mean", "covariance", "innovation", "nis", "log_likelihood")


RATES = np.deg2rad([-3.0, 0.0, 3.0])


def turning(rate_deg_s: float) -> wl.CoordinatedTurn:
    return wl.CoordinatedTurn(turn_rate_rad_s=np.deg2rad(rate_deg_s), noise=NOISE)


def imm(*filters) -> wl.Imm:
    k = len(filters)
    stay = np.full((k, k), 0.1 / (k - 1)) + (0.9 - 0.1 / (k - 1)) * np.eye(k)
    return wl.Imm(filters=list(filters), chain=wl.ModeChain(stay))


ESTIMATORS = {
    "ekf_cv": wl.Ekf(wl.ConstantVelocity(noise=NOISE)),
    "ekf_ct": wl.Ekf(turning(1.5)),
    "ekf_ctr": wl.Ekf(wl.CoordinatedTurnRate(noise=NOISE)),
    "ekf_ca": wl.Ekf(wl.ConstantAcceleration()),
    "ekf_singer": wl.Ekf(wl.Singer()),
    "ekf_wandering": wl.Ekf(wl.WanderingCourse()),
    "ukf_ctr": wl.Ukf(wl.CoordinatedTurnRate(noise=NOISE)),
    "ukf_singer": wl.Ukf(wl.Singer()),
    "square_root": wl.SquareRootUkf(wl.CoordinatedTurnRate(noise=NOISE)),
    "imm2": imm(wl.Ekf(wl.ConstantVelocity(noise=NOISE)), wl.Ekf(turning(2.0))),
    "imm3": imm(*(wl.Ekf(turning(w)) for w in (0.0, 1.0, -1.0))),
    "imm4": imm(*(wl.Ekf(turning(w)) for w in (0.0, 1.0, -1.0, 3.0))),
    "imm5": imm(*(wl.Ekf(turning(w)) for w in (0.0, 1.0, -1.0, 2.0, -2.0))),
    "imm_mixed": imm(
        wl.Ekf(wl.ConstantVelocity(noise=NOISE)), wl.Ukf(wl.CoordinatedTurnRate(noise=NOISE))
    ),
    "imm_all_kinds": imm(
        wl.Ekf(wl.ConstantVelocity(noise=NOISE)),
        wl.Ekf(wl.WanderingCourse()),
        wl.Ekf(wl.CoordinatedTurnRate(noise=NOISE)),
        wl.Ukf(wl.ConstantAcceleration()),
        wl.Ekf(wl.Singer()),
    ),
    "imm_of_rates": imm(
        wl.Ekf(wl.CoordinatedTurnRate(noise=NOISE)),
        wl.Ukf(wl.CoordinatedTurnRate(noise=NOISE, turn_rate_psd_rad2s3=1e-6)),
    ),
    "imm_of_ukfs": imm(*(wl.Ukf(turning(w)) for w in (0.0, 2.0, -2.0))),
    "imm_of_pushes": imm(wl.Ekf(wl.ConstantAcceleration()), wl.Ekf(wl.Singer())),
    "imm_with_roots": imm(wl.Ekf(turning(0.0)), wl.SquareRootUkf(turning(2.0))),
    "adaptive": wl.AdaptiveGridImm(wl.Ekf(turning(0.0))),
    "adaptive_printed": wl.AdaptiveGridImm(
        wl.Ekf(turning(0.0)),
        centre_threshold=0.3,
        centre_gain=1.0,
        kept_spacing_rad_s=0.0,
        least_move_rad_s=0.0,
    ),
    "switching": wl.SwitchingGridImm(wl.Ekf(turning(0.0))),
    "likely": wl.LikelyModelSetImm(wl.Ekf(turning(0.0))),
    "mode_history": wl.ModeHistory(wl.Ekf(turning(0.0)), max_branches=100),
    "mode_history_rates": wl.ModeHistory(wl.Ekf(wl.CoordinatedTurnRate(noise=NOISE))),
    "fuzzy": wl.FuzzyAlphaBeta(),
    "fuzzy_of_six": wl.FuzzyAlphaBeta(max_plots=6, hold=False),
    "bayesian": wl.BayesianAlphaBeta(),
    "alpha_beta": wl.AlphaBeta(wl.RangeDependent(alpha_range_m=6e3, beta_range_m=6e3)),
    "alpha_beta_gamma": wl.AlphaBetaGamma(wl.TrackingIndex(0.5)),
    "imm_of_many_kinds": imm(
        wl.Ekf(wl.WanderingCourse()),
        wl.SquareRootUkf(wl.CoordinatedTurnRate(noise=NOISE)),
        wl.Ukf(wl.ConstantAcceleration()),
        wl.Ekf(wl.Singer()),
        *(wl.Ukf(turning(w)) for w in (1.0, -1.0)),
        *(wl.Ekf(turning(w)) for w in (0.0, 3.0, -3.0)),
    ),
    **{
        f"{name}_{kind.__name__.lower()}": build(kind)
        for kind in (wl.Ukf, wl.SquareRootUkf)
        for name, build in {
            "adaptive": lambda kind: wl.AdaptiveGridImm(kind(turning(0.0))),
            "switching": lambda kind: wl.SwitchingGridImm(kind(turning(0.0))),
            "likely": lambda kind: wl.LikelyModelSetImm(kind(turning(0.0))),
            "mode_history": lambda kind: wl.ModeHistory(kind(turning(0.0)), RATES),
            "mode_history_rates": lambda kind: wl.ModeHistory(
                kind(wl.CoordinatedTurnRate(noise=NOISE)), RATES
            ),
        }.items()
    },
}
UNSCENTED_TURNS = [name for name in ESTIMATORS if name.endswith("ukf")]  # of either kind
LINES = ["fuzzy", "bayesian", "alpha_beta", "alpha_beta_gamma"]
DOPPLER_ESTIMATORS = [
    "ekf_cv",
    "ekf_ct",
    "ekf_ctr",
    "ekf_ca",
    "ekf_singer",
    "ekf_wandering",
    "ukf_ctr",
    "ukf_singer",
    "imm2",
    "imm5",
    "imm_mixed",
    *LINES,
]


def recordings(seed: int = 3, range_rates: bool = False) -> np.ndarray:
    """Plots of vessels that turn here and there; some scans are missed."""
    rng = np.random.default_rng(seed)
    course = rng.uniform(-np.pi, np.pi, RUNS)[:, None] + np.cumsum(
        np.where(np.arange(SCANS) > 25, np.deg2rad(2.0), 0.0)
    )
    place = 4000.0 + np.cumsum(25.0 * np.stack([np.cos(course), np.sin(course)], -1), axis=1)
    polar = np.stack([np.hypot(*place.T).T, np.arctan2(place[..., 1], place[..., 0])], -1)
    range_rate = 25.0 * np.cos(course - polar[..., 1])
    polar += rng.normal(size=polar.shape) * [20.0, np.deg2rad(0.5)]
    if range_rates:
        range_rate += rng.normal(size=range_rate.shape) * 0.3
        polar = np.concatenate([polar, range_rate[..., None]], -1)
    polar[rng.random((RUNS, SCANS)) < 0.08] = np.nan
    return polar


def start() -> wl.Gaussian:
    return wl.Gaussian([4000.0, 0.0, 4000.0, 0.0], np.diag([1e6, 100.0, 1e6, 100.0]))


def run(estimator, z, sensor=POLAR, begin=None, **more):
    return estimator.run(z, dt_s=DT_S, sensor=sensor, start=begin or start(), **more)


def assert_near(many, one, k: int, relative: float = 1e-11, of_modes: float = 0.0) -> None:
    """Run k of `many` is `one`, to rounding."""
    np.testing.assert_array_equal(many.status[k], one.status)
    for name in ARRAYS:
        a, b = getattr(many, name)[k], getattr(one, name)
        np.testing.assert_array_equal(np.isnan(a), np.isnan(b))
        scale = np.nanmax(np.abs(b))
        np.testing.assert_allclose(a, b, rtol=0, atol=relative * scale, err_msg=name)
    if one.mode_probability is not None:
        np.testing.assert_allclose(
            many.mode_probability[k], one.mode_probability, rtol=0, atol=max(relative, of_modes)
        )
    if one.turn_rate_rad_s is not None:
        np.testing.assert_allclose(
            many.turn_rate_rad_s[k], one.turn_rate_rad_s, rtol=0, atol=relative, equal_nan=True
        )


@pytest.fixture
def restored_threads():
    before = wl.threads()
    yield
    wl.set_threads(before)


@pytest.mark.parametrize("name", ESTIMATORS)
@pytest.mark.parametrize("sensor", [POLAR, CONVERTED], ids=["polar", "converted"])
def test_runs_at_once_are_the_runs_one_by_one(name, sensor):
    z = recordings()
    many = run(ESTIMATORS[name], z, sensor)
    for k in range(RUNS):
        assert_near(many, run(ESTIMATORS[name], z[k], sensor), k)


@pytest.mark.parametrize("name", DOPPLER_ESTIMATORS)
def test_runs_of_range_rates_are_the_runs_one_by_one(name):
    """To ten times the rounding of plots: range rates are sharper; modes, by likelihoods, more."""
    z = recordings(range_rates=True)
    moving = {
        "own_position_m": np.cumsum(np.full((SCANS, 2), 0.1 * DT_S), axis=0),
        "own_velocity_mps": np.full((SCANS, 2), 0.1),
        "gate": wl.RadiusGate(radius_m=400.0),
    }
    for more in ({}, moving):
        many = run(ESTIMATORS[name], z, DOPPLER, **more)
        for k in range(RUNS):
            one = run(ESTIMATORS[name], z[k], DOPPLER, **more)
            assert_near(many, one, k, relative=1e-10, of_modes=1e-9)


@pytest.mark.parametrize("name", ESTIMATORS)
def test_filters_imms_and_mode_histories_run_in_lanes(name):
    kinds = (wl.Ekf, wl.Ukf, wl.SquareRootUkf, wl.Imm, wl.ModeHistory)
    expected = wl.lanes() if isinstance(ESTIMATORS[name], kinds) else 1
    for sensor in (POLAR, CONVERTED):
        assert run(ESTIMATORS[name], recordings(), sensor).lanes == expected


@pytest.mark.parametrize("name", ESTIMATORS)
def test_a_single_recording_and_range_rates_have_no_lanes(name):
    assert run(ESTIMATORS[name], recordings()[0]).lanes == 1
    assert run(ESTIMATORS[name], recordings(range_rates=True), DOPPLER).lanes == 1


def test_starts_of_several_layouts_have_no_lanes():
    wide = wl.Gaussian([4000.0, 0.0, 4000.0, 0.0, 0.0], np.diag([1e6, 100.0, 1e6, 100.0, 1e-4]))
    mixed = [start()] * (RUNS - 1) + [wide]
    assert run(ESTIMATORS["ekf_ctr"], recordings(), begin=mixed).lanes == 1
    assert run(ESTIMATORS["ekf_ctr"], recordings(), begin=[wide] * RUNS).lanes == wl.lanes()


@pytest.mark.skipif(wl.lanes() == 1, reason="one run after the other on this processor")
@pytest.mark.parametrize("name", ["ekf_ct", "imm3", "imm_all_kinds", "mode_history"])
def test_lanes_round_otherwise_than_single_runs(name):
    """So that `lanes` is what was done."""
    z = recordings()
    many = run(ESTIMATORS[name], z)
    assert any(
        np.any(many.covariance[k] != run(ESTIMATORS[name], z[k]).covariance) for k in range(RUNS)
    )


@pytest.mark.parametrize("name", ["square_root", "adaptive", "mode_history", "fuzzy"])
def test_without_lanes_runs_have_the_bits_of_single_ones(name):
    z = recordings(range_rates=True)
    many = run(ESTIMATORS[name], z, DOPPLER)
    one = run(ESTIMATORS[name], z[4], DOPPLER)
    np.testing.assert_array_equal(many.mean[4], one.mean)


@pytest.mark.parametrize("name", ["imm3", "imm_of_many_kinds", *UNSCENTED_TURNS, *LINES])
def test_each_run_has_its_own_start(name):
    z = recordings()
    starts = [
        wl.Gaussian([4000.0 + 10.0 * k, k, 4000.0, -k], (1.0 + k) * np.diag([1e4, 9.0, 1e4, 9.0]))
        for k in range(RUNS)
    ]
    many = run(ESTIMATORS[name], z, begin=starts)
    for k in range(RUNS):
        assert_near(many, run(ESTIMATORS[name], z[k], begin=starts[k]), k)


@pytest.mark.parametrize("name", ["imm3", "imm_of_many_kinds", *UNSCENTED_TURNS, *LINES])
def test_plots_as_thin_as_a_line_are_taken_in_lanes(name):
    """Their covariances are all but singular, which magnifies rounding."""
    z = recordings()[:, :20]
    many = run(ESTIMATORS[name], z, THIN)
    for k in range(RUNS):
        assert_near(many, run(ESTIMATORS[name], z[k], THIN), k, relative=1e-6)


@pytest.mark.parametrize("name", ["imm3", "imm_of_many_kinds", *UNSCENTED_TURNS, *LINES])
def test_a_reading_that_fails_does_so_in_its_run_only(name):
    z = recordings()
    sound = run(ESTIMATORS[name], z)
    z[3, 10] = [np.inf, 0.5]
    many = run(ESTIMATORS[name], z)
    assert_near(many, run(ESTIMATORS[name], z[3]), 3)
    others = np.arange(RUNS) != 3
    assert many.status[3, 10] == int(wl.Status.not_finite)
    np.testing.assert_array_equal(many.mean[others], sound.mean[others])
    np.testing.assert_array_equal(many.covariance[others], sound.covariance[others])


def test_a_start_that_is_none_is_named():
    starts = [start()] * RUNS
    starts[7] = wl.Gaussian([0.0] * 4, -np.eye(4))
    with pytest.raises(wl.FilterError, match="run 7"):
        run(ESTIMATORS["imm3"], recordings(), begin=starts)


@pytest.mark.parametrize(
    "name",
    [
        "ekf_ct",
        "ukf_ctr",
        "imm3",
        "imm_mixed",
        "imm_all_kinds",
        "switching",
        "mode_history",
        *UNSCENTED_TURNS,
        *LINES,
    ],
)
def test_results_do_not_depend_on_threads(name, restored_threads):
    z = np.tile(recordings(), (8, 1, 1))
    wl.set_threads(1)
    one = run(ESTIMATORS[name], z)
    wl.set_threads(3)
    three = run(ESTIMATORS[name], z)
    for array in ARRAYS:
        np.testing.assert_array_equal(getattr(one, array), getattr(three, array))


@pytest.mark.parametrize(
    "name",
    [
        "ekf_ctr",
        "ukf_ctr",
        "imm3",
        "imm4",
        "imm_all_kinds",
        "imm_of_many_kinds",
        "adaptive",
        "switching",
        *UNSCENTED_TURNS,
        *LINES,
    ],
)
def test_runs_do_not_depend_on_their_neighbours(name):
    z = recordings()
    order = np.random.default_rng(0).permutation(RUNS)
    shuffled = run(ESTIMATORS[name], z[order])
    plain = run(ESTIMATORS[name], z)
    for array in ARRAYS:
        np.testing.assert_array_equal(getattr(shuffled, array), getattr(plain, array)[order])


@pytest.mark.parametrize("name", ["imm3", *UNSCENTED_TURNS, *LINES])
def test_own_ship_and_gate_and_control_hold_in_lanes(name):
    z = recordings()
    more = {
        "own_position_m": np.cumsum(np.full((SCANS, 2), 5.0), axis=0) - 100.0,
        "acceleration_mps2": np.full((SCANS, 2), 0.01),
        "gate": wl.RadiusGate(radius_m=400.0),
    }
    many = run(ESTIMATORS[name], z, **more)
    for k in range(RUNS):
        assert_near(many, run(ESTIMATORS[name], z[k], **more), k)


def test_calls_from_many_threads_share_the_threads(restored_threads):
    z = np.tile(recordings(), (4, 1, 1))
    expected = run(ESTIMATORS["imm3"], z)
    results = []
    callers = [
        threading.Thread(target=lambda: results.append(run(ESTIMATORS["imm3"], z)))
        for _ in range(6)
    ]
    for caller in callers:
        caller.start()
    for caller in callers:
        caller.join()
    assert len(results) == 6
    for result in results:
        np.testing.assert_array_equal(result.mean, expected.mean)


def test_a_run_is_its_own_while_another_thread_steps_its_estimator():
    estimator = wl.LikelyModelSetImm(
        wl.Ukf(turning(0.0)), unlikely_threshold=0.1, likely_threshold=0.3
    )
    start = wl.Gaussian([4000.0, 6.0, 3000.0, -8.0], np.diag([2500.0, 4.0, 2500.0, 4.0]))
    z = np.tile([5000.0, np.arctan2(3.0, 4.0), 0.0], (1500, 1, 1))
    wanted = estimator.run(z, dt_s=DT_S, sensor=DOPPLER, start=start)
    done = threading.Event()

    def step():
        while not done.is_set():
            estimator.start(start)
            for k in range(1, 6):
                estimator.predict(DT_S)
                estimator.update(CONVERTED, [5000.0, np.arctan2(3000 - 8 * k, 4000 + 6 * k)])

    stepping = threading.Thread(target=step)
    stepping.start()
    try:
        for _ in range(10):
            got = estimator.run(z, dt_s=DT_S, sensor=DOPPLER, start=start)
            np.testing.assert_array_equal(got.mean, wanted.mean)
    finally:
        done.set()
        stepping.join()


def test_the_number_of_threads_is_reported_and_set(restored_threads):
    wl.set_threads(2)
    assert wl.threads() == 2
    with pytest.raises(ValueError, match="threads must be at least 1, got 0"):
        wl.set_threads(0)
    assert wl.lanes() in (1, 2, 4, 8)


FEW_THREADS = """
import resource
import numpy as np
import wakeline as wl
wl.set_threads(64)
filters = [wl.Ekf(wl.ConstantVelocity()), wl.SquareRootUkf(wl.CoordinatedTurnRate())]
imm = wl.Imm(filters, wl.ModeChain.from_sojourn_s([60.0, 30.0]))
start = wl.Gaussian([9.0, 0.0, 1.0, 0.0], np.eye(4))
z = np.tile([9.0, 0.1, 0.0], (400, 60, 1))
run = lambda: imm.run(z, 3.0, wl.RangeBearingDoppler(), start)
wanted = run().mean
with open("/proc/self/statm") as file:
    in_use = int(file.read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (in_use + 2**26, in_use + 2**26))
print((run().mean == wanted).all())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="limits memory as Linux does")
def test_where_there_are_no_more_threads_those_that_there_are_do_all():
    done = subprocess.run(
        [sys.executable, "-c", FEW_THREADS], check=False, capture_output=True, text=True
    )
    assert done.stdout == "True\n", done.stderr


def test_the_environment_limits_the_threads():
    reported = subprocess.run(
        [sys.executable, "-c", "import wakeline; print(wakeline.threads())"],
        env=os.environ | {"WAKELINE_THREADS": "5", "OMP_NUM_THREADS": "7"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert reported.stdout.strip() == "5"
