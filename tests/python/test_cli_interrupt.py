"""Ctrl-C ends a command soon; what a killed one leaves; two commands on one folder."""

import os
import signal
import subprocess
import sys
import time

import pytest

from wakeline.cli import main

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")

# Commands whose main thread never sees the interrupt, or waits for threads.
PROGRAM = """
import sys, threading, time
from wakeline import cli
from wakeline._pool import thread_pool

def swallows(arguments):
    print("begun", flush=True)
    while True:
        try:
            time.sleep(60)
        except KeyboardInterrupt:
            pass

def waits(arguments):
    with thread_pool(2) as pool:
        tasks = [pool.submit(time.sleep, 60) for _ in range(10)]
        print("begun", flush=True)
        tasks[0].result()

def stops(arguments):
    print("begun", flush=True)
    time.sleep(60)

cli.track.run = globals()[sys.argv.pop(1)]
sys.exit(cli.main())
"""


@pytest.mark.parametrize("kind", ["swallows", "waits", "stops"])
def test_the_first_ctrl_c_ends_a_command(kind, tmp_path):
    command = subprocess.Popen(
        [sys.executable, "-c", PROGRAM, kind, "track", "--out", str(tmp_path)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert command.stdout.readline() == "begun\n"
    command.send_signal(signal.SIGINT)
    begun = time.monotonic()
    _, error = command.communicate(timeout=30)
    assert command.returncode == 130
    assert error == "wakeline: interrupted\n"
    assert time.monotonic() - begun < 10.0, "60 s without the watch"


LOG = "$GPRMC,120000,A,5430.0000,N,01030.0000,E,6.00,60.0,150826,,,A\n"


def test_the_next_command_removes_what_a_killed_one_left(tmp_path):
    log = tmp_path / "own.nmea"
    log.write_text(LOG)
    stale = [tmp_path / f".{name}-0123abcd.{kind}" for name, kind in (("own", "csv"), ("a", "png"))]
    kept = [
        tmp_path / name for name in (".notes-of-today.csv", "own-0123abcd.csv", ".a-0123abcd.txt")
    ]
    for file in (*stale, *kept):
        file.touch()
    assert main(["navigate", str(log), "--out", str(tmp_path)]) == 0
    assert not any(file.exists() for file in stale)
    assert all(file.exists() for file in kept)


def test_a_second_command_on_one_folder_is_rejected(tmp_path, capsys):
    fcntl = pytest.importorskip("fcntl")
    log, out = tmp_path / "own.nmea", tmp_path / "out"
    log.write_text(LOG)
    out.mkdir()
    other = os.open(out, os.O_RDONLY)
    fcntl.flock(other, fcntl.LOCK_EX)
    try:
        assert main(["navigate", str(log), "--out", str(out)]) == 2
    finally:
        os.close(other)
    assert "another wakeline command writes to" in capsys.readouterr().err
    assert list(out.iterdir()) == []
    for _ in range(2):
        assert main(["navigate", str(log), "--out", str(out)]) == 0
