"""``wakeline demo``: a bundled real recording, tracked and scored."""

from __future__ import annotations

import argparse

from wakeline import metrics, recording
from wakeline.tracking import Settings

from . import options, outputs, report, view
from .track import draw_into, track_into

_ABOUT = {
    "joyride": """\
A fast boat that turns at up to 17 degrees per second, observed every 2.5 s by the marine radar
of a moving boat. The truth is from GNSS aboard.
""",
    "autoferry": """\
Two boats near a slow ferry in a harbor, in five scenarios, among quays and other boats.
The truth is from GNSS aboard.
""",
}


def add_to(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command to its parser."""
    parser.description = (
        "Tracks a bundled real recording, scores the tracks against GNSS truth, and "
        "writes tracks and pictures."
    )
    parser.add_argument(
        "--recording", choices=recording.names(), default="joyride", help="default %(default)s"
    )
    options.add_results(parser, "write the score as JSON", "wakeline-demo")
    view.add_screen_options(parser, "show the recording in the browser instead, as it is tracked")
    parser.set_defaults(run=run)


def _show(episode: recording.Episode, settings: Settings, arguments: argparse.Namespace) -> None:
    from wakeline.live.playback import Playback, RecordedPlots

    plots = RecordedPlots(episode, settings)
    view.show(Playback(plots, own=episode.own, settings=settings, speed=arguments.speed), arguments)


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    name = arguments.recording
    print(_ABOUT[name])
    real = recording.load(name)
    settings = Settings.default().knowing(real.radar)
    if arguments.web is not None:
        _show(real.episodes[0], settings, arguments)
        return
    tracks = track_into(arguments.out, real, settings, f"radar {name}")
    score = metrics.score(tracks, real)
    print(f"\nThe tracks against the truth:\n\n{report.explained(score.overall)}")
    if arguments.json is not None:
        outputs.write_json(arguments.json, "demo", report.score_rows(score, name))
    draw_into(arguments.out, tracks)
