"""Turns of the antenna in sectors."""

import itertools
import pickle

import numpy as np
import pytest

import wakeline as wl
from wakeline.recording import Tracks
from wakeline.tracking import median_step_s, read_settings

TURN = 2.0 * np.pi


def sectors_of(scan, edges_rad, own):
    """A scan as sectors between edges that begin and end at north."""
    bearing_rad = scan.bearing_rad % TURN
    for from_rad, to_rad in itertools.pairwise(edges_rad):
        inside = (bearing_rad >= from_rad) & (bearing_rad < to_rad)
        yield {
            "from_rad": from_rad,
            "to_rad": to_rad,
            "time_s": scan.time_s,
            "range_m": scan.range_m[inside],
            "bearing_rad": scan.bearing_rad[inside],
            "plot_time_s": scan.plot_time_s[inside],
            "own": own,
        }


def own_at(episode, scan):
    """Own ship at a scan."""
    if len(scan):
        return wl.OwnShip(north_m=scan.own_north_m[0], east_m=scan.own_east_m[0])
    if episode.own is None:
        return wl.OwnShip()
    north_m, east_m = episode.own.position_at(np.array([scan.time_s]))[0]
    return wl.OwnShip(north_m=north_m, east_m=east_m)


def score(name, edges_rad):
    """Score of a bundled recording tracked in sectors, or by turns without edges."""
    recording = wl.recording.load(name)
    settings, tables = read_settings().knowing(recording.radar), []
    for episode in recording:
        tracker = settings.make_tracker(median_step_s(episode))
        for scan in episode.scans:
            own = own_at(episode, scan)
            if edges_rad is None:
                whole = next(iter(sectors_of(scan, [0.0, TURN], own)))
                tracker.sector(**whole)
            else:
                for sector in sectors_of(scan, edges_rad, own):
                    tracker.sector(**sector)
            table = tracker.tracks()
            tables.append(
                Tracks(
                    track_id=table.track_id.astype(str),
                    time_s=table.time_s,
                    state=table.mean,
                    scenario=np.full(len(table), episode.name),
                )
            )
    return wl.metrics.score(Tracks.joined(tables), recording).overall


@pytest.mark.parametrize("name", ["joyride", "autoferry"])
def test_sectors_of_any_width_score_as_turns_do(name):
    turns = score(name, None)
    uneven = np.concatenate(
        [[0.0], np.sort(np.random.default_rng(3).uniform(0.0, TURN, 20)), [TURN]]
    )
    for edges_rad in (*(np.linspace(0.0, TURN, n + 1) for n in (8, 16, 32, 64)), uneven):
        of = score(name, edges_rad)
        assert of.ids == turns.ids
        assert of.switches == turns.switches
        assert of.coverage >= turns.coverage - 1.001 * turns.targets / turns.eligible_scans
        for error in ("position_rmse_m", "velocity_rmse_mps", "course_rms_deg", "speed_rmse_mps"):
            wanted = getattr(turns.errors, error)
            assert getattr(of.errors, error) == pytest.approx(wanted, rel=0.05), error


RADAR = wl.Radar(range_std_m=8.0, bearing_std_rad=np.deg2rad(0.5), period_s=2.5, max_speed_mps=25.0)


def turns(count, seed=1):
    """Plots of some vessels, turn by turn: ranges, bearings and times."""
    rng = np.random.default_rng(seed)
    bearing_rad = np.array([0.1, 1.0, 2.5, 4.0, 6.1])
    for k in range(count):
        seen = rng.random(5) < 0.9
        yield (
            (2000.0 + 300.0 * np.arange(5) + 10.0 * k + 8.0 * rng.standard_normal(5))[seen],
            (bearing_rad + 0.009 * rng.standard_normal(5))[seen],
            (2.5 * k + 2.5 * bearing_rad / TURN)[seen],
        )


def test_a_whole_turn_as_a_sector_gives_the_bits_of_a_scan():
    scans, sectors = wl.Tracker(RADAR), wl.Tracker([RADAR])
    for k, (range_m, bearing_rad, plot_time_s) in enumerate(turns(30)):
        plots = {"range_m": range_m, "bearing_rad": bearing_rad, "plot_time_s": plot_time_s}
        scans.process(2.5 * (k + 1), **plots)
        sectors.sector(
            radar=0, from_rad=0.3 * k, to_rad=0.3 * k + TURN, time_s=2.5 * (k + 1), **plots
        )
        assert scans.save() == sectors.save()
    assert len(scans.tracks()) == 5


@pytest.mark.parametrize("sectors", [1, 4, 32])
def test_plots_are_seen_from_where_own_ship_was_at_their_times(sectors):
    at_rest, moving = wl.Tracker(RADAR), wl.Tracker(RADAR)
    velocity_mps = {"vnorth_mps": 12.0, "veast_mps": -7.0}
    for k, (range_m, bearing_rad, plot_time_s) in enumerate(turns(20)):
        seen = {"range_m": range_m, "bearing_rad": bearing_rad, "plot_time_s": plot_time_s}
        at_rest.process(2.5 * (k + 1), **seen)
        edges_rad = np.linspace(0.0, TURN, sectors + 1)
        for from_rad, to_rad in itertools.pairwise(edges_rad):
            inside = (bearing_rad >= from_rad) & (bearing_rad < to_rad)
            time_s = 2.5 * (k + to_rad / TURN)
            own = wl.OwnShip(north_m=12.0 * time_s, east_m=-7.0 * time_s, **velocity_mps)
            moving.sector(
                from_rad=from_rad,
                to_rad=to_rad,
                time_s=time_s,
                own=own,
                **{name: column[inside] for name, column in seen.items()},
            )
    time_s = 50.0
    seen_from_own = moving.tracks(time_s).mean - [12.0 * time_s, 12.0, -7.0 * time_s, -7.0]
    off = np.abs(seen_from_own[:, None] - at_rest.tracks(time_s).mean[None]).min(axis=1)
    assert len(off) == 5
    assert (off[:, ::2] < 3.0).all()
    assert (off[:, 1::2] < 1.0).all()


def test_a_track_is_there_when_the_beam_has_passed_it():
    tracker = wl.Tracker([RADAR])
    for k, (range_m, bearing_rad, plot_time_s) in enumerate(turns(20)):
        for n in range(32):
            edges = TURN * n / 32, TURN * (n + 1) / 32
            inside = (bearing_rad >= edges[0]) & (bearing_rad < edges[1])
            report = tracker.sector(
                from_rad=edges[0],
                to_rad=edges[1],
                time_s=2.5 * (k + (n + 1) / 32),
                range_m=range_m[inside],
                bearing_rad=bearing_rad[inside],
                plot_time_s=plot_time_s[inside],
                own=wl.OwnShip(),
            )
            assert report.plot_track_id.shape == (inside.sum(),)
            assert report.rejected_plots == 0
    table = tracker.tracks()
    assert len(table) == 5
    assert (table.time_s == tracker.time_s).all()
    assert (table.hits + table.misses <= 20).all()


def test_the_covariance_of_a_plot_takes_the_place_of_the_radars_errors():
    def position_std_m(**covariance):
        tracker = wl.Tracker(RADAR)
        for k in range(30):
            tracker.process(2.5 * k, range_m=[2000.0], bearing_rad=[0.0], **covariance)
        return np.sqrt(tracker.tracks().covariance[0].diagonal()[[0, 2]])

    of_radar = position_std_m()
    own = np.diag([8.0**2, np.deg2rad(0.5) ** 2])
    np.testing.assert_allclose(position_std_m(covariance=own[None]), of_radar, rtol=1e-9)
    np.testing.assert_array_equal(position_std_m(covariance=np.zeros((1, 2, 2))), of_radar)
    assert (position_std_m(covariance=16.0 * own[None]) > 1.5 * of_radar).all()
    with pytest.raises(ValueError, match=r"covariance must have shape \(1, 2, 2\)"):
        position_std_m(covariance=own)
    tracker = wl.Tracker(RADAR)
    broken = {"range_m": [2000.0], "bearing_rad": [0.0], "covariance": -own[None]}
    assert tracker.process(0.0, **broken).rejected_plots == 1


@pytest.mark.parametrize(
    ("change", "error"),
    [
        ({"radar": 1}, ValueError),
        ({"from_rad": np.nan}, ValueError),
        ({"to_rad": 20.0}, ValueError),
        ({"from_rad": 20.0}, ValueError),
        ({"time_s": np.nan}, wl.FilterError),
        ({"time_s": 1.0}, wl.FilterError),
        ({"time_s": 1e9}, wl.FilterError),
        ({"bearing_rad": [0.1, 0.2]}, ValueError),
    ],
)
def test_a_sector_that_makes_no_sense_is_rejected_and_changes_nothing(change, error):
    tracker = wl.Tracker([RADAR])
    good = {"from_rad": 0.0, "to_rad": 1.0, "time_s": 5.0, "range_m": [1e3], "bearing_rad": [0.1]}
    tracker.sector(**good)
    before = tracker.save()
    with pytest.raises(error):
        tracker.sector(**(good | change))
    assert tracker.save() == before


def quiet(number, time_s):
    """A sector without a plot."""
    return {
        "radar": number,
        "from_rad": 0.0,
        "to_rad": 1.0,
        "time_s": time_s,
        "range_m": [],
        "bearing_rad": [],
    }


def test_radars_are_added_changed_and_removed_and_pickled_so():
    other = wl.Radar(range_std_m=25.0, period_s=3.0)
    tracker = wl.Tracker([RADAR, other])
    assert tracker.add_radar(other) == 2
    assert tracker.remove_radar(1)
    assert not tracker.remove_radar(1)
    with pytest.raises(ValueError, match="radar must be the number of a radar"):
        tracker.sector(**quiet(1, 5.0))
    with pytest.raises(ValueError, match="radar must be the number of a radar"):
        tracker.set_radar(1, other)
    tracker.set_radar(2, RADAR)
    tracker.sector(**quiet(2, 5.0))
    copy = pickle.loads(pickle.dumps(tracker))
    assert copy.save() == tracker.save()
    for one in (tracker, copy):
        one.sector(**quiet(0, 4.0))
        assert one.add_radar(other) == 1
    with pytest.raises(ValueError, match="one Radar at least"):
        wl.Tracker([])


def test_a_vessel_seen_by_two_radars_has_one_track():
    """Both have their own place, errors and period; the picture is one."""
    places = [wl.OwnShip(), wl.OwnShip(north_m=3000.0, east_m=-1000.0)]
    radars = [RADAR, wl.Radar(range_std_m=20.0, bearing_std_rad=0.01, period_s=3.0)]
    tracker = wl.Tracker(radars)
    rng = np.random.default_rng(1)
    turns = sorted(
        (turn * radar.period_s, number)
        for number, radar in enumerate(radars)
        for turn in range(1, int(120 / radar.period_s))
    )
    for time_s, number in turns:
        d = np.array([2000.0 + 5.0 * time_s, 1500.0 - 4.0 * time_s])
        d -= [places[number].north_m, places[number].east_m]
        radar = radars[number]
        tracker.sector(
            radar=number,
            from_rad=0.0,
            to_rad=2 * np.pi,
            time_s=time_s,
            range_m=[np.hypot(*d) + radar.range_std_m * rng.normal()],
            bearing_rad=[np.arctan2(d[1], d[0]) + radar.bearing_std_rad * rng.normal()],
            own=places[number],
        )
    tracks = tracker.tracks()
    assert tracks.track_id.tolist() == [1]
    north_m, vnorth_mps, east_m, veast_mps = tracks.mean[0]
    time_s = tracker.time_s
    assert np.hypot(north_m - 2000 - 5 * time_s, east_m - 1500 + 4 * time_s) < 30.0
    assert np.hypot(vnorth_mps - 5, veast_mps + 4) < 1.0
