"""Settings of a live session: inputs, outputs, radars and own ship, in Python and as TOML."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import MISSING, asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import wakeline as wl
from wakeline._brief import cut, quoted
from wakeline.tracking.settings import Settings, SettingsError, read_toml

from .zones import Zone, placed

IN_SCHEMES = (
    "udp",
    "tcp",
    "tcp-listen",
    "serial",
    "stdin",
    "file",
    "pcap",
    "signalk",
)
OUT_SCHEMES = ("udp", "tcp", "tcp-listen", "serial", "file", "stdout")
IN_FORMATS = ("", "nmea", "json", "cat240", "cat048", "cat010", "signalk", "spokes")
OUT_FORMATS = ("json", "ttm", "tll", "cat062", "cat010")
# Sentences of each quantity, the best first; those of JSON lines and of Signal K come from a system
# that has chosen already.
SENTENCES = {
    "position": ("JSON", "SIGNALK", "GGA", "GNS", "RMC", "GLL", "VDO"),
    "heading": ("JSON", "SIGNALK", "HDT", "THS", "HDG", "HDM", "VHW"),
    "velocity": ("JSON", "SIGNALK", "RMC", "VTG", "VDO"),
    "turn": ("ROT",),
}
AZIMUTHS = ("north", "bow")
CONNECTION = " from "  # between the names of an input and of a peer of it
_OF_SCHEME = {"udp": ("iface",), "serial": ("baud",)}  # what a URL's query may have beside settings


_SECTIONS = ("session", "own", "input", "output", "radar", "guard_zone")
_GUARD_ZONE = """\
# [[guard_zone]]
# Alarms when a target enters. kind is guard, exclusion (plots inside start no track) or land.
# name = "harbor entrance"
# kind = "guard"
# Corners: latitude and longitude, or outline_m, [north, east] of the origin. [degrees]
# outline_deg = [[54.50, 10.10], [54.50, 10.20], [54.45, 10.20]]
# Of entry, exit and occupancy, which is a stay of occupancy_s.
# triggers = ["entry"]
# occupancy_s = 60.0
# A target has left when it is outside by so much. [m]
# hysteresis_m = 10.0
""".splitlines()


def _key(default: Any, sentence: str) -> Any:
    """A setting with the sentence that explains it."""
    if isinstance(default, (dict, list)):
        return field(default_factory=lambda: type(default)(default), metadata={"about": sentence})
    return field(default=default, metadata={"about": sentence})


@dataclass(frozen=True)
class InputConfig:
    """One source of data.

    Attributes
    ----------
    url : str
        ``udp://HOST:PORT``, ``udp://GROUP:PORT?iface=ADDRESS``, ``tcp://HOST:PORT``,
        ``tcp-listen://HOST:PORT``, ``serial:/dev/NAME?baud=38400``, ``stdin:``, ``file:PATH``,
        ``pcap:PATH``, ``signalk://HOST:PORT``, or ``signalk://HOST:PORT/radars/ID`` for the
        spokes of a radar; the other settings may be given as its query.
    name : str
        The name in the status; default the URL without its query, with `sac_sic`.
    format : str
        One of `IN_FORMATS`; empty: recognized by the octets.
    radar : str
        Name of the radar of video or plots that do not name one; default the first.
    sac_sic : str
        Only messages of ASTERIX of this source are taken: area and system, as ``25/1``.
    """

    url: str = _key("", "Where data come from: udp://0.0.0.0:10110, tcp://HOST:PORT, ...")
    name: str = _key("", "Name in the status; empty: the URL without its query.")
    format: str = _key("", f"One of {', '.join(filter(None, IN_FORMATS))}; empty: recognized.")
    radar: str = _key("", "Radar of its video or plots where they name none; empty: the first.")
    sac_sic: str = _key("", "Only ASTERIX of this source, such as 25/1, is taken; empty: all.")

    def __post_init__(self) -> None:
        _take_query(self, ("name", "format", "radar", "sac_sic"), IN_SCHEMES)
        _check_sac_sic(self)
        if self.scheme == "signalk":
            kind = "spokes" if urlsplit(self.url).path.startswith("/radars/") else "signalk"
            object.__setattr__(self, "format", kind)
        _check_choice("format", self.format, IN_FORMATS)

    @property
    def scheme(self) -> str:
        """The part of the URL before the colon."""
        return urlsplit(self.url).scheme

    @property
    def is_stream(self) -> bool:
        """Whether octets come without the borders of messages."""
        if self.scheme == "pcap":
            return CONNECTION in self.name
        return self.scheme not in ("", "udp", "signalk")


@dataclass(frozen=True)
class OutputConfig:
    """One receiver of tracks.

    Attributes
    ----------
    url : str
        ``udp://HOST:PORT``, ``tcp://HOST:PORT``, ``tcp-listen://HOST:PORT``,
        ``serial:/dev/NAME?baud=38400``, ``file:PATH`` or ``stdout:``; ``name`` and ``format`` may
        be given as its query.
    name : str
        The name in the status; default the URL without its query.
    format : str
        One of `OUT_FORMATS`; default ``json`` to files and the standard output, else ``ttm``.
    """

    url: str = _key("", "Where tracks go: udp://127.0.0.1:10111, file:tracks.jsonl, ...")
    name: str = _key("", "Name in the status; empty: the URL without its query.")
    format: str = _key("", f"One of {', '.join(OUT_FORMATS)}; empty: json to files, else ttm.")

    def __post_init__(self) -> None:
        _take_query(self, ("name", "format"), OUT_SCHEMES)
        if not self.format:
            json_too = self.scheme in ("file", "stdout")
            object.__setattr__(self, "format", "json" if json_too else "ttm")
        _check_choice("format", self.format, OUT_FORMATS)

    @property
    def scheme(self) -> str:
        """The part of the URL before the colon."""
        return urlsplit(self.url).scheme


@dataclass(frozen=True)
class RadarConfig:
    """One radar.

    Attributes
    ----------
    name : str
    azimuth : str
        Origin of its bearings and azimuths: "north" or "bow".
    position_deg : (float, float), optional
        Latitude and longitude of a radar ashore; default aboard own ship.
    forward_m, starboard_m : float
        Position of the antenna aboard, from the reference point of own ship.
    sac_sic : str
        Source of its messages of ASTERIX, as ``25/1``: these are its at inputs that name no radar,
        and it has no others.
    settings : dict of str to float
        Keys of ``[radar]`` of :class:`wakeline.tracking.Settings`.
    """

    name: str = _key("A", "Name of the radar in data and tracks.")
    azimuth: str = _key("north", "Origin of its bearings: north or bow.")
    position_deg: Sequence[float] = _key(
        (), "Latitude and longitude of a radar ashore; empty: aboard own ship. [degrees]"
    )
    forward_m: float = _key(0.0, "Antenna forward of own ship's reference point. [m]")
    starboard_m: float = _key(0.0, "Antenna to starboard of the reference point. [m]")
    sac_sic: str = _key("", "Source of its ASTERIX, such as 25/1; empty: the first of its input.")
    settings: Mapping[str, float] = _key({}, "")

    def __post_init__(self) -> None:
        _check_sac_sic(self)
        _check_choice("azimuth", self.azimuth, AZIMUTHS)
        _check_place("position_deg", self.position_deg)

    def make_radar(self, default: Settings) -> wl.Radar:
        """The tracker's radar; keys that are not given are those of the default."""
        return replace(default, radar=default.radar | dict(self.settings)).make_radar()


@dataclass(frozen=True)
class OwnConfig:
    """Sources of own ship's position, heading and velocity.

    Attributes
    ----------
    position, heading, velocity : sequence of str
        Sources in order of preference, before all others: a sentence (``GGA``), a talker with it
        (``GPGGA``), either at an input (``GPGGA@NAME``), or ``@NAME`` alone.
    dwell_s : float
        A better source must have been there for this long before it is used.
    position_age_s, heading_age_s, velocity_age_s : float
        An older reading is not used.
    position_std_m, heading_std_deg : float
        Standard deviations of a reading, per axis, and of a heading.
    variation_deg : float
        Magnetic variation, positive east; NaN: that of the sentences.
    gnss_forward_m, gnss_starboard_m : float
        Position of the antenna of the GNSS receiver, from the reference point of own ship.
    place_deg : (float, float), optional
        Latitude and longitude of a station that does not move.
    fixed_heading_deg : float
        Heading of such a station.
    """

    position: Sequence[str] = _key((), "Preferred sources of position: GGA, GPGGA, GGA@NAME, ...")
    heading: Sequence[str] = _key((), "Preferred sources of heading.")
    velocity: Sequence[str] = _key((), "Preferred sources of velocity over ground.")
    dwell_s: float = _key(10.0, "A better source is used after being there for this long. [s]")
    position_age_s: float = _key(10.0, "An older position is not used. [s]")
    heading_age_s: float = _key(3.0, "An older heading is not used. [s]")
    velocity_age_s: float = _key(10.0, "An older velocity is not used. [s]")
    position_std_m: float = _key(
        1.0, "Error of a position that changes from fix to fix, per axis. [m]"
    )
    heading_std_deg: float = _key(0.5, "Standard deviation of a heading. [degrees]")
    variation_deg: float = _key(
        float("nan"), "Magnetic variation, east positive; nan: that of the sentences. [degrees]"
    )
    gnss_forward_m: float = _key(0.0, "GNSS antenna forward of own ship's reference point. [m]")
    gnss_starboard_m: float = _key(0.0, "GNSS antenna to starboard of the reference point. [m]")
    place_deg: Sequence[float] = _key(
        (), "Latitude and longitude of a station that does not move. [degrees]"
    )
    fixed_heading_deg: float = _key(0.0, "Heading of such a station. [degrees]")

    def __post_init__(self) -> None:
        _check_place("place_deg", self.place_deg)
        for name in ("dwell_s", "position_age_s", "heading_age_s", "velocity_age_s"):
            if not getattr(self, name) >= 0.0:
                raise SettingsError(f"{name} must be 0 or more, got {getattr(self, name)}")
        for name in ("position", "heading", "velocity"):
            for pattern in getattr(self, name):
                sentence, known = pattern.partition("@")[0], ("", *SENTENCES[name])
                if sentence not in known and sentence[2:] not in known[1:]:
                    _check_choice(name, sentence, known)


@dataclass(frozen=True)
class SessionConfig:
    """The session itself.

    Attributes
    ----------
    origin_deg : (float, float), optional
        Latitude and longitude of north 0, east 0; default the first position of own ship, or the
        first radar ashore.
    status_s : float
        Interval of the status line.
    window_s : float
        Data of radars that are at most so much older than the newest are put in their place; 0:
        two turns of the slowest radar, and at least 10 s.
    record : str
        File that the session is recorded to; empty: none.
    segment_mb, most_mb : float
        Size at which a new segment of the record begins, and of all segments together before the
        oldest is removed.
    """

    origin_deg: Sequence[float] = _key(
        (), "Latitude and longitude of north 0, east 0; empty: the first position. [degrees]"
    )
    status_s: float = _key(1.0, "Interval of the status line; 0: none. [s]")
    window_s: float = _key(
        0.0, "Data at most so late are put in their place; 0: two turns, at least 10 s. [s]"
    )
    record: str = _key("", "File that the session is recorded to; empty: none.")
    segment_mb: float = _key(256.0, "A new segment of the record begins at this size. [MB]")
    most_mb: float = _key(4096.0, "Size of all segments before the oldest is removed. [MB]")

    def __post_init__(self) -> None:
        _check_place("origin_deg", self.origin_deg)
        if not 0.0 <= self.window_s <= 3600.0:
            raise SettingsError(f"window_s must be from 0 to 3600, got {self.window_s}")
        if not 0.0 < self.segment_mb <= self.most_mb:
            raise SettingsError(
                f"segment_mb must be above 0 and at most most_mb, got {self.segment_mb}"
            )


@dataclass(frozen=True)
class LiveConfig:
    """All settings of a live session.

    Attributes
    ----------
    inputs : tuple of InputConfig
    outputs : tuple of OutputConfig
    radars : tuple of RadarConfig
        Without any, one radar "A" aboard, as ``[radar]`` describes it.
    own : OwnConfig
    session : SessionConfig
    settings : Settings
        Tracker, motion models, danger limits and zones, and what radars have in common.
    guard_zones : tuple of dict
        Zones that alarms or tracks depend on: :class:`wakeline.live.zones.Zone` as objects, with
        `outline_m` from the origin or `outline_deg` (latitude, longitude).
    """

    inputs: tuple[InputConfig, ...] = ()
    outputs: tuple[OutputConfig, ...] = ()
    radars: tuple[RadarConfig, ...] = ()
    own: OwnConfig = field(default_factory=OwnConfig)
    session: SessionConfig = field(default_factory=SessionConfig)
    settings: Settings = field(default_factory=Settings.default)
    guard_zones: tuple[Mapping[str, Any], ...] = ()

    def __post_init__(self) -> None:
        for name in ("inputs", "outputs"):
            named = tuple(_named(each) for each in getattr(self, name))
            check_once(name, [each.name for each in named])
            object.__setattr__(self, name, named)
        object.__setattr__(self, "radars", tuple(self.radars) or (RadarConfig(),))
        names = [radar.name for radar in self.radars]
        check_once("radars", names)
        check_once("sac_sic of radars", [one.sac_sic for one in self.radars if one.sac_sic])
        for one in self.inputs:
            if one.radar and one.radar not in names:
                known, got = ", ".join(names), quoted(one.radar)
                needed = "each other one needs a section [[radar]] with its name"
                raise SettingsError(f"radar must be one of {known}, got {got}; {needed}")
        for one in self.guard_zones:
            try:
                Zone.of(placed(one, lambda latitude, longitude: (latitude * 1e3, longitude * 1e3)))
            except (ValueError, TypeError) as error:
                raise SettingsError(f"[[guard_zone]]: {error}") from None

    def as_document(self) -> dict[str, Any]:
        """The sections of a TOML file, from which :func:`config_of` makes the same settings."""
        radars = [asdict(one) for one in self.radars]
        settings = self.settings
        return {
            "session": asdict(self.session),
            "own": {key: value for key, value in asdict(self.own).items() if not _is_nan(value)},
            "input": [asdict(one) for one in self.inputs],
            "output": [asdict(one) for one in self.outputs],
            "radar": [
                {key: value for key, value in one.items() if key != "settings"}
                | settings.radar
                | dict(one["settings"])
                for one in radars
            ],
            **{name: dict(getattr(settings, name)) for name in ("tracker", "models", "danger")},
            "zone": list(settings.zones),
            "guard_zone": [dict(one) for one in self.guard_zones],
        }

    def toml(self) -> str:
        """Every setting with a line of explanation; reading it gives the same settings."""
        lists = [
            ("input", self.inputs or (InputConfig(),)),
            ("output", self.outputs or (OutputConfig(url="stdout:"),)),
            ("radar", self.radars),
        ]
        lines = list(_section("session", self.session))
        lines += _section("own", self.own)
        for name, each in lists:
            empty = not getattr(self, f"{name}s")
            for one in each:
                mark = "# " if empty else ""
                lines += [f"{mark}{line}" for line in _section(f"[{name}]", one)]
                if name == "radar":
                    lines[-1:] = [*self.settings.toml_of_radar(one.settings), ""]
        common = self.settings.toml().partition("[tracker]")
        before = common[0].rstrip().rpartition("\n")[2]
        if not self.guard_zones:
            lines += _GUARD_ZONE
        for zone in self.guard_zones:
            lines += ["[[guard_zone]]", *(f"{k} = {json.dumps(v)}" for k, v in zone.items()), ""]
        return "\n".join(lines) + f"\n{before}\n[tracker]{common[2]}"


def read_config(path: str | Path) -> LiveConfig:
    """Read the settings of a live session.

    Raises
    ------
    SettingsError
        When the file cannot be read, a key is unknown, or a value is out of range.
    """
    return config_of(read_toml(Path(path)), path)


def config_of(document: Mapping[str, Any], path: str | Path = "settings") -> LiveConfig:
    """The settings in the sections of a document; `path` is its name in messages."""
    rest = dict(document)
    inputs = _read_list(rest.pop("input", []), "input", InputConfig, path)
    outputs = _read_list(rest.pop("output", []), "output", OutputConfig, path)
    given = rest.pop("radar", [])
    guard_zones = rest.pop("guard_zone", [])
    _check_list(guard_zones, "guard_zone", path)
    session = _read_one(rest.pop("session", {}), "session", SessionConfig, path)
    own = _read_one(rest.pop("own", {}), "own", OwnConfig, path)
    common = given if isinstance(given, dict) else {}
    settings = Settings.of(rest | ({"radar": common} if common else {}), path, _SECTIONS)
    radars = () if common else _read_radars(given, settings, path)
    try:
        return LiveConfig(inputs, outputs, radars, own, session, settings, tuple(guard_zones))
    except SettingsError as error:
        raise SettingsError(f"{path}: {error}") from None


def _read_radars(given: Any, settings: Settings, path: str | Path) -> tuple[RadarConfig, ...]:
    _check_list(given, "radar", path)
    ours = {one.name for one in fields(RadarConfig)} - {"settings"}
    radars = []
    for values in given:
        keys = {key: value for key, value in values.items() if key in ours}
        engine = {key: value for key, value in values.items() if key not in ours}
        Settings.of({"radar": engine}, path)
        radars.append(_read_one(keys | {"settings": engine}, "radar", RadarConfig, path))
    return tuple(radars)


def _read_list(given: Any, section: str, kind: type, path: str | Path) -> tuple[Any, ...]:
    _check_list(given, section, path)
    return tuple(_read_one(values, section, kind, path) for values in given)


def _check_list(given: Any, section: str, path: str | Path) -> None:
    if not isinstance(given, list) or not all(isinstance(one, dict) for one in given):
        raise SettingsError(f"{path}: {section} must be sections [[{section}]]")


def _read_one(values: Any, section: str, kind: type, path: str | Path) -> Any:
    if not isinstance(values, dict):
        raise SettingsError(f"{path}: {section} must be a section with keys")
    known = {one.name: one for one in fields(kind)}
    given = {}
    for key, value in values.items():
        if key not in known:
            raise SettingsError(
                f"{path}: unknown key {cut(key)} in [{section}]; known: {', '.join(known)}"
            )
        given[key] = _as_type(value, _default(known[key]), f"{path}: [{section}] {key}")
    try:
        return kind(**given)
    except SettingsError as error:
        raise SettingsError(f"{path}: [{section}] {error}") from None


def _default(one: Any) -> Any:
    return one.default_factory() if one.default is MISSING else one.default


def _as_type(value: Any, default: Any, place: str) -> Any:
    """The value as the type of the default."""
    if isinstance(default, float) and isinstance(value, (int, float)) and value is not True:
        return float(value)
    if isinstance(default, tuple) and isinstance(value, (list, tuple)):
        return tuple(value)
    if isinstance(default, str) and isinstance(value, str):
        return value
    if isinstance(default, dict) and isinstance(value, dict):
        return value
    what = {float: "a number", tuple: "a list", str: "a text", dict: "a section"}[type(default)]
    raise SettingsError(f"{place} must be {what}, got {quoted(value)}")


def _section(name: str, values: Any) -> Iterator[str]:
    yield f"[{name}]"
    for one in fields(values):
        value = getattr(values, one.name)
        if one.name == "settings":
            continue
        yield f"# {one.metadata['about']}"
        text = "nan" if _is_nan(value) else json.dumps(value)
        yield f"{one.name} = {text}"
    yield ""


def _is_nan(value: Any) -> bool:
    return isinstance(value, float) and math.isnan(value)


def _take_query(values: Any, names: Sequence[str], schemes: Sequence[str]) -> None:
    """Settings from the query of the URL where they are not given."""
    url = urlsplit(values.url)
    if values.url and url.scheme not in schemes:
        raise SettingsError(
            f"url must begin with one of {', '.join(schemes)} and a colon, got {quoted(values.url)}"
        )
    query = parse_qs(url.query, keep_blank_values=True)
    known = (*names, *_OF_SCHEME.get(url.scheme, ()))
    for key in query:
        if key not in known:
            raise SettingsError(
                f"unknown key {quoted(key)} in the query of {quoted(values.url)}; "
                f"known: {', '.join(known)}"
            )
    for name in names:
        if name in query and not getattr(values, name):
            object.__setattr__(values, name, query[name][-1])


def _named(one: Any) -> Any:
    parts = one.url.partition("?")[0], getattr(one, "sac_sic", "")
    return one if one.name else replace(one, name=" ".join(filter(None, parts)))


def _check_sac_sic(values: Any) -> None:
    """Check the source of ASTERIX that is wanted, and write it in one way."""
    numbers = re.fullmatch(r"(\d{1,3})/(\d{1,3})", values.sac_sic)
    pair = [int(one) for one in numbers.groups()] if numbers else []
    if values.sac_sic and (not pair or max(pair) > 255):
        wanted = "two numbers from 0 to 255, such as 25/1"
        raise SettingsError(f"sac_sic must be {wanted}, got {quoted(values.sac_sic)}")
    object.__setattr__(values, "sac_sic", "/".join(map(str, pair)))


def _check_choice(name: str, value: str, choices: Sequence[str]) -> None:
    if value not in choices:
        known = ", ".join(filter(None, choices))
        raise SettingsError(f"{name} must be one of {known}, got {quoted(value)}")


def _check_place(name: str, place: Sequence[float]) -> None:
    if len(place) not in (0, 2) or (
        len(place) == 2 and not (abs(place[0]) <= 90 and abs(place[1]) <= 360)
    ):
        raise SettingsError(f"{name} must be latitude and longitude in degrees, got {place!r}")


def check_once(name: str, names: Sequence[str]) -> None:
    """Raise `SettingsError` when a name is there twice."""
    twice = sorted({one for one in names if names.count(one) > 1})
    if twice:
        raise SettingsError(f"{name} must be different, got {quoted(twice[0])} twice")
