"""A grid over the walls: each cell lists the walls that cross it.

A beam looks only into the cells on its way (Amanatides & Woo, A Fast Voxel Traversal Algorithm,
1987): single_beam.py, many_beams.py and compiled.py go that way. A crowded cell has a grid of its
own, so that a town of walls in a wide plain is found as fast.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np

from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.raycast.rules import TIE

# of a cell: a wall is listed in the cells it passes as near as this, so rounding on the way is
# harmless
PAD = 1 / 64
CROWDED = 64  # walls in a cell from which on it has a grid of its own
# of the coordinates' size: a smaller cell, and rounding would count for beams from near by
FINEST = 2e-8
DEEPEST = 4  # grids within grids; walls that all pass through one point never part

Wall = tuple[float, float, float, float, int]  # its ends' x, y, x, y in m, and its index


@dataclass(frozen=True, eq=False)
class Grid:
    """Square cells over all walls, about as many as there are walls, and round them a border that
    ends every walk.

    Cell (i, j) covers x = left + [i, i + 1) cell, y = bottom + [j, j + 1) cell and has the number
    i · rows + j.
    """

    segments: Array  # (W, 2, 2) m: the ends of each wall
    numbers: Integers  # (W,) the index that each wall has on the map
    size: float  # m, the largest coordinate of any wall
    # m: as long as |x| + |y| is less, rounding is small against a cell, and the walls are found
    horizon: float
    left: float  # m
    bottom: float  # m
    cell: float  # m
    columns: int
    rows: int
    start: Integers  # (cells + 1,): cell c lists walls[start[c] : start[c + 1]]
    walls: Integers  # (listed,) which of the segments, cell after cell
    border: Booleans  # (cells,)
    crowded: Mapping[int, "Grid"]  # the grids of the cells that have one of their own

    @classmethod
    def over(cls, segments: Array) -> Self:
        """A grid over all walls of a map."""
        return cls._within(
            segments, segments, np.arange(len(segments)), float(np.abs(segments).max()), 0
        )

    @classmethod
    def _within(
        cls, segments: Array, pieces: Array, numbers: Integers, size: float, depth: int
    ) -> Self:
        """Lay the cells so that even walls that all cross the whole area are listed some 16 times
        each at most.

        pieces : (W, 2, 2) m, the parts of the walls that lie in the area; numbers : (W,) indices of
        the walls
        """
        count, extent = len(segments), np.ptp(pieces, axis=(0, 1))
        lengths = np.abs(pieces[:, 1] - pieces[:, 0]).sum()
        fine = max(
            np.sqrt(extent.prod() / count), extent.max() / count, lengths / (16 * count + 4096)
        )
        cell = float(max(fine, FINEST * size))
        left, bottom = pieces.min((0, 1)) - (1 + 2 * PAD) * cell
        # 2 for border, 2 for what is over and the pads
        columns, rows = (int(n) for n in extent // cell + 4)

        wall, at = crossed((pieces - [left, bottom]) / cell, columns, rows)
        order = np.argsort(at, kind="stable")
        start = np.concatenate([[0], np.cumsum(np.bincount(at, minlength=columns * rows))])
        border = np.pad(np.zeros((columns - 2, rows - 2), bool), 1, constant_values=True).ravel()

        horizon = PAD / 64 * cell / TIE - size
        crowds = np.flatnonzero((np.diff(start) > CROWDED) & ~border & (depth < DEEPEST))
        crowded = {}
        for c in crowds.tolist():
            here = wall[order[start[c] : start[c + 1]]]
            corner = np.array([left, bottom]) + np.array(divmod(c, rows)) * cell
            inside = clipped(segments[here], corner - 2 * PAD * cell, corner + (1 + 2 * PAD) * cell)
            crowded[c] = cls._within(segments[here], inside, numbers[here], size, depth + 1)
        horizon = min([horizon, *(nested.horizon for nested in crowded.values())])
        place = horizon, float(left), float(bottom), cell, columns, rows
        return cls(segments, numbers, size, *place, start, wall[order], border, crowded)

    @cached_property
    def plain(self) -> tuple[float, float, float, int, int, float, list[list[Wall] | None]]:
        """What a single beam looks up, in plain numbers: left, bottom, cell, columns, rows, size,
        and the walls of each cell, None for a crowded one and for the border.
        """
        ends = self.segments.reshape(-1, 4).T.tolist()
        tuples = list(zip(*ends, self.numbers.tolist(), strict=True))
        listed, bounds = [tuples[k] for k in self.walls.tolist()], self.start.tolist()
        lists: list[list[Wall] | None] = [
            None if outside else listed[a:b]
            for outside, a, b in zip(self.border.tolist(), bounds[:-1], bounds[1:], strict=True)
        ]
        for c in self.crowded:
            lists[c] = None
        return self.left, self.bottom, self.cell, self.columns, self.rows, self.size, lists


def crossed(segments: Array, columns: int, rows: int) -> tuple[Integers, Integers]:
    """All pairs of a segment and a cell that it crosses or passes within PAD; segments (n, 2, 2) in
    units of cells.

    Each segment is cut into its columns, and what lies in one column runs through neighbouring
    rows.
    """
    eastward = segments[:, 0, 0] <= segments[:, 1, 0]
    ax, ay, bx, by = np.where(eastward[:, None, None], segments, segments[:, ::-1]).reshape(-1, 4).T
    low = np.floor(ax - PAD).astype(np.int64)
    wall, nth = spread(np.floor(bx + PAD).astype(np.int64) - low + 1)
    column = low[wall] + nth

    ax, ay, bx, by = ax[wall], ay[wall], bx[wall], by[wall]
    enter, leave = np.maximum(ax, column - PAD), np.minimum(bx, column + 1 + PAD)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.where(bx > ax, (by - ay) / (bx - ax), 0.0)
        y = np.stack([ay + slope * (enter - ax), by + slope * (leave - bx)])
    y = np.where(bx > ax, np.clip(y, np.minimum(ay, by), np.maximum(ay, by)), [ay, by])
    low = np.floor(y.min(0) - PAD).astype(np.int64)
    part, nth = spread(np.floor(y.max(0) + PAD).astype(np.int64) - low + 1)
    column, row = np.clip(column[part], 1, columns - 2), np.clip(low[part] + nth, 1, rows - 2)
    return wall[part], column * rows + row


def clipped(segments: Array, low: Array, high: Array) -> Array:
    """The parts of segments within a box (Liang & Barsky, 1984). segments : (n, 2, 2), low and high
    : (2,)
    """
    a, way = segments[:, 0], segments[:, 1] - segments[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.sort([(low - a) / way, (high - a) / way], axis=0)
    # along a side: within it all the way
    ends = np.where(way == 0, [[[-np.inf]], [[np.inf]]], ends)
    enter, leave = np.clip(ends[0].max(-1), 0, 1), np.clip(ends[1].min(-1), 0, 1)
    t = np.stack([np.minimum(enter, leave), np.maximum(enter, leave)], axis=-1)
    pieces: Array = np.clip(a[:, None] + t[..., None] * way[:, None], low, high)
    return pieces


def spread(counts: Integers) -> tuple[Integers, Integers]:
    """Counts (2, 0, 3) give owners (0, 0, 2, 2, 2) and numbers (0, 1, 0, 1, 2)."""
    owner = np.repeat(np.arange(len(counts)), counts)
    return owner, np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
