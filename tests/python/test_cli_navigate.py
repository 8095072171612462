"""`wakeline navigate`: own ship's solution from a log of its instruments."""

import csv
import json
import re
import sys
import tracemalloc
import warnings
from importlib import resources

import numpy as np
import pytest

from wakeline import _progress, own_ship
from wakeline.cli import main
from wakeline.navigation import LocalPlane
from wakeline.own_ship import coasting
from wakeline.recording import read_nmea
from wakeline.recording.own_csv import read_own

pytestmark = pytest.mark.usefixtures("no_pictures")

BUNDLED = resources.files("wakeline.recording") / "data" / "irene"
KN = 1852.0 / 3600.0
NORTH_M, EAST_M = 111_239.0, 70_949.0  # of a degree at 50.5 degrees north


def sentence(body):
    check = 0
    for octet in body.encode():
        check ^= octet
    return f"${body}*{check:02X}\n"


def heading_deg(second):
    """40 degrees, and 90 more after every five minutes, at 3 degrees a second."""
    return (
        40.0
        + 90.0 * (second // 300)
        - (90.0 - np.minimum(3.0 * (second % 300), 90.0)) * (second >= 300)
    )


def changed(lines, kind, seconds, field, value):
    """Sentences with another field, or what a function makes of it, in some seconds."""
    lines = list(lines)
    for k, line in enumerate(lines):
        if line[3:6] == kind and k // 3 in seconds:
            fields = line[1:].partition("*")[0].split(",")
            fields[field] = value(fields[field]) if callable(value) else value
            lines[k] = sentence(",".join(fields))
    return lines


def voyage(
    minutes=20,
    current_kn=(0.8, -0.5),
    *,
    compass="HDT",
    water=True,
    across_kn=0.0,
    across_given=False,
    bottom=False,
    turn=False,
    compass_std_deg=1.0,
    seed=1,
):
    """Sentences of a ship of 6 kn that turns every five minutes, in a current (north, east).

    It also moves through the water to starboard at `across_kn`.
    """
    rng = np.random.default_rng(seed)
    lines, north, east = [], 0.0, 0.0
    for second in range(60 * minutes):
        heading = np.deg2rad(heading_deg(second))
        c, s = np.cos(heading), np.sin(heading)
        vn = (6.0 * c - across_kn * s + current_kn[0]) * KN
        ve = (6.0 * s + across_kn * c + current_kn[1]) * KN
        north, east = north + vn, east + ve
        clock = f"{10 + second // 3600:02d}{second // 60 % 60:02d}{second % 60:02d}"
        latitude_min = 30.0 + 60 * (north + 2 * rng.standard_normal()) / NORTH_M
        longitude_min = 30.0 + 60 * (east + 2 * rng.standard_normal()) / EAST_M
        course = np.degrees(np.arctan2(ve, vn)) % 360
        reported = (np.degrees(heading) + compass_std_deg * rng.standard_normal()) % 360
        lines.append(
            sentence(
                f"GPRMC,{clock},A,50{latitude_min:08.5f},N,002{longitude_min:08.5f},E,"
                f"{np.hypot(vn, ve) / KN:.1f},{course:.1f},010620,,"
            )
        )
        if compass == "HDT":
            lines.append(sentence(f"HEHDT,{reported:.1f},T"))
        elif compass == "HDG":
            lines.append(sentence(f"HCHDG,{(reported - 3.0) % 360:.1f},,,,"))
        if water and across_given:
            told_kn = [6.0, across_kn] + 0.1 * rng.standard_normal(2)
            lines.append(sentence(f"VDVBW,{told_kn[0]:.1f},{told_kn[1]:.1f},A,,,V"))
        elif water:
            lines.append(sentence(f"VWVHW,,T,,M,{6 + 0.1 * rng.standard_normal():.1f},N,,K"))
        if bottom:
            ahead = vn * np.cos(heading) + ve * np.sin(heading) + 0.1 * rng.standard_normal()
            starboard = ve * np.cos(heading) - vn * np.sin(heading) + 0.1 * rng.standard_normal()
            lines.append(sentence(f"VDVBW,,,V,{ahead / KN:.2f},{starboard / KN:.2f},A"))
        if turn:
            turned_deg = heading_deg(second) - heading_deg(max(second - 1, 0))
            lines.append(sentence(f"TIROT,{60 * (turned_deg + rng.standard_normal()):.1f},A"))
    return lines


def column(rows, name):
    return np.array([float(row[name]) for row in rows])


def seconds(rows):
    return column(rows, "time_s") - float(rows[0]["time_s"])


def log_of(folder, lines):
    log = folder / "some.nmea"
    log.write_text("".join(lines))
    return log


def navigated(folder, lines, *, smooth=False, variation_deg=None):
    """Rows of own.csv; the notes are printed."""
    log = read_nmea(log_of(folder, lines), variation_deg=variation_deg)
    voyage = own_ship.navigate_log(log, smooth=smooth)
    print(*(f"note: {note}" for note in (*log.notes, *voyage.notes)), sep="\n")
    own_ship.write_own(folder / "own.csv", [leg.track for leg in voyage.legs])
    return rows_of(folder)


def commanded(folder, lines, *options):
    """The same by the command."""
    log = log_of(folder, lines)
    assert main(["navigate", str(log), "--out", str(folder), *options]) == 0
    return rows_of(folder)


def rows_of(folder):
    with (folder / "own.csv").open() as file:
        return list(csv.DictReader(file))


def test_the_bundled_log_coasts_better_than_on_a_straight(tmp_path, capsys):
    (log,) = [f for f in BUNDLED.iterdir() if f.name.endswith(".nmea")]
    answer = tmp_path / "errors.json"
    command = ["navigate", str(log), "--out", str(tmp_path), "--json", str(answer)]
    assert main(command) == 0
    rows = {row["estimator"]: row for row in json.loads(answer.read_text())["rows"]}
    ours, straight = rows["navigator"], rows["constant_velocity"]
    assert ours["coast_60s_median_m"] < 0.75 * straight["coast_60s_median_m"]
    assert ours["coast_10s_median_m"] < 1.05 * straight["coast_10s_median_m"]
    assert ours["coast_60s_median_m"] < rows["dead_reckoning"]["coast_60s_median_m"]
    assert "median of" in capsys.readouterr().out


@pytest.mark.parametrize("water", [True, False])
def test_the_first_fix_is_taken_once(tmp_path, water):
    first = navigated(tmp_path, voyage(minutes=1, water=water))[0]
    np.testing.assert_allclose(float(first["north_var_m2"]), own_ship.FIX_STD_M**2, rtol=0.01)


def test_set_and_drift_come_out(tmp_path):
    rows = navigated(tmp_path, voyage())
    late = rows[len(rows) // 2 :]
    drift = np.array([float(row["drift_mps"]) for row in late])
    toward = np.deg2rad([float(row["set_deg"]) for row in late])
    current = np.median(np.column_stack([drift * np.cos(toward), drift * np.sin(toward)]), axis=0)
    np.testing.assert_allclose(current / KN, [0.8, -0.5], atol=0.1)
    assert np.mean([row["status"] == "ok" for row in late]) > 0.99
    assert np.all([float(row["north_var_m2"]) > 0 for row in rows])
    heading = np.array([float(row["heading_deg"]) for row in late])
    assert np.isfinite(heading).all()


def test_speed_across_the_hull_is_no_current(tmp_path):
    """With leeway given, the current is right on every course; else it contains the leeway."""
    off_kn, heading_off_deg = {}, {}
    for reported in (True, False):
        rows = navigated(tmp_path, voyage(20, across_kn=0.8, across_given=reported))
        settled = seconds(rows) % 300 > 150
        toward = np.deg2rad(column(rows, "set_deg"))
        found = column(rows, "drift_mps") * np.array([np.cos(toward), np.sin(toward)]) / KN
        off = found - np.array([[0.8], [-0.5]])
        off_kn[reported] = np.sqrt(np.mean(np.hypot(*off[:, settled]) ** 2))
        off_deg = column(rows, "heading_deg") - heading_deg(np.rint(seconds(rows)))
        heading_off_deg[reported] = np.median((off_deg + 180.0) % 360.0 - 180.0)
    assert off_kn[True] < 0.15
    assert off_kn[False] > 0.5
    assert abs(heading_off_deg[True]) < 0.3


def test_speed_across_the_hull_coasts_through_turns(tmp_path):
    error_m = {}
    for reported in (True, False):
        answer = tmp_path / "errors.json"
        commanded(tmp_path, voyage(across_kn=0.8, across_given=reported), "--json", str(answer))
        rows = {row["estimator"]: row for row in json.loads(answer.read_text())["rows"]}
        error_m[reported] = [
            rows[who]["coast_60s_p95_m"] for who in ("navigator", "dead_reckoning")
        ]
    assert np.all(np.array(error_m[True]) < 0.8 * np.array(error_m[False])), error_m


def test_speed_across_the_hull_is_not_taken_for_an_error_of_the_compass(tmp_path, capsys):
    navigated(tmp_path, voyage(12, compass="HDG", across_kn=0.8, across_given=True))
    assert added_deg(capsys.readouterr().out)[0] == pytest.approx(3.0, abs=0.5)
    navigated(tmp_path, voyage(12, compass="HDG", across_kn=0.8))
    assert added_deg(capsys.readouterr().out)[0] > 8.0


def added_deg(out):
    """What is added to magnetic headings, and its standard deviation."""
    found = re.search(r"note: ([+-][0-9.]+)° ± ([0-9.]+)° are added", out)
    return float(found[1]), float(found[2])


@pytest.mark.parametrize("current_kn", [(0.0, 0.0), (0.8, -0.5)])
def test_a_compass_without_variation_is_set_by_velocities_over_ground(tmp_path, capsys, current_kn):
    rows = navigated(tmp_path, voyage(12, current_kn=current_kn, compass="HDG"))
    out = capsys.readouterr().out
    added, std = added_deg(out)
    assert added == pytest.approx(3.0, abs=0.3)
    assert 0.3 < std < 2.0
    assert "variation_deg" not in out
    assert (
        f"without --variation set and drift have an error of {100 * np.deg2rad(std):.0f} %" in out
    )
    off = (column(rows, "heading_deg") - heading_deg(seconds(rows)) + 180.0) % 360.0 - 180.0
    assert abs(np.median(off)) < 0.5
    drift, toward = column(rows, "drift_mps"), np.deg2rad(column(rows, "set_deg"))
    found = np.column_stack([drift * np.cos(toward), drift * np.sin(toward)])[-360:]
    np.testing.assert_allclose(np.median(found, axis=0) / KN, current_kn, atol=0.15)


@pytest.mark.parametrize("water", [True, False])
def test_an_offset_that_may_be_drift_is_in_the_error_of_the_heading(tmp_path, capsys, water):
    lines = voyage(4, current_kn=(0.4, -0.7), compass="HDG", water=water)
    rows = navigated(tmp_path, lines)
    added, std = added_deg(capsys.readouterr().out)
    assert abs(added - 3.0) > 3.0
    assert abs(added - 3.0) < 2.0 * std
    assert (column(rows, "heading_std_deg") > std).all()
    known = column(navigated(tmp_path, lines, variation_deg=3.0), "heading_std_deg")
    np.testing.assert_allclose(
        column(rows, "heading_std_deg"), np.hypot(known, std), rtol=0.1, atol=0.05
    )


@pytest.mark.parametrize("variation", ["3.0,E", ","])
def test_a_part_without_true_headings_takes_those_of_its_compass(tmp_path, capsys, variation):
    """With the given variation, else with that estimated from velocities over ground."""
    second_part = [
        re.sub(r"HDG,([0-9.]+),.*", rf"HDG,\1,,,{variation}", line.strip())[1:]
        if line.startswith("$HCHDG")
        else line.strip()[1:].partition("*")[0]
        for line in voyage(20, compass="HDG")[3 * 660 :]
    ]
    rows = navigated(tmp_path, voyage(9) + list(map(sentence, second_part)))
    off_deg = (column(rows, "heading_deg") - heading_deg(seconds(rows)) + 180.0) % 360.0 - 180.0
    later = seconds(rows) > 600
    assert abs(np.median(off_deg[later])) < 0.7
    assert ("are added to magnetic headings" in capsys.readouterr().out) == (variation == ",")
    earlier_std, later_std = (
        np.median(column(rows, "heading_std_deg")[which]) for which in (~later, later)
    )
    assert (later_std > 1.03 * earlier_std) == (variation == ",")


@pytest.mark.filterwarnings("error")
def test_a_log_that_is_stuck_is_reported_and_says_nothing_of_the_compass(tmp_path, capsys):
    stuck = [
        sentence("VWVHW,,T,,M,0.00,N,,K") if line.startswith("$VWVHW") else line
        for line in voyage(6, compass="HDG")
    ]
    navigated(tmp_path, stuck)
    reported = capsys.readouterr().out
    assert added_deg(reported) == (0.0, 15.0)
    assert (
        "speeds through the water are 0 while the ship makes way over ground: 360 (first in"
        in reported
    )
    assert "(first in line 3)" in reported
    navigated(tmp_path, voyage(6))
    assert "are 0 while" not in capsys.readouterr().out


def without_speed(line):
    fields = line[1:].partition("*")[0].split(",")
    return sentence(",".join([*fields[:7], "", "", *fields[9:]]))


def expect_soon_right(rows, reported, within_mps=1.0):
    """The ship makes 6 kn to 040 in the current for five minutes."""
    early = (seconds(rows) > 20) & (seconds(rows) < 300)
    heading = np.deg2rad(40.0)
    off_mps = [
        column(rows, "vnorth_mps") - (6.0 * np.cos(heading) + 0.8) * KN,
        column(rows, "veast_mps") - (6.0 * np.sin(heading) - 0.5) * KN,
    ]
    assert np.hypot(*off_mps)[early].max() < within_mps
    assert "rejected" not in reported


def test_a_compass_and_a_log_that_come_late_say_nothing_of_the_start(tmp_path, capsys):
    lines = [line for k, line in enumerate(voyage(14)) if line[3:6] == "RMC" or k // 3 >= 660]
    expect_soon_right(navigated(tmp_path, lines), capsys.readouterr().out)


def test_nor_do_they_where_fixes_alone_come_before(tmp_path, capsys):
    lines = [line for k, line in enumerate(voyage(14)) if line[3:6] == "RMC" or k // 3 >= 660]
    lines = [without_speed(line) if line[3:6] == "RMC" else line for line in lines]
    expect_soon_right(navigated(tmp_path, lines), capsys.readouterr().out, within_mps=2.0)


def test_velocities_over_ground_that_come_late_say_nothing_of_the_start(tmp_path, capsys):
    lines = voyage(14, compass=None, water=False)
    lines = [without_speed(line) for line in lines[:660:10]] + lines[660:]
    expect_soon_right(navigated(tmp_path, lines), capsys.readouterr().out)


@pytest.mark.parametrize("speed", ["0.0", "0.023"])
def test_at_rest_no_course_is_wanted(tmp_path, capsys, speed):
    rng = np.random.default_rng(2)
    clocks = [f"10{second // 60:02d}{second % 60:02d}" for second in range(600)]
    north_min, east_min = 30.0 + 0.001 * rng.standard_normal((2, 600))
    places = [f"50{n:08.5f},N,002{e:08.5f},E" for n, e in zip(north_min, east_min, strict=True)]
    lines = [
        sentence(f"GPRMC,{clock},A,{place},{speed},,010620,,")
        for clock, place in zip(clocks, places, strict=True)
    ]
    rows = navigated(tmp_path, lines)[300:]
    assert np.hypot(column(rows, "vnorth_mps"), column(rows, "veast_mps")).max() < 0.2
    assert column(rows, "vnorth_var_m2s2").max() < 0.3**2 * 1.2
    assert "not used" not in capsys.readouterr().out


def test_a_speed_over_ground_that_lacks_its_course_is_reported(tmp_path, capsys):
    lines = changed(voyage(4), "RMC", range(100, 105), 8, "")
    navigated(tmp_path, changed(lines, "RMC", [110], 7, ""))
    reported = "speeds over ground without a course, or courses without a speed are not used: 6"
    assert f"note: {reported} (first in line 301)" in capsys.readouterr().out


def test_without_velocities_over_ground_the_variation_may_be_any(tmp_path, capsys):
    lines = [
        sentence("HCHDG,0.0,,,,") if line.startswith("$HEHDT") else line
        for line in fixes_alone(60, 6.0)
    ]
    rows = navigated(tmp_path, lines)
    assert added_deg(capsys.readouterr().out) == (0.0, 15.0)
    assert (column(rows, "heading_std_deg") > 15.0).all()


def test_satellites_that_fail_are_coasted_over_and_come_back_without_a_jump(tmp_path):
    lines = voyage()
    silent = [
        line
        for k, line in enumerate(lines)
        if not (3 * 700 <= k < 3 * 790 and line.startswith("$GPRMC"))
    ]
    rows = navigated(tmp_path, silent)
    coasting = [row for row in rows if row["status"] == "coasting"]
    assert coasting
    spread = [float(row["north_var_m2"]) for row in coasting]
    assert spread[-1] > 4.0 * spread[0]
    place = np.array([[float(row["north_m"]), float(row["east_m"])] for row in rows])
    assert np.hypot(*np.diff(place, axis=0).T).max() < 15.0


def test_a_receiver_that_freezes_is_not_believed_in_its_velocity_either(tmp_path):
    lines = voyage(14)
    true = navigated(tmp_path, lines)
    stood = lines[3 * 580].split(",")
    for k in [3 * second for second in range(581, 700)]:
        fields = lines[k][1:].partition("*")[0].split(",")
        lines[k] = sentence(",".join([*fields[:3], *stood[3:9], *fields[9:]]))
    rows = navigated(tmp_path, lines)
    assert {row["status"] for row in rows} == {"ok", "coasting"}
    off_m = [
        column(rows, name) - np.interp(seconds(rows), seconds(true), column(true, name))
        for name in ("north_m", "east_m")
    ]
    assert np.hypot(*off_m).max() < 25.0


def turned_by(angle_deg):
    return lambda reported: f"{(float(reported) + angle_deg) % 360.0:.1f}"


@pytest.mark.parametrize("begins_s", [400, 590])
@pytest.mark.parametrize(
    ("kind", "lasts_s", "field", "value", "what"),
    [
        ("VHW", 15, 5, "30.0", "speeds through the water"),
        ("VHW", 15, 5, "199.0", "speeds through the water"),
        ("VHW", 100, 5, "0.0", "speeds through the water"),
        ("RMC", 30, 7, "0.0", "speeds over ground by satellite"),
        ("RMC", 30, 7, "40.0", "speeds over ground by satellite"),
        ("HDT", 20, 1, turned_by(180.0), "headings"),
        ("HDT", 100, 1, turned_by(180.0), "headings"),
    ],
)
def test_an_instrument_that_good_fixes_refute_is_named_and_moves_nothing(
    tmp_path, capsys, begins_s, kind, lasts_s, field, value, what
):
    lines = voyage(14)
    true = navigated(tmp_path, lines)
    assert "rejected" not in capsys.readouterr().out
    rows = navigated(
        tmp_path, changed(lines, kind, range(begins_s, begins_s + lasts_s), field, value)
    )
    line = 3 * begins_s + 1 + ("RMC", "HDT", "VHW").index(kind)
    (reported,) = [line for line in capsys.readouterr().out.splitlines() if "rejected" in line]
    assert reported == (
        f"note: {what} inconsistent with other readings are rejected: {lasts_s} "
        f"(first in line {line})"
    )
    off_m = [column(rows, name) - column(true, name) for name in ("north_m", "east_m")]
    assert np.hypot(*off_m).max() < 3.0
    assert column(rows, "drift_mps").max() < 1.5 * KN
    off_deg = column(rows, "heading_deg") - column(true, "heading_deg")
    assert np.abs((off_deg + 180.0) % 360.0 - 180.0).max() < 20.0
    assert {row["status"] for row in rows} == {"ok"}


@pytest.mark.parametrize("missing", [{"water": False}, {"compass": "none"}])
def test_without_a_log_or_a_heading_fixes_refute_speeds_over_ground_as_well(tmp_path, missing):
    lines = voyage(10, **missing)
    true = navigated(tmp_path, lines)
    wrong = [
        sentence(re.sub(r"E,[0-9.]+,", "E,25.0,", line[1:-4]))
        if line.startswith("$GPRMC") and 400 <= k // 2 < 430
        else line
        for k, line in enumerate(lines)
    ]
    rows = navigated(tmp_path, wrong)
    off_m = [column(rows, name) - column(true, name) for name in ("north_m", "east_m")]
    assert np.hypot(*off_m).max() < 5.0


@pytest.mark.parametrize(
    ("kind", "field", "value"), [("HDT", 1, turned_by(180.0)), ("VHW", 5, "0.0")]
)
def test_an_instrument_that_was_wrong_at_first_is_believed_when_it_is_right(
    tmp_path, kind, field, value
):
    rows = navigated(tmp_path, changed(voyage(12), kind, range(200), field, value))
    later = np.array([row for row in rows if float(row["time_s"]) - float(rows[0]["time_s"]) > 400])
    off_deg = column(later, "heading_deg") - heading_deg(np.rint(seconds(rows)[-len(later) :]))
    assert abs(np.median((off_deg + 180.0) % 360.0 - 180.0)) < 1.0
    drift = np.median(drift_mps(later), axis=0) / KN
    np.testing.assert_allclose(drift, [0.8, -0.5], atol=0.15)


def test_errors_know_nothing_of_the_hidden_speeds_in_the_magnetic_offset_either(tmp_path):
    lines = voyage(12, compass="HDG")
    hidden = [second for second in range(120, 720) if 0 < (second - 120) % 150 <= 60]
    turned = changed(lines, "RMC", hidden, 8, turned_by(40.0))
    errors = []
    for log in (lines, turned):
        answer = tmp_path / "errors.json"
        commanded(tmp_path, log, "--json", str(answer))
        rows = {row["estimator"]: row for row in json.loads(answer.read_text())["rows"]}
        errors.append([rows[who]["coast_60s_median_m"] for who in ("navigator", "dead_reckoning")])
    np.testing.assert_allclose(errors[1], errors[0], rtol=1e-9)


@pytest.mark.parametrize("every_s", [7, 8, 11])
def test_errors_are_those_at_hidden_fixes(tmp_path, every_s):
    """Fixes after the hidden minute have been seen: the solution there is as good as they are."""
    file = tmp_path / "some.nmea"
    kept = [
        line
        for k, line in enumerate(voyage(30))
        if not line.startswith("$GPRMC") or k // 3 % every_s == 0
    ]
    file.write_text("".join(kept))
    log = read_nmea(file)
    readings = own_ship.readings_of(log)
    fixed_s = readings.time_s[readings.has_fix]
    starts_s = np.arange(fixed_s[0] + 120.0, readings.time_s[-1] - 135.0, 150.0)
    errors = own_ship.hold_out(readings)
    fresh = [s for s in starts_s if s - fixed_s[fixed_s <= s][-1] <= 3.0]
    assert fresh
    for horizon_s in own_ship.HORIZONS_S:
        end_s = 60.0 if horizon_s == 60.0 else np.inf
        compared = [
            start_s
            for start_s in fresh
            if np.any((np.abs(fixed_s - start_s - horizon_s) <= 3.0) & (fixed_s <= start_s + end_s))
        ]
        for by_horizon in errors.values():
            assert len(by_horizon[horizon_s]) == len(compared)


@pytest.mark.parametrize(
    ("every_s", "wanted"),
    [
        (20, r"navigator +- +- +\d"),
        (40, "too short, or its fixes too rare, to test it"),
    ],
)
def test_where_fixes_are_seldom_it_is_said_what_cannot_be_compared(
    tmp_path, capsys, every_s, wanted
):
    commanded(tmp_path, [line for k, line in enumerate(voyage(30)) if k // 3 % every_s == 0])
    reported = capsys.readouterr().out
    assert re.search(wanted, reported)
    assert "nan" not in reported


def test_what_is_hidden_takes_no_more_memory_than_the_log():
    time_s = np.arange(0.0, 150_000.0, 5.0)
    starts_s = np.arange(120.0, 149_000.0, coasting.HIDDEN_EVERY_S)
    tracemalloc.start()
    hidden = coasting._is_hidden(time_s, starts_s)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 10 * time_s.nbytes
    since_s = (time_s - 120.0) % coasting.HIDDEN_EVERY_S
    wanted = (since_s > 0.0) & (since_s <= coasting.HIDDEN_S)
    wanted &= (time_s > 120.0) & (time_s <= starts_s[-1] + coasting.HIDDEN_S)
    np.testing.assert_array_equal(hidden, wanted)
    assert not coasting._is_hidden(time_s, starts_s[:0]).any()


def moved_north(lines, seconds, way_m):
    """Sentences with the fixes of some seconds moved."""
    lines = list(lines)
    for k in [3 * second for second in seconds]:
        fields = lines[k][1:].partition("*")[0].split(",")
        fields[3] = f"50{float(fields[3][2:]) + 60 * way_m / NORTH_M:08.5f}"
        lines[k] = sentence(",".join(fields))
    return lines


def north_off_m(rows, without):
    place = [float(row["lat_deg"]) for row in rows], [float(row["lat_deg"]) for row in without]
    return NORTH_M * np.subtract(*place)


def test_fixes_that_jump_far_and_come_back_move_nothing(tmp_path, capsys):
    lines = voyage(10)
    true = navigated(tmp_path, lines)
    assert "note" not in capsys.readouterr().out
    rows = navigated(tmp_path, moved_north(lines, range(400, 450), 50_000.0))
    assert np.abs(north_off_m(rows, true)).max() < 25.0
    assert "50 fixes at 0/0 or out of the vessel's reach" in capsys.readouterr().out
    assert rows[3 * 440]["status"] == "coasting"


def test_a_position_that_jumped_is_in_doubt_until_it_comes_back(tmp_path, capsys):
    lines = voyage(12)
    true = navigated(tmp_path, lines)
    capsys.readouterr()
    rows = navigated(tmp_path, moved_north(lines, range(400, 460), 150.0))
    reported = capsys.readouterr().out
    assert (
        "fixes inconsistent with other readings are rejected: 20 (first in line 1201)" in reported
    )
    assert "the position jumps 2 times" in reported
    status = np.array([row["status"] for row in rows])
    off = np.abs(north_off_m(rows, true)) > 75.0
    assert off.sum() > 150
    assert set(status[off]) == {"jumped", "rejected"}
    assert set(status[~off]) == {"ok", "rejected", "coasting"}


def test_while_fixes_are_rejected_she_coasts(tmp_path):
    rows = navigated(tmp_path, moved_north(voyage(8), range(400, 480), 150.0))
    status, second = np.array([row["status"] for row in rows]), seconds(rows)
    last_s = second[(status == "ok") & (second < 405)][-1]
    jump_s = second[status == "jumped"][0]
    waits = (second > last_s) & (second < jump_s)
    assert set(status[waits]) == {"rejected", "coasting"}
    assert last_s < 406


@pytest.mark.parametrize("way_m", [150.0, 50_000.0])
def test_a_position_that_jumped_is_in_doubt_until_fixes_have_fitted_for_a_minute(
    tmp_path, capsys, way_m
):
    lines = moved_north(voyage(12), range(400, 720), way_m)
    alone = moved_north(lines, [440], 30.0)
    for log, until_s in ((lines, 470), (alone, 500)):
        status = np.array([row["status"] for row in commanded(tmp_path, log)])
        assert set(status[3 * 410 : 3 * until_s]) - {"rejected"} == {"jumped"}
        assert set(status[3 * until_s :]) == {"ok"}
    reported = capsys.readouterr().out
    assert "the position jumps 1 time, to persistent rejected fixes" in reported
    if way_m > 1000.0:
        assert "first by 50 km in line 1201, where 320 fixes continue" in reported


def test_fixes_that_were_rejected_and_moved_the_position_a_little_are_reported(tmp_path, capsys):
    rows = navigated(tmp_path, moved_north(voyage(10), range(400, 600), 35.0))
    reported = re.search(
        r"fixes inconsistent with other readings are rejected: (\d+) \(first in line 1201\); "
        r"1 time they persisted and moved the position by up to (\d+) m",
        capsys.readouterr().out,
    )
    assert int(reported[1]) == sum(row["status"] == "rejected" for row in rows)
    assert 25.0 < float(reported[2]) < 45.0
    assert "jumped" not in {row["status"] for row in rows}


def test_a_minute_without_fixes_is_none_in_which_they_fit(tmp_path):
    lines = moved_north(voyage(12), range(400, 720), 150.0)
    hidden = [3 * second for second in range(430, 500)]
    rows = navigated(tmp_path, [line for k, line in enumerate(lines) if k not in hidden])
    status = np.array([row["status"] for row in rows])
    assert set(status[(seconds(rows) > 411) & (seconds(rows) < 560)]) == {"jumped"}
    assert set(status[seconds(rows) > 565]) == {"ok"}


def test_the_deviation_of_the_drift_covers_its_error_and_falls(tmp_path):
    rows = navigated(tmp_path, voyage())
    std_mps = column(rows, "drift_std_mps")
    error_mps = np.hypot(*(drift_mps(rows) - np.array([0.8, -0.5]) * KN).T)
    assert np.mean(error_mps < 2.5 * std_mps) > 0.95
    assert np.median(error_mps / std_mps) > 0.15
    assert std_mps[0] > 0.4
    assert np.median(std_mps[-300:]) < 0.15


def test_an_offset_that_is_not_known_well_is_in_the_deviation_of_the_drift(tmp_path):
    lines = voyage(4, compass="HDG")
    sure = column(navigated(tmp_path, lines, variation_deg=3.0), "drift_std_mps")
    found = navigated(tmp_path, lines)
    shared_rad = np.deg2rad(column(found, "heading_std_deg"))
    assert np.all(column(found, "drift_std_mps")[60:] > sure[60:])
    assert np.all(column(found, "drift_std_mps") < np.hypot(sure, 8.0 * KN * shared_rad))


@pytest.mark.parametrize(("compass", "water"), [("none", True), ("HDT", False), ("none", False)])
def test_without_heading_or_log_there_is_a_solution_without_drift(tmp_path, compass, water):
    rows = navigated(tmp_path, voyage(5, compass=compass, water=water))
    assert all(row["drift_mps"] == row["drift_std_mps"] == "" for row in rows)
    assert all(np.isfinite(float(row["vnorth_mps"])) for row in rows)
    assert (rows[-1]["heading_deg"] == "") == (compass == "none")


@pytest.mark.parametrize("kinds", ["RMC GGA GLL", "RMC GGA GLL VTG HDG HDM HDT VHW MTW"])
def test_turns_of_a_yacht_are_no_reason_to_reject_fixes(tmp_path, kinds):
    lines = (BUNDLED / "irene.nmea").read_text(encoding="latin-1").splitlines(keepends=True)
    rows = navigated(tmp_path, [line for line in lines if line[3:6] in kinds.split()])
    assert len(rows) > 2000
    assert "rejected" not in {row["status"] for row in rows}


def silent_satellites(headings_in_a_second):
    """Sentences of a ship that goes straight north, without fixes from 120 s to 180 s."""
    lines = []
    for second in range(240):
        clock = f"10{second // 60:02d}{second % 60:02d}"
        north_min = 30.0 + 60.0 * 5.0 * second / NORTH_M
        place = f"50{north_min:08.5f},N,00230.00000,E"
        lines.append(
            sentence(f"GPZDA,{clock},01,06,2020,00,00")
            if 120 <= second < 180
            else sentence(f"GPRMC,{clock},A,{place},{5.0 / KN:.2f},0.0,010620,,")
        )
        lines += headings_in_a_second * [sentence("HEHDT,0.0,T")]
    return lines


def test_how_well_the_place_is_known_does_not_hang_on_how_many_headings_come(tmp_path):
    variance_m2 = []
    for headings_in_a_second in (1, 4, 20):
        rows = navigated(tmp_path, silent_satellites(headings_in_a_second))
        coasting = np.array([row["status"] == "coasting" for row in rows])
        variance_m2.append(column(rows, "north_var_m2")[coasting][-1])
    assert variance_m2[0] > 1000.0
    np.testing.assert_allclose(variance_m2, variance_m2[0], rtol=0.1)


def test_a_log_that_sees_the_bottom_coasts_through_turns_without_satellites(tmp_path):
    error_m = {}
    for bottom in (True, False):
        answer = tmp_path / "errors.json"
        commanded(tmp_path, voyage(water=False, bottom=bottom), "--json", str(answer))
        rows = {row["estimator"]: row for row in json.loads(answer.read_text())["rows"]}
        error_m[bottom] = rows["navigator"]["coast_60s_p95_m"]
    assert error_m[True] < 0.4 * error_m[False]


def test_rates_of_turn_steady_the_heading(tmp_path):
    error_deg = {}
    for turn in (True, False):
        rows = navigated(tmp_path, voyage(turn=turn, compass_std_deg=4.0))
        second = np.rint([float(row["time_s"]) for row in rows]) % 3600
        reported = np.array([float(row["heading_deg"]) for row in rows])
        off = (reported - heading_deg(second) + 180.0) % 360.0 - 180.0
        error_deg[turn] = np.sqrt(np.mean(off**2))
    assert error_deg[True] < 0.85 * error_deg[False]


def test_what_no_state_is_there_for_is_reported(tmp_path, capsys):
    lines = voyage(3, compass="none", bottom=True, turn=True)
    lines += [sentence("VDVBW,,0.3,A,,,V"), sentence("VDVBW,6.0,0.0,A,6.0,,A")]
    navigated(tmp_path, lines)
    out = capsys.readouterr().out
    for reported in (
        "speeds through the water without a heading are not used: 182 (first in line 2)",
        "speeds through the water across the hull alone are not used: 1 (first in line 721)",
        "speeds over ground by log that lack a heading or a side are not used: 181 (first in",
        "rates of turn without a heading are not used: 180 (first in line 4)",
    ):
        assert f"note: {reported}" in out
    navigated(tmp_path, [*voyage(3, bottom=True, turn=True), sentence("VDVBW,,,V,6.0,,A")])
    (reported,) = [line for line in capsys.readouterr().out.splitlines() if "not used" in line]
    assert "speeds over ground by log that lack a heading or a side are not used: 1 " in reported


def test_short_parts_are_navigated_too(tmp_path, capsys):
    lines = [line for line in voyage(62) if not line.startswith("$VW")]
    kept = lines[:600] + lines[2 * 3700 : 2 * 3705] + lines[2 * 3715 : 2 * 3716]
    rows = commanded(tmp_path, kept)
    assert "306 fixes" in capsys.readouterr().out
    times_s = {float(row["time_s"]) for row in rows}
    assert len(rows) == len(kept)
    assert max(times_s) - min(times_s) > 3600
    assert float(rows[-1]["north_var_m2"]) < 25.0


def eastward(
    hours, *, latitude_deg=60.0, over_ground_mps=10.0, through_water_mps=9.5, bottom=False
):
    """Sentences of a ship on a parallel of latitude that heads east in a current that sets east."""
    across_m = 6378137.0 / np.sqrt(1.0 - 0.00669438 * np.sin(np.radians(latitude_deg)) ** 2)
    of_degree_m = np.radians(across_m * np.cos(np.radians(latitude_deg)))
    lines = []
    for second in range(0, int(3600 * hours), 20):
        clock = f"{second // 3600:02d}{second // 60 % 60:02d}{second % 60:02d}"
        longitude_deg = 10.0 + over_ground_mps * second / of_degree_m
        where = f"{int(longitude_deg):03d}{longitude_deg % 1.0 * 60.0:09.6f}"
        ground = "," if bottom else f"{over_ground_mps / KN:.2f},90.0"
        lines += [
            sentence(f"GPRMC,{clock},A,{latitude_deg:.0f}00.000000,N,{where},E,{ground},010620,,"),
            sentence("HEHDT,90.0,T"),
            sentence(f"VWVHW,,T,,M,{through_water_mps / KN:.2f},N,,K"),
        ]
        if bottom:
            lines.append(sentence(f"VDVBW,,,V,{over_ground_mps / KN:.2f},0.00,A"))
    return lines


@pytest.mark.parametrize("bottom", [False, True])
def test_far_from_the_first_fix_headings_and_set_are_true_and_the_current_is_the_waters(
    tmp_path, bottom
):
    rows = navigated(tmp_path, eastward(12, bottom=bottom))
    assert {row["status"] for row in rows} <= {"ok", "coasting"}
    assert column(rows, "heading_deg") == pytest.approx(90.0, abs=0.3)
    late = [row for row in rows if float(row["east_m"]) > 100e3]
    assert column(late, "drift_mps") == pytest.approx(0.5, abs=0.05)
    assert column(late, "set_deg") == pytest.approx(90.0, abs=3.0)


@pytest.mark.parametrize(
    ("longitude_deg", "reported"),
    [("012", ""), ("032", "1572 km from the first one, whose plane is stretched by 1.02 %")],
)
def test_fixes_too_far_for_one_plane_are_reported(tmp_path, capsys, longitude_deg, reported):
    times_s = range(0, 1200, 20)
    lines = [
        sentence(f"GPRMC,10{s // 60:02d}{s % 60:02d},A,5000.0,N,{place}00.0,E,0.0,0.0,010620,,")
        for s, place in zip(times_s, 30 * ["010"] + 30 * [longitude_deg], strict=True)
    ]
    navigated(tmp_path, lines)
    notes = [n for n in capsys.readouterr().out.splitlines() if "km from the first one" in n]
    assert len(notes) == bool(reported)
    assert all(reported in note for note in notes)


def test_courses_of_the_solution_are_true(tmp_path):
    file = tmp_path / "some.nmea"
    file.write_text("".join(eastward(6)))
    log = read_nmea(file)
    track = own_ship.navigate(own_ship.readings_of(log))
    assert np.degrees(track.course_rad) == pytest.approx(90.0, abs=0.3)
    assert np.degrees(track.lean_rad[-1]) == pytest.approx(-3.3, abs=0.1)


def position_m(plane, where):
    return plane.position_m(latitude_rad=where[:, 0], longitude_rad=where[:, 1])


def test_places_are_written_to_the_millimetre_however_far(tmp_path):
    rows = navigated(tmp_path, eastward(6))
    where = np.radians([[float(row["lat_deg"]), float(row["lon_deg"])] for row in rows])
    place_m = np.column_stack([column(rows, "north_m"), column(rows, "east_m")])
    plane = LocalPlane(latitude_rad=np.radians(60.0), longitude_rad=np.radians(10.0))
    assert place_m[-1, 1] > 200e3
    np.testing.assert_allclose(place_m, position_m(plane, where), atol=0.005)


def test_all_parts_lie_in_one_plane(tmp_path):
    lines = [line for line in voyage(62) if not line.startswith("$VW")]
    rows = navigated(tmp_path, lines[:600] + lines[2 * 3700 :])
    place_m = np.array([[float(row["north_m"]), float(row["east_m"])] for row in rows])
    where = np.radians([[float(row["lat_deg"]), float(row["lon_deg"])] for row in rows])
    plane = LocalPlane(latitude_rad=where[0, 0], longitude_rad=where[0, 1])
    off_m = place_m - position_m(plane, where)
    assert np.hypot(*place_m[-1]) > 1000.0
    assert np.ptp(off_m, axis=0) == pytest.approx([0.0, 0.0], abs=0.1)


def test_a_clock_set_back_is_reported_where_it_puts_own_ship_at_two_places_at_a_time(
    tmp_path, capsys
):
    lines = voyage(10)
    again = [
        sentence(re.sub(r",10(\d\d)", lambda m: f",10{int(m[1]) - 2:02d}", line[1:-4], count=1))
        if line.startswith("$GPRMC")
        else line
        for line in lines[900:]
    ]
    rows = navigated(tmp_path, lines[:900] + again)
    (k,) = np.flatnonzero(np.diff(column(rows, "time_s")) < 0)
    assert f"own.csv go back 1 time because the clock was set back (line {k + 3})" in (
        capsys.readouterr().out
    )
    notes = []
    own = read_own(tmp_path / "own.csv", notes)
    assert len(own.time_s) == len(rows)
    (reported,) = notes
    assert f"times go back 1 time (first in line {k + 3})" in reported
    navigated(tmp_path, lines)
    assert "go back" not in capsys.readouterr().out
    notes.clear()
    read_own(tmp_path / "own.csv", notes)
    assert notes == []


def both(folder, lines):
    """What is found of a log, and what it is smoothed."""
    return navigated(folder, lines), navigated(folder, lines, smooth=True)


def drift_mps(rows):
    toward = np.deg2rad(column(rows, "set_deg"))
    return column(rows, "drift_mps")[:, None] * np.column_stack([np.cos(toward), np.sin(toward)])


def motion_off(rows):
    """Errors (T, 2) of the places and of the velocities of a `voyage`."""
    second = np.rint(seconds(rows)).astype(int)
    heading = np.deg2rad(heading_deg(np.arange(second[-1] + 1)))
    over_ground = 6.0 * np.column_stack([np.cos(heading), np.sin(heading)]) + [0.8, -0.5]
    true_mps = over_ground * KN
    true_m = np.cumsum(true_mps, axis=0)
    degrees = np.column_stack([column(rows, "lat_deg"), column(rows, "lon_deg")])
    mps = np.column_stack([column(rows, "vnorth_mps"), column(rows, "veast_mps")])
    place_m = (degrees - [50.5, 2.5]) * [NORTH_M, EAST_M]
    return place_m - true_m[second], mps - true_mps[second]


def rms(error):
    return np.sqrt(np.mean(error**2))


VARIANCES = ("north_var_m2", "east_var_m2", "vnorth_var_m2s2", "veast_var_m2s2")


def test_smoothed_places_speeds_and_drift_are_nearer_to_the_truth(tmp_path, capsys):
    found, smooth = both(tmp_path, voyage())
    assert [row["time_s"] for row in found] == [row["time_s"] for row in smooth]
    assert [row["status"] for row in found] == [row["status"] for row in smooth]
    for smooth_off, off in zip(motion_off(smooth), motion_off(found), strict=True):
        assert rms(smooth_off) < 0.9 * rms(off)
    current_mps = np.array([0.8, -0.5]) * KN
    assert rms(drift_mps(smooth) - current_mps) < 0.85 * rms(drift_mps(found) - current_mps)
    off_deg, smooth_off_deg = (
        (column(rows, "heading_deg") - heading_deg(np.rint(seconds(rows))) + 180.0) % 360.0 - 180.0
        for rows in (found, smooth)
    )
    assert rms(smooth_off_deg) < 0.75 * rms(off_deg)


def test_smoothed_deviations_are_no_larger_and_the_last_row_is_the_same(tmp_path):
    found, smooth = both(tmp_path, voyage())
    assert found[-1] == smooth[-1]
    for name in (*VARIANCES[:2], "heading_std_deg"):
        assert np.all(column(smooth, name) <= column(found, name)), name
    for name in VARIANCES:
        assert np.median(column(smooth, name)) < 0.75 * np.median(column(found, name)), name


def test_nothing_is_smoothed_across_a_gap(tmp_path):
    """What comes after the gap, of another current and place, changes nothing before it."""
    lines, other = voyage(12), moved_north(voyage(12, (-0.8, 0.5), seed=2), range(360, 720), 300.0)
    before, after = slice(0, 3 * 300), slice(3 * 400, None)
    alone = navigated(tmp_path, lines[before], smooth=True)
    for later in (lines[after], other[after]):
        rows = navigated(tmp_path, lines[before] + later, smooth=True)
        assert len(rows) > len(alone)
        assert rows[: len(alone)] == alone


def test_a_jump_is_not_spread_by_smoothing(tmp_path):
    lines = voyage(10)
    true = navigated(tmp_path, lines, smooth=True)
    rows = navigated(tmp_path, moved_north(lines, range(400, 600), 150.0), smooth=True)
    off_m = north_off_m(rows, true)
    jumped = np.array([row["status"] for row in rows]) == "jumped"
    first = np.flatnonzero(jumped)[0]
    assert np.abs(off_m[:first]).max() < 10.0
    assert np.abs(off_m[first:] - 150.0).max() < 20.0


def test_the_bundled_log_is_smoothed(tmp_path, capsys):
    logs = tmp_path / "found", tmp_path / "smooth"
    rows = {}
    for folder, options in zip(logs, ([], ["--smooth"]), strict=True):
        assert main(["navigate", str(BUNDLED / "irene.nmea"), "--out", str(folder), *options]) == 0
        with (folder / "own.csv").open() as file:
            rows[folder] = list(csv.DictReader(file))
    found, smooth = (rows[folder] for folder in logs)
    assert found[-1] == smooth[-1]
    for name in (*VARIANCES[:2], "heading_std_deg"):
        assert np.all(column(smooth, name) <= column(found, name)), name
    for name in VARIANCES:
        assert np.median(column(smooth, name)) < 0.75 * np.median(column(found, name)), name
    reported = [
        text.partition("error in metres")[2] for text in capsys.readouterr().out.split("irene:")
    ]
    assert reported[1].splitlines()[:5] == reported[2].splitlines()[:5], "errors without satellites"


def test_pictures_of_an_earlier_log_are_removed(tmp_path, pictures):
    for name in ("own_map-2.png", "own_time-2.png", "own_map-harbour.png"):
        (tmp_path / name).touch()
    commanded(tmp_path, voyage(2))
    left = {file.name for file in tmp_path.glob("*.png")}
    assert left == {"own_map.png", "own_time.png", "own_map-harbour.png"}


def test_readings_without_a_fix_before_them_are_reported(tmp_path, capsys):
    lines = voyage(12)
    early = [line for line in lines[:30] if not line.startswith("$GPRMC")]
    late = [sentence("GPZDA,101100,01,06,2020,00,00"), *lines[3 * 660 + 1 : 3 * 660 + 3]]
    rows = navigated(tmp_path, [*early, *lines[30:900], *late])
    assert "note: readings with no fix before them are not used: 22 (first in line 1)" in (
        capsys.readouterr().out
    )
    assert len(rows) == 870


def fixes_alone(seconds, kn):
    """Sentences of a ship that steers north, without speeds over ground."""
    lines = []
    for second in range(seconds):
        north_min = 30.0 + 60.0 * kn * KN * second / NORTH_M
        clock = f"10{second // 60:02d}{second % 60:02d}"
        place = f"50{north_min:08.5f},N,00230.00000,E"
        lines += [
            sentence(f"GPGGA,{clock},{place},1,08,1.0,,M,,M,,"),
            sentence("HEHDT,0.0,T"),
            sentence(f"VWVHW,,T,,M,{kn:.1f},N,,K"),
        ]
    return lines


@pytest.mark.parametrize("water", [True, False])
def test_a_fast_ship_without_speeds_over_ground_is_followed_from_the_start(tmp_path, water):
    lines = [line for line in fixes_alone(60, 25.0) if water or not line.startswith("$VW")]
    rows = navigated(tmp_path, lines)
    assert all(row["status"] == "ok" for row in rows)
    assert float(rows[-1]["vnorth_mps"]) == pytest.approx(25.0 * KN, abs=0.3)


def test_without_speeds_over_ground_the_straight_is_that_of_the_last_fixes(tmp_path):
    answer = tmp_path / "errors.json"
    commanded(tmp_path, fixes_alone(600, 6.0), "--json", str(answer))
    rows = {row["estimator"]: row for row in json.loads(answer.read_text())["rows"]}
    assert set(rows) == {"navigator", "dead_reckoning", "constant_velocity"}
    assert rows["navigator"]["coast_60s_median_m"] < 10.0
    assert rows["constant_velocity"]["coast_60s_median_m"] < 1.0


def test_bad_lines_are_reported_and_nothing_else_is_lost(tmp_path, capsys):
    lines = voyage(5)
    lines[99] = lines[99][:20] + "\n"
    lines[201] = lines[201].replace("*", "7*")
    lines[300] = "\x00\x01 nonsense\n"
    rows = commanded(tmp_path, lines)
    reported = capsys.readouterr().out
    for line in (100, 202, 301):
        assert reported.count(f"line {line}:") == 1
    assert len(rows) >= 298
    with (tmp_path / "problems.csv").open(newline="") as file:
        problems = list(csv.DictReader(file))
    assert [(row["line"], row["kind"]) for row in problems] == [
        ("100", "cut"),
        ("202", "checksum"),
        ("301", "no sentence"),
    ]
    assert problems[1]["reason"].startswith("wanted ")
    assert ", got '$" in problems[1]["reason"]
    assert "note: all problems are listed in problems.csv" in reported
    commanded(tmp_path, voyage(5))
    assert not (tmp_path / "problems.csv").exists()


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("", "wanted"),
        ("north, east\n1, 2\n", "wanted"),
        (
            sentence("GPZDA,100000,01,06,2020,00,00") + sentence("HEHDT,40.0,T"),
            "at least one usable fix",
        ),
    ],
)
def test_what_is_no_log_is_one_clear_line(tmp_path, text, word, capsys):
    log = tmp_path / "some.nmea"
    log.write_text(text)
    assert main(["navigate", str(log), "--out", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("wakeline: ")
    assert word in error
    assert error.count("\n") == 1


@pytest.mark.parametrize("variation", ["400", "nan", "east"])
def test_a_variation_that_is_none_is_one_clear_line(tmp_path, variation, capsys):
    log = tmp_path / "some.nmea"
    log.write_text("".join(voyage(1, compass="HDG")))
    assert main(["navigate", str(log), "--out", str(tmp_path), "--variation", variation]) == 2
    error = capsys.readouterr().err
    assert f"--variation: wanted degrees from -180 to 180, got '{variation}'" in error
    assert "variation_deg" not in error
    assert error.count("\n") == 1


def test_the_date_and_the_variation_given_override_the_log(tmp_path, capsys):
    lines = [line.replace("010620", "151000") for line in fixes_alone(60, 6.0)]
    clock = [sentence(f"GPZDA,10{t // 60:02d}{t % 60:02d},15,10,2000,00,00") for t in range(60)]
    lines = [line for t in range(60) for line in (clock[t], *lines[3 * t : 3 * t + 3])]
    rows = commanded(tmp_path, lines, "--date", "2020-06-01", "--variation", "3")
    assert float(rows[0]["time_s"]) == pytest.approx(1590969600 + 36000, abs=1.0)
    assert "2020-06-01, is used instead of 2000-10-15" in capsys.readouterr().out
    assert main(["navigate", str(tmp_path / "some.nmea"), "--date", "1 June"]) == 2
    assert "--date: wanted a date such as" in capsys.readouterr().err


def test_many_parts_are_drawn_in_part(tmp_path, pictures, capsys):
    lines = [
        line
        for start in range(0, 14 * 600, 600)
        for t in range(start, start + 12)
        for line in [sentence(f"GPGGA,{clock_text(t)},5030.0,N,00230.0,E,1,08,1.0,,M,,M,,")]
    ]
    commanded(tmp_path, lines)
    assert len(list(tmp_path.glob("own_map*.png"))) == 10
    assert "of 14 parts those 10 with most fixes are drawn" in capsys.readouterr().out


def clock_text(second):
    return f"{10 + second // 3600:02d}{second // 60 % 60:02d}{second % 60:02d}"


def test_a_ship_at_her_berth_is_drawn_without_warnings(tmp_path, pictures):
    fix = "5430.829,N,01010.244,E,00.0,000,220726,,,A"
    lines = [sentence(f"IIRMC,{clock_text(t)},A,{fix}") for t in range(30)]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        commanded(tmp_path, lines)


def test_a_missing_log_is_one_clear_line(tmp_path, capsys):
    assert main(["navigate", str(tmp_path / "none.nmea"), "--out", str(tmp_path)]) == 2
    assert "none.nmea" in capsys.readouterr().err


def test_pictures_are_drawn(tmp_path, pictures, capsys):
    lines = voyage(8)
    commanded(tmp_path, [*lines[:1080], *lines[-9:]])
    assert "1 of 2 parts not drawn, with fewer than 10 fixes" in capsys.readouterr().out
    for name in ("own_map.png", "own_time.png"):
        assert (tmp_path / name).read_bytes()[:4] == b"\x89PNG"


@pytest.mark.parametrize("water", [True, False])
def test_there_is_no_panel_of_a_drift_that_is_not_known(tmp_path, pictures, monkeypatch, water):
    from wakeline import plot

    labels = {}
    monkeypatch.setattr(
        plot, "save", lambda figure, path: labels.update({path.name: figure.axes[-1].get_ylabel()})
    )
    commanded(tmp_path, voyage(4, water=water))
    assert labels["own_time.png"] == ("drift (kn)" if water else "course (°)")


def test_long_work_is_seen_on_a_terminal(tmp_path, pictures, capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setattr(_progress, "_EVERY_S", -1.0)
    commanded(tmp_path, voyage(6))
    reported = capsys.readouterr().err
    for work in ("navigating", "writing own.csv", "drawing", "hiding satellites", "comparing"):
        assert work in reported


@pytest.mark.parametrize("name", ["own.csv", "problems.csv"])
def test_the_log_is_not_replaced_by_what_is_written(tmp_path, capsys, name):
    log = tmp_path / name
    log.write_text("mine")
    assert main(["navigate", str(log), "--out", str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"wakeline: --out would replace the input {log}\n"
    assert main(["navigate", str(log), "--out", str(tmp_path / "out"), "--json", str(log)]) == 2
    assert capsys.readouterr().err == f"wakeline: --json would replace the input {log}\n"
    assert log.read_text() == "mine"
