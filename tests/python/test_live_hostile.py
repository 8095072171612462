"""Clocks, senders and peers of a live session that are not as they should be."""

import math
import socket

import numpy as np
import pytest

import wakeline as wl
from test_live_outputs import TARGETS, ashore, block, of_day, plot_048, rotating
from test_live_service import opened, until
from wakeline.live import network

MIDNIGHT_S = 86400.0 * 20_600
PERIOD_S, TURNS = 2.5, 16
TCP_REPAIR = 19  # of Linux: a socket is closed without a word to its peer


def tracked(clock=lambda t: t, begin_s=1.75e9):
    """A session with a radar of another clock; the events of its tracks."""
    session, events = ashore(), []
    session.listeners.append(lambda kind, one: events.append(one) if kind == "event" else None)
    rotating(session, PERIOD_S, clock, begin_s=begin_s, turns=TURNS)
    return session, [one for one in events if one.get("event") in ("confirmed", "lost")]


def check_tracks(session, events, within_m=30.0):
    """Each target has had one track, which is where the target is."""
    tracks, end_s = session.tracker.tracks(), TURNS * PERIOD_S
    assert len(tracks) == len(TARGETS)
    assert [one["event"] for one in events] == ["confirmed"] * len(TARGETS)
    for place, speed in TARGETS.values():
        at = place + end_s * speed
        off_m = min(math.hypot(one.north_m - at[0], one.east_m - at[1]) for one in tracks)
        assert off_m < within_m


def test_midnight_is_a_time_like_others():
    check_tracks(*tracked(begin_s=MIDNIGHT_S - 20.0))


@pytest.mark.parametrize("repeats", [True, False])
def test_a_leap_second_costs_no_track(repeats):
    """A clock that counts it shows a second twice, or one of 86401 s, and is then behind ours."""

    def clock(t):
        if t < MIDNIGHT_S:
            return t
        counted = t - 1.0
        return counted if repeats or t >= MIDNIGHT_S + 1.0 else MIDNIGHT_S - 1e-3

    session, events = tracked(clock, MIDNIGHT_S - 20.0)
    check_tracks(session, events)
    assert session.status()["late"]["too_late_inputs"] == 0


@pytest.mark.parametrize("off_s", [3 * 3600.0, -12 * 3600.0, 4.0])
def test_a_clock_that_is_off_from_the_start_costs_no_track(off_s):
    session, events = tracked(lambda t: t + off_s)
    check_tracks(session, events)
    corrected_s = session.status()["radars"]["A"]["clock_offset_s"]
    assert corrected_s == (0.0 if off_s == 4.0 else pytest.approx(-off_s, abs=0.1))


@pytest.mark.parametrize("off_s", [3 * 3600.0, -3 * 3600.0])
def test_a_clock_that_is_set_wrong_is_followed_after_10_s(off_s):
    """Data in the future count as of now, those in the past as late, until then."""
    session, events = tracked(lambda t: t + off_s * (t > 1.75e9 + 15.0))
    assert len(session.tracker.tracks()) == len(TARGETS)
    assert len([one for one in events if one["event"] == "confirmed"]) <= 2 * len(TARGETS)
    too_late = session.status()["late"]["too_late_inputs"]
    assert (too_late > 0) == (off_s < 0)
    assert too_late <= 33 * (10.0 / PERIOD_S + 1)


def test_the_clock_of_one_radar_does_not_disturb_another():
    def session(off_s):
        radars = [{"name": name, "position_deg": [54.0, 10.0]} for name in "AB"]
        inputs = [{"url": f"udp://127.0.0.1:1?name={name}", "radar": name} for name in "AB"]
        one = wl.live.Session({"radar": radars, "input": inputs})
        for k in range(60):
            t = 1.75e9 + 2.0 * k
            for name, range_m, its_s in (("A", 2000.0 - 8.0 * k, t), ("B", 9000.0, t + off_s)):
                one.feed(t, name, plot_048(its_s, range_m, 1.0))
                one.feed(t, name, block(34, b"\xe0\x01\x02\x01" + of_day(its_s)))
        return one

    right, wrong = (
        [track for track in session(off_s).tracker.tracks() if track.north_m < 3000.0]
        for off_s in (0.0, 5 * 3600.0)
    )
    assert repr(right) == repr(wrong)


def test_weeks_that_a_receiver_counts_wrongly_do_not_matter():
    """A date 1024 weeks back, in JSON lines and in RMC."""
    session = wl.live.Session({"radar": [{"name": "A", "period_s": 2.0}]})
    for k in range(40):
        t = 1.75e9 + 2.0 * k
        body = f"GPRMC,{k % 60:06d},A,5400.00,N,01000.00,E,0.0,0.0,150305,,".encode()
        session.feed(t, "boat", b"$%s*%02X\r\n" % (body, np.bitwise_xor.reduce(list(body))))
        its_s = t - 1024 * 7 * 86400.0
        for line in (
            b'{"time_s":%f,"range_m":%f,"bearing_rad":1}' % (its_s, 2000.0 - 10.0 * k),
            b'{"sector":{"from_rad":0,"to_rad":6.283185307179586,"time_s":%f}}' % its_s,
        ):
            session.feed(t, "radar", line)
    (track,) = session.tracker.tracks()
    assert track.speed_mps == pytest.approx(5.0, abs=0.5)
    assert track.time_s == pytest.approx(t)
    assert session.status()["own"]["position"]["sources"][0]["count"] == 40


def test_of_two_radars_on_one_group_the_first_counts():
    """The other is named; it starts no track and gives the first no sector."""
    alone, both = ashore(), ashore()

    class Doubled:
        """Feeds what another radar at the same input sends, too."""

        def feed(self, t, name, octets):
            both.feed(t, name, octets)
            both.feed(t, name, octets[:5] + b"\x09" + octets[6:])

    rotating(alone, PERIOD_S, turns=12)
    rotating(Doubled(), PERIOD_S, turns=12)
    assert repr(alone.tracker.tracks()) == repr(both.tracker.tracks()) != "[]"
    status = both.status()
    assert status["inputs"]["a"]["problems"].keys() == {"other radar"}
    assert "(1, 9)" in status["inputs"]["a"]["last_problem"]
    assert status["radars"]["A"]["sectors"] == alone.status()["radars"]["A"]["sectors"]


GROUP = "udp://239.1.1.1:8600"


@pytest.mark.parametrize("first", [7, 8])
@pytest.mark.parametrize(
    ("inputs", "sources"),
    [
        ([f"{GROUP}?sac_sic=25/7&radar=A", f"{GROUP}?sac_sic=025/008&radar=B"], ("", "")),
        ([GROUP], ("25/7", "25/8")),
        ([f"{GROUP}?name=a&radar=A", f"{GROUP}?name=b&radar=B"], ("25/7", "25/8")),
    ],
)
def test_radars_on_one_group_are_distinguished_by_their_sources(inputs, sources, first):
    """By the source that an input takes, or by that of each radar."""
    radars = [
        {"name": name, "position_deg": [54.0 + 0.1 * k, 10.0], "sac_sic": sources[k]}
        for k, name in enumerate("AB")
    ]
    session = wl.live.Session({"input": [{"url": url} for url in inputs], "radar": radars})
    for turn in range(10):
        t = 1e6 + 2.5 * turn
        time = round(128.0 * (t % 86400.0)).to_bytes(3, "big")
        for system in (first, 15 - first):
            source = bytes([25, system])
            plot = b"\x30\x00\x0e\xf0" + source + time + b"\x20\x02\x29\x20" + bytes([system])
            mark = b"\x22\x00\x0c\xe8" + source + b"\x01" + time + b"\x01\x40"
            for name in session.inputs:
                session.feed(t + 0.1, name, plot)
                session.feed(t + 0.1, name, mark)
    status = session.status()
    assert [one["plots"] for one in status["radars"].values()] == [10, 10]
    assert [one["problems"] for one in status["inputs"].values()] == [{}] * len(inputs)
    assert len(session.picture()["tracks"]) == 2


def test_a_peer_that_vanishes_is_found_gone(monkeypatch):
    """A connection of which no end was sent ends by probes: at an input and at an output."""
    monkeypatch.setattr(network, "PROBES", {"TCP_KEEPIDLE": 1, "TCP_KEEPINTVL": 1})
    one = opened("tcp-listen://127.0.0.1:0?name=in", lambda name, messages: None)
    other = network.NetworkOutput(wl.live.OutputConfig("tcp-listen://127.0.0.1:0"))
    other.start()
    peers = [socket.create_connection(("127.0.0.1", port)) for port in (one.port, other.port)]
    until(lambda: "1 connected" in one.connection and "1 connected" in other.connection)
    try:
        for peer in peers:
            peer.setsockopt(socket.IPPROTO_TCP, TCP_REPAIR, 1)
    except OSError:
        pytest.skip("only root of Linux can let a peer vanish")
    finally:
        for peer in peers:
            peer.close()
    until(lambda: "0 connected" in one.connection and "0 connected" in other.connection)
    for each in (one, other):
        each.close()
        each.join()
