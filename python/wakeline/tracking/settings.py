"""Settings of tracking: radar, tracker, motion models and danger limits, in Python and as TOML.

Settings are kept as a file holds them, with angles of the radar in degrees, so that writing and
reading them again changes nothing.
"""

from __future__ import annotations

import json
import math
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

import wakeline as wl
from wakeline._brief import cut, quoted, with_short_quotes
from wakeline.recording import load_radar, radar_names

from .encounters import DangerLimits, DangerZone

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

Value = float | int | str


class SettingsError(ValueError):
    """Settings cannot be used; the message names file and key."""


_CLASSES = {
    "radar": wl.Radar,
    "tracker": wl.TrackerConfig,
    "models": wl.VesselModels,
    "strobes": wl.StrobeTrackerConfig,
    "danger": DangerLimits,
}
_PERIOD = (
    "Time of an antenna revolution, which groups plots without a scan number; 0: estimated. [s]"
)


def _engine_name(key: str) -> str:
    return f"{key[:-4]}_rad" if key.endswith("_deg") else key


def _in_degrees(text: str) -> str:
    """Names and numbers of angles in a rule or a message, which are in radians."""

    def degrees(found: re.Match[str]) -> str:
        return f"{math.degrees(math.pi if found[0] == 'pi' else float(found[0])):.4g}"

    text = re.sub(r"(\w)_rad\b", r"\1_deg", text.replace(", in radians", ""))
    return re.sub(r"-?\b\d[\d.]*(?:e[+-]?\d+)?\b|\bpi\b", degrees, text)


def _explained(section: str) -> dict[str, str]:
    """The sentence of each key of a section, with its unit and rule, from the field tables."""
    lines = {}
    for name, _, _, unit, rule, sentence in _CLASSES[section].fields():
        key, unit = name, unit if unit != "1" else ""
        if name.endswith("_rad"):
            key, unit, rule = f"{name[:-4]}_deg", "degrees", _in_degrees(rule)
            sentence = _in_degrees(sentence)
        lines[key] = f"{sentence} [{'; '.join(filter(None, (unit, rule)))}]"
    return lines | {"period_s": _PERIOD} if section == "radar" else lines


KEYS = {section: _explained(section) for section in _CLASSES}

VESSELS = {"any": wl.VesselModels, "ships": wl.VesselModels.ships}
"""Motion models by the vessels they are for."""
_ABOUT = {
    "radar": "Parameters of the radar.",
    "tracker": "Parameters of the tracker; one set of defaults for all radars.",
    "models": "Motion models; course noise grows with the speed.",
    "strobes": "Parameters of --method strobe; default radii and least amplitude are estimated.",
    "danger": "Limits of a dangerous approach of two vessels, own ship (--own) or tracks.",
}
_ZONES = """\
# Areas with separate limits: each a section [[zone]] with a name, outline_m, the
# corners [north, east] of a polygon, and any keys of [danger].
"""
_MANY = 2**31
_MOST_OCTETS = 2**20
_TRACKER_OCTETS = 6600, 65  # of a track, and of a plot of a scan
_STROBE_OCTETS = 21900  # of a track
_MUCH_OCTETS = 100e6
_PART = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*"""
_DEEP_KEY = re.compile(rf"(?<![\w-])(?:{_PART}){{20,}}")  # costs its square
_WHAT = {float: "a number", int: "a whole number", str: "a text"}


@dataclass(frozen=True)
class Settings:
    """All settings, by section and key as in a file.

    Attributes
    ----------
    radar, tracker, models, strobes, danger : dict of str to float, int or str
        Complete; the keys are those of `KEYS`.
    zones : tuple of dict
        Areas with separate limits of danger: ``name``, ``outline_m`` and any keys of `danger`.
    """

    radar: dict[str, Value]
    tracker: dict[str, Value]
    models: dict[str, Value]
    strobes: dict[str, Value]
    danger: dict[str, Value]
    zones: tuple[dict[str, Any], ...] = ()

    @classmethod
    def default(cls) -> Settings:
        """The engine's settings, with the period of the recording."""
        return cls(**{section: _defaults(section) for section in KEYS})

    @classmethod
    def of(
        cls, document: Mapping[str, Any], path: str | Path, beside: Iterable[str] = ()
    ) -> Settings:
        """The defaults, changed by the sections of a document.

        In messages `path` is its name, and `beside` are sections that are read elsewhere.
        """
        settings = cls.default()
        for section, values in document.items():
            if section == "zone":
                settings = replace(settings, zones=_read_zones(values, path))
                continue
            if section not in KEYS:
                known = _one_of(dict.fromkeys((*beside, *KEYS, "zone")))
                raise SettingsError(f"{path}: unknown section {cut(section)}; {known}")
            settings = _changed(settings, section, values, path)
        _check_zones(settings, path)
        return settings

    @property
    def period_s(self) -> float | None:
        """Period of the antenna, None if the recording gives it."""
        return float(self.radar["period_s"]) or None

    @property
    def vessels(self) -> str:
        """Which of `VESSELS` the models are for."""
        for name, models in VESSELS.items():
            if self.models == models().as_dict():
                return name
        return "as configured"

    def make_tracker(self, period_s: float | None = None) -> wl.Tracker:
        """A new tracker; `period_s` is that of the antenna if the settings do not give it."""
        return self.tracker_of(self.make_radar(period_s))

    def tracker_of(self, radar: wl.Radar | Sequence[wl.Radar]) -> wl.Tracker:
        """A new tracker for other radars."""
        return wl.Tracker(radar, _engine("tracker", self.tracker), _engine("models", self.models))

    def make_estimator(self, radar: wl.Radar) -> wl.Imm:
        """A new estimator as the tracker has one for each track."""
        return wl.vessel_imm(radar, _engine("models", self.models))

    def window_of(self, radar: wl.Radar | Sequence[wl.Radar], **room: float) -> wl.LateWindow:
        """A new tracker of data that may come late; `room` as of :class:`wakeline.LateWindow`."""
        config, models = _engine("tracker", self.tracker), _engine("models", self.models)
        return wl.LateWindow(radar, config, models, **room)

    def make_strobe_tracker(
        self, period_s: float, bits: int = 8, **estimated: float
    ) -> wl.StrobeTracker:
        """A new tracker on radar video; estimated parameters replace those by default."""
        default = _defaults("strobes")
        open_ones = {k: v for k, v in estimated.items() if self.strobes[k] == default[k]}
        if "radius_m" not in open_ones:
            open_ones.pop("max_radius_m", None)
        radar = self.make_radar(period_s)
        return wl.StrobeTracker(
            radar,
            _engine("strobes", self.strobes | open_ones),
            self.make_estimator(radar),
            bits=bits,
        )

    def memory_octets(self, method: str = "plots", bits: int = 8) -> int:
        """About the octets of a tracker by its room; `method` as on the command line."""
        if method == "plots":
            room = self.tracker["max_tracks"], self.tracker["max_plots"]
            return round(sum(np.multiply(room, _TRACKER_OCTETS)))
        picture = self.strobes["max_sweep_cells"] * self.strobes["max_strobe_sweeps"]
        return round(self.strobes["max_tracks"] * _STROBE_OCTETS + picture * bits / 8)

    def memory_notes(self, method: str = "plots") -> list[str]:
        """A note on the memory of a tracker if it takes much."""
        octets = self.memory_octets(method)
        if octets < _MUCH_OCTETS:
            return []
        section, names = {
            "plots": ("tracker", ("max_tracks", "max_plots")),
            "strobe": ("strobes", ("max_tracks", "max_sweep_cells", "max_strobe_sweeps")),
        }[method]
        room = ", ".join(f"{name} = {getattr(self, section)[name]}" for name in names)
        return [f"a tracker with {room} takes about {octets / 1e6:.0f} MB of memory"]

    def make_radar(self, period_s: float | None = None) -> wl.Radar:
        """The radar; `period_s` is that of the antenna if the settings do not give it."""
        return _engine("radar", self.radar | {"period_s": self.period_s or period_s or 0.0})

    def knowing(self, radar: Mapping[str, Value]) -> Settings:
        """These settings with the radar parameters of a recording.

        If any of the radar parameters differs from its default, the settings are unchanged.
        """
        default = _defaults("radar")
        if any(self.radar[key] != default[key] for key in radar):
            return self
        return replace(self, radar=self.radar | dict(radar))

    @property
    def danger_limits(self) -> DangerLimits:
        """Limits of danger."""
        return _engine("danger", self.danger)

    @property
    def danger_zones(self) -> list[DangerZone]:
        """Areas with separate limits of danger."""
        return [_zone(self.danger, **zone) for zone in self.zones]

    def calibrated(self, result: wl.track.CalibrationResult) -> Settings:
        """These settings with the offsets of the radar that a calibration determined."""
        radar = _as_in_file("radar", result.applied_to(self.make_radar()))
        return replace(self, radar=radar | {"period_s": self.radar["period_s"]})

    def radar_toml(self) -> str:
        """The section ``[radar]`` of :meth:`toml`."""
        return "\n".join(self._section("radar"))

    def toml_of_radar(self, given: Mapping[str, Value]) -> Iterator[str]:
        """The lines of a section ``[[radar]]``; those that are not given are comments."""
        for key, sentence in KEYS["radar"].items():
            mark = "" if key in given else "# "
            yield f"# {sentence}"
            yield f"{mark}{key} = {json.dumps(given.get(key, self.radar[key]))}"

    def toml(self) -> str:
        """Every setting with a line of explanation; reading it gives the same settings."""
        sections = "\n".join(line for section in KEYS for line in self._section(section))
        return f"{sections}\n{_ZONES}{''.join(map(_zone_text, self.zones))}"

    def _section(self, section: str) -> Iterator[str]:
        yield f"# {_ABOUT[section]}"
        yield f"[{section}]"
        for key, value in getattr(self, section).items():
            yield f"# {KEYS[section][key]}"
            yield f"{key} = {json.dumps(value)}"
        yield ""


def read_settings(
    config: Settings | wl.TrackerConfig | str | Path | None = None,
    radar: wl.Radar | str | Path | None = None,
    vessels: wl.VesselModels | str | None = None,
) -> Settings:
    """The defaults, changed by a configuration and then by radar and vessels.

    Parameters
    ----------
    config : Settings, TrackerConfig, str or Path, optional
        All settings, parameters of the tracker, or a TOML file with any of the sections and keys
        that :meth:`Settings.toml` writes.
    radar : Radar, str or Path, optional
        Radar parameters, the name of a bundled radar, or a TOML file with keys of ``[radar]``.
    vessels : VesselModels or str, optional
        Motion models, or a name of `VESSELS`. They replace those of `config`.

    Raises
    ------
    SettingsError
        When a file cannot be read, a key or name is unknown, or a value is out of range.
    """
    settings = config if isinstance(config, Settings) else Settings.default()
    if isinstance(config, wl.TrackerConfig):
        settings = replace(settings, tracker=config.as_dict())
    elif config is not None and not isinstance(config, Settings):
        settings = Settings.of(read_toml(Path(config)), config)
    if isinstance(radar, wl.Radar):
        settings = replace(settings, radar=_as_in_file("radar", radar))
    elif radar is not None:
        settings = _changed(settings, "radar", _read_radar(radar), radar)
    if isinstance(vessels, wl.VesselModels):
        settings = replace(settings, models=vessels.as_dict())
    elif vessels is not None:
        if vessels not in VESSELS:
            raise SettingsError(f"vessels must be {' or '.join(VESSELS)}, got {quoted(vessels)}")
        settings = replace(settings, models=VESSELS[vessels]().as_dict())
    return settings


def _read_radar(name: str | Path) -> Any:
    """Values of ``[radar]`` by the name of a radar or from a file, with or without the heading."""
    if name in radar_names():
        return load_radar(str(name))
    path = Path(name)
    if not path.exists():
        raise SettingsError(
            f"radar must be a file or one of {', '.join(radar_names())}, got {quoted(str(name))}"
        )
    document = read_toml(path)
    if list(document) == ["radar"]:
        return document["radar"]
    sections = [key for key, value in document.items() if isinstance(value, dict)]
    if sections:
        raise SettingsError(
            f"{path}: a radar file must have only keys of [radar], got {cut(', '.join(sections))}; "
            "use --config for settings of several sections"
        )
    return document


def _changed(settings: Settings, section: str, values: Any, path: str | Path) -> Settings:
    """The settings with some of one section's replaced."""
    if not isinstance(values, dict):
        raise SettingsError(f"{path}: {section} must be a section with keys")
    before = getattr(settings, section)
    for key, value in values.items():
        if key not in before:
            unknown = f"unknown key {cut(key)} in [{section}]"
            raise SettingsError(f"{path}: {unknown}; {_one_of(before)}")
        _check_type(path, f"[{section}] {key}", value, type(before[key]))
    after = before | {k: float(v) if type(before[k]) is float else v for k, v in values.items()}
    _check_values(path, section, before, after)
    return replace(settings, **{section: after})


def _read_zones(zones: Any, path: str | Path) -> tuple[dict[str, Any], ...]:
    """Zones with keys that are known, and values of their types."""
    if not isinstance(zones, list) or not all(isinstance(zone, dict) for zone in zones):
        raise SettingsError(f"{path}: zones must be sections [[zone]]")
    for place, zone in _places(zones):
        for key, value in zone.items():
            if key not in ("name", "outline_m", *KEYS["danger"]):
                known = _one_of(("name", "outline_m", *KEYS["danger"]))
                raise SettingsError(f"{path}: unknown key {cut(key)} in {place}; {known}")
            if key != "outline_m":
                _check_type(path, f"{place} {key}", value, str if key == "name" else float)
        for key in ("name", "outline_m"):
            if key not in zone:
                raise SettingsError(f"{path}: {place} needs {key}")
    return tuple(zones)


def _check_zones(settings: Settings, path: str | Path) -> None:
    """Raise SettingsError naming the zone that the engine rejects, if there is one."""
    for place, zone in _places(settings.zones):
        try:
            _zone(settings.danger, **zone)
        except (ValueError, TypeError) as error:
            raise SettingsError(f"{path}: {place}: {with_short_quotes(str(error))}") from None


def _places(zones: Sequence[dict[str, Any]]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Each zone, and what messages call it."""
    for k, zone in enumerate(zones, 1):
        yield f"[[zone]] {k}", zone


def _zone(danger: dict[str, Value], name: str, outline_m: Any, **limits: float) -> DangerZone:
    """The engine's zone; what it does not limit is limited as everywhere."""
    return DangerZone(name, outline_m, _engine("danger", danger | limits))


def _zone_text(zone: dict[str, Any]) -> str:
    return "\n[[zone]]\n" + "".join(f"{key} = {json.dumps(value)}\n" for key, value in zone.items())


def _check_type(path: str | Path, place: str, value: Any, wanted: type) -> None:
    good = (int, float) if wanted is float else wanted
    if isinstance(value, bool) or not isinstance(value, good):
        raise SettingsError(f"{path}: {place} must be {_WHAT[wanted]}, got {quoted(value)}")
    below = _MANY if wanted is int else sys.float_info.max
    if isinstance(value, int) and not abs(value) < below:
        raise SettingsError(f"{path}: {place} must be below {below}, got {quoted(value)}")


def _check_values(
    path: str | Path, section: str, before: dict[str, Value], after: dict[str, Value]
) -> None:
    """Raise SettingsError naming the key that the engine rejects, if there is one."""
    try:
        _engine(section, after)
    except ValueError as error:
        reason = with_short_quotes(str(error))
        for key, value in after.items():
            if value != before[key] and reason.startswith(f"{_engine_name(key)} "):
                place = f"{path}: [{section}] {key}"
                reason = _in_degrees(reason) if key.endswith("_deg") else reason
                raise SettingsError(f"{place} = {quoted(value)}: {reason}") from None
        raise SettingsError(f"{path}: [{section}]: {reason}") from None


def _engine(section: str, values: dict[str, Value]) -> Any:
    """The engine's object of a section; a period of 0 is the engine's default."""
    given = {_engine_name(key): _to_engine(key, value) for key, value in values.items()}
    if section == "radar" and given["period_s"] == 0:
        del given["period_s"]
    return _CLASSES[section](**given)


def _to_engine(key: str, value: Value) -> Value:
    return math.radians(value) if key.endswith("_deg") else value


def _defaults(section: str) -> dict[str, Value]:
    values = _as_in_file(section, _CLASSES[section]())
    return values | {"period_s": 0.0} if section == "radar" else values


def _as_in_file(section: str, parameters: Any) -> dict[str, Value]:
    """Parameters by the keys of a section; angles to 12 digits, so that 0.3 degrees are 0.3."""
    engine, values = parameters.as_dict(), {}
    for key in KEYS[section]:
        value = engine[_engine_name(key)]
        values[key] = float(f"{math.degrees(value):.12g}") if key.endswith("_deg") else value
    return values


def read_toml(path: Path) -> dict[str, Any]:
    """A TOML file of at most a megabyte as a dict; SettingsError if it cannot be read as such."""
    with path.open("rb") as file:  # which may be a pipe, or a device without end
        octets = file.read(_MOST_OCTETS + 1)
    if len(octets) > _MOST_OCTETS:
        raise SettingsError(f"{path}: too long for settings; wanted at most {_MOST_OCTETS} octets")
    try:
        text = octets.decode("utf-8-sig")
        deep = _DEEP_KEY.search(text)
        if deep:
            raise SettingsError(f"{path}: a key has too many parts: {cut(deep[0])}")
        return tomllib.loads(text.replace("\r\n", "\n").replace("\r", "\n"))
    except UnicodeDecodeError:
        raise SettingsError(f"{path}: not text in UTF-8") from None
    except SettingsError:
        raise
    except ValueError as error:  # TOMLDecodeError, and integers of thousands of digits
        raise SettingsError(f"{path}: not TOML: {_in_short(str(error))}") from None
    except RecursionError:
        raise SettingsError(f"{path}: not TOML: nested too deep") from None


def _in_short(error: str) -> str:
    """The message of a parser with at most 80 characters before the place."""
    end = error.rfind(" (at ")
    return f"{cut(error[:end])}{error[end:]}" if end > 0 else cut(error)


def _one_of(names: Iterable[str]) -> str:
    return f"known: {', '.join(names)}"
