"""Radar video as a picture: a PPI, north up, and a B-scope of cells and sweeps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

import wakeline as wl
from wakeline._checks import real_numbers, whole_number
from wakeline._engine.video import ScanImage
from wakeline.extraction import VideoRecording
from wakeline.recording import RadarVideo, Tracks

from .maps import ellipse_outline
from .style import INK, MUTED, TEXT_PT, by_length, dot_lone, figure, plain, with_gaps

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage

    from wakeline.tracking import TrackedRecording

_TURN_RAD = 2.0 * np.pi
SCREEN = "#04070C"
SCREEN_INK = "#C9D6DF"
SCREEN_GRID = "#5B7C8C"
PLOT_COLOR = "#FFFFFF"
STROBE_COLOR = "#59D5FF"
TRACK_COLORS = ("#FF8FB1", "#7CE0FF", "#C6A6FF", "#7DF0B4", "#FFB870", "#F4F4F4")
_ECHO_COLORS = (
    *((0.0, "#071019"), (0.15, "#0A2431"), (0.35, "#115058"), (0.56, "#3E8F5A")),
    *((0.76, "#C9BE4A"), (0.9, "#FFE58A"), (1.0, "#FFFBE6")),
)
_KM_FROM_M = 2000.0
_RINGS = 6
_SWEEPS_AT_ONCE = 512
_DARKEST_QUANTILE, _BRIGHTEST_QUANTILE = 0.15, 0.9995
_SIDE_AROUND = 0.02
_STROBE_PROBABILITY = 0.99


def ppi(
    video: RadarVideo | ScanImage,
    ax: Axes | None = None,
    *,
    plots: ArrayLike | None = None,
    strobes: Sequence[ArrayLike] = (),
    tracks: Tracks | None = None,
    extent_m: tuple[float, float, float, float] | None = None,
    amplitude_range: tuple[float, float] | None = None,
    rings: bool = True,
    pixels: int = 1200,
) -> Axes:
    """Draw radar video as a PPI: north up, antenna at the origin.

    A pixel shows the largest amplitude of the cells in it, so that no echo is lost between pixels.
    Of sweeps with the same azimuth the last one is shown.

    Parameters
    ----------
    video : RadarVideo or ScanImage
        A revolution, or a part of it.
    ax : matplotlib.axes.Axes, optional
        Axes to draw into; default those of a new figure.
    plots : array_like (n, 2), optional
        Marked by crosses; metres north and east.
    strobes : sequence of (k, 2) arrays
        Outlines in metres north and east: :func:`circle_outline`, :func:`window_outline`,
        :func:`ellipse_outline`.
    tracks : Tracks, optional
        Drawn as lines with their ids at the ends.
    extent_m : (west, east, south, north), optional
        Area to show, in metres; default all of the video.
    amplitude_range : (float, float), optional
        Darkest and brightest amplitude; default from the darker part of the noise to the amplitude
        that one cell in 2000 exceeds.
    rings : bool
        Whether to draw range rings with their ranges, and the cardinal directions.
    pixels : int
        Pixels of the longer side.

    Returns
    -------
    matplotlib.axes.Axes
        Data coordinates are metres east and north, whatever the labels of the ticks.

    Raises
    ------
    ValueError
        When the video has no sweep, the extent is empty, or a layer has a wrong shape.
    TypeError
        When the video is something else.
    """
    whole_number("pixels", pixels, 16)
    video = _as_video(video)
    ax = figure(7.2, 7.2).add_subplot() if ax is None else ax
    extent = _checked_extent(extent_m, video)
    raster = screen_raster(video, extent, pixels)
    _show(ax, raster, extent, _brightness(video, amplitude_range))
    ax.set_aspect("equal", adjustable="box")
    if rings:
        _draw_rings(ax, extent, float(video.range_m[-1] + 0.5 * video.cell_m))
    _draw_layers(ax, plots, strobes, tracks)
    return _dress_screen(ax, extent)


def screen(tracks: TrackedRecording) -> Figure:
    """Draw the last revolution of radar video: echoes, plots, strobes, and the tracks.

    Positions are relative to own ship at the end of the revolution, without the bearing offset of
    the radar. The strobes are those in which the plots were measured; without strobes a region that
    contains the next plot of a track with a probability of 99 % is drawn.

    Parameters
    ----------
    tracks : TrackedRecording
        Of a :class:`wakeline.extraction.VideoRecording`.

    Returns
    -------
    matplotlib.figure.Figure
        For :func:`save`.

    Raises
    ------
    TypeError
        When the tracks are not those of radar video.
    """
    recording, episode = tracks.recording, tracks.episodes[-1].episode
    if not isinstance(recording, VideoRecording):
        raise TypeError(f"tracks must be those of radar video, got those of {recording!r}")
    scan, last = episode.scans[-1], tracks.episodes[-1].tracks
    north_m, east_m = episode.own.position_at(scan.time_s)[0]
    last = replace(last, state=last.state - [north_m, 0.0, east_m, 0.0])
    if tracks.episodes[-1].strobes_m is None:
        strobes = _strobes(last.where(last.time_s == scan.time_s), recording.plot_std)
    else:
        strobes = [
            circle_outline(np.subtract(centre_m, [north_m, east_m]), radius_m)
            for *centre_m, radius_m in tracks.episodes[-1].strobes_m
        ]
    offset_rad = np.deg2rad(tracks.settings.radar["bearing_offset_deg"])
    range_m, bearing_rad = scan.range_bearing.T
    fig = figure(8.6, 8.6)
    ppi(
        replace(recording.last, azimuth_rad=recording.last.azimuth_rad - offset_rad),
        fig.add_subplot(),
        plots=range_m[:, None] * np.column_stack([np.cos(bearing_rad), np.sin(bearing_rad)]),
        strobes=strobes,
        tracks=last,
    )
    return fig


def _strobes(tracks: Tracks, plot_std: tuple[float, float]) -> list[NDArray]:
    """Outlines around rows of tracks; errors of a plot are metres of range and radians."""
    range_std_m, bearing_std_rad = plot_std
    sensor = wl.ConvertedRangeBearing(range_std_m=range_std_m, bearing_std_rad=bearing_std_rad)
    threshold = wl.ChiSquareGate(probability=_STROBE_PROBABILITY).threshold(2)
    place = np.ix_([0, 2], [0, 2])
    outlines = []
    for (north_m, _, east_m, _), covariance in zip(tracks.state, tracks.covariance, strict=True):
        polar = [np.hypot(north_m, east_m), np.arctan2(east_m, north_m)]
        plot_m2 = wl.one_point(sensor, polar, 1.0).covariance[place]
        outlines.append(ellipse_outline([north_m, east_m], covariance[place] + plot_m2, threshold))
    return outlines


def echo(
    video: RadarVideo | ScanImage,
    ax: Axes | None = None,
    *,
    around_m: tuple[float, float] | None = None,
    half_range_m: float = 150.0,
    half_azimuth_rad: float = 0.008,
    plots: ArrayLike | None = None,
    strobes: Sequence[ArrayLike] = (),
    amplitude_range: tuple[float, float] | None = None,
    colorbar: bool = True,
) -> Axes:
    """Draw the cells around a position as a B-scope: azimuth to the right, range upwards.

    Parameters
    ----------
    video : RadarVideo or ScanImage
        Of sweeps with the same azimuth the last one is shown.
    ax : matplotlib.axes.Axes, optional
        Axes to draw into; default those of a new figure.
    around_m : (north, east), optional
        Center of the picture; default the strongest cell.
    half_range_m, half_azimuth_rad : float
        Half the range and azimuth of the picture.
    plots, strobes
        As for :func:`ppi`, in metres north and east.
    amplitude_range : (float, float), optional
        Darkest and brightest amplitude; default 0 and the largest in the picture.
    colorbar : bool
        Whether to draw a scale of the amplitudes.

    Returns
    -------
    matplotlib.axes.Axes
        Azimuth in degrees, range in metres.

    Raises
    ------
    ValueError
        When no cell of the video is there, or a layer has a wrong shape.
    TypeError
        When the video is something else.
    """
    video = _as_video(video)
    ax = figure(6.4, 4.8).add_subplot() if ax is None else ax
    azimuth_rad, range_m = _middle(video, around_m)
    sweep, azimuth_edges_rad = _sweeps_about(video, azimuth_rad, half_azimuth_rad)
    cells = np.flatnonzero(np.abs(video.range_m - range_m) <= half_range_m)
    if len(cells) == 0 or not (sweep >= 0).any():
        raise ValueError(
            f"no cell of the video is around azimuth {np.rad2deg(azimuth_rad):.2f} degrees, "
            f"range {range_m:.0f} m"
        )
    picture = video.amplitude[sweep][:, cells].astype(float)
    picture[sweep < 0] = np.nan
    low, high = _checked_range(amplitude_range) or (0.0, max(float(np.nanmax(picture)), 1.0))
    near_m = video.start_range_m + cells[0] * video.cell_m
    extent = (*np.rad2deg(azimuth_edges_rad), near_m, near_m + len(cells) * video.cell_m)
    image = _show(ax, picture.T, extent, (low, high))
    ax.set_aspect("auto")

    def scope(places: ArrayLike, name: str) -> tuple[NDArray, NDArray]:
        return _scope_coordinates(_places(name, places), azimuth_rad)

    for outline in strobes:
        ax.plot(*scope(outline, "strobe"), color=STROBE_COLOR, linewidth=1.4, zorder=4)
    if plots is not None:
        ax.plot(*scope(plots, "plots"), **_CROSS)
    ax.set(xlabel="azimuth (°)", ylabel="range (m)")
    ax.ticklabel_format(useOffset=False, style="plain")
    if colorbar:
        _explain_amplitudes(ax, image)
    return _dress_dark(ax)


def circle_outline(centre_m: ArrayLike, radius_m: float, points: int = 61) -> NDArray[np.float64]:
    """Outline (points, 2) of a circle around a position north and east."""
    return ellipse_outline(np.asarray(centre_m), np.eye(2) * radius_m**2, 1.0, points)


def window_outline(
    range_m: float,
    azimuth_rad: float,
    half_range_m: float,
    half_azimuth_rad: float,
    points: int = 15,
) -> NDArray[np.float64]:
    """Outline (2 points + 1, 2), north and east, of a window in range and azimuth."""
    swing = azimuth_rad + np.linspace(-half_azimuth_rad, half_azimuth_rad, points)
    far, near = (
        (range_m + way) * np.exp(1j * turned)
        for way, turned in ((half_range_m, swing), (-half_range_m, swing[::-1]))
    )
    outline = np.concatenate([far, near, far[:1]])
    return np.column_stack([outline.real, outline.imag])


def screen_raster(
    video: RadarVideo | ScanImage, extent_m: tuple[float, float, float, float], pixels: int
) -> NDArray[np.float32]:
    """Video on a square grid, north up: row 0 in the south, NaN without video.

    A pixel has the largest amplitude of the cell at its center and of all cells with their center
    in it: a small picture loses no cell, a large one has no holes.

    Parameters
    ----------
    video : RadarVideo or ScanImage
    extent_m : (west, east, south, north)
    pixels : int
        Pixels of the longer side.

    Returns
    -------
    ndarray (rows, columns) of float32
    """
    video = _as_video(video)
    west, east, south, north = extent_m
    pixel_m = max(east - west, north - south) / pixels
    columns, rows = (max(1, round(side / pixel_m)) for side in (east - west, north - south))
    east_m = west + (np.arange(columns) + 0.5) * (east - west) / columns
    north_m = south + (np.arange(rows) + 0.5) * (north - south) / rows
    steps = _steps(video)
    raster = _cells_below(video, steps, north_m[:, None], east_m)
    latest = _latest(video, steps)
    for sweeps in np.array_split(latest, max(1, len(latest) // _SWEEPS_AT_ONCE)):
        place = np.exp(1j * video.azimuth_rad[sweeps, None])
        row = np.floor((place.real * video.range_m - south) * (rows / (north - south)))
        column = np.floor((place.imag * video.range_m - west) * (columns / (east - west)))
        inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
        pixel = (row[inside] * columns + column[inside]).astype(np.intp)
        np.fmax.at(raster.ravel(), pixel, video.amplitude[sweeps][inside].astype(np.float32))
    return raster


def _as_video(video: RadarVideo | ScanImage) -> RadarVideo:
    if isinstance(video, RadarVideo):
        return video
    if not isinstance(video, ScanImage):
        raise TypeError(f"video must be a RadarVideo or a ScanImage, got {type(video).__name__}")
    return RadarVideo(
        video.amplitude,
        video.azimuth_rad,
        np.zeros_like(video.azimuth_rad),
        video.azimuth_step_rad,
        video.start_range_m,
        video.cell_m,
    )


@dataclass(frozen=True)
class _Steps:
    """A revolution divided into equal steps as wide as a sweep.

    The centers of sweeps are near the middle of steps, so that each sweep of a regular revolution
    has its step, wherever the revolution begins and however its azimuths are rounded.

    Attributes
    ----------
    sweep : ndarray (count,)
        Number of the last sweep in each step, -1 without one.
    shift : float
        Steps from the start of the first to north.
    """

    sweep: NDArray[np.intp]
    shift: float

    @property
    def width_rad(self) -> float:
        return _TURN_RAD / len(self.sweep)

    def of(self, azimuth_rad: ArrayLike) -> NDArray[np.intp]:
        """Number of the step at an azimuth, not wrapped."""
        return np.floor(np.asarray(azimuth_rad) / self.width_rad + self.shift).astype(int)

    def begin_rad(self, step: int) -> float:
        """Azimuth at which a step begins."""
        return (step - self.shift) * self.width_rad


def _steps(video: RadarVideo) -> _Steps:
    """The steps of a revolution with their last sweeps.

    A single empty step between two sweeps takes the previous sweep, because real antennas jitter.
    """
    if len(video) == 0:
        raise ValueError("video must have a sweep, got none")
    count = max(8, round(_TURN_RAD / video.azimuth_width_rad))
    off_rad = np.angle(np.exp(1j * count * video.azimuth_rad).mean())
    steps = _Steps(np.full(count, -1), 0.5 - off_rad / _TURN_RAD)
    sweep = steps.sweep
    sweep[steps.of(video.azimuth_rad) % count] = np.arange(len(video))
    lone = (sweep < 0) & (np.roll(sweep, 1) >= 0) & (np.roll(sweep, -1) >= 0)
    sweep[lone] = np.roll(sweep, 1)[lone]
    return steps


def _latest(video: RadarVideo, steps: _Steps) -> NDArray[np.intp]:
    """Sweeps after which the beam has not returned to their step."""
    step = steps.of(video.azimuth_rad) % len(steps.sweep)
    stay = np.cumsum(np.diff(step, prepend=step[0]) != 0)
    return np.flatnonzero(stay == stay[steps.sweep[step]])


def _cells_below(
    video: RadarVideo, steps: _Steps, north_m: NDArray, east_m: NDArray
) -> NDArray[np.float32]:
    """Amplitude of the cell at each position, NaN without one."""
    sweep = steps.sweep[steps.of(np.arctan2(east_m, north_m)) % len(steps.sweep)]
    cell = np.floor((np.hypot(north_m, east_m) - video.start_range_m) / video.cell_m).astype(int)
    seen = (sweep >= 0) & (cell >= 0) & (cell < video.amplitude.shape[1])
    picture = np.full(seen.shape, np.nan, np.float32)
    picture[seen] = video.amplitude[sweep[seen], cell[seen]]
    return picture


def _sweeps_about(
    video: RadarVideo, azimuth_rad: float, half_rad: float
) -> tuple[NDArray[np.intp], tuple[float, float]]:
    """Sweeps of the steps around an azimuth, in order, and the azimuths of both ends.

    Azimuths are not wrapped.
    """
    steps = _steps(video)
    count = len(steps.sweep)
    first, last = steps.of([azimuth_rad - half_rad, azimuth_rad + half_rad]).tolist()
    last = min(last, first + count - 1)
    edges_rad = (steps.begin_rad(first), steps.begin_rad(last + 1))
    return steps.sweep[np.arange(first, last + 1) % count], edges_rad


def _middle(video: RadarVideo, around_m: tuple[float, float] | None) -> tuple[float, float]:
    """Azimuth from 0 to 2 pi, and range."""
    if around_m is not None:
        if np.shape(around_m) != (2,):
            raise ValueError(f"around_m must be north and east, got {around_m}")
        north_m, east_m = real_numbers("around_m", around_m)
        return float(np.arctan2(east_m, north_m) % _TURN_RAD), float(np.hypot(north_m, east_m))
    if len(video) == 0:
        raise ValueError("video must have a sweep, got none")
    sweep, cell = np.unravel_index(np.argmax(video.amplitude), video.amplitude.shape)
    return float(video.azimuth_rad[sweep] % _TURN_RAD), float(video.range_m[cell])


def _scope_coordinates(places_m: NDArray[np.float64], middle_rad: float) -> tuple[NDArray, NDArray]:
    """Azimuth in degrees, unwrapped around the center, and range in metres."""
    north_m, east_m = places_m.T
    off_rad = (np.arctan2(east_m, north_m) - middle_rad + np.pi) % _TURN_RAD - np.pi
    return np.rad2deg(middle_rad + off_rad), np.hypot(north_m, east_m)


def _checked_extent(
    extent_m: tuple[float, float, float, float] | None, video: RadarVideo
) -> tuple[float, float, float, float]:
    if extent_m is None:
        return _whole_extent(video)
    extent = tuple(float(edge) for edge in extent_m)
    if len(extent) != 4 or not (extent[0] < extent[1] and extent[2] < extent[3]):
        raise ValueError(f"extent_m must be west < east, south < north, got {extent_m}")
    return extent


def _whole_extent(video: RadarVideo) -> tuple[float, float, float, float]:
    """A square around all cells of the video, with a margin."""
    if len(video) == 0:
        raise ValueError("video must have a sweep, got none")
    edge_m = video.range_m[[0, -1]] + 0.5 * video.cell_m * np.array([-1.0, 1.0])
    place = np.exp(1j * video.azimuth_rad)[:, None] * edge_m
    low = np.array([place.imag.min(), place.real.min()])
    high = np.array([place.imag.max(), place.real.max()])
    half_m = (0.5 + _SIDE_AROUND) * np.max(high - low)
    (west, south), (east, north) = (low + high) / 2 - half_m, (low + high) / 2 + half_m
    return float(west), float(east), float(south), float(north)


def _brightness(
    video: RadarVideo, amplitude_range: tuple[float, float] | None
) -> tuple[float, float]:
    asked = _checked_range(amplitude_range)
    if asked is not None:
        return asked
    every = max(1, video.amplitude.size // 1_000_000)
    sample = video.amplitude.ravel()[::every]
    low, high = np.quantile(sample, [_DARKEST_QUANTILE, _BRIGHTEST_QUANTILE])
    return float(low), float(max(high, low + 1.0))


def _checked_range(amplitude_range: tuple[float, float] | None) -> tuple[float, float] | None:
    if amplitude_range is None:
        return None
    low, high = amplitude_range
    if not low < high:
        raise ValueError(f"amplitude_range must be low < high, got {amplitude_range}")
    return float(low), float(high)


def _echo_map() -> Colormap:
    """From dark through sea green to amber, with increasing brightness."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("radar", list(_ECHO_COLORS))


def _dark_halo(width: float = 2.0) -> list:
    from matplotlib import patheffects

    return [patheffects.withStroke(linewidth=width, foreground=SCREEN)]


_CROSS = {
    "linestyle": "none",
    "marker": "+",
    "markersize": 7.0,
    "markeredgewidth": 1.1,
    "color": PLOT_COLOR,
    "zorder": 5,
}


def _draw_rings(ax: Axes, extent: tuple[float, float, float, float], far_m: float) -> None:
    """Rings at round ranges, each labelled to the upper right."""
    from matplotlib.patches import Circle
    from matplotlib.ticker import MaxNLocator

    west, east, south, north = extent
    corner_m = np.hypot([west, west, east, east], [south, north, south, north])
    antenna_inside = west < 0 < east and south < 0 < north
    near_m = 0.0 if antenna_inside else _nearest_m(extent)
    last_m = min(far_m, float(corner_m.max()))
    ticks_m = MaxNLocator(_RINGS, steps=[1, 2, 2.5, 5, 10]).tick_values(near_m, last_m)
    middle = complex(south + north, 0.65 * west + 1.35 * east) / 2.0
    label_rad = np.deg2rad(40.0) if antenna_inside else np.angle(middle)
    unit, per_unit = _unit(extent)
    for ring_m in ticks_m[(ticks_m > near_m) & (ticks_m <= last_m * (1 + 1e-9))]:
        ax.add_patch(
            Circle((0, 0), ring_m, fill=False, edgecolor=SCREEN_GRID, linewidth=0.6, alpha=0.7)
        )
        place = (ring_m * np.sin(label_rad), ring_m * np.cos(label_rad))
        if west < place[0] < east and south < place[1] < north:
            ax.annotate(
                f"{ring_m / per_unit:g} {unit}",
                place,
                ha="center",
                va="center",
                color=SCREEN_INK,
                fontsize=TEXT_PT - 2,
                path_effects=_dark_halo(),
                zorder=3,
            )
    if antenna_inside:
        for quarter in range(4):
            tip = far_m * np.exp(0.5j * np.pi * quarter)
            ax.plot([0, tip.imag], [0, tip.real], color=SCREEN_GRID, linewidth=0.5, alpha=0.45)


def _nearest_m(extent: tuple[float, float, float, float]) -> float:
    west, east, south, north = extent
    return float(np.hypot(np.clip(0.0, west, east), np.clip(0.0, south, north)))


def _draw_layers(
    ax: Axes, plots: ArrayLike | None, strobes: Sequence[ArrayLike], tracks: Tracks | None
) -> None:
    for outline in strobes:
        north_m, east_m = _places("strobe", outline).T
        ax.plot(east_m, north_m, color=STROBE_COLOR, linewidth=1.1, zorder=4)
    if plots is not None:
        north_m, east_m = _places("plots", plots).T
        ax.plot(east_m, north_m, **_CROSS)
    if tracks is not None:
        _draw_tracks(ax, tracks)


def _draw_tracks(ax: Axes, tracks: Tracks) -> None:
    """Each with its id at its end, unless it would cover that of a longer one."""
    from .labels import LoneLabels

    ids = {}
    for k, track_id in enumerate(tracks.ids()):
        color = TRACK_COLORS[k % len(TRACK_COLORS)]
        track = tracks.where(tracks.track_id == track_id)
        _, east_m, north_m = with_gaps(track.time_s, track.east_m, track.north_m)
        dot_lone(*ax.plot(east_m, north_m, color=color, linewidth=1.4, zorder=6))
        end = (track.east_m[-1], track.north_m[-1])
        ids[track_id] = ax.annotate(
            plain(track_id),
            end,
            xytext=(6, 5),
            textcoords="offset points",
            color=color,
            fontsize=TEXT_PT - 1,
            fontweight="bold",
            path_effects=_dark_halo(),
            annotation_clip=True,
            zorder=7,
        )
    ax.add_artist(LoneLabels([ids[track_id] for track_id in by_length(tracks)]))


def _places(name: str, places: ArrayLike) -> NDArray[np.float64]:
    array = real_numbers(name, places)
    if array.size == 0:
        return np.zeros((0, 2))
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"{name} must have shape (n, 2), north and east, got {array.shape}")
    return array


def _dress_screen(ax: Axes, extent: tuple[float, float, float, float]) -> Axes:
    """Ticks in kilometres or metres, no grid over the picture."""
    from matplotlib.ticker import FuncFormatter

    unit, per_unit = _unit(extent)
    for axis, name in ((ax.xaxis, "east"), (ax.yaxis, "north")):
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / per_unit:g}"))
        axis.set_label_text(f"{name} ({unit})")
    return _dress_dark(ax)


def _unit(extent: tuple[float, float, float, float]) -> tuple[str, float]:
    """Unit of lengths on the screen, and its metres."""
    return ("km", 1000.0) if np.abs(extent).max() > _KM_FROM_M else ("m", 1.0)


def _dress_dark(ax: Axes) -> Axes:
    ax.grid(False)
    ax.tick_params(labelsize=TEXT_PT, color=MUTED, labelcolor=INK, length=3)
    for spine in ax.spines.values():
        spine.set_color(MUTED)
    for label in (ax.xaxis.label, ax.yaxis.label):
        label.set_size(TEXT_PT)
        label.set_color(INK)
    return ax


def _show(
    ax: Axes,
    picture: NDArray,
    extent: tuple[float, float, float, float],
    amplitude_range: tuple[float, float],
) -> AxesImage:
    """The picture alone within the axes, on a dark screen."""
    low, high = amplitude_range
    ax.set_facecolor(SCREEN)
    image = ax.imshow(
        picture,
        extent=extent,
        origin="lower",
        cmap=_echo_map(),
        vmin=low,
        vmax=high,
        interpolation="nearest",
        zorder=0,
    )
    ax.set(xlim=extent[:2], ylim=extent[2:])
    return image


def _explain_amplitudes(ax: Axes, image: AxesImage) -> None:
    bar = ax.figure.colorbar(image, ax=ax, pad=0.02, fraction=0.05)
    bar.set_label("amplitude", size=TEXT_PT, color=INK)
    bar.ax.tick_params(labelsize=TEXT_PT - 1, color=MUTED, labelcolor=INK, length=3)
    bar.outline.set_edgecolor(MUTED)
