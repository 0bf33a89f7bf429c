"""Beams of runs that go much the same way, against the few walls before them, compiled by Numba.

The twin of `Walls.cast`. Seen from the middle of the beams, along their mean direction, none leaves
the wedge

    |across| ≤ ρ + (along + ρ) tan δ     ρ: how far origins lie off, δ: how far directions part

so that the walls that none can meet are left out, once for all; see nearby_beams.py. Nothing
doubtful is decided here: a beam that passes within a hair of a wall's end, or begins within one of
a wall, is left to `Walls.cast`. All arrays have their entries in front and the runs behind.
"""

import math

import numpy as np

from ekfsim.fast.compiled.angles import directions
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.twins import compiled

DOUBT = -2  # in place of a wall
# SPREAD, APART and SAFE as in nearby_beams.py: written again, since what Numba has kept is made
# anew when this file changes, and not when that one does
SPREAD = 0.35  # rad; a beam that parts more from the others is followed by itself
APART = 0.05  # of the walls' extent: and so is one that begins farther from them
SAFE = 1e-6  # of the coordinates' size: by so much the wedge is wider than it need be
SAMPLE = 16  # runs, of which the one that is nearest to the others is the middle of all
MANY = 100  # walls from which on beams that go their own ways are sooner searched for in a grid


@compiled
def cast(
    ends: Array, place: Array, heading: Array, size: float, tie: float, doubt: float,
    ranges: Array, walls: Integers, way: Array,
) -> int:  # fmt: skip
    """Fill in ranges, walls and unit directions; how many beams are left in doubt.

    ends : (W, 4) m: x, y of both ends of each wall; place : (3, N), x, y, θ; ranges, walls : (N,);
    way : (2, N); size : m, the largest coordinate of any wall; tie, doubt : shares of it
    """
    N = place.shape[1]
    directions(heading, way[0], way[1])
    near, numbers, every = np.empty(ends.shape), np.empty(len(ends), np.int64), np.arange(len(ends))
    least, none = np.empty(len(ends)), np.zeros(len(ends))
    alone = np.empty(N, np.bool_)
    lone = _part(place, way, APART * _extent(ends), alone)
    count = _before(ends, place, way, alone, size, near, numbers, least)
    walk = len(ends) > MANY and 4 * lone > N
    left = 0
    for n in range(N):
        x, y, dx, dy = place[0, n], place[1, n], way[0, n], way[1, n]
        span = size + abs(x) + abs(y)
        hair = doubt * span * span
        if not alone[n]:
            hit = _first(near, numbers, least, count, x, y, dx, dy, tie * span, hair)
        elif walk or not (-1 <= dx <= 1 and span < math.inf):
            hit = math.nan, DOUBT
        else:
            hit = _first(ends, every, none, len(ends), x, y, dx, dy, tie * span, hair)
        ranges[n], walls[n] = hit
        left += walls[n] == DOUBT
    return left


@compiled
def stop(
    ends: Array, place: Array, heading: Array, way: Array, clearance: float,
    size: float, tie: float, doubt: float, unsure: Integers,
) -> int:  # fmt: skip
    """Cut ways short of the first wall; how many are left in doubt, and which, in `unsure`.

    What lies out of reach needs no look: whether a beam meets it, it does not stop the robot.
    place : (3, N), x, y, θ; way : (N,) m, backwards where it is negative
    """
    N = place.shape[1]
    left = bottom = math.inf
    right = top = -math.inf
    for n in range(N):
        far = abs(way[n]) + 2 * clearance
        left, right = min(left, place[0, n] - far), max(right, place[0, n] + far)
        bottom, top = min(bottom, place[1, n] - far), max(top, place[1, n] + far)
    around, some = np.empty(ends.shape), 0
    for w in range(len(ends)):
        if _touches(ends, w, left, bottom, right, top):
            _put(around, some, ends, w)
            some += 1
    if not some:
        return 0
    aim, alone = np.empty((2, N)), np.empty(N, np.bool_)
    directions(heading, aim[0], aim[1])
    near, numbers, least = np.empty(ends.shape), np.empty(len(ends), np.int64), np.empty(len(ends))
    every, none = np.arange(some), np.zeros(some)
    _part(place, aim, APART * _extent(ends), alone)
    count = _before(around[:some], place, aim, alone, size, near, numbers, least)
    doubtful = 0
    for n in range(N):
        x, y, dx, dy = place[0, n], place[1, n], aim[0, n], aim[1, n]
        span = size + abs(x) + abs(y)
        hair = doubt * span * span
        if alone[n]:
            r, wall = _first(around, every, none, some, x, y, dx, dy, tie * span, hair)
        elif count and least[0] <= abs(way[n]) + 2 * clearance:
            r, wall = _first(near, numbers, least, count, x, y, dx, dy, tie * span, hair)
        else:
            continue
        if wall == DOUBT:
            unsure[doubtful] = n
            doubtful += 1
        elif wall >= 0 and abs(way[n]) > max(r - clearance, 0.0):
            way[n] = math.copysign(max(r - clearance, 0.0), way[n])
    return doubtful


@compiled
def _touches(ends: Array, w: int, left: float, bottom: float, right: float, top: float) -> bool:
    """Whether a wall's box touches another one."""
    ax, ay, bx, by = ends[w, 0], ends[w, 1], ends[w, 2], ends[w, 3]
    beside = (min(ax, bx) <= right) & (max(ax, bx) >= left)
    touches: bool = beside & (min(ay, by) <= top) & (max(ay, by) >= bottom)
    return touches


@compiled
def _first(
    ends: Array, numbers: Integers, least: Array, count: int,
    x: float, y: float, dx: float, dy: float, tie: float, doubt: float,
) -> tuple[float, int]:  # fmt: skip
    """Range and wall of a beam among the first `count` walls; of those within a tie the lowest.

    least : (W,) m, no wall is nearer than that, and none that follows it. The nearest ranges so far
    are from `low` to `high`. A range within a tie of one of them but not of all is left in doubt.
    """
    low = high = math.inf
    nearest = -1
    for k in range(count):
        if least[k] > low + tie:
            break
        ax, ay, bx, by = ends[k, 0] - x, ends[k, 1] - y, ends[k, 2] - x, ends[k, 3] - y
        across_a, across_b = ax * dy - ay * dx, bx * dy - by * dx
        sides = across_a * across_b
        if sides > doubt:
            continue  # both ends on one side
        along_a, along_b = ax * dx + ay * dy, bx * dx + by * dy
        area = along_a * across_b - along_b * across_a
        if sides >= -doubt or abs(area) <= doubt:
            return math.nan, DOUBT
        r = area / (across_b - across_a)
        if r < 0 or r > low + tie:
            continue
        if r < low - tie:
            low, high, nearest = r, r, numbers[k]
        elif r >= high - tie:
            low, high, nearest = min(low, r), max(high, r), min(nearest, numbers[k])
        else:
            return math.nan, DOUBT
    return low if nearest >= 0 else math.nan, nearest


@compiled
def _put(into: Array, at: int, ends: Array, w: int) -> None:
    """Copy a wall."""
    for k in range(4):
        into[at, k] = ends[w, k]


@compiled
def _extent(ends: Array) -> float:
    """From the least coordinate of all walls to the greatest, in m."""
    low, high = math.inf, -math.inf
    for w in range(len(ends)):
        for k in range(4):
            low, high = min(low, ends[w, k]), max(high, ends[w, k])
    return high - low


@compiled
def _part(place: Array, way: Array, apart: float, alone: Booleans) -> int:
    """Which beams go their own way, and how many these are: far from one in the middle of some."""
    N = place.shape[1]
    step = max(1, N // SAMPLE)
    middle, least = 0, math.inf
    for n in range(0, N, step):
        off = 0.0
        for m in range(0, N, step):
            off += (abs(place[0, m] - place[0, n]) + abs(place[1, m] - place[1, n])) / apart
            off += (abs(way[0, m] - way[0, n]) + abs(way[1, m] - way[1, n])) / SPREAD
        if off < least:
            middle, least = n, off
    x, y, dx, dy = place[0, middle], place[1, middle], way[0, middle], way[1, middle]
    cosine, lone = math.cos(SPREAD), 0
    for n in range(N):
        close = (abs(place[0, n] - x) <= apart) & (abs(place[1, n] - y) <= apart)
        alone[n] = not (close & (way[0, n] * dx + way[1, n] * dy >= cosine))
        lone += alone[n]
    return lone


@compiled
def _before(
    ends: Array, place: Array, way: Array, alone: Booleans, size: float,
    near: Array, numbers: Integers, least: Array,
) -> int:  # fmt: skip
    """The walls that beams of the bundle may meet, the nearest first, and how many those are.

    near : (W, 4), numbers : (W,), least : (W,) m, how far they are off at least, to be filled in
    """
    N, together = len(alone), 0
    mx = my = ux = uy = 0.0
    for n in range(N):
        if not alone[n]:
            together += 1
            mx, my, ux, uy = mx + place[0, n], my + place[1, n], ux + way[0, n], uy + way[1, n]
    if together == 0:
        return 0
    length = math.hypot(ux, uy)
    mx, my, ux, uy = mx / together, my / together, ux / length, uy / length
    far_x = far_y = 0.0
    cosine = 1.0
    for n in range(N):
        if not alone[n]:
            far_x, far_y = max(far_x, abs(place[0, n] - mx)), max(far_y, abs(place[1, n] - my))
            cosine = min(cosine, way[0, n] * ux + way[1, n] * uy)
    ρ = math.hypot(far_x, far_y) + SAFE * (size + abs(mx) + abs(my))
    tan_δ = math.sqrt(max(1 / (cosine * cosine) - 1, 0.0) + SAFE)
    limit = math.inf
    for found in (False, True):  # first how far any can go, then what they may meet until there
        count = 0
        for w in range(len(ends)):
            ax, ay, bx, by = ends[w, 0] - mx, ends[w, 1] - my, ends[w, 2] - mx, ends[w, 3] - my
            along_a, along_b = ax * ux + ay * uy, bx * ux + by * uy
            across_a, across_b = ax * uy - ay * ux, bx * uy - by * ux
            half_a, half_b = ρ + (along_a + ρ) * tan_δ, ρ + (along_b + ρ) * tan_δ
            right_a, right_b = across_a > half_a, across_b > half_b
            left_a, left_b = across_a < -half_a, across_b < -half_b
            nearest, farthest = min(along_a, along_b), max(along_a, along_b)
            beside = (right_a and right_b) or (left_a and left_b)
            if found and not beside and -ρ <= farthest and nearest <= limit:
                distance = _distance(ax, ay, bx, by) - ρ
                at = count
                while at and least[at - 1] > distance:
                    _put(near, at, near, at - 1)
                    numbers[at], least[at] = numbers[at - 1], least[at - 1]
                    at -= 1
                _put(near, at, ends, w)
                numbers[at], least[at] = w, distance
                count += 1
            if nearest > ρ and ((right_a and left_b) or (left_a and right_b)):
                limit = min(limit, farthest)
    return count


@compiled
def _distance(ax: float, ay: float, bx: float, by: float) -> float:
    """From the origin to a wall, in m."""
    east, north = bx - ax, by - ay
    foot = min(max(-(ax * east + ay * north) / (east * east + north * north), 0.0), 1.0)
    return math.hypot(ax + foot * east, ay + foot * north)
