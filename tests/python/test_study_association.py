"""Dense traffic: the scenes are what they say, and the tracker holds them."""

import numpy as np
import pytest

from wakeline.scenario.dense import MERGED_M, SCENES
from wakeline.study import association

# scene: GOSPA, m; coverage; false tracks; scans until a vessel is shown
MUST = {
    "crossings": (60.0, 0.99, 0, 4.5),
    "abreast": (65.0, 0.94, 0, 8.0),
    "clutter_300": (66.0, 0.99, 1, 5.6),
    "clutter_1000": (70.0, 0.96, 1, 9.0),
    "merged": (45.0, 0.98, 0, 4.5),
}


@pytest.fixture(scope="module")
def recordings():
    return {name: association.record(name, 1) for name in MUST}


@pytest.mark.parametrize("name", MUST)
def test_truth_is_in_range_and_clutter_as_dense_as_given(recordings, name):
    scene, (episode,) = SCENES[name], recordings[name].episodes
    for truth in episode.truth.values():
        state = truth.state_at(episode.time_s)
        range_m = np.hypot(state[:, 0], state[:, 2])
        assert range_m.min() > 400.0
        assert range_m.max() < scene.radar.max_range_m
    seen = scene.radar.detection_probability * len(episode.truth)
    expected = scene.radar.clutter_per_scan + seen
    found = np.mean([len(scan) for scan in episode.scans])
    assert found == pytest.approx(expected, rel=0.1)


def test_a_run_is_the_same_for_a_seed_and_another_for_another():
    once, again, other = (SCENES["abreast"].record(seed).episodes[0] for seed in (3, 3, 4))
    np.testing.assert_array_equal(once.scans[9].range_m, again.scans[9].range_m)
    assert len(once.scans[9]) != len(other.scans[9]) or not np.array_equal(
        once.scans[9].range_m, other.scans[9].range_m
    )


def test_two_vessels_near_each_other_give_one_plot(recordings):
    (episode,) = recordings["merged"].episodes
    names = sorted(episode.truth, key=int)
    for k, scan in enumerate(episode.scans):
        for first, second in zip(names[::2], names[1::2], strict=True):
            a, b = (
                episode.truth[n].state_at(episode.time_s[k : k + 1])[0] for n in (first, second)
            )
            if np.hypot(*(a - b)[0::2]) < 0.5 * MERGED_M:
                middle = 0.5 * (a + b)[0::2]
                near = np.hypot(*(scan.position_m - middle).T) < 30.0
                assert near.sum() <= 2  # its plot, and perhaps a false one


@pytest.mark.parametrize("name", MUST)
def test_the_tracker_holds_dense_traffic_with_nothing_given(recordings, name):
    found = association.figures(association.track(recordings[name], "tracker"), recordings[name])
    gospa_m, coverage, false_tracks, delay_scans = MUST[name]
    assert found["gospa_m"] <= gospa_m
    assert found["coverage"] >= coverage
    assert found["false_tracks"] <= false_tracks
    assert found["delay_scans"] <= delay_scans
