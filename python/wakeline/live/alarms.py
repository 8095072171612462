"""Alarms of a session: zones, close passings, targets and sensors lost, AIS that disagrees.

They are decided here from the tracks, so that they need no screen. A condition begins one alarm
and keeps it until it is over; the operator can silence or acknowledge an alarm and can not end it.
"""

from __future__ import annotations

import csv
import io
import math
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import wakeline as wl
from wakeline._brief import quoted
from wakeline._checks import not_negative, whole_number

from .lines import append_whole
from .problems import in_words
from .zones import Crossing, OwnPlace, Zone, Zones

OWN_SHIP = 0
KINDS = (
    "cpa",
    "zone entry",
    "zone exit",
    "zone occupancy",
    "lost target",
    "new target",
    "sensor lost",
    "ais disagrees",
)
_PRIORITIES = {"cpa": "alarm", "zone entry": "alarm", "ais disagrees": "caution"}
_SHOWN = ("confirmed", "coasting")
_COUNTED_AS_LOST = ("missed", "uncertain", "failed", "too_fast", "")
_DANGER = (
    *("first", "second", "cpa_m", "tcpa_s", "probability"),
    *("first_at_cpa_m", "second_at_cpa_m"),
)
_PAIR_S = 6e-6  # between looks at close passings, times the square of the number of vessels
_MOST_ENDED = 200
_OUTAGE_S = 30.0  # after a longer one of a radar its targets have other numbers
_MOST_TARGET_ALARMS = 50
_RESTART_S = 30.0  # after a restart an alarm of before keeps its number


@dataclass(frozen=True, kw_only=True)
class AlarmConfig:
    """Which conditions raise alarms, and their times.

    Attributes
    ----------
    lost_target, new_target : bool
        Whether a target that is lost, or one that is new, raises an alarm.
    pairs : bool or None
        Whether a close passing of two tracks raises an alarm, beside those of own ship. None: only
        where there is no own ship, as ashore.
    established_s : float
        A lost target raises an alarm only if it was shown for this time.
    momentary_s : float
        How long an alarm about something that has happened (a lost or new target, a zone left)
        lasts; an acknowledgement ends it earlier.
    silence_s : float
        How long a silenced alarm makes no sound.
    sensor_back_s : float
        A lost sensor is back when it has been heard for this time.
    disagree_s, agree_s : float
        AIS disagrees with the radar when it has done so for the one time, until it has not for the
        other.
    """

    lost_target: bool = True
    new_target: bool = False
    pairs: bool | None = None
    established_s: float = 30.0
    momentary_s: float = 60.0
    silence_s: float = 60.0
    sensor_back_s: float = 5.0
    disagree_s: float = 10.0
    agree_s: float = 30.0

    def __post_init__(self) -> None:
        for one in fields(self):
            if one.name.endswith("_s"):
                not_negative(**{one.name: getattr(self, one.name)})


@dataclass
class Alarm:
    """An alarm from its beginning to its end.

    Attributes
    ----------
    alarm_id : int
        Positive, never used again.
    kind : str
        One of `KINDS`.
    priority : str
        "alarm" (immediate action), "warning" or "caution".
    text : str
        One line for the operator.
    begin_s, time_s : float
        Beginning, and time of the values below.
    tracks : tuple of int
        The tracks concerned; 0 is own ship.
    zone_id : int
        0 without a zone.
    source : str
        Sensor or identity concerned; empty without one.
    cpa_m, tcpa_s, probability : float
        Of a close passing: distance and time of the closest approach, and the probability of a
        distance below the limit. NaN for other kinds.
    acknowledged : bool
    silent_until_s : float
        The alarm makes no sound before this time.
    end_s : float
        NaN while it lasts.
    reason : str
        Why it has ended.
    """

    alarm_id: int
    kind: str
    priority: str
    text: str
    begin_s: float
    time_s: float
    tracks: tuple[int, ...] = ()
    zone_id: int = 0
    source: str = ""
    cpa_m: float = math.nan
    tcpa_s: float = math.nan
    probability: float = math.nan
    acknowledged: bool = False
    silent_until_s: float = -math.inf
    end_s: float = math.nan
    reason: str = ""

    def state_at(self, time_s: float) -> str:
        """ "active", "silenced", "acknowledged" or "ended"."""
        if not math.isnan(self.end_s):
            return "ended"
        if self.acknowledged:
            return "acknowledged"
        return "silenced" if time_s < self.silent_until_s else "active"

    def sounds_at(self, time_s: float) -> bool:
        """Whether it is to be heard; a caution never is."""
        return self.priority != "caution" and self.state_at(time_s) == "active"

    def as_dict(self, time_s: float) -> dict[str, Any]:
        """For JSON, with ``state`` and ``sounds`` at a time; unknown numbers are None."""
        values = {one.name: getattr(self, one.name) for one in fields(self)}
        values["tracks"] = list(self.tracks)
        values = {k: None if _unknown(v) else v for k, v in values.items()}
        return values | {"state": self.state_at(time_s), "sounds": self.sounds_at(time_s)}


class AlarmEvent(NamedTuple):
    """A change of an alarm ("began", "ended", "acknowledged" or "silenced"), as it then was."""

    time_s: float
    change: str
    alarm: Alarm


class Sensor(NamedTuple):
    """A source of data: lost when its last data are older than the limit."""

    name: str
    age_s: float
    limit_s: float
    why: str = "no data"


class Disagreement(NamedTuple):
    """A track whose identity report is not where its echo is."""

    track_id: int
    identity: str
    text: str


@dataclass
class _Held:
    """A condition with a delay before it holds and one before it is over."""

    since_s: float
    last_s: float
    alarm: Alarm | None = None
    good_since_s: float = math.nan


@dataclass
class _Shown:
    since_s: float
    name: str = ""
    gone_s: float = math.inf  # when it vanished while a radar was silent


class Alarms:
    """Decides the alarms of a session.

    Parameters
    ----------
    limits : wakeline.DangerLimits, optional
        Of a close passing.
    zones : Zones or sequence of Zone, optional
    config : AlarmConfig, optional
    danger_zones : sequence of wakeline.DangerZone
        Areas with separate limits of a close passing.
    max_vessels : int
        As many vessels are watched for close passings: at each update, of more than some 300 at
        longer intervals, 6 s for 1000.
    """

    def __init__(
        self,
        limits: wl.DangerLimits | None = None,
        zones: Zones | Sequence[Zone] = (),
        config: AlarmConfig | None = None,
        *,
        danger_zones: Sequence[wl.DangerZone] = (),
        max_vessels: int = 1000,
    ) -> None:
        whole_number("max_vessels", max_vessels, 1)
        self.zones = zones if isinstance(zones, Zones) else Zones(zones)
        self.config = config or AlarmConfig()
        self.time_s = -math.inf
        self._limits = limits or wl.DangerLimits()
        self._danger_zones, self._max_vessels = list(danger_zones), max_vessels
        self._watch = wl.EncounterWatch(self._limits, self._danger_zones, max_vessels)
        self._dangers = self._watch.encounters
        self._paired_s = -math.inf
        self._active: dict[int, Alarm] = {}
        self._ended: deque[Alarm] = deque(maxlen=_MOST_ENDED)
        self._next_id = 1
        self._encounters: dict[int, Alarm] = {}
        self._stays: dict[tuple[int, int, str], Alarm] = {}
        self._around: dict[int, tuple[str, str]] = {}  # the name of the zone in texts, by alarm
        self._saved: dict[tuple, tuple[int, float, bool]] = {}  # that lasted before a restart
        self._restart_s = math.inf
        self._momentary: list[Alarm] = []
        self._sensors: dict[str, _Held] = {}
        self._identities: dict[tuple[int, str], _Held] = {}
        self._tracks: dict[int, _Shown] = {}
        self._dropped: set[int] = set()
        self._changes: list[AlarmEvent] = []

    @property
    def limits(self) -> wl.DangerLimits:
        """Limits of a close passing; new ones end the encounters of the old ones."""
        return self._limits

    @limits.setter
    def limits(self, limits: wl.DangerLimits) -> None:
        self._limits = limits
        self._watch = wl.EncounterWatch(limits, self._danger_zones, self._max_vessels)
        for alarm in self._encounters.values():
            self._end(alarm, "new limits")
        self._encounters.clear()
        self._dangers = self._watch.encounters
        self._paired_s = -math.inf

    # What has happened ----------------------------------------------------------------------------

    def update(
        self,
        time_s: float,
        tracks: Any,
        *,
        own: Sequence[float] | None = None,
        own_covariance: Any = None,
        is_ashore: bool | None = None,
        is_blind: bool = False,
        heading_rad: float = math.nan,
        events: Iterable[Any] = (),
        sensors: Iterable[Sensor | tuple] = (),
        disagreements: Iterable[Disagreement | tuple] = (),
    ) -> list[AlarmEvent]:
        """Take the picture at a time.

        Parameters
        ----------
        time_s : float
            An earlier time than the last one counts as the last one.
        tracks : object
            With the columns ``track_id``, ``mean``, ``covariance``, ``status`` and, if known,
            ``name``: a ``TrackTable``. Only confirmed and coasting tracks count.
        own : [north, vnorth, east, veast], optional
            Own ship. A shore station has none; its sectors then need none either.
        own_covariance : (4, 4) array, optional
            Default: the velocity error of the limits.
        is_ashore : bool, optional
            Whether there is no own ship; default: none is given. Of one whose position is lost the
            close passings stay as they were.
        is_blind : bool
            Whether a radar is silent or has just come back: targets that vanish meanwhile are lost
            only if they are not back after it, and only after half a minute at most.
        heading_rad : float, optional
        events : iterable of wakeline.Event
            Of the tracker; a loss has its reason there.
        sensors : iterable of (name, age_s, limit_s, why)
            All sources at this time; `why` it has no data may be left out.
        disagreements : iterable of (track_id, identity, text)
            All that hold at this time.

        Returns
        -------
        list of AlarmEvent
            All changes since the last call, the operator's included.
        """
        self.time_s = time_s = max(time_s, self.time_s)
        self._restart_s = min(time_s, self._restart_s)
        if time_s - self._restart_s > _RESTART_S:
            self._saved.clear()
        shown = np.isin(np.asarray(tracks.status, dtype=str), _SHOWN)
        track_id = np.asarray(tracks.track_id, dtype=np.int64)[shown]
        mean = np.asarray(tracks.mean, dtype=float).reshape(-1, 4)[shown]
        covariance = np.asarray(tracks.covariance, dtype=float).reshape(-1, 4, 4)[shown]
        names = getattr(tracks, "name", None)
        names = [""] * len(track_id) if names is None else np.asarray(names, dtype=str)[shown]
        now = dict(zip(track_id.tolist(), map(str, names), strict=True))
        known = np.isfinite(mean).all(axis=1) & np.isfinite(covariance).all(axis=(1, 2))
        track_id, mean, covariance = track_id[known], mean[known], covariance[known]

        lasts_s = self.config.momentary_s
        self._end_momentary("time over", lambda one: time_s - one.begin_s >= lasts_s)
        self._pass_targets(now, events, is_blind)
        place = None if own is None else OwnPlace(own[0], own[2], heading_rad)
        std_m = np.sqrt(_largest_variance(covariance))
        places = mean[:, 0::2]
        hidden = self._tracks.keys() - now.keys()
        for crossing in self.zones.update(time_s, track_id, places, std_m, place, hidden):
            self._pass_crossing(crossing)
        self._pass_occupants()
        if not time_s - self._paired_s < _PAIR_S * len(track_id) ** 2:
            self._paired_s = time_s
            pairs = own is None if is_ashore is None else is_ashore
            if self.config.pairs is not None:
                pairs = self.config.pairs
            if own is not None or pairs:
                self._pass_encounters(track_id, mean, covariance, own, own_covariance, pairs)
        self._pass_sensors([Sensor(*one) for one in sensors])
        self._pass_disagreements([Disagreement(*one) for one in disagreements])
        return self.changes()

    def changes(self) -> list[AlarmEvent]:
        """All changes that no call has returned yet."""
        changes, self._changes = self._changes, []
        return changes

    def _pass_targets(self, now: dict[int, str], events: Iterable[Any], is_blind: bool) -> None:
        reasons = {e.track_id: e.reason for e in events if getattr(e, "kind", "") == "lost"}
        gone = [track_id for track_id in self._tracks if track_id not in now]
        for track_id in gone:
            was = self._tracks[track_id]
            if is_blind and track_id not in self._dropped:
                was.gone_s = min(was.gone_s, self.time_s)
                continue
            del self._tracks[track_id]
            by_outage = self.time_s - was.gone_s > _OUTAGE_S  # which was an alarm
            dropped = track_id in self._dropped
            self._dropped.discard(track_id)
            established = self.time_s - was.since_s >= self.config.established_s
            reason = reasons.get(track_id, "")
            counts = reason in _COUNTED_AS_LOST and established and not dropped and not by_outage
            if self.config.lost_target and counts:
                self._happen("lost target", f"{_called(track_id, was.name)} lost", (track_id,))
        for track_id, name in now.items():
            if track_id not in self._tracks:
                self._tracks[track_id] = _Shown(self.time_s, name)
                if self.config.new_target:
                    self._happen("new target", f"new {_called(track_id, name)}", (track_id,))
            self._tracks[track_id].name = name
            self._tracks[track_id].gone_s = math.inf

    def _pass_crossing(self, crossing: Crossing) -> None:
        zone, track_id = crossing.zone, crossing.track_id
        who = self._called(track_id)
        if crossing.entered:
            left = (zone.zone_id, (track_id,))
            self._end_momentary("entered again", lambda one: (one.zone_id, one.tracks) == left)
            if "entry" in zone.triggers:
                how = "is inside" if crossing.born_inside else "has entered"
                self._stays[zone.zone_id, track_id, "entry"] = self._of_zone(
                    self._begin, "zone entry", track_id, zone, f"{who} {how} "
                )
            return
        for trigger in ("entry", "occupancy"):
            alarm = self._stays.pop((zone.zone_id, track_id, trigger), None)
            if alarm is not None:
                self._end(alarm, "target lost" if crossing.lost else "left")
        if "exit" in zone.triggers and not crossing.lost:
            self._of_zone(self._happen, "zone exit", track_id, zone, f"{who} has left ")

    def _pass_occupants(self) -> None:
        for zone, track_id, stay_s in self.zones.occupants(self.time_s):
            key = (zone.zone_id, track_id, "occupancy")
            long = "occupancy" in zone.triggers and stay_s >= zone.occupancy_s
            if long and key not in self._stays:
                around = f"{self._called(track_id)} in ", f" for {zone.occupancy_s:.0f} s"
                self._stays[key] = self._of_zone(
                    self._begin, "zone occupancy", track_id, zone, *around
                )

    def _pass_encounters(
        self,
        track_id: np.ndarray,
        mean: np.ndarray,
        covariance: np.ndarray,
        own: Sequence[float] | None,
        own_covariance: Any,
        pairs: bool,
    ) -> None:
        if own is not None and np.isfinite(own).all():
            if own_covariance is None:
                error_m2s2 = self._limits.own_velocity_std_mps**2
                own_covariance = np.diag([0.0, error_m2s2, 0.0, error_m2s2])
            track_id = np.concatenate([[OWN_SHIP], track_id])
            mean = np.concatenate([[np.asarray(own, dtype=float)], mean])
            covariance = np.concatenate([[np.asarray(own_covariance, dtype=float)], covariance])
        report = self._watch.update(
            self.time_s, vessel_id=track_id, mean=mean, covariance=covariance
        )
        for number in report.ended.encounter_id.tolist():
            if number in self._encounters:
                self._end(self._encounters.pop(number), "danger over")
        self._dangers = self._watch.encounters
        for number, time_s, first, second, cpa_m, tcpa_s, probability in _rows(
            self._dangers,
            *("encounter_id", "time_s", "first", "second", "cpa_m", "tcpa_s", "probability"),
        ):
            if first != OWN_SHIP and not pairs:
                if number in self._encounters:
                    self._end(self._encounters.pop(number), "own ship is known")
                continue
            values = {"cpa_m": cpa_m, "tcpa_s": tcpa_s, "probability": probability}
            alarm = self._encounters.get(number)
            if alarm is None:
                text = self._encounter_text(first, second)
                alarm = self._begin("cpa", text, (first, second), **values)
                self._encounters[number] = alarm
                if alarm.acknowledged:
                    self._watch.acknowledge(number)
            vars(alarm).update(values, time_s=time_s)

    def _encounter_text(self, first: int, second: int) -> str:
        if first == OWN_SHIP:
            return f"{self._called(second)} comes close to own ship"
        return f"{self._called(first)} and {self._called(second)} come close"

    def _pass_sensors(self, sensors: list[Sensor]) -> None:
        for name, age_s, limit_s, why in sensors:
            held = self._sensors.setdefault(name, _Held(self.time_s, -math.inf))
            if age_s > limit_s or math.isnan(age_s):
                held.good_since_s = math.nan
                if held.alarm is None:
                    held.alarm = self._begin("sensor lost", f"{name}: {why}", source=name)
                continue
            if math.isnan(held.good_since_s):
                held.good_since_s = self.time_s
            back = self.time_s - held.good_since_s >= self.config.sensor_back_s
            if held.alarm is not None and back:
                self._end(held.alarm, "data again")
                held.alarm = None
        there = {sensor.name for sensor in sensors}
        for name in [name for name in self._sensors if name not in there]:
            held = self._sensors.pop(name)
            if held.alarm is not None:
                self._end(held.alarm, "source removed")

    def _pass_disagreements(self, disagreements: list[Disagreement]) -> None:
        for track_id, identity, text in disagreements:
            held = self._identities.setdefault(
                (track_id, identity), _Held(self.time_s, self.time_s)
            )
            held.last_s = self.time_s
            if held.alarm is None and self.time_s - held.since_s >= self.config.disagree_s:
                held.alarm = self._begin(
                    "ais disagrees",
                    f"{self._called(track_id)}: {text or f'AIS {identity} disagrees'}",
                    (track_id,),
                    source=identity,
                )
        for key, held in list(self._identities.items()):
            over = self.time_s - held.last_s >= self.config.agree_s
            brief = held.alarm is None and held.last_s < self.time_s
            if over or brief or key[0] not in self._tracks:
                del self._identities[key]
                if held.alarm is not None:
                    self._end(held.alarm, "agrees" if over else "target lost")

    # What the operator does -----------------------------------------------------------------------

    def set_zone(self, zone: Zone | Mapping[str, Any]) -> Zone:
        """Add or change a zone: :meth:`Zones.set`; the alarms that last have its new name."""
        zone = self.zones.set(zone)
        for alarm_id, (before, after) in self._around.items():
            alarm = self._active[alarm_id]
            if alarm.zone_id == zone.zone_id:
                alarm.text = f"{before}{zone.name}{after}"
        return zone

    def delete_zone(self, zone_id: int) -> bool:
        """Remove a zone and end its alarms; False if none has that number."""
        if self.zones.delete(zone_id) is None:
            return False
        for key in [key for key in self._stays if key[0] == zone_id]:
            self._end(self._stays.pop(key), "zone deleted")
        self._end_momentary("zone deleted", lambda one: one.zone_id == zone_id)
        return True

    def save(self) -> dict[str, Any]:
        """Zones, numbers and what lasts, for `restore`."""
        lasting = [one for one in self._active.values() if one not in self._momentary]
        return {
            "next_id": self._next_id,
            "zones": self.zones.save(),
            "lasting": [
                [list(_condition(one)), one.alarm_id, one.begin_s, one.acknowledged]
                for one in lasting
            ],
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Continue with zones that were saved; what lasted begins again with its number."""
        self._next_id = int(state["next_id"])
        self.zones.restore(state["zones"])
        self._saved = {
            (kind, tuple(tracks), zone_id, source): (int(alarm_id), float(begin_s), bool(known))
            for (kind, tracks, zone_id, source), alarm_id, begin_s, known in state.get(
                "lasting", ()
            )
        }

    def forget(self, track_id: int) -> None:
        """The operator drops this track: its end is no lost target."""
        self._dropped.add(track_id)

    def acknowledge(self, alarm_id: int | str) -> bool:
        """Mark an alarm, or "all", as known; False if none lasts that has this number."""
        return self._each(alarm_id, self._acknowledge)

    def silence(self, alarm_id: int | str) -> bool:
        """Stop the sound of an alarm, or of "all", for a time; the same."""
        return self._each(alarm_id, self._silence)

    def _each(self, alarm_id: int | str, do: Any) -> bool:
        if alarm_id != "all" and (isinstance(alarm_id, bool) or not isinstance(alarm_id, int)):
            raise ValueError(f'alarm_id must be a number or "all", got {quoted(alarm_id)}')
        chosen = list(self._active) if alarm_id == "all" else [alarm_id]
        found = [self._active[number] for number in chosen if number in self._active]
        for alarm in found:
            do(alarm)
        return alarm_id == "all" or bool(found)

    def _acknowledge(self, alarm: Alarm) -> None:
        if alarm.acknowledged:
            return
        alarm.acknowledged = True
        self._change("acknowledged", alarm)
        for number, one in self._encounters.items():
            if one is alarm:
                self._watch.acknowledge(number)
        self._end_momentary("acknowledged", lambda one: one is alarm)

    def _silence(self, alarm: Alarm) -> None:
        if not alarm.acknowledged:
            alarm.silent_until_s = self.time_s + self.config.silence_s
            self._change("silenced", alarm)

    # What there is --------------------------------------------------------------------------------

    @property
    def active(self) -> list[Alarm]:
        """The alarms that last, in order of beginning."""
        return list(self._active.values())

    @property
    def ended(self) -> list[Alarm]:
        """The last 200 alarms that have ended."""
        return list(self._ended)

    def list(self, ended: int = 10) -> list[dict[str, Any]]:
        """The alarms that last, and as many of the latest that have ended, for JSON."""
        return [alarm.as_dict(self.time_s) for alarm in self._active.values()] + [
            alarm.as_dict(self.time_s) for alarm in list(self._ended)[::-1][:ended]
        ]

    @property
    def in_danger(self) -> set[int]:
        """The tracks of all alarms of close passings."""
        return {track for alarm in self._encounters.values() for track in alarm.tracks}

    def encounters(self) -> list[dict[str, Any]]:
        """Every close passing that is a danger now, for JSON: values and the two closest places."""
        return [
            dict(zip(_DANGER, row, strict=True))
            for dangerous, *row in _rows(self._dangers, "dangerous", *_DANGER)
            if dangerous
        ]

    def _called(self, track_id: int) -> str:
        was = self._tracks.get(track_id)
        return _called(track_id, was.name if was else "")

    # Beginning and end ----------------------------------------------------------------------------

    def _begin(
        self,
        kind: str,
        text: str,
        tracks: tuple[int, ...] = (),
        **values: Any,
    ) -> Alarm:
        priority = _PRIORITIES.get(kind, "warning")
        if kind == "cpa" and OWN_SHIP not in tracks:
            priority = "warning"
        now_s = self.time_s
        alarm = Alarm(self._next_id, kind, priority, text, now_s, now_s, tracks, **values)
        saved = self._saved.pop(_condition(alarm), None)
        if saved is None:
            self._next_id += 1
        else:
            alarm.alarm_id, alarm.begin_s, alarm.acknowledged = saved
        self._active[alarm.alarm_id] = alarm
        self._change("began", alarm)
        return alarm

    def _of_zone(
        self,
        begin: Callable[..., Alarm],
        kind: str,
        track_id: int,
        zone: Zone,
        before: str,
        after: str = "",
    ) -> Alarm:
        """Begin an alarm whose text has the name of a zone between two others."""
        text = f"{before}{zone.name}{after}"
        alarm = begin(kind, text, (track_id,), zone_id=zone.zone_id)
        self._around[alarm.alarm_id] = before, after
        return alarm

    def _happen(self, kind: str, text: str, tracks: tuple[int, ...], zone_id: int = 0) -> Alarm:
        alike = [one for one in self._momentary if one.kind == kind]
        if len(alike) >= _MOST_TARGET_ALARMS:
            self._end(alike[0], "too many")
            self._momentary.remove(alike[0])
        alarm = self._begin(kind, text, tracks, zone_id=zone_id)
        self._momentary.append(alarm)
        return alarm

    def _end_momentary(self, reason: str, over: Callable[[Alarm], bool]) -> None:
        for one in [one for one in self._momentary if over(one)]:
            self._end(one, reason)
            self._momentary.remove(one)

    def _end(self, alarm: Alarm, reason: str) -> None:
        alarm.end_s, alarm.reason = self.time_s, reason
        del self._active[alarm.alarm_id]
        self._around.pop(alarm.alarm_id, None)
        self._ended.append(alarm)
        self._change("ended", alarm)

    def _change(self, change: str, alarm: Alarm) -> None:
        self._changes.append(AlarmEvent(self.time_s, change, replace(alarm)))


def notification(radar: str, alarm: Mapping[str, Any]) -> tuple[str, dict[str, Any] | None]:
    """Path and value of the Signal K notification of an alarm of a list; None once it has ended."""
    words = alarm["kind"].split()
    name = words[0] + "".join(word.capitalize() for word in words[1:])
    where = f"guardZone.{alarm['zone_id']}." if alarm["zone_id"] else ""
    path = f"notifications.radar.{radar}.{where}{name}.{alarm['alarm_id']}"
    if alarm["state"] == "ended":
        return path, None
    state = {"alarm": "alarm", "warning": "warn", "caution": "alert"}[alarm["priority"]]
    method = ["visual", "sound"] if alarm["sounds"] else ["visual"]
    return path, {"state": state, "method": method, "message": alarm["text"]}


class AlarmLog:
    """Writes every change of an alarm as a line of ``alarms.csv``, at once.

    Parameters
    ----------
    path : str or Path
        Lines are appended to a file that exists.

    Attributes
    ----------
    problem : str
        Why the last lines were not written, as where the disk is full; else empty.
    """

    COLUMNS = (
        *("time_s", "utc", "alarm_id", "change", "kind", "priority", "tracks", "zone_id"),
        *("source", "cpa_m", "tcpa_s", "probability", "reason", "text"),
    )

    def __init__(self, path: str | Path) -> None:
        self._path, self.problem = Path(path), ""
        self._file: io.FileIO = self._path.open("ab", buffering=0)
        if self._file.tell() == 0:
            append_whole(self._file, _csv([self.COLUMNS]))

    def write(self, events: Iterable[AlarmEvent]) -> None:
        """Append events, or take note of why they cannot be."""
        rows = []
        for time_s, change, alarm in events:
            row = [getattr(alarm, name, "") for name in self.COLUMNS]
            values = dict(zip(self.COLUMNS, row, strict=True))
            values |= {"time_s": f"{time_s:.3f}", "utc": _utc(time_s), "change": change}
            values["tracks"] = " ".join("own" if t == OWN_SHIP else str(t) for t in alarm.tracks)
            for name, form in (("cpa_m", ".1f"), ("tcpa_s", ".1f"), ("probability", ".3f")):
                values[name] = "" if _unknown(values[name]) else format(values[name], form)
            rows.append(values.values())
        if not rows:
            return
        try:
            append_whole(self._file, _csv(rows))
            self.problem = ""
        except OSError as error:
            self.problem = f"{self._path}: {in_words(error)}"

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _csv(rows: Iterable[Iterable[Any]]) -> bytes:
    text = io.StringIO(newline="")
    csv.writer(text).writerows(rows)
    return text.getvalue().encode()


def _rows(table: Any, *names: str) -> Iterable[tuple]:
    return zip(*(np.asarray(getattr(table, name)).tolist() for name in names), strict=True)


def _condition(alarm: Alarm) -> tuple[str, tuple[int, ...], int, str]:
    """What an alarm is about."""
    return alarm.kind, alarm.tracks, alarm.zone_id, alarm.source


def _called(track_id: int, name: str) -> str:
    return f"{name} ({track_id})" if name else f"target {track_id}"


def _utc(time_s: float) -> str:
    if not 1e8 < time_s < 1e10:  # a recording whose times are not UTC
        return ""
    when = datetime.fromtimestamp(time_s, timezone.utc)
    return when.isoformat(timespec="milliseconds").replace("+00:00", "Z")


def _unknown(value: Any) -> bool:
    return isinstance(value, float) and not math.isfinite(value)


def _largest_variance(covariance: np.ndarray) -> np.ndarray:
    """Of the position, over all directions."""
    xx, xy, yy = covariance[:, 0, 0], covariance[:, 0, 2], covariance[:, 2, 2]
    return np.maximum((xx + yy) / 2 + np.hypot((xx - yy) / 2, xy), 0.0)
