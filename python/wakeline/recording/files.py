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
    """Yield a temporary path beside `path`; on success that file replaces `path`.

    When the block raises, `path` is unchanged and the temporary file is removed. The temporary path
    keeps the suffix of `path`. If `path` is a link, its target is replaced; a pipe or a device
    receives the content.

    Parameters
    ----------
    path : str or Path
        The file to write. Its folder must exist.

    Raises
    ------
    OSError
        When the temporary file cannot be written or cannot replace `path`; it names `path`.
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
    """Raise OSError naming `path` if `replacing` could not write a file there."""
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
    """Whether the path exists but is neither a file nor a folder."""
    return path.exists() and not path.is_file() and not path.is_dir()


def _led_to(path: Path) -> Path:
    """The final target of a link; any other path itself."""
    return Path(os.path.realpath(path)) if path.is_symlink() else path


def _beside(target: Path, suffix: str) -> Path:
    return target.with_name(f".{target.stem}-{secrets.token_hex(4)}{suffix}")


@contextmanager
def _named(fresh: Path, path: Path) -> Iterator[None]:
    """Errors about the temporary file name the requested one."""
    try:
        yield
    except OSError as error:
        nameless = error.filename is None and error.errno is not None
        if not nameless and (error.filename is None or Path(error.filename) != fresh):
            raise
        raise OSError(error.errno, error.strerror, str(path)) from None
