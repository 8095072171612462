"""A live session without network: what it is fed decides its tracks, bit for bit."""

import csv
import itertools
import json
import math
import re
import shutil
import subprocess
import time
from functools import reduce
from operator import xor
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from test_cli_navigate import sentence as sentence_of
from wakeline._engine.video import Cat240Encoder
from wakeline.extraction.plots import Extraction
from wakeline.extraction.turns import Turn
from wakeline.live.ais import AisPicture
from wakeline.live.asterix_feed import BlockAssembly
from wakeline.live.config import InputConfig, config_of
from wakeline.live.lines import LineAssembly
from wakeline.live.nmea import AisMessage, NmeaDecoder
from wakeline.live.own_ship import Missing, OwnShipSources, SourceKey
from wakeline.live.problems import Problems
from wakeline.live.recognition import format_in_stream
from wakeline.live.sources import Source
from wakeline.live.video_feed import Sweeps, VideoFeed
from wakeline.recording import RadarVideo
from wakeline.tracking.settings import SettingsError
from wakeline.wire import SensorClock

HALO = Path(__file__).parents[1] / "data" / "halo_udp10110" / "udp10110.csv"
JOYRIDE = {"name": "A", "range_std_m": 6.0, "bearing_std_deg": 0.3, "extent_std_m": 6.5}
SMALL = {"max_tracks": 20, "max_plots": 200}
HDT = SourceKey("HDT", "GP", "x")
HDM = SourceKey("HDM", "GP", "x")


def halo():
    with HALO.open() as file:
        return [(float(row["time_s"]), row["sentence"].encode()) for row in csv.DictReader(file)]


def joyride_lines(count=None):
    """The bundled recording as JSON lines, with their times."""
    episode = wl.recording.load("joyride").episodes[0]
    for scan in episode.scans[:count]:
        t = scan.time_s
        own = {"north_m": float(scan.own_north_m[0]), "east_m": float(scan.own_east_m[0])}
        yield t, {"own": own}
        for range_m, bearing_rad in zip(scan.range_m, scan.bearing_rad, strict=True):
            plot = {"time_s": t, "range_m": float(range_m), "bearing_rad": float(bearing_rad)}
            yield t, {"radar": "A"} | plot
        yield t, {"radar": "A", "sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}}


def joyride_session():
    return wl.live.Session({"radar": [JOYRIDE | {"period_s": 2.5, "max_speed_mps": 25.0}]})


def written(session):
    lines = []
    session.add_output("file:tracks.jsonl").send = lines.append
    return lines


# ------------------------------------------------------------------ tracks


def test_two_outputs_have_different_names():
    session = joyride_session()
    output = session.add_output("file:tracks.jsonl")
    with pytest.raises(SettingsError, match=re.escape("file:tracks.jsonl")):
        session.add_output("file:tracks.jsonl?format=ttm")
    assert session.outputs == {"file:tracks.jsonl": output}


def test_plots_as_json_lines_give_the_track_of_the_recording():
    session, whole = joyride_session(), wl.track_recording("joyride")
    lines = written(session)
    for t, line in joyride_lines():
        session.feed(t, "plots", json.dumps(line).encode())
    rows = [json.loads(line) for line in lines]
    tracks = [row for row in rows if row["type"] == "track"]
    assert {row["track_id"] for row in tracks} == set(map(int, whole.ids()))
    last = tracks[-1]
    np.testing.assert_allclose([last["north_m"], last["east_m"]], whole.state[-1, [0, 2]], atol=15)


def test_lines_have_the_values_of_the_picture():
    session = wl.live.Session({"radar": [JOYRIDE], "session": {"origin_deg": [54.0, 10.0]}})
    lines, heard = written(session), []
    session.listeners.append(lambda kind, values: heard.append(values))
    for t, line in joyride_lines(60):
        session.feed(t, "x", json.dumps(line).encode())
    rows = [json.loads(line) for line in lines]
    assert len(rows) == len(heard) > 30
    for row, values in zip(rows, heard, strict=True):
        assert row.keys() - {"version", "type"} == values.keys() - {"type"}
        for name in ("north_m", "latitude_deg", "range_m", "speed_mps", "track_id"):
            if name in values:
                assert row[name] == pytest.approx(values[name], rel=1e-6, abs=1e-3)
        if "covariance" in values:
            np.testing.assert_allclose(row["covariance"], values["covariance"], rtol=1e-6)


def test_lines_are_json_of_what_the_tracker_has():
    session = wl.live.Session({"radar": [JOYRIDE], "session": {"origin_deg": [54.0, 10.0]}})
    lines = written(session)
    scans = list(joyride_lines(60))
    for t, line in scans[: len(scans) // 2]:
        session.feed(t, "x", json.dumps(line).encode())
    name = 'Å "one"\t\\'
    for track in session.tracker.tracks():
        named = {"command": "rename", "track_id": track.track_id, "name": name}
        assert session.command(named)["ok"]
    for t, line in scans[len(scans) // 2 :]:
        session.feed(t, "x", json.dumps(line).encode())
    rows = {row["track_id"]: row for row in map(json.loads, lines) if row["type"] == "track"}
    table = session.tracker.table()
    assert len(table) > 0
    for k, track_id in enumerate(table.track_id.tolist()):
        row = rows[track_id]
        assert (row["status"], row["name"]) == (table.status[k], table.name[k])
        assert [row["hits"], row["misses"]] == [table.hits[k], table.misses[k]]
        state = [row[key] for key in ("north_m", "vnorth_mps", "east_m", "veast_mps")]
        np.testing.assert_allclose(state, table.mean[k], atol=1e-3)
        np.testing.assert_allclose(row["covariance"], table.covariance[k], rtol=1e-6)
        np.testing.assert_allclose(row["mode_probability"], table.mode_probability[k], atol=1e-5)
        nis = [row["nis"][key] for key in ("mean", "lower", "upper")]
        np.testing.assert_allclose(nis, [table.mean_nis[k], *table.mean_nis_bounds[k]], atol=1e-3)
        whiteness = [row["whiteness"][key] for key in ("value", "bound")]
        expected = [table.whiteness[k], table.whiteness_bound[k]]
        np.testing.assert_allclose(whiteness, expected, atol=1e-3)
        assert row["identity_time_s"] is None
    assert name in {row["name"] for row in rows.values()}
    modes = session.status()["modes"]
    assert tuple(modes) == wl.tracking.MODE_NAMES
    assert all(one["lower"] < 2.0 < one["upper"] for one in modes.values())


def test_a_session_fed_twice_gives_the_same_lines():
    def lines():
        session = joyride_session()
        out = written(session)
        for t, line in joyride_lines(60):
            session.feed(t, "plots", json.dumps(line).encode())
        return out

    assert lines() == lines() != []


def assert_same_tracks(one, other):
    for session in (one, other):
        session.correct()
    assert len(one.tracker.tracks())
    assert repr(one.tracker.tracks()) == repr(other.tracker.tracks())


@pytest.mark.parametrize("most_turns", [0.3, 2.0])
def test_scans_that_come_up_to_two_turns_late_give_the_tracks_of_time(most_turns):
    """Own ship moves, and its readings come in time."""
    scans, own = {}, []
    for t, line in joyride_lines(80):
        (own if "own" in line else scans.setdefault(t, [])).append((t, line))
    rng = np.random.default_rng(3)
    in_order, late, lines = joyride_session(), joyride_session(), []
    for session, delay_s in ((in_order, 0.0), (late, 2.5 * most_turns)):
        arrivals = [(t, json.dumps(line)) for t, line in own]
        for t, each in scans.items():
            text = "\n".join(json.dumps(line) for _, line in each)
            arrivals.append((t + rng.uniform(0.0, delay_s), text))
        lines.append(written(session))
        for t, text in sorted(arrivals, key=lambda one: one[0]):
            session.feed(t, "x", text.encode())
    assert_same_tracks(late, in_order)
    assert late.status()["late"]["too_late_inputs"] == 0
    assert (late.status()["late"]["late_inputs"] > 0) == (most_turns > 1.0)
    assert len(lines[1]) <= 2 * len(lines[0])  # corrections report only what they have changed


def test_what_a_held_up_connection_delivers_at_once_is_put_in_its_place():
    """Two radars ashore; the second comes over a line that stops for 8 s."""
    sessions = [wl.live.Session({"radar": two_radars()}) for _ in range(2)]
    for session, held_up in zip(sessions, (False, True), strict=True):
        waiting = []
        for k in range(60):
            t = 2.0 * k
            for name in "AB":
                text = "\n".join(map(json.dumps, turn_of(name, t)))
                if held_up and name == "B" and 20 <= k < 24:
                    waiting.append(text)
                    continue
                for each in [*waiting, text] if name == "B" else [text]:
                    session.feed(t, name, each.encode())
                waiting = [] if name == "B" else waiting
    assert_same_tracks(*sessions)
    assert sessions[1].status()["late"]["late_inputs"] == 4


def two_radars():
    return [JOYRIDE | {"name": n, "position_deg": [54.0, 10.0], "period_s": 2.0} for n in "AB"]


def turn_of(radar, t):
    """Two vessels in a turn of a radar, and its mark."""
    for k, range_m in enumerate((2000.0 - 5.0 * t, 1500.0 + 3.0 * t)):
        yield {"radar": radar, "time_s": t, "range_m": range_m, "bearing_rad": 0.7 + 2.0 * k}
    yield {"radar": radar, "sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}}


def test_data_from_before_the_window_are_counted_and_change_nothing():
    one, other = (wl.live.Session({"radar": two_radars()}) for _ in range(2))
    for k in range(20):
        t = 1000.0 + 2.0 * k
        for session in (one, other):
            for line in turn_of("A", t):
                session.feed(t, "A", json.dumps(line).encode())
    for line in turn_of("A", 1020.0):  # 18 s late
        other.feed(t, "A", json.dumps(line).encode())
    assert_same_tracks(one, other)
    assert other.status()["late"]["too_late_inputs"] == 1
    assert "wakeline_too_late_inputs_total 1" in other.metrics()


def test_bearings_from_the_bow_give_the_track_of_true_bearings():
    def last(azimuth, offset_rad):
        radar = JOYRIDE | {"period_s": 2.5, "max_speed_mps": 25.0, "azimuth": azimuth}
        session = wl.live.Session({"radar": [radar], "own": {"heading_std_deg": 0.0}})
        for t, line in joyride_lines(50):
            if "own" in line:
                line["own"]["heading_rad"] = offset_rad
            if "bearing_rad" in line:
                line["bearing_rad"] -= offset_rad
            session.feed(t, "x", json.dumps(line).encode())
        return session.tracker.tracks()[0].mean

    np.testing.assert_allclose(last("bow", 1.3), last("north", 0.0), atol=0.5)


def test_a_ship_that_turns_under_its_radar_sees_a_still_target_still():
    rate, period_s, target = math.radians(10.0), 2.5, np.array([1500.0, 600.0])
    radar = JOYRIDE | {"period_s": period_s, "azimuth": "bow", "forward_m": 20.0}
    session = wl.live.Session({"radar": [radar], "own": {"heading_std_deg": 0.1}})
    seen_rad, places = None, []
    for k in range(40 * 64):
        t = k / 64.0 * period_s
        heading = rate * t % math.tau
        if k % 3 == 0:
            own = {"north_m": 4.0 * t, "east_m": 0.0, "heading_rad": heading, "time_s": t}
            own |= {"course_rad": 0.0, "speed_mps": 4.0}
            session.feed(t, "own", json.dumps({"own": own}).encode())
        antenna = np.array([4.0 * t, 0.0]) + 20.0 * np.array([math.cos(heading), math.sin(heading)])
        seen = target - antenna
        bearing = (math.atan2(seen[1], seen[0]) - heading) % math.tau
        beam = k / 64.0 * math.tau % math.tau
        if seen_rad is not None and 0.0 <= (beam - bearing) % math.tau < 0.15:
            plot = {"time_s": t, "range_m": float(np.hypot(*seen)), "bearing_rad": bearing}
            session.feed(t, "radar", json.dumps(plot).encode())
            seen_rad = None
        if (beam - bearing) % math.tau > 3.0:
            seen_rad = bearing
        mark = {"from_rad": beam - math.tau / 64.0, "to_rad": beam, "time_s": t}
        session.feed(t, "radar", json.dumps({"sector": mark}).encode())
        if t > 40.0:
            places += [(one.north_m, one.east_m) for one in session.tracker.tracks()]
    assert len({one.track_id for one in session.tracker.tracks()}) == 1
    assert np.hypot(*(np.array(places) - target).T).max() < 15.0


def test_plots_without_marks_are_grouped_by_the_period():
    session = joyride_session()
    for t, line in joyride_lines():
        if "sector" not in line:
            session.feed(t, "x", json.dumps(line).encode())
    assert session.status()["radars"]["A"]["sectors"] > 100
    assert len(session.tracker.tracks()) == 1


def test_the_status_says_how_far_the_north_of_the_plane_is_off():
    session = wl.live.Session({"session": {"origin_deg": [54.0, 10.0]}})
    for t, (latitude, longitude) in enumerate([(54.0, 10.0), (55.0, 10.0), (54.0, 10.8)]):
        own = {"latitude_deg": latitude, "longitude_deg": longitude}
        session.feed(20.0 * t, "own", json.dumps({"own": own}).encode())
        off_deg = session.status()["north_off_deg"]
        north = np.array([session.to_plane(latitude + d, longitude) for d in (0.0, 1e-4)])
        along = np.diff(north, axis=0)[0]
        true_deg = -math.degrees(math.atan2(along[1], along[0]))
        assert off_deg == pytest.approx(true_deg, abs=0.02)


def test_without_a_position_tracks_are_frozen_and_the_operator_is_told():
    session = wl.live.Session()
    for t, line in joyride_lines(3):
        if "own" not in line:
            session.feed(t, "x", json.dumps(line).encode())
    assert "position" in session.status()["frozen"]
    assert session.status()["radars"]["A"]["unused_plots"] > 0


def test_a_heading_that_is_lost_is_one_alarm_until_it_is_back():
    session = wl.live.Session({"radar": [JOYRIDE | {"azimuth": "bow"}]})
    alarms = []
    session.listeners.append(
        lambda kind, event: alarms.append(event) if event.get("type") == "alarm" else None
    )
    for k in range(600):
        t = 1000.0 + 0.5 * k
        session.feed(t, "nmea", sentence_of("GPGLL,5400.000,N,01000.000,E,,A").encode())
        if not 100 <= k < 300:
            session.feed(t, "nmea", sentence_of("HEHDT,30.0,T").encode())
        mark = {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}
        if k % 5 == 0:
            session.feed(t, "radar", json.dumps({"radar": "A", "sector": mark}).encode())
        session.feed(t, "clock", b"")
    assert session.status()["inputs"]["nmea"]["problems"] == {}
    assert [(one["change"], one["text"].partition(":")[0]) for one in alarms] == [
        ("began", "own ship's heading"),
        ("ended", "own ship's heading"),
    ]
    began, ended = (one["time_s"] for one in alarms)
    assert 1050.0 < began < 1075.0
    assert 1150.0 < ended < 1170.0


def test_a_radar_ashore_needs_no_own_ship():
    session = wl.live.Session({"radar": [{"name": "A", "position_deg": [54.0, 10.0]}]})
    for k in range(20):
        t = 3.0 * k
        plot = {"time_s": t, "range_m": 2000.0 - 15.0 * k, "bearing_rad": 0.7}
        session.feed(t, "x", json.dumps(plot).encode())
        mark = {"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}}
        session.feed(t, "x", json.dumps(mark).encode())
    (track,) = session.picture()["tracks"]
    assert track["speed_mps"] == pytest.approx(5.0, abs=1.0)
    assert track["latitude_deg"] > 54.0


def turning_antenna(session, begin_s, end_s, turn_s, *, marks, sectors=16):
    """Five vessels at rest and false plots as an antenna ashore sees them, sector by sector."""
    rng = np.random.default_rng(5)
    width_rad = math.tau / sectors
    for k in range(int((end_s - begin_s) / turn_s * sectors)):
        from_rad, to_rad = k % sectors * width_rad, (k % sectors + 1) * width_rad
        plots = [(b, 2000.0 + 500.0 * b) for b in (0.3, 1.1, 2.9, 4.0, 5.5)]
        if rng.random() < 0.3:
            plots.append((rng.uniform(from_rad, to_rad), rng.uniform(500.0, 8000.0)))
        for b, range_m in sorted(plots):
            if from_rad <= b < to_rad:
                t = begin_s + (k // sectors + b / math.tau) * turn_s
                r = range_m + 5.0 * rng.normal()
                plot = {"time_s": t, "range_m": r, "bearing_rad": b}
                session.feed(t, "x", json.dumps(plot).encode())
        t = begin_s + (k + 1) / sectors * turn_s
        mark = {"sector": {"from_rad": from_rad, "to_rad": to_rad, "time_s": t}}
        session.feed(t, "x", json.dumps(mark).encode() if marks else b"")


@pytest.mark.parametrize("marks", [True, False])
@pytest.mark.parametrize("turn_s", [1.25, 5.0, 12.0, 18.0])
def test_the_period_of_the_antenna_is_found(turn_s, marks):
    session = wl.live.Session({"radar": [{"name": "A", "position_deg": [54.0, 10.0]}]})
    turning_antenna(session, 0.0, 12.0 * turn_s + 60.0, turn_s, marks=marks)
    assert session.status()["radars"]["A"]["period_s"] == pytest.approx(turn_s, rel=0.05)
    ids = {track["track_id"] for track in session.picture()["tracks"]}
    assert len(ids) == 5
    other_s = 2.4 * turn_s if turn_s < 8.0 else turn_s / 2.4
    begin_s = session.time_s
    turning_antenna(session, begin_s, begin_s + 12.0 * other_s + 90.0, other_s, marks=marks)
    assert session.status()["radars"]["A"]["period_s"] == pytest.approx(other_s, rel=0.05)
    assert {track["track_id"] for track in session.picture()["tracks"]} == ids

    again = wl.live.Session({"radar": [{"name": "A", "position_deg": [54.0, 10.0]}]})
    again.restore(session.save())
    assert again.status()["radars"]["A"]["period_s"] == session.status()["radars"]["A"]["period_s"]


def test_plots_in_an_exclusion_zone_start_no_track():
    zone = {"kind": "exclusion", "outline_m": [[-1e5, -1e5], [-1e5, 1e5], [1e5, 1e5], [1e5, -1e5]]}
    session = wl.live.Session({"radar": [JOYRIDE], "guard_zone": [zone]})
    for t, line in joyride_lines(40):
        session.feed(t, "x", json.dumps(line).encode())
    assert session.tracker.tracks() == []
    assert session.status()["radars"]["A"]["excluded_plots"] > 40


def test_a_track_that_enters_an_exclusion_zone_is_followed_and_one_that_enters_land_is_not():
    everywhere = [[-1e5, -1e5], [-1e5, 1e5], [1e5, 1e5], [1e5, -1e5]]
    hits = {}
    for kind in ("exclusion", "land"):
        session = joyride_session()
        before = 0
        for t, line in joyride_lines(120):
            tracks = session.tracker.tracks()
            if tracks and tracks[0].hits >= 10 and not before:
                before = tracks[0].hits
                zone = {"kind": kind, "outline_m": everywhere}
                assert session.command({"command": "zone", "zone": zone})["ok"]
            session.feed(t, "x", json.dumps(line).encode())
        hits[kind] = [one.hits - before for one in session.tracker.tracks()]
    assert hits["exclusion"][0] > 25
    assert hits["land"] in ([], [0])


def test_a_target_that_is_acquired_has_no_figures_before_it_has_plots():
    session = joyride_session()
    place = {"command": "acquire", "north_m": 900.0, "east_m": -200.0}
    assert not session.command(place)["ok"]  # without a radar
    for k in range(9):
        t = 2.5 * k
        plot = {"time_s": t, "range_m": math.hypot(900.0, 200.0), "bearing_rad": -0.2187}
        mark = {"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}}
        own = {"own": {"north_m": 0.0, "east_m": 0.0}}
        for line in (own, *([{"radar": "A"} | plot] if k > 4 else []), {"radar": "A"} | mark):
            session.feed(t, "x", json.dumps(line).encode())
        if k == 3:
            assert session.command(place)["ok"]
        assert all(one["manual"] for one in session.picture()["tracks"])
        shown = [(one["status"], "cpa" in one) for one in session.picture()["tracks"]]
        assert shown == (
            [] if k < 3 else [("tentative", False)] if k < 7 else [("confirmed", True)]
        )


def test_the_picture_has_the_first_sight_and_the_last_echo_of_a_track():
    session = joyride_session()
    session.feed(0.0, "x", b'{"own": {"north_m": 0.0, "east_m": 0.0}}')
    firsts, ages = set(), []
    for k in range(24):
        t = 2.5 * k
        plot = {"radar": "A", "time_s": t - 1.0, "range_m": 900.0, "bearing_rad": 1.0}
        mark = {"radar": "A", "sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}}
        own = {"own": {"north_m": 0.0, "east_m": 0.0}}
        for line in (own, *([plot] if k < 20 else []), mark):
            session.feed(t, "x", json.dumps(line).encode())
        shown = session.picture()["tracks"] if k % 3 == 0 else ()
        for track in shown:
            firsts.add(track["first_s"])
            ages.append(track["age_s"])
    (first_s,) = firsts
    assert first_s < 12.0
    last_s = 2.5 * 19 - 1.0
    assert ages == pytest.approx([1.0] * (len(ages) - 1) + [2.5 * 21 - last_s], abs=0.01)


def test_each_radar_says_why_it_is_not_used():
    radars = [JOYRIDE | {"azimuth": "bow"}, {"name": "shore", "position_deg": [54.0, 10.0]}]
    session = wl.live.Session({"radar": radars, "own": {"heading_age_s": 3.0}})
    for k in range(40):
        t, seen = 0.5 * k, set()
        own = {"latitude_deg": 54.01, "longitude_deg": 10.0}
        lines = [{"own": own | ({"heading_rad": 1.0} if t < 5.0 else {})}]
        for name in ("A", "shore"):
            mark = {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}
            lines.append({"radar": name, "sector": mark})
        for line in lines:
            session.feed(t, "x", json.dumps(line).encode())
            seen.add(session.status()["frozen"].partition(":")[0])
        if t == 8.0:
            continue  # too old from this sector on
        assert seen == ({""} if t < 8.0 else {"radar A not used"}), t
        radar = session.status()["radars"]
        assert (radar["A"]["unused_why"] == "") == (t < 8.0)
        assert radar["shore"]["unused_why"] == ""
    mark = {"from_rad": 0.0, "to_rad": math.tau, "time_s": 40.0}
    session.feed(40.0, "x", json.dumps({"radar": "shore", "sector": mark}).encode())
    assert session.status()["frozen"] == ""  # of a radar that is silent


@pytest.mark.parametrize("silence_s", [20.0, 60.0])
def test_targets_are_not_lost_while_the_radar_is_silent(silence_s):
    """Those that are not there when it has been back for some turns are, while they are held."""
    back_s = 100.0 + silence_s
    session, alarms = joyride_session(), {"lost target": [], "sensor lost": []}

    def note(kind, values):
        if values.get("type") == "alarm" and values["change"] == "began":
            alarms[values["kind"]].append((session.time_s, *values["tracks"]))

    session.listeners.append(note)
    for k in range(900):
        t = 0.25 * k
        session.feed(t, "own", json.dumps({"own": {"north_m": 0.0, "east_m": 0.0}}).encode())
        if k % 10 or 100.0 <= t < back_s:
            continue
        for bearing_rad in (0.5, 2.0, 4.0) if t < back_s else (0.5, 2.0):
            plot = {"time_s": t, "range_m": 1500.0, "bearing_rad": bearing_rad}
            session.feed(t, "radar", json.dumps(plot).encode())
        mark = {"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}}
        session.feed(t, "radar", json.dumps(mark).encode())
    assert len(alarms["sensor lost"]) == 1
    if silence_s > 30.0:
        assert alarms["lost target"] == []
        return
    ((lost_s, track_id),) = alarms["lost target"]
    assert 125.0 < lost_s < 145.0
    assert track_id not in {one.track_id for one in session.tracker.tracks()}


def test_targets_are_not_lost_while_own_ship_is():
    session, began = joyride_session(), []
    session.listeners.append(
        lambda _, values: (
            began.append((values["kind"], values["source"]))
            if values.get("change") == "began"
            else None
        )
    )
    for k in range(80):
        t = 2.5 * k
        if not 100.0 <= t < 135.0:
            session.feed(t, "own", json.dumps({"own": {"north_m": 0.0, "east_m": 0.0}}).encode())
        for bearing_rad in (0.5, 2.0, 4.0):
            plot = {"time_s": t, "range_m": 1500.0, "bearing_rad": bearing_rad}
            session.feed(t, "radar", json.dumps(plot).encode())
        mark = {"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}}
        session.feed(t, "radar", json.dumps(mark).encode())
    assert began == [("sensor lost", "own ship's position")]
    assert len(session.tracker.tracks()) == 3


def test_own_ship_that_is_lost_is_where_it_was_with_its_heading():
    session = wl.live.Session({"radar": [JOYRIDE]})
    for k in range(40):
        t = 1.0 * k
        own = {"heading_rad": 0.1 * k}
        if t < 10.0:
            own |= {"north_m": 5.0 * k, "east_m": 0.0, "speed_mps": 5.0, "course_rad": 0.0}
        session.feed(t, "own", json.dumps({"own": own}).encode())
        session.feed(
            t,
            "radar",
            json.dumps({"sector": {"from_rad": 0.0, "to_rad": 6.0, "time_s": t}}).encode(),
        )
    picture = session.picture()
    own = picture["own"]
    assert (own["lost"], own["north_m"], own["vnorth_mps"]) == (True, 45.0, None)
    assert own["heading_rad"] == pytest.approx(3.9)
    assert not picture["ashore"]


def test_zones_of_the_settings_are_where_their_corners_are_and_survive_a_restart():
    """Also where the origin is the first position; those that an operator changed, too."""
    corners = [[54.01, 9.99], [54.01, 10.01], [54.02, 10.01], [54.02, 9.99]]
    config = {
        "radar": [JOYRIDE],
        "guard_zone": [{"name": "entrance", "outline_deg": corners}],
        "zone": [{"name": "harbor", "outline_m": [[0, 0], [0, 9], [9, 9]], "cpa_limit_m": 50.0}],
    }
    session = wl.live.Session(config)
    assert session.picture()["zones"] == []
    own = {"latitude_deg": 54.0, "longitude_deg": 10.0}
    session.feed(0.0, "own", json.dumps({"own": own}).encode())
    (zone,) = session.picture()["zones"]
    places = [session.to_degrees(*corner) for corner in zone["outline_m"]]
    np.testing.assert_allclose(places, corners, atol=1e-9)
    drawn = {"outline_deg": corners, "name": "drawn"}
    assert session.command({"command": "zone", "zone": drawn})["zone"]["zone_id"] == 2
    assert session.command({"command": "zone_delete", "zone_id": 1})["ok"]
    again = wl.live.Session(config)
    again.restore(session.save())
    assert again.picture()["zones"] == session.picture()["zones"]
    assert again.command({"command": "zone", "zone": drawn})["zone"]["zone_id"] == 3


def test_a_vessel_that_reports_gives_its_track_an_identity():
    session = wl.live.Session({"radar": [JOYRIDE | {"position_deg": [54.0, 10.0]}]})
    lines = written(session)
    for k in range(40):
        t, north_m = 3.0 * k, 2000.0 - 15.0 * k
        for identity, east_m in (("257000001", 300.0), ("257000002", 1500.0)):
            bearing_rad = math.atan2(east_m, north_m)
            plot = {"time_s": t, "range_m": math.hypot(north_m, east_m), "bearing_rad": bearing_rad}
            session.feed(t, "radar", json.dumps(plot).encode())
            report = {"source": "ais", "identity": identity, "time_s": t, "north_m": north_m}
            report |= {"east_m": east_m, "course_rad": math.pi, "speed_mps": 5.0}
            if identity.endswith("1") and k > 10:
                session.feed(t, "ais", json.dumps({"report": report}).encode())
        mark = {"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}}
        session.feed(t, "radar", json.dumps(mark).encode())
    assert session.status()["inputs"]["ais"]["problems"] == {}
    identities = {one["east_m"] > 900.0: one["identity"] for one in session.picture()["tracks"]}
    assert identities == {False: "257000001", True: ""}
    rows = [json.loads(line) for line in lines]
    assert "257000001" in [row["identity"] for row in rows if row["type"] == "track"]
    (named,) = [row for row in rows if row.get("event") == "identified"]
    assert named["identity"] == "257000001"


def test_vessels_that_report_are_tracks_before_a_radar_turns():
    session = wl.live.Session({"radar": [JOYRIDE | {"position_deg": [54.0, 10.0]}]})
    lines = written(session)
    for k in range(240):
        t = 1000.0 + 0.5 * k
        if k % 12 == 0:
            report = {"source": "ais", "identity": "257000001", "time_s": t, "speed_mps": 5.0}
            report |= {"north_m": 2000.0 - 5.0 * t, "east_m": 300.0, "course_rad": math.pi}
            session.feed(t, "ais", json.dumps({"report": report}).encode())
        session.feed(t, "clock", b"")
    rows = [json.loads(line) for line in lines]
    tracks = [row for row in rows if row["type"] == "track"]
    assert len(tracks) > 10
    assert {row["identity"] for row in tracks} == {"257000001"}
    assert all(row["time_s"] >= 1000.0 for row in rows)
    assert session.command({"command": "rename", "track_id": 1, "name": "Mary"}) == {"ok": True}


def test_a_vessel_disagrees_for_as_long_as_its_reports_do():
    session = wl.live.Session({"radar": [JOYRIDE | {"position_deg": [54.0, 10.0]}]})
    for k in range(150):
        t, north_m = 3.0 * k, 4000.0 - 15.0 * k
        bearing_rad = math.atan2(300.0, north_m)
        plot = {"time_s": t, "range_m": math.hypot(north_m, 300.0), "bearing_rad": bearing_rad}
        session.feed(t, "radar", json.dumps({"radar": "A"} | plot).encode())
        speed_mps = 5.0 if t < 150.0 or t > 360.0 else 0.0
        report = {"source": "ais", "identity": "257000001", "time_s": t, "north_m": north_m}
        report |= {"east_m": 300.0, "course_rad": math.pi, "speed_mps": speed_mps}
        if k % 3 == 0:
            session.feed(t, "ais", json.dumps({"report": report}).encode())
        mark = {"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}}
        session.feed(t, "radar", json.dumps({"radar": "A"} | mark).encode())
        disagrees = [identity for _, identity, _ in session.disagreements()]
        if 165.0 < t <= 360.0:
            assert disagrees == ["257000001"], t
        if t < 150.0 or t > 440.0:
            assert disagrees == [], t


def test_operators_name_drop_and_acquire():
    session = joyride_session()
    for t, line in joyride_lines(60):
        session.feed(t, "x", json.dumps(line).encode())
    (track,) = session.tracker.tracks()
    answer = session.command({"command": "rename", "track_id": track.track_id, "name": "boat"})
    assert answer == {"ok": True}
    assert session.tracker.tracks()[0].name == "boat"
    for name, kept in (("  ", ""), (" tug ", "tug"), ("Æ" * 31, "Æ" * 15)):
        long = {"command": "rename", "track_id": track.track_id, "name": name}
        assert session.command(long) == {"ok": True, "name": kept}
        assert session.tracker.tracks()[0].name == kept
    session.command({"command": "rename", "track_id": track.track_id, "name": "boat"})
    assert session.command({"command": "drop", "track_id": track.track_id})["ok"]
    assert session.tracker.tracks() == []
    answer = session.command({"command": "acquire", "north_m": 100.0, "east_m": 2.0})
    assert answer["ok"]
    assert answer["track_id"] in [one.track_id for one in session.tracker.tracks()]


@pytest.mark.parametrize(
    "command",
    [
        {},
        {"command": "sink"},
        {"command": "drop"},
        {"command": "drop", "track_id": "x"},
        {"command": "rename", "track_id": 99, "name": "x"},
        {"command": "acquire", "north_m": math.inf, "east_m": 0.0},
        {"command": "acquire", "latitude_deg": 1.0, "longitude_deg": 1.0},
    ],
)
def test_a_wrong_command_is_answered(command):
    answer = wl.live.Session().command(command)
    assert answer["ok"] is False
    assert answer["error"]


# ------------------------------------------------------------------ own ship


def test_of_contradicting_sources_the_status_says_which_is_used_and_why():
    session = wl.live.Session()
    for t, sentence in halo():
        session.feed(t, "udp", sentence)
    own = session.status()["own"]
    assert sum(one["count"] for one in own["position"]["sources"]) == 17
    assert own["position"]["source"].startswith("BMGLL")
    assert own["heading"]["source"].startswith("BMHDT")
    (magnetic,) = [one for one in own["heading"]["sources"] if "HDM" in one["source"]]
    assert "variation" in magnetic["why_not"]
    assert len(own["velocity"]["sources"]) == 2
    for one in own.values():
        assert one["why"]
    assert session.status()["inputs"]["udp"]["problems"] == {}


@pytest.mark.parametrize(
    ("quantity", "body"),
    [
        ("position", "GPGGA,120000,,,,,0,00,,,M,,M,,"),
        ("position", "GPGGA,120000,5418.0,N,01012.0,E,0,00,,,M,,M,,"),
        ("position", "GPGGA,120000,5418.0,N,01012.0,E,7,08,1,,M,,M,,"),
        ("position", "GPGGA,120000,5418.0,N,01012.0,E,8,08,1,,M,,M,,"),
        ("position", "GPGGA,120000,0000.0,N,00000.0,E,1,08,1,,M,,M,,"),
        ("position", "GNGNS,120000,5418.0,N,01012.0,E,SN,08,1,,,,"),
        ("position", "GPGLL,5418.0,N,01012.0,E,120000,V,N"),
        ("position", "GPRMC,120000,V,,,,,,,281126,,,N"),
        ("velocity", "GPRMC,120000,V,,,,,,,281126,,,N"),
        ("velocity", "GPRMC,120000,A,5418.0,N,01012.0,E,9.0,90.0,281126,,,S"),
        ("velocity", "GPVTG,,T,,M,,N,,K,N"),
        ("heading", "HETHS,100.0,S"),
        ("heading", "HETHS,100.0,V"),
        ("heading", "HEHDT,,T"),
    ],
)
def test_an_instrument_that_has_not_measured_is_not_used_and_visible(quantity, body):
    session, texts = joyride_session(), []
    session.listeners.append(lambda _, values: texts.append(values.get("text", "")))
    for k in range(20):
        session.feed(1.0 * k, "gnss", sentence_of(body).encode())
        mark = {"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": 1.0 * k}}
        session.feed(1.0 * k, "radar", json.dumps(mark).encode())
    status = session.status()
    own = status["own"][quantity]
    assert own["source"] is None
    assert body[:5] in own["why"]
    assert [one["source"].partition("@")[0] for one in own["rejected"]] == [body[:5]]
    if quantity == "position":
        assert body[:5] in status["frozen"]
        assert any(body[:5] in text for text in texts)
    good = {"latitude_deg": 54.3, "longitude_deg": 10.2, "heading_rad": 0.1}
    good |= {"course_rad": 0.1, "speed_mps": 5.0}
    session.feed(20.0, "json", json.dumps({"own": good}).encode())
    assert body[:5] not in session.status()["own"][quantity]["why"]


def test_a_preferred_source_is_used():
    session = wl.live.Session({"own": {"position": ["CHGLL"], "velocity": ["BOVTG@udp"]}})
    for t, sentence in halo():
        session.feed(t, "udp", sentence)
    own = session.status()["own"]
    assert own["position"]["source"].startswith("CHGLL")
    assert own["velocity"]["source"].startswith("BOVTG")


def sources(**config):
    return OwnShipSources(wl.live.OwnConfig(**config))


def test_a_silent_source_is_replaced_at_once_and_comes_back_after_the_dwell():
    own = sources(variation_deg=0.0, dwell_s=10.0, heading_age_s=3.0)
    for t in np.arange(0.0, 60.0):
        own.add_magnetic(t, HDM, 1.0)
        if not 20.0 < t < 30.0:
            own.heading.add(t, HDT, (2.0,))
        own.choose(t)
        if t in (19.0, 25.0, 35.0, 45.0):
            used = str(own.heading.used.key)
            assert ("HDT" in used) == (t in (19.0, 45.0)), t


def test_heading_is_interpolated_across_north_and_predicted_with_the_rate():
    own = sources()
    for k, heading_deg in enumerate((350.0, 354.0, 358.0, 2.0, 6.0)):
        own.heading.add(0.5 * k, HDT, (math.radians(heading_deg),))
    assert math.degrees(own.heading_at(1.25)[0]) % 360.0 == pytest.approx(0.0, abs=1e-6)
    ahead, std = own.heading_at(2.5)
    assert math.degrees(ahead) == pytest.approx(10.0)
    assert std > own.heading_at(1.25)[1]
    assert own.heading_at(10.0) is None


def test_position_is_that_of_the_time_and_of_the_reference_point():
    own = sources(gnss_forward_m=10.0, position_age_s=5.0)
    for t in range(5):
        own.position.add(t, SourceKey("GGA", "GP", "x"), (8.0 * t, 0.0))
        own.heading.add(t, HDT, (0.0,))
    pose = own.at(2.5)
    assert (pose.north_m, pose.east_m) == pytest.approx((10.0, 0.0))
    assert own.at(5.0).north_m == pytest.approx(30.0)
    assert own.at(5.0).position_std_m > pose.position_std_m
    antenna = pose.antenna(-4.0, 2.0)
    assert (antenna.north_m, antenna.east_m) == pytest.approx((6.0, 2.0))
    gone = own.at(30.0)
    assert isinstance(gone, Missing)
    assert "position" in gone.reason


@pytest.mark.parametrize("off_s", [0.4, 3 * 3600.0, -86400.0 * 1024 * 7, 86399.0])
def test_a_clock_that_is_off_is_held(off_s):
    clock = SensorClock()
    times = [clock(t + off_s, t + 0.1) for t in np.arange(1.7e9, 1.7e9 + 30.0)]
    np.testing.assert_allclose(np.diff(times), 1.0, atol=1e-6)
    assert abs(times[-1] - (1.7e9 + 29.0)) < 5.0


def test_a_time_of_day_is_on_the_day_nearest_to_its_arrival():
    midnight = 86400.0 * 20_000
    clock = SensorClock()
    for t in np.arange(midnight - 3.0, midnight + 3.0, 0.25):
        assert clock(t % 86400.0, t + 0.3) == pytest.approx(t)


# ------------------------------------------------------------------ lines and AIS


def ais_lines():
    return [sentence for _, sentence in halo() if sentence.startswith(b"!")]


def messages(pieces, is_stream=True):
    pytest.importorskip("pyais")
    decoder, problems = NmeaDecoder(is_stream), Problems()
    found = [
        one.message.asdict()
        for k, piece in enumerate(pieces)
        for one in decoder.feed(0.001 * k, piece, problems)
        if isinstance(one, AisMessage)
    ]
    return found, problems


def test_ais_agrees_with_gpsdecode_line_by_line():
    if shutil.which("gpsdecode") is None:
        pytest.skip("gpsdecode is not installed")
    octets = b"\r\n".join(ais_lines()) + b"\r\n"
    done = subprocess.run(["gpsdecode", "-j"], input=octets, capture_output=True, check=True)
    theirs = [json.loads(line) for line in done.stdout.splitlines()]
    ours, problems = messages([octets])
    assert problems.count == {}
    assert len({one["mmsi"] for one in ours if one["msg_type"] != 5}) == 129
    ours = [one for one in ours if one["msg_type"] != 24]  # gpsdecode waits for its other part
    assert len(ours) == len(theirs) > 100
    same = {"speed": 0.05, "course": 0.05, "lon": 1e-6, "lat": 1e-6, "heading": 0, "mmsi": 0}
    same |= {"to_bow": 0, "to_stern": 0, "imo": 0}
    for mine, its in zip(ours, theirs, strict=True):
        assert mine["msg_type"] == its["type"]
        for key in same.keys() & its.keys() & mine.keys():
            assert mine[key] == pytest.approx(its[key], abs=same[key]), key
        for key in {"shipname", "callsign"} & its.keys() & mine.keys():
            assert mine[key].strip() == its[key].strip()


def test_bytes_cut_at_every_offset_give_the_same_messages():
    lines = [line for line in ais_lines() if line.startswith(b"!AIVDM,2")][:4] + ais_lines()[:3]
    octets = b"\r\n".join(lines) + b"\r\n"
    whole, _ = messages([octets])
    assert len(whole) == 5
    for cut in range(1, len(octets)):
        assert messages([octets[:cut], octets[cut:]])[0] == whole
    assert messages([octets[k : k + 1] for k in range(len(octets))])[0] == whole


def ais_fleet(rng, delay_s, wrong_s=0.0, lying=(), seconds=400):
    """Positions of ten vessels every tenth second: times of them and of reception, messages.

    Received so much later, by a clock that is wrong; of the lying ones the second is any.
    """
    pyais = pytest.importorskip("pyais")
    found = []
    for k in range(10):
        start, speed, course = (
            rng.uniform(-0.05, 0.05, 2),
            rng.uniform(3.0, 10.0),
            rng.uniform(0.0, 6.2),
        )
        for time_s in range(int(rng.integers(10)), seconds, 10):
            way_deg = speed * time_s / 1852.0 / 60.0
            fields = {
                "type": int(rng.choice([1, 3, 18])),
                "mmsi": 211000000 + k,
                "lat": start[0] + way_deg * np.cos(course),
                "lon": start[1] + way_deg * np.sin(course),
                "speed": speed * 3600.0 / 1852.0,
                "course": np.degrees(course),
                "second": int(rng.integers(60)) if k in lying else time_s % 60,
            }
            found.append((time_s + wrong_s, delay_s(rng, time_s) + wrong_s + time_s, fields))
    found.sort(key=lambda one: one[1])
    return [(a, b, pyais.decode(*pyais.encode_dict(fields))) for a, b, fields in found]


def ais_times(fleet):
    """How far times taken are from the true ones, and those of reception; after three of each."""
    picture, errors = AisPicture(), []
    for time_s, received_s, message in fleet:
        found = picture.add(received_s, message)
        if found is not None and found[1] and found[0].messages > 3:
            errors.append((found[0].mmsi, found[0].time_s - time_s, received_s - time_s))
    mmsi, taken, received = np.array(errors).T
    return mmsi, taken, received


def soon(rng, time_s):
    return 0.1 + rng.exponential(1.0)


@settings(max_examples=8, deadline=None)
@given(wrong_s=st.floats(-40.0, 40.0), seed=st.integers(0, 99))
def test_positions_of_ais_are_of_the_second_that_they_state(wrong_s, seed):
    fleet = ais_fleet(np.random.default_rng(seed), soon, wrong_s)
    _, taken, received = ais_times(fleet)
    assert np.std(received) > 0.8
    assert np.std(taken) < 0.4
    assert np.abs(taken - 0.1).mean() < 0.4  # as soon as the soonest


def test_positions_of_ais_that_have_waited_are_not_of_their_reception():
    def held_up(rng, time_s):
        return max(soon(rng, time_s), (200.0 - time_s) * (150.0 < time_s < 200.0))

    _, taken, received = ais_times(ais_fleet(np.random.default_rng(1), held_up))
    assert received.max() > 40.0
    assert np.abs(taken).max() < 6.0
    _, taken, received = ais_times(
        ais_fleet(np.random.default_rng(2), lambda rng, _: rng.uniform(2.0, 25.0), seconds=900)
    )
    assert np.sqrt(np.mean((taken - 2.0) ** 2)) < 0.4 * np.std(received)


def test_a_wrong_second_of_ais_does_not_move_a_vessel():
    lying = (2, 5, 7)
    mmsi, taken, _ = ais_times(ais_fleet(np.random.default_rng(3), soon, lying=lying))
    lies = np.isin(mmsi - 211000000, lying)
    assert np.sqrt(np.mean(taken[lies] ** 2)) < 2.5
    assert np.abs(taken[~lies]).mean() < 0.5


def errors_m(delay_s, seconds=240):
    """Errors of the tracks of a shore radar, with AIS so late or, without a delay, without."""
    pyais = pytest.importorskip("pyais")
    rng = np.random.default_rng(5)
    begin_s, period_s, plane = (
        1.7e9 // 60 * 60,
        2.5,
        wl.LocalPlane(latitude_rad=0.0, longitude_rad=0.0),
    )
    radar = {"name": "A", "position_deg": [0.0, 0.0], "bearing_std_deg": 0.5, "period_s": period_s}
    session = wl.live.Session({"session": {"origin_deg": [0.0, 0.0]}, "radar": [radar]})
    start = 4000.0 * np.exp(1j * np.linspace(0.3, 6.0, 8))
    velocity = rng.uniform(4.0, 10.0, 8) * np.exp(1j * rng.uniform(0.0, 6.2, 8))
    fed = []
    for vessel, way in enumerate(velocity):
        for t in range(int(rng.integers(10)), seconds if delay_s else 0, 10):
            place = start[vessel] + way * t + 5.0 * complex(*rng.standard_normal(2))
            fields = {"type": 1, "mmsi": 211000000 + vessel, "second": t % 60, "accuracy": 1}
            degrees = np.degrees(plane.place(np.array([place.real, place.imag])))
            fields |= {"lat": degrees[0], "lon": degrees[1], "heading": 511}
            fields |= {"speed": abs(way) / 0.514444, "course": np.degrees(np.angle(way)) % 360.0}
            body = pyais.encode_dict(fields)[0].replace("VDO", "VDM")[1:].partition("*")[0]
            line = b"!%s*%02X\r\n" % (body.encode(), reduce(xor, body.encode()))
            fed.append((t + 0.2 + rng.exponential(delay_s), "ais", line))
    for k in range(8 * int(seconds / period_s)):
        lines, turn_s = [], k // 8 * period_s
        for place, way in zip(start + velocity * turn_s, velocity, strict=True):
            share = np.angle(place) % math.tau / math.tau
            if int(8 * share) == k % 8:
                place += way * share * period_s
                plot = {"radar": "A", "time_s": begin_s + turn_s + share * period_s}
                plot["range_m"] = abs(place) + 10.0 * rng.standard_normal()
                plot["bearing_rad"] = np.angle(place) + np.radians(0.5) * rng.standard_normal()
                lines.append(plot)
        end_s = (k + 1) * period_s / 8
        sector = {"from_rad": k % 8 * math.tau / 8, "to_rad": (k % 8 + 1) * math.tau / 8}
        lines.append({"radar": "A", "sector": sector | {"time_s": begin_s + end_s}})
        fed.append((end_s, "radar", "".join(f"{json.dumps(one)}\n" for one in lines).encode()))
    errors = []
    for time_s, source, octets in sorted(fed):
        session.feed(begin_s + time_s, source, octets)
        if time_s < seconds / 2:
            continue
        for track in session.tracker.tracks():
            found = complex(track.mean[0], track.mean[2])
            errors.append(np.abs(start + velocity * (track.time_s - begin_s) - found).min())
    return np.sqrt(np.mean(np.square(errors)))


def test_ais_that_comes_late_makes_tracks_better():
    alone = errors_m(0.0)
    assert errors_m(1.5) < 0.95 * alone
    assert errors_m(6.0) < alone


def test_a_position_of_ais_that_comes_by_two_ways_is_one():
    fleet = ais_fleet(np.random.default_rng(4), soon)
    later = sorted(
        [(b + 2.5 * way, m) for _, b, m in fleet for way in (0, 1)], key=lambda one: one[0]
    )
    picture = AisPicture()
    taken = [picture.add(received_s, message)[1] for received_s, message in later]
    assert sum(taken) < 1.15 * len(fleet)


def test_interleaved_parts_and_tag_blocks_give_the_same_messages():
    parts = [line for line in ais_lines() if line.startswith(b"!AIVDM,2")]
    alone, _ = messages([line + b"\r\n" for line in parts])
    assert len(alone) == 4
    first = [line for line in parts if line.split(b",")[2] == b"1"]
    second = [line for line in parts if line.split(b",")[2] == b"2"]
    renumbered = []
    for half in (first, second):
        for k, line in enumerate(half):
            fields = line[1 : line.rindex(b"*")].split(b",")
            fields[3] = b"%d" % k
            body = b",".join(fields)
            checksum = 0
            for octet in body:
                checksum ^= octet
            tag = b"g:%d-2-%d" % (1 if half is first else 2, 100 + k)
            sum_of_tag = 0
            for octet in tag:
                sum_of_tag ^= octet
            renumbered.append(b"\\%s*%02X\\!%s*%02X" % (tag, sum_of_tag, body, checksum))
    mixed, problems = messages([line + b"\r\n" for line in renumbered])
    assert mixed == alone
    assert problems.count == {}


@given(st.lists(st.binary(max_size=80), max_size=20))
def test_lines_do_not_depend_on_the_cuts(pieces):
    octets = b"".join(pieces)
    cut, whole = LineAssembly(True), LineAssembly(True)
    got = [line for piece in pieces for line in cut.feed(piece, Problems())]
    got += cut.feed(b"\n", Problems())
    want = list(whole.feed(octets + b"\n", Problems()))
    assert got == want == [line for line in re.split(rb"[\r\n]+", octets) if line.strip()]


# ------------------------------------------------------------------ rubbish


@settings(max_examples=100)
@given(st.lists(st.tuples(st.sampled_from(["nmea", "json", "cat240", "spokes", ""]), st.binary())))
def test_no_octets_are_fatal(pieces):
    inputs = [
        {"url": f"udp://127.0.0.1:1?name={kind or 'any'}", "format": kind}
        for kind in ("nmea", "json", "cat240", "spokes", "")
    ]
    session = wl.live.Session({"input": inputs, "tracker": SMALL})
    for k, (kind, octets) in enumerate(pieces):
        session.feed(float(k), kind or "any", octets)
    json.dumps(session.picture(), allow_nan=False)
    assert session.metrics()


@settings(max_examples=40)
@given(
    st.dictionaries(
        st.sampled_from(["radar", "sector", "own", "report", "time_s", "range_m", "version"]),
        st.recursive(
            st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=5),
            lambda inner: st.dictionaries(
                st.sampled_from(["time_s", "from_rad", "to_rad", "north_m", "east_m"]), inner
            ),
            max_leaves=5,
        ),
    )
)
def test_no_json_is_fatal(line):
    session = wl.live.Session({"tracker": SMALL})
    session.feed(0.0, "x", json.dumps(line).encode())
    json.dumps(session.picture(), allow_nan=False)


@pytest.mark.parametrize(("mmsi", "kind"), [(2111111, 4), (2111111, 1), (211000001, 1)])
def test_an_identity_of_ais_has_nine_digits_and_a_base_station_is_no_target(mmsi, kind):
    pyais = pytest.importorskip("pyais")
    session = wl.live.Session({"own": {"place_deg": [54.3, 10.2]}})
    lines = written(session)
    values = {"type": kind, "mmsi": mmsi, "lat": 54.31, "lon": 10.2, "speed": 0.0, "course": 0.0}
    body = pyais.encode_dict(values)[0][1:].partition("*")[0].replace("VDO", "VDM")
    sentence = f"!{body}*{reduce(xor, body.encode()):02X}"
    for t in range(0, 60, 10):
        session.feed(float(t), "ais", f"{sentence}\r\n".encode())
        session.feed(t + 5.0, "clock", b"")
    picture, identity = session.picture(), f"{mmsi:09d}"
    assert [one["identity"] for one in picture["ais"]] == [identity]
    identities = [] if kind == 4 else [identity]
    assert [one["identity"] for one in picture["tracks"]] == identities
    rows = [json.loads(line) for line in lines]
    assert {row["identity"] for row in rows if row.get("identity")} == set(identities)


def test_rubbish_is_counted_and_named():
    session = wl.live.Session()
    session.feed(0.0, "nmea", b"$GPGGA,1,2*00\r\n")
    session.feed(0.0, "json", b'{"time_s": 1}')
    session.feed(0.0, "json", b'{"version": 2, "own": {}}')
    session.feed(0.0, "x", b"\x01\x02")
    inputs = session.status()["inputs"]
    assert inputs["nmea"]["problems"] == {"checksum": 1}
    assert inputs["json"]["problems"] == {"JSON": 2}
    assert "version" in inputs["json"]["last_problem"]
    assert inputs["x"]["problems"] == {"unknown": 1}


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("time_s", 1.8e12),
        ("range_m", 1e300),
        ("range_m", math.nan),
        ("range_std_m", 0.0),
        ("bearing_std_rad", -1.0),
        ("range_std_m", None),
    ],
)
def test_a_plot_that_cannot_be_used_is_a_problem_with_the_name_of_its_value(name, value):
    plot = {"time_s": 0.0, "range_m": 1.0, "bearing_rad": 1.0}
    plot |= {"range_std_m": 5.0, "bearing_std_rad": 0.01, name: value}
    if value is None:  # one without the other
        del plot[name]
    session = wl.live.Session()
    session.feed(0.0, "x", json.dumps(plot).encode())
    status = session.status()
    assert status["radars"]["A"]["plots"] == 0
    assert name in status["inputs"]["x"]["last_problem"]


# ------------------------------------------------------------------ other senders


def delta(context, **values):
    rows = [{"path": path, "value": value} for path, value in values.items()]
    return json.dumps({"context": context, "updates": [{"values": rows}]}).encode()


def test_signalk_gives_own_ship_and_vessels():
    session = wl.live.Session({"input": [{"url": "signalk://127.0.0.1:3000?name=sk"}]})
    me = "vessels.urn:mrn:imo:mmsi:211000001"
    session.feed(0.0, "sk", json.dumps({"self": me}).encode())
    place = {"latitude": 54.0, "longitude": 10.0}
    moving = {"navigation.speedOverGround": 5.0, "navigation.courseOverGroundTrue": 0.0}
    turned = {"navigation.headingTrue": 0.1, "navigation.position": place}
    session.feed(0.1, "sk", delta(me, **turned, **moving))
    other = "vessels.urn:mrn:imo:mmsi:211000002"
    session.feed(0.2, "sk", delta(other, **{"navigation.position": place, "": {"name": "NOOR"}}))
    session.feed(0.2, "sk", b"[]")
    assert "object" in session.status()["inputs"]["sk"]["last_problem"]
    session.feed(0.2, "sk", b'{"updates": null}')
    assert "updates" in session.status()["inputs"]["sk"]["last_problem"]
    picture = session.picture()
    assert picture["own"]["vnorth_mps"] == pytest.approx(5.0)
    assert picture["own"]["heading_rad"] == pytest.approx(0.1)
    (vessel,) = picture["ais"]
    assert (vessel["mmsi"], vessel["name"]) == (211000002, "NOOR")
    assert session.status()["inputs"]["sk"]["problems"] == {"Signal K": 2}


def test_a_vessel_that_reports_from_a_track_names_it_in_the_picture():
    inputs = [{"url": "signalk://127.0.0.1:3000?name=sk"}]
    session = wl.live.Session(
        {"input": inputs, "radar": [JOYRIDE | {"position_deg": [54.0, 10.0]}]}
    )
    urn = "vessels.urn:mrn:imo:mmsi:%d"
    session.feed(0.0, "sk", json.dumps({"self": urn % 211000001}).encode())
    for k in range(20):
        t, north_m = 3.0 * k, 2000.0 - 15.0 * k
        for mmsi, east_m in ((211000002, 0.0), (211000003, 3000.0)):
            degrees = session.to_degrees(north_m, east_m)
            place = dict(zip(("latitude", "longitude"), degrees, strict=True))
            moving = {"navigation.speedOverGround": 5.0}
            moving["navigation.courseOverGroundTrue"] = math.pi
            session.feed(t, "sk", delta(urn % mmsi, **{"navigation.position": place}, **moving))
        for line in (
            {"time_s": t, "range_m": north_m, "bearing_rad": 0.0},
            {"sector": {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}},
        ):
            session.feed(t, "radar", json.dumps(line).encode())
    picture = session.picture()
    tracks = {one["identity"]: one["track_id"] for one in picture["tracks"]}
    seen = {one["mmsi"]: one["track_id"] for one in picture["ais"]}
    assert seen[211000002] == tracks["211000002"]
    assert seen[211000003] == tracks.get("211000003")


def varint(value):
    octets = bytearray()
    while value > 127:
        octets.append(value & 127 | 128)
        value >>= 7
    return bytes([*octets, value])


def spoke(angle, bearing, range_m, pixels):
    fields = [(0x08, angle), (0x10, bearing), (0x18, range_m), (0x20, 5000)]
    body = b"".join(bytes([key]) + varint(value) for key, value in fields)
    body += b"\x2a" + varint(len(pixels)) + pixels
    return b"\x12" + varint(len(body)) + body


@pytest.mark.parametrize("azimuth", ["north", "bow"])
def test_spokes_are_sweeps(azimuth):
    url = "signalk://127.0.0.1:3000/radars/one?name=spokes"
    session = wl.live.Session({"input": [{"url": url}], "radar": [{"azimuth": azimuth}]})
    seen = []
    session.sweeps.append(lambda *one: seen.append(one))
    session.feed(4.0, "spokes", b'{"spokesPerRevolution": 2048, "pixelValues": 16}')
    session.feed(4.5, "spokes", spoke(1, 1025, 3000, bytes(16)))  # shown from the next on
    pixels = [bytes([k % 16] * 16) for k in range(8)]
    message = b"".join(spoke(10 + k, 1034 + k, 3000, one) for k, one in enumerate(pixels))
    session.feed(5.0, "spokes", message)
    radar, azimuth_rad, heading_rad, range_m, cells = seen[-1]
    first = 1034 if azimuth == "north" else 10
    np.testing.assert_allclose(azimuth_rad, (first + np.arange(8)) * math.tau / 2048)
    assert (radar, range_m) == ("A", 3000.0)
    assert math.isnan(heading_rad)
    np.testing.assert_array_equal(cells, np.array([list(one) for one in pixels]) * 17)
    for cut in range(len(message)):
        session.feed(5.0, "spokes", message[:cut])
    assert set(session.status()["inputs"]["spokes"]["problems"]) == {"spokes"}


@pytest.mark.parametrize("together", [1, 8, 50])
def test_plots_of_video_come_before_the_beam_has_passed_their_sector(together):
    """Echoes of 1 to 5 degrees: sectors end where the first one that is not whole begins."""
    rng = np.random.default_rng(together)
    sweeps, width_rad = 1024, math.tau / 1024
    feed = VideoFeed()
    passed_rad, lags_rad, plots = None, [], 0
    echoes = [(int(k), int(rng.integers(3, 15)), int(c)) for k, c in rng.integers(20, 230, (40, 2))]
    for turn in range(4):
        cells = rng.rayleigh(10.0, (sweeps, 256)).clip(0, 255).astype(np.uint8)
        for k, (_, count, cell) in enumerate(echoes):
            cells[k * sweeps // 40 : k * sweeps // 40 + count, cell : cell + 4] = 250
        for first in range(0, sweeps, together):
            number = np.arange(first, min(first + together, sweeps))
            azimuth_rad = (number + 0.5) * width_rad
            time_s = 1e6 + 2.5 * (turn + (number + 0.5) / sweeps)
            part = Sweeps(azimuth_rad, time_s, width_rad, 0.0, 10.0, cells[number])
            for one in feed.take(part, Problems()):
                if hasattr(one, "range_m"):
                    plots += 1
                    if passed_rad is not None:
                        assert (one.bearing_rad - passed_rad) % math.tau < math.pi
                else:
                    passed_rad = one.to_rad
                    beam_rad = azimuth_rad[-1] + 0.5 * width_rad
                    lags_rad.append((beam_rad - passed_rad + 1e-9) % math.tau)
    assert plots > 100
    assert np.median(lags_rad) < 0.03
    assert max(lags_rad) <= 0.1 + 1e-6


def marks_of_video(azimuths_rad, turns=4, period_s=2.5, problems=None):
    """The sectors that end with sweeps of an antenna, at these azimuths in each turn."""
    feed, found = VideoFeed(), []
    cells = np.random.default_rng(1).rayleigh(10.0, (len(azimuths_rad), 64)).astype(np.uint8)
    for turn in range(turns):
        for first in range(0, len(azimuths_rad), 8):
            azimuth_rad = azimuths_rad[first : first + 8]
            time_s = 1e6 + period_s * (turn + azimuth_rad / math.tau)
            part = Sweeps(azimuth_rad, time_s, math.tau / 512, 0.0, 10.0, cells[first : first + 8])
            found += [one for one in feed.take(part, problems or Problems())]
    return [one for one in found if hasattr(one, "to_rad")]


@pytest.mark.parametrize("blanked", [0.0, 0.45, 0.5, 0.6, 0.8])
def test_sectors_of_video_adjoin_across_a_blanked_part_of_the_turn(blanked):
    azimuth_rad = (np.arange(int(512 * (1.0 - blanked))) + 0.5) * math.tau / 512
    marks = marks_of_video(azimuth_rad, turns=10)
    for one, other in itertools.pairwise(marks):
        assert other.from_rad % math.tau == pytest.approx(one.to_rad % math.tau)
    first, last = marks[0].time_s, marks[-1].time_s
    swept = sum(one.to_rad - one.from_rad for one in marks[1:]) / math.tau
    assert swept == pytest.approx((last - first) / 2.5, abs=0.1)
    assert swept > 3.0


def test_an_antenna_that_turns_anticlockwise_is_named():
    problems = Problems()
    azimuth_rad = (np.arange(512)[::-1] + 0.5) * math.tau / 512
    assert marks_of_video(azimuth_rad, problems=problems) == []
    assert set(problems.count) == {"anticlockwise"}


def counted(numbers):
    """A video feed that has taken sweeps with these numbers of their messages."""
    feed, problems, encoder = VideoFeed(), Problems(), Cat240Encoder(1, 2)
    cells, kind = np.zeros((1, 64), np.uint8), b"\x01\x02\x02"  # of radar 1, 2
    for k, number in enumerate(numbers):
        at = np.array([0.01 * k]), np.array([0.001 * k])
        message = encoder.encode(cells, *at, azimuth_width_rad=0.01, start_range_m=0.0, cell_m=10.0)
        count = kind + k.to_bytes(4, "big")
        message = message.replace(count, kind + number.to_bytes(4, "big"), 1)
        list(feed.feed(0.001 * k, message, problems))
    list(feed.pass_to(1e3, problems))
    return feed


def test_sweeps_that_come_late_are_not_lost():
    numbers = list(range(500))
    for k in (20, 100, 130):
        numbers[k], numbers[k + 1] = numbers[k + 1], numbers[k]
    late = counted(numbers)
    assert (late.lost, late.late, late.duplicates) == (0, 3, 0)
    some = counted([k for k in range(500) if k not in (100, 101, 200)])
    assert (some.lost, some.late, some.sweeps) == (3, 0, 497)
    outage = counted([*range(100), *range(1000, 1200)])
    assert outage.lost == 900


def test_sweeps_of_a_sender_that_does_not_count_are_used():
    assert counted([0] * 200).sweeps == 200


def test_the_same_message_a_turn_later_is_another_one():
    """Of a still target, from a radar that sends no times."""
    plot = b"\x30\x00\x0b\xb0\x19\x07\x20\x02\x29\x20\x00"
    source = Source(InputConfig("udp://127.0.0.1:1"))
    found = [list(source.read(1.25 * k + late_s, plot)) for k in range(9) for late_s in (0.0, 0.2)]
    assert [len(one) for one in found] == [1, 0] * 9
    assert source.duplicates == 9


@pytest.mark.parametrize(("min_range_m", "seen"), [(0.0, 2), (15.0, 3), (300.0, 1)])
def test_cells_nearer_than_a_radar_sees_give_no_plots(min_range_m, seen):
    """By default those nearer than 40 m, live and in a file."""
    settings = {"name": "A", "azimuth": "north", "min_range_m": min_range_m}
    session = wl.live.Session({"radar": [settings], "own": {"place_deg": [54.0, 10.0]}})
    rng, encoder, width_rad = np.random.default_rng(0), Cat240Encoder(1, 2), math.tau / 256
    place = {"azimuth_width_rad": width_rad, "start_range_m": 0.0, "cell_m": 10.0}
    extraction, in_file, turns = Extraction(min_range_m), [], 3
    for turn in range(turns):
        cells = rng.rayleigh(10.0, (256, 200)).clip(0, 45).astype(np.uint8)
        for k, cell in ((50, 2), (100, 20), (150, 60)):
            cells[k : k + 3, cell : cell + 2] = 250
        azimuth_rad = (np.arange(256) + 0.5) * width_rad
        time_s = 2.5 * (turn + np.arange(256) / 256)
        for k in range(256):
            part = slice(k, k + 1)
            octets = encoder.encode(cells[part], azimuth_rad[part], time_s[part], **place)
            session.feed(time_s[k], "video", octets)
        video = RadarVideo(cells, azimuth_rad, time_s, *place.values())
        in_file += extraction.plots_of(Turn([video])).range_m.tolist()
    session.feed(2.5 * turns, "clock", b"")
    assert len(in_file) == seen * turns
    assert min(in_file) > min_range_m
    assert session.status()["radars"]["A"]["plots"] == seen * (turns - 1)


def test_the_status_says_how_far_the_clock_of_a_radar_server_is_off():
    url = "signalk://127.0.0.1:3000/radars/one?name=spokes"
    session = wl.live.Session({"input": [{"url": url}]})
    session.feed(604.0, "spokes", b'{"spokesPerRevolution": 2048}')
    session.feed(605.0, "spokes", spoke(1, 1025, 3000, bytes(16)))  # of 5 s
    assert session.status()["radars"]["A"]["clock_offset_s"] == pytest.approx(600.0)


@settings(max_examples=50)
@given(
    lengths=st.lists(st.integers(0, 300), min_size=1, max_size=8),
    cuts=st.lists(st.integers(1, 2500), max_size=12),
)
def test_blocks_of_asterix_do_not_depend_on_the_cuts_of_a_stream(lengths, cuts):
    blocks = [
        bytes([48, *(3 + n).to_bytes(2, "big")]) + bytes(k % 256 for k in range(n)) for n in lengths
    ]
    stream, assembly, problems = b"".join(blocks), BlockAssembly(), Problems()
    edges = [0, *sorted({cut for cut in cuts if cut < len(stream)}), len(stream)]
    found = [
        block
        for begin, end in itertools.pairwise(edges)
        for block in assembly.feed(stream[begin:end], problems)
    ]
    assert found == blocks
    assert not problems.count
    assert list(assembly.feed(b"no ASTERIX", problems)) == []
    assert list(assembly.feed(blocks[0], problems)) == blocks[:1]
    assert sum(problems.count.values()) == 1


@pytest.mark.parametrize("piece", [7, 1460, 1 << 16])
def test_a_stream_of_asterix_may_begin_within_a_block_and_has_other_categories(piece):
    rng = np.random.default_rng(1)
    blocks = []
    for k in range(500):
        category = 247 if k % 7 == 3 else (48, 34, 240)[k % 3]
        contents = rng.bytes(int(rng.integers(5, 400)))
        blocks.append(bytes([category, *(3 + len(contents)).to_bytes(2, "big")]) + contents)
    stream, assembly, problems = b"".join(blocks)[100:], BlockAssembly(), Problems()
    found = [
        block
        for begin in range(0, len(stream), piece)
        for block in assembly.feed(stream[begin : begin + piece], problems)
    ]
    ours = [block for block in blocks if block[0] != 247]
    assert found[-380:] == ours[-380:]


def turns_of_blocks(turns):
    """A plot and a mark of north a turn, as category 048 and 034 of one radar."""
    for k in range(turns):
        time = (128 * k + 64).to_bytes(3, "big")
        yield b"\x30\x00\x0e\xf0\x19\x07" + time + b"\x20\x02\x29\x20" + bytes([k])
        yield b"\x22\x00\x0c\xe8\x19\x07\x01" + time + b"\x01\x40"


def test_plots_of_a_stream_that_begins_within_a_block_are_found_within_a_few():
    blocks = list(turns_of_blocks(8))
    for cut in range(1, len(blocks[0])):
        assembly, problems = BlockAssembly(), Problems()
        pieces = [blocks[0][cut:], *blocks[1:]]
        found = [one for piece in pieces for one in assembly.feed(piece, problems)]
        assert found[-13:] == blocks[-13:]
        assert problems.count["ASTERIX"] > 0


def test_a_header_without_a_block_costs_no_other_block():
    blocks, assembly, problems = list(turns_of_blocks(8)), BlockAssembly(), Problems()
    pieces = [*blocks[:6], b"\x30\xff\xff", *blocks[6:]]
    assert [one for piece in pieces for one in assembly.feed(piece, problems)] == blocks
    assert problems.count == {"ASTERIX": 1}


def readings(pieces, url="tcp://127.0.0.1:1"):
    """What an input of unknown format reads in pieces at 5 Hz, and the input."""
    source = Source(InputConfig(url))
    found = [one for k, piece in enumerate(pieces) for one in source.read(0.2 * k, piece)]
    return found, source


def test_a_stream_of_sentences_may_begin_anywhere():
    fix = sentence_of("GPGGA,101010.00,5400.000,N,01000.000,E,1,10,0.8,2.0,M,44.0,M,,").encode()
    lines = fix + b"\r\n" + sentence_of("HEHDT,30.0,T").encode() + b"\r\n"
    for start in (lines, b'0"\xf0\n\r\n'):
        for cut in range(len(start)):
            found, source = readings([start[cut:], *[lines] * 5])
            assert {one.quantity for _, one in found} == {"position", "heading"}
            assert source.status(1.0)["format"] == "nmea"
            skipped = start[cut:].partition(b"$")[0].strip()
            assert bool(source.problems.count) == bool(skipped), start[cut:]


def test_the_format_of_a_stream_is_recognized_anew():
    blocks = list(turns_of_blocks(6))
    fix = sentence_of("GPGLL,5400.000,N,01000.000,E,,A").encode() + b"\r\n"
    found, source = readings([*blocks, *[fix] * 6, *blocks[1:]])
    kinds = [kind for kind, _ in found]
    assert kinds[-1] == "radar"
    assert kinds.count("own") == 6
    assert source.status(2.0)["format"] == "cat048"


@pytest.mark.parametrize("unit", [b"\n", b"\n{", b'{"', b"$AAA,", b"0", b"\xf0\x00\x04\x81"])
def test_long_streams_of_an_unknown_format_take_no_time(unit):
    began_s = time.process_time()
    format_in_stream((unit * (1 << 17))[: 1 << 17])
    assert time.process_time() - began_s < 0.5


def test_a_datagram_may_have_octets_before_its_sentence():
    fix = sentence_of("GPGLL,5400.000,N,01000.000,E,,A").encode()
    for start in (b"\n", b"\0", b"0", b'"', b"\xf0"):
        assert len(readings([start + fix], "udp://127.0.0.1:1")[0]) == 1


@pytest.mark.parametrize(
    "radar", [{"position_deg": [54.0, 10.0]}, {"azimuth": "bow", "forward_m": 30.0}]
)
def test_plots_given_by_their_places_on_earth_are_tracked_there(radar):
    inputs = [{"url": "udp://127.0.0.1:1?name=x"}]
    own = {"place_deg": [54.0, 10.0], "fixed_heading_deg": 40.0}
    radars = [radar | {"name": "A", "period_s": 2.5}]
    session = wl.live.Session({"input": inputs, "radar": radars, "own": own})
    place_deg = 54.02, 10.03
    place = b"".join(round(one / 180.0 * 2**31).to_bytes(4, "big") for one in place_deg)
    for k in range(12):
        t = 1e6 + 2.5 * k
        time = round(128.0 * (t % 86400.0)).to_bytes(3, "big")
        session.feed(t + 0.1, "x", b"\x0a\x00\x13\xf8\x19\x07\x01\x60" + time + place)
        session.feed(t + 2.4, "x", b"\x0a\x00\x0a\xd0\x19\x07\x02" + time)
    assert session.status()["inputs"]["x"]["problems"] == {}
    (track,) = session.picture()["tracks"]
    north_m, east_m = session.to_plane(*place_deg)
    assert math.hypot(track["north_m"] - north_m, track["east_m"] - east_m) < 5.0


def test_places_of_plots_without_that_of_the_radar_are_a_problem():
    session = wl.live.Session()
    plot = b"\x0a\x00\x13\xf8\x19\x07\x01\x60\x00\x00\x00" + bytes(8)
    session.feed(0.0, "x", plot)
    assert sum(session.status()["inputs"]["x"]["problems"].values()) == 1


LOSSES = ("lost", "late")


def test_messages_of_redundant_groups_count_once():
    inputs = [{"url": f"udp://127.0.0.1:1?name={name}", "radar": "A"} for name in "ab"]
    session = wl.live.Session({"input": inputs, "radar": [{"name": "A", "azimuth": "north"}]})
    encoder = Cat240Encoder(1, 2)
    for k in range(200):
        message = encoder.encode(
            np.zeros((1, 64), np.uint8),
            np.array([0.01 * k]),
            np.array([0.001 * k]),
            azimuth_width_rad=0.01,
            start_range_m=0.0,
            cell_m=10.0,
        )
        if k % 5 != 1:
            session.feed(0.001 * k, "a", message)
        if k % 5 != 2:
            session.feed(0.001 * k, "b", message)
    session.feed(1.0, "clock", b"")
    inputs = session.status()["inputs"]
    assert inputs["a"]["lost_sweeps"] == inputs["b"]["lost_sweeps"] == 0
    assert all(f"wakeline_input_{name}_sweeps_total" in session.metrics() for name in LOSSES)
    assert inputs["a"]["duplicates"] + inputs["b"]["duplicates"] == 120


# ------------------------------------------------------------------ settings


def test_printed_settings_read_back_the_same(tmp_path):
    config = config_of(
        {
            "input": [
                {"url": "udp://0.0.0.0:10110?name=boat&format=nmea"},
                {"url": "udp://239.0.0.1:8600?sac_sic=25/1"},
            ],
            "output": [{"url": "file:x.jsonl"}, {"url": "udp://127.0.0.1:1"}],
            "radar": [{"name": "A", "azimuth": "bow", "forward_m": 3.0, "period_s": 2.5}],
            "own": {"position": ["GGA", "@boat"], "dwell_s": 4.0},
            "tracker": {"max_tracks": 50},
            "guard_zone": [{"name": "x", "outline_deg": [[54, 10], [54, 10.1], [54.1, 10]]}],
            "zone": [{"name": "y", "outline_m": [[0, 0], [0, 9], [9, 9]], "cpa_limit_m": 50.0}],
        }
    )
    path = tmp_path / "live.toml"
    path.write_text(config.toml())
    again = wl.live.read_config(path)
    assert again.inputs == config.inputs
    assert again.outputs == config.outputs
    assert again.radars == config.radars
    assert again.settings.tracker == config.settings.tracker
    assert again.own.position == config.own.position
    assert again.guard_zones == config.guard_zones
    assert again.settings.zones == config.settings.zones
    assert [one.format for one in config.outputs] == ["json", "ttm"]
    assert config_of(config.as_document()).as_document() == config.as_document()


@pytest.mark.parametrize(
    ("document", "names"),
    [
        ({"input": [{"url": "ftp://x"}]}, "ftp"),
        ({"input": [{"url": "udp://x:1", "format": "cat999"}]}, "format"),
        ({"input": [{"url": "udp://x:1", "radar": "B"}]}, "radar"),
        ({"input": [{"url": "udp://x:1?foramt=nmea"}]}, "foramt"),
        ({"input": [{"url": "udp://x:1?sac_sic=25"}]}, "sac_sic"),
        ({"radar": [{"sac_sic": "25/256"}]}, "sac_sic"),
        ({"radar": [{"name": name, "sac_sic": "25/1"} for name in "AB"]}, "25/1"),
        ({"output": [{"url": "tcp://x:1?iface=127.0.0.1"}]}, "iface"),
        ({"input": [{"url": "udp://x:1"}, {"url": "udp://x:1"}]}, "udp://x:1"),
        ({"radar": [{"name": "A", "range_std": 1.0}]}, "range_std"),
        ({"own": {"dwell_s": -1.0}}, "dwell_s"),
        ({"own": {"place_deg": [1.0]}}, "place_deg"),
        ({"own": {"dwell_s": "long"}}, "dwell_s"),
        ({"own": {"position": ["GPGGA@gnss", "HDT"]}}, "HDT"),
        ({"guard_zone": [{"outline_deg": [[54, 10], [95, 10], [54, 11]]}]}, "outline_deg"),
        ({"guard_zone": [{"outline_deg": [[54, 10], [55, 10]]}]}, "guard_zone"),
        ({"harbor": {}}, "harbor"),
    ],
)
def test_errors_name_the_setting(document, names):
    with pytest.raises(SettingsError, match=re.escape(names)):
        config_of(document)
