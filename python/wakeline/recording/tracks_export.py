"""Tracks for maps and navigation programs: GPX, KML, GeoJSON and geographic CSV."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import datetime, timedelta, timezone
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree as Xml

import numpy as np

from wakeline._engine.navigation import LocalPlane

from .files import replacing
from .tracks_csv import Tracks

_EPOCH = datetime(1970, 1, 1, tzinfo=timezone.utc)
_UNIX_S = 1e8  # times from here on are Unix times: 1973 and later
_GPX = "http://www.topografix.com/GPX/1/1"
_KML = "http://www.opengis.net/kml/2.2"
_GX = "http://www.google.com/kml/ext/2.2"
_DIGITS = 8  # of degrees: 1 mm


@dataclass(frozen=True)
class _Line:
    """One track in order of time."""

    name: str
    times: list[datetime] | None
    latitude_deg: np.ndarray
    longitude_deg: np.ndarray
    course_deg: np.ndarray
    rows: Tracks

    def places(self) -> Iterator[tuple[float, float]]:
        """Latitude and longitude of each row."""
        yield from zip(self.latitude_deg.tolist(), self.longitude_deg.tolist(), strict=True)

    def when(self) -> list[str]:
        return [_iso(time) for time in self.times or []]


def export_tracks(
    path: str | Path,
    tracks: Tracks,
    *,
    origin_deg: tuple[float, float],
    start: datetime | None = None,
) -> None:
    """Write tracks in the format that the name of the file ends with; `path` is replaced only when
    the new file is complete.

    - ``.gpx``: GPX 1.1, a ``trk`` for each track;
    - ``.kml``: a ``gx:Track`` for each track, a ``LineString`` where times are unknown;
    - ``.geojson`` or ``.json``: a ``FeatureCollection`` (RFC 7946) with a line for each track, cut
      at the antimeridian; ``coordTimes`` has the times of its points;
    - ``.csv``: ``track_id, time, time_s, latitude_deg, longitude_deg, course_deg, speed_mps``, and
      ``status`` and ``scenario`` if `tracks` has them.

    Courses are from true north. Rows without a finite position are left out.

    Parameters
    ----------
    path : str or Path
        The file to write. Its folder must exist.
    tracks : Tracks
        The rows.
    origin_deg : (float, float)
        Latitude and longitude of north 0, east 0.
    start : datetime, optional
        When ``time_s`` is 0; UTC unless it has a time zone. By default times from 1e8 s on are Unix
        times, and others are unknown.

    Raises
    ------
    ValueError
        When the name has another ending or the origin is not on the earth.
    """
    path = Path(path)
    write = _WRITERS.get(path.suffix.lower())
    if write is None:
        endings = ", ".join(_WRITERS)
        raise ValueError(f"{path}: the name must end with one of {endings}, got {path.suffix!r}")
    lines = _lines(tracks, _plane(origin_deg), start)
    with replacing(path) as fresh:
        write(fresh, lines)


def _plane(origin_deg: tuple[float, float]) -> LocalPlane:
    latitude_deg, longitude_deg = origin_deg
    if not (abs(latitude_deg) <= 90 and abs(longitude_deg) <= 180):
        raise ValueError(
            "origin_deg must be a latitude from -90 to 90 and a longitude from -180 to 180, "
            f"got {origin_deg}"
        )
    return LocalPlane(
        latitude_rad=np.radians(latitude_deg), longitude_rad=np.radians(longitude_deg)
    )


def _lines(tracks: Tracks, plane: LocalPlane, start: datetime | None) -> list[_Line]:
    tracks = tracks.where(np.isfinite(tracks.state).all(axis=1))
    if start is None and len(tracks) and tracks.time_s.min() >= _UNIX_S:
        start = _EPOCH
    if start is not None and start.tzinfo is None:
        start = start.replace(tzinfo=timezone.utc)
    latitude, longitude = plane.place(tracks.state[:, [0, 2]])
    course = plane.true_course_rad(
        np.radians(tracks.course_deg), latitude_rad=latitude, longitude_rad=longitude
    )
    columns = np.degrees([latitude, longitude, course])
    scenario = tracks.scenario if tracks.scenario is not None else np.full(len(tracks), "")
    labels = [f"{a}/{b}" if a else b for a, b in zip(scenario, tracks.track_id, strict=True)]
    rows: dict[str, list[int]] = {}
    for row, label in enumerate(labels):
        rows.setdefault(label, []).append(row)
    return [_line(label, tracks, np.array(of), columns, start) for label, of in rows.items()]


def _line(
    label: str,
    tracks: Tracks,
    rows: np.ndarray,
    columns: np.ndarray,
    start: datetime | None,
) -> _Line:
    rows = rows[np.argsort(tracks.time_s[rows], kind="stable")]
    times = None
    if start is not None:
        times = [start + timedelta(seconds=s) for s in tracks.time_s[rows].tolist()]
    return _Line(label, times, *columns[:, rows], tracks.where(rows))


def _iso(time: datetime) -> str:
    text = time.astimezone(timezone.utc).isoformat(timespec="milliseconds")
    return text.replace("+00:00", "Z")


def _plain(text: str) -> str:
    """Without the characters that XML does not have."""
    return re.sub("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]", "?", text)


def _write_xml(path: Path, root: Xml.Element) -> None:
    tree = Xml.ElementTree(root)
    Xml.indent(tree)
    tree.write(path, encoding="UTF-8", xml_declaration=True)


def _degrees(value: float) -> str:
    return f"{value:.{_DIGITS}f}"


def _write_gpx(path: Path, lines: list[_Line]) -> None:
    root = Xml.Element("gpx", {"xmlns": _GPX, "version": "1.1", "creator": "wakeline"})
    for line in lines:
        track = Xml.SubElement(root, "trk")
        Xml.SubElement(track, "name").text = _plain(line.name)
        segment = Xml.SubElement(track, "trkseg")
        when = line.when()
        for k, (latitude, longitude) in enumerate(line.places()):
            place = {"lat": _degrees(latitude), "lon": _degrees(longitude)}
            point = Xml.SubElement(segment, "trkpt", place)
            if when:
                Xml.SubElement(point, "time").text = when[k]
    _write_xml(path, root)


def _write_kml(path: Path, lines: list[_Line]) -> None:
    root = Xml.Element("kml", {"xmlns": _KML, "xmlns:gx": _GX})
    document = Xml.SubElement(root, "Document")
    for line in lines:
        mark = Xml.SubElement(document, "Placemark")
        Xml.SubElement(mark, "name").text = _plain(line.name)
        if line.times is None:
            shape = Xml.SubElement(mark, "LineString")
            Xml.SubElement(shape, "coordinates").text = " ".join(
                f"{_degrees(longitude)},{_degrees(latitude)}"
                for latitude, longitude in line.places()
            )
            continue
        shape = Xml.SubElement(mark, "gx:Track")
        for when in line.when():
            Xml.SubElement(shape, "when").text = when
        for latitude, longitude in line.places():
            Xml.SubElement(shape, "gx:coord").text = f"{_degrees(longitude)} {_degrees(latitude)} 0"
    _write_xml(path, root)


def _write_geojson(path: Path, lines: list[_Line]) -> None:
    features = [
        {"type": "Feature", "geometry": _geometry(line), "properties": _properties(line)}
        for line in lines
    ]
    collection = {"type": "FeatureCollection", "features": features}
    with path.open("w", encoding="utf-8") as file:
        json.dump(collection, file, ensure_ascii=False)
        file.write("\n")


def _geometry(line: _Line) -> dict:
    places = [
        [round(longitude, _DIGITS), round(latitude, _DIGITS)]
        for latitude, longitude in line.places()
    ]
    parts = _cut(places)
    if len(places) == 1:
        return {"type": "Point", "coordinates": places[0]}
    if len(parts) == 1:
        return {"type": "LineString", "coordinates": parts[0]}
    return {"type": "MultiLineString", "coordinates": parts}


def _cut(places: list[list[float]]) -> list[list[list[float]]]:
    """The parts of a line on either side of the antimeridian, each up to it."""
    parts = [places[:1]]
    for (x0, y0), (x1, y1) in pairwise(places):
        if abs(x1 - x0) > 180:
            edge = 180.0 if x0 > 0 else -180.0
            width = 360 - abs(x1 - x0)
            share = abs(edge - x0) / width if width > 0 else 0.0
            y = round(y0 + share * (y1 - y0), _DIGITS)
            parts[-1].append([edge, y])
            parts.append([[-edge, y]])
        parts[-1].append([x1, y1])
    return parts


def _properties(line: _Line) -> dict:
    properties: dict = {"track_id": line.rows.track_id[0].item()}
    if line.rows.scenario is not None:
        properties["scenario"] = line.rows.scenario[0].item()
    properties["begin_s"], properties["end_s"] = line.rows.time_s[[0, -1]].tolist()
    when = line.when()
    if when:
        properties |= {"begin": when[0], "end": when[-1], "coordTimes": when}
    return properties


def _write_csv(path: Path, lines: list[_Line]) -> None:
    names = ["track_id", "time", "time_s", "latitude_deg", "longitude_deg"]
    names += ["course_deg", "speed_mps"]
    more = [
        name
        for name in ("status", "scenario")
        if lines and getattr(lines[0].rows, name) is not None
    ]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names + more)
        for line in lines:
            rows = line.rows
            columns = [
                rows.track_id,
                line.when() or [""] * len(rows),
                rows.time_s.tolist(),
                map(_degrees, line.latitude_deg.tolist()),
                map(_degrees, line.longitude_deg.tolist()),
                [f"{course:.3f}" for course in line.course_deg.tolist()],
                rows.speed_mps.tolist(),
                *(getattr(rows, name) for name in more),
            ]
            writer.writerows(zip(*columns, strict=True))


_WRITERS: dict[str, Callable[[Path, list[_Line]], None]] = {
    ".gpx": _write_gpx,
    ".kml": _write_kml,
    ".geojson": _write_geojson,
    ".json": _write_geojson,
    ".csv": _write_csv,
}
