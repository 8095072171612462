"""JSON lines, version 1: one object a line, SI units and radians, times in UTC seconds.

In::

    {"radar": "A", "time_s": 1.0, "range_m": 820.0, "bearing_rad": 0.3}
    {"radar": "A", "sector": {"from_rad": 0.0, "to_rad": 0.2, "time_s": 1.1}}
    {"own": {"time_s": 1.0, "latitude_deg": 54.2, "longitude_deg": 10.1, "heading_rad": 0.1,
             "course_rad": 0.1, "speed_mps": 5.0}}
    {"report": {"source": "ais", "identity": "257378500", "time_s": 1.0, "latitude_deg": 54.2,
                "longitude_deg": 10.2, "course_rad": 1.0, "speed_mps": 4.0}}

`bearing_rad` is clockwise from the origin that the radar is configured with; `range_std_m` and
`bearing_std_rad` of a plot are both given or both left out. A position may be `north_m` and
`east_m` instead, from the origin of the session. `radar` may be left out where the input has one. A
line with ``"version"`` other than 1 is rejected.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from itertools import chain
from typing import Any, NamedTuple

VERSION = 1
_LIMIT = 1e12  # of any number


class _Rules(NamedTuple):
    """What a line of a kind may have."""

    numbers: frozenset[str]
    needed: frozenset[str]
    texts: frozenset[str] = frozenset()
    pairs: tuple[tuple[str, str], ...] = ()


_PLACE = ("latitude_deg", "longitude_deg"), ("north_m", "east_m")
_PLACE_NUMBERS = frozenset(chain(*_PLACE))
_SECTOR = frozenset(("from_rad", "to_rad", "time_s"))
_RULES = {
    "sector": _Rules(_SECTOR, _SECTOR),
    "own": _Rules(
        _PLACE_NUMBERS | {"time_s", "heading_rad", "course_rad", "speed_mps"},
        frozenset(),
        pairs=_PLACE,
    ),
    "report": _Rules(
        _PLACE_NUMBERS
        | {"time_s", "position_std_m", "course_rad", "speed_mps", "velocity_std_mps"},
        frozenset(("source", "identity", "time_s")),
        frozenset(("source", "identity", "name")),
        _PLACE,
    ),
    "plot": _Rules(
        frozenset(("time_s", "range_m", "bearing_rad", "range_std_m", "bearing_std_rad")),
        frozenset(("time_s", "range_m", "bearing_rad")),
        pairs=(("range_std_m", "bearing_std_rad"),),
    ),
}
_NESTED = ("sector", "own", "report")
_PLAIN = frozenset((str, int, bool, type(None)))
_raw_decode = json.JSONDecoder().raw_decode
_ENCODER = json.JSONEncoder(separators=(",", ":"), allow_nan=False)


class BadLine(ValueError):
    """A message cannot be used; the text says what was expected and what came."""


def read_line(line: bytes) -> tuple[str, str, dict[str, Any]]:
    """The kind, the radar and the values of a line.

    The kind is "plot", "sector", "own" or "report"; numbers are finite.

    Raises
    ------
    BadLine
    """
    try:
        given = _decode(line)
    except (ValueError, RecursionError) as error:
        raise BadLine(f"wanted one JSON object, {_first_words(error)}") from None
    if not isinstance(given, dict):
        raise BadLine(f"wanted one JSON object, got {type(given).__name__}")
    if given.get("version", VERSION) != VERSION:
        raise BadLine(f"wanted version {VERSION}, got {str(given['version'])[:20]}")
    kind, values = "plot", given
    for each in _NESTED:
        if each in given:
            kind, values = each, given[each]
            break
    if not isinstance(values, dict):
        raise BadLine(f"wanted an object in {kind}, got {type(values).__name__}")
    radar = given.get("radar", "")
    if not isinstance(radar, str):
        raise BadLine(f"wanted a text in radar, got {type(radar).__name__}")
    return kind, radar, _checked(kind, values)


def _decode(line: bytes) -> Any:
    """What `json.loads` gives, in two thirds of its time."""
    text = str(line, "utf-8").strip()
    value, end = _raw_decode(text)
    if end != len(text):
        raise ValueError("Extra data")
    return value


def _checked(kind: str, values: Mapping[str, Any]) -> dict[str, Any]:
    numbers, needed, texts, pairs = _RULES[kind]
    checked: dict[str, Any] = {}
    for name, value in values.items():
        if name in numbers:
            if type(value) not in (float, int):
                raise BadLine(f"wanted a number in {name}, got {type(value).__name__}")
            if not abs(value) < _LIMIT:
                wanted = f"a number from {-_LIMIT:g} to {_LIMIT:g} in {name}"
                raise BadLine(f"wanted {wanted}, got {str(value)[:20]}")
            if "_std_" in name and value <= 0.0:
                raise BadLine(f"wanted {name} above 0, got {value}")
            checked[name] = float(value)
        elif name in texts:
            checked[name] = str(value)[:64]
    if not needed <= checked.keys():
        raise BadLine(f"wanted {min(needed - checked.keys())} in {kind}")
    if checked.get("range_m", 0.0) < 0.0:
        raise BadLine(f"wanted range_m of 0 or more, got {checked['range_m']}")
    for one, other in pairs:
        if (one in checked) != (other in checked):
            raise BadLine(f"wanted both of {one} and {other}")
    if not abs(checked.get("latitude_deg", 0.0)) <= 90.0:
        raise BadLine(f"wanted latitude_deg from -90 to 90, got {checked['latitude_deg']}")
    return checked


def _first_words(error: Exception) -> str:
    return str(error).split(":")[0][:60]


def write_line(kind: str, values: Mapping[str, Any]) -> bytes:
    """One line of output; NaN and infinity become null."""
    line = {"version": VERSION, "type": kind} | dict(values)
    try:
        text = _ENCODER.encode(line)
    except ValueError:
        text = _ENCODER.encode(finite_only(line))
    return text.encode() + b"\n"


def track_values(line: bytes) -> dict[str, Any]:
    """What a line of a track says, without its version and type."""
    values = _decode(line)
    del values["version"], values["type"]
    return values


def without_danger(line: bytes) -> bytes:
    """The line of a track whose motion is not known yet."""
    values = track_values(line) | {"status": "tentative"}
    values.pop("cpa", None)
    return write_line("track", values)


def finite_only(value: Any) -> Any:
    """A value for JSON, with null for numbers that are not finite."""
    if type(value) in _PLAIN:
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {key: finite_only(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite_only(each) for each in value]
    return value
