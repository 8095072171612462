"""The search study: predicted POS against objects that drift and are found by chance."""

import numpy as np
import pytest

from wakeline import search as ws
from wakeline import study
from wakeline.study.search import binomial_band


@pytest.fixture(scope="module")
def report():
    return study.load("search").run(500, 0)


def test_it_has_a_row_for_each_pattern_and_plan(report):
    assert "search" in study.names()
    assert [(row["scenario"], row["estimator"]) for row in report.rows] == [
        (kind, name) for kind in ws.PATTERNS for name in ("plan", "naive", "bound")
    ]
    for row in report.rows:
        assert row["found_runs"] == pytest.approx(500 * row["pos_found"])


@pytest.mark.parametrize("kind", ws.PATTERNS)
def test_the_prediction_is_within_the_binomial_band(report, kind):
    for name in ("plan", "naive"):
        row = report.row(kind, name)
        low, high = binomial_band(row["pos_predicted"], 500)
        assert low <= row["found_runs"] <= high


@pytest.mark.parametrize("kind", ws.PATTERNS)
def test_the_plan_finds_more_and_not_more_than_the_bound(report, kind):
    plan, naive, bound = (report.row(kind, name) for name in ("plan", "naive", "bound"))
    assert plan["found_runs"] >= naive["found_runs"]
    assert naive["pos_predicted"] <= plan["pos_predicted"] <= bound["pos_predicted"]


def test_the_best_pattern_finds_a_quarter_more_than_a_naive_square(report):
    best = max(report.row(kind, "plan")["found_runs"] for kind in ws.PATTERNS)
    assert best >= 1.25 * report.row("expanding_square", "naive")["found_runs"]


@pytest.mark.parametrize("probability", [0.02, 0.3, 0.5, 0.97])
def test_the_band_has_the_share_of_a_binomial(probability):
    low, high = binomial_band(probability, 500)
    found = np.random.default_rng(1).binomial(500, probability, 200_000)
    inside = np.mean((low <= found) & (found <= high))
    assert 0.989 <= inside <= 0.996
