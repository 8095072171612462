"""Search for a drifting object: its drift, where it probably is, and how to look for it.

>>> import wakeline as wl
>>> scenario = wl.search.read_scenario("liferaft")
>>> cloud = scenario.cloud(count=1000)
>>> plan = wl.search.optimized_plan(scenario.units, cloud, scenario.law)
>>> plan.pos(cloud) >= wl.search.naive_plan(scenario.units, cloud, scenario.law).pos(cloud)
True

Terms are those of the IAMSAR Manual: the datum is the most probable position of the object, POC
the probability that an area contains it, POD the probability of detecting it there, POS = POC POD
the probability that a search succeeds. Leeway, detection and interception are functions of
`wakeline.navigation`.
"""

from .cells import Allocation, greedy_bound, map_cells, probability_map
from .drift import Cloud, SearchObject, drift, on_land
from .environment import Environment, Flow, Tide
from .optimizer import optimized_plan
from .patterns import PATTERNS, Pattern, datum_square
from .plan import DETECTION_LAWS, Plan, Sortie, Track, Unit, naive_plan, success
from .routes import route_points, write_gpx, write_routes
from .scenario import SearchScenario, example_names, read_scenario

__all__ = [
    "DETECTION_LAWS",
    "PATTERNS",
    "Allocation",
    "Cloud",
    "Environment",
    "Flow",
    "Pattern",
    "Plan",
    "SearchObject",
    "SearchScenario",
    "Sortie",
    "Tide",
    "Track",
    "Unit",
    "datum_square",
    "drift",
    "example_names",
    "greedy_bound",
    "map_cells",
    "naive_plan",
    "on_land",
    "optimized_plan",
    "probability_map",
    "read_scenario",
    "route_points",
    "success",
    "write_gpx",
    "write_routes",
]
