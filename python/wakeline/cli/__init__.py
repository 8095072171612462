"""The ``wakeline`` command.

Built on argparse of the standard library, so that it needs only numpy.
"""

from __future__ import annotations

import argparse
import io
import os
import sys
import warnings
from collections.abc import Sequence
from typing import NoReturn, TextIO

from wakeline import FilterError, __version__, _starting
from wakeline._brief import with_short_quotes
from wakeline.recording.files import check_writable, remove_begun

from . import (
    bench,
    calibrate,
    demo,
    export,
    interrupt,
    live,
    navigate,
    outputs,
    score,
    search,
    study,
    track,
    view,
)

_BAD_INPUT = 2
_NOBODY_READS = 141


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    argv : sequence of str, optional
        Arguments without the name of the program; default those of the process.

    Returns
    -------
    int
        Exit status: 0 on success, 2 after one line on stderr about invalid input or insufficient
        memory, 130 when interrupted, 141 when the reader of the output is gone. If a scenario fails
        or is interrupted, an earlier line names the files of the previous scenarios.
    """
    _degrade(sys.stdout)
    if argv is None:
        with interrupt.ended_by_interrupt():
            return _run(sys.argv[1:])
    return _run(argv)


def _run(argv: Sequence[str]) -> int:
    try:
        _starting.started()
        arguments = _parser().parse_args(argv)
        if arguments.json is not None:
            _check_json(arguments)
        with warnings.catch_warnings():
            if not sys.warnoptions:
                warnings.simplefilter("ignore", UserWarning)  # of libraries, about their code
            arguments.run(arguments)
        if sys.stdout is not None:
            sys.stdout.flush()
    except SystemExit as done:  # --help and --version
        return int(done.code or 0)
    except KeyboardInterrupt:
        interrupt.report()
        return interrupt.INTERRUPTED
    except BrokenPipeError:
        _close_output()
        return _NOBODY_READS
    except (ValueError, OSError, FilterError, MemoryError) as error:
        print(f"wakeline: {_one_line(error)}", file=sys.stderr)
        return _BAD_INPUT
    finally:
        outputs.release_folders()
    return 0


def _check_json(arguments: argparse.Namespace) -> None:
    """Fail before the work if the JSON cannot or must not be written."""
    if hasattr(arguments, "inputs"):
        outputs.check_no_input("--json", [arguments.json], arguments.inputs(arguments))
    if hasattr(arguments, "out"):
        outputs.check_no_result("--json", arguments.json, arguments.out)
    arguments.json.parent.mkdir(parents=True, exist_ok=True)
    check_writable(arguments.json)
    remove_begun(arguments.json)


def _degrade(output: TextIO) -> None:
    """Print a question mark for characters that the terminal's encoding lacks."""
    if isinstance(output, io.TextIOWrapper):
        output.reconfigure(errors="replace")


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one line like all others about invalid input."""

    def error(self, message: str) -> NoReturn:
        raise ValueError(f"{message} (see {self.prog} --help)")


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="wakeline", description="Tracks maneuvering vessels with radar, and scores the tracks."
    )
    parser.add_argument("--version", action="version", version=f"wakeline {__version__}")
    commands = parser.add_subparsers(
        title="commands", required=True, metavar="COMMAND", parser_class=_Parser
    )
    for command in (
        demo,
        track,
        live,
        view,
        calibrate,
        navigate,
        search,
        score,
        export,
        study,
        bench,
    ):
        command.add_to(commands)
    return parser


def _one_line(error: Exception) -> str:
    if isinstance(error, OSError) and error.strerror:
        place = f"{error.filename}: " if error.filename is not None else ""
        return f"{place}{error.strerror}"
    message = " ".join(with_short_quotes(str(error)).split())
    if isinstance(error, MemoryError):
        return message or "not enough memory"
    return message


def _close_output() -> None:
    """Redirect stdout to null, so that the interpreter does not report an error at exit."""
    try:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (OSError, ValueError):  # stdout has no file behind it
        pass
