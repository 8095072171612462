"""Output files that are replaced only when they are complete."""

from __future__ import annotations

import errno
import glob
import json
import os
import re
import secrets
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

_COMPLETE = ".wakeline-complete"  # folder of files that replace those of an earlier run
_EARLIER = ".earlier"  # in it: names of the files to be removed first
_BEGUN = re.compile(r"\.wakeline-[0-9a-f]{8}|\.\w.*-[0-9a-f]{8}\.(csv|gpx|json|png)")


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


@contextmanager
def replacing_together(folder: str | Path, earlier: Iterable[Path]) -> Iterator[Path]:
    """Yield a temporary folder in `folder`; on success its files replace the `earlier` ones.

    Files of two runs are never beside each other: those of the earlier run are removed before those
    of the new one are moved in. Of a process that is killed meanwhile, :func:`settle` moves in the
    rest. When the block raises, `folder` is unchanged.

    Parameters
    ----------
    folder : str or Path
        Must exist; for one process at a time.
    earlier : iterable of Path
        Files in `folder` that an earlier run may have left.

    Raises
    ------
    OSError
        When a file cannot be written or moved; it names the file in `folder`.
    """
    folder = Path(folder)
    earlier = [file.name for file in earlier]
    fresh = folder / f".wakeline-{secrets.token_hex(4)}"
    fresh.mkdir()
    try:
        yield fresh
        for file in fresh.iterdir():
            check_writable(folder / file.name)
        (fresh / _EARLIER).write_text(json.dumps(earlier), encoding="utf-8")
        _move_in(folder)
        fresh.rename(folder / _COMPLETE)
        _move_in(folder)
    except OSError as error:
        if error.filename is None or Path(error.filename).parent != fresh:
            raise
        file = folder / Path(error.filename).name
        raise OSError(error.errno, error.strerror, str(file)) from None
    finally:
        shutil.rmtree(fresh, ignore_errors=True)


def settle(folder: str | Path) -> None:
    """Clear up after a process that was killed while it wrote to `folder`.

    Files that were complete are moved in, incomplete ones are removed.
    """
    _move_in(Path(folder))
    for left in Path(folder).iterdir():
        if not _BEGUN.fullmatch(left.name):
            continue
        if left.is_dir():
            shutil.rmtree(left, ignore_errors=True)
        else:
            left.unlink(missing_ok=True)


def remove_begun(path: Path) -> None:
    """Remove temporary files that a killed process has left beside a file."""
    target = _led_to(path)
    for left in target.parent.glob(f".{glob.escape(target.stem)}-*"):
        if left.suffix == path.suffix and _BEGUN.fullmatch(left.name):
            left.unlink(missing_ok=True)


def _move_in(folder: Path) -> None:
    """Let complete files replace those of an earlier run; what is done is not done again."""
    complete = folder / _COMPLETE
    if not complete.is_dir():
        return
    files = [file for file in complete.iterdir() if file.name != _EARLIER]
    files.sort(key=lambda file: (file.stat().st_mtime_ns, file.name))
    if (complete / _EARLIER).exists():
        first = {files[0].name} if files else set()  # replaced at once, so that it is always there
        for name in json.loads((complete / _EARLIER).read_text(encoding="utf-8")):
            file = folder / name
            is_replaced = name in first or ((complete / name).exists() and not _is_plain(file))
            if not is_replaced and os.path.lexists(file) and not os.path.isdir(file):  # noqa: PTH112
                file.unlink()
        (complete / _EARLIER).unlink()
    for file in files:
        target = folder / file.name
        if _is_plain(target) or not os.path.lexists(target):
            file.replace(target)
        else:
            with replacing(target) as copy:
                shutil.copyfile(file, copy)
            file.unlink()
    complete.rmdir()


def _is_plain(path: Path) -> bool:
    return path.is_file() and not path.is_symlink()


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
