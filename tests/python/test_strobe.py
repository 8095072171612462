"""Strobes on radar video."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl
from wakeline.recording import RadarVideo

CELL_M = 10.0


def video_of(amplitude, *, first_rad=0.0, span_rad=2 * np.pi, start_range_m=0.0, cell_m=CELL_M):
    sweeps = len(amplitude)
    step = span_rad / sweeps
    return RadarVideo(
        amplitude=amplitude,
        azimuth_rad=np.mod(first_rad + step * np.arange(sweeps), 2 * np.pi),
        time_s=np.linspace(0.0, 3.0, sweeps),
        azimuth_width_rad=step,
        start_range_m=start_range_m,
        cell_m=cell_m,
    )


def positions(video):
    """(N, C, 2) centres of the cells."""
    u = np.stack([np.cos(video.azimuth_rad), np.sin(video.azimuth_rad)], axis=-1)
    return video.range_m[None, :, None] * u[:, None, :]


def polar(range_m, bearing_rad):
    return range_m * np.array([np.cos(bearing_rad), np.sin(bearing_rad)])


STROBES = st.one_of(
    st.builds(lambda r: wl.RadiusGate(radius_m=r), st.floats(1.0, 400.0)),
    st.builds(
        lambda a, b, c, p: wl.CovarianceStrobe(
            [[a * a, c * a * b], [c * a * b, b * b]], wl.ChiSquareGate(probability=p)
        ),
        st.floats(1.0, 150.0),
        st.floats(1.0, 150.0),
        st.floats(-0.95, 0.95),
        st.floats(0.1, 0.999),
    ),
    st.builds(
        lambda r, b: wl.RangeBearingWindow(range_half_m=r, bearing_half_rad=b),
        st.floats(1.0, 400.0),
        st.floats(0.01, np.pi),
    ),
)


def holds(strobe, predicted_m, points):
    """Which points are inside, and which lie so near to the border that rounding decides."""
    d = points - predicted_m
    if isinstance(strobe, wl.RadiusGate):
        excess = np.hypot(d[..., 0], d[..., 1]) / strobe.radius_m - 1
    elif isinstance(strobe, wl.CovarianceStrobe):
        inverse = np.linalg.inv(strobe.innovation_covariance_m2)
        excess = np.einsum("...i,ij,...j", d, inverse, d) / strobe.threshold - 1
    else:
        off_m = np.hypot(*np.moveaxis(points, -1, 0)) - np.hypot(*predicted_m)
        bearings = np.arctan2(points[..., 1], points[..., 0])
        off_rad = wl.wrap_angle(bearings - np.arctan2(predicted_m[1], predicted_m[0]))
        excess = np.maximum(
            np.abs(off_m) / strobe.range_half_m - 1, np.abs(off_rad) / strobe.bearing_half_rad - 1
        )
    return excess <= 0, np.abs(excess) < 1e-7


@given(
    strobe=STROBES,
    sweeps=st.integers(3, 90),
    cells=st.integers(1, 40),
    span_rad=st.one_of(st.just(2 * np.pi), st.floats(0.2, 5.0)),
    first_rad=st.floats(0.0, 6.0),
    start_range_m=st.sampled_from([0.0, 35.0, 200.0]),
    range_m=st.floats(0.5, 600.0),
    bearing_rad=st.floats(-np.pi, np.pi),
    kind=st.sampled_from([np.uint8, np.uint16]),
    seed=st.integers(0, 2**32 - 1),
)
def test_it_weighs_the_cells_whose_centres_are_inside(
    strobe, sweeps, cells, span_rad, first_rad, start_range_m, range_m, bearing_rad, kind, seed
):
    rng = np.random.default_rng(seed)
    amplitude = rng.integers(0, np.iinfo(kind).max, (sweeps, cells), dtype=kind, endpoint=True)
    amplitude[rng.random(amplitude.shape) < 0.5] = 0
    video = video_of(amplitude, first_rad=first_rad, span_rad=span_rad, start_range_m=start_range_m)
    predicted_m = polar(range_m, bearing_rad)
    inside, border = holds(strobe, predicted_m, positions(video))
    if border.any():
        return
    echo = wl.strobe_echo(video, strobe, predicted_m)
    weight = np.where(inside, amplitude, 0).astype(float)
    assert echo.strobe_cells == inside.sum()
    assert echo.cells == (weight > 0).sum()
    assert echo.total_amplitude == weight.sum()
    assert bool(echo) == (weight.sum() > 0)
    if not echo:
        assert echo.status in ("empty", "outside")
        return
    assert echo.peak_amplitude == weight.max()
    assert echo.range_m == pytest.approx((weight * video.range_m).sum() / weight.sum())
    np.testing.assert_allclose(echo.position.mean, polar(echo.range_m, echo.bearing_rad), atol=1e-9)
    assert np.linalg.eigvalsh(echo.covariance)[0] > 0


def blob_video(*centres, kind=np.uint8, sweeps=720, cells=200, half=1):
    amplitude = np.zeros((sweeps, cells), kind)
    for sweep, cell, peak in centres:
        rows = np.arange(sweep - half, sweep + half + 1) % sweeps
        amplitude[np.ix_(rows, np.arange(cell - half, cell + half + 1))] = peak
    return video_of(amplitude)


@pytest.mark.parametrize("sweep", [0, 1, 200, 719])
def test_a_symmetric_echo_is_at_its_centre(sweep):
    video = blob_video((sweep, 100, 90))
    centre = positions(video)[sweep, 100]
    echo = wl.strobe_echo(video, wl.RadiusGate(radius_m=60.0), centre + np.array([12.0, -7.0]))
    assert echo.status == "ok"
    assert (echo.cells, echo.echoes, echo.peak_amplitude) == (9, 1, 90)
    np.testing.assert_allclose(echo.position.mean, centre, atol=1e-7)
    # Cells of equal amplitude: their spread over their number, and the grid's rounding.
    assert echo.covariance[0, 0] == pytest.approx(CELL_M**2 * (2 / 3 / 9 + 1 / 12))


def test_which_of_two_echoes():
    video = blob_video((100, 100, 200), (100, 108, 50))
    strong, weak = positions(video)[100, [100, 108]]
    predicted_m = positions(video)[100, 106]
    strobe = wl.RadiusGate(radius_m=100.0)

    def measured(several):
        echo = wl.strobe_echo(video, strobe, predicted_m, several=several)
        assert (echo.status, echo.echoes) == ("several echoes", 2)
        return echo.position.mean

    np.testing.assert_allclose(measured("nearest"), weak, atol=1e-7)
    np.testing.assert_allclose(measured("strongest"), strong, atol=1e-7)
    np.testing.assert_allclose(measured("all"), 0.8 * strong + 0.2 * weak, atol=1e-7)


def test_what_it_says_where_there_is_no_whole_echo():
    video = blob_video((100, 100, 90), (100, 198, 90))
    cell = positions(video)[100]

    def status(radius_m, predicted_m):
        return wl.strobe_echo(video, wl.RadiusGate(radius_m=radius_m), predicted_m).status

    assert status(14.0, cell[102]) == "touches edge"
    assert status(60.0, cell[150]) == "empty"
    assert status(60.0, cell[198]) == "cut"
    assert status(60.0, 1.1 * cell[199]) == "outside"
    assert status(60.0, [np.nan, 0.0]) == "invalid"


def test_noise_below_the_least_amplitude_does_not_pull():
    rng = np.random.default_rng(1)
    video = blob_video((100, 100, 200))
    noisy = np.where(video.amplitude, 200, rng.integers(0, 20, video.amplitude.shape, np.uint8))
    video = video_of(noisy.astype(np.uint8))
    centre = positions(video)[100, 100]
    predicted_m = centre + 30.0
    strobe = wl.RadiusGate(radius_m=80.0)
    raw = wl.strobe_echo(video, strobe, predicted_m)
    above = wl.strobe_echo(video, strobe, predicted_m, least_amplitude=20, pedestal=10)
    assert np.linalg.norm(raw.position.mean - centre) > 5.0
    np.testing.assert_allclose(above.position.mean, centre, atol=1e-7)


def test_predict_strobe_update_holds_a_target():
    estimator = wl.Kalman(wl.ConstantVelocity(noise=wl.WhiteAcceleration(psd_m2s3=0.05)))
    start, velocity = np.array([1200.0, -200.0]), np.array([1.0, 8.0])
    estimator.start(
        wl.Gaussian([start[0], velocity[0], start[1], velocity[1]], np.diag([25.0, 1, 25, 1]))
    )
    for scan in range(1, 31):
        truth = start + 3.0 * scan * velocity
        video = video_of(np.zeros((720, 200), np.uint8))
        near = np.linalg.norm(positions(video) - truth, axis=-1)
        video = video_of((200 * np.exp(-0.5 * (near / 12.0) ** 2)).astype(np.uint8))
        estimator.predict(3.0)
        predicted_m = estimator.estimate().mean[[0, 2]]
        echo = wl.strobe_echo(video, wl.RadiusGate(radius_m=50.0), predicted_m, least_amplitude=5)
        assert echo, scan
        std_m = np.sqrt(np.trace(echo.position.covariance) / 2)
        estimator.update(wl.Position(position_std_m=std_m), echo.position.mean)
    assert np.linalg.norm(estimator.estimate().mean[[0, 2]] - truth) < 4.0


def test_a_scan_image_stands_in_for_video_with_gaps():
    video = blob_video((100, 100, 90))
    strobe = wl.RadiusGate(radius_m=400.0)
    there = video.range_m[90] * np.array(
        [np.cos(video.azimuth_rad[100]), np.sin(video.azimuth_rad[100])]
    )
    image = wl.ScanImage(
        len(video), video.amplitude.shape[1], first_azimuth_rad=video.azimuth_rad[0]
    )
    assert image.add(video) == len(video) == len(image)
    whole = wl.strobe_echo(video, strobe, there)
    shown = wl.strobe_echo(image, strobe, there)
    assert shown.position.mean == pytest.approx(whole.position.mean, abs=1e-6)
    gappy = wl.ScanImage(
        len(video), video.amplitude.shape[1], first_azimuth_rad=video.azimuth_rad[0]
    )
    gappy.add(video[np.delete(np.arange(len(video)), 300)])
    assert wl.strobe_echo(gappy, strobe, there).position.mean == pytest.approx(
        whole.position.mean, abs=1e-6
    )


def test_video_that_is_no_picture_is_rejected():
    video = blob_video((100, 100, 90))
    strobe = wl.RadiusGate(radius_m=60.0)
    with pytest.raises(TypeError, match="RadarVideo or a ScanImage, got ndarray"):
        wl.strobe_echo(video.amplitude, strobe, [0.0, 0.0])
    with pytest.raises(ValueError, match="sweeps, got none"):
        wl.strobe_echo(video[:0], strobe, [0.0, 0.0])
    with pytest.raises(ValueError, match="clockwise"):
        wl.strobe_echo(video[::-1], strobe, [0.0, 0.0])
    uneven = np.delete(np.arange(720), 300)
    with pytest.raises(ValueError, match=r"even steps of azimuth, got sweep \d+ .*ScanImage"):
        wl.strobe_echo(video[uneven], strobe, [0.0, 0.0])
    twice = np.concatenate([np.arange(720), np.arange(720)])
    with pytest.raises(ValueError, match="at most one turn, got 2"):
        wl.strobe_echo(video[twice], strobe, [0.0, 0.0])


def test_settings_that_are_invalid_are_rejected():
    video = blob_video((100, 100, 90))
    strobe = wl.RadiusGate(radius_m=60.0)
    with pytest.raises(ValueError, match="least_amplitude must be 1 to 65535, got 0"):
        wl.strobe_echo(video, strobe, [0.0, 0.0], least_amplitude=0)
    with pytest.raises(ValueError, match="pedestal"):
        wl.strobe_echo(video, strobe, [0.0, 0.0], pedestal=1)
    with pytest.raises(ValueError, match=r"several must be .* got 'both'"):
        wl.strobe_echo(video, strobe, [0.0, 0.0], several="both")
    with pytest.raises(ValueError, match=r"predicted_m must have shape \(2,\)"):
        wl.strobe_echo(video, strobe, [0.0])
    with pytest.raises(ValueError, match="positive definite"):
        wl.CovarianceStrobe([[1.0, 2.0], [2.0, 1.0]])
    with pytest.raises(ValueError, match="bearing_half_rad"):
        wl.RangeBearingWindow(bearing_half_rad=4.0)
    with pytest.raises(TypeError):
        wl.strobe_echo(video, wl.ChiSquareGate(), [0.0, 0.0])
