"""Tables and labeled arrays of pandas and xarray, which are optional."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from wakeline._checks import shaped

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset

    from wakeline import RunResult

# The arrays of a result of a run, with their dimensions after those of run and scan.
_ARRAYS = {
    "mean": ("state",),
    "covariance": ("state", "state_too"),
    "mode_probability": ("mode",),
    "turn_rate_rad_s": ("mode",),
    "innovation": ("reading",),
    "nis": (),
    "log_likelihood": (),
    "status": (),
}
_COLUMNS = {"mode_probability": "mode", "turn_rate_rad_s": "turn_rate"}


def data_frame(columns: Mapping[str, Any]) -> DataFrame:
    """A table of columns of equal length."""
    return _library("pandas").DataFrame(dict(columns))


def run_table(result: RunResult, time_s: Any = None) -> DataFrame:
    """The result of a run as a table; as documented at `RunResult.to_pandas`."""
    pandas = _library("pandas")
    shape = np.shape(result.nis)
    name = "scan" if time_s is None else "time_s"
    index = pandas.Index(_scans(time_s, shape[-1]), name=name)
    if len(shape) > 1:
        runs = pandas.RangeIndex(shape[0], name="run")
        index = pandas.MultiIndex.from_product([runs, index])
    return pandas.DataFrame(dict(_columns(result, len(shape))), index=index)


def run_dataset(result: RunResult, time_s: Any = None) -> Dataset:
    """The result of a run as labeled arrays; as documented at `RunResult.to_xarray`."""
    xarray = _library("xarray")
    shape = np.shape(result.nis)
    before = ("run", "scan")[2 - len(shape) :]
    arrays = {name: getattr(result, name) for name in _ARRAYS}
    coordinates = {} if time_s is None else {"scan": _scans(time_s, shape[-1])}
    return xarray.Dataset(
        {k: ((*before, *_ARRAYS[k]), v) for k, v in arrays.items() if v is not None},
        coords=coordinates,
    )


def _columns(result: RunResult, axes: int) -> Iterator[tuple[str, np.ndarray]]:
    for name, dimensions in _ARRAYS.items():
        array = getattr(result, name)
        if array is None:
            continue
        array = np.asarray(array)
        rows = array.reshape(-1, *array.shape[axes:])
        if name == "covariance":
            with np.errstate(invalid="ignore"):
                rows = np.sqrt(np.diagonal(rows, axis1=1, axis2=2))
            name, dimensions = "std", ("state",)
        if not dimensions:
            yield name, rows
        for k, column in enumerate(rows.T if dimensions else (), start=1):
            yield f"{_COLUMNS.get(name, name)}_{k}", column


def _scans(time_s: Any, scans: int) -> np.ndarray:
    return np.arange(scans) if time_s is None else shaped("time_s", time_s, scans)


def _library(name: str) -> Any:
    try:
        return import_module(name)
    except ImportError:
        raise ImportError(f"this needs {name}: pip install {name}") from None
