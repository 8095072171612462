"""The strobe tracker on simulated radar video."""

import copy
import pickle
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from wakeline import scenario

PERIOD_S, SCANS = 2.5, 14
RADAR = wl.Radar(
    range_std_m=4.0, bearing_std_rad=np.deg2rad(0.2), period_s=PERIOD_S, max_speed_mps=20.0
)
CONFIG = wl.StrobeTrackerConfig(least_amplitude=40, radius_m=60.0)


def ship(north_m, east_m, vnorth_mps, veast_mps):
    truth = scenario.Truth([north_m, vnorth_mps, east_m, veast_mps])
    return scenario.VideoTarget(truth=truth, length_m=40.0, beam_m=10.0, rcs_m2=10.0, swerling=0)


SHIPS = [ship(1500.0, -60.0, 0.0, 8.0), ship(-900.0, 1200.0, 6.0, 5.0)]


@pytest.fixture(scope="module")
def turns():
    radar = scenario.RadarVideoSimulator(
        sweeps_per_turn=720,
        cells=300,
        cell_m=10.0,
        period_s=PERIOD_S,
        beam_width_rad=np.deg2rad(1.5),
        pulse_length_m=20.0,
        snr_db=12.0,
    )
    return list(radar.turns({str(k): ship for k, ship in enumerate(SHIPS)}, SCANS, seed=1))


def place(ship, time_s):
    return ship.truth.state_at(time_s)[..., [0, 2]].reshape(-1, 2)


def designated(tracker, turns):
    begin_s = float(turns[0].time_s[0])
    return [tracker.designate(begin_s, *place(ship, begin_s)[0]) for ship in SHIPS]


@pytest.mark.parametrize(
    "estimator", [None, wl.BayesianAlphaBeta(), wl.FuzzyAlphaBeta(), wl.vessel_imm(RADAR)]
)
def test_designated_vessels_are_followed_with_any_estimator(turns, estimator):
    tracker = wl.StrobeTracker(RADAR, CONFIG, estimator)
    ids = designated(tracker, turns)
    readings = [tracker.process(turn) for turn in turns]
    table = tracker.tracks()
    assert table.track_id.tolist() == ids
    assert table.status == ["confirmed"] * 2
    for k, target in enumerate(SHIPS):
        off_m = table.mean[k, [0, 2]] - place(target, table.time_s[k])[0]
        assert np.linalg.norm(off_m) < 10.0
        mine = np.concatenate([r.position_m[r.track_id == ids[k]] for r in readings])
        when_s = np.concatenate([r.time_s[r.track_id == ids[k]] for r in readings])
        assert len(mine) >= SCANS - 1
        assert np.linalg.norm(mine - place(target, when_s), axis=1).max() < 25.0
    later = tracker.tracks(time_s=turns[-1].time_s[-1] + 10.0)
    np.testing.assert_allclose(
        later.mean[:, 0] - table.mean[:, 0],
        table.mean[:, 1] * (later.time_s - table.time_s),
        atol=15.0,
    )


@settings(max_examples=15, deadline=None)
@given(cuts=st.lists(st.integers(1, 4 * 720 - 1), max_size=6))
def test_video_may_be_cut_anywhere(turns, cuts):
    whole = wl.StrobeTracker(RADAR, CONFIG)
    pieces = copy_of(whole)
    video = joined(turns[:4])
    for tracker in (whole, pieces):
        designated(tracker, turns)
    at_once = whole.process(video)
    edges = [0, *sorted(set(cuts)), len(video)]
    parts = [pieces.process(video[a:b]) for a, b in pairwise(edges)]
    for name in ("track_id", "time_s", "predicted_m", "range_m", "shared"):
        part = np.concatenate([getattr(readings, name) for readings in parts])
        np.testing.assert_array_equal(part, getattr(at_once, name))
    assert pieces.save() == whole.save()


def copy_of(tracker):
    other = wl.StrobeTracker(tracker.radar, tracker.config)
    other.restore(tracker.save())
    return other


def joined(turns):
    first = turns[0]
    return wl.recording.RadarVideo(
        np.concatenate([turn.amplitude for turn in turns]),
        np.concatenate([turn.azimuth_rad for turn in turns]),
        np.concatenate([turn.time_s for turn in turns]),
        first.azimuth_width_rad,
        first.start_range_m,
        first.cell_m,
    )


def test_vessels_are_acquired_once_from_plots(turns):
    tracker, extractor = wl.StrobeTracker(RADAR, CONFIG), wl.PlotExtractor(min_cells=8)
    events = []
    for turn in turns:
        for first in range(0, len(turn), 60):
            piece = turn[first : first + 60]
            events += tracker.process(piece).events
            tracker.acquire(extractor.process(piece))
    confirmed = [event for event in events if event.kind == "confirmed"]
    assert [event.track_id for event in confirmed] == [1, 2]
    assert all(event.tentative_id < 0 for event in confirmed)
    table = tracker.tracks()
    for target in SHIPS:
        off_m = [
            np.linalg.norm(mean[[0, 2]] - place(target, time_s)[0])
            for mean, time_s in zip(table.mean, table.time_s, strict=True)
        ]
        assert min(off_m) < 12.0


def test_a_moving_own_ship_sees_the_same_tracks(turns):
    still = wl.StrobeTracker(RADAR, CONFIG)
    designated(still, turns)
    moving = wl.StrobeTracker(RADAR, CONFIG)
    begin_s = float(turns[0].time_s[0])
    for target in SHIPS:  # as if both sailed north with own ship
        moving.designate(begin_s, *place(target, begin_s)[0])
    for turn in turns:
        still.process(turn)
        own_m = 15.0 * (turn.time_s - begin_s)
        moving.process(turn, own_north_m=own_m)
    here, there = still.tracks(), moving.tracks()
    way_m = 15.0 * (there.time_s - begin_s)
    np.testing.assert_allclose(there.mean[:, 0] - way_m, here.mean[:, 0], atol=1.0)
    np.testing.assert_allclose(there.mean[:, 2], here.mean[:, 2], atol=1.0)
    np.testing.assert_allclose(there.mean[:, 1] - here.mean[:, 1], 15.0, atol=0.5)
    np.testing.assert_allclose(there.mean[:, 3], here.mean[:, 3], atol=0.5)


def test_land_hides_a_vessel(turns):
    land = wl.LandMask()
    land.exclude_sector(-0.5, 0.5, 1000.0, 2000.0)
    tracker = wl.StrobeTracker(RADAR, CONFIG, land=land)
    designated(tracker, turns)
    lost = [e.track_id for turn in turns for e in tracker.process(turn).events if e.kind == "lost"]
    assert lost == [1]
    assert tracker.tracks().track_id.tolist() == [2]


def test_tables_can_be_pickled(turns):
    tracker = wl.StrobeTracker(RADAR, CONFIG)
    designated(tracker, turns)
    for table in (tracker.process(turns[0]), tracker.tracks()):
        again = pickle.loads(pickle.dumps(table))
        np.testing.assert_array_equal(again.time_s, table.time_s)
        assert again.status == table.status
    assert copy.copy(CONFIG) == CONFIG


def test_a_saved_tracker_goes_on(turns):
    tracker = wl.StrobeTracker(RADAR, CONFIG)
    designated(tracker, turns)
    for turn in turns[:5]:
        tracker.process(turn)
    tracker.process(turns[5][:10])
    other = copy_of(tracker)
    rest = turns[5][10:]
    np.testing.assert_array_equal(tracker.process(rest).range_m, other.process(rest).range_m)
    with pytest.raises(ValueError, match="same settings"):
        wl.StrobeTracker(RADAR, wl.StrobeTrackerConfig()).restore(tracker.save())


def test_what_makes_no_sense_is_rejected(turns):
    with pytest.raises(ValueError, match="radius_m"):
        wl.StrobeTrackerConfig(radius_m=-1.0)
    with pytest.raises(ValueError, match="max_radius_m"):
        wl.StrobeTrackerConfig(radius_m=200.0)
    with pytest.raises(ValueError, match="pedestal"):
        wl.StrobeTrackerConfig(pedestal=1)
    with pytest.raises(ValueError, match="several"):
        wl.StrobeTrackerConfig(several="both")
    with pytest.raises(ValueError, match="bits"):
        wl.StrobeTracker(RADAR, bits=12)
    with pytest.raises(TypeError, match="estimator"):
        wl.StrobeTracker(RADAR, estimator=wl.ConstantVelocity())
    tracker = wl.StrobeTracker(RADAR, CONFIG)
    with pytest.raises(ValueError, match="uint8"):
        wl.StrobeTracker(RADAR, CONFIG, bits=16).process(turns[0])
    with pytest.raises(ValueError, match="own_north_m"):
        tracker.process(turns[0], own_north_m=np.zeros(3))
    with pytest.raises(ValueError, match="position_std_m"):
        tracker.designate(0.0, 1.0, 2.0, position_std_m=0.0)
    with pytest.raises(ValueError, match="north_m"):
        tracker.designate(0.0, np.nan, 2.0)
    assert tracker.process(turns[0][::-1]).rejected_sweeps == len(turns[0]) - 1
