"""Deltas of a Signal K server: own ship and the vessels of AIS."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from .nmea import OwnReading
from .problems import Problems

HOW_TO_GET = "Signal K needs aiohttp: pip install 'wakeline[live]'"
_MMSI = re.compile(r"mmsi:(\d{9})$")
_OWN = ("vessels.self", "self", "")
_FIXED = ("atons.", "shore.")
_LONGEST = 4 << 20
_PER_TURN = "spokesPerRevolution"
_WANTED = {
    "context": "*",
    "subscribe": [{"path": "*", "period": 200, "policy": "instant"}],
}


class VesselReading(NamedTuple):
    """What a delta says of another vessel: its MMSI and values by the names of `AisVessel`."""

    mmsi: int
    values: dict[str, Any]


class SignalkDecoder:
    """Deltas of one server, one JSON object a message."""

    def __init__(self) -> None:
        self._own = set(_OWN)
        self._speed = self._course = math.nan

    def feed(self, octets: bytes, problems: Problems) -> Iterator[OwnReading | VesselReading]:
        """The readings of a message."""
        try:
            delta = json.loads(octets)
            if not isinstance(delta, Mapping):
                raise TypeError(f"wanted an object, got {json.dumps(delta)[:40]}")
            if isinstance(delta.get("self"), str):
                self._own.add(delta["self"].removeprefix("vessels."))
                self._own.add(f"vessels.{delta['self'].removeprefix('vessels.')}")
            values = list(_values(delta))
        except (ValueError, RecursionError, TypeError) as error:
            problems.add("Signal K", str(error))
            return
        context = str(delta.get("context", ""))
        if context in self._own:
            yield from self._own_readings(values)
            return
        mmsi = _MMSI.search(context)
        if mmsi is not None:
            vessel = _vessel(values)
            if vessel:
                vessel["is_fixed"] = context.startswith(_FIXED)
                yield VesselReading(int(mmsi[1]), vessel)

    def _own_readings(self, values: list[tuple[str, Any]]) -> Iterator[OwnReading]:
        for path, value in values:
            place = _place(path, value)
            if place is not None:
                yield OwnReading("position", "SIGNALK", "", place)
            quantity = _QUANTITIES.get(path)
            number = _number(value)
            if quantity is not None and number is not None:
                yield OwnReading(quantity, "SIGNALK", "", (number,))
            if path == "navigation.speedOverGround" and number is not None:
                self._speed = number
            elif path == "navigation.courseOverGroundTrue" and number is not None:
                self._course = number
        moved = {path for path, _ in values} & set(_VELOCITY)
        if moved and math.isfinite(self._speed + self._course):
            velocity = (
                self._speed * math.cos(self._course),
                self._speed * math.sin(self._course),
            )
            yield OwnReading("velocity", "SIGNALK", "", velocity)


_VELOCITY = ("navigation.speedOverGround", "navigation.courseOverGroundTrue")
_QUANTITIES = {
    "navigation.headingTrue": "heading",
    "navigation.headingMagnetic": "magnetic",
    "navigation.magneticVariation": "variation",
    "navigation.rateOfTurn": "turn",
}
_OF_VESSEL = {
    "navigation.speedOverGround": "speed_mps",
    "navigation.courseOverGroundTrue": "course_rad",
    "navigation.headingTrue": "heading_rad",
}


def _values(delta: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    for update in _objects(delta, "updates"):
        for one in _objects(update, "values"):
            yield str(one.get("path", "")), one.get("value")


def _objects(given: Mapping[str, Any], name: str) -> Sequence[Mapping[str, Any]]:
    """The objects in a list, which may be left out."""
    found = given.get(name, [])
    if not isinstance(found, list) or not all(isinstance(one, Mapping) for one in found):
        raise TypeError(f"wanted a list of objects in {name}, got {json.dumps(found)[:40]}")
    return found


def _vessel(values: list[tuple[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for path, value in values:
        place = _place(path, value)
        number = _number(value)
        if place is not None:
            found["latitude_deg"], found["longitude_deg"] = place
        elif path in _OF_VESSEL and number is not None:
            found[_OF_VESSEL[path]] = number
        elif path == "" and isinstance(value, Mapping) and isinstance(value.get("name"), str):
            found["name"] = value["name"][:40]
    return found


def _place(path: str, value: Any) -> tuple[float, float] | None:
    if path != "navigation.position" or not isinstance(value, Mapping):
        return None
    latitude, longitude = _number(value.get("latitude")), _number(value.get("longitude"))
    if latitude is None or longitude is None or abs(latitude) > 90 or abs(longitude) > 360:
        return None
    return latitude, longitude


def _number(value: Any) -> float | None:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if is_number and abs(value) < 1e9 else None


def receive(
    host: str, port: int, radar: str, take: Callable[[bytes], None], ends: Callable[[], bool]
) -> bool:
    """Receive the deltas of a server, or the spokes of a radar if one is named.

    Of a radar the capabilities come first. False when the server has closed the stream, True when
    it `ends`.

    Raises
    ------
    OSError
        When there is no connection.
    ModuleNotFoundError
        When aiohttp is not installed.
    """
    import asyncio

    try:
        import aiohttp
    except ModuleNotFoundError:
        raise ModuleNotFoundError(HOW_TO_GET) from None
    server = f"http://{host}:{port}/signalk"
    radar_url = f"{server}/v2/api/vessels/self/radars/{radar}"
    stream_url = f"{radar_url}/spokes" if radar else f"{server}/v1/stream?subscribe=none"

    async def work() -> bool:
        async with aiohttp.ClientSession() as client:
            if radar:
                async with client.get(f"{radar_url}/capabilities") as answer:
                    answer.raise_for_status()
                    capabilities = await answer.json()
                    if isinstance(capabilities, dict) and not capabilities.get(_PER_TURN):
                        raise OSError("the radar has no spokes yet")
                    take(json.dumps(capabilities).encode())
            async with client.ws_connect(
                stream_url, heartbeat=20.0, max_msg_size=_LONGEST
            ) as stream:
                if not radar:
                    await stream.send_json(_WANTED)
                while not ends():
                    try:
                        message = await stream.receive(timeout=0.2)
                    except asyncio.TimeoutError:
                        continue
                    if message.type == aiohttp.WSMsgType.TEXT:
                        take(message.data.encode())
                    elif message.type == aiohttp.WSMsgType.BINARY:
                        take(message.data)
                    else:
                        return False
                return True

    async def in_words() -> bool:
        try:
            return await work()
        except (aiohttp.ClientError, asyncio.TimeoutError, ValueError) as error:
            raise OSError(str(error) or type(error).__name__) from None

    return asyncio.run(in_words())
