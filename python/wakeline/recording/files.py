"""Output files that are replaced only when they are complete."""

from __future__ import annotations

import errno
import os
import secrets
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Give a fresh path beside `path`; on success the file written there takes the place of `path`.

    When the block raises, what stood at `path` is left as it was and the fresh file is removed. The
    fresh path keeps the suffix of `path`. Where `path` is a link, what it leads to is replaced; a
    pipe or a device takes the content and stays what it is.

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
    if _is_stream(path):
        with tempfile.TemporaryDirectory() as folder:
            fresh = Path(folder, path.name)
            yield fresh
            with _named(path, path), fresh.open("rb") as source, path.open("wb") as stream:
                shutil.copyfileobj(source, stream)
        return
    target = _led_to(path)
    fresh = _beside(target, path.suffix)
    try:
        with _named(fresh, path):
            yield fresh
            fresh.replace(target)
    finally:
        with suppress(OSError):
            fresh.unlink()


def check_writable(path: str | Path) -> None:
    """Raise OSError naming `path` where `replacing` could not write a file there."""
    path = Path(path)
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if _is_stream(path):
        if not os.access(path, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return
    fresh = _beside(_led_to(path), path.suffix)
    with _named(fresh, path):
        fresh.touch()
        fresh.unlink()


def _is_stream(path: Path) -> bool:
    """Whether the path is there but neither a file nor a folder."""
    return path.exists() and not path.is_file() and not path.is_dir()


def _led_to(path: Path) -> Path:
    """What a link leads to in the end; any other path itself."""
    return Path(os.path.realpath(path)) if path.is_symlink() else path


def _beside(target: Path, suffix: str) -> Path:
    return target.with_name(f".{target.stem}-{secrets.token_hex(4)}{suffix}")


@contextmanager
def _named(fresh: Path, path: Path) -> Iterator[None]:
    """Errors about the fresh file name the one that was asked for."""
    try:
        yield
    except OSError as error:
        nameless = error.filename is None and error.errno is not None
        if not nameless and (error.filename is None or Path(error.filename) != fresh):
            raise
        raise OSError(error.errno, error.strerror, str(path)) from None
