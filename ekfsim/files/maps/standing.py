"""Where a robot can start among the walls of a plan: where it has most room."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import shapely

from ekfsim.files.maps.plan import Plan, Start
from ekfsim.geometry import Array

CLOSE = 1.02  # times the room that was found: what is no more is not looked for
LEVELS = 16  # how often a square is parted: the smallest is 2⁻¹⁶ of the plan's side
MOST = 1024  # squares that are looked at on a level, the most promising of it
AT_ONCE = 512  # places that are looked up among the outlines: each may lie in all their boxes
PIECE = 1 / 64  # of a plan's side: how long a wall is at the most that is looked up
MOST_PIECES = 2_000_000  # more than there are walls
QUARTERS = np.array([(-1, -1), (-1, 1), (1, -1), (1, 1)]) / 2  # of half a square's side


def roomiest(plan: Plan) -> tuple[Start, float] | None:
    """The place with most room about it, looking along +x; and how much that is, m. None where a
    robot can stand nowhere.

    Squares are parted into four, and those left behind in which no place can have more room than
    the best so far: at a middle with room r, none in a square of side s has more than r + s/√2.
    """
    floor = _Floor.of(plan)
    low, high = floor.low, floor.high
    half = float((high - low).max()) / 2
    middles, best, room = (low + high)[None] / 2, None, 0.0
    for _ in range(LEVELS):
        rooms = floor.room(middles)
        if rooms.max() > room:
            best, room = middles[rooms.argmax()], float(rooms.max())
        most = rooms + half * math.sqrt(2)
        hopeful = np.argsort(-most, kind="stable")[:MOST]
        hopeful = hopeful[most[hopeful] > CLOSE * room]
        if not len(hopeful):
            break
        middles = (middles[hopeful, None] + half * QUARTERS).reshape(-1, 2)
        half /= 2
    if best is None:
        return None
    rounded = np.round(best, 1 - math.floor(math.log10(room)))  # two digits of how much room
    x, y = rounded.tolist()
    return (x, y, 0.0), float(floor.room(rounded[None])[0])


@dataclass(frozen=True, slots=True)
class _Floor:
    """What walls a plan in, and what takes up room in it."""

    around: Any  # the shapely.Polygon that is looked through
    solid: Any  # a tree of outlines and circles
    walls: Any  # a tree of their edges, of all lines, and of what lies around
    low: Array  # (2,) m, of the box of what lies around
    high: Array  # (2,) m

    @classmethod
    def of(cls, plan: Plan) -> Self:
        """The floor of a plan; where it has no room, the box of all that it holds is one."""
        rounds = [shapely.Point(one.x, one.y).buffer(one.radius) for one in plan.circles]
        rims = [np.vstack([ring, ring[:1]]) for ring in _rings(plan)]
        rims += [line.points for line in plan.lines]
        rims += [shapely.get_coordinates(one) for one in rounds]
        indoors = plan.boundary if plan.indoors is None else plan.indoors
        around = _box_of(rims) if indoors is None else shapely.Polygon(indoors)
        shapely.prepare(around)
        solid = [*(shapely.Polygon(one.points, one.holes) for one in plan.outlines), *rounds]
        shapely.prepare(solid)
        rims.append(shapely.get_coordinates(around))
        edges: Any = np.concatenate([np.stack([rim[:-1], rim[1:]], axis=1) for rim in rims])
        low, high = np.reshape(around.bounds, (2, 2))
        side = float((high - low).max())
        near = shapely.clip_by_rect(shapely.linestrings(edges), *(low - side), *(high + side))
        edges = shapely.get_coordinates(near[shapely.get_num_coordinates(near) == 2])
        walls: Any = shapely.linestrings(_in_pieces(edges.reshape(-1, 2, 2), side * PIECE))
        return cls(around, shapely.STRtree(solid), shapely.STRtree(walls), low, high)

    def room(self, places: Array) -> Array:
        """How far the next wall is : (n,) m, and less than 0 where a robot cannot stand.
        places : (n, 2) m
        """
        points: Any = shapely.points(places)
        far = shapely.distance(self.walls.geometries[self.walls.nearest(points)], points)
        free = shapely.contains_xy(self.around, *places.T)
        for some in np.split(np.arange(len(places)), range(AT_ONCE, len(places), AT_ONCE)):
            which, what = self.solid.query(points[some])
            held = shapely.contains_xy(self.solid.geometries[what], *places[some[which]].T)
            free[some[which[held]]] = False
        room: Array = np.where(free, far, -far)
        return room


def _rings(plan: Plan) -> Iterator[Array]:
    """The rims of all outlines and of their holes, (n, 2) m each."""
    for one in plan.outlines:
        yield one.points
        yield from one.holes


def _in_pieces(edges: Array, longest: float) -> Array:
    """The same edges (n, 2, 2), parted where they are longer than `longest`, m : (k, 2, 2). A tree
    finds the next of many small boxes soon, and has to try each of those that lie over each other.
    """
    a, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    length = np.hypot(*along.T)
    longest = max(longest, length.sum() / MOST_PIECES)
    parts = np.maximum(np.ceil(length / longest), 1).astype(int)
    which = np.repeat(np.arange(len(edges)), parts)
    number = np.arange(len(which)) - np.repeat(np.cumsum(parts) - parts, parts)
    ends = np.stack([number, number + 1], axis=1) / parts[which, None]
    pieces: Array = a[which, None] + ends[..., None] * along[which, None]
    return pieces


def _box_of(rims: Sequence[Array]) -> Any:
    """The shapely.Polygon about all points (n, 2), wider by a metre where it would be flat."""
    points = np.concatenate([*rims, np.empty((0, 2))])
    if not len(points):
        return shapely.box(0, 0, 2, 2)
    low, high = points.min(axis=0), points.max(axis=0)
    flat = low == high
    return shapely.box(*(low - flat), *(high + flat))
