"""Output files that are replaced only when they are complete."""

from __future__ import annotations

import errno
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Give a fresh path beside `path`; on success the file written there takes the place of `path`.

    When the block raises, what stood at `path` is left as it was and the fresh file is removed. The
    fresh path keeps the suffix of `path`.

    Parameters
    ----------
    path : str or Path
        The file to write. Its folder must exist.

    Raises
    ------
    OSError
        Naming `path`, when the fresh file cannot be written or cannot take its place.
    """
    path = Path(path)
    fresh = _beside(path)
    try:
        with _named(fresh, path):
            yield fresh
            fresh.replace(path)
    finally:
        with suppress(OSError):
            fresh.unlink()


def check_writable(path: str | Path) -> None:
    """Raise OSError naming `path` where `replacing` could not write a file there."""
    path = Path(path)
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    fresh = _beside(path)
    with _named(fresh, path):
        fresh.touch()
        fresh.unlink()


def _beside(path: Path) -> Path:
    return path.with_name(f".{path.stem}-{secrets.token_hex(4)}{path.suffix}")


@contextmanager
def _named(fresh: Path, path: Path) -> Iterator[None]:
    """Errors about the fresh file name the one that was asked for."""
    try:
        yield
    except OSError as error:
        if error.filename is None or Path(error.filename) != fresh:
            raise
        raise OSError(error.errno, error.strerror, str(path)) from None
