"""A demonstration session: instruments and radars that send through sockets of the loopback.

A moving boat with a radar sends the bundled recording "joyride": plots as JSON lines, own ship as
NMEA 0183. A radar on the shore of a simulated strait sends video as ASTERIX category 240; four
vessels in it send AIS.
"""

from __future__ import annotations

import json
import math
import socket
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from functools import reduce
from operator import xor
from typing import NamedTuple

import numpy as np

import wakeline as wl
from wakeline import recording
from wakeline._engine.video import Cat240Encoder
from wakeline._units import KNOT_MPS
from wakeline.scenario import RadarVideoSimulator, Truth, VideoTarget
from wakeline.scenario.video import SeaClutter
from wakeline.tracking import Settings

from .config import InputConfig, LiveConfig, OutputConfig, OwnConfig, RadarConfig, SessionConfig

ORIGIN_DEG = (63.40, 10.40)
STATION_DEG = (63.50, 10.25)
TTM_PORT = 10111
_OWN_S, _AIS_S = 0.5, 6.0
_PIECES = 64  # of a revolution of the strait's radar
_MMSI = 257000001


class _Message(NamedTuple):
    """Octets for an input, and when they are sent."""

    at_s: float
    input: str
    octets: bytes


def demo_config(tracks: str, ttm_port: int = TTM_PORT) -> LiveConfig:
    """The settings of the demonstration; `tracks` is the file of JSON lines."""
    joyride = {
        key: value for key, value in recording.load("joyride").radar.items() if value is not None
    } | {"max_range_m": 6000.0}
    default = Settings.default()
    tracker = dict(default.tracker) | {"vessel_length_m": 120.0}  # of the longest, with two echoes
    return LiveConfig(
        settings=replace(default, tracker=tracker),
        inputs=(
            InputConfig("udp://127.0.0.1:0?name=boat", format="nmea"),
            InputConfig("udp://127.0.0.1:0?name=boat radar", format="json", radar="boat"),
            InputConfig("udp://127.0.0.1:0?name=ais", format="nmea"),
            InputConfig("udp://127.0.0.1:0?name=strait radar", format="cat240", radar="strait"),
        ),
        outputs=(
            OutputConfig(f"udp://127.0.0.1:{ttm_port}", format="ttm"),
            OutputConfig(f"file:{tracks}", format="json"),
        ),
        radars=(
            RadarConfig("boat", settings=joyride),
            RadarConfig("strait", position_deg=STATION_DEG, settings=_STRAIT_RADAR),
        ),
        own=OwnConfig(),
        session=SessionConfig(origin_deg=ORIGIN_DEG),
    )


_STRAIT_RADAR = {
    "range_std_m": 12.0,
    "bearing_std_deg": 0.5,
    "extent_std_m": 20.0,
    "period_s": 2.5,
    "max_speed_mps": 20.0,
    "max_range_m": 6144.0,
}


class DemoSender:
    """Sends the demonstration in a thread, in real time.

    Parameters
    ----------
    ports : dict of str to int
        Port of each input of :func:`demo_config`.
    """

    def __init__(self, ports: dict[str, int]) -> None:
        self._ports = ports
        self._ends = threading.Event()
        self._thread = threading.Thread(target=self._run, name="demo", daemon=True)

    @property
    def is_done(self) -> bool:
        """Whether all has been sent."""
        return not self._thread.is_alive()

    def start(self) -> None:
        self._thread.start()

    def close(self) -> None:
        """End the thread."""
        self._ends.set()
        self._thread.join(5.0)

    def _run(self) -> None:
        start_s = time.time()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
            for message in demo_messages(start_s):
                if self._ends.wait(max(start_s + message.at_s - time.time(), 0.0)):
                    return
                one.sendto(message.octets, ("127.0.0.1", self._ports[message.input]))


def demo_messages(start_s: float) -> Iterator[_Message]:
    """All messages in order of time; the session begins at `start_s`, UTC seconds."""
    streams = [_boat(start_s), _strait(start_s)]
    waiting = [(next(stream), stream) for stream in streams]
    while waiting:
        k = min(range(len(waiting)), key=lambda k: waiting[k][0].at_s)
        message, stream = waiting[k]
        yield message
        following = next(stream, None)
        if following is None:
            return
        waiting[k] = following, stream


def _boat(start_s: float) -> Iterator[_Message]:
    """Own ship and plots of the recording."""
    episode = recording.load("joyride").episodes[0]
    plane = _plane(ORIGIN_DEG)
    begin_s = float(episode.time_s[0])
    scans = iter(episode.scans)
    scan = next(scans)
    middle_m = episode.own.position_at(np.array([begin_s]))[0]
    for at_s in np.arange(0.0, float(episode.time_s[-1]) - begin_s, _OWN_S).tolist():
        now = np.array([begin_s + at_s])
        position_m = episode.own.position_at(now)[0] - middle_m
        velocity = episode.own.velocity_at(now)[0]
        heading_deg = math.degrees(math.atan2(velocity[1], velocity[0])) % 360.0
        hdt = _sentence("$", f"GPHDT,{heading_deg:.1f},T")
        fix = rmc(start_s + at_s, *_degrees(plane, position_m), velocity)
        yield _Message(at_s, "boat", fix + hdt)
        while scan is not None and scan.time_s - begin_s <= at_s + _OWN_S:
            yield from _scan(scan, scan.time_s - begin_s, start_s - begin_s)
            scan = next(scans, None)


def _scan(scan: wl.recording.Scan, at_s: float, later_s: float) -> Iterator[_Message]:
    rows = zip(scan.plot_time_s, scan.range_m, scan.bearing_rad, strict=True)
    lines = [
        {
            "radar": "boat",
            "time_s": float(when_s) + later_s,
            "range_m": float(range_m),
            "bearing_rad": float(bearing_rad),
        }
        for when_s, range_m, bearing_rad in rows
    ]
    turn = {"from_rad": 0.0, "to_rad": 2.0 * math.pi, "time_s": scan.time_s + later_s}
    lines.append({"radar": "boat", "sector": turn})
    octets = "".join(f"{json.dumps(line)}\n" for line in lines).encode()
    yield _Message(at_s, "boat radar", octets)


def _strait(start_s: float) -> Iterator[_Message]:
    """Video of the strait's radar, and AIS of its four vessels."""
    radar = RadarVideoSimulator(
        sweeps_per_turn=1024,
        cells=512,
        cell_m=12.0,
        period_s=_STRAIT_RADAR["period_s"],
        beam_width_rad=np.deg2rad(1.2),
        pulse_length_m=24.0,
        snr_db=22.0,
        sea=SeaClutter(clutter_to_noise_db=-3.0, decay=3.0, shape=1.0, correlation_m=60.0),
    )
    vessels = {
        "NORDLYS": ([-3200.0, 6.5, 1500.0, 0.4], 110.0),
        "HAVSULA": ([3900.0, -5.0, 2400.0, 1.0], 70.0),
        "KYSTVAKT 4": ([1200.0, 1.5, -3600.0, 8.0], 40.0),
        "ALBATROSS": ([-900.0, -3.0, -1800.0, -2.0], 25.0),
    }
    targets = {
        name: VideoTarget(
            truth=Truth(state), length_m=length_m, beam_m=length_m / 6.0, rcs_m2=0.15 * length_m**2
        )
        for name, (state, length_m) in vessels.items()
    }
    plane, encoder, next_ais_s = _plane(STATION_DEG), Cat240Encoder(25, 1), 0.0
    for turn in radar.turns(targets, 10_000, 0):
        for first in range(0, len(turn), len(turn) // _PIECES):
            piece = turn[first : first + len(turn) // _PIECES]
            at_s = float(piece.time_s[-1])
            for k in range(len(piece)):
                yield _Message(at_s, "strait radar", _encoded(encoder, piece[k : k + 1], start_s))
            if at_s >= next_ais_s:
                next_ais_s += _AIS_S
                yield from _ais(targets, plane, at_s, start_s)


def _encoded(encoder: Cat240Encoder, sweep: recording.RadarVideo, start_s: float) -> bytes:
    return encoder.encode(
        sweep.amplitude,
        sweep.azimuth_rad,
        (sweep.time_s + start_s) % 86400.0,
        azimuth_width_rad=sweep.azimuth_width_rad,
        start_range_m=sweep.start_range_m,
        cell_m=sweep.cell_m,
    )


def _ais(
    targets: dict[str, VideoTarget], plane: wl.LocalPlane, at_s: float, start_s: float
) -> Iterator[_Message]:
    """Positions and names of the vessels, with pyais; nothing without it."""
    try:
        import pyais
    except ModuleNotFoundError:
        return
    second_s = math.floor(start_s + at_s)
    for k, (name, target) in enumerate(targets.items()):
        state = target.truth.state_at(np.array([second_s - start_s]))[0]
        north, vnorth, east, veast = state.tolist()
        latitude, longitude = _degrees(plane, np.array([north, east]))
        course_deg = math.degrees(math.atan2(veast, vnorth)) % 360.0
        position = {
            "type": 1,
            "mmsi": _MMSI + k,
            "lat": latitude,
            "lon": longitude,
            "speed": math.hypot(vnorth, veast) / KNOT_MPS,
            "course": course_deg,
            "heading": round(course_deg) % 360,
            "accuracy": 1,
            "second": second_s % 60,
        }
        static = {"type": 5, "mmsi": _MMSI + k, "shipname": name, "ship_type": 70}
        for message in (position, static):
            for line in pyais.encode_dict(message):
                body = line[1 : line.rindex("*")].replace("VDO", "VDM", 1)
                yield _Message(at_s, "ais", _sentence("!", body))


def rmc(time_s: float, latitude_deg: float, longitude_deg: float, velocity: np.ndarray) -> bytes:
    """A sentence with position and velocity."""
    clock = time.gmtime(time_s)
    hundredths = int(time_s % 1.0 * 100.0)
    speed_kn = math.hypot(*velocity) / KNOT_MPS
    course_deg = math.degrees(math.atan2(velocity[1], velocity[0])) % 360.0
    body = (
        f"GPRMC,{time.strftime('%H%M%S', clock)}.{hundredths:02d},A,"
        f"{_packed(latitude_deg, 2)},{'N' if latitude_deg >= 0 else 'S'},"
        f"{_packed(longitude_deg, 3)},{'E' if longitude_deg >= 0 else 'W'},"
        f"{speed_kn:.2f},{course_deg:.1f},{time.strftime('%d%m%y', clock)},,,A"
    )
    return _sentence("$", body)


def _sentence(begin: str, body: str) -> bytes:
    return f"{begin}{body}*{reduce(xor, body.encode(), 0):02X}\r\n".encode()


def _packed(angle_deg: float, digits: int) -> str:
    """Degrees and minutes as in a sentence."""
    units = round(abs(angle_deg) * 60.0 * 1e5)
    degrees, minutes = divmod(units, 60 * 10**5)
    return f"{degrees:0{digits}d}{minutes // 10**5:02d}.{minutes % 10**5:05d}"


def _plane(place_deg: tuple[float, float]) -> wl.LocalPlane:
    return wl.LocalPlane(
        latitude_rad=math.radians(place_deg[0]), longitude_rad=math.radians(place_deg[1])
    )


def _degrees(plane: wl.LocalPlane, position_m: np.ndarray) -> tuple[float, float]:
    latitude_rad, longitude_rad = plane.place(position_m)
    return math.degrees(float(latitude_rad)), math.degrees(float(longitude_rad))
