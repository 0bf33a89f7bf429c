"""The walls of a map: which polygon each belongs to, and which of them a beam meets first.

A wall is met from either side: a beam that starts inside an obstacle, or outside the boundary,
meets the first edge on its way, whosesoever it is. What a beam through a corner, along a wall or
from a wall meets is told in rules.py.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Self

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.geometry.circle import circle_outline
from ekfsim.raycast.brute import brute_force
from ekfsim.raycast.ground import Ground
from ekfsim.raycast.round_walls import RoundWalls
from ekfsim.raycast.searches.flat_grid import FlatGrid
from ekfsim.raycast.searches.grid import Grid
from ekfsim.twins import twinned

BOUNDARY = "boundary"  # the name of the ring that is the room's own wall
COLLINEAR = 1e-9  # rad, and of the polygon's size: edges that differ by less lie on one line


@dataclass(frozen=True, slots=True)
class Hit:
    """Where beams met their first walls. Every array has the beams' axes (…)."""

    range: Array  # (…) m, nan where the beam meets no wall
    wall: Integers  # (…) index of that wall, -1 where the beam meets none


@dataclass(frozen=True, eq=False)
class Walls:
    """All walls of one map: every edge of every polygon and of every line of walls that stands
    free, W in all, and then every circle, C in all.
    """

    segments: Array  # (W, 2, 2) m: the ends of each straight wall
    # (W, 2) unit normal of each, to the left on the way from its first end to its second
    normals: Array
    circles: Array  # (C, 3) m: centre and radius of each round wall
    polygon: Integers  # (W + C,) which polygon, line of walls or circle the wall belongs to
    # (W + C,) which edge of it: edge j joins points j and j + 1, the last closes the ring; a
    # circle is its own edge 0
    edge: Integers
    # (W + C,) edges of one polygon on one straight line share a number; a circle has its own
    line: Integers
    names: tuple[str, ...]  # of the polygons, then of the lines of walls, then of the circles
    polygons: int  # how many of the names are polygons

    def __post_init__(self) -> None:
        """Every step of a run hands out the same walls: nobody may move them."""
        each = self.segments, self.normals, self.circles, self.polygon, self.edge, self.line
        for numbers in each:
            numbers.flags.writeable = False

    @classmethod
    def of(
        cls,
        rings: Mapping[str, Array],
        lines: Mapping[str, Array] | None = None,
        circles: Mapping[str, Array] | None = None,
    ) -> Self:
        """Collect the edges of all rings, closed or not, and of all lines of walls, which stay
        open: both given by name as (n, 2) points in m; and circles as x, y of the centre and
        radius, (3,) m.

        Edges of no length are no walls; the others keep their number in the ring.
        """
        lines, circles = lines or {}, circles or {}
        polygon, edge, segments = [], [], []
        edges = chain(map(_edges, rings.values()), map(_open_edges, lines.values()))
        for number, ends in enumerate(edges):
            kept = np.flatnonzero(np.hypot(*(ends[:, 1] - ends[:, 0]).T))
            polygon.append(np.full(len(kept), number))
            edge.append(kept)
            segments.append(ends[kept])
        ends = np.concatenate([np.empty((0, 2, 2)), *segments])
        east, north = (ends[:, 1] - ends[:, 0]).T
        normals = np.stack([-north, east], -1) / np.hypot(east, north)[:, None]
        none, round_ = np.empty(0, np.int64), np.arange(len(circles))
        numbers = np.concatenate([none, *polygon])
        line = _lines(ends, numbers)
        return cls(
            ends,
            normals,
            np.array(list(circles.values()), float).reshape(-1, 3),
            np.concatenate([numbers, len(rings) + len(lines) + round_]),
            np.concatenate([none, *edge, 0 * round_]),
            np.concatenate([line, line.max(initial=-1) + 1 + round_]),
            (*rings, *lines, *circles),
            len(rings),
        )

    def name(self, wall: int) -> tuple[str, int]:
        """The polygon or line that a wall belongs to, and which edge of it: ("desk", 2)."""
        return self.names[self.polygon[wall]], int(self.edge[wall])

    def is_round(self, wall: int) -> bool:
        """Whether a wall is a circle."""
        return wall >= len(self.segments)

    def normal_at(self, wall: Integers, place: Array) -> Array:
        """Unit normals where walls (…) are met at places (…, 2) : (…, 2), zero where there is no
        wall. That of a circle points outwards.
        """
        W = len(self.segments)
        straight = np.vstack([self.normals, np.zeros(2)])  # no wall, −1, takes the last
        n = straight[np.where(wall < W, wall, -1)]
        if not len(self.circles):
            return n
        circle = self.circles[np.maximum(wall - W, 0)]
        with np.errstate(invalid="ignore"):  # where no wall is met
            outwards = (place - circle[..., :2]) / circle[..., 2:]
        return np.where((wall >= W)[..., None], outwards, n)

    def outline(self, wall: int) -> Array:
        """A wall as a line to be drawn : (n, 2) m"""
        W = len(self.segments)
        return self.segments[wall] if wall < W else circle_outline(*self.circles[wall - W].tolist())

    @twinned
    def cast(self, origin: Array, heading: Array) -> Hit:
        """Follow beams to their first walls. origin : (…, 2) m; heading : (…) rad; broadcast
        together.
        """
        x, y, heading = np.broadcast_arrays(origin[..., 0], origin[..., 1], heading)
        with np.errstate(invalid="ignore"):
            dx, dy = np.cos(heading), np.sin(heading)
        found = brute_force(self.segments, x, y, dx, dy)
        return Hit(*(found if self.round is None else self.round.before(found, x, y, dx, dy)))

    @twinned
    def first(self, x: float, y: float, heading: float) -> tuple[float, int]:
        """Range and wall of one beam from (x, y) m towards `heading` rad; nan and −1 where it meets
        none.
        """
        hit = self.cast(np.array([x, y]), np.array(heading))
        return float(hit.range), int(hit.wall)

    def near(self, low: Array, high: Array) -> Integers:
        """The walls whose bounding boxes touch a box from its corner `low` (2,) to `high` (2,)."""
        first, last = self.boxes
        return np.flatnonzero(((first <= high) & (last >= low)).all(axis=-1))

    @cached_property
    def boxes(self) -> tuple[Array, Array]:
        """The lower left and the upper right corner of each wall's bounding box : (W + C, 2) m"""
        centre, radius = self.circles[:, :2], self.circles[:, 2:]
        return (
            np.concatenate([self.segments.min(axis=1), centre - radius]),
            np.concatenate([self.segments.max(axis=1), centre + radius]),
        )

    @cached_property
    def round(self) -> RoundWalls | None:
        """The round walls; None where there is none."""
        return RoundWalls(self.circles, len(self.segments)) if len(self.circles) else None

    @cached_property
    def ground(self) -> Ground:
        """Where a robot can stand among these walls."""
        numbers = self.polygon[: len(self.segments)]
        areas = numbers < self.polygons
        return Ground.of(
            self.segments[areas],
            numbers[areas],
            self.names.index(BOUNDARY) if BOUNDARY in self.names else -1,
            self.circles,
        )

    @cached_property
    def plane(self) -> Integers:
        """(W + C,) as `line`, but edges of different polygons on one straight line share a number,
        too.
        """
        W = len(self.segments)
        straight = _lines(self.segments, np.zeros(W, np.int64)) if W else self.line[:0]
        return np.concatenate([straight, W + np.arange(len(self.circles))])

    @cached_property
    def recent(self) -> dict[tuple[float, float, float], tuple[float, int]]:
        """The last few single beams, with what they met."""
        return {}

    @cached_property
    def grid(self) -> Grid | None:
        """What the searches look walls up in, built at the first cast; None where there is none."""
        return Grid.over(self.segments) if len(self.segments) else None

    @cached_property
    def flat_grid(self) -> FlatGrid:
        """The same for many beams, where there is a wall."""
        return FlatGrid.of(Grid.over(self.segments) if self.grid is None else self.grid)


def _edges(points: Array) -> Array:
    """(n, 2, 2): the edges of a ring, each from its point to the next; a repeated closing point is
    none of them.
    """
    points = np.asarray(points, float).reshape(-1, 2)
    if len(points) > 1 and (points[0] == points[-1]).all():
        points = points[:-1]
    return np.stack([points, np.roll(points, -1, axis=0)], 1)


def _open_edges(points: Array) -> Array:
    """(n − 1, 2, 2): the edges of a line, from each point to the next."""
    points = np.asarray(points, float).reshape(-1, 2)
    return np.stack([points[:-1], points[1:]], 1)


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
    """(n,): number the runs of nearly equal values; a gap in the sorted values, or another
    `within`, parts two runs.
    """
    order = np.lexsort([value, within])
    parted = (np.diff(within[order]) != 0) | (np.diff(value[order]) > gap[order][1:])
    number = np.empty(len(order), np.int64)
    number[order] = np.concatenate([np.zeros(min(1, len(order)), np.int64), np.cumsum(parted)])
    return number
