"""The picture of a session as messages for pages: only what is new to each."""

from __future__ import annotations

import json
import math
from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

TRACK_COLUMNS = (
    *("id", "time", "north", "east", "vnorth", "veast", "major", "minor", "axis", "seen"),
    *("status", "mode", "existence", "cpa", "cpa_time", "probability"),
    *("name", "identity", "identity_probability"),
)
AIS_COLUMNS = ("id", "time", "north", "east", "vnorth", "veast", "heading", "name", "track")
_MOTION = {"port_turn": "turning to port", "starboard_turn": "turning to starboard"}
_LOOSE = {  # a smaller change needs no message: absolute, and relative
    "major": (1.0, 0.2),
    "minor": (1.0, 0.2),
    "axis": (0.3, 0.0),
    "heading": (0.03, 0.0),
    "existence": (0.05, 0.0),
    "cpa": (5.0, 0.05),
    "cpa_time": (3.0, 0.0),
    "probability": (0.02, 0.0),
    "identity_probability": (0.05, 0.0),
    "seen": (1e300, 0.0),
}
_MOVED_M = 2.0
_MOVED_STDS = 0.5
_REPEAT_S = 15.0
_MOVES_PER_S, _FAR = 400.0, 6.0  # so many rows for small moves; large ones are sent at once
_GONE_KEPT = 5000
_SECTIONS = ("origin_deg", "radars", "encounters", "alarms", "zones", "status", "limits", "note")
_MOST_PLOTS = 4000
_MOST_ENCOUNTERS = 200


@dataclass
class _Row:
    values: list[Any]
    version: int


class _Table:
    """Rows by id, each with the version at which it last changed."""

    def __init__(self, columns: tuple[str, ...]) -> None:
        self._loose = [_LOOSE.get(name) for name in columns[6:]]
        self.rows: dict[Any, _Row] = {}
        self._gone: deque[tuple[int, Any]] = deque(maxlen=_GONE_KEPT)

    def take(self, rows: Iterable[list[Any]], version: int) -> None:
        left = set(self.rows)
        for values in rows:
            key = values[0]
            left.discard(key)
            row = self.rows.get(key)
            if row is None:
                row = self.rows[key] = _Row(values, version)
            elif self._differs(row.values, values):
                row.values, row.version = values, version
        for key in left:
            del self.rows[key]
            self._gone.append((version, key))

    def since(self, version: int) -> tuple[list[list[Any]], list[Any], bool]:
        """Changed rows, keys that are gone, and whether that is everything there is."""
        lost = len(self._gone) == _GONE_KEPT and self._gone[0][0] > version
        if version == 0 or lost:
            return [row.values for row in self.rows.values()], [], True
        changed = [row.values for row in self.rows.values() if row.version > version]
        return changed, [key for when, key in self._gone if when > version], False

    def _differs(self, old: list[Any], new: list[Any]) -> bool:
        """Whether a page that keeps the old row shows something else."""
        dt_s = new[1] - old[1]
        if not 0.0 <= dt_s < _REPEAT_S:
            return True
        if dt_s > 0.0:
            std_m = new[6] or 0.0
            allowed_m = max(_MOVED_M, _MOVED_STDS * std_m)
            off_m = math.hypot(old[2] + dt_s * old[4] - new[2], old[3] + dt_s * old[5] - new[3])
            off_mps = math.hypot(old[4] - new[4], old[5] - new[5])
            moved = off_m > allowed_m or off_mps * _REPEAT_S > 4.0 * allowed_m
            if moved and (dt_s >= len(self.rows) / _MOVES_PER_S or off_m > _FAR * allowed_m):
                return True
        elif old[2:6] != new[2:6]:
            return True
        for loose, a, b in zip(self._loose, old[6:], new[6:], strict=True):
            if a != b and (
                loose is None or a is None or b is None or abs(a - b) > loose[0] + loose[1] * abs(a)
            ):
                return True
        return False


class Scene:
    """Follows the pictures of a session and makes messages of them.

    A message has the rows of tracks and AIS that are new, the sections that have changed, and
    always the time, own ship and the plots of the last turn.
    """

    def __init__(self) -> None:
        self.version = 0
        self.time_s = 0.0
        self._epoch = 0
        self._past: dict[int, Any] = {}
        self._tracks, self._ais = _Table(TRACK_COLUMNS), _Table(AIS_COLUMNS)
        self._sections: dict[str, tuple[int, str]] = {}
        self._plots: tuple[int, str] = (0, "[]")
        self._always = "{}"

    def take(self, picture: Mapping[str, Any]) -> None:
        """Take the picture as it is now."""
        time_s = float(picture["time_s"])
        if time_s < self.time_s - 1.0:  # a replay that was set back
            self._tracks, self._ais = _Table(TRACK_COLUMNS), _Table(AIS_COLUMNS)
            self._epoch = self.version + 1
        self.time_s = time_s
        self.version += 1
        self._past = {one["track_id"]: one.get("history", ()) for one in picture["tracks"]}
        self._tracks.take([_track_row(one, time_s) for one in picture["tracks"]], self.version)
        placed = [one for one in picture.get("ais", ()) if _known(one.get("north_m"))]
        self._ais.take([_ais_row(one, time_s) for one in placed], self.version)
        for name in _SECTIONS:
            value = picture.get(name)
            if name == "encounters" and value and len(value) > _MOST_ENCOUNTERS:
                value = sorted(value, key=lambda one: -one["probability"])[:_MOST_ENCOUNTERS]
            text = _dumps(_rounded(value))
            if self._sections.get(name, (0, None))[1] != text:
                self._sections[name] = (self.version, text)
        plots = np.asarray(picture.get("plots", ()), dtype=float).reshape(-1, 2)[:_MOST_PLOTS]
        text = _dumps(np.round(plots, 1).tolist())
        if text != self._plots[1]:
            self._plots = (self.version, text)
        always = {
            name: _rounded(picture.get(name), 7 if name == "own" else 3)
            for name in ("time_s", "live", "own", "ashore", "replay")
        }
        self._always = _dumps(always)

    def message(self, version: int) -> tuple[str, int]:
        """JSON text of what is newer than a version (0: everything), and its version."""
        if version < self._epoch:
            version = 0
        tracks, gone, all_tracks = self._tracks.since(version)
        ais, ais_gone, all_ais = self._ais.since(version)
        parts = [f'"type":"picture","version":{self.version}', self._always[1:-1]]
        if version == 0:
            parts.append(f'"past":{_dumps(_rounded(self._past, 1))}')
        if all_tracks or all_ais:
            parts.append('"all":true')
            tracks, gone, _ = self._tracks.since(0)
            ais, ais_gone, _ = self._ais.since(0)
        for name, value in (
            ("tracks", tracks), ("gone", gone), ("ais", ais), ("ais_gone", ais_gone),
        ):  # fmt: skip
            if value:
                parts.append(f'"{name}":{_dumps(value)}')
        for name, (changed, text) in self._sections.items():
            if changed > version:
                parts.append(f'"{name}":{text}')
        if self._plots[0] > version:
            parts.append(f'"plots":{self._plots[1]}')
        return "{" + ",".join(parts) + "}", self.version


def _track_row(track: Mapping[str, Any], time_s: float) -> list[Any]:
    major_m, minor_m, axis_rad = _ellipse(track.get("covariance"))
    cpa = track.get("cpa") or {}
    tcpa_s, age_s = cpa.get("tcpa_s"), track.get("age_s")
    mode = track.get("mode", "")
    return [
        int(track["track_id"]),
        round(float(track.get("time_s", time_s)), 2),
        *(_round(track[name], 1) for name in ("north_m", "east_m")),
        *(_round(track[name], 2) for name in ("vnorth_mps", "veast_mps")),
        *(_round(major_m, 1), _round(minor_m, 1), _round(axis_rad, 2)),
        _round(time_s - age_s, 1) if _known(age_s) else None,
        *(track.get("status", ""), _MOTION.get(mode, mode)),
        *(_round(track.get("existence"), 2), _round(cpa.get("cpa_m"), 0)),
        _round(time_s + tcpa_s, 0) if _known(tcpa_s) else None,
        _round(cpa.get("probability"), 2),
        *(track.get("name") or "", track.get("identity") or ""),
        _round(track.get("identity_probability"), 2),
    ]


def _ais_row(vessel: Mapping[str, Any], time_s: float) -> list[Any]:
    speed_mps, course_rad = vessel.get("speed_mps"), vessel.get("course_rad")
    moves = _known(speed_mps) and _known(course_rad)
    velocity = [speed_mps * f(course_rad) if moves else 0.0 for f in (math.cos, math.sin)]
    return [
        str(vessel.get("identity") or vessel.get("mmsi")),
        round(time_s - (vessel.get("age_s") or 0.0), 2),
        *(_round(vessel["north_m"], 1), _round(vessel["east_m"], 1)),
        *(_round(v, 2) for v in velocity),
        _round(vessel.get("heading_rad"), 2),
        vessel.get("name") or "",
        vessel.get("track_id"),
    ]


def _ellipse(covariance: Any) -> tuple[float | None, float | None, float | None]:
    """Half axes of one standard deviation, and the direction of the longer one."""
    if covariance is None:
        return None, None, None
    xx, xy, yy = covariance[0][0], covariance[0][2], covariance[2][2]
    middle, half = (xx + yy) / 2, math.hypot((xx - yy) / 2, xy)
    axis_rad = 0.5 * math.atan2(2 * xy, xx - yy)
    return math.sqrt(max(middle + half, 0.0)), math.sqrt(max(middle - half, 0.0)), axis_rad


def _known(value: Any) -> bool:
    return value is not None and math.isfinite(value)


def _round(value: Any, digits: int) -> float | int | None:
    if not _known(value):
        return None
    rounded = round(float(value), digits)
    return int(rounded) if digits <= 0 else rounded


def _rounded(value: Any, digits: int = 3) -> Any:
    """For JSON: numbers rounded, NaN and infinity None, arrays lists."""
    if isinstance(value, (bool, int, str)) or value is None:
        return value
    if isinstance(value, Mapping):
        return {str(k): _rounded(v, digits) for k, v in value.items()}
    if isinstance(value, np.ndarray):
        return _rounded(value.tolist(), digits)
    if isinstance(value, (list, tuple)):
        return [_rounded(one, digits) for one in value]
    return _round(value, digits)


def _dumps(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
