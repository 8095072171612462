"""Results in one NPZ file: arrays, and everything else as one JSON text."""

from __future__ import annotations

import json
import tokenize
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from wakeline.recording import replacing

_FORMAT = "wakeline montecarlo 1"
_DAMAGES = (
    ValueError,
    KeyError,
    TypeError,
    AttributeError,
    EOFError,
    RuntimeError,
    SyntaxError,
    MemoryError,
    OverflowError,
    tokenize.TokenError,
    zipfile.BadZipFile,
    zlib.error,
)


def current_version() -> str:
    """Version of the package."""
    import wakeline

    return wakeline.__version__


def save(
    path: str | Path,
    outcomes: Mapping[tuple[str, str], Any],
    runs: int,
    seed: int,
    parameters: Mapping[str, Any],
    version: str,
) -> None:
    """Write the outcomes and their parameters."""
    arrays: dict[str, np.ndarray] = {}
    plain: list[dict[str, Any]] = []
    for k, outcome in enumerate(outcomes.values()):
        rest = {}
        for field in fields(outcome):
            value = getattr(outcome, field.name)
            if isinstance(value, np.ndarray):
                arrays[f"{k}.{field.name}"] = value
            else:
                rest[field.name] = value
        plain.append(rest)
    header = {
        "format": _FORMAT,
        "version": version,
        "seed": int(seed),
        "runs": int(runs),
        "parameters": dict(parameters),
        "outcomes": plain,
    }
    with replacing(path) as fresh, fresh.open("wb") as file:
        np.savez_compressed(file, header=np.array(json.dumps(header)), **arrays)


def load(path: str | Path, result_type: type, outcome_type: type) -> Any:
    """Read a result; ValueError if the file has none."""
    path = Path(path)
    try:
        with path.open("rb") as raw, np.load(raw, allow_pickle=False) as file:
            header = json.loads(str(file["header"]))
            if header["format"] != _FORMAT:
                raise ValueError(f"format {header['format']!r}")
            arrays = {name: file[name] for name in file.files if name != "header"}
            outcomes = {}
            for k, plain in enumerate(header["outcomes"]):
                prefix = f"{k}."
                own = {n.removeprefix(prefix): a for n, a in arrays.items() if n.startswith(prefix)}
                outcome = outcome_type(**plain, **own)
                outcomes[outcome.scenario, outcome.candidate] = outcome
            return result_type(
                outcomes, header["runs"], header["seed"], header["parameters"], header["version"]
            )
    except OSError as error:
        if error.strerror:
            raise ValueError(f"{path}: the file cannot be read ({error.strerror})") from error
        raise _foreign(path) from error
    except _DAMAGES as error:
        raise _foreign(path) from error


def _foreign(path: Path) -> ValueError:
    return ValueError(
        f"{path}: not a Monte Carlo result; wanted a whole NPZ file of format {_FORMAT!r} as "
        "Result.save writes, got another"
    )
