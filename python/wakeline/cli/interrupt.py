"""The end of a command soon after Ctrl-C, whatever its threads do."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

INTERRUPTED = 130

_GRACE_S = 1.5  # to write partial results
_reported = threading.Event()


def report() -> None:
    """Print that the command was interrupted."""
    _reported.set()
    print("wakeline: interrupted", file=sys.stderr, flush=True)


@contextmanager
def ended_by_interrupt() -> Iterator[None]:
    """End the process 1.5 s after Ctrl-C, with status 130, if it is still there.

    Python raises KeyboardInterrupt in the main thread only after a long call has returned, a
    library may swallow it, and at exit Python waits for threads. Nothing is done in other threads
    than the main one, and on other systems than POSIX.
    """
    if os.name != "posix" or threading.current_thread() is not threading.main_thread():
        yield
        return
    _reported.clear()
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    previous = signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
    threading.Thread(target=_watch, args=(reader,), daemon=True).start()
    try:
        yield
    finally:
        signal.set_wakeup_fd(previous)
        os.close(writer)


def _watch(reader: int) -> None:
    """End the process some time after the first SIGINT; return when the pipe is closed."""
    while (octets := os.read(reader, 16)) and signal.SIGINT not in octets:
        pass
    os.close(reader)
    if octets:
        time.sleep(_GRACE_S)
        try:
            if not _reported.is_set():
                report()
            sys.stdout.flush()
        finally:
            os._exit(INTERRUPTED)
