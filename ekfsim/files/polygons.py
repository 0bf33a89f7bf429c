"""What makes points a polygon, and where a robot can stand."""

import re
from collections.abc import Sequence

import numpy as np
import shapely

from ekfsim.geometry import Array

Points = Sequence[Sequence[float]] | Array
Fault = tuple[int | None, str, str]  # the point it is about, what is wrong, what would be right


def fault_of(points: Sequence[Sequence[float]]) -> Fault | None:
    """Why points are no simple polygon; None where they are one."""
    for index, point in enumerate(points):
        if index and point == points[index - 1]:
            return index, f"the point {pair(point)} repeats the one before it", "delete one of them"
    if points[0] == points[-1]:
        return (
            len(points) - 1,
            f"the last point {pair(points[0])} repeats the first",
            "delete it: an outline closes by itself",
        )
    corners = np.array(points, dtype=float)
    if without_area(corners):
        return None, "the polygon has no area: its points lie on one line", "move a point off that line"
    polygon = shapely.Polygon(corners)
    if not polygon.is_valid:
        return None, f"the outline crosses or touches itself{crossing(polygon)}", "give the corners in order, around it"
    return None


def without_area(corners: Array) -> bool:
    """Whether all points lie on one line, to rounding. corners : (n, 2) m"""
    hull = shapely.MultiPoint(corners).convex_hull
    extent = float(np.ptp(corners, axis=0).max())
    return bool(hull.area <= 1e-12 * extent**2)


def crossing(polygon: shapely.Polygon) -> str:
    """Where an outline crosses itself, as the end of a sentence."""
    found = re.search(r"\[(\S+) (\S+)\]", shapely.is_valid_reason(polygon))
    return f" at {pair([float(found[1]), float(found[2])])}" if found else ""


def pair(point: Sequence[float]) -> str:
    """A point as it is written: [4, 3.5]."""
    return f"[{point[0]:.6g}, {point[1]:.6g}]"


def stands_inside(points: Points, x: float, y: float) -> bool:
    """Whether a point lies inside a polygon, and not on its outline."""
    return bool(shapely.Polygon(points).contains(shapely.Point(x, y)))


def is_clear_of(points: Points, x: float, y: float) -> bool:
    """Whether a point lies outside a polygon, and not on its outline."""
    return not shapely.Polygon(points).intersects(shapely.Point(x, y))
