"""A search scenario from a TOML file."""

from __future__ import annotations

import datetime
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from wakeline import LocalPlane, navigation
from wakeline._brief import cut, quoted
from wakeline.recording.table import Table
from wakeline.tracking.settings import SettingsError, read_toml

from .drift import Cloud, SearchObject, drift, on_land
from .environment import Environment, Flow, Tide
from .patterns import PATTERNS
from .plan import DETECTION_LAWS, Track, Unit

_S_PER_H = 3600.0
_MPS_PER_KN = 1852.0 / 3600.0
_LONGEST_H = 240.0
_FASTEST_MPS = 100.0


@dataclass(frozen=True)
class SearchScenario:
    """All that a search is planned from.

    Attributes
    ----------
    name : str
    plane : LocalPlane
        North and east from the last known position.
    search_object : SearchObject
    environment : Environment
    units : tuple of Unit
    land : tuple of (k, 2) arrays
        Corners [north, east] m.
    patterns : tuple of str
        To choose from.
    law : str
        Of detection, one of `DETECTION_LAWS`.
    searched : tuple of Track
        Of earlier sorties without success.
    time : datetime, optional
        Of the last known position.
    """

    name: str
    plane: LocalPlane
    search_object: SearchObject
    environment: Environment
    units: tuple[Unit, ...]
    land: tuple[np.ndarray, ...] = ()
    patterns: tuple[str, ...] = tuple(PATTERNS)
    law: str = "inverse_cube"
    searched: tuple[Track, ...] = ()
    time: datetime.datetime | None = None

    @property
    def until_s(self) -> float:
        """When the last unit leaves."""
        return max([unit.end_s for unit in self.units] + [one.time_s[-1] for one in self.searched])

    def cloud(self, count: int = 5000, seed: int = 0, step_s: float | None = None) -> Cloud:
        """The drift until the last unit leaves of an object that `searched` missed; see `drift`."""
        step = {} if step_s is None else {"step_s": step_s}
        cloud = drift(
            self.search_object,
            self.environment,
            self.until_s,
            count=count,
            seed=seed,
            land=self.land,
            **step,
        )
        if not self.searched:
            return cloud
        missed = cloud.searched(sum(one.potential(cloud, self.law) for one in self.searched))
        if not missed.weight.any():
            raise ValueError("searched must leave a place where the object can be, got none")
        return replace(missed, weight=missed.weight / missed.weight.sum())

    def degrees(self, position_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Latitudes and longitudes (...) of positions (..., 2)."""
        latitude_rad, longitude_rad = self.plane.place(position_m)
        return np.degrees(latitude_rad), np.degrees(longitude_rad)


def example_names() -> list[str]:
    """Names of the bundled scenarios."""
    files = resources.files(__package__).joinpath("data").iterdir()
    return sorted(file.name[:-5] for file in files if file.name.endswith(".toml"))


def read_scenario(source: str | Path) -> SearchScenario:
    """Read a scenario from a TOML file; cpp/docs/search.md describes its keys.

    Parameters
    ----------
    source : str or Path
        The file, or the name of a bundled scenario.

    Raises
    ------
    SettingsError
        When the file cannot be read, a key is unknown or missing, or a value is out of range.
    RecordingError
        When a file of wind or current cannot be read.
    """
    if source in example_names():
        bundled = resources.files(__package__).joinpath(f"data/{source}.toml")
        with resources.as_file(bundled) as path:
            return _scenario(path)
    if not Path(source).exists():
        known = ", ".join(example_names())
        raise SettingsError(f"scenario must be a file or one of {known}, got {quoted(str(source))}")
    return _scenario(Path(source))


def _scenario(path: Path) -> SearchScenario:
    top = _Section(path, "", read_toml(path))
    found, wind = top.section("object"), top.section("wind")
    latitude_rad = math.radians(found.number("lat_deg", *_LATITUDE))
    longitude_rad = math.radians(found.number("lon_deg", *_LONGITUDE))
    plane = LocalPlane(latitude_rad=latitude_rad, longitude_rad=longitude_rad)
    current = top.section("current", needed=False)
    tides = tuple(_tide(section) for section in top.sections("tide"))
    land = tuple(_land(section, plane) for section in top.sections("land"))
    units = tuple(_unit(section, plane) for section in top.sections("unit"))
    names = [unit.name for unit in units]
    if not units or len(set(names)) < len(names):
        raise top.error("unit", "one or more tables [[unit]] of different names", names)
    search_object = SearchObject(
        kind=found.word("kind", navigation.leeway_kinds()),
        position_std_m=found.number("position_std_m", 0.0, 1e6, default=0.0),
        time_std_s=60.0 * found.number("time_std_min", 0.0, 1e4, default=0.0),
        jibes_per_h=found.number("jibes_per_h", 0.0, 1e3, default=0.04),
        wind_std_mps=wind.number("std_mps", 0.0, _FASTEST_MPS, default=1.5),
        current_std_mps=current.number("std_mps", 0.0, _FASTEST_MPS, default=0.1),
        residual_std_mps=found.number("residual_std_mps", 0.0, _FASTEST_MPS, default=0.05),
        residual_time_s=60.0
        * found.number("residual_time_min", 0.0, 1e5, default=30.0, above=True),
    )
    if on_land(search_object.position_m[None], land)[0]:
        raise SettingsError(
            f"{path}: [object] lat_deg, lon_deg must be at sea, got a place on land"
        )
    wind_current = current.truth("wind_current", default=True)
    if wind_current and abs(latitude_rad) < math.radians(20.0):
        raise SettingsError(
            f"{path}: [current] wind_current must be false less than 20 degrees from the equator, "
            "where (14) does not hold"
        )
    scenario = SearchScenario(
        name=top.text("name", path.stem),
        plane=plane,
        search_object=search_object,
        environment=Environment(
            wind=_flow(wind, "from_deg", plane, path),
            current=_flow(current, "toward_deg", plane, path)
            if current.given("speed_mps", "file")
            else None,
            tides=tides,
            latitude_rad=latitude_rad,
            wind_current=wind_current,
        ),
        units=units,
        land=land,
        patterns=top.words("patterns", PATTERNS),
        law=top.word("detection", DETECTION_LAWS, default="inverse_cube"),
        searched=tuple(
            track for one in top.sections("searched") for track in _tracks(one, plane, path)
        ),
        time=found.time("time"),
    )
    top.close()
    try:
        scenario.environment.require(0.0, scenario.until_s)
    except ValueError as error:
        raise SettingsError(f"{path}: {error}, when the last unit leaves") from None
    return scenario


_LATITUDE = (-90.0, 90.0)
_LONGITUDE = (-360.0, 360.0)
_DIRECTION = (-360.0, 360.0)


def _unit(section: _Section, plane: LocalPlane) -> Unit:
    speed_kn = section.number("speed_kn", 0.0, 600.0, above=True)
    return Unit(
        name=section.text("name", section.title),
        position_m=_place(section, plane),
        start_s=_S_PER_H * section.number("start_h", 0.0, _LONGEST_H, default=0.0),
        endurance_s=_S_PER_H * section.number("endurance_h", 0.0, _LONGEST_H, above=True),
        transit_mps=_MPS_PER_KN * speed_kn,
        search_mps=_MPS_PER_KN
        * section.number("search_speed_kn", 0.0, 600.0, default=speed_kn, above=True),
        sweep_width_m=section.number("sweep_width_m", 0.0, 1e5, above=True),
    )


def _tracks(section: _Section, plane: LocalPlane, path: Path) -> Iterator[Track]:
    """Tracks of the units in a file of routes, without the way to the commence search point."""
    names = ("unit", "point", "time_h", "lat_deg", "lon_deg")
    table = Table(path.parent / section.text("file"), {name: (name,) for name in names})
    table.require(*names[2:])
    sweep_width_m = section.number("sweep_width_m", 0.0, 1e5, above=True)
    limits = {"time_h": (0.0, 2 * _LONGEST_H), "lat_deg": _LATITUDE, "lon_deg": _LONGITUDE}
    columns = {name: table.numbers(name) for name in limits}
    for name, (least, most) in limits.items():
        good = (least <= columns[name]) & (columns[name] <= most)
        table.check(name, good, f"a number from {least:g} to {most:g}")
    whose = np.array(table.text("unit") if "unit" in table else [""] * len(table))
    chosen = section.text("unit") if section.given("unit") else None
    on_task = table.numbers("point") > 0 if "point" in table else np.ones(len(table), bool)
    position_m = plane.position_m(
        latitude_rad=np.radians(columns["lat_deg"]), longitude_rad=np.radians(columns["lon_deg"])
    )
    found = [name for name in dict.fromkeys(whose.tolist()) if chosen in (None, name)]
    if not found:
        raise section.error("unit", "a unit of the file with rows", chosen)
    for name in found:
        rows = np.flatnonzero((whose == name) & on_task)
        time_s = _S_PER_H * columns["time_h"][rows]
        if len(rows) < 2 or not (np.diff(time_s) > 0).all():
            table.check("time_h", whose != name, f"two or more increasing times of {name!r}")
        yield Track(time_s, position_m[rows], sweep_width_m)


def _place(section: _Section, plane: LocalPlane) -> np.ndarray:
    return plane.position_m(
        latitude_rad=math.radians(section.number("lat_deg", *_LATITUDE)),
        longitude_rad=math.radians(section.number("lon_deg", *_LONGITUDE)),
    )


def _tide(section: _Section) -> Tide:
    major_mps = section.number("major_mps", 0.0, _FASTEST_MPS)
    return Tide(
        period_s=_S_PER_H * section.number("period_h", 0.0, 1e4, default=12.4206, above=True),
        major_mps=major_mps,
        minor_mps=section.number("minor_mps", -major_mps, major_mps, default=0.0),
        direction_rad=math.radians(section.number("direction_deg", *_DIRECTION)),
        time_s=_S_PER_H * section.number("time_h", -1e4, 1e4, default=0.0),
    )


def _land(section: _Section, plane: LocalPlane) -> np.ndarray:
    latitude_deg = section.series("lat_deg", *_LATITUDE)
    longitude_deg = section.series("lon_deg", *_LONGITUDE, count=len(latitude_deg))
    if len(latitude_deg) < 3:
        raise section.error("lat_deg", "3 or more corners", latitude_deg.tolist())
    return plane.position_m(
        latitude_rad=np.radians(latitude_deg), longitude_rad=np.radians(longitude_deg)
    )


# Wind and current --------------------------------------------------------------------------------


def _flow(section: _Section, direction: str, plane: LocalPlane, path: Path) -> Flow:
    """A flow from arrays or a file; `direction` says whether it is from or toward."""
    if section.given("file"):
        return _flow_file(path.parent / section.text("file"), direction, plane)
    speed_mps = section.series("speed_mps", 0.0, _FASTEST_MPS)
    count = len(speed_mps)
    direction_deg = section.series(direction, *_DIRECTION, count=count)
    steady = count == 1 and not section.given("time_h")
    time_h = np.zeros(1) if steady else section.series("time_h", -1e4, 1e4, count=count)
    if not (np.diff(time_h) > 0).all():
        raise section.error("time_h", "increasing times", time_h.tolist())
    return Flow(_S_PER_H * time_h, _velocity_mps(speed_mps, direction_deg, direction))


def _velocity_mps(speed_mps: np.ndarray, direction_deg: np.ndarray, direction: str) -> np.ndarray:
    toward_rad = np.radians(direction_deg + (180.0 if direction == "from_deg" else 0.0))
    return speed_mps[..., None] * np.stack([np.cos(toward_rad), np.sin(toward_rad)], axis=-1)


def _flow_file(path: Path, direction: str, plane: LocalPlane) -> Flow:
    """A series, or with columns of latitude and longitude a field on a grid of them."""
    names = ("time_h", "lat_deg", "lon_deg", "speed_mps", direction)
    table = Table(path, {name: (name,) for name in names})
    table.require("time_h", "speed_mps", direction)
    columns = {name: table.numbers(name) for name in names if name in table}
    for name, values in columns.items():
        table.check(name, np.isfinite(values), "a number")
    table.check("speed_mps", abs(columns["speed_mps"]) <= _FASTEST_MPS, "at most 100 m/s")
    velocity_mps = _velocity_mps(columns["speed_mps"], columns[direction], direction)
    lines = [np.unique(columns[name]) for name in names[:3] if name in columns]
    size = tuple(map(len, lines))
    wanted = "each time once" if len(lines) == 1 else "each place of the grid once at each time"
    if len(lines) == 2 or not len(table) or np.prod(size) != len(table):
        table.check("time_h", np.zeros(max(len(table), 1), bool), wanted)
    place = tuple(
        np.searchsorted(line, columns[name])
        for line, name in zip(lines, (n for n in names[:3] if n in columns), strict=True)
    )
    ordered_mps = np.full((*size, 2), np.nan)
    ordered_mps[place] = velocity_mps
    table.check("time_h", np.full(len(table), np.isfinite(ordered_mps).all()), wanted)
    time_s = _S_PER_H * lines[0]
    if len(lines) == 1:
        return Flow(time_s, ordered_mps)
    north_m = plane.position_m(
        latitude_rad=np.radians(lines[1]),
        longitude_rad=np.full(len(lines[1]), plane.longitude_rad),
    )[:, 0]
    east_m = plane.position_m(
        latitude_rad=np.full(len(lines[2]), plane.latitude_rad),
        longitude_rad=np.radians(lines[2]),
    )[:, 1]
    return Flow(time_s, ordered_mps, north_m, east_m)


# TOML --------------------------------------------------------------------------------------------


class _Section:
    """Values of a table of a TOML file; every error names file, table and key."""

    def __init__(self, path: Path, title: str, values: Any) -> None:
        if not isinstance(values, dict):
            raise SettingsError(f"{path}: {title} must be a table, got {quoted(values)}")
        self.title = title
        self._path, self._values, self._used = path, values, {}

    def error(self, key: str, wanted: str, got: Any) -> SettingsError:
        """An error about the value of a key."""
        place = f"{self._path}: {self._place(key)}"
        return SettingsError(f"{place} must be {wanted}, got {quoted(got)}")

    def given(self, *keys: str) -> bool:
        """Whether the table has one of the keys."""
        return any(key in self._values for key in keys)

    def section(self, key: str, needed: bool = True) -> _Section:
        """The table of a key; an empty one if it may be left out."""
        return self._use(key, _Section(self._path, key, self._get(key, None if needed else {})))

    def sections(self, key: str) -> list[_Section]:
        """The tables of a key that may be repeated."""
        tables = self._get(key, [])
        if not isinstance(tables, list):
            raise self.error(key, f"tables [[{key}]]", tables)
        return self._use(
            key,
            [_Section(self._path, f"{key} {k}", table) for k, table in enumerate(tables, 1)],
        )

    def number(
        self, key: str, least: float, most: float, default: float | None = None, above: bool = False
    ) -> float:
        """A number of a range, with `above` more than the least."""
        value = self._get(key, default)
        return float(self._use(key, self._checked(key, value, least, most, above)))

    def series(self, key: str, least: float, most: float, count: int | None = None) -> np.ndarray:
        """Numbers (n,) of a range; one number is a series of one."""
        values = self._get(key, None)
        values = values if isinstance(values, list) else [values]
        if not values or count not in (None, len(values)):
            raise self.error(key, f"{count or 'one or more'} numbers", values)
        return self._use(key, np.array([self._checked(key, v, least, most) for v in values], float))

    def text(self, key: str, default: str | None = None) -> str:
        """A text."""
        value = self._get(key, default)
        if not isinstance(value, str) or not value.strip():
            raise self.error(key, "a text", value)
        return self._use(key, value)

    def truth(self, key: str, default: bool) -> bool:
        """True or false."""
        value = self._get(key, default)
        if not isinstance(value, bool):
            raise self.error(key, "true or false", value)
        return self._use(key, value)

    def word(
        self, key: str, known: Mapping[str, Any] | tuple[str, ...], default: str | None = None
    ):
        """One of some words."""
        value = self._get(key, default)
        if value not in known:
            raise self.error(key, f"one of {', '.join(known)}", value)
        return self._use(key, value)

    def words(self, key: str, known: Mapping[str, Any]) -> tuple[str, ...]:
        """Some of the words, by default all."""
        values = self._get(key, list(known))
        if not isinstance(values, list) or not values or not set(map(str, values)) <= set(known):
            raise self.error(key, f"a list of some of {', '.join(known)}", values)
        return self._use(key, tuple(values))

    def time(self, key: str) -> datetime.datetime | None:
        """A date with time and offset, if given."""
        value = self._values.get(key)
        if value is not None and not (isinstance(value, datetime.datetime) and value.tzinfo):
            raise self.error(key, "a date with time and offset such as 2026-03-14T05:30:00Z", value)
        return self._use(key, value)

    def close(self) -> None:
        """Raise SettingsError if there is a key that nothing has asked for."""
        for key in self._values:
            if key not in self._used:
                known = ", ".join(self._used)
                raise SettingsError(
                    f"{self._path}: unknown key {cut(self._place(key))}; known: {known}"
                )
        for used in self._used.values():
            for section in used if isinstance(used, list) else [used]:
                if isinstance(section, _Section):
                    section.close()

    def _place(self, key: str) -> str:
        return f"[{self.title}] {key}" if self.title else key

    def _get(self, key: str, default: Any) -> Any:
        if key not in self._values and default is None:
            raise SettingsError(f"{self._path}: {self._place(key)} is missing")
        return self._values.get(key, default)

    def _use(self, key: str, value: Any) -> Any:
        self._used[key] = value
        return value

    def _checked(
        self, key: str, value: Any, least: float, most: float, above: bool = False
    ) -> float:
        good = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not (good and least <= value <= most and not (above and value == least)):
            start = f"above {least:g}" if above else f"from {least:g}"
            raise self.error(key, f"a number {start}, at most {most:g}", value)
        return value
