"""Data that come late."""

import copy
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from wakeline.tracking import median_step_s, read_settings

TURN = 2.0 * np.pi
COLUMNS = ("track_id", "time_s", "mean", "covariance", "mode_probability", "existence", "hits")


def assert_same(late, in_order):
    """Both trackers have the same tracks, bit for bit."""
    for tentative in (False, True):
        one, other = late.tracks(tentative=tentative), in_order.tracks(tentative=tentative)
        assert one.status == other.status
        assert one.name == other.name
        for column in COLUMNS:
            np.testing.assert_array_equal(getattr(one, column), getattr(other, column))


def as_they_come(rng, time_s, latest_s):
    """Indices of data in the order in which they come when each is late by up to so much."""
    return np.argsort(np.asarray(time_s) + rng.uniform(0.0, latest_s, len(time_s)))


def sectors_of(scan, count):
    """A scan in sectors from north, with a time for each that grows up to that of the scan."""
    bearing_rad = scan.bearing_rad % TURN
    for k in range(count):
        from_rad, to_rad = TURN * k / count, TURN * (k + 1) / count
        inside = (bearing_rad >= from_rad) & (bearing_rad < to_rad)
        own = wl.OwnShip()
        if len(scan):
            own = wl.OwnShip(north_m=scan.own_north_m[0], east_m=scan.own_east_m[0])
        yield {
            "from_rad": from_rad,
            "to_rad": to_rad,
            "time_s": scan.time_s - 1e-3 * (count - 1 - k),
            "range_m": scan.range_m[inside],
            "bearing_rad": scan.bearing_rad[inside],
            "plot_time_s": scan.plot_time_s[inside],
            "own": own,
        }


@pytest.mark.parametrize("sectors", [1, 8])
@pytest.mark.parametrize("name", ["joyride", "autoferry"])
def test_recordings_shuffled_by_two_turns_give_the_tracks_in_order(name, sectors):
    recording = wl.recording.load(name)
    chosen = read_settings().knowing(recording.radar)
    for n, episode in enumerate(recording):
        in_order = chosen.make_tracker(median_step_s(episode))
        models = wl.VesselModels(**chosen.models)
        late = wl.LateWindow(in_order.radar, in_order.config, models)
        inputs = [sector for scan in episode.scans for sector in sectors_of(scan, sectors)]
        for sector in inputs:
            in_order.sector(**sector)
        order = as_they_come(
            np.random.default_rng(n), [one["time_s"] for one in inputs], late.window_s
        )
        for k in order:
            late.sector(**inputs[k])
        assert late.too_late_inputs == 0
        assert late.late_inputs > 0
        assert_same(late, in_order)
        assert len(in_order.tracks())


RADARS = [
    wl.Radar(range_std_m=8.0, bearing_std_rad=np.deg2rad(0.5), period_s=2.5, max_speed_mps=25.0),
    wl.Radar(range_std_m=20.0, bearing_std_rad=np.deg2rad(1.0), period_s=3.0, max_speed_mps=25.0),
]


def events(seed, last_s=40.0):
    """What sensors see of five vessels, and what an operator does: (time, call, arguments)."""
    rng = np.random.default_rng(seed)
    bearing_rad = np.array([0.1, 1.0, 2.5, 4.0, 6.1])
    for number, radar in enumerate(RADARS):
        for time_s in np.arange(radar.period_s, last_s, radar.period_s):
            seen = rng.random(5) < 0.9
            range_m = 2000.0 + 300.0 * np.arange(5) + 4.0 * time_s
            yield (
                time_s,
                "sector",
                {
                    "radar": number,
                    "from_rad": 0.0,
                    "to_rad": TURN,
                    "time_s": time_s,
                    "range_m": (range_m + radar.range_std_m * rng.standard_normal(5))[seen],
                    "bearing_rad": (bearing_rad + radar.bearing_std_rad * rng.standard_normal(5))[
                        seen
                    ],
                },
            )
    for time_s in np.arange(3.1, last_s, 1.7):
        vessel = int(rng.integers(0, 5))
        range_m = 2000.0 + 300.0 * vessel + 4.0 * time_s
        north_m, east_m = (
            range_m * np.cos(bearing_rad[vessel]),
            range_m * np.sin(bearing_rad[vessel]),
        )
        report = {"time_s": time_s, "north_m": north_m, "east_m": east_m, "position_std_m": 5.0}
        yield time_s, "report", report | {"identity": f"vessel {vessel}"}
        seen_rad = bearing_rad + 0.01 * rng.standard_normal(5)
        bearings = {"bearing_rad": seen_rad, "bearing_std_rad": 0.01}
        yield time_s + 0.05, "bearings", bearings | {"time_s": time_s + 0.05}
    for time_s in np.sort(rng.uniform(10.0, last_s, 4)):
        north_m, east_m = rng.uniform(-3000.0, 3000.0, 2)
        yield time_s, "designate", {"time_s": time_s, "north_m": north_m, "east_m": east_m}
        track_id = int(rng.integers(1, 7))
        yield time_s + 0.1, "rename", {"track_id": track_id, "name": f"Boat {time_s:.0f}"}
        yield time_s + 0.2, "drop", {"track_id": track_id, "hush": bool(rng.random() < 0.5)}


def give(tracker, event, late):
    """Give an event to a tracker."""
    time_s, call, arguments = event
    if late and call in ("rename", "drop"):
        arguments = arguments | {"time_s": time_s}
    return getattr(tracker, call)(**arguments)


@given(seed=st.integers(0, 1000), shuffle=st.integers(0, 1000), latest_s=st.floats(0.0, 5.9))
@settings(max_examples=10, deadline=None)
def test_any_order_of_arrival_gives_the_tracks_in_order(seed, shuffle, latest_s):
    given_events = list(events(seed))
    in_order, late = wl.Tracker(RADARS), wl.LateWindow(RADARS)
    for event in sorted(given_events, key=lambda one: (one[0], one[2].get("radar", 9))):
        give(in_order, event, late=False)
    times_s = [event[0] for event in given_events]
    for k in as_they_come(np.random.default_rng(shuffle), times_s, latest_s):
        give(late, given_events[k], late=True)
    assert late.too_late_inputs == 0
    assert_same(late, in_order)


def test_the_picture_is_published_at_once_and_corrected():
    late = wl.LateWindow(RADARS[0])
    turns = [event for event in events(1) if event[1] == "sector" and event[2]["radar"] == 0]
    for event in turns[:-2]:
        give(late, event, late=True)
    give(late, turns[-1], late=True)
    assert (late.tracks(correct=False).time_s == turns[-1][0]).all()
    report = give(late, turns[-2], late=True)
    assert late.is_correct, "there is credit for one"
    assert late.corrections == 1
    assert (report.plot_track_id != 0).all()
    assert late.late_inputs == 1
    assert late.correct() == []


def test_what_is_too_late_is_counted():
    late = wl.LateWindow(RADARS, window_s=4.0)
    assert isinstance(late, wl.Tracker)
    late.process(100.0, range_m=[1000.0], bearing_rad=[0.0])
    assert late.earliest_time_s == 96.0
    report = late.process(95.0, range_m=[1000.0, 2000.0], bearing_rad=[0.0, 1.0])
    assert report.rejected_plots == 2
    assert late.too_late_inputs == 1
    assert late.late_inputs == 0
    for bad in ({"window_s": -1.0}, {"window_s": np.nan}, {"max_inputs": 0}):
        with pytest.raises(ValueError, match=next(iter(bad))):
            wl.LateWindow(RADARS, **bad)
    with pytest.raises(wl.FilterError):
        late.process(np.nan, range_m=[], bearing_rad=[])
    with pytest.raises(ValueError, match="time_s"):
        late.drop(1, time_s=np.inf)
    with pytest.raises(ValueError, match="radar"):
        late.sector(radar=2, from_rad=0, to_rad=1, time_s=100.0, range_m=[], bearing_rad=[])


def test_a_restored_a_pickled_and_a_copied_window_go_on():
    given_events = list(events(3))
    times_s = [event[0] for event in given_events]
    order = as_they_come(np.random.default_rng(3), times_s, 5.0)
    late, restored = wl.LateWindow(RADARS), wl.LateWindow(RADARS)
    for k in order[:25]:
        give(late, given_events[k], late=True)
    restored.restore(late.save())
    twins = [restored, pickle.loads(pickle.dumps(late)), copy.deepcopy(late)]
    for k in order[25:]:
        for one in (late, *twins):
            give(one, given_events[k], late=True)
    for one in twins:
        assert one.window_s == late.window_s
        assert_same(one, late)
    with pytest.raises(ValueError, match="state"):
        late.restore(wl.Tracker(RADARS).save())
    with pytest.raises(ValueError, match="state"):
        late.restore(wl.LateWindow(RADARS, window_s=9.0).save())


def test_radars_come_change_and_go():
    late = wl.LateWindow(RADARS[0])
    for event in sorted(events(4, 20.0), key=lambda one: one[0]):
        if event[2].get("radar", 0) == 0:
            give(late, event, late=True)
    before = late.tracks().track_id
    assert late.add_radar(RADARS[1]) == 1
    late.set_radar(1, RADARS[0])
    late.sector(radar=1, from_rad=0.0, to_rad=TURN, time_s=30.0, range_m=[], bearing_rad=[])
    assert late.tracks().time_s[0] == 30.0
    again = pickle.loads(pickle.dumps(late))
    assert_same(again, late)
    assert late.remove_radar(0)
    assert set(late.tracks(tentative=True).track_id) >= set(before)
