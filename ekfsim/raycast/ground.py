"""Where a robot can stand: inside the room and outside every obstacle. Walls that stand free take
no room.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Self

import numpy as np

from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.twins import twinned

CLEARANCE = 1e-3  # m; how near a robot comes to a wall
MORE, MOST_TRIES = 64, 1_000_000  # places tried beyond those that are wanted; for a single one
HAIR = 1e-9  # of a wall's length: how far beyond its ends a way is cut, too

NONE = np.empty((0, 3))  # no circle

if TYPE_CHECKING:
    from numpy.random import Generator

Edge = tuple[float, float, float, float]


@dataclass(frozen=True, eq=False)
class Ground:
    """The floor of a map. Obstacles may overlap, cross the room's wall or lie outside it."""

    rings: tuple[Array, ...]  # (n, 2, 2) m each: the edges of every polygon
    room: int  # which of them walls in what is free rather than what is not, -1 where none does
    circles: Array  # (c, 3) m: centre and radius of every round obstacle
    low: Array  # (p + c, 2) m: the corners of the boxes of all polygons, then of all circles
    high: Array  # (p + c, 2) m

    @classmethod
    def of(cls, segments: Array, polygon: Integers, room: int, circles: Array = NONE) -> Self:
        """segments : (W, 2, 2) m, all edges; polygon : (W,) which polygon each belongs to"""
        order = np.argsort(polygon, kind="stable")
        first = np.flatnonzero(np.diff(polygon[order])) + 1
        numbers = polygon[order][np.concatenate([[0], first])].tolist() if len(order) else []
        rings = np.split(segments[order], first) if len(order) else []
        corners = [(ring.min(axis=(0, 1)), ring.max(axis=(0, 1))) for ring in rings]
        low, high = np.array(corners).reshape(-1, 2, 2).swapaxes(0, 1)
        centre, radius = circles[:, :2], circles[:, 2:]
        return cls(
            tuple(rings),
            numbers.index(room) if room in numbers else -1,
            circles,
            np.concatenate([low, centre - radius]),
            np.concatenate([high, centre + radius]),
        )

    def free(self, places: Array) -> Booleans:
        """Whether a robot can stand there : (…). places : (…, 2) m"""
        points = places.reshape(-1, 2)
        taken, indoors = np.zeros(len(points), bool), np.full(len(points), self.room < 0)
        for number in (
            self.near(np.fmin.reduce(points), np.fmax.reduce(points)) if len(points) else ()
        ):
            boxed = np.flatnonzero(
                ((self.low[number] <= points) & (points <= self.high[number])).all(axis=-1)
            )
            within = boxed[self._holds(number, points[boxed])]
            (indoors if number == self.room else taken)[within] = True
        free: Booleans = (indoors & ~taken & np.isfinite(points).all(axis=-1)).reshape(
            places.shape[:-1]
        )
        return free

    def anywhere(self, generator: "Generator", number: int) -> Array:
        """Poses, uniform over the places where a robot can stand and over all headings : (p, 3).

        Raises ValueError where walls shut nothing in, or leave no place.
        """
        if self.room < 0:
            raise ValueError("no wall says where the floor ends")
        low, high = self.low[self.room], self.high[self.room]
        found, tried = np.empty((0, 3)), 0
        while len(found) < number:
            poses = generator.random((number + MORE, 3))
            poses[:, :2] = low + poses[:, :2] * (high - low)
            poses[:, 2] = np.pi * (1 - 2 * poses[:, 2])
            found = np.concatenate([found, poses[self.free(poses[:, :2])]])
            tried += number + MORE
            if not len(found) and tried > MOST_TRIES:
                raise ValueError("the map leaves no place where a robot can stand")
        return found[:number]

    def _holds(self, number: int, points: Array) -> Booleans:
        """Whether points (n, 2) lie in a polygon or circle : (n,)"""
        if number < len(self.rings):
            return _inside(self.rings[number], points)
        x, y, radius = self.circles[number - len(self.rings)].tolist()
        holds: Booleans = np.hypot(points[:, 0] - x, points[:, 1] - y) < radius
        return holds

    @twinned
    def reach(self, place: Array, ways: Array) -> Array:
        """How much of straight ways can be gone to where a robot can stand : (…), each in [0, 1]

        1 where that is so at the end of the way. Elsewhere the way is cut back to the last such
        place on it, 1 mm clear of the wall; to 0 where there is none.

        place : (…, 2) m, ways : (…, 2) m, broadcast together
        """
        place, ways = np.broadcast_arrays(place, ways)
        share = np.ones(place.shape[:-1])
        stuck = ~self.free(place + ways)
        if stuck.any():
            share[stuck] = self._cut_back(place[stuck], ways[stuck])
        return share

    def _cut_back(self, place: Array, ways: Array) -> Array:
        """The same of ways that end where no robot can stand : (n,)

        Every wall on a way parts it, and a part is free as a whole or not at all: each is tried in
        its middle, from the end of the way back to its beginning.
        """
        share, length = np.zeros(len(ways)), np.linalg.norm(ways, axis=-1)
        cuts, left = self._cuts(place, ways), np.arange(len(ways))
        for k in range(cuts.shape[1] - 1):
            far, near = cuts[left, k], cuts[left, k + 1]
            left, far, near = (each[far > 0] for each in (left, far, near))
            if not left.size:
                break
            middle = (far + near) / 2
            free = (far > near) & self.free(place[left] + middle[:, None] * ways[left])
            share[left[free]] = np.maximum(middle[free], far[free] - CLEARANCE / length[left[free]])
            left = left[~free]
        return share

    def _cuts(self, place: Array, ways: Array) -> Array:
        """Where ways meet walls, as shares of them, from the last to the first : (n, k); the way's
        own ends are two.
        """
        ends = place + ways
        low = np.fmin.reduce([place, ends]).min(axis=0)
        high = np.fmax.reduce([place, ends]).max(axis=0)
        touched = self.near(low, high)
        near = [
            _touching(self.rings[number], low, high)
            for number in touched
            if number < len(self.rings)
        ]
        circles = [number - len(self.rings) for number in touched if number >= len(self.rings)]
        round_ = _round_cuts(place, ways, self.circles[circles])
        edges = np.concatenate([np.empty((0, 2, 2)), *near])
        a, along = edges[:, 0], edges[:, 1] - edges[:, 0]
        offset, ways = a - place[:, None], ways[:, None]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            across = _cross(ways, along)
            cut, where = _cross(offset, along) / across, _cross(offset, ways) / across
            met = (cut > 0) & (cut < 1) & (np.abs(where - 0.5) <= 0.5 + HAIR)
        one = np.ones((len(place), 1))
        cuts = [one, np.where(met, cut, 0.0), round_, 0 * one]
        return -np.sort(-np.concatenate(cuts, axis=1), axis=1)

    def near(self, low: Array, high: Array) -> list[int]:
        """The polygons whose boxes touch the box from its corner `low` (2,) to `high` (2,); circles
        are numbered after them.
        """
        return self.touching(np.concatenate([high, -low]))

    def touching(self, box: Array) -> list[int]:
        """The same. box : (4,) m, its corner in the north-east, then the other with its sign
        turned.
        """
        touch: Booleans = np.logical_and.reduce(self._boxes <= box, axis=-1)
        numbers: list[int] = touch.nonzero()[0].tolist()
        return numbers

    @cached_property
    def _boxes(self) -> Array:
        """(p, 4) m: low, and −high, so that one comparison tells whether two boxes touch."""
        return np.concatenate([self.low, -self.high], axis=-1)

    def edges(self, number: int) -> list[Edge]:
        """A ring in plain numbers."""
        if number not in self._edges:
            self._edges[number] = [
                (ax, ay, bx, by) for (ax, ay), (bx, by) in self.rings[number].tolist()
            ]
        return self._edges[number]

    @cached_property
    def _edges(self) -> dict[int, list[Edge]]:
        """Those that were asked for: a robot comes near few of a building's."""
        return {}

    @cached_property
    def rounds(self) -> list[tuple[float, float, float]]:
        """The circles in plain numbers."""
        return [(x, y, radius) for x, y, radius in self.circles.tolist()]


def _touching(ring: Array, low: Array, high: Array) -> Array:
    """The edges of a ring whose boxes, a hair wider, touch that from `low` (2,) to `high` (2,)."""
    first, last = ring.min(axis=1), ring.max(axis=1)
    hair = HAIR * (last - first)
    touching: Booleans = ((first - hair <= high) & (last + hair >= low)).all(axis=-1)
    return ring[touching]


def _inside(ring: Array, points: Array) -> Booleans:
    """Whether points (n, 2) lie in a polygon : (n,). A line from there to the west crosses its
    edges oddly often.
    """
    if len(points) > 1:  # few edges of a building's outline are as far north as any of them
        south, north = points[:, 1].min(), points[:, 1].max()
        ring = ring[(ring[..., 1].min(axis=1) <= north) & (ring[..., 1].max(axis=1) > south)]
    (ax, ay), (bx, by) = ring[:, 0].T, ring[:, 1].T
    x, y = points[:, 0, None], points[:, 1, None]
    beside = (ay > y) != (by > y)
    rise = np.where(beside, by - ay, 1.0)
    odd: Booleans = (
        np.count_nonzero(beside & (x > ax + (bx - ax) * (y - ay) / rise), axis=-1) % 2 == 1
    )
    return odd


def _round_cuts(place: Array, ways: Array, circles: Array) -> Array:
    """Where ways (n, 2) from places (n, 2) meet circles (c, 3), as shares of them : (n, 2c); 0
    where they do not.

    p + s w lies on a circle of centre c and radius ρ where s² w·w + 2 s w·(p − c) = ρ² − |p − c|²
    """
    offset = place[:, None] - circles[:, :2]
    square = np.vecdot(ways, ways)[:, None]
    half = np.vecdot(ways[:, None], offset)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        root = np.sqrt(half**2 - square * (np.vecdot(offset, offset) - circles[:, 2] ** 2))
        cuts = np.concatenate([(-half - root) / square, (-half + root) / square], axis=1)
        return np.where((cuts > 0) & (cuts < 1), cuts, 0.0)


def _cross(v: Array, w: Array) -> Array:
    """v × w : (…)"""
    product: Array = v[..., 0] * w[..., 1] - v[..., 1] * w[..., 0]
    return product
