"""Zones and alarms as a watcher of a session."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np

import wakeline as wl
from wakeline._checks import at_least, positive

from .alarms import AlarmConfig, AlarmEvent, AlarmLog, Alarms, Disagreement, Sensor
from .zones import Zone, Zones, placed

_SILENT_TURNS, _SOME_TURNS, _BACK_TURNS = 2.5, 20.0, 5.0  # of an antenna without data
_LIMITS = ("cpa_limit_m", "tcpa_limit_s", "alarm_probability")


class AlarmBoard:
    """The alarms of a session, with the commands of operators and the log.

    Parameters
    ----------
    limits : wakeline.DangerLimits, optional
    zones : Zones or sequence of Zone, optional
    config : AlarmConfig, optional
    log : AlarmLog, optional
        Receives every change.
    danger_zones : sequence of wakeline.DangerZone
        Areas with separate limits.

    Attributes
    ----------
    alarms : Alarms
    log : AlarmLog or None
    """

    def __init__(
        self,
        limits: wl.DangerLimits | None = None,
        zones: Zones | Sequence[Zone] = (),
        config: AlarmConfig | None = None,
        log: AlarmLog | None = None,
        danger_zones: Sequence[wl.DangerZone] = (),
    ) -> None:
        self.alarms = Alarms(limits, zones, config, danger_zones=danger_zones)
        self.log = log

    def take(self, time_s: float, tracks: Any, **others: Any) -> list[AlarmEvent]:
        """Take the picture at a time: :meth:`Alarms.update`."""
        return self._logged(self.alarms.update(time_s, tracks, **others))

    def _logged(self, events: list[AlarmEvent]) -> list[AlarmEvent]:
        if self.log is not None and events:
            self.log.write(events)
        return events

    def obey(self, command: Mapping[str, Any]) -> dict[str, Any] | None:
        """Do what an operator asks for; None if it concerns neither zones nor alarms.

        ``zone`` (a :class:`Zone` as an object), ``zone_delete`` (zone_id), ``limits`` (cpa_limit_m,
        tcpa_limit_s, alarm_probability), ``acknowledge`` and ``silence`` (alarm_id, or "all").

        Raises
        ------
        ValueError, TypeError, KeyError
            When a value is missing or invalid; nothing is changed.
        """
        alarms, name = self.alarms, command.get("command")
        if name == "zone":
            return {"ok": True, "zone": alarms.set_zone(command["zone"]).as_dict()}
        if name == "zone_delete":
            return _answer(alarms.delete_zone(command["zone_id"]), "no zone has that number")
        if name == "limits":
            changed = {key: float(command[key]) for key in _LIMITS if key in command}
            at_least(1.0, **{k: v for k, v in changed.items() if k != "alarm_probability"})
            positive(**changed)  # limits of 0 would switch the alarms off
            now = alarms.limits.as_dict() | changed
            now["clear_probability"] = min(now["clear_probability"], now["alarm_probability"])
            alarms.limits = wl.DangerLimits(**now)
            return {"ok": True}
        if name in ("acknowledge", "silence"):
            found = getattr(alarms, name)(command["alarm_id"])
            return _answer(found, "no alarm with that number lasts")
        return None

    def shown(self) -> dict[str, Any]:
        """What it adds to the picture."""
        limits = self.alarms.limits.as_dict()
        return {
            "alarms": self.alarms.list(),
            "zones": self.alarms.zones.list(),
            "encounters": self.alarms.encounters(),
            "limits": {key: limits[key] for key in _LIMITS},
        }


class AlarmWatcher(AlarmBoard):
    """The alarms of a :class:`wakeline.live.Session`: one of its ``watchers``."""

    _blind_until_s = -math.inf

    def update(self, session: Any, time_s: float) -> list[dict[str, Any]]:
        """Changes of alarms at a new picture, as events of the session."""
        own = session.own.at(time_s)
        known = hasattr(own, "north_m") and np.isfinite([own.vnorth_mps, own.veast_mps]).all()
        table = session.tracker.table()
        names = map(session.called, table.name, table.identity)
        events = self.take(
            time_s,
            SimpleNamespace(
                track_id=table.track_id,
                mean=table.mean,
                covariance=table.covariance,
                status=np.where(session.is_acquiring(table), "tentative", table.status),
                name=list(names),
            ),
            own=[own.north_m, own.vnorth_mps, own.east_m, own.veast_mps] if known else None,
            is_ashore=session.is_ashore,
            is_blind=self.is_blind(session, time_s),
            heading_rad=own.heading_rad if hasattr(own, "heading_rad") else float("nan"),
            events=[SimpleNamespace(**one) for one in session.news],
            sensors=_sensors(session, time_s),
            disagreements=_disagreements(session),
        )
        return [event_of(one) for one in events]

    def is_blind(self, session: Any, time_s: float) -> bool:
        """Whether radars are silent or not used: all, one since a short time, or a moment ago."""
        heard = [feed for feed in session.feeds.values() if feed.used_s > -math.inf]
        silent_turns = [(time_s - feed.used_s) / feed.period_s for feed in heard]
        if any(_SILENT_TURNS < turns < _SOME_TURNS for turns in silent_turns) or (
            heard and min(silent_turns) > _SILENT_TURNS
        ):
            self._blind_until_s = time_s + _BACK_TURNS * max(feed.period_s for feed in heard)
        return time_s < self._blind_until_s

    def command(self, session: Any, command: Mapping[str, Any]) -> dict[str, Any] | None:
        """The answer to an operator; None for a command of another."""
        if command.get("command") == "drop" and "track_id" in command:
            self.alarms.forget(int(command["track_id"]))
            return None
        if command.get("command") == "zone" and session.plane is not None:
            return self.obey({**command, "zone": placed(command["zone"], session.to_plane)})
        return self.obey(command)

    def picture(self, session: Any) -> dict[str, Any]:
        """What it adds to the picture."""
        return self.shown()


def event_of(event: AlarmEvent) -> dict[str, Any]:
    """For JSON lines."""
    time_s, change, alarm = event
    return {"type": "alarm", "change": change} | alarm.as_dict(time_s) | {"time_s": time_s}


def _sensors(session: Any, time_s: float) -> list[Sensor]:
    """Radars, silent after three turns and 10 s, and own ship's data where they are too old."""
    sensors = [
        Sensor(f"radar {name}", time_s - feed.last_s, feed.longest_silence_s)
        for name, feed in session.feeds.items()
        if feed.last_s > float("-inf")
    ]
    unused = [one.unused_why for one in session.feeds.values()]
    for name, age_s, oldest_s, why in session.own.ages_s(time_s):
        if not math.isnan(age_s) or any(one.startswith(f"no {name}") for one in unused):
            sensors.append(Sensor(f"own ship's {name}", age_s, oldest_s, why))
    return sensors


def _disagreements(session: Any) -> list[Disagreement]:
    return [Disagreement(*one) for one in session.disagreements()]


def _answer(good: bool, error: str) -> dict[str, Any]:
    return {"ok": True} if good else {"ok": False, "error": error}
