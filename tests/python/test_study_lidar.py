"""A lidar beside a radar: the laws of the study ``lidar`` on the five runs of real data."""

import numpy as np
import pytest

from wakeline import recording
from wakeline.study import lidar


@pytest.fixture(scope="module")
def report():
    return lidar.run(runs=1)


def runs_of(report):
    return sorted({row["scenario"] for row in report.rows} - {"mean"})


def test_both_are_nowhere_worse_than_either_alone(report):
    runs = runs_of(report)
    assert len(runs) == 5
    for name in runs:
        both, *alone = (report.row(name, one) for one in ("both", "radar", "lidar"))
        assert both["coverage"] >= max(one["coverage"] for one in alone)
        assert both["velocity_to_radar"] <= 1.02
        assert both["velocity_to_lidar"] <= 0.8


def test_both_are_better_than_either_alone_in_the_mean(report):
    both, *alone = (report.row("mean", one) for one in ("both", "radar", "lidar"))
    assert both["coverage"] > max(one["coverage"] for one in alone)
    assert both["velocity_to_radar"] < 0.99
    better = [name for name in runs_of(report) if report.row(name, "both")["velocity_to_radar"] < 1]
    assert len(better) >= 4


@pytest.mark.parametrize("k", range(5))
def test_late_data_change_nothing_in_the_end(k):
    episodes = {
        "radar": recording.load("autoferry").episodes[k],
        "lidar": recording.load_lidar().episodes[k],
    }
    in_time, *late = (
        lidar.follow(episodes, lidar.ESTIMATORS[name])[0]
        for name in ("both", "lidar_late", "radar_late")
    )
    assert len(in_time)
    for table in late:
        np.testing.assert_array_equal(table.track_id, in_time.track_id)
        np.testing.assert_array_equal(table.mean, in_time.mean)
        np.testing.assert_array_equal(table.covariance, in_time.covariance)
