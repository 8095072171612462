"""Danger between any two vessels: the engine's watch, tracks of recordings, files and pictures."""

import copy
import csv
import dataclasses
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from wakeline.cli import main
from wakeline.recording import OwnShipMotion, Tracks
from wakeline.tracking import watch_tracks, write_tables

COVARIANCE = np.diag([25.0, 0.01, 25.0, 0.01])
LIMITS = wl.DangerLimits()


def vessels(*states):
    """Arguments of an update: vessels numbered from 1."""
    mean = np.array(states, dtype=float).reshape(-1, 4)
    return {
        "vessel_id": np.arange(1, len(mean) + 1),
        "mean": mean,
        "covariance": np.tile(COVARIANCE, (len(mean), 1, 1)),
    }


def later(state, after_s):
    x, vx, y, vy = state
    return (x + after_s * vx, vx, y + after_s * vy, vy)


HEAD_ON = ((0.0, 5.0, 0.0, 0.0), (5000.0, -5.0, 100.0, 0.0))

SPEED = st.floats(-12.0, 12.0)
PLACE = st.floats(0.0, 2e4)
SHIP = st.tuples(PLACE, SPEED, PLACE, SPEED)


# The engine ---------------------------------------------------------------------------------------


@settings(max_examples=40, deadline=None)
@given(ships=st.lists(SHIP, min_size=2, max_size=25), limit_m=st.floats(10.0, 5000.0))
def test_the_screened_pairs_are_those_of_all_pairs(ships, limit_m):
    limits = wl.DangerLimits(cpa_limit_m=limit_m)
    report = wl.EncounterWatch(limits).update(0.0, **vessels(*ships))
    mean = np.array(ships)
    first, second = np.triu_indices(len(ships), 1)
    closest = wl.closest_approach(mean[first], mean[second], COVARIANCE, COVARIANCE)
    relative = mean[second, 1::2] - mean[first, 1::2]
    speed = np.hypot(*mean[:, 1::2].T)
    matters = (
        (closest.tcpa_s >= 0.0)
        & (closest.tcpa_s <= limits.tcpa_limit_s)
        & (np.hypot(*relative.T) > 3.0 * np.sqrt(0.02))
        & (np.maximum(speed[first], speed[second]) > limits.rest_speed_mps + 2.0 * 0.1)
        & (closest.probability(limit_m, limits.tcpa_limit_s) >= 0.01)
    )
    found = report.approaches
    assert set(zip(found.first, found.second, strict=True)) == set(
        zip(first[matters] + 1, second[matters] + 1, strict=True)
    )
    order = {pair: k for k, pair in enumerate(zip(first + 1, second + 1, strict=True))}
    rows = [order[pair] for pair in zip(found.first, found.second, strict=True)]
    np.testing.assert_array_equal(found.cpa_m, closest.cpa_m[rows])
    np.testing.assert_array_equal(found.tcpa_s, closest.tcpa_s[rows])
    np.testing.assert_array_equal(found.covariance, closest.covariance[rows])
    apart = np.hypot(*(found.first_at_cpa_m - found.second_at_cpa_m).T)
    np.testing.assert_allclose(apart, found.cpa_m, atol=1e-6)


def test_the_probability_is_the_share_of_draws():
    report = wl.EncounterWatch(wl.DangerLimits(cpa_limit_m=120.0)).update(0.0, **vessels(*HEAD_ON))
    draws = np.random.default_rng(1).multivariate_normal(
        np.subtract(*HEAD_ON[::-1]), 2.0 * COVARIANCE, 100_000
    )
    x, vx, y, vy = draws.T
    t = np.clip(-(x * vx + y * vy) / (vx**2 + vy**2), 0.0, 1200.0)
    share = np.mean(np.hypot(x + vx * t, y + vy * t) < 120.0)
    assert report.approaches.probability[0] == pytest.approx(share, abs=0.02)
    assert 0.2 < share < 0.9


@settings(max_examples=30, deadline=None)
@given(
    noise=st.lists(st.floats(-0.3, 0.3), min_size=250, max_size=250),
    miss_m=st.floats(-1500.0, 1500.0),
    hold_s=st.floats(0.0, 100.0),
)
def test_an_encounter_never_flickers(noise, miss_m, hold_s):
    """Between beginnings there is an end, after the hold time; no number comes twice."""
    watch = wl.EncounterWatch(wl.DangerLimits(clear_hold_s=hold_s))
    open_id, numbers = None, []
    for k, error in enumerate(noise):
        ship = later((9000.0, -5.0, miss_m, 0.0), 5.0 * k)
        ship = (ship[0], ship[1], ship[2], error)
        report = watch.update(5.0 * k, **vessels(later(HEAD_ON[0], 5.0 * k), ship))
        for one, last_s in zip(report.ended.encounter_id, report.ended.last_s, strict=True):
            assert one == open_id
            assert 5.0 * k - last_s >= hold_s
            open_id = None
        for one in report.began.encounter_id:
            assert open_id is None
            open_id = one
            numbers.append(one)
        assert watch.encounters.encounter_id.tolist() == ([] if open_id is None else [open_id])
    assert len(set(numbers)) == len(numbers)


def test_it_is_acknowledged_copied_and_goes_on():
    zone = wl.DangerZone("basin", [[-9, -9], [-9, 9], [9, 0]], wl.DangerLimits(cpa_limit_m=5.0))
    watch = wl.EncounterWatch(zones=[zone], max_vessels=10)
    watch.update(0.0, **vessels(*HEAD_ON))
    (number,) = watch.encounters.encounter_id
    assert not watch.acknowledge(number + 1)
    assert watch.acknowledge(number)
    for other in (copy.copy(watch), pickle.loads(pickle.dumps(watch))):
        assert repr(other) == repr(watch)
        assert other.zones == watch.zones == [zone]
        assert other.encounters.acknowledged.tolist() == [True]
        assert other.save() == watch.save()
    with pytest.raises(ValueError, match="same limits"):
        wl.EncounterWatch().restore(watch.save())
    table = pickle.loads(pickle.dumps(watch.encounters))
    np.testing.assert_array_equal(table.covariance, watch.encounters.covariance)


@pytest.mark.parametrize(
    ("change", "error", "words"),
    [
        ({"vessel_id": [3, 3]}, ValueError, "vessel_id must be different.* got 3 twice"),
        ({"mean": np.zeros((2, 3))}, ValueError, r"mean must have shape \(2, 4\)"),
        ({"covariance": np.zeros((2, 4))}, ValueError, r"covariance must have shape \(2, 4, 4\)"),
        ({"time_s": -1.0}, wl.FilterError, "negative time step"),
        ({"time_s": np.nan}, wl.FilterError, "not finite"),
    ],
)
def test_an_update_that_cannot_be_is_named(change, error, words):
    watch = wl.EncounterWatch()
    watch.update(0.0, **vessels(*HEAD_ON))
    with pytest.raises(error, match=words):
        watch.update(**({"time_s": 1.0} | vessels(*HEAD_ON) | change))


@pytest.mark.parametrize(
    ("outline", "words"),
    [([[0, 0], [1, 1]], "3 or more"), ([[0, 0], [1, 1], [0, np.inf]], "finite"), ([1, 2], "shape")],
)
def test_a_zone_is_a_polygon(outline, words):
    with pytest.raises(ValueError, match=words):
        wl.DangerZone("line", outline)


def test_vessels_that_are_not_finite_are_counted():
    report = wl.EncounterWatch().update(0.0, **vessels(*HEAD_ON, (np.nan, 1.0, 2.0, 3.0)))
    assert report.unwatched_vessels == 1
    assert len(report.began) == 1


# Tracks -------------------------------------------------------------------------------------------


def straight(ships, time_s):
    """Tracks of ships that go straight on, by id."""
    ids = np.repeat(list(ships), len(time_s))
    states = np.array([later(ship, t) for ship in ships.values() for t in time_s])
    covariance = np.tile(COVARIANCE, (len(states), 1, 1))
    return Tracks(ids, np.tile(time_s, len(ships)), states, covariance=covariance)


def own_ship(time_s, state=(0.0, 0.0, 0.0, 0.0)):
    x, vx, y, vy = np.array([later(state, t) for t in time_s]).T
    return OwnShipMotion(time_s, x, y, vx, vy)


TIME_S = np.arange(0.0, 900.0, 3.0)


def test_tracks_have_encounters_without_own_ship():
    ships = dict(zip("ab", HEAD_ON, strict=True)) | {"far": (9e4, 5.0, 0.0, 0.0)}
    tracks, (one,) = watch_tracks(straight(ships, TIME_S))
    assert tracks.alarmed is None
    assert tracks.cpa_m is None
    assert (one.first, one.second, one.begin_s) == ("a", "b", 0.0)
    assert one.end_s == pytest.approx(500.0, abs=3.0)
    assert one.least_range_s == pytest.approx(500.0, abs=3.0)
    assert one.least_range_m == pytest.approx(100.0, abs=10.0)
    assert one.cpa_m == pytest.approx(100.0)
    assert one.tcpa_s == pytest.approx(500.0)
    assert "tracks a and b at 0.0 s: CPA 100 m (0.05 NM), TCPA 8.3 min, 100 %" in str(one)


def test_own_ship_is_one_more_vessel():
    tracks = straight({"b": HEAD_ON[1]}, TIME_S)
    watched, (one,) = watch_tracks(tracks, own_ship(TIME_S, HEAD_ON[0]))
    assert (one.first, one.second, one.with_own_ship) == ("own", "b", True)
    during = (tracks.time_s >= one.begin_s) & (tracks.time_s <= one.end_s)
    np.testing.assert_array_equal(watched.alarmed, during)
    assert str(one).startswith("track b at 0.0 s: CPA 100 m")


def test_a_vessel_that_is_inside_already_gives_its_distance():
    _, (one,) = watch_tracks(straight({"1": (0, 5, 0, 0), "2": (700, -5, 0, 0)}, TIME_S))
    assert one.inside
    assert "inside already, 700 m (0.38 NM) off" in str(one)


def test_rows_that_are_nan_have_no_encounter():
    tracks = straight(dict(zip("ab", HEAD_ON, strict=True)), TIME_S)
    tracks.state[tracks.track_id == "b", 0] = np.nan
    assert watch_tracks(tracks).encounters == []
    assert watch_tracks(tracks.where(slice(0, 0))).encounters == []


def test_covariance_and_velocity_are_needed():
    tracks = straight({"a": HEAD_ON[0]}, TIME_S)
    with pytest.raises(ValueError, match="tracks must have a covariance"):
        watch_tracks(dataclasses.replace(tracks, covariance=None))
    with pytest.raises(ValueError, match="own must have a velocity"):
        watch_tracks(tracks, OwnShipMotion.fixed())


# Recordings ---------------------------------------------------------------------------------------

SCAN_S = 3.0


def recorded(path, *ways, scans=120, seed=1, std_m=4.0):
    """A file of plots of vessels, each a function of time that gives [north, east]."""
    rng = np.random.default_rng(seed)
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["time_s", "north_m", "east_m"])
        for k in range(scans):
            for way in ways:
                noise = rng.normal(scale=std_m, size=2)
                writer.writerow([1000.0 + SCAN_S * k, *(np.array(way(SCAN_S * k)) + noise)])
    return path


def own_file(path, way, scans=120):
    rows = [(1000.0 + SCAN_S * k, *way(SCAN_S * k)) for k in range(scans)]
    text = "\n".join(",".join(map(str, row)) for row in rows)
    path.write_text(f"time_s,own_north_m,own_east_m\n{text}\n")
    return path


def test_a_target_at_rest_near_the_limit_raises_no_alarm(tmp_path):
    """Own ship at anchor, another vessel at rest 1000 m off, the limit 926 m."""
    for seed in range(5):
        plots = recorded(tmp_path / "plots.csv", lambda t: (1000.0, 0.0), scans=600, seed=seed)
        own = own_file(tmp_path / "own.csv", lambda t: (0.0, 0.0), scans=600)
        assert wl.track_recording(plots, own=own).encounters == []


def test_no_alarm_has_its_closest_approach_beyond_the_time_limit(tmp_path):
    """Slow vessels that close up from outside the limit."""
    for k, speed in enumerate((0.3, 0.8, 1.5, 6.0)):
        plots = recorded(
            tmp_path / "plots.csv", lambda t, v=speed: (1100.0 - v * t, 50.0), scans=400, seed=k
        )
        own = own_file(tmp_path / "own.csv", lambda t: (0.0, 0.0), scans=400)
        for one in wl.track_recording(plots, own=own).encounters:
            assert 0.0 <= one.tcpa_s <= LIMITS.tcpa_limit_s


def test_own_ships_own_echo_raises_no_alarm(tmp_path):
    """A plot 12 m off own ship in every scan of a voyage with turns."""

    def own_way(t):
        leg, rest = divmod(t, 300.0)
        corner = [(0.0, 0.0), (1500.0, 0.0), (1500.0, 1500.0), (0.0, 1500.0)]
        course = np.radians(90.0 * (leg % 4))
        x, y = corner[int(leg) % 4]
        return x + 5.0 * rest * np.cos(course), y + 5.0 * rest * np.sin(course)

    plots = recorded(tmp_path / "plots.csv", lambda t: np.add(own_way(t), (12.0, 0.0)), scans=600)
    own = own_file(tmp_path / "own.csv", own_way, scans=600)
    tracks = wl.track_recording(plots, own=own)
    assert len(tracks) > 300
    assert tracks.encounters == []


def test_moored_craft_are_silent_and_the_one_that_passes_is_not(tmp_path):
    berths = [(200.0 + 25.0 * k, 400.0) for k in range(6)]
    passing = [lambda t, b=b: b for b in berths] + [lambda t: (-600.0 + 5.0 * t, 250.0)]
    tracks = wl.track_recording(recorded(tmp_path / "plots.csv", *passing, scans=200))
    moving = [
        track_id
        for track_id in tracks.ids()
        if np.median(tracks.speed_mps[tracks.track_id == track_id]) > 3.0
    ]
    assert len(moving) == 1
    assert len(tracks.encounters) >= 3
    assert all(moving[0] in (one.first, one.second) for one in tracks.encounters)
    pairs = [(one.first, one.second) for one in tracks.encounters]
    assert len(set(pairs)) == len(pairs)


@pytest.fixture(scope="module")
def meeting(tmp_path_factory):
    """Plots of two vessels that meet port to port, 60 m off."""
    folder = tmp_path_factory.mktemp("meeting")
    return recorded(
        folder / "plots.csv",
        lambda t: (-1000.0 + 6.0 * t, 500.0),
        lambda t: (1200.0 - 6.0 * t, 440.0),
    )


def test_the_command_writes_and_prints_encounters(meeting, tmp_path, capsys):
    assert main(["track", str(meeting), "--out", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    assert "1 encounter of tracks with each other, closer than 926 m within 20 min" in text
    with (tmp_path / "encounters.csv").open(newline="") as file:
        (row,) = csv.DictReader(file)
    tracks = wl.recording.read_tracks(tmp_path / "tracks.csv")
    assert {row["first"], row["second"]} <= set(tracks.ids())
    assert float(row["least_range_m"]) == pytest.approx(60.0, abs=15.0)
    assert float(row["least_range_s"]) == pytest.approx(1000.0 + 2200.0 / 12.0, abs=6.0)
    assert (tmp_path / "map.png").exists()


def test_encounters_without_any_are_a_table_of_its_head(meeting, tmp_path):
    narrow = tmp_path / "narrow.toml"
    narrow.write_text("[danger]\ncpa_limit_m = 10\n")
    tracks = wl.track_recording(meeting, config=narrow)
    assert tracks.encounters == []
    files = write_tables(tmp_path, tracks.episodes)
    assert (tmp_path / "encounters.csv") in files
    assert len((tmp_path / "encounters.csv").read_text().splitlines()) == 1


ZONE = '[[zone]]\nname = "harbor"\noutline_m = [[-900, 0], [-900, 900], [900, 900], [900, 0]]\n'


def test_a_zone_has_its_own_limits(meeting, tmp_path):
    config = tmp_path / "zone.toml"
    config.write_text(f"{ZONE}cpa_limit_m = 20\n")
    assert wl.track_recording(meeting, config=config).encounters == []
    config.write_text(f"[danger]\ncpa_limit_m = 20\n{ZONE}cpa_limit_m = 500\n")
    (one,) = wl.track_recording(meeting, config=config).encounters
    assert one.zone == "harbor"
    read = wl.tracking.read_settings(config)
    assert read.danger_zones[0].limits.tcpa_limit_s == LIMITS.tcpa_limit_s
    config.write_text(read.toml())
    assert wl.tracking.read_settings(config) == read


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[zone]\nname = 'a'\n", "must be sections"),
        ("[[zone]]\nname = 'a'\n", "1 needs outline_m"),
        ("[[zone]]\nname = 'a'\noutline_m = [[0, 0], [1, 1]]\n", "1: outline_m.*3 or more"),
        ("[[zone]]\nname = 'a'\noutline_m = 'round'\n", "1: "),
        (f"{ZONE}range_m = 3\n", "unknown key range_m"),
        (f"{ZONE}cpa_limit_m = -3\n", "1: cpa_limit_m"),
        (f"{ZONE}cpa_limit_m = 'wide'\n", "cpa_limit_m must be a number"),
    ],
)
def test_a_zone_that_cannot_be_used_is_named(text, words, tmp_path):
    config = tmp_path / "zone.toml"
    config.write_text(text)
    with pytest.raises(wl.tracking.SettingsError, match=rf"zone\.toml.*{words}"):
        wl.tracking.read_settings(config)


def test_encounters_are_drawn(meeting):
    colors = pytest.importorskip("matplotlib.colors")
    tracks = wl.track_recording(meeting)
    ax = wl.plot.map(tracks).axes[0]
    (one,) = tracks.encounters
    assert f"{one.first}\u2013{one.second}: {one.least_range_m:.0f} m" in [
        t.get_text() for t in ax.texts
    ]
    red = [line for line in ax.lines if colors.to_hex(line.get_color()) == "#e00000"]
    ends = next(line.get_xydata() for line in red if len(line.get_xdata()) == 2)
    assert np.hypot(*np.diff(ends, axis=0)[0]) == pytest.approx(one.least_range_m, abs=1.0)
    assert [t.get_text() for t in ax.get_legend().get_texts()].count("danger") == 1
