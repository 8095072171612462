"""``wakeline live``: data from the network in, tracks out."""

from __future__ import annotations

import argparse
import contextlib
import math
import signal
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from wakeline._brief import many
from wakeline.live.config import (
    IN_FORMATS,
    OUT_FORMATS,
    InputConfig,
    LiveConfig,
    OutputConfig,
    RadarConfig,
    config_of,
    read_config,
)
from wakeline.live.demo import TTM_PORT, DemoSender, demo_config
from wakeline.live.network import NetworkOutput, close_all
from wakeline.live.playback import SPEEDS, SessionPlayback
from wakeline.live.record import read_session
from wakeline.live.service import Service, feed_record, note_outputs, replay
from wakeline.live.session import Session
from wakeline.tracking.settings import Settings, SettingsError, read_settings, read_toml

from . import view
from .options import above_zero, place, seconds_above_zero

_ABOUT = """\
Tracks the vessels that radars on the network see, and sends the tracks.

Inputs are udp://HOST:PORT (HOST 0.0.0.0 for all interfaces), a multicast group
udp://GROUP:PORT?iface=ADDRESS, tcp://HOST:PORT, tcp-listen://HOST:PORT,
serial:/dev/NAME?baud=38400, stdin:, file:PATH and pcap:PATH. Outputs are udp,
tcp, tcp-listen, serial, file:PATH and stdout:. What an input sends is recognized;
?format= of an input or output states it, ?radar= of an input names its radar,
?sac_sic=25/1 takes ASTERIX of one source, ?name= names it in the status.

Without --demo, --replay or inputs there is nothing to do. One status line is
printed a second; SIGTERM and Ctrl-C end the session cleanly.
"""
_FORMATS = f"""\
formats:
  in   {", ".join(filter(None, IN_FORMATS))}
  out  {", ".join(OUT_FORMATS)}
"""


def add_to(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command to its parser."""
    parser.description = _ABOUT
    parser.epilog = _FORMATS
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument(
        "config",
        nargs="?",
        type=Path,
        metavar="CONFIG.toml",
        help="settings, in the form of --print-config",
    )
    parser.add_argument(
        "--in", dest="inputs_", action="append", default=[], metavar="URL", help="an input"
    )
    parser.add_argument(
        "--out", dest="outputs_", action="append", default=[], metavar="URL", help="an output"
    )
    parser.add_argument(
        "--web", metavar="[HOST:]PORT", help="serve the screen, /status and /metrics"
    )
    parser.add_argument("--token", help="needed by browsers where --web is not the loopback")
    parser.add_argument(
        "--record",
        type=Path,
        metavar="FILE",
        help="record the session (pcap); a file that exists is continued, with the same numbers",
    )
    parser.add_argument("--alarms", type=Path, metavar="F.csv", help="append alarms to a table")
    parser.add_argument(
        "--replay",
        type=Path,
        metavar="SESSION",
        help="replay a recorded session; with --web, the screen has a bar that stops and sets it",
    )
    parser.add_argument(
        "--speed", type=_speed, default=1.0, metavar="X|max", help="of --replay, default 1"
    )
    parser.add_argument("--demo", action="store_true", help="track simulated and recorded radars")
    parser.add_argument(
        "--radar", metavar="NAME|F.toml", help="radar parameters, as for wakeline track"
    )
    parser.add_argument(
        "--own",
        type=place,
        metavar="LAT,LON",
        help="place of a station that does not move, in degrees; default: own ship's instruments",
    )
    parser.add_argument(
        "--for",
        dest="for_s",
        type=seconds_above_zero,
        metavar="S",
        help="end after so many seconds",
    )
    parser.add_argument("--quiet", action="store_true", help="print no status lines")
    parser.add_argument(
        "--print-config", action="store_true", help="print every setting with its explanation"
    )
    parser.set_defaults(run=run, json=None)


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    config = _config(arguments)
    if arguments.print_config:
        print(config.toml(), end="")
    elif arguments.replay is not None:
        _replay(arguments, config)
    elif arguments.demo:
        _demo(arguments, config)
    elif not config.inputs:
        raise ValueError("live needs an input: --in URL, --replay SESSION or --demo")
    else:
        _serve(arguments, Service(Session(config), _record(arguments, config)))


def _config(arguments: argparse.Namespace) -> LiveConfig:
    """The settings of the file, the session or the demonstration, changed by the options."""
    if arguments.demo:
        folder = Path("wakeline-live")
        config = demo_config(str(folder / "tracks.jsonl"))
    elif arguments.replay is not None:
        first = next(read_session(arguments.replay), None)
        if first is None or "settings" not in (first.values or {}):
            raise SettingsError(f"{arguments.replay}: the session has no settings")
        config = _of_session(arguments, first.values["settings"])
    else:
        config = read_config(arguments.config) if arguments.config else LiveConfig()
    inputs = tuple(InputConfig(url) for url in arguments.inputs_)
    outputs = tuple(OutputConfig(url) for url in arguments.outputs_)
    config = replace(config, inputs=(*config.inputs, *inputs), outputs=(*config.outputs, *outputs))
    if arguments.radar is not None:
        radar = read_settings(None, arguments.radar).radar
        changed = {k: v for k, v in radar.items() if v != Settings.default().radar[k]}
        radars = [
            replace(one, settings=dict(one.settings) | changed)
            for one in config.radars or (RadarConfig(),)
        ]
        config = replace(config, radars=tuple(radars))
    if arguments.own is not None:
        config = replace(config, own=replace(config.own, place_deg=arguments.own))
    return config


def _of_session(arguments: argparse.Namespace, recorded: dict[str, Any]) -> LiveConfig:
    """The settings of a session, changed by those in the file; inputs are those recorded."""
    if not arguments.config:
        return replace(config_of(recorded, arguments.replay), outputs=())
    document = read_toml(arguments.config)
    given, usual = config_of(document, arguments.config), LiveConfig()
    changed = recorded | {"output": document.pop("output", [])}
    document.pop("input", None)
    if given.radars == usual.radars:
        common = document.pop("radar", {})
        if isinstance(common, dict):
            changed["radar"] = [radar | common for radar in recorded["radar"]]
    for section, values in document.items():
        is_section = isinstance(values, dict)
        changed[section] = recorded.get(section, {}) | values if is_section else values
    return config_of(changed, arguments.config)


def _record(arguments: argparse.Namespace, config: LiveConfig) -> Path | None:
    if arguments.record is not None:
        return arguments.record
    return Path(config.session.record) if config.session.record else None


def _demo(arguments: argparse.Namespace, config: LiveConfig) -> None:
    folder = Path("wakeline-live")
    folder.mkdir(exist_ok=True)
    (folder / "tracks.jsonl").unlink(missing_ok=True)
    service = Service(Session(config), _record(arguments, config))
    ports = {one.config.name: one.port for one in service.inputs}
    sender = DemoSender(ports)
    print(f"TTM to UDP port {TTM_PORT} of the loopback, tracks to {folder / 'tracks.jsonl'}")
    try:
        sender.start()
        _serve(arguments, service, lambda: sender.is_done)
    finally:
        sender.close()


def _serve(arguments: argparse.Namespace, service: Service, is_done: Any = lambda: False) -> None:
    """Run a service until it ends, with signals, status lines and the screen."""

    def report() -> None:
        if not arguments.quiet:
            print(status_line(service.session.status()), flush=True)
        if is_done():
            service.stop()

    with contextlib.ExitStack() as stack:
        service.session.watchers[0].log = view.alarm_log(arguments, stack)
        stack.enter_context(_stopped(service.stop, arguments.for_s))
        stack.enter_context(_screen(arguments, service.session))
        service.run(every_s=service.session.config.session.status_s or 1.0, report=report)


def _replay(arguments: argparse.Namespace, config: LiveConfig) -> None:
    """Replay a session to its end, or on a screen with a bar until it is stopped."""
    ends = threading.Event()
    with contextlib.ExitStack() as stack:
        stack.enter_context(_stopped(ends.set, arguments.for_s))
        outputs = [NetworkOutput(one) for one in config.outputs]
        stack.callback(close_all, outputs)
        for one in outputs:
            one.start()
        log = view.alarm_log(arguments, stack)

        def attach(session: Session) -> None:
            for one in outputs:
                session.outputs[one.config.name].send = one.send
            session.watchers[0].log = log

        if arguments.web is None:
            _replay_all(arguments, config, attach, ends, outputs)
            return
        speed = min(arguments.speed, SPEEDS[-1])
        player = SessionPlayback(arguments.replay, speed=speed, config=config, attach=attach)
        stack.enter_context(_screen(arguments, player))
        stack.enter_context(contextlib.closing(player.start()))
        while not ends.wait(1.0):
            if not arguments.quiet:
                with player.lock:
                    print(status_line(player.status()), flush=True)


def _replay_all(
    arguments: argparse.Namespace,
    config: LiveConfig,
    attach: Any,
    ends: threading.Event,
    outputs: list[NetworkOutput],
) -> None:
    session = Session(config)
    attach(session)
    count, next_s = 0, time.monotonic()
    for record in replay(arguments.replay, arguments.speed, ends):
        feed_record(session, record)
        count += 1
        if not arguments.quiet and time.monotonic() >= next_s:
            next_s = time.monotonic() + 1.0
            note_outputs(session, outputs)
            print(status_line(session.status()), flush=True)
    print(f"{count} records replayed, {session.status()['tracks']} tracks at the end")


@contextlib.contextmanager
def _screen(arguments: argparse.Namespace, session: Session | SessionPlayback) -> Iterator[None]:
    """Serve the screen while the block runs, if it is asked for."""
    if arguments.web is None:
        yield
        return
    with view.serving(session, arguments.web, arguments.token) as url:
        print(f"screen at {url}", flush=True)
        yield


@contextlib.contextmanager
def _stopped(stop: Any, for_s: float | None) -> Iterator[None]:
    """Call `stop` on SIGTERM, Ctrl-C (in the main thread) or after a time, while the block runs."""
    previous = {}
    timer = threading.Timer(for_s, stop) if for_s is not None else None
    with contextlib.suppress(ValueError):  # of another thread
        for one in (signal.SIGTERM, signal.SIGINT):
            previous[one] = signal.signal(one, lambda *_: stop())
    try:
        if timer is not None:
            timer.start()
        yield
    finally:
        if timer is not None:
            timer.cancel()
        for one, handler in previous.items():
            signal.signal(one, handler)


def status_line(status: dict[str, Any]) -> str:
    """The status in one line."""
    clock = time.strftime("%H:%M:%S", time.gmtime(status["time_s"]))
    messages = sum(one["messages_per_s"] for one in status["inputs"].values())
    parts = [f"{clock} in {messages:.0f}/s"]
    for name in ("position", "heading"):
        own = status["own"][name]
        if own["source"]:
            age = f"{own['age_s']:.1f} s" if own["fresh"] else f"{own['age_s']:.0f} s old, not used"
            parts.append(f"{name} {own['source'].partition('@')[0]} {age}")
        elif own["rejected"]:
            parts.append(f"{name} {own['why']}")
    for name, radar in status["radars"].items():
        if radar["age_s"] is not None:
            parts.append(f"{name} {radar['plots']} plots, {radar['age_s']:.1f} s")
    parts.append(f"{status['tracks']} tracks, {status['ais_vessels']} AIS")
    sent = sum(one["sent"] for one in status["outputs"].values())
    dropped = sum(one["dropped"] for one in status["outputs"].values())
    if status["outputs"]:
        parts.append(f"{sent} sent" + (f", {dropped} dropped" if dropped else ""))
    lost = sum(one.get("lost_sweeps") or 0 for one in status["inputs"].values())
    wrong = sum(sum(one["problems"].values()) for one in status["inputs"].values())
    if lost or status["lost_batches"]:
        parts.append(f"{lost + status['lost_batches']} lost")
    if wrong:
        worst = max(status["inputs"].items(), key=lambda item: sum(item[1]["problems"].values()))
        parts.append(f"{wrong} problems, last of {worst[0]}: {worst[1]['last_problem']}")
    for name, one in (*status["inputs"].items(), *status["outputs"].items()):
        if one["failing"]:
            parts.append(f"{name}: {one['connection']}")
    for name, one in status["outputs"].items():
        if one["waiting"]:
            parts.append(f"{name}: no number left for {many(one['waiting'], 'track')}")
    parts += status["file_problems"]
    if status["frozen"]:
        parts.append(status["frozen"])
    return " | ".join(parts)


def _speed(text: str) -> float:
    return math.inf if text == "max" else above_zero(text, "max, or a number", math.inf)
