"""A grid and all the grids within its cells, laid end to end: what beams by the thousand walk
through.

Arrays cannot hold a tree, so every cell of every grid gets a number, and a crowded cell names the
grid that it holds.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.searches.grid import Grid

PLAIN, BORDER = -1, -2  # a cell that lists its walls itself; one where every walk ends


@dataclass(frozen=True, eq=False)
class FlatGrid:
    """All cells of a `Grid` and of the grids within it. The outermost has the number 0, and its
    cells the first numbers.
    """

    grid: Grid  # the outermost
    # (listed, 4) m: x, y of the first and of the second end of each listed wall, cell after cell
    ends: Array
    walls: Integers  # (listed,) the index that each of them has on the map
    start: Integers  # (cells + 1,): cell c lists walls[start[c] : start[c + 1]]
    # (cells,) the number of the grid that a crowded cell holds, else PLAIN or BORDER
    within: Integers
    place: Array  # (grids, 3) m: left, bottom and cell of each grid
    shape: Integers  # (grids, 3): its columns, its rows, and the number of its first cell

    @classmethod
    def of(cls, outermost: Grid) -> Self:
        """Number the grids from the outside in."""
        grids, first, within, counts, listed = [outermost], 0, [], [], []
        shape = []
        for grid in grids:  # which grows on the way
            inside = np.where(grid.border, BORDER, PLAIN)
            count = np.diff(grid.start)
            kept = np.ones(len(grid.walls), bool)
            for c, nested in grid.crowded.items():
                inside[c], count[c] = len(grids), 0
                kept[grid.start[c] : grid.start[c + 1]] = False
                grids.append(nested)
            shape.append((grid.columns, grid.rows, first))
            first += len(inside)
            within.append(inside)
            counts.append(count)
            listed.append(grid.numbers[grid.walls[kept]])
        walls = np.concatenate(listed)
        return cls(
            outermost,
            np.ascontiguousarray(outermost.segments[walls].reshape(-1, 4)),
            walls,
            np.concatenate([[0], np.cumsum(np.concatenate(counts))]),
            np.concatenate(within),
            np.array([(grid.left, grid.bottom, grid.cell) for grid in grids]),
            np.array(shape),
        )
