"""A vessel in radar video: a hull of scatterers that moves, turns and fluctuates."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from wakeline._checks import finite, not_negative, number_fields, positive, whole_number

SWERLING = (0, 1, 2, 3, 4)


@runtime_checkable
class AnyMotion(Protocol):
    """What a target needs of its truth: a :class:`Truth` or any object with ``state_at``."""

    def state_at(self, time_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """States (T, 4), ``[north, vnorth, east, veast]``, NaN where there is no target."""


@dataclass(frozen=True, kw_only=True)
class VideoTarget:
    """A vessel in radar video.

    Point scatterers of equal mean power are evenly spaced along both sides of the hull. Their
    echoes interfere, each with an independent phase in every pass of the beam: an extended echo is
    irregular and its center wanders (glint), a single point's does not.

    Attributes
    ----------
    truth : Truth
        Or any object with ``state_at``; the center of the hull. NaN where there is no target.
    length_m, beam_m : float
        Length and beam of the hull; 0 for a point.
    rcs_m2 : float
        Mean radar cross-section outside the broadside lobe.
    swerling : int
        Fluctuation of the scatterers' powers: 0 none; 1 and 2 exponential; 3 and 4 chi-square of 4
        degrees of freedom; 1 and 3 from pass to pass, 2 and 4 from sweep to sweep. With many
        scatterers in a cell the echo tends to the exponential; with 1 and 2 it is exactly
        exponential.
    broadside_db : float
        Increase of the cross-section when a flat side faces the radar.
    broadside_width_rad : float
        Width of that lobe at half maximum.
    scatterers : int, optional
        Number of scatterers; default one per 3 m of length and at least 2, one for a point.
    heading_rad : float, optional
        Heading, if it differs from the course over ground, which is the default (north at rest).

    Raises
    ------
    ValueError
        When a value is invalid.
    TypeError
        When the truth has no `state_at`.
    """

    truth: AnyMotion
    length_m: float = 0.0
    beam_m: float = 0.0
    rcs_m2: float = 10.0
    swerling: int = 1
    broadside_db: float = 6.0
    broadside_width_rad: float = 0.35
    scatterers: int | None = None
    heading_rad: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.truth, AnyMotion):
            raise TypeError(f"truth must have state_at, got {self.truth!r}")
        not_negative(**number_fields(self, "length_m", "beam_m", "rcs_m2", "broadside_db"))
        positive(**number_fields(self, "broadside_width_rad"))
        if self.swerling not in SWERLING:
            raise ValueError(f"swerling must be one of {SWERLING}, got {self.swerling!r}")
        if self.scatterers is not None:
            whole_number("scatterers", self.scatterers, 1)
        if self.heading_rad is not None:
            finite(heading_rad=self.heading_rad)

    @cached_property
    def hull_m(self) -> NDArray[np.float64]:
        """Scatterers (S, 2), ahead and to starboard of the center of the hull."""
        count = self.scatterers
        if count is None:
            extended = max(self.length_m, self.beam_m) > 0
            count = max(2, 1 + round(self.length_m / 3.0)) if extended else 1
        if count == 1:
            return np.zeros((1, 2))
        ahead = np.linspace(-0.5, 0.5, count) * self.length_m
        side = np.where(np.arange(count) % 2, 0.5, -0.5) * self.beam_m
        return np.column_stack([ahead, side - side.mean()])

    def heading_at(self, state: NDArray[np.float64]) -> float:
        """Heading in a state (4,)."""
        _, vnorth_mps, _, veast_mps = state
        course_rad = float(np.arctan2(veast_mps, vnorth_mps))
        return course_rad if self.heading_rad is None else self.heading_rad

    def scatterers_at(self, state: NDArray[np.float64]) -> NDArray[np.complex128]:
        """Positions (S,) of the scatterers as north + i east."""
        hull = self.hull_m @ [1.0, 1j]
        return complex(state[0], state[2]) + hull * np.exp(1j * self.heading_at(state))

    def cross_section_at(self, state: NDArray[np.float64]) -> float:
        """Mean cross-section (m^2), with a broadside lobe on both sides of an extended hull.

        A Gaussian lobe over the angle between the line of sight and the vessel's beam.
        """
        if self.length_m == 0:
            return self.rcs_m2
        sight_rad = np.arctan2(state[2], state[0]) - self.heading_at(state)
        off_beam_rad = np.arcsin(abs(np.cos(sight_rad)))
        lobe = np.exp(-4.0 * np.log(2.0) * (off_beam_rad / self.broadside_width_rad) ** 2)
        return self.rcs_m2 * (1.0 + (10.0 ** (self.broadside_db / 10.0) - 1.0) * lobe)

    def fluctuations(self, rng: np.random.Generator, sweeps: int) -> NDArray[np.complex128]:
        """Amplitudes of unit mean power: one row per pass, or per sweep, and S columns."""
        size = (sweeps if self.swerling in (2, 4) else 1, len(self.hull_m))
        phase = np.exp(1j * rng.uniform(0.0, 2.0 * np.pi, size))
        if self.swerling == 0:
            return phase
        degrees = 1.0 if self.swerling in (1, 2) else 2.0
        return phase * np.sqrt(rng.standard_gamma(degrees, size) / degrees)
