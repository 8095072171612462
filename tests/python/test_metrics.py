"""Scores: laws that hold for any tracks, and cases worked out by hand."""

import dataclasses
import itertools
import json
import pickle
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wakeline import metrics, recording, scenario
from wakeline.metrics import scoring
from wakeline.recording import Episode, Scan, TargetTruth, Tracks

SCANS, PERIOD_S = 60, 2.0
TIME_S = PERIOD_S * np.arange(SCANS)
STILL = np.zeros(SCANS)
NORTHBOUND = np.column_stack([10 * TIME_S, STILL + 10, STILL, STILL])
WESTBOUND = np.column_stack([STILL + 600, STILL, 300 - 5 * TIME_S, STILL - 5])


def scan_of(k, places=()):
    """Scan k with plots at the given places (n, 2)."""
    places = np.array(places, dtype=float).reshape(-1, 2)
    zero = np.zeros(len(places))
    return Scan(TIME_S[k], k, zero + TIME_S[k], *places.T, np.hypot(*places.T), zero, zero, zero)


def episode_of(*states, plots=None):
    """An episode whose targets "1", "2" ... are at the states (T, 4)."""
    scans = [scan_of(k, () if plots is None else plots[k]) for k in range(SCANS)]
    truth = {
        str(n): TargetTruth(TIME_S, s[:, 0], s[:, 2], s[:, 1], s[:, 3])
        for n, s in enumerate(states, start=1)
    }
    return Episode("", scans, truth=truth)


def track(track_id, states, scans=range(SCANS), offset=(0, 0, 0, 0)):
    scans = list(scans)
    return Tracks([track_id] * len(scans), TIME_S[scans], states[scans] + np.array(offset))


def overall(tracks, episode, **parameters):
    return metrics.score(Tracks.joined(tracks), episode, **parameters).overall


def test_perfect_tracks_score_perfectly():
    got = overall(
        [track("A", NORTHBOUND), track("B", WESTBOUND)], episode_of(NORTHBOUND, WESTBOUND)
    )
    assert got.coverage == 1.0
    assert (got.ids, got.switches, got.breaks, got.false_tracks) == (2, 0, 0, 0)
    assert got.errors.position_rmse_m == got.errors.velocity_rmse_mps == 0.0
    assert got.gospa_m == got.gospa_near_m == 0.0
    assert got.eligible_scans == 2 * (SCANS - 5)


def test_no_tracks_score_nothing():
    got = overall([], episode_of(NORTHBOUND))
    assert (got.coverage, got.never_tracked, got.ids) == (0.0, 1, 0)
    assert got.errors == metrics.Errors()
    assert got.gospa_m == pytest.approx(np.sqrt(50.0**2 / 2))


@given(st.floats(-20, 20), st.floats(-20, 20))
def test_a_constant_offset_is_gone_after_debiasing(north_m, east_m):
    errors = overall(
        [track("A", NORTHBOUND, offset=(north_m, 0, east_m, 0))], episode_of(NORTHBOUND)
    ).errors
    assert errors.position_rmse_m == pytest.approx(np.hypot(north_m, east_m))
    assert errors.position_rmse_debiased_m == pytest.approx(0.0, abs=1e-9)
    assert errors.mean_offset_north_m == pytest.approx(north_m, abs=1e-9)
    assert errors.mean_offset_east_m == pytest.approx(east_m, abs=1e-9)


def test_offsets_are_taken_out_target_by_target():
    tracks = [
        track("A", NORTHBOUND, offset=(8, 0, 0, 0)),
        track("B", WESTBOUND, offset=(-8, 0, 3, 0)),
    ]
    errors = overall(tracks, episode_of(NORTHBOUND, WESTBOUND)).errors
    assert errors.position_rmse_debiased_m == pytest.approx(0.0, abs=1e-9)


def test_velocity_speed_and_course_errors():
    errors = overall([track("A", NORTHBOUND, offset=(3, 0, 4, 2))], episode_of(NORTHBOUND)).errors
    assert errors.position_rmse_m == pytest.approx(5.0)
    assert errors.position_median_m == pytest.approx(5.0)
    assert errors.velocity_rmse_mps == pytest.approx(2.0)
    assert errors.speed_rmse_mps == pytest.approx(np.hypot(10, 2) - 10)
    assert errors.course_rms_deg == pytest.approx(np.degrees(np.arctan2(2, 10)))


def test_course_error_goes_the_short_way_round_and_needs_speed():
    west_of_north = np.column_stack([STILL, STILL + 10, STILL, STILL - 0.1])
    got = overall([track("A", west_of_north, offset=(0, 0, 0, 0.2))], episode_of(west_of_north))
    assert got.errors.course_rms_deg == pytest.approx(2 * np.degrees(np.arctan(0.01)))
    slow = np.column_stack([STILL, STILL + 1, STILL, STILL])
    assert overall([track("A", slow)], episode_of(slow)).errors.course_rms_deg is None


def test_an_interruption_is_a_break_and_no_switch():
    seen = [k for k in range(SCANS) if not 20 <= k < 25]
    got = metrics.score(track("A", NORTHBOUND, seen), episode_of(NORTHBOUND))
    assert (got.overall.breaks, got.overall.switches) == (1, 0)
    assert got.overall.coverage == pytest.approx(50 / 55)
    assert got.episodes[0].targets[0].lost_at_time_s == [40.0]


def test_a_new_id_after_an_interruption_is_a_break_and_a_switch():
    tracks = [track("A", NORTHBOUND, range(20)), track("B", NORTHBOUND, range(25, 50))]
    got = metrics.score(Tracks.joined(tracks), episode_of(NORTHBOUND))
    assert (got.overall.breaks, got.overall.switches, got.overall.ids) == (1, 1, 2)
    assert got.overall.lost_at_end == 1
    assert got.episodes[0].targets[0].lost_at_time_s == [40.0, 100.0]


def test_swapped_tracks_are_counted_once_each():
    half, rest = range(30), range(30, SCANS)
    swapped = [
        *(track("A", NORTHBOUND, half), track("A", WESTBOUND, rest)),
        *(track("B", WESTBOUND, half), track("B", NORTHBOUND, rest)),
    ]
    got = overall(swapped, episode_of(NORTHBOUND, WESTBOUND))
    assert (got.switches, got.breaks, got.ids, got.coverage) == (2, 0, 4, 1.0)


def test_of_two_noisy_tracks_the_target_keeps_one():
    rng = np.random.default_rng(4)
    noise = rng.normal(0, 4, (2, SCANS, 4)) * [1, 0, 1, 0]
    tracks = [track("A", NORTHBOUND + noise[0]), track("B", NORTHBOUND + noise[1])]
    got = overall(tracks, episode_of(NORTHBOUND))
    assert (got.switches, got.ids) == (0, 1)
    assert got.duplicate_track_scans_per_scan == pytest.approx(1.0)


def test_false_and_duplicate_tracks():
    tracks = [
        track("A", NORTHBOUND),
        track("F", NORTHBOUND, range(10, 20), (900, 0, 0, 0)),
        track("D", NORTHBOUND, range(30, 36), (20, 0, 0, 0)),
    ]
    got = overall(tracks, episode_of(NORTHBOUND))
    assert got.false_tracks == 1
    assert got.false_track_scans_per_scan == pytest.approx(10 / SCANS)
    assert got.duplicate_track_scans_per_scan == pytest.approx(6 / SCANS)
    assert got.gospa_m == pytest.approx(16 * np.sqrt(1250) / SCANS)
    assert got.gospa_near_m == pytest.approx(6 * np.sqrt(1250) / SCANS)


def test_nothing_is_matched_at_the_gate():
    assert overall([track("A", NORTHBOUND, offset=(50, 0, 0, 0))], episode_of(NORTHBOUND)).ids == 0
    assert overall([track("A", NORTHBOUND, offset=(49, 0, 0, 0))], episode_of(NORTHBOUND)).ids == 1


def test_the_most_pairs_come_before_the_nearest():
    side = NORTHBOUND + np.array([0, 0, 40, 0])
    tracks = [track("A", NORTHBOUND, offset=(0, 0, 20, 0)), track("B", side, offset=(0, 0, 45, 0))]
    got = overall(tracks, episode_of(NORTHBOUND, side))
    assert got.coverage == 1.0


def test_warm_up_follows_the_plots():
    with_plot = (10, 12, 14, 16, 18, 30)
    plots = [[(9e3, 9e3)] for _ in range(SCANS)]
    for k in with_plot:
        plots[k].append((NORTHBOUND[k, 0] + 5, NORTHBOUND[k, 2]))
    got = metrics.score(
        track("A", NORTHBOUND, range(12, SCANS)), episode_of(NORTHBOUND, plots=plots)
    )
    (target,) = got.episodes[0].targets
    assert target.supported_scans == len(with_plot)
    assert target.eligible_scans == SCANS - 19
    assert target.coverage == 1.0
    assert target.initiation_scans == 2


@given(st.sampled_from([0.2, 0.25, 0.4, 1.0]), st.randoms())
def test_of_rows_near_a_scan_the_nearest_in_time_counts(step_s, random):
    time_s = np.arange(-0.5, TIME_S[-1] + 0.5, step_s)
    rows = list(range(len(time_s)))
    random.shuffle(rows)
    zero = 0 * time_s
    states = np.column_stack([10 * time_s, zero + 10, zero, zero])
    tracks = Tracks(["A"] * len(rows), time_s[rows], states[rows])
    away_s = np.abs(time_s[:, np.newaxis] - TIME_S).min(axis=0)
    wanted_m = 10 * np.sqrt(np.mean(away_s[5:] ** 2))
    got = overall([tracks], episode_of(NORTHBOUND)).errors
    assert got.position_rmse_m == pytest.approx(wanted_m, abs=1e-9)


def test_of_two_tracks_as_near_the_order_of_rows_decides_nothing():
    tracks = [track(name, NORTHBOUND, offset=(m, 0, 0, 0)) for name, m in (("A", 9), ("B", -9))]
    one, other = (overall(rows, episode_of(NORTHBOUND)).errors for rows in (tracks, tracks[::-1]))
    assert one == other


def test_rows_at_no_scan_or_not_finite_are_counted():
    rows = track("A", NORTHBOUND)
    late = dataclasses.replace(rows, time_s=rows.time_s + 0.9)
    assert metrics.score(late, episode_of(NORTHBOUND)).episodes[0].unmatched_rows == SCANS
    broken = dataclasses.replace(
        rows, state=np.where(rows.time_s[:, None] == 8, np.nan, rows.state)
    )
    assert metrics.score(broken, episode_of(NORTHBOUND)).episodes[0].unmatched_rows == 1


@settings(max_examples=25, deadline=None)
@given(st.randoms(use_true_random=False))
def test_the_order_of_rows_and_the_names_of_tracks_do_not_matter(random):
    rng = np.random.default_rng(random.getrandbits(32))
    tracks = Tracks.joined(
        [
            track("A", NORTHBOUND + rng.normal(0, 12, (SCANS, 4)), range(40)),
            track("B", WESTBOUND + rng.normal(0, 12, (SCANS, 4))),
            track("C", NORTHBOUND + rng.normal(0, 12, (SCANS, 4)), range(20, SCANS)),
        ]
    )
    episode = episode_of(NORTHBOUND, WESTBOUND)
    shuffled = tracks.where(rng.permutation(len(tracks)))
    renamed = dataclasses.replace(shuffled, track_id=["x" + i for i in shuffled.track_id])
    wanted, got = overall([tracks], episode).as_dict(), overall([renamed], episode).as_dict()
    assert got == pytest.approx(wanted)


def test_episodes_add_up():
    loaded = recording.load("autoferry")
    tracks = Tracks.joined(
        [
            Tracks(
                [f"{episode.name}-{name}"] * np.count_nonzero(known),
                episode.time_s[known],
                state[known],
                scenario=[episode.name] * np.count_nonzero(known),
            )
            for episode in loaded
            for name, truth in episode.truth.items()
            for state in [truth.state_at(episode.time_s)]
            for known in [np.isfinite(state).all(axis=1)]
        ]
    )
    got = metrics.score(tracks, loaded)
    assert got.overall.coverage == 1.0
    assert got.overall.switches == got.overall.breaks == 0
    assert got.overall.errors.position_rmse_m == 0.0
    for name in ("scans", "targets", "eligible_scans", "ids"):
        parts = [getattr(episode.summary, name) for episode in got.episodes]
        assert getattr(got.overall, name) == sum(parts)
    by_time = metrics.score(dataclasses.replace(tracks, scenario=None), loaded)
    assert by_time.overall == got.overall
    json.dumps(got.overall.as_dict())


def test_parameters_and_scenarios_that_are_invalid():
    for name, values in {
        "gate_m": (0.0, np.inf, np.nan, 1e-200, 1e200),
        "bonus_m": (-1.0, np.inf, np.nan),
        "warmup_scans": (0, np.inf),
    }.items():
        for value in values:
            wanted = rf"^{name} must be .*finite.*, got {re.escape(str(value))}$"
            with pytest.raises(ValueError, match=wanted):
                overall([track("A", NORTHBOUND)], episode_of(NORTHBOUND), **{name: value})
    lost = Tracks(["1"], [0.0], np.zeros((1, 4)), scenario=["9"])
    with pytest.raises(ValueError, match="'9'"):
        metrics.score(lost, recording.load("autoferry"))


# ------------------------------------------------------------------ sets of points


def points(most):
    coordinate = st.floats(-60, 60)
    return st.lists(st.tuples(coordinate, coordinate), max_size=most).map(
        lambda rows: np.array(rows, dtype=float).reshape(-1, 2)
    )


def least_over_pairings(truth, tracks, cutoff, p):
    """Least sum over every set of one-to-one pairs, cutoff ** p / 2 for each point left out."""
    distance = np.hypot(*(truth[:, None] - tracks[None]).transpose(2, 0, 1))
    best = np.inf
    for size in range(min(distance.shape) + 1):
        for rows in itertools.combinations(range(len(truth)), size):
            for columns in itertools.permutations(range(len(tracks)), size):
                pairs = sum(distance[i, j] ** p for i, j in zip(rows, columns, strict=True))
                left = sum(distance.shape) - 2 * size
                best = min(best, pairs + left * cutoff**p / 2)
    return best


@settings(deadline=None)
@given(points(4), points(4), st.sampled_from([1.0, 2.0]))
def test_gospa_is_the_least_over_all_pairings(truth, tracks, p):
    got = metrics.set_distance(truth, tracks, cutoff_m=40.0, order=p)
    assert got.gospa_m**p == pytest.approx(least_over_pairings(truth, tracks, 40.0, p), abs=1e-6)
    assert got.gospa_m**p == pytest.approx(
        got.localisation + got.missed + got.false_tracks, abs=1e-6
    )


@settings(deadline=None)
@given(points(4), points(4), points(4))
def test_gospa_and_ospa_are_metrics(a, b, c):
    for name in ("gospa_m", "ospa_m"):
        aa, ab, ba, bc, ac = (
            getattr(metrics.set_distance(x, y), name)
            for x, y in ((a, a), (a, b), (b, a), (b, c), (a, c))
        )
        assert aa == pytest.approx(0.0, abs=1e-6)
        assert ab == pytest.approx(ba)
        assert ac <= ab + bc + 1e-6


@settings(deadline=None)
@given(points(4), points(4))
def test_ospa_is_at_most_the_cutoff(truth, tracks):
    ospa_m = metrics.set_distance(truth, tracks, cutoff_m=30.0).ospa_m
    assert 0.0 <= ospa_m <= 30.0 + 1e-9
    if len(truth) == 0 and len(tracks):
        assert ospa_m == pytest.approx(30.0)


def test_ospa_of_one_pair_is_their_distance():
    one = metrics.set_distance([[0.0, 0.0]], [[3.0, 4.0]])
    assert (one.ospa_m, one.pairs) == (pytest.approx(5.0), 1)
    with_one_more = metrics.set_distance([[0.0, 0.0]], [[3.0, 4.0], [500.0, 0.0]])
    assert with_one_more.ospa_m == pytest.approx(np.sqrt((25 + 2500) / 2))
    assert pickle.loads(pickle.dumps(with_one_more)).gospa_m == with_one_more.gospa_m


def test_no_points_need_no_columns():
    for points in ([], np.zeros((0, 2)), [[]]):
        false = metrics.set_distance(points, [[0.0, 0.0]], cutoff_m=50.0)
        assert (false.gospa_m, false.false_tracks) == (pytest.approx(50 / 2**0.5), 1250.0)
        assert metrics.set_distance([[0.0, 0.0]], points, cutoff_m=50.0).missed == 1250.0
        assert metrics.set_distance(points, points).gospa_m == 0.0
    assert metrics.gospa is metrics.set_distance


def test_sets_of_the_wrong_shape():
    with pytest.raises(ValueError, match=r"truth_m must have shape \(N, D\), got \(2,\)"):
        metrics.set_distance(np.zeros(2), np.zeros((1, 2)))
    with pytest.raises(ValueError, match=r"tracks_m must have shape \(N, 2\), got \(1, 3\)"):
        metrics.set_distance(np.zeros((1, 2)), np.zeros((1, 3)))


@pytest.mark.parametrize("value", [np.inf, np.nan])
def test_points_that_are_nowhere(value):
    point, nowhere = [[0.0, 0.0]], [[0.0, value]]
    for sets, name in (((point, nowhere), "tracks_m"), ((nowhere, point), "truth_m")):
        with pytest.raises(ValueError, match=f"{name} must be finite, got {value}"):
            metrics.set_distance(*sets)


@pytest.mark.parametrize("value", [0.0, np.inf, np.nan])
@pytest.mark.parametrize("name", ["cutoff_m", "order"])
def test_cutoffs_and_orders_that_are_invalid(name, value):
    with pytest.raises(ValueError, match=f"^{name} must be .*, got {value:g}"):
        metrics.set_distance(np.zeros((1, 2)), np.zeros((1, 2)), **{name: value})


@pytest.mark.parametrize(("cutoff_m", "order"), [(50.0, 200.0), (0.3, 1000.0)])
def test_the_cutoff_to_the_power_of_the_order_must_be_a_number(cutoff_m, order):
    with pytest.raises(ValueError, match=f"^order must be .*overflow, got {order:g}"):
        metrics.set_distance(np.zeros((1, 2)), np.zeros((0, 2)), cutoff_m, order)


# ------------------------------------------------------------------ errors of states


def test_rmse_over_axes():
    assert metrics.rmse([3.0, -3.0]) == pytest.approx(3.0)
    np.testing.assert_allclose(metrics.rmse([[3.0, 4.0], [3.0, -4.0]], axis=0), [3.0, 4.0])


def test_nees_of_honest_errors_has_the_mean_of_chi_square():
    rng = np.random.default_rng(2)
    root = rng.normal(size=(4, 4)) + 4 * np.eye(4)
    error = rng.standard_normal((20_000, 4)) @ root.T
    got = metrics.nees(error, np.broadcast_to(root @ root.T, (20_000, 4, 4)))
    assert got.shape == (20_000,)
    assert got.mean() == pytest.approx(4.0, abs=4 * np.sqrt(8 / 20_000))


@pytest.mark.parametrize("size", range(1, 10))
def test_nees_is_what_the_inverse_gives(size):
    rng = np.random.default_rng(size)
    error, root = rng.normal(size=(2, 3, size)), rng.normal(size=(2, 3, size, size))
    covariance = root @ np.swapaxes(root, -1, -2) + np.eye(size)
    expected = np.einsum("rti,rtij,rtj->rt", error, np.linalg.inv(covariance), error)
    np.testing.assert_allclose(metrics.nees(error, covariance), expected, rtol=1e-9)


def test_nees_of_a_covariance_that_is_none_is_nan():
    with pytest.raises(ValueError, match=r"\(3, 2, 2\), got \(2, 2\)"):
        metrics.nees(np.zeros((3, 2)), np.eye(2))
    with pytest.raises(ValueError, match=r"N from 1 to 9, got \(10,\)"):
        metrics.nees(np.zeros(10), np.eye(10))
    honest, wrong = np.eye(2), np.diag([1.0, -1.0])
    assert np.isnan(metrics.nees(np.zeros((2, 2)), [honest, wrong])).tolist() == [False, True]


TAKES = {
    "error": metrics.rmse,
    "time_s": lambda values: metrics.steady_scans(values, [1.0]),
    "curve": lambda values: metrics.share_inside(values, 4, 10),
    "turn_rates_rad_s": lambda values: metrics.right_mode(np.ones((1, 2)), values, [0.0]),
    "start": scenario.Truth,
}


@pytest.mark.parametrize("name", TAKES)
@pytest.mark.parametrize(
    ("values", "error", "words"),
    [
        (["12.5", "3"], TypeError, "got text such as '12.5'"),
        (np.array(["12.5", 3.0], dtype=object), TypeError, "got text such as '12.5'"),
        ([1j, 2.0], TypeError, "got complex128"),
        ([[1.0], [2.0, 3.0]], ValueError, "inhomogeneous"),
    ],
)
def test_what_is_not_a_number_is_rejected_by_name(name, values, error, words):
    with pytest.raises(error, match=f"{name} must hold real numbers: .*{words}"):
        TAKES[name](values)


def test_a_masked_error_is_none():
    assert np.isnan(metrics.rmse(np.ma.array([3.0, 4.0], mask=[True, False])))
    assert metrics.rmse(np.ma.array([3, 4], mask=False)) == np.sqrt(12.5)


@pytest.mark.parametrize("spread_m", [0.0, 10.0, 300.0, 1e5, 1e9])
@pytest.mark.parametrize("size", [(0, 3), (3, 0), (1, 1), (40, 60), (150, 120)])
def test_near_pairs_by_a_grid_are_those_of_all_distances(spread_m, size, monkeypatch):
    rng = np.random.default_rng(7)
    a_m, b_m = (rng.uniform(-spread_m, spread_m, (n, 2)) for n in size)
    b_m[::17] = np.nan
    b_m[1::5] = a_m[0] + [49.0, 0.0] if len(a_m) else 0.0
    of_all = scoring._pairs_within(50.0, a_m, b_m)
    distance_m = np.hypot(*(a_m[:, None] - b_m).transpose(2, 0, 1))
    monkeypatch.setattr(scoring, "_FEW_PAIRS", -1)
    by_grid = scoring._pairs_within(50.0, a_m, b_m)
    wanted = np.nonzero(distance_m < 50.0)
    for pairs in (of_all, by_grid):
        assert np.array_equal(pairs[:2], wanted)
        assert np.array_equal(pairs[2], distance_m[wanted])
