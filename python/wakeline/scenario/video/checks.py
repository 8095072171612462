"""Checks of the fields of a settings object, by their names."""

from __future__ import annotations

from typing import Any

import numpy as np


def finite(settings: Any, *names: str) -> None:
    """ValueError unless each of the fields is a finite number."""
    for name in names:
        if not np.isfinite(_number(settings, name)):
            raise ValueError(f"{name} must be finite, got {getattr(settings, name)}")


def positive(settings: Any, *names: str) -> None:
    """ValueError unless each of the fields is finite and above zero."""
    for name in names:
        if not 0 < _number(settings, name) < np.inf:
            raise ValueError(f"{name} must be positive and finite, got {getattr(settings, name)}")


def not_negative(settings: Any, *names: str) -> None:
    """ValueError unless each of the fields is finite and zero or more."""
    for name in names:
        if not 0 <= _number(settings, name) < np.inf:
            raise ValueError(
                f"{name} must be finite and not negative, got {getattr(settings, name)}"
            )


def at_least(settings: Any, least: float, *names: str) -> None:
    """ValueError unless each of the fields is `least` or more; inf is allowed."""
    for name in names:
        if not _number(settings, name) >= least:
            raise ValueError(f"{name} must be at least {least}, got {getattr(settings, name)}")


def fraction(settings: Any, *names: str) -> None:
    """ValueError unless each of the fields is from 0 to 1."""
    for name in names:
        if not 0 <= _number(settings, name) <= 1:
            raise ValueError(f"{name} must be from 0 to 1, got {getattr(settings, name)}")


def _number(settings: Any, name: str) -> float:
    value = getattr(settings, name)
    if not isinstance(value, (int, float, np.integer, np.floating)) or isinstance(value, bool):
        raise TypeError(f"{name} must be a number, got {value!r}")
    return float(value)
