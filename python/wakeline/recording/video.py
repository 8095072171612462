"""Radar video: the amplitudes of sweeps."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from wakeline._brief import brief, many, span
from wakeline._checks import not_negative, positive, real_numbers

_TURN = 2 * math.pi
_BACK_RAD = 0.2  # of steps against the antenna's direction: more than any jitter


@dataclass(frozen=True)
class RadarVideo:
    """Sweeps of one geometry, in the order of time.

    Parameters
    ----------
    amplitude : (N, C) array of uint8 or uint16
        C range cells of N sweeps, from the antenna outwards.
    azimuth_rad : (N,) array
        Center of each sweep, clockwise from north.
    time_s : (N,) array
        Time of each sweep.
    azimuth_width_rad : float
        Width of a sweep: from its center to that of the next one.
    start_range_m : float
        Near edge of the first cell.
    cell_m : float
        Length of a range cell.

    Raises
    ------
    ValueError
        When the shapes do not fit, or a length is invalid.
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
            values = np.ascontiguousarray(real_numbers(name, getattr(self, name)))
            if values.shape != (len(amplitude),):
                raise ValueError(f"{name} must have shape ({len(amplitude)},), got {values.shape}")
            object.__setattr__(self, name, values)
        if not 0 < self.azimuth_width_rad < np.pi:
            raise ValueError(
                f"azimuth_width_rad must be between 0 and pi, got {self.azimuth_width_rad}"
            )
        not_negative(start_range_m=self.start_range_m)
        positive(cell_m=self.cell_m)

    def __len__(self) -> int:
        return len(self.amplitude)

    def __repr__(self) -> str:
        cells = many(self.amplitude.shape[1], "cell")
        return brief(self, many(len(self), "sweep"), f"of {cells}", span(self.time_s))

    def beyond(self, range_m: float) -> RadarVideo:
        """The cells that begin at a range or farther away; at least the last one."""
        nearer = math.ceil((range_m - self.start_range_m) / self.cell_m - 1e-9)
        first = min(nearer, self.amplitude.shape[1] - 1)
        if first <= 0:
            return self
        start_range_m = self.start_range_m + first * self.cell_m
        return replace(self, amplitude=self.amplitude[:, first:], start_range_m=start_range_m)

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
        """(C,) centers of the cells."""
        return self.start_range_m + (np.arange(self.amplitude.shape[1]) + 0.5) * self.cell_m

    def turns(self) -> Iterator[RadarVideo]:
        """The revolutions of the antenna one by one, split as by `read_video`."""
        beam = Beam()
        begins = [beam.begins_turn(azimuth_rad) for azimuth_rad in self.azimuth_rad.tolist()]
        cuts = np.flatnonzero(begins)
        for first, last in zip([0, *cuts], [*cuts, len(self)], strict=True):
            if last > first:
                yield self[first:last]


class Beam:
    """Azimuth of the beam, sweep by sweep, and the starts of revolutions.

    A revolution begins at north, in either direction. For a sector scan it begins where the beam
    goes back, at once if the gap is not transmitted, or gradually if the antenna turns back. After
    a full revolution the beam must remain behind, because a few sweeps may be false or most of a
    revolution may be lost.

    Attributes
    ----------
    reversals : int
        Steps against the previous step.
    """

    def __init__(self) -> None:
        self.reversals = 0
        self._way_rad = 0.0  # clockwise until the antenna's direction is known
        self._azimuth_rad: float | None = None
        self._step_rad = 0.0  # the last that was not zero
        self._seen_rad = 0.0  # path until the antenna's direction is known
        self._sense = 0.0
        self._goes_round = False
        self._begin(0.0, from_north=True)

    @property
    def turned_rad(self) -> float:
        """Total path in either direction; the part of a revolution that is not sent counts."""
        return self._way_rad if self._sense else abs(self._way_rad)

    def begins_turn(self, azimuth_rad: float) -> bool:
        """Whether a revolution begins with the next sweep, at this azimuth."""
        azimuth_rad %= _TURN
        before_rad, self._azimuth_rad = self._azimuth_rad, azimuth_rad
        if before_rad is None:
            self._begin(azimuth_rad, from_north=True)
            return False
        step_rad = (azimuth_rad - before_rad + math.pi) % _TURN - math.pi
        back = -step_rad * self._likely_sense > self._most_back_rad
        if back:
            step_rad += self._likely_sense * _TURN
        elif step_rad and (self._likely_sense or abs(step_rad) <= _BACK_RAD):
            self.reversals += step_rad * self._step_rad < 0
            self._step_rad = step_rad
        self._learn_sense(step_rad)
        self._way_rad += step_rad * (self._sense or 1.0)
        if back and not self._goes_round:
            self._begin(azimuth_rad, from_north=False)
            return True
        if step_rad * self._sense > _BACK_RAD:
            self._left_rad = self._place_rad
        turns = round((self._place_rad + step_rad - azimuth_rad) / _TURN)
        self._place_rad = azimuth_rad + turns * _TURN  # exact, unlike a sum of steps
        return self._turns_back(step_rad) or self._completes()

    @property
    def _likely_sense(self) -> float:
        """Direction of the antenna from the steps until now; 0 if unknown."""
        return self._sense or float(np.sign(self._seen_rad))

    @property
    def _most_back_rad(self) -> float:
        return math.pi / 2 if self._goes_round else _BACK_RAD

    def _begin(self, place_rad: float, *, from_north: bool) -> None:
        """Begin a revolution at an azimuth, from which azimuths continue unwrapped."""
        self._from_north = from_north
        self._start_rad = self._place_rad = self._furthest_rad = self._left_rad = place_rad
        self._behind_rad = 0.0

    def _learn_sense(self, step_rad: float) -> None:
        if self._sense or abs(step_rad) > _BACK_RAD:
            return
        self._seen_rad += step_rad
        sense = self._likely_sense
        if -self._way_rad * sense > _BACK_RAD:  # it went back before the direction was known
            self._way_rad += sense * _TURN
        if abs(self._seen_rad) > _BACK_RAD:
            self._sense = sense
            self._way_rad *= sense

    def _turns_back(self, step_rad: float) -> bool:
        steps_back = step_rad * self._sense < -_BACK_RAD
        returns = steps_back and (self._place_rad - self._left_rad) * self._sense > 0.0
        if returns or (self._place_rad - self._furthest_rad) * self._sense >= 0.0:
            self._furthest_rad = self._place_rad
            self._behind_rad = 0.0
        back_rad = (self._furthest_rad - self._place_rad) * self._sense
        if back_rad <= _BACK_RAD:
            return False
        if abs(step_rad) <= _BACK_RAD:
            self._behind_rad += step_rad * self._sense
        reverses = self._behind_rad < 0.0 and back_rad > self._most_back_rad
        if not reverses and not (self._goes_round and self._behind_rad > _BACK_RAD):
            return False
        if reverses:
            self._sense = -self._sense
            self._way_rad += 2.0 * back_rad
        self._goes_round = False
        self._begin(self._place_rad % _TURN, from_north=False)
        return True

    def _completes(self) -> bool:
        """Whether the beam reached north, or the start of a sector after a full revolution."""
        low_rad = 0.0 if self._from_north else self._start_rad - _TURN
        high_rad = _TURN if self._from_north else self._start_rad + _TURN
        complete = (self._sense >= 0.0 and self._place_rad >= high_rad) or (
            self._sense <= 0.0 and self._place_rad < low_rad
        )
        if complete:
            self._goes_round = abs(self._place_rad - self._start_rad) > _TURN - _BACK_RAD
            self._begin(self._place_rad % _TURN, from_north=True)
        return complete
