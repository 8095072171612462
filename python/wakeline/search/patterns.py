"""Search patterns by their names in the IAMSAR Manual, volume II."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from wakeline._checks import positive, shaped

_SECTOR_LEGS = 9
_PASS_TURN_RAD = np.pi / 6
_FEWEST_LEGS = 2
_CIRCLE_CORNERS = 24


@dataclass(frozen=True)
class Pattern:
    """A search pattern in its place.

    Attributes
    ----------
    kind : str
        One of `PATTERNS`.
    center_m : (2,) array
        Of the area, [north, east].
    orientation_rad : float
        Direction of the first leg, clockwise from north.
    spacing_m : float
        Track spacing; for a sector search the radius, which is the length of its legs.
    length_m : float
        Of the whole route.
    legs : int
        Of a parallel sweep or a creeping line; the others turn until their length is used up.
    mirrored : bool
        Whether the first turn is to port, else to starboard.

    Raises
    ------
    ValueError
        When the kind is unknown or a length is not positive.
    """

    kind: str
    center_m: np.ndarray
    orientation_rad: float
    spacing_m: float
    length_m: float
    legs: int = _FEWEST_LEGS
    mirrored: bool = False

    def __post_init__(self) -> None:
        if self.kind not in PATTERNS:
            raise ValueError(f"kind must be one of {', '.join(PATTERNS)}, got {self.kind!r}")
        object.__setattr__(self, "center_m", shaped("center_m", self.center_m, 2))
        positive(spacing_m=self.spacing_m, length_m=self.length_m)

    @property
    def sides_m(self) -> tuple[float, float]:
        """Length of the area along the first leg, and across it."""
        return PATTERNS[self.kind].sides_m(self)

    @property
    def area_m2(self) -> float:
        """Area that the pattern covers."""
        along_m, across_m = self.sides_m
        return along_m * across_m * (np.pi / 4 if self.kind == "sector" else 1.0)

    def turning_points_m(self) -> np.ndarray:
        """(K, 2) positions [north, east] from the commence search point to the end."""
        return self._placed(PATTERNS[self.kind].points_m(self))

    def outline_m(self) -> np.ndarray:
        """Corners (k, 2) of the area; of a circle those of the regular polygon around it."""
        along_m, across_m = self.sides_m
        if self.kind == "sector":
            turn_rad = 2.0 * np.pi / _CIRCLE_CORNERS * np.arange(_CIRCLE_CORNERS)
            corners = np.column_stack([np.cos(turn_rad), np.sin(turn_rad)])
            corners /= np.cos(np.pi / _CIRCLE_CORNERS)
        else:
            corners = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]])
        return self._placed(0.5 * corners * [along_m, across_m])

    @property
    def label(self) -> str:
        """Name of the kind in words."""
        return PATTERNS[self.kind].label

    def holds(self, position_m: np.ndarray) -> np.ndarray:
        """Which positions (n, 2) are in the area."""
        along_m, across_m = self.sides_m
        c, s = np.cos(self.orientation_rad), np.sin(self.orientation_rad)
        part = np.abs((position_m - self.center_m) @ np.array([[c, -s], [s, c]]))
        if self.kind == "sector":
            return np.hypot(*part.T) <= 0.5 * along_m
        return (part[:, 0] <= 0.5 * along_m) & (part[:, 1] <= 0.5 * across_m)

    def _placed(self, points_m: np.ndarray) -> np.ndarray:
        """Points [along the first leg, to starboard of it] from the center, in their place."""
        along, across = points_m.T * np.array([[1.0], [-1.0 if self.mirrored else 1.0]])
        c, s = np.cos(self.orientation_rad), np.sin(self.orientation_rad)
        return self.center_m + np.column_stack([c * along - s * across, s * along + c * across])


def leg_count(length_m: float, spacing_m: float, aspect: float) -> int:
    """Legs of a parallel sweep whose area is `aspect` times as long (along the legs) as wide."""
    return max(_FEWEST_LEGS, round(np.sqrt(length_m / (spacing_m * aspect))))


# Parallel sweep and creeping line ----------------------------------------------------------------


def _leg_m(p: Pattern) -> float:
    return (p.length_m - (p.legs - 1) * p.spacing_m) / p.legs


def _sweep_points_m(p: Pattern) -> np.ndarray:
    """Legs side by side: half a spacing from the sides, from end to end half a spacing inside."""
    across_m = p.spacing_m * (np.arange(p.legs) - 0.5 * (p.legs - 1))
    end_m = 0.5 * _leg_m(p) * np.where(np.arange(p.legs) % 2 == 0, 1.0, -1.0)
    along_m = np.column_stack([-end_m, end_m]).ravel()
    return np.column_stack([along_m, np.repeat(across_m, 2)])


def _sweep_sides_m(p: Pattern) -> tuple[float, float]:
    return _leg_m(p) + p.spacing_m, p.legs * p.spacing_m


# Expanding square --------------------------------------------------------------------------------


def _square_legs_m(p: Pattern) -> np.ndarray:
    """S, S, 2S, 2S, ... until the length is used up."""
    most = int(2.0 * np.sqrt(p.length_m / p.spacing_m)) + 3
    legs_m = p.spacing_m * (1 + np.arange(most) // 2)
    before_m = np.cumsum(legs_m) - legs_m
    legs_m = np.minimum(legs_m, p.length_m - before_m)
    return legs_m[legs_m > 0.0]


def _square_points_m(p: Pattern) -> np.ndarray:
    return _joined(_square_legs_m(p), np.pi / 2 * np.arange(len(_square_legs_m(p))))


def _square_sides_m(p: Pattern) -> tuple[float, float]:
    side_m = np.max(_square_legs_m(p)) + p.spacing_m
    return side_m, side_m


# Sector search -----------------------------------------------------------------------------------


def _sector_points_m(p: Pattern) -> np.ndarray:
    """Three triangles about the center with turns of 120 degrees; a new pass is turned by 30."""
    count = int(np.ceil(p.length_m / p.spacing_m - 1e-9))
    leg = np.arange(count)
    # Every third leg ends at the center, and the next one continues straight.
    turns = leg - leg // 3
    course_rad = 2.0 * np.pi / 3.0 * turns + _PASS_TURN_RAD * (leg // _SECTOR_LEGS)
    legs_m = np.minimum(p.spacing_m, p.length_m - p.spacing_m * leg)
    return _joined(legs_m, course_rad)


def _sector_sides_m(p: Pattern) -> tuple[float, float]:
    return 2.0 * p.spacing_m, 2.0 * p.spacing_m


def _joined(legs_m: np.ndarray, course_rad: np.ndarray) -> np.ndarray:
    steps_m = legs_m[:, None] * np.column_stack([np.cos(course_rad), np.sin(course_rad)])
    return np.vstack([np.zeros(2), np.cumsum(steps_m, axis=0)])


@dataclass(frozen=True)
class _Kind:
    points_m: Callable[[Pattern], np.ndarray]
    sides_m: Callable[[Pattern], tuple[float, float]]
    label: str


PATTERNS = {
    "parallel_sweep": _Kind(_sweep_points_m, _sweep_sides_m, "parallel sweep"),
    "creeping_line": _Kind(_sweep_points_m, _sweep_sides_m, "creeping line"),
    "expanding_square": _Kind(_square_points_m, _square_sides_m, "expanding square"),
    "sector": _Kind(_sector_points_m, _sector_sides_m, "sector search"),
}
"""Search patterns by name, as the IAMSAR Manual has them."""


def is_regular(p: Pattern) -> bool:
    """Whether the shape is one of its kind: a parallel sweep has long legs, a creeping line short
    ones, and legs are longer than their spacing."""
    if p.kind not in ("parallel_sweep", "creeping_line"):
        return True
    along_m, across_m = p.sides_m
    return _leg_m(p) > p.spacing_m and (along_m >= across_m) == (p.kind == "parallel_sweep")


def datum_square(kind: str, datum_m: np.ndarray, length_m: float, sweep_width_m: float) -> Pattern:
    """A pattern of coverage 1 in a square about the datum (a sector search in a circle), with its
    first leg to north (of a creeping line to east)."""
    if kind == "sector":
        return Pattern(kind, datum_m, 0.0, np.sqrt(sweep_width_m * length_m / np.pi), length_m)
    legs = leg_count(length_m, sweep_width_m, 1.0)
    turned = np.pi / 2 if kind == "creeping_line" else 0.0
    return Pattern(kind, datum_m, turned, sweep_width_m, length_m, legs)
