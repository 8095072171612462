"""Optimal assignment against trying everything."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from wakeline.association import assign, assign_sparse

sizes = st.tuples(st.integers(0, 5), st.integers(0, 5))
costs = hnp.arrays(float, sizes, elements=st.floats(-100.0, 100.0))
gated = hnp.arrays(float, sizes, elements=st.floats(-100.0, 100.0) | st.just(np.inf))


def best(cost):
    """(pairs, total) of the best assignment: the most pairs, then the least cost."""
    rows, columns = cost.shape
    if rows > columns:
        return best(cost.T)
    found = (0, 0.0)
    for chosen in itertools.permutations(range(columns), rows):
        picked = cost[range(rows), list(chosen)] if rows else np.zeros(0)
        picked = picked[np.isfinite(picked)]
        found = min(found, (-len(picked), picked.sum()))
    return -found[0], found[1]


@given(costs | gated)
def test_the_assignment_is_the_best_there_is(cost):
    pairs = assign(cost)
    count, total = best(cost)
    assert len(pairs) == count
    picked = cost[pairs[:, 0], pairs[:, 1]]
    assert np.isfinite(picked).all()
    assert picked.sum() == pytest.approx(total, abs=1e-9)


@given(gated)
def test_no_row_and_no_column_is_used_twice(cost):
    pairs = assign(cost)
    assert pairs.dtype == np.int64
    assert len(set(pairs[:, 0])) == len(set(pairs[:, 1])) == len(pairs)
    assert (np.diff(pairs[:, 0]) > 0).all()


@given(costs, st.floats(-1e3, 1e3))
def test_a_constant_changes_nothing_about_the_total(cost, constant):
    moved = assign(cost + constant)
    picked = cost[moved[:, 0], moved[:, 1]]
    assert picked.sum() == pytest.approx(best(cost)[1], abs=1e-7)


@pytest.mark.parametrize("shape", [(0, 0), (0, 4), (4, 0)])
def test_nothing_to_assign(shape):
    assert assign(np.zeros(shape)).shape == (0, 2)


def test_everything_forbidden():
    assert assign(np.full((3, 3), np.inf)).shape == (0, 2)


def test_the_greedy_choice_is_not_the_best():
    np.testing.assert_array_equal(assign([[1.0, 2.0], [2.0, 100.0]]), [[0, 1], [1, 0]])


@pytest.mark.parametrize("cost", [np.nan, -np.inf])
def test_what_neither_costs_nor_forbids_is_an_error(cost):
    with pytest.raises(ValueError, match=f"cost must be numbers.* got {cost}"):
        assign([[1.0, cost]])
    with pytest.raises(ValueError, match=f"data must be numbers.* got {cost}"):
        assign_sparse([0, 1], [0], [cost], unassigned_cost=1.0, columns=1)


@pytest.mark.parametrize("shape", [(3,), (2, 2, 2), ()])
def test_a_cost_must_be_a_matrix(shape):
    with pytest.raises(ValueError, match=r"cost must have shape \(rows, columns\), got"):
        assign(np.zeros(shape))


def test_strides_and_integers_are_taken():
    cost = np.arange(64).reshape(8, 8) * -1
    np.testing.assert_array_equal(assign(cost[::2, ::3]), assign(cost[::2, ::3].copy()))


@given(costs | gated, st.floats(-100.0, 100.0))
def test_a_sparse_assignment_costs_the_least(cost, unassigned_cost):
    rows, columns = cost.shape
    row, column = np.nonzero(np.isfinite(cost))
    start = np.concatenate([[0], np.cumsum(np.isfinite(cost).sum(axis=1))])
    pairs = assign_sparse(
        start, column, cost[row, column], unassigned_cost=unassigned_cost, columns=columns
    )
    assert len(set(pairs[:, 0])) == len(set(pairs[:, 1])) == len(pairs)
    total = cost[pairs[:, 0], pairs[:, 1]].sum() + unassigned_cost * (rows - len(pairs))
    ways_out = np.full((rows, rows), unassigned_cost)
    assert total == pytest.approx(best(np.hstack([cost, ways_out]))[1], abs=1e-9)


def test_each_row_has_its_own_way_out():
    pairs = assign_sparse([0, 1, 2], [0, 0], [1.0, 2.0], unassigned_cost=[1.5, 9.0], columns=1)
    assert pairs.tolist() == [[1, 0]]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"indptr": [0, 2, 1]}, "indptr"),
        ({"indptr": [0, 1, 3]}, "indptr"),
        ({"indptr": [1, 1, 2]}, "indptr"),
        ({"indptr": [0, 1, 1]}, "indptr"),
        ({"indices": [0, 2]}, "indices .* got 2"),
        ({"indices": [0, -1]}, "indices .* got -1"),
        ({"indices": [0]}, "indices"),
        ({"unassigned_cost": np.inf}, "unassigned_cost must be finite, got inf"),
        ({"unassigned_cost": [1.0]}, "unassigned_cost"),
        ({"columns": -1}, "columns"),
    ],
)
def test_what_is_no_sparse_matrix_is_rejected(change, words):
    good = {
        "indptr": [0, 1, 2],
        "indices": [0, 1],
        "data": [1.0, 2.0],
        "unassigned_cost": 3.0,
        "columns": 2,
    }
    assert assign_sparse(**good).tolist() == [[0, 0], [1, 1]]
    with pytest.raises(ValueError, match=words):
        assign_sparse(**good | change)


@pytest.mark.parametrize("name", ["indptr", "indices"])
@pytest.mark.parametrize(
    ("wrong", "error", "words"),
    [
        (0.9, ValueError, "got 0.9"),
        (np.nan, ValueError, "got nan"),
        (1j, TypeError, "real numbers"),
    ],
)
def test_places_that_are_no_whole_numbers_are_rejected(name, wrong, error, words):
    places = {"indptr": [0, 1, 2], "indices": [0, 1]}
    places[name][1] = wrong
    with pytest.raises(error, match=words):
        assign_sparse(**places, data=[1.0, 2.0], unassigned_cost=3.0, columns=2)


def test_a_sparse_matrix_may_be_empty():
    nothing = assign_sparse([0], [], [], unassigned_cost=1.0, columns=3)
    assert nothing.shape == (0, 2)
