"""Correlated random fields over a sector of sweeps and cells, and the texture of clutter."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

_KERNEL_SIGMAS = 4.0
_NO_GAIN = 1e-4
_TABLE_EDGE = 5.5
_TABLE_SIZE = 4096
_HERMITE_TERMS = 40


@dataclass(frozen=True)
class PolarGrid:
    """Sweeps and cells of a revolution or a sector of it.

    Attributes
    ----------
    azimuth_rad : ndarray (N,)
        Centers of the sweeps, not wrapped.
    range_m : ndarray (C,)
        Centers of the cells.
    sweeps_per_turn : int
    cell_m : float
    """

    azimuth_rad: NDArray[np.float64]
    range_m: NDArray[np.float64]
    sweeps_per_turn: int
    cell_m: float

    @property
    def shape(self) -> tuple[int, int]:
        return len(self.azimuth_rad), len(self.range_m)

    @property
    def step_rad(self) -> float:
        """Angle between the centers of consecutive sweeps."""
        return 2.0 * np.pi / self.sweeps_per_turn

    def padded(self, sweeps: float, cells: float) -> tuple[int, int]:
        """Sweeps and cells of a periodic field from which the grid can be cut.

        The ends of the cut are independent for a kernel of that many sweeps or cells. A full
        revolution is periodic.
        """
        rows, columns = self.shape
        wanted = quick_length(rows + math.ceil(min(sweeps, self.sweeps_per_turn)))
        return min(wanted, self.sweeps_per_turn), quick_length(columns + math.ceil(cells))


class Speckle:
    """Complex Gaussian field of unit power: the echo of many scatterers in beam and pulse.

    Parameters
    ----------
    grid : PolarGrid
    beam_std_rad, pulse_std_m : float
        Standard deviations of the Gaussian amplitude responses that smooth it.
    """

    def __init__(self, grid: PolarGrid, beam_std_rad: float, pulse_std_m: float) -> None:
        sweeps, cells = beam_std_rad / grid.step_rad, pulse_std_m / grid.cell_m
        support = 2.0 * _KERNEL_SIGMAS
        rows, columns = grid.padded(support * sweeps, support * cells)
        self._shape, self._rows = grid.shape, rows
        across = _kernel_spectrum(rows, sweeps)
        self._band = np.flatnonzero(across > _NO_GAIN * across[0])
        self._across = across[self._band, None]
        self._along = _kernel_spectrum(columns, cells)

    def draw(self, rng: np.random.Generator) -> NDArray[np.complex64]:
        """A field (N, C), independent of the previous ones."""
        rows, columns = self._shape
        white = complex_normal(rng, (len(self._band), len(self._along)))
        smooth = np.fft.ifft(white * self._along, axis=1, norm="ortho")[:, :columns]
        spectrum = np.zeros((self._rows, columns), np.complex64)
        spectrum[self._band] = smooth * self._across
        return np.fft.ifft(spectrum, axis=0, norm="ortho")[:rows]


class PatchyField:
    """Real Gaussian field of unit variance with one correlation length in metres everywhere.

    The correlation is ``exp(-(d / length)^2)`` in the distance d. Across the beam a length is
    fewer sweeps at a longer range, so every range has a separate spectrum.

    Parameters
    ----------
    grid : PolarGrid
    length_m : float
        Distance at which the correlation has fallen to 1 / e.
    """

    def __init__(self, grid: PolarGrid, length_m: float) -> None:
        kernel_m = 0.5 * length_m
        sweeps = kernel_m / (grid.range_m * grid.step_rad)
        support = 2.0 * _KERNEL_SIGMAS
        rows, columns = grid.padded(support * sweeps.max(), support * kernel_m / grid.cell_m)
        self._shape, self._rows = grid.shape, rows
        along = _kernel_spectrum(columns, kernel_m / grid.cell_m)
        self._columns = columns
        self._band = np.flatnonzero(along > _NO_GAIN * along[0])
        self._along = along[self._band]
        self._across = _half_spectra(rows, sweeps.astype(np.float32))

    def draw(self, rng: np.random.Generator) -> NDArray[np.float32]:
        """A field (N, C), independent of the previous ones."""
        rows, columns = self._shape
        spectrum = np.zeros((len(self._across), self._columns), np.complex64)
        white = _unit_pairs(rng, (len(self._across), len(self._band)))
        spectrum[:, self._band] = white * self._along
        smooth = np.fft.ifft(spectrum, axis=1, norm="ortho")[:, :columns]
        return np.fft.irfft(smooth * self._across, n=self._rows, axis=0)[:rows]


@dataclass(frozen=True)
class GammaTexture:
    """Gamma-distributed power of mean 1, transformed from a Gaussian field.

    Attributes
    ----------
    shape : float
        Reciprocal of the variance; inf for a texture that is 1 everywhere.
    """

    shape: float

    def amplitude(self, gaussian: NDArray[np.float32]) -> NDArray[np.float32]:
        """Square root of the texture at values of a standard Gaussian field."""
        scale = (_TABLE_SIZE - 1) / (2.0 * _TABLE_EDGE)
        index = (gaussian * np.float32(scale) + np.float32(0.5 * _TABLE_SIZE)).astype(np.int32)
        return np.take(self._amplitude_table, index, mode="clip")

    @cached_property
    def gaussian_correlation(self) -> float:
        """Correlation of the Gaussian field where that of the texture is 1 / e.

        With Hermite polynomials ``He_n`` and ``c_n = E[texture He_n]``, fields that correlate by
        ``r`` have textures that correlate by ``sum_n c_n^2 r^n / n!`` over the same sum at 1.
        """
        if np.isinf(self.shape):
            return math.exp(-1.0)
        z = _table_places()
        weight = np.exp(-0.5 * z**2) * self._amplitude_table.astype(float) ** 2
        before, polynomial, power = np.ones_like(z), z, []
        for n in range(1, _HERMITE_TERMS):
            power.append(np.sum(weight * polynomial) ** 2)
            before, polynomial = (
                polynomial,
                (z * polynomial - math.sqrt(n) * before) / math.sqrt(n + 1),
            )
        r = np.linspace(0.0, 1.0, 1001)
        texture = np.polynomial.polynomial.polyval(r, [0.0, *power]) / np.sum(power)
        return float(np.interp(math.exp(-1.0), texture, r))

    @cached_property
    def _amplitude_table(self) -> NDArray[np.float32]:
        """Square root of the gamma quantile of the normal distribution, at the table's points."""
        if np.isinf(self.shape):
            return np.ones(_TABLE_SIZE, np.float32)
        spread, skew = 12.0 / math.sqrt(self.shape), 40.0 / self.shape
        log_power = np.linspace(-spread - skew, spread + math.log1p(skew), 40_001)
        density = np.exp(self.shape * (log_power - np.expm1(log_power)))
        below = np.cumsum(0.5 * (density[1:] + density[:-1]))
        chance = np.array([0.5 * math.erfc(-z / math.sqrt(2.0)) for z in _table_places()])
        quantile = np.interp(chance, np.append(0.0, below) / below[-1], log_power)
        return np.exp(0.5 * quantile).astype(np.float32)


def complex_normal(rng: np.random.Generator, shape: tuple[int, int]) -> NDArray[np.complex64]:
    """Circular Gaussian values of unit power."""
    return _unit_pairs(rng, shape) * np.float32(math.sqrt(0.5))


def quick_length(least: int) -> int:
    """The smallest product of 2, 3 and 5 that is at least `least`: quick to transform.

    >>> quick_length(217)
    225
    """
    length = least
    while _without_small_factors(length) > 1:
        length += 1
    return length


def _without_small_factors(number: int) -> int:
    for factor in (2, 3, 5):
        while number % factor == 0:
            number //= factor
    return number


def _unit_pairs(rng: np.random.Generator, shape: tuple[int, int]) -> NDArray[np.complex64]:
    """Complex values whose real and imaginary parts have unit variance."""
    return rng.standard_normal((*shape, 2), dtype=np.float32).view(np.complex64)[..., 0]


def _kernel_spectrum(length: int, std: float) -> NDArray[np.float32]:
    """Spectrum (length,) of a periodic Gaussian kernel of unit energy, `std` samples wide."""
    distance = np.arange(length)
    distance = np.minimum(distance, length - distance)
    kernel = np.exp(-0.5 * (distance / max(std, 1e-3)) ** 2)
    return np.fft.fft(kernel / np.sqrt(np.sum(kernel**2))).real.astype(np.float32)


def _half_spectra(length: int, std: NDArray[np.float32]) -> NDArray[np.float32]:
    """Gains (length // 2 + 1, C) that turn unit pairs into a half spectrum of unit variance.

    Column c smooths with a Gaussian kernel `std[c]` samples wide. The inverse transform uses only
    the real part of the first row, and of the last row of an even length.
    """
    turn = 2.0 * np.pi * np.fft.rfftfreq(length).astype(np.float32)
    power = np.exp(-((turn[:, None] * std) ** 2))
    twice = np.full((len(turn), 1), 2.0, np.float32)
    twice[0] = 1.0
    if length % 2 == 0:
        twice[-1] = 1.0
    share = power / np.sum(twice * power, axis=0)
    return length * np.sqrt(share / twice)


def _table_places() -> NDArray[np.float64]:
    return np.linspace(-_TABLE_EDGE, _TABLE_EDGE, _TABLE_SIZE)
