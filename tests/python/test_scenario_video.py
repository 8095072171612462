"""Simulated radar video: noise, sea, land and echoes follow their documented statistics."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wakeline.scenario import (
    HardTurn,
    Land,
    RadarVideoSimulator,
    SeaClutter,
    Truth,
    VideoTarget,
    radar_screen,
    small_craft_scene,
    strait_scene,
)
from wakeline.scenario.video.fields import GammaTexture

TURN = 2 * np.pi
SWEEPS = 2048
STEP = TURN / SWEEPS


def radar(**settings):
    """A narrow piece of a 16-bit radar far out, without sea; noise of 20 counts."""
    usual = {
        "sweeps_per_turn": SWEEPS,
        "cells": 200,
        "cell_m": 6.0,
        "start_range_m": 4800.0,
        "beam_width_rad": 5 * STEP,
        "pulse_length_m": 15.0,
        "noise_rms": 20.0,
        "bits": 16,
        "sector_rad": (1.0, 1.0 + 100 * STEP),
    }
    return RadarVideoSimulator(**(usual | settings))


def at(range_m, azimuth_rad, **hull):
    """A target at rest."""
    north_m, east_m = range_m * np.cos(azimuth_rad), range_m * np.sin(azimuth_rad)
    return VideoTarget(truth=Truth([north_m, 0.0, east_m, 0.0]), **hull)


def middle_of(simulator, sweep=50, cell=100):
    """Range and azimuth of a cell's centre."""
    return simulator.grid.range_m[cell], simulator.grid.azimuth_rad[sweep]


def power(video, simulator):
    """Power of every cell over that of the noise."""
    return (video.amplitude / simulator.noise_rms) ** 2


def centroid(video):
    """Azimuth and range weighted by power, of cells above a thousandth of the strongest."""
    weight = video.amplitude.astype(float) ** 2
    weight[weight < 1e-3 * weight.max()] = 0.0
    strongest = video.azimuth_rad[np.argmax(weight.max(axis=1))]
    off = (video.azimuth_rad - strongest + np.pi) % TURN - np.pi
    weight /= weight.sum()
    return strongest + np.sum(weight.sum(axis=1) * off), np.sum(weight.sum(axis=0) * video.range_m)


# Noise and the receiver ---------------------------------------------------------------------------


def test_noise_alone_is_rayleigh_with_the_rms_that_was_set():
    simulator = radar(noise_rms=1000.0, cells=1000, sector_rad=(1.0, 2.0))
    amplitude = np.sort(simulator.turn(rng=1).amplitude.ravel() / 1000.0)
    n = len(amplitude)
    assert np.mean(amplitude) == pytest.approx(np.sqrt(np.pi) / 2, rel=4 * 0.52 / np.sqrt(n))
    assert np.mean(amplitude**2) == pytest.approx(1.0, rel=4 / np.sqrt(n))
    assert np.mean(amplitude**4) == pytest.approx(2.0, rel=4 * np.sqrt(5 / n))
    distance = np.max(np.abs(np.arange(1, n + 1) / n - (1 - np.exp(-(amplitude**2)))))
    assert distance < 2.2 / np.sqrt(n)


def test_noise_is_independent_from_cell_to_cell_and_from_scan_to_scan():
    simulator = radar(noise_rms=500.0)
    first, second = (power(video, simulator) - 1.0 for video in simulator.turns(scans=2, seed=4))
    allowed = 4 / np.sqrt(first.size)
    for one, other in (
        (first, second),
        (first[:, 1:], first[:, :-1]),
        (first[1:], first[:-1]),
    ):
        assert abs(np.mean(one * other)) < allowed


@pytest.mark.parametrize(("bits", "dtype", "full"), [(8, np.uint8, 255), (16, np.uint16, 65535)])
def test_a_strong_echo_is_cut_off_at_full_scale(bits, dtype, full):
    simulator = radar(bits=bits, snr_db=200.0)
    video = simulator.turn([at(*middle_of(simulator))])
    assert video.amplitude.dtype == dtype
    assert video.amplitude.max() == full
    assert simulator.full_scale == full


def test_the_logarithmic_receiver_has_noise_and_full_scale_where_it_says():
    simulator = radar(
        bits=8, receiver="logarithmic", noise_rms=50.0, dynamic_range_db=40.0, sector_rad=(0, 1)
    )
    amplitude = np.array([0.0, 1.0, 10.0, 100.0, 1e6], np.float32)
    assert simulator.received(amplitude).tolist() == [0, 50, 152, 255, 255]


def test_the_linear_receiver_is_linear():
    simulator = radar(bits=8, noise_rms=8.0)
    amplitude = np.array([0.0, 1.0, 10.0, 100.0], np.float32)
    assert simulator.received(amplitude).tolist() == [0, 8, 80, 255]


# Sweeps, sectors, seeds ---------------------------------------------------------------------------


def test_sweeps_have_the_azimuths_and_times_of_a_turning_antenna():
    simulator = radar(sector_rad=None, cells=4)
    video = list(simulator.turns(scans=3, start_time_s=10.0))[2]
    share = (np.arange(SWEEPS) + 0.5) / SWEEPS
    np.testing.assert_allclose(video.azimuth_rad, TURN * share)
    np.testing.assert_allclose(video.time_s, 16.0 + 3.0 * share)
    assert (video.start_range_m, video.cell_m) == (4800.0, 6.0)
    assert video.azimuth_width_rad == pytest.approx(STEP)


@pytest.mark.parametrize("sector", [(1.0, 1.3), (0.0, 0.1), (6.2, TURN), (3.0, 3.0 + STEP)])
def test_a_sector_has_the_sweeps_of_the_whole_turn(sector):
    whole, part = (radar(sector_rad=s, cells=4).turn(rng=1) for s in (None, sector))
    inside = (whole.azimuth_rad >= sector[0] - 1e-9) & (whole.azimuth_rad < sector[1] - 1e-9)
    np.testing.assert_allclose(part.azimuth_rad, whole.azimuth_rad[inside])
    np.testing.assert_allclose(part.time_s, whole.time_s[inside])


@pytest.mark.parametrize(("sector", "begin_s"), [((-0.1, 0.1), -0.1), ((6.2, 0.1), 6.2)])
def test_a_sector_across_north_is_one_piece(sector, begin_s):
    video = radar(sector_rad=sector, cells=4).turn()
    assert (np.diff(video.time_s) > 0).all()
    assert video.time_s[0] == pytest.approx(3.0 * begin_s / TURN, abs=0.002)
    assert ((0 <= video.azimuth_rad) & (video.azimuth_rad < TURN)).all()
    np.testing.assert_allclose(np.diff(video.azimuth_rad) % TURN, STEP)


def sea_and_land():
    outline = [[2500, 3600], [2500, 4400], [3500, 4400], [3500, 3600]]
    land = Land(where=[outline], clutter_to_noise_db=10.0, correlation_m=60.0, penetration_m=300.0)
    return radar(sea=SeaClutter(), land=land)


def test_the_same_seed_gives_the_same_bits():
    simulator = sea_and_land()
    targets = {"one": at(*middle_of(simulator), length_m=40.0, swerling=2)}
    for first, second in zip(
        simulator.turns(targets, 3, 7), simulator.turns(targets, 3, 7), strict=True
    ):
        np.testing.assert_array_equal(first.amplitude, second.amplitude)
    once = simulator.turn(list(targets.values()), rng=7)
    np.testing.assert_array_equal(
        once.amplitude, next(simulator.turns(targets, 1, np.random.default_rng(7))).amplitude
    )


def test_different_seeds_are_independent():
    simulator = radar(sea=SeaClutter(correlation_m=15.0, clutter_to_noise_db=20.0))
    one, other = (power(simulator.turn(rng=seed), simulator) for seed in (1, 2))
    assert abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < 0.05


def test_a_target_changes_nothing_of_noise_and_clutter_away_from_it():
    simulator = sea_and_land()
    without, with_it = (
        simulator.turn(targets, rng=3).amplitude
        for targets in ((), [at(*middle_of(simulator), rcs_m2=1e4)])
    )
    changed = np.argwhere(without != with_it)
    assert len(changed) > 50
    np.testing.assert_allclose(changed.mean(axis=0), [50, 100], atol=2)
    assert (np.ptp(changed, axis=0) < [25, 20]).all()


def test_a_radar_around_places_sees_them_all_in_cells_of_the_whole():
    whole = radar(sector_rad=None, start_range_m=0.0, cells=2000)
    rng = np.random.default_rng(0)
    for middle in np.exp(1j * rng.uniform(0, TURN, 20)):
        place = 6000.0 * middle + rng.uniform(-900, 900, 9) + 1j * rng.uniform(-900, 900, 9)
        part = whole.around(np.column_stack([place.real, place.imag]), 100.0)
        grid = part.grid
        off = (np.angle(place)[:, None] - grid.azimuth_rad[[0, -1]] + np.pi) % TURN - np.pi
        assert (off[:, 0] > 100 / np.abs(place) - STEP).all()
        assert (off[:, 1] < STEP - 100 / np.abs(place)).all()
        assert (np.abs(place) - grid.range_m[0] > 90).all()
        assert (grid.range_m[-1] - np.abs(place) > 90).all()
        assert part.start_range_m % 6.0 == 0.0


# Windows ------------------------------------------------------------------------------------------

SAILING = Truth([6000.0 * np.cos(1.12), -4.0, 6000.0 * np.sin(1.12), 3.0])


def sea_radar(**settings):
    sea = SeaClutter(clutter_to_noise_db=20.0, decay=0.0, upwind_downwind_db=0.0, shape=1.0)
    return radar(sea=sea, cells=400, sector_rad=(1.0, 1.3), **settings)


def places_of(window, simulator):
    """First sweep and first cell of a window in the picture."""
    sweep = (window.azimuth_rad[0] - simulator.grid.azimuth_rad[0]) / STEP
    cell = (window.start_range_m - simulator.start_range_m) / simulator.cell_m
    assert sweep == pytest.approx(round(sweep), abs=1e-6)
    assert cell == pytest.approx(round(cell), abs=1e-6)
    return round(sweep), round(cell)


def spread(windows, simulator):
    """(T, N, C) power of every cell, NaN outside of the window."""
    whole = np.full((len(windows), *simulator.grid.shape), np.nan)
    for picture, window in zip(whole, windows, strict=True):
        sweep, cell = places_of(window, simulator)
        sweeps, cells = window.amplitude.shape
        picture[sweep : sweep + sweeps, cell : cell + cells] = power(window, simulator)
    return whole


def follow(simulator, scans, margin_m, seed=1, targets=(), around=SAILING):
    looks = simulator.windows({0: targets}, scans, seed, around=around, margin_m=margin_m)
    return [look[0] for look in looks]


def test_a_window_as_large_as_the_picture_is_the_picture():
    land = Land(where=[[(4000.0, 4000.0), (4000.0, 6000.0), (2500.0, 6000.0)]], shape=1.0)
    simulator = sea_radar(land=land)
    boat = VideoTarget(truth=SAILING, length_m=15.0, beam_m=4.0)
    windows = follow(simulator, 3, 1e5, targets=[boat])
    for window, turn in zip(windows, simulator.turns([boat], 3, seed=1), strict=True):
        np.testing.assert_array_equal(window.amplitude, turn.amplitude)
        np.testing.assert_array_equal(window.azimuth_rad, turn.azimuth_rad)
        np.testing.assert_array_equal(window.time_s, turn.time_s)
        assert window.start_range_m == turn.start_range_m


def test_a_window_follows_its_vessel_and_shows_its_echo_as_the_picture_does():
    simulator = radar(cells=400, sector_rad=(1.0, 1.3), snr_db=50.0, noise_rms=1.0)
    boat = VideoTarget(truth=SAILING, length_m=15.0, beam_m=4.0)
    windows = follow(simulator, 40, 150.0, targets=[boat])
    shapes = {window.amplitude.shape for window in windows}
    assert len(shapes) == 1
    for window, turn in zip(windows, simulator.turns([boat], 40, seed=1), strict=True):
        sweep, cell = places_of(window, simulator)
        sweeps, cells = window.amplitude.shape
        part = turn.amplitude[sweep : sweep + sweeps, cell : cell + cells]
        difference = window.amplitude.astype(int) - part.astype(int)
        assert part.max() > 100
        assert np.abs(difference).max() < 12  # of noise alone
        state = SAILING.state_at(window.time_s.mean())[0]
        assert window.range_m.mean() == pytest.approx(np.hypot(state[0], state[2]), abs=6.0)


@pytest.mark.parametrize("shape", [0.5, 2.0])
def test_clutter_in_a_window_has_the_statistics_of_the_picture(shape):
    """Moments, correlation within a scan, and patches that stay where they are between scans."""
    simulator = sea_radar()
    simulator = replace(simulator, sea=replace(simulator.sea, shape=shape, correlation_s=6.0))
    measured = []
    for seed in range(3):
        windows = spread(follow(simulator, 30, 200.0, seed=2 * seed), simulator)
        pictures = np.array([power(v, simulator) for v in simulator.turns((), 30, 2 * seed + 1)])
        measured.append([statistics_of(windows), statistics_of(pictures)])
    in_windows, in_pictures = np.mean(measured, axis=0)
    np.testing.assert_allclose(in_windows[0], in_pictures[0], rtol=0.06)
    np.testing.assert_allclose(in_windows[1:], in_pictures[1:], rtol=0.2, atol=0.02)


def statistics_of(power_of_cells):
    """Mean power, and relative to it the variance and correlations over cells and scans."""
    mean = np.nanmean(power_of_cells)
    off = power_of_cells / mean - 1.0
    return [
        mean,
        np.nanmean(off**2),
        np.nanmean(off[:, 3:] * off[:, :-3]),
        np.nanmean(off[:, :, 6:] * off[:, :, :-6]),
        np.nanmean(off[1:] * off[:-1]),
        np.nanmean(off[2:] * off[:-2]),
    ]


def test_land_in_a_window_is_that_of_the_picture():
    land = Land(
        where=lambda north, east: east > 4000.0, clutter_to_noise_db=60.0, decay=0.0, fluctuation=0
    )
    simulator = radar(land=land, cells=400, sector_rad=(1.0, 1.3), noise_rms=1.0)
    (turn,) = simulator.turns((), 1, seed=1)
    (window,) = follow(simulator, 1, 150.0)
    sweep, cell = places_of(window, simulator)
    sweeps, cells = window.amplitude.shape
    part = turn.amplitude[sweep : sweep + sweeps, cell : cell + cells].astype(int)
    assert part.max() > 300
    assert np.abs(window.amplitude - part).max() < 12


def test_cases_have_the_same_sea_and_the_same_craft():
    simulator = sea_radar()
    boat = VideoTarget(truth=SAILING, length_m=15.0, beam_m=4.0)
    beside = replace(boat, truth=Truth(SAILING.state_at(0.0)[0] + [0.0, 0.0, 80.0, 0.0]))
    cases = {"alone": [boat], "met": [boat, beside], "nobody": []}
    looks = list(simulator.windows(cases, 3, seed=4, around=SAILING, margin_m=150.0))
    for case, targets in cases.items():
        own = follow(simulator, 3, 150.0, seed=4, targets=targets)
        for look, window in zip(looks, own, strict=True):
            np.testing.assert_array_equal(look[case].amplitude, window.amplitude)
    assert (looks[0]["met"].amplitude != looks[0]["alone"].amplitude).any()


@pytest.mark.parametrize("veast_mps", [-15.0, 15.0])
@pytest.mark.parametrize("sector", [(-0.2, 0.2), (6.1, 0.2), None])
def test_a_window_follows_across_north(veast_mps, sector):
    simulator = radar(cells=400, sector_rad=sector)
    craft = Truth([6000.0, 0.0, -10.0 * veast_mps, veast_mps])
    windows = follow(simulator, 7, 150.0, around=craft)
    for window in windows:
        middle = len(window) // 2
        north_m, _, east_m, _ = craft.state_at(window.time_s[middle])[0]
        off_rad = np.arctan2(east_m, north_m) - window.azimuth_rad[middle]
        reach = (off_rad + np.pi) % TURN - np.pi
        assert abs(reach) < (0.6 if sector else 0.5 * len(window) + 1.0) * STEP


def test_a_window_needs_a_vessel_in_the_picture_and_a_margin():
    away = Truth([-6000.0, 0.0, 0.0, 0.0])
    with pytest.raises(ValueError, match="around must be a vessel inside the simulated picture"):
        follow(sea_radar(), 1, 100.0, around=away)
    with pytest.raises(ValueError, match="margin_m"):
        follow(sea_radar(), 1, 0.0)


# Sea clutter --------------------------------------------------------------------------------------


def flat_sea(**settings):
    """A sea of the same mean everywhere, far above the noise."""
    usual = {
        "clutter_to_noise_db": 40.0,
        "decay": 0.0,
        "upwind_downwind_db": 0.0,
        "correlation_m": 30.0,
        "correlation_s": 0.01,
    }
    sea = SeaClutter(**(usual | settings))
    return radar(
        sea=sea, beam_width_rad=1.1 * STEP, pulse_length_m=6.0, sector_rad=(1.0, 1.0 + 300 * STEP)
    )


def scans_of(simulator, scans, seed=1):
    return np.array([power(v, simulator) for v in simulator.turns(scans=scans, seed=seed)])


@pytest.mark.parametrize("shape", [0.5, 2.0, np.inf])
def test_clutter_has_the_moments_of_the_k_distribution(shape):
    clutter = scans_of(flat_sea(shape=shape), 12)
    assert clutter.mean() == pytest.approx(1e4, rel=0.03)
    ratio = np.mean(clutter**2) / clutter.mean() ** 2
    assert ratio == pytest.approx(2 * (1 + 1 / shape), rel=0.06)


@pytest.mark.parametrize("shape", [0.05, 0.3, 1.0, 30.0, 1e5])
def test_a_texture_has_mean_1_and_the_variance_that_was_set(shape):
    rng = np.random.default_rng(1)
    texture = GammaTexture(shape).amplitude(rng.standard_normal(400_000, np.float32)) ** 2
    assert texture.mean() == pytest.approx(1.0, abs=5 / np.sqrt(shape * 400_000) + 1e-3)
    assert texture.var() == pytest.approx(1.0 / shape, rel=0.05 + 0.02 / shape)


@pytest.mark.parametrize("shape", [0.5, 2.0])
def test_patches_are_as_long_along_the_beam_and_across_it_as_they_were_set(shape):
    simulator = flat_sea(shape=shape, correlation_m=60.0)
    clutter = scans_of(simulator, 16) / 1e4 - 1.0
    wanted = np.exp(-1.0) / shape
    along = np.mean(clutter[:, :, 10:] * clutter[:, :, :-10])
    assert along == pytest.approx(wanted, rel=0.15)
    for cells in (slice(0, 50), slice(150, 200)):
        range_m = simulator.grid.range_m[cells].mean()
        lag = 60.0 / (range_m * STEP)
        low = int(lag)
        near, far = (
            np.mean(clutter[:, n:, cells] * clutter[:, :-n, cells]) for n in (low, low + 1)
        )
        assert np.interp(lag, [low, low + 1], [near, far]) == pytest.approx(wanted, rel=0.25)


def test_patches_live_for_the_time_that_was_set():
    simulator = flat_sea(shape=1.0, correlation_s=6.0)
    clutter = scans_of(simulator, 40) / 1e4 - 1.0
    for lag, wanted in ((2, np.exp(-1.0)), (12, 0.0)):
        assert np.mean(clutter[lag:] * clutter[:-lag]) == pytest.approx(wanted, abs=0.04)


def test_speckle_is_as_wide_as_beam_and_pulse():
    """Exponential power correlates as the square of the field's correlation."""
    simulator = replace(flat_sea(shape=np.inf), beam_width_rad=8 * STEP, pulse_length_m=36.0)
    clutter = scans_of(simulator, 8) / 1e4 - 1.0
    sweeps, cells = 4, 3
    beam = np.exp(-0.5 * (sweeps * STEP / simulator.beam_std_rad) ** 2)
    pulse = np.exp(-0.5 * (cells * 6.0 / simulator.pulse_std_m) ** 2)
    across = np.mean(clutter[:, sweeps:] * clutter[:, :-sweeps])
    along = np.mean(clutter[:, :, cells:] * clutter[:, :, :-cells])
    assert across == pytest.approx(beam, abs=0.05)
    assert along == pytest.approx(pulse, abs=0.05)


def test_clutter_falls_with_range_and_is_strongest_against_the_wind():
    sea = SeaClutter(
        clutter_to_noise_db=40.0,
        decay=3.0,
        shape=np.inf,
        wind_from_rad=1.0,
        upwind_downwind_db=8.0,
    )
    simulator = RadarVideoSimulator(
        sweeps_per_turn=720, cells=64, cell_m=150.0, pulse_length_m=150.0, bits=16, sea=sea
    )
    clutter = scans_of(simulator, 12).mean(axis=0)
    reference = np.abs(simulator.grid.range_m - 10_000.0).argmin()
    range_m = simulator.grid.range_m[[reference // 2, reference]]
    near, far = clutter[:, [reference // 2, reference]].mean(axis=0)
    assert near / far == pytest.approx((range_m[1] / range_m[0]) ** 3, rel=0.1)
    weight = (simulator.grid.range_m / 10_000.0) ** 3
    level_db = 10 * np.log10((clutter * weight)[:, 20:].mean(axis=1))
    for azimuth, wanted in ((1.0, 44.0), (1.0 + np.pi, 36.0), (1.0 + np.pi / 2, 40.0)):
        near_it = np.abs(np.angle(np.exp(1j * (simulator.grid.azimuth_rad - azimuth)))) < 0.1
        assert np.mean(level_db[near_it]) == pytest.approx(wanted, abs=0.5)


# Land ---------------------------------------------------------------------------------------------

ISLAND = [[-2000, -500], [-1500, 900], [-1000, -200], [-1400, -1000]]
POND = [[-1600, -100], [-1500, 200], [-1300, -100]]


def island(**settings):
    """Land of 60 dB without texture, all around the compass."""
    usual = {"where": [ISLAND, POND], "clutter_to_noise_db": 60.0, "decay": 0.0, "shape": np.inf}
    return RadarVideoSimulator(
        sweeps_per_turn=720,
        cells=250,
        cell_m=10.0,
        beam_width_rad=TURN / 720,
        bits=16,
        land=Land(**(usual | settings)),
    )


def inside(north_m, east_m, outline):
    """Even-odd rule, edge by edge."""
    odd = np.zeros(north_m.shape, bool)
    for (n1, e1), (n2, e2) in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        spans = (n1 > north_m) != (n2 > north_m)
        if n1 != n2:
            odd ^= spans & (east_m < e1 + (north_m - n1) * (e2 - e1) / (n2 - n1))
    return odd


def test_land_lies_where_its_outlines_are():
    simulator = island()
    cover = simulator.land.cover(simulator.grid, 1e-9)
    north_m = np.outer(np.cos(simulator.grid.azimuth_rad), simulator.grid.range_m)
    east_m = np.outer(np.sin(simulator.grid.azimuth_rad), simulator.grid.range_m)
    wanted = inside(north_m, east_m, ISLAND) ^ inside(north_m, east_m, POND)
    assert wanted.any()
    assert np.mean((cover > 0.5) != wanted) < 1e-5
    echo = power(simulator.turn(rng=1), simulator)
    assert echo[cover > 0.99].mean() == pytest.approx(1e6, rel=0.1)
    assert echo[(cover == 0) & ~wanted][:1000].mean() < 10


@given(st.integers(0, 10_000))
@settings(max_examples=25, deadline=None)
def test_any_outline_even_around_the_antenna_covers_its_inside(seed):
    rng = np.random.default_rng(seed)
    outline = rng.uniform(-2400, 2400, (rng.integers(3, 9), 2))
    simulator = island(where=[outline])
    cover = simulator.land.cover(simulator.grid, 1e-9)
    north_m = np.outer(np.cos(simulator.grid.azimuth_rad), simulator.grid.range_m)
    east_m = np.outer(np.sin(simulator.grid.azimuth_rad), simulator.grid.range_m)
    assert np.mean((cover > 0.5) != inside(north_m, east_m, outline)) < 1e-4


def test_land_may_be_given_by_a_function():
    drawn, reported = island(), island(where=lambda n, e: inside(n, e, ISLAND) ^ inside(n, e, POND))
    np.testing.assert_allclose(
        drawn.land.cover(drawn.grid, 0.01), reported.land.cover(reported.grid, 0.01), atol=1e-6
    )
    with pytest.raises(ValueError, match=r"shape \(720, 250\), got \(3,\)"):
        island(where=lambda n, e: np.ones(3)).turn()


@pytest.mark.parametrize("fluctuation", [0.0, 0.3, 1.0])
def test_the_land_stays_but_for_its_fluctuation(fluctuation):
    simulator = island(fluctuation=fluctuation)
    cover = simulator.land.cover(simulator.grid, TURN / 720) > 0.99
    first, second = (power(v, simulator)[cover] for v in simulator.turns(scans=2, seed=2))
    alike = np.corrcoef(first, second)[0, 1]
    assert alike == pytest.approx((1 - fluctuation) ** 2, abs=0.08)


def test_no_sea_on_land_and_hills_hide_what_lies_behind():
    sea = SeaClutter(clutter_to_noise_db=60.0, decay=0.0, shape=np.inf, upwind_downwind_db=0.0)
    wall = [[500, -5000], [1000, -5000], [1000, 5000], [500, 5000]]
    simulator = replace(
        island(where=[wall], clutter_to_noise_db=-60.0, penetration_m=100.0), sea=sea
    )
    echo = power(simulator.turn(rng=1), simulator)
    before, on, behind = (
        echo[:20, cells].mean() for cells in (slice(40), slice(60, 90), slice(120, 200))
    )
    assert before == pytest.approx(1e6, rel=0.2)
    assert on < 10
    assert behind == pytest.approx(1e6 * np.exp(-5.0), rel=0.3)
    target = at(1500.0, 0.5 * TURN / 720, rcs_m2=1e3, swerling=0)
    hidden, free = (
        replace(simulator, sea=None, noise_rms=2.0, land=land) for land in (simulator.land, None)
    )
    peaks = [power(s.turn([target]), s)[0].max() for s in (hidden, free)]
    assert peaks[0] / peaks[1] == pytest.approx(np.exp(-5.0), rel=0.1)


# Echoes -------------------------------------------------------------------------------------------


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.floats(0.0, TURN))
@settings(max_examples=40, deadline=None)
def test_the_echo_of_a_point_is_centred_where_it_is(sweep_part, cell_part, azimuth):
    simulator = radar(snr_db=45.0, sector_rad=(azimuth - 0.1, azimuth + 0.1))
    target_azimuth = azimuth + sweep_part * STEP
    range_m = 5400.0 + cell_part * 6.0
    seen_azimuth, seen_range = centroid(simulator.turn([at(range_m, target_azimuth, swerling=0)]))
    off = (seen_azimuth - target_azimuth + np.pi) % TURN - np.pi
    assert abs(off) < 0.02 * STEP
    assert abs(seen_range - range_m) < 0.02 * 6.0


@pytest.mark.parametrize("swerling", [0, 1, 2, 3, 4])
def test_the_echo_of_a_hull_is_centred_where_it_is_on_average(swerling):
    simulator = radar(snr_db=40.0)
    range_m, azimuth = middle_of(simulator)
    target = at(
        range_m, azimuth, length_m=60.0, beam_m=12.0, swerling=swerling, heading_rad=azimuth + 0.7
    )
    videos = simulator.turns([target], 300, seed=5)
    off = np.array([centroid(video) for video in videos]) - [azimuth, range_m]
    error = 4 * off.std(axis=0) / np.sqrt(len(off))
    error += np.array([0.02 * STEP, 0.02 * 6.0])
    assert (np.abs(off.mean(axis=0)) < error).all()
    assert (off.std(axis=0) > [0.1 * STEP, 0.6]).all()


@pytest.mark.parametrize("range_m", [1500.0, 3000.0, 6000.0])
def test_an_echo_is_as_wide_as_the_beam_and_so_grows_with_range(range_m):
    width = 12 * STEP
    simulator = radar(
        snr_db=50.0,
        reference_range_m=range_m,
        beam_width_rad=width,
        start_range_m=range_m - 600.0,
    )
    video = simulator.turn([at(range_m, 1.0 + 50.3 * STEP, swerling=0)])
    over_half = video.amplitude.max(axis=1) >= 0.5 * video.amplitude.max()
    extent_m = over_half.sum() * STEP * range_m
    assert extent_m == pytest.approx(width * range_m, abs=1.5 * STEP * range_m)
    power_along = video.amplitude.max(axis=0).astype(float) ** 2
    assert np.sum(power_along >= 0.5 * power_along.max()) * 6.0 == pytest.approx(15.0, abs=7.0)


def test_a_long_hull_has_a_long_echo():
    simulator = radar(snr_db=40.0)
    range_m, azimuth = middle_of(simulator)
    seen = []
    for heading in (azimuth, azimuth + np.pi / 2):
        target = at(range_m, azimuth, length_m=300.0, beam_m=30.0, heading_rad=heading)
        mean = np.mean([power(v, simulator) for v in simulator.turns([target], 30)], axis=0)
        strong = mean > 0.05 * mean.max()
        seen.append((strong.any(axis=0).sum() * 6.0, strong.any(axis=1).sum() * STEP * range_m))
    assert seen[0][0] == pytest.approx(315.0, abs=40.0)
    assert seen[0][0] > 4 * seen[1][0]
    assert seen[1][1] > seen[0][1] + 200.0


def test_power_at_the_reference_range_is_as_set_and_falls_with_the_fourth_power():
    simulator = radar(noise_rms=1.0, snr_db=30.0, reference_range_m=middle_of(radar())[0])
    levels = []
    for start_m in (4800.0, 4800.0 + middle_of(simulator)[0]):
        moved = replace(simulator, start_range_m=start_m, noise_rms=10.0)
        target = at(*middle_of(moved), rcs_m2=4.0, swerling=0)
        peak = [power(v, moved)[50, 100] for v in moved.turns([target], 400)]
        levels.append(np.mean(peak) - 1.0)
    assert levels[0] == pytest.approx(4000.0, rel=0.01)
    assert levels[0] / levels[1] == pytest.approx(16.0, rel=0.03)


@pytest.mark.parametrize(("swerling", "variance"), [(0, 0.0), (1, 1.0), (3, 0.5)])
def test_power_fluctuates_from_scan_to_scan_as_swerling_says(swerling, variance):
    simulator = radar(
        cells=20,
        sector_rad=(1.0, 1.0 + 20 * STEP),
        snr_db=40.0,
        noise_rms=2.0,
        start_range_m=5000.0,
    )
    target = at(*middle_of(simulator, 10, 10), swerling=swerling)
    peak = np.array([power(v, simulator)[8:13, 10] for v in simulator.turns([target], 800)])
    level = peak[:, 2]
    assert level.var() / level.mean() ** 2 == pytest.approx(variance, abs=0.2 * variance + 0.01)
    within = peak[:, 1:4] / peak[:, 1:4].mean(axis=0)
    strong = level > 0.3 * level.mean()
    assert np.std(within[strong] / within[strong].mean(axis=1, keepdims=True)) < 0.1


@pytest.mark.parametrize(("swerling", "variance"), [(2, 1.0), (4, 0.5)])
def test_power_fluctuates_from_sweep_to_sweep_as_swerling_says(swerling, variance):
    simulator = radar(
        cells=20,
        sector_rad=(1.0, 1.0 + 20 * STEP),
        snr_db=60.0,
        noise_rms=1.0,
        start_range_m=5000.0,
    )
    target = at(*middle_of(simulator, 10, 10), swerling=swerling)
    level = np.array([power(v, simulator)[8:13, 10] for v in simulator.turns([target], 800)])
    level /= level.mean(axis=0)
    assert level.var(axis=0) == pytest.approx(np.full(5, variance), rel=0.25)
    correlation = np.corrcoef(level.T) - np.eye(5)
    assert np.abs(correlation).max() < 0.12


def test_many_scatterers_in_one_cell_keep_swerling_1_exactly():
    simulator = radar(
        cells=20,
        sector_rad=(1.0, 1.0 + 20 * STEP),
        snr_db=60.0,
        noise_rms=1.0,
        start_range_m=5000.0,
    )
    range_m, azimuth = middle_of(simulator, 10, 10)
    target = at(range_m, azimuth, length_m=1.0, scatterers=7, broadside_db=0.0)
    level = np.array([power(v, simulator)[10, 10] for v in simulator.turns([target], 800)])
    assert level.mean() == pytest.approx(10.0 * 1e6 * (1e4 / range_m) ** 4, rel=0.14)
    assert level.var() / level.mean() ** 2 == pytest.approx(1.0, abs=0.3)


def test_a_flat_side_shines():
    end_on, broadside, quarter = (
        VideoTarget(
            truth=Truth([5000.0, 0.0, 0.0, 0.0]),
            length_m=50.0,
            rcs_m2=100.0,
            broadside_db=10.0,
            heading_rad=heading,
        ).cross_section_at(np.array([5000.0, 0.0, 0.0, 0.0]))
        for heading in (0.0, np.pi / 2, np.pi / 2 + 0.175)
    )
    assert end_on == pytest.approx(100.0)
    assert broadside == pytest.approx(1000.0)
    assert quarter == pytest.approx(550.0)


def test_the_hull_heads_where_it_moves():
    target = VideoTarget(truth=Truth([0.0, 3.0, 0.0, 4.0]), length_m=50.0, beam_m=10.0)
    place = target.scatterers_at(np.array([1000.0, 3.0, 2000.0, 4.0]))
    assert np.mean(place) == pytest.approx(1000.0 + 2000.0j)
    along = (place - np.mean(place)) * np.exp(-1j * np.arctan2(4.0, 3.0))
    assert np.ptp(along.real) == pytest.approx(50.0)
    assert np.ptp(along.imag) == pytest.approx(10.0)


def test_a_target_is_seen_where_it_is_when_the_beam_passes():
    """A target this fast moves 10 sweeps and 100 m between the begin of the turn and the pass."""
    azimuth, speed = 3.0, 100.0
    north, east = 5400.0 * np.cos(azimuth), 5400.0 * np.sin(azimuth)
    outwards = speed * np.array([np.cos(azimuth), np.sin(azimuth)])
    around = speed * np.array([-np.sin(azimuth), np.cos(azimuth)])
    vnorth, veast = outwards + around
    truth = Truth([north, vnorth, east, veast], start_time_s=20.0)
    simulator = radar(snr_db=45.0, sector_rad=(2.9, 3.2))
    video = simulator.turn([VideoTarget(truth=truth, swerling=0)], start_time_s=20.0)
    seen_azimuth, seen_range = centroid(video)
    seen_s = np.interp(seen_azimuth, video.azimuth_rad, video.time_s)
    state = truth.state_at(seen_s)[0]
    assert seen_s == pytest.approx(20.0 + 3.0 * seen_azimuth / TURN)
    assert seen_azimuth == pytest.approx(np.arctan2(state[2], state[0]), abs=0.02 * STEP)
    assert seen_range == pytest.approx(np.hypot(state[0], state[2]), abs=0.3)
    assert seen_range > 5400.0 + 100.0


@pytest.mark.parametrize("azimuth", [-0.6 * STEP, 0.0, 0.4 * STEP])
def test_an_echo_across_north_is_one_echo_of_two_turns(azimuth):
    """The end of a turn and the begin of the next one see two parts of the same pass."""
    simulator = radar(sector_rad=None, snr_db=45.0, beam_width_rad=10 * STEP)
    target = at(5401.0, azimuth, swerling=1)
    turns = list(simulator.turns([target], 4, seed=2))
    for before, after in pairwise(turns):
        joined = np.concatenate([before.amplitude[-30:], after.amplitude[:30]]).astype(float)
        echo = np.log(joined[20:40, 100])
        off = (np.arange(-10, 10) + 0.5) * STEP - azimuth
        level = echo + 0.5 * (off / simulator.beam_std_rad) ** 2
        assert np.ptp(level) < 0.02
    first = turns[0].amplitude[:, 100].astype(float)
    assert first[:5].min() > 1000
    assert first[-5:].min() > 1000


def test_a_target_of_which_nothing_is_known_is_not_there():
    class Gone:
        def state_at(self, time_s):
            return np.full((len(np.atleast_1d(time_s)), 4), np.nan)

    simulator = radar()
    nothing, gone = (simulator.turn(t, rng=1).amplitude for t in ((), [VideoTarget(truth=Gone())]))
    np.testing.assert_array_equal(nothing, gone)


def test_a_target_over_the_antenna_does_no_harm():
    simulator = radar(sector_rad=None, start_range_m=0.0, cells=20)
    video = simulator.turn([VideoTarget(truth=Truth([0.0, 1.0, 0.0, 0.0]), length_m=10.0)])
    assert video.amplitude.max() == simulator.full_scale


# Scenes -------------------------------------------------------------------------------------------


def test_the_small_craft_stands_out_of_the_sea_near_its_truth():
    scene = small_craft_scene(3)
    craft = scene.targets["craft"]
    found = 0
    for video in scene.turns(20, seed=1):
        north, _, east, _ = craft.truth.state_at(video.time_s.mean())[0]
        range_m, azimuth = np.hypot(north, east), np.arctan2(east, north)
        assert 17_000 < range_m < 23_000
        off = np.angle(np.exp(1j * (video.azimuth_rad - azimuth)))
        near = video.amplitude[np.abs(off) * range_m < 40][:, np.abs(video.range_m - range_m) < 30]
        found += near.max() > 2 * video.amplitude.mean() + 20
    assert found >= 16
    assert video.azimuth_width_rad == pytest.approx(np.deg2rad(0.03))
    assert (video.cell_m, np.diff(video.time_s)[0]) == (6.0, pytest.approx(3.0 / 12_000))


def test_the_small_craft_may_have_another_beam_and_another_situation():
    situation = HardTurn(20.0, 600.0, range_m=8000.0)
    scene = small_craft_scene(1, situation=situation, beam_cells=10.0)
    assert scene.radar.beam_width_rad == pytest.approx(np.deg2rad(0.3))
    north, vnorth, east, veast = scene.targets["craft"].truth.state_at(0.0)[0]
    assert np.hypot(vnorth, veast) == pytest.approx(20.0)
    assert 8000.0 <= np.hypot(north, east) <= 8006.0


def test_the_strait_has_ships_and_a_coast():
    scene = strait_scene(1)
    assert {"ship 1", "craft 1", "buoy 1"} <= set(scene.targets)
    radar = scene.radar
    assert (radar.sweeps_per_turn, radar.cells, radar.bits) == (4096, 2048, 8)
    assert len(radar.land.where) >= 3
    assert strait_scene(1).radar.sea == radar.sea
    assert strait_scene(2).radar.sea != radar.sea


@pytest.mark.slow
def test_every_seed_has_a_separate_radar_screen():
    one, other = (radar_screen(seed).amplitude for seed in (5, 6))
    assert one.shape == (4096, 2048)
    assert np.mean(one != other) > 0.5


# Bad arguments ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        ({"sweeps_per_turn": 2}, "sweeps_per_turn must be a whole number, at least 8, got 2"),
        ({"cells": 0}, "cells must be a whole number, at least 1, got 0"),
        ({"cell_m": -1.0}, "cell_m must be finite and positive, got -1.0"),
        ({"period_s": np.nan}, "period_s must be finite and positive"),
        ({"beam_width_rad": 1e-4}, "beam_width_rad must be at least .*0.00306796 rad"),
        ({"pulse_length_m": 5.0}, "pulse_length_m must be at least a cell of 6.0 m, got 5.0"),
        ({"start_range_m": -5.0}, "start_range_m must be finite and not negative, got -5.0"),
        ({"snr_db": np.inf}, "snr_db must be finite, got inf"),
        ({"noise_rms": 70000.0}, "noise_rms must be below full scale, 65535, got 70000.0"),
        ({"bits": 12}, "bits must be 8 or 16, got 12"),
        ({"receiver": "square"}, "receiver must be one of .*, got 'square'"),
        ({"sector_rad": (1.0, 9.0)}, "sector_rad must begin"),
        ({"sector_rad": (1.0,)}, "sector_rad must be two finite azimuths"),
        ({"sector_rad": (1.0, 1.0 + 1e-6)}, "sector_rad must contain a sweep"),
    ],
)
def test_a_radar_that_is_invalid_is_rejected(bad, message):
    with pytest.raises(ValueError, match=message):
        radar(**bad)


@pytest.mark.parametrize(
    ("kind", "bad", "message"),
    [
        (SeaClutter, {"shape": 0.01}, "shape must be at least 0.05, got 0.01"),
        (SeaClutter, {"correlation_m": 0.0}, "correlation_m must be finite and positive"),
        (SeaClutter, {"decay": np.nan}, "decay must be finite"),
        (Land, {"where": [[[0, 0], [1, 1]]]}, r"outline 0 of where must have shape \(n, 2\)"),
        (Land, {"where": [[[0, 0], [1, 1], [np.nan, 2]]]}, "outline 0 of where must be finite"),
        (Land, {"where": [], "fluctuation": 2.0}, "fluctuation must be from 0 to 1, got 2.0"),
        (Land, {"where": [], "penetration_m": 0.0}, "penetration_m must be positive, got 0.0"),
        (VideoTarget, {"truth": Truth([1, 0, 0, 0]), "swerling": 5}, "swerling must be one of"),
        (VideoTarget, {"truth": Truth([1, 0, 0, 0]), "rcs_m2": -1.0}, "rcs_m2 must be finite"),
        (VideoTarget, {"truth": Truth([1, 0, 0, 0]), "scatterers": 0}, "scatterers must be a"),
    ],
)
def test_clutter_and_targets_that_are_invalid_are_rejected(kind, bad, message):
    with pytest.raises(ValueError, match=message):
        kind(**bad)


def test_what_is_of_another_type_is_rejected():
    simulator = radar()
    boat = at(5000.0, 1.0)
    with pytest.raises(TypeError, match="truth must have state_at, got 3"):
        VideoTarget(truth=3)
    with pytest.raises(TypeError, match="sea must be a SeaClutter, got 3"):
        radar(sea=3)
    with pytest.raises(TypeError, match="cell_m must be a number, got 'six'"):
        radar(cell_m="six")
    with pytest.raises(TypeError, match="sequence of VideoTarget, got a single one"):
        simulator.turn(boat)
    with pytest.raises(TypeError, match="target 1 must be a VideoTarget, got 7"):
        simulator.turn([boat, 7])
    with pytest.raises(ValueError, match="scans must be a whole number, at least 0, got -1"):
        simulator.turns([boat], -1)
    with pytest.raises(ValueError, match="start_time_s must be finite, got nan"):
        simulator.turn([boat], np.nan)
    with pytest.raises(ValueError, match=r"places_m must have shape \(n, 2\), got \(3,\)"):
        simulator.around([1.0, 2.0, 3.0], 10.0)
    with pytest.raises(ValueError, match=r"places_m .*antenna"):
        simulator.around([[5.0, 5.0]], 10.0)
