"""A live session on the loopback: sockets, session files, replay, restart."""

import asyncio
import errno
import json
import math
import os
import random
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from dataclasses import replace

import pytest
from aiohttp import web

import wakeline as wl
from harbor import RANGE_M, Harbor
from test_cli_navigate import sentence as sentence_of
from test_live import written
from test_recording_containers import ipv4, tcp
from wakeline.cli import main
from wakeline.live import network
from wakeline.live.config import (
    InputConfig,
    LiveConfig,
    OutputConfig,
    OwnConfig,
    RadarConfig,
    SessionConfig,
)
from wakeline.live.network import NetworkInput, NetworkOutput, _Clock
from wakeline.live.record import Recorder, at_microsecond, read_session, segments_of
from wakeline.live.service import Service, feed_record, replay
from wakeline.live.web import WebServer
from wakeline.recording import RecordingError
from wakeline.tracking.settings import Settings

SMALL = {
    "radar": [{"name": "A", "position_deg": [54.0, 10.0], "period_s": 2.0}],
    "tracker": {"max_tracks": 20, "max_plots": 200},
}
ASHORE = RadarConfig("A", position_deg=(54.0, 10.0), settings={"period_s": 2.0})


def turn(k, begin_s, period_s=2.0):
    """The lines of one turn with two vessels."""
    t = begin_s + period_s * k
    plots = [
        {"time_s": t, "range_m": 2000.0 - 2.0 * period_s * k, "bearing_rad": 0.7},
        {"time_s": t, "range_m": 1500.0 + 5.0 * period_s * k, "bearing_rad": 3.9},
    ]
    mark = {"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}}
    return t, "".join(f"{json.dumps(line)}\n" for line in [*plots, mark]).encode()


def until(condition, within_s=5.0):
    end_s = time.monotonic() + within_s
    while not condition():
        assert time.monotonic() < end_s, "nothing happened in time"
        time.sleep(0.01)


@pytest.fixture
def taken():
    class Taken(list):
        def __call__(self, name, messages):
            self.extend((name, octets) for _, octets in messages)

        @property
        def octets(self):
            return b"".join(octets for _, octets in self)

    return Taken()


def opened(url, taken):
    one = NetworkInput(LiveConfig(inputs=(InputConfig(url),)).inputs[0], taken)
    one.start()
    return one


# ------------------------------------------------------------------ inputs and outputs


def test_udp_unicast(taken):
    one = opened("udp://127.0.0.1:0", taken)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for k in range(5):
            sender.sendto(b"%d" % k, ("127.0.0.1", one.port))
    until(lambda: taken.octets == b"01234")
    one.close()


def test_udp_multicast_on_the_interface(taken):
    one = opened("udp://239.192.0.21:0?iface=127.0.0.1", taken)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        loopback = socket.inet_aton("127.0.0.1")
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, loopback)
        sender.sendto(b"x", ("239.192.0.21", one.port))
    until(lambda: taken.octets == b"x")
    one.close()


@pytest.mark.parametrize("host", ["127.0.0.1", "0.0.0.0", "239.192.0.21", "127.255.255.255"])
def test_only_what_every_receiver_has_a_copy_of_is_shared(host, taken):
    one = opened(f"udp://{host}:0?iface=127.0.0.1", taken)
    again = f"udp://{host}:{one.port}?iface=127.0.0.1"
    if host in ("127.0.0.1", "0.0.0.0"):
        with pytest.raises(OSError, match="in use"):
            NetworkInput(InputConfig(again), taken)
    else:
        other = opened(again, taken)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            loopback = socket.inet_aton("127.0.0.1")
            sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, loopback)
            sender.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
            sender.sendto(b"x", (host, one.port))
        until(lambda: taken.octets == b"xx")
        other.close()
    one.close()


def test_a_tcp_client_connects_again(taken):
    with socket.create_server(("127.0.0.1", 0)) as server:
        one = opened(f"tcp://127.0.0.1:{server.getsockname()[1]}", taken)
        for octets in (b"a", b"b"):
            peer, _ = server.accept()
            peer.sendall(octets)
            until(lambda octets=octets: taken.octets.endswith(octets))
            peer.close()
        one.close()
    assert one.restarts >= 1


class SignalkServer:
    """Sends a delta to each client that has subscribed, and closes the stream."""

    DELTA = '{"context":"vessels.self","updates":[]}'

    def __enter__(self):
        self.port, self._loop = free_port(), asyncio.new_event_loop()
        self.asked, ready = [], threading.Event()
        self._thread = threading.Thread(target=self._run, args=(ready,))
        self._thread.start()
        assert ready.wait(5.0)
        return self

    def __exit__(self, *_):
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()

    def _run(self, ready):
        app = web.Application()
        app.add_routes([web.get("/signalk/v1/stream", self._stream)])
        runner = web.AppRunner(app)
        self._loop.run_until_complete(runner.setup())
        self._loop.run_until_complete(web.TCPSite(runner, "127.0.0.1", self.port).start())
        ready.set()
        self._loop.run_forever()
        self._loop.run_until_complete(runner.cleanup())
        self._loop.close()

    async def _stream(self, request):
        stream = web.WebSocketResponse()
        await stream.prepare(request)
        self.asked.append(await stream.receive_json())
        await stream.send_str(self.DELTA)
        await stream.close()
        return stream


def test_a_signal_k_server_is_subscribed_to_and_connected_again(taken):
    with SignalkServer() as server:
        one = opened(f"signalk://127.0.0.1:{server.port}", taken)
        until(lambda: len(taken) >= 2)
        one.close()
        one.join()
    assert {octets for _, octets in taken} == {SignalkServer.DELTA.encode()}
    assert all(wanted["subscribe"] for wanted in server.asked)
    assert one.restarts >= 1


def test_spokes_of_a_radar_server_are_the_sweeps_that_it_shows():
    """The server is ours, and knows its spokes only after the first sweep."""
    harbor, seen = Harbor(), []
    with WebServer(harbor, port=0) as server:
        url = f"signalk://127.0.0.1:{server.app.port}/radars/A?name=spokes"
        session = wl.live.Session({"input": [{"url": url}]})
        session.sweeps.append(lambda *sweeps: seen.append(sweeps))
        service = Service(session)
        thread = threading.Thread(target=service.run)
        thread.start()
        until(lambda: "no spokes yet" in service.inputs[0].connection)
        end_s = time.monotonic() + 10.0
        while len(seen) < 2 and time.monotonic() < end_s:
            harbor.sweep()
            time.sleep(0.1)
        service.stop()
        thread.join()
    assert session.status()["inputs"]["spokes"]["problems"] == {}
    assert {(radar, range_m) for radar, _, _, range_m, _ in seen} == {("A", RANGE_M)}
    assert max(cells.max() for *_, cells in seen) > 0


def test_standard_input_is_read_to_its_end(tmp_path):
    radar = '[[radar]]\nname = "A"\nposition_deg = [54, 10]\nperiod_s = 0.2\n'
    (tmp_path / "live.toml").write_text(radar)
    command = [sys.executable, "-m", "wakeline", "live", "live.toml", "--in", "stdin:"]
    begin_s = time.time()
    lines = b"".join(turn(k, begin_s, 0.2)[1] for k in range(12))
    done = subprocess.run(
        [*command, "--out", "file:tracks.jsonl", "--quiet"],
        input=lines,
        cwd=tmp_path,
        timeout=60.0,
        check=False,
    )
    assert done.returncode == 0
    assert '"type":"track"' in read_tracks(tmp_path)


def test_a_tcp_server_tells_its_clients_apart(taken):
    one = opened("tcp-listen://127.0.0.1:0?name=in", taken)
    clients = [socket.create_connection(("127.0.0.1", one.port)) for _ in range(2)]
    for k, client in enumerate(clients):
        client.sendall(b"%d" % k)
    until(lambda: len(taken) == 2)
    assert len({name for name, _ in taken}) == 2
    assert all(name.startswith("in from 127.0.0.1:") for name, _ in taken)
    for client in clients:
        client.close()
    one.close()


def test_files_and_captures_end(taken, tmp_path):
    path = tmp_path / "x.nmea"
    path.write_bytes(b"$GPGGA\r\n")
    one = opened(f"file:{path}", taken)
    until(lambda: one.is_done)
    assert taken.octets == b"$GPGGA\r\n"
    other_clock = b'{"time_s": 1.7e9, "own": {}}'
    lines = [b'{"time_s": %.2f, "range_m": 1.0}' % (50.0 + 0.25 * k) for k in range(5)]
    octets = b"\n".join([b'{"own": {}}', other_clock, *lines])
    path.write_bytes(octets)
    began_s, before = time.monotonic(), len(taken.octets)
    one = opened(f"file:{path}", taken)
    until(lambda: one.is_done)
    assert time.monotonic() - began_s > 0.9  # JSON lines are as far apart as their times
    assert taken.octets[before:] == octets + b"\n"
    capture = tmp_path / "x.pcap"
    recorder = Recorder(capture, {})
    recorder.data(1.0, "a", "udp://127.0.0.1:5", b"datagram")
    recorder.close()
    one = opened(f"pcap:{capture}", taken)
    until(lambda: one.is_done)
    assert taken[-1][1] == b"datagram"


def test_a_connection_in_a_capture_is_a_stream(taken, tmp_path):
    """Segments cut lines, two change places, one comes twice and one was not recorded."""
    lines = [sentence_of(f"GPGLL,5400.{k:03},N,01000.000,E,,A").encode() for k in range(40)]
    stream = b"".join(line + b"\r\n" for line in lines)
    segments = [(at, stream[at : at + 27]) for at in range(0, len(stream), 27)]
    segments[5], segments[6] = segments[6], segments[5]
    segments.insert(9, segments[8])
    (lost,) = segments[-8:-7]
    segments.remove(lost)
    capture = struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, 101)
    for at, part in segments:
        (frame,) = ipv4(tcp(part, 1000 + at), 6)
        capture += struct.pack("<4I", 0, 0, len(frame), len(frame)) + frame
    path = tmp_path / "x.pcap"
    path.write_bytes(capture)
    one = opened(f"pcap:{path}", taken)
    until(lambda: one.is_done)
    assert taken.octets == stream[: lost[0]] + stream[lost[0] + len(lost[1]) :]
    session = wl.live.Session({"input": [{"url": f"pcap:{path}"}]})
    for name, octets in taken:
        session.feed(0.0, name, octets)
    (status,) = (one for one in session.status()["inputs"].values() if one["messages"])
    (fixes,) = session.status()["own"]["position"]["sources"]
    assert 36 <= fixes["count"] < 40
    assert sum(status["problems"].values()) > 0


def test_a_serial_line(taken):
    serial = pytest.importorskip("serial")
    assert serial
    controller, line = os.openpty()
    one = opened(f"serial:{os.ttyname(line)}?baud=38400", taken)
    until(lambda: "baud" in one.connection)
    os.write(controller, b"$GPHDT,1.0,T*07\r\n")
    until(lambda: b"HDT" in taken.octets)
    one.close()
    one.join()
    os.close(controller)
    os.close(line)


def test_an_output_serves_clients_and_drops_for_one_that_does_not_read():
    one = NetworkOutput(OutputConfig("tcp-listen://127.0.0.1:0"))
    one.start()
    stalled = socket.create_connection(("127.0.0.1", one.port))
    reader = socket.create_connection(("127.0.0.1", one.port))
    got = []
    thread = threading.Thread(target=lambda: got.extend(iter(lambda: reader.recv(1 << 16), b"")))
    thread.start()
    until(lambda: "2 connected" in one.connection)
    longest_s = 0.0
    for k in range(300):
        began_s = time.perf_counter()
        one.send(b"%06d" % k + b"x" * 65536)
        longest_s = max(longest_s, time.perf_counter() - began_s)
        time.sleep(0.002)
    until(lambda: one.dropped > 0)
    assert longest_s < 0.05
    until(lambda: b"".join(got)[-65536 - 6 :].startswith(b"000299"))
    one.close()
    one.join()
    stalled.close()
    thread.join(5.0)
    reader.close()


def test_a_peer_that_appears_has_only_what_comes_from_then_on():
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        one = NetworkOutput(OutputConfig(f"tcp://127.0.0.1:{server.getsockname()[1]}"))
        for k in range(3):
            one.send(b"old%d" % k)
        one.start()
        until(lambda: one.is_failing)
        server.listen(1)
        peer, _ = server.accept()
        until(lambda: one.dropped == 3)
        one.send(b"new")
        assert peer.recv(99) == b"new"
    one.close()
    one.join()
    peer.close()


@pytest.mark.parametrize("scheme", ["tcp", "tcp-listen"])
def test_what_a_peer_does_not_read_in_time_is_dropped(scheme, monkeypatch):
    """But for some octets of the system; a file has all."""
    monkeypatch.setattr(network, "_LONGEST_WAIT_S", 0.2)
    with socket.socket() as server:
        server.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        server.bind(("127.0.0.1", 0))
        server.listen(1)
        port = server.getsockname()[1] if scheme == "tcp" else 0
        one = NetworkOutput(OutputConfig(f"{scheme}://127.0.0.1:{port}"))
        one.start()
        if scheme == "tcp":
            peer, _ = server.accept()
        else:
            peer = socket.socket()
            peer.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            peer.connect(("127.0.0.1", one.port))
        until(lambda: "connected" in one.connection and "0 connected" not in one.connection)
        for k in range(5000):
            one.send(b"%079d\n" % k)
        time.sleep(0.4)
        one.send(b"%079d\n" % 5000)
        got = b""
        until(lambda: one.sent + one.dropped >= 5001 and one.dropped > 4000)
        while not got.endswith(b"5000\n"):
            got += peer.recv(1 << 16)
        assert got.count(b"\n") < 200
        assert all(len(line) == 79 for line in got.splitlines())
    one.close()
    one.join()
    peer.close()


def test_a_file_has_all(tmp_path, monkeypatch):
    monkeypatch.setattr(network, "_LONGEST_WAIT_S", 0.0)
    one = NetworkOutput(OutputConfig(f"file:{tmp_path / 'f'}"))
    lines = [b"%0999d\n" % k for k in range(3000)]
    for line in lines:
        one.send(line)
    time.sleep(0.01)
    one.start()
    until(lambda: one.sent == len(lines))
    one.close()
    one.join()
    assert (tmp_path / "f").read_bytes() == b"".join(lines)


def test_the_clock_does_not_go_back(monkeypatch):
    clock, machine = _Clock(), {"wall": time.time(), "up": time.monotonic()}
    monkeypatch.setattr(time, "time", lambda: machine["wall"])
    monkeypatch.setattr(time, "monotonic", lambda: machine["up"])
    before = clock()
    machine["wall"] -= 3 * 3600.0
    machine["up"] += 1.0
    assert clock() == pytest.approx(before + 1.0)
    machine["wall"] += 6 * 3600.0
    assert clock() == machine["wall"]


def test_a_flood_is_dropped_and_counted():
    service = Service(wl.live.Session())
    for _ in range(3000):
        service.take("x", [(0.0, bytes(60000))])
    assert 0 < service.lost < 3000
    service.close()
    assert service.session.status()["lost_batches"] == service.lost


# ------------------------------------------------------------------ sessions


def run_demo_like(record, turns, begin_s):
    """A service that is sent some turns by UDP; its session and the lines it wrote."""
    config = LiveConfig(inputs=(InputConfig("udp://127.0.0.1:0?name=in"),), radars=(ASHORE,))
    session = wl.live.Session(config)
    lines, service = written(session), Service(session, record)
    thread = threading.Thread(target=service.run)
    thread.start()
    port = service.inputs[0].port
    before = session.feeds["A"].sectors
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for k in turns:
            sender.sendto(turn(k, begin_s)[1], ("127.0.0.1", port))
            time.sleep(0.01)
    until(lambda: session.feeds["A"].sectors >= before + len(turns))
    service.stop()
    thread.join(10.0)
    return session, lines


def replayed(path, speed=math.inf):
    session = wl.live.Session(LiveConfig(radars=(ASHORE,)))
    lines = written(session)
    for record in replay(path, speed):
        feed_record(session, record)
    return session, lines


def test_a_session_replays_bit_for_bit_and_goes_on_with_the_same_numbers(tmp_path):
    path = tmp_path / "s.pcap"
    begin_s = time.time()
    first, lines = run_demo_like(path, range(12), begin_s)
    assert len(first.tracker.tracks()) == 2
    assert replayed(path)[1] == lines
    numbers = {one.track_id for one in first.tracker.tracks()}
    again, more = run_demo_like(path, range(12, 16), begin_s)
    assert {one.track_id for one in again.tracker.tracks()} == numbers
    assert replayed(path)[1][-len(more) :] == more


def fed(path, arrivals, **limits):
    """The session of a service without network, and its lines."""
    config = LiveConfig(radars=(ASHORE,), session=SessionConfig(**limits))
    service = Service(wl.live.Session(config), path)
    lines = written(service.session)
    service._begin()
    for t, octets in arrivals:
        service._feed("x", [(t, octets)])
    service.close()
    return service.session, lines


@pytest.mark.parametrize("speed", [1.0, 10.0, math.inf])
def test_a_replay_at_any_speed_gives_the_same_lines(tmp_path, speed):
    path, begin_s = tmp_path / "s.pcap", time.time() + 0.5
    length_s = 1.2
    arrivals = [(begin_s + length_s * k / 24.0, turn(k, begin_s, 0.05)[1]) for k in range(25)]
    _, lines = fed(path, arrivals)
    began_s = time.monotonic()
    assert replayed(path, speed)[1] == lines != []
    took_s = time.monotonic() - began_s
    assert took_s > 0.95 * length_s / speed


@pytest.mark.parametrize("speed", [math.inf, 50.0])
def test_a_replay_ends_when_it_is_stopped(tmp_path, speed):
    path, ends = tmp_path / "s.pcap", threading.Event()
    run_demo_like(path, range(5), time.time())
    records = replay(path, speed, ends)
    next(records)
    ends.set()
    assert list(records) == []


def test_a_session_that_is_stopped_while_it_reads_its_record_leaves_it_as_it_is(tmp_path):
    path = tmp_path / "s.pcap"
    run_demo_like(path, range(5), time.time())
    octets = path.read_bytes()
    service = Service(wl.live.Session(LiveConfig(radars=(ASHORE,))), path)
    service.stop()
    service.run()
    assert path.read_bytes() == octets


def test_a_session_ends_in_time_whenever_its_status_is_printed(tmp_path):
    settings = tmp_path / "live.toml"
    settings.write_text("[session]\nstatus_s = 60\n")
    began_s = time.monotonic()
    assert main(["live", str(settings), "--in", "udp://127.0.0.1:0", "--for", "0.2"]) == 0
    assert time.monotonic() - began_s < 3.0


def test_late_data_and_segments_replay_bit_for_bit(tmp_path):
    path, rng, begin_s = tmp_path / "s.pcap", random.Random(2), time.time()
    turns = [turn(k, begin_s) for k in range(100)]
    arrivals = sorted((t + 4.0 * rng.random(), octets) for t, octets in turns)
    session, lines = fed(path, arrivals, segment_mb=0.01)
    assert len(segments_of(path)) > 2
    assert session.status()["late"]["late_inputs"] >= 10
    again, repeated = replayed(path)
    assert repeated == lines
    assert repr(again.tracker.tracks()) == repr(session.tracker.tracks())


def survivor(path, pieces, acknowledge):
    """Continue a session with what it has not received; to be killed."""
    service = Service(wl.live.Session(SMALL), path)
    service._begin()
    known = service.session.inputs.get("x")
    for t, octets in pieces[known.rate.messages if known else 0 :]:
        service._feed("x", [(t, octets)])
        os.write(acknowledge, b".")
    signal.pause()


def killed_after(path, pieces, count, moment_s):
    """Kill a survivor in another process a moment after so many pieces; how many it has taken."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            survivor(path, pieces, writing)
        finally:
            os._exit(1)
    os.close(writing)
    taken = 0
    while taken < count:
        taken += len(os.read(reading, count))
    time.sleep(moment_s)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    with os.fdopen(reading, "rb") as rest:
        return taken + len(rest.read())


def test_a_session_killed_at_20_moments_loses_at_most_the_last_record_of_each(tmp_path):
    path, rng, begin_s = tmp_path / "s.pcap", random.Random(7), time.time()
    pieces = [
        (t, line + b"\n")
        for t, octets in (turn(k, begin_s) for k in range(400))
        for line in octets.splitlines()
    ]
    kept = 0
    for _ in range(20):
        taken = killed_after(path, pieces, rng.randrange(1, 12), rng.uniform(0.0, 0.003))
        records = [record for record in read_session(path) if record.values is None]
        assert kept + taken <= len(records) <= kept + taken + 1
        assert [record.octets for record in records] == [line for _, line in pieces[: len(records)]]
        kept = len(records)
    assert kept > 40
    whole, again = wl.live.Session(SMALL), wl.live.Session(SMALL)
    for t, octets in pieces[:kept]:
        whole.feed(at_microsecond(t), "x", octets)
    for record in read_session(path):
        feed_record(again, record)
    assert len(again.tracker.tracks()) == 2
    assert repr(again.tracker.tracks()) == repr(whole.tracker.tracks())


def test_what_operators_did_is_replayed(tmp_path):
    path = tmp_path / "s.pcap"
    session = wl.live.Session(LiveConfig(radars=(ASHORE,)))
    service = Service(session, path)
    service._begin()
    for k in range(8):
        t, octets = turn(k, 1000.0)
        service._feed("x", [(t, octets)])
    number = session.tracker.tracks()[0].track_id
    assert session.command({"command": "rename", "track_id": number, "name": "ferry"})["ok"]
    service.close()
    again, _ = replayed(path)
    assert {one.track_id: one.name for one in again.tracker.tracks()}[number] == "ferry"


def test_what_is_no_file_is_not_recorded_to_and_stays(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path in (pipe, tmp_path):
        with pytest.raises(OSError, match="not a file"):
            Service(wl.live.Session({}), path).run()
        assert path.exists()


def test_a_second_session_does_not_record_to_the_same_file(tmp_path):
    path = tmp_path / "s.pcap"
    limits = SessionConfig(segment_mb=0.01, most_mb=0.03)
    config = LiveConfig(radars=(ASHORE,), session=limits)
    first = Service(wl.live.Session(config), path)
    first._begin()
    for k in range(120):
        t, octets = turn(k, time.time())
        first._feed("x", [(t, octets)])
        if k in (0, 119):  # its first segment is there, and removed
            with pytest.raises(OSError, match=str(path)):
                Service(wl.live.Session(config), path).run()
    first.close()
    assert not path.exists()
    last = [record.octets for record in read_session(path) if record.octets]
    assert last[-1] == octets
    after = Service(wl.live.Session(config), path)
    after._begin()
    after.close()


def test_a_cut_file_loses_its_last_record_only(tmp_path):
    whole, rng = tmp_path / "s.pcap", random.Random(1)
    recorder = Recorder(whole, {"radar": []})
    recorder.begin(0.0)
    for k in range(40):
        recorder.data(float(k), "x", "udp://127.0.0.1:7", b"%d" % k * (k + 1))
    recorder.close()
    octets = whole.read_bytes()
    records = [record for record in read_session(whole) if record.values is None]
    assert [record.time_s for record in records] == list(range(40))
    for cut in (rng.randrange(400, len(octets)) for _ in range(20)):
        part = tmp_path / f"cut{cut}.pcap"
        part.write_bytes(octets[:cut])
        kept = [record for record in read_session(part) if record.values is None]
        assert kept == records[: len(kept)]
        onward = Recorder(part, {"radar": []})
        onward.data(99.0, "x", "udp://127.0.0.1:7", b"on")
        onward.close()
        on = [record for record in read_session(part) if record.values is None]
        assert on[:-1] == kept
        assert on[-1].octets == b"on"


def test_segments_are_rotated_within_the_cap(tmp_path):
    path = tmp_path / "s.pcap"
    recorder = Recorder(path, {"radar": []}, segment_octets=5000, most_octets=20000)
    recorder.begin(0.0)
    for k in range(500):
        recorder.data(float(k), "x", "udp://127.0.0.1:7", bytes(200))
    recorder.close()
    segments = segments_of(path)
    assert 2 < len(segments)
    assert sum(segment.stat().st_size for segment in segments) < 26000
    times = [record.time_s for record in read_session(path) if record.values is None]
    assert times == [float(k) for k in range(500 - len(times), 500)]


def test_a_later_segment_alone_keeps_the_numbers(tmp_path):
    path = tmp_path / "s.pcap"
    limits = SessionConfig(segment_mb=0.01, most_mb=0.03)
    config = LiveConfig(radars=(ASHORE,), session=limits)
    service = Service(wl.live.Session(config), path)
    service._begin()
    for k in range(120):
        t, octets = turn(k, time.time() + 1.0)
        service._feed("x", [(t, octets)])
    service.close()
    whole = {one.track_id: one for one in service.session.tracker.tracks()}
    assert not path.exists()
    again = Service(wl.live.Session(config), path)
    again._begin()
    again.close()
    tracks = {one.track_id: one for one in again.session.tracker.tracks()}
    assert tracks.keys() == whole.keys()
    for number, track in tracks.items():
        assert track.mean == whole[number].mean


class Disk:
    """Stands in for `os.write`: takes so many octets, and then no more."""

    def __init__(self, monkeypatch, room):
        self.room, self._write = room, os.write
        monkeypatch.setattr("wakeline.live.record.os.write", self)

    def __call__(self, file, octets):
        taken = min(len(octets), self.room)
        if taken == 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        self.room -= taken
        return self._write(file, octets[:taken])


def test_tracking_continues_on_a_full_disk_and_the_record_when_there_is_room(tmp_path, monkeypatch):
    path = tmp_path / "s.pcap"
    config = LiveConfig(radars=(ASHORE,))
    service = Service(wl.live.Session(config), path)
    service._begin()
    begin_s = time.time()
    for k in range(6):
        service._feed("x", [turn(k, begin_s)])
    disk = Disk(monkeypatch, room=100)
    for k in range(6, 12):
        service._feed("x", [turn(k, begin_s)])
    (problem,) = service.session.status()["file_problems"]
    assert problem == f"{path}: No space left on device"
    assert len(service.session.tracker.tracks()) == 2
    before = list(read_session(path))
    disk.room, service._again_s = 2000, -math.inf  # not enough for a segment
    service._feed("x", [turn(12, begin_s)])
    assert segments_of(path) == [path]
    assert list(read_session(path)) == before
    disk.room, service._again_s = 1 << 30, -math.inf
    for k in range(13, 16):
        service._feed("x", [turn(k, begin_s)])
    assert service.session.status()["file_problems"] == []
    service.close()
    whole = {one.track_id: one.mean for one in service.session.tracker.tracks()}
    again = Service(wl.live.Session(config), path)
    again._begin()
    again.close()
    for session in (again.session, replayed(path)[0]):
        assert {one.track_id: one.mean for one in session.tracker.tracks()} == whole
    assert not list(tmp_path.glob("*.part"))


def test_a_session_begins_on_a_full_disk_and_is_recorded_when_there_is_room(tmp_path, monkeypatch):
    path, begin_s = tmp_path / "s.pcap", time.time()
    disk = Disk(monkeypatch, room=10)
    service = Service(wl.live.Session(LiveConfig(radars=(ASHORE,))), path)
    service._begin()
    for k in range(6):
        service._feed("x", [turn(k, begin_s)])
    assert service.session.status()["file_problems"] == [f"{path}: No space left on device"]
    assert not segments_of(path)
    disk.room, service._again_s = 1 << 30, -math.inf
    for k in range(6, 12):
        service._feed("x", [turn(k, begin_s)])
    service.close()
    whole = {one.track_id: one.mean for one in service.session.tracker.tracks()}
    assert len(whole) == 2
    assert {one.track_id: one.mean for one in replayed(path)[0].tracker.tracks()} == whole


def test_what_waits_while_a_record_is_read_again_is_not_taken_for_new(tmp_path):
    path = tmp_path / "s.pcap"
    config = LiveConfig(radars=(ASHORE,), inputs=(InputConfig("udp://127.0.0.1:0?name=x"),))
    service = Service(wl.live.Session(config), path)
    service._begin()
    service._feed("x", [turn(0, time.time())])
    service.close()
    again = Service(wl.live.Session(config), path)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for k in range(50):
            sender.sendto(turn(k, time.time())[1], ("127.0.0.1", again.inputs[0].port))
        again._begin()
        sender.sendto(turn(50, time.time())[1], ("127.0.0.1", again.inputs[0].port))
        end_s = time.monotonic() + 3.0
        while again._waiting.empty() and time.monotonic() < end_s:
            time.sleep(0.01)
    taken = []
    while not again._waiting.empty():
        taken += again._waiting.get()[1]
    again.close()
    assert len(taken) == 1


def test_a_session_of_other_settings_or_inputs_is_not_continued(tmp_path):
    path = tmp_path / "s.pcap"
    config = LiveConfig(radars=(ASHORE,), session=SessionConfig(segment_mb=0.01))
    service = Service(wl.live.Session(config), path)
    service._begin()
    for k in range(60):
        service._feed("x", [turn(k, time.time())])
    service.close()
    assert len(segments_of(path)) > 1
    radar = RadarConfig("B", position_deg=(54.1, 10.0))
    for changed in (
        replace(config, radars=(ASHORE, radar)),
        replace(config, inputs=(InputConfig("udp://127.0.0.1:0?name=y"),)),
    ):
        with pytest.raises(RecordingError, match="cannot be continued"):
            Service(wl.live.Session(changed), path).run()


def test_a_session_is_replayed_with_the_settings_of_a_file(tmp_path, capsys):
    path, lines = tmp_path / "s.pcap", tmp_path / "t.jsonl"
    run_demo_like(path, range(12), time.time())
    settings = tmp_path / "live.toml"
    settings.write_text("[tracker]\nbirth_density_per_m2 = 0.0\n")
    main(["live", str(settings), "--replay", str(path), "--speed", "max", "--out", f"file:{lines}"])
    assert "0 tracks at the end" in capsys.readouterr().out
    main(["live", "--replay", str(path), "--speed", "max", "--out", f"file:{lines}"])
    assert "2 tracks at the end" in capsys.readouterr().out


def test_a_file_changes_only_what_it_names_of_a_session(tmp_path, capsys):
    path, settings = tmp_path / "s.pcap", tmp_path / "live.toml"
    recorded = LiveConfig(
        radars=(replace(ASHORE, settings={"range_std_m": 7.0}),),
        own=OwnConfig(place_deg=(54.0, 10.0)),
        session=SessionConfig(origin_deg=(54.0, 10.0)),
        settings=Settings.of({"tracker": {"vessel_length_m": 90.0, "confirm_hits": 4}}, "here"),
        guard_zones=({"name": "fairway", "near_m": 100.0, "far_m": 900.0},),
    )
    service = Service(wl.live.Session(recorded), path)
    service._begin()
    service.close()
    for text, wanted in (
        ("", {}),
        ("[tracker]\nconfirm_hits = 5\n", {("tracker", "confirm_hits"): 5}),
        ("[session]\nwindow_s = 20.0\n", {("session", "window_s"): 20.0}),
    ):
        settings.write_text(text)
        main(["live", str(settings), "--replay", str(path), "--print-config"])
        settings.write_text(capsys.readouterr().out)
        found, expected = wl.live.read_config(settings).as_document(), recorded.as_document()
        for (section, key), value in wanted.items():
            expected[section][key] = value
        assert found == expected


def test_another_file_is_no_session(tmp_path):
    (tmp_path / "x.pcap").write_bytes(b"nothing")
    for name in ("x.pcap", "missing.pcap"):
        with pytest.raises(RecordingError):
            list(read_session(tmp_path / name))


def test_times_of_a_session_file_are_exact():
    for time_s in (0.1, 1.7e9 + 0.123456, 1795717706.9999999):
        assert at_microsecond(at_microsecond(time_s)) == at_microsecond(time_s)


# ------------------------------------------------------------------ the command


def started(*arguments, cwd):
    return subprocess.Popen(
        [sys.executable, "-m", "wakeline", "live", *arguments],
        cwd=cwd,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def test_the_demonstration_tracks_and_stops_on_sigterm(tmp_path):
    process = started("--demo", "--record", "s.pcap", cwd=tmp_path)
    tracks = tmp_path / "wakeline-live" / "tracks.jsonl"
    try:
        until(lambda: tracks.exists() and b'"type":"track"' in tracks.read_bytes(), 40.0)
    finally:
        process.send_signal(signal.SIGTERM)
        output, _ = process.communicate(timeout=20.0)
    assert process.returncode == 0, output
    assert "tracks" in output
    lines = tracks.read_bytes()
    for speed in ("max", "50"):
        again = tmp_path / f"{speed}.jsonl"
        replay = ["live", "--replay", str(tmp_path / "s.pcap"), "--speed", speed, "--quiet"]
        assert main([*replay, "--out", f"file:{again}"]) == 0
        assert again.read_bytes() == lines


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as one:
        return one.getsockname()[1]


def test_a_killed_process_goes_on_with_the_same_numbers(tmp_path):
    port = free_port()
    (tmp_path / "live.toml").write_text(
        '[[radar]]\nname = "A"\nposition_deg = [54, 10]\nperiod_s = 0.2\n'
        f'[[input]]\nurl = "tcp-listen://127.0.0.1:{port}"\n'
        '[[output]]\nurl = "file:tracks.jsonl"\n'
    )
    texts, begin_s = [], time.time()
    for _ in range(2):
        process = started("live.toml", "--record", "s.pcap", cwd=tmp_path)
        try:
            until(lambda process=process: "in 0/s" in process.stdout.readline(), 30.0)
            first = math.ceil((time.time() - begin_s) / 0.2)
            with socket.create_connection(("127.0.0.1", port)) as sender:
                for k in range(first, first + 8):
                    sender.sendall(turn(k, begin_s, 0.2)[1])
                    time.sleep(0.1)
                last = f'"time_s":{begin_s + 0.2 * k:.6f}'
                until(lambda last=last: last in read_tracks(tmp_path), 10.0)
        finally:
            process.kill()
            process.communicate(timeout=10.0)
        texts.append(read_tracks(tmp_path))
    again = tmp_path / "again.jsonl"
    replay = ["live", "--replay", str(tmp_path / "s.pcap"), "--speed", "max", "--quiet"]
    assert main([*replay, "--out", f"file:{again}"]) == 0
    second = texts[1][len(texts[0]) :].partition("\n")[2]
    assert second in again.read_text()
    assert '"type":"track"' in second


def read_tracks(folder):
    path = folder / "tracks.jsonl"
    return path.read_text().rpartition("\n")[0] if path.exists() else ""


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["--in", "ftp://x"],
        ["--in", "udp://127.0.0.1"],
        ["--in", "tcp://127.0.0.1"],
        ["--in", "stdin:", "--out", "tcp://127.0.0.1"],
        ["--in", "serial:/dev/null?baud=fast"],
        ["--in", "pcap:missing.pcap", "--quiet"],
        ["--in", "stdin:", "--for", "0"],
        ["--replay", "missing.pcap"],
        ["--in", "pcap:missing.pcap"],
        ["--in", "pcap:/"],
        ["--in", f"pcap:{__file__}"],
        ["--in", f"pcap:{os.devnull}"],
        ["--own", "here", "--in", "stdin:"],
        ["--speed", "0", "--demo"],
    ],
)
def test_a_wrong_command_line_is_one_line(arguments, capsys):
    assert main(["live", *arguments]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_an_address_in_use_is_named(capsys):
    with socket.create_server(("127.0.0.1", 0)) as one:
        url = f"tcp-listen://127.0.0.1:{one.getsockname()[1]}"
        assert main(["live", "--in", url]) == 2
    assert url in capsys.readouterr().err


def test_settings_are_printed_and_read(tmp_path, capsys):
    assert main(["live", "--print-config", "--in", "udp://0.0.0.0:10110"]) == 0
    path = tmp_path / "live.toml"
    path.write_text(capsys.readouterr().out)
    assert main(["live", str(path), "--print-config"]) == 0
    assert capsys.readouterr().out == path.read_text()
