"""Drift, detection and search plans: laws, against independent computations."""

import csv
import json
import math
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wakeline as wl
from wakeline import navigation as nav
from wakeline import search as ws
from wakeline.cli import main
from wakeline.search.optimizer import _overlap
from wakeline.tracking.settings import SettingsError

HOUR = 3600.0
CALM = ws.Environment(ws.Flow.steady(0.0, 0.0), wind_current=False)
EXACT = {"wind_std_mps": 0.0, "current_std_mps": 0.0, "residual_std_mps": 0.0, "jibes_per_h": 0.0}


def still_cloud(count=4000, seed=3, until_s=10 * HOUR, std_m=3000.0):
    thing = ws.SearchObject("datum_buoy", position_std_m=std_m, **EXACT)
    return ws.drift(thing, CALM, until_s, count=count, seed=seed)


def unit(**changed):
    given = {
        "name": "boat",
        "position_m": (0.0, -20000.0),
        "start_s": 0.0,
        "endurance_s": 6 * HOUR,
        "transit_mps": 10.0,
        "search_mps": 8.0,
        "sweep_width_m": 600.0,
    }
    return ws.Unit(**given | changed)


# Drift -------------------------------------------------------------------------------------------


def test_every_kind_of_the_table_drifts():
    assert len(nav.leeway_kinds()) >= 16
    wind = ws.Environment(ws.Flow.steady(0.0, 12.0), wind_current=False)
    for kind in nav.leeway_kinds():
        cloud = ws.drift(ws.SearchObject(kind, **EXACT), wind, HOUR, count=400)
        lines = nav.leeway_lines(kind)
        slope, offset, std_slope, std_offset = lines["downwind"]
        speed, spread = 12.0 * slope + offset, 12.0 * std_slope + std_offset
        east_m = cloud.at(HOUR)[:, 1]
        assert np.mean(east_m) / HOUR == pytest.approx(speed, abs=3.5 * spread / 20 + 1e-9)
        assert np.std(east_m) / HOUR == pytest.approx(spread, rel=0.15, abs=1e-9)


@pytest.mark.parametrize("kind", ["buoy", "dinghy", "launch", "ship"])
def test_the_kinds_of_the_paper_have_its_factors(kind):
    least, most = nav.leeway_factor(getattr(nav.FloatingObject, kind))
    wind_mps = np.array([[6.0, -8.0]])
    drift_mps = nav.leeway_mps(kind, wind_mps, error=np.zeros((1, 2)), to_right=np.ones(1))
    assert drift_mps == pytest.approx(nav.wind_drift_mps(wind_mps, 0.5 * (least + most)))


def test_half_drift_to_each_side_and_jibing_mixes_them():
    wind = ws.Environment(ws.Flow.steady(10.0, 0.0), wind_current=False)
    sides = {}
    for jibes_per_h in (0.0, 5.0):
        thing = ws.SearchObject("life_capsule", **EXACT | {"jibes_per_h": jibes_per_h})
        east_m = ws.drift(thing, wind, 6 * HOUR, count=4000).at(6 * HOUR)[:, 1]
        assert np.mean(east_m > 0) == pytest.approx(0.5, abs=0.04)
        sides[jibes_per_h] = np.mean(np.abs(east_m))
    assert sides[5.0] < 0.5 * sides[0.0]


def test_the_drift_does_not_depend_on_the_step():
    scenario = ws.read_scenario("liferaft")
    coarse, fine = (scenario.cloud(6000, seed, step) for seed, step in ((1, 900.0), (2, 100.0)))
    for time_s in (4 * HOUR, 10 * HOUR):
        std_m = np.sqrt(np.diag(fine.covariance_m2(time_s)))
        assert coarse.datum(time_s) == pytest.approx(fine.datum(time_s), abs=0.06 * std_m.max())
        assert np.sqrt(np.diag(coarse.covariance_m2(time_s))) == pytest.approx(std_m, rel=0.05)


def test_errors_have_the_moments_of_the_forecast():
    """The cloud of a kind of the paper against the exact Gaussian of `drift_forecast`."""
    thing = ws.SearchObject("dinghy", position_std_m=300.0, jibes_per_h=0.0)
    wind = ws.Environment(ws.Flow.steady(3.0, 8.0), wind_current=False)
    cloud = ws.drift(thing, wind, 5 * HOUR, count=20000)
    start = wl.Gaussian(np.zeros(2), 300.0**2 * np.eye(2))
    model = wl.DriftModel.of(nav.FloatingObject.dinghy)
    dt_s, wind_mps, still = np.full(5, HOUR), np.tile([3.0, 8.0], (5, 1)), np.zeros((5, 2))
    mean, covariance = wl.drift_forecast(model, start, dt_s, wind_mps, still)
    std_m = np.sqrt(np.diag(covariance[-1]))
    assert cloud.datum(5 * HOUR) == pytest.approx(mean[-1], abs=0.04 * std_m.max())
    assert np.sqrt(np.diag(cloud.covariance_m2(5 * HOUR))) == pytest.approx(std_m, rel=0.04)


def test_an_unknown_time_spreads_the_cloud_along_the_drift():
    current = ws.Environment(
        ws.Flow.steady(0.0, 0.0), current=ws.Flow.steady(0.5, 0.0), wind_current=False
    )
    thing = ws.SearchObject("datum_buoy", time_std_s=1200.0, **EXACT)
    north_m, east_m = ws.drift(thing, current, 6 * HOUR, count=4000).at(6 * HOUR).T
    assert np.std(north_m) == pytest.approx(0.5 * 1200.0, rel=0.05)
    assert np.mean(north_m) == pytest.approx(0.5 * 6 * HOUR, abs=40.0)
    assert np.ptp(east_m) == 0.0


def test_a_tide_returns_what_it_took():
    tide = ws.Tide(period_s=12 * HOUR, major_mps=0.8, minor_mps=0.2, direction_rad=0.7)
    env = ws.Environment(ws.Flow.steady(0.0, 0.0), tides=(tide,), wind_current=False)
    cloud = ws.drift(ws.SearchObject("datum_buoy", **EXACT), env, 12 * HOUR, count=2)
    assert cloud.at(12 * HOUR) == pytest.approx(np.zeros((2, 2)), abs=1.0)
    farthest = np.abs(cloud.position_m[0] @ [math.cos(0.7), math.sin(0.7)]).max()
    assert farthest == pytest.approx(0.8 * 12 * HOUR / (2 * math.pi), rel=1e-3)


def test_the_wind_current_is_that_of_the_equation():
    wind_mps = np.array([[0.0, 5.0], [0.0, 15.0]])
    env = ws.Environment(ws.Flow.steady(0, 5), latitude_rad=math.radians(50.0))
    found = env.water_mps(0.0, np.zeros((2, 2)), wind_mps)
    factor = nav.wind_current_factor([5.0, 15.0])
    speed = factor * [5.0, 15.0] / math.sqrt(math.sin(math.radians(50.0)))
    assert np.hypot(*found.T) == pytest.approx(speed)
    assert np.degrees(np.arctan2(found[:, 1], found[:, 0])) == pytest.approx([135.0, 135.0])
    assert nav.wind_current_factor([2.0, 20.0]) == pytest.approx([0.04, 0.012])


def test_a_field_is_linear_between_its_places_and_times():
    north_m, east_m, time_s = np.array([0.0, 1000.0]), np.array([-500.0, 0.0, 900.0]), [0.0, 60.0]
    t, n, e = np.meshgrid(time_s, north_m, east_m, indexing="ij")
    flow = ws.Flow(time_s, np.stack([t + 2 * n, 3 * e - n], axis=-1), north_m, east_m)
    place_m = np.array([[250.0, -100.0], [999.0, 450.0], [5000.0, 0.0]])
    assert flow.at(15.0, place_m)[:2] == pytest.approx(
        np.column_stack([15 + 2 * place_m[:2, 0], 3 * place_m[:2, 1] - place_m[:2, 0]])
    )
    assert flow.at(15.0, place_m)[2] == pytest.approx([15 + 2000, -1000])  # that of the edge


def test_what_reaches_land_stays_there():
    land = np.array([[-9e4, 5e3], [9e4, 5e3], [9e4, 9e3], [-9e4, 9e3]])
    current = ws.Environment(
        ws.Flow.steady(0.0, 0.0), current=ws.Flow.steady(0.0, 0.5), wind_current=False
    )
    thing = ws.SearchObject("datum_buoy", position_std_m=500.0, **EXACT)
    cloud = ws.drift(thing, current, 12 * HOUR, count=300, land=[land])
    assert cloud.ashore.all()
    assert not ws.on_land(cloud.at(12 * HOUR), [land]).any()
    assert cloud.at(12 * HOUR)[:, 1].min() > 4000.0


# Detection ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", ws.DETECTION_LAWS)
def test_simulated_parallel_tracks_have_the_pod_of_their_coverage(law):
    rng = np.random.default_rng(5)
    spacing_m, width_m, tracks = 900.0, 700.0, 41
    object_m = np.repeat(rng.uniform(-0.5, 0.5, (3000, 1, 2)) * [8000.0, spacing_m], 2, axis=1)
    total = np.zeros(3000)
    for k in range(-(tracks // 2), tracks // 2 + 1):
        unit_m = np.array([[-2e5, k * spacing_m], [2e5, k * spacing_m]])
        total += nav.detection_potential(law, width_m, [0.0, 1e4], unit_m, [0.0, 1e4], object_m)
    pod = float(nav.parallel_track_pod(law, width_m / spacing_m))
    assert np.mean(-np.expm1(-total)) == pytest.approx(pod, abs=0.02)


@settings(max_examples=40, deadline=None)
@given(st.floats(0.1, 5000.0), st.floats(100.0, 3000.0), st.sampled_from(ws.DETECTION_LAWS))
def test_a_pass_is_detected_less_the_farther_it_is(range_m, width_m, law):
    near, far = nav.pass_probability(law, [range_m, 1.1 * range_m], width_m)
    assert 0.0 <= far <= near <= 1.0
    assert nav.pass_probability(law, -range_m, width_m) == near


def test_potentials_of_the_parts_of_a_sortie_add_up():
    cloud = still_cloud(300)
    plan = ws.naive_plan([unit()], cloud)
    whole = plan.potential(cloud)
    sortie = plan.sorties[0]
    middle_s = sortie.time_s.mean()
    parts = [sortie.potential(cloud, plan.law, a, b) for a, b in ((-1, middle_s), (middle_s, 1e9))]
    assert sum(parts) == pytest.approx(whole)
    over_time = plan.pos_over_time(cloud, np.linspace(*sortie.time_s[[0, -1]], 9))
    assert over_time[-1] == pytest.approx(plan.pos(cloud))
    assert (np.diff(over_time) >= 0).all()


def test_bayes_after_sorties_without_success():
    cloud = still_cloud(500)
    first, second = (
        ws.naive_plan([unit()], cloud, kind=kind) for kind in ("expanding_square", "sector")
    )
    after = cloud.searched(first.potential(cloud)).searched(second.potential(cloud))
    both = ws.Plan((*first.sorties, *second.sorties))
    assert after.weight.sum() == pytest.approx(1.0 - both.pos(cloud))
    assert both.pos(cloud) == pytest.approx(
        first.pos(cloud) + second.pos(cloud.searched(first.potential(cloud)))
    )


# Patterns ----------------------------------------------------------------------------------------


def patterns():
    for kind in ws.PATTERNS:
        yield ws.Pattern(kind, (2000.0, -500.0), 0.4, 700.0, 60000.0, legs=6)
        yield ws.Pattern(kind, (0.0, 0.0), 4.0, 1500.0, 80000.0, legs=9, mirrored=True)


@pytest.mark.parametrize("pattern", list(patterns()), ids=lambda p: p.kind)
def test_a_pattern_uses_its_length_within_its_area(pattern):
    points_m = pattern.turning_points_m()
    legs_m = np.hypot(*np.diff(points_m, axis=0).T)
    assert legs_m.sum() == pytest.approx(pattern.length_m)
    assert pattern.holds(points_m + 0.01 * (pattern.center_m - points_m)).mean() > 0.9
    assert pattern.holds(pattern.center_m[None])[0]
    first_rad = math.atan2(*np.diff(points_m[:2], axis=0)[0][::-1])
    assert math.cos(first_rad - pattern.orientation_rad) == pytest.approx(1.0)


def test_tracks_are_a_spacing_apart_and_half_a_spacing_inside():
    p = ws.Pattern("parallel_sweep", (0.0, 0.0), 0.0, 500.0, 44500.0, legs=8)
    points_m = p.turning_points_m()
    assert np.unique(np.round(points_m[:, 1], 6)) == pytest.approx(-1750.0 + 500.0 * np.arange(8))
    along_m, across_m = p.sides_m
    assert across_m == 8 * 500.0
    assert np.abs(points_m[:, 0]).max() == pytest.approx(0.5 * along_m - 250.0)


def test_an_expanding_square_has_legs_of_one_one_two_two():
    p = ws.Pattern("expanding_square", (0.0, 0.0), 0.0, 100.0, 1200.0)
    legs_m = np.diff(p.turning_points_m(), axis=0)
    assert np.hypot(*legs_m.T) == pytest.approx([100, 100, 200, 200, 300, 300])
    turned = legs_m[:-1, 0] * legs_m[1:, 1] - legs_m[:-1, 1] * legs_m[1:, 0]
    assert (turned > 0).all()  # to starboard


def test_a_sector_search_passes_its_datum_and_turns_its_second_pass():
    p = ws.Pattern("sector", (0.0, 0.0), 0.0, 1000.0, 18000.0)
    points_m = p.turning_points_m()
    at_datum = np.flatnonzero(np.hypot(*points_m.T) < 1e-6)
    assert at_datum.tolist() == [0, 3, 6, 9, 12, 15, 18]
    assert np.hypot(*points_m.T).max() == pytest.approx(1000.0)
    first_rad, second_rad = (math.atan2(*points_m[k + 1][::-1]) for k in (0, 9))
    assert second_rad - first_rad == pytest.approx(math.radians(30.0))


# Plans -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", ws.DETECTION_LAWS)
def test_the_plan_is_never_worse_than_the_naive_one_nor_better_than_the_bound(law):
    cloud = still_cloud(3000)
    for kind in ("parallel_sweep", "expanding_square"):
        plan = ws.optimized_plan([unit()], cloud, law, [kind])
        assert ws.naive_plan([unit()], cloud, law, kind).pos(cloud) <= plan.pos(cloud)
        assert plan.pos(cloud) <= ws.greedy_bound(plan, cloud).pos(cloud) + 0.01


def test_units_that_search_at_the_same_time_have_areas_of_their_own():
    cloud = still_cloud(800, std_m=6000.0)
    units = [
        unit(),
        unit(name="second", start_s=HOUR),
        unit(name="late", start_s=7 * HOUR, endurance_s=3 * HOUR),
    ]
    plan = ws.optimized_plan(units, cloud, kinds=["parallel_sweep", "creeping_line"])
    a, b, late = plan.sorties
    assert not _overlap(a, b)
    assert late.time_s[0] >= a.time_s[-1]
    for sortie in plan.sorties:
        run_m = np.hypot(*np.diff(sortie.position_m, axis=0).T).sum()
        spent_s = sortie.time_s[-1] - sortie.unit.start_s
        assert spent_s == pytest.approx(sortie.unit.endurance_s, rel=1e-3)
        assert run_m == pytest.approx(8.0 * np.ptp(sortie.time_s), rel=1e-3)


def test_the_bound_spends_the_effort_of_the_plan():
    cloud = still_cloud(2000)
    plan = ws.naive_plan([unit()], cloud)
    bound = ws.greedy_bound(plan, cloud)
    cell_m2 = np.diff(bound.north_m)[0] * np.diff(bound.east_m)[0]
    assert bound.coverage.sum() * cell_m2 == pytest.approx(
        600.0 * 8.0 * np.ptp(plan.sorties[0].time_s), rel=1e-3
    )
    assert bound.pos_over_time(cloud)[-1] == pytest.approx(bound.pos(cloud))


def test_the_probability_map_sums_to_one():
    cloud = still_cloud(2000)
    cells = ws.map_cells(cloud, 0.0, HOUR)
    assert ws.probability_map(cloud, 0.0, *cells).sum() == pytest.approx(1.0)


@given(st.integers(0, 10**6))
@settings(max_examples=30, deadline=None)
def test_an_intercept_meets_the_object(seed):
    rng = np.random.default_rng(seed)
    mean = rng.normal(0.0, [5000.0, 4.0, 5000.0, 4.0])
    place_m, speed_mps = rng.normal(0.0, 5000.0, 2), rng.uniform(1.0, 12.0)
    met = nav.intercept(wl.Gaussian(mean, np.eye(4)), place_m, speed_mps)
    if np.hypot(mean[1], mean[3]) < speed_mps:
        assert met.found
    if met.found:
        way_m = speed_mps * met.time_s * np.array([np.cos(met.course_rad), np.sin(met.course_rad)])
        assert place_m + way_m == pytest.approx(met.position_m, abs=1e-5)
        assert met.position_m == pytest.approx(mean[::2] + met.time_s * mean[1::2])


# Input -------------------------------------------------------------------------------------------

SCENARIO = """
[object]
kind = "skiff"
lat_deg = 50.0
lon_deg = -4.0
position_std_m = 500
[wind]
time_h = [0, 12]
speed_mps = [6.0, 9.0]
from_deg = [270, 300]
[[unit]]
name = "pilot boat"
lat_deg = 50.2
lon_deg = -4.1
start_h = 1
speed_kn = 15
endurance_h = 5
sweep_width_m = 700
"""


def read(tmp_path, text=SCENARIO, **files):
    for name, content in files.items():
        (tmp_path / f"{name}.csv").write_text(content)
    path = tmp_path / "scenario.toml"
    path.write_text(text)
    return ws.read_scenario(path)


def test_a_scenario_is_read_in_its_units(tmp_path):
    scenario = read(tmp_path)
    (boat,) = scenario.units
    assert (boat.start_s, boat.end_s, boat.sweep_width_m) == (HOUR, 6 * HOUR, 700.0)
    assert boat.search_mps == boat.transit_mps == pytest.approx(15 * 1852 / 3600)
    assert scenario.degrees(boat.position_m) == pytest.approx((50.2, -4.1))
    blows_mps = scenario.environment.wind.at(0.0, np.zeros((1, 2)))
    assert blows_mps[0] == pytest.approx([0.0, 6.0], abs=1e-9)
    assert scenario.patterns == tuple(ws.PATTERNS)


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ("sweep_width_m = 700", "sweep_width_m = 0", "[unit 1] sweep_width_m"),
        ("sweep_width_m = 700", "", "[unit 1] sweep_width_m"),
        ("time_h = [0, 12]", "time_h = [0, 5]", "wind"),
        ("time_h = [0, 12]", "time_h = [2, 12]", "wind"),
        ("time_h = [0, 12]", "time_h = [12, 0]", "[wind] time_h"),
        ("time_h = [0, 12]", "time_h = [0]", "[wind] time_h"),
        ("[6.0, 9.0]", "[6.0, nan]", "[wind] speed_mps"),
        ('"skiff"', '"submarine"', "[object] kind"),
        ("speed_kn = 15", "speed_knots = 15", "[unit 1] speed_kn"),
        ("start_h = 1", "start_h = 1\ncolour = 3", "[unit 1] colour"),
        ("lat_deg = 50.0", "lat_deg = 10.0", "[current] wind_current"),
        ("lat_deg = 50.0", "lat_deg = 95.0", "[object] lat_deg"),
        ("[[unit]]", "[[boat]]", "unit"),
        ("[wind]", "[[land]]\nlat_deg=[49,51,51,49]\nlon_deg=[-5,-5,-3,-3]\n[wind]", "[object]"),
        ("[wind]", "[[land]]\nlat_deg=[49,51]\nlon_deg=[-5,-5]\n[wind]", "[land 1] lat_deg"),
    ],
)
def test_a_bad_scenario_names_file_and_key(tmp_path, old, new, named):
    with pytest.raises(SettingsError) as error:
        read(tmp_path, SCENARIO.replace(old, new))
    assert "scenario.toml" in str(error.value)
    assert named in str(error.value)


def test_a_unit_that_cannot_reach_is_named(tmp_path):
    scenario = read(tmp_path, SCENARIO.replace("endurance_h = 5", "endurance_h = 0.5"))
    cloud = scenario.cloud(200)
    for plan in (ws.naive_plan, ws.optimized_plan):
        with pytest.raises(ValueError, match="pilot boat"):
            plan(scenario.units, cloud)


def test_wind_from_a_file_is_a_series_or_a_field(tmp_path):
    text = SCENARIO.replace("time_h = [0, 12]", 'file = "wind.csv"').replace(
        "speed_mps = [6.0, 9.0]\nfrom_deg = [270, 300]", ""
    )
    series = read(tmp_path, text, wind="time_h,speed_mps,from_deg\n0,6,270\n12,9,300\n")
    assert series.environment.wind.at(6 * HOUR, np.zeros((1, 2))) == pytest.approx(
        read(tmp_path).environment.wind.at(6 * HOUR, np.zeros((1, 2)))
    )
    rows = [
        f"{t},{lat},{lon},{5 + t + 10 * (lat - 50)},270"
        for t in (0, 12)
        for lat in (49.5, 50.5)
        for lon in (-5, -3)
    ]
    header = "time_h,lat_deg,lon_deg,speed_mps,from_deg\n"
    field = read(tmp_path, text, wind=header + "\n".join(rows)).environment.wind
    assert field.at(0.0, np.array([[0.0, 0.0]]))[0] == pytest.approx([0.0, 5.0], abs=0.01)
    assert field.at(0.0, np.array([[22240.0, 0.0]]))[0, 1] == pytest.approx(7.0, abs=0.05)
    with pytest.raises(wl.recording.RecordingError, match=r"wind\.csv"):
        read(tmp_path, text, wind=header + "\n".join(rows[:-1]))
    with pytest.raises(wl.recording.RecordingError, match=r"line 3.*speed_mps"):
        read(tmp_path, text, wind="time_h,speed_mps,from_deg\n0,6,270\n12,,300\n")


def test_earlier_sorties_without_success_update_the_cloud(tmp_path):
    before = read(tmp_path)
    cloud = before.cloud(2000)
    plan = ws.naive_plan(before.units, cloud)
    ws.write_routes(tmp_path / "routes.csv", plan, before)
    more = '[[searched]]\nfile = "routes.csv"\nsweep_width_m = 700\n'
    after = read(tmp_path, SCENARIO + more)
    expected = cloud.searched(plan.potential(cloud)).weight
    found = after.cloud(2000)
    assert found.weight == pytest.approx(expected / expected.sum(), abs=2e-6)
    assert plan.pos(found) < plan.pos(cloud)
    with pytest.raises(SettingsError, match="searched 1"):
        read(tmp_path, SCENARIO + more + 'unit = "frigate"')
    (tmp_path / "routes.csv").write_text("time_h,lat_deg,lon_deg\n2,50,-4\n1,50,-4\n")
    with pytest.raises(wl.recording.RecordingError, match=r"routes\.csv"):
        read(tmp_path, SCENARIO + more)


# The command -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def searched(tmp_path_factory):
    folder = tmp_path_factory.mktemp("search")
    file = folder / "plan.json"
    assert main(["search", "liferaft", "--out", str(folder), "--json", str(file)]) == 0
    return folder, json.loads(file.read_text())


def test_the_command_plans_a_tenth_more_than_the_naive_plan(searched):
    _, result = searched
    pos = {row["estimator"]: row["pos_predicted"] for row in result["rows"]}
    assert 1.1 * pos["naive"] <= pos["plan"] <= pos["bound"]
    assert sum(one["pos"] for one in result["sorties"]) == pytest.approx(pos["plan"])


def test_the_command_writes_routes_that_units_can_run(searched):
    folder, result = searched
    with (folder / "routes.csv").open() as file:
        rows = list(csv.DictReader(file))
    space = {"g": "http://www.topografix.com/GPX/1/1"}
    routes = ElementTree.parse(folder / "routes.gpx").getroot().findall("g:rte", space)
    for sortie, route in zip(result["sorties"], routes, strict=True):
        mine = [row for row in rows if row["unit"] == sortie["unit"]]
        points = route.findall("g:rtept", space)
        assert len(mine) == len(points) == len(sortie["route"])
        assert [float(row["lat_deg"]) for row in mine] == [float(p.get("lat")) for p in points]
        assert float(mine[-1]["time_h"]) == pytest.approx(sortie["end_h"], abs=1e-3)
        assert mine[0]["time_utc"].startswith("2026-03-14T")
    for name in ("probability", "drift", "plan", "pos"):
        assert (folder / f"{name}.png").stat().st_size > 10_000


def test_the_command_reports_bad_input_in_one_line(tmp_path, capsys):
    path = tmp_path / "bad.toml"
    path.write_text(SCENARIO.replace("sweep_width_m = 700", "sweep_width_m = 0"))
    for source in (path, tmp_path / "missing.toml"):
        assert main(["search", str(source), "--out", str(tmp_path / "out")]) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert source.name in line
