"""The radar screen and the close-up: every echo is drawn, and where it is."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from wakeline.recording import RadarVideo, Tracks
from wakeline.scenario import RadarVideoSimulator, Truth, VideoTarget

pytest.importorskip("matplotlib")

from wakeline import plot

TURN = 2 * np.pi


def video_of(amplitude, *, first=0, sweeps_per_turn=720, start_range_m=0.0, cell_m=10.0):
    """Amplitudes as sweeps from number `first` on."""
    number = first + np.arange(len(amplitude)) + 0.5
    return RadarVideo(
        np.asarray(amplitude, np.uint8),
        (number / sweeps_per_turn * TURN) % TURN,
        number / sweeps_per_turn * 3.0,
        TURN / sweeps_per_turn,
        start_range_m,
        cell_m,
    )


def dot(sweep, cell, shape=(720, 300), **geometry):
    amplitude = np.zeros(shape)
    amplitude[sweep, cell] = 200
    return video_of(amplitude, **geometry)


@pytest.fixture(scope="module")
def screen():
    radar = RadarVideoSimulator(
        sweeps_per_turn=720, cells=300, cell_m=10.0, beam_width_rad=0.02, snr_db=-15.0
    )
    boat = VideoTarget(truth=Truth([1500.0, 0.0, -800.0, 0.0]), swerling=0)
    return radar.turn([boat], rng=1)


def drawn(ax):
    return [np.asarray(line.get_xydata(), float) for line in ax.lines]


def texts(ax):
    return [text.get_text() for text in ax.texts]


@given(st.integers(0, 719), st.integers(0, 299), st.integers(40, 700))
@settings(max_examples=60, deadline=None)
def test_no_single_cell_is_lost_and_each_lies_where_it_is(sweep, cell, pixels):
    video = dot(sweep, cell)
    extent = (-3100.0, 3100.0, -3100.0, 3100.0)
    raster = plot.screen_raster(video, extent, pixels)
    assert raster.shape == (pixels, pixels)
    assert np.nanmax(raster) == 200
    pixel_m = 6200.0 / pixels
    row, column = np.argwhere(raster == 200).T
    north_m, east_m = -3100.0 + (row + 0.5) * pixel_m, -3100.0 + (column + 0.5) * pixel_m
    range_m, azimuth = video.range_m[cell], video.azimuth_rad[sweep]
    off_m = np.hypot(north_m - range_m * np.cos(azimuth), east_m - range_m * np.sin(azimuth))
    assert off_m.max() <= 0.72 * pixel_m + 0.5 * (10.0 + range_m * TURN / 720)


def test_the_whole_picture_is_square_around_the_video_and_empty_outside():
    video = video_of(np.full((100, 50), 7), first=-50, start_range_m=400.0)
    ax = plot.ppi(video)
    image = ax.images[0].get_array()
    assert 0 < np.isnan(image.filled(np.nan)).mean() < 1
    assert set(np.unique(image.compressed())) == {7}
    west, east = ax.get_xlim()
    south, north = ax.get_ylim()
    assert east - west == pytest.approx(north - south)
    assert (west + east) / 2 == pytest.approx(0.0, abs=10.0)
    assert south < 400 * np.cos(TURN * 50 / 720)
    assert north > 895


def test_the_screen_is_a_map_with_north_up_and_equal_axes(screen):
    ax = plot.figure().add_subplot()
    assert plot.ppi(screen, ax, pixels=400) is ax
    assert ax.get_aspect() == 1.0
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("east (km)", "north (km)")
    image = np.asarray(ax.images[0].get_array(), float)
    row, column = np.unravel_index(np.nanargmax(image), image.shape)
    west, east, south, north = ax.images[0].get_extent()
    assert south + (row + 0.5) / len(image) * (north - south) == pytest.approx(1500.0, abs=30.0)
    assert west + (column + 0.5) / len(image) * (east - west) == pytest.approx(-800.0, abs=30.0)
    assert ax.images[0].origin == "lower"


def test_a_part_of_the_screen_may_be_shown_in_metres(screen):
    extent = (-1000.0, -600.0, 1300.0, 1600.0)
    ax = plot.ppi(screen, extent_m=extent, pixels=200)
    assert (*ax.get_xlim(), *ax.get_ylim()) == extent
    assert ax.images[0].get_array().shape == (150, 200)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("east (m)", "north (m)")


def test_rings_stand_at_round_ranges_and_report_them(screen):
    ax = plot.ppi(screen, pixels=100)
    radii = [patch.get_radius() for patch in ax.patches]
    assert radii == sorted(radii)
    assert 3 <= len(radii) <= 7
    assert [float(t.removesuffix(" km")) * 1000 for t in texts(ax)] == radii
    assert not plot.ppi(screen, rings=False, pixels=100).patches


def test_plots_strobes_and_tracks_lie_where_they_are(screen):
    circle = plot.circle_outline((1500.0, -800.0), 100.0)
    state = np.array([[1400.0, 1.0, -900.0, 1.0], [1500.0, 1.0, -800.0, 1.0]])
    tracks = Tracks(["A7", "A7"], [0.0, 3.0], state)
    ax = plot.ppi(screen, plots=[[1500.0, -800.0]], strobes=[circle], tracks=tracks, pixels=100)
    lines = drawn(ax)
    for wanted in (circle[:, ::-1], [[-800.0, 1500.0]], state[:, [2, 0]]):
        assert any(np.array_equal(line, wanted) for line in lines)
    assert "A7" in texts(ax)


def test_the_last_of_sweeps_of_the_same_azimuth_is_shown():
    early, late = video_of(np.full((720, 20), 50)), video_of(np.full((720, 20), 90))
    both = RadarVideo(
        np.concatenate([early.amplitude, late.amplitude[:360]]),
        np.concatenate([early.azimuth_rad, late.azimuth_rad[:360]]),
        np.concatenate([early.time_s, late.time_s[:360] + 3.0]),
        early.azimuth_width_rad,
        0.0,
        10.0,
    )
    raster = plot.screen_raster(both, (-300.0, 300.0, -300.0, 300.0), 300)
    assert raster[150, 240] == 90
    assert raster[150, 60] == 50


def test_a_jitter_of_the_antenna_leaves_no_holes():
    video = video_of(np.full((720, 100), 9))
    rng = np.random.default_rng(3)
    turned = video.azimuth_rad + rng.uniform(-0.4, 0.4, 720) * TURN / 720
    jittered = RadarVideo(video.amplitude, turned, video.time_s, video.azimuth_width_rad, 0.0, 10.0)
    raster = plot.screen_raster(jittered, (-700.0, 700.0, -700.0, 700.0), 500)
    assert not np.isnan(raster).any()


def numbered(sweeps, first_step, jitter_steps=0.0, rounded=False, width_steps=1.0):
    """A turn whose sweep k has the amplitude k + 1 in one cell, at another range than others."""
    rng = np.random.default_rng(sweeps)
    number = np.arange(sweeps)
    step = number + first_step + rng.uniform(-jitter_steps, jitter_steps, sweeps)
    turned = np.rint(step / sweeps * 65536) / 65536 if rounded else step / sweeps
    amplitude = np.zeros((sweeps, 16), np.uint16)
    amplitude[number, number % 16] = number + 1
    width_rad = width_steps * TURN / sweeps
    return RadarVideo(amplitude, turned * TURN % TURN, number * 1e-3, width_rad, 2000.0, 100.0)


FRAME = (-3700.0, 3700.0, -3700.0, 3700.0)
REGULAR = [
    *({"first_step": first} for first in (0.0, 0.25, 0.5, 0.999)),
    *({"first_step": first, "rounded": True} for first in (0.0, 0.5)),
    *({"first_step": first, "rounded": True, "jitter_steps": 0.2} for first in (0.0, 0.5)),
]


@pytest.mark.parametrize("turn", REGULAR, ids=str)
@pytest.mark.parametrize("sweeps", [8, 512, 1000, 3600, 4000, 4096, 5000])
def test_every_sweep_of_a_regular_turn_is_in_an_echo(sweeps, turn):
    video = numbered(sweeps, **turn)
    ax = plot.echo(video, half_range_m=5000.0, half_azimuth_rad=np.pi, colorbar=False)
    assert len(np.unique(ax.images[0].get_array())) == sweeps + 1
    west, east = ax.images[0].get_extent()[:2]
    shown = np.asarray(ax.images[0].get_array()).max(axis=0)
    middle_deg = west + (np.arange(sweeps) + 0.5) * (east - west) / sweeps
    off_deg = middle_deg - np.rad2deg(video.azimuth_rad[shown.astype(int) - 1])
    assert np.abs((off_deg + 180.0) % 360.0 - 180.0).max() < 0.5 * 360.0 / sweeps


@pytest.mark.parametrize("turn", REGULAR, ids=str)
@pytest.mark.parametrize("sweeps", [720, 4000])
def test_every_sweep_of_a_regular_turn_is_on_the_screen(sweeps, turn):
    raster = plot.screen_raster(numbered(sweeps, **turn), FRAME, 1000)
    assert set(np.unique(raster[raster > 0])) == set(range(1, sweeps + 1))


def test_of_sweeps_in_the_width_of_one_none_is_lost():
    raster = plot.screen_raster(numbered(1440, 0.3, width_steps=2.0), FRAME, 1000)
    assert set(np.unique(raster[raster > 0])) == set(range(1, 1441))


@pytest.mark.parametrize("turn", REGULAR, ids=str)
def test_nothing_is_left_of_a_turn_before(turn):
    early, late = numbered(720, **turn), numbered(720, **turn)
    both = RadarVideo(
        np.concatenate([early.amplitude, np.zeros_like(late.amplitude)]),
        np.concatenate([early.azimuth_rad, late.azimuth_rad]),
        np.concatenate([early.time_s, late.time_s + 3.0]),
        early.azimuth_width_rad,
        2000.0,
        100.0,
    )
    assert np.nanmax(plot.screen_raster(both, FRAME, 500)) == 0.0


def test_a_scan_image_is_drawn_as_its_video_is():
    video = numbered(720, 0.0)
    image = wl.ScanImage(720, 16, bits=16)
    image.add(video)
    for draw in (plot.ppi, plot.echo):
        drawn_video, drawn_image = (draw(of).images[0].get_array() for of in (video, image))
        np.testing.assert_array_equal(drawn_video.filled(-1.0), drawn_image.filled(-1.0))
    same = (plot.screen_raster(of, FRAME, 100) for of in (video, image))
    np.testing.assert_array_equal(*same)


def test_missing_sweeps_stay_dark():
    whole = video_of(np.full((720, 100), 9))
    raster = plot.screen_raster(whole[:500], (-700.0, 700.0, -700.0, 700.0), 200)
    assert np.isnan(raster).mean() == pytest.approx(220 / 720, abs=0.02)


def test_an_echo_is_drawn_cell_by_cell():
    video = dot(100, 40)
    ax = plot.figure().add_subplot()
    assert plot.echo(video, ax, half_range_m=45.0, half_azimuth_rad=0.05) is ax
    image = np.asarray(ax.images[0].get_array(), float)
    west, east, near, far = ax.images[0].get_extent()
    cell, sweep = np.unravel_index(np.argmax(image), image.shape)
    assert near + (cell + 0.5) / len(image) * (far - near) == pytest.approx(video.range_m[40])
    assert west + (sweep + 0.5) / image.shape[1] * (east - west) == pytest.approx(
        np.rad2deg(video.azimuth_rad[100])
    )
    assert np.count_nonzero(image) == 1
    assert len(image) == 9
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("azimuth (°)", "range (m)")
    assert [other.get_ylabel() for other in ax.figure.axes[1:]] == ["amplitude"]


@pytest.mark.parametrize("azimuth", [0.001, TURN - 0.001])
def test_an_echo_across_north_is_drawn_in_one_piece(azimuth):
    amplitude = np.zeros((720, 300))
    amplitude[[718, 719, 0, 1], 100] = [100, 150, 160, 110]
    place = 1005.0 * np.array([np.cos(azimuth), np.sin(azimuth)])
    window = plot.window_outline(1005.0, azimuth, 30.0, 0.03)
    ax = plot.echo(
        video_of(amplitude),
        around_m=place,
        half_range_m=40.0,
        half_azimuth_rad=0.05,
        plots=[place],
        strobes=[window],
    )
    image = np.asarray(ax.images[0].get_array(), float)
    row = image[len(image) // 2]
    assert row[row > 0].tolist() == [100, 150, 160, 110]
    west, east = ax.get_xlim()
    strobe, cross = drawn(ax)
    middle = np.rad2deg(azimuth)
    np.testing.assert_allclose(cross, [[middle, 1005.0]], rtol=1e-9)
    np.testing.assert_allclose(strobe.min(axis=0), [middle - np.rad2deg(0.03), 975.0], rtol=1e-9)
    np.testing.assert_allclose(strobe.max(axis=0), [middle + np.rad2deg(0.03), 1035.0], rtol=1e-9)
    assert west < strobe[:, 0].min()
    assert strobe[:, 0].max() < east


def test_outlines_are_what_they_are_called():
    circle = plot.circle_outline((100.0, -50.0), 27.0)
    np.testing.assert_allclose(np.hypot(*(circle - [100.0, -50.0]).T), 27.0)
    window = plot.window_outline(500.0, 3.1, 20.0, 0.1)
    np.testing.assert_array_equal(window[0], window[-1])
    range_m = np.hypot(*window.T)
    off = np.angle(np.exp(1j * (np.arctan2(window[:, 1], window[:, 0]) - 3.1)))
    np.testing.assert_allclose(np.unique(range_m.round(6)), [480.0, 520.0])
    assert (off.min(), off.max()) == (pytest.approx(-0.1), pytest.approx(0.1))


@pytest.mark.parametrize("value", [0, 255])
def test_an_even_picture_is_drawn(tmp_path, value):
    video = video_of(np.full((720, 30), value))
    for name, draw in (("ppi", plot.ppi), ("echo", plot.echo)):
        plot.save(draw(video).figure, tmp_path / f"{name}.png")
        assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")


def test_bad_arguments_are_named(screen):
    nothing = screen[:0]
    for draw in (plot.ppi, plot.echo):
        with pytest.raises(ValueError, match="video must have a sweep, got none"):
            draw(nothing)
        with pytest.raises(TypeError, match="must be a RadarVideo or a ScanImage, got ndarray"):
            draw(screen.amplitude)
        with pytest.raises(ValueError, match=r"plots must have shape \(n, 2\).*got \(3,\)"):
            draw(screen, plots=[1.0, 2.0, 3.0])
        with pytest.raises(ValueError, match=r"strobe must have shape \(n, 2\).*got \(1, 3\)"):
            draw(screen, strobes=[[[1.0, 2.0, 3.0]]])
        with pytest.raises(ValueError, match=r"amplitude_range must be low < high, got \(9, 3\)"):
            draw(screen, amplitude_range=(9, 3))
    with pytest.raises(ValueError, match="extent_m must be west < east, south < north"):
        plot.ppi(screen, extent_m=(1.0, 0.0, 0.0, 1.0))
    with pytest.raises(ValueError, match="pixels must be a whole number, at least 16, got 2"):
        plot.ppi(screen, pixels=2)
    with pytest.raises(ValueError, match=r"no cell of the video is around .* range 9000 m"):
        plot.echo(screen, around_m=(9000.0, 0.0))
    with pytest.raises(ValueError, match=r"around_m must be north and east, got \(1\.0,\)"):
        plot.echo(screen, around_m=(1.0,))


def test_tracks_are_not_drawn_across_gaps_and_a_row_alone_is_seen(screen):
    when_s = np.array([0.0, 3.0, 6.0, 100.0, 200.0, 203.0])
    state = np.column_stack([when_s, np.ones(6), -2.0 * when_s, np.full(6, -2.0)])
    ax = plot.ppi(screen, tracks=Tracks(["1"] * 6, when_s, state), rings=False, pixels=100)
    (line,) = ax.lines
    east_m, north_m = line.get_xydata().T
    np.testing.assert_array_equal(np.isnan(east_m), [0, 0, 0, 1, 0, 1, 0, 0])
    assert line.get_marker() == "."
    assert north_m[line.get_markevery()].tolist() == [100.0]


def test_ids_of_tracks_are_shown_as_they_are(screen):
    tracks = Tracks([r"$5 \frac$"] * 2, [0.0, 3.0], [[1500.0, 0.0, -800.0, 0.0]] * 2)
    plot.ppi(screen, tracks=tracks).figure.draw_without_rendering()
