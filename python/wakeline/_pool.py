"""Threads that an interrupt does not wait for."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager


@contextmanager
def thread_pool(threads: int | None) -> Iterator[ThreadPoolExecutor]:
    """A pool of threads, by default one per processor.

    On KeyboardInterrupt, or when a generator is closed, tasks that have not begun are cancelled and
    those that run are left to themselves.
    """
    pool = ThreadPoolExecutor(threads or os.cpu_count() or 1)
    wait = True
    try:
        yield pool
    except (KeyboardInterrupt, GeneratorExit):
        wait = False
        raise
    finally:
        pool.shutdown(wait=wait, cancel_futures=not wait)
