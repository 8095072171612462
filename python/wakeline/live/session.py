"""A live session without network: octets with their times in, tracks out."""

from __future__ import annotations

import base64
import math
import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import Any, Protocol

import numpy as np

import wakeline as wl
from wakeline.measurement import OwnShip
from wakeline.tracking import MODE_NAMES

from . import json_lines
from .ais import AisPicture, AisVessel
from .config import (
    CONNECTION,
    LiveConfig,
    OutputConfig,
    RadarConfig,
    check_once,
    config_of,
    read_config,
)
from .engine import TrackEngine
from .metrics import metrics_of
from .outputs import Output, make_output
from .own_ship import Missing, OwnShipSources, Pose, SourceKey
from .radar_feed import AntennaPeriod, PlacedPlot, PlotRow, RadarFeed, Sector, columns
from .shown import Shown
from .sources import Receivers, Source
from .watch import AlarmWatcher
from .zones import Zone, are_of_tracks, placed

Sweeps = Callable[[str, np.ndarray, float, float, np.ndarray], None]
"""Called with radar, azimuth_rad (n,), heading_rad (NaN: azimuths from north), range_m of the end
of the last cell, and cells (n, C) of uint8."""

CLOCK = "clock"
_MOST_CONNECTIONS = 64
_PUBLISH_S = 0.015, 1e-4  # between reports of tracks: least, and for each track
_WIDE_RAD = 1.0  # a sector after which they are reported at once
_WATCH_S = 0.5  # between looks for alarms
_PASS_S = 0.02  # between looks at what happens by time alone
_DISAGREE = ("identity_disagrees", "identity_jumps", "identity_shared")
_DISAGREE_S = 60.0  # a disagreement that is not stated again is over
_HISTORY = 60  # past positions of a track in the picture
_HISTORY_S = 5.0
_HITS_OF_ACQUIRED = 3  # more plots of a target that the operator acquires until it has figures
_NAME_OCTETS = 31
_MOST_EVENTS = 500


class Watcher(Protocol):
    """What decides on alarms: given every picture, asked by operators."""

    def update(self, session: Session, time_s: float) -> list[dict[str, Any]]:
        """Events of a new picture."""

    def command(self, session: Session, command: Mapping[str, Any]) -> dict[str, Any] | None:
        """The answer to an operator; None for a command of another."""

    def picture(self, session: Session) -> dict[str, Any]:
        """What it adds to :meth:`Session.picture`."""


class Session:
    """Tracks from what sources send, in the order in which it is fed.

    The same octets at the same times give the same tracks, bit for bit: nothing depends on the
    clock of the machine or on a network.

    Parameters
    ----------
    config : LiveConfig, dict, str or Path, optional
        Settings, as sections of a TOML file, or its path.

    Attributes
    ----------
    config : LiveConfig
    inputs : dict of str to Source
        By name. What is fed from another name becomes an input of datagrams.
    tracker : TrackEngine
    outputs : dict of str to Output
        Whose `send` receives octets.
    shown : Shown
        The shown tracks, each as of its last update.
    acquired : dict of int to int
        The tracks that the operator has acquired, and the plots at which they have motion.
    own : OwnShipSources
    ais : AisPicture
    sweeps : list of callable
        Called with the sweeps of radar video: radar, azimuths, heading, range and cells.
    watchers : list of Watcher
        The first decides on alarms and zones.
    news : list of dict
        Events of tracks since watchers were last called.
    listeners : list of callable
        Called with every event, track update and alarm: kind and values.
    time_s : float
        Of the last octets; -inf before the first.
    note : str
        Why the picture is not of now; empty if it is.
    journal : callable, optional
        Called with an operator's command before it is done; returns the time of it.
    lock : RLock
        Held by whoever feeds the session or asks it, where there are several threads.

    Examples
    --------
    >>> import wakeline as wl
    >>> session = wl.live.Session()
    >>> session.feed(0.0, "test", b'{"radar":"A","time_s":0,"range_m":900,"bearing_rad":1}\\n')
    >>> session.picture()["status"]["radars"]["A"]["plots"]
    1
    """

    def __init__(self, config: LiveConfig | Mapping[str, Any] | str | Path | None = None) -> None:
        self.config = _config(config)
        self.time_s = -math.inf
        self.lock = threading.RLock()
        self._passed_s = -math.inf
        self.journal: Callable[[Mapping[str, Any]], float] | None = None
        self.lost = 0
        self.note = ""
        self.record_problem = ""
        self.radars = {one.name: one for one in self.config.radars}
        engine_radars = [one.make_radar(self.config.settings) for one in self.config.radars]
        pairs = list(zip(self.config.radars, engine_radars, strict=True))
        named = {one.name: (one, radar) for one, radar in pairs}
        named[""] = pairs[0]  # inputs that name no radar have the first
        self._shared = Receivers(
            from_bow=frozenset(n for n, (one, _) in named.items() if one.azimuth == "bow"),
            sac_sic={n: one.sac_sic for n, (one, _) in named.items() if one.sac_sic},
            min_range_m={n: radar.min_range_m for n, (_, radar) in named.items()},
        )
        self.inputs = {one.name: Source(one, self._shared) for one in self.config.inputs}
        self.outputs: dict[str, Output] = {}
        for one in self.config.outputs:
            self.add_output(one)
        self.tracker = TrackEngine(
            engine_radars, self.config.settings, self.config.session.window_s
        )
        self.feeds = {
            one.name: RadarFeed(one.name, AntennaPeriod(radar.period_s)) for one, radar in pairs
        }
        self.own = OwnShipSources(self.config.own)
        self.ais = AisPicture()
        self.plane: wl.LocalPlane | None = None
        self.shown = Shown()
        self.sweeps: list[Sweeps] = []
        self.watchers: list[Watcher] = [
            AlarmWatcher(
                self.config.settings.danger_limits,
                zones=[Zone.of(one) for one in self.config.guard_zones if "outline_deg" not in one],
                danger_zones=self.config.settings.danger_zones,
            )
        ]
        self.listeners: list[Callable[[str, dict[str, Any]], None]] = []
        self.events: deque[dict[str, Any]] = deque(maxlen=_MOST_EVENTS)
        self._history: dict[int, deque[tuple[float, float, float]]] = {}
        self._watched_s = self._published_s = -math.inf
        self._unpublished = ""  # the radar of sectors whose tracks are not reported yet
        self.news: list[dict[str, Any]] = []
        self._disagree: dict[tuple[int, str], float] = {}
        self._edge_rad: dict[str, float] = {}
        self.acquired: dict[int, int] = {}
        self._held: set[int] = set()  # shown, though no radar has looked for long
        if self.config.session.origin_deg:
            self._set_origin(*self.config.session.origin_deg)
        for one in self.config.radars:
            if one.position_deg and self.plane is None:
                self._set_origin(*one.position_deg)
        if self.config.own.place_deg:
            if self.plane is None:
                self._set_origin(*self.config.own.place_deg)
            self.own.fix_place(*self.to_plane(*self.config.own.place_deg))

    # ------------------------------------------------------------------ in

    def feed(self, time_s: float, source: str, octets: bytes) -> None:
        """Take octets that a source sent.

        Parameters
        ----------
        time_s : float
            When they were received, UTC seconds. A time before the last one counts as that.
        source : str
            Name of an input; ``"clock"`` with no octets lets time pass.
        octets : bytes
            A datagram, or the next piece of a stream.

        Raises
        ------
        ValueError
            When the time is not finite. What is wrong with the octets is counted, never raised.
        """
        if not math.isfinite(time_s):
            raise ValueError(f"time_s must be finite, got {time_s}")
        self.time_s = time_s = max(time_s, self.time_s)
        if source != CLOCK:
            one = self.inputs.get(source) or self._new_input(source)
            for kind, values in one.read(time_s, octets):
                self._take(time_s, one, kind, values)
            for radar, video in one.videos.items():
                if video.show is None and self.sweeps:
                    video.show = partial(self._show, one, radar)
        self._pass(time_s)

    def _new_input(self, name: str) -> Source:
        """An input of datagrams, or a connection to an input that listens."""
        parent = self.inputs.get(name.partition(CONNECTION)[0])
        connections = [one for one in self.inputs if CONNECTION in one]
        if len(connections) >= _MOST_CONNECTIONS:
            del self.inputs[min(connections, key=lambda one: self.inputs[one].last_s)]
        if parent is None:
            one = Source.unknown(name, self._shared)
        else:
            one = Source(replace(parent.config, name=name), self._shared)
        self.inputs[name] = one
        return one

    def url_of(self, name: str) -> str:
        """The URL of an input; '' of one that is not configured."""
        one = self.inputs.get(name) or self.inputs.get(name.partition(CONNECTION)[0])
        return "" if one is None else one.config.url

    def _take(self, time_s: float, source: Source, kind: str, values: Any) -> None:
        try:
            getattr(self, f"_take_{kind}")(time_s, source, values)
        except (wl.FilterError, ValueError) as error:
            source.problems.add("tracker", str(error))

    def _take_own(self, time_s: float, source: Source, reading: Any) -> None:
        key = SourceKey(reading.sentence, reading.talker, source.group)
        if reading.why_not:
            getattr(self.own, reading.quantity).reject(time_s, key, reading.why_not)
        else:
            self._add_own(time_s, key, reading.quantity, reading.values)

    def _add_own(
        self, time_s: float, key: SourceKey, quantity: str, values: tuple[float, ...]
    ) -> None:
        own = self.own
        if quantity == "position":
            if self.plane is None:
                self._set_origin(*values)
            own.position.add(time_s, key, self.to_plane(*values))
        elif quantity == "magnetic":
            own.add_magnetic(time_s, key, values[0])
        elif quantity == "variation":
            own.learn_variation(values[0])
        else:
            getattr(own, quantity).add(time_s, key, values)

    def _take_ais(self, time_s: float, source: Source, message: Any) -> None:
        found = self.ais.add(time_s, message.message)
        if found is None:
            return
        vessel, is_new = found
        if not is_new:
            return
        if message.own:
            key = SourceKey("VDO", "AI", source.group)
            self._add_own(time_s, key, "position", (vessel.latitude_deg, vessel.longitude_deg))
            del self.ais.vessels[vessel.mmsi]
            return
        self._report_vessel(vessel)

    def _take_vessel(self, time_s: float, source: Source, reading: Any) -> None:
        vessel, is_new = self.ais.update(time_s, reading.mmsi, reading.values)
        if is_new:
            self._report_vessel(vessel)

    def _report_vessel(self, vessel: AisVessel) -> None:
        """Give the position of a vessel to the tracker; what is fixed is shown alone."""
        if self.plane is None or vessel.is_fixed:
            return
        north_m, east_m = self.to_plane(vessel.latitude_deg, vessel.longitude_deg)
        to_middle = vessel.to_middle_m
        north_m, east_m = north_m + to_middle[0], east_m + to_middle[1]
        speed, course = vessel.speed_mps, vessel.course_rad
        self._report(
            source="ais",
            identity=vessel.identity,
            time_s=vessel.time_s,
            north_m=north_m,
            east_m=east_m,
            position_std_m=vessel.position_std_m,
            vnorth_mps=speed * math.cos(course),
            veast_mps=speed * math.sin(course),
        )

    def _report(self, **report: Any) -> None:
        """Give a report with an identity to the tracker."""
        events, left_out = self.tracker.report(**report)
        self._tracker_events(events)
        if (left_out, report["identity"]) in self._disagree:  # it lasts
            self._disagree[left_out, report["identity"]] = self.tracker.time_s

    def _take_json(self, time_s: float, source: Source, line: tuple[str, str, dict]) -> None:
        kind, radar, values = line
        if kind in ("plot", "sector"):
            feed = self._feed_of(source, radar)
            if feed is None:
                return
            when_s = feed.clock(values["time_s"], time_s)
            if kind == "plot":
                stds = values.get("range_std_m", 0.0), values.get("bearing_std_rad", 0.0)
                plot = PlotRow(
                    when_s, values["range_m"], values["bearing_rad"], stds[0] ** 2, stds[1] ** 2
                )
                self._plot(feed, plot)
            else:
                self._sectors(feed, feed.mark(values["from_rad"], values["to_rad"], when_s))
        elif kind == "own":
            self._take_json_own(time_s, source, values)
        else:
            self._take_json_report(time_s, source, values)

    def _take_radar(
        self, time_s: float, source: Source, found: tuple[str, PlotRow | PlacedPlot | Sector]
    ) -> None:
        """Take a plot or a sector of a radar, on the session's clock."""
        radar, one = found
        feed = self._feed_of(source, radar)
        if feed is None:
            return
        if isinstance(one, PlacedPlot):
            one = self._measured(self.radars[feed.name], one)
            if isinstance(one, Missing):
                source.problems.add("plot's position", f"not used: {one.reason}")
                return
        if isinstance(one, PlotRow):
            self._plot(feed, one)
        else:
            self._sectors(feed, feed.mark(one.from_rad, one.to_rad, one.time_s))

    def _measured(self, radar: RadarConfig, plot: PlacedPlot) -> PlotRow | Missing:
        """A plot as the radar measures it from its place."""
        from_bow = radar.azimuth == "bow"
        antenna = self._antenna(radar, plot.time_s, needs_heading=from_bow)
        if isinstance(antenna, Missing):
            return antenna
        if self.plane is None:
            return Missing("no origin yet")
        pose, own = antenna
        north_m, east_m = self.to_plane(*map(math.degrees, plot[1:]))
        north_m, east_m = north_m - own.north_m, east_m - own.east_m
        bearing_rad = math.atan2(east_m, north_m) - (pose.heading_rad if from_bow else 0.0)
        return PlotRow(plot.time_s, math.hypot(north_m, east_m), bearing_rad % (2.0 * math.pi))

    def _feed_of(self, source: Source, radar: str) -> RadarFeed | None:
        """The radar of that name, else that of the input, else the first."""
        feed = self.feeds.get(radar or source.radar or next(iter(self.feeds)))
        if feed is None:
            source.problems.add("radar", f"wanted one of {', '.join(self.feeds)}, got {radar}")
        return feed

    def _take_json_own(self, time_s: float, source: Source, values: dict[str, float]) -> None:
        key = SourceKey("JSON", "", source.group)
        when_s = source.clock(values.get("time_s", time_s), time_s)
        if "latitude_deg" in values:
            place = values["latitude_deg"], values["longitude_deg"]
            self._add_own(when_s, key, "position", place)
        elif "north_m" in values:
            self.own.position.add(when_s, key, (values["north_m"], values["east_m"]))
        if "heading_rad" in values:
            self._add_own(when_s, key, "heading", (values["heading_rad"] % (2.0 * math.pi),))
        if "course_rad" in values and "speed_mps" in values:
            self._add_own(when_s, key, "velocity", _velocity(values))

    def _take_json_report(self, time_s: float, source: Source, values: dict[str, Any]) -> None:
        if "latitude_deg" in values:
            if self.plane is None:
                return
            north_m, east_m = self.to_plane(values["latitude_deg"], values["longitude_deg"])
        elif "north_m" in values:
            north_m, east_m = values["north_m"], values["east_m"]
        else:
            source.problems.add("report", "wanted a position")
            return
        vnorth_mps, veast_mps = _velocity(values)
        self._report(
            source=values["source"],
            identity=values["identity"],
            time_s=source.clock(values["time_s"], time_s),
            north_m=north_m,
            east_m=east_m,
            position_std_m=values.get("position_std_m", 10.0),
            vnorth_mps=vnorth_mps,
            veast_mps=veast_mps,
        )

    # ------------------------------------------------------------------ sectors

    def _show(
        self,
        source: Source,
        radar: str,
        azimuth_rad: np.ndarray,
        range_m: float,
        cells: np.ndarray,
    ) -> None:
        """Give sweeps of a radar to those who show them."""
        feed = self._feed_of(source, radar)
        if feed is None:
            return
        heading = None
        if self.radars[feed.name].azimuth == "bow":
            heading = self.own.heading_at(self.time_s)
        heading_rad = math.nan if heading is None else heading[0]
        for show in self.sweeps:
            show(feed.name, azimuth_rad, heading_rad, range_m, cells)

    def _pass(self, time_s: float) -> None:
        """What happens by time alone."""
        if time_s - self._passed_s < _PASS_S:
            return
        self._passed_s = time_s
        self.own.choose(time_s)
        for one in self.inputs.values():
            for kind, values in one.pass_to(time_s):
                self._take(time_s, one, kind, values)
        for feed in self.feeds.values():
            self._sectors(feed, feed.pass_to(time_s))
        before_s = self.tracker.time_s
        self._tracker_events(self.tracker.coast(time_s))
        news = self._unpublished or self.tracker.time_s > before_s
        if news and self._is_due():
            self._publish()
        if not self.tracker.time_s:  # also while no sector can be used
            self._watch(time_s)

    def _plot(self, feed: RadarFeed, plot: PlotRow) -> None:
        if feed.antenna.add(plot):
            index = list(self.feeds).index(feed.name)
            self.tracker.set_period(index, feed.period_s, plot.time_s)
        self._sectors(feed, feed.add(plot))

    def _sectors(self, feed: RadarFeed, sectors: Sequence[Sector]) -> None:
        for sector in sectors:
            self._sector(feed, sector)

    def _sector(self, feed: RadarFeed, sector: Sector) -> None:
        radar = self.radars[feed.name]
        from_bow = radar.azimuth == "bow"
        antenna = self._antenna(radar, sector.time_s, needs_heading=from_bow)
        if isinstance(antenna, Missing):
            feed.unused_why = antenna.reason
            feed.unused += len(sector.plots)
            self._edge_rad.pop(feed.name, None)
            return
        feed.unused_why, feed.used_s = "", self.time_s
        end, own = antenna
        plot_time_s, range_m, bearing_rad, covariance = columns(sector.plots)
        place_m = _moved(own, plot_time_s - sector.time_s)
        if len(sector.plots) and not radar.position_deg:
            range_m, bearing_rad = self._seen_from(
                place_m, radar, plot_time_s, range_m, bearing_rad, from_bow
            )
        index = list(self.radars).index(feed.name)
        kept = self._outside(index, sector.time_s, place_m, range_m, bearing_rad)
        if not kept.all():
            feed.excluded += int(np.sum(~kept))
            plot_time_s, range_m, bearing_rad = (
                one[kept] for one in (plot_time_s, range_m, bearing_rad)
            )
            covariance = None if covariance is None else covariance[kept]
        from_rad, to_rad = sector.from_rad, sector.to_rad
        if from_bow:
            to_rad = to_rad + end.heading_rad
            from_rad = self._edge_rad.get(feed.name, from_rad + end.heading_rad)
            self._edge_rad[feed.name] = to_rad
            width_rad = sector.to_rad - sector.from_rad
            if width_rad >= 2.0 * math.pi - 1e-9:
                from_rad, to_rad = 0.0, 2.0 * math.pi
            elif not 0.0 <= (to_rad - from_rad) % (2 * math.pi) <= 2.0 * width_rad + 0.1:
                from_rad = sector.from_rad + end.heading_rad
        self.tracker.note_lateness(sector.time_s, self.time_s)
        events = self.tracker.sector(
            index,
            from_rad,
            to_rad,
            sector.time_s,
            range_m,
            bearing_rad,
            plot_time_s,
            own,
            covariance,
        )
        self._tracker_events(events)
        self._unpublished = feed.name
        wide = sector.to_rad - sector.from_rad > _WIDE_RAD
        if wide or self._is_due():
            self._publish()

    def _outside(
        self,
        index: int,
        time_s: float,
        place_m: np.ndarray,
        range_m: np.ndarray,
        bearing_rad: np.ndarray,
    ) -> np.ndarray:
        """Which plots (n,) from places (n, 2) are used: :meth:`Zones.kept`."""
        if not len(range_m):
            return np.ones(0, dtype=bool)
        direction = np.column_stack([np.cos(bearing_rad), np.sin(bearing_rad)])
        plots_m = place_m + range_m[:, np.newaxis] * direction
        radar, shown = self.tracker.radars[index], self.shown

        def is_tracked(which: np.ndarray) -> np.ndarray:
            plots = radar, range_m[which], plots_m[which]
            return are_of_tracks(*plots, shown.mean, shown.covariance, time_s - shown.time_s)

        return self.watchers[0].alarms.zones.kept(plots_m, is_tracked)

    def _antenna(
        self, radar: RadarConfig, time_s: float, *, needs_heading: bool
    ) -> tuple[Pose, OwnShip] | Missing:
        """Own ship and the antenna at a time."""
        if radar.position_deg:
            north_m, east_m = self.to_plane(*radar.position_deg)
            return Pose(time_s, north_m, east_m, *(0.0,) * 6), OwnShip(
                north_m=north_m, east_m=east_m
            )
        pose = self.own.at(time_s, needs_heading=needs_heading)
        if isinstance(pose, Missing):
            return pose
        antenna = pose.antenna(radar.forward_m, radar.starboard_m)
        if not needs_heading:
            antenna = _with_true_bearings(antenna)
        return pose, antenna

    def _seen_from(
        self,
        place_m: np.ndarray,
        radar: RadarConfig,
        time_s: np.ndarray,
        range_m: np.ndarray,
        bearing_rad: np.ndarray,
        from_bow: bool,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Ranges and true bearings of plots (n,) from places (n, 2).

        A tracker, which has own ship at the end of the sector alone, takes plots to be seen from
        where the velocity of own ship had the antenna.
        """
        ranges, bearings = np.empty(len(time_s)), np.empty(len(time_s))
        rows = zip(time_s.tolist(), range_m.tolist(), bearing_rad.tolist(), strict=True)
        for k, (when_s, r, b) in enumerate(rows):
            antenna = self._antenna(radar, when_s, needs_heading=from_bow)
            if isinstance(antenna, Missing):
                ranges[k], bearings[k] = r, b
                continue
            pose, then = antenna
            true_rad = b + pose.heading_rad if from_bow else b
            north_m = then.north_m - place_m[k, 0] + r * math.cos(true_rad)
            east_m = then.east_m - place_m[k, 1] + r * math.sin(true_rad)
            ranges[k], bearings[k] = math.hypot(north_m, east_m), math.atan2(east_m, north_m)
        return ranges, bearings

    # ------------------------------------------------------------------ out

    def _is_due(self) -> bool:
        """Whether the last report of tracks is long enough ago; many take longer to list."""
        least_s, each_s = _PUBLISH_S
        return self.time_s - self._published_s >= max(least_s, each_s * len(self.shown))

    def _publish(self) -> None:
        """Report the tracks that sectors have updated."""
        self._published_s = self.time_s
        radar, self._unpublished = self._unpublished, ""
        table, rows, gone = self.tracker.updated()
        gone = self._gone_now(table, gone)
        self.shown.take(table, rows, self.is_acquiring(table))
        self.shown.drop(gone)
        self._remember(table, rows)
        if len(rows) or gone:
            lines = cache(partial(self.lines, table, rows, radar))
            for output in self.outputs.values():
                output.tracks(self, lines)
            if self.listeners:
                for line in lines():
                    self._tell("track", json_lines.track_values(line))
        for track_id in gone:
            self._history.pop(track_id, None)
            self.acquired.pop(track_id, None)
        self._watch(self.tracker.time_s)

    def _gone_now(self, table: wl.track.TrackTable, gone: Sequence[int]) -> list[int]:
        """The tracks that are gone; not yet those that are held because radars are silent."""
        self._held = (self._held | set(gone)) - set(table.track_id.tolist())
        kept = set()
        if self._held and self.watchers[0].is_blind(self, self.tracker.time_s):
            kept = self._held & self.tracker.held()
        gone, self._held = sorted(self._held - kept), kept
        return gone

    def _watch(self, time_s: float) -> None:
        """Look for alarms, if the last look is long enough ago."""
        if time_s - self._watched_s < _WATCH_S:
            return
        self._watched_s = time_s
        events = [event for watcher in self.watchers for event in watcher.update(self, time_s)]
        self.news.clear()
        for event in events:
            self._event(event)

    def _remember(self, table: wl.track.TrackTable, rows: np.ndarray) -> None:
        """Keep the positions of tracks, as far apart in time as they are shown."""
        columns = (one[rows].tolist() for one in (table.track_id, table.time_s, table.mean))
        for track_id, time_s, (north_m, _, east_m, _) in zip(*columns, strict=True):
            past = self._history.setdefault(track_id, deque(maxlen=_HISTORY))
            if not past or time_s - past[-1][0] >= _HISTORY_S:
                past.append((time_s, north_m, east_m))

    def _tracker_events(self, events: Sequence[dict[str, Any]]) -> None:
        for event in events:
            self.news.append(event)
            key = event["track_id"], event.get("identity", "")
            if event["event"] in _DISAGREE:
                self._disagree[key] = event["time_s"]
            elif event["event"] in ("identified", "identity_lost"):
                self._disagree.pop(key, None)
            self._event(event)

    def called(self, name: str, identity: str) -> str:
        """What a target is called: by its name, else by that of the vessel that reports."""
        if name or not identity.isdecimal():
            return name
        vessel = self.ais.vessels.get(int(identity))
        return vessel.name if vessel is not None and vessel.identity == identity else ""

    def disagreements(self) -> list[tuple[int, str, str]]:
        """Tracks whose reports are not where their echoes are: number, identity, and what is so."""
        now_s = self.tracker.time_s
        self._disagree = {
            key: when_s for key, when_s in self._disagree.items() if now_s - when_s < _DISAGREE_S
        }
        return [(*key, "its reports disagree with its echo") for key in self._disagree]

    def _event(self, event: dict[str, Any]) -> None:
        self.events.append(event)
        for output in self.outputs.values():
            output.event(self, event)
        self._tell("event", event)

    def _tell(self, kind: str, values: dict[str, Any]) -> None:
        for listener in self.listeners:
            listener(kind, values)

    def add_output(self, config: OutputConfig | str) -> Output:
        """Add a receiver of tracks; its `send` is called with octets.

        Raises
        ------
        SettingsError
            When there is one of that name.
        """
        if isinstance(config, str):
            config = LiveConfig(outputs=(OutputConfig(config),)).outputs[0]
        check_once("outputs", [*self.outputs, config.name])
        self.outputs[config.name] = make_output(config)
        return self.outputs[config.name]

    def lines(
        self,
        table: wl.track.TrackTable,
        rows: np.ndarray | None = None,
        radar: str | None = None,
    ) -> list[bytes]:
        """Tracks of a table, or of some of its rows, as JSON lines."""
        which = slice(None) if rows is None else rows
        mean, covariance = table.mean[which], table.covariance[which]
        time_s = table.time_s[which]
        if not len(mean):
            return []
        own = self.own.at(float(time_s.max()))
        columns: dict[str, np.ndarray] = {}
        if self.plane is not None:
            columns["place_deg"] = np.degrees(self.plane.place(mean[:, [0, 2]])).T
        if isinstance(own, Pose):
            columns |= self._relative(own, time_s, mean, covariance)
        lines = table.json_lines(rows, radar=radar, modes=MODE_NAMES, **columns)
        for k in np.flatnonzero(self.is_acquiring(table)[which]).tolist():
            lines[k] = json_lines.without_danger(lines[k])
        return lines

    def is_acquiring(self, table: wl.track.TrackTable) -> np.ndarray:
        """Which tracks of a table (n,) the operator has acquired that have too few plots yet."""
        if not self.acquired:
            return np.zeros(len(table.hits), dtype=bool)
        wanted = [self.acquired.get(one, 0) for one in table.track_id.tolist()]
        return np.asarray(table.hits) < np.array(wanted, dtype=int)

    def _relative(
        self, own: Pose, time_s: np.ndarray, mean: np.ndarray, covariance: np.ndarray
    ) -> dict[str, np.ndarray]:
        """Range, bearing and closest approach to own ship, of states (k, 4) at their times."""
        moves = math.isfinite(own.vnorth_mps)
        state = np.tile([own.north_m, own.vnorth_mps, own.east_m, own.veast_mps], (len(mean), 1))
        if moves:
            state[:, 0::2] += (time_s - own.time_s)[:, np.newaxis] * state[:, 1::2]
        north_m, east_m = (mean - state)[:, 0::2].T
        bearing_rad = np.arctan2(east_m, north_m) % (2.0 * np.pi)
        columns = {"direction": np.column_stack([np.hypot(north_m, east_m), bearing_rad])}
        if not moves:
            return columns
        own_covariance = np.diag([0.0, own.velocity_std_mps**2] * 2)
        approach = wl.navigation.closest_approach(state, mean, own_covariance, covariance)
        limits = self.config.settings.danger_limits
        probability = approach.probability(limits.cpa_limit_m, limits.tcpa_limit_s)
        columns["approach"] = np.column_stack([approach.cpa_m, approach.tcpa_s, probability])
        return columns

    def picture(self) -> dict[str, Any]:
        """All that a screen shows, ready for JSON: SI units, radians, positions also in degrees.

        Its keys are ``version``, ``time_s``, ``origin_deg``, ``own``, ``ashore``, ``radars``,
        ``tracks``, ``ais``, ``alarms``, ``zones`` and ``status``.
        """
        time_s = self.time_s if math.isfinite(self.time_s) else 0.0
        lines = self.lines(self.tracker.table(self._shown_s(time_s)))
        tracks = [json_lines.track_values(line) for line in lines]
        track_of = {one["identity"]: one["track_id"] for one in tracks}
        picture = {
            "version": json_lines.VERSION,
            "time_s": time_s,
            "origin_deg": self.origin_deg,
            "own": self._own_picture(time_s),
            "ashore": self.is_ashore,
            "note": self.note,
            "radars": [self._radar_picture(name, time_s) for name in self.radars],
            "ais": [
                self._vessel_picture(vessel, time_s) | {"track_id": track_of.get(vessel.identity)}
                for vessel in self.ais.vessels.values()
            ],
            "alarms": [],
            "zones": [],
            "status": self.status(),
        }
        for watcher in self.watchers:
            picture |= watcher.picture(self)
        for values in tracks:
            values["manual"] = values["track_id"] in self.acquired
            seen_s = self.shown.seen_s(values["track_id"])
            if seen_s is not None:
                values["first_s"], values["age_s"] = seen_s[0], values["time_s"] - seen_s[1]
            values["history"] = list(self._history.get(values["track_id"], ()))
        return json_lines.finite_only(picture) | {"tracks": tracks}

    def _shown_s(self, time_s: float) -> float | None:
        """The time of the tracks in the picture; None before the first sector."""
        return max(time_s, self.tracker.time_s) if self.tracker.time_s else None

    @property
    def is_ashore(self) -> bool:
        """Whether there is no own ship: radars have a place for good, nothing else a position."""
        aboard = any(
            self.feeds[name].last_s > -math.inf and not radar.position_deg
            for name, radar in self.radars.items()
        )
        return not aboard and self.own.last(self.time_s) is None

    def _own_picture(self, time_s: float) -> dict[str, Any] | None:
        """Own ship as it is, or, `lost`, where it was last."""
        pose = self.own.at(time_s)
        is_lost = isinstance(pose, Missing)
        if is_lost:
            pose = self.own.last(time_s)
        if pose is None:
            return None
        values = pose._asdict() | {"lost": is_lost}
        place = self.to_degrees(pose.north_m, pose.east_m)
        if place is not None:
            values["latitude_deg"], values["longitude_deg"] = place
        values["speed_mps"] = math.hypot(pose.vnorth_mps, pose.veast_mps)
        values["course_rad"] = math.atan2(pose.veast_mps, pose.vnorth_mps) % (2.0 * math.pi)
        return values

    def _radar_picture(self, name: str, time_s: float) -> dict[str, Any]:
        config, feed = self.radars[name], self.feeds[name]
        antenna = self._antenna(config, time_s, needs_heading=config.azimuth == "bow")
        known = not isinstance(antenna, Missing)
        return {
            "name": name,
            "azimuth": config.azimuth,
            "aboard": not config.position_deg,
            "period_s": feed.period_s,
            "north_m": antenna[1].north_m if known else None,
            "east_m": antenna[1].east_m if known else None,
        }

    def _vessel_picture(self, vessel: Any, time_s: float) -> dict[str, Any]:
        values = vessel.as_dict() | {"age_s": time_s - vessel.time_s}
        if self.plane is not None and math.isfinite(vessel.latitude_deg):
            values["north_m"], values["east_m"] = self.to_plane(
                vessel.latitude_deg, vessel.longitude_deg
            )
        return values

    @property
    def frozen(self) -> str:
        """Why tracks are not updated, or which radars are not used; empty if all are."""
        heard = [feed for feed in self.feeds.values() if not feed.is_silent_at(self.time_s)]
        unused = [feed for feed in heard if feed.unused_why]
        if unused and len(unused) == len(heard):
            return f"tracks frozen: {unused[0].unused_why}"
        return "; ".join(f"radar {feed.name} not used: {feed.unused_why}" for feed in unused)

    def _file_problems(self) -> list[str]:
        """Why the session file or the table of alarms is not written."""
        logs = [getattr(one, "log", None) for one in self.watchers]
        found = [self.record_problem, *(one.problem for one in logs if one is not None)]
        return [one for one in found if one]

    def status(self) -> dict[str, Any]:
        """Rates, losses, ages and problems of all sources, ready for JSON."""
        time_s = self.time_s if math.isfinite(self.time_s) else 0.0
        return json_lines.finite_only(
            {
                "time_s": time_s,
                "frozen": self.frozen,
                "lost_batches": self.lost,
                "file_problems": self._file_problems(),
                "late": self.tracker.late,
                "north_off_deg": self._north_off_deg(time_s),
                "inputs": {name: one.status(time_s) for name, one in self.inputs.items()},
                "outputs": {name: one.status() for name, one in self.outputs.items()},
                "radars": {
                    name: {
                        "plots": feed.plots,
                        "sectors": feed.sectors,
                        "period_s": feed.period_s,
                        "unused_plots": feed.unused,
                        "excluded_plots": feed.excluded,
                        "unused_why": feed.unused_why,
                        "age_s": time_s - feed.last_s,
                        "clock_offset_s": self._clock_offset_s(feed),
                    }
                    for name, feed in self.feeds.items()
                },
                "own": self.own.status(time_s, lambda n, e: self.to_degrees(n, e)),
                "tracks": len(self.tracker),
                "modes": self.tracker.modes(),
                "ais_vessels": len(self.ais.vessels),
            }
        )

    def _north_off_deg(self, time_s: float) -> float:
        """How far the plane's north is from north at own ship, which grows away from the origin."""
        pose = self.own.at(time_s)
        if self.plane is None or isinstance(pose, Missing):
            return 0.0
        latitude_deg, longitude_deg = self.to_degrees(pose.north_m, pose.east_m)
        along_deg = longitude_deg - math.degrees(self.plane.longitude_rad)
        return ((along_deg + 180.0) % 360.0 - 180.0) * math.sin(math.radians(latitude_deg))

    def _clock_offset_s(self, feed: RadarFeed) -> float:
        """What is added to the times of a radar: of its lines, its messages, or its video."""
        names = [feed.name] + [""] * (feed.name == self.config.radars[0].name)
        clocks, shared = [feed.clock], self._shared
        for decoders in (shared.plots, shared.video, shared.spokes):
            clocks += [decoders[name].clock for name in names if name in decoders]
        return max((clock.offset_s for clock in clocks), key=abs)

    def metrics(self) -> str:
        """The status as text for Prometheus."""
        return metrics_of(self.status())

    def save(self) -> dict[str, Any]:
        """The state of tracks and of the numbers of outputs, ready for JSON.

        Sources of own ship, AIS and detection in video are not in it; they are found again from
        what is fed. The picture is corrected.
        """
        self.correct()
        numbers = {name: one.save() for name, one in self.outputs.items()}
        return {
            "time_s": self.time_s if math.isfinite(self.time_s) else 0.0,
            "origin_deg": self.origin_deg,
            "tracker": _text(self.tracker.save()),
            "heard": self.tracker.heard,
            "periods_s": [one.period_s for one in self.tracker.radars],
            "alarms": self.watchers[0].alarms.save(),
            "acquired": list(self.acquired.items()),
            "outputs": {name: _text(octets) for name, octets in numbers.items() if octets},
        }

    def correct(self) -> None:
        """Put all late data in the picture."""
        self._tracker_events(self.tracker.correct())

    def restore(self, state: Mapping[str, Any]) -> None:
        """Continue from a state; ValueError if it is not that of a session like this one."""
        try:
            periods_s = zip(self.feeds.values(), state["periods_s"], strict=True)
            for index, (feed, period_s) in enumerate(periods_s):
                feed.antenna.period_s = period_s
                self.tracker.set_period(index, period_s)
            self.tracker.restore(base64.b64decode(state["tracker"]), state.get("heard"))
            if state["origin_deg"] is not None:
                self._set_origin(*map(float, state["origin_deg"]))
            self.watchers[0].alarms.restore(state["alarms"])
            self.acquired = {int(one): int(hits) for one, hits in state.get("acquired", ())}
            self.time_s = float(state["time_s"])
            for name, text in state["outputs"].items():
                if name in self.outputs:
                    self.outputs[name].restore(self, base64.b64decode(text))
        except (KeyError, TypeError, AttributeError) as error:
            raise ValueError(f"the state is not that of a session ({error})") from None

    # ------------------------------------------------------------------ operators

    def command(self, command: Mapping[str, Any], time_s: float | None = None) -> dict[str, Any]:
        """Do what an operator asks for, at a time or at that of the last octets.

        ``{"command": "acquire", "north_m": ..., "east_m": ...}`` (or latitude_deg, longitude_deg),
        ``{"command": "drop", "track_id": ..., "hush": true}``,
        ``{"command": "rename", "track_id": ..., "name": ...}``, and those of the watchers.

        Returns
        -------
        dict
            ``{"ok": true, ...}``, or ``{"ok": false, "error": ...}``.
        """
        with self.lock:
            if time_s is None and self.journal is not None:
                time_s = self.journal(command)
            if time_s is not None:
                self.time_s = max(time_s, self.time_s)
            return self._command(command)

    def _command(self, command: Mapping[str, Any]) -> dict[str, Any]:
        try:
            name = command.get("command")
            for watcher in self.watchers:
                answer = watcher.command(self, command)
                if answer is not None:
                    return answer
            if name == "acquire":
                return self._acquire(command)
            if name == "drop":
                found = self.tracker.drop(
                    int(command["track_id"]), hush=bool(command.get("hush", True))
                )
                return _answer(found, "no track has that number")
            if name == "rename":
                given = str(command["name"])
                name = _kept_name(given)
                found = self.tracker.rename(int(command["track_id"]), name)
                kept = {"name": name} if name != given else {}
                return _answer(found, "no track has that number") | kept
            return _answer(False, f"unknown command {str(name)[:40]!r}")
        except KeyError as error:
            return _answer(False, f"wanted {error.args[0]}")
        except (ValueError, TypeError, OverflowError, wl.FilterError) as error:
            return _answer(False, str(error)[:200])

    def _acquire(self, command: Mapping[str, Any]) -> dict[str, Any]:
        if "latitude_deg" in command:
            if self.plane is None:
                return _answer(False, "the session has no position yet")
            place = self.to_plane(float(command["latitude_deg"]), float(command["longitude_deg"]))
        else:
            place = float(command["north_m"]), float(command["east_m"])
        std_m = float(command.get("position_std_m", 50.0))
        if not self.tracker.heard:
            return _answer(False, "no radar has given data yet")
        known = self.tracker.table().track_id.tolist()
        track_id = self.tracker.designate(self.tracker.time_s, *place, std_m)
        if track_id > 0 and track_id not in known:
            table = self.tracker.table()
            hits = int(table.hits[table.track_id == track_id].sum())
            self.acquired[track_id] = hits + _HITS_OF_ACQUIRED
        return _answer(track_id > 0, "there is no room for another track") | {"track_id": track_id}

    # ------------------------------------------------------------------ places

    def fix_of_receivers(self) -> tuple[OwnShip, bool]:
        """Own ship as receivers of TTM have it, and whether its velocity is known.

        It is at the last fix, not predicted; ashore at the radar.
        """
        pose = self.own.at(self.time_s)
        if isinstance(pose, Missing):
            used = self.own.position.used
            if used is not None:  # receivers keep the last fix
                north_m, east_m = used.value[-1][:2]
                return OwnShip(north_m=north_m, east_m=east_m), False
            antenna = self._antenna(self.config.radars[0], self.time_s, needs_heading=False)
            return (OwnShip(), False) if isinstance(antenna, Missing) else (antenna[1], True)
        source = self.own.position.fresh(self.time_s)
        place_m = (pose.north_m, pose.east_m) if source is None else source.value[-1]
        known = math.isfinite(pose.vnorth_mps)
        velocity_mps = (pose.vnorth_mps, pose.veast_mps) if known else (0.0, 0.0)
        own = OwnShip(
            north_m=place_m[0],
            east_m=place_m[1],
            vnorth_mps=velocity_mps[0],
            veast_mps=velocity_mps[1],
        )
        return own, known

    @property
    def origin_deg(self) -> tuple[float, float] | None:
        """Latitude and longitude of north 0, east 0; None while unknown."""
        if self.plane is None:
            return None
        return math.degrees(self.plane.latitude_rad), math.degrees(self.plane.longitude_rad)

    def _set_origin(self, latitude_deg: float, longitude_deg: float) -> None:
        is_first = self.plane is None
        self.plane = wl.LocalPlane(
            latitude_rad=math.radians(latitude_deg), longitude_rad=math.radians(longitude_deg)
        )
        if is_first:
            for one in self.config.guard_zones:
                if "outline_deg" in one:
                    self.watchers[0].alarms.set_zone(placed(one, self.to_plane))

    def to_plane(self, latitude_deg: float, longitude_deg: float) -> tuple[float, float]:
        """[north, east] of a place; the origin must be known."""
        position = self.plane.position_m(
            latitude_rad=math.radians(latitude_deg), longitude_rad=math.radians(longitude_deg)
        )
        return float(position[0]), float(position[1])

    def to_degrees(self, north_m: float, east_m: float) -> tuple[float, float] | None:
        """Latitude and longitude of a place; None while the origin is unknown."""
        if self.plane is None:
            return None
        latitude_rad, longitude_rad = self.plane.place([north_m, east_m])
        return math.degrees(float(latitude_rad)), math.degrees(float(longitude_rad))


def _config(config: LiveConfig | Mapping[str, Any] | str | Path | None) -> LiveConfig:
    if config is None:
        return LiveConfig()
    if isinstance(config, LiveConfig):
        return config
    if isinstance(config, Mapping):
        return config_of(config)
    return read_config(config)


def _kept_name(name: str) -> str:
    """What a tracker keeps of the name of a track."""
    return name.strip().encode()[:_NAME_OCTETS].decode(errors="ignore").strip()


def _velocity(values: Mapping[str, float]) -> tuple[float, float]:
    speed, course = values.get("speed_mps", math.nan), values.get("course_rad", math.nan)
    return speed * math.cos(course), speed * math.sin(course)


def _with_true_bearings(own: OwnShip) -> OwnShip:
    """The antenna of a radar that gives true bearings: its errors of heading are the radar's."""
    return OwnShip(**(own.as_dict() | {"heading_std_rad": 0.0}))


def _moved(own: OwnShip, ahead_s: np.ndarray) -> np.ndarray:
    """Where an antenna is so long after (n,), by its velocity: north and east, m, (n, 2)."""
    return np.column_stack(
        [own.north_m + ahead_s * own.vnorth_mps, own.east_m + ahead_s * own.veast_mps]
    )


def _text(octets: bytes) -> str:
    return base64.b64encode(octets).decode()


def _answer(good: bool, error: str) -> dict[str, Any]:
    return {"ok": True} if good else {"ok": False, "error": error}
