"""A live session on the network: inputs, clock, operators, record and outputs."""

from __future__ import annotations

import contextlib
import errno
import math
import queue
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO

from wakeline.recording import RecordingError

from .config import CONNECTION
from .network import NetworkInput, NetworkOutput, close_all, now_s
from .problems import in_words
from .record import Record, Recorder, at_microsecond, lock, read_session, segments_of
from .session import CLOCK, Session

_TICK_S = 0.5
_FULL = (errno.ENOSPC, errno.EDQUOT)
_AGAIN_S = 20.0  # until a record that failed is tried again
_MOST_WAITING = 128 << 20  # octets that the session has not taken


class Service:
    """Runs a session: what its inputs receive is recorded and fed in one order.

    Parameters
    ----------
    session : Session
    record : str or Path, optional
        File to record to. If it exists, the session first continues from it: the records of its
        last segment are fed again, so that tracks keep their numbers.

    Attributes
    ----------
    session : Session
    inputs : list of NetworkInput
    outputs : list of NetworkOutput
    lost : int
        Batches of messages dropped because the session was too slow.
    """

    def __init__(self, session: Session, record: str | Path | None = None) -> None:
        self.session = session
        self.inputs = [NetworkInput(one, self.take) for one in session.config.inputs]
        self.outputs = [NetworkOutput(one) for one in session.config.outputs]
        self.lost = 0
        self._ends = threading.Event()
        self._waiting: queue.SimpleQueue[tuple[str, list[tuple[float, bytes]]]] = (
            queue.SimpleQueue()
        )
        self._waiting_octets = 0
        self._counting = threading.Lock()
        self._recorder: Recorder | None = None
        self._record = record
        self._lock: BinaryIO | None = None
        self._tick_s = self._again_s = -math.inf

    def take(self, name: str, messages: list[tuple[float, bytes]]) -> None:
        """Take messages of an input, from any thread."""
        octets = sum(len(one) for _, one in messages)
        with self._counting:
            if self._waiting_octets > _MOST_WAITING:
                self.lost += 1
                return
            self._waiting_octets += octets
        self._waiting.put((name, messages))

    def _journal(self, command: Mapping[str, Any]) -> float:
        """Record what an operator asks for; its time."""
        time_s = max(at_microsecond(now_s()), self.session.time_s)
        self._keep(time_s, partial(Recorder.command, time_s=time_s, command=dict(command)))
        return time_s

    def _keep(self, time_s: float, write: Callable[[Recorder], None]) -> None:
        """Record something. Where the file takes nothing more, tracking continues without it.

        From time to time a new segment is tried, which begins with the state.
        """
        if self._record is None:
            return
        try:
            if self.session.record_problem:
                if time.monotonic() < self._again_s:
                    return
                if self._recorder is None:
                    self._recorder = self._begun_recorder(time_s)
                self._recorder.rotate(time_s, after_gap=True)
                self.session.record_problem = ""
            if self._recorder is not None:
                write(self._recorder)
        except OSError as error:
            self._note_problem(error)

    def _begun_recorder(self, time_s: float) -> Recorder:
        """A recorder whose settings are written; a new file that does not take them is removed."""
        config, path = self.session.config, Path(self._record)
        is_new = not segments_of(path)
        limits, recorder = config.session, None
        try:
            recorder = Recorder(
                path,
                config.as_document(),
                round(limits.segment_mb * 1e6),
                round(limits.most_mb * 1e6),
                self.session.save,
            )
            recorder.begin(time_s)
        except OSError:
            if recorder is not None:
                recorder.close()
            if is_new:
                path.unlink(missing_ok=True)
            raise
        return recorder

    def _note_problem(self, error: OSError) -> None:
        self._again_s = time.monotonic() + _AGAIN_S
        self.session.record_problem = f"{self._record}: {in_words(error)}"

    def run(self, *, every_s: float = 0.0, report: Callable[[], None] | None = None) -> None:
        """Run until `stop`, or until all inputs have ended.

        Parameters
        ----------
        every_s : float
            Interval at which `report` is called.
        report : callable, optional

        Raises
        ------
        RecordingError
            When all inputs have ended, one of them because its file cannot be read.
        """
        try:
            self._begin()
            next_s = time.monotonic() + every_s
            while not self._ends.is_set():
                self._step()
                if report is not None and every_s > 0.0 and time.monotonic() >= next_s:
                    next_s = max(next_s + every_s, time.monotonic())
                    report()
                done = self.inputs and all(one.is_done for one in self.inputs)
                if done and self._waiting.empty():
                    break
            self._take_note()
            if report is not None:
                report()
        finally:
            self.close()
        failures = [one.failure for one in self.inputs if one.failure is not None]
        if failures and not self._ends.is_set():
            raise failures[0]

    def stop(self) -> None:
        """End `run` soon; may be called by a signal handler."""
        self._ends.set()

    def _begin(self) -> None:
        if self._record is not None:
            path = Path(self._record)
            if path.exists() and not path.is_file():
                raise FileExistsError(errno.EEXIST, "not a file that can be recorded to", str(path))
            self._lock = lock(path)
            if segments_of(path) and segments_of(path)[-1].stat().st_size > 0:
                board = self.session.watchers[0]
                log, board.log = board.log, None  # which has what is recorded
                for record in read_session(path, last_segment=True):
                    if self._ends.is_set():
                        return
                    self._continue(path, record)
                self.session.note, board.log = "", log
                for one in self.inputs:
                    one.discard()
            time_s = max(at_microsecond(now_s()), self.session.time_s)
            try:
                self._recorder = self._begun_recorder(time_s)
            except OSError as error:
                if error.errno not in _FULL:
                    raise
                self._note_problem(error)
        self.session.journal = self._journal
        for one in self.outputs:
            self.session.outputs[one.config.name].send = one.send
            one.start()
        for one in self.inputs:
            one.start()

    def _continue(self, path: Path, record: Record) -> None:
        """Feed what was recorded."""
        inputs = [one.name for one in self.session.config.inputs]
        try:
            if record.input and inputs and record.input.partition(CONNECTION)[0] not in inputs:
                raise ValueError(f"no input named {record.input}")
            with self.session.lock:
                feed_record(self.session, record)
            if math.isfinite(behind_s := now_s() - self.session.time_s):
                self.session.note = f"The record is read again: the picture is {behind_s:.0f} s old"
        except ValueError as error:
            raise RecordingError(
                path,
                "its tracks cannot be continued",
                wanted="the settings and inputs with which it was recorded, or another file",
                got=str(error),
            ) from None

    def _step(self) -> None:
        """Feed what has arrived, and let time pass twice a second."""
        with contextlib.suppress(queue.Empty):
            name, messages = self._waiting.get(timeout=0.1)
            self._feed(name, messages)
            for _ in range(100):
                name, messages = self._waiting.get_nowait()
                self._feed(name, messages)
        tick_s = now_s()
        if not 0.0 <= tick_s - self._tick_s < _TICK_S:
            self._tick_s = tick_s
            self._take_note()
            with self.session.lock:
                time_s = max(at_microsecond(tick_s), self.session.time_s)
                self._keep(time_s, partial(Recorder.clock, time_s=time_s))
                self.session.feed(time_s, CLOCK, b"")

    def _feed(self, name: str, messages: list[tuple[float, bytes]]) -> None:
        session, url = self.session, self.session.url_of(name)
        with self._counting:
            self._waiting_octets -= sum(len(one) for _, one in messages)
        with session.lock:
            for when_s, octets in messages:
                time_s = max(at_microsecond(when_s), session.time_s)
                data = {"time_s": time_s, "name": name, "url": url, "octets": octets}
                self._keep(time_s, partial(Recorder.data, **data))
                session.feed(time_s, name, octets)

    def _take_note(self) -> None:
        """Bring connections and losses into the status."""
        for one in self.inputs:
            source = self.session.inputs[one.config.name]
            source.connection, source.failing = one.connection, one.is_failing
        note_outputs(self.session, self.outputs)
        self.session.lost = self.lost

    def close(self) -> None:
        """End inputs, feed what they have received, and end outputs and record."""
        close_all(self.inputs)
        with contextlib.suppress(queue.Empty):
            while True:
                name, messages = self._waiting.get_nowait()
                self._feed(name, messages)
        self._take_note()
        close_all(self.outputs)
        if self._recorder is not None:
            self._recorder.close()
        if self._lock is not None:
            self._lock.close()


def note_outputs(session: Session, outputs: Iterable[NetworkOutput]) -> None:
    """Bring what was sent, and why nothing is, into the status of a session."""
    for one in outputs:
        output = session.outputs[one.config.name]
        output.connection, output.failing = one.connection, one.is_failing
        output.sent, output.dropped = one.sent, one.dropped


def feed_record(session: Session, record: Record) -> None:
    """Feed a record of a session file to a session."""
    if record.values is None:
        session.feed(record.time_s, record.input, record.octets)
    elif "command" in record.values:
        session.command(record.values["command"], record.time_s)
    elif "state" in record.values:
        if session.time_s == -math.inf or record.values.get("after_gap"):
            session.restore(record.values["state"])
        else:
            session.correct()  # as it was when the state was saved
    elif "clock" in record.values:
        session.feed(record.time_s, CLOCK, b"")


def replay(
    path: str | Path,
    speed: float = math.inf,
    ends: threading.Event | None = None,
) -> Iterator[Record]:
    """The records of a session file, as far apart in time as they were, divided by `speed`."""
    ends = ends or threading.Event()
    begin_s = start_s = None
    for record in read_session(path):
        if begin_s is None:
            begin_s, start_s = record.time_s, time.monotonic()
        due_s = start_s + (record.time_s - begin_s) / speed
        if ends.wait(max(due_s - time.monotonic(), 0.0)):
            return
        yield record
