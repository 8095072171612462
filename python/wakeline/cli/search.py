"""``wakeline search``: drift of an object, and a search plan with its probability of success."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from wakeline import navigation, plot
from wakeline import search as ws
from wakeline.recording.files import replacing_together

from . import options, outputs, report

_SEED = 0
_PLANNED, _JUDGED = 2000, 8000
_PICTURES = ("probability.png", "drift.png", "plan.png", "pos.png")
_TABLE, _GPX = "routes.csv", "routes.gpx"
_ELLIPSE = 0.9
_DATUM_STEP_S = 3600.0
_POINTS_A_LEG = 20
_NOTED_SHARE = 0.001


def add_to(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command to its parser."""
    parser.description = (
        "Drifts a cloud of particles from the last known position, plans the search of "
        "each unit for the highest probability of success (POS), and compares the plan with a "
        "naive square about the datum and with a bound. Writes routes (CSV, GPX) and pictures."
    )
    parser.add_argument(
        "scenario",
        metavar="SCENARIO.toml",
        help=f"a file, or a bundled scenario: {', '.join(ws.example_names())}",
    )
    options.add_results(parser, "plan, POS and datum as JSON")
    parser.set_defaults(run=run, inputs=inputs)


def inputs(arguments: argparse.Namespace) -> list[Path]:
    """The input file of the command line."""
    return [Path(arguments.scenario)]


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    scenario = ws.read_scenario(arguments.scenario)
    outputs.make_folder(arguments.out)
    planned = scenario.cloud(_PLANNED, _SEED)
    judged = scenario.cloud(_JUDGED, _SEED + 1)
    try:
        plan = ws.optimized_plan(
            scenario.units, planned, scenario.law, scenario.patterns, _SEED, progress=True
        )
    except ValueError as error:  # a unit cannot reach the datum
        raise ValueError(f"{arguments.scenario}: {error}") from None
    naive = ws.naive_plan(scenario.units, judged, scenario.law)
    bound = ws.greedy_bound(plan, judged)
    pos = {"plan": plan.pos(judged), "naive": naive.pos(judged), "bound": bound.pos(judged)}
    sorties = _sorties(scenario, judged, plan)

    for line in _head(scenario, judged, plan):
        print(line)
    print(f"\n{report.aligned(_table(sorties), left=2)}\n")
    print("POS: " + ", ".join(f"{name} {100 * value:.1f} %" for name, value in pos.items()))

    earlier = [arguments.out / name for name in (_TABLE, _GPX, *_PICTURES)]
    with replacing_together(arguments.out, earlier) as fresh:
        files = [fresh / _TABLE, fresh / _GPX]
        ws.write_routes(files[0], plan, scenario)
        ws.write_gpx(files[1], plan, scenario)
        if outputs.can_draw():
            figures = plot.search_figures(scenario, judged, plan, naive, bound)
            for name, figure in figures.items():
                files.append(fresh / f"{name}.png")
                plot.save(figure, files[-1])
    print(f"written to {arguments.out}: {', '.join(file.name for file in files)}")
    if not outputs.can_draw():
        print(outputs.HOW_TO_GET_PICTURES)
    if arguments.json is not None:
        rows = [
            {"scenario": scenario.name, "estimator": name, "pos_predicted": value}
            for name, value in pos.items()
        ]
        outputs.write_json(
            arguments.json,
            "search",
            rows,
            seed=_SEED,
            sorties=sorties,
            datum=_datum(scenario, judged),
            ashore_share=_ashore(judged),
        )


def _head(scenario: ws.SearchScenario, cloud: ws.Cloud, plan: ws.Plan) -> list[str]:
    """What is searched for and where it is, and notes."""
    kind = navigation.leeway_kinds()[scenario.search_object.kind]
    begin_s = min(sortie.time_s[0] for sortie in plan.sorties)
    latitude_deg, longitude_deg = scenario.degrees(cloud.datum(begin_s))
    lines = [
        f"{scenario.name}: {kind}",
        f"datum after {begin_s / 3600.0:.1f} h: {latitude_deg:.4f}, {longitude_deg:.4f}",
    ]
    if _ashore(cloud) > _NOTED_SHARE:
        lines.append(f"note: {_ashore(cloud):.1%} of the particles drift ashore and stay there")
    for sortie in plan.sorties:
        if _crosses_land(scenario, sortie):
            lines.append(f"note: the route of {sortie.unit.name} crosses land")
    return lines


def _ashore(cloud: ws.Cloud) -> float:
    return float(cloud.ashore.mean())


def _crosses_land(scenario: ws.SearchScenario, sortie: ws.Sortie) -> bool:
    _, points_m = ws.route_points(sortie)
    share = np.linspace(0.0, 1.0, _POINTS_A_LEG)[:, None, None]
    between_m = (1.0 - share) * points_m[:-1] + share * points_m[1:]
    return bool(ws.on_land(between_m.reshape(-1, 2), scenario.land).any())


def _sorties(scenario: ws.SearchScenario, cloud: ws.Cloud, plan: ws.Plan) -> list[dict[str, Any]]:
    """Each sortie in order of units, with POC and POD by area and POS by particles.

    POC is that of the object not found by the sorties before; POS sums to that of the plan.
    """
    described, whole = [], cloud
    for sortie in plan.sorties:
        unit, pattern, poc = sortie.unit, sortie.pattern, sortie.poc(cloud)
        before = cloud.weight.sum()
        cloud = cloud.searched(sortie.potential(cloud, plan.law))
        met = unit.intercept(whole)
        along_m, across_m = pattern.sides_m
        time_s, position_m = ws.route_points(sortie)
        degrees = scenario.degrees(position_m)
        center_deg = scenario.degrees(pattern.center_m)
        described.append(
            {
                "unit": unit.name,
                "pattern": pattern.kind,
                "center_lat_deg": float(center_deg[0]),
                "center_lon_deg": float(center_deg[1]),
                "orientation_deg": float(np.degrees(pattern.orientation_rad) % 360.0),
                "track_spacing_m": float(pattern.spacing_m),
                "length_m": float(along_m),
                "width_m": float(across_m),
                "commence_h": float(sortie.time_s[0] / 3600.0),
                "end_h": float(sortie.time_s[-1] / 3600.0),
                "coverage": float(sortie.coverage),
                "poc": poc,
                "pod": float(navigation.parallel_track_pod(plan.law, sortie.coverage)),
                "pos": float(before - cloud.weight.sum()),
                "intercept_h": (unit.start_s + met.time_s) / 3600.0,
                "intercept_course_deg": float(np.degrees(met.course_rad)),
                "intercept_std_m": float(np.sqrt(np.trace(met.covariance_m2))),
                "route": [
                    {"time_h": float(t / 3600.0), "lat_deg": float(a), "lon_deg": float(b)}
                    for t, a, b in zip(time_s, *degrees, strict=True)
                ],
            }
        )
    return described


def _table(sorties: list[dict[str, Any]]) -> list[list[str]]:
    rows = [
        [
            "unit",
            "pattern",
            "spacing m",
            "area km",
            "from h",
            "to h",
            "coverage",
            "POC %",
            "POD %",
            "POS %",
        ]
    ]
    for one in sorties:
        rows.append(
            [
                one["unit"],
                one["pattern"].replace("_", " "),
                f"{one['track_spacing_m']:.0f}",
                f"{one['length_m'] / 1000:.1f} x {one['width_m'] / 1000:.1f}",
                f"{one['commence_h']:.2f}",
                f"{one['end_h']:.2f}",
                f"{one['coverage']:.2f}",
                *(f"{100 * one[name]:.1f}" for name in ("poc", "pod", "pos")),
            ]
        )
    return rows


def _datum(scenario: ws.SearchScenario, cloud: ws.Cloud) -> list[dict[str, float]]:
    """The datum every hour, with the ellipse of 90 %."""
    rows = []
    for time_s in np.arange(0.0, cloud.time_s[-1] + 1.0, _DATUM_STEP_S):
        place_deg = scenario.degrees(cloud.datum(time_s))
        variances_m2 = np.linalg.eigvalsh(cloud.covariance_m2(time_s))
        minor_m, major_m = np.sqrt(-2.0 * np.log(1.0 - _ELLIPSE) * np.maximum(variances_m2, 0.0))
        rows.append(
            {
                "time_h": float(time_s / 3600.0),
                "lat_deg": float(place_deg[0]),
                "lon_deg": float(place_deg[1]),
                "semi_major_m": float(major_m),
                "semi_minor_m": float(minor_m),
            }
        )
    return rows
