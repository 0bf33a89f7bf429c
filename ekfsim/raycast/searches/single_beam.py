"""One beam from cell to cell of a grid, in plain floats: where no array is worth its while."""

from collections.abc import Sequence
from math import cos, hypot, inf, isfinite, nan, sin, sqrt

import numpy as np

from ekfsim.raycast.brute import brute_force
from ekfsim.raycast.round_walls import RoundWalls
from ekfsim.raycast.rules import REACH, TIE
from ekfsim.raycast.searches.grid import Grid, Wall
from ekfsim.raycast.walls import Walls

FEW_CIRCLES = 32  # that are sooner tried one after another than all at once
RECENT = 8  # beams that are remembered
NOTHING: list[Wall] = []


def first(walls: Walls, x: float, y: float, heading: float) -> tuple[float, int]:
    """`Walls.first`. The last few beams are remembered: one is looked along before its reading is
    used, and followed again when it is.
    """
    beam, recent = (x, y, heading), walls.recent
    hit = recent.get(beam)
    if hit is None:
        if len(recent) >= RECENT:
            recent.clear()
        hit = recent[beam] = found(walls, x, y, heading)
    return hit


def found(walls: Walls, x: float, y: float, heading: float) -> tuple[float, int]:
    """The same of a beam that nobody will ask for again."""
    if not isfinite(x + y + heading):
        return nan, -1
    grid, dx, dy = walls.grid, cos(heading), sin(heading)
    straight = (nan, -1) if grid is None else follow(grid, x, y, dx, dy)
    return straight if walls.round is None else _before(walls.round, straight, x, y, dx, dy)


def _before(
    round_: RoundWalls, straight: tuple[float, int], x: float, y: float, dx: float, dy: float
) -> tuple[float, int]:
    """`RoundWalls.before` of one beam."""
    span = round_.extent + abs(x) + abs(y)
    reach, tie, best = REACH * span, TIE * span, inf
    met: list[tuple[float, int]] = []
    for circle in _on_the_way(round_, x, y, dx, dy, reach):
        east, north, radius = round_.plain[circle]
        wall, east, north = round_.first + circle, east - x, north - y
        across = abs(east * dy - north * dx)
        if across > radius + reach:
            continue
        along = east * dx + north * dy
        distance = hypot(along, across)
        half = sqrt(max((radius - across) * (radius + across), 0.0))
        r = along + half if distance < radius else along - half
        if abs(distance - radius) <= reach:
            r = 0.0
        if 0 <= r <= best + tie:
            met.append((r, wall))
            best = min(best, r)
    r, wall = straight
    if not met or r <= best + tie:
        return (min(r, best) if wall >= 0 else nan), wall
    return best, min(wall for r, wall in met if r <= best + tie)


def _on_the_way(
    round_: RoundWalls, x: float, y: float, dx: float, dy: float, reach: float
) -> Sequence[int]:
    """The circles that lie on a beam's line, and not wholly behind it; all where they are few."""
    circles = round_.circles
    if len(circles) <= FEW_CIRCLES:
        return range(len(circles))
    east, north = circles[:, 0] - x, circles[:, 1] - y
    touched = np.abs(east * dy - north * dx) <= circles[:, 2] + 2 * reach
    touched &= east * dx + north * dy + circles[:, 2] >= -2 * reach
    numbers: list[int] = np.flatnonzero(touched).tolist()
    return numbers


def follow(grid: Grid, x: float, y: float, dx: float, dy: float) -> tuple[float, int]:
    """Range and wall of a beam in the unit direction (dx, dy), from however far."""
    if abs(x) + abs(y) < grid.horizon:
        return walk(grid, x, y, dx, dy)
    (r,), (wall,) = brute_force(grid.segments, *np.array([[x], [y], [dx], [dy]]))
    return float(r), int(wall)


def walk(grid: Grid, x: float, y: float, dx: float, dy: float) -> tuple[float, int]:
    """Range and wall of a beam in the unit direction (dx, dy); nan and −1 where it meets none."""
    left, bottom, cell, columns, rows, size, lists = grid.plain
    u, v = (x - left) / cell, (y - bottom) / cell
    i, j = int(u), int(v)
    if not (0 < i < columns - 1 and 0 < j < rows - 1):
        entry = _entry(u, v, dx, dy, columns, rows)
        if entry is None:
            return nan, -1
        i, j = entry
    # the step to the next cell's number, the range at which it is due, and that to one more
    x_step, x_exit, x_cell = rows if dx > 0 else -rows, inf, inf
    y_step, y_exit, y_cell = 1 if dy > 0 else -1, inf, inf
    if dx:
        x_exit, x_cell = (i + (dx > 0) - u) * cell / dx, abs(cell / dx)
    if dy:
        y_exit, y_cell = (j + (dy > 0) - v) * cell / dy, abs(cell / dy)

    span = size + abs(x) + abs(y)
    tie, doubt = TIE * span, 4 * REACH * span * span
    at, aim = i * rows + j, x * dy - y * dx
    best, limit = inf, inf
    found: list[tuple[float, int]] = []
    while True:
        listed = lists[at]
        if listed is None:  # a crowded cell, or the border
            if at not in grid.crowded:
                break
            r, wall = walk(grid.crowded[at], x, y, dx, dy)
            if r <= limit:
                found.append((r, wall))
                best = min(best, r)
                limit = best + tie
            listed = NOTHING
        for ax, ay, bx, by, wall in listed:
            if (ax * dy - ay * dx - aim) * (bx * dy - by * dx - aim) > doubt:
                continue  # both ends on one side
            r = _crossing(ax - x, ay - y, bx - x, by - y, dx, dy, doubt, span)
            if 0 <= r <= limit:
                found.append((r, wall))
                if r < best:
                    best, limit = r, r + tie
        if x_exit < y_exit:
            if limit < x_exit:
                break
            at += x_step
            x_exit += x_cell
        else:
            if limit < y_exit:
                break
            at += y_step
            y_exit += y_cell
    if len(found) < 2:
        return found[0] if found else (nan, -1)
    return best, min(wall for r, wall in found if r <= limit)


def _crossing(
    ax: float, ay: float, bx: float, by: float, dx: float, dy: float, doubt: float, span: float
) -> float:
    """Where a beam from the origin meets a wall from a to b: less than 0 or nan where it does not.

    Where the ends lie clearly on both sides, and the origin clearly off the wall, the crossing is
    all.
    """
    across_a, across_b = ax * dy - ay * dx, bx * dy - by * dx
    along_a, along_b = ax * dx + ay * dy, bx * dx + by * dy
    area = along_a * across_b - along_b * across_a
    if across_a * across_b < -doubt and not -doubt <= area <= doubt:
        return area / (across_b - across_a)
    return _meet(along_a, across_a, along_b, across_b, REACH * span)


def _meet(along_a: float, across_a: float, along_b: float, across_b: float, reach: float) -> float:
    """`rules.meet` of one beam and one wall; less than 0 or nan where they do not."""
    ahead, aside = along_b - along_a, across_b - across_a
    square = ahead * ahead + aside * aside or 1.0
    foot = min(max(-(along_a * ahead + across_a * aside) / square, 0.0), 1.0)
    if hypot(along_a + foot * ahead, across_a + foot * aside) <= reach:
        return 0.0
    if abs(across_a) <= reach or abs(across_b) <= reach:
        ends = (along_a, across_a), (along_b, across_b)
        return min(along for along, across in ends if abs(across) <= reach)
    if (across_a < 0) == (across_b < 0):
        return nan
    return (along_a * across_b - along_b * across_a) / aside


def _entry(
    u: float, v: float, dx: float, dy: float, columns: int, rows: int
) -> tuple[int, int] | None:
    """The first cell inside the border on the way of a beam that starts outside, at (u, v) in units
    of cells.
    """
    enter, leave = 0.0, inf
    for place, d, count in ((u, dx, columns), (v, dy, rows)):
        if d:
            first, last = (1 - place) / d, (count - 1 - place) / d
            enter, leave = max(enter, min(first, last)), min(leave, max(first, last))
        elif not 1 <= place <= count - 1:
            return None
    i, j = min(max(int(u + enter * dx), 1), columns - 2), min(max(int(v + enter * dy), 1), rows - 2)
    return (i, j) if enter <= leave else None
