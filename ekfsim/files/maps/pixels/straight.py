"""Outlines of steps → straight walls, no farther from them than a tolerance.

An outline is parted into as few walls as its steps allow: the parting that has the least sum of
squared distances between the steps and the lines through them, and λ for each wall, found as a
shortest way (Killick, Fearnhead & Eckley, Optimal Detection of Changepoints With a Linear
Computational Cost, 2012, who drop the beginnings that can no longer win). Lines that nearly point
along the building's main directions do so; corners are where the lines meet. All in cells.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import shapely

from ekfsim.geometry import Array, Booleans

WALL_COSTS = 1.5  # λ, in squares of the tolerance
TRIES = 16  # before an outline keeps its steps
NARROW = math.radians(12.0)  # lines that differ by less have no corner of their own
BOX = 4  # corners of what is straight as it is
TURNED = 0.25  # of the tolerance: how far a wall's ends are moved at most to lie along others
SAME = 0.35  # of the tolerance: offsets of walls that differ by less are one line


@dataclass(frozen=True, slots=True)
class Wall:
    """A stretch of an outline and the line through it."""

    first: int  # the point of the outline that it begins with
    last: int  # and that with which the next one begins, beyond the end where that is the first
    cost: float  # λ by which it was found
    middle: Array  # (2,) of its steps
    direction: float  # rad
    length: float  # cells
    # of a line in a main direction: which of the four, and how far to the left of the origin it is
    facing: int | None = None
    line: float = 0.0
    loose: bool = False  # the main directions do not suit it

    def normal(self) -> Array:
        """Unit normal, to the left."""
        return np.array([-math.sin(self.direction), math.cos(self.direction)])

    def offset(self) -> float:
        """How far to the left of the origin the line lies."""
        return float(self.normal() @ self.middle) if self.facing is None else self.line

    def nearest(self, point: Array) -> Array:
        """The point of the line next to another."""
        return np.asarray(point - (self.normal() @ point - self.offset()) * self.normal())


def corners(ring: Array) -> Array:
    """The points of a closed outline (n, 2) at which it turns."""
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    turning = before[:, 0] * after[:, 1] != before[:, 1] * after[:, 0]
    return np.asarray(ring[turning])


def straightened(rings: list[Array], tolerance: float) -> list[Array]:
    """Outlines (n, 2) whose points are 1 apart, by straight walls within a tolerance of them."""
    fitted = [list(_walls(ring, tolerance)) for ring in rings]
    main = main_direction([wall for walls in fitted for wall in walls])
    return [
        _outline(ring, walls, main, tolerance) for ring, walls in zip(rings, fitted, strict=True)
    ]


def main_direction(walls: list[Wall]) -> float:
    """The direction in [−45°, 45°) along or across which most of the length of walls lies, rad."""
    if not walls:
        return 0.0
    angles = np.array([wall.direction for wall in walls])
    weights = np.array([wall.length for wall in walls]) ** 2
    # the mean of directions that count alike after a quarter turn, about the fullest degree
    degree = np.floor(np.degrees(angles) % 90).astype(int) % 90
    fullest = math.radians(int(np.argmax(np.bincount(degree, weights, 90))) + 0.5)
    away = (angles - fullest + math.pi / 4) % (math.pi / 2) - math.pi / 4
    near = np.abs(away) < math.radians(1.5)
    mean = fullest + float(np.average(away[near], weights=weights[near]))
    return (mean + math.pi / 4) % (math.pi / 2) - math.pi / 4


def farthest(ring: Array, outline: Array) -> float:
    """How far a straightened outline is from its steps at most, either way."""
    steps, straight = shapely.LinearRing(ring), shapely.LinearRing(outline)
    away = shapely.distance(shapely.points(ring), straight).max()
    return float(max(away, shapely.distance(shapely.points(outline), steps).max()))


def _outline(ring: Array, walls: list[Wall], main: float, tolerance: float) -> Array:
    """The corners of the straightened outline; its steps where nothing straight is near enough."""
    if len(box := corners(ring)) == BOX:
        return box
    for _ in range(TRIES):
        snapped = [wall if wall.loose else _snapped(wall, main, tolerance) for wall in walls]
        outline = _corners(ring, _aligned(snapped, tolerance), tolerance)
        if len(outline) < 3:
            far = np.ones(len(ring), bool)
        else:
            far = _wrong(ring, outline, tolerance)
            if not far.any() and farthest(ring, outline) <= tolerance:
                return outline
        walls = [better for wall in walls for better in _better(ring, wall, far, tolerance)]
    return corners(ring)


def _wrong(ring: Array, outline: Array, tolerance: float) -> Booleans:
    """Which points of an outline a straightened one is too far from, or crosses itself beside."""
    points = shapely.points(ring)
    wrong = np.asarray(shapely.distance(points, shapely.LinearRing(outline)) > tolerance)
    if not shapely.Polygon(outline).is_valid:
        n = len(outline)
        edges = np.stack([outline, np.roll(outline, -1, axis=0)], 1)
        walls = np.asarray(shapely.linestrings(edges))
        one, other = shapely.STRtree(walls).query(walls, predicate="intersects")
        apart = np.minimum((one - other) % n, (other - one) % n) > 1
        crossings = shapely.union_all(shapely.intersection(walls[one[apart]], walls[other[apart]]))
        wrong |= np.asarray(shapely.distance(points, crossings) <= 2 * tolerance)
        if not wrong.any():
            wrong[:] = True
    return wrong


def _better(ring: Array, wall: Wall, far: Booleans, tolerance: float) -> Iterator[Wall]:
    """A wall as it is tried next, where one of its steps was too far away: as it lies by itself;
    after that in parts.
    """
    n = len(ring)
    if not far[np.arange(wall.first, wall.last + 1) % n].any():
        yield wall
    elif not wall.loose:
        yield replace(wall, loose=True)
    else:
        length = wall.last - wall.first
        stretch = ring[np.arange(wall.first, wall.last + 1) % n]
        parted = _shortest(_Moments(stretch, is_closed=False), 0, length, wall.cost / 2)
        for a, b in zip(parted, [*parted[1:], length], strict=True):
            yield replace(
                _wall(ring, wall.first + a, wall.first + b, tolerance, wall.cost / 2), loose=True
            )


class _Moments:
    """Sums over the steps of an outline, by which the line through any stretch of it is known."""

    def __init__(self, points: Array, is_closed: bool = True) -> None:
        ends = np.concatenate([points, points[:1]]) if is_closed else points
        step = np.diff(ends, axis=0)
        self.origin = ends[0]
        (x, y), (dx, dy) = (ends[:-1] - self.origin + step / 2).T, step.T
        # a step is a line, and more than its middle: 1/12 of its square about that
        own = [x, y, x * x + dx * dx / 12, x * y + dx * dy / 12, y * y + dy * dy / 12]
        self.sums = np.concatenate([np.zeros((1, 5)), np.cumsum(np.stack(own, -1), axis=0)])

    def spread(self, first: Array | int, last: int) -> tuple[Array, Array, Array, Array, Array]:
        """Of the steps from `first` to `last`, without that: how many, and their sums of squares
        about their middle, xx, xy, yy; and the middle (…, 2).
        """
        total = self.sums[last] - self.sums[first]
        n = np.asarray(last - np.asarray(first), np.float64)
        x, y = total[..., 0] / n, total[..., 1] / n
        xx, xy, yy = (
            total[..., 2] - n * x * x, total[..., 3] - n * x * y, total[..., 4] - n * y * y,
        )  # fmt: skip
        return n, xx, xy, yy, self.origin + np.stack([x, y], -1)

    def cost(self, first: Array, last: int) -> Array:
        """The sum of squared distances to the best line."""
        _, xx, xy, yy, _ = self.spread(first, last)
        return np.asarray((xx + yy - np.hypot(xx - yy, 2 * xy)) / 2)


def _walls(ring: Array, tolerance: float) -> Iterator[Wall]:
    """The walls of an outline, in its order."""
    n, cost = len(ring), WALL_COSTS * tolerance**2
    breaks = _shortest(_Moments(ring), 0, n, cost)
    # it began where nobody knows whether there is a corner
    start = breaks[len(breaks) // 2]
    breaks = _shortest(_Moments(np.roll(ring, -start, axis=0)), 0, n, cost)
    for first, last in zip(breaks, [*breaks[1:], n], strict=True):
        yield _wall(ring, start + first, start + last, tolerance, cost)


def _wall(ring: Array, first: int, last: int, tolerance: float, cost: float) -> Wall:
    """The wall of the steps from one point of an outline to another. The steps next to a corner
    may be its neighbour's, and do not count.
    """
    n = len(ring)
    points = ring[np.arange(first, last + 1) % n]
    trim = min(math.ceil(tolerance), (last - first) // 4)
    moments = _Moments(points[trim : len(points) - trim], is_closed=False)
    _, xx, xy, yy, middle = moments.spread(0, last - first - 2 * trim)
    chord = points[-1] - points[0]
    angle = float(np.arctan2(2 * xy, xx - yy)) / 2
    if chord[0] * math.cos(angle) + chord[1] * math.sin(angle) < 0:
        angle += math.pi
    length = max(float(np.hypot(*chord)), 1.0)
    return Wall(first % n, first % n + last - first, cost, middle, angle, length)


def _shortest(moments: _Moments, first: int, last: int, cost: float) -> list[int]:
    """The beginnings of the walls from one point to another that cost least."""
    n = last - first
    best = np.zeros(n + 1)
    before = np.zeros(n + 1, np.int64)
    left = np.array([0])  # the beginnings that can still win
    for j in range(1, n + 1):
        costs = best[left] + moments.cost(left + first, j + first)
        k = int(np.argmin(costs))
        best[j], before[j] = costs[k] + cost, left[k]
        left = np.append(left[costs <= best[j]], j)
    found, j = [], n
    while j:
        j = int(before[j])
        found.append(j + first)
    return found[::-1]


def _snapped(wall: Wall, main: float, tolerance: float) -> Wall:
    """The wall along a main direction, where that does not move its ends far."""
    quarter = math.pi / 2
    quarters = round((wall.direction - main) / quarter)
    along = main + quarter * quarters
    if abs(math.sin(wall.direction - along)) * wall.length / 2 > TURNED * tolerance:
        return wall
    turned = replace(wall, direction=along)
    return replace(turned, facing=quarters % 4, line=turned.offset())


def _aligned(walls: list[Wall], tolerance: float) -> list[Wall]:
    """Walls of one main direction that nearly lie on one line, on it."""
    aligned = list(walls)
    facing: dict[int, list[int]] = {}
    for k, wall in enumerate(walls):
        if wall.facing is not None:
            facing.setdefault(wall.facing, []).append(k)
    for group in facing.values():
        group.sort(key=lambda k: walls[k].offset())
        while group:
            low = walls[group[0]].offset()
            one = [k for k in group if walls[k].offset() - low <= SAME * tolerance]
            group = group[len(one) :]
            lengths = [walls[k].length for k in one]
            line = float(np.average([walls[k].offset() for k in one], weights=lengths))
            for k in one:
                aligned[k] = replace(walls[k], line=line)
    return aligned


def _corners(ring: Array, walls: list[Wall], tolerance: float) -> Array:
    """Where the lines of neighbours meet; beside each other where they do not near by."""
    found: list[Array] = []
    for one, other in zip(walls, [*walls[1:], walls[0]], strict=True):
        split = ring[other.first]
        turn = math.sin(other.direction - one.direction)
        if abs(turn) > math.sin(NARROW):
            normals = np.stack([one.normal(), other.normal()])
            met = np.linalg.solve(normals, np.array([one.offset(), other.offset()]))
            if np.hypot(*(met - split)) <= tolerance:
                found.append(met)
                continue
        a, b = one.nearest(split), other.nearest(split)
        on_one_line = one.facing is not None and (one.facing, one.line) == (
            other.facing,
            other.line,
        )
        if not on_one_line:
            found += [a, b] if float(np.hypot(*(a - b))) > 0.5 else [(a + b) / 2]
    outline = np.array(found).reshape(-1, 2)
    kept = np.hypot(*(outline - np.roll(outline, 1, axis=0)).T) > 1e-6
    return np.asarray(outline[kept])
