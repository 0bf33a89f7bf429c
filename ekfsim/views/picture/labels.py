"""Obstacles' names and landmarks' numbers, lightly, where they fit."""

from collections.abc import Sequence

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.text import Text
from shapely.geometry.base import BaseGeometry

from ekfsim.geometry import Array
from ekfsim.views.picture.lettering import drawable, families, shortened
from ekfsim.world import Landmark, Map

MOST = 60  # names in one picture; the largest obstacles come first
MOST_NUMBERS = 200  # of landmarks
GAP = 4  # pixels between a name and what stands beside it
MARK = 9  # pixels that a landmark's triangle is wide and high


def label_obstacles(axes: Axes, floor: Map) -> list[Text]:
    """Write the names into the obstacles, or beside them where that covers nothing."""
    if not floor.obstacles:
        return []
    axes.apply_aspect()  # so that metres become pixels as they will when drawn
    outlines = [axes.transData.transform(obstacle.points) for obstacle in floor.obstacles]
    shapes = [shapely.make_valid(shapely.Polygon(outline)) for outline in outlines]
    taken = [
        *shapes,
        *(
            []
            if floor.boundary is None
            else [shapely.LinearRing(axes.transData.transform(floor.boundary))]
        ),
    ]
    window = shapely.box(*axes.bbox.extents)
    order = np.argsort([-shape.area for shape in shapes], kind="stable")[:MOST]
    written = []
    for i in order:
        name = axes.text(0, 0, drawable(shortened(floor.obstacles[i].name, 20)), parse_math=False)
        name.set(
            fontsize=7,
            color="#333333",
            ha="center",
            va="center",
            zorder=1.5,
            gid="name",
            clip_on=True,
        )
        name.set_fontfamily(families())
        size = np.array(name.get_window_extent().size) + GAP
        others = [*taken[:i], *taken[i + 1 :]]
        place = _inside(shapes[i], others, size) or _beside(shapes[i], taken, window, size)
        if place is None:
            name.remove()
            continue
        x, y = axes.transData.inverted().transform(place)
        name.set_position((x, y))
        taken.append(_box(place[0], place[1], size))
        written.append(name)
    return written


def label_landmarks(
    axes: Axes, landmarks: Sequence[Landmark], names: Sequence[Text] = ()
) -> list[Text]:
    """Write each landmark's number beside it,
    where that covers no other landmark, number or name.
    """
    if not landmarks or len(landmarks) > MOST_NUMBERS:
        return []
    axes.apply_aspect()
    places = axes.transData.transform([[mark.x, mark.y] for mark in landmarks])
    marks = [_box(x, y, np.array([MARK, MARK])) for x, y in places]
    taken = [*marks, *(shapely.box(*name.get_window_extent().extents) for name in names)]
    window, written = shapely.box(*axes.bbox.extents), []
    for mark, shape in zip(landmarks, marks, strict=True):
        number = axes.text(
            0, 0, str(mark.id), fontsize=6.5, color="#444444", ha="center", va="center", zorder=1.5
        )
        number.set(gid="number", clip_on=True)
        size = np.array(number.get_window_extent().size) + GAP / 2
        place = _beside(shape, taken, window, size)
        if place is None:
            number.remove()
            continue
        x, y = axes.transData.inverted().transform(place)
        number.set_position((x, y))
        taken.append(_box(*place, size))
        written.append(number)
    return written


def _inside(
    shape: BaseGeometry, others: list[BaseGeometry], size: Array
) -> tuple[float, float] | None:
    """The middle of an obstacle that has room for its name."""
    for point in (shape.centroid, shape.representative_point()):
        box = _box(point.x, point.y, size - GAP)
        if shape.contains(box) and not any(box.intersects(other) for other in others):
            return point.x, point.y
    return None


def _beside(
    shape: BaseGeometry, taken: list[BaseGeometry], window: BaseGeometry, size: Array
) -> tuple[float, float] | None:
    """A place right above, below, left or right of an obstacle that is free and in the picture."""
    left, bottom, right, top = shape.bounds
    x, y = (left + right) / 2, (bottom + top) / 2
    width, height = size / 2 + 1
    for place in ((x, top + height), (x, bottom - height), (right + width, y), (left - width, y)):
        box = _box(place[0], place[1], size - 1)
        if window.contains(box) and not any(box.intersects(other) for other in taken):
            return place
    return None


def _box(x: float, y: float, size: Array) -> BaseGeometry:
    width, height = (size / 2).tolist()
    box: BaseGeometry = shapely.box(x - width, y - height, x + width, y + height)
    return box
