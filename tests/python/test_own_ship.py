"""Own ship's solution from Python; what it is worth is in the tests of the command."""

import numpy as np

from wakeline import own_ship, recording


def longest_part(**options):
    """Of the log that ships with the package."""
    return max(recording.load_navigation(**options).parts(), key=lambda part: len(part.fixes))


def test_the_bundled_log_is_navigated():
    part = longest_part()
    offset = own_ship.magnetic_offset([part])
    readings = own_ship.readings_of(part, offset)
    track = own_ship.navigate(readings)
    fixed = readings.has_fix & (track.status == "ok")
    away_m = np.hypot(*(track.position_m - readings.fix_m)[fixed].T)
    assert np.median(away_m) < own_ship.JUMP_M / 10
    errors = own_ship.medians(own_ship.hold_out(readings)["navigator"])
    assert list(errors) == list(own_ship.HORIZONS_S)
    assert 0 < errors[10.0] < errors[30.0] < errors[60.0] < 20.0


def test_smoothed_it_is_surer_of_the_same_voyage():
    readings = own_ship.readings_of(longest_part(variation_deg=2.0))
    as_it_went = own_ship.navigate(readings)
    smoothed = own_ship.navigate(readings, smooth=True)
    np.testing.assert_array_equal(smoothed.status, as_it_went.status)
    np.testing.assert_array_equal(smoothed.time_s, readings.time_s)

    def variance_m2(track):
        return np.trace(track.position_m2, axis1=1, axis2=2)

    assert np.median(variance_m2(smoothed) / variance_m2(as_it_went)) < 0.6
