"""The Signal K Radar API, version 3.4: radars, capabilities, guard zones, targets and spokes.

Distances are metres, angles radians, bearings and courses clockwise from north.
"""

from __future__ import annotations

import asyncio
import json
import math
import re
import struct
import time
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timezone
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

import numpy as np
from aiohttp import web

from wakeline import __version__
from wakeline._brief import quoted
from wakeline._units import NAUTICAL_MILE_M

from ..alarms import notification
from .echoes import EchoReader

if TYPE_CHECKING:
    from .server import WebApp

VERSION = "3.4.0"
_BASE = "/signalk/v2/api/vessels/self/radars"
_SELF = "vessels.self"
_LOST_S = 10.0  # a lost target is reported as lost before it is deleted
_MOST_PATTERNS, _LONGEST_PATTERN = 64, 200
_PERIOD_S, _SHORTEST_S = 1.0, 0.25  # of a subscription that names none; that of pictures
_ZONES = ("guardZone1", "guardZone2")
_SPOKE_S = 0.04
_LATER_S = 0.001  # than a time, so that it has passed
_TURN_RAD = 2.0 * math.pi
_LEVELS = 16
_ANGLES, _DISTANCES = ("value", "endValue"), ("startDistance", "endDistance")
_ANGLE_UNITS = {"rad": 1.0, "deg": math.pi / 180.0}
_DISTANCE_UNITS = {"m": 1.0, "km": 1000.0, "nm": NAUTICAL_MILE_M}
_FARTHEST_ZONE_M = 1e5
_ROUNDING = 1e-3  # of limits by clients, rad and m
_NEAREST_TARGET_M, _FARTHEST_TARGET_M = 1.0, 4e5


class SignalK:
    """The API over the pictures of a session.

    Parameters
    ----------
    server : WebApp
    """

    def __init__(self, server: WebApp) -> None:
        self._server = server
        self._picture: Mapping[str, Any] = {"time_s": 0.0, "tracks": (), "radars": ()}
        self._first_seen: dict[int, float] = {}
        self._lost: dict[int, tuple[float, dict[str, Any]]] = {}
        self._values: dict[str, Any] = {}
        self._version = 0
        self._versions: dict[str, int] = {}
        self._deleted: deque[tuple[int, str]] = deque(maxlen=2000)
        self._changed = asyncio.Event()
        self._zone_ids: dict[str, int] = {}
        self._switched_on = ""  # the control whose zone is being made
        self._inside: list[set[int]] = []  # tracks in the zone of each control

    def routes(self) -> list[web.RouteDef]:
        """All routes below ``/signalk``."""
        one = _BASE + "/{radar}"
        return [
            web.get("/signalk", self._discovery),
            web.get(_BASE, self._list),
            web.get(_BASE + "/", self._list),
            web.get(_BASE + "/interfaces", self._interfaces),
            web.get(one, self._one),
            web.get(one + "/capabilities", self._capabilities),
            web.get(one + "/controls", self._controls),
            web.get(one + "/controls/{control}", self._control),
            web.put(one + "/controls/{control}", self._set_control),
            web.get(one + "/targets", self._targets),
            web.post(one + "/targets", self._acquire),
            web.delete(one + "/targets/{target}", self._cancel),
            web.get(one + "/spokes", self._spokes),
            web.get("/signalk/v1/stream", self._stream),
        ]

    # Pictures -------------------------------------------------------------------------------------

    def take(self, picture: Mapping[str, Any]) -> None:
        """Take a new picture; called on the loop of the server."""
        before, self._picture = self._picture, picture
        time_s, values = picture["time_s"], {}
        if time_s < before["time_s"] - 1.0:
            self._lost.clear()
            self._first_seen.clear()
        controls = self._zone_controls()
        self._inside = [set((self._zone_of(name) or {}).get("inside", ())) for name in _ZONES]
        now = {track["track_id"]: self._target(track) for track in picture["tracks"]}
        for track in before["tracks"]:
            if track["track_id"] not in now and 0.0 <= time_s - before["time_s"] <= _LOST_S:
                last = self._target(track) | {"status": "lost"}
                self._lost[track["track_id"]] = (time_s, last)
        for track_id, (since_s, last) in list(self._lost.items()):
            if track_id in now or time_s - since_s > _LOST_S:
                del self._lost[track_id]
            else:
                now[track_id] = last
        self._first_seen = {k: v for k, v in self._first_seen.items() if k in now}
        radars = list(self._radars())
        for radar in radars[:1]:  # one tracker for all radars
            for track_id, target in now.items():
                values[f"radars.{radar}.targets.{track_id}"] = target
            for name, value in controls.items():
                values[f"radars.{radar}.controls.{name}"] = value
            for alarm in picture.get("alarms", ()):
                path, value = notification(radar, alarm)
                if value is not None:
                    values[path] = value
        self._version += 1
        for path, value in values.items():
            if self._values.get(path) != value:
                self._versions[path] = self._version
        for path in self._values.keys() - values.keys():
            del self._versions[path]
            self._deleted.append((self._version, path))
        self._values = values
        self._changed.set()
        self._changed = asyncio.Event()

    def _radars(self) -> dict[str, Mapping[str, Any]]:
        return {_slug(one["name"], k): one for k, one in enumerate(self._picture["radars"])}

    def _radar(self, request: web.Request) -> Mapping[str, Any]:
        radar = self._radars().get(request.match_info["radar"])
        if radar is None:
            raise _error(web.HTTPNotFound, "no radar has that name")
        return radar

    def _target(self, track: Mapping[str, Any]) -> dict[str, Any]:
        track_id, place = track["track_id"], self._place(next(iter(self._picture["radars"]), {}))
        time_s = track.get("time_s", self._picture["time_s"])
        seen_s = time_s - (track.get("age_s") or 0.0)
        first_s = track.get("first_s", self._first_seen.setdefault(track_id, seen_s))
        acquiring = track.get("status") in ("tentative", "held")
        position: dict[str, Any] = {}
        if place is not None:
            north_m, east_m = track["north_m"] - place[0], track["east_m"] - place[1]
            position["bearing"] = round(math.atan2(east_m, north_m) % _TURN_RAD, 4)
            position["distance"] = round(math.hypot(north_m, east_m), 1)
        if track.get("latitude_deg") is not None:
            position["latitude"] = round(track["latitude_deg"], 7)
            position["longitude"] = round(track["longitude_deg"], 7)
        target: dict[str, Any] = {
            "id": track_id,
            "status": "acquiring" if acquiring else "tracking",
            "position": position,
            "acquisition": "manual" if track.get("manual") else "auto",
            "firstSeen": _iso(first_s),
            "lastSeen": _iso(seen_s),
        }
        if not acquiring:
            course_rad = math.atan2(track["veast_mps"], track["vnorth_mps"]) % _TURN_RAD
            speed_mps = math.hypot(track["vnorth_mps"], track["veast_mps"])
            target["motion"] = {"course": round(course_rad, 4), "speed": round(speed_mps, 2)}
        cpa = track.get("cpa")
        known = cpa and cpa.get("cpa_m") is not None and cpa.get("tcpa_s") is not None
        if known and cpa["tcpa_s"] >= 0.0:
            target["danger"] = {"cpa": round(cpa["cpa_m"], 1), "tcpa": round(cpa["tcpa_s"], 1)}
        zones = [k for k, inside in enumerate(self._inside, 1) if track_id in inside]
        if zones and not track.get("manual"):
            target["sourceZone"] = zones[0]
        return target

    def _place(self, radar: Mapping[str, Any]) -> tuple[float, float] | None:
        """North and east of what a radar measures from: the radar ashore, else own ship."""
        own = self._picture.get("own")
        if not radar.get("aboard", True) and radar.get("north_m") is not None:
            return radar["north_m"], radar["east_m"]
        return None if own is None or own.get("lost") else (own["north_m"], own["east_m"])

    def _zone_of(self, name: str) -> Mapping[str, Any] | None:
        """The zone of a control; None while it is off."""
        zones = {zone["zone_id"]: zone for zone in self._picture.get("zones", ())}
        return zones.get(self._zone_ids.get(name, 0))

    def _zone_controls(self) -> dict[str, Any]:
        """The first two guard zones about own ship; the second name is free while there is one."""
        zones = {
            zone["zone_id"]: zone
            for zone in self._picture.get("zones", ())
            if "far_m" in zone and zone["from_bow"]
        }
        self._zone_ids = {k: v for k, v in self._zone_ids.items() if v in zones}
        for zone_id in zones:
            free = [name for name in _ZONES if name not in self._zone_ids]
            free.sort(key=lambda name: name != self._switched_on)
            if free and zone_id not in self._zone_ids.values():
                self._zone_ids[free[0]] = zone_id
        off = {"value": 0.0, "endValue": 0.0, "startDistance": 0.0, "endDistance": 0.0}
        controls: dict[str, Any] = {name: {"enabled": False} | off for name in _ZONES}
        for name, zone_id in self._zone_ids.items():
            zone = zones[zone_id]
            controls[name] = {
                "enabled": True,
                "value": _wrapped(zone["from_rad"]),
                "endValue": _wrapped(zone["to_rad"]),
                "startDistance": zone["near_m"],
                "endDistance": zone["far_m"],
            }
        return controls

    # REST -----------------------------------------------------------------------------------------

    async def _fresh(self) -> None:
        await self._server.take_picture()

    async def _discovery(self, request: web.Request) -> web.Response:
        host = request.host
        v1 = {"version": "1.7.0", "signalk-ws": f"ws://{host}/signalk/v1/stream"}
        v2 = {"version": VERSION, "signalk-http": f"http://{host}/signalk/v2/api/"}
        server = {"id": "wakeline", "version": __version__}
        return web.json_response({"endpoints": {"v1": v1, "v2": v2}, "server": server})

    def _described(self, request: web.Request, radar: str) -> dict[str, Any]:
        host = request.host
        return {
            "name": self._radars()[radar]["name"],
            "brand": "Wakeline",
            "spokeDataUrl": f"ws://{host}{_BASE}/{radar}/spokes",
            "streamUrl": f"ws://{host}/signalk/v1/stream",
        }

    async def _list(self, request: web.Request) -> web.Response:
        await self._fresh()
        radars = {radar: self._described(request, radar) for radar in self._radars()}
        return web.json_response({"version": VERSION, "radars": radars})

    async def _interfaces(self, request: web.Request) -> web.Response:
        return web.json_response({"brands": ["Wakeline"], "interfaces": {}})

    async def _one(self, request: web.Request) -> web.Response:
        await self._fresh()
        self._radar(request)
        return web.json_response(self._described(request, request.match_info["radar"]))

    async def _capabilities(self, request: web.Request) -> web.Response:
        await self._fresh()
        image = self._server.image_of(self._radar(request)["name"])
        rows, columns = image.shape if image is not None else (0, 0)
        range_m = image.range_m if image is not None and image.range_m > 0.0 else 0.0
        pixels = [_color(k) for k in range(_LEVELS)]
        return web.json_response(
            {
                "minRange": range_m,
                "maxRange": range_m,
                "supportedRanges": [range_m] if range_m else [],
                "spokesPerRevolution": rows,
                "maxSpokeLength": columns,
                "pixelValues": _LEVELS,
                "hasDoppler": False,
                "hasDualRadar": False,
                "hasDualRange": False,
                "hasSparseSpokes": False,
                "noTransmitSectors": 0,
                "controls": {name: _zone_schema(k) for k, name in enumerate(_ZONES)},
                "legend": {
                    "lowReturn": 3,
                    "mediumReturn": 8,
                    "strongReturn": 13,
                    "pixelColors": _LEVELS,
                    "pixels": [{"type": "normal", "color": color} for color in pixels],
                },
            }
        )

    async def _controls(self, request: web.Request) -> web.Response:
        await self._fresh()
        self._radar(request)
        return web.json_response(self._zone_controls())

    async def _control(self, request: web.Request) -> web.Response:
        await self._fresh()
        self._radar(request)
        control = self._zone_controls().get(request.match_info["control"])
        if control is None:
            raise _error(web.HTTPNotFound, "no control has that name")
        return web.json_response(control)

    async def _set_control(self, request: web.Request) -> web.Response:
        await self._fresh()
        self._radar(request)
        answer = await self._set_zone(request.match_info["control"], await _json_of(request))
        return _answered(answer)

    async def _set_zone(self, name: str, value: Mapping[str, Any]) -> dict[str, Any]:
        if name not in _ZONES:
            return {"ok": False, "error": "no control has that name"}
        try:
            now = self._zone_controls()[name] | _in_si(value)
        except ValueError as error:
            return {"ok": False, "error": str(error)}
        before = self._zone_of(name) or {"name": f"guard zone {_ZONES.index(name) + 1}"}
        if not now.get("enabled"):
            if "zone_id" not in before:
                return {"ok": True}
            command = {"command": "zone_delete", "zone_id": before["zone_id"]}
            return await self._server.command(command)
        zone = {key: value for key, value in before.items() if key != "inside"} | {
            "near_m": now["startDistance"],
            "far_m": now["endDistance"],
            "from_rad": now["value"],
            "to_rad": now["endValue"],
            "from_bow": True,
        }
        self._switched_on = name
        answer = await self._server.command({"command": "zone", "zone": zone})
        if answer.get("ok"):
            zone_id = answer["zone"]["zone_id"]
            others = {k: v for k, v in self._zone_ids.items() if v != zone_id}
            self._zone_ids = others | {name: zone_id}
        return answer

    async def _targets(self, request: web.Request) -> web.Response:
        await self._fresh()
        self._radar(request)
        prefix = f"radars.{request.match_info['radar']}.targets."
        return web.json_response([v for k, v in self._values.items() if k.startswith(prefix)])

    async def _acquire(self, request: web.Request) -> web.Response:
        await self._fresh()
        place, wanted = self._place(self._radar(request)), await _json_of(request)
        bearing_rad, distance_m = _number(wanted.get("bearing")), _number(wanted.get("distance"))
        if bearing_rad is None:
            raise _error(web.HTTPBadRequest, "wanted bearing, rad")
        if distance_m is None or not _NEAREST_TARGET_M <= distance_m <= _FARTHEST_TARGET_M:
            limits = f"from {_NEAREST_TARGET_M:g} to {_FARTHEST_TARGET_M:g} m"
            raise _error(web.HTTPBadRequest, f"wanted distance {limits}")
        if place is None:
            raise _error(web.HTTPConflict, "own ship's position is unknown")
        command = {
            "command": "acquire",
            "north_m": place[0] + distance_m * math.cos(bearing_rad),
            "east_m": place[1] + distance_m * math.sin(bearing_rad),
        }
        return _answered(await self._server.command(command))

    async def _cancel(self, request: web.Request) -> web.Response:
        self._radar(request)
        target = request.match_info["target"]
        if not target.isdecimal() or len(target) > 15:
            raise _error(web.HTTPNotFound, "no target has that number")
        answer = await self._server.command({"command": "drop", "track_id": int(target)})
        return _answered(answer, web.HTTPNotFound)

    # Streams --------------------------------------------------------------------------------------

    async def _stream(self, request: web.Request) -> web.StreamResponse:
        stream = await self._server.open_stream(request)
        subscriptions: dict[str, _Subscription] = {}
        asked = asyncio.Event()
        await self._fresh()
        if request.query.get("subscribe", "self") != "none":
            cached = request.query.get("sendCachedValues") != "false"
            subscriptions["*"] = _Subscription("*", version=0 if cached else self._version)
        hello = {
            "name": "wakeline",
            "version": VERSION,
            "self": _SELF,
            "roles": ["main"],
            "timestamp": _iso(self._picture["time_s"]),
        }
        await stream.send_json(hello)
        await stream.send_json(self._delta(meta=self._meta()))

        async def send() -> None:
            while True:
                changed = self._changed
                asked.clear()
                values: dict[str, Any] = {}
                for one in subscriptions.values():
                    values |= self._due(one)
                if values:
                    rows = [{"path": path, "value": value} for path, value in values.items()]
                    await stream.send_json(self._delta(values=rows))
                now_s = time.monotonic()
                waits_s = [one.wait_s(now_s) for one in subscriptions.values()]
                await _first_of(changed, asked, within_s=min(waits_s, default=math.inf))

        async def receive(text: str) -> None:
            try:
                message = json.loads(text)
            except (ValueError, RecursionError):
                return
            if not isinstance(message, dict):
                return
            for one in _subscriptions(message.get("unsubscribe") or message.get("desubscribe")):
                if one.pattern == "*":
                    subscriptions.clear()
                subscriptions.pop(one.pattern, None)
            for one in _subscriptions(message.get("subscribe")):
                if one.pattern in subscriptions or len(subscriptions) < _MOST_PATTERNS:
                    subscriptions[one.pattern] = one
            asked.set()
            path, value = message.get("path"), message.get("value")
            if isinstance(path, str) and path in self._values and isinstance(value, dict):
                await self._set_zone(path.rpartition(".")[2], value)

        await self._server.run_stream(stream, send, receive)
        return stream

    def _due(self, one: _Subscription) -> dict[str, Any]:
        """Values by path that a subscription is to be sent now."""
        passed_s = time.monotonic() - one.sent_s
        if passed_s < one.least_s:
            return {}
        since = 0 if passed_s > one.repeat_s else one.version
        values = {k: v for k, v in self._values.items() if self._versions[k] > since}
        for when, path in self._deleted if one.version else ():
            if when > one.version and path not in self._values:
                values[path] = None
        values = {path: value for path, value in values.items() if fnmatchcase(path, one.pattern)}
        one.version = self._version
        if values:
            one.sent_s = time.monotonic()
        return values

    def _meta(self) -> list[dict[str, Any]]:
        return [
            {"path": f"radars.{radar}.controls.{name}", "value": _zone_schema(k)}
            for radar in list(self._radars())[:1]
            for k, name in enumerate(_ZONES)
        ]

    def _delta(self, **content: list[dict[str, Any]]) -> dict[str, Any]:
        update = {"$source": "wakeline", "timestamp": _iso(self._picture["time_s"])} | content
        return {"context": _SELF, "updates": [update]}

    async def _spokes(self, request: web.Request) -> web.StreamResponse:
        image = self._server.image_of(self._radar(request)["name"])
        if image is None:
            raise _error(web.HTTPNotFound, "this radar gives plots, no video")
        stream = await self._server.open_stream(request, compress=False)
        reader = EchoReader(image, 64)

        async def send() -> None:
            while True:
                while message := reader.next():
                    octets = spokes_of(message, self._picture["time_s"])
                    self._server.octets_sent += len(octets)
                    await stream.send_bytes(octets)
                await asyncio.sleep(_SPOKE_S)

        async def receive(text: str) -> None:
            pass

        await self._server.run_stream(stream, send, receive)
        return stream


def spokes_of(message: bytes, time_s: float) -> bytes:
    """Rows of an echo image as a ``RadarMessage`` in protocol buffers.

    ``RadarMessage { repeated Spoke spokes = 2; }`` and ``Spoke { uint32 angle = 1; uint32 bearing =
    2; uint32 range = 3; uint64 time = 4; bytes data = 5; }``: angle from the bow and bearing from
    north in rows of a turn, range of the last pixel in metres, time in ms since 1970.
    """
    _, _, rows, columns, count, range_m, heading_rad = struct.unpack_from("<BBHHHff", message)
    head = struct.calcsize("<BBHHHff")
    numbers = np.frombuffer(message, "<u2", count, head)
    packed = np.frombuffer(message, np.uint8, offset=head + 2 * count).reshape(count, columns // 2)
    data = np.empty((count, columns), np.uint8)
    data[:, 0::2], data[:, 1::2] = packed & 15, packed >> 4
    ahead = 0 if math.isnan(heading_rad) else round(heading_rad / _TURN_RAD * rows)
    common = b"\x18" + _varint(round(range_m)) + b"\x20" + _varint(max(round(1e3 * time_s), 0))
    out = []
    for number, pixels in zip(numbers.tolist(), data, strict=True):
        spoke = b"\x08" + _varint((number - ahead) % rows) + b"\x10" + _varint(number) + common
        spoke += b"\x2a" + _varint(columns) + pixels.tobytes()
        out.append(b"\x12" + _varint(len(spoke)) + spoke)
    return b"".join(out)


def _varint(value: int) -> bytes:
    octets = bytearray()
    while value > 127:
        octets.append(value & 127 | 128)
        value >>= 7
    octets.append(value)
    return bytes(octets)


def _in_si(value: Mapping[str, Any]) -> dict[str, Any]:
    """What a client sets of a zone, in radians and metres; its units are of angles or distances.

    Raises
    ------
    ValueError
        When a value has unknown units, is not a number or is out of range.
    """
    units = value.get("units", "rad")
    if not isinstance(units, str) or units not in _ANGLE_UNITS | _DISTANCE_UNITS:
        known = ", ".join(_ANGLE_UNITS | _DISTANCE_UNITS)
        raise ValueError(f"units of a zone must be one of {known}, got {quoted(units)}")
    si: dict[str, Any] = {}
    if "enabled" in value:
        if not isinstance(value["enabled"], bool):
            raise ValueError(f"enabled must be true or false, got {quoted(value['enabled'])}")
        si["enabled"] = value["enabled"]
    for names, factors, least, most, unit in (
        (_ANGLES, _ANGLE_UNITS, -math.pi, math.pi, "rad"),
        (_DISTANCES, _DISTANCE_UNITS, 0.0, _FARTHEST_ZONE_M, "m"),
    ):
        for name in names:
            if name not in value:
                continue
            given, number = units if units in factors else unit, _number(value[name])
            si[name] = math.nan if number is None else number * factors[given]
            if not least - _ROUNDING <= si[name] <= most + _ROUNDING:
                limits = f"from {least:.6g} to {most:.6g} {unit}"
                raise ValueError(f"{name} must be {limits}, got {quoted(value[name])} {given}")
    return si


def _zone_schema(k: int) -> dict[str, Any]:
    return {
        "id": 16 + k,
        "name": f"Guard zone {k + 1}",
        "description": "Sector about own ship that raises an alarm for targets inside",
        "category": "guardZones",
        "dataType": "zone",
        "hasEnabled": True,
        "minValue": -math.pi,
        "maxValue": math.pi,
        "maxDistance": _FARTHEST_ZONE_M,
        "units": "rad",
    }


def _color(level: int) -> str:
    share = level / (_LEVELS - 1)
    red, green, blue = (round(255 * c) for c in (share**1.5, share**0.6, 0.3 * share))
    return f"#{red:02x}{green:02x}{blue:02x}{255 if level else 0:02x}"


def _number(value: Any) -> float | None:
    """A finite number; None for what is none."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    return float(value) if abs(value) < 1e300 else None


@dataclass
class _Subscription:
    """Paths that a client wants, how often, and what of them it has.

    Attributes
    ----------
    pattern : str
    least_s, repeat_s : float
        Between messages at least, and after which what has not changed is sent again.
    version : int
    sent_s : float
    """

    pattern: str
    least_s: float = 0.0
    repeat_s: float = math.inf
    version: int = 0
    sent_s: float = -math.inf

    @classmethod
    def of(cls, wanted: Any) -> _Subscription | None:
        """As a client asks for it; None of what is none.

        The policy is "instant", not within `minPeriod`, "ideal", the same and again after `period`,
        or "fixed", every `period`; without one "fixed" if there is a `period`.
        """
        path = wanted.get("path") if isinstance(wanted, dict) else None
        if not isinstance(path, str) or len(path) > _LONGEST_PATTERN:
            return None
        period_s, least_s = (_seconds(wanted.get(name)) for name in ("period", "minPeriod"))
        policy = wanted.get("policy", "instant" if period_s is None else "fixed")
        period_s = _PERIOD_S if period_s is None else max(period_s, _SHORTEST_S)
        if policy == "fixed":
            return cls(path, period_s, period_s)
        return cls(path, least_s or 0.0, period_s if policy == "ideal" else math.inf)

    def wait_s(self, now_s: float) -> float:
        """Time until something may be due that has not changed since."""
        due_s = (self.sent_s + self.least_s - now_s, self.sent_s + self.repeat_s - now_s)
        return min((one_s for one_s in due_s if one_s >= 0.0), default=math.inf)


def _subscriptions(wanted: Any) -> list[_Subscription]:
    found = map(_Subscription.of, wanted[:_MOST_PATTERNS] if isinstance(wanted, list) else ())
    return [one for one in found if one is not None]


def _seconds(value: Any) -> float | None:
    """Of a time in ms; None of what is none."""
    number = _number(value)
    return None if number is None or number < 0.0 else number / 1000.0


async def _first_of(*events: asyncio.Event, within_s: float) -> None:
    """Wait until one of them is set, or so long."""
    waits = [asyncio.ensure_future(event.wait()) for event in events]
    try:
        timeout_s = within_s + _LATER_S if math.isfinite(within_s) else None
        await asyncio.wait(waits, timeout=timeout_s, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for one in waits:
            one.cancel()


def _slug(name: str, k: int) -> str:
    return re.sub(r"[^A-Za-z0-9_-]+", "-", name).strip("-") or f"radar-{k}"


def _wrapped(angle_rad: float) -> float:
    return math.remainder(angle_rad, _TURN_RAD)


def _iso(time_s: float) -> str:
    when = datetime.fromtimestamp(min(max(time_s, 0.0), 4e9), timezone.utc)
    return when.isoformat(timespec="milliseconds").replace("+00:00", "Z")


async def _json_of(request: web.Request) -> dict[str, Any]:
    try:
        value = json.loads(await request.read() or b"{}")
    except (ValueError, RecursionError):
        raise _error(web.HTTPBadRequest, "the body must be JSON") from None
    if not isinstance(value, dict):
        raise _error(web.HTTPBadRequest, "the body must be an object")
    return value


def _answered(
    answer: Mapping[str, Any], failure: type[web.HTTPException] = web.HTTPBadRequest
) -> web.Response:
    if not answer.get("ok"):
        raise _error(failure, str(answer.get("error", "")))
    return web.json_response(answer)


def _error(kind: type[web.HTTPException], text: str) -> web.HTTPException:
    return kind(text=json.dumps({"error": text}), content_type="application/json")
