"""Ctrl-C while the command is imported."""

from __future__ import annotations

import os
import signal
import sys
from typing import Any


def started() -> None:
    """Let Ctrl-C raise KeyboardInterrupt from here on."""
    if signal.getsignal(signal.SIGINT) is _end:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _is_command() -> bool:
    """Whether Python runs ``wakeline``, ``-m wakeline`` or ``-m wakeline.cli``."""
    words = sys.orig_argv
    if sys.argv[:1] == ["-m"] and "-m" in words[:-1]:
        return words[words.index("-m") + 1] in ("wakeline", "wakeline.cli")
    return os.path.basename(sys.argv[0] if sys.argv else "") in ("wakeline", "wakeline.exe")  # noqa: PTH119


def _end(number: int, frame: Any) -> None:
    os.write(2, b"wakeline: interrupted\n")
    os._exit(130)


# An exception would end the command with a traceback, or be lost in the import of a library.
if signal.getsignal(signal.SIGINT) is signal.default_int_handler and _is_command():
    signal.signal(signal.SIGINT, _end)
