"""Figures of recordings, tracks and studies with matplotlib (installed by the extra ``plot``).

:func:`map` draws the tracks of a recording, :func:`screen` those of radar video. Each ``..._view``
and ``..._panel`` draws into the caller's axes or figure; :func:`map`, :func:`screen` and each
``..._figure`` make a figure, which :func:`save` writes.
"""

from .calibration import calibration_figure
from .comparison import (
    error_panel,
    mark_switches,
    paths_view,
    probability_panel,
    ranking_panel,
    steps_panel,
    turn_colors,
    turn_rate_panel,
)
from .maps import ellipse_outline, map, map_view
from .own_ship import (
    biases_over_time,
    course_over_time,
    drift_over_time,
    own_map,
    own_map_figure,
    own_time_figure,
    speed_over_time,
)
from .ppi import circle_outline, echo, ppi, screen, screen_raster, window_outline
from .search import drift_view, plan_view, pos_panel, probability_view, search_figures
from .style import (
    INK,
    MUTED,
    PALETTE,
    TEXT_PT,
    dress,
    dress_map,
    figure,
    halo,
    name_lines,
    save,
    track_colors,
)
from .time import (
    course_panel,
    draw_bands,
    mode_panel,
    nis_panel,
    speed_panel,
    time_figure,
    time_view,
)

__all__ = [
    "INK",
    "MUTED",
    "PALETTE",
    "TEXT_PT",
    "biases_over_time",
    "calibration_figure",
    "circle_outline",
    "course_over_time",
    "course_panel",
    "draw_bands",
    "dress",
    "dress_map",
    "drift_over_time",
    "drift_view",
    "echo",
    "ellipse_outline",
    "error_panel",
    "figure",
    "halo",
    "map",
    "map_view",
    "mark_switches",
    "mode_panel",
    "name_lines",
    "nis_panel",
    "own_map",
    "own_map_figure",
    "own_time_figure",
    "paths_view",
    "plan_view",
    "pos_panel",
    "ppi",
    "probability_panel",
    "probability_view",
    "ranking_panel",
    "save",
    "screen",
    "screen_raster",
    "search_figures",
    "speed_over_time",
    "speed_panel",
    "steps_panel",
    "time_figure",
    "time_view",
    "track_colors",
    "turn_colors",
    "turn_rate_panel",
    "window_outline",
]
