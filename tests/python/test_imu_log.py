"""Logs of an IMU: the file, the solution by eight states, and the command."""

import csv
import dataclasses
import json

import numpy as np
import pytest

import wakeline as wl
from wakeline import own_ship, recording
from wakeline.cli import main
from wakeline.own_ship.imu import averaged, of_steps
from wakeline.recording import RecordingError, read_imu
from wakeline.scenario import USV_EXAMPLE

HEAD = "time_s,forward_mps2,starboard_mps2,yaw_rate_deg_s,lat_deg,lon_deg,heading_deg"
TRUTH = USV_EXAMPLE.voyage
DAY_S = 1620086400.0  # 2021-05-04
ORIGIN = wl.LocalPlane(latitude_rad=np.deg2rad(60.0), longitude_rad=np.deg2rad(29.0))


@pytest.fixture(scope="module")
def log():
    return recording.load_imu()


@pytest.fixture(scope="module")
def track(log):
    (leg,) = own_ship.navigate_log(log).legs
    return leg.track


def written(tmp_path, *rows, head=HEAD, name="log.csv"):
    path = tmp_path / name
    path.write_text("\n".join((head, *rows)) + "\n")
    return path


def errors_m(track):
    """Distances from the true positions of the bundled log."""
    where = {
        "latitude_rad": np.radians(track.latitude_deg),
        "longitude_rad": np.radians(track.longitude_deg),
    }
    rows = np.rint(track.time_s / USV_EXAMPLE.period_s).astype(int)
    return np.hypot(*(ORIGIN.position_m(**where) - TRUTH.position_m[rows]).T)


# The file -----------------------------------------------------------------------------------------


def test_the_bundled_log_is_made_by_the_simulator(log, tmp_path):
    USV_EXAMPLE.write_log(tmp_path / "usv.csv")
    again = read_imu(tmp_path / "usv.csv")
    for name, series in log.series.items():
        for one, two in zip(vars(series).values(), vars(again.series[name]).values(), strict=True):
            if one.dtype.kind == "f":
                np.testing.assert_allclose(one, two, rtol=1e-6, atol=1.1e-4)
            else:
                np.testing.assert_array_equal(one, two)


def test_columns_are_read_in_their_units(tmp_path):
    head = "Time [s],accel_forward_mps2,starboard_mps2,turn_rate_rad_s,latitude,longitude,SOG_mps,"
    head += "cog_deg,heading_magnetic_deg,note"
    path = written(tmp_path, "10,0.5,-0.25,0.1,60,185,2,350,-10,x", "11,,,,,,,,,", head=head)
    log = read_imu(path, variation_deg=5.0)
    assert log.imu.time_s == [10.0]
    assert (log.imu.forward_mps2, log.imu.starboard_mps2) == (0.5, -0.25)
    assert log.imu.yaw_rate_rad_s == [0.1]
    assert (log.fixes.latitude_deg, log.fixes.longitude_deg) == (60.0, -175.0)
    assert log.ground.speed_mps == [2.0]
    np.testing.assert_allclose(log.ground.course_rad, np.deg2rad(350))
    np.testing.assert_allclose(log.compass.heading_rad, np.deg2rad(355))
    assert len(log.heading) == 0
    assert log.imu.line == [2]


@pytest.mark.parametrize(
    ("rows", "head", "line", "column"),
    [
        (["1,0,0,0,60,29,0"], HEAD.replace("starboard_mps2", "y"), 1, "starboard_mps2"),
        (["1,0,0,0,60,29,0"], HEAD.replace("yaw_rate_deg_s", "z"), 1, "yaw_rate_deg_s"),
        (["1,0,0,0,60,29,0", "0.5,0,0,0,,,"], HEAD, 3, "time_s"),
        (["1,0,0,0,60,29,0", "2,980,0,0,,,"], HEAD, 3, "forward_mps2"),
        (["1,0,0,0,60,29,0", "2,0,0,x,,,"], HEAD, 3, "yaw_rate_deg_s"),
        (["1,0,0,0,91,29,0"], HEAD, 2, "lat_deg"),
    ],
)
def test_an_error_names_line_and_column(tmp_path, rows, head, line, column):
    with pytest.raises(RecordingError) as error:
        read_imu(written(tmp_path, *rows, head=head))
    assert (error.value.line, error.value.column) == (line, column)


def test_a_log_without_an_imu_or_a_position_is_rejected(tmp_path):
    with pytest.raises(RecordingError, match="IMU"):
        read_imu(written(tmp_path, "1,,,,60,29,0"))
    with pytest.raises(RecordingError, match="position"):
        read_imu(written(tmp_path, "1,0,0,0,,,"))


# With an NMEA log beside --------------------------------------------------------------------------


def sentence(body):
    return f"${body}*{np.bitwise_xor.reduce(np.frombuffer(body.encode(), dtype=np.uint8)):02X}\n"


def dmm(degrees, digits):
    whole = int(degrees)
    return f"{whole:0{digits}d}{60 * (degrees - whole):09.6f}"


def split(log, folder):
    """The same log as an IMU CSV and NMEA sentences, on another day."""
    imu, text = log.imu, []
    places = zip(log.fixes.latitude_deg, log.fixes.longitude_deg, strict=True)
    fixes = dict(zip(log.fixes.time_s, places, strict=True))
    heading = dict(zip(log.heading.time_s, log.heading.heading_rad, strict=True))
    for time_s in sorted(heading):
        clock = f"{int(time_s) // 3600:02d}{int(time_s) // 60 % 60:02d}{int(time_s) % 60:02d}.00"
        place = ",,,"
        if time_s in fixes:
            place = f"{dmm(fixes[time_s][0], 2)},N,{dmm(fixes[time_s][1], 3)},E"
        valid = "A" if time_s in fixes else "V"
        text.append(sentence(f"GPRMC,{clock},{valid},{place},,,040521,,,A"))
        text.append(sentence(f"HEHDT,{np.degrees(heading[time_s]):.2f},T"))
    (folder / "log.nmea").write_text("".join(text))
    with (folder / "imu.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(HEAD.split(",")[:4])
        turn_deg_s = np.degrees(imu.yaw_rate_rad_s)
        columns = (imu.time_s + DAY_S, imu.forward_mps2, imu.starboard_mps2, turn_deg_s)
        writer.writerows(zip(*columns, strict=True))
    return folder / "imu.csv", folder / "log.nmea"


def test_an_nmea_log_beside_gives_the_same_solution(log, track, tmp_path):
    both = read_imu(*split(log, tmp_path))
    assert (len(both.imu), len(both.fixes.sound())) == (len(log.imu), len(log.fixes))
    (leg,) = own_ship.navigate_log(both).legs
    times, place = leg.track.time_s - DAY_S, leg.track.position_m
    off_m = [np.interp(track.time_s, times, place[:, k]) - track.position_m[:, k] for k in (0, 1)]
    assert np.abs(off_m)[:, 200:].max() < 1.0  # headings without times are spread between others


def test_logs_of_other_times_are_rejected(log, tmp_path):
    imu, nmea = split(log, tmp_path)
    nmea.write_text(nmea.read_text().replace(",040521,", ",050521,"))
    text = "".join(sentence(line[1:].split("*")[0]) for line in nmea.read_text().splitlines())
    nmea.write_text(text)
    with pytest.raises(RecordingError, match="times are not those"):
        read_imu(imu, nmea)


# The solution -------------------------------------------------------------------------------------


def test_the_solution_is_better_than_the_fixes_and_finds_the_biases(track):
    settled = track.time_s > 60.0
    inside = settled & ((track.time_s < 150.0) | (track.time_s > 215.0))
    assert np.sqrt(np.mean(errors_m(track)[inside] ** 2)) < 0.5 * np.hypot(2.5, 2.5)
    error = track.imu_bias[-1] - USV_EXAMPLE.imu_bias
    assert np.all(np.abs(error) < 4 * track.imu_bias_std[-1])
    assert np.all(track.imu_bias_std[-1] < [0.005, 0.005, np.deg2rad(0.02)])


def test_without_satellites_it_coasts_within_its_covariance(track):
    hidden = (track.time_s > 150.0) & (track.time_s < 210.5)
    assert (track.status[track.time_s == 205.0] == "coasting").all()
    error, std = errors_m(track), np.sqrt(np.trace(track.position_m2, axis1=1, axis2=2))
    assert np.all(error[hidden] < 3 * std[hidden])
    assert error[hidden].max() < 15.0


def test_a_faster_log_is_averaged_to_tenths_of_a_second(log):
    imu = log.imu
    fine = type(imu)(
        time_s=np.arange(1, 1001) / 100.0,
        valid=np.ones(1000, dtype=bool),
        sentence=np.full(1000, "CSV"),
        line=np.arange(1000),
        forward_mps2=np.arange(1000.0),
        starboard_mps2=np.zeros(1000),
        yaw_rate_rad_s=np.ones(1000),
    )
    time_s, mean = averaged(fine)
    assert np.all(np.diff(time_s)[:-1] > 0.0999)
    np.testing.assert_allclose(mean[:, 2], 1.0)
    np.testing.assert_allclose(mean[1:-1, 0], 100.0 * time_s[1:-1] - 5.5)  # the middle of each step
    same_s, same = averaged(imu)
    np.testing.assert_array_equal(same_s, imu.time_s)
    np.testing.assert_array_equal(same[:, 0], imu.forward_mps2)


def test_a_step_has_the_reading_that_ends_it_or_after_it():
    imu_s, imu = np.array([1.0, 2.0, 3.0, 9.0]), np.arange(12.0).reshape(4, 3)
    found = of_steps(np.array([1.0, 1.4, 2.0, 5.0, 9.0, 9.5]), imu_s, imu)
    np.testing.assert_array_equal(found[:3], imu[[0, 1, 1]])
    assert np.isnan(found[3]).all()  # 4 s before the reading
    np.testing.assert_array_equal(found[4], imu[3])
    assert np.isnan(found[5]).all()


def test_without_a_heading_the_solution_finds_it(log):
    blind = dataclasses.replace(log, heading=log.heading.rows(slice(0, 0)))
    (leg,) = own_ship.navigate_log(blind).legs
    rows = np.rint(leg.track.time_s / USV_EXAMPLE.period_s).astype(int)
    error = np.abs(wl.wrap_angle(leg.track.heading_rad - TRUTH.heading_rad[rows]))
    assert np.all(error[-200:] < 3 * leg.track.heading_std_rad[-200:])
    assert error[-200:].max() < np.deg2rad(15.0)


# The command --------------------------------------------------------------------------------------


def test_the_command_writes_the_solution_with_the_biases(log, tmp_path, capsys, no_pictures):
    USV_EXAMPLE.write_log(tmp_path / "usv.csv")
    out, scores = tmp_path / "out", tmp_path / "s.json"
    command = ["navigate", str(tmp_path / "usv.csv"), "--out", str(out), "--json", str(scores)]
    assert main(command) == 0
    with (out / "own.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert float(rows[-1]["forward_bias_mps2"]) == pytest.approx(0.03, abs=0.005)
    assert float(rows[-1]["gyro_bias_deg_s"]) == pytest.approx(0.28, abs=0.02)
    assert rows[-1]["status"] == "ok"
    assert "biases of the IMU" in capsys.readouterr().out
    assert {row["estimator"] for row in json.loads(scores.read_text())["rows"]} == {
        "navigator",
        "constant_velocity",
    }


def test_the_command_takes_an_nmea_log_beside(log, tmp_path, capsys, no_pictures):
    imu, nmea = split(log, tmp_path)
    assert main(["navigate", str(imu), "--nmea", str(nmea), "--out", str(tmp_path / "out")]) == 0
    assert main(["navigate", str(nmea), "--nmea", str(nmea), "--out", str(tmp_path / "out")]) == 2
    assert "--nmea" in capsys.readouterr().err
    assert main(["navigate", str(imu), "--fix-std", "0"]) == 2
    assert "--fix-std" in capsys.readouterr().err


def test_pictures_show_the_biases(log):
    pytest.importorskip("matplotlib")
    from wakeline import plot

    (leg,) = own_ship.navigate_log(log).legs
    labels = [ax.get_ylabel() for ax in plot.own_time_figure(leg).axes]
    assert labels[-2:] == ["bias (m/s²)", "bias (°/s)"]
