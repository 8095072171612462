"""Truth under control, from tables and under disturbance: exact, seeded, validated."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wakeline.scenario import Segment, Truth, disturbed, segments_from_table

START = [100.0, 6.0, -50.0, 8.0]
rates = st.floats(-0.3, 0.3)
pushes = st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))


def integrated(state, duration_s, rate, thrust, push, steps=600):
    """dv/dt = w x v + a e(c0 + w t) + u by Runge-Kutta."""
    course = np.arctan2(state[3], state[1])

    def slope(t, s):
        steered = course + rate * t
        return np.array(
            [
                s[1],
                -rate * s[3] + thrust * np.cos(steered) + push[0],
                s[3],
                rate * s[1] + thrust * np.sin(steered) + push[1],
            ]
        )

    h = duration_s / steps
    for k in range(steps):
        t = k * h
        k1 = slope(t, state)
        k2 = slope(t + h / 2, state + h / 2 * k1)
        k3 = slope(t + h / 2, state + h / 2 * k2)
        k4 = slope(t + h, state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return state


@pytest.mark.parametrize("rate", [0.0, 1e-12, 1e-6, 1e-3, -0.015, 0.07, -0.3])
@pytest.mark.parametrize("thrust", [0.0, 0.1])
@pytest.mark.parametrize("push", [(0.2, 0.0), (-0.3, 0.5)])
def test_turn_thrust_and_control_together_obey_the_equation_of_motion(rate, thrust, push):
    truth = Truth(START, [Segment(40.0, rate, thrust, control_mps2=push)])
    for at in (0.5, 20.0, 40.0):
        wanted = integrated(np.array(START), at, rate, thrust, push)
        np.testing.assert_allclose(truth.state_at(at)[0], wanted, atol=1e-6)


@given(rates, pushes, st.floats(1.0, 59.0))
def test_a_controlled_turn_cut_in_two_is_the_same_motion(rate, push, cut_s):
    whole = Truth(START, [Segment(60.0, rate, control_mps2=push)])
    halves = Truth(
        START,
        [Segment(cut_s, rate, control_mps2=push), Segment(60.0 - cut_s, rate, control_mps2=push)],
    )
    time_s = np.linspace(0.0, 80.0, 41)
    np.testing.assert_allclose(halves.state_at(time_s), whole.state_at(time_s), atol=1e-8)


@given(rates, pushes)
def test_control_and_disturbance_move_alike_but_only_control_is_reported(rate, push):
    known = Truth(START, [Segment(30.0, rate, control_mps2=push)])
    unknown = Truth(START, [Segment(30.0, rate, disturbance_mps2=push)])
    time_s = np.linspace(-5.0, 40.0, 19)
    np.testing.assert_array_equal(known.state_at(time_s), unknown.state_at(time_s))
    np.testing.assert_array_equal(unknown.control_at(time_s), 0.0)
    reported = known.control_at([-1.0, 0.0, 29.9, 30.0])
    np.testing.assert_array_equal(reported, [(0.0, 0.0), push, push, (0.0, 0.0)])


@given(rates, pushes)
def test_the_motion_is_linear_in_the_control(rate, push):
    """What the papers' F x + G u takes for granted, with the turn turning the gain as well."""
    time_s = np.linspace(0.0, 50.0, 11)

    def path(u):
        return Truth(START, [Segment(50.0, rate, control_mps2=u)]).state_at(time_s)

    double = path((2 * push[0], 2 * push[1]))
    np.testing.assert_allclose(double - path((0, 0)), 2 * (path(push) - path((0, 0))), atol=1e-8)


def test_a_straight_under_control_is_a_parabola():
    truth = Truth([0, 10, 0, 0], [Segment(20.0, control_mps2=(-0.5, 0.25))])
    np.testing.assert_allclose(truth.state_at(20.0)[0], [100, 0, 50, 5], atol=1e-12)
    np.testing.assert_allclose(truth.state_at(30.0)[0], [100, 0, 100, 5], atol=1e-12)


def test_control_may_push_a_vessel_backwards_and_from_rest():
    back = Truth([0, 1, 0, 0], [Segment(10.0, control_mps2=(-1.0, 0.0)), Segment(5.0, 0.1)])
    np.testing.assert_allclose(back.state_at(10.0)[0], [-40, -9, 0, 0], atol=1e-12)
    assert np.hypot(*back.state_at(15.0)[0, 1::2]) == pytest.approx(9.0)
    rest = Truth([0, 0, 0, 0], [Segment(4.0, control_mps2=(0.0, 1.0))])
    np.testing.assert_allclose(rest.state_at(5.0)[0], [0, 0, 12, 4], atol=1e-12)


def test_switches_are_where_the_rate_changes():
    truth = Truth(
        START,
        [Segment(10.0), Segment(5.0), Segment(5.0, 0.1), Segment(5.0, 0.1, 0.2), Segment(5.0)],
        start_time_s=100.0,
    )
    np.testing.assert_allclose(truth.switch_times_s, [115.0, 125.0])
    assert len(Truth(START, [Segment(10.0)]).switch_times_s) == 0
    np.testing.assert_allclose(Truth(START, [Segment(10.0, 0.1)]).switch_times_s, [0.0, 10.0])


def test_the_control_switches_where_it_changes():
    north, other = (0.1, 0.0), (0.1, 0.2)
    pushed = [Segment(5.0, 0.1, control_mps2=u) for u in (north, north, other, (0.0, 0.0))]
    truth = Truth(START, pushed, start_time_s=100.0)
    np.testing.assert_allclose(truth.control_switch_times_s, [100.0, 110.0, 115.0])
    assert len(Truth(START, [Segment(10.0, 0.1)]).control_switch_times_s) == 0


def test_a_table_of_segments():
    segments = segments_from_table([(0, 90, 0.0), (90, 180, -0.02), (180.0, 240.0, 0.1)])
    assert [s.duration_s for s in segments] == [90.0, 90.0, 60.0]
    assert [s.turn_rate_rad_s for s in segments] == [0.0, -0.02, 0.1]


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([], "at least one row"),
        ([(0, 10)], "row 0 must be three finite numbers"),
        ([0, 10, 0], "row 0 must be three finite numbers"),
        ([("a", "b", "c")], r"row 0 .*got \('a', 'b', 'c'\)"),
        ([("0", "10", "0.1")], "row 0 must be three finite numbers"),
        ([(0, 10, 0), None], "row 1 .*got None"),
        ([(0, 10, 0), (10, (20, 30), 0)], "row 1 must be three finite numbers"),
        ([(0, 10, 0), (10, np.nan, 0)], "row 1 must be three finite numbers"),
        ([(0, 10, 0), (10, 10, 0)], "row 1 .*10.0 s"),
        ([(0, 10, 0), (9, 20, 0)], "row 1 begins at 9.0 s and overlaps with row 0"),
        ([(0, 10, 0), (11, 20, 0)], "row 1 begins at 11.0 s .* row 0"),
        ([(0, 10, 0), (10, 20, -0.3)], "row 1 turns at -0.3 rad/s, faster than 0.2"),
    ],
)
def test_tables_that_are_invalid_are_reported_by_row(rows, message):
    with pytest.raises(ValueError, match=message):
        segments_from_table(rows, max_turn_rate_rad_s=0.2)


@pytest.mark.parametrize("what", [None, 3.0])
def test_what_is_no_table_is_reported(what):
    with pytest.raises(TypeError, match=f"rows must be a sequence of .*got {what}"):
        segments_from_table(what)


@pytest.mark.parametrize("most", [-0.1, np.nan])
def test_a_fastest_turn_that_is_invalid(most):
    with pytest.raises(ValueError, match="max_turn_rate_rad_s must be at least 0"):
        segments_from_table([(0, 10, 0)], max_turn_rate_rad_s=most)


@pytest.mark.parametrize("name", ["control_mps2", "disturbance_mps2"])
def test_accelerations_are_pairs(name):
    with pytest.raises(ValueError, match=f"{name} must be two numbers"):
        Segment(1.0, **{name: (1.0, 2.0, 3.0)})
    with pytest.raises(ValueError, match="finite"):
        Segment(1.0, **{name: (np.inf, 0.0)})


# ------------------------------------------------------------------ disturbance

ORDERS = Truth(START, [Segment(95.0), Segment(100.0, 0.02)], start_time_s=7.0)


def test_the_same_seed_disturbs_alike_and_orders_stay():
    one, again = (disturbed(ORDERS, 0.01, 10.0, 4) for _ in range(2))
    time_s = np.linspace(0.0, 250.0, 51)
    np.testing.assert_array_equal(one.state_at(time_s), again.state_at(time_s))
    other = disturbed(ORDERS, 0.01, 10.0, 5)
    assert np.abs(one.state_at(190.0) - other.state_at(190.0)).max() > 0.1
    np.testing.assert_array_equal(one.turn_rate_at(time_s), ORDERS.turn_rate_at(time_s))
    np.testing.assert_array_equal(one.switch_times_s, ORDERS.switch_times_s)
    np.testing.assert_array_equal(one.control_at(time_s), 0.0)
    assert one.end_time_s == pytest.approx(ORDERS.end_time_s)
    np.testing.assert_allclose(one.state_at(7.0), ORDERS.state_at(7.0))


def test_accelerations_are_held_for_the_interval():
    pushes = {}
    shaken = disturbed(ORDERS, 0.01, 10.0, 1)
    for begin_s, segment in zip(
        np.cumsum([0.0, *(s.duration_s for s in shaken.segments)]), shaken.segments, strict=False
    ):
        pushes.setdefault(int((begin_s + 1e-9) // 10.0), set()).add(segment.disturbance_mps2)
    assert sorted(pushes) == list(range(20))
    assert all(len(same) == 1 for same in pushes.values())
    assert len(set.union(*pushes.values())) == 20


@given(rates, pushes.filter(any), st.floats(0.5, 39.0))
def test_under_a_disturbance_a_thrust_ends_when_it_has_taken_the_speed(rate, push, ends_s):
    braking = -np.hypot(START[1], START[3]) / ends_s
    whole = Truth(START, [Segment(40.0, rate, braking, disturbance_mps2=push)])
    halves = Truth(
        START,
        [
            Segment(ends_s, rate, braking, disturbance_mps2=push),
            Segment(40.0 - ends_s, rate, disturbance_mps2=push),
        ],
    )
    time_s = np.linspace(0.0, 60.0, 41)
    np.testing.assert_allclose(whole.state_at(time_s), halves.state_at(time_s), atol=1e-6)


STOPPING = Truth([0.0, 10.0, 0.0, 0.0], [Segment(60.0), Segment(100.0, 0.0, -0.1), Segment(100.0)])


@pytest.mark.parametrize("pieces_s", [[3.0], [1.0, 1.0, 1.0], [0.1] * 30])
def test_a_vessel_that_brakes_to_a_stop_does_not_go_astern(pieces_s):
    braking = [Segment(duration_s, 0.0, -0.1) for duration_s in pieces_s]
    truth = Truth([0.0, 0.3, 0.0, 0.0], [*braking, Segment(10.0)])
    state = truth.state_at([*np.cumsum(pieces_s), 5.0, 13.0])
    assert state[:, 1].min() >= 0.0
    np.testing.assert_array_equal(np.arctan2(state[:, 3], state[:, 1]), 0.0)
    assert state[-1, 0] == pytest.approx(0.45)


def test_a_vessel_that_brakes_to_a_stop_may_be_disturbed():
    time_s = np.linspace(0.0, 250.0, 51)
    for seed in range(30):
        disturbed(STOPPING, 0.01, 3.0, seed)
        hardly = disturbed(STOPPING, 1e-7, 3.0, seed)
        np.testing.assert_allclose(hardly.state_at(time_s), STOPPING.state_at(time_s), atol=0.02)


def drawn(**options):
    long = Truth(START, [Segment(8_000.0)])
    return np.array([s.disturbance_mps2 for s in disturbed(long, 0.1, 1.0, 3, **options).segments])


def test_the_default_law_is_cauchy_cut_off():
    pushes = drawn()
    assert np.abs(pushes).max() <= 2.0
    inside = np.arctan(1.0) / np.arctan(20.0)  # half of a Cauchy law lies within its scale
    assert np.mean(np.abs(pushes) < 0.1) == pytest.approx(inside, abs=0.01)
    beyond = 1.0 - np.arctan(5.0) / np.arctan(20.0)
    assert np.mean(np.abs(pushes) > 0.5) == pytest.approx(beyond, abs=0.01)


def test_many_degrees_of_freedom_are_gaussian():
    pushes = drawn(degrees_of_freedom=np.inf)
    assert pushes.std() == pytest.approx(0.1, rel=0.02)
    assert np.mean((pushes / pushes.std()) ** 4) == pytest.approx(3.0, abs=0.15)


def test_a_limit_holds():
    assert np.abs(drawn(limit_mps2=0.15)).max() <= 0.15


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((ORDERS, 0.0, 1.0, 0), "scale_mps2"),
        ((ORDERS, np.inf, 1.0, 0), "scale_mps2"),
        ((ORDERS, 0.1, 0.0, 0), "interval_s"),
        ((Truth(START), 0.1, 1.0, 0), "truth must have at least one segment"),
    ],
)
def test_disturbances_that_are_invalid(arguments, message):
    with pytest.raises(ValueError, match=message):
        disturbed(*arguments)
    with pytest.raises(ValueError, match="limit_mps2"):
        disturbed(ORDERS, 0.1, 1.0, 0, limit_mps2=0.01)
