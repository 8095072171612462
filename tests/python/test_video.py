"""Radar video to plots: CFAR, echoes, masks, pictures."""

import copy
import dataclasses
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.lib.stride_tricks import sliding_window_view

import wakeline as wl
from wakeline.recording import RadarVideo

TYPES = st.sampled_from([np.uint8, np.uint16])
SEEDS = st.integers(0, 2**32 - 1)


def video(amplitude, *, first=0, sweeps_a_turn=None, time_s=0.0, cell_m=10.0, start_range_m=100.0):
    """Sweeps from number `first` on of turns of so many."""
    amplitude = np.asarray(amplitude)
    count = len(amplitude)
    width = 2 * np.pi / (sweeps_a_turn or count)
    number = first + np.arange(count)
    return RadarVideo(
        amplitude=amplitude,
        azimuth_rad=np.mod(number * width, 2 * np.pi),
        time_s=time_s + number * 1e-3,
        azimuth_width_rad=width,
        start_range_m=start_range_m,
        cell_m=cell_m,
    )


def random_amplitude(seed, shape, dtype=np.uint8, density=0.3):
    rng = np.random.default_rng(seed)
    top = np.iinfo(dtype).max
    return (rng.integers(1, top, shape, endpoint=True) * (rng.random(shape) < density)).astype(
        dtype
    )


def every_cell(**others):
    """An extractor whose thresholds are next to nothing."""
    keywords = {"train_cells": 128, "guard_cells": 0, "threshold_factor": 1e-6, "min_cells": 1}
    return wl.PlotExtractor(**(keywords | others))


def together(*tables):
    """Columns of all plots, by range and then bearing."""
    names = ("range_m", "bearing_rad", "total_amplitude", "peak_amplitude", "cells")
    columns = {name: np.concatenate([getattr(t, name) for t in tables]) for name in names}
    order = np.lexsort([np.round(columns["bearing_rad"], 9), np.round(columns["range_m"], 6)])
    return {name: values[order] for name, values in columns.items()}


def whole_turn(picture, **keywords):
    extractor = every_cell(closed_circle=True, **keywords)
    return together(extractor.process(video(picture)), extractor.finish())


# CFAR ---------------------------------------------------------------------------------------------


def windows(amplitude, train, guard):
    """The training cells of each cell, NaN where there is none."""
    far = train + guard
    padded = np.pad(amplitude.astype(float), ((0, 0), (far, far)), constant_values=np.nan)
    view = sliding_window_view(padded, 2 * far + 1, axis=1)
    return np.delete(view, np.s_[train : train + 2 * guard + 1], axis=2)


@settings(deadline=None)
@given(SEEDS, TYPES, st.integers(1, 20), st.integers(0, 6), st.integers(1, 70))
def test_a_cell_is_compared_with_the_mean_about_it(seed, dtype, train, guard, cells):
    amplitude = random_amplitude(seed, (3, cells), dtype)
    around = windows(amplitude, train, guard)
    count = np.isfinite(around).sum(axis=2)
    weight = np.ceil(65536 * 2.3 / np.maximum(count, 1) - 1e-9)
    level = np.floor(np.nansum(around, axis=2) * weight / 65536)
    expected = (amplitude > level) & (count > 0) & (amplitude >= 5)
    top = np.iinfo(dtype).max
    expected &= amplitude > np.minimum(level, top)
    given_mask = wl.video.cfar(
        amplitude,
        train_cells=train,
        guard_cells=guard,
        threshold_factor=2.3,
        least_amplitude=5,
    )
    assert np.array_equal(given_mask, expected)


@settings(deadline=None)
@given(SEEDS, TYPES, st.integers(1, 20), st.integers(0, 6), st.integers(1, 70), st.floats(0.05, 1))
def test_a_cell_is_compared_with_the_kth_about_it(seed, dtype, train, guard, cells, rank):
    amplitude = random_amplitude(seed, (3, cells), dtype, density=0.7)
    around = np.sort(windows(amplitude, train, guard), axis=2)  # NaN come last
    count = np.isfinite(around).sum(axis=2)
    k = np.maximum(np.ceil(rank * count - 1e-9).astype(int), 1)
    kth = np.take_along_axis(around, k[..., None] - 1, axis=2)[..., 0]
    with np.errstate(invalid="ignore"):
        expected = (count > 0) & (amplitude > np.floor(kth * 1.5)) & (amplitude >= 1)
    mask = wl.video.cfar(
        amplitude,
        kind="ordered_statistic",
        train_cells=train,
        guard_cells=guard,
        threshold_factor=1.5,
        rank=rank,
    )
    assert np.array_equal(mask, expected)


def test_thresholds_are_those_of_the_mask():
    amplitude = random_amplitude(1, (20, 300), np.uint16)
    threshold = wl.video.cfar_threshold(amplitude, train_cells=8)
    assert threshold.dtype == np.uint16
    assert np.array_equal(amplitude > threshold, wl.video.cfar(amplitude, train_cells=8))


@pytest.mark.parametrize("kind", ["cell_averaging", "ordered_statistic"])
@pytest.mark.parametrize("noise", ["exponential", "rayleigh"])
def test_false_alarms_are_as_designed(kind, noise):
    power = np.random.default_rng(4).exponential(size=(400, 2048))
    amplitude = power if noise == "exponential" else np.sqrt(power)
    amplitude = np.minimum(3000 * amplitude, 65535).astype(np.uint16)
    factor = wl.video.threshold_factor(1e-3, noise=noise, kind=kind)
    mask = wl.video.cfar(amplitude, kind=kind, threshold_factor=factor)
    assert mask[:, 20:-20].mean() == pytest.approx(1e-3, rel=0.15)
    probability = wl.video.false_alarm_probability(factor, noise=noise, kind=kind)
    assert probability == pytest.approx(1e-3, rel=1e-9)


# Echoes -------------------------------------------------------------------------------------------


def labelled(picture, closed):
    """Total, peak and number of cells of each 8-connected component, by scipy."""
    ndimage = pytest.importorskip("scipy.ndimage")
    label, count = ndimage.label(picture > 0, structure=np.ones((3, 3)))
    if closed:  # across the seam
        parent = np.arange(count + 1)

        def root(k):
            while parent[k] != k:
                k = parent[k]
            return k

        for i in np.flatnonzero(label[0]):
            for other in label[-1, max(i - 1, 0) : i + 2]:
                if other:
                    parent[root(other)] = root(label[0, i])
        label = np.array([root(k) for k in range(count + 1)])[label]
    names = np.unique(label[label > 0])
    picture = picture.astype(float)
    return sorted(
        zip(
            ndimage.sum(picture, label, names),
            ndimage.maximum(picture, label, names),
            ndimage.sum(picture > 0, label, names),
            strict=True,
        )
    )


@settings(deadline=None, max_examples=50)
@given(SEEDS, TYPES, st.floats(0.05, 0.8), st.booleans())
def test_echoes_are_the_connected_components(seed, dtype, density, closed):
    # 16 bits: next to nothing is a threshold of some hundred.
    picture = random_amplitude(seed, (30, 40), dtype, density)
    if dtype is np.uint16:
        picture[picture < 1000] = 0
    extractor = every_cell(closed_circle=closed)
    plots = together(extractor.process(video(picture)), extractor.finish())
    columns = (plots["total_amplitude"], plots["peak_amplitude"], plots["cells"])
    assert sorted(zip(*columns, strict=True)) == labelled(picture, closed)


@settings(deadline=None, max_examples=30)
@given(SEEDS, st.integers(0, 39))
def test_plots_turn_with_the_picture(seed, turn):
    picture = random_amplitude(seed, (40, 30), density=0.15)
    before, after = whole_turn(picture), whole_turn(np.roll(picture, turn, axis=0))
    assert len(before["cells"]) == len(after["cells"])
    turned = np.mod(before["bearing_rad"] + turn * 2 * np.pi / 40, 2 * np.pi)
    for name in ("range_m", "total_amplitude", "peak_amplitude", "cells"):
        assert np.allclose(np.sort(before[name]), np.sort(after[name]), rtol=1e-12)
    where = np.exp(1j * turned) * before["range_m"]
    found = np.exp(1j * after["bearing_rad"]) * after["range_m"]
    # An echo all around has no bearing.
    ring = (picture > 0).any(axis=1).all()
    if not ring:
        assert np.allclose(np.sort_complex(where.round(6)), np.sort_complex(found.round(6)))


@settings(deadline=None, max_examples=30)
@given(SEEDS, st.lists(st.integers(0, 90), max_size=5))
def test_pieces_give_what_the_whole_gives(seed, cuts):
    picture = np.tile(random_amplitude(seed, (30, 40), density=0.2), (3, 1))
    one, many = every_cell(), every_cell()
    whole = together(one.process(video(picture, sweeps_a_turn=30)), one.finish())
    tables = []
    for first, last in zip([0, *sorted(cuts)], [*sorted(cuts), 90], strict=True):
        if last > first:
            piece = video(picture[first:last], first=first, sweeps_a_turn=30)
            tables.append(many.process(piece))
    pieces = together(*tables, many.finish())
    for name, values in whole.items():
        assert np.array_equal(values, pieces[name])


def ship(number_of_sweeps=360, cells=200, *, sweep=100.0, cell=60.0, peak=200.0):
    """A smooth echo about a place, across north too."""
    away = np.mod(np.arange(number_of_sweeps) - sweep + number_of_sweeps / 2, number_of_sweeps)
    along = np.exp(-0.5 * ((away - number_of_sweeps / 2) / 4) ** 2)
    across = np.exp(-0.5 * ((np.arange(cells) - cell) / 1.2) ** 2)
    return (peak * np.outer(along, across)).astype(np.uint8)


@pytest.mark.parametrize("sweep", [100.0, 100.4, 0.0, 359.6])
def test_a_ship_is_one_plot_where_she_is(sweep):
    extractor = wl.PlotExtractor(closed_circle=True)
    first = extractor.process(video(ship(sweep=sweep, cell=60.3)))
    last = extractor.finish()
    assert len(first) + len(last) == 1
    plots = first if len(first) else last
    error = (plots.bearing_rad[0] - np.deg2rad(sweep) + np.pi) % (2 * np.pi) - np.pi
    assert abs(error) < 0.1 * np.deg2rad(1)
    assert plots.range_m[0] == pytest.approx(100 + 60.8 * 10, abs=1.0)
    assert plots.covariance.shape == (1, 2, 2)
    assert np.all(np.linalg.eigvalsh(plots.covariance) > 0)
    assert not plots.cut[0]
    assert plots.range_extent_m[0] == pytest.approx(plots.range_extent_m[0].round())
    assert not plots.touches_first_cell[0]
    assert not plots.touches_last_cell[0]


def test_turns_follow_without_a_seam():
    extractor = wl.PlotExtractor()
    counts = [
        len(extractor.process(video(ship(sweep=0.0), first=360 * k, sweeps_a_turn=360)))
        for k in range(4)
    ]
    assert sum(counts) == 4  # half of one at the beginning, three whole ones
    assert extractor.open_echoes == 1
    assert len(extractor.finish()) == 1


def test_what_is_still_to_come_is_where_the_first_open_echo_begins():
    picture = np.zeros((360, 50), np.uint8)
    picture[100:112, 20:24] = picture[105:108, 30:34] = 200
    extractor, width_rad = every_cell(gap_sweeps=0), 2.0 * np.pi / 360
    for k in range(120):
        extractor.process(video(picture[k : k + 1], first=k, sweeps_a_turn=360))
        expected = k - 99 if 100 <= k < 112 else 0
        assert extractor.open_extent_rad == pytest.approx(expected * width_rad)


# Sweeps that do not come as they should ----------------------------------------------------------


def test_a_gap_and_a_step_back_close_echoes():
    picture = ship(sweep=100)
    extractor = wl.PlotExtractor()
    before = extractor.process(video(picture[:100], sweeps_a_turn=360))
    after = extractor.process(video(picture[103:150], first=103, sweeps_a_turn=360))
    assert len(before) == 0
    assert list(after.cut) == [True, True]
    assert extractor.counts.gaps == 1
    again = extractor.process(video(picture[80:150], first=80, sweeps_a_turn=360))
    assert len(again) == 1
    assert not again.cut[0]
    assert extractor.counts.reversals == 1


def test_a_sweep_that_is_invalid_is_as_if_it_had_not_come():
    turn = video(ship())
    azimuth = np.insert(turn.azimuth_rad, 100, [np.nan, turn.azimuth_rad[99]])
    damaged = dataclasses.replace(
        turn,
        amplitude=np.insert(turn.amplitude, [100, 100], 255, axis=0),
        azimuth_rad=azimuth,
        time_s=np.insert(turn.time_s, [100, 100], 0.1),
    )
    extractor, clean = wl.PlotExtractor(), wl.PlotExtractor()
    plots, expected = extractor.process(damaged), clean.process(turn)
    assert np.array_equal(plots.range_m, expected.range_m)
    assert np.array_equal(plots.covariance, expected.covariance)
    assert extractor.counts.invalid == 1
    assert extractor.counts.repeated == 1
    assert extractor.counts.sweeps == 360


def test_another_cell_length_closes_echoes():
    picture = ship(sweep=100)
    extractor = wl.PlotExtractor()
    extractor.process(video(picture[:100], sweeps_a_turn=360))
    other = video(picture[100:150], first=100, sweeps_a_turn=360, cell_m=20.0)
    assert list(extractor.process(other).cut) == [True, True]
    assert extractor.counts.geometry_changes == 1


def test_a_sweep_too_long_is_rejected_and_counted():
    extractor = wl.PlotExtractor(max_sweep_cells=100)
    assert len(extractor.process(video(ship()))) == 0
    assert extractor.counts.too_long == 360
    assert extractor.counts.sweeps == 0


@pytest.mark.parametrize("level", [0, 255])
def test_pictures_of_one_amplitude_have_no_plots(level):
    extractor = wl.PlotExtractor()
    assert len(extractor.process(video(np.full((360, 500), level, np.uint8)))) == 0
    assert len(extractor.finish()) == 0


def test_an_echo_without_end_is_cut():
    picture = np.zeros((360, 50), np.uint8)
    picture[:, 20:22] = 200
    extractor = every_cell(max_sweeps=90)
    plots = extractor.process(video(picture))
    assert len(plots) == 4
    assert plots.cut.all()
    assert extractor.open_echoes == 1


def test_sizes_are_limited():
    for limit, count in (({"min_cells": 10_000}, "too_small"), ({"max_cells": 10}, "too_large")):
        extractor = wl.PlotExtractor(**limit)
        assert len(extractor.process(video(ship()))) == 0
        assert getattr(extractor.counts, count) == 1


# What is left out ---------------------------------------------------------------------------------


def test_land_is_left_out():
    picture = np.maximum(ship(sweep=100, cell=60), ship(sweep=200, cell=120))
    land = wl.LandMask(720)
    corners = [[-400, 400], [300, 400], [300, 900], [-500, 900]]  # [north, east]
    land.exclude_polygon(corners)
    assert land.excludes(np.deg2rad(95), 700.0)
    assert not land.excludes(np.deg2rad(200), 700.0)
    plots = wl.PlotExtractor(land=land).process(video(picture))
    assert len(plots) == 1
    assert plots.bearing_rad[0] == pytest.approx(np.deg2rad(200), abs=1e-3)
    extractor = wl.PlotExtractor()
    everywhere = wl.LandMask()
    everywhere.exclude_sector(0.0, 2 * np.pi, 0.0, 1e6)
    extractor.set_land(everywhere)
    assert len(extractor.process(video(picture))) == 0


def test_what_always_stands_there_vanishes():
    clutter = wl.StaticClutterMap(360, 200, time_constant_s=20.0)
    extractor = wl.PlotExtractor(clutter=clutter, max_sweep_cells=200)
    block = np.zeros((360, 200), np.uint8)
    block[100:104, 60:62] = 200
    # A turn takes 2.36 s.
    seen = [
        len(extractor.process(video(block, first=360 * k, sweeps_a_turn=360, time_s=2.0 * k)))
        for k in range(30)
    ]
    gone_s = 20.0 * np.log(3)
    assert seen[0] == 1
    assert all(seen[: int(gone_s / 2.36 - 1)])
    assert not any(seen[int(gone_s / 2.36) + 2 :])
    mean = extractor.clutter.mean
    assert mean.shape == (360, 200)
    assert mean[101, 60] > 130
    assert mean[0, 0] == 0
    assert clutter.mean.max() == 0  # the extractor has a copy


def test_what_a_clutter_map_has_learned_is_pickled():
    block = np.zeros((360, 200), np.uint8)
    block[100:104, 60:62] = 200

    def learn(clutter, turns):
        extractor = wl.PlotExtractor(clutter=clutter, max_sweep_cells=200)
        for k in turns:
            extractor.process(video(block, first=360 * k, sweeps_a_turn=360, time_s=2.0 * k))
        return extractor.clutter

    clutter = learn(wl.StaticClutterMap(360, 200, time_constant_s=20.0), range(10))
    for other in (pickle.loads(pickle.dumps(clutter)), copy.copy(clutter)):
        np.testing.assert_array_equal(other.mean, clutter.mean)
        later = learn(other, range(10, 14)).mean
        np.testing.assert_array_equal(later, learn(clutter, range(10, 14)).mean)
    assert clutter.mean.max() > 50
    with pytest.raises(ValueError, match="different parameters"):
        wl.StaticClutterMap(360, 100, time_constant_s=20.0).restore(clutter.save())


# The picture --------------------------------------------------------------------------------------


@pytest.mark.parametrize("bits", [8, 16])
def test_a_scan_image_is_the_picture(bits):
    picture = random_amplitude(3, (90, 40), np.uint8 if bits == 8 else np.uint16)
    image = wl.ScanImage(90, 40, bits=bits)
    view = image.amplitude
    assert image.add(video(picture)) == 90
    assert np.array_equal(view, picture)  # the same memory
    assert not view.flags.writeable
    assert image.azimuth_rad == pytest.approx(video(picture).azimuth_rad)
    assert image.range_m == pytest.approx(video(picture).range_m)
    assert (image.start_range_m, image.cell_m) == (100.0, 10.0)
    assert image.azimuth_step_rad == pytest.approx(2 * np.pi / 90)
    image.clear()
    assert not view.any()


def test_a_view_outlives_the_name_of_its_image():
    picture = random_amplitude(3, (90, 40))
    image = wl.ScanImage(90, 40)
    image.add(video(picture))
    view = image.amplitude
    del image
    assert np.array_equal(view, picture)


# Errors -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"kind": "best"}, "kind must be cell_averaging or ordered_statistic, got 'best'"),
        ({"train_cells": 0}, "train_cells must be 1 to 128, got 0"),
        ({"threshold_factor": -1.0}, "threshold_factor must be above 0 and at most 1000"),
        ({"rank": 0.0}, "rank must be above 0"),
        ({"gap_sweeps": 9}, "gap_sweeps must be 0 to 8, got 9"),
        ({"max_sweep_cells": 0}, "max_sweep_cells must be 1 to 65536, got 0"),
        ({"max_range_extent_m": np.nan}, "max_range_extent_m must be"),
    ],
)
def test_settings_that_are_invalid_are_rejected(keywords, message):
    with pytest.raises(ValueError, match=message):
        wl.PlotExtractor(**keywords)


def test_amplitudes_of_another_kind_are_rejected():
    with pytest.raises(ValueError, match="amplitude must be of uint8 or uint16, got float64"):
        wl.video.cfar(np.zeros((3, 4)))
    with pytest.raises(ValueError, match=r"amplitude must have shape \(N, C\), got \(4,\)"):
        wl.video.cfar(np.zeros(4, np.uint8))
    extractor = wl.PlotExtractor()
    extractor.process(video(ship()))
    with pytest.raises(ValueError, match="amplitude must be of uint8 as in the video before"):
        extractor.process(video(ship().astype(np.uint16)))
    with pytest.raises(ValueError, match="amplitude must be of uint16 as the image"):
        wl.ScanImage(360, 200, bits=16).add(video(ship()))
    with pytest.raises(ValueError, match="bits must be 8 or 16, got 12"):
        wl.ScanImage(360, 200, bits=12)
    with pytest.raises(ValueError, match="probability must be between 0 and 1, got 0"):
        wl.video.threshold_factor(0.0)
    with pytest.raises(ValueError, match="noise must be exponential or rayleigh, got 'white'"):
        wl.video.threshold_factor(0.1, noise="white")
    with pytest.raises(ValueError, match=r"corners_m must have shape \(k, 2\), got \(3,\)"):
        wl.LandMask().exclude_polygon([1.0, 2.0, 3.0])
