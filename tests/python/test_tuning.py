"""Settings by maximum likelihood: of simulated radars, of a real one, and where plots are few."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

import wakeline as wl
from wakeline import metrics
from wakeline.cli import main
from wakeline.scenario import RadarSimulator, TrackTruth
from wakeline.tracking import Settings, read_settings

PERIOD_S = 2.5
RADAR = RadarSimulator(
    10.0, np.deg2rad(0.4), PERIOD_S, detection_probability=0.85, clutter_per_scan=3, max_range_m=8e3
)
PSD_M2S3 = 0.1
SCANS = 80


def wanderer(rng):
    """A vessel with white acceleration noise."""
    F = np.array([[1.0, PERIOD_S], [0.0, 1.0]])
    Q = PSD_M2S3 * np.array([[PERIOD_S**3 / 3, PERIOD_S**2 / 2], [PERIOD_S**2 / 2, PERIOD_S]])
    state = np.array([rng.uniform(-3e3, 3e3, 2), rng.uniform(-8.0, 8.0, 2)])
    states = [state]
    for _ in range(SCANS + 2):
        states.append(F @ states[-1] + np.linalg.cholesky(Q) @ rng.normal(size=(2, 2)))
    return TrackTruth(PERIOD_S * np.arange(len(states)), *np.array(states)[:, 0].T)


@pytest.fixture(scope="module")
def simulated():
    rng = np.random.default_rng(0)
    return RADAR.record({str(k): wanderer(rng) for k in range(8)}, SCANS, rng)


@pytest.fixture(scope="module")
def tuned(simulated):
    """From a wrong radar and half of the noise, which all motion models share."""
    noise = {"psd_m2s3": 0.5 * PSD_M2S3, "course_psd_rad2s": 0.0}
    modes = ("cruising", "steady", "restless", "turning")
    models = wl.VesselModels(
        **{f"{mode}_{name}": value for mode in modes for name, value in noise.items()},
        turn_rate_psd_rad2s3=0.0,
        prior_turn_rate_std_rad_s=1e-6,
    )
    radar = wl.Radar(
        range_std_m=14.0, bearing_std_rad=np.deg2rad(0.3), extent_std_m=0.0, period_s=PERIOD_S
    )
    config = wl.TrackerConfig(outlier_probability=0.0, visible_time_s=0.0)
    return wl.tune(simulated, radar=radar, vessels=models, config=config)


@pytest.mark.parametrize(
    ("name", "truth"),
    [
        ("range_std_m", 10.0),
        ("bearing_std_deg", 0.4),
        ("noise_scale", 2.0),
        ("detection_probability", 0.85),
    ],
)
def test_simulated_truth_is_found_within_two_standard_deviations(tuned, name, truth):
    found = tuned[name]
    assert found.determined
    assert abs(found.value - truth) < 2.0 * found.std
    assert found.std < 0.2 * truth


def test_tuned_settings_make_innovations_consistent(tuned):
    low, high = tuned.nis_bounds
    assert low < tuned.nis_after < high
    assert not low < tuned.nis_before < high


def test_what_is_given_as_zero_remains_zero(tuned):
    assert not tuned["extent_std_m"].determined
    assert tuned.settings.radar["extent_std_m"] == 0.0
    assert math.isnan(tuned["extent_std_m"].std)


def test_what_was_found_is_in_the_settings(tuned):
    settings = tuned.settings
    for name in ("range_std_m", "bearing_std_deg"):
        assert settings.radar[name] == pytest.approx(tuned[name].value, rel=1e-3)
    psd_m2s3 = settings.models["restless_psd_m2s3"]
    assert psd_m2s3 == pytest.approx(0.5 * PSD_M2S3 * tuned["noise_scale"].value, rel=1e-3)
    assert settings.models["cruising_sojourn_s"] == Settings.default().models["cruising_sojourn_s"]
    assert "detection_probability" in repr(tuned)


@pytest.fixture(scope="module")
def joyride(tmp_path_factory):
    """The command on a real recording, from the defaults of every radar."""
    out = tmp_path_factory.mktemp("tune")
    radar = out / "radar.toml"
    radar.write_text("range_std_m = 10.0\nbearing_std_deg = 1.01\n")
    arguments = ["--radar", str(radar), "--out", str(out), "--json", str(out / "tune.json")]
    assert main(["tune", "joyride", *arguments]) == 0
    return out


def test_a_real_radar_is_found_from_plots_alone(joyride):
    written = json.loads((joyride / "tune.json").read_text())
    found = {row["parameter"]: row for row in written["rows"]}
    shipped = wl.recording.load_radar("joyride")
    for name in ("range_std_m", "extent_std_m"):
        assert found[name]["determined"]
        assert abs(found[name]["value"] - shipped[name]) < 2.0 * found[name]["std"]


def test_tuned_settings_track_as_well_as_the_shipped_ones(joyride):
    recording = wl.recording.load("joyride")
    settings = read_settings(joyride / "settings.toml")
    tuned = metrics.score(wl.track_recording(recording, config=settings), recording).overall
    shipped = metrics.score(wl.track_recording(recording), recording).overall
    assert tuned.coverage > 0.97 * shipped.coverage
    for name in ("position_rmse_debiased_m", "velocity_rmse_mps", "course_rms_deg"):
        assert getattr(tuned.errors, name) < 1.03 * getattr(shipped.errors, name)


def test_too_few_plots_are_rejected(simulated):
    episode = simulated.episodes[0]
    short = replace(simulated, episodes=[replace(episode, scans=episode.scans[:4], truth=None)])
    with pytest.raises(ValueError, match="too few"):
        wl.tune(short)
