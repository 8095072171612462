"""Sea and land clutter."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wakeline._checks import (
    above_zero,
    at_least,
    finite,
    fraction,
    number_fields,
    positive,
    real_numbers,
)

from .fields import PolarGrid

_BEAM_RAYS = 9

LandMask = Callable[[NDArray[np.float64], NDArray[np.float64]], NDArray[np.bool_]]


@dataclass(frozen=True, kw_only=True)
class SeaClutter:
    """Sea clutter of K-distributed amplitude.

    In every cell the power is a texture times the power of a speckle. The texture is
    gamma-distributed with mean 1 and variance ``1 / shape``: patches of waves of width
    ``correlation_m`` and lifetime ``correlation_s``. The speckle is exponential, correlated over
    beam and pulse, and independent in each scan. The second moment of the power over the square of
    its mean is therefore ``2 (1 + 1 / shape)``. The mean clutter-to-noise ratio is

        ``clutter_to_noise_db - 10 decay log10(range / reference range)
        + upwind_downwind_db / 2 cos(azimuth - wind_from_rad)``  in dB.

    See K. D. Ward, R. Tough, S. Watts, "Sea Clutter: Scattering, the K Distribution and Radar
    Performance", 2nd edition, IET 2013.

    Attributes
    ----------
    clutter_to_noise_db : float
        Mean clutter-to-noise ratio across the wind, at the radar's reference range.
    decay : float
        Exponent of the range with which the clutter falls; 3 well inside the horizon.
    shape : float
        Of the texture: 0.1 for spiky clutter, inf for none; at least 0.05.
    correlation_m : float
        Distance, in any direction, at which the correlation of the texture has fallen to 1 / e.
    correlation_s : float
        Time at which it has fallen to 1 / e.
    wind_from_rad : float
        Direction the wind comes from.
    upwind_downwind_db : float
        Ratio of the clutter looking upwind to downwind.

    Raises
    ------
    ValueError
        When a value is invalid.
    """

    clutter_to_noise_db: float = 10.0
    decay: float = 3.0
    shape: float = 1.0
    correlation_m: float = 60.0
    correlation_s: float = 8.0
    wind_from_rad: float = 0.0
    upwind_downwind_db: float = 6.0

    def __post_init__(self) -> None:
        finite(
            **number_fields(
                self, "clutter_to_noise_db", "wind_from_rad", "upwind_downwind_db", "decay"
            )
        )
        positive(**number_fields(self, "correlation_m", "correlation_s"))
        at_least(0.05, **number_fields(self, "shape"))

    def mean_amplitude(self, grid: PolarGrid, reference_range_m: float) -> NDArray[np.float32]:
        """Root of the mean clutter-to-noise ratio, (N, C)."""
        wind_db = 0.5 * self.upwind_downwind_db * np.cos(grid.azimuth_rad - self.wind_from_rad)
        range_db = -10.0 * self.decay * np.log10(grid.range_m / reference_range_m)
        return np.outer(
            amplitude_of_db(self.clutter_to_noise_db + wind_db), amplitude_of_db(range_db)
        ).astype(np.float32)


@dataclass(frozen=True, kw_only=True, eq=False)
class Land:
    """Land clutter: constant from scan to scan except for a fluctuation.

    Attributes
    ----------
    where : sequence of (n, 2) arrays, or callable
        Closed outlines in metres north and east of the antenna; an even number of overlapping
        outlines is no land (a lake). Or a function of arrays north and east that is true on land.
    clutter_to_noise_db : float
        Mean clutter-to-noise ratio at the radar's reference range.
    decay : float
        Exponent of the range with which the echo falls.
    shape, correlation_m : float
        Of the gamma texture, as for the sea, but half of it has a quarter of that correlation
        length; it is constant in time.
    fluctuation : float
        Part of the power that is independent in each scan, from 0 to 1.
    penetration_m : float
        Distance over land at which the power of every echo behind has fallen to 1 / e, because
        hills mask it. inf for flat land.

    Raises
    ------
    ValueError
        When a value is invalid.
    """

    where: Sequence[ArrayLike] | LandMask
    clutter_to_noise_db: float = 35.0
    decay: float = 3.0
    shape: float = 0.5
    correlation_m: float = 120.0
    fluctuation: float = 0.1
    penetration_m: float = np.inf

    def __post_init__(self) -> None:
        finite(**number_fields(self, "clutter_to_noise_db", "decay"))
        positive(**number_fields(self, "correlation_m"))
        fraction(**number_fields(self, "fluctuation"))
        at_least(0.05, **number_fields(self, "shape"))
        above_zero(penetration_m=self.penetration_m)
        if not callable(self.where):
            object.__setattr__(
                self, "where", tuple(_outline(k, w) for k, w in enumerate(self.where))
            )

    def mean_amplitude(self, grid: PolarGrid, reference_range_m: float) -> NDArray[np.float32]:
        """Root of the mean clutter-to-noise ratio in each cell of land, (C,)."""
        range_db = -10.0 * self.decay * np.log10(grid.range_m / reference_range_m)
        return amplitude_of_db(self.clutter_to_noise_db + range_db).astype(np.float32)

    def cover(self, grid: PolarGrid, beam_std_rad: float) -> NDArray[np.float32]:
        """Part of the two-way beam's power that falls on land, (N, C) from 0 to 1.

        Raises
        ------
        ValueError
            When the function `where` does not return an array of the requested shape.
        """
        offset = np.linspace(-2.0, 2.0, _BEAM_RAYS)
        weight = np.exp(-0.5 * offset**2)
        weight /= weight.sum()
        offset_rad = offset * beam_std_rad
        if not callable(self.where):
            return _cover_of_outlines(self.where, grid, offset_rad, weight)
        cover = np.zeros(grid.shape, np.float32)
        for turned_rad, part in zip(offset_rad, weight, strict=True):
            cover += np.float32(part) * _masked(self.where, grid.azimuth_rad + turned_rad, grid)
        return cover

    def shade(self, cover: NDArray[np.float32], cell_m: float) -> NDArray[np.float32]:
        """Root of the part of the power that is not masked by land in between, (N, C)."""
        way_m = np.cumsum(cover, axis=1, dtype=np.float32) - cover
        return np.exp(way_m * np.float32(-0.5 * cell_m / self.penetration_m))


def amplitude_of_db(power_db: ArrayLike) -> NDArray[np.float64]:
    """``10^(dB / 20)``."""
    return 10.0 ** (np.asarray(power_db) / 20.0)


def _outline(number: int, outline: ArrayLike) -> NDArray[np.float64]:
    corners = real_numbers(f"outline {number} of where", outline)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3:
        raise ValueError(
            f"outline {number} of where must have shape (n, 2), n at least 3, got {corners.shape}"
        )
    if not np.isfinite(corners).all():
        raise ValueError(f"outline {number} of where must be finite")
    return corners


def _masked(
    where: LandMask, azimuth_rad: NDArray[np.float64], grid: PolarGrid
) -> NDArray[np.bool_]:
    north_m = np.outer(np.cos(azimuth_rad), grid.range_m)
    east_m = np.outer(np.sin(azimuth_rad), grid.range_m)
    inside = np.asarray(where(north_m, east_m), dtype=bool)
    if inside.shape != north_m.shape:
        raise ValueError(f"where must return an array of shape {north_m.shape}, got {inside.shape}")
    return inside


def _cover_of_outlines(
    outlines: Sequence[NDArray[np.float64]],
    grid: PolarGrid,
    offset_rad: NDArray[np.float64],
    weight: NDArray[np.float64],
) -> NDArray[np.float32]:
    """Weight (N, C) of the rays of the beam that end on land in each cell.

    A ray ends inside an outline if an odd number of crossings is ahead. Each ray has one bit, so
    that one pass from the far end inwards counts all of them at once.
    """
    sweeps, cells = grid.shape
    ahead = np.zeros((sweeps, cells + 1), np.uint16)
    for ray, turned_rad in enumerate(offset_rad):
        for corners in outlines:
            sweep, crossing_m = _crossings(corners @ [1.0, 1j], grid, turned_rad)
            last = np.ceil((crossing_m - grid.range_m[0]) / grid.cell_m)
            cell = np.clip(last, 0, cells).astype(int)
            np.bitwise_xor.at(ahead, (sweep, cell), np.uint16(1 << ray))
    inside = np.bitwise_xor.accumulate(ahead[:, :0:-1], axis=1)[:, ::-1]
    bits = np.arange(1 << len(weight))[:, None] >> np.arange(len(weight)) & 1
    return np.take((bits @ weight).astype(np.float32), inside)


def _crossings(
    corners: NDArray[np.complex128], grid: PolarGrid, turned_rad: float
) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Sweeps, rotated by an angle, that cross an edge of the outline, and the ranges.

    An edge from ``p`` along ``v`` crosses the ray along ``u`` at ``Im(p* v) / Im(u* v)``.
    """
    edge = np.roll(corners, -1) - corners
    begin_rad = np.angle(corners)
    end_rad = begin_rad + np.angle(np.roll(corners, -1) / np.where(corners == 0, 1.0, corners))
    begin, end = (
        np.ceil((angle - turned_rad - grid.azimuth_rad[0]) / grid.step_rad).astype(int)
        for angle in (np.minimum(begin_rad, end_rad), np.maximum(begin_rad, end_rad))
    )
    count = end - begin
    which = np.repeat(np.arange(len(corners)), count)
    sweep = np.arange(len(which)) + np.repeat(begin - np.cumsum(count) + count, count)
    ray = np.exp(1j * (grid.azimuth_rad[0] + turned_rad + sweep * grid.step_rad))
    crossed = edge[which]
    range_m = (corners[which].conj() * crossed).imag / (ray.conj() * crossed).imag
    sweep %= grid.sweeps_per_turn
    seen = sweep < grid.shape[0]
    return sweep[seen], range_m[seen]
