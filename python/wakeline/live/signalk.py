"""Deltas of a Signal K server: own ship and the vessels of AIS."""

from __future__ import annotations

import asyncio
import json
import math
import re
import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from .nmea import OwnReading
from .problems import Problems

HOW_TO_GET = "Signal K needs aiohttp: pip install 'wakeline[live]'"
_MMSI = re.compile(r"mmsi:(\d{9})$")
_OWN = ("vessels.self", "self", "")
_PERIOD_MS = 200


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
                raise TypeError("wanted an object")
            if isinstance(delta.get("self"), str):
                self._own.add(delta["self"].removeprefix("vessels."))
                self._own.add(f"vessels.{delta['self'].removeprefix('vessels.')}")
            values = list(_values(delta))
        except (ValueError, RecursionError, TypeError, AttributeError) as error:
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
    for update in delta.get("updates", ()):
        for one in update.get("values", ()):
            yield str(one.get("path", "")), one.get("value")


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
    host: str, port: int, take: Callable[[float, bytes], None], ends: Callable[[], bool]
) -> bool:
    """Receive the deltas of a server until it closes the stream (False) or `ends` (True).

    Raises
    ------
    OSError
        When there is no connection.
    ModuleNotFoundError
        When aiohttp is not installed.
    """
    try:
        import aiohttp
    except ModuleNotFoundError:
        raise ModuleNotFoundError(HOW_TO_GET) from None
    wanted = {
        "context": "*",
        "subscribe": [{"path": "*", "period": _PERIOD_MS, "policy": "instant"}],
    }

    async def work() -> bool:
        url = f"http://{host}:{port}/signalk/v1/stream?subscribe=none"
        try:
            async with (
                aiohttp.ClientSession() as client,
                client.ws_connect(url, heartbeat=20.0, max_msg_size=1 << 20) as stream,
            ):
                await stream.send_json(wanted)
                while not ends():
                    try:
                        message = await stream.receive(timeout=0.2)
                    except asyncio.TimeoutError:
                        continue
                    if message.type != aiohttp.WSMsgType.TEXT:
                        return False
                    take(time.time(), message.data.encode())
        except aiohttp.ClientError as error:
            raise OSError(str(error)) from None
        return True

    return asyncio.run(work())
