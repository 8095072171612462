"""Tables and labeled arrays of pandas and xarray, which are optional."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pandas import DataFrame


def library(name: str) -> Any:
    """An optional library.

    Raises
    ------
    ImportError
        When it is not installed.
    """
    try:
        return import_module(name)
    except ImportError:
        raise ImportError(f"this needs {name}: pip install {name}") from None


def data_frame(columns: Mapping[str, Any]) -> DataFrame:
    """A table of columns of equal length."""
    return library("pandas").DataFrame(dict(columns))
