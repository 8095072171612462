"""Checks of arguments, shared by the modules."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Sequence
from numbers import Real
from typing import Any

import numpy as np

from wakeline._brief import cut, quoted

MOST_RUNS = 10**7


def whole_number(name: str, value: Any, least: int) -> None:
    """ValueError unless the named argument is an integer, at least `least`."""
    if not isinstance(value, (int, np.integer)) or value < least:
        raise ValueError(f"{name} must be a whole number, at least {least}, got {quoted(value)}")


def plain_numbers(**values: Any) -> None:
    """TypeError unless each argument is one real number."""
    for name, value in values.items():
        single = isinstance(value, np.ndarray) and value.shape == () and value.dtype.kind in "buif"
        if not (single or isinstance(value, Real)):
            raise TypeError(f"{name} must be a number, got {quoted(value)}")


def number_fields(settings: Any, *names: str) -> dict[str, Any]:
    """Fields of an object by their names, for the checks below."""
    return {name: getattr(settings, name) for name in names}


def finite(**values: Any) -> None:
    """TypeError unless each argument is one real number, ValueError unless it is finite."""
    _require("finite", np.isfinite, values)


def positive(**values: Any) -> None:
    """The same, and ValueError unless it is positive."""
    _require("finite and positive", lambda value: 0 < value < np.inf, values)


def not_negative(**values: Any) -> None:
    """The same, and ValueError if it is negative."""
    _require("finite and not negative", lambda value: 0 <= value < np.inf, values)


def at_least(least: float, **values: Any) -> None:
    """The same, and ValueError if it is less; infinity is allowed."""
    _require(f"at least {least:g}", lambda value: value >= least, values)


def above_zero(**values: Any) -> None:
    """The same, and ValueError unless it is positive; infinity is allowed."""
    _require("positive", lambda value: value > 0, values)


def fraction(**values: Any) -> None:
    """The same, and ValueError unless it is from 0 to 1."""
    _require("from 0 to 1", lambda value: 0 <= value <= 1, values)


def _require(wanted: str, holds: Callable[[Any], Any], values: dict[str, Any]) -> None:
    plain_numbers(**values)
    for name, value in values.items():
        if not holds(value):
            raise ValueError(f"{name} must be {wanted}, got {cut(str(value))}")


def listed(name: str, sequence: Any, of_what: str) -> list[Any]:
    """The named argument as a list; TypeError if it is not a sequence."""
    try:
        return list(sequence)
    except TypeError:
        raise TypeError(f"{name} must be a sequence of {of_what}, got {quoted(sequence)}") from None


def run_numbers(runs: Any, seed: Any, threads: Any) -> None:
    """ValueError unless these arguments of runs are valid; threads may be None."""
    whole_number("runs", runs, 1)
    if runs > MOST_RUNS:
        raise ValueError(f"runs must be at most {MOST_RUNS}, got {runs}")
    whole_number("seed", seed, 0)
    if threads is not None:
        whole_number("threads", threads, 1)


def entropy(seed: Any, purpose: str) -> list[int]:
    """Seed of a random generator: the numbers of a seed, one or several, and a purpose.

    ValueError unless those of the seed are non-negative integers.
    """
    seeds = list(seed) if np.ndim(seed) else [seed]
    for number in seeds:
        whole_number("seed", number, 0)
    return [*map(int, seeds), zlib.crc32(purpose.encode())]


def real_numbers(name: str, values: Any) -> np.ndarray:
    """The named argument as an array of real numbers; masked numbers are NaN.

    TypeError for text, times and complex numbers, ValueError for ragged sequences.
    """
    masked = isinstance(values, np.ma.MaskedArray)
    try:
        numbers = np.asarray(values)
        _reject_others(numbers)
        return values.astype(float).filled(np.nan) if masked else numbers.astype(float, copy=False)
    except (TypeError, ValueError) as error:
        raise type(error)(f"{name} must hold real numbers: {error}") from None


def shaped(name: str, values: Any, *shape: int | None) -> np.ndarray:
    """Real numbers of the given shape (None: any length); ValueError for another shape."""
    numbers = real_numbers(name, values)
    lengths = zip(shape, numbers.shape, strict=False)
    if numbers.ndim != len(shape) or any(wanted not in (None, got) for wanted, got in lengths):
        text = str(shape).replace("None", "n")
        raise ValueError(f"{name} must have shape {text}, got {numbers.shape}")
    return numbers


def columns(table: Any, time: str, *names: str, optional: Sequence[str] = ()) -> None:
    """Convert fields of a frozen dataclass to arrays (n,) with one number per time of `time`.

    ValueError if the lengths differ or the times are not in order; optional ones may be None.
    """
    time_s = shaped(time, getattr(table, time), None)
    if not (np.isfinite(time_s).all() and (np.diff(time_s) >= 0).all()):
        raise ValueError(f"{time} must be finite and in order, got {cut(str(time_s))}")
    given = [name for name in optional if getattr(table, name) is not None]
    for name in (time, *names, *given):
        object.__setattr__(table, name, shaped(name, getattr(table, name), len(time_s)))


def _reject_others(numbers: np.ndarray) -> None:
    kind = numbers.dtype.kind
    if kind in "Mmc":
        raise TypeError(f"got {numbers.dtype}")
    text = (one for one in numbers.flat if isinstance(one, (str, bytes)))
    example = next(text, None) if kind in "USO" else None
    if example is not None:
        raise TypeError(f"got text such as {quoted(str(example))}")


def in_a_row(name: str, values: Any) -> np.ndarray:
    """Numbers (T,), T = 1 for a single number; ValueError if the argument has more axes."""
    row = np.atleast_1d(real_numbers(name, values))
    if row.ndim != 1:
        raise ValueError(f"{name} must be a number or have shape (T,), got {row.shape}")
    return row
