"""Recordings: what a good file becomes, and what is said about each bad one."""

import dataclasses
import os
import pickle
import re
import threading
import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wakeline import forecast, metrics, montecarlo, recording
from wakeline.recording import OwnShipMotion, RecordingError, read_plots
from wakeline.recording.scans import by_time
from wakeline.scenario import RadarSimulator, Truth

OWN = "scan,time_s,own_north_m,own_east_m\n0,0,0,0\n1,2,20,0\n2,4,40,0\n"


def only(read):
    """The single episode of a recording."""
    (episode,) = read.episodes
    return episode


def places(episode):
    return [scan.position_m.tolist() for scan in episode.scans]


# ------------------------------------------------------------------ recordings that ship


@pytest.mark.parametrize(
    ("name", "episodes", "scans", "plots"), [("joyride", 1, 115, 147), ("autoferry", 5, 381, 2046)]
)
def test_bundled_recordings_are_whole_and_clean(name, episodes, scans, plots):
    loaded = recording.load(name)
    assert name in recording.names()
    assert loaded.name == name
    assert loaded.notes == []
    assert len(loaded) == episodes
    assert sum(len(e) for e in loaded) == scans
    assert sum(e.plot_count for e in loaded) == plots
    for episode in loaded:
        assert (np.diff(episode.time_s) > 0).all()
        assert len(episode.own) == len(episode)
        assert episode.truth


@pytest.mark.parametrize("name", ["joyride", "autoferry"])
def test_range_and_bearing_lead_from_own_ship_back_to_the_plot(name):
    for episode in recording.load(name):
        for scan in episode.scans:
            north = scan.own_north_m + scan.range_m * np.cos(scan.bearing_rad)
            east = scan.own_east_m + scan.range_m * np.sin(scan.bearing_rad)
            np.testing.assert_allclose(np.column_stack([north, east]), scan.position_m, atol=1e-9)


def test_unknown_recording_is_named_beside_the_known_ones():
    with pytest.raises(ValueError, match=r"autoferry, joyride.*'joyrid'"):
        recording.load("joyrid")


# ------------------------------------------------------------------ columns, times, text


@pytest.mark.parametrize(
    "header",
    [
        "time_s,range_m,bearing_deg",
        "Time,Range [m],Bearing (deg)",
        "UTC,RANGE_M,Azimuth_Deg",
        " timestamp , distance_m , azimuth deg ",
    ],
)
def test_columns_are_known_by_name(file, header):
    episode = only(read_plots(file(f"{header}\n5,100,90\n"), own=(10.0, 20.0)))
    (scan,) = episode.scans
    np.testing.assert_allclose(scan.position_m, [[10.0, 120.0]], atol=1e-12)
    assert scan.time_s == 5.0


@pytest.mark.parametrize(
    ("columns", "row"),
    [
        ("range_nm,bearing_rad", "1,-1.5707963267948966"),
        ("distance_nm,azimuth_rad", "1,4.71238898038469"),
        ("range_m,bearing_deg", "1852,270"),
        ("range_m,bearing_deg", "1852,-90"),
        ("north_m,east_m", "0,-1852"),
    ],
)
def test_units_and_turns_agree(file, columns, row):
    (scan,) = only(read_plots(file(f"time_s,{columns}\n0,{row}\n"))).scans
    np.testing.assert_allclose(scan.position_m, [[0.0, -1852.0]], atol=1e-9)
    np.testing.assert_allclose(scan.range_bearing, [[1852.0, -np.pi / 2]], atol=1e-9)


def test_north_and_east_win_over_range_and_bearing(file):
    text = "time_s,north_m,east_m,range_m,bearing_deg\n0,3,4,99,99\n"
    read = read_plots(file(text))
    assert places(only(read)) == [[[3.0, 4.0]]]
    assert "north and east are used" in read.notes[0]


@pytest.mark.parametrize(
    "text",
    [
        "1620114893.5",
        "2021-05-04T07:54:53.500Z",
        "2021-05-04 07:54:53.5",
        "2021-05-04T09:54:53,5+02:00",
        "2021-05-04T07:24:53.5-0030",
        "2021-05-04T09:54:53.5+02",
        "2021-05-05T07:53:53.5+23:59",
    ],
)
def test_times_are_utc_seconds_or_iso_text(file, text):
    path = file(f'time,north_m,east_m\n"{text}",1,2\n')
    assert only(read_plots(path)).time_s == pytest.approx([1620114893.5], abs=1e-6)


@pytest.mark.parametrize("text", ["2016-12-31T23:59:60.25Z", "2017-01-01T05:29:60.25+05:30"])
def test_a_leap_second_is_the_second_after_it(file, text):
    path = file(f"time,north_m,east_m\n{text},1,2\n")
    assert only(read_plots(path)).time_s == pytest.approx([1483228800.25], abs=1e-6)


@pytest.mark.parametrize("zone", ["+99:99", "-23:75", "+24:00", "+2", "-9900"])
def test_a_zone_that_does_not_exist_is_rejected(file, zone):
    path = file(f"time,north_m,east_m\n2021-05-04T07:54:53{zone},1,2\n")
    with pytest.raises(RecordingError) as caught:
        read_plots(path)
    assert_says(caught, path, 2, "time", "ISO 8601", zone)


def test_byte_order_mark_crlf_blank_lines_and_spaces_do_not_matter(file):
    plain = file("scan,time_s,north_m,east_m\n0,1,2,3\n1,2,4,5\n", "plain.csv")
    odd = file(
        b"\xef\xbb\xbfscan , time_s,north_m,east_m\r\n\r\n0, 1 ,2,3\r\n"
        b"   \r\n1,2,4, 5\r\n,, ,\r\n\r\n",
        "odd.csv",
    )
    assert places(only(read_plots(odd))) == places(only(read_plots(plain)))


def test_spaces_before_quotes_do_not_matter(file):
    path = file('"time_s", "note", "north_m" ,"east_m"\n"1", "a, b", "2" ,"3"\n')
    assert places(only(read_plots(path))) == [[[2.0, 3.0]]]
    path = file('note,time_s,north_m,east_m\n"a "" ,b" ,"1"\t, "2" ,3\n')
    assert places(only(read_plots(path))) == [[[2.0, 3.0]]]


@pytest.mark.parametrize("row", ['"1","2","31', '"1","2","3"4', '"1","2"5,"3"'])
@pytest.mark.parametrize("before", ["", "0,1,2\n"])
def test_a_quoted_cell_that_is_cut_or_continues_is_not_a_number(file, row, before):
    path = file(f"time_s,north_m,east_m\n{before}{row}")
    with pytest.raises(RecordingError) as caught:
        read_plots(path)
    assert caught.value.line == (3 if before else 2)


@pytest.mark.parametrize("end", ["", '2,4,5,c"\n', '2,4,5,"c\n', '2,4,5,"c"\n'])
def test_a_quote_that_is_not_closed_hides_no_rows(file, end):
    path = file('time_s,north_m,east_m,note\n0,1,2,a\n1,2,3,"b\n1.5,2,3,b\n' + end)
    assert only(read_plots(path)).time_s.tolist() == [0.0, 1.0, 1.5, 2.0][: 4 if end else 3]


def test_own_columns_beside_the_plots_are_used(file):
    text = "time_s,range_m,bearing_deg,own_north_m,own_east_m\n0,10,0,100,200\n2,10,0,110,200\n"
    episode = only(read_plots(file(text)))
    np.testing.assert_allclose(places(episode), [[[110.0, 200.0]], [[120.0, 200.0]]])
    assert episode.own.north_m.tolist() == [100.0, 110.0]


# ------------------------------------------------------------------ scans


def test_scans_without_plots_stay(file):
    plots = file("scan,time_s,north_m,east_m\n1,2,5,6\n")
    episode = only(read_plots(plots, file(OWN, "own.csv")))
    assert [len(scan) for scan in episode.scans] == [0, 1, 0]
    assert episode.time_s.tolist() == [0.0, 2.0, 4.0]


def test_a_header_alone_has_no_plots(file):
    plots = file("scan,time_s,north_m,east_m\n")
    assert len(only(read_plots(plots))) == 0
    read = read_plots(plots, file(OWN, "own.csv"))
    assert [len(scan) for scan in only(read).scans] == [0, 0, 0]
    assert read.notes == ["plots.csv: no plots"]


def test_scans_can_be_read_without_plots(file):
    episode = only(read_plots(None, file(OWN, "own.csv")))
    assert len(episode) == 3
    assert episode.plot_count == 0
    with pytest.raises(ValueError, match="plots_path or own_path"):
        read_plots(None)


@pytest.mark.parametrize("head", ["range_m,bearing_deg", "range_nm,bearing_deg", "north_m,east_m"])
def test_a_place_beyond_all_radars_is_reported_by_its_cell(file, head):
    plots = file(f"time_s,{head}\n0,1,1\n3,1e308,1\n")
    column = head.split(",")[0]
    with pytest.raises(RecordingError, match=f"line 3, column {column}: .*at most 1e9 m"):
        read_plots(plots)


@pytest.mark.parametrize(
    ("column", "wanted"), [("north_m", "1e9 m"), ("east_m", "1e9 m"), ("veast_mps", "1e6 m/s")]
)
def test_what_is_beyond_the_earth_is_reported_by_its_cell_in_every_file(file, column, wanted):
    def far(head, name):
        row = dict.fromkeys(head.split(","), "0") | {"time_s": "3", column: "-1e200"}
        return file(f"{head}\n{','.join(row.values())}\n", name)

    plots = file("time_s,north_m,east_m\n0,1,1\n3,1,1\n")
    state = "time_s,north_m,east_m,vnorth_mps,veast_mps"
    readers = [
        lambda: read_plots(plots, far(state, "own.csv")),
        lambda: read_plots(plots, truth_path=far(f"{state},target", "truth.csv")),
        lambda: recording.read_tracks(far(f"{state},track_id", "tracks.csv")),
    ]
    for read in readers:
        with pytest.raises(RecordingError, match=f"line 2, column {column}: .*at most {wanted}"):
            read()


def test_plots_in_a_grid_without_own_ship_in_it_are_reported(file):
    rows = [f"{k},{5.6e6 + 10 * k},4e5" for k in range(5)]
    plots = file("\n".join(["time_s,north_m,east_m", *rows]) + "\n")
    (note,) = read_plots(plots).notes
    assert note.startswith("plots are 5614 km from own ship")
    assert read_plots(plots, own=(5.6e6, 4.02e5)).notes == []


def test_own_ship_beside_a_plot_is_on_the_earth(file):
    plots = file("time_s,range_m,bearing_rad,own_north_m,own_east_m\n0,1,1,0,1e200\n")
    with pytest.raises(RecordingError, match=r"line 2, column own_east_m: .*at most 1e9 m"):
        read_plots(plots)


def test_equal_times_make_a_scan(file):
    text = "time_s,north_m,east_m\n0,1,1\n0,2,2\n3,3,3\n"
    assert [len(s) for s in only(read_plots(file(text))).scans] == [2, 1]


def test_plots_without_scan_numbers_go_to_the_listed_scan_nearest_in_time(file):
    plots = file("time_s,north_m,east_m\n0.3,1,1\n3.6,2,2\n4.2,3,3\n")
    episode = only(read_plots(plots, file(OWN, "own.csv")))
    assert [len(scan) for scan in episode.scans] == [1, 0, 2]


def test_a_turning_antenna_makes_a_scan_of_each_turn(file):
    period, turns = 2.5, 40
    phases = np.array([0.05, 0.3, 0.35, 0.8])
    times = (np.arange(turns)[:, np.newaxis] + phases).ravel() * period * 0.998
    rows = "".join(f"{t:.6f},{k},0\n" for k, t in enumerate(times))
    episode = only(read_plots(file("time_s,north_m,east_m\n" + rows), period_s=period))
    sizes = [len(scan) for scan in episode.scans]
    assert sum(sizes) == len(times)
    assert max(sizes) <= len(phases)
    assert abs(len(sizes) - turns) <= 1


def polar(time_s, bearing_deg):
    rows = zip(time_s, bearing_deg % 360.0, strict=True)
    return "time_s,range_m,bearing_deg\n" + "".join(f"{t:.3f},4000,{b:.3f}\n" for t, b in rows)


@pytest.mark.parametrize(("period_s", "targets"), [(1.2, 1), (2.5, 3), (2.5, 200), (12.0, 30)])
def test_a_turning_antenna_is_found_from_times_and_bearings(file, period_s, targets):
    rng = np.random.default_rng(4)
    place_deg = np.sort(rng.uniform(20.0, 340.0, targets)) + 0.2 * np.arange(40)[:, np.newaxis]
    turn = np.arange(40)[:, np.newaxis] + place_deg / 360.0
    seen = rng.random(turn.shape) < 0.8
    bearing_deg = (place_deg + rng.normal(scale=0.5, size=turn.shape))[seen]
    text = polar(1.7e9 + period_s * turn[seen], bearing_deg)
    read = read_plots(file(text))
    given = only(read_plots(file(text), period_s=period_s))
    assert abs(len(only(read)) - np.count_nonzero(seen.any(axis=1))) <= 1
    assert abs(len(only(read)) - len(given)) <= 1
    assert len(read.notes) == (targets > 1)
    assert all(f"revolutions of {period_s:.2g} s" in note for note in read.notes)


@pytest.mark.parametrize("cartesian", [False, True])
@pytest.mark.parametrize("reported", [{}, {"period_s": 2.5}, {"period_s": 2.6}])
@pytest.mark.parametrize(("plots", "begin_deg"), [(30, 0.0), (120, 200.0)])
def test_of_many_plots_a_turn_each_turn_is_a_scan(file, plots, begin_deg, reported, cartesian):
    """A scan shorter than a turn would miss, time and again, what is seen in every turn."""
    rng = np.random.default_rng(6)
    turn = np.repeat(np.arange(60), plots)
    bearing_deg = begin_deg + np.sort(rng.uniform(0.0, 360.0, (60, plots))).ravel()
    time_s = 2.5 * (turn + (bearing_deg - begin_deg) / 360.0)
    text = polar(time_s, bearing_deg)
    if cartesian:
        place_m = 4000.0 * np.exp(1j * np.deg2rad(bearing_deg))
        rows = zip(time_s, place_m.real, place_m.imag, strict=True)
        text = "time_s,north_m,east_m\n" + "".join(f"{t:.3f},{n},{e}\n" for t, n, e in rows)
    sizes = [len(scan) for scan in only(read_plots(file(text), **reported)).scans]
    assert len(sizes) in (60, 61)
    assert np.abs(np.array(sizes[1:-1]) - plots).max() <= 0.1 * plots + 3


def test_plots_of_one_time_are_in_one_scan_of_an_antenna_that_turns(file):
    time_s = np.round(np.arange(400) / 7.0 * 3.0, 1)
    bearing_deg = np.arange(400) / 7.0 * 360.0
    scans = only(read_plots(file(polar(time_s, bearing_deg)), period_s=3.0)).scans
    ends_s = np.array([scan.plot_time_s[-1] for scan in scans[:-1]])
    assert (ends_s < [scan.plot_time_s[0] for scan in scans[1:]]).all()


def test_plots_that_report_of_no_turn_are_reported_and_left_as_they_are(file):
    rng = np.random.default_rng(5)
    time_s = np.cumsum(rng.uniform(0.1, 2.0, 300))
    read = read_plots(file(polar(time_s, rng.uniform(0.0, 360.0, 300))))
    assert len(only(read)) == 300
    (note,) = read.notes
    assert "nearly every scan has one plot" in note
    assert "period_s" in note


def test_scans_stamped_with_one_time_are_no_turns(file):
    time_s = np.repeat(2.5 * np.arange(60), 3)
    read = read_plots(file(polar(time_s, np.tile([10.0, 12.0, 200.0], 60))))
    assert len(only(read)) == 60
    assert read.notes == []


@given(st.lists(st.floats(0, 1000), min_size=1, max_size=60), st.floats(0.5, 50))
def test_no_scan_is_as_long_as_the_period(times, period_s):
    times = np.sort(np.array(times))
    number = by_time(times, period_s)
    assert number[0] == 0
    assert set(np.diff(number)) <= {0, 1}
    for k in np.unique(number):
        assert np.ptp(times[number == k]) < period_s or np.ptp(times[number == k]) == 0
        assert (np.diff(times[number == k]) <= period_s / 2).all()


def test_plots_are_sorted_within_a_scan_and_between_scans(file):
    text = "scan,time_s,north_m,east_m\n1,3,3,0\n0,1,1,0\n0,0,0,0\n1,2,2,0\n"
    episode = only(read_plots(file(text)))
    assert places(episode) == [[[0.0, 0.0], [1.0, 0.0]], [[2.0, 0.0], [3.0, 0.0]]]
    assert episode.time_s.tolist() == [1.0, 3.0]


def test_scenarios_become_episodes(file):
    plots = file("scenario,scan,time_s,north_m,east_m\nb,0,9,1,1\na,0,0,2,2\na,1,1,3,3\n")
    own = file(
        "scenario,scan,time_s,own_north_m,own_east_m\nb,0,9,0,0\nb,1,10,0,0\na,0,0,5,5\na,1,1,5,5\n",
        "own.csv",
    )
    read = read_plots(plots, own)
    assert [(e.name, len(e), e.plot_count) for e in read] == [("b", 2, 1), ("a", 2, 2)]
    assert read.episodes[1].own.north_m.tolist() == [5.0, 5.0]
    assert read.episode_of(["", "", "a"], [0.4, 9.2, 9.2]).tolist() == [1, 0, 1]
    with pytest.raises(ValueError, match="'c'"):
        read.episode_of(["c"], [0.0])
    with pytest.raises(TypeError, match="time_s must hold real numbers: got text"):
        read.episode_of(["", ""], ["0.4", "9.2"])


def test_a_long_recording_is_read_in_reasonable_time(file):
    n = 200_000
    rows = "".join(f"{k // 50},{k // 50 * 2.5},{k % 97}.5,{k % 89}.25\n" for k in range(n))
    path = file("scan,time_s,north_m,east_m\n" + rows)
    start = time.perf_counter()
    episode = only(read_plots(path))
    assert time.perf_counter() - start < 20.0
    assert episode.plot_count == n
    assert len(episode) == n // 50


def test_ten_thousand_plots_in_a_scan_and_a_plot_at_the_radar(file):
    rows = "".join(f"0,{k % 100},{k // 100}\n" for k in range(10_000))
    (scan,) = only(read_plots(file("time_s,north_m,east_m\n" + rows))).scans
    assert len(scan) == 10_000
    assert np.isfinite(scan.range_bearing).all()
    assert scan.range_m[0] == 0.0


# ------------------------------------------------------------------ what is left out, with a note


@pytest.mark.parametrize("cell", ["nan", "NaN", "", "inf", "-inf"])
def test_plots_without_a_finite_place_are_left_out_and_counted(file, cell):
    text = f"scan,time_s,north_m,east_m\n0,0,1,1\n1,2,{cell},1\n2,4,1,{cell}\n"
    read = read_plots(file(text))
    assert [len(scan) for scan in only(read).scans] == [1, 0, 0]
    (note,) = read.notes
    assert "plots.csv: 2 plots without a finite position" in note
    assert "line 3" in note


def test_times_that_go_back_are_reported_where_no_scans_are_numbered(file):
    rows = "86399.5,1,1\n86399,2,2\n0.5,3,3\n3,4,4\n"
    (note,) = read_plots(file("time_s,north_m,east_m\n" + rows)).notes
    assert "plots.csv: 1 plot sorted that is more than a minute earlier" in note
    assert "line 4" in note
    rows = "a,900,1,1\na,902,1,1\nb,0,1,1\nb,2,1,1\n"
    assert read_plots(file("scenario,time_s,north_m,east_m\n" + rows)).notes == []


def test_repeated_rows_are_left_out_and_counted(file):
    text = "scan,time_s,north_m,east_m\n0,0,1,1\n0,0,1,1\n0,0,1,2\n1,1,1,1\n0,0,1,1\n"
    read = read_plots(file(text))
    assert [len(scan) for scan in only(read).scans] == [2, 1]
    (note,) = read.notes
    assert "2 plots that repeat an earlier row" in note
    assert "line 3" in note


# ------------------------------------------------------------------ own ship


def test_own_ship_is_interpolated_to_each_plot(file):
    plots = file("scan,time_s,range_m,bearing_deg\n0,0.5,0,0\n0,1.5,0,0\n2,4.5,0,0\n")
    episode = only(read_plots(plots, file(OWN, "own.csv")))
    np.testing.assert_allclose(episode.scans[0].own_north_m, [5.0, 15.0])
    np.testing.assert_allclose(episode.scans[2].own_north_m, [45.0])


def test_own_ship_goes_straight_on_beyond_its_record():
    ship = OwnShipMotion(np.array([0.0, 2.0]), np.array([0.0, 4.0]), np.array([1.0, 1.0]))
    np.testing.assert_allclose(ship.position_at([-1.0, 1.0, 3.0]), [[-2, 1], [2, 1], [6, 1]])
    np.testing.assert_allclose(OwnShipMotion.fixed(3, 4).position_at([0, 9]), [[3, 4], [3, 4]])


def test_a_plot_beyond_own_ship_is_an_error(file):
    plots = file("time_s,north_m,east_m\n1,0,0\n7,0,0\n")
    own = file("time_s,north_m,east_m\n0,0,0\n2,0,0\n", "own.csv")
    with pytest.raises(RecordingError) as caught:
        read_plots(plots, own)
    assert_says(caught, plots, 3, "time_s", "own ship is not known at 7", "own.csv", "0.0 to 2.0")


def test_a_plot_that_says_where_own_ship_was_must_be_within_her_record_too(file):
    text = "time_s,north_m,east_m,own_north_m,own_east_m\n1,9,9,1,0\n2,9,9,2,0\n9,9,9,9,0\n"
    plots, own = file(text), "time_s,north_m,east_m\n0,0,0\n1,1,0\n"
    with pytest.raises(RecordingError) as caught:
        read_plots(plots, file(own, "own.csv"))
    assert_says(caught, plots, 4, "time_s", "own ship is not known at 9", "0.0 to 1.0")
    episode = only(read_plots(plots, file(own + "9,9,0\n", "own.csv")))
    assert episode.own.time_s.tolist() == [0.0, 1.0, 9.0]


def test_a_plot_inside_an_own_ship_gap_is_an_error(file):
    plots = file("time_s,north_m,east_m\n1,0,0\n20,0,0\n")
    own = file("time_s,north_m,east_m\n0,0,0\n1,0,0\n2,nan,0\n30,0,0\n31,0,0\n", "own.csv")
    with pytest.raises(RecordingError) as caught:
        read_plots(plots, own)
    assert_says(caught, plots, 3, "time_s", "own.csv", "a gap of 29 s after its line 3")
    read = read_plots(plots, own, own_gap_s=30.0)
    assert "1 row without a finite own-ship position" in read.notes[0]


def test_a_scan_list_without_positions_is_a_radar_at_rest(file):
    plots = file("scan,time_s,range_m,bearing_deg\n1,2,10,0\n")
    read = read_plots(plots, file("scan,time_s\n0,0\n1,2\n", "own.csv"), own=(5.0, 6.0))
    assert places(only(read)) == [[], [[15.0, 6.0]]]
    assert "the radar is stationary" in read.notes[0]


# ------------------------------------------------------------------ errors


def assert_says(caught, path, line, column, *parts):
    error = caught.value
    assert isinstance(error, ValueError)
    assert (error.path, error.line, error.column) == (path, line, column)
    message = str(error)
    assert "\n" not in message
    for part in (str(path), f"line {line}", *([f"column {column}"] if column else []), *parts):
        assert part in message


@pytest.mark.parametrize(
    ("text", "line", "column", "parts"),
    [
        ("", 1, None, ["empty", "wanted a header"]),
        ("\n\n", 1, None, ["empty"]),
        (
            "scan,north_m,east_m\n0,1,2\n",
            1,
            "time_s",
            ["missing", "time_s or", "got scan, north_m"],
        ),
        ("time_s,north_m\n0,1\n", 1, None, ["missing", "north_m and east_m, or range_m"]),
        ("time_s,range_m\n0,1\n", 1, None, ["missing", "bearing_deg"]),
        ("time_s,north_m,east_m,own_north_m\n0,1,1,1\n", 1, "own_east_m", ["missing"]),
        ("time_s,north_m,east_m\n0,1,2\n1,x,2\n", 3, "north_m", ["wanted a number", "got 'x'"]),
        ("time_s,north_m,east_m\n0,1,1_0\n", 2, "east_m", ["wanted a number", "got '1_0'"]),
        ("time_s,Range m,bearing_deg\n0,-5,0\n", 2, "Range m", ["0 or more", "got '-5'"]),
        ("time_s,range_m,bearing_deg\n0,5,361\n", 2, "bearing_deg", ["-360 to 360", "'361'"]),
        ("time_s,range_m,bearing_rad\n0,5,90\n", 2, "bearing_rad", ["2 pi", "'90'"]),
        ("time_s,north_m,east_m\nnoon,1,1\n", 2, "time_s", ["UTC seconds or ISO 8601", "'noon'"]),
        ("time,north_m,east_m\n2021-13-04T00:00:00Z,1,1\n", 2, "time", ["ISO 8601"]),
        ("time_s,north_m,east_m\n,1,1\n", 2, "time_s", ["UTC seconds", "an empty cell"]),
        ("time_s,north_m,east_m\nnan,1,1\n", 2, "time_s", ["UTC seconds", "'nan'"]),
        ("scan,time_s,north_m,east_m\n1.5,0,1,1\n", 2, "scan", ["a whole number", "'1.5'"]),
        ("time_s,north_m,east_m,north_m\n0,1,1,1\n", 1, "north_m", ["repeated"]),
        ("time_s,utc,north_m,east_m\n0,0,1,1\n", 1, "utc", ["repeated", "time_s and utc"]),
        ("time_s,range_m,range_nm,bearing_deg\n0,1,1,1\n", 1, "range_nm", ["range_m and range_nm"]),
        ("time_s,north_m,east_m\n0,1\n", 2, None, ["wanted 3 cells, got 2"]),
        ("time_s\n0\n0,1\n", 3, None, ["wanted 1 cell, got 2"]),
        ("time_s,north_m,east_m\n0,1,1\n\n0,1,1,1\n", 4, None, ["wanted 3 cells, got 4"]),
        ("scan,time_s,north_m,east_m\n0,5,1,1\n1,4,1,1\n", 3, "time_s", ["go back", "scan 0"]),
        ("scan,time_s,north_m,east_m\n0,5,1,1\n1,5,1,1\n", 3, "time_s", ["increase", "scan 0"]),
        ("time_s,north_m,east_m,own_north_m,own_east_m\n0,1,1,,1\n", 2, "own_north_m", ["finite"]),
    ],
)
def test_bad_plots_are_reported_by_file_line_and_column(file, text, line, column, parts):
    path = file(text)
    with pytest.raises(RecordingError) as caught:
        read_plots(path)
    assert_says(caught, path, line, column, *parts)


@pytest.mark.parametrize(
    ("text", "line", "column", "parts"),
    [
        ("", 1, None, ["empty"]),
        ("scan,time_s,own_north_m,own_east_m\n", 1, None, ["no row follows the header"]),
        ("time_s,own_north_m\n0,1\n", 1, "east_m", ["missing", "own_east_m or east_m"]),
        ("time_s,speed\n0,1\n", 1, "north_m", ["missing"]),
        (
            "scan,time_s,north_m,east_m\n0,0,0,0\n0,1,0,0\n",
            3,
            "scan",
            ["listed twice; wanted each"],
        ),
        ("scan,time_s,north_m,east_m\n0,2,0,0\n1,1,0,0\n", 3, "time_s", ["increase", "scan 0"]),
        ("scan,time_s,north_m,east_m\n0,0,zero,0\n", 2, "north_m", ["a number", "'zero'"]),
    ],
)
def test_bad_own_ship_is_reported_by_file_line_and_column(file, text, line, column, parts):
    path = file(text, "own.csv")
    with pytest.raises(RecordingError) as caught:
        read_plots(None, path)
    assert_says(caught, path, line, column, *parts)


def test_scenarios_must_be_distinguished_in_both_files(file):
    with_scenario = file("scenario,scan,time_s,north_m,east_m\na,0,0,1,1\nb,0,9,1,1\n")
    with pytest.raises(RecordingError) as caught:
        read_plots(with_scenario, file(OWN, "own.csv"))
    assert_says(caught, with_scenario.with_name("own.csv"), 1, "scenario", "missing")
    without = file("scan,time_s,north_m,east_m\n0,0,1,1\n", "without.csv")
    with pytest.raises(RecordingError) as caught:
        read_plots(without, with_scenario)
    assert_says(caught, without, 1, "scenario", "missing")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
def test_a_pipe_that_is_no_text_is_not_read_again(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reported = []

    def read():
        with pytest.raises(RecordingError) as caught:
            read_plots(pipe)
        reported.append(str(caught.value))

    reader = threading.Thread(target=read, daemon=True)
    reader.start()
    pipe.write_bytes(b"\x1f\x8b")
    reader.join(timeout=10.0)
    assert "the file is empty" in reported[0]


def test_a_turned_scan_keeps_its_ranges_about_own_ship(file):
    plots = file("time_s,range_m,bearing_deg\n0,100,175\n0,50,0\n")
    (scan,) = only(read_plots(plots, own=(10.0, 20.0))).scans
    turned = scan.without_offsets(0.0, np.radians(-10.0), 0.0)
    np.testing.assert_allclose(turned.range_bearing[:, 0], scan.range_m)
    np.testing.assert_allclose(np.degrees(turned.bearing_rad), [-175.0, 10.0])
    from_own_m = turned.position_m - np.column_stack([turned.own_north_m, turned.own_east_m])
    np.testing.assert_allclose(np.hypot(*from_own_m.T), turned.range_m)
    np.testing.assert_allclose(np.arctan2(*from_own_m.T[::-1]), turned.bearing_rad)


def test_files_that_are_no_text_or_not_there(file, tmp_path):
    for encoding in ("utf-16", "utf-16-le", "utf-16-be"):
        with pytest.raises(RecordingError, match="got text in UTF-16, save it as UTF-8 first"):
            read_plots(file("time_s,north_m,east_m\n0,1,1\n".encode(encoding)))
    with pytest.raises(RecordingError, match=r"none\.csv: the file cannot be read"):
        read_plots(tmp_path / "none.csv")
    with pytest.raises(RecordingError, match="cannot be read"):
        read_plots(tmp_path)


@pytest.mark.parametrize("arguments", [{"period_s": 0.0}, {"own_gap_s": -1.0}])
def test_parameters_that_are_invalid(file, arguments):
    path = file("time_s,north_m,east_m\n0,1,1\n")
    with pytest.raises(ValueError, match=next(iter(arguments))):
        read_plots(path, **arguments)


def test_an_error_survives_pickling():
    error = RecordingError("a.csv", "bad", line=3, column="x", wanted="y", got="z")
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error)
    assert again.line == 3


@given(st.binary(max_size=200))
def test_any_bytes_give_a_recording_or_a_recording_error(tmp_path_factory, data):
    path = tmp_path_factory.mktemp("bytes") / "plots.csv"
    path.write_bytes(b"time_s,range_m,bearing_deg\n" + data)
    try:
        read = read_plots(path)
    except RecordingError:
        return
    for scan in only(read).scans:
        assert np.isfinite(scan.position_m).all()


def test_what_holds_much_is_shown_in_a_few_words():
    read = recording.load("joyride")
    (episode,) = read
    counts, when = "115 scans, 147 plots, 1 target", "1495196206.9 to 1495196526.2 s"
    assert repr(read) == f"<Recording 'joyride': 1 episode, {counts}, {when}>"
    assert repr(episode) == f"<Episode: {counts}, {when}>"
    assert repr(episode.own) == f"<OwnShipMotion: 115 positions, {when}>"
    assert repr(episode.truth) == f"{{'1': <TargetTruth: 115 positions, {when}>}}"
    assert repr(episode.scans[3]) == "<Scan: number 3, 1 plot, at 1495196214.5 s>"
    assert (
        repr(recording.Recording("none", [])) == "<Recording 'none': 0 episodes, 0 scans, 0 plots>"
    )
    assert repr(recording.Tracks.joined([])) == "<Tracks: 0 tracks, 0 rows>"
    assert "14 tracks, 4958 reports" in repr(recording.load_ais())
    log = recording.load_navigation()
    assert repr(log).startswith(f"<NavigationLog 'irene': fixes {len(log.fixes)}, ground ")
    assert repr(log.compass).startswith(f"<MagneticHeading: {len(log.compass)} readings, ")


# ------------------------------------------------------------------ what is written


def fields_of(thing):
    return {name: np.asarray(value) for name, value in vars(thing).items() if value is not None}


def assert_same(got, wanted, names=None):
    for name in names or fields_of(wanted):
        np.testing.assert_array_equal(fields_of(got)[name], fields_of(wanted)[name], name)


@pytest.mark.parametrize("rotating", [False, True])
def test_a_simulated_recording_is_read_back_to_the_last_bit(tmp_path, rotating):
    radar = RadarSimulator(20.0, 0.01, 2.5, 0.5, 0.5, max_range_m=3000.0, rotating=rotating)
    own = Truth([10.0, 3.0, -20.0, 1.0], start_time_s=1.7e9)
    boats = {f'"{k}", east': Truth([900.0 - k, 5.0, 300.0, k], start_time_s=1.7e9) for k in (1, 2)}
    made = radar.record(boats, 30, rng=1, own=own)
    assert not all(map(len, only(made).scans))  # nor are scans without plots lost
    files = [tmp_path / f"{kind}.csv" for kind in ("plots", "scans", "truth")]
    recording.write_plots(files[0], made, *files[1:])
    back = read_plots(*files)
    assert back.notes == []
    got, wanted = only(back), only(made)
    assert_same(got.own, wanted.own)
    assert list(got.truth) == list(wanted.truth)
    for name, truth in wanted.truth.items():
        assert_same(got.truth[name], truth)
    assert len(got) == len(wanted)
    for mine, its in zip(got.scans, wanted.scans, strict=True):
        assert_same(mine, its)


@pytest.mark.parametrize("name", ["joyride", "autoferry"])
def test_recordings_that_ship_are_written_and_read_back(tmp_path, name):
    real = recording.load(name)
    files = [tmp_path / f"{kind}.csv" for kind in ("plots", "scans", "truth")]
    recording.write_plots(files[0], real, *files[1:])
    back = read_plots(*files)
    assert [episode.name for episode in back] == [episode.name for episode in real]
    for got, wanted in zip(back, real, strict=True):
        assert_same(got.own, wanted.own)
        assert list(got.truth) == list(wanted.truth)
        for mine, its in zip(got.scans, wanted.scans, strict=True):
            assert_same(mine, its, ("time_s", "number", "plot_time_s", "range_m", "bearing_rad"))
            np.testing.assert_allclose(mine.position_m, its.position_m, atol=1e-9)


@pytest.mark.parametrize(
    ("episodes", "target", "wanted"),
    [
        (["a", "a"], "1", "each episode must have a unique name, got 'a' 2 times"),
        ([" a"], "1", "names of episodes must be one line without spaces around it, got ' a'"),
        (["a\nb"], "1", r"names of episodes must be one line .*, got 'a\\nb'"),
        (["a"], "1 ", "names of targets must be one line without spaces around it, got '1 '"),
        (["a"], "", "a target must have a name, got ''"),
    ],
)
def test_names_that_would_not_be_read_back_are_not_written(tmp_path, episodes, target, wanted):
    (scene,) = RadarSimulator(5.0, 0.01, 3.0).record({target: Truth([900.0, 1.0, 0.0, 0.0])}, 3, 1)
    parts = [dataclasses.replace(scene, name=name) for name in episodes]
    with pytest.raises(ValueError, match=wanted):
        recording.write_plots(
            tmp_path / "p.csv", recording.Recording("r", parts), None, tmp_path / "t.csv"
        )
    assert not list(tmp_path.iterdir())


def test_plots_alone_are_written_without_own_ship_and_truth(tmp_path):
    made = RadarSimulator(20.0, 0.01, 2.5).record({"a": Truth([900.0, 5.0, 300.0, 1.0])}, 4, rng=1)
    recording.write_plots(tmp_path / "plots.csv", made)
    assert [path.name for path in tmp_path.iterdir()] == ["plots.csv"]
    back = read_plots(tmp_path / "plots.csv")
    assert places(only(back)) == places(only(made))
    blind = dataclasses.replace(made, episodes=[dataclasses.replace(only(made), truth=None)])
    with pytest.raises(ValueError, match="must have truth"):
        recording.write_plots(tmp_path / "plots.csv", blind, truth_path=tmp_path / "truth.csv")


def own_ship(**change):
    rows = np.arange(3.0)
    return recording.OwnShipMotion(**{"time_s": rows, "north_m": rows, "east_m": rows} | change)


def truth(**change):
    names = ("time_s", "north_m", "east_m", "vnorth_mps", "veast_mps")
    return recording.TargetTruth(**dict.fromkeys(names, np.arange(3.0)) | change)


def ais_track(**change):
    names = ("time_s", "north_m", "east_m", "course_rad", "speed_mps")
    return recording.AisTrack("1", **dict.fromkeys(names, np.arange(3.0)) | change)


@pytest.mark.parametrize("made", [own_ship, truth, ais_track])
def test_what_is_made_of_columns_takes_lists_and_rejects_what_does_not_fit(made):
    listed = made(time_s=[0.0, 1.0, 2.0], north_m=[0.0, 1.0, 2.0])
    np.testing.assert_array_equal(listed.north_m, made().north_m)
    for wrong in (np.zeros(2), 0.0, None):
        with pytest.raises(ValueError, match=r"north_m must have shape \(3,\), got \("):
            made(north_m=wrong)
    with pytest.raises(TypeError, match="east_m must hold real numbers: got text"):
        made(east_m=["0", "1", "2"])
    for wrong in ([0.0, 2.0, 1.0], [0.0, np.nan, 1.0]):
        with pytest.raises(ValueError, match="time_s must be finite and in order, got"):
            made(time_s=wrong)


@pytest.mark.parametrize("time_s", [[], [0.0, 0.0], [0.0, 5.0, 5.0]])
def test_own_ship_is_at_one_place_at_a_time(time_s):
    with pytest.raises(ValueError, match="time_s must have at least one time, each once, got"):
        OwnShipMotion(time_s, np.zeros(len(time_s)), np.zeros(len(time_s)))


@pytest.mark.parametrize("nowhere", [np.nan, np.inf])
def test_own_ship_is_somewhere(file, nowhere):
    plots = file("time_s,north_m,east_m\n0,1,1\n")
    with pytest.raises(ValueError, match=r"north_m must be finite, got \["):
        read_plots(plots, own=(nowhere, 0.0))
    with pytest.raises(ValueError, match=r"east_m must be finite, got \["):
        OwnShipMotion([0.0, 1.0], [0.0, 0.0], [0.0, nowhere])
    with pytest.raises(TypeError, match="east_m must hold real numbers: got text such as '5'"):
        OwnShipMotion.fixed(0.0, "5")


NOWHERE = "there/is/no/such/file"
WITH_A_NUMBER = {
    "period_s": lambda value: read_plots(NOWHERE, period_s=value),
    "own_gap_s": lambda value: read_plots(NOWHERE, own_gap_s=value),
    "min_step_s": lambda value: recording.read_ais(NOWHERE, min_step_s=value),
    "reorder_s": lambda value: recording.read_nmea(NOWHERE, reorder_s=value),
    "variation_deg": lambda value: recording.read_nmea(NOWHERE, variation_deg=value),
    "midnight_s": lambda value: recording.read_video(NOWHERE, midnight_s=value),
    "max_gap_s": lambda value: ais_track().parts(value),
    "min_reports": lambda value: ais_track().parts(min_reports=value),
    "longer_than_s": lambda value: recording.load_navigation().gaps_s(value),
    "window_s": lambda value: truth().state_at([0.5], window_s=value),
}


@pytest.mark.parametrize("name", WITH_A_NUMBER)
@pytest.mark.parametrize("wrong", ["3", [1.0]])
def test_readers_and_recordings_name_what_is_not_a_number(name, wrong):
    with pytest.raises(TypeError, match=f"^{name} must be a number, got {re.escape(repr(wrong))}"):
        WITH_A_NUMBER[name](wrong)


@pytest.mark.parametrize("name", ["max_gap_s", "min_reports", "longer_than_s", "window_s"])
@pytest.mark.parametrize("wrong", [-1.0, np.nan])
def test_spans_and_counts_below_zero_are_rejected(name, wrong):
    with pytest.raises(ValueError, match=f"^{name} must be at least 0, got {wrong}"):
        WITH_A_NUMBER[name](wrong)
    with pytest.raises(ValueError, match="max_gap_s must be at least 0"):
        recording.load_navigation().parts(-1.0)
    with pytest.raises(ValueError, match="max_gap_s must be at least 0"):
        truth().state_at([0.5], max_gap_s=-1.0)


def test_scores_forecasts_and_bounds_name_what_is_none():
    joyride = recording.load("joyride")
    with pytest.raises(TypeError, match="tracks must be of type Tracks, got NoneType"):
        metrics.score(None, joyride)
    with pytest.raises(TypeError, match="recording must be a Recording or Episode, got dict"):
        metrics.score(recording.Tracks.joined([]), {})
    with pytest.raises(TypeError, match="track must be an AisTrack or Tracks, got str"):
        forecast.position_m("3", [60.0])
    with pytest.raises(TypeError, match="scenario must be of type Scenario, got str"):
        montecarlo.bound("example1")
    with pytest.raises(TypeError, match="scenarios must be a sequence of Scenario, got None"):
        montecarlo.run(None, {}, 1)


def test_tracks_and_video_of_numbers_written_as_text_are_rejected():
    state = np.zeros((2, 4))
    with pytest.raises(TypeError, match="time_s must hold real numbers: got text such as '1'"):
        recording.Tracks(track_id=["1", "1"], time_s=["1", "2"], state=state)
    video = {"amplitude": np.zeros((2, 3), np.uint8), "azimuth_width_rad": 0.1}
    video |= {"start_range_m": 0.0, "cell_m": 5.0}
    with pytest.raises(TypeError, match="azimuth_rad must hold real numbers: got text such as '0'"):
        recording.RadarVideo(azimuth_rad=["0", "1"], time_s=[0.0, 1.0], **video)
