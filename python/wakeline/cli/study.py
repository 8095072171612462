"""``wakeline study``: reproduce the scenarios of papers, with their figures beside ours."""

from __future__ import annotations

import argparse
from pathlib import Path

from wakeline import study
from wakeline._brief import many
from wakeline.recording.files import replacing_together

from . import outputs, report

_RUNS = 500
_SEED = 0


def add_to(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command to its parser."""
    parser.description = (
        "Runs the scenarios of papers again, and prints a table of the papers' figures beside ours."
    )
    actions = parser.add_subparsers(
        title="actions", required=True, metavar="ACTION", parser_class=type(parser)
    )
    listing = actions.add_parser("list", help="list the studies", description="Lists the studies.")
    listing.set_defaults(run=list_studies, json=None)
    one = actions.add_parser(
        "run",
        help="run a study",
        description="Runs a study, prints its table, and draws its figures. When it ends early "
        "the rows that were done are printed, and written with -partial in the name of the JSON.",
    )
    one.add_argument("name", choices=study.names(), metavar="NAME", help=", ".join(study.names()))
    one.add_argument(
        "--runs",
        type=_runs,
        default=_RUNS,
        metavar="N",
        help="Monte Carlo runs, default 500; solent divides them among its segments and rounds up; "
        "ais-forecast is not random and runs once",
    )
    one.add_argument("--seed", type=_seed, default=_SEED, metavar="S", help="default 0")
    one.add_argument("--json", type=Path, metavar="F", help="write the table as JSON")
    one.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        default=Path("wakeline-study"),
        help="folder of the figures, default %(default)s",
    )
    one.add_argument(
        "--full", action="store_true", help="also the sensitivity of the results; may take minutes"
    )
    one.set_defaults(run=run_study)


def list_studies(arguments: argparse.Namespace) -> None:
    """Print each name and its summary."""
    print(report.aligned([[name, study.load(name).summary] for name in study.names()], text=(1,)))


def run_study(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    outputs.make_folder(arguments.out)
    try:
        done = study.load(arguments.name).run(
            arguments.runs, arguments.seed, full=arguments.full, progress=True
        )
    except BaseException as error:
        found = getattr(error, "result", None)
        if found is not None and found.rows:
            _tell(found, arguments.json and _partial(arguments.json))
            print("\ninterrupted: the table has the completed rows", flush=True)
        raise
    _tell(done, arguments.json)
    if not outputs.can_draw():
        print(f"\n{outputs.HOW_TO_GET_PICTURES}")
        return
    drawn = [arguments.out / f"{picture.name}.png" for picture in done.pictures]
    with replacing_together(arguments.out, drawn) as fresh:
        files = done.save_pictures(fresh, progress=True)
    print(f"\nwritten to {arguments.out}: {', '.join(file.name for file in files)}")


def _tell(done: study.Report, json: Path | None) -> None:
    """Print the table and the notes, and write the JSON if requested."""
    drawn = "nothing random" if done.seed is None else f"seed {done.seed}"
    print(f"{done.name}: {many(done.runs, 'run')}, {drawn}\n")
    print(report.aligned(done.table(), left=2))
    for note in done.notes:
        print(f"\n{note}")
    if json is not None:
        outputs.write_json(json, done.name, done.rows, seed=done.seed, runs=done.runs)


def _partial(file: Path) -> Path:
    return file.with_name(f"{file.stem}{outputs.PARTIAL}{file.suffix}")


def _runs(text: str) -> int:
    return _whole(text, 1)


def _seed(text: str) -> int:
    return _whole(text, 0)


def _whole(text: str, least: int) -> int:
    try:
        value = int(text)
    except ValueError:
        value = least - 1
    if value < least:
        raise argparse.ArgumentTypeError(f"wanted an integer, at least {least}, got {text!r}")
    return value
