"""Tables as they come: damaged rows, exports of spreadsheets, dialects of AIS archives."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wakeline import recording
from wakeline.recording import RecordingError, read_ais, read_plots, read_tracks

ROWS = 40


def table(head, row, rows=ROWS):
    return [head, *(row.format(k=k, t=2.5 * k) for k in range(rows))]


PLOTS = table("scan,time_s,range_m,bearing_deg", "{k},{t},9{k:02d}.5,10")
OWN = table("scan,time_s,north_m,east_m", "{k},{t},{k},0")
TRUTH = table("time_s,target,north_m,east_m", "{t},a,{k},0")
TRACKS = table("track_id,time_s,north_m,east_m,vnorth_mps,veast_mps", "7,{t},{k},0,1,2")
AIS = table("mmsi,time,lat,lon,sog,cog", "211,{t},54.{k:03d},10,5,0")


def read(name, lines, file, **given):
    """The times that a reader takes from its table, and the notes about it."""
    path = file("\n".join(lines) + "\n", f"{name}.csv")
    plots = file("\n".join(PLOTS) + "\n", "all.csv")
    notes = []
    if name == "plots":
        got = read_plots(path, **given)
        time_s, notes = np.concatenate([s.plot_time_s for s in got.episodes[0].scans]), got.notes
    elif name == "own":
        got = read_plots(plots, path, **given)
        time_s, notes = got.episodes[0].own.time_s, got.notes
    elif name == "truth":
        got = read_plots(plots, truth_path=path, **given)
        time_s, notes = got.episodes[0].truth["a"].time_s, got.notes
    elif name == "tracks":
        time_s = read_tracks(path, notes=notes, **given).time_s
    else:
        got = read_ais(path, **given)
        time_s, notes = got.tracks["211"].time_s, got.notes
    return time_s.tolist(), notes


TABLES = {"plots": PLOTS, "own": OWN, "truth": TRUTH, "tracks": TRACKS, "ais": AIS}


def replaced(lines, line, text):
    return [*lines[: line - 1], text, *lines[line:]]


def without(*scans):
    return [2.5 * k for k in range(ROWS) if k not in scans]


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize("bad", ["x", "", "1,2", "1,2,3,4,5,6,7,8,9", "0,noon,a,b,c,d", "\0\0\0"])
def test_a_row_that_cannot_be_read_is_left_out_counted_and_placed(name, bad, file):
    lines = replaced(TABLES[name], 21, bad)
    time_s, notes = read(name, lines, file)
    assert time_s == without(19)
    assert (len(notes) == 1 and "1 row" in notes[0] and "line 21" in notes[0]) or not bad


@pytest.mark.parametrize("name", TABLES)
def test_more_than_a_tenth_of_bad_rows_is_an_error_of_the_first(name, file):
    lines = list(TABLES[name])
    for line in (5, 10, 15, 20):
        lines = replaced(lines, line, "bad")
    _, notes = read(name, lines, file)
    assert "4 rows" in notes[0]
    with pytest.raises(RecordingError, match=r"line 5.*5 of 40 rows"):
        read(name, replaced(lines, 30, "bad"), file)


@pytest.mark.parametrize("name", TABLES)
def test_what_spreadsheets_and_recorders_add_does_not_matter(name, file):
    plain = TABLES[name]
    wanted = read(name, plain, file)[0]
    commas = [plain[0], *(f"{line}," for line in plain[1:])]
    semicolons = [line.replace(",", ";").replace(".", ",") for line in plain]
    for odd in (
        commas,
        [f"{line},," for line in plain],
        ["# radar: X", "# time_s of the console", *plain],
        ["Recorder 1.2", "", *plain],
        [*plain[:7], "# restarted", plain[0], *plain[7:], "# end"],
        semicolons,
        [line.replace(",", "\t") for line in plain],
    ):
        assert read(name, odd, file) == (wanted, [])
    times, notes = read(name, [*plain, plain[-1][:4]], file)
    assert times == wanted
    assert "last row is cut off" in notes[0]
    assert "line 42" in notes[0]


@pytest.mark.parametrize("word", ["NA", "n/a", "null", "None", "NaN", "-", "#N/A", ""])
def test_words_for_missing_values_are_missing(word, file):
    lines = replaced(PLOTS, 11, f"9,22.5,{word},10")
    time_s, notes = read("plots", lines, file)
    assert time_s == without(9)
    assert "1 plot without a finite position" in notes[0]


@pytest.mark.parametrize("name", TABLES)
def test_a_time_of_another_age_is_left_out(name, file):
    column = TABLES[name][0].split(",").index("time" if name == "ais" else "time_s")
    cells = TABLES[name][20].split(",")
    cells[column] = "2077-01-31T00:00:00Z"
    time_s, notes = read(name, replaced(TABLES[name], 21, ",".join(cells)), file)
    assert time_s == without(19)
    assert "line 21" in notes[0]


@given(
    st.sampled_from([8, 10, 16]),
    st.integers(0, 3),
    st.integers(1, 3),
    st.booleans(),
)
def test_a_counter_that_begins_again_continues(bits, turns, plots, jitter):
    from wakeline.recording.scans import unwrapped

    count = 2**bits
    first = count * turns + count - 20
    scan = np.repeat(np.arange(first, first + 60), plots)
    time_s = 2.5 * scan + np.tile(np.arange(plots) * (1.4 if jitter else 0.1), 60)
    got = unwrapped(scan % count, time_s)
    assert (got - got[0] == scan - scan[0]).all()


def test_a_counter_wraps_in_plots_and_own_ship_alike(file):
    scans = [(k + 250) % 256 for k in range(ROWS)]
    plots = [PLOTS[0], *(f"{s},{2.5 * k},{500 + k},0" for k, s in enumerate(scans))]
    own = [OWN[0], *(f"{s},{2.5 * k},{k},0" for k, s in enumerate(scans))]
    got = read_plots(file("\n".join(plots)), file("\n".join(own), "own.csv"))
    (episode,) = got.episodes
    assert [len(scan) for scan in episode.scans] == [1] * ROWS
    assert got.notes == []


def test_a_plot_whose_time_does_not_fit_its_scan_is_left_out(file):
    lines = replaced(PLOTS, 21, "19,9.5,19,10")
    time_s, notes = read("plots", lines, file)
    assert time_s == without(19)
    assert "line 21" in notes[0]


def test_a_plot_without_own_ship_is_left_out(file):
    lines = [*OWN[:18], *OWN[21:]]
    got = read_plots(file("\n".join(PLOTS)), file("\n".join(lines), "own.csv"), own_gap_s=3.0)
    assert got.episodes[0].plot_count == ROWS - 3
    assert "3 plots left out" in got.notes[0]
    with pytest.raises(RecordingError, match="own ship is not known"):
        read_plots(file("\n".join(PLOTS)), file("\n".join(OWN[:30]), "own.csv"))


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_text_that_is_not_utf_8_is_read_and_said(file, end):
    text = f"time_s,target,north_m,east_m,name{end}0,Sørn,1,2,x{end}1,Særn,1,2,x{end}"
    plots = file("time_s,north_m,east_m\n0,1,1\n1,1,1\n")
    got = read_plots(plots, truth_path=file(text.encode("latin-1"), "truth.csv"))
    assert list(got.episodes[0].truth) == ["Særn", "Sørn"]
    assert "octet 0xf8 in line 2" in got.notes[0]


@pytest.mark.parametrize("name", TABLES)
def test_columns_are_named_by_the_caller(name, file):
    wanted = read(name, TABLES[name], file)[0]
    ours = TABLES[name][0].split(",")
    lines = [",".join(f"Their {n}" for n in ours), *TABLES[name][1:]]
    columns = {f"their {n}": n for n in ours}
    assert read(name, lines, file, columns=columns)[0] == wanted
    with pytest.raises(RecordingError, match="a column is missing"):
        read(name, lines, file)
    with pytest.raises(RecordingError, match="wanted thier"):
        read(name, lines, file, columns={**columns, "thier": ours[-1]})
    more = [f"{line},{cell}" for line, cell in zip(lines, ["Note"] + ["x"] * ROWS, strict=False)]
    with pytest.raises(RecordingError, match="got meaning"):
        read(name, more, file, columns={**columns, "note": "meaning"})


# ------------------------------------------------------------------ AIS

DAY_S = 1789257600.0  # 2026-09-13

DIALECTS = {
    "Danish": (
        "# Timestamp,Type of mobile,MMSI,Latitude,Longitude,ROT,SOG,COG,Heading,Name",
        "13/09/2026 00:{m:02d}:{s:02d},Class A,211,{lat},{lon},0.0,{kn},{cog},60,X",
    ),
    "MarineCadastre until 2024": (
        "MMSI,BaseDateTime,LAT,LON,SOG,COG,Heading,VesselName",
        '211,2026-09-13T00:{m:02d}:{s:02d},{lat},{lon},{kn},{cog},511.0,"OLD" X',
    ),
    "MarineCadastre from 2025": (
        "mmsi,base_date_time,longitude,latitude,sog,cog,heading,vessel_name",
        "211,2026-09-13 00:{m:02d}:{s:02d},{lon},{lat},{kn},{cog},511,X",
    ),
    "Brest": (
        "sourcemmsi,navigationalstatus,rateofturn,speedoverground,courseoverground,lon,lat,t",
        "211,0,0,{kn},{cog},{lon},{lat},{t:.0f}",
    ),
    "Norwegian": (
        "mmsi;imo_nr;date_time_utc;lon;lat;sog;cog;true_heading",
        "211;0;2026-09-13 00:{m:02d}:{s:02d};{lon};{lat};{kn};{cog};60",
    ),
    "Piraeus": (
        "t,vessel_id,lon,lat,heading,course,speed",
        "{ms:.0f},211,{lon},{lat},60,{cog},{kn}",
    ),
    "Global Fishing Watch": (
        "mmsi,timestamp,speed,course,lat,lon",
        "211,2026-09-13 00:{m:02d}:{s:02d} UTC,{kn},{cog},{lat},{lon}",
    ),
    "metres a second": (
        ",timestamp,mmsi,lat,lon,speed,course",
        "0,2026-09-13 00:{m:02d}:{s:02d},211,{lat},{lon},{mps},{cog}",
    ),
    "American": (
        "mmsi,time,lat,lon,sog,cog",
        "211,9/13/2026 12:{m:02d}:{s:02d} AM,{lat},{lon},{kn},{cog}",
    ),
}


def voyage(row, speed_mps=5.0):
    """Six reports, 10 s apart, on 060."""
    for k in range(6):
        way_m = 10 * k * speed_mps
        lat = 55 + np.degrees(way_m * 0.5 / 6.371e6)
        lon = 11 + np.degrees(way_m * np.sqrt(0.75) / 6.371e6 / np.cos(np.radians(55)))
        t = DAY_S + 10 * k
        values = {"m": 10 * k // 60, "s": 10 * k % 60, "t": t, "ms": 1e3 * t, "cog": 60}
        values |= {"lat": f"{lat:.7f}", "lon": f"{lon:.7f}"}
        yield row.format(**values, mps=speed_mps, kn=speed_mps * 1.943844)


@pytest.mark.parametrize("name", DIALECTS)
def test_dialects_of_ais_archives_hold_the_same_voyage(name, file):
    head, row = DIALECTS[name]
    (track,) = read_ais(file("\n".join([head, *voyage(row)]))).tracks.values()
    np.testing.assert_allclose(track.time_s, DAY_S + 10 * np.arange(6))
    np.testing.assert_allclose(track.speed_mps, 5.0, rtol=1e-5)
    np.testing.assert_allclose(np.degrees(track.course_rad), 60.0, atol=0.1)
    steps_m = np.hypot(np.diff(track.north_m), np.diff(track.east_m))
    np.testing.assert_allclose(steps_m, 50.0, rtol=0.01)


def test_a_speed_of_an_unknown_unit_is_not_used_and_said(file):
    lines = ["mmsi,time,lat,lon,speed,track_over_ground_speed", *["211,{k},54,10,7,7"]]
    lines = [lines[0], *(lines[1].format(k=10 * k) for k in range(5))]
    got = read_ais(file("\n".join(lines)))
    assert np.isnan(got.tracks["211"].speed_mps).all()
    assert any("unit of speed is not known" in note for note in got.notes)
    assert any("track_over_ground_speed not used" in note for note in got.notes)
    got = read_ais(file("\n".join(lines)), columns={"speed": "SOG_mps"})
    assert got.tracks["211"].speed_mps.tolist() == [7.0] * 5


@pytest.mark.parametrize(
    ("dates", "days"),
    [
        (["03/04/2026", "04/04/2026"], 1),
        (["04/03/2026", "04/04/2026"], 1),
        (["25/12/2026", "26/12/2026"], 1),
        (["12/25/2026", "12/26/2026"], 1),
        (["13.09.2026", "14.09.2026"], 1),
        (["2026/09/13", "2026/09/14"], 1),
        (["1/2/2026", "1/2/2026"], 0),
    ],
)
def test_dates_are_read_in_the_order_that_fits(dates, days, file):
    rows = [f"{date} 10:00:00,1,1" for date in dates]
    times = recording.read_plots(file("\n".join(["time,north_m,east_m", *rows]))).episodes[0].time_s
    assert np.ptp(times) == days * 86400


@pytest.mark.parametrize(("unit", "per_second"), [("milli", 1e3), ("micro", 1e6), ("nano", 1e9)])
def test_times_in_smaller_units_are_read_as_seconds(unit, per_second, file):
    rows = [f"{(DAY_S + k) * per_second:.0f},1,1" for k in range(3)]
    got = read_plots(file("\n".join(["time,north_m,east_m", *rows])))
    np.testing.assert_allclose(got.episodes[0].time_s, DAY_S + np.arange(3), atol=1e-3)
    assert f"{unit}seconds" in got.notes[0]
