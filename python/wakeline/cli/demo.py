"""``wakeline demo``: a real recording that ships with the package, tracked and scored."""

from __future__ import annotations

import argparse
from pathlib import Path

from wakeline import metrics, recording
from wakeline.tracking import Settings

from . import outputs, report
from .track import draw_into, track_into

_ABOUT = {
    "joyride": """\
A fast boat that keeps turning, up to 17 degrees a second, seen every 2.5 s by a marine radar
on a moving boat. GNSS aboard tells where it really was.
""",
    "autoferry": """\
Two boats near a slow ferry in a harbour, in five scenarios, among quays and other boats.
GNSS aboard tells where they really were.
""",
}


def add_to(commands: argparse._SubParsersAction) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "demo",
        help="track and score a real recording that ships with the package",
        description="Tracks a real recording that ships with the package, scores the tracks "
        "against GNSS truth, and writes tracks and pictures.",
    )
    parser.add_argument(
        "--recording", choices=recording.names(), default="joyride", help="default %(default)s"
    )
    parser.add_argument(
        "--out", type=Path, metavar="DIR", default=Path("wakeline-demo"), help="default %(default)s"
    )
    parser.add_argument("--json", type=Path, metavar="F", help="write the score as JSON")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    name = arguments.recording
    print(_ABOUT[name])
    real = recording.load(name)
    settings = Settings.default().knowing(real.radar)
    tracks = track_into(arguments.out, real, settings, f"radar {name}")
    score = metrics.score(tracks, real)
    print(f"\nThe tracks against the truth:\n\n{report.explained(score.overall)}")
    if arguments.json is not None:
        outputs.write_json(arguments.json, "demo", report.score_rows(score, name))
    draw_into(arguments.out, tracks)
