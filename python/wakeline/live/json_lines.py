"""JSON lines, version 1: one object a line, SI units and radians, times in UTC seconds.

In::

    {"radar": "A", "time_s": 1.0, "range_m": 820.0, "bearing_rad": 0.3}
    {"radar": "A", "sector": {"from_rad": 0.0, "to_rad": 0.2, "time_s": 1.1}}
    {"own": {"time_s": 1.0, "latitude_deg": 54.2, "longitude_deg": 10.1, "heading_rad": 0.1,
             "course_rad": 0.1, "speed_mps": 5.0}}
    {"report": {"source": "ais", "identity": "257378500", "time_s": 1.0, "latitude_deg": 54.2,
                "longitude_deg": 10.2, "course_rad": 1.0, "speed_mps": 4.0}}

`bearing_rad` is clockwise from the origin that the radar is configured with; `range_std_m` and
`bearing_std_rad` of a plot are optional. A position may be `north_m` and `east_m` instead, from the
origin of the session. `radar` may be left out where the input has one. A line with
``"version"`` other than 1 is rejected.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from functools import lru_cache
from itertools import chain
from typing import Any

VERSION = 1

_NUMBERS = {
    "plot": {"time_s", "range_m", "bearing_rad", "range_std_m", "bearing_std_rad"},
    "sector": {"from_rad", "to_rad", "time_s"},
    "own": {
        "time_s",
        "latitude_deg",
        "longitude_deg",
        "north_m",
        "east_m",
        "heading_rad",
        "course_rad",
        "speed_mps",
    },
    "report": {
        "time_s",
        "latitude_deg",
        "longitude_deg",
        "north_m",
        "east_m",
        "position_std_m",
        "course_rad",
        "speed_mps",
        "velocity_std_mps",
    },
}
_NEEDED = {
    "plot": ("time_s", "range_m", "bearing_rad"),
    "sector": ("from_rad", "to_rad", "time_s"),
    "own": (),
    "report": ("source", "identity", "time_s"),
}
_PLAIN = frozenset((str, int, bool, type(None)))
_decode = json.JSONDecoder().decode
_ENCODER = json.JSONEncoder(separators=(",", ":"), allow_nan=False)
_TEXTS = ("source", "identity", "name")


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
        given = _decode(str(line, "utf-8"))
    except (ValueError, RecursionError) as error:
        raise BadLine(f"wanted one JSON object, {_first_words(error)}") from None
    if not isinstance(given, dict):
        raise BadLine(f"wanted one JSON object, got {type(given).__name__}")
    if given.get("version", VERSION) != VERSION:
        raise BadLine(f"wanted version {VERSION}, got {str(given['version'])[:20]}")
    kind = next((each for each in ("sector", "own", "report") if each in given), "plot")
    values = given if kind == "plot" else given[kind]
    if not isinstance(values, dict):
        raise BadLine(f"wanted an object in {kind}, got {type(values).__name__}")
    radar = given.get("radar", "")
    if not isinstance(radar, str):
        raise BadLine(f"wanted a text in radar, got {type(radar).__name__}")
    return kind, radar, _checked(kind, values)


def _checked(kind: str, values: Mapping[str, Any]) -> dict[str, Any]:
    checked: dict[str, Any] = {}
    numbers = _NUMBERS[kind]
    for name, value in values.items():
        if name not in numbers:
            continue
        if type(value) not in (float, int):
            raise BadLine(f"wanted a number in {name}, got {type(value).__name__}")
        if not abs(value) < 1e12:
            raise BadLine(f"wanted a finite number in {name}, got {str(value)[:20]}")
        checked[name] = float(value)
    for name in _TEXTS:
        if kind == "report" and name in values:
            checked[name] = str(values[name])[:64]
    missing = [name for name in _NEEDED[kind] if name not in checked]
    if missing:
        raise BadLine(f"wanted {missing[0]} in {kind}")
    if checked.get("range_m", 0.0) < 0.0:
        raise BadLine(f"wanted range_m of 0 or more, got {checked['range_m']}")
    if not abs(checked.get("latitude_deg", 0.0)) <= 90.0:
        raise BadLine(f"wanted latitude_deg from -90 to 90, got {checked['latitude_deg']}")
    for one, other in (("latitude_deg", "longitude_deg"), ("north_m", "east_m")):
        if (one in checked) != (other in checked):
            raise BadLine(f"wanted both of {one} and {other}")
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


_ROW = "[%.8g,%.8g,%.8g,%.8g]"
_TRACK = (
    '{"version":1,"type":"track","track_id":%d,"status":"%s","name":%s,"time_s":%.6f,'
    '"north_m":%.3f,"east_m":%.3f,"vnorth_mps":%.5f,"veast_mps":%.5f,'
    f'"covariance":[{_ROW},{_ROW},{_ROW},{_ROW}],'
    '"course_rad":%.6f,"speed_mps":%.5f,"mode":"%s","mode_probability":[%s],"existence":%.6g,'
    '"hits":%d,"misses":%d,"identity":%s,"identity_probability":%.5g,"identity_time_s":%s'
    '%s%s%s,"radar":%s}\n'
)
_PLACE = ',"latitude_deg":%.9f,"longitude_deg":%.9f'
_SEEN = ',"range_m":%.3f,"bearing_rad":%.7f'
_CPA = ',"cpa":{"cpa_m":%.2f,"tcpa_s":%.2f,"probability":%.5f}'


@lru_cache(maxsize=4096)
def _quoted(text: str) -> str:
    return _ENCODER.encode(text)


def track_line(track: Mapping[str, Any], radar: str) -> bytes:
    """The line of a track as :meth:`Session.describe` has it; written once for many a second."""
    cpa = track.get("cpa")
    text = _TRACK % (
        track["track_id"],
        track["status"],
        _quoted(track["name"]),
        track["time_s"],
        track["north_m"],
        track["east_m"],
        track["vnorth_mps"],
        track["veast_mps"],
        *chain.from_iterable(track["covariance"]),
        track["course_rad"],
        track["speed_mps"],
        track["mode"],
        ",".join([f"{value:.6g}" for value in track["mode_probability"]]),
        track["existence"],
        track["hits"],
        track["misses"],
        _quoted(track["identity"]),
        track["identity_probability"],
        "null" if track["identity_time_s"] is None else f"{track['identity_time_s']:.3f}",
        _PLACE % (track["latitude_deg"], track["longitude_deg"]) if "latitude_deg" in track else "",
        _SEEN % (track["range_m"], track["bearing_rad"]) if "range_m" in track else "",
        _CPA % (cpa["cpa_m"], cpa["tcpa_s"], cpa["probability"]) if cpa else "",
        _quoted(radar),
    )
    if "nan" in text or "inf" in text:
        return write_line("track", {**track, "radar": radar})
    return text.encode()


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
