"""A session for the screen whose tracks, echoes and own ship are as a test wants them."""

import math
import threading
import time

import numpy as np

import wakeline as wl
from wakeline.live.playback import Playback, RecordedPlots
from wakeline.live.watch import AlarmBoard
from wakeline.tracking import Settings

RANGE_M = 3000.0
ROWS, CELLS = 512, 256
ECHOES = [(0.5, 900.0), (2.2, 1800.0), (4.0, 2400.0)]  # bearing, range


class Harbor:
    """A session whose tracks, echoes and own ship are as a test wants them."""

    def __init__(self):
        self.lock = threading.RLock()
        self.sweeps, self.commands = [], []
        self.clear()

    def clear(self):
        self.tracks, self.ais = {}, []
        self.own = {"north_m": 0.0, "east_m": 0.0, "vnorth_mps": 0.0, "veast_mps": 0.0}
        self.own["heading_rad"] = math.pi / 2
        self.board = AlarmBoard()
        self.begin_s = 1.7e9 - time.monotonic()
        self.time_s = 1.7e9
        self.commands.clear()

    def add(self, track_id, north_m, east_m, vnorth_mps=0.0, veast_mps=0.0, **more):
        self.tracks[track_id] = {
            "track_id": track_id, "name": "", "status": "confirmed", "north_m": north_m,
            "east_m": east_m, "vnorth_mps": vnorth_mps, "veast_mps": veast_mps,
            "covariance": np.diag([25.0, 0.1, 25.0, 0.1]), "mode": "steady", "existence": 1.0,
            "history": [], **more,
        }  # fmt: skip

    def picture(self):
        self.time_s = self.begin_s + time.monotonic()
        self.watch()
        tracks = [track | {"time_s": self.time_s} for track in self.tracks.values()]
        return {
            "time_s": self.time_s,
            "own": self.own,
            "origin_deg": [50.0, -1.0],
            "radars": [{"name": "A"}],
            "tracks": tracks,
            "ais": self.ais,
            "status": {},
        } | self.board.shown()

    def watch(self):
        rows = list(self.tracks.values())
        n = len(rows)
        mean = [[t["north_m"], t["vnorth_mps"], t["east_m"], t["veast_mps"]] for t in rows]
        table = type("Table", (), {})()
        table.track_id = np.array([t["track_id"] for t in rows], dtype=int)
        table.mean = np.array(mean, dtype=float).reshape(-1, 4)
        table.covariance = np.array([t["covariance"] for t in rows]).reshape(-1, 4, 4)
        table.status = np.full(n, "confirmed")
        table.name = np.array([t["name"] for t in rows], dtype=str)
        own = [self.own[k] for k in ("north_m", "vnorth_mps", "east_m", "veast_mps")]
        self.board.take(self.time_s, table, own=own, heading_rad=self.own["heading_rad"])

    def command(self, command):
        self.commands.append(command)
        name, track_id = command.get("command"), command.get("track_id")
        if name == "acquire":
            track_id = max(self.tracks, default=0) + 1
            self.add(track_id, command["north_m"], command["east_m"], status="held")
            return {"ok": True, "track_id": track_id}
        if name == "rename":
            self.tracks[track_id]["name"] = command["name"]
            return {"ok": True}
        if name == "drop":
            self.board.alarms.forget(track_id)
            del self.tracks[track_id]
            return {"ok": True}
        return self.board.obey(command) or {"ok": False, "error": f"unknown command {name}"}

    def sweep(self, echoes=ECHOES):
        """One turn with echoes at (bearing, range), about 60 m wide and long."""
        azimuth_rad = (np.arange(ROWS) + 0.5) * 2.0 * np.pi / ROWS
        range_m = (np.arange(CELLS) + 0.5) * RANGE_M / CELLS
        cells = np.full((ROWS, CELLS), 10, np.uint8)
        for bearing_rad, echo_m in echoes:
            across_m = echo_m * np.abs((azimuth_rad - bearing_rad + np.pi) % (2 * np.pi) - np.pi)
            near = (across_m[:, None] < 30.0) & (np.abs(range_m - echo_m) < 30.0)
            cells[near] = 250
        for part in np.array_split(np.arange(ROWS), 8):
            for taker in self.sweeps:
                taker("A", azimuth_rad[part], math.nan, RANGE_M, cells[part])


def recorded_plots(log=None):
    """A playback of the first episode of the joyride."""
    recording = wl.recording.load("joyride")
    episode = recording.episodes[0]
    settings = Settings.default().knowing(recording.radar)
    source = RecordedPlots(episode, settings)
    return Playback(source, own=episode.own, settings=settings, log=log)
