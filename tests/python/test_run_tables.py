"""Results of `run` as tables of pandas and labeled arrays of xarray."""

import sys

import numpy as np
import pytest

import wakeline as wl

SENSOR = wl.RangeBearing(range_std_m=20.0, bearing_std_rad=0.01)
Z = np.random.default_rng(0).normal(size=(3, 6, 2)) * [20.0, 0.01] + [1000.0, 0.5]
TIME_S = 2.0 * np.arange(6)


def results():
    """Of one model and of several, of one run and of three."""
    ekf = wl.Ekf(wl.ConstantVelocity())
    imm = wl.Imm([ekf, ekf], wl.ModeChain.from_sojourn_s([60.0, 60.0]))
    start = wl.one_point(SENSOR, Z[0, 0], 5.0)
    for estimator in (ekf, imm):
        for z in (Z, Z[0]):
            yield estimator.run(z, dt_s=2.0, sensor=SENSOR, start=start)


@pytest.mark.parametrize("result", list(results()), ids=["runs", "run", "runs-imm", "run-imm"])
def test_a_table_has_a_row_per_scan_and_the_numbers_of_the_arrays(result):
    pytest.importorskip("pandas")
    table = result.to_pandas(TIME_S)
    runs = result.nis.shape[:-1]
    assert table.index.names == ["run", "time_s"][1 - len(runs) :]
    assert len(table) == result.nis.size
    last = table.xs(TIME_S[-1], level="time_s") if runs else table.loc[[TIME_S[-1]]]
    np.testing.assert_array_equal(
        last[["mean_1", "mean_4"]], result.mean[..., -1, [0, 3]].reshape(-1, 2)
    )
    np.testing.assert_allclose(last["std_3"] ** 2, result.covariance[..., -1, 2, 2].ravel())
    np.testing.assert_array_equal(table["nis"], result.nis.ravel())
    assert ("mode_2" in table) == (result.mode_probability is not None)
    assert result.to_pandas().index.names[-1] == "scan"


def test_labeled_arrays_keep_their_dimensions():
    pytest.importorskip("xarray")
    for result in results():
        data = result.to_xarray(TIME_S)
        np.testing.assert_array_equal(data["mean"].sel(scan=4.0), result.mean[..., 2, :])
        assert data["covariance"].dims[-2:] == ("state", "state_too")
        assert ("mode" in data.dims) == (result.mode_probability is not None)


@pytest.mark.parametrize(("library", "method"), [("pandas", "to_pandas"), ("xarray", "to_xarray")])
def test_a_missing_library_is_named(monkeypatch, library, method):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(ImportError, match=f"pip install {library}"):
        getattr(next(results()), method)()


def test_times_are_one_per_scan():
    pytest.importorskip("pandas")
    with pytest.raises(ValueError, match="time_s"):
        next(results()).to_pandas(TIME_S[:-1])
