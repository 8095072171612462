"""Routes of a plan as CSV and GPX."""

from __future__ import annotations

import csv
import datetime
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from wakeline.recording import replacing

from .plan import Plan, Sortie
from .scenario import SearchScenario

_COLUMNS = ("unit", "pattern", "point", "time_h", "time_utc", "lat_deg", "lon_deg", "course_deg")


def route_points(sortie: Sortie) -> tuple[np.ndarray, np.ndarray]:
    """Times (K,) and positions (K, 2) from departure to the end of the pattern."""
    time_s = np.append(sortie.unit.start_s, sortie.time_s)
    return time_s, np.vstack([sortie.unit.position_m, sortie.position_m])


def write_routes(path: str | Path, plan: Plan, scenario: SearchScenario) -> None:
    """Write the routes of all units as CSV.

    Columns: unit, pattern, point (0 is the departure, 1 the commence search point), time_h after
    the last known time, time_utc if that is known, latitude, longitude, and the true course to the
    next point.
    """
    with replacing(path) as fresh, fresh.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(_COLUMNS)
        for sortie in plan.sorties:
            courses = [*_courses_deg(sortie, scenario), None]
            for k, (time_s, latitude_deg, longitude_deg) in enumerate(_placed(sortie, scenario)):
                writer.writerow(
                    (
                        sortie.unit.name,
                        sortie.pattern.kind,
                        k,
                        f"{time_s / 3600.0:.4f}",
                        _utc(scenario, time_s) or "",
                        f"{latitude_deg:.6f}",
                        f"{longitude_deg:.6f}",
                        "" if courses[k] is None else f"{courses[k]:.1f}",
                    )
                )


def write_gpx(path: str | Path, plan: Plan, scenario: SearchScenario) -> None:
    """Write the routes of all units as a GPX 1.1 file, one route a unit."""
    root = ElementTree.Element(
        "gpx", version="1.1", creator="wakeline", xmlns="http://www.topografix.com/GPX/1/1"
    )
    for sortie in plan.sorties:
        route = ElementTree.SubElement(root, "rte")
        ElementTree.SubElement(route, "name").text = sortie.unit.name
        ElementTree.SubElement(route, "desc").text = sortie.pattern.label
        for k, (time_s, latitude_deg, longitude_deg) in enumerate(_placed(sortie, scenario)):
            point = ElementTree.SubElement(
                route, "rtept", lat=f"{latitude_deg:.6f}", lon=f"{longitude_deg:.6f}"
            )
            utc = _utc(scenario, time_s)
            if utc:
                ElementTree.SubElement(point, "time").text = utc
            ElementTree.SubElement(point, "name").text = "departure" if k == 0 else f"{k}"
    ElementTree.indent(root, " ")
    with replacing(path) as fresh:
        ElementTree.ElementTree(root).write(fresh, encoding="utf-8", xml_declaration=True)


def _placed(sortie: Sortie, scenario: SearchScenario) -> Iterator[tuple[float, float, float]]:
    time_s, position_m = route_points(sortie)
    return zip(time_s, *scenario.degrees(position_m), strict=True)


def _courses_deg(sortie: Sortie, scenario: SearchScenario) -> np.ndarray:
    """True courses of the legs at their beginning."""
    _, position_m = route_points(sortie)
    latitude_deg, longitude_deg = scenario.degrees(position_m[:-1])
    north_m, east_m = np.diff(position_m, axis=0).T
    return np.degrees(
        scenario.plane.true_course_rad(
            np.arctan2(east_m, north_m),
            latitude_rad=np.radians(latitude_deg),
            longitude_rad=np.radians(longitude_deg),
        )
    )


def _utc(scenario: SearchScenario, time_s: float) -> str | None:
    if scenario.time is None:
        return None
    then = scenario.time.astimezone(datetime.timezone.utc) + datetime.timedelta(seconds=time_s)
    return then.strftime("%Y-%m-%dT%H:%M:%SZ")
