"""What makes points a polygon, and where a robot can stand."""

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Self

import numpy as np
import shapely

from ekfsim.floor import Map, Obstacle
from ekfsim.geometry import Array
from ekfsim.printable import quoted

Points = Sequence[Sequence[float]] | Array
Circle = tuple[float, float, float]  # x, y, radius in m
Fault = tuple[int | None, str, str]  # the point it is about, what is wrong, what would be right


def fault_of(points: Sequence[Sequence[float]]) -> Fault | None:
    """Why points are no simple polygon; None where they are one. The last may repeat the first."""
    if fault := fault_of_line(points):
        return fault
    if points[0] == points[-1]:
        points = points[:-1]
    if without_area(points):
        return (
            None,
            "the polygon has no area: its points lie on one line",
            "move a point off that line",
        )
    polygon = shapely.Polygon(points)
    if not polygon.is_valid:
        reason = shapely.is_valid_reason(polygon)
        return None, f"the outline crosses or touches itself{crossing(reason)}", cure_of(reason)
    return None


def fault_of_line(points: Sequence[Sequence[float]]) -> Fault | None:
    """Why points are no line from one to the next; None where they are one."""
    for index, point in enumerate(points):
        if index and point == points[index - 1]:
            return index, f"the point {pair(point)} repeats the one before it", "delete one of them"
    return None


def without_area(points: Sequence[Sequence[float]]) -> bool:
    """Whether all points lie on one line, to rounding.
    In plain floats: a file may hold thousands of small polygons.
    """
    # far from the origin, products of coordinates have no digit left for an area
    x_0, y_0 = points[0]
    x, y = [point[0] - x_0 for point in points], [point[1] - y_0 for point in points]
    least = 1e-12 * max(max(x) - min(x), max(y) - min(y)) ** 2
    # the last edge ends at 0, 0
    twice = sum(a * d - b * c for a, b, c, d in zip(x, y, x[1:], y[1:], strict=False))
    if abs(twice) / 2 > least:
        return False  # the area that it encloses is at most that of its hull
    return bool(shapely.MultiPoint(list(zip(x, y, strict=True))).convex_hull.area <= least)


def cure_of(reason: str) -> str:
    """What would be right in place of an outline that is none, for what Shapely says of it: one
    that only touches itself may be meant to hold a hole.
    """
    right = "give the corners in order, around it"
    if reason.startswith("Ring Self-intersection"):
        return f"{right}; the rim of a hole, or a spike, may stand by itself under 'walls'"
    return right


def crossing(reason: str) -> str:
    """Where an outline crosses itself by what Shapely says of it, as the end of a sentence."""
    found = re.search(r"\[(\S+) (\S+)\]", reason)
    return f" at {pair([float(found[1]), float(found[2])])}" if found else ""


def pair(point: Sequence[float]) -> str:
    """A point as it is written, in a map's grid to 0.1 mm.

    >>> pair([4, 3.5]), pair([388097.25, 5632217.123456])
    ('[4, 3.5]', '[388097.25, 5632217.1235]')
    """
    x, y = (f"{value:.6g}" if abs(value) < FINE else f"{round(value, 4):.15g}" for value in point)
    return f"[{x}, {y}]"


FINE = 100  # m, up to which six digits tell 0.1 mm
MOST_IN_THE_WAY = 5  # obstacles that are told of one place


class FloorPlan:
    """Where a robot cannot stand: outside a boundary, inside an obstacle, on the wall of either, on
    a wall that stands free.
    """

    def __init__(
        self,
        boundary: Points | None,
        obstacles: Iterable[tuple[str, Points]],
        lines: Iterable[tuple[str, Points]] = (),
        circles: Iterable[tuple[str, Circle]] = (),
    ) -> None:
        self._boundary = None if boundary is None else shapely.Polygon(boundary)
        areas, walls, self._circles = list(obstacles), list(lines), list(circles)
        self._told = [f"inside the obstacle {quoted(name)} or on its wall" for name, _ in areas]
        self._told += [f"on the wall {quoted(name)}" for name, _ in walls]
        self._tree = shapely.STRtree(
            [
                *_shapes([np.asarray(points, dtype=float) for _, points in areas]),
                *_lines([np.asarray(points, dtype=float) for _, points in walls]),
            ]
        )

    @classmethod
    def of(cls, floor: Map) -> Self:
        """That of a map."""
        return cls(
            floor.boundary,
            [(one.name, one.points) for one in floor.obstacles if isinstance(one, Obstacle)],
            [(line.name, line.points) for line in floor.lines],
            [(one.name, (*one.centre.tolist(), one.radius)) for one in floor.circles()],
        )

    def in_the_way(self, x: float, y: float) -> Iterator[str]:
        """Why a robot cannot stand at a point, as the ends of sentences."""
        where, point = f"{pair([x, y])},", shapely.Point(x, y)
        if self._boundary is not None and not self._boundary.contains(point):
            yield f"{where} outside the boundary or on its wall"
        for index in sorted(self._tree.query(point, predicate="intersects").tolist())[
            :MOST_IN_THE_WAY
        ]:
            yield f"{where} {self._told[index]}"
        for name, (east, north, radius) in self._circles:
            if math.hypot(x - east, y - north) <= radius:
                yield f"{where} inside the obstacle {quoted(name)} or on its wall"


def _shapes(outlines: list[Array]) -> list[Any]:
    """The polygons of Shapely."""
    return list(shapely.polygons(_lines(outlines, shapely.linearrings))) if outlines else []


def _lines(corners: list[Array], made: Any = shapely.linestrings) -> Any:
    """The lines of Shapely, made all at once:
    one by one they take the longest of all that a file is asked.
    """
    if not corners:
        return []
    owners = np.repeat(np.arange(len(corners)), [len(each) for each in corners])
    return made(np.concatenate(corners), indices=owners)
