"""Numbers of another unit, and azimuths from another origin, are noticed or taken as asked."""

import numpy as np
import pytest

from wakeline import recording
from wakeline.recording import RecordingError, read_plots

PERIOD_S = 2.5
SCANS = 40


def vessels(time_s):
    """North and east of two vessels."""
    return np.array([[1500 - 6 * time_s, 500 + 2 * time_s], [-800 + 3 * time_s, 2000 - 7 * time_s]])


def heading_deg(time_s):
    return (300.0 + 2.0 * time_s) % 360.0


def written(
    tmp_path, *, from_bow=False, ranges=("range_m", 1.0), bearings=("bearing_deg", 1.0), times=1.0
):
    """Files of plots and of own ship, which turns on the spot."""
    lines = [f"time_s,scan,{ranges[0]},{bearings[0]}"]
    for scan in range(SCANS):
        t = PERIOD_S * scan
        for north, east in vessels(t):
            bearing = np.degrees(np.arctan2(east, north)) - (heading_deg(t) if from_bow else 0.0)
            distance = np.hypot(north, east) * ranges[1]
            lines.append(f"{t * times},{scan},{distance:.6f},{bearing % 360 * bearings[1]:.8f}")
    own = ["time_s,north_m,east_m,heading_deg"]
    own += [f"{t},0,0,{heading_deg(t):.3f}" for t in range(-5, int(PERIOD_S * SCANS) + 5)]
    files = tmp_path / "plots.csv", tmp_path / "own.csv"
    for file, rows in zip(files, (lines, own), strict=True):
        file.write_text("\n".join([*rows, ""]))
    return files


def places_m(read):
    return np.array([[scan.north_m, scan.east_m] for scan in read.episodes[0].scans])


def test_bearings_from_the_bow_are_turned_by_the_heading(tmp_path):
    plots, own = written(tmp_path, from_bow=True)
    read = read_plots(plots, own, azimuth="bow")
    true_m = np.array([vessels(PERIOD_S * k).T for k in range(SCANS)])
    np.testing.assert_allclose(places_m(read), true_m, atol=0.1)
    scan = read.episodes[0].scans[7]
    np.testing.assert_allclose(scan.bearing_rad, np.arctan2(scan.east_m, scan.north_m))
    assert read.notes == []


@pytest.mark.parametrize("from_bow", [True, False])
@pytest.mark.parametrize("azimuth", ["north", "bow"])
def test_azimuths_that_look_like_those_from_the_other_origin_are_noted(tmp_path, from_bow, azimuth):
    read = read_plots(*written(tmp_path, from_bow=from_bow), azimuth=azimuth)
    right = "bow" if from_bow else "north"
    noted = [note for note in read.notes if f"--azimuth {right}" in note]
    assert len(noted) == (azimuth != right)


def test_azimuths_from_the_bow_need_a_heading_and_bearings(tmp_path):
    plots, own = written(tmp_path)
    with pytest.raises(ValueError, match="own ship's heading"):
        read_plots(plots, azimuth="bow")
    with pytest.raises(ValueError, match="north, bow, got 'stern'"):
        read_plots(plots, own, azimuth="stern")
    own.write_text("time_s,north_m,east_m\n0,0,0\n200,0,0\n")
    with pytest.raises(RecordingError, match="there is no heading"):
        read_plots(plots, own, azimuth="bow", own_gap_s=300.0)
    plots.write_text("time_s,north_m,east_m\n0,1,1\n")
    with pytest.raises(ValueError, match="need bearings"):
        read_plots(plots, own, azimuth="bow", own_gap_s=300.0)


@pytest.mark.parametrize(
    ("unit", "word"),
    [
        ({"bearings": ("bearing_deg", np.pi / 180)}, "bearing_rad"),
        ({"bearings": ("Azimuth [deg]", np.pi / 180)}, "bearing_rad"),
        ({"ranges": ("range_m", 1 / 1852)}, "range_nm"),
        ({"ranges": ("range_nm", 1.0)}, "range_m"),
        ({"times": 1000.0}, "milliseconds"),
    ],
)
def test_numbers_of_another_unit_are_noted(tmp_path, unit, word):
    plots, _ = written(tmp_path, **unit)
    assert any(word in note for note in read_plots(plots).notes)
    right = {"ranges": ("range_nm", 1 / 1852), "bearings": ("bearing_rad", np.pi / 180)}
    for units in ({}, right):
        plots, _ = written(tmp_path, **units)
        assert read_plots(plots).notes == []


def test_degrees_as_radians_are_an_error(tmp_path):
    plots, _ = written(tmp_path, bearings=("bearing_rad", 1.0))
    with pytest.raises(RecordingError, match="radians"):
        read_plots(plots)


def test_another_period_than_that_of_the_log_is_used_and_noted(tmp_path):
    plots, _ = written(tmp_path)
    (note,) = read_plots(plots, period_s=1.25).notes
    assert "1.25 s" in note
    assert "2.5 s" in note
    assert read_plots(plots, period_s=2.45).notes == []


def test_recordings_of_radars_have_no_such_notes():
    for name in recording.names():
        assert recording.load(name).notes == []
