"""Figures of a live session on this machine, by sending to it through the loopback."""

from __future__ import annotations

import json
import math
import os
import platform
import resource
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from wakeline._engine.video import Cat240Encoder

from .config import InputConfig, LiveConfig, OutputConfig, RadarConfig
from .network import NetworkOutput
from .service import Service
from .session import Session

SWEEPS, CELLS, PERIOD_S = 4096, 2048, 1.25
CELL_M = 6.0
_WIDTH_SWEEPS = 14  # of an echo
_PLACE_DEG = (54.0, 10.0)
_RADAR = {"period_s": PERIOD_S, "range_std_m": 5.0, "bearing_std_deg": 0.2, "max_speed_mps": 20.0}

Figure = dict[str, Any]


def figures(seconds: float = 20.0, hours: float = 24.0) -> Iterator[Figure]:
    """The figures one by one, each with its name, value, unit and limit."""
    yield from latency(seconds)
    yield from sector_latency()
    yield from four_radars(seconds)
    yield from many_tracks()
    yield from stalled_client()
    yield from long_session(hours)


def machine() -> str:
    """The machine in words."""
    model = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        names = [line for line in info.read_text().splitlines() if line.startswith("model name")]
        model = names[0].partition(":")[2].strip() if names else model
    return f"{model}, {os.cpu_count()} cores, Python {platform.python_version()}"


def _figure(name: str, value: float, unit: str, limit: float | None) -> Figure:
    return {"scenario": name, "estimator": "live", "value": value, "unit": unit, "limit": limit}


# ------------------------------------------------------------------ radar video


def sweeps_of_turn(echoes: int = 20, seed: int = 0) -> list[bytes]:
    """One turn of noise with echoes, a message for each sweep, without sequence and time."""
    rng = np.random.default_rng(seed)
    amplitude = rng.rayleigh(14.0, (SWEEPS, CELLS)).clip(0, 120).astype(np.uint8)
    for k in range(echoes):
        sweep = int((k + 0.5) * SWEEPS / echoes)
        cell = int(rng.integers(300, CELLS - 300))
        amplitude[sweep : sweep + _WIDTH_SWEEPS, cell : cell + 6] = 250
    azimuth_rad = (np.arange(SWEEPS) + 0.5) * 2.0 * np.pi / SWEEPS
    encoder = Cat240Encoder(1, 1)
    return [
        encoder.encode(
            amplitude[k : k + 1],
            azimuth_rad[k : k + 1],
            np.zeros(1),
            azimuth_width_rad=2.0 * np.pi / SWEEPS,
            start_range_m=0.0,
            cell_m=CELL_M,
        )
        for k in range(SWEEPS)
    ]


def send_video(port: int, seconds: float) -> None:
    """Send video in real time, from a process of its own; prints the number of sweeps."""
    turn = sweeps_of_turn()
    sequence_at, time_at = _places(turn)
    step_s, begin_s, sent = PERIOD_S / SWEEPS, time.time(), 0
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4 << 20)
        one.connect(("127.0.0.1", port))
        while (now_s := time.time()) < begin_s + seconds:
            due = int((now_s - begin_s) / step_s)
            for k in range(sent, due):
                message = bytearray(turn[k % SWEEPS])
                message[sequence_at : sequence_at + 4] = (k & 0xFFFFFFFF).to_bytes(4, "big")
                of_day = int((begin_s + k * step_s) % 86400.0 * 128.0) & 0xFFFFFF
                message[time_at : time_at + 3] = of_day.to_bytes(3, "big")
                one.send(message)
            sent = max(sent, due)
            time.sleep(0.002)
    print(sent)


def _places(turn: list[bytes]) -> tuple[int, int]:
    """Where a message has its sequence number and its time of day."""
    sequence = next(
        at
        for at in range(4, 40)
        if all(turn[k][at : at + 4] == k.to_bytes(4, "big") for k in (1, 77, 3000))
        or all(turn[k][at : at + 4] == (k + 1).to_bytes(4, "big") for k in (1, 77, 3000))
    )
    return sequence, len(turn[0]) - 3


def _senders(ports: list[int], seconds: float) -> list[subprocess.Popen]:
    code = "import sys; from wakeline.live.benchmark import send_video; "
    code += "send_video(int(sys.argv[1]), float(sys.argv[2]))"
    return [
        subprocess.Popen(
            [sys.executable, "-c", code, str(port), str(seconds)], stdout=subprocess.PIPE
        )
        for port in ports
    ]


def latency(seconds: float) -> Iterator[Figure]:
    """From the last sweep through an echo to its track on the wire."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(0.2)
        config = _one_radar(receiver, "cat240")
        late_s: list[float] = []
        ends = threading.Event()
        thread = threading.Thread(target=_receive, args=(receiver, late_s, ends))
        thread.start()
        _, _ = _run_video(config, max(seconds, 12.0))
        ends.set()
        thread.join()
    late_ms = 1e3 * np.array(late_s or [math.inf])
    yield _figure("last sweep to track, median", float(np.median(late_ms)), "ms", 50.0)
    yield _figure("last sweep to track, 99.9 %", float(np.quantile(late_ms, 0.999)), "ms", 150.0)


def _one_radar(receiver: socket.socket, radar_format: str) -> LiveConfig:
    """One radar at an input, and JSON lines to a receiver."""
    return LiveConfig(
        inputs=(InputConfig("udp://127.0.0.1:0?name=radar", format=radar_format),),
        outputs=(OutputConfig(f"udp://127.0.0.1:{receiver.getsockname()[1]}", format="json"),),
        radars=(RadarConfig("A", position_deg=_PLACE_DEG, settings=_RADAR),),
    )


def _lines(receiver: socket.socket, ends: threading.Event) -> Iterator[dict[str, Any]]:
    """The JSON lines that arrive until the event is set."""
    while not ends.is_set():
        try:
            yield json.loads(receiver.recv(1 << 16))
        except TimeoutError:
            continue


def _receive(receiver: socket.socket, late_s: list[float], ends: threading.Event) -> None:
    width_s = 0.5 * _WIDTH_SWEEPS * PERIOD_S / SWEEPS
    for line in _lines(receiver, ends):
        if line["type"] == "track" and line["misses"] == 0:
            late_s.append(time.time() - line["time_s"] - width_s)


def sector_latency(turns: int = 16, targets: int = 20) -> Iterator[Figure]:
    """From the message that ends a sector of category 048 to the tracks in it on the wire."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(0.2)
        service = Service(Session(_one_radar(receiver, "cat048")))
        thread = threading.Thread(target=service.run)
        thread.start()
        sent: dict[float, float] = {}
        late_s: list[float] = []
        ends = threading.Event()
        hearing = threading.Thread(target=_receive_sectors, args=(receiver, sent, late_s, ends))
        hearing.start()
        _send_sectors(service.inputs[0].port, turns, targets, sent)
        time.sleep(0.3)
        ends.set()
        hearing.join()
        service.stop()
        thread.join()
    late_ms = 1e3 * np.array(late_s or [math.inf])
    yield _figure("sector of plots to track, median", float(np.median(late_ms)), "ms", 20.0)


def _send_sectors(port: int, turns: int, targets: int, sent: dict[float, float]) -> None:
    bearing_rad = (np.arange(targets) + 0.5) * 2.0 * np.pi / targets
    begin_s = time.time()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.connect(("127.0.0.1", port))
        for k in range(turns * 32):
            due_s = begin_s + PERIOD_S * k / 32.0
            time.sleep(max(due_s - time.time(), 0.0))
            edge = k % 32
            inside = (32.0 * bearing_rad / (2.0 * np.pi)).astype(int) == (edge - 1) % 32
            ticks = round(due_s % 86400.0 * 128.0)
            of_day = ticks.to_bytes(3, "big")
            for bearing in bearing_rad[inside].tolist():
                polar = struct.pack(">HH", 500, round(bearing / (2.0 * math.pi) * 65536.0))
                one.send(_block(48, b"\xf0\x01\x01" + of_day + b"\x20" + polar))
            one.send(_block(34, b"\xf0\x01\x01\x02" + of_day + bytes([8 * edge])))
            sent[ticks] = time.time()


def _block(category: int, record: bytes) -> bytes:
    return bytes([category]) + (len(record) + 3).to_bytes(2, "big") + record


def _receive_sectors(
    receiver: socket.socket, sent: dict[float, float], late_s: list[float], ends: threading.Event
) -> None:
    for line in _lines(receiver, ends):
        began_s = sent.get(round(line.get("time_s", 0.0) % 86400.0 * 128.0))
        if line["type"] == "track" and began_s is not None:
            late_s.append(time.time() - began_s)


def four_radars(seconds: float) -> Iterator[Figure]:
    """Four radars of 4096 sweeps of 2048 cells, 48 turns a minute: losses and processor."""
    names = "ABCD"
    config = LiveConfig(
        inputs=tuple(
            InputConfig(f"udp://127.0.0.1:0?name={name}", format="cat240", radar=name)
            for name in names
        ),
        radars=tuple(
            RadarConfig(name, position_deg=(54.0 + 0.2 * k, 10.0), settings=_RADAR)
            for k, name in enumerate(names)
        ),
    )
    session, share = _run_video(config, seconds)
    inputs = session.status()["inputs"].values()
    lost = sum(one["lost_sweeps"] for one in inputs)
    octets = sum(one["octets"] for one in inputs)
    yield _figure("four radars, sweeps lost", float(lost), "sweeps", 0.0)
    yield _figure("four radars, received", octets / seconds / 1e6, "MB/s", None)
    yield _figure("four radars, processor", 100.0 * share, "% of a core", 100.0)


def _run_video(config: LiveConfig, seconds: float) -> tuple[Session, float]:
    """A session that receives video for some time, and its share of a core."""
    session = Session(config)
    service = Service(session)
    thread = threading.Thread(target=service.run)
    thread.start()
    senders = _senders([one.port for one in service.inputs], seconds)
    while session.time_s == -math.inf or not any(
        one.rate.octets for one in session.inputs.values()
    ):
        time.sleep(0.05)
    began_s, cpu_s = time.monotonic(), time.process_time()
    for one in senders:
        one.communicate()
    share = (time.process_time() - cpu_s) / (time.monotonic() - began_s)
    time.sleep(0.3)
    service.stop()
    thread.join()
    return session, share


# ------------------------------------------------------------------ tracks and outputs


def many_tracks(tracks: int = 1000, false_plots: int = 400, turns: int = 40) -> Iterator[Figure]:
    """1000 tracks and 1400 plots a turn with every output: share of a core at 48 turns a minute."""
    formats = ("json", "ttm", "cat062", "cat010")
    config = LiveConfig(
        outputs=tuple(
            OutputConfig(f"udp://127.0.0.1:9?name={kind}", format=kind) for kind in formats
        ),
        radars=(RadarConfig("A", position_deg=_PLACE_DEG, settings=_RADAR),),
    )
    settings = config.settings
    more = settings.tracker | {"max_tracks": 4000, "max_plots": 4000}
    danger = settings.danger | {"cpa_limit_m": 100.0}  # of vessels 500 m apart
    session = Session(replace(config, settings=replace(settings, tracker=more, danger=danger)))
    rng = np.random.default_rng(0)
    side = math.ceil(math.sqrt(tracks))
    place_m = 500.0 * np.stack(np.divmod(np.arange(tracks), side), axis=1) + 2000.0
    velocity = rng.uniform(-6.0, 6.0, (tracks, 2))
    cpu_s = 0.0
    for k in range(turns):
        t = PERIOD_S * k
        position = place_m + velocity * t
        clutter = rng.uniform(2000.0, 2000.0 + 500.0 * side, (false_plots, 2))
        seen = np.concatenate([position, clutter])
        range_m = np.hypot(*seen.T) + rng.normal(0.0, 5.0, len(seen))
        bearing_rad = np.arctan2(seen[:, 1], seen[:, 0]) + rng.normal(0.0, 0.0035, len(seen))
        lines = _turn_of_lines(t, range_m, bearing_rad)
        began_s = time.process_time()
        for when_s, line in lines:
            session.feed(when_s, "plots", line)
        if k >= turns // 2:
            cpu_s += time.process_time() - began_s
    share = cpu_s / (PERIOD_S * (turns - turns // 2))
    shown = len(session.tracker.tracks())
    yield _figure("1000 tracks with every output, tracks", float(shown), "tracks", None)
    yield _figure("1000 tracks with every output, processor", 100.0 * share, "% of a core", 10.0)


def _turn_of_lines(
    t: float, range_m: np.ndarray, bearing_rad: np.ndarray
) -> list[tuple[float, bytes]]:
    """A turn as 32 messages, with their times, of plots and the mark of their sector."""
    bearing_rad = bearing_rad % (2.0 * np.pi)
    order = np.argsort(bearing_rad)
    edges = np.linspace(0.0, 2.0 * np.pi, 33)
    cuts = np.searchsorted(bearing_rad[order], edges)
    messages = []
    for k in range(32):
        when_s = t + PERIOD_S * (k + 1) / 32.0
        rows = order[cuts[k] : cuts[k + 1]]
        plots = [
            f'{{"time_s":{when_s},"range_m":{r},"bearing_rad":{b}}}\n'
            for r, b in zip(range_m[rows].tolist(), bearing_rad[rows].tolist(), strict=True)
        ]
        mark = {"from_rad": edges[k], "to_rad": edges[k + 1], "time_s": when_s}
        messages.append((when_s, "".join([*plots, json.dumps({"sector": mark})]).encode()))
    return messages


def stalled_client(messages: int = 3000) -> Iterator[Figure]:
    """A client that connects and never reads, beside one that does."""
    output = NetworkOutput(OutputConfig("tcp-listen://127.0.0.1:0"))
    output.start()
    stalled = socket.create_connection(("127.0.0.1", output.port))
    reader = socket.create_connection(("127.0.0.1", output.port))
    thread = threading.Thread(target=_drain, args=(reader,))
    thread.start()
    while "2 connected" not in output.connection:
        time.sleep(0.01)
    before, longest_s, octets = _resident(), 0.0, bytes(8192)
    for _ in range(messages):
        began_s = time.perf_counter()
        output.send(octets)
        longest_s = max(longest_s, time.perf_counter() - began_s)
        time.sleep(0.0005)
    grown = _resident() - before
    output.close()
    output.join()
    stalled.close()
    reader.close()
    thread.join()
    yield _figure("a client that does not read, memory", max(grown, 0) / 1e6, "MB", 8.0)
    yield _figure("a client that does not read, longest send", 1e3 * longest_s, "ms", 1.0)


def _drain(one: socket.socket) -> None:
    try:
        while one.recv(1 << 16):
            pass
    except OSError:
        pass


def long_session(hours: float) -> Iterator[Figure]:
    """Memory after a day against that after its first tenth, fed as fast as it goes."""
    config = LiveConfig(radars=(RadarConfig("A", position_deg=_PLACE_DEG, settings=_RADAR),))
    session = Session(config)
    session.add_output("file:x")
    rng = np.random.default_rng(0)
    turns = int(3600.0 * hours / PERIOD_S)
    early = 0
    began_s = time.monotonic()
    bearing = np.linspace(0.2, 6.0, 20)
    for k in range(turns):
        t = PERIOD_S * k
        range_m = 3000.0 + 1500.0 * np.sin(t / 600.0 + bearing) + rng.normal(0.0, 5.0, 20)
        plots = "".join(
            f'{{"time_s":{t},"range_m":{r},"bearing_rad":{b}}}\n'
            for r, b in zip(range_m.tolist(), bearing.tolist(), strict=True)
        )
        mark = json.dumps({"sector": {"from_rad": 0.0, "to_rad": 2.0 * math.pi, "time_s": t}})
        session.feed(t, "plots", (plots + mark).encode())
        if k == turns // 10:
            early = _resident()
    speed = 3600.0 * hours / (time.monotonic() - began_s)
    name = f"{hours:g} h of a session"
    yield _figure(f"{name}, growth of memory", max(_resident() - early, 0) / 1e6, "MB", 5.0)
    yield _figure(f"{name}, speed", speed, "times real time", None)


def _resident() -> int:
    """Octets of this process in memory."""
    statm = Path("/proc/self/statm")
    if statm.exists():
        return int(statm.read_text().split()[1]) * resource.getpagesize()
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def table(rows: list[Figure]) -> str:
    """The figures as text."""
    lines = [machine()]
    for row in rows:
        limit = row["limit"]
        verdict = "" if limit is None else f"at most {limit:g}: "
        if limit is not None:
            verdict += "met" if row["value"] <= limit else "not met"
        lines.append(f"{row['scenario']:<48}{row['value']:>10.3g} {row['unit']:<16}{verdict}")
    return "\n".join(lines)
