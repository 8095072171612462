"""AIS reports: reading, dropped reports and their notes, rejected files; the Solent."""

import gzip

import numpy as np
import pytest

from wakeline import recording
from wakeline.recording import RecordingError, read_ais

HEAD = "Time,MMSI,Latitude_degrees,Longitude_degrees,COG_degrees,SOG_knots"
KNOT_MPS = 1852.0 / 3600.0
SECOND_DEG = 10.0 / 111_200.0  # about 10 m north


def row(second, mmsi="211", latitude=54.0, longitude=10.0, cog=0.0, sog=20.0):
    return f"2026-05-01 12:00:{second:06.3f},{mmsi},{latitude},{longitude},{cog},{sog}"


def written(tmp_path, *rows, head=HEAD):
    path = tmp_path / "ais.csv"
    path.write_text("\n".join([head, *rows]) + "\n")
    return path


def northbound(seconds, mmsi="211"):
    return [row(s, mmsi, latitude=54.0 + s * SECOND_DEG) for s in seconds]


def test_reports_become_a_track_in_the_local_plane(tmp_path):
    ais = read_ais(written(tmp_path, *northbound([0, 3, 7.5])), origin_deg=(54.0, 10.0))
    (track,) = ais.tracks.values()
    assert (track.mmsi, len(track)) == ("211", 3)
    np.testing.assert_allclose(np.diff(track.time_s), [3.0, 4.5])
    np.testing.assert_allclose(track.north_m, [0.0, 30.0, 75.0], atol=0.3)
    np.testing.assert_allclose(track.east_m, 0.0, atol=1e-6)
    np.testing.assert_allclose(track.course_rad, 0.0, atol=1e-6)
    np.testing.assert_allclose(track.vnorth_mps, 20 * KNOT_MPS)
    np.testing.assert_allclose(track.veast_mps, 0.0, atol=1e-4)
    assert ais.notes == []


def test_rows_need_no_order_and_vessels_are_reported_apart(tmp_path):
    mixed = [*northbound([9, 0, 6], "2"), *northbound([3, 1], "1")]
    ais = read_ais(written(tmp_path, *mixed))
    assert list(ais.tracks) == ["2", "1"]
    assert [len(track) for track in ais.tracks.values()] == [3, 2]
    for track in ais.tracks.values():
        assert (np.diff(track.time_s) > 0).all()
        assert (np.diff(track.north_m) > 0).all()


def test_the_origin_is_the_median_where_none_is_given(tmp_path):
    ais = read_ais(written(tmp_path, row(0, latitude=54.0), row(5, "9", 54.2, 10.4)))
    assert (ais.plane.latitude_rad, ais.plane.longitude_rad) == pytest.approx(
        np.radians([54.1, 10.2])
    )


@pytest.mark.parametrize("longitudes", [(10.0, 10.0), (179.9999, -179.9999)])
def test_a_outlier_report_does_not_move_the_plane(tmp_path, longitudes):
    there = [row(s, longitude=longitudes[s % 2], latitude=54.0 + s * SECOND_DEG) for s in range(9)]
    alone = read_ais(written(tmp_path, *there))
    beside = read_ais(written(tmp_path, row(4, "8", -20.0, 40.0), *there))
    place_m = beside.plane.position_m(
        latitude_rad=alone.plane.latitude_rad, longitude_rad=alone.plane.longitude_rad
    )
    assert np.hypot(*place_m) < 20.0
    (note,) = beside.notes
    assert "1 report is more than 500 km from the origin of the plane (first in line 2)" in note
    (note,) = read_ais(written(tmp_path, row(10, latitude=-20.0), *there)).notes
    assert "1 report out of reach of the vessel at 40 m/s left out (first in line 2)" in note


def test_other_programs_names_of_columns(tmp_path):
    path = written(tmp_path, "2026-05-01T12:00:00Z,211,54,10", head="BaseDateTime,MMSI,LAT,LON")
    (track,) = read_ais(path).tracks.values()
    assert np.isnan([*track.speed_mps, *track.course_rad, *track.vnorth_mps]).all()


@pytest.mark.parametrize("name", ["timestamp_s", "datetime", "UTC", "BaseDateTime"])
def test_the_time_goes_by_the_names_it_has_in_other_recordings(tmp_path, name):
    path = written(tmp_path, "2026-05-01T12:00:00Z,211,54,10", head=f"{name},MMSI,LAT,LON")
    assert list(read_ais(path).tracks) == ["211"]


@pytest.mark.parametrize(
    ("cog", "sog"), [("360", "5"), ("", "5"), ("90", "102.3"), ("90", "102.2"), ("90", "")]
)
def test_what_is_not_available_is_not_a_number(tmp_path, cog, sog):
    (track,) = read_ais(written(tmp_path, row(0, cog=cog, sog=sog))).tracks.values()
    assert np.isnan(track.vnorth_mps).all()
    assert np.isfinite(track.north_m).all()


@pytest.mark.parametrize(("cog", "sog"), [("409.5", "5"), ("-100.5", "5"), ("90", "-0.1")])
def test_what_a_message_can_hold_but_no_vessel_can_do_is_left_out_and_said(tmp_path, cog, sog):
    ais = read_ais(written(tmp_path, row(0), row(3, cog=cog, sog=sog), row(6)))
    (track,) = ais.tracks.values()
    assert np.isnan(track.vnorth_mps).tolist() == [False, True, False]
    assert np.isfinite(track.north_m).all()
    (note,) = ais.notes
    assert "1 value of" in note
    assert "impossible for a vessel left out (first in line 3)" in note


def test_a_stream_faster_than_wanted_is_thinned_not_lost(tmp_path):
    path = written(tmp_path, *northbound(np.arange(0.0, 10.0, 0.5)))
    (track,) = read_ais(path).tracks.values()
    np.testing.assert_allclose(track.time_s - track.time_s[0], np.arange(10.0))
    (track,) = read_ais(path, min_step_s=3.0).tracks.values()
    assert (np.diff(track.time_s) >= 3.0).all()
    assert len(track) == 4
    ais = read_ais(path, min_step_s=100.0)
    assert [len(track) for track in ais.tracks.values()] == [1]
    assert "19 reports less than 100 s before the next of the vessel" in ais.notes[0]


def test_a_vessel_that_crosses_180_degrees_continues(tmp_path):
    crossing = [
        row(0, latitude=-17.0, longitude=179.999, cog=90.0),
        row(20, latitude=-17.0, longitude=-179.999, cog=90.0),
    ]
    (track,) = (ais := read_ais(written(tmp_path, *crossing))).tracks.values()
    assert abs(ais.plane.longitude_rad) == pytest.approx(np.pi)
    assert np.diff(track.east_m) == pytest.approx(
        0.002 * 111_320.0 * np.cos(np.radians(17)), rel=0.01
    )
    np.testing.assert_allclose(track.north_m, 0.0, atol=0.1)
    np.testing.assert_allclose(np.degrees(track.course_rad), 90.0, atol=1e-3)


def test_a_vessel_at_rest_needs_no_course(tmp_path):
    (track,) = read_ais(written(tmp_path, row(0, cog="360", sog="0"))).tracks.values()
    assert (track.vnorth_mps[0], track.veast_mps[0]) == (0.0, 0.0)


def test_what_is_left_out_is_said(tmp_path):
    rows = northbound([0, 3, 6, 6.4, 9])
    rows.insert(1, row(1, latitude=91, longitude=181))
    rows.insert(4, row(7.9, latitude=54.5))  # 55 km away within two seconds
    ais = read_ais(written(tmp_path, *rows))
    (track,) = ais.tracks.values()
    np.testing.assert_allclose(track.time_s - track.time_s[0], [0.0, 3.0, 6.4, 9.0])
    assert [note.split("left out")[0] for note in ais.notes] == [
        "ais.csv: 1 report without a position ",
        "ais.csv: 1 report less than 1 s before the next of the vessel ",
        "ais.csv: 1 report out of reach of the vessel at 40 m/s ",
    ]
    assert [note.split("line ")[1] for note in ais.notes] == ["3)", "5)", "6)"]


def test_reports_too_far_off_for_one_plane_are_reported(tmp_path):
    hawaii = [row(second, "1", 21.0 + second * 5e-5, -157.0, 0.0, 10.8) for second in (0, 30)]
    rows = [row(0, "2", 19.0, -111.0), *hawaii]
    ais = read_ais(written(tmp_path, *rows), origin_deg=(19.0, -111.0))
    track = ais.tracks["1"]
    way_m = np.hypot(np.diff(track.north_m)[0], np.diff(track.east_m)[0])
    stretch = 100.0 * (way_m / (30 * 5e-5 * 110_700.0) - 1.0)
    (note,) = ais.notes
    assert "2 reports are more than 500 km from the origin of the plane (first in line 3)" in note
    reported = float(note.partition("too long by ")[2].partition(" %")[0])
    assert reported == pytest.approx(stretch, abs=1.0)
    assert "% at 4803 km; cut the file to one area" in note
    near = read_ais(written(tmp_path, row(0, "1", 54.0), row(0, "2", 56.6)), origin_deg=(54.0, 10))
    assert near.notes == []


def test_three_reports_in_a_row_are_believed_though_they_are_far(tmp_path):
    far = [row(s, latitude=54.5 + s * SECOND_DEG) for s in (12, 15, 18)]
    (track,) = read_ais(written(tmp_path, *northbound([0, 3, 6, 9]), *far)).tracks.values()
    assert len(track) == 7
    (track,) = read_ais(written(tmp_path, *northbound([0, 3]), *far)).tracks.values()
    assert len(track) == 3  # the first two were the ones that were wrong


def test_parts_are_cut_at_gaps(tmp_path):
    (track,) = read_ais(written(tmp_path, *northbound([0, 3, 6, 40, 43, 59]))).tracks.values()
    parts = track.parts(max_gap_s=15.0)
    assert [len(part) for part in parts] == [3, 2]
    assert [len(part) for part in track.parts(15.0, min_reports=1)] == [3, 2, 1]
    assert [len(part) for part in track.parts()] == [6]
    np.testing.assert_array_equal(parts[1].north_m, track.north_m[3:5])
    assert len(track.rows(track.time_s > track.time_s[2])) == 3


@pytest.mark.parametrize(
    ("rows", "wanted"),
    [
        ([row(0, latitude=90.5)], ["line 2", "latitude", "-90 to 90", "90.5"]),
        ([row(0), row(1, longitude=-181)], ["line 3", "longitude", "-180 to 180", "-181"]),
        ([row(0, cog=900)], ["line 2", "cog", "0 to 410", "900"]),
        ([row(0, sog=140)], ["line 2", "sog", "0 to 102.4", "140"]),
        ([row(0, sog="fast")], ["line 2", "SOG", "fast"]),
        ([row(0, mmsi="")], ["line 2", "mmsi"]),
        ([row(0).replace("2026-05-01", "May")], ["line 2", "Time"]),
        ([row(0, latitude=91)], ["no report has a position"]),
    ],
)
def test_cells_that_are_invalid_are_reported_by_line_and_column(tmp_path, rows, wanted):
    with pytest.raises(RecordingError) as caught:
        read_ais(written(tmp_path, *rows))
    for word in ("ais.csv", *wanted):
        assert word.lower() in str(caught.value).lower()


def test_files_and_parameters_that_are_invalid(tmp_path):
    with pytest.raises(RecordingError, match="cannot be read"):
        read_ais(tmp_path / "none.csv")
    with pytest.raises(RecordingError, match="mmsi"):
        read_ais(written(tmp_path, "12:00,54,10", head="Time,Latitude,Longitude"))
    packed = tmp_path / "ais.csv.gz"
    path = written(tmp_path, row(0))
    packed.write_bytes(gzip.compress(path.read_bytes()))
    assert repr(read_ais(packed)) == repr(read_ais(path))
    for name in ("min_step_s", "max_speed_mps"):
        for wrong in (0.0, np.nan):
            with pytest.raises(ValueError, match=name):
                read_ais(path, **{name: wrong})


# ------------------------------------------------------------------ the Solent


def test_the_solent_holds_its_vessels():
    ais = recording.load_ais()
    assert len(ais.tracks) == 14
    assert 4500 < sum(map(len, ais.tracks.values())) <= 5015
    for track in ais.tracks.values():
        assert (np.diff(track.time_s) >= 1.0).all()
        assert np.hypot(track.north_m, track.east_m).max() < 40_000.0


def test_reported_velocities_are_those_of_the_positions():
    """Which they would not be with a wrong plane, course or unit."""
    way_m, told_m = [], []
    for track in recording.load_ais().tracks.values():
        dt_s = np.diff(track.time_s)
        told_mps = track.vnorth_mps + 1j * track.veast_mps
        between_m = 0.5 * (told_mps[:-1] + told_mps[1:]) * dt_s
        near = np.isfinite(between_m) & (dt_s < 15.0)
        way_m.append(np.diff(track.north_m + 1j * track.east_m)[near])
        told_m.append(between_m[near])
    way_m, told_m = np.concatenate(way_m), np.concatenate(told_m)
    ratio = np.vdot(told_m, way_m) / np.vdot(told_m, told_m).real
    assert abs(ratio) == pytest.approx(1.0, abs=0.02)
    assert np.angle(ratio) == pytest.approx(0.0, abs=0.02)
