"""AIS: parts of messages to messages, and messages to vessels."""

from __future__ import annotations

import math
import re
from collections import deque
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from wakeline._units import KNOT_MPS, NAUTICAL_MILE_M

from .problems import Problems

HOW_TO_GET = "AIS needs pyais: pip install 'wakeline[live]'"
_PART_S = 10.0  # the parts of a message follow each other within this time
_MOST_OPEN = 256  # messages with missing parts
_MOST_VESSELS = 20_000
FORGET_S = 900.0
_GROUP = re.compile(rb"\\(?:[^\\*]*,)?g:(\d+)-(\d+)-(\d+)")
_POSITION_TYPES = (1, 2, 3, 4, 18, 19, 27)
_CLASS_B = (18, 19, 24)
_BASE_STATION = 4
_OFTEN = 2  # so many stated times in a row must fit how far a vessel has moved
_NEW = 6  # messages after which times that do not fit are wrong, not unknown
_SLOW_MPS = 2.0  # too slow to tell times by how far a vessel has moved


class _Open(NamedTuple):
    """A message with missing parts."""

    begin_s: float
    parts: dict[int, bytes]


class AisAssembly:
    """Whole messages of one source from sentences that may interleave.

    Parts belong together by count, sequence number and channel, or by the group of their TAG
    blocks; they must follow each other within 10 s.
    """

    def __init__(self) -> None:
        self._open: dict[tuple, _Open] = {}

    def feed(
        self, time_s: float, line: bytes, piece: bytes, problems: Problems
    ) -> tuple[bytes, ...] | None:
        """The sentences of a message, when the last of them is there."""
        fields = piece.split(b",")
        if len(fields) < 7:
            problems.add("AIS fields", f"wanted 7 fields, got {len(fields)}")
            return None
        try:
            count, number = int(fields[1]), int(fields[2])
        except ValueError:
            problems.add("AIS part", "wanted the number of parts and of this one")
            return None
        if count == 1:
            return (piece,)
        if not 1 <= number <= count <= 9:
            problems.add("AIS part", f"wanted part 1 to {count} of 9, got {number}")
            return None
        group = _GROUP.match(line)
        key = (fields[0], count, fields[3], fields[4], group[3] if group else b"")
        open_one = self._open.get(key)
        expired = open_one is not None and not 0.0 <= time_s - open_one.begin_s <= _PART_S
        if open_one is None or expired or number in open_one.parts:
            if open_one is not None:
                problems.add("AIS part missing", f"message of {count} parts is not complete")
            open_one = self._open[key] = _Open(time_s, {})
        open_one.parts[number] = piece
        if len(open_one.parts) == count:
            del self._open[key]
            return tuple(open_one.parts[k] for k in range(1, count + 1))
        while len(self._open) > _MOST_OPEN:
            problems.add("AIS part missing", "too many messages are not complete")
            del self._open[next(iter(self._open))]
        return None


class AisClock:
    """When positions of AIS were measured, by the second of the minute that they state.

    They come up to seconds later, where they have waited up to a minute, and the receiver's own
    clock may be wrong by seconds. How long before its reception a position was, as that clock has
    it, is known but for what is common to all. That is found as the least after which they come:
    the one that is likeliest where the number of those that take longer falls by e in 20 s.
    """

    _MINUTE_S = 60.0
    _STEP_S = 0.25
    _FALLS_S = 20.0
    _MEMORY = 200  # messages
    _FEWEST = 10
    _APART_S = 0.05  # of those that come together all but the first may have waited
    _CLEAR = 0.42  # mean weight of a message; of seconds at random 0.32

    def __init__(self) -> None:
        steps = round(self._MINUTE_S / self._STEP_S)
        after = (np.arange(steps) - np.arange(steps)[:, None]) % steps * self._STEP_S
        self._weight = np.exp(-after / self._FALLS_S)
        self._count = np.zeros(steps)
        self._recent: deque[int] = deque()
        self._last_s = -math.inf
        self._least_s = math.nan

    def __call__(self, received_s: float, second: int | None) -> float:
        """The time of a position on the receiver's clock; NaN where it is not known."""
        if second is None or not 0 <= second < 60:
            return math.nan
        since_s = (received_s - second) % self._MINUTE_S
        if received_s - self._last_s >= self._APART_S:
            self._last_s = received_s
            self._learn(min(int(since_s / self._STEP_S), len(self._count) - 1))
        age_s = (since_s - self._least_s) % self._MINUTE_S
        return received_s - (0.0 if age_s > self._MINUTE_S - 1.0 else age_s)

    def _learn(self, step: int) -> None:
        self._recent.append(step)
        self._count[step] += 1
        if len(self._recent) > self._MEMORY:
            self._count[self._recent.popleft()] -= 1
        weight = self._weight @ self._count
        best = int(np.argmax(weight))
        is_known = len(self._recent) >= self._FEWEST
        is_clear = weight[best] > self._CLEAR * len(self._recent)
        self._least_s = best * self._STEP_S if is_known and is_clear else math.nan


@dataclass
class AisVessel:
    """What AIS says of a vessel; NaN and empty where unknown.

    Attributes
    ----------
    mmsi : int
    time_s : float
        Of its last position.
    received_s : float
        When that was received.
    stated_s : float
        Its time by the second that the vessel states.
    stated_well : int
        Positions in a row whose stated times fit how far the vessel has moved.
    late_m : float
        How far it may have moved before its position was received, while that is not known.
    latitude_deg, longitude_deg, course_rad, speed_mps, heading_rad : float
    accurate : bool
        Whether it reports an error of the position below 10 m.
    name, callsign : str
    ship_type : int
    to_bow_m, to_stern_m, to_port_m, to_starboard_m : float
        From the reference of its position.
    is_class_b : bool
    is_fixed : bool
        Whether it is a base station or an aid to navigation.
    messages : int
    """

    mmsi: int
    time_s: float = -math.inf
    received_s: float = -math.inf
    stated_s: float = math.nan
    stated_well: int = 0
    late_m: float = 0.0
    latitude_deg: float = math.nan
    longitude_deg: float = math.nan
    course_rad: float = math.nan
    speed_mps: float = math.nan
    heading_rad: float = math.nan
    accurate: bool = False
    name: str = ""
    callsign: str = ""
    ship_type: int = 0
    to_bow_m: float = math.nan
    to_stern_m: float = math.nan
    to_port_m: float = math.nan
    to_starboard_m: float = math.nan
    is_class_b: bool = False
    is_fixed: bool = False
    messages: int = 0

    @property
    def identity(self) -> str:
        """Its MMSI, nine digits."""
        return f"{self.mmsi:09d}"

    @property
    def position_std_m(self) -> float:
        """Standard deviation of its position, per axis."""
        return math.hypot(5.0 if self.accurate else 10.0, self.late_m)

    @property
    def to_middle_m(self) -> tuple[float, float]:
        """[north, east] from its position to the middle of the hull; 0 while unknown."""
        forward_m = 0.5 * (self.to_bow_m - self.to_stern_m)
        starboard_m = 0.5 * (self.to_starboard_m - self.to_port_m)
        if not math.isfinite(forward_m + starboard_m + self.heading_rad):
            return 0.0, 0.0
        cos, sin = math.cos(self.heading_rad), math.sin(self.heading_rad)
        return forward_m * cos - starboard_m * sin, forward_m * sin + starboard_m * cos

    def as_dict(self) -> dict[str, Any]:
        """Its values by name, and its identity."""
        return asdict(self) | {"identity": self.identity}


def decoded(sentences: tuple[bytes, ...]) -> Any:
    """The message of its sentences, by pyais.

    Raises
    ------
    ValueError
        When it cannot be decoded.
    ModuleNotFoundError
        When pyais is not installed.
    """
    try:
        import pyais
    except ModuleNotFoundError:
        raise ModuleNotFoundError(HOW_TO_GET) from None
    try:
        message = pyais.decode(*sentences)
    except Exception as error:  # noqa: BLE001 - of any class, by octets of anyone
        raise ValueError(f"{type(error).__name__} {error}") from None
    needed = ("mmsi", "lat", "lon") if int(message.msg_type) in _POSITION_TYPES else ("mmsi",)
    for name in needed:
        if getattr(message, name) is None:
            raise ValueError(f"the message is cut before {name}")
    return message


class AisPicture:
    """The vessels of all AIS messages.

    Attributes
    ----------
    vessels : dict of int to AisVessel
    """

    def __init__(self) -> None:
        self.vessels: dict[int, AisVessel] = {}
        self._clock = AisClock()

    def add(self, time_s: float, message: Any) -> tuple[AisVessel, bool] | None:
        """Add a message; its vessel and whether its position is new, None for other messages."""
        kind = int(message.msg_type)
        if kind not in (*_POSITION_TYPES, 5, 24):
            return None
        vessel = self._vessel(time_s, int(message.mmsi))
        vessel.is_class_b = vessel.is_class_b or kind in _CLASS_B
        if kind in (5, 19, 24):
            _take_static(vessel, message)
        if kind not in _POSITION_TYPES:
            return vessel, False
        vessel.is_fixed = kind == _BASE_STATION
        stated_s = self._clock(time_s, getattr(message, "second", None))
        return vessel, _take_position(vessel, time_s, stated_s, message)

    def update(self, time_s: float, mmsi: int, values: dict[str, Any]) -> tuple[AisVessel, bool]:
        """Take values by the names of `AisVessel`; the vessel and whether its position is new."""
        vessel = self._vessel(time_s, mmsi)
        for name, value in values.items():
            setattr(vessel, name, value)
        is_new = "latitude_deg" in values
        if is_new:
            vessel.time_s = vessel.received_s = time_s
        return vessel, is_new

    def _vessel(self, time_s: float, mmsi: int) -> AisVessel:
        vessel = self.vessels.get(mmsi)
        if vessel is None:
            self._make_room(time_s)
            vessel = self.vessels[mmsi] = AisVessel(mmsi)
        vessel.messages += 1
        return vessel

    def _make_room(self, time_s: float) -> None:
        if len(self.vessels) < _MOST_VESSELS:
            return
        self.forget(time_s)
        if len(self.vessels) >= _MOST_VESSELS:
            oldest = min(self.vessels.values(), key=lambda vessel: vessel.time_s)
            del self.vessels[oldest.mmsi]

    def forget(self, time_s: float) -> None:
        """Drop vessels without a position for 15 minutes."""
        old = [m for m, vessel in self.vessels.items() if time_s - vessel.time_s > FORGET_S]
        for mmsi in old:
            del self.vessels[mmsi]


def _take_position(vessel: AisVessel, received_s: float, stated_s: float, message: Any) -> bool:
    latitude, longitude = float(message.lat), float(message.lon)
    if not (abs(latitude) <= 90.0 and abs(longitude) <= 180.0) or latitude == longitude == 0.0:
        return False  # 0/0 is that of a receiver without a fix
    speed_kn = getattr(message, "speed", None)
    course_deg = getattr(message, "course", None)
    heading_deg = getattr(message, "heading", None)
    has_speed = speed_kn is not None and 0.0 <= speed_kn < 102.25
    speed_mps = float(speed_kn) * KNOT_MPS if has_speed else math.nan
    good = course_deg is not None and 0.0 <= course_deg < 360.0
    course_rad = math.radians(course_deg) if good else math.nan

    moved_s = _moved_s(vessel, latitude, longitude, speed_mps, course_rad)
    later_s = stated_s - vessel.stated_s
    fits = abs(moved_s - later_s) <= abs(moved_s - (received_s - vessel.received_s)) + 1.0
    if fits and later_s < 0.5:
        return False  # known, or from before: by another way
    vessel.stated_well = vessel.stated_well + 1 if fits else 0
    is_known = vessel.stated_well >= _OFTEN
    vessel.time_s = stated_s if is_known else received_s
    is_doubtful = not is_known and vessel.messages < _NEW and math.isfinite(stated_s)
    vessel.late_m = speed_mps * (received_s - stated_s) if is_doubtful and has_speed else 0.0
    vessel.received_s, vessel.stated_s = received_s, stated_s
    vessel.latitude_deg, vessel.longitude_deg = latitude, longitude
    vessel.speed_mps, vessel.course_rad = speed_mps, course_rad
    good = heading_deg is not None and 0 <= heading_deg < 360
    vessel.heading_rad = math.radians(heading_deg) if good else math.nan
    vessel.accurate = bool(getattr(message, "accuracy", False))
    return True


def _moved_s(
    vessel: AisVessel,
    latitude_deg: float,
    longitude_deg: float,
    speed_mps: float,
    course_rad: float,
) -> float:
    """How long a vessel has run from its last position; NaN where it is too slow to tell."""
    if not speed_mps > _SLOW_MPS:
        return math.nan
    north_deg = latitude_deg - vessel.latitude_deg
    east_deg = (longitude_deg - vessel.longitude_deg) * math.cos(math.radians(latitude_deg))
    along_deg = north_deg * math.cos(course_rad) + east_deg * math.sin(course_rad)
    return along_deg * 60.0 * NAUTICAL_MILE_M / speed_mps


def _take_static(vessel: AisVessel, message: Any) -> None:
    names = {"shipname": "name", "callsign": "callsign"}
    for theirs, ours in names.items():
        text = getattr(message, theirs, None)
        if text:
            setattr(vessel, ours, str(text).strip("@ ").rstrip())
    kind = getattr(message, "ship_type", None)
    if kind is not None:
        vessel.ship_type = int(kind)
    ends = [getattr(message, f"to_{end}", None) for end in ("bow", "stern", "port", "starboard")]
    if all(end is not None for end in ends) and any(ends):
        vessel.to_bow_m, vessel.to_stern_m, vessel.to_port_m, vessel.to_starboard_m = map(
            float, ends
        )
