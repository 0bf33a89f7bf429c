"""Many beams at once through the cells of a grid: in every pass each beam tries the walls of its
cell and steps on.

The steps are those of `single_beam.walk`. Where a beam comes to a crowded cell, a second walk of
the same beam begins in the grid of that cell, while the first goes on; what either finds shortens
both.
"""

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.rules import TIE
from ekfsim.raycast.searches.candidates import first_of, measure
from ekfsim.raycast.searches.flat_grid import BORDER, FlatGrid
from ekfsim.raycast.searches.grid import spread


def many_beams(cells: FlatGrid, x: Array, y: Array, dx: Array, dy: Array) -> tuple[Array, Integers]:
    """Ranges and walls of many beams, all (n,)."""
    span = cells.grid.size + np.abs(x) + np.abs(y)
    beams = np.stack([x, y, dx, dy, span])
    tie = TIE * span
    # nothing farther matters: the nearest range so far, and a tie more
    limit = np.full(len(x), np.inf)
    everyone = np.arange(len(x))
    place, due = _enter(cells, beams, everyone, np.zeros_like(everyone))
    found = [(everyone[:0], everyone[:0], x[:0])]
    while place.size:
        beam, at, x_step, y_step = place
        begin = cells.start[at]
        which, nth = spread(cells.start[at + 1] - begin)
        if which.size:
            listed, which = begin[which] + nth, beam[which]
            r = measure(cells.ends[listed], *beams[:, which])
            met = np.flatnonzero(r <= limit[which])
            which, r = which[met], r[met]
            found.append((which, cells.walls[listed[met]], r))
            np.minimum.at(limit, which, r + tie[which])

        grid = cells.within[at]
        crowded = np.flatnonzero(grid >= 0)
        x_exit, y_exit, x_cell, y_cell = due
        east = x_exit < y_exit
        on = limit[beam] >= np.where(east, x_exit, y_exit)
        at += np.where(east, x_step, y_step)
        x_exit += np.where(east, x_cell, 0)
        y_exit += np.where(east, 0, y_cell)
        on &= cells.within[at] != BORDER
        newcomers = _enter(cells, beams, beam[crowded], grid[crowded]) if crowded.size else None
        place, due = place[:, on], due[:, on]
        if newcomers is not None:
            place, due = np.hstack([place, newcomers[0]]), np.hstack([due, newcomers[1]])
    which, wall, r = (np.concatenate(each) for each in zip(*found, strict=True))
    return first_of(which, wall, r, span, len(cells.walls))


def _enter(cells: FlatGrid, beams: Array, beam: Integers, grid: Integers) -> tuple[Integers, Array]:
    """Begin a walk of each `beam` (n,) in its `grid` (n,); those that pass the grid by are left
    out.

    Gives beam, cell, and the steps east and north to the next cell, (4, m); and the ranges at which
    these steps are due, and those from one to the next, (4, m) m.
    """
    (x, y, dx, dy, _), (left, bottom, cell), (columns, rows, first) = (
        beams[:, beam],
        cells.place[grid].T,
        cells.shape[grid].T,
    )
    u, v = (x - left) / cell, (y - bottom) / cell
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        west, east, south, north = (
            (1 - u) / dx,
            (columns - 1 - u) / dx,
            (1 - v) / dy,
            (rows - 1 - v) / dy,
        )
        enter = np.maximum(np.maximum(np.minimum(west, east), np.minimum(south, north)), 0.0)
        leave = np.minimum(np.maximum(west, east), np.maximum(south, north))
        # where dx is 0: -inf and inf inside; nan or both alike outside
        comes = np.flatnonzero(enter <= leave)
        if len(comes) < len(beam):
            beam, u, v, dx, dy, enter, cell, columns, rows, first = (
                each[comes] for each in (beam, u, v, dx, dy, enter, cell, columns, rows, first)
            )
        i = np.clip((u + enter * dx).astype(np.int64), 1, columns - 2)
        j = np.clip((v + enter * dy).astype(np.int64), 1, rows - 2)
        x_exit = np.where(dx == 0, np.inf, (i + (dx > 0) - u) * cell / dx)
        y_exit = np.where(dy == 0, np.inf, (j + (dy > 0) - v) * cell / dy)
        due = np.stack([x_exit, y_exit, np.abs(cell / dx), np.abs(cell / dy)])
    steps = np.where(dx > 0, rows, -rows), np.where(dy > 0, 1, -1)
    return np.stack([beam, first + i * rows + j, *steps]), due
