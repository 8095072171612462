"""Positions that vessels report, and bearings and ranges alone."""

import pickle

import numpy as np
import pytest

import wakeline as wl

RADAR = wl.Radar(range_std_m=10.0, bearing_std_rad=0.01, period_s=2.5)
EPOCH_S = 1.7e9  # of a clock that tells the day
START_M = np.array([2000.0, -1500.0])
VELOCITY_MPS = np.array([-3.0, 6.0])


def at(time_s):
    """Where the vessel is."""
    return START_M + (time_s - EPOCH_S) * VELOCITY_MPS


def seen(tracker, rng, turns, each_turn=lambda time_s: None):
    """Give a tracker turns of the antenna with a plot of the vessel."""
    for turn in turns:
        time_s = EPOCH_S + 2.5 * turn
        range_m = np.hypot(*at(time_s)) + RADAR.range_std_m * rng.normal()
        bearing_rad = np.arctan2(*at(time_s)[::-1]) + RADAR.bearing_std_rad * rng.normal()
        tracker.process(time_s, range_m=[range_m], bearing_rad=[bearing_rad])
        each_turn(time_s)


def report(time_s, identity="257378500", offset_m=(0.0, 0.0), **others):
    """The arguments of a report of the vessel."""
    north_m, east_m = at(time_s) + offset_m
    values = {
        "time_s": time_s,
        "identity": identity,
        "north_m": north_m,
        "east_m": east_m,
        "position_std_m": 5.0,
        "vnorth_mps": VELOCITY_MPS[0],
        "veast_mps": VELOCITY_MPS[1],
        "velocity_std_mps": 0.3,
    }
    return values | others


def test_a_report_gives_its_track_an_identity_and_tells_of_it():
    tracker = wl.Tracker(RADAR)
    rng = np.random.default_rng(1)
    seen(tracker, rng, range(1, 21))
    assert tracker.tracks().identity == [""]
    assert np.isnan(tracker.tracks().identity_time_s[0])
    assert tracker.find("257378500") == 0
    results = [tracker.report(**report(time_s)) for time_s in (EPOCH_S + 47.0, EPOCH_S + 49.0)]
    assert [result.track_id for result in results] == [1, 1]
    assert [(event.kind, event.identity) for event in results[0].events] == [
        ("identified", "257378500")
    ]
    assert not results[1].events
    tracks = tracker.tracks()
    assert tracks.identity == ["257378500"]
    assert tracks.identity_probability[0] > 0.9
    assert tracks.identity_time_s[0] == EPOCH_S + 49.0
    assert tracker.find("257378500") == 1
    assert tracker.find("257378500", source="gnss") == 0
    assert np.hypot(*(tracks.mean[0, ::2] - at(EPOCH_S + 50.0))) < 12.0
    for one in (results[0], tracks):
        copy = pickle.loads(pickle.dumps(one))
        assert repr(copy) == repr(one)
    copy = pickle.loads(pickle.dumps(tracker))
    assert copy.tracks().identity == ["257378500"]


def test_a_report_far_from_its_track_changes_no_state_but_is_told():
    tracker = wl.Tracker(RADAR)
    rng = np.random.default_rng(2)
    seen(tracker, rng, range(1, 21))
    for time_s in (40.0, 45.0, 50.0):
        tracker.report(**report(EPOCH_S + time_s))
    before = tracker.tracks().mean.copy()
    result = tracker.report(**report(EPOCH_S + 50.5, offset_m=(3704.0, 0.0)))
    assert {event.kind for event in result.events} >= {"identity_jumps", "identity_disagrees"}
    assert str(result.status) != "ok"
    np.testing.assert_array_equal(tracker.tracks().mean, before)


@pytest.mark.parametrize(
    "change",
    [
        {"identity": ""},
        {"identity": "x" * 200},
        {"source": ""},
        {"north_m": np.nan},
        {"east_m": 1e300},
        {"position_std_m": 0.0},
        {"veast_mps": None},
        {"velocity_std_mps": -1.0},
        {"time_s": np.inf},
    ],
)
def test_a_report_that_makes_no_sense_is_rejected(change):
    tracker = wl.Tracker(RADAR)
    seen(tracker, np.random.default_rng(3), range(1, 5))
    before = tracker.save()
    with pytest.raises(ValueError, match=next(iter(change))):
        tracker.report(**(report(EPOCH_S + 10.0) | change))
    assert tracker.save() == before


def test_a_report_of_long_ago_or_twice_is_not_an_error_and_changes_nothing():
    tracker = wl.Tracker(RADAR)
    seen(tracker, np.random.default_rng(4), range(1, 81))
    tracker.report(**report(EPOCH_S + 195.0))
    before = tracker.save()
    for time_s in (195.0, 190.0, 10.0, 1e4):
        assert not tracker.report(**report(EPOCH_S + time_s)).events
    assert tracker.save() == before


@pytest.mark.parametrize("sensor", ["bearings", "ranges"])
def test_a_precise_part_of_a_position_makes_it_better(sensor):
    """Across the line of sight for bearings, along it for ranges."""
    errors = {}
    for used in (False, True):
        tracker = wl.Tracker(RADAR)
        rng = np.random.default_rng(5)
        noise = np.random.default_rng(6)
        squares = []

        def part(time_s, used=used, tracker=tracker, noise=noise, squares=squares):
            if used and sensor == "bearings":
                bearing_rad = np.arctan2(*at(time_s)[::-1]) + 1e-3 * noise.normal()
                tracker.bearings(time_s=time_s, bearing_rad=[bearing_rad], bearing_std_rad=1e-3)
            elif used:
                range_m = np.hypot(*at(time_s)) + noise.normal()
                tracker.ranges(time_s=time_s, range_m=[range_m], range_std_m=1.0)
            if time_s > EPOCH_S + 50.0 and len(tracker.tracks()):
                along = at(time_s) / np.hypot(*at(time_s))
                measured = along if sensor == "ranges" else np.array([-along[1], along[0]])
                squares.append(((tracker.tracks().mean[0, ::2] - at(time_s)) @ measured) ** 2)

        seen(tracker, rng, range(1, 81), part)
        errors[used] = np.sqrt(np.mean(squares))
    assert errors[True] < 0.7 * errors[False]


def test_a_part_that_makes_no_sense_is_rejected():
    tracker = wl.Tracker(RADAR)
    seen(tracker, np.random.default_rng(7), range(1, 21))
    good = {"time_s": EPOCH_S + 50.0, "bearing_rad": [0.1], "bearing_std_rad": 0.01}
    for change in ({"bearing_std_rad": 0.0}, {"bearing_rad": [[0.1]]}, {"sensor": 4}):
        with pytest.raises(ValueError, match=next(iter(change))):
            tracker.bearings(**(good | change))
    with pytest.raises(wl.FilterError):
        tracker.bearings(**(good | {"time_s": EPOCH_S + 1e5}))
    with pytest.raises(ValueError, match="range_std_m"):
        tracker.ranges(time_s=EPOCH_S + 50.0, range_m=[1e3], range_std_m=np.nan)
    assert tracker.bearings(**good).plot_track_id.tolist() == [0]


@pytest.mark.parametrize("ahead_s", [10.0, 60.0, 100.0])
def test_a_clock_that_is_ahead_drags_no_track(ahead_s):
    """Of AIS and of a camera, whose positions are right."""
    rng = np.random.default_rng(7)
    for of_camera in (False, True):
        tracker, errors_m = wl.Tracker(RADAR), []

        def each_turn(time_s, tracker=tracker, errors_m=errors_m, of_camera=of_camera):
            if of_camera:
                bearing_rad = np.arctan2(*at(time_s)[::-1]) + 0.003 * rng.normal()
                values = {"bearing_rad": [bearing_rad], "bearing_std_rad": 0.003}
                tracker.bearings(time_s=time_s + ahead_s, **values)
            elif int((time_s - EPOCH_S) / 2.5) % 4 == 0:
                tracker.report(**report(time_s) | {"time_s": time_s + ahead_s})
            tracks = tracker.tracks(time_s=time_s)
            if time_s > EPOCH_S + 60.0 and len(tracks.mean):
                errors_m.append(np.hypot(*(tracks.mean[0, 0::2] - at(time_s))))

        seen(tracker, rng, range(1, 80), each_turn)
        assert len(errors_m) > 50
        assert np.sqrt(np.mean(np.square(errors_m))) < 12.0


def test_reports_of_vessels_go_on_where_radars_are_silent():
    tracker, rng = wl.Tracker(RADAR), np.random.default_rng(8)
    seen(tracker, rng, range(1, 30), lambda time_s: tracker.report(**report(time_s)))
    for time_s in EPOCH_S + np.arange(85.0, 180.0, 10.0):
        assert tracker.report(**report(time_s)).status == wl.Status.ok
    last = tracker.tracks(time_s=EPOCH_S + 175.0)
    assert np.hypot(*(last.mean[0, 0::2] - at(EPOCH_S + 175.0))) < 15.0


@pytest.mark.parametrize("sectors", [1, 8])
def test_a_vessel_behind_the_mast_keeps_its_track(sectors):
    """It has no misses where the radar is said to be blind, by turns and by sectors."""
    radar = wl.Radar(
        range_std_m=10.0,
        bearing_std_rad=0.01,
        period_s=2.5,
        blind_from_rad=np.radians(40.0),
        blind_to_rad=np.radians(60.0),
    )
    tracker, rng = wl.Tracker(radar), np.random.default_rng(9)
    misses = []
    for turn in range(120):
        bearing_rad = np.radians(30.0 + 0.3 * turn)
        for k in range(sectors):
            from_rad, to_rad = 2.0 * np.pi * k / sectors, 2.0 * np.pi * (k + 1) / sectors
            end_s = 2.5 * (turn + (k + 1) / sectors)
            behind_mast = 40.0 < 30.0 + 0.3 * turn < 60.0
            seen_plots = int(from_rad <= bearing_rad < to_rad and not behind_mast)
            plots = {
                "range_m": [1500.0 + 10.0 * rng.normal()] * seen_plots,
                "bearing_rad": [bearing_rad + 0.01 * rng.normal()] * seen_plots,
            }
            if sectors == 1:
                tracker.process(end_s, **plots)
            else:
                tracker.sector(from_rad=from_rad, to_rad=to_rad, time_s=end_s, **plots)
        if turn > 20:
            assert tracker.tracks().track_id.tolist() == [1], turn
            misses.append(tracker.tracks().misses[0])
    assert max(misses) <= 3
