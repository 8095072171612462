"""Zones of the picture: guard zones, exclusion zones and land, and the tracks inside them."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wakeline._brief import cut, quoted
from wakeline._checks import finite, not_negative
from wakeline.track import Radar

KINDS = ("guard", "exclusion", "land")
TRIGGERS = ("entry", "exit", "occupancy")
MOST_ZONES = 64
MOST_CORNERS = 100
MOST_NAME = 40
_FAR_M = 1e6
_TURN_RAD = 2.0 * np.pi
_LEAVING_STDS = 2.0
_OF_TRACK = 4.0  # standard deviations


@dataclass(frozen=True, kw_only=True)
class Zone:
    """An area fixed to the ground, or a sector of a ring about own ship.

    Attributes
    ----------
    zone_id : int
        Positive once it is in :class:`Zones`; never used again.
    name : str
    kind : str
        "guard" (alarms), "exclusion" (plots inside start no track, and update those that have come
        in) or "land" (plots inside are not used).
    outline_m : ndarray (n, 2) or None
        Corners [north, east] of a polygon, 3 or more. None for a sector.
    near_m, far_m : float
        Inner and outer radius of a sector about own ship.
    from_rad, to_rad : float
        Its sides, clockwise; the same side twice is the whole ring.
    from_bow : bool
        Whether the sides are relative to the bow; else to north.
    triggers : tuple of str
        Which of "entry", "exit" and "occupancy" raise alarms.
    occupancy_s : float
        A stay of this length is an occupancy.
    hysteresis_m : float
        A track has left when it is outside by this distance and by two standard deviations of its
        position.

    Raises
    ------
    ValueError
        When a value is out of range; the message names it.
    TypeError
        When a value has a wrong type.
    """

    name: str = "zone"
    kind: str = "guard"
    outline_m: NDArray[np.float64] | None = None
    near_m: float = 0.0
    far_m: float = 0.0
    from_rad: float = 0.0
    to_rad: float = 0.0
    from_bow: bool = False
    triggers: tuple[str, ...] = ("entry",)
    occupancy_s: float = 60.0
    hysteresis_m: float = 10.0
    zone_id: int = 0

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or len(self.name) > MOST_NAME:
            raise ValueError(f"name must be a text of at most {MOST_NAME} characters")
        if self.kind not in KINDS:
            raise ValueError(f"kind must be one of {', '.join(KINDS)}, got {quoted(self.kind)}")
        triggers = self.triggers
        if not isinstance(triggers, (list, tuple)) or not set(triggers) <= set(TRIGGERS):
            raise ValueError(f"triggers must be of {', '.join(TRIGGERS)}, got {quoted(triggers)}")
        object.__setattr__(self, "triggers", tuple(t for t in TRIGGERS if t in triggers))
        if not isinstance(self.from_bow, bool):
            raise TypeError(f"from_bow must be true or false, got {quoted(self.from_bow)}")
        not_negative(occupancy_s=self.occupancy_s, hysteresis_m=self.hysteresis_m)
        if self.outline_m is None:
            self._check_sector()
        else:
            object.__setattr__(self, "outline_m", _corners(self.outline_m))

    def _check_sector(self) -> None:
        not_negative(near_m=self.near_m, far_m=self.far_m)
        finite(from_rad=self.from_rad, to_rad=self.to_rad)
        if not self.near_m < self.far_m <= _FAR_M:
            raise ValueError(
                f"far_m must be above near_m and at most {_FAR_M:g}, got near_m {self.near_m:g} "
                f"and far_m {self.far_m:g}; a polygon needs outline_m"
            )
        if self.kind != "guard":
            raise ValueError(f"a zone of kind {self.kind} must be a polygon (outline_m)")

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Zone:
        """From a JSON object with the names of the attributes."""
        if not isinstance(values, Mapping):
            raise TypeError(f"zone must be an object, got {quoted(values)}")
        known = {one.name for one in fields(cls)}
        for name in values:
            if name not in known:
                raise ValueError(f"unknown key {cut(str(name))} of a zone")
        return cls(**values)

    def as_dict(self) -> dict[str, Any]:
        """For JSON; :meth:`of` reads it."""
        values = {one.name: getattr(self, one.name) for one in fields(self)}
        values["triggers"] = list(self.triggers)
        if self.outline_m is None:
            del values["outline_m"]
            return values
        values["outline_m"] = self.outline_m.tolist()
        return {k: v for k, v in values.items() if k not in _SECTOR}

    @property
    def is_sector(self) -> bool:
        """Whether it moves with own ship."""
        return self.outline_m is None

    def depth_m(self, place_m: ArrayLike, own: OwnPlace | None = None) -> NDArray[np.float64]:
        """Distance of places (n, 2) to the edge: positive inside, negative outside.

        NaN for a sector when own ship's position, or the heading that it needs, is unknown.
        """
        place_m = np.asarray(place_m, dtype=float).reshape(-1, 2)
        if self.outline_m is not None:
            return _polygon_depth_m(self.outline_m, place_m)
        if own is None or (self.from_bow and not np.isfinite(own.heading_rad)):
            return np.full(len(place_m), np.nan)
        ahead_rad = own.heading_rad if self.from_bow else 0.0
        return self._sector_depth_m(place_m - [own.north_m, own.east_m], ahead_rad)

    def _sector_depth_m(
        self, offset_m: NDArray[np.float64], ahead_rad: float
    ) -> NDArray[np.float64]:
        range_m = np.hypot(*offset_m.T)
        width_rad = (self.to_rad - self.from_rad) % _TURN_RAD or _TURN_RAD
        begin_rad = self.from_rad + ahead_rad
        along_rad = (np.arctan2(offset_m[:, 1], offset_m[:, 0]) - begin_rad) % _TURN_RAD
        within = along_rad <= width_rad
        inside = within & (range_m >= self.near_m) & (range_m <= self.far_m)
        edge_m = np.abs(range_m - self.far_m)
        if self.near_m > 0.0:
            edge_m = np.minimum(edge_m, np.abs(range_m - self.near_m))
        edge_m[~within] = np.inf
        if width_rad < _TURN_RAD:
            for side_rad in (begin_rad, begin_rad + width_rad):
                side = np.array([np.cos(side_rad), np.sin(side_rad)])
                to_side_m = _segment_distance_m(self.near_m * side, self.far_m * side, offset_m)
                edge_m = np.minimum(edge_m, to_side_m)
        return np.where(inside, edge_m, -edge_m)


def placed(values: Any, to_plane: Callable[[float, float], tuple[float, float]]) -> Any:
    """A zone as a JSON object with `outline_m`, made of its `outline_deg` (latitude, longitude).

    Raises
    ------
    ValueError
        When a corner is no place.
    """
    if not isinstance(values, Mapping) or "outline_deg" not in values:
        return values
    corners = np.asarray(values["outline_deg"], dtype=float)
    if corners.ndim != 2 or corners.shape[1] != 2 or not (np.abs(corners) <= [90.0, 360.0]).all():
        raise ValueError("outline_deg must be corners [latitude, longitude] in degrees")
    rest = {name: value for name, value in values.items() if name != "outline_deg"}
    return rest | {"outline_m": [list(to_plane(*corner)) for corner in corners.tolist()]}


_SECTOR = ("near_m", "far_m", "from_rad", "to_rad", "from_bow")


class OwnPlace(NamedTuple):
    """Own ship, as far as zones need it; `heading_rad` is NaN where unknown."""

    north_m: float
    east_m: float
    heading_rad: float = np.nan


class Crossing(NamedTuple):
    """A track that has come into a zone or left it.

    Attributes
    ----------
    zone : Zone
    track_id : int
    entered : bool
        Else it has left, or has ended inside.
    born_inside : bool
        Whether it was inside when it, or the zone, was first there.
    lost : bool
        Whether the track has ended.
    since_s : float
        When it came in.
    """

    zone: Zone
    track_id: int
    entered: bool
    born_inside: bool
    lost: bool
    since_s: float


@dataclass
class _Stay:
    since_s: float
    born_inside: bool


@dataclass
class _Watched:
    zone: Zone
    inside: dict[int, _Stay] = field(default_factory=dict)
    seen: set[int] = field(default_factory=set)


class Zones:
    """The zones of a session and the tracks inside each.

    Whether a track is inside is decided for each zone and track alone, so that no track can hide
    another: it comes in when its position is inside, and has left when it is outside by the
    hysteresis of the zone and by two standard deviations of its position.
    """

    def __init__(self, zones: Sequence[Zone] = ()) -> None:
        self._watched: dict[int, _Watched] = {}
        self._next_id = 1
        for zone in zones:
            self.set(zone)

    def __len__(self) -> int:
        return len(self._watched)

    def __iter__(self):
        return iter([one.zone for one in self._watched.values()])

    def __getitem__(self, zone_id: int) -> Zone:
        return self._watched[zone_id].zone

    def list(self) -> list[dict[str, Any]]:
        """All zones for JSON, with the tracks inside."""
        return [
            one.zone.as_dict() | {"inside": sorted(one.inside)} for one in self._watched.values()
        ]

    def set(self, zone: Zone | Mapping[str, Any]) -> Zone:
        """Add a zone (`zone_id` 0), or change one and keep who is inside.

        Raises
        ------
        ValueError
            When there are 64 already, no zone has that number, or a value is out of range.
        """
        zone = zone if isinstance(zone, Zone) else Zone.of(zone)
        if zone.zone_id == 0:
            if len(self) >= MOST_ZONES:
                raise ValueError(f"there are {MOST_ZONES} zones already; delete one first")
            zone = replace(zone, zone_id=self._next_id)
            self._next_id += 1
            self._watched[zone.zone_id] = _Watched(zone)
        elif zone.zone_id in self._watched:
            self._watched[zone.zone_id].zone = zone
        else:
            raise ValueError(f"no zone has the number {cut(str(zone.zone_id))}")
        return zone

    def delete(self, zone_id: int) -> Zone | None:
        """Remove a zone; None if none has that number."""
        removed = self._watched.pop(zone_id, None)
        return None if removed is None else removed.zone

    def adopt(self, other: Zones) -> None:
        """Take the zones of another collection, and keep who is inside those that both have."""
        kept = self._watched
        self._watched = {}
        for zone in other:
            before = kept.get(zone.zone_id)
            self._watched[zone.zone_id] = (
                _Watched(zone) if before is None else _Watched(zone, before.inside, before.seen)
            )
        self._next_id = max(self._next_id, other._next_id)

    def save(self) -> dict[str, Any]:
        """Zones and the next number, for JSON and `restore`."""
        return {"next_id": self._next_id, "zones": [zone.as_dict() for zone in self]}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Replace all zones by those that were saved."""
        zones = [Zone.of(one) for one in state["zones"]]
        self._watched = {zone.zone_id: _Watched(zone) for zone in zones}
        self._next_id = int(state["next_id"])

    def kept(
        self,
        place_m: NDArray[np.float64],
        is_tracked: Callable[[NDArray[np.intp]], NDArray[np.bool_]],
    ) -> NDArray[np.bool_]:
        """Which plots at places (n, 2) are used: (n,).

        Not those on land, and of those in exclusion zones what is of a track: `is_tracked` says so
        of some, by their indices.
        """
        kept = ~self._are_in("land", place_m)
        excluded = np.flatnonzero(kept & self._are_in("exclusion", place_m))
        if len(excluded):
            kept[excluded] = is_tracked(excluded)
        return kept

    def _are_in(self, kind: str, place_m: NDArray[np.float64]) -> NDArray[np.bool_]:
        inside = np.zeros(len(place_m), dtype=bool)
        for zone in self:
            if zone.kind == kind:
                inside |= zone.depth_m(place_m) >= 0.0
        return inside

    def update(
        self,
        time_s: float,
        track_id: ArrayLike,
        place_m: ArrayLike,
        std_m: ArrayLike,
        own: OwnPlace | None = None,
        hidden: Collection[int] = (),
    ) -> list[Crossing]:
        """Take all confirmed tracks at a time.

        Parameters
        ----------
        time_s : float
        track_id : (n,) array of int
        place_m : (n, 2) array
            North and east.
        std_m : (n,) array
            Standard deviation of the position in its worst direction.
        own : OwnPlace, optional
            Without it sectors keep the state that they had.
        hidden : collection of int
            Tracks that are not among these and not lost: they are where they were.

        Returns
        -------
        list of Crossing
        """
        track_id = np.asarray(track_id, dtype=np.int64)
        place_m = np.asarray(place_m, dtype=float).reshape(-1, 2)
        std_m = np.asarray(std_m, dtype=float)
        crossings: list[Crossing] = []
        for one in self._watched.values():
            if one.zone.kind == "guard":
                depth_m = one.zone.depth_m(place_m, own)
                crossings += _cross(one, time_s, track_id, depth_m, std_m, hidden)
        return crossings

    def occupants(self, time_s: float) -> list[tuple[Zone, int, float]]:
        """Zone, track and length of stay of every track inside a zone."""
        return [
            (one.zone, track_id, time_s - stay.since_s)
            for one in self._watched.values()
            for track_id, stay in one.inside.items()
        ]


def _cross(
    one: _Watched,
    time_s: float,
    track_id: NDArray[np.int64],
    depth_m: NDArray[np.float64],
    std_m: NDArray[np.float64],
    hidden: Collection[int],
) -> list[Crossing]:
    crossings = []
    leaves_m = -np.maximum(one.zone.hysteresis_m, _LEAVING_STDS * std_m)
    for number, depth, leaves in zip(
        track_id.tolist(), depth_m.tolist(), leaves_m.tolist(), strict=True
    ):
        stay = one.inside.get(number)
        if stay is None and depth >= 0.0:
            stay = one.inside[number] = _Stay(time_s, number not in one.seen)
            crossings.append(Crossing(one.zone, number, True, stay.born_inside, False, time_s))
        elif stay is not None and depth < leaves:
            del one.inside[number]
            crossings.append(
                Crossing(one.zone, number, False, stay.born_inside, False, stay.since_s)
            )
        if not math.isnan(depth):  # a sector has no depth while own ship is unknown
            one.seen.add(number)
    there = {*track_id.tolist(), *hidden}
    one.seen &= there
    for number in [number for number in one.inside if number not in there]:
        stay = one.inside.pop(number)
        crossings.append(Crossing(one.zone, number, False, stay.born_inside, True, stay.since_s))
    return crossings


def _corners(outline_m: Any) -> NDArray[np.float64]:
    try:
        corners = np.array(outline_m, dtype=float)
    except (TypeError, ValueError):
        raise TypeError(f"outline_m must be [north, east] pairs, got {quoted(outline_m)}") from None
    if corners.ndim != 2 or corners.shape[1] != 2 or not 3 <= len(corners) <= MOST_CORNERS:
        raise ValueError(
            f"outline_m must be 3 to {MOST_CORNERS} corners [north, east], "
            f"got shape {corners.shape}"
        )
    if not (np.abs(corners) <= _FAR_M).all():
        raise ValueError(f"outline_m must be finite and within {_FAR_M:g} m")
    return corners


def _polygon_depth_m(
    outline_m: NDArray[np.float64], place_m: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Inside by the crossings of a place's parallel, as `wakeline.DangerZone.contains`."""
    distance_m = np.full(len(place_m), np.inf)
    inside = np.zeros(len(place_m), dtype=bool)
    for a, b in zip(outline_m, np.roll(outline_m, 1, axis=0), strict=True):
        distance_m = np.minimum(distance_m, _segment_distance_m(a, b, place_m))
        if a[0] != b[0]:
            crosses = (a[0] > place_m[:, 0]) != (b[0] > place_m[:, 0])
            east_m = a[1] + (place_m[:, 0] - a[0]) / (b[0] - a[0]) * (b[1] - a[1])
            inside ^= crosses & (place_m[:, 1] < east_m)
    return np.where(inside, distance_m, -distance_m)


def _segment_distance_m(
    a: NDArray[np.float64], b: NDArray[np.float64], place_m: NDArray[np.float64]
) -> NDArray[np.float64]:
    along = b - a
    length2 = float(along @ along)
    share = np.clip((place_m - a) @ along / length2, 0.0, 1.0) if length2 > 0.0 else 0.0
    return np.hypot(*(place_m - a - np.multiply.outer(share, along)).T)


def are_of_tracks(
    radar: Radar,
    range_m: NDArray[np.float64],
    place_m: NDArray[np.float64],
    mean: NDArray[np.float64],
    covariance: NDArray[np.float64],
    ahead_s: NDArray[np.float64] | float = 0.0,
) -> NDArray[np.bool_]:
    """Whether plots of a radar, at ranges (n,) and places (n, 2), may be of some tracks: (n,).

    These have states (k, 4) of [north, vnorth, east, veast], `ahead_s` before the plots.
    """
    std_m = np.hypot(radar.range_std_m, radar.bearing_std_rad * range_m)
    ahead_s = np.broadcast_to(ahead_s, len(mean))[:, np.newaxis]
    now_m = mean[:, ::2] + ahead_s * mean[:, 1::2]
    variance = np.diagonal(covariance, axis1=1, axis2=2)
    now_m2 = (variance[:, ::2] + ahead_s**2 * variance[:, 1::2]).sum(axis=1)
    off_m = np.linalg.norm(place_m[:, np.newaxis] - now_m, axis=2)
    return (off_m <= _OF_TRACK * np.sqrt(std_m[:, np.newaxis] ** 2 + now_m2)).any(axis=1)
