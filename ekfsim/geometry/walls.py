"""The walls of a map: which polygon each belongs to, and which of them a beam meets first.

A wall is met from either side: a beam that starts inside an obstacle, or outside the boundary,
meets the first edge on its way, whosesoever it is. What a beam through a corner, along a wall or
from a wall meets is told in meeting.py. Which of the fast ways is taken when, and why there are so
many, is told in __init__.py.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from math import cos, isfinite, nan, sin
from typing import Self

import numpy as np

from ekfsim.geometry import Array, Integers, backend
from ekfsim.geometry.broad import broad
from ekfsim.geometry.bundle import bundle
from ekfsim.geometry.cells import Cells
from ekfsim.geometry.fan import fan
from ekfsim.geometry.grid import Grid
from ekfsim.geometry.ground import Ground
from ekfsim.geometry.march import march
from ekfsim.geometry.meeting import REACH, TIE, meet, see

BOUNDARY = "boundary"  # the name of the ring that is the room's own wall
COLLINEAR = 1e-9  # rad, and of the polygon's size: edges that differ by less lie on one line
RECENT = 8  # beams that are remembered
FEW = 64  # beams that are sooner followed one by one than all at once
FEW_COMPILED = 16  # the same where compiled code follows them
CHUNK = 1 << 18  # beams × walls that are held in memory at a time
BLOCK = 4096  # beams that are followed together: few enough for a processor's cache
FEW_WALLS = 150  # walls that are sooner all tried than searched
FEWER_WALLS = 48  # and that are so even where the beams lie close together


@dataclass(frozen=True, slots=True)
class Hit:
    """Where beams met their first walls. Every array has the beams' axes (…)."""

    range: Array  # (…) m, nan where the beam meets no wall
    wall: Integers  # (…) index of that wall, -1 where the beam meets none


@dataclass(frozen=True, eq=False)
class Walls:
    """Every edge of every polygon of one map."""

    segments: Array  # (W, 2, 2) m: the ends of each wall
    # (W, 2) unit normal of each wall, to the left on the way from its first end to its second
    normals: Array
    polygon: Integers  # (W,) which polygon the wall belongs to
    # (W,) which edge of it: edge j joins points j and j + 1, the last closes the ring
    edge: Integers
    line: Integers  # (W,) edges of one polygon on one straight line share a number
    names: tuple[str, ...]  # of the polygons
    _recent: dict[tuple[float, float, float], tuple[float, int]] = field(
        default_factory=dict, repr=False
    )

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
        return cls(
            ends,
            normals,
            numbers,
            np.concatenate([none, *edge]),
            _lines(ends, numbers),
            tuple(rings),
        )

    def name(self, wall: int) -> tuple[str, int]:
        """The polygon that a wall belongs to, and which edge of it: ("desk", 2)."""
        return self.names[self.polygon[wall]], int(self.edge[wall])

    def cast(self, origin: Array, heading: Array) -> Hit:
        """Follow beams to their first walls. origin : (…, 2) m; heading : (…) rad; broadcast
        together.
        """
        if origin.ndim == 1 and np.ndim(heading) == 0:
            r, wall = self.first(float(origin[0]), float(origin[1]), float(heading))
            return Hit(np.array(r), np.array(wall))
        x, y = origin[..., 0], origin[..., 1]
        if x.shape != np.shape(heading):
            x, y, heading = np.broadcast_arrays(x, y, heading)
        if heading.size > (FEW if backend.used() == "numpy" else FEW_COMPILED):
            ranges, walls = self._all(x.ravel(), y.ravel(), heading.ravel())
        else:
            hits = [
                self.first(*beam)
                for beam in zip(*(v.ravel().tolist() for v in (x, y, heading)), strict=True)
            ]
            ranges, walls = (
                np.array([r for r, _ in hits]),
                np.array([wall for _, wall in hits], np.int64),
            )
        return Hit(ranges.reshape(heading.shape), walls.reshape(heading.shape))

    def first(self, x: float, y: float, heading: float) -> tuple[float, int]:
        """Range and wall of one beam from (x, y) m towards `heading` rad; nan and -1 where it meets
        none.

        The last few are remembered: a beam is looked along before its reading is used, and followed
        again when it is.
        """
        beam = x, y, heading
        hit = self._recent.get(beam)
        if hit is None:
            if len(self._recent) >= RECENT:
                self._recent.clear()
            hit = self._recent[beam] = self._follow(x, y, heading)
        return hit

    def _follow(self, x: float, y: float, heading: float) -> tuple[float, int]:
        grid = self.grid
        if grid is None or not isfinite(x + y + heading):
            return nan, -1
        if abs(x) + abs(y) < grid.horizon:
            return grid.walk(x, y, cos(heading), sin(heading))
        r, wall = brute_force(self.segments, *np.array([[x], [y], [cos(heading)], [sin(heading)]]))
        return float(r[0]), int(wall[0])

    def _all(self, x: Array, y: Array, heading: Array) -> tuple[Array, Integers]:
        """`first` of many beams, all (n,): quickly, and those that are left in doubt once more by a
        sure way.
        """
        ranges, walls = np.full(x.shape, np.nan), np.full(x.shape, -1)
        for start in range(0, len(x) if self.grid else 0, BLOCK):
            part = slice(start, start + BLOCK)
            with np.errstate(invalid="ignore"):
                beams = x[part], y[part], np.cos(heading[part]), np.sin(heading[part])
            ranges[part], walls[part], doubtful = self._quickly(*beams)
            if doubtful.size:
                ranges[start + doubtful], walls[start + doubtful] = self._surely(
                    *(each[doubtful] for each in beams)
                )
        return ranges, walls

    def _quickly(
        self, x: Array, y: Array, dx: Array, dy: Array
    ) -> tuple[Array, Integers, Integers]:
        """Ranges and walls by the way that suits these beams best, and which of them are in
        doubt.
        """
        grid, ends = self.cells.grid, self.segments.reshape(-1, 4)
        if backend.used() == "numba":
            from ekfsim.geometry import compiled

            return compiled.walk(self.cells, x, y, dx, dy)
        far = np.abs(x) + np.abs(y)
        if not (np.isfinite(dx) & (far < grid.horizon)).all():
            return np.full(x.shape, np.nan), np.full(x.shape, -1), np.arange(len(x))
        span = grid.size + far
        if (x == x[0]).all() and (y == y[0]).all():
            return fan(ends, x[0], y[0], dx, dy, span[0])
        if len(ends) > FEWER_WALLS and (together := bundle(ends, x, y, dx, dy, span)) is not None:
            return together
        if len(ends) <= FEW_WALLS:
            return broad(ends, x, y, dx, dy, span)
        return *march(self.cells, x, y, dx, dy), np.empty(0, np.int64)

    def _surely(self, x: Array, y: Array, dx: Array, dy: Array) -> tuple[Array, Integers]:
        """Cell by cell where rounding is small against a cell, by trying all walls from beyond."""
        ranges, walls = np.full(x.shape, np.nan), np.full(x.shape, -1)
        far = np.abs(x) + np.abs(y)
        near = far < self.cells.grid.horizon
        finite = np.isfinite(far + dx)
        for some, find in (
            (finite & near, partial(march, self.cells)),
            (finite & ~near, partial(brute_force, self.segments)),
        ):
            ranges[some], walls[some] = find(x[some], y[some], dx[some], dy[some])
        return ranges, walls

    def near(self, low: Array, high: Array) -> Integers:
        """The walls whose bounding boxes touch a box from its corner `low` (2,) to `high` (2,)."""
        first, last = self._boxes
        return np.flatnonzero(((first <= high) & (last >= low)).all(axis=-1))

    @cached_property
    def _boxes(self) -> tuple[Array, Array]:
        return self.segments.min(axis=1), self.segments.max(axis=1)

    @cached_property
    def ground(self) -> Ground:
        """Where a robot can stand among these walls."""
        return Ground.of(
            self.segments,
            self.polygon,
            self.names.index(BOUNDARY) if BOUNDARY in self.names else -1,
        )

    @cached_property
    def grid(self) -> Grid | None:
        """What makes a cast fast, built at the first one; None where there is no wall."""
        return Grid.over(self.segments) if len(self.segments) else None

    @cached_property
    def cells(self) -> Cells:
        """The same for many beams, where there is a wall."""
        return Cells.of(Grid.over(self.segments) if self.grid is None else self.grid)


def brute_force(
    segments: Array, x: Array, y: Array, dx: Array, dy: Array
) -> tuple[Array, Integers]:
    """The first wall of each beam, found by trying every wall: the twin of the fast ways. All beams
    are (n,).
    """
    ranges, walls = np.full(x.shape, np.nan), np.full(x.shape, -1)
    step = max(1, CHUNK // max(1, len(segments)))
    size = np.abs(segments).max(initial=0.0)
    for start in range(0, len(x) if len(segments) else 0, step):
        part = slice(start, start + step)
        span = size + np.abs(x[part]) + np.abs(y[part])
        seen = see(segments, x[part, None], y[part, None], dx[part, None], dy[part, None])
        each = meet(seen, REACH * span[:, None])
        nearest = each.min(-1)
        lowest = (each <= (nearest + TIE * span)[:, None]).argmax(-1)
        met = nearest < np.inf
        ranges[part] = np.where(met, nearest, np.nan)
        walls[part] = np.where(met, lowest, -1)
    return ranges, walls


def _edges(points: Array) -> Array:
    """(n, 2, 2): the edges of a ring, each from its point to the next; a repeated closing point is
    none of them.
    """
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
    """(n,): number the runs of nearly equal values; a gap in the sorted values, or another
    `within`, parts two runs.
    """
    order = np.lexsort([value, within])
    parted = (np.diff(within[order]) != 0) | (np.diff(value[order]) > gap[order][1:])
    number = np.empty(len(order), np.int64)
    number[order] = np.concatenate([np.zeros(min(1, len(order)), np.int64), np.cumsum(parted)])
    return number
