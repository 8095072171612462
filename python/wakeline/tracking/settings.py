"""Settings of tracking: radar, tracker, motion models and danger limits, in Python and as TOML.

Settings are kept as a file holds them, with angles of the radar in degrees, so that writing and
reading them again changes nothing.
"""

from __future__ import annotations

import json
import math
import reprlib
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import wakeline as wl
from wakeline.recording import load_radar, radar_names

from .alarms import DangerLimits

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

Value = float | int | str


class SettingsError(ValueError):
    """Settings cannot be used; the message names file and key."""


_RADAR = {
    "range_std_m": "m, standard deviation of the range of a plot",
    "bearing_std_deg": "degrees, standard deviation of its bearing",
    "extent_std_m": "m per axis, wander of an echo over the hull of its vessel",
    "period_s": "s, one turn of the antenna, which groups plots without a scan number; 0: found",
    "max_speed_mps": "m/s, of the vessels, with a fifth to spare",
    "bearing_offset_deg": "degrees, bearing read minus true bearing; taken off every plot",
}

_TRACKER = {
    "detection_probability": "0..1, chance that a target which is visible gives a plot in a scan",
    "gate_probability": "0..1, chance that the plot of a target lies in its gate",
    "clutter_density_per_m2": "1/m² and scan, false plots where the clutter map knows of none",
    "outlier_probability": "0..1, share of plots with a wild error",
    "outlier_scale": "how many times larger that error is",
    "clutter_cell_m": "m, cell of the clutter map; 0: no map",
    "clutter_memory_s": "s, fading memory of the clutter map",
    "clutter_weight": "how far the clutter map is believed; 1: fully",
    "visible_time_s": "s, mean time until a target is hidden from the radar; 0: never",
    "hidden_time_s": "s, mean time until a hidden target is seen again",
    "association": "how plots are given to tracks: probabilistic, global_nearest or nearest",
    "initial_existence": "0..1, chance that a new pair of plots is a target",
    "free_plot": "0..1, a plot may start a track when it is no other track's with this chance",
    "start_gate_sigma": "plot errors by which the speed limit of a start is widened",
    "start_speed_factor": "expected speed of a start over the radar's speed limit; 0: anything",
    "confirm_existence": "0..1, a track is confirmed above this probability of existence",
    "confirm_hits": "plots, and with at least so many of them",
    "confirm_window": "scans, in so many of its last ones",
    "survival_time_s": "s, mean time until a target leaves",
    "drop_existence": "0..1, a tentative track is dropped below this probability of existence",
    "tentative_misses": "scans, a tentative track is dropped after more of them without a plot",
    "coast_scans": "scans, a confirmed track is dropped after more of them without a plot,",
    "coast_scans_per_hit": "scans, with so many more for each plot that it ever had,",
    "coast_scans_max": "scans, but after this many at the latest",
    "shown_scans": "scans, a coasting track is shown for so many, then only held in mind",
    "drop_position_std_m": "m, a track that knows its place worse than this is dropped",
    "drop_speed_factor": "a track faster than this times the radar's speed limit is dropped",
    "duplicate_distance": "squared sigmas, two tracks nearer than this are one",
    "vessel_length_m": "m, an echo nearer to a shown track is of its vessel; 0: of another one",
    "duplicate_scans": "scans, once they have been so for so many",
    "max_tracks": "tracks at a time; when full a new one replaces the weakest tentative one",
    "max_plots": "plots of a scan; those beyond are refused",
}

_MODELS = {
    "cruising_psd_m2s3": "m²/s³, acceleration noise of a cruising vessel at rest",
    "cruising_course_psd_rad2s": "rad²/s, wander of the course of a cruising vessel",
    "steady_psd_m2s3": "m²/s³, acceleration noise of a steady vessel at rest",
    "steady_course_psd_rad2s": "rad²/s, wander of the course of a steady vessel",
    "restless_psd_m2s3": "m²/s³, acceleration noise of a restless vessel at rest",
    "restless_course_psd_rad2s": "rad²/s, wander of the course of a restless vessel",
    "turning_psd_m2s3": "m²/s³, acceleration noise of a turning vessel at rest",
    "turning_course_psd_rad2s": "rad²/s, wander of the course of a turning vessel",
    "turn_rate_psd_rad2s3": "rad²/s³, wander of the rate of turn",
    "prior_turn_rate_std_rad_s": "rad/s, rate of turn before it is known",
    "cruising_probability": "of a vessel that is seen for the first time",
    "cruising_sojourn_s": "s, mean time until a cruising vessel does something else",
    "settling_s": "s, mean time until a steady vessel is taken to cruise",
    "steady_sojourn_s": "s, mean time until a steady vessel becomes restless or turns",
    "restless_sojourn_s": "s, mean time for which it is restless",
    "turning_sojourn_s": "s, mean time for which it turns",
}

_DANGER = {
    "cpa_limit_m": "m, closer than this a track is dangerous; half a nautical mile",
    "tcpa_limit_s": "s, when it comes so close within this time",
    "alarm_probability": "0..1, with this probability or more, an alarm begins,",
    "clear_probability": "0..1, and it ends where the probability falls below this one",
    "clear_hold_s": "s, for so long; shorter falls belong to the same alarm",
    "own_velocity_std_mps": "m/s per axis, error of own ship's velocity where --own has none",
}

KEYS = {"radar": _RADAR, "tracker": _TRACKER, "models": _MODELS, "danger": _DANGER}

_CLASSES = {
    "radar": wl.Radar,
    "tracker": wl.TrackerConfig,
    "models": wl.VesselModels,
    "danger": DangerLimits,
}
VESSELS = {"any": wl.VesselModels, "ships": wl.VesselModels.ships}
_ABOUT = {
    "radar": "What a console knows of its radar, as its plots come.",
    "tracker": "How tracks live; one set of defaults for all radars.",
    "models": "How vessels move; the noise of the course matters more the faster they are.",
    "danger": "When a track is dangerous to own ship, whose motion --own tells.",
}
_MANY = 2**31
_WHAT = {float: "a number", int: "a whole number", str: "a text"}


@dataclass(frozen=True)
class Settings:
    """All settings, by section and key as in a file.

    Attributes
    ----------
    radar, tracker, models, danger : dict of str to float, int or str
        Complete; the keys are those of `KEYS`.
    """

    radar: dict[str, Value]
    tracker: dict[str, Value]
    models: dict[str, Value]
    danger: dict[str, Value]

    @classmethod
    def default(cls) -> Settings:
        """The engine's settings, with the period of the recording."""
        return cls(**{section: _defaults(section) for section in KEYS})

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
        radar = dict(self.radar)
        radar["period_s"] = self.period_s or period_s or 0.0
        return wl.Tracker(
            _engine("radar", radar),
            _engine("tracker", self.tracker),
            _engine("models", self.models),
        )

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

    def toml(self) -> str:
        """Every setting with a line of explanation; reading it gives the same settings."""
        return "\n".join(line for section in KEYS for line in self._section(section))

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
        for section, values in _read_toml(Path(config)).items():
            if section not in KEYS:
                raise SettingsError(f"{config}: unknown section {section}; {_one_of(KEYS)}")
            settings = _changed(settings, section, values, config)
    if isinstance(radar, wl.Radar):
        settings = replace(settings, radar=_as_in_file("radar", radar))
    elif radar is not None:
        settings = _changed(settings, "radar", _read_radar(radar), radar)
    if isinstance(vessels, wl.VesselModels):
        settings = replace(settings, models=vessels.as_dict())
    elif vessels is not None:
        if vessels not in VESSELS:
            raise SettingsError(f"vessels must be {' or '.join(VESSELS)}, got {vessels!r}")
        settings = replace(settings, models=VESSELS[vessels]().as_dict())
    return settings


def _read_radar(name: str | Path) -> Any:
    """Values of ``[radar]`` by the name of a radar or from a file, with or without the heading."""
    if name in radar_names():
        return load_radar(str(name))
    path = Path(name)
    if not path.exists():
        raise SettingsError(
            f"radar must be a file or one of {', '.join(radar_names())}, got {str(name)!r}"
        )
    document = _read_toml(path)
    if list(document) == ["radar"]:
        return document["radar"]
    sections = [key for key, value in document.items() if isinstance(value, dict)]
    if sections:
        raise SettingsError(
            f"{path}: a radar file must have only keys of [radar], got {', '.join(sections)}; "
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
            raise SettingsError(f"{path}: unknown key {key} in [{section}]; {_one_of(before)}")
        _check_type(path, f"[{section}] {key}", value, type(before[key]))
    after = before | {k: float(v) if type(before[k]) is float else v for k, v in values.items()}
    _check_values(path, section, before, after)
    return replace(settings, **{section: after})


def _check_type(path: str | Path, place: str, value: Any, wanted: type) -> None:
    good = (int, float) if wanted is float else wanted
    if isinstance(value, bool) or not isinstance(value, good):
        raise SettingsError(f"{path}: {place} must be {_WHAT[wanted]}, got {reprlib.repr(value)}")
    below = _MANY if wanted is int else sys.float_info.max
    if isinstance(value, int) and not abs(value) < below:
        raise SettingsError(f"{path}: {place} must be below {below}, got {value}")


def _check_values(
    path: str | Path, section: str, before: dict[str, Value], after: dict[str, Value]
) -> None:
    """Raise SettingsError naming the key that the engine rejects, if there is one."""
    try:
        _check_engine(section, after)
    except ValueError as error:
        for key, value in after.items():
            if value != before[key] and str(error).startswith(f"{_engine_name(key)} "):
                raise SettingsError(f"{path}: [{section}] {key} = {value!r}: {error}") from None
        raise SettingsError(f"{path}: [{section}]: {error}") from None


def _check_engine(section: str, values: dict[str, Value]) -> None:
    for key, value in values.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise ValueError(f"{_engine_name(key)} must be finite, got {value}")
        if section == "models" and key != "cruising_probability" and not value > 0:
            raise ValueError(f"{key} must be positive, got {value}")
    if section == "radar" and values["period_s"] < 0:
        raise ValueError(f"period_s must not be negative, got {values['period_s']}")
    _engine(section, values)


def _engine(section: str, values: dict[str, Value]) -> Any:
    """The engine's object of a section; a period of 0 is the engine's default."""
    given = {_engine_name(key): _to_engine(key, value) for key, value in values.items()}
    if section == "radar" and given["period_s"] == 0:
        del given["period_s"]
    return _CLASSES[section](**given)


def _engine_name(key: str) -> str:
    return f"{key[:-4]}_rad" if key.endswith("_deg") else key


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


def _read_toml(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except UnicodeDecodeError:
        raise SettingsError(f"{path}: not text in UTF-8") from None
    except ValueError as error:  # TOMLDecodeError, and integers of thousands of digits
        raise SettingsError(f"{path}: not TOML: {error}") from None
    except RecursionError:
        raise SettingsError(f"{path}: not TOML: nested too deep") from None


def _one_of(names: Iterable[str]) -> str:
    return f"known: {', '.join(names)}"
