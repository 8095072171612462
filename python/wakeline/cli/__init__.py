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
from importlib import import_module
from typing import Any, NoReturn, TextIO

from wakeline import FilterError, _starting
from wakeline._brief import with_short_quotes

from . import interrupt

_BAD_INPUT = 2
_NOBODY_READS = 141

# Each command is a module of its name, which is imported when the command is given.
_COMMANDS = {
    "demo": "track and score a bundled real recording",
    "track": "track a recording",
    "live": "track what radars on the network send",
    "view": "show a session or tracks in the browser",
    "calibrate": "find the offsets of a radar from AIS or GNSS reports, or another radar",
    "tune": "find the errors of a radar, process noise and detection from plots alone",
    "navigate": "own ship's solution from an NMEA 0183 log or an IMU log",
    "search": "drift of an object and a search plan, from a scenario in TOML",
    "score": "score tracks against truth",
    "export": "write tracks as GPX, KML, GeoJSON or CSV with latitude and longitude",
    "study": "reproduce a paper's scenarios, with its figures beside ours",
    "bench": "throughput on this machine",
}


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
        arguments = _parser().parse_args(argv)  # imports the command
        _starting.started()
        _execute(arguments)
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
    return 0


def _execute(arguments: argparse.Namespace) -> None:
    from . import outputs

    try:
        if arguments.json is not None:
            _check_json(arguments)
        with warnings.catch_warnings():
            if not sys.warnoptions:
                warnings.simplefilter("ignore", UserWarning)  # of libraries, about their code
            arguments.run(arguments)
    finally:
        outputs.release_folders()


def _check_json(arguments: argparse.Namespace) -> None:
    """Fail before the work if the JSON cannot or must not be written."""
    from wakeline.recording.files import check_writable, remove_begun

    from . import outputs

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


class _Commands(argparse._SubParsersAction):
    """The commands, of which the given one adds its options."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        if (name := values[0]) in self.choices:
            import_module(f".{name}", __name__).add_to(self.choices[name])
        super().__call__(parser, namespace, values, option_string)


class _Version(argparse.Action):
    """Prints the version, which takes time to find."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> NoReturn:
        from wakeline import __version__

        print(f"wakeline {__version__}")
        parser.exit()


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="wakeline", description="Tracks maneuvering vessels with radar, and scores the tracks."
    )
    parser.add_argument(
        "--version", action=_Version, nargs=0, help="show program's version number and exit"
    )
    commands = parser.add_subparsers(
        title="commands",
        required=True,
        metavar="COMMAND",
        action=_Commands,
        parser_class=_Parser,
    )
    for name, about in _COMMANDS.items():
        commands.add_parser(name, help=about)
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
