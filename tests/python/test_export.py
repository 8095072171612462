"""Tracks as GPX, KML, GeoJSON and CSV, read back by gpsbabel, GDAL and pandas."""

import csv
import json
import math
import shutil
import subprocess
from datetime import datetime, timedelta, timezone
from xml.etree import ElementTree as Xml

import numpy as np
import pytest
from geographiclib.geodesic import Geodesic

from wakeline.cli import main
from wakeline.live.record import Recorder
from wakeline.recording import Tracks, export_tracks, write_tracks

START = datetime(2026, 5, 1, 12, 0, tzinfo=timezone.utc)
ORIGIN = (63.44, 10.40)
FORMATS = ("gpx", "kml", "geojson", "csv")


def make_tracks(scenario=False):
    """Two tracks, one of which has a name that markup has to escape."""
    time_s = np.tile(np.arange(20) * 2.5, 2)
    ids = np.repeat(["1", 'a<&"\x07ø'], 20)
    state = np.zeros((40, 4))
    state[:, 0] = np.where(ids == "1", 1000.0, -20_000.0) + 6.0 * time_s
    state[:, 1] = 6.0
    state[:, 2] = 9000.0 - 4.0 * time_s
    state[:, 3] = -4.0
    order = np.random.default_rng(1).permutation(40)  # files need no order
    more = {"scenario": np.repeat(["x", "y"], 20)[order]} if scenario else {}
    return Tracks(ids[order], time_s[order], state[order], **more)


def places_deg(tracks, name):
    """Latitude and longitude in order of time, by another geodesy."""
    rows = tracks.where(tracks.track_id == name)
    rows = rows.where(np.argsort(rows.time_s))
    found = []
    for north, east in rows.state[:, [0, 2]]:
        course = math.degrees(math.atan2(east, north))
        line = Geodesic.WGS84.Direct(*ORIGIN, course, math.hypot(north, east))
        found.append((line["lat2"], line["lon2"]))
    return np.array(found)


def times_of(tracks, name):
    return [START + timedelta(seconds=s) for s in sorted(tracks.time_s[tracks.track_id == name])]


@pytest.fixture
def tracks():
    return make_tracks()


@pytest.fixture
def files(tmp_path, tracks):
    files = {ending: tmp_path / f"tracks.{ending}" for ending in FORMATS}
    for file in files.values():
        export_tracks(file, tracks, origin_deg=ORIGIN, start=START)
    return files


def run(*command):
    if shutil.which(command[0]) is None:
        pytest.skip(f"{command[0]} is not installed")
    said = subprocess.run(
        [str(one) for one in command], capture_output=True, text=True, timeout=60, check=False
    )
    assert said.returncode == 0, said.stderr
    return said.stdout


def instant(text):
    return datetime.fromisoformat(text.strip().replace("Z", "+00:00").replace("/", "-"))


def test_gpx_has_every_row(files, tracks):
    space = {"g": "http://www.topografix.com/GPX/1/1"}
    root = Xml.parse(files["gpx"]).getroot()
    lines = root.findall("g:trk", space)
    assert {line.find("g:name", space).text for line in lines} == {"1", 'a<&"?ø'}
    for line in lines:
        name = "1" if line.find("g:name", space).text == "1" else 'a<&"\x07ø'
        points = line.findall("g:trkseg/g:trkpt", space)
        got = [(float(point.get("lat")), float(point.get("lon"))) for point in points]
        assert np.abs(np.array(got) - places_deg(tracks, name)).max() < 1e-7
        when = [instant(point.find("g:time", space).text) for point in points]
        assert when == times_of(tracks, name)


@pytest.mark.parametrize("ending", ["gpx", "kml"])
def test_gpsbabel_reads_what_we_write(files, tracks, tmp_path, ending):
    out = tmp_path / "babel.csv"
    run("gpsbabel", "-t", "-i", ending, "-f", files[ending], "-o", "unicsv,utc=0", "-F", out)
    with out.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(tracks)
    wanted = np.concatenate([places_deg(tracks, name) for name in tracks.ids()])
    got = np.array([(float(row["Latitude"]), float(row["Longitude"])) for row in rows])
    order = np.lexsort(got.T), np.lexsort(wanted.T)
    assert np.abs(got[order[0]] - wanted[order[1]]).max() < 2e-6  # what gpsbabel writes
    when = sorted(instant(f"{row['Date']} {row['Time']}Z") for row in rows)
    assert when == sorted(times_of(tracks, "1") + times_of(tracks, tracks.ids()[1]))


@pytest.mark.parametrize(
    ("ending", "layer"), [("gpx", "track_points"), ("geojson", None), ("kml", None)]
)
def test_gdal_reads_what_we_write(files, tracks, ending, layer):
    said = run("ogrinfo", "-ro", "-al", files[ending], *([layer] if layer else []))
    if ending == "gpx":
        assert said.count("POINT (") == len(tracks)
        return
    lines = [line for line in said.splitlines() if "LINESTRING" in line.split("(")[0]]
    lines = [line for line in lines if "(" in line]
    assert len(lines) == 2
    wanted = sorted(places_deg(tracks, name)[0].tolist() for name in tracks.ids())
    got = []
    for line in lines:
        longitude, latitude = line.split("(")[1].split(",")[0].split()[:2]
        got.append([float(latitude), float(longitude)])
        assert line.count(",") == 19
    assert np.abs(np.array(sorted(got)) - wanted).max() < 1e-7


def test_geojson_has_lines_with_times(files, tracks):
    collection = json.loads(files["geojson"].read_text(encoding="utf-8"))
    assert collection["type"] == "FeatureCollection"
    assert len(collection["features"]) == 2
    for feature in collection["features"]:
        name = feature["properties"]["track_id"]
        got = np.array(feature["geometry"]["coordinates"])[:, ::-1]
        assert np.abs(got - places_deg(tracks, name)).max() < 1e-7
        when = [instant(text) for text in feature["properties"]["coordTimes"]]
        assert when == times_of(tracks, name)


def test_pandas_reads_the_csv(files, tracks):
    pandas = pytest.importorskip("pandas")
    table = pandas.read_csv(files["csv"], parse_dates=["time"], dtype={"track_id": str})
    assert len(table) == len(tracks)
    assert set(table["track_id"]) == set(tracks.ids())
    for name, rows in table.groupby("track_id"):
        places = rows[["latitude_deg", "longitude_deg"]].to_numpy()
        assert np.abs(places - places_deg(tracks, name)).max() < 1e-7
        assert [one.to_pydatetime() for one in rows["time"]] == times_of(tracks, name)
    assert table["speed_mps"].to_numpy() == pytest.approx(math.hypot(6, 4))


def test_csv_has_courses_from_true_north(tmp_path):
    """At 100 km to the east, meridians converge by 1.8 degrees."""
    north = Tracks(["1"], [0.0], [[0.0, 5.0, 100e3, 0.0]])
    export_tracks(tmp_path / "a.csv", north, origin_deg=ORIGIN)
    with (tmp_path / "a.csv").open(encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    line = Geodesic.WGS84.Direct(*ORIGIN, 90.0, 100e3)
    assert float(row["course_deg"]) == pytest.approx(line["azi2"] - 90.0, abs=1e-3)
    assert float(row["course_deg"]) == pytest.approx(1.8, abs=0.1)
    assert row["time"] == ""


def test_scenarios_are_apart(tmp_path):
    tracks = make_tracks(scenario=True)
    export_tracks(tmp_path / "a.geojson", tracks, origin_deg=ORIGIN)
    features = json.loads((tmp_path / "a.geojson").read_text())["features"]
    assert {feature["properties"]["scenario"] for feature in features} == {"x", "y"}
    assert all("coordTimes" not in feature["properties"] for feature in features)


@pytest.mark.parametrize("east", [1, -1])
def test_a_line_is_cut_at_the_antimeridian(tmp_path, east):
    state = [[0.0, 0.0, east * (k - 1.5) * 1000.0, 10.0] for k in range(4)]
    tracks = Tracks(["1"] * 4, np.arange(4.0), state)
    export_tracks(tmp_path / "a.geojson", tracks, origin_deg=(10.0, 180.0))
    (feature,) = json.loads((tmp_path / "a.geojson").read_text())["features"]
    first, second = feature["geometry"]["coordinates"]
    assert feature["geometry"]["type"] == "MultiLineString"
    assert (len(first), len(second)) == (3, 3)
    assert (first[-1][0], second[0][0]) == (180.0 * east, -180.0 * east)
    assert first[-1][1] == second[0][1] == pytest.approx(10.0, abs=1e-6)
    for part in (first, second):
        assert np.abs(np.diff([place[0] for place in part])).max() < 0.02


def test_unix_times_need_no_start(tmp_path, tracks):
    later = Tracks(tracks.track_id, tracks.time_s + START.timestamp(), tracks.state)
    for ending in FORMATS:
        export_tracks(tmp_path / f"a.{ending}", later, origin_deg=ORIGIN)
        export_tracks(tmp_path / f"b.{ending}", tracks, origin_deg=ORIGIN, start=START)
        a, b = ((tmp_path / f"{name}.{ending}").read_text(encoding="utf-8") for name in "ab")
        if ending in ("gpx", "kml"):
            assert a == b
        else:
            assert "2026-05-01T12:00:47.500Z" in a


def test_tracks_without_rows_and_rows_that_are_not_finite(tmp_path):
    none = Tracks([], [], np.zeros((0, 4)))
    bad = Tracks(["1", "1"], [0.0, 1.0], [[0.0] * 4, [math.nan] * 4])
    for ending in FORMATS:
        export_tracks(tmp_path / f"none.{ending}", none, origin_deg=ORIGIN)
        export_tracks(tmp_path / f"bad.{ending}", bad, origin_deg=ORIGIN)
    (feature,) = json.loads((tmp_path / "bad.geojson").read_text())["features"]
    assert feature["geometry"]["type"] == "Point"
    assert json.loads((tmp_path / "none.geojson").read_text())["features"] == []
    Xml.parse(tmp_path / "none.gpx")


def test_what_cannot_be_written_is_named(tmp_path, tracks):
    with pytest.raises(ValueError, match="shp"):
        export_tracks(tmp_path / "a.shp", tracks, origin_deg=ORIGIN)
    with pytest.raises(ValueError, match="origin_deg"):
        export_tracks(tmp_path / "a.gpx", tracks, origin_deg=(91.0, 0.0))
    assert list(tmp_path.iterdir()) == []


def test_the_command_writes_all_formats(tmp_path, tracks, files, capsys):
    write_tracks(tmp_path / "in.csv", tracks)
    out = [str(tmp_path / f"out.{ending}") for ending in FORMATS]
    told = ["--origin=63.44,10.40", "--start=2026-05-01T12:00:00Z"]
    assert main(["export", str(tmp_path / "in.csv"), *out, *told]) == 0
    assert "2 tracks, 40 rows" in capsys.readouterr().out
    for ending in FORMATS:
        written = (tmp_path / f"out.{ending}").read_bytes()
        assert written == files[ending].read_bytes()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["in.csv", "out.gpx"], "--origin"),
        (["in.csv", "out.gpx", "--origin=a,b"], "LAT,LON"),
        (["in.csv", "out.gpx", "--origin=1,2", "--start=noon"], "2026-05-01"),
        (["in.csv", "in.csv", "--origin=1,2"], "in.csv"),
        (["in.csv", "out.dat", "--origin=1,2"], ".geojson"),
        (["none.csv", "out.gpx", "--origin=1,2"], "none.csv"),
    ],
)
def test_the_command_says_what_is_wrong(tmp_path, monkeypatch, tracks, capsys, arguments, said):
    monkeypatch.chdir(tmp_path)
    write_tracks("in.csv", tracks)
    assert main(["export", *arguments]) == 2
    assert said in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["in.csv"]


def test_a_session_is_replayed_and_has_its_own_origin(tmp_path, capsys):
    """A boat seen ashore: 6 m/s to the north, 2 km to the east."""
    path = tmp_path / "watch.pcap"
    radar = {"name": "A", "position_deg": list(ORIGIN), "period_s": 2.5}
    recorder = Recorder(path, {"radar": [radar]})
    recorder.begin(START.timestamp())
    for k in range(20):
        t = START.timestamp() + 2.5 * k
        north = 6.0 * 2.5 * k - 150.0
        plot = {"range_m": math.hypot(north, 2000.0), "bearing_rad": math.atan2(2000.0, north)}
        sector = {"from_rad": 0.0, "to_rad": math.tau, "time_s": t}
        for line in ({"time_s": t, **plot}, {"sector": sector}):
            octets = json.dumps({"radar": "A", **line}).encode()
            recorder.data(t, "plots", "udp://127.0.0.1:8600", octets)
    recorder.close()
    assert main(["export", str(path), str(tmp_path / "out.geojson")]) == 0
    assert "1 track" in capsys.readouterr().out
    (feature,) = json.loads((tmp_path / "out.geojson").read_text())["features"]
    longitude, latitude = feature["geometry"]["coordinates"][-1]
    line = Geodesic.WGS84.Inverse(*ORIGIN, latitude, longitude)
    last = math.hypot(6.0 * 47.5 - 150.0, 2000.0)
    assert line["s12"] == pytest.approx(last, abs=30.0)
    assert feature["properties"]["end"] == "2026-05-01T12:00:47.500Z"
