"""Settings as TOML: a file keeps them exactly, and errors name file, section and key."""

import math
import os
import re
import subprocess
import sys

import numpy as np
import pytest

import wakeline as wl
from wakeline.cli import main
from wakeline.recording import radar_names
from wakeline.tracking import DangerLimits, Settings, SettingsError, read_settings
from wakeline.tracking.settings import KEYS


def read(tmp_path, text, name="mine.toml", **kwargs):
    path = tmp_path / name
    path.write_text(text)
    return read_settings(config=path, **kwargs)


def test_every_setting_of_the_engine_has_a_line_that_explains_it():
    engine = {"radar": wl.Radar, "tracker": wl.TrackerConfig, "models": wl.VesselModels}
    for section, kind in engine.items():
        names = {key.replace("_deg", "_rad") for key in KEYS[section]}
        assert names == set(kind().as_dict()), section


def test_explanations_are_those_of_the_parameters():
    text = Settings.default().toml()
    for kind in (wl.Radar, wl.TrackerConfig, wl.VesselModels, DangerLimits):
        for field in kind.fields():
            sentence = field.sentence.replace("_rad`", "_deg`")  # as in files
            assert sentence in text or field.name == "period_s"


def test_limits_of_angles_are_stated_in_degrees():
    stated = re.findall(r"degrees; \S+ to (\S+)\]\n(\w+_deg) =", Settings.default().toml())
    assert len(stated) == 4
    for most, key in stated:
        for factor, fits in ((0.99, True), (1.01, False)):
            values = {"radar": {key: factor * float(most)}}
            if fits:
                Settings.of(values, "here")
            else:
                with pytest.raises(SettingsError, match=f"{key} = .*: {key} must be"):
                    Settings.of(values, "here")


def test_the_defaults_are_those_of_the_engine():
    settings = Settings.default()
    assert settings.tracker == wl.TrackerConfig().as_dict()
    assert settings.models == wl.VesselModels().as_dict()
    assert settings.radar["bearing_std_deg"] == pytest.approx(
        math.degrees(wl.Radar().bearing_std_rad)
    )
    assert settings.period_s is None
    assert settings.make_tracker().radar == wl.Radar()
    assert settings.danger_limits == DangerLimits()


def test_printed_settings_read_back_the_same(tmp_path, capsys):
    assert main(["track", "--print-config"]) == 0
    text = capsys.readouterr().out
    assert read(tmp_path, text) == Settings.default()
    for section, keys in KEYS.items():
        assert f"[{section}]" in text
        for key, about in keys.items():
            assert f"# {about}\n{key} = " in text


def test_a_byte_order_mark_does_not_matter(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_bytes(b"\xef\xbb\xbfrange_std_m = 3.0\n")
    assert read_settings(radar=str(path)).radar["range_std_m"] == 3.0


def test_changed_settings_read_back_the_same(tmp_path, capsys):
    changed = """
        [tracker]
        confirm_hits = 4
        association = "global_nearest"
        clutter_density_per_m2 = 1.25e-9
        [models]
        steady_sojourn_s = 123
        [radar]
        bearing_offset_deg = 1.1
    """
    path = tmp_path / "changed.toml"
    path.write_text(changed)
    assert main(["track", "--config", str(path), "--radar", "joyride", "--print-config"]) == 0
    printed = read(tmp_path, capsys.readouterr().out)
    assert printed == read_settings(path, "joyride")
    assert printed.tracker["confirm_hits"] == 4
    assert printed.tracker["association"] == "global_nearest"
    assert printed.models["steady_sojourn_s"] == 123.0


def test_vessels_win_over_the_models_of_the_configuration(tmp_path, capsys):
    settings = read(tmp_path, "[models]\nsteady_psd_m2s3 = 9.0", vessels="ships")
    assert settings.models == wl.VesselModels.ships().as_dict()
    assert [settings.vessels, Settings.default().vessels] == ["ships", "any"]
    assert read(tmp_path, "[models]\nsteady_psd_m2s3 = 9.0").vessels == "as configured"
    assert main(["track", "--vessels", "ships", "--print-config"]) == 0
    assert read(tmp_path, capsys.readouterr().out) == settings
    with pytest.raises(SettingsError, match="vessels must be any or ships, got 'yachts'"):
        read_settings(vessels="yachts")


def test_radars_that_ship_are_complete_and_win_over_the_configuration(tmp_path):
    assert radar_names() == ["autoferry", "joyride"]
    settings = read(tmp_path, "[radar]\nrange_std_m = 99.0\nperiod_s = 9.0", radar="joyride")
    assert settings.radar == {
        "range_std_m": 6.0,
        "bearing_std_deg": 0.3,
        "extent_std_m": 6.5,
        "period_s": 2.5,
        "max_speed_mps": 25.0,
        "bearing_offset_deg": 0.0,
        "range_offset_m": 0.0,
        "time_offset_s": 0.0,
        "min_range_m": 0.0,
        "max_range_m": 0.0,
        "blind_from_deg": 0.0,
        "blind_to_deg": 0.0,
        "correlation_time_s": 0.0,
    }
    autoferry = read_settings(radar="autoferry").make_tracker().radar
    assert autoferry.bearing_std_rad == math.radians(1.5)
    assert autoferry.period_s == 1.68


@pytest.mark.parametrize("head", ["", "[radar]\n"])
def test_a_radar_of_ones_own(tmp_path, head):
    path = tmp_path / "radar.toml"
    path.write_text(f"{head}range_std_m = 30\nbearing_offset_deg = 2.0\n")
    radar = read_settings(radar=str(path)).make_tracker(4.0).radar
    assert radar.range_std_m == 30.0
    assert radar.bearing_offset_rad == math.radians(2.0)
    assert radar.period_s == 4.0
    assert radar.max_speed_mps == wl.Radar().max_speed_mps


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("[danger]\ncpa_limit_m = -1", "[danger] cpa_limit_m = -1.0"),
        ("[danger]\ntcpa_limit_s = inf", "[danger] tcpa_limit_s = inf"),
        ("[danger]\nalarm_probability = 1.5", "[danger] alarm_probability = 1.5"),
        ("[danger]\nclear_probability = 0.7", "[danger] clear_probability = 0.7"),
        ("[danger]\ncpa = 3", "unknown key cpa in [danger]"),
        ("[tracker]\nconfirm_hitz = 3", "unknown key confirm_hitz in [tracker]"),
        ("[trackers]\nconfirm_hits = 3", "unknown section trackers"),
        ("confirm_hits = 3", "unknown section confirm_hits"),
        ("tracker = 3", "tracker must be a section"),
        ("[tracker]\nconfirm_hits = 3.5", "[tracker] confirm_hits must be a whole number"),
        ("[tracker]\nconfirm_hits = true", "[tracker] confirm_hits must be a whole number"),
        ("[tracker]\ngate_probability = 'high'", "gate_probability must be a number, got 'high'"),
        ("[tracker]\ngate_probability = 1.5", "[tracker] gate_probability = 1.5"),
        ("[tracker]\ngate_probability = nan", "[tracker] gate_probability = nan"),
        ("[tracker]\nassociation = 'best'", "[tracker] association = 'best'"),
        ("[tracker]\nassociation = 1", "association must be a text"),
        ("[tracker]\nconfirm_hits = 6", "confirm_window"),
        ("[tracker]\nmax_tracks = 100000000000000", "[tracker] max_tracks"),
        ("[models]\nsteady_psd_m2s3 = -1.0", "[models] steady_psd_m2s3 = -1.0"),
        ("[models]\nturning_sojourn_s = 0.0", "[models] turning_sojourn_s = 0.0"),
        ("[radar]\nbearing_std_deg = -1", "[radar] bearing_std_deg = -1.0"),
        ("[radar]\nperiod_s = -2.5", "[radar] period_s = -2.5"),
        ("[radar]\nrange_std_m = inf", "[radar] range_std_m = inf"),
        (f"[radar]\nrange_std_m = 1{400 * '0'}", "[radar] range_std_m must be below 1.79"),
        (f"[radar]\nrange_std_m = 1{5000 * '0'}", "not TOML"),
        ("[models]\ncruising_probability = 2.0", "[models] cruising_probability = 2.0"),
        ("[radar\n", "not TOML"),
        (f"a = {5000 * '['}", "not TOML"),
        (f"[radar]\nrange_std_m{5 * '.a'} = 1", "range_std_m must be a number, got {'a': "),
        (f"[radar]\nrange_std_m{50_000 * '.a'} = 1", "too many parts: range_std_m.a"),
        (f"[{50_000 * 'a.'}b]", "too many parts: a.a"),
        ("x = {" + 50_000 * '"a" . ' + "b = 1}", 'too many parts: "a" . "a"'),
        (f"#{2**20 * '-'}", "too long for settings"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, text, wanted):
    with pytest.raises(SettingsError) as caught:
        read(tmp_path, text)
    assert wanted in str(caught.value)
    assert "mine.toml" in str(caught.value)


def test_objects_of_the_engine_are_settings_too():
    radar = wl.Radar(range_std_m=7.0, bearing_std_rad=math.radians(0.7), period_s=2.0)
    config = wl.TrackerConfig(confirm_hits=4)
    settings = read_settings(config, radar, wl.VesselModels.ships())
    tracker = settings.make_tracker()
    assert (tracker.radar, tracker.config) == (radar, config)
    assert settings.vessels == "ships"
    assert settings.period_s == 2.0
    assert read_settings(settings) == settings


def test_what_a_recording_knows_of_its_radar_holds_until_the_settings_differ():
    known = {"range_std_m": 4.0, "bearing_std_deg": 0.2}
    assert Settings.default().knowing(known).radar == Settings.default().radar | known
    other = read_settings(radar="joyride")
    assert other.knowing(known) == other
    assert Settings.default().knowing({}) == Settings.default()


def test_no_vessel_need_be_taken_for_a_ship(tmp_path):
    settings = read(tmp_path, "[models]\ncruising_probability = 0")
    assert settings.models["cruising_probability"] == 0.0


def test_a_radar_that_does_not_exist(capsys):
    assert main(["track", "--radar", "nonesuch", "--print-config"]) == 2
    assert "got 'nonesuch'" in capsys.readouterr().err


def test_a_configuration_that_does_not_exist(tmp_path, capsys):
    assert main(["track", "--config", str(tmp_path / "no.toml"), "--print-config"]) == 2
    assert "no.toml: No such file or directory" in capsys.readouterr().err


def test_a_radar_file_has_keys_of_the_radar_alone(tmp_path):
    full = tmp_path / "full.toml"
    full.write_text("[radar]\nrange_std_m = 12.0\n[tracker]\nconfirm_hits = 3\n")
    with pytest.raises(SettingsError, match=r"full.toml: a radar file .* got radar, tracker"):
        read_settings(radar=full)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("[radar]\nrange_std_m = 12.0\n", "radar of mine.toml, period"),
        ("[tracker]\nconfirm_hits = 3\n", "radar by default, period"),
    ],
)
def test_whose_radar_holds_is_reported(tmp_path, capsys, text, wanted):
    (tmp_path / "mine.toml").write_text(text)
    plots = tmp_path / "plots.csv"
    plots.write_text("time_s,north_m,east_m\n")
    files = [str(plots), "--config", str(tmp_path / "mine.toml"), "--out", str(tmp_path / "out")]
    assert main(["track", *files]) == 0
    assert wanted in capsys.readouterr().out


LONG = 100_000 * "q"


@pytest.mark.parametrize(
    "text",
    [
        f"{LONG} = 1",
        f"[{LONG}]\n[{LONG}]\n",
        f"[tracker]\n{LONG} = 1",
        f"[tracker]\nassociation = '{LONG}'",
        f"[tracker]\nmax_tracks = '{LONG}'",
        f"[[zone]]\n{LONG} = 1",
        f"[[zone]]\nname = 'a'\noutline_m = '{LONG}'",
        f"zone = '{LONG}'",
    ],
)
def test_messages_quote_little(tmp_path, text):
    with pytest.raises(SettingsError) as caught:
        read(tmp_path, text)
    assert "mine.toml" in str(caught.value)
    assert 81 * "q" not in str(caught.value)
    with pytest.raises(SettingsError) as caught:
        read_settings(vessels=LONG)
    assert 81 * "q" not in str(caught.value)


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="no such device")  # noqa: PTH110
@pytest.mark.parametrize("arguments", [["--config"], ["--radar"], [], ["--method", "strobe"]])
def test_a_device_without_end_is_not_read_for_ever(tmp_path, capsys, arguments):
    assert main(["track", "--out", str(tmp_path), *arguments, "/dev/zero"]) == 2
    assert capsys.readouterr().err.startswith("wakeline: /dev/zero")


EXTREMES = (1.7e308, 1e30, 1e12, 1e6, 1e-6, 1e-12, 1e-300, 0.0, -1.0)


@pytest.mark.parametrize("section", ["radar", "tracker", "models"])
def test_settings_at_extremes_are_rejected_or_give_finite_tracks(section):
    kinds = {"radar": wl.Radar, "tracker": wl.TrackerConfig, "models": wl.VesselModels}
    bearing_rad = np.array([0.3, -1.0])
    rejected = 0
    for field in kinds[section].fields():
        for value in EXTREMES if field.type is float else ():
            try:
                given = {name: kind() for name, kind in kinds.items()}
                given[section] = kinds[section](**{field.name: value})
            except ValueError as error:
                assert str(error).startswith(field.name)  # noqa: PT017
                rejected += 1
                continue
            tracker = wl.Tracker(given["radar"], given["tracker"], given["models"])
            period_s = given["radar"].period_s
            for k in range(8):
                range_m = np.array([2000.0, 3000.0]) + 10.0 * min(period_s, 60.0) * k
                tracker.process(k * period_s, range_m=range_m, bearing_rad=bearing_rad)
                tracks = tracker.tracks(tentative=True)
                assert np.isfinite(tracks.mean).all(), (field.name, value)
                assert np.isfinite(tracks.covariance).all(), (field.name, value)
    assert rejected > 4


def test_every_setting_has_a_range():
    for kind in (wl.Radar, wl.TrackerConfig, wl.VesselModels, wl.StrobeTrackerConfig, DangerLimits):
        for field in kind.fields():
            for value in (1.7e308, -1.7e308, math.nan, math.inf) if field.type is float else ():
                with pytest.raises(ValueError, match=field.name):
                    kind(**{field.name: value})
            for value in (2**31 - 1, -1) if field.type is int else ():
                with pytest.raises(ValueError, match=field.name):
                    kind(**{field.name: value})


def memory_of(program):
    """Octets that the last line of a program takes."""
    *before, last = program
    page = "int(open('/proc/self/statm').read().split()[1]) * 4096"
    text = "\n".join([*before, f"before = {page}", last, f"print({page} - before)"])
    return int(subprocess.check_output([sys.executable, "-c", text], text=True))


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="Linux")  # noqa: PTH110
@pytest.mark.parametrize(
    ("method", "text"),
    [
        ("plots", "[tracker]\nmax_tracks = 30000"),
        ("plots", "[tracker]\nmax_plots = 1000000"),
        ("strobe", "[strobes]\nmax_tracks = 10000"),
        ("strobe", "[strobes]\nmax_sweep_cells = 16384\nmax_strobe_sweeps = 8192"),
    ],
)
def test_the_memory_of_a_tracker_is_said(tmp_path, method, text):
    settings = read(tmp_path, text)
    make = "make_tracker" if method == "plots" else "make_strobe_tracker"
    taken = memory_of(
        [
            "from wakeline.tracking import read_settings",
            f"settings = read_settings({str(tmp_path / 'mine.toml')!r})",
            f"tracker = settings.{make}(2.5)",
        ]
    )
    assert settings.memory_octets(method) == pytest.approx(taken, rel=0.3)
    notes = settings.memory_notes(method)
    assert bool(notes) == (settings.memory_octets(method) >= 100e6)
    assert all(f"{settings.memory_octets(method) / 1e6:.0f} MB" in note for note in notes)
    assert Settings.default().memory_notes(method) == []
