"""What a session sends, as its receivers read it."""

import json
import math

import numpy as np
import pytest

import wakeline as wl
from wakeline.live.demo import rmc

ORIGIN_DEG = (54.0, 10.0)
PLANE = wl.LocalPlane(latitude_rad=math.radians(54.0), longitude_rad=math.radians(10.0))
TARGETS = {
    "ahead": (np.array([2500.0, 300.0]), np.array([-3.0, 1.0])),
    "aside": (np.array([-900.0, 2100.0]), np.array([4.0, 4.0])),
    "still": (np.array([800.0, -1700.0]), np.array([0.0, 0.0])),
}
RADAR = {"name": "A", "range_std_m": 2.0, "bearing_std_deg": 0.05, "extent_std_m": 1.0}


def degrees_of(position_m):
    latitude, longitude = PLANE.place(position_m)
    return math.degrees(float(latitude)), math.degrees(float(longitude))


def turning_ship(t):
    """Position and velocity of own ship at 30 kn, turning 10 degrees a second."""
    speed, rate = 15.43, math.radians(10.0)
    radius = speed / rate
    position = radius * np.array([math.sin(rate * t), 1.0 - math.cos(rate * t)])
    return position, speed * np.array([math.cos(rate * t), math.sin(rate * t)])


def run(fmt, seconds=90.0, gone_s=math.inf):
    """What is sent in a session, as (time, octets, last fix of own ship)."""
    config = {
        "radar": [RADAR | {"period_s": 2.5}],
        "own": {"position_std_m": 0.5},
        "session": {"origin_deg": ORIGIN_DEG},
    }
    session, sent, begin_s = wl.live.Session(config), [], 1.75e9
    output = session.add_output(f"udp://127.0.0.1:1?format={fmt}")
    fix_m = None
    output.send = lambda octets: sent.append((session.time_s - begin_s, octets, fix_m))
    rng = np.random.default_rng(0)
    for k in range(int(seconds * 10)):
        t = 0.1 * k
        position, velocity = turning_ship(t)
        if k % 10 == 0:
            fix_m = position
            session.feed(begin_s + t, "gnss", rmc(begin_s + t, *degrees_of(position), velocity))
        if k % 25 == 24:
            for place, speed in TARGETS.values():
                if t > gone_s:
                    continue
                seen = place + t * speed - position
                plot = {
                    "time_s": begin_s + t,
                    "range_m": float(np.hypot(*seen) + rng.normal(0.0, 1.0)),
                    "bearing_rad": float(math.atan2(seen[1], seen[0]) + rng.normal(0.0, 0.0003)),
                }
                session.feed(begin_s + t, "radar", json.dumps(plot).encode())
            mark = {"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": begin_s + t}}
            session.feed(begin_s + t, "radar", json.dumps(mark).encode())
    return sent, session


def fields_of(sentence):
    body, _, digits = sentence.strip().decode()[1:].partition("*")
    checksum = 0
    for octet in body.encode():
        checksum ^= octet
    assert int(digits, 16) == checksum
    assert len(sentence) <= 82
    return body.split(",")


def test_ttm_puts_every_target_where_it_is_for_a_ship_that_turns():
    sent, _ = run("ttm")
    times, off_m, numbers = {}, [], set()
    for t, octets, fix_m in sent:
        fields = fields_of(octets)
        if fields[0] != "RATTM" or fields[12] != "T":
            continue
        numbers.add(fields[1])
        times.setdefault(fields[1], []).append(t)
        assert fields[4] == fields[7] == "T" or fields[7] == "T"
        range_m, bearing_rad = 1852.0 * float(fields[2]), math.radians(float(fields[3]))
        place = fix_m + range_m * np.array([math.cos(bearing_rad), math.sin(bearing_rad)])
        off_m.append(min(np.hypot(*(place - at - t * speed)) for at, speed in TARGETS.values()))
    assert len(numbers) == 3
    assert all(0 <= int(number) <= 99 for number in numbers)
    assert max(off_m) < 10.0
    for each in times.values():
        assert np.diff(each).min() > 2.4


@pytest.mark.parametrize("own", [{}, {"velocity": True}, {"place_deg": ORIGIN_DEG}])
def test_without_the_velocity_of_own_ship_nothing_is_made_up(own):
    """Neither its speed nor closest approaches, also when its position is lost; ashore it is 0."""
    moves = own.pop("velocity", False)
    session = wl.live.Session({"radar": [RADAR | {"period_s": 2.5}], "own": own})
    output, sent = session.add_output("udp://127.0.0.1:1?format=ttm"), []
    output.send = lambda octets: sent.append((session.time_s, fields_of(octets)))
    place = dict(zip(("latitude_deg", "longitude_deg"), ORIGIN_DEG, strict=True))
    velocity = {"course_rad": 0.0, "speed_mps": 5.0} if moves else {}
    session.feed(0.0, "gnss", json.dumps({"own": place | velocity}).encode())
    for k in range(30):
        time_s = 0.3 * k
        plot = {"time_s": time_s, "range_m": 900.0 - 2.0 * k, "bearing_rad": 1.0}
        mark = {"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": time_s}}
        for line in (plot, mark):
            session.feed(time_s, "radar", json.dumps(line).encode())
    for time_s in range(9, 60):
        session.feed(float(time_s), "clock", b"")
    is_known = {True: [], False: []}
    for time_s, fields in sent:
        needing = fields[8:10] if fields[0] == "RATTM" else fields[5:7]
        is_known[time_s > 10.0].append("" not in needing)
    assert set(is_known[False]) == {moves or bool(own)}
    assert set(is_known[True]) == {bool(own)}


def test_a_lost_target_is_reported_once():
    sent, session = run("ttm", seconds=200.0, gone_s=60.0)
    assert session.tracker.tracks() == []
    lost = [fields_of(octets)[1] for _, octets, _ in sent if b",L," in octets]
    assert sorted(lost) == sorted(set(lost))
    assert len(lost) == 3


def test_near_targets_take_the_numbers_of_far_ones_and_the_rest_are_counted():
    """TTM has a hundred numbers, tracks of ASTERIX have more."""
    session = wl.live.Session(
        {"radar": [RADAR | {"period_s": 2.5}], "own": {"place_deg": ORIGIN_DEG}}
    )
    outputs = [
        session.add_output(f"udp://127.0.0.1:1?name={f}&format={f}") for f in ("ttm", "cat062")
    ]
    far = [(5000.0 + 100.0 * (k % 7), 0.06 * k) for k in range(100)]
    near = [(1000.0 + 50.0 * k, 0.25 * k) for k in range(25)]
    lost = []
    outputs[0].send = lambda octets: lost.append(octets) if b",L," in octets else None
    for turn in range(50):
        time_s = 2.5 * turn
        lines = [
            {"time_s": time_s, "range_m": range_m, "bearing_rad": bearing_rad}
            for range_m, bearing_rad in far + near * (turn >= 10)
        ]
        lines.append({"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": time_s}})
        for line in lines:
            session.feed(time_s, "radar", json.dumps(line).encode())
        if turn == 9:
            assert [output.status()["waiting"] for output in outputs] == [5, 0]
    shown = session.shown
    assert len(shown) == 125
    assert [output.status()["waiting"] for output in outputs] == [30, 0]
    is_near = np.hypot(shown.mean[:, 0], shown.mean[:, 2]) < 3000.0
    assert np.isin(shown.track_id[is_near], list(outputs[0]._feed.numbers)).all()
    assert len(lost) == 25


def test_a_target_that_the_operator_acquires_has_q_and_no_motion_until_it_has_plots():
    session = wl.live.Session(
        {"radar": [RADAR | {"period_s": 2.5}], "own": {"place_deg": ORIGIN_DEG}}
    )
    sent = []
    session.add_output("udp://127.0.0.1:1?format=ttm").send = sent.append
    alarms = session.watchers[0].alarms
    for turn in range(40):
        time_s = 2.5 * turn
        bearings_rad = [1.0] * (turn < 30) + [2.0] * (15 <= turn < 30)
        lines = [{"time_s": time_s, "range_m": 900.0, "bearing_rad": one} for one in bearings_rad]
        lines.append({"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": time_s}})
        for line in lines:
            session.feed(time_s, "radar", json.dumps(line).encode())
        if turn == 12:
            place = {"north_m": 900.0 * math.cos(2.0), "east_m": 900.0 * math.sin(2.0)}
            acquired = session.command({"command": "acquire"} | place)["track_id"]
        if turn < 17:
            assert not any(acquired in alarm.tracks for alarm in alarms.active if turn > 12)
    rows = [fields_of(one) for one in sent if b"TTM" in one]
    by_operator = [row for row in rows if float(row[3]) > 100.0]
    others = [row for row in rows if float(row[3]) < 100.0]
    assert {row[15] for row in by_operator} == {"M"}
    assert {row[15] for row in others} == {"A"}
    assert list(dict.fromkeys(row[12] for row in by_operator)) == ["Q", "T", "L"]
    assert list(dict.fromkeys(row[12] for row in others)) == ["T", "L"]
    for row in by_operator:
        motion = {row[k] != "" for k in (5, 6, 8)}
        assert motion == {row[12] != "Q"}


def test_pynmea2_reads_every_sentence():
    pynmea2 = pytest.importorskip("pynmea2")
    sent, _ = run("ttm", 60.0)
    kinds = {type(pynmea2.parse(octets.decode().strip(), check=True)) for _, octets, _ in sent}
    assert {kind.__name__ for kind in kinds} == {"TTM", "OSD"}


@pytest.mark.parametrize(("fmt", "category"), [("cat062", 62), ("cat010", 10)])
def test_asterix_datagrams_are_whole(fmt, category):
    sent, _ = run(fmt, 60.0)
    assert len(sent) > 10
    for _, octets, _ in sent:
        assert octets[0] == category
        assert int.from_bytes(octets[1:3], "big") <= len(octets) <= 1400


def test_what_was_sent_as_cat010_is_read_as_plots_or_left_out():
    sent, _ = run("cat010", 60.0)
    session = wl.live.Session({"radar": [RADAR | {"position_deg": ORIGIN_DEG}]})
    for t, octets, _ in sent:
        session.feed(1.75e9 + t, "in", octets)
    assert session.status()["inputs"]["in"]["problems"] == {}


# ------------------------------------------------------------------ categories 048 and 034 in


def block(category, record):
    return bytes([category]) + (len(record) + 3).to_bytes(2, "big") + record


def of_day(t):
    return round(t % 86400.0 * 128.0).to_bytes(3, "big")


def plot_048(t, range_m, bearing_rad):
    polar = (
        round(range_m / 1852.0 * 256.0),
        round(bearing_rad % math.tau / math.tau * 65536) % 65536,
    )
    words = b"".join(value.to_bytes(2, "big") for value in polar)
    return block(48, b"\xf0\x01\x02" + of_day(t) + b"\x20" + words)


def sector_034(t, azimuth_rad):
    azimuth = round(azimuth_rad / math.tau * 256.0) % 256
    return block(34, b"\xf0\x01\x02\x02" + of_day(t) + bytes([azimuth]))


def north_034(t):
    return block(34, b"\xe0\x01\x02\x01" + of_day(t))


def rotating(session, period_s, clock=lambda t: t, *, twice=False, begin_s=1.75e9, turns=30):
    """Feed a radar ashore that marks 32 sectors a turn; its clock shows another time than it is."""
    for k in range(turns * 32):
        t = k / 32.0 * period_s
        its_s = clock(begin_s + t)
        azimuth = k % 32 / 32.0 * math.tau
        messages = [north_034(its_s)] if k % 32 == 0 else []
        for place, speed in TARGETS.values():
            seen = place + t * speed
            bearing = math.atan2(seen[1], seen[0]) % math.tau
            if 0.0 <= (azimuth - bearing) % math.tau < math.tau / 32.0:
                range_m = float(np.hypot(*seen))
                messages.append(plot_048(its_s, range_m, bearing))
        messages.append(sector_034(its_s, azimuth))
        for message in messages:
            session.feed(begin_s + t, "a", message)
            if twice:
                session.feed(begin_s + t, "b", message)


def ashore(**radar):
    inputs = [{"url": f"udp://127.0.0.1:1?name={name}"} for name in "ab"]
    one = RADAR | {"position_deg": ORIGIN_DEG, "period_s": 2.5, "range_std_m": 5.0} | radar
    return wl.live.Session({"input": inputs, "radar": [one]})


@pytest.mark.parametrize("off_s", [0.0, 3 * 3600.0])
def test_plots_of_category_048_are_tracked_sector_by_sector(off_s):
    session = ashore()
    rotating(session, 2.5, lambda t: t + off_s)
    status = session.status()
    assert status["inputs"]["a"]["problems"] == {}
    assert status["radars"]["A"]["sectors"] > 900
    tracks = session.tracker.tracks()
    assert len(tracks) == 3
    end_s = 30.0 * 2.5
    for place, speed in TARGETS.values():
        at = place + end_s * speed
        assert min(math.hypot(one.north_m - at[0], one.east_m - at[1]) for one in tracks) < 30.0


def test_category_048_by_two_groups_counts_once():
    once, both = ashore(), ashore()
    rotating(once, 2.5)
    rotating(both, 2.5, twice=True)
    assert [one.mean for one in both.tracker.tracks()] == [
        one.mean for one in once.tracker.tracks()
    ]
    assert both.status()["inputs"]["b"]["duplicates"] > 900


@pytest.mark.parametrize("silence_s", [8.0, 14.0, 20.0])
def test_no_target_ends_because_a_radar_is_silent(silence_s):
    """Vessels that are still there when it turns again; one that is not is lost then."""
    session = wl.live.Session(
        {"session": {"origin_deg": [54.0, 10.0]}, "own": {"place_deg": [54.0, 10.0]}}
    )
    ended, back_s = [], 100.0 + silence_s
    output = session.add_output("udp://127.0.0.1:1?format=ttm")
    output.send = lambda octets: ended.append(session.time_s) if b",L," in octets else None
    shown = set()
    for k in range(800):
        t = 0.25 * k
        session.feed(t, "clock", b"")
        if k % 10 or 100.0 <= t < back_s:
            shown |= {len(session.shown)} if 60.0 < t < back_s + 8.0 else set()
            continue
        for bearing_rad in (0.5, 2.0, 4.0) if t < back_s else (0.5, 2.0):
            plot = {"time_s": t, "range_m": 1500.0, "bearing_rad": bearing_rad}
            session.feed(t, "radar", json.dumps({"radar": "A", **plot}).encode())
        mark = {"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}}
        session.feed(t, "radar", json.dumps({"radar": "A", **mark}).encode())
    assert shown == {3}
    assert len(ended) == 1
    assert ended[0] > back_s + 5.0
