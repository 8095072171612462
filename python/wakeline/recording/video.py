"""Radar video: the amplitudes of sweeps, as a radar gives them to whoever looks for echoes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from wakeline._brief import brief, many, span


@dataclass(frozen=True)
class RadarVideo:
    """Sweeps of one geometry, in the order of time.

    Parameters
    ----------
    amplitude : (N, C) array of uint8 or uint16
        Of N sweeps the C range cells, from the antenna outwards.
    azimuth_rad : (N,) array
        Centre of each sweep, clockwise from north.
    time_s : (N,) array
        When the beam stood there.
    azimuth_width_rad : float
        What a sweep stands for: from its centre to that of the next one.
    start_range_m : float
        Near edge of the first cell.
    cell_m : float
        Length of a range cell.

    Raises
    ------
    ValueError
        When the arrays do not fit each other, or a length makes no sense.
    """

    amplitude: NDArray[np.uint8] | NDArray[np.uint16]
    azimuth_rad: NDArray[np.float64]
    time_s: NDArray[np.float64]
    azimuth_width_rad: float
    start_range_m: float
    cell_m: float

    def __post_init__(self) -> None:
        amplitude = np.ascontiguousarray(self.amplitude)
        if amplitude.dtype not in (np.uint8, np.uint16):
            raise ValueError(f"amplitude must be of uint8 or uint16, got {amplitude.dtype}")
        if amplitude.ndim != 2 or amplitude.shape[1] == 0:
            raise ValueError(f"amplitude must have shape (N, C), got {amplitude.shape}")
        object.__setattr__(self, "amplitude", amplitude)
        for name in ("azimuth_rad", "time_s"):
            values = np.ascontiguousarray(getattr(self, name), dtype=float)
            if values.shape != (len(amplitude),):
                raise ValueError(f"{name} must have shape ({len(amplitude)},), got {values.shape}")
            object.__setattr__(self, name, values)
        if not 0 < self.azimuth_width_rad < np.pi:
            raise ValueError(
                f"azimuth_width_rad must be between 0 and pi, got {self.azimuth_width_rad}"
            )
        if not (np.isfinite(self.start_range_m) and self.start_range_m >= 0):
            raise ValueError(
                f"start_range_m must be finite and not negative, got {self.start_range_m}"
            )
        if not (np.isfinite(self.cell_m) and self.cell_m > 0):
            raise ValueError(f"cell_m must be finite and positive, got {self.cell_m}")

    def __len__(self) -> int:
        return len(self.amplitude)

    def __repr__(self) -> str:
        cells = many(self.amplitude.shape[1], "cell")
        return brief(self, many(len(self), "sweep"), f"of {cells}", span(self.time_s))

    def __getitem__(self, sweeps: slice) -> RadarVideo:
        """Some of the sweeps."""
        return replace(
            self,
            amplitude=self.amplitude[sweeps],
            azimuth_rad=self.azimuth_rad[sweeps],
            time_s=self.time_s[sweeps],
        )

    @property
    def range_m(self) -> NDArray[np.float64]:
        """(C,) centres of the cells."""
        return self.start_range_m + (np.arange(self.amplitude.shape[1]) + 0.5) * self.cell_m

    def turns(self) -> Iterator[RadarVideo]:
        """The turns of the antenna one by one, cut where it passes north."""
        azimuth = np.mod(self.azimuth_rad, 2 * np.pi)
        cuts = np.flatnonzero(np.diff(azimuth) < -np.pi) + 1
        for first, last in zip([0, *cuts], [*cuts, len(self)], strict=True):
            if last > first:
                yield self[first:last]
