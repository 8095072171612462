"""Zones and alarms of a session: laws of one alarm for each entry, danger, loss and silence."""

import csv
import errno
import io
import itertools
import json
import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl
from wakeline.live.alarms import AlarmConfig, AlarmLog, Alarms, notification
from wakeline.live.lines import append_whole
from wakeline.live.zones import MOST_ZONES, OwnPlace, Zone, Zones

SQUARE = [[0.0, 0.0], [0.0, 100.0], [100.0, 100.0], [100.0, 0.0]]
QUIET = AlarmConfig(lost_target=False, pairs=False)


def table(places, *, std_m=1.0, status="confirmed", velocity=(0.0, 0.0), names=None):
    """Tracks by number: {number: (north, east)}."""
    n = len(places)
    mean = np.array([[p[0], velocity[0], p[1], velocity[1]] for p in places.values()])
    return SimpleNamespace(
        track_id=np.array(list(places), dtype=int),
        mean=mean.reshape(-1, 4),
        covariance=np.tile(np.diag([std_m**2, 0.01, std_m**2, 0.01]), (n, 1, 1)),
        status=np.full(n, status),
        name=np.array(names or [""] * n),
    )


def began(events, kind):
    return [e.alarm for e in events if e.change == "began" and e.alarm.kind == kind]


def ended(events, kind):
    return [e.alarm for e in events if e.change == "ended" and e.alarm.kind == kind]


# Zones --------------------------------------------------------------------------------------------

PLACE = st.tuples(st.floats(-200.0, 300.0), st.floats(-200.0, 300.0))
WALK = st.lists(st.one_of(st.none(), PLACE), min_size=1, max_size=25)


@given(walks=st.lists(WALK, min_size=1, max_size=6), hysteresis_m=st.floats(0.0, 50.0))
def test_a_track_has_the_alarms_that_it_would_have_alone(walks, hysteresis_m):
    """No track hides another one, in whatever order they enter, leave and end."""

    def entries(numbers):
        zone = Zone(outline_m=SQUARE, hysteresis_m=hysteresis_m)
        alarms = Alarms(zones=[zone], config=QUIET)
        found = []
        for t in range(max(map(len, walks))):
            here = {
                k: walks[k - 1][t]
                for k in numbers
                if t < len(walks[k - 1]) and walks[k - 1][t] is not None
            }
            events = alarms.update(float(t), table(here))
            found += [
                (e.time_s, e.change, e.alarm.tracks) for e in events if e.alarm.kind == "zone entry"
            ]
        return sorted(found)

    everyone = range(1, len(walks) + 1)
    assert entries(everyone) == sorted(one for k in everyone for one in entries([k]))


@given(
    visits=st.lists(st.booleans(), min_size=1, max_size=30),
    others=st.integers(0, 5),
    noise_m=st.floats(0.0, 9.0),
)
def test_one_alarm_for_each_visit_and_none_from_noise_at_the_edge(visits, others, noise_m):
    alarms = Alarms(zones=[Zone(outline_m=SQUARE, hysteresis_m=20.0)], config=QUIET)
    counted, inside, turn = 0, False, 0
    for inside_now in visits:
        for wobble in (noise_m, -noise_m, noise_m):
            # inside: about the edge; outside: far beyond the hysteresis
            places = {1: (wobble if inside_now else -60.0 + wobble, 50.0)}
            places |= {k + 2: (50.0, 50.0) for k in range(others)}
            events = alarms.update(float(turn), table(places))
            counted += len([a for a in began(events, "zone entry") if a.tracks == (1,)])
            turn += 1
    expected = 0
    for inside_now in visits:
        expected += inside_now and not inside
        inside = inside_now
    assert counted == expected


@given(
    angle=st.floats(-7.0, 7.0),
    width=st.floats(0.05, 6.2),
    near_m=st.floats(0.0, 500.0),
    deep_m=st.floats(1.0, 500.0),
    place=st.tuples(st.floats(-1200.0, 1200.0), st.floats(-1200.0, 1200.0)),
    heading=st.floats(-4.0, 4.0),
)
def test_a_sector_is_its_polygon(angle, width, near_m, deep_m, place, heading):
    """Depth in a sector, turned with the bow, against a fine polygon of the same outline."""
    zone = Zone(
        near_m=near_m,
        far_m=near_m + deep_m,
        from_rad=angle,
        to_rad=angle + width,
        from_bow=True,
    )
    way = np.linspace(0.0, width, 50) + angle + heading
    arcs = [
        r * np.column_stack([np.cos(w), np.sin(w)])
        for r, w in ((near_m + deep_m, way), (near_m, way[::-1]))
    ]
    outline = Zone(outline_m=np.concatenate(arcs) + np.array([10.0, -20.0]))
    own = OwnPlace(10.0, -20.0, heading)
    there = np.array([place]) + np.array([10.0, -20.0])
    coarse_m = (near_m + deep_m) * (1.0 - math.cos(width / 98.0)) + 1e-6
    got, wanted = zone.depth_m(there, own)[0], outline.depth_m(there)[0]
    assert abs(abs(got) - abs(wanted)) <= coarse_m
    assert np.sign(got) == np.sign(wanted) or abs(wanted) <= coarse_m


@given(place=PLACE)
def test_inside_a_polygon_is_as_for_danger_zones(place):
    outline = [[0.0, 0.0], [150.0, 20.0], [90.0, 90.0], [200.0, 160.0], [-20.0, 180.0]]
    inside = wl.DangerZone("harbor", outline, wl.DangerLimits()).contains(*place)
    depth_m = Zone(outline_m=outline).depth_m(place)[0]
    assert (depth_m >= 0.0) == inside or abs(depth_m) < 1e-9


def test_born_inside_and_a_zone_about_a_track():
    alarms = Alarms(zones=[Zone(outline_m=SQUARE, name="gate")], config=QUIET)
    (alarm,) = began(alarms.update(0.0, table({7: (50.0, 50.0)})), "zone entry")
    assert alarm.tracks == (7,)
    assert "inside" in alarm.text
    alarms.set_zone(Zone(outline_m=SQUARE, name="second"))
    (alarm,) = began(alarms.update(1.0, table({7: (50.0, 50.0)})), "zone entry")
    assert "inside" in alarm.text
    assert began(alarms.update(2.0, table({7: (50.0, 50.0)})), "zone entry") == []


def test_a_target_that_is_hidden_while_a_radar_is_silent_stays_in_its_zone():
    alarms = Alarms(zones=[Zone(outline_m=SQUARE)], config=QUIET)
    inside, nothing = table({1: (50.0, 50.0)}), table({})
    (alarm,) = began(alarms.update(0.0, inside), "zone entry")
    assert alarms.update(10.0, nothing, is_blind=True) == []
    assert alarms.update(20.0, inside, is_blind=True) == []
    assert alarms.active == [alarm]
    (end,) = ended(alarms.update(30.0, nothing), "zone entry")
    assert end.alarm_id == alarm.alarm_id


def test_only_confirmed_tracks_count():
    alarms = Alarms(zones=[Zone(outline_m=SQUARE)], config=QUIET)
    assert alarms.update(0.0, table({1: (50.0, 50.0)}, status="tentative")) == []
    assert len(began(alarms.update(1.0, table({1: (50.0, 50.0)})), "zone entry")) == 1
    assert alarms.update(2.0, table({1: (50.0, 50.0)}, status="coasting")) == []


def test_a_track_has_left_only_beyond_its_own_uncertainty():
    alarms = Alarms(zones=[Zone(outline_m=SQUARE)], config=QUIET)
    alarms.update(0.0, table({1: (50.0, 50.0)}))
    assert alarms.update(1.0, table({1: (-50.0, 50.0)}, std_m=40.0)) == []
    (alarm,) = ended(alarms.update(2.0, table({1: (-50.0, 50.0)}, std_m=20.0)), "zone entry")
    assert alarm.reason == "left"


def test_exit_and_occupancy():
    zone = Zone(outline_m=SQUARE, triggers=["exit", "occupancy"], occupancy_s=3.0)
    alarms = Alarms(zones=[zone], config=QUIET)
    kinds = []
    for t, north_m in enumerate([50.0, 50.0, 50.0, 50.0, 50.0, -50.0, -50.0]):
        for event in alarms.update(float(t), table({1: (north_m, 50.0)})):
            kinds.append((t, event.change, event.alarm.kind))
    assert kinds == [
        (3, "began", "zone occupancy"),
        (5, "ended", "zone occupancy"),
        (5, "began", "zone exit"),
    ]
    assert ended(alarms.update(65.0, table({1: (-50.0, 50.0)})), "zone exit")


def test_a_sector_keeps_its_state_without_own_ship():
    zone = Zone(far_m=500.0)
    alarms = Alarms(zones=[zone], config=QUIET)
    assert began(alarms.update(0.0, table({1: (10.0, 0.0)}), own=[0, 0, 0, 0]), "zone entry")
    assert alarms.update(1.0, table({1: (9e3, 0.0)})) == []
    assert ended(alarms.update(2.0, table({1: (9e3, 0.0)}), own=[0, 0, 0, 0]), "zone entry")


def test_alarms_that_last_have_the_new_name_of_their_zone():
    triggers = ("entry", "exit", "occupancy")
    zone = Zone(name="60 s", outline_m=SQUARE, triggers=triggers, occupancy_s=5.0)
    alarms = Alarms(zones=[zone, Zone(name="other", outline_m=SQUARE)], config=QUIET)
    names = ["60 s", "60 s"]
    for t in (0.0, 6.0):
        alarms.update(t, table({1: (50.0, 50.0), 2: (50.0, 50.0)}, names=names))
    alarms.update(7.0, table({1: (50.0, 50.0), 2: (900.0, 50.0)}, names=names))
    before = {one.alarm_id: one.text for one in alarms.active}
    alarms.set_zone({**alarms.zones[1].as_dict(), "name": "harbor"})
    for one in alarms.list():
        if one["zone_id"] == 1 and one["state"] != "ended":
            assert "harbor" in one["text"]
            assert "60 s (" in one["text"]
            assert one["text"].replace("harbor", "60 s") == before[one["alarm_id"]]
    assert {one.kind for one in alarms.active if "harbor" in one.text} == {
        "zone entry", "zone occupancy", "zone exit",
    }  # fmt: skip
    assert [one.text for one in alarms.active if one.zone_id == 2] == ["60 s (1) is inside other"]


@pytest.mark.parametrize("later_s", [1.0, 100.0])
def test_an_alarm_keeps_its_number_over_a_restart_and_a_later_one_has_another(later_s):
    alarms = Alarms(zones=[Zone(outline_m=SQUARE)], config=QUIET)
    alarms.update(0.0, table({}))
    inside = table({1: (50.0, 50.0)})
    alarms.update(1.0, inside)
    sensors = [("radar A", 99.0, 10.0)]
    alarms.update(2.0, inside, sensors=sensors)
    alarms.acknowledge(1)
    again = Alarms(config=QUIET)
    again.restore(json.loads(json.dumps(alarms.save())))
    again.update(10.0, table({}))
    again.update(10.0 + later_s, inside, sensors=sensors)
    numbers = {one.kind: one.alarm_id for one in again.active}
    acknowledged = {one.kind: one.acknowledged for one in again.active}
    if later_s < 10.0:
        assert numbers == {"zone entry": 1, "sensor lost": 2}
        assert acknowledged == {"zone entry": True, "sensor lost": False}
    else:
        assert sorted(numbers.values()) == [3, 4]
        assert not any(acknowledged.values())


def test_deleting_a_zone_ends_its_alarms():
    alarms = Alarms(zones=[Zone(outline_m=SQUARE)], config=QUIET)
    alarms.update(0.0, table({1: (50.0, 50.0)}))
    assert alarms.delete_zone(1)
    assert not alarms.delete_zone(1)
    (alarm,) = ended(alarms.update(1.0, table({1: (50.0, 50.0)})), "zone entry")
    assert alarm.reason == "zone deleted"
    assert alarms.active == []


def test_exclusion_and_land_keep_plots_out_and_raise_no_alarm():
    guard = Zone(outline_m=[[200, 0], [300, 0], [300, 9]])
    plots_m = np.array([[50.0, 50.0], [150.0, 50.0], [290.0, 2.0]])
    for kind, of_track in (("land", False), ("exclusion", False), ("exclusion", True)):
        zones = Zones([Zone(kind=kind, outline_m=SQUARE), guard])
        kept = zones.kept(plots_m, lambda which: np.full(len(which), of_track))  # noqa: B023
        assert kept.tolist() == [of_track, True, True]
        assert zones.update(0.0, [1], [[50.0, 50.0]], [1.0]) == []


@pytest.mark.parametrize(
    "values",
    [
        {"outline_m": [[0, 0], [1, 1]]},
        {"outline_m": [[0, 0], [1, 1], [math.nan, 2]]},
        {"outline_m": "nonsense"},
        {"outline_m": [[0, 0]] * 101},
        {"near_m": 5.0, "far_m": 5.0},
        {"far_m": math.inf},
        {"far_m": "wide"},
        {"kind": "land", "far_m": 10.0},
        {"kind": "wall", "outline_m": SQUARE},
        {"outline_m": SQUARE, "triggers": ["approach"]},
        {"outline_m": SQUARE, "triggers": 3},
        {"outline_m": SQUARE, "name": "n" * 41},
        {"outline_m": SQUARE, "name": 4},
        {"outline_m": SQUARE, "zone_id": 99},
        {"outline_m": SQUARE, "hysteresis_m": -1.0},
        {"outline_m": SQUARE, "color": "red"},
        ["a", "list"],
    ],
)
def test_a_zone_that_is_none_is_rejected_and_nothing_changes(values):
    zones = Zones()
    with pytest.raises((TypeError, ValueError)):
        zones.set(values)
    assert len(zones) == 0


def test_zones_are_json_both_ways_and_bounded():
    zones = Zones([Zone(outline_m=SQUARE, kind="exclusion"), Zone(far_m=9.0, from_bow=True)])
    for one in json.loads(json.dumps(zones.list())):
        assert one.pop("inside") == []
        again = Zone.of(one)
        assert again.as_dict() == zones[one["zone_id"]].as_dict()
    for _ in range(MOST_ZONES - 2):
        zones.set(Zone(far_m=10.0))
    with pytest.raises(ValueError, match="delete"):
        zones.set(Zone(far_m=10.0))


# Close passings -----------------------------------------------------------------------------------


def meeting(time_s):
    """Two vessels head on, passing at 600 s."""
    there = table({1: (-3000.0 + 5.0 * time_s, 0.0), 2: (3000.0 - 5.0 * time_s, 20.0)})
    there.mean[:, 1] = [5.0, -5.0]
    return there


def test_one_alarm_for_an_encounter_with_its_figures_and_its_end():
    alarms = Alarms()
    events = [e for t in range(0, 900, 5) for e in alarms.update(float(t), meeting(t))]
    (alarm,) = began(events, "cpa")
    assert alarm.tracks == (1, 2)
    assert alarm.cpa_m == pytest.approx(20.0, abs=0.1)
    assert alarm.tcpa_s == pytest.approx(600.0, abs=1.0)
    assert alarm.probability > 0.5
    assert alarm.priority == "warning"
    (end,) = ended(events, "cpa")
    assert 600.0 <= end.end_s <= 700.0


def test_with_own_ship_the_alarm_is_its_own_and_pairs_are_silent_unless_wanted():
    own = [-3000.0, 5.0, 2000.0, 0.0]
    for pairs, expected in ((None, [(0, 3)]), (True, [(0, 3), (1, 2)])):
        alarms = Alarms(config=AlarmConfig(pairs=pairs))
        there = meeting(0.0)
        there.track_id = np.append(there.track_id, 3)
        there.mean = np.vstack([there.mean, [3000.0, -5.0, 2020.0, 0.0]])
        there.covariance = np.tile(there.covariance[0], (3, 1, 1))
        there.status, there.name = np.full(3, "confirmed"), np.full(3, "")
        alarms.update(0.0, there, own=own)
        assert sorted(alarm.tracks for alarm in alarms.active) == expected
        assert alarms.active[0].priority == "alarm"
        assert {(e["first"], e["second"]) for e in alarms.encounters()} == {(0, 3), (1, 2)}


def test_own_ship_whose_position_is_lost_is_no_shore_station():
    own = [-3000.0, 5.0, 0.0, 0.0]
    alarms, there = Alarms(), meeting(0.0)
    for column in ("track_id", "mean", "covariance", "status", "name"):  # one on a reverse course
        setattr(there, column, getattr(there, column)[1:])
    alarms.update(0.0, there, own=own, is_ashore=False)
    (alarm,) = alarms.active
    assert alarm.tracks == (0, 2)
    for time_s in (1.0, 5.0):
        assert alarms.update(time_s, meeting(time_s), is_ashore=False) == []
    assert alarms.active == [alarm]
    events = []
    for time_s in range(900, 1000, 5):
        own[0] = -3000.0 + own[1] * time_s
        events += alarms.update(float(time_s), meeting(time_s), own=own, is_ashore=False)
    assert ended(events, "cpa") == [alarm]


def test_pairs_that_began_ashore_end_when_there_is_own_ship():
    alarms = Alarms()
    alarms.update(0.0, meeting(0.0))
    (alarm,) = alarms.active
    far = [9e4, 0.0, 9e4, 0.0]
    assert ended(alarms.update(1.0, meeting(1.0), own=far), "cpa") == [alarm]
    assert alarms.active == []


def test_new_limits_end_the_encounters_of_the_old_ones():
    alarms = Alarms()
    alarms.update(0.0, meeting(0.0))
    alarms.limits = wl.DangerLimits(cpa_limit_m=1.0)
    events = alarms.update(1.0, meeting(1.0))
    assert ended(events, "cpa")
    assert alarms.active == []
    assert alarms.encounters() == []


# Targets, sensors, identities ---------------------------------------------------------------------


def test_a_lost_target_alarms_unless_it_was_dropped_or_hardly_there():
    alarms = Alarms(config=AlarmConfig(pairs=False, established_s=10.0))
    far = {k: (1e5 * k, 0.0) for k in range(1, 5)}
    alarms.update(0.0, table({k: far[k] for k in (1, 2, 3)}, names=["", "Nordic Star", ""]))
    alarms.update(15.0, table(far))
    alarms.forget(1)
    lost = SimpleNamespace(kind="lost", track_id=3, reason="duplicate")
    events = alarms.update(20.0, table({}), events=[lost])
    (alarm,) = began(events, "lost target")
    assert alarm.tracks == (2,)
    assert ended(alarms.update(80.0, table({})), "lost target")


def test_a_target_that_vanished_in_an_outage_and_was_dropped_alarms_when_it_is_back_and_lost():
    alarms = Alarms(config=AlarmConfig(pairs=False, established_s=10.0))
    there, nothing = table({1: (0.0, 0.0)}), table({})
    alarms.update(0.0, there)
    alarms.update(20.0, nothing, is_blind=True)
    alarms.forget(1)
    assert alarms.update(60.0, nothing) == []
    alarms.update(70.0, there)
    (alarm,) = began(alarms.update(90.0, nothing), "lost target")
    assert alarm.tracks == (1,)


def test_a_new_target_alarms_when_wanted():
    alarms = Alarms(config=AlarmConfig(new_target=True))
    assert began(alarms.update(0.0, table({4: (0.0, 0.0)})), "new target")
    assert not began(alarms.update(1.0, table({4: (0.0, 0.0)})), "new target")


@given(ages=st.lists(st.sampled_from([0.0, 2.9, 3.1, 50.0, math.nan]), max_size=40))
def test_a_sensor_is_lost_once_and_back_when_it_has_been_heard_for_a_while(ages):
    alarms = Alarms(config=AlarmConfig(sensor_back_s=3.0))
    lost, good, changes = False, 0, []
    for t, age_s in enumerate(ages):
        events = alarms.update(float(t), table({}), sensors=[("radar A", age_s, 3.0)])
        changes += [e.change for e in events]
        good = good + 1 if age_s <= 3.0 else 0
        if not age_s <= 3.0:
            lost = True
        elif good > 3:
            lost = False
        assert bool(alarms.active) == lost
    assert all(a != b for a, b in itertools.pairwise(changes))


def test_ais_that_disagrees():
    alarms = Alarms(config=AlarmConfig(disagree_s=10.0, agree_s=20.0))
    where, changes = table({5: (0.0, 0.0)}), []
    for t in range(60):
        apart = [(5, "257378500", "")] if t < 30 else []
        events = alarms.update(float(t), where, disagreements=apart)
        changes += [(t, e.change, e.alarm.kind, e.alarm.source) for e in events]
    assert changes == [
        (10, "began", "ais disagrees", "257378500"),
        (49, "ended", "ais disagrees", "257378500"),
    ]


# The operator -------------------------------------------------------------------------------------


def test_acknowledge_and_silence():
    alarms = Alarms(zones=[Zone(outline_m=SQUARE)], config=AlarmConfig(silence_s=30.0))
    inside = table({1: (50.0, 50.0)})
    alarms.update(0.0, inside)
    (alarm,) = alarms.active
    assert alarm.sounds_at(0.0)
    assert alarms.silence("all")
    assert not alarm.sounds_at(29.0)
    assert alarm.sounds_at(31.0)
    assert alarms.acknowledge(alarm.alarm_id)
    assert not alarm.sounds_at(31.0)
    assert not alarms.acknowledge(1234)
    changes = [e.change for e in alarms.update(5.0, inside)]
    assert changes == ["silenced", "acknowledged"]
    assert [one["state"] for one in alarms.list()] == ["acknowledged"]
    alarms.acknowledge(alarm.alarm_id)
    assert alarms.changes() == []
    for wrong in ("some", None, 1.5, True):
        with pytest.raises(ValueError, match="alarm_id"):
            alarms.silence(wrong)


def test_the_list_is_json_and_the_log_has_every_change(tmp_path):
    alarms = Alarms(zones=[Zone(outline_m=SQUARE, name='gate, "north"')], config=QUIET)
    log = AlarmLog(tmp_path / "alarms.csv")
    for t, north_m in enumerate([50.0, -50.0, 50.0]):
        log.write(alarms.update(1.7e9 + t, table({1: (north_m, 50.0)})))
    log.close()
    again = AlarmLog(tmp_path / "alarms.csv")
    alarms.acknowledge("all")
    again.write(alarms.changes())
    again.close()
    with (tmp_path / "alarms.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["change"] for row in rows] == ["began", "ended", "began", "acknowledged"]
    assert [row["alarm_id"] for row in rows] == ["1", "1", "2", "2"]
    assert 'gate, "north"' in rows[0]["text"]
    assert rows[0]["utc"] == "2023-11-14T22:13:20.000Z"
    json.dumps(alarms.list(), allow_nan=False)


class Disk(io.FileIO):
    """A file on a disk that takes so many octets."""

    room = 1 << 20

    def write(self, octets):
        taken = min(len(octets), self.room)
        if taken == 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        self.room -= taken
        return super().write(bytes(octets[:taken]))


def test_a_file_has_whole_lines_where_the_disk_fills_up(tmp_path):
    with Disk(tmp_path / "lines", "a") as file:
        append_whole(file, b"one\n")
        file.room = 3
        with pytest.raises(OSError, match="No space"):
            append_whole(file, b"two\n")
        file.room = 10
        append_whole(file, b"three\n")
    assert (tmp_path / "lines").read_bytes() == b"one\nthree\n"


def test_a_table_that_takes_no_more_is_a_problem_and_ends_nothing(tmp_path):
    path = tmp_path / "alarms.csv"
    alarms, log = Alarms(zones=[Zone(outline_m=SQUARE)], config=QUIET), AlarmLog(path)
    log._file.close()
    log._file = Disk(path, "a")
    for t, (north_m, room) in enumerate([(50.0, 1 << 20), (-50.0, 20), (50.0, 1 << 20)]):
        log._file.room = room
        log.write(alarms.update(1.7e9 + t, table({1: (north_m, 50.0)})))
        assert log.problem == ("" if room > 20 else f"{path}: No space left on device")
    log.close()
    with path.open(newline="") as file:
        assert [row["change"] for row in csv.DictReader(file)] == ["began", "began"]


def test_notifications_of_signal_k():
    alarms = Alarms(zones=[Zone(outline_m=SQUARE)], config=QUIET)
    (event,) = alarms.update(0.0, table({1: (50.0, 50.0)}))
    path, value = notification("radar", event.alarm.as_dict(0.0))
    assert path.startswith("notifications.radar.radar.guardZone.1.")
    assert value["state"] == "alarm"
    assert value["method"] == ["visual", "sound"]
    (event,) = alarms.update(1.0, table({}))
    assert notification("radar", event.alarm.as_dict(1.0)) == (path, None)


def test_time_never_goes_back():
    alarms = Alarms()
    alarms.update(10.0, meeting(10.0))
    alarms.update(5.0, meeting(5.0))
    assert alarms.time_s == 10.0
