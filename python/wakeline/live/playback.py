"""A recording or a table of tracks as a session that a screen can play, stop and set back."""

from __future__ import annotations

import abc
import math
import pickle
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Protocol

import numpy as np

import wakeline as wl
from wakeline._brief import quoted
from wakeline.recording import Episode, OwnShipMotion, Scan, Tracks
from wakeline.tracking import MODE_NAMES, Settings, median_step_s

from .alarms import AlarmConfig, AlarmLog
from .config import LiveConfig, config_of
from .record import read_session
from .service import feed_record
from .session import Session
from .watch import AlarmBoard
from .zones import Zone, Zones, are_of_tracks

SPEEDS = (0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
_TICK_S = 0.1
_MOST_STEP_S = 1.0  # that are played at once, so that a slow machine still answers
_SNAPSHOT_S, _MOST_SNAPSHOTS = 30.0, 100
_HISTORY = 60
_HISTORY_S = 5.0
_SHOWN = ("confirmed", "coasting", "held")


class Source(Protocol):
    """What a playback plays.

    Attributes
    ----------
    start_s, end_s : float
    kept : callable
        Which plots are used where there are zones: :meth:`Zones.kept`.
    """

    start_s: float
    end_s: float
    kept: Callable[[np.ndarray, Callable[[np.ndarray], np.ndarray]], np.ndarray]

    def steps(self, after_s: float, until_s: float) -> list[float]:
        """Times in (after_s, until_s] at which something is new."""

    def advance(self, time_s: float) -> list[Any]:
        """Continue to the next of these times; events of the tracker."""

    def tracks(self) -> Any:
        """Columns of a ``TrackTable`` at that time."""

    def plots_m(self) -> np.ndarray:
        """(n, 2) plots of the last scan."""

    def command(self, time_s: float, command: Mapping[str, Any]) -> dict[str, Any]:
        """What an operator asks of the tracker."""

    def save(self) -> Any:
        """The state, for `restore`."""

    def restore(self, state: Any) -> None:
        """Go back to a state."""


class Player(abc.ABC):
    """A time that plays, stops and can be set, on a thread.

    Attributes
    ----------
    start_s, end_s, time_s : float
        Of the recording, and now.
    speed : float
        Seconds of the recording in a second.
    paused : bool
    sweeps : list of callable
        As of a :class:`wakeline.live.Session`.
    lock : threading.RLock
        Held whenever the player changes.
    """

    def __init__(self, start_s: float, end_s: float, speed: float) -> None:
        self.start_s, self.end_s, self.time_s = start_s, end_s, start_s
        self.speed, self.paused = _speed(speed), False
        self.sweeps: list[Callable[..., None]] = []
        self.lock = threading.RLock()
        self._played_s = time.monotonic()
        self._thread: threading.Thread | None = None
        self._stopped = threading.Event()

    def start(self):
        """Play on a thread until :meth:`close`; returns the player."""
        self._thread = threading.Thread(target=self._play, name="wakeline-playback", daemon=True)
        self._thread.start()
        return self

    def close(self) -> None:
        """Stop the thread."""
        self._stopped.set()
        if self._thread is not None:
            self._thread.join()

    def _play(self) -> None:
        self._played_s = time.monotonic()
        while not self._stopped.wait(_TICK_S):
            with self.lock:
                now_s = time.monotonic()
                passed_s = min(now_s - self._played_s, _MOST_STEP_S)
                self._played_s = now_s
                if not self.paused:
                    self.go_to(self.time_s + passed_s * self.speed)

    def go_to(self, time_s: float) -> None:
        """Set the time, forward or back, within the recording."""
        with self.lock:
            time_s = min(max(time_s, self.start_s), self.end_s)
            if time_s < self.time_s:
                self._go_back(time_s)
            self._advance(time_s)
            self.time_s = time_s

    @abc.abstractmethod
    def _go_back(self, time_s: float) -> None:
        """Be at some time not after `time_s`."""

    @abc.abstractmethod
    def _advance(self, time_s: float) -> None:
        """Take all that is new until a time."""

    def command(self, command: Mapping[str, Any]) -> dict[str, Any]:
        """What an operator asks for, as :meth:`wakeline.live.Session.command`.

        Also ``{"command": "replay", "time_s": ..., "speed": ..., "paused": ...}``, each optional.
        """
        with self.lock:
            try:
                if command.get("command") == "replay":
                    return self._replay(command)
                return self._obey(command)
            except KeyError as error:
                return {"ok": False, "error": f"wanted {error.args[0]}"}
            except (ValueError, TypeError, OverflowError, wl.FilterError) as error:
                return {"ok": False, "error": str(error)[:200]}

    @abc.abstractmethod
    def _obey(self, command: Mapping[str, Any]) -> dict[str, Any]:
        """Do what an operator asks for, but for the time that plays."""

    def _replay(self, command: Mapping[str, Any]) -> dict[str, Any]:
        if "speed" in command:
            self.speed = _speed(command["speed"])
        if "paused" in command:
            self.paused = bool(command["paused"])
        if "time_s" in command:
            wanted_s = float(command["time_s"])
            if not math.isfinite(wanted_s):
                raise ValueError("time_s must be finite")
            self.go_to(wanted_s)
            self._played_s = time.monotonic()  # what this took is not played
        return {"ok": True}

    def replay_picture(self) -> dict[str, Any]:
        """What the picture says of the replay."""
        names = ("start_s", "end_s", "time_s", "speed", "paused")
        return {name: getattr(self, name) for name in names}


class SessionPlayback(Player):
    """Plays a session file (``wakeline live --record``) through a session.

    Setting the time back feeds a new session from the beginning, so that the tracks are the same as
    at first; what the viewer did is gone, but for zones.

    Parameters
    ----------
    path : str or Path
    speed : float
    config : LiveConfig, optional
        Settings; default those of the file, without outputs.
    attach : callable, optional
        Called with the session that plays, to connect its outputs. After the time was set back that
        is another one, which has played until then without them.

    Raises
    ------
    RecordingError
        When the file is no session.
    """

    def __init__(
        self,
        path: str | Path,
        *,
        speed: float = 1.0,
        config: LiveConfig | None = None,
        attach: Callable[[Session], None] | None = None,
    ) -> None:
        self._path, self._attach = path, attach or (lambda _: None)
        first = next(read_session(path))
        self._config = config or replace(config_of(first.values["settings"], path), outputs=())
        start_s = end_s = first.time_s
        for record in read_session(path):
            end_s = max(end_s, record.time_s)
        super().__init__(start_s, end_s, speed)
        self._begin()
        self._attach(self._session)
        self._advance(start_s)

    def _begin(self) -> None:
        self._session = Session(self._config)
        self._session.sweeps.append(self._show)
        self._records = read_session(self._path)
        self._next = next(self._records, None)

    def _show(self, *sweeps: Any) -> None:
        for one in self.sweeps:
            one(*sweeps)

    def _advance(self, time_s: float) -> None:
        while self._next is not None and self._next.time_s <= time_s:
            feed_record(self._session, self._next)
            self._next = next(self._records, None)

    def _go_back(self, time_s: float) -> None:
        zones = self._session.watchers[0].alarms.zones
        self._begin()
        self._advance(time_s)
        self._attach(self._session)
        self._session.watchers[0].alarms.zones.adopt(zones)

    def picture(self) -> dict[str, Any]:
        """That of the session, with the state of the replay."""
        with self.lock:
            return self._session.picture() | {
                "time_s": self.time_s,
                "live": False,
                "replay": self.replay_picture(),
            }

    def status(self) -> dict[str, Any]:
        """Of the session."""
        return self._session.status()

    def _obey(self, command: Mapping[str, Any]) -> dict[str, Any]:
        return self._session.command(command)


class Playback(Player):
    """Plays a source as a live session: pictures, alarms and commands, and a time that obeys.

    Setting the time back restores a snapshot from before and continues from there, so that the
    tracks are the same as at first; what the operator did after the new time is gone.

    Parameters
    ----------
    source : Source
    own : OwnShipMotion, optional
        Own ship.
    settings : Settings, optional
        With the limits of danger.
    zones : Zones or sequence of Zone, optional
    config : AlarmConfig, optional
    log : AlarmLog, optional
        Receives the changes of alarms, once for each time of the recording.
    origin_deg : (float, float), optional
        Latitude and longitude of north 0, east 0.
    speed : float
        Seconds of the recording in a second.
    """

    def __init__(
        self,
        source: Source,
        *,
        own: OwnShipMotion | None = None,
        settings: Settings | None = None,
        zones: Zones | Sequence[Zone] = (),
        config: AlarmConfig | None = None,
        log: AlarmLog | None = None,
        origin_deg: tuple[float, float] | None = None,
        speed: float = 1.0,
    ) -> None:
        super().__init__(source.start_s, source.end_s, speed)
        self._source, self._own, self._log = source, own, log
        self._logged_s = -math.inf
        settings = settings or Settings.default()
        self._board = AlarmBoard(settings.danger_limits, zones, config)
        self._plane = None
        if origin_deg is not None:
            latitude_rad, longitude_rad = np.deg2rad(origin_deg)
            self._plane = wl.LocalPlane(latitude_rad=latitude_rad, longitude_rad=longitude_rad)
        self._history: dict[int, deque[tuple[float, float, float]]] = {}
        self._snapshots: list[tuple[float, bytes]] = []
        self._spacing_s = _SNAPSHOT_S
        self._step_s = -math.inf
        source.kept = lambda *plots: self._board.alarms.zones.kept(*plots)
        self._keep()
        self._advance(source.start_s)

    # Time -----------------------------------------------------------------------------------------

    def _advance(self, time_s: float) -> None:
        for step_s in self._source.steps(self._step_s, time_s):
            if step_s >= self._snapshots[-1][0] + self._spacing_s:
                self._keep()
            events = self._source.advance(step_s)
            self._step_s = step_s
            self._watch(step_s, events)
            self._remember(step_s)
        self.time_s = max(time_s, self.time_s)

    def _watch(self, time_s: float, events: list[Any]) -> None:
        own, heading_rad = self._own_state(time_s)
        changes = self._board.take(
            time_s, self._source.tracks(), own=own, heading_rad=heading_rad, events=events
        )
        if self._log is not None and time_s > self._logged_s:
            self._log.write(changes)
            self._logged_s = time_s

    def _keep(self) -> None:
        state = (self._step_s, self._source.save(), self._board, self._history)
        self._snapshots.append((self._step_s, pickle.dumps(state)))
        if len(self._snapshots) > _MOST_SNAPSHOTS:
            del self._snapshots[1::2]
            self._spacing_s *= 2.0

    def _go_back(self, time_s: float) -> None:
        zones = self._board.alarms.zones
        while len(self._snapshots) > 1 and self._snapshots[-1][0] > time_s:
            self._snapshots.pop()
        state = pickle.loads(self._snapshots[-1][1])
        self._step_s, source, self._board, self._history = state
        self._source.restore(source)
        self._board.alarms.zones.adopt(zones)
        self.time_s = max(self._step_s, self._source.start_s)

    # Picture --------------------------------------------------------------------------------------

    def picture(self) -> dict[str, Any]:
        """All that a screen shows, as :meth:`wakeline.live.Session.picture`."""
        with self.lock:
            own, heading_rad = self._own_state(self.time_s)
            return {
                "time_s": self.time_s,
                "live": False,
                "origin_deg": self._origin_deg(),
                "own": self._own_picture(own, heading_rad),
                "radars": [{"name": "radar", "azimuth": "north", "aboard": self._own is not None}],
                "tracks": self._tracks(own),
                "ais": [],
                "plots": self._source.plots_m().tolist(),
                "status": self.status(),
                "replay": self.replay_picture(),
            } | self._board.shown()

    def status(self) -> dict[str, Any]:
        """Of the recording."""
        recording = {"time_s": self.time_s, "speed": self.speed, "paused": self.paused}
        problem = "" if self._log is None else self._log.problem
        return {"recording": recording, "file_problems": [problem] if problem else []}

    def _origin_deg(self) -> list[float] | None:
        if self._plane is None:
            return None
        return [math.degrees(self._plane.latitude_rad), math.degrees(self._plane.longitude_rad)]

    def _own_state(self, time_s: float) -> tuple[list[float] | None, float]:
        own = self._own
        if own is None:
            return None, math.nan
        at = np.array([time_s])
        north_m, east_m = own.position_at(at)[0]
        vnorth_mps, veast_mps = own.velocity_at(at)[0] if own.knows_velocity else (0.0, 0.0)
        heading_rad = math.nan
        if own.heading_rad is not None:
            known = np.isfinite(own.heading_rad)
            if known.any():
                unwrapped = np.unwrap(own.heading_rad[known])
                heading_rad = float(np.interp(time_s, own.time_s[known], unwrapped))
        return [float(v) for v in (north_m, vnorth_mps, east_m, veast_mps)], heading_rad

    def _own_picture(self, own: list[float] | None, heading_rad: float) -> dict[str, Any] | None:
        if own is None:
            return None
        shown = dict(zip(("north_m", "vnorth_mps", "east_m", "veast_mps"), own, strict=True))
        shown["heading_rad"] = None if math.isnan(heading_rad) else heading_rad % (2.0 * math.pi)
        return shown | self._degrees(own[0], own[2])

    def _degrees(self, north_m: float, east_m: float) -> dict[str, float]:
        if self._plane is None:
            return {}
        latitude_rad, longitude_rad = self._plane.place([north_m, east_m])
        return {
            "latitude_deg": math.degrees(float(latitude_rad)),
            "longitude_deg": math.degrees(float(longitude_rad)),
        }

    def _tracks(self, own: list[float] | None) -> list[dict[str, Any]]:
        table = self._source.tracks()
        limits = self._board.alarms.limits
        approach = None
        if own is not None and len(table.track_id):
            error_m2s2 = limits.own_velocity_std_mps**2
            approach = wl.navigation.closest_approach(
                np.array(own),
                np.asarray(table.mean),
                np.diag([0.0, error_m2s2, 0.0, error_m2s2]),
                np.asarray(table.covariance),
            )
            probability = approach.probability(limits.cpa_limit_m, limits.tcpa_limit_s)
        words = mode_words(table)
        shown = []
        for k, track_id in enumerate(np.asarray(table.track_id).tolist()):
            if table.status[k] not in _SHOWN:
                continue
            north_m, vnorth_mps, east_m, veast_mps = np.asarray(table.mean[k]).tolist()
            shown.append(
                {
                    "track_id": track_id,
                    "status": str(table.status[k]),
                    "name": str(table.name[k]),
                    "time_s": self._step_s,
                    "north_m": north_m,
                    "east_m": east_m,
                    "vnorth_mps": vnorth_mps,
                    "veast_mps": veast_mps,
                    "covariance": table.covariance[k],
                    "mode": words[k],
                    "existence": float(table.existence[k]),
                    "history": list(self._history.get(track_id, ())),
                    "cpa": None
                    if approach is None
                    else {
                        "cpa_m": float(approach.cpa_m[k]),
                        "tcpa_s": float(approach.tcpa_s[k]),
                        "probability": float(probability[k]),
                    },
                }
                | self._degrees(north_m, east_m)
            )
        return shown

    def _remember(self, time_s: float) -> None:
        table = self._source.tracks()
        there = np.asarray(table.track_id).tolist()
        for track_id, mean in zip(there, np.asarray(table.mean).tolist(), strict=True):
            past = self._history.setdefault(track_id, deque(maxlen=_HISTORY))
            if not past or time_s - past[-1][0] >= _HISTORY_S:
                past.append((time_s, mean[0], mean[2]))
        for gone in self._history.keys() - set(there):
            del self._history[gone]

    # The operator ---------------------------------------------------------------------------------

    def _obey(self, command: Mapping[str, Any]) -> dict[str, Any]:
        name = command.get("command")
        if name in ("acquire", "drop", "rename"):
            answer = self._source.command(max(self._step_s, self._source.start_s), command)
            if name == "drop" and answer["ok"]:
                self._board.alarms.forget(int(command["track_id"]))
            return answer
        answer = self._board.obey(command)
        return answer or {"ok": False, "error": f"unknown command {quoted(name)}"}


class RecordedPlots:
    """Plots of an episode through the tracker, scan by scan: a :class:`Source`."""

    def __init__(self, episode: Episode, settings: Settings) -> None:
        self._scans = episode.scans
        self._end_s = [
            max(scan.time_s, scan.plot_time_s.max(initial=-np.inf)) for scan in episode.scans
        ]
        self._tracker = settings.make_tracker(median_step_s(episode))
        self._next = 0
        self.start_s, self.end_s = float(self._end_s[0]), float(max(self._end_s))

    def steps(self, after_s: float, until_s: float) -> list[float]:
        """Ends of scans."""
        return [float(t) for t in self._end_s[self._next :] if after_s < t <= until_s]

    def advance(self, time_s: float) -> list[Any]:
        """Process the scans up to a time."""
        events: list[Any] = []
        while self._next < len(self._scans) and self._end_s[self._next] <= time_s:
            scan, end_s = self._scans[self._next], self._end_s[self._next]
            while end_s > self._tracker.latest_time_s:
                silent = self._tracker.process(
                    self._tracker.latest_time_s, range_m=[], bearing_rad=[]
                )
                events += silent.events
            kept = self.kept(scan.position_m, partial(self._are_tracked, scan))
            events += self._tracker.process(
                end_s,
                range_m=scan.range_m[kept],
                bearing_rad=scan.bearing_rad[kept],
                plot_time_s=scan.plot_time_s[kept],
                own_north_m=scan.own_north_m[kept],
                own_east_m=scan.own_east_m[kept],
            ).events
            self._next += 1
        return events

    def _are_tracked(self, scan: Scan, which: np.ndarray) -> np.ndarray:
        radar, table = self._tracker.radar, self._tracker.tracks(time_s=self._end_s[self._next])
        plots = radar, scan.range_m[which], scan.position_m[which]
        return are_of_tracks(*plots, table.mean, table.covariance)

    def tracks(self) -> Any:
        """At the last scan, those that are being acquired too."""
        return self._tracker.tracks(tentative=True)

    def plots_m(self) -> np.ndarray:
        """Of the last scan."""
        return self._scans[self._next - 1].position_m if self._next else np.zeros((0, 2))

    def command(self, time_s: float, command: Mapping[str, Any]) -> dict[str, Any]:
        """Acquire, drop, rename."""
        if command["command"] == "acquire":
            place = float(command["north_m"]), float(command["east_m"])
            std_m = float(command.get("position_std_m", 30.0))
            track_id = self._tracker.designate(time_s, *place, std_m)
            return {"ok": True, "track_id": track_id}
        track_id = int(command["track_id"])
        if command["command"] == "drop":
            found = self._tracker.drop(track_id)
        else:
            found = self._tracker.rename(track_id, str(command["name"]))
        return {"ok": True} if found else {"ok": False, "error": "no track has that number"}

    def save(self) -> Any:
        """Of the tracker, and the next scan."""
        return self._tracker.save(), self._next

    def restore(self, state: Any) -> None:
        """The same."""
        self._tracker.restore(state[0])
        self._next = state[1]


class RecordedTracks:
    """Rows of a table of tracks as they were: a :class:`Source`."""

    def __init__(self, tracks: Tracks) -> None:
        if len(tracks) == 0:
            raise ValueError("the table has no tracks")
        order = np.argsort(tracks.time_s, kind="stable")
        self._time_s, self._mean = tracks.time_s[order], tracks.state[order]
        n = len(order)
        self._covariance = np.full((n, 4, 4), np.nan)
        if tracks.covariance is not None:
            self._covariance = tracks.covariance[order]
        self._modes = None if tracks.mode_probability is None else tracks.mode_probability[order]
        status = np.full(n, "confirmed") if tracks.status is None else tracks.status[order]
        self._status = np.where(np.isin(status, _SHOWN), status, "confirmed")
        names = np.asarray(tracks.track_id, dtype=str)[order]
        number = {name: k for k, name in enumerate(dict.fromkeys(names.tolist()), 1)}
        if all(name.isdecimal() and 0 < int(name) < 2**31 for name in number):
            number = {name: int(name) for name in number}
        self._id = np.array([number[name] for name in names.tolist()])
        self._called = {k: "" if name == str(k) else name for name, k in number.items()}
        self._dropped: set[int] = set()
        self._rows = slice(0, 0)
        self.start_s, self.end_s = float(self._time_s[0]), float(self._time_s[-1])

    def steps(self, after_s: float, until_s: float) -> list[float]:
        """Times of rows."""
        first, last = np.searchsorted(self._time_s, [after_s, until_s], side="right")
        return np.unique(self._time_s[first:last]).tolist()

    def advance(self, time_s: float) -> list[Any]:
        """Go to the rows of a time."""
        first = np.searchsorted(self._time_s, time_s, side="left")
        last = np.searchsorted(self._time_s, time_s, side="right")
        self._rows = slice(int(first), int(last))
        return []

    def tracks(self) -> Any:
        """The rows, without those that were dropped."""
        rows = np.arange(self._rows.start, self._rows.stop)
        rows = rows[~np.isin(self._id[rows], list(self._dropped))]
        number = self._id[rows]
        return SimpleNamespace(
            track_id=number,
            mean=self._mean[rows],
            covariance=self._covariance[rows],
            status=self._status[rows],
            name=np.array([self._called[k] for k in number.tolist()], dtype=str),
            existence=np.full(len(rows), np.nan),
            mode_probability=None if self._modes is None else self._modes[rows],
            turn_rate_rad_s=None,
        )

    def plots_m(self) -> np.ndarray:
        """None are in the table."""
        return np.zeros((0, 2))

    def command(self, time_s: float, command: Mapping[str, Any]) -> dict[str, Any]:
        """Drop and rename; there is no tracker that could acquire."""
        if command["command"] == "acquire":
            return {"ok": False, "error": "a table of tracks has no plots to acquire a target from"}
        track_id = int(command["track_id"])
        if track_id not in self._called:
            return {"ok": False, "error": "no track has that number"}
        if command["command"] == "drop":
            self._dropped.add(track_id)
        else:
            self._called[track_id] = str(command["name"])[:31]
        return {"ok": True}

    def save(self) -> Any:
        """Rows, and what the operator has changed."""
        return self._rows, set(self._dropped), dict(self._called)

    def restore(self, state: Any) -> None:
        """The same."""
        self._rows, dropped, called = state
        self._dropped, self._called = set(dropped), dict(called)


def mode_words(table: Any) -> list[str]:
    """What each track of a table does, such as "turning to starboard"."""
    modes = table.mode_probability
    if modes is None:
        return [""] * len(table.track_id)
    modes = np.asarray(modes)
    if modes.ndim != 2 or modes.shape[1] != len(MODE_NAMES):
        return [""] * len(table.track_id)
    rates = table.turn_rate_rad_s
    turning = MODE_NAMES.index("turning")
    words = []
    for k, probability in enumerate(modes):
        likeliest = int(np.nanargmax(probability)) if np.isfinite(probability).any() else -1
        word = MODE_NAMES[likeliest] if likeliest >= 0 else ""
        if likeliest == turning and rates is not None:
            rate_rad_s = float(rates[k][turning])
            if math.isfinite(rate_rad_s) and abs(rate_rad_s) > math.radians(0.2):
                word = "turning to starboard" if rate_rad_s > 0.0 else "turning to port"
        words.append(word)
    return words


def _speed(value: Any) -> float:
    speed = float(value)
    if not SPEEDS[0] <= speed <= SPEEDS[-1]:
        raise ValueError(f"speed must be {SPEEDS[0]:g} to {SPEEDS[-1]:g}, got {quoted(value)}")
    return speed
