"""Output files that are replaced only when they are complete."""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from contextlib import contextmanager
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
    """
    path = Path(path)
    fresh = path.with_name(f".{path.stem}-{secrets.token_hex(4)}{path.suffix}")
    try:
        yield fresh
        fresh.replace(path)
    finally:
        fresh.unlink(missing_ok=True)
