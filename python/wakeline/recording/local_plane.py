"""A small area of the earth as a plane: north and east in metres around an origin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wakeline._checks import plain_numbers

EARTH_RADIUS_M = 6371e3
"""Of a sphere, where that is near enough."""

_EQUATOR_M = 6378137.0
_FLATTENING = 1.0 / 298.257223563
_ECCENTRICITY_2 = _FLATTENING * (2.0 - _FLATTENING)


@dataclass(frozen=True)
class LocalPlane:
    """The plane that touches the WGS84 ellipsoid at an origin.

    Points at sea are projected onto it straight down, which shortens a distance ``d`` from the
    origin by about ``d^3 / (6 R^2)``: 0.03 m at 20 km, 4 m at 100 km.

    Attributes
    ----------
    latitude_deg, longitude_deg : float
        The origin.

    Raises
    ------
    ValueError
        When the origin is not on the earth.
    """

    latitude_deg: float
    longitude_deg: float

    def __post_init__(self) -> None:
        plain_numbers(latitude_deg=self.latitude_deg, longitude_deg=self.longitude_deg)
        if not (abs(self.latitude_deg) <= 90 and abs(self.longitude_deg) <= 180):
            raise ValueError(
                "latitude_deg must be from -90 to 90 and longitude_deg from -180 to 180, "
                f"got {self.latitude_deg} and {self.longitude_deg}"
            )

    def position_m(
        self, latitude_deg: np.ndarray, longitude_deg: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """North and east (n,) of points at sea level, given in degrees (n,)."""
        origin, north, east = self._frame()
        off = _cartesian(np.radians(latitude_deg), np.radians(longitude_deg)) - origin
        return off @ north, off @ east

    def course_rad(
        self, true_course_rad: np.ndarray, latitude_deg: np.ndarray, longitude_deg: np.ndarray
    ) -> np.ndarray:
        """Courses (n,) in the plane of courses (n,) from true north at points in degrees (n,).

        True north at another place leans against that of the origin by the convergence of the
        meridians, ``sin(latitude)`` times the difference in longitude.
        """
        away_deg = (np.asarray(longitude_deg) - self.longitude_deg + 180.0) % 360.0 - 180.0
        return true_course_rad - np.radians(away_deg) * np.sin(np.radians(latitude_deg))

    def angle_rad(self, latitude_deg: np.ndarray, longitude_deg: np.ndarray) -> np.ndarray:
        """Angles (n,) between the verticals of points in degrees (n,) and that of the origin.

        A way along the line to the origin is shortened by one less the cosine.
        """
        up = verticals(np.radians(latitude_deg), np.radians(longitude_deg))
        own = verticals(*np.radians([self.latitude_deg, self.longitude_deg]))
        return 2.0 * np.arcsin(np.minimum(np.linalg.norm(up - own, axis=-1) / 2.0, 1.0))

    def _frame(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The origin (3,) in earth-centred metres, and unit vectors (3,) north and east."""
        latitude, longitude = np.radians([self.latitude_deg, self.longitude_deg])
        north = np.array(
            [
                -np.sin(latitude) * np.cos(longitude),
                -np.sin(latitude) * np.sin(longitude),
                np.cos(latitude),
            ]
        )
        east = np.array([-np.sin(longitude), np.cos(longitude), 0.0])
        return _cartesian(latitude, longitude), north, east


def verticals(latitude_rad: np.ndarray, longitude_rad: np.ndarray) -> np.ndarray:
    """Unit vectors (..., 3) of verticals."""
    across = np.cos(latitude_rad)
    directions = [across * np.cos(longitude_rad), across * np.sin(longitude_rad)]
    return np.stack([*directions, np.sin(latitude_rad)], axis=-1)


def _cartesian(latitude_rad: np.ndarray, longitude_rad: np.ndarray) -> np.ndarray:
    """Earth-centred coordinates (..., 3) of points on the ellipsoid, metres."""
    across_m = _EQUATOR_M / np.sqrt(1.0 - _ECCENTRICITY_2 * np.sin(latitude_rad) ** 2)
    return np.stack(
        [
            across_m * np.cos(latitude_rad) * np.cos(longitude_rad),
            across_m * np.cos(latitude_rad) * np.sin(longitude_rad),
            across_m * (1.0 - _ECCENTRICITY_2) * np.sin(latitude_rad),
        ],
        axis=-1,
    )
