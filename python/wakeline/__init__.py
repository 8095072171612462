"""Wakeline tracks maneuvering vessels with radar.

The engine is C++; its nouns are modules here, and their names are also at the top level:
`wakeline.filter.Ekf` is `wakeline.Ekf`. Python adds recordings, scenarios, scores, pictures and the
`wakeline` command.

Axes are north and east in metres, angles radians clockwise from north, turn rates positive to
starboard.
"""

import sys as _sys
from importlib import import_module as _import_module
from typing import TYPE_CHECKING as _TYPE_CHECKING

from . import _starting as _starting  # first, so that Ctrl-C ends the command while it imports
from ._engine import (
    association,
    batch,
    core,
    eval,
    filter,
    gating,
    measurement,
    motion,
    multimodel,
    navigation,
    track,
    video,
    wire,
)
from ._engine.batch import lanes, set_threads, threads
from ._engine.core import (
    FilterError,
    Gaussian,
    Status,
    Step,
    chi_square_probability,
    chi_square_quantile,
    wrap_angle,
)
from ._engine.eval import consistency_bounds
from ._engine.filter import (
    AdaptiveAlphaBeta,
    AdaptiveExponentialSmoother,
    AdaptiveGains,
    AlphaBeta,
    AlphaBetaGamma,
    AlphaBetaSmoother,
    BenedictBordner,
    ConstantGains,
    CriticallyDamped,
    Ekf,
    ExponentialSmoother,
    Filter,
    GrowingMemory,
    Kalman,
    RangeDependent,
    RecentMemory,
    RunResult,
    SquareRootUkf,
    ThreePointSmoother,
    TrackingIndex,
    Ukf,
    WindowBank,
    one_point,
    stable_gains,
    two_point,
)
from ._engine.gating import (
    ChiSquareGate,
    CovarianceStrobe,
    RadiusGate,
    RangeBearingWindow,
    strobe_echo,
)
from ._engine.measurement import *  # noqa: F403
from ._engine.motion import *  # noqa: F403
from ._engine.multimodel import (
    AdaptiveGridImm,
    BayesianAlphaBeta,
    FuzzyAlphaBeta,
    Imm,
    LikelyModelSetImm,
    ModeChain,
    ModeHistory,
    SwitchingGridImm,
)
from ._engine.navigation import (
    DangerLimits,
    DangerZone,
    DriftModel,
    DriftWindow,
    EncounterWatch,
    FloatingObject,
    LocalPlane,
    UncertaintyEllipse,
    UsvNavigator,
    closest_approach,
    dead_reckon,
    drift_forecast,
    drift_particles,
    geodesic,
    rhumb_line,
)
from ._engine.track import (
    Calibration,
    CalibrationConfig,
    Event,
    LateWindow,
    Radar,
    StrobeTracker,
    StrobeTrackerConfig,
    Tracker,
    TrackerConfig,
    VesselModels,
    vessel_imm,
)
from ._engine.video import LandMask, PlotExtractor, ScanImage, StaticClutterMap

# The engine's nouns, importable as modules of the package.
for _noun in (
    association,
    batch,
    core,
    eval,
    filter,
    gating,
    measurement,
    motion,
    multimodel,
    navigation,
    track,
    video,
    wire,
):
    _sys.modules[f"{__name__}.{_noun.__name__.rpartition('.')[2]}"] = _noun

from . import _pickling as _pickling  # noqa: E402

if _TYPE_CHECKING:
    from . import (
        extraction,
        forecast,
        live,
        metrics,
        montecarlo,
        own_ship,
        plot,
        recording,
        scenario,
        search,
        study,
        tracking,
    )
    from .tracking import track_recording, tune

    __version__: str

__all__ = [
    "AdaptiveAlphaBeta",
    "AdaptiveExponentialSmoother",
    "AdaptiveGains",
    "AdaptiveGridImm",
    "AlphaBeta",
    "AlphaBetaGamma",
    "AlphaBetaSmoother",
    "BayesianAlphaBeta",
    "BenedictBordner",
    "Calibration",
    "CalibrationConfig",
    "ChiSquareGate",
    "ConstantGains",
    "CovarianceStrobe",
    "CriticallyDamped",
    "DangerLimits",
    "DangerZone",
    "DriftModel",
    "DriftWindow",
    "Ekf",
    "EncounterWatch",
    "Event",
    "ExponentialSmoother",
    "Filter",
    "FilterError",
    "FloatingObject",
    "FuzzyAlphaBeta",
    "Gaussian",
    "GrowingMemory",
    "Imm",
    "Kalman",
    "LandMask",
    "LateWindow",
    "LikelyModelSetImm",
    "LocalPlane",
    "ModeChain",
    "ModeHistory",
    "PlotExtractor",
    "Radar",
    "RadiusGate",
    "RangeBearingWindow",
    "RangeDependent",
    "RecentMemory",
    "RunResult",
    "ScanImage",
    "SquareRootUkf",
    "StaticClutterMap",
    "Status",
    "Step",
    "StrobeTracker",
    "StrobeTrackerConfig",
    "SwitchingGridImm",
    "ThreePointSmoother",
    "Tracker",
    "TrackerConfig",
    "TrackingIndex",
    "Ukf",
    "UncertaintyEllipse",
    "UsvNavigator",
    "VesselModels",
    "WindowBank",
    "chi_square_probability",
    "chi_square_quantile",
    "closest_approach",
    "consistency_bounds",
    "dead_reckon",
    "drift_forecast",
    "drift_particles",
    "extraction",
    "forecast",
    "geodesic",
    "lanes",
    "live",
    "metrics",
    "montecarlo",
    "one_point",
    "own_ship",
    "plot",
    "recording",
    "rhumb_line",
    "scenario",
    "search",
    "set_threads",
    "stable_gains",
    "strobe_echo",
    "study",
    "threads",
    "track_recording",
    "tracking",
    "tune",
    "two_point",
    "vessel_imm",
    "wrap_angle",
]
# A new motion model or sensor is at the top level without being listed here.
__all__ += [
    name for noun in (measurement, motion) for name in vars(noun) if not name.startswith("_")
]

# What is imported when it is first used, so that `import wakeline` is quick.
_MODULES = {
    "extraction",
    "forecast",
    "live",
    "metrics",
    "montecarlo",
    "own_ship",
    "plot",
    "recording",
    "scenario",
    "search",
    "study",
    "tracking",
}
_FUNCTIONS = {"track_recording": "tracking", "tune": "tracking"}


def _installed_version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("wakeline")
    except PackageNotFoundError:  # run from a checkout that is not installed
        return "0+unknown"


if not _TYPE_CHECKING:  # to a type checker, the names are those imported above

    def __getattr__(name: str) -> object:
        if name in _MODULES:
            return _import_module(f".{name}", __name__)  # which makes it an attribute
        if name in _FUNCTIONS:
            value = getattr(_import_module(f".{_FUNCTIONS[name]}", __name__), name)
        elif name == "__version__":
            value = _installed_version()
        else:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        globals()[name] = value
        return value

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__, "__version__"})
