"""Ctrl-C ends a command soon; what a killed one leaves; two commands on one folder."""

import json
import os
import random
import signal
import subprocess
import sys
import time

import pytest

from wakeline.cli import main
from wakeline.recording import files, load, write_plots
from wakeline.tracking import VESSELS

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")

# Commands whose main thread never sees the interrupt, or waits for threads.
PROGRAM = """
import sys, threading, time
from wakeline import cli
from wakeline.cli import track
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

track.run = globals()[sys.argv.pop(1)]
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


@pytest.mark.parametrize("module", ["_starting", "_engine", "recording", "montecarlo.running"])
def test_ctrl_c_ends_a_command_that_is_still_imported(module):
    command = subprocess.Popen(
        [sys.executable, "-X", "importtime", "-m", "wakeline", "study", "list"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    for line in command.stderr:  # each module when it is imported
        if line.rpartition("|")[2].strip() == f"wakeline.{module}":
            break
    command.send_signal(signal.SIGINT)
    _, error = command.communicate(timeout=30)
    assert command.returncode == 130
    assert "Traceback" not in error
    assert error.endswith("wakeline: interrupted\n")


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


# Replaces the files of an earlier run, and is killed before the n-th time that it changes a folder.
REPLACES = """
import importlib.util, os, signal, sys
from pathlib import Path

spec = importlib.util.spec_from_file_location("files", sys.argv[1])
files = importlib.util.module_from_spec(spec)
spec.loader.exec_module(files)
folder, left = Path(sys.argv[2]), int(sys.argv[3])

def count(event, arguments):
    global left
    if event in ("os.mkdir", "os.rename", "os.remove", "os.rmdir"):
        left -= 1
        if left < 0:
            os.kill(os.getpid(), signal.SIGKILL)

sys.addaudithook(count)
earlier = [folder / name for name in ("tracks.csv", "events.csv", "map.png", "gone.png")]
with files.replacing_together(folder, earlier) as fresh:
    for name in ("tracks.csv", "events.csv", "alarms.csv"):
        (fresh / name).write_text("new")
"""


def test_files_of_two_runs_are_never_beside_each_other(tmp_path):
    old = dict.fromkeys(("tracks.csv", "events.csv", "map.png"), "old")
    new = dict.fromkeys(("tracks.csv", "events.csv", "alarms.csv"), "new")
    mine = {"notes.txt": "mine"}
    outcomes = []
    for step in range(100):
        folder = tmp_path / str(step)
        folder.mkdir()
        for name, text in (old | mine).items():
            (folder / name).write_text(text)
        program = [sys.executable, "-c", REPLACES, files.__file__, str(folder), str(step)]
        ended = subprocess.run(program, check=False).returncode
        assert len(set(_texts(folder).values()) - {"mine"}) == 1
        assert (folder / "tracks.csv").exists()
        files.settle(folder)
        assert [file for file in folder.iterdir() if file.name.startswith(".")] == []
        assert _texts(folder) in (old | mine, new | mine)
        outcomes.append((ended, _texts(folder) == new | mine))
        if ended == 0:
            break
        assert ended == -signal.SIGKILL
    assert outcomes[0] == (-signal.SIGKILL, False)
    assert outcomes[-2:] == [(-signal.SIGKILL, True), (0, True)]


def _texts(folder):
    files = (file for file in folder.iterdir() if not file.name.startswith("."))
    return {file.name: file.read_text() for file in files}


@pytest.mark.slow
def test_kill_9_leaves_the_tables_of_one_run(tmp_path):
    plots = tmp_path / "plots.csv"
    write_plots(plots, load("joyride"))
    command = [sys.executable, "-m", "wakeline", "track", str(plots), "--out"]
    folders = tmp_path / "out", tmp_path / "other"
    runs = []
    for folder, vessels in zip(folders, VESSELS, strict=True):
        begun = _begun([*command, str(folder), "--vessels", vessels])
        begun.communicate()
        assert begun.returncode == 0
        runs.append(_tables(folder))
    rng = random.Random(1)
    for _ in range(6):
        begun = _begun([*command, str(folders[0]), "--vessels", "ships"])
        begun.stdout.readline()  # before the tables
        time.sleep(rng.uniform(0.0, 0.5))
        begun.kill()
        begun.communicate()
        assert _tables(folders[0]) in runs
    begun = _begun([*command, str(folders[0]), "--vessels", "ships"])
    begun.communicate()
    assert _tables(folders[0]) == runs[1]
    assert [file for file in folders[0].iterdir() if file.name.startswith(".")] == []


def _begun(command):
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def _tables(folder):
    return {file.name: file.read_bytes() for file in folder.glob("*.csv")}


def test_what_a_killed_run_left_beside_its_json_is_removed(tmp_path):
    log, out = tmp_path / "own.nmea", tmp_path / "out"
    log.write_text(LOG)
    left, kept = tmp_path / ".errors-0123abcd.json", tmp_path / ".error-0123abcd.json"
    for file in (left, kept):
        file.touch()
    result = tmp_path / "errors.json"
    assert main(["navigate", str(log), "--out", str(out), "--json", str(result)]) == 0
    assert json.loads(result.read_text())["name"] == "navigate"
    assert kept.exists()
    assert not left.exists()
