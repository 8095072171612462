"""``wakeline view``: a recorded session or a table of tracks on the screen."""

from __future__ import annotations

import argparse
import contextlib
import threading
import time
import webbrowser
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from wakeline.recording import RecordingError, read_own_ship, read_tracks
from wakeline.tracking import read_settings

from .options import seconds_above_zero

if TYPE_CHECKING:
    from wakeline.live.alarms import AlarmLog
    from wakeline.live.playback import Player

_ABOUT = """\
Shows a session that `wakeline live --record` has written, or tracks as CSV, in
the browser: the picture as it was, with a bar to stop it and to set its time.
Tracks of a session come out of its recorded data again, bit for bit.
"""


def add_to(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command to its parser."""
    parser.description = _ABOUT
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("file", type=Path, metavar="SESSION|TRACKS.csv")
    parser.add_argument("--own", type=Path, metavar="F.csv", help="own ship, for tracks")
    parser.add_argument(
        "--config", type=Path, metavar="F.toml", help="limits of danger, for tracks"
    )
    parser.add_argument("--alarms", type=Path, metavar="F.csv", help="write the alarms of tracks")
    add_screen_options(parser, "where to serve it, default 127.0.0.1:8080", default="8080")
    parser.set_defaults(run=run, json=None)


def add_screen_options(
    parser: argparse.ArgumentParser, about: str, default: str | None = None
) -> None:
    """Where the screen is served, and how fast the recording plays."""
    parser.add_argument(
        "--web", metavar="[HOST:]PORT", default=default, nargs="?", const="8080", help=about
    )
    parser.add_argument("--token", help="needed by browsers where --web is not the loopback")
    parser.add_argument("--speed", type=float, default=1.0, metavar="X", help="default 1")
    parser.add_argument("--no-browser", action="store_true", help="open no browser")
    parser.add_argument(
        "--for",
        dest="for_s",
        type=seconds_above_zero,
        metavar="S",
        help="end after so many seconds",
    )


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    from wakeline.live.playback import Playback, RecordedTracks, SessionPlayback

    if arguments.file.suffix.lower() not in (".csv", ".gz"):
        show(SessionPlayback(arguments.file, speed=arguments.speed), arguments)
        return
    tracks = read_tracks(arguments.file)
    if len(tracks) == 0:
        raise RecordingError(arguments.file, "there are no tracks", wanted="a row for each scan")
    own = read_own_ship(arguments.own) if arguments.own is not None else None
    source, settings = RecordedTracks(tracks), read_settings(arguments.config)
    with contextlib.ExitStack() as stack:
        log = alarm_log(arguments, stack)
        player = Playback(source, own=own, settings=settings, log=log, speed=arguments.speed)
        show(player, arguments)


def alarm_log(arguments: argparse.Namespace, stack: contextlib.ExitStack) -> AlarmLog | None:
    """The table of alarms, if it is asked for; the stack closes it."""
    if arguments.alarms is None:
        return None
    from wakeline.live.alarms import AlarmLog

    return stack.enter_context(contextlib.closing(AlarmLog(arguments.alarms)))


def show(player: Player, arguments: argparse.Namespace) -> None:
    """Serve a player until the command is interrupted."""
    with serving(player, arguments.web, arguments.token) as url:
        print(f"screen at {url} (Ctrl-C ends it)", flush=True)
        player.start()
        try:
            if not arguments.no_browser:
                threading.Thread(target=webbrowser.open, args=(url,), daemon=True).start()
            if arguments.for_s is not None:
                time.sleep(arguments.for_s)
            else:
                threading.Event().wait()
        finally:
            player.close()


@contextlib.contextmanager
def serving(session: object, web: str, token: str | None) -> Iterator[str]:
    """Serve a session at ``[HOST:]PORT`` while the block runs, and give the address of its page."""
    try:
        from wakeline.live.web import serve
    except ImportError as error:
        raise ValueError(str(error)) from None

    host, _, port = web.rpartition(":")
    if not port.isdecimal() or int(port) > 65535:
        raise ValueError(f"--web must be [HOST:]PORT, got {web!r}")
    server = serve(session, host.strip("[]") or "127.0.0.1", int(port), token=token)
    try:
        yield server.url
    finally:
        server.close()
