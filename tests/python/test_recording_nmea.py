"""Logs of own ship's instruments: what is read, what is said about what is not, and times."""

import datetime
import gzip
import math
from functools import reduce
from operator import xor
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from wakeline import recording
from wakeline.navigation import LocalPlane
from wakeline.recording import RecordingError, read_nmea

KNOT_MPS = 1852.0 / 3600.0
DAY_S = 86400.0
MAY_21 = datetime.datetime(2008, 5, 21, tzinfo=datetime.timezone.utc).timestamp()


def sentence(body, talker="II"):
    text = talker + body
    return f"${text}*{reduce(xor, text.encode('latin-1'), 0):02X}"


def hhmmss(time_s):
    time_s = time_s % DAY_S
    return f"{int(time_s // 3600):02}{int(time_s // 60 % 60):02}{time_s % 60:06.3f}"


def place(latitude_deg=46.5, longitude_deg=6.7):
    def minutes(value, width):
        total = round(abs(value) * 60, 6)
        return f"{int(total // 60):0{width}}{total % 60:09.6f}"

    sides = ("N" if latitude_deg >= 0 else "S"), ("E" if longitude_deg >= 0 else "W")
    return f"{minutes(latitude_deg, 2)},{sides[0]},{minutes(longitude_deg, 3)},{sides[1]}"


def rmc(time_s, latitude_deg=46.5, longitude_deg=6.7, *, kn="5.0", course="90", **more):
    """An RMC of 21 May 2008, `time_s` after midnight."""
    date = more.get("date", f"{21 + int(time_s // DAY_S):02}0508")
    where = more.get("where", place(latitude_deg, longitude_deg))
    status, variation, mode = (
        more.get(k, v) for k, v in (("status", "A"), ("var", ","), ("mode", "A"))
    )
    return sentence(
        f"RMC,{hhmmss(time_s)},{status},{where},{kn},{course},{date},{variation},{mode}"
    )


def gll(time_s, latitude_deg=46.5, longitude_deg=6.7, status="A"):
    return sentence(f"GLL,{place(latitude_deg, longitude_deg)},{hhmmss(time_s)},{status},A")


def gga(time_s, latitude_deg=46.5, longitude_deg=6.7, quality="1", hdop="0.9"):
    where = place(latitude_deg, longitude_deg)
    return sentence(f"GGA,{hhmmss(time_s)},{where},{quality},08,{hdop},372.0,M,48.0,M,,")


def gns(time_s, latitude_deg=46.5, longitude_deg=6.7, modes="AA", hdop="0.9"):
    where = place(latitude_deg, longitude_deg)
    return sentence(f"GNS,{hhmmss(time_s)},{where},{modes},14,{hdop},372.0,48.0,,", "GN")


def under_way(times_s, **more):
    """RMC of a vessel that goes east at 5 kn."""
    return [rmc(t, longitude_deg=6.7 + 3.35e-5 * (t - times_s[0]), **more) for t in times_s]


@pytest.fixture
def log(tmp_path):
    """Reads a log of some lines."""

    def read(*lines, end="\n", **settings):
        path = tmp_path / "own.nmea"
        octets = end.join([*lines, ""]).encode("latin-1")
        path.write_bytes(octets)
        return read_nmea(path, **settings)

    return read


def clock_s(series):
    """Times since midnight of 21 May."""
    return pytest.approx(series.time_s - MAY_21, abs=1e-6)


# ------------------------------------------------------------------ readings


def test_rmc_is_a_fix_and_a_speed_over_ground(log):
    read = log(rmc(60300, -33.25, -179.5, kn="12.5", course="275.5"))
    fixes, ground = read.fixes, read.ground
    assert clock_s(fixes) == [60300]
    assert fixes.latitude_deg == pytest.approx([-33.25])
    assert fixes.longitude_deg == pytest.approx([-179.5])
    assert (fixes.quality[0], fixes.valid[0], fixes.sentence[0], fixes.line[0]) == (
        1,
        True,
        "RMC",
        1,
    )
    assert np.isnan(fixes.hdop).all()
    assert ground.speed_mps == pytest.approx([12.5 * KNOT_MPS])
    assert ground.course_rad == pytest.approx(np.radians([275.5]))
    assert clock_s(ground) == [60300]
    assert read.report.problems == {}
    assert read.report.lines == 1


def test_gga_gives_quality_and_hdop(log):
    read = log(rmc(10), gga(12, 1.5, 2.5, "4", "1.25"), gga(14, quality="0", hdop=""))
    assert read.fixes.quality.tolist() == [1, 4, 0]
    assert read.fixes.valid.tolist() == [True, True, False]
    np.testing.assert_array_equal(read.fixes.hdop, [np.nan, 1.25, np.nan])
    assert read.fixes.latitude_deg[1] == pytest.approx(1.5)


def test_gns_is_a_gga_of_several_systems_of_satellites(log):
    modes = ("AA", "AN", "NDA", "FR", "NN", "EN", "")
    lines = [gns(12 + k, 1.5, 2.5, mode, "1.25") for k, mode in enumerate(modes)]
    read = log(rmc(10), *lines, sentence("GNS,000030,,,,,NN,00,,,,,"))
    assert read.fixes.quality[1:].tolist() == [1, 1, 2, 4, 0, 6, -1]
    assert read.fixes.valid[1:].tolist() == [True] * 4 + [False] * 3
    assert read.fixes.sentence[1:].tolist() == ["GNS"] * len(modes)
    assert clock_s(read.fixes) == [10, *range(12, 12 + len(modes))]
    assert read.fixes.hdop[1] == 1.25
    assert read.fixes.latitude_deg[1] == pytest.approx(1.5)
    assert read.report.problems == {}


def test_a_gns_of_another_mode_is_reported(log):
    read = log(rmc(10), gns(12, modes="AX"))
    assert read.fixes.valid.tolist() == [True, False]
    assert "GNS field 6: wanted letters out of" in str(read.report.examples[0])


def test_gll_of_old_has_neither_time_nor_status(log):
    read = log(rmc(10), sentence(f"GLL,{place(10, 20)}"), rmc(12))
    assert read.fixes.sentence.tolist() == ["RMC", "GLL", "RMC"]
    assert clock_s(read.fixes) == [10, 11, 12]
    assert read.fixes.valid.all()


@pytest.mark.parametrize(
    ("body", "series", "name", "wanted"),
    [
        ("HDT,123.5,T", "heading", "heading_rad", math.radians(123.5)),
        ("HDT,360,T", "heading", "heading_rad", 0.0),
        ("THS,123.5,A", "heading", "heading_rad", math.radians(123.5)),
        ("VHW,10,T,,M,,N,,K", "heading", "heading_rad", math.radians(10)),
        ("HDG,123.5,,,,", "compass", "heading_magnetic_rad", math.radians(123.5)),
        ("HDG,1,2.0,W,,", "compass", "heading_magnetic_rad", math.radians(359)),
        ("HDG,1,2.0,W,3.5,W", "compass", "variation_rad", math.radians(-3.5)),
        ("HDG,1,2.0,W,3.5,W", "heading", "heading_rad", math.radians(355.5)),
        ("HDG,1,,,3.5,E", "heading", "heading_rad", math.radians(4.5)),
        ("HDM,123.5,M", "compass", "heading_magnetic_rad", math.radians(123.5)),
        ("VHW,,T,11,M,,N,,K", "compass", "heading_magnetic_rad", math.radians(11)),
        ("VHW,,T,11,M,6.5,N,12,K", "water", "ahead_mps", 6.5 * KNOT_MPS),
        ("VHW,,T,11,M,,N,18,K", "water", "ahead_mps", 5.0),
        ("VBW,6.5,-0.5,A,7.5,1.5,A", "water", "ahead_mps", 6.5 * KNOT_MPS),
        ("VBW,6.5,-0.5,A,7.5,1.5,A,,V,,V", "water", "starboard_mps", -0.5 * KNOT_MPS),
        ("VBW,6.5,-0.5,A,7.5,1.5,A", "bottom", "ahead_mps", 7.5 * KNOT_MPS),
        ("VBW,6.5,-0.5,A,7.5,1.5,A", "bottom", "starboard_mps", 1.5 * KNOT_MPS),
        ("ROT,-30.0,A", "turn", "turn_rate_rad_s", math.radians(-0.5)),
        ("VTG,45,T,,M,6.5,N,,K", "ground", "speed_mps", 6.5 * KNOT_MPS),
        ("VTG,45,T,,M,,N,18,K,A", "ground", "speed_mps", 5.0),
        ("VTG,45,T,,M,,N,,K", "ground", "course_rad", math.pi / 4),
    ],
)
@pytest.mark.parametrize("talker", ["II", "gp", ""])
def test_what_each_sentence_reports(log, body, series, name, wanted, talker):
    read = log(
        sentence("ZDA,120000.5,21,05,2008,00,00"),
        sentence(body.lower() if talker == "gp" else body, talker),
    )
    readings = read.series[series]
    assert getattr(readings, name) == pytest.approx([wanted], abs=1e-12)
    assert clock_s(readings) == [43200.5]
    assert readings.valid.all()
    assert read.report.problems == {}


@pytest.mark.parametrize(
    ("body", "series"),
    [
        ("THS,123.5,V", "heading"),
        ("THS,123.5,M", "heading"),
        ("ROT,1.0,V", "turn"),
        ("VBW,6.5,,V,,,V", "water"),
        ("VBW,,,V,6.5,,V", "bottom"),
        ("VTG,45,T,,M,6.5,N,,K,N", "ground"),
    ],
)
def test_what_an_instrument_does_not_stand_by_is_not_valid(log, body, series):
    read = log(sentence("ZDA,120000,21,05,2008,00,00"), sentence(body))
    assert read.series[series].valid.tolist() == [False]
    assert len(read.series[series].sound()) == 0


def test_empty_fields_are_no_readings(log):
    empty = (
        "HDT,,T",
        "THS,,V",
        "HDG,,,,,",
        "HDM,,M",
        "VHW,,T,,M,,N,,K",
        "ROT,,A",
        "VTG,,T,,M,,N,,K",
    )
    read = log(
        rmc(10, kn="", course=""),
        rmc(12, where=",,,", kn="", status="V"),
        *map(sentence, (*empty, "VBW,,,V,,,V", "ZDA,,,,,,", "GGA,,,,,,0,,,,,,,,", "GLL,,,,,,V,N")),
    )
    assert read.report.problems == {}
    assert {name: len(s) for name, s in read.series.items() if len(s)} == {"fixes": 1, "ground": 1}
    assert clock_s(read.ground) == [12]
    assert np.isnan(read.ground.speed_mps[0])
    assert read.ground.valid.tolist() == [False]


@pytest.mark.parametrize(("status", "mode"), [("V", "A"), ("A", "N"), ("A", "E"), ("V", "")])
def test_a_fix_that_the_receiver_does_not_call_valid_is_kept_and_marked(log, status, mode):
    read = log(rmc(10), rmc(12, status=status, mode=mode), rmc(14))
    assert read.fixes.valid.tolist() == read.fixes.usable.tolist() == [True, False, True]
    assert read.ground.valid.tolist() == [True, False, True]
    assert "1 fix marked invalid by the receiver (first in line 2)" in read.notes[0]


# ------------------------------------------------------------------ one fix a time


def test_sentences_of_one_fix_are_one_fix(log):
    burst = [gll(10, 46.5), rmc(10, 46.5), gga(10, 46.5, quality="2"), rmc(10, 46.5), gll(12, 46.5)]
    read = log(*burst)
    assert read.fixes.sentence.tolist() == ["GGA", "GLL"]
    assert read.fixes.quality.tolist() == [2, 1]
    assert read.report.repeated == 3 + 1  # and a speed over ground
    assert len(read.ground) == 1


@pytest.mark.parametrize(
    ("clock", "lost"),
    [
        (lambda t: t - (t % 50 == 49), 4),  # goes back by a second now and then
        (lambda t: 100 if 100 <= t < 130 else t, 29),  # stopped
    ],
)
def test_fixes_that_a_wrong_clock_takes_for_others_are_reported(log, clock, lost):
    vessel = [6.7 + 3.35e-5 * t for t in range(200)]
    read = log(*(rmc(clock(t), longitude_deg=where) for t, where in enumerate(vessel)))
    first = 50 if lost == 4 else 102
    assert len(read.fixes) == 200 - lost
    assert len(read.report.displaced_lines) == lost
    reported = f"{lost} fixes at a time given before but another position are left out"
    assert any(f"{reported} (first in line {first})" in note for note in read.notes)


def test_a_fix_reported_again_at_its_place_or_by_another_sentence_is_not_lost(log):
    where = [6.7 + 3.35e-5 * t for t in range(50)]
    again = [
        fix
        for t, east in enumerate(where)
        for fix in (rmc(t, longitude_deg=east), rmc(t, longitude_deg=east), gll(t, 46.50001, east))
    ]
    again += [rmc(60), rmc(60, 46.6, status="V")]
    read = log(*again)
    assert read.report.repeated > 100
    assert read.report.displaced_lines == []
    assert not any("given before" in note for note in read.notes)


def test_the_valid_one_of_a_time_is_kept(log):
    read = log(gga(10, quality="0"), rmc(10), gll(12), rmc(12, status="V"))
    assert read.fixes.sentence.tolist() == ["RMC", "GLL"]
    assert read.fixes.valid.all()


def test_a_vtg_belongs_to_the_fix_before_it(log):
    vtg = sentence("VTG,91.5,T,,M,5.25,N,,K")
    read = log(rmc(10), vtg, gga(12), vtg, gga(14))
    assert read.ground.sentence.tolist() == ["RMC", "VTG"]
    assert clock_s(read.ground) == [10, 12]


def vtg(kn):
    return sentence(f"VTG,91.5,T,,M,{kn:.2f},N,,K")


def test_more_vtg_than_fixes_lie_between_them(log):
    lines = [s for t in range(10) for s in (gga(10 + t), *(vtg(t + 0.2 * k) for k in range(5)))]
    read = log(*lines)
    assert len(read.ground) == 50
    assert read.ground.speed_mps == pytest.approx(0.2 * KNOT_MPS * np.arange(50))
    assert (np.diff(read.ground.time_s) > 0).all()
    np.testing.assert_array_equal(read.ground.time_s[::5], read.fixes.time_s)
    assert read.report.repeated == 0


def test_speeds_continue_where_fixes_are_damaged(log):
    fixes = [gga(10 + t) for t in range(20)]
    fixes[5:15] = [line.replace("GGA", "GGX") for line in fixes[5:15]]
    read = log(*(line for t, fix in enumerate(fixes) for line in (fix, vtg(t))))
    assert read.report.problems == {"checksum": 10}
    assert len(read.ground) == 20
    np.testing.assert_allclose(read.ground.time_s, 10 + np.arange(20), atol=0.6)


def test_speeds_left_out_though_they_are_other_ones_are_reported(log):
    standing = [line for t in range(12, 15) for line in (rmc(10, kn=f"{t}.0"), gga(t))]
    read = log(rmc(10), gga(10), *standing, reorder_s=10)
    assert len(read.ground) == 1
    assert read.report.other_speed_lines == [3, 5, 7]
    reported = (
        "3 different speeds over ground at a time given before are left out (first in line 3)"
    )
    assert f"own.nmea: {reported}" in read.notes
    same = log(rmc(10, course=""), rmc(10, course=""), vtg(7.0), rmc(12))
    assert same.report.repeated == 3
    assert same.report.other_speed_lines == []


# ------------------------------------------------------------------ times


def test_times_continue_over_midnight(log):
    times_s = [DAY_S - 4, DAY_S - 2, DAY_S, DAY_S + 2]
    read = log(*under_way(times_s))
    assert clock_s(read.fixes) == times_s
    late_date = [rmc(t, date="210508") for t in times_s[:3]] + [rmc(t) for t in times_s[3:]]
    for lines in ([gll(t) for t in times_s], [rmc(times_s[0]), *map(gll, times_s[1:])], late_date):
        read = log(*lines, date=datetime.date(2008, 5, 21))
        assert clock_s(read.fixes) == times_s
        assert read.dated
        assert len(read.set_back_lines) == 0


def test_the_date_reaches_back_to_sentences_before_it(log):
    read = log(gll(DAY_S - 2), gll(DAY_S), rmc(DAY_S + 2))
    assert clock_s(read.fixes) == [DAY_S - 2, DAY_S, DAY_S + 2]


def test_without_a_date_times_count_from_midnight(log):
    read = log(gll(5), gll(7))
    assert read.fixes.time_s.tolist() == [5, 7]
    assert not read.dated
    assert "no sentence has a date" in read.notes[0]


def test_the_date_of_a_sentence_that_is_left_out_is_better_than_none(log):
    """The date comes from another clock, 18 s ahead, of which no time is believed."""
    lines = []
    for t in range(10, 100):
        lines.append(gga(t, longitude_deg=6.7 + 3.35e-5 * t))
        if t % 10 == 5:
            lines.append(sentence(f"ZDA,{hhmmss(t + 18)},21,05,2008,00,00"))
    read = log(*lines)
    assert read.report.problems == {"time": 9}
    assert clock_s(read.fixes) == list(range(10, 100))
    assert read.dated
    given = log(*lines, date=datetime.date(2008, 5, 22))
    assert given.fixes.time_s == pytest.approx(read.fixes.time_s + DAY_S)


def test_the_century_of_two_digits(log):
    for text, year in (("010199", 1999), ("010180", 1980), ("010179", 2079)):
        read = log(rmc(0, date=text))
        day = datetime.datetime(year, 1, 1, tzinfo=datetime.timezone.utc)
        assert read.fixes.time_s[0] == day.timestamp()


def test_a_leap_second_is_the_midnight_after_it(log):
    end = rmc(0, date="210508").replace("000000.000", "235960.000")
    read = log(*under_way([DAY_S - 1]), sentence(end[3:-3]), rmc(DAY_S))
    assert clock_s(read.fixes) == [DAY_S - 1, DAY_S]
    assert read.report.problems == {}


def test_sentences_a_little_late_are_put_in_order(log):
    read = log(rmc(10), rmc(12), gll(11), rmc(13))
    assert clock_s(read.fixes) == [10, 11, 12, 13]
    assert len(read.set_back_lines) == 0


@pytest.mark.parametrize("wrong", [[90], [90, 90], [90, 91, 92], [4], [43000], [86399], [3, 4]])
def test_a_time_that_leaps_and_comes_back_is_left_out(log, wrong):
    lines = [*under_way(range(10, 20)), *(gll(t) for t in wrong), *under_way(range(20, 30))]
    read = log(*lines)
    assert clock_s(read.fixes) == list(range(10, 30))
    assert read.report.problems == {"time": len(wrong)}
    assert [p.line for p in read.report.examples] == [11 + k for k in range(len(wrong))]


def test_a_date_that_leaps_and_comes_back_is_left_aside(log):
    read = log(rmc(10), rmc(12, date="220508"), rmc(14), rmc(16, date="060180"), rmc(18))
    assert clock_s(read.fixes) == [10, 12, 14, 16, 18]
    assert read.report.problems == {"date": 2}


@pytest.mark.parametrize("back_s", [4, 5, 7, 60, 3600, 40000, 86400, 10 * 86400])
def test_a_clock_that_was_set_back_begins_a_part(log, back_s):
    first, second = np.arange(20) + 50000.0, np.arange(20) + 50020.0 - back_s
    read = log(*[rmc(t) for t in first], *[rmc(t) for t in second])
    assert read.report.problems == {}
    assert read.set_back_lines.tolist() == [21]
    assert clock_s(read.fixes) == [*first, *second]
    assert "the clock was set back 1 time (line 21)" in "".join(read.notes)
    parts = read.parts()
    assert [clock_s(part.fixes) for part in parts] == [list(first), list(second)]


def test_the_track_of_a_log_is_where_its_sound_fixes_are(log):
    times_s = range(1000, 1020)
    still = [rmc(1020, longitude_deg=6.7 + 20 * 3.35e-5, kn="0.0", course="")]
    read = log(*under_way(times_s), *still, gll(1021, longitude_deg=6.70067), rmc(1022, status="V"))
    track = read.track()
    assert len(track) == 22
    assert (track.north_m[0], track.east_m[0]) == (0.0, 0.0)
    np.testing.assert_allclose(np.diff(track.east_m[:20]), 5.0 * KNOT_MPS, atol=0.01)
    np.testing.assert_allclose(track.veast_mps[:20], 5.0 * KNOT_MPS)
    np.testing.assert_allclose(track.vnorth_mps[:20], 0.0, atol=1e-4)
    assert (track.vnorth_mps[20], track.veast_mps[20]) == (0.0, 0.0)
    assert np.isnan([track.vnorth_mps[21], track.veast_mps[21]]).all()
    elsewhere = read.track(LocalPlane(latitude_rad=np.radians(46.6), longitude_rad=np.radians(6.6)))
    np.testing.assert_allclose(elsewhere.north_m[0], -11_115.0, atol=10.0)
    north_leans_rad = np.radians(0.1) * np.sin(np.radians(46.5))
    np.testing.assert_allclose(
        elsewhere.vnorth_mps[0], 5.0 * KNOT_MPS * np.sin(north_leans_rad), rtol=1e-3
    )


def test_a_log_without_a_track_says_why(log):
    with pytest.raises(ValueError, match="own: a track needs a usable fix, got none"):
        log(rmc(10, status="V")).track()
    with pytest.raises(ValueError, match=r"own: the clock was set back.*parts\(\)"):
        log(*[rmc(t) for t in range(5000, 5020)], *[rmc(t) for t in range(1000, 1020)]).track()


@pytest.mark.parametrize("gap_s", [61, 3600, 43000, 50000, 80000, 86400, 10 * 86400 + 7])
def test_a_gap_is_a_gap(log, gap_s):
    times_s = [*range(1000, 1010), *range(1010 + gap_s, 1020 + gap_s)]
    read = log(*[line for t in times_s for line in (gll(t), rmc(t, kn="0.0"))])
    assert read.report.problems == {}
    assert clock_s(read.fixes) == times_s
    np.testing.assert_allclose(read.gaps_s() - MAY_21, [[1009, 1010 + gap_s]])
    assert [len(part.fixes) for part in read.parts()] == [10, 10]
    assert [len(part.fixes) for part in read.parts(max_gap_s=gap_s + 1)] == [20]
    assert "the longest" in "".join(read.notes)


def test_slow_logs_have_longer_steps(log):
    times_s = [60 * k for k in range(9)]
    read = log(*under_way(times_s))
    assert clock_s(read.fixes) == times_s
    wrong = [*under_way(times_s), rmc(7000), *under_way([t + 540 for t in times_s])]
    assert log(*wrong).report.problems == {"time": 1}


def headings(count):
    return [sentence(f"HDT,{k % 360},T") for k in range(count)]


def test_readings_without_a_time_lie_equally_between_those_with_one(log):
    lines = [line for t in (10, 12, 12, 14) for line in (*headings(1), gll(t), *headings(2))]
    read = log(*lines, date=datetime.date(2008, 5, 21))
    line = read.heading.line
    expected = np.interp(line, [2, 6, 14], [10, 12, 14])
    expected[line < 2], expected[line > 14] = 10 - 0.375, 14 + 0.375 * (line[line > 14] - 14)
    assert clock_s(read.heading) == expected
    assert (np.diff(read.heading.time_s) >= 0).all()


def test_while_fixes_are_missing_headings_continue(log):
    usual = [line for t in range(10) for line in (gll(t), *headings(4))]
    after = [line for t in range(70, 80) for line in (gll(t), *headings(4))]
    read = log(*usual, *headings(300), *after)
    assert np.diff(read.heading.time_s).max() < 0.5
    assert len(read.parts(max_gap_s=10)) == 1
    assert len(read.gaps_s()) == 1


def test_where_the_log_stopped_nothing_is_put_into_the_gap(log):
    lines = [line for t in [*range(10), *range(600, 610)] for line in (rmc(t), *headings(4))]
    read = log(*lines)
    heading_s = read.heading.time_s - MAY_21
    assert not ((heading_s > 11) & (heading_s < 599)).any()
    assert [len(part.heading) for part in read.parts()] == [40, 40]


def test_they_do_so_in_a_slow_log_of_many_days(log):
    fixes_s = 600.7 * np.arange(1500)
    lines = [line for t in fixes_s for line in (rmc(t, kn="0.0", date=""), *headings(3))]
    heading = log(*lines, rmc(600.7 * 1500, kn="0.0", date="")).heading
    expected_s = 600.7 * (heading.line - 1) / 4
    np.testing.assert_allclose(heading.time_s, expected_s, atol=1e-3)


def test_a_log_on_one_line(log):
    lines = [*headings(2), *(gll(t) for t in (*range(50, 56), *range(20, 26))), *headings(3)]
    for read in (log(*lines, end=""), log(*headings(1), "".join(lines))):
        assert read.report.problems == {}
        assert sorted(read.fixes.time_s) == [*range(20, 26), *range(50, 56)]
        assert len(read.heading) >= 5
        assert sum(len(part.fixes) for part in read.parts()) == 12


# ------------------------------------------------------------------ headings


def test_the_variation_is_that_of_the_sentence_of_rmc_or_the_one_given(log):
    compass = sentence("HDG,100,,,,")
    read = log(
        compass, rmc(10), compass, sentence("HDG,100,,,1.0,W"), rmc(12, var="2.0,E"), compass
    )
    assert np.degrees(read.compass.variation_rad) == pytest.approx([2, 2, -1, 2])
    assert np.degrees(read.heading.heading_rad) == pytest.approx([102, 102, 99, 102])
    read = log(rmc(10), compass, sentence("HDG,359.5,,,1.0,W"), variation_deg=-3.0)
    assert np.degrees(read.heading.heading_rad) == pytest.approx([97, 356.5])
    read = log(rmc(10), compass, compass)
    assert np.isnan(read.compass.variation_rad).all()
    assert np.isnan(read.compass.heading_rad).all()
    assert len(read.heading) == 0
    assert read.notes == ["own.nmea: no true heading; 2 magnetic ones need a variation"]
    assert log(rmc(10)).notes == ["own.nmea: no true heading"]


def test_headings_come_from_the_best_sentence_there_is(log):
    vhw, hdg, hdt = map(sentence, ("VHW,10,T,11,M,6,N,,K", "HDG,12,,,1,E", "HDT,13,T"))

    def degrees(*lines):
        return np.degrees(log(rmc(10), *lines).heading.heading_rad).tolist()

    assert degrees(vhw, hdg, hdt) == pytest.approx([13])
    assert degrees(hdg, sentence("THS,1,V")) == pytest.approx([13])
    assert degrees(vhw, hdg) == pytest.approx([10])
    assert degrees(hdg) == pytest.approx([13])
    read = log(rmc(10), vhw, hdg, hdt)
    assert read.compass.sentence.tolist() == ["HDG"]
    assert log(rmc(10), vhw).compass.sentence.tolist() == ["VHW"]


@pytest.mark.parametrize(("variation", "taken"), [("3.0,E", 40), (",", 0)])
def test_where_true_headings_are_silent_those_of_the_compass_continue(log, variation, taken):
    lines = []
    for t, fix in enumerate(under_way(range(120))):
        lines += [fix, sentence(f"HDG,37.0,,,{variation}")]
        lines += [] if 40 < t <= 100 else [sentence("HDT,40.5,T")]
    read = log(*lines)
    heading = read.heading
    assert np.count_nonzero(heading.sentence == "HDT") == 60
    compass = heading.rows(heading.sentence == "HDG")
    assert len(compass) == pytest.approx(taken, abs=1)
    np.testing.assert_allclose(np.degrees(compass.heading_rad), 40.0)
    assert ((compass.time_s > MAY_21 + 50) & (compass.time_s < MAY_21 + 92)).all()
    assert (np.diff(heading.time_s) > 0).all()
    found = "magnetic headings without true ones need a variation (first in line 145)"
    assert [found in note for note in read.notes if "variation" in note] == [True] * (taken == 0)


# ------------------------------------------------------------------ fixes to doubt


def test_fixes_at_zero_are_suspect(log):
    lines = under_way(range(10, 20))
    lines[4] = rmc(14, 0.0, 0.0)
    read = log(*lines)
    assert np.flatnonzero(read.fixes.suspect).tolist() == [4]
    assert len(read.fixes.sound()) == 9
    assert log(*(rmc(t, 0.0, 0.0) for t in range(5))).fixes.suspect.all()


def test_fixes_at_zero_are_not_frozen_too(log):
    lines = under_way(range(200))
    lines[30:180] = [rmc(t, 0.0, 0.0) for t in range(30, 180)]
    read = log(*lines)
    assert not read.fixes.frozen.any()
    assert read.fixes.suspect.sum() == 150
    assert not any("frozen" in note for note in read.notes)


def test_a_fix_where_the_vessel_cannot_have_come_is_suspect(log):
    lines = under_way(range(10, 20))
    lines[4] = rmc(14, 46.6)
    assert np.flatnonzero(log(*lines).fixes.suspect).tolist() == [4]
    assert not log(*lines, max_speed_mps=20000.0).fixes.suspect.any()
    across = [rmc(t, 0.5, (179.9999 + 2e-5 * t + 180) % 360 - 180) for t in range(20)]
    assert not log(*across).fixes.suspect.any()


def jumping(*where, seconds=300):
    """RMC of a vessel that goes east, moved north by degrees at the times of some slices."""
    north_deg = np.zeros(seconds)
    for times, moved_deg in where:
        north_deg[times] += moved_deg
    return [rmc(t, 46.5 + north, 6.7 + 3.35e-5 * t) for t, north in enumerate(north_deg)]


@pytest.mark.parametrize("count", [3, 9, 120])
def test_fixes_that_jump_and_come_back_are_suspect_all_of_them(log, count):
    read = log(*jumping((slice(100, 100 + count), 0.5)))
    assert np.flatnonzero(read.fixes.suspect).tolist() == list(range(100, 100 + count))
    (reported,) = [note for note in read.notes if "out of the vessel's reach" in note]
    assert f"{count} fixes" in reported
    assert "first in line 101" in reported
    twice = log(*jumping((slice(100, 120), 0.5), (slice(120, 130), -0.5)))
    assert np.flatnonzero(twice.fixes.suspect).tolist() == list(range(100, 130))


def test_fixes_that_jump_and_stay_are_believed_and_reported(log):
    read = log(*jumping((slice(100, 300), 0.5), (slice(150, 154), -0.4)))
    assert np.flatnonzero(read.fixes.suspect).tolist() == [150, 151, 152, 153]
    (reported,) = [note for note in read.notes if "jumps" in note]
    assert "1 time out of the vessel's reach, first by 55.6 km in line 101" in reported
    assert "196 fixes continue" in reported
    silent = log(*(rmc(t + 3000 * (t > 50), 46.5 + 0.5 * (t > 50)) for t in range(100)))
    assert not silent.fixes.suspect.any()
    assert not any("jumps" in note for note in silent.notes)


@pytest.mark.parametrize("source", ["rmc", "vhw"])
def test_fixes_that_stay_while_the_vessel_moves_are_frozen(log, source):
    lines = []
    for t in range(60):
        kept = 20 if 20 < t < 50 else t
        fix = rmc if source == "rmc" else gll
        lines += [fix(t, longitude_deg=6.7 + 3.35e-5 * kept), sentence("VHW,,T,,M,5.0,N,,K")]
    fixes = log(*lines).fixes
    assert np.flatnonzero(fixes.frozen).tolist() == list(range(21, 50))
    assert not fixes.usable[fixes.frozen].any()


@pytest.mark.parametrize("kind", ["HDT,40.0,T", "HDM,40.0,M"])
@pytest.mark.parametrize(
    ("lost", "longest_s"),
    [(range(200, 300), 101), (range(100), 100), (range(500, 600), 100), (range(200, 250), 0)],
)
def test_a_heading_that_is_lost_for_long_is_reported(log, kind, lost, longest_s):
    lines = [
        line
        for t, fix in enumerate(under_way(range(600)))
        for line in (fix, *([] if t in lost else [sentence(kind)]))
    ]
    reported = [note for note in log(*lines).notes if "without a heading" in note]
    if longest_s == 0:
        assert reported == []
    else:
        (note,) = reported
        assert "1 interval of more than 60 s without a heading" in note
        assert float(note.split()[-2]) == pytest.approx(longest_s, abs=1.0)


def test_a_log_that_stopped_or_has_no_heading_lost_none(log):
    fixes = under_way([*range(100), *range(4000, 4100)])
    stopped = log(*(line for fix in fixes for line in (fix, sentence("HDT,40.0,T"))))
    for read in (stopped, log(*fixes)):
        assert not any("without a heading" in note for note in read.notes)


@pytest.mark.parametrize("speeds", ["rmc", "vtg"])
@pytest.mark.parametrize("live", [True, False])
def test_speeds_that_stay_the_same_beside_frozen_fixes_are_frozen_too(log, speeds, live):
    lines = []
    for t in range(60):
        frozen = 20 < t < 50
        where = 6.7 + 3.35e-5 * (20 if frozen else t)
        kn = f"{5.0 + 0.1 * (t % 2)}" if live and frozen else "5.0"
        if speeds == "rmc":
            lines += [rmc(t, longitude_deg=where, kn=kn)]
        else:
            lines += [gll(t, longitude_deg=where), sentence(f"VTG,90,T,,M,{kn},N,,K,A")]
    read = log(*lines)
    frozen = [] if live else list(range(21, 50))
    assert np.flatnonzero(read.ground.frozen).tolist() == frozen
    assert np.flatnonzero(~read.ground.usable).tolist() == frozen
    reported = [note for note in read.notes if "29 speeds over ground repeated" in note]
    assert len(reported) == (not live)


def test_a_vessel_that_lies_still_long_after_her_last_speed_is_not_frozen(log):
    way = [gll(t, longitude_deg=6.7 + 3.35e-5 * t) for t in range(300)]
    still = [gll(t, longitude_deg=6.71) for t in range(300, 900)]
    speeds = [sentence("VTG,90,T,,M,5.0,N,,K,A")] * 120
    reported = [line for pair in zip(way, speeds, strict=False) for line in pair]
    assert not log(*reported, *way[120:], *still).fixes.frozen.any()
    moving = [line for fix in still for line in (fix, sentence("VHW,,T,,M,5.0,N,,K"))]
    assert log(*reported, *way[120:], *moving).fixes.frozen.sum() == 599


def test_a_vessel_at_rest_is_not_frozen(log):
    assert not log(*(rmc(t, kn="0.3") for t in range(0, 3600, 10))).fixes.frozen.any()
    assert not log(*(gll(t) for t in range(0, 3600, 10))).fixes.frozen.any()
    slow = [rmc(t, longitude_deg=6.7 + round(3.35e-5 * t, 4)) for t in range(100)]
    assert not log(*slow).fixes.frozen.any()


def test_readings_that_their_instrument_calls_not_valid_are_reported(log):
    bad = ["VBW,5.0,0.1,V,5.1,0.2,V", "VBW,5.0,0.1,A,5.1,0.2,V", "ROT,3.0,V", "THS,90.0,V"]
    read = log(rmc(10), *map(sentence, bad), sentence("HDG,89.0,,,1.0,E"), rmc(12))
    assert read.heading.sentence.tolist() == ["HDG"]
    for reported in (
        "1 heading marked invalid by the instrument (first in line 5)",
        "1 speed through the water marked invalid by the instrument (first in line 2)",
        "2 speeds over ground by log marked invalid by the instrument (first in line 2)",
        "1 rate of turn marked invalid by the instrument (first in line 4)",
    ):
        assert f"own.nmea: {reported}" in read.notes
    good = ["VBW,5.0,0.1,A,5.1,0.2,A", "VBW,,,V,,,V", "ROT,3.0,A", "THS,90.0,A"]
    assert log(rmc(10), *map(sentence, good), rmc(12)).notes == []


# ------------------------------------------------------------------ bad lines


def test_lines_that_cannot_be_used_are_counted_and_kept_by_kind(log):
    bad = {
        "checksum": rmc(12)[:-2] + "00",
        "no sentence": "switched on",
        "cut": rmc(12)[:30],
        "character": sentence("HDG,1\xb52,,,,"),
        "address": "$II%5Q%5]I5*70",
        "field": sentence("HDT,1e2,T"),
        "range": sentence("HDT,400,T"),
    }
    read = log(rmc(10), *bad.values(), rmc(14))
    assert read.report.problems == dict.fromkeys(bad, 1)
    assert [p.kind for p in read.report.examples] == list(bad)
    assert [p.line for p in read.report.examples] == list(range(2, 9))
    assert all(p.reason for p in read.report.examples)
    assert clock_s(read.fixes) == [10, 14]
    assert read.report.lines == 9
    for kind in bad:
        assert any(kind in note and "first in line" in note for note in read.notes)


@pytest.mark.parametrize(
    ("body", "kind", "words"),
    [
        ("RMC,126000,A,4630.0,N,00640.0,E,,,210508,,,A", "range", "field 1"),
        ("RMC,1200000,A,4630.0,N,00640.0,E,,,210508,,,A", "field", "hhmmss"),
        ("RMC,120000,A,9030.0,N,00640.0,E,,,210508,,,A", "range", "0 to 90"),
        ("RMC,120000,A,4660.1,N,00640.0,E,,,210508,,,A", "range", "minutes"),
        ("RMC,120000,A,463.0,N,00640.0,E,,,210508,,,A", "range", "minutes"),
        ("RMC,120000,A,046300.0,N,00640.0,E,,,210508,,,A", "field", "ddmm.mm"),
        ("RMC,120000,A,4630.0,,00640.0,E,,,210508,,,A", "field", "N or S"),
        ("RMC,120000,A,4630.0,N,18000.1,E,,,210508,,,A", "range", "0 to 180"),
        ("GGA,120000,4630.0,N,00661.0,E,1,,,,,,,,", "range", "minutes"),
        ("GLL,4630.0,N,nan,E,120000,A", "field", "dddmm.mm"),
        ("ZDA,126000,21,05,2008,00,00", "range", "field 1"),
    ],
)
def test_without_time_or_place_a_sentence_is_left_out(log, body, kind, words):
    read = log(rmc(10), sentence(body), rmc(12))
    assert clock_s(read.fixes) == [10, 12]
    (problem,) = read.report.examples
    assert (problem.line, problem.kind) == (2, kind)
    assert words in problem.reason


@pytest.mark.parametrize(
    ("body", "valid", "words"),
    [
        ("RMC,000011,A,4630.0,N,00640.0,E,5,90,000000,,,A", True, "a date"),
        ("RMC,000011,A,4630.0,N,00640.0,E,5,90,310208,,,A", True, "a date"),
        ("RMC,000011,A,4630.0,N,00640.0,E,5,90,21052008,,,A", True, "ddmmyy"),
        ("RMC,000011,X,4630.0,N,00640.0,E,5,90,210508,,,A", False, "field 2: wanted one of A V"),
        ("RMC,000011,A,4630.0,N,00640.0,E,5,90,210508,,,X", False, "field 12"),
        ("GGA,000011,4630.0,N,00640.0,E,X,,,,,,,,", False, "field 6: wanted a number"),
        ("GGA,000011,4630.0,N,00640.0,E,10,,,,,,,,", False, "field 6: wanted 0 to 9"),
        ("GNS,000011,4630.0,N,00640.0,E,AX,,,,,,,", False, "field 6"),
        ("GLL,4630.0,N,00640.0,E,000011,X,A", False, "field 6"),
    ],
)
def test_a_bad_field_beside_them_costs_neither_time_nor_place(log, body, valid, words):
    read = log(rmc(10), sentence(body), rmc(12))
    assert clock_s(read.fixes) == [10, 11, 12]
    assert read.fixes.latitude_deg == pytest.approx(46.5)
    assert read.fixes.valid.tolist() == [True, valid, True]
    if body.startswith("RMC"):
        assert read.ground.speed_mps == pytest.approx(5.0 * KNOT_MPS)
        assert read.ground.valid.tolist() == [True, valid, True]
    (problem,) = read.report.examples
    assert problem.line == 2
    assert words in problem.reason


@pytest.mark.parametrize(
    ("body", "speed_mps", "course_deg", "valid"),
    [
        ("VTG,45,X,,M,,N,18,K", 5.0, math.nan, True),
        ("VTG,45,T,,M,6.5,X,18,K", 5.0, 45.0, True),
        ("VTG,45,T,,M,6.5,X,,K", math.nan, 45.0, True),
        ("VTG,45,T,,M,,N,18,K,X", 5.0, 45.0, False),
    ],
)
def test_a_bad_letter_of_a_vtg_costs_what_it_stands_for(log, body, speed_mps, course_deg, valid):
    read = log(gga(10), sentence(body), gga(12))
    np.testing.assert_allclose(read.ground.speed_mps, [speed_mps])
    np.testing.assert_allclose(np.degrees(read.ground.course_rad), [course_deg])
    assert read.ground.valid.tolist() == [valid]
    assert read.report.problems == {"field": 1}


def test_a_gga_of_quality_9_is_differential(log):
    read = log(rmc(10), gga(12, quality="9"))
    assert read.fixes.quality.tolist() == [1, 2]
    assert read.fixes.valid.all()
    assert read.report.problems == {}


def test_dates_that_the_receiver_does_not_know_yet_leave_a_log_without_a_date(log):
    read = log(*(rmc(10 + t, date="000000") for t in range(5)))
    assert len(read.fixes) == len(read.ground) == 5
    assert not read.dated
    assert read.report.problems == {"range": 5}


@pytest.mark.parametrize(
    ("date", "words"),
    [
        ("21,05,08", "field 4: wanted 1980 to 9999, got '08'"),
        ("21,05,1979", "wanted 1980 to 9999, got '1979'"),
        ("21.5,05,2008", "field 2: wanted a whole number, got '21.5'"),
        ("21,-5,2008", "field 3: wanted a whole number"),
        ("32,05,2008", "a date"),
    ],
)
def test_a_zda_with_a_bad_date_reports_the_time_alone(log, date, words):
    read = log(sentence(f"ZDA,000010,{date},00,00"), gll(12))
    assert not read.dated
    assert read.fixes.time_s.tolist() == [12]
    assert [p.line for p in read.report.examples] == [1]
    assert words in str(read.report.examples[0])


@pytest.mark.parametrize(
    "text", ["nan", "NaN", "-", "---.-", "inf", "1e1", "1_0", "9" * 400, "0x1"]
)
def test_of_another_bad_field_only_the_value_is_lost(log, text):
    read = log(rmc(10), rmc(12, kn=text), rmc(14, var=f"{text},E"))
    assert len(read.fixes) == 3
    kind = "range" if text.isdigit() else "field"
    assert read.report.problems == {kind: 2}
    assert np.isnan(read.ground.speed_mps).tolist() == [False, True, False]
    assert np.isfinite(read.ground.course_rad).all()


def test_a_sentence_cut_anywhere_is_never_taken_for_another(log):
    """With checksums around it, and without them for all that the sentence must hold."""
    for whole in (rmc(12, 47.0), gga(12, 47.0), gll(12, 47.0), sentence("HDG,123.5,1.0,E,2.0,E")):
        for cut in range(1, len(whole)):
            read = log(rmc(10), whole, whole[:cut], rmc(14))
            assert read.report.problems.total() == 1
            assert np.unique(read.fixes.latitude_deg).size <= 2
            joined = log(rmc(10), whole[:cut] + rmc(14), whole)
            assert joined.report.problems.total() == 1
            assert len(joined.fixes) >= 2


def test_without_checksums_what_is_cut_is_found_or_does_no_harm(log):
    first = rmc(10).partition("*")[0]
    for line in (rmc(12, 46.5001), gga(12, 46.5001), gll(12, 46.5001)):
        bare = line.partition("*")[0]
        for cut in range(1, len(bare)):
            read = log(first, bare[:cut])
            if len(read.fixes) == 2:
                assert read.fixes.latitude_deg[1] == pytest.approx(46.5001)
                assert read.fixes.longitude_deg[1] == pytest.approx(6.7)
                assert np.isclose(read.fixes.time_s[1] - MAY_21, 12)
                assert read.ground.speed_mps == pytest.approx(5.0 * KNOT_MPS)
            else:
                assert read.report.problems.total() > 0


def test_fields_are_shown_as_they_are_written(log):
    read = log(sentence("RMC,100000,A,50three,N,00230.0,E,1.0,0.0,010620,,"), rmc(10))
    assert "got '50three'" in str(read.report.examples[0])


def test_sentences_without_what_they_are_there_for_are_reported(log):
    empty = ["HDT,,T", "HDT,,T", "ROT,,A", "RMC,100011,V,,,,,,,010620,,", "VHW,,T,,M,,N,,K"]
    notes = log(rmc(10), sentence("HDT,40.0,T"), *map(sentence, empty), rmc(12)).notes
    for reported in (
        "2 HDT sentences have no heading (first in line 3)",
        "1 ROT sentence has no rate of turn (first in line 5)",
        "1 RMC sentence has no position (first in line 6)",
        "1 VHW sentence has no heading or speed (first in line 7)",
    ):
        assert f"own.nmea: {reported}" in notes


def test_a_date_that_stays_the_same_over_midnight_is_stale_until_it_changes(log):
    def timed(clock, date):
        return sentence(f"RMC,{clock},A,5000.0,N,00230.0,E,0.0,0.0,{date},,")

    before = [timed(f"2359{s:02d}", "010620") for s in range(50, 60)]
    stale = [timed(f"0000{s:02d}", "010620") for s in range(20)]
    mended = [timed(f"0000{s:02d}", "020620") for s in range(20, 40)]
    for lines in (before + stale, before + stale + mended):
        read = log(*lines)
        assert len(read.set_back_lines) == 0
        assert np.diff(read.fixes.time_s) == pytest.approx(1.0)
        assert read.report.problems == {"date": 20}
        assert "the date is that of the day before" in str(read.report.examples[0])


def test_examples_are_bounded_and_counts_are_not(log):
    read = log(rmc(10), *["junk"] * 100_500)
    assert read.report.problems["no sentence"] == 100_500
    assert len(read.report.examples) == 100_000


# ------------------------------------------------------------------ forms of lines


@pytest.mark.parametrize(
    "dress",
    [
        lambda body: f"2008-05-21T12:00:00.250Z {sentence(body)}",
        lambda body: f"1211371200,{sentence(body)}",
        lambda body: f"\\s:GP0001,n:23,c:1211371200*2A\\{sentence(body)}",
        lambda body: f"UdPbC\0\\s:GP0001*00\\{sentence(body)}",
        lambda body: f"\xe9\xb5 {sentence(body)}",
        lambda body: f"  {sentence(body)}  ",
        lambda body: f"{sentence(body)},1211371200",
        lambda body: f"\n{sentence(body)}\n",
        lambda body: f"${body}",
        lambda body: f"$GP{body}",
        lambda body: sentence(body.lower(), "gp"),
        lambda body: sentence(body)[:-2] + sentence(body)[-2:].lower(),
        lambda body: sentence(body.replace(",", " , ")),
    ],
)
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r", "\r\r\n", ""])
def test_lines_in_many_dresses(log, dress, end):
    bodies = (line[3:-3] for line in (rmc(10, 1.5), sentence("HDT,90,T"), rmc(12, 1.5)))
    read = log(*map(dress, bodies), end=end)
    assert read.report.problems == {}
    assert clock_s(read.fixes) == [10, 12]
    assert read.fixes.latitude_deg == pytest.approx([1.5, 1.5])
    assert np.degrees(read.heading.heading_rad) == pytest.approx([90])


@pytest.mark.parametrize(("end", "of_each"), [("\r\n\r\n", 2), ("\n\r", 2), ("\n\n\n", 3)])
def test_blank_lines_change_nothing(log, end, of_each):
    lines = [
        line
        for t in [*range(10, 50), *range(900, 940)]
        for line in (rmc(t), *(sentence(f"HDT,{(7 * t + k) % 360},T") for k in range(3)))
    ]
    dense, sparse = log(*lines), log(*lines, end=end)
    assert sparse.heading.time_s == pytest.approx(dense.heading.time_s)
    np.testing.assert_array_equal(sparse.heading.heading_rad, dense.heading.heading_rad)
    assert sparse.fixes.time_s == pytest.approx(dense.fixes.time_s)
    assert dense.report.lines == len(lines)
    assert sparse.report.lines == of_each * len(lines)


def test_other_sentences_are_counted(log):
    ais = "!AIVDM,1,1,,A,13aG?P0P00PD;88MD5MTDww@2<0L,0*23"
    ais = ais[:-2] + f"{reduce(xor, ais[1:-3].encode(), 0):02X}"
    read = log(rmc(10), sentence("GSV,1,1,00"), sentence("GRME,1", "P"), ais)
    assert read.report.sentences == {"RMC": 1, "GSV": 1, "PGRME": 1, "VDM": 1}
    assert read.report.problems == {}


# ------------------------------------------------------------------ files that cannot be read


@pytest.mark.parametrize(
    ("octets", "words"),
    [
        (b"", ["0 lines", "no sentence"]),
        (b"time,lat,lon\n1,2,3\n", ["2 lines", "line 1"]),
        (b"$GPGSV,1,1,00\n", ["1 GSV"]),
        (b"$HEHDT,1.0,T\n", ["1 HDT"]),
        (b"$GPZDA,120000,21,05,2008,00,00\n", ["1 ZDA"]),
        (b"$HEHDT,1.0,T*00\n", ["1 of 'checksum'", "line 1"]),
        (bytes(range(256)), ["binary"]),
    ],
)
def test_a_file_without_readings_is_an_error(tmp_path, octets, words):
    path = tmp_path / "own.nmea"
    path.write_bytes(octets)
    with pytest.raises(RecordingError) as caught:
        read_nmea(path)
    for word in ("own.nmea", "wanted NMEA 0183 sentences", *words):
        assert word in str(caught.value)


def test_a_file_in_utf_16_is_named_and_one_of_gzip_is_read(tmp_path):
    path = tmp_path / "own.nmea"
    text = "\n".join(under_way(range(10)))
    path.write_bytes(gzip.compress(text.encode()))
    assert len(read_nmea(path).fixes) == 10
    for encoding in ("utf-16", "utf-16-le", "utf-16-be"):
        path.write_bytes(text.encode(encoding))
        with pytest.raises(RecordingError, match="got text in UTF-16, save it as UTF-8 first"):
            read_nmea(path)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (rmc(10).replace("E,5.0", "E,6.0"), "no sentence with a time could be read"),
        (rmc(10, where="x,N,y,E"), "no sentence with a time could be read"),
        (sentence("ZDA,120000,21,05,2008,00,00"), "no sentence with a reading could be read"),
    ],
)
def test_a_log_with_times_is_not_said_to_have_none(log, line, words):
    with pytest.raises(RecordingError, match=words):
        log(line)


def test_what_is_no_file_is_an_error(tmp_path):
    for path in (tmp_path, tmp_path / "none.nmea"):
        with pytest.raises(RecordingError, match=r"cannot be read \(.*wanted a log of NMEA 0183"):
            read_nmea(path)


@pytest.mark.parametrize(
    "wrong",
    [
        {"variation_deg": 181.0},
        {"variation_deg": math.nan},
        {"reorder_s": -1.0},
        {"max_speed_mps": 0.0},
    ],
)
def test_parameters_that_are_invalid(log, wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        log(rmc(10), **wrong)


def test_a_date_is_a_date(log):
    read = log(gll(5), date=datetime.datetime(2008, 5, 21, 12, 30))
    assert clock_s(read.fixes) == [5]
    with pytest.raises(TypeError, match=r"date must be a datetime.date, got '2008-05-21'"):
        log(gll(5), date="2008-05-21")


# ------------------------------------------------------------------ laws


SOME = [*under_way(range(10, 16)), sentence("HDT,90,T"), gga(15), sentence("ROT,3.0,A")]
ALPHABET = "$!*,.\\ \r\nARMCGLHDT0123456789NESW-nai\xb5\0"


def written(tmp_path_factory, octets):
    path = tmp_path_factory.getbasetemp() / "law.nmea"
    path.write_bytes(octets)
    return path


@given(
    junk=st.lists(
        st.binary(max_size=80) | st.text(ALPHABET, max_size=80).map(lambda t: t.encode("latin-1"))
    )
)
def test_no_line_is_fatal_and_the_others_stay(tmp_path_factory, junk):
    text = "\r\n".join([*SOME, ""]).encode()
    alone = read_nmea(written(tmp_path_factory, text))
    mixed = read_nmea(written(tmp_path_factory, text + b"\n".join([*junk, b""])))
    assert len(mixed.fixes) >= len(alone.fixes)
    assert set(alone.fixes.time_s) <= set(mixed.fixes.time_s)
    kept = len(alone.heading)
    np.testing.assert_array_equal(mixed.heading.heading_rad[:kept], alone.heading.heading_rad)


@given(
    which=st.integers(0, len(SOME) - 1),
    place=st.integers(0, 200),
    octet=st.integers(0, 255),
)
@example(which=0, place=0, octet=ord("!"))
@example(which=0, place=0, octet=ord("*"))
@example(which=0, place=40, octet=ord("$"))
@example(which=0, place=40, octet=ord("\\"))
def test_a_changed_octet_is_always_counted(tmp_path_factory, which, place, octet):
    text = [line.encode() for line in (*SOME, *SOME)]
    at = place % len(text[which])
    before = text[which][at]
    text[which] = text[which][:at] + bytes([octet]) + text[which][at + 1 :]
    report = read_nmea(written(tmp_path_factory, b"\r\n".join([*text, b""]))).report
    same = octet == before
    same |= at >= len(text[which]) - 2 and chr(before).upper() == chr(octet).upper()
    assert (report.problems.total() == 0) == same


@given(
    times_s=st.lists(
        st.integers(0, 86399) | st.integers(1000, 1040) | st.sampled_from([86399, 0, 43200]),
        min_size=1,
        max_size=40,
    ),
    dates=st.lists(st.sampled_from([None, "210508", "220508", "010180"]), min_size=40, max_size=40),
    end=st.sampled_from(["\n", ""]),
)
@example(
    times_s=[0, 0, 801, 160],
    dates=[None, "010180", "210508", "210508", *[None] * 36],
    end="",
)
def test_whatever_the_clock_does_no_fix_is_lost(tmp_path_factory, times_s, dates, end):
    lines = []
    for t, date in zip(times_s, dates, strict=False):
        lines += [gll(t) if date is None else rmc(t, date=date, kn="", course=""), *headings(1)]
    read = read_nmea(written(tmp_path_factory, end.join([*lines, ""]).encode()))
    wrong = read.report.problems["time"]
    assert len(read.fixes) + read.report.repeated + wrong == len(times_s)
    assert len(read.heading) == len(times_s)
    parts = read.parts()
    for name, series in read.series.items():
        assert np.isfinite(series.time_s).all()
        assert sum(len(part.series[name]) for part in parts) == len(series)
    for part in parts:
        assert (np.diff(part.fixes.time_s) > 0).all()
        assert (np.diff(part.heading.time_s) >= 0).all()


@given(
    start_s=st.integers(0, 86399),
    rows=st.lists(
        st.tuples(
            st.floats(-89.9, 89.9),
            st.floats(-179.9, 179.9),
            st.floats(0, 99),
            st.floats(0, 359.9),
            st.floats(-700, 700),
        ),
        min_size=1,
        max_size=20,
    ),
)
@example(start_s=86395, rows=[(0.0, -0.001, 0.0, 0.0, 0.0)] * 12)
def test_what_is_written_is_read(tmp_path_factory, start_s, rows):
    lines = []
    for k, (latitude, longitude, kn, course, rate) in enumerate(rows):
        lines += [
            rmc(start_s + k, latitude, longitude, kn=f"{kn:.2f}", course=f"{course:.1f}"),
            sentence(f"HDT,{course:.1f},T"),
            sentence(f"ROT,{rate:.1f},A"),
        ]
    read = read_nmea(written(tmp_path_factory, "\n".join(lines).encode()))
    latitude, longitude, kn, course, rate = np.array(rows).T
    assert clock_s(read.fixes) == start_s + np.arange(len(rows))
    np.testing.assert_allclose(read.fixes.latitude_deg, latitude, rtol=0, atol=1e-8)
    np.testing.assert_allclose(read.fixes.longitude_deg, longitude, rtol=0, atol=1e-8)
    np.testing.assert_allclose(read.ground.speed_mps, kn * KNOT_MPS, rtol=0, atol=0.0051 * KNOT_MPS)
    for angle in (read.ground.course_rad, read.heading.heading_rad):
        off = np.mod(angle - np.radians(course) + np.pi, 2 * np.pi) - np.pi
        assert np.abs(off).max() <= np.radians(0.0501)
    np.testing.assert_allclose(
        read.turn.turn_rate_rad_s, np.radians(rate) / 60, rtol=0, atol=np.radians(0.0501) / 60
    )


@given(
    steps_s=st.lists(st.integers(1, 9), min_size=2, max_size=40),
    cut=st.integers(1, 39),
    gap_s=st.integers(1, 40000),
)
def test_two_logs_one_after_the_other_are_one_log(tmp_path_factory, steps_s, cut, gap_s):
    times_s = np.cumsum(steps_s)
    times_s[cut:] += gap_s
    lines = [line for t in times_s.tolist() for line in (rmc(t, kn="0.0"), gll(t), *headings(1))]
    cut = min(cut, len(times_s) - 1)
    a, b = lines[: 3 * cut], lines[3 * cut :]
    one, two, both = (
        read_nmea(written(tmp_path_factory, "\n".join([*part, ""]).encode()))
        for part in (a, b, a + b)
    )
    for name in ("time_s", "latitude_deg", "longitude_deg", "valid", "sentence"):
        parts = [getattr(one.fixes, name), getattr(two.fixes, name)]
        np.testing.assert_array_equal(np.concatenate(parts), getattr(both.fixes, name))
    assert one.report.sentences + two.report.sentences == both.report.sentences
    assert len(one.heading) + len(two.heading) == len(both.heading)
    assert (np.diff(both.heading.time_s) >= 0).all()


# ------------------------------------------------------------------ a real log


@pytest.fixture(scope="module")
def irene():
    return recording.load_navigation()


def test_irene_holds_what_its_source_says(irene):
    report, fixes = irene.report, irene.fixes
    assert (report.lines, report.sentences["RMC"], report.sentences["GLL"]) == (14164, 3530, 3529)
    assert report.problems == {"character": 3, "address": 1}
    assert [p.line for p in report.examples] == [862, 882, 1241, 1589]
    assert (len(fixes), np.count_nonzero(fixes.sentence == "GLL")) == (2196, 37)
    assert fixes.usable.all()
    assert len(irene.set_back_lines) == 0
    start_s = MAY_21 + 3600 * np.array([16 + 43 / 60, 18.0])
    assert fixes.time_s[0] == start_s[0]
    assert start_s[1] - 10 < fixes.time_s[-1] < start_s[1]
    stops = np.diff(irene.ground.time_s)
    assert stops[stops > 10].tolist() == [140, 30]
    assert np.median(irene.ground.speed_mps) / KNOT_MPS == pytest.approx(5.7, abs=0.01)
    assert [len(part.fixes) for part in irene.parts()] == [256, 1940]
    assert "3540 magnetic ones need a variation" in irene.notes[-1]


def test_speeds_and_courses_of_irene_are_those_of_her_positions(irene):
    """Which they would not be with a wrong time, unit or angle."""
    north_m, east_m = (
        irene.fixes.plane()
        .position_m(latitude_rad=irene.fixes.latitude_rad, longitude_rad=irene.fixes.longitude_rad)
        .T
    )
    way_m, told_m = [], []
    for start in range(0, len(irene.fixes) - 15, 15):
        rows = slice(start, start + 16)
        time_s = irene.fixes.time_s[rows]
        if np.diff(time_s).max() > 10:
            continue
        ground = irene.ground.rows(
            (irene.ground.time_s >= time_s[0]) & (irene.ground.time_s <= time_s[-1])
        )
        velocity = ground.speed_mps * np.exp(1j * ground.course_rad)
        between = 0.5 * (velocity[1:] + velocity[:-1]) * np.diff(ground.time_s)
        told_m.append(between.sum())
        way_m.append(
            complex(north_m[rows][-1] - north_m[rows][0], east_m[rows][-1] - east_m[rows][0])
        )
    ratio = np.vdot(told_m, way_m) / np.vdot(told_m, told_m).real
    assert abs(ratio) == pytest.approx(1.0, abs=0.03)
    assert np.angle(ratio) == pytest.approx(0.0, abs=0.03)


def test_headings_of_irene_are_spread_over_the_times_of_her_fixes():
    irene = recording.load_navigation(variation_deg=1.0)
    step_s = np.diff(irene.heading.time_s)
    assert (step_s > 0).all()
    assert np.median(step_s) == pytest.approx(1.25, abs=0.1)
    np.testing.assert_allclose(
        np.mod(irene.heading.heading_rad - irene.compass.heading_magnetic_rad, 2 * np.pi),
        np.radians(1),
    )
    assert irene.notes[-1].endswith("the longest 140 s")


def test_irene_is_read_as_by_another_reader(irene):
    pynmea2 = pytest.importorskip("pynmea2")
    path = Path(recording.__file__).parent / "data" / "irene" / "irene.nmea"
    lines = path.read_text(encoding="latin-1").splitlines()
    for k in range(0, len(irene.fixes), 7):
        other = pynmea2.parse(lines[irene.fixes.line[k] - 1])
        assert irene.fixes.latitude_deg[k] == pytest.approx(other.latitude, abs=1e-9)
        assert irene.fixes.longitude_deg[k] == pytest.approx(other.longitude, abs=1e-9)
        clock = datetime.datetime.combine(datetime.date(2008, 5, 21), other.timestamp)
        assert irene.fixes.time_s[k] == clock.replace(tzinfo=datetime.timezone.utc).timestamp()
