"""Round walls in cells, and many beams from cell to cell: where each may meet others than its
neighbours, and there are too many for all to be tried.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.raycast.brute import extent
from ekfsim.raycast.rules import REACH, TIE, meet_round
from ekfsim.raycast.searches.candidates import first_of
from ekfsim.raycast.searches.grid import FINEST, PAD, spread


@dataclass(frozen=True, eq=False)
class RoundCells:
    """Square cells over all circles, about as many as there are circles, and none of them much
    smaller than these are: each lists the circles whose boxes touch it.

    Cell (i, j) covers x = left + [i, i + 1) cell, y = bottom + [j, j + 1) cell and has the number
    i · rows + j.
    """

    circles: Array  # (C, 3) m
    size: float  # m, the largest coordinate of any circle
    horizon: float  # m: as long as |x| + |y| is less, rounding is small against a cell
    corner: Array  # (2,) m: left, bottom
    cell: float  # m
    count: Integers  # (2,): columns, rows
    start: Integers  # (cells + 1,): cell c lists listed[start[c] : start[c + 1]]
    listed: Integers

    @classmethod
    def over(cls, circles: Array) -> Self:
        """Cells over all circles of a map, one at least."""
        size, centre, radius = extent(circles), circles[:, :2], circles[:, 2:]
        low, high = centre - radius, centre + radius
        side = high.max(axis=0) - low.min(axis=0)
        broad = 2 * np.sqrt(np.mean(radius**2))
        cell = float(max(np.sqrt(side.prod() / len(circles)), broad, FINEST * size))
        corner = low.min(axis=0) - PAD * cell
        count = (side // cell).astype(np.int64) + 2
        first = np.floor((low - corner) / cell - PAD).astype(np.int64).clip(0, count - 1)
        last = np.floor((high - corner) / cell + PAD).astype(np.int64).clip(0, count - 1)
        circle, nth = spread((last - first + 1).prod(axis=1))
        across = (last - first + 1)[circle, 1]
        i, j = first[circle, 0] + nth // across, first[circle, 1] + nth % across
        at = i * count[1] + j
        start = np.concatenate([[0], np.cumsum(np.bincount(at, minlength=int(count.prod())))])
        horizon = PAD / 64 * cell / TIE - size
        listed = circle[np.argsort(at, kind="stable")]
        return cls(circles, size, horizon, corner, cell, count, start, listed)

    def first(self, beams: Array, limit: Array) -> tuple[Array, Integers]:
        """Ranges and circles that beams meet first : (n,) both, nan and −1 for a beam without

        beams : (4, n), x, y in m, each within the horizon, and the unit direction; limit : (n,) m,
        nothing farther matters
        """
        x, y = beams[:2]
        span = self.size + np.abs(x) + np.abs(y)
        limit, tie = limit + TIE * span, TIE * span
        beam, place, due, each = self._enter(beams)
        found = [(beam[:0], beam[:0], x[:0])]
        while beam.size:
            at = place[0] * self.count[1] + place[1]
            which, nth = spread(self.start[at + 1] - self.start[at])
            circle, which = self.listed[self.start[at][which] + nth], beam[which]
            with np.errstate(invalid="ignore"):
                ox, oy, dx, dy = beams[:, which]
                r = meet_round(self.circles[circle], ox, oy, dx, dy, REACH * span[which])
            met = np.flatnonzero(r <= limit[which])
            found.append((which[met], circle[met], r[met]))
            np.minimum.at(limit, which[met], r[met] + tie[which[met]])
            on = self._step(place, due, each, np.sign(beams[2:, beam]), limit[beam])
            beam, place, due, each = beam[on], place[:, on], due[:, on], each[:, on]
        which, circle, r = (np.concatenate(one) for one in zip(*found, strict=True))
        return first_of(which, circle, r, span, len(self.circles))

    def _step(self, place: Integers, due: Array, each: Array, way: Array, limit: Array) -> Booleans:
        """Step on to the next cells; and which beams are still to be followed there."""
        east = due[0] < due[1]
        exits = np.where(east, due[0], due[1])
        axis, all_ = np.where(east, 0, 1), np.arange(len(east))
        place[axis, all_] += way[axis, all_].astype(np.int64)
        due[axis, all_] += each[axis, all_]
        inside = ((place >= 0) & (place < self.count[:, None])).all(axis=0)
        return np.asarray(inside & (exits <= limit))

    def _enter(self, beams: Array) -> tuple[Integers, Integers, Array, Array]:
        """The beams that come to a cell (m,), the first that each comes to (2, m), the ranges at
        which it leaves that to the east or west and to the north or south, and from one such step
        to the next (2, m) m.
        """
        at, way = (beams[:2] - self.corner[:, None]) / self.cell, beams[2:]
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = np.stack([-at / way, (self.count[:, None] - at) / way])
            enter = np.fmax(ends.min(axis=0).max(axis=0), 0.0)
            comes = np.flatnonzero(enter <= ends.max(axis=0).min(axis=0))
            at, way, enter = at[:, comes], way[:, comes], enter[comes]
            place = np.floor(at + enter * way).astype(np.int64).clip(0, self.count[:, None] - 1)
            due = np.where(way == 0, np.inf, (place + (way > 0) - at) * self.cell / way)
            return comes, place, due, np.abs(self.cell / way)
