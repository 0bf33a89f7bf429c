"""The walk of one beam after the other through the cells of a grid, compiled by Numba: the extra `fast`.

Imported only where engine.py has been told to use it. The steps are those of `Grid.walk`, but nothing doubtful is
decided here: a beam that passes within a hair of a wall's end, or begins within one of a wall, is left to march.py.
"""

from collections.abc import Callable
from math import inf, nan
from typing import TypeVar, cast

import numpy as np
from numba import njit

from ekfsim.geometry import Array, Integers
from ekfsim.geometry.cells import BORDER, Cells
from ekfsim.geometry.meeting import REACH, TIE

DOUBT = -2  # in place of a wall

Function = TypeVar("Function", bound=Callable[..., object])


def compiled(function: Function) -> Function:
    """Compile at the first call, and keep the result for later processes where there is a folder to keep it in."""
    try:
        return cast("Function", njit(cache=True, nogil=True)(function))
    except RuntimeError:  # no folder that can be written
        return cast("Function", njit(nogil=True)(function))


@compiled
def _enter(
    place: Array, shape: Integers, grid: int, x: float, y: float, dx: float, dy: float
) -> tuple[int, int, int, float, float, float, float]:
    """The first cell on the way through a grid, the steps to the next ones, and the ranges when these are due.

    A beam that passes the grid by begins in the corner of the border, where its walk ends.
    """
    left, bottom, cell = place[grid]
    columns, rows, first = shape[grid]
    u, v = (x - left) / cell, (y - bottom) / cell
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
    x_exit = (i + (dx > 0) - u) * cell / dx if dx != 0 else inf
    y_exit = (j + (dy > 0) - v) * cell / dy if dy != 0 else inf
    x_cell = abs(cell / dx) if dx != 0 else inf
    y_cell = abs(cell / dy) if dy != 0 else inf
    return first + i * rows + j, rows if dx > 0 else -rows, 1 if dy > 0 else -1, x_exit, y_exit, x_cell, y_cell


@compiled
def _try(
    ends: Array, numbers: Integers, begin: int, end: int,
    x: float, y: float, dx: float, dy: float, tie: float, doubt: float, low: float, high: float, nearest: int,
) -> tuple[float, float, int]:  # fmt: skip
    """Try the walls of one cell. The nearest so far lie between `low` and `high`, which are within a tie.

    Of these `nearest` is the lowest. A range within a tie of one of them, but not of all, is left in doubt.
    """
    for k in range(begin, end):
        ax, ay, bx, by = ends[k, 0] - x, ends[k, 1] - y, ends[k, 2] - x, ends[k, 3] - y
        across_a, across_b = ax * dy - ay * dx, bx * dy - by * dx
        sides = across_a * across_b
        if sides > doubt:
            continue  # both ends on one side
        along_a, along_b = ax * dx + ay * dy, bx * dx + by * dy
        area = along_a * across_b - along_b * across_a
        if not sides < -doubt or abs(area) <= doubt:
            return low, high, DOUBT
        r = area / (across_b - across_a)
        if r < 0 or r > low + tie:
            continue
        if r < low - tie:
            low, high, nearest = r, r, numbers[k]
        elif r >= high - tie:
            low, high, nearest = min(low, r), max(high, r), min(nearest, numbers[k])
        else:
            return low, high, DOUBT
    return low, high, nearest


@compiled
def _walk_all(
    ends: Array, numbers: Integers, start: Integers, within: Integers, place: Array, shape: Integers,
    x: Array, y: Array, dx: Array, dy: Array, ties: Array, doubts: Array, ranges: Array, walls: Integers,
) -> int:  # fmt: skip
    """Fill in ranges and walls; the number of beams in doubt.

    Where a beam comes to a crowded cell, the walk through the grid in it is put off until the present one is done.
    """
    upcoming, due = np.zeros(len(place), np.int64), np.zeros(len(place))  # grids to walk, the range where each begins
    left = 0
    for k in range(len(x)):
        tie = ties[k]
        low, high, wall = inf, inf, -1
        done, count = 0, 1
        while done < count and wall != DOUBT:
            grid = upcoming[done]
            if due[done] <= low + tie:
                at, x_step, y_step, x_exit, y_exit, x_cell, y_cell = _enter(
                    place, shape, grid, x[k], y[k], dx[k], dy[k]
                )
                leaving = due[done]
                while within[at] != BORDER:
                    if within[at] >= 0:
                        upcoming[count], due[count] = within[at], leaving
                        count += 1
                    low, high, wall = _try(
                        ends,
                        numbers,
                        start[at],
                        start[at + 1],
                        x[k],
                        y[k],
                        dx[k],
                        dy[k],
                        tie,
                        doubts[k],
                        low,
                        high,
                        wall,
                    )
                    leaving = min(x_exit, y_exit)
                    if low + tie < leaving or wall == DOUBT:
                        break
                    if x_exit < y_exit:
                        at += x_step
                        x_exit += x_cell
                    else:
                        at += y_step
                        y_exit += y_cell
            done += 1
        ranges[k], walls[k] = low if wall >= 0 else nan, wall
        left += wall == DOUBT
    return left


def walk(cells: Cells, x: Array, y: Array, dx: Array, dy: Array, span: Array) -> tuple[Array, Integers, Integers]:
    """Ranges and walls of many beams, all (n,), and which beams are left in doubt."""
    ranges, walls = np.empty(x.shape), np.empty(x.shape, np.int64)
    tree = cells.ends, cells.walls, cells.start, cells.within, cells.place, cells.shape
    left = _walk_all(*tree, x, y, dx, dy, TIE * span, 4 * REACH * span * span, ranges, walls)
    return ranges, walls, np.flatnonzero(walls == DOUBT) if left else walls[:0]
