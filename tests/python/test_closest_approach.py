"""Closest approach of ships, and the tracks that the command finds dangerous."""

import csv

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wakeline as wl
from wakeline.cli import main, outputs
from wakeline.cli.config import ConfigError, Settings, read_settings
from wakeline.cli.danger import DangerLimits, danger_of, with_closest_approach
from wakeline.recording import OwnShip, RecordingError, Tracks, read_tracks
from wakeline.recording.own_csv import read_own

KNOT = 1852.0 / 3600.0
MILE_M = 1852.0
PERIOD_S = 3.0
SPEED = st.floats(-15.0, 15.0)
PLACE = st.floats(-2e4, 2e4)
SHIP = st.tuples(PLACE, SPEED, PLACE, SPEED)

closest_approach = wl.navigation.closest_approach


# The engine ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("own_kn", "range_nm", "bearing_deg", "course_deg", "speed_kn", "cpa_nm", "tcpa_min"),
    [
        (10, 8, 0, 180, 20, 0, 24),
        (10, 1, 0, 90, 10, 1, 0),
        (5, 8, 45, 225, 20, 0, 24),
        (25, 8, 45, 225, 20, 0, 24),
    ],
)
def test_the_scenarios_of_a823(
    own_kn, range_nm, bearing_deg, course_deg, speed_kn, cpa_nm, tcpa_min
):
    bearing, course = np.radians([bearing_deg, course_deg])
    own = np.array([0.0, own_kn * KNOT, 0.0, 0.0])
    place = range_nm * MILE_M * np.array([np.cos(bearing), np.sin(bearing)])
    velocity = own[1::2] + speed_kn * KNOT * np.array([np.cos(course), np.sin(course)])
    target = [place[0], velocity[0], place[1], velocity[1]]
    approach = closest_approach(own, target)
    assert approach.cpa_m / MILE_M == pytest.approx(cpa_nm, abs=1e-9)
    assert approach.tcpa_s / 60.0 == pytest.approx(tcpa_min, abs=1e-9)
    assert approach.cpa_std_m == 0.0


@given(own=SHIP, target=SHIP, after_s=st.floats(-600.0, 600.0))
def test_no_time_is_closer_than_the_closest(own, target, after_s):
    approach = closest_approach(own, target)
    x, vx, y, vy = np.subtract(target, own)
    there_m = np.hypot(x + vx * after_s, y + vy * after_s)
    assert there_m >= approach.cpa_m * (1 - 1e-9) - 1e-6 or np.hypot(vx, vy) <= 1e-6


@given(own=SHIP, target=SHIP)
def test_both_ships_see_the_same(own, target):
    one, other = closest_approach(own, target), closest_approach(target, own)
    np.testing.assert_allclose(one.signed_cpa_m, other.signed_cpa_m, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(one.tcpa_s, other.tcpa_s, rtol=1e-9, atol=1e-9)


def test_many_pairs_are_each_pair_alone():
    rng = np.random.default_rng(1)
    own = rng.normal(scale=[2e3, 8, 2e3, 8], size=(3, 1, 4))
    target = rng.normal(scale=[2e3, 8, 2e3, 8], size=(5, 4))
    root = rng.normal(scale=0.5, size=(5, 4, 4))
    covariance = root @ np.swapaxes(root, -1, -2)
    own_covariance = np.diag([4.0, 0.1, 4.0, 0.1])
    every = closest_approach(own, target, own_covariance, covariance)
    assert every.covariance.shape == (3, 5, 2, 2)
    for i in range(3):
        for j in range(5):
            one = closest_approach(own[i, 0], target[j], own_covariance, covariance[j])
            for name in ("cpa_m", "signed_cpa_m", "tcpa_s", "cpa_std_m", "tcpa_std_s"):
                assert getattr(every, name).shape == (3, 5)
                assert getattr(every, name)[i, j] == getattr(one, name)
            assert every.probability(500.0, 900.0)[i, j] == one.probability(500.0, 900.0)
    assert closest_approach(np.zeros(4), np.zeros((0, 4))).probability(1.0).shape == (0,)


def test_the_probability_is_the_share_of_draws_that_come_so_close():
    target = np.array([6000.0, -8.0, 700.0, 0.5])
    covariance = np.diag([900.0, 0.25, 900.0, 0.25])
    rng = np.random.default_rng(2)
    x, vx, y, vy = (target + rng.standard_normal((100_000, 4)) * np.sqrt(np.diag(covariance))).T
    approach = closest_approach(np.zeros(4), target, None, covariance)
    for limit_m, horizon_s in [(926.0, 1200.0), (1200.0, 1200.0), (1500.0, 700.0)]:
        t = np.clip(-(x * vx + y * vy) / (vx**2 + vy**2), 0.0, horizon_s)
        share = np.mean(np.hypot(x + vx * t, y + vy * t) < limit_m)
        assert approach.probability(limit_m, horizon_s) == pytest.approx(share, abs=0.02)
    d = (y * vx - x * vy) / np.hypot(vx, vy)
    assert np.std(d) == pytest.approx(approach.cpa_std_m, rel=0.02)


def test_ships_that_keep_together_stay_at_their_range():
    approach = closest_approach([0.0, 5.0, 0.0, 2.0], [300.0, 5.0, -400.0, 2.0])
    assert approach.cpa_m == 500.0
    assert approach.tcpa_s == 0.0
    assert approach.probability(501.0) == 1.0


def test_what_is_no_number_gives_none():
    approach = closest_approach(np.zeros(4), [[np.nan, 1.0, 1.0, 1.0], [9.0, -1.0, 1.0, 0.0]])
    assert np.isnan(approach.cpa_m).tolist() == [True, False]
    assert np.isnan(approach.probability(5.0)).tolist() == [True, False]


@pytest.mark.parametrize(
    ("arguments", "wanted"),
    [
        ((np.zeros(3), np.zeros(4)), r"own must have shape \(..., 4\), got \(3,\)"),
        ((np.zeros(4), np.zeros((4, 2))), r"target must have shape"),
        ((np.zeros(4), np.zeros(4), np.eye(2)), r"own_covariance must have shape"),
        ((np.zeros((2, 4)), np.zeros((3, 4))), "broadcast"),
    ],
)
def test_shapes_that_do_not_fit_are_named(arguments, wanted):
    with pytest.raises(ValueError, match=wanted):
        closest_approach(*arguments)


@pytest.mark.parametrize("limits", [(-1.0, 5.0), (1.0, -5.0), (np.nan, 5.0), (1.0, np.nan)])
def test_limits_below_zero_are_refused(limits):
    with pytest.raises(ValueError, match="must not be negative"):
        closest_approach(np.zeros(4), np.ones(4)).probability(*limits)


# Own ship's velocity ------------------------------------------------------------------------------


def test_own_velocity_is_the_recorded_one_else_that_of_the_positions():
    time_s = np.arange(0.0, 100.0, 2.0)
    places = (10.0 + 3.0 * time_s, 5.0 - 4.0 * time_s)
    steady = OwnShip(time_s, *places)
    np.testing.assert_allclose(steady.velocity_at([0.0, 31.0, 120.0]), [[3.0, -4.0]] * 3)
    gap = np.where(time_s == 30.0, np.nan, 7.0)
    told = OwnShip(time_s, *places, vnorth_mps=gap, veast_mps=gap)
    np.testing.assert_allclose(told.velocity_at([30.0, 999.0]), [[7.0, 7.0]] * 2)
    lost = np.full(50, np.nan)
    untold = OwnShip(time_s, *places, vnorth_mps=lost, veast_mps=lost)
    np.testing.assert_allclose(untold.velocity_at([31.0]), [[3.0, -4.0]])
    assert steady.knows_velocity
    assert not OwnShip.fixed().knows_velocity


# Alarms -------------------------------------------------------------------------------------------


def tracks_of(probability, tcpa_s=60.0):
    n = len(probability)
    zero = np.zeros(n)
    return Tracks(
        np.full(n, "7"),
        10.0 * np.arange(n),
        np.zeros((n, 4)),
        cpa_m=zero + 300.0,
        tcpa_s=zero + tcpa_s,
        cpa_probability=np.array(probability),
    )


def danger_of_tracks(tracks, *, range_m=2000.0, **limits):
    """What is dangerous to own ship at rest."""
    own = OwnShip(np.array([0.0, 1.0]), np.full(2, range_m), np.zeros(2))
    return danger_of(tracks, own, DangerLimits(**limits))


def test_an_alarm_does_not_flicker():
    danger = danger_of_tracks(
        tracks_of([0.1, 0.49, 0.5, 0.31, 0.6, 0.31, 0.29, 0.49, 0.9]), clear_hold_s=0.0
    )
    assert danger.alarmed.tolist() == [False] * 2 + [True] * 4 + [False] * 2 + [True]
    assert [(alarm.begin_s, alarm.end_s) for alarm in danger.alarms] == [(20.0, 50.0), (80.0, 80.0)]
    assert "at 20.0 s: CPA 300 m (0.16 NM), TCPA 1.0 min, 50 %" in str(danger.alarms[0])


@pytest.mark.parametrize(("range_m", "inside"), [(500.0, True), (950.0, False)])
def test_an_alarm_of_a_ship_inside_the_limit_says_how_near_she_is(range_m, inside):
    (alarm,) = danger_of_tracks(tracks_of([0.9], tcpa_s=1830.0), range_m=range_m).alarms
    assert alarm.range_m == range_m
    assert alarm.inside == inside
    assert ("inside already, 500 m (0.27 NM) off; CPA 300 m" in str(alarm)) == inside


@pytest.mark.parametrize(("below", "alarms"), [(6, 1), (7, 2)])
def test_an_alarm_is_over_when_the_probability_stays_low(below, alarms):
    danger = danger_of_tracks(tracks_of([0.9, *[0.1] * below, 0.6, 0.1, 0.3, *[0.0] * 9]))
    assert len(danger.alarms) == alarms
    assert danger.alarms[0].begin_s == 0.0
    assert danger.alarms[-1].end_s == 10.0 * (below + 3)
    assert danger.alarmed.sum() == (below + 4 if alarms == 1 else 4)


def test_an_alarm_begins_only_while_the_closest_point_is_ahead():
    assert danger_of_tracks(tracks_of([0.9, 0.9], tcpa_s=-1.0)).alarms == []
    danger = danger_of_tracks(tracks_of([0.9] * 3, tcpa_s=np.array([-5.0, 5.0, -5.0])))
    assert danger.alarmed.tolist() == [False, True, True]


def test_what_is_not_known_is_no_alarm():
    danger = danger_of_tracks(tracks_of([np.nan, 0.9, np.nan, np.nan]))
    assert danger.alarmed.tolist() == [False, True, False, False]
    assert danger_of_tracks(tracks_of([])).alarms == []


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("cpa_limit_m = -1", "[danger] cpa_limit_m = -1.0"),
        ("tcpa_limit_s = inf", "[danger] tcpa_limit_s = inf"),
        ("alarm_probability = 1.5", "[danger] alarm_probability = 1.5"),
        ("clear_probability = 0.7", "[danger] clear_probability = 0.7"),
        ("clear_hold_s = -1", "[danger] clear_hold_s = -1.0"),
        ("cpa = 3", "unknown key cpa in [danger]"),
    ],
)
def test_limits_that_make_no_sense_are_named(tmp_path, text, wanted):
    (tmp_path / "mine.toml").write_text(f"[danger]\n{text}\n")
    with pytest.raises(ConfigError) as caught:
        read_settings(tmp_path / "mine.toml")
    assert wanted in str(caught.value)


def test_limits_are_settings_like_others():
    assert Settings.default().danger == DangerLimits().as_dict()
    assert Settings.default().danger_limits == DangerLimits()


# The command --------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def encounter(tmp_path_factory):
    """Own ship north at 5 m/s; one ship head on, 100 m off; one that passes two miles off."""
    folder = tmp_path_factory.mktemp("encounter")
    rng = np.random.default_rng(3)
    time_s = PERIOD_S * np.arange(120)
    own = np.column_stack([5.0 * time_s, 0.0 * time_s])
    head_on = np.column_stack([4000.0 - 6.0 * time_s, 0.0 * time_s + 100.0])
    clear = np.column_stack([2000.0 - 6.0 * time_s, 0.0 * time_s + 4000.0])
    rows = [(1000.0 + t, *own[k]) for k, t in enumerate(time_s)]
    write(folder / "own.csv", "time_s,own_north_m,own_east_m", rows)
    rows = [
        (1000.0 + t, *(ship[k] + rng.normal(scale=4.0, size=2)))
        for k, t in enumerate(time_s)
        for ship in (head_on, clear)
    ]
    write(folder / "plots.csv", "time_s,north_m,east_m", rows)
    return folder


def write(path, head, rows):
    path.write_text("\n".join([head, *(",".join(map(str, row)) for row in rows)]) + "\n")
    return path


def track(folder, out, *options):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(outputs, "can_draw", lambda: False)
        files = [str(folder / "plots.csv"), "--out", str(out)]
        assert main(["track", *files, *map(str, options)]) == 0


def test_the_ship_head_on_is_told_and_the_other_is_not(encounter, tmp_path, capsys):
    track(encounter, tmp_path, "--own", encounter / "own.csv")
    tracks = read_tracks(tmp_path / "tracks.csv")
    near = tracks.where(tracks.east_m < 2000.0)
    far = tracks.where(tracks.east_m > 2000.0)
    assert np.all(far.cpa_probability < 0.3)
    settled = near.where(near.time_s > 1120.0)
    np.testing.assert_allclose(settled.cpa_m, 100.0, atol=60.0)
    meeting_s = 1000.0 + 4000.0 / 11.0
    np.testing.assert_allclose(settled.time_s + settled.tcpa_s, meeting_s, atol=10.0)
    assert np.all(settled.cpa_probability[settled.time_s < meeting_s - 10.0] > 0.9)
    with (tmp_path / "alarms.csv").open(newline="") as file:
        (alarm,) = csv.DictReader(file)
    assert alarm["track_id"] == near.track_id[0]
    begin_s = float(alarm["begin_s"])
    assert 1000.0 < begin_s < 1060.0
    assert float(alarm["range_m"]) == pytest.approx(4000.0 - 11.0 * (begin_s - 1000.0), abs=30.0)
    text = capsys.readouterr().out
    assert "1 alarm of tracks closer than 926 m within 20 min" in text
    assert f"track {alarm['track_id']} at " in text
    assert "alarms.csv" in text


COVARIANCE = "vnorth_var_m2s2,vnorth_veast_cov_m2s2,veast_var_m2s2"


def own_file(path, variance_m2s2, status="ok"):
    """Own ship of `encounter` as ``wakeline navigate`` writes her, with this variance per axis."""
    rows = [
        (1000.0 + t, 5.0 * t, 0.0, 5.0, 0.0, variance_m2s2, 0.0, variance_m2s2, status)
        for t in PERIOD_S * np.arange(120)
    ]
    return write(path, f"time_s,north_m,east_m,vnorth_mps,veast_mps,{COVARIANCE},status", rows)


def test_the_covariance_of_own_ships_velocity_is_in_the_probability(encounter, tmp_path):
    probability = {}
    for std_mps in (0.05, 0.2, 2.0, ""):
        variance = std_mps and std_mps**2
        track(encounter, tmp_path, "--own", own_file(tmp_path / "own.csv", variance))
        tracks = read_tracks(tmp_path / "tracks.csv")
        probability[std_mps] = tracks.where(tracks.time_s > 1060.0).cpa_probability
    np.testing.assert_allclose(probability[""], probability[0.2], atol=1e-12)
    assert (probability[0.05] != probability[0.2]).any()
    assert np.abs(probability[2.0] - probability[0.05]).max() > 0.1


def test_a_covariance_of_own_ship_is_interpolated_over_rows_that_tell_none():
    time_s = np.arange(4.0)
    covariance = np.array([1.0, np.nan, 3.0, 5.0])[:, None, None] * np.array(
        [[1.0, 0.5], [0.5, 2.0]]
    )
    own = OwnShip(time_s, time_s, time_s, time_s, time_s, velocity_m2s2=covariance)
    at = own.velocity_m2s2_at([0.0, 1.0, 2.5, 9.0])
    np.testing.assert_allclose(at[:, 0, 0], [1.0, 2.0, 4.0, 5.0])
    np.testing.assert_allclose(at[:, 0, 1], at[:, 0, 0] / 2.0)
    assert OwnShip(time_s, time_s, time_s).velocity_m2s2_at([0.0]) is None


@pytest.mark.parametrize(
    ("cells", "name"),
    [
        ("-1,0,1", "vnorth_var_m2s2"),
        ("1,0,inf", "veast_var_m2s2"),
        ("1,1.1,1", "vnorth_veast_cov_m2s2"),
        ("1e300,1.1e300,1e300", "vnorth_veast_cov_m2s2"),
    ],
)
def test_a_covariance_that_is_none_is_an_error_at_its_cell(tmp_path, cells, name):
    head = f"time_s,north_m,east_m,vnorth_mps,veast_mps,{COVARIANCE}"
    own = write(tmp_path / "own.csv", head, [(0, 0, 0, 0, 0, "1,0,1"), (1, 0, 0, 0, 0, cells)])
    with pytest.raises(RecordingError, match=f"line 3.*{name}"):
        read_own(own, [])


def test_a_large_covariance_is_one(tmp_path):
    head = f"time_s,north_m,east_m,vnorth_mps,veast_mps,{COVARIANCE}"
    cells = "1e300,-0.5e300,1e300"
    own = read_own(write(tmp_path / "own.csv", head, [(0, 0, 0, 0, 0, cells)]), [])
    assert own.columns["velocity_m2s2"][0, 0, 1] == -0.5e300


@pytest.mark.parametrize("status", ["jumped", "Jumped"])
def test_rows_in_which_own_ships_place_is_in_doubt_are_told(tmp_path, status):
    notes = []
    read_own(own_file(tmp_path / "own.csv", 0.01, status), notes)
    assert notes == [
        "own.csv: own ship's place is in doubt in 120 rows, of status jumped (first in line 2)"
    ]


CRAFT = "[models]\ncruising_probability = 0\nsettling_s = 1e9\n"


@pytest.mark.parametrize(("models", "needs_hold"), [("", False), (CRAFT, True)])
def test_one_encounter_from_afar_is_one_alarm(tmp_path, models, needs_hold):
    """Even by models that expect a maneuver at any time, whose probabilities go up and down."""
    rng = np.random.default_rng(3)
    time_s = PERIOD_S * np.arange(260)
    own_m = 5.0 * time_s
    range_m = np.hypot(9000.0 - 12.0 * time_s, 600.0) + rng.normal(scale=25.0, size=260)
    bearing = np.arctan2(600.0, 9000.0 - 12.0 * time_s) + rng.normal(scale=0.009, size=260)
    place = zip(own_m + range_m * np.cos(bearing), range_m * np.sin(bearing), strict=True)
    rows = [(t, *where) for t, where in zip(time_s, place, strict=True)]
    write(tmp_path / "plots.csv", "time_s,north_m,east_m", rows)
    rows = [(t, north_m, 0.0) for t, north_m in zip(time_s, own_m, strict=True)]
    own = write(tmp_path / "own.csv", "time_s,own_north_m,own_east_m", rows)
    limits = write(
        tmp_path / "mine.toml",
        f"{models}[radar]",
        [("range_std_m = 25",), ("bearing_std_deg = 0.5",)],
    )
    counts = []
    for hold in ("", "\n[danger]\nclear_hold_s = 0\n"):
        limits.write_text(limits.read_text() + hold)
        track(tmp_path, tmp_path, "--own", own, "--config", limits)
        counts.append(len((tmp_path / "alarms.csv").read_text().splitlines()) - 1)
    assert counts[0] == 1
    assert (counts[1] > 1) == needs_hold


def test_an_alarm_ends_when_the_ship_is_past(encounter, tmp_path):
    limits = write(tmp_path / "mine.toml", "[danger]", [("cpa_limit_m = 150",)])
    time_s = np.arange(1000.0, 1500.0, 5.0)
    own = OwnShip(time_s, 5.0 * (time_s - 1000.0), 0.0 * time_s)
    state = np.column_stack(
        [4000.0 - 6.0 * (time_s - 1000.0), 0 * time_s - 6.0, 0 * time_s + 50.0, 0 * time_s]
    )
    covariance = np.broadcast_to(np.diag([25.0, 0.01, 25.0, 0.01]), (len(time_s), 4, 4))
    tracks = Tracks(["1"] * len(time_s), time_s, state, covariance=covariance)
    settings = read_settings(limits).danger_limits
    told = with_closest_approach(tracks, own, settings)
    (alarm,) = danger_of(told, own, settings).alarms
    meeting_s = 1000.0 + 4000.0 / 11.0
    assert meeting_s <= alarm.end_s < meeting_s + 30.0


def test_without_own_ship_nothing_is_told_of_danger(encounter, tmp_path, capsys):
    track(encounter, tmp_path)
    assert read_tracks(tmp_path / "tracks.csv").cpa_m is None
    assert not (tmp_path / "alarms.csv").exists()
    assert "alarm" not in capsys.readouterr().out


def test_of_an_own_ship_of_one_place_the_velocity_is_not_known(encounter, tmp_path, capsys):
    rows = [(k, 1000.0 + PERIOD_S * k) for k in range(120)]
    scans = write(tmp_path / "scans.csv", "scan,time_s", rows)
    track(encounter, tmp_path, "--own", scans)
    assert "own ship's velocity is not known" in capsys.readouterr().out
    assert read_tracks(tmp_path / "tracks.csv").cpa_m is None


def test_the_tracks_themselves_do_not_change(encounter, tmp_path):
    own = ["--own", encounter / "own.csv"]
    track(encounter, tmp_path / "a", *own)
    wide = write(tmp_path / "wide.toml", "[danger]", [("cpa_limit_m = 9000",)])
    track(encounter, tmp_path / "b", *own, "--config", wide)
    a, b = (read_tracks(tmp_path / name / "tracks.csv") for name in "ab")
    np.testing.assert_array_equal(a.state, b.state)
    np.testing.assert_array_equal(a.cpa_m, b.cpa_m)
    assert np.all(b.cpa_probability >= a.cpa_probability - 1e-3)
    assert set(b.track_id[b.cpa_probability > 0.9]) == set(b.track_id)


def test_danger_is_red_on_the_map():
    plt = pytest.importorskip("matplotlib.colors")
    from wakeline import plot

    tracks = tracks_of([0.1, 0.9, 0.9])
    ax = plot.map_figure(None, tracks, alarmed=np.array([False, True, True])).axes[0]
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert names.count("danger") == 1
    assert "7: CPA 300 m in 1.0 min" in [text.get_text() for text in ax.texts]
    red = [line for line in ax.lines if plt.to_hex(line.get_color()) == "#e00000"]
    assert np.isnan(red[0].get_xdata()).tolist() == [True, False, False]
    calm = plot.map_figure(None, tracks, alarmed=np.zeros(3, dtype=bool)).axes[0]
    assert "danger" not in [text.get_text() for text in calm.get_legend().get_texts()]
