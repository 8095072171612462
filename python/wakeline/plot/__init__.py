"""Figures of recordings and tracks, drawn with matplotlib (installed by the extra ``plot``).

Each ``..._view`` and ``..._panel`` draws into axes or a figure of the caller's; ``..._figure``
makes one of its own, which :func:`save` writes.
"""

from .map import ellipse_outline, map_figure, map_view
from .style import dress, figure, save, track_colors
from .time import course_panel, mode_panel, nis_panel, speed_panel, time_figure, time_view

__all__ = [
    "course_panel",
    "dress",
    "ellipse_outline",
    "figure",
    "map_figure",
    "map_view",
    "mode_panel",
    "nis_panel",
    "save",
    "speed_panel",
    "time_figure",
    "time_view",
    "track_colors",
]
