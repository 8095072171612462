"""The server of the screen: who may look, what is sent, and that no client can harm."""

import asyncio
import json
import math
import socket
import struct
import time
from pathlib import Path

import aiohttp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from harbor import CELLS, RANGE_M, ROWS, Harbor, recorded_plots
from wakeline.cli import main
from wakeline.live.alarms import AlarmLog
from wakeline.live.playback import Playback, RecordedTracks, SessionPlayback
from wakeline.live.record import Recorder
from wakeline.live.session import Session
from wakeline.live.web import WebServer
from wakeline.live.web.echoes import EchoImage, EchoReader
from wakeline.live.web.scene import TRACK_COLUMNS, Scene
from wakeline.live.web.signalk import spokes_of

BASE = "/signalk/v2/api/vessels/self/radars"


def with_client(server, work):
    """Run `work(client, url)` with an HTTP client."""

    async def run():
        jar = aiohttp.CookieJar(unsafe=True)  # of an address without a name
        async with aiohttp.ClientSession(cookie_jar=jar) as client:
            return await work(client, f"http://127.0.0.1:{server.app.port}")

    return asyncio.run(run())


@pytest.fixture
def harbor():
    return Harbor()


@pytest.fixture
def server(harbor):
    with WebServer(harbor, port=0) as server:
        yield server


async def next_of(stream, kind, within_s=10.0):
    """The next JSON message of a type."""
    while True:
        message = await stream.receive_json(timeout=within_s)
        if message.get("type") == kind:
            return message


# Who may look -------------------------------------------------------------------------------------


def test_pages_allow_no_foreign_script_and_no_foreign_site(server):
    async def work(client, url):
        for path in ("/", "/static/main.js", "/status"):
            async with client.get(url + path) as answer:
                assert answer.status == 200
                policy = answer.headers["Content-Security-Policy"]
                assert "default-src 'none'" in policy
                assert "script-src 'self';" in policy
                assert answer.headers["X-Content-Type-Options"] == "nosniff"
        for headers in ({"Host": "evil.example"}, {"Origin": "http://evil.example"}):
            for path in ("/", "/picture", "/echoes", BASE):
                async with client.get(url + path, headers=headers) as answer:
                    assert answer.status == 403
        for path in ("/static/..%2Fserver.py", "/static/%2e%2e/server.py", "/static/nothing.js"):
            async with client.get(aiohttp.client.URL(url + path, encoded=True)) as answer:
                assert answer.status == 404

    with_client(server, work)


def test_another_address_needs_the_token(harbor):
    with WebServer(harbor, "0.0.0.0", 0) as server:
        token = server.app.token
        assert len(token) > 15

        async def work(client, url):
            for path in ("/", "/status", "/picture", "/metrics"):
                for query in ("", "?token=wrong"):
                    async with client.get(url + path + query) as answer:
                        assert answer.status == 403
            async with client.get(url + "/status", headers=bearer) as answer:
                assert answer.status == 200
            async with client.get(f"{url}/?token={token}") as answer:
                assert answer.status == 200
                assert "token" not in str(answer.url)
            async with client.ws_connect(url + "/picture") as stream:
                assert (await stream.receive_json())["type"] == "hello"

        bearer = {"Authorization": f"Bearer {token}"}
        with_client(server, work)


def test_an_address_in_use_is_an_error(server, harbor):
    with pytest.raises(OSError, match=r"."):
        WebServer(harbor, port=server.app.port)


# No client can harm -------------------------------------------------------------------------------


def test_what_a_client_sends_is_answered_and_harms_nobody(server, harbor):
    def boom():
        raise RuntimeError("the session is ill")

    async def work(client, url):
        async with client.ws_connect(url + "/picture") as other:
            async with client.ws_connect(url + "/picture") as stream:
                garbage = [
                    *("", "nonsense", "[]", "3", "null", '"x"', "{}", '{"number": []}'),
                    *('{"command": "zone"}', '{"command": "zone", "zone": {"outline_m": [[]]}}'),
                    *('{"command": "zone", "zone": {"far_m": 1e999}}', "[" * 50000),
                    *('{"command": "acknowledge", "alarm_id": {}}', '{"command": {"a": 1}}'),
                    '{"command": "limits", "cpa_limit_m": "wide"}',
                ]
                for text in garbage:
                    await stream.send_str(text)
                    answer = await next_of(stream, "answer")
                    assert not answer["ok"]
                    assert answer["error"]
                await stream.send_str("x" * 100_000)
                while not stream.closed:
                    await stream.receive(timeout=10.0)
            harbor.picture, picture = boom, harbor.picture
            while "note" not in (message := await next_of(other, "picture")) or (
                message["note"] is None
            ):
                pass
            assert "ill" in message["note"]
            harbor.picture = picture
            harbor.add(9, 1.0, 2.0)
            while not any(row[0] == 9 for row in message.get("tracks", ())):
                message = await next_of(other, "picture")

    with_client(server, work)
    assert len(harbor.board.alarms.zones) == 0


def memory_octets():
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


def test_a_client_that_does_not_read_costs_little_and_hinders_nobody(server, harbor):
    for k in range(1, 300):
        harbor.add(k, 10.0 * k, 5.0 * k)
    silent = []
    for path in ("/echoes", "/picture"):
        one = socket.socket()
        one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        one.connect(("127.0.0.1", server.app.port))
        one.sendall(
            f"GET {path} HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n"
            "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n".encode()
        )
        silent.append(one)

    async def work(client, url):
        async with client.ws_connect(url + "/echoes") as stream:
            harbor.sweep()
            await stream.receive(timeout=10.0)
            before = memory_octets()
            for turn in range(60):
                harbor.sweep([(0.1 * turn, 1000.0)])
                last = await stream.receive(timeout=10.0)
                while last.type == aiohttp.WSMsgType.TEXT:  # a gap, where this reader was slow
                    last = await stream.receive(timeout=10.0)
                assert last.type == aiohttp.WSMsgType.BINARY
            return memory_octets() - before

    try:
        assert with_client(server, work) < 8e6
    finally:
        for one in silent:
            one.close()


# The picture --------------------------------------------------------------------------------------

METRES = st.floats(-5e4, 5e4)
SPEED = st.floats(-20.0, 20.0)
TRACK = st.tuples(METRES, METRES, SPEED, SPEED, st.floats(0.5, 60.0), st.sampled_from(["", "A"]))
PICTURES = st.lists(st.dictionaries(st.integers(1, 6), TRACK, max_size=6), min_size=1, max_size=8)


@settings(max_examples=60)
@given(pictures=PICTURES, step_s=st.floats(0.1, 20.0), joins=st.integers(0, 4))
def test_a_page_that_follows_has_the_picture(pictures, step_s, joins):
    """Messages with what is new lead to the whole picture, within its stated tolerance."""
    scene, version, followed = Scene(), 0, {}
    for k, tracks in enumerate(pictures):
        time_s = 100.0 + k * step_s
        rows = [
            {
                "track_id": number, "time_s": time_s, "north_m": n, "east_m": e,
                "vnorth_mps": vn, "veast_mps": ve, "name": name, "status": "confirmed",
                "covariance": np.diag([std**2, 1.0, std**2, 1.0]),
            }
            for number, (n, e, vn, ve, std, name) in tracks.items()
        ]  # fmt: skip
        scene.take({"time_s": time_s, "tracks": rows})
        if k < joins:
            continue
        text, version = scene.message(version)
        message = json.loads(text)
        if message.get("all"):
            followed.clear()
        for row in message.get("tracks", ()):
            followed[row[0]] = dict(zip(TRACK_COLUMNS, row, strict=True))
        for number in message.get("gone", ()):
            followed.pop(number, None)
        assert followed.keys() == tracks.keys()
        for number, (north_m, east_m, *_, std_m, name) in tracks.items():
            row = followed[number]
            dt_s = time_s - row["time"]
            off_m = math.hypot(
                row["north"] + dt_s * row["vnorth"] - north_m,
                row["east"] + dt_s * row["veast"] - east_m,
            )
            assert off_m <= max(2.0, 0.5 * std_m) + 0.3
            assert row["name"] == name


def test_a_page_has_the_motion_of_each_track_in_words():
    place = dict.fromkeys(("north_m", "east_m", "vnorth_mps", "veast_mps"), 0.0)
    scene, modes = Scene(), ["", *wl.tracking.MODE_NAMES]
    tracks = [{"track_id": k, "mode": mode, **place} for k, mode in enumerate(modes)]
    scene.take({"time_s": 0.0, "tracks": tracks})
    rows = json.loads(scene.message(0)[0])["tracks"]
    words = {row[0]: row[TRACK_COLUMNS.index("mode")] for row in rows}
    for k, mode in enumerate(modes):
        side = mode.removesuffix("_turn")
        assert words[k] == (mode if side == mode else f"turning to {side}")


def test_a_picture_of_steady_tracks_is_small():
    """1000 tracks that keep their course: far below 60 kB/s at four pictures a second."""
    rng = np.random.default_rng(1)
    place, way = rng.uniform(-2e4, 2e4, (1000, 2)), rng.uniform(-8.0, 8.0, (1000, 2))
    scene, version, octets = Scene(), 0, 0
    for k in range(40):
        time_s = 0.25 * k
        now = place + time_s * way + rng.normal(0.0, 0.3, place.shape)
        rows = [
            {
                "track_id": i + 1, "time_s": time_s, "north_m": n, "east_m": e,
                "vnorth_mps": vn, "veast_mps": ve, "status": "confirmed",
                "covariance": np.diag([64.0, 0.1, 64.0, 0.1]),
                "cpa": {"cpa_m": 500.0, "tcpa_s": 600.0 - time_s, "probability": 0.4},
            }
            for i, ((n, e), (vn, ve)) in enumerate(zip(now, way, strict=True))
        ]  # fmt: skip
        scene.take({"time_s": time_s, "tracks": rows})
        text, version = scene.message(version)
        octets += len(text) if k else 0
    assert octets / 10.0 < 60e3


# Echoes -------------------------------------------------------------------------------------------


def unpack(message):
    """Numbers of rows and their cells."""
    _, _, rows, columns, count, range_m, _ = struct.unpack_from("<BBHHHff", message)
    number = np.frombuffer(message, "<u2", count, 16)
    packed = np.frombuffer(message, np.uint8, offset=16 + 2 * count).reshape(count, -1)
    cells = np.empty((count, columns), np.uint8)
    cells[:, 0::2], cells[:, 1::2] = packed & 15, packed >> 4
    return rows, range_m, number, cells


@settings(max_examples=40)
@given(
    sweeps=st.sampled_from([64, 128, 300, 512, 4096]),
    cells=st.integers(1, 2500),
    pieces=st.integers(1, 9),
    begin=st.floats(-7.0, 7.0),
    seed=st.integers(0, 99),
)
def test_a_turn_of_echoes_arrives_with_its_largest_amplitudes(sweeps, cells, pieces, begin, seed):
    rng = np.random.default_rng(seed)
    azimuth_rad = begin + (np.arange(sweeps) + 0.5) * 2.0 * np.pi / sweeps
    amplitude = rng.integers(0, 256, (sweeps, cells), dtype=np.uint8)
    image = EchoImage()
    reader = EchoReader(image, 100)
    for part in np.array_split(np.arange(sweeps), pieces):
        if len(part) > 1:
            image(azimuth_rad[part], math.nan, 1e3, amplitude[part])
    got = {}
    while message := reader.next():
        rows, range_m, number, levels = unpack(message)
        assert range_m == 1e3
        got.update(zip(number.tolist(), levels, strict=True))
    assert reader.gap == 0
    for number, levels in got.items():
        inside = (azimuth_rad % (2 * np.pi) * rows / (2 * np.pi)).astype(int) % rows == number
        if inside.any():
            assert levels.max() <= amplitude[inside].max() >> 4
    if pieces == 1:
        assert len(got) >= min(rows, sweeps) - 1
        assert max(levels.max() for levels in got.values()) == amplitude.max() >> 4


def test_rows_are_sent_replaced_or_waiting():
    """Sent, replaced and waiting rows are all that were written; the newest are sent."""
    image = EchoImage()
    readers = [EchoReader(image, 50), EchoReader(image, 1000)]
    azimuth_rad = (np.arange(512) + 0.5) * 2 * np.pi / 512
    cells = np.zeros((512, 64), np.uint8)
    image(azimuth_rad, math.nan, 1e3, cells)
    sent = [len(unpack(reader.next())[2]) for reader in readers]
    for turn in range(1, 9):
        image(azimuth_rad, math.nan, 1e3, cells + 16 * turn)
    for k, reader in enumerate(readers):
        while message := reader.next():
            _, _, number, levels = unpack(message)
            sent[k] += len(number)
            assert (levels == 8).all()
        assert sent[k] + reader.gap == 9 * 512


def test_heading_turns_echoes_to_north():
    image = EchoImage()
    cells = np.zeros((512, 64), np.uint8)
    cells[0] = 255  # at the bow
    image((np.arange(512) + 0.5) * 2 * np.pi / 512, math.pi / 2, 1e3, cells)
    rows, _, number, levels = unpack(EchoReader(image, 1000).next())
    (bright,) = number[levels.max(axis=1) == 15]
    assert bright == rows // 4


# Signal K -----------------------------------------------------------------------------------------


def test_a_signal_k_client_sees_acquiring_tracking_lost_and_null(server, harbor):
    async def work(client, url):
        async with client.get(url + BASE) as answer:
            listed = await answer.json()
        assert listed["version"].startswith("3.4")
        (radar,) = listed["radars"]
        seen = []
        stream_url = listed["radars"][radar]["streamUrl"].replace("localhost", "127.0.0.1")
        async with client.ws_connect(stream_url + "?subscribe=none") as stream:
            hello = await stream.receive_json(timeout=5.0)
            assert hello["self"]
            wanted = {"path": "radars.*.targets.*", "policy": "instant"}
            await stream.send_json({"context": "vessels.self", "subscribe": [wanted]})
            place = {"bearing": math.pi / 2, "distance": 500.0}
            async with client.post(f"{url}{BASE}/{radar}/targets", json=place) as answer:
                assert answer.status == 200
            until = time.monotonic() + 40.0
            while not seen or seen[-1] is not None:
                assert time.monotonic() < until
                delta = await stream.receive_json(timeout=20.0)
                for update in delta["updates"]:
                    assert update["$source"]
                    for value in update.get("values", ()):
                        assert value["path"] == f"radars.{radar}.targets.1"
                        seen.append(value["value"])
                state = seen[-1]["status"] if seen and seen[-1] else None
                if state == "acquiring":
                    harbor.tracks[1]["status"] = "confirmed"
                elif state == "tracking":
                    harbor.tracks.clear()
                elif state == "lost":
                    harbor.begin_s += 20.0
        states = [value and value["status"] for value in seen]
        assert list(dict.fromkeys(states)) == ["acquiring", "tracking", "lost", None]
        tracking = seen[states.index("tracking")]
        assert tracking["position"]["bearing"] == pytest.approx(math.pi / 2, abs=1e-3)
        assert tracking["position"]["distance"] == pytest.approx(500.0, abs=0.1)
        assert tracking["motion"]["speed"] == 0.0
        assert "motion" not in seen[0]

    with_client(server, work)


def test_signal_k_guard_zones_notifications_and_errors(server, harbor):
    async def work(client, url):
        radar = f"{url}{BASE}/A"
        zone = {"enabled": True, "value": -0.5, "endValue": 0.5, "startDistance": 0.0}
        async with client.put(f"{radar}/controls/guardZone1", json=zone) as answer:
            assert answer.status == 400  # no end
        async with client.put(
            f"{radar}/controls/guardZone1", json=zone | {"endDistance": 900.0}
        ) as answer:
            assert answer.status == 200
        async with client.get(f"{radar}/controls") as answer:
            control = (await answer.json())["guardZone1"]
        assert control["enabled"]
        assert control["value"] == pytest.approx(-0.5)
        harbor.add(4, 0.0, 500.0)  # ahead: the heading is east
        async with client.ws_connect(url + "/signalk/v1/stream") as stream:
            found = None
            while found is None:
                delta = await stream.receive_json(timeout=10.0)
                for value in delta.get("updates", [{}])[0].get("values", ()):
                    if value["path"].startswith("notifications.radar.A.guardZone.1."):
                        found = value["value"]
            assert found["state"] == "alarm"
            assert "sound" in found["method"]
        async with client.put(f"{radar}/controls/guardZone1", json={"enabled": False}) as answer:
            assert answer.status == 200
        for method, path, body in (
            ("get", "/B/targets", None),
            ("delete", "/A/targets/99x", None),
            ("post", "/A/targets", {"bearing": "x"}),
            ("put", "/A/controls/gain", {"value": 1}),
            ("get", "/A/spokes", None),
        ):
            async with client.request(method, url + BASE + path, json=body) as answer:
                assert 400 <= answer.status < 500
                assert (await answer.json())["error"]

    with_client(server, work)


@pytest.mark.parametrize(
    ("given", "wanted"),
    [
        (
            {"value": -30, "endValue": 90, "units": "deg"},
            {"value": -math.pi / 6},
        ),
        ({"startDistance": 1, "endDistance": 2, "units": "nm"}, {"endDistance": 3704.0}),
        ({"endDistance": 2, "units": "km"}, {"endDistance": 2000.0}),
        ({"value": 1.0, "units": "rad"}, {"value": 1.0}),
        ({"value": 170, "endValue": 190, "units": "deg"}, None),
        ({"value": 170}, None),
        ({"endDistance": 60, "units": "nm"}, None),
        ({"endDistance": 5, "units": "kn"}, None),
        ({"units": ["deg"]}, None),
        ({"value": "1"}, None),
        ({"value": True}, None),
        ({"startDistance": -1.0}, None),
    ],
)
def test_a_guard_zone_is_set_in_the_units_that_it_names_within_its_limits(server, given, wanted):
    zone = {"enabled": True, "value": -0.5, "endValue": 0.5}
    zone |= {"startDistance": 0.0, "endDistance": 900.0}

    async def work(client, url):
        control = f"{url}{BASE}/A/controls/guardZone1"
        async with client.put(control, json=zone) as answer:
            assert answer.status == 200
        async with client.put(control, json=given) as answer:
            assert answer.status == (200 if wanted else 400)
            assert wanted or (await answer.json())["error"]
        async with client.get(control) as answer:
            now = await answer.json()
        assert {key: now[key] for key in wanted or zone} == pytest.approx(wanted or zone)

    with_client(server, work)


def test_a_control_has_its_own_zone_and_leaves_what_it_does_not_name(server, harbor):
    harbor.add(4, 0.0, 500.0)  # ahead: the heading is east
    zone = {"enabled": True, "value": -0.5, "endValue": 0.5}
    zone |= {"startDistance": 0.0, "endDistance": 900.0}

    async def work(client, url):
        controls = f"{url}{BASE}/A/controls"
        async with client.put(f"{controls}/guardZone2", json=zone) as answer:
            assert answer.status == 200
        async with client.get(controls) as answer:
            shown = await answer.json()
        assert [shown[name]["enabled"] for name in ("guardZone1", "guardZone2")] == [False, True]
        drawn = harbor.board.alarms.zones[1].as_dict() | {"name": "pier", "triggers": ["exit"]}
        assert harbor.command({"command": "zone", "zone": drawn})["ok"]
        await asyncio.sleep(0.3)  # until there is another picture
        async with client.put(f"{controls}/guardZone2", json={"endDistance": 800.0}) as answer:
            assert answer.status == 200
        now = harbor.board.alarms.zones[1]
        assert (now.name, now.triggers, now.far_m) == ("pier", ("exit",), 800.0)
        async with client.get(f"{url}{BASE}/A/targets") as answer:
            (target,) = await answer.json()
        assert target["sourceZone"] == 2

    with_client(server, work)


def test_targets_of_a_radar_ashore_are_seen_from_it():
    class Shore(Harbor):
        def picture(self):
            radar = {"name": "A", "aboard": False, "north_m": 100.0, "east_m": 0.0}
            return super().picture() | {"own": None, "radars": [radar]}

    harbor = Shore()

    async def work(client, url):
        targets = f"{url}{BASE}/A/targets"
        async with client.post(targets, json={"bearing": 0.0, "distance": 400.0}) as answer:
            assert answer.status == 200
        assert harbor.tracks[1]["north_m"] == pytest.approx(500.0)
        async with client.get(targets) as answer:
            (target,) = await answer.json()
        assert target["position"]["distance"] == pytest.approx(400.0)

    with WebServer(harbor, port=0) as server:
        with_client(server, work)


def test_octets_that_are_no_text_are_rejected(harbor):
    with WebServer(harbor, port=0) as server:

        async def put(client, url):
            kind = {"Content-Type": "application/json; charset=nothing"}
            async with client.post(f"{url}{BASE}/A/targets", data=b"\xff", headers=kind) as answer:
                assert answer.status == 400

        with_client(server, put)
    with (
        WebServer(harbor, "0.0.0.0", 0) as server,
        socket.create_connection(("127.0.0.1", server.app.port), timeout=5.0) as client,
    ):
        client.sendall(b"GET / HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer \xff\r\n\r\n")
        assert client.recv(12) == b"HTTP/1.1 403"


@pytest.mark.parametrize("distance", ["-2000", "0", "1e9", "Infinity", "null", "true", "1" * 400])
def test_no_target_is_acquired_at_an_impossible_place(server, harbor, distance):
    async def work(client, url):
        body = f'{{"bearing": -7.0, "distance": {distance}}}'
        async with client.post(f"{url}{BASE}/A/targets", data=body) as answer:
            assert answer.status == 400
            assert "distance" in (await answer.json())["error"]
        assert not harbor.commands

    with_client(server, work)


def test_each_subscription_has_its_period(server, harbor):
    harbor.add(1, 0.0, 500.0, vnorth_mps=5.0)
    wanted = {
        "radars.A.targets.1": {"period": 1000},
        "radars.*.targets.1": {"policy": "instant"},
        "radars.A.targets.*": {"policy": "instant", "minPeriod": 60000},
        "radars.A.controls.guardZone1": {"policy": "ideal", "period": 700},
        "radars.A.controls.guardZone2": {"policy": "instant"},
    }

    async def count(client, url, paths):
        times = []
        async with client.ws_connect(url + "/signalk/v1/stream?subscribe=none") as stream:
            subscribe = [{"path": path} | wanted[path] for path in paths]
            await stream.send_json({"context": "vessels.self", "subscribe": subscribe})
            end_s = time.monotonic() + 1.6
            while (left_s := end_s - time.monotonic()) > 0.0:
                try:
                    delta = await stream.receive_json(timeout=left_s)
                except asyncio.TimeoutError:
                    break
                values = delta.get("updates", [{}])[0].get("values", ())
                times += [one["path"] for one in values]
        return len(times)

    async def move():
        while True:
            harbor.tracks[1]["north_m"] += 1.0
            await asyncio.sleep(0.05)

    async def work(client, url):
        moving = asyncio.ensure_future(move())
        counts = await asyncio.gather(*(count(client, url, [path]) for path in wanted))
        moving.cancel()
        by_second, instant, by_minute, repeated, once = counts
        assert 1 <= by_second <= 2 < instant
        assert by_minute == once == 1
        assert 2 <= repeated <= 3

    with_client(server, work)


def fields_of(octets):
    """Numbers and values of the fields of a protocol-buffers message."""

    def varint(at):
        value = shift = 0
        while True:
            value |= (octets[at] & 127) << shift
            at, shift = at + 1, shift + 7
            if octets[at - 1] < 128:
                return value, at

    at = 0
    while at < len(octets):
        key, at = varint(at)
        value, at = varint(at)
        if key & 7 == 2:
            value, at = octets[at : at + value], at + value
        yield key >> 3, value


def test_spokes_are_the_rows(harbor):
    image = EchoImage()
    harbor.sweeps.append(lambda radar, *sweeps: image(*sweeps))
    harbor.sweep()
    message = EchoReader(image, 1000).next()
    _, _, number, cells = unpack(message)
    spokes = [dict(fields_of(spoke)) for _, spoke in fields_of(spokes_of(message, 1.7e9))]
    assert [spoke[2] for spoke in spokes] == number.tolist()
    assert [spoke[1] for spoke in spokes] == number.tolist()  # without a heading
    assert all(spoke[3] == RANGE_M and spoke[4] == 1_700_000_000_000 for spoke in spokes)
    for spoke, row in zip(spokes, cells, strict=True):
        assert np.array_equal(np.frombuffer(spoke[5], np.uint8), row)
    assert cells.shape == (ROWS, CELLS)


# Playback -----------------------------------------------------------------------------------------


def same(a, b):
    def plain(value):
        return json.dumps(value, default=lambda array: array.tolist())

    return plain(a) == plain(b)


def recorded_tracks(log=None):
    return Playback(RecordedTracks(wl.track_recording("joyride")), log=log)


@pytest.mark.parametrize("make", [recorded_plots, recorded_tracks])
def test_going_back_leads_to_the_same_pictures_and_the_alarms_are_logged_once(make, tmp_path):
    log = AlarmLog(tmp_path / "alarms.csv")
    player = make(log)
    times = np.linspace(player.start_s, player.end_s, 9)
    pictures = []
    for time_s in times:
        player.go_to(time_s)
        pictures.append(player.picture())
    written = (tmp_path / "alarms.csv").read_text()
    for k in (3, 7, 0, 5, 8):
        player.go_to(times[k])
        assert same(player.picture(), pictures[k])
    assert (tmp_path / "alarms.csv").read_text() == written
    log.close()


def test_a_player_obeys():
    player = recorded_plots()
    player.go_to(player.start_s + 60.0)
    (track,) = player.picture()["tracks"]
    assert player.command({"command": "rename", "track_id": track["track_id"], "name": "Speedy"})
    assert player.picture()["tracks"][0]["name"] == "Speedy"
    assert player.command({"command": "replay", "paused": True, "speed": 5})["ok"]
    assert player.picture()["replay"] == {
        "start_s": player.start_s,
        "end_s": player.end_s,
        "time_s": player.time_s,
        "speed": 5.0,
        "paused": True,
    }
    assert player.command({"command": "drop", "track_id": track["track_id"]})["ok"]
    assert player.picture()["tracks"] == []
    for wrong in (
        {"command": "replay", "time_s": math.nan},
        {"command": "replay", "speed": 0},
        {"command": "drop", "track_id": 12345},
        {"command": "drop"},
        {"command": "dance"},
    ):
        assert not player.command(wrong)["ok"]


def test_a_session_file_is_played_and_set_back(tmp_path, capsys):
    path = tmp_path / "session.pcap"
    session = Session({"radar": [{"name": "A", "position_deg": [54.0, 10.0], "period_s": 2.5}]})
    recorder = Recorder(path, session.config.as_document())
    recorder.begin(1.7e9)
    rng = np.random.default_rng(3)
    for turn in range(40):
        lines = b"".join(
            json.dumps(
                {"radar": "A", "time_s": 1.7e9 + 2.5 * turn + 0.4 * k, "range_m": 900.0 + 100 * k
                 + 8.0 * turn + rng.normal(0, 3), "bearing_rad": 0.5 * k}
            ).encode() + b"\n"
            for k in range(4)
        )  # fmt: skip
        recorder.data(1.7e9 + 2.5 * turn + 2.0, "plots", "udp://127.0.0.1:9", lines)
    recorder.close()
    player = SessionPlayback(path)
    player.go_to(player.end_s)
    last = player.picture()
    assert last["tracks"]
    player.go_to(player.start_s)
    assert player.picture()["tracks"] == []
    player.go_to(player.end_s)
    assert same(player.picture(), last)
    lines = tmp_path / "again.jsonl"
    command = ["live", "--replay", str(path), "--web", "0", "--speed", "max", "--quiet"]
    assert main([*command, "--for", "1.5", "--out", f"file:{lines}"]) == 0
    assert "http://127.0.0.1:" in capsys.readouterr().out
    assert b'"type":"track"' in lines.read_bytes()


def test_the_time_that_a_setting_takes_is_not_played():
    player = recorded_plots()
    go_to, wanted_s = player.go_to, player.start_s + 100.0

    def slow(time_s):
        go_to(time_s)
        if time_s == wanted_s:
            time.sleep(1.0)

    player.go_to = slow
    player.start()
    try:
        assert player.command({"command": "replay", "time_s": wanted_s})["ok"]
        time.sleep(0.25)
        assert 0.0 < player.time_s - wanted_s < 0.9
    finally:
        player.close()


def test_no_target_is_acquired_in_an_exclusion_zone():
    player = recorded_plots()
    around = [[-1e5, -1e5], [-1e5, 1e5], [1e5, 1e5], [1e5, -1e5]]
    assert player.command({"command": "zone", "zone": {"kind": "land", "outline_m": around}})["ok"]
    player.go_to(player.end_s)
    assert player.picture()["tracks"] == []


def test_view_and_demo_serve_the_screen(tmp_path, capsys):
    path = tmp_path / "tracks.csv"
    wl.recording.write_tracks(path, wl.track_recording("joyride"))
    for command in (["view", str(path), "--alarms", str(tmp_path / "alarms.csv")], ["demo"]):
        assert main([*command, "--web", "0", "--no-browser", "--for", "0.3"]) == 0
        assert "http://127.0.0.1:" in capsys.readouterr().out
    assert (tmp_path / "alarms.csv").exists()
    (tmp_path / "empty.csv").write_text("time_s\n")
    for wrong in (
        ["view", str(tmp_path / "empty.csv")],
        ["view", str(tmp_path / "nothing.pcap")],
        ["view", str(path), "--web", "everywhere"],
        ["view", str(path), "--speed", "0"],
    ):
        assert main([*wrong, "--no-browser", "--for", "0.1"]) == 2
        assert capsys.readouterr().err.count("\n") == 1
