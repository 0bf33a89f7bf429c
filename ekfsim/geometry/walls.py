"""Where a beam meets the first wall.

A wall is a straight edge of a polygon, from a to b; a beam leaves the origin o in the unit direction d. Seen from the
beam, a point v lies `along` = (v − o)·d ahead and `across` = (v − o)×d to the right. A wall whose ends lie on different
sides is crossed, and the crossing is the mean of the ends' `along`, weighted with the distances across:

    r = (along_a across_b − along_b across_a) / (across_b − across_a)

What rounding must not decide is decided within `reach`, a few units in the last place of the coordinates:

- A beam that passes within reach of a wall's end hits that end. Two edges that share a corner get the same numbers for
  it, so nothing slips between them.
- A beam along a wall hits its nearer end.
- A beam that starts within reach of a wall has range 0, whatever its direction.
- Of several walls at the same range (within `tie`), the one with the lowest index is hit.

A wall is hit from either side, so a beam that starts inside an obstacle, or outside the boundary, meets the first edge
on its way.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np

from ekfsim.geometry import Array, Integers

REACH = 16 * float(
    np.finfo(float).eps
)  # of the largest coordinate: what an aimed beam misses its mark by, and to spare
TIE = 1e-12  # of the largest coordinate: ranges that differ by less are equal
COLLINEAR = 1e-9  # rad, and of the polygon's size: edges that differ by less lie on one line
CHUNK = 1 << 18  # beams × walls that brute force holds in memory at a time


@dataclass(frozen=True, slots=True)
class Hit:
    """Where beams met their first walls. Every array has the beams' axes (…)."""

    range: Array  # (…) m, nan where the beam meets no wall
    wall: Integers  # (…) index of that wall, -1 where the beam meets none


@dataclass(frozen=True, eq=False)
class Walls:
    """Every edge of every polygon of one map."""

    segments: Array  # (W, 2, 2) m: the ends of each wall
    normals: Array  # (W, 2) unit normal of each wall, to the left on the way from its first end to its second
    polygon: Integers  # (W,) which polygon the wall belongs to
    edge: Integers  # (W,) which edge of it: edge j joins points j and j + 1, the last closes the ring
    line: Integers  # (W,) edges of one polygon on one straight line share a number
    names: tuple[str, ...]  # of the polygons

    @classmethod
    def of(cls, rings: Mapping[str, Array]) -> Self:
        """Collect the edges of all rings, given by name as (n, 2) points in m, closed or not.

        Edges of no length are no walls; the others keep their number in the ring.
        """
        polygon, edge, segments = [], [], []
        for number, points in enumerate(rings.values()):
            ends = _edges(points)
            kept = np.flatnonzero(np.hypot(*(ends[:, 1] - ends[:, 0]).T))
            polygon.append(np.full(len(kept), number))
            edge.append(kept)
            segments.append(ends[kept])
        ends = np.concatenate([np.empty((0, 2, 2)), *segments])
        east, north = (ends[:, 1] - ends[:, 0]).T
        normals = np.stack([-north, east], -1) / np.hypot(east, north)[:, None]
        none = np.empty(0, np.int64)
        numbers = np.concatenate([none, *polygon])
        return cls(ends, normals, numbers, np.concatenate([none, *edge]), _lines(ends, numbers), tuple(rings))

    def name(self, wall: int) -> tuple[str, int]:
        """The polygon that a wall belongs to, and which edge of it: ("desk", 2)."""
        return self.names[self.polygon[wall]], int(self.edge[wall])

    def cast(self, origin: Array, heading: Array) -> Hit:
        """Follow beams to their first walls. origin : (…, 2) m; heading : (…) rad; broadcast together."""
        x, y, heading = np.broadcast_arrays(origin[..., 0], origin[..., 1], heading)
        shape = heading.shape
        distance, wall = brute_force(
            self.segments, x.ravel(), y.ravel(), np.cos(heading).ravel(), np.sin(heading).ravel()
        )
        return Hit(distance.reshape(shape), wall.reshape(shape))

    def first(self, x: float, y: float, heading: float) -> tuple[float, int]:
        """Range and wall of one beam from (x, y) m towards `heading` rad; nan and -1 where it meets none."""
        hit = self.cast(np.array([x, y]), np.array(heading))
        return float(hit.range), int(hit.wall)


def brute_force(segments: Array, x: Array, y: Array, dx: Array, dy: Array) -> tuple[Array, Integers]:
    """The first wall of each beam, found by trying every wall: the twin of the fast ways. All beams are (n,)."""
    ranges, walls = np.full(x.shape, np.nan), np.full(x.shape, -1)
    step = max(1, CHUNK // max(1, len(segments)))
    size = np.abs(segments).max(initial=0.0)
    for start in range(0, len(x) if len(segments) else 0, step):
        part = slice(start, start + step)
        span = size + np.abs(x[part]) + np.abs(y[part])
        beams = [v[part, None] for v in (x, y, dx, dy)]
        each = meet(segments, *beams, REACH * span[:, None])
        nearest = each.min(-1)
        lowest = (each <= (nearest + TIE * span)[:, None]).argmax(-1)
        met = nearest < np.inf
        ranges[part] = np.where(met, nearest, np.nan)
        walls[part] = np.where(met, lowest, -1)
    return ranges, walls


def meet(segments: Array, x: Array, y: Array, dx: Array, dy: Array, reach: Array) -> Array:
    """The range at which each beam meets each wall, inf where it does not; see the top of this file.

    segments : (…, 2, 2) m; the beams' origin and unit direction, and reach in m, broadcast with its leading axes.
    """
    ax, ay, bx, by = segments[..., 0, 0] - x, segments[..., 0, 1] - y, segments[..., 1, 0] - x, segments[..., 1, 1] - y
    along_a, across_a = ax * dx + ay * dy, ax * dy - ay * dx
    along_b, across_b = bx * dx + by * dy, bx * dy - by * dx
    at_a, at_b = np.abs(across_a) <= reach, np.abs(across_b) <= reach
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        crossing = (along_a * across_b - along_b * across_a) / (across_b - across_a)
    r = np.where((across_a < 0) != (across_b < 0), crossing, np.inf)
    r = np.where(at_b, along_b, r)
    r = np.where(at_a, np.where(at_b, np.minimum(along_a, along_b), along_a), r)
    r = np.where(_distance(along_a, across_a, along_b, across_b) <= reach, 0.0, r)
    return np.where(r >= 0, r, np.inf)


def _distance(ax: Array, ay: Array, bx: Array, by: Array) -> Array:
    """How far the segments from a to b are from the origin of coordinates, in m."""
    ex, ey = bx - ax, by - ay
    with np.errstate(divide="ignore", invalid="ignore"):
        foot = np.clip(-(ax * ex + ay * ey) / (ex * ex + ey * ey), 0, 1)
    return np.hypot(ax + foot * ex, ay + foot * ey)


def _edges(points: Array) -> Array:
    """(n, 2, 2): the edges of a ring, each from its point to the next; a repeated closing point is none of them."""
    points = np.asarray(points, float).reshape(-1, 2)
    if len(points) > 1 and (points[0] == points[-1]).all():
        points = points[:-1]
    return np.stack([points, np.roll(points, -1, axis=0)], 1)


def _lines(segments: Array, polygon: Integers) -> Integers:
    """(W,): a number for each straight line, in the order of its first wall."""
    _, first, which = np.unique(polygon, return_index=True, return_inverse=True)
    start = segments[first, 0][which]
    size = np.zeros(len(first))
    np.maximum.at(size, which, np.abs(segments - start[:, None]).max((1, 2)))
    east, north = (segments[:, 1] - segments[:, 0]).T
    angle = np.arctan2(north, east) % np.pi
    angle = np.where(angle > np.pi - COLLINEAR, angle - np.pi, angle)
    parallel = _groups(polygon, angle, np.full(len(angle), COLLINEAR))
    middle = segments.mean(1) - start
    offset = middle[:, 1] * np.cos(angle) - middle[:, 0] * np.sin(angle)
    line = _groups(parallel, offset, COLLINEAR * size[which])
    _, first, which = np.unique(line, return_index=True, return_inverse=True)
    return np.argsort(np.argsort(first))[which]


def _groups(within: Integers, value: Array, gap: Array) -> Integers:
    """(n,): number the runs of nearly equal values; a gap in the sorted values, or another `within`, parts two runs."""
    order = np.lexsort([value, within])
    parted = (np.diff(within[order]) != 0) | (np.diff(value[order]) > gap[order][1:])
    number = np.empty(len(order), np.int64)
    number[order] = np.concatenate([np.zeros(min(1, len(order)), np.int64), np.cumsum(parted)])
    return number
