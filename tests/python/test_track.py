"""The tracker: the life of tracks, saved states, rejected input, and threads."""

import re
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import wakeline as wl
from wakeline.scenario import RadarSimulator, Segment, Truth

PERIOD_S = 2.5
RADAR = wl.Radar(
    range_std_m=10.0,
    bearing_std_rad=np.deg2rad(0.5),
    extent_std_m=2.0,
    period_s=PERIOD_S,
    max_speed_mps=25.0,
)
TABLE = (
    "track_id",
    "time_s",
    "mean",
    "covariance",
    "mode_probability",
    "nis",
    "existence",
    "visibility",
    "hits",
    "misses",
)
SETTINGS = (wl.Radar, wl.TrackerConfig, wl.VesselModels)


def simulator(detection=0.9, clutter=3.0):
    return RadarSimulator(
        RADAR.range_std_m,
        RADAR.bearing_std_rad,
        PERIOD_S,
        detection_probability=detection,
        clutter_per_scan=clutter,
        max_range_m=6000.0,
        rotating=True,
    )


def vessels(count=4):
    """Vessels a kilometre apart; every second one turns."""
    return {
        f"vessel {k}": Truth(
            [1500.0, 5.0, 1000.0 * k - 1500.0, 5.0],
            [Segment(60.0), Segment(60.0, 0.03 * (k % 2))],
        )
        for k in range(count)
    }


def scans(count=40, seed=1, truths=None, own=None, **radar):
    truths = vessels() if truths is None else truths
    (episode,) = simulator(**radar).record(truths, count, seed, own=own)
    return episode.scans


def feed(tracker, scan):
    return tracker.process(
        scan.time_s,
        range_m=scan.range_m,
        bearing_rad=scan.bearing_rad,
        plot_time_s=scan.plot_time_s,
        own_north_m=scan.own_north_m,
        own_east_m=scan.own_east_m,
    )


def track_all(recorded, tracker=None):
    """The tables of tracks after each scan."""
    tracker = tracker or wl.Tracker(RADAR)
    tables = []
    for scan in recorded:
        feed(tracker, scan)
        tables.append(tracker.tracks(tentative=True))
    return tables


def assert_same(tables, others):
    for table, other in zip(tables, others, strict=True):
        for column in TABLE:
            np.testing.assert_array_equal(getattr(table, column), getattr(other, column))
        assert table.status == other.status
        assert table.name == other.name


def tracker_after(count=20):
    tracker = wl.Tracker(RADAR)
    track_all(scans(count), tracker)
    return tracker


# --- life -------------------------------------------------------------------------------------


def test_each_vessel_has_one_track_that_knows_where_it_is():
    recorded = scans(60)
    table = track_all(recorded)[-1]
    shown = np.isin(table.status, ["confirmed", "coasting"])
    end_s = recorded[-1].time_s
    for truth in vessels().values():
        distance = [
            np.hypot(*(mean[[0, 2]] - truth.state_at(time)[0, [0, 2]]))
            for mean, time in zip(table.mean[shown], table.time_s[shown], strict=True)
        ]
        assert (np.array(distance) < 60.0).sum() == 1
        assert truth.state_at(end_s).shape == (1, 4)


def test_what_is_seen_from_a_moving_own_ship_is_tracked_over_ground():
    own = Truth([0.0, 6.0, 0.0, -4.0], [Segment(50.0), Segment(100.0, 0.01)])
    truths = {"one": Truth([1500.0, 4.0, -800.0, 3.0])}
    recorded = scans(50, truths=truths, own=own, clutter=0.0, detection=1.0)
    table = track_all(recorded)[-1]
    assert table.status == ["confirmed"]
    wanted = truths["one"].state_at(table.time_s[0])[0]
    error = table.mean[0] - wanted
    assert np.hypot(error[0], error[2]) < 40.0
    assert np.hypot(error[1], error[3]) < 3.0


@pytest.mark.parametrize("pattern", ["10", "1100", "1110100010", "1111100000"])
def test_a_target_seen_in_five_of_ten_scans_is_held(pattern):
    truth = Truth([1500.0, 4.0, -800.0, 3.0])
    time_s, z = simulator(1.0, 0.0).observe(truth, 110, 7)
    tracker = wl.Tracker(RADAR)
    for k, (range_m, bearing_rad) in enumerate(z):
        seen = k < 10 or pattern[k % len(pattern)] == "1"
        plots = {"range_m": [range_m] * seen, "bearing_rad": [bearing_rad] * seen}
        tracker.process((k + 1) * PERIOD_S, **plots, plot_time_s=[time_s[k]] * seen)
        table = tracker.tracks(tentative=True)
        if k >= 10:
            assert list(table.track_id) == [1], f"scan {k}"
            place = truth.state_at(table.time_s[0])[0, [0, 2]]
            assert np.hypot(*(table.mean[0, [0, 2]] - place)) < 100.0


def test_events_report_the_life_of_a_track():
    truths = {"one": Truth([1500.0, 4.0, -800.0, 3.0])}
    recorded = scans(20, truths=truths, clutter=0.0, detection=1.0)
    tracker = wl.Tracker(RADAR)
    events = [event for scan in recorded for event in feed(tracker, scan).events]
    for k in range(60):
        events += tracker.process(
            recorded[-1].time_s + (k + 1) * PERIOD_S, range_m=[], bearing_rad=[]
        ).events
    kinds = [event.kind for event in events]
    assert kinds == ["started", "confirmed", "coasting", "lost"]
    confirmed = events[1]
    assert confirmed.track_id > 0
    assert confirmed.tentative_id == events[0].tentative_id < 0
    assert {event.track_id for event in events[1:]} == {confirmed.track_id}
    assert (np.diff([event.time_s for event in events]) > 0.0).all()
    assert len(tracker.tracks(tentative=True)) == 0


def test_a_report_says_whose_each_plot_is():
    tracker = tracker_after()
    recorded = scans(21)
    report = feed(tracker, recorded[20])
    table = tracker.tracks(tentative=True)
    assert report.plot_track_id.shape == (len(recorded[20]),)
    for plot, track in zip(recorded[20].position_m, report.plot_track_id, strict=True):
        if track > 0:
            place = table.mean[list(table.track_id).index(track)][[0, 2]]
            assert np.hypot(*(plot - place)) < 200.0


def test_tracks_at_a_later_time_are_predictions():
    tracker = tracker_after()
    now, later = tracker.tracks(), tracker.tracks(time_s=1000.0)
    np.testing.assert_array_equal(later.time_s, 1000.0)
    np.testing.assert_array_equal(later.track_id, now.track_id)
    grown = np.trace(later.covariance, axis1=1, axis2=2) - np.trace(
        now.covariance, axis1=1, axis2=2
    )
    assert (grown > 0.0).all()
    np.testing.assert_array_equal(tracker.tracks().mean, now.mean)  # looking changes nothing


def test_all_tracks_are_of_the_time_of_the_last_scan():
    tracker = wl.Tracker(RADAR)
    for k in range(20):  # 15 m/s, seen as each turn begins; the turn ends 2.4 s later
        time_s = PERIOD_S * k
        tracker.process(
            time_s + 2.4,
            range_m=[1000.0 + 15.0 * time_s, 2000.0],
            bearing_rad=[0.0, 1.0],
            plot_time_s=[time_s, time_s + 1.0],
        )
    table = tracker.tracks()
    assert list(table.time_s) == [tracker.time_s] * 2
    np.testing.assert_allclose(table.mean[0, [0, 2]], [1748.5, 0.0], atol=2.0)
    back = tracker.tracks(time_s=PERIOD_S * 19)
    assert list(back.time_s) == [PERIOD_S * 19] * 2
    np.testing.assert_allclose(back.mean[0, [0, 2]], [1712.5, 0.0], atol=2.0)


def test_a_track_above_the_speed_limit_is_held_or_lost_for_that_reason():
    for speed_mps, lost in ((25.5, []), (33.0, ["too_fast"])):
        tracker, range_m, reasons = wl.Tracker(RADAR), 1500.0, []
        for k in range(60):
            range_m += PERIOD_S * (speed_mps if 25 <= k < 45 else 15.0)
            for event in tracker.process(PERIOD_S * k, range_m=[range_m], bearing_rad=[0.3]).events:
                assert bool(event.reason) == (event.kind == "lost")
                if event.kind == "lost" and event.track_id > 0:
                    reasons.append(event.reason)
        assert reasons == lost


def test_events_of_lost_tracks_have_a_reason():
    tracker = tracker_after()
    events = []
    for _ in range(40):
        report = tracker.process(tracker.time_s + PERIOD_S, range_m=[], bearing_rad=[])
        events += [event for event in report.events if event.kind == "lost"]
    assert {event.reason for event in events if event.track_id > 0} == {"missed"}
    assert all("missed" in repr(event) for event in events if event.track_id > 0)


def test_a_full_tracker_says_so_once():
    tracker = wl.Tracker(RADAR, wl.TrackerConfig(max_tracks=3))
    bearing_rad = np.linspace(0.0, 3.0, 5)
    kinds = [
        event.kind
        for k in range(10)
        for event in tracker.process(
            PERIOD_S * k, range_m=np.full(5, 2e3), bearing_rad=bearing_rad
        ).events
    ]
    assert kinds.count("full") == 1


@pytest.mark.parametrize("association", ["probabilistic", "global_nearest", "nearest"])
def test_every_association_tracks(association):
    tracker = wl.Tracker(RADAR, wl.TrackerConfig(association=association))
    table = track_all(scans(40, clutter=0.5), tracker)[-1]
    assert (np.array(table.status) != "tentative").sum() == 4


# --- the operator -----------------------------------------------------------------------------


def test_a_designated_track_is_there_at_once_and_ends_when_dropped():
    tracker = wl.Tracker(RADAR)
    track_id = tracker.designate(0.0, 1000.0, -500.0, position_std_m=30.0)
    assert track_id > 0
    table = tracker.tracks()
    assert list(table.track_id) == [track_id]
    assert table.status == ["confirmed"]
    np.testing.assert_allclose(table.mean[0], [1000.0, 0.0, -500.0, 0.0])
    np.testing.assert_allclose(np.diag(table.covariance[0])[[0, 2]], 900.0)
    assert tracker.drop(track_id)
    assert not tracker.drop(track_id)
    assert len(tracker.tracks(tentative=True)) == 0


def test_designating_a_tracked_vessel_confirms_its_track():
    for count in (2, 20):
        tracker = wl.Tracker(RADAR)
        for k in range(count):
            tracker.process(PERIOD_S * k, range_m=[2000.0 + 5.0 * k], bearing_rad=[0.0])
        time_s = PERIOD_S * (count - 1)
        assert tracker.designate(time_s, 2010.0 + 5.0 * (count - 1), 10.0) == 1
        for k in range(count, count + 10):
            tracker.process(PERIOD_S * k, range_m=[2000.0 + 5.0 * k], bearing_rad=[0.0])
        assert list(tracker.tracks(tentative=True).track_id) == [1]


def test_a_vessel_dropped_with_hush_does_not_come_back_until_it_is_designated():
    def scan(k):
        return tracker.process(PERIOD_S * k, range_m=[2000.0 + 5.0 * k], bearing_rad=[0.0])

    tracker = wl.Tracker(RADAR)
    for k in range(10):
        scan(k)
    assert not tracker.drop(7, hush=True)
    assert tracker.drop(1, hush=True)
    for k in range(10, 40):
        report = scan(k)
        assert not report.events
        assert list(report.plot_track_id) == [0]
        assert len(tracker.tracks(tentative=True)) == 0
    assert tracker.designate(PERIOD_S * 39, 2195.0, 0.0) == 1
    assert list(tracker.tracks().track_id) == [1]


def test_a_designated_track_takes_the_plots_that_come():
    truth = Truth([1500.0, 4.0, -800.0, 3.0])
    tracker = wl.Tracker(RADAR)
    track_id = tracker.designate(0.0, 1500.0, -800.0)
    table = track_all(scans(20, truths={"one": truth}, clutter=0.0), tracker)[-1]
    assert track_id in table.track_id
    mean = table.mean[list(table.track_id).index(track_id)]
    assert np.hypot(*(mean - truth.state_at(table.time_s[0])[0])[[0, 2]]) < 40.0


def test_a_target_far_from_the_time_of_the_last_scan_is_not_designated():
    tracker = wl.Tracker(RADAR)
    no_plots = {"range_m": [], "bearing_rad": []}
    tracker.process(100.0, **no_plots)
    before = tracker.save()
    with pytest.raises(ValueError, match=r"within an hour of the last scan, at 100\."):
        tracker.designate(3701.0, 1000.0, 0.0)
    with pytest.raises(ValueError, match="within an hour"):
        tracker.designate(-3501.0, 1000.0, 0.0)
    assert tracker.save() == before
    assert tracker.designate(3700.0, 1000.0, 0.0) == 1
    tracker.process(3700.0, **no_plots)
    assert tracker.designate(7300.0, 1000.0, 0.0) == 2


def test_an_error_of_own_ships_place_is_one_of_all_plots():
    def variance(**own):
        tracker = wl.Tracker(RADAR)
        for k in range(30):
            tracker.process(PERIOD_S * k, range_m=[2000.0], bearing_rad=[0.3], **own)
        table = tracker.tracks()
        assert len(table) == 1
        return table.covariance[0][0, 0]

    assert variance(own_position_std_m=0.0) == variance()
    assert variance(own_position_std_m=40.0) > 2.0 * variance()
    for wrong in (-1.0, np.nan, np.inf):
        with pytest.raises(ValueError, match="own_position_std_m must be"):
            variance(own_position_std_m=wrong)


def test_names_are_the_operators():
    tracker = wl.Tracker(RADAR)
    track_id = tracker.designate(0.0, 1000.0, 0.0)
    assert tracker.rename(track_id, "Fähre 7")
    assert tracker.tracks().name == ["Fähre 7"]
    assert tracker.rename(track_id, "x" * 100)
    assert tracker.tracks().name == ["x" * 31]
    assert not tracker.rename(track_id + 1, "nobody")


@settings(max_examples=100)
@given(st.binary(max_size=40))
def test_a_name_of_bytes_is_utf_8_or_rejected(name):
    tracker = wl.Tracker(RADAR)
    track_id = tracker.designate(0.0, 1000.0, 0.0)
    try:
        text = name.decode()
    except UnicodeDecodeError:
        with pytest.raises(ValueError, match="name must be UTF-8"):
            tracker.rename(track_id, name)
        assert tracker.tracks().name == [""]
    else:
        assert tracker.rename(track_id, name)
        kept = tracker.tracks().name[0]
        assert text.startswith(kept)
        assert len(kept.encode()) <= 31


def test_a_name_is_cut_between_letters():
    tracker = wl.Tracker(RADAR)
    track_id = tracker.designate(0.0, 1000.0, 0.0)
    assert tracker.rename(track_id, "é" * 16)  # 32 bytes, 31 are kept: half a letter
    assert tracker.tracks().name == ["é" * 15]


@pytest.mark.parametrize(
    "place",
    [
        {"north_m": np.nan, "east_m": 0.0},
        {"north_m": 0.0, "east_m": np.inf},
        {"north_m": 0.0, "east_m": 0.0, "position_std_m": 0.0},
        {"north_m": 0.0, "east_m": 0.0, "position_std_m": -1.0},
        {"north_m": 0.0, "east_m": 0.0, "position_std_m": np.inf},
        {"time_s": np.nan, "north_m": 0.0, "east_m": 0.0},
        {"north_m": 1e300, "east_m": 0.0},
        {"north_m": 0.0, "east_m": -2e9},
        {"north_m": 0.0, "east_m": 0.0, "position_std_m": 1e200},
    ],
)
def test_a_designation_that_is_invalid_is_rejected(place):
    tracker = wl.Tracker(RADAR)
    with pytest.raises(ValueError, match="must be finite"):
        tracker.designate(**({"time_s": 0.0} | place))
    assert len(tracker.tracks(tentative=True)) == 0


def test_when_there_is_no_room_for_more():
    tracker = wl.Tracker(RADAR, wl.TrackerConfig(max_tracks=2))
    assert tracker.designate(0.0, 1000.0, 0.0) > 0
    assert tracker.designate(0.0, 2000.0, 0.0) > 0
    assert tracker.designate(0.0, 3000.0, 0.0) == 0
    assert len(tracker.tracks()) == 2


# --- save and restore -------------------------------------------------------------------------


def test_a_restored_tracker_continues_bit_for_bit():
    recorded = scans(40)
    saved = wl.Tracker(RADAR)
    track_all(recorded[:17], saved)
    saved.rename(int(saved.tracks().track_id[0]), "first")
    state = saved.save()
    restored = wl.Tracker(RADAR)
    restored.restore(state)
    assert restored.save() == state
    assert_same(track_all(recorded[17:], saved), track_all(recorded[17:], restored))
    assert restored.save() == saved.save()


def test_a_tracker_that_was_never_used_saves_too():
    tracker = tracker_after()
    tracker.restore(wl.Tracker(RADAR).save())
    assert len(tracker.tracks(tentative=True)) == 0


@pytest.mark.parametrize(
    "other",
    [
        wl.Tracker(wl.Radar(**(RADAR.as_dict() | {"period_s": 3.0}))),
        wl.Tracker(RADAR, wl.TrackerConfig(confirm_hits=4)),
        wl.Tracker(RADAR, wl.TrackerConfig(max_tracks=100)),
        wl.Tracker(RADAR, wl.TrackerConfig(association="nearest")),
        wl.Tracker(RADAR, models=wl.VesselModels(steady_psd_m2s3=0.5)),
        wl.Tracker(RADAR, models=wl.VesselModels(turning_sojourn_s=99.0)),
        wl.Tracker(RADAR, estimator=wl.Imm([wl.Ekf(wl.ConstantVelocity())], wl.ModeChain([[1]]))),
    ],
    ids=["radar", "confirm", "room", "association", "models", "chain", "estimator"],
)
def test_a_state_is_rejected_by_other_settings(other):
    before = other.save()
    with pytest.raises(ValueError, match="same settings"):
        other.restore(tracker_after().save())
    assert other.save() == before


@settings(max_examples=50)
@given(st.data())
def test_a_damaged_state_is_rejected_or_harmless(data):
    state = bytearray(STATE)
    place = data.draw(st.integers(0, len(state) - 1))
    if data.draw(st.booleans()):
        state = state[:place]
    else:
        state[place] ^= data.draw(st.integers(1, 255))
    tracker = wl.Tracker(RADAR)
    before = tracker.save()
    try:
        tracker.restore(bytes(state))
    except ValueError:
        assert tracker.save() == before
    else:
        feed(tracker, LATER)  # whatever it holds, it does not crash
        tracker.tracks(tentative=True)


STATE = tracker_after().save()
LATER = scans(21)[20]


@pytest.mark.parametrize("state", [b"", b"no state", STATE + b"\0"])
def test_what_is_no_state_is_rejected(state):
    with pytest.raises(ValueError, match="state was not saved by a tracker with the same settings"):
        wl.Tracker(RADAR).restore(state)


# --- bad input --------------------------------------------------------------------------------


def test_time_backwards_is_an_error_that_changes_nothing():
    tracker = tracker_after()
    before = tracker.save()
    with pytest.raises(wl.FilterError, match=r"backwards|time step"):
        tracker.process(-1.0, range_m=[1000.0], bearing_rad=[0.1])
    assert tracker.save() == before


@pytest.mark.parametrize("time_s", [np.nan, np.inf, -np.inf])
def test_a_time_that_is_not_finite_is_an_error(time_s):
    tracker = wl.Tracker(RADAR)
    with pytest.raises(wl.FilterError, match="finite"):
        tracker.process(time_s, range_m=[], bearing_rad=[])


def test_a_scan_far_ahead_is_an_error_that_changes_nothing():
    tracker = tracker_after()
    before, time_s = tracker.save(), tracker.time_s
    assert tracker.latest_time_s == time_s + 3600.0
    for ahead_s in (3600.1, 1e9):
        with pytest.raises(wl.FilterError, match="an hour after the last scan"):
            tracker.process(time_s + ahead_s, range_m=[], bearing_rad=[])
    assert tracker.save() == before
    tracker.process(tracker.latest_time_s, range_m=[], bearing_rad=[])


@pytest.mark.parametrize("own", [{"own_north_m": 1e308}, {"own_east_m": -1e300}])
def test_plots_of_an_own_ship_out_of_range_are_rejected(own):
    tracker = tracker_after()
    for k in range(5):
        report = tracker.process(tracker.time_s + PERIOD_S, range_m=[1e3], bearing_rad=[0.1], **own)
        assert report.rejected_plots == 1, k
    assert np.isfinite(tracker.tracks(tentative=True).mean).all()


@pytest.mark.parametrize("wrong", [-0.01, np.nan, np.inf])
def test_an_error_of_the_heading_that_is_none_is_an_error(wrong):
    with pytest.raises(ValueError, match="heading_std_rad must be"):
        wl.Tracker(RADAR).process(0.0, range_m=[1e3], bearing_rad=[0.1], heading_std_rad=wrong)


def test_plots_that_are_invalid_are_rejected_and_counted():
    tracker = wl.Tracker(RADAR)
    report = tracker.process(
        0.0,
        range_m=[1000.0, np.nan, np.inf, -5.0, 1000.0, 1000.0],
        bearing_rad=[0.1, 0.1, 0.1, 0.1, np.nan, 0.1],
        plot_time_s=[0.0, 0.0, 0.0, 0.0, 0.0, np.nan],
    )
    assert report.rejected_plots == 5
    np.testing.assert_array_equal(report.plot_track_id[1:], 0)


def test_rejected_plots_leave_no_trace():
    recorded = scans(25)
    clean = track_all(recorded)
    tracker, tables = wl.Tracker(RADAR), []
    for scan in recorded:
        report = tracker.process(
            scan.time_s,
            range_m=np.append(scan.range_m, np.nan),
            bearing_rad=np.append(scan.bearing_rad, 0.0),
            plot_time_s=np.append(scan.plot_time_s, scan.time_s),
        )
        assert report.rejected_plots == 1
        tables.append(tracker.tracks(tentative=True))
    assert_same(clean, tables)


@pytest.mark.parametrize("kind", ["empty scans", "same time", "at the radar", "one place"])
def test_odd_scans_leave_no_nan(kind):
    tracker = tracker_after()
    time_s = scans(20)[-1].time_s
    for k in range(1, 8):
        if kind == "empty scans":
            tracker.process(time_s + 3600.0 * k, range_m=[], bearing_rad=[])
        elif kind == "same time":
            tracker.process(time_s, range_m=[1500.0, 2000.0], bearing_rad=[0.1, 0.4])
        elif kind == "at the radar":
            tracker.process(time_s + k * PERIOD_S, range_m=[0.0, 1e-9], bearing_rad=[0.0, 3.0])
        else:
            tracker.process(
                time_s + k * PERIOD_S, range_m=np.full(50, 1e3), bearing_rad=np.ones(50)
            )
        table = tracker.tracks(tentative=True)
        assert np.isfinite(table.mean).all()
        assert np.isfinite(table.covariance).all()
        assert np.isfinite(table.existence).all()


def test_ten_thousand_plots_in_a_scan():
    rng = np.random.default_rng(2)
    tracker = wl.Tracker(RADAR)
    for k in range(4):
        report = tracker.process(
            k * PERIOD_S,
            range_m=rng.uniform(100.0, 20_000.0, 10_000),
            bearing_rad=rng.uniform(-np.pi, np.pi, 10_000),
        )
        assert report.rejected_plots == 0
        assert report.plot_track_id.shape == (10_000,)
    table = tracker.tracks(tentative=True)
    assert len(table) <= tracker.config.max_tracks
    assert np.isfinite(table.mean).all()


def test_plots_beyond_the_room_are_rejected_and_counted():
    tracker = wl.Tracker(RADAR, wl.TrackerConfig(max_plots=5))
    report = tracker.process(0.0, range_m=np.full(8, 1e3), bearing_rad=np.linspace(0, 1, 8))
    assert report.rejected_plots == 3
    assert report.plot_track_id.shape == (8,)


@given(hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=5))
def test_plots_of_wrong_shape_name_wanted_and_given(shape):
    tracker = wl.Tracker(RADAR)
    if len(shape) != 1:
        with pytest.raises(ValueError, match=r"range_m must have shape \(n,\)") as error:
            tracker.process(0.0, range_m=np.ones(shape), bearing_rad=0.0)
        assert f"got {shape}" in str(error.value)
    for name in ("bearing_rad", "plot_time_s", "own_north_m", "own_east_m"):
        if shape in ((), (3,)):
            continue
        columns = {"range_m": np.ones(3), "bearing_rad": np.ones(3), name: np.ones(shape)}
        with pytest.raises(ValueError, match=rf"{name} must have shape \(3,\)") as error:
            tracker.process(0.0, **columns)
        assert f"got {shape}" in str(error.value)


@pytest.mark.parametrize("name", ["plot_time_s", "own_north_m", "own_east_m"])
@pytest.mark.parametrize("value", ["east", [[1.0], [2.0, 3.0]], None])
def test_columns_that_are_no_numbers_are_rejected_by_name(name, value):
    if name == "plot_time_s" and value is None:
        return  # the time of the scan
    wanted = f"{name} must be a number or an array, got {re.escape(repr(value))}"
    with pytest.raises(TypeError, match=wanted):
        wl.Tracker(RADAR).process(0.0, range_m=[1e3], bearing_rad=[0.1], **{name: value})


def test_tracks_at_no_time_are_rejected():
    with pytest.raises(ValueError, match="time_s must be finite, got nan"):
        wl.Tracker(RADAR).tracks(time_s=np.nan)


# --- settings ---------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", SETTINGS)
def test_a_misspelt_attribute_is_an_error(kind):
    with pytest.raises(AttributeError):
        kind().no_such_setting = 1.0


@pytest.mark.parametrize(
    ("kind", "name", "value"),
    [
        (wl.Radar, "range_std_m", 0.0),
        (wl.Radar, "bearing_std_rad", -1.0),
        (wl.Radar, "period_s", np.nan),
        (wl.Radar, "max_speed_mps", np.inf),
        (wl.Radar, "bearing_offset_rad", np.nan),
        (wl.TrackerConfig, "detection_probability", 1.5),
        (wl.TrackerConfig, "gate_probability", 1.0),
        (wl.TrackerConfig, "clutter_density_per_m2", 0.0),
        (wl.TrackerConfig, "confirm_hits", 0),
        (wl.TrackerConfig, "confirm_window", 2),
        (wl.TrackerConfig, "max_tracks", 0),
        (wl.TrackerConfig, "max_plots", -1),
        (wl.TrackerConfig, "association", "nearby"),
        (wl.VesselModels, "steady_psd_m2s3", -1.0),
        (wl.VesselModels, "turning_sojourn_s", 0.0),
    ],
)
def test_a_setting_that_is_invalid_is_rejected_by_name(kind, name, value):
    with pytest.raises(ValueError, match=name):
        kind(**{name: value})


def test_the_settings_of_a_tracker_are_a_copy():
    config = wl.TrackerConfig(max_tracks=10)
    tracker = wl.Tracker(RADAR, config)
    config.max_tracks = 99
    with pytest.raises(AttributeError, match="max_tracks"):
        tracker.config.max_tracks = 99
    with pytest.raises(AttributeError, match="period_s"):
        tracker.radar.period_s = 99.0
    assert tracker.config.max_tracks == 10
    assert tracker.radar == RADAR


# --- other estimators, threads ----------------------------------------------------------------


def test_the_usual_estimator_given_by_hand_gives_the_same_bits():
    recorded = scans(25)
    by_hand = wl.Tracker(RADAR, estimator=wl.vessel_imm(RADAR))
    assert_same(track_all(recorded), track_all(recorded, by_hand))


def test_models_of_ships_are_those_of_the_estimator_for_ships():
    recorded, ships = scans(25), wl.VesselModels.ships()
    reported = wl.Tracker(RADAR, models=ships)
    by_hand = wl.Tracker(RADAR, estimator=wl.vessel_imm(RADAR, ships))
    assert_same(track_all(recorded, reported), track_all(recorded, by_hand))
    assert ships != wl.VesselModels()


@pytest.mark.filterwarnings("ignore:the ModeChain has no period")
def test_a_track_reports_the_turn_rates_of_models_that_change_theirs():
    known_turn = wl.Ekf(wl.CoordinatedTurn(noise=wl.WhiteAcceleration(psd_m2s3=0.05)))
    recorded = scans(40, clutter=0.5)
    for estimator in (wl.AdaptiveGridImm(known_turn), wl.LikelyModelSetImm(known_turn)):
        tables = track_all(recorded, wl.Tracker(RADAR, estimator=estimator))
        last = tables[-1]
        assert last.turn_rate_rad_s.shape == last.mode_probability.shape
        at_rest = np.isnan(last.turn_rate_rad_s)
        assert (last.mode_probability[at_rest] == 0.0).all()
        assert np.isfinite(last.turn_rate_rad_s).any(axis=1).all()
        if isinstance(estimator, wl.AdaptiveGridImm):
            assert np.ptp(last.turn_rate_rad_s[:, 1]) > 0.01  # of vessels that turn and do not
    assert track_all(recorded)[-1].turn_rate_rad_s is None
    tree = track_all(scans(5), wl.Tracker(RADAR, estimator=wl.ModeHistory(known_turn)))
    assert tree[-1].turn_rate_rad_s is None


def test_another_estimator_tracks():
    filters = [
        wl.Ukf(wl.ConstantVelocity(noise=wl.WhiteAcceleration(psd_m2s3=0.05))),
        wl.SquareRootUkf(wl.CoordinatedTurnRate()),
        wl.Kalman(wl.Singer()),
        wl.Ekf(wl.ConstantAcceleration()),
    ]
    chain = wl.ModeChain.from_sojourn_s([60.0, 20.0, 20.0, 20.0])
    tracker = wl.Tracker(RADAR, estimator=wl.Imm(filters, chain))
    table = track_all(scans(40, clutter=0.5), tracker)[-1]
    assert table.mode_probability.shape == (len(table), len(filters))
    assert (np.array(table.status) != "tentative").sum() == 4
    np.testing.assert_allclose(table.mode_probability.sum(axis=1), 1.0, atol=1e-12)


def test_a_chain_without_a_period_warns_in_a_tracker():
    filters = [wl.Ekf(wl.ConstantVelocity()), wl.Ekf(wl.CoordinatedTurnRate())]
    matrix = [[0.95, 0.05], [0.1, 0.9]]
    with pytest.warns(UserWarning, match="no period"):
        wl.Tracker(RADAR, estimator=wl.Imm(filters, wl.ModeChain(matrix)))
    wl.Tracker(RADAR, estimator=wl.Imm(filters, wl.ModeChain(matrix, period_s=3.0)))


def test_one_tracker_a_thread_is_as_good_as_one_after_the_other():
    recordings = [scans(30, seed) for seed in range(6)]
    serial = [track_all(recorded) for recorded in recordings]
    with ThreadPoolExecutor(3) as pool:
        parallel = list(pool.map(track_all, recordings))
    for one, other in zip(serial, parallel, strict=True):
        assert_same(one, other)


def test_many_runs_in_threads_are_the_same_too():
    z = np.column_stack([np.full(2000, 5000.0), np.full(2000, 0.5)])
    start = wl.Gaussian([4400.0, 0.0, 2400.0, 0.0], np.diag([1e4, 25.0, 1e4, 25.0]))
    sensor = wl.RangeBearing(range_std_m=30.0, bearing_std_rad=0.01)

    def run(_):
        return wl.vessel_imm(RADAR).run(z, dt_s=1.0, sensor=sensor, start=start).mean

    wanted = run(0)
    with ThreadPoolExecutor(3) as pool:
        for mean in pool.map(run, range(6)):
            np.testing.assert_array_equal(mean, wanted)
