"""`wakeline track` on radar video: sweeps in, tracks and a picture of the screen out."""

import importlib
import json
from dataclasses import replace

import numpy as np
import pytest

from wakeline import plot, scenario
from wakeline.cli import main
from wakeline.extraction import noise_of, read_plots_of_video
from wakeline.extraction.settings import threshold_above
from wakeline.recording import read_tracks, write_video

pytestmark = pytest.mark.usefixtures("no_pictures")

SCANS = 14
PPI = importlib.import_module("wakeline.plot.ppi")  # the name is also that of its function
PERIOD_S = 2.5


def ship(north_m, east_m, vnorth_mps, veast_mps):
    truth = scenario.Truth([north_m, vnorth_mps, east_m, veast_mps])
    return scenario.VideoTarget(truth=truth, length_m=40.0, beam_m=10.0, rcs_m2=10.0, swerling=0)


SHIPS = {
    "off north": ship(2500.0, -60.0, 0.0, 8.0),  # crosses north
    "far": ship(-1500.0, 2200.0, 6.0, 5.0),
}


def simulator(**changes):
    radar = scenario.RadarVideoSimulator(
        sweeps_per_turn=720,
        cells=400,
        cell_m=10.0,
        period_s=PERIOD_S,
        beam_width_rad=np.deg2rad(1.5),
        pulse_length_m=20.0,
        snr_db=12.0,
    )
    return replace(radar, **changes)


@pytest.fixture(scope="module")
def video(tmp_path_factory):
    path = tmp_path_factory.mktemp("video") / "harbour.cat240"
    write_video(path, simulator().turns(SHIPS, SCANS, seed=1))
    return path


def track_of(tracks, name):
    """Rows of the track that is nearest to a ship at the end, and its distances to the truth."""
    truth = SHIPS[name].truth
    last = tracks.time_s == tracks.time_s.max()
    place_m = truth.state_at(tracks.time_s.max())[0, ::2]
    distance_m = np.hypot(*(tracks.state[last][:, ::2] - place_m).T)
    rows = tracks.track_id == tracks.track_id[last][distance_m.argmin()]
    error = tracks.state[rows] - truth.state_at(tracks.time_s[rows])
    return rows, np.hypot(error[:, 0], error[:, 2]), np.hypot(error[:, 1], error[:, 3])


def test_every_ship_has_a_track_from_strobe_to_velocity(video, tmp_path, capsys):
    assert main(["track", str(video), "--out", str(tmp_path), "--json", str(tmp_path / "f")]) == 0
    tracks = read_tracks(tmp_path / "tracks.csv")
    for name in SHIPS:
        rows, position_m, velocity_mps = track_of(tracks, name)
        assert rows.sum() >= SCANS - 5
        assert position_m[-5:].max() < 25.0
        assert velocity_mps[-1] < 2.5
    assert len(tracks.ids()) == len(SHIPS)
    row = json.loads((tmp_path / "f").read_text())["rows"][-1]
    assert row["scans"] in (SCANS, SCANS + 1)
    assert row["tracks"] == len(SHIPS)
    reported = capsys.readouterr().out
    assert "harbour" in reported
    assert "estimated from its echoes" in reported


def test_a_file_may_be_named_by_text(video):
    film = read_plots_of_video(str(video))
    assert film.name == "harbour"
    assert len(film.episodes[0]) in (SCANS, SCANS + 1)


def test_the_screen_is_drawn(video, tmp_path, pictures):
    assert main(["track", str(video), "--out", str(tmp_path)]) == 0
    assert (tmp_path / "ppi.png").read_bytes()[:4] == b"\x89PNG"
    assert (tmp_path / "map.png").stat().st_size > 5000


def test_damage_is_reported_and_what_is_sound_is_tracked(video, tmp_path, capsys):
    octets = bytearray(video.read_bytes())
    octets[len(octets) // 2 : len(octets) // 2 + 50] = bytes(50)
    damaged = tmp_path / "damaged.cat240"
    damaged.write_bytes(octets[:-100])
    assert main(["track", str(damaged), "--out", str(tmp_path)]) == 0
    assert "note:" in capsys.readouterr().out
    assert len(read_tracks(tmp_path / "tracks.csv").ids()) == len(SHIPS)


def test_truth_goes_with_plots(video, tmp_path, capsys):
    assert main(["track", str(video), "--truth", "truth.csv", "--out", str(tmp_path)]) == 2
    assert "truth goes with a file of plots" in capsys.readouterr().err


# Own ship -----------------------------------------------------------------------------------------

OWN = np.array([400.0, 3.0, -900.0, -6.0])  # north, its rate, east, its rate
DAY_S = 86400.0


def own_file(path, own=OWN, begin_s=-2.0, end_s=SCANS * PERIOD_S + 2.0, day_s=0.0):
    """A row per second of a ship on a straight course, with its position at time 0."""
    rows = ["time_s,north_m,east_m"]
    for time_s in np.arange(begin_s, end_s):
        north_m, east_m = own[::2] + time_s * own[1::2]
        rows.append(f"{time_s + day_s},{north_m},{east_m}")
    path.write_text("\n".join(rows) + "\n")
    return path


def tracked(video, folder, *own):
    assert main(["track", str(video), *own, "--out", str(folder)]) == 0
    return read_tracks(folder / "tracks.csv")


def test_own_ship_in_motion_adds_her_place_and_her_velocity(video, tmp_path):
    """Targets have absolute positions and velocities, seen from a moving ship."""
    tracks = tracked(video, tmp_path, "--own", str(own_file(tmp_path / "own.csv")))
    now = tracks.time_s[:, None]
    moved = np.column_stack([OWN[:1] + now * OWN[1], OWN[2:3] + now * OWN[3]])
    moved = np.insert(moved, [1, 2], OWN[1::2], axis=1)
    seen = replace(tracks, state=tracks.state - moved)
    for name in SHIPS:
        rows, position_m, velocity_mps = track_of(seen, name)
        assert rows.sum() >= SCANS - 5
        assert position_m[-5:].max() < 25.0
        assert velocity_mps[-1] < 2.5
    assert len(tracks.ids()) == len(SHIPS)


def test_own_ship_at_rest_shifts_the_tracks(video, tmp_path):
    at = np.array([700.0, 0.0, -300.0, 0.0])
    alone = tracked(video, tmp_path)
    shifted = tracked(video, tmp_path, "--own", str(own_file(tmp_path / "own.csv", at)))
    np.testing.assert_array_equal(shifted.track_id, alone.track_id)
    wanted = np.tile(at, (len(alone), 1))
    np.testing.assert_allclose(shifted.state - alone.state, wanted, atol=0.02)


def test_a_ship_that_comes_towards_own_ship_raises_an_alarm(tmp_path):
    path = tmp_path / "some.cat240"
    ahead = {"ahead": ship(2400.0, 150.0, -12.0, 0.0)}  # relative to own ship
    write_video(path, simulator().turns(ahead, SCANS, seed=5))
    tracks = tracked(path, tmp_path, "--own", str(own_file(tmp_path / "own.csv")))
    assert len(tracks.ids()) == 1
    assert tracks.cpa_m[-1] == pytest.approx(150.0, abs=100.0)
    assert tracks.tcpa_s[-1] + tracks.time_s[-1] == pytest.approx(200.0, rel=0.1)
    assert len((tmp_path / "alarms.csv").read_text().splitlines()) == 2


def test_the_day_of_video_is_that_of_own_ship(video, tmp_path):
    same = tracked(video, tmp_path, "--own", str(own_file(tmp_path / "own.csv")))
    day_s = 18752 * DAY_S
    later = tracked(video, tmp_path, "--own", str(own_file(tmp_path / "o.csv", day_s=day_s)))
    np.testing.assert_allclose(later.time_s - day_s, same.time_s, atol=1e-3)
    np.testing.assert_allclose(later.state, same.state, atol=0.01)


@pytest.mark.parametrize(
    ("changes", "reported"),
    [
        ({"end_s": 20.0}, "own ship is not known at"),
        ({"begin_s": 10.0}, "own ship is not known at"),
        ({"begin_s": 7200.0, "end_s": 7300.0}, "own.csv covers"),
    ],
)
def test_own_ship_must_be_known_at_every_plot(video, tmp_path, changes, reported, capsys):
    own = own_file(tmp_path / "own.csv", **changes)
    assert main(["track", str(video), "--own", str(own), "--out", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert reported in error
    assert "harbour.cat240" in error


def test_a_list_of_scans_without_places_is_no_own_ship(video, tmp_path, capsys):
    own = tmp_path / "scans.csv"
    own.write_text("time_s,scan\n0.0,1\n2.5,2\n")
    assert main(["track", str(video), "--own", str(own), "--out", str(tmp_path)]) == 2
    assert "north_m and east_m" in capsys.readouterr().err


def test_the_screen_shows_what_own_ship_sees(video, tmp_path, monkeypatch, pictures):
    """Plots, strobes and tracks are on the echoes, wherever own ship is."""
    shown = {}

    def keep(video, ax, **layers):
        shown.update(layers)

    monkeypatch.setattr(PPI, "ppi", keep)
    tracked(video, tmp_path, "--own", str(own_file(tmp_path / "own.csv")))
    time_s = shown["tracks"].time_s.max()
    here = shown["tracks"].where(shown["tracks"].time_s == time_s).state[:, ::2]
    for ship in SHIPS.values():
        place_m = ship.truth.state_at(time_s)[0, ::2]
        for layer in (shown["plots"], here, [s.mean(axis=0) for s in shown["strobes"]]):
            assert np.hypot(*(np.asarray(layer) - place_m).T).min() < 50.0


def in_scenarios(path, names):
    head, *rows = path.read_text().splitlines()
    rows = [f"{row},{names[k % len(names)]}" for k, row in enumerate(rows)]
    path.write_text("\n".join([f"{head},scenario", *rows]) + "\n")
    return path


def test_own_ship_of_one_scenario_is_own_ship(video, tmp_path):
    own = in_scenarios(own_file(tmp_path / "own.csv"), ["harbour"])
    named = tracked(video, tmp_path / "named", "--own", str(own))
    own = own_file(tmp_path / "own.csv")
    alone = tracked(video, tmp_path / "alone", "--own", str(own))
    np.testing.assert_array_equal(named.state, alone.state)


def test_own_ship_of_several_scenarios_is_rejected(video, tmp_path, capsys):
    own = in_scenarios(own_file(tmp_path / "own.csv"), ["b", "a", "c"])
    assert main(["track", str(video), "--own", str(own), "--out", str(tmp_path)]) == 2
    assert f"{own}, column scenario: " in (error := capsys.readouterr().err)
    assert "got 3, such as 'a' and 'b'" in error


# Clocks that are set back -------------------------------------------------------------------------


def set_back(turns, k, sweep=0, by_s=3600.0):
    """Turns whose clock is set back before a sweep of turn k."""
    split = [*turns[:k], turns[k][:sweep], turns[k][sweep:], *turns[k + 1 :]]
    parts = [part for part in split if len(part)]
    late = len(parts) - (len(turns) - k)
    return [
        replace(part, time_s=part.time_s + 7200.0 - by_s * (number >= late))
        for number, part in enumerate(parts)
    ]


@pytest.mark.parametrize("sweep", [0, 360])
@pytest.mark.parametrize("by_s", [6.0, 3600.0])
def test_after_a_clock_was_set_back_all_is_tracked_from_a_fresh_start(
    tmp_path, capsys, sweep, by_s
):
    turns = list(simulator().turns(SHIPS, 2 * SCANS, seed=4))
    tracks = tracks_of(set_back(turns, SCANS, sweep, by_s), tmp_path)
    reported = capsys.readouterr().out
    assert "the clock is set back 1 time, first after 723" in reported
    assert "period 2.5 s" in reported
    assert "could not take" not in reported
    for name, begin_s in (("part-1", 7200.0), ("part-2", 7200.0 + SCANS * PERIOD_S - by_s)):
        part = tracks.where(tracks.scenario == name)
        assert len(part.ids()) == len(SHIPS)
        assert part.time_s.min() > begin_s
        assert part.time_s.max() == pytest.approx(begin_s + SCANS * PERIOD_S, abs=1.5 * PERIOD_S)
        assert len(part) >= len(SHIPS) * (SCANS - 6)


def test_two_turns_of_a_clock_set_back_have_no_period(tmp_path, capsys):
    turns = list(simulator().turns(SHIPS, 2, seed=4))
    assert len(tracks_of(set_back(turns, 1), tmp_path)) == 0
    assert "period by default" in capsys.readouterr().out


def test_the_screen_shows_the_last_part(tmp_path, monkeypatch, pictures):
    drawn = {}
    monkeypatch.setattr(PPI, "ppi", lambda shown, axes, **kinds: drawn.update(kinds, video=shown))
    monkeypatch.setattr(plot, "save", lambda figure, file: file.write_bytes(b""))
    turns = list(simulator().turns(SHIPS, 2 * SCANS, seed=4))
    tracks_of(set_back(turns, SCANS), tmp_path)
    assert drawn["tracks"].time_s.max() == pytest.approx(drawn["video"].time_s[-1])
    assert set(drawn["tracks"].scenario) == {"part-2"}


# Recordings of all kinds --------------------------------------------------------------------------


def test_noise_alone_gives_no_track(tmp_path):
    path = tmp_path / "noise.cat240"
    write_video(path, simulator().turns({}, 8, seed=2))
    assert main(["track", str(path), "--out", str(tmp_path)]) == 0
    assert len(read_tracks(tmp_path / "tracks.csv")) == 0


@pytest.mark.parametrize("pieces", range(1, 12))
def test_small_pictures_have_noise_too(pieces):
    amplitude = np.random.default_rng(pieces).rayleigh(20.0, (pieces, 32)).astype(np.uint8)
    assert 5.0 < noise_of(amplitude).std < 30.0


NOISES = {
    "linear": lambda rng, shape: rng.rayleigh(20.0, shape),
    "of powers": lambda rng, shape: rng.exponential(12.0, shape),
    "sea": lambda rng, shape: rng.gamma(2.0, 6.0, shape),
    "normal": lambda rng, shape: rng.normal(60.0, 12.0, shape),
    "logarithmic": lambda rng, shape: 120.0 + 20.0 * np.log10(rng.exponential(1.0, shape)),
}


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("share", [1e-2, 1e-3])
def test_a_threshold_is_exceeded_by_the_wanted_share_of_any_noise(noise, share):
    rng = np.random.default_rng(5)
    amplitude = NOISES[noise](rng, (720, 1024)).clip(0.0, 255.0).astype(np.uint8)
    threshold = threshold_above(noise_of(amplitude), share, above_db=0.0)
    assert 0.4 * share < np.mean(amplitude >= threshold) < 2.0 * share


@pytest.mark.parametrize("receiver", ["linear", "logarithmic"])
def test_the_kind_of_receiver_is_seen_in_the_noise(tmp_path, receiver):
    radar = simulator(receiver=receiver, noise_rms=12.0 if receiver == "linear" else 40.0)
    turns = list(radar.turns(SHIPS, SCANS, seed=3))
    assert (noise_of(turns[0].amplitude).skewness < 0.2) == (receiver == "logarithmic")
    path = tmp_path / "some.cat240"
    write_video(path, turns)
    assert main(["track", str(path), "--out", str(tmp_path)]) == 0
    assert len(read_tracks(tmp_path / "tracks.csv").ids()) == len(SHIPS)


@pytest.mark.parametrize("level", [0, 255])
def test_dark_and_saturated_pictures_give_nothing(tmp_path, level):
    turns = [
        replace(turn, amplitude=np.full_like(turn.amplitude, level))
        for turn in simulator().turns({}, 3, seed=0)
    ]
    path = tmp_path / "flat.cat240"
    write_video(path, turns)
    assert main(["track", str(path), "--out", str(tmp_path)]) == 0
    assert len(read_tracks(tmp_path / "tracks.csv")) == 0


def begun_late(turns):
    return [turns[0][500:], *turns[1:]]


def ended_early(turns):
    return [*turns[:-1], turns[-1][:150]]


def begun_and_ended_in_between(turns):
    return [turns[0][700:], *turns[1:-1], turns[-1][:30]]


def in_quarters(turns):
    """As of a radar whose turns are too large to be kept as one block."""
    return [turn[k : k + 180] for turn in turns for k in range(0, 720, 180)]


def mirrored(turns):
    """As of an antenna that turns anticlockwise; the ships are where they were."""
    return [
        replace(turn, amplitude=turn.amplitude[::-1], azimuth_rad=turn.azimuth_rad[::-1])
        for turn in turns
    ]


def coarsely_counted(turns):
    """Azimuths in 1/800 of a turn, 720 sweeps: steps of one and of two."""
    step_rad = 2 * np.pi / 800
    return [
        replace(turn, azimuth_rad=np.floor(turn.azimuth_rad / step_rad) * step_rad)
        for turn in turns
    ]


def in_16_bits_from_the_sixth_turn(turns):
    return [
        turn if k < 5 else replace(turn, amplitude=turn.amplitude.astype(np.uint16) * 257)
        for k, turn in enumerate(turns)
    ]


def with_many_cells(turns):
    more = np.random.default_rng(1).rayleigh(5.7, (len(turns[0]), 4700)).astype(np.uint8)
    return [replace(turn, amplitude=np.hstack([turn.amplitude, more])) for turn in turns]


def with_a_false_time(turns):
    time_s = turns[6].time_s.copy()
    time_s[400] += 600.0
    return [*turns[:6], replace(turns[6], time_s=time_s), *turns[7:]]


def with_a_false_azimuth_in_every_turn(turns):
    azimuth = [turn.azimuth_rad.copy() for turn in turns]
    for turn in azimuth:
        turn[300] = turn[30]
    return [replace(t, azimuth_rad=a) for t, a in zip(turns, azimuth, strict=True)]


def of_a_sender_that_tells_narrow_sweeps(turns):
    return [replace(turn, azimuth_width_rad=turn.azimuth_width_rad / 20) for turn in turns]


def with_cells_that_come_and_go(turns):
    """A sender that leaves the last cell out every tenth sweep on."""
    return [
        replace(part, amplitude=part.amplitude[:, : 400 - k % 2])
        for turn in turns
        for k, part in enumerate(turn[first : first + 10] for first in range(0, 720, 10))
    ]


@pytest.mark.parametrize(
    "change",
    [
        with_cells_that_come_and_go,
        with_a_false_time,
        with_a_false_azimuth_in_every_turn,
        of_a_sender_that_tells_narrow_sweeps,
        begun_late,
        ended_early,
        begun_and_ended_in_between,
        in_quarters,
        mirrored,
        coarsely_counted,
        in_16_bits_from_the_sixth_turn,
        with_many_cells,
    ],
)
def test_recordings_as_they_are(tmp_path, change):
    path = tmp_path / "some.cat240"
    write_video(path, change(list(simulator().turns(SHIPS, SCANS, seed=4))))
    assert main(["track", str(path), "--out", str(tmp_path)]) == 0
    tracks = read_tracks(tmp_path / "tracks.csv")
    assert len(tracks.ids()) == len(SHIPS)
    assert (tracks.status == "confirmed").all()
    for name in SHIPS:  # a mirrored turn shows ships by up to a period of 2.5 s too early or late
        assert track_of(tracks, name)[1][-3:].max() < 30.0


def tracks_of(turns, folder, *options):
    path = folder / "some.cat240"
    write_video(path, turns)
    assert main(["track", str(path), "--out", str(folder), *options]) == 0
    return read_tracks(folder / "tracks.csv")


@pytest.mark.parametrize("sector_deg", [(90.0, 180.0), (-60.0, 60.0), (20.0, 320.0)])
def test_a_radar_that_shows_a_sector_gives_a_scan_a_turn(tmp_path, sector_deg):
    """Any sector: across north, and so wide that the beam seems to continue from its end."""
    middle_rad = np.deg2rad(np.mean(sector_deg))
    sight = np.array([np.cos(middle_rad), np.sin(middle_rad)])
    truth = scenario.Truth(np.array([*(2000.0 * sight), *(6.0 * sight)])[[0, 2, 1, 3]])
    target = scenario.VideoTarget(truth=truth, length_m=40.0, beam_m=10.0, rcs_m2=10.0, swerling=0)
    radar = simulator(sector_rad=tuple(np.deg2rad(sector_deg)))
    tracks = tracks_of(radar.turns({"ship": target}, SCANS, seed=2), tmp_path)
    assert len(tracks.ids()) == 1
    assert np.diff(np.unique(tracks.time_s)) == pytest.approx(PERIOD_S, abs=0.1)
    assert len(tracks) >= SCANS - 5


def test_a_short_range_scale_leaves_no_blind_ring(tmp_path):
    """The whole sweep is shorter than the windows that fit ships at sea."""
    radar = simulator(cells=512, cell_m=0.28, pulse_length_m=1.0)
    boat = scenario.VideoTarget(
        truth=scenario.Truth([75.0, 0.5, 60.0, 0.3]),
        length_m=6.0,
        beam_m=2.0,
        rcs_m2=5.0,
        swerling=0,
    )
    tracks = tracks_of(radar.turns({"boat": boat}, SCANS, seed=2), tmp_path)
    last = tracks.state[tracks.time_s == tracks.time_s.max()][:, [0, 2]]
    place_m = boat.truth.state_at(tracks.time_s.max())[0, ::2]
    assert np.hypot(*(last - place_m).T).min() < 5.0


def test_a_change_of_the_range_scale_keeps_the_ships(tmp_path):
    """Windows are lengths of water, not numbers of cells."""
    ship = scenario.VideoTarget(
        truth=scenario.Truth([1200.0, -4.0, 300.0, -1.0]),
        length_m=200.0,
        beam_m=30.0,
        rcs_m2=1e3,
        swerling=0,
    )
    wide = simulator(cell_m=24.0, pulse_length_m=24.0).turns({"ship": ship}, 5, seed=2)
    near = simulator(cell_m=4.0).turns({"ship": ship}, 5 + SCANS, seed=2)
    tracks = tracks_of([*wide, *list(near)[5:]], tmp_path)
    shown_s = tracks.time_s[tracks.status == "confirmed"]
    assert np.unique(shown_s[shown_s > 8 * PERIOD_S]).size >= SCANS - 4


def test_video_without_a_time_of_day_is_tracked_by_the_period(video, tmp_path, capsys):
    untimed = tmp_path / "untimed.cat240"
    untimed.write_bytes(without_times(video.read_bytes()))
    command = ["track", str(untimed), "--out", str(tmp_path)]
    assert main(command) != 0
    assert "period_s" in capsys.readouterr().err
    config = tmp_path / "some.toml"
    config.write_text(f"[radar]\nperiod_s = {PERIOD_S}\n")
    assert main([*command, "--config", str(config)]) == 0
    assert len(read_tracks(tmp_path / "tracks.csv").ids()) == len(SHIPS)


def without_times(octets):
    """The same blocks without item I240/140, the last of each record."""
    blocks, at = [], 0
    while at < len(octets):
        length = int.from_bytes(octets[at + 1 : at + 3], "big")
        head = bytearray(octets[at : at + length - 3])
        head[1:3] = (length - 3).to_bytes(2, "big")
        head[4] &= ~0x08
        blocks.append(bytes(head))
        at += length
    return b"".join(blocks)


def test_the_screen_shows_tracks_at_their_echoes_under_an_offset(
    video, tmp_path, monkeypatch, pictures
):
    drawn = {}
    monkeypatch.setattr(PPI, "ppi", lambda shown, axes, **kinds: drawn.update(kinds, video=shown))
    monkeypatch.setattr(plot, "save", lambda figure, file: file.write_bytes(b""))
    config = tmp_path / "some.toml"
    config.write_text("[radar]\nbearing_offset_deg = 10.0\n")
    tracked(video, tmp_path, "--config", str(config))
    last = drawn["tracks"].time_s == drawn["tracks"].time_s.max()
    for place_m in drawn["tracks"].state[last][:, [0, 2]]:
        assert np.hypot(*(drawn["plots"] - place_m).T).min() < 40.0
    brightest = np.unravel_index(drawn["video"].amplitude.argmax(), drawn["video"].amplitude.shape)
    at_m = drawn["video"].range_m[brightest[1]] * np.exp(
        1j * drawn["video"].azimuth_rad[brightest[0]]
    )
    assert np.hypot(*(drawn["plots"] - [at_m.real, at_m.imag]).T).min() < 60.0


def test_settings_without_a_radar_leave_its_errors_to_the_video(video, tmp_path, capsys):
    config = tmp_path / "some.toml"
    config.write_text("[tracker]\nconfirm_hits = 4\n")
    command = ["track", str(video), "--out", str(tmp_path)]
    assert main([*command, "--config", str(config)]) == 0
    assert "estimated from its echoes" in capsys.readouterr().out
    config.write_text("[radar]\nrange_std_m = 11.0\n")
    assert main([*command, "--config", str(config)]) == 0
    assert "radar of some.toml" in capsys.readouterr().out


def test_azimuths_from_the_bow_of_a_ship_that_turns(tmp_path, capsys):
    def from_bow(turn):
        heading_rad = np.deg2rad(300.0 + turn.time_s)
        return replace(turn, azimuth_rad=(turn.azimuth_rad - heading_rad) % (2.0 * np.pi))

    video, own = tmp_path / "bow.cat240", tmp_path / "own.csv"
    write_video(video, map(from_bow, simulator().turns(SHIPS, SCANS, seed=1)))
    rows = [f"{t},0,0,{(300 + t) % 360}" for t in range(-2, int(SCANS * PERIOD_S) + 3)]
    own.write_text("\n".join(["time_s,north_m,east_m,heading_deg", *rows]))
    tracked(video, tmp_path, "--own", str(own))
    assert "--azimuth bow" in capsys.readouterr().out
    tracks = tracked(video, tmp_path, "--own", str(own), "--azimuth", "bow")
    assert "--azimuth" not in capsys.readouterr().out
    for name in SHIPS:
        _, position_m, _ = track_of(tracks, name)
        assert position_m[-5:].max() < 25.0


def strobe_tracked(video, folder, *options):
    command = ["track", str(video), "--method", "strobe", "--out", str(folder), *options]
    assert main(command) == 0
    return read_tracks(folder / "tracks.csv")


def test_strobes_follow_every_ship(video, tmp_path, capsys):
    tracks = strobe_tracked(video, tmp_path)
    assert len(tracks.ids()) == len(SHIPS)
    for name in SHIPS:
        rows, position_m, velocity_mps = track_of(tracks, name)
        assert rows.sum() >= SCANS - 6
        assert position_m[-5:].max() < 25.0
        assert velocity_mps[-1] < 2.5
    plots = (tmp_path / "plots_tracks.csv").read_text().splitlines()
    assert sum(line.endswith((",1", ",2")) for line in plots) >= 2 * (SCANS - 6)


def test_strobes_follow_whom_the_operator_points_at(video, tmp_path, capsys):
    wanted = tmp_path / "wanted.csv"
    first_s = read_plots_of_video(video).episodes[0].scans[0].time_s
    where_m = SHIPS["far"].truth.state_at(first_s)[0, ::2]
    wanted.write_text(f"time_s,north_m,east_m\n{first_s},{where_m[0]},{where_m[1]}\n")
    tracks = strobe_tracked(video, tmp_path, "--acquire", str(wanted))
    assert tracks.ids() == ["1"]
    rows, position_m, _ = track_of(tracks, "far")
    assert rows.all()
    assert position_m[-1] < 15.0


def test_the_screen_shows_the_strobes_around_the_plots(video, tmp_path, monkeypatch, pictures):
    drawn = {}
    monkeypatch.setattr(PPI, "ppi", lambda shown, axes, **kinds: drawn.update(kinds, video=shown))
    monkeypatch.setattr(plot, "save", lambda figure, file: file.write_bytes(b""))
    strobe_tracked(video, tmp_path)
    assert len(drawn["strobes"]) == len(SHIPS)
    for outline in drawn["strobes"]:
        center_m = outline[:-1].mean(axis=0)
        radius_m = np.hypot(*(outline[0] - center_m))
        assert np.hypot(*(drawn["plots"] - center_m).T).min() < radius_m


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--acquire", "nowhere.csv"], "--method strobe"),
        (["--method", "strobe", "--acquire", "nowhere.csv"], "nowhere.csv"),
        (["--method", "strobe", "--truth", "truth.csv"], "--truth"),
    ],
)
def test_options_of_strobes_that_do_not_fit(video, tmp_path, capsys, options, words):
    assert main(["track", str(video), "--out", str(tmp_path), *options]) == 2
    assert words in capsys.readouterr().err


def test_a_designation_that_cannot_be_read_names_the_line(video, tmp_path, capsys):
    wanted = tmp_path / "wanted.csv"
    wanted.write_text("time_s,north_m,east_m\n1,2,3\n1,x,3\n")
    command = ["track", str(video), "--method", "strobe", "--acquire", str(wanted)]
    assert main([*command, "--out", str(tmp_path)]) == 2
    assert "line 3" in capsys.readouterr().err
