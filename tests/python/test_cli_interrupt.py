"""Ctrl-C ends a command soon, with status 130."""

import os
import signal
import subprocess
import sys
import time

import pytest

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
