"""Where one robot can stand, in plain floats."""

import itertools
import math
from collections.abc import Sequence

import numpy as np

from ekfsim.geometry import Array
from ekfsim.raycast.ground import CLEARANCE, HAIR, Edge, Ground


def reach(ground: Ground, place: Array, ways: Array) -> Array | None:
    """Twin of `Ground.reach`, of a few ways from one place."""
    if place.size != 2 or ways.ndim != 2 or not ways.size or not np.isfinite(place).all():
        return None
    x, y = place.ravel().tolist()
    return np.array(reach_of_each(ground, x, y, ways.tolist()))


def reach_of_each(
    ground: Ground, x: float, y: float, ways: Sequence[Sequence[float]]
) -> list[float]:
    """The same, all in plain floats: of ways (dx, dy, …) m from (x, y) m."""
    xs, ys = [x + way[0] for way in ways], [y + way[1] for way in ways]
    near = ground.touching(np.array([max(xs), max(ys), -min(xs), -min(ys)]))
    stuck = [not _free(ground, near, *end) for end in zip(xs, ys, strict=True)]
    if not any(stuck):
        return [1.0] * len(ways)
    near = ground.near(np.array([min(x, *xs), min(y, *ys)]), np.array([max(x, *xs), max(y, *ys)]))
    return [
        _cut_back(ground, near, x, y, *way[:2]) if cut else 1.0
        for way, cut in zip(ways, stuck, strict=True)
    ]


def _free(ground: Ground, near: list[int], x: float, y: float) -> bool:
    """Whether a robot can stand at a place. near : the polygons that may hold it"""
    indoors = ground.room < 0
    for number in near:
        if _holds(ground, number, x, y):
            if number != ground.room:
                return False
            indoors = True
    return indoors


def _holds(ground: Ground, number: int, x: float, y: float) -> bool:
    polygons = len(ground.rings)
    if number < polygons:
        return _inside(ground.edges(number), x, y)
    cx, cy, radius = ground.rounds[number - polygons]
    return math.hypot(x - cx, y - cy) < radius


def _inside(ring: list[Edge], x: float, y: float) -> bool:
    odd = False
    for ax, ay, bx, by in ring:
        if (ay > y) != (by > y) and x > ax + (bx - ax) * (y - ay) / (by - ay):
            odd = not odd
    return odd


def _cut_back(ground: Ground, near: list[int], x: float, y: float, dx: float, dy: float) -> float:
    """How much can be gone of a way that ends where no robot can stand. near : the polygons that it
    may meet
    """
    cuts = [1.0, 0.0]
    polygons = len(ground.rings)
    for number in near:
        if number >= polygons:
            cuts += _round_cuts(ground.rounds[number - polygons], x, y, dx, dy)
            continue
        for ax, ay, bx, by in ground.edges(number):
            east, north, across = bx - ax, by - ay, dx * (by - ay) - dy * (bx - ax)
            if across:
                cut = ((ax - x) * north - (ay - y) * east) / across
                where = ((ax - x) * dy - (ay - y) * dx) / across
                if 0 < cut < 1 and -HAIR <= where <= 1 + HAIR:
                    cuts.append(cut)
    cuts.sort(reverse=True)
    for far, close in itertools.pairwise(cuts):
        middle = (far + close) / 2
        if far > close and _free(ground, near, x + middle * dx, y + middle * dy):
            return max(middle, far - CLEARANCE / math.hypot(dx, dy))
    return 0.0


def _round_cuts(
    circle: tuple[float, float, float], x: float, y: float, dx: float, dy: float
) -> list[float]:
    cx, cy, radius = circle
    x, y = x - cx, y - cy
    square, half = dx * dx + dy * dy, dx * x + dy * y
    under = half**2 - square * (x * x + y * y - radius**2)
    if under < 0 or square == 0:
        return []
    root = math.sqrt(under)
    return [cut for cut in ((-half - root) / square, (-half + root) / square) if 0 < cut < 1]
