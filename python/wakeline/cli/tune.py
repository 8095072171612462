"""``wakeline tune``: settings by maximum likelihood, from plots alone."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

from wakeline._brief import many
from wakeline.recording.files import replacing_together
from wakeline.tracking import Tuning, read_settings, tune

from . import options, outputs, report

_SETTINGS = "settings.toml"
_ABOUT = """\
Tracks the plots of a recording, and finds the errors of the radar, the process
noise (noise_scale, a factor on the noise of all motion models) and the
detection probability with which they are most likely. Only tracks that move
count. A parameter that the plots do not determine stays near its given value.
NIS is the mean normalized innovation squared of the plots, 2 where settings are
right.

Writes settings.toml for wakeline track --config settings.toml.
"""


def add_to(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command to its parser."""
    parser.description = _ABOUT
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    options.add_recording(parser)
    options.add_own(parser)
    options.add_columns(parser)
    options.add_radar(parser)
    parser.add_argument("--config", type=Path, metavar="F.toml", help="settings to start from")
    options.add_results(parser, "the parameters as JSON")
    parser.set_defaults(run=run, inputs=inputs)


def inputs(arguments: argparse.Namespace) -> list[Path]:
    """The input files of the command line."""
    return options.files(arguments, "plots", "own", "config")


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    written = arguments.out / _SETTINGS
    outputs.check_no_input("--out", [written], inputs(arguments))
    settings = read_settings(arguments.config, arguments.radar)
    recording = options.opened(arguments, settings)
    options.columns_of(arguments).require_found()
    outputs.make_folder(arguments.out)
    tuned = tune(recording, config=settings)
    for note in recording.notes:
        print(f"note: {note}")
    print(f"{recording.name}: {many(tuned.plots, 'plot')} of {many(tuned.tracks, 'moving track')}")
    print(_table(tuned))
    low, high = tuned.nis_bounds
    print(f"NIS {tuned.nis_before:.2f}, tuned {tuned.nis_after:.2f} (2 +- {(high - low) / 2:.2f})")
    with replacing_together(arguments.out, {written}) as fresh:
        (fresh / _SETTINGS).write_text(tuned.settings.toml(), encoding="utf-8")
    print(f"written to {arguments.out}: {_SETTINGS}")
    if arguments.json is not None:
        outputs.write_json(
            arguments.json,
            "tune",
            _rows(tuned),
            tracks=tuned.tracks,
            plots=tuned.plots,
            nis_before=tuned.nis_before,
            nis_after=tuned.nis_after,
            nis_bounds=list(tuned.nis_bounds),
        )


def _table(tuned: Tuning) -> str:
    rows = [["parameter", "given", "found", "std", ""]]
    for one in tuned.parameters:
        std = f"{one.std:.2g}" if math.isfinite(one.std) else "-"
        verdict = "" if one.determined else f"not determined: {one.verdict}"
        rows.append([one.name, f"{one.before:.4g}", f"{one.value:.4g}", std, verdict])
    return report.aligned(rows, left=1, text=(4,))


def _rows(tuned: Tuning) -> list[dict[str, Any]]:
    return [
        {
            "parameter": one.name,
            "before": one.before,
            "value": one.value,
            "std": one.std if math.isfinite(one.std) else None,
            "determined": one.determined,
            "verdict": one.verdict,
        }
        for one in tuned.parameters
    ]
