"""Many beams, one after the other from cell to cell of a grid, compiled by Numba: the extra `fast`.

Imported only where twins.py has been told to take what is compiled. The steps are those of
`single_beam.walk`, but nothing doubtful is decided here: a beam that passes within a hair of a
wall's end, or begins within one of a wall, is left to the other searches.
"""

from math import inf, nan

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.rules import REACH, TIE
from ekfsim.raycast.searches.choice import in_blocks, together
from ekfsim.raycast.searches.flat_grid import BORDER, FlatGrid
from ekfsim.raycast.walls import Hit, Walls
from ekfsim.twins import compiled

FEW = 16  # beams that are sooner followed in plain floats
DOUBT = -2  # in place of a wall


def cast(walls: Walls, origin: Array, heading: Array) -> Hit | None:
    """`Walls.cast` of many beams; None where they are few."""
    x, y, heading = together(origin, heading)
    return in_blocks(_search, walls, x, y, heading) if heading.size > FEW else None


def _search(walls: Walls, beams: Array) -> tuple[Array, Integers, Integers]:
    return walk(walls.flat_grid, *beams)


def walk(
    grid: FlatGrid, x: Array, y: Array, dx: Array, dy: Array
) -> tuple[Array, Integers, Integers]:
    """Ranges and walls of many beams, all (n,), and which are left in doubt; those beyond the
    horizon are, too.
    """
    ranges, walls = np.empty(x.shape), np.empty(x.shape, np.int64)
    tree = grid.ends, grid.walls, grid.start, grid.within, grid.place, grid.shape
    left = _walk_all(
        *tree, grid.grid.size, grid.grid.horizon, TIE, 4 * REACH, x, y, dx, dy, ranges, walls
    )
    return ranges, walls, np.flatnonzero(walls == DOUBT) if left else walls[:0]


@compiled
def _try(
    ends: Array, walls: Integers, begin: int, end: int, x: float, y: float, dx: float, dy: float,
    tie: float, doubt: float, low: float, high: float, nearest: int,
) -> tuple[float, float, int]:  # fmt: skip
    """Try the walls of one cell. The nearest ranges so far are from `low` to `high` and differ by
    no more than a tie.

    Of their walls `nearest` has the lowest index. A range within a tie of one but not of all is
    left in doubt.
    """
    for k in range(begin, end):
        ax, ay, bx, by = ends[k, 0] - x, ends[k, 1] - y, ends[k, 2] - x, ends[k, 3] - y
        across_a, across_b = ax * dy - ay * dx, bx * dy - by * dx
        sides = across_a * across_b
        if sides > doubt:
            continue  # both ends on one side
        along_a, along_b = ax * dx + ay * dy, bx * dx + by * dy
        area = along_a * across_b - along_b * across_a
        if sides >= -doubt or abs(area) <= doubt:
            return low, high, DOUBT
        r = area / (across_b - across_a)
        if r < 0 or r > low + tie:
            continue
        if r < low - tie:
            low, high, nearest = r, r, walls[k]
        elif r >= high - tie:
            low, high, nearest = min(low, r), max(high, r), min(nearest, walls[k])
        else:
            return low, high, DOUBT
    return low, high, nearest


@compiled
def _enter(
    place: Array, shape: Integers, grid: int, x: float, y: float, dx: float, dy: float
) -> tuple[int, int, int, float, float, float, float]:
    """The first cell on the way through a grid, the steps to the next ones, and the ranges when
    these are due.

    A beam that passes the grid by begins in the corner of its border, where a walk ends.
    """
    cell, columns, rows, first = place[grid, 2], shape[grid, 0], shape[grid, 1], shape[grid, 2]
    u, v = (x - place[grid, 0]) / cell, (y - place[grid, 1]) / cell
    enter, leave = 0.0, inf
    if not (1 <= u < columns - 1 and 1 <= v < rows - 1):
        for at, d, count in ((u, dx, columns), (v, dy, rows)):
            if d != 0:
                one, other = (1 - at) / d, (count - 1 - at) / d
                enter, leave = max(enter, min(one, other)), min(leave, max(one, other))
            elif not 1 <= at <= count - 1:
                leave = -inf
        if not enter <= leave:
            return first, 0, 0, inf, inf, inf, inf
    i = min(max(int(u + enter * dx), 1), columns - 2)
    j = min(max(int(v + enter * dy), 1), rows - 2)
    per_x, per_y = cell / dx, cell / dy
    x_exit = (i + (dx > 0) - u) * per_x if dx != 0 else inf
    y_exit = (j + (dy > 0) - v) * per_y if dy != 0 else inf
    return (
        first + i * rows + j,
        rows if dx > 0 else -rows,
        1 if dy > 0 else -1,
        x_exit,
        y_exit,
        abs(per_x),
        abs(per_y),
    )


@compiled
def _walk_all(
    ends: Array, numbers: Integers, start: Integers, within: Integers, place: Array,
    shape: Integers,
    size: float, horizon: float, tie: float, doubt: float,
    x: Array, y: Array, dx: Array, dy: Array, ranges: Array, walls: Integers,
) -> int:  # fmt: skip
    """Fill in ranges and walls; how many beams are left in doubt.

    Where a beam comes to a crowded cell, the grid in there waits until the present one is done. All
    in one function, since calls with so many arrays are dear: apart, the walk takes three times as
    long.
    """
    # grids that wait, the ranges where they begin
    upcoming, due = np.zeros(len(place), np.int64), np.zeros(len(place))
    left = 0
    for k in range(len(x)):
        far = abs(x[k]) + abs(y[k])
        known = far < horizon and -1 <= dx[k] <= 1  # else out there, or not a number
        span = size + far
        near, vague = tie * span, doubt * span * span
        low, high, wall = inf, inf, -1 if known else DOUBT
        done, count = 0, 1
        while done < count and wall != DOUBT:
            leaving = due[done]
            at, x_step, y_step, x_exit, y_exit, x_cell, y_cell = _enter(
                place, shape, upcoming[done], x[k], y[k], dx[k], dy[k]
            )
            done += 1
            while leaving <= low + near and within[at] != BORDER:
                if within[at] >= 0:
                    upcoming[count], due[count] = within[at], leaving
                    count += 1
                low, high, wall = _try(
                    ends, numbers, start[at], start[at + 1],
                    x[k], y[k], dx[k], dy[k], near, vague, low, high, wall,
                )  # fmt: skip
                if wall == DOUBT:
                    break
                leaving = min(x_exit, y_exit)
                if x_exit < y_exit:
                    at += x_step
                    x_exit += x_cell
                else:
                    at += y_step
                    y_exit += y_cell
        ranges[k], walls[k] = low if wall >= 0 else nan, wall
        left += wall == DOUBT
    return left
