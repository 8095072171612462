"""Labels beside points of a map that do not overlap."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

_AWAY_PT = 3.0
_SIDES = ((1, -1), (1, 1), (-1, -1), (-1, 1), (1, 0), (-1, 0), (0, -1), (0, 1))
_ACROSS = {1: "left", 0: "center", -1: "right"}
_UP = {1: "bottom", 0: "center", -1: "top"}


class ClearLabels(Artist):
    """Moves labels to free positions whenever the axes are drawn.

    Each moves to the side of its point where it covers the fewest lines. It is hidden if every side
    has text, the point of another label, or too little room within the axes.

    Parameters
    ----------
    labels : sequence of Annotation
        At points in data coordinates; the first have priority.
    clear_pt : float
        Radius around each point that remains clear.
    """

    def __init__(self, labels: Sequence[Annotation], clear_pt: float) -> None:
        super().__init__()
        self._labels = labels
        self._clear_pt = clear_pt
        for artist in (self, *labels):
            artist.set_in_layout(False)

    def draw(self, renderer: RendererBase) -> None:
        """Place the labels; the axes draw them afterwards, as texts."""
        window = self.axes.get_window_extent(renderer)
        ways = [line.get_transform().transform_path(line.get_path()) for line in self.axes.lines]
        clear = renderer.points_to_pixels(self._clear_pt)
        taken = [_around(label, clear) for label in self._labels]
        taken += _written(self.axes, self._labels, renderer)
        for label in self._labels:
            free = [
                (sum(way.intersects_bbox(box, filled=False) for way in ways), side, box)
                for side, box in self._boxes(label, renderer)
                if _holds(window, box) and not box.count_overlaps(taken)
            ]
            label.set_visible(bool(free))
            if free:
                _, side, box = min(free, key=lambda choice: choice[0])
                self._put(label, side)
                taken.append(_apart(box, renderer))

    def _boxes(
        self, label: Annotation, renderer: RendererBase
    ) -> Iterator[tuple[tuple[int, int], Bbox]]:
        """The sides of a point, and what the label would cover there."""
        label.set_visible(True)
        for side in _SIDES:
            self._put(label, side)
            yield side, label.get_window_extent(renderer)

    def _put(self, label: Annotation, side: tuple[int, int]) -> None:
        right, up = side
        away_pt = (self._clear_pt + _AWAY_PT) / (1.0 if 0 in side else np.sqrt(2.0))
        label.set(ha=_ACROSS[right], va=_UP[up], position=(right * away_pt, up * away_pt))


class LoneLabels(Artist):
    """Hides labels that would cover an earlier one, whenever the axes are drawn.

    Parameters
    ----------
    labels : sequence of Annotation
        They do not move.
    """

    def __init__(self, labels: Sequence[Annotation]) -> None:
        super().__init__()
        self._labels = labels
        self.set_in_layout(False)

    def draw(self, renderer: RendererBase) -> None:
        """Choose the labels; the axes draw them afterwards, as texts."""
        taken: list[Bbox] = []
        for label in self._labels:
            label.set_visible(True)
            box = label.get_window_extent(renderer)
            label.set_visible(not box.count_overlaps(taken))
            if label.get_visible():
                taken.append(box)


def _around(label: Annotation, radius: float) -> Bbox:
    """The square around the point of a label, in pixels."""
    place = label.axes.transData.transform(label.xy)
    return Bbox([place - radius, place + radius])


def _written(ax: Axes, labels: Sequence[Annotation], renderer: RendererBase) -> list[Bbox]:
    """Boxes of the other texts of the axes."""
    others = (text for text in ax.texts if text not in labels and text.get_visible())
    return [_apart(text.get_window_extent(renderer), renderer) for text in others]


def _apart(box: Bbox, renderer: RendererBase) -> Bbox:
    """Box that another text must not cover, so that they are not read as one line."""
    away = renderer.points_to_pixels(2.0 * _AWAY_PT)
    return Bbox.from_extents(box.x0 - away, box.y0, box.x1 + away, box.y1)


def _holds(window: Bbox, box: Bbox) -> bool:
    return bool((window.min <= box.min).all() and (box.max <= window.max).all())
